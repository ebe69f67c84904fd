//! The reader answers every text with a scene or with errors, quickly and without a panic.

use proptest::prelude::*;
use qhat_scene::{Format, load, load_bytes, shipped};

const FORMATS: [Format; 2] = [Format::Toml, Format::Json];

/// A shipped scene or the scene with every key, in one of the two formats. Other tests have the longest scenes.
fn text() -> impl Strategy<Value = (String, Format)> {
    let short = shipped().iter().map(|scene| scene.text).filter(|text| text.len() < 3000);
    let texts: Vec<&str> = short.chain([include_str!("every-key.toml")]).collect();
    (prop::sample::select(texts), prop::sample::select(FORMATS.to_vec())).prop_map(|(text, format)| match format {
        Format::Toml => (text.to_owned(), format),
        Format::Json => (toml::from_str::<serde_json::Value>(text).unwrap().to_string(), format),
    })
}

/// A change of bytes: its position, the number of bytes removed, and the bytes inserted.
fn edits() -> impl Strategy<Value = Vec<(prop::sample::Index, usize, Vec<u8>)>> {
    let syntax = prop::sample::select(b"[]{}\",.=:-+eE0123456789\n #'\\ntafiulse_".to_vec());
    let bytes = prop::collection::vec(prop_oneof![8 => syntax, 1 => any::<u8>()], 0..4);
    prop::collection::vec((any::<prop::sample::Index>(), 0_usize..6, bytes), 1..6)
}

/// The number of cases; `make fuzz` multiplies it by QHAT_FUZZ.
fn cases() -> u32 {
    4000 * std::env::var("QHAT_FUZZ").map_or(1, |times| times.parse::<u32>().expect("QHAT_FUZZ is a whole number"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn long_changed_scenes_never_panic((text, format) in text(), edits in edits()) {
        let mut bytes = text.into_bytes();
        for (place, removed, inserted) in edits {
            let start = place.index(bytes.len() + 1);
            let end = (start + removed).min(bytes.len());
            bytes.splice(start..end, inserted);
        }
        match load_bytes(&bytes, "changed", format) {
            Ok(scene) => drop(scene.simulation()),
            Err(errors) => prop_assert!(!errors.errors.is_empty() && !errors.to_string().is_empty()),
        }
    }

    #[test]
    fn long_any_text_never_panics(text in ".{0,200}", format in prop::sample::select(FORMATS.to_vec())) {
        drop(load(&text, "any", format));
    }
}

#[test]
fn deep_nesting_is_refused() {
    for depth in [100, 10_000, 1_000_000] {
        for (open, close) in [("[", "]"), ("{\"a\":", "}"), ("{a=", "}"), ("a.", "")] {
            let text = format!("{}1{}", open.repeat(depth), close.repeat(depth));
            for format in FORMATS {
                assert!(load(&text, "deep", format).is_err());
                assert!(load(&format!("a = {text}"), "deep", format).is_err());
            }
        }
    }
}

#[test]
fn long_texts_are_refused_and_long_lists_are_not_slow() {
    let long = "# nothing\n".repeat(2_000_000);
    let errors = load(&long, "long", Format::Toml).unwrap_err();
    assert!(errors.errors[0].message.contains("bytes"), "{errors}");

    let scene = |mistake: &dyn Fn(usize) -> String| {
        let particles: Vec<String> =
            (0..50_000).map(|i| format!("{{\"id\": \"p{i}\", \"at\": [{i}, 0], {}}}", mistake(i))).collect();
        let list = particles.join(",");
        format!("{{\"schema\": \"qhat/1\", \"name\": \"x\", \"dimension\": 2, \"particles\": [{list}]}}")
    };
    let errors = load(&scene(&|i| format!("\"weight{i}\": 1")), "long", Format::Json).unwrap_err();
    assert!(errors.more && errors.errors.len() == 20);

    let text = scene(&|i| format!("\"mass\": -{i}"));
    let errors = load(&text, "long", Format::Json).unwrap_err();
    assert!(!errors.more && errors.errors.len() < 20, "the same mistake with other numbers is told once: {errors}");

    let same = text.replace("\"mass\": -", "\"mass\": 0, \"comment\": ");
    let errors = load(&same, "long", Format::Json).unwrap_err();
    assert!(errors.errors.len() < 20, "errors that are the same are told once: {errors}");
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_change_nothing() {
    for scene in shipped() {
        let windows = format!("\u{FEFF}{}", scene.text.replace('\n', "\r\n"));
        load(&windows, scene.name, Format::Toml).unwrap_or_else(|errors| panic!("{errors}"));
    }
    let errors = load("\u{FEFF}schema = 3\r\n", "marked.toml", Format::Toml).unwrap_err();
    let wrong = errors.errors.iter().find(|error| error.message.contains("`schema`")).unwrap();
    assert_eq!(wrong.line, 1);
}

#[test]
fn bytes_that_are_not_utf_8_are_told_with_their_place() {
    let errors = load_bytes(b"schema = \"qhat/1\"\nname = \"\xff\"\n", "latin.toml", Format::Toml).unwrap_err();
    assert_eq!((errors.errors[0].line, errors.errors[0].column), (2, 9));
}

#[test]
fn messages_do_not_control_the_terminal() {
    let text = "schema = \"qhat/1\"\nname = \"x\"\ndimension = 2\n\"\\u001b[2J\\u202e\" = \"\u{202E}\"\n";
    let said = load(text, "scene.toml", Format::Toml).unwrap_err().to_string();
    assert!(!said.contains(['\u{1b}', '\u{202E}']), "{said:?}");
}

#[test]
fn the_format_follows_the_name() {
    assert_eq!(Format::from_path("a/b.json"), Format::Json);
    assert_eq!(Format::from_path("B.JSON"), Format::Json);
    assert_eq!(Format::from_path("a.json/b.toml"), Format::Toml);
    assert_eq!(Format::from_path("json"), Format::Toml);
}

/// An expression above a limit gives an error at its position, quickly, and is not evaluated.
#[test]
fn expressions_are_limited() {
    let names: Vec<String> = (0..65).map(|i| format!("p{i}")).collect();
    let particles: Vec<String> = names.iter().map(|name| format!("{{ id = \"{name}\", at = [0, 1] }}")).collect();
    let load = |residual: &str| {
        let head = "schema = \"qhat/1\"\nname = \"x\"\ndimension = 2\n";
        let text = format!(
            "{head}particles = [{}]\n[[constraints]]\nkind = \"expression\"\nresidual = \"{residual}\"\n",
            particles.join(", ")
        );
        load(&text, "scene.toml", Format::Toml)
    };
    let sum = |count: usize| names[..count].iter().map(|name| format!("{name}.x")).collect::<Vec<_>>().join(" + ");
    assert!(load(&sum(64)).is_ok());
    for (residual, said) in [
        (sum(65), "more than 64 different names"),
        (format!("p0.x{}", " ".repeat(5000)), "at most 4096"),
        (format!("p0.x{}", " + 1".repeat(600)), "512"),
        (format!("{}p0.x{}", "(".repeat(100), ")".repeat(100)), "32"),
        ("p0.x + \u{202E}".to_owned(), "no meaning"),
    ] {
        let errors = load(&residual).unwrap_err();
        assert_eq!(errors.errors.len(), 1, "{errors}");
        assert!(errors.errors[0].message.contains(said), "{errors}");
        assert_eq!(errors.errors[0].line, 7);
        assert!(!errors.to_string().contains(['\u{7f}', '\u{202E}']), "{errors:?}");
    }
}
