//! The reasons for which points of a user do not make a curve or a rigid cluster.

use super::ValueError;
use thiserror::Error;

/// The reason for which points of a user do not make a [`Curve`](crate::Curve) or a cluster of
/// [`rigid_rods`](crate::rigid_rods).
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GeometryError {
    /// A parametric curve has the wrong number of components.
    #[error("a curve has 2 or 3 components, not {count}")]
    CurveComponents {
        /// The number of components.
        count: usize,
    },
    /// A component of a parametric curve depends on particles.
    #[error("a curve may depend on s only")]
    CurveNamesParticles {
        /// The place of the component.
        component: usize,
    },
    /// The bounds of the parameter are in the wrong order, or not finite.
    #[error("the parameter of a curve must grow from its start to its end, but goes from {from} to {to}")]
    CurveRange {
        /// The parameter at the start.
        from: f64,
        /// The parameter at the end.
        to: f64,
    },
    /// The curve is infinite or undefined between its ends.
    #[error("the curve is not finite everywhere from {from} to {to}")]
    CurveNotFinite {
        /// The parameter at the start.
        from: f64,
        /// The parameter at the end.
        to: f64,
    },
    /// A parametric curve has components for another number of dimensions than the system.
    #[error("a curve in {dimension} dimensions has {dimension} components, not {count}")]
    CurveDimension {
        /// d of the system.
        dimension: usize,
        /// The number of components.
        count: usize,
    },
    /// A spline has too few points.
    #[error("a curve needs {least} points, but has {count}")]
    CurvePoints {
        /// The least number of points.
        least: usize,
        /// The number of points.
        count: usize,
    },
    /// Two neighbours of a spline have no distance, or one that cannot be squared.
    #[error("two neighbouring points of a curve are at one place, or too far apart to measure")]
    CurveNeighbours {
        /// The first of the two points.
        point: usize,
    },
    /// A polyline has too few points.
    #[error("a wire of straight pieces needs {least} points, but has {count}")]
    WirePoints {
        /// The least number of points.
        least: usize,
        /// The number of points.
        count: usize,
    },
    /// Two neighbours of a polyline have no distance, or one that cannot be squared.
    #[error("points[{}] and points[{}] are at one place, or too far apart to measure", points[0], points[1])]
    WireNeighbours {
        /// The two points.
        points: [usize; 2],
    },
    /// A polyline turns back on itself.
    #[error("the wire folds back by 180° at points[{point}], where no arc turns it")]
    WireFolds {
        /// The point at the corner.
        point: usize,
    },
    /// The arcs at the corners of a polyline are longer than the straight pieces between them.
    #[error(
        "a radius of {radius} m is too large for the corner at points[{point}]: the largest that fits is {largest} m"
    )]
    WireRadius {
        /// The radius \[m\].
        radius: f64,
        /// The point at the corner.
        point: usize,
        /// The largest radius that fits \[m\].
        largest: f64,
    },
    /// A cluster has fewer than two particles.
    #[error("a rigid cluster has two particles or more")]
    ClusterCount,
    /// A particle of a cluster is at the place of another.
    #[error("two of the particles are at the same place")]
    ClusterCoincides {
        /// One of the two points.
        point: usize,
    },
    /// All particles of a cluster are at one place, or two of them are too far apart.
    #[error("the particles are at the same place, or too far apart to measure")]
    ClusterExtent,
    /// All particles of a cluster lie in one line.
    #[error("the particles lie in one line, which rods between them cannot hold; add a particle beside the line")]
    ClusterLine,
    /// All particles of a cluster in space lie in one plane.
    #[error("the particles lie in one plane, which rods between them cannot hold; add a particle beside the plane")]
    ClusterPlane,
    /// A number is out of range.
    #[error(transparent)]
    Value(#[from] ValueError),
}
