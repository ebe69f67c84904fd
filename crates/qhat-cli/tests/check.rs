//! `qhat check`: degrees of freedom, rank, self-stress, and whether the start is consistent.

use crate::common::{Folder, INFEASIBLE, PENDULUM};
use serde_json::{Value, json};

/// A scene of particles (x, y, fixed) and rods between them.
fn truss(particles: &[(f64, f64, bool)], rods: &[(usize, usize)]) -> String {
    let particles = particles.iter().enumerate();
    let particles: Vec<Value> =
        particles.map(|(i, (x, y, fixed))| json!({ "id": format!("p{i}"), "at": [x, y], "fixed": fixed })).collect();
    let rods = rods.iter().map(|(a, b)| json!({ "kind": "distance", "between": [format!("p{a}"), format!("p{b}")] }));
    let scene = json!({ "schema": "qhat/1", "name": "Truss", "dimension": 2, "particles": particles,
                        "constraints": rods.collect::<Vec<_>>() });
    scene.to_string()
}

fn check(scene: &str) -> Value {
    Folder::new().qhat_reading(scene, &["check", "-", "--json"]).well().json()
}

/// N, m on free particles, rank, degrees of freedom, states of self-stress.
fn counts(found: &Value) -> [u64; 4] {
    ["rows_on_free_particles", "rank", "degrees_of_freedom", "states_of_self_stress"]
        .map(|key| found[key].as_u64().unwrap())
}

#[test]
fn counts_by_hand() {
    let square = [(0.0, 0.0, false), (1.0, 0.0, false), (1.0, 1.0, false), (0.0, 1.0, false)];
    let sides = [(0, 1), (1, 2), (2, 3), (3, 0)];
    // 8 coordinates; four sides leave the 3 motions of the plane and the shear.
    assert_eq!(counts(&check(&truss(&square, &sides))), [4, 4, 4, 0]);
    // Both diagonals: one of the six rods is redundant.
    let braced = check(&truss(&square, &[&sides[..], &[(0, 2), (1, 3)]].concat()));
    assert_eq!(counts(&braced), [6, 5, 3, 1]);
    assert_eq!(braced["redundant"], true);

    // A rod between fixed particles constrains nothing and is not counted.
    let held = [(0.0, 0.0, true), (1.0, 0.0, true), (0.5, 1.0, false)];
    let found = check(&truss(&held, &[(0, 1), (0, 2), (1, 2)]));
    assert_eq!((counts(&found), &found["rows"]), ([2, 2, 0, 0], &json!(3)));
    assert_eq!(found["redundant"], false);
}

/// Three joints in a line: two degrees of freedom to first order, and one of the lever that the rods are.
#[test]
fn rods_that_hold_to_second_order_are_named() {
    let joints = [(-1.0, 0.0, false), (0.0, 0.0, true), (1.0, 0.0, false)];
    let scene = truss(&joints, &[(0, 1), (1, 2), (0, 2)]);
    let found = check(&scene);
    assert_eq!(counts(&found), [3, 2, 2, 1]);
    assert_eq!(
        (&found["degrees_of_freedom_nearby"], &found["second_order"]),
        (&json!(1), &json!([["p0", "p1", "p2"]]))
    );
    let said = Folder::new().qhat_reading(&scene, &["check", "-"]).well().stdout;
    assert!(said.contains("2 degrees of freedom at this position, 1 of the mechanism near by"), "{said}");
    assert!(said.contains("rods hold `p0`, `p1`, `p2` in a line or plane only to second order"), "{said}");
    let triangle = check(&truss(&[(-1.0, 0.0, false), (0.0, 0.5, true), (1.0, 0.0, false)], &[(0, 1), (1, 2), (0, 2)]));
    assert_eq!((&triangle["degrees_of_freedom_nearby"], &triangle["second_order"]), (&json!(null), &json!([])));
}

#[test]
fn the_rank_is_that_of_the_bare_matrix() {
    // Diagonal drag makes A + ε I regular; the rank is the rank of A.
    let square = [(0.0, 0.0, false), (1.0, 0.0, false), (1.0, 1.0, false), (0.0, 1.0, false)];
    let scene = truss(&square, &[(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)]);
    let mut scene: Value = serde_json::from_str(&scene).unwrap();
    scene["step"] = json!({ "integrator": "euler" });
    scene["feedback"] = json!({ "diagonal_drag": 0.5 });
    assert_eq!(counts(&check(&scene.to_string())), [6, 5, 3, 1]);
}

#[test]
fn an_inconsistent_start_is_told_and_mended() {
    let stretched = PENDULUM.replace("\"bob\"] }]", "\"bob\"], length = 1.25 }]");
    let found = check(&stretched);
    assert_eq!((&found["consistent_at_start"], &found["feasible"]), (&json!(false), &json!(true)));
    // The bob at 1 m on a rod of 1.25 m; the projection ends within its tolerance of 1e-10.
    assert!((found["max_residual_at_start"].as_f64().unwrap() - 0.25).abs() < 1e-15);
    assert!((found["start_moved"].as_f64().unwrap() - 0.25).abs() < 1e-9);
    let said = Folder::new().qhat_reading(&stretched, &["check", "-"]).well().stdout;
    assert!(said.contains("is the farthest off; every constraint holds after moves of up to 2.500e-1 m"), "{said}");
}

#[test]
fn an_infeasible_scene_is_told() {
    let folder = Folder::with(&[("torn.toml", INFEASIBLE)]);
    let ran = folder.qhat(&["check", "torn.toml", "--json"]);
    assert_eq!((ran.code, &ran.json()["feasible"]), (1, &json!(false)));
    let ran = folder.qhat(&["check", "torn.toml"]);
    assert_eq!(ran.code, 1);
    assert!(ran.stdout.starts_with("Torn: valid, but its constraints cannot all hold\n"), "{}", ran.stdout);
}

#[test]
fn an_invalid_scene_is_told_as_json_too() {
    let folder = Folder::with(&[("bob.toml", &PENDULUM.replace("mass", "mess"))]);
    let ran = folder.qhat(&["check", "bob.toml", "--json"]).refused("bob.toml:7:");
    let found = ran.json();
    assert_eq!((&found["valid"], &found["errors"][0]["line"]), (&json!(false), &json!(7)));
    assert!(found["errors"][0]["message"].as_str().unwrap().contains("mess"));
}

#[test]
fn plain_words() {
    let said = Folder::with(&[("bob.toml", PENDULUM)]).qhat(&["check", "bob.toml"]).well().stdout;
    let expected = "A bob: valid\n  \
                    particles    2 particles, 1 of them free to move, in 2 dimensions\n  \
                    constraints  1 row, 1 of them on free particles; 1 rod\n  \
                    start        every constraint holds exactly\n  \
                    rank         1: no row is redundant, so every tension is unique\n  \
                    freedom      1 degree of freedom\n  \
                    component    path, 1 row: dense\n  \
                    first frame  auto: dop853, in lanes\n";
    assert_eq!(said, expected);
}

#[test]
fn long_every_shipped_scene_passes() {
    let folder = Folder::new();
    for scene in folder.qhat(&["scenes", "--json"]).well().json().as_array().unwrap() {
        let ran = folder.qhat(&["check", scene["name"].as_str().unwrap(), "--json"]).well();
        assert_eq!(ran.json()["feasible"], true, "{scene}");
    }
}

#[test]
fn components_are_named_with_their_method() {
    // A free square with one diagonal, and a pendulum.
    let points = [
        (0.0, 0.0, false),
        (1.0, 0.0, false),
        (1.0, 1.0, false),
        (0.0, 1.0, false),
        (5.0, 0.0, true),
        (5.0, 1.0, false),
    ];
    let rods = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (4, 5)];
    let found = check(&truss(&points, &rods));
    let told: Vec<_> =
        found["components"].as_array().unwrap().iter().map(|c| (&c["kind"], &c["rows"], &c["method"])).collect();
    assert_eq!(told, [(&json!("cyclic"), &json!(5), &json!("dense")), (&json!("path"), &json!(1), &json!("dense"))]);

    // Forty spokes are a hub; each spoke adds one entry for each direction, and its own.
    let spokes: Vec<(f64, f64, bool)> = (0..40).map(|i| (f64::from(i) - 20.5, 1.0, false)).collect();
    let star = truss(&[&[(0.0, 0.0, false)], &spokes[..]].concat(), &(1..=40).map(|i| (0, i)).collect::<Vec<_>>());
    let found = &check(&star)["components"][0];
    assert_eq!(
        (&found["kind"], &found["hubs"], &found["entries_of_l"]),
        (&json!("tree"), &json!(1), &json!(40 * 3 + 3))
    );
    let words = Folder::new().qhat_reading(&star, &["check", "-"]).well().stdout;
    assert!(words.contains("tree with 1 hub, 40 rows: simplicial"), "{words}");
}
