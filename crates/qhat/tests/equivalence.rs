//! Every fast path equals one slow dense reference: the sparse and the dense factorization against an eigenvalue
//! decomposition by Jacobi's method, redundant systems against the pseudo-inverse, and any numbering of particles and
//! rows against any other.

use crate::systems;
use crate::systems::dense::{assert_all_close, assert_close, difference, dot, eigen, largest, multiply, norm};
use crate::systems::random::{Random, web};
use qhat::{
    Constraint, Dimension, Distance, Force, Integrator, Nail, NamedConstraint, Particle, ParticleId, Settings,
    Simulation, State, System, Terms, Warning, Workspace, evaluate, project,
};

/// The least-norm solution of (S A S) x = S b, S = diag(A)^(−½), as λ = S x, through the eigenvalues of S A S. Returns
/// λ and the rank: eigenvalues below 1e-11 of the largest count as zero.
fn reference(terms: &Terms) -> (Vec<f64>, usize) {
    let (m, A) = (terms.right_hand_side.len(), &terms.constraint_matrix);
    let scale = |i: usize| if A.get(i, i) > 0.0 { 1.0 / A.get(i, i).sqrt() } else { 0.0 };
    let M = (0..m * m).map(|k| scale(k / m) * A.get(k / m, k % m) * scale(k % m)).collect();
    let (sigma, U) = eigen(M, m);
    let cut = 1e-11 * largest(&sigma);
    let mut lambda = vec![0.0; m];
    let mut rank = 0;
    for (sigma, u) in sigma.iter().zip(&U).filter(|(sigma, _)| **sigma > cut) {
        rank += 1;
        let share = (0..m).map(|i| u[i] * scale(i) * terms.right_hand_side[i]).sum::<f64>() / sigma;
        for i in 0..m {
            lambda[i] += scale(i) * u[i] * share;
        }
    }
    (lambda, rank)
}

/// The reference itself: the matrix (−1, 2, −1) of n rows has the eigenvalues 2 − 2 cos(kπ/(n + 1)), and every
/// eigenvector is orthogonal to all others.
#[test]
fn the_reference_finds_known_eigenvalues() {
    let n = 60_usize;
    let A: Vec<f64> = (0..n * n)
        .map(|k| match (k / n).abs_diff(k % n) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        })
        .collect();
    let (sigma, U) = eigen(A.clone(), n);
    let mut sorted = sigma.clone();
    sorted.sort_by(f64::total_cmp);
    let expected = (1..=n).map(|k| 2.0 - 2.0 * libm::cos(k as f64 * std::f64::consts::PI / (n + 1) as f64));
    // Roundoff of some thousand rotations of each row.
    assert_all_close("σ", &sorted, &expected.collect::<Vec<_>>(), 1e-13);
    for (i, (sigma, u)) in sigma.iter().zip(&U).enumerate() {
        let scaled: Vec<f64> = u.iter().map(|u| sigma * u).collect();
        assert_all_close("A u = σ u", &multiply(&A, u), &scaled, 1e-12);
        for (j, other) in U.iter().enumerate() {
            assert_close("Uᵀ U", dot(u, other), if i == j { 1.0 } else { 0.0 }, 1e-12);
        }
    }
}

/// q̈ = W (Q + Jᵀ λ).
fn accelerations(system: &System, terms: &Terms, lambda: &[f64]) -> Vec<f64> {
    let Jt = systems::dense::multiply_transposed(&terms.jacobian.to_dense(), terms.positions.len(), lambda);
    let W = |k: usize| system.inverse_masses()[k / system.dimension()];
    Jt.iter().enumerate().map(|(k, force)| W(k) * (terms.applied_forces[k] + force)).collect()
}

fn check(name: &str, system: &System, state: &State) {
    let terms = evaluate(system, state);
    let (lambda, rank) = reference(&terms);
    let qdd = accelerations(system, &terms, &lambda);
    // The error of the eigenvalue decomposition is about 1e-14 of the norm of A; chains and trusses multiply it by 1e2
    // to 1e3.
    let scale = largest(&qdd).max(largest(&terms.right_hand_side)).max(1.0);
    assert_all_close(&format!("{name}: q̈"), &terms.accelerations, &qdd, 1e-10 * scale);
    let size = largest(&lambda).max(1e-3);
    for (row, (found, expected)) in terms.multipliers.iter().zip(&lambda).enumerate() {
        // The others are a share, which `share.rs` compares with its definition.
        if terms.multiplier_is_unique[row] {
            assert_close(&format!("{name}: λ of row {row}"), *found, *expected, 1e-8 * size);
        }
    }
    assert_eq!(terms.rank, Some(rank), "{name}: rank of {} rows", system.row_count());
    assert_eq!(terms.warnings.contains(&Warning::Singular), rank < system.row_count(), "{name}");
}

/// A hub with `arms` rods, some of them with a second rod at the end.
fn star(arms: usize) -> (System, State) {
    let mut builder = System::builder(Dimension::Three);
    let hub = builder.particle(Particle::at("hub", [0.0; 3]).with_velocity([1.0, 0.0, 0.0]).with_mass(2.0));
    for i in 0..arms {
        let angle = 2.4 * i as f64;
        let x = [libm::cos(angle), libm::sin(angle), 0.02 * i as f64];
        let tip = builder.particle(Particle::at(format!("t{i}"), x).with_mass(0.1 + 0.05 * i as f64));
        builder.constraint(format!("arm{i}"), Distance::new(hub, tip, norm(&x)));
        if i % 3 == 0 {
            let end = builder.particle(Particle::at(format!("e{i}"), [2.0 * x[0], 2.0 * x[1], 1.0]));
            let d = [x[0], x[1], 1.0 - x[2]];
            builder.constraint(format!("end{i}"), Distance::new(tip, end, norm(&d)));
        }
    }
    builder.with_force(systems::gravity()).force(qhat::Drag { coefficient: 0.3 });
    builder.build().unwrap()
}

/// Two free hubs with many rods each: to shared particles, to particles that a rod or a nail holds, to particles with a
/// second rod to the hub (`redundant`), to each other and to fixed particles.
fn hubs(d: usize, redundant: bool) -> (System, State) {
    let mut builder = System::builder(systems::random::dimension(d));
    let mut random = Random::new(7 + d as u64);
    let place = |random: &mut Random, x: f64| {
        let offset = random.numbers(d, -0.4, 0.4);
        offset.iter().enumerate().map(|(k, y)| y + if k == 0 { x } else { 5.0 }).collect::<Vec<f64>>()
    };
    let apart = |a: &[f64], b: &[f64]| norm(&difference_of(a, b));
    let (left, right) = (vec![-1.0; d], vec![2.0; d]);
    let a = builder.particle(Particle::at("a", left.clone()).with_mass(0.3));
    let b = builder.particle(Particle::at("b", right.clone()).with_mass(5.0));
    let ground = builder.particle(Particle::at("ground", vec![0.0; d]).fixed());
    builder.constraint("a b", Distance::new(a, b, apart(&left, &right)));
    builder.constraint("a ground", Distance::new(a, ground, norm(&left)));
    for i in 0..56 {
        let x = place(&mut random, 0.1 * f64::from(i) - 2.0);
        let tip = builder.particle(Particle::at(format!("t{i}"), x.clone()).with_mass(0.1 + 0.01 * f64::from(i)));
        builder.constraint(format!("a{i}"), Distance::new(a, tip, apart(&left, &x)));
        if i % 2 == 0 || i > 40 {
            builder.constraint(format!("b{i}"), Distance::new(b, tip, apart(&right, &x)));
        }
        if i % 8 == 1 {
            builder.constraint(format!("g{i}"), Distance::new(tip, ground, norm(&x)));
        }
        if i == 3 {
            builder.constraint(
                "nail",
                Nail::new(tip, std::array::from_fn::<_, 3, _>(|k| x.get(k).copied().unwrap_or(0.0))),
            );
        }
        if redundant && i % 20 == 5 {
            builder.constraint(format!("again{i}"), Distance::new(a, tip, apart(&left, &x)));
        }
    }
    for i in 0..40 {
        let x = place(&mut random, 0.1 * f64::from(i));
        let tip = builder.particle(Particle::at(format!("u{i}"), x.clone()));
        builder.constraint(format!("c{i}"), Distance::new(b, tip, apart(&right, &x)));
    }
    builder.force(systems::gravity());
    builder.build().unwrap()
}

fn difference_of(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Hubs have unknowns of their own; λ, the rank and the warnings are the same as for A.
#[test]
fn long_hubs_change_nothing() {
    for d in [2, 3] {
        for redundant in [false, true] {
            let (system, state) = hubs(d, redundant);
            check(&format!("hubs in {d} dimensions, redundant: {redundant}"), &system, &state);
        }
    }
}

/// The same system with velocities that are not zero, so that γ is not zero, and meet Ċ = 0, so that redundant rows
/// agree about C̈.
fn moving(random: &mut Random, (system, state): (System, State)) -> (System, State) {
    let d = system.dimension();
    let v = (0..state.velocities().len()).map(|k| {
        let v = random.within(-1.0, 1.0);
        if system.inverse_masses()[k / d] == 0.0 { 0.0 } else { v }
    });
    let mut state = state.with_motion(state.positions().to_vec(), v.collect());
    project(&system, &mut state, &Settings::default(), &mut Workspace::new(&system)).unwrap();
    (system, state)
}

/// Regular systems on both sides of the limit of 24 rows at which the sparse factorization takes over.
#[test]
fn multipliers_equal_the_dense_reference() {
    let mut random = Random::new(9);
    let mut cases = vec![("pendulum", systems::pendulum(1.0)), ("double pendulum", systems::double_pendulum())];
    cases.extend([2, 23, 24, 25, 26, 80].map(|n| ("chain", systems::chain(n, 1.0))));
    cases.extend([10, 40].map(|n| ("heavy chain", systems::chain(n, 1000.0))));
    cases.extend([2, 3, 4, 6].map(|n| ("net", systems::net(n))));
    cases.extend([1, 4, 5, 20].map(|n| ("truss", systems::truss(n, false))));
    cases.extend([3, 18, 19, 60].map(|n| ("star", star(n))));
    cases.push(("free structure", systems::free_structure()));
    for (name, case) in cases {
        let (system, state) = moving(&mut random, case);
        check(&format!("{name} of {} rows", system.row_count()), &system, &state);
    }
    for (d, n) in [(2, 5), (2, 24), (2, 60), (3, 12), (3, 50)] {
        let (system, state) = web(&mut random, d, n);
        check(&format!("web of {n} in {d}D"), &system, &state);
    }
}

/// Redundant rows: q̈ agrees with the pseudo-inverse to 1e-10, and λ to 1e-8 where it is unique.
#[test]
fn redundant_systems_equal_the_pseudo_inverse() {
    let mut random = Random::new(10);
    for panels in [2, 4, 8, 20] {
        let (system, state) = moving(&mut random, systems::truss(panels, true));
        check(&format!("braced truss of {panels}"), &system, &state);
    }
    // Every row twice, and the nails of a net three times: many null vectors at once.
    for (name, case, times) in
        [("net", systems::net(3), 2), ("chain", systems::chain(9, 5.0), 3), ("long chain", systems::chain(30, 5.0), 2)]
    {
        let (system, state) = moving(&mut random, case);
        let copies = (0..times).flat_map(|k| system.constraints().iter().map(move |c| (k, c)));
        let rows = copies.map(|(k, c)| NamedConstraint { name: format!("{} {k}", c.name), ..c.clone() }).collect();
        let (system, state) = rebuilt(&system, &state, &Numbering::of(&system, rows));
        check(&format!("{name}, {times} times"), &system, &state);
    }
}

/// Rows that contradict each other about C̈, as with velocities that no redundant row allows: the rows that were kept
/// are met exactly, so that the contradiction stays in the row that was left out, and λ stays bounded.
#[test]
fn contradicting_rows_are_met_but_for_those_left_out() {
    let mut random = Random::new(14);
    for (system, state) in [systems::truss(4, true), systems::net(2)] {
        let state = state.with_motion(state.positions().to_vec(), random.numbers(state.velocities().len(), -1.0, 1.0));
        let terms = evaluate(&system, &state);
        let (lambda, rank) = reference(&terms);
        assert_eq!((terms.rank, rank), (Some(system.row_count() - 1), system.row_count() - 1));
        let J = terms.jacobian.to_dense();
        let coordinates = terms.positions.len();
        let Cdd: Vec<f64> = (0..system.row_count())
            .map(|row| {
                let along = (0..coordinates).map(|k| J[row * coordinates + k] * terms.accelerations[k]);
                along.sum::<f64>() + terms.acceleration_bias[row]
            })
            .collect();
        // Roundoff of accelerations of size 10 to 1000, over twenty terms.
        let size = largest(&terms.accelerations);
        let missed = Cdd.iter().filter(|Cdd| Cdd.abs() > 1e-11 * size).count();
        assert_eq!(missed, 1, "{Cdd:?}");
        // The one row is missed by what the rows contradict each other, which the least residual shares among all.
        assert!(largest(&terms.multipliers) < 100.0 * largest(&lambda), "{:?}", terms.multipliers);
    }
}

/// A new numbering: particle `particles[i]` comes i-th.
struct Numbering {
    particles: Vec<usize>,
    constraints: Vec<NamedConstraint>,
}

impl Numbering {
    fn of(system: &System, constraints: Vec<NamedConstraint>) -> Self {
        Numbering { particles: (0..system.particle_count()).collect(), constraints }
    }
}

/// The same system in the new numbering.
fn rebuilt(system: &System, state: &State, numbering: &Numbering) -> (System, State) {
    let d = system.dimension();
    let new = |old: ParticleId| systems::id(numbering.particles.iter().position(|&i| i == old.index()).unwrap());
    let mut builder = System::builder(systems::random::dimension(d));
    for &i in &numbering.particles {
        let (x, v) = (&state.positions()[i * d..][..d], &state.velocities()[i * d..][..d]);
        let particle = Particle::at(system.particle_names()[i].clone(), x).with_mass(system.masses()[i]);
        let fixed = system.inverse_masses()[i] == 0.0;
        builder.particle(if fixed { particle.fixed() } else { particle.with_velocity(v) });
    }
    for named in &numbering.constraints {
        let constraint: Constraint = match named.constraint.clone() {
            Constraint::Distance(rod) => Distance { a: new(rod.a), b: new(rod.b), ..rod }.into(),
            Constraint::Nail(nail) => Nail { particle: new(nail.particle), ..nail }.into(),
            other => panic!("these systems have no {other:?}"),
        };
        builder.constraint(named.name.clone(), constraint);
    }
    for force in system.forces() {
        builder.force(match force.clone() {
            Force::Spring(s) => qhat::Spring { a: new(s.a), b: new(s.b), ..s }.into(),
            Force::PointForce(f) => qhat::PointForce { particle: new(f.particle), ..f }.into(),
            Force::MouseSpring(m) => qhat::MouseSpring { particle: new(m.particle), ..m }.into(),
            other => other,
        });
    }
    builder.feedback(*system.feedback());
    builder.build().unwrap()
}

/// Particles and rows in a random order, and back.
#[test]
fn renumbering_changes_nothing() {
    let mut random = Random::new(12);
    let mut cases = vec![systems::chain(12, 3.0), systems::chain(40, 3.0), systems::net(4), star(20)];
    cases.extend([systems::truss(8, true), systems::free_structure()]);
    let mut cases: Vec<_> = cases.into_iter().map(|case| moving(&mut random, case)).collect();
    cases.extend([(2, 9), (3, 30)].map(|(d, n)| web(&mut random, d, n)));
    for (system, state) in cases {
        let rows = random.order(system.constraints().len()).into_iter().map(|i| system.constraints()[i].clone());
        let rows = rows.collect();
        let numbering = Numbering { particles: random.order(system.particle_count()), constraints: rows };
        let (other, other_state) = rebuilt(&system, &state, &numbering);
        let (a, b) = (evaluate(&system, &state), evaluate(&other, &other_state));

        let d = system.dimension();
        let place = |i: usize| numbering.particles.iter().position(|&p| p == i).unwrap();
        let back = |flat: &[f64]| -> Vec<f64> {
            (0..system.particle_count()).flat_map(|i| flat[place(i) * d..][..d].to_vec()).collect()
        };
        // Sums in another order and another elimination: roundoff, times a condition of up to 1e4.
        let scale = largest(&a.accelerations).max(largest(&a.right_hand_side));
        assert_all_close("q̈", &back(&b.accelerations), &a.accelerations, 1e-11 * scale);
        for (row, name) in system.row_names().iter().enumerate() {
            let other_row = other.row_names().iter().position(|n| n == name).unwrap();
            let off = (a.multipliers[row] - b.multipliers[other_row]).abs();
            assert!(off <= 1e-9 * largest(&a.multipliers), "λ of {name}: off by {off:e}");
        }
        assert_eq!(a.rank, b.rank);
    }
}

/// The motion does not depend on the numbering, either, as long as it is not chaotic.
#[test]
fn renumbering_changes_no_motion() {
    let (system, state) = systems::net(4);
    let mut random = Random::new(13);
    let rows = random.order(system.constraints().len()).into_iter().map(|i| system.constraints()[i].clone()).collect();
    let numbering = Numbering { particles: random.order(system.particle_count()), constraints: rows };
    let (other, other_state) = rebuilt(&system, &state, &numbering);
    for integrator in [Integrator::Rattle, Integrator::Rk4, Integrator::Euler] {
        let settings = systems::settings(integrator, if integrator.is_adaptive() { 0.01 } else { 1e-4 });
        let mut a = Simulation::new(system.clone(), state.clone(), settings).unwrap();
        let mut b = Simulation::new(other.clone(), other_state.clone(), settings).unwrap();
        for _ in 0..if integrator.is_adaptive() { 10 } else { 1000 } {
            a.step().unwrap();
            b.step().unwrap();
        }
        let (a, b) = (a.state().positions(), b.state().positions());
        let place = |i: usize| numbering.particles.iter().position(|&p| p == i).unwrap();
        let back: Vec<f64> = (0..16).flat_map(|i| b[place(i) * 3..][..3].to_vec()).collect();
        // Newton stops at half of 1e-10 in either numbering; roundoff alone would leave 1e-13.
        assert!(difference(a, &back) < 1e-8, "{integrator}: off by {:e}", difference(a, &back));
    }
}

/// Several small systems side by side are factored sparsely, and each of them alone densely: the same numbers.
#[test]
fn sparse_equals_dense() {
    let (system, state) = systems::truss(4, false);
    let alone = evaluate(&system, &state);
    assert!(system.row_count() <= 24);
    let mut builder = System::builder(Dimension::Two);
    for copy in 0..3 {
        for (i, x) in state.positions().chunks(2).enumerate() {
            let particle = Particle::at(format!("{i} of {copy}"), x).with_mass(system.masses()[i]);
            builder.particle(if system.inverse_masses()[i] == 0.0 { particle.fixed() } else { particle });
        }
        let shift = |id: ParticleId| systems::id(id.index() + copy * system.particle_count());
        for named in system.constraints() {
            let constraint: Constraint = match named.constraint.clone() {
                Constraint::Distance(rod) => Distance { a: shift(rod.a), b: shift(rod.b), ..rod }.into(),
                Constraint::Nail(nail) => Nail { particle: shift(nail.particle), ..nail }.into(),
                other => panic!("these systems have no {other:?}"),
            };
            builder.constraint(format!("{} of {copy}", named.name), constraint);
        }
    }
    builder.force(systems::gravity());
    let (triple, triple_state) = builder.build().unwrap();
    let together = evaluate(&triple, &triple_state);
    for copy in together.multipliers.chunks(system.row_count()) {
        // Another order of elimination: roundoff times a condition of about 1e2.
        assert_all_close("λ", copy, &alone.multipliers, 1e-12 * largest(&alone.multipliers));
    }
}
