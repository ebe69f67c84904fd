//! What qhat costs beside what it gets wrong: speed without its error is no result.
//!
//! A [`Workload`] is particles and rods in neutral form, from which both qhat's `System` and the one file that every
//! other engine reads are made. [`run()`] simulates one under a [`Setting`]; [`Errors`] measures a motion, whoever
//! computed it.

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
pub use run::{Outcome, best, quickest, run};
pub use series::Series;
pub use setting::{SETTINGS, Setting, UnknownSetting, settings};
pub use table::Row;
pub use workload::Workload;
