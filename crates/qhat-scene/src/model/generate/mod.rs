//! `[[generate]]`: many particles from few numbers, one kind a file.
//!
//! To add a kind: write one file here with its keys and its `Plan`, and name it in the list below.

mod chain;
mod net;
mod ring;
mod truss;

use super::Vector;
use super::constraint::DistanceForm;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Particles by the dozen, with what connects them.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Generate {
    Chain(chain::Chain),
    Net(net::Net),
    Truss(truss::Truss),
    Ring(ring::Ring),
}

/// What connects neighbours.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Link {
    Rod(RodLink),
    Spring(SpringLink),
    None(NoLink),
}

impl Default for Link {
    fn default() -> Self {
        Link::Rod(RodLink::default())
    }
}

/// Rods as long as the distances at the start.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RodLink {
    /// The function that is held at zero: the length's error, or that of its square (the classic one).
    #[serde(default)]
    pub(crate) form: DistanceForm,
    /// How far each gives way [m/N], 0 (rigid) or more: under a tension T it is longer by this times T.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) compliance: f64,
    /// A damper beside the compliance [N·s/m], 0 or more; a rigid rod has no motion to damp.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
}

/// Springs that do not pull at the start.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpringLink {
    /// The stiffness of each [N/m], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) stiffness: f64,
    /// The damping of each [N·s/m], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
}

/// Nothing: the particles alone.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoLink {}

/// What is the same for every kind and every particle of it.
pub(crate) struct Common<'a> {
    pub(crate) mass: f64,
    pub(crate) velocity: Option<&'a Vector>,
    pub(crate) fixed: bool,
    pub(crate) link: &'a Link,
}

/// Particles and the pairs of them that are linked, by their place in the list.
#[derive(Debug, Default)]
pub(crate) struct Plan {
    pub(crate) particles: Vec<(String, Vec<f64>)>,
    pub(crate) links: Vec<(usize, usize)>,
}

impl Plan {
    /// Adds a particle and tells its place.
    fn particle(&mut self, name: String, at: Vec<f64>) -> usize {
        self.particles.push((name, at));
        self.particles.len() - 1
    }
}

macro_rules! kinds {
    ($($kind:ident),*) => {
        impl Generate {
            /// How many particles it makes, without making them.
            pub(crate) fn count(&self) -> u64 {
                match self { $(Generate::$kind(generate) => generate.count(),)* }
            }

            /// What it makes.
            pub(crate) fn plan(&self) -> Plan {
                match self { $(Generate::$kind(generate) => generate.plan(),)* }
            }

            pub(crate) fn common(&self) -> Common<'_> {
                match self {
                    $(Generate::$kind(generate) => Common {
                        mass: generate.mass,
                        velocity: generate.velocity.as_ref(),
                        fixed: generate.fixed,
                        link: &generate.link,
                    },)*
                }
            }
        }
    };
}

kinds!(Chain, Net, Truss, Ring);

/// origin + Σ factor · direction, component by component.
fn point(origin: &Vector, terms: &[(f64, &Vector)]) -> Vec<f64> {
    let component = |k: usize| terms.iter().fold(origin.0[k], |sum, (factor, direction)| sum + factor * direction.0[k]);
    (0..origin.0.len()).map(component).collect()
}

/// 4 s (1 − s): a parabola that is 0 at both ends and 1 in the middle of the n places 0 … n − 1.
fn bow(place: u32, n: u32) -> f64 {
    let s = f64::from(place) / f64::from(n - 1);
    4.0 * s * (1.0 - s)
}
