//! Systems that several tests share, built through the public interface.
#![allow(unreachable_pub, reason = "a module of a test crate, which is its whole world")]

pub mod dense;
pub mod open_chains;
pub mod random;
pub mod swing;

use std::sync::LazyLock;

use qhat::{Dimension, Distance, Feedback, Gravity, Integrator, Nail, Particle, ParticleId, Settings, State, System};

pub const G: f64 = 9.81;

/// More particles than any test names by place.
const MOST_IDS: usize = 20_000;

/// The id of the particle at a place, the same in every system with that many particles.
pub fn id(place: usize) -> ParticleId {
    static IDS: LazyLock<Vec<ParticleId>> = LazyLock::new(|| {
        let mut builder = System::builder(Dimension::Two);
        (0..MOST_IDS).map(|i| builder.particle(Particle::at(i.to_string(), [0.0; 2]))).collect()
    });
    IDS[place]
}

/// A frame of a page [s].
pub const FRAME: f64 = 1.0 / 60.0;

/// The factor by which `make fuzz` increases the number of random cases, from QHAT_FUZZ; 1 without it.
pub fn fuzz() -> u64 {
    std::env::var("QHAT_FUZZ").map_or(1, |times| times.parse().expect("QHAT_FUZZ is a whole number"))
}

pub fn gravity() -> Gravity {
    Gravity { acceleration: [0.0, -G, 0.0] }
}

pub fn settings(integrator: Integrator, h: f64) -> Settings {
    Settings { integrator, h, ..Settings::default() }
}

/// A bob of 2 kg on a rod of length 1 m, `angle` from straight down [rad], at rest.
pub fn pendulum(angle: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [libm::sin(angle), -libm::cos(angle)]).with_mass(2.0));
    builder.with_constraint("rod", Distance::new(pivot, bob, 1.0)).force(gravity());
    builder.build().unwrap()
}

/// Two bobs, released from horizontal with a kink.
pub fn double_pendulum() -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let elbow = builder.particle(Particle::at("elbow", [1.0, 0.0]));
    let tip = builder.particle(Particle::at("tip", [1.6, 0.8]).with_mass(0.5));
    builder
        .with_constraint("upper", Distance::new(pivot, elbow, 1.0))
        .constraint("lower", Distance::new(elbow, tip, 1.0));
    builder.force(gravity());
    builder.build().unwrap()
}

/// `links` links of 0.01 m and 0.01 kg, horizontal, hung from one end; the last bead `heavy` times heavier.
pub fn chain(links: usize, heavy: f64) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let mut last = builder.particle(Particle::at("p0", [0.0, 0.0]).fixed());
    for i in 1..=links {
        let mass = if i == links { 0.01 * heavy } else { 0.01 };
        let next = builder.particle(Particle::at(format!("p{i}"), [0.01 * i as f64, 0.0]).with_mass(mass));
        builder.constraint(format!("p{}-p{i}", i - 1), Distance::new(last, next, 0.01));
        last = next;
    }
    builder.force(gravity());
    builder.build().unwrap()
}

/// The given number of chains of `links` links of 0.01 m and 0.01 kg, each hung from its own point, at all angles.
pub fn chains(count: usize, links: usize) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    for k in 0..count {
        let angle = k as f64;
        let step = [0.01 * libm::cos(angle), 0.01 * libm::sin(angle)];
        let mut before = builder.particle(Particle::at(format!("{k}"), [k as f64, 0.0]).fixed());
        for i in 1..=links {
            let at = [k as f64 + i as f64 * step[0], i as f64 * step[1]];
            let bead = builder.particle(Particle::at(format!("{k}-{i}"), at).with_mass(0.01));
            builder.constraint(format!("rod {k}-{i}"), Distance::new(before, bead, 0.01));
            before = bead;
        }
    }
    builder.force(gravity());
    builder.build().unwrap()
}

/// n × n particles of a net in 3D, two corners nailed, the start a little slack so that it is regular.
pub fn net(n: usize) -> (System, State) {
    let mut builder = System::builder(Dimension::Three);
    let at = |i: usize, j: usize| {
        let (x, y) = (j as f64 * 0.1, -(i as f64) * 0.1);
        [x, y, 0.03 * libm::sin(0.7 * i as f64 + 0.3) * libm::cos(0.5 * j as f64)]
    };
    for i in 0..n {
        for j in 0..n {
            builder.particle(Particle::at(format!("p{i}_{j}"), at(i, j)).with_mass(0.01));
        }
    }
    let id = |i: usize, j: usize| id(i * n + j);
    let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
    for i in 0..n {
        for j in 0..n {
            if j + 1 < n {
                let r = distance(at(i, j), at(i, j + 1));
                builder.constraint(format!("h{i}_{j}"), Distance::new(id(i, j), id(i, j + 1), r));
            }
            if i + 1 < n {
                let r = distance(at(i, j), at(i + 1, j));
                builder.constraint(format!("v{i}_{j}"), Distance::new(id(i, j), id(i + 1, j), r));
            }
        }
    }
    builder
        .with_constraint("left", Nail::new(id(0, 0), at(0, 0)))
        .constraint("right", Nail::new(id(0, n - 1), at(0, n - 1)));
    builder.force(Gravity { acceleration: [0.0, -G, 1.0] });
    builder.build().unwrap()
}

/// A Warren truss of equilateral triangles with `panels` panels of 1 m, held at both ends of its bottom chord: on a pin
/// and on a roller that a vertical rod of 1 m carries. `braced` adds one redundant rod.
pub fn truss(panels: usize, braced: bool) -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let height = 0.75_f64.sqrt();
    let mut at = Vec::new();
    for i in 0..=2 * panels {
        at.push([0.5 * i as f64, if i % 2 == 0 { 0.0 } else { height }]);
    }
    let ids: Vec<ParticleId> = at
        .iter()
        .enumerate()
        .map(|(i, x)| builder.particle(Particle::at(format!("n{i}"), *x).with_mass(5.0)))
        .collect();
    let ground = builder.particle(Particle::at("ground", [panels as f64, -1.0]).fixed());
    let mut rod = |a: usize, b: usize| {
        let d = [at[a][0] - at[b][0], at[a][1] - at[b][1]];
        let r = (d[0] * d[0] + d[1] * d[1]).sqrt();
        builder.constraint(format!("n{a}-n{b}"), Distance::new(ids[a], ids[b], r));
    };
    for i in 0..2 * panels {
        rod(i, i + 1);
        if i + 2 <= 2 * panels {
            rod(i, i + 2);
        }
    }
    if braced {
        rod(0, 3);
    }
    builder.constraint("pin", Nail::new(ids[0], [0.0; 3]));
    builder.constraint("roller", Distance::new(ids[2 * panels], ground, 1.0));
    builder.force(gravity());
    builder.build().unwrap()
}

/// A free triangle of rods with a spring to a fourth particle, spinning, without gravity.
pub fn free_structure() -> (System, State) {
    let mut builder = System::builder(Dimension::Three);
    let a = builder.particle(Particle::at("a", [0.0, 0.0, 0.0]).with_velocity([0.3, 1.0, -0.2]));
    let b = builder.particle(Particle::at("b", [1.0, 0.0, 0.0]).with_mass(2.0).with_velocity([0.3, -0.5, 0.4]));
    let c = builder.particle(Particle::at("c", [0.0, 1.0, 0.2]).with_mass(0.7).with_velocity([-1.0, 0.0, 0.1]));
    let d = builder.particle(Particle::at("d", [0.2, 0.1, 1.0]).with_velocity([0.0, 0.2, -0.5]));
    builder.constraint("ab", Distance::new(a, b, 1.0));
    builder.constraint("ac", Distance::new(a, c, 1.04_f64.sqrt()));
    builder.constraint("bc", Distance::new(b, c, 2.04_f64.sqrt()));
    builder.force(qhat::Spring { a: c, b: d, stiffness: 20.0, damping: 0.0, rest: 0.8 });
    builder.build().unwrap()
}

/// ks and kd that make the feedback critically damped at rate ω [1/s].
pub fn critical(omega: f64) -> Feedback {
    Feedback { ks: omega * omega, kd: 2.0 * omega, ..Feedback::NONE }
}
