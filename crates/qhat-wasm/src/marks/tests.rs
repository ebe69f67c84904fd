#![expect(non_snake_case, reason = "the corners of a square are A, B, C, D")]

use super::*;
use qhat::{Angle, Area, Curve, Dimension, Expression, Lengths, OnCurve, OnLine, Particle, Purpose, Scope};

/// The corners of the square.
fn corners() -> [ParticleId; 4] {
    let mut builder = System::builder(Dimension::Two);
    ["a", "b", "c", "d"].map(|name| builder.particle(Particle::at(name, [0.0; 2])))
}

fn expression(text: &str, purpose: Purpose) -> Expression {
    Expression::parse(text, &Scope::new(purpose, Dimension::Two, &|_| None)).unwrap()
}

/// The marks of constraints on the corners of a square of 3 m, at t.
fn drawn(constraints: impl IntoIterator<Item = Constraint>, t: f64) -> Vec<Mark> {
    let mut builder = System::builder(Dimension::Two);
    for (name, at) in [("a", [0.0, 0.0]), ("b", [3.0, 0.0]), ("c", [3.0, 3.0]), ("d", [0.0, 3.0])] {
        builder.particle(Particle::at(name, at));
    }
    for (i, constraint) in constraints.into_iter().enumerate() {
        builder.constraint(format!("{i}"), constraint);
    }
    let (system, state) = builder.build().unwrap();
    marks(&system, &state, t)
}

fn kinds(marks: &[Mark]) -> Vec<&'static str> {
    marks.iter().map(|mark| mark.kind).collect()
}

#[test]
fn a_pulley_is_a_cord_and_a_ratio_ties() {
    let [A, B, C, D] = corners();
    let cord = drawn([Lengths::pulley(&[A, B, C], 6.0).into()], 0.0);
    assert_eq!(kinds(&cord), ["cord", "cord"]);
    assert_eq!(cord[1].particles, [B, C]);
    assert_eq!(kinds(&drawn([Lengths::ratio([A, B], [A, D], 1.0).into()], 0.0)), ["tie", "tie"]);
}

#[test]
fn a_rope_and_a_strut_know_their_limits() {
    let [A, B, _, _] = corners();
    let limits = [Limits::rope(A, B, 4.0), Limits::strut(A, B, 2.0), Limits::between(A, B, 1.0, 4.0)];
    let drawn = drawn(limits.map(Constraint::from), 0.0);
    assert_eq!(kinds(&drawn), ["rope", "strut", "strut"]);
    assert_eq!(drawn.iter().map(|mark| mark.size).collect::<Vec<_>>(), [4.0, 2.0, 1.0]);
}

#[test]
fn what_is_led_moves_with_time_and_nothing_else_does() {
    let [A, B, C, _] = corners();
    let radius = Driven::Function(expression("3 + sin(t)", Purpose::Time));
    let rod = || Constraint::from(OnSphere::new(B, A, radius.clone()));
    let rail = Constraint::from(OnLine::fixed(C, [0.0, 3.0, 0.0], [1.0, 0.0, 0.0]));
    let [first, later] = [0.0, 1.0].map(|t| drawn([rod(), rail.clone()], t));
    assert_eq!(kinds(&first), ["rod", "line"]);
    assert_eq!((first[0].size, first[0].particles.as_slice()), (3.0, [A, B].as_slice()));
    assert!((later[0].size - (3.0 + 1.0f64.sin())).abs() < 1e-12); // two sines, a rounding apart
    assert_eq!((first[0].driven, first[1].driven), (true, false));
    assert_eq!(first[1], later[1]);
}

#[test]
fn a_wire_is_drawn_from_end_to_end_once() {
    let [A, B, _, _] = corners();
    let path = ["s", "s^2"].map(|text| expression(text, Purpose::Curve)).to_vec();
    let curve = Curve::parametric(path, 0.0, 3.0).unwrap();
    let bead = |particle| Constraint::from(OnCurve { particle, curve: curve.clone() });
    let wires = drawn([bead(A), bead(B)], 0.0);
    assert_eq!(kinds(&wires), ["wire"]);
    assert_eq!(wires[0].points.first(), Some(&[0.0, 0.0, 0.0]));
    assert_eq!(wires[0].points.last(), Some(&[3.0, 9.0, 0.0]));
}

#[test]
fn ground_that_many_meet_is_drawn_once_with_a_unit_normal() {
    let [A, B, C, _] = corners();
    let surface = Surface::HalfSpace { normal: [0.0, 2.0, 0.0], offset: -1.0 };
    let ground = drawn([A, B, C].map(|particle| Obstacle::new(particle, surface.clone()).into()), 0.0);
    assert_eq!(kinds(&ground), ["ground"]);
    assert_eq!(ground[0].points, [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn wheels_meet_between_their_centres_and_a_rack_touches_its_pinion() {
    let [A, B, C, D] = corners();
    let wheels = drawn([Gears::mesh([[A, D], [B, C]], [20, 10], 0.0).into()], 0.0);
    assert_eq!(kinds(&wheels), ["wheel", "wheel"]);
    assert_eq!((wheels[0].size, wheels[1].size), (2.0, 1.0));
    let rack = drawn([Gears::rack([A, D], B, [1.0, 0.0], 0.5, 0.0).into()], 0.0);
    assert_eq!(kinds(&rack), ["wheel", "line"]);
    assert_eq!((rack[0].size, rack[1].particles.as_slice()), (0.5, [B].as_slice()));
}

#[test]
fn a_lone_relation_is_a_nail_and_a_tie_begins_at_its_first_particle() {
    let [A, B, C, _] = corners();
    let point = [2.0, 4.0, 0.0].map(Driven::Constant);
    let nail = drawn([Relation { terms: vec![(A, 2.0)], point }.into()], 0.0);
    assert_eq!((nail[0].kind, nail[0].points.as_slice()), ("nail", [[1.0, 2.0, 0.0]].as_slice()));
    let middle = drawn([Relation::midpoint(C, A, B).into()], 0.0);
    assert_eq!(middle.iter().map(|mark| mark.particles.clone()).collect::<Vec<_>>(), [[C, A], [C, B]]);
    let center = Relation::center_of_mass([(A, 1.0), (B, 1.0)], [0.0; 3].map(Driven::Constant));
    assert_eq!(drawn([center.into()], 0.0), []);
}

#[test]
fn angles_have_two_arms_or_a_direction_and_areas_their_corners() {
    let [A, B, C, D] = corners();
    let right = std::f64::consts::FRAC_PI_2;
    let angle = Angle::between([A, B], [A, D], right);
    let turned = Angle::from_direction([1.0, 0.0, 0.0], [A, D], right);
    let area = Area { corners: vec![A, B, C, D], area: Driven::Constant(9.0) };
    let all = drawn([angle.into(), turned.into(), area.into()], 0.0);
    assert_eq!(kinds(&all), ["angle", "angle", "area"]);
    assert_eq!(all[0].particles, [A, B, A, D]);
    assert_eq!(
        (all[1].particles.as_slice(), all[1].points.as_slice()),
        ([A, D].as_slice(), [[1.0, 0.0, 0.0]].as_slice())
    );
    assert_eq!(all[2].particles, [A, B, C, D]);
}
