//! Contacts that contradict their modes, and directions of friction that are not those of their slips, for λ at hand.

use super::complementarity::{along, size, w};
use super::roundoff::Roundoffs;
use super::{SAME_WAY, Touching};
use crate::modes::{Mode, Modes, Slip};
use crate::multiplier::Equation;
use crate::structure::Contact;
use crate::system::System;

/// Every contact that contradicts its mode, with the mode that it changes to; `None` where a contact that follows from
/// others would be violated by them.
pub(super) fn contradictions<const D: usize>(
    equation: &Equation,
    system: &System,
    modes: &Modes,
    touching: &[Touching],
) -> Option<Vec<(usize, Mode)>> {
    let lambda = &equation.lambda;
    let all = Roundoffs::new::<D>(equation, system, touching);
    let w = |row: usize| w::<D>(equation, row);
    let mut changes = Vec::new();
    for touching in touching {
        let k = touching.contact;
        let Contact { normal, tangents, friction, .. } = &system.contacts.list[k];
        let small = all.of::<D>(equation, system, *normal);
        let mode = modes.contacts[k];
        let follows = mode.is_closed() && equation.is_left_out(*normal);
        if follows && w(*normal) < -small.following {
            return None;
        }
        let changed = match mode {
            // w_n < 0: the gap would close.
            Mode::Open if w(*normal) < -small.w => Some(touching.closed()),
            Mode::Open => None,
            // w_n > 0: the gap opens by itself.
            _ if follows && w(*normal) > small.following => Some(Mode::Open),
            // λ_n < 0: the contact would pull.
            _ if lambda[*normal] < -small.force => Some(Mode::Open),
            // |λ_t| > μ λ_n: the contact slips, against the force that held it.
            Mode::Sticking => {
                let (lambda_t, w_t) = (along(tangents.clone().map(|row| lambda[row])), along(tangents.clone().map(w)));
                let (size_of_lambda, size_of_w) = (size(lambda_t), size(w_t));
                let slips = tangents.clone().any(|row| equation.is_left_out(row)) && size_of_w > small.following;
                if slips {
                    Some(Mode::sliding(w_t.map(|component| component / size_of_w)))
                } else {
                    (size_of_lambda > friction * lambda[*normal] + small.force)
                        .then(|| Mode::sliding(lambda_t.map(|component| -component / size_of_lambda)))
                }
            }
            // w_t · d < 0: the impulse would turn the slip round.
            Mode::Sliding(slip) if touching.may_stick => {
                let w_t = along(tangents.clone().map(w));
                let onward: f64 = w_t.iter().zip(slip.direction).map(|(w, d)| w * d).sum();
                (onward < -small.w).then_some(Mode::Sticking)
            }
            Mode::Smooth | Mode::Sliding(_) => None,
        };
        changes.extend(changed.map(|mode| (k, mode)));
    }
    Some(changes)
}

/// Turns the direction of contacts that begin to slip, or slip after an impact, to their slip; whether any turned. In
/// space friction of one contact moves others, so that a slip need not be against the force that held it.
pub(super) fn align<const D: usize>(
    equation: &Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
) -> bool {
    let all = Roundoffs::new::<D>(equation, system, touching);
    let mut turned = false;
    for &Touching { contact: k, .. } in
        touching.iter().filter(|touching| D == 3 && (touching.may_stick || touching.slip.is_none()))
    {
        let Mode::Sliding(Slip { direction: d, .. }) = modes.contacts[k] else { continue };
        let w_t = along(system.contacts.list[k].tangents.clone().map(|row| w::<D>(equation, row)));
        let size = size(w_t);
        let small = all.of::<D>(equation, system, system.contacts.list[k].normal);
        if size > small.w && w_t[0] * d[0] + w_t[1] * d[1] < SAME_WAY * size {
            modes.contacts[k] = Mode::sliding(w_t.map(|component| component / size));
            turned = true;
        }
    }
    turned
}
