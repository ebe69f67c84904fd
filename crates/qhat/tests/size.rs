//! Sizes that grow in proportion to a system: numbers stored and entries of the factor, counted for n and 2 n parts.

use crate::systems::gravity;
use qhat::{BuildError, Dimension, Distance, Expression, Particle, Purpose, Scope, State, System, evaluate};

/// n rods from a hub; with `rim`, rods between neighbours on the rim, too.
fn star(n: usize, is_fixed: bool, rim: bool) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let hub = Particle::at("hub", [0.0, 0.0]);
    let hub = builder.particle(if is_fixed { hub.fixed() } else { hub });
    let at = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        [angle.cos(), angle.sin()]
    };
    let ends: Vec<_> = (0..n).map(|i| builder.particle(Particle::at(format!("s{i}"), at(i)))).collect();
    for (i, &end) in ends.iter().enumerate() {
        builder.constraint(format!("spoke {i}"), Distance::new(hub, end, 1.0));
        if rim && i > 0 {
            let ([x, y], [u, v]) = (at(i), at(i - 1));
            builder.constraint(format!("rim {i}"), Distance::new(ends[i - 1], end, (x - u).hypot(y - v)));
        }
    }
    builder.force(gravity());
    builder.build().unwrap()
}

/// The numbers that the terms of a star store for A, and the entries of its factor.
fn sizes(n: usize, is_fixed: bool, rim: bool) -> [u64; 2] {
    let (system, state) = star(n, is_fixed, rim);
    let stored = evaluate(&system, &state).constraint_matrix.stored();
    [stored as u64, system.components().iter().map(|component| component.entries).sum()]
}

/// All pairs of 2000 rods at one particle would be two million numbers.
#[test]
fn a_particle_with_many_rods_stores_numbers_in_proportion_to_them() {
    for (is_fixed, rim) in [(false, false), (true, false), (false, true), (true, true)] {
        let [once, twice] = [1000, 2000].map(|n| sizes(n, is_fixed, rim));
        for k in 0..2 {
            assert!(twice[k] <= 2 * once[k] + 100, "fixed {is_fixed}, rim {rim}: {once:?}, {twice:?}");
            assert!(twice[k] <= 20 * 2000, "fixed {is_fixed}, rim {rim}: {twice:?}");
        }
    }
}

/// What is stored apart for a hub is part of every entry and of every product.
#[test]
fn the_matrix_of_a_hub_is_J_W_Jt() {
    // 40 spokes make a hub.
    let (system, state) = star(40, false, true);
    let terms = evaluate(&system, &state);
    let (A, m) = (&terms.constraint_matrix, system.row_count());
    let (J, columns) = (terms.jacobian.to_dense(), terms.jacobian.column_count());
    let dense = A.to_dense();
    for i in 0..m {
        for j in 0..m {
            let product: f64 = (0..columns).map(|k| J[i * columns + k] * J[j * columns + k]).sum();
            // Masses are 1, and an entry is a sum of at most four products of numbers up to 1.
            assert!((A.get(i, j) - product).abs() <= 4.0 * f64::EPSILON, "{i}, {j}: {} {product}", A.get(i, j));
            assert_eq!(dense[i * m + j], A.get(i, j));
        }
    }
    let x: Vec<f64> = (0..m).map(|i| (i as f64 * 0.7).sin()).collect();
    let mut product = vec![0.0; m];
    A.multiply(&x, &mut product);
    for i in 0..m {
        let sum: f64 = (0..m).map(|j| dense[i * m + j] * x[j]).sum();
        assert!((product[i] - sum).abs() <= 1e-13 * m as f64, "{i}: {} {sum}", product[i]);
    }
}

/// A list of zeros for every particle of a system, made anew for each expression, is what made n of them take n².
#[test]
fn an_expression_at_rest_needs_no_velocities() {
    let bob = System::builder(Dimension::Two).particle(Particle::at("bob", [1.0, 0.0]));
    let particle = |name: &str| (name == "bob").then_some(bob);
    let scope = Scope::new(Purpose::Constraint, Dimension::Two, &particle);
    let circle = Expression::parse("bob.x^2*sin(t) + bob.y^3", &scope).unwrap();
    let (mut with, mut without) = ([0.0; 2], [0.0; 2]);
    let at_rest = circle.jet_and_gradient(&[0.3, 0.4], &[0.0; 2], 0.5, &mut with);
    assert_eq!(circle.jet_and_gradient(&[0.3, 0.4], &[], 0.5, &mut without), at_rest);
    assert_eq!(with, without);
}

/// 60,000 fixed ends at one particle: the rows follow from two of them, and a factor of all would have 1.8 · 10⁹
/// entries. The error comes before the factor is allocated, and names the part.
#[test]
fn a_factor_that_would_not_fit_is_refused_by_name() {
    let mut builder = System::builder(Dimension::Two);
    let hub = builder.particle(Particle::at("hub", [0.1, 0.2]));
    for i in 0..60_000 {
        let angle = f64::from(i);
        let end = builder.particle(Particle::at(format!("s{i}"), [angle.cos(), angle.sin()]).fixed());
        builder.constraint(format!("spoke {i}"), Distance::new(hub, end, 1.0));
    }
    let refused = builder.build().unwrap_err();
    let BuildError::TooLarge { constraint, rows, memory, limit } = &refused else { panic!("{refused}") };
    assert_eq!((constraint.as_str(), *rows), ("spoke 0", 60_000));
    assert!(memory > limit, "{memory} of {limit} bytes");
    assert!(refused.to_string().contains("60000 rows that hang together with constraint `spoke 0`"), "{refused}");
}
