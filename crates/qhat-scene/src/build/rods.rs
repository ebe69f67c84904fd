//! `[[constraints]]` that hold distances: rods and rigid clusters.

use super::Assembly;
use crate::model::rods::{Distance, DistanceForm, Rigid};
use crate::model::{Id, Named};
use crate::tree::Node;
use qhat::{ParticleId, RigidCluster, rigid_cluster};

impl Assembly<'_, '_, '_> {
    pub(super) fn add_distance(&mut self, it: &Distance, place: &Node) -> Option<()> {
        let ends = self.pair(&it.between, place.key("between"))?;
        let length = match &it.length {
            Some(driven) => match self.schedule(driven, place.key("length"))? {
                qhat::Driven::Constant(length) => length,
                radius => return self.add_driven_rod(it, radius, ends, place),
            },
            None => self.measured_length("rod", &it.between, ends, place)?,
        };
        let name = self.name_of(it);
        if it.compliance > 0.0 && it.stiffness.is_some() {
            let message = "a rod with a compliance has no `stiffness`: its tension follows from its own length";
            let help = "leave out one of the two".to_owned();
            self.report.error(place.key("stiffness").span.clone(), message, Some(help));
            return None;
        }
        let rod = qhat::Distance::new(ends.0, ends.1, length).with_compliance(it.compliance, it.damping);
        let stiffness = it.stiffness.unwrap_or(rod.stiffness);
        let rod = rod.with_stiffness(stiffness);
        let Distance { form, breaks_at, breaks_at_impulse, .. } = *it;
        self.builder.constraint(name, qhat::Distance { form: form.into(), breaks_at, breaks_at_impulse, ..rod });
        Some(())
    }

    /// The distance at the start [m], for a rod or rope whose length is left out.
    pub(super) fn measured_length(
        &mut self,
        what: &str,
        between: &[Id; 2],
        (a, b): (ParticleId, ParticleId),
        place: &Node,
    ) -> Option<f64> {
        if place.get("length").is_some() {
            // The length was refused, and its error reported.
            return None;
        }
        let length = self.distance(a, b);
        let [one, other] = between.each_ref().map(|Id(id)| self.report.quoted(id));
        let complaint = if length == 0.0 {
            format!("a {what} needs a length, but {one} and {other} start at the same place")
        } else if !length.is_finite() {
            format!("{one} and {other} start too far apart to measure the length of a {what}")
        } else {
            return Some(length);
        };
        let help = "move one of them, or give `length` [m]".to_owned();
        self.report.error(place.key("between").span.clone(), complaint, Some(help));
        None
    }

    /// A rod whose length is an expression of t.
    fn add_driven_rod(
        &mut self,
        it: &Distance,
        radius: qhat::Driven,
        (a, b): (ParticleId, ParticleId),
        place: &Node,
    ) -> Option<()> {
        if it.compliance > 0.0 || it.form != DistanceForm::Length {
            let message = "a rod whose length is an expression is rigid and held in the form `length`";
            let help = "leave out `form`, `compliance` and `damping`, or give `length` as a number".to_owned();
            self.report.error(place.key("length").span.clone(), message, Some(help));
            return None;
        }
        if let Some(key) = ["breaks_at", "breaks_at_impulse"].into_iter().find(|key| place.get(key).is_some()) {
            let message = "a rod whose length is an expression does not break";
            let help = format!("leave out `{key}`, or give `length` as a number");
            self.report.error(place.key(key).span.clone(), message, Some(help));
            return None;
        }
        let rod = qhat::Distance::driven(a, b, radius);
        let stiffness = it.stiffness.unwrap_or(rod.stiffness);
        self.add_named(it, rod.with_stiffness(stiffness));
        Some(())
    }

    pub(super) fn add_rigid(&mut self, it: &Rigid, place: &Node) -> Option<()> {
        let list = place.key("particles");
        let particles = self.different(&it.particles, list)?;
        let points: Vec<[f64; 3]> = particles.iter().map(|id| self.start(*id)).collect();
        match rigid_cluster(self.dimension_of_system(), &points) {
            Ok(RigidCluster { rods, combinations }) => {
                for ends in rods {
                    let [a, b] = ends.map(|end| &it.particles[end].0);
                    let name = self.free_name(format!("{a}-{b}"));
                    let [a, b] = ends.map(|end| particles[end]);
                    let rod = qhat::Distance::new(a, b, self.distance(a, b));
                    self.builder.constraint(name, rod);
                }
                for terms in combinations {
                    let name = self.free_name(format!("rigid({})", it.particles[terms[0].0].0));
                    let terms: Vec<_> = terms.into_iter().map(|(k, weight)| (particles[k], weight)).collect();
                    self.builder.constraint(name, qhat::Relation::homogeneous(terms));
                }
                Some(())
            }
            Err(reason) => {
                let message = format!("constraint `{}`: this cluster cannot be held: {reason}", it.default_name());
                self.report.error(list.span.clone(), message, None);
                None
            }
        }
    }
}
