//! Arithmetic that fuses products into sums.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dpsm::scalar::float::Float;

/// f32 as a compiler may contract it: a sum with a product in it is one fused multiply-add, of the
/// left product where both sides are one and LEFT is set, else of the right.
#[derive(Clone, Copy, Debug)]
pub struct Fused<const LEFT: bool> {
    value: f32,
    factors: Option<[f32; 2]>,
}

impl<const LEFT: bool> Fused<LEFT> {
    fn of(value: f32) -> Self {
        Self { value, factors: None }
    }
}

impl<const LEFT: bool> PartialEq for Fused<LEFT> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<const LEFT: bool> PartialOrd for Fused<LEFT> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<const LEFT: bool> Add for Fused<LEFT> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::of(match (self.factors, other.factors) {
            (Some([a, b]), None) => a.mul_add(b, other.value),
            (Some([a, b]), Some(_)) if LEFT => a.mul_add(b, other.value),
            (_, Some([a, b])) => a.mul_add(b, self.value),
            (None, None) => self.value + other.value,
        })
    }
}

impl<const LEFT: bool> Neg for Fused<LEFT> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, factors: self.factors.map(|[a, b]| [-a, b]) }
    }
}

impl<const LEFT: bool> Sub for Fused<LEFT> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const LEFT: bool> Mul for Fused<LEFT> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, factors: Some([self.value, other.value]) }
    }
}

impl<const LEFT: bool> Div for Fused<LEFT> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::of(self.value / other.value)
    }
}

impl<const LEFT: bool> Float for Fused<LEFT> {
    fn lit(value: f64) -> Self {
        Self::of(value as f32)
    }
    fn value(self) -> f64 {
        self.value.into()
    }
    fn sqrt(self) -> Self {
        Self::of(self.value.sqrt())
    }
    fn abs(self) -> Self {
        Self::of(self.value.abs())
    }
    fn max(self, other: Self) -> Self {
        Self::of(self.value.max(other.value))
    }
    fn min(self, other: Self) -> Self {
        Self::of(self.value.min(other.value))
    }
    fn floor(self) -> Self {
        Self::of(self.value.floor())
    }
    fn ceil(self) -> Self {
        Self::of(self.value.ceil())
    }
}
