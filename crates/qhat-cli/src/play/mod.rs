//! `qhat play`: serves the page, which is embedded in the command, to this machine only.

#[cfg(feature = "page")]
mod answer;
#[cfg(feature = "page")]
mod page;
#[cfg(feature = "page")]
mod server;

use crate::arguments;
use crate::failure::Failure;
use std::process::ExitCode;

/// Serves the page until Ctrl-C.
#[cfg(feature = "page")]
pub(crate) fn play(arguments: &arguments::Play) -> Result<ExitCode, Failure> {
    use crate::{print, source::Source};

    let scene = arguments.scene.as_deref().map(Source::read).transpose()?;
    if scene.is_none() && !arguments.parameters.set.is_empty() {
        return Err(Failure::input("--set needs a scene: qhat play SCENE --set NAME=VALUE"));
    }
    if let Some(scene) = &scene {
        // The page shows the errors, too, but the user who typed the command looks at the terminal.
        scene.load(&arguments.parameters.set).map_err(Failure::formatted)?;
    }
    let listener = server::listen(arguments.port)?;
    let address = listener.local_addr().map_err(|error| Failure::io("cannot listen", &error))?;
    let set: Vec<String> =
        arguments.parameters.set.iter().map(|(name, value)| format!("set={name}={value:?}")).collect();
    let query = if set.is_empty() { String::new() } else { format!("?{}", set.join("&")) };
    let address = format!("http://{address}/{query}");
    let what = scene.as_ref().map_or(String::new(), |scene| format!(" with {}", scene.name));
    print::text(&format!("qhat{what} is at {address} (end with Ctrl-C)"))?;
    if !arguments.no_open {
        server::open(&address);
    }
    server::serve(&listener, scene)
}

/// Refuses, and says how to build a command with the page.
#[cfg(not(feature = "page"))]
pub(crate) fn play(_: &arguments::Play) -> Result<ExitCode, Failure> {
    Err(Failure::input(
        "this qhat was built without its page; in a clone of its repository `make play` builds one that has it,\n\
         and leaves it at target/release/qhat",
    ))
}
