//! `qhat run` on scenes with events: its messages about impacts, slip and breaks.

use crate::common::{BREAKS, Folder, JERKED};

/// A particle that falls 0.2 m in 0.2 s onto ground without restitution.
const LANDS: &str = r#"
schema = "qhat/1"
name = "Lands"
dimension = 2
step = { h = 0.01, duration = 0.5 }
forces = { gravity = [0.0, -10.0] }
particles = [{ id = "ball", at = [0.0, 0.2] }]
constraints = [{ kind = "half-space", id = "ground" }]
"#;

#[test]
fn what_broke_is_told_with_its_name_and_its_time() {
    let folder = Folder::with(&[("breaks.toml", BREAKS)]);
    let summary = folder.qhat(&["run", "breaks.toml", "--json"]).well().json();
    let broke = summary["events"]["broke"].as_array().unwrap();
    assert_eq!(broke.len(), 1, "{broke:?}");
    assert_eq!(broke[0]["constraint"], "arm");
    // ∫ dφ/√(2 g sin φ) from 0 to arcsin 2/3, by Simpson's rule in x = √φ.
    let time = broke[0]["time"].as_f64().unwrap();
    let (pieces, end) = (200, (2.0_f64 / 3.0).asin().sqrt());
    let rate = |x: f64| if x == 0.0 { 2.0 / 20.0_f64.sqrt() } else { 2.0 * x / (20.0 * (x * x).sin()).sqrt() };
    let sum: f64 = (0..=pieces)
        .map(|k| match k {
            0 => rate(0.0),
            k if k == pieces => rate(end),
            k => rate(end * k as f64 / pieces as f64) * if k % 2 == 1 { 4.0 } else { 2.0 },
        })
        .sum();
    let expected = sum * end / (3 * pieces) as f64;
    assert!((time - expected).abs() < 1e-8, "{time} s, expected {expected} s");
    let said = folder.qhat(&["run", "breaks.toml"]).well().stdout;
    assert!(said.contains(&format!("arm broke at t = {expected:.6} s")), "{said}");
}

/// An elastic rod that is let go at its rest length carries m g (1 − cos ω t), with ω² = 1/(α m) = 1000/s².
#[test]
fn an_elastic_rod_breaks_when_its_tension_passes_the_limit() {
    let elastic = BREAKS.replace("at = [1.0, 0.0]", "at = [0.0, -1.0]");
    let elastic = elastic.replace("breaks_at = 20.0", "breaks_at = 15.0, compliance = 1e-3");
    let folder = Folder::with(&[("elastic.toml", &elastic)]);
    let summary = folder.qhat(&["run", "elastic.toml", "--json"]).well().json();
    let broke = &summary["events"]["broke"];
    assert_eq!((broke.as_array().unwrap().len(), broke[0]["constraint"].as_str()), (1, Some("arm")), "{broke}");
    // 1 − cos ω t = 3/2.
    let expected = 2.0 / 3.0 * std::f64::consts::PI / 1000.0_f64.sqrt();
    let time = broke[0]["time"].as_f64().unwrap();
    assert!((time - expected).abs() < 1e-9, "{time} s, expected {expected} s");
}

#[test]
fn a_rope_that_an_impulse_breaks_is_told_with_the_impulse() {
    let folder = Folder::with(&[("jerked.toml", JERKED)]);
    let summary = folder.qhat(&["run", "jerked.toml", "--json"]).well().json();
    let events = &summary["events"];
    let impulse = events["broke"][0]["impulse"].as_f64().unwrap();
    assert!((impulse - 2.0).abs() < 1e-12, "1 kg at 2 m/s, to rounding: {events}");
    assert!(events["largest_impulse"].is_null(), "the rope broke before any impact: {events}");
    let said = folder.qhat(&["run", "jerked.toml"]).well().stdout;
    assert!(said.contains("rope(hook-ball) broke at t = 0.200000 s, by an impulse of 2.0000 N·s"), "{said}");
}

#[test]
fn impacts_are_counted_and_quiet_runs_say_nothing_of_events() {
    let folder = Folder::with(&[("lands.toml", LANDS), ("flies.toml", &LANDS.replace("0.2]", "9.0]"))]);
    let summary = folder.qhat(&["run", "lands.toml", "--json"]).well().json();
    assert_eq!(summary["events"]["impacts"], 1, "{}", summary["events"]);
    assert_eq!(summary["events"]["broke"], serde_json::json!([]));
    let largest = &summary["events"]["largest_impulse"];
    // 1 kg stops from √(2 · 10 m/s² · 0.2 m) = 2 m/s; the impulse is 2 N·s to rounding.
    assert!((largest["impulse"].as_f64().unwrap() - 2.0).abs() < 1e-12, "{largest}");
    assert_eq!(largest["constraint"], "ground(ball)");
    let said = folder.qhat(&["run", "lands.toml"]).well().stdout;
    assert!(said.lines().any(|line| line.contains("events") && line.contains("1 impact")), "{said}");
    let said = folder.qhat(&["run", "flies.toml"]).well().stdout;
    assert!(!said.contains("events"), "{said}");
}
