//! Random texts of the expression language: valid ones, ones beyond its limits, ones that are wrong.

use crate::random::Random;

const NUMBERS: [&str; 16] = [
    "0", "1", "-1", "2", "0.5", "1e-320", "1e308", "-1e308", "1e400", "1e-9", "3.5e16", "0.0", "1.", ".5", "1024", "7e",
];
const FUNCTIONS: [&str; 12] =
    ["sqrt", "exp", "ln", "abs", "sin", "cos", "tan", "asin", "acos", "atan", "length", "log"];
/// Pieces that rarely fit where they are put.
const WRONG: [&str; 13] = ["(", ")", ",", ".", "..", " ", "é", "\u{202E}", "e", "=", "'", "@", "x"];
const OPERATIONS: [&str; 6] = [" + ", " - ", "*", "/", "^", " ^ -"];

/// A text that uses these names of particles.
pub(super) fn expression(random: &mut Random, names: &[String]) -> String {
    let mut text = match random.below(8) {
        0 => {
            // Beyond what a reader that calls itself would survive.
            let depth = *random.pick(&[31, 33, 200, 3000, 100_000]);
            let (open, close) =
                *random.pick(&[("(", ")"), ("-", ""), ("sqrt(", ")"), ("2^", ""), ("[", "]"), ("abs(", ")")]);
            format!("{}{}{}", open.repeat(depth), leaf(random, names), close.repeat(depth))
        }
        1 => {
            let terms = *random.pick(&[10, 170, 600, 2000]);
            (0..terms).map(|_| leaf(random, names)).collect::<Vec<_>>().join(*random.pick(&OPERATIONS))
        }
        _ => {
            let depth = 1 + random.below(5);
            node(random, names, depth)
        }
    };
    if random.chance(0.1) {
        let place = text.char_indices().map(|(place, _)| place).nth(random.below(text.chars().count())).unwrap_or(0);
        let put = random.pick(&WRONG);
        text.insert_str(place, put);
    }
    text
}

fn leaf(random: &mut Random, names: &[String]) -> String {
    let name = if names.is_empty() { "p" } else { random.pick(names) };
    match random.below(7) {
        0 | 1 => (*random.pick(&NUMBERS)).to_owned(),
        2 => (*random.pick(&["t", "pi", "tau", "s", "k", "nan", "inf", "x"])).to_owned(),
        3 => format!("{name}.{}", random.pick(&["vx", "vy", "vz", "w", "X"])),
        _ => format!("{name}.{}", random.pick(&["x", "y", "y", "x", "z"])),
    }
}

fn node(random: &mut Random, names: &[String], depth: usize) -> String {
    if depth == 0 {
        return leaf(random, names);
    }
    let inner = |random: &mut Random| node(random, names, depth - 1);
    let name = |random: &mut Random| if names.is_empty() { "p".to_owned() } else { random.pick(names).clone() };
    match random.below(10) {
        0..=3 => format!("({}{}{})", inner(random), random.pick(&OPERATIONS), inner(random)),
        4 | 5 => format!("{}({})", random.pick(&FUNCTIONS), inner(random)),
        6 => format!("{}({}, {})", random.pick(&["atan2", "min", "max", "dot", "dist"]), inner(random), inner(random)),
        7 => format!("{}({}, {})", random.pick(&["dist", "dot", "cross"]), name(random), name(random)),
        8 => format!("area({}, {}, {})", name(random), name(random), name(random)),
        _ => format!("dist({}, [{}, {}])", name(random), inner(random), inner(random)),
    }
}
