//! A driver that uses the freedoms of WGSL's table of accuracies, at random. Other rewrites by
//! real algebra, which WGSL allows as well, are not among them (docs/numerics.md).

use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use fastrand::Rng;

use crate::scalar::float::Float;
use crate::scalar::ports::{Flat, Port, Word};

/// How a run of a function rounds.
#[derive(Clone, Copy, Debug)]
enum Way {
    Down,
    Up,
    Either,
}

thread_local! {
    static DRIVER: RefCell<(Rng, Way)> = const { RefCell::new((Rng::with_seed(7), Way::Either)) };
}

/// An f32 whose operations round either way, divide within 2.5 ULP, take roots through inverses,
/// sum dot products in any order, and flush subnormal numbers or not.
#[derive(Clone, Copy, Debug)]
pub struct Loose(pub f32);

/// Runs a port as such a driver; each run is its own, chosen by the seed.
pub fn loosely(port: Port<Loose>, record: &[Word<f32>], seed: u64) -> Option<Vec<Word<f32>>> {
    DRIVER.with_borrow_mut(|(rng, way)| {
        *rng = Rng::with_seed(seed);
        *way = [Way::Down, Way::Up, Way::Either, Way::Either][rng.usize(..4)];
    });
    let words: Vec<_> = record
        .iter()
        .map(|word| match *word {
            Word::Float(value) => Word::Float(Loose(value)),
            Word::Integer(value) => Word::Integer(value),
        })
        .collect();
    let mut out = Vec::new();
    port(&words, &mut out)?;
    let back = |word: Word<Loose>| match word {
        Word::Float(value) => Word::Float(value.0),
        Word::Integer(value) => Word::Integer(value),
    };
    Some(out.into_iter().map(back).collect())
}

fn coin() -> bool {
    DRIVER.with_borrow_mut(|(rng, way)| match way {
        Way::Down => false,
        Way::Up => true,
        Way::Either => rng.bool(),
    })
}

fn flushed(x: f32) -> f32 {
    if x.is_subnormal() && DRIVER.with_borrow_mut(|(rng, _)| rng.bool()) { 0.0 } else { x }
}

/// One of the two f32s around a number; `rest` is what the f64 lacks of it.
fn round(x: f64, rest: f64) -> Loose {
    let nearest = x as f32;
    let left = (x - f64::from(nearest)) + rest;
    let rounded = match coin() {
        true if left > 0.0 => nearest.next_up(),
        false if left < 0.0 => nearest.next_down(),
        _ => nearest,
    };
    Loose(flushed(rounded))
}

/// An f32 within so many ULP.
fn within(x: f64, ulps: f64) -> f32 {
    let nearest = x as f32;
    let whole = ulps.floor() as i32;
    let away = DRIVER.with_borrow_mut(|(rng, way)| match way {
        Way::Down => -whole,
        Way::Up => whole,
        Way::Either => rng.i32(-whole..=whole),
    });
    if !nearest.is_finite() || nearest == 0.0 {
        return nearest;
    }
    // away from 0 for a positive number of steps; no farther than the ULP of x itself
    let moved = f32::from_bits(nearest.to_bits().wrapping_add_signed(away));
    let ulp = f64::from((x.abs() as f32).max(f32::MIN_POSITIVE).to_bits() >> 23) - 150.0;
    let fits = (f64::from(moved) - x).abs() <= ulps * ulp.exp2();
    flushed(if fits && moved.is_finite() { moved } else { nearest })
}

impl Add for Loose {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (a, b) = (f64::from(flushed(self.0)), f64::from(flushed(other.0)));
        let sum = a + b;
        let part = sum - a;
        round(sum, (a - (sum - part)) + (b - part))
    }
}

impl Sub for Loose {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Loose {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        round(f64::from(flushed(self.0)) * f64::from(flushed(other.0)), 0.0)
    }
}

impl Div for Loose {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Loose(within(f64::from(flushed(self.0)) / f64::from(flushed(other.0)), 2.5))
    }
}

impl Neg for Loose {
    type Output = Self;
    fn neg(self) -> Self {
        Loose(-self.0)
    }
}

impl PartialEq for Loose {
    fn eq(&self, other: &Self) -> bool {
        flushed(self.0) == flushed(other.0)
    }
}

impl PartialOrd for Loose {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        flushed(self.0).partial_cmp(&flushed(other.0))
    }
}

impl Float for Loose {
    fn lit(value: f64) -> Self {
        Loose(value as f32)
    }
    fn value(self) -> f64 {
        self.0.into()
    }
    fn sqrt(self) -> Self {
        let x = f64::from(flushed(self.0));
        if x == 0.0 || x.is_nan() || x < 0.0 {
            return Loose(x.sqrt() as f32);
        }
        Loose(within(1.0 / f64::from(within(1.0 / x.sqrt(), 2.0)), 2.5))
    }
    fn abs(self) -> Self {
        Loose(self.0.abs())
    }
    fn max(self, other: Self) -> Self {
        Loose(self.0.max(other.0))
    }
    fn min(self, other: Self) -> Self {
        Loose(self.0.min(other.0))
    }
    fn floor(self) -> Self {
        Loose(flushed(self.0).floor())
    }
    fn ceil(self) -> Self {
        Loose(flushed(self.0).ceil())
    }
    fn sum<const N: usize>(mut terms: [Self; N]) -> Self {
        DRIVER.with_borrow_mut(|(rng, _)| rng.shuffle(&mut terms));
        terms.into_iter().reduce(Add::add).unwrap_or(Loose(0.0))
    }
}

impl Flat<Loose> for Loose {
    fn read(words: &mut dyn Iterator<Item = Word<Loose>>) -> Option<Self> {
        match words.next()? {
            Word::Float(value) => Some(value),
            Word::Integer(_) => None,
        }
    }
    fn write(self, words: &mut Vec<Word<Loose>>) {
        words.push(Word::Float(self));
    }
}
