//! Share: how rows that repeat each other share the force that they exert together.
//!
//! Where A is singular, the constraint force F = Jᵀλ is unique, and λ is not. Among all λ with the same F, the share
//! is the one that elastic rods would have in the limit of infinite stiffness:
//!
//! ```text
//! least Σ L T²/EA over the rods, and then least Σ |J_iᵀ λ_i|² over the other rows,   Jᵀλ = F,
//! λ_i ≥ 0 of ropes, struts and contacts
//! ```
//!
//! T is the tension of a rod \[N\], L its length \[m\] and EA its own `stiffness` \[N\]; J_iᵀ λ_i is the force that a
//! row puts on particles that can move \[N\]. Both are forces, so that neither masses nor units nor the form of a row
//! play a part. Rows that are not rods do not deform and have no part in the energy of the rods.
//!
//! Where that share would take a sticking contact out of its cone of friction, λ goes only as far towards it, from
//! the λ by which modes were decided (`../sticking.rs`), as all cones of the component allow.
//!
//! `component.rs` computes the share of one connected component of rows, `range.rs` and `displacements.rs` have the
//! solves and the factor for it, and `one_sided.rs` finds the ropes and contacts that carry nothing. A component
//! whose rows are all independent keeps the λ that it has, to the bit.

mod component;
mod displacements;
mod one_sided;
mod range;

use super::{RightHandSide, Sliding};
use crate::constraint::Jacobian;
use crate::linalg::{Incidence, components};
use component::Component;
use std::ops::Range;

/// Halvings of the way to the edge of a cone: every bit of a number between 0 and 1.
const HALVINGS: usize = 53;

/// A sticking contact, |λ_t| ≤ μ λ_n.
#[derive(Clone, Debug)]
pub(crate) struct Sticking {
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// μ.
    pub(crate) friction: f64,
}

impl Sticking {
    /// The largest part t of the way from λ to `to`, up to `part`, with |λ_t| ≤ μ λ_n. λ itself counts as within.
    pub(super) fn part(&self, lambda: &[f64], to: &[f64], part: f64) -> f64 {
        let limit = |t: f64| self.friction * (lambda[self.normal] + t * (to[self.normal] - lambda[self.normal]));
        let squares = |t: f64| {
            let along = self.tangents.clone().map(|row| lambda[row] + t * (to[row] - lambda[row]));
            along.map(|force| force * force).sum::<f64>()
        };
        let is_within = |t: f64| limit(t) >= 0.0 && squares(t) <= limit(t) * limit(t);
        if is_within(part) {
            return part;
        }
        // The cone is convex, so what is within it is a stretch that begins at 0.
        let (mut low, mut high) = (0.0, part);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if is_within(middle) { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

/// The rows at one motion, as far as their share depends on them. Each list has one number for each row.
pub(crate) struct RowsToShare<'a> {
    pub(crate) J: &'a Jacobian,
    /// W; particles with W = 0 are fixed.
    pub(crate) inverse_mass: &'a [f64],
    /// L/EA of rods [m/N]; zero for rows that are not rods.
    pub(crate) flexibility: &'a [f64],
    /// Whether a row takes part: it is rigid and active, and it has a gradient.
    pub(crate) acts: &'a [bool],
    /// Whether λ ≥ 0 is required of a row.
    pub(crate) is_one_sided: &'a [bool],
    /// Q [N], d numbers for each particle.
    pub(crate) applied: &'a [f64],
    /// J q̈, as the equation asks for it: −γ − ks C − kd Ċ [C/s²].
    pub(crate) rates: &'a RightHandSide,
    /// λ of independent rows, whose force Jᵀλ is shared.
    pub(crate) lambda: &'a [f64],
    /// Sticking contacts: their forces stay within their cones of friction.
    pub(crate) sticking: &'a [Sticking],
    /// Sliding contacts. Their friction follows the λ of their normal rows, and belongs to F.
    pub(crate) sliding: &'a [Sliding],
}

/// The arrays for the share of one system, made when a share is first asked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Share {
    components: Option<Vec<Component>>,
    /// For each row whether its λ is unique.
    pub(crate) is_unique: Vec<bool>,
}

impl Share {
    /// Every λ is unique.
    pub(crate) fn set_unique(&mut self, rows: usize) {
        self.is_unique.clear();
        self.is_unique.resize(rows, true);
    }

    /// Replaces every λ that is not unique by its share, and notes which these are. `lambda` is a λ with the same force
    /// as `rows.lambda`, up to what rows that follow from others are off by, and within all cones of friction. `rigid`
    /// tells the rows that may act at some time.
    pub(crate) fn spread<const D: usize>(
        &mut self,
        rows: &RowsToShare<'_>,
        rigid: impl Fn(usize) -> bool,
        lambda: &mut [f64],
    ) {
        self.set_unique(lambda.len());
        // A λ that is not finite does not come from redundant rows; the caller will report it.
        if lambda.iter().any(|lambda| !lambda.is_finite()) {
            return;
        }
        let components = self.components.get_or_insert_with(|| find(rows.J, rows.inverse_mass, rigid));
        for component in components {
            component.spread::<D>(rows, lambda, &mut self.is_unique);
        }
    }
}

/// The connected components of the rows: two rows are connected if they share a particle that can move.
fn find(J: &Jacobian, inverse_mass: &[f64], rigid: impl Fn(usize) -> bool) -> Vec<Component> {
    let layout = &J.layout;
    let particles = |row: usize| {
        let is_rigid = rigid(row);
        let entries = layout.start[row]..layout.start[row + 1];
        let entries = entries.filter(move |_| is_rigid).map(|e| layout.particle[e].0);
        entries.filter(|&particle| inverse_mass[particle] > 0.0).map(|particle| particle as u32)
    };
    let incidence = Incidence::new(inverse_mass.len(), (0..layout.row_count()).map(particles));
    let found = components(&incidence).into_iter().map(|(_, rows)| rows);
    // A single row is redundant with no other.
    let several = found.filter(|rows| rows.len() > 1);
    several.map(|rows| Component::new(layout, inverse_mass, rows)).collect()
}
