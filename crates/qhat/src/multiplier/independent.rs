//! Independent rows: which rows of J follow from the others at one position, and so are redundant.
//!
//! ```text
//! g_i = s_i J_iᵀ,   s_i = 1/|J_i|                   row i as a direction: a unit vector over the free coordinates
//! M = S J Jᵀ S                                      M_ij is the cosine between rows i and j; no mass is in it
//! pivot of row i in L D Lᵀ = M:   sin²(row i, span of the rows before it)
//! ```
//!
//! 1. M is eliminated in the order of the structure. A row whose pivot is below `WAITS` is left out for the moment.
//! 2. A row that waits with a pivot below `SAME`² follows from the rows before it.
//! 3. For each of the others, the part of g_w across the span of the rows kept is computed itself,
//!
//! ```text
//! r_w = g_w − Jᵀ S x,   M_kept x = S J g_w        refined once: |r_w| is good to roundoff and not to its root
//! ```
//!
//!    and they are taken in turn, the largest first, as long as |r_w|, the sine of the angle, is above `SAME`. A row
//!    that is taken removes its direction from the r of the others (modified Gram and Schmidt).
//!
//! Neither masses nor units nor the form of a row change a sine, and no small eigenvalue is confused with a row that
//! repeats others: the least eigenvalue of a long truss is far below roundoff, while its pivots are 0.1 and more.
//! Source of the pivots as sines: Golub and Van Loan, Matrix Computations, 5.2 (L D Lᵀ of a Gram matrix is the squared
//! triangle of Gram and Schmidt).

use super::Equation;
use crate::state::Rank;
use crate::system::System;
use std::sync::Arc;

/// Pivot below which a row waits: the square of a sine of 0.1, an angle of 6°. Rows that are kept at once make M_kept
/// well conditioned.
const WAITS: f64 = 1e-2;

/// Sine below which a row counts as one that follows from others. A row at an angle σ to the others changes its C by
/// σ² while the motion goes the way σ across; with C held to 1e-10 nothing below 1e-5 can be seen, and half of that is
/// taken.
pub(crate) const SAME: f64 = 5e-6;

/// Numbers in the directions of all rows that wait; with more of them fewer rows are let wait.
const ROOM: usize = 10_000_000;

impl Equation {
    /// The rows that follow from other active rows at the J at hand, ascending. The factor and A at hand are lost.
    pub(super) fn dependent_rows<const D: usize>(&mut self, system: &System) -> Vec<u32> {
        let free = self.assemble_without_masses::<D>(system);
        self.solver.scale_rows(&system.matrix, &self.A, 0.0, &self.inactive, system.following());
        let coordinates = system.coordinate_count();
        let mut waits = WAITS;
        let (sure, waiting) = loop {
            let waiting = self.solver.factor_waiting(&system.matrix, waits);
            // Before a hub is eliminated, a pivot does not contain its share: it says nothing yet.
            let is_sure = |pivot: f64| system.matrix.on_hubs.is_empty() && pivot < SAME * SAME;
            let (sure, waiting): (Vec<_>, Vec<_>) = waiting.into_iter().partition(|&(_, pivot)| is_sure(pivot));
            if waiting.len() * coordinates <= ROOM || waits < SAME * SAME {
                break (sure, waiting);
            }
            waits *= 1e-2;
        };
        let mut left: Vec<(usize, Vec<f64>)> =
            waiting.iter().map(|&(place, _)| (place, self.across::<D>(system, &free, place))).collect();
        while let Some(best) = largest(&left) {
            let (_, mut direction) = left.swap_remove(best);
            let size = length(&direction);
            direction.iter_mut().for_each(|x| *x /= size);
            for (_, other) in &mut left {
                let along: f64 = other.iter().zip(&direction).map(|(a, b)| a * b).sum();
                other.iter_mut().zip(&direction).for_each(|(a, b)| *a -= along * b);
            }
        }
        let places = sure.iter().map(|&(place, _)| place).chain(left.iter().map(|&(place, _)| place));
        let found = places.map(|place| system.matrix.order[place]);
        let mut dependent: Vec<u32> = found.chain(system.following().iter().copied()).collect();
        dependent.sort_unstable();
        dependent
    }

    /// A ← J Jᵀ over coordinates that can move. Returns the numbers in place of W: 1 for a particle that can move, 0
    /// for a fixed one.
    pub(super) fn assemble_without_masses<const D: usize>(&mut self, system: &System) -> Vec<f64> {
        let free: Vec<f64> = system.inverse_mass.iter().map(|&w| if w > 0.0 { 1.0 } else { 0.0 }).collect();
        system.matrix.assemble::<D>(&self.rows.J, &free, &mut self.A);
        free
    }

    /// Leaves out `rows`, which have just become active, if all of them follow from the rows that were active with
    /// `rank`; the rows that are kept are then the same. Says whether it did. The factor and A at hand are lost.
    pub(crate) fn leave_out<const D: usize>(&mut self, system: &System, rank: &Rank, rows: &[usize]) -> bool {
        if self.dependent_rows::<D>(system).len() != rank.dependent.len() + rows.len() {
            return false;
        }
        let mut dependent = rank.dependent.clone();
        dependent.extend(rows.iter().map(|&row| row as u32));
        dependent.sort_unstable();
        self.rank = Some(Arc::new(Rank { inactive: self.inactive.clone(), dependent, ..*rank }));
        true
    }

    /// r_w of the row at a place of the order of elimination.
    fn across<const D: usize>(&mut self, system: &System, free: &[f64], place: usize) -> Vec<f64> {
        let (J, matrix) = (&self.rows.J, &system.matrix);
        let (m, row) = (J.row_count(), matrix.order[place] as usize);
        let mut r = vec![0.0; J.column_count()];
        let (mut x, mut along) = (vec![0.0; m], vec![0.0; m]);
        x[row] = 1.0;
        J.add_impulse::<D>(free, &x, 1.0, &mut r);
        let size = length(&r);
        r.iter_mut().for_each(|number| *number /= size);
        // The first pass leaves the rounding of M times its condition, the second that of the numbers alone.
        for _ in 0..2 {
            J.multiply::<D>(&r, &mut along);
            self.solver.solve_waiting(matrix, &along, &mut x);
            J.add_impulse::<D>(free, &x, -1.0, &mut r);
        }
        r
    }
}

/// |x|.
fn length(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The place of the longest direction in the list, if it is longer than `SAME`.
fn largest(left: &[(usize, Vec<f64>)]) -> Option<usize> {
    let sizes = left.iter().map(|(_, direction)| length(direction));
    let best = sizes.enumerate().fold((0, 0.0), |best, (k, size)| if size > best.1 { (k, size) } else { best });
    (best.1 > SAME).then_some(best.0)
}
