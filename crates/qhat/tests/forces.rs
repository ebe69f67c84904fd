//! The applied forces of every kind: Q against its formula, its conservative part against differences of the potential,
//! and the power of the rest against F·v.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close, dot, norm};
use crate::systems::random::{Random, dimension};
use qhat::{Drag, Force, Gravity, Integrator, MouseSpring, Particle, PointForce, Simulation, Spring, State};
use qhat::{System, evaluate, step};

const STATES: usize = 40;

fn build(random: &mut Random, d: usize, force: Force) -> (System, State) {
    let mut builder = System::builder(dimension(d));
    for (i, x) in random.points(3, d, 0.8).into_iter().enumerate() {
        let (m, v) = (random.within(0.5, 2.0), random.numbers(d, -0.5, 0.5));
        builder.particle(Particle::at(format!("p{i}"), x).with_velocity(v).with_mass(m));
    }
    builder.force(force);
    builder.build().unwrap()
}

/// V at other positions, through the public interface.
fn potential(system: &System, state: &State, q: Vec<f64>) -> f64 {
    let state = state.with_motion(q, state.velocities().to_vec());
    let settings = systems::settings(Integrator::Euler, 0.01);
    Simulation::new(system.clone(), state, settings).unwrap().energy().potential
}

/// dV/dτ along q + τ v, central difference of fourth order: δ⁴ V⁽⁵⁾/30 + ε V/δ < 1e-9 for the numbers of these tests.
fn slope(system: &System, state: &State, v: &[f64]) -> f64 {
    const DELTA: f64 = 1e-3;
    let at = |tau: f64| potential(system, state, state.positions().iter().zip(v).map(|(q, v)| q + tau * v).collect());
    (8.0 * (at(DELTA) - at(-DELTA)) - (at(2.0 * DELTA) - at(-2.0 * DELTA))) / (12.0 * DELTA)
}

/// Power of the forces without a potential, from the account of energy over a step so short that the motion hardly
/// changes.
fn booked_power(system: &System, state: &State) -> f64 {
    const H: f64 = 1e-10;
    let mut after = state.clone();
    let settings = systems::settings(Integrator::Euler, H);
    step(system, &mut after, &settings, &mut qhat::Workspace::new(system)).unwrap();
    after.work().dissipation / H
}

/// Q of one particle by the force's formula, given all x, v and m.
type Formula<'a> = &'a dyn Fn(usize, &[&[f64]], &[&[f64]], &[f64]) -> Vec<f64>;

fn check(make: impl Fn(&mut Random) -> Force, formula: Formula<'_>, takes_energy: bool) {
    let mut random = Random::new(5);
    for d in [2, 3] {
        for _ in 0..STATES {
            let force = make(&mut random);
            let (system, state) = build(&mut random, d, force);
            let (q, v) = (state.positions(), state.velocities());
            let (xs, vs) = (q.chunks(d).collect::<Vec<_>>(), v.chunks(d).collect::<Vec<_>>());
            let Q = evaluate(&system, &state).applied_forces;
            let expected: Vec<f64> = (0..3).flat_map(|i| formula(i, &xs, &vs, system.masses())).collect();
            // Roundoff of a few operations on numbers below 100.
            assert_all_close("Q", &Q, &expected, 1e-12);

            let at_rest = evaluate(&system, &state.with_motion(q.to_vec(), vec![0.0; q.len()])).applied_forces;
            for k in 0..q.len() {
                let axis: Vec<f64> = (0..q.len()).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
                assert_close("Q at rest = −∂V/∂q", at_rest[k], -slope(&system, &state, &axis), 1e-8);
            }
            let power = dot(&Q, v) + slope(&system, &state, v);
            // 1e-7: the difference above, and half the change of the power in 1e-10 s, at up to 1e3 W/s.
            assert_close("power booked = F·v + dV/dt", booked_power(&system, &state), power, 1e-7);
            assert!(if takes_energy { power < -1e-7 } else { power.abs() < 1e-8 }, "power {power}");
        }
    }
}

#[test]
fn gravity_is_mass_times_g() {
    const GRAVITY: [f64; 3] = [0.3, -9.81, 1.1];
    let formula = |i: usize, x: &[&[f64]], _: &[&[f64]], m: &[f64]| {
        GRAVITY[..x[i].len()].iter().map(|g| m[i] * g).collect::<Vec<_>>()
    };
    check(|_| Gravity { acceleration: GRAVITY }.into(), &formula, false);
}

#[test]
fn damping_acts_against_the_velocity() {
    let formula = |i: usize, _: &[&[f64]], v: &[&[f64]], _: &[f64]| v[i].iter().map(|v| -0.7 * v).collect::<Vec<_>>();
    check(|_| Drag { coefficient: 0.7 }.into(), &formula, true);
}

/// F_a = [−ks (|L| − r) − kd L̇·L/|L|] L/|L|, F_b = −F_a: the source's formula with its damping sign corrected.
fn spring_force(i: usize, x: &[&[f64]], v: &[&[f64]], damping: f64) -> Vec<f64> {
    let (ks, r) = (13.0, 0.9);
    let L: Vec<f64> = x[2].iter().zip(x[0]).map(|(a, b)| a - b).collect();
    let Ld: Vec<f64> = v[2].iter().zip(v[0]).map(|(a, b)| a - b).collect();
    let sign = [-1.0, 0.0, 1.0][i];
    let pull = -ks * (norm(&L) - r) - damping * dot(&Ld, &L) / norm(&L);
    L.iter().map(|l| sign * pull * l / norm(&L)).collect()
}

fn spring(damping: f64) -> Force {
    Spring { a: crate::systems::id(2), b: crate::systems::id(0), stiffness: 13.0, damping, rest: 0.9 }.into()
}

#[test]
fn springs_pull_their_ends_to_the_rest_length() {
    check(|_| spring(0.0), &|i, x, v, _| spring_force(i, x, v, 0.0), false);
}

#[test]
fn springs_damp_their_own_stretching() {
    check(|_| spring(1.7), &|i, x, v, _| spring_force(i, x, v, 1.7), true);
}

/// The damper of a spring that shrinks pushes outward; the wrong sign of the source would add energy here.
#[test]
fn spring_damping_opposes_the_stretch_rate() {
    let mut builder = System::builder(dimension(2));
    let a = builder.particle(Particle::at("a", [1.0, 0.0]).with_velocity([2.0, 5.0]));
    let b = builder.particle(Particle::at("b", [0.0, 0.0]));
    builder.force(Spring { a, b, stiffness: 10.0, damping: 3.0, rest: 1.0 });
    let (system, state) = builder.build().unwrap();
    // At rest length only the damper acts: −kd L̇ = −3 · 2 N along x; the 5 m/s across have no effect.
    assert_eq!(evaluate(&system, &state).applied_forces, [-6.0, 0.0, 6.0, 0.0]);
}

#[test]
fn point_force_acts_on_its_particle_alone() {
    const F: [f64; 3] = [1.5, -0.4, 2.0];
    let formula = |i: usize, x: &[&[f64]], _: &[&[f64]], _: &[f64]| {
        F[..x[i].len()].iter().map(|f| if i == 1 { *f } else { 0.0 }).collect::<Vec<_>>()
    };
    check(|_| PointForce { particle: crate::systems::id(1), force: F }.into(), &formula, false);
}

#[test]
fn mouse_spring_pulls_to_its_target() {
    const TARGET: [f64; 3] = [0.4, 0.1, -0.8];
    let formula = |i: usize, x: &[&[f64]], v: &[&[f64]], _: &[f64]| {
        let pull = |k: usize| if i == 1 { -6.0 * (x[1][k] - TARGET[k]) - 0.9 * v[1][k] } else { 0.0 };
        (0..x[i].len()).map(pull).collect::<Vec<_>>()
    };
    let mouse = MouseSpring { particle: crate::systems::id(1), target: TARGET, stiffness: 6.0, damping: 0.9 };
    check(|_| mouse.clone().into(), &formula, true);
}

/// Q is the sum of all forces, and gravity does not depend on the others.
#[test]
fn forces_add_up() {
    let mut random = Random::new(17);
    for d in [2, 3] {
        let (system, state) = systems::random::web(&mut random, d, 8);
        let mut sum = vec![0.0; system.coordinate_count()];
        for force in system.forces() {
            let mut builder = System::builder(dimension(d));
            for (i, x) in state.positions().chunks(d).enumerate() {
                let v = &state.velocities()[i * d..(i + 1) * d];
                let particle = Particle::at(format!("p{i}"), x).with_velocity(v).with_mass(system.masses()[i]);
                builder.particle(particle);
            }
            builder.force(force.clone());
            let (alone, state) = builder.build().unwrap();
            for (sum, Q) in sum.iter_mut().zip(evaluate(&alone, &state).applied_forces) {
                *sum += Q;
            }
        }
        // Roundoff of sums of a dozen numbers below 100.
        assert_all_close("Q", &evaluate(&system, &state).applied_forces, &sum, 1e-12);
    }
}
