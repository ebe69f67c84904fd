//! Small square blocks: the entries of a matrix whose unknowns are vectors of D components.

/// D × D numbers, row after row.
pub(crate) type Block<const D: usize> = [[f64; D]; D];

/// The zero block.
pub(crate) const fn zero<const D: usize>() -> Block<D> {
    [[0.0; D]; D]
}

/// s I.
#[inline(always)]
pub(crate) fn diagonal<const D: usize>(s: f64) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { s } else { 0.0 }))
}

/// s a bᵀ.
#[inline(always)]
pub(crate) fn outer<const D: usize>(s: f64, a: [f64; D], b: [f64; D]) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| s * a[i] * b[j]))
}

/// A + s B.
#[inline(always)]
pub(crate) fn plus<const D: usize>(A: Block<D>, s: f64, B: Block<D>) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| A[i][j] + s * B[i][j]))
}

/// A x.
#[inline(always)]
pub(crate) fn times<const D: usize>(A: &Block<D>, x: [f64; D]) -> [f64; D] {
    std::array::from_fn(|i| sum::<D>(|k| A[i][k] * x[k]))
}

/// Aᵀ x.
#[inline(always)]
pub(crate) fn transposed_times<const D: usize>(A: &Block<D>, x: [f64; D]) -> [f64; D] {
    std::array::from_fn(|i| sum::<D>(|k| A[k][i] * x[k]))
}

/// A B.
#[inline(always)]
pub(crate) fn product<const D: usize>(A: &Block<D>, B: &Block<D>) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| sum::<D>(|k| A[i][k] * B[k][j])))
}

/// A Bᵀ.
#[inline(always)]
pub(crate) fn product_transposed<const D: usize>(A: &Block<D>, B: &Block<D>) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| sum::<D>(|k| A[i][k] * B[j][k])))
}

/// Aᵀ.
#[inline(always)]
pub(crate) fn transposed<const D: usize>(A: &Block<D>) -> Block<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| A[j][i]))
}

/// The i-th block of a flat array of them.
#[inline(always)]
pub(crate) fn load<const D: usize>(flat: &[f64], i: usize) -> Block<D> {
    let numbers = &flat[i * D * D..][..D * D];
    std::array::from_fn(|row| std::array::from_fn(|column| numbers[row * D + column]))
}

/// Writes the i-th block of a flat array of them.
#[inline(always)]
pub(crate) fn store<const D: usize>(flat: &mut [f64], i: usize, A: Block<D>) {
    for (target, row) in flat[i * D * D..][..D * D].chunks_exact_mut(D).zip(A) {
        target.copy_from_slice(&row);
    }
}

/// Adds s A to the i-th block of a flat array of them.
#[inline(always)]
pub(crate) fn accumulate<const D: usize>(flat: &mut [f64], i: usize, s: f64, A: &Block<D>) {
    let numbers = &mut flat[i * D * D..][..D * D];
    for row in 0..D {
        for column in 0..D {
            numbers[row * D + column] += s * A[row][column];
        }
    }
}

/// The i-th vector of a flat array of them.
#[inline(always)]
pub(crate) fn vector<const D: usize>(flat: &[f64], i: usize) -> [f64; D] {
    let numbers = &flat[i * D..][..D];
    std::array::from_fn(|k| numbers[k])
}

/// A = L D Lᵀ of a symmetric positive definite block: L (unit lower) below the diagonal and 1/D on it; entries above
/// the diagonal are not used. `None` if a pivot does not exceed `least`.
#[inline(always)]
pub(crate) fn ldl<const D: usize>(A: &Block<D>, least: f64) -> Option<Block<D>> {
    let mut factor = *A;
    let mut pivots = [0.0; D];
    for j in 0..D {
        let mut pivot = factor[j][j];
        for k in 0..j {
            pivot -= factor[j][k] * factor[j][k] * pivots[k];
        }
        if pivot.is_nan() || pivot <= least {
            return None;
        }
        (pivots[j], factor[j][j]) = (pivot, 1.0 / pivot);
        for i in j + 1..D {
            let mut entry = factor[i][j];
            for k in 0..j {
                entry -= factor[i][k] * factor[j][k] * pivots[k];
            }
            factor[i][j] = entry * factor[j][j];
        }
    }
    Some(factor)
}

/// L⁻¹ x for the L of [`ldl`].
#[inline(always)]
pub(crate) fn forward<const D: usize>(factor: &Block<D>, mut x: [f64; D]) -> [f64; D] {
    for i in 1..D {
        for k in 0..i {
            x[i] -= factor[i][k] * x[k];
        }
    }
    x
}

/// L⁻ᵀ x for the L of [`ldl`].
#[inline(always)]
pub(crate) fn backward<const D: usize>(factor: &Block<D>, mut x: [f64; D]) -> [f64; D] {
    for i in (0..D).rev() {
        for k in i + 1..D {
            x[i] -= factor[k][i] * x[k];
        }
    }
    x
}

/// D⁻¹ x for the D of [`ldl`].
#[inline(always)]
pub(crate) fn divide<const D: usize>(factor: &Block<D>, x: [f64; D]) -> [f64; D] {
    std::array::from_fn(|i| factor[i][i] * x[i])
}

/// Σ over k < D, in ascending order of k.
#[inline(always)]
fn sum<const D: usize>(term: impl Fn(usize) -> f64) -> f64 {
    let mut total = term(0);
    for k in 1..D {
        total += term(k);
    }
    total
}
