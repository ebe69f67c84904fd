//! The choice of the contacts that act: the mixed complementarity problem, solved with the factor of the active rows.
//!
//! ```text
//! equations              A λ = b
//! touching contacts      w = A λ − b ≥ 0,   λ_n ≥ 0,   λ_n w = 0
//! friction               no slip with |λ_t| ≤ μ λ_n, or λ_t = −μ λ_n (direction of slip)
//! ```
//!
//! Forces and impulses are the same problem: with b = −γ − J W Q, w is C̈; in `impact.rs` w is a jump of Ċ.
//!
//! Method: pivoting on modes. The modes at hand are taken to be right, their active rows are solved, and every
//! contact that contradicts its mode changes it. Once a set of modes comes back, only the first contradicting contact
//! changes (Murty's rule of the least index), which ends for every positive definite A without friction. With
//! friction pivoting need not end; then `pyramids.rs` proposes modes to go on from. There may be no solution, or
//! several (Painlevé); a problem that does not end is an error.
//!
//! Rows of closed contacts may follow from other active rows, as the fourth leg of a table does. They are left out of A
//! with λ = 0, so λ is that of independent rows, a vertex of all solutions. In space λ is then spread over contacts if
//! one of them sticks (`multiplier/sticking.rs`). A contact that was left out stays closed while its w is zero; where
//! w > 0 it opens, and where w < 0 one of the contacts that it follows from must open, which Lemke's method finds.
//! Source: Murty, Linear Complementarity, Linear and Nonlinear Programming (1988), chapter 11.

use super::contradictions::{align, contradictions};
use super::pyramids::propose;
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::point::largest;
use crate::system::System;

/// Rest of the active rows, relative to the largest right-hand side, that is not solved for again: what a factor leaves
/// where nothing is ill-conditioned is 1e-15.
const REFINED: f64 = 1e-13;

/// Passes for each touching contact, and for four more: problems that end at all end in far fewer.
const PASSES: usize = 8;

/// Number of times that directions of slip are aligned with the slip. Each time the error shrinks by the part that
/// friction has in the slip.
const ALIGNMENTS: usize = 10;

/// A contact that touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touching {
    /// Its index among the contacts.
    pub(crate) contact: usize,
    /// The direction in which it slips; `None` if it does not.
    pub(crate) slip: Option<[f64; 2]>,
    /// Whether it may stick: an impulse may stop a slip, a force takes time to.
    pub(crate) may_stick: bool,
    /// Whether its friction acts.
    pub(crate) is_rough: bool,
}

impl Touching {
    /// A contact without its friction.
    pub(crate) fn smooth(contact: usize) -> Self {
        Touching { contact, slip: None, may_stick: false, is_rough: false }
    }

    /// The mode of this contact if it closes now.
    pub(crate) fn closed(&self) -> Mode {
        match self.slip {
            _ if !self.is_rough => Mode::Smooth,
            Some(direction) => Mode::sliding(direction),
            None => Mode::Sticking,
        }
    }
}

/// No consistent set of modes was found; the contact that contradicted its mode last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoConsistentModes {
    pub(crate) contact: usize,
}

/// Finds modes for the touching contacts, from those at hand, and λ in `equation.lambda`, for the right-hand side in
/// `equation.b.sum`. The rows must have been evaluated. Leaves A factored for those modes.
pub(crate) fn settle<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
) -> Result<(), NoConsistentModes> {
    let failure = match pivot::<D>(equation, system, modes, touching) {
        Ok(()) => return Ok(()),
        Err(failure) => failure,
    };
    *modes = propose::<D>(equation, system, modes, touching).ok_or(failure)?;
    pivot::<D>(equation, system, modes, touching)
}

/// Changes modes until none contradicts.
fn pivot<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
) -> Result<(), NoConsistentModes> {
    let mut seen: Vec<Vec<Mode>> = Vec::new();
    let mut one_at_a_time = false;
    let (mut last, mut aligned) = (0, 0);
    // Modes without a contradiction, whose directions of slip are not quite right.
    let mut consistent: Option<Vec<Mode>> = None;
    for _ in 0..PASSES * (touching.len() + 4) {
        solve::<D>(equation, system, modes);
        if equation.lambda.iter().any(|force| force.is_nan()) {
            break;
        }
        let Some(changes) = contradictions::<D>(equation, system, modes, touching) else { break };
        let Some(&(first, mode)) = changes.first() else {
            let contacts = modes.contacts.clone();
            if aligned == ALIGNMENTS || !align::<D>(equation, system, modes, touching) {
                return Ok(());
            }
            aligned += 1;
            consistent = Some(contacts);
            continue;
        };
        last = first;
        one_at_a_time |= seen.contains(&modes.contacts);
        seen.push(modes.contacts.clone());
        if one_at_a_time {
            modes.contacts[first] = mode;
        } else {
            changes.into_iter().for_each(|(k, mode)| modes.contacts[k] = mode);
        }
    }
    modes.contacts = consistent.ok_or(NoConsistentModes { contact: last })?;
    solve::<D>(equation, system, modes);
    Ok(())
}

/// λ, F and W (Jᵀλ + F), for modes and the right-hand side at hand, with λ spread over contacts.
pub(super) fn solve<const D: usize>(equation: &mut Equation, system: &System, modes: &Modes) {
    equation.set_modes(system, modes);
    solve_refined::<D>(equation, system);
    equation.spread_over_contacts::<D>(system);
}

/// The same without the spread. The rest of the active rows, −w by J W, is solved for once more: beside a load of a
/// billion beads it is too large.
fn solve_refined<const D: usize>(equation: &mut Equation, system: &System) {
    equation.factor::<D>(system, 0.0);
    equation.solve_multipliers::<D>(system);
    equation.write_W_JT_lambda_F::<D>(system);
    let rest = |equation: &Equation| -> Vec<f64> {
        let is_left_out = |row: usize| equation.is_inactive(row) || equation.is_left_out(row) || !system.is_rigid(row);
        (0..system.all_row_count()).map(|row| if is_left_out(row) { 0.0 } else { -w::<D>(equation, row) }).collect()
    };
    let before = rest(equation);
    if largest(&before) <= REFINED * largest(&equation.b.sum) {
        return;
    }
    let (b, lambda) = (std::mem::replace(&mut equation.b.sum, before.clone()), equation.lambda.clone());
    let force = equation.friction.force.clone();
    equation.solve_multipliers::<D>(system);
    equation.lambda.iter_mut().zip(&lambda).for_each(|(change, lambda)| *change += lambda);
    equation.friction.force.iter_mut().zip(&force).for_each(|(change, force)| *change += force);
    equation.b.sum = b;
    equation.write_W_JT_lambda_F::<D>(system);
    let after = largest(&rest(equation));
    if after.is_nan() || after >= largest(&before) {
        equation.lambda = lambda;
        equation.friction.force = force;
        equation.write_W_JT_lambda_F::<D>(system);
    }
}

/// w = J W (Jᵀλ + F) − b of one row.
pub(super) fn w<const D: usize>(equation: &Equation, row: usize) -> f64 {
    equation.J_W_JT_lambda::<D>(row) - equation.b.sum[row]
}

/// The numbers of up to two tangential rows; the second is zero in the plane.
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
