//! What the functions' results are off by: inputs over a whole domain, each answer judged by the
//! function's bound and by the interval of what WGSL allows.

mod judge;
mod loose;
pub mod random;
mod records;
mod search;

pub use judge::{Judge, Judged, Verdict};
pub use loose::{Loose, loosely};
pub use records::Records;
pub use search::{BINS, CHUNK, Inputs, Stats, bits, judge_all, search, search_loosely};
