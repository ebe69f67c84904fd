//! The constraint matrix.
//!
//! ```text
//! A = J W Jᵀ,   A_ij = Σ_p w_p J_ip · J_jp        m × m, symmetric, positive semidefinite
//! ```
//!
//! Two rows are coupled only if they share a particle that can move, so A is as sparse as the graph of rods. Which pairs of
//! blocks meet in which entry is found once, when the System is built; so is the order of elimination, in which A is stored.

use crate::constraint::{Jacobian, Layout};
use crate::linalg::{Component, DENSE_UP_TO, Incidence, Pattern, Plan, Symbolic, SymmetricMatrix};
use crate::point::{dot, scaled};
use crate::system::ParticleId;
use std::sync::Arc;

/// The structure of A: its pattern, what is summed into each entry, and how it will be factored.
#[derive(Clone, Debug, Default)]
pub(crate) struct MatrixStructure {
    /// In the order of elimination.
    pub(crate) pattern: Pattern,
    /// `order[k]` is the row that is eliminated k-th.
    pub(crate) order: Vec<u32>,
    /// For each particle in turn that can move: its blocks of J, and then the slots that their pairs are added to.
    meeting: Vec<Meeting>,
    blocks: Vec<u32>,
    slots: Vec<u32>,
    /// Rows all of whose particles are fixed: their row of A is zero for good, no λ can act through them.
    pub(crate) inert: Vec<bool>,
    pub(crate) symbolic: Arc<Symbolic>,
    pub(crate) components: Vec<Component>,
}

/// Where the rows of one particle meet.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    particle: ParticleId,
    /// Number of its blocks of J.
    blocks: u32,
}

impl MatrixStructure {
    pub(crate) fn new(layout: &Layout, W: &[f64]) -> Self {
        let m = layout.row_count();
        let entries = |row: usize| layout.start[row]..layout.start[row + 1];
        let moves = |e: &usize| W[layout.particle[*e].0] > 0.0;
        let inert = (0..m).map(|row| !entries(row).any(|e| moves(&e))).collect();
        let points = |row: usize| entries(row).filter(moves).map(|e| layout.particle[e].0 as u32);
        let incidence = Incidence::new(W.len(), (0..m).map(points));
        let plan = Plan::new(&incidence);
        // What is small is factored densely, in the order given.
        let order = if m <= DENSE_UP_TO { (0..m as u32).collect() } else { plan.order.clone() };
        let incidence = incidence.permuted(&order);
        let pattern = Pattern::of_incidence(&incidence);
        let symbolic = Arc::new(Symbolic::new(&pattern, &plan, None));
        let mut structure = MatrixStructure {
            pattern,
            order,
            meeting: Vec::new(),
            blocks: Vec::new(),
            slots: Vec::new(),
            inert,
            symbolic,
            components: plan.components,
        };
        structure.meet(layout, &incidence);
        structure
    }

    /// Finds the slots of all pairs of rows at each particle, particles in the order in which elimination touches them.
    fn meet(&mut self, layout: &Layout, incidence: &Incidence) {
        let mut seen = vec![false; incidence.points()];
        for first in 0..self.order.len() as u32 {
            for &p in incidence.points_of(first) {
                if std::mem::replace(&mut seen[p as usize], true) {
                    continue;
                }
                let rows = incidence.unknowns_at(p);
                for (k, &left) in rows.iter().enumerate() {
                    let row = self.order[left as usize] as usize;
                    let entries = layout.start[row]..layout.start[row + 1];
                    let here = entries.into_iter().find(|&e| layout.particle[e].0 == p as usize);
                    self.blocks.extend(here.map(|e| e as u32));
                    let slots = rows[..=k].iter().filter_map(|&right| self.pattern.slot(left as usize, right as usize));
                    self.slots.extend(slots.map(|slot| slot as u32));
                }
                self.meeting.push(Meeting { particle: ParticleId(p as usize), blocks: rows.len() as u32 });
            }
        }
    }

    /// Writes A = J W Jᵀ.
    pub(crate) fn assemble<const D: usize>(&self, J: &Jacobian, W: &[f64], A: &mut [f64]) {
        A.fill(0.0);
        let (mut blocks, mut slots) = (&self.blocks[..], &self.slots[..]);
        for meeting in &self.meeting {
            let w = W[meeting.particle.0];
            let (here, rest) = blocks.split_at(meeting.blocks as usize);
            blocks = rest;
            for (k, &left) in here.iter().enumerate() {
                let wJ = scaled(w, J.entry::<D>(left as usize));
                let (row, rest) = slots.split_at(k + 1);
                slots = rest;
                for (&slot, &right) in row.iter().zip(here) {
                    A[slot as usize] += dot(wJ, J.entry::<D>(right as usize));
                }
            }
        }
    }

    /// A with its rows in the order the user gave them.
    pub(crate) fn in_given_order(&self, A: &[f64]) -> SymmetricMatrix {
        SymmetricMatrix { pattern: self.pattern.clone(), values: A.to_vec() }.renumbered(&self.order)
    }
}
