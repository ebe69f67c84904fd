//! Benchmarks of qhat: the time of a simulation together with its errors, because a time alone says nothing.
//!
//! A [`Workload`] has particles and rods in a form that belongs to no engine. qhat's `System` is made from it, and so
//! is the file that the other engines read. [`run()`] simulates a workload under a [`Setting`]. [`Errors`] measures the
//! errors of a motion, computed by qhat or by another engine.

pub mod kernels;
pub mod scenes;
pub mod shapes;
pub mod trajectory;

mod errors;
mod names;
mod run;
mod series;
mod setting;
mod table;
mod workload;

pub use errors::Errors;
pub use names::{NAMES, UnknownWorkload};
pub use run::{Outcome, RunError, best, quickest, run};
pub use series::Series;
pub use setting::{SETTINGS, Setting, UnknownSetting, settings};
pub use table::Row;
pub use workload::Workload;
