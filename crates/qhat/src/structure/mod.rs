//! Structure: everything that depends on which particles, constraints and forces there are, and not on where they are. It is
//! found once, when a System is built.

pub(crate) mod chains;
mod contacts;
mod matrix;

pub(crate) use chains::ChainPlan;
pub(crate) use contacts::{Contact, Contacts};
pub(crate) use matrix::{MatrixPlan, MatrixStructure};
