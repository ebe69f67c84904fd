//! The multiplier solve on systems of known shape, timed beside its residual:
//! `cargo test --release --package qhat --lib -- --ignored --nocapture timed`.

use super::Equation;
use crate::point::Motion;
use crate::{Dimension, Distance, Gravity, Particle, ParticleId, State, System, SystemBuilder};
use std::time::Instant;

fn plane() -> SystemBuilder {
    let mut builder = System::builder(Dimension::Two);
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder
}

fn add(builder: &mut SystemBuilder, x: [f64; 2], fixed: bool) -> ParticleId {
    let particle = Particle::at(format!("{} {}", x[0], x[1]), x).with_mass(0.01);
    builder.particle(if fixed { particle.fixed() } else { particle })
}

fn rod(builder: &mut SystemBuilder, a: ParticleId, b: ParticleId, length: f64) {
    builder.constraint(format!("{} {}", a.0, b.0), Distance::new(a, b, length));
}

fn chain(links: usize) -> (System, State) {
    let mut builder = plane();
    let ids: Vec<ParticleId> = (0..=links).map(|i| add(&mut builder, [i as f64 * 0.01, 0.0], i == 0)).collect();
    for pair in ids.windows(2) {
        rod(&mut builder, pair[0], pair[1], 0.01);
    }
    builder.build().unwrap()
}

/// A Warren truss, one end pinned and one on a rod to the ground.
fn truss(panels: usize) -> (System, State) {
    let mut builder = plane();
    let place = |i: usize| [i as f64 * 0.5, if i.is_multiple_of(2) { 0.0 } else { 0.8 }];
    let ids: Vec<ParticleId> = (0..=2 * panels).map(|i| add(&mut builder, place(i), i == 0)).collect();
    let ground = add(&mut builder, [panels as f64, -1.0], true);
    rod(&mut builder, ids[2 * panels], ground, 1.0);
    let side = (0.25_f64 + 0.64).sqrt();
    for i in 0..2 * panels {
        rod(&mut builder, ids[i], ids[i + 1], side);
        if i + 2 <= 2 * panels {
            rod(&mut builder, ids[i], ids[i + 2], 1.0);
        }
    }
    builder.build().unwrap()
}

/// N × N particles in an arc, structural rods only, two corners held.
fn net(n: usize) -> (System, State) {
    let mut builder = plane();
    let place = |i: usize, j: usize| {
        let s = (j as f64 + 0.5) / n as f64 - 0.5;
        [j as f64, -(i as f64) - 0.3 * n as f64 * (0.25 - s * s)]
    };
    let mut ids = Vec::new();
    for i in 0..n {
        for j in 0..n {
            ids.push(add(&mut builder, place(i, j), i == 0 && (j == 0 || j == n - 1)));
        }
    }
    let rise = |i: usize, j: usize| place(i, j)[1] - place(i, j + 1)[1];
    for i in 0..n {
        for j in 0..n {
            if j + 1 < n {
                rod(&mut builder, ids[i * n + j], ids[i * n + j + 1], (1.0 + rise(i, j) * rise(i, j)).sqrt());
            }
            if i + 1 < n {
                rod(&mut builder, ids[i * n + j], ids[(i + 1) * n + j], 1.0);
            }
        }
    }
    builder.build().unwrap()
}

/// Rods from one free particle to many.
fn star(spokes: usize) -> (System, State) {
    let mut builder = plane();
    let hub = add(&mut builder, [0.0, 0.0], false);
    for i in 0..spokes {
        let (angle, radius) = (i as f64 * 0.1, 1.0 + i as f64 * 1e-3);
        let tip = add(&mut builder, [radius * libm::cos(angle), radius * libm::sin(angle)], false);
        rod(&mut builder, hub, tip, radius);
    }
    builder.build().unwrap()
}

/// J W Jᵀ λ.
fn multiply(system: &System, equation: &Equation, lambda: &[f64]) -> Vec<f64> {
    let mut qdd = vec![0.0; system.coordinate_count()];
    equation.rows.J.add_transposed::<2>(lambda, &mut qdd);
    for (i, w) in system.inverse_mass.iter().enumerate() {
        qdd[2 * i] *= w;
        qdd[2 * i + 1] *= w;
    }
    let mut product = vec![0.0; lambda.len()];
    equation.rows.J.multiply::<2>(&qdd, &mut product);
    product
}

fn timed(name: &str, build: &dyn Fn() -> (System, State)) {
    let clock = Instant::now();
    let (system, state) = build();
    let built = clock.elapsed().as_secs_f64();
    let m = system.all_row_count();
    let clock = Instant::now();
    let mut equation = Equation::new(&system);
    let made = clock.elapsed().as_secs_f64();
    equation.constrain(&system, Motion::<2> { q: &state.q, qd: &state.qd, t: state.t });
    let known: Vec<f64> = (0..m).map(|i| (i as f64 * 0.618).fract() - 0.4).collect();
    let b = multiply(&system, &equation, &known);
    let mut lambda = vec![0.0; m];
    let (mut factor, mut solve) = (f64::INFINITY, f64::INFINITY);
    let start = Instant::now();
    for turn in 0..100_000 {
        let clock = Instant::now();
        equation.factor::<2>(&system, 0.0);
        factor = factor.min(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        equation.solver.solve(&system.matrix, &b, &mut lambda);
        solve = solve.min(clock.elapsed().as_secs_f64());
        if turn >= 4 && start.elapsed().as_secs_f64() > 0.5 {
            break;
        }
    }
    let back = multiply(&system, &equation, &lambda);
    let residual = (0..m).map(|i| (back[i] - b[i]).abs()).fold(0.0, f64::max);
    println!(
        "{name:>11} {m:>8} rows: build {built:.3} s, workspace {made:.3} s, factor {:.4} ms ({:.1} ns/row), \
         solve {:.4} ms ({:.1} ns/row), residual {residual:.1e}{}",
        factor * 1e3,
        factor / m as f64 * 1e9,
        solve * 1e3,
        solve / m as f64 * 1e9,
        if equation.solver.dependent().is_empty() { "" } else { ", singular" }
    );
}

type Case<'a> = (&'a str, &'a dyn Fn() -> (System, State));

#[test]
#[ignore = "a measurement, not a check"]
fn timed_solves() {
    let only = std::env::var("QHAT_TIMED").unwrap_or_default();
    let cases: [Case; 13] = [
        ("chain100", &|| chain(100)),
        ("chain1e6", &|| chain(1_000_000)),
        ("truss20", &|| truss(20)),
        ("truss200", &|| truss(200)),
        ("truss20000", &|| truss(20_000)),
        ("net10", &|| net(10)),
        ("net32", &|| net(32)),
        ("net100", &|| net(100)),
        ("star30", &|| star(30)),
        ("star50", &|| star(50)),
        ("star1000", &|| star(1000)),
        ("net316", &|| net(316)),
        ("net1000", &|| net(1000)),
    ];
    for (name, build) in &cases {
        if only.split(',').any(|word| word == *name) || only.is_empty() {
            timed(name, build);
        }
    }
}

/// Redundant rods between a hub and its tips make A singular; three rods in a plane that hold a tip do not.
#[test]
fn a_hub_is_not_mistaken_for_a_redundancy() {
    for redundant in [false, true] {
        let mut builder = System::builder(Dimension::Three);
        let at = |x: f64, y: f64, z: f64| Particle::at(format!("{x} {y} {z}"), [x, y, z]);
        let hub = builder.particle(at(0.0, 0.0, 0.0));
        let anchors = [[-1.0, 5.0, 0.0], [1.0, 5.0, 0.0]].map(|x| builder.particle(at(x[0], x[1], x[2]).fixed()));
        for i in 0..40 {
            let (angle, z) = (0.3 * f64::from(i), if i == 0 { 0.0 } else { 1.0 });
            let tip = builder.particle(at(libm::cos(angle), libm::sin(angle), z));
            let length = (1.0 + z * z).sqrt();
            rod(&mut builder, hub, tip, length);
            if i == 0 {
                // In one plane with the rod to the hub.
                rod(&mut builder, tip, anchors[0], 29.0_f64.sqrt());
                rod(&mut builder, tip, anchors[1], 5.0);
            }
            if redundant && i == 7 {
                builder.constraint("again", Distance::new(hub, tip, length));
            }
        }
        let (system, state) = builder.build().unwrap();
        assert_eq!(system.components()[0].hubs, 1);
        let terms = crate::evaluate(&system, &state);
        assert_eq!(terms.warnings == [crate::Warning::Singular], redundant, "{:?}", terms.warnings);
        assert_eq!(terms.rank, Some(42), "of {} rows", system.all_row_count());
    }
}

/// The memory estimated before anything is allocated is within a factor of two of the memory of the factor.
#[test]
fn memory_is_estimated() {
    for (name, (system, _)) in [("truss", truss(200)), ("net", net(60)), ("star", star(1000)), ("chain", chain(1000))] {
        let estimated: u64 = system.components().iter().map(|component| component.memory).sum();
        let taken = crate::linalg::Factor::with(&system.matrix.symbolic).memory() as u64;
        assert!(estimated < 2 * taken && taken < 2 * estimated, "{name}: {estimated} estimated, {taken} bytes taken");
    }
}
