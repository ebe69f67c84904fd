//! `qhat render`: pictures, read back by a parser of XML and a decoder of PNG, and input that is refused.

use crate::common::{BREAKS, Folder, INFEASIBLE, JERKED, PENDULUM};
use roxmltree::Document;
use std::path::Path;

/// The titles and colours of the links of a picture, and its texts.
fn drawn(svg: &str) -> (Vec<(String, String)>, Vec<String>) {
    let document = Document::parse(svg).unwrap();
    let lines = document.descendants().filter(|node| node.has_tag_name("line"));
    let links = lines.map(|line| {
        let title = line.first_element_child().unwrap().text().unwrap();
        (title.to_owned(), line.attribute("stroke").unwrap().to_owned())
    });
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    (links.collect(), texts.filter_map(|node| Some(node.text()?.to_owned())).collect())
}

fn has_class(svg: &str, class: &str) -> bool {
    Document::parse(svg).unwrap().descendants().any(|node| node.attribute("class") == Some(class))
}

/// Width, height and the number of colours of a PNG.
fn pixels(path: &Path) -> (u32, u32, usize) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut buffer).unwrap();
    let colours: std::collections::HashSet<&[u8]> = buffer.chunks(4).collect();
    (info.width, info.height, colours.len())
}

#[test]
fn a_still_of_the_start_has_name_time_and_tension() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["render", "bob.toml", "-o", "bob.svg"]).well();
    let (links, texts) = drawn(&folder.read("bob.svg"));
    // At rest on the horizontal the rod carries nothing.
    assert_eq!(links, [("rod hook-bob: 0 N".to_owned(), "#a8acb2".to_owned())]);
    assert_eq!(texts[..2], ["A bob", "t = 0 s"]);
    assert_eq!(folder.files(), ["bob.svg", "bob.toml"], "nothing temporary is left");
}

#[test]
fn a_later_time_is_the_frame_that_a_run_writes() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz", "-q"]).well();
    folder.qhat(&["render", "bob.toml", "-o", "at.svg", "--at", "0.2"]).well();
    folder.qhat(&["render", "bob.toml", "-o", "from.svg", "--from", "bob.npz", "--frame", "20"]).well();
    let at = folder.read("at.svg");
    assert_eq!(at, folder.read("from.svg"));
    let (links, texts) = drawn(&at);
    assert_eq!(texts[1], "t = 0.2 s");
    // The bob has fallen almost freely: g t²/2 = 0.196 m, and a rod of 1 m carries 3 m g sin φ with sin φ ≈ 0.195. On a
    // scale of 20 N this is step 11 of 20, √0.55 of the way from grey to blue.
    assert!(links[0].0.starts_with("rod hook-bob: 11.") && links[0].1 == "#3c71c5", "{links:?}");

    // A trajectory has its own parameters.
    let text =
        PENDULUM.replace("mass = 2.0", "mass = \"m\"").replace("dimension = 2", "dimension = 2\nparameters.m = 2.0");
    std::fs::write(folder.path("named.toml"), text).unwrap();
    folder.qhat(&["run", "named.toml", "-o", "named.npz", "-q", "--set", "m=8"]).well();
    folder.qhat(&["render", "named.toml", "-o", "a.svg", "--from", "named.npz", "--frame", "20"]).well();
    folder.qhat(&["render", "named.toml", "-o", "b.svg", "--at", "0.2", "--set", "m=8"]).well();
    assert_eq!(folder.read("a.svg"), folder.read("b.svg"));
    assert_ne!(folder.read("a.svg"), at);

    folder.qhat(&["render", "bob.toml", "-o", "last.svg", "--from", "bob.npz"]).well();
    assert_eq!(drawn(&folder.read("last.svg")).1[1], "t = 0.5 s");
    // A time between two frames, and a time beyond the duration of the scene.
    folder.qhat(&["render", "bob.toml", "-o", "late.svg", "--at", "0.605"]).well();
    assert_eq!(drawn(&folder.read("late.svg")).1[1], "t = 0.605 s");
}

#[test]
fn a_png_has_the_size_asked_for_and_the_same_bytes_every_time() {
    let folder = Folder::new();
    for name in ["a.png", "b.png"] {
        folder.qhat(&["render", "bridge-truss", "-o", name, "--at", "0.1"]).well();
    }
    let (width, height, _) = pixels(&folder.path("a.png"));
    assert_eq!((width, height), (1200, 800));
    assert!(std::fs::read(folder.path("a.png")).unwrap() == std::fs::read(folder.path("b.png")).unwrap());
    folder.qhat(&["render", "bridge-truss", "-o", "dark.png", "--size", "640x360", "--dark"]).well();
    let (width, height, colours) = pixels(&folder.path("dark.png"));
    assert_eq!((width, height), (640, 360));
    assert!(colours > 100, "{colours} colours");
}

#[test]
fn a_broken_link_leaves_stubs_by_either_way() {
    let folder = Folder::with(&[("breaks.toml", BREAKS)]);
    folder.qhat(&["run", "breaks.toml", "-o", "run.npz", "-q"]).well();
    folder.qhat(&["render", "breaks.toml", "-o", "whole.svg", "--at", "0.3"]).well();
    assert!(!has_class(&folder.read("whole.svg"), "broken"));
    folder.qhat(&["render", "breaks.toml", "-o", "at.svg", "--at", "0.6"]).well();
    folder.qhat(&["render", "breaks.toml", "-o", "from.svg", "--from", "run.npz"]).well();
    for name in ["at.svg", "from.svg"] {
        let picture = folder.read(name);
        assert!(has_class(&picture, "broken") && drawn(&picture).0.is_empty(), "{name}");
    }
    // A trajectory shows a link that an impulse broke as well.
    let folder = Folder::with(&[("jerked.toml", JERKED)]);
    folder.qhat(&["run", "jerked.toml", "-o", "run.npz", "-q"]).well();
    folder.qhat(&["render", "jerked.toml", "-o", "from.svg", "--from", "run.npz"]).well();
    assert!(has_class(&folder.read("from.svg"), "broken"));
    // The rods of an infeasible start have no tension and wrong lengths, but they cannot break.
    let folder = Folder::with(&[("torn.toml", INFEASIBLE)]);
    assert_eq!(folder.qhat(&["run", "torn.toml", "-o", "torn.npz", "-q"]).code, 1);
    folder.qhat(&["render", "torn.toml", "-o", "torn.svg", "--from", "torn.npz"]).well();
    let picture = folder.read("torn.svg");
    assert!(!has_class(&picture, "broken") && drawn(&picture).0.len() == 2, "{picture}");
}

#[test]
fn a_run_that_ends_early_is_drawn_and_marked() {
    // Explicit Euler without feedback diverges with steps of half a second.
    let euler = PENDULUM.replace("h = 0.01, duration = 0.5", "h = 0.5, duration = 100, integrator = \"euler\"");
    let folder = Folder::with(&[("euler.toml", &euler), ("torn.toml", INFEASIBLE)]);
    let ran = folder.qhat(&["render", "euler.toml", "-o", "euler.svg", "--at", "100"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.stderr.starts_with("diverged: at t = "), "{}", ran.stderr);
    let said = drawn(&folder.read("euler.svg")).1.remove(1);
    assert!(said.starts_with("t = ") && said.ends_with(" s, diverged"), "{said}");

    let ran = folder.qhat(&["render", "torn.toml", "-o", "torn.svg"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.stderr.starts_with("infeasible: "), "{}", ran.stderr);
    assert_eq!(drawn(&folder.read("torn.svg")).1[1], "t = 0 s, infeasible start");
}

#[test]
fn what_cannot_be_drawn_is_refused_and_every_file_stays() {
    let euler = PENDULUM.replace("h = 0.01,", "h = 0.01, integrator = \"euler\",");
    let uneven = euler.replace("h = 0.01,", "h = 0.3,");
    let scenes = [("bob.toml", PENDULUM), ("euler.toml", &euler), ("uneven.toml", &uneven)];
    let folder = Folder::with(&[&scenes[..], &[("bob.svg", "mine"), ("no.npz", "no zip")]].concat());
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz", "-q"]).well();
    let refused = |arguments: &[&str], words: &str| {
        folder.qhat(&[&["render"], arguments].concat()).refused(words);
    };
    refused(&["bob.toml", "-o", "bob.svg"], "exists; nothing was written. Use --force");
    refused(&["bob.toml", "-o", "bob.gif"], "end the name in .svg or .png");
    refused(&["bob.toml", "-o", "nowhere/bob.svg"], "there is no folder `nowhere`");
    refused(&["bob.toml"], "--output");
    refused(&["nothing", "-o", "a.svg"], "no scene of that name comes with qhat");
    for at in ["-1", "nan", "inf"] {
        refused(&["bob.toml", "-o", "a.svg", "--at", at], "must be 0 or later");
    }
    refused(&["bob.toml", "-o", "a.svg", "--at", "1e300"], "more than the");
    refused(&["euler.toml", "-o", "a.svg", "--at", "0.015"], "choose --at as a multiple of 0.01 s");
    refused(&["uneven.toml", "-o", "a.svg", "--at", "0.3"], "choose its `duration` as a multiple of 0.3 s");
    for size in ["800", "100x100", "9000x800", "axb", "-800x800"] {
        refused(&["bob.toml", "-o", "a.svg", &format!("--size={size}")], "--size");
    }
    refused(&["bob.toml", "-o", "a.svg", "--frame", "1"], "--from");
    refused(&["bob.toml", "-o", "a.svg", "--at", "1", "--from", "bob.npz"], "cannot be used with");
    refused(&["bob.toml", "-o", "a.svg", "--from", "bob.npz", "--frame", "51"], "has 51 frames, counted from 0");
    refused(&["bob.toml", "-o", "a.svg", "--from", "none.npz"], "cannot read `none.npz`");
    refused(&["bob.toml", "-o", "a.svg", "--from", "no.npz"], "is no trajectory");
    refused(&["net", "-o", "a.svg", "--from", "bob.npz"], "the array `positions`");
    assert_eq!(folder.read("bob.svg"), "mine");
    assert_eq!(folder.files(), ["bob.npz", "bob.svg", "bob.toml", "euler.toml", "no.npz", "uneven.toml"]);
    folder.qhat(&["render", "bob.toml", "-o", "bob.svg", "--force"]).well();
    assert!(folder.read("bob.svg").starts_with("<svg"));
}

#[test]
fn a_trajectory_of_another_text_is_drawn_with_a_warning() {
    let heavier = PENDULUM.replace("mass = 2.0", "mass = 3.0");
    let folder = Folder::with(&[("bob.toml", PENDULUM), ("heavier.toml", &heavier)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz", "-q"]).well();
    let ran = folder.qhat(&["render", "heavier.toml", "-o", "bob.svg", "--from", "bob.npz"]);
    assert_eq!(ran.code, 0, "{ran:?}");
    assert_eq!(ran.stderr, "`bob.npz` comes from another text of the scene `heavier.toml`\n");
}

/// Members whose header claims more data than the file has are refused before memory is allocated.
#[test]
fn a_hostile_trajectory_is_refused() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz", "-q"]).well();
    let whole = std::fs::read(folder.path("bob.npz")).unwrap();
    for length in [0, 30, 100, whole.len() / 2, whole.len() - 1] {
        std::fs::write(folder.path("cut.npz"), &whole[..length]).unwrap();
        folder.qhat(&["render", "bob.toml", "-o", "a.svg", "--from", "cut.npz"]).refused("is no trajectory");
    }
    for (what, lie) in [("(51, 2, 2)", "(9999999999999999999, 2, 2)"), ("(51, 2, 2)", "(51, 2, 4294967296)")] {
        let mut file = zip::ZipWriter::new(std::fs::File::create(folder.path("lie.npz")).unwrap());
        let stored = zip::write::SimpleFileOptions::DEFAULT.compression_method(zip::CompressionMethod::Stored);
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(&whole)).unwrap();
        for index in 0..archive.len() {
            let mut member = archive.by_index(index).unwrap();
            let mut bytes = Vec::new();
            std::io::Read::read_to_end(&mut member, &mut bytes).unwrap();
            file.start_file(member.name(), stored).unwrap();
            if member.name() == "positions.npy" {
                let header = String::from_utf8(bytes[10..128].to_vec()).unwrap();
                let padded = format!("{:117}\n", header.trim_end().replace(what, lie));
                bytes[10..128].copy_from_slice(padded.as_bytes());
            }
            std::io::Write::write_all(&mut file, &bytes).unwrap();
        }
        file.finish().unwrap();
        folder.qhat(&["render", "bob.toml", "-o", "a.svg", "--from", "lie.npz"]).refused("the array `positions`");
    }
    assert!(!folder.files().contains(&"a.svg".to_owned()));
}
