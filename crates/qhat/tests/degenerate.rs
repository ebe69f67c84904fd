//! Degenerate systems end in a status or a typed error, never in a panic or in wrong numbers without a warning. Wrong
//! numbers and names are in `refused.rs`.

use crate::systems;
use crate::systems::dense::{assert_close, largest, norm};
use qhat::{
    Dimension, Distance, DistanceForm, Feedback, Formulation, Integrator, Nail, NailForm, Particle, Settings,
    Simulation, State, StepError, System, SystemBuilder, Warning, Workspace, evaluate, step,
};

fn plane() -> SystemBuilder {
    System::builder(Dimension::Two)
}

fn settings(integrator: Integrator) -> Settings {
    systems::settings(integrator, 1.0 / 240.0)
}

/// Steps under every integrator and returns the simulation if no step failed.
fn run_all(system: &System, state: &State, steps: usize) -> Vec<Simulation> {
    let start = |integrator| Simulation::new(system.clone(), state.clone(), settings(integrator)).unwrap();
    let run = |mut simulation: Simulation| {
        for _ in 0..steps {
            let report = simulation.step().unwrap();
            assert!(simulation.state().positions().iter().all(|x| x.is_finite()));
            assert!(report.max_residual.is_finite() && report.energy.total().is_finite());
        }
        simulation
    };
    Integrator::ALL.into_iter().map(start).map(run).collect()
}

#[test]
fn no_particles() {
    for dimension in [Dimension::Two, Dimension::Three] {
        let (system, state) = System::builder(dimension).build().unwrap();
        for mut simulation in run_all(&system, &state, 3) {
            assert!(simulation.terms().accelerations.is_empty());
            assert_close("t", simulation.state().time(), 3.0 / 240.0, 1e-15);
        }
        assert_eq!(evaluate(&system, &state).rank, Some(0));
    }
}

#[test]
fn no_constraints() {
    let mut builder = plane();
    builder.particle(Particle::at("it", [1.0, 2.0]));
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    for simulation in run_all(&system, &state, 240) {
        // The particle falls 4.9 m in a second; the error of the Euler methods is half of h v.
        assert_close("y", simulation.state().positions()[1], 2.0 - 0.5 * systems::G, 0.021);
    }
}

#[test]
fn both_ends_fixed() {
    let mut builder = plane();
    let a = builder.particle(Particle::at("a", [0.0, 0.0]).fixed());
    let b = builder.particle(Particle::at("b", [1.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.0, -1.0]));
    builder.with_constraint("inert", Distance::new(a, b, 1.0)).constraint("rod", Distance::new(a, bob, 1.0));
    builder.with_constraint("nail", Nail::new(b, [1.0, 0.0, 0.0])).force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    assert_eq!((terms.multipliers[0], terms.rank), (0.0, Some(1)), "no multiplier acts through fixed ends");
    assert_eq!(terms.warnings, [], "rows that can never act are no news");
    assert_close("the other rod", terms.tension[1], systems::G, 1e-13);
    for simulation in run_all(&system, &state, 60) {
        assert_eq!(simulation.state().positions()[..4], [0.0, 0.0, 1.0, 0.0]);
    }
}

/// A rod between fixed ends at a wrong distance cannot be projected: the error names the row and its C.
#[test]
fn both_ends_fixed_at_the_wrong_distance() {
    let mut builder = plane();
    let a = builder.particle(Particle::at("a", [0.0, 0.0]).fixed());
    let b = builder.particle(Particle::at("b", [1.5, 0.0]).fixed());
    builder.constraint("wrong", Distance::new(a, b, 1.0));
    let (system, state) = builder.build().unwrap();
    assert_eq!(evaluate(&system, &state).residual, [0.5]);
    let error = Simulation::new(system, state, settings(Integrator::Rattle)).unwrap_err();
    assert_eq!(error, StepError::NotSatisfied { time: 0.0, row: "wrong".into(), residual: 0.5 });
}

/// Two nails hold the ends of a rod too far apart.
#[test]
fn infeasible_rows_are_named() {
    let mut builder = plane();
    let a = builder.particle(Particle::at("a", [0.0, 0.0]));
    let b = builder.particle(Particle::at("b", [1.0, 0.0]));
    builder.with_constraint("left", Nail::new(a, [0.0; 3])).constraint("right", Nail::new(b, [1.2, 0.0, 0.0]));
    builder.with_constraint("short", Distance::new(a, b, 1.0)).force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let before = state.clone();
    let error = Simulation::new(system.clone(), state.clone(), settings(Integrator::Rattle)).unwrap_err();
    let StepError::NotSatisfied { time, row, residual } = &error else { panic!("{error:?}") };
    assert!(["left.x", "right.x", "short"].contains(&row.as_str()), "{row}");
    // The nearest configuration shares 0.2 m among three rows.
    assert!(*time == 0.0 && residual.abs() > 0.05 && residual.abs() < 0.2, "{residual}");
    assert!(error.to_string().contains(row.as_str()), "{error}");

    // A step from there gives the same error and leaves the state.
    let mut stepped = state;
    let mut workspace = Workspace::new(&system);
    let error = step(&system, &mut stepped, &settings(Integrator::Rattle), &mut workspace).unwrap_err();
    assert!(matches!(error, StepError::NotSatisfied { .. }), "{error:?}");
    assert_eq!(stepped.positions(), before.positions());
    // The other integrators continue with a finite λ: the least of all λ with the smallest residual.
    assert!(largest(&evaluate(&system, &before).multipliers) < 1e3);
}

/// Redundant rows are reported and carry load: equal rods carry equal parts, and the motion is the same as with one
/// row.
#[test]
fn redundant_rows_share_the_load() {
    let (single, start) = systems::pendulum(0.5);
    let mut builder = plane();
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", &start.positions()[2..]).with_mass(2.0));
    for name in ["one", "two", "three"] {
        builder.constraint(name, Distance::new(pivot, bob, 1.0));
    }
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    assert_eq!((terms.rank, terms.warnings), (Some(1), vec![Warning::Singular]));
    let alone = evaluate(&single, &start).tension[0];
    for tension in &terms.tension {
        assert_close("a third", *tension, alone / 3.0, 1e-12 * alone); // refined to roundoff
    }
    for (mut simulation, integrator) in run_all(&system, &state, 240).into_iter().zip(Integrator::ALL) {
        let mut reference = Simulation::new(single.clone(), start.clone(), settings(integrator)).unwrap();
        for _ in 0..240 {
            reference.step().unwrap();
        }
        let (a, b) = (simulation.state().positions()[2], reference.state().positions()[2]);
        // Roundoff of a second's motion. An implicit step is solved to 1e-10 only, and its residual remains in the
        // velocity.
        let allowed = if integrator.is_implicit() { 1e-8 } else { 1e-9 };
        assert_close(&format!("x under {integrator}"), a, b, allowed);
        // An implicit method forms no A. The warning comes with the terms.
        let report = simulation.step().unwrap();
        let warnings = if integrator.is_implicit() { simulation.terms().warnings } else { report.warnings };
        assert!(warnings.contains(&Warning::Singular), "{integrator}");
    }
}

#[test]
fn coincident_particles() {
    for form in [DistanceForm::Length, DistanceForm::Squared] {
        let mut builder = plane();
        let a = builder.particle(Particle::at("a", [0.3, 0.4]));
        let b = builder.particle(Particle::at("b", [0.3, 0.4]));
        builder.with_constraint("rod", Distance { form, ..Distance::new(a, b, 1.0) }).force(systems::gravity());
        builder.force(qhat::Spring { a, b, stiffness: 10.0, damping: 1.0, rest: 0.5 });
        let (system, state) = builder.build().unwrap();
        let terms = evaluate(&system, &state);
        assert!(terms.multipliers.iter().chain(&terms.accelerations).all(|x| x.is_finite()));
        let simulation = Simulation::new(system, state, settings(Integrator::Rattle));
        match form {
            // The length form takes the first axis, so that the ends can be pulled apart.
            DistanceForm::Length => {
                let simulation = simulation.unwrap();
                let x = simulation.state().positions();
                assert_close("|d|", norm(&[x[0] - x[2], x[1] - x[3]]), 1.0, 1e-10);
            }
            // The squared form has no gradient there.
            DistanceForm::Squared => {
                assert_eq!(terms.warnings, [Warning::NoGradient { rows: vec!["rod".into()] }]);
                assert!(matches!(simulation, Err(StepError::NotSatisfied { .. })));
            }
        }
    }
}

/// The scalar nail of the source with its particle exactly at its point: without diagonal drag no λ can act. The step
/// warns and does not fail.
#[test]
fn scalar_nail_without_diagonal_drag() {
    let mut builder = plane();
    let it = builder.particle(Particle::at("it", [0.5, 0.5]));
    builder.constraint("nail", Nail { particle: it, at: [0.5, 0.5, 0.0], form: NailForm::Scalar });
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    let warning = Warning::NoGradient { rows: vec!["nail".into()] };
    assert_eq!((terms.multipliers.as_slice(), terms.rank), (&[0.0][..], Some(0)));
    assert_eq!(terms.warnings, std::slice::from_ref(&warning));
    assert_eq!(terms.accelerations, [0.0, -systems::G], "it falls as if there were no nail");
    assert!(warning.to_string().contains("nail") && warning.to_string().contains("diagonal drag"));

    // With diagonal drag A can be factored and no warning is given; λ is still zero where C, Ċ and J are zero.
    let mut simulation = Simulation::new(system.clone(), state.clone(), settings(Integrator::Euler)).unwrap();
    simulation.set_feedback(Feedback { diagonal_drag: 0.1, ..systems::critical(10.0) }).unwrap();
    assert_eq!(simulation.terms().warnings, []);
    for _ in 0..240 {
        simulation.step().unwrap();
    }
    let held = simulation.state().positions()[1];
    assert!(held > 0.0, "held softly near 0.5, but fell to {held}");
    // The vector nail needs no diagonal drag.
    let modern = system.with_formulation(Formulation::Modern);
    assert_eq!(evaluate(&modern, &state).accelerations, [0.0, 0.0]);
}

/// A load of a billion beads: a badly scaled A is not singular, and λ must carry the load.
#[test]
fn masses_a_billion_apart() {
    for (links, ratio) in [(2, 1e9), (20, 1e7), (20, 1e8), (20, 1e9), (100, 1e9)] {
        let mut builder = plane();
        let mut last = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
        for i in 1..=links {
            let mass = if i == links { 1e-2 * ratio } else { 1e-2 };
            let next = builder.particle(Particle::at(format!("p{i}"), [0.0, -0.01 * i as f64]).with_mass(mass));
            builder.constraint(format!("link{i}"), Distance::new(last, next, 0.01));
            last = next;
        }
        builder.force(systems::gravity());
        let (system, state) = builder.build().unwrap();
        let terms = evaluate(&system, &state);
        assert_eq!((terms.rank, terms.warnings), (Some(links), vec![]));
        let weight = 1e-2 * ratio * systems::G;
        for tension in terms.tension {
            // Pivots are 1/ratio of the diagonal: the relative error of λ is 1e-16 times the ratio; a factor of ten is
            // added.
            assert_close("tension", tension, weight, (2e-15 * ratio + 1.5 * links as f64 / ratio) * weight);
        }
    }
}

/// The heavier the load, the shorter the substeps (ω grows with the root of the load). The frames are completed, and
/// the links hold.
#[test]
fn a_heavy_load_can_be_carried() {
    let (system, state) = systems::chain(20, 1e7);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rattle, 1e-3)).unwrap();
    for _ in 0..3 {
        let report = simulation.step().unwrap();
        assert!(report.max_relative_length_error <= 1e-10 && report.warnings.is_empty(), "{report:?}");
    }
}

/// A parallelogram linkage loses rank where all its bars are in line; the motion must pass through this position.
#[test]
fn parallelogram_passes_through_flat() {
    let mut builder = plane();
    let a = builder.particle(Particle::at("a", [0.0, 0.0]).fixed());
    let b = builder.particle(Particle::at("b", [2.0, 0.0]).fixed());
    let c = builder.particle(Particle::at("c", [0.0, 1.0]).with_velocity([5.0, 0.0]));
    let d = builder.particle(Particle::at("d", [2.0, 1.0]).with_velocity([5.0, 0.0]));
    builder.with_constraint("ac", Distance::new(a, c, 1.0)).constraint("bd", Distance::new(b, d, 1.0));
    builder.with_constraint("cd", Distance::new(c, d, 2.0)).force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, settings(Integrator::Rattle)).unwrap();
    let (mut worst, mut passages, mut last) = (0.0_f64, 0, 1.0);
    for _ in 0..480 {
        worst = worst.max(simulation.step().unwrap().max_relative_length_error);
        let y = simulation.state().positions()[5];
        passages += usize::from(y * last < 0.0);
        last = y;
    }
    assert!(worst <= 1e-10, "{worst:e}");
    assert!(passages >= 2, "flat was passed {passages} times in 2 s");
    assert!(simulation.energy_error_max() < 1e-2, "{:e}", simulation.energy_error_max());
}
