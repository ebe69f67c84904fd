//! Failure: the error of a step that no shorter one mends, with the true culprit.
//!
//! | culprit | the error |
//! |---|---|
//! | the end of a curve | [`StepError::CurveEnds`] |
//! | a gradient that jumps or is lost | [`StepError::NoGradient`] |
//! | a drive at a dead centre, from which more than one motion follows it | [`StepError::Undecided`], at a start |
//! | a drive that the other constraints do not follow | [`StepError::DriveBlocked`] |
//! | a rate that no velocities bring to zero | [`StepError::RateNotSatisfied`], at a start |
//! | none of these | [`StepError::NotSatisfied`], with the row that is off most |
//!
//! At a dead centre rows depend on each other, and a drive still asks for an acceleration along them: no q̈ satisfies
//! J q̈ = −γ, although a free direction is left in which a velocity of the right size would.

use super::Workspace;
use super::edges::Passage;
use crate::constraint::{Constraint, Holds, NamedConstraint, Rows};
use crate::drift::worst_row;
use crate::error::StepError;
use crate::point::{Motion, block, larger, minus, norm};
use crate::settings::Feedback;
use crate::space::ParticleId;
use crate::state::State;
use crate::system::System;

/// Length of an arm, relative to the extent of the system, below which a good motion counts as one without it. The last
/// good motion ends before the length at which `edges.rs` counts an arm as lost, so this length is ten times as much.
const NO_LENGTH: f64 = 1e-6;

/// Part of the accelerations in a row by which J q̈ = −γ must be missed to count as a contradiction: A that is nearly
/// singular leaves 1e-6 (`ACCEPTED_RESIDUAL` in `multiplier/factor.rs`).
const CONTRADICTION: f64 = 1e-4;

/// Number of free velocities that are tried; one would do for one free direction.
const DIRECTIONS: usize = 4;

/// A time after which a drive that stands still now has begun to move [s].
const LATER: f64 = 1e-6;

/// The error of a step from the last good state to a motion that was tried and passed an edge; `None` if it did not.
pub(super) fn at_an_edge<const D: usize>(system: &System, state: &State, tried: Motion<'_, D>) -> Option<StepError> {
    if system.jumpy.is_empty() && system.bead_places.is_empty() {
        return None;
    }
    let from = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    let mut rows = system.rows_at::<D>(state);
    if let Some((place, end)) = rows.feet.past_an_end(&system.beads(), tried) {
        let named = &system.constraints[system.bead_places[place]];
        let particle = named.constraint.particles().first().map(|id| system.particle_names[id.0].clone());
        let (particle, constraint) = (particle.unwrap_or_default(), named.name.clone());
        return Some(StepError::CurveEnds { time: state.t, particle, constraint, end });
    }
    let before = rows.J.blocks.clone();
    system.evaluate_rows(tried, &mut rows);
    let mut inactive = vec![false; rows.C.len()];
    state.modes.write_inactive(&system.contacts, &mut inactive);
    let passage = Passage { system, rows: &rows, inactive: &inactive, before: &before, from, to: tried };
    let place = passage.lost_arm().or_else(|| passage.jump())?;
    let ends = [from.q, tried.q].map(|q| shortest_arm::<D>(system, place, q));
    let shorter = ends.into_iter().flatten().min_by(|(_, a), (_, b)| a.total_cmp(b));
    Some(no_gradient(system, state.t, place, shorter.map(|(ends, _)| ends)))
}

/// The error of the first arm that has no length at q.
pub(super) fn without_length<const D: usize>(system: &System, time: f64, q: &[f64]) -> Option<StepError> {
    system.jumpy.iter().find_map(|&place| {
        let (ends, length) = shortest_arm::<D>(system, place, q)?;
        (length <= NO_LENGTH * system.extent).then(|| no_gradient(system, time, place, Some(ends)))
    })
}

/// The shortest arm of a constraint that can change, and its length [m].
pub(super) fn shortest_arm<const D: usize>(system: &System, place: usize, q: &[f64]) -> Option<([ParticleId; 2], f64)> {
    let arms = system.constraints[place].constraint.arms().into_iter();
    let moving = arms.filter(|&[a, b]| !(system.is_fixed(a) && system.is_fixed(b)));
    let lengths = moving.map(|[a, b]| ([a, b], norm(minus(block::<D>(q, a), block::<D>(q, b)))));
    lengths.min_by(|(_, a), (_, b)| a.total_cmp(b))
}

fn no_gradient(system: &System, time: f64, place: usize, ends: Option<[ParticleId; 2]>) -> StepError {
    let NamedConstraint { name, constraint, .. } = &system.constraints[place];
    let ends = match (ends, constraint) {
        (Some(ends), _) => ends.to_vec(),
        // About a point, the particle alone is an end.
        (None, Constraint::OnSphere(_) | Constraint::OnCircle(_) | Constraint::OnEllipse(_)) => constraint.particles(),
        (None, _) => Vec::new(),
    };
    let ends = ends.into_iter().map(|id| system.particle_names[id.0].clone()).collect();
    StepError::NoGradient { time, constraint: name.clone(), ends }
}

/// The error of constraints that no positions near a motion that was tried satisfy; `rows` are those of that motion.
pub(super) fn not_satisfied(system: &System, time: f64, rows: &Rows) -> StepError {
    blocked(system, time, rows).unwrap_or_else(|| {
        let (row, residual) = worst(system, rows);
        StepError::NotSatisfied { time, row, residual }
    })
}

/// The same error where a drive is near the row that is off most.
pub(super) fn blocked(system: &System, time: f64, rows: &Rows) -> Option<StepError> {
    let drive = drive_near(system, rows, worst_row(system, &rows.C).0)?;
    let (row, residual) = worst(system, rows);
    Some(StepError::DriveBlocked { time, drive, row, residual })
}

/// The name of the row that is off most, and its C.
fn worst(system: &System, rows: &Rows) -> (String, f64) {
    let (row, _) = worst_row(system, &rows.C);
    (system.row_names.get(row).cloned().unwrap_or_default(), rows.C.get(row).copied().unwrap_or_default())
}

/// The error of a projection of velocities that left the rate of a row above `allowed`, |Ċ| over the scale of the row.
pub(super) fn unmet_rate(system: &System, time: f64, rows: &Rows, allowed: f64) -> Option<StepError> {
    let rates = rows.Cd.iter().zip(&system.row_scale).enumerate().filter(|&(row, _)| system.softness[row].is_rigid());
    let (row, left) =
        rates.map(|(row, (Cd, scale))| (row, Cd.abs() / scale)).max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    if left <= allowed {
        return None;
    }
    let drive = drive_near(system, rows, row);
    Some(StepError::RateNotSatisfied { time, row: system.row_names[row].clone(), rate: rows.Cd[row], drive })
}

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

/// The name of the constraint with the driven row that is nearest to a row, over particles that can move; that of the
/// row itself if it is driven.
fn drive_near(system: &System, rows: &Rows, row: usize) -> Option<String> {
    if rows.Ct.iter().all(|&Ct| Ct == 0.0) {
        return None;
    }
    let layout = &system.layout;
    let of = |row: usize| &layout.particle[layout.start[row]..layout.start[row + 1]];
    let mut is_reached = vec![false; system.all_row_count()];
    let mut frontier = vec![row];
    *is_reached.get_mut(row)? = true;
    while !frontier.is_empty() {
        if let Some(&driven) = frontier.iter().find(|&&row| rows.Ct[row] != 0.0) {
            let named = system.constraints.iter().rev().find(|named| named.first_row <= driven)?;
            return Some(named.name.clone());
        }
        let mut is_touched = vec![false; system.particle_count()];
        frontier.iter().flat_map(|&row| of(row)).for_each(|id| is_touched[id.0] = !system.is_fixed(*id));
        frontier = (0..is_reached.len())
            .filter(|&row| !is_reached[row] && of(row).iter().any(|id| is_touched[id.0]))
            .collect();
        frontier.iter().for_each(|&row| is_reached[row] = true);
    }
    None
}
