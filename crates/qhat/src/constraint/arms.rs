//! Arms: vectors d from one particle to another. Several kinds of constraints are functions of such vectors only.
//! `Arms` turns ∂C/∂d into the gradient of C, also where several arms end at one particle.
//!
//! ```text
//! d = x_b − x_a,   ∂C/∂x_i = Σ (∂C/∂d of the arms that end at i) − Σ (∂C/∂d of the arms that begin at i)
//! ```

use super::smooth::{At, Gradient};
use crate::number::{Number, minus, plus};
use crate::space::ParticleId;
use std::collections::BTreeMap;

/// The arms of a constraint and the particles that they connect.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arms {
    /// The particles, each once.
    particles: Vec<ParticleId>,
    /// The beginning and the end of each arm, as indices into `particles`.
    ends: Vec<[usize; 2]>,
    /// The arms at each particle, ascending, and whether each ends there. A row over k arms takes time in proportion
    /// to k with this list.
    at: Vec<Vec<(usize, bool)>>,
}

impl Arms {
    pub(super) fn new(arms: impl IntoIterator<Item = [ParticleId; 2]>) -> Self {
        let mut particles: Vec<ParticleId> = Vec::new();
        let mut places = BTreeMap::new();
        let mut place = |id: ParticleId| {
            *places.entry(id).or_insert_with(|| {
                particles.push(id);
                particles.len() - 1
            })
        };
        let ends: Vec<[usize; 2]> = arms.into_iter().map(|[a, b]| [place(a), place(b)]).collect();
        let mut at = vec![Vec::new(); particles.len()];
        for (arm, &[a, b]) in ends.iter().enumerate() {
            at[b].push((arm, true));
            if a != b {
                at[a].push((arm, false));
            }
        }
        Arms { particles, ends, at }
    }

    pub(super) fn particles(&self) -> &[ParticleId] {
        &self.particles
    }

    pub(super) fn count(&self) -> usize {
        self.ends.len()
    }

    /// The particles at which an arm begins and ends.
    pub(super) fn ends(&self, arm: usize) -> [ParticleId; 2] {
        self.ends[arm].map(|place| self.particles[place])
    }

    /// The ends of every arm.
    pub(super) fn all(&self) -> Vec<[ParticleId; 2]> {
        (0..self.count()).map(|arm| self.ends(arm)).collect()
    }

    /// Whether an arm begins and ends at the same particle.
    pub(super) fn is_without_length(&self, arm: usize) -> bool {
        self.ends[arm][0] == self.ends[arm][1]
    }

    /// d of one arm.
    pub(super) fn vector<N: Number, const D: usize>(&self, arm: usize, at: &At<N, D>) -> [N; D] {
        let [a, b] = self.ends[arm];
        minus(at.x(b), at.x(a))
    }

    /// Hands ∂C/∂x to `gradient`, particle after particle, given ∂C/∂d of each arm.
    pub(super) fn spread<N: Number, const D: usize>(
        &self,
        of_arm: impl Fn(usize) -> [N; D],
        gradient: &mut Gradient<N, D>,
    ) {
        for arms in &self.at {
            let mut sum = [N::constant(0.0); D];
            for &(arm, ends_here) in arms {
                sum = if ends_here { plus(sum, of_arm(arm)) } else { minus(sum, of_arm(arm)) };
            }
            gradient.push(sum);
        }
    }
}
