//! Stills, read back by a parser of XML: their elements and colours, and that no text breaks the document.

use super::*;
use qhat::{Constraint, Dimension, Distance, Limits, Particle, ParticleId};
use roxmltree::{Document, Node};

/// A weight of 20 N hangs from `a` and a weight of 10 N stands on `b`; `c` and `d` carry nothing.
fn hanging_and_standing() -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| builder.particle(Particle::at(name, place(name)).fixed()));
    let low = builder.particle(Particle::at("low", [0.0, -1.0]).with_mass(2.0));
    let high = builder.particle(Particle::at("high", [1.0, 1.0]).with_mass(1.0));
    builder.constraint("hanger", Distance::new(a, low, 1.0));
    builder.constraint("post", Distance::new(b, high, 1.0));
    builder.constraint("idle", Distance::new(c, d, 1.0));
    builder.force(Gravity { acceleration: [0.0, -10.0, 0.0] });
    builder.build().unwrap()
}

fn place(name: &str) -> [f64; 2] {
    let x = f64::from(name.as_bytes()[0] - b'a');
    [x, 0.0]
}

fn picture<'a>(system: &'a System, state: &'a State, tension: &'a [f64], broken: &'a [usize]) -> Picture<'a> {
    Picture { system, state, time: 0.0, tension, broken, name: "Still", note: "" }
}

fn lines<'a, 'input>(document: &'a Document<'input>) -> Vec<Node<'a, 'input>> {
    document.descendants().filter(|node| node.has_tag_name("line")).collect()
}

fn class<'a>(node: &Node<'a, '_>) -> &'a str {
    node.attribute("class").unwrap_or_default()
}

fn title<'a>(node: &Node<'a, '_>) -> &'a str {
    node.children().find(|child| child.has_tag_name("title")).and_then(|title| title.text()).unwrap_or_default()
}

fn texts(document: &Document<'_>) -> Vec<String> {
    let nodes = document.descendants().filter(|node| node.has_tag_name("text"));
    nodes.map(|node| node.text().unwrap_or_default().to_owned()).collect()
}

#[test]
fn links_have_the_colour_of_their_tension_and_a_legend_says_which() {
    let (system, state) = hanging_and_standing();
    let tension = qhat::evaluate(&system, &state).tension;
    let text = svg(&picture(&system, &state, &tension, &[]), &Options::default());
    let document = Document::parse(&text).unwrap();
    let drawn: Vec<_> = lines(&document).iter().map(|line| (title(line), line.attribute("stroke").unwrap())).collect();
    // Half of the limit gives √½ of the way from grey to the colour of the limit, in 41 steps.
    let half = super::palette::LIGHT.tension(-10.0, 20.0);
    assert_eq!(
        drawn,
        [("rod hanger: 20 N pull", "#165ccc"), ("rod post: 10 N push", half.as_str()), ("rod idle: 0 N", "#a8acb2")]
    );
    let texts = texts(&document);
    for words in ["Still", "t = 0 s", "push", "pull", "−20 N", "0", "+20 N", "0.5 m"] {
        assert!(texts.iter().any(|text| text == words), "{words}: {texts:?}");
    }
    let ramp = document.descendants().find(|node| class(node) == "legend").unwrap();
    let colours: Vec<_> = ramp.children().filter_map(|node| node.attribute("fill")).collect();
    assert_eq!((colours[0], colours[20], colours[40]), ("#c9580a", "#a8acb2", "#165ccc"));
}

#[test]
fn free_particles_are_balls_by_their_mass_and_fixed_ones_squares() {
    let (system, state) = hanging_and_standing();
    let text = svg(&picture(&system, &state, &[0.0; 3], &[]), &Options::default());
    let document = Document::parse(&text).unwrap();
    let group = document.descendants().find(|node| class(node) == "particles").unwrap();
    let names = |tag: &str| -> Vec<_> {
        group.children().filter(|node| node.has_tag_name(tag)).map(|node| title(&node)).collect()
    };
    assert_eq!(names("rect"), ["a", "b", "c", "d"]);
    assert_eq!(names("circle"), ["low", "high"]);
    let radii: Vec<f64> =
        group.children().filter_map(|node| node.attribute("r")).map(|radius| radius.parse().unwrap()).collect();
    // The ratio of the radii is ∛2 for masses of 2:1, rounded to hundredths of a pixel.
    assert!((radii[0] / radii[1] - 2.0f64.cbrt()).abs() < 0.003, "{radii:?}");
}

#[test]
fn slack_ropes_hang_taut_ropes_are_straight_and_broken_links_leave_stubs() {
    let mut builder = System::builder(Dimension::Two);
    let ends = [0.0, 1.0, 2.0].map(|x| builder.particle(Particle::at(format!("{x}"), [x, 0.0]).fixed()));
    let rope = |a: ParticleId, b, length| Constraint::from(Limits::rope(a, b, length));
    builder.with_constraint("slack", rope(ends[0], ends[1], 2.0)).constraint("taut", rope(ends[1], ends[2], 1.0));
    builder.constraint("broken", Distance::new(ends[0], ends[2], 1.0));
    builder.force(Gravity { acceleration: [0.0, -10.0, 0.0] });
    let (system, state) = builder.build().unwrap();
    let text = svg(&picture(&system, &state, &[0.0, 5.0, 0.0], &[2]), &Options::default());
    let document = Document::parse(&text).unwrap();
    assert_eq!(lines(&document).iter().map(title).collect::<Vec<_>>(), ["rope taut: 5 N pull"]);
    let path = |name: &str| document.descendants().find(|node| class(node) == name).unwrap();
    let slack = path("rope");
    assert!(slack.attribute("d").unwrap().contains('Q') && slack.attribute("stroke-dasharray").is_some());
    // The control point lies below the ends: y of a picture points down.
    let numbers: Vec<f64> =
        slack.attribute("d").unwrap().split(['M', 'Q', ' ']).filter_map(|number| number.parse().ok()).collect();
    assert!(numbers[3] > numbers[1] + 10.0, "{numbers:?}");
    assert_eq!(path("broken").attribute("d").unwrap().matches('M').count(), 2);
}

#[test]
fn names_from_anywhere_stay_text() {
    let mut builder = System::builder(Dimension::Two);
    builder.particle(Particle::at("</title><script>\u{1}\u{202E}", [0.0, 0.0]));
    let (system, state) = builder.build().unwrap();
    let name = "a < b & \"c\" \u{0}\u{FFFF} λ̇";
    let text = svg(&Picture { name, ..picture(&system, &state, &[], &[]) }, &Options::default());
    let document = Document::parse(&text).unwrap();
    assert!(!document.descendants().any(|node| node.has_tag_name("script")));
    let fitted = "a < b & \"c\" \u{FFFD}\u{FFFD} λ̇";
    assert_eq!(title(&document.root_element()), fitted);
    assert_eq!(texts(&document)[0], fitted);
    assert!(text.contains("&lt;/title&gt;&lt;script&gt;\u{FFFD}\u{FFFD}"), "{text}");
    assert!(!document.descendants().any(|node| class(&node) == "legend"), "no link, no scale of tension");
}

/// Every scene, in both themes and from the smallest size up, gives a document that shows all particles.
#[test]
fn every_shipped_scene_is_drawn_within_its_picture() {
    for shipped in qhat_scene::shipped() {
        let scene = shipped.load().unwrap();
        let tension = vec![1.0; scene.system.links().count()];
        for (size, dark) in [([1200, 800], false), ([Options::LEAST; 2], true)] {
            let still = picture(&scene.system, &scene.state, &tension, &[]);
            let text = svg(&still, &Options { size, dark });
            let document = Document::parse(&text).unwrap();
            let view = document.root_element().attribute("viewBox").unwrap();
            let [_, _, width, height] = view.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()[..] else {
                panic!("{view}")
            };
            for ball in document.descendants().filter(|node| node.has_tag_name("circle")) {
                let [x, y] = ["cx", "cy"].map(|name| ball.attribute(name).unwrap().parse::<f64>().unwrap());
                assert!((0.0..=width).contains(&x) && (0.0..=height).contains(&y), "{}: {x} {y}", shipped.name);
            }
            // Ropes and struts are lines, too, because each has a tension of 1 N.
            assert_eq!(lines(&document).len(), tension.len(), "{}", shipped.name);
        }
    }
}

/// Positions that a diverging run may reach.
#[test]
fn huge_and_coinciding_places_make_no_endless_picture() {
    for far in [0.0, 1e-300, 1e154, 1e300, f64::MAX] {
        let mut builder = System::builder(Dimension::Two);
        let ends = [-far, far].map(|x| builder.particle(Particle::at(format!("{x}"), [x, -x]).fixed()));
        builder.force(qhat::Spring { a: ends[0], b: ends[1], stiffness: 1.0, damping: 0.0, rest: 1.0 });
        let (system, state) = builder.build().unwrap();
        let text = svg(&picture(&system, &state, &[], &[]), &Options::default());
        assert!(text.len() < 20_000 && !text.contains("NaN") && !text.contains("inf"), "{far}: {text}");
        Document::parse(&text).unwrap();
    }
}
