//! Every kind of constraint: one table of cases, and one file for each question about all kinds.

mod case;
mod cases;
mod closed_forms;
mod differences;
mod expressions;
mod motion;
mod refused;
mod rows;
mod singular;

use qhat::Constraint;
use std::collections::BTreeSet;
use std::path::Path;

/// The kinds by the numbers of dimensions in which they can be used; the kinds behind `equality` hold C = 0 over a
/// motion. The code does not compile if a kind is missing: name a new kind here, then add its cases.
macro_rules! kinds {
    ($(in $dimensions:expr; equality $($equality:ident)*; other $($other:ident)*;)*) => {
        /// Name, dimensions, and whether it is an equality.
        const KINDS: &[(&str, &[usize], bool)] =
            &[$($((stringify!($equality), &$dimensions, true),)* $((stringify!($other), &$dimensions, false),)*)*];

        fn kind(constraint: &Constraint) -> &'static str {
            match constraint {
                $($(Constraint::$equality(_) => stringify!($equality),)*)*
                $($(Constraint::$other(_) => stringify!($other),)*)*
            }
        }
    };
}

kinds! {
    in [2, 3];
    equality Distance Nail Relation Lengths Angle Direction OnLine OnSphere OnCurve ExpressionConstraint;
    other Limits Obstacle Custom;

    in [2];
    equality Gears Area;
    other;

    in [3];
    equality Volume OnPlane OnCircle;
    other;
}

/// The kinds whose fields hold a number or a point that time may change, as the source of the engine declares them.
fn can_be_driven() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/constraint");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let source: String = files.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(String::from).collect()
    };
    // Name of each public type, and the words up to the end of its declaration.
    let mut declared = Vec::new();
    for start in ["pub struct ", "pub enum ", "pub type "] {
        for rest in source.split(&format!("\n{start}")).skip(1) {
            let end = if start == "pub type " { ";" } else { "\n}" };
            let code: Vec<&str> =
                rest.split(end).next().unwrap().lines().filter(|line| !line.trim().starts_with("//")).collect();
            let mut words = words(&code.join("\n"));
            declared.push((words.remove(0), words));
        }
    }
    let mut driven = BTreeSet::from(["Driven".to_owned()]);
    loop {
        let more: Vec<String> = declared
            .iter()
            .filter(|(name, words)| !driven.contains(name) && words.iter().any(|word| driven.contains(word)))
            .map(|(name, _)| name.clone())
            .collect();
        if more.is_empty() {
            break;
        }
        driven.extend(more);
    }
    assert!(driven.contains("OnSphere") && !driven.contains("Distance"), "the search for fields found {driven:?}");
    driven
}
