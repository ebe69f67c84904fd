//! Parameters of the whole scene: in every expression a name gives the same bits as its number.

use qhat_scene::{Format, load};

const SCENE: &str = r#"
schema = "qhat/1"
name = "Parameters"
dimension = 2
particles = [
    { id = "pivot", at = [0.0, 0.0] },
    { id = "arm", at = [1.5, 0.0] },
    { id = "bob", at = [1.5, 1.0] },
    { id = "bead", at = [3.0, 0.0] },
    { id = "ring", at = [5.0, 0.0] },
]

[parameters]
reach = 1.5
rate = 3.0
k = 0.5

[[constraints]]
kind = "nail"
particle = "pivot"
at = ["0.1*sin(rate*t)", 0.0]

[[constraints]]
kind = "distance"
between = ["pivot", "arm"]
length = "reach"
compliance = 1e-4

[[constraints]]
kind = "expression"
residual = "dist(arm, bob) - 1 - push*sin(rate*t)"
parameters = { push = 0.1 }

[[constraints]]
kind = "curve"
particle = "bead"
path = ["2*reach + s", "k*s^2"]
range = [-1.0, 1.0]

[[constraints]]
kind = "sphere"
particle = "ring"
center = [4.0, 0.0]
radius = "1 + k*t"

[[loads]]
kind = "force"
particle = "bead"
force = ["1 - k*bead.vx", "0"]

[[loads]]
kind = "potential"
potential = "k*dist(bob, ring)^2"
"#;

/// q and q̇ after a second.
fn end(text: &str) -> Vec<f64> {
    let scene = load(text, "parameters.toml", Format::Toml).unwrap_or_else(|errors| panic!("{errors}"));
    let mut simulation = scene.simulation().unwrap();
    simulation.advance(1.0).unwrap();
    [simulation.state().positions(), simulation.state().velocities()].concat()
}

/// The text with numbers in place of names.
fn spelt(text: &str, numbers: &[(&str, &str, &str)]) -> String {
    let is_letter = |letter: char| letter.is_alphanumeric() || letter == '_';
    let number = |word: &str| numbers.iter().find(|(name, ..)| *name == word).map(|(_, number, _)| *number);
    let mut all = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|letter| is_letter(letter) != is_letter(first)).unwrap_or(rest.len());
        all.push_str(number(&rest[..end]).unwrap_or(&rest[..end]));
        rest = &rest[end..];
    }
    all
}

#[test]
fn a_name_is_its_number_in_every_expression() {
    let numbers = [("reach", "1.5", "1.25"), ("rate", "3.0", "2.0"), ("k", "0.5", "0.25")];
    let (top, rest) = SCENE.split_once("[parameters]").unwrap();
    let (_, rest) = rest.split_once("k = 0.5\n").unwrap();
    let named = end(SCENE);
    assert_eq!(named, end(&format!("{top}{}", spelt(rest, &numbers))));
    // Each parameter changes the motion.
    for (name, number, other) in numbers {
        let changed = SCENE.replace(&format!("\n{name} = {number}\n"), &format!("\n{name} = {other}\n"));
        assert_ne!(changed, SCENE);
        assert_ne!(named, end(&changed), "{name}");
    }
}
