//! Link: a constraint that acts along the line of two particles a and b and has a tension: a rod, a rope, a strut.
//!
//! ```text
//! d = x_a − x_b,   n = d/|d|
//! Q̂ = −T n on a, T n on b        T > 0 pulls the two together, T < 0 pushes them apart, T = 0 while slack or broken
//! rod               T = −λ, or −2|d|λ in the squared form
//! rope and strut    T = λ of the longest − λ of the shortest; at most one of the two is not 0
//! ```
//!
//! T [N] is the tension as applied: λ is scaled by s where the row is rigid.

use super::{Constraint, Distance, Limits};
use crate::point::Motion;
use crate::space::ParticleId;
use std::ops::Range;

/// A constraint that acts along the line of two particles, as the faces draw and report it. `tension` has one number
/// for each link.
#[derive(Clone, Debug, PartialEq)]
pub struct Link<'a> {
    /// The name of the constraint.
    pub name: &'a str,
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// The least distance of the ends \[m\]; `None` for a rope.
    pub shortest: Option<f64>,
    /// The largest distance of the ends \[m\]; `None` for a loose strut. For a rod both distances are its length.
    pub longest: Option<f64>,
    /// The rows of the constraint in C, λ and J. With two limits, the row of the longest comes first.
    pub rows: Range<usize>,
}

impl Link<'_> {
    /// Whether the link holds one length.
    pub fn is_rod(&self) -> bool {
        self.shortest == self.longest
    }
}

/// The constraint that a link stands for.
pub(crate) enum LinkKind<'a> {
    Rod(&'a Distance),
    Limits(&'a Limits),
}

impl Constraint {
    pub(crate) fn as_link(&self) -> Option<LinkKind<'_>> {
        match self {
            Constraint::Distance(rod) => Some(LinkKind::Rod(rod)),
            Constraint::Limits(limits) => Some(LinkKind::Limits(limits)),
            _ => None,
        }
    }
}

impl<'a> LinkKind<'a> {
    /// The link as the faces see it.
    pub(crate) fn link(&self, name: &'a str, rows: Range<usize>) -> Link<'a> {
        match *self {
            LinkKind::Rod(&Distance { a, b, length, .. }) => {
                Link { name, a, b, shortest: Some(length), longest: Some(length), rows }
            }
            LinkKind::Limits(&Limits { a, b, shortest, longest, .. }) => Link { name, a, b, shortest, longest, rows },
        }
    }

    /// T [N] from λ of the rows of the constraint.
    pub(crate) fn tension<const D: usize>(&self, motion: Motion<'_, D>, lambda: &[f64], s: f64) -> f64 {
        match self {
            // A soft rod is a force, so λ is not scaled by s.
            LinkKind::Rod(rod) if rod.compliance > 0.0 => rod.tension(motion, lambda[0]),
            LinkKind::Rod(rod) => rod.tension(motion, s * lambda[0]),
            LinkKind::Limits(limits) => s * limits.tension(lambda),
        }
    }
}
