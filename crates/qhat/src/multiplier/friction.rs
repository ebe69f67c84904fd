//! Coulomb friction of sliding contacts: an applied force that follows the multiplier.
//!
//! ```text
//! F = −Σ_k μ_k x_k Σ_i d_ki J_kiᵀ        k: sliding contacts, x_k: λ of the normal row of k,
//! A λ = b − J W F(x)                     d_k: unit direction of the slip in the tangential rows i of k
//! ```
//!
//! F is linear in x. With g_k, the answer of A to the friction of a normal force of one newton at contact k,
//!
//! ```text
//! A λ⁰ = b,   A g_k = −J W F(e_k)                  one solve each, with the factor at hand
//! (I − G) x = λ⁰_n,   G_jk = g_k in the normal row of contact j        a small dense system
//! λ = λ⁰ + Σ_k g_k x_k
//! ```
//!
//! Where I − G is singular, friction presses a contact as hard as the contact is pressed (Painlevé's paradox), and no λ
//! exists. λ is then not a number.

use crate::constraint::Rows;
use crate::modes::Slip;
use crate::point::{add, block, dot, scaled};
use std::ops::Range;

/// A sliding contact: its rows, and its slip in the substep being tried.
#[derive(Clone, Debug)]
pub(crate) struct Sliding {
    /// Its index among the contacts.
    pub(crate) contact: usize,
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// μ.
    pub(crate) friction: f64,
    pub(crate) slip: Slip,
}

impl Sliding {
    /// λ_t = −μ λ_n d, in the multipliers.
    pub(super) fn write_multipliers(&self, lambda: &mut [f64]) {
        let lambda_n = lambda[self.normal];
        for (row, d) in self.tangents.clone().zip(self.slip.direction) {
            lambda[row] = -self.friction * lambda_n * d;
        }
    }

    /// F += −μ λ_n Σ_i d_i J_iᵀ.
    fn add_force<const D: usize>(&self, lambda_n: f64, rows: &Rows, F: &mut [f64]) {
        let layout = &rows.J.layout;
        for (row, d) in self.tangents.clone().zip(self.slip.direction) {
            for e in layout.start[row]..layout.start[row + 1] {
                add(F, layout.particle[e], scaled(-self.friction * lambda_n * d, rows.J.entry::<D>(e)));
            }
        }
    }
}

/// F, and the arrays that its solve writes in.
#[derive(Clone, Debug, Default)]
pub(crate) struct Friction {
    /// F [N], d·n numbers; empty until a contact slides, and out of date while none does.
    pub(crate) force: Vec<f64>,
    /// −J W F(e_k), of the contact at hand.
    target: Vec<f64>,
    /// g_k, m numbers each; as many as contacts ever slid at once.
    answers: Vec<Vec<f64>>,
    /// I − G, row after row.
    matrix: Vec<f64>,
    /// λ⁰_n, then x.
    x: Vec<f64>,
}

impl Friction {
    /// λ⁰ → λ, and F, for the sliding contacts; `solve` writes the solution of A g = target for a given target.
    pub(crate) fn solve<const D: usize>(
        &mut self,
        sliding: &[Sliding],
        rows: &Rows,
        W: &[f64],
        lambda: &mut [f64],
        mut solve: impl FnMut(&[f64], &mut [f64]),
    ) {
        let (count, m) = (sliding.len(), lambda.len());
        self.answers.resize(count.max(self.answers.len()), Vec::new());
        self.answers.iter_mut().for_each(|g| g.resize(m, 0.0));
        self.target.resize(m, 0.0);
        for (k, contact) in sliding.iter().enumerate() {
            self.write_target::<D>(contact, rows, W);
            solve(&self.target, &mut self.answers[k]); // A g_k = −J W F(e_k)
        }
        self.matrix.clear();
        for contact in sliding {
            self.matrix.extend(self.answers[..count].iter().map(|g| -g[contact.normal])); // −G
        }
        (0..count).for_each(|k| self.matrix[k * count + k] += 1.0); // I − G
        self.x.clear();
        self.x.extend(sliding.iter().map(|contact| lambda[contact.normal])); // λ⁰_n
        eliminate(&mut self.matrix, &mut self.x); // (I − G) x = λ⁰_n
        self.force.fill(0.0);
        for ((contact, g), &x) in sliding.iter().zip(&self.answers).zip(&self.x) {
            contact.add_force::<D>(x, rows, &mut self.force); // F(x)
            lambda.iter_mut().zip(g).for_each(|(lambda, g)| *lambda += g * x); // λ⁰ + Σ g_k x_k
        }
    }

    /// target ← −J W F(e_k).
    fn write_target<const D: usize>(&mut self, contact: &Sliding, rows: &Rows, W: &[f64]) {
        self.force.clear();
        self.force.resize(rows.J.column_count(), 0.0);
        contact.add_force::<D>(1.0, rows, &mut self.force);
        let layout = &rows.J.layout;
        for (row, target) in self.target.iter_mut().enumerate() {
            let entries = layout.start[row]..layout.start[row + 1];
            let J_W_F = |e: usize| {
                let particle = layout.particle[e];
                W[particle.0] * dot(rows.J.entry::<D>(e), block(&self.force, particle))
            };
            *target = -entries.map(J_W_F).sum::<f64>();
        }
    }
}

/// x ← A⁻¹ x by elimination with the largest pivot of each column; not a number where A is singular. A is small, and
/// overwritten.
pub(super) fn eliminate(A: &mut [f64], x: &mut [f64]) {
    let n = x.len();
    for k in 0..n {
        let pivot = (k + 1..n).fold(k, |best, i| if A[i * n + k].abs() > A[best * n + k].abs() { i } else { best });
        (0..n).for_each(|j| A.swap(k * n + j, pivot * n + j));
        x.swap(k, pivot);
        for i in k + 1..n {
            let factor = A[i * n + k] / A[k * n + k];
            (k..n).for_each(|j| A[i * n + j] -= factor * A[k * n + j]);
            x[i] -= factor * x[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| A[k * n + j] * x[j]).sum();
        x[k] = (x[k] - known) / A[k * n + k];
    }
}
