//! Coulomb friction of what slides: an applied force that follows the multiplier.
//!
//! ```text
//! F = −Σ μ λ_n Σ_k d_k J_tkᵀ          over the sliding contacts; d: unit direction of the slip in the tangential rows
//! A λ = b − J W F(λ)
//! ```
//!
//! Solved on the factor of A at hand: λ of one pass gives F of the next. One pass is exact where friction presses no contact
//! (a particle on a slope); elsewhere the error shrinks by what friction of one newton presses contacts with. Where that is one
//! newton or more there may be no solution at all (Painlevé's paradox), and the passes end without one.

use crate::constraint::Rows;
use crate::point::{add, dot, scaled};
use std::ops::Range;

/// The direction follows the slip where that is this many times what friction changes of it in a substep. What is slower turns at
/// a rate that no explicit method follows, and straightens itself: it keeps its direction.
const FAST: f64 = 4.0;

/// Where the slip has left that direction by more than this [rad], substeps must be short enough to follow it.
const ASTRAY: f64 = 0.03;

/// A contact that slides.
#[derive(Clone, Debug)]
pub(crate) struct Sliding {
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// μ.
    pub(crate) friction: f64,
    /// d.
    pub(crate) direction: [f64; 2],
    /// d where the substep began: what turns far from it within one has come to a stop on the way.
    pub(crate) began: [f64; 2],
    /// Whether d follows the slip.
    pub(crate) turns: bool,
}

impl Sliding {
    /// The longest substep in which d can follow the slip [s], and the slip: at a beginning with these rates.
    fn follows<const D: usize>(&self, begin: &Beginning, rows: &Rows, W: &[f64]) -> (f64, [f64; 2]) {
        let layout = &rows.J.layout;
        let row = self.tangents.start;
        let entries = layout.start[row]..layout.start[row + 1];
        let w: f64 = entries.map(|e| W[layout.particle[e].0] * dot(rows.J.entry::<D>(e), rows.J.entry::<D>(e))).sum();
        let slip = [begin.Cd[row], begin.Cd[row + 1]];
        let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
        (speed / (FAST * self.friction * begin.lambda[self.normal].abs() * w), slip)
    }

    /// Turns d to where the contact slips now, in space; in the plane it cannot turn while the mode lasts.
    fn follow(&mut self, rows: &Rows) {
        if self.tangents.len() == 2 && self.turns {
            let slip = [rows.Cd[self.tangents.start], rows.Cd[self.tangents.start + 1]];
            let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            let along = slip[0] * self.began[0] + slip[1] * self.began[1];
            let follows = speed > 0.0 && along > 0.5 * speed;
            self.direction = if follows { slip.map(|component| component / speed) } else { self.began };
        }
    }
}

/// Ċ of every row, whether it took part or not, and λ, where a substep begins.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beginning {
    pub(crate) Cd: Vec<f64>,
    pub(crate) lambda: Vec<f64>,
}

/// All contacts that slide, and F.
#[derive(Clone, Debug, Default)]
pub(crate) struct Friction {
    pub(crate) sliding: Vec<Sliding>,
    /// F [N], d·n numbers; empty until something slides.
    pub(crate) force: Vec<f64>,
    /// b − J W F.
    pub(crate) target: Vec<f64>,
    /// λ of the pass before.
    pub(crate) last: Vec<f64>,
}

impl Friction {
    pub(crate) fn is_empty(&self) -> bool {
        self.sliding.is_empty()
    }

    /// Decides for a substep of h which directions follow the slip.
    pub(crate) fn prepare<const D: usize>(&mut self, begin: &Beginning, rows: &Rows, W: &[f64], h: f64) {
        for sliding in self.sliding.iter_mut().filter(|sliding| sliding.tangents.len() == 2) {
            sliding.turns = sliding.follows::<D>(begin, rows, W).0 > h;
        }
    }

    /// The longest substep from here [s]: bounded where something slips faster than `slow` and has left its direction.
    pub(crate) fn longest<const D: usize>(&self, begin: &Beginning, rows: &Rows, W: &[f64], slow: f64) -> f64 {
        let mut longest = f64::INFINITY;
        for sliding in self.sliding.iter().filter(|sliding| sliding.tangents.len() == 2) {
            let (h, slip) = sliding.follows::<D>(begin, rows, W);
            let across = (slip[0] * sliding.began[1] - slip[1] * sliding.began[0]).abs();
            let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            if speed > slow && across > ASTRAY * speed {
                longest = longest.min(0.5 * h);
            }
        }
        longest
    }

    pub(crate) fn follow(&mut self, rows: &Rows) {
        self.sliding.iter_mut().for_each(|sliding| sliding.follow(rows));
    }

    /// F for λ.
    pub(crate) fn write_force<const D: usize>(&mut self, rows: &Rows, lambda: &[f64], coordinates: usize) {
        self.force.clear();
        self.force.resize(coordinates, 0.0);
        for Sliding { normal, tangents, friction, direction, .. } in &self.sliding {
            for (row, d) in tangents.clone().zip(direction) {
                let layout = &rows.J.layout;
                for e in layout.start[row]..layout.start[row + 1] {
                    let push = scaled(-friction * lambda[*normal] * d, rows.J.entry::<D>(e));
                    add(&mut self.force, layout.particle[e], push);
                }
            }
        }
    }

    /// b − J W F.
    pub(crate) fn write_target<const D: usize>(&mut self, rows: &Rows, W: &[f64], b: &[f64]) {
        self.target.clear();
        self.target.extend_from_slice(b);
        let layout = &rows.J.layout;
        for (row, target) in self.target.iter_mut().enumerate() {
            for e in layout.start[row]..layout.start[row + 1] {
                let particle = layout.particle[e];
                let force = crate::point::block::<D>(&self.force, particle);
                *target -= W[particle.0] * dot(rows.J.entry::<D>(e), force);
            }
        }
    }
}
