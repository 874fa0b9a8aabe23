//! f32 as SwiftShader computes it: operations take and give a zero for a subnormal, copies keep it.

use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dpsm::scalar::float::Float;
use dpsm::scalar::ports::{Flat, Word};

thread_local! {
    /// Set where min or max met a NaN, or zeros of either sign: WGSL leaves open which they give.
    pub static OPEN: Cell<bool> = const { Cell::new(false) };
}

/// An f32 whose operations flush.
#[derive(Clone, Copy, Debug)]
pub struct Flushed(pub f32);

fn flush(value: f32) -> f32 {
    if value.is_subnormal() { 0f32.copysign(value) } else { value }
}

impl Flushed {
    fn map(self, operation: impl Fn(f32) -> f32) -> Self {
        Self(flush(operation(flush(self.0))))
    }

    /// The operation, noted where its result is open.
    fn choose(self, other: Self, operation: impl Fn(f32, f32) -> f32) -> Self {
        let [a, b] = [flush(self.0), flush(other.0)];
        if a.is_nan() || b.is_nan() || (a == 0.0 && b == 0.0 && a.to_bits() != b.to_bits()) {
            OPEN.set(true);
        }
        Self(operation(a, b))
    }
}

macro_rules! operators {
    ($($trait:ident $name:ident)+) => {$(
        impl $trait for Flushed {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                self.map(|value| value.$name(flush(other.0)))
            }
        }
    )+};
}
operators! { Add add Sub sub Mul mul Div div }

impl Neg for Flushed {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(f32::neg)
    }
}

impl PartialEq for Flushed {
    fn eq(&self, other: &Self) -> bool {
        flush(self.0) == flush(other.0)
    }
}

impl PartialOrd for Flushed {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        flush(self.0).partial_cmp(&flush(other.0))
    }
}

impl Float for Flushed {
    fn lit(value: f64) -> Self {
        Self(value as f32)
    }
    fn value(self) -> f64 {
        self.0.into()
    }
    fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn max(self, other: Self) -> Self {
        self.choose(other, f32::max)
    }
    fn min(self, other: Self) -> Self {
        self.choose(other, f32::min)
    }
    fn floor(self) -> Self {
        self.map(f32::floor)
    }
    fn ceil(self) -> Self {
        self.map(f32::ceil)
    }
}

impl Flat<Flushed> for Flushed {
    fn read(words: &mut dyn Iterator<Item = Word<Flushed>>) -> Option<Self> {
        match words.next()? {
            Word::Float(value) => Some(value),
            Word::Integer(_) => None,
        }
    }
    fn write(self, words: &mut Vec<Word<Flushed>>) {
        words.push(Word::Float(self));
    }
}
