//! Nail: one particle stays at the point p.
//!
//! vector form (default), d rows, [C] = m, λ in N is the force of the nail on the particle:
//!
//! ```text
//! C = x − p,   Ċ = v,   J = I,   γ = 0
//! ```
//!
//! scalar form (as in the source), one row, [C] = m², λ in N/m:
//!
//! ```text
//! C = |x − p|²,   Ċ = 2 v·(x − p),   J = 2 (x − p)ᵀ,   γ = 2 v·v,   ∂²C/∂x² = 2 I
//! ```
//!
//! The scalar form fails exactly where C = 0: at x = p its J is zero, so A has a zero row and no λ can carry the
//! particle. This is why the source needed a drag on the diagonal.

use super::{ConstraintError, Formulation, Holds, Relation, RowWriter};
use crate::allowed::all_finite;
use crate::driven::Driven;
use crate::linalg::block::diagonal;
use crate::point::{Motion, Vector, dot, first, minus, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// The function of x − p that is held at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NailForm {
    /// C = x − p \[m\], d rows.
    #[default]
    Vector,
    /// C = |x − p|² \[m²\], one row, the form of the source.
    Scalar,
}

/// One particle at a fixed point.
#[derive(Clone, Debug, PartialEq)]
pub struct Nail {
    /// The particle that is held.
    pub particle: ParticleId,
    /// p \[m\]; the third component is ignored in two dimensions.
    pub at: [f64; 3],
    /// The function that is held at zero.
    pub form: NailForm,
}

impl Nail {
    /// A nail at p \[m\] in the vector form.
    pub fn new(particle: ParticleId, at: impl Into<Vector>) -> Self {
        Nail { particle, at: at.into().0, form: NailForm::Vector }
    }

    /// A nail that moves: a [`Relation`] of the particle to the point p(t) \[m\], each component a number or a function
    /// of t; the third is ignored in two dimensions.
    ///
    /// ```
    /// use qhat::{Dimension, Driven, Nail, Particle, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let hand = builder.particle(Particle::at("hand", [0.0, 0.0]));
    /// let shaken = [Driven::text("sin(6*t)/10")?, 0.0.into(), 0.0.into()];
    /// builder.constraint("hand", Nail::driven(hand, shaken));
    /// # Ok::<(), qhat::ExpressionError>(())
    /// ```
    pub fn driven(particle: ParticleId, point: [Driven; 3]) -> Relation {
        Relation::driven(particle, point)
    }
}

impl Holds for Nail {
    fn row_count(&self, dimension: usize) -> usize {
        match self.form {
            NailForm::Vector => dimension,
            NailForm::Scalar => 1,
        }
    }

    fn is_vector(&self) -> bool {
        self.form == NailForm::Vector
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.particle]
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        let away = minus(motion.x(self.particle), first::<D>(&self.at));
        let v = motion.v(self.particle);
        match self.form {
            NailForm::Vector => {
                for k in 0..D {
                    let axis = std::array::from_fn(|j| if j == k { 1.0 } else { 0.0 });
                    rows.write(away[k], v[k], 0.0, [axis]);
                }
            }
            NailForm::Scalar => {
                rows.write(dot(away, away), 2.0 * dot(v, away), 2.0 * dot(v, v), [scaled(2.0, away)]);
            }
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        match self.form {
            NailForm::Vector => extent,
            NailForm::Scalar => extent * extent,
        }
    }

    fn curvature<const D: usize>(&self, _: Motion<'_, D>) -> f64 {
        match self.form {
            NailForm::Vector => 0.0,
            NailForm::Scalar => 2.0,
        }
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        _: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        match self.form {
            NailForm::Vector => {}
            NailForm::Scalar => visit(0, 0, Stiffness::Difference(diagonal(-2.0 * lambda[0]))),
        }
    }

    fn pulls_on_each(&self) -> bool {
        true
    }

    fn formulated(&self, formulation: Formulation) -> Self {
        let form = match formulation {
            Formulation::Modern => NailForm::Vector,
            Formulation::Classic => NailForm::Scalar,
        };
        Nail { form, ..self.clone() }
    }

    fn check(&self) -> Result<(), ConstraintError> {
        Ok(all_finite("the point of a nail", &self.at)?)
    }
}
