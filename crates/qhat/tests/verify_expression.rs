//! Expressions of a user give the same motion as built-in kinds, close their account of energy, and end in an error
//! where they have no value.

use crate::systems;
use qhat::{
    BuildError, Constraint, Dimension, Distance, DistanceForm, Drag, Expression, ExpressionConstraint, ExpressionForce,
    ExpressionPotential, Feedback, Force, Gravity, Integrator, Nail, NailForm, Particle, Purpose, Scope, Settings,
    Simulation, Spring, System, SystemBuilder,
};

const GRAVITY: Gravity = Gravity { acceleration: [0.0, -9.81, 0.0] };
/// The particles of all chains here, p0 to p3.
const START: [f64; 8] = [0.0, 0.0, 1.0, 0.0, 1.6, 0.8, 1.6, 1.8];

fn parse(purpose: Purpose, text: &str) -> Expression {
    let particle = |name: &str| name.strip_prefix('p')?.parse().ok().map(systems::id);
    Expression::parse(text, &Scope::new(purpose, Dimension::Two, &particle)).unwrap_or_else(|error| panic!("{error}"))
}

fn row(text: &str) -> Constraint {
    ExpressionConstraint::new(parse(Purpose::Constraint, text), &START).into()
}

fn potential(text: &str) -> Force {
    ExpressionPotential { potential: parse(Purpose::Potential, text) }.into()
}

fn force(particle: usize, [x, y]: [&str; 2]) -> Force {
    let components = [x, y].map(|text| parse(Purpose::Force, text)).into();
    ExpressionForce { particle: systems::id(particle), components }.into()
}

/// Four particles that start as a chain of links of 1 m.
fn particles() -> SystemBuilder {
    let mut builder = System::builder(Dimension::Two);
    for (i, x) in START.chunks(2).enumerate() {
        builder.particle(Particle::at(format!("p{i}"), x).with_mass(1.0 + i as f64));
    }
    builder
}

/// The chain with a built-in last link, so that both systems have the same length scale, in which errors are measured.
fn chain(constraints: Vec<Constraint>, forces: Vec<Force>) -> SystemBuilder {
    let mut builder = particles();
    for (k, constraint) in constraints.into_iter().enumerate() {
        builder.constraint(format!("c{k}"), constraint);
    }
    builder.constraint("last", Distance::new(systems::id(2), systems::id(3), 1.0));
    for force in forces {
        builder.force(force);
    }
    builder
}

fn run(builder: SystemBuilder, integrator: Integrator, tolerance: f64, h: f64, duration: f64) -> Simulation {
    let (system, state) = builder.build().unwrap();
    let settings = Settings { integrator, tolerance, h, constraint_tolerance: 1e-13, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    for _ in 0..(duration / h).round() as usize {
        simulation.step().unwrap_or_else(|error| panic!("{integrator}: {error}"));
    }
    simulation
}

fn apart(one: &Simulation, other: &Simulation) -> f64 {
    let pairs = one.state().positions().iter().zip(other.state().positions());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The error in the balance of energy [J].
fn missing(builder: SystemBuilder, integrator: Integrator, tolerance: f64, h: f64) -> f64 {
    let (system, state) = builder.clone().build().unwrap();
    let begin = Simulation::new(system, state, Settings { integrator, ..Settings::default() }).unwrap();
    let end = run(builder, integrator, tolerance, h, 1.0);
    (end.energy().balance() - begin.energy().balance()).abs()
}

/// The distance that twins may have after a second. dop853 at a tolerance of 1e-12 follows the motion itself, to some
/// 1e-12 a substep. The other methods have larger errors, which are equal for twins with equal steps. Twins differ
/// where their Newton solves stop, some 1e-13 m in each of 100 steps, which is 1e-11 m/s in a velocity and up to 1e-9 m
/// after a second.
const TWINS: [(Integrator, f64, f64); 4] = [
    (Integrator::Dop853, 1e-12, 1e-10),
    (Integrator::Bdf2, 1e-4, 2e-9),
    (Integrator::Implicit, 1e-4, 2e-9),
    (Integrator::Rattle, 1e-6, 2e-9),
];

fn assert_twins(
    twins: [(Integrator, f64, f64); 4],
    one: impl Fn() -> SystemBuilder,
    other: impl Fn() -> SystemBuilder,
    what: &str,
) {
    for (integrator, tolerance, allowed) in twins {
        let one = run(one(), integrator, tolerance, 0.01, 1.0);
        let other = run(other(), integrator, tolerance, 0.01, 1.0);
        let apart = apart(&one, &other);
        assert!(apart <= allowed, "{what} under {integrator}: {apart:e} m apart");
    }
}

#[test]
fn nails_and_rods_as_expressions_move_as_the_built_in_ones() {
    let p = systems::id;
    let gravity = || vec![GRAVITY.into()];
    let squared = |a, b| Distance { form: DistanceForm::Squared, ..Distance::new(p(a), p(b), 1.0) };
    let built_in = || {
        let constraints =
            vec![Nail::new(p(0), [0.0; 3]).into(), Distance::new(p(0), p(1), 1.0).into(), squared(1, 2).into()];
        chain(constraints, gravity())
    };
    let written = || {
        let texts = ["p0.x", "p0.y", "dist(p0, p1) - 1", "dot(p1 - p2, p1 - p2) - 1"];
        chain(texts.map(row).into(), gravity())
    };
    assert_twins(TWINS, built_in, written, "the chain");
    let (built_in, _) = built_in().build().unwrap();
    let (written, _) = written().build().unwrap();
    for (one, other) in built_in.row_scales().iter().zip(written.row_scales()) {
        assert!((one - other).abs() < 1e-14, "scales {one} and {other}");
    }
}

/// The classic forms under Euler's method, where they need feedback: the same arithmetic up to roundoff.
#[test]
fn the_scalar_nail_as_an_expression_moves_as_the_built_in_one() {
    let feedback = Feedback { ks: 50.0, kd: 10.0, diagonal_drag: 0.1, elasticity: 0.1 };
    let nail = Nail { form: NailForm::Scalar, ..Nail::new(systems::id(0), [0.0; 3]) };
    let [one, other] = [nail.into(), row("dot(p0, p0)")].map(|nail| {
        let mut builder = chain(vec![nail, row("dist(p0, p1) - 1")], vec![GRAVITY.into()]);
        builder.feedback(feedback);
        run(builder, Integrator::Euler, 1e-4, 0.001, 0.5)
    });
    // 500 steps, each of roundoff, in a motion that doubles differences a few times.
    assert!(apart(&one, &other) < 1e-11, "{:e}", apart(&one, &other));
    assert_eq!(one.system().row_scales()[0], other.system().row_scales()[0]);
}

#[test]
fn forces_as_expressions_move_as_the_built_in_ones() {
    let held = || vec![row("p0.x"), row("p0.y"), row("dist(p0, p1) - 1")];
    let spring = |damping| Spring { a: systems::id(0), b: systems::id(2), stiffness: 40.0, damping, rest: 1.0 };
    let built_in = || {
        let forces = vec![GRAVITY.into(), Drag { coefficient: 0.3 }.into(), spring(0.7).into()];
        chain(held(), forces)
    };
    // The pull of the spring on p2, in the direction of p0.
    let rate = "dot([p0.vx - p2.vx, p0.vy - p2.vy], p0 - p2)/dist(p0, p2)";
    let pull = format!("(40*(dist(p0, p2) - 1) + 0.7*{rate})/dist(p0, p2)");
    let written = || {
        let of = |i: usize| {
            let m = 1.0 + i as f64;
            let sign = [-1.0, 0.0, 1.0, 0.0][i];
            let component =
                |axis: &str, g: f64| format!("-0.3*p{i}.v{axis} - {g}*{m} + {sign}*{pull}*(p0.{axis} - p2.{axis})");
            force(i, [component("x", 0.0).as_str(), component("y", 9.81).as_str()])
        };
        chain(held(), (0..4).map(of).collect())
    };
    // At the end of a step of bdf2 and implicit, the velocity is projected onto Ċ = 0 in the metric M + h² K of
    // Newton's matrix. The K of a damped spring lacks a part that the expressions have. The projections then differ by
    // h² K/M times their change of the velocity, which is itself some h².
    let by_components = TWINS.map(|(integrator, tolerance, allowed)| match integrator {
        Integrator::Bdf2 | Integrator::Implicit => (integrator, tolerance, 1e-5),
        _ => (integrator, tolerance, allowed),
    });
    assert_twins(by_components, built_in, written, "gravity, drag and a spring");
    let built_in = || chain(held(), vec![GRAVITY.into(), spring(0.0).into()]);
    let written = || {
        let gravity = "9.81*(p0.y + 2*p1.y + 3*p2.y + 4*p3.y)";
        chain(held(), vec![potential(&format!("{gravity} + 20*(dist(p0, p2) - 1)^2"))])
    };
    assert_twins(TWINS, built_in, written, "a potential");
}

/// A pendulum whose length is driven.
fn driven() -> SystemBuilder {
    let mut builder = particles();
    builder.with_constraint("x", row("p0.x")).constraint("y", row("p0.y"));
    builder.constraint("driven", row("dist(p0, p1) - (1 + 0.1*sin(3*t))"));
    // The length changes at 0.3 m/s at the start. The projection gives p1 this velocity. Euler's methods do not
    // project: they start from rest with Ċ off by 0.3 m/s, and only the acceleration is consistent.
    builder.force(GRAVITY);
    builder
}

#[test]
fn a_driven_length_closes_the_energy_account() {
    // The largest kinetic energy is some 20 J. The account of adaptive methods closes to their tolerance.
    for (integrator, tolerance, allowed) in [
        (Integrator::Dop853, 1e-10, 1e-7),
        (Integrator::Dopri5, 1e-9, 1e-6),
        (Integrator::Rattle, 1e-8, 1e-4),
        (Integrator::Auto, 1e-10, 1e-7),
    ] {
        let missing = missing(driven(), integrator, tolerance, 0.01);
        assert!(missing < allowed, "{integrator}: {missing:e} J");
    }
}

/// The power of h with which the error in the energy falls when h is halved.
#[test]
fn fixed_steps_close_it_at_their_order() {
    for (integrator, order, h) in [
        (Integrator::Euler, 1.0, 0.001),
        (Integrator::SymplecticEuler, 1.0, 0.001),
        (Integrator::Rk4, 4.0, 0.02),
        (Integrator::Implicit, 1.0, 0.001),
        (Integrator::Bdf2, 2.0, 0.002),
    ] {
        let [coarse, fine] = [h, 0.5 * h].map(|h| missing(driven(), integrator, 1e-4, h));
        let found = (coarse / fine).log2();
        // Two steps of h give the order up to the effect of the next power.
        assert!(found > order - 0.2, "{integrator}: order {found}, {coarse:e} J and {fine:e} J");
    }
}

/// A spring whose stiffness changes with time: the account contains the power ∂V/∂t.
#[test]
fn a_potential_that_changes_with_time_closes_the_account() {
    let system = || {
        let mut builder = particles();
        builder.force(potential("20*(1 + 0.5*sin(2*t))*(dist(p0, p1) - 0.5)^2 + p2.x*cos(t) + p3.y^2"));
        builder
    };
    // Some 10 J go back and forth between kinetic and potential energy.
    let exact = missing(system(), Integrator::Dop853, 1e-10, 0.01);
    assert!(exact < 1e-7, "dop853: {exact:e} J");
    let [coarse, fine] = [0.004, 0.002].map(|h| missing(system(), Integrator::Rk4, 1e-4, h));
    assert!((coarse / fine).log2() > 3.8, "rk4: {coarse:e} J and {fine:e} J");
    let end = run(system(), Integrator::Dop853, 1e-10, 0.01, 1.0);
    assert!(end.energy().work.total().abs() > 0.1, "{:?}", end.energy());
}

#[test]
fn an_expression_that_loses_its_value_ends_in_an_error() {
    let systems: [fn() -> SystemBuilder; 6] = [
        || chain(vec![row("p0.x"), row("p0.y + ln(1.05 - 10*t) - ln(1.05)")], vec![GRAVITY.into()]),
        || chain(vec![row("p0.x"), row("p0.y + sqrt(1 - 10*t) - 1")], vec![GRAVITY.into()]),
        || chain(vec![row("dist(p0, p1) - 1 + 0.01/(1.005 - 10*t) - 0.01/1.005")], vec![GRAVITY.into()]),
        || chain(vec![], vec![force(1, ["1/(0.1 - t)", "ln(0.1 - t)"])]),
        || chain(vec![], vec![potential("p2.x*ln(0.1 - t)")]),
        || chain(vec![], vec![force(1, ["exp(1000*t)*1e300", "p1.vx^1000"])]),
    ];
    for (number, system) in systems.iter().enumerate() {
        for integrator in Integrator::ALL {
            let (system, state) = system().build().unwrap();
            let settings = Settings { integrator, frame_budget: 1000, frame_work: 100_000, ..Settings::default() };
            let mut simulation = Simulation::new(system, state, settings).unwrap();
            let refused = (0..100).find_map(|_| simulation.step().err());
            assert!(refused.is_some(), "system {number} goes on under {integrator}: {:?}", simulation.state());
            assert!(simulation.state().positions().iter().all(|x| x.is_finite()), "{number}, {integrator}");
        }
    }
}

#[test]
fn expressions_that_cannot_be_held_are_refused() {
    let refused = |constraint: Constraint| {
        let mut builder = particles();
        builder.constraint("typed", constraint);
        match builder.build() {
            Err(BuildError::Constraint { name, reason, .. }) if name == "typed" => reason.to_string(),
            other => panic!("{other:?}"),
        }
    };
    assert!(refused(row("t - 1")).contains("depends on no particle"));
    assert!(refused(row("ln(p0.x - 1)")).contains("not a finite number at the start"));
    assert!(refused(row("sqrt(p0.x)")).contains("not a finite number at the start"));
    assert!(refused(row("p0.x^4")).contains("its scale must be given"));
    assert!(refused(row("p9.x")).contains("no particle number 9"));
    let given = |scale| {
        let quartic = parse(Purpose::Constraint, "p0.x^4");
        ExpressionConstraint::new(quartic, &START).with_scale(scale)
    };
    assert!(refused(given(0.0).into()).contains("must be above 0"));
    assert_eq!(given(1.0).check(), Ok(()));
    let velocity = ExpressionConstraint::new(parse(Purpose::Force, "p0.vx"), &START);
    assert!(refused(velocity.into()).contains("not on velocities"));
    let particle = |_: &str| Some(systems::id(3));
    let scope = Scope::new(Purpose::Force, Dimension::Three, &particle);
    let in_space = ExpressionConstraint::new(Expression::parse("p.z", &scope).unwrap(), &START);
    assert!(refused(in_space.into()).contains("written for 3 dimensions"));
    let mut builder = particles();
    builder.force(ExpressionPotential { potential: Expression::parse("p.z", &scope).unwrap() });
    assert!(builder.build().unwrap_err().to_string().contains("written for 3 dimensions"));
    let mut builder = particles();
    builder.force(ExpressionForce { particle: systems::id(0), components: vec![parse(Purpose::Force, "1"); 3] });
    assert!(builder.build().unwrap_err().to_string().contains("dimension"));
    let mut builder = particles();
    builder.force(potential("t^2"));
    assert!(builder.build().unwrap_err().to_string().contains("pulls nothing"));
}
