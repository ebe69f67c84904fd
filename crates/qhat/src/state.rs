//! State: positions, velocities and time, and all that a restart needs to go on with the same bits.

use crate::modes::{Mode, Modes};
use crate::settings::Integrator;

/// q, q̇ and t, the energy account, and what an integrator carries from frame to frame.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) t: f64,
    pub(crate) work: Work,
    /// The mode of every contact, and the broken constraints.
    pub(crate) modes: Modes,
    pub(crate) carry: Option<Carry>,
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

/// The data that an integrator carries from one frame to the next.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Carry {
    /// The last multipliers, the first guess of the next.
    pub(crate) lambda: Vec<f64>,
    /// The substep to try next [s].
    pub(crate) substep: f64,
    /// Whether A was found singular at this state.
    pub(crate) deficient: bool,
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
pub(crate) struct Choice {
    pub(crate) integrator: Integrator,
    pub(crate) frames: u32,
}

/// A substep of a method of collocation: a guess for the next, and its error.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Collocation {
    /// The length of that substep [s].
    pub(crate) h: f64,
    /// Its error estimate, in the unit of the tolerance.
    pub(crate) error: f64,
    /// Changes of velocities and the multipliers of its three stages, one after the other.
    pub(crate) stages: Vec<f64>,
}

/// The state before the last step of a method that solves at the end of the step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Previous {
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    /// The length of that step [s].
    pub(crate) h: f64,
}

impl State {
    pub(crate) fn new(q: Vec<f64>, qd: Vec<f64>) -> Self {
        State { q, qd, t: 0.0, work: Work::default(), modes: Modes::default(), carry: None }
    }

    /// q \[m\], d·n numbers, particle after particle.
    pub fn positions(&self) -> &[f64] {
        &self.q
    }

    /// q̇ [m/s], d·n numbers, particle after particle.
    pub fn velocities(&self) -> &[f64] {
        &self.qd
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
        let mut state = State { q: positions, qd: velocities, carry: None, ..self.clone() };
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
