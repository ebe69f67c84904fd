//! Contacts of a start: how deep the deepest is violated, and which of them act.

use super::{EventResolution, RestThresholds, TOUCH_DISTANCE};
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::settings::Settings;
use crate::state::State;
use crate::system::System;

/// The contact that is violated most: the index of its constraint, and −C [m]. `None` where every contact is
/// within `TOUCH_DISTANCE` × `tolerance` of its row's scale.
pub(crate) fn deepest<const D: usize>(system: &System, state: &State, tolerance: f64) -> Option<(usize, f64)> {
    if system.contacts.list.is_empty() {
        return None;
    }
    let mut rows = system.empty_rows();
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    system.evaluate_rows(motion, &mut rows);
    let contacts = system.contacts.list.iter().filter(|contact| !state.modes.is_gone(contact));
    let depths = contacts.map(|contact| (contact, -rows.C[contact.normal]));
    let violated =
        depths.filter(|(contact, depth)| *depth > TOUCH_DISTANCE * tolerance * system.row_scale[contact.normal]);
    violated.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(contact, depth)| (contact.constraint, depth))
}

/// Closes taut ropes and contacts at rest, so that forces are known before the first step. A contact whose closing
/// would be an impact, or has no answer, is left to the first step, which reports it.
pub(crate) fn close<const D: usize>(system: &System, state: &mut State, settings: &Settings, equation: &mut Equation) {
    let thresholds = RestThresholds {
        touch_distance: TOUCH_DISTANCE * settings.constraint_tolerance,
        shortest_flight: Some(0.0),
        frame: settings.h,
    };
    let (mut modes, mut qd) = (state.modes.clone(), state.qd.clone());
    let mut resolution = EventResolution::<D> { equation, system, q: &state.q, qd: &mut qd, t: state.t, thresholds };
    if resolution.resolve(&mut modes, None).is_ok() && qd == state.qd {
        state.modes = modes;
    }
}
