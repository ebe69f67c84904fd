//! `[[generate]]`: blocks of many particles from few numbers, one kind to a file.
//!
//! A new kind costs one file here with its keys and its `Plan`, its name in the enum below, and its name in the list
//! `kinds!` below.

mod chain;
mod net;
mod ring;
mod truss;

use super::Vector;
use super::rods::DistanceForm;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A block of many particles with the links between them.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Generate {
    Chain(chain::Chain),
    Net(net::Net),
    Truss(truss::Truss),
    Ring(ring::Ring),
}

/// The links between neighbours.
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

/// Rods with the distances at the start as their lengths.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RodLink {
    /// The function that is held at zero: the error of the length, or of its square (the classic form).
    #[serde(default)]
    pub(crate) form: DistanceForm,
    /// The compliance of each rod [m/N], 0 (rigid) or more: under a tension T a rod is longer by compliance · T.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) compliance: f64,
    /// The damping beside the compliance [N·s/m], 0 or more; a rigid rod has no motion to damp.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
}

/// Springs with the distances at the start as their rest lengths.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpringLink {
    /// The stiffness of each spring [N/m], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) stiffness: f64,
    /// The damping of each spring [N·s/m], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
}

/// No links: the particles alone.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoLink {}

/// The keys that every kind has; they hold for every particle of a block.
pub(crate) struct Common<'a> {
    pub(crate) mass: f64,
    pub(crate) velocity: Option<&'a Vector>,
    pub(crate) fixed: bool,
    pub(crate) link: &'a Link,
}

/// The particles of a block, and the pairs of linked particles by their places in the list.
#[derive(Debug, Default)]
pub(crate) struct Plan {
    pub(crate) particles: Vec<(String, Vec<f64>)>,
    pub(crate) links: Vec<(usize, usize)>,
}

impl Plan {
    /// Adds a particle and returns its place.
    fn particle(&mut self, name: String, at: Vec<f64>) -> usize {
        self.particles.push((name, at));
        self.particles.len() - 1
    }
}

macro_rules! kinds {
    ($($kind:ident),*) => {
        impl Generate {
            /// The number of particles of the block; makes none.
            pub(crate) fn count(&self) -> u64 {
                match self { $(Generate::$kind(generate) => generate.count(),)* }
            }

            /// The particles and links of the block.
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
