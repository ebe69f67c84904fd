// Included once for the plane and once for space: `super::rapier` is Rapier for D dimensions.

use super::rapier::prelude::*;
use super::{D, vector};
use crate::{Engine, Setting, Workload};

/// The largest useful stiffness of a spring in Rapier [N/m]: every solver iteration corrects the whole error.
const STIFFNESS: f64 = 1e15;

/// A motion in Rapier.
pub struct World {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    steps: usize,
}

impl World {
    pub fn new(workload: &Workload, setting: &Setting) -> Self {
        let mut world = PhysicsWorld { gravity: vector(&workload.gravity), ..PhysicsWorld::default() };
        let steps = setting.number("substeps");
        world.integration_parameters.dt = workload.frame / steps as f64;
        world.integration_parameters.num_solver_iterations = setting.number("iterations");
        let turns = matches!(setting.word("joint"), "hinge" | "tree");
        let bodies: Vec<RigidBodyHandle> = (0..workload.masses.len())
            .map(|i| {
                let at = vector(&workload.positions[D * i..][..D]);
                let body = if workload.fixed[i] == 1 { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() };
                let body = body.translation(at).can_sleep(false);
                // A link on hinges turns with its rod, and Rapier needs a moment of inertia for the turning. A
                // ten-thousandth of m r² changes the motion less than the steps do. Without hinges no body turns.
                let body = if turns {
                    body.additional_mass_properties(point_mass(workload, i))
                } else {
                    body.lock_rotations().additional_mass(workload.masses[i])
                };
                world.insert_body(body)
            })
            .collect();
        for (ends, &length) in workload.ends.chunks_exact(2).zip(&workload.lengths) {
            let (a, b) = (bodies[ends[0]], bodies[ends[1]]);
            let apart = world.bodies[a].translation() - world.bodies[b].translation();
            match setting.word("joint") {
                "spring" => {
                    world.insert_impulse_joint(a, b, SpringJointBuilder::new(length, STIFFNESS, 0.0));
                }
                "hinge" => {
                    world.insert_impulse_joint(a, b, super::hinge(apart));
                }
                "tree" => {
                    world.insert_multibody_joint(a, b, super::hinge(apart)).expect("a chain has no loops");
                }
                other => panic!("no joint is called {other}"),
            }
        }
        World { world, bodies, steps }
    }
}

fn point_mass(workload: &Workload, particle: usize) -> MassProperties {
    let mass = workload.masses[particle];
    super::mass_properties(mass, mass * 1e-4 * workload.lengths[0].powi(2))
}

impl Engine for World {
    fn step(&mut self) {
        for _ in 0..self.steps {
            self.world.step();
        }
    }

    fn read(&self) -> (Vec<f64>, Vec<f64>) {
        let of = |told: fn(&RigidBody) -> Vector| {
            self.bodies.iter().flat_map(|&body| super::numbers(told(&self.world.bodies[body]))).collect()
        };
        (of(|body| body.translation()), of(|body| body.linvel()))
    }
}
