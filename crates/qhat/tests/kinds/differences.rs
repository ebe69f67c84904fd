//! The rows of every kind against differences: Ċ, J and C_t against those of C, γ against those of Ċ along the motion.

use super::can_be_driven;
use super::case::{LATER, slopes_in_time};
use super::cases::CASES;
use crate::systems::dense::{assert_all_close, largest, multiply};
use crate::systems::random::{Random, dimension};
use qhat::evaluate;
use std::collections::BTreeMap;

/// Random states tried for every case.
const STATES: usize = 40;

/// Step of the differences. Points are at least 0.8 m apart and speeds below 1 m/s, so the fifth derivatives are below
/// about 1e3 and the formula's error δ⁴ f⁽⁵⁾/30 below 1e-10; roundoff adds about ε|C|/δ = 1e-12.
const DELTA: f64 = 1e-3;
const TOLERANCE: f64 = 1e-9;
/// The fifth derivative of an angle at 0.8 m and 1 m/s, 5!/0.8⁵, is 400; gears multiply it by the turns of a wheel, at
/// most 12.
const TURNS_TOLERANCE: f64 = 1e-8;

/// f'(0) by the central difference of fourth order.
fn derivative(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [left2, left, right, right2] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * DELTA));
    let slope = |k: usize| (8.0 * (right[k] - left[k]) - (right2[k] - left2[k])) / (12.0 * DELTA);
    (0..left.len()).map(slope).collect()
}

/// q + τ v.
fn along(q: &[f64], v: &[f64], tau: f64) -> Vec<f64> {
    q.iter().zip(v).map(|(q, v)| q + tau * v).collect()
}

#[test]
fn every_kind_agrees_with_differences() {
    for case in CASES.iter().filter(|case| !case.one_sided) {
        let tolerance = if case.turns { TURNS_TOLERANCE } else { TOLERANCE };
        let at = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| case.system(LATER + k * DELTA));
        for (q, v) in case.states(&mut Random::new(5), STATES) {
            let at = |q: Vec<f64>, tau: f64| {
                let (system, state) = &at[((tau / DELTA).round() + 2.0) as usize];
                evaluate(system, &state.with_motion(q, v.clone()))
            };
            let check = |symbol: &str, actual: &[f64], slope: &[f64]| {
                assert_all_close(&format!("{}: {symbol}", case.name), actual, slope, tolerance);
            };
            let terms = at(q.clone(), 0.0);
            let J = terms.jacobian.to_dense();
            // A state near a place where C has no gradient would put the differences to the test, not the rows.
            assert!(largest(&J) < 20.0, "{}: {J:?}", case.name);

            check("Ċ", &terms.residual_rate, &derivative(|tau| at(along(&q, &v, tau), tau).residual));
            let Ct = slopes_in_time(&terms);
            check("C_t", &Ct, &derivative(|tau| at(q.clone(), tau).residual));
            check("γ", &terms.acceleration_bias, &derivative(|tau| at(along(&q, &v, tau), tau).residual_rate));
            for k in 0..q.len() {
                let axis: Vec<f64> = (0..q.len()).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
                let column: Vec<f64> = J.chunks(q.len()).map(|row| row[k]).collect();
                check("J", &column, &derivative(|tau| at(along(&q, &axis, tau), 0.0).residual));
            }
            if !case.is_driven() {
                // Roundoff of a sum over a particle's coordinates.
                assert!(largest(&Ct) < 1e-13, "{}: Ċ is not J q̇: {Ct:?}", case.name);
                // J moves with q while q̇ is kept.
                let J_rate = derivative(|tau| at(along(&q, &v, tau), 0.0).jacobian.to_dense());
                check("γ = J̇ q̇", &terms.acceleration_bias, &multiply(&J_rate, &v));
            }
        }
    }
}

/// A C_t that is zero in every case agrees with every difference, whatever its sign.
#[test]
fn every_kind_that_can_be_driven_is_driven_in_some_case() {
    let mut fastest: BTreeMap<&str, f64> = BTreeMap::new();
    for case in CASES {
        let constraints = case.constraints(LATER);
        let (system, state) = case.system(LATER);
        let Ct = slopes_in_time(&evaluate(&system, &state));
        for (named, constraint) in system.constraints().iter().zip(&constraints) {
            let m = constraint.residual(dimension(case.d), state.positions()).len();
            let rows = named.first_row..named.first_row + m;
            let most = fastest.entry(constraint.kind()).or_default();
            *most = most.max(largest(&Ct[rows]));
        }
    }
    let can_be = can_be_driven();
    for (kind, fastest) in fastest {
        if can_be.contains(kind) {
            assert!(
                fastest > 1e-3,
                "{kind} holds a number or a point that may be driven, and no case of tests/kinds/cases.rs drives it: \
                 add one with `driven(…)` and `t.s()` or `t.of(…)`"
            );
        }
    }
}
