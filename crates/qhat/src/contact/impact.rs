//! Impacts: the jump of the velocity where touching contacts close.
//!
//! ```text
//! q̇⁺ = q̇⁻ + W (Jᵀ Λ + F)                       Λ: impulses [N·s], F those of friction
//! equations and contacts at rest   Ċ⁺ = 0
//! touching contacts                Ċ⁺ + e Ċ⁻ ≥ 0,  Λ_n ≥ 0, one of the two zero       (Newton's law of impact)
//! friction                         no slip after, or |Λ_t| = μ Λ_n against the slip after
//! ```
//!
//! so A Λ = b with b = −(1 + e) Ċ⁻ for closing contacts and −Ċ elsewhere: the problem of `complementarity.rs`.
//!
//! Newton's law can gain energy where several contacts meet, or one with friction (Kane's pendulum), and a wedged
//! particle cannot bounce off both sides. Such an impact is solved with e = 0, which never gains energy.

use super::complementarity::solve;
use super::pyramids::propose;
use super::{NoConsistentModes, Touching, settle};
use crate::modes::Modes;
use crate::multiplier::Equation;
use crate::point::{block, dot};
use crate::space::ParticleId;
use crate::system::System;

/// Part of the kinetic energy below which a gain counts as roundoff.
const ROUNDOFF: f64 = 1e-12;

/// A jump of q̇ under way. The rows must have been evaluated at q and q̇.
pub(crate) struct Impact<'a, const D: usize> {
    pub(crate) equation: &'a mut Equation,
    pub(crate) system: &'a System,
    pub(crate) touching: &'a [Touching],
    pub(crate) qd: &'a mut [f64],
}

impl<const D: usize> Impact<'_, D> {
    /// Applies the impact to q̇; `bounces` says for each touching contact whether it closes fast enough to give back e
    /// of its speed. Returns the energy lost [J].
    pub(crate) fn collide(&mut self, modes: &mut Modes, bounces: &[bool]) -> Result<f64, NoConsistentModes> {
        let before = kinetic::<D>(self.system, self.qd);
        let start = modes.clone();
        let mut with_restitution = true;
        loop {
            modes.clone_from(&start);
            ask_to_stop(self.equation);
            let mut gives_back = false;
            for (&Touching { contact, .. }, &bounces) in self.touching.iter().zip(bounces) {
                let contact = &self.system.contacts.list[contact];
                let rate = self.equation.rows.Cd[contact.normal];
                if with_restitution && bounces && rate < 0.0 {
                    self.equation.b.sum[contact.normal] = -(1.0 + contact.restitution) * rate;
                    gives_back |= contact.restitution > 0.0;
                }
            }
            let outcome = settle::<D>(self.equation, self.system, modes, self.touching);
            let (after, lost) = self.after(before);
            match outcome {
                Err(failure) if !gives_back => return Err(failure),
                Ok(()) if !gives_back || lost >= -ROUNDOFF * before => {
                    self.qd.copy_from_slice(&after);
                    return Ok(lost);
                }
                // No answer, or energy gained.
                Err(_) | Ok(()) => with_restitution = false,
            }
        }
    }

    /// The impulse of a friction force that has no answer: an impulse without a collision. Friction that presses its
    /// own contact harder than the contact is pressed (Painlevé) stops the slip in no time. For impulses over a time
    /// τ there is always an answer,
    ///
    /// ```text
    /// A Λ = b,   b = −Ċ − τ (γ + J W Q)
    /// ```
    ///
    /// and its modes say which slips stop; the impulse itself is then solved for τ = 0. b must be that of the forces.
    /// Returns the energy lost [J].
    /// Source: Génot, Brogliato, New Results on Painlevé Paradoxes (1999).
    pub(crate) fn shock(&mut self, modes: &mut Modes, tau: f64) -> Result<f64, NoConsistentModes> {
        let failure = NoConsistentModes { contact: self.touching.first().map_or(0, |touching| touching.contact) };
        let before = kinetic::<D>(self.system, self.qd);
        for (b, rate) in self.equation.b.sum.iter_mut().zip(&self.equation.rows.Cd) {
            *b = tau * *b - rate;
        }
        let during = propose::<D>(self.equation, self.system, modes, self.touching).ok_or(failure)?;
        ask_to_stop(self.equation);
        solve::<D>(self.equation, self.system, &during);
        let (after, lost) = self.after(before);
        // An impulse that takes no energy and changes no mode would be asked for again and again.
        let takes_energy = lost > ROUNDOFF * before;
        if lost.is_nan() || lost < -ROUNDOFF * before || (!takes_energy && during == *modes) {
            return Err(failure);
        }
        *modes = during;
        self.qd.copy_from_slice(&after);
        Ok(lost)
    }

    /// q̇⁺ for the impulses at hand, and the energy lost [J] of the kinetic energy before.
    fn after(&self, before: f64) -> (Vec<f64>, f64) {
        let after: Vec<f64> = self.qd.iter().zip(&self.equation.W_JT_lambda).map(|(v, change)| v + change).collect();
        let lost = before - kinetic::<D>(self.system, &after);
        (after, lost)
    }
}

/// Takes Ċ of the active rows out of q̇, with the factor and rows at hand. Returns the energy lost [J].
pub(crate) fn hold<const D: usize>(equation: &mut Equation, system: &System, qd: &mut [f64]) -> f64 {
    let before = kinetic::<D>(system, qd);
    ask_to_stop(equation);
    let Equation { solver, b, lambda, .. } = &mut *equation;
    solver.solve(&system.matrix, &b.sum, lambda);
    equation.write_W_JT_lambda::<D>(system);
    qd.iter_mut().zip(&equation.W_JT_lambda).for_each(|(v, change)| *v += change);
    before - kinetic::<D>(system, qd)
}

/// b ← −Ċ.
fn ask_to_stop(equation: &mut Equation) {
    for (b, rate) in equation.b.sum.iter_mut().zip(&equation.rows.Cd) {
        *b = -rate;
    }
}

/// T of the particles that can move [J].
fn kinetic<const D: usize>(system: &System, qd: &[f64]) -> f64 {
    let moving = (0..system.particle_count()).map(ParticleId).filter(|&i| !system.is_fixed(i));
    0.5 * moving.map(|i| (system.mass[i.0], block::<D>(qd, i))).map(|(m, v)| m * dot(v, v)).sum::<f64>()
}
