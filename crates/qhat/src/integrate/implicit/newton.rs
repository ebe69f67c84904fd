//! Newton's method for one step, solved at its end.
//!
//! ```text
//! q̇ = (q − q*)/h_e                                        q*, q̇* and h_e say which method it is
//! M (q − q* − h_e q̇*) − h_e² Q(q, q̇) − Jᵀ μ = 0           μ = h_e² λ
//! C + α λ + α c Ċ = 0                                      α = 0 for a rigid row; C, J and Q at t + h
//! ```
//!
//! The factor of an iteration is kept for the next where the rate at which the residual fell says that it will do:
//! the last iteration of most steps then costs a solve and no factorization. `residual.rs` evaluates the equations
//! and says when they are met, `matrix.rs` is their derivative, `velocities.rs` projects q̇ afterwards.

use super::matrix::{Linearization, Matrix};
use super::residual::{Aim, Miss, exceeds};
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::settings::Settings;
use crate::system::System;

/// The motion that the step would have without forces; it says which method the step is of.
#[derive(Clone, Debug)]
pub(crate) struct Base {
    /// q* [m].
    pub(crate) q: Vec<f64>,
    /// q̇* [m/s].
    pub(crate) qd: Vec<f64>,
    /// h_e [s].
    pub(crate) h_e: f64,
    /// t at the end of the step [s], where everything is evaluated.
    pub(crate) end: f64,
}

/// Arrays of the iteration.
#[derive(Clone, Debug)]
pub(super) struct Newton {
    pub(super) matrix: Matrix,
    /// μ = h_e² λ.
    pub(super) mu: Vec<f64>,
    /// Right-hand sides, then Δq (by nodes) and −Δμ.
    pub(super) r: Vec<f64>,
    pub(super) s: Vec<f64>,
    /// Of each node the size of its forces, h_e² |Q| + Σ |μ| |g|, and of their change by the rounding of q, over ε.
    pub(super) load: Vec<f64>,
    pub(super) rounding: Vec<f64>,
    /// 1/scale of each row.
    pub(super) per_scale: Vec<f64>,
    /// The nearest iterate so far.
    best_q: Vec<f64>,
    best_mu: Vec<f64>,
}

/// The step being tried: q, q̇ and the equation evaluated there.
pub(super) struct Tried<'a> {
    pub(super) system: &'a System,
    pub(super) equation: &'a mut Equation,
    pub(super) q: &'a mut [f64],
    pub(super) qd: &'a mut [f64],
}

/// The end of an iteration; q and μ are the nearest iterate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ending {
    pub(super) has_converged: bool,
    pub(super) iterations: usize,
    /// Whether the matrix is factored, at the last iterate or one near by.
    pub(super) is_factored: bool,
    pub(super) miss: Miss,
}

impl Newton {
    pub(super) fn new(system: &System) -> Self {
        let (matrix, m) = (Matrix::new(system), system.all_row_count());
        let nodes = matrix.graph.particle.len();
        let coordinates = system.coordinate_count();
        Newton {
            mu: vec![0.0; m],
            r: vec![0.0; nodes * system.dimension()],
            s: vec![0.0; m],
            load: vec![0.0; nodes],
            rounding: vec![0.0; nodes],
            per_scale: system.row_scale.iter().map(|scale| 1.0 / scale).collect(),
            best_q: vec![0.0; coordinates],
            best_mu: vec![0.0; m],
            matrix,
        }
    }

    /// Solves for q (a guess on entry) and q̇ = (q − q*)/h_e. Leaves rows and forces evaluated there.
    pub(super) fn solve<const D: usize>(
        &mut self,
        settings: &Settings,
        base: &Base,
        limit: usize,
        tried: &mut Tried<'_>,
    ) -> Ending {
        let aim = Aim::new(tried.system, settings, base, tried.q);
        let mut miss = self.evaluate::<D>(&aim, tried);
        let (mut best, mut last) = (f64::INFINITY, f64::INFINITY);
        let (mut iterations, mut is_factored) = (0, false);
        while exceeds(miss.worst, 1.0) {
            if miss.worst < best {
                best = miss.worst;
                self.best_q.copy_from_slice(tried.q);
                self.best_mu.copy_from_slice(&self.mu);
            }
            // With the same factor the residual falls again as it just fell; two solves cost less than a new one.
            let falls = miss.worst / last;
            let will_do = is_factored && miss.worst * falls * falls <= 1.0;
            let is_lost = iterations == limit || !miss.worst.is_finite();
            if is_lost || !(will_do || self.factor::<D>(base, tried)) {
                tried.q.copy_from_slice(&self.best_q);
                self.mu.copy_from_slice(&self.best_mu);
                miss = self.evaluate::<D>(&aim, tried);
                // The factor belongs to the last iterate, not to the nearest.
                return Ending { has_converged: false, iterations, is_factored: false, miss };
            }
            is_factored = true;
            last = miss.worst;
            self.advance::<D>(tried.system, tried.q);
            iterations += 1;
            miss = self.evaluate::<D>(&aim, tried);
        }
        Ending { has_converged: true, iterations, is_factored, miss }
    }

    /// The factor of the matrix at the step being tried; whether it is definite.
    pub(super) fn factor<const D: usize>(&mut self, base: &Base, tried: &Tried<'_>) -> bool {
        let motion = Motion::<D> { q: tried.q, qd: tried.qd, t: base.end };
        let (rows, mu, h_e) = (&tried.equation.rows, &self.mu, base.h_e);
        let dependent = tried.equation.rank.as_ref().map_or(&[][..], |rank| &rank.dependent);
        self.matrix.factor(&Linearization { system: tried.system, rows, motion, mu, h_e, dependent })
    }

    /// q ← q + Δq, μ ← μ + Δμ.
    fn advance<const D: usize>(&mut self, system: &System, q: &mut [f64]) {
        self.matrix.solve::<D>(system, &mut self.r, &mut self.s);
        for (id, change) in self.matrix.graph.particle.iter().zip(self.r.chunks_exact(D)) {
            for (x, change) in q[id.0 * D..][..D].iter_mut().zip(change) {
                *x += change;
            }
        }
        for (mu, change) in self.mu.iter_mut().zip(&self.s) {
            *mu -= change;
        }
    }
}
