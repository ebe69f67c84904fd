//! `--select`: the quantities of a trajectory, and the laws that they obey.

use crate::common::npz::read;
use crate::common::{Folder, JERKED, PENDULUM};
use qhat_scene::shipped;

/// Newton's law from the output alone: m a = applied + constraint forces on every particle that can move, in every
/// frame of every shipped scene, friction included.
#[test]
fn long_forces_of_every_scene_add_up_to_mass_times_acceleration() {
    let folder = Folder::new();
    let select = "accelerations,applied_forces,constraint_forces";
    for scene in shipped() {
        let name = scene.name;
        let run = ["run", name, "--quiet", "--no-tension", "--frames", "5", "--duration", "0.05", "--select", select];
        let ran = folder.qhat(&[&run[..], &["-o", "out.npz", "--force"]].concat());
        // Integrators of fixed step take frames of their own.
        if ran.code == 2 && ran.stderr.contains("takes steps of exactly h") {
            continue;
        }
        assert_eq!(ran.code, 0, "{name}: {ran:?}");
        let npz = read(&folder.path("out.npz"));
        let masses = npz["masses"].numbers();
        let [a, applied, held] = ["accelerations", "applied_forces", "constraint_forces"].map(|it| npz[it].numbers());
        let d = npz["accelerations"].shape[2];
        let size = applied.iter().chain(&held).fold(0.0_f64, |largest, force| largest.max(force.abs()));
        for k in (0..a.len()).filter(|k| masses[k / d % masses.len()].is_finite()) {
            let off = masses[k / d % masses.len()] * a[k] - applied[k] - held[k];
            // Three roundings of numbers of this size.
            assert!(off.abs() <= 1e-12 * size, "{name}: {off:e} N of {size:e} N");
        }
    }
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
}
