//! Numbers that are texts of parameters: any number of a scene may be one, and a scene that is bound is the scene with
//! these numbers, to the bit.

use qhat_scene::{Format, Scene, SceneErrors, load, load_with};
use serde_json::{Value, json};

const SCENES: [&str; 3] =
    [include_str!("every-key.toml"), include_str!("every-key-in-space.toml"), include_str!("every-contact.toml")];

/// The pointers to all numbers of a scene outside of `[parameters]` and `[expect]`.
fn numbers(value: &Value, pointer: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(pointer.to_owned()),
        Value::Object(table) => table
            .iter()
            .filter(|(key, _)| !(pointer.is_empty() && matches!(key.as_str(), "parameters" | "expect" | "dimension")))
            .for_each(|(key, value)| numbers(value, &format!("{pointer}/{key}"), found)),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(k, value)| numbers(value, &format!("{pointer}/{k}"), found));
        }
        _ => {}
    }
}

fn read(scene: &Value, parameters: &[(String, f64)]) -> Result<Scene, SceneErrors> {
    load_with(&scene.to_string(), "scene.json", Format::Json, parameters)
}

/// Everything that a scene consists of.
fn all(scene: &Scene) -> String {
    format!("{:?} {:?} {:?} {:?}", scene.system, scene.state, scene.settings, scene.duration)
}

/// Every number of every kind of every table, one after the other, becomes a text of parameters. Whole numbers (counts)
/// are tried with another whole number. A scene that refuses the other number must refuse it both ways.
#[test]
fn a_bound_scene_is_the_scene_with_these_numbers() {
    let (mut tried, mut bindable, mut refused) = (0, 0, 0);
    for text in SCENES {
        let plain: Value = toml::from_str(text).unwrap();
        let mut pointers = Vec::new();
        numbers(&plain, "", &mut pointers);
        for pointer in pointers {
            let mut scene = plain.clone();
            let number = scene.pointer(&pointer).and_then(Value::as_f64).unwrap();
            *scene.pointer_mut(&pointer).unwrap() = json!("now");
            let table = scene.as_object_mut().unwrap().entry("parameters").or_insert(json!({}));
            table["now"] = json!(number);
            let mut bound = read(&scene, &[]).unwrap_or_else(|errors| panic!("{pointer}: {errors}"));
            let place = bound.system.parameters().iter().position(|parameter| parameter.name == "now").unwrap();
            let is_bindable = bound.system.parameter_uses().iter().any(|it| it.is_bindable() && it.depends_on(place));
            let other = if number.fract() == 0.0 && number.abs() > 1.0 { number + 1.0 } else { number * 1.001 + 1e-4 };
            let values: Vec<f64> = bound.system.parameters().iter().map(|parameter| parameter.value).collect();
            let others = values.iter().enumerate().map(|(k, &value)| if k == place { other } else { value });
            let outcome = bound.bind(&others.collect::<Vec<_>>());
            tried += 1;
            bindable += usize::from(is_bindable);
            match (outcome, read(&scene, &[("now".to_owned(), other)])) {
                (Ok(()), Ok(fresh)) => {
                    assert!(all(&bound) == all(&fresh), "{pointer}: {number} → {other}, bindable: {is_bindable}");
                }
                (Err(one), Err(other)) => {
                    assert_eq!(one.to_string(), other.to_string(), "{pointer}");
                    refused += 1;
                }
                (one, other) => panic!("{pointer}: {:?}, {:?}", one.err(), other.err()),
            }
            // Back again.
            bound.bind(&values).unwrap();
            assert!(all(&bound) == all(&read(&scene, &[]).unwrap()), "{pointer}: back to {number}");
        }
    }
    // Numbers that the scenes of every key have today, and those that a fast bind must reach.
    println!("{tried} numbers, {bindable} bound in place, {refused} refused with another value");
    assert!(tried > 250 && bindable > 80 && refused < tried / 4, "{tried} {bindable} {refused}");
}

fn errors_of(text: &str, parameters: &[(&str, f64)]) -> Vec<String> {
    let parameters: Vec<_> = parameters.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    match load_with(text, "scene.toml", Format::Toml, &parameters) {
        Ok(_) => Vec::new(),
        Err(errors) => errors
            .errors
            .iter()
            .map(|error| {
                let help = error.help.as_deref().unwrap_or_default();
                format!("{}:{}: {} | {help}", error.line, error.column, error.message)
            })
            .collect(),
    }
}

const PENDULUM: &str = r#"schema = "qhat/1"
name = "Pendulum"
dimension = 2

[parameters]
L = { value = 1.0, min = 0.1, max = 5.0, unit = "m" }
m = 2.0

[[particles]]
id = "pivot"
at = [0, 0]
fixed = true

[[particles]]
id = "bob"
at = ["L*sin(pi/6)", "-L*cos(pi/6)"]
mass = "m"

[[constraints]]
kind = "distance"
between = ["pivot", "bob"]
length = "L"
"#;

#[test]
fn parameters_have_a_value_a_range_and_a_unit() {
    let scene = load(PENDULUM, "scene.toml", Format::Toml).unwrap();
    let parameters = scene.system.parameters();
    assert_eq!((parameters[0].name.as_str(), parameters[0].value, parameters[0].range), ("L", 1.0, [0.1, 5.0]));
    assert_eq!((parameters[0].unit.as_str(), parameters[1].name.as_str()), ("m", "m"));
    let uses: Vec<_> = scene.system.parameter_uses().iter().map(ToString::to_string).collect();
    let expected =
        ["length in line 22 = L", "at in line 16 = L*sin(pi/6)", "at in line 16 = -L*cos(pi/6)", "mass in line 17 = m"];
    for line in expected {
        assert!(uses.contains(&line.to_owned()), "{uses:?}");
    }
    assert!(scene.system.parameter_uses().iter().all(|it| it.is_bindable()));
    let longer = load_with(PENDULUM, "scene.toml", Format::Toml, &[("L".to_owned(), 2.0)]).unwrap();
    assert_eq!(longer.state.positions()[2], 2.0 * (std::f64::consts::PI / 6.0).sin());
}

/// A piece of the scene, its replacement, the values that are set, and the beginning of the error.
type Broken = (&'static str, &'static str, &'static [(&'static str, f64)], &'static str);

#[test]
fn what_no_parameter_can_be_is_refused_in_words() {
    let cases: [Broken; 14] = [
        ("", "", &[("l", 2.0)], "5:1: there is no parameter `l` to set | the parameters of this scene are `L` or `m`"),
        ("", "", &[("L", 7.0)], "6:5: the parameter `L` must be at least 0.1 and at most 5, but is 7 | "),
        ("", "", &[("m", f64::NAN)], "7:5: the parameter `m` must be a finite number, but is NaN | "),
        ("", "", &[("m", -1.0)], "17:8: `mass` must be above 0, but is -1.0, the value of `m` | `mass` is the mass"),
        ("mass = \"m\"", "mass = \"q\"", &[], "17:9: `mass` must be a number or an expression of parameters, but is"),
        ("mass = \"m\"", "mass = \"2*\"", &[], "17:10: `mass` must be a number or an expression of parameters"),
        ("mass = \"m\"", "mass = \"t\"", &[], "17:9: `mass` must be a number or an expression of parameters"),
        ("m = 2.0", "m = \"2*L\"", &[], "7:5: `parameters[m]` must be a number or a table, but is the text `2*L`"),
        (
            "[parameters]\nL = { value = 1.0, min = 0.1, max = 5.0, unit = \"m\" }\nm = 2.0",
            "[parameters.L]\nvalue = 1.0\nmax = \"m*3\"\n[parameters.m]\nvalue = 2.0",
            &[],
            "7:7: `max` must be a number, but is the text `m*3`",
        ),
        (
            "[parameters]\nL = { value = 1.0, min = 0.1, max = 5.0, unit = \"m\" }\nm = 2.0",
            "[parameters]\nL.value = \"m/2\"\nm = 2.0",
            &[],
            "6:11: `value` must be a number, but is the text `m/2`",
        ),
        (
            "[parameters]\nL = { value = 1.0, min = 0.1, max = 5.0, unit = \"m\" }\nm = 2.0\n",
            "parameters.L = 1.0\nparameters.m.value = \"L\"\n",
            &[],
            "6:22: `value` must be a number, but is the text `L`",
        ),
        ("min = 0.1", "min = 3.0", &[], "6:1: the parameter `L` must be at least 3 and at most 5, but is 1 | "),
        ("min = 0.1", "min = 9.0", &[], "6:1: `min` of the parameter `L` is above `max` | exchange them"),
        ("min = 0.1", "mni = 0.1", &[], "6:20: unknown key `mni` in `parameters[L]` | did you mean `min`?"),
    ];
    for (from, to, set, words) in cases {
        let errors = errors_of(&PENDULUM.replacen(from, to, usize::from(!from.is_empty())), set);
        assert!(errors.iter().any(|error| error.starts_with(words)), "{words}\n{errors:#?}");
    }
    let without =
        PENDULUM.replace("[parameters]\nL = { value = 1.0, min = 0.1, max = 5.0, unit = \"m\" }\nm = 2.0\n", "");
    let errors = errors_of(&without.replace("\"m\"", "1").replace("\"L\"", "1").replace("L*", ""), &[("L", 1.0)]);
    assert!(errors[0].starts_with("1:1: there is no parameter `L` to set: the scene has none"), "{errors:?}");
}
