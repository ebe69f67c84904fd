//! The equations of every constraint: C against its formula, Ċ and J against differences of C, γ against differences of Ċ
//! along the motion. The forces have the same in `forces.rs`.

#![allow(non_snake_case, reason = "the letters of the equations keep their case")]

mod systems;

use qhat::{Constraint, Distance, DistanceForm, Formulation, Nail, NailForm, Particle, State, System, evaluate};
use systems::dense::{assert_all_close, assert_close, dot, multiply, norm};
use systems::random::{Random, dimension};

/// Random states tried for every form and dimension.
const STATES: usize = 40;

/// Step of the differences. Points are at least 0.8 apart and speeds below 1, so the fifth derivatives are below about 1e3
/// and the formula's error δ⁴ f⁽⁵⁾/30 below 1e-10; roundoff adds about ε|C|/δ = 1e-12.
const DELTA: f64 = 1e-3;
const TOLERANCE: f64 = 1e-9;

/// f'(0) by the central difference of fourth order.
fn derivative(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [left2, left, right, right2] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * DELTA));
    let slope = |k: usize| (8.0 * (right[k] - left[k]) - (right2[k] - left2[k])) / (12.0 * DELTA);
    (0..left.len()).map(slope).collect()
}

/// q + τ v.
fn along(q: &[f64], v: &[f64], tau: f64) -> Vec<f64> {
    q.iter().zip(v).map(|(q, v)| q + tau * v).collect()
}

/// Three particles and one constraint, at random.
fn build(random: &mut Random, d: usize, constraint: Constraint) -> (System, State) {
    let mut builder = System::builder(dimension(d));
    for (i, x) in random.points(3, d, 0.8).into_iter().enumerate() {
        let v = random.numbers(d, -0.5, 0.5);
        builder.particle(Particle::at(format!("p{i}"), x).with_velocity(v));
    }
    builder.constraint("it", constraint);
    builder.build().unwrap()
}

/// C by its formula, then the other symbols by differences, in 2D and 3D.
fn check(make: impl Fn(&mut Random) -> Constraint, formula: impl Fn(&[&[f64]]) -> Vec<f64>) {
    let mut random = Random::new(7);
    for d in [2, 3] {
        for _ in 0..STATES {
            let constraint = make(&mut random);
            let (system, state) = build(&mut random, d, constraint);
            let (q, v) = (state.positions(), state.velocities());
            let terms = evaluate(&system, &state);
            let at = |q: Vec<f64>| evaluate(&system, &state.with_motion(q, v.to_vec()));

            // Roundoff of a few operations on numbers below 30.
            assert_all_close("C", &terms.residual, &formula(&q.chunks(d).collect::<Vec<_>>()), 1e-13);
            let rate = derivative(|tau| at(along(q, v, tau)).residual);
            assert_all_close("Ċ against differences of C", &terms.residual_rate, &rate, TOLERANCE);

            let J = terms.jacobian.to_dense();
            assert_all_close("J q̇ = Ċ", &multiply(&J, v), &terms.residual_rate, 1e-13);
            for k in 0..q.len() {
                let axis: Vec<f64> = (0..q.len()).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
                let column: Vec<f64> = J.chunks(q.len()).map(|row| row[k]).collect();
                let slope = derivative(|tau| at(along(q, &axis, tau)).residual);
                assert_all_close("J against differences of C", &column, &slope, TOLERANCE);
            }

            // γ = d/dt (J) q̇: J moves with q while q̇ is kept.
            let J_rate = derivative(|tau| at(along(q, v, tau)).jacobian.to_dense());
            assert_all_close("γ = J̇ q̇", &terms.acceleration_bias, &multiply(&J_rate, v), TOLERANCE);
            let acceleration = derivative(|tau| at(along(q, v, tau)).residual_rate);
            assert_all_close("γ against differences of Ċ", &terms.acceleration_bias, &acceleration, TOLERANCE);
        }
    }
}

const R: f64 = 1.3;
const P: [f64; 3] = [0.4, -0.7, 0.2];

fn apart(x: &[&[f64]]) -> Vec<f64> {
    x[2].iter().zip(x[0]).map(|(a, b)| a - b).collect()
}

fn away(x: &[&[f64]]) -> Vec<f64> {
    x[1].iter().zip(P).map(|(x, p)| x - p).collect()
}

fn rod(form: DistanceForm) -> Constraint {
    // The end with the higher number first: the blocks of a row need not be in order.
    Distance { form, ..Distance::new(systems::id(2), systems::id(0), R) }.into()
}

fn nail(form: NailForm) -> Constraint {
    Nail { particle: systems::id(1), at: P, form }.into()
}

#[test]
fn distance_in_the_length_form() {
    check(|_| rod(DistanceForm::Length), |x| vec![norm(&apart(x)) - R]);
}

#[test]
fn distance_in_the_squared_form_of_the_source() {
    check(|_| rod(DistanceForm::Squared), |x| vec![dot(&apart(x), &apart(x)) - R * R]);
}

#[test]
fn nail_in_the_vector_form() {
    check(|_| nail(NailForm::Vector), away);
}

#[test]
fn nail_in_the_scalar_form_of_the_source() {
    check(|_| nail(NailForm::Scalar), |x| vec![dot(&away(x), &away(x))]);
}

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

/// Going to the classic forms and back changes the rows, not what they hold.
#[test]
fn formulations_hold_the_same_places() {
    let mut random = Random::new(3);
    let (system, state) = build(&mut random, 3, rod(DistanceForm::Length));
    let classic = system.with_formulation(Formulation::Classic);
    let (length, squared) = (evaluate(&system, &state), evaluate(&classic, &state));
    let distance = length.residual[0] + R;
    // d·d − r² = (|d| − r)(|d| + r).
    assert_close("squared C", squared.residual[0], length.residual[0] * (distance + R), 1e-13);
    let back = evaluate(&classic.with_formulation(Formulation::Modern), &state);
    assert_eq!(back, length);
    // The same motion: q̈ is that of the length form plus the form's own drift, which is zero on C = 0, Ċ = 0.
    let (system, state) = systems::double_pendulum();
    let classic = system.with_formulation(Formulation::Classic);
    let (a, b) = (evaluate(&system, &state), evaluate(&classic, &state));
    // 30 m/s² and roundoff of a 2 × 2 solve.
    assert_all_close("q̈", &a.accelerations, &b.accelerations, 1e-12);
    assert_all_close("tension", &a.tension, &b.tension, 1e-12);
}
