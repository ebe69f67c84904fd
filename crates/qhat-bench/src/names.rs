//! Workloads by their names: a family and its size.

use crate::shapes;
use crate::workload::Workload;
use std::str::FromStr;
use thiserror::Error;

/// The workloads that `qhat bench` runs when no name is given, by family and by growing size.
pub const NAMES: [&str; 22] = [
    "chain10",
    "chain100",
    "chain1000",
    "chain1e4",
    "chain1e5",
    "chain1e6",
    "heavy100",
    "heavy1000",
    "net32",
    "net100",
    "net316",
    "cloth32",
    "cloth100",
    "cloth316",
    "truss20",
    "truss20r",
    "truss200",
    "truss200r",
    "four-bar",
    "star1000",
    "many20",
    "many10000",
];

/// The most particles of a workload, ten times as many as the largest of [`NAMES`] has.
const MOST_PARTICLES: usize = 10_000_000;

/// The error for a name that no workload has.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "there is no workload `{name}`; use chainN, heavyR, netN, clothN, trussK, trussKr, four-bar, starN or manyN, \
     as in {}",
    NAMES.join(", ")
)]
pub struct UnknownWorkload {
    /// The name that was given.
    pub name: String,
}

impl FromStr for Workload {
    type Err = UnknownWorkload;

    /// Makes a workload from its name: a family and, for all but the four-bar linkage, a size (`chain100`, `chain1e5`).
    fn from_str(name: &str) -> Result<Self, UnknownWorkload> {
        let made = match name.split_once(|c: char| c.is_ascii_digit()) {
            None if name == "four-bar" => Some(shapes::four_bar()),
            None => None,
            Some((family, _)) => sized(family, &name[family.len()..]),
        };
        let workload = made.ok_or_else(|| UnknownWorkload { name: name.to_owned() })?;
        Ok(Workload { name: name.to_owned(), ..workload })
    }
}

fn sized(family: &str, size: &str) -> Option<Workload> {
    let (digits, redundant) = match size.strip_suffix('r') {
        Some(digits) if family == "truss" => (digits, true),
        _ => (size, false),
    };
    // Sizes are integers, read as f64 because 1e6 is easier to read than 1000000.
    let size = digits
        .parse()
        .ok()
        .filter(|&size: &f64| (1.0..=MOST_PARTICLES as f64).contains(&size) && size.fract() == 0.0)?;
    let count = size as usize;
    let most = MOST_PARTICLES;
    match family {
        "chain" => Some(shapes::chain(count)),
        "heavy" => Some(shapes::heavy(size)),
        "net" if count > 1 && count * count <= most => Some(shapes::net(count, 2)),
        "cloth" if count > 1 && count * count <= most => Some(shapes::net(count, 3)),
        "truss" if count > 2 && 2 * count <= most => Some(shapes::truss(count, redundant)),
        "star" => Some(shapes::star(count)),
        "many" if 21 * count <= most => Some(shapes::many(count)),
        _ => None,
    }
}
