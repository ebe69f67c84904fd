//! Dead centre: a state at which the constraints do not decide which way a drive moves them.
//!
//! At a dead centre rows depend on each other, and a drive still asks for an acceleration along them: no q̈ satisfies
//! J q̈ = −γ, although a free direction is left in which a velocity of the right size would.

use super::Workspace;
use super::failure::drive_near;
use crate::constraint::Rows;
use crate::error::StepError;
use crate::point::{Motion, larger};
use crate::settings::Feedback;
use crate::state::State;
use crate::system::System;

/// Part of the accelerations in a row by which J q̈ = −γ must be missed to count as a contradiction: A that is nearly
/// singular leaves 1e-6 (`ACCEPTED_RESIDUAL` in `multiplier/factor.rs`).
const CONTRADICTION: f64 = 1e-4;

/// Number of free velocities that are tried; one would do for one free direction.
const DIRECTIONS: usize = 4;

/// A time after which a drive that stands still now has begun to move [s].
const LATER: f64 = 1e-6;

/// The error of a state at which no accelerations satisfy the constraints, although some velocities would: a drive at a
/// dead centre. `None` where it is not so.
///
/// ```text
/// e = J q̈ + γ                             what the accelerations miss; zero in rows that are independent
/// r = e − A⁻¹ J W Jᵀ e                    A⁻¹ over the independent rows, so Jᵀ r = 0 and r·γ = |e|²
/// r·γ(v) − r·γ = vᵀ (Σ r_i ∂²C_i/∂q²) v   from rest, with a free velocity v: J v = 0
/// ```
///
/// Where the last line is below zero, r·γ is zero at a velocity of some size along v, and accelerations then satisfy
/// all rows.
pub(super) fn undecided<const D: usize>(
    system: &System,
    state: &State,
    workspace: &mut Workspace,
) -> Option<StepError> {
    if system.constraints.is_empty() {
        return None;
    }
    let (m, soon) = (system.all_row_count(), later::<D>(system, state));
    if soon.Ct.iter().all(|&Ct| Ct == 0.0) {
        return None;
    }
    let equation = workspace.solve::<D>(system, state, &Feedback::NONE);
    if equation.solver.dependent().is_empty() {
        return None;
    }
    let (mut met, mut forces) = (vec![0.0; m], vec![0.0; m]);
    equation.rows.J.multiply::<D>(&equation.qdd, &mut met);
    equation.rows.J.multiply::<D>(&equation.WQ, &mut forces);
    let gamma = equation.rows.gamma.clone();
    let is_active = |row: usize| !equation.is_inactive(row) && system.softness[row].is_rigid();
    let missed: Vec<f64> = (0..m).map(|row| if is_active(row) { met[row] + gamma[row] } else { 0.0 }).collect();
    let largest = (0..m).map(|row| larger(gamma[row].abs(), forces[row].abs())).fold(0.0, larger);
    let row = (0..m).find(|&row| missed[row].abs() > CONTRADICTION * largest)?;
    let contradiction = without_force::<D>(system, workspace, missed);
    let along = |gamma: &[f64]| contradiction.iter().zip(gamma).map(|(r, g)| r * g).sum::<f64>();
    let at_rest = along(&gamma);
    let bends_back = |seed: usize| {
        let v = free_velocity::<D>(system, workspace, seed);
        let mut rows = system.rows_at::<D>(state);
        system.evaluate_rows(Motion::<D> { q: &state.q, qd: &v, t: state.t }, &mut rows);
        let bend = along(&rows.gamma) - at_rest;
        bend * at_rest < 0.0 && bend.abs() > CONTRADICTION * at_rest.abs()
    };
    if !(1..=DIRECTIONS).any(bends_back) {
        return None;
    }
    Some(StepError::Undecided { time: state.t, drive: drive_near(system, &soon, row)? })
}

/// r = e − A⁻¹ J W Jᵀ e with Jᵀ r = 0, from e, which only rows that follow from others miss.
fn without_force<const D: usize>(system: &System, workspace: &mut Workspace, mut missed: Vec<f64>) -> Vec<f64> {
    let (equation, W) = (&mut workspace.equation, &system.inverse_mass);
    let (mut moved, mut rates) = (vec![0.0; system.coordinate_count()], vec![0.0; system.all_row_count()]);
    let mut held = vec![0.0; system.all_row_count()];
    equation.rows.J.add_impulse::<D>(W, &missed, 1.0, &mut moved);
    equation.rows.J.multiply::<D>(&moved, &mut rates);
    equation.solver.solve(&system.matrix, &rates, &mut held);
    missed.iter_mut().zip(&held).for_each(|(e, held)| *e -= held);
    missed
}

/// A velocity v of the order of the extent a second with J v = 0, at the motion of the equation.
fn free_velocity<const D: usize>(system: &System, workspace: &mut Workspace, seed: usize) -> Vec<f64> {
    let mut v = vec![0.0; system.coordinate_count()];
    for (k, v) in v.iter_mut().enumerate().filter(|(k, _)| system.inverse_mass[k / D] > 0.0) {
        // Parts of multiples of the golden ratio are spread evenly, and the same everywhere.
        *v = system.extent * (((k + 1) * seed) as f64 * 0.618_033_988_749_895).fract() - 0.5 * system.extent;
    }
    let equation = &mut workspace.equation;
    let (mut rates, mut nu) = (vec![0.0; system.all_row_count()], vec![0.0; system.all_row_count()]);
    equation.rows.J.multiply::<D>(&v, &mut rates);
    equation.solver.solve(&system.matrix, &rates, &mut nu);
    equation.rows.J.add_impulse::<D>(&system.inverse_mass, &nu, -1.0, &mut v);
    v
}

/// The rows at the positions of a state, a little later: a drive that turns back has C_t = 0 for one moment.
fn later<const D: usize>(system: &System, state: &State) -> Rows {
    let mut rows = system.rows_at::<D>(state);
    system.evaluate_rows(Motion::<D> { q: &state.q, qd: &state.qd, t: state.t + LATER }, &mut rows);
    rows
}
