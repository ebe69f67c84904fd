//! Every kind at positions where it has no gradient.

use super::case::{P, slopes_in_time};
use super::motion::curve;
use crate::systems::random::dimension;
use qhat::{
    Angle, Area, Constraint, Distance, Gears, Lengths, OnCurve, OnSphere, Particle, Settings, Simulation, System,
    Volume, evaluate,
};

/// A step from a position without a gradient ends in an error or succeeds: no panic, and no NaN in the state.
#[test]
fn singular_places_end_in_an_error_or_in_numbers() {
    let start = |d: usize, constraint: Constraint| {
        let mut builder = System::builder(dimension(d));
        for i in 0..6 {
            let x = [if i < 2 { 0.0 } else { i as f64 }, 0.0, 0.0];
            builder.particle(Particle::at(format!("p{i}"), &x[..d]).with_velocity(vec![0.1; d]));
        }
        builder.with_constraint("anchor", Distance::new(P[4], P[5], 1.0)).constraint("it", constraint);
        let (system, state) = builder.build().unwrap();
        let outcome = Simulation::new(system, state, Settings::default()).and_then(|mut simulation| {
            simulation.step()?;
            Ok(simulation.state().positions().to_vec())
        });
        match outcome {
            Ok(positions) => assert!(positions.iter().all(|x| x.is_finite())),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    };
    start(2, Lengths::pulley(&P[..3], 2.0).into());
    start(2, Lengths::ratio([P[0], P[1]], [P[2], P[3]], 1.0).into());
    start(2, Angle::between([P[0], P[1]], [P[2], P[3]], 1.0).into());
    start(2, Angle::from_direction([1.0, 0.0, 0.0], [P[2], P[3]], std::f64::consts::PI).into());
    start(3, Angle::between([P[2], P[3]], [P[3], P[4]], 1.0).into());
    start(2, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [2, 3], 1.0).into());
    start(2, Area { corners: P[..4].to_vec(), area: 1.0.into() }.into());
    start(3, Volume::tetrahedron([P[0], P[1], P[2], P[3]], 1.0).into());
}

/// The rows stay finite where a direction does not exist and where the foot is about to jump.
#[test]
fn rows_are_finite_without_a_direction_and_where_the_foot_jumps() {
    let finite = |constraint: Constraint| {
        let mut builder = System::builder(dimension(2));
        for name in ["p0", "p1"] {
            builder.particle(Particle::at(name, [0.0; 2]).with_velocity([0.3, -0.7]));
        }
        builder.constraint("it", constraint);
        let (system, state) = builder.build().unwrap();
        let terms = evaluate(&system, &state);
        let Ct = slopes_in_time(&terms);
        let rows = [&terms.residual[..], &terms.residual_rate, &terms.acceleration_bias, &Ct];
        let all = [rows.concat(), terms.jacobian.to_dense()].concat();
        assert!(all.iter().all(|number| number.is_finite()), "{all:?}");
    };
    finite(OnSphere::new(P[1], P[0], 1.0).into());
    let wire = |x: &str, y: &str| OnCurve { particle: P[1], curve: curve(&[x, y], 0.0, 6.0) };
    // The centre of a circle, and the cusp of a cycloid.
    finite(wire("cos(s)", "sin(s)").into());
    finite(wire("s - sin(s)", "cos(s) - 1").into());
}
