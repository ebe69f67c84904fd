//! Moment: the distance of a point from a line as smooth rows, components of d × w over |d|, with w from a point of
//! the line.
//!
//! ```text
//! C_k = (d × w)_k/|d|           in the plane the one component k = z, the signed distance
//! ∂C/∂w = (e_k × d)/|d|,   ∂C/∂d = (w × e_k)/|d| − C d/|d|²
//! ```
//!
//! In space d × w has no component along d, so two of its three components are enough. The component along the axis of
//! the largest |d_k| is left out. The two gradients then have at least 0.7 of full length and an angle of at least 60°
//! between them. Where d turns so far that another |d_k| is the largest, the rows change. The set of points that they
//! allow does not change, so no force jumps.

use crate::number::{Number, dot, scaled};

/// C, ∂C/∂d and ∂C/∂w of one row.
pub(super) fn moment<N: Number, const D: usize>(row: usize, d: [N; D], w: [N; D]) -> (N, [N; D], [N; D]) {
    let (i, j) = plane(row, d.map(Number::value));
    let square = dot(d, d);
    let inverse = N::constant(1.0) / square.sqrt();
    let C = (d[i] * w[j] - d[j] * w[i]) * inverse;
    let across = |v: [N; D], sign: f64| {
        let mut normal = [N::constant(0.0); D];
        normal[i] = v[j].times(sign) * inverse;
        normal[j] = v[i].times(-sign) * inverse;
        normal
    };
    let (turn, along) = (across(w, 1.0), scaled(C / square, d));
    (C, std::array::from_fn(|k| turn[k] - along[k]), across(d, -1.0))
}

/// The axes i and j of component k = i × j.
fn plane<const D: usize>(row: usize, d: [f64; D]) -> (usize, usize) {
    if D == 2 {
        return (0, 1);
    }
    let longest = (1..D).fold(0, |most, k| if d[k].abs() > d[most].abs() { k } else { most });
    let k = (longest + 1 + row) % 3;
    ((k + 1) % 3, (k + 2) % 3)
}
