//! What speed and what error each way to shadows has: the figures, and what shows them.
//!
//! [`scene()`] measures one scene and [`costs()`] what cost grows with. [`data`] holds every figure
//! as report.json does. [`page`] makes one HTML file of it, [`table`] one CSV table, and
//! [`mod@compare`] says what changed between two reports; docs/report.md.

pub mod compare;
mod costs;
pub mod data;
mod gather;
mod html;
mod machine;
mod noise;
pub mod page;
pub mod parameterisations;
pub mod pareto;
mod pictures;
pub mod plot;
pub mod table;
mod timing;
mod variants;

pub use costs::costs;
pub use gather::{Effort, Job, Part, ReportError, Subject, scene};
pub use machine::{NAGA, WGPU, machine};
pub use timing::timing;
