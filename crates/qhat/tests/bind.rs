//! Parameters: a system that is bound moves with the bits of one that is built with the same numbers.

use qhat::{
    Actuator, AirDrag, Angle, Area, BindError, CentralForce, Constraint, CubicSpring, Dimension, Direction, Distance,
    Drag, Feedback, Force, Gravity, HarmonicForce, Integrator, InverseSquare, Lengths, Limits, Nail, Obstacle,
    OnCircle, OnEllipse, OnLine, OnPlane, OnSphere, Parameter, Particle, ParticleId, PointForce, Pressure, Quantity,
    Relation, Settings, Simulation, Spring, StepError, Surface, System, SystemBuilder, TorsionSpring, Volume,
    Workspace, project, step,
};

/// The particles p0 to p4, of which none is fixed, at places without a pattern.
fn particles(dimension: Dimension) -> (SystemBuilder, Vec<ParticleId>) {
    let places = [[0.0, 0.1, 0.3], [1.1, 0.2, -0.2], [0.9, 1.3, 0.1], [-0.2, 1.0, 0.4], [0.5, 0.4, 1.2]];
    let velocities = [[-0.3, -0.4, 0.2], [0.5, 0.7, -0.1], [-0.2, 0.6, 0.3], [0.1, -0.5, -0.4], [0.8, 0.2, -0.6]];
    let mut builder = System::builder(dimension);
    let particle = |builder: &mut SystemBuilder, k: usize| {
        let [x, v] = [places[k], velocities[k]].map(|vector| vector[..dimension.number()].to_vec());
        builder.particle(Particle::at(format!("p{k}"), x).with_velocity(v))
    };
    let ids = (0..places.len()).map(|k| particle(&mut builder, k)).collect();
    (builder, ids)
}

/// Ten frames of 10 ms, as bits of positions, velocities and multipliers.
fn motion(mut simulation: Simulation) -> Vec<u64> {
    let mut bits = Vec::new();
    for _ in 0..10 {
        if simulation.step().is_err() {
            break;
        }
        let state = simulation.state();
        bits.extend(state.positions().iter().chain(state.velocities()).map(|x| x.to_bits()));
        bits.extend(simulation.terms().multipliers.iter().map(|x| x.to_bits()));
    }
    bits
}

/// Binds the number of a part to `2*a`, built at 0.5·`from` and bound to 0.5·`to`, and compares it with a system built
/// with `to`. Returns whether the number has an effect on the motion.
fn bound_like_built(
    dimension: Dimension,
    add: &dyn Fn(&mut SystemBuilder, &[ParticleId], f64) -> Quantity,
    [from, to]: [f64; 2],
) -> bool {
    let (mut fresh, ids) = particles(dimension);
    let quantity = add(&mut fresh, &ids, to);
    let start = Simulation::new(fresh.build().unwrap().0, fresh.build().unwrap().1, Settings::default());

    let (mut builder, ids) = particles(dimension);
    add(&mut builder, &ids, from);
    builder.parameter(Parameter::new("unused", 3.0)).unwrap();
    builder.parameter(Parameter::new("a", 0.5 * from)).unwrap();
    builder.depends(quantity.clone(), "2*a").unwrap_or_else(|error| panic!("{quantity:?}: {error}"));
    let (mut system, state) = builder.build().unwrap();
    assert_eq!(system.start(), state, "{quantity:?}");
    system.bind(&[3.0, 0.5 * to]).unwrap_or_else(|error| panic!("{quantity:?}: {error}"));
    let bound = Simulation::new(system.clone(), system.start(), Settings::default());
    match (start, bound) {
        (Ok(start), Ok(bound)) => {
            let (expected, found) = (motion(start.clone()), motion(bound));
            assert!(!expected.is_empty(), "{quantity:?} does not move");
            assert_eq!(expected, found, "{quantity:?}");
            // The same in a simulation that has moved before.
            let mut simulation = Simulation::new(builder.build().unwrap().0, state, Settings::default()).unwrap();
            let has_effect = expected != motion(simulation.clone());
            let _ = simulation.advance(0.05);
            simulation.bind(&[3.0, 0.5 * to]).unwrap();
            assert_eq!(expected, motion(simulation), "{quantity:?}, after a motion");
            has_effect
        }
        (start, bound) => panic!("{quantity:?}: {:?}, {:?}", start.err(), bound.err()),
    }
}

fn constraint(key: &'static str, k: usize) -> impl Fn(&mut SystemBuilder, Constraint) -> Quantity {
    move |builder, constraint| Quantity::Constraint(builder.constraint("it", constraint), key.into(), k)
}

fn force(key: &'static str, k: usize) -> impl Fn(&mut SystemBuilder, Force) -> Quantity {
    move |builder, force| Quantity::Force(builder.force(force), key.into(), k)
}

type Make<'a> = &'a dyn Fn(&[ParticleId], f64) -> Constraint;
type Push<'a> = &'a dyn Fn(&[ParticleId], f64) -> Force;

#[test]
fn every_number_of_a_constraint_is_bound_with_the_bits_of_a_new_system() {
    let gravity = |builder: &mut SystemBuilder| {
        builder.force(Gravity::new([0.3, -9.81]));
    };
    let rope = |p: &[ParticleId], length: f64| Limits::rope(p[0], p[1], length);
    let in_plane: &[(&'static str, usize, [f64; 2], Make<'_>)] = &[
        ("length", 0, [1.1, 1.3], &|p, x| Distance::new(p[0], p[1], x).into()),
        ("stiffness", 0, [1.0, 2.0], &|p, x| Distance::new(p[0], p[1], 1.1).with_stiffness(x).into()),
        ("compliance", 0, [1e-3, 2e-3], &|p, x| Distance { compliance: x, ..Distance::new(p[0], p[1], 1.1) }.into()),
        ("damping", 0, [1.0, 2.0], &|p, x| {
            Distance { compliance: 1e-3, damping: x, ..Distance::new(p[0], p[1], 1.1) }.into()
        }),
        ("breaks_at", 0, [50.0, 0.1], &|p, x| Distance::new(p[0], p[1], 1.1).breaking_at(x).into()),
        ("at", 1, [0.1, 0.2], &|p, x| Nail::new(p[0], [0.0, x, 0.0]).into()),
        ("length", 0, [1.2, 1.11], &|p, x| rope(p, x).into()),
        ("longest", 0, [1.2, 1.11], &|p, x| rope(p, x).into()),
        ("shortest", 0, [0.5, 0.915], &|p, x| Limits::strut(p[0], p[3], x).into()),
        ("restitution", 0, [0.2, 0.6], &|p, x| rope(p, 1.11).with_restitution(x).into()),
        ("friction", 0, [0.2, 0.4], &|p, x| {
            Obstacle::new(p[0], Surface::half_space([0.2, 1.0], 0.09)).with_friction(x).into()
        }),
        ("radius", 0, [0.5, 0.52], &|p, x| Obstacle::new(p[0], Surface::ball([0.0, -0.5], x)).into()),
        ("at", 0, [1.2, 1.3], &|p, x| {
            Relation { terms: vec![(p[0], 1.0), (p[1], 1.0)], point: [x.into(), 0.3.into(), 0.0.into()] }.into()
        }),
        ("length", 0, [2.3, 2.4], &|p, x| Lengths::pulley(&p[..3], x).into()),
        ("angle", 0, [0.1, 0.2], &|p, x| Angle::from_direction([1.0, 0.0, 0.0], [p[0], p[1]], x).into()),
        ("area", 0, [1.2, 1.3], &|p, x| Area { corners: p[..4].to_vec(), area: x.into() }.into()),
        ("along", 1, [0.1, 0.2], &|p, x| Direction::new(p[0], p[1], [1.0, x, 0.0]).into()),
        ("at", 1, [0.1, 0.2], &|p, x| OnLine::fixed(p[0], [0.0, x, 0.0], [1.0, 0.5, 0.0]).into()),
        ("along", 1, [0.4, 0.6], &|p, x| OnLine::fixed(p[0], [0.0, 0.1, 0.0], [1.0, x, 0.0]).into()),
        ("radius", 0, [1.0, 1.1], &|p, x| OnSphere::new(p[0], [1.0, 0.2, 0.0], x).into()),
        ("center", 0, [1.0, 1.1], &|p, x| OnSphere::new(p[0], [x, 0.2, 0.0], 1.0).into()),
        ("half_along", 0, [1.0, 1.1], &|p, x| OnEllipse::new(p[0], [1.0, 0.1, 0.0], [1.0, 0.0, 0.0], [x, 0.5]).into()),
    ];
    let mut without_effect = Vec::new();
    for &(key, k, numbers, make) in in_plane {
        let add = |builder: &mut SystemBuilder, ids: &[ParticleId], x: f64| {
            gravity(builder);
            if key == "stiffness" {
                // It only tells how redundant rods share a force.
                builder.constraint("twin", Distance::new(ids[0], ids[1], 1.1));
            }
            constraint(key, k)(builder, make(ids, x))
        };
        if !bound_like_built(Dimension::Two, &add, numbers) {
            without_effect.push((key, numbers));
        }
    }
    let in_space: &[(&'static str, usize, [f64; 2], Make<'_>)] = &[
        ("at", 2, [0.3, 0.4], &|p, x| OnPlane::fixed(p[0], [0.0, 0.0, x], [0.1, 0.2, 1.0]).into()),
        ("normal", 0, [0.1, 0.2], &|p, x| OnPlane::fixed(p[0], [0.0, 0.0, 0.3], [x, 0.2, 1.0]).into()),
        ("axis", 0, [0.1, 0.2], &|p, x| OnCircle::new(p[0], [1.0, 0.0, 0.3], [x, 0.2, 1.0], 1.0).into()),
        ("volume", 0, [0.2, 0.25], &|p, x| {
            let [a, b, c, d] = [p[0], p[1], p[2], p[4]];
            Volume::new(&[[a, c, b], [a, b, d], [b, c, d], [c, a, d]], x).into()
        }),
    ];
    for &(key, k, numbers, make) in in_space {
        let add = |builder: &mut SystemBuilder, ids: &[ParticleId], x: f64| {
            gravity(builder);
            constraint(key, k)(builder, make(ids, x))
        };
        if !bound_like_built(Dimension::Three, &add, numbers) {
            without_effect.push((key, numbers));
        }
    }
    assert!(without_effect.is_empty(), "{without_effect:?}");
}

#[test]
fn every_number_of_a_force_is_bound_with_the_bits_of_a_new_system() {
    let forces: &[(&'static str, usize, [f64; 2], Push<'_>)] = &[
        ("acceleration", 1, [-9.81, -1.62], &|_, x| Gravity::new([0.0, x]).into()),
        ("coefficient", 0, [0.1, 0.3], &|_, x| Drag { coefficient: x }.into()),
        ("stiffness", 0, [10.0, 30.0], &|p, x| {
            Spring { a: p[0], b: p[1], stiffness: x, damping: 0.1, rest: 1.0 }.into()
        }),
        ("damping", 0, [0.1, 0.3], &|p, x| Spring { a: p[0], b: p[1], stiffness: 9.0, damping: x, rest: 1.0 }.into()),
        ("rest", 0, [1.0, 0.0], &|p, x| Spring { a: p[0], b: p[1], stiffness: 9.0, damping: 0.1, rest: x }.into()),
        ("force", 0, [1.0, 2.0], &|p, x| PointForce::new(p[0], [x, 1.0]).into()),
        ("force", 1, [1.0, 2.0], &|p, x| {
            let (amplitude, angular_frequency) = ([0.5, x, 0.0], 3.0);
            HarmonicForce { particle: p[0], amplitude, angular_frequency, phase: 0.1 }.into()
        }),
        ("push", 0, [1.0, 2.0], &|p, x| {
            Actuator { a: p[0], b: p[1], push: x, amplitude: 0.5, angular_frequency: 3.0, phase: 0.1 }.into()
        }),
        ("cubic", 0, [1.0, 2.0], &|p, x| {
            CubicSpring { a: p[0], b: p[1], stiffness: 3.0, cubic: x, damping: 0.1, rest: 0.9 }.into()
        }),
        ("angle", 0, [1.0, 2.0], &|p, x| {
            TorsionSpring { a: p[0], b: p[1], c: p[2], stiffness: 3.0, damping: 0.1, angle: x }.into()
        }),
        ("center", 0, [2.0, 3.0], &|p, x| {
            CentralForce { particle: p[0], center: [x, 1.0, 0.0], strength: -2.0, softening: 0.1 }.into()
        }),
        ("softening", 0, [0.1, 0.2], &|p, x| InverseSquare { a: p[0], b: p[1], strength: -2.0, softening: x }.into()),
        ("wind", 1, [2.0, 3.0], &|p, x| AirDrag { wind: [1.0, x, 0.0], ..AirDrag::still(p[0], 0.1, 0.2) }.into()),
        ("pressure", 0, [2.0, 3.0], &|p, x| Pressure::in_loop(&p[..2], x).next().unwrap().into()),
    ];
    let mut without_effect = Vec::new();
    for &(key, k, numbers, make) in forces {
        let add = |builder: &mut SystemBuilder, ids: &[ParticleId], x: f64| {
            builder.constraint("rod", Distance::new(ids[1], ids[2], 1.2));
            builder.force(PointForce::new(ids[1], [0.4, 0.7]));
            force(key, k)(builder, make(ids, x))
        };
        if !bound_like_built(Dimension::Two, &add, numbers) {
            without_effect.push((key, numbers));
        }
    }
    assert!(without_effect.is_empty(), "{without_effect:?}");
}

#[test]
fn masses_starts_and_feedback_are_bound_with_the_bits_of_a_new_system() {
    let chain = |builder: &mut SystemBuilder, ids: &[ParticleId]| {
        builder.constraint("nail", Nail::new(ids[0], [0.0, 0.1, 0.0]));
        for (k, length) in [(0, 1.1), (1, 1.2), (2, 1.2)] {
            builder.constraint(format!("rod{k}"), Distance::new(ids[k], ids[k + 1], length));
        }
        builder.force(Gravity::new([0.0, -9.81]));
    };
    let mass_has_effect = bound_like_built(
        Dimension::Two,
        &|builder, ids, mass| {
            chain(builder, ids);
            let quantity = Quantity::Mass(ids[3]);
            *builder.number(&quantity).unwrap() = mass;
            quantity
        },
        [1.0, 7.0],
    );
    assert!(mass_has_effect);
    for quantity in [|id| Quantity::Position(id, 0), |id| Quantity::Velocity(id, 1)] {
        let has_effect = bound_like_built(
            Dimension::Two,
            &|builder, ids, x| {
                chain(builder, ids);
                *builder.number(&quantity(ids[3])).unwrap() = x;
                quantity(ids[3])
            },
            [-0.2, -0.3],
        );
        assert!(has_effect);
    }
    let (mut builder, ids) = particles(Dimension::Two);
    chain(&mut builder, &ids);
    builder.feedback(Feedback { ks: 5.0, kd: 1.0, ..Feedback::NONE });
    builder.parameter(Parameter::new("k", 5.0)).unwrap();
    builder.depends(Quantity::Feedback("ks".into()), "2*k").unwrap();
    let (mut system, _) = builder.build().unwrap();
    assert_eq!(system.feedback().ks, 10.0);
    system.bind(&[7.0]).unwrap();
    assert_eq!(system.feedback().ks, 14.0);
}

/// Arrays that steps have written before a bind do not keep the numbers before.
#[test]
fn a_workspace_follows_a_bound_system() {
    for integrator in Integrator::ALL {
        let settings = Settings { integrator, h: 1e-3, ..Settings::default() };
        let mut builder = System::builder(Dimension::Two);
        let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
        let [elbow, bob] = [1.0, 2.0].map(|x| builder.particle(Particle::at(format!("at {x}"), [x, 0.0])));
        builder.constraint("upper", Distance::new(pivot, elbow, 1.0));
        builder.constraint("lower", Distance::new(elbow, bob, 1.0));
        builder.force(Gravity::new([0.0, -9.81]));
        builder.parameter(Parameter::new("m", 1.0)).unwrap();
        builder.depends(Quantity::Mass(bob), "m").unwrap();
        let (mut system, mut state) = builder.build().unwrap();
        let mut used = Workspace::new(&system);
        step(&system, &mut state, &settings, &mut used).unwrap();
        system.bind(&[7.0]).unwrap();
        let mut fresh = Workspace::new(&system);
        let [one, other] = [&mut used, &mut fresh].map(|workspace| {
            let mut state = system.start();
            project(&system, &mut state, &settings, workspace).unwrap();
            step(&system, &mut state, &settings, workspace).unwrap();
            state
        });
        assert_eq!(one, other, "{integrator}");
    }
}

/// A pendulum whose length, mass and stiffness of a soft rod are parameters.
fn pendulum() -> SystemBuilder {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.0, -1.0]));
    let rod = builder.constraint("rod", Distance::new(pivot, bob, 1.0));
    builder.constraint("ground", Obstacle::new(bob, Surface::half_space([0.0, 1.0], -9.0)));
    builder.parameter(Parameter::new("L", 1.0).within(-1.0, 4.0)).unwrap();
    builder.parameter(Parameter::new("m", 1.0)).unwrap();
    builder.parameter(Parameter::new("c", 0.0)).unwrap();
    builder.parameter(Parameter::new("mu", 0.0)).unwrap();
    builder.depends(Quantity::Constraint(rod, "length".into(), 0), "L").unwrap();
    builder.depends(Quantity::Constraint(rod, "compliance".into(), 0), "c").unwrap();
    builder.depends(Quantity::Mass(bob), "m").unwrap();
    let ground = builder.build().unwrap().0.constraint("ground").unwrap();
    builder.depends(Quantity::Constraint(ground, "friction".into(), 0), "mu").unwrap();
    builder
}

#[test]
fn what_cannot_be_bound_is_refused_in_words_and_changes_nothing() {
    let (mut system, _) = pendulum().build().unwrap();
    let before = format!("{system:?}");
    let cases: [(&[f64], &str); 10] = [
        (&[1.0], "1 value for 4 parameters: give one value for each parameter"),
        (&[f64::NAN, 1.0, 0.0, 0.0], "the parameter `L` must be a finite number, but is NaN"),
        (&[5.0, 1.0, 0.0, 0.0], "the parameter `L` must be at least -1 and at most 4, but is 5"),
        (&[-1.0, 1.0, 0.0, 0.0], "`length of rod` would be -1: the length of a distance constraint must be positive"),
        (&[2.0, 0.0, 0.0, 0.0], "`mass of bob` would be 0: the mass must be positive and finite, but is 0.0 kg"),
        (&[2.0, 1.0, 1e-3, 0.0], "`compliance of rod` cannot be changed in a system that is built"),
        (&[2.0, 1.0, 0.0, 0.5], "`friction of ground` cannot be changed in a system that is built"),
        // Of several numbers of a part the one that the part refuses is named.
        (&[2.0, 1.0, -1.0, 0.0], "`compliance of rod` would be -1: "),
        (&[2.0, 1.0, 0.0, -0.5], "`friction of ground` would be -0.5: "),
        (&[2.0, 1e-320, 0.0, 0.0], "`mass of bob` would be"),
    ];
    for (values, words) in cases {
        let error = system.bind(values).unwrap_err().to_string();
        assert!(error.starts_with(words), "{error}");
        assert_eq!(before, format!("{system:?}"), "{error}");
    }
    let mut simulation = Simulation::new(system.clone(), system.start(), Settings::default()).unwrap();
    simulation.advance(0.1).unwrap();
    let state = simulation.state().clone();
    assert!(matches!(simulation.bind(&[-1.0, 1.0, 0.0, 0.0]), Err(StepError::Parameters(BindError::Refused { .. }))));
    assert_eq!(&state, simulation.state());
}

#[test]
fn a_declaration_that_has_no_meaning_is_refused_in_words() {
    let mut builder = pendulum();
    let rod = builder.build().unwrap().0.constraint("rod").unwrap();
    let refused = |error: BindError| error.to_string();
    let error = builder.parameter(Parameter::new("L", 1.0)).map_err(refused).unwrap_err();
    assert_eq!(error, "`L` already has a meaning in expressions: give the parameter another name");
    let error = builder.parameter(Parameter::new("x", 2.0).within(0.0, 1.0)).map_err(refused).unwrap_err();
    assert_eq!(error, "the parameter `x` must be at least 0 and at most 1, but is 2");
    let error = builder.depends(Quantity::Constraint(rod, "lenght".into(), 0), "L").map(drop).map_err(refused);
    assert_eq!(error.unwrap_err(), "`lenght of rod` is no number that a parameter can give");
    for (text, words) in [
        ("2*q", "`2*q`: there is no name `q`"),
        ("t", "`t`: `t` is time, and this number is the same at all times"),
        ("L.x", "`L.x`: `L` is a parameter, a number: it has no `.x`"),
        ("1/0", "`1/0`: this is never a finite number"),
    ] {
        let error = builder.depends(Quantity::Constraint(rod, "length".into(), 0), text).map(drop).map_err(refused);
        assert_eq!(error.unwrap_err(), words);
    }
}
