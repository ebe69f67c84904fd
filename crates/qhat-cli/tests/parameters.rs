//! `--set`: parameters of a scene from the command line.

use crate::common::Folder;

const PENDULUM: &str = r#"schema = "qhat/1"
name = "Pendulum"
dimension = 2

[parameters]
L = { value = 1.0, min = 0.1, max = 5.0, unit = "m" }
g = 9.81

[forces]
gravity = [0, "-g"]

[[particles]]
id = "pivot"
at = [0, 0]
fixed = true

[[particles]]
id = "bob"
at = ["L", 0]

[[constraints]]
kind = "distance"
between = ["pivot", "bob"]
length = "L"
"#;

/// The same with numbers.
fn spelt() -> String {
    let (head, rest) = PENDULUM.split_once("[parameters]").unwrap();
    let (_, rest) = rest.split_once("\n\n").unwrap();
    format!("{head}{}", rest.replace("\"-g\"", "-1.62").replace("\"L\"", "2.5"))
}

#[test]
fn a_run_with_set_has_the_bytes_of_the_scene_with_these_numbers() {
    let folder = Folder::with(&[("named.toml", PENDULUM), ("spelt.toml", &spelt())]);
    folder.qhat(&["run", "named.toml", "--set", "L=2.5", "--set", "g=1.62", "-o", "a.csv", "--duration", "1"]).well();
    folder.qhat(&["run", "spelt.toml", "-o", "b.csv", "--duration", "1"]).well();
    assert!(folder.read("a.csv").lines().count() > 100);
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
    assert!(folder.read("a.csv.json").contains(r#""parameters":{"L":2.5,"g":1.62}"#));
}

#[test]
fn check_lists_parameters_and_their_uses() {
    let folder = Folder::with(&[("named.toml", PENDULUM)]);
    let found = folder.qhat(&["check", "named.toml", "--set", "L=2", "--json"]).well().json();
    let parameters = &found["parameters"];
    assert_eq!(parameters[0]["name"], "L");
    assert_eq!(parameters[0]["value"], 2.0);
    assert_eq!((&parameters[0]["min"], &parameters[0]["max"]), (&0.1.into(), &5.0.into()));
    assert_eq!(parameters[0]["uses"].as_array().unwrap().len(), 2);
    assert_eq!(parameters[1]["uses"][0]["place"], "gravity in line 10");
    let words = folder.qhat(&["check", "named.toml"]).well().stdout;
    assert!(words.contains("L = 1 m, from 0.1 to 5: length in line 24, at in line 19"), "{words}");
}

#[test]
fn a_parameter_that_cannot_be_set_is_refused() {
    let folder = Folder::with(&[("named.toml", PENDULUM)]);
    let cases = [
        ("l=2", "there is no parameter `l` to set"),
        ("L", "a parameter is set as in a=0.2"),
        ("L=two", "`two` is no number"),
        ("L=nan", "the parameter `L` must be a finite number, but is NaN"),
        ("L=7", "the parameter `L` must be at least 0.1 and at most 5, but is 7"),
    ];
    for (setting, words) in cases {
        for command in ["run", "check"] {
            folder.qhat(&[command, "named.toml", "--set", setting]).refused(words);
        }
    }
    folder.qhat(&["run", "pendulum", "--set", "L=2"]).refused("the scene has none");
}
