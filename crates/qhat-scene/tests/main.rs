//! Tests of the reader from outside, in one binary, but `golden.rs`: that one is compiled a second time, for a debug
//! build, and should not take the others with it. Names that begin with `long_` simulate for seconds of real time;
//! `make check` leaves them to `make test`. What the schema allows is held to the reader in the crate
//! `qhat-schema-test`.

mod broken;
mod classic;
mod expectations;
mod hostile;
mod keys;
mod parameters;
mod recipes;
mod shipped;
