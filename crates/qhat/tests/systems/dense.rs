//! Textbook dense algebra on flat row-major arrays: slow, short, and written apart from the engine.

/// y = A x; A has `x.len()` columns.
pub fn multiply(a: &[f64], x: &[f64]) -> Vec<f64> {
    a.chunks_exact(x.len()).map(|row| dot(row, x)).collect()
}

/// y = Aᵀ x; A has `columns` columns and `x.len()` rows.
pub fn multiply_transposed(a: &[f64], columns: usize, x: &[f64]) -> Vec<f64> {
    (0..columns).map(|j| x.iter().enumerate().map(|(i, x)| a[i * columns + j] * x).sum()).collect()
}

/// J W Jᵀ for W given as one number for each coordinate.
pub fn sandwich(j: &[f64], w: &[f64]) -> Vec<f64> {
    let rows: Vec<&[f64]> = j.chunks_exact(w.len()).collect();
    let entry = |a: &[f64], b: &[f64]| (0..w.len()).map(|k| a[k] * w[k] * b[k]).sum();
    rows.iter().flat_map(|a| rows.iter().map(move |b| entry(a, b))).collect()
}

/// Gaussian elimination with partial pivoting; `None` if a pivot is zero.
pub fn solve(mut a: Vec<f64>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs()))?;
        if a[pivot * n + k] == 0.0 {
            return None;
        }
        for j in 0..n {
            a.swap(k * n + j, pivot * n + j);
        }
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            for j in k..n {
                a[i * n + j] -= factor * a[k * n + j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k * n + j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k * n + k];
    }
    Some(b)
}

/// Eigenvalues of a symmetric matrix of n rows and, in the same order, its eigenvectors of length 1, by Jacobi's
/// method: rotations in the plane of two coordinates, each of which makes one entry beside the diagonal zero, until all
/// are zero. Slow; the error of every eigenvalue is some ε of the largest entry.
pub fn eigen(mut a: Vec<f64>, n: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    assert_eq!(a.len(), n * n);
    let rotated = |x: f64, y: f64, (cosine, sine): (f64, f64)| (cosine * x - sine * y, sine * x + cosine * y);
    let mut vectors = vec![vec![0.0; n]; n];
    (0..n).for_each(|k| vectors[k][k] = 1.0);
    let pairs = || (0..n).flat_map(move |p| (p + 1..n).map(move |q| (p, q)));
    let roundoff = f64::EPSILON * largest(&a);
    // Convergence is quadratic: matrices of some hundred rows take about ten sweeps.
    for _ in 0..50 {
        if pairs().all(|(p, q)| a[p * n + q].abs() <= roundoff) {
            return ((0..n).map(|k| a[k * n + k]).collect(), vectors);
        }
        for (p, q) in pairs().collect::<Vec<_>>() {
            if a[p * n + q] == 0.0 {
                continue;
            }
            let slope = (a[q * n + q] - a[p * n + p]) / (2.0 * a[p * n + q]);
            let tangent = 1.0_f64.copysign(slope) / (slope.abs() + libm::hypot(slope, 1.0));
            let cosine = 1.0 / libm::hypot(tangent, 1.0);
            let turn = (cosine, cosine * tangent);
            for k in 0..n {
                (a[k * n + p], a[k * n + q]) = rotated(a[k * n + p], a[k * n + q], turn);
            }
            for k in 0..n {
                (a[p * n + k], a[q * n + k]) = rotated(a[p * n + k], a[q * n + k], turn);
                (vectors[p][k], vectors[q][k]) = rotated(vectors[p][k], vectors[q][k], turn);
            }
        }
    }
    panic!("no eigenvalues after 50 sweeps");
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// max |a_i|.
pub fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |most, x| if x.is_nan() { f64::NAN } else { most.max(x.abs()) })
}

/// max |a_i − b_i|.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    largest(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// Fails with both numbers unless they agree to `tolerance`; NaN never agrees.
#[track_caller]
pub fn assert_close(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let error = (actual - expected).abs();
    assert!(error <= tolerance, "{what}: {actual:e} instead of {expected:e}, off by {error:e}, allowed {tolerance:e}");
}

/// The same for arrays, by their largest difference.
#[track_caller]
pub fn assert_all_close(what: &str, actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len(), "{what}: lengths");
    for (i, (a, e)) in actual.iter().zip(expected).enumerate() {
        assert_close(&format!("{what}[{i}]"), *a, *e, tolerance);
    }
}
