//! Edges of a motion: ends of curves, gradients that are lost, dead centres, drives that are blocked. Each run goes on
//! where the motion does, and ends with the true culprit where it does not.

use crate::systems::{self, gravity};
use qhat::{
    Constraint, Curve, CurveEnd, Dimension, Distance, Driven, ExpressionConstraint, Gravity, Integrator, Lengths, Nail,
    OnCurve, OnSphere, Particle, ParticleId, Purpose, Scope, Settings, Simulation, StepError, System, SystemBuilder,
    Workspace, step,
};

const ADAPTIVE: [Integrator; 4] = [Integrator::Auto, Integrator::Dop853, Integrator::Dopri5, Integrator::Rattle];

fn accurate(integrator: Integrator) -> Settings {
    Settings { tolerance: 1e-8, ..systems::settings(integrator, 0.01) }
}

/// A bead at a place with a velocity, on the path of some expressions.
fn bead(texts: &[&str], [from, to]: [f64; 2], at: &[f64], velocity: &[f64]) -> SystemBuilder {
    let dimension = if texts.len() == 2 { Dimension::Two } else { Dimension::Three };
    let scope = Scope::new(Purpose::Curve, dimension, &|_| None);
    let path = texts.iter().map(|text| qhat::Expression::parse(text, &scope).unwrap()).collect();
    on(Curve::parametric(path, from, to).unwrap(), dimension, at, velocity)
}

fn on(curve: Curve, dimension: Dimension, at: &[f64], velocity: &[f64]) -> SystemBuilder {
    let mut builder = System::builder(dimension);
    let particle = builder.particle(Particle::at("bead", at).with_velocity(velocity));
    builder.constraint("wire", OnCurve { particle, curve });
    builder
}

fn begin(builder: &SystemBuilder, settings: Settings) -> Result<Simulation, StepError> {
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, settings)
}

/// The error that ends a run of so many seconds.
fn ended(builder: &SystemBuilder, settings: Settings, seconds: f64) -> StepError {
    let mut simulation = match begin(builder, settings) {
        Ok(simulation) => simulation,
        Err(error) => return error,
    };
    for _ in 0..(seconds / settings.h).round() as usize {
        if let Err(error) = simulation.step() {
            return error;
        }
    }
    panic!("{} went on to {} s", settings.integrator, simulation.state().time())
}

/// A bead that falls down a helix from rest goes s = ½ g p/(r² + p²) t², also beyond the range and round after round,
/// and keeps its energy.
#[test]
fn a_helix_goes_on_beyond_its_range() {
    let mut builder = bead(&["0.5*cos(s)", "-0.1*s", "0.5*sin(s)"], [0.0, 18.0], &[0.5, 0.0, 0.0], &[0.0; 3]);
    builder.force(gravity());
    let mut simulation = begin(&builder, Settings { tolerance: 1e-10, ..accurate(Integrator::Auto) }).unwrap();
    for _ in 0..3000 {
        simulation.step().unwrap();
    }
    let s = 0.5 * systems::G * 0.1 / (0.25 + 0.01) * 900.0;
    let y = simulation.state().positions()[1];
    // In 30 s the bead falls 170 m. It is 4e-7 m off, after 11 000 substeps at 1e-10.
    assert!((y + 0.1 * s).abs() < 1e-5, "{y} m, and not {} m", -0.1 * s);
    // The substeps, each with an error of about 1e-10 of either sign, leave 1.3e-8.
    assert!(simulation.energy_error_max() < 1e-7, "{:e}", simulation.energy_error_max());
}

/// Without forces a bead goes at one speed through the crossing of a figure of eight, from one lobe to the other, and
/// comes back after the same time each round.
#[test]
fn a_bead_goes_straight_through_a_crossing() {
    let at = |s: f64| [libm::sin(s), 0.5 * libm::sin(2.0 * s)];
    let builder = bead(&["sin(s)", "sin(2*s)/2"], [-3.2, 3.2], &at(1.0), &[libm::cos(1.0), libm::cos(2.0)]);
    let mut simulation = begin(&builder, accurate(Integrator::Dop853)).unwrap();
    let speed = (libm::pow(libm::cos(1.0), 2.0) + libm::pow(libm::cos(2.0), 2.0)).sqrt();
    // The length of the whole curve, by the trapezoidal rule, which is exact for smooth periodic functions.
    let rate = |s: f64| (libm::pow(libm::cos(s), 2.0) + libm::pow(libm::cos(2.0 * s), 2.0)).sqrt();
    let length: f64 = (0..400).map(|i| rate(std::f64::consts::TAU * f64::from(i) / 400.0)).sum::<f64>()
        * std::f64::consts::TAU
        / 400.0;
    let mut sides = [0.0_f64; 2];
    for _ in 0..3 {
        for _ in 0..100 {
            simulation.advance(length / speed / 100.0).unwrap();
            let x = simulation.state().positions()[0];
            sides = [sides[0].min(x), sides[1].max(x)];
        }
        for (x, start) in simulation.state().positions().iter().zip(at(1.0)) {
            assert!((x - start).abs() < 1e-6, "{x} and not {start}");
        }
    }
    // The lobes end at ±1; a hundred frames a round come within 2e-3 of that.
    assert!(sides[0] < -0.99 && sides[1] > 0.99, "{sides:?}");
    let error = simulation.energy_error_max();
    // Errors of at most 1e-8 in each of some hundred substeps, of either sign.
    assert!(error < 1e-7, "{error:e}");
}

/// A run that is saved and loaded gives the same bits, also beyond the range of a path.
#[test]
fn a_restart_finds_the_foot_where_it_was() {
    for integrator in Integrator::ALL {
        let mut builder = bead(&["0.5*cos(s)", "-0.1*s", "0.5*sin(s)"], [0.0, 1.0], &[0.5, 0.0, 0.0], &[0.0; 3]);
        builder.force(gravity());
        let (system, state) = builder.build().unwrap();
        let settings = systems::settings(integrator, if integrator.is_adaptive() { 0.1 } else { 1e-3 });
        let mut state = Simulation::new(system.clone(), state, settings).unwrap().state().clone();
        let mut kept = Workspace::new(&system);
        for frame in 0..25 {
            let mut restarted = state.clone();
            step(&system, &mut restarted, &settings, &mut Workspace::new(&system)).unwrap();
            step(&system, &mut state, &settings, &mut kept).unwrap();
            assert_eq!(state, restarted, "{integrator}, frame {frame}");
        }
    }
}

/// An open spline and an open polyline end; the error names the bead and the end, at the time when it is there.
#[test]
fn an_open_curve_ends_where_its_points_do() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let curves = [Curve::through(&points, false).unwrap(), Curve::polyline(&points, 0.1, false).unwrap()];
    for curve in curves {
        for (velocity, end, when) in [(1.0, CurveEnd::Last, 1.5), (-1.0, CurveEnd::First, 0.5)] {
            let builder = on(curve.clone(), Dimension::Two, &[0.5, 0.0], &[velocity, 0.0]);
            for integrator in ADAPTIVE {
                match ended(&builder, accurate(integrator), 3.0) {
                    StepError::CurveEnds { time, particle, constraint, end: at } => {
                        assert_eq!((particle.as_str(), constraint.as_str(), at), ("bead", "wire", end));
                        assert!((time - when).abs() < 1e-8, "{integrator}: {time}");
                    }
                    other => panic!("{integrator}: {other}"),
                }
            }
        }
    }
}

/// A light weight of 1 kg is pulled up by 3 kg, at (3 − 1)/(3 + 1) g, until it is in its guide.
fn pulley(rope: impl Fn([ParticleId; 4]) -> Constraint) -> SystemBuilder {
    let mut builder = System::builder(Dimension::Two);
    let left = builder.particle(Particle::at("left", [-1.0, 0.0]).fixed());
    let right = builder.particle(Particle::at("right", [1.0, 0.0]).fixed());
    let light = builder.particle(Particle::at("light", [-1.0, -1.0]));
    let heavy = builder.particle(Particle::at("heavy", [1.0, -2.0]).with_mass(3.0));
    builder.constraint("rope", rope([light, left, right, heavy]));
    builder.force(Gravity { acceleration: [0.0, -10.0, 0.0] });
    builder
}

/// √(2 · 1 m/5 m/s²).
const IN_THE_GUIDE: f64 = 0.632_455_532_033_675_9;

#[test]
fn a_stretch_of_a_rope_that_has_no_length_left_ends_the_run() {
    let builder = pulley(|points| Lengths::pulley(&points, 5.0).into());
    for integrator in Integrator::ALL {
        let h = if integrator.is_adaptive() { 0.01 } else { 1e-3 };
        let settings = Settings { tolerance: 1e-8, ..systems::settings(integrator, h) };
        // The methods of the first order are late by their own error.
        let late = match integrator {
            Integrator::Euler | Integrator::SymplecticEuler | Integrator::Implicit => 0.02,
            Integrator::Rk4 | Integrator::Bdf2 => 2e-3,
            _ => 1e-6,
        };
        match ended(&builder, settings, 1.5) {
            StepError::NoGradient { time, constraint, ends } => {
                assert_eq!((constraint.as_str(), ends.as_slice()), ("rope", &["light".to_owned(), "left".into()][..]));
                assert!((time - IN_THE_GUIDE).abs() < late, "{integrator}: {time}");
            }
            other => panic!("{integrator}: {other}"),
        }
    }
}

/// The same rope as an expression, which has a kink where the stretch has no length.
#[test]
fn an_expression_that_loses_its_gradient_ends_the_run() {
    let names = ["left", "right", "light", "heavy"];
    let find = |name: &str| names.iter().position(|known| *known == name).map(systems::id);
    let text = "dist(light, left) + 2 + dist(right, heavy) - 5";
    let expression = qhat::Expression::parse(text, &Scope::new(Purpose::Constraint, Dimension::Two, &find)).unwrap();
    let start = [-1.0, 0.0, 1.0, 0.0, -1.0, -1.0, 1.0, -2.0];
    let builder = pulley(|_| ExpressionConstraint::new(expression.clone(), &start).into());
    for integrator in ADAPTIVE {
        match ended(&builder, accurate(integrator), 1.5) {
            StepError::NoGradient { time, constraint, .. } => {
                assert_eq!(constraint, "rope");
                assert!((time - IN_THE_GUIDE).abs() < 1e-6, "{integrator}: {time}");
            }
            other => panic!("{integrator}: {other}"),
        }
    }
}

/// A rod from a particle or a point that is drawn in to nothing at t = 1.
#[test]
fn a_driven_rod_that_shrinks_to_nothing_ends_the_run() {
    for is_about_a_point in [false, true] {
        let mut builder = System::builder(Dimension::Two);
        let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
        let load = builder.particle(Particle::at("load", [0.0, -1.0]).with_velocity([0.0, 1.0]));
        let length = Driven::text("1 - t").unwrap();
        let about_a_point = OnSphere::new(load, [0.0; 3], length.clone());
        let winch = if is_about_a_point { about_a_point } else { OnSphere::new(load, hook, length) };
        builder.with_constraint("winch", winch).force(gravity());
        let expected: &[&str] = if is_about_a_point { &["load"] } else { &["load", "hook"] };
        for integrator in ADAPTIVE {
            match ended(&builder, accurate(integrator), 1.5) {
                StepError::NoGradient { time, constraint, ends } => {
                    assert_eq!(constraint, "winch");
                    assert_eq!(ends, expected, "{integrator}");
                    assert!((time - 1.0).abs() < 1e-6, "{integrator}: {time}");
                }
                other => panic!("{integrator}: {other}"),
            }
        }
    }
}

/// A start at a dead centre is refused, and the state is then as it was before the projection.
#[test]
fn a_start_that_is_refused_stays_as_it_was() {
    let (system, mut state) = slider_crank("1.5 + 0.5*cos(t)", [0.5 + 1e-6, 0.0]).build().unwrap();
    let before = state.clone();
    let settings = accurate(Integrator::Dop853);
    let error = qhat::project(&system, &mut state, &settings, &mut Workspace::new(&system)).unwrap_err();
    assert!(matches!(error, StepError::Undecided { .. }), "{error}");
    assert_eq!(state, before);
}

/// A gradient that goes smoothly through zero is no edge: the bead on x y = 0 goes straight on through the crossing.
#[test]
fn a_gradient_may_go_through_zero() {
    let mut builder = System::builder(Dimension::Two);
    builder.particle(Particle::at("bead", [-1.0, 0.0]).with_velocity([1.0, 0.0]));
    let expression = builder.expression(Purpose::Constraint, "bead.x*bead.y").unwrap();
    builder.constraint("cross", ExpressionConstraint::new(expression, &[-1.0, 0.0]));
    let mut simulation = begin(&builder, Settings { h: 0.03, ..accurate(Integrator::Dop853) }).unwrap();
    for _ in 0..60 {
        simulation.step().unwrap();
    }
    assert!((simulation.state().positions()[0] - 0.8).abs() < 1e-9);
}

fn slider_crank(drive: &str, pin: [f64; 2]) -> SystemBuilder {
    let mut builder = System::builder(Dimension::Two);
    let axle = builder.particle(Particle::at("axle", [0.0, 0.0]).fixed());
    let pin = builder.particle(Particle::at("pin", pin));
    let slider = builder.particle(Particle::at("slider", [2.0, 0.0]));
    builder.constraint("crank", Distance::new(axle, pin, 0.5));
    builder.constraint("rod", Distance::new(pin, slider, 1.5));
    builder.constraint("drive", Nail::driven(slider, [Driven::text(drive).unwrap(), 0.0.into(), 0.0.into()]));
    builder
}

/// At a dead centre two motions follow the drive.
#[test]
fn a_dead_centre_is_told_by_its_drive() {
    let builder = slider_crank("1.5 + 0.5*cos(t)", [0.5, 0.0]);
    for integrator in ADAPTIVE.into_iter().chain([Integrator::Implicit, Integrator::Bdf2]) {
        let error = ended(&builder, accurate(integrator), 1.0);
        assert_eq!(error, StepError::Undecided { time: 0.0, drive: "drive".into() }, "{integrator}: {error}");
    }
}

/// A drive that comes to the end of its linkage on the way is named by every method that chooses its substeps.
#[test]
fn a_drive_at_the_end_of_its_linkage_is_named() {
    let start = 2.0_f64.sqrt();
    let mut builder = System::builder(Dimension::Two);
    let axle = builder.particle(Particle::at("axle", [0.0, 0.0]).fixed());
    let pin = builder.particle(Particle::at("pin", [0.0, 0.5]));
    let slider = builder.particle(Particle::at("slider", [start, 0.0]));
    builder.constraint("crank", Distance::new(axle, pin, 0.5));
    builder.constraint("rod", Distance::new(pin, slider, 1.5));
    let drive = Driven::text("sqrt(2) + 0.6*sin(t)").unwrap();
    builder.constraint("drive", Nail::driven(slider, [drive, 0.0.into(), 0.0.into()]));
    for integrator in ADAPTIVE {
        let settings = accurate(integrator);
        let error = ended(&builder, settings, 3.0);
        let is_named = match &error {
            // A residual within the tolerance is not off.
            StepError::DriveBlocked { drive, residual, .. } => {
                drive == "drive" && residual.abs() > settings.constraint_tolerance
            }
            StepError::DriveEnds { drive, .. } => drive == "drive",
            _ => false,
        };
        assert!(is_named, "{integrator}: {error}");
    }
}

/// A drive that pulls farther than the rods reach is named, and so is one that moves a fixed particle.
#[test]
fn a_drive_that_asks_for_too_much_is_named() {
    for drive in ["2.05 - 0.05*cos(t)", "2 + 0.1*t"] {
        let error = ended(&slider_crank(drive, [0.5, 0.0]), accurate(Integrator::Dop853), 4.0);
        let is_named = matches!(&error, StepError::DriveBlocked { drive, .. } if drive == "drive")
            || matches!(&error, StepError::DriveEnds { drive, .. } if drive == "drive")
            || matches!(&error, StepError::RateNotSatisfied { drive: Some(drive), .. } if drive == "drive");
        assert!(is_named, "{drive}: {error}");
    }
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [1.0, 0.0]).fixed());
    builder.particle(Particle::at("stone", [0.0, 0.0]));
    let drive = OnSphere::new(hook, [0.0; 3], Driven::text("1 + t").unwrap());
    builder.constraint("motor", drive);
    match ended(&builder, accurate(Integrator::Auto), 1.0) {
        StepError::RateNotSatisfied { row, drive, .. } => {
            assert_eq!((row.as_str(), drive.as_deref()), ("motor", Some("motor")));
        }
        other => panic!("{other}"),
    }
}

/// A driven radius about a point, or about a particle, that comes to nothing at t = 1 s is named by every method that
/// shortens its substeps.
#[test]
fn a_driven_radius_that_comes_to_nothing_is_named() {
    for ends in [vec!["bead"], vec!["bead", "hub"]] {
        let mut builder = System::builder(Dimension::Two);
        let bead = builder.particle(Particle::at("bead", [1.0, 0.0]));
        let hub = builder.particle(Particle::at("hub", [0.0, 0.0]).fixed());
        let radius = Driven::text("1 - t").unwrap();
        let sphere =
            if ends.len() == 1 { OnSphere::new(bead, [0.0; 3], radius) } else { OnSphere::new(bead, hub, radius) };
        builder.with_constraint("rail", sphere).force(gravity());
        for integrator in ADAPTIVE.into_iter().chain([Integrator::Radau5, Integrator::Implicit, Integrator::Bdf2]) {
            match ended(&builder, systems::settings(integrator, 0.01), 2.0) {
                StepError::NoGradient { time, constraint, ends: named } => {
                    assert_eq!(constraint, "rail", "{integrator}");
                    assert_eq!(named, ends, "{integrator}");
                    // The smallest length that counts as one is a millionth of the extent.
                    assert!((time - 1.0).abs() < 1e-5, "{integrator}: {time}");
                }
                other => panic!("{integrator}: {other}"),
            }
        }
    }
}

/// A string that winds itself round a post, whose atan2 jumps by 2π: every method that shortens its substeps says so.
#[test]
fn a_residual_that_jumps_is_named() {
    let mut builder = System::builder(Dimension::Two);
    builder.particle(Particle::at("puck", [0.1, 1.0]).with_velocity([-1.0, 0.0]));
    let string = "sqrt(puck.x^2 + puck.y^2 - 0.01) \
                  + 0.1*(atan2(puck.y, puck.x) - acos(0.1/sqrt(puck.x^2 + puck.y^2))) - 1";
    let string = builder.expression(Purpose::Constraint, string).unwrap();
    builder.constraint("string", ExpressionConstraint::new(string, &[0.1, 1.0]));
    for integrator in ADAPTIVE.into_iter().chain([Integrator::Radau5]) {
        match ended(&builder, accurate(integrator), 4.5) {
            StepError::Jumps { row, residual, .. } => {
                assert_eq!(row, "string", "{integrator}");
                // 2π R, as far as the sharpest step tried sees of it.
                assert!((residual.abs() - 0.2 * std::f64::consts::PI).abs() < 1e-9, "{integrator}: {residual}");
            }
            other => panic!("{integrator}: {other}"),
        }
    }
}

/// A contact that is open is not held, so its gap is not at fault where a force grows without bound.
#[test]
fn an_open_contact_is_not_at_fault() {
    let mut builder = System::builder(Dimension::Two);
    let ball = builder.particle(Particle::at("ball", [1.0, 0.0]));
    let force = ["ball.x^5", "0"].map(|text| builder.expression(Purpose::Force, text).unwrap());
    builder.force(qhat::ExpressionForce { particle: ball, components: force.to_vec() });
    let ground = qhat::Surface::HalfSpace { normal: [0.0, 1.0, 0.0], offset: -1.0 };
    builder.constraint("ground", qhat::Obstacle::new(ball, ground));
    for integrator in [Integrator::Auto, Integrator::Dop853, Integrator::Dopri5] {
        match ended(&builder, accurate(integrator), 10.0) {
            StepError::RanAway { particle, .. } | StepError::NotFinite { particle, .. } => assert_eq!(particle, "ball"),
            other => panic!("{integrator}: {other}"),
        }
    }
}
