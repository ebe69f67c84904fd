//! `[[constraints]]` that act on one side, and whether the start respects them.

use super::{Assembly, Places};
use crate::model::contact::{Ball, Box, HalfSpace, Limits, Rope};
use crate::model::{Id, Name};
use crate::report::Report;
use crate::tree::Node;
use qhat::{Obstacle, Settings, State, StepError, Surface, System};

impl Assembly<'_, '_, '_> {
    pub(super) fn add_rope(&mut self, rope: &Rope, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&rope.between, place)?;
        let length = match rope.length {
            Some(length) => length,
            None => self.measured_length("rope", &rope.between, (a, b), place)?,
        };
        let Rope { restitution, breaks_at, .. } = *rope;
        let limits = qhat::Limits { restitution, breaks_at, ..qhat::Limits::rope(a, b, length) };
        self.add_limited(rope.id.as_ref(), "rope", &rope.between, limits, place);
        Some(())
    }

    pub(super) fn add_limits(&mut self, limits: &Limits, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&limits.between, place)?;
        let Limits { shortest, longest, restitution, breaks_at, .. } = *limits;
        let limited = qhat::Limits { a, b, shortest, longest, restitution, breaks_at };
        self.add_limited(limits.id.as_ref(), "limits", &limits.between, limited, place);
        Some(())
    }

    fn add_limited(&mut self, id: Option<&Name>, kind: &str, between: &[Id; 2], limits: qhat::Limits, place: &Node) {
        let [Id(one), Id(other)] = between;
        let name = match id {
            Some(Name(name)) => name.clone(),
            None => self.free_constraint_name(format!("{kind}({one}-{other})")),
        };
        self.places.insert(name.clone(), place.span.clone());
        self.builder.constraint(name, limits);
    }

    pub(super) fn add_half_space(&mut self, it: &HalfSpace, place: &Node) -> Option<()> {
        let normal = it.normal.as_ref().map_or([0.0, 1.0, 0.0], |normal| normal.padded());
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let through = it.through.as_ref().map_or([0.0; 3], |point| point.padded());
        let offset = normal.iter().zip(through).map(|(n, x)| n * x).sum::<f64>() / length;
        if !(length > 0.0 && offset.is_finite()) {
            let message = "this `normal` has no direction that can be measured";
            let help = "give a vector about as long as 1, as in `normal = [0.0, 1.0]`".to_owned();
            self.report.error(place.key("normal").span.clone(), message, Some(help));
            return None;
        }
        let surface = Surface::HalfSpace { normal, offset };
        self.add_barriers(
            (it.id.as_ref(), "half-space"),
            it.particles.as_deref(),
            surface,
            (it.restitution, it.friction),
            place,
        )
    }

    pub(super) fn add_ball(&mut self, it: &Ball, place: &Node) -> Option<()> {
        let surface = Surface::Ball { center: it.center.padded(), radius: it.radius, inside: it.inside };
        self.add_barriers(
            (it.id.as_ref(), "ball"),
            it.particles.as_deref(),
            surface,
            (it.restitution, it.friction),
            place,
        )
    }

    pub(super) fn add_box(&mut self, it: &Box, place: &Node) -> Option<()> {
        if let Some(k) = it.size.0.iter().position(|&size| size <= 0.0) {
            let message = "the size of a box must be above 0";
            let help = "a half-space is a wall without thickness".to_owned();
            self.report.error(place.key("size").item(k).span.clone(), message, Some(help));
            return None;
        }
        // In the plane the third is not looked at, and must only be positive.
        let half = std::array::from_fn(|k| it.size.0.get(k).map_or(1.0, |size| 0.5 * size));
        let surface = Surface::Box { center: it.center.padded(), half };
        self.add_barriers(
            (it.id.as_ref(), "box"),
            it.particles.as_deref(),
            surface,
            (it.restitution, it.friction),
            place,
        )
    }

    /// One barrier for each particle, named after both.
    fn add_barriers(
        &mut self,
        (id, kind): (Option<&Name>, &str),
        particles: Option<&[Id]>,
        surface: Surface,
        (restitution, friction): (f64, f64),
        place: &Node,
    ) -> Option<()> {
        let stem = id.map_or(kind, |Name(name)| name);
        for particle in self.those_or_all(particles, place)? {
            let name = format!("{stem}({})", self.builder.name(particle));
            let name = self.free_constraint_name(name);
            self.places.insert(name.clone(), place.span.clone());
            self.builder.constraint(name, Obstacle { particle, surface: surface.clone(), restitution, friction });
        }
        Some(())
    }
}

/// Tells what the start, or the choice of the integrator, has against contacts.
pub(super) fn check_start(
    system: &System,
    state: &State,
    settings: &Settings,
    (tree, places): (&Node, &Places),
    report: &mut Report<'_>,
) {
    let Err(error) = qhat::check_start(system, state, settings) else { return };
    let place = match &error {
        StepError::NoEvents { .. } => tree.key("step").key("integrator").span.clone(),
        StepError::Penetrates { constraint, .. } => places.get(constraint).cloned().unwrap_or_default(),
        _ => 0..0,
    };
    let message = report.fitted(&error.to_string());
    report.error(place, message, None);
}
