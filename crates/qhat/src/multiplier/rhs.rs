//! The right-hand side b, in its four terms (m numbers each, [C]/s²).
//!
//! ```text
//! b = −γ − J W Q − ks C − kd Ċ
//! ```

use crate::constraint::Rows;
use crate::settings::Feedback;

/// The four terms of b and their sum.
#[derive(Clone, Debug, Default)]
pub(crate) struct RightHandSide {
    /// −γ; γ is C̈ without any acceleration.
    pub(crate) bias: Vec<f64>,
    /// −J W Q; J W Q is C̈ by the applied forces.
    pub(crate) forces: Vec<f64>,
    /// −ks C.
    pub(crate) stiffness: Vec<f64>,
    /// −kd Ċ.
    pub(crate) damping: Vec<f64>,
    /// b.
    pub(crate) sum: Vec<f64>,
}

impl RightHandSide {
    pub(crate) fn new(m: usize) -> Self {
        let zeros = || vec![0.0; m];
        RightHandSide { bias: zeros(), forces: zeros(), stiffness: zeros(), damping: zeros(), sum: zeros() }
    }

    /// `WQ` is W Q, d·n numbers [m/s²].
    pub(crate) fn assemble<const D: usize>(&mut self, rows: &Rows, WQ: &[f64], feedback: &Feedback) {
        rows.J.multiply::<D>(WQ, &mut self.forces);
        for i in 0..self.sum.len() {
            self.bias[i] = -rows.gamma[i];
            self.forces[i] = -self.forces[i];
            self.stiffness[i] = -feedback.ks * rows.C[i];
            self.damping[i] = -feedback.kd * rows.Cd[i];
            self.sum[i] = self.bias[i] + self.forces[i] + self.stiffness[i] + self.damping[i];
        }
    }
}
