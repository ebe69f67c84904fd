//! One binary for all tests of the crate.

mod hostile;
mod parts;
mod planted;
mod seeds;
