//! The quantities of a trajectory: for each its name, its shape, its columns in a CSV and its numbers in a frame.

use qhat::{Energy, Pose, Powers, System, Terms, Work};
use qhat_scene::SceneBody;
use std::borrow::Cow;
use std::str::FromStr;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The parts of the energy account, in the order of its array [J].
pub(crate) const ENERGIES: [&str; 6] = ["kinetic", "potential", "dissipation", "stabilization", "external", "drives"];

/// The readings of a frame. Powers and poses are empty where no array asks for them.
pub(crate) struct Frame {
    /// \[s\].
    pub(crate) time: f64,
    pub(crate) terms: Terms,
    pub(crate) energy: Energy,
    pub(crate) powers: Powers,
    /// One for each body of the scene.
    pub(crate) poses: Vec<Pose>,
}

/// The parts of a scene that have quantities.
#[derive(Clone, Copy)]
pub(crate) struct Subjects<'a> {
    pub(crate) system: &'a System,
    pub(crate) bodies: &'a [SceneBody],
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
    ForcePower,
    ConstraintPower,
    BodyCenter,
    BodyRotation,
    BodyVelocity,
    BodySpin,
    BodyAngularMomentum,
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
    /// A number for each force.
    Forces,
    /// A number for each constraint.
    Constraints,
    /// d numbers for each body.
    BodyVectors,
    /// For each body a turn about z, or in space three components.
    BodyTurns,
    /// For each body an angle, or in space a quaternion.
    BodyRotations,
}

impl Quantity {
    /// All of them, in the order of files.
    pub(crate) const ALL: [Quantity; 20] = [
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
        Quantity::ForcePower,
        Quantity::ConstraintPower,
        Quantity::BodyCenter,
        Quantity::BodyRotation,
        Quantity::BodyVelocity,
        Quantity::BodySpin,
        Quantity::BodyAngularMomentum,
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
            Quantity::ForcePower => "force_power",
            Quantity::ConstraintPower => "constraint_power",
            Quantity::BodyCenter => "body_center",
            Quantity::BodyRotation => "body_rotation",
            Quantity::BodyVelocity => "body_velocity",
            Quantity::BodySpin => "body_spin",
            Quantity::BodyAngularMomentum => "body_angular_momentum",
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
            Quantity::ForcePower => Extent::Forces,
            Quantity::ConstraintPower => Extent::Constraints,
            Quantity::BodyCenter | Quantity::BodyVelocity => Extent::BodyVectors,
            Quantity::BodyRotation => Extent::BodyRotations,
            Quantity::BodySpin | Quantity::BodyAngularMomentum => Extent::BodyTurns,
        }
    }

    /// Whether it is one of the powers.
    pub(crate) fn is_power(self) -> bool {
        matches!(self.extent(), Extent::Forces | Extent::Constraints)
    }

    /// Whether it is one of the bodies.
    pub(crate) fn is_of_bodies(self) -> bool {
        matches!(self.extent(), Extent::BodyVectors | Extent::BodyTurns | Extent::BodyRotations)
    }

    /// The names of the parts that its numbers belong to, with the name of their array, where they are not those of
    /// every trajectory.
    pub(crate) fn names(self, Subjects { system, bodies }: Subjects<'_>) -> Option<(&'static str, Vec<String>)> {
        match self.extent() {
            Extent::Single | Extent::Particles | Extent::Rows | Extent::Links => None,
            Extent::Energies => Some(("energy_names", ENERGIES.map(str::to_owned).to_vec())),
            Extent::Forces => Some(("force_names", system.force_names())),
            Extent::Constraints => {
                Some(("constraint_names", system.constraints().iter().map(|named| named.name.clone()).collect()))
            }
            Extent::BodyVectors | Extent::BodyTurns | Extent::BodyRotations => {
                Some(("body_names", bodies.iter().map(|body| body.name.clone()).collect()))
            }
        }
    }

    /// The shape of a row.
    pub(crate) fn shape(self, Subjects { system, bodies }: Subjects<'_>) -> Vec<usize> {
        let (d, in_plane) = (system.dimension(), system.dimension() == 2);
        match self.extent() {
            Extent::Single => Vec::new(),
            Extent::Particles => vec![system.particle_count(), d],
            Extent::Rows => vec![system.row_count()],
            Extent::Links => vec![system.links().count()],
            Extent::Energies => vec![ENERGIES.len()],
            Extent::Forces => vec![system.force_names().len()],
            Extent::Constraints => vec![system.constraints().len()],
            Extent::BodyVectors => vec![bodies.len(), d],
            Extent::BodyTurns | Extent::BodyRotations if in_plane => vec![bodies.len()],
            Extent::BodyTurns => vec![bodies.len(), 3],
            Extent::BodyRotations => vec![bodies.len(), 4],
        }
    }

    /// The numbers of a row.
    pub(crate) fn row(self, frame: &Frame) -> Cow<'_, [f64]> {
        let terms = &frame.terms;
        let d = terms.positions.len() / terms.inverse_masses.len().max(1);
        let vectors = |of: &dyn Fn(&Pose) -> [f64; 3]| {
            Cow::Owned(frame.poses.iter().flat_map(|pose| of(pose).into_iter().take(d)).collect())
        };
        let turns = |of: &dyn Fn(&Pose) -> [f64; 3]| {
            let from = if d == 2 { 2 } else { 0 };
            Cow::Owned(frame.poses.iter().flat_map(|pose| of(pose).into_iter().skip(from)).collect())
        };
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
            Quantity::ForcePower => Cow::Borrowed(&frame.powers.forces),
            Quantity::ConstraintPower => Cow::Borrowed(&frame.powers.constraints),
            Quantity::BodyCenter => vectors(&|pose| pose.center),
            Quantity::BodyVelocity => vectors(&|pose| pose.velocity),
            Quantity::BodySpin => turns(&|pose| pose.spin),
            Quantity::BodyAngularMomentum => turns(&|pose| pose.angular_momentum),
            Quantity::BodyRotation if d == 2 => Cow::Owned(frame.poses.iter().map(Pose::angle).collect()),
            Quantity::BodyRotation => Cow::Owned(frame.poses.iter().flat_map(|pose| pose.rotation).collect()),
        }
    }

    /// The names of its columns in a CSV.
    pub(crate) fn columns(self, subjects: Subjects<'_>) -> Vec<String> {
        let system = subjects.system;
        let letter = match self {
            Quantity::Positions => "",
            Quantity::Velocities => "v",
            Quantity::Accelerations => "a",
            Quantity::AppliedForces => "applied_",
            _ => "f",
        };
        let word = match self {
            Quantity::Multipliers => "multiplier",
            Quantity::BodyCenter => "center",
            Quantity::BodyRotation => "rotation",
            Quantity::BodyVelocity => "velocity",
            Quantity::BodySpin => "spin",
            Quantity::BodyAngularMomentum => "angular_momentum",
            other => other.name(),
        };
        let axes = &AXES[..system.dimension()];
        let of_particle = |name: &String| axes.iter().map(|axis| format!("{name}.{letter}{axis}")).collect::<Vec<_>>();
        let each = |names: Vec<String>| names.into_iter().map(|name| format!("{name}.{word}")).collect();
        let of_body = |parts: &[&str]| {
            let column = |name: &str| parts.iter().map(|part| format!("{name}.{word}.{part}")).collect::<Vec<_>>();
            subjects.bodies.iter().flat_map(|body| column(&body.name)).collect()
        };
        let names = || self.names(subjects).map(|(_, names)| names).unwrap_or_default();
        match self.extent() {
            Extent::Single => vec![word.to_owned()],
            Extent::Particles => system.particle_names().iter().flat_map(of_particle).collect(),
            Extent::Rows => each(system.row_names().to_vec()),
            Extent::Links => each(system.links().map(|link| link.name.to_owned()).collect()),
            Extent::Energies => ENERGIES.iter().map(|part| format!("energy.{part}")).collect(),
            Extent::Forces | Extent::Constraints => each(names()),
            Extent::BodyTurns | Extent::BodyRotations if system.dimension() == 2 => each(names()),
            Extent::BodyVectors => of_body(axes),
            Extent::BodyTurns => of_body(&AXES),
            Extent::BodyRotations => of_body(&["w", "x", "y", "z"]),
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
