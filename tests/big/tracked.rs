//! An f64 that carries a bound of its error, and notes the decisions that are made on it.

use std::cell::RefCell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dpsm::scalar::float::Float;
use dpsm::scalar::ports::{Flat, Word};

/// Half of f64's epsilon: what rounding to nearest adds, relative.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// The smallest subnormal: what it adds near 0.
const UNDERFLOW: f64 = 4.94e-324;

/// A computed value, and how far the exact one may be off.
#[derive(Clone, Copy, Debug)]
pub struct Tracked {
    pub value: f64,
    pub error: f64,
}

/// What was decided on two values or a value's whole part.
#[derive(Clone, Copy, Debug)]
pub struct Decision {
    pub answer: Answer,
    /// True where the bounds allow another answer.
    pub straddles: bool,
}

/// An answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    Order(Option<Ordering>),
    Whole(f64),
}

thread_local! {
    static DECISIONS: RefCell<Vec<Decision>> = const { RefCell::new(Vec::new()) };
}

/// Forgets the decisions noted so far.
pub fn forget() {
    DECISIONS.with_borrow_mut(Vec::clear);
}

/// The decision of this number since then.
pub fn decision(index: usize) -> Option<Decision> {
    DECISIONS.with_borrow(|all| all.get(index).copied())
}

/// How many of the decisions could have gone otherwise.
pub fn straddles() -> usize {
    DECISIONS.with_borrow(|all| all.iter().filter(|decision| decision.straddles).count())
}

fn note(answer: Answer, straddles: bool) {
    DECISIONS.with_borrow_mut(|all| all.push(Decision { answer, straddles }));
}

impl Tracked {
    /// An input.
    pub fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// The result of an operation whose operands' errors make so much.
    fn rounded(value: f64, error: f64) -> Self {
        match value.is_finite() {
            true => Self { value, error: error + value.abs() * ROUNDING },
            false => Self::exact(value),
        }
    }

    /// True where the exact values may be the other way round.
    fn near(self, other: Self) -> bool {
        let errors = self.error + other.error;
        errors > 0.0 && (self.value - other.value).abs() <= errors
    }

    fn either(self, other: Self, value: f64) -> Self {
        let error = match () {
            _ if self.near(other) => self.error.max(other.error),
            _ if value == self.value => self.error,
            _ => other.error,
        };
        Self { value, error }
    }

    fn whole(self, of: impl Fn(f64) -> f64) -> Self {
        let value = of(self.value);
        note(Answer::Whole(value), of(self.value - self.error) != of(self.value + self.error));
        Self::exact(value)
    }
}

impl PartialEq for Tracked {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Tracked {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let order = self.value.partial_cmp(&other.value);
        note(Answer::Order(order), self.near(*other));
        order
    }
}

impl Add for Tracked {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error)
    }
}

impl Sub for Tracked {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Tracked {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value.abs(), other.value.abs());
        let error = a * other.error + b * self.error + self.error * other.error;
        let product = self.value * other.value;
        // exactly 0 times anything is exactly 0
        let exact =
            product == 0.0 && (a == 0.0 && self.error == 0.0 || b == 0.0 && other.error == 0.0);
        Self::rounded(product, if exact { 0.0 } else { error + UNDERFLOW })
    }
}

impl Div for Tracked {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        let least = other.value.abs() - other.error;
        let error = match () {
            _ if self.value == 0.0 && self.error == 0.0 => 0.0,
            _ if least <= 0.0 => f64::INFINITY,
            _ => (self.error + quotient.abs() * other.error) / least + UNDERFLOW,
        };
        Self::rounded(quotient, error)
    }
}

impl Neg for Tracked {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Float for Tracked {
    fn lit(value: f64) -> Self {
        Self::exact(value)
    }
    fn value(self) -> f64 {
        self.value
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let error = match self.value > self.error {
            true => self.error / (root + (self.value - self.error).sqrt()),
            false => self.error.sqrt(),
        };
        Self::rounded(root, error)
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), ..self }
    }
    fn max(self, other: Self) -> Self {
        self.either(other, self.value.max(other.value))
    }
    fn min(self, other: Self) -> Self {
        self.either(other, self.value.min(other.value))
    }
    fn floor(self) -> Self {
        self.whole(f64::floor)
    }
    fn ceil(self) -> Self {
        self.whole(f64::ceil)
    }
}

impl Flat<Tracked> for Tracked {
    fn read(words: &mut dyn Iterator<Item = Word<Tracked>>) -> Option<Self> {
        match words.next()? {
            Word::Float(value) => Some(value),
            Word::Integer(_) => None,
        }
    }
    fn write(self, words: &mut Vec<Word<Tracked>>) {
        words.push(Word::Float(self));
    }
}
