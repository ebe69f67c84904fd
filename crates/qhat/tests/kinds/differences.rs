//! The rows of every kind against differences: Ċ, J and C_t against differences of C, γ against differences of Ċ along
//! the motion.

use super::case::{LATER, slopes_in_time};
use super::cases::CASES;
use super::motion::curve;
use crate::systems::dense::{assert_all_close, assert_close, largest, multiply};
use crate::systems::random::{Random, dimension};
use qhat::{Curve, OnCurve, Particle, State, System, Terms, evaluate};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Random states tried for every case.
const STATES: usize = 40;

/// Step of the differences. Points are at least 0.8 m apart and speeds below 1 m/s, so the fifth derivatives are below
/// about 1e3 and the formula's error δ⁴ f⁽⁵⁾/30 below 1e-10; roundoff adds about ε|C|/δ = 1e-12.
const DELTA: f64 = 1e-3;
const TOLERANCE: f64 = 1e-9;
/// The fifth derivative of an angle at 0.8 m and 1 m/s, 5!/0.8⁵, is 400; gears multiply it by the turns of a wheel, at
/// most 12.
const TURNS_TOLERANCE: f64 = 1e-8;

/// A bead moves by 2 mm at most around its place, along arcs of 0.3 m: δ⁴ f⁽⁵⁾/30 with f⁽⁵⁾ = 4!/0.3⁴ is 1e-10, and ten
/// times that for the sums of a spline.
const WIRE_TOLERANCE: f64 = 1e-8;

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

/// Compares the rows of `at(q, τ)`, the terms at positions q and the velocities v at the time τ, with their
/// differences.
fn compare(name: &str, tolerance: f64, q: &[f64], v: &[f64], at: impl Fn(Vec<f64>, f64) -> Terms) {
    let check = |symbol: &str, actual: &[f64], slope: &[f64]| {
        assert_all_close(&format!("{name}: {symbol}"), actual, slope, tolerance);
    };
    let terms = at(q.to_vec(), 0.0);
    let J = terms.jacobian.to_dense();
    // Near a position where C has no gradient the differences would be inaccurate, not the rows.
    assert!(largest(&J) < 20.0, "{name}: {J:?}");
    check("Ċ", &terms.residual_rate, &derivative(|tau| at(along(q, v, tau), tau).residual));
    check("C_t", &slopes_in_time(&terms), &derivative(|tau| at(q.to_vec(), tau).residual));
    check("γ", &terms.acceleration_bias, &derivative(|tau| at(along(q, v, tau), tau).residual_rate));
    for k in 0..q.len() {
        let axis: Vec<f64> = (0..q.len()).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
        let column: Vec<f64> = J.chunks(q.len()).map(|row| row[k]).collect();
        check("J", &column, &derivative(|tau| at(along(q, &axis, tau), 0.0).residual));
    }
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
            compare(case.name, tolerance, &q, &v, at);
            if !case.is_driven() {
                let terms = at(q.clone(), 0.0);
                // Roundoff of a sum over a particle's coordinates.
                let Ct = slopes_in_time(&terms);
                assert!(largest(&Ct) < 1e-13, "{}: Ċ is not J q̇: {Ct:?}", case.name);
                // J changes with q while q̇ is constant.
                let J_rate = derivative(|tau| at(along(&q, &v, tau), 0.0).jacobian.to_dense());
                let name = format!("{}: γ = J̇ q̇", case.name);
                assert_all_close(&name, &terms.acceleration_bias, &multiply(&J_rate, &v), tolerance);
            }
        }
    }
}

/// A bead at a point of the d-dimensional curve, moved by `off`, with random velocities; compared as every kind is.
fn compare_wire(d: usize, curve: &Curve, s: f64, off: &[f64]) -> Terms {
    let mut builder = System::builder(dimension(d));
    let place: Vec<f64> = curve.point(s).iter().zip(off).map(|(c, off)| c + off).collect();
    let particle = builder.particle(Particle::at("bead", &place[..]));
    builder.constraint("wire", OnCurve { particle, curve: curve.clone() });
    let (system, start): (System, State) = builder.build().unwrap();
    let v = Random::new(5).numbers(d, -0.5, 0.5);
    let at = |q: Vec<f64>, _: f64| evaluate(&system, &start.with_motion(q, v.clone()));
    compare(&format!("wire at s = {s}"), WIRE_TOLERANCE, &place, &v, at);
    at(place, 0.0)
}

/// In space γ leaves out w·c‴, so it is exact on the wire; so is the foot on a spline.
#[test]
fn rows_of_a_wire_in_space_are_exact_on_the_wire() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2], [1.5, 2.0, -0.3], [0.2, 1.6, 0.1], [-0.8, 0.9, 0.5]];
    let helix = curve(&["cos(s)", "sin(s)", "0.2*s"], -7.0, 7.0);
    let spline = Curve::through(&points, true).unwrap();
    let bent = Curve::polyline(&points, 0.3, true).unwrap();
    for (curve, s) in
        [(&helix, -2.2), (&helix, 0.4), (&helix, 5.9), (&spline, 0.6), (&spline, 4.1), (&bent, 0.5), (&bent, 0.95)]
    {
        let terms = compare_wire(3, curve, s, &[0.0; 3]);
        // The position itself is rounded, hence 1e-15.
        terms.residual.iter().for_each(|C| assert_close("C on the wire", *C, 0.0, 1e-15));
    }
}

/// In the plane a wire of straight pieces and arcs is exact beside itself, too.
#[test]
fn rows_of_a_bent_wire_in_the_plane_are_exact_beside_the_wire() {
    let points = [[0.0; 3], [2.0, 0.0, 0.0], [2.5, 2.0, 0.0], [-1.0, 2.5, 0.0]];
    let curve = Curve::polyline(&points, 0.8, false).unwrap();
    // On a straight piece, on both arcs, and beyond the ends; up to 0.1 m to either side of an arc of 0.8 m.
    for (i, s) in [-1.0, 0.5, 1.9, 3.2, 7.0].into_iter().enumerate() {
        let off = Random::new(i as u64).numbers(2, -0.1, 0.1);
        compare_wire(2, &curve, s, &off);
    }
}

/// Every kind that can be driven has a case in which C_t is not zero. Otherwise a wrong sign of C_t would agree with
/// the differences.
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
            // A drive of the table changes C by some tenths a second.
            assert!(
                fastest > 1e-3,
                "{kind} holds a number or a point that may be driven, and no case of tests/kinds/cases.rs drives it: \
                 add one with `driven(…)` and `t.s()` or `t.of(…)`"
            );
        }
    }
}

/// The kinds whose fields hold a number or a point that time may change, as the source of the engine declares them.
fn can_be_driven() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/constraint");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let source: String = files.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(String::from).collect()
    };
    // Name of each public type, and the words up to the end of its declaration.
    let mut declared = Vec::new();
    for start in ["pub struct ", "pub enum ", "pub type "] {
        for rest in source.split(&format!("\n{start}")).skip(1) {
            let end = if start == "pub type " { ";" } else { "\n}" };
            let code: Vec<&str> =
                rest.split(end).next().unwrap().lines().filter(|line| !line.trim().starts_with("//")).collect();
            let mut words = words(&code.join("\n"));
            declared.push((words.remove(0), words));
        }
    }
    let mut driven = BTreeSet::from(["Driven".to_owned()]);
    loop {
        let more: Vec<String> = declared
            .iter()
            .filter(|(name, words)| !driven.contains(name) && words.iter().any(|word| driven.contains(word)))
            .map(|(name, _)| name.clone())
            .collect();
        if more.is_empty() {
            break;
        }
        driven.extend(more);
    }
    assert!(driven.contains("OnSphere") && !driven.contains("Distance"), "the search for fields found {driven:?}");
    driven
}
