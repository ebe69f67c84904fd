//! Curve: a smooth curve c(s), and the foot of a point on it, the parameter s* of the nearest point.
//!
//! ```text
//! w = x − c(s),   g(s) = w·c' = 0,   −g' = c'·c' − w·c"
//! ∂s*/∂x = c'/(c'·c' − w·c")
//! ```
//!
//! A curve may cross itself, and a helix goes on beyond its range, so x does not tell on which branch the particle is.
//! The foot is therefore followed: the search for s* begins where the foot is expected (feet.rs), goes downhill along
//! |x − c(s)|², and ends at the first minimum. A stride turns c' by no more than [`TURN`], so that it does not leave
//! the branch. Where no foot is known, the search begins at the nearest of 512 points within the range and stays
//! between the neighbours of that point. A polyline has its foot in closed form (polyline.rs).
//!
//! Beyond its range a path goes on as its expressions do. A spline or polyline that is not closed ends at its first and
//! last point. There it goes on straight, so that a substep may look beyond; no substep is kept whose foot is beyond.
//!
//! On the inner side, beyond 9/10 of the radius of curvature, −g' is kept at c'·c'/10. At the full radius the foot
//! jumps, and its derivative would be infinite. At a cusp, where c' = 0, c" gives the tangent, and the foot does not
//! move.

use super::polyline::Polyline;
use super::spline::Spline;
use crate::allowed::GeometryError;
use crate::expression::Expression;
use crate::number::Number;
use crate::point::{Point, dot, minus};
use std::sync::Arc;

/// Number of pieces of equal parameter whose ends are compared. The search for a foot begins at the nearest end.
const SAMPLES: usize = 512;
/// Most iterations for one foot. Newton's method takes about five; the bisection that replaces it where it fails takes
/// about fifty; strides along the whole range take [`STRIDES`].
const ITERATIONS: usize = 400;
/// Strides in which the search could go along the whole range.
const STRIDES: f64 = 64.0;
/// Angle by which c' may turn in one stride of the search [rad]: well below the half turn at which the other side of a
/// coil would be as near.
const TURN: f64 = 0.5;
/// Part of the length of a curve by which a foot may lie beyond an end of it: a projection ends within 1e-10 of C = 0.
const PAST: f64 = 1e-9;

/// A smooth curve, for beads and wires. Clones share the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    shape: Arc<Shape>,
}

/// An end of a curve that a bead cannot pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveEnd {
    /// The first point of a spline or polyline that is not closed.
    First,
    /// The last point of a spline or polyline that is not closed.
    Last,
    /// A place beyond which the expressions of a path have no value.
    Undefined,
}

#[derive(Debug, PartialEq)]
struct Shape {
    form: CurveForm,
    from: f64,
    to: f64,
    samples: Vec<[f64; 3]>,
}

#[derive(Debug, PartialEq)]
enum CurveForm {
    Expressions(Vec<Expression>),
    Spline(Spline),
    Polyline(Polyline),
}

/// The foot of a point, with the tangent there and the derivative of s*.
pub(super) struct Foot<N, const D: usize> {
    /// x − c.
    pub(super) w: [N; D],
    /// c', or c" in a cusp.
    pub(super) tangent: [N; D],
    /// ∂s*/∂x.
    pub(super) slope: [N; D],
}

impl Curve {
    /// The curve x(s), y(s) and in space z(s) \[m\] for s between two numbers: expressions for
    /// [`Purpose::Curve`](crate::Purpose::Curve). Beyond its ends the curve goes on by the same expressions.
    ///
    /// # Errors
    /// A number of components other than two or three; a component that depends on more than s; bounds in the wrong
    /// order; a curve that is not finite.
    pub fn parametric(components: Vec<Expression>, from: f64, to: f64) -> Result<Self, GeometryError> {
        if !(2..=3).contains(&components.len()) {
            return Err(GeometryError::CurveComponents { count: components.len() });
        }
        if let Some(component) = components.iter().position(|component| !component.particles().is_empty()) {
            return Err(GeometryError::CurveNamesParticles { component });
        }
        if !(from < to && (to - from).is_finite()) {
            return Err(GeometryError::CurveRange { from, to });
        }
        Curve::new(CurveForm::Expressions(components), from, to)
    }

    /// The cubic spline through points \[m\], closed or open; z = 0 in two dimensions. A bead that reaches an end of an
    /// open spline ends the run: [`StepError::CurveEnds`](crate::StepError::CurveEnds).
    ///
    /// # Errors
    /// Fewer than two points, or three of a closed spline; two neighbours at one place; a number that is not finite.
    pub fn through(points: &[[f64; 3]], closed: bool) -> Result<Self, GeometryError> {
        let spline = Spline::new(points, closed)?;
        let end = spline.end();
        Curve::new(CurveForm::Spline(spline), 0.0, end)
    }

    /// Straight pieces from point to point \[m\], closed or open, with arcs of a radius \[m\] at the corners; z = 0 in
    /// two dimensions. The parameter is the arc length \[m\]. A bead that reaches an end of an open polyline ends the
    /// run: [`StepError::CurveEnds`](crate::StepError::CurveEnds).
    ///
    /// # Errors
    /// Fewer than two points, or three of a closed polyline; two neighbours at one place; a corner that folds back by
    /// 180°; a radius that is too large for the straight pieces beside a corner, with the largest that fits.
    pub fn polyline(points: &[[f64; 3]], radius: f64, closed: bool) -> Result<Self, GeometryError> {
        let polyline = Polyline::new(points, radius, closed)?;
        let to = polyline.end();
        Ok(Curve { shape: Arc::new(Shape { form: CurveForm::Polyline(polyline), from: 0.0, to, samples: Vec::new() }) })
    }

    fn new(form: CurveForm, from: f64, to: f64) -> Result<Self, GeometryError> {
        let mut shape = Shape { form, from, to, samples: Vec::new() };
        shape.samples = (0..=SAMPLES).map(|i| shape.at::<3>(shape.parameter(i)).map(|[c, _, _]| c)).collect();
        if shape.samples.iter().flatten().any(|c| !c.is_finite()) {
            return Err(GeometryError::CurveNotFinite { from, to });
        }
        Ok(Curve { shape: Arc::new(shape) })
    }

    /// `Ok` if the curve has a meaning in d dimensions.
    pub(super) fn fits(&self, dimension: usize) -> Result<(), GeometryError> {
        match &self.shape.form {
            CurveForm::Expressions(components) if components.len() != dimension => {
                Err(GeometryError::CurveDimension { dimension, count: components.len() })
            }
            _ => Ok(()),
        }
    }

    /// The first and last parameter of the curve.
    pub fn range(&self) -> [f64; 2] {
        [self.shape.from, self.shape.to]
    }

    /// The point at a parameter \[m\]; z = 0 in two dimensions.
    pub fn point(&self, s: f64) -> [f64; 3] {
        self.shape.at::<3>(s).map(|[c, _, _]| c)
    }

    /// The corners of a polygon that approximates the curve \[m\], from end to end, for drawing. The polygon has the
    /// given number of pieces of equal parameter. For a polyline it has the straight pieces, and the arcs in pieces of
    /// 5°.
    pub fn drawn(&self, pieces: usize) -> Vec<[f64; 3]> {
        let Shape { form, from, to, .. } = &*self.shape;
        match form {
            CurveForm::Polyline(polyline) => polyline.drawn().into_iter().map(|s| self.point(s)).collect(),
            _ => (0..=pieces).map(|i| self.point(from + (to - from) * i as f64 / pieces as f64)).collect(),
        }
    }

    /// s*, and its rate ṡ* for a particle with the velocity v; sought near `near`, where that is known.
    pub(super) fn parameter<const D: usize>(&self, x: Point<D>, v: Point<D>, near: Option<f64>) -> (f64, f64) {
        let s = self.shape.foot(x, near);
        let at = self.shape.at::<D>(s);
        let [c, c1, c2] = [0, 1, 2].map(|order| std::array::from_fn::<f64, D, _>(|k| at[k][order]));
        let (square, inner) = (dot(c1, c1), dot(minus(x, c), c2));
        let rate = dot(c1, v) / (square - inner).max(0.1 * square);
        (s, if rate.is_finite() { rate } else { 0.0 })
    }

    /// The end that lies before a parameter, if the curve has one there.
    pub(super) fn end_passed(&self, s: f64) -> Option<CurveEnd> {
        let Shape { form, from, to, .. } = &*self.shape;
        let is_open = match form {
            CurveForm::Expressions(_) => false,
            CurveForm::Spline(spline) => !spline.closed(),
            CurveForm::Polyline(polyline) => !polyline.closed(),
        };
        let past = PAST * (to - from);
        if s.is_nan() {
            Some(CurveEnd::Undefined)
        } else if is_open && s < from - past {
            Some(CurveEnd::First)
        } else {
            (is_open && s > to + past).then_some(CurveEnd::Last)
        }
    }

    /// The foot of x, sought near `near`, where that is known.
    pub(super) fn foot<N: Number, const D: usize>(&self, x: [N; D], near: Option<f64>) -> Foot<N, D> {
        let place = x.map(Number::value);
        let at = self.shape.at::<D>(self.shape.foot(place, near));
        let [c, c1, c2] = [0, 1, 2].map(|order| std::array::from_fn::<f64, D, _>(|k| at[k][order]));
        let square = dot(c1, c1);
        let moving = if square > 0.0 { 1.0 } else { 0.0 };
        let way = if square > 0.0 { c1 } else { c2 };
        let inner = dot(minus(place, c), c2);
        let steepness = (square - inner).max(0.1 * square);
        let velocity = x.map(Number::slope);
        let rate = moving * dot(c1, velocity) / if square > 0.0 { steepness } else { 1.0 };
        let tangent: [N; D] = std::array::from_fn(|k| N::of(way[k], moving * c2[k] * rate));
        let w: [N; D] = std::array::from_fn(|k| x[k] - N::of(c[k], c1[k] * rate));
        // (c'·c' − w·c")˙ without w·c‴, which is 0 on the curve.
        let held = steepness > square - inner;
        let turning = if held { 0.2 * dot(c1, c2) * rate } else { 3.0 * dot(c1, c2) * rate - dot(velocity, c2) };
        let steepness = N::of(if square > 0.0 { steepness } else { 1.0 }, turning);
        let slope = tangent.map(|component| component.times(moving) / steepness);
        Foot { w, tangent, slope }
    }
}

impl Shape {
    fn parameter(&self, sample: usize) -> f64 {
        self.from + (self.to - self.from) * (sample as f64 / SAMPLES as f64)
    }

    /// c, c' and c" of each component.
    fn at<const D: usize>(&self, s: f64) -> [[f64; 3]; D] {
        match &self.form {
            CurveForm::Expressions(components) => std::array::from_fn(|k| {
                components.get(k).map_or([0.0; 3], |component| {
                    let jet = component.jet(&[], &[], s);
                    [jet.value, jet.first, jet.second]
                })
            }),
            CurveForm::Spline(spline) => std::array::from_fn(|k| spline.at(k, s)),
            CurveForm::Polyline(polyline) => polyline.at(s),
        }
    }

    /// s*, sought near `near`, where that is known; NaN where the curve has no value on the way.
    fn foot<const D: usize>(&self, x: Point<D>, near: Option<f64>) -> f64 {
        if let CurveForm::Polyline(polyline) = &self.form {
            return polyline.foot(x, near);
        }
        if let Some(near) = near {
            return self.descend(x, near, [f64::NEG_INFINITY, f64::INFINITY]);
        }
        let away = |i: usize| {
            let apart: Point<D> = std::array::from_fn(|k| x[k] - self.samples[i][k]);
            dot(apart, apart)
        };
        let mut nearest = (0, away(0));
        for i in 1..=SAMPLES {
            let distance = away(i);
            if distance < nearest.1 {
                nearest = (i, distance);
            }
        }
        let (s, step) = (self.parameter(nearest.0), (self.to - self.from) / SAMPLES as f64);
        // Beyond an end the foot may lie at any distance.
        let low = if nearest.0 == 0 { f64::NEG_INFINITY } else { s - step };
        let high = if nearest.0 == SAMPLES { f64::INFINITY } else { s + step };
        self.descend(x, s, [low, high])
    }

    /// The first minimum of |x − c(s)|² downhill from s, within bounds.
    fn descend<const D: usize>(&self, x: Point<D>, mut s: f64, [mut low, mut high]: [f64; 2]) -> f64 {
        let span = self.to - self.from;
        for _ in 0..ITERATIONS {
            let at = self.at::<D>(s);
            let [c, c1, c2] = [0, 1, 2].map(|order| std::array::from_fn::<f64, D, _>(|k| at[k][order]));
            let w = minus(x, c);
            let square = dot(c1, c1);
            let (g, steepness) = (dot(w, c1), square - dot(w, c2));
            if g == 0.0 {
                break;
            }
            let bound = if g > 0.0 {
                low = s;
                high
            } else {
                high = s;
                low
            };
            // c' turns by |c' × c"|/c'·c' for each unit of s.
            let along = dot(c1, c2);
            let turning = (square * dot(c2, c2) - along * along).max(0.0).sqrt() / square;
            let stride = (span / STRIDES).min(TURN / turning);
            let newton = if steepness > 0.0 { g / steepness } else { stride.copysign(g) };
            let newton = s + newton.clamp(-stride, stride);
            let inside = (s.min(bound)..=s.max(bound)).contains(&newton);
            let next = if inside { newton } else { 0.5 * (s + bound) };
            // Newton's method squares its error, so after a step of 1e-8 only roundoff is left. NaN ends the search,
            // too.
            let done = next.is_nan() || (next - s).abs() <= 1e-8 * stride;
            s = next;
            if done {
                break;
            }
        }
        s
    }
}
