//! Reading: the numbers of a frame. Powers and poses are computed only where an array of them is asked for.

use crate::trajectory::{Frame, Quantity};
use qhat::{Energy, ParticleId, Pose, Powers, Simulation, State, System, evaluate};
use qhat_scene::{Scene, SceneBody};

/// Reads frames of a run of one scene.
pub(super) struct Reader {
    has_powers: bool,
    /// The bodies whose poses are asked for, each with its positions at the start \[m\].
    bodies: Vec<(SceneBody, Vec<[f64; 3]>)>,
}

impl Reader {
    /// A reader for some arrays.
    pub(super) fn new(scene: &Scene, quantities: &[Quantity]) -> Self {
        let has_poses = quantities.iter().any(|quantity| quantity.is_of_bodies());
        let bodies = scene.bodies.iter().filter(|_| has_poses);
        let start = |body: &SceneBody| vectors(&scene.system, scene.state.positions(), &body.particles);
        Reader {
            has_powers: quantities.iter().any(|quantity| quantity.is_power()),
            bodies: bodies.map(|body| (body.clone(), start(body))).collect(),
        }
    }

    /// The frame at the present state of a simulation, at `time` \[s\].
    pub(super) fn read(&self, simulation: &mut Simulation, time: f64) -> Frame {
        let powers = if self.has_powers { simulation.powers() } else { Powers::default() };
        let poses = self.poses(simulation.system(), simulation.state());
        Frame { time, terms: simulation.terms(), energy: simulation.energy(), powers, poses }
    }

    /// The frame of a start from which there is no motion. Its energies and powers are unknown.
    pub(super) fn read_start(&self, system: &System, state: &State) -> Frame {
        let energy = Energy { kinetic: f64::NAN, potential: f64::NAN, ..Energy::default() };
        let unknown = |count: usize| vec![f64::NAN; count];
        let powers =
            Powers { forces: unknown(system.force_names().len()), constraints: unknown(system.constraints().len()) };
        Frame { time: 0.0, terms: evaluate(system, state), energy, powers, poses: self.poses(system, state) }
    }

    fn poses(&self, system: &System, state: &State) -> Vec<Pose> {
        let pose = |(body, start): &(SceneBody, Vec<[f64; 3]>)| {
            let masses: Vec<f64> = body.particles.iter().map(|id| system.masses()[id.index()]).collect();
            let [x, v] = [state.positions(), state.velocities()].map(|flat| vectors(system, flat, &body.particles));
            Pose::new(&masses, start, &x, &v)
        };
        self.bodies.iter().map(pose).collect()
    }
}

/// The vectors of some particles; z is 0 in two dimensions.
fn vectors(system: &System, flat: &[f64], particles: &[ParticleId]) -> Vec<[f64; 3]> {
    let d = system.dimension();
    let vector = |id: &ParticleId| std::array::from_fn(|k| if k < d { flat[id.index() * d + k] } else { 0.0 });
    particles.iter().map(vector).collect()
}
