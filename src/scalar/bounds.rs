//! The bounds of every function, in one table that tests, `dpsm eval` and docs/accuracy.md read.
//!
//! A bound is in eps = 2^-23 of its unit. The text beside it, with the domain, is the WGSL
//! function's own comment; the derivation is on the module's page. Where no closed form is tight
//! (hulls, lookups, decisions from many steps) the bound is the interval of the port
//! ([`super::interval`]), which the specification's table gives for each input.

mod rows;

use super::ports::{PORTS, Word};

/// 2^-23.
pub const EPS: f64 = f32::EPSILON as f64;

/// What a bound counts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// No error: integers, decisions and copies.
    Exact,
    /// A share of the result's own size.
    Relative,
    /// Units of the result, times a scale that the text names.
    Absolute,
    /// Radians.
    Angle,
    /// The interval of the port, for each input.
    Interval,
}

/// One function's bound.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// The function.
    pub function: &'static str,
    /// Its module, whose page in docs/ has the derivation.
    pub module: &'static str,
    /// What the bound counts in.
    pub unit: Unit,
    /// True where an input's words lie in the domain.
    pub inside: fn(&[f64]) -> bool,
    /// Input, exact result, actual result: the error, beside what is allowed.
    measure: fn(&[f64], &[f64], &[f64]) -> Error,
}

/// An error and its bound, both in eps of the unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Error {
    /// The error.
    pub eps: f64,
    /// The most that is allowed.
    pub bound: f64,
}

impl Error {
    /// The error as a share of the bound; above 1 it is broken.
    pub fn share(self) -> f64 {
        if self.eps == 0.0 { 0.0 } else { self.eps / self.bound }
    }

    /// The one that is closer to its bound.
    fn or(self, other: Self) -> Self {
        // a NaN is above every bound
        if self.share().is_nan() || other.share() <= self.share() { self } else { other }
    }
}

impl Bound {
    /// The bound of a function; `None` for an unknown one, or one that samples textures.
    pub fn of(function: &str) -> Option<&'static Bound> {
        let known = PORTS.iter().any(|(_, name)| *name == function);
        rows::BOUNDS.iter().find(|bound| known && bound.function == function)
    }

    /// The error of a result against the exact one, both with the same decisions; `None` where the
    /// bound is the interval.
    pub fn error(&self, input: &[f64], exact: &[f64], actual: &[f64]) -> Option<Error> {
        (self.unit != Unit::Interval).then(|| (self.measure)(input, exact, actual))
    }
}

/// All bounds, in the ports' order.
pub fn all() -> &'static [Bound] {
    rows::BOUNDS
}

/// A word as a number, whatever its type.
pub fn number<T: super::float::Float>(word: Word<T>) -> f64 {
    match word {
        Word::Float(value) => value.value(),
        Word::Integer(value) => value.into(),
    }
}
