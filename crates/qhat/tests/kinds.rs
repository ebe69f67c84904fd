//! Lengths, angles, gears, areas and volumes: each against differences, against the same constraint typed as an expression, and over a
//! motion under three integrators. Their closed forms are in `verify_kinds.rs`.

#![allow(non_snake_case, reason = "the letters of the equations keep their case")]

mod systems;

use qhat::{
    Angle, Area, Constraint, Dimension, Distance, Driven, Expression, Gears, Integrator, Lengths, Particle, ParticleId,
    Purpose, Scope, Settings, Simulation, State, System, Volume, evaluate,
};
use std::sync::LazyLock;
use systems::dense::{assert_all_close, assert_close, multiply};
use systems::random::{Random, dimension};

/// A kind, made for a time τ later than it is, and the expression that says the same. `T` in the texts is that later time.
struct Case {
    name: &'static str,
    d: usize,
    make: fn(Driven) -> Constraint,
    /// What it is driven by.
    drive: &'static str,
    /// What of the particles p0 … is held at the drive.
    held: &'static str,
    /// Whether C counts but for whole turns.
    turns: bool,
}

static P: LazyLock<[ParticleId; 6]> = LazyLock::new(|| std::array::from_fn(systems::id));

const CASES: &[Case] = &[
    Case {
        name: "tackle, with points passed twice, in the plane",
        d: 2,
        make: tackle,
        drive: "3 + 0.4*sin(2*T)",
        held: "dist(p0, p1) + 2*dist(p1, p2) + 0.5*dist(p1, p0)",
        turns: false,
    },
    Case {
        name: "tackle in space",
        d: 3,
        make: tackle,
        drive: "3 + 0.4*sin(2*T)",
        held: "dist(p0, p1) + 2*dist(p1, p2) + 0.5*dist(p1, p0)",
        turns: false,
    },
    Case {
        name: "ratio of lengths with a shared end",
        d: 3,
        make: |_| Lengths::ratio([P[0], P[1]], [P[1], P[3]], 1.7).into(),
        drive: "0",
        held: "dist(p0, p1) - 1.7*dist(p3, p1)",
        turns: false,
    },
    Case {
        name: "angle between arms",
        d: 2,
        make: |angle| Angle::between([P[0], P[1]], [P[2], P[3]], angle).into(),
        drive: "5*T + sin(T)",
        held: "atan2(cross(p1 - p0, p3 - p2), dot(p1 - p0, p3 - p2))",
        turns: true,
    },
    Case {
        name: "angle at a corner in space",
        d: 3,
        make: |angle| Angle::between([P[1], P[0]], [P[1], P[2]], angle).into(),
        drive: "1 + 0.3*sin(T)",
        held: "atan2(length(cross(p0 - p1, p2 - p1)), dot(p0 - p1, p2 - p1))",
        turns: true,
    },
    Case {
        name: "angle from a direction",
        d: 2,
        make: |angle| Angle::from_direction([1.0, 2.0, 7.0], [P[3], P[2]], angle).into(),
        drive: "-3*T",
        held: "atan2(cross([1, 2], p2 - p3), dot([1, 2], p2 - p3))",
        turns: true,
    },
    Case {
        name: "angle from a direction in space",
        d: 3,
        make: |angle| Angle::from_direction([1.0, 2.0, -1.0], [P[3], P[2]], angle).into(),
        drive: "1.2 + T/2",
        held: "atan2(length(cross([1, 2, -1], p2 - p3)), dot([1, 2, -1], p2 - p3))",
        turns: true,
    },
    Case {
        // 30 and -12 teeth: 5 and -2.
        name: "gears, one inside the other",
        d: 2,
        make: |angle| Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [30, -12], angle).into(),
        drive: "sin(3*T)",
        held: "5*atan2(p1.y - p0.y, p1.x - p0.x) - 2*atan2(p3.y - p2.y, p3.x - p2.x) - 3*atan2(p2.y - p0.y, p2.x - p0.x)",
        turns: true,
    },
    Case {
        name: "hands of a clock",
        d: 2,
        make: |angle| Gears::coupled(&[([P[0], P[1]], 12), ([P[0], P[2]], -1)], angle).into(),
        drive: "0.2",
        held: "12*atan2(p1.y - p0.y, p1.x - p0.x) - atan2(p2.y - p0.y, p2.x - p0.x)",
        turns: true,
    },
    Case {
        name: "rack and pinion",
        d: 2,
        make: |angle| Gears::rack([P[0], P[1]], P[2], [3.0, 4.0], 0.25, angle).into(),
        drive: "T^2",
        held: "atan2(p1.y - p0.y, p1.x - p0.x) - dot([0.6, 0.8], p2 - p0)/0.25",
        turns: true,
    },
    Case {
        name: "area",
        d: 2,
        make: |area| Area { corners: vec![P[0], P[2], P[1], P[4], P[3]], area }.into(),
        drive: "1 + T - T^2",
        held: "area(p0, p2, p1, p4, p3)",
        turns: false,
    },
    Case {
        name: "volume of a tetrahedron",
        d: 3,
        make: |volume| Volume::tetrahedron([P[2], P[0], P[1], P[3]], volume).into(),
        drive: "2 + cos(T)",
        held: "volume(p2, p0, p1, p3)",
        turns: false,
    },
    Case {
        name: "volume of two tetrahedra on one face",
        d: 3,
        make: |volume| {
            let faces = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4]];
            Volume::new(&faces.map(|corners| corners.map(|i| P[i])), volume).into()
        },
        drive: "2 + cos(T)",
        held: "volume(p0, p1, p2, p3) - volume(p0, p1, p2, p4)",
        turns: false,
    },
];

/// Back and forth between p0 and p1, once with half the weight.
fn tackle(total: Driven) -> Constraint {
    Lengths::new(&[([P[0], P[1]], 1.0), ([P[2], P[1]], 2.0), ([P[1], P[0]], 0.5)], total).into()
}

fn particle(name: &str) -> Option<ParticleId> {
    name.strip_prefix('p').and_then(|number| number.parse().ok()).map(systems::id)
}

fn schedule(text: &str, later: f64) -> Driven {
    let scope = Scope::new(Purpose::Time, Dimension::Two, &particle);
    Expression::parse(&text.replace('T', &format!("(t + ({later:?}))")), &scope).unwrap().into()
}

/// Random states tried for every kind.
const STATES: usize = 30;

/// As in `equations.rs`, with slopes that gears of five turns a turn make five times as large; the fifth derivative of an angle at 0.8 m
/// and 1 m/s, 5!/0.8⁵, is 400.
const DELTA: f64 = 1e-3;
const TOLERANCE: f64 = 1e-8;

/// f'(0) by the central difference of fourth order.
fn derivative(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let [left2, left, right, right2] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * DELTA));
    let slope = |k: usize| (8.0 * (right[k] - left[k]) - (right2[k] - left2[k])) / (12.0 * DELTA);
    (0..left.len()).map(slope).collect()
}

fn along(q: &[f64], v: &[f64], tau: f64) -> Vec<f64> {
    q.iter().zip(v).map(|(q, v)| q + tau * v).collect()
}

/// A state in which differences do not cross a jump of C, nor come near arms in line in space.
fn build(random: &mut Random, case: &Case) -> (System, State) {
    loop {
        let mut builder = System::builder(dimension(case.d));
        for (i, x) in random.points(6, case.d, 0.8).into_iter().enumerate() {
            let v = random.numbers(case.d, -0.5, 0.5);
            builder.particle(Particle::at(format!("p{i}"), x).with_velocity(v));
        }
        builder.constraint("it", (case.make)(schedule(case.drive, 0.0)));
        let (system, state) = builder.build().unwrap();
        let terms = evaluate(&system, &state);
        let steep = terms.jacobian.to_dense().iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        let in_line = case.d == 3 && case.turns && {
            let drive = schedule(case.drive, 0.0).value(0.0);
            libm::sin(terms.residual[0] + drive) < 0.5
        };
        if !(case.turns && terms.residual[0].abs() > 3.0 || in_line) {
            assert!(steep < 20.0, "{}: {steep}", case.name);
            return (system, state);
        }
    }
}

#[test]
fn every_kind_agrees_with_differences_and_with_its_expression() {
    for case in CASES {
        let mut random = Random::new(5);
        let later = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| k * DELTA);
        for _ in 0..STATES {
            let (system, state) = build(&mut random, case);
            let (q, v) = (state.positions(), state.velocities());
            let at = later.map(|tau| {
                let mut builder = System::builder(dimension(case.d));
                q.chunks(case.d).enumerate().for_each(|(i, x)| {
                    builder.particle(Particle::at(format!("p{i}"), x));
                });
                builder.constraint("it", (case.make)(schedule(case.drive, tau)));
                builder.build().unwrap().0
            });
            let at = |q: Vec<f64>, tau: f64| {
                let system = &at[((tau / DELTA).round() + 2.0) as usize];
                evaluate(system, &state.with_motion(q, v.to_vec()))
            };
            let terms = evaluate(&system, &state);
            let J = terms.jacobian.to_dense();
            let rate = derivative(|tau| at(along(q, v, tau), tau).residual);
            assert_all_close(&format!("{}: Ċ", case.name), &terms.residual_rate, &rate, TOLERANCE);
            for k in 0..q.len() {
                let axis: Vec<f64> = (0..q.len()).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
                let slope = derivative(|tau| at(along(q, &axis, tau), 0.0).residual);
                assert_close(&format!("{}: J", case.name), J[k], slope[0], TOLERANCE);
            }
            let Ct = terms.residual_rate[0] - multiply(&J, v)[0];
            let slope = derivative(|tau| at(q.to_vec(), tau).residual);
            assert_close(&format!("{}: C_t", case.name), Ct, slope[0], TOLERANCE);
            let gamma = derivative(|tau| at(along(q, v, tau), tau).residual_rate);
            assert_all_close(&format!("{}: γ", case.name), &terms.acceleration_bias, &gamma, TOLERANCE);

            let scope = Scope::new(Purpose::Constraint, dimension(case.d), &particle);
            let twin =
                Expression::parse(&format!("{} - ({})", case.held, case.drive).replace('T', "t"), &scope).unwrap();
            let mut gradient = vec![0.0; twin.gradient_len()];
            let (jet, slope_in_time) = twin.jet_and_gradient(q, v, 0.0, &mut gradient);
            // Roundoff of some dozens of operations on numbers below 100.
            let roundoff = 1e-12;
            let turn = std::f64::consts::TAU;
            let whole = if case.turns { ((jet.value - terms.residual[0]) / turn).round() * turn } else { 0.0 };
            assert_close(&format!("{}: C typed", case.name), terms.residual[0], jet.value - whole, roundoff);
            assert_close(&format!("{}: Ċ typed", case.name), terms.residual_rate[0], jet.first, roundoff);
            assert_close(&format!("{}: γ typed", case.name), terms.acceleration_bias[0], jet.second, roundoff);
            assert_close(&format!("{}: C_t typed", case.name), Ct, slope_in_time, roundoff);
            let mut dense = vec![0.0; q.len()];
            for (particle, block) in twin.particles().iter().zip(gradient.chunks(case.d)) {
                dense[particle.index() * case.d..][..case.d].copy_from_slice(block);
            }
            assert_all_close(&format!("{}: J typed", case.name), &J, &dense, roundoff);
        }
    }
}

/// The kind at its own measure at the start, driven to and fro, on particles that springs keep apart and together.
fn moving(case: &Case) -> (System, State) {
    let mut builder = System::builder(dimension(case.d));
    let places =
        [[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [0.2, 1.1, -0.1], [-0.3, 0.4, 1.2], [-1.0, -0.2, -0.9], [2.0, 2.0, 0.5]];
    let q: Vec<f64> = places.iter().flat_map(|x| x[..case.d].to_vec()).collect();
    for (i, x) in q.chunks(case.d).enumerate() {
        let particle = Particle::at(format!("p{i}"), x).with_mass(1.0 + 0.3 * i as f64);
        builder.particle(if i == 5 { particle.fixed() } else { particle });
    }
    for (i, a) in P.iter().enumerate() {
        for b in &P[..i] {
            let apart = |k: usize| q[a.index() * case.d + k] - q[b.index() * case.d + k];
            let square = |k: usize| apart(k) * apart(k);
            let rest = 0.95 * (0..case.d).map(square).sum::<f64>().sqrt();
            builder.force(qhat::Spring { a: *a, b: *b, stiffness: 20.0, damping: 0.0, rest });
        }
    }
    let at_start = (case.make)(0.0.into()).residual(dimension(case.d), &q)[0];
    builder.constraint("it", (case.make)(schedule(&format!("{at_start:?} + 0.1*sin(2*t)^2"), 0.0)));
    builder.build().unwrap()
}

/// The worst |C| over its scale, and the most that is missing in the energy, over a second.
fn run(case: &Case, integrator: Integrator, h: f64) -> (f64, f64) {
    let (system, state) = moving(case);
    let settings = Settings { integrator, h, tolerance: 1e-10, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let mut worst = 0.0_f64;
    for _ in 0..(1.0 / h).round() as usize {
        simulation.step().unwrap_or_else(|error| panic!("{} under {integrator:?}: {error}", case.name));
        let C = simulation.terms().residual[0];
        worst = worst.max(C.abs() / simulation.system().row_scales()[0]);
    }
    (worst, simulation.energy_error_max())
}

#[test]
fn every_kind_is_held_and_its_energy_accounted_for() {
    for case in CASES {
        // What projections leave, and ten times that.
        let held = |integrator: Integrator, worst: f64| {
            assert!(worst < 1e-9, "{} under {integrator:?}: off by {worst:e}", case.name);
        };
        let (worst, energy) = run(case, Integrator::Auto, 0.01);
        held(Integrator::Auto, worst);
        // dop853 at 1e-10 a substep; the drives' work is summed by a rule of the same order.
        assert!(energy < 1e-7, "{} under auto: {energy:e} of the energy is missing", case.name);
        for integrator in [Integrator::Rattle, Integrator::Bdf2] {
            let ((worst, coarse), (_, fine)) = (run(case, integrator, 0.004), run(case, integrator, 0.002));
            held(integrator, worst);
            println!("{} {integrator:?} {worst:e} {coarse:e} {fine:e}", case.name);
            // Rattle makes substeps by its tolerance; bdf2 takes h as it is, of second order: a quarter of it at half the step.
            let second_order = fine < 1e-3 && fine < 0.35 * coarse;
            assert!(fine < 1e-6 || second_order, "{} under {integrator:?}: {coarse:e}, {fine:e}", case.name);
        }
    }
}

/// Refused before anything moves, in words that say what to do.
#[test]
fn what_cannot_be_is_refused() {
    let refuse = |d: usize, constraint: Constraint, words: &str| {
        let mut builder = System::builder(dimension(d));
        for i in 0..6 {
            let x = [i as f64, (i * i) as f64, (i % 3) as f64];
            builder.particle(Particle::at(format!("p{i}"), &x[..d]));
        }
        builder.constraint("it", constraint);
        let error = builder.build().expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    };
    refuse(2, Lengths::pulley(&P[..1], 1.0).into(), "two points at least");
    refuse(2, Lengths::pulley(&[P[0], P[0]], 1.0).into(), "from one particle to another");
    refuse(2, Lengths::pulley(&P[..3], -1.0).into(), "above 0");
    refuse(2, Lengths::ratio([P[0], P[1]], [P[2], P[3]], 0.0).into(), "weight 0");
    refuse(2, Lengths::ratio([P[0], P[1]], [P[2], P[3]], f64::NAN).into(), "finite");
    refuse(2, Angle::between([P[0], P[0]], [P[1], P[2]], 1.0).into(), "one particle to another");
    refuse(2, Angle::from_direction([0.0; 3], [P[1], P[2]], 1.0).into(), "needs a length");
    refuse(2, Gears::mesh([[P[0], P[1]], [P[0], P[2]]], [2, 3], 0.0).into(), "two centres");
    refuse(2, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [0, 3], 0.0).into(), "without teeth");
    refuse(2, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [i32::MIN, i32::MAX], 0.0).into(), "1000 at most");
    refuse(2, Gears::rack([P[0], P[1]], P[2], [0.0, 0.0], 1.0, 0.0).into(), "finite");
    refuse(3, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [2, 3], 0.0).into(), "2 dimensions");
    refuse(2, Area { corners: P[..2].to_vec(), area: 1.0.into() }.into(), "three corners");
    refuse(2, Area { corners: vec![P[0], P[1], P[0], P[2]], area: 1.0.into() }.into(), "one corner");
    refuse(3, Area { corners: P[..3].to_vec(), area: 1.0.into() }.into(), "2 dimensions");
    refuse(2, Volume::tetrahedron([P[0], P[1], P[2], P[3]], 1.0).into(), "3 dimensions");
    refuse(3, Volume::new(&[[P[0], P[1], P[2]]], 1.0).into(), "not closed");
    refuse(3, Volume::tetrahedron([P[0], P[1], P[1], P[3]], 1.0).into(), "three different corners");
    refuse(3, Volume::new(&[[P[0], P[1], P[2]], [P[0], P[1], P[3]]], 1.0).into(), "turn one of them round");
    let named = Expression::parse("p0.x", &Scope::new(Purpose::Constraint, Dimension::Two, &particle)).unwrap();
    refuse(2, Lengths::pulley(&P[..3], named).into(), "nothing but t");
}

/// Where there is no gradient a step says so, or carries on: no panic, and no number that is not one.
#[test]
fn singular_places_end_in_an_error_or_in_numbers() {
    let start = |d: usize, constraint: Constraint| {
        let mut builder = System::builder(dimension(d));
        for i in 0..6 {
            let x = [if i < 2 { 0.0 } else { i as f64 }, 0.0, 0.0];
            builder.particle(Particle::at(format!("p{i}"), &x[..d]).with_velocity(vec![0.1; d]));
        }
        builder.with_constraint("anchor", Distance::new(P[4], P[5], 1.0)).constraint("it", constraint);
        let (system, state) = builder.build().unwrap();
        let outcome = Simulation::new(system, state, Settings::default()).and_then(|mut simulation| {
            simulation.step()?;
            Ok(simulation.state().positions().to_vec())
        });
        match outcome {
            Ok(positions) => assert!(positions.iter().all(|x| x.is_finite())),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    };
    start(2, Lengths::pulley(&P[..3], 2.0).into());
    start(2, Lengths::ratio([P[0], P[1]], [P[2], P[3]], 1.0).into());
    start(2, Angle::between([P[0], P[1]], [P[2], P[3]], 1.0).into());
    start(2, Angle::from_direction([1.0, 0.0, 0.0], [P[2], P[3]], std::f64::consts::PI).into());
    start(3, Angle::between([P[2], P[3]], [P[3], P[4]], 1.0).into());
    start(2, Gears::mesh([[P[0], P[1]], [P[2], P[3]]], [2, 3], 1.0).into());
    start(2, Area { corners: P[..4].to_vec(), area: 1.0.into() }.into());
    start(3, Volume::tetrahedron([P[0], P[1], P[2], P[3]], 1.0).into());
}
