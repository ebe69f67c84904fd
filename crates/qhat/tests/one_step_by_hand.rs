//! One step of each explicit method by its formula, bit for bit, from the accelerations of `evaluate`; and the
//! effect of each on the energy of an oscillator.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close};
use crate::systems::random::{Random, web};
use qhat::{Dimension, Integrator, MouseSpring, Particle, State, System, Workspace, evaluate, step};

const H: f64 = 1e-3;

fn stepped(system: &System, state: &State, integrator: Integrator) -> State {
    let mut next = state.clone();
    step(system, &mut next, &systems::settings(integrator, H), &mut Workspace::new(system)).unwrap();
    assert_eq!(next.time(), state.time() + H);
    next
}

/// x + h y.
fn moved(x: &[f64], y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x + H * y).collect()
}

fn webs() -> Vec<(System, State)> {
    let mut random = Random::new(31);
    [(2, 4), (3, 6), (2, 40)].map(|(d, n)| web(&mut random, d, n)).into()
}

/// q' = q + h q̇, q̇' = q̇ + h q̈: positions move with the old velocities.
#[test]
fn euler_step_of_the_source() {
    for (system, state) in webs() {
        let next = stepped(&system, &state, Integrator::Euler);
        assert_eq!(next.positions(), moved(state.positions(), state.velocities()));
        assert_eq!(next.velocities(), moved(state.velocities(), &evaluate(&system, &state).accelerations));
    }
}

/// q̇' = q̇ + h q̈, q' = q + h q̇': positions move with the new velocities.
#[test]
fn symplectic_euler_step() {
    for (system, state) in webs() {
        let next = stepped(&system, &state, Integrator::SymplecticEuler);
        assert_eq!(next.velocities(), moved(state.velocities(), &evaluate(&system, &state).accelerations));
        assert_eq!(next.positions(), moved(state.positions(), next.velocities()));
    }
}

/// The four slopes of Kutta, written out.
#[test]
fn rk4_step() {
    for (system, state) in webs() {
        let at = |q: Vec<f64>, v: Vec<f64>| {
            let slope = evaluate(&system, &state.with_motion(q, v.clone())).accelerations;
            (v, slope)
        };
        let (q, v) = (state.positions(), state.velocities());
        let along = |x: &[f64], c: f64, y: &[f64]| x.iter().zip(y).map(|(x, y)| x + c * H * y).collect::<Vec<_>>();
        let (v1, a1) = at(q.to_vec(), v.to_vec());
        let (v2, a2) = at(along(q, 0.5, &v1), along(v, 0.5, &a1));
        let (v3, a3) = at(along(q, 0.5, &v2), along(v, 0.5, &a2));
        let (v4, a4) = at(along(q, 1.0, &v3), along(v, 1.0, &a3));
        let mean = |s: [&[f64]; 4]| -> Vec<f64> {
            (0..q.len()).map(|k| (s[0][k] + 2.0 * s[1][k] + 2.0 * s[2][k] + s[3][k]) / 6.0).collect()
        };
        let next = stepped(&system, &state, Integrator::Rk4);
        // The engine sums in another order: roundoff of numbers of order one.
        assert_all_close("q", next.positions(), &moved(q, &mean([&v1, &v2, &v3, &v4])), 1e-14);
        assert_all_close("q̇", next.velocities(), &moved(v, &mean([&a1, &a2, &a3, &a4])), 1e-12);
    }
}

/// Without damping, explicit Euler multiplies the energy of an oscillator by 1 + h²ω² at every step, for every h. This
/// was the source's problem. Semi-implicit Euler keeps the energy within hω.
#[test]
fn euler_gains_energy_where_symplectic_euler_does_not() {
    let mut builder = System::builder(Dimension::Two);
    let it = builder.particle(Particle::at("it", [1.0, 0.0]));
    builder.force(MouseSpring { particle: it, target: [0.0; 3], stiffness: 100.0, damping: 0.0 }); // ω = 10 rad/s
    let (system, start) = builder.build().unwrap();
    let energy = |state: &State| {
        let (x, v) = (state.positions()[0], state.velocities()[0]);
        0.5 * v * v + 50.0 * x * x
    };
    for (integrator, low, high) in [(Integrator::Euler, 1.0, 1.3), (Integrator::SymplecticEuler, 0.99, 1.01)] {
        let mut state = start.clone();
        for k in 1..=2000 {
            state = stepped(&system, &state, integrator);
            let ratio = energy(&state) / 50.0;
            assert!(ratio >= low && ratio < high, "{integrator} after {k} steps: {ratio}");
            if integrator == Integrator::Euler {
                // (1 + 1e-4)^k, exactly but for roundoff.
                assert_close("energy", ratio, libm::exp(f64::from(k) * libm::log1p(1e-4)), 1e-12);
            }
        }
    }
}
