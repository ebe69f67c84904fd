//! The pendulum against its closed forms: the period by the complete elliptic integral, the tension by energy
//! conservation.

use crate::systems::dense::assert_close;
use crate::systems::{self, G, swing};
use qhat::{Integrator, Settings, Simulation};

fn simulation(angle: f64, settings: Settings) -> Simulation {
    let (system, state) = systems::pendulum(-angle);
    Simulation::new(system, state, settings).unwrap()
}

#[test]
fn long_period_is_that_of_the_elliptic_integral() {
    for amplitude in [0.1, 1.0, 2.0, 3.0] {
        let period = swing::period(1.0, amplitude);
        // RK4: the phase is good to (hω)⁴/120 < 1e-12 with ω up to 6 rad/s, but the circle is left by errors of that
        // size a step which grow with t²: below 1e-10 over five swings, and more where the bob nearly stands still on
        // top.
        let rk4 = simulation(amplitude, systems::settings(Integrator::Rk4, 2.5e-4));
        assert_close("rk4", swing::measured(rk4, 2, 5), period, if amplitude < 2.5 { 1e-10 } else { 1e-8 });
        // RATTLE: (hω)²/24 of the period, ω² at most 4 g/L = 39/s²: 2e-6 of it at h = 1 ms. At this tolerance every
        // frame is one substep.
        let settings = Settings { tolerance: 1e-4, ..systems::settings(Integrator::Rattle, 1e-3) };
        let rattle = simulation(amplitude, settings);
        assert_close("rattle", swing::measured(rattle, 2, 5), period, 3e-6 * period);
    }
}

/// T = m (g cos θ + v²/L): Newton's law along the rod, at every moment of the swing.
/// With v² = 2 g L (cos θ − cos θ₀) it becomes m g (3 cos θ − 2 cos θ₀).
#[test]
fn tension_along_the_swing() {
    let amplitude = 2.5;
    let settings = Settings { tolerance: 1e-8, constraint_tolerance: 1e-13, ..Settings::default() };
    let mut simulation = simulation(amplitude, settings);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..300 {
        simulation.step().unwrap();
        let tension = simulation.tension()[0];
        let state = simulation.state();
        let (x, v) = (&state.positions()[2..], &state.velocities()[2..]);
        let cosine = -x[1]; // L = 1 m
        // Algebra on a state that is on the circle to 1e-13: roundoff of numbers of some 100 N.
        assert_close("m (g cos θ + v²/L)", tension, 2.0 * (G * cosine + v[0] * v[0] + v[1] * v[1]), 1e-11);
        // The energy error of RATTLE at this tolerance, about h²ω²/12 with h = 4e-4 s: 5e-7 of 2 m g.
        let conserved = 2.0 * G * (3.0 * cosine - 2.0 * libm::cos(amplitude));
        assert_close("m g (3 cos θ − 2 cos θ₀)", tension, conserved, 1e-4);
        (least, most) = (least.min(tension), most.max(tension));
    }
    // Above 90° the rod pushes; at the bottom it carries m g (3 − 2 cos θ₀).
    assert!(least < -15.0, "{least}");
    assert!(most > 2.0 * G * (3.0 - 2.0 * libm::cos(amplitude)) - 1.0, "{most}");
}

/// In 3D a conical pendulum keeps its height: v² = g L sin²α/cos α, T = m g/cos α.
#[test]
fn conical_pendulum_keeps_its_height() {
    let alpha: f64 = 0.7;
    let (sine, cosine) = (libm::sin(alpha), libm::cos(alpha));
    let mut builder = qhat::System::builder(qhat::Dimension::Three);
    let pivot = builder.particle(qhat::Particle::at("pivot", [0.0; 3]).fixed());
    let speed = (G * sine * sine / cosine).sqrt();
    let bob = qhat::Particle::at("bob", [sine, -cosine, 0.0]).with_velocity([0.0, 0.0, speed]).with_mass(2.0);
    let bob = builder.particle(bob);
    builder.with_constraint("rod", qhat::Distance::new(pivot, bob, 1.0)).force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rattle, 1e-3)).unwrap();
    for _ in 0..2000 {
        simulation.step().unwrap();
        // RATTLE follows a circle of a slightly different radius: (hω)² with ω² = g/(L cos α) = 13/s², 1e-5 of the
        // height.
        assert_close("height", simulation.state().positions()[4], -cosine, 1e-5);
        assert_close("tension", simulation.tension()[0], 2.0 * G / cosine, 1e-3);
    }
}
