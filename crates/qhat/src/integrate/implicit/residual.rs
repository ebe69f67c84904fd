//! The equations of a step at an iterate, and how far they are from zero.
//!
//! They are met where
//!
//! - each row is within half the tolerance of its scale;
//! - the force on each particle is within the same part of the force that would move it by the extent of the system
//!   in a step, and within 1e-8 of the size of its forces;
//! - or what is left is rounding: ε |λ| |g| (1 + |g| |q|/scale) of a row, since the direction of a rod is rounded by
//!   ε |q|/r; and ε h_e² k |q| of a spring of stiffness k. Without this a load of 1e7 beads never converges.

use super::newton::{Base, Newton, Tried};
use crate::drift::attainable;
use crate::force::Acts;
use crate::linalg::NONE;
use crate::point::{Motion, block, largest, norm};
use crate::settings::Settings;
use crate::system::System;

/// Rounding of a force, relative to the size of its terms: roundings add up over the terms, and this many cover
/// chains under loads of 1e9 beads.
pub(super) const ROUNDOFF: f64 = 16.0 * f64::EPSILON;

/// Part of the size of the forces on a particle to which they must balance. A short step hardly moves anything,
/// whatever the forces; with this, a system at rest stays where it should.
const BALANCED: f64 = 1e-8;

/// The accuracy that a step aims at.
pub(super) struct Aim<'a> {
    base: &'a Base,
    /// The residual of a row that is allowed, over its scale.
    within: f64,
    /// The largest coordinate [m], for the rounding of coordinates.
    farthest: f64,
}

impl<'a> Aim<'a> {
    pub(super) fn new(system: &System, settings: &Settings, base: &'a Base, q: &[f64]) -> Self {
        let farthest = largest(q);
        Aim { base, within: attainable(system, settings, farthest), farthest }
    }
}

/// The distance of an iterate from the solution, relative to the accuracy asked for: 1 is just enough.
#[derive(Clone, Copy, Debug)]
pub(super) struct Miss {
    pub(super) worst: f64,
    /// The worst row, with its |s| over its scale.
    pub(super) row: usize,
    pub(super) relative: f64,
}

impl Newton {
    /// Evaluates rows and forces at q, and the right-hand sides r and s of the next iteration.
    pub(super) fn evaluate<const D: usize>(&mut self, aim: &Aim<'_>, tried: &mut Tried<'_>) -> Miss {
        let Aim { base, within, farthest } = *aim;
        let (system, h_e) = (tried.system, base.h_e);
        // Fixed particles have no node, and no velocity: the rounding of q* would move them a little in every step.
        tried.qd.fill(0.0);
        for id in &self.matrix.graph.particle {
            for k in id.0 * D..(id.0 + 1) * D {
                tried.qd[k] = (tried.q[k] - base.q[k]) / h_e;
            }
        }
        let motion = Motion::<D> { q: tried.q, qd: tried.qd, t: base.end };
        tried.equation.constrain(system, motion);
        system.add_applied_forces(motion, &mut tried.equation.Q);
        let (rows, Q) = (&tried.equation.rows, &tried.equation.Q);
        let Newton { matrix, mu, r, s, load, rounding, per_scale, .. } = self;
        // r = h_e² Q − M (q − q* − h_e q̇*), and Jᵀ μ below.
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
            // s = −(C + α λ + α c Ċ)/(1 + α c/h_e).
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
                    // |g| to within √D, without a root: the bounds that it enters are no more accurate.
                    let size: f64 = g.iter().map(|g| g.abs()).sum();
                    let force = mu[row].abs() * size;
                    load[node] += force;
                    rounding[node] += force * size * farthest * per_scale;
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
}

/// a > b, or a is not a number: such a residual counts as the worst of all.
#[inline(always)]
pub(super) fn exceeds(a: f64, b: f64) -> bool {
    a > b || a.is_nan()
}
