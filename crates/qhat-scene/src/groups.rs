//! Under which heading a list shows each shipped scene.

/// The headings in their order, each with its scenes. A test holds it to the list of shipped scenes.
pub(crate) const GROUPS: [(&str, &[&str]); 11] = [
    (
        "First steps",
        &["pendulum", "double-pendulum", "coupled-pendulums", "hanging-chain", "heavy-end", "net", "web", "classic"],
    ),
    (
        "Linkages",
        &["four-bar", "jansen-leg", "strandbeest", "watt", "peaucellier", "pantograph", "trammel", "trebuchet"],
    ),
    ("Drives and motors", &["crank-slider", "crank-rocker", "robot-arm", "kapitza"]),
    ("Pulleys and gears", &["atwood", "block-and-tackle", "gears", "rack-and-pinion"]),
    ("Structures", &["bracket", "bridge-truss", "girder", "tensegrity", "catenary"]),
    (
        "Curves and surfaces",
        &[
            "cycloid-pendulum",
            "brachistochrone",
            "tautochrone",
            "helix",
            "bent-wire",
            "rotating-hoop",
            "conical-pendulum",
        ],
    ),
    (
        "Contacts and ropes",
        &[
            "bouncing-balls",
            "slope",
            "slack-ropes",
            "loop-the-loop",
            "dome",
            "round-billiards",
            "overload",
            "dropped-bridge",
        ],
    ),
    ("Bodies", &["compound-pendulum", "cube", "middle-axis"]),
    ("Soft things", &["jelly", "leaf-spring", "inflated-loop", "air-spring", "drop", "streamer"]),
    ("Forces and fields", &["elastic-pendulum", "terminal-velocity", "electroscope", "comets", "figure-eight"]),
    ("Large", &["chain-100", "chain-1000", "chain-10000"]),
];

/// The heading of a scene; empty where it has none.
pub(crate) fn group_of(name: &str) -> &'static str {
    GROUPS.iter().find(|(_, scenes)| scenes.contains(&name)).map_or("", |(group, _)| group)
}
