//! Powers: the rate at which each force and each constraint does work on the particles.
//!
//! ```text
//! of a force f:        P_f = Q_f · q̇                               [W]
//! of a constraint c:   P_c = Σ over its rows of λ (J q̇),  J q̇ = Ċ − C_t
//! Σ P_f + Σ P_c = q̇ · (Q + Q̂) = dT/dt
//! ```
//!
//! On legal motion Ċ = 0, and a rigid constraint has the power −λ C_t: that of its drive. A constraint that gives
//! way is a force, whose λ is that of its own law. Friction is in the rows of its contact.

use super::Simulation;
use crate::force::{Acts, Force};
use crate::point::{Motion, block, dot};
use crate::space::in_dimension;

/// The power of each force and constraint on the particles \[W\]; positive where it speeds them up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Powers {
    /// Of each force, in the order of addition.
    pub forces: Vec<f64>,
    /// Of each constraint, in the order of addition: of its drive, of its friction, or of its elasticity.
    pub constraints: Vec<f64>,
}

impl Simulation {
    /// The power of each force and constraint at the present state. Their sum is the rate of the kinetic energy. A
    /// trajectory of powers integrates to the work of each load and drive.
    ///
    /// ```
    /// use qhat::{Dimension, Gravity, Particle, Settings, Simulation, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// builder.particle(Particle::at("stone", [0.0, 0.0]).with_velocity([0.0, -3.0]).with_mass(2.0));
    /// builder.force(Gravity::new([0.0, -10.0]));
    /// let (system, state) = builder.build()?;
    /// let mut simulation = Simulation::new(system, state, Settings::default())?;
    /// assert_eq!(simulation.powers().forces, [60.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn powers(&mut self) -> Powers {
        in_dimension!(self.system.dimension, D => Powers {
            forces: self.powers_of_forces::<D>(),
            constraints: self.powers_of_constraints::<D>(),
        })
    }

    fn powers_of_forces<const D: usize>(&self) -> Vec<f64> {
        let (system, state) = (&self.system, &self.state);
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        let mut Q = vec![0.0; system.coordinate_count()];
        let power = |force: &Force| {
            force.add(motion, &system.mass, &mut Q);
            let mut touched = force.particles();
            if touched.is_empty() {
                touched.extend(system.particles());
            }
            let mut power = 0.0;
            for id in touched {
                // Fixed particles take no work.
                if !system.is_fixed(id) {
                    power += dot(block::<D>(&Q, id), motion.v(id));
                }
                Q[id.0 * D..][..D].fill(0.0);
            }
            power
        };
        system.forces[..system.force_names.len()].iter().map(power).collect()
    }

    fn powers_of_constraints<const D: usize>(&mut self) -> Vec<f64> {
        let feedback = self.feedback_in_use();
        let (system, s) = (&self.system, 1.0 - feedback.elasticity);
        let equation = self.workspace.solve::<D>(system, &self.state, &feedback);
        let of_row = |row: usize| {
            let entries = system.layout.start[row]..system.layout.start[row + 1];
            let terms = entries.map(|e| {
                let id = system.layout.particle[e];
                // Fixed particles take no work.
                if system.is_fixed(id) { 0.0 } else { dot(equation.rows.J.entry::<D>(e), block(&self.state.qd, id)) }
            });
            // As in `Simulation::reaction`.
            let factor = if system.is_rigid(row) { s } else { 1.0 };
            factor * equation.lambda[row] * terms.sum::<f64>()
        };
        system.constraints().iter().map(|named| named.rows(D).map(of_row).sum()).collect()
    }
}
