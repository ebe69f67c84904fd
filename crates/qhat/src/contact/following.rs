//! Touching contacts that follow from active rows, as the fourth leg of a table follows from three.
//!
//! With λ of independent rows, pivoting may open any one of four legs, and the leg then neither presses nor separates.
//! The leg is closed again with λ = 0, left out of A. The forces that people read are the shares of all four legs
//! (`multiplier/share/`), and where another leg opens, this one takes its part without an impact.

use super::Touching;
use super::complementarity::{solve, w};
use super::roundoff::Roundoffs;
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::structure::Contact;
use crate::system::System;

/// Part of the touch distance up to which a gap may stay in a contact that is closed here. It is a quarter of the
/// constraint tolerance, half of what a projection leaves of C. No projection can close the gap of a row that is left
/// out.
const NO_GAP: f64 = 0.125;

/// Closes open contacts whose rows follow from those that are active, for modes that are settled. λ, Q̂ and every
/// motion are the same after it. `touch_distance` is relative to the row's scale.
pub(super) fn close_following<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
    touch_distance: f64,
) {
    let mut candidates = candidates::<D>(equation, system, modes, touching);
    candidates.retain(|(Touching { contact, .. }, _)| {
        let row = system.contacts.list[*contact].normal;
        equation.rows.C[row].abs() <= NO_GAP * touch_distance * system.row_scale[row]
    });
    let Some(mut rank) = equation.rank.clone().filter(|_| !candidates.is_empty()) else { return };
    // Near a position where the rank drops, rows follow at that position alone.
    if equation.solver.dependent() != rank.dependent {
        return;
    }
    for (Touching { contact, .. }, mode) in candidates {
        let Contact { normal, tangents, .. } = &system.contacts.list[contact];
        let tangents = tangents.clone().filter(|_| mode == Mode::Sticking);
        let rows: Vec<usize> = std::iter::once(*normal).chain(tangents).collect();
        modes.contacts[contact] = mode;
        equation.set_modes(system, modes);
        if equation.leave_out::<D>(system, &rank, &rows) {
            rank = equation.rank.clone().unwrap_or(rank);
        } else {
            modes.contacts[contact] = Mode::Open;
        }
    }
    equation.rank = Some(rank);
    solve::<D>(equation, system, modes);
}

/// The open contacts that neither press nor separate nor slip, with the modes in which they close.
fn candidates<const D: usize>(
    equation: &Equation,
    system: &System,
    modes: &Modes,
    touching: &[Touching],
) -> Vec<(Touching, Mode)> {
    let all = Roundoffs::new::<D>(equation, system, touching);
    let rests = |touching: &&Touching| {
        let Contact { normal, tangents, .. } = &system.contacts.list[touching.contact];
        let small = all.of::<D>(equation, system, *normal).following;
        let tangents = tangents.clone().filter(|_| touching.closed() == Mode::Sticking);
        modes.contacts[touching.contact] == Mode::Open
            && std::iter::once(*normal).chain(tangents).all(|row| w::<D>(equation, row).abs() <= small)
    };
    touching.iter().filter(rests).map(|touching| (*touching, touching.closed())).collect()
}
