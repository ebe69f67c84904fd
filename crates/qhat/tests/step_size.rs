//! The substeps that rattle chooses: short enough to be stable, to turn no rod far and to resolve the damping. They are
//! equal within a frame, and each begins with a good guess of λ.

use crate::systems;
use qhat::{Dimension, Distance, Drag, Integrator, Particle, Settings, StepReport, System, Workspace, step};

/// Frames of h under a tolerance that allows every error, so that only the bounds under test limit the substep.
fn frames(system: &System, start: &qhat::State, h: f64, count: usize) -> Vec<StepReport> {
    let settings = Settings { integrator: Integrator::Rattle, h, tolerance: 0.999, ..Settings::default() };
    let (mut state, mut workspace) = (start.clone(), Workspace::new(system));
    (0..count).map(|_| step(system, &mut state, &settings, &mut workspace).unwrap()).collect()
}

/// A chain that hangs at rest does not move, so no error asks for short substeps. But its waves of up to
/// ω = 2 √(T/(m L)) would grow out of roundoff unless h ω < 2.
#[test]
fn substeps_are_stable_under_tension() {
    const LINKS: usize = 40;
    let (mass, length, load) = (0.01, 0.01, 10.0);
    let mut builder = System::builder(Dimension::Two);
    let mut last = builder.particle(Particle::at("p0", [0.0, 0.0]).fixed());
    for i in 1..=LINKS {
        let m = if i == LINKS { load } else { mass };
        let next = builder.particle(Particle::at(format!("p{i}"), [0.0, -length * i as f64]).with_mass(m));
        builder.constraint(format!("link{i}"), Distance::new(last, next, length));
        last = next;
    }
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let tension = systems::G * (load + mass * LINKS as f64);
    let omega = 2.0 * (tension / (mass * length)).sqrt();
    for report in frames(&system, &state, 1.0 / 60.0, 5) {
        let h = 1.0 / 60.0 / report.substeps as f64;
        assert!(h * omega < 2.0, "hω = {}", h * omega);
        // Gershgorin's bound is within √2 of the exact ω for a chain, so the substep is at least a quarter of the
        // longest stable substep.
        assert!(h * omega > 0.5, "hω = {}: shorter than needed", h * omega);
        assert!(report.max_relative_length_error <= 1e-10);
    }
}

/// A rod that spins freely about a fixed end: T = m ω² L, so stability needs h ω < 1.4/√2 rad or so,
/// and a substep may not turn it by more than about a third of a radian.
#[test]
fn substeps_turn_no_rod_far() {
    for speed in [50.0, 500.0] {
        let mut builder = System::builder(Dimension::Two);
        let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [1.0, 0.0]).with_velocity([0.0, speed]));
        builder.constraint("rod", Distance::new(pivot, bob, 1.0));
        let (system, state) = builder.build().unwrap();
        for report in frames(&system, &state, 0.1, 3) {
            let turn = speed * 0.1 / report.substeps as f64;
            assert!(turn < 0.35 && turn > 0.15, "{turn} rad a substep at {speed} rad/s");
        }
    }
}

/// Drag is explicit: unless h kd/m < 2, velocities would change sign and grow.
#[test]
fn substeps_resolve_the_damping() {
    let mut builder = System::builder(Dimension::Two);
    builder.particle(Particle::at("it", [0.0, 0.0]).with_velocity([1.0, 0.0]).with_mass(0.01));
    builder.force(Drag { coefficient: 20.0 });
    let (system, state) = builder.build().unwrap();
    for report in frames(&system, &state, 0.1, 5) {
        let product = 0.1 / report.substeps as f64 * 20.0 / 0.01;
        assert!(product < 1.0 && product > 0.1, "h kd/m = {product}");
        assert!(report.energy.kinetic < 1e-6);
    }
}

/// No very short substeps: the rest of a frame is taken as one substep or as two halves.
#[test]
fn substeps_of_a_frame_are_alike() {
    let (system, state) = systems::double_pendulum();
    let settings = Settings { integrator: Integrator::Rattle, h: 0.05, tolerance: 1e-6, ..Settings::default() };
    let (mut state, mut workspace) = (state, Workspace::new(&system));
    let mut worst = f64::INFINITY;
    for _ in 0..100 {
        let report = step(&system, &mut state, &settings, &mut workspace).unwrap();
        worst = worst.min(report.smallest_substep * report.substeps as f64 / settings.h);
    }
    // At the end of a frame the shortest substep is half of the rest. The motion also changes the substep within a
    // frame.
    assert!(worst > 0.25, "the smallest substep was {worst} of the mean");
}

/// λ of the last substep is the guess for the next: Newton then needs one or two iterations; the first
/// is always made.
#[test]
fn multipliers_of_the_last_substep_start_the_next() {
    // Counted, with a small margin; with half of λ as the guess each substep needs one more iteration.
    for (name, (system, state), allowed) in [
        ("pendulum", systems::pendulum(1.0), 1.2),
        ("double pendulum", systems::double_pendulum(), 2.1),
        ("heavy chain", systems::chain(40, 100.0), 1.3),
        ("net", systems::net(5), 1.6),
    ] {
        let settings = Settings { constraint_tolerance: 1e-8, ..systems::settings(Integrator::Rattle, 1.0 / 60.0) };
        let (mut state, mut workspace) = (state, Workspace::new(&system));
        let (mut iterations, mut substeps) = (0, 0);
        for _ in 0..30 {
            let report = step(&system, &mut state, &settings, &mut workspace).unwrap();
            iterations += report.iterations;
            substeps += report.substeps;
        }
        let mean = iterations as f64 / substeps as f64;
        assert!(mean < allowed, "{name}: {mean} iterations a substep");
    }
}
