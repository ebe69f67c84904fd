//! Every kind of force against differences: Q against the potential, the tangent and its bound against Q, and the power
//! against both.

use super::*;
use crate::expression::{Expression, Purpose, Scope};
use crate::hyper::Hyper;
use crate::linalg::block::{diagonal, outer, plus};
use crate::space::Dimension;

/// Pseudo-random numbers in [−1, 1), the same on every machine.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }
}

const PARTICLES: usize = 4;
const RATE: f64 = 7.0;
const T: f64 = 0.4;
/// Step of central differences. For numbers below 100 with third derivatives below 1e4 the error is 1e-7 from the third
/// derivatives and 1e-9 from roundoff.
const STEP: f64 = 3e-6;
const CLOSE: f64 = 1e-6;

/// Forces that belong together.
struct Case {
    name: &'static str,
    forces: Vec<Force>,
    /// Whether they all have potentials when the particles are at rest.
    is_conservative: bool,
}

fn case(name: &'static str, force: impl Into<Force>, is_conservative: bool) -> Case {
    Case { name, forces: vec![force.into()], is_conservative }
}

fn expression(text: &str, purpose: Purpose, d: usize) -> Expression {
    let particle = |name: &str| ["a", "b", "c", "d"].iter().position(|known| *known == name).map(ParticleId);
    let dimension = if d == 2 { Dimension::Two } else { Dimension::Three };
    Expression::parse(text, &Scope::new(purpose, dimension, &particle)).unwrap()
}

/// A force on c that depends on the positions and velocities of c and a.
fn typed_force(d: usize) -> Case {
    let texts = ["sin(a.x*c.y) - 0.4*c.vx", "c.x^2 - 0.3*a.vy*t", "exp(c.x/3) - 0.2*c.vz"];
    let components = texts[..d].iter().map(|text| expression(text, Purpose::Force, d)).collect();
    case("force as typed", ExpressionForce { particle: ParticleId(2), components }, false)
}

fn cases<const D: usize>() -> Vec<Case> {
    let [a, b, c, d] = [0, 1, 2, 3].map(ParticleId);
    let ring: Vec<Force> = Pressure::in_loop(&[a, b, c, d], 3.0).map(Force::from).collect();
    let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
    let mesh = faces.map(|corners| Pressure { facet: Facet::Triangle(corners), pressure: 3.0 }.into()).to_vec();
    let torsion = |angle| TorsionSpring { a: c, b: a, c: b, stiffness: 2.0, damping: 0.3, angle };
    let air = AirDrag { wind: [0.4, -0.7, 0.2], ..AirDrag::still(b, 0.3, 0.8) };
    let swing = HarmonicForce { particle: c, amplitude: [1.0, -2.0, 0.5], angular_frequency: 5.0, phase: 0.3 };
    let actuator = Actuator { a: d, b, push: 1.3, amplitude: 2.0, angular_frequency: 4.0, phase: -0.2 };
    let cubic = CubicSpring { a: b, b: d, stiffness: -3.0, cubic: 8.0, damping: 0.6, rest: 0.9 };
    let corners = [-1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0];
    let gas = |name, facets: Vec<Facet>, exponent| {
        case(name, Gas::new(facets, 3.0, exponent, Dimension::Three, &corners), true)
    };
    let edges = || [[a, b], [b, c], [c, d], [d, a]].map(Facet::Edge).to_vec();
    // The faces above run clockwise as seen from outside and are turned here. In the plane triangles enclose no volume,
    // so a gas has edges there.
    let outside = faces.map(|[a, b, c]| Facet::Triangle([a, c, b])).to_vec();
    let in_space = (D == 3).then(|| gas("gas in a mesh", outside, 1.4));
    let all = vec![
        case("gravity", Gravity { acceleration: [0.3, -9.81, 1.0] }, true),
        case("drag", Drag { coefficient: 0.4 }, false),
        case("spring", Spring { a, b: c, stiffness: 9.0, damping: 0.4, rest: 0.7 }, true),
        case("mouse", MouseSpring { particle: b, target: [0.1; 3], stiffness: 4.0, damping: 0.3 }, true),
        case("central", CentralForce::gravity(c, 2.0, [0.2, 0.1, -0.3], 3.0, 0.4), true),
        case("masses", InverseSquare::gravity([d, a], [2.0, 3.0], 1.5, 0.5), true),
        case("charges", InverseSquare::charges([d, a], [2.0, 1.0], 1.5, 0.3), true),
        case("air", air, false),
        case("harmonic", swing, false),
        case("actuator", actuator, false),
        case("cubic", cubic, true),
        case("torsion", torsion(1.1), true),
        case("straight", torsion(std::f64::consts::PI), true),
        case("point force", PointForce::new(b, [1.5, -0.4, 2.0]), true),
        case("potential as typed", ExpressionPotential { potential: expression(HILLS, Purpose::Potential, D) }, true),
        typed_force(D),
        case("custom", CustomForce::new([c, a, d], hills), true),
        Case { name: "ring", forces: ring, is_conservative: true },
        Case { name: "mesh", forces: mesh, is_conservative: true },
        gas("gas", edges(), 1.4),
        gas("gas of one temperature", edges(), 1.0),
    ];
    all.into_iter().chain(in_space).collect()
}

/// A potential of three particles, as text and as a function.
const HILLS: &str = "sin(c.x*a.y) + (c.y - d.x)^2*a.x + exp(d.y)";

fn hills(x: &[[Hyper; 3]], _: Hyper) -> Hyper {
    let [c, a, d] = [x[0], x[1], x[2]];
    (c[0] * a[1]).sin() + (c[1] - d[0]).powi(2) * a[0] + d[1].exp() * c[2].cos()
}

const MASS: [f64; PARTICLES] = [0.7, 1.2, 0.5, 2.0];

impl Case {
    fn force<const D: usize>(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        let mut Q = vec![0.0; q.len()];
        let motion = Motion::<D> { q, qd, t: T };
        self.forces.iter().for_each(|force| force.add(motion, &MASS, &mut Q));
        Q
    }

    fn potential<const D: usize>(&self, q: &[f64]) -> f64 {
        let motion = Motion::<D> { q, qd: q, t: T };
        self.forces.iter().map(|force| force.potential(motion, &MASS)).sum()
    }
}

fn moved(x: &[f64], k: usize, by: f64) -> Vec<f64> {
    x.iter().enumerate().map(|(i, x)| if i == k { x + by } else { *x }).collect()
}

/// −∂(f)/∂x by differences: column after column.
fn minus_slopes(x: &[f64], f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
    let column = |k: usize| {
        let (ahead, behind) = (f(&moved(x, k, STEP)), f(&moved(x, k, -STEP)));
        ahead.iter().zip(behind).map(|(ahead, behind)| (behind - ahead) / (2.0 * STEP)).collect()
    };
    (0..x.len()).map(column).collect()
}

/// The tangent of the case as a dense matrix.
fn tangent<const D: usize>(case: &Case, q: &[f64], qd: &[f64]) -> Vec<Vec<f64>> {
    let mut dense = vec![vec![0.0; q.len()]; q.len()];
    let mut definite = dense.clone();
    for force in &case.forces {
        let named = force.particles();
        force.tangent(Motion::<D> { q, qd, t: T }, RATE, &mut |i, j, stiffness| {
            assert!(
                i == j || (named.contains(&i) && named.contains(&j)),
                "{}: couples a particle that it does not name",
                case.name
            );
            stiffness.add_to(&mut dense, i, j);
            match stiffness {
                Stiffness::Difference(block) => assert_one_sign(case.name, &block),
                Stiffness::Definite(_) => stiffness.add_to(&mut definite, i, j),
                Stiffness::Indefinite(_) => {}
            }
        });
    }
    let mut numbers = Numbers(3);
    for _ in 0..20 {
        let x = numbers.vector(q.len());
        let product = |row: &Vec<f64>| row.iter().zip(&x).map(|(k, x)| k * x).sum::<f64>();
        let form: f64 = definite.iter().zip(&x).map(|(row, x)| x * product(row)).sum();
        assert!(form > -1e-10, "{}: the blocks called definite are not: {form}", case.name);
    }
    dense
}

/// xᵀBx has the sign of the trace at every x.
fn assert_one_sign<const D: usize>(name: &str, block: &[[f64; D]; D]) {
    let trace: f64 = (0..D).map(|k| block[k][k]).sum();
    let mut numbers = Numbers(9);
    for _ in 0..20 {
        let x: [f64; D] = std::array::from_fn(|_| numbers.next());
        let form: f64 = (0..D).map(|i| (0..D).map(|j| x[i] * block[i][j] * x[j]).sum::<f64>()).sum();
        assert!(form * trace.signum() > -1e-10 * (1.0 + trace.abs()), "{name}: of both signs");
    }
}

fn check_all<const D: usize>() {
    let mut numbers = Numbers(1);
    for case in cases::<D>() {
        for _ in 0..12 {
            // The corners of a square or of a tetrahedron, moved a little, so that no two particles are close to each
            // other and no hinge is close to straight.
            let corners = [[-1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, 1.0]];
            let q: Vec<f64> = corners.iter().flat_map(|x| x[..D].to_vec()).map(|x| x + 0.3 * numbers.next()).collect();
            check_one::<D>(&case, &q, &numbers.vector(q.len()));
        }
    }
}

fn check_one<const D: usize>(case: &Case, q: &[f64], qd: &[f64]) {
    let name = case.name;
    let still = vec![0.0; q.len()];
    let at_rest = case.force::<D>(q, &still);
    let slopes: Vec<f64> = minus_slopes(q, |q| vec![case.potential::<D>(q)]).concat();
    if case.is_conservative {
        for (force, slope) in at_rest.iter().zip(&slopes) {
            assert!((force - slope).abs() < CLOSE, "{name}, D = {D}: F = {force}, −∂V/∂q = {slope}");
        }
    }

    let Q = case.force::<D>(q, qd);
    let expected: f64 = Q.iter().zip(&slopes).zip(qd).map(|((force, slope), v)| (force - slope) * v).sum();
    let motion = Motion::<D> { q, qd, t: T };
    let power: f64 = case.forces.iter().map(|force| force.power(motion)).sum();
    assert!((power - expected).abs() < 10.0 * CLOSE, "{name}, D = {D}: power {power}, F·v + dV/dt = {expected}");

    // The particles are at rest, so that the change of a damper's direction, which the tangent leaves out, has no
    // effect.
    let by_position = minus_slopes(q, |q| case.force::<D>(q, &still));
    let by_velocity = minus_slopes(&still, |qd| case.force::<D>(q, qd));
    let dense = tangent::<D>(case, q, &still);
    // The force as typed gives the symmetric part alone.
    let is_typed = matches!(case.forces[..], [Force::ExpressionForce(_)]);
    for j in 0..q.len() {
        for i in 0..q.len() {
            let full = |i: usize, j: usize| by_position[j][i] + RATE * by_velocity[j][i];
            let difference = if is_typed { 0.5 * (full(i, j) + full(j, i)) } else { full(i, j) };
            let entry = dense[i][j];
            assert!(
                (entry - difference).abs() < 10.0 * CLOSE,
                "{name}, D = {D}: K[{i}][{j}] = {entry}, not {difference}"
            );
        }
    }

    check_linearized::<D>(case, q, qd);

    let mut bounds = [(0.0, 0.0); PARTICLES];
    for force in &case.forces {
        force.stiffness(Motion::<D> { q, qd: &still, t: T }, &mut |id, stiffness, damping| {
            bounds[id.0].0 += stiffness;
            bounds[id.0].1 += damping;
        });
    }
    // The forces that a user writes bound each component of a row, the others the norm of the row.
    let [first, ..] = &case.forces[..] else { panic!("{name}: no force") };
    let written = ["ExpressionForce", "ExpressionPotential", "CustomForce"];
    let is_written = written.contains(&first.kind());
    let mut numbers = Numbers(7);
    for _ in 0..50 {
        let x = unit_vectors::<D>(&mut numbers);
        for (i, (stiffness, damping)) in bounds.iter().enumerate() {
            let row = |slopes: &[Vec<f64>]| {
                let sums = (0..D).map(|k| (0..x.len()).map(|j| slopes[j][i * D + k] * x[j]).sum::<f64>());
                if is_written {
                    sums.map(f64::abs).fold(0.0, f64::max)
                } else {
                    sums.map(|sum| sum * sum).sum::<f64>().sqrt()
                }
            };
            assert!(row(&by_position) <= stiffness + CLOSE, "{name}, D = {D}: above its bound {stiffness}");
            assert!(row(&by_velocity) <= damping + CLOSE, "{name}, D = {D}: above its bound {damping}");
        }
    }
}

/// With moving particles: what `linearize` gives is exact, dampers whose direction turns and all.
fn check_linearized<const D: usize>(case: &Case, q: &[f64], qd: &[f64]) {
    let by_position = minus_slopes(q, |q| case.force::<D>(q, qd));
    let by_velocity = minus_slopes(qd, |qd| case.force::<D>(q, qd));
    let mut exact = vec![vec![[0.0; 2]; q.len()]; q.len()];
    for force in &case.forces {
        force.linearize(Motion::<D> { q, qd, t: T }, &mut |i, j, position, velocity| {
            for row in 0..D {
                for column in 0..D {
                    let [to, of_velocity] = &mut exact[i.0 * D + row][j.0 * D + column];
                    *to += position[row][column];
                    *of_velocity += velocity[row][column];
                }
            }
        });
    }
    for j in 0..q.len() {
        for i in 0..q.len() {
            for (entry, difference) in exact[i][j].into_iter().zip([by_position[j][i], by_velocity[j][i]]) {
                assert!(
                    (entry - difference).abs() < 10.0 * CLOSE,
                    "{}, D = {D}: [{i}][{j}] = {entry}, not {difference}",
                    case.name
                );
            }
        }
    }
}

/// Forces that do not have the same tangent in both directions, or not the same at rest.
#[test]
fn forces_without_symmetry_are_linearized_exactly() {
    let mut numbers = Numbers(4);
    for case in one_sided::<2>() {
        check_linearized::<2>(&case, &numbers.vector(2 * PARTICLES), &numbers.vector(2 * PARTICLES));
    }
    for case in one_sided::<3>() {
        check_linearized::<3>(&case, &numbers.vector(3 * PARTICLES), &numbers.vector(3 * PARTICLES));
    }
}

fn one_sided<const D: usize>() -> Vec<Case> {
    let dimension = if D == 2 { Dimension::Two } else { Dimension::Three };
    let number = |name: &str| name.strip_prefix('p').and_then(|n| n.parse().ok()).map(ParticleId);
    let parse = |text: &&str| Expression::parse(text, &Scope::new(Purpose::Force, dimension, &number)).unwrap();
    let components = ["p1.vx*p0.x - p0.vy^3", "sin(p2.x) + p0.vx*t", "exp(p0.y)*p1.vy"];
    let force = ExpressionForce { particle: ParticleId(0), components: components[..D].iter().map(parse).collect() };
    let air = AirDrag {
        wind: [0.4, -0.7, 0.2],
        gradient: [[0.2, -0.5, 0.1], [0.7, 0.1, -0.3], [0.3, 0.6, 0.2]],
        ..AirDrag::still(ParticleId(1), 0.3, 0.8)
    };
    vec![case("expression", force, false), case("wind that varies", air, false)]
}

/// A unit vector for each particle.
fn unit_vectors<const D: usize>(numbers: &mut Numbers) -> Vec<f64> {
    let mut x = numbers.vector(PARTICLES * D);
    for x in x.chunks_exact_mut(D) {
        let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        x.iter_mut().for_each(|x| *x /= length);
    }
    x
}

#[test]
fn every_kind_of_force_has_a_case() {
    let cases = cases::<3>();
    let tried: Vec<&str> = cases.iter().flat_map(|case| &case.forces).map(Force::kind).collect();
    let missing: Vec<_> = Force::KINDS.iter().filter(|kind| !tried.contains(kind)).collect();
    assert!(missing.is_empty(), "add {missing:?} to the cases of this file");
}

#[test]
fn every_force_agrees_with_its_derivatives_in_the_plane() {
    check_all::<2>();
}

#[test]
fn every_force_agrees_with_its_derivatives_in_space() {
    check_all::<3>();
}

/// With arms in line at rest, the tangent is the limit of the tangents of hinges that are less and less bent, for every
/// direction in which they bend.
#[test]
fn a_straight_hinge_is_stiff_both_ways_across() {
    let [a, b, c] = [0, 1, 2].map(ParticleId);
    let q = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 3.0, 0.0];
    let torsion = TorsionSpring { a, b, c, stiffness: 2.0, damping: 0.0, angle: std::f64::consts::PI };
    let case = case("straight", torsion, true);
    assert_eq!(case.force::<3>(&q, &[0.0; 12]), [0.0; 12]);
    let dense = tangent::<3>(&case, &q, &[0.0; 12]);
    // V = ½ k (y_a/1 + y_c/0.5 − 3 y_b)², and the same in z.
    let slope = [1.0, -3.0, 2.0];
    for (i, one) in slope.iter().enumerate() {
        for (j, other) in slope.iter().enumerate() {
            let B = plus(diagonal(2.0 * one * other), -2.0 * one * other, outer(1.0, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]));
            for row in 0..3 {
                for column in 0..3 {
                    let entry = dense[3 * i + row][3 * j + column];
                    assert!((entry - B[row][column]).abs() < 1e-12, "{i}{j}: {entry} for {}", B[row][column]);
                }
            }
        }
    }
}

/// A force whose direction is undefined is zero, and all numbers stay finite.
#[test]
fn forces_of_no_direction_are_zero() {
    let [a, b, c] = [0, 1, 2].map(ParticleId);
    let q = [0.5; 9];
    let motion = Motion::<3> { q: &q, qd: &[0.3; 9], t: T };
    let forces: [Force; 5] = [
        InverseSquare::gravity([a, b], [1.0, 1.0], 1.0, 0.0).into(),
        CentralForce::gravity(a, 1.0, [0.5; 3], 1.0, 0.0).into(),
        CubicSpring { a, b, stiffness: 1.0, cubic: 1.0, damping: 1.0, rest: 1.0 }.into(),
        Actuator { a, b, push: 1.0, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 }.into(),
        TorsionSpring { a, b, c, stiffness: 1.0, damping: 1.0, angle: 1.0 }.into(),
    ];
    for force in forces {
        let mut Q = [0.0; 9];
        force.add(motion, &MASS, &mut Q);
        assert_eq!(Q, [0.0; 9], "{force:?}");
        assert_eq!(force.power(motion), 0.0);
        force.stiffness(motion, &mut |_, stiffness, damping| assert!(stiffness.is_finite() && damping.is_finite()));
        force.tangent(motion, RATE, &mut |_, _, stiffness| panic!("{stiffness:?}"));
    }
}
