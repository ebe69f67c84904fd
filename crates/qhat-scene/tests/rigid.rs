//! `kind = "rigid"`: the rows that it adds for joints in general position, in a line and in a plane; and names that
//! many constraints share.

use qhat_scene::{Format, load};

/// The names of the constraints of a scene whose particles a, b, … are held by `rigid`.
fn held(dimension: usize, places: &[&str]) -> Vec<String> {
    let ids: Vec<String> = ('a'..).take(places.len()).map(String::from).collect();
    let particles: Vec<String> =
        ids.iter().zip(places).map(|(id, at)| format!("  {{ id = \"{id}\", at = [{at}] }},\n")).collect();
    let quoted: Vec<String> = ids.iter().map(|id| format!("\"{id}\"")).collect();
    let text = format!(
        "schema = \"qhat/1\"\nname = \"Held\"\ndimension = {dimension}\nparticles = [\n{}]\nconstraints = \
         [{{ kind = \"rigid\", particles = [{}] }}]\n",
        particles.concat(),
        quoted.join(", ")
    );
    let scene = load(&text, "held.toml", Format::Toml).unwrap_or_else(|errors| panic!("{errors}"));
    let freedom = scene.system.coordinate_count() - qhat::evaluate(&scene.system, &scene.state).rank.unwrap();
    assert_eq!(scene.system.row_count(), scene.system.coordinate_count() - freedom, "no row is redundant");
    scene.system.constraints().iter().map(|named| named.name.clone()).collect()
}

#[test]
fn joints_in_a_line_and_in_a_plane_are_held() {
    assert_eq!(held(2, &["0.0, 0.0", "1.0, 0.5", "4.0, 2.0"]), ["c-a", "rigid(b)"]);
    assert_eq!(held(3, &["1.0, 0.0, 1.0", "0.0, 0.0, 0.0", "2.0, 0.0, 2.0"]), ["b-c", "rigid(a)"]);
    let plate = ["0.0, 0.0, 1.0", "2.0, 0.0, 1.0", "2.0, 1.0, 1.0", "0.0, 1.0, 1.0", "1.0, 0.5, 1.0"];
    assert_eq!(held(3, &plate), ["c-a", "c-b", "a-b", "rigid(d)", "rigid(e)"]);
    // In general position there are rods alone.
    assert!(held(2, &plate.map(|at| at.strip_suffix(", 1.0").unwrap())).iter().all(|name| name.contains('-')));
}

/// The number behind a name goes on where it was, also where a name with a number was given.
#[test]
fn equal_names_are_numbered() {
    let text = "schema = \"qhat/1\"\nname = \"Names\"\ndimension = 2\nparticles = [{ id = \"a\", at = [0.0, 0.0] }]\n\
                constraints = [\n{ kind = \"expression\", residual = \"a.x\" },\n\
                { kind = \"expression\", id = \"expression(3)\", residual = \"a.x\" },\n\
                { kind = \"expression\", residual = \"a.x\" },\n{ kind = \"expression\", residual = \"a.x\" },\n\
                { kind = \"expression\", residual = \"a.x\" }]\n";
    let scene = load(text, "names.toml", Format::Toml).unwrap_or_else(|errors| panic!("{errors}"));
    let names: Vec<&str> = scene.system.constraints().iter().map(|named| named.name.as_str()).collect();
    assert_eq!(names, ["expression", "expression(3)", "expression(2)", "expression(4)", "expression(5)"]);
}
