//! K = Bᵀ B, the stiffness of the elastic truss, and displacements under a force: (K + δ) u = F.
//!
//! ```text
//! D K D + δ I,   D = diag(K)^(−½)        scaled to a unit diagonal, so that units and stiffnesses do not matter
//! ```
//!
//! K is singular where the structure can move. δ, a few hundred roundoffs, stands for what would hold it there; a force
//! that constraints exert does not push in these directions, so that δ changes only roundoff.
//!
//! A row with very many particles would couple all of them. Its term b bᵀ is not formed; b·u stays an unknown
//! (`linalg/hubs.rs`).

use super::component::Component;
use crate::linalg::{DENSE_UP_TO, EliminationPlan, Factor, Hubs, Incidence, Pattern, Symbolic};
use std::sync::Arc;

/// δ of the first try. Pivots that vanish in exact arithmetic come out at a few roundoffs, on either side of zero.
const SHIFT: f64 = 1e-13;

/// δ of the last try; each is a hundred times the one before. The entries of D K D are at most 1, so that a larger one
/// is never needed.
const LARGEST_SHIFT: f64 = 1e-5;

/// The factor of D K D + δ I. Its pattern never changes.
#[derive(Clone, Debug)]
pub(super) struct Displacements {
    pattern: Pattern,
    /// The place of each coordinate in the order of elimination.
    place: Vec<u32>,
    /// For each row, the slots of the products of its numbers, or of its numbers if the row is a hub.
    slots: Vec<u32>,
    /// For each row, the place of its unknown if it is a hub.
    hub: Vec<Option<u32>>,
    factor: Factor,
    values: Vec<f64>,
    /// D, in the order of coordinates.
    scale: Vec<f64>,
    x: Vec<f64>,
}

impl Displacements {
    pub(super) fn new<const D: usize>(rows: &Component, particles: usize) -> Self {
        let n = D * particles;
        let mut at = vec![Vec::new(); particles];
        for i in 0..rows.row_count() {
            for block in rows.blocks(i) {
                at[rows.particle[block] as usize].push(i as u32);
            }
        }
        let unknowns = (0..n).map(|c| at[c / D].iter().copied());
        let incidence = Incidence::new(rows.row_count(), unknowns);
        let hubs = Hubs::new(&incidence, 1);
        let plan = EliminationPlan::with_hubs(&incidence, &hubs);
        let all = n + hubs.unknown_count();
        let order = if all <= DENSE_UP_TO { (0..all as u32).collect() } else { plan.order.clone() };
        let pattern = Pattern::of_incidence(&hubs.extended(&incidence).permuted(&order));
        let negative = order.iter().map(|&unknown| unknown as usize >= n).collect();
        let symbolic = Arc::new(Symbolic::new(&pattern, &plan, None, negative));
        let mut place = vec![0; all];
        for (k, &unknown) in order.iter().enumerate() {
            place[unknown as usize] = k as u32;
        }
        let number = |i: usize| hubs.number(i as u32).map(|hub| place[n + hub]);
        let hub: Vec<Option<u32>> = (0..rows.row_count()).map(number).collect();
        let mut displacements = Displacements {
            factor: Factor::with(&symbolic),
            values: vec![0.0; pattern.len()],
            pattern,
            place,
            slots: Vec::new(),
            hub,
            scale: vec![0.0; n],
            x: vec![0.0; all],
        };
        displacements.find_slots::<D>(rows);
        displacements
    }

    fn find_slots<const D: usize>(&mut self, rows: &Component) {
        let Displacements { pattern, place, slots, hub, .. } = self;
        let slot = |k: u32, l: u32| pattern.slot(k.max(l) as usize, k.min(l) as usize).map(|slot| slot as u32);
        for (i, hub) in hub.iter().enumerate() {
            let places: Vec<u32> = rows.coordinates::<D>(i).map(|c| place[c]).collect();
            match *hub {
                Some(hub) => slots.extend(places.iter().filter_map(|&k| slot(k, hub))),
                None => {
                    for (k, &own) in places.iter().enumerate() {
                        slots.extend(places[..=k].iter().filter_map(|&other| slot(own, other)));
                    }
                }
            }
        }
    }

    /// Factors D K D + δ I for these B, D numbers for each block, and returns the smallest pivot; `None` if that
    /// failed.
    pub(super) fn factor<const D: usize>(&mut self, rows: &Component, b: &[f64]) -> Option<f64> {
        let Displacements { pattern, slots, hub, factor, values, scale, .. } = self;
        scale.fill(0.0);
        for i in 0..rows.row_count() {
            for (c, number) in rows.coordinates::<D>(i).zip(rows.numbers::<D>(i, b)) {
                scale[c] += number * number;
            }
        }
        for scale in scale.iter_mut() {
            *scale = if *scale > 0.0 { 1.0 / scale.sqrt() } else { 0.0 };
        }
        values.fill(0.0);
        let mut slots = slots.iter();
        let mut scaled = Vec::new();
        for (i, hub) in hub.iter().enumerate() {
            scaled.clear();
            let numbers = rows.numbers::<D>(i, b);
            scaled.extend(rows.coordinates::<D>(i).zip(numbers).map(|(c, number)| scale[c] * number));
            match *hub {
                Some(hub) => {
                    for (&number, &slot) in scaled.iter().zip(&mut slots) {
                        values[slot as usize] = number;
                    }
                    values[pattern.diagonal(hub as usize)] = -1.0;
                }
                None => {
                    for (k, &number) in scaled.iter().enumerate() {
                        for (&other, &slot) in scaled[..=k].iter().zip(&mut slots) {
                            values[slot as usize] += number * other;
                        }
                    }
                }
            }
        }
        // Nothing acts on a coordinate without a row.
        for (c, _) in scale.iter().enumerate().filter(|&(_, &scale)| scale == 0.0) {
            values[pattern.diagonal(self.place[c] as usize)] = 1.0;
        }
        let mut shift = SHIFT;
        loop {
            let smallest = factor.factor(pattern, values, shift);
            if smallest > 0.0 {
                return Some(smallest);
            }
            if smallest.is_nan() || shift >= LARGEST_SHIFT {
                return None;
            }
            shift *= 100.0;
        }
    }

    /// u ← (K + δ D⁻²)⁻¹ u.
    pub(super) fn solve(&mut self, u: &mut [f64]) {
        self.x.fill(0.0);
        for (c, u) in u.iter().enumerate() {
            self.x[self.place[c] as usize] = self.scale[c] * u;
        }
        self.factor.solve(&mut self.x);
        for (c, u) in u.iter_mut().enumerate() {
            *u = self.scale[c] * self.x[self.place[c] as usize];
        }
    }
}
