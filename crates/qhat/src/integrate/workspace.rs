//! Workspace: the arrays that steps write in, and the equation at a state.

use super::runge_kutta::Stages;
use super::watch::TensionWatch;
use super::{implicit, radau, rattle};
use crate::chains::Chains;
use crate::multiplier::{Equation, SolveFor};
use crate::point::Motion;
use crate::settings::Feedback;
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
    pub(super) radau: Option<Box<radau::Scratch>>,
    /// The record of the largest tension of a frame, if it is to be recorded. A frame loop takes it for the time that
    /// the loop runs, and puts it back.
    pub(super) watch: Option<TensionWatch>,
}

impl Workspace {
    /// Arrays for one system.
    pub fn new(system: &System) -> Self {
        let coordinates = system.coordinate_count();
        Workspace {
            equation: Equation::new(system),
            q: vec![0.0; coordinates],
            qd: vec![0.0; coordinates],
            delta: vec![0.0; system.row_count()],
            stages: Stages::default(),
            chains: None,
            rattle: rattle::Scratch::new(system),
            implicit: None,
            radau: None,
            watch: None,
        }
    }

    pub(crate) fn equation(&self) -> &Equation {
        &self.equation
    }

    /// Solves the equation at a state; a factor of A that is at hand is kept.
    pub(crate) fn solve<const D: usize>(&mut self, system: &System, state: &State, feedback: &Feedback) -> &Equation {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        self.set_modes(system, state);
        let is_factored = feedback.diagonal_drag == 0.0 && self.is_factored_at(state);
        if !is_factored {
            self.equation.solver.memory.ask_again();
        }
        self.equation.solve(system, motion, feedback, is_factored, SolveFor::LeastNorm);
        self.equation.solver.memory.forget();
        if feedback.diagonal_drag == 0.0 {
            self.note_factored(state);
        }
        &self.equation
    }

    /// Signed tension of every link at a state [N], as applied.
    pub(crate) fn tension(&mut self, system: &System, state: &State, feedback: &Feedback) -> Vec<f64> {
        in_dimension!(system.dimension, D => {
            let equation = self.solve::<D>(system, state, feedback);
            let (motion, s) = (Motion::<D> { q: &state.q, qd: &state.qd, t: state.t }, 1.0 - feedback.elasticity);
            let links = system.constraints.iter();
            let links = links.filter_map(|named| Some((named.constraint.as_link()?, named.first_row)));
            links.map(|(link, first_row)| link.tension(motion, &equation.lambda[first_row..], s)).collect()
        })
    }

    /// Takes the active rows from the modes of a state.
    pub(crate) fn set_modes(&mut self, system: &System, state: &State) {
        if !system.contacts.is_empty() {
            self.equation.set_modes(system, &state.modes);
        }
    }

    /// Whether the factor at hand is that of A at the state, under the active rows at hand.
    pub(super) fn is_factored_at(&self, state: &State) -> bool {
        self.equation.solver.memory.is_of(state, &self.equation.inactive)
    }

    /// Notes that the factor at hand is that of A at the state, under the active rows at hand.
    pub(super) fn note_factored(&mut self, state: &State) {
        let Equation { solver, inactive, .. } = &mut self.equation;
        solver.memory.note(state, inactive);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dimension, Gravity, Limits, Particle, Settings, project};

    /// A taut rope and a slack one may have the same q: the factor of one must not serve the other.
    #[test]
    fn a_factor_is_not_kept_for_other_modes() {
        let mut builder = System::builder(Dimension::Two);
        let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(2.0));
        builder
            .with_constraint("rope", Limits::rope(hook, bob, 1.0))
            .force(Gravity { acceleration: [0.0, -9.81, 0.0] });
        let (system, mut taut) = builder.build().unwrap();
        let mut workspace = Workspace::new(&system);
        project(&system, &mut taut, &Settings::default(), &mut workspace).unwrap();
        let slack = taut.with_motion(taut.positions().to_vec(), taut.velocities().to_vec());
        let tension = |workspace: &mut Workspace, state: &State| workspace.tension(&system, state, &Feedback::NONE);
        // The rope carries m g, to a few roundings of numbers of size 20.
        assert!((tension(&mut workspace, &taut)[0] - 2.0 * 9.81).abs() < 1e-13);
        assert_eq!(tension(&mut workspace, &slack), [0.0]);
        assert_eq!(tension(&mut workspace, &taut), tension(&mut Workspace::new(&system), &taut));
    }
}
