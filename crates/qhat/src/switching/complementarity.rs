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
//! rule of the least index), which ends for every positive definite A without friction. With friction the contacts that contradict take
//! turns, and what would close sticking is tried sliding, too; there may be no solution, or
//! several (Painlevé): what does not end is told.
//! Source: Murty, Linear Complementarity, Linear and Nonlinear Programming (1988), chapter 11.

use super::{Contact, Mode, Modes};
use crate::multiplier::{Equation, Multipliers};
use crate::system::System;
use std::ops::Range;

/// What is negative by less than this part of the largest of its kind is roundoff: solutions have some 1e-12 of it.
const ROUNDOFF: f64 = 1e-10;

/// Passes for each contact that touches, and a few more: what ends at all ends in far fewer.
const PASSES: usize = 8;

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
pub(crate) struct Jam {
    pub(crate) contact: usize,
}

/// Finds modes for what touches, from those at hand, and λ in `equation.lambda` for the right side in `equation.b.sum`. The
/// rows must have been evaluated. Leaves A factored for those modes.
pub(crate) fn settle<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
) -> Result<(), Jam> {
    let mut seen: Vec<Vec<Mode>> = Vec::new();
    let mut is_careful = false;
    let mut last = 0;
    for pass in 0..PASSES * (touching.len() + 4) {
        equation.set_modes(system, modes);
        equation.factor::<D>(system, 0.0);
        equation.solve_multipliers::<D>(system, Multipliers::Force);
        if equation.lambda.iter().any(|force| force.is_nan()) {
            break;
        }
        equation.write_push::<D>(system);
        let changes = contradictions::<D>(equation, system, modes, touching);
        let Some(&(first, _)) = changes.first() else { return Ok(()) };
        last = first;
        is_careful |= seen.contains(&modes.contacts);
        seen.push(modes.contacts.clone());
        if !is_careful {
            changes.into_iter().for_each(|(contact, mode)| modes.contacts[contact] = mode);
            continue;
        }
        let has_friction = touching.iter().any(|touching| !tangents(system, touching.contact).is_empty());
        let (contact, mode) = changes[if has_friction { pass % changes.len() } else { 0 }];
        let closes_sticking = modes.contacts[contact] == Mode::Open && mode == Mode::Sticking;
        modes.contacts[contact] = if closes_sticking && pass % 3 == 0 {
            sliding::<D>(equation, system, contact).unwrap_or(mode)
        } else {
            mode
        };
    }
    Err(Jam { contact: last })
}

fn tangents(system: &System, contact: usize) -> Range<usize> {
    system.switches.contacts[contact].tangents.clone()
}

/// The mode in which something open slips the way it goes; `None` if it goes nowhere.
fn sliding<const D: usize>(equation: &Equation, system: &System, contact: usize) -> Option<Mode> {
    let slip = along(tangents(system, contact).map(|row| equation.push_along::<D>(row) - equation.b.sum[row]));
    let size = size(slip);
    (size > 0.0).then(|| Mode::Sliding(slip.map(|component| component / size)))
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
    let rows = touching.iter().map(|touching| system.switches.contacts[touching.contact].normal);
    let small_gap = ROUNDOFF * rows.map(|row| equation.b.sum[row].abs()).fold(0.0, f64::max);
    // w of one row.
    let opening = |row: usize| equation.push_along::<D>(row) - equation.b.sum[row];
    let mut changes = Vec::new();
    for &Touching { contact: place, slip, may_stick } in touching {
        let Contact { normal, tangents, friction, .. } = &system.switches.contacts[place];
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
