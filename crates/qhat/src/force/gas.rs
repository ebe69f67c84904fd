//! Gas: a gas inside a closed loop in the plane or a closed mesh in space. Its pressure depends on the area or volume A
//! inside.
//!
//! ```text
//! A = Σ of the areas or volumes of the facets (pressure.rs),   p = p₀ (A₀/A)^γ,   p A^γ is constant
//! l = ln(A/A₀),   V = ∫ p dA from A to A₀ = p₀ A₀ ((A₀/A)^(γ−1) − 1)/(γ − 1) = p₀ A₀ expm1((1 − γ) l)/(γ − 1)
//!                 V = −p₀ A₀ l for γ = 1
//! F = −∂V/∂x = p ∂A/∂x
//! −∂F/∂x = −p ∂²A/∂x² + (γ p/A) (∂A/∂x)(∂A/∂x)ᵀ
//! ```
//!
//! γ = 1 is a gas at constant temperature. In space, γ = 7/5 is air and γ = 5/3 a monatomic gas, both without exchange
//! of heat. In implicit methods the last term couples every two particles of the gas, so their number is bounded. For γ
//! ≥ 1 the energy goes to infinity at A = 0, so the gas keeps A above 0. For A ≤ 0 the numbers are NaN, and an adaptive
//! method rejects the substep.

use super::pressure::Facet;
use super::{Acts, Dependence, ForceError};
use crate::allowed::positive;
use crate::linalg::block::outer;
use crate::point::{Motion, Point, add, norm};
use crate::space::{Dimension, ParticleId};
use crate::stiffness::Stiffness;

/// The largest number of particles of one gas. Every two of its particles are coupled, so memory and time grow with the
/// square of this number.
const MOST: usize = 200;

/// A gas in a closed loop of edges or a closed mesh of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Gas {
    facets: Vec<Facet>,
    /// The particles, each once.
    particles: Vec<ParticleId>,
    /// The corners of each facet, as indices into `particles`.
    corners: Vec<[usize; 3]>,
    pressure: f64,
    exponent: f64,
    content: f64,
}

impl Gas {
    /// A gas of pressure p₀ [N/m in a loop, Pa in a mesh] and exponent γ. A₀ is its area or volume at positions q
    /// \[m\], flat, d numbers for each particle. Edges must go round counter-clockwise, and triangles counter-clockwise
    /// as seen from outside. A particle without a position in q makes A₀ NaN, which the builder of the system rejects.
    pub fn new(facets: Vec<Facet>, pressure: f64, exponent: f64, dimension: Dimension, q: &[f64]) -> Self {
        let mut particles: Vec<ParticleId> = Vec::new();
        let mut corners = Vec::with_capacity(facets.len());
        for facet in &facets {
            let mut numbers = [0; 3];
            for (number, id) in numbers.iter_mut().zip(facet.corners()) {
                *number = particles.iter().position(|known| known == id).unwrap_or_else(|| {
                    particles.push(*id);
                    particles.len() - 1
                });
            }
            corners.push(numbers);
            // The builder of the system rejects a larger gas, so the search for particles may end.
            if particles.len() > MOST {
                break;
            }
        }
        let mut gas = Gas { facets, particles, corners, pressure, exponent, content: f64::NAN };
        if gas.particles.iter().all(|id| dimension.number() * (id.0 + 1) <= q.len()) {
            gas.content = match dimension {
                Dimension::Two => gas.enclosed::<2>(Motion { q, qd: q, t: 0.0 }),
                Dimension::Three => gas.enclosed::<3>(Motion { q, qd: q, t: 0.0 }),
            };
        }
        gas
    }

    /// The facets that enclose the gas.
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// A₀ [m² or m³].
    pub fn content(&self) -> f64 {
        self.content
    }

    /// `Ok` if the numbers and the facets are allowed.
    ///
    /// # Errors
    /// A number out of its range, or facets that do not close.
    pub fn check(&self) -> Result<(), ForceError> {
        positive("the pressure of a gas", self.pressure)?;
        positive("the exponent of a gas", self.exponent)?;
        if !(self.content > 0.0 && self.content.is_finite()) {
            return Err(ForceError::GasContent { content: self.content });
        }
        if self.particles.len() > MOST {
            return Err(ForceError::GasParticles { most: MOST, count: self.particles.len() });
        }
        self.facets.iter().try_for_each(Facet::check)
    }

    fn enclosed<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        self.facets.iter().map(|facet| facet.enclosed(motion)).sum()
    }

    /// p and A.
    fn pressure<const D: usize>(&self, motion: Motion<'_, D>) -> (f64, f64) {
        let A = self.enclosed(motion);
        (self.pressure * libm::pow(self.content / A, self.exponent), A)
    }

    /// ∂A/∂x of each particle.
    fn gradient<const D: usize>(&self, motion: Motion<'_, D>) -> [Point<D>; MOST] {
        let mut gradient = [[0.0; D]; MOST];
        for (facet, numbers) in self.facets.iter().zip(&self.corners) {
            let mut numbers = numbers.iter();
            facet.gradient(motion, &mut |_, share, v| {
                if let Some(&number) = numbers.next() {
                    (0..D).for_each(|k| gradient[number][k] += share * v[k]);
                }
            });
        }
        gradient
    }
}

impl Acts for Gas {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        let (p, _) = self.pressure(motion);
        for facet in &self.facets {
            facet.gradient(motion, &mut |particle, share, v| {
                add::<D>(Q, particle, std::array::from_fn(|k| share * p * v[k]));
            });
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        let l = libm::log(self.enclosed(motion) / self.content);
        let beyond = self.exponent - 1.0;
        let reduced = if beyond == 0.0 { -l } else { libm::expm1(-beyond * l) / beyond };
        self.pressure * self.content * reduced
    }

    fn power<const D: usize>(&self, _: Motion<'_, D>) -> f64 {
        0.0
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let (p, A) = self.pressure(motion);
        self.facets.iter().for_each(|facet| facet.bound(motion, p, bound));
        let gradient = self.gradient(motion);
        let all: f64 = gradient.iter().map(|g| norm(*g)).sum();
        for (&particle, g) in self.particles.iter().zip(gradient) {
            bound(particle, (self.exponent * p / A).abs() * norm(g) * all, 0.0);
        }
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        _: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        let (p, A) = self.pressure(motion);
        self.facets.iter().for_each(|facet| facet.tangent(motion, p, visit));
        let gradient = self.gradient(motion);
        for (j, &other) in self.particles.iter().enumerate() {
            for (i, &one) in self.particles[..=j].iter().enumerate() {
                visit(one, other, Stiffness::Definite(outer(self.exponent * p / A, gradient[i], gradient[j])));
            }
        }
    }

    fn particles(&self) -> Vec<ParticleId> {
        self.particles.clone()
    }

    fn check(&self) -> Result<(), ForceError> {
        self.check()
    }
}
