//! Which contacts act: the mixed complementarity problem, solved on the factor of the rows that are on.
//!
//! ```text
//! equations              A λ = b
//! contacts that touch    w = A λ − b ≥ 0,   λ_n ≥ 0,   λ_n w = 0
//! friction               no slip with |λ_t| ≤ μ λ_n, or λ_t = −μ λ_n (direction of slip)
//! ```
//!
//! The same problem for forces (b = −γ − J W Q: w is C̈) and for impulses (`impact.rs`: w is a jump of Ċ).
//!
//! Method: pivoting. The modes at hand are taken for right, the rows that they leave on are solved, and every contact that
//! contradicts its mode changes it. Where a set of modes comes back, from then on only the first that contradicts changes (Murty's
//! rule of the least index), which ends for every positive definite A without friction. With friction it need not end, though it nearly
//! always does and then takes a few passes; where it does not, `cones.rs` proposes modes to go on from. There may be no solution, or several (Painlevé):
//! what does not end is told.
//! Source: Murty, Linear Complementarity, Linear and Nonlinear Programming (1988), chapter 11.

use super::SAME_WAY;
use super::cones::propose;
use crate::modes::{Mode, Modes};
use crate::multiplier::{Equation, SolveFor};
use crate::structure::Contact;
use crate::system::System;

/// What is negative by less than this part of the largest of its kind is roundoff: solutions have some 1e-12 of it.
const ROUNDOFF: f64 = 1e-10;

/// Passes for each contact that touch_distance, and a few more: what ends at all ends in far fewer.
const PASSES: usize = 8;

/// How often directions of slip are aligned: each time brings them nearer by the part that friction has in the slip.
const ALIGNMENTS: usize = 10;

/// A contact that touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touching {
    /// Its place among the contacts.
    pub(crate) contact: usize,
    /// The direction in which it slips; `None` if it does not.
    pub(crate) slip: Option<[f64; 2]>,
    /// Whether it may stick: an impulse may stop what slips, a force takes time.
    pub(crate) may_stick: bool,
}

/// No modes were found that contradict nothing: the contact that was asked last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoConsistentModes {
    pub(crate) contact: usize,
}

/// Finds modes for what touch_distance, from those at hand, and λ in `equation.lambda` for the right side in `equation.b.sum`. The
/// rows must have been evaluated. Leaves A factored for those modes.
pub(crate) fn settle<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
) -> Result<(), NoConsistentModes> {
    let failure = match turn::<D>(equation, system, modes, touching) {
        Ok(()) => return Ok(()),
        Err(failure) => failure,
    };
    *modes = propose::<D>(equation, system, modes, touching).ok_or(failure)?;
    turn::<D>(equation, system, modes, touching)
}

/// Changes modes until none contradicts.
fn turn<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
) -> Result<(), NoConsistentModes> {
    let mut seen: Vec<Vec<Mode>> = Vec::new();
    let mut is_careful = false;
    let (mut last, mut aligned) = (0, 0);
    // Modes that contradict nothing, but for directions that are not quite right.
    let mut fits: Option<Vec<Mode>> = None;
    for _ in 0..PASSES * (touching.len() + 4) {
        solve::<D>(equation, system, modes);
        if equation.lambda.iter().any(|force| force.is_nan()) {
            break;
        }
        let changes = contradictions::<D>(equation, system, modes, touching);
        let Some(&(first, mode)) = changes.first() else {
            let contacts = modes.contacts.clone();
            if aligned == ALIGNMENTS || !align::<D>(equation, system, modes, touching) {
                return Ok(());
            }
            aligned += 1;
            fits = Some(contacts);
            continue;
        };
        last = first;
        is_careful |= seen.contains(&modes.contacts);
        seen.push(modes.contacts.clone());
        if is_careful {
            modes.contacts[first] = mode;
        } else {
            changes.into_iter().for_each(|(contact, mode)| modes.contacts[contact] = mode);
        }
    }
    modes.contacts = fits.ok_or(NoConsistentModes { contact: last })?;
    solve::<D>(equation, system, modes);
    Ok(())
}

/// λ, F and the push of both, for modes and the right side at hand.
pub(super) fn solve<const D: usize>(equation: &mut Equation, system: &System, modes: &Modes) {
    equation.set_modes(system, modes);
    equation.factor::<D>(system, 0.0);
    equation.solve_multipliers::<D>(system, SolveFor::Force);
    equation.write_push::<D>(system);
}

/// What of w is roundoff.
fn small_gap(equation: &Equation, system: &System, touching: &[Touching]) -> f64 {
    let rows = touching.iter().map(|touching| system.contacts.list[touching.contact].normal);
    ROUNDOFF * rows.map(|row| equation.b.sum[row].abs()).fold(0.0, f64::max)
}

/// Every contact that contradicts its mode, with the mode that does not.
fn contradictions<const D: usize>(
    equation: &Equation,
    system: &System,
    modes: &Modes,
    touching: &[Touching],
) -> Vec<(usize, Mode)> {
    let lambda = &equation.lambda;
    let small_force = ROUNDOFF * lambda.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    let small_gap = small_gap(equation, system, touching);
    // w of one row.
    let opening = |row: usize| equation.push_along::<D>(row) - equation.b.sum[row];
    let mut changes = Vec::new();
    for &Touching { contact: place, slip, may_stick } in touching {
        let Contact { normal, tangents, friction, .. } = &system.contacts.list[place];
        let has_friction = !tangents.is_empty();
        let mode = modes.contacts[place];
        let changed = match mode {
            Mode::Open if opening(*normal) < -small_gap => Some(match slip {
                _ if !has_friction => Mode::Smooth,
                Some(direction) => Mode::Sliding(direction),
                None => Mode::Sticking,
            }),
            Mode::Open => None,
            _ if lambda[*normal] < -small_force => Some(Mode::Open),
            Mode::Sticking => {
                let pull = along(tangents.clone().map(|row| lambda[row]));
                let size = size(pull);
                // What would slip, slips against the force that held it.
                (size > friction * lambda[*normal] + small_force)
                    .then(|| Mode::Sliding(pull.map(|component| -component / size)))
            }
            Mode::Sliding(direction) if may_stick => {
                let slipping = along(tangents.clone().map(opening));
                let along: f64 = slipping.iter().zip(direction).map(|(w, d)| w * d).sum();
                (along < -small_gap).then_some(Mode::Sticking)
            }
            Mode::Smooth | Mode::Sliding(_) => None,
        };
        changes.extend(changed.map(|mode| (place, mode)));
    }
    changes
}

/// Turns what begins to slip, or slips after an impact, to where it goes; whether anything turned. In space friction on one contact moves
/// others, so that a slip need not be against the force that held it.
fn align<const D: usize>(equation: &Equation, system: &System, modes: &mut Modes, touching: &[Touching]) -> bool {
    let small = small_gap(equation, system, touching);
    let mut turned = false;
    for &Touching { contact, .. } in
        touching.iter().filter(|touching| D == 3 && (touching.may_stick || touching.slip.is_none()))
    {
        let Mode::Sliding(direction) = modes.contacts[contact] else { continue };
        let rows = system.contacts.list[contact].tangents.clone();
        let slipping = along(rows.map(|row| equation.push_along::<D>(row) - equation.b.sum[row]));
        let size = size(slipping);
        if size > small && slipping[0] * direction[0] + slipping[1] * direction[1] < SAME_WAY * size {
            modes.contacts[contact] = Mode::Sliding(slipping.map(|component| component / size));
            turned = true;
        }
    }
    turned
}

/// Up to two numbers of tangential rows; the second is zero in the plane.
pub(crate) fn along(rows: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut components = [0.0; 2];
    for (component, value) in components.iter_mut().zip(rows) {
        *component = value;
    }
    components
}

pub(crate) fn size([a, b]: [f64; 2]) -> f64 {
    (a * a + b * b).sqrt()
}
