//! One substep of Radau IIA: stages, error estimate, and the next length; `projection.rs` is its projection.

use super::Scratch;
use super::stages::{Convergence, MOST_ITERATIONS, Step};
use super::tableau::{A, ESTIMATE, REAL, combine};
use crate::drift::{Drift, drift};
use crate::energy;
use crate::integrate::adaptive::pair::{ERROR_SCALE, norm};
use crate::integrate::adaptive::{Attempt, Outcome, Refusal, Stepper, accepts, accepts_move};
use crate::multiplier::{APPROACH, Equation};
use crate::point::Motion;
use crate::settings::Settings;
use crate::state::{Collocation, State};
use crate::system::System;

/// Rate of convergence above which the next substep has a matrix of its own.
const SLOW: f64 = 1e-3;

/// Part of the length at which the error would be one tolerance.
const SAFE: f64 = 0.9;

/// A substep that would grow by less than this keeps its length, and with it its factors.
const KEPT: f64 = 1.1;

/// Rate of convergence to which the growth of the next substep may lead.
const CONVERGENT: f64 = 0.3;

/// The factor by which a substep grows at most, and shrinks at least.
const GROWTH: f64 = 8.0;
const SHRINKAGE: f64 = 0.1;

/// Margin to a singular position above which none is within a substep: the sine of where the rank was noted, or more.
const FAR: f64 = 1.0;

/// Margin below which C is held to roundoff: what C is off by moves q̇ by as much over the square of the margin.
const SHARP: f64 = 0.5;

/// Part of a substep over which the margin is differenced.
const LOOK_AHEAD: f64 = 0.01;

/// Ratio of lengths up to which the polynomials of the last substep are a guess for the next.
const ONWARDS: f64 = 3.0;

/// Radau IIA under way over one frame.
pub(super) struct RadauStepper<'a, const D: usize> {
    pub(super) system: &'a System,
    pub(super) settings: &'a Settings,
    pub(super) scratch: &'a mut Scratch,
    /// The equation for accelerations, which tells how far a singular position is.
    pub(super) equation: &'a mut Equation,
    /// λ at the start of the substep, by the rows of the system.
    pub(super) lambda: Vec<f64>,
    /// What the last substep left for the next.
    pub(super) before: Option<Collocation>,
    /// Whether a matrix is at hand.
    pub(super) is_linearized: bool,
    /// Whether that matrix is one of this substep.
    pub(super) is_fresh: bool,
    /// Whether the projection tried last made a matrix of the end of its substep.
    pub(super) is_ahead: bool,
    /// The length of the substep for which the matrix is factored [s].
    pub(super) factored_for: Option<f64>,
    /// Whether the substep tried last was rejected.
    pub(super) was_rejected: bool,
    pub(super) convergence: Convergence,
    /// The error of the substep tried last.
    pub(super) error: f64,
    /// Whether the motion is near a position where the rank of A drops, which this method does not cross.
    pub(super) gives_up: bool,
    /// Whether the motion is so near to one that C is held to roundoff.
    pub(super) sharpens: bool,
}

impl<const D: usize> Stepper for RadauStepper<'_, D> {
    fn estimate_order(&self) -> f64 {
        4.0
    }

    fn longest(&mut self, _: &State) -> f64 {
        f64::INFINITY
    }

    /// Looks for a singular position. All three stages of a substep across it would be near it, and the corrections of
    /// a projection are divided by its distance.
    fn across(&mut self, state: &State, h: f64, remaining: f64) -> Option<f64> {
        if self.system.row_count() == 0 {
            return None;
        }
        self.equation.place_feet::<D>(self.system, state);
        let here = self.margin_after(state, 0.0);
        self.sharpens = here.is_some_and(|here| here < SHARP);
        self.gives_up = match here {
            Some(here) if here >= FAR => false,
            Some(here) if here >= APPROACH => {
                let next = self.margin_after(state, LOOK_AHEAD * h).unwrap_or(0.0);
                here - (here - next) * (h.min(remaining) / (LOOK_AHEAD * h)) < APPROACH
            }
            _ => true,
        };
        None
    }

    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome {
        if self.gives_up {
            return Outcome::Singular;
        }
        let step = Step { system: self.system, settings: self.settings, state, h, end };
        if !self.solve(&step) {
            return Outcome::NotMet;
        }
        self.error = self.error(&step);
        if !self.error.is_finite() {
            return Outcome::NotMet;
        }
        let iterations = self.convergence.iterations;
        let mut attempt = Attempt { h, error: self.error, iterations, dissipation: 0.0, drives: 0.0 };
        if !accepts(self.error, self.settings) {
            return Outcome::Met(attempt);
        }
        self.add_work(&step, &mut attempt);
        // The motion at hand is now that of the last stage.
        let Scratch { stages, tried_q, tried_qd, .. } = &mut *self.scratch;
        tried_q.copy_from_slice(&stages.q);
        tried_qd.copy_from_slice(&stages.qd);
        match self.project(&step) {
            Some(_) if self.passes_an_edge(&step) => Outcome::Refused(Refusal::Edge),
            Some(_) if !accepts_move(self.moved(h), self.settings) => {
                // The error is about the motion that was projected.
                let Scratch { stages, tried_q, tried_qd, .. } = &mut *self.scratch;
                stages.q.copy_from_slice(tried_q);
                stages.qd.copy_from_slice(tried_qd);
                Outcome::Refused(Refusal::Jump)
            }
            Some(iterations) => {
                attempt.iterations += iterations;
                Outcome::Met(attempt)
            }
            None => Outcome::NotMet,
        }
    }

    fn keep(&mut self, state: &mut State, h: f64) -> Drift {
        let stages = &mut self.scratch.stages;
        std::mem::swap(&mut state.q, &mut stages.q);
        std::mem::swap(&mut state.qd, &mut stages.qd);
        self.lambda.copy_from_slice(&stages.lambda);
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t + h };
        self.system.follow_feet(&mut stages.rows, motion, &mut state.feet);
        let mut collocation = self.before.take().unwrap_or_default();
        collocation.stages.clear();
        stages.z.iter().for_each(|z| collocation.stages.extend(z));
        (collocation.h, collocation.error) = (h, self.error);
        self.before = Some(collocation);
        self.is_fresh = false;
        // A matrix of the end of the step serves the next one.
        self.is_linearized = self.is_ahead || !self.is_slow();
        self.was_rejected = false;
        drift::<D>(self.system, &self.scratch.stages.rows, &[], &state.q)
    }

    fn turn_back(&mut self, _: &State) {
        self.was_rejected = true;
    }

    fn end(&mut self, _: &mut State) {}

    fn write_tried(&self, state: &mut State) {
        state.q.copy_from_slice(&self.scratch.stages.q);
        state.qd.copy_from_slice(&self.scratch.stages.qd);
    }

    /// Towards an error of one tolerance, with the trend of the last two errors (Gustafsson's predictive controller);
    /// more carefully the more iterations were needed, and not at all where the factors can then stay.
    fn growth(&self, attempt: &Attempt, settings: &Settings) -> f64 {
        let tolerance = settings.tolerance;
        let most = 2 * MOST_ITERATIONS + 1;
        let safe = SAFE * most as f64 / (most - 1 + self.convergence.iterations) as f64;
        let error = (attempt.error / tolerance).max(f64::MIN_POSITIVE);
        let mut growth = fourth_root(1.0 / error);
        if !accepts(attempt.error, self.settings) {
            return (safe * growth).clamp(SHRINKAGE, SAFE);
        }
        if let Some(before) = &self.before {
            // Errors of almost nothing tell no trend.
            let last = (before.error / tolerance).max(1e-2);
            growth = growth.min(attempt.h / before.h * fourth_root(last / error) * growth);
        }
        // The rate grows about as the square of h; the iteration should not be what rejects the next substep.
        let convergent = (CONVERGENT / self.convergence.rate).sqrt().max(1.0);
        let most = if self.was_rejected { 1.0 } else { GROWTH.min(convergent) };
        let growth = (safe * growth).clamp(SHRINKAGE, most);
        if (1.0..KEPT).contains(&growth) && !self.is_slow() { 1.0 } else { growth }
    }
}

impl<const D: usize> RadauStepper<'_, D> {
    /// The margin to a singular position, a time s along the velocity; `None` where the rank has dropped.
    fn margin_after(&mut self, state: &State, s: f64) -> Option<f64> {
        let (system, q) = (self.system, &mut self.scratch.tried_q);
        q.iter_mut().zip(state.q.iter().zip(&state.qd)).for_each(|(q, (x, v))| *q = x + s * v);
        self.equation.constrain(system, Motion::<D> { q, qd: &state.qd, t: state.t + s });
        self.equation.factor::<D>(system, 0.0);
        if s == 0.0 {
            self.equation.rank = self.equation.rank_to_keep::<D>(system);
        }
        self.equation.margin::<D>(system)
    }

    /// Whether the matrix at hand served the last substep badly.
    fn is_slow(&self) -> bool {
        self.convergence.iterations > 2 && self.convergence.rate > SLOW
    }

    /// Solves for the stages. Whether the iteration converged.
    fn solve(&mut self, step: &Step<'_>) -> bool {
        loop {
            self.guess(step);
            if !self.is_linearized {
                self.linearize(step);
            }
            let Scratch { saddle, factors, stages, .. } = &mut *self.scratch;
            if self.factored_for != Some(step.h) {
                self.factored_for = None;
                if factors.factor::<D>(saddle, step.h) {
                    self.factored_for = Some(step.h);
                }
            }
            if self.factored_for.is_some() {
                self.convergence = stages.solve::<D>(step, saddle, factors, |stages| {
                    ERROR_SCALE * (1.0 / stages.speed(step, saddle)).max(step.h / step.system.extent)
                });
                if self.convergence.is_met {
                    return true;
                }
            }
            self.is_linearized = false;
            if self.is_fresh {
                return false;
            }
        }
    }

    /// The first guess of the stages.
    fn guess(&mut self, step: &Step<'_>) {
        let Scratch { saddle, stages, .. } = &mut *self.scratch;
        match &self.before {
            Some(before) if step.h <= ONWARDS * before.h && before.stages.len() == 3 * saddle.unknowns() => {
                stages.guess_onwards(saddle, &before.stages, step.h / before.h);
            }
            _ => stages.guess_rest(saddle, &self.lambda),
        }
    }

    /// K, B, J and J̇ at the second stage as it is guessed, two thirds of the way. Where a stiff spring turns by φ from
    /// there to a stage, the iteration converges like φ² times its stiffness; from the start φ would be twice as large.
    fn linearize(&mut self, step: &Step<'_>) {
        let Scratch { saddle, stages, .. } = &mut *self.scratch;
        stages.motion::<D>(step, saddle, 1);
        let t = step.time(1);
        stages.evaluate_rows::<D>(self.system, t);
        let motion = Motion::<D> { q: &stages.q, qd: &stages.qd, t };
        saddle.linearize(self.system, motion, &stages.rows, &stages.lambda);
        (self.is_linearized, self.is_fresh, self.factored_for) = (true, true, None);
    }

    /// The error estimate, in the unit of the tolerance: (γ/h − ∂f/∂y)⁻¹ (f(y₀) + Σ e_i z_i/h) of positions and
    /// velocities, on (J q̇)' = 0. Where the estimate is too large at a start or after a rejected substep, f is taken
    /// once more at y₀ plus the estimate: what a stiff force does to it then falls away.
    fn error(&mut self, step: &Step<'_>) -> f64 {
        let Scratch { saddle, stages, tried_q, tried_qd, .. } = &mut *self.scratch;
        tried_q.copy_from_slice(&step.state.q);
        tried_qd.copy_from_slice(&step.state.qd);
        let speed = stages.speed(step, saddle);
        let error = self.estimate(step, speed);
        if accepts(error, self.settings) || !(self.was_rejected || self.before.is_none()) {
            return error;
        }
        let Scratch { saddle, error_q, error_qd, tried_q, tried_qd, .. } = &mut *self.scratch;
        saddle.add_to::<D>(error_q, tried_q);
        saddle.add_to::<D>(error_qd, tried_qd);
        self.estimate(step, speed)
    }

    /// The estimate with f at the motion in `tried_q` and `tried_qd`.
    fn estimate(&mut self, step: &Step<'_>, speed: f64) -> f64 {
        let Scratch { saddle, factors, stages, tried_q, tried_qd, error_q, error_qd, rhs } = &mut *self.scratch;
        let (h, velocities) = (step.h, saddle.velocities());
        stages.q.copy_from_slice(tried_q);
        stages.qd.copy_from_slice(tried_qd);
        stages.lambda.copy_from_slice(&self.lambda);
        stages.evaluate::<D>(self.system, saddle, step.state.t, 0);
        // Σ e_i z_i/h of positions is Σ e_i a_ij z_j − q̇₀, since Σ e_i c_i = −1.
        let of_positions: [f64; 3] = std::array::from_fn(|j| combine(&ESTIMATE, [A[0][j], A[1][j], A[2][j]]));
        for u in 0..velocities {
            let z = [stages.z[0][u], stages.z[1][u], stages.z[2][u]];
            error_q[u] = combine(&of_positions, z);
            error_qd[u] = stages.evaluated(0)[u] + saddle.mass[u / D] * combine(&ESTIMATE, z) / h;
        }
        for (node, id) in saddle.particle.iter().enumerate() {
            for k in 0..D {
                error_q[node * D + k] += tried_qd[id.0 * D + k] - step.state.qd[id.0 * D + k];
            }
        }
        let per = h / REAL;
        saddle.stiffness_times::<D>(error_q, rhs);
        saddle.turning_times::<D>(error_q, &mut rhs[velocities..]);
        for u in 0..velocities {
            error_qd[u] = per * (error_qd[u] - per * rhs[u]);
        }
        for u in velocities..saddle.unknowns() {
            error_qd[u] = -per * rhs[u];
        }
        factors.solve(saddle, error_qd);
        let (mut squares_q, mut squares_qd) = (0.0, 0.0);
        for u in 0..velocities {
            error_q[u] = per * (error_qd[u] + error_q[u]);
            squares_q += error_q[u] * error_q[u];
            squares_qd += error_qd[u] * error_qd[u];
        }
        ERROR_SCALE * norm(self.system, [squares_q, squares_qd], speed)
    }

    /// Work of forces without a potential and of drives, by the quadrature of the method. Leaves the motion of the last
    /// stage as the motion at hand.
    fn add_work(&mut self, step: &Step<'_>, attempt: &mut Attempt) {
        let Scratch { saddle, stages, .. } = &mut *self.scratch;
        for i in 0..3 {
            stages.motion::<D>(step, saddle, i);
            let motion = Motion::<D> { q: &stages.q, qd: &stages.qd, t: step.time(i) };
            attempt.dissipation += step.h * A[2][i] * energy::dissipation(self.system, motion, &[]);
            if stages.is_driven {
                self.system.evaluate_rows(motion, &mut stages.rows);
                let power = energy::drive_power(self.system, &stages.rows.Ct, &stages.lambda);
                attempt.drives += step.h * A[2][i] * power;
            }
        }
    }
}

/// x^¼, of square roots, which round alike everywhere.
fn fourth_root(x: f64) -> f64 {
    x.sqrt().sqrt()
}
