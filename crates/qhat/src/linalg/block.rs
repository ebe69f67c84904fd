//! Small square blocks: the entries of a matrix whose unknowns come D at a time.

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

/// A⁻¹ of a symmetric positive definite block by LDLᵀ; `None` where a pivot does not exceed `least`.
#[inline(always)]
pub(crate) fn inverse<const D: usize>(A: &Block<D>, least: f64) -> Option<Block<D>> {
    // A = L D Lᵀ, then L⁻¹ by forward substitution, then A⁻¹ = L⁻ᵀ D⁻¹ L⁻¹.
    let mut L = *A;
    let (mut pivots, mut inverse_pivot) = ([0.0; D], [0.0; D]);
    for j in 0..D {
        let mut pivot = L[j][j];
        for k in 0..j {
            pivot -= L[j][k] * L[j][k] * pivots[k];
        }
        if pivot.is_nan() || pivot <= least {
            return None;
        }
        (pivots[j], inverse_pivot[j]) = (pivot, 1.0 / pivot);
        for i in j + 1..D {
            let mut entry = L[i][j];
            for k in 0..j {
                entry -= L[i][k] * L[j][k] * pivots[k];
            }
            L[i][j] = entry * inverse_pivot[j];
        }
    }
    let mut inverted = diagonal::<D>(1.0);
    for i in 0..D {
        for j in 0..i {
            let entry = -(j..i).map(|k| L[i][k] * inverted[k][j]).sum::<f64>();
            inverted[i][j] = entry;
        }
    }
    Some(std::array::from_fn(|i| {
        std::array::from_fn(|j| sum::<D>(|k| inverted[k][i] * inverse_pivot[k] * inverted[k][j]))
    }))
}

/// Σ over k < D, from the first on.
#[inline(always)]
fn sum<const D: usize>(term: impl Fn(usize) -> f64) -> f64 {
    let mut total = term(0);
    for k in 1..D {
        total += term(k);
    }
    total
}
