//! Cluster: the rods that keep all distances of some particles, and no more rods than that.
//!
//! n particles in general position need 2n − 3 rods in the plane and 3n − 6 in space: one bar, one triangle, in space
//! one tetrahedron, and for every other particle d rods to particles that stand already. The rods of a particle must
//! not lie in one line (plane). Each particle therefore takes, of the corners of the first simplex, those d whose
//! directions, as unit vectors e, span the most:
//!
//! ```text
//! plane |e₁ × e₂|,   space |e₁ · (e₂ × e₃)|
//! ```
//!
//! The corners of the simplex are far apart: the particle farthest from the first, the farthest from that, the
//! farthest from the line of the two, and the farthest from the plane of the three. The least span, and with it the
//! condition of the rods, is then that of the shape.
//!
//! Particles all in one line, or in space in one plane, cannot be held like this: rods in a line do not resist a
//! motion across it. Two particles, and three in space, need no more than their rods.

use crate::allowed::GeometryError;
use crate::number::cross;
use crate::point::{dot, minus, norm, scaled};
use crate::space::Dimension;

/// The relative span below which points count as collinear or coplanar. At this span the tension of a rod is 1e6
/// times the load that it carries.
const FLAT: f64 = 1e-6;

/// The pairs of points \[m\] between which rods hold a cluster rigid, with no superfluous rod; z is ignored in two
/// dimensions.
///
/// ```
/// use qhat::{Dimension, rigid_rods};
/// let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// assert_eq!(rigid_rods(Dimension::Two, &square)?.len(), 2 * 4 - 3);
/// assert!(rigid_rods(Dimension::Three, &square).is_err(), "all in one plane");
/// # Ok::<(), qhat::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError`]: fewer than two points, two at the same place, all in one line, or in space all in one plane.
pub fn rigid_rods(dimension: Dimension, points: &[[f64; 3]]) -> Result<Vec<[usize; 2]>, GeometryError> {
    let d = dimension.number();
    let flat: Vec<[f64; 3]> = points.iter().map(|x| std::array::from_fn(|k| if k < d { x[k] } else { 0.0 })).collect();
    let corners = simplex(d, &flat)?;
    let mut rods = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        rods.extend(corners[..i].iter().map(|&b| [b, a]));
    }
    for i in (0..flat.len()).filter(|i| !corners.contains(i)) {
        let to: Vec<[f64; 3]> = corners.iter().map(|&corner| minus(flat[corner], flat[i])).collect();
        if to.iter().any(|&d| norm(d) == 0.0) {
            return Err(GeometryError::ClusterCoincides { point: i });
        }
        let unit: Vec<[f64; 3]> = to.iter().map(|&d| scaled(1.0 / norm(d), d)).collect();
        // The simplex has one corner too many; `left` is the corner to leave out.
        let span = |left: usize| {
            let e: Vec<[f64; 3]> = (0..=d).filter(|k| *k != left).map(|k| unit[k]).collect();
            if d == 2 { norm(cross(e[0], e[1])) } else { dot(e[0], cross(e[1], e[2])).abs() }
        };
        let left = (1..=d).fold(0, |best, k| if span(k) > span(best) { k } else { best });
        rods.extend((0..=d).filter(|k| *k != left).map(|k| [corners[k], i]));
    }
    Ok(rods)
}

/// d + 1 points that span as much as possible, or all points if there are no more than d.
fn simplex(d: usize, points: &[[f64; 3]]) -> Result<Vec<usize>, GeometryError> {
    if points.len() < 2 {
        return Err(GeometryError::ClusterCount);
    }
    let farthest = |from: &dyn Fn([f64; 3]) -> f64| {
        let better = |best: usize, i: usize| if from(points[i]) > from(points[best]) { i } else { best };
        (1..points.len()).fold(0, better)
    };
    let a = farthest(&|x| norm(minus(x, points[0])));
    let b = farthest(&|x| norm(minus(x, points[a])));
    let bar = minus(points[b], points[a]);
    let length = norm(bar);
    if !(length > 0.0 && length.is_finite()) {
        return Err(GeometryError::ClusterExtent);
    }
    if points.len() == 2 {
        return Ok(vec![a, b]);
    }
    let off_line = |x: [f64; 3]| norm(cross(bar, minus(x, points[a]))) / (length * length);
    let c = farthest(&off_line);
    if off_line(points[c]) < FLAT {
        return Err(GeometryError::ClusterLine);
    }
    if d == 2 || points.len() == 3 {
        return Ok(vec![a, b, c]);
    }
    let normal = cross(bar, minus(points[c], points[a]));
    let off_plane = |x: [f64; 3]| dot(normal, minus(x, points[a])).abs() / (norm(normal) * length);
    let e = farthest(&off_plane);
    if off_plane(points[e]) < FLAT {
        return Err(GeometryError::ClusterPlane);
    }
    Ok(vec![a, b, c, e])
}
