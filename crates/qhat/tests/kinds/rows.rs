//! Rows of several constraints together, the state vector that they act on, and their two formulations.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close};
use crate::systems::random::{Random, dimension};
use qhat::{Dimension, Distance, Formulation, Particle, State, System, evaluate};

/// The rows of several constraints stand one below the other, each with its own blocks.
#[test]
fn rows_stand_in_the_order_of_the_constraints() {
    let mut random = Random::new(11);
    for d in [2, 3] {
        let (system, state) = systems::random::web(&mut random, d, 9);
        let terms = evaluate(&system, &state);
        for named in system.constraints() {
            let mut alone = System::builder(dimension(d));
            for (i, x) in state.positions().chunks(d).enumerate() {
                let v = &state.velocities()[i * d..(i + 1) * d];
                alone.particle(Particle::at(format!("p{i}"), x).with_velocity(v));
            }
            alone.constraint("alone", named.constraint.clone());
            let (lone_system, lone_state) = alone.build().unwrap();
            let lone = evaluate(&lone_system, &lone_state);
            let m = lone_system.row_count();
            let rows = named.first_row..named.first_row + m;
            assert_eq!(terms.residual[rows.clone()], lone.residual, "C of {}", named.name);
            assert_eq!(terms.residual_rate[rows.clone()], lone.residual_rate, "Ċ of {}", named.name);
            assert_eq!(terms.acceleration_bias[rows.clone()], lone.acceleration_bias, "γ of {}", named.name);
            let N = system.coordinate_count();
            let J = terms.jacobian.to_dense();
            assert_eq!(J[rows.start * N..rows.end * N], lone.jacobian.to_dense(), "J of {}", named.name);
            let name = if m == 1 { named.name.clone() } else { format!("{}.x", named.name) };
            assert_eq!(system.row_names()[rows.start], name);
        }
    }
}

/// The state vector of the source: q = [x1, y1, x2, y2 …], and q̇ beside it.
#[test]
fn state_vector_is_particle_after_particle() {
    let mut builder = System::builder(qhat::Dimension::Two);
    builder.particle(Particle::at("a", [1.0, 2.0]).with_velocity([5.0, 6.0]).with_mass(4.0));
    builder.particle(Particle::at("b", [3.0, 4.0]).fixed());
    let (system, state) = builder.build().unwrap();
    assert_eq!(state.positions(), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(state.velocities(), [5.0, 6.0, 0.0, 0.0]);
    let terms = evaluate(&system, &state);
    assert_eq!((terms.positions, terms.velocities), (state.positions().to_vec(), state.velocities().to_vec()));
    assert_eq!(terms.inverse_masses, [0.25, 0.0], "W is 1/m, and 0 for what is fixed");
}

/// The length of `rod`.
const R: f64 = 1.3;

/// A rod between two of three particles anywhere in space.
fn rod(random: &mut Random) -> (System, State) {
    let mut builder = System::builder(Dimension::Three);
    for (i, x) in random.points(3, 3, 0.8).into_iter().enumerate() {
        let v = random.numbers(3, -0.5, 0.5);
        builder.particle(Particle::at(format!("p{i}"), x).with_velocity(v));
    }
    builder.constraint("it", Distance::new(crate::systems::id(2), crate::systems::id(0), R));
    builder.build().unwrap()
}

/// The change to the classic forms and back changes the rows and not the positions that they allow.
#[test]
fn formulations_hold_the_same_places() {
    let mut random = Random::new(3);
    let (system, state) = rod(&mut random);
    let classic = system.with_formulation(Formulation::Classic);
    let (length, squared) = (evaluate(&system, &state), evaluate(&classic, &state));
    let distance = length.residual[0] + R;
    // d·d − r² = (|d| − r)(|d| + r).
    assert_close("squared C", squared.residual[0], length.residual[0] * (distance + R), 1e-13);
    let back = evaluate(&classic.with_formulation(Formulation::Modern), &state);
    assert_eq!(back, length);
    // The same motion: q̈ equals q̈ of the length form plus a drift of the squared form that is zero on C = 0, Ċ = 0.
    let (system, state) = systems::double_pendulum();
    let classic = system.with_formulation(Formulation::Classic);
    let (a, b) = (evaluate(&system, &state), evaluate(&classic, &state));
    // 30 m/s² and roundoff of a 2 × 2 solve.
    assert_all_close("q̈", &a.accelerations, &b.accelerations, 1e-12);
    assert_all_close("tension", &a.tension, &b.tension, 1e-12);
}
