//! Stiff systems under radau5, and the choice of radau5 by auto.

use crate::systems::{self, FRAME, settings};
use qhat::{
    Dimension, Distance, Drag, Expression, ExpressionForce, Gravity, Integrator, Particle, Purpose, Scope, Settings,
    Simulation, Spring, State, StepReport, System, Warning,
};

fn radau5(h: f64, tolerance: f64) -> Settings {
    Settings { tolerance, ..settings(Integrator::Radau5, h) }
}

/// A weight on a strut of 8e5 N/m and 4e4 N·s/m, whose rate is 1.3e5/s, with a pendulum on the weight.
fn strut() -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let weight = builder.particle(Particle::at("weight", [0.0, -0.5]).with_mass(0.3));
    let bob = builder.particle(Particle::at("bob", [0.5, -0.5]).with_mass(0.1));
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder.force(Spring { a: hook, b: weight, stiffness: 8e5, damping: 4e4, rest: 0.5 });
    builder.constraint("rod", Distance::new(weight, bob, 0.5));
    builder.build().unwrap()
}

/// ẍ = μ ((1 − x²) ẋ − x), van der Pol's oscillator with its slow motion in units of a second.
fn van_der_pol(mu: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let bead = builder.particle(Particle::at("bead", [2.0, 0.0]).with_velocity([-0.66, 0.0]));
    let number = |name: &str| (name == "bead").then_some(bead);
    let parse = |text: &str| Expression::parse(text, &Scope::new(Purpose::Force, Dimension::Two, &number)).unwrap();
    let along = parse(&format!("{mu}*((1 - bead.x^2)*bead.vx - bead.x)"));
    builder.force(ExpressionForce { particle: bead, components: vec![along, parse("0")] });
    builder.build().unwrap()
}

/// The simulation after a time, and the report of all its frames.
fn run((system, state): (System, State), settings: Settings, duration: f64) -> (Simulation, StepReport) {
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let frames = (duration / settings.h).round() as usize;
    let mut total = StepReport::default();
    for _ in 0..frames {
        let report = simulation.step().unwrap();
        total.substeps += report.substeps;
        total.rejected += report.rejected;
        total.max_residual = total.max_residual.max(report.max_residual);
        total.max_residual_rate = total.max_residual_rate.max(report.max_residual_rate);
        total.integrator = report.integrator;
        for warning in report.warnings {
            if !total.warnings.contains(&warning) {
                total.warnings.push(warning);
            }
        }
    }
    (simulation, total)
}

/// SciPy's Radau takes 3324 steps at rtol = atol = 1e-6 for an error of 1.9e-6. The end is that of its run at 1e-11.
#[test]
fn long_a_stiff_strut_is_followed_to_a_millionth() {
    let end = [-0.033_169_9, -0.498_902_32, -0.527_354_16, -0.574_941_24];
    for (integrator, most) in [(Integrator::Radau5, 3324), (Integrator::Auto, 4000)] {
        let (simulation, total) = run(strut(), Settings { tolerance: 1e-6, ..settings(integrator, 0.01) }, 10.0);
        assert_eq!(total.integrator, Integrator::Radau5);
        assert!(total.substeps + total.rejected <= most, "{} + {}", total.substeps, total.rejected);
        for (x, expected) in simulation.state().positions()[2..].iter().zip(end) {
            // 2e-6 of the method, 1e-8 of the digits of `end`.
            assert!((x - expected).abs() < 2e-6, "{integrator}: {x} for {expected}");
        }
        assert!(total.max_residual <= 1e-10 && total.max_residual_rate <= 1e-10, "{total:?}");
        assert!(simulation.energy_error_max() < 1e-6, "{integrator}: {:e}", simulation.energy_error_max());
    }
}

/// The error falls with the tolerance.
#[test]
fn a_tighter_tolerance_is_more_exact() {
    let positions = |tolerance: f64| run(strut(), radau5(0.01, tolerance), 2.0).0.state().positions().to_vec();
    let exact = positions(1e-11);
    let errors = [1e-4, 1e-6, 1e-8].map(|tolerance| systems::dense::difference(&positions(tolerance), &exact));
    for pair in errors.windows(2) {
        assert!(pair[1] < 0.2 * pair[0], "{errors:?}");
    }
    // Below that the constraint tolerance of 1e-10 decides.
    assert!(errors[2] < 1e-9, "{errors:?}");
}

/// μ = 1e6, two seconds with two jumps. SciPy's Radau takes 859 steps at 1e-6 for 5e-9, and 491 at 1e-5 for 1.6e-7. The
/// end is that of its run at 1e-12.
#[test]
fn van_der_pol_jumps() {
    for (tolerance, most, error) in [(1e-4, 360, 2e-6), (1e-6, 1000, 1e-8)] {
        let (simulation, total) = run(van_der_pol(1e6), radau5(2.0, tolerance), 2.0);
        let (x, v) = (simulation.state().positions()[0], simulation.state().velocities()[0]);
        assert!((x - 1.706_167_44).abs() < error + 5e-9 && (v + 0.892_810_02).abs() < error + 5e-9, "{x}, {v}");
        assert!(total.substeps + total.rejected <= most, "{} + {}", total.substeps, total.rejected);
    }
}

/// R(z) = (1 + 2z/5 + z²/20)/(1 − 3z/5 + 3z²/20 − z³/60) on the negative axis, by drag, and on the imaginary one, by a
/// spring: |R| ≤ 1 on both, and R → 0.
#[test]
fn it_is_l_stable() {
    for exponent in -2..=8 {
        let z = libm::pow(10.0, f64::from(exponent));
        let once = |builder: &mut qhat::SystemBuilder| {
            let (system, state) = builder.build().unwrap();
            let settings = Settings { constraint_tolerance: 1e-14, ..radau5(1.0, 0.999) };
            let mut simulation = Simulation::new(system, state, settings).unwrap();
            let report = simulation.step().unwrap();
            // Where the error is too large for one substep of one second, there are several; each has |R| ≤ 1.
            (simulation.state().positions()[2], simulation.state().velocities()[2], report.substeps)
        };
        let mut builder = System::builder(Dimension::Two);
        builder.particle(Particle::at("far", [1.0, 0.0]).fixed());
        builder.particle(Particle::at("bead", [0.0, 0.0]).with_velocity([1.0, 0.0]));
        builder.force(Drag { coefficient: z });
        let (_, v, substeps) = once(&mut builder);
        let R = (1.0 - z * (0.4 - z / 20.0)) / (1.0 + z * (0.6 + z * (0.15 + z / 60.0)));
        assert!(v.abs() <= 1.0, "R(−{z}) = {v}");
        if substeps == 1 {
            assert!((v - R).abs() < 1e-12, "R(−{z}) = {R}, not {v}");
        }
        let mut builder = System::builder(Dimension::Two);
        let far = builder.particle(Particle::at("far", [0.0, 0.0]).fixed());
        let bead = builder.particle(Particle::at("bead", [1.0, 0.0]));
        builder.force(Spring { a: far, b: bead, stiffness: z * z, damping: 0.0, rest: 0.0 });
        let (x, v, _) = once(&mut builder);
        let size = (x * x + v * v / (z * z)).sqrt();
        // Roundoff of a few operations where |R| is almost one.
        assert!(size <= 1.0 + 1e-12, "|R({z} i)| = {size}");
        // R(z i) → 3/(z i), of a substep of one second; one of at least a tenth leaves 30/z or less.
        assert!(z < 1e4 || size < 30.0 / z, "|R({z} i)| = {size}");
    }
}

/// A whip, and ends a thousand to a billion times heavier than the beads: rods and their rates hold.
#[test]
fn long_chains_stay_on_their_rods() {
    for ratio in [1.0, 1e3, 1e6, 1e9] {
        let (simulation, total) = run(systems::chain(30, ratio), radau5(FRAME, 1e-4), 1.0);
        // |C| of a rod of 0.01 m, and |Ċ| of particles at some 10 m/s.
        assert!(total.max_residual <= 1e-12 && total.max_residual_rate <= 1e-10, "{ratio:e}: {total:?}");
        assert!(simulation.energy_error().abs() < 1e-3, "{ratio:e}: {:e}", simulation.energy_error());
        assert_eq!(total.warnings, [], "{ratio:e}");
    }
}

/// A truss with one brace more than it needs: the motion is that of dop853, and the warning says that rows repeat
/// others.
#[test]
fn redundant_rows_are_left_out() {
    let exact = run(systems::truss(5, true), Settings { tolerance: 1e-10, ..settings(Integrator::Dop853, FRAME) }, 0.5);
    let (simulation, total) = run(systems::truss(5, true), radau5(FRAME, 1e-8), 0.5);
    let off = systems::dense::difference(simulation.state().positions(), exact.0.state().positions());
    assert!(off < 1e-7, "off by {off:e}");
    assert!(total.max_residual <= 1e-10, "{total:?}");
    assert_eq!(total.warnings, [Warning::Singular]);
}

/// Auto looks at the rates of forces, and tries whether they bound the substeps: a damper beside a rigid rod has a high
/// rate, and never moves.
#[test]
fn auto_is_not_misled_by_a_rate_that_nothing_moves_at() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [1.0, 0.0]));
    builder.constraint("rod", Distance::new(pivot, bob, 1.0));
    builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
    builder.force(Spring { a: pivot, b: bob, stiffness: 0.0, damping: 1e5, rest: 1.0 });
    let (_, total) = run(builder.build().unwrap(), settings(Integrator::Auto, FRAME), 1.0);
    assert_eq!(total.integrator, Integrator::Dop853);
}

/// A stiff spring without damping that oscillates by much must be followed, whatever its rate: dop853 does that with
/// less work.
#[test]
fn auto_follows_a_stiff_oscillation_with_dop853() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [1.2, 0.0]));
    builder.force(Spring { a: pivot, b: bob, stiffness: 4e8, damping: 0.0, rest: 1.0 });
    let start = settings(Integrator::Auto, FRAME);
    let (simulation, total) = run(builder.build().unwrap(), Settings { tolerance: 1e-7, ..start }, 0.2);
    assert_eq!(total.integrator, Integrator::Dop853);
    assert!(simulation.energy_error_max() < 1e-3, "{:e}", simulation.energy_error_max());
}
