//! Embedded Runge–Kutta pairs: substeps by the estimated error, each projected onto the constraints.

use super::{Attempt, End, Outcome, Stepper, Substeps, accepts, begin, check_length};
use crate::chains::{Chains, Projected};
use crate::drift::Drift;
use crate::error::StepError;
use crate::integrate::events::EventStepper;
use crate::integrate::field::{ChainField, Field, GeneralField};
use crate::integrate::frame::Frame;
use crate::integrate::runge_kutta::{Combination, Squares, Stages, Tableau, advance};
use crate::linalg::eight::{Largest, vector_unit};
use crate::report::{Solver, StepReport};
use crate::settings::{Feedback, Settings};
use crate::state::State;
use crate::structure::ChainPlan;
use crate::system::System;

/// Part of the extent of the system below which the way of the fastest particle in one substep counts as rest.
const AT_REST: f64 = 1e-3;

/// Factor on the error estimate, which is a mean over all coordinates, while a large error may be in a few. With this
/// factor the default tolerance of 1e-4 left energy errors of 1e-7 to 3e-5 after 2 s of whipping chains; four times
/// looser, substeps ran against the bound of stability, and chains of 1000 links took more of them.
const ERROR_SCALE: f64 = 4.0;

/// A method with an error estimate.
#[derive(Debug)]
pub(crate) struct Pair {
    order: u32,
    tableau: Tableau,
    estimate: Combination,
    /// A second, coarser estimate, or the same: together |e|²/√(|e|² + 0.01 |e_coarse|²).
    coarse: Option<Combination>,
}

impl Pair {
    /// Number of solves of the equation in one substep.
    pub(crate) fn stages(&self) -> usize {
        self.tableau.stages
    }

    #[cfg(test)]
    pub(crate) fn tableau(&self) -> &Tableau {
        &self.tableau
    }

    pub(crate) const fn new(order: u32, tableau: Tableau, estimate: &[f64], coarse: Option<&[f64]>) -> Self {
        let coarse = match coarse {
            Some(weights) => Some(tableau.combination(weights)),
            None => None,
        };
        let estimate = tableau.combination(estimate);
        Pair { order, tableau, estimate, coarse }
    }
}

/// A pair under way over one frame.
pub(crate) struct PairStepper<'a, F> {
    pair: &'a Pair,
    pub(crate) field: F,
    pub(crate) system: &'a System,
    pub(crate) settings: &'a Settings,
    pub(crate) stages: &'a mut Stages,
}

/// Advances the state by one frame.
pub(crate) fn frame<const D: usize>(
    pair: &Pair,
    frame: &mut Frame<'_>,
    state: &mut State,
) -> Result<StepReport, StepError> {
    carry_on::<D>(pair, frame, state, usize::MAX).map(|(report, _)| report)
}

/// Advances the state by one frame, or as far as so many substeps go; says whether it is the whole frame. Open chains
/// are solved by `chains/`; every other system, and chains that become singular on the way, by the general equation.
pub(crate) fn carry_on<const D: usize>(
    pair: &Pair,
    frame: &mut Frame<'_>,
    state: &mut State,
    limit: usize,
) -> Result<(StepReport, bool), StepError> {
    check_length(frame.length)?;
    let system = frame.system;
    let mut substeps = Substeps::new(frame, state).within(limit);
    substeps.watch = frame.workspace.watch.take();
    let mut carry = state.carry.take();
    let mut run = PairFrame { pair, frame, substeps };
    if let Some(plan) = &system.chains
        && !carry.as_ref().is_some_and(|carry| carry.deficient)
    {
        run.substeps.report.solver = Solver::Chains;
        match run.along_chains::<D>(plan, state) {
            Ok(End::Singular) => carry = None,
            end => {
                run.frame.workspace.watch = run.substeps.watch.take();
                return end.map(|end| (run.substeps.finish(state, None), end == End::Whole));
            }
        }
    }
    run.substeps.report.solver = Solver::Rows;
    let factorizations = run.frame.factorizations();
    begin::<D>(run.frame, state, carry);
    let end = run.by_rows::<D>(state);
    let PairFrame { frame, mut substeps, .. } = run;
    // Also after an error, after which `auto` may go on with another method.
    frame.workspace.watch = substeps.watch.take();
    let end = end?;
    if end == End::Whole && system.contacts.is_empty() {
        // A frame that ran out of work may have ended on a rejected substep: the factor is then that of one of its
        // stages.
        frame.workspace.note_factored(state);
    }
    substeps.report.factorizations += frame.factorizations() - factorizations;
    let equation = &frame.workspace.equation;
    Ok((substeps.finish(state, Some((equation.lambda.clone(), equation))), end == End::Whole))
}

/// A pair, the frame that it advances by, and the substeps of that frame.
struct PairFrame<'a, 'f> {
    pair: &'a Pair,
    frame: &'a mut Frame<'f>,
    substeps: Substeps<'f>,
}

impl PairFrame<'_, '_> {
    /// The substeps of open chains, eight side by side.
    fn along_chains<const D: usize>(&mut self, plan: &ChainPlan, state: &mut State) -> Result<End, StepError> {
        let Frame { system, settings, ref mut workspace, .. } = *self.frame;
        let mut stages = std::mem::take(&mut workspace.stages);
        let chains = workspace.chains.get_or_insert_with(|| Chains::new(system, plan));
        let field = ChainField::<D> { system, plan, chains };
        let mut stepper = PairStepper { pair: self.pair, field, system, settings, stages: &mut stages };
        stepper.begin(state);
        let end = self.substeps.run(&mut stepper, state);
        workspace.stages = stages;
        end
    }

    /// The substeps of any system, which end at events where there are contacts; events are reported in any case.
    fn by_rows<const D: usize>(&mut self, state: &mut State) -> Result<End, StepError> {
        let PairFrame { pair, frame, substeps } = self;
        let Frame { system, settings, length, ref mut workspace } = **frame;
        workspace.equation.solver.memory.forget();
        let mut stages = std::mem::take(&mut workspace.stages);
        let field = GeneralField::<D> { system, workspace, feedback: Feedback::NONE, is_factored: true };
        let mut stepper = PairStepper { pair, field, system, settings, stages: &mut stages };
        stepper.begin(state);
        let end = if system.contacts.is_empty() {
            substeps.run(&mut stepper, state)
        } else {
            EventStepper::begin(stepper, state, length).and_then(|mut stepper| {
                let end = substeps.run(&mut stepper, state);
                substeps.report.events.append(&mut stepper.events);
                end
            })
        };
        workspace.stages = stages;
        end
    }
}

impl<F: Field> Stepper for PairStepper<'_, F> {
    fn estimate_order(&self) -> f64 {
        f64::from(self.pair.order)
    }

    fn longest(&mut self, _: &State) -> f64 {
        f64::INFINITY
    }

    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome {
        let Some(work) = advance(&self.pair.tableau, &mut self.field, self.stages, state.t, h) else {
            return if self.stages.overflow() { Outcome::NotMet } else { Outcome::Singular };
        };
        let error = self.error(h);
        if error.is_nan() && self.stages.overflow() {
            return Outcome::NotMet;
        }
        let mut attempt = Attempt { h, error, iterations: 0, dissipation: work.dissipation, drives: work.drives };
        if !accepts(error, self.settings) {
            return Outcome::Met(attempt);
        }
        let Stages { next_q, next_qd, .. } = self.stages;
        match self.field.project(next_q, next_qd, end, self.settings) {
            Projected::Met(iterations) => {
                attempt.iterations = iterations;
                Outcome::Met(attempt)
            }
            Projected::NotMet => Outcome::NotMet,
            Projected::Singular => Outcome::Singular,
        }
    }

    fn keep(&mut self, _: &mut State, _: f64) -> Drift {
        self.stages.accept();
        self.field.drift(&self.stages.q, &self.stages.qd)
    }

    fn turn_back(&mut self, _: &State) {
        self.field.turn_back();
    }

    fn end(&mut self, state: &mut State) {
        self.field.end(&self.stages.q, &self.stages.qd, state);
    }

    fn write_tried(&self, state: &mut State) {
        self.field.end(&self.stages.next_q, &self.stages.next_qd, state);
    }
}

impl<F: Field> PairStepper<'_, F> {
    /// Takes the motion of a state.
    fn begin(&mut self, state: &State) {
        self.stages.resize(self.field.blocks());
        self.field.begin(state, &mut self.stages.q, &mut self.stages.qd);
    }

    /// The error estimate: that of positions relative to the extent, or of velocities relative to the fastest,
    /// whichever is larger.
    fn error(&self, h: f64) -> f64 {
        let fastest = vector_unit().dispatch(Largest(&self.stages.next_qd));
        // A system at rest to roundoff has no speed to compare with.
        let speed = fastest.max(AT_REST * self.system.extent / h);
        let coarse = self.pair.coarse.as_ref().unwrap_or(&self.pair.estimate);
        let coordinates = self.system.coordinate_count().max(1) as f64;
        let estimates = [&self.pair.estimate, coarse];
        let squares = Squares { estimates, field: &self.field, stages: self.stages, h };
        let squares = vector_unit().dispatch(squares);
        let [q, qd, coarse_q, coarse_qd] = squares.map(|sum| (sum / coordinates).sqrt());
        let mut largest = 0.0_f64;
        for (fine, coarse, scale) in [(q, coarse_q, self.system.extent), (qd, coarse_qd, speed)] {
            let is_plain = self.pair.coarse.is_none() || fine == 0.0;
            let estimate = if is_plain { fine } else { fine * fine / (fine * fine + 0.01 * coarse * coarse).sqrt() };
            let error = ERROR_SCALE * h * estimate / scale;
            largest = if error.is_nan() { error } else { largest.max(error) };
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use super::super::dop853::DOP853;
    use super::*;
    use crate::integrate::Workspace;
    use crate::space::Dimension;
    use crate::system::Particle;
    use crate::{Distance, Gravity};

    /// The work ends on a rejected substep: the next solve must not use the factor of one of its stages.
    #[test]
    fn work_that_runs_out_leaves_no_factor_of_a_stage() {
        let mut builder = System::builder(Dimension::Two);
        let corners =
            [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75]].map(|x| builder.particle(Particle::at(format!("{x:?}"), x)));
        let hook = builder.particle(Particle::at("hook", [-0.6, 0.8]).fixed());
        for (name, a, b) in [("ab", 0, 1), ("bc", 1, 2), ("ca", 2, 0)] {
            let length = if name == "ab" { 1.0 } else { 0.8125_f64.sqrt() };
            builder.constraint(name, Distance::new(corners[a], corners[b], length));
        }
        builder.constraint("hanger", Distance::new(hook, corners[0], 1.0));
        builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
        let (system, start) = builder.build().unwrap();
        let settings = Settings::default();
        let (mut state, mut workspace) = (start.clone(), Workspace::new(&system));
        let mut frame = Frame { system: &system, settings: &settings, workspace: &mut workspace, length: 2.0 };
        let (report, is_whole) = carry_on::<2>(&DOP853, &mut frame, &mut state, 1).unwrap();
        assert_eq!((report.substeps, report.rejected, is_whole), (0, 1, false));
        assert_eq!(state.q, start.q);
        let expected = Workspace::new(&system).solve::<2>(&system, &state, &Feedback::NONE).lambda.clone();
        assert_eq!(workspace.solve::<2>(&system, &state, &Feedback::NONE).lambda, expected);
    }
}
