//! Field: q̈ as a function of q, q̇ and t for a Runge–Kutta method, and the projection onto the constraints.
//!
//! Positions and velocities are in blocks of eight numbers, in an order of the field's own: eight stretches of chain
//! side by side, or the user's order filled up with zeros. The method adds and scales blocks without knowing which.

use super::Workspace;
use super::edges::Passage;
use crate::chains::{Chains, Projected};
use crate::drift::{Drift, attainable, drift, worst_row};
use crate::energy;
use crate::linalg::eight::{F8, LANES, Largest, vector_unit};
use crate::multiplier::{APPROACH, Equation, Needed};
use crate::point::{Motion, largest};
use crate::settings::{Feedback, Settings};
use crate::state::State;
use crate::structure::ChainPlan;
use crate::system::System;

/// Newton iterations of one projection. The factor is that of the last stage, near by, and the correction is small: a
/// projection that takes more is not worth its substep.
const MAX_ITERATIONS: usize = 8;

/// Newton iterations that take C from its tolerance to roundoff.
const SHARPENED: usize = 2;

/// Margin to a singular position below which velocities are not projected: what Ċ is off by there changes q̇ by a
/// hundred times as much, in a direction that the constraints hardly see.
const NEAR: f64 = 1e-2;

/// Margin below which a substep may lead near a singular position. With 0.2, from where on substeps are placed, two of
/// 33,540 random frameworks ended with an error.
const WITHIN_REACH: f64 = 0.5;

/// Part of a substep over which the margin is differenced.
const LOOK_AHEAD: f64 = 0.01;

/// Power that no potential accounts for [W].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Power {
    pub(super) dissipation: f64,
    pub(super) stabilization: f64,
    pub(super) drives: f64,
}

/// q̈(q, q̇, t), in an order of its own. The two implementations are [`GeneralField`] and [`ChainField`].
pub(super) trait Field {
    /// Number of blocks of eight numbers that q has.
    fn blocks(&self) -> usize;

    /// Writes the state to blocks.
    fn begin(&mut self, state: &State, q: &mut [F8], qd: &mut [F8]);

    /// Writes blocks back to the state.
    fn end(&self, q: &[F8], qd: &[F8], state: &mut State);

    /// Writes q̈. `None` if A is singular on this path; the caller falls back to the general one.
    fn accelerate(&mut self, q: &[F8], qd: &[F8], t: f64, qdd: &mut [F8]) -> Option<Power>;

    /// Projects q onto C = 0 and q̇ onto Ċ = 0 at the time t; says whether that was possible, and its iterations.
    fn project(&mut self, q: &mut [F8], qd: &mut [F8], t: f64, settings: &Settings) -> Projected;

    /// The residuals of C = 0 and Ċ = 0 that the last projection left.
    fn drift(&self, q: &[F8], qd: &[F8]) -> Drift;

    /// The time after which the motion comes to a position where the rank drops, if that is within a few h; `None` at
    /// other positions, and where it is not known.
    fn time_to_singular(&mut self, _q: &[F8], _qd: &[F8], _t: f64, _h: f64) -> Option<f64> {
        None
    }

    /// The largest relative residual of A λ = b since the last call.
    fn imbalance(&mut self) -> f64 {
        0.0
    }

    /// Whether the substep from (q, q̇) at `from` to the motion projected last at `to` passes an edge.
    fn passes_an_edge(&self, _q: &[F8], _qd: &[F8], _from: f64, _to: f64) -> bool {
        false
    }

    /// Keeps the motion projected last, at the time t: moves the feet of beads on to it.
    fn follow(&mut self, _t: f64, _feet: &mut Vec<f64>) {}

    /// Whether a substep from the motion that `time_to_singular` was asked about last may lead near a position where
    /// the rank drops.
    fn is_near_singular(&self) -> bool {
        false
    }

    /// Whether velocities of the motion that was kept last were not projected, as near a singular position.
    fn is_unprojected(&self) -> bool {
        false
    }

    /// Gives up the motion projected last: the next call of `accelerate` is at the motion before it.
    fn turn_back(&mut self);

    /// 1 where a number of block k counts in the error estimate, 0 in copies of particles.
    fn counted(&self, k: usize) -> F8;
}

/// Any system, in the user's order, by the equation of `multiplier/`.
pub(super) struct GeneralField<'a, const D: usize> {
    pub(super) system: &'a System,
    pub(super) workspace: &'a mut Workspace,
    pub(super) feedback: Feedback,
    /// Whether the factor at hand is that of A at the next call of `accelerate`.
    pub(super) is_factored: bool,
    /// Whether velocities were not projected in the last projection.
    pub(super) skips: bool,
    /// Whether velocities were not projected in the projection of the motion kept last.
    pub(super) skipped: bool,
    /// Whether the margin of the last motion that was asked about is below `WITHIN_REACH`.
    is_near: bool,
    /// J at the start of the substep, in a system with rows whose gradient may jump.
    pub(super) before: Vec<f64>,
}

impl<'a, const D: usize> GeneralField<'a, D> {
    /// At a motion where the rows of the workspace have been evaluated.
    pub(super) fn new(system: &'a System, workspace: &'a mut Workspace, feedback: Feedback, is_factored: bool) -> Self {
        let (skips, skipped, is_near, before) = (false, false, false, Vec::new());
        let mut field = GeneralField { system, workspace, feedback, is_factored, skips, skipped, is_near, before };
        field.note_gradients();
        field
    }

    fn note_gradients(&mut self) {
        if !self.system.jumpy.is_empty() {
            self.before.clone_from(&self.workspace.equation.rows.J.blocks);
        }
    }
}

pub(super) fn pack(flat: &[f64], blocks: &mut [F8]) {
    for (chunk, block) in flat.chunks(LANES).zip(blocks) {
        block.0[..chunk.len()].copy_from_slice(chunk);
    }
}

pub(super) fn unpack(blocks: &[F8], flat: &mut [f64]) {
    for (chunk, block) in flat.chunks_mut(LANES).zip(blocks) {
        chunk.copy_from_slice(&block.0[..chunk.len()]);
    }
}

impl<const D: usize> Field for GeneralField<'_, D> {
    fn blocks(&self) -> usize {
        self.system.coordinate_count().div_ceil(LANES)
    }

    fn begin(&mut self, state: &State, q: &mut [F8], qd: &mut [F8]) {
        pack(&state.q, q);
        pack(&state.qd, qd);
    }

    fn end(&self, q: &[F8], qd: &[F8], state: &mut State) {
        unpack(q, &mut state.q);
        unpack(qd, &mut state.qd);
    }

    fn accelerate(&mut self, q: &[F8], qd: &[F8], t: f64, qdd: &mut [F8]) -> Option<Power> {
        let Workspace { equation, q: flat_q, qd: flat_qd, .. } = &mut *self.workspace;
        unpack(q, flat_q);
        unpack(qd, flat_qd);
        let motion = Motion::<D> { q: flat_q, qd: flat_qd, t };
        equation.solve(self.system, motion, &self.feedback, self.is_factored, Needed::Accelerations);
        self.is_factored = false;
        pack(&equation.qdd, qdd);
        let constraint_power = equation.Q_hat.iter().zip(&*flat_qd).map(|(force, velocity)| force * velocity);
        let drives = equation.drive_power(self.system, &self.feedback);
        let friction: f64 = equation.friction_power(motion.qd);
        Some(Power {
            dissipation: energy::dissipation(self.system, motion, &equation.broken) + friction,
            stabilization: constraint_power.sum::<f64>() - drives,
            drives,
        })
    }

    fn project(&mut self, q: &mut [F8], qd: &mut [F8], t: f64, settings: &Settings) -> Projected {
        let Workspace { equation, q: flat_q, qd: flat_qd, delta, .. } = &mut *self.workspace;
        let (system, matrix) = (self.system, &self.system.matrix);
        unpack(q, flat_q);
        unpack(qd, flat_qd);
        for iteration in 0..=MAX_ITERATIONS {
            equation.constrain(system, Motion::<D> { q: flat_q, qd: flat_qd, t });
            let (row, off) = worst_row(system, &equation.rows.C);
            if off <= attainable(system, settings, largest(flat_q)) {
                equation.factor::<D>(system, 0.0);
                let margin = equation.margin::<D>(system);
                if margin.is_some_and(|margin| margin < APPROACH) {
                    for _ in 0..SHARPENED {
                        equation.solver.solve(matrix, &equation.rows.C, delta);
                        equation.rows.J.add_impulse::<D>(&system.inverse_mass, delta, -1.0, flat_q);
                        equation.constrain(system, Motion::<D> { q: flat_q, qd: flat_qd, t });
                    }
                    equation.factor::<D>(system, 0.0);
                }
                self.skips = margin.is_none_or(|margin| margin <= NEAR);
                if !self.skips {
                    equation.rows.rates::<D>(flat_qd, &mut equation.b.sum);
                    equation.solver.solve(matrix, &equation.b.sum, delta);
                    equation.rows.J.add_impulse::<D>(&system.inverse_mass, delta, -1.0, flat_qd);
                    equation.constrain(system, Motion::<D> { q: flat_q, qd: flat_qd, t });
                }
                pack(flat_q, q);
                pack(flat_qd, qd);
                self.is_factored = true;
                return Projected::Met(iteration);
            }
            if off.is_infinite() {
                break;
            }
            if iteration == MAX_ITERATIONS && equation.follows(row) {
                // The rows that were kept no longer say what this one says.
                equation.rank = None;
                equation.factor::<D>(system, 0.0);
            }
            equation.solver.solve(matrix, &equation.rows.C, delta);
            equation.rows.J.add_impulse::<D>(&system.inverse_mass, delta, -1.0, flat_q);
        }
        Projected::NotMet
    }

    fn drift(&self, _: &[F8], _: &[F8]) -> Drift {
        drift::<D>(self.system, &self.workspace.equation.rows, &self.workspace.equation.inactive, &self.workspace.q)
    }

    fn imbalance(&mut self) -> f64 {
        std::mem::take(&mut self.workspace.equation.imbalance)
    }

    fn time_to_singular(&mut self, q: &[F8], qd: &[F8], t: f64, h: f64) -> Option<f64> {
        let Workspace { equation, q: flat_q, qd: flat_qd, .. } = &mut *self.workspace;
        if !self.is_factored {
            unpack(q, flat_q);
            unpack(qd, flat_qd);
            equation.constrain(self.system, Motion::<D> { q: flat_q, qd: flat_qd, t });
            equation.factor::<D>(self.system, 0.0);
            self.is_factored = true;
        }
        let margin = equation.margin::<D>(self.system);
        self.is_near = margin.is_some_and(|margin| margin < WITHIN_REACH);
        let here = margin.filter(|&margin| margin < APPROACH)?;
        let ahead = LOOK_AHEAD * h;
        unpack(q, flat_q);
        unpack(qd, flat_qd);
        flat_q.iter_mut().zip(&*flat_qd).for_each(|(x, v)| *x += ahead * v);
        equation.constrain(self.system, Motion::<D> { q: flat_q, qd: flat_qd, t: t + ahead });
        equation.factor::<D>(self.system, 0.0);
        self.is_factored = false;
        let next = equation.margin::<D>(self.system).unwrap_or(0.0);
        (next < here).then(|| ahead * here / (here - next))
    }

    fn is_near_singular(&self) -> bool {
        self.is_near
    }

    fn is_unprojected(&self) -> bool {
        self.skipped
    }

    fn follow(&mut self, t: f64, feet: &mut Vec<f64>) {
        self.skipped = self.skips;
        let Workspace { equation, q, qd, .. } = &mut *self.workspace;
        equation.follow_feet(self.system, Motion::<D> { q, qd, t }, feet);
        self.note_gradients();
    }

    fn passes_an_edge(&self, q: &[F8], qd: &[F8], from: f64, to: f64) -> bool {
        let (system, workspace) = (self.system, &*self.workspace);
        if system.jumpy.is_empty() && system.bead_places.is_empty() {
            return false;
        }
        let [mut start_q, mut start_qd] = [&workspace.q, &workspace.qd].map(|numbers| vec![0.0; numbers.len()]);
        unpack(q, &mut start_q);
        unpack(qd, &mut start_qd);
        let from = Motion::<D> { q: &start_q, qd: &start_qd, t: from };
        let to = Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: to };
        let Equation { rows, inactive, .. } = &workspace.equation;
        Passage { system, rows, inactive, before: &self.before, from, to }.is_barred()
    }

    fn turn_back(&mut self) {
        self.is_factored = false;
    }

    fn counted(&self, _: usize) -> F8 {
        F8::splat(1.0)
    }
}

/// Open chains, by the equation of `chains/`.
pub(super) struct ChainField<'a, const D: usize> {
    pub(super) system: &'a System,
    pub(super) plan: &'a ChainPlan,
    pub(super) chains: &'a mut Chains,
}

impl<const D: usize> Field for ChainField<'_, D> {
    fn blocks(&self) -> usize {
        self.plan.blocks() * D
    }

    fn begin(&mut self, state: &State, q: &mut [F8], qd: &mut [F8]) {
        self.chains.begin::<D>(self.system, self.plan, state, q, qd);
    }

    fn end(&self, q: &[F8], qd: &[F8], state: &mut State) {
        self.chains.end::<D>(self.plan, q, qd, state);
    }

    fn accelerate(&mut self, q: &[F8], qd: &[F8], t: f64, qdd: &mut [F8]) -> Option<Power> {
        let dissipation = self.chains.accelerate::<D>(self.system, self.plan, q, qd, t, qdd)?;
        Some(Power { dissipation, ..Power::default() })
    }

    fn project(&mut self, q: &mut [F8], qd: &mut [F8], _: f64, settings: &Settings) -> Projected {
        let attainable = attainable(self.system, settings, vector_unit().dispatch(Largest(q)));
        self.chains.project::<D>(self.plan, q, qd, attainable)
    }

    fn drift(&self, q: &[F8], qd: &[F8]) -> Drift {
        self.chains.drift::<D>(self.plan, q, qd)
    }

    fn turn_back(&mut self) {}

    fn counted(&self, k: usize) -> F8 {
        self.plan.counted[k / D]
    }
}
