//! `[[bodies]]`: rigid bodies, each a few particles and the rods between them. The engine's `Body` derives which.

use super::{Id, Vector};
use qhat::BodyError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rigid bodies, each made of a few particles, prefix0, prefix1, …, and the rods between them.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Body {
    Bar(Bar),
    Block(Block),
    Triangle(Triangle),
    Inertia(Inertia),
}

/// A uniform thin bar; its particles 0 and 1 are its ends.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bar {
    /// What the ids of its particles begin with.
    pub(crate) prefix: Id,
    /// The mass of the whole [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// Where one end starts [m].
    pub(crate) from: Vector,
    /// Where the other end starts [m].
    pub(crate) to: Vector,
    /// The velocity of its centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// How it turns at the start [rad/s]: one number in the plane, three in space; not if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// What is uniform over one edge (a thin bar), two (a plate) or three (a block).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Block {
    /// What the ids of its particles begin with.
    pub(crate) prefix: Id,
    /// The mass of the whole [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// Where its centre starts [m].
    pub(crate) center: Vector,
    /// Its edges [m], one to three vectors that do not lie in one line or plane.
    #[schemars(length(min = 1, max = 3))]
    pub(crate) edges: Vec<Vector>,
    /// The velocity of its centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// How it turns at the start [rad/s]: one number in the plane, three in space; not if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// A uniform triangular plate.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Triangle {
    /// What the ids of its particles begin with.
    pub(crate) prefix: Id,
    /// The mass of the whole [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// Where its corners start [m].
    pub(crate) corners: [Vector; 3],
    /// The velocity of its centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// How it turns at the start [rad/s]: one number in the plane, three in space; not if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// A body of which the moments of inertia about its centre are known.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Inertia {
    /// What the ids of its particles begin with.
    pub(crate) prefix: Id,
    /// The mass of the whole [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// Where its centre starts [m].
    pub(crate) center: Vector,
    /// Its moments of inertia about the centre [kg m²]: one number in the plane; in space xx, yy, zz, or xx, yy, zz, xy, xz, yz.
    #[schemars(length(min = 1, max = 6))]
    pub(crate) inertia: Vec<f64>,
    /// The velocity of its centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// How it turns at the start [rad/s]: one number in the plane, three in space; not if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// An angular velocity.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Turning(#[schemars(length(min = 1, max = 3))] pub(crate) Vec<f64>);

/// Why a block of `bodies` makes none, and the key that says so.
pub(crate) struct Refusal {
    pub(crate) key: &'static str,
    pub(crate) message: String,
    pub(crate) help: &'static str,
}

impl Body {
    /// The particles and rods.
    pub(crate) fn make(&self, dimension: usize) -> Result<qhat::Body, Refusal> {
        let refused =
            |key: &'static str| move |error: BodyError| Refusal { key, message: error.to_string(), help: help(key) };
        match self {
            Body::Bar(Bar { mass, from, to, .. }) if dimension == 3 => {
                qhat::Body::bar_in_space(*mass, [from, to].map(Vector::padded)).map_err(refused("to"))
            }
            Body::Bar(Bar { mass, from, to, .. }) => {
                qhat::Body::bar_in_plane(*mass, [from, to].map(|end| [end.0[0], end.0[1]])).map_err(refused("to"))
            }
            Body::Block(Block { mass, center, edges, .. }) => {
                let edges: Vec<[f64; 3]> = edges.iter().map(Vector::padded).collect();
                qhat::Body::block(*mass, center.padded(), &edges).map_err(refused("edges"))
            }
            Body::Triangle(Triangle { mass, corners, .. }) => {
                qhat::Body::triangle(*mass, corners.each_ref().map(Vector::padded)).map_err(refused("corners"))
            }
            Body::Inertia(Inertia { mass, center, inertia, .. }) => match (dimension, inertia.as_slice()) {
                (2, [polar]) => {
                    qhat::Body::in_plane(*mass, [center.0[0], center.0[1]], *polar).map_err(refused("inertia"))
                }
                (3, &[xx, yy, zz]) => {
                    let tensor = [[xx, 0.0, 0.0], [0.0, yy, 0.0], [0.0, 0.0, zz]];
                    qhat::Body::from_inertia(*mass, center.padded(), tensor).map_err(refused("inertia"))
                }
                (3, &[xx, yy, zz, xy, xz, yz]) => {
                    let tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
                    qhat::Body::from_inertia(*mass, center.padded(), tensor).map_err(refused("inertia"))
                }
                (_, given) => {
                    let wanted = if dimension == 2 { "1 number in the plane" } else { "3 or 6 numbers in space" };
                    let message = format!("`inertia` must have {wanted}, but has {}", given.len());
                    Err(Refusal { key: "inertia", message, help: help("inertia") })
                }
            },
        }
    }

    /// ω [rad/s], about z in the plane.
    pub(crate) fn spin(&self, dimension: usize) -> Result<[f64; 3], Refusal> {
        match (dimension, self.common().spin.map(|Turning(spin)| spin.as_slice())) {
            (_, None) => Ok([0.0; 3]),
            (2, Some(&[z])) => Ok([0.0, 0.0, z]),
            (3, Some(&[x, y, z])) => Ok([x, y, z]),
            (_, Some(given)) => {
                let wanted = if dimension == 2 { "1 number in the plane" } else { "3 numbers in space" };
                let message = format!("`spin` must have {wanted}, but has {}", given.len());
                let help = "`spin` is how the body turns [rad/s]: about z in the plane, a vector in space";
                Err(Refusal { key: "spin", message, help })
            }
        }
    }
}

/// What is the same for every kind.
pub(crate) struct Common<'a> {
    pub(crate) prefix: &'a str,
    /// v of the centre [m/s].
    pub(crate) velocity: [f64; 3],
    spin: Option<&'a Turning>,
}

macro_rules! kinds {
    ($($kind:ident),*) => {
        impl Body {
            pub(crate) fn common(&self) -> Common<'_> {
                match self {
                    $(Body::$kind(body) => Common {
                        prefix: &body.prefix.0,
                        velocity: body.velocity.as_ref().map_or([0.0; 3], Vector::padded),
                        spin: body.spin.as_ref(),
                    },)*
                }
            }
        }
    };
}

kinds!(Bar, Block, Triangle, Inertia);

fn help(key: &str) -> &'static str {
    match key {
        "to" => "give the bar two different ends",
        "edges" => "a long bar is one edge, a plate two, a block three, none of which follows from the others",
        "corners" => "give the triangle three corners that are not in a line",
        _ => {
            "`inertia` [kg m²] is one moment in the plane; in space xx, yy, zz, or xx, yy, zz, xy, xz, yz of the tensor"
        }
    }
}
