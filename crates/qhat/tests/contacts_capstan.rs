//! A chain of light beads on a rough drum, under a heavy load: friction that holds many times what pulls on the other
//! end, with masses up to 1e9 apart.

use crate::systems::settings;
use qhat::{
    Dimension, Distance, Integrator, Obstacle, Particle, PointForce, Settings, Simulation, Surface, System,
    SystemBuilder,
};
use std::f64::consts::PI;

/// Pull on the load, of 1 kg [N].
const LOAD: f64 = 10.0;

const FRICTION: f64 = 0.3;

/// `count` beads over an angle of the drum of 1 m, from the load that hangs on the last of them at the angle 0.
#[derive(Clone, Copy, Debug)]
struct Capstan {
    count: usize,
    angle: f64,
    /// The mass of a bead [kg].
    mass: f64,
}

impl Capstan {
    /// Half the angle between neighbours.
    fn half(&self) -> f64 {
        0.5 * self.angle / (self.count - 1) as f64
    }

    /// The speed that roundoff may give the load [m/s]: forces are rounded at the accelerations that they give a bead.
    fn rest(&self) -> f64 {
        (1e-15 / self.mass).max(1e-9)
    }

    /// The largest load for one newton on the other end. A bead between rods that are bent by α and β from the tangent,
    /// with tensions S and T, has
    ///
    /// ```text
    /// N = S sin α + T sin β,   T cos β − S cos α = μ N   →   T/S = (cos α + μ sin α)/(cos β − μ sin β)
    /// ```
    ///
    /// α = β = half the angle between neighbours, and 0 at the outer sides of the first and the last.
    fn holds(&self) -> f64 {
        let (s, c) = (libm::sin(self.half()), libm::cos(self.half()));
        libm::pow((c + FRICTION * s) / (c - FRICTION * s), (self.count - 1) as f64)
    }

    /// The beads on the drum, from the far end to the load, and the load.
    fn builder(&self) -> (SystemBuilder, Vec<qhat::ParticleId>) {
        let mut builder = System::builder(Dimension::Two);
        let mut ids = Vec::new();
        for i in 0..self.count {
            let angle = self.angle * (self.count - 1 - i) as f64 / (self.count - 1) as f64;
            let place = [libm::cos(angle), libm::sin(angle)];
            ids.push(builder.particle(Particle::at(format!("bead{i}"), place).with_mass(self.mass)));
        }
        ids.push(builder.particle(Particle::at("load", [1.0, -1.0])));
        for (i, pair) in ids.windows(2).enumerate() {
            let length = if i + 1 < self.count { 2.0 * libm::sin(self.half()) } else { 1.0 };
            builder.constraint(format!("rod{i}"), Distance::new(pair[0], pair[1], length));
        }
        for (i, &bead) in ids[..self.count].iter().enumerate() {
            let drum = Obstacle::new(bead, Surface::ball([0.0; 3], 1.0)).with_friction(FRICTION);
            builder.constraint(format!("drum{i}"), drum);
        }
        builder.force(PointForce { particle: ids[self.count], force: [0.0, -LOAD, 0.0] });
        (builder, ids)
    }

    /// With a pull on the far end [N].
    fn pulled(&self, pull: f64) -> Simulation {
        let (mut builder, ids) = self.builder();
        let along = [-pull * libm::sin(self.angle), pull * libm::cos(self.angle), 0.0];
        builder.force(PointForce { particle: ids[0], force: along });
        start(builder)
    }

    /// With the far end on a rod to a hook.
    fn hooked(&self) -> Simulation {
        let (mut builder, ids) = self.builder();
        let (s, c) = (libm::sin(self.angle), libm::cos(self.angle));
        let hook = builder.particle(Particle::at("hook", [c - s, s + c]).fixed());
        builder.constraint("anchor", Distance::new(hook, ids[0], 1.0));
        start(builder)
    }
}

fn start(builder: SystemBuilder) -> Simulation {
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, Settings { tolerance: 1e-6, ..settings(Integrator::Dop853, 0.01) }).unwrap()
}

fn capstans() -> Vec<Capstan> {
    let mut capstans = Vec::new();
    for count in [6, 9, 14, 24] {
        for angle in [0.5 * PI, 2.0 / 3.0 * PI, PI] {
            for mass in [1e-2, 1e-4, 1e-5, 1e-7, 1e-9] {
                capstans.push(Capstan { count, angle, mass });
            }
        }
    }
    capstans
}

/// The velocity of the load after so many frames [m/s].
fn velocity(simulation: &mut Simulation, frames: usize, what: &str) -> f64 {
    for frame in 0..frames {
        simulation.step().unwrap_or_else(|error| panic!("{what}, frame {frame}: {error}"));
    }
    let count = simulation.system().particle_count();
    let load = (0..count).find(|&i| simulation.system().particle_names()[i] == "load").unwrap();
    simulation.state().velocities()[2 * load + 1]
}

/// Friction holds the load down to the pull that the closed form says, and no further.
#[test]
fn friction_on_a_drum_holds_as_much_as_it_should() {
    for capstan in capstans() {
        let least = LOAD / capstan.holds();
        for pull in [1.01 * least, 0.5 * (LOAD + least), LOAD] {
            let what = format!("{capstan:?}, {pull} N");
            let speed = velocity(&mut capstan.pulled(pull), 3, &what);
            assert!(speed.abs() < capstan.rest(), "{what}: {speed:e} m/s");
        }
        // A twentieth less, and the load goes down with what is missing, at the end of the chain that it pulls itself.
        let what = format!("{capstan:?}, slips");
        let speed = velocity(&mut capstan.pulled(0.95 * least), 3, &what);
        let expected = -0.05 * LOAD * 0.03 / (1.0 + capstan.count as f64 * capstan.mass);
        assert!((speed / expected - 1.0).abs() < 0.2, "{what}: {speed:e} m/s, expected {expected:e}");
    }
}

/// A chain on a hook stands still, whatever part of the load friction takes: every force within its cone, none pulling,
/// and all in balance.
#[test]
fn a_chain_on_a_hook_stands_still() {
    for capstan in capstans() {
        let what = format!("{capstan:?}");
        let mut simulation = capstan.hooked();
        let speed = velocity(&mut simulation, 3, &what);
        assert!(speed.abs() < capstan.rest(), "{what}: {speed:e} m/s");
        let terms = simulation.terms();
        for k in 0..2 * (capstan.count + 1) {
            let off = terms.applied_forces[k] + terms.constraint_forces[k];
            // Roundoff, times the ratio of the masses.
            assert!(off.abs() < LOAD * (1e-14 / capstan.mass).max(1e-12), "{what}: {k}: {off:e} N");
        }
        let first = capstan.count;
        for normal in (0..capstan.count).map(|i| first + 2 * i) {
            let (force, held) = (terms.multipliers[normal], terms.multipliers[normal + 1]);
            assert!(force > -1e-9 * LOAD && held.abs() < FRICTION * force + 1e-9 * LOAD, "{what}: {force}, {held}");
        }
    }
}
