//! Springs, drag and free flight against their closed forms.

use crate::systems::dense::assert_close;
use crate::systems::{self, G};
use qhat::{
    Dimension, Drag, Integrator, MouseSpring, Particle, PointForce, Settings, Simulation, Spring, State, System,
};

const MASS: f64 = 2.0;
const STIFFNESS: f64 = 50.0;
const REST: f64 = 1.0;

/// A mass on a horizontal spring, stretched by 0.3 m and released; along x only.
fn oscillator(damping: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let wall = builder.particle(Particle::at("wall", [0.0, 0.0]).fixed());
    let mass = builder.particle(Particle::at("mass", [REST + 0.3, 0.0]).with_mass(MASS));
    builder.force(Spring { a: wall, b: mass, stiffness: STIFFNESS, damping, rest: REST });
    builder.build().unwrap()
}

/// x(t) of m ẍ = −ks (x − r) − kd ẋ, underdamped, from rest at amplitude 0.3 m.
fn closed_form(damping: f64, t: f64) -> f64 {
    let decay = damping / (2.0 * MASS);
    let omega = (STIFFNESS / MASS - decay * decay).sqrt();
    let (sine, cosine) = libm::sincos(omega * t);
    REST + 0.3 * libm::exp(-decay * t) * (cosine + decay / omega * sine)
}

fn compare(damping: f64, settings: Settings, allowed: f64) {
    let (system, state) = oscillator(damping);
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let steps = (8.0 / settings.h).round() as usize;
    for _ in 0..steps {
        simulation.step().unwrap();
        let state = simulation.state();
        let expected = closed_form(damping, state.time());
        assert_close(&format!("{} x(t)", settings.integrator), state.positions()[2], expected, allowed);
        assert_eq!(state.positions()[3], 0.0, "nothing pulls it aside");
        assert_eq!(state.positions()[..2], [0.0, 0.0], "the wall stays");
    }
}

/// ω = √(ks/m) = 5 rad/s over 8 s, six periods.
#[test]
fn long_frequency_and_damping_of_a_mass_on_a_spring() {
    for damping in [0.0, 1.0, 5.0] {
        // RK4: phase error (hω)⁴/120 · ωt = 2e-10 of 0.3 m.
        compare(damping, systems::settings(Integrator::Rk4, 1e-3), 1e-9);
        // RATTLE without constraints is velocity Verlet: (hω)²/24 · ωt = 1e-6 · 40 of 0.3 m; where the force depends on
        // the velocity twice that.
        compare(damping, systems::settings(Integrator::Rattle, 1e-3), 3e-5);
        // Order 1: ½ hω · ωt = 2.5e-4 · 40 · 0.3 m for the damping rate and frequency at h = 0.1 ms.
        compare(damping, systems::settings(Integrator::SymplecticEuler, 1e-4), 3e-3);
        compare(damping, systems::settings(Integrator::Euler, 1e-4), 5e-3);
    }
}

/// A spring that is released at its rest length stays at rest.
#[test]
fn a_spring_at_rest_length_is_at_rest() {
    let (system, state) = oscillator(0.5);
    let state = state.with_motion(vec![0.0, 0.0, REST, 0.0], vec![0.0; 4]);
    for integrator in Integrator::ALL {
        let mut simulation =
            Simulation::new(system.clone(), state.clone(), systems::settings(integrator, 0.01)).unwrap();
        simulation.step().unwrap();
        assert_eq!(simulation.state().positions(), state.positions());
    }
}

/// A mass that hangs on a spring rests m g/ks below the rest length.
#[test]
fn spring_sags_by_weight_over_stiffness() {
    let mut builder = System::builder(Dimension::Three);
    let top = builder.particle(Particle::at("top", [0.0; 3]).fixed());
    let mass = builder.particle(Particle::at("mass", [0.0, -REST, 0.0]).with_mass(MASS));
    builder
        .with_force(Spring { a: mass, b: top, stiffness: STIFFNESS, damping: 20.0, rest: REST })
        .force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rattle, 1.0 / 60.0)).unwrap();
    for _ in 0..600 {
        simulation.step().unwrap();
    }
    // The slower root of m s² + 20 s + 50 is −5/s or faster: e^−50 of the start is left after 10 s, so only roundoff.
    assert_close("y", simulation.state().positions()[4], -REST - MASS * G / STIFFNESS, 1e-12);
    assert_eq!(simulation.state().velocities()[3], 0.0);
}

/// Near its rest position, a pendulum on a spring bounces at √(ks/m) and swings at √(g/l), as on a rod of its length l
/// at rest. In its scene, `elastic-pendulum`, the first is twice the second.
#[test]
fn a_pendulum_on_a_spring_bounces_and_swings() {
    let l = REST + MASS * G / STIFFNESS;
    let small = 1e-5;
    let at_quarters = |aside: f64, down: f64, omega: f64| {
        let mut builder = System::builder(Dimension::Two);
        let top = builder.particle(Particle::at("top", [0.0; 2]).fixed());
        let bob = builder.particle(Particle::at("bob", [aside, -l - down]).with_mass(MASS));
        builder.force(Spring { a: bob, b: top, stiffness: STIFFNESS, damping: 0.0, rest: REST });
        builder.force(systems::gravity());
        let (system, state) = builder.build().unwrap();
        let settings = Settings { tolerance: 1e-12, ..systems::settings(Integrator::Dop853, 0.01) };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        [1, 2, 3, 4].map(|_| {
            simulation.advance(std::f64::consts::FRAC_PI_2 / omega).unwrap();
            let state = simulation.state();
            [state.positions()[2], -l - state.positions()[3]]
        })
    };
    // Relative to the amplitude. The change of the frequencies with the amplitude is at most of first order, 1e-5.
    let cosine = [0.0, -1.0, 0.0, 1.0];
    let swing = at_quarters(small, 0.0, (G / l).sqrt());
    let bounce = at_quarters(0.0, small, (STIFFNESS / MASS).sqrt());
    for (quarter, cosine) in cosine.into_iter().enumerate() {
        assert_close("aside", swing[quarter][0] / small, cosine, 1e-4);
        assert_close("down", bounce[quarter][1] / small, cosine, 1e-4);
        assert_eq!(bounce[quarter][0], 0.0, "nothing pulls it aside");
    }
}

/// v = v₀ e^(−kd t/m) under drag alone, and x = v₀ m/kd (1 − e^(−kd t/m)).
#[test]
fn drag_slows_a_free_particle_exponentially() {
    let mut builder = System::builder(Dimension::Two);
    builder.particle(Particle::at("it", [0.0, 0.0]).with_velocity([3.0, -4.0]).with_mass(MASS));
    builder.force(Drag { coefficient: 1.5 });
    let (system, state) = builder.build().unwrap();
    // RK4: (h kd/m)⁴/120; RATTLE: (h kd/m)²/6 or so of 5 m/s; Euler: half of h kd/m.
    for (integrator, allowed) in [(Integrator::Rk4, 1e-11), (Integrator::Rattle, 1e-6), (Integrator::Euler, 5e-3)] {
        let settings = systems::settings(integrator, 1e-3);
        let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
        for _ in 0..2000 {
            simulation.step().unwrap();
            let state = simulation.state();
            let left = libm::exp(-1.5 / MASS * state.time());
            for (k, v0) in [3.0, -4.0].into_iter().enumerate() {
                assert_close(&format!("{integrator} v"), state.velocities()[k], v0 * left, allowed);
                let x = v0 * MASS / 1.5 * (1.0 - left);
                assert_close(&format!("{integrator} x"), state.positions()[k], x, allowed);
            }
        }
    }
}

/// x = v₀ t + ½ (g + f/m) t²: constant forces are exact for RATTLE and RK4.
#[test]
fn free_flight_is_a_parabola() {
    for integrator in [Integrator::Rattle, Integrator::Rk4] {
        let mut builder = System::builder(Dimension::Three);
        let velocity = [3.0, 5.0, -1.0];
        let it = builder.particle(Particle::at("it", [0.0; 3]).with_velocity(velocity).with_mass(MASS));
        builder.with_force(systems::gravity()).force(PointForce { particle: it, force: [1.0, 0.0, -6.0] });
        let (system, state) = builder.build().unwrap();
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, 0.01)).unwrap();
        for _ in 0..200 {
            simulation.step().unwrap();
            let (t, acceleration) = (simulation.state().time(), [0.5, -G, -3.0]);
            for k in 0..3 {
                let expected = velocity[k] * t + 0.5 * acceleration[k] * t * t;
                // Roundoff of 200 steps over 20 m.
                assert_close("x", simulation.state().positions()[k], expected, 1e-12);
            }
        }
    }
}

/// The mouse spring is a spring of rest length zero: the same closed form about its target.
#[test]
fn mouse_spring_oscillates_about_its_target() {
    let mut builder = System::builder(Dimension::Two);
    let it = builder.particle(Particle::at("it", [0.3, 1.0]).with_mass(MASS));
    builder.force(MouseSpring { particle: it, target: [0.0, 1.0, 0.0], stiffness: STIFFNESS, damping: 1.0 });
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rk4, 1e-3)).unwrap();
    for _ in 0..2000 {
        simulation.step().unwrap();
        let x = closed_form(1.0, simulation.state().time()) - REST;
        assert_close("x", simulation.state().positions()[0], x, 1e-9);
        assert_close("y", simulation.state().positions()[1], 1.0, 1e-12);
    }
}

/// The force of a spring turns round where its ends pass each other. Substeps must shrink there as far as the tolerance
/// asks. Where a force jumps within a substep, an estimate may be 26 times too small (`dop853`, a jump in its first
/// quarter), a substep may miss the tolerance by 3, and the energy has twice the error of the speed.
#[test]
fn ends_of_a_spring_pass_each_other() {
    for integrator in [Integrator::Dop853, Integrator::Dopri5] {
        for tolerance in [1e-6, 1e-8, 1e-10] {
            for aside in [0.0, 1e-9, 1e-6, 1e-3] {
                let mut builder = System::builder(Dimension::Two);
                let a = builder.particle(Particle::at("a", [-0.987, aside]).with_velocity([10.0, 0.0]));
                let b = builder.particle(Particle::at("b", [0.0123, 0.0]));
                builder.force(Spring { a, b, stiffness: 30.0, damping: 0.0, rest: 0.9 });
                let (system, state) = builder.build().unwrap();
                let settings = Settings { integrator, tolerance, ..Settings::default() };
                let mut simulation = Simulation::new(system, state, settings).unwrap();
                (0..20).for_each(|_| drop(simulation.step().unwrap()));
                assert!(simulation.state().positions()[0] > simulation.state().positions()[2], "they have passed");
                let energy = simulation.energy_error_max();
                assert!(energy <= 156.0 * tolerance, "{integrator} at {tolerance:e}, {aside:e} m aside: {energy:e}");
            }
        }
    }
}
