//! The constraint force Q̂: it does no work on motion with Ċ = 0, changes no momentum, and has the documented sign.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close, dot};
use crate::systems::random::{Random, web};
use qhat::{Dimension, Distance, DistanceForm, Nail, NailForm, Particle, PointForce, Settings, State, System};
use qhat::{Terms, Workspace, evaluate, project};

/// Puts a random state onto C = 0 and Ċ = 0.
fn legal(system: &System, state: &mut State) {
    let settings = Settings { constraint_tolerance: 1e-14, ..Settings::default() };
    project(system, state, &settings, &mut Workspace::new(system)).unwrap();
}

/// The power that Q̂ would have if every coordinate moved in its direction at 1 m/s, the size of the start velocities.
fn size(terms: &Terms) -> f64 {
    terms.constraint_forces.iter().map(|force| force.abs()).sum()
}

#[test]
fn constraint_force_does_no_work_on_legal_motion() {
    let mut random = Random::new(2);
    let mut tried = 0;
    for d in [2, 3] {
        for n in [3, 5, 8, 20, 40] {
            let (system, mut state) = web(&mut random, d, n);
            if project(&system, &mut state, &Settings::default(), &mut Workspace::new(&system)).is_err() {
                continue; // random lengths cannot always be met
            }
            tried += 1;
            let terms = evaluate(&system, &state);
            let power = dot(&terms.constraint_forces, &terms.velocities);
            // Q̂·q̇ = λ·Ċ, and the projection leaves roundoff of speeds of about 1 m/s as Ċ; stiff trusses multiply it
            // by 1e3.
            assert_close("Q̂·q̇", power, 0.0, 1e-12 * size(&terms));
        }
    }
    assert!(tried >= 5, "only {tried} systems could be made legal");
    for (system, mut state) in [systems::double_pendulum(), systems::net(5), systems::truss(6, true)] {
        let v = random.numbers(state.velocities().len(), -1.0, 1.0);
        let d = system.dimension();
        let v = v.iter().enumerate().map(|(k, v)| if system.inverse_masses()[k / d] == 0.0 { 0.0 } else { *v });
        state = state.with_motion(state.positions().to_vec(), v.collect());
        legal(&system, &mut state);
        let terms = evaluate(&system, &state);
        assert_close("Q̂·q̇", dot(&terms.constraint_forces, &terms.velocities), 0.0, 1e-12 * size(&terms));
    }
}

/// Σ m q̈ and Σ x × m q̈ of a free structure.
#[test]
fn internal_forces_change_no_momentum() {
    let mut random = Random::new(4);
    for _ in 0..20 {
        let (system, start) = systems::free_structure();
        let state = start.with_motion(random.numbers(12, -1.0, 1.0), random.numbers(12, -1.0, 1.0));
        let terms = evaluate(&system, &state);
        let change: Vec<f64> = (0..12).map(|k| system.masses()[k / 3] * terms.accelerations[k]).collect();
        let size: f64 = change.iter().map(|f| f.abs()).sum();
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let force: f64 = change.chunks(3).map(|f| f[k]).sum();
            assert_close("Σ m q̈", force, 0.0, 1e-14 * size); // opposite pairs: roundoff of the sum
            let moments = change.chunks(3).zip(state.positions().chunks(3)).map(|(f, x)| x[i] * f[j] - x[j] * f[i]);
            assert_close("Σ x × m q̈", moments.sum(), 0.0, 1e-13 * size);
        }
    }
}

fn hanging(form: DistanceForm) -> Terms {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.5, 1.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.5, -1.5]).with_mass(2.0));
    builder.with_constraint("rod", Distance { form, ..Distance::new(pivot, bob, 2.5) }).force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    evaluate(&system, &state)
}

const MG: f64 = 2.0 * systems::G;

#[test]
fn tension_at_rest_is_plus_mg_and_lambda_minus_mg() {
    let terms = hanging(DistanceForm::Length);
    // A handful of operations, each rounded once.
    assert_close("λ", terms.multipliers[0], -MG, 1e-14 * MG);
    assert_close("tension", terms.tension[0], MG, 1e-14 * MG);
    // The rod pulls the bob up and the pivot down.
    assert_close("Q̂ on the bob", terms.constraint_forces[3], MG, 1e-14 * MG);
    assert_close("Q̂ on the pivot", terms.constraint_forces[1], -MG, 1e-14 * MG);
    assert_all_close("q̈", &terms.accelerations, &[0.0; 4], 1e-14 * MG);
}

#[test]
fn tension_of_the_squared_form_is_minus_two_d_lambda() {
    let terms = hanging(DistanceForm::Squared);
    assert_close("λ", terms.multipliers[0], -MG / (2.0 * 2.5), 1e-14 * MG);
    assert_close("tension", terms.tension[0], MG, 1e-14 * MG);
    assert_close("Q̂ on the bob", terms.constraint_forces[3], MG, 1e-14 * MG);
}

#[test]
fn a_strut_under_load_has_negative_tension() {
    let mut builder = System::builder(Dimension::Three);
    let foot = builder.particle(Particle::at("foot", [0.0, 0.0, 0.0]).fixed());
    let load = builder.particle(Particle::at("load", [0.0, 2.0, 0.0]).with_mass(2.0));
    builder.with_constraint("strut", Distance::new(load, foot, 2.0)).force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    assert_close("tension", evaluate(&system, &state).tension[0], -MG, 1e-14 * MG);
}

#[test]
fn lambda_of_a_nail_is_its_force_on_the_particle() {
    let mut builder = System::builder(Dimension::Three);
    let it = builder.particle(Particle::at("it", [1.0, 2.0, 3.0]).with_mass(2.0));
    builder.with_constraint("nail", Nail::new(it, [1.0, 2.0, 3.0])).force(systems::gravity());
    builder.force(PointForce { particle: it, force: [5.0, 1.0, -4.0] });
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    for (lambda, expected) in terms.multipliers.iter().zip([-5.0, MG - 1.0, 4.0]) {
        assert_close("λ", *lambda, expected, 1e-14 * MG);
    }
    assert_eq!(terms.constraint_forces, terms.multipliers);
    assert!(terms.tension.is_empty(), "a nail is no link");
}

/// The scalar nail of the source can hold a particle only away from p. There its λ balances the load, λ J = −F.
#[test]
fn scalar_nail_carries_along_its_gradient_only() {
    let mut builder = System::builder(Dimension::Two);
    let it = builder.particle(Particle::at("it", [0.0, -0.1]).with_mass(2.0));
    builder
        .with_constraint("nail", Nail { particle: it, at: [0.0; 3], form: NailForm::Scalar })
        .force(systems::gravity());
    builder.force(PointForce { particle: crate::systems::id(0), force: [3.0, 0.0, 0.0] });
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    // J = (0, −0.2), so λ = −mg/0.2; no row holds the particle sideways.
    assert_close("λ", terms.multipliers[0], -MG / 0.2, 1e-13 * MG / 0.2);
    assert_close("q̈ along", terms.accelerations[1], 0.0, 1e-13);
    assert_eq!(terms.accelerations[0], 1.5);
}
