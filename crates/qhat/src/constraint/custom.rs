//! Custom: a constraint C(q, t) = 0 of which the user writes C in Rust, without derivatives; one row. The user chooses
//! the unit [C].
//!
//! ```text
//! C, Ċ, γ          from one call along (q̇, 1)                 (hyper/derivatives.rs)
//! J and C_t        two numbers a call
//! −λ ∂²C/∂q²       one call for each pair of coordinates; its sign is not known
//! ```
//!
//! A user with several residuals adds several constraints, so that each row has its own particles and its own scale.
//!
//! Fails where C or a derivative is not finite. The whole row becomes NaN where C itself is not finite, because a
//! derivative may still have a value there. No method then mistakes the row for zero, and the step ends in `StepError`.

use super::anchor::check_different;
use super::expression::size;
use super::{ConstraintError, Formulation, Holds, RowWriter};
use crate::hyper::{Hyper, gradient, hessian_blocks, jet};
use crate::linalg::block::Block;
use crate::point::{Motion, Point};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;
use std::fmt;
use std::sync::Arc;

/// A residual C(q, t) written by a user, for [`Custom`] to hold at zero: the formula alone, without any derivative.
///
/// Closures with the same arguments implement this trait. [`Custom`] has an example of both.
pub trait CustomConstraint: Send + Sync {
    /// C(q, t) in a unit of the user's choice, in metres if [`Custom`] gets no scale. `x` has the positions \[m\] of
    /// the particles in the order of [`Custom::new`], with z = 0 in two dimensions; `t` is the time \[s\].
    ///
    /// C must be smooth and must depend on `x` and `t` alone: the same arguments give the same C. A function that uses
    /// only operations of [`Hyper`] gives the same bits on every target. A C that is not finite ends the step in an
    /// error.
    fn residual(&self, x: &[[Hyper; 3]], t: Hyper) -> Hyper;
}

impl<F: Fn(&[[Hyper; 3]], Hyper) -> Hyper + Send + Sync> CustomConstraint for F {
    fn residual(&self, x: &[[Hyper; 3]], t: Hyper) -> Hyper {
        self(x, t)
    }
}

/// A constraint with a residual written by the user. The residual is held at zero as exactly as for the built-in kinds.
///
/// Two custom constraints are equal if they share the residual (as clones do) and have the same particles and scale.
/// Threads share the residual, so it must be `Send + Sync`.
///
/// A bead on the spiral r = a θ, on any of its turns:
///
/// ```
/// use qhat::{Custom, CustomConstraint, Dimension, Gravity, Hyper, Particle, Settings, Simulation, System};
///
/// /// C = a sin(r/a − φ) with the polar angle φ of the bead [m]; its gradient has about unit length.
/// struct Spiral {
///     a: f64,
/// }
///
/// impl CustomConstraint for Spiral {
///     fn residual(&self, x: &[[Hyper; 3]], _t: Hyper) -> Hyper {
///         let [x, y, _] = x[0];
///         let r = x.hypot(y);
///         // sin φ = y/r and cos φ = x/r.
///         self.a * (x * (r / self.a).sin() - y * (r / self.a).cos()) / r
///     }
/// }
///
/// let mut builder = System::builder(Dimension::Two);
/// let bead = builder.particle(Particle::at("bead", [2.0 * 20.0_f64.cos(), 2.0 * 20.0_f64.sin()]));
/// builder.constraint("spiral", Custom::new([bead], Spiral { a: 0.1 }));
/// // A closure names the types of its arguments. This closure keeps a second bead at the distance 1 + 0.1 sin t.
/// let other = builder.particle(Particle::at("other", [2.0 * 20.0_f64.cos() + 1.0, 2.0 * 20.0_f64.sin()]));
/// let tie = |x: &[[Hyper; 3]], t: Hyper| (x[1][0] - x[0][0]).hypot(x[1][1] - x[0][1]) - (1.0 + 0.1 * t.sin());
/// builder.constraint("tie", Custom::new([bead, other], tie));
/// builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
/// let (system, state) = builder.build()?;
///
/// let mut simulation = Simulation::new(system, state, Settings::default())?;
/// for _ in 0..100 {
///     assert!(simulation.step()?.max_residual < 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Custom {
    particles: Arc<[ParticleId]>,
    residual: Arc<dyn CustomConstraint>,
    /// The scale [C], if one was given.
    scale: Option<f64>,
}

impl Custom {
    /// A constraint that holds a residual of the positions of these particles at zero. Each particle is named once. C
    /// is a length \[m\] unless a scale is given.
    pub fn new(particles: impl Into<Vec<ParticleId>>, residual: impl CustomConstraint + 'static) -> Self {
        Custom { particles: particles.into().into(), residual: Arc::new(residual), scale: None }
    }

    /// The same constraint with a scale \[C\], above 0: the |C| that counts as a relative error of one. Without it
    /// the scale is the size of the system \[m\].
    pub fn with_scale(self, scale: f64) -> Self {
        Custom { scale: Some(scale), ..self }
    }

    fn C(&self) -> impl Fn(&[[Hyper; 3]], Hyper) -> Hyper {
        |x: &[[Hyper; 3]], t: Hyper| self.residual.residual(x, t)
    }
}

impl PartialEq for Custom {
    fn eq(&self, other: &Self) -> bool {
        let shared = Arc::ptr_eq(&self.residual, &other.residual);
        shared && self.particles == other.particles && self.scale == other.scale
    }
}

impl fmt::Debug for Custom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Custom").field("particles", &self.particles).field("scale", &self.scale).finish_non_exhaustive()
    }
}

impl Holds for Custom {
    fn row_count(&self, _: usize) -> usize {
        1
    }

    fn particles(&self) -> Vec<ParticleId> {
        self.particles.to_vec()
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        let [C, Cd, gamma] = jet(self.C(), &self.particles, motion);
        let (J, Ct) = gradient(self.C(), &self.particles, motion);
        // Where C has no value, its derivative may still have a value: 1/x, the derivative of ln x, at −1.
        let lost = if C.is_finite() { 0.0 } else { f64::NAN };
        let blocks = J.chunks_exact(D).map(|g| -> Point<D> { std::array::from_fn(|k| g[k] + lost) });
        rows.write_driven(C + lost, Cd + lost, gamma + lost, Ct + lost, blocks);
    }

    fn scale(&self, extent: f64) -> f64 {
        self.scale.unwrap_or(extent)
    }

    fn may_jump(&self) -> bool {
        true
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let mut largest = 0.0_f64;
        hessian_blocks(self.C(), &self.particles, motion, &mut |_, _, block: Block<D>| {
            largest = largest.max(size(&block))
        });
        largest
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        hessian_blocks(self.C(), &self.particles, motion, &mut |i, j, block: Block<D>| {
            visit(i, j, Stiffness::Indefinite(block.map(|row| row.map(|entry| -lambda[0] * entry))));
        });
    }

    /// The engine does not know where the gradient of the user's residual vanishes.
    fn pulls_on_each(&self) -> bool {
        false
    }

    /// The residual of a user has one form only.
    fn formulated(&self, _: Formulation) -> Self {
        self.clone()
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if self.particles.is_empty() {
            return Err(ConstraintError::CustomWithoutParticles);
        }
        check_different(self.particles.iter().copied(), "a custom constraint")?;
        match self.scale {
            Some(scale) if !(scale.is_finite() && scale > 0.0) => Err(ConstraintError::Scale { scale }),
            _ => Ok(()),
        }
    }
}
