//! Every kind that is written as a residual, with or without its gradient: compares its rows with differences and with
//! the same constraint written as expressions.

use super::{
    Anchor, Constraint, Curve, Custom, Direction, Holds, Layout, Line, OnCircle, OnCurve, OnLine, OnPlane, OnSphere,
    Plane, Relation, Rows,
};
use crate::driven::Driven;
use crate::expression::{Expression, Purpose, Scope};
use crate::hyper::Hyper;
use crate::point::Motion;
use crate::space::{Dimension, ParticleId};
use crate::stiffness::Stiffness;

const PARTICLES: usize = 4;
/// A time at which no driven value is zero or extreme.
const T: f64 = 0.37;

fn dimension(d: usize) -> Dimension {
    if d == 2 { Dimension::Two } else { Dimension::Three }
}

fn expression(text: &str, purpose: Purpose, d: usize) -> Expression {
    let particle = |name: &str| ["a", "b", "c", "p"].iter().position(|known| *known == name).map(ParticleId);
    Expression::parse(text, &Scope::new(purpose, dimension(d), &particle))
        .unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn schedule(text: &str) -> Driven {
    expression(text, Purpose::Time, 2).into()
}

fn driven(x: &str, y: &str, z: &str) -> [Driven; 3] {
    [schedule(x), schedule(y), schedule(z)]
}

const A: ParticleId = ParticleId(0);
const B: ParticleId = ParticleId(1);
const OTHER: ParticleId = ParticleId(2);
const P: ParticleId = ParticleId(3);

/// A kind, the number of dimensions, the constraint, and its rows as expressions if they are short.
type Case = (&'static str, usize, Constraint, Vec<&'static str>);

fn cases() -> Vec<Case> {
    let point = || driven("sin(t)", "2*t", "0.3 - t^2");
    let turning = || driven("cos(3*t)", "sin(3*t)", "0.2 + t");
    let radius = || schedule("1 + 0.1*sin(5*t)");
    let wave = [expression("s", Purpose::Curve, 2), expression("0.3*sin(2*s)", Purpose::Curve, 2)];
    vec![
        (
            "center of mass",
            2,
            Relation::center_of_mass([(A, 1.0), (B, 2.0), (P, 1.0)], point()).into(),
            vec!["0.25*a.x + 0.5*b.x + 0.25*p.x - sin(t)", "0.25*a.y + 0.5*b.y + 0.25*p.y - 2*t"],
        ),
        ("driven", 3, Relation::driven(P, point()).into(), vec!["p.x - sin(t)", "p.y - 2*t", "p.z - 0.3 + t^2"]),
        ("direction", 2, Direction { a: A, b: B, along: turning() }.into(), vec!["cross([cos(3*t), sin(3*t)], b - a)"]),
        ("direction in space", 3, Direction { a: A, b: B, along: turning() }.into(), vec![]),
        (
            "on a driven line",
            2,
            OnLine { particle: P, line: Line::Through(point(), turning()) }.into(),
            vec!["cross([cos(3*t), sin(3*t)], p - [sin(t), 2*t])"],
        ),
        (
            "on a driven line in space",
            3,
            OnLine { particle: P, line: Line::Through(point(), turning()) }.into(),
            vec![],
        ),
        ("on a line of particles", 2, OnLine::through(P, A, B).into(), vec!["cross(b - a, p - a)/dist(a, b)"]),
        ("on a line of particles in space", 3, OnLine::through(P, A, B).into(), vec![]),
        (
            "on a driven plane",
            3,
            OnPlane { particle: P, plane: Plane::Across(point(), turning()) }.into(),
            vec![
                "dot([cos(3*t), sin(3*t), 0.2 + t], p - [sin(t), 2*t, 0.3 - t^2])\
                 /length([cos(3*t), sin(3*t), 0.2 + t])",
            ],
        ),
        (
            "on a plane of particles",
            3,
            OnPlane::through(P, [A, B, OTHER]).into(),
            vec!["dot(cross(b - a, c - a), p - a)/length(cross(b - a, c - a))"],
        ),
        ("driven rod", 3, OnSphere::new(P, A, radius()).into(), vec!["dist(p, a) - 1 - 0.1*sin(5*t)"]),
        (
            "on a driven sphere",
            2,
            OnSphere::new(P, Anchor::Point(point()), radius()).into(),
            vec!["dist(p, [sin(t), 2*t]) - 1 - 0.1*sin(5*t)"],
        ),
        (
            "on a circle",
            3,
            OnCircle::new(P, A, [1.0, 2.0, 2.0], radius()).into(),
            vec!["dot([1, 2, 2], p - a)/3", "dist(p, a) - 1 - 0.1*sin(5*t)"],
        ),
        (
            "on a curve",
            2,
            OnCurve { particle: P, curve: Curve::parametric(wave.to_vec(), -3.0, 3.0).unwrap() }.into(),
            vec![],
        ),
        (
            "custom",
            2,
            Custom::new([P, A], |x: &[[Hyper; 3]], t: Hyper| (x[0][0] - x[1][0]).hypot(x[0][1] - x[1][1] * t.exp()))
                .into(),
            vec!["sqrt((p.x - a.x)^2 + (p.y - a.y*exp(t))^2)"],
        ),
        (
            "custom in space",
            3,
            Custom::new([B, P, A], |x: &[[Hyper; 3]], t: Hyper| {
                (x[0][2] * x[1][0]).sin() + x[2][1] * (t - x[1][1]) + x[0][0].powi(3) * x[2][2]
            })
            .into(),
            vec!["sin(b.z*p.x) + a.y*(t - p.y) + b.x^3*a.z"],
        ),
    ]
}

/// Pseudo-random numbers in [−1, 1].
fn numbers(count: usize, seed: u64) -> Vec<f64> {
    let mut bits = seed;
    let mut next = || {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

/// Pseudo-random positions, no three of them nearly in line.
fn places<const D: usize>(seed: u64) -> Vec<f64> {
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.3, 0.5], [0.5, 2.0, 1.0], [-1.0, 1.5, 2.0]];
    let apart = numbers(PARTICLES * D, seed);
    apart.iter().enumerate().map(|(i, x)| corners[i / D][i % D] + 0.3 * x).collect()
}

struct Evaluated {
    C: Vec<f64>,
    Cd: Vec<f64>,
    gamma: Vec<f64>,
    Ct: Vec<f64>,
    J: Vec<f64>,
}

fn evaluated<const D: usize>(constraint: &Constraint, q: &[f64], qd: &[f64], t: f64) -> Evaluated {
    let mut rows = Rows::new(Layout::new([constraint].into_iter(), D), D, PARTICLES);
    rows.evaluate::<D>([constraint].into_iter(), Motion { q, qd, t });
    let Rows { C, Cd, gamma, Ct, J } = rows;
    Evaluated { C, Cd, gamma, Ct, J: J.to_dense() }
}

/// q + τ q̇.
fn moved(q: &[f64], qd: &[f64], tau: f64) -> Vec<f64> {
    q.iter().zip(qd).map(|(x, v)| x + tau * v).collect()
}

fn close(what: &str, actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len(), "{what}");
    for (a, e) in actual.iter().zip(expected) {
        assert!((a - e).abs() <= tolerance, "{what}: {actual:?} {expected:?}");
    }
}

/// Central differences over ±1e-5 are good to h² f‴/6, 2e-11 times a third derivative of some hundreds, and to ε/h =
/// 1e-11. The comparison with expressions is much closer.
const H: f64 = 1e-5;
const GOOD: f64 = 3e-7;

fn slope(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(one, other)| (one - other) / (2.0 * H)).collect()
}

fn against_differences<const D: usize>(name: &str, constraint: &Constraint, q: &[f64], qd: &[f64]) {
    let at = evaluated::<D>(constraint, q, qd, T);
    let along = |tau: f64| evaluated::<D>(constraint, &moved(q, qd, tau), qd, T + tau);
    close(&format!("{name}: rate"), &at.Cd, &slope(&along(H).C, &along(-H).C), GOOD);
    close(&format!("{name}: gamma"), &at.gamma, &slope(&along(H).Cd, &along(-H).Cd), GOOD);
    let later = |tau: f64| evaluated::<D>(constraint, q, qd, T + tau).C;
    close(&format!("{name}: time"), &at.Ct, &slope(&later(H), &later(-H)), GOOD);

    // −λ ∂²C/∂q² against differences of Jᵀλ, and J against differences of C.
    let n = q.len();
    let lambda = numbers(at.C.len(), 5);
    let mut stiffness = vec![0.0; n * n];
    let particles = constraint.particles();
    constraint.geometric_stiffness::<D>(Motion { q, qd, t: T }, &lambda, &mut |i, j, block| {
        let Stiffness::Indefinite(block) = block else { panic!("{name}: a sign is known") };
        for (k, row) in block.iter().enumerate() {
            for (l, entry) in row.iter().enumerate() {
                let (row, column) = (particles[i].0 * D + k, particles[j].0 * D + l);
                stiffness[row * n + column] += entry;
                if i < j {
                    stiffness[column * n + row] += entry;
                }
            }
        }
    });
    for j in 0..n {
        let axis: Vec<f64> = (0..n).map(|k| if k == j { 1.0 } else { 0.0 }).collect();
        let shifted = |tau: f64| evaluated::<D>(constraint, &moved(q, &axis, tau), qd, T);
        let (one, other) = (shifted(H), shifted(-H));
        let column: Vec<f64> = at.J.iter().skip(j).step_by(n).copied().collect();
        close(&format!("{name}: J"), &column, &slope(&one.C, &other.C), GOOD);
        let turn = slope(&one.J, &other.J);
        let pull: Vec<f64> =
            (0..n).map(|i| -lambda.iter().enumerate().map(|(row, l)| l * turn[row * n + i]).sum::<f64>()).collect();
        close(&format!("{name}: stiffness"), &stiffness[j * n..][..n], &pull, GOOD);
    }
}

fn against_expressions<const D: usize>(name: &str, constraint: &Constraint, texts: &[&str], q: &[f64], qd: &[f64]) {
    let at = evaluated::<D>(constraint, q, qd, T);
    // Roundoff of some dozens of operations on numbers up to 20.
    let roundoff = 3e-13;
    for (row, text) in texts.iter().enumerate() {
        let twin = expression(text, Purpose::Constraint, D);
        let mut blocks = vec![0.0; twin.gradient_len()];
        let (jet, Ct) = twin.jet_and_gradient(q, qd, T, &mut blocks);
        let mut J = vec![0.0; q.len()];
        for (particle, block) in twin.particles().iter().zip(blocks.chunks(D)) {
            J[particle.0 * D..][..D].copy_from_slice(block);
        }
        let ours = [at.C[row], at.Cd[row], at.gamma[row], at.Ct[row]];
        close(&format!("{name}: typed"), &ours, &[jet.value, jet.first, jet.second, Ct], roundoff);
        close(&format!("{name}: J as typed"), &at.J[row * q.len()..][..q.len()], &J, roundoff);
    }
}

fn check<const D: usize>((name, _, constraint, texts): &Case) {
    for seed in 1..=5 {
        let (mut q, qd) = (places::<D>(seed), numbers(PARTICLES * D, seed + 100));
        if let Constraint::OnCurve(OnCurve { curve, .. }) = constraint {
            // Beside the wire, well within its radius of curvature, 0.8 m.
            let on = curve.point(q[P.0 * D]);
            (0..D).for_each(|k| q[P.0 * D + k] = on[k] + 0.1 * qd[k]);
        }
        against_differences::<D>(name, constraint, &q, &qd);
        against_expressions::<D>(name, constraint, texts, &q, &qd);
    }
}

#[test]
fn rows_are_what_differences_and_expressions_say() {
    for case in &cases() {
        if case.1 == 2 { check::<2>(case) } else { check::<3>(case) }
    }
}

/// In space γ and the stiffness of a wire leave out w·c‴, so they are exact on the wire; so is the foot of a spline.
#[test]
fn rows_of_a_wire_in_space_are_exact_on_it() {
    let texts = ["cos(s)", "sin(s)", "0.2*s"];
    let helix = Curve::parametric(texts.map(|text| expression(text, Purpose::Curve, 3)).to_vec(), -7.0, 7.0).unwrap();
    let points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2], [1.5, 2.0, -0.3], [0.2, 1.6, 0.1], [-0.8, 0.9, 0.5]];
    let spline = Curve::through(&points, true).unwrap();
    let bent = Curve::polyline(&points, 0.3, true).unwrap();
    let places =
        [(&helix, -2.2), (&helix, 0.4), (&helix, 5.9), (&spline, 0.6), (&spline, 4.1), (&bent, 0.5), (&bent, 0.95)];
    for (curve, at) in places {
        let constraint = Constraint::from(OnCurve { particle: P, curve: curve.clone() });
        let (mut q, qd) = (numbers(PARTICLES * 3, 1), numbers(PARTICLES * 3, 2));
        q[P.0 * 3..].copy_from_slice(&curve.point(at));
        against_differences::<3>("wire", &constraint, &q, &qd);
        // The position itself is rounded, hence 1e-15.
        close("wire: C", &evaluated::<3>(&constraint, &q, &qd, T).C, &[0.0, 0.0], 1e-15);
    }
}

/// In the plane a wire of straight pieces and arcs is exact beside itself, too.
#[test]
fn rows_of_a_bent_wire_are_exact_beside_it() {
    let points = [[0.0; 3], [2.0, 0.0, 0.0], [2.5, 2.0, 0.0], [-1.0, 2.5, 0.0]];
    let curve = Curve::polyline(&points, 0.8, false).unwrap();
    // On a straight piece, on both arcs, and beyond the ends; 0.1 m to either side of an arc of 0.8 m.
    for (i, at) in [-1.0, 0.5, 1.9, 3.2, 7.0].into_iter().enumerate() {
        let constraint = Constraint::from(OnCurve { particle: P, curve: curve.clone() });
        let (mut q, qd) = (numbers(PARTICLES * 2, 1), numbers(PARTICLES * 2, 2));
        let place = curve.point(at);
        (0..2).for_each(|k| q[P.0 * 2 + k] = place[k] + 0.1 * numbers(2, i as u64)[k]);
        against_differences::<2>("bent wire", &constraint, &q, &qd);
    }
}

/// The numbers stay finite where a direction does not exist and where the foot is about to jump.
#[test]
fn singular_places_give_finite_numbers() {
    let finite = |constraint: &Constraint, q: &[f64]| {
        let at = evaluated::<2>(constraint, q, &numbers(PARTICLES * 2, 3), T);
        let all = [at.C, at.Cd, at.gamma, at.Ct, at.J].concat();
        assert!(all.iter().all(|number| number.is_finite()), "{all:?}");
    };
    finite(&OnSphere::new(P, A, 1.0).into(), &[0.0; PARTICLES * 2]);
    let wire = |x: &str, y: &str| {
        let components = [x, y].map(|text| expression(text, Purpose::Curve, 2)).to_vec();
        Constraint::from(OnCurve { particle: P, curve: Curve::parametric(components, 0.0, 6.0).unwrap() })
    };
    // The centre of a circle, and the cusp of a cycloid.
    finite(&wire("cos(s)", "sin(s)"), &[0.0; PARTICLES * 2]);
    finite(&wire("s - sin(s)", "cos(s) - 1"), &[0.0; PARTICLES * 2]);
}
