//! astro-float's numbers of 256 bits as the ports' float type: an index into this thread's list of
//! them, since the type must be Copy. Decisions follow those that module tracked noted.

use std::cell::{Cell, RefCell};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use astro_float::{BigFloat, RoundingMode, Sign};
use dpsm::scalar::float::Float;
use dpsm::scalar::ports::{Flat, Word};

use crate::tracked::{self, Answer};

/// Bits of the significand.
const BITS: usize = 256;
const NEAREST: RoundingMode = RoundingMode::ToEven;

/// A number's place in the list.
#[derive(Clone, Copy, Debug)]
pub struct Wide(usize);

thread_local! {
    static NUMBERS: RefCell<Vec<BigFloat>> = const { RefCell::new(Vec::new()) };
    static DECIDED: Cell<usize> = const { Cell::new(0) };
    static FAULTS: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Forgets all numbers, and begins again with the first decision.
pub fn forget() {
    NUMBERS.with_borrow_mut(Vec::clear);
    DECIDED.set(0);
}

/// Decisions that differ where the bounds do not straddle, taken from the list.
pub fn faults() -> Vec<String> {
    FAULTS.take()
}

/// The answer to go by: that of f64 where it may differ, else this one, which must be the same.
fn decide(own: Answer) -> Answer {
    let index = DECIDED.replace(DECIDED.get() + 1);
    match tracked::decision(index) {
        Some(other) if other.straddles => other.answer,
        Some(other) if other.answer == own => own,
        other => {
            FAULTS.with_borrow_mut(|all| all.push(format!("decision {own:?}, in f64 {other:?}")));
            own
        }
    }
}

fn new(number: BigFloat) -> Wide {
    NUMBERS.with_borrow_mut(|all| {
        all.push(number);
        Wide(all.len() - 1)
    })
}

impl Wide {
    /// A number of f64.
    pub fn exact(value: f64) -> Self {
        new(BigFloat::from_f64(value, BITS))
    }

    /// How far a number of f64 is off, rounded to f64.
    pub fn off(self, value: f64) -> f64 {
        let value = Self::exact(value);
        (self - value).value().abs()
    }

    fn unary(self, of: impl Fn(&BigFloat) -> BigFloat) -> Self {
        let result = NUMBERS.with_borrow(|all| of(&all[self.0]));
        new(result)
    }

    fn binary(self, other: Self, of: impl Fn(&BigFloat, &BigFloat) -> BigFloat) -> Self {
        let result = NUMBERS.with_borrow(|all| of(&all[self.0], &all[other.0]));
        new(result)
    }

    fn order(self, other: Self) -> Option<Ordering> {
        let sign = NUMBERS.with_borrow(|all| all[self.0].cmp(&all[other.0]))?;
        Some(sign.cmp(&0))
    }

    fn whole(self, own: Self) -> Self {
        match decide(Answer::Whole(own.value())) {
            Answer::Whole(value) => Self::exact(value),
            Answer::Order(_) => own,
        }
    }
}

impl PartialEq for Wide {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Wide {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match decide(Answer::Order(self.order(*other))) {
            Answer::Order(order) => order,
            Answer::Whole(_) => None,
        }
    }
}

macro_rules! operator {
    ($($op:ident $function:ident),+) => {
        $(impl $op for Wide {
            type Output = Self;
            fn $function(self, other: Self) -> Self {
                self.binary(other, |a, b| a.$function(b, BITS, NEAREST))
            }
        })+
    };
}
operator!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Wide {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(|a| a.neg())
    }
}

impl Float for Wide {
    fn lit(value: f64) -> Self {
        Self::exact(value)
    }
    /// The number's 64 highest bits, rounded to f64.
    fn value(self) -> f64 {
        NUMBERS.with_borrow(|all| {
            let number = &all[self.0];
            let Some((words, _, sign, exponent, _)) = number.as_raw_parts() else {
                return match () {
                    _ if number.is_inf_pos() => f64::INFINITY,
                    _ if number.is_inf_neg() => f64::NEG_INFINITY,
                    _ => f64::NAN,
                };
            };
            // 0.1... times 2^exponent, the highest word last; in two steps, down to subnormals
            let highest = words.last().map_or(0.0, |&word| word as f64 / 2f64.powi(64));
            let half = exponent / 2;
            let value = highest * 2f64.powi(half) * 2f64.powi(exponent - half);
            if sign == Sign::Neg { -value } else { value }
        })
    }
    fn sqrt(self) -> Self {
        self.unary(|a| a.sqrt(BITS, NEAREST))
    }
    fn abs(self) -> Self {
        self.unary(|a| a.abs())
    }
    fn max(self, other: Self) -> Self {
        if self.order(other) == Some(Ordering::Less) { other } else { self }
    }
    fn min(self, other: Self) -> Self {
        if self.order(other) == Some(Ordering::Greater) { other } else { self }
    }
    fn floor(self) -> Self {
        let own = self.unary(|a| a.floor());
        self.whole(own)
    }
    fn ceil(self) -> Self {
        let own = self.unary(|a| a.ceil());
        self.whole(own)
    }
}

impl Flat<Wide> for Wide {
    fn read(words: &mut dyn Iterator<Item = Word<Wide>>) -> Option<Self> {
        match words.next()? {
            Word::Float(value) => Some(value),
            Word::Integer(_) => None,
        }
    }
    fn write(self, words: &mut Vec<Word<Wide>>) {
        words.push(Word::Float(self));
    }
}
