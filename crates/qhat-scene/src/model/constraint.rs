//! `[[constraints]]`: the list of their kinds. The files beside this one hold the keys of each kind, a family to a
//! file.
//!
//! A new kind costs a struct with its keys and its `named!` in a file of `model`, the function that adds it in a file
//! of `build`, and one line in the list below.

use super::contact::{Ball, Box, HalfSpace, Limits, Rope};
use super::curves::{Circle, Curve, Ellipse, Sphere};
use super::enclosed::{Area, Volume};
use super::expression::Expression;
use super::incidence::{CenterOfMass, Coincidence, Midpoint, Nail, Relation};
use super::lengths::{LengthRatio, Pulley};
use super::lines::{Direction, Line, Plane};
use super::rods::{Distance, Rigid};
use super::value::Name;
use super::wheels::{Angle, Gears, Rack};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The kinds of constraints: the struct of each, and the function of `build` that adds it. Messages list the kinds in
/// this order. In a scene a kind has the name of its struct in kebab case.
macro_rules! constraint_kinds {
    ($make:ident) => {
        $make! {
            Distance => add_distance,
            Nail => add_nail,
            Expression => add_expression,
            Pulley => add_pulley,
            LengthRatio => add_length_ratio,
            Angle => add_angle,
            Gears => add_gears,
            Rack => add_rack,
            Rigid => add_rigid,
            Area => add_area,
            Volume => add_volume,
            Coincidence => add_coincidence,
            Midpoint => add_midpoint,
            CenterOfMass => add_center_of_mass,
            Relation => add_relation,
            Direction => add_direction,
            Line => add_line,
            Plane => add_plane,
            Sphere => add_sphere,
            Circle => add_circle,
            Ellipse => add_ellipse,
            Curve => add_curve,
            Rope => add_rope,
            Limits => add_limits,
            HalfSpace => add_half_space,
            Ball => add_ball,
            Box => add_box,
        }
    };
}
pub(crate) use constraint_kinds;

macro_rules! constraint_enum {
    ($($kind:ident => $add:ident,)*) => {
        /// A constraint, which holds exactly.
        #[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        pub(crate) enum Constraint {
            $($kind($kind),)*
        }

        impl Constraint {
            /// The name that the scene gives the constraint.
            pub(crate) fn id(&self) -> Option<&Name> {
                match self {
                    $(Constraint::$kind(it) => it.id(),)*
                }
            }
        }
    };
}
constraint_kinds!(constraint_enum);

/// The names of a constraint, by which reports and `[expect]` refer to it.
pub(crate) trait Named {
    /// The name that the scene gives the constraint; `None` where `id` is left out.
    fn id(&self) -> Option<&Name>;

    /// The name of a constraint without `id`, made from the ids of its particles.
    fn default_name(&self) -> String;
}

/// Implements [`Named`] for a struct with the key `id`: `named!(Kind, it => default name of it)`.
macro_rules! named {
    ($kind:ident, $it:ident => $default_name:expr) => {
        impl super::constraint::Named for $kind {
            fn id(&self) -> Option<&super::Name> {
                self.id.as_ref()
            }

            fn default_name(&self) -> String {
                let $it = self;
                $default_name
            }
        }
    };
}
pub(crate) use named;
