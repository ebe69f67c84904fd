//! `[[constraints]]` that act on one side, and the check that the start respects them.

use super::ids::Ids;
use super::{Assembly, Places};
use crate::model::contact::{Ball, Box, HalfSpace, Limits, Rope};
use crate::model::{Id, Name, Named};
use crate::report::Report;
use crate::tree::Node;
use qhat::{Obstacle, Settings, State, StepError, Surface, System};

impl Assembly<'_, '_, '_> {
    pub(super) fn add_rope(&mut self, it: &Rope, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        let length = match it.length {
            Some(length) => length,
            None => self.measured_length("rope", &it.between, (a, b), place)?,
        };
        let Rope { restitution, breaks_at, breaks_at_impulse, .. } = *it;
        let rope = qhat::Limits::rope(a, b, length);
        let stiffness = it.stiffness.unwrap_or(rope.stiffness);
        self.add_named(it, qhat::Limits { restitution, breaks_at, breaks_at_impulse, stiffness, ..rope });
        Some(())
    }

    pub(super) fn add_limits(&mut self, it: &Limits, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        let Limits { shortest, longest, restitution, breaks_at, breaks_at_impulse, .. } = *it;
        let stiffness = it.stiffness.unwrap_or(1.0);
        let limits = qhat::Limits { a, b, shortest, longest, restitution, breaks_at, breaks_at_impulse, stiffness };
        self.add_named(it, limits);
        Some(())
    }

    pub(super) fn add_half_space(&mut self, it: &HalfSpace, place: &Node) -> Option<()> {
        let normal = it.normal.as_ref().map_or([0.0, 1.0, 0.0], |normal| normal.padded());
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let through = it.through.as_ref().map_or([0.0; 3], |point| point.padded());
        let offset = normal.iter().zip(through).map(|(n, x)| n * x).sum::<f64>() / length;
        if !(length > 0.0 && offset.is_finite()) {
            let message = "this `normal` has no direction that can be measured";
            let help = "give a vector of a length near 1, as in `normal = [0.0, 1.0]`".to_owned();
            self.report.error(place.key("normal").span.clone(), message, Some(help));
            return None;
        }
        let surface = Surface::HalfSpace { normal, offset };
        self.add_obstacles(it, it.particles.as_deref(), surface, (it.restitution, it.friction), place)
    }

    pub(super) fn add_ball(&mut self, it: &Ball, place: &Node) -> Option<()> {
        let surface = Surface::Ball { center: it.center.padded(), radius: it.radius, inside: it.inside };
        self.add_obstacles(it, it.particles.as_deref(), surface, (it.restitution, it.friction), place)
    }

    pub(super) fn add_box(&mut self, it: &Box, place: &Node) -> Option<()> {
        if let Some(k) = it.size.0.iter().position(|&size| size <= 0.0) {
            let message = "the size of a box must be above 0";
            let help = "a half-space is a wall without thickness".to_owned();
            self.report.error(place.key("size").item(k).span.clone(), message, Some(help));
            return None;
        }
        // In the plane the engine checks that the third number is positive, and does not use it.
        let half = std::array::from_fn(|k| it.size.0.get(k).map_or(1.0, |size| 0.5 * size));
        let surface = Surface::Box { center: it.center.padded(), half };
        self.add_obstacles(it, it.particles.as_deref(), surface, (it.restitution, it.friction), place)
    }

    /// Adds an obstacle for each particle, named after both.
    fn add_obstacles(
        &mut self,
        it: &impl Named,
        particles: Option<&[Id]>,
        surface: Surface,
        (restitution, friction): (f64, f64),
        place: &Node,
    ) -> Option<()> {
        let stem = it.id().map_or_else(|| it.default_name(), |Name(name)| name.clone());
        for particle in self.listed_or_free(particles, place)? {
            let name = format!("{stem}({})", self.builder.name(particle));
            let name = self.free_name(name);
            self.builder.constraint(name, Obstacle { particle, surface: surface.clone(), restitution, friction });
        }
        Some(())
    }
}

/// Reports contacts that the start violates, an integrator that cannot find events, and an energy that is not finite.
pub(super) fn check_start(
    system: &System,
    state: &State,
    settings: &Settings,
    (tree, ids, places): (&Node, &Ids, &Places),
    report: &mut Report<'_>,
) {
    let Err(error) = qhat::check_start(system, state, settings) else { return };
    let place = match &error {
        StepError::NoEvents { .. } => tree.key("step").key("integrator").span.clone(),
        StepError::Penetrates { constraint, .. } | StepError::NoGradient { constraint, .. } => {
            places.get(constraint).cloned().unwrap_or_default()
        }
        StepError::EnergyNotFinite { particle, .. } => ids.origin(particle).unwrap_or_default(),
        _ => 0..0,
    };
    let message = report.fitted(&error.to_string());
    report.error(place, message, None);
}
