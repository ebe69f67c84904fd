//! All tests of the public interface of the engine, in one binary: to link some thirty binaries took most of the time
//! of a test run. `cargo test --package qhat --test all kinds::` runs one file.
//!
//! No test here changes the environment, the working directory or rayon's global pool, so none needs a process of its
//! own. Names that begin with `long_` simulate for seconds of real time; `make check` leaves them to `make test`.

#![allow(non_snake_case, reason = "the letters of the equations keep their case")]

mod api;
mod auto;
mod bind;
mod chains_against_general;
mod columns;
mod contacts;
mod contacts_breaking;
mod contacts_capstan;
mod contacts_friction;
mod contacts_random;
mod contacts_singular;
mod contacts_start;
mod custom;
mod degenerate;
mod docs;
mod edges;
mod equivalence;
mod examples;
mod expression;
mod expression_derivatives;
mod forces;
mod glossary;
mod identities;
mod kinds;
mod layers;
mod levers;
mod limits;
mod method_example;
mod one_step_by_hand;
mod order;
mod reactions;
mod redundant;
mod refused;
mod saved;
mod second_order;
mod serde;
mod share;
mod share_random;
mod signs;
mod size;
mod snapshot;
mod softness;
mod step_size;
mod stiff;
mod systems;
mod tension;
mod threads;
mod unaccounted;
mod verify_body;
mod verify_chain;
mod verify_energy;
mod verify_expression;
mod verify_forces;
mod verify_gears;
mod verify_implicit;
mod verify_orbits;
mod verify_pendulum;
mod verify_rattle;
mod verify_rigid;
mod verify_spring;
