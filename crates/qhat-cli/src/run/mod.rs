//! `qhat run`: from a scene to a trajectory and a summary.

mod events;
pub(crate) mod frames;
pub(crate) mod interrupt;
mod origin;
pub(crate) mod progress;
mod summary;

use crate::arguments;
use crate::failure::{BAD_INPUT, Failure, warn};
use crate::print;
use crate::source::Source;
use crate::trajectory::{Kept, Recorder, Target};
use cpu_time::ProcessTime;
use frames::Frames;
use interrupt::Interrupt;
use origin::Origin;
use progress::Progress;
use qhat::{Settings, Simulation, StepError, System, Terms, evaluate};
use std::process::ExitCode;
use std::time::Instant;
use summary::{Summary, Tally};

/// Simulates a scene as the arguments say.
pub(crate) fn run(arguments: &arguments::Run) -> Result<ExitCode, Failure> {
    let began = Instant::now();
    let source = Source::read(&arguments.scene)?;
    let scene = source.load(&arguments.parameters.set).map_err(Failure::formatted)?;
    let settings = settings(arguments, scene.settings)?;
    // An integrator from the command line may find no events, which the reader of the scene could not know.
    qhat::check_start(&scene.system, &scene.state, &settings).map_err(Failure::input)?;
    let frames = Frames::new(arguments.duration.unwrap_or(scene.duration), arguments.frames, &settings)?;
    let target = arguments.output.as_deref().map(|path| Target::new(path, arguments.force)).transpose()?;
    let output = target.as_ref().map(|target| target.path().display().to_string());
    // Ctrl-C is handled before the first file exists, so that no temporary file is left behind.
    let interrupt = Interrupt::watch()?;
    let recorder = target.map(|target| Recorder::new(target, &scene.system)).transpose()?;
    let mut origin = Origin::new(&source, &scene, &settings, frames);

    let progress = Progress::new(frames, arguments.quiet);
    let mut job = Job { frames, recorder, tally: Tally::default(), progress, interrupt };
    let (system, state) = (scene.system, scene.state);
    let stopped = match Simulation::new(system.clone(), state.clone(), settings) {
        Ok(mut simulation) => {
            simulation.record_tension(!arguments.no_tension);
            job.simulate(simulation)?
        }
        // Where no positions satisfy the constraints, the start is the only frame.
        Err(error) => {
            job.start(&system, &evaluate(&system, &state))?;
            Some(Stop::Error(error))
        }
    };
    job.progress.finish();

    origin.close(&job.tally, stopped.as_ref())?;
    let mut is_unwritten = matches!(stopped, Some(Stop::Unwritten(_)));
    if let Some(recorder) = job.recorder {
        let shortened =
            if is_unwritten { origin.clone() } else { origin.shortened(output.as_deref().unwrap_or_default()) };
        let [whole, part] = [&origin, &shortened].map(serde_json::to_string);
        let (whole, part) = (whole.map_err(Failure::input)?, part.map_err(Failure::input)?);
        if recorder.finish(&whole, &part)? == Kept::Part {
            (origin, is_unwritten) = (shortened, true);
        }
    }
    let summary = Summary::new(&origin, &job.tally, began.elapsed(), output);
    if arguments.json {
        print::json(&summary)?;
    } else if !arguments.quiet {
        summary.print()?;
    }
    if let Some(message) = &origin.error {
        warn(format!("{}: {message}", origin.status));
    }
    Ok(if is_unwritten { ExitCode::from(BAD_INPUT) } else { origin.status.exit_code() })
}

/// The scene's settings, changed by the options of the command line.
fn settings(arguments: &arguments::Run, scene: Settings) -> Result<Settings, Failure> {
    let mut settings = scene;
    if let Some(h) = arguments.h {
        settings.h = h;
    }
    if let Some(integrator) = arguments.integrator {
        settings.integrator = integrator;
    }
    if let Some(tolerance) = arguments.tolerance {
        settings.tolerance = tolerance;
    }
    if let Some(max_substeps) = arguments.max_substeps {
        settings.max_substeps = max_substeps;
    }
    settings.check().map_err(Failure::input)?;
    Ok(settings)
}

/// The reason why a run ended early.
enum Stop {
    Error(StepError),
    Interrupt,
    /// A frame could not be written.
    Unwritten(Failure),
}

/// A run in progress.
struct Job {
    frames: Frames,
    recorder: Option<Recorder>,
    tally: Tally,
    progress: Progress,
    interrupt: Interrupt,
}

impl Job {
    /// Steps from frame to frame. Returns the reason where the run ends early.
    fn simulate(&mut self, mut simulation: Simulation) -> Result<Option<Stop>, Failure> {
        self.tally.begun(&simulation);
        let terms = simulation.terms();
        self.start(simulation.system(), &terms)?;
        for index in 1..=self.frames.count {
            if self.interrupt.came() {
                return Ok(Some(Stop::Interrupt));
            }
            let clock = ProcessTime::now();
            let outcome = simulation.advance(self.frames.length());
            self.tally.cpu += clock.elapsed();
            self.tally.reached(&simulation);
            match outcome {
                Ok(report) => self.tally.step(simulation.system(), &report, self.frames.time(index)),
                // The frame is no multiple of h, so the options are at fault. The state is unchanged.
                Err(StepError::Settings(error)) => return Err(self.frames.refused(&error, simulation.settings())),
                Err(error) => return Ok(Some(Stop::Error(error))),
            }
            if self.recorder.is_some() {
                let terms = simulation.terms();
                if let Err(failure) = self.record(simulation.system(), self.frames.time(index), &terms) {
                    return Ok(Some(Stop::Unwritten(failure)));
                }
            } else {
                self.tally.frames += 1;
            }
            self.progress.at(index, self.frames.time(index));
        }
        Ok(None)
    }

    fn start(&mut self, system: &System, terms: &Terms) -> Result<(), Failure> {
        self.tally.start(system, terms);
        self.record(system, 0.0, terms)
    }

    fn record(&mut self, system: &System, time: f64, terms: &Terms) -> Result<(), Failure> {
        self.tally.frame(system, time, terms);
        match &mut self.recorder {
            Some(recorder) => recorder.frame(time, terms),
            None => Ok(()),
        }
    }
}
