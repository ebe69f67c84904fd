//! States and simulations as bytes: what goes on from them has the bits of what did not stop.
#![cfg(feature = "serde")]

use crate::systems;
use qhat::{
    Dimension, Distance, Driven, Gravity, Integrator, Limits, Obstacle, OnSphere, Particle, RestoreError, Settings,
    Simulation, State, Surface, System,
};

/// Systems whose states have contacts in every mode, broken rods, drives, redundant rows, stiff forces.
fn cases() -> Vec<(&'static str, System, State)> {
    let mut cases = vec![("chain", systems::chain(30, 10.0)), ("truss", systems::truss(5, true))];
    let mut builder = System::builder(Dimension::Three);
    let puck = builder.particle(Particle::at("puck", [0.0, 0.0, 0.0]).with_velocity([1.0, 0.5, 0.0]));
    let other = builder.particle(Particle::at("other", [0.3, 0.0, 0.0]).with_velocity([0.0, 0.5, 1.0]));
    for (name, particle) in [("under", puck), ("below", other)] {
        let ground = Obstacle::new(particle, Surface::half_space([0.0, 0.0, 1.0], 0.0));
        builder.constraint(name, ground.with_friction(0.3).with_restitution(0.4));
    }
    builder.constraint("rope", Limits::rope(puck, other, 0.6).breaking_at(40.0).with_restitution(0.2));
    builder.force(Gravity::new([0.0, 0.0, -9.81]));
    cases.push(("pucks", builder.build().unwrap()));
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [1.0, 0.0]));
    let load = builder.particle(Particle::at("load", [1.0, -1.0]));
    builder.constraint("driven", OnSphere::new(bob, hook, Driven::text("1 + 0.2*sin(3*t)").unwrap()));
    builder.constraint("weak", Distance::new(bob, load, 1.0).breaking_at(25.0));
    builder.force(Gravity::new([0.0, -9.81]));
    cases.push(("driven", builder.build().unwrap()));
    // Three joints in a line, which rods hold only to second order: a simulation adds rows.
    let mut builder = System::builder(Dimension::Two);
    let ends = [-1.0, 0.0, 1.0].map(|x| {
        let joint = Particle::at(format!("at {x}"), [x, 0.0]);
        builder.particle(if x == 0.0 { joint.fixed() } else { joint })
    });
    for (name, a, b, length) in [("left", 0, 1, 1.0), ("right", 1, 2, 1.0), ("both", 0, 2, 2.0)] {
        builder.constraint(name, Distance::new(ends[a], ends[b], length));
    }
    builder.force(Gravity::new([0.3, -9.81]));
    cases.push(("lever", builder.build().unwrap()));
    cases.into_iter().map(|(name, (system, state))| (name, system, state)).collect()
}

#[test]
fn a_restored_simulation_goes_on_with_the_same_bits() {
    for integrator in Integrator::ALL {
        let settings = systems::settings(integrator, if integrator.is_adaptive() { 1.0 / 60.0 } else { 2e-4 });
        for (name, system, start) in cases() {
            let Ok(mut simulation) = Simulation::new(system.clone(), start, settings) else {
                assert!(!integrator.finds_events(), "{name} under {integrator}");
                continue;
            };
            simulation.record_tension(true);
            for frame in 0..40 {
                let bytes = simulation.to_bytes();
                let mut restored = Simulation::restore(system.clone(), &bytes).unwrap();
                assert_eq!(restored.to_bytes(), bytes, "{name} under {integrator}, frame {frame}");
                let state = State::from_bytes(&system, &simulation.state().to_bytes(&system)).unwrap();
                assert_eq!(&state, simulation.state());
                let (one, mut other) = (simulation.step(), restored.step());
                if let (Ok(one), Ok(other)) = (&one, &mut other) {
                    // A factor that is at hand need not be computed again; its bits are the same.
                    other.factorizations = one.factorizations;
                }
                assert_eq!(one, other, "{name} under {integrator}, frame {frame}");
                assert_eq!(simulation.to_bytes(), restored.to_bytes(), "{name} under {integrator}, frame {frame}");
                if one.is_err() {
                    break;
                }
            }
        }
    }
}

#[test]
fn bytes_that_do_not_fit_are_refused_in_words() {
    let (system, start) = systems::pendulum(1.0);
    let simulation = Simulation::new(system.clone(), start.clone(), Settings::default()).unwrap();
    let bytes = simulation.to_bytes();
    let refused = |bytes: &[u8]| Simulation::restore(system.clone(), bytes).unwrap_err();
    assert_eq!(refused(b"").to_string(), "these bytes are no simulation that qhat saved");
    assert_eq!(refused(&start.to_bytes(&system)), RestoreError::NotSaved { what: "simulation" });
    let newer = [&bytes[..8], &[9, 0, 0, 0], &bytes[12..]].concat();
    assert_eq!(refused(&newer), RestoreError::Version { found: 9 });
    // Every cut and every changed bit is found.
    for end in 12..bytes.len() {
        assert_eq!(refused(&bytes[..end]), RestoreError::Damaged, "{end}");
    }
    for place in 12..bytes.len() {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place % 8);
        assert_eq!(refused(&changed), RestoreError::Damaged, "{place}");
    }
    let build = |mass: f64, length: f64, g: f64| {
        let mut builder = System::builder(Dimension::Two);
        let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(mass));
        builder.constraint("rod", Distance::new(pivot, bob, length));
        builder.force(Gravity::new([0.0, g]));
        builder.build().unwrap()
    };
    let (system, state) = build(1.0, 1.0, -9.81);
    let bytes = Simulation::new(system, state, Settings::default()).unwrap().to_bytes();
    for ((mass, length, g), part) in
        [((2.0, 1.0, -9.81), "particles"), ((1.0, 1.5, -9.81), "constraints"), ((1.0, 1.0, -1.62), "forces")]
    {
        match Simulation::restore(build(mass, length, g).0, &bytes) {
            Err(RestoreError::Differs { part: found }) => assert_eq!(found, part),
            other => panic!("{part}: {:?}", other.err()),
        }
    }
}
