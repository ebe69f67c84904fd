//! Rigid clusters in a line and in a plane: a lever against the compound pendulum, a plate and a bar in space against
//! torque-free motion of Euler's equations.

use crate::systems::G;
use qhat::{
    Dimension, Distance, Gravity, Integrator, Particle, ParticleId, Relation, RigidCluster, Settings, Simulation,
    System, SystemBuilder, evaluate, rigid_cluster,
};

fn settings() -> Settings {
    Settings { h: 0.05, integrator: Integrator::Dop853, tolerance: 1e-11, ..Settings::default() }
}

/// Holds particles rigidly together as `kind = "rigid"` does.
fn hold(builder: &mut SystemBuilder, dimension: Dimension, particles: &[ParticleId], points: &[[f64; 3]]) {
    let RigidCluster { rods, combinations } = rigid_cluster(dimension, points).unwrap();
    for [a, b] in rods {
        let length = (0..3).map(|k| points[a][k] - points[b][k]).map(|x| x * x).sum::<f64>().sqrt();
        builder.constraint(format!("rod {a}-{b}"), Distance::new(particles[a], particles[b], length));
    }
    for terms in combinations {
        let terms: Vec<_> = terms.iter().map(|&(k, weight)| (particles[k], weight)).collect();
        builder.constraint(format!("rigid {}", terms[0].0.index()), Relation::homogeneous(terms));
    }
}

/// A lever about its middle joint, 1 kg at one end and 2 kg at the other. By the energy ω² = −⅔ g sin θ; by Newton's
/// law of each end along the lever, the bar between them carries T = −3/2 g sin θ and the pivot
/// (A: T + F/2 = ω² + g sin θ; C: F/2 − T = 2 g sin θ − 2 ω²).
#[test]
fn a_lever_is_a_compound_pendulum() {
    let points = [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let mut builder = System::builder(Dimension::Two);
    let a = builder.particle(Particle::at("A", [-1.0, 0.0]));
    let b = builder.particle(Particle::at("B", [0.0, 0.0]).fixed());
    let c = builder.particle(Particle::at("C", [1.0, 0.0]).with_mass(2.0));
    hold(&mut builder, Dimension::Two, &[a, b, c], &points);
    builder.force(Gravity { acceleration: [0.0, -G, 0.0] });
    let (system, state) = builder.build().unwrap();
    let rank = evaluate(&system, &state).rank.unwrap();
    assert_eq!((system.row_count(), rank, 2 * 2 - rank), (3, 3, 1), "one degree of freedom, no row redundant");
    let mut simulation = Simulation::new(system, state, settings()).unwrap();
    assert!(simulation.second_order().is_empty());
    for frame in 1..=60 {
        simulation.step().unwrap();
        let ([x, y, _], [u, v, _]) = (simulation.position(c), simulation.velocity(c));
        let (sine, squared) = (y, u * u + v * v);
        // The tolerance is 1e-11 a substep.
        assert!((squared + 2.0 / 3.0 * G * sine).abs() < 1e-8, "frame {frame}: ω² {squared}, sin θ {sine}");
        let [p, q, _] = simulation.position(a);
        assert!((p + x).abs() < 1e-10 && (q + y).abs() < 1e-10, "frame {frame}: the ends are opposite");
        let tension = simulation.tension()[0];
        assert!((tension + 1.5 * G * sine).abs() < 1e-7, "frame {frame}: {tension} N, sin θ {sine}");
        // The pivot carries the weights and 3 kg times the acceleration of the centre of mass, at ⅓ of the arm.
        let turning = -G * x / 3.0;
        let centre = [-turning * y / 3.0 - squared * x / 3.0, turning * x / 3.0 - squared * y / 3.0];
        let wanted = [-3.0 * centre[0], -3.0 * (centre[1] + G)];
        let carried = simulation.support(b);
        for k in 0..2 {
            assert!((carried[k] - wanted[k]).abs() < 1e-6, "frame {frame}: {carried:?} N, not {wanted:?} N");
        }
    }
}

type Vector = [f64; 3];

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A square plate of nine joints is a symmetric top: with L the angular momentum and I the moment about a side's
/// direction, its normal turns about L at |L|/I.
#[test]
fn a_plate_in_space_turns_as_a_symmetric_top() {
    let mut points = Vec::new();
    for i in -1..=1 {
        points.extend((-1..=1).map(|j| [f64::from(i), f64::from(j), 0.0]));
    }
    let omega = [0.8, 0.0, 1.5];
    let mut builder = System::builder(Dimension::Three);
    let joint = |(k, &x): (usize, &Vector)| Particle::at(format!("p{k}"), x).with_velocity(cross(omega, x));
    let particles: Vec<_> = points
        .iter()
        .enumerate()
        .map(joint)
        .collect::<Vec<_>>()
        .into_iter()
        .map(|particle| builder.particle(particle))
        .collect();
    hold(&mut builder, Dimension::Three, &particles, &points);
    let (system, state) = builder.build().unwrap();
    let rank = evaluate(&system, &state).rank.unwrap();
    assert_eq!((system.row_count(), rank), (3 * 9 - 6, 3 * 9 - 6), "six degrees of freedom, no row redundant");
    let mut simulation = Simulation::new(system, state, settings()).unwrap();
    // Six joints at 1 from each axis in the plane.
    let (across, along) = (6.0, 12.0);
    let L = [across * omega[0], 0.0, along * omega[2]];
    let size = dot(L, L).sqrt();
    let axis = L.map(|component| component / size);
    for frame in 1..=40 {
        simulation.step().unwrap();
        let angle = size / across * 0.05 * f64::from(frame);
        let normal = [0.0, 0.0, 1.0];
        let (turned, part) = (cross(axis, normal), dot(axis, normal) * (1.0 - angle.cos()));
        let wanted: Vector =
            std::array::from_fn(|k| normal[k] * angle.cos() + turned[k] * angle.sin() + axis[k] * part);
        let at: Vec<Vector> = particles.iter().map(|&id| simulation.position(id)).collect();
        let side = |a: usize, b: usize| -> Vector { std::array::from_fn(|k| at[b][k] - at[a][k]) };
        let found = cross(side(4, 7), side(4, 5));
        for k in 0..3 {
            assert!((found[k] - wanted[k]).abs() < 1e-8, "frame {frame}: {found:?}, not {wanted:?}");
        }
        for i in 0..9 {
            for j in 0..i {
                let (now, then) = (side(i, j), std::array::from_fn::<f64, 3, _>(|k| points[j][k] - points[i][k]));
                let off = dot(now, now).sqrt() - dot(then, then).sqrt();
                assert!(off.abs() < 1e-10 * 3.0, "frame {frame}: {i}-{j} off by {off} m");
            }
        }
    }
    assert!(simulation.energy_error_max() < 1e-9);
}

/// Joints in a line have no inertia about it: five degrees of freedom, in space, in any direction and order.
#[test]
fn a_bar_of_many_joints_in_space_has_five_degrees_of_freedom() {
    let places = [0.3, -1.0, 0.0, 0.7, 0.1, 0.9];
    let direction = [0.48, -0.6, 0.64];
    let points: Vec<Vector> = places.iter().map(|s| direction.map(|c| 2.0 * s * c)).collect();
    let mut builder = System::builder(Dimension::Three);
    let particles: Vec<_> = points
        .iter()
        .enumerate()
        .map(|(k, &x)| {
            let spin = cross([0.3, 0.9, -0.2], x);
            builder.particle(Particle::at(format!("p{k}"), x).with_velocity(spin).with_mass(1.0 + k as f64))
        })
        .collect();
    hold(&mut builder, Dimension::Three, &particles, &points);
    let (system, state) = builder.build().unwrap();
    assert_eq!(evaluate(&system, &state).rank, Some(3 * 6 - 5));
    assert_eq!(system.row_count(), 3 * 6 - 5);
    let mut simulation = Simulation::new(system, state, settings()).unwrap();
    for _ in 0..40 {
        simulation.step().unwrap();
    }
    for (i, s) in places.iter().enumerate() {
        for (j, other) in places.iter().enumerate().take(i) {
            let [a, b] = [particles[i], particles[j]].map(|id| simulation.position(id));
            let apart: Vector = std::array::from_fn(|k| a[k] - b[k]);
            assert!((dot(apart, apart).sqrt() - 2.0 * (s - other).abs()).abs() < 4e-10, "{i}-{j}");
        }
    }
    assert!(simulation.energy_error_max() < 1e-9);
}
