//! Closed forms of gears and clusters. The closed forms of pulleys, motors and ratios are in the shipped scenes.

use crate::systems::random::Random;
use crate::systems::settings;
use qhat::{Dimension, Distance, Gears, Integrator, Particle, Simulation, System, evaluate, rigid_rods};

fn unit(angle: f64) -> [f64; 2] {
    [libm::cos(angle), libm::sin(angle)]
}

/// A fixed sun of 30 teeth, a carrier, and a planet of 15 teeth. By Willis, (ω_planet − ω_carrier) 15 = (ω_carrier − 0)
/// 30, so the planet turns three times for each turn of the carrier. Without a force the carrier keeps its speed.
#[test]
fn a_planet_turns_three_times_a_turn_of_its_carrier() {
    let mut builder = System::builder(Dimension::Two);
    let sun = builder.particle(Particle::at("sun", [0.0, 0.0]).fixed());
    let mark = builder.particle(Particle::at("mark", [1.0, 0.0]).fixed());
    let planet = builder.particle(Particle::at("planet", [1.5, 0.0]).with_velocity([0.0, 1.5]));
    // Two points opposite each other, so that the planet is balanced.
    let one = builder.particle(Particle::at("one", [2.0, 0.0]).with_velocity([0.0, 3.0]));
    let other = builder.particle(Particle::at("other", [1.0, 0.0]).with_velocity([0.0, 0.0]));
    builder.constraint("carrier", Distance::new(sun, planet, 1.5));
    builder
        .with_constraint("spoke", Distance::new(planet, one, 0.5))
        .constraint("across", Distance::new(planet, other, 0.5));
    builder.constraint("straight", qhat::Relation::midpoint(planet, one, other));
    let gears = Gears::mesh([[sun, mark], [planet, one]], [30, 15], 0.0);
    let start =
        qhat::Constraint::from(gears).residual(Dimension::Two, &[0.0, 0.0, 1.0, 0.0, 1.5, 0.0, 2.0, 0.0, 1.0, 0.0]);
    builder.constraint("mesh", Gears::mesh([[sun, mark], [planet, one]], [30, 15], start[0]));
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, settings(Integrator::Dop853, 0.01)).unwrap();
    // A little more than five turns of the carrier and fifteen of the planet.
    let duration = 32.0;
    for _ in 0..3200 {
        simulation.step().unwrap();
    }
    let q = simulation.state().positions();
    let (carrier, spoke) = (unit(duration), unit(3.0 * duration));
    for k in 0..2 {
        // Errors of the speeds from projections to 1e-10 of a length, over 32 s.
        assert!((q[4 + k] - 1.5 * carrier[k]).abs() < 1e-7, "{q:?}");
        assert!((q[6 + k] - q[4 + k] - 0.5 * spoke[k]).abs() < 1e-7, "{q:?}");
    }
}

/// Random clusters are held by the fewest rods: their number of degrees of freedom minus that number for a rigid body,
/// all rods independent.
#[test]
fn clusters_take_the_fewest_rods_and_hold() {
    let mut random = Random::new(9);
    for (dimension, d) in [(Dimension::Two, 2), (Dimension::Three, 3)] {
        let rigid = d * (d + 1) / 2;
        for n in d + 1..12 {
            let points = random.points(n, d, 0.3);
            let raised: Vec<[f64; 3]> =
                points.iter().map(|x| std::array::from_fn(|k| x.get(k).copied().unwrap_or(0.0))).collect();
            let rods = rigid_rods(dimension, &raised).unwrap();
            assert_eq!(rods.len(), d * n - rigid, "{n} particles in {d} dimensions");
            let mut builder = System::builder(dimension);
            for (i, x) in points.iter().enumerate() {
                builder.particle(Particle::at(format!("p{i}"), x.clone()));
            }
            for (k, &[a, b]) in rods.iter().enumerate() {
                let square = |k: usize| (raised[a][k] - raised[b][k]) * (raised[a][k] - raised[b][k]);
                let length = (square(0) + square(1) + square(2)).sqrt();
                builder
                    .constraint(format!("rod{k}"), Distance::new(crate::systems::id(a), crate::systems::id(b), length));
            }
            let (system, state) = builder.build().unwrap();
            assert_eq!(evaluate(&system, &state).rank, Some(rods.len()), "none is superfluous");
        }
    }
    let line = [[0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]];
    assert!(rigid_rods(Dimension::Two, &line).unwrap_err().to_string().contains("one line"));
    assert!(rigid_rods(Dimension::Three, &line).unwrap_err().to_string().contains("one line"));
    assert_eq!(rigid_rods(Dimension::Three, &line[..2]).unwrap().len(), 1);
    assert!(rigid_rods(Dimension::Two, &line[..1]).unwrap_err().to_string().contains("two particles"));
    assert!(rigid_rods(Dimension::Two, &[[1.0; 3]; 3]).unwrap_err().to_string().contains("same place"));
    let twice = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(rigid_rods(Dimension::Two, &twice).unwrap_err().to_string().contains("same place"));
}
