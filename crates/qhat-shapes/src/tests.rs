//! The list of shapes: kinds, particles, points and sizes of every family, and the changes with time.

#![expect(non_snake_case, reason = "the corners of a square are A, B, C, D")]

use super::*;
use ShapeKind::{DrivenRod, Ground, Line, Rod, Rope, Strut, Tie, Wheel, Wire};
use qhat::{
    Angle, Area, Constraint, CubicSpring, Curve, Dimension, Distance, Driven, Expression, Gears, Gravity, Lengths,
    Limits, Nail, Obstacle, OnCurve, OnLine, OnSphere, Particle, ParticleId, Purpose, Relation, Scope, Spring, Surface,
    System,
};

/// The corners of the square.
fn corners() -> [ParticleId; 4] {
    let mut builder = System::builder(Dimension::Two);
    ["a", "b", "c", "d"].map(|name| builder.particle(Particle::at(name, [0.0; 2])))
}

fn expression(text: &str, purpose: Purpose) -> Expression {
    Expression::parse(text, &Scope::new(purpose, Dimension::Two, &|_| None)).unwrap()
}

/// A system of constraints on the corners of a square of 3 m.
fn system(constraints: impl IntoIterator<Item = Constraint>) -> (System, qhat::State) {
    let mut builder = System::builder(Dimension::Two);
    for (name, at) in [("a", [0.0, 0.0]), ("b", [3.0, 0.0]), ("c", [3.0, 3.0]), ("d", [0.0, 3.0])] {
        builder.particle(Particle::at(name, at));
    }
    for (i, constraint) in constraints.into_iter().enumerate() {
        builder.constraint(format!("{i}"), constraint);
    }
    builder.build().unwrap()
}

/// The shapes of constraints on the corners of a square of 3 m.
fn drawn(constraints: impl IntoIterator<Item = Constraint>) -> Vec<Shape> {
    let (system, state) = system(constraints);
    shapes(&system, &state)
}

fn kinds(shapes: &[Shape]) -> Vec<ShapeKind> {
    shapes.iter().map(|shape| shape.kind).collect()
}

#[test]
fn a_pulley_is_a_cord_and_a_ratio_ties() {
    let [A, B, C, D] = corners();
    let cord = drawn([Lengths::pulley(&[A, B, C], 6.0).into()]);
    assert_eq!(kinds(&cord), [ShapeKind::Cord; 2]);
    assert_eq!(cord[1].particles, [B, C]);
    assert_eq!(kinds(&drawn([Lengths::ratio([A, B], [A, D], 1.0).into()])), [Tie, Tie]);
}

#[test]
fn a_rope_and_a_strut_know_their_limits() {
    let [A, B, _, _] = corners();
    let limits = [Limits::rope(A, B, 4.0), Limits::strut(A, B, 2.0), Limits::between(A, B, 1.0, 4.0)];
    let drawn = drawn(limits.map(Constraint::from));
    assert_eq!(kinds(&drawn), [Rope, Strut, Strut]);
    assert_eq!(drawn.iter().map(|shape| shape.size).collect::<Vec<_>>(), [4.0, 2.0, 1.0]);
}

#[test]
fn links_know_their_place_and_every_shape_its_source() {
    let [A, B, C, D] = corners();
    let rod = |a, b| Constraint::from(Distance::new(a, b, 3.0));
    let (mut builder, names) = (System::builder(Dimension::Two), ["a", "b", "c", "d"]);
    for (name, at) in names.into_iter().zip([[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]]) {
        builder.particle(Particle::at(name, at));
    }
    builder.constraint("nail", Nail::new(A, [0.0; 3]));
    builder.with_constraint("ab", rod(A, B)).with_constraint("bc", Limits::rope(B, C, 4.0)).constraint("cd", rod(C, D));
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder.force(Spring { a: A, b: D, stiffness: 1.0, damping: 0.0, rest: 2.0 });
    builder.force(CubicSpring { a: B, b: D, stiffness: 1.0, cubic: 0.0, damping: 0.0, rest: 1.0 });
    let (system, state) = builder.build().unwrap();
    let all = shapes(&system, &state);
    assert_eq!(kinds(&all), [ShapeKind::Nail, Rod, Rope, Rod, ShapeKind::Spring, ShapeKind::Spring]);
    let sources = [0, 1, 2, 3].map(Source::Constraint).into_iter().chain([1, 2].map(Source::Force));
    assert!(all.iter().map(|shape| shape.of).eq(sources), "{all:?}");
    assert_eq!(all.iter().map(|shape| shape.size).collect::<Vec<_>>(), [0.0, 3.0, 4.0, 3.0, 2.0, 1.0]);
    for (place, link) in system.links().enumerate() {
        let shape = all.iter().find(|shape| shape.link == Some(place)).unwrap();
        assert_eq!(shape.particles, [link.a, link.b]);
        let Source::Constraint(i) = shape.of else { panic!("{shape:?}") };
        assert_eq!(system.constraints()[i].name, link.name);
    }
    assert_eq!(all.iter().filter(|shape| shape.link.is_some()).count(), 3);
}

#[test]
fn driven_shapes_move_with_time_and_no_others_do() {
    let [A, B, C, _] = corners();
    let radius = Driven::Function(expression("3 + sin(t)", Purpose::Time));
    let rail = OnLine::fixed(C, [0.0, 3.0, 0.0], [1.0, 0.0, 0.0]).into();
    let (system, state) = system([rail, OnSphere::new(B, A, radius).into()]);
    let all = shapes(&system, &state);
    assert_eq!(kinds(&all), [Line, DrivenRod]);
    assert_eq!((all[0].driven, all[1].driven), (false, true));
    assert_eq!((all[1].size, all[1].particles.as_slice()), (3.0, [A, B].as_slice()));
    assert_eq!(driven_shapes(&system, &state, 0.0), all[1..]);
    let later = driven_shapes(&system, &state, 1.0);
    assert_eq!(later.len(), 1);
    assert!((later[0].size - (3.0 + 1.0f64.sin())).abs() < 1e-12); // two sines, a rounding apart
}

#[test]
fn a_wire_is_drawn_from_end_to_end_once() {
    let [A, B, _, _] = corners();
    let path = ["s", "s^2"].map(|text| expression(text, Purpose::Curve)).to_vec();
    let curve = Curve::parametric(path, 0.0, 3.0).unwrap();
    let bead = |particle| Constraint::from(OnCurve { particle, curve: curve.clone() });
    let wires = drawn([bead(A), bead(B)]);
    assert_eq!(kinds(&wires), [Wire]);
    assert_eq!(wires[0].points.first(), Some(&[0.0, 0.0, 0.0]));
    assert_eq!(wires[0].points.last(), Some(&[3.0, 9.0, 0.0]));
}

#[test]
fn ground_that_many_meet_is_drawn_once_with_a_unit_normal() {
    let [A, B, C, _] = corners();
    let surface = Surface::HalfSpace { normal: [0.0, 2.0, 0.0], offset: -1.0 };
    let ground = drawn([A, B, C].map(|particle| Obstacle::new(particle, surface.clone()).into()));
    assert_eq!(kinds(&ground), [Ground]);
    assert_eq!(ground[0].points, [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn wheels_meet_between_their_centres_and_a_rack_touches_its_pinion() {
    let [A, B, C, D] = corners();
    let wheels = drawn([Gears::mesh([[A, D], [B, C]], [20, 10], 0.0).into()]);
    assert_eq!(kinds(&wheels), [Wheel, Wheel]);
    assert_eq!((wheels[0].size, wheels[1].size), (2.0, 1.0));
    let rack = drawn([Gears::rack([A, D], B, [1.0, 0.0], 0.5, 0.0).into()]);
    assert_eq!(kinds(&rack), [Wheel, Line]);
    assert_eq!((rack[0].size, rack[1].particles.as_slice()), (0.5, [B].as_slice()));
}

#[test]
fn a_lone_relation_is_a_nail_and_a_tie_begins_at_its_first_particle() {
    let [A, B, C, _] = corners();
    let point = [2.0, 4.0, 0.0].map(Driven::Constant);
    let nail = drawn([Relation { terms: vec![(A, 2.0)], point }.into()]);
    assert_eq!((nail[0].kind, nail[0].points.as_slice()), (ShapeKind::Nail, [[1.0, 2.0, 0.0]].as_slice()));
    let middle = drawn([Relation::midpoint(C, A, B).into()]);
    assert_eq!(middle.iter().map(|shape| shape.particles.clone()).collect::<Vec<_>>(), [[C, A], [C, B]]);
    let center = Relation::center_of_mass([(A, 1.0), (B, 1.0)], [0.0; 3].map(Driven::Constant));
    assert_eq!(drawn([center.into()]), []);
}

#[test]
fn angles_have_two_arms_or_a_direction_and_areas_their_corners() {
    let [A, B, C, D] = corners();
    let right = std::f64::consts::FRAC_PI_2;
    let angle = Angle::between([A, B], [A, D], right);
    let turned = Angle::from_direction([1.0, 0.0, 0.0], [A, D], right);
    let area = Area { corners: vec![A, B, C, D], area: Driven::Constant(9.0) };
    let all = drawn([angle.into(), turned.into(), area.into()]);
    assert_eq!(kinds(&all), [ShapeKind::Angle, ShapeKind::Angle, ShapeKind::Area]);
    assert_eq!(all[0].particles, [A, B, A, D]);
    assert_eq!(
        (all[1].particles.as_slice(), all[1].points.as_slice()),
        ([A, D].as_slice(), [[1.0, 0.0, 0.0]].as_slice())
    );
    assert_eq!(all[2].particles, [A, B, C, D]);
}

/// The engine's enums may grow, so the compiler does not ask for a kind that this crate forgot.
#[test]
fn every_kind_is_named_here() {
    let missing = |source: &str, of: &str, kinds: &[&str]| -> Vec<String> {
        let names = kinds.iter().map(|kind| format!("{of}::{kind}("));
        names.filter(|name| !source.contains(name)).collect()
    };
    let mut found = missing(include_str!("constraint.rs"), "Constraint", qhat::Constraint::KINDS);
    found.extend(missing(include_str!("force.rs"), "Force", qhat::Force::KINDS));
    assert!(found.is_empty(), "crates/qhat-shapes/src does not say how to draw {found:?}");
}
