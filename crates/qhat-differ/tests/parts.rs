//! The parts of the reference against answers that are known without it.

use qhat_differ::Framework;
use qhat_differ::dense::Svd;
use qhat_differ::formula::{Direction, Formula, Passing, distance, number};
use qhat_differ::framework::{Condition, Particle, Push};
use qhat_differ::generate::framework;
use qhat_differ::motion::{Moment, advance};
use qhat_differ::random::Random;
use qhat_differ::reference::Reference;

/// One mass of 2 kg at (1, 0) beside a fixed point at the origin.
fn bob(conditions: Vec<Condition>, pushes: Vec<Push>, velocity: [f64; 3]) -> Framework {
    let particle = |name: &str, at, fixed| Particle { name: name.into(), at, velocity: [0.0; 3], mass: 2.0, fixed };
    Framework {
        seed: 0,
        family: "by hand",
        dimension: 2,
        particles: vec![
            particle("pivot", [0.0; 3], true),
            Particle { velocity, ..particle("bob", [1.0, 0.0, 0.0], false) },
        ],
        conditions,
        instead: None,
        pushes,
        gravity: [0.0; 3],
        drag: 0.0,
        parameters: Vec::new(),
        duration: 1.0,
    }
}

fn start(framework: &Framework) -> Moment {
    Moment { q: framework.positions(), qd: framework.velocities(), t: 0.0 }
}

/// A pendulum that lies level, with the velocity v along its arc: q̈ = (−v²/r, −g), Q̂ = (−m v²/r, 0). The bounds are
/// some roundoffs of 10 and of 18.
#[test]
fn pendulum_by_hand() {
    for squared in [false, true] {
        let rod = Condition::Rod { between: [0, 1], length: number(1.0), squared };
        let mut pendulum = bob(vec![rod], Vec::new(), [0.0, 3.0, 0.0]);
        pendulum.gravity = [0.0, -10.0, 0.0];
        let evaluation = Reference::new(&pendulum).unwrap().evaluate(&start(&pendulum).q, &start(&pendulum).qd, 0.0);
        assert!(
            (evaluation.accelerations[2] + 9.0).abs() < 1e-14 && (evaluation.accelerations[3] + 10.0).abs() < 1e-14
        );
        assert!((evaluation.constraint_forces[2] + 18.0).abs() < 1e-13);
        assert!(evaluation.constraint_forces[3].abs() < 1e-13);
    }
}

/// A rod turns about the pivot at the rate v/r, whatever the number of steps; a spring of rest length 0 swings as a
/// cosine of √(k/m) t. Each step may be off by 1e-12 of the extent or the speed, and the bounds leave room for the
/// errors to add up: a factor of 10 for the rod, of 100 for the spring and its speed of 5 m/s.
#[test]
fn motions_of_closed_form() {
    let rod = Condition::Rod { between: [0, 1], length: number(1.0), squared: false };
    let turning = bob(vec![rod], Vec::new(), [0.0, 2.0, 0.0]);
    let end = advance(&Reference::new(&turning).unwrap(), &start(&turning), 1.5).unwrap();
    assert!((end.q[2] - 3.0_f64.cos()).abs() < 1e-11 && (end.q[3] - 3.0_f64.sin()).abs() < 1e-11, "{end:?}");

    let spring = Push::Spring { between: [0, 1], stiffness: 50.0, damping: 0.0, rest: 0.0 };
    let line = Condition::Expression { rows: vec![Formula::Place(1, 1)] };
    let swinging = bob(vec![line], vec![spring], [0.0; 3]);
    let end = advance(&Reference::new(&swinging).unwrap(), &start(&swinging), 1.5).unwrap();
    assert!((end.q[2] - 7.5_f64.cos()).abs() < 1e-10 && (end.qd[2] + 5.0 * 7.5_f64.sin()).abs() < 1e-9, "{end:?}");
}

/// A second row that says the same as the first changes no acceleration: the bound is some roundoffs of 9.
#[test]
fn redundant_rows_change_nothing() {
    let rod = |squared| Condition::Rod { between: [0, 1], length: number(1.0), squared };
    let [one, both] = [vec![rod(false)], vec![rod(false), rod(true)]].map(|conditions| {
        let framework = bob(conditions, Vec::new(), [0.0, 3.0, 0.0]);
        let reference = Reference::new(&framework).unwrap();
        assert_eq!(reference.rank, 1);
        reference.evaluate(&start(&framework).q, &start(&framework).qd, 0.0).accelerations
    });
    assert!(one.iter().zip(&both).all(|(a, b)| (a - b).abs() < 1e-13), "{one:?} {both:?}");
}

/// The rank is that of the factors, and B⁺ gives the least-norm solution y of B y = c where there is one: the bound is
/// some hundred roundoffs of 1.
#[test]
fn singular_values_of_random_matrices() {
    let mut random = Random::new(1);
    for (rows, columns, rank) in [(5, 9, 5), (9, 5, 5), (12, 12, 7), (1, 3, 1)] {
        let factor = |random: &mut Random, a: usize, b: usize| -> Vec<Vec<f64>> {
            (0..a).map(|_| (0..b).map(|_| random.between(-1.0, 1.0)).collect()).collect()
        };
        let (left, right) = (factor(&mut random, rows, rank), factor(&mut random, rank, columns));
        let product = |x: &[f64]| (0..columns).map(|j| (0..rank).map(|k| x[k] * right[k][j]).sum()).collect();
        let matrix: Vec<Vec<f64>> = left.iter().map(|row| product(row)).collect();
        let svd = Svd::new(&matrix);
        assert_eq!(svd.rank(1e-12), rank);
        let y: Vec<f64> = (0..columns).map(|_| random.between(-1.0, 1.0)).collect();
        let apply =
            |y: &[f64]| -> Vec<f64> { matrix.iter().map(|row| row.iter().zip(y).map(|(a, b)| a * b).sum()).collect() };
        let solved = svd.solve(rank, &apply(&y), columns);
        let off = apply(&y).iter().zip(apply(&solved)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{rows} × {columns}: {off}");
        let length = |y: &[f64]| y.iter().map(|y| y * y).sum::<f64>();
        assert!(length(&solved) <= length(&y) * (1.0 + 1e-12), "no solution of least norm");
    }
}

/// Derivatives of every formula that the generator makes, against differences.
#[test]
fn derivatives_of_formulas() {
    let h = 3e-4;
    let mut tried = 0;
    for seed in 0..200 {
        let framework = framework(seed);
        let d = framework.dimension;
        let (q, qd) = (framework.positions(), framework.velocities());
        let formulas = framework.formulas();
        for formula in formulas.rows.iter().chain(&formulas.potentials) {
            let value = |tau: f64| {
                let moved: Vec<f64> = q.iter().zip(&qd).map(|(q, qd)| q + tau * qd).collect();
                let at = Passing { dimension: d, q: &moved, qd: &qd, t: tau, along: Direction::Nowhere };
                formula.follow(at).value
            };
            let along = formula.follow(Passing { dimension: d, q: &q, qd: &qd, t: 0.0, along: Direction::Motion });
            // Differences of order 4, whose error is h⁴ of a fifth derivative and roundoff over h².
            let sum = |weights: [f64; 5]| (-2..=2).zip(weights).map(|(i, w)| w * value(f64::from(i) * h)).sum::<f64>();
            let first = sum([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * h);
            let second = sum([-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * h * h);
            let size = 1.0 + along.value.abs() + along.first.abs() + along.second.abs();
            assert!((along.first - first).abs() < 1e-8 * size, "seed {seed}: {} and {first}", along.first);
            assert!((along.second - second).abs() < 1e-5 * size, "seed {seed}: {} and {second}", along.second);
            tried += 1;
        }
    }
    assert!(tried > 1000, "{tried}");
    let at = Passing { dimension: 2, q: &[0.0, 0.0, 3.0, 4.0], qd: &[0.0; 4], t: 0.0, along: Direction::Coordinate(3) };
    assert_eq!(distance(0, 1, 2).follow(at).first, 0.8);
}
