//! Relation: a linear relation between positions, Σ w_i x_i = p: a particle in the middle of two others, the centre of
//! mass at a point, two particles at one point.
//!
//! ```text
//! C = Σ w_i x_i − p(t)      d rows [m], λ: force on a particle of weight 1 [N]
//! J = w_i I on each particle,   γ = −p̈,   C_t = −ṗ
//! ```

use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::allowed::finite;
use crate::driven::Driven;
use crate::number::Number;
use crate::point::Motion;
use crate::space::{ParticleId, first_repeated};

/// A weighted sum of positions that is held at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Relation {
    /// The particles with their weights, each particle once.
    pub terms: Vec<(ParticleId, f64)>,
    /// p \[m\]; the third component is ignored in two dimensions.
    pub point: [Driven; 3],
}

impl Relation {
    /// a and b at the same point: x_a − x_b = 0.
    pub fn coincidence(a: ParticleId, b: ParticleId) -> Self {
        Relation::homogeneous([(a, 1.0), (b, -1.0)])
    }

    /// m in the middle of a and b: x_m − ½ x_a − ½ x_b = 0.
    pub fn midpoint(m: ParticleId, a: ParticleId, b: ParticleId) -> Self {
        Relation::homogeneous([(m, 1.0), (a, -0.5), (b, -0.5)])
    }

    /// The centre of mass of particles with masses m_i \[kg\] at p(t): w_i = m_i/Σ m.
    pub fn center_of_mass(masses: impl Into<Vec<(ParticleId, f64)>>, point: [Driven; 3]) -> Self {
        let mut terms = masses.into();
        let sum: f64 = terms.iter().map(|(_, mass)| mass).sum();
        terms.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Relation { terms, point }
    }

    /// A particle at a point that may be driven: x = p(t).
    pub fn driven(particle: ParticleId, point: [Driven; 3]) -> Self {
        Relation { terms: vec![(particle, 1.0)], point }
    }

    /// Σ w_i x_i = 0.
    pub fn homogeneous(terms: impl Into<Vec<(ParticleId, f64)>>) -> Self {
        Relation { terms: terms.into(), point: [0.0; 3].map(Driven::Constant) }
    }
}

impl Smooth for Relation {
    fn row_count(&self, dimension: usize) -> usize {
        dimension
    }

    fn is_vector(&self) -> bool {
        true
    }

    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.terms.get(i).map(|&(particle, _)| particle)
    }

    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (point, rate) = self.point[row].at(at.t);
        let mut C = -point;
        for (i, &(_, weight)) in self.terms.iter().enumerate() {
            C = C + at.x(i)[row].times(weight);
            gradient.push(std::array::from_fn(|k| N::constant(if k == row { weight } else { 0.0 })));
        }
        Residual { C, C_t: -rate }
    }

    fn scale(&self, extent: f64) -> f64 {
        extent * self.terms.iter().fold(0.0, |most: f64, (_, weight)| most.max(weight.abs()))
    }

    /// C is linear.
    fn curvature_bound<const D: usize>(&self, _: Motion<'_, D>) -> Option<f64> {
        Some(0.0)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        for (term, (_, weight)) in self.terms.iter().enumerate() {
            finite("a weight", *weight)?;
            if *weight == 0.0 {
                return Err(ConstraintError::NoWeight { term });
            }
        }
        if let Some(term) = first_repeated(self.terms.iter().map(|(particle, _)| *particle)) {
            return Err(ConstraintError::TwoWeights { term });
        }
        if self.terms.is_empty() {
            return Err(ConstraintError::NoTerms);
        }
        self.point.iter().try_for_each(|point| Ok(point.check("the point of a relation")?))
    }
}
