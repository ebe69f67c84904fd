//! Structure: properties of a System that follow from its connections and not from positions. They are found once, when
//! the System is built: the pattern of A and its order of elimination, the chains, the contacts. What
//! holds flat cliques is found where a simulation starts.

pub(crate) mod chains;
mod cliques;
mod contacts;
mod hold;
mod matrix;

pub(crate) use chains::ChainPlan;
pub use cliques::FlatClique;
pub(crate) use cliques::{Classes, flat_cliques};
pub(crate) use contacts::{Contact, Contacts};
pub(crate) use hold::{Flat, Hold, hold, relations};
pub(crate) use matrix::{MatrixPlan, MatrixStructure, blocks_at};
