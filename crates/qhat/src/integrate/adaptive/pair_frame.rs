//! The frame of a pair: the choice of the path that solves the equation, and the substeps along that path.

use super::dop853::DOP853;
use super::pair::{Pair, PairStepper};
use super::{End, Substeps, begin};
use crate::chains::{Chains, TINY_PIVOT};
use crate::error::StepError;
use crate::integrate::events::EventStepper;
use crate::integrate::field::{ChainField, GeneralField};
use crate::integrate::frame::Frame;
use crate::multiplier::APPROACH;
use crate::report::{Solver, StepReport};
use crate::settings::Feedback;
use crate::state::State;
use crate::structure::ChainPlan;

/// Advances the state by one frame.
pub(crate) fn frame<const D: usize>(
    pair: &Pair,
    frame: &mut Frame<'_>,
    state: &mut State,
) -> Result<StepReport, StepError> {
    carry_on::<D>(pair, frame, state, usize::MAX).map(|(report, _)| report)
}

/// Advances the state by one frame, or as far as `limit` substeps go; says whether the frame is whole. Open chains are
/// solved by `chains/`; every other system, and chains that become singular on the way, by the general equation.
pub(crate) fn carry_on<const D: usize>(
    pair: &Pair,
    frame: &mut Frame<'_>,
    state: &mut State,
    limit: usize,
) -> Result<(StepReport, bool), StepError> {
    let system = frame.system;
    let substeps = Substeps::new(frame, state).within(limit);
    let mut carry = state.carry.take();
    let mut run = PairFrame { pair, frame, substeps };
    if let Some(plan) = &system.chains
        && !carry.as_ref().is_some_and(|carry| carry.is_nearly_singular)
    {
        run.substeps.report.solver = Solver::Chains;
        if plan.may_lose_rank && state.rank.is_none() {
            run.frame.workspace.solve::<D>(system, state, &Feedback::NONE);
            state.rank = run.frame.workspace.equation.rank_to_keep::<D>(system);
        }
        match run.along_chains::<D>(plan, state) {
            Ok(End::Singular) => carry = None,
            Ok(end) => return Ok((run.substeps.finish(run.frame, state, None), end == End::Whole)),
            Err(error) => return Err(run.substeps.fail(run.frame, error)),
        }
    }
    run.substeps.report.solver = Solver::Rows;
    let factorizations = run.frame.factorizations();
    let is_near = carry.as_ref().is_some_and(|carry| carry.is_nearly_singular);
    begin::<D>(run.frame, state, carry);
    let equation = &mut run.frame.workspace.equation;
    equation.rank = equation.rank_to_keep::<D>(system);
    if is_near {
        run.pair = &DOP853;
    }
    let mut end = run.by_rows::<D>(state, is_near);
    if let Ok(End::Singular) = end {
        run.pair = &DOP853;
        begin::<D>(run.frame, state, None);
        end = run.by_rows::<D>(state, false);
    }
    let PairFrame { frame, mut substeps, .. } = run;
    let end = match end {
        Ok(end) => end,
        Err(error) => return Err(substeps.fail(frame, error)),
    };
    if end == End::Whole && system.contacts.is_empty() {
        // A frame that ran out of work may have ended on a rejected substep: the factor is then that of one of its
        // stages.
        frame.workspace.note_factored(state);
    }
    substeps.report.factorizations += frame.factorizations() - factorizations;
    let lambda = frame.workspace.equation.lambda.clone();
    Ok((substeps.finish(frame, state, Some(lambda)), end == End::Whole))
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
        chains.tiny = state
            .rank
            .as_ref()
            .filter(|_| plan.may_lose_rank)
            .map_or(TINY_PIVOT, |rank| APPROACH * APPROACH * rank.least);
        let field = ChainField::<D> { system, plan, chains };
        let pair = self.pair;
        let mut stepper = PairStepper { pair, field, system, settings, stages: &mut stages, gives_up: false };
        stepper.begin(state);
        let end = self.substeps.run(&mut stepper, state);
        workspace.stages = stages;
        end
    }

    /// The substeps of any system, which end at events where there are contacts; events are reported in any case.
    /// `is_near`: the state is near a singular position.
    fn by_rows<const D: usize>(&mut self, state: &mut State, is_near: bool) -> Result<End, StepError> {
        let PairFrame { pair, frame, substeps } = self;
        let Frame { system, settings, length, ref mut workspace } = **frame;
        workspace.equation.solver.memory.forget();
        let mut stages = std::mem::take(&mut workspace.stages);
        let mut field = GeneralField::<D>::new(system, workspace, Feedback::NONE, true);
        field.skipped = is_near;
        let mut stepper = PairStepper { pair, field, system, settings, stages: &mut stages, gives_up: false };
        stepper.begin(state);
        let end = if system.contacts.is_empty() {
            substeps.run(&mut stepper, state)
        } else {
            EventStepper::begin(stepper, state, length).and_then(|mut stepper| {
                let end = substeps.run(&mut stepper, state);
                substeps.report.events.append(&mut stepper.events);
                stepper.warnings.drain(..).for_each(|warning| substeps.report.warn(warning));
                end
            })
        };
        workspace.stages = stages;
        end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::Workspace;
    use crate::settings::Settings;
    use crate::space::Dimension;
    use crate::system::{Particle, System};
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
