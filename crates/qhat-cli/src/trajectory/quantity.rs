//! The quantities of a trajectory: for each its name, its shape, its columns in a CSV and its numbers in a frame.

use qhat::{Energy, System, Terms, Work};
use std::borrow::Cow;
use std::str::FromStr;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The parts of the energy account, in the order of its array [J].
pub(crate) const ENERGIES: [&str; 6] = ["kinetic", "potential", "dissipation", "stabilization", "external", "drives"];

/// The time, the terms and the energies of a frame.
pub(crate) struct Frame<'a> {
    /// \[s\].
    pub(crate) time: f64,
    pub(crate) terms: &'a Terms,
    pub(crate) energy: Energy,
}

/// An array of a trajectory, with a row for each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Quantity {
    Time,
    Positions,
    Velocities,
    Accelerations,
    AppliedForces,
    ConstraintForces,
    Multipliers,
    MultiplierIsUnique,
    Residual,
    ResidualRate,
    Tension,
    TensionIsUnique,
    Energy,
}

/// The extent of a quantity.
enum Extent {
    /// One number.
    Single,
    /// d numbers for each particle.
    Particles,
    /// A number for each row.
    Rows,
    /// A number for each link.
    Links,
    /// A number for each part of the energy account.
    Energies,
}

impl Quantity {
    /// All of them, in the order of files.
    pub(crate) const ALL: [Quantity; 13] = [
        Quantity::Time,
        Quantity::Positions,
        Quantity::Velocities,
        Quantity::Accelerations,
        Quantity::AppliedForces,
        Quantity::ConstraintForces,
        Quantity::Multipliers,
        Quantity::MultiplierIsUnique,
        Quantity::Residual,
        Quantity::ResidualRate,
        Quantity::Tension,
        Quantity::TensionIsUnique,
        Quantity::Energy,
    ];

    /// The quantities that are written unless others are asked for.
    pub(crate) const USUAL: [Quantity; 7] = [
        Quantity::Time,
        Quantity::Positions,
        Quantity::Velocities,
        Quantity::ConstraintForces,
        Quantity::Multipliers,
        Quantity::Tension,
        Quantity::TensionIsUnique,
    ];

    /// The name of its array.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Quantity::Time => "t",
            Quantity::Positions => "positions",
            Quantity::Velocities => "velocities",
            Quantity::Accelerations => "accelerations",
            Quantity::AppliedForces => "applied_forces",
            Quantity::ConstraintForces => "constraint_forces",
            Quantity::Multipliers => "multipliers",
            Quantity::MultiplierIsUnique => "multiplier_is_unique",
            Quantity::Residual => "residual",
            Quantity::ResidualRate => "residual_rate",
            Quantity::Tension => "tension",
            Quantity::TensionIsUnique => "tension_is_unique",
            Quantity::Energy => "energy",
        }
    }

    fn extent(self) -> Extent {
        match self {
            Quantity::Time => Extent::Single,
            Quantity::Positions
            | Quantity::Velocities
            | Quantity::Accelerations
            | Quantity::AppliedForces
            | Quantity::ConstraintForces => Extent::Particles,
            Quantity::Multipliers | Quantity::MultiplierIsUnique | Quantity::Residual | Quantity::ResidualRate => {
                Extent::Rows
            }
            Quantity::Tension | Quantity::TensionIsUnique => Extent::Links,
            Quantity::Energy => Extent::Energies,
        }
    }

    /// The shape of a row.
    pub(crate) fn shape(self, system: &System) -> Vec<usize> {
        match self.extent() {
            Extent::Single => Vec::new(),
            Extent::Particles => vec![system.particle_count(), system.dimension()],
            Extent::Rows => vec![system.row_count()],
            Extent::Links => vec![system.links().count()],
            Extent::Energies => vec![ENERGIES.len()],
        }
    }

    /// The numbers of a row.
    pub(crate) fn row<'a>(self, frame: &'a Frame<'_>) -> Cow<'a, [f64]> {
        let terms = frame.terms;
        match self {
            Quantity::Time => Cow::Borrowed(std::slice::from_ref(&frame.time)),
            Quantity::Positions => Cow::Borrowed(&terms.positions),
            Quantity::Velocities => Cow::Borrowed(&terms.velocities),
            Quantity::Accelerations => Cow::Borrowed(&terms.accelerations),
            Quantity::AppliedForces => Cow::Borrowed(&terms.applied_forces),
            Quantity::ConstraintForces => Cow::Borrowed(&terms.constraint_forces),
            Quantity::Multipliers => Cow::Borrowed(&terms.multipliers),
            Quantity::MultiplierIsUnique => as_numbers(&terms.multiplier_is_unique),
            Quantity::Residual => Cow::Borrowed(&terms.residual),
            Quantity::ResidualRate => Cow::Borrowed(&terms.residual_rate),
            Quantity::Tension => Cow::Borrowed(&terms.tension),
            Quantity::TensionIsUnique => as_numbers(&terms.tension_is_unique),
            Quantity::Energy => {
                let Work { dissipation, stabilization, external, drives } = frame.energy.work;
                let Energy { kinetic, potential, .. } = frame.energy;
                Cow::Owned(vec![kinetic, potential, dissipation, stabilization, external, drives])
            }
        }
    }

    /// The names of its columns in a CSV.
    pub(crate) fn columns(self, system: &System) -> Vec<String> {
        let letter = match self {
            Quantity::Positions => "",
            Quantity::Velocities => "v",
            Quantity::Accelerations => "a",
            Quantity::AppliedForces => "applied_",
            _ => "f",
        };
        let axes = &AXES[..system.dimension()];
        let of_particle = |name: &String| axes.iter().map(|axis| format!("{name}.{letter}{axis}")).collect::<Vec<_>>();
        let word = match self {
            Quantity::Multipliers => "multiplier",
            other => other.name(),
        };
        match self.extent() {
            Extent::Single => vec![word.to_owned()],
            Extent::Particles => system.particle_names().iter().flat_map(of_particle).collect(),
            Extent::Rows => system.row_names().iter().map(|row| format!("{row}.{word}")).collect(),
            Extent::Links => system.links().map(|link| format!("{}.{word}", link.name)).collect(),
            Extent::Energies => ENERGIES.iter().map(|part| format!("energy.{part}")).collect(),
        }
    }
}

impl FromStr for Quantity {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Quantity::ALL.into_iter().find(|quantity| quantity.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Quantity::ALL.iter().map(|quantity| quantity.name()).collect();
            format!("there is no quantity `{name}`; there are {}, or all of them with `all`", names.join(", "))
        })
    }
}

/// The quantities of a list such as `positions,energy`, with the time; all of them for `all`.
pub(crate) fn selection(text: &str) -> Result<Vec<Quantity>, String> {
    if text.split(',').any(|name| name.trim() == "all") {
        return Ok(Quantity::ALL.to_vec());
    }
    let mut selected = text.split(',').map(|name| name.trim().parse()).collect::<Result<Vec<Quantity>, String>>()?;
    selected.push(Quantity::Time);
    selected.sort_unstable();
    selected.dedup();
    Ok(selected)
}

/// 1 for true and 0 for false: every array of a trajectory holds numbers.
fn as_numbers(flags: &[bool]) -> Cow<'static, [f64]> {
    Cow::Owned(flags.iter().map(|&flag| f64::from(u8::from(flag))).collect())
}
