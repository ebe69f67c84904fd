//! Polyline: a wire of straight pieces with round corners. Its parameter is the arc length s, so |c'| = 1.
//!
//! ```text
//! at a corner p the wire comes along e and leaves along f, unit vectors, with the angle θ between them
//! o = (e − f)/|e − f|,   a = (e + f)/|e + f|,   |e − f| = 2 sin(θ/2),   |e + f| = 2 cos(θ/2)
//! arc of radius r, ψ from −θ/2 to θ/2:   c = m + r (cos ψ o + sin ψ a),   m = p − r o/cos(θ/2),   ψ = u/r − θ/2
//!   c' = −sin ψ o + cos ψ a,   which is e at −θ/2 and f at θ/2;   c" = −(cos ψ o + sin ψ a)/r
//! the arc takes r tan(θ/2) of the straight piece on either side:   r (tan(θ_i/2) + tan(θ_{i+1}/2)) ≤ |p_{i+1} − p_i|
//! ```
//!
//! u is the length from the beginning of the piece. An arc lies in the plane of its two pieces, and o, a and c stay in
//! that plane, so the same formulas hold in space. An open wire goes on straight beyond its ends. The foot of a point
//! is the nearest of its feet on all pieces. Each foot has a closed form and is limited to its piece: u = (x − c)·e on
//! a straight piece, u = r (atan2((x − m)·a, (x − m)·o) + θ/2) on an arc.
//!
//! c and c' are continuous. c" jumps from 0 to 1/r where an arc begins; γ and the force of the wire jump with it, as on
//! a real wire. An adaptive method closes in on each of these jumps by rejected and short substeps: `dop853` takes 28
//! of them at a tolerance of 1e-6 and 40 at 1e-9. A method with fixed steps is of first order there.

use crate::allowed::{GeometryError, positive};
use crate::point::{Point, dot, minus, norm};

/// Least angle by which the turn at a corner must stay below 180° [rad]. Nearer to 180° the corner counts as folded
/// back, because its arc would lie a million radii away from it.
const FOLD: f64 = 1e-6;
/// Overlap of two arcs on a straight piece that is allowed as roundoff, relative to the length of the piece. Two arcs
/// may meet on a piece and leave nothing of it straight.
const ROUNDING: f64 = 1e-12;
/// The largest piece of a drawn arc [rad], 5°. The distance of its chord from the arc is at most 0.1 % of the radius.
const DRAWN: f64 = std::f64::consts::PI / 36.0;

/// A wire of straight pieces and arcs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polyline {
    pieces: Vec<Piece>,
    closed: bool,
    end: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct Piece {
    /// s at the beginning of the piece.
    start: f64,
    length: f64,
    form: PolylineForm,
}

#[derive(Clone, Debug, PartialEq)]
enum PolylineForm {
    Straight {
        from: [f64; 3],
        along: [f64; 3],
    },
    Arc {
        /// m.
        center: [f64; 3],
        radius: f64,
        /// o.
        outward: [f64; 3],
        /// a.
        across: [f64; 3],
        /// θ/2.
        half: f64,
    },
}

/// e − f and e + f at one corner.
struct Corner {
    diff: [f64; 3],
    sum: [f64; 3],
    /// tan(θ/2).
    tangent: f64,
}

impl Polyline {
    /// Through points [m], with corners of one radius [m].
    pub(super) fn new(points: &[[f64; 3]], radius: f64, closed: bool) -> Result<Self, GeometryError> {
        let n = points.len();
        let least = if closed { 3 } else { 2 };
        if n < least {
            return Err(GeometryError::WirePoints { least, count: n });
        }
        positive("the radius of a wire's corners", radius)?;
        let count = if closed { n } else { n - 1 };
        let mut sides = Vec::new();
        for i in 0..count {
            let way = minus(points[(i + 1) % n], points[i]);
            let square = dot(way, way);
            if !square.is_normal() {
                let next = (i + 1) % n;
                return Err(GeometryError::WireNeighbours { points: [i, next] });
            }
            let length = square.sqrt();
            sides.push((way.map(|x| x / length), length));
        }
        let mut corners = Vec::new();
        for i in 0..n {
            let is_end = !closed && (i == 0 || i == n - 1);
            corners.push(if is_end { None } else { corner(sides[(i + count - 1) % count].0, sides[i].0, i)? });
        }
        fit(&sides, &corners, radius)?;

        let mut wire = Polyline { pieces: Vec::new(), closed, end: 0.0 };
        let taken = |i: usize| corners[i].as_ref().map_or(0.0, |corner| radius * corner.tangent);
        for (i, (along, length)) in sides.iter().enumerate() {
            let next = (i + 1) % n;
            let from = std::array::from_fn(|k| points[i][k] + taken(i) * along[k]);
            wire.push((length - taken(i) - taken(next)).max(0.0), PolylineForm::Straight { from, along: *along });
            if let Some(Corner { diff, sum, .. }) = &corners[next] {
                let (sine, cosine) = (norm(*diff), norm(*sum));
                let outward = diff.map(|x| x / sine);
                let away = 2.0 * radius / cosine;
                let center = std::array::from_fn(|k| points[next][k] - away * outward[k]);
                let half = libm::atan2(sine, cosine);
                let across = sum.map(|x| x / cosine);
                wire.push(2.0 * radius * half, PolylineForm::Arc { center, radius, outward, across, half });
            }
        }
        Ok(wire)
    }

    fn push(&mut self, length: f64, form: PolylineForm) {
        self.pieces.push(Piece { start: self.end, length, form });
        self.end += length;
    }

    /// The last parameter; the first is 0.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// Whether it returns to its first point.
    pub(super) fn closed(&self) -> bool {
        self.closed
    }

    /// A parameter of a closed wire within its length, and the piece there.
    fn piece(&self, s: f64) -> (f64, usize) {
        let s = if self.closed { s - self.end * (s / self.end).floor() } else { s };
        (s, self.pieces.partition_point(|piece| piece.start <= s).saturating_sub(1))
    }

    /// c, c' and c" of each component.
    pub(super) fn at<const D: usize>(&self, s: f64) -> [[f64; 3]; D] {
        let (s, i) = self.piece(s);
        let piece = &self.pieces[i];
        let u = s - piece.start;
        match &piece.form {
            PolylineForm::Straight { from, along } => std::array::from_fn(|k| [from[k] + along[k] * u, along[k], 0.0]),
            PolylineForm::Arc { center, radius, outward, across, half } => {
                let (sine, cosine) = libm::sincos(u / radius - half);
                std::array::from_fn(|k| {
                    let out = cosine * outward[k] + sine * across[k];
                    [center[k] + radius * out, cosine * across[k] - sine * outward[k], -out / radius]
                })
            }
        }
    }

    /// s*: the first minimum of |x − c|² downhill from `near`, or where that is not known the nearest point of the
    /// wire.
    pub(super) fn foot<const D: usize>(&self, x: Point<D>, near: Option<f64>) -> f64 {
        match near {
            Some(near) => self.foot_near(x, near),
            None => self.nearest_foot(x),
        }
    }

    fn nearest_foot<const D: usize>(&self, x: Point<D>) -> f64 {
        let (mut nearest, mut foot) = (f64::INFINITY, 0.0);
        for (i, piece) in self.pieces.iter().enumerate() {
            let [low, high] = self.bounds(i);
            let (u, square) = piece.form.foot(x, low, high);
            if square < nearest {
                (nearest, foot) = (square, piece.start + u);
            }
        }
        foot
    }

    /// The search goes from piece to piece, towards the end of a piece at which the foot on that piece lies.
    fn foot_near<const D: usize>(&self, x: Point<D>, near: f64) -> f64 {
        let (mut i, count) = (self.piece(near).1, self.pieces.len());
        let mut forward = None;
        for _ in 0..=count {
            let (piece, [low, high]) = (&self.pieces[i], self.bounds(i));
            let (u, _) = piece.form.foot(x, low, high);
            let here = piece.start + u;
            let next = match (u <= low, u >= high) {
                (false, false) => return here,
                // A piece without length is passed in the direction of the search.
                (true, true) => forward.unwrap_or(true),
                (_, is_high) => is_high,
            };
            // The foot on the piece before lies at the same joint.
            if forward == Some(!next) {
                return here;
            }
            forward = Some(next);
            i = if next { (i + 1) % count } else { (i + count - 1) % count };
        }
        self.nearest_foot(x)
    }

    /// The bounds of u on a piece. An open wire goes on straight beyond its ends.
    fn bounds(&self, i: usize) -> [f64; 2] {
        let low = if i == 0 && !self.closed { f64::NEG_INFINITY } else { 0.0 };
        let high = if i == self.pieces.len() - 1 && !self.closed { f64::INFINITY } else { self.pieces[i].length };
        [low, high]
    }

    /// The parameters of the corners of a polygon that approximates the wire.
    pub(super) fn drawn(&self) -> Vec<f64> {
        let mut all = vec![0.0];
        for Piece { start, length, form } in &self.pieces {
            let cuts = match form {
                PolylineForm::Straight { .. } => 1.0,
                PolylineForm::Arc { half, .. } => (2.0 * half / DRAWN).ceil().max(1.0),
            };
            all.extend((1..=cuts as usize).map(|i| start + length * (i as f64 / cuts)));
        }
        all
    }
}

impl PolylineForm {
    /// u of the foot of x and |x − c|² there. The foot lies between `low` and `high` on a straight piece, and within
    /// the piece on an arc.
    fn foot<const D: usize>(&self, x: Point<D>, low: f64, high: f64) -> (f64, f64) {
        let first = |v: &[f64; 3]| -> Point<D> { std::array::from_fn(|k| v[k]) };
        match self {
            PolylineForm::Straight { from, along } => {
                let (w, along) = (minus(x, first(from)), first(along));
                let u = dot(w, along).max(low).min(high);
                let apart: Point<D> = std::array::from_fn(|k| w[k] - u * along[k]);
                (u, dot(apart, apart))
            }
            PolylineForm::Arc { center, radius, outward, across, half } => {
                let (w, o, a) = (minus(x, first(center)), first(outward), first(across));
                let psi = libm::atan2(dot(w, a), dot(w, o)).max(-half).min(*half);
                let (sine, cosine) = libm::sincos(psi);
                let apart: Point<D> = std::array::from_fn(|k| w[k] - radius * (cosine * o[k] + sine * a[k]));
                (radius * (psi + half), dot(apart, apart))
            }
        }
    }
}

/// The corner from e to f at a point; `None` where the wire goes on straight.
fn corner(e: [f64; 3], f: [f64; 3], point: usize) -> Result<Option<Corner>, GeometryError> {
    let (diff, sum) = (minus(e, f), std::array::from_fn(|k| e[k] + f[k]));
    let (sine, cosine) = (norm(diff), norm(sum));
    if cosine <= FOLD {
        return Err(GeometryError::WireFolds { point });
    }
    Ok((sine > 0.0).then_some(Corner { diff, sum, tangent: sine / cosine }))
}

/// `Ok` if every straight piece is long enough for the arcs at its ends.
fn fit(sides: &[([f64; 3], f64)], corners: &[Option<Corner>], radius: f64) -> Result<(), GeometryError> {
    let tangent = |i: usize| corners[i % corners.len()].as_ref().map_or(0.0, |corner| corner.tangent);
    // The largest radius that fits, and the corner that takes the most of the piece that limits it.
    let mut tightest = (f64::INFINITY, 0);
    for (i, (_, length)) in sides.iter().enumerate() {
        let room = length / (tangent(i) + tangent(i + 1));
        if room < tightest.0 {
            let widest = if tangent(i) > tangent(i + 1) { i } else { i + 1 };
            tightest = (room, widest % corners.len());
        }
    }
    let (room, point) = tightest;
    if radius <= room * (1.0 + ROUNDING) {
        return Ok(());
    }
    Err(GeometryError::WireRadius { radius, point, largest: short(room) })
}

/// The radius rounded down to five digits, so that it still fits.
fn short(room: f64) -> f64 {
    let rounded = |x: f64| format!("{x:.4e}").parse().unwrap_or(x);
    if rounded(room) <= room * (1.0 + ROUNDING) { rounded(room) } else { rounded(room * (1.0 - 1e-4)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BENT: [[f64; 3]; 5] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 1.0], [0.5, 3.0, 1.0], [-1.0, 1.5, 0.5]];

    fn apart(a: [[f64; 3]; 3], b: [[f64; 3]; 3], order: usize) -> f64 {
        norm(std::array::from_fn::<f64, 3, _>(|k| a[k][order] - b[k][order]))
    }

    /// Where pieces meet, c and c' are the same from both sides, also where a closed wire meets itself. Everywhere |c'|
    /// = 1, c' and c" agree with differences, and |c"| is 0 or 1/r.
    #[test]
    fn pieces_meet_with_one_derivative() {
        for closed in [false, true] {
            let wire = Polyline::new(&BENT, 0.3, closed).unwrap();
            let ends = wire.pieces.iter().map(|piece| piece.start).filter(|start| closed || *start > 0.0);
            for s in ends {
                let (left, right) = (wire.at::<3>(s - 1e-9), wire.at::<3>(s + 1e-9));
                // Over 2e-9 m, c changes by 2e-9 m and c' by 2e-9 m over the radius.
                assert!(apart(left, right, 0) < 2.1e-9 && apart(left, right, 1) < 1e-8, "{closed} {s}");
            }
            for i in 0..500 {
                let s = wire.end() * (i as f64 + 0.5) / 500.0;
                let [at, before, after] = [s, s - 1e-6, s + 1e-6].map(|s| wire.at::<3>(s));
                let speed = norm(at.map(|[_, c1, _]| c1));
                let bend = norm(at.map(|[_, _, c2]| c2));
                assert!((speed - 1.0).abs() < 1e-14, "{speed}");
                assert!(bend == 0.0 || (bend - 1.0 / 0.3).abs() < 1e-13, "{bend}");
                for k in 0..3 {
                    // Central differences over ±1e-6: roundoff of 1e-16 leaves an error of 1e-10, third derivatives of
                    // 1/r² leave less.
                    let slope = |order: usize| (after[k][order] - before[k][order]) / 2e-6;
                    assert!((slope(0) - at[k][1]).abs() < 1e-8 && (slope(1) - at[k][2]).abs() < 1e-8, "{s}");
                }
            }
        }
    }

    /// For points beside the wire and off the planes of its arcs, no point of the wire is nearer than the foot, and the
    /// line to the foot is at right angles to the wire.
    #[test]
    fn the_foot_is_the_nearest_point() {
        for closed in [false, true] {
            let wire = Polyline::new(&BENT, 0.4, closed).unwrap();
            for i in 0..200 {
                let turn = f64::from(i);
                let x = [1.5 * libm::sin(turn) + 0.8, 1.5 * libm::cos(1.7 * turn) + 1.2, libm::sin(2.3 * turn)];
                let away = |s: f64| minus(x, wire.at::<3>(s).map(|[c, _, _]| c));
                let foot = wire.foot(x, None);
                let tangent = wire.at::<3>(foot).map(|[_, c1, _]| c1);
                assert!(dot(away(foot), tangent).abs() < 1e-13, "{closed} {i}");
                // An open wire is tested for 2 m beyond its ends.
                let (low, high) = if closed { (0.0, wire.end()) } else { (-2.0, wire.end() + 2.0) };
                for j in 0..=2000 {
                    let s = low + (high - low) * f64::from(j) / 2000.0;
                    assert!(norm(away(s)) >= norm(away(foot)) - 1e-14, "{closed} {i} {s}");
                }
            }
        }
    }

    /// No point of the wire is farther from its polygon than an arc from its chord of 5°, and each straight piece is
    /// drawn as one line.
    #[test]
    fn what_is_drawn_is_round_and_cuts_no_corner() {
        let wire = Polyline::new(&BENT, 0.3, false).unwrap();
        let at = |s: f64| wire.at::<3>(s).map(|[c, _, _]| c);
        let drawn = wire.drawn();
        let straight = wire.pieces.iter().filter(|piece| matches!(piece.form, PolylineForm::Straight { .. }));
        for Piece { start, length, .. } in straight {
            assert!(drawn.windows(2).any(|pair| pair[0] == *start && pair[1] == start + length));
        }
        for pair in drawn.windows(2) {
            let (a, chord) = (at(pair[0]), minus(at(pair[1]), at(pair[0])));
            for i in 0..10 {
                let w = minus(at(pair[0] + (pair[1] - pair[0]) * f64::from(i) / 10.0), a);
                let u = dot(w, chord) / dot(chord, chord);
                let off = norm(std::array::from_fn::<f64, 3, _>(|k| w[k] - u * chord[k]));
                assert!(off <= 0.3 * (1.0 - libm::cos(0.5 * DRAWN)) + 1e-15, "{off}");
            }
        }
    }

    #[test]
    fn what_cannot_be_bent_is_refused_with_the_place() {
        let refused = |points: &[[f64; 3]], radius: f64, closed: bool, words: &str| {
            let error = Polyline::new(points, radius, closed).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        refused(&square[..2], 0.1, true, "needs 3 points, but has 2");
        refused(&square, 0.0, true, "must be positive and finite, but is 0");
        refused(&square, f64::NAN, true, "but is NaN");
        refused(&[square[0], square[1], square[1]], 0.1, false, "points[1] and points[2] are at one place");
        refused(&[square[0], square[1], square[0]], 0.1, true, "points[2] and points[0] are at one place");
        refused(&[square[0], square[1], [0.5, 0.0, 0.0]], 0.1, false, "folds back by 180° at points[1]");
        refused(&square, 0.6, true, "corner at points[1]: the largest that fits is 0.5 m");
        // The two corners take (tan(π/8) + tan(π/4)) r of 1 m.
        let narrow = [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 1.0, 0.0], [0.0, 5.0, 0.0]];
        refused(&narrow, 3.0, false, "corner at points[1]: the largest that fits is 0.70");
    }

    /// Arcs may meet and leave no straight piece between them: a stadium, and a circle from a square.
    #[test]
    fn arcs_may_use_up_a_side() {
        let points = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let stadium = Polyline::new(&points, 0.5, true).unwrap();
        assert!((stadium.end() - 2.0 - std::f64::consts::PI).abs() < 1e-14);
        let square = [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];
        let circle = Polyline::new(&square, 1.0, true).unwrap();
        for s in circle.drawn() {
            assert!((norm(circle.at::<2>(s).map(|[c, _, _]| c)) - 1.0).abs() < 1e-15);
        }
    }
}
