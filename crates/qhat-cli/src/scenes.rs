//! `qhat scenes`: the scenes that come with qhat.

use crate::arguments;
use crate::failure::Failure;
use crate::print;
use crate::source::{available, find_shipped};
use qhat_scene::{Shipped, shipped};
use serde_json::json;
use std::process::ExitCode;

const HEADING: &str =
    "Scenes that come with qhat; try `qhat play NAME`, or `qhat scenes NAME > my.toml` to start from one";

/// Lists the scenes, or prints one.
pub(crate) fn scenes(arguments: &arguments::Scenes) -> Result<ExitCode, Failure> {
    match &arguments.name {
        Some(name) => print::text(text_of(name)?)?,
        None if arguments.json => print::json(&shipped().iter().map(as_json).collect::<Vec<_>>())?,
        None => {
            let line = |scene: &'static Shipped| (scene.name, format!("{}\n{}", scene.title, description(scene)));
            print::table(HEADING, &shipped().iter().map(line).collect::<Vec<_>>())?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn text_of(name: &str) -> Result<&'static str, Failure> {
    let unknown = || Failure::input(format!("no scene `{name}` comes with qhat\n{}", available()));
    find_shipped(name).map(|scene| scene.text).ok_or_else(unknown)
}

fn as_json(scene: &Shipped) -> serde_json::Value {
    json!({ "name": scene.name, "title": scene.title, "description": description(scene) })
}

fn description(scene: &Shipped) -> String {
    scene.load().map(|scene| scene.description).unwrap_or_default()
}
