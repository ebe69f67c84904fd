//! The content of a picture: a state with its tensions, and the end of the run that led to it.

use crate::failure::{Failure, warn};
use crate::run::frames::{Frames, MOST};
use crate::run::interrupt::Interrupt;
use crate::run::progress::Progress;
use crate::source::Source;
use crate::status::Status;
use crate::trajectory::Stored;
use qhat::{Constraint, ParticleId, Seconds, Settings, Simulation, State, StepError, System, evaluate};
use qhat_scene::Scene;
use qhat_shapes::{Picture, Reading};

/// A time within this part of a frame of the frame's end counts as that end. Both are quotients of decimals that a user
/// typed, and differ by roundings of 1e-16 of a time.
const SAME: f64 = 1e-9;

/// A link that carries nothing counts as broken if its length is out of its limits by this part of the length. Links
/// that hold keep their length to 1e-10.
const PARTED: f64 = 1e-6;

/// A state to draw.
pub(super) struct Still {
    system: System,
    state: State,
    time: f64,
    reading: Reading,
    pub(super) status: Status,
    /// The reason of an early end.
    pub(super) message: Option<String>,
}

impl Still {
    /// The state at a time \[s\]: whole frames of the scene, as `qhat run` takes them, and the rest of the last one.
    pub(super) fn simulated(scene: &Scene, at: f64, quiet: bool) -> Result<Self, Failure> {
        if !(at.is_finite() && at >= 0.0) {
            return Err(Failure::input(format!("the time of a picture must be 0 or later, but is {at} s")));
        }
        let mut simulation = match scene.simulation() {
            Ok(simulation) => simulation,
            Err(StepError::Settings(error)) => return Err(Failure::input(error)),
            // If no positions near the start satisfy the constraints, the start itself is drawn.
            Err(error) => return Ok(Still::start(scene, &error)),
        };
        let ending = match at {
            0.0 => Ending { status: Status::Done, message: None },
            _ => advance(&mut simulation, scene, at, quiet)?,
        };
        let reading = Reading::of(&mut simulation);
        let (system, state) = (simulation.system().clone(), simulation.state().clone());
        Ok(Still { time: state.time(), system, state, reading, status: ending.status, message: ending.message })
    }

    fn start(scene: &Scene, error: &StepError) -> Self {
        let (system, state) = (scene.system.clone(), scene.state.clone());
        let reading = Reading { tension: evaluate(&system, &state).tension, broken: Vec::new() };
        Still { system, state, time: 0.0, reading, status: Status::of(error), message: Some(error.to_string()) }
    }

    /// A frame of a trajectory of the scene.
    pub(super) fn stored(
        scene: &Scene,
        source: &Source,
        mut stored: Stored<'_>,
        frame: Option<u64>,
    ) -> Result<Self, Failure> {
        let (system, path) = (&scene.system, stored.path());
        let frames = stored.frames()?;
        let frame = match frame {
            Some(frame) if frame < frames => frame,
            None if frames > 0 => frames - 1,
            _ => return Err(Failure::input(format!("`{}` has {frames} frames, counted from 0", path.display()))),
        };
        let time = stored.numbers("t", frame, 1)?[0];
        let positions = stored.numbers("positions", frame, system.coordinate_count())?;
        let tension = stored.numbers("tension", frame, system.links().count())?;
        let state = scene.state.with_motion(positions, scene.state.velocities().to_vec());
        let hash = stored.origin().and_then(|origin| Some(origin.get("scene_hash")?.as_str()?.to_owned()));
        if hash.is_some_and(|hash| hash != source.hash()) {
            warn(format!("`{}` comes from another text of the scene `{}`", path.display(), source.name));
        }
        let broken = broken(system, &state, &tension);
        let reading = Reading { tension, broken };
        Ok(Still { system: system.clone(), state, time, reading, status: Status::Done, message: None })
    }

    pub(super) fn picture<'a>(&'a self, name: &'a str) -> Picture<'a> {
        let note = match self.status {
            Status::Done => "",
            Status::Diverged => "diverged",
            Status::Infeasible => "infeasible start",
            Status::Interrupted => "interrupted",
        };
        Picture {
            system: &self.system,
            state: &self.state,
            time: self.time,
            tension: &self.reading.tension,
            broken: &self.reading.broken,
            name,
            note,
        }
    }
}

struct Ending {
    status: Status,
    message: Option<String>,
}

/// Steps to a time \[s\], or as far as the motion goes.
fn advance(simulation: &mut Simulation, scene: &Scene, at: f64, quiet: bool) -> Result<Ending, Failure> {
    let length = Frames::new(scene.duration, None, &scene.settings)?.length;
    let count = (at / length).ceil();
    if count > MOST {
        return Err(Failure::input(format!("{at} s is {count:e} frames away, more than the {MOST:e} that qhat takes")));
    }
    let whole = (at / length + SAME).floor();
    let rest = at - whole * length;
    let rest = (rest > SAME * length).then_some(rest);
    let interrupt = Interrupt::watch()?;
    let progress = Progress::new(Frames { duration: at, count: count as usize, length: at / count }, quiet);
    let lengths = std::iter::repeat_n(length, whole as usize).chain(rest);
    for (index, frame) in lengths.enumerate() {
        if interrupt.came() {
            progress.finish();
            let message = format!("stopped by Ctrl-C at t = {} s", Seconds(simulation.state().time()));
            return Ok(Ending { status: Status::Interrupted, message: Some(message) });
        }
        match simulation.advance(frame) {
            Ok(_) => progress.at(index + 1, simulation.state().time()),
            Err(StepError::Settings(error)) => {
                progress.finish();
                let Settings { integrator, h, .. } = scene.settings;
                let remedy = if frame == length {
                    format!("the frames of the scene, of {length} s, end between two of them; choose its `duration`")
                } else {
                    format!("{at} s lies between two of them; choose --at")
                };
                return Err(Failure::input(format!(
                    "{error}\n`{integrator}` takes steps of exactly h, and {remedy} as a multiple of {h} s"
                )));
            }
            Err(error) => {
                progress.finish();
                return Ok(Ending { status: Status::of(&error), message: Some(error.to_string()) });
            }
        }
    }
    progress.finish();
    Ok(Ending { status: Status::Done, message: None })
}

/// The places of broken links. A trajectory has tensions and positions only, so a link counts as broken if it can
/// break, carries nothing and has a length out of its limits.
fn broken(system: &System, state: &State, tension: &[f64]) -> Vec<usize> {
    let (d, q) = (system.dimension(), state.positions());
    let distance = |a: ParticleId, b: ParticleId| {
        let (a, b) = (a.index(), b.index());
        (0..d).map(|k| q[d * a + k] - q[d * b + k]).map(|x| x * x).sum::<f64>().sqrt()
    };
    let has_parted = |(place, link): &(usize, qhat::Link<'_>)| {
        let apart = distance(link.a, link.b);
        let longer = link.longest.is_some_and(|most| apart > most * (1.0 + PARTED));
        let shorter = link.shortest.is_some_and(|least| apart < least * (1.0 - PARTED));
        tension[*place] == 0.0 && (longer || shorter)
    };
    // The links of a system are its rods and limits, in their order.
    let can_break = system.constraints().iter().filter_map(|named| match &named.constraint {
        Constraint::Distance(rod) => Some(rod.breaks_at.or(rod.breaks_at_impulse).is_some()),
        Constraint::Limits(limits) => Some(limits.breaks_at.or(limits.breaks_at_impulse).is_some()),
        _ => None,
    });
    let breakable = system.links().enumerate().zip(can_break).filter(|(_, can_break)| *can_break);
    breakable.map(|(link, _)| link).filter(has_parted).map(|(place, _)| place).collect()
}
