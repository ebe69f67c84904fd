//! Chains and frames at rest against statics: every tension has a closed form.

use crate::systems::dense::{assert_close, largest};
use crate::systems::{self, G};
use qhat::{Dimension, Distance, Integrator, Particle, Simulation, State, System, evaluate};

/// Masses of all sizes hung below each other, and the tension of every link: the weight below it.
fn hanging(links: usize, dimension: Dimension) -> (System, State, Vec<f64>) {
    let d = dimension.number();
    let place = |y: f64| if d == 2 { vec![0.3, y] } else { vec![0.3, y, -0.2] };
    let mut builder = System::builder(dimension);
    let mut last = builder.particle(Particle::at("p0", place(0.0)).fixed());
    let mut masses = Vec::new();
    for i in 1..=links {
        masses.push(0.01 * (1 + i * i % 7) as f64 * if i == links { 100.0 } else { 1.0 });
        let next = Particle::at(format!("p{i}"), place(-0.1 * i as f64)).with_mass(masses[i - 1]);
        let next = builder.particle(next);
        builder.constraint(format!("link{i}"), Distance::new(last, next, 0.1));
        last = next;
    }
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let below = (0..links).map(|k| G * masses[k..].iter().sum::<f64>()).collect();
    (system, state, below)
}

#[test]
fn tension_of_a_hanging_chain_is_the_weight_below() {
    for dimension in [Dimension::Two, Dimension::Three] {
        for links in [1, 2, 24, 25, 300] {
            let (system, state, below) = hanging(links, dimension);
            let tension = evaluate(&system, &state).tension;
            for (k, (tension, weight)) in tension.iter().zip(&below).enumerate() {
                // Links are of 0.1 m to roundoff only; the sum of up to 300 weights rounds as well.
                assert_close(&format!("link {}", k + 1), *tension, *weight, 1e-12 * weight);
            }
        }
    }
}

#[test]
fn a_hanging_chain_stays_at_rest() {
    for integrator in Integrator::ALL {
        let (system, state, below) = hanging(40, Dimension::Two);
        let start = state.positions().to_vec();
        // Fixed steps of 0.1 ms are stable: the fastest wave of the chain has some 1000 rad/s.
        let h = if integrator.is_adaptive() { 1.0 / 60.0 } else { 1e-4 };
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, h)).unwrap();
        for _ in 0..if integrator.is_adaptive() { 60 } else { 1000 } {
            simulation.step().unwrap();
        }
        let moved: Vec<f64> = simulation.state().positions().iter().zip(&start).map(|(a, b)| a - b).collect();
        // Roundoff of the weight of 40 links, integrated for up to a second: far below the resolution of a plot.
        assert!(largest(&moved) < 1e-10, "{integrator}: moved by {:e}", largest(&moved));
        for (tension, weight) in simulation.tension().iter().zip(&below) {
            assert_close(&format!("tension under {integrator}"), *tension, *weight, 1e-8 * weight);
        }
    }
}

/// A chain whose equal weights hang at equal spacings is the parabola of a suspension bridge: the slope grows by m g/H
/// from link to link, and link k carries H √(1 + slope²).
#[test]
fn funicular_chain_is_in_equilibrium() {
    const LINKS: usize = 30;
    let (spacing, mass, pull) = (0.2, 0.5, 40.0);
    let slope = |k: usize| mass * G / pull * (k as f64 - 0.5 * (LINKS as f64 - 1.0));
    let mut builder = System::builder(Dimension::Two);
    let mut y = 0.0;
    let mut last = builder.particle(Particle::at("left", [0.0, 0.0]).fixed());
    for k in 0..LINKS {
        y += slope(k) * spacing;
        let particle = Particle::at(format!("p{k}"), [spacing * (k + 1) as f64, y]).with_mass(mass);
        let next = builder.particle(if k + 1 == LINKS { particle.fixed() } else { particle });
        builder.constraint(format!("link{k}"), Distance::new(last, next, spacing * (1.0 + slope(k) * slope(k)).sqrt()));
        last = next;
    }
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let terms = evaluate(&system, &state);
    for (k, tension) in terms.tension.iter().enumerate() {
        // Coordinates are sums of 30 rounded numbers, and A of a flat chain multiplies by about 1e3.
        assert_close("tension", *tension, pull * (1.0 + slope(k) * slope(k)).sqrt(), 1e-11 * pull);
    }
    assert!(largest(&terms.accelerations) < 1e-11 * G, "it is at rest");
}

/// A mass on two ropes: T₁ = m g cos β / sin(α + β), T₂ = m g cos α / sin(α + β), angles above the horizontal.
#[test]
fn a_mass_on_two_ropes() {
    let (alpha, beta, mass): (f64, f64, f64) = (0.5, 1.1, 3.0);
    let mut builder = System::builder(Dimension::Two);
    let left = builder.particle(Particle::at("left", [-libm::cos(alpha), libm::sin(alpha)]).fixed());
    let right = builder.particle(Particle::at("right", [2.0 * libm::cos(beta), 2.0 * libm::sin(beta)]).fixed());
    let load = builder.particle(Particle::at("load", [0.0, 0.0]).with_mass(mass));
    builder
        .with_constraint("left", Distance::new(left, load, 1.0))
        .constraint("right", Distance::new(load, right, 2.0));
    builder.force(systems::gravity());
    let (system, state) = builder.build().unwrap();
    let tension = evaluate(&system, &state).tension;
    let sine = libm::sin(alpha + beta);
    assert_close("left", tension[0], mass * G * libm::cos(beta) / sine, 1e-13 * mass * G);
    assert_close("right", tension[1], mass * G * libm::cos(alpha) / sine, 1e-13 * mass * G);
}

/// A Warren truss of p panels under its own nodes' weight w = m g: the bottom chord by the method of sections. With the
/// supports each carrying half of the load, the moment about the top node of panel i gives T h = M.
#[test]
fn truss_chords_by_the_method_of_sections() {
    let panels = 6;
    let (system, state) = systems::truss(panels, false);
    let terms = evaluate(&system, &state);
    let (w, height) = (5.0 * G, 0.75_f64.sqrt());
    let nodes = 2 * panels + 1;
    let reaction = 0.5 * w * nodes as f64;
    for i in 0..panels {
        // Left of the cut at x: the reaction at 0 and the nodes at 0, ½, 1 … below x.
        let x = i as f64 + 0.5;
        let moment: f64 = (0..nodes).map(|k| 0.5 * k as f64).filter(|at| *at < x).map(|at| w * (x - at)).sum();
        let name = format!("n{}-n{}", 2 * i, 2 * i + 2);
        let rod = system.links().position(|rod| rod.name == name).unwrap();
        // Its conditioning multiplies roundoff by about 1e3.
        assert_close(&name, terms.tension[rod], (reaction * x - moment) / height, 1e-11 * reaction);
    }
}
