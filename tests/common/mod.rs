//! What the numeric tests share: inputs over a function's domain, and bounds in eps.
#![allow(dead_code)] // each test file uses its part

pub mod exact;
pub mod planes;
#[path = "../../src/accuracy/random.rs"]
mod random;

pub use random::*;

use dpsm::scalar::float::Vec3;

/// eps = 2^-23 of docs/numerics.md, the error of one WGSL operation.
pub const EPS: f64 = 1.0 / (1u64 << 23) as f64;

/// The same for f64.
pub const EPS_DOUBLE: f64 = f64::EPSILON;

/// Cases that each numeric check runs.
pub const CASES: usize = 200_000;

/// Angle in radians between two directions, accurate also where it is small.
pub fn angle(a: Vec3<f64>, b: Vec3<f64>) -> f64 {
    cross(a, b).length().atan2(a.dot(b))
}

/// The largest ratio of error to bound, with its input: a check that says how close it came.
#[derive(Debug, Default)]
pub struct Worst {
    ratio: f64,
    input: String,
}

impl Worst {
    /// Notes one error beside its bound.
    pub fn note(&mut self, error: f64, bound: f64, input: impl std::fmt::Debug) {
        let ratio = if error.is_nan() { f64::INFINITY } else { error / bound };
        if error != 0.0 && ratio > self.ratio {
            *self = Self { ratio, input: format!("{input:?}: error {error:e}, bound {bound:e}") };
        }
    }

    /// Fails where an error was above its bound.
    pub fn check(self, name: &str) {
        println!("{name}: at most {:.3} of the bound, at {}", self.ratio, self.input);
        assert!(self.ratio <= 1.0, "{name}: {:.3} of the bound at {}", self.ratio, self.input);
    }
}

/// The adapter, or `None` with a printed line; an error where one is required.
#[cfg(feature = "gpu")]
pub fn device() -> Option<dpsm::gpu::Device> {
    match dpsm::gpu::Device::open() {
        Ok(device) => {
            println!("adapter: {}", device.describe());
            Some(device)
        }
        Err(error) if std::env::var_os("DPSM_REQUIRE_ADAPTER").is_none() => {
            println!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}
