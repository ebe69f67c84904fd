//! Orbits over a hundred periods at the default settings, in frames of a period, so that the tolerance alone chooses
//! the substeps.

use crate::systems::dense::difference;
use qhat::{Dimension, InverseSquare, Particle, Settings, Simulation, System};
use std::f64::consts::TAU;

/// The largest change of a coordinate over a hundred periods [m].
fn off_after_a_hundred(bodies: &[([f64; 2], [f64; 2])], is_first_fixed: bool, period: f64) -> f64 {
    let mut builder = System::builder(Dimension::Two);
    let ids: Vec<_> = bodies
        .iter()
        .enumerate()
        .map(|(i, (place, velocity))| {
            let body = Particle::at(i.to_string(), *place).with_velocity(*velocity);
            builder.particle(if i == 0 && is_first_fixed { body.fixed() } else { body })
        })
        .collect();
    for (i, &a) in ids.iter().enumerate() {
        // G m_a m_b = 1 N·m².
        for &b in &ids[..i] {
            builder.force(InverseSquare { a, b, strength: -1.0, softening: 0.0 });
        }
    }
    let (system, state) = builder.build().unwrap();
    let settings = Settings { h: period, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let start = simulation.state().positions().to_vec();
    (0..100).for_each(|_| drop(simulation.step().unwrap()));
    difference(simulation.state().positions(), &start)
}

/// A Kepler ellipse of e = 0.6, a = 1 m: 0.23 m off at a tolerance of 1e-4, and 5e-3 m at 1e-7 (x86-64, release).
#[test]
fn an_ellipse_comes_back_after_a_hundred_periods() {
    let off = off_after_a_hundred(&[([0.0; 2], [0.0; 2]), ([0.4, 0.0], [0.0, 2.0])], true, TAU);
    assert!(off < 0.01, "{off} m");
}

/// The figure-eight of three bodies (Chenciner and Montgomery 2000; numbers by Simó): lost altogether at a tolerance of
/// 1e-4, 0.011 m off at 1e-7 (x86-64, release).
#[test]
fn a_figure_eight_comes_back_after_a_hundred_periods() {
    let bodies = [
        ([0.97000436, -0.24308753], [0.466203685, 0.43236573]),
        ([-0.97000436, 0.24308753], [0.466203685, 0.43236573]),
        ([0.0, 0.0], [-0.93240737, -0.86473146]),
    ];
    let off = off_after_a_hundred(&bodies, false, 6.32591398);
    assert!(off < 0.02, "{off} m");
}
