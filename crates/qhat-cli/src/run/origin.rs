//! The origin of a trajectory: the scene and settings from which it can be computed again, and the end of the run.

use super::Stop;
use super::frames::Frames;
use super::summary::Tally;
use crate::failure::Failure;
use crate::source::Source;
use crate::status::Status;
use qhat::{Feedback, Seconds, Settings, StepError};
use qhat_scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;

/// The origin, written with every trajectory.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Origin {
    qhat: &'static str,
    pub(crate) status: Status,
    pub(crate) error: Option<String>,
    pub(crate) scene: String,
    file: String,
    scene_hash: String,
    dimension: usize,
    pub(crate) integrator: &'static str,
    /// The step or frame \[s\].
    pub(crate) h: f64,
    tolerance: f64,
    constraint_tolerance: f64,
    feedback: FeedbackInUse,
    /// The duration asked for \[s\].
    pub(crate) duration: f64,
    /// The number of frames asked for, without the start.
    frames_asked: usize,
    /// t of the last good state \[s\].
    pub(crate) time_reached: f64,
    warnings: Vec<String>,
    /// The value of each parameter of the scene.
    parameters: BTreeMap<String, f64>,
}

/// The feedback that the integrator uses; zeros under an integrator that projects.
#[derive(Clone, Debug, Serialize)]
struct FeedbackInUse {
    ks: f64,
    kd: f64,
    diagonal_drag: f64,
    elasticity: f64,
}

impl Origin {
    pub(super) fn new(source: &Source, scene: &Scene, settings: &Settings, frames: Frames) -> Self {
        let projects = settings.integrator.projects();
        let Feedback { ks, kd, diagonal_drag, elasticity } =
            if projects { Feedback::NONE } else { *scene.system.feedback() };
        Origin {
            qhat: env!("CARGO_PKG_VERSION"),
            status: Status::Done,
            error: None,
            scene: scene.name.clone(),
            file: source.file_name(),
            scene_hash: source.hash(),
            dimension: scene.system.dimension(),
            integrator: settings.integrator.name(),
            h: settings.h,
            tolerance: settings.tolerance,
            constraint_tolerance: settings.constraint_tolerance,
            feedback: FeedbackInUse { ks, kd, diagonal_drag, elasticity },
            duration: frames.duration,
            frames_asked: frames.count,
            time_reached: 0.0,
            warnings: Vec::new(),
            parameters: scene.system.parameters().iter().map(|it| (it.name.clone(), it.value)).collect(),
        }
    }

    /// Notes that the run has reached a frame and has not ended.
    pub(super) fn reach(&mut self, tally: &Tally) {
        self.time_reached = tally.time_reached;
        self.warnings = tally.warnings();
        self.status = Status::Interrupted;
        self.error = Some(format!("a checkpoint at t = {} s of a run that did not end", Seconds(tally.time_reached)));
    }

    /// Notes the end of the run.
    ///
    /// # Errors
    /// Settings that the engine refused in the middle of the run.
    pub(super) fn close(&mut self, tally: &Tally, stopped: Option<&Stop>) -> Result<(), Failure> {
        self.time_reached = tally.time_reached;
        self.warnings = tally.warnings();
        (self.status, self.error) = match stopped {
            None => (Status::Done, None),
            Some(Stop::Interrupt) => {
                let reached = Seconds(tally.time_reached);
                (Status::Interrupted, Some(format!("stopped at t = {reached} s by Ctrl-C, SIGTERM or SIGHUP")))
            }
            Some(Stop::Unwritten(failure)) => {
                let message = format!("{}; of the frames before, those that were written are kept", failure.message());
                (Status::Interrupted, Some(message))
            }
            Some(Stop::Error(StepError::Settings(error))) => return Err(Failure::input(error)),
            Some(Stop::Error(error)) => (Status::of(error), Some(error.to_string())),
        };
        Ok(())
    }

    /// The same of a run whose earlier file `output` is kept, because a longer one does not fit on the disk.
    pub(super) fn kept_earlier(&self, output: &str) -> Self {
        let error = format!(
            "cannot write all frames to `{output}`: the disk is full; the file of before is kept, and \
             `qhat run --from {output}` goes on from it"
        );
        Origin { status: Status::Interrupted, error: Some(error), ..self.clone() }
    }

    /// The same of a trajectory whose last frames could not be written to `output`.
    pub(super) fn shortened(&self, output: &str) -> Self {
        let unwritten = format!("cannot write all frames to `{output}`; those that fit are kept");
        let error = match &self.error {
            Some(error) => format!("{error}; {unwritten}"),
            None => unwritten,
        };
        Origin { status: Status::Interrupted, error: Some(error), ..self.clone() }
    }
}
