//! Refusals: numbers out of range, names that do not exist, motions that cannot be continued. Every refusal is a typed
//! error whose text names the cause, and the last good state is kept.

use crate::systems;
use qhat::{
    BodyError, BuildError, ConstraintError, Curve, Dimension, Distance, Drag, ExpressionError, Feedback, ForceError,
    GeometryError, Gravity, Integrator, MouseSpring, Nail, ParameterError, Particle, ParticleError, ParticleId,
    PointForce, Settings, SettingsError, Simulation, Spring, StepError, System, SystemBuilder, ValueError, Workspace,
    step,
};

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

/// Two particles, and one error.
fn message(change: impl FnOnce(&mut SystemBuilder, ParticleId, ParticleId)) -> String {
    let mut builder = System::builder(Dimension::Two);
    let a = builder.particle(Particle::at("a", [0.0, 0.0]));
    let b = builder.particle(Particle::at("b", [1.0, 0.0]));
    change(&mut builder, a, b);
    builder.build().map(|_| ()).unwrap_err().to_string()
}

#[test]
fn particles_that_cannot_be() {
    let refuse = |particle: Particle| message(|builder, _, _| _ = builder.particle(particle));
    assert_eq!(refuse(Particle::at("a", [2.0, 0.0])), "particle `a`: the name is used twice");
    let space = Particle::at("c", [2.0, 0.0, 1.0]);
    assert_eq!(refuse(space), "particle `c`: the position must have 2 components, but has 3");
    let line = Particle::at("c", [2.0, 0.0]).with_velocity([1.0]);
    assert_eq!(refuse(line), "particle `c`: the velocity must have 2 components, but has 1");
    let finite = "particle `c`: position and velocity must be finite numbers";
    assert_eq!(refuse(Particle::at("c", [f64::NAN, 0.0])), finite);
    assert_eq!(refuse(Particle::at("c", [0.0, 0.0]).with_velocity([0.0, f64::INFINITY])), finite);
    for (mass, shown) in [(0.0, "0.0"), (-1.0, "-1.0"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let expected = format!("particle `c`: the mass must be positive and finite, but is {shown} kg");
        assert_eq!(refuse(Particle::at("c", [2.0, 0.0]).with_mass(mass)), expected);
    }
    assert!(refuse(Particle::at("c", [2.0, 0.0]).with_mass(1e-320)).contains("mass"), "1/m is not finite");
    let moving = Particle::at("c", [2.0, 0.0]).with_velocity([1.0, 0.0]).fixed();
    assert_eq!(refuse(moving), "particle `c`: a fixed particle cannot have a velocity");
}

#[test]
fn constraints_that_cannot_be() {
    for (length, shown) in [(0.0, "0"), (-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let got = message(|builder, a, b| _ = builder.constraint("rod", Distance::new(a, b, length)));
        let expected = "constraint `rod`: the length of a distance constraint must be positive and finite, but is ";
        assert_eq!(got, format!("{expected}{shown}"));
    }
    let got = message(|builder, a, _| _ = builder.constraint("rod", Distance::new(a, a, 1.0)));
    assert_eq!(got, "constraint `rod`: a distance constraint needs two different particles");
    let got = message(|builder, a, _| _ = builder.constraint("rod", Distance::new(a, systems::id(7), 1.0)));
    assert_eq!(got, "constraint `rod`: there is no particle number 7");
    let got = message(|builder, a, _| _ = builder.constraint("nail", Nail::new(a, [f64::NAN, 0.0, 0.0])));
    assert_eq!(got, "constraint `nail`: the point of a nail must be a finite number, not NaN");
    let got = message(|builder, a, b| {
        builder.with_constraint("rod", Distance::new(a, b, 1.0)).constraint("rod", Distance::new(b, a, 2.0));
    });
    assert_eq!(got, "constraint `rod`: the name is used twice");
}

/// The reason is a value that code can tell apart, and the source of the error.
#[test]
fn a_refusal_has_a_typed_reason() {
    let mut builder = System::builder(Dimension::Two);
    let a = builder.particle(Particle::at("a", [0.0, 0.0]));
    builder.constraint("rod", Distance::new(a, a, 1.0));
    let refused = builder.build().unwrap_err();
    let Some(reason) = std::error::Error::source(&refused) else { panic!("{refused:?} has no source") };
    let reason = reason.downcast_ref::<ConstraintError>();
    assert_eq!(reason, Some(&ConstraintError::SameEnds { what: "a distance constraint" }));
    let refused = Curve::polyline(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], 0.1, false).unwrap_err();
    assert_eq!(refused, GeometryError::WireNeighbours { points: [1, 2] });
}

fn is_error<E: std::error::Error + Send + Sync + 'static>() {}

#[test]
fn every_error_goes_through_a_question_mark_into_any_other() {
    is_error::<BuildError>();
    is_error::<ParticleError>();
    is_error::<ConstraintError>();
    is_error::<ForceError>();
    is_error::<GeometryError>();
    is_error::<ValueError>();
    is_error::<ExpressionError>();
    is_error::<ParameterError>();
    is_error::<BodyError>();
    is_error::<SettingsError>();
    is_error::<StepError>();
}

#[test]
fn the_hand_says_what_it_cannot_do() {
    let (system, state) = systems::pendulum(1.0);
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    let find = |name| simulation.system().particle(name).unwrap();
    let (pivot, bob) = (find("pivot"), find("bob"));
    assert_eq!(simulation.grab(pivot, [0.0; 2]), Err(ForceError::Fixed { particle: "pivot".into() }));
    assert_eq!(simulation.drag_to([0.0; 2]), Err(ForceError::NothingGrabbed));
    assert_eq!(simulation.grab(systems::id(7), [0.0; 2]), Err(ForceError::NoParticle { particle: 7 }));
    let what = "the target of the mouse spring";
    let infinite = ForceError::Value(ValueError::NotFinite { what, value: f64::INFINITY });
    assert_eq!(simulation.grab(bob, [f64::INFINITY, 0.0]), Err(infinite));
    assert_eq!(simulation.mouse(), None);
    assert_eq!(simulation.grab(bob, [1.0, 2.0]), Ok(()));
    assert_eq!(simulation.drag_to([3.0, 4.0, 0.0]), Ok(()));
    assert_eq!(simulation.mouse().map(|mouse| (mouse.particle, mouse.target)), Some((bob, [3.0, 4.0, 0.0])));
    simulation.release();
    assert_eq!(simulation.mouse(), None);
}

#[test]
fn forces_that_cannot_be() {
    let refuse = |force: qhat::Force| {
        message(|builder, _, _| drop(builder.with_force(Drag { coefficient: 1.0 }).with_force(force).clone()))
    };
    let (a, b) = (systems::id(0), systems::id(1));
    let spring = Spring { a, b, stiffness: 1.0, damping: 1.0, rest: 1.0 };
    let mouse = MouseSpring { particle: a, target: [0.0; 3], stiffness: 1.0, damping: 1.0 };
    let cases: [(qhat::Force, &str); 11] = [
        (Gravity { acceleration: [0.0, f64::NAN, 0.0] }.into(), "gravity must be a finite number, not NaN"),
        (Drag { coefficient: -1.0 }.into(), "the drag coefficient must not be negative, but is -1"),
        (
            Spring { stiffness: -2.0, ..spring.clone() }.into(),
            "the stiffness of a spring must not be negative, but is -2",
        ),
        (Spring { damping: -2.0, ..spring.clone() }.into(), "the damping of a spring must not be negative, but is -2"),
        (Spring { rest: -2.0, ..spring.clone() }.into(), "the rest length of a spring must not be negative, but is -2"),
        (Spring { b: a, ..spring.clone() }.into(), "a spring needs two different particles"),
        (Spring { b: systems::id(9), ..spring }.into(), "there is no particle number 9"),
        (
            PointForce { particle: a, force: [f64::INFINITY; 3] }.into(),
            "a point force must be a finite number, not inf",
        ),
        (
            MouseSpring { stiffness: -1.0, ..mouse.clone() }.into(),
            "the stiffness of the mouse spring must not be negative, but is -1",
        ),
        (
            MouseSpring { damping: -1.0, ..mouse.clone() }.into(),
            "the damping of the mouse spring must not be negative, but is -1",
        ),
        (
            MouseSpring { target: [f64::NAN; 3], ..mouse }.into(),
            "the target of the mouse spring must be a finite number, not NaN",
        ),
    ];
    for (force, expected) in cases {
        assert_eq!(refuse(force), format!("force number 1: {expected}"));
    }
    let wind = || PointForce::new(a, [1.0, 0.0]);
    let got = message(|builder, _, _| _ = [builder.named_force("wind", wind()), builder.named_force("wind", wind())]);
    assert_eq!(got, "force `wind`: the name is used twice");
}

#[test]
fn settings_out_of_range() {
    let good = Settings::default();
    assert_eq!(good.check(), Ok(()));
    let nan = f64::NAN;
    let mut cases: Vec<(&str, Settings)> = Vec::new();
    cases.extend([0.0, -0.1, nan, f64::INFINITY].map(|h| ("h", Settings { h, ..good })));
    cases.extend([0.0, 1.0, -1.0, nan].map(|tolerance| ("tolerance", Settings { tolerance, ..good })));
    let constraint = |constraint_tolerance| ("constraint_tolerance", Settings { constraint_tolerance, ..good });
    cases.extend([0.0, 9e-15, 0.011, nan].map(constraint));
    cases.push(("max_substeps", Settings { max_substeps: 0, ..good }));
    cases.push(("frame_budget", Settings { frame_budget: 0, ..good }));
    cases.push(("frame_work", Settings { frame_work: 0, ..good }));
    for (expected, settings) in cases {
        let (system, mut state) = systems::pendulum(1.0);
        let Err(SettingsError::OutOfRange { name, .. }) = settings.check() else { panic!("{expected}") };
        assert_eq!(name, expected);
        let error = StepError::Settings(settings.check().unwrap_err());
        assert_eq!(
            Simulation::new(system.clone(), state.clone(), settings).unwrap_err().to_string(),
            error.to_string()
        );
        // A step refuses them as well, and does not change the state.
        let before = state.clone();
        let refused = step(&system, &mut state, &settings, &mut Workspace::new(&system)).unwrap_err();
        assert_eq!(refused.to_string(), error.to_string());
        assert_eq!(state, before);
    }
    let zero_step = Settings { h: 0.0, ..good }.check().unwrap_err().to_string();
    assert_eq!(zero_step, "h must be finite and positive, but is 0");
}

#[test]
fn feedback_out_of_range() {
    let cases = [
        ("ks", Feedback { ks: -1.0, ..Feedback::NONE }),
        ("kd", Feedback { kd: f64::NAN, ..Feedback::NONE }),
        ("diagonal_drag", Feedback { diagonal_drag: -1e-9, ..Feedback::NONE }),
        ("elasticity", Feedback { elasticity: 1.0, ..Feedback::NONE }),
        ("elasticity", Feedback { elasticity: -0.1, ..Feedback::NONE }),
    ];
    for (expected, feedback) in cases {
        let Err(SettingsError::OutOfRange { name, .. }) = feedback.check() else { panic!("{expected}") };
        assert_eq!(name, expected);
        let mut builder = System::builder(Dimension::Two);
        builder.feedback(feedback);
        let refused = builder.build().map(|_| ()).unwrap_err();
        assert!(matches!(refused, BuildError::Settings(SettingsError::OutOfRange { name, .. }) if name == expected));
        let (system, state) = systems::pendulum(1.0);
        let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
        assert!(simulation.set_feedback(feedback).is_err());
        assert_eq!(simulation.system().feedback(), &Feedback::NONE, "nothing is changed");
    }
}

#[test]
fn integrators_and_frames() {
    for integrator in Integrator::ALL {
        assert_eq!(integrator.name().parse(), Ok(integrator));
        assert_eq!(integrator.to_string(), integrator.name());
    }
    let unknown = "leapfrog".parse::<Integrator>().unwrap_err();
    assert_eq!(unknown, SettingsError::UnknownIntegrator { name: "leapfrog".into() });

    let (system, state) = systems::pendulum(1.0);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rk4, 0.003)).unwrap();
    let refused = simulation.advance(0.01).unwrap_err();
    assert_eq!(refused, StepError::Settings(SettingsError::FrameNotMultiple { frame: 0.01, h: 0.003 }));
    assert_eq!(simulation.advance(0.012).unwrap().substeps, 4);
}

#[test]
fn a_start_that_is_not_finite() {
    for bad in [f64::NAN, f64::INFINITY] {
        for integrator in Integrator::ALL {
            let (system, start) = systems::pendulum(1.0);
            for state in [
                start.with_motion(vec![0.0, 0.0, bad, 0.0], vec![0.0; 4]),
                start.with_motion(start.positions().to_vec(), vec![0.0, 0.0, 0.0, bad]),
            ] {
                let settings = systems::settings(integrator, 0.01);
                let refused = Simulation::new(system.clone(), state.clone(), settings).and_then(|mut s| s.step());
                assert!(refused.is_err(), "{integrator} went on from {state:?}");
                let mut stepped = state.clone();
                let refused = step(&system, &mut stepped, &settings, &mut Workspace::new(&system));
                assert!(refused.is_err(), "{integrator} stepped from {state:?}");
                assert_eq!(bits(stepped.positions()), bits(state.positions()));
                assert_eq!(bits(stepped.velocities()), bits(state.velocities()));
            }
        }
    }
}

/// The source's explicit Euler with steps far too large: in the end a typed error, and the state is the last good one.
#[test]
fn a_diverging_run_stops_at_the_last_good_state() {
    let (system, state) = systems::chain(20, 1000.0);
    for integrator in [Integrator::Euler, Integrator::SymplecticEuler, Integrator::Rk4] {
        let settings = systems::settings(integrator, 1.0 / 60.0);
        let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
        let (last, error) = loop {
            let before = simulation.state().clone();
            match simulation.step() {
                Ok(_) => assert!(before.time() < 60.0, "{integrator} must diverge at this step"),
                Err(error) => break (before, error),
            }
        };
        let time = last.time();
        match &error {
            StepError::NotFinite { time: at, particle } => assert!(*at == time && particle.starts_with('p')),
            StepError::Diverged { time: at, row, relative } => {
                assert!(*at == time && system.row_names().contains(row) && *relative > 1e3);
            }
            other => panic!("{integrator}: {other:?}"),
        }
        assert!(error.to_string().contains("the step h is too large"), "{error}");
        assert_eq!(&last, simulation.state());
        assert_eq!(bits(last.positions()), bits(simulation.state().positions()));
        assert_eq!(bits(last.velocities()), bits(simulation.state().velocities()));
        // The next step gives the same error.
        assert_eq!(simulation.step().unwrap_err(), error);
        assert_eq!(&last, simulation.state());
    }
}

#[test]
fn more_substeps_than_allowed() {
    let (system, state) = systems::double_pendulum();
    let settings = Settings { integrator: Integrator::Rattle, h: 1.0, max_substeps: 7, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let error = simulation.step().unwrap_err();
    let time = simulation.state().time();
    assert_eq!(error, StepError::TooManySubsteps { time, max_substeps: 7 });
    assert!(time > 0.0 && time < 1.0, "the state is that after the last substep");
    assert!(simulation.state().positions().iter().all(|x| x.is_finite()));
    // The run may go on from this state.
    simulation.set_settings(Settings { h: 0.01, ..Settings::default() }).unwrap();
    assert!(simulation.step().unwrap().max_relative_length_error < 1e-10);
}
