//! The constraint force, and the acceleration.
//!
//! ```text
//! Q̂ = s Jᵀ λ,   s = 1 − elasticity         [N], d·n numbers
//! q̈ = W (Q + Q̂)                            [m/s²]
//! ```

use crate::constraint::Jacobian;

/// Q̂ = s Jᵀ λ.
pub(crate) fn constraint_forces<const D: usize>(J: &Jacobian, lambda: &[f64], s: f64, Q_hat: &mut [f64]) {
    Q_hat.fill(0.0);
    J.add_transposed::<D>(lambda, Q_hat);
    // Mostly s = 1. A multiplication by it changes no bit, so no branch is needed.
    for force in Q_hat {
        *force *= s;
    }
}

/// q̈ += W F.
pub(crate) fn add_accelerations<const D: usize>(W: &[f64], F: &[f64], qdd: &mut [f64]) {
    for (i, &w) in W.iter().enumerate() {
        for k in i * D..(i + 1) * D {
            qdd[k] += w * F[k];
        }
    }
}

/// q̈ = W (Q + Q̂).
pub(crate) fn accelerations<const D: usize>(W: &[f64], Q: &[f64], Q_hat: &[f64], qdd: &mut [f64]) {
    for (i, &w) in W.iter().enumerate() {
        for k in i * D..(i + 1) * D {
            qdd[k] = w * (Q[k] + Q_hat[k]);
        }
    }
}
