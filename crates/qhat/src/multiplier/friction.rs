//! Coulomb friction of what slides: an applied force that follows the multiplier.
//!
//! ```text
//! F = −Σ μ λ_n Σ_k d_k J_tkᵀ          over the sliding contacts; d: unit direction of the slip in the tangential rows
//! A λ = b − J W F(λ)
//! ```
//!
//! F is linear in the λ_n that slide, x: with the answer g_s of A to the friction of one newton at each of them,
//!
//! ```text
//! A λ⁰ = b,   A g_s = −J W F(e_s),   λ = λ⁰ + Σ g_s x_s,   (I − G) x = λ⁰_n,   G_rs = (g_s) in the normal row of r
//! ```
//!
//! a solve with the factor at hand for each, and a small dense system. Where I − G is singular friction presses its own contact as hard as it is
//! pressed (Painlevé's paradox), and there is no answer.

use crate::constraint::Rows;
use crate::point::{add, block, dot, scaled};
use std::ops::Range;

/// The direction follows the slip where that is this many times what friction changes of it in a substep. What is slower turns at
/// a rate that no explicit method follows, and straightens itself: it keeps its direction.
const FAST: f64 = 4.0;

/// Where the slip has left that direction by more than this [rad], substeps must be short enough to follow it.
const ASTRAY: f64 = 0.03;

/// A contact that slides.
#[derive(Clone, Debug)]
pub(crate) struct Sliding {
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// μ.
    pub(crate) friction: f64,
    /// d.
    pub(crate) direction: [f64; 2],
    /// d where the substep began: what turns far from it within one has come to a stop on the way.
    pub(crate) began: [f64; 2],
    /// Whether d follows the slip.
    pub(crate) turns: bool,
}

impl Sliding {
    /// The longest substep in which d can follow the slip [s], and the slip: at a beginning with these rates.
    fn follows<const D: usize>(&self, begin: &Beginning, rows: &Rows, W: &[f64]) -> (f64, [f64; 2]) {
        let layout = &rows.J.layout;
        let row = self.tangents.start;
        let entries = layout.start[row]..layout.start[row + 1];
        let w: f64 = entries.map(|e| W[layout.particle[e].0] * dot(rows.J.entry::<D>(e), rows.J.entry::<D>(e))).sum();
        let slip = [begin.Cd[row], begin.Cd[row + 1]];
        let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
        (speed / (FAST * self.friction * begin.lambda[self.normal].abs() * w), slip)
    }

    /// Adds F for λ_n.
    fn add_force<const D: usize>(&self, lambda: f64, rows: &Rows, F: &mut [f64]) {
        let layout = &rows.J.layout;
        for (row, d) in self.tangents.clone().zip(self.direction) {
            for e in layout.start[row]..layout.start[row + 1] {
                add(F, layout.particle[e], scaled(-self.friction * lambda * d, rows.J.entry::<D>(e)));
            }
        }
    }

    /// Turns d to where the contact slips now, in space; in the plane it cannot turn while the mode lasts.
    fn follow(&mut self, rows: &Rows) {
        if self.tangents.len() == 2 && self.turns {
            let slip = [rows.Cd[self.tangents.start], rows.Cd[self.tangents.start + 1]];
            let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            let along = slip[0] * self.began[0] + slip[1] * self.began[1];
            let follows = speed > 0.0 && along > 0.5 * speed;
            self.direction = if follows { slip.map(|component| component / speed) } else { self.began };
        }
    }
}

/// Ċ of every row, whether it took part or not, and λ, where a substep begins.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beginning {
    pub(crate) Cd: Vec<f64>,
    pub(crate) lambda: Vec<f64>,
}

/// All contacts that slide, and F.
#[derive(Clone, Debug, Default)]
pub(crate) struct Friction {
    pub(crate) sliding: Vec<Sliding>,
    /// F [N], d·n numbers; empty until something slides.
    pub(crate) force: Vec<f64>,
    /// −J W F(e_s), of the one at hand.
    pub(crate) target: Vec<f64>,
    /// g_s, m numbers each; as many as ever slid at once.
    pub(crate) answers: Vec<Vec<f64>>,
    /// I − G, row after row, and λ⁰_n, then x.
    matrix: Vec<f64>,
    x: Vec<f64>,
}

impl Friction {
    pub(crate) fn is_empty(&self) -> bool {
        self.sliding.is_empty()
    }

    /// Decides for a substep of h which directions follow the slip.
    pub(crate) fn prepare<const D: usize>(&mut self, begin: &Beginning, rows: &Rows, W: &[f64], h: f64) {
        for sliding in self.sliding.iter_mut().filter(|sliding| sliding.tangents.len() == 2) {
            sliding.turns = sliding.follows::<D>(begin, rows, W).0 > h;
        }
    }

    /// The longest substep from here [s]: bounded where something slips faster than `slow` and has left its direction.
    pub(crate) fn longest<const D: usize>(&self, begin: &Beginning, rows: &Rows, W: &[f64], slow: f64) -> f64 {
        let mut longest = f64::INFINITY;
        for sliding in self.sliding.iter().filter(|sliding| sliding.tangents.len() == 2) {
            let (h, slip) = sliding.follows::<D>(begin, rows, W);
            let across = (slip[0] * sliding.began[1] - slip[1] * sliding.began[0]).abs();
            let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            if speed > slow && across > ASTRAY * speed {
                longest = longest.min(0.5 * h);
            }
        }
        longest
    }

    pub(crate) fn follow(&mut self, rows: &Rows) {
        self.sliding.iter_mut().for_each(|sliding| sliding.follow(rows));
    }

    /// Makes room for so many answers.
    pub(crate) fn begin(&mut self, count: usize, rows: usize) {
        self.answers.resize(count.max(self.answers.len()), Vec::new());
        self.answers.iter_mut().for_each(|answer| answer.resize(rows, 0.0));
        self.target.resize(rows, 0.0);
    }

    /// −J W F(e_s): what one newton at s asks of A.
    pub(crate) fn write_unit<const D: usize>(&mut self, s: usize, rows: &Rows, W: &[f64]) {
        self.force.clear();
        self.force.resize(rows.J.column_count(), 0.0);
        self.sliding[s].add_force::<D>(1.0, rows, &mut self.force);
        let layout = &rows.J.layout;
        for (row, target) in self.target.iter_mut().enumerate() {
            let entries = layout.start[row]..layout.start[row + 1];
            let pull = |e: usize| {
                let particle = layout.particle[e];
                W[particle.0] * dot(rows.J.entry::<D>(e), block(&self.force, particle))
            };
            *target = -entries.map(pull).sum::<f64>();
        }
    }

    /// From λ⁰ to λ, and F.
    pub(crate) fn finish<const D: usize>(&mut self, rows: &Rows, lambda: &mut [f64]) {
        let count = self.sliding.len();
        self.matrix.clear();
        for r in &self.sliding {
            self.matrix.extend(self.answers[..count].iter().map(|g| -g[r.normal]));
        }
        (0..count).for_each(|k| self.matrix[k * count + k] += 1.0);
        self.x.clear();
        self.x.extend(self.sliding.iter().map(|sliding| lambda[sliding.normal]));
        eliminate(&mut self.matrix, &mut self.x);
        self.force.fill(0.0);
        for ((sliding, g), &x) in self.sliding.iter().zip(&self.answers).zip(&self.x) {
            sliding.add_force::<D>(x, rows, &mut self.force);
            lambda.iter_mut().zip(g).for_each(|(lambda, g)| *lambda += g * x);
        }
    }
}

/// x ← A⁻¹ x by elimination with the largest pivot of each column; not a number where A is singular. A is small, and lost.
fn eliminate(A: &mut [f64], x: &mut [f64]) {
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
