//! Edges: places that no substep may pass, because the motion beyond them is another one.
//!
//! - The end of a curve.
//! - A place where an arm of a constraint, such as a stretch of a rope, has no length left.
//! - A place where the gradient of a row jumps or has no value: where a stretch of a rope has no length, its direction
//!   d/|d| turns by 180° at once, and a substep that goes over such a place is not the motion of any rope.
//!
//! A gradient of a row by a particle that turns by more than 120° in a substep has turned fast, or has jumped. The
//! cubic through both ends of the substep is halved, each time towards the larger turn: a turn becomes small, a jump
//! stays. A gradient that goes through zero, as at the crossing of x y = 0, jumps as well, but the force does not: the
//! motion goes straight on.

use super::failure::shortest_arm;
use crate::constraint::{Constraint, Holds, Layout, Rows};
use crate::point::{Motion, Point, dot};
use crate::system::System;

/// Length of an arm, relative to the extent of the system, below which it is lost.
const LOST: f64 = 1e-7;
/// Cosine of the turn in a substep from which a jump is sought: 120°.
const TURNED: f64 = -0.5;
/// Cosine of a turn that is no jump: 60°.
const SMOOTH: f64 = 0.5;
/// Halvings of the substep: 1e-14 of it.
const HALVINGS: usize = 46;
/// Part of the gradient below which a block of it is taken to have gone through zero: the factor of a product that is
/// held at zero turns with every rounding.
const VANISHED: f64 = 1e-6;

/// A substep from one motion to another. `before` is J at its start, `rows` are those at its end; inactive rows do not
/// count.
pub(super) struct Passage<'a, const D: usize> {
    pub(super) system: &'a System,
    pub(super) rows: &'a Rows,
    pub(super) inactive: &'a [bool],
    pub(super) before: &'a [f64],
    pub(super) from: Motion<'a, D>,
    pub(super) to: Motion<'a, D>,
}

impl<const D: usize> Passage<'_, D> {
    /// Whether the substep passes an edge.
    pub(super) fn is_barred(&self) -> bool {
        self.lost_arm().is_some() || self.jump().is_some() || self.past_an_end()
    }

    /// The first constraint with an arm that shrinks to nothing. Nearer than that to a guide, roundoff says whether a
    /// stretch goes round it or through it.
    pub(super) fn lost_arm(&self) -> Option<usize> {
        let Passage { system, from, to, .. } = *self;
        let nothing = LOST * system.extent;
        system.jumpy.iter().copied().find(|&place| {
            let is_active = self.is_active(system.constraints[place].first_row);
            let length = |q: &[f64]| shortest_arm::<D>(system, place, q).map_or(f64::INFINITY, |(_, length)| length);
            is_active && length(to.q) <= nothing && length(from.q) > nothing
        })
    }

    fn is_active(&self, row: usize) -> bool {
        self.inactive.get(row).is_none_or(|inactive| !inactive)
    }

    fn past_an_end(&self) -> bool {
        let Passage { system, rows, to, .. } = *self;
        !system.bead_places.is_empty() && rows.feet.past_an_end(&system.beads(), to).is_some()
    }

    /// The first constraint whose gradient jumps on the way.
    pub(super) fn jump(&self) -> Option<usize> {
        let J = &self.rows.J;
        self.system.jumpy.iter().copied().find(|&place| {
            let named = &self.system.constraints[place];
            let rows = named.first_row..named.first_row + named.constraint.row_count(D);
            let (first, last) = (J.layout.start[rows.start], J.layout.start[rows.end]);
            let block = |blocks: &[f64], e: usize| -> Point<D> { std::array::from_fn(|k| blocks[e * D + k]) };
            let scale = size(&J.blocks[first * D..last * D]);
            let counts = |block: Point<D>| size(&block) > VANISHED * scale;
            let turned = |&e: &usize| {
                let [then, now] = [block(self.before, e), J.entry::<D>(e)];
                (counts(then) || counts(now)) && has_turned(then, now)
            };
            self.is_active(rows.start)
                && (first..last).filter(turned).any(|e| self.jumps(&named.constraint, (e - first) * D, scale))
        })
    }

    /// Whether a block of a gradient that has turned far has jumped; `at` is its place among the numbers of the
    /// constraint's J, and `scale` the largest of these.
    fn jumps(&self, constraint: &Constraint, at: usize, scale: f64) -> bool {
        let Passage { from, to, .. } = *self;
        let mut rows = Rows::new(Layout::new(std::iter::once(constraint), D), D, self.system.particle_count());
        let mut q = from.q.to_vec();
        let mut gradient = |part: f64| -> Point<D> {
            let h = to.t - from.t;
            let (s, c) = (part * part * (3.0 - 2.0 * part), part * (1.0 - part));
            for (k, x) in q.iter_mut().enumerate() {
                let bend = h * c * ((1.0 - part) * from.qd[k] - part * to.qd[k]);
                *x = (1.0 - s) * from.q[k] + s * to.q[k] + bend;
            }
            rows.evaluate(std::iter::once(constraint), Motion::<D> { q: &q, qd: to.qd, t: from.t + part * h });
            std::array::from_fn(|k| rows.J.blocks[at + k])
        };
        let (mut low, mut high) = (0.0, 1.0);
        let (mut at_low, mut at_high) = (gradient(low), gradient(high));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let at_middle = gradient(middle);
            let (first, second) = (cosine(at_low, at_middle), cosine(at_middle, at_high));
            if first > SMOOTH && second > SMOOTH {
                return false;
            }
            if first <= second {
                (high, at_high) = (middle, at_middle);
            } else {
                (low, at_low) = (middle, at_middle);
            }
        }
        let left = size(&at_low).max(size(&at_high));
        !left.is_finite() || left > VANISHED * scale
    }
}

/// Whether one block of a gradient has turned far, or been lost.
fn has_turned<const D: usize>(then: Point<D>, now: Point<D>) -> bool {
    let (then_now, then, now) = (dot(then, now), dot(then, then), dot(now, now));
    if then.is_nan() || then <= 0.0 {
        return false;
    }
    now.is_nan() || now <= 0.0 || then_now < 0.0 && then_now * then_now > TURNED * TURNED * then * now
}

/// The cosine between two blocks; −1 where one of them is lost.
fn cosine<const D: usize>(a: Point<D>, b: Point<D>) -> f64 {
    let (along, product) = (dot(a, b), dot(a, a) * dot(b, b));
    if product > 0.0 {
        along / product.sqrt()
    } else if dot(a, a) == 0.0 && dot(b, b) == 0.0 {
        1.0
    } else {
        -1.0
    }
}

/// max |x_i|; infinite if one is not a number.
fn size(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| if x.is_nan() { f64::INFINITY } else { most.max(x.abs()) })
}
