//! `[[bodies]]`: rigid bodies, each made of a few particles and rods, which the engine's `Body` derives.

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
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The mass of the body [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// The position of one end at the start [m].
    pub(crate) from: Vector,
    /// The position of the other end at the start [m].
    pub(crate) to: Vector,
    /// The velocity of the centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// The angular velocity at the start [rad/s]: one number in the plane, three in space; zero if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// A uniform body that spans one edge (a thin bar), two edges (a plate) or three (a block).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Block {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The mass of the body [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// The position of the centre at the start [m].
    pub(crate) center: Vector,
    /// The edges [m], one to three vectors that do not lie in one line or plane.
    #[schemars(length(min = 1, max = 3))]
    pub(crate) edges: Vec<Vector>,
    /// The velocity of the centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// The angular velocity at the start [rad/s]: one number in the plane, three in space; zero if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// A uniform triangular plate.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Triangle {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The mass of the body [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// The positions of the corners at the start [m].
    pub(crate) corners: [Vector; 3],
    /// The velocity of the centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// The angular velocity at the start [rad/s]: one number in the plane, three in space; zero if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// A body given by the moments of inertia about its centre.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Inertia {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The mass of the body [kg], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// The position of the centre at the start [m].
    pub(crate) center: Vector,
    /// The moments of inertia about the centre [kg m²]: one number in the plane; in space xx, yy, zz, or xx, yy, zz,
    /// xy, xz, yz.
    #[schemars(length(min = 1, max = 6))]
    pub(crate) inertia: Vec<f64>,
    /// The velocity of the centre at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// The angular velocity at the start [rad/s]: one number in the plane, three in space; zero if left out.
    #[serde(default)]
    pub(crate) spin: Option<Turning>,
}

/// An angular velocity.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Turning(#[schemars(length(min = 1, max = 3))] pub(crate) Vec<f64>);

/// The reason why an entry of `bodies` makes no body, and the key that is at fault.
pub(crate) struct Refusal {
    pub(crate) key: &'static str,
    pub(crate) message: String,
    pub(crate) help: &'static str,
}

impl Body {
    /// The particles and rods of the body.
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

    /// ω at the start [rad/s]; (0, 0, ω) in the plane.
    pub(crate) fn spin(&self, dimension: usize) -> Result<[f64; 3], Refusal> {
        match (dimension, self.common().spin.map(|Turning(spin)| spin.as_slice())) {
            (_, None) => Ok([0.0; 3]),
            (2, Some(&[z])) => Ok([0.0, 0.0, z]),
            (3, Some(&[x, y, z])) => Ok([x, y, z]),
            (_, Some(given)) => {
                let wanted = if dimension == 2 { "1 number in the plane" } else { "3 numbers in space" };
                let message = format!("`spin` must have {wanted}, but has {}", given.len());
                let help =
                    "`spin` is the angular velocity of the body [rad/s]: one number in the plane, a vector in space";
                Err(Refusal { key: "spin", message, help })
            }
        }
    }
}

/// The keys that every kind has.
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
        "edges" => "a bar has one edge, a plate two, a block three; they must not lie in one line or plane",
        "corners" => "give the triangle three corners that are not in one line",
        _ => {
            "`inertia` [kg m²] is one moment in the plane; in space xx, yy, zz, or xx, yy, zz, xy, xz, yz of the tensor"
        }
    }
}
