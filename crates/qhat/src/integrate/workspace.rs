//! Workspace: the arrays that steps write in.

use super::reading::Reading;
use super::runge_kutta::Stages;
use super::watch::TensionWatch;
use super::{implicit, radau, rattle};
use crate::chains::Chains;
use crate::multiplier::Equation;
use crate::space::in_dimension;
use crate::state::State;
use crate::system::System;

/// Arrays that steps write in, made once for a system. Nothing in it changes a result.
#[derive(Clone, Debug)]
pub struct Workspace {
    pub(super) equation: Equation,
    /// The state being tried.
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    /// A correction of λ, m numbers.
    pub(super) delta: Vec<f64>,
    pub(super) stages: Stages,
    /// Made when a method first solves open chains eight side by side.
    pub(super) chains: Option<Chains>,
    pub(super) rattle: rattle::Scratch,
    pub(super) implicit: Option<Box<implicit::Scratch>>,
    /// The arrays for the share of redundant rows, for readers of λ and tension.
    pub(super) reading: Reading,
    pub(super) radau: Option<Box<radau::Scratch>>,
    /// The record of the largest tension of a frame, if it is to be recorded. A frame loop takes it for the time that
    /// the loop runs, and puts it back.
    pub(super) watch: Option<TensionWatch>,
    /// The values of the parameters of the system, on which masses and lengths in these arrays depend.
    bound: Vec<f64>,
}

impl Workspace {
    /// Arrays for one system.
    pub fn new(system: &System) -> Self {
        let coordinates = system.coordinate_count();
        Workspace {
            equation: Equation::new(system),
            q: vec![0.0; coordinates],
            qd: vec![0.0; coordinates],
            delta: vec![0.0; system.all_row_count()],
            stages: Stages::default(),
            chains: None,
            rattle: rattle::Scratch::new(system),
            implicit: None,
            reading: Reading::default(),
            radau: None,
            watch: None,
            bound: system.parameters().iter().map(|parameter| parameter.value).collect(),
        }
    }

    /// Makes the arrays anew if the system was bound to other values of its parameters.
    pub(crate) fn follow(&mut self, system: &System) {
        if !self.bound.iter().eq(system.parameters().iter().map(|parameter| &parameter.value)) {
            *self = self.renewed(system);
        }
    }

    pub(crate) fn equation(&self) -> &Equation {
        &self.equation
    }

    /// Takes the active rows from the modes of a state, the feet of beads, and the rows that follow from others. A
    /// factor of A without other rows is forgotten.
    pub(crate) fn set_modes(&mut self, system: &System, state: &State) {
        in_dimension!(system.dimension, D => self.equation.place_feet::<D>(system, state));
        let rank = state.rank_in(system.all_row_count());
        if rank.is_none() || rank != self.equation.rank.as_ref() {
            self.equation.rank = rank.cloned();
            self.equation.solver.memory.forget();
        }
        if !system.contacts.is_empty() {
            self.equation.set_modes(system, &state.modes);
        }
    }

    /// Whether the factor at hand is that of A at the state, under the active rows at hand. With beads it is not known:
    /// a foot that was sought from another place differs in its last bits.
    pub(super) fn is_factored_at(&self, state: &State) -> bool {
        self.equation.rows.feet.is_empty() && self.equation.solver.memory.is_of(state, &self.equation.inactive)
    }

    /// Notes that the factor at hand is that of A at the state, under the active rows at hand.
    pub(super) fn note_factored(&mut self, state: &State) {
        let Equation { solver, inactive, .. } = &mut self.equation;
        solver.memory.note(state, inactive);
    }
}
