//! The motion of the reference: extrapolation of the modified midpoint rule, with a projection after each step.
//!
//! The rule with n substeps has an error in even powers of 1/n, so that the results for n = 2, 4, 6, … extrapolate to
//! 1/n = 0 by Neville's scheme; the last difference in the scheme is the estimate of the error.
//!
//! Source: Gragg (1965); Bulirsch, Stoer, Numerical treatment of ordinary differential equations by extrapolation
//! methods (1966); Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I (1993), II.9.

use crate::dense::largest;
use crate::reference::Reference;

/// The most columns of the scheme: order 16.
const COLUMNS: usize = 8;
/// The largest error of a step, relative to the sizes of positions and velocities [1].
const TOLERANCE: f64 = 1e-12;
/// The most evaluations of a motion. A motion that needs more is not compared, so that no seed holds up a test run.
const MOST_EVALUATIONS: usize = 20_000;

/// A state on the way.
#[derive(Clone, Debug)]
pub struct Moment {
    /// q \[m\].
    pub q: Vec<f64>,
    /// q̇ [m/s].
    pub qd: Vec<f64>,
    /// t \[s\].
    pub t: f64,
}

/// The state after a duration \[s\]; `None` where that takes more work than is allowed, or the motion is not finite.
pub fn advance(reference: &Reference, start: &Moment, duration: f64) -> Option<Moment> {
    let mut now = start.clone();
    let end = start.t + duration;
    let mut h = duration / 4.0;
    let mut evaluations = 0;
    while now.t < end {
        // The last step ends at the end, and none before it is so short that roundoff of t counts.
        let last = now.t + 1.01 * h >= end;
        let length = if last { end - now.t } else { h };
        let (next, columns) = step(reference, &now, length, &mut evaluations);
        if evaluations > MOST_EVALUATIONS {
            return None;
        }
        match next {
            Some(mut next) => {
                reference.project(&mut next.q, &mut next.qd, next.t);
                if last {
                    next.t = end;
                }
                now = next;
                if columns < COLUMNS - 1 {
                    h = 1.5 * length.max(h);
                }
            }
            None => h = 0.4 * length,
        }
    }
    now.q.iter().chain(&now.qd).all(|x| x.is_finite()).then_some(now)
}

/// One step, and the number of columns that it took; `None` where the columns do not suffice.
fn step(reference: &Reference, now: &Moment, h: f64, evaluations: &mut usize) -> (Option<Moment>, usize) {
    let count = now.q.len();
    let mut table: Vec<Vec<f64>> = Vec::new();
    for column in 0..COLUMNS {
        let substeps = 2 * (column + 1);
        let mut row = vec![midpoint(reference, now, h, substeps)];
        *evaluations += substeps + 1;
        for k in 1..=column {
            let ratio = (substeps as f64 / (2 * (column - k + 1)) as f64).powi(2);
            let finer = row[k - 1].iter().zip(&table[k - 1]);
            row.push(finer.map(|(fine, coarse)| fine + (fine - coarse) / (ratio - 1.0)).collect());
        }
        if column >= 3 {
            let (best, former) = (&row[column], &row[column - 1]);
            let off = |range: std::ops::Range<usize>, size: f64| {
                let change: Vec<f64> = range.map(|i| best[i] - former[i]).collect();
                largest(&change) <= TOLERANCE * size
            };
            let extent = largest(&now.q).max(1e-3);
            // A system at rest is measured against the speed at which it would cross a part of itself within the step.
            let speed = largest(&now.qd).max(largest(&best[count..])).max(1e-3 * extent / h);
            if off(0..count, extent) && off(count..2 * count, speed) {
                let (q, qd) = best.split_at(count);
                return (Some(Moment { q: q.to_vec(), qd: qd.to_vec(), t: now.t + h }), column);
            }
        }
        table = row;
    }
    (None, COLUMNS)
}

/// The modified midpoint rule with an even number of substeps and Gragg's smoothing: q, then q̇.
fn midpoint(reference: &Reference, now: &Moment, h: f64, substeps: usize) -> Vec<f64> {
    let count = now.q.len();
    let small = h / substeps as f64;
    let slope = |y: &[f64], t: f64| {
        let (q, qd) = y.split_at(count);
        [qd.to_vec(), reference.accelerations(q, qd, t)].concat()
    };
    let plus = |y: &[f64], f: &[f64], h: f64| y.iter().zip(f).map(|(y, f)| y + h * f).collect::<Vec<f64>>();
    let mut before = [now.q.clone(), now.qd.clone()].concat();
    let mut y = plus(&before, &slope(&before, now.t), small);
    for i in 1..substeps {
        let next = plus(&before, &slope(&y, now.t + i as f64 * small), 2.0 * small);
        before = std::mem::replace(&mut y, next);
    }
    let end = plus(&before, &slope(&y, now.t + h), small);
    y.iter().zip(end).map(|(y, end)| 0.5 * (y + end)).collect()
}
