//! Drift: how far a motion is from C = 0 and Ċ = 0.

use crate::constraint::Rows;
use crate::point::{block, larger, minus, norm};
use crate::settings::Settings;
use crate::system::System;

/// The residuals of one motion.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    /// max |C| over the rigid rows that the user gave.
    pub(crate) residual: f64,
    /// max |Ċ|.
    pub(crate) residual_rate: f64,
    /// max |C| over the row's own scale, of the rows that are held, and the row; NaN counts as infinite.
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
        if !system.is_held(row) {
            continue;
        }
        let relative = rows.C[row].abs() / system.row_scale[row];
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

/// The row that is held with the largest |C| over its scale, and that number; NaN counts as infinite.
pub(crate) fn worst_row(system: &System, C: &[f64]) -> (usize, f64) {
    let mut worst = (0, 0.0);
    for (row, (residual, scale)) in C.iter().zip(&system.row_scale).enumerate() {
        if !system.is_held(row) {
            continue;
        }
        let relative = residual.abs() / scale;
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
