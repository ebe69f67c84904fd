//! The quantities of a trajectory: for each its name, its shape, its columns in a CSV and its numbers in a frame.

use qhat::{Energy, System, Terms, Work};
use std::borrow::Cow;
use std::str::FromStr;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The parts of the energy account, in the order of its array [J].
pub(crate) const ENERGIES: [&str; 6] = ["kinetic", "potential", "dissipation", "stabilization", "external", "drives"];

/// Everything that is known at a frame.
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

use Quantity::*;

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
    ];

    /// Those that are written unless others are asked for.
    pub(crate) const USUAL: [Quantity; 7] =
        [Time, Positions, Velocities, ConstraintForces, Multipliers, Tension, TensionIsUnique];

    /// The name of its array.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Time => "t",
            Positions => "positions",
            Velocities => "velocities",
            Accelerations => "accelerations",
            AppliedForces => "applied_forces",
            ConstraintForces => "constraint_forces",
            Multipliers => "multipliers",
            MultiplierIsUnique => "multiplier_is_unique",
            Residual => "residual",
            ResidualRate => "residual_rate",
            Tension => "tension",
            TensionIsUnique => "tension_is_unique",
            Energy => "energy",
        }
    }

    fn extent(self) -> Extent {
        match self {
            Time => Extent::Single,
            Positions | Velocities | Accelerations | AppliedForces | ConstraintForces => Extent::Particles,
            Multipliers | MultiplierIsUnique | Residual | ResidualRate => Extent::Rows,
            Tension | TensionIsUnique => Extent::Links,
            Energy => Extent::Energies,
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
            Time => Cow::Borrowed(std::slice::from_ref(&frame.time)),
            Positions => Cow::Borrowed(&terms.positions),
            Velocities => Cow::Borrowed(&terms.velocities),
            Accelerations => Cow::Borrowed(&terms.accelerations),
            AppliedForces => Cow::Borrowed(&terms.applied_forces),
            ConstraintForces => Cow::Borrowed(&terms.constraint_forces),
            Multipliers => Cow::Borrowed(&terms.multipliers),
            MultiplierIsUnique => as_numbers(&terms.multiplier_is_unique),
            Residual => Cow::Borrowed(&terms.residual),
            ResidualRate => Cow::Borrowed(&terms.residual_rate),
            Tension => Cow::Borrowed(&terms.tension),
            TensionIsUnique => as_numbers(&terms.tension_is_unique),
            Energy => {
                let Work { dissipation, stabilization, external, drives } = frame.energy.work;
                let qhat::Energy { kinetic, potential, .. } = frame.energy;
                Cow::Owned(vec![kinetic, potential, dissipation, stabilization, external, drives])
            }
        }
    }

    /// The names of its columns in a CSV.
    pub(crate) fn columns(self, system: &System) -> Vec<String> {
        let letter = match self {
            Positions => "",
            Velocities => "v",
            Accelerations => "a",
            AppliedForces => "applied_",
            _ => "f",
        };
        let axes = &AXES[..system.dimension()];
        let of_particle = |name: &String| axes.iter().map(|axis| format!("{name}.{letter}{axis}")).collect::<Vec<_>>();
        let word = match self {
            Multipliers => "multiplier",
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
    if text.trim() == "all" {
        return Ok(Quantity::ALL.to_vec());
    }
    let mut selected = text.split(',').map(|name| name.trim().parse()).collect::<Result<Vec<Quantity>, String>>()?;
    selected.push(Time);
    selected.sort_unstable();
    selected.dedup();
    Ok(selected)
}

/// 1 for true and 0 for false: every array of a trajectory holds numbers.
fn as_numbers(flags: &[bool]) -> Cow<'static, [f64]> {
    Cow::Owned(flags.iter().map(|&flag| f64::from(u8::from(flag))).collect())
}
