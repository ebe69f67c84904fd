//! Tests of the public interface of the reader, in one binary. `golden.rs` has a binary of its own, because it is
//! compiled a second time, for a debug build. Names that begin with `long_` simulate for seconds of real time; `make
//! check` leaves them to `make test`. The crate `qhat-schema-test` compares the schema with the reader.

mod bind;
mod broken;
mod classic;
mod encodings;
mod expectations;
mod hostile;
mod keys;
mod parameters;
mod recipes;
mod rigid;
mod shipped;
