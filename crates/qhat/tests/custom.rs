//! Constraints and potentials that a user writes in Rust: compared with the same formulas as expressions and with
//! forces of the engine.

use qhat::{
    BuildError, Constraint, Custom, CustomConstraint, CustomForce, Dimension, Expression, ExpressionConstraint,
    ExpressionPotential, Force, Gravity, Hyper, Integrator, Particle, ParticleId, Purpose, Scope, Settings, Simulation,
    Spring, State, StepError, System, step_all,
};

/// r = a θ: C = a sin(r/a − φ), with the polar angle φ.
struct Spiral {
    a: f64,
}

impl CustomConstraint for Spiral {
    fn residual(&self, x: &[[Hyper; 3]], _: Hyper) -> Hyper {
        let [x, y, _] = x[0];
        let r = x.hypot(y);
        self.a * (x * (r / self.a).sin() - y * (r / self.a).cos()) / r
    }
}

const SPIRAL: &str = "0.1*(bead.x*sin(length(bead)/0.1) - bead.y*cos(length(bead)/0.1))/length(bead)";

/// The point of the spiral r = 0.1 θ at θ = 20.
fn on_spiral() -> [f64; 2] {
    [2.0 * libm::cos(20.0), 2.0 * libm::sin(20.0)]
}

fn bead() -> ParticleId {
    crate::systems::id(0)
}

fn bob() -> ParticleId {
    crate::systems::id(1)
}

fn expression(text: &str, purpose: Purpose, dimension: Dimension) -> Expression {
    let particle = |name: &str| ["bead", "bob"].iter().position(|known| *known == name).map(crate::systems::id);
    Expression::parse(text, &Scope::new(purpose, dimension, &particle)).unwrap()
}

fn same_as(text: &str, positions: &[f64]) -> Constraint {
    ExpressionConstraint::new(expression(text, Purpose::Constraint, Dimension::Two), positions).into()
}

fn settings(integrator: Integrator) -> Settings {
    Settings { integrator, tolerance: 1e-8, constraint_tolerance: 1e-13, ..Settings::default() }
}

/// A bead on a spiral, and a bob at the end of a rod that begins at the bead and whose length is driven.
fn spiral(spiral: Constraint, rod: Constraint) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let [x, y] = on_spiral();
    builder.particle(Particle::at("bead", [x, y]));
    builder.particle(Particle::at("bob", [x + 1.0, y]).with_mass(0.3));
    builder.constraint("spiral", spiral);
    builder.constraint("rod", rod);
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder.build().unwrap()
}

fn custom() -> (System, State) {
    let rod = |x: &[[Hyper; 3]], t: Hyper| (x[1][0] - x[0][0]).hypot(x[1][1] - x[0][1]) - 1.0 - 0.1 * (2.0 * t).sin();
    // The scales that the expressions measure, so that both stop their iterations at the same residual.
    let (typed, _) = typed();
    let [spiral_scale, rod_scale] = [typed.row_scales()[0], typed.row_scales()[1]];
    spiral(
        Custom::new([bead()], Spiral { a: 0.1 }).with_scale(spiral_scale).into(),
        Custom::new([bead(), bob()], rod).with_scale(rod_scale).into(),
    )
}

fn typed() -> (System, State) {
    let [x, y] = on_spiral();
    let at = [x, y, x + 1.0, y];
    spiral(same_as(SPIRAL, &at), same_as("dist(bob, bead) - 1 - 0.1*sin(2*t)", &at))
}

/// All positions after a number of frames of 10 ms.
fn run((system, state): (System, State), integrator: Integrator, frames: usize) -> (Vec<f64>, Simulation) {
    let mut simulation = Simulation::new(system, state, settings(integrator)).unwrap();
    for _ in 0..frames {
        simulation.step().unwrap();
    }
    (simulation.state().positions().to_vec(), simulation)
}

fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

#[test]
fn a_custom_constraint_moves_as_the_same_expression() {
    // The derivatives agree to roundoff, which 300 frames amplify; measured: 5e-15 and 2e-13 m. The implicit method
    // ends its iterations when forces balance to 1e-8. Roundoff decides whether a step near that limit takes one more
    // iteration, and 300 steps add up; measured: 3e-8 m, and 2e-9 of the kinetic energy.
    for (integrator, good) in [(Integrator::Dop853, 1e-12), (Integrator::Rattle, 1e-11), (Integrator::Implicit, 1e-6)] {
        let (own, simulation) = run(custom(), integrator, 300);
        let (text, twin) = run(typed(), integrator, 300);
        let apart = largest_difference(&own, &text);
        println!("{integrator}: {apart:e}");
        assert!(apart < good, "{integrator}: {apart:e} m apart after 3 s");
        let moved = largest_difference(&own, custom().1.positions());
        assert!(moved > 0.05, "{integrator}: nothing moved: {moved}");
        let errors = [&simulation, &twin].map(Simulation::energy_error_max);
        assert!((errors[0] - errors[1]).abs() < good.max(1e-9), "{integrator}: {errors:?}");
    }
}

/// A bead and a bob in space under gravity, with one force between them.
fn pulled(force: Force) -> (System, State) {
    let mut builder = System::builder(Dimension::Three);
    builder.particle(Particle::at("bead", [0.0, 0.2, 0.0]).with_velocity([0.0, 0.5, 0.3]));
    builder.particle(Particle::at("bob", [1.2, 0.0, 0.4]).with_mass(0.3));
    builder.force(Gravity { acceleration: [0.0, 0.0, -9.81] });
    builder.force(force);
    builder.build().unwrap()
}

/// V = ½ k (|d| − L)².
fn spring_potential(x: &[[Hyper; 3]], _: Hyper) -> Hyper {
    let square: Hyper = (0..3).map(|k| (x[0][k] - x[1][k]).powi(2)).sum();
    let stretched = square.sqrt() - 1.0;
    0.5 * 20.0 * stretched * stretched
}

#[test]
fn a_custom_potential_moves_as_a_spring_does() {
    let spring = || Spring { a: bead(), b: bob(), stiffness: 20.0, damping: 0.0, rest: 1.0 }.into();
    for integrator in [Integrator::Dop853, Integrator::Rattle, Integrator::Implicit, Integrator::Rk4] {
        let (own, simulation) =
            run(pulled(CustomForce::new([bead(), bob()], spring_potential).into()), integrator, 300);
        let (builtin, _) = run(pulled(spring()), integrator, 300);
        let apart = largest_difference(&own, &builtin);
        println!("{integrator}: {apart:e}");
        assert!(apart < 1e-10, "{integrator}: {apart:e} m apart after 3 s, 44 m of fall");
        if integrator == Integrator::Dop853 {
            assert!(simulation.energy_error_max() < 1e-6, "the potential accounts for the force");
        }
    }
}

/// A potential that changes with time adds or takes energy; the account of energy contains it.
#[test]
fn a_custom_potential_may_depend_on_time() {
    let driven = |x: &[[Hyper; 3]], t: Hyper| 8.0 * (x[0][0] - 0.3 * (4.0 * t).sin()).powi(2) + x[1][0].cos() * x[0][1];
    let own = || pulled(CustomForce::new([bead(), bob()], driven).into());
    let text = "8*(bead.x - 0.3*sin(4*t))^2 + cos(bob.x)*bead.y";
    let potential = expression(text, Purpose::Potential, Dimension::Three);
    let (one, simulation) = run(own(), Integrator::Dop853, 300);
    let (other, twin) = run(pulled(ExpressionPotential { potential }.into()), Integrator::Dop853, 300);
    let apart = largest_difference(&one, &other);
    println!("{apart:e}");
    assert!(apart < 1e-11, "{apart:e} m apart after 3 s");
    assert!(simulation.energy_error_max() < 1e-6, "{}", simulation.energy_error_max());
    let work = [&simulation, &twin].map(|simulation| simulation.state().work().total());
    assert!(work[0].abs() > 1e-3 && (work[0] - work[1]).abs() < 1e-9, "{work:?}");
}

/// A bead on y = 0. Its residual or a derivative of the residual is not finite at x > 1, where the bead arrives after a
/// second.
fn gone_wrong(residual: fn(Hyper, Hyper) -> Hyper, integrator: Integrator) -> Result<(), StepError> {
    let mut builder = System::builder(Dimension::Two);
    let bead = builder.particle(Particle::at("bead", [0.0, 0.0]).with_velocity([1.0, 0.0]));
    let line = move |x: &[[Hyper; 3]], _: Hyper| residual(x[0][0], x[0][1]);
    builder.constraint("line", Custom::new([bead], line));
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings { h: 0.02, ..settings(integrator) })?;
    for _ in 0..100 {
        simulation.step()?;
    }
    Ok(())
}

#[test]
fn a_residual_that_goes_wrong_ends_the_step_in_an_error() {
    type Residual = fn(Hyper, Hyper) -> Hyper;
    let wrong: [(&str, Residual); 5] = [
        ("ln of what is negative", |x, y| y + 0.0 * (1.0 - x).ln()),
        ("C is NaN", |x, y| if x.value() > 1.0 { y.with(f64::NAN, 1.0, 0.0) } else { y }),
        ("C is infinite", |x, y| if x.value() > 1.0 { y / 0.0 } else { y }),
        ("J is NaN", |x, y| if x.value() > 1.0 { y.with(y.value(), f64::NAN, 0.0) } else { y }),
        ("J is infinite", |x, y| if x.value() > 1.0 { y.with(y.value(), f64::INFINITY, 0.0) } else { y }),
    ];
    for integrator in Integrator::ALL {
        for (name, residual) in wrong {
            let result = gone_wrong(residual, integrator);
            println!("{name} under {integrator}: {result:?}");
            assert!(result.is_err(), "{name} under {integrator}");
        }
        assert_eq!(gone_wrong(|_, y| y, integrator), Ok(()), "{integrator}");
    }
}

/// A residual that has no value at the start is refused before the run.
#[test]
fn a_residual_without_a_value_at_the_start_is_refused() {
    for integrator in [Integrator::Auto, Integrator::Rattle, Integrator::Implicit, Integrator::Rk4] {
        let result = gone_wrong(|x, y| y + (x - 1.0).ln(), integrator);
        println!("{integrator}: {result:?}");
        assert!(result.is_err(), "{integrator}");
    }
}

#[test]
fn what_names_no_particle_or_one_twice_is_refused() {
    let refused = |constraint: Custom| {
        let mut builder = System::builder(Dimension::Two);
        builder.particle(Particle::at("bead", [0.0, 0.0]));
        builder.constraint("own", constraint);
        builder.build().map(|_| ()).unwrap_err().to_string()
    };
    let y = |x: &[[Hyper; 3]], _: Hyper| x[0][1];
    assert!(refused(Custom::new([], y)).contains("names no particle"));
    assert!(refused(Custom::new([bead(), bead()], y)).contains("named twice"));
    assert!(refused(Custom::new([bead()], y).with_scale(0.0)).contains("must be above 0"));
    assert!(refused(Custom::new([bead()], y).with_scale(f64::NAN)).contains("must be above 0"));
    assert!(!refused(Custom::new([bob()], y)).is_empty(), "a particle that is not there");

    let refused = |force: CustomForce| -> BuildError {
        let mut builder = System::builder(Dimension::Two);
        builder.particle(Particle::at("bead", [0.0, 0.0]));
        builder.force(force);
        builder.build().map(|_| ()).unwrap_err()
    };
    assert!(refused(CustomForce::new([], y)).to_string().contains("names no particle"));
    assert!(refused(CustomForce::new([bead(), bead()], y)).to_string().contains("named twice"));
}

#[test]
fn clones_are_equal_and_others_are_not() {
    let y = |x: &[[Hyper; 3]], _: Hyper| x[0][1];
    let (one, other) = (Custom::new([bead()], y), Custom::new([bead()], y));
    assert_eq!(one, one.clone());
    assert_ne!(one, other, "two residuals may be any two functions");
    assert_ne!(one, one.clone().with_scale(2.0));
    let (one, other) = (CustomForce::new([bead()], y), CustomForce::new([bead()], y));
    assert_eq!(one, one.clone());
    assert_ne!(one, other);
    // The debug form of both shows the particles only.
    assert_eq!(format!("{one:?}"), "CustomForce { particles: [ParticleId(0)], .. }");
}

/// Threads share the functions of a user and compute the same bits.
#[test]
fn threads_step_custom_constraints_to_the_same_bits() {
    let (system, state) = custom();
    let start = Simulation::new(system, state, settings(Integrator::Dop853)).unwrap();
    let mut many = vec![start; 8];
    for _ in 0..20 {
        assert!(step_all(&mut many).iter().all(Result::is_ok));
    }
    let (alone, _) = run(custom(), Integrator::Dop853, 20);
    for simulation in &many {
        assert_eq!(simulation.state().positions(), alone);
    }
}

/// A factor before C changes only roundoff if the scale has the same factor.
#[test]
fn a_scale_has_the_unit_of_its_residual() {
    let thousandfold = |x: &[[Hyper; 3]], t: Hyper| 1000.0 * Spiral { a: 0.1 }.residual(x, t);
    let positions = |constraint: Custom| {
        let mut builder = System::builder(Dimension::Two);
        builder.particle(Particle::at("bead", on_spiral()));
        builder.constraint("spiral", constraint);
        builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
        run(builder.build().unwrap(), Integrator::Rattle, 100).0
    };
    let plain = positions(Custom::new([bead()], Spiral { a: 0.1 }).with_scale(2.0));
    let scaled = positions(Custom::new([bead()], thousandfold).with_scale(2000.0));
    assert!(largest_difference(&plain, &scaled) < 1e-10, "{plain:?} {scaled:?}");
}
