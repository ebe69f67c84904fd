//! Motion under a single kind of constraint, against closed forms or against the motion under other constraints.

use super::motion::{curve, driven, system};
use crate::systems::dense::assert_close;
use crate::systems::{self, G};
use qhat::{
    Constraint, Curve, Dimension, Distance, Integrator, OnCircle, OnCurve, OnLine, OnPlane, OnSphere, Particle,
    ParticleId, Relation, Settings, Simulation, State, System,
};
use std::f64::consts::PI;

/// The same motion with other constraints over a second, to the error of dop853 at 1e-12 a substep.
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

/// A bead on a cycloid swings with the period 2π √(4R/g) at every amplitude; after half a period it is on the other
/// side.
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

/// A particle that slides freely on a rod, which turns at ω, moves outwards as r cosh ω t. Its whole energy is the work
/// of the drive, m ω² r² sinh²(ω t).
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
    // Half of the work is the speed outwards, and half the faster rotation.
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
        // No degree of freedom is left. The error is the residual of the projections, here times ω² and the like.
        assert_close("x", simulation.state().positions()[2], x, 1e-10);
        assert_close("acceleration", simulation.terms().accelerations[2], -r * omega * omega * (cosine + bend), 1e-9);
    }
}

/// A bead takes π √(R/g) down a cycloid to its lowest point, and no path is faster: down the straight line to the same
/// point (π R, −2 R) it takes √((4 + π²) R/g), 1.19 times as long. As the cycloid begins with a cusp, the bead on it is
/// met where s = √(g/R) t = 0.5.
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

/// Without gravity a bead keeps its speed v round every corner, so it is at s = v t. The force of the wire is m v²/r on
/// an arc and zero between arcs.
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
                // The error of a few joints, each at the tolerance; the force is 2 v/r = 16 times as sensitive to v.
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
            // Two rounds of 4 or 5 corners. Measured: 37 attempts a joint at 1e-6, 63 at 1e-9.
            let joints = if d == 2 { 16 } else { 20 };
            assert!(pressed > frames / 4 && attempts < frames + 80 * joints, "{attempts} attempts");
        }
    }
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}
