//! `qhat render`: from a scene, a time of its run or a frame of a trajectory to a picture.

mod still;

use crate::arguments;
use crate::failure::{Failure, warn};
use crate::output::{Output, ending};
use crate::source::Source;
use crate::trajectory::Stored;
use qhat_shapes::{Options, png, svg};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use still::Still;

/// The format of a picture, by the ending of its file name.
#[derive(Clone, Copy, Debug)]
enum Format {
    Svg,
    Png,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Failure> {
        match ending(path).as_deref() {
            Some("svg") => Ok(Format::Svg),
            Some("png") => Ok(Format::Png),
            _ => Err(Failure::input(format!(
                "cannot tell from its ending how to draw `{}`; end the name in .svg or .png",
                path.display()
            ))),
        }
    }
}

/// Draws a picture as the arguments say. If a run ends early, its last state is drawn, with the reason beside the time.
pub(crate) fn render(arguments: &arguments::Render) -> Result<ExitCode, Failure> {
    let format = Format::of(&arguments.output)?;
    let output = Output::new(&arguments.output, &[], arguments.force)?;
    let source = Source::read(&arguments.scene)?;
    // A trajectory is drawn with the parameters that it was computed with.
    let mut stored = arguments.from.as_deref().map(Stored::open).transpose()?;
    let parameters = match &mut stored {
        Some(stored) => stored.parameters(&source.hash()),
        None => arguments.parameters.set.clone(),
    };
    let scene = source.load(&parameters).map_err(Failure::formatted)?;
    let still = match stored {
        Some(stored) => Still::stored(&scene, &source, stored, arguments.frame)?,
        None => Still::simulated(&scene, arguments.at.unwrap_or(0.0), arguments.quiet)?,
    };
    let options = Options { size: arguments.size, dark: arguments.dark };
    let picture = still.picture(&scene.name);
    let bytes = match format {
        Format::Svg => svg(&picture, &options).into_bytes(),
        Format::Png => png(&picture, &options).map_err(Failure::input)?,
    };
    let mut file = output.temporary()?;
    file.write_all(&bytes).map_err(|error| output.cannot_write(&error))?;
    output.put(file)?;
    if let Some(message) = &still.message {
        warn(format!("{}: {message}", still.status));
    }
    Ok(still.status.exit_code())
}
