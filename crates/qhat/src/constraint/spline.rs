//! Spline: the smooth curve through given points, a cubic in each piece, with c, c' and c" continuous.
//!
//! ```text
//! knots s_i: the length of the straight lines from point to point up to point i,   h_i = s_{i+1} − s_i,   u = s − s_i
//! c = p_i + b_i u + m_i u²/2 + (m_{i+1} − m_i) u³/(6 h_i),   b_i = (p_{i+1} − p_i)/h_i − h_i (2 m_i + m_{i+1})/6
//! h_{i−1} m_{i−1} + 2 (h_{i−1} + h_i) m_i + h_i m_{i+1} = 6 ((p_{i+1} − p_i)/h_i − (p_i − p_{i−1})/h_{i−1})
//! ```
//!
//! m_i = c"(s_i). An open curve has m = 0 at both ends and goes on straight beyond them; a closed curve returns to
//! its first point. The matrix of the closed curve has two further entries β in its corners. They are split off as a
//! matrix of rank one (Sherman and Morrison). Source: de Boor, A Practical Guide to Splines, chapter IV.

use crate::allowed::GeometryError;

/// A cubic spline.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spline {
    knots: Vec<f64>,
    points: Vec<[f64; 3]>,
    /// m_i.
    bends: Vec<[f64; 3]>,
    closed: bool,
}

impl Spline {
    /// Through two points [m] or more, three or more of a closed spline, no two neighbours the same.
    pub(super) fn new(points: &[[f64; 3]], closed: bool) -> Result<Self, GeometryError> {
        let mut points = points.to_vec();
        let least = if closed { 3 } else { 2 };
        if points.len() < least {
            return Err(GeometryError::CurvePoints { least, count: points.len() });
        }
        if closed {
            points.push(points[0]);
        }
        let mut knots = vec![0.0];
        for (point, pair) in points.windows(2).enumerate() {
            let way: f64 = (0..3).map(|k| pair[1][k] - pair[0][k]).map(|x| x * x).sum();
            if !way.is_normal() {
                return Err(GeometryError::CurveNeighbours { point });
            }
            knots.push(knots[knots.len() - 1] + way.sqrt());
        }
        let mut spline = Spline { bends: vec![[0.0; 3]; points.len()], knots, points, closed };
        for k in 0..3 {
            spline.bend(k);
        }
        Ok(spline)
    }

    /// The last parameter; the first is 0.
    pub(super) fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// Whether it returns to its first point.
    pub(super) fn closed(&self) -> bool {
        self.closed
    }

    /// Solves for m along axis k.
    fn bend(&mut self, k: usize) {
        let pieces = self.knots.len() - 1;
        let h = |i: usize| self.knots[i % pieces + 1] - self.knots[i % pieces];
        let slope = |i: usize| (self.points[i % pieces + 1][k] - self.points[i % pieces][k]) / h(i);
        // Unknown j belongs to the point between the pieces left(j) and left(j) + 1.
        let (count, left) = if self.closed { (pieces, pieces - 1) } else { (pieces - 1, 0) };
        let mut diagonal: Vec<f64> = (0..count).map(|j| 2.0 * (h(left + j) + h(left + j + 1))).collect();
        let beside: Vec<f64> = (0..count).map(|j| h(left + j + 1)).collect();
        let mut right: Vec<f64> = (0..count).map(|j| 6.0 * (slope(left + j + 1) - slope(left + j))).collect();
        if self.closed {
            let corner = beside[count - 1];
            let first = -diagonal[0];
            let mut other = vec![0.0; count];
            (other[0], other[count - 1]) = (first, corner);
            diagonal[0] -= first;
            diagonal[count - 1] -= corner * corner / first;
            solve(&diagonal, &beside, &mut right);
            solve(&diagonal, &beside, &mut other);
            let of = |v: &[f64]| v[0] + corner / first * v[count - 1];
            let share = of(&right) / (1.0 + of(&other));
            for (m, o) in right.iter_mut().zip(&other) {
                *m -= share * o;
            }
            for (j, m) in right.iter().enumerate() {
                self.bends[j][k] = *m;
            }
            self.bends[pieces][k] = right[0];
        } else {
            solve(&diagonal, &beside, &mut right);
            for (j, m) in right.iter().enumerate() {
                self.bends[j + 1][k] = *m;
            }
        }
    }

    /// c, c' and c" along axis k.
    pub(super) fn at(&self, k: usize, s: f64) -> [f64; 3] {
        let end = self.end();
        let s = if self.closed { s - end * (s / end).floor() } else { s };
        let last = self.knots.len() - 2;
        let i = self.knots.partition_point(|knot| *knot <= s).saturating_sub(1).min(last);
        let (h, u) = (self.knots[i + 1] - self.knots[i], s - self.knots[i]);
        let ([p, q], [m, n]) = ([self.points[i][k], self.points[i + 1][k]], [self.bends[i][k], self.bends[i + 1][k]]);
        let b = (q - p) / h - h * (2.0 * m + n) / 6.0;
        if !self.closed && u < 0.0 {
            return [p + b * u, b, 0.0];
        }
        let at =
            |u: f64| [p + u * (b + u * (m / 2.0 + u * (n - m) / (6.0 * h))), b + u * (m + u * (n - m) / (2.0 * h))];
        if !self.closed && u > h {
            let [c, c1] = at(h);
            return [c + c1 * (u - h), c1, 0.0];
        }
        let [c, c1] = at(u);
        [c, c1, m + u * (n - m) / h]
    }
}

/// Solves a symmetric tridiagonal system in place; rows j and j + 1 share `beside[j]`. The matrix is diagonally
/// dominant, so no pivoting is needed.
fn solve(diagonal: &[f64], beside: &[f64], right: &mut [f64]) {
    let mut pivots = diagonal.to_vec();
    for j in 1..right.len() {
        let factor = beside[j - 1] / pivots[j - 1];
        pivots[j] -= factor * beside[j - 1];
        right[j] -= factor * right[j - 1];
    }
    for j in (0..right.len()).rev() {
        let next = if j + 1 < right.len() { beside[j] * right[j + 1] } else { 0.0 };
        right[j] = (right[j] - next) / pivots[j];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At every knot the curve passes through the point, and c, c' and c" are the same from both sides, also where a
    /// closed curve meets itself.
    #[test]
    fn pieces_meet_with_two_derivatives() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2], [1.5, 2.0, -0.3], [0.2, 1.6, 0.1], [-0.8, 0.9, 0.5]];
        for closed in [false, true] {
            let spline = Spline::new(&points, closed).unwrap();
            for (i, knot) in spline.knots.iter().enumerate() {
                for k in 0..3 {
                    let (left, right) = (spline.at(k, knot - 1e-9), spline.at(k, knot + 1e-9));
                    assert!((spline.at(k, *knot)[0] - points[i % points.len()][k]).abs() < 1e-14);
                    for order in 0..3 {
                        // Over 2e-9 m each changes by 2e-8, because the next derivative is of the order of 10.
                        assert!((left[order] - right[order]).abs() < 1e-7, "{closed} {i} {order}");
                    }
                }
            }
        }
    }
}
