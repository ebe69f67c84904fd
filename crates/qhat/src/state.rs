//! State: positions, velocities and time, and all that a restart needs to go on with the same bits.

use crate::modes::{Mode, Modes};
use crate::settings::Integrator;
use std::sync::Arc;

/// q, q̇ and t, the energy account, and what an integrator carries from frame to frame.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) t: f64,
    pub(crate) work: Work,
    /// The mode of every contact, and the broken constraints.
    pub(crate) modes: Modes,
    /// s of the foot of every bead on its curve, in the order of the constraints; empty where no step has found them.
    pub(crate) feet: Vec<f64>,
    pub(crate) carry: Option<Carry>,
    /// `None` until the equation is first solved there.
    pub(crate) rank: Option<Arc<Rank>>,
}

/// Energy that has crossed the borders of the system since t = 0 \[J\]; positive into it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Work {
    /// Of forces without a potential: drag, dampers. Negative where they take energy.
    pub dissipation: f64,
    /// Of the constraint force, which does none on legal motion: feedback, diagonal drag, elasticity, projections.
    pub stabilization: f64,
    /// Of the hand that moves the mouse spring, and of changes made to the forces while running.
    pub external: f64,
    /// Of constraints that move with time: motors, cranks.
    pub drives: f64,
}

impl Work {
    /// All of it \[J\].
    pub fn total(&self) -> f64 {
        self.dissipation + self.stabilization + self.external + self.drives
    }
}

/// The rows that follow from others, found where the equation was first solved with these rows active. It stays until
/// a row that was left out is no longer satisfied by the others, or other rows become active.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rank {
    /// The number of rows of the system in which they were found; of another system the rank says nothing.
    pub(crate) rows: usize,
    /// For each row whether it was inactive; empty in a system without contacts.
    pub(crate) inactive: Vec<bool>,
    /// Rows that follow from others, ascending.
    pub(crate) dependent: Vec<u32>,
    /// The smallest pivot of the scaled A without these rows. Masses make it small, and so does a position near by
    /// where the rank drops.
    pub(crate) least: f64,
    /// The sine of the least independent row there, which masses do not change; 1 until it is computed.
    pub(crate) sine: f64,
}

/// The data that an integrator carries from one frame to the next.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Carry {
    /// The last multipliers, the first guess of the next.
    pub(crate) lambda: Vec<f64>,
    /// The substep to try next [s]; of a steady pace the longest that is allowed.
    pub(crate) substep: f64,
    pub(crate) steady: SteadyMemory,
    /// Whether the rank of A drops near this state.
    pub(crate) is_nearly_singular: bool,
    /// The start of the last step, for a method that looks back.
    pub(crate) previous: Option<Previous>,
    /// The last substep of a method of collocation.
    pub(crate) collocation: Option<Collocation>,
    /// Power of the drives at the end of the last step [W], for a rule that looks back.
    pub(crate) drives: f64,
    /// What auto chose for the next frames.
    pub(crate) choice: Option<Choice>,
}

/// An integrator that auto stays with, and for how many frames.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Choice {
    pub(crate) integrator: Integrator,
    pub(crate) frames: u32,
}

/// A substep of a method of collocation: a guess for the next, and its error.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Collocation {
    /// The length of that substep [s].
    pub(crate) h: f64,
    /// Its error estimate, in the unit of the tolerance.
    pub(crate) error: f64,
    /// Changes of velocities and the multipliers of its three stages, one after the other.
    pub(crate) stages: Vec<f64>,
}

/// What a method of constant substeps knows of their lengths.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SteadyMemory {
    /// Substeps in a row that would have been accepted at twice the length.
    pub(crate) calm: u64,
    /// How often a length proved too long, by the binary exponent of the length in s.
    pub(crate) too_long: Vec<(i32, u32)>,
}

/// The state before the last step of a method that solves at the end of the step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Previous {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    /// The length of that step [s].
    pub(crate) h: f64,
}

impl State {
    pub(crate) fn new(q: Vec<f64>, qd: Vec<f64>) -> Self {
        let (work, modes, feet) = (Work::default(), Modes::default(), Vec::new());
        State { q, qd, t: 0.0, work, modes, feet, carry: None, rank: None }
    }

    /// q \[m\], d·n numbers, particle after particle.
    pub fn positions(&self) -> &[f64] {
        &self.q
    }

    /// q̇ [m/s], d·n numbers, particle after particle.
    pub fn velocities(&self) -> &[f64] {
        &self.qd
    }

    /// The rank as it was found in a system of so many rows. Rows are added to a system where rods hold joints only to
    /// second order.
    pub(crate) fn rank_in(&self, rows: usize) -> Option<&Arc<Rank>> {
        self.rank.as_ref().filter(|rank| rank.rows == rows)
    }

    /// t \[s\].
    pub fn time(&self) -> f64 {
        self.t
    }

    /// The energy account.
    pub fn work(&self) -> Work {
        self.work
    }

    /// The same state with other positions \[m\] and velocities [m/s], d·n numbers each. The time, the
    /// work and the broken constraints stay.
    ///
    /// # Panics
    /// If the lengths differ from d·n.
    pub fn with_motion(&self, positions: Vec<f64>, velocities: Vec<f64>) -> State {
        assert_eq!((positions.len(), velocities.len()), (self.q.len(), self.qd.len()), "d·n numbers each");
        let state = self.clone();
        let mut state = State { q: positions, qd: velocities, feet: Vec::new(), carry: None, rank: None, ..state };
        // The next frame finds the contacts that are closed there. Broken constraints stay broken.
        state.modes.contacts.fill(Mode::Open);
        state
    }

    /// The former name of [`State::with_motion`].
    ///
    /// # Panics
    /// As [`State::with_motion`].
    #[deprecated(since = "0.1.0", note = "use `with_motion`")]
    pub fn at(&self, positions: Vec<f64>, velocities: Vec<f64>) -> State {
        self.with_motion(positions, velocities)
    }
}
