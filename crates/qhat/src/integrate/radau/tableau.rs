//! The coefficients of Radau IIA with three stages, and of its error estimate.
//!
//! The stages are those of collocation at c₁, c₂ and c₃ = 1, so that the last stage is the end of the step. A⁻¹ has one
//! real eigenvalue and two that are conjugate:
//!
//! ```text
//! T⁻¹ A⁻¹ T = [γ 0 0; 0 α β; 0 −β α]
//! ```
//!
//! so the three coupled stages fall into one real system and one complex one, of w₂ + i w₃ and α − i β.
//! Source: Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8. A and c are rational in √6;
//! the others were computed from them to 40 digits.

use crate::linalg::Complex;

/// c.
pub(super) const C: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];

/// A; its last row is b.
pub(super) const A: [[f64; 3]; 3] = [
    [0.196_815_477_223_660_4, -0.065_535_425_850_198_39, 0.023_770_974_348_220_15],
    [0.394_424_314_739_087_3, 0.292_073_411_665_228_5, -0.041_548_752_125_997_93],
    [0.376_403_062_700_467_25, 0.512_485_826_188_421_6, 0.111_111_111_111_111_1],
];

/// T.
pub(super) const T: [[f64; 3]; 3] = [
    [0.094_438_762_488_975_24, -0.141_255_295_020_954_2, 0.030_029_194_105_147_424],
    [0.250_213_122_965_333_3, 0.204_129_352_293_799_94, -0.382_942_112_757_261_9],
    [1.0, 1.0, 0.0],
];

/// T⁻¹.
pub(super) const T_INVERSE: [[f64; 3]; 3] = [
    [4.178_718_591_551_905, 0.327_682_820_761_062_37, 0.523_376_445_499_449_5],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_37, 0.476_623_554_500_550_44],
    [0.502_872_634_945_786_8, -2.571_926_949_855_605, 0.596_039_204_828_224_9],
];

/// γ.
pub(super) const REAL: f64 = 3.637_834_252_744_496;

/// α − i β.
pub(super) const PAIR: Complex = Complex { re: 2.681_082_873_627_752_3, im: -3.050_430_199_247_410_5 };

/// e of the error estimate (γ/h − ∂f/∂y)⁻¹ (f(y₀) + Σ e_i z_i/h).
pub(super) const ESTIMATE: [f64; 3] = [-10.048_809_399_827_416, 1.382_142_733_160_749, -0.333_333_333_333_333_3];

/// Σ_j weights_j x_j, the weights being one row of a matrix.
#[inline(always)]
pub(super) fn combine(weights: &[f64; 3], x: [f64; 3]) -> f64 {
    weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
        a.map(|row| std::array::from_fn(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
    }

    /// Entries below five, products of three terms: a few units of 1e-15.
    const CLOSE: f64 = 1e-14;

    /// B(5), C(3): the quadrature is exact for polynomials of degree 4, that of each stage of degree 2.
    #[test]
    fn the_stages_integrate_polynomials() {
        for (i, row) in A.iter().enumerate() {
            let last = if i == 2 { 5 } else { 3 };
            for power in 1..=last {
                let of = |c: f64, n: usize| (0..n).fold(1.0, |x, _| x * c);
                let sum: f64 = row.iter().zip(C).map(|(a, c)| a * of(c, power - 1)).sum();
                assert!((sum - of(C[i], power) / power as f64).abs() < CLOSE, "stage {i}, power {power}");
            }
        }
    }

    #[test]
    fn the_stages_are_separated() {
        let identity = product(&T, &T_INVERSE);
        let (alpha, beta) = (PAIR.re, -PAIR.im);
        let blocks = [[REAL, 0.0, 0.0], [0.0, alpha, beta], [0.0, -beta, alpha]];
        let one = product(&product(&product(&T, &blocks), &T_INVERSE), &A);
        for i in 0..3 {
            for j in 0..3 {
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((identity[i][j] - expected).abs() < CLOSE, "T T⁻¹, {i}{j}");
                assert!((one[i][j] - expected).abs() < CLOSE, "T Λ T⁻¹ A, {i}{j}");
            }
        }
    }

    /// f(y₀) + Σ e_i z_i/h vanishes where y is a polynomial of degree 3, and no higher: it is of order h³. Degree 1
    /// says Σ e_i c_i = −1, by which the estimate of positions has no part of q̇₀ (`stepper.rs`).
    #[test]
    fn the_estimate_is_of_third_order() {
        for power in 1..=4 {
            let of = |c: f64, n: usize| (0..n).fold(1.0, |x, _| x * c);
            let start = if power == 1 { 1.0 } else { 0.0 };
            let sum: f64 = start + ESTIMATE.iter().zip(C).map(|(e, c)| e * of(c, power)).sum::<f64>();
            assert_eq!(sum.abs() < CLOSE, power < 4, "power {power}: {sum}");
        }
    }
}
