//! Failure: the error of a step that no shorter one mends, with the true culprit.
//!
//! | culprit | the error |
//! |---|---|
//! | the end of a curve | [`StepError::CurveEnds`] |
//! | a gradient that jumps or is lost | [`StepError::NoGradient`] |
//! | a driven radius or length that shrinks to nothing | [`StepError::NoGradient`] |
//! | a residual that jumps | [`StepError::Jumps`] |
//! | a rate that jumps | [`StepError::RateJumps`] |
//! | a drive that the other constraints do not follow | [`StepError::DriveBlocked`], [`StepError::DriveEnds`] |
//! | a rate that no velocities bring to zero | [`StepError::RateNotSatisfied`], at a start |
//! | none of these | [`StepError::NotSatisfied`], with the row that is off most |
//!
//! A dead centre, from which more than one motion follows a drive, has a file of its own: `dead_centre.rs`.
//!
//! A residual that jumps does so however short the substep is: halved again and again, towards the half in which C
//! changes more, the change of C stays.

use super::edges::Passage;
use crate::constraint::{Constraint, Holds, NamedConstraint, Rows};
use crate::drift::{attainable, worst_row};
use crate::error::StepError;
use crate::point::{Motion, block, largest, minus, norm};
use crate::settings::Settings;
use crate::space::ParticleId;
use crate::state::State;
use crate::system::System;

/// Length of an arm, relative to the extent of the system, below which a good motion counts as one without it. The last
/// good motion ends before the length at which `edges.rs` counts an arm as lost, so this length is ten times as much.
const NO_LENGTH: f64 = 1e-6;

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

/// Halvings of a substep in which a jump is sought: t and q then have no number in between.
const HALVINGS: usize = 60;

/// The error of the first arm that has no length at q.
pub(super) fn without_length<const D: usize>(system: &System, time: f64, q: &[f64]) -> Option<StepError> {
    system.jumpy.iter().find_map(|&place| {
        let (ends, length) = shortest_arm::<D>(system, place, q)?;
        (length <= NO_LENGTH * system.extent).then(|| no_gradient(system, time, place, Some(ends)))
    })
}

/// The error of a driven radius, or of a rod of driven length, that shrinks to nothing between two times [s].
pub(super) fn shrinks(system: &System, from: f64, to: f64) -> Option<StepError> {
    let nothing = NO_LENGTH * system.extent;
    system.jumpy.iter().find_map(|&place| {
        let constraint = &system.constraints[place].constraint;
        let at_end = constraint.least_size(to);
        if at_end.is_nan() || at_end > nothing {
            return None;
        }
        let (mut low, mut high) = (from, to);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if constraint.least_size(middle) <= at_end.max(0.0) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(no_gradient(system, high, place, constraint.arms().first().copied()))
    })
}

/// The error of a residual that jumps between a state and the end of the shortest substep [s] from there.
pub(super) fn jumps<const D: usize>(
    system: &System,
    settings: &Settings,
    state: &State,
    end: f64,
) -> Option<StepError> {
    let (row, residual, off) = discontinuity::<D>(system, state, end, |rows| &rows.C)?;
    let row = system.row_names[row].clone();
    let is_jump = off > attainable(system, settings, largest(&state.q));
    is_jump.then_some(StepError::Jumps { time: state.t, row, residual })
}

/// The error of a rate that jumps there.
pub(super) fn rate_jumps<const D: usize>(
    system: &System,
    settings: &Settings,
    state: &State,
    end: f64,
) -> Option<StepError> {
    let (row, rate, off) = discontinuity::<D>(system, state, end, |rows| &rows.Cd)?;
    let row = system.row_names[row].clone();
    // The roundoff of positions turns directions.
    let relative = settings.tolerance.max(attainable(system, settings, largest(&state.q)));
    let is_jump = off * system.extent > relative * largest(&state.qd);
    is_jump.then_some(StepError::RateJumps { time: state.t, row, rate })
}

/// The largest change, over the scale of its row, of C or Ċ within the shortest time that numbers tell apart, between a
/// state and `end` along its velocity: the row, the number after the change, and the change. `None` where it is not
/// finite.
fn discontinuity<const D: usize>(
    system: &System,
    state: &State,
    end: f64,
    of: fn(&Rows) -> &Vec<f64>,
) -> Option<(usize, f64, f64)> {
    let mut rows = system.rows_at::<D>(state);
    let mut q = vec![0.0; state.q.len()];
    let mut after = |s: f64| {
        for (q, (x, v)) in q.iter_mut().zip(state.q.iter().zip(&state.qd)) {
            *q = x + s * v;
        }
        system.evaluate_rows(Motion::<D> { q: &q, qd: &state.qd, t: state.t + s }, &mut rows);
        let mut numbers = of(&rows).clone();
        without_inactive(system, state, &mut numbers);
        numbers
    };
    let change = |a: &[f64], b: &[f64]| {
        let change: Vec<f64> = a.iter().zip(b).map(|(a, b)| b - a).collect();
        worst_row(system, &change)
    };
    let (mut low, mut high) = (0.0, end - state.t);
    let (mut at_low, mut at_high) = (after(low), after(high));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let at_middle = after(middle);
        if change(&at_low, &at_middle).1 >= change(&at_middle, &at_high).1 {
            (high, at_high) = (middle, at_middle);
        } else {
            (low, at_low) = (middle, at_middle);
        }
    }
    let (row, off) = change(&at_low, &at_high);
    Some((row, *at_high.get(row)?, off)).filter(|_| off.is_finite())
}

/// Writes zeros for the inactive rows of a state, which are not held.
pub(super) fn without_inactive(system: &System, state: &State, C: &mut [f64]) {
    let mut inactive = vec![false; C.len()];
    state.modes.write_inactive(&system.contacts, &mut inactive);
    C.iter_mut().zip(inactive).filter(|(_, inactive)| *inactive).for_each(|(C, _)| *C = 0.0);
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
    let (row, residual) = worst(system, rows);
    match drive_near(system, rows, worst_row(system, &rows.C).0) {
        Some(drive) => StepError::DriveBlocked { time, drive, row, residual },
        None => StepError::NotSatisfied { time, row, residual },
    }
}

/// The error of a drive that the other constraints follow in no substep, although every row is met; the drive near the
/// row that is off most.
pub(super) fn drive_ends(system: &System, time: f64, rows: &Rows) -> Option<StepError> {
    let drive = drive_near(system, rows, worst_row(system, &rows.C).0)?;
    Some(StepError::DriveEnds { time, drive })
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

/// The name of the constraint with the driven row that is nearest to a row, over particles that can move; that of the
/// row itself if it is driven.
pub(super) fn drive_near(system: &System, rows: &Rows, row: usize) -> Option<String> {
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
