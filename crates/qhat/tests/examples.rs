//! The examples say what they should.

use std::error::Error;

macro_rules! examples {
    ($($name:ident: $path:literal,)*) => {$(
        #[path = $path]
        #[allow(dead_code, reason = "the test calls what main calls")]
        mod $name;
    )*};
}

examples! {
    pendulum: "../examples/pendulum.rs",
    bridge: "../examples/bridge.rs",
    slider_crank: "../examples/slider_crank.rs",
    slack_rope: "../examples/slack_rope.rs",
    expression: "../examples/expression.rs",
    sweep: "../examples/sweep.rs",
    game: "../examples/game.rs",
    picture: "../examples/picture.rs",
}

fn said(tell: impl FnOnce(&mut Vec<u8>) -> Result<(), Box<dyn Error>>) -> String {
    let mut out = Vec::new();
    tell(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// The numbers of a text.
fn numbers(text: &str) -> Vec<f64> {
    let is_border = |c: char| c.is_whitespace() || "(),:".contains(c);
    text.split(is_border).filter_map(|word| word.parse().ok()).collect()
}

/// A pendulum of amplitude 60° has the period 4 K(sin 30°) √(l/g) and pulls at most with m g (3 − 2 cos 60°).
#[test]
fn the_pendulum_has_its_period() {
    let text = said(pendulum::tell);
    assert_eq!(text, "period 2.153 s\ntension at most 39.24 N, at rest 19.62 N\nthe energy is right to 1e-6\n");
}

/// The supports bear twelve free nodes of 10 kg and the load; the moments about the left one give the right one's
/// share.
#[test]
fn the_bridge_stands_on_its_supports_and_breaks_where_it_is_pushed_most() {
    let text = said(bridge::tell);
    let lines: Vec<_> = text.lines().collect();
    let weight = 9.81 * 10.0;
    let deck: f64 = (1..=6).map(f64::from).sum();
    let top: f64 = (0..6).map(|i| f64::from(i) + 0.5).sum();
    let right = (weight * (deck + top) + 500.0 * 3.0) / 6.0;
    let borne = [&lines[2], &lines[3]].map(|line| numbers(line)[0]);
    assert!((borne[1] - right).abs() < 0.06 && (borne[0] + borne[1] - 12.0 * weight - 500.0).abs() < 0.11, "{text}");
    assert!(lines[0].starts_with("pulled most: deck2-3 ") && lines[1].starts_with("pushed most: top2-3 "), "{text}");
    assert!(lines[4].starts_with("top2-3 breaks under a load of "), "{text}");
}

/// Half a turn on, the motor does the same the other way round; where the piston turns back it has no torque.
#[test]
fn the_motor_of_the_slider_crank_gives_back_what_it_takes() {
    let text = said(slider_crank::tell);
    let rows: Vec<Vec<f64>> = text.lines().skip(1).take(8).map(numbers).collect();
    for (before, after) in [(0, 6), (1, 5), (2, 4)] {
        assert!((rows[before][1] - rows[after][1]).abs() < 2e-4, "{text}");
        assert!((rows[before][2] + rows[after][2]).abs() < 2e-3, "{text}");
    }
    assert!(rows[0][2] > 1.0 && rows[3][2].abs() < 2e-3 && rows[7][2].abs() < 2e-3, "{text}");
    assert_eq!((rows[3][1], rows[7][1]), (0.15, 0.25));
}

/// The ball flies until |x| = 1.5 m: (0.5 + t)² + (g t²/2)² = 1.5² at t = 0.4810 s.
#[test]
fn the_rope_goes_taut_when_the_ball_is_at_its_end() {
    let text = said(slack_rope::tell);
    let lines: Vec<_> = text.lines().collect();
    assert!(lines[0].starts_with("0.4810 s: rope impact at "), "{text}");
    assert_eq!(lines[1], "0.4810 s: rope closed");
    assert!(lines.iter().any(|line| line.contains("wall impact")) && text.contains("rope opened"), "{text}");
}

#[test]
fn the_bead_stays_on_its_spiral() {
    let text = said(expression::tell);
    assert!(text.ends_with("off the spiral by less than 1e-9 m: true\n"), "{text}");
    let radii: Vec<f64> = text.lines().take(4).map(|line| numbers(line)[1]).collect();
    assert!(radii.windows(2).all(|pair| pair[0] < pair[1]), "the wind drives the bead outwards: {text}");
}

/// A single pendulum of both masses would pull with 3 (m₁ + m₂) g; a tip that whips round pulls more.
#[test]
fn the_sweep_finds_one_of_its_lengths() {
    let text = said(sweep::tell);
    let found = numbers(&text);
    assert_eq!(found[0], 50.0);
    assert!((0.5..=1.5).contains(&found[1]) && found[2] > 3.0 * 2.0 * 9.81, "{text}");
}

#[test]
fn the_game_picks_the_heavy_end_and_is_never_off() {
    let text = said(game::tell);
    assert!(text.starts_with("picked bead20\nframe 39: end at ("), "{text}");
    assert_eq!(text.matches("links right to 1e-9: true").count(), 3, "{text}");
    assert!(numbers(text.lines().nth(2).unwrap())[0] > 0.5, "the hand has dragged it: {text}");
}

#[test]
fn the_picture_has_every_link_and_particle() {
    let text = said(picture::tell);
    assert_eq!((text.matches("<line ").count(), text.matches("<circle ").count()), (3, 3));
    assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"), "{text}");
    assert!(text.contains("stroke='rgb(255,0,0)'") && text.contains("<title>pivot-right "), "{text}");
}
