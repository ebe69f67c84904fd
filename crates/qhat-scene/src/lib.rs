//! Scene files of [`qhat`]: TOML for people, JSON for programs, one model for both.
//!
//! [`load`] turns a text into a [`Scene`], ready to simulate, or into [`SceneErrors`], each with its line and column,
//! the mistake, and what to write instead. This crate reads no files, and a scene cannot name one.
//!
//! ```
//! let text = r#"
//! schema = "qhat/1"
//! name = "Pendulum"
//! dimension = 2
//!
//! [forces]
//! gravity = [0.0, -9.81]
//!
//! [[particles]]
//! id = "pivot"
//! at = [0.0, 0.0]
//! fixed = true
//!
//! [[particles]]
//! id = "bob"
//! at = [1.0, 0.0]
//!
//! [[constraints]]
//! kind = "distance"
//! between = ["pivot", "bob"]
//! "#;
//! let mut simulation = qhat_scene::load(text, "pendulum.toml", qhat_scene::Format::Toml)?.simulation()?;
//! simulation.step()?;
//!
//! let text = text.replace("at =", "ta =");
//! let error = qhat_scene::load(&text, "pendulum.toml", qhat_scene::Format::Toml).unwrap_err();
//! assert_eq!(error.errors[1].message, "unknown key `ta` in this entry of `particles`");
//! assert_eq!((error.errors[1].line, error.errors[1].column), (11, 1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Data flows one way: text → `tree` (values with their places in the text) → `check` (against the schema) → `model`
//! (the scene as Rust types) → `build` (the engine's `System` and `State`). The types of `model` are the only list of
//! keys: [`json_schema`] is made from them, and `check` follows that schema.

// Doc comments of the model are the texts of the schema too, where a backslash before [m] would be shown.
#![allow(rustdoc::broken_intra_doc_links, reason = "units in brackets are taken for links")]

mod build;
mod check;
mod error;
mod load;
mod model;
mod parameters;
mod report;
mod scene;
mod schema;
mod shipped;
mod suggest;
mod tree;

pub use error::{SceneError, SceneErrors};
pub use load::{Format, from_utf16, load, load_bytes, load_bytes_with, load_with};
pub use model::{AtEnd, Axis, Expect, Motion, Period, SpeedAtEnd, Tension};
pub use report::fitted;
pub use scene::{Scene, SceneBody};
pub use schema::json_schema;
pub use shipped::{Shipped, shipped};
