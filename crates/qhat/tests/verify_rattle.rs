//! RATTLE over long times: the error of the energy oscillates and does not grow, because the substep is constant.

use crate::systems::{self, FRAME};
use qhat::{Dimension, Distance, Drag, HarmonicForce, Integrator, Particle, Settings, Simulation, State, System};

/// The energy errors after each of so many frames of h, and the number of substeps.
fn errors((system, state): (System, State), h: f64, frames: usize) -> (Vec<f64>, usize) {
    let settings = Settings { integrator: Integrator::Rattle, h, tolerance: 1e-4, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let mut substeps = 0;
    let each = (0..frames).map(|_| {
        substeps += simulation.step().unwrap().substeps;
        simulation.energy_error()
    });
    let errors = each.collect();
    assert_eq!(simulation.warnings().entries(), [], "no frame lost a hundredth of the energy");
    (errors, substeps)
}

/// The rise of the straight line through the errors, from the first to the last.
fn drift(errors: &[f64]) -> f64 {
    let n = errors.len() as f64;
    let (middle, mean) = (0.5 * (n - 1.0), errors.iter().sum::<f64>() / n);
    let numbered = || errors.iter().enumerate().map(|(i, error)| (i as f64 - middle, error - mean));
    n * numbered().map(|(i, error)| i * error).sum::<f64>() / numbered().map(|(i, _)| i * i).sum::<f64>()
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most: f64, error| most.max(error.abs()))
}

/// A pendulum released at one radian swings with a period of 2.14 s. With substeps that followed its swing it had lost
/// 60 % of its energy after 9,500 periods.
#[test]
fn long_pendulum_keeps_its_energy_for_ten_thousand_periods() {
    // Frames much longer than a period, and one that no power of two divides into the period.
    for (h, frames) in [(20.0, 1070), (1.37, 1562)] {
        let (errors, substeps) = errors(systems::pendulum(1.0), h, frames);
        assert!(largest(&errors) < 1e-2, "{:e}", largest(&errors));
        assert!(drift(&errors).abs() < 1e-3, "h = {h} s: {:e} in {substeps} substeps", drift(&errors));
    }
}

/// Chaotic motion comes upon harder moments again and again, each of which may shorten the substep and shift the error.
/// That happens ever more rarely, and what is lost stays small.
#[test]
fn long_chaotic_motion_keeps_its_energy() {
    // A double pendulum from horizontal had lost 1.8e-3 after 1000 s, and a chain of ten links 1.5e-3 after 100 s.
    for (name, start, seconds) in
        [("double pendulum", systems::double_pendulum(), 100.0), ("chain", systems::chain(10, 1.0), 20.0)]
    {
        let (errors, substeps) = errors(start, FRAME, (seconds / FRAME) as usize);
        assert!(largest(&errors) < 3e-3, "{name}: {:e} in {substeps} substeps", largest(&errors));
    }
}

/// Where drag takes energy and an oscillating force gives it, the account is right to the second order of the substep.
#[test]
fn long_driven_motion_keeps_its_account() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.0, -1.0]));
    builder.with_constraint("rod", Distance::new(pivot, bob, 1.0)).force(systems::gravity());
    builder.force(Drag { coefficient: 0.2 });
    builder.force(HarmonicForce { particle: bob, amplitude: [2.0, 0.0, 0.0], angular_frequency: 2.5, phase: 0.0 });
    let (errors, substeps) = errors(builder.build().unwrap(), FRAME, 3000);
    assert!(largest(&errors) < 1e-2, "{:e} in {substeps} substeps", largest(&errors));
}
