//! The scenes that come with qhat, embedded, under the headings of lists.

use crate::report::Report;
use crate::tree::toml;
use std::sync::LazyLock;

/// A scene that comes with qhat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shipped {
    /// The name of the scene in commands and addresses: the name of its file without `.toml`.
    pub name: &'static str,
    /// The title of the scene.
    pub title: &'static str,
    /// The heading under which a list shows the scene.
    pub group: &'static str,
    /// The text of the file, TOML.
    pub text: &'static str,
}

impl Shipped {
    fn new(group: &'static str, name: &'static str, text: &'static str) -> Self {
        let tree = toml::parse(text, &mut Report::new(name, text));
        let written = tree.and_then(|tree| text.get(tree.get("name")?.span.clone()));
        Shipped { name, title: written.map_or(name, |title| title.trim_matches('"')), group, text }
    }

    /// Reads the scene.
    ///
    /// # Errors
    /// None: a test reads every shipped scene.
    pub fn load(&self) -> Result<crate::Scene, crate::SceneErrors> {
        crate::load(self.text, &format!("{}.toml", self.name), crate::Format::Toml)
    }
}

macro_rules! scenes {
    ($($group:literal: $($name:literal),*;)*) => {
        vec![$($(Shipped::new($group, $name, include_str!(concat!("../../../scenes/", $name, ".toml"))),)*)*]
    };
}

/// The scenes that come with qhat, heading by heading, in the order in which lists show them.
pub fn shipped() -> &'static [Shipped] {
    static SHIPPED: LazyLock<Vec<Shipped>> = LazyLock::new(|| {
        scenes! {
            "First steps":
                "pendulum", "double-pendulum", "coupled-pendulums", "hanging-chain", "heavy-end", "net", "web",
                "classic";
            "Linkages":
                "four-bar", "jansen-leg", "strandbeest", "watt", "peaucellier", "pantograph", "trammel", "trebuchet";
            "Drives and motors":
                "crank-slider", "crank-rocker", "robot-arm", "kapitza";
            "Pulleys and gears":
                "atwood", "block-and-tackle", "gears", "rack-and-pinion";
            "Structures":
                "bracket", "bridge-truss", "girder", "tensegrity", "catenary";
            "Curves and surfaces":
                "cycloid-pendulum", "brachistochrone", "tautochrone", "helix", "bent-wire", "rotating-hoop",
                "conical-pendulum";
            "Contacts and ropes":
                "bouncing-balls", "slope", "slack-ropes", "loop-the-loop", "dome", "round-billiards", "overload",
                "dropped-bridge";
            "Bodies":
                "compound-pendulum", "cube", "middle-axis";
            "Soft things":
                "jelly", "leaf-spring", "inflated-loop", "air-spring", "drop", "streamer";
            "Forces and fields":
                "elastic-pendulum", "terminal-velocity", "electroscope", "comets", "figure-eight";
            "Large":
                "chain-100", "chain-1000", "chain-10000";
        }
    });
    &SHIPPED
}
