//! `qhat run`: from a scene to a trajectory and a summary.

mod checkpoints;
mod events;
pub(crate) mod frames;
pub(crate) mod interrupt;
mod origin;
pub(crate) mod progress;
mod reading;
mod snapshot;
mod summary;

use crate::arguments;
use crate::failure::{BAD_INPUT, Failure, warn};
use crate::print;
use crate::source::Source;
use crate::trajectory::{Extras, Format, Frame, Kept, Quantity, Recorder, Stored, Subjects, Target};
use checkpoints::Checkpoints;
use cpu_time::ProcessTime;
use frames::Frames;
use interrupt::Interrupt;
use origin::Origin;
use progress::Progress;
use qhat::{Settings, Simulation, StepError, System};
use qhat_scene::Scene;
use reading::Reader;
use snapshot::Former;
use std::process::ExitCode;
use std::time::Instant;
use summary::{Summary, Tally};

/// Simulates a scene as the arguments say.
pub(crate) fn run(arguments: &arguments::Run) -> Result<ExitCode, Failure> {
    let began = Instant::now();
    let mut before = arguments.from.as_deref().map(Stored::open).transpose()?;
    let Plan { source, scene, parameters, settings, frames, former } = Plan::of(arguments, before.as_mut())?;
    let target = Plan::target(arguments)?;
    let output = target.as_ref().map(|target| target.path().display().to_string());
    // Ctrl-C is handled before the first file exists, so that no temporary file is left behind.
    let interrupt = Interrupt::watch()?;
    let quantities = match (&before, &arguments.select) {
        (Some(before), _) => before.quantities(),
        (None, Some(selected)) => selected.to_vec(),
        (None, None) => Quantity::USUAL.to_vec(),
    };
    let reader = Reader::new(&scene, if target.is_some() { &quantities } else { &[] });
    let subjects = Subjects { system: &scene.system, bodies: &scene.bodies };
    let mut recorder = target.map(|target| Recorder::new(target, subjects, quantities)).transpose()?;
    if let (Some(recorder), Some(before)) = (&mut recorder, &mut before) {
        recorder.take(before)?;
    }
    let mut origin = Origin::new(&source, &scene, &settings, frames);

    let progress = Progress::new(frames, arguments.quiet);
    let checkpoints = arguments.checkpoint.map(Checkpoints::new);
    let mut job = Job { frames, reader, recorder, tally: Tally::default(), progress, interrupt, checkpoints };
    job.tally.all_events = job.recorder.is_some().then(Vec::new);
    let snapshot =
        |tally: &Tally, simulation: &Simulation| snapshot::bytes(&source, &parameters, frames, tally, simulation);
    let keep = |tally: &Tally, simulation: &Simulation| {
        let mut origin = origin.clone();
        origin.reach(tally);
        Ok((serde_json::to_string(&origin).map_err(Failure::input)?, snapshot(tally, simulation)?))
    };
    let (system, state) = (scene.system, scene.state);
    let begun = match former {
        Some((simulation, tally)) => {
            job.tally = tally;
            Ok(simulation)
        }
        None => Simulation::new(system.clone(), state.clone(), settings).map(|mut simulation| {
            simulation.record_tension(!arguments.no_tension);
            simulation
        }),
    };
    let (stopped, last) = match begun {
        Ok(mut simulation) => {
            let stopped = job.simulate(&mut simulation, &keep)?;
            // After an error or a frame that was not written, the state is not that of the last frame.
            let is_at_a_frame = matches!(stopped, None | Some(Stop::Interrupt));
            let is_kept = is_at_a_frame && job.recorder.is_some();
            (stopped, if is_kept { Some(snapshot(&job.tally, &simulation)?) } else { None })
        }
        // Where no positions satisfy the constraints, the start is the only frame.
        Err(error) => {
            let frame = job.reader.read_start(&system, &state);
            job.start(&system, &frame)?;
            (Some(Stop::Error(error)), None)
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
        let events = job.tally.all_events.as_deref().unwrap_or_default();
        match recorder.finish(&whole, &part, Extras { snapshot: last.as_deref(), events })? {
            Kept::Whole => {}
            Kept::Part => (origin, is_unwritten) = (shortened, true),
            Kept::Earlier => {
                (origin, is_unwritten) = (origin.kept_earlier(output.as_deref().unwrap_or_default()), true);
            }
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

/// The input of a run: scene, settings and frames, and a former run if it goes on.
struct Plan {
    source: Source,
    scene: Scene,
    parameters: Vec<(String, f64)>,
    settings: Settings,
    frames: Frames,
    former: Option<(Simulation, Tally)>,
}

impl Plan {
    fn of(arguments: &arguments::Run, before: Option<&mut Stored<'_>>) -> Result<Self, Failure> {
        let source = arguments.scene.as_deref().map(Source::read).transpose()?;
        if let Some(before) = before {
            let former = Former::read(before, source.as_ref(), arguments.duration)?;
            let Former { source, scene, parameters, frames, tally, simulation } = former;
            let settings = *simulation.settings();
            return Ok(Plan { source, scene, parameters, settings, frames, former: Some((simulation, tally)) });
        }
        // The options ask for a scene where there is no trajectory.
        let Some(source) = source else { return Err(Failure::input("no scene is named")) };
        let parameters = arguments.parameters.set.clone();
        let scene = source.load(&parameters).map_err(Failure::formatted)?;
        let settings = settings(arguments, scene.settings)?;
        // An integrator from the command line may find no events, which the reader of the scene could not know.
        qhat::check_start(&scene.system, &scene.state, &settings).map_err(Failure::input)?;
        let frames = Frames::new(arguments.duration.unwrap_or(scene.duration), arguments.frames, &settings)?;
        Ok(Plan { source, scene, parameters, settings, frames, former: None })
    }

    /// The output, which is the former trajectory where the run goes on and no other output is named.
    fn target(arguments: &arguments::Run) -> Result<Option<Target>, Failure> {
        let path = arguments.output.as_deref().or(arguments.from.as_deref());
        let [from, to] = [arguments.from.as_deref(), path].map(|path| path.and_then(|path| path.canonicalize().ok()));
        let is_same = from.is_some() && from == to;
        let target = path.map(|path| Target::new(path, arguments.force || is_same)).transpose()?;
        let holds_snapshots = target.as_ref().is_some_and(|target| target.format() == Format::Npz);
        if (arguments.from.is_some() || arguments.checkpoint.is_some()) && !holds_snapshots {
            return Err(Failure::input(
                "a run can go on from a file in .npz alone: write one with -o run.npz for --checkpoint and --from",
            ));
        }
        Ok(target)
    }
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
    reader: Reader,
    recorder: Option<Recorder>,
    tally: Tally,
    progress: Progress,
    interrupt: Interrupt,
    checkpoints: Option<Checkpoints>,
}

/// The origin and the snapshot of a run at the end of a frame.
type Keep<'a> = &'a dyn Fn(&Tally, &Simulation) -> Result<(String, Vec<u8>), Failure>;

impl Job {
    /// Steps from frame to frame. Returns the reason where the run ends early.
    fn simulate(&mut self, simulation: &mut Simulation, keep: Keep<'_>) -> Result<Option<Stop>, Failure> {
        if self.tally.frames == 0 {
            self.tally.begun(simulation);
            let frame = self.reader.read(simulation, 0.0);
            self.start(simulation.system(), &frame)?;
        }
        for index in self.tally.frames..=self.frames.count {
            if self.interrupt.came() {
                return Ok(Some(Stop::Interrupt));
            }
            let clock = ProcessTime::now();
            let outcome = simulation.advance(self.frames.length);
            self.tally.cpu += clock.elapsed();
            self.tally.reached(simulation);
            match outcome {
                Ok(report) => self.tally.step(simulation.system(), &report, self.frames.time(index)),
                // The frame is no multiple of h, so the options are at fault. The state is unchanged.
                Err(StepError::Settings(error)) => return Err(self.frames.refused(&error, simulation.settings())),
                Err(error) => return Ok(Some(Stop::Error(error))),
            }
            if self.recorder.is_some() {
                let frame = self.reader.read(simulation, self.frames.time(index));
                if let Err(failure) = self.record(simulation.system(), &frame) {
                    return Ok(Some(Stop::Unwritten(failure)));
                }
            } else {
                self.tally.frames += 1;
            }
            if index < self.frames.count {
                self.checkpoint(simulation, keep)?;
            }
            self.progress.at(index, self.frames.time(index));
        }
        Ok(None)
    }

    fn start(&mut self, system: &System, frame: &Frame) -> Result<(), Failure> {
        self.tally.start(system, &frame.terms);
        self.record(system, frame)
    }

    fn record(&mut self, system: &System, frame: &Frame) -> Result<(), Failure> {
        self.tally.frame(system, frame.time, &frame.terms);
        match &mut self.recorder {
            Some(recorder) => recorder.frame(frame),
            None => Ok(()),
        }
    }

    /// Writes the trajectory so far, where the time for it has come. A disk that is full keeps the file before.
    fn checkpoint(&mut self, simulation: &Simulation, keep: Keep<'_>) -> Result<(), Failure> {
        let (Some(checkpoints), Some(recorder)) = (&mut self.checkpoints, &mut self.recorder) else { return Ok(()) };
        if !checkpoints.are_due() {
            return Ok(());
        }
        let (origin, snapshot) = keep(&self.tally, simulation)?;
        let events = self.tally.all_events.as_deref().unwrap_or_default();
        if let Err(failure) = recorder.checkpoint(&origin, Extras { snapshot: Some(&snapshot), events }) {
            checkpoints.failed(&failure);
        }
        checkpoints.begin();
        Ok(())
    }
}
