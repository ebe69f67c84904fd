//! Drift: how far a motion is from C = 0 and Ċ = 0.

use crate::constraint::Rows;
use crate::point::{block, larger, minus, norm};
use crate::settings::Settings;
use crate::system::System;

/// Part of |C| that counts in a row that follows from others everywhere. Such a row is as exact as the rows that it
/// follows from, up to the shape of its clique; where it is off by ten thousand tolerances, it does not follow.
const FOLLOWING: f64 = 1e-4;

/// The residuals of one motion.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    /// max |C| over the rigid rows that the user gave.
    pub(crate) residual: f64,
    /// max |Ċ|.
    pub(crate) residual_rate: f64,
    /// max |C| over the row's own scale, and the row; NaN counts as infinite.
    pub(crate) relative: f64,
    pub(crate) worst_row: usize,
    /// max ||d| − r|/r over the rigid rods.
    pub(crate) relative_length: f64,
}

/// The drift of rows that were evaluated at q. Inactive rows do not count; an empty `inactive` means that every row is
/// active.
pub(crate) fn drift<const D: usize>(system: &System, rows: &Rows, inactive: &[bool], q: &[f64]) -> Drift {
    let mut drift = Drift::default();
    let given = system.row_count();
    let rigid = |row: &usize| system.softness[*row].is_rigid();
    for row in (0..rows.C.len()).filter(rigid) {
        if row < given {
            drift.residual = larger(drift.residual, rows.C[row].abs());
            drift.residual_rate = larger(drift.residual_rate, rows.Cd[row].abs());
        }
        let relative = weight(system, row) * rows.C[row].abs() / system.row_scale[row];
        let relative = if relative.is_nan() { f64::INFINITY } else { relative };
        if relative > drift.relative {
            (drift.relative, drift.worst_row) = (relative, row);
        }
    }
    for named in &system.constraints {
        if let Some(rod) = named.constraint.as_rod()
            && rod.compliance == 0.0
            && !inactive.get(named.first_row).is_some_and(|inactive| *inactive)
        {
            let length = norm(minus(block::<D>(q, rod.a), block(q, rod.b)));
            drift.relative_length = larger(drift.relative_length, (length - rod.length).abs() / rod.length);
        }
    }
    drift
}

/// The part of |C| of a row that counts: all of it where the row is held, nothing where it is soft.
fn weight(system: &System, row: usize) -> f64 {
    match () {
        () if system.is_held(row) => 1.0,
        () if system.softness[row].is_rigid() => FOLLOWING,
        () => 0.0,
    }
}

/// The rigid row with the largest |C| over its scale, and that number; NaN counts as infinite.
pub(crate) fn worst_row(system: &System, C: &[f64]) -> (usize, f64) {
    let mut worst = (0, 0.0);
    for (row, (residual, scale)) in C.iter().zip(&system.row_scale).enumerate() {
        let weight = weight(system, row);
        let relative = if weight > 0.0 { weight * residual.abs() / scale } else { 0.0 };
        if relative.is_nan() {
            return (row, f64::INFINITY);
        }
        if relative > worst.1 {
            worst = (row, relative);
        }
    }
    worst
}

/// The relative |C| at which a projection stops: half the constraint tolerance, so that a later measurement still lies
/// within the tolerance after rounding, or the roundoff of the coordinates if that is larger. `farthest` is max |q|
/// \[m\].
pub(crate) fn attainable(system: &System, settings: &Settings, farthest: f64) -> f64 {
    // A coordinate is rounded by ε|q|; a difference of two of them and its square root add a few more.
    (0.5 * settings.constraint_tolerance).max(4.0 * f64::EPSILON * farthest / system.extent)
}
