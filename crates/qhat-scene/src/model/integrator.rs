//! The integrator of a scene, by any of its names.

use qhat::Integrator;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::borrow::Cow;

/// An integrator, in a scene its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Method(pub(crate) Integrator);

impl JsonSchema for Method {
    fn schema_name() -> Cow<'static, str> {
        "Integrator".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "The integrator.",
            "type": "string",
            "enum": Integrator::names().map(|(name, _)| name).collect::<Vec<_>>(),
        })
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.name())
    }
}

impl<'de> Deserialize<'de> for Method {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map(Method).map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{from_value, json, to_value};

    /// The first name of an integrator is the engine's own, so that reports and files use one name.
    #[test]
    fn every_name_chooses_its_integrator() {
        for (name, integrator) in Integrator::names() {
            assert_eq!(from_value::<Method>(json!(name)).unwrap(), Method(integrator));
            assert_eq!(to_value(Method(integrator)).unwrap(), json!(integrator.name()));
        }
        assert_eq!(from_value::<Method>(json!("backward-euler")).unwrap(), Method(Integrator::Implicit));
        assert!(from_value::<Method>(json!("forward-euler")).is_err());
    }

    #[test]
    fn no_name_has_two_meanings() {
        let mut names: Vec<&str> = Integrator::names().map(|(name, _)| name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Integrator::names().count());
    }
}
