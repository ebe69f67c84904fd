//! Quantities: the numbers of parts that parameters may give, by the keys that they have in scenes.

use crate::constraint::{Anchor, Constraint, DrivenPoint, Line, Plane, Surface};
use crate::driven::Driven;
use crate::force::Force;
use crate::settings::Feedback;
use crate::space::{ConstraintId, ForceId, ParticleId};

/// A number of a part of a system.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Quantity {
    /// m of a particle \[kg\].
    Mass(ParticleId),
    /// A component of the position of a particle at the start \[m\].
    Position(ParticleId, usize),
    /// A component of the velocity of a particle at the start [m/s].
    Velocity(ParticleId, usize),
    /// A number of a constraint by its key, such as `length`, and its place in a vector, 0 for a single number.
    Constraint(ConstraintId, String, usize),
    /// A number of a force by its key, such as `stiffness`, and its place in a vector, 0 for a single number.
    Force(ForceId, String, usize),
    /// A number of the feedback by its key: `ks`, `kd`, `diagonal_drag`, `elasticity`.
    Feedback(String),
}

/// The number of a constraint under a key; `None` if the kind has no such number, or follows a function of time there.
pub(super) fn of_constraint<'a>(constraint: &'a mut Constraint, key: &str, k: usize) -> Option<&'a mut f64> {
    match (constraint, key) {
        (Constraint::Distance(it), "length") => one(&mut it.length, k),
        (Constraint::Distance(it), "compliance") => one(&mut it.compliance, k),
        (Constraint::Distance(it), "damping") => one(&mut it.damping, k),
        (Constraint::Distance(it), "breaks_at") => one(it.breaks_at.as_mut()?, k),
        (Constraint::Distance(it), "breaks_at_impulse") => one(it.breaks_at_impulse.as_mut()?, k),
        (Constraint::Distance(it), "stiffness") => one(&mut it.stiffness, k),
        (Constraint::Nail(it), "at") => it.at.get_mut(k),
        (Constraint::Limits(it), "length") => one(it.longest.as_mut().or(it.shortest.as_mut())?, k),
        (Constraint::Limits(it), "shortest") => one(it.shortest.as_mut()?, k),
        (Constraint::Limits(it), "longest") => one(it.longest.as_mut()?, k),
        (Constraint::Limits(it), "restitution") => one(&mut it.restitution, k),
        (Constraint::Limits(it), "breaks_at") => one(it.breaks_at.as_mut()?, k),
        (Constraint::Limits(it), "breaks_at_impulse") => one(it.breaks_at_impulse.as_mut()?, k),
        (Constraint::Limits(it), "stiffness") => one(&mut it.stiffness, k),
        (Constraint::Obstacle(it), "restitution") => one(&mut it.restitution, k),
        (Constraint::Obstacle(it), "friction") => one(&mut it.friction, k),
        (Constraint::Obstacle(it), _) => of_surface(&mut it.surface, key, k),
        (Constraint::Relation(it), "at") => component(&mut it.point, k),
        (Constraint::Lengths(it), "length") => constant(&mut it.total, k),
        (Constraint::Angle(it), "angle") => constant(&mut it.angle, k),
        (Constraint::Gears(it), "angle") => constant(&mut it.angle, k),
        (Constraint::Area(it), "area") => constant(&mut it.area, k),
        (Constraint::Volume(it), "volume") => constant(&mut it.volume, k),
        (Constraint::Direction(it), "along") => component(&mut it.along, k),
        (Constraint::OnLine(it), _) => match (&mut it.line, key) {
            (Line::Through(point, _), "at") => component(point, k),
            (Line::Through(_, along), "along") => component(along, k),
            _ => None,
        },
        (Constraint::OnPlane(it), _) => match (&mut it.plane, key) {
            (Plane::Across(point, _), "at") => component(point, k),
            (Plane::Across(_, normal), "normal") => component(normal, k),
            _ => None,
        },
        (Constraint::OnSphere(it), "radius" | "length") => constant(&mut it.radius, k),
        (Constraint::OnSphere(it), "stiffness") => one(&mut it.stiffness, k),
        (Constraint::OnSphere(it), "center") => anchored(&mut it.center, k),
        (Constraint::OnCircle(it), "radius") => constant(&mut it.radius, k),
        (Constraint::OnCircle(it), "axis") => it.axis.get_mut(k),
        (Constraint::OnCircle(it), "center") => anchored(&mut it.center, k),
        (Constraint::OnEllipse(it), "half_along") => constant(&mut it.half[0], k),
        (Constraint::OnEllipse(it), "half_across") => constant(&mut it.half[1], k),
        (Constraint::OnEllipse(it), "along") => it.along.get_mut(k),
        (Constraint::OnEllipse(it), "center") => anchored(&mut it.center, k),
        _ => None,
    }
}

/// The number of a force under a key; `None` if the kind has no such number.
pub(super) fn of_force<'a>(force: &'a mut Force, key: &str, k: usize) -> Option<&'a mut f64> {
    match (force, key) {
        (Force::Gravity(it), "acceleration") => it.acceleration.get_mut(k),
        (Force::Drag(it), "coefficient") => one(&mut it.coefficient, k),
        (Force::Spring(it), "stiffness") => one(&mut it.stiffness, k),
        (Force::Spring(it), "damping") => one(&mut it.damping, k),
        (Force::Spring(it), "rest") => one(&mut it.rest, k),
        (Force::PointForce(it), "force") => it.force.get_mut(k),
        (Force::HarmonicForce(it), "force") => it.amplitude.get_mut(k),
        (Force::HarmonicForce(it), "angular_frequency") => one(&mut it.angular_frequency, k),
        (Force::HarmonicForce(it), "phase") => one(&mut it.phase, k),
        (Force::Actuator(it), "push") => one(&mut it.push, k),
        (Force::Actuator(it), "amplitude") => one(&mut it.amplitude, k),
        (Force::Actuator(it), "angular_frequency") => one(&mut it.angular_frequency, k),
        (Force::Actuator(it), "phase") => one(&mut it.phase, k),
        (Force::CubicSpring(it), "stiffness") => one(&mut it.stiffness, k),
        (Force::CubicSpring(it), "cubic") => one(&mut it.cubic, k),
        (Force::CubicSpring(it), "damping") => one(&mut it.damping, k),
        (Force::CubicSpring(it), "rest") => one(&mut it.rest, k),
        (Force::TorsionSpring(it), "stiffness") => one(&mut it.stiffness, k),
        (Force::TorsionSpring(it), "damping") => one(&mut it.damping, k),
        (Force::TorsionSpring(it), "angle") => one(&mut it.angle, k),
        (Force::CentralForce(it), "center") => it.center.get_mut(k),
        (Force::CentralForce(it), "softening") => one(&mut it.softening, k),
        (Force::InverseSquare(it), "softening") => one(&mut it.softening, k),
        (Force::AirDrag(it), "linear") => one(&mut it.linear, k),
        (Force::AirDrag(it), "quadratic") => one(&mut it.quadratic, k),
        (Force::AirDrag(it), "wind") => it.wind.get_mut(k),
        (Force::Pressure(it), "pressure") => one(&mut it.pressure, k),
        _ => None,
    }
}

/// The number of the feedback under a key.
pub(super) fn of_feedback<'a>(feedback: &'a mut Feedback, key: &str) -> Option<&'a mut f64> {
    match key {
        "ks" => Some(&mut feedback.ks),
        "kd" => Some(&mut feedback.kd),
        "diagonal_drag" => Some(&mut feedback.diagonal_drag),
        "elasticity" => Some(&mut feedback.elasticity),
        _ => None,
    }
}

fn of_surface<'a>(surface: &'a mut Surface, key: &str, k: usize) -> Option<&'a mut f64> {
    match (surface, key) {
        (Surface::Ball { center, .. } | Surface::Box { center, .. }, "center") => center.get_mut(k),
        (Surface::Ball { radius, .. }, "radius") => one(radius, k),
        _ => None,
    }
}

/// A number that is no vector.
fn one(number: &mut f64, k: usize) -> Option<&mut f64> {
    (k == 0).then_some(number)
}

/// A number that may be driven, where it is not.
fn constant(driven: &mut Driven, k: usize) -> Option<&mut f64> {
    match driven {
        Driven::Constant(number) => one(number, k),
        Driven::Function(_) => None,
    }
}

/// A component of a point that may be driven.
fn component(point: &mut DrivenPoint, k: usize) -> Option<&mut f64> {
    constant(point.get_mut(k)?, 0)
}

/// A component of an anchor that is a point.
fn anchored(anchor: &mut Anchor, k: usize) -> Option<&mut f64> {
    match anchor {
        Anchor::Point(point) => component(point, k),
        Anchor::Particle(_) => None,
    }
}
