//! The stage equations of one step, and Newton's method for them.
//!
//! ```text
//! q_i = q₀ + h Σ_j a_ij q̇_j
//! M (q̇_i − q̇₀) = h Σ_j a_ij (Q_j + J_jᵀ λ_j)
//! J_i q̇_i + C_t,i = 0
//! ```
//!
//! Unknowns are z_i = (q̇_i − q̇₀, λ_i). With w = T⁻¹ z and κ = γ/h or (α − i β)/h, each iteration solves
//!
//! ```text
//! M + B/κ + K/κ²   Jᵀ        Δw             f/κ − M w          f = (T⁻¹ (Q + Jᵀ λ)) of its part
//! J + J̇/κ          0     ·  −Δλ/κ    =     −g                  g = (T⁻¹ (J q̇ + C_t)) of its part
//! ```
//!
//! with a matrix of this step or an earlier one. The rate of convergence is the ratio of two changes. The iteration
//! ends where the rate shows that all further changes add up to less than the tolerance (Hairer and Wanner, IV.8).

use super::factors::Factors;
use super::saddle::Saddle;
use super::tableau::{A, C, PAIR, REAL, T, T_INVERSE, combine};
use crate::constraint::Rows;
use crate::integrate::adaptive::pair::reference_speed;
use crate::linalg::{Complex, Scalar};
use crate::point::{Motion, largest};
use crate::settings::Settings;
use crate::state::State;
use crate::system::System;

/// Most iterations of one step. Changes that halve gain two digits in as many; a new matrix, or half the step, is then
/// cheaper.
pub(super) const MOST_ITERATIONS: usize = 8;

/// The error that the iteration may leave, in tolerances; √tolerance where that is less.
const LEFT: f64 = 0.03;

/// The error that the iteration may leave at most, in constraint tolerances: a method of order 5 with an estimate of
/// order 3 is more accurate than its tolerance, and the iteration must not spoil that.
const LEFT_OF_CONSTRAINTS: f64 = 1e4;

/// Rounding of a force or of its effect on a position, relative to its size: enough for the terms of some ten forces.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The step being tried: from a state over h, to the time `end`.
#[derive(Clone, Copy)]
pub(super) struct Step<'a> {
    pub(super) system: &'a System,
    pub(super) settings: &'a Settings,
    pub(super) state: &'a State,
    pub(super) h: f64,
    pub(super) end: f64,
}

impl Step<'_> {
    pub(super) fn time(&self, i: usize) -> f64 {
        if i == 2 { self.end } else { self.state.t + C[i] * self.h }
    }
}

/// How the iteration ended.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Convergence {
    pub(super) is_met: bool,
    pub(super) iterations: usize,
    /// The ratio of the last two changes.
    pub(super) rate: f64,
}

/// Numbers of the stages, one array for each stage.
pub(super) type OfStages = [Vec<f64>; 3];

/// The arrays of one step. Those of `OfStages` have one number for each unknown: velocities, then multipliers.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// z.
    pub(super) z: OfStages,
    w: OfStages,
    /// (Q + Jᵀ λ, J q̇ + C_t) of each stage; then Δw, the complex part as re and im.
    f: OfStages,
    /// The motion of one stage, as d·n numbers each, and its forces.
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    Q: Vec<f64>,
    pub(super) rows: Rows,
    /// λ of one stage, by the rows of the system.
    pub(super) lambda: Vec<f64>,
    /// Whether any row was ever seen to move with time.
    pub(super) is_driven: bool,
}

impl Stages {
    pub(super) fn new(system: &System, saddle: &Saddle) -> Self {
        let zeros = || std::array::from_fn(|_| vec![0.0; saddle.unknowns()]);
        let n = system.coordinate_count();
        Stages {
            z: zeros(),
            w: zeros(),
            f: zeros(),
            q: vec![0.0; n],
            qd: vec![0.0; n],
            Q: vec![0.0; n],
            rows: system.empty_rows(),
            lambda: vec![0.0; system.all_row_count()],
            is_driven: false,
        }
    }

    /// Writes the motion of a stage: q_i, q̇_i and λ_i.
    pub(super) fn motion<const D: usize>(&mut self, step: &Step<'_>, saddle: &Saddle, i: usize) {
        let Stages { z, q, qd, lambda, .. } = self;
        let (state, h) = (step.state, step.h);
        q.copy_from_slice(&state.q);
        qd.copy_from_slice(&state.qd);
        for (node, id) in saddle.particle.iter().enumerate() {
            for k in 0..D {
                let (u, x) = (node * D + k, id.0 * D + k);
                let change = combine(&A[i], [z[0][u], z[1][u], z[2][u]]);
                q[x] += h * (C[i] * state.qd[x] + change);
                qd[x] += z[i][u];
            }
        }
        let multipliers = &z[i][saddle.velocities()..];
        for (&row, multiplier) in saddle.rows.iter().zip(multipliers) {
            lambda[row] = *multiplier;
        }
    }

    /// C, Ċ and J at the motion at hand.
    pub(super) fn evaluate_rows<const D: usize>(&mut self, system: &System, t: f64) {
        system.evaluate_rows(Motion::<D> { q: &self.q, qd: &self.qd, t }, &mut self.rows);
    }

    /// Writes Q + Jᵀ λ over the nodes and J q̇ + C_t over the rows at the motion at hand, and evaluates its rows.
    pub(super) fn evaluate<const D: usize>(&mut self, system: &System, saddle: &Saddle, t: f64, out: usize) {
        let Stages { f, q, qd, Q, rows, lambda, is_driven, .. } = self;
        let motion = Motion::<D> { q, qd, t };
        system.evaluate_rows(motion, rows);
        system.add_forces(motion, &[], Q);
        let (forces, rates) = f[out].split_at_mut(saddle.velocities());
        for (force, id) in forces.chunks_exact_mut(D).zip(&saddle.particle) {
            force.copy_from_slice(&Q[id.0 * D..][..D]);
        }
        for (i, (&row, rate)) in saddle.rows.iter().zip(rates).enumerate() {
            *rate = rows.J.multiply_row::<D>(row, qd) + rows.Ct[row];
            *is_driven |= rows.Ct[row] != 0.0;
            for &(node, entry) in saddle.touched(i) {
                let g = rows.J.entry::<D>(entry);
                for (force, g) in forces[node * D..][..D].iter_mut().zip(g) {
                    *force += lambda[row] * g;
                }
            }
        }
    }

    /// The result of the last `evaluate` into this place.
    pub(super) fn evaluated(&self, place: usize) -> &[f64] {
        &self.f[place]
    }

    /// Takes z = 0 with these multipliers as the first guess.
    pub(super) fn guess_rest(&mut self, saddle: &Saddle, lambda: &[f64]) {
        for z in &mut self.z {
            let (velocities, multipliers) = z.split_at_mut(saddle.velocities());
            velocities.fill(0.0);
            for (multiplier, &row) in multipliers.iter_mut().zip(&saddle.rows) {
                *multiplier = lambda[row];
            }
        }
    }

    /// Takes the polynomials of the step before as the first guess, beyond the end of that step. `ratio` is h over the
    /// length of that step.
    pub(super) fn guess_onwards(&mut self, saddle: &Saddle, before: &[f64], ratio: f64) {
        let (n, velocities) = (saddle.unknowns(), saddle.velocities());
        for i in 0..3 {
            let x = 1.0 + C[i] * ratio;
            // Velocities go through zero at the start of that step, multipliers have no value there.
            let of_velocity: [f64; 3] = std::array::from_fn(|j| x / C[j] * lagrange(j, x));
            let of_multiplier: [f64; 3] = std::array::from_fn(|j| lagrange(j, x));
            for u in 0..n {
                let [one, two, three] = [before[u], before[n + u], before[2 * n + u]];
                self.z[i][u] = if u < velocities {
                    combine(&of_velocity, [one, two, three]) - three
                } else {
                    combine(&of_multiplier, [one, two, three])
                };
            }
        }
    }

    /// The speed to which errors of velocities are relative [m/s], by the fastest particle at the start and the end.
    pub(super) fn speed(&self, step: &Step<'_>, saddle: &Saddle) -> f64 {
        let mut fastest = largest(&step.state.qd);
        let dimension = step.system.dimension();
        for (node, id) in saddle.particle.iter().enumerate() {
            for k in 0..dimension {
                let v = step.state.qd[id.0 * dimension + k] + self.z[2][node * dimension + k];
                fastest = fastest.max(v.abs());
            }
        }
        reference_speed(step.system, fastest, step.h)
    }

    /// Newton's method from the guess in z. `scale` multiplies the root mean square of a change of velocities to an
    /// error in the unit of the tolerance.
    pub(super) fn solve<const D: usize>(
        &mut self,
        step: &Step<'_>,
        saddle: &Saddle,
        factors: &mut Factors,
        scale: impl Fn(&Self) -> f64,
    ) -> Convergence {
        let (h, velocities) = (step.h, saddle.velocities());
        let (real, per_pair) = (h / REAL, PAIR.reciprocal() * Complex::real(h));
        let pair = Complex { re: PAIR.re / h, im: PAIR.im / h };
        let tolerance = step.settings.tolerance;
        let of_constraints = LEFT_OF_CONSTRAINTS * step.settings.constraint_tolerance;
        let enough = (tolerance * LEFT.min(tolerance.sqrt())).min(of_constraints);
        for u in 0..saddle.unknowns() {
            let z = [self.z[0][u], self.z[1][u], self.z[2][u]];
            for k in 0..3 {
                self.w[k][u] = combine(&T_INVERSE[k], z);
            }
        }
        let mut found = Convergence::default();
        let mut last = 0.0;
        while found.iterations < MOST_ITERATIONS {
            for i in 0..3 {
                self.motion::<D>(step, saddle, i);
                self.evaluate::<D>(step.system, saddle, step.time(i), i);
            }
            for u in 0..saddle.unknowns() {
                let f = [self.f[0][u], self.f[1][u], self.f[2][u]];
                let [one, re, im] = [0, 1, 2].map(|k| combine(&T_INVERSE[k], f));
                let rhs = if u < velocities {
                    let m = saddle.mass[u / D];
                    let both = per_pair * Complex { re, im };
                    [real * one - m * self.w[0][u], both.re - m * self.w[1][u], both.im - m * self.w[2][u]]
                } else {
                    [-one, -re, -im]
                };
                (0..3).for_each(|k| self.f[k][u] = rhs[k]);
            }
            let [one, re, im] = &mut self.f;
            factors.solve(saddle, one);
            factors.solve_pair(saddle, re, im);
            // The multipliers come out as −Δλ/κ.
            for u in velocities..saddle.unknowns() {
                let both = pair * Complex { re: re[u], im: im[u] };
                (one[u], re[u], im[u]) = (-one[u] / real, -both.re, -both.im);
            }
            let scale = scale(self);
            let size = scale * self.change(velocities, step.system.coordinate_count());
            let rounding = ROUNDING * (1.0 + scale * largest(&step.state.q) / h);
            let enough = enough.max(rounding);
            let has_arrived = size <= rounding;
            if found.iterations > 0 && !has_arrived {
                found.rate = size / last;
                let ahead = (found.iterations..MOST_ITERATIONS).fold(1.0, |product, _| product * found.rate);
                // The negation also holds for what is not a number.
                if !(found.rate < 1.0 && ahead / (1.0 - found.rate) * size <= enough) {
                    return found;
                }
            }
            for u in 0..saddle.unknowns() {
                let w: [f64; 3] = std::array::from_fn(|k| self.w[k][u] + self.f[k][u]);
                for k in 0..3 {
                    self.w[k][u] = w[k];
                    self.z[k][u] = combine(&T[k], w);
                }
            }
            found.iterations += 1;
            if has_arrived || (found.iterations > 1 && found.rate / (1.0 - found.rate) * size <= enough) {
                found.is_met = true;
                return found;
            }
            if !size.is_finite() {
                return found;
            }
            last = size;
        }
        found
    }

    /// The root mean square of the change of the velocities of all stages, which lies in f as Δw.
    fn change(&self, velocities: usize, coordinates: usize) -> f64 {
        let mut sum = 0.0;
        for u in 0..velocities {
            let w = [self.f[0][u], self.f[1][u], self.f[2][u]];
            for row in &T {
                let change = combine(row, w);
                sum += change * change;
            }
        }
        (sum / (3 * coordinates.max(1)) as f64).sqrt()
    }
}

/// The j-th Lagrange polynomial of the three nodes c at x.
fn lagrange(j: usize, x: f64) -> f64 {
    (0..3).filter(|&k| k != j).fold(1.0, |product, k| product * (x - C[k]) / (C[j] - C[k]))
}
