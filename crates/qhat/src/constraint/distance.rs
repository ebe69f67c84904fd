//! Distance: two particles a and b stay r apart. A rod.
//!
//! ```text
//! d = x_a − x_b,   n = d/|d|,   u = v_a − v_b
//! ```
//!
//! length form (default), \[C\] = m, λ in N, tension = −λ:
//!
//! ```text
//! C  = |d| − r
//! Ċ  = n·u
//! J  = nᵀ on a, −nᵀ on b
//! γ  = (u·u − (n·u)²)/|d|        since C̈ = n·u̇ + ṅ·u and ṅ = (u − n (n·u))/|d|
//! ∂²C/∂x² = (I − nnᵀ)/|d| on aa and bb, its negative on ab;  its norm is 1/|d|
//! ```
//!
//! squared form (as in the source, where the −r² is missing), \[C\] = m², λ in N/m, tension = −2|d|λ:
//!
//! ```text
//! C  = d·d − r²
//! Ċ  = 2 d·u
//! J  = 2dᵀ on a, −2dᵀ on b
//! γ  = 2 u·u
//! ∂²C/∂x² = 2 I on aa and bb, −2 I on ab
//! ```
//!
//! A rod of compliance α [m/N] and damping c [N·s/m] is soft: C + α λ + α c Ċ = 0 in the length form, so that at rest
//! it is longer by α T. α = 0 is rigid. Implicit methods, which solve for the end of the step, solve this row with the
//! others. For all other methods the soft rod is a spring of stiffness 1/α with a damper c in parallel, and A has no
//! active row for it. λ and tension mean the same for all methods.
//!
//! A soft rod breaks as a rigid one does, by its tension, that of the damper included. The energy C²/2α that it held
//! leaves with it, and is booked as dissipated.
//!
//! EA \[N\], the `stiffness` of a rod, acts only where redundant rods share a force: a rod takes part in the share as
//! if it stretched by T L/EA (`multiplier/share/`). The motion does not depend on it.
//!
//! Fails at |d| = 0. The length form has no direction there and takes the first axis with γ = 0 (any unit vector is a
//! subgradient of |d| at 0), so that a projection can still pull the ends apart. The J of the squared form vanishes.
//!
//! Source: the seed report, "Constraint Used"; Witkin, Gleicher, Welch, Interactive Dynamics (1990).

use super::{ConstraintError, Formulation, Holds, OnSphere, RowWriter, Softness};
use crate::allowed::{check_impulse, check_strength, not_negative, positive};
use crate::driven::Driven;
use crate::force::{Force, Spring};
use crate::linalg::block::{diagonal, outer, plus};
use crate::point::{Motion, dot, first_axis, minus, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// The function of the distance that is held at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DistanceForm {
    /// C = |d| − r \[m\].
    #[default]
    Length,
    /// C = d·d − r² \[m²\], the form of the source.
    Squared,
}

/// Two particles at a fixed distance: a rod.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// r \[m\], positive.
    pub length: f64,
    /// The function that is held at zero.
    pub form: DistanceForm,
    /// α [m/N], not negative; 0 is rigid.
    pub compliance: f64,
    /// c [N·s/m], not negative: a damper parallel to the compliance. It has no effect on a rigid rod.
    pub damping: f64,
    /// The tension or thrust at which the rod breaks \[N\].
    pub breaks_at: Option<f64>,
    /// The impulse of a blow at which the rod breaks \[N·s\]; `None` for a rod of a compliance, which takes no blow.
    pub breaks_at_impulse: Option<f64>,
    /// EA \[N\], positive; 1 unless given. It only weighs how redundant rods share a force.
    pub stiffness: f64,
}

impl Distance {
    /// A rod of the given length \[m\] in the length form.
    pub fn new(a: ParticleId, b: ParticleId, length: f64) -> Self {
        Distance {
            a,
            b,
            length,
            form: DistanceForm::Length,
            compliance: 0.0,
            damping: 0.0,
            breaks_at: None,
            breaks_at_impulse: None,
            stiffness: 1.0,
        }
    }

    /// A rod whose length is driven \[m\], a number or a function of t: an [`OnSphere`] about the particle `b`. It is
    /// no link; its tension is minus its reaction.
    ///
    /// ```
    /// use qhat::{Dimension, Distance, Driven, Particle, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let [wall, load] = [0.0, 2.0].map(|x| builder.particle(Particle::at(format!("{x}"), [x, 0.0])));
    /// let winch = builder.constraint("winch", Distance::driven(load, wall, Driven::text("2 - t/10")?));
    /// # Ok::<(), qhat::ExpressionError>(())
    /// ```
    pub fn driven(a: ParticleId, b: ParticleId, length: impl Into<Driven>) -> OnSphere {
        OnSphere::new(a, b, length)
    }

    /// The same rod, with the tension or thrust at which it breaks \[N\].
    pub fn breaking_at(self, tension: f64) -> Self {
        Distance { breaks_at: Some(tension), ..self }
    }

    /// The same rod, with the impulse of a blow \[N·s\] at which it breaks.
    pub fn breaking_at_impulse(self, impulse: f64) -> Self {
        Distance { breaks_at_impulse: Some(impulse), ..self }
    }

    /// The same rod with the stiffness EA \[N\] by which it shares a force with redundant rods.
    ///
    /// ```
    /// use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    /// let load = builder.particle(Particle::at("load", [0.0, -1.0]).with_mass(4.0));
    /// builder.constraint("thin", Distance::new(hook, load, 1.0));
    /// builder.constraint("thick", Distance::new(hook, load, 1.0).with_stiffness(3.0));
    /// builder.force(Gravity { acceleration: [0.0, -10.0, 0.0] });
    /// let (system, state) = builder.build()?;
    /// let tension = Simulation::new(system, state, Settings::default())?.tension(); // 40 N, one to three
    /// assert!((tension[0] - 10.0).abs() < 1e-12 && (tension[1] - 30.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_stiffness(self, stiffness: f64) -> Self {
        Distance { stiffness, ..self }
    }

    /// The same rod with a compliance [m/N] and a damping [N·s/m].
    pub fn with_compliance(self, compliance: f64, damping: f64) -> Self {
        Distance { compliance, damping, ..self }
    }

    /// Signed tension \[N\] of a multiplier of this row, positive where the rod pulls its ends together.
    pub(crate) fn tension<const D: usize>(&self, motion: Motion<'_, D>, lambda: f64) -> f64 {
        match self.form {
            DistanceForm::Length => -lambda,
            DistanceForm::Squared => -2.0 * norm(minus(motion.x(self.a), motion.x(self.b))) * lambda,
        }
    }
}

impl Holds for Distance {
    fn row_count(&self, _: usize) -> usize {
        1
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b]
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        let d = minus(motion.x(self.a), motion.x(self.b));
        let u = minus(motion.v(self.a), motion.v(self.b));
        let r = self.length;
        match self.form {
            DistanceForm::Length => {
                let length = norm(d);
                let n = if length > 0.0 { scaled(1.0 / length, d) } else { first_axis() };
                let C = length - r;
                let Cd = dot(n, u);
                let gamma = if length > 0.0 { (dot(u, u) - Cd * Cd) / length } else { 0.0 };
                rows.write(C, Cd, gamma, [n, scaled(-1.0, n)]);
            }
            DistanceForm::Squared => {
                let C = dot(d, d) - r * r;
                let Cd = 2.0 * dot(d, u);
                let gamma = 2.0 * dot(u, u);
                rows.write(C, Cd, gamma, [scaled(2.0, d), scaled(-2.0, d)]);
            }
        }
    }

    fn scale(&self, _: f64) -> f64 {
        let r = self.length;
        match self.form {
            DistanceForm::Length => r,
            DistanceForm::Squared => 2.0 * r * r, // d·d − r² = 2r (|d| − r) + O((|d| − r)²)
        }
    }

    fn softness(&self) -> Softness {
        Softness { compliance: self.compliance, damping: self.damping }
    }

    fn flexibility(&self, _: usize, _: f64) -> f64 {
        self.length / self.stiffness
    }

    fn breaks_at(&self) -> Option<f64> {
        self.breaks_at
    }

    fn breaks_at_impulse(&self) -> Option<f64> {
        self.breaks_at_impulse
    }

    fn as_force(&self) -> Option<Force> {
        let Distance { a, b, length, compliance, damping, .. } = *self;
        (compliance > 0.0).then(|| Spring { a, b, stiffness: 1.0 / compliance, damping, rest: length }.into())
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        match self.form {
            DistanceForm::Length => {
                let length = norm(minus(motion.x(self.a), motion.x(self.b)));
                if length > 0.0 { 1.0 / length } else { 0.0 }
            }
            DistanceForm::Squared => 2.0,
        }
    }

    #[inline(always)]
    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        match self.form {
            DistanceForm::Length => {
                let d = minus(motion.x(self.a), motion.x(self.b));
                let length = norm(d);
                if length > 0.0 {
                    let n = scaled(1.0 / length, d);
                    let stiffness = -lambda[0] / length;
                    visit(0, 1, Stiffness::Difference(plus(diagonal(stiffness), -stiffness, outer(1.0, n, n))));
                }
            }
            DistanceForm::Squared => visit(0, 1, Stiffness::Difference(diagonal(-2.0 * lambda[0]))),
        }
    }

    fn pulls_on_each(&self) -> bool {
        true
    }

    fn formulated(&self, formulation: Formulation) -> Self {
        let form = match formulation {
            Formulation::Modern => DistanceForm::Length,
            // A soft rod is a spring in every formulation.
            Formulation::Classic if self.compliance > 0.0 => DistanceForm::Length,
            Formulation::Classic => DistanceForm::Squared,
        };
        Distance { form, ..self.clone() }
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if self.a == self.b {
            return Err(ConstraintError::SameEnds { what: "a distance constraint" });
        }
        positive("the length of a distance constraint", self.length)?;
        not_negative("the compliance of a distance constraint", self.compliance)?;
        not_negative("the damping of a distance constraint", self.damping)?;
        positive("the stiffness of a distance constraint", self.stiffness)?;
        if self.compliance > 0.0 && !(1.0 / self.compliance).is_finite() {
            return Err(ConstraintError::ComplianceTooSmall { compliance: self.compliance });
        }
        if self.compliance > 0.0 && self.form == DistanceForm::Squared {
            return Err(ConstraintError::ComplianceInSquaredForm);
        }
        if self.breaks_at_impulse.is_some() && self.compliance > 0.0 {
            return Err(ConstraintError::ComplianceTakesNoBlow);
        }
        check_impulse(self.breaks_at_impulse)?;
        Ok(check_strength(self.breaks_at)?)
    }
}
