//! The feature `serde`: what goes into JSON comes back the same.
#![cfg(feature = "serde")]

use crate::systems;
use qhat::{Event, EventKind, Feedback, Integrator, Settings, Simulation, StepReport, Warning, evaluate};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

fn comes_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) {
    let text = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
}

#[test]
fn reports_settings_and_energies_come_back() {
    let (system, state) = systems::pendulum(1.0);
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    comes_back(&simulation.step().unwrap());
    comes_back(&simulation.energy());
    comes_back(simulation.settings());
    comes_back(&StepReport::default());
    comes_back(&Feedback { ks: 1.0, elasticity: 0.5, ..Feedback::NONE });
    comes_back(&Warning::NoGradient { rows: vec!["rod".into()] });
    for integrator in Integrator::ALL {
        comes_back(&integrator);
        assert_eq!(serde_json::to_string(&integrator).unwrap(), format!("\"{integrator}\""));
    }
    for (name, integrator) in Integrator::names() {
        assert_eq!(serde_json::from_str::<Integrator>(&format!("\"{name}\"")).unwrap(), integrator);
    }
    let event = r#"{"time":0.5,"constraint":"ground","kind":{"Impact":{"speed":2.0}},"impulse":3.0}"#;
    let event: Event = serde_json::from_str(event).unwrap();
    assert_eq!(event.kind, EventKind::Impact { speed: 2.0 });
    comes_back(&event);
}

/// Settings that are left out keep their defaults, as in scenes.
#[test]
fn settings_may_be_partial() {
    let settings: Settings = serde_json::from_str(r#"{"h":0.002,"integrator":"backward-euler"}"#).unwrap();
    assert_eq!(settings, Settings { h: 0.002, integrator: Integrator::Implicit, ..Settings::default() });
}

#[test]
fn terms_can_be_written() {
    let (system, state) = systems::pendulum(0.0);
    let terms = serde_json::to_value(evaluate(&system, &state)).unwrap();
    // C is |d| − r, and d points from the bob up to the pivot: the gradient is (0, 1) there, and −(0, 1) on the bob.
    assert_eq!(terms["jacobian"], serde_json::json!([[[0, [0.0, 1.0]], [1, [0.0, -1.0]]]]));
    assert_eq!(terms["constraint_matrix"], serde_json::json!([[[0, 0.5]]]));
}
