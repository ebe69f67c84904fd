//! What roundoff leaves of forces and accelerations of a contact, by the forces on its own particles.

use crate::multiplier::Equation;
use crate::point::norm;
use crate::system::System;

/// Part of the forces on the particles of a contact below which a negative force counts as roundoff: solutions have
/// some 1e-12 of it. The forces elsewhere do not matter, so a bead may lie on a drum beside a load of a billion beads.
const ROUNDOFF: f64 = 1e-10;

/// Part of the accelerations by those forces below which an acceleration counts as roundoff. A chain of beads moves
/// with its load, so the least acceleration that matters is this times the ratio of the masses.
const NO_ACCELERATION: f64 = 1e-12;

/// What roundoff leaves in the normal row of a contact.
#[derive(Clone, Copy)]
pub(super) struct Roundoff {
    /// Of w: `NO_ACCELERATION` × (|b| + |J| W |f|), f the sum of the sizes of all forces on a particle.
    pub(super) w: f64,
    /// Of λ: `ROUNDOFF` × the same over the diagonal of A.
    pub(super) force: f64,
}

impl Roundoff {
    /// Σ |J_ip| |λ_i| + |F_p| of each particle.
    pub(super) fn forces<const D: usize>(equation: &Equation, system: &System) -> Vec<f64> {
        let (J, layout) = (&equation.rows.J, &equation.rows.J.layout);
        let mut forces = vec![0.0; system.particle_count()];
        for (row, lambda) in equation.lambda.iter().enumerate().filter(|(_, lambda)| **lambda != 0.0) {
            for e in layout.start[row]..layout.start[row + 1] {
                forces[layout.particle[e].0] += lambda.abs() * norm(J.entry::<D>(e));
            }
        }
        if !equation.sliding.is_empty() {
            let friction = equation.friction.force.chunks_exact(D);
            forces.iter_mut().zip(friction).for_each(|(sum, F)| *sum += F.iter().map(|F| F.abs()).sum::<f64>());
        }
        forces
    }

    pub(super) fn of<const D: usize>(equation: &Equation, system: &System, row: usize, forces: &[f64]) -> Self {
        let (J, layout) = (&equation.rows.J, &equation.rows.J.layout);
        let (mut w, mut diagonal) = (equation.b.sum[row].abs(), 0.0);
        for e in layout.start[row]..layout.start[row + 1] {
            let (particle, J) = (layout.particle[e].0, norm(J.entry::<D>(e)));
            w += J * system.inverse_mass[particle] * forces[particle];
            diagonal += J * J * system.inverse_mass[particle];
        }
        // A row between fixed particles has no diagonal: whatever its force is, it does nothing.
        Roundoff { w: NO_ACCELERATION * w, force: if diagonal > 0.0 { ROUNDOFF * w / diagonal } else { f64::INFINITY } }
    }
}
