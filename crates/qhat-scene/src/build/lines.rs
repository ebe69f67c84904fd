//! `[[constraints]]` of directions, straight lines and planes.

use super::Assembly;
use crate::model::lines::{Direction, Line, Plane};
use crate::tree::Node;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_direction(&mut self, it: &Direction, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        let (from, to) = (self.start(a), self.start(b));
        let start = std::array::from_fn(|k| to[k] - from[k]);
        if it.along.is_none() && start == [0.0; 3] {
            let message = "the two particles start at the same place, which gives no direction";
            self.report.error(place.key("between").span.clone(), message, Some("give `along`".into()));
            return None;
        }
        let along = self.schedules_or(it.along.as_ref(), place.key("along"), start)?;
        self.add_named(it, qhat::Direction { a, b, along });
        Some(())
    }

    pub(super) fn add_line(&mut self, it: &Line, place: &Node) -> Option<()> {
        let constraint = match (&it.between, &it.along) {
            (Some([one, other]), None) if it.at.is_none() => {
                let between = place.key("between");
                let ids = [(&it.particle, place.key("particle")), (one, between.item(0)), (other, between.item(1))];
                let [particle, a, b] = self.different_at(ids)?;
                qhat::OnLine::through(particle, a, b)
            }
            (None, Some(along)) => {
                let particle = self.particle(&it.particle, place.key("particle"))?;
                let start = self.start(particle);
                let point = self.schedules_or(it.at.as_ref(), place.key("at"), start)?;
                let along = self.schedules(along, place.key("along"))?;
                qhat::OnLine { particle, line: qhat::Line::Through(point, along) }
            }
            (given, _) => {
                self.needs_one(place, "line", ["along", "between"], given.is_some());
                return None;
            }
        };
        self.add_named(it, constraint);
        Some(())
    }

    pub(super) fn add_plane(&mut self, it: &Plane, place: &Node) -> Option<()> {
        if self.dimension == 2 {
            let help = "hold the particle on a line: `kind = \"line\"`".to_owned();
            self.report.error(place.span.clone(), "there is no plane to be on in two dimensions", Some(help));
            return None;
        }
        let constraint = match (&it.through, &it.normal) {
            (Some([a, b, c]), None) if it.at.is_none() => {
                let list = place.key("through");
                let [a, b, c] = [(a, list.item(0)), (b, list.item(1)), (c, list.item(2))];
                let [particle, corners @ ..] = self.different_at([(&it.particle, place.key("particle")), a, b, c])?;
                qhat::OnPlane::through(particle, corners)
            }
            (None, Some(normal)) => {
                let particle = self.particle(&it.particle, place.key("particle"))?;
                let start = self.start(particle);
                let point = self.schedules_or(it.at.as_ref(), place.key("at"), start)?;
                let normal = self.schedules(normal, place.key("normal"))?;
                qhat::OnPlane { particle, plane: qhat::Plane::Across(point, normal) }
            }
            (given, _) => {
                self.needs_one(place, "plane", ["normal", "through"], given.is_some());
                return None;
            }
        };
        self.add_named(it, constraint);
        Some(())
    }
}
