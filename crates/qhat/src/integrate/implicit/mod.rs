//! Implicit methods: steps solved at their end, with geometric stiffness in the matrix. Stiff or heavily loaded
//! systems need them where the step is given.
//!
//! A chain under tension T has transverse waves up to ω = 2√(T/(m L)), and every explicit method bounds h ω. Here
//! K = −Σ λ ∂²C/∂q² is added to the mass, so that h ω may be anything. In tension it stiffens, and M + h² K is positive
//! definite. In compression its sign is kept while the matrix stays definite, since buckling must be seen.
//!
//! `newton.rs` is the iteration that all methods share, `matrix.rs` its matrix. A method is a [`Formula`]:
//! `backward_euler.rs`, `bdf2.rs`.
//! Source: Tournier, Nesme, Gilles, Faure, Stable Constrained Dynamics, ACM Trans. Graph. 34 (2015).

pub(crate) mod backward_euler;
pub(crate) mod bdf2;
mod graph;
mod matrix;
mod newton;
mod passes;
mod reach;
mod residual;
mod stiffness;
#[cfg(test)]
mod tests;
mod velocities;

pub(crate) use newton::Base;

use super::check_finite;
use super::failure::{at_an_edge, jumps, not_satisfied, shrinks, without_length};
use super::frame::Frame;
use crate::drift::{attainable, drift};
use crate::energy;
use crate::error::StepError;
use crate::multiplier::APPROACH;
use crate::point::{Motion, largest};
use crate::report::{Solver, StepReport, Warning};
use crate::settings::{Feedback, Integrator};
use crate::state::{Carry, Previous, State};
use crate::system::System;
use graph::check_couplings;
use newton::{Ending, Newton, Tried};
use residual::exceeds;

/// Newton iterations of one step. From q + h q̇ most steps take a few, and factor the matrix four times or less
/// (`tests/verify_implicit.rs`); the crack of a whip and a hanging net take more. Beyond this number two halves of the
/// step are cheaper.
const MOST_ITERATIONS: usize = 60;

/// Newton iterations after which a step of a method of second order is done again with backward Euler. Such a step is
/// never cut short: an unfinished step of BDF2 would go on into the next two.
const BEFORE_FALLBACK: usize = 10;

/// Number of parts of a frame, a power of two: its shortest step. Where such a short one does not help, none will.
const PARTS: u32 = 4096;

/// A method: how it writes q*, q̇* and h_e for a step of h.
pub(crate) struct Formula {
    /// The integrator that it belongs to.
    pub(crate) integrator: Integrator,
    /// From the state alone: backward Euler.
    pub(crate) first: fn(&State, f64, &mut Base),
    /// From the state and the one before, for a method of second order.
    pub(crate) second: Option<fn(&State, &Previous, f64, &mut Base)>,
}

/// Arrays of these methods, made when one of them first steps.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    newton: Newton,
    base: Base,
}

impl Scratch {
    fn new(system: &System) -> Self {
        let zeros = || vec![0.0; system.coordinate_count()];
        Scratch { newton: Newton::new(system), base: Base { q: zeros(), qd: zeros(), h_e: 0.0, end: 0.0 } }
    }
}

/// Advances the state by one frame: one step, or halves of it where Newton's method does not converge.
pub(crate) fn frame<const D: usize>(
    formula: &Formula,
    frame: &mut Frame<'_>,
    state: &mut State,
) -> Result<StepReport, StepError> {
    let (system, length) = (frame.system, frame.length);
    reach::check::<D>(system, state, formula.integrator, length)?;
    let mut scratch = match frame.workspace.implicit.take() {
        Some(scratch) => scratch,
        None => {
            check_couplings(system, state.t)?;
            Box::new(Scratch::new(system))
        }
    };
    let before = frame.factorizations();
    if state.carry.as_ref().is_none_or(|carry| carry.lambda.len() != system.all_row_count()) {
        // λ of the equation is the best first guess.
        frame.workspace.solve::<D>(system, state, &Feedback::NONE);
        let equation = &mut frame.workspace.equation;
        let is_nearly_singular = equation.margin::<D>(system).is_none_or(|margin| margin < APPROACH);
        let lambda = equation.lambda.clone();
        state.rank.clone_from(&equation.rank);
        let drives = energy::drive_power(system, &equation.rows.Ct, &lambda);
        state.carry = Some(Carry { lambda, substep: length, is_nearly_singular, drives, ..Carry::default() });
    }
    frame.workspace.set_modes(system, state);
    frame.workspace.equation.solver.memory.forget();
    scratch.newton.matrix.factorizations = frame.factorizations() - before;
    let outcome = ImplicitStepper::<D> { formula, frame, scratch: &mut scratch }.run(state);
    frame.workspace.implicit = Some(scratch);
    outcome
}

/// A method under way over one frame.
struct ImplicitStepper<'a, 'f, const D: usize> {
    formula: &'a Formula,
    frame: &'a mut Frame<'f>,
    scratch: &'a mut Scratch,
}

impl<const D: usize> ImplicitStepper<'_, '_, D> {
    fn run(&mut self, state: &mut State) -> Result<StepReport, StepError> {
        let (system, length, budget) = (self.frame.system, self.frame.length, self.frame.settings.frame_budget);
        let mut report = StepReport { smallest_substep: length, solver: Solver::EndOfStep, ..StepReport::default() };
        let start = state.t;
        // Counted in parts of the frame, which add up without rounding.
        let (mut done, mut parts) = (0, PARTS);
        while done < PARTS {
            let h = length * (f64::from(parts) / f64::from(PARTS));
            self.scratch.base.end = start + length * (f64::from(done + parts) / f64::from(PARTS));
            let left = budget - report.iterations.min(budget);
            let ending = self.attempt(state, h, left);
            report.iterations += ending.iterations;
            let edge = if ending.has_converged { self.edge(state) } else { None };
            if (!ending.has_converged || edge.is_some()) && report.iterations < budget {
                report.rejected += 1;
                parts /= 2;
                if parts == 0 {
                    state.carry = None;
                    return Err(edge.unwrap_or_else(|| self.failure(state, &ending)));
                }
                continue;
            }
            if let Some(error) = edge {
                return Err(error);
            }
            if !ending.has_converged {
                report.warn(Warning::BudgetSpent {
                    time: state.t + h,
                    iterations: report.iterations,
                    row: system.row_names.get(ending.miss.row).cloned().unwrap_or_default(),
                    relative: ending.miss.relative,
                });
            }
            let Frame { workspace, .. } = &mut *self.frame;
            let Scratch { newton, base } = &mut *self.scratch;
            let drives = newton.project_velocities::<D>(base, ending.is_factored, &mut workspace.tried(system));
            check_finite::<D>(system, state.t, &workspace.q, &workspace.qd)?;
            self.keep(state, h, drives);
            done += parts;
            state.t = self.scratch.base.end;
            let equation = &self.frame.workspace.equation;
            report.book(h, 0, &drift::<D>(system, &equation.rows, &equation.inactive, &state.q));
            if let Some(watch) = &mut self.frame.workspace.watch {
                watch.note(system, state);
            }
        }
        report.factorizations = self.scratch.newton.matrix.factorizations;
        report.energy = energy::energy(system, state);
        Ok(report)
    }

    /// One step of h into the workspace, with no more than `left` iterations: of second order where the step before
    /// is known; else, or where that does not converge, of backward Euler.
    fn attempt(&mut self, state: &State, h: f64, left: usize) -> Ending {
        let previous = state.carry.as_ref().and_then(|carry| carry.previous.as_ref());
        let mut spent = 0;
        if let (Some(second), Some(previous)) = (self.formula.second, previous) {
            second(state, previous, h, &mut self.scratch.base);
            // Half of the iterations left, so that backward Euler still has its turn.
            let ending = self.solve(state, h, BEFORE_FALLBACK.min(left / 2));
            if ending.has_converged {
                return ending;
            }
            spent = ending.iterations;
        }
        (self.formula.first)(state, h, &mut self.scratch.base);
        // A step takes an iteration even where the budget has none left: without it rods would not be held at all.
        let limit = MOST_ITERATIONS.min(left.saturating_sub(spent)).max(1);
        let ending = self.solve(state, h, limit);
        Ending { iterations: spent + ending.iterations, ..ending }
    }

    /// Newton's method from q + h q̇ with the last λ.
    fn solve(&mut self, state: &State, h: f64, limit: usize) -> Ending {
        let Frame { system, settings, workspace, .. } = &mut *self.frame;
        let Scratch { newton, base } = &mut *self.scratch;
        let mut tried = workspace.tried(system);
        for k in 0..tried.q.len() {
            tried.q[k] = state.q[k] + h * state.qd[k];
        }
        let scale = base.h_e * base.h_e;
        let lambda = state.carry.as_ref().map(|carry| carry.lambda.as_slice()).unwrap_or_default();
        for (mu, multiplier) in newton.mu.iter_mut().zip(lambda) {
            *mu = scale * multiplier;
        }
        newton.solve::<D>(settings, base, limit, &mut tried)
    }

    /// Makes the step in the workspace the state, and writes what a restart needs to its carry. `projection` is the
    /// work of the drives in the projection of velocities [J].
    fn keep(&mut self, state: &mut State, h: f64, projection: f64) {
        let Frame { system, workspace, .. } = &mut *self.frame;
        let Scratch { newton, base } = &*self.scratch;
        let after = energy::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: base.end }, &[]);
        let before = energy::dissipation(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t }, &[]);
        // The rule of the end point is backward Euler's own; the trapezoidal rule is of second order.
        let has_second_order = self.formula.second.is_some();
        let mean = |before: f64, after: f64| if has_second_order { 0.5 * (before + after) } else { after };
        state.work.dissipation += h * mean(before, after);
        std::mem::swap(&mut state.q, &mut workspace.q);
        std::mem::swap(&mut state.qd, &mut workspace.qd);
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: base.end };
        workspace.equation.follow_feet(system, motion, &mut state.feet);
        if let Some(carry) = &mut state.carry {
            let scale = base.h_e * base.h_e;
            for (multiplier, mu) in carry.lambda.iter_mut().zip(&newton.mu) {
                *multiplier = mu / scale;
            }
            // λ brings q onto C = 0, and the projection adds what the velocity needs: the force is the sum of both.
            let power = energy::drive_power(system, &workspace.equation.rows.Ct, &carry.lambda);
            let drives = power + projection / base.h_e;
            state.work.drives += h * mean(carry.drives, drives);
            carry.drives = drives;
            carry.substep = h;
            carry.collocation = None;
            let previous = carry.previous.get_or_insert_with(|| Previous { q: Vec::new(), qd: Vec::new(), h });
            previous.q.clone_from(&workspace.q);
            previous.qd.clone_from(&workspace.qd);
            previous.h = h;
        }
    }

    /// The error after the shortest step did not converge: it names the edge that was passed, the arm without length,
    /// the worst row, or where all rows are met the particle with the largest acceleration.
    fn failure(&self, state: &State, ending: &Ending) -> StepError {
        let (system, time, workspace) = (self.frame.system, state.t, &*self.frame.workspace);
        let (end, settings) = (self.scratch.base.end, self.frame.settings);
        let lost = || without_length::<D>(system, time, &state.q).or_else(|| shrinks(system, time, end));
        if let Some(error) = self.edge(state).or_else(lost).or_else(|| jumps::<D>(system, settings, state, end)) {
            return error;
        }
        let rows = &workspace.equation.rows;
        // An iteration goes on to half the tolerance, but what is within the tolerance is not off.
        let within = attainable(system, settings, largest(&workspace.q)).max(settings.constraint_tolerance);
        if !rows.C.is_empty() && exceeds(ending.miss.relative, within) {
            return not_satisfied(system, time, rows);
        }
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: time };
        match energy::most_accelerated(system, motion, &[]) {
            Some((particle, acceleration)) => {
                StepError::RanAway { time, particle: system.particle_names[particle.0].clone(), acceleration }
            }
            None => StepError::NotFinite { time, particle: system.first_moving() },
        }
    }

    /// The error of the edge that the step in the workspace passes.
    fn edge(&self, state: &State) -> Option<StepError> {
        let workspace = &*self.frame.workspace;
        let tried = Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: self.scratch.base.end };
        at_an_edge(self.frame.system, state, tried)
    }
}

impl super::Workspace {
    /// The step being tried.
    fn tried<'a>(&'a mut self, system: &'a System) -> Tried<'a> {
        Tried { system, equation: &mut self.equation, q: &mut self.q, qd: &mut self.qd }
    }
}
