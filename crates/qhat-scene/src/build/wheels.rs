//! `[[constraints]]` of angles and motors, gears, racks.

use super::Assembly;
use crate::model::Id;
use crate::model::wheels::{Angle, Gears, Rack};
use crate::tree::Node;
use qhat::{Constraint, ParticleId};
use std::f64::consts::PI;

/// The distance of an angle from 0 or π [rad] below which the angle is lost in the roundoff of a step.
const IN_LINE: f64 = 1e-6;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_angle(&mut self, it: &Angle, place: &Node) -> Option<()> {
        let arm = self.arm(&it.arm, place.key("arm"))?;
        if it.from.is_some() && it.direction.is_some() {
            let message = "an angle is counted from an arm or from a direction, not from both";
            let help = "leave out `from` or `direction`".to_owned();
            self.report.error(place.key("direction").span.clone(), message, Some(help));
            return None;
        }
        let from = match &it.from {
            Some(from) => Some(self.arm(from, place.key("from"))?),
            None => None,
        };
        let direction = it.direction.as_ref().map_or([1.0, 0.0, 0.0], |direction| direction.padded());
        let make = |angle: qhat::Driven| -> Constraint {
            match from {
                Some(from) => qhat::Angle::between(from, arm, angle).into(),
                None => qhat::Angle::from_direction(direction, arm, angle).into(),
            }
        };
        let at_start = make(0.0.into()).residual(self.dimension_of_system(), self.start_positions())[0];
        if self.dimension == 3 && (at_start.abs() < IN_LINE || (PI - at_start.abs()).abs() < IN_LINE) {
            let message = "at the start the arm lies in one line with the arm or direction from which its angle is \
                           counted; in space such an angle has no direction to change in";
            let help = "start with an angle between 0 and π".to_owned();
            self.report.error(place.key("arm").span.clone(), message, Some(help));
            return None;
        }
        self.add_driven(it, it.angle.as_ref(), (place, "angle"), make)
    }

    pub(super) fn add_gears(&mut self, it: &Gears, place: &Node) -> Option<()> {
        let wheels = place.key("wheels");
        let [one, other] = [0, 1].map(|wheel| self.arm(&it.wheels[wheel], wheels.item(wheel)));
        let wheels = [one?, other?];
        self.in_plane(place, "gears mesh")?;
        let make = |angle: qhat::Driven| qhat::Gears::mesh(wheels, it.teeth, angle).into();
        self.add_driven(it, it.angle.as_ref(), (place, "angle"), make)
    }

    pub(super) fn add_rack(&mut self, it: &Rack, place: &Node) -> Option<()> {
        let pinion = self.arm(&it.pinion, place.key("pinion"));
        let particle = self.particle(&it.particle, place.key("particle"));
        let (pinion, particle) = (pinion?, particle?);
        self.in_plane(place, "a rack moves")?;
        let [x, y, _] = it.along.padded();
        if x == 0.0 && y == 0.0 {
            let message = "`along` needs a length";
            self.report.error(place.key("along").span.clone(), message, Some("as in `along = [1.0, 0.0]`".into()));
            return None;
        }
        let make = |angle: qhat::Driven| qhat::Gears::rack(pinion, particle, [x, y], it.radius, angle).into();
        self.add_driven(it, it.angle.as_ref(), (place, "angle"), make)
    }

    /// `None` in space after reporting that a kind exists in two dimensions only.
    pub(super) fn in_plane(&mut self, place: &Node, what: &str) -> Option<()> {
        if self.dimension != 2 {
            self.report.error(place.span.clone(), format!("{what} in two dimensions only"), None);
            return None;
        }
        Some(())
    }

    fn arm(&mut self, ids: &[Id; 2], list: &Node) -> Option<[ParticleId; 2]> {
        self.pair(ids, list).map(|(a, b)| [a, b])
    }
}
