//! `qhat run`: its files and its messages.

use crate::common::{Folder, INFEASIBLE, PENDULUM, npz};

/// Sums of the same products in another order differ by a few roundings of numbers of this size.
const ROUNDOFF: f64 = 1e-12;

#[test]
fn npz_holds_every_array_in_the_order_of_the_file() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz"]).well();
    let arrays = npz::read(&folder.path("bob.npz"));
    let shape = |name: &str| arrays[name].shape.clone();

    // 0.5 s at h = 0.01 s: 50 frames and the start; 2 particles, the fixed one included; 1 row; 1 rod.
    assert_eq!(shape("t"), [51]);
    for name in ["positions", "velocities", "constraint_forces"] {
        assert_eq!(shape(name), [51, 2, 2], "{name}");
    }
    assert_eq!(shape("multipliers"), [51, 1]);
    assert_eq!(shape("tension"), [51, 1]);
    assert_eq!(arrays["particle_ids"].texts(), ["hook", "bob"]);
    assert_eq!((shape("row_names"), shape("link_names"), shape("origin")), (vec![1], vec![1], vec![]));

    let q = arrays["positions"].numbers();
    assert_eq!(q[..4], [0.0, 0.0, 1.0, 0.0], "the first frame is the start");
    assert!(arrays["t"].numbers().iter().enumerate().all(|(i, &t)| t == i as f64 * 0.5 / 50.0), "t = i · duration / N");
}

#[test]
fn forces_belong_to_the_state_of_their_own_frame() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz"]).well();
    let arrays = npz::read(&folder.path("bob.npz"));
    let numbers = |name: &str| arrays[name].numbers();
    let (q, qd, force, tension) =
        (numbers("positions"), numbers("velocities"), numbers("constraint_forces"), numbers("tension"));
    for frame in 0..51 {
        let [x, y, vx, vy] = [q[4 * frame + 2], q[4 * frame + 3], qd[4 * frame + 2], qd[4 * frame + 3]];
        let r = (x * x + y * y).sqrt();
        // The rod carries the weight along it and the centripetal force: m (v² − g·x)/r with m = 2 kg.
        let expected = 2.0 * ((vx * vx + vy * vy) - 9.81 * y) / r;
        let scale = ROUNDOFF * (1.0 + expected.abs());
        assert!((tension[frame] - expected).abs() <= scale, "frame {frame}: {} N, not {expected} N", tension[frame]);
        assert!((force[4 * frame + 2] + tension[frame] * x / r).abs() <= scale);
        assert!((force[4 * frame + 3] + tension[frame] * y / r).abs() <= scale);
    }
}

#[test]
fn csv_holds_the_same_bits_as_npz() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz"]).well();
    folder.qhat(&["run", "bob.toml", "-o", "bob.csv"]).well();
    let arrays = npz::read(&folder.path("bob.npz"));

    let mut reader = csv::Reader::from_path(folder.path("bob.csv")).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let vectors = ["hook.x", "hook.y", "bob.x", "bob.y", "hook.vx", "hook.vy", "bob.vx", "bob.vy"];
    assert_eq!(header[0], "t");
    assert_eq!(header[1..9], vectors);
    assert_eq!(header[9..13], ["hook.fx", "hook.fy", "bob.fx", "bob.fy"]);
    assert_eq!(header[13], format!("{}.multiplier", arrays["row_names"].texts()[0]));
    assert_eq!(header[14], format!("{}.tension", arrays["link_names"].texts()[0]));

    assert_eq!(header[15], format!("{}.tension_is_unique", arrays["link_names"].texts()[0]));

    let order = ["t", "positions", "velocities", "constraint_forces", "multipliers", "tension", "tension_is_unique"];
    let arrays: Vec<(usize, Vec<f64>)> =
        order.iter().map(|&name| (arrays[name].shape[1..].iter().product(), arrays[name].numbers())).collect();
    let mut frames = 0;
    for (frame, record) in reader.records().enumerate() {
        let line: Vec<f64> = record.unwrap().iter().map(|number| number.parse().unwrap()).collect();
        let expected = arrays.iter().flat_map(|(width, numbers)| &numbers[frame * width..(frame + 1) * width]);
        assert!(line.iter().map(|x| x.to_bits()).eq(expected.map(|x| x.to_bits())), "frame {frame}");
        frames += 1;
    }
    assert_eq!(frames, 51);
}

#[test]
fn names_of_every_language_reach_both_formats() {
    let scene = PENDULUM.replace("kind = \"distance\"", "kind = \"distance\", id = 'стержень-(長い)'");
    let folder = Folder::with(&[("bob.toml", &scene)]);
    for output in ["bob.csv", "bob.npz"] {
        folder.qhat(&["run", "bob.toml", "-o", output, "--frames", "1", "-q"]).well();
    }
    assert!(folder.read("bob.csv").lines().next().unwrap().ends_with(",стержень-(長い).tension_is_unique"));
    assert_eq!(npz::read(&folder.path("bob.npz"))["link_names"].texts(), ["стержень-(長い)"]);
}

#[test]
fn output_tells_its_origin() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz", "--h", "0.005"]).well();
    folder.qhat(&["run", "bob.toml", "-o", "bob.csv", "--h", "0.005"]).well();
    let inside = npz::read(&folder.path("bob.npz"))["origin"].texts().remove(0);
    assert_eq!(folder.read("bob.csv.json").trim_end(), inside, "a CSV has it beside");
    let origin: serde_json::Value = serde_json::from_str(&inside).unwrap();
    assert_eq!(origin["qhat"], env!("CARGO_PKG_VERSION"));
    assert_eq!(origin["status"], "done");
    assert_eq!(origin["scene"], "A bob");
    assert_eq!(origin["file"], "bob.toml");
    assert_eq!(origin["scene_hash"].as_str().unwrap().len(), "sha256:".len() + 64);
    assert_eq!(origin["h"], 0.005);
    for key in ["integrator", "tolerance", "constraint_tolerance", "feedback", "duration", "frames_asked"] {
        assert!(!origin[key].is_null(), "{key}");
    }
}

#[test]
fn two_runs_write_the_same_bytes() {
    let folder = Folder::new();
    for name in ["a.npz", "b.npz"] {
        folder.qhat(&["run", "pendulum", "--duration", "0.2", "-o", name]).well();
    }
    assert!(std::fs::read(folder.path("a.npz")).unwrap() == std::fs::read(folder.path("b.npz")).unwrap());
}

#[test]
fn frames_divide_the_duration() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "a.npz", "--duration", "1", "--frames", "3"]).well();
    assert_eq!(npz::read(&folder.path("a.npz"))["t"].numbers(), [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]);

    let euler = ["run", "bob.toml", "--integrator", "euler", "-o", "c.npz", "--duration", "0.4"];
    folder.qhat(&[&euler[..], &["--frames", "20"]].concat()).well();
    assert_eq!(npz::read(&folder.path("c.npz"))["t"].shape, [21], "two steps of 0.01 s a frame");
    let refused = folder.qhat(&[&euler[..], &["--frames", "30", "--force"]].concat());
    refused.refused("no multiple of the step h = 0.01 s");
    assert_eq!(npz::read(&folder.path("c.npz"))["t"].shape, [21], "and the old file stays");
}

#[test]
fn summary_has_what_scripts_need() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let summary = folder.qhat(&["run", "bob.toml", "--json", "-o", "bob.npz"]).well().json();
    assert_eq!(summary["status"], "done");
    assert_eq!(summary["scene"], "A bob");
    assert_eq!(summary["integrator"], "auto");
    assert_eq!(summary["frames"], 51);
    let carried = serde_json::json!([{ "integrator": "dop853", "solver": "lanes", "frames": 50 }]);
    assert_eq!(summary["carried"], carried, "the start is no frame that was stepped");
    assert!(summary["substeps"].as_u64().unwrap() >= 50);
    assert_eq!(summary["warnings"], serde_json::json!([]));
    assert_eq!(summary["output"], "bob.npz");
    // The documented bound of integrators that project, for the default constraint_tolerance and rods of 1 m.
    assert!(summary["max_residual"].as_f64().unwrap() <= 1e-10);
    assert!(summary["max_relative_length_error"].as_f64().unwrap() <= 1e-10);
    for key in ["wall_seconds", "cpu_seconds", "energy_error", "energy_error_max"] {
        assert!(summary[key].is_f64(), "{key}");
    }
}

#[test]
fn options_replace_the_settings_of_the_scene() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let run = |options: &[&str]| folder.qhat(&[&["run", "bob.toml", "--json"], options].concat()).well().json();
    // Frames of 0.25 s, because one substep covers a frame of 0.01 s at every tolerance.
    let substeps = |tolerance: &str| run(&["--h", "0.25", "--tolerance", tolerance])["substeps"].as_u64().unwrap();
    // DOP853 is of order 8, so that 1e-12 takes far more substeps of this swing than the largest tolerances do.
    assert!(substeps("1e-12") > substeps("1e-2"), "{} substeps, {}", substeps("1e-12"), substeps("1e-2"));
    let backward = run(&["--integrator", "backward-euler"]);
    assert_eq!(backward["integrator"], "implicit");
    let implicit = run(&["--integrator", "implicit"]);
    assert_eq!(backward["energy_error"], implicit["energy_error"], "one integrator under two names");
}

#[test]
fn summary_for_people_is_aligned_and_quiet_says_nothing() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let said = folder.qhat(&["run", "bob.toml"]).well().stdout;
    assert!(said.starts_with("A bob: done\n  simulated    0.5 s, 51 frames\n"), "{said}");
    assert_eq!(folder.qhat(&["run", "bob.toml", "--quiet"]).well().stdout, "");
    assert_eq!(folder.qhat(&["run", "bob.toml", "--quiet", "--json"]).well().json()["status"], "done");
}

#[test]
fn scenes_come_from_stdin_by_name_and_as_json() {
    let folder = Folder::new();
    assert_eq!(folder.qhat_reading(PENDULUM, &["run", "-", "--json"]).well().json()["scene"], "A bob");
    let json = r#" {"schema": "qhat/1", "name": "One", "dimension": 3, "particles": [{"id": "p", "at": [0, 0, 0]}]}"#;
    let ran = folder.qhat_reading(json, &["run", "-", "--duration", "0.1", "-o", "one.npz"]);
    ran.well();
    let arrays = npz::read(&folder.path("one.npz"));
    assert_eq!(arrays["positions"].shape, [11, 1, 3]);
    assert_eq!((arrays["multipliers"].shape[1], arrays["link_names"].shape[0]), (0, 0), "no rows, no links");
    folder.qhat(&["run", "pendulum", "--duration", "0.1"]).well();
    std::fs::create_dir(folder.path("pendulum")).unwrap();
    folder.qhat(&["run", "pendulum", "--duration", "0.1"]).well();
    std::fs::write(folder.path("net"), PENDULUM).unwrap();
    assert_eq!(folder.qhat(&["run", "net", "--json"]).well().json()["scene"], "A bob", "a file wins");
}

#[test]
fn a_diverging_run_keeps_and_marks_what_was_reached() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    // Explicit Euler without feedback diverges with steps of half a second.
    let euler = ["run", "bob.toml", "--integrator", "euler", "--h", "0.5", "--duration", "100", "--json"];
    for output in ["bob.npz", "bob.csv"] {
        let ran = folder.qhat(&[&euler[..], &["-o", output]].concat());
        assert_eq!(ran.code, 1, "{ran:?}");
        assert!(ran.stderr.starts_with("diverged: at t = "), "{}", ran.stderr);
        let summary = ran.json();
        assert_eq!(summary["status"], "diverged");
        let frames = summary["frames"].as_u64().unwrap();
        assert!(1 < frames && frames < 201, "{frames} frames");
    }
    let arrays = npz::read(&folder.path("bob.npz"));
    assert!(arrays["positions"].numbers().iter().all(|x| x.is_finite()));
    let origin = arrays["origin"].texts().remove(0);
    assert!(origin.contains(r#""status":"diverged""#), "{origin}");
    assert_eq!(folder.read("bob.csv.json").trim_end(), origin);
    assert_eq!(folder.read("bob.csv").lines().count(), arrays["t"].shape[0] + 1);
}

#[test]
fn an_infeasible_start_is_marked() {
    let folder = Folder::with(&[("torn.toml", INFEASIBLE)]);
    let ran = folder.qhat(&["run", "torn.toml", "--json", "-o", "torn.npz"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    let summary = ran.json();
    assert_eq!((&summary["status"], &summary["frames"]), (&"infeasible".into(), &1.into()));
    // The rod from b is √(4² + 0.5²) m long where it should be 1 m; three decimals distinguish it from every other rod.
    assert!((summary["max_relative_length_error"].as_f64().unwrap() - 3.031).abs() < 1e-3, "{summary}");
    let arrays = npz::read(&folder.path("torn.npz"));
    assert_eq!(arrays["positions"].numbers(), [0.0, 0.0, 5.0, 0.0, 1.0, 0.5]);
    assert!(arrays["origin"].texts()[0].contains(r#""status":"infeasible""#));
}

/// Two short frames each: long enough for every kind to be stepped and for the summary to be written.
#[test]
fn every_shipped_scene_runs() {
    let folder = Folder::new();
    for scene in folder.qhat(&["scenes", "--json"]).well().json().as_array().unwrap() {
        let name = scene["name"].as_str().unwrap();
        let ran = folder.qhat(&["run", name, "--duration", "0.02", "--frames", "2", "--json"]).well();
        assert!(ran.json().is_object(), "{name}");
    }
}

/// A bob of m kg that hangs at rest pulls with m g, and a bob above its hook pushes with it.
#[test]
fn the_largest_tension_has_four_digits() {
    for (mass, y, tension) in
        [(206.26, -1.0, "2023"), (2.0, -1.0, "19.62"), (0.012_586, -1.0, "0.1235"), (2.0, 1.0, "-19.62")]
    {
        let scene = PENDULUM.replace("at = [1.0, 0.0], mass = 2.0", &format!("at = [0.0, {y:?}], mass = {mass:?}"));
        let folder = Folder::with(&[("bob.toml", &scene)]);
        let summary = folder.qhat(&["run", "bob.toml"]).well().stdout;
        let without = folder.qhat(&["run", "bob.toml", "--no-tension"]).well().stdout;
        assert!(!without.contains("\n  tension"), "--no-tension looks for none:\n{without}");
        let expected = format!("at most {tension} N in ");
        assert!(summary.contains(&expected), "{mass} kg at {y} m: no `{expected}` in\n{summary}");
    }
}

/// A run whose energy is wrong says so before anything else; its warning is told once, with the number of frames.
#[test]
fn energy_that_is_gone_is_said_first() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let damped = ["run", "bob.toml", "--integrator", "implicit", "--h", "0.05", "--duration", "5"];
    let text = folder.qhat(&damped).well().stdout;
    let second = text.lines().nth(1).unwrap_or_default();
    assert!(second.trim_start().starts_with("caution") && second.contains("energy is gone: "), "{text}");
    assert_eq!(text.matches("energy was lost without a cause").count(), 1, "{text}");

    let summary = folder.qhat(&[&damped[..], &["--json"]].concat()).well().json();
    let caution = summary["caution"].as_str().unwrap();
    assert!(
        caution.contains(" % of the largest kinetic energy was lost") && caution.contains("a smaller h"),
        "{caution}"
    );
    let warnings = summary["warnings"].as_array().unwrap();
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(warning.as_str().unwrap().contains(" frames, from t = "), "{warning}");

    let summary = folder.qhat(&["run", "bob.toml", "--json"]).well().json();
    assert!(summary["caution"].is_null(), "{summary}");
}

/// A force that grows without bound ends the run as diverged and names its particle, and no rod.
#[test]
fn a_force_without_bound_is_diverged() {
    let scene = r#"
schema = "qhat/1"
name = "A force that runs away"
dimension = 2
particles = [{ id = "p0", at = [0.0, 0.0] }, { id = "p1", at = [0.0, 1.0] }, { id = "p3", at = [1.0, 1.0] }]
constraints = [{ kind = "distance", between = ["p0", "p1"] }]
loads = [{ kind = "force", particle = "p3", force = ["-2*p3.vy + sin(3*t)", "2*p3.vx - p3.x^3"] }]
"#;
    let folder = Folder::with(&[("wild.toml", scene)]);
    for integrator in ["auto", "dop853", "dopri5", "rattle", "implicit", "bdf2", "rk4", "euler"] {
        // At the default tolerance rattle uses up its substeps before the force has grown so large.
        let ran = folder.qhat(&["run", "wild.toml", "--integrator", integrator, "--tolerance", "1e-4", "-q"]);
        assert_eq!(ran.code, 1, "{integrator}: {}", ran.stderr);
        assert!(
            ran.stderr.starts_with("diverged: at t = ") && ran.stderr.contains("`p3`"),
            "{integrator}: {}",
            ran.stderr
        );
    }
}
