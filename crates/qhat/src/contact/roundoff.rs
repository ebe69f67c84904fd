//! Roundoff in forces and accelerations of a contact, by the forces on its own particles.

use super::Touching;
use crate::multiplier::{Equation, SAME};
use crate::point::norm;
use crate::system::System;

/// Part of the forces on the particles of a contact below which a negative force counts as roundoff: solutions have
/// some 1e-12 of it. The forces elsewhere do not matter, so a bead may lie on a drum beside a load of a billion beads.
const ROUNDOFF: f64 = 1e-10;

/// Part of the accelerations by those forces below which an acceleration counts as roundoff. A chain of beads moves
/// with its load, so the least acceleration that matters is this times the ratio of the masses.
const NO_ACCELERATION: f64 = 1e-12;

/// Part of the largest |b| of all touching contacts below which w is roundoff, however little acts on the particles of
/// its own contact: a few roundings, which λ of the rows near by brings there.
const SMALLEST: f64 = 16.0 * f64::EPSILON;

/// The roundoff in the rows of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roundoff {
    /// Of w: `NO_ACCELERATION` × (|b| + |J| W |f|), f the sum of the sizes of all forces on a particle; at least
    /// `SMALLEST` × the largest |b| of any touching contact.
    pub(super) w: f64,
    /// Of w in a row that follows from others, which it does up to the sine `SAME`: `SAME` × the same.
    pub(super) following: f64,
    /// Of λ: `ROUNDOFF` × the same over the diagonal of A; at least the λ of that.
    pub(super) force: f64,
}

/// The forces and right-hand sides by which roundoff is judged.
pub(super) struct Roundoffs {
    /// Σ |J_ip| |λ_i| + |F_p| of each particle.
    forces: Vec<f64>,
    /// `SMALLEST` × the largest |b| of any row of a touching contact.
    least: f64,
}

impl Roundoffs {
    pub(super) fn new<const D: usize>(equation: &Equation, system: &System, touching: &[Touching]) -> Self {
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
        let contacts = touching.iter().map(|touching| &system.contacts.list[touching.contact]);
        let rows = contacts.flat_map(|contact| std::iter::once(contact.normal).chain(contact.tangents.clone()));
        let largest = rows.fold(0.0_f64, |most, row| most.max(equation.b.sum[row].abs()));
        Roundoffs { forces, least: SMALLEST * largest }
    }

    /// Of the contact with this normal row.
    pub(super) fn of<const D: usize>(&self, equation: &Equation, system: &System, row: usize) -> Roundoff {
        let (J, layout) = (&equation.rows.J, &equation.rows.J.layout);
        let (mut w, mut diagonal) = (equation.b.sum[row].abs(), 0.0);
        for e in layout.start[row]..layout.start[row + 1] {
            let (particle, J) = (layout.particle[e].0, norm(J.entry::<D>(e)));
            w += J * system.inverse_mass[particle] * self.forces[particle];
            diagonal += J * J * system.inverse_mass[particle];
        }
        // A row between fixed particles has no diagonal: whatever its force is, it does nothing.
        let force = if diagonal > 0.0 { (ROUNDOFF * w).max(self.least) / diagonal } else { f64::INFINITY };
        Roundoff { w: (NO_ACCELERATION * w).max(self.least), following: (SAME * w).max(self.least), force }
    }
}
