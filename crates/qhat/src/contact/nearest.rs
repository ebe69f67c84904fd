//! The start of a system with contacts: the nearest positions and velocities, in the mass metric, that satisfy
//! equations and contacts.
//!
//! ```text
//! positions   ½ (q − q⁰)ᵀ M (q − q⁰) least      C = 0,  of contacts C ≥ 0
//! velocities  ½ (q̇ − q̇⁰)ᵀ M (q̇ − q̇⁰) least      Ċ = 0,  of touching contacts Ċ ≥ min(Ċ⁰, 0)
//! ```
//!
//! With the rows linearised at q_i, both are the problem of `complementarity.rs` without friction:
//!
//! ```text
//! b = −C + J (q_i − q⁰),   w = A λ − b,   q_{i+1} = q⁰ + W Jᵀ λ
//! b = −Ċ⁰, or −max(Ċ⁰, 0) of a touching contact,   q̇ = q̇⁰ + W Jᵀ Λ
//! ```
//!
//! So a contact that would pull is open, and one that would be violated is closed. An approach that the scene writes is
//! an impact with the restitution of its contact: the first step resolves it and reports it. The equations must not add
//! an approach of their own, which would bounce.

use super::{NoConsistentModes, Touching, settle};
use crate::drift::worst_row;
use crate::modes::Modes;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::system::System;

/// Rounds of linearisation. The error shrinks by curvature times the way in each.
const ROUNDS: usize = 60;

/// Way of one round, in extents, at which the contacts that act are known; Newton's method then goes the rest.
const SETTLED: f64 = 1e-9;

/// The least part of C that a round takes out.
const SMALLEST: f64 = 1e-3;

/// Halvings of one round.
const HALVINGS: usize = 12;

/// Part of the speeds below which an approach is roundoff.
const ROUNDOFF: f64 = 1e-12;

/// A start under way.
pub(crate) struct NearestStart<'a> {
    pub(crate) equation: &'a mut Equation,
    pub(crate) system: &'a System,
    pub(crate) t: f64,
    /// Gap, relative to the row's scale, below which a contact is violated if negative and touches if positive.
    pub(crate) tolerance: f64,
}

impl NearestStart<'_> {
    /// Whether contacts that are not broken are violated at q.
    pub(crate) fn is_violated<const D: usize>(&mut self, modes: &Modes, q: &[f64], qd: &[f64]) -> bool {
        self.equation.constrain_all(self.system, Motion::<D> { q, qd, t: self.t });
        self.depth(modes) > self.tolerance
    }

    /// Moves q, which satisfies the equations and violates contacts, near the nearest to `written` that satisfies
    /// both. Returns the modes of contacts there, closed where they hold q. The equations are met to the tolerance once
    /// the active rows have been projected.
    pub(crate) fn positions<const D: usize>(
        &mut self,
        state: &Modes,
        written: &[f64],
        q: &mut [f64],
        qd: &[f64],
    ) -> Result<Modes, NoConsistentModes> {
        let (system, t) = (self.system, self.t);
        let mut modes = Modes { broken: state.broken.clone(), ..Modes::at_first(&system.contacts) };
        let mut touching = Vec::new();
        self.equation.constrain_all(system, Motion::<D> { q, qd, t });
        self.add_violated(state, &mut touching);
        q.copy_from_slice(written);
        let mut towards = vec![0.0; q.len()];
        let mut J_way = vec![0.0; system.all_row_count()];
        for _ in 0..ROUNDS {
            self.equation.constrain_all(system, Motion::<D> { q, qd, t });
            let found = self.add_violated(state, &mut touching);
            towards.iter_mut().zip(&*q).zip(written).for_each(|((way, q), written)| *way = q - written);
            self.equation.rows.J.multiply::<D>(&towards, &mut J_way);
            let off = self.off(state);
            let part = self.settle::<D>(&mut modes, &touching, &J_way)?;
            // From q to q⁰ + W Jᵀ λ.
            let ends = written.iter().zip(&self.equation.W_JT_lambda);
            towards.iter_mut().zip(ends).zip(&*q).for_each(|((way, (w, change)), q)| *way = w + change - q);
            let way = towards.iter().fold(0.0_f64, |most, way| most.max(way.abs()));
            if part == 1.0 && way <= SETTLED * system.extent && !found {
                return Ok(modes);
            }
            let before = q.to_vec();
            let mut fraction = 1.0;
            for _ in 0..HALVINGS {
                for ((q, before), way) in q.iter_mut().zip(&before).zip(&towards) {
                    *q = before + fraction * way;
                }
                self.equation.constrain_all(system, Motion::<D> { q, qd, t });
                // Near the end rounds move along the rows, and what they are off by is of second order.
                if self.off(state) <= off.max(way / system.extent) {
                    break;
                }
                fraction *= 0.5;
            }
        }
        Ok(modes)
    }

    /// One round, for J (q_i − q⁰). Where linearised rows and contacts leave nothing, as far from q⁰, a part of C is
    /// taken out: contacts are satisfied where the rounds begin, so there is such a part. Returns the part.
    fn settle<const D: usize>(
        &mut self,
        modes: &mut Modes,
        touching: &[Touching],
        J_way: &[f64],
    ) -> Result<f64, NoConsistentModes> {
        let (at_first, mut part) = (modes.clone(), 1.0);
        loop {
            let Equation { b, rows, .. } = &mut *self.equation;
            b.sum.iter_mut().zip(&rows.C).zip(J_way).for_each(|((b, C), J_way)| *b = J_way - part * C);
            match settle::<D>(self.equation, self.system, modes, touching) {
                Err(failure) if part < SMALLEST => return Err(failure),
                Err(_) => {
                    part *= 0.5;
                    modes.clone_from(&at_first);
                }
                Ok(()) => return Ok(part),
            }
        }
    }

    /// Takes Ċ of the equations out of q̇, from `written` on, so that no touching contact approaches faster than is
    /// written.
    pub(crate) fn velocities<const D: usize>(
        &mut self,
        state: &Modes,
        q: &[f64],
        written: &[f64],
        qd: &mut [f64],
    ) -> Result<(), NoConsistentModes> {
        let (system, t) = (self.system, self.t);
        let mut modes = Modes { broken: state.broken.clone(), ..Modes::at_first(&system.contacts) };
        self.equation.constrain_all(system, Motion::<D> { q, qd: written, t });
        let Equation { b, rows, .. } = &mut *self.equation;
        b.sum.iter_mut().zip(&rows.Cd).for_each(|(b, Cd)| *b = -Cd);
        let touching = self.near(state);
        for contact in &touching {
            let row = system.contacts.list[contact.contact].normal;
            self.equation.b.sum[row] = self.equation.b.sum[row].min(0.0);
        }
        settle::<D>(self.equation, system, &mut modes, &touching)?;
        let changes = written.iter().zip(&self.equation.W_JT_lambda);
        qd.iter_mut().zip(changes).for_each(|(qd, (written, change))| *qd = written + change);
        Ok(())
    }

    /// Whether a touching contact approaches faster at q̇ than at the velocities that are written.
    pub(crate) fn approaches<const D: usize>(&mut self, state: &Modes, q: &[f64], written: &[f64], qd: &[f64]) -> bool {
        let (system, t) = (self.system, self.t);
        self.equation.constrain_all(system, Motion::<D> { q, qd: written, t });
        let touching = self.near(state);
        let before = self.equation.rows.Cd.clone();
        self.equation.constrain_all(system, Motion::<D> { q, qd, t });
        let fastest = written.iter().chain(qd).fold(0.0_f64, |most, v| most.max(v.abs()));
        touching.iter().any(|contact| {
            let row = system.contacts.list[contact.contact].normal;
            self.equation.rows.Cd[row] < before[row].min(0.0) - ROUNDOFF * fastest
        })
    }

    /// The row of the contact that is violated most, and its C.
    pub(crate) fn deepest(&self, modes: &Modes) -> Option<(usize, f64)> {
        let contacts = self.system.contacts.list.iter().filter(|contact| !modes.is_gone(contact));
        let depths = contacts.map(|contact| (contact.normal, self.equation.rows.C[contact.normal]));
        depths
            .min_by(|(a, gap), (b, other)| {
                (gap / self.system.row_scale[*a]).total_cmp(&(other / self.system.row_scale[*b]))
            })
            .filter(|(_, gap)| *gap < 0.0)
    }

    /// The largest violation of a contact, over the scale of its row.
    fn depth(&self, modes: &Modes) -> f64 {
        self.deepest(modes).map_or(0.0, |(row, gap)| -gap / self.system.row_scale[row])
    }

    /// What q is off by: the largest |C| of an equation or violation of a contact, over the row's scale.
    fn off(&self, modes: &Modes) -> f64 {
        let mut C = self.equation.rows.C.clone();
        for contact in &self.system.contacts.list {
            C[contact.normal] = if modes.is_gone(contact) { 0.0 } else { C[contact.normal].min(0.0) };
        }
        for (breakable, _) in self.system.contacts.breakables.iter().zip(&modes.broken).filter(|(_, broken)| **broken) {
            C[breakable.rows.clone()].fill(0.0);
        }
        worst_row(self.system, &C).1
    }

    /// Adds the contacts that are violated; whether there is a new one.
    fn add_violated(&self, modes: &Modes, touching: &mut Vec<Touching>) -> bool {
        let known = touching.len();
        for (k, contact) in self.system.contacts.list.iter().enumerate() {
            let is_violated =
                self.equation.rows.C[contact.normal] < -self.tolerance * self.system.row_scale[contact.normal];
            if is_violated && !modes.is_gone(contact) && !touching.iter().any(|touching| touching.contact == k) {
                touching.push(Touching::smooth(k));
            }
        }
        touching.len() > known
    }

    /// The contacts that touch, without friction.
    fn near(&self, modes: &Modes) -> Vec<Touching> {
        let contacts = self.system.contacts.list.iter().enumerate();
        let near = contacts.filter(|(_, contact)| {
            let gap = self.equation.rows.C[contact.normal];
            !modes.is_gone(contact) && gap <= self.tolerance * self.system.row_scale[contact.normal]
        });
        near.map(|(k, _)| Touching::smooth(k)).collect()
    }
}
