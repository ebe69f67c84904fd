//! `--select`: the quantities of a trajectory, and the laws that they obey.

use crate::common::npz::{Array, read};
use crate::common::{Folder, JERKED, PENDULUM};
use qhat_scene::shipped;
use std::collections::BTreeMap;

/// Runs every shipped scene for five short frames, and hands its name and the arrays that are selected to a test.
fn for_every_scene(select: &str, test: &dyn Fn(&str, &BTreeMap<String, Array>)) {
    let folder = Folder::new();
    for scene in shipped() {
        let name = scene.name;
        let run = ["run", name, "--quiet", "--no-tension", "--frames", "5", "--duration", "0.05", "--select", select];
        let ran = folder.qhat(&[&run[..], &["-o", "out.npz", "--force"]].concat());
        // Integrators of fixed step take frames of their own.
        if ran.code == 2 && ran.stderr.contains("takes steps of exactly h") {
            continue;
        }
        assert_eq!(ran.code, 0, "{name}: {ran:?}");
        test(name, &read(&folder.path("out.npz")));
    }
}

/// Newton's law from the output alone: m a = applied + constraint forces on every particle that can move, in every
/// frame of every shipped scene, friction included.
#[test]
fn long_forces_of_every_scene_add_up_to_mass_times_acceleration() {
    for_every_scene("accelerations,applied_forces,constraint_forces", &|name, npz| {
        let masses = npz["masses"].numbers();
        let [a, applied, held] = ["accelerations", "applied_forces", "constraint_forces"].map(|it| npz[it].numbers());
        let d = npz["accelerations"].shape[2];
        let size = applied.iter().chain(&held).fold(0.0_f64, |largest, force| largest.max(force.abs()));
        for k in (0..a.len()).filter(|k| masses[k / d % masses.len()].is_finite()) {
            let off = masses[k / d % masses.len()] * a[k] - applied[k] - held[k];
            // Three roundings of numbers of this size.
            assert!(off.abs() <= 1e-12 * size, "{name}: {off:e} N of {size:e} N");
        }
    });
}

#[test]
fn what_is_selected_is_written() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "all.npz", "--select", "all"]).well();
    let npz = read(&folder.path("all.npz"));
    let shapes = [
        ("t", vec![51]),
        ("accelerations", vec![51, 2, 2]),
        ("applied_forces", vec![51, 2, 2]),
        ("residual", vec![51, 1]),
        ("residual_rate", vec![51, 1]),
        ("multiplier_is_unique", vec![51, 1]),
        ("energy", vec![51, 6]),
    ];
    for (name, shape) in shapes {
        assert_eq!(npz[name].shape, shape, "{name}");
    }
    // The bob falls: what it loses in height it gains in speed.
    let energy = npz["energy"].numbers();
    let total = |frame: usize| energy[6 * frame] + energy[6 * frame + 1];
    assert!(energy[6 * 50] > 1.0 && (total(50) - total(0)).abs() < 1e-6, "{energy:?}");
    folder.qhat(&["run", "bob.toml", "-o", "few.csv", "--select", "energy,positions"]).well();
    let header = folder.read("few.csv").lines().next().unwrap().to_owned();
    assert_eq!(
        header,
        "t,hook.x,hook.y,bob.x,bob.y,energy.kinetic,energy.potential,energy.dissipation,energy.stabilization,\
         energy.external,energy.drives"
    );
    folder.qhat(&["run", "bob.toml", "-o", "x.npz", "--select", "tensions"]).refused("there is no quantity `tensions`");
}

#[test]
fn events_are_in_the_output() {
    let folder = Folder::with(&[("jerked.toml", JERKED)]);
    folder.qhat(&["run", "jerked.toml", "-o", "jerked.npz"]).well();
    let npz = read(&folder.path("jerked.npz"));
    // The ball falls 0.2 m in 0.2 s to the length of its rope, at 2 m/s; the impulse of 2 N·s breaks the rope.
    let kinds = npz["event_kind"].texts();
    let broke = kinds.iter().position(|kind| kind == "broke").unwrap();
    assert!((npz["event_t"].numbers()[broke] - 0.2).abs() < 1e-6);
    assert!((npz["event_impulse"].numbers()[broke] - 2.0).abs() < 1e-5, "{:?}", npz["event_impulse"].numbers());
    assert_eq!(npz["event_constraint"].texts()[broke], "rope(hook-ball)");

    // A CSV has a table of them beside it.
    folder.qhat(&["run", "jerked.toml", "-o", "jerked.csv"]).well();
    let table = folder.read("jerked.csv.events.csv");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!((lines[0], lines.len()), ("t,constraint,kind,speed,impulse", kinds.len() + 1));
    for (k, line) in lines[1..].iter().enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells[0].parse::<f64>().unwrap(), npz["event_t"].numbers()[k]);
        assert_eq!(cells[1..3], ["rope(hook-ball)", &kinds[k]]);
        assert_eq!(cells[3].parse::<f64>().unwrap(), npz["event_speed"].numbers()[k]);
        assert_eq!(cells[4].parse::<f64>().unwrap(), npz["event_impulse"].numbers()[k]);
    }
    folder.qhat(&["run", "jerked.toml", "-o", "jerked.csv"]).refused("exists");
    // A run without events leaves no table of a former one.
    folder.qhat(&["run", "jerked.toml", "-o", "jerked.csv", "--duration", "0.1", "--force"]).well();
    assert!(!folder.path("jerked.csv.events.csv").exists());
}

/// The power of all forces and constraints is that of the sum of their forces, in every frame of every shipped scene.
#[test]
fn long_powers_of_every_scene_add_up_to_force_times_velocity() {
    for_every_scene("velocities,applied_forces,constraint_forces,force_power,constraint_power", &|name, npz| {
        let [v, applied, held] = ["velocities", "applied_forces", "constraint_forces"].map(|it| npz[it].numbers());
        let masses = npz["masses"].numbers();
        let (frames, d) = (npz["velocities"].shape[0], npz["velocities"].shape[2]);
        let powers = ["force_power", "constraint_power"].map(|it| npz[it].numbers());
        for frame in 0..frames {
            let width = v.len() / frames;
            let free = (0..width).filter(|k| masses[k / d].is_finite()).map(|k| frame * width + k);
            let parts: Vec<f64> = free.flat_map(|k| [applied[k] * v[k], held[k] * v[k]]).collect();
            let row = |all: &[f64]| all[frame * (all.len() / frames)..][..all.len() / frames].to_vec();
            let own: Vec<f64> = powers.iter().flat_map(|all| row(all)).collect();
            let size: f64 = parts.iter().chain(&own).map(|part| part.abs()).sum();
            let off = parts.iter().sum::<f64>() - own.iter().sum::<f64>();
            // Roundings of as many terms as there are coordinates, rows and forces.
            assert!(off.abs() <= 1e-12 * size, "{name}, frame {frame}: {off:e} W of {size:e} W");
        }
    });
}

/// A crank with a motor, a damped spring, a load that swings, and gravity.
const MACHINE: &str = r#"
schema = "qhat/1"
name = "Machine"
dimension = 2
step = { h = 0.0005, duration = 1.0, tolerance = 1e-12 }
forces = { gravity = [0.0, -9.81], drag = 0.2 }
particles = [
    { id = "hub", at = [0.0, 0.0], fixed = true },
    { id = "pin", at = [0.4, 0.0] },
    { id = "slide", at = [1.6, 0.0], mass = 2.0 },
    { id = "wall", at = [3.0, 0.0], fixed = true },
]
constraints = [
    { kind = "angle", id = "motor", arm = ["hub", "pin"], angle = "2*t + 0.3*sin(3*t)" },
    { kind = "distance", id = "crank", between = ["hub", "pin"] },
    { kind = "distance", id = "rod", between = ["pin", "slide"] },
    { kind = "line", id = "guide", particle = "slide", at = [0.0, 0.0], along = [1.0, 0.0] },
]
springs = [{ between = ["slide", "wall"], stiffness = 40.0, damping = 1.5, rest = 1.2 }]
loads = [{ kind = "harmonic", particle = "slide", force = [5.0, 0.0], angular_frequency = 7.0 }]
"#;

/// Powers integrate to the energy account: those of drives to their work, all to the change of T, within 1e-8 of the
/// largest kinetic energy. Simpson's rule over frames of 0.5 ms is right to (7 · 0.0005)⁴/180, 1e-12.
#[test]
fn powers_integrate_to_the_energy_account() {
    let folder = Folder::with(&[("machine.toml", MACHINE)]);
    let select = "energy,force_power,constraint_power";
    folder.qhat(&["run", "machine.toml", "-o", "machine.npz", "--select", select]).well();
    let npz = read(&folder.path("machine.npz"));
    let energy = npz["energy"].numbers();
    let last = npz["t"].shape[0] - 1;
    let change = |part: usize| energy[6 * last + part] - energy[part];
    let largest = (0..=last).map(|frame| energy[6 * frame]).fold(0.0, f64::max);
    let work = |array: &str, wanted: &dyn Fn(&str) -> bool| {
        let names = npz[&array.replace("power", "names")].texts();
        let (powers, width) = (npz[array].numbers(), names.len());
        let columns: Vec<usize> = (0..width).filter(|&k| wanted(&names[k])).collect();
        assert!(!columns.is_empty(), "{names:?}");
        let power = |frame: usize| columns.iter().map(|&k| powers[frame * width + k]).sum::<f64>();
        let weight = |frame: usize| match frame {
            0 => 1.0,
            _ if frame == last => 1.0,
            _ if frame % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..=last).map(|frame| weight(frame) * power(frame)).sum::<f64>() * 0.0005 / 3.0
    };
    let drives = work("constraint_power", &|name| name == "motor");
    let all = work("force_power", &|_| true) + work("constraint_power", &|_| true);
    let gravity = work("force_power", &|name| name.starts_with("Gravity"));
    let dissipated = work("force_power", &|name| !name.starts_with("Gravity") && !name.starts_with("Spring"));
    let spring = work("force_power", &|name| name.starts_with("Spring"));
    assert!(drives.abs() > 0.1 * largest && dissipated.abs() > 0.1 * largest, "{drives} {dissipated}");
    for (what, found, expected) in [
        ("drives", drives, change(5)),
        ("all", all, change(0)),
        ("forces", gravity + dissipated + spring, change(2) - change(1)),
    ] {
        let off = (found - expected).abs();
        assert!(off <= 1e-8 * largest, "{what}: {found} J and {expected} J differ by {off:e} J of {largest} J");
    }
}

/// Poses of the bodies of shipped scenes: a compound pendulum in the plane and a tumbling block in space.
#[test]
fn poses_of_bodies_are_in_the_output() {
    let folder = Folder::new();
    let select = "body_center,body_rotation,body_velocity,body_spin,body_angular_momentum,energy";
    let run = |scene: &str, output: &str| folder.qhat(&["run", scene, "-q", "-o", output, "--select", select]).well();
    run("middle-axis", "space.npz");
    let npz = read(&folder.path("space.npz"));
    let frames = npz["t"].shape[0];
    assert_eq!(npz["body_center"].shape, [frames, 1, 3]);
    assert_eq!(npz["body_rotation"].shape, [frames, 1, 4]);
    assert_eq!(npz["body_spin"].shape, [frames, 1, 3]);
    assert_eq!(npz["body_names"].texts().len(), 1);
    let rotation = npz["body_rotation"].numbers();
    assert_eq!(rotation[..4], [1.0, 0.0, 0.0, 0.0], "the start is not turned");
    let [spin, momentum] = ["body_spin", "body_angular_momentum"].map(|it| npz[it].numbers());
    let energy = npz["energy"].numbers();
    for frame in 0..frames {
        // No moment acts on a free body: L stays, and T = ½ ω·L.
        let [own, omega] = [&momentum, &spin].map(|all| &all[3 * frame..3 * frame + 3]);
        let size = momentum[..3].iter().map(|x| x.abs()).sum::<f64>();
        let off = (0..3).map(|k| (own[k] - momentum[k]).abs()).fold(0.0, f64::max);
        // The default tolerance over some hundred substeps.
        assert!(off <= 1e-5 * size, "frame {frame}: L is off by {off:e} of {size}");
        let turning = 0.5 * (0..3).map(|k| own[k] * omega[k]).sum::<f64>();
        let velocity = &npz["body_velocity"].numbers()[3 * frame..3 * frame + 3];
        let along: f64 =
            0.5 * npz["masses"].numbers().iter().sum::<f64>() * velocity.iter().map(|v| v * v).sum::<f64>();
        assert!((turning + along - energy[6 * frame]).abs() <= 1e-9 * energy[0], "frame {frame}");
    }
    run("compound-pendulum", "plane.csv");
    let header = folder.read("plane.csv").lines().next().unwrap().to_owned();
    assert!(header.contains(".center.x,") && header.contains(".rotation,") && header.contains(".spin,"), "{header}");
}
