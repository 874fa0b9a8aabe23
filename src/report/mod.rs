//! What speed and what error each way to shadows has: the figures, and what shows them.
//!
//! [`data`] holds every figure as report.json does. [`page`] makes one HTML file of it, [`table`]
//! one CSV table, and [`compare`] says what changed between two reports; docs/report.md.

pub mod compare;
pub mod data;
mod html;
mod noise;
pub mod page;
pub mod parameterisations;
pub mod pareto;
pub mod plot;
pub mod table;
