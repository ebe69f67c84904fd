//! Feet: where the beads are on their curves, so that each foot is sought near the last one.
//!
//! ```text
//! s*(q, t) is sought near s + ṡ (t − t₀)        s, ṡ: the foot and its rate at the start t₀ of the substep
//! ```
//!
//! s is part of the State, and a substep that is kept moves it on. So the rows are a function of q, t and the State,
//! and a restart gives the same bits.

use super::curve::CurveEnd;
use super::on_curve::Followed;
use super::{Constraint, OnCurve};
use crate::point::Motion;

/// The feet of all beads at the start of the substep, in the order of the constraints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Feet {
    /// The first row of each bead, ascending.
    rows: Vec<usize>,
    s: Vec<f64>,
    /// ṡ [1/s].
    rate: Vec<f64>,
    /// t₀ [s].
    t: f64,
}

impl Feet {
    pub(crate) fn is_empty(&self) -> bool {
        self.s.is_empty()
    }

    /// s of each bead.
    pub(crate) fn parameters(&self) -> &[f64] {
        &self.s
    }

    /// The bead of a constraint, with its foot expected at t. `None` if it is no bead, or if no foot is known.
    #[inline]
    pub(crate) fn bead<'a>(&self, constraint: &'a Constraint, first_row: usize, t: f64) -> Option<Followed<'a>> {
        if self.s.is_empty() {
            return None;
        }
        let Constraint::OnCurve(bead) = constraint else { return None };
        let place = self.rows.binary_search(&first_row).ok()?;
        Some(Followed { bead, near: Some(self.expected(place, t)) })
    }

    /// Where the foot of a bead is expected at t.
    fn expected(&self, place: usize, t: f64) -> f64 {
        self.s[place] + self.rate[place] * (t - self.t)
    }

    /// Moves the feet on to a motion that was kept.
    pub(crate) fn follow<const D: usize>(&mut self, beads: &[(usize, &OnCurve)], motion: Motion<'_, D>) {
        let from: Vec<f64> = (0..self.s.len()).map(|place| self.expected(place, motion.t)).collect();
        self.place(beads, motion, &from);
    }

    /// The first bead that is beyond an end of its curve at a motion, by its place, and the end.
    pub(crate) fn past_an_end<const D: usize>(
        &self,
        beads: &[(usize, &OnCurve)],
        motion: Motion<'_, D>,
    ) -> Option<(usize, CurveEnd)> {
        beads.iter().enumerate().find_map(|(place, (_, bead))| {
            let near = (!self.is_empty()).then(|| self.expected(place, motion.t));
            let (s, _) = bead.curve.parameter(motion.x(bead.particle), motion.v(bead.particle), near);
            Some((place, bead.curve.end_passed(s)?))
        })
    }

    /// Takes the feet of the beads at a motion, each near its parameter in `from`; the nearest where there is none.
    pub(crate) fn place<const D: usize>(&mut self, beads: &[(usize, &OnCurve)], motion: Motion<'_, D>, from: &[f64]) {
        self.t = motion.t;
        self.rows.clear();
        self.s.clear();
        self.rate.clear();
        for (place, &(row, bead)) in beads.iter().enumerate() {
            let near = from.get(place).copied();
            let (s, rate) = bead.curve.parameter(motion.x(bead.particle), motion.v(bead.particle), near);
            self.rows.push(row);
            self.s.push(s);
            self.rate.push(rate);
        }
    }
}
