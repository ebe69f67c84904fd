//! Workspace: the arrays that steps write in.

use super::runge_kutta::Stages;
use super::{implicit, rattle};
use crate::chains::Chains;
use crate::multiplier::{Equation, SolveFor};
use crate::point::Motion;
use crate::settings::Feedback;
use crate::state::State;
use crate::system::System;

/// Arrays that steps write in, made once for a system. Holds nothing that changes a result.
#[derive(Clone, Debug)]
pub struct Workspace {
    pub(super) equation: Equation,
    /// The state being tried.
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    /// The q, with t behind it, whose A the solver holds factored without ε; empty if that is not known.
    pub(super) factored_at: Vec<f64>,
    pub(super) delta: Vec<f64>,
    pub(super) stages: Stages,
    /// Made when a method first goes in chains.
    pub(super) chains: Option<Chains>,
    pub(super) rattle: rattle::Scratch,
    pub(super) implicit: Option<Box<implicit::Scratch>>,
}

impl Workspace {
    /// Arrays for one system.
    pub fn new(system: &System) -> Self {
        let coordinates = system.coordinate_count();
        Workspace {
            equation: Equation::new(system),
            q: vec![0.0; coordinates],
            qd: vec![0.0; coordinates],
            factored_at: Vec::new(),
            delta: vec![0.0; system.row_count()],
            stages: Stages::default(),
            chains: None,
            rattle: rattle::Scratch::new(system),
            implicit: None,
        }
    }

    pub(crate) fn equation(&self) -> &Equation {
        &self.equation
    }

    /// Solves the equation at a state; a factor of A that is there already is kept.
    pub(crate) fn solve<const D: usize>(&mut self, system: &System, state: &State, feedback: &Feedback) -> &Equation {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        let is_factored = feedback.diagonal_drag == 0.0 && self.is_factored_at(state);
        if !is_factored {
            self.equation.solver.stays_deficient = false;
        }
        self.set_modes(system, state);
        self.equation.solve(system, motion, feedback, is_factored, SolveFor::LeastNorm);
        self.factored_at.clear();
        if feedback.diagonal_drag == 0.0 {
            self.note_factored(state);
        }
        &self.equation
    }

    /// From now on those rows take part that do in the state.
    pub(crate) fn set_modes(&mut self, system: &System, state: &State) {
        if !system.contacts.is_empty() {
            self.equation.set_modes(system, &state.modes);
        }
    }

    /// Whether the factor at hand is that of A at the state.
    pub(super) fn is_factored_at(&self, state: &State) -> bool {
        self.factored_at.split_last() == Some((&state.t, &state.q[..]))
    }

    /// The factor at hand is that of A at the state.
    pub(super) fn note_factored(&mut self, state: &State) {
        self.factored_at.clone_from(&state.q);
        self.factored_at.push(state.t);
    }
}
