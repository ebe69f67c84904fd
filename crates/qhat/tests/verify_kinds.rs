//! Motion under every kind of constraint: C held, the energy accounted for, and closed forms where there are some.

mod systems;

use qhat::{
    Anchor, Constraint, Curve, Dimension, Direction, Distance, Driven, Expression, GeometryError, Integrator, OnCircle,
    OnCurve, OnLine, OnPlane, OnSphere, Particle, ParticleId, Purpose, Relation, Scope, Settings, Simulation, State,
    System,
};
use std::f64::consts::PI;
use systems::G;
use systems::dense::{assert_close, largest};

fn expression(text: &str, purpose: Purpose, dimension: Dimension) -> Expression {
    Expression::parse(text, &Scope::new(purpose, dimension, &|_| None)).unwrap()
}

fn schedule(text: &str) -> Driven {
    expression(text, Purpose::Time, Dimension::Two).into()
}

/// A point that moves in the plane.
fn driven(x: &str, y: &str) -> [Driven; 3] {
    [schedule(x), schedule(y), Driven::Constant(0.0)]
}

fn curve(components: &[&str], from: f64, to: f64) -> Curve {
    let dimension = if components.len() == 2 { Dimension::Two } else { Dimension::Three };
    let components = components.iter().map(|text| expression(text, Purpose::Curve, dimension)).collect();
    Curve::parametric(components, from, to).unwrap()
}

/// Particles of 1 kg and 2 kg by turns under gravity along −y, and what holds them.
fn system(places: &[&[f64]], constraints: impl FnOnce(&[ParticleId]) -> Vec<Constraint>) -> (System, State) {
    let dimension = if places[0].len() == 2 { Dimension::Two } else { Dimension::Three };
    let mut builder = System::builder(dimension);
    let place = |(i, at): (usize, &&[f64])| Particle::at(format!("p{i}"), at.to_vec()).with_mass(1.0 + (i % 2) as f64);
    let ids: Vec<_> = places.iter().enumerate().map(place).map(|particle| builder.particle(particle)).collect();
    for (i, constraint) in constraints(&ids).into_iter().enumerate() {
        builder.constraint(format!("c{i}"), constraint);
    }
    builder.force(systems::gravity());
    builder.build().unwrap()
}

/// One system for each kind, in the plane and in space, driven where it can be.
fn all() -> Vec<(&'static str, (System, State))> {
    let point = || driven("0.1*sin(3*t)", "0.2*cos(2*t)");
    vec![
        (
            "center of mass",
            system(&[&[0.0, 0.0], &[1.0, 0.3], &[0.4, 1.0]], |p| {
                vec![Relation::center_of_mass([(p[0], 1.0), (p[1], 2.0), (p[2], 1.0)], point()).into()]
            }),
        ),
        (
            "driven pivot",
            system(&[&[0.0, 0.2], &[1.0, 0.2]], |p| {
                vec![Relation::driven(p[0], point()).into(), OnSphere::new(p[1], p[0], 1.0).into()]
            }),
        ),
        (
            "driven rod",
            system(&[&[1.0, 0.0]], |p| vec![OnSphere::new(p[0], [0.0; 3], schedule("1 + 0.1*sin(3*t)")).into()]),
        ),
        (
            "slider",
            system(&[&[0.0, 0.0], &[0.6, 0.8][..]], |p| {
                vec![
                    OnSphere::new(p[0], [0.0, 1.0, 0.0], 1.0).into(),
                    Direction { a: p[0], b: p[1], along: driven("3 + sin(t)", "4") }.into(),
                ]
            }),
        ),
        (
            "slider in space",
            system(&[&[0.0, 0.0, 0.0], &[0.3, 0.6, 0.6]], |p| {
                vec![
                    OnSphere::new(p[0], [0.0, 1.0, 0.0], 1.0).into(),
                    Direction::new(p[0], p[1], [1.0, 2.0, 2.0]).into(),
                ]
            }),
        ),
        (
            "trammel",
            system(&[&[0.6, 0.0], &[0.0, 0.8], &[1.2, -0.8]], |p| {
                vec![
                    OnLine::fixed(p[0], [0.0; 3], [1.0, 0.0, 0.0]).into(),
                    OnLine::fixed(p[1], [0.0; 3], [0.0, 1.0, 0.0]).into(),
                    OnSphere::new(p[0], p[1], 1.0).into(),
                    OnLine::through(p[2], p[0], p[1]).into(),
                    OnSphere::new(p[2], p[0], 1.0).into(),
                ]
            }),
        ),
        (
            "bead on a rod in space",
            system(&[&[0.0, 0.0, 0.0], &[1.0, 0.5, 0.2], &[0.5, 0.25, 0.1]], |p| {
                vec![
                    OnSphere::new(p[0], [0.0, 1.0, 0.0], 1.0).into(),
                    OnSphere::new(p[1], [1.0, 1.0, 1.0], libm::sqrt(0.25 + 0.64)).into(),
                    OnLine::through(p[2], p[0], p[1]).into(),
                ]
            }),
        ),
        (
            "plane of particles",
            system(&[&[0.0, 0.0, 0.0], &[1.0, 0.0, 0.0], &[0.0, 0.0, 1.0], &[0.4, 0.0, 0.4]], |p| {
                let hang = |p: ParticleId, x: f64, z: f64| Constraint::from(OnSphere::new(p, [x, 1.0, z], 1.0));
                let mut held = vec![hang(p[0], 0.0, 0.0), hang(p[1], 1.0, 0.0), hang(p[2], 0.0, 1.0)];
                held.push(OnPlane::through(p[3], [p[0], p[1], p[2]]).into());
                held.push(OnSphere::new(p[3], [0.4, 1.4, 0.4], 1.4).into());
                held
            }),
        ),
        (
            "inclined plane",
            system(&[&[0.0, 0.0, 0.0]], |p| vec![OnPlane::fixed(p[0], [0.0; 3], [1.0, 2.0, 0.5]).into()]),
        ),
        (
            "circle in space",
            system(&[&[1.0, 0.0, 0.0]], |p| {
                vec![OnCircle::new(p[0], [0.0; 3], [0.0, 0.6, 0.8], schedule("1 + 0.05*sin(4*t)")).into()]
            }),
        ),
        (
            "bead on a parabola",
            system(&[&[1.0, 0.5]], |p| {
                vec![OnCurve { particle: p[0], curve: curve(&["s", "s^2/2"], -3.0, 3.0) }.into()]
            }),
        ),
        (
            "bead on a helix",
            system(&[&[1.0, 0.0, 0.0]], |p| {
                vec![OnCurve { particle: p[0], curve: curve(&["cos(s)", "-s/5", "sin(s)"], -5.0, 20.0) }.into()]
            }),
        ),
        (
            "bead on a spline",
            system(&[&[0.0, 0.0]], |p| {
                let points = [[0.0, 0.0, 0.0], [1.0, -1.0, 0.0], [2.0, -0.5, 0.0], [2.5, 0.5, 0.0]];
                vec![OnCurve { particle: p[0], curve: Curve::through(&points, false).unwrap() }.into()]
            }),
        ),
        (
            "bead on a bent wire",
            system(&[&[0.0, 0.0, 0.0]], |p| {
                let points = [[0.0, 0.0, 0.0], [0.4, -1.0, 0.0], [1.5, -1.0, 0.5], [2.5, 0.5, 0.0]];
                vec![OnCurve { particle: p[0], curve: Curve::polyline(&points, 0.3, false).unwrap() }.into()]
            }),
        ),
    ]
}

/// C within the tolerance asked for, relative to its scale, and the balance of energy to what the order leaves, over a second.
#[test]
fn every_kind_holds_and_accounts_for_its_energy() {
    // Of the largest kinetic energy: dop853 keeps 1e-9 a substep, and the spline, whose third derivative jumps, a little less. RATTLE and
    // BDF2 are of second order: (ω h)² with ω of 5/s and h = 1 ms or ½ ms is 3e-5 and less.
    for (integrator, h, energy) in
        [(Integrator::Auto, 0.01, 1e-6), (Integrator::Rattle, 1e-3, 1e-3), (Integrator::Bdf2, 5e-4, 1e-3)]
    {
        for (name, (system, state)) in all() {
            let scales = system.row_scales().to_vec();
            let settings = Settings { tolerance: 1e-9, ..systems::settings(integrator, h) };
            let mut simulation = Simulation::new(system, state, settings).unwrap();
            let steps = (1.0 / h).round() as usize;
            for _ in 0..steps {
                simulation.step().unwrap_or_else(|error| panic!("{name} {integrator}: {error}"));
            }
            let relative: Vec<f64> =
                simulation.terms().residual.iter().zip(&scales).map(|(residual, scale)| residual / scale).collect();
            assert!(largest(&relative) <= 1e-10, "{name} {integrator}: {relative:?}");
            let error = simulation.energy_error_max();
            assert!(error <= energy, "{name} {integrator}: {error:e} of the energy is missing");
        }
    }
}

/// The same motion by other constraints, to what dop853 leaves at 1e-12 a substep, over a second.
#[test]
fn the_same_held_otherwise_moves_the_same() {
    let run = |(system, state): (System, State)| {
        let settings = Settings { tolerance: 1e-12, ..systems::settings(Integrator::Dop853, 0.01) };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        simulation.advance(1.0).unwrap();
        simulation.state().positions().to_vec()
    };
    let same = |what: &str, one: Vec<f64>, other: Vec<f64>| {
        for (a, b) in one.iter().zip(&other) {
            assert_close(what, *a, *b, 1e-10);
        }
    };
    let circle = system(&[&[1.0, 0.0]], |p| vec![OnSphere::new(p[0], [0.0; 3], 1.0).into()]);
    let wire = system(&[&[1.0, 0.0]], |p| {
        vec![OnCurve { particle: p[0], curve: curve(&["cos(s)", "sin(s)"], -PI, PI) }.into()]
    });
    same("a circle as a wire", run(circle), run(wire));
    let tilted = |hold: fn(ParticleId) -> Constraint| system(&[&[1.0, 0.0, 0.0]], |p| vec![hold(p[0])]);
    let circle = tilted(|p| OnCircle::new(p, [0.0; 3], [0.0, 0.6, 0.8], 1.0).into());
    let wire =
        tilted(|p| OnCurve { particle: p, curve: curve(&["cos(s)", "0.8*sin(s)", "-0.6*sin(s)"], -PI, PI) }.into());
    same("a circle in space as a wire", run(circle), run(wire));
    let plane = |p: ParticleId, normal: [f64; 3]| Constraint::from(OnPlane::fixed(p, [0.0; 3], normal));
    let line = system(&[&[0.0; 3]], |p| vec![OnLine::fixed(p[0], [0.0; 3], [1.0, -1.0, 0.5]).into()]);
    let planes = system(&[&[0.0; 3]], |p| vec![plane(p[0], [1.0, 1.0, 0.0]), plane(p[0], [0.0, 1.0, 2.0])]);
    same("a line as two planes", run(line), run(planes));
}

/// A bead on a cycloid swings with 2π √(4R/g) whatever its amplitude; after half of it, it is on the other side.
#[test]
fn a_cycloid_is_isochronous() {
    let period = 2.0 * PI * (4.0 / G).sqrt();
    for s in [0.2, 1.0, 2.5] {
        let place = [s + libm::sin(s), -libm::cos(s)];
        let wire = system(&[&place], |p| {
            vec![OnCurve { particle: p[0], curve: curve(&["s + sin(s)", "-cos(s)"], -3.1, 3.1) }.into()]
        });
        let settings = Settings { tolerance: 1e-12, ..systems::settings(Integrator::Dop853, 0.01) };
        let mut simulation = Simulation::new(wire.0, wire.1, settings).unwrap();
        simulation.advance(period / 2.0).unwrap();
        assert_close("x", simulation.state().positions()[0], -place[0], 1e-9);
        assert_close("y", simulation.state().positions()[1], place[1], 1e-9);
    }
}

/// A free particle on a rod that turns at ω goes out as r cosh ω t; the drive does the work m ω² r² sinh²(ω t), all that it gains.
#[test]
fn a_bead_on_a_turning_rod_goes_out_as_cosh() {
    let mut builder = System::builder(Dimension::Two);
    let bead = builder.particle(Particle::at("bead", [0.5, 0.0]).with_velocity([0.0, 1.0]));
    let line = OnLine { particle: bead, line: qhat::Line::Through(driven("0", "0"), driven("cos(2*t)", "sin(2*t)")) };
    builder.constraint("rod", line);
    let (system, state) = builder.build().unwrap();
    let settings = Settings { tolerance: 1e-12, ..systems::settings(Integrator::Dop853, 0.01) };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    simulation.advance(1.0).unwrap();
    let radius = 0.5 * libm::cosh(2.0);
    assert_close("x", simulation.state().positions()[0], radius * libm::cos(2.0), 1e-9);
    assert_close("y", simulation.state().positions()[1], radius * libm::sin(2.0), 1e-9);
    let sinh = libm::sinh(2.0);
    // Half of the work is the speed outwards, half the faster turn.
    assert_close("work", simulation.state().work().drives, sinh * sinh, 1e-8);
}

/// A crank of r turns at ω, a rod of l pushes the slider: x = r cos θ + s with s = √(l² − r² sin² θ), θ = ω t, and
/// ẍ = −r ω² (cos θ + r cos 2θ/s + r³ sin² θ cos² θ/s³).
#[test]
fn a_slider_moves_and_accelerates_as_its_crank_says() {
    let (r, l, omega) = (0.3, 1.0, 2.0);
    let mut builder = System::builder(Dimension::Two);
    let pin = builder.particle(Particle::at("pin", [r, 0.0]).with_velocity([0.0, r * omega]));
    let slider = builder.particle(Particle::at("slider", [r + l, 0.0]).with_mass(3.0));
    builder.constraint("crank", Relation::driven(pin, driven("0.3*cos(2*t)", "0.3*sin(2*t)")));
    builder.constraint("rod", Distance::new(pin, slider, l));
    builder.constraint("way", OnLine::fixed(slider, [0.0; 3], [1.0, 0.0, 0.0]));
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Dop853, 0.05)).unwrap();
    for _ in 0..100 {
        simulation.step().unwrap();
        let (sine, cosine) = libm::sincos(omega * simulation.state().time());
        let s = (l * l - r * r * sine * sine).sqrt();
        let x = r * cosine + s;
        let bend = r * (cosine * cosine - sine * sine) / s + libm::pow(r / s, 3.0) * libm::pow(sine * cosine, 2.0);
        // No freedom is left: what projections leave, here times ω² and the like.
        assert_close("x", simulation.state().positions()[2], x, 1e-10);
        assert_close("acceleration", simulation.terms().accelerations[2], -r * omega * omega * (cosine + bend), 1e-9);
    }
}

/// Down a cycloid to its lowest point a bead takes π √(R/g), and no way is faster: down the straight line to the same point (π R, −2 R) it
/// takes √((4 + π²) R/g), 1.19 times as long. As the cycloid begins with a cusp, the bead on it is met where s = √(g/R) t = 0.5.
#[test]
fn a_cycloid_is_faster_than_the_straight_line() {
    let r = 0.5;
    let rate = (G / r).sqrt();
    let arrive = |place: [f64; 2], velocity: [f64; 2], curve: Curve, duration: f64| {
        let mut builder = System::builder(Dimension::Two);
        let particle = builder.particle(Particle::at("bead", place).with_velocity(velocity));
        builder.with_constraint("wire", OnCurve { particle, curve }).force(systems::gravity());
        let (system, state) = builder.build().unwrap();
        let settings = Settings { tolerance: 1e-12, ..systems::settings(Integrator::Dop853, 0.01) };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        simulation.advance(duration).unwrap();
        // dop853 keeps 1e-12 a substep.
        assert_close("x", simulation.state().positions()[0], PI * r, 1e-9);
        assert_close("y", simulation.state().positions()[1], -2.0 * r, 1e-9);
    };
    let (sine, cosine) = libm::sincos(0.5);
    let cycloid = curve(&["0.5*(s - sin(s))", "0.5*(cos(s) - 1)"], 0.0, 3.5);
    let velocity = [r * (1.0 - cosine) * rate, -r * sine * rate];
    arrive([r * (0.5 - sine), r * (cosine - 1.0)], velocity, cycloid, (PI - 0.5) / rate);
    let straight = Curve::through(&[[0.0; 3], [PI * r, -2.0 * r, 0.0]], false).unwrap();
    arrive([0.0; 2], [0.0; 2], straight, (4.0 + PI * PI).sqrt() / rate);
}

/// Without gravity a bead keeps its speed v round every corner, so that it is where s = v t; the wire presses with m v²/r on an arc and not at all between.
#[test]
fn a_bead_keeps_its_speed_round_corners() {
    let (r, v) = (0.25, 2.0);
    let square = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
    let folded = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.3], [0.0, 1.0, -0.4], [0.0, 0.0, 0.5]];
    for (points, dimension) in [(square, Dimension::Two), (folded, Dimension::Three)] {
        let curve = Curve::polyline(&points, r, true).unwrap();
        let (d, start) = (dimension.number(), curve.point(0.1));
        let later = curve.point(0.1 + 1e-3);
        let velocity: Vec<f64> = (0..d).map(|k| v * (later[k] - start[k]) / 1e-3).collect();
        let mut builder = System::builder(dimension);
        let particle = builder.particle(Particle::at("bead", &start[..d]).with_velocity(velocity));
        builder.constraint("wire", OnCurve { particle, curve: curve.clone() });
        let (system, state) = builder.build().unwrap();
        for tolerance in [1e-6, 1e-9] {
            let settings = Settings { tolerance, ..systems::settings(Integrator::Dop853, 0.02) };
            let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
            let (mut attempts, mut pressed) = (0, 0);
            let frames = (2.0 * curve.range()[1] / v / settings.h) as usize;
            for _ in 0..frames {
                let report = simulation.step().unwrap();
                attempts += report.substeps + report.rejected;
                // A few joints at the tolerance each; the force is 2 v/r = 16 times as sensitive to v.
                assert_close("speed", length(simulation.state().velocities()), v, tolerance);
                let force = length(&simulation.terms().constraint_forces);
                let expected = if force > 8.0 { v * v / r } else { 0.0 };
                assert_close("force", force, expected, 20.0 * tolerance);
                pressed += usize::from(force > 8.0);
            }
            let expected = curve.point(0.1 + v * simulation.state().time());
            for (x, e) in simulation.state().positions().iter().zip(expected) {
                assert_close("place", *x, e, 5.0 * tolerance);
            }
            // Two rounds of 4 or 5 corners. Measured: 28 attempts a joint at 1e-6, 40 at 1e-9.
            let joints = if d == 2 { 16 } else { 20 };
            assert!(pressed > frames / 4 && attempts < frames + 60 * joints, "{attempts} attempts");
        }
    }
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// What each kind refuses, in words.
#[test]
fn what_cannot_be_is_refused() {
    let refused = |dimension: Dimension, make: fn(ParticleId, ParticleId) -> Constraint, words: &str| {
        let mut builder = System::builder(dimension);
        let d = dimension.number();
        let [a, b] = ["a", "b"].map(|name| builder.particle(Particle::at(name, vec![name.len() as f64; d])));
        builder.constraint("c", make(a, b));
        let error = builder.build().unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let (two, three) = (Dimension::Two, Dimension::Three);
    refused(two, |a, _| Direction::new(a, a, [1.0, 0.0, 0.0]).into(), "named twice");
    refused(two, |a, b| Direction::new(a, b, [0.0, 0.0, 1.0]).into(), "must not be zero");
    refused(three, |a, b| OnLine::through(a, b, b).into(), "named twice");
    refused(two, |a, _| OnPlane::fixed(a, [0.0; 3], [0.0, 1.0, 0.0]).into(), "needs three dimensions");
    refused(three, |a, b| OnPlane::through(a, [a, b, b]).into(), "named twice");
    refused(three, |a, _| OnPlane::fixed(a, [0.0; 3], [0.0; 3]).into(), "must not be zero");
    refused(two, |a, _| OnSphere::new(a, a, 1.0).into(), "named twice");
    refused(two, |a, b| OnSphere::new(a, b, 0.0).into(), "must be positive");
    refused(two, |a, _| OnSphere::new(a, Anchor::Point([f64::NAN; 3].map(Driven::Constant)), 1.0).into(), "finite");
    refused(two, |a, b| OnCircle::new(a, b, [0.0, 0.0, 1.0], 1.0).into(), "needs three dimensions");
    refused(three, |a, _| OnCurve { particle: a, curve: curve(&["s", "s"], 0.0, 1.0) }.into(), "3 components");
    let not_a_curve = |made: Result<Curve, GeometryError>, words: &str| {
        assert!(made.unwrap_err().to_string().contains(words));
    };
    not_a_curve(Curve::through(&[[0.0; 3]], false), "needs 2 points");
    not_a_curve(Curve::through(&[[0.0; 3], [0.0; 3]], false), "at one place");
    not_a_curve(Curve::polyline(&[[0.0; 3], [1.0, 0.0, 0.0]], -1.0, false), "must be positive");
    let s = || expression("s", Purpose::Curve, two);
    not_a_curve(Curve::parametric(vec![s()], 0.0, 1.0), "2 or 3 components");
    not_a_curve(Curve::parametric(vec![s(), s()], 1.0, 0.0), "must grow");
    let root = expression("1/s", Purpose::Curve, two);
    not_a_curve(Curve::parametric(vec![s(), root], 0.0, 1.0), "not finite");
}
