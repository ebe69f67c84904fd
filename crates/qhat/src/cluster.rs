//! Cluster: what keeps all distances of some particles, with no row more than that.
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
//! Particles all in one line, or in space in one plane, cannot be held by rods alone: rods in a line do not resist a
//! motion across it. Rods then hold the corners a, b (and c), and every other particle is a linear combination of the
//! corners, which a rigid motion keeps:
//!
//! ```text
//! line    x = (1 − s) x_a + s x_b,               s = (x − x_a)·(x_b − x_a)/|x_b − x_a|²
//! plane   x = (1 − r − s) x_a + r x_b + s x_c,   r, s from the areas of the triangles (x, c, a) and (x, a, b)
//! ```
//!
//! These d rows for each particle are linear, and they are independent of each other and of the rods. n particles in a
//! line keep 2 d − 1 degrees of freedom (no spin about the line in space), n particles in a plane in space keep 6. Two
//! particles, and three in space, need no more than their rods.

use crate::allowed::GeometryError;
use crate::number::cross;
use crate::point::{dot, minus, norm, scaled};
use crate::space::Dimension;

/// The relative span below which points count as collinear or coplanar. At this span the tension of a rod is 1e6
/// times the load that it carries. A point that is off its line or plane by less is moved onto it by the projection of
/// the start, which reports the move.
const FLAT: f64 = 1e-6;

/// What keeps all distances of some points, by their places in the list: see [`rigid_cluster`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidCluster {
    /// The pairs of points between which there is a rod.
    pub rods: Vec<[usize; 2]>,
    /// Linear combinations Σ w x = 0, each as the places of its points and their weights: the point that is held first,
    /// with weight 1, then corners. Empty unless all points lie in one line, or in space in one plane.
    pub combinations: Vec<Vec<(usize, f64)>>,
}

/// The rods and the linear combinations that keep all distances of some points \[m\], with no superfluous row: for
/// joints of a lever in one line, of a plate in one plane, and for any other rigid cluster of particles. z is ignored
/// in two dimensions.
///
/// ```
/// use qhat::{Dimension, rigid_cluster};
/// let lever = [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
/// let held = rigid_cluster(Dimension::Two, &lever)?;
/// assert_eq!(held.rods, [[2, 0]]);
/// assert_eq!(held.combinations, [[(1, 1.0), (2, -0.25), (0, -0.75)]]);
/// # Ok::<(), qhat::GeometryError>(())
/// ```
///
/// # Errors
/// In words: fewer than two points, two at the same place where rods would hold them, all at one place.
pub fn rigid_cluster(dimension: Dimension, points: &[[f64; 3]]) -> Result<RigidCluster, GeometryError> {
    let d = dimension.number();
    let flat = in_space_of(d, points);
    let corners = simplex(d, &flat)?;
    if is_spanned(d, &flat, &corners) {
        return Ok(RigidCluster { rods: rods_to(d, &flat, &corners)?, combinations: Vec::new() });
    }
    let others = (0..flat.len()).filter(|i| !corners.contains(i));
    let combinations = others.map(|i| combination(&flat, &corners, i)).collect();
    Ok(RigidCluster { rods: rods_between(&corners), combinations })
}

/// The pairs of points \[m\] between which rods alone hold a cluster rigid, with no superfluous rod; z is ignored in
/// two dimensions.
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
/// [`GeometryError`]: fewer than two points, two at the same place, all in one line, or in space all in one plane,
/// which [`rigid_cluster`] holds.
pub fn rigid_rods(dimension: Dimension, points: &[[f64; 3]]) -> Result<Vec<[usize; 2]>, GeometryError> {
    let d = dimension.number();
    let flat = in_space_of(d, points);
    let corners = simplex(d, &flat)?;
    match corners.len() {
        _ if is_spanned(d, &flat, &corners) => rods_to(d, &flat, &corners),
        2 => Err(GeometryError::ClusterLine),
        _ => Err(GeometryError::ClusterPlane),
    }
}

/// The points without the components that are ignored.
fn in_space_of(d: usize, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    points.iter().map(|x| std::array::from_fn(|k| if k < d { x[k] } else { 0.0 })).collect()
}

/// Whether rods to the corners hold every point.
fn is_spanned(d: usize, points: &[[f64; 3]], corners: &[usize]) -> bool {
    corners.len() == points.len().min(d + 1)
}

fn rods_between(corners: &[usize]) -> Vec<[usize; 2]> {
    corners.iter().enumerate().flat_map(|(i, &a)| corners[..i].iter().map(move |&b| [b, a])).collect()
}

/// The rods between the corners, and d rods from every other point to corners.
fn rods_to(d: usize, points: &[[f64; 3]], corners: &[usize]) -> Result<Vec<[usize; 2]>, GeometryError> {
    let mut rods = rods_between(corners);
    for i in (0..points.len()).filter(|i| !corners.contains(i)) {
        let to: Vec<[f64; 3]> = corners.iter().map(|&corner| minus(points[corner], points[i])).collect();
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

/// Point i as a linear combination of two or three corners, in whose line or plane it lies. Corners of weight 0 are
/// left out.
fn combination(points: &[[f64; 3]], corners: &[usize], i: usize) -> Vec<(usize, f64)> {
    let from = minus(points[i], points[corners[0]]);
    let [b, c] = [1, 2].map(|k| corners.get(k).map(|&corner| minus(points[corner], points[corners[0]])));
    let weights = match (b, c) {
        (Some(b), Some(c)) => {
            let normal = cross(b, c);
            let part = |area: [f64; 3]| dot(area, normal) / dot(normal, normal);
            vec![part(cross(from, c)), part(cross(b, from))]
        }
        (Some(b), None) => vec![dot(from, b) / dot(b, b)],
        _ => Vec::new(),
    };
    let first = 1.0 - weights.iter().sum::<f64>();
    let corners = corners.iter().zip(std::iter::once(first).chain(weights));
    let shares = corners.filter(|&(_, weight)| weight != 0.0).map(|(&corner, weight)| (corner, -weight));
    std::iter::once((i, 1.0)).chain(shares).collect()
}

/// Up to d + 1 points that span as much as possible: two where all points lie in one line, three where all lie in one
/// plane, and all points if there are no more than d.
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
        return Ok(vec![a, b]);
    }
    if d == 2 || points.len() == 3 {
        return Ok(vec![a, b, c]);
    }
    let normal = cross(bar, minus(points[c], points[a]));
    let off_plane = |x: [f64; 3]| dot(normal, minus(x, points[a])).abs() / (norm(normal) * length);
    let e = farthest(&off_plane);
    if off_plane(points[e]) < FLAT {
        return Ok(vec![a, b, c]);
    }
    Ok(vec![a, b, c, e])
}
