//! Motion under every kind of constraint: C held, and the energy accounted for.

use super::case::{Case, P, parse};
use super::cases::CASES;
use crate::systems;
use crate::systems::dense::largest;
use qhat::{
    Constraint, Curve, Dimension, Direction, Driven, Integrator, OnCircle, OnCurve, OnLine, OnPlane, OnSphere,
    Particle, ParticleId, Purpose, Relation, Settings, Simulation, State, System,
};

/// The case at rest at its start, on particles that springs keep apart and together; p5 is held.
fn moving(case: &Case) -> (System, State) {
    let (d, q) = (case.d, case.positions());
    let mut builder = case.particles(|i, particle| if i == 5 { particle.fixed() } else { particle });
    for (i, a) in P.iter().enumerate() {
        for b in &P[..i] {
            let square = |k: usize| {
                let apart = q[a.index() * d + k] - q[b.index() * d + k];
                apart * apart
            };
            let rest = 0.95 * (0..d).map(square).sum::<f64>().sqrt();
            if rest > 0.0 {
                builder.force(qhat::Spring { a: *a, b: *b, stiffness: 20.0, damping: 0.0, rest });
            }
        }
    }
    for (k, constraint) in case.constraints(0.0).into_iter().enumerate() {
        builder.constraint(format!("c{k}"), constraint);
    }
    builder.build().unwrap_or_else(|error| panic!("{}: {error}", case.name))
}

/// The worst |C| over its scale, and the most that is missing in the energy, over a second.
fn run(case: &Case, integrator: Integrator, h: f64) -> (f64, f64) {
    let (system, state) = moving(case);
    let settings = Settings { integrator, h, tolerance: 1e-10, ..Settings::default() };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    let mut worst = 0.0_f64;
    for _ in 0..(1.0 / h).round() as usize {
        simulation.step().unwrap_or_else(|error| panic!("{} under {integrator:?}: {error}", case.name));
        let C = simulation.terms().residual;
        let relative = C.iter().zip(simulation.system().row_scales()).map(|(C, scale)| C.abs() / scale);
        worst = relative.fold(worst, f64::max);
    }
    (worst, simulation.energy_error_max())
}

#[test]
fn long_every_kind_is_held_and_its_energy_accounted_for() {
    for case in CASES.iter().filter(|case| case.moves) {
        // What projections leave, and ten times that.
        let held = |integrator: Integrator, worst: f64| {
            assert!(worst < 1e-9, "{} under {integrator:?}: off by {worst:e}", case.name);
        };
        let (worst, energy) = run(case, Integrator::Auto, 0.01);
        held(Integrator::Auto, worst);
        // dop853 at 1e-10 a substep; the drives' work is summed by a rule of the same order.
        assert!(energy < 1e-7, "{} under auto: {energy:e} of the energy is missing", case.name);
        for integrator in [Integrator::Rattle, Integrator::Bdf2] {
            let ((worst, coarse), (_, fine)) = (run(case, integrator, 0.004), run(case, integrator, 0.002));
            held(integrator, worst);
            println!("{} {integrator:?} {worst:e} {coarse:e} {fine:e}", case.name);
            // Rattle makes substeps by its tolerance; bdf2 takes h as it is, of second order: a quarter of it at half
            // the step.
            let second_order = fine < 1e-3 && fine < 0.35 * coarse;
            assert!(fine < 1e-6 || second_order, "{} under {integrator:?}: {coarse:e}, {fine:e}", case.name);
        }
    }
}

fn schedule(text: &str) -> Driven {
    parse(text, Purpose::Time, 2).into()
}

/// A point that moves in the plane.
pub(crate) fn driven(x: &str, y: &str) -> [Driven; 3] {
    [schedule(x), schedule(y), Driven::Constant(0.0)]
}

pub(crate) fn curve(components: &[&str], from: f64, to: f64) -> Curve {
    let d = if components.len() == 2 { 2 } else { 3 };
    let components = components.iter().map(|text| parse(text, Purpose::Curve, d)).collect();
    Curve::parametric(components, from, to).unwrap()
}

/// Particles of 1 kg and 2 kg by turns under gravity along −y, and what holds them.
pub(crate) fn system(places: &[&[f64]], constraints: impl FnOnce(&[ParticleId]) -> Vec<Constraint>) -> (System, State) {
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

/// Mechanisms of one or several kinds, in the plane and in space, driven where they can be.
fn mechanisms() -> Vec<(&'static str, (System, State))> {
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

/// C within the tolerance asked for, relative to its scale, and the balance of energy to what the order leaves, over a
/// second.
#[test]
fn long_mechanisms_hold_and_account_for_their_energy() {
    // Of the largest kinetic energy: dop853 keeps 1e-9 a substep, and the spline, whose third derivative jumps, a
    // little less. RATTLE and BDF2 are of second order: (ω h)² with ω of 5/s and h = 1 ms or ½ ms is 3e-5 and less.
    for (integrator, h, energy) in
        [(Integrator::Auto, 0.01, 1e-6), (Integrator::Rattle, 1e-3, 1e-3), (Integrator::Bdf2, 5e-4, 1e-3)]
    {
        for (name, (system, state)) in mechanisms() {
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
