//! Radau IIA of order 5 with three stages, solved at the end of the step, with an error estimate (RADAU5). For stiff
//! systems: stiff springs and dampers, heavy chains, and all other forces whose rates are far above that of the motion.
//!
//! ```text
//! q̇ = v,   M v̇ = Q(q, v, t) + J(q, t)ᵀ λ,   0 = J v + C_t            (index 2)
//! ```
//!
//! at three stages, the last of which is the end of the substep (`stages.rs`). Positions and velocities are of order 5,
//! the multipliers of the stages of order 3. Afterwards q is moved onto C = 0 and v onto Ċ = 0; the shift is no larger
//! than the error, so the order stays. The method is L-stable: motions far faster than the substep die away within it.
//! With stiff forces the order of the slow motions falls towards 3, that of the collocation within a substep.
//!
//! The error estimate is of order 3 (`stepper.rs`), so the method is more accurate than its tolerance, most where the
//! motion is smooth. Work of dampers and drives is the quadrature of the stages, of order 5 as well.
//!
//! `saddle.rs` is the matrix of Newton's method with the exact stiffness and damping of all forces and constraints,
//! `factors.rs` its two factors. The factors stay for the next substep where the iteration converged quickly with them.
//! A frame begins with factors of its own, so that a restart goes on with the same bits.
//!
//! Near a position where the rank of A drops, DOP853 goes on to the end of the frame: it crosses such a position
//! without a stage near it (`adaptive/crossing.rs`), and finds the independent rows anew where they change.
//!
//! When it fails: no events are found, so a system with contacts is refused. Oscillations that must be followed cost
//! more than with DOP853. Source: Hairer and Wanner, Solving Ordinary Differential Equations II, IV.8, VII.4 and VII.6.

mod factors;
mod projection;
mod saddle;
mod stages;
mod stepper;
mod tableau;

use super::adaptive::dop853::DOP853;
use super::adaptive::{End, Substeps, pair_frame};
use super::frame::Frame;
use crate::error::StepError;
use crate::report::{Solver, StepReport, Warning};
use crate::settings::{Feedback, Integrator};
use crate::state::{Carry, State};
use crate::system::System;
use factors::Factors;
use saddle::Saddle;
use stages::{Convergence, Stages};
use stepper::RadauStepper;

/// Arrays of the method, made when it first steps.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    saddle: Saddle,
    factors: Factors,
    stages: Stages,
    /// A motion at which forces are evaluated for the error estimate.
    tried_q: Vec<f64>,
    tried_qd: Vec<f64>,
    /// The estimate, one number for each unknown; and a right-hand side.
    error_q: Vec<f64>,
    error_qd: Vec<f64>,
    rhs: Vec<f64>,
}

impl Scratch {
    /// `None` if the factors would not fit into memory.
    fn new(system: &System) -> Option<Self> {
        let saddle = Saddle::new(system)?;
        let of_unknowns = || vec![0.0; saddle.unknowns()];
        let of_coordinates = || vec![0.0; system.coordinate_count()];
        Some(Scratch {
            factors: Factors::new(&saddle),
            stages: Stages::new(system, &saddle),
            tried_q: of_coordinates(),
            tried_qd: of_coordinates(),
            error_q: of_unknowns(),
            error_qd: of_unknowns(),
            rhs: of_unknowns(),
            saddle,
        })
    }
}

/// Advances the state by one frame.
pub(crate) fn frame<const D: usize>(frame: &mut Frame<'_>, state: &mut State) -> Result<StepReport, StepError> {
    let (start, length) = (state.t, frame.length);
    let is_nearly_singular = state.carry.as_ref().is_some_and(|carry| carry.is_nearly_singular);
    let (mut report, is_whole) = carry_on::<D>(frame, state, usize::MAX)?;
    if !is_whole {
        // A singular position is near. Velocities that were not projected in the last frame are projected beyond it.
        let rest = length - (state.t - start);
        let is_nearly_singular = is_nearly_singular && state.t == start;
        state.carry = Some(Carry { substep: rest, is_nearly_singular, ..Carry::default() });
        report.absorb(pair_frame::frame::<D>(&DOP853, &mut frame.over(rest), state)?);
        // The parts add up to the frame only up to rounding.
        state.t = start + length;
    }
    Ok(report)
}

/// Advances the state by one frame, or as far as `limit` substeps go, or to where a singular position is near; says
/// whether the frame is whole.
pub(crate) fn carry_on<const D: usize>(
    frame: &mut Frame<'_>,
    state: &mut State,
    limit: usize,
) -> Result<(StepReport, bool), StepError> {
    let (system, settings) = (frame.system, frame.settings);
    let mut scratch = match frame.workspace.radau.take() {
        Some(scratch) => scratch,
        None => {
            let refused = StepError::TooCoupled { integrator: Integrator::Radau5 };
            Box::new(Scratch::new(system).ok_or(refused)?)
        }
    };
    let mut substeps = Substeps::new(frame, state).within(limit);
    let carry = state.carry.take().filter(|carry| carry.lambda.len() == system.all_row_count());
    frame.workspace.set_modes(system, state);
    let (lambda, before) = match carry {
        Some(carry) if state.rank.is_some() => (carry.lambda, carry.collocation),
        _ => {
            let equation = frame.workspace.solve::<D>(system, state, &Feedback::NONE);
            state.rank.clone_from(&equation.rank);
            (equation.lambda.clone(), None)
        }
    };
    scratch.stages.rows.feet.clone_from(&frame.workspace.equation.rows.feet);
    scratch.saddle.leave_out(state.rank.as_ref().map_or(&[], |rank| &rank.dependent));
    frame.workspace.equation.solver.memory.forget();
    substeps.report.solver = Solver::EndOfStep;
    let factorizations = scratch.factors.factorizations;
    let mut stepper = RadauStepper::<D> {
        system,
        settings,
        scratch: &mut scratch,
        equation: &mut frame.workspace.equation,
        lambda,
        before,
        is_linearized: false,
        is_fresh: false,
        is_ahead: false,
        factored_for: None,
        was_rejected: false,
        convergence: Convergence::default(),
        error: 0.0,
        gives_up: false,
        sharpens: false,
    };
    let end = substeps.run(&mut stepper, state);
    let RadauStepper { lambda, before, .. } = stepper;
    let (Scratch { saddle, factors, .. }, mut without) = (&*scratch, Vec::new());
    for i in factors.left_out(saddle) {
        match saddle.is_zero_row::<D>(i) {
            true => without.push(system.row_names[saddle.rows[i]].clone()),
            false => substeps.report.warn(Warning::Singular),
        }
    }
    if !without.is_empty() {
        substeps.report.warn(Warning::NoGradient { rows: without });
    }
    substeps.report.factorizations = scratch.factors.factorizations - factorizations;
    frame.workspace.radau = Some(scratch);
    let end = match end {
        Ok(end) => end,
        Err(error) => return Err(substeps.fail(frame, error)),
    };
    state.rank.clone_from(&frame.workspace.equation.rank);
    let report = substeps.finish(frame, state, None);
    if let Some(carry) = &mut state.carry {
        (carry.lambda, carry.collocation) = (lambda, before);
    }
    Ok((report, end == End::Whole))
}
