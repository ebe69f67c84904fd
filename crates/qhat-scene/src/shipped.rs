//! The scenes that come with qhat, embedded.

use crate::groups::group_of;
use crate::report::Report;
use crate::tree::toml;
use std::sync::LazyLock;

/// A scene that comes with qhat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shipped {
    /// Its name in commands and addresses: the file's name without `.toml`.
    pub name: &'static str,
    /// The title people see.
    pub title: &'static str,
    /// The heading under which a list shows it.
    pub group: &'static str,
    /// The text of its file, TOML.
    pub text: &'static str,
}

impl Shipped {
    fn new(name: &'static str, text: &'static str) -> Self {
        let tree = toml::parse(text, &mut Report::new(name, text));
        let written = tree.and_then(|tree| text.get(tree.get("name")?.span.clone()));
        Shipped { name, title: written.map_or(name, |title| title.trim_matches('"')), group: group_of(name), text }
    }

    /// Reads the scene.
    ///
    /// # Errors
    /// None that the tests of this crate have left.
    pub fn load(&self) -> Result<crate::Scene, crate::SceneErrors> {
        crate::load(self.text, &format!("{}.toml", self.name), crate::Format::Toml)
    }
}

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        vec![$(Shipped::new($name, include_str!(concat!("../../../scenes/", $name, ".toml"))),)*]
    };
}

/// The scenes that come with qhat, in the order in which a reader meets them. A test holds the list to the folder `scenes`.
pub fn shipped() -> &'static [Shipped] {
    static SHIPPED: LazyLock<Vec<Shipped>> = LazyLock::new(|| {
        scenes![
            "pendulum",
            "compound-pendulum",
            "cycloid-pendulum",
            "brachistochrone",
            "elastic-pendulum",
            "kapitza",
            "helix",
            "bent-wire",
            "double-pendulum",
            "conical-pendulum",
            "rotating-hoop",
            "tautochrone",
            "coupled-pendulums",
            "hanging-chain",
            "catenary",
            "heavy-end",
            "net",
            "bracket",
            "bridge-truss",
            "girder",
            "four-bar",
            "crank-slider",
            "trammel",
            "jansen-leg",
            "strandbeest",
            "watt",
            "peaucellier",
            "trebuchet",
            "atwood",
            "block-and-tackle",
            "crank-rocker",
            "robot-arm",
            "pantograph",
            "gears",
            "rack-and-pinion",
            "jelly",
            "bouncing-balls",
            "slope",
            "loop-the-loop",
            "dome",
            "slack-ropes",
            "round-billiards",
            "overload",
            "dropped-bridge",
            "leaf-spring",
            "inflated-loop",
            "air-spring",
            "drop",
            "streamer",
            "terminal-velocity",
            "electroscope",
            "comets",
            "figure-eight",
            "cube",
            "middle-axis",
            "tensegrity",
            "web",
            "classic",
            "chain-100",
            "chain-1000",
            "chain-10000",
        ]
    });
    &SHIPPED
}

#[cfg(test)]
mod tests {
    use super::shipped;
    use crate::groups::GROUPS;

    /// In one group each, and the groups name no other.
    #[test]
    fn every_scene_has_one_heading() {
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, scenes)| scenes.iter().copied()).collect();
        let mut listed: Vec<&str> = shipped().iter().map(|scene| scene.name).collect();
        grouped.sort_unstable();
        listed.sort_unstable();
        assert_eq!(grouped, listed);
    }
}
