//! Input that each kind refuses before the run, with messages that say what to do.

use super::case::{P, parse};
use super::motion::curve;
use crate::systems::random::dimension;
use qhat::{
    Anchor, Angle, Area, Constraint, Curve, Dimension, Direction, Driven, Gears, GeometryError, Lengths, OnCircle,
    OnCurve, OnLine, OnPlane, OnSphere, Particle, ParticleId, Purpose, System, Volume,
};

#[test]
fn lengths_angles_gears_areas_and_volumes_that_cannot_be() {
    let refuse = |d: usize, constraint: Constraint, words: &str| {
        let mut builder = System::builder(dimension(d));
        for i in 0..6 {
            let x = [i as f64, (i * i) as f64, (i % 3) as f64];
            builder.particle(Particle::at(format!("p{i}"), &x[..d]));
        }
        builder.constraint("it", constraint);
        let error = builder.build().expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    };
    refuse(2, Lengths::pulley(&P[..1], 1.0).into(), "two points at least");
    refuse(2, Lengths::pulley(&[P[0], P[0]], 1.0).into(), "from one particle to another");
    refuse(2, Lengths::pulley(&P[..3], -1.0).into(), "above 0");
    refuse(2, Lengths::ratio([P[0], P[1]], [P[2], P[3]], 0.0).into(), "weight 0");
    refuse(2, Lengths::ratio([P[0], P[1]], [P[2], P[3]], f64::NAN).into(), "finite");
    refuse(2, Angle::between([P[0], P[0]], [P[1], P[2]], 1.0).into(), "one particle to another");
    refuse(2, Angle::from_direction([0.0; 3], [P[1], P[2]], 1.0).into(), "needs a length");
    refuse(2, Gears::mesh([[P[0], P[1]], [P[0], P[2]]], [2, 3], 0.0).into(), "two centres");
    refuse(2, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [0, 3], 0.0).into(), "without teeth");
    refuse(2, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [i32::MIN, i32::MAX], 0.0).into(), "at most 1000");
    refuse(2, Gears::rack([P[0], P[1]], P[2], [0.0, 0.0], 1.0, 0.0).into(), "finite");
    refuse(3, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [2, 3], 0.0).into(), "2 dimensions");
    refuse(2, Area { corners: P[..2].to_vec(), area: 1.0.into() }.into(), "three corners");
    refuse(2, Area { corners: vec![P[0], P[1], P[0], P[2]], area: 1.0.into() }.into(), "one corner");
    refuse(3, Area { corners: P[..3].to_vec(), area: 1.0.into() }.into(), "2 dimensions");
    refuse(2, Volume::tetrahedron([P[0], P[1], P[2], P[3]], 1.0).into(), "3 dimensions");
    refuse(3, Volume::new(&[[P[0], P[1], P[2]]], 1.0).into(), "not closed");
    refuse(3, Volume::tetrahedron([P[0], P[1], P[1], P[3]], 1.0).into(), "three different corners");
    refuse(3, Volume::new(&[[P[0], P[1], P[2]], [P[0], P[1], P[3]]], 1.0).into(), "turn one of them round");
    let named = parse("p0.x", Purpose::Constraint, 2);
    refuse(2, Lengths::pulley(&P[..3], named).into(), "nothing but t");
}

#[test]
fn directions_lines_surfaces_and_curves_that_cannot_be() {
    let refused = |dimension: Dimension, make: fn(ParticleId, ParticleId) -> Constraint, words: &str| {
        let mut builder = System::builder(dimension);
        let d = dimension.number();
        let [a, b] = ["a", "b"].map(|name| builder.particle(Particle::at(name, vec![name.len() as f64; d])));
        builder.constraint("c", make(a, b));
        let error = builder.build().unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let (two, three) = (Dimension::Two, Dimension::Three);
    refused(two, |a, _| Direction::new(a, a, [1.0, 0.0, 0.0]).into(), "named twice");
    refused(two, |a, b| Direction::new(a, b, [0.0, 0.0, 1.0]).into(), "must not be zero");
    refused(three, |a, b| OnLine::through(a, b, b).into(), "named twice");
    refused(two, |a, _| OnPlane::fixed(a, [0.0; 3], [0.0, 1.0, 0.0]).into(), "needs three dimensions");
    refused(three, |a, b| OnPlane::through(a, [a, b, b]).into(), "named twice");
    refused(three, |a, _| OnPlane::fixed(a, [0.0; 3], [0.0; 3]).into(), "must not be zero");
    refused(two, |a, _| OnSphere::new(a, a, 1.0).into(), "named twice");
    refused(two, |a, b| OnSphere::new(a, b, 0.0).into(), "must be positive");
    refused(two, |a, _| OnSphere::new(a, Anchor::Point([f64::NAN; 3].map(Driven::Constant)), 1.0).into(), "finite");
    refused(two, |a, b| OnCircle::new(a, b, [0.0, 0.0, 1.0], 1.0).into(), "needs three dimensions");
    refused(three, |a, _| OnCurve { particle: a, curve: curve(&["s", "s"], 0.0, 1.0) }.into(), "3 components");
    let not_a_curve = |made: Result<Curve, GeometryError>, words: &str| {
        assert!(made.unwrap_err().to_string().contains(words));
    };
    not_a_curve(Curve::through(&[[0.0; 3]], false), "needs 2 points");
    not_a_curve(Curve::through(&[[0.0; 3], [0.0; 3]], false), "at one place");
    not_a_curve(Curve::polyline(&[[0.0; 3], [1.0, 0.0, 0.0]], -1.0, false), "must be positive");
    let s = || parse("s", Purpose::Curve, 2);
    not_a_curve(Curve::parametric(vec![s()], 0.0, 1.0), "2 or 3 components");
    not_a_curve(Curve::parametric(vec![s(), s()], 1.0, 0.0), "must grow");
    let root = parse("1/s", Purpose::Curve, 2);
    not_a_curve(Curve::parametric(vec![s(), root], 0.0, 1.0), "not finite");
}
