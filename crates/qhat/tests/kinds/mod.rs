//! Every kind of constraint: one table of cases, and one file for each question about all kinds.

mod case;
mod cases;
mod closed_forms;
mod differences;
mod expressions;
mod motion;
mod refused;
mod rows;
mod singular;
