//! The parameters of a scene, with the numbers that depend on each.

use qhat::{Parameter, System};
use serde::Serialize;

/// The most uses of a parameter that are printed.
const LISTED: usize = 6;

/// A parameter and its uses.
#[derive(Debug, Serialize)]
pub(super) struct Found {
    name: String,
    value: f64,
    /// The least and the greatest value; none where there is no limit.
    min: Option<f64>,
    max: Option<f64>,
    unit: String,
    uses: Vec<Use>,
}

/// A number that depends on a parameter.
#[derive(Debug, Serialize)]
struct Use {
    place: String,
    text: String,
    /// Whether the number is changed in a system that is built; else the scene is built anew.
    is_bindable: bool,
}

impl Found {
    /// All parameters of a system.
    pub(super) fn all(system: &System) -> Vec<Found> {
        let parameters = system.parameters().iter().enumerate();
        parameters.map(|(place, parameter)| Found::of(system, place, parameter)).collect()
    }

    fn of(system: &System, place: usize, parameter: &Parameter) -> Self {
        let uses = system.parameter_uses().iter().filter(|it| it.depends_on(place));
        let uses =
            uses.map(|it| Use { place: it.place.clone(), text: it.text().to_owned(), is_bindable: it.is_bindable() });
        let limit = |k: usize| Some(parameter.range[k]).filter(|limit| limit.is_finite());
        Found {
            name: parameter.name.clone(),
            value: parameter.value,
            min: limit(0),
            max: limit(1),
            unit: parameter.unit.clone(),
            uses: uses.collect(),
        }
    }

    pub(super) fn in_words(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let range = match (self.min, self.max) {
            (Some(min), Some(max)) => format!(", from {min} to {max}"),
            (Some(min), None) => format!(", at least {min}"),
            (None, Some(max)) => format!(", at most {max}"),
            (None, None) => String::new(),
        };
        let places: Vec<&str> = self.uses.iter().take(LISTED).map(|it| it.place.as_str()).collect();
        let uses = match self.uses.len() {
            0 => "not used".to_owned(),
            all if all > LISTED => format!("{} and {} more", places.join(", "), all - LISTED),
            _ => places.join(", "),
        };
        format!("{} = {}{unit}{range}: {uses}", self.name, self.value)
    }
}
