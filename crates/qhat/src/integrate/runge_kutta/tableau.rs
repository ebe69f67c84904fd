//! Tableau: the coefficients of a method, arranged for slopes of second order.

/// Most stages of any method here.
pub(in crate::integrate) const STAGES: usize = 12;

/// One combination of the slopes: q + h c q̇ + h² Σ position_l k_l and q̇ + h Σ velocity_l k_l.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrate) struct Combination {
    pub(super) c: f64,
    pub(super) position: [f64; STAGES],
    pub(super) velocity: [f64; STAGES],
}

/// A method: the combination of slopes at each stage, and at the end of the step.
#[derive(Debug)]
pub(in crate::integrate) struct Tableau {
    pub(in crate::integrate) stages: usize,
    a: [[f64; STAGES]; STAGES],
    pub(super) at: [Combination; STAGES],
    pub(super) end: Combination,
}

impl Tableau {
    /// A method from its coefficients: a, whose row i has i entries, and b.
    pub(in crate::integrate) const fn new(rows: &[&[f64]], b: &[f64]) -> Self {
        let mut a = [[0.0; STAGES]; STAGES];
        let mut i = 0;
        while i < rows.len() {
            a[i] = padded(rows[i]);
            i += 1;
        }
        let end = combination(&a, padded(b));
        let mut at = [end; STAGES];
        let mut i = 0;
        while i < rows.len() {
            at[i] = combination(&a, a[i]);
            i += 1;
        }
        Tableau { stages: rows.len(), a, at, end }
    }

    /// The middle of the longest interval of a step without a stage, as a part of the step.
    pub(in crate::integrate) fn middle(&self) -> f64 {
        let mut times: Vec<f64> = self.at[..self.stages].iter().map(|at| at.c).collect();
        times.sort_by(f64::total_cmp);
        let longest = times.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        longest.map_or(0.5, |ends| 0.5 * (ends[0] + ends[1]))
    }

    /// The combination with weights e, for an error estimate: Σ e_i q̇_i and Σ e_i k_i, over h and without q.
    pub(in crate::integrate) const fn combination(&self, e: &[f64]) -> Combination {
        combination(&self.a, padded(e))
    }
}

const fn padded(weights: &[f64]) -> [f64; STAGES] {
    let mut padded = [0.0; STAGES];
    let mut j = 0;
    while j < weights.len() {
        padded[j] = weights[j];
        j += 1;
    }
    padded
}

const fn combination(a: &[[f64; STAGES]; STAGES], weights: [f64; STAGES]) -> Combination {
    let mut c = 0.0;
    let mut position = [0.0; STAGES];
    let mut j = 0;
    while j < STAGES {
        c += weights[j];
        let mut l = 0;
        while l < j {
            position[l] += weights[j] * a[j][l];
            l += 1;
        }
        j += 1;
    }
    Combination { c, position, velocity: weights }
}
