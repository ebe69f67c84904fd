//! Bounds on the length of a substep.
//!
//! - Stability: an explicit method needs h ω < 2. Geometric stiffness |λ_i| |∂²C_i/∂q²| and the stiffness of forces
//!   bound ω by Gershgorin's theorem, ω² ≤ max_p w_p Σ (row sum of |K| at particle p); for a chain under tension T
//!   that is 4 w T/L.
//! - Turning: √(γ_i/scale_i) is the rate at which row i turns [1/s]; a substep must not turn it far.
//! - Accuracy: an error estimate grows with a power of h, h³ for RATTLE.

use crate::constraint::Holds;
use crate::force::Acts;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::system::System;

/// h ω allowed, of the 2 at which an explicit method becomes unstable.
const STABLE: f64 = 1.4;

/// Turn of a row allowed in one substep [rad].
const TURN: f64 = 0.3;

/// h times the rate of damping allowed, of the 2 at which an explicit method becomes unstable.
const DAMPED: f64 = 0.5;

/// Sums at each particle: Gershgorin's row sums of |K| [N/m], and of damping [N s/m].
#[derive(Clone, Debug)]
pub(crate) struct RowSums {
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

impl RowSums {
    pub(crate) fn new(system: &System) -> Self {
        let zeros = || vec![0.0; system.particle_count()];
        RowSums { stiffness: zeros(), damping: zeros() }
    }

    /// The longest substep that is stable and turns no row too far [s], for λ and an equation with its rows at the
    /// motion.
    pub(crate) fn longest_substep<const D: usize>(
        &mut self,
        system: &System,
        equation: &Equation,
        lambda: &[f64],
        motion: Motion<'_, D>,
    ) -> f64 {
        let RowSums { stiffness: rowsum, damping } = self;
        rowsum.fill(0.0);
        damping.fill(0.0);
        let mut turning = 0.0_f64;
        for named in &system.constraints {
            let rows = named.first_row..named.first_row + named.constraint.row_count(D);
            let sum: f64 = lambda[rows.clone()].iter().map(|multiplier| multiplier.abs()).sum();
            let particles = system.layout.start[named.first_row]..system.layout.start[named.first_row + 1];
            // As in the evaluation of rows: rods need no call.
            let curvature = match named.constraint.as_rod() {
                Some(rod) => rod.curvature(motion),
                None => match equation.rows.feet.bead(&named.constraint, named.first_row, motion.t) {
                    Some(bead) => bead.curvature(motion),
                    None => named.constraint.curvature(motion),
                },
            };
            let stiffness = sum * curvature * particles.len() as f64;
            for &particle in &system.layout.particle[particles] {
                rowsum[particle.0] += stiffness;
            }
            for row in rows {
                turning = turning.max(equation.rows.gamma[row].abs() / system.row_scale[row]);
            }
        }
        for force in system.acting_forces(&equation.broken) {
            force.stiffness(motion, &mut |particle, stiffness, damper| {
                rowsum[particle.0] += stiffness;
                damping[particle.0] += damper;
            });
        }
        let mut omega_squared = 0.0_f64;
        let mut damping_rate = 0.0_f64;
        for (i, &w) in system.inverse_mass.iter().enumerate() {
            omega_squared = omega_squared.max(w * rowsum[i]);
            damping_rate = damping_rate.max(w * damping[i]);
        }
        // A rate of zero gives an infinite limit: none.
        (STABLE / omega_squared.sqrt()).min(TURN / turning.sqrt()).min(DAMPED / damping_rate)
    }
}

/// Bounds on the rates of the applied forces [1/s]: that of an oscillation, √ of the largest w Σ |K|, and that of a
/// decay, the largest w Σ of the damping.
pub(crate) fn rates_of_forces<const D: usize>(system: &System, motion: Motion<'_, D>) -> [f64; 2] {
    // Most systems have gravity alone, which has no rate: they need no arrays.
    let mut sums: Vec<[f64; 2]> = Vec::new();
    for force in system.all_forces() {
        force.stiffness(motion, &mut |particle, stiffness, damping| {
            sums.resize(system.particle_count(), [0.0; 2]);
            sums[particle.0][0] += stiffness;
            sums[particle.0][1] += damping;
        });
    }
    let mut largest = [0.0_f64; 2];
    for (sums, w) in sums.iter().zip(&system.inverse_mass) {
        largest = [largest[0].max(w * sums[0]), largest[1].max(w * sums[1])];
    }
    [largest[0].sqrt(), largest[1]]
}

/// Part of the way to the tolerance that one change of h goes, in logarithms. Near the bound of stability an estimate
/// answers to h more steeply than its order says, and the whole way there and back costs a rejected substep each
/// time.
const PART: f64 = 0.8;

/// The factor by which to change h after an error of `error` where `tolerance` is allowed, for an estimate that grows
/// with h to the power `order`.
pub(crate) fn growth(error: f64, tolerance: f64, order: f64) -> f64 {
    // 0.92: aim a little low, a rejected substep costs a whole one. The bounds keep one odd estimate from mattering
    // long.
    (0.92 * libm::pow(tolerance / error, PART / order)).clamp(0.2, 2.0)
}
