//! Compares the chains in lanes with the general path, and plain f64 with the vector unit.

use super::*;
use crate::linalg::eight::Largest;
use crate::settings::{Feedback, Settings};
use crate::space::{Dimension, ParticleId};
use crate::system::Particle;
use crate::{Distance, Drag, Gravity, Integrator, MouseSpring, Nail, PointForce, Spring, Workspace, project, step};
use pulp::Arch;

/// Numbers in (−1, 1) without a visible order: Knuth's linear congruential generator.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Moving chains of the given numbers of links along random walks. The first particle of every third chain is fixed,
/// the last particle of every fourth is nailed. All kinds of forces act.
fn chains(dimension: Dimension, lengths: &[usize]) -> (System, State) {
    let numbers = &mut Numbers(7);
    let d = dimension.number();
    let mut builder = System::builder(dimension);
    for (k, &links) in lengths.iter().enumerate() {
        let mut x: Vec<f64> = (0..d).map(|_| 3.0 * numbers.next()).collect();
        let mut before: Option<ParticleId> = None;
        for i in 0..=links {
            let velocity: Vec<f64> = (0..d).map(|_| numbers.next()).collect();
            let particle = Particle::at(format!("{k}-{i}"), x.clone()).with_mass(1.5 + numbers.next());
            let is_held = i == 0 && k % 3 == 0;
            let id = builder.particle(if is_held { particle.fixed() } else { particle.with_velocity(velocity) });
            if k % 4 == 3 && i == links {
                builder.constraint(
                    format!("nail {k}"),
                    Nail::new(id, std::array::from_fn::<_, 3, _>(|c| *x.get(c).unwrap_or(&0.0))),
                );
            }
            let step: Vec<f64> = (0..d).map(|c| 0.5 * numbers.next() + if c == 0 { 0.7 } else { 0.0 }).collect();
            if let Some(before) = before {
                builder.constraint(format!("rod {k}-{i}"), Distance::new(before, id, 1.0));
            }
            for c in 0..d {
                x[c] += step[c];
            }
            before = Some(id);
        }
    }
    let last = ParticleId(lengths.iter().map(|links| links + 1).sum::<usize>() - 1);
    builder.with_force(Gravity { acceleration: [0.3, -9.81, 1.0] }).force(Drag { coefficient: 0.2 });
    builder.force(PointForce { particle: last, force: [1.0, 2.0, 3.0] });
    builder.force(MouseSpring { particle: last, target: [0.0; 3], stiffness: 5.0, damping: 0.5 });
    builder.force(Spring { a: ParticleId(0), b: last, stiffness: 3.0, damping: 0.1, rest: 0.5 });
    let (system, mut state) = builder.build().unwrap();
    // The steps of the walk have different lengths; the projection brings them onto rods of one metre.
    let settings = Settings { constraint_tolerance: 1e-13, ..Settings::default() };
    project(&system, &mut state, &settings, &mut Workspace::new(&system)).unwrap();
    (system, state)
}

fn cases() -> Vec<(System, State)> {
    let mut cases = Vec::new();
    for dimension in [Dimension::Two, Dimension::Three] {
        for links in [1, 2, 7, 15, 16, 17, 24, 33, 100] {
            cases.push(chains(dimension, &[links]));
        }
        cases.push(chains(dimension, &[0, 0, 3]));
        cases.push(chains(dimension, &[20; 11]));
        cases.push(chains(dimension, &[60, 5, 4, 4, 3, 2, 2, 1, 1, 0, 40, 1]));
    }
    cases
}

struct Laid {
    lanes: Chains,
    q: Vec<F8>,
    qd: Vec<F8>,
}

fn lay<const D: usize>(system: &System, plan: &ChainPlan, state: &State) -> Laid {
    let array = || vec![F8::ZERO; plan.blocks() * D];
    let mut laid = Laid { lanes: Chains::new(system, plan), q: array(), qd: array() };
    laid.lanes.begin::<D>(system, plan, state, &mut laid.q, &mut laid.qd);
    laid
}

/// q̈ computed in lanes, in the user's order.
fn accelerations<const D: usize>(system: &System, state: &State) -> Vec<f64> {
    let plan = system.chains.as_ref().expect("nothing but chains");
    let Laid { mut lanes, q, qd } = lay::<D>(system, plan, state);
    let mut qdd = q.clone();
    lanes.accelerate::<D>(system, plan, &q, &qd, 0.0, &mut qdd).expect("regular");
    let mut laid = state.clone();
    lanes.end::<D>(plan, &q, &qdd, &mut laid);
    let home = |k: usize| plan.home(k / D).is_some();
    laid.qd.iter().enumerate().map(|(k, &a)| if home(k) { a } else { 0.0 }).collect()
}

#[test]
fn accelerations_are_those_of_the_general_path() {
    for (system, state) in cases() {
        let terms = Workspace::new(&system).terms(&system, &state, &Feedback::NONE);
        let is_planar = system.dimension() == 2;
        let lanes = if is_planar { accelerations::<2>(&system, &state) } else { accelerations::<3>(&system, &state) };
        let scale = terms.accelerations.iter().fold(1.0_f64, |most, a| most.max(a.abs()));
        for (k, (a, b)) in lanes.iter().zip(&terms.accelerations).enumerate() {
            // The state meets C = Ċ = 0 to 1e-13, and a chain multiplies roundoff by up to the square of its length.
            assert!((a - b).abs() <= 1e-9 * scale, "{} rods, coordinate {k}: {a} and {b}", system.row_count());
        }
    }
}

/// Only the sweep could give different numbers on different vector units: it agrees on plain f64 and on the widest unit
/// of this machine.
#[test]
fn every_vector_unit_gives_the_same_bits() {
    for (system, state) in cases().into_iter().filter(|(system, _)| system.dimension() == 3) {
        let plan = system.chains.as_ref().unwrap();
        let Laid { mut lanes, q, qd } = lay::<3>(&system, plan, &state);
        let (mut plain, mut wide) = (q.clone(), q.clone());
        for (unit, out) in [(Arch::Scalar, &mut plain), (Arch::new(), &mut wide)] {
            let right = &|_, at: Range<usize>| Acceleration { qd: &qd[at.clone()], WQ: &q[at] };
            let (groups, rows) = (&plan.groups[..], &mut lanes.rows[..]);
            assert!(unit.dispatch(Solve::<_, 3> { plan, groups, q: &q, right, rows, out, tiny: super::TINY_PIVOT }));
        }
        let bits = |numbers: &[F8]| numbers.iter().flat_map(|x| x.0.map(f64::to_bits)).collect::<Vec<u64>>();
        assert_eq!(bits(&plain), bits(&wide), "{} rods", system.row_count());
    }
}

#[test]
fn projection_reaches_both_constraints() {
    for (system, mut state) in cases().into_iter().filter(|(system, _)| system.dimension() == 2) {
        let plan = system.chains.as_ref().unwrap();
        let numbers = &mut Numbers(3);
        for (x, v) in state.q.iter_mut().zip(&mut state.qd) {
            *x += 1e-3 * numbers.next();
            *v += 0.1 * numbers.next();
        }
        let Laid { mut lanes, mut q, mut qd } = lay::<2>(&system, plan, &state);
        // Newton's method squares the error in each iteration: 1e-3, 1e-6, 1e-12, roundoff.
        let outcome = lanes.project::<2>(plan, &mut q, &mut qd, 1e-13);
        assert!(matches!(outcome, Projected::Met(1..=4)), "{outcome:?}");
        lanes.end::<2>(plan, &q, &qd, &mut state);
        let terms = Workspace::new(&system).terms(&system, &state, &Feedback::NONE);
        assert!(terms.residual.iter().all(|C| C.abs() < 1e-12));
        assert!(terms.residual_rate.iter().all(|Cd| Cd.abs() < 1e-12));
        let drift = lanes.drift::<2>(plan, &q, &qd);
        assert!(drift.relative_length < 1e-13 && drift.residual_rate < 1e-12);
    }
}

#[test]
fn only_open_chains_have_a_plan() {
    let build = |rods: &[(usize, usize)], held: usize| {
        let mut builder = System::builder(Dimension::Two);
        for i in 0..5 {
            let particle = Particle::at(format!("{i}"), [i as f64, (i * i) as f64]);
            builder.particle(if i < held { particle.fixed() } else { particle });
        }
        for &(a, b) in rods {
            builder.constraint(format!("{a}{b}"), Distance::new(ParticleId(a), ParticleId(b), 1.0));
        }
        builder.build().unwrap().0.chains.is_some()
    };
    assert!(build(&[(0, 1), (1, 2)], 0), "free chain");
    assert!(build(&[(0, 1), (0, 2), (0, 3)], 1), "three pendulums on one fixed point");
    assert!(build(&[(1, 0), (3, 2), (1, 3)], 1), "in any order");
    assert!(build(&[], 0), "no rods");
    assert!(!build(&[(0, 1), (0, 2), (0, 3)], 0), "star");
    assert!(!build(&[(0, 1), (1, 2), (2, 0)], 0), "ring");
    assert!(!build(&[(0, 1), (1, 2)], 2), "a rod between fixed particles");
}

/// Two rods in one line between fixed points depend on each other: the general path takes over and gives the same
/// frame.
#[test]
fn a_taut_line_goes_over_to_the_general_path() {
    let mut builder = System::builder(Dimension::Two);
    let a = builder.particle(Particle::at("a", [0.0, 0.0]).fixed());
    let b = builder.particle(Particle::at("b", [1.0, 0.0]));
    let c = builder.particle(Particle::at("c", [2.0, 0.0]).fixed());
    builder.with_constraint("ab", Distance::new(a, b, 1.0)).constraint("bc", Distance::new(b, c, 1.0));
    builder.force(PointForce { particle: b, force: [1.0, 0.0, 0.0] });
    let (system, mut state) = builder.build().unwrap();
    let plan = system.chains.as_ref().unwrap();
    let Laid { mut lanes, q, qd } = lay::<2>(&system, plan, &state);
    assert_eq!(lanes.accelerate::<2>(&system, plan, &q, &qd, 0.0, &mut q.clone()), None);
    let settings = Settings { integrator: Integrator::Dop853, ..Settings::default() };
    let mut workspace = Workspace::new(&system);
    let report = step(&system, &mut state, &settings, &mut workspace).unwrap();
    assert_eq!(report.warnings, [crate::Warning::Singular]);
    assert_eq!(state.q, [0.0, 0.0, 1.0, 0.0, 2.0, 0.0]);
}

#[test]
fn the_largest_is_not_lost_beside_nan() {
    let mut numbers = [F8::splat(-2.0), F8::ZERO, F8::splat(1.0)];
    assert_eq!(Arch::new().dispatch(Largest(&numbers)), 2.0);
    for at in 0..3 {
        let good = std::mem::replace(&mut numbers[at].0[5], f64::NAN);
        assert!(Arch::new().dispatch(Largest(&numbers)).is_nan());
        numbers[at].0[5] = good;
    }
}
