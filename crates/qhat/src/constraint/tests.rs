//! The second derivatives of every kind: the geometric stiffness −Σ λ ∂²C/∂q² against differences of Jᵀ λ, and the
//! curvature as a bound on the blocks of ∂²C/∂q². No public call shows them. `tests/kinds/` tests the rows themselves.

use super::{
    Anchor, Angle, Area, Constraint, Curve, Custom, Direction, Distance, DistanceForm, ExpressionConstraint, Gears,
    Holds, Layout, Lengths, Limits, Line, Nail, NailForm, Obstacle, OnCircle, OnCurve, OnEllipse, OnLine, OnPlane,
    OnSphere, Plane, Relation, Rows, Surface, Volume,
};
use crate::driven::Driven;
use crate::expression::{Expression, Purpose, Scope};
use crate::hyper::Hyper;
use crate::point::Motion;
use crate::space::{Dimension, ParticleId};

const PARTICLES: usize = 4;
/// A time at which no driven value is zero or extreme.
const T: f64 = 0.37;

const A: ParticleId = ParticleId(0);
const B: ParticleId = ParticleId(1);
const OTHER: ParticleId = ParticleId(2);
const P: ParticleId = ParticleId(3);

fn expression(text: &str, purpose: Purpose, d: usize) -> Expression {
    let particle = |name: &str| ["a", "b", "c", "p"].iter().position(|known| *known == name).map(ParticleId);
    let dimension = if d == 2 { Dimension::Two } else { Dimension::Three };
    Expression::parse(text, &Scope::new(purpose, dimension, &particle))
        .unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn driven(x: &str, y: &str, z: &str) -> [Driven; 3] {
    [x, y, z].map(|text| expression(text, Purpose::Time, 2).into())
}

/// A curve with these components.
fn curve(components: &[&str], from: f64, to: f64) -> Curve {
    let d = components.len();
    let components = components.iter().map(|text| expression(text, Purpose::Curve, d)).collect();
    Curve::parametric(components, from, to).unwrap()
}

/// Constraints with a meaning in the plane and in space.
fn anywhere(d: usize) -> Vec<Constraint> {
    let point = || driven("sin(t)", "2*t", "0.3 - t^2");
    let turning = || driven("cos(3*t)", "sin(3*t)", "0.2 + t");
    let radius = || Driven::from(expression("1 + 0.1*sin(5*t)", Purpose::Time, 2));
    let ball = Surface::Ball { center: [0.3, -0.4, 0.1], radius: 0.5, inside: true };
    let wavy = |x: &[[Hyper; 3]], t: Hyper| {
        (x[0][1] * x[1][0]).sin() + x[2][1] * (t - x[1][1]) + x[0][0].powi(3) * x[2][0] + x[0][2] * x[1][2]
    };
    let text = expression("length(b - p)*a.x + dot(a, a)*sin(p.y*t)", Purpose::Constraint, d);
    vec![
        Distance::new(A, P, 1.3).into(),
        Distance { form: DistanceForm::Squared, ..Distance::new(P, A, 1.3) }.into(),
        Nail::new(P, [0.1, 0.2, 0.3]).into(),
        Nail { form: NailForm::Scalar, ..Nail::new(P, [0.1, 0.2, 0.3]) }.into(),
        Limits::between(P, B, 0.5, 4.0).into(),
        Obstacle::new(P, Surface::half_space([3.0, 4.0, 0.0], -1.5)).into(),
        Obstacle::new(P, ball).into(),
        Obstacle::new(P, Surface::ball([0.3, -0.4, 0.1], 0.5)).into(),
        // Beyond a corner of the box.
        Obstacle::new(P, Surface::block([10.0, -9.0, -9.0], [1.0; 3])).into(),
        ExpressionConstraint::new(text, &[0.5; 12]).into(),
        Custom::new([B, P, A], wavy).into(),
        Relation::center_of_mass([(A, 1.0), (B, 2.0), (P, 1.0)], point()).into(),
        Lengths::new(&[([A, B], 1.0), ([P, B], 2.0), ([B, A], 0.5)], radius()).into(),
        Angle::between([A, B], [P, OTHER], radius()).into(),
        Angle::from_direction([1.0, 2.0, -1.0], [A, P], radius()).into(),
        Direction { a: A, b: B, along: turning() }.into(),
        OnLine { particle: P, line: Line::Through(point(), turning()) }.into(),
        OnLine::through(P, A, B).into(),
        OnSphere::new(P, A, radius()).into(),
        OnSphere::new(P, Anchor::Point(point()), radius()).into(),
    ]
}

fn in_plane() -> Vec<Constraint> {
    let half = driven("1 + 0.1*sin(5*t)", "0.7 + t", "0");
    let [along, across, _] = half;
    vec![
        Gears::mesh([[A, B], [OTHER, P]], [3, -2], 0.3).into(),
        Gears::rack([A, B], P, [3.0, 4.0], 0.5, 0.3).into(),
        Area { corners: vec![A, B, P, OTHER], area: 1.0.into() }.into(),
        OnEllipse { particle: P, center: A.into(), along: [3.0, 4.0, 0.0], half: [along, across] }.into(),
        OnCurve { particle: P, curve: curve(&["s", "0.3*sin(2*s)"], -3.0, 3.0) }.into(),
    ]
}

fn in_space() -> Vec<Constraint> {
    let (point, normal) = (driven("sin(t)", "2*t", "0.3 - t^2"), driven("cos(3*t)", "sin(3*t)", "0.2 + t"));
    vec![
        Volume::tetrahedron([A, B, OTHER, P], 1.0).into(),
        OnPlane { particle: P, plane: Plane::Across(point, normal) }.into(),
        OnPlane::through(P, [A, B, OTHER]).into(),
        OnCircle::new(P, A, [1.0, 2.0, 2.0], 1.0).into(),
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

/// J at positions q, row after row.
fn jacobian<const D: usize>(constraint: &Constraint, q: &[f64]) -> Vec<f64> {
    let mut rows = Rows::new(Layout::new([constraint].into_iter(), D), D, PARTICLES);
    rows.evaluate::<D>([constraint].into_iter(), Motion { q, qd: q, t: T });
    rows.J.to_dense()
}

/// −Σ λ ∂²C/∂q² as the constraint gives it.
fn stiffness<const D: usize>(constraint: &Constraint, q: &[f64], lambda: &[f64]) -> Vec<Vec<f64>> {
    let mut dense = vec![vec![0.0; q.len()]; q.len()];
    let particles = constraint.particles();
    constraint.geometric_stiffness::<D>(Motion { q, qd: q, t: T }, lambda, &mut |i, j, stiffness| {
        assert!(i <= j && j < particles.len(), "{}: block {i}, {j}", constraint.kind());
        stiffness.add_to(&mut dense, particles[i], particles[j]);
    });
    dense
}

/// Step of the central differences [m]. They are good to H² f‴/6, 2e-11 times a third derivative of some hundreds, and
/// to ε/H = 1e-11 of numbers of some tens.
const H: f64 = 1e-5;
const GOOD: f64 = 3e-7;

/// Column j of −Σ λ ∂²C/∂q² by differences of Jᵀ λ.
fn by_differences<const D: usize>(constraint: &Constraint, q: &[f64], lambda: &[f64], j: usize) -> Vec<f64> {
    let pull = |by: f64| -> Vec<f64> {
        let mut moved = q.to_vec();
        moved[j] += by;
        let J = jacobian::<D>(constraint, &moved);
        (0..q.len()).map(|i| lambda.iter().enumerate().map(|(row, l)| -l * J[row * q.len() + i]).sum()).collect()
    };
    pull(H).iter().zip(pull(-H)).map(|(ahead, behind)| (ahead - behind) / (2.0 * H)).collect()
}

fn check<const D: usize>(constraint: &Constraint, q: &[f64]) {
    let name = constraint.kind();
    let m = constraint.row_count(D);
    let lambda = numbers(m, 5);
    let dense = stiffness::<D>(constraint, q, &lambda);
    for (j, row) in dense.iter().enumerate() {
        for (i, (entry, expected)) in row.iter().zip(by_differences::<D>(constraint, q, &lambda, j)).enumerate() {
            assert!((entry - expected).abs() <= GOOD, "{name}, D = {D}: K[{i}][{j}] = {entry}, not {expected}");
        }
    }
    let bound = constraint.curvature::<D>(Motion { q, qd: q, t: T });
    assert!(bound.is_finite());
    let direction = numbers(D, 9);
    let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    for row in 0..m {
        let alone: Vec<f64> = (0..m).map(|k| if k == row { -1.0 } else { 0.0 }).collect();
        let second = stiffness::<D>(constraint, q, &alone);
        for (i, j) in (0..PARTICLES).flat_map(|i| (0..PARTICLES).map(move |j| (i, j))) {
            let entry = |k: usize| (0..D).map(|l| second[i * D + k][j * D + l] * direction[l]).sum();
            let turned: Vec<f64> = (0..D).map(entry).collect();
            // Roundoff of a block of some tens.
            let most = bound * size(&direction) + 1e-12;
            assert!(size(&turned) <= most, "{name}, D = {D}: block {i}, {j} is above its bound {bound}");
        }
    }
}

#[test]
fn stiffness_and_curvature_of_every_kind_agree_with_differences_of_J() {
    let (plane, space) = ([anywhere(2), in_plane()].concat(), [anywhere(3), in_space()].concat());
    for seed in 1..=5 {
        for constraint in &plane {
            let mut q = places::<2>(seed);
            if let Constraint::OnCurve(OnCurve { curve, .. }) = constraint {
                // Beside the wire, well within its radius of curvature, 0.8 m.
                let (on, beside) = (curve.point(q[P.0 * 2]), numbers(2, seed));
                (0..2).for_each(|k| q[P.0 * 2 + k] = on[k] + 0.1 * beside[k]);
            }
            check::<2>(constraint, &q);
        }
        for constraint in &space {
            check::<3>(constraint, &places::<3>(seed));
        }
    }
    let tried: Vec<&str> = plane.iter().chain(&space).map(Constraint::kind).collect();
    let missing: Vec<_> = Constraint::KINDS.iter().filter(|kind| !tried.contains(kind)).collect();
    assert!(missing.is_empty(), "add {missing:?} to the constraints that are tried here");
}

/// In space the stiffness of a wire leaves out w·c‴, so it is exact on the wire.
#[test]
fn stiffness_of_a_wire_in_space_is_exact_on_the_wire() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2], [1.5, 2.0, -0.3], [0.2, 1.6, 0.1], [-0.8, 0.9, 0.5]];
    let helix = curve(&["cos(s)", "sin(s)", "0.2*s"], -7.0, 7.0);
    let spline = Curve::through(&points, true).unwrap();
    let bent = Curve::polyline(&points, 0.3, true).unwrap();
    for (curve, s) in
        [(&helix, -2.2), (&helix, 0.4), (&helix, 5.9), (&spline, 0.6), (&spline, 4.1), (&bent, 0.5), (&bent, 0.95)]
    {
        let mut q = places::<3>(1);
        q[P.0 * 3..].copy_from_slice(&curve.point(s));
        check::<3>(&OnCurve { particle: P, curve: curve.clone() }.into(), &q);
    }
}

/// In the plane the stiffness of straight pieces and arcs is exact beside the wire, too.
#[test]
fn stiffness_of_a_bent_wire_in_the_plane_is_exact_beside_the_wire() {
    let points = [[0.0; 3], [2.0, 0.0, 0.0], [2.5, 2.0, 0.0], [-1.0, 2.5, 0.0]];
    let curve = Curve::polyline(&points, 0.8, false).unwrap();
    // On a straight piece, on both arcs, and beyond the ends; 0.1 m to either side of an arc of 0.8 m.
    for (i, s) in [-1.0, 0.5, 1.9, 3.2, 7.0].into_iter().enumerate() {
        let (mut q, place, beside) = (places::<2>(1), curve.point(s), numbers(2, i as u64));
        (0..2).for_each(|k| q[P.0 * 2 + k] = place[k] + 0.1 * beside[k]);
        check::<2>(&OnCurve { particle: P, curve: curve.clone() }.into(), &q);
    }
}
