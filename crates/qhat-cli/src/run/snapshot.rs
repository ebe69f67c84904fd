//! Snapshot: the data from which a run goes on, kept inside its trajectory: the text of the scene, the plan of frames,
//! the simulation and the counts of the summary. A run that goes on from it has the bytes of a run that did not stop.

use super::frames::Frames;
use super::summary::Tally;
use crate::failure::Failure;
use crate::source::{Source, Text};
use crate::trajectory::Stored;
use qhat::Simulation;
use qhat_scene::Scene;
use serde::{Deserialize, Serialize};

/// The first bytes of a snapshot, with the version of its format. Any change of the types that are saved makes a new
/// one.
const HEAD: &[u8; 8] = b"qhatrun\x02";

/// A run at the end of a frame.
#[derive(Serialize, Deserialize)]
struct Content {
    scene: Text,
    parameters: Vec<(String, f64)>,
    frames: Frames,
    tally: Tally,
    simulation: Vec<u8>,
}

/// The bytes of a snapshot.
pub(super) fn bytes(
    source: &Source,
    parameters: &[(String, f64)],
    frames: Frames,
    tally: &Tally,
    simulation: &Simulation,
) -> Result<Vec<u8>, Failure> {
    let content = Content {
        scene: source.text(),
        parameters: parameters.to_vec(),
        frames,
        tally: tally.clone(),
        simulation: simulation.to_bytes(),
    };
    let content = postcard::to_allocvec(&content).map_err(Failure::input)?;
    Ok([HEAD.as_slice(), &content].concat())
}

/// A run that goes on.
pub(super) struct Former {
    pub(super) source: Source,
    pub(super) scene: Scene,
    pub(super) parameters: Vec<(String, f64)>,
    pub(super) frames: Frames,
    pub(super) tally: Tally,
    pub(super) simulation: Simulation,
}

impl Former {
    /// Reads the snapshot of a trajectory. `given` is the scene that the command names, if it names one; `duration` the
    /// duration that it asks for.
    ///
    /// # Errors
    /// A file that has no snapshot, one of another version or another scene, a duration that has already been reached
    /// or that is no multiple of the frame.
    pub(super) fn read(
        stored: &mut Stored<'_>,
        given: Option<&Source>,
        duration: Option<f64>,
    ) -> Result<Self, Failure> {
        let name = stored.path().display();
        let refused = |reason: String| Failure::input(format!("cannot go on from `{name}`: {reason}"));
        let Some(bytes) = stored.snapshot()? else {
            let origin = stored.origin();
            let error = origin.as_ref().and_then(|origin| origin.get("error")?.as_str());
            let status = origin.as_ref().and_then(|origin| origin.get("status")?.as_str());
            let reason = match error {
                Some(error) if status == Some("interrupted") => format!("it has no snapshot: {error}"),
                Some(error) => format!("its run ended with an error, from which nothing can go on: {error}"),
                None => "it holds no snapshot of its run, which `qhat run -o run.npz` writes".to_owned(),
            };
            return Err(refused(reason));
        };
        let content = match bytes.strip_prefix(HEAD.as_slice()) {
            Some(content) => content,
            None if bytes.starts_with(&HEAD[..7]) => {
                let (found, known) = (bytes.get(7).copied().unwrap_or(0), HEAD[7]);
                let reason = format!("its snapshot has version {found}, and this qhat reads version {known}");
                return Err(refused(reason));
            }
            None => return Err(refused("its snapshot is damaged".to_owned())),
        };
        let content: Content =
            postcard::from_bytes(content).map_err(|_| refused("its snapshot is damaged".to_owned()))?;
        let source = Source::restored(content.scene);
        if let Some(given) = given.filter(|given| given.hash() != source.hash()) {
            let reason = format!(
                "it was computed from another text than that of `{}`; leave the scene out, and the text in the \
                 trajectory is used",
                given.name
            );
            return Err(refused(reason));
        }
        let scene = source.load(&content.parameters).map_err(Failure::formatted)?;
        let simulation = Simulation::restore(scene.system.clone(), &content.simulation);
        let simulation = simulation.map_err(|error| refused(error.to_string()))?;
        let frames = match duration {
            Some(duration) => content.frames.over(duration).map_err(refused)?,
            None => content.frames,
        };
        let (kept, reached) = (stored.frames()?, content.tally.frames as u64);
        if kept != reached {
            return Err(refused(format!("it has {kept} frames, and its snapshot was taken after {reached}")));
        }
        if reached > frames.count as u64 {
            let time = qhat::Seconds(content.frames.time(content.tally.frames - 1));
            return Err(refused(format!("it has reached t = {time} s; ask for more with --duration")));
        }
        let Content { parameters, tally, .. } = content;
        Ok(Former { source, scene, parameters, frames, tally, simulation })
    }
}
