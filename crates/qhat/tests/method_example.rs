//! The pendulum that `docs/method/` works by hand. Each page continues the example by one stage, in tables with the
//! heading `| symbol | by hand | value | unit |`. This test reads every value from these tables, computes it again with
//! the engine, and compares the two in every printed digit.

#![allow(non_snake_case, reason = "the letters of the method keep their case")]

use crate::systems;
use qhat::{
    Body, Dimension, Distance, DistanceForm, Drag, Expression, ExpressionConstraint, Feedback, Gravity, Integrator,
    Limits, Nail, Particle, ParticleId, Purpose, Scope, Settings, Simulation, State, System, SystemBuilder, Terms,
    evaluate,
};
use std::fs;
use std::path::Path;

/// A line of a table: its symbol and its numbers.
type Line = (&'static str, Vec<f64>);

const HEADING: &str = "| symbol | by hand | value | unit |";

/// Length of the rod [m]: the bob is at (1, −1), the pivot at (0, 0).
const R: f64 = std::f64::consts::SQRT_2;

/// One step [s], so long that integrators differ in the first digits.
const H: f64 = 0.1;

fn pivot_id() -> ParticleId {
    systems::id(0)
}

fn bob_id() -> ParticleId {
    systems::id(1)
}

/// Pivot, bob and gravity; each test adds the constraint of the bob.
fn hung(hold: impl FnOnce(&mut SystemBuilder)) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    builder.particle(Particle::at("bob", [1.0, -1.0]).with_mass(2.0).with_velocity([1.0, 1.0]));
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    hold(&mut builder);
    builder.build().unwrap()
}

fn pendulum() -> (System, State) {
    hung(|builder| {
        builder.constraint("rod", Distance::new(pivot_id(), bob_id(), R));
    })
}

/// The two components of the bob in a vector of four.
fn bob(vector: &[f64]) -> Vec<f64> {
    vector[2..4].to_vec()
}

fn at(state: &State, q: [f64; 2], qd: [f64; 2]) -> State {
    state.with_motion(vec![0.0, 0.0, q[0], q[1]], vec![0.0, 0.0, qd[0], qd[1]])
}

/// One frame of `H` with an integrator.
fn stepped(system: &System, state: &State, integrator: Integrator) -> Simulation {
    // With this tolerance, an integrator with substeps of its own takes the frame in one substep.
    let settings = Settings { h: H, integrator, tolerance: 0.9, constraint_tolerance: 1e-12, ..Settings::default() };
    let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
    let report = simulation.step().unwrap();
    assert_eq!(report.substeps, 1, "{integrator}");
    simulation
}

/// C of the rod, |d| − r [m].
fn stretch(q: &[f64]) -> f64 {
    libm::hypot(q[0], q[1]) - R
}

fn forces() -> Vec<Line> {
    let (system, state) = hung(|builder| {
        builder.force(Drag { coefficient: 0.5 });
    });
    let terms = evaluate(&system, &state);
    let (bare, _) = hung(|_| {});
    let gravity = bob(&evaluate(&bare, &state).applied_forces);
    let Q = bob(&terms.applied_forces);
    let drag = vec![Q[0] - gravity[0], Q[1] - gravity[1]];
    let simulation = Simulation::new(system, state, Settings::default()).unwrap();
    let power = drag[0] + drag[1]; // F·v with v = (1, 1)
    vec![
        ("W", vec![terms.inverse_masses[1]]),
        ("Q of gravity", gravity),
        ("Q of drag", drag),
        ("Q", Q),
        ("V", vec![simulation.energy().potential]),
        ("power", vec![power]),
    ]
}

fn rod(terms: &Terms) -> Vec<Line> {
    vec![
        ("C", terms.residual.clone()),
        ("Ċ", terms.residual_rate.clone()),
        ("J", bob(&terms.jacobian.to_dense())),
        ("γ", terms.acceleration_bias.clone()),
    ]
}

fn readme() -> Vec<Line> {
    let (system, state) = pendulum();
    let terms = evaluate(&system, &state);
    let mut lines = vec![
        ("q", bob(&terms.positions)),
        ("q̇", bob(&terms.velocities)),
        ("W", vec![terms.inverse_masses[1]]),
        ("Q", bob(&terms.applied_forces)),
    ];
    lines.extend(rod(&terms));
    lines.extend([
        ("A", terms.constraint_matrix.to_dense()),
        ("b", terms.right_hand_side.clone()),
        ("λ", terms.multipliers.clone()),
        ("Q̂", bob(&terms.constraint_forces)),
        ("q̈", bob(&terms.accelerations)),
        ("T", terms.tension.clone()),
        ("C̈", vec![rate_of_rate(&terms)]),
    ]);
    lines
}

/// C̈ = J q̈ + γ.
fn rate_of_rate(terms: &Terms) -> f64 {
    let (J, qdd) = (bob(&terms.jacobian.to_dense()), bob(&terms.accelerations));
    J[0] * qdd[0] + J[1] * qdd[1] + terms.acceleration_bias[0]
}

fn expression(builder: &SystemBuilder, positions: &[f64]) -> (Expression, ExpressionConstraint) {
    assert_eq!((builder.name(pivot_id()), builder.name(bob_id())), ("pivot", "bob"));
    let particle = |name: &str| match name {
        "pivot" => Some(pivot_id()),
        "bob" => Some(bob_id()),
        _ => None,
    };
    let scope = Scope::new(Purpose::Constraint, Dimension::Two, &particle);
    let expression = Expression::parse("dist(bob, pivot) - sqrt(2)", &scope).unwrap();
    (expression.clone(), ExpressionConstraint::new(expression, positions))
}

const POSITIONS: [f64; 4] = [0.0, 0.0, 1.0, -1.0];

fn constraints() -> Vec<Line> {
    let (system, state) = pendulum();
    let terms = evaluate(&system, &state);
    let (squared, _) = hung(|builder| {
        builder.constraint("rod", Distance { form: DistanceForm::Squared, ..Distance::new(pivot_id(), bob_id(), R) });
    });
    let squared = evaluate(&squared, &state);
    let mut hessian = Vec::new();
    hung(|builder| {
        let (expression, _) = expression(builder, &POSITIONS);
        hessian = vec![0.0; expression.gradient_len() * expression.gradient_len()];
        expression.hessian(state.positions(), state.velocities(), 0.0, &mut hessian);
    });
    // Particles of the expression in the order of their first names: the block of the bob is the first.
    let block: Vec<f64> = [0, 1, 4, 5].map(|k| hessian[k]).into();
    let stiffness = block.iter().map(|h| -terms.multipliers[0] * h).collect();
    let mut lines = rod(&terms);
    lines.push(("λ", terms.multipliers.clone()));
    lines.extend(rod(&squared));
    lines.extend([
        ("λ", squared.multipliers.clone()),
        ("T", squared.tension.clone()),
        ("Q̂", bob(&squared.constraint_forces)),
        ("∂²C/∂q²", block),
        ("−λ ∂²C/∂q²", stiffness),
    ]);
    lines
}

fn multipliers() -> Vec<Line> {
    let fed = Feedback { ks: 100.0, kd: 20.0, ..Feedback::NONE };
    let (system, state) = hung(|builder| {
        builder.with_constraint("rod", Distance::new(pivot_id(), bob_id(), R)).feedback(fed);
    });
    let stepped = stepped(&pendulum().0, &state, Integrator::Euler);
    let off = at(
        &state,
        bob(stepped.state().positions()).try_into().unwrap(),
        bob(stepped.state().velocities()).try_into().unwrap(),
    );
    let terms = evaluate(&system, &off);
    let mut lines = vec![("q", bob(&terms.positions)), ("q̇", bob(&terms.velocities))];
    lines.extend(rod(&terms));
    lines.extend([
        ("−γ", terms.rhs_bias.clone()),
        ("−J W Q", terms.rhs_forces.clone()),
        ("−ks C", terms.rhs_stiffness.clone()),
        ("−kd Ċ", terms.rhs_damping.clone()),
        ("b", terms.right_hand_side.clone()),
        ("λ", terms.multipliers.clone()),
        ("C̈", vec![rate_of_rate(&terms)]),
    ]);
    let (twice, _) = hung(|builder| {
        builder
            .with_constraint("rod", Distance::new(pivot_id(), bob_id(), R))
            .constraint("twin", Distance::new(pivot_id(), bob_id(), R));
    });
    let twice = evaluate(&twice, &state);
    lines.extend([
        ("A", twice.constraint_matrix.to_dense()),
        ("rank A", vec![twice.rank.unwrap() as f64]),
        ("λ", twice.multipliers.clone()),
        ("Q̂", bob(&twice.constraint_forces)),
    ]);
    let (soft, _) = hung(|builder| {
        let drag = Feedback { diagonal_drag: 0.5, ..Feedback::NONE };
        builder.with_constraint("rod", Distance::new(pivot_id(), bob_id(), R)).feedback(drag);
    });
    let soft = evaluate(&soft, &state);
    lines.extend([("λ", soft.multipliers.clone()), ("C̈", vec![rate_of_rate(&soft)])]);
    lines
}

fn ended(simulation: &Simulation) -> Vec<Line> {
    let (q, qd) = (bob(simulation.state().positions()), bob(simulation.state().velocities()));
    vec![("q'", q.clone()), ("q̇'", qd), ("C", vec![stretch(&q)]), ("T + V", vec![simulation.energy().total()])]
}

fn integrators() -> Vec<Line> {
    let (system, state) = pendulum();
    let mut lines = Vec::new();
    for integrator in [Integrator::Euler, Integrator::SymplecticEuler] {
        lines.extend(ended(&stepped(&system, &state, integrator)));
    }
    let rattle = stepped(&system, &state, Integrator::Rattle);
    let (half, n) = ([1.0, 1.0 - 0.5 * H * 9.81], [1.0 / R, -1.0 / R]);
    let (q, qd) = (bob(rattle.state().positions()), bob(rattle.state().velocities()));
    // q' = q + h q̇½ + W Jᵀ μ, and q̇' = q̇½ + W Jᵀ μ/h + ½ h W Q + W J'ᵀ ν, both along a unit vector; 1/W = 2.
    let mu = 2.0 * (n[0] * (q[0] - 1.0 - H * half[0]) + n[1] * (q[1] + 1.0 - H * half[1]));
    let before = [half[0] + 0.5 * n[0] * mu / H, half[1] + 0.5 * n[1] * mu / H - 0.5 * H * 9.81];
    let nu = 2.0 * (q[0] * (qd[0] - before[0]) + q[1] * (qd[1] - before[1])) / R;
    lines.extend([("q̇½", half.to_vec()), ("μ", vec![mu]), ("ν", vec![nu])]);
    lines.push(("2μ/h², 2ν/h", vec![2.0 * mu / (H * H), 2.0 * nu / H]));
    lines.extend(ended(&rattle));
    lines.extend(ended(&stepped(&system, &state, Integrator::Dop853)));
    lines.extend(ended(&stepped(&system, &state, Integrator::Implicit)));
    let mut bdf2 = stepped(&system, &state, Integrator::Bdf2);
    assert_eq!(bdf2.step().unwrap().substeps, 1);
    lines.extend(ended(&bdf2));
    let (soft, _) = hung(|builder| {
        builder.constraint("rod", Distance::new(pivot_id(), bob_id(), R).with_compliance(0.001, 0.0));
    });
    let mut soft = stepped(&soft, &state, Integrator::Implicit);
    lines.extend(ended(&soft));
    lines.push(("T", soft.tension()));
    lines
}

fn energy() -> Vec<Line> {
    let (system, state) = pendulum();
    let start = Simulation::new(system.clone(), state.clone(), Settings::default()).unwrap().energy();
    let euler = stepped(&system, &state, Integrator::Euler);
    let end = euler.energy();
    let dop853 = stepped(&system, &state, Integrator::Dop853).energy();
    assert!((dop853.balance() - start.balance()).abs() < 1e-9, "the page says so: {dop853:?}");
    vec![
        ("T", vec![start.kinetic]),
        ("V", vec![start.potential]),
        ("T'", vec![end.kinetic]),
        ("V'", vec![end.potential]),
        ("stabilization", vec![end.work.stabilization]),
        ("missing", vec![end.balance() - start.balance()]),
        ("energy_error", vec![euler.energy_error()]),
    ]
}

/// The rod, with a second rod that hangs from the bob.
fn chain(form: DistanceForm) -> Terms {
    let (system, state) = hung(|builder| {
        let second = Particle::at("second", [1.0, -2.0]).with_mass(2.0).with_velocity([1.0, 1.0]);
        let second = builder.particle(second);
        builder.constraint("rod", Distance { form, ..Distance::new(bob_id(), pivot_id(), R) });
        builder.constraint("below", Distance { form, ..Distance::new(second, bob_id(), 1.0) });
    });
    evaluate(&system, &state)
}

fn chains() -> Vec<Line> {
    let (squared, length) = (chain(DistanceForm::Squared), chain(DistanceForm::Length));
    // d·d − r² is twice the half squared form: J, γ and b are twice, A is four times, λ half of the value on the page.
    let A: Vec<f64> = squared.constraint_matrix.to_dense().iter().map(|a| a / 4.0).collect();
    let b: Vec<f64> = squared.right_hand_side.iter().map(|b| b / 2.0).collect();
    let (e, p1) = (A[2], A[0]);
    let p2 = A[3] * p1 - e * e;
    let y2 = b[1] - e * b[0] / p1;
    let lambda2 = y2 / (p2 / p1);
    let lambda1 = (b[0] - e * lambda2) / p1;
    let of_engine: Vec<f64> = squared.multipliers.iter().map(|lambda| 2.0 * lambda).collect();
    assert!((of_engine[0] - lambda1).abs() + (of_engine[1] - lambda2).abs() < 1e-12); // a few roundings of 20
    for (a, b) in squared.accelerations.iter().zip(&length.accelerations) {
        assert!((a - b).abs() < 1e-12); // the same motion in both forms, to a few roundings of 10
    }
    vec![
        ("A", A),
        ("b", b),
        ("p", vec![p1, p2]),
        ("D", vec![p1, p2 / p1]),
        ("y₂", vec![y2]),
        ("λ", of_engine),
        ("T", length.tension.clone()),
        ("q̈ of the bob", bob(&length.accelerations)),
    ]
}

fn expressions() -> Vec<Line> {
    let mut jet = None;
    let (system, state) = hung(|builder| {
        let (expression, constraint) = expression(builder, &POSITIONS);
        jet = Some(expression.jet(&POSITIONS, &[0.0, 0.0, 1.0, 1.0], 0.0));
        builder.constraint("rod", constraint);
    });
    let terms = evaluate(&system, &state);
    let jet = jet.unwrap();
    let mut lines = vec![("C, Ċ, γ", vec![jet.value, jet.first, jet.second])];
    lines.push(("J", bob(&terms.jacobian.to_dense())));
    lines.push(("λ", terms.multipliers.clone()));
    lines
}

fn bodies() -> Vec<Line> {
    let end = [1.5, -1.5];
    let body = Body::bar_in_plane(2.0, [[0.0, 0.0], end]).unwrap();
    let velocities = body.velocities([0.75, 0.75, 0.0], [0.0, 0.0, 1.0]);
    let mut builder = System::builder(Dimension::Two);
    for (k, (x, m)) in body.points.iter().zip(&body.masses).enumerate() {
        let v = velocities[k];
        builder.particle(Particle::at(format!("p{k}"), [x[0], x[1]]).with_mass(*m).with_velocity([v[0], v[1]]));
    }
    for (k, &[a, b]) in body.rods.iter().enumerate() {
        builder.constraint(format!("rod{k}"), Distance::new(systems::id(a), systems::id(b), body.length(k)));
    }
    let near = body.points.iter().position(|x| x[0].abs() + x[1].abs() < 1e-12).unwrap();
    let far = body.points.iter().position(|x| (x[0] - end[0]).abs() < 1e-12).unwrap();
    builder.constraint("nail", Nail::new(systems::id(near), [0.0; 3]));
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    let qdd = &terms.accelerations[2 * far..][..2];
    let turn = (end[0] * qdd[1] - end[1] * qdd[0]) / (end[0] * end[0] + end[1] * end[1]);
    let (pendulum, state) = self::pendulum();
    let qdd = bob(&evaluate(&pendulum, &state).accelerations);
    vec![
        ("L", vec![libm::hypot(end[0], end[1])]),
        ("m of the ends", vec![body.masses[near], body.masses[far]]),
        ("φ̈ of the bar", vec![turn]),
        ("φ̈ of the bob", vec![(qdd[1] + qdd[0]) / 2.0]),
    ]
}

fn contacts() -> Vec<Line> {
    let rope = |restitution: f64| {
        hung(|builder| {
            builder.constraint("rope", Limits { restitution, ..Limits::rope(pivot_id(), bob_id(), R) });
        })
    };
    let (system, state) = rope(0.0);
    let settings = Settings { h: H, ..Settings::default() };
    let mut taut = Simulation::new(system.clone(), state.clone(), settings).unwrap();
    let taut = taut.terms();
    let mut above = Simulation::new(system, at(&state, [1.0, 1.0], [-1.0, 1.0]), settings).unwrap();
    let above = above.terms();
    let mut lines = vec![
        ("J", bob(&taut.jacobian.to_dense())),
        ("b", taut.right_hand_side.clone()),
        ("λ", taut.multipliers.clone()),
        ("λ", above.multipliers.clone()),
        ("q̈", bob(&above.accelerations)),
    ];
    for (symbol, e) in [("q̇⁺ for e = 0", 0.0), ("q̇⁺ for e = ½", 0.5)] {
        let (system, state) = rope(e);
        let thrown = at(&state, [1.0, -1.0], [1.0, -1.0]);
        // A frame so short that gravity does not change the digits on the page.
        let short = Settings { h: 1e-9, ..settings };
        let mut simulation = Simulation::new(system, thrown, short).unwrap();
        simulation.step().unwrap();
        lines.push((symbol, bob(simulation.state().velocities())));
    }
    lines
}

fn pages() -> Vec<(&'static str, Vec<Line>)> {
    vec![
        ("README", readme()),
        ("forces", forces()),
        ("constraints", constraints()),
        ("multipliers", multipliers()),
        ("integrators", integrators()),
        ("energy", energy()),
        ("chains", chains()),
        ("expressions", expressions()),
        ("bodies", bodies()),
        ("contacts", contacts()),
    ]
}

/// The rows of every table with the heading, cell by cell.
fn tables(text: &str) -> Vec<Vec<&str>> {
    let mut rows = Vec::new();
    let mut is_inside = false;
    for line in text.lines() {
        if line == HEADING {
            is_inside = true;
        } else if !line.starts_with('|') {
            is_inside = false;
        } else if is_inside && !line.starts_with("|--") {
            rows.push(line.trim_matches('|').split(" | ").map(str::trim).collect());
        }
    }
    rows
}

/// Half a unit in the last digit of a number as it is printed.
fn half_a_digit(printed: &str) -> f64 {
    let decimals = printed.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    0.5 * (0..decimals).fold(1.0, |unit, _| unit / 10.0)
}

/// A printed number; documents and programs have different minus signs.
fn number(printed: &str) -> f64 {
    printed.replace('−', "-").parse().unwrap_or_else(|error| panic!("{printed}: {error}"))
}

#[test]
fn every_number_of_the_example_is_what_the_engine_computes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/method");
    let mut wrong = Vec::new();
    for (page, computed) in pages() {
        let text = fs::read_to_string(folder.join(format!("{page}.md"))).unwrap();
        let rows = tables(&text);
        let symbols: Vec<&str> = rows.iter().map(|row| row[0]).collect();
        let expected: Vec<&str> = computed.iter().map(|(symbol, _)| *symbol).collect();
        assert_eq!(symbols, expected, "{page}.md: the rows of the example");
        for (row, (symbol, values)) in rows.iter().zip(&computed) {
            assert_eq!(row.len(), 4, "{page}.md: no cell may be empty: {row:?}");
            let printed: Vec<&str> = row[2].split(", ").collect();
            let fits = |(printed, value): (&&str, &f64)| {
                // Roundoff of the engine is below 1e-13 of these numbers; with it a digit 5 may round up or down.
                (number(printed) - value).abs() <= half_a_digit(printed) + 1e-12
            };
            if printed.len() != values.len() || !printed.iter().zip(values).all(fits) {
                wrong.push(format!("{page}.md: {symbol} is {values:?}, not {printed:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_wrong_digit_would_be_seen() {
    assert_eq!(
        tables(&format!("{HEADING}\n|---|---|---|---|\n| q | here | 1.5, −2 | m |\n")),
        [["q", "here", "1.5, −2", "m"]]
    );
    assert_eq!((number("−2"), half_a_digit("−2"), half_a_digit("1.50")), (-2.0, 0.5, 0.005));
}
