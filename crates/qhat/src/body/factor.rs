//! G with G Gᵀ = S/m: Cholesky's method with the largest pivot first, so that it ends with the rank.

use super::{BodyError, FLAT};

/// The columns of G [m], as many as are independent, from S/m [m²].
///
/// # Errors
/// A tensor that is negative somewhere, or zero.
pub(super) fn factor(mut S: [[f64; 3]; 3]) -> Result<Vec<[f64; 3]>, BodyError> {
    let scale = (0..3).map(|i| S[i][i].abs()).fold(0.0, f64::max);
    let mut g = Vec::new();
    let mut left = vec![0, 1, 2];
    while let Some(&pivot) = left.iter().max_by(|&&i, &&j| S[i][i].total_cmp(&S[j][j])) {
        let lowest = left.iter().map(|&i| S[i][i]).fold(f64::INFINITY, f64::min);
        if lowest < -FLAT * scale {
            return Err(BodyError::Inertia);
        }
        let largest = S[pivot][pivot];
        if largest <= FLAT * scale {
            // The remainder of the tensor of a body is bounded by its diagonal.
            let rest = left.iter().flat_map(|&i| left.iter().map(move |&j| S[i][j].abs())).fold(0.0, f64::max);
            return match g.len() {
                _ if rest > FLAT * scale => Err(BodyError::Inertia),
                0 => Err(BodyError::NoExtent),
                _ => Ok(g),
            };
        }
        left.retain(|&i| i != pivot);
        let root = largest.sqrt();
        let column: [f64; 3] = std::array::from_fn(|i| match () {
            () if i == pivot => root,
            () if left.contains(&i) => S[i][pivot] / root,
            () => 0.0,
        });
        for &i in &left {
            for &j in &left {
                S[i][j] -= column[i] * column[j];
            }
        }
        g.push(column);
    }
    Ok(g)
}
