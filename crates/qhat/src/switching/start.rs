//! Whether a start respects what acts on one side.

use super::{Mode, TOUCHES};
use crate::point::Motion;
use crate::state::State;
use crate::system::System;

/// The contact that is violated most while open, by its constraint's place, and −C [m]; `None` where all are within `tolerance`,
/// relative to their rows' scales, as far as what touches may be off.
pub(crate) fn deepest<const D: usize>(system: &System, state: &State, tolerance: f64) -> Option<(usize, f64)> {
    if system.switches.contacts.is_empty() {
        return None;
    }
    let mut rows = system.empty_rows();
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    rows.evaluate(system.constraints.iter().map(|named| &named.constraint), motion);
    let contacts = system.switches.contacts.iter().enumerate();
    let broken = |constraint: usize| {
        let mut breakables = system.switches.breakables.iter().zip(&state.modes.broken);
        breakables.any(|(breakable, &broken)| broken && breakable.constraint == constraint)
    };
    let open = contacts.filter(|(k, contact)| {
        state.modes.contacts.get(*k).is_none_or(|&mode| mode == Mode::Open) && !broken(contact.constraint)
    });
    let depths = open.map(|(_, contact)| (contact, -rows.C[contact.normal]));
    let violated = depths.filter(|(contact, depth)| *depth > TOUCHES * tolerance * system.row_scale[contact.normal]);
    violated.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(contact, depth)| (contact.constraint, depth))
}
