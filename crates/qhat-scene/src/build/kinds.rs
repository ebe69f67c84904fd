//! The kinds of `[[constraints]]` beyond rods and nails.

use super::Assembly;
use crate::model::kinds::{CenterOfMass, Circle, Coincidence, Direction, Line, Midpoint, Plane, Relation, Sphere};
use crate::model::{Driven, DrivenVector, Id, Name};
use crate::tree::Node;
use qhat::{Anchor, Constraint, ParticleId};

impl Assembly<'_, '_, '_> {
    /// Adds a constraint under its own name, or one made from what it is.
    pub(super) fn add_named(&mut self, id: Option<&Name>, wanted: String, constraint: impl Into<Constraint>) {
        let name = self.name_of(id, wanted);
        self.builder.constraint(name, constraint);
    }

    /// Where a particle starts, as the engine takes points.
    pub(super) fn start(&self, particle: ParticleId) -> [f64; 3] {
        let start = &self.positions[particle.index() * self.dimension..][..self.dimension];
        std::array::from_fn(|k| start.get(k).copied().unwrap_or(0.0))
    }

    /// The particles of a list, all different.
    fn named_once<const K: usize>(&mut self, ids: [(&Id, &Node); K]) -> Option<[ParticleId; K]> {
        let found = ids.map(|(id, place)| self.particle(id, place));
        for i in 1..K {
            if found[i].is_some() && found[..i].contains(&found[i]) {
                let (id, place) = ids[i];
                let message = format!("{} is named twice in one constraint", self.report.quoted(&id.0));
                self.report.error(place.span.clone(), message, Some("name different particles".into()));
                return None;
            }
        }
        if found.iter().any(Option::is_none) { None } else { Some(found.map(|id| id.expect("found"))) }
    }

    /// Tells that a constraint needs one of two keys, and not both; not where one is there and was refused already.
    pub(super) fn needs_one(&mut self, place: &Node, kind: &str, keys: [&str; 2], both: bool) {
        let [one, other] = keys;
        if !both && keys.iter().any(|key| place.get(key).is_some()) {
            return;
        }
        let what = if both { "not both" } else { "but has neither" };
        let message = format!("a {kind} is given by `{one}` or by `{other}`, {what}");
        let help = if both { format!("leave out `{one}` or `{other}`") } else { format!("add `{one}` or `{other}`") };
        self.report.error(place.span.clone(), message, Some(help));
    }

    pub(super) fn add_coincidence(&mut self, it: &Coincidence, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place)?;
        let wanted = format!("coincidence({}-{})", it.between[0].0, it.between[1].0);
        self.add_named(it.id.as_ref(), wanted, qhat::Relation::coincidence(a, b));
        Some(())
    }

    pub(super) fn add_midpoint(&mut self, it: &Midpoint, place: &Node) -> Option<()> {
        let between = place.key("between");
        let named = [
            (&it.particle, place.key("particle")),
            (&it.between[0], between.item(0)),
            (&it.between[1], between.item(1)),
        ];
        let [m, a, b] = self.named_once(named)?;
        self.add_named(it.id.as_ref(), format!("midpoint({})", it.particle.0), qhat::Relation::midpoint(m, a, b));
        Some(())
    }

    pub(super) fn add_center_of_mass(&mut self, it: &CenterOfMass, place: &Node) -> Option<()> {
        let list = place.key("particles");
        let found: Option<Vec<ParticleId>> =
            it.particles.iter().enumerate().map(|(i, id)| self.particle(id, list.item(i))).collect();
        let terms: Vec<_> = found?.into_iter().map(|id| (id, self.builder.mass(id))).collect();
        let terms = qhat::Relation::center_of_mass(terms, [0.0; 3].map(qhat::Driven::Constant)).terms;
        let wanted = format!("center-of-mass({})", it.particles[0].0);
        self.add_relation_of(it.id.as_ref(), wanted, terms, it.at.as_ref(), place)
    }

    pub(super) fn add_relation(&mut self, it: &Relation, place: &Node) -> Option<()> {
        let list = place.key("terms");
        let terms: Option<Vec<_>> = it
            .terms
            .iter()
            .enumerate()
            .map(|(i, term)| Some((self.particle(&term.particle, list.item(i).key("particle"))?, term.weight)))
            .collect();
        let wanted = format!("relation({})", it.terms[0].particle.0);
        self.add_relation_of(it.id.as_ref(), wanted, terms?, it.at.as_ref(), place)
    }

    fn add_relation_of(
        &mut self,
        id: Option<&Name>,
        wanted: String,
        terms: Vec<(ParticleId, f64)>,
        at: Option<&DrivenVector>,
        place: &Node,
    ) -> Option<()> {
        let mut start = [0.0; 3];
        for (particle, weight) in &terms {
            let x = self.start(*particle);
            start = std::array::from_fn(|k| start[k] + weight * x[k]);
        }
        let point = self.schedules_or(at, place.key("at"), start)?;
        self.add_named(id, wanted, qhat::Relation { terms, point });
        Some(())
    }

    pub(super) fn add_direction(&mut self, it: &Direction, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place)?;
        let (from, to) = (self.start(a), self.start(b));
        let start = std::array::from_fn(|k| to[k] - from[k]);
        if it.along.is_none() && start == [0.0; 3] {
            let message = "the two particles start at the same place: that gives no direction";
            self.report.error(place.key("between").span.clone(), message, Some("give `along`".into()));
            return None;
        }
        let along = self.schedules_or(it.along.as_ref(), place.key("along"), start)?;
        let wanted = format!("direction({}-{})", it.between[0].0, it.between[1].0);
        self.add_named(it.id.as_ref(), wanted, qhat::Direction { a, b, along });
        Some(())
    }

    pub(super) fn add_line(&mut self, it: &Line, place: &Node) -> Option<()> {
        let wanted = format!("line({})", it.particle.0);
        let constraint = match (&it.between, &it.along) {
            (Some([one, other]), None) if it.at.is_none() => {
                let between = place.key("between");
                let named = [(&it.particle, place.key("particle")), (one, between.item(0)), (other, between.item(1))];
                let [particle, a, b] = self.named_once(named)?;
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
        self.add_named(it.id.as_ref(), wanted, constraint);
        Some(())
    }

    pub(super) fn add_plane(&mut self, it: &Plane, place: &Node) -> Option<()> {
        if self.dimension == 2 {
            let help = "hold the particle on a line: `kind = \"line\"`".to_owned();
            self.report.error(place.span.clone(), "there is no plane to be on in two dimensions", Some(help));
            return None;
        }
        let wanted = format!("plane({})", it.particle.0);
        let constraint = match (&it.through, &it.normal) {
            (Some([a, b, c]), None) if it.at.is_none() => {
                let list = place.key("through");
                let named =
                    [(&it.particle, place.key("particle")), (a, list.item(0)), (b, list.item(1)), (c, list.item(2))];
                let [particle, corners @ ..] = self.named_once(named)?;
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
        self.add_named(it.id.as_ref(), wanted, constraint);
        Some(())
    }

    pub(super) fn add_sphere(&mut self, it: &Sphere, place: &Node) -> Option<()> {
        let (particle, center, radius) =
            self.round("sphere", &it.particle, it.around.as_ref(), it.center.as_ref(), it.radius.as_ref(), place)?;
        let wanted = format!("sphere({})", it.particle.0);
        self.add_named(it.id.as_ref(), wanted, qhat::OnSphere { particle, center, radius });
        Some(())
    }

    pub(super) fn add_circle(&mut self, it: &Circle, place: &Node) -> Option<()> {
        let (particle, center, radius) =
            self.round("circle", &it.particle, it.around.as_ref(), it.center.as_ref(), it.radius.as_ref(), place)?;
        let wanted = format!("circle({})", it.particle.0);
        match (&it.axis, self.dimension) {
            (None, 2) => self.add_named(it.id.as_ref(), wanted, qhat::OnSphere { particle, center, radius }),
            (Some(axis), 3) => {
                let axis = axis.padded();
                self.add_named(it.id.as_ref(), wanted, qhat::OnCircle { particle, center, axis, radius });
            }
            (Some(_), _) => {
                let message = "a circle has no axis in two dimensions";
                self.report.error(place.key("axis").span.clone(), message, Some("leave out `axis`".into()));
            }
            (None, _) if place.get("axis").is_some() => {}
            (None, _) => {
                let message = "a circle needs an `axis` in three dimensions";
                let help = "add `axis`, what it is at right angles to, as in `axis = [0.0, 1.0, 0.0]`".to_owned();
                self.report.error(place.span.clone(), message, Some(help));
            }
        }
        Some(())
    }

    /// What a sphere and a circle have in common: the particle, the centre and the radius.
    fn round(
        &mut self,
        kind: &str,
        particle: &Id,
        around: Option<&Id>,
        center: Option<&DrivenVector>,
        radius: Option<&Driven>,
        place: &Node,
    ) -> Option<(ParticleId, Anchor, qhat::Driven)> {
        let (particle, center) = match (around, center) {
            (Some(around), None) => {
                let named = [(particle, place.key("particle")), (around, place.key("around"))];
                let [particle, around] = self.named_once(named)?;
                (particle, Anchor::Particle(around))
            }
            (None, Some(center)) => {
                let particle = self.particle(particle, place.key("particle"))?;
                (particle, Anchor::Point(self.schedules(center, place.key("center"))?))
            }
            (given, _) => {
                self.needs_one(place, kind, ["center", "around"], given.is_some());
                return None;
            }
        };
        let radius = match radius {
            Some(radius) => self.schedule(radius, place.key("radius"))?,
            None => {
                let x = self.start(particle);
                let p = match &center {
                    Anchor::Particle(other) => self.start(*other),
                    Anchor::Point(point) => point.each_ref().map(|component| component.value(0.0)),
                };
                let squares: f64 = (0..self.dimension).map(|k| x[k] - p[k]).map(|x| x * x).sum();
                let length = squares.sqrt();
                if !(length > 0.0 && length.is_finite()) {
                    let message =
                        format!("a {kind} needs a radius, but the particle starts in its centre or too far away");
                    self.report.error(place.span.clone(), message, Some("give `radius` [m]".into()));
                    return None;
                }
                qhat::Driven::Constant(length)
            }
        };
        Some((particle, center, radius))
    }
}
