//! What speed and what error each way to shadows has: the figures, and what shows them.
//!
//! [`scene()`] measures one scene, [`costs()`] what cost grows with; [`data`] holds every figure as
//! report.json does. docs/report.md.

mod costs;
pub mod data;
mod gather;
mod machine;
mod pictures;
mod timing;
mod variants;

pub use costs::costs;
pub use gather::{Effort, Job, Part, ReportError, Subject, scene};
pub use machine::{NAGA, WGPU, machine};
pub use timing::timing;

pub mod compare;
pub mod page;
pub mod parameterisations;
pub mod pareto;
pub mod table;
