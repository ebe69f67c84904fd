//! Contacts whose force does not exist or jumps: friction that presses its own contact together, and edges.

use crate::systems::{FRAME, G, gravity, settings};
use qhat::{Dimension, Distance, Integrator, Obstacle, Particle, Settings, Simulation, Surface, System, SystemBuilder};

fn start(builder: SystemBuilder) -> Simulation {
    let (system, state) = builder.build().unwrap();
    let settings = Settings { tolerance: 1e-9, ..settings(Integrator::Dop853, FRAME) };
    Simulation::new(system, state, settings).unwrap()
}

/// A rod pushed over rough ground with its lower end in front, as chalk over a board. Friction turns the rod so that it
/// presses on the ground. The ground cannot push it back if
///
/// ```text
/// 1 − k sin² a − μ k sin a cos a < 0,   k = m₂/(m₁ + m₂)
/// ```
///
/// No finite force solves the equations. The lower end stops at once, and the motion along the rod is lost: the energy
/// m₁ v²/2 + m₂ (v cos a)²/2.
#[test]
fn friction_without_an_answer_stops_the_slip_at_once() {
    let (lower, upper, speed, angle) = (1.0, 10.0, 1.0, std::f64::consts::FRAC_PI_3);
    let (sin, cos) = libm::sincos(angle);
    let k = upper / (lower + upper);
    let critical = (1.0 - k * sin * sin) / (k * sin * cos);
    for dimension in [Dimension::Two, Dimension::Three] {
        for (friction, stops) in [(1.5 * critical, true), (0.5 * critical, false)] {
            let in_space = |x: f64, y: f64| [x, y, 0.0][..dimension.number()].to_vec();
            let mut builder = System::builder(dimension);
            let mut end = |name: &str, x: f64, y: f64, mass: f64| {
                let particle = Particle::at(name, in_space(x, y)).with_mass(mass);
                builder.particle(particle.with_velocity(in_space(-speed, 0.0)))
            };
            let (a, b) = (end("lower", 0.0, 0.0, lower), end("upper", cos, sin, upper));
            let ground = Surface::HalfSpace { normal: [0.0, 1.0, 0.0], offset: 0.0 };
            builder
                .with_constraint("rod", Distance::new(a, b, 1.0))
                .with_constraint("ground", Obstacle { friction, ..Obstacle::new(a, ground) })
                .force(gravity());
            let mut simulation = start(builder);
            simulation.step().unwrap();
            let lost = -simulation.state().work().dissipation;
            if stops {
                let expected = 0.5 * speed * speed * (lower + upper * cos * cos);
                assert!((lost - expected).abs() < 1e-12 * expected, "{dimension:?}: {lost} J, expected {expected}");
                let slip = simulation.state().velocities()[0];
                assert!(slip.abs() < 1e-12, "{dimension:?}: {slip} m/s");
            } else {
                // The end slips on and is slowed by a finite force.
                assert!(simulation.state().velocities()[0] < -0.5 * speed, "{dimension:?}");
            }
            for _ in 0..60 {
                simulation.step().unwrap();
            }
            // The tolerance of a substep.
            assert!(simulation.energy_error_max() < 1e-9, "{dimension:?}: {:e}", simulation.energy_error_max());
        }
    }
}

/// A particle that slides fast over the edge of a box leaves the box where the edge begins to be round, and falls.
#[test]
fn a_particle_that_slides_over_an_edge_falls_from_there() {
    for dimension in [Dimension::Two, Dimension::Three] {
        for friction in [0.0, 0.2] {
            // The radius is a thousandth of the smallest half.
            let (speed, radius, way) = (2.0, 0.5e-3, 0.37);
            let d = dimension.number();
            let mut builder = System::builder(dimension);
            let mut velocity = vec![0.0; d];
            velocity[0] = speed;
            let particle = Particle::at("puck", [1.0 - radius - way, 0.5, 0.1][..d].to_vec()).with_velocity(velocity);
            let puck = builder.particle(particle);
            let block = Surface::Box { center: [0.0; 3], half: [1.0, 0.5, 1.0] };
            builder.with_constraint("box", Obstacle { friction, ..Obstacle::new(puck, block) }).force(gravity());
            let mut simulation = start(builder);
            for _ in 0..30 {
                simulation.step().unwrap();
            }
            let after = (speed * speed - 2.0 * friction * G * way).sqrt();
            let fall = simulation.state().time() - 2.0 * way / (speed + after);
            let q = simulation.state().positions();
            let (x, y) = (1.0 - radius + after * fall, 0.5 - 0.5 * G * fall * fall);
            // The edge is located to 1e-13 of a frame; 1e-9 allows for the tolerance of the method.
            assert!(
                (q[0] - x).abs() < 1e-9 && (q[1] - y).abs() < 1e-9,
                "{dimension:?} {friction}: {q:?}, expected {x} {y}"
            );
            assert!(simulation.energy_error_max() < 1e-9);
        }
    }
}
