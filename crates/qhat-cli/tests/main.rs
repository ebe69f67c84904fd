//! Tests of the command from outside, in one binary. Each runs the command as a process of its own, in a folder of its
//! own.

mod bench;
mod check;
mod common;
mod events;
mod going_on;
mod parameters;
mod play;
mod reached;
mod refuse;
mod render;
mod run;
mod select;
mod words;
