//! One step, solved at its end by Newton's method.
//!
//! ```text
//! q̇ = (q − q*)/h_e                                        q*, q̇* and h_e say which method it is
//! M (q − q* − h_e q̇*) − h_e² Q(q, q̇) − Jᵀ μ = 0           μ = h_e² λ
//! C + α λ + α c Ċ = 0                                      α = 0 for a rigid row; C, J and Q at t + h
//! ```
//!
//! The factor of an iteration is kept for the next where the speed at which the residual fell says that it will do: the last
//! iteration of most steps then costs a solve and no factorization.
//!
//! Arrived where each row is within half the tolerance of its scale and each particle's force within the same part of what
//! would move it by the system's extent in a step (and a hundred-millionth of what its rows carry), or within what rounding leaves: ε |λ| |g| (1 + |g| |q|/scale), since the
//! direction of a rod is rounded by ε |q|/r; and ε h_e² k |q| for a spring of stiffness k. Without that a load of 1e7 beads never stops.

use super::matrix::Matrix;
use crate::drift::attainable;
use crate::energy;
use crate::force::Acts;
use crate::integrate::projection::largest;
use crate::linalg::NONE;
use crate::multiplier::Equation;
use crate::point::{Motion, block, dot, norm};
use crate::settings::Settings;
use crate::system::System;

/// Rounding errors of a force add up over its terms; this many covers what chains under loads of 1e9 beads showed.
const ROUNDOFF: f64 = 16.0 * f64::EPSILON;

/// A short step hardly moves anything, whatever the forces; they must balance to this part of what the rows carry all the
/// same, so that what rests, rests where it should.
const BALANCED: f64 = 1e-8;

/// Which method: where q would be and how fast it would move without forces.
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
    /// Right sides, then Δq (by nodes) and −Δμ.
    r: Vec<f64>,
    s: Vec<f64>,
    /// What each node carries, h_e² |Q| + Σ |μ| |g|, and what the rounding of q does to its forces, over ε.
    load: Vec<f64>,
    rounding: Vec<f64>,
    /// 1/scale of each row.
    per_scale: Vec<f64>,
    /// The nearest iterate so far.
    best_q: Vec<f64>,
    best_mu: Vec<f64>,
}

/// The step being tried: q, q̇ and what is evaluated there.
pub(super) struct Tried<'a> {
    pub(super) equation: &'a mut Equation,
    pub(super) q: &'a mut [f64],
    pub(super) qd: &'a mut [f64],
}

/// What a step aims at.
struct Aim<'a> {
    base: &'a Base,
    /// How much of its own scale a row may be off.
    within: f64,
    /// The largest coordinate [m], as what its rounding is measured by.
    farthest: f64,
}

/// How far an iterate is from the solution, relative to what is asked for: 1 is just enough.
#[derive(Clone, Copy, Debug)]
pub(super) struct Miss {
    pub(super) worst: f64,
    /// The worst row with its |C + α λ + α c Ċ| over its scale.
    pub(super) row: usize,
    pub(super) relative: f64,
}

/// How an iteration ended; q and μ are the nearest iterate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ending {
    pub(super) has_arrived: bool,
    pub(super) iterations: usize,
    /// Whether the matrix is factored, at the last iterate or one near by.
    pub(super) is_factored: bool,
    pub(super) miss: Miss,
}

impl Newton {
    pub(super) fn new(system: &System) -> Self {
        let (matrix, m) = (Matrix::new(system), system.row_count());
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

    /// Solves for q (a guess on entry) and q̇ = (q − q*)/h_e. Leaves rows and forces at them.
    pub(super) fn solve<const D: usize>(
        &mut self,
        system: &System,
        settings: &Settings,
        base: &Base,
        limit: usize,
        tried: &mut Tried<'_>,
    ) -> Ending {
        let farthest = largest(tried.q);
        let aim = Aim { base, within: attainable(system, settings, farthest), farthest };
        let mut miss = self.evaluate::<D>(system, &aim, tried);
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
            if is_lost || !(will_do || self.factor::<D>(system, &aim, tried)) {
                tried.q.copy_from_slice(&self.best_q);
                self.mu.copy_from_slice(&self.best_mu);
                miss = self.evaluate::<D>(system, &aim, tried);
                // The factor belongs to wherever the iteration went.
                return Ending { has_arrived: false, iterations, is_factored: false, miss };
            }
            is_factored = true;
            last = miss.worst;
            self.advance::<D>(system, tried.q);
            iterations += 1;
            miss = self.evaluate::<D>(system, &aim, tried);
        }
        Ending { has_arrived: true, iterations, is_factored, miss }
    }

    fn factor<const D: usize>(&mut self, system: &System, aim: &Aim<'_>, tried: &Tried<'_>) -> bool {
        let motion = Motion::<D> { q: tried.q, qd: tried.qd, t: aim.base.end };
        self.matrix.factor(system, &tried.equation.rows, motion, &self.mu, aim.base.h_e)
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

    /// Rows and forces at q, the right sides of the next iteration, and how far they are from zero.
    fn evaluate<const D: usize>(&mut self, system: &System, aim: &Aim<'_>, tried: &mut Tried<'_>) -> Miss {
        let Aim { base, within, farthest } = *aim;
        let h_e = base.h_e;
        for (v, (x, from)) in tried.qd.iter_mut().zip(tried.q.iter().zip(&base.q)) {
            *v = (x - from) / h_e;
        }
        let motion = Motion::<D> { q: tried.q, qd: tried.qd, t: base.end };
        tried.equation.constrain(system, motion);
        system.add_applied_forces(motion, &mut tried.equation.Q);
        let (rows, Q) = (&tried.equation.rows, &tried.equation.Q);
        let Newton { matrix, mu, r, s, load, rounding, per_scale, .. } = self;
        for (r, id) in r.chunks_exact_mut(D).zip(&matrix.graph.particle) {
            let m = system.mass[id.0];
            for (k, r) in r.iter_mut().enumerate() {
                let i = id.0 * D + k;
                *r = h_e * h_e * Q[i] - m * (motion.q[i] - base.q[i] - h_e * base.qd[i]);
            }
        }
        for ((load, rounding), id) in load.iter_mut().zip(rounding.iter_mut()).zip(&matrix.graph.particle) {
            *load = h_e * h_e * norm(block::<D>(Q, *id));
            *rounding = system.mass[id.0] * farthest;
        }
        for force in &system.forces {
            force.stiffness(motion, &mut |id, stiffness, damping| {
                let node = matrix.graph.node(id);
                if node != NONE {
                    rounding[node] += h_e * (h_e * stiffness + damping) * farthest;
                }
            });
        }
        let mut miss = Miss { worst: 0.0, row: 0, relative: 0.0 };
        for row in 0..mu.len() {
            if matrix.graph.idle[row] {
                s[row] = 0.0;
                continue;
            }
            let soft = &system.softness[row];
            s[row] = if soft.is_rigid() {
                -rows.C[row]
            } else {
                let lambda = mu[row] / (h_e * h_e);
                -(rows.C[row] + soft.compliance * (soft.damping * rows.Cd[row] + lambda)) / soft.lag(h_e)
            };
            let per_scale = per_scale[row];
            for entry in system.layout.start[row]..system.layout.start[row + 1] {
                let node = matrix.graph.entry_node[entry];
                if node != NONE {
                    let g = rows.J.entry::<D>(entry);
                    for (r, g) in r[node * D..][..D].iter_mut().zip(g) {
                        *r += mu[row] * g;
                    }
                    // |g| to within √D, without a root: what it bounds is known no better.
                    let size: f64 = g.iter().map(|g| g.abs()).sum();
                    let pull = mu[row].abs() * size;
                    load[node] += pull;
                    rounding[node] += pull * size * farthest * per_scale;
                }
            }
            let relative = s[row].abs() * per_scale;
            if exceeds(relative, miss.relative) {
                miss = Miss { worst: relative / within, row, relative };
            }
        }
        for (node, (r, id)) in r.chunks_exact(D).zip(&matrix.graph.particle).enumerate() {
            let allowed = (system.mass[id.0] * system.extent * within).min(BALANCED * load[node]);
            let unbalanced = r.iter().map(|r| r * r).sum::<f64>().sqrt();
            let worst = unbalanced / (allowed + ROUNDOFF * (load[node] + rounding[node]));
            if exceeds(worst, miss.worst) {
                miss.worst = worst;
            }
        }
        miss
    }

    /// Takes out of q̇ what violates Ċ = 0, in the metric of the step's own matrix M + h_e² K: its factor is at hand, and what
    /// hangs on a tight rod is not kicked sideways as it would be in the metric of M. `is_factored` says whether this step made
    /// one. Returns the work of the drives in it [J].
    pub(super) fn project_velocities<const D: usize>(
        &mut self,
        system: &System,
        base: &Base,
        mut is_factored: bool,
        tried: &mut Tried<'_>,
    ) -> f64 {
        let Tried { equation, q, qd } = tried;
        /// The factor belongs to a q next door: each pass gains as many digits as J has in common there, four or more.
        const PASSES: usize = 4;
        /// A rate below this part of the fastest particle's speed over the extent is roundoff.
        const CONSISTENT: f64 = 1e-13;
        let fastest = qd.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut drives = 0.0;
        for _ in 0..PASSES {
            self.r.fill(0.0);
            let mut worst = 0.0_f64;
            for row in 0..self.s.len() {
                let takes_part = !self.matrix.graph.idle[row] && system.softness[row].is_rigid();
                let entries = system.layout.start[row]..system.layout.start[row + 1];
                let terms = entries.map(|e| dot(equation.rows.J.entry::<D>(e), block(qd, system.layout.particle[e])));
                let rate = terms.sum::<f64>() + equation.rows.Ct[row];
                self.s[row] = if takes_part { -rate } else { 0.0 };
                worst = worst.max(self.s[row].abs() * self.per_scale[row]);
            }
            if worst * system.extent <= CONSISTENT * fastest {
                break;
            }
            if !is_factored {
                is_factored =
                    self.matrix.factor(system, &equation.rows, Motion::<D> { q, qd, t: base.end }, &self.mu, base.h_e);
            }
            if !is_factored {
                break;
            }
            self.matrix.solve::<D>(system, &mut self.r, &mut self.s);
            // s is the impulse turned round.
            drives -= energy::drive_power(system, &equation.rows.Ct, &self.s);
            for (id, change) in self.matrix.graph.particle.iter().zip(self.r.chunks_exact(D)) {
                for (v, change) in qd[id.0 * D..][..D].iter_mut().zip(change) {
                    *v += change;
                }
            }
        }
        equation.constrain(system, Motion::<D> { q, qd, t: base.end });
        drives
    }
}

/// a > b, or a is no number: what is not finite counts as the worst of all.
#[inline(always)]
fn exceeds(a: f64, b: f64) -> bool {
    a > b || a.is_nan()
}
