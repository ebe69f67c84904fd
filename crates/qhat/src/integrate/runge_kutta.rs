//! Explicit Runge–Kutta methods on the equation itself: λ is solved for at every stage.
//!
//! ```text
//! q_i = q + h Σ_{j<i} a_ij q̇_j,   q̇_i = q̇ + h Σ_{j<i} a_ij k_j,   k_i = q̈(q_i, q̇_i, t + c_i h)
//! q'  = q + h Σ b_i q̇_i,          q̇'  = q̇ + h Σ b_i k_i
//! ```
//!
//! The q̇_j are combinations of k themselves, so only the k are kept (Nyström's arrangement of the same method):
//!
//! ```text
//! q_i = q + h c_i q̇ + h² Σ_l (A²)_il k_l,   q' = q + h q̇ + h² Σ_l (bᵀA)_l k_l,   c_i = Σ_j a_ij
//! ```
//!
//! A pair adds weights e_i that estimate the local error, e = h Σ e_i (q̇_i, k_i), and is carried in substeps of its own
//! choosing with q' brought onto C = 0 and q̇' onto Ċ = 0 after each. That changes nothing of the order: q' misses C = 0 by
//! no more than the method's own error.

use super::field::{Field, Power};
use super::fixed::StepWork;
use crate::linalg::eight::{F8, Largest, Wide, vector_unit};
use crate::threads;
use pulp::{Simd, WithSimd};

/// Work for one thread [blocks]: some 20 µs, a hundred times what handing it over costs.
const SHARE: usize = 4096;

/// The square of a larger number [m or m/s] leaves the range of numbers in sums of a few: J and A are made of squares, and of
/// their products.
const OVERFLOW: f64 = 1e60;

/// Most stages of any method here.
pub(super) const STAGES: usize = 12;

/// One combination of the slopes: q + h c q̇ + h² Σ position_l k_l and q̇ + h Σ velocity_l k_l.
#[derive(Clone, Copy, Debug)]
pub(super) struct Combination {
    c: f64,
    position: [f64; STAGES],
    velocity: [f64; STAGES],
}

/// A method: where each stage lies, and where the step ends.
#[derive(Debug)]
pub(super) struct Tableau {
    pub(super) stages: usize,
    a: [[f64; STAGES]; STAGES],
    at: [Combination; STAGES],
    end: Combination,
}

impl Tableau {
    /// From a, whose row i has i entries, and b.
    pub(super) const fn new(rows: &[&[f64]], b: &[f64]) -> Self {
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

    /// The combination with weights e: Σ e_i q̇_i and Σ e_i k_i, over h and with q left out.
    pub(super) const fn combination(&self, e: &[f64]) -> Combination {
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

/// A motion, the one that is tried from it, and the stages between.
#[derive(Clone, Debug, Default)]
pub(super) struct Stages {
    pub(super) q: Vec<F8>,
    pub(super) qd: Vec<F8>,
    pub(super) next_q: Vec<F8>,
    pub(super) next_qd: Vec<F8>,
    stage_q: Vec<F8>,
    stage_qd: Vec<F8>,
    slope: Vec<Vec<F8>>,
    power: [Power; STAGES],
    /// Whether the first slope is that of the motion at hand.
    pub(super) is_first_known: bool,
}

impl Stages {
    /// For so many blocks of eight numbers.
    pub(super) fn new(blocks: usize) -> Self {
        let array = || vec![F8::ZERO; blocks];
        Stages {
            q: array(),
            qd: array(),
            next_q: array(),
            next_qd: array(),
            stage_q: array(),
            stage_qd: array(),
            slope: vec![array(); STAGES],
            power: [Power::default(); STAGES],
            is_first_known: false,
        }
    }

    /// The same arrays for another number of blocks; nothing if it is the same.
    pub(super) fn resize(&mut self, blocks: usize) {
        if self.q.len() != blocks || self.slope.is_empty() {
            *self = Stages::new(blocks);
        }
        self.is_first_known = false;
    }

    /// Whether the substep tried last was so long that numbers lost their range on the way, although where it began all is
    /// finite: then a shorter one is worth trying.
    pub(super) fn overflow(&self) -> bool {
        let largest = |numbers: &[F8]| vector_unit().dispatch(Largest(numbers));
        let is_within = |numbers: &[F8]| largest(numbers) < OVERFLOW;
        let begins_well = self.is_first_known && [&self.q, &self.qd, &self.slope[0]].into_iter().all(|x| is_within(x));
        let ends_well = [&self.stage_q, &self.stage_qd].into_iter().all(|x| is_within(x));
        begins_well && !ends_well
    }

    /// What was tried becomes the motion at hand.
    pub(super) fn accept(&mut self) {
        std::mem::swap(&mut self.q, &mut self.next_q);
        std::mem::swap(&mut self.qd, &mut self.next_qd);
        self.is_first_known = false;
    }
}

/// Tries one step from t to t + h; `None` if the field cannot tell a slope.
pub(super) fn advance<F: Field>(
    tableau: &Tableau,
    field: &mut F,
    stages: &mut Stages,
    t: f64,
    h: f64,
) -> Option<StepWork> {
    let Stages { q, qd, next_q, next_qd, stage_q, stage_qd, slope, power, is_first_known } = stages;
    if !*is_first_known {
        power[0] = field.accelerate(q, qd, t, &mut slope[0])?;
        *is_first_known = true;
    }
    for i in 1..tableau.stages {
        let (known, rest) = slope.split_at_mut(i);
        let weights = &tableau.at[i];
        Combine { weights, h, q, qd, slope: known, first: 0, out_q: stage_q, out_qd: stage_qd }.write();
        power[i] = field.accelerate(stage_q, stage_qd, t + weights.c * h, &mut rest[0])?;
    }
    Combine { weights: &tableau.end, h, q, qd, slope, first: 0, out_q: next_q, out_qd: next_qd }.write();
    let mut work = StepWork::default();
    for (weight, power) in tableau.end.velocity.iter().zip(power).take(tableau.stages) {
        work.dissipation += weight * h * power.dissipation;
        work.stabilization += weight * h * power.stabilization;
        work.drives += weight * h * power.drives;
    }
    Some(work)
}

/// Writes the motion at one combination of the slopes.
struct Combine<'a> {
    weights: &'a Combination,
    h: f64,
    q: &'a [F8],
    qd: &'a [F8],
    slope: &'a [Vec<F8>],
    /// Where in each slope q begins.
    first: usize,
    out_q: &'a mut [F8],
    out_qd: &'a mut [F8],
}

impl WithSimd for Combine<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // Most tableaux have many zeros; what is left is gathered.
        let mut terms: [Term<'_>; STAGES] = [(&[], 0.0, 0.0); STAGES];
        let mut count = 0;
        for (j, slope) in self.slope.iter().enumerate() {
            let (position, velocity) = (self.weights.position[j], self.weights.velocity[j]);
            if position != 0.0 || velocity != 0.0 {
                terms[count] = (&slope[self.first..], self.h * self.h * position, self.h * velocity);
                count += 1;
            }
        }
        // With their number known, the loop over them is unrolled.
        macro_rules! of {
            ($($n:literal)*) => {
                match count {
                    $($n => self.sum::<S, $n>(simd, std::array::from_fn(|j| terms[j])),)*
                    _ => self.sum::<S, STAGES>(simd, terms),
                }
            };
        }
        of!(0 1 2 3 4 5 6 7 8 9 10 11)
    }
}

/// A slope with its weights in positions and in velocities.
type Term<'a> = (&'a [F8], f64, f64);

impl Combine<'_> {
    /// On several threads where there is much to do.
    #[inline(never)]
    fn write(self) {
        let half = self.q.len() / 2;
        if half < SHARE {
            return vector_unit().dispatch(self);
        }
        let Combine { weights, h, q, qd, slope, first, out_q, out_qd } = self;
        let ((q, rest_q), (qd, rest_qd)) = (q.split_at(half), qd.split_at(half));
        let ((out_q, rest_out_q), (out_qd, rest_out_qd)) = (out_q.split_at_mut(half), out_qd.split_at_mut(half));
        let one = Combine { weights, h, q, qd, slope, first, out_q, out_qd };
        let first = first + half;
        let (out_q, out_qd) = (rest_out_q, rest_out_qd);
        let other = Combine { weights, h, q: rest_q, qd: rest_qd, slope, first, out_q, out_qd };
        threads::both(|| one.write(), || other.write());
    }

    #[inline(always)]
    fn sum<S: Simd, const N: usize>(self, simd: S, terms: [Term<'_>; N]) {
        let blocks = self.q.len();
        let terms = terms.map(|(slope, position, velocity)| (&slope[..blocks], position, velocity));
        let (qd, out_q, out_qd) = (&self.qd[..blocks], &mut self.out_q[..blocks], &mut self.out_qd[..blocks]);
        let hc = self.h * self.weights.c;
        for k in 0..blocks {
            let v = Wide::load(simd, &qd[k]);
            let (mut position, mut velocity) = (hc * v, Wide::splat(simd, 0.0));
            for (slope, in_position, in_velocity) in terms {
                let slope = Wide::load(simd, &slope[k]);
                position = position + in_position * slope;
                velocity = velocity + in_velocity * slope;
            }
            (Wide::load(simd, &self.q[k]) + position).store(&mut out_q[k]);
            (v + velocity).store(&mut out_qd[k]);
        }
    }
}

/// Σ |e|² of positions and of velocities for two estimates at once, each over the coordinates that count.
pub(super) struct Squares<'a, F> {
    pub(super) estimates: [&'a Combination; 2],
    pub(super) field: &'a F,
    pub(super) stages: &'a Stages,
    pub(super) h: f64,
}

impl<F: Field> WithSimd for Squares<'_, F> {
    type Output = [f64; 4];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 4] {
        let Squares { estimates: [fine, coarse], field, stages: Stages { qd, slope, .. }, h } = self;
        let mut terms: [(&[F8], [f64; 4]); STAGES] = [(&[], [0.0; 4]); STAGES];
        let mut count = 0;
        for (j, slope) in slope.iter().enumerate() {
            let weights = [h * fine.position[j], fine.velocity[j], h * coarse.position[j], coarse.velocity[j]];
            if weights != [0.0; 4] {
                terms[count] = (&slope[..qd.len()], weights);
                count += 1;
            }
        }
        let mut sums = [Wide::splat(simd, 0.0); 4];
        for k in 0..qd.len() {
            let v = Wide::load(simd, &qd[k]);
            let mut e = [fine.c * v, Wide::splat(simd, 0.0), coarse.c * v, Wide::splat(simd, 0.0)];
            for (slope, weights) in &terms[..count] {
                let slope = Wide::load(simd, &slope[k]);
                for (e, weight) in e.iter_mut().zip(weights) {
                    *e = *e + *weight * slope;
                }
            }
            let counted = Wide::load(simd, &field.counted(k));
            for (sum, e) in sums.iter_mut().zip(e) {
                *sum = *sum + counted * (e * e);
            }
        }
        sums.map(Wide::stored).map(F8::sum)
    }
}

#[cfg(test)]
mod tests {
    use super::super::adaptive::{dop853, dopri5};
    use super::super::fixed::rk4;
    use super::*;
    use crate::chains::Projected;
    use crate::drift::Drift;
    use crate::settings::Settings;
    use crate::state::State;

    fn power(x: f64, exponent: i32) -> f64 {
        (0..exponent).map(|_| x).product()
    }

    /// q̈ = t^power: what a stage gets depends on nothing but the time it is handed.
    struct Clock {
        power: i32,
    }

    impl Field for Clock {
        fn blocks(&self) -> usize {
            1
        }

        fn begin(&mut self, _: &State, _: &mut [F8], _: &mut [F8]) {}

        fn end(&self, _: &[F8], _: &[F8], _: &mut State) {}

        fn accelerate(&mut self, _: &[F8], _: &[F8], t: f64, qdd: &mut [F8]) -> Option<Power> {
            qdd[0] = F8::splat(power(t, self.power));
            Some(Power::default())
        }

        fn project(&mut self, _: &mut [F8], _: &mut [F8], _: f64, _: &Settings) -> Projected {
            Projected::Met(0)
        }

        fn drift(&self, _: &[F8], _: &[F8]) -> Drift {
            Drift::default()
        }

        fn turn_back(&mut self) {}

        fn counted(&self, _: usize) -> F8 {
            F8::splat(1.0)
        }
    }

    /// A method of order p integrates t^(p−1) to q̇ and t^(p−2) to q without error, if its stages stand at t + c_i h.
    #[test]
    fn stages_stand_at_their_times() {
        let (t, h) = (0.7, 0.4);
        for (name, tableau, order) in
            [("rk4", &rk4::RK4, 4), ("dopri5", dopri5::DOPRI5.tableau(), 5), ("dop853", dop853::DOP853.tableau(), 8)]
        {
            for power in 0..order {
                let mut stages = Stages::new(1);
                advance(tableau, &mut Clock { power }, &mut stages, t, h).unwrap();
                let to = |p: i32| (self::power(t + h, p) - self::power(t, p)) / f64::from(p);
                // The tableaux are rounded, and a dozen terms of size one are added up.
                let allowed = 1e-14;
                let velocity = stages.next_qd[0].0[0];
                assert!((velocity - to(power + 1)).abs() < allowed, "{name}, t^{power}: q̇ = {velocity}");
                if power < order - 1 {
                    let expected = (to(power + 2) - h * self::power(t, power + 1)) / f64::from(power + 1);
                    let position = stages.next_q[0].0[0];
                    assert!((position - expected).abs() < allowed, "{name}, t^{power}: q = {position}");
                }
            }
        }
    }
}
