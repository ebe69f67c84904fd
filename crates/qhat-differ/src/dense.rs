//! Dense linear algebra of the reference: the singular value decomposition by one-sided Jacobi rotations.
//!
//! ```text
//! B = V Σ Uᵀ,    the rotations make the rows of VᵀB orthogonal; their lengths are σ, their directions uᵀ
//! B⁺ c = U Σ⁻¹ Vᵀ c over the largest r singular values: the least-norm solution of B y = c
//! ```
//!
//! Source: Hestenes, Inversion of matrices by biorthogonalization (1958); Demmel, Veselić, Jacobi's method is more
//! accurate than QR (1992).

/// The cosine between two rows below which they count as orthogonal [1]: some roundoffs of a dot product.
const ORTHOGONAL: f64 = 4e-16;
/// The length of a row, relative to the largest, below which it is roundoff and is not rotated [1]. More rows than
/// dimensions leave rows of roundoff, which can never be orthogonal to each other.
const ROUNDOFF: f64 = 1e-15;
/// The most sweeps over all pairs of rows; a matrix of 40 rows needs about eight.
const SWEEPS: usize = 60;

/// A singular value decomposition of a matrix of m rows and N columns.
#[derive(Clone, Debug)]
pub struct Svd {
    /// σ, m numbers, falling.
    pub values: Vec<f64>,
    /// σ uᵀ, m rows of N numbers.
    scaled: Vec<Vec<f64>>,
    /// Vᵀ, m rows of m numbers.
    turned: Vec<Vec<f64>>,
}

/// The scalar product of two vectors of equal length.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The Euclidean length of a vector.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// The largest size of an entry; NaN where an entry is NaN.
pub fn largest(a: &[f64]) -> f64 {
    // NaN is larger than no number, and stays once it is there.
    a.iter().fold(0.0, |most, entry| if entry.abs() <= most { most } else { entry.abs() + 0.0 * most })
}

impl Svd {
    /// Decomposes a matrix that is given by its rows.
    pub fn new(rows: &[Vec<f64>]) -> Self {
        let m = rows.len();
        let mut scaled = rows.to_vec();
        let mut turned: Vec<Vec<f64>> =
            (0..m).map(|i| (0..m).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
        let mut squares: Vec<f64> = scaled.iter().map(|row| dot(row, row)).collect();
        for _ in 0..SWEEPS {
            let small = ROUNDOFF * ROUNDOFF * squares.iter().fold(0.0, |most: f64, square| most.max(*square));
            let mut rotated = false;
            for i in 0..m {
                for j in i + 1..m {
                    let (a, b) = (squares[i], squares[j]);
                    if a <= small || b <= small {
                        continue;
                    }
                    let product = dot(&scaled[i], &scaled[j]);
                    if product.abs() <= ORTHOGONAL * (a * b).sqrt() {
                        continue;
                    }
                    rotated = true;
                    // The smaller angle that makes the two rows orthogonal: t² + 2 ζ t − 1 = 0.
                    let zeta = (b - a) / (2.0 * product);
                    let tangent = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                    let sine = tangent * cosine;
                    rotate(&mut scaled, i, j, cosine, sine);
                    rotate(&mut turned, i, j, cosine, sine);
                    squares[i] = dot(&scaled[i], &scaled[i]);
                    squares[j] = dot(&scaled[j], &scaled[j]);
                }
            }
            if !rotated {
                break;
            }
        }
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&i, &j| squares[j].total_cmp(&squares[i]));
        Svd {
            values: order.iter().map(|&i| squares[i].sqrt()).collect(),
            scaled: order.iter().map(|&i| std::mem::take(&mut scaled[i])).collect(),
            turned: order.iter().map(|&i| std::mem::take(&mut turned[i])).collect(),
        }
    }

    /// The number of singular values above a part of the largest one.
    pub fn rank(&self, threshold: f64) -> usize {
        let largest = self.values.first().copied().unwrap_or(0.0);
        self.values.iter().filter(|&&value| value > threshold * largest).count()
    }

    /// B⁺ c with the largest `rank` singular values; `columns` numbers.
    pub fn solve(&self, rank: usize, c: &[f64], columns: usize) -> Vec<f64> {
        let mut y = vec![0.0; columns];
        for k in 0..rank.min(self.values.len()) {
            let factor = dot(&self.turned[k], c) / (self.values[k] * self.values[k]);
            for (entry, u) in y.iter_mut().zip(&self.scaled[k]) {
                *entry += factor * u;
            }
        }
        y
    }
}

/// Turns rows i < j of a matrix in their plane.
fn rotate(rows: &mut [Vec<f64>], i: usize, j: usize, cosine: f64, sine: f64) {
    let (head, tail) = rows.split_at_mut(j);
    for (a, b) in head[i].iter_mut().zip(&mut tail[0]) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
}
