//! CustomForce: a force with a potential V(q, t) [J] that the user writes in Rust, without derivatives.
//!
//! ```text
//! F_i = −∂V/∂x_i,   −∂F_i/∂x_j = ∂²V/∂x_i∂x_j         (hyper/derivatives.rs)
//! d(T + V)/dt = ∂V/∂t, the power of an agent that changes V with time     [W]
//! ```
//!
//! The sign of the stiffness is not known. Where V or a derivative is not finite, the step ends in `StepError`.

use super::expression::{largest, sum_of_sizes};
use super::{Acts, Dependence, ForceError};
use crate::hyper::{Hyper, gradient, hessian_blocks, jet};
use crate::linalg::block::{Block, transposed};
use crate::point::{Motion, add};
use crate::space::{ParticleId, first_repeated};
use crate::stiffness::Stiffness;
use std::fmt;
use std::sync::Arc;

/// A potential energy V(q, t) written by a user, for [`CustomForce`]: the formula alone, without any derivative.
///
/// Closures with the same arguments implement this trait. [`CustomForce`] has an example.
pub trait CustomPotential: Send + Sync {
    /// V(q, t) \[J\]. `x` has the positions \[m\] of the particles in the order of [`CustomForce::new`], with z = 0
    /// in two dimensions; `t` is the time \[s\].
    ///
    /// V must be smooth and must depend on `x` and `t` alone: the same arguments give the same V. A function that uses
    /// only operations of [`Hyper`] gives the same bits on every target. A V that is not finite ends the step in an
    /// error.
    fn potential(&self, x: &[[Hyper; 3]], t: Hyper) -> Hyper;
}

impl<F: Fn(&[[Hyper; 3]], Hyper) -> Hyper + Send + Sync> CustomPotential for F {
    fn potential(&self, x: &[[Hyper; 3]], t: Hyper) -> Hyper {
        self(x, t)
    }
}

/// A force with a potential written by the user: F = −∂V/∂x on each particle.
///
/// Two custom forces are equal if they share the potential (as clones do) and have the same particles. Threads share
/// the potential, so it must be `Send + Sync`.
///
/// A bead on a spiral wire r = a θ, and a potential well that pulls the bead to the middle:
///
/// ```
/// use qhat::{Custom, CustomForce, CustomPotential, Dimension, Hyper, Particle, Settings, Simulation, System};
///
/// /// V = −depth exp(−r²/(2 width²)).
/// struct Well {
///     depth: f64,
///     width: f64,
/// }
///
/// impl CustomPotential for Well {
///     fn potential(&self, x: &[[Hyper; 3]], _t: Hyper) -> Hyper {
///         let [x, y, _] = x[0];
///         -self.depth * (-(x * x + y * y) / (2.0 * self.width * self.width)).exp()
///     }
/// }
///
/// let mut builder = System::builder(Dimension::Two);
/// let bead = builder.particle(Particle::at("bead", [2.0 * 20.0_f64.cos(), 2.0 * 20.0_f64.sin()]));
/// let spiral = |x: &[[Hyper; 3]], _: Hyper| {
///     let ([x, y, _], a) = (x[0], 0.1);
///     let r = x.hypot(y);
///     a * (x * (r / a).sin() - y * (r / a).cos()) / r
/// };
/// builder.constraint("spiral", Custom::new([bead], spiral));
/// builder.force(CustomForce::new([bead], Well { depth: 5.0, width: 1.0 }));
/// let (system, state) = builder.build()?;
///
/// let mut simulation = Simulation::new(system, state, Settings { tolerance: 1e-8, ..Settings::default() })?;
/// for _ in 0..100 {
///     simulation.step()?;
/// }
/// // The potential accounts for the work of the force.
/// assert!(simulation.energy_error_max() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct CustomForce {
    particles: Arc<[ParticleId]>,
    potential: Arc<dyn CustomPotential>,
}

impl CustomForce {
    /// The force of a potential of the positions of these particles. Each particle is named once.
    pub fn new(particles: impl Into<Vec<ParticleId>>, potential: impl CustomPotential + 'static) -> Self {
        CustomForce { particles: particles.into().into(), potential: Arc::new(potential) }
    }

    fn V(&self) -> impl Fn(&[[Hyper; 3]], Hyper) -> Hyper {
        |x: &[[Hyper; 3]], t: Hyper| self.potential.potential(x, t)
    }
}

impl PartialEq for CustomForce {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.potential, &other.potential) && self.particles == other.particles
    }
}

impl fmt::Debug for CustomForce {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CustomForce").field("particles", &self.particles).finish_non_exhaustive()
    }
}

impl Acts for CustomForce {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        let (slopes, _) = gradient(self.V(), &self.particles, motion);
        for (g, &particle) in slopes.chunks_exact(D).zip(self.particles.iter()) {
            add(Q, particle, std::array::from_fn::<f64, D, _>(|k| -g[k]));
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        let [V, ..] = jet(self.V(), &self.particles, motion);
        V
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        gradient(self.V(), &self.particles, motion).1
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let mut sums = vec![[0.0; D]; self.particles.len()];
        hessian_blocks(self.V(), &self.particles, motion, &mut |i, j, block: Block<D>| {
            for k in 0..D {
                sums[i][k] += sum_of_sizes(block[k]);
                if i != j {
                    sums[j][k] += sum_of_sizes(transposed(&block)[k]);
                }
            }
        });
        for (&particle, sum) in self.particles.iter().zip(sums) {
            bound(particle, largest(sum), 0.0);
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
        hessian_blocks(self.V(), &self.particles, motion, &mut |i, j, block: Block<D>| {
            visit(self.particles[i], self.particles[j], Stiffness::Indefinite(block));
        });
    }

    fn particles(&self) -> Vec<ParticleId> {
        self.particles.to_vec()
    }

    fn check(&self) -> Result<(), ForceError> {
        let named = &self.particles;
        if named.is_empty() {
            return Err(ForceError::CustomWithoutParticles);
        }
        match first_repeated(named.iter().copied()).is_some() {
            true => Err(ForceError::NamedTwice { what: "a custom force" }),
            false => Ok(()),
        }
    }
}
