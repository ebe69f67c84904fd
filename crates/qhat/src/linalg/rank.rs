//! Rank of a positive semidefinite matrix by LDLᵀ with diagonal pivoting: the largest remaining pivot goes first, and
//! the rank is the number of pivots above the roundoff of the elimination.
//! Source: Higham, Analysis of the Cholesky decomposition of a semi-definite matrix (1990).

/// Rank of a dense positive semidefinite matrix with unit or zero diagonal, `n × n` row after row; `matrix` is
/// consumed.
pub(crate) fn rank(n: usize, mut matrix: Vec<f64>) -> usize {
    // Pivots of a matrix with unit diagonal lie in [0, 1]. A pivot that is zero in exact arithmetic comes out at about
    // n times roundoff, amplified by the conditioning of the rows already taken; three digits are allowed for that.
    let tolerance = 1e3 * f64::EPSILON * (n.max(1) as f64);
    let mut active: Vec<usize> = (0..n).collect();
    let mut rank = 0;
    while let Some((place, pivot)) = largest(&active, |i| matrix[i * n + i]) {
        let d = matrix[pivot * n + pivot];
        if d.is_nan() || d <= tolerance {
            break;
        }
        active.swap_remove(place);
        rank += 1;
        for &i in &active {
            let l = matrix[i * n + pivot] / d;
            if l != 0.0 {
                for &j in &active {
                    matrix[i * n + j] -= l * matrix[pivot * n + j];
                }
            }
        }
    }
    rank
}

/// Rank of the sparse matrix of a pattern. The unknowns for which `is_eliminated` holds are eliminated first. The
/// diagonal is one in the rows for which `is_active` holds and zero in the others.
///
/// An eliminated unknown h has −1 on its diagonal, so its elimination adds the outer product of its column.
pub(crate) fn rank_of(
    pattern: &super::Pattern,
    values: &[f64],
    is_eliminated: impl Fn(usize) -> bool,
    is_active: impl Fn(usize) -> bool,
) -> usize {
    let n = pattern.order();
    let mut dense = vec![0.0; n * n];
    for i in 0..n {
        for slot in pattern.start[i]..pattern.start[i + 1] {
            let j = pattern.column[slot];
            dense[i * n + j] = values[slot];
            dense[j * n + i] = values[slot];
        }
    }
    for h in (0..n).filter(|&h| is_eliminated(h)) {
        let column: Vec<f64> = (0..n).map(|i| dense[i * n + h]).collect();
        for i in (0..n).filter(|&i| i != h && column[i] != 0.0) {
            for j in 0..n {
                dense[i * n + j] += column[i] * column[j];
            }
        }
        dense[h * n..(h + 1) * n].fill(0.0);
        (0..n).for_each(|i| dense[i * n + h] = 0.0);
    }
    for i in (0..n).filter(|&i| !is_eliminated(i)) {
        dense[i * n + i] = if is_active(i) { 1.0 } else { 0.0 };
    }
    rank(n, dense)
}

fn largest(active: &[usize], value: impl Fn(usize) -> f64) -> Option<(usize, usize)> {
    let mut best: Option<(usize, usize)> = None;
    for (place, &i) in active.iter().enumerate() {
        if best.is_none_or(|(_, j)| value(i) > value(j)) {
            best = Some((place, i));
        }
    }
    best
}
