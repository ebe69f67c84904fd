//! Implicit methods: heavy loads and stiff springs at a frame of 1/60 s, where every explicit method fails; buckling,
//! nets, redundant rows; rods with compliance.

use crate::systems::dense::assert_close;
use crate::systems::{self, FRAME};
use qhat::{
    Dimension, Distance, Drag, Gravity, Integrator, Particle, Settings, Simulation, Spring, State, StepReport, System,
    Warning,
};

const IMPLICIT: [Integrator; 2] = [Integrator::Implicit, Integrator::Bdf2];

fn start((system, state): (System, State), integrator: Integrator, h: f64) -> Simulation {
    Simulation::new(system, state, systems::settings(integrator, h)).unwrap()
}

/// The reports of some frames summed up in one report, the factorizations in a frame, and the largest rise of T + V in
/// a step [J].
fn run(simulation: &mut Simulation, frames: usize) -> (StepReport, f64, f64) {
    let (mut total, mut rise) = (StepReport::default(), f64::NEG_INFINITY);
    let mut last = simulation.energy().total();
    for _ in 0..frames {
        let report = simulation.step().unwrap();
        rise = rise.max(report.energy.total() - last);
        last = report.energy.total();
        total.factorizations += report.factorizations;
        total.substeps += report.substeps;
        total.rejected += report.rejected;
        total.max_relative_length_error = total.max_relative_length_error.max(report.max_relative_length_error);
        total.energy = report.energy;
        for warning in report.warnings {
            // Both methods damp what a frame does not resolve, and the account of the simulation says so.
            let is_expected = matches!(warning, Warning::Singular | Warning::EnergyUnaccounted { .. });
            assert!(is_expected, "{warning}");
        }
    }
    let mean = total.factorizations as f64 / frames as f64;
    (total, mean, rise)
}

/// A chain of rods of 1 cm and beads of 10 g from a pin, along x, its last bead `ratio` times as heavy.
fn loaded_chain(dimension: Dimension, links: usize, ratio: f64) -> (System, State) {
    let at = |x: f64| [x, 0.0, 0.0][..dimension.number()].to_vec();
    let mut builder = System::builder(dimension);
    let mut last = builder.particle(Particle::at("pin", at(0.0)).fixed());
    for i in 1..=links {
        let mass = if i == links { 0.01 * ratio } else { 0.01 };
        let bead = builder.particle(Particle::at(format!("bead{i}"), at(0.01 * i as f64)).with_mass(mass));
        builder.constraint(format!("rod{i}"), Distance::new(last, bead, 0.01));
        last = bead;
    }
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder.build().unwrap()
}

/// n × n points 1 cm and 10 g apart hanging from two corners, their top row on an arc so that the start is regular.
fn cloth(n: usize) -> (System, State) {
    const HALF_ANGLE: f64 = 0.5;
    let side = 0.01;
    let mut builder = System::builder(Dimension::Three);
    let turn = 2.0 * HALF_ANGLE / (n - 1) as f64;
    let radius = 0.5 * side / libm::sin(0.5 * turn);
    let mut points = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let angle = turn * i as f64 - HALF_ANGLE;
            let position = [radius * libm::sin(angle), -radius * libm::cos(angle), side * j as f64];
            let point = Particle::at(format!("p{i},{j}"), position).with_mass(0.01);
            points.push(builder.particle(if j == 0 && (i == 0 || i == n - 1) { point.fixed() } else { point }));
        }
    }
    for j in 0..n {
        for i in 0..n {
            if i + 1 < n {
                builder.constraint(format!("h{i},{j}"), Distance::new(points[j * n + i], points[j * n + i + 1], side));
            }
            if j + 1 < n {
                builder.constraint(format!("v{i},{j}"), Distance::new(points[j * n + i], points[j * n + n + i], side));
            }
        }
    }
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder.build().unwrap()
}

/// The end of a chain of 100 a thousand to a billion times heavier than its beads, at 60 frames a second.
#[test]
fn long_heavy_ends_stay_on_their_rods() {
    for dimension in [Dimension::Two, Dimension::Three] {
        for ratio in [1.0, 1e3, 1e6, 1e7, 1e9] {
            for integrator in IMPLICIT {
                let mut simulation = start(loaded_chain(dimension, 100, ratio), integrator, FRAME);
                let (total, mean, rise) = run(&mut simulation, 120);
                let case = format!("{integrator}, {ratio:e}:1");
                assert!(total.max_relative_length_error <= 1e-10, "{case}: {:e}", total.max_relative_length_error);
                assert!(mean <= 4.0, "{case}: {mean} factorizations a frame");
                assert_eq!((total.substeps, total.rejected), (120, 0), "{case}: every frame in one step");
                // The end hangs within its reach, and has fallen.
                let tip = &simulation.state().positions()[100 * dimension.number()..];
                assert!(systems::dense::norm(tip) < 1.0 + 1e-9, "{case}: {tip:?}");
                if integrator == Integrator::Implicit {
                    // A step solved to 1e-10 of the extent may raise the energy by 1e-10 of it.
                    assert!(rise <= 1e-10 * total.energy.kinetic.max(1.0), "{case}: T + V rose by {rise:e} J");
                }
            }
        }
    }
}

/// Steps of a tenth of a second, from rest, under every load: |C| stays within 1e-10.
#[test]
fn a_tenth_of_a_second_is_not_too_long() {
    for ratio in [1.0, 1e3, 1e6, 1e9] {
        for integrator in IMPLICIT {
            let mut simulation = start(loaded_chain(Dimension::Two, 100, ratio), integrator, 0.1);
            let (total, ..) = run(&mut simulation, 20);
            assert!(total.max_relative_length_error <= 1e-10, "{integrator}, {ratio:e}: {total:?}");
        }
    }
}

#[test]
fn long_a_cloth_hangs_and_loses_energy() {
    let mut simulation = start(cloth(8), Integrator::Implicit, FRAME);
    let (total, mean, rise) = run(&mut simulation, 120);
    assert!(total.max_relative_length_error <= 1e-10 && total.rejected == 0, "{total:?}");
    assert!(mean <= 4.0, "{mean} factorizations a frame");
    assert!(rise <= 1e-10, "T + V rose by {rise:e} J");
    let mut simulation = start(cloth(8), Integrator::Bdf2, FRAME);
    let (total, ..) = run(&mut simulation, 120);
    assert!(total.max_relative_length_error <= 1e-10, "{total:?}");
}

/// Two rods that stand on a pin under a load: their geometric stiffness is negative. The knee, pushed a little to one
/// side, must buckle to that side. (s = √(2T/(mL)) is 9/s here. Backward Euler grows by 1/(1 − h s) a step, so from h s
/// = 1 on it would buckle to the other side.)
#[test]
fn a_column_buckles_to_the_side_it_is_pushed() {
    for push in [1e-4, -1e-4] {
        let mut builder = System::builder(Dimension::Two);
        let foot = builder.particle(Particle::at("foot", [0.0, 0.0]).fixed());
        let knee = builder.particle(Particle::at("knee", [0.0, 0.5]).with_mass(0.5).with_velocity([push, 0.0]));
        let load = builder.particle(Particle::at("load", [0.0, 1.0]));
        builder
            .with_constraint("shin", Distance::new(foot, knee, 0.5))
            .constraint("thigh", Distance::new(knee, load, 0.5));
        builder.force(systems::gravity());
        for integrator in IMPLICIT {
            let mut simulation = start(builder.clone().build().unwrap(), integrator, FRAME);
            let mut side = 0.0;
            for _ in 0..240 {
                let report = simulation.step().unwrap();
                assert!(report.max_relative_length_error <= 1e-10, "{integrator}: {report:?}");
                let x = simulation.state().positions()[2];
                if side == 0.0 && x.abs() > 0.1 {
                    side = x.signum();
                }
            }
            assert_eq!(side, push.signum(), "{integrator} gave to the wrong side, or not at all");
        }
    }
}

/// A square with both diagonals and a load has one redundant row. It moves in the same way without the second diagonal.
#[test]
fn a_redundant_brace_carries_as_without() {
    let frame = |braces: usize| {
        let mut builder = System::builder(Dimension::Two);
        let a = builder.particle(Particle::at("a", [0.0, 0.0]).fixed());
        let b = builder.particle(Particle::at("b", [1.0, 0.0]));
        let c = builder.particle(Particle::at("c", [1.0, 1.0]));
        let d = builder.particle(Particle::at("d", [0.0, 1.0]));
        for (name, p, q) in [("ab", a, b), ("bc", b, c), ("cd", c, d), ("da", d, a)] {
            builder.constraint(name, Distance::new(p, q, 1.0));
        }
        for (name, p, q) in [("ac", a, c), ("bd", b, d)].into_iter().take(braces) {
            builder.constraint(name, Distance::new(p, q, std::f64::consts::SQRT_2));
        }
        builder.force(systems::gravity());
        builder.build().unwrap()
    };
    for integrator in IMPLICIT {
        let (mut once, mut twice) = (start(frame(1), integrator, FRAME), start(frame(2), integrator, FRAME));
        let (total, ..) = run(&mut twice, 120);
        run(&mut once, 120);
        assert!(total.max_relative_length_error <= 1e-10 && total.rejected == 0, "{total:?}");
        // Two seconds of a swinging plate, each step solved to 1e-10.
        let (x, y) = (once.state().positions(), twice.state().positions());
        for (x, y) in x.iter().zip(y) {
            assert_close(&format!("{integrator}"), *y, *x, 1e-7);
        }
    }
}

/// A parallelogram linkage driven through the position in which all its bars are in line and the rank drops for an
/// instant.
#[test]
fn a_parallelogram_goes_through_flat() {
    for integrator in IMPLICIT {
        let mut builder = System::builder(Dimension::Two);
        let left = builder.particle(Particle::at("left", [0.0, 0.0]).fixed());
        let right = builder.particle(Particle::at("right", [1.0, 0.0]).fixed());
        let a = builder.particle(Particle::at("a", [0.0, -1.0]).with_velocity([8.0, 0.0]));
        let b = builder.particle(Particle::at("b", [1.0, -1.0]).with_velocity([8.0, 0.0]));
        for (name, p, q) in [("la", left, a), ("rb", right, b), ("ab", a, b)] {
            builder.constraint(name, Distance::new(p, q, 1.0));
        }
        builder.force(systems::gravity());
        let mut simulation = start(builder.build().unwrap(), integrator, FRAME);
        let mut highest = f64::NEG_INFINITY;
        for _ in 0..120 {
            let report = simulation.step().unwrap();
            assert!(report.max_relative_length_error <= 1e-10, "{integrator}: {report:?}");
            highest = highest.max(simulation.state().positions()[5]);
        }
        assert!(highest > 0.0, "{integrator} never passed the flat position: {highest}");
    }
}

/// A rod of compliance α under a weight T is longer by α T, at rest, under every integrator; λ and tension are T.
#[test]
fn long_a_compliant_rod_sags_by_its_compliance() {
    let (mass, compliance) = (3.0, 1e-3);
    let weight = mass * 9.81;
    for integrator in Integrator::ALL {
        let mut builder = System::builder(Dimension::Two);
        let pin = builder.particle(Particle::at("pin", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(mass));
        // Nearly critical: 2 √(m/α) is 110 N·s/m.
        builder.constraint("rod", Distance::new(pin, bob, 1.0).with_compliance(compliance, 100.0));
        builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
        let mut simulation = start(builder.build().unwrap(), integrator, 1.0 / 2000.0);
        for _ in 0..4000 {
            simulation.step().unwrap();
        }
        // e⁻ᵏᵗ with k = 16/s is over after 2 s; a compliant row is solved to half of 1e-10 of its length times 1 + α
        // c/h = 201.
        assert_close(&format!("{integrator}: y"), simulation.state().positions()[3], -1.0 - compliance * weight, 2e-8);
        assert_close(&format!("{integrator}: tension"), simulation.tension()[0], weight, 2e-5);
        assert_close(&format!("{integrator}: λ"), simulation.terms().multipliers[0], -weight, 2e-5);
    }
}

/// A compliant rod gives the same motion as its spring under an explicit method, and nearly the same motion where the
/// row is solved.
#[test]
fn a_compliant_rod_is_a_spring() {
    let build = |as_rod: bool| {
        let mut builder = System::builder(Dimension::Two);
        let pin = builder.particle(Particle::at("pin", [0.0, 0.0]).fixed());
        let elbow = builder.particle(Particle::at("elbow", [1.0, 0.0]));
        let bob = builder.particle(Particle::at("bob", [1.6, 0.8]).with_mass(0.5));
        builder.constraint("rigid", Distance::new(pin, elbow, 1.0));
        if as_rod {
            builder.constraint("soft", Distance::new(elbow, bob, 1.0).with_compliance(0.02, 1.5));
        } else {
            builder.force(Spring { a: elbow, b: bob, stiffness: 50.0, damping: 1.5, rest: 1.0 });
        }
        builder.force(systems::gravity());
        builder.build().unwrap()
    };
    for (integrator, h, allowed) in [
        // The same sums in another order: roundoff.
        (Integrator::Rk4, 1e-3, 1e-11),
        (Integrator::Rattle, 0.01, 1e-11),
        // The same equations. Newton's method factors at other iterates, and velocities are projected with the last
        // factor: the difference is a thousandth of the error of the methods.
        (Integrator::Implicit, 1.0 / 240.0, 1e-4),
        (Integrator::Bdf2, 1.0 / 240.0, 1e-4),
    ] {
        let settings = Settings { constraint_tolerance: 1e-13, ..systems::settings(integrator, h) };
        let start = |(system, state)| Simulation::new(system, state, settings).unwrap();
        let [mut rod, mut spring] = [true, false].map(|as_rod| start(build(as_rod)));
        for _ in 0..(1.0 / h).round() as usize {
            rod.step().unwrap();
            spring.step().unwrap();
        }
        let (x, y) = (rod.state().positions(), spring.state().positions());
        for (x, y) in x.iter().zip(y) {
            assert_close(&format!("{integrator}"), *x, *y, allowed);
        }
        let (x, y) = (rod.energy(), spring.energy());
        assert_close("T + V", x.total(), y.total(), 100.0 * allowed);
        assert_close("dissipated", x.work.dissipation, y.work.dissipation, 100.0 * allowed);
    }
}

/// A spring of 1e9 N/m on a gram at 1/60 s: h ω is 17000.
#[test]
fn a_stiff_spring_does_not_bound_the_step() {
    for integrator in IMPLICIT {
        let mut builder = System::builder(Dimension::Two);
        let pin = builder.particle(Particle::at("pin", [0.0, 0.0]).fixed());
        let a = builder.particle(Particle::at("a", [0.5, 0.0]).with_mass(1e-3));
        let b = builder.particle(Particle::at("b", [1.0, 0.0]).with_mass(1e-3));
        builder.constraint("rod", Distance::new(pin, a, 0.5));
        builder.force(Spring { a, b, stiffness: 1e9, damping: 0.0, rest: 0.5 });
        builder.with_force(systems::gravity()).force(Drag { coefficient: 1e-4 });
        let mut simulation = start(builder.build().unwrap(), integrator, FRAME);
        for _ in 0..600 {
            let report = simulation.step().unwrap();
            assert!(report.max_relative_length_error <= 1e-10, "{integrator}: {report:?}");
            let q = simulation.state().positions();
            let length = systems::dense::norm(&[q[4] - q[2], q[5] - q[3]]);
            // The pull is some 0.1 N, 1e-10 m of this spring; the force is solved to 1e-10 m of the masses' own
            // inertia.
            assert!((length - 0.5).abs() < 1e-8, "{integrator}: {length}");
        }
    }
}

/// Drag strong enough to stop a bead in a hundredth of a step only slows it.
#[test]
fn strong_drag_is_stable() {
    for integrator in IMPLICIT {
        let mut simulation = start(loaded_chain(Dimension::Two, 10, 1.0), integrator, FRAME);
        simulation.set_drag(60.0).unwrap();
        let (_, _, rise) = run(&mut simulation, 120);
        assert!(rise <= 0.0, "{integrator}: T + V rose by {rise:e} J");
    }
}

/// Two iterations a frame are too few for a whipping chain. Every frame that was not solved reports its residual, and
/// the links of the chain still hold.
#[test]
fn a_spent_budget_is_reported_and_holds() {
    for integrator in IMPLICIT {
        let (system, state) = loaded_chain(Dimension::Two, 100, 1.0);
        let settings = Settings { frame_budget: 2, ..systems::settings(integrator, FRAME) };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        let mut warned = 0;
        for _ in 0..240 {
            let report = simulation.step().unwrap();
            // One factorization for the first try, one for the fallback.
            assert!(report.iterations <= 2 && report.substeps == 1, "{integrator}: {report:?}");
            for warning in report.warnings {
                if matches!(warning, Warning::EnergyUnaccounted { .. }) {
                    continue;
                }
                let Warning::BudgetSpent { iterations, relative, ref row, .. } = warning else { panic!("{warning}") };
                assert!(iterations <= 2 && relative < 0.5 && row.starts_with("rod"), "{integrator}: {warning}");
                assert!(warning.to_string().contains("budget"), "{warning}");
                warned += 1;
            }
        }
        assert!(warned > 20, "{integrator}: {warned} warnings");
    }
}
