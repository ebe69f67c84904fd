//! Lengths: a weighted sum of distances, Σ w |d| = L(t): a rope over pulleys, a block and tackle, a winch, two lengths
//! that are equal or have a given ratio.
//!
//! ```text
//! d = x_b − x_a of each segment,   n = d/|d|
//! C = Σ w |d| − L(t)              [m],  λ [N]
//! ∂C/∂d = w n,   C_t = −L̇
//! ```
//!
//! −λ is the tension of the rope: a segment of weight w pulls its ends together with −w λ. The constraint is an
//! equality, so this rope also pushes where λ > 0.
//!
//! A segment without length has no direction, and its gradient jumps there: a substep that would pass it is refused,
//! and the run ends with an error (integrate/edges.rs). At the place itself the gradient is taken as zero. The
//! curvature 1/|d| grows without bound as |d| goes to zero, so a load must not be pulled all the way up to its pulley.

use super::arms::Arms;
use super::error::ConstraintError;
use super::smooth::{At, Gradient, LONG, Residual, Smooth};
use crate::allowed::finite;
use crate::driven::Driven;
use crate::number::{Number, minus, norm, scaled};
use crate::point::Motion;
use crate::space::ParticleId;
use std::collections::BTreeMap;

/// A weighted sum of distances that is held at a length.
#[derive(Clone, Debug, PartialEq)]
pub struct Lengths {
    segments: Arms,
    weights: Vec<f64>,
    pub(crate) total: Driven,
}

impl Lengths {
    /// Σ w |d| = L \[m\] over segments from one particle to another, each with its weight.
    pub fn new(segments: &[([ParticleId; 2], f64)], total: impl Into<Driven>) -> Self {
        let (ends, weights): (Vec<_>, Vec<_>) = segments.iter().copied().unzip();
        Lengths { segments: Arms::new(ends), weights, total: total.into() }
    }

    /// A rope of length L \[m\] over points, in order. A point that the rope passes several times is named each time.
    pub fn pulley(points: &[ParticleId], total: impl Into<Driven>) -> Self {
        let segments: Vec<_> = points.windows(2).map(|pair| ([pair[0], pair[1]], 1.0)).collect();
        Lengths::new(&segments, total)
    }

    /// |x_a − x_b| = k |x_c − x_d|; k = 1 keeps the two distances equal.
    pub fn ratio(ab: [ParticleId; 2], cd: [ParticleId; 2], k: f64) -> Self {
        Lengths::new(&[(ab, 1.0), (cd, -k)], 0.0)
    }

    /// The segments, each from one particle to another, with their weights.
    pub fn segments(&self) -> impl Iterator<Item = ([ParticleId; 2], f64)> + '_ {
        self.weights.iter().enumerate().map(|(segment, &weight)| (self.segments.ends(segment), weight))
    }
}

impl Smooth for Lengths {
    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.segments.particles().get(i).copied()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (total, rate) = self.total.at(at.t);
        let length = |segment: usize| {
            let d = self.segments.vector(segment, at);
            let is_point = d.iter().all(|component| component.value() == 0.0);
            if is_point { (N::constant(0.0), [N::constant(0.0); D]) } else { (norm(d), d) }
        };
        let mut C = -total;
        for (segment, &weight) in self.weights.iter().enumerate() {
            C = C + length(segment).0.times(weight);
        }
        let slope = |segment: usize| {
            let (length, d) = length(segment);
            if length.value() == 0.0 { d } else { scaled(N::constant(self.weights[segment]) / length, d) }
        };
        self.segments.spread(slope, gradient);
        Residual { C, C_t: -rate }
    }

    fn may_jump(&self) -> bool {
        true
    }

    fn arms(&self) -> Vec<[ParticleId; 2]> {
        self.segments.all()
    }

    fn scale(&self, extent: f64) -> f64 {
        extent * self.weights.iter().fold(0.0, |most: f64, weight| most.max(weight.abs()))
    }

    /// An arm of weight w adds w (I − nnᵀ)/|d| to the blocks of its ends, and its negative between them: at most
    /// 2 √D |w|/|d| to the sum of a column.
    fn curvature_bound<const D: usize>(&self, motion: Motion<'_, D>) -> Option<f64> {
        if self.segments.particles().len() <= LONG {
            return None;
        }
        let mut sums = BTreeMap::new();
        for ([a, b], weight) in self.segments() {
            let length = norm(minus(motion.x(b), motion.x(a)));
            if length > 0.0 {
                for end in [a, b] {
                    *sums.entry(end).or_insert(0.0) += 2.0 * (D as f64).sqrt() * weight.abs() / length;
                }
            }
        }
        Some(sums.into_values().fold(0.0, f64::max))
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if self.weights.is_empty() {
            return Err(ConstraintError::NoSegments);
        }
        for (segment, &weight) in self.weights.iter().enumerate() {
            finite("a weight", weight)?;
            if weight == 0.0 {
                return Err(ConstraintError::NoSegmentWeight { segment });
            }
            if self.segments.is_without_length(segment) {
                return Err(ConstraintError::SegmentEnds { segment });
            }
        }
        self.total.check("the length of a rope")?;
        if self.total.value(0.0) <= 0.0 && self.weights.iter().all(|&weight| weight > 0.0) {
            return Err(ConstraintError::RopeLength { length: self.total.value(0.0) });
        }
        Ok(())
    }
}
