//! The library of forces against closed forms, and its energy account.

use crate::systems;
use crate::systems::dense::assert_close;
use crate::systems::random::{Random, dimension};
use qhat::{
    Actuator, AirDrag, CentralForce, CubicSpring, Dimension, Distance, Facet, Force, Gas, HarmonicForce, Integrator,
    InverseSquare, Particle, ParticleId, Pressure, Settings, Simulation, State, System, TorsionSpring, evaluate,
};
use std::f64::consts::PI;

fn simulation((system, state): (System, State), integrator: Integrator, tolerance: f64, h: f64) -> Simulation {
    Simulation::new(system, state, Settings { tolerance, ..systems::settings(integrator, h) }).unwrap()
}

fn run(simulation: &mut Simulation, frames: usize) {
    for _ in 0..frames {
        simulation.step().unwrap();
    }
}

/// All kinds of forces together on a small tree of rods.
fn with_every_force(random: &mut Random, d: usize) -> (System, State) {
    let mut builder = System::builder(dimension(d));
    let points = random.points(7, d, 1.0);
    for (i, x) in points.iter().enumerate() {
        let particle = Particle::at(format!("p{i}"), x.clone()).with_mass(random.within(0.5, 2.0));
        let v = random.numbers(d, -0.5, 0.5);
        builder.particle(if i == 0 { particle.fixed() } else { particle.with_velocity(v) });
    }
    let p: Vec<ParticleId> = (0..7).map(systems::id).collect();
    for (a, b) in [(0, 1), (1, 2), (2, 3), (1, 4)] {
        let r = points[a].iter().zip(&points[b]).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt();
        builder.constraint(format!("{a}-{b}"), Distance::new(p[a], p[b], r));
    }
    builder.force(CentralForce::gravity(p[3], 1.0, [0.3, -0.2, 0.1], 2.0, 0.5));
    builder.force(InverseSquare::gravity([p[4], p[5]], [1.0, 2.0], 1.0, 0.5));
    builder.force(InverseSquare::charges([p[2], p[6]], [1.0, 2.0], 1.0, 0.5));
    builder.force(AirDrag { wind: [0.5, -0.3, 0.2], gradient: [[0.1; 3]; 3], ..AirDrag::still(p[5], 0.2, 0.3) });
    builder.force(TorsionSpring { a: p[0], b: p[1], c: p[2], stiffness: 1.0, damping: 0.1, angle: 2.0 });
    builder.force(HarmonicForce { particle: p[2], amplitude: [0.5, 1.0, -0.3], angular_frequency: 3.0, phase: 0.4 });
    builder.force(Actuator { a: p[3], b: p[6], push: 0.2, amplitude: 0.3, angular_frequency: 2.0, phase: 0.1 });
    builder.force(CubicSpring { a: p[5], b: p[6], stiffness: 1.0, cubic: 2.0, damping: 0.2, rest: 1.0 });
    for facet in Pressure::in_loop(&[p[1], p[4], p[5]], 0.5) {
        builder.force(facet);
    }
    builder.build().unwrap()
}

#[test]
fn every_force_closes_the_account_of_energy() {
    let mut random = Random::new(23);
    for d in [2, 3] {
        let mut simulation = simulation(with_every_force(&mut random, d), Integrator::Dop853, 1e-10, 0.05);
        run(&mut simulation, 60);
        let work = simulation.energy().work.dissipation;
        assert!(work.abs() > 0.1, "much goes through the account: {work}");
        // Errors of some hundred substeps of 1e-10 add up.
        assert!(simulation.energy_error_max() < 1e-8, "D = {d}: {:e}", simulation.energy_error_max());
    }
}

#[test]
fn a_kepler_orbit_closes_and_keeps_energy_and_angular_momentum() {
    for (d, e) in [(2, 0.0), (2, 0.6), (3, 0.6)] {
        let (mu, a, m) = (3.0_f64, 1.0, 2.0);
        let speed = (mu * (1.0 + e) / (a * (1.0 - e))).sqrt();
        let (x, v) = ([a * (1.0 - e), 0.0, 0.0], [0.0, 0.6 * speed, 0.8 * speed]);
        let v = if d == 2 { [0.0, speed, 0.0] } else { v };
        let mut builder = System::builder(dimension(d));
        let body = builder.particle(Particle::at("body", &x[..d]).with_mass(m).with_velocity(&v[..d]));
        builder.force(CentralForce::gravity(body, m, [0.0; 3], mu, 0.0));
        let period = 2.0 * PI * (a * a * a / mu).sqrt();
        let mut simulation = simulation(builder.build().unwrap(), Integrator::Dop853, 1e-11, period / 50.0);
        // E = −μ m/(2a), and the angular momentum of perihelion.
        for _ in 0..100 {
            simulation.step().unwrap();
            assert_close("energy", simulation.energy().total(), -mu * m / (2.0 * a), 1e-8);
            let (x, v) = (simulation.state().positions(), simulation.state().velocities());
            let z = m * (x[0] * v[1] - x[1] * v[0]);
            let tilt = if d == 2 { 1.0 } else { 0.6 };
            assert_close("angular momentum", z, m * a * (1.0 - e) * speed * tilt, 1e-8);
        }
        // Two rounds: a phase error of the step's tolerance, times a speed of some m/s, times some hundred substeps.
        for k in 0..d {
            assert_close("closed", simulation.state().positions()[k], x[k], 1e-7);
        }
    }
}

/// A hinge with V = ½ k (θ − θ₀)² and one fixed arm is a harmonic oscillator at any amplitude.
#[test]
fn a_torsion_pendulum_swings_in_its_period() {
    for d in [2, 3] {
        let (k, m, r) = (5.0, 0.8, 0.7);
        let at = |angle: f64| [r * libm::cos(angle), r * libm::sin(angle), 0.0];
        let mut builder = System::builder(dimension(d));
        let a = builder.particle(Particle::at("a", &[1.0, 0.0, 0.0][..d]).fixed());
        let b = builder.particle(Particle::at("b", &[0.0; 3][..d]).fixed());
        let c = builder.particle(Particle::at("c", &at(2.1)[..d]).with_mass(m));
        builder.constraint("arm", Distance::new(b, c, r));
        builder.force(TorsionSpring { a, b, c, stiffness: k, damping: 0.0, angle: 1.2 });
        let period = 2.0 * PI * (m * r * r / k).sqrt();
        let mut simulation = simulation(builder.build().unwrap(), Integrator::Dop853, 1e-10, period / 8.0);
        for eighth in 1..=16 {
            simulation.step().unwrap();
            let angle = 1.2 + 0.9 * libm::cos(2.0 * PI * f64::from(eighth) / 8.0);
            for k in 0..d {
                assert_close("place", simulation.state().positions()[2 * d + k], at(angle)[k], 1e-7);
            }
        }
    }
}

/// m ẍ = f cos(ω t + φ), and the work that it does. A free particle goes into lanes, so this test
/// also checks the forces that lanes keep constant within a frame.
#[test]
fn a_harmonic_force_follows_the_time() {
    for integrator in [Integrator::Dop853, Integrator::Dopri5, Integrator::Rk4] {
        let (f, omega, phase, m) = (3.0, 4.0, 0.7, 1.5);
        let mut builder = System::builder(Dimension::Two);
        let particle = builder.particle(Particle::at("p", [0.2, 0.0]).with_mass(m));
        builder.force(HarmonicForce { particle, amplitude: [f, 0.0, 0.0], angular_frequency: omega, phase });
        let mut simulation = simulation(builder.build().unwrap(), integrator, 1e-10, 0.01);
        run(&mut simulation, 300);
        let t = 3.0;
        let v = f / (m * omega) * (libm::sin(omega * t + phase) - libm::sin(phase));
        let swing = libm::cos(phase) - libm::cos(omega * t + phase) - omega * t * libm::sin(phase);
        // rk4: (ω h)⁵/120 a step, 300 of them, 3e-7.
        assert_close("x", simulation.state().positions()[0], 0.2 + f / (m * omega * omega) * swing, 3e-7);
        assert_close("work", simulation.energy().work.dissipation, 0.5 * m * v * v, 3e-6);
    }
}

#[test]
fn an_actuator_gives_push_times_way() {
    let mut builder = System::builder(Dimension::Three);
    let a = builder.particle(Particle::at("a", [0.0, 0.0, 0.0]));
    let b = builder.particle(Particle::at("b", [0.6, 0.0, 0.8]).with_mass(3.0));
    builder.force(Actuator { a, b, push: 2.0, amplitude: 0.0, angular_frequency: 0.0, phase: 0.0 });
    let mut simulation = simulation(builder.build().unwrap(), Integrator::Dop853, 1e-10, 0.1);
    run(&mut simulation, 10);
    // Relative acceleration 2 (1 + 1/3) m/s² for 1 s: 4/3 m farther apart.
    let x = simulation.state().positions();
    let apart = ((x[0] - x[3]) * (x[0] - x[3]) + (x[2] - x[5]) * (x[2] - x[5])).sqrt();
    assert_close("apart", apart, 1.0 + 4.0 / 3.0, 1e-9);
    assert_close("work", simulation.energy().work.dissipation, 2.0 * 4.0 / 3.0, 1e-9);
    assert_close("kinetic", simulation.energy().kinetic, 2.0 * 4.0 / 3.0, 1e-9);
}

/// Pressure on a closed mesh: no net force and no torque about any origin, and p V stored.
#[test]
fn a_closed_mesh_is_pushed_nowhere() {
    let mut random = Random::new(4);
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 1.3, 0.1], [0.1, 0.3, 0.9]];
    for shift in [0.0, 50.0] {
        let mut builder = System::builder(Dimension::Three);
        let by = random.triple().map(|x| shift * x);
        let at: Vec<[f64; 3]> = corners.iter().map(|x| std::array::from_fn(|k| x[k] + by[k])).collect();
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| builder.particle(Particle::at(format!("{i}"), at[i])));
        for triangle in [[a, c, b], [a, b, d], [a, d, c], [b, c, d]] {
            builder.force(Pressure { facet: Facet::Triangle(triangle), pressure: 6.0 });
        }
        let (system, state) = builder.build().unwrap();
        let Q = evaluate(&system, &state).applied_forces;
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            // Roundoff of products of coordinates up to 50.
            assert_close("force", (0..4).map(|p| Q[3 * p + k]).sum(), 0.0, 1e-10);
            assert_close("torque", (0..4).map(|p| at[p][i] * Q[3 * p + j] - at[p][j] * Q[3 * p + i]).sum(), 0.0, 1e-9);
        }
        // −6 V with V = det/6 of the three edges.
        let det = 1.0 * (1.3 * 0.9 - 0.1 * 0.3) - 0.1 * (0.2 * 0.9 - 0.1 * 0.1);
        let simulation = simulation((system, state), Integrator::Dop853, 1e-4, 0.01);
        assert_close("potential", simulation.energy().potential, -det, 1e-9);
    }
}

/// A loop of equal rods under pressure comes to rest as the regular polygon, here with an implicit method, which uses
/// the tangents.
#[test]
fn a_loop_under_pressure_becomes_regular() {
    let (n, r, p) = (12, 0.3, 40.0);
    let mut builder = System::builder(Dimension::Two);
    // A flattened circle; the projection of the start gives the rods their lengths.
    let place = |i: usize| 2.0 * PI * i as f64 / n as f64;
    let ids: Vec<ParticleId> = (0..n)
        .map(|i| builder.particle(Particle::at(format!("{i}"), [0.7 * libm::cos(place(i)), 0.4 * libm::sin(place(i))])))
        .collect();
    for i in 0..n {
        builder.constraint(format!("rod{i}"), Distance::new(ids[i], ids[(i + 1) % n], r));
    }
    builder.force(qhat::Drag { coefficient: 4.0 });
    for facet in Pressure::in_loop(&ids, p) {
        builder.force(facet);
    }
    let mut simulation = simulation(builder.build().unwrap(), Integrator::Implicit, 1e-6, 0.05);
    run(&mut simulation, 600);
    let radius = r / (2.0 * libm::sin(PI / n as f64));
    // The slowest oscillation that remains after 30 s, and rods held to 1e-10.
    for tension in simulation.tension() {
        assert_close("tension", tension, p * radius * libm::cos(PI / n as f64), 1e-4);
    }
    for x in simulation.state().positions().chunks(2) {
        assert_close("radius", (x[0] * x[0] + x[1] * x[1]).sqrt(), radius, 1e-6);
    }
}

/// A regular polygon of n particles of mass m, released at the radius R, has the area A = k r², k = ½ n sin(2π/n). With
/// γ = 2 the force on each, 2 k r p/n, is as r⁻³: r² = R² (1 + (2 k p₀/(n m)) t²). With γ = 1 the energy p₀ A₀ ln(A/A₀)
/// has become kinetic energy.
#[test]
fn a_loop_of_particles_flies_apart_as_its_gas_expands() {
    let (n, m, radius, p) = (7, 0.3, 0.8, 2.0);
    let k = 0.5 * n as f64 * libm::sin(2.0 * PI / n as f64);
    for gamma in [2.0, 1.0] {
        let mut builder = System::builder(Dimension::Two);
        let place = |i: usize| {
            let (sine, cosine) = libm::sincos(2.0 * PI * i as f64 / n as f64);
            [radius * cosine, radius * sine]
        };
        let ids: Vec<_> =
            (0..n).map(|i| builder.particle(Particle::at(format!("{i}"), place(i)).with_mass(m))).collect();
        let q: Vec<f64> = (0..n).flat_map(place).collect();
        let facets = (0..n).map(|i| Facet::Edge([ids[i], ids[(i + 1) % n]])).collect();
        let gas = Gas::new(facets, p, gamma, Dimension::Two, &q);
        assert_close("content", gas.content(), k * radius * radius, 1e-14);
        builder.force(gas);
        let mut simulation = simulation(builder.build().unwrap(), Integrator::Dop853, 1e-12, 0.02);
        run(&mut simulation, 50);
        let [x, y] = simulation.state().positions()[..2] else { unreachable!() };
        let now = (x * x + y * y).sqrt();
        // dop853 at 1e-12 a substep, some dozens of them.
        if gamma == 2.0 {
            assert_close("radius", now, radius * (1.0 + 2.0 * k * p / (n as f64 * m)).sqrt(), 1e-10);
        } else {
            let expected = p * k * radius * radius * 2.0 * libm::log(now / radius);
            assert!(expected > 1.0);
            assert_close("kinetic", simulation.energy().kinetic, expected, 1e-10);
        }
    }
}

/// Implicit methods use the tangent of a gas, which is dense. A gas that is pressed to a hundredth of its volume and
/// released settles where its pressure carries the weight, p₀ (A₀/A)^γ w = m g.
#[test]
fn a_piston_settles_on_its_gas() {
    for integrator in [Integrator::Implicit, Integrator::Bdf2] {
        let mut builder = System::builder(Dimension::Two);
        let [a, b] = [0.0, 1.0].map(|x| builder.particle(Particle::at(format!("low{x}"), [x, 0.0]).fixed()));
        let [c, d] = [0.0, 1.0].map(|x| builder.particle(Particle::at(format!("top{x}"), [x, 0.01]).with_mass(0.5)));
        for (name, top, x) in [("left", c, 0.0), ("right", d, 1.0)] {
            builder.constraint(name, qhat::OnLine::fixed(top, [x, 0.0, 0.0], [0.0, 1.0, 0.0]));
        }
        let facets = [[a, b], [b, d], [d, c], [c, a]].map(Facet::Edge).to_vec();
        let gas = Gas::new(facets, 1000.0, 1.4, Dimension::Two, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.01, 1.0, 0.01]);
        builder.with_force(gas).with_force(systems::gravity()).force(qhat::Drag { coefficient: 2.0 });
        let mut simulation = simulation(builder.build().unwrap(), integrator, 1e-6, 0.02);
        run(&mut simulation, 1500);
        // The oscillation that remains; it decays as e^(−2t).
        let height = 0.01 * libm::pow(1000.0 / systems::G, 1.0 / 1.4);
        assert_close("height", simulation.state().positions()[5], height, 1e-9);
    }
}

#[test]
fn forces_that_cannot_be() {
    let (a, b, c) = (systems::id(0), systems::id(1), systems::id(2));
    let torsion = TorsionSpring { a, b, c, stiffness: 1.0, damping: 1.0, angle: 1.0 };
    let actuator = Actuator { a, b, push: 1.0, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 };
    let cubic = CubicSpring { a, b, stiffness: 1.0, cubic: 1.0, damping: 0.0, rest: 1.0 };
    let nan = f64::NAN;
    let q = [0.0, 0.0, 1.0, 0.0, 2.0, 0.0];
    let gas = |corners: [ParticleId; 3], pressure: f64, exponent: f64, q: &[f64]| -> Force {
        let [a, b, c] = corners;
        let facets = [[a, b], [b, c], [c, a]].map(Facet::Edge).to_vec();
        Gas::new(facets, pressure, exponent, Dimension::Two, q).into()
    };
    let cases: [(Force, &str); 17] = [
        (gas([a, b, c], 0.0, 1.0, &q), "the pressure of a gas must be positive and finite, but is 0"),
        (gas([a, b, c], 1.0, nan, &q), "the exponent of a gas must be positive and finite, but is NaN"),
        (gas([a, b, c], 1.0, 1.0, &q), "a gas must fill more than nothing at the start, but fills 0"),
        (gas([a, b, c], 1.0, 1.0, &q[..4]), "a gas must fill more than nothing at the start, but fills NaN"),
        (
            InverseSquare::gravity([a, a], [1.0; 2], 1.0, 0.0).into(),
            "an inverse-square force needs two different particles",
        ),
        (
            InverseSquare::gravity([a, b], [1.0; 2], 1.0, -1.0).into(),
            "a softening length must not be negative, but is -1",
        ),
        (
            CentralForce::gravity(a, 1.0, [0.0; 3], nan, 0.0).into(),
            "the strength of an inverse-square force must be a finite number, not NaN",
        ),
        (
            CentralForce::gravity(a, 1.0, [nan; 3], 1.0, 0.0).into(),
            "the centre of a central force must be a finite number, not NaN",
        ),
        (AirDrag::still(a, -1.0, 0.0).into(), "the linear drag coefficient must not be negative, but is -1"),
        (AirDrag { wind: [nan; 3], ..AirDrag::still(a, 0.0, 0.0) }.into(), "the wind must be a finite number, not NaN"),
        (TorsionSpring { c: a, ..torsion.clone() }.into(), "a torsion spring needs three different particles"),
        (
            TorsionSpring { angle: 4.0, ..torsion.clone() }.into(),
            "the rest angle of a torsion spring must be within π of zero, but is 4",
        ),
        (
            TorsionSpring { stiffness: -1.0, ..torsion }.into(),
            "the stiffness of a torsion spring must not be negative, but is -1",
        ),
        (Actuator { push: nan, ..actuator.clone() }.into(), "the push of an actuator must be a finite number, not NaN"),
        (Actuator { b: a, ..actuator }.into(), "an actuator needs two different particles"),
        (
            CubicSpring { cubic: nan, ..cubic }.into(),
            "the cubic stiffness of a spring must be a finite number, not NaN",
        ),
        (
            Pressure { facet: Facet::Triangle([a, b, a]), pressure: 1.0 }.into(),
            "a facet under pressure needs different particles at its corners",
        ),
    ];
    for (force, expected) in cases {
        let mut builder = System::builder(Dimension::Two);
        for (name, x) in [("a", 0.0), ("b", 1.0), ("c", 2.0)] {
            builder.particle(Particle::at(name, [x, 0.0]));
        }
        builder.force(force);
        assert_eq!(builder.build().unwrap_err().to_string(), format!("force number 0: {expected}"));
    }
}
