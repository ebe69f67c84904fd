//! Bodies of particles and rods against rigid bodies: their moments, the compound pendulum, Euler's equations.

use crate::systems::dense::{assert_all_close, assert_close};
use crate::systems::{self, gravity, swing};
use qhat::{
    Body, BodyError, Dimension, Distance, Nail, Particle, ParticleId, Pose, Relation, Settings, Simulation,
    SystemBuilder,
};

/// m, c and Σ m (x − c)(x − c)ᵀ of particles.
fn moments(points: &[[f64; 3]], masses: &[f64]) -> (f64, [f64; 3], [[f64; 3]; 3]) {
    let mass: f64 = masses.iter().sum();
    let sum = |f: &dyn Fn(&[f64; 3]) -> f64| points.iter().zip(masses).map(|(x, m)| m * f(x)).sum::<f64>();
    let c: [f64; 3] = std::array::from_fn(|k| sum(&|x| x[k]) / mass);
    let S = std::array::from_fn(|i| std::array::from_fn(|j| sum(&|x| (x[i] - c[i]) * (x[j] - c[j]))));
    (mass, c, S)
}

fn inertia(S: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let trace = S[0][0] + S[1][1] + S[2][2];
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { trace - S[i][j] } else { -S[i][j] }))
}

/// Tolerance for numbers of order one after some ten roundings.
const ROUNDING: f64 = 1e-14;

fn assert_moments(what: &str, body: &Body, mass: f64, centre: [f64; 3], S: [[f64; 3]; 3]) {
    let found = moments(&body.points, &body.masses);
    assert_close(what, found.0, mass, ROUNDING);
    assert_all_close(what, &found.1, &centre, ROUNDING);
    assert_all_close(what, &body.center(), &centre, ROUNDING);
    assert_all_close(what, found.2.as_flattened(), S.as_flattened(), ROUNDING);
    assert!(body.masses.iter().all(|&m| m > 0.0), "{what}");
}

/// Adds a body to a system.
fn add(builder: &mut SystemBuilder, d: usize, body: &Body, v: [f64; 3], omega: [f64; 3]) -> Vec<ParticleId> {
    let velocities = body.velocities(v, omega);
    let particle = |i: usize| Particle::at(format!("p{i}"), &body.points[i][..d]).with_mass(body.masses[i]);
    let ids: Vec<ParticleId> =
        (0..body.points.len()).map(|i| builder.particle(particle(i).with_velocity(&velocities[i][..d]))).collect();
    for (k, &[a, b]) in body.rods.iter().enumerate() {
        builder.constraint(format!("rod{k}"), Distance::new(ids[a], ids[b], body.length(k)));
    }
    for (k, of) in body.midpoints.iter().enumerate() {
        let [middle, a, b] = of.map(|i| ids[i]);
        builder.constraint(format!("middle{k}"), Relation::midpoint(middle, a, b));
    }
    ids
}

const EDGES: [[f64; 3]; 3] = [[0.9, 0.1, -0.3], [0.2, 0.5, 0.4], [-0.1, 0.3, 0.7]];

/// ∫ u_k² du = 1/12 over |u_k| ≤ ½, and the mixed integrals vanish.
#[test]
fn blocks_have_the_moments_of_what_they_stand_for() {
    let (mass, centre) = (1.7, [0.3, -0.4, 0.5]);
    for count in 1..=3 {
        let body = Body::block(mass, centre, &EDGES[..count]).unwrap();
        let second = |i: usize, j: usize| EDGES[..count].iter().map(|e| mass / 12.0 * e[i] * e[j]).sum();
        let S = std::array::from_fn(|i| std::array::from_fn(|j| second(i, j)));
        assert_moments(&format!("{count} edges"), &body, mass, centre, S);
        assert_eq!(body.points.len(), count + 1);
    }
}

/// The other equimomental set of a triangle: a twelfth of the mass at each corner, the rest at the centre.
#[test]
fn triangle_has_the_moments_of_corners_and_centre() {
    let (mass, [a, b, c]) = (2.3, EDGES);
    let middle = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
    let (_, _, S) = moments(&[a, b, c, middle], &[mass / 12.0, mass / 12.0, mass / 12.0, 0.75 * mass]);
    assert_moments("triangle", &Body::triangle(mass, EDGES).unwrap(), mass, middle, S);
}

#[test]
fn a_bar_in_space_has_its_moments_and_its_ends() {
    let (mass, a) = (1.3, [0.1, 0.2, -0.3]);
    let b = std::array::from_fn(|k| a[k] + EDGES[0][k]);
    let bar = Body::bar_in_space(mass, [a, b]).unwrap();
    let centre = std::array::from_fn(|k| a[k] + 0.5 * EDGES[0][k]);
    let S = std::array::from_fn(|i| std::array::from_fn(|j| mass / 12.0 * EDGES[0][i] * EDGES[0][j]));
    assert_moments("bar", &bar, mass, centre, S);
    assert_eq!(bar.points[..2], [a, b]);
}

#[test]
fn bodies_in_the_plane_have_their_polar_moment() {
    let (mass, length) = (1.3, 0.74_f64.sqrt()); // 0.5² + 0.7²
    let bar = Body::bar_in_plane(mass, [[0.1, 0.2], [0.6, 0.9]]).unwrap();
    let (m, centre, S) = moments(&bar.points, &bar.masses);
    assert_close("mass", m, mass, ROUNDING);
    assert_all_close("centre", &centre, &[0.35, 0.55, 0.0], ROUNDING);
    assert_close("m L²/12", S[0][0] + S[1][1], mass * length * length / 12.0, ROUNDING);
    assert_all_close("end", &bar.points[1][..2], &[0.6, 0.9], 0.0);

    let body = Body::in_plane(mass, [0.3, -0.2], 0.4).unwrap();
    assert_moments("in the plane", &body, mass, [0.3, -0.2, 0.0], [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0; 3]]);
}

/// A body made from the inertia tensor of a cloud of particles has this tensor; a cloud in a line or a plane gives a
/// thin body.
#[test]
fn a_body_from_an_inertia_tensor_has_it() {
    let cloud = [[0.1, 0.7, -0.2], [0.9, -0.3, 0.4], [-0.6, 0.2, 0.8], [0.3, 0.3, -0.9], [-0.5, -0.4, 0.1]];
    let weights = [0.2, 0.7, 0.4, 0.3, 0.5];
    for count in 2..=5 {
        let (mass, centre, S) = moments(&cloud[..count], &weights[..count]);
        let body = Body::from_inertia(mass, centre, inertia(S)).unwrap();
        assert_moments(&format!("{count} particles"), &body, mass, centre, S);
        assert_eq!(body.points.len(), count.min(4));
    }
    let ball = Body::from_inertia(3.0, [0.0; 3], [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]]).unwrap();
    assert_moments("ball", &ball, 3.0, [0.0; 3], [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]]);
}

#[test]
fn moments_that_no_body_has_are_refused() {
    let diagonal = |a, b, c| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
    let from = |tensor| Body::from_inertia(1.0, [0.0; 3], tensor);
    assert_eq!(from(diagonal(1.0, 1.0, 2.1)), Err(BodyError::Inertia));
    assert_eq!(from(diagonal(-1.0, 1.0, 1.0)), Err(BodyError::Inertia));
    assert_eq!(from([[1.0, 0.9, 0.9], [0.9, 1.0, 0.9], [0.9, 0.9, 1.0]]), Err(BodyError::Inertia));
    assert_eq!(from(diagonal(0.0, 0.0, 0.0)), Err(BodyError::NoExtent));
    assert_eq!(from([[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), Err(BodyError::NotSymmetric));
    assert_eq!(from(diagonal(f64::NAN, 1.0, 1.0)), Err(BodyError::NotFinite));
    assert_eq!(from(diagonal(1.0, 1.0, 2.0)).unwrap().points.len(), 3, "a plate");
    for mass in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(Body::block(mass, [0.0; 3], &EDGES), Err(BodyError::Mass(mass)));
    }
    assert_eq!(Body::block(1.0, [0.0; 3], &[]), Err(BodyError::EdgeCount(0)));
    assert_eq!(Body::block(1.0, [0.0; 3], &[[0.0; 3]]), Err(BodyError::FlatEdges));
    assert_eq!(Body::block(1.0, [0.0; 3], &[EDGES[0], EDGES[0]]), Err(BodyError::FlatEdges));
    assert_eq!(Body::triangle(1.0, [EDGES[0], EDGES[1], EDGES[0]]), Err(BodyError::FlatEdges));
    assert_eq!(Body::bar_in_plane(1.0, [[1.0, 2.0]; 2]), Err(BodyError::Lost));
    assert_eq!(Body::bar_in_space(1.0, [EDGES[0]; 2]), Err(BodyError::Lost));
    assert_eq!(Body::bar_in_space(0.0, [EDGES[0], EDGES[1]]), Err(BodyError::Mass(0.0)));
    assert_eq!(Body::in_plane(1.0, [0.0; 2], 0.0), Err(BodyError::NoExtent));
    assert_eq!(Body::in_plane(1.0, [1.0; 2], 1e-40), Err(BodyError::Lost));
}

/// Degrees of freedom: 3 in the plane, 6 in space, 5 for a line in space. No row depends on the others.
#[test]
fn rods_hold_a_body_and_none_repeats_another() {
    let block = |count| Body::block(1.0, [0.0; 3], &EDGES[..count]).unwrap();
    let flat = Body::in_plane(1.0, [0.0; 2], 0.1).unwrap();
    let bar = Body::bar_in_plane(1.0, [[0.0, 0.0], [1.0, 0.0]]).unwrap();
    for (dimension, body, freedom) in [
        (Dimension::Three, block(1), 5),
        (Dimension::Three, block(2), 6),
        (Dimension::Three, block(3), 6),
        (Dimension::Three, Body::triangle(1.0, EDGES).unwrap(), 6),
        (Dimension::Three, Body::bar_in_space(1.0, [EDGES[0], EDGES[1]]).unwrap(), 5),
        (Dimension::Two, flat, 3),
        (Dimension::Two, bar, 3),
    ] {
        let mut builder = qhat::System::builder(dimension);
        add(&mut builder, dimension.number(), &body, [0.0; 3], [0.0; 3]);
        let (system, state) = builder.build().unwrap();
        let rank = qhat::evaluate(&system, &state).rank.unwrap();
        assert_eq!(rank, body.rods.len() + dimension.number() * body.midpoints.len());
        assert_eq!(system.coordinate_count() - rank, freedom);
    }
}

fn accurate() -> Settings {
    Settings {
        integrator: qhat::Integrator::Dop853,
        tolerance: 1e-10,
        constraint_tolerance: 1e-13,
        ..Settings::default()
    }
}

/// A uniform rod hung at its end swings as a mathematical pendulum of the length I/(m L/2) = 2L/3.
#[test]
fn long_compound_pendulum_swings_as_one_of_two_thirds_its_length() {
    let length = 1.2;
    for amplitude in [1e-3, 1.0, 2.5] {
        let end = [-length * libm::sin(amplitude), -length * libm::cos(amplitude)];
        let period = swing::period(2.0 / 3.0 * length, amplitude);
        let in_plane = Body::bar_in_plane(0.7, [[0.0, 0.0], end]).unwrap();
        let in_space = Body::bar_in_space(0.7, [[0.0; 3], [end[0], end[1], 0.0]]).unwrap();
        for (dimension, bar) in [(Dimension::Two, in_plane), (Dimension::Three, in_space)] {
            let mut builder = qhat::System::builder(dimension);
            let ids = add(&mut builder, dimension.number(), &bar, [0.0; 3], [0.0; 3]);
            builder.with_constraint("hinge", Nail::new(ids[0], [0.0; 3])).force(gravity());
            let (system, state) = builder.build().unwrap();
            let simulation = Simulation::new(system, state, accurate()).unwrap();
            // The tolerance of a substep; the errors do not add up in one direction. Measured: 5e-12.
            assert_close("period", swing::measured(simulation, dimension.number(), 5), period, 1e-10 * period);
        }
        if amplitude < 0.01 {
            // Small swings: 2π √(2L/3g), short of the elliptic integral by θ₀²/16.
            let small = 2.0 * std::f64::consts::PI * (2.0 * length / (3.0 * systems::G)).sqrt();
            assert_close("small swings", period, small, 1e-7 * small);
        }
    }
}

type Matrix = [[f64; 3]; 3];

/// Euler's equations in the body's principal axes, I ω̇ = (I ω) × ω, and Ṙ = R [ω]×: (R, ω)˙.
fn euler((R, w): (Matrix, [f64; 3]), I: [f64; 3]) -> (Matrix, [f64; 3]) {
    let turning =
        [(I[1] - I[2]) / I[0] * w[1] * w[2], (I[2] - I[0]) / I[1] * w[2] * w[0], (I[0] - I[1]) / I[2] * w[0] * w[1]];
    let row = |r: [f64; 3]| [r[1] * w[2] - r[2] * w[1], r[2] * w[0] - r[0] * w[2], r[0] * w[1] - r[1] * w[0]];
    (R.map(row), turning)
}

/// One step of the classical Runge–Kutta method.
fn rk4(y: (Matrix, [f64; 3]), I: [f64; 3], h: f64) -> (Matrix, [f64; 3]) {
    let along = |s: f64, k: (Matrix, [f64; 3])| {
        let R = std::array::from_fn(|i| std::array::from_fn(|j| y.0[i][j] + s * k.0[i][j]));
        (R, std::array::from_fn(|j| y.1[j] + s * k.1[j]))
    };
    let k1 = euler(y, I);
    let k2 = euler(along(0.5 * h, k1), I);
    let k3 = euler(along(0.5 * h, k2), I);
    let k4 = euler(along(h, k3), I);
    let mean = |a: f64, b: f64, c: f64, d: f64| (a + 2.0 * b + 2.0 * c + d) / 6.0;
    let R = std::array::from_fn(|i| std::array::from_fn(|j| mean(k1.0[i][j], k2.0[i][j], k3.0[i][j], k4.0[i][j])));
    along(h, (R, std::array::from_fn(|j| mean(k1.1[j], k2.1[j], k3.1[j], k4.1[j]))))
}

/// Spun about its middle axis a free body turns over, again and again.
#[test]
fn a_free_body_tumbles_as_euler_says() {
    let (I, omega, duration) = ([1.0, 2.0, 2.5], [0.01, 6.0, 0.0], 10.0);
    let tensor = [[I[0], 0.0, 0.0], [0.0, I[1], 0.0], [0.0, 0.0, I[2]]];
    let body = Body::from_inertia(3.0, [0.0; 3], tensor).unwrap();
    let mut builder = qhat::System::builder(Dimension::Three);
    add(&mut builder, 3, &body, [0.0; 3], omega);
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, accurate()).unwrap();
    let momentum = |simulation: &Simulation| {
        let (q, qd) = (simulation.state().positions(), simulation.state().velocities());
        let mut sum = [0.0; 3];
        for (i, m) in body.masses.iter().enumerate() {
            let (x, v) = (&q[3 * i..], &qd[3 * i..]);
            let moment = [x[1] * v[2] - x[2] * v[1], x[2] * v[0] - x[0] * v[2], x[0] * v[1] - x[1] * v[0]];
            (0..3).for_each(|k| sum[k] += m * moment[k]);
        }
        sum
    };
    let start = momentum(&simulation);
    assert_all_close("angular momentum", &start, &[I[0] * omega[0], I[1] * omega[1], I[2] * omega[2]], 1e-13);
    let energy = 0.5 * (0..3).map(|k| I[k] * omega[k] * omega[k]).sum::<f64>();
    assert_close("energy", simulation.energy().kinetic, energy, 1e-12);

    let mut exact = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], omega);
    let h = simulation.settings().h;
    let (mut flips, mut upright) = (0, true);
    for _ in 0..(duration / h).round() as usize {
        simulation.step().unwrap();
        // 6 rad/s in steps of 0.1 ms: (hω)⁴/120 of a radian for each of 60 rad, 1e-13.
        (0..100).for_each(|_| exact = rk4(exact, I, h / 100.0));
        if (exact.1[1] > 0.0) != upright {
            (flips, upright) = (flips + 1, !upright);
        }
        let (R, _) = exact;
        for (i, x) in body.points.iter().enumerate() {
            let expected: [f64; 3] = std::array::from_fn(|k| R[k][0] * x[0] + R[k][1] * x[1] + R[k][2] * x[2]);
            // The tolerance of 1e-10 a substep, grown by the instability of the middle axis: its rate is ω √((I₂ −
            // I₁)(I₃ − I₂)/(I₁ I₃)) = 2.7/s from a lean of 0.002 until it has turned over, e⁶. Measured: 4e-10.
            assert_all_close("place", &simulation.state().positions()[3 * i..][..3], &expected, 1e-8);
        }
        assert_all_close("angular momentum", &momentum(&simulation), &start, 1e-11);
    }
    assert!(flips >= 2, "{flips}");
    // Each projection keeps both to 1e-13, the tolerance of the rods.
    assert!(simulation.energy_error_max() < 1e-11, "{:e}", simulation.energy_error_max());
}

/// A vector turned by a unit quaternion: x + 2 w (u × x) + 2 u × (u × x).
fn turned([w, u @ ..]: [f64; 4], x: [f64; 3]) -> [f64; 3] {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let once = cross(u, x);
    let twice = cross(u, once);
    std::array::from_fn(|k| x[k] + 2.0 * w * once[k] + 2.0 * twice[k])
}

/// The pose of every shape of body after turns about axes without a pattern, half turns among them: the turn takes each
/// particle to where it is, and the spin is the one that it was given.
#[test]
fn poses_are_the_turns_and_spins_that_bodies_were_given() {
    let bodies = [
        Body::block(1.7, [0.3, -0.4, 0.5], &EDGES).unwrap(),
        Body::block(1.7, [0.3, -0.4, 0.5], &EDGES[..2]).unwrap(),
        Body::block(1.7, [0.3, -0.4, 0.5], &EDGES[..1]).unwrap(),
        Body::bar_in_space(1.2, [[0.1, 0.2, 0.3], [1.0, -0.5, 0.4]]).unwrap(),
    ];
    let (v, shift) = ([0.2, -0.7, 0.4], [5.0, -3.0, 2.0]);
    for (which, body) in bodies.iter().enumerate() {
        for k in 0..40 {
            let axis = [0.3 + 0.1 * k as f64, -0.8, 0.02 * (k * k) as f64];
            let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            // Multiples of an eighth of a turn, up to one and a quarter.
            let (sine, cosine) = libm::sincos(std::f64::consts::PI / 8.0 * (k % 11) as f64);
            let turn = [cosine, sine * axis[0] / length, sine * axis[1] / length, sine * axis[2] / length];
            let moved = Body {
                points: body.points.iter().map(|&x| std::array::from_fn(|k| turned(turn, x)[k] + shift[k])).collect(),
                ..body.clone()
            };
            let omega = [1.5, -0.4, 2.5];
            let pose = Pose::new(&body.masses, &body.points, &moved.points, &moved.velocities(v, omega));
            let what = format!("body {which}, turn {k}");
            assert_all_close(&what, &pose.center, &moved.center(), ROUNDING * 10.0);
            assert_all_close(&what, &pose.velocity, &v, ROUNDING);
            let before = body.center();
            for (&from, &to) in body.points.iter().zip(&moved.points) {
                let offset = std::array::from_fn(|k| from[k] - before[k]);
                let expected: [f64; 3] = std::array::from_fn(|k| to[k] - pose.center[k]);
                // Frames of directions lose a digit or two in the shortest side of the body.
                assert_all_close(&what, &turned(pose.rotation, offset), &expected, 1e-13);
            }
            let (_, _, S) = moments(&moved.points, &body.masses);
            let I = inertia(S);
            let L: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| I[i][j] * omega[j]).sum());
            assert_all_close(&what, &pose.angular_momentum, &L, 1e-13);
            if which < 2 {
                assert_all_close(&what, &pose.spin, &omega, 1e-12);
            } else {
                // Of a body in one line the part of ω along the line has no meaning.
                let back: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| I[i][j] * pose.spin[j]).sum());
                assert_all_close(&what, &back, &L, 1e-13);
            }
        }
    }
    // In the plane the angle counts from −π to π, half turns of bars included.
    let bar = Body::block(1.0, [0.0; 3], &[[2.0, 0.0, 0.0]]).unwrap();
    for (angle, expected) in
        [(3.0, 3.0), (4.0, 4.0 - std::f64::consts::TAU), (std::f64::consts::PI, std::f64::consts::PI)]
    {
        let (sine, cosine) = libm::sincos(angle);
        let points: Vec<[f64; 3]> = bar.points.iter().map(|x| [cosine * x[0], sine * x[0], 0.0]).collect();
        let found = Pose::new(&bar.masses, &bar.points, &points, &bar.points).angle();
        assert!(
            (found - expected).abs() < 1e-14 || (found + expected).abs() < 1e-14 && angle == std::f64::consts::PI,
            "{found} {expected}"
        );
    }
}

/// The moment of inertia of a thin body about itself, 1e-10 of the others, hardly tells its spin; its velocities do.
#[test]
fn a_thin_body_spins_about_itself() {
    let body = Body::block(1.0, [0.0; 3], &[[1.0, 0.0, 0.0], [0.0, 1e-5, 0.0], [0.0, 0.0, 1e-5]]).unwrap();
    let omega = [30.0, 0.1, 0.2];
    let velocities = body.velocities([0.0; 3], omega);
    let pose = Pose::new(&body.masses, &body.points, &body.points, &velocities);
    // Velocities of 0.1 m/s are rounded to 1e-17 m/s, over 1e-5 m; a hundred such roundings.
    assert_all_close("spin", &pose.spin, &omega, 1e-10);
}
