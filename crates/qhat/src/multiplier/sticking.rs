//! λ of sticking contacts where rows follow from others.
//!
//! Three feet of a rigid body that stick have nine rows, of which six hold the body. With λ of independent rows, single
//! feet would do all the work, beyond their cones of friction. Of all λ with the same force Jᵀλ, the one is taken that
//! slightly elastic contacts between rigid rows would have, and of those within all cones the nearest to it
//! (`cones.rs`):
//!
//! ```text
//! least Σ (|J_i| λ_i)² over the rows i of contacts,   λ = λ⁰ + Σ_r c_r v_r
//! v_r: 1 in a row r that follows from others, −A_kk⁻¹ A_kr in the rows k that are kept         Jᵀ v_r = 0
//! ```
//!
//! λ⁰ is that of independent rows. The v are made orthonormal in the product of that sum, one after the other, so that
//! each takes its own part from λ⁰.
//!
//! Friction of a sliding contact follows its normal force, so a v with a part in that force would be another motion,
//! and is not used.

use super::Equation;
use super::cones::{Member, least_outside};
use crate::point::norm;
use crate::structure::Contact;
use crate::system::System;

/// Part of a v in the rows of contacts below which the part is roundoff: λ is good to some 1e-12 of it.
const NONE: f64 = 1e-8;

impl Equation {
    /// Spreads λ over the rows of contacts if one of them sticks and rows follow from others. The motion is the same.
    /// In the plane λ stays: modes of a cone with two edges are those of a solution with independent rows.
    pub(crate) fn spread_over_contacts<const D: usize>(&mut self, system: &System) {
        let is_sticking = |contact: &Contact| contact.tangents.clone().any(|row| !self.is_inactive(row));
        if D == 2 || self.solver.dependent().is_empty() || !system.contacts.list.iter().any(is_sticking) {
            return;
        }
        let weight = self.weights::<D>(system);
        let product = |a: &[f64], b: &[f64]| -> f64 { weight.iter().zip(a).zip(b).map(|((w, a), b)| w * a * b).sum() };
        let add = |factor: f64, v: &[f64], to: &mut [f64]| {
            to.iter_mut().zip(v).for_each(|(to, v)| *to += factor * v);
        };
        let mut lambda = self.lambda.clone();
        let of_lambda = (self.Q_hat.clone(), self.W_JT_lambda.clone());
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for row in self.solver.dependent().to_vec() {
            self.answer_to_row::<D>(system, row as usize);
            let mut v = self.lambda.clone();
            let largest = v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            if self.sliding.iter().any(|contact| v[contact.normal].abs() > NONE * largest) {
                continue;
            }
            let before = product(&v, &v).sqrt();
            for u in &basis {
                let along = product(u, &v);
                add(-along, u, &mut v);
            }
            let size = product(&v, &v).sqrt();
            // The rest of v has no part in contacts.
            if size.is_nan() || size <= NONE * before.max(largest * NONE) {
                continue;
            }
            v.iter_mut().for_each(|v| *v /= size);
            let along = product(&v, &lambda);
            add(-along, &v, &mut lambda);
            basis.push(v);
        }
        let members = self.members(system, &weight, &lambda, &basis);
        let z = least_outside(&members, basis.len());
        z.iter().zip(&basis).filter(|(z, _)| **z != 0.0).for_each(|(z, v)| add(*z, v, &mut lambda));
        self.lambda = lambda;
        (self.Q_hat, self.W_JT_lambda) = of_lambda;
    }

    /// The closed contacts that do not slide, with their forces by λ and by each v.
    fn members(&self, system: &System, weight: &[f64], lambda: &[f64], basis: &[Vec<f64>]) -> Vec<Member> {
        let slides = |contact: &Contact| self.sliding.iter().any(|sliding| sliding.normal == contact.normal);
        let held = system.contacts.list.iter().filter(|contact| !self.is_inactive(contact.normal) && !slides(contact));
        let member = |contact: &Contact| {
            let is_sticking = contact.tangents.clone().any(|row| !self.is_inactive(row));
            let size = weight[contact.normal].sqrt();
            let force = |lambda: &[f64]| {
                let mut force = [size * lambda[contact.normal], 0.0, 0.0];
                let tangents = contact.tangents.clone().filter(|_| is_sticking);
                force[1..].iter_mut().zip(tangents).for_each(|(force, row)| *force = size * lambda[row]);
                force
            };
            let friction = if is_sticking { contact.friction } else { 0.0 };
            Member { friction, force: force(lambda), parts: basis.iter().map(|v| force(v)).collect() }
        };
        held.map(member).collect()
    }

    /// |J_i|² of active rows of contacts, 0 of others.
    fn weights<const D: usize>(&self, system: &System) -> Vec<f64> {
        let (J, layout) = (&self.rows.J, &self.rows.J.layout);
        let mut weight = vec![0.0; system.all_row_count()];
        for Contact { normal, tangents, .. } in &system.contacts.list {
            for row in std::iter::once(*normal).chain(tangents.clone()).filter(|&row| !self.is_inactive(row)) {
                let entries = layout.start[row]..layout.start[row + 1];
                weight[row] = entries.map(|e| norm(J.entry::<D>(e))).map(|size| size * size).sum();
            }
        }
        weight
    }
}
