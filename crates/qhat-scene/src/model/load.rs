//! `[[loads]]`: the list of their kinds, for every force that is neither gravity or drag on all particles nor a plain
//! spring. A new kind costs a struct, the function that adds it in a file of `build`, and one line in the list below.

use super::expression::{Force, Potential};
use super::fields::{AirDrag, CentralGravity, Charges, PairwiseGravity};
use super::point::{Actuator, Harmonic, Point};
use super::pressure::Pressure;
use super::springs::{CubicSpring, TorsionSpring};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The kinds of loads: the struct of each, and the function of `build` that adds it. Messages list the kinds in this
/// order. In a scene a kind has the name of its struct in kebab case.
macro_rules! load_kinds {
    ($make:ident) => {
        $make! {
            Point => add_point,
            Harmonic => add_harmonic,
            Actuator => add_actuator,
            CubicSpring => add_cubic_spring,
            TorsionSpring => add_torsion_spring,
            CentralGravity => add_central_gravity,
            PairwiseGravity => add_pairwise_gravity,
            Charges => add_charges,
            AirDrag => add_air_drag,
            Pressure => add_pressure,
            Force => add_expression_force,
            Potential => add_expression_potential,
        }
    };
}
pub(crate) use load_kinds;

macro_rules! load_enum {
    ($($kind:ident => $add:ident,)*) => {
        /// A force.
        #[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        pub(crate) enum Load {
            $($kind($kind),)*
        }
    };
}
load_kinds!(load_enum);
