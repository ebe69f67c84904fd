//! `[[constraints]]` that hold sums of positions at a point: nails, coincidences, midpoints, centres of mass.

use super::Assembly;
use crate::model::incidence::{CenterOfMass, Coincidence, Midpoint, Nail, NailForm, Relation};
use crate::model::{DrivenVector, Named};
use crate::tree::Node;
use qhat::ParticleId;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_nail(&mut self, it: &Nail, place: &Node) -> Option<()> {
        let particle = self.particle(&it.particle, place.key("particle"))?;
        let start = self.start(particle);
        let point = self.schedules_or(it.at.as_ref(), place.key("at"), start)?;
        if let [qhat::Driven::Constant(x), qhat::Driven::Constant(y), qhat::Driven::Constant(z)] = point {
            self.add_named(it, qhat::Nail { particle, at: [x, y, z], form: it.form.into() });
        } else if it.form == NailForm::Vector {
            self.add_named(it, qhat::Relation::driven(particle, point));
        } else {
            let message = "a nail whose point is an expression is held in the form `vector`";
            self.report.error(place.key("form").span.clone(), message, Some("leave out `form`".into()));
        }
        Some(())
    }

    pub(super) fn add_coincidence(&mut self, it: &Coincidence, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        self.add_named(it, qhat::Relation::coincidence(a, b));
        Some(())
    }

    pub(super) fn add_midpoint(&mut self, it: &Midpoint, place: &Node) -> Option<()> {
        let between = place.key("between");
        let [one, other] = &it.between;
        let ids = [(&it.particle, place.key("particle")), (one, between.item(0)), (other, between.item(1))];
        let [middle, a, b] = self.different_at(ids)?;
        self.add_named(it, qhat::Relation::midpoint(middle, a, b));
        Some(())
    }

    pub(super) fn add_center_of_mass(&mut self, it: &CenterOfMass, place: &Node) -> Option<()> {
        let particles = self.particles(&it.particles, place.key("particles"))?;
        let terms: Vec<_> = particles.into_iter().map(|id| (id, self.weighed(id))).collect();
        let terms = qhat::Relation::center_of_mass(terms, [0.0; 3].map(qhat::Driven::Constant)).terms;
        self.add_relation_of(it, terms, it.at.as_ref(), place)
    }

    pub(super) fn add_relation(&mut self, it: &Relation, place: &Node) -> Option<()> {
        let list = place.key("terms");
        let mut terms = Vec::new();
        for (index, term) in it.terms.iter().enumerate() {
            terms.push((self.particle(&term.particle, list.item(index).key("particle"))?, term.weight));
        }
        self.add_relation_of(it, terms, it.at.as_ref(), place)
    }

    fn add_relation_of(
        &mut self,
        it: &impl Named,
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
        self.add_named(it, qhat::Relation { terms, point });
        Some(())
    }
}
