//! Ways of running the modules' functions, each an opinion of its own on their results.

mod adapter;
mod dawn;
mod native;

/// One way of running the modules.
pub trait Implementation {
    /// Name with version: adapter and driver, or compiler.
    fn name(&self) -> String;

    /// Result words of a function for records given as flat words, as `Evaluator::run` takes and
    /// gives them: record after record, f32 as bits, bool as 0 or 1. `Ok(None)` where this
    /// implementation cannot run that function, for a reason that is known.
    fn evaluate(&mut self, function: &str, words: &[u32]) -> Result<Option<Vec<u32>>, String>;
}

/// Every implementation that is present here; prints a line for each that is missing, and why.
pub fn all() -> Vec<Box<dyn Implementation>> {
    let mut all: Vec<Box<dyn Implementation>> = Vec::new();
    for adapter in adapter::all() {
        all.push(Box::new(adapter));
    }
    match dawn::open() {
        Ok(dawn) => all.push(Box::new(dawn)),
        Err(reason) => println!("missing: Dawn with Tint: {reason}"),
    }
    all.push(Box::new(Native));
    all
}

/// The modules as Rust.
struct Native;

impl Implementation for Native {
    fn name(&self) -> String {
        "native Rust (naga-rust-embed 0.3.1)".into()
    }

    fn evaluate(&mut self, function: &str, words: &[u32]) -> Result<Option<Vec<u32>>, String> {
        Ok(native::call(function, words))
    }
}
