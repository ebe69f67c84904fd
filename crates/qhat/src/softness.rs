//! Softness of a row as other engines write it, in the letters of the equation.
//!
//! A soft row is held as
//!
//! ```text
//! (A + R) λ = −(γ + J W Q) − ks C − kd Ċ           R in the units of A, ks [1/s²], kd [1/s]
//! ```
//!
//! with the force λ. At rest under a load C = −R λ/ks: its compliance is α = R/ks. The notations of other engines say
//! the same with other letters; each function below translates one. Notations of the velocity level (ODE, the implicit
//! spring, Box2D) leave out γ, which is of the order of their own error. XPBD takes the next step's linearisation
//! instead.
//!
//! | elsewhere | R | ks | kd |
//! |---|---|---|---|
//! | diagonal drag ε | ε | ks | kd |
//! | elasticity, s on Q̂ | (1/s − 1) A, with s λ applied | ks | kd |
//! | ODE's ERP and CFM | CFM/h | ERP/h² | 1/h |
//! | implicit spring k, c | 1/(h (h k + c)) | k/(h (h k + c)) | 1/h |
//! | Box2D's f, ζ; ω = 2π f | A_ii/(h ω (2 ζ + h ω)) | ω/(h (2 ζ + h ω)) | 1/h |
//! | XPBD's α | α/h² | 1/h² | 1/h |
//!
//! Sources: Smith, Open Dynamics Engine User Guide (ERP, CFM); Catto, Soft Constraints, GDC 2011, and Box2D 3 (hertz,
//! damping ratio); Macklin, Müller, Chentanez, XPBD (2016).

/// R, ks and kd of one soft row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftRow {
    /// R [units of A, C²/(m² kg)].
    pub R: f64,
    /// ks [1/s²].
    pub ks: f64,
    /// kd [1/s].
    pub kd: f64,
}

impl SoftRow {
    /// The diagonal drag ε [units of A] of [`Feedback`](crate::Feedback) with feedback ks [1/s²] and kd [1/s].
    pub fn from_diagonal_drag(epsilon: f64, ks: f64, kd: f64) -> Self {
        SoftRow { R: epsilon, ks, kd }
    }

    /// The elasticity of [`Feedback`](crate::Feedback), in [0, 1), which scales Q̂ by s = 1 − elasticity, on a row that
    /// is coupled to no other: `diagonal` is its A_ii. The λ of this row is what is applied, s times the λ of the
    /// equation without R. (For coupled rows R is (1/s − 1) A, the whole matrix.)
    pub fn from_elasticity(elasticity: f64, diagonal: f64, ks: f64, kd: f64) -> Self {
        let s = 1.0 - elasticity;
        SoftRow { R: (1.0 / s - 1.0) * diagonal, ks, kd }
    }

    /// ODE's error reduction parameter \[1\] and constraint force mixing [C²/(m² kg) · s] at a step of h \[s\].
    pub fn from_erp_cfm(erp: f64, cfm: f64, h: f64) -> Self {
        SoftRow { R: cfm / h, ks: erp / (h * h), kd: 1.0 / h }
    }

    /// A spring of stiffness k [N/m] and damping c [N·s/m] along the row, taken at the end of a step of h \[s\]. Not
    /// both zero.
    pub fn from_implicit_spring(stiffness: f64, damping: f64, h: f64) -> Self {
        let stiff = h * (h * stiffness + damping);
        SoftRow { R: 1.0 / stiff, ks: stiffness / stiff, kd: 1.0 / h }
    }

    /// Box2D's and Rapier's natural frequency f \[Hz\] and damping ratio ζ at a substep of h \[s\], for a row whose
    /// A_ii is `diagonal`.
    pub fn from_hertz(hertz: f64, damping_ratio: f64, diagonal: f64, h: f64) -> Self {
        let omega = 2.0 * std::f64::consts::PI * hertz;
        let reach = h * (2.0 * damping_ratio + h * omega);
        SoftRow { R: diagonal / (omega * reach), ks: omega / reach, kd: 1.0 / h }
    }

    /// XPBD's compliance α [m/N for a row in m] at a step of h \[s\].
    pub fn from_xpbd(compliance: f64, h: f64) -> Self {
        SoftRow { R: compliance / (h * h), ks: 1.0 / (h * h), kd: 1.0 / h }
    }

    /// α = R/ks: how much C gives way to a load, for each unit of λ, at rest [m/N for a row in m].
    pub fn compliance(&self) -> f64 {
        self.R / self.ks
    }

    /// λ of a row on its own (A_ii = `diagonal`) for its γ, J W Q, C and Ċ.
    pub fn multiplier(&self, diagonal: f64, gamma: f64, JWQ: f64, C: f64, Cd: f64) -> f64 {
        -(gamma + JWQ + self.ks * C + self.kd * Cd) / (diagonal + self.R)
    }
}
