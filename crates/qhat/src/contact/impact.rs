//! Impacts: what touches and closes in jumps to a velocity that does not.
//!
//! ```text
//! q̇⁺ = q̇⁻ + W (Jᵀ Λ + F)                     Λ: impulses [N·s], F those of friction
//! equations and what is at rest   Ċ⁺ = 0
//! contacts that touch             Ċ⁺ + e Ċ⁻ ≥ 0,  Λ_n ≥ 0, one of the two zero       (Newton's law of impact)
//! friction                        no slip after, or |Λ_t| = μ Λ_n against the slip after
//! ```
//!
//! so A Λ = b with b = −(1 + e) Ċ⁻ where a contact closes in and −Ċ elsewhere: the problem of `complementarity.rs`.
//!
//! Newton's law can gain energy where several contacts meet, or one with friction (Kane's pendulum), and what is wedged cannot bounce off
//! both sides. Such an impact is taken without giving back, e = 0, which never gains.

use super::complementarity::solve;
use super::cones::propose;
use super::{NoConsistentModes, Touching, settle};
use crate::modes::Modes;
use crate::multiplier::{Equation, SolveFor};
use crate::point::{block, dot};
use crate::space::ParticleId;
use crate::system::System;

/// Gains below this part of the kinetic energy are roundoff.
const ROUNDOFF: f64 = 1e-12;

/// Applies the impact to q̇; `gives_back` says for each of what touches whether it is fast enough to bounce. The rows must have been
/// evaluated at q and q̇. Returns the energy lost [J].
pub(crate) fn collide<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
    gives_back: &[bool],
    qd: &mut [f64],
) -> Result<f64, NoConsistentModes> {
    let before = kinetic::<D>(system, qd);
    let start = modes.clone();
    let mut is_bouncing = true;
    loop {
        modes.clone_from(&start);
        ask_to_stop(equation);
        let mut bounces = false;
        for (&Touching { contact, .. }, &gives_back) in touching.iter().zip(gives_back) {
            let contact = &system.contacts.list[contact];
            let rate = equation.rows.Cd[contact.normal];
            if is_bouncing && gives_back && rate < 0.0 {
                equation.b.sum[contact.normal] = -(1.0 + contact.restitution) * rate;
                bounces |= contact.restitution > 0.0;
            }
        }
        let outcome = settle::<D>(equation, system, modes, touching);
        let after: Vec<f64> = qd.iter().zip(&equation.push).map(|(v, push)| v + push).collect();
        let lost = before - kinetic::<D>(system, &after);
        match outcome {
            Err(failure) if !bounces => return Err(failure),
            Ok(()) if !bounces || lost >= -ROUNDOFF * before => {
                qd.copy_from_slice(&after);
                return Ok(lost);
            }
            _ => is_bouncing = false,
        }
    }
}

/// Takes out of q̇ what moves the rows that are on, with the factor and rows at hand. Returns the energy lost [J].
pub(crate) fn hold<const D: usize>(equation: &mut Equation, system: &System, qd: &mut [f64]) -> f64 {
    let before = kinetic::<D>(system, qd);
    ask_to_stop(equation);
    let Equation { solver, b, lambda, .. } = &mut *equation;
    solver.solve(&system.matrix, &b.sum, SolveFor::Force, lambda);
    equation.write_impulse::<D>(system);
    qd.iter_mut().zip(&equation.push).for_each(|(v, push)| *v += push);
    before - kinetic::<D>(system, qd)
}

/// What a force of friction without an answer does to q̇: an impulse without a collision. Friction that presses its own contact harder
/// than it is pressed (Painlevé) stops the slip in no time. As impulses over a time τ there is always an answer,
///
/// ```text
/// A Λ = b,   b = −Ċ − τ (γ + J W Q)
/// ```
///
/// and its modes say what stops; τ then counts for nothing. b must be that of the forces. Returns the energy lost [J].
/// Source: Génot, Brogliato, New Results on Painlevé Paradoxes (1999).
pub(crate) fn shock<const D: usize>(
    equation: &mut Equation,
    system: &System,
    modes: &mut Modes,
    touching: &[Touching],
    tau: f64,
    qd: &mut [f64],
) -> Result<f64, NoConsistentModes> {
    let failure = NoConsistentModes { contact: touching.first().map_or(0, |touching| touching.contact) };
    let before = kinetic::<D>(system, qd);
    for (b, rate) in equation.b.sum.iter_mut().zip(&equation.rows.Cd) {
        *b = tau * *b - rate;
    }
    let during = propose::<D>(equation, system, modes, touching).ok_or(failure)?;
    ask_to_stop(equation);
    solve::<D>(equation, system, &during);
    let after: Vec<f64> = qd.iter().zip(&equation.push).map(|(v, push)| v + push).collect();
    let lost = before - kinetic::<D>(system, &after);
    // Neither an impulse that takes something nor other modes: nothing that could go on.
    let takes = lost > ROUNDOFF * before;
    if lost.is_nan() || lost < -ROUNDOFF * before || (!takes && during == *modes) {
        return Err(failure);
    }
    *modes = during;
    qd.copy_from_slice(&after);
    Ok(lost)
}

/// b ← −Ċ.
fn ask_to_stop(equation: &mut Equation) {
    for (b, rate) in equation.b.sum.iter_mut().zip(&equation.rows.Cd) {
        *b = -rate;
    }
}

/// T of what can move [J].
fn kinetic<const D: usize>(system: &System, qd: &[f64]) -> f64 {
    let moving = (0..system.particle_count()).map(ParticleId).filter(|&i| !system.is_fixed(i));
    0.5 * moving.map(|i| (system.mass[i.0], block::<D>(qd, i))).map(|(m, v)| m * dot(v, v)).sum::<f64>()
}
