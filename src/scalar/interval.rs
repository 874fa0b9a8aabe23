//! Interval arithmetic that models WGSL's freedoms: what any adapter may answer.
//!
//! An interval holds every f32 that the specification allows an operation to give: sums and
//! products rounded either way (and so fused or not: the exact product lies inside), quotients
//! within 2.5 ULP, roots through their inverse, sums of a dot product in any order, subnormal
//! numbers flushed or kept. Each carries the exact value too, in f64. Where an interval straddles a
//! decision's edge the answer is a choice: [`answers`] runs a port once for each way to decide, so
//! both are accepted there, and only there. Other rewrites by real algebra are not
//! modelled. The rules and their source are in docs/numerics.md.

use std::cell::RefCell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::float::Float;

/// Smallest normal f32, 2^-126.
const SMALLEST: f64 = f32::MIN_POSITIVE as f64;

/// Largest f32.
const LARGEST: f64 = f32::MAX as f64;

/// Divisors of larger magnitude have no specified quotient.
const LARGEST_DIVISOR: f64 = (1u128 << 126) as f64;

/// Ways to decide after which [`answers`] gives up.
pub const MOST_WAYS: usize = 1 << 10;

/// Every f32 that an adapter may give for a value.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    /// The smallest; an f32, or -infinity where anything may come out.
    pub low: f64,
    /// The largest; an f32, or infinity where anything may come out.
    pub high: f64,
    /// The value in f64, decided as the choices say.
    pub value: f64,
    /// Equal in copies of one result, so that its square is told from a product.
    id: u64,
}

/// The decisions of one run of a port: what was chosen, of how many.
#[derive(Default)]
struct Choices {
    made: Vec<(u32, u32)>,
    next: usize,
    ids: u64,
}

thread_local! {
    static CHOICES: RefCell<Choices> = RefCell::default();
}

/// A choice of `ways`; the first of them is the one that the values in f64 make.
fn choose(ways: u32) -> u32 {
    CHOICES.with_borrow_mut(|choices| {
        if choices.next == choices.made.len() {
            choices.made.push((0, ways));
        }
        choices.next += 1;
        choices.made[choices.next - 1].0
    })
}

fn decide(first: bool) -> bool {
    first ^ (choose(2) == 1)
}

/// Runs `port` once for each way to decide what its intervals leave open, the way of the values in
/// f64 first, until `accept` is true of a result: whether it was. `None` after [`MOST_WAYS`].
pub fn answers<R>(port: impl Fn() -> R, mut accept: impl FnMut(R) -> bool) -> Option<bool> {
    CHOICES.with_borrow_mut(|choices| choices.made.clear());
    for _ in 0..MOST_WAYS {
        CHOICES.with_borrow_mut(|choices| choices.next = 0);
        if accept(port()) {
            return Some(true);
        }
        let more = CHOICES.with_borrow_mut(|choices| {
            while choices.made.pop_if(|(made, ways)| *made + 1 == *ways).is_some() {}
            choices.made.last_mut().map(|(made, _)| *made += 1).is_some()
        });
        if !more {
            return Some(false);
        }
    }
    None
}

impl Interval {
    /// What reading this f32 may give: itself, or 0 for a subnormal one, anything for one that is
    /// not finite.
    pub fn exact(value: f32) -> Self {
        Self::hull(value.into(), value.into(), value.into())
    }

    /// True where an adapter may give this f32.
    pub fn holds(self, value: f32) -> bool {
        self.is_anything() || (self.low..=self.high).contains(&f64::from(value))
    }

    /// True where the specification says nothing: overflow, a zero divisor, a negative root.
    pub fn is_anything(self) -> bool {
        self.low == f64::NEG_INFINITY
    }

    /// The f32s around an exact result between two f64s, flushed or not.
    fn hull(low: f64, high: f64, value: f64) -> Self {
        if !(low >= -LARGEST && high <= LARGEST) {
            return Self::anything(value);
        }
        let (mut low, mut high) = (below(low), above(high));
        if low > 0.0 && low < SMALLEST {
            low = 0.0;
        }
        if high < 0.0 && high > -SMALLEST {
            high = 0.0;
        }
        Self { low, high, value, id: id() }
    }

    fn anything(value: f64) -> Self {
        Self { low: f64::NEG_INFINITY, high: f64::INFINITY, value, id: id() }
    }

    /// The smallest interval around both, with the value of this one.
    fn or(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high), ..self }
    }

    fn compare(self, other: Self, holds: impl Fn(Ordering) -> bool) -> bool {
        if self.id == other.id {
            return holds(Ordering::Equal);
        }
        let exact = self.value.partial_cmp(&other.value).is_some_and(&holds);
        if self.is_anything() || other.is_anything() {
            return decide(exact);
        }
        let less = (self.low < other.high, Ordering::Less);
        let equal = (self.low <= other.high && other.low <= self.high, Ordering::Equal);
        let greater = (self.high > other.low, Ordering::Greater);
        let mut possible = [less, equal, greater].into_iter().filter(|(can, _)| *can);
        let first = possible.next().is_some_and(|(_, order)| holds(order));
        match possible.all(|(_, order)| holds(order) == first) {
            true => first,
            false => decide(exact),
        }
    }

    /// A whole number out of those between two; the value's own first.
    fn whole(self, low: f64, high: f64, value: f64) -> Self {
        if self.is_anything() {
            return Self::anything(value);
        }
        let ways = high - low + 1.0;
        if ways > 4.0 {
            return Self { low, high, value, id: id() };
        }
        let first = value.clamp(low, high);
        let turn = f64::from(if ways > 1.0 { choose(ways as u32) } else { 0 });
        let chosen = low + (first - low + turn) % ways;
        Self { low: chosen, high: chosen, value: chosen, id: id() }
    }
}

fn id() -> u64 {
    CHOICES.with_borrow_mut(|choices| {
        choices.ids += 1;
        choices.ids
    })
}

/// The largest f32 that is not above.
fn below(x: f64) -> f64 {
    let nearest = x as f32;
    f64::from(if f64::from(nearest) > x { nearest.next_down() } else { nearest })
}

/// The smallest f32 that is not below.
fn above(x: f64) -> f64 {
    -below(-x)
}

/// One unit in the last place of an f32 of this size.
fn ulp(x: f64) -> f64 {
    let exponent = f64::from_bits(x.abs().max(SMALLEST).to_bits() & (0x7ff << 52));
    exponent * (f64::from(f32::EPSILON))
}

/// The sum in f64, and bounds between which the exact one lies.
fn sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let part = sum - a;
    let rest = (a - (sum - part)) + (b - part);
    [if rest < 0.0 { sum.next_down() } else { sum }, if rest > 0.0 { sum.next_up() } else { sum }]
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let [low, _] = sum(self.low, other.low);
        let [_, high] = sum(self.high, other.high);
        Self::hull(low, high, self.value + other.value)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        if self.id == other.id && !self.is_anything() {
            return Self::exact(0.0);
        }
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;
    // products of two f32s are exact in f64
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        if self.is_anything() || other.is_anything() {
            return Self::anything(value);
        }
        if self.id == other.id {
            let (a, b) = (self.low.abs(), self.high.abs());
            let least = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { a.min(b) };
            return Self::hull(least * least, a.max(b) * a.max(b), value);
        }
        let corners = [self.low, self.high].map(|a| [a * other.low, a * other.high]);
        let [low, high] = ends(corners);
        Self::hull(low, high, value)
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let least = other.low.max(-other.high);
        let most = other.high.max(-other.low);
        let specified = least >= SMALLEST && most <= LARGEST_DIVISOR;
        if self.is_anything() || !specified {
            return Self::anything(value);
        }
        let corners = [self.low, self.high].map(|a| [a / other.low, a / other.high]);
        let [low, high] = ends(corners);
        Self::hull(lower(low, 2.5), upper(high, 2.5), value)
    }
}

/// The largest f32 within so many ULP; the last bits are for the rounding of x itself.
fn upper(x: f64, ulps: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let most = x + ulps * ulp(x) * (1.0 + 1e-8);
    if most > LARGEST { most } else { below(most) }
}

/// The smallest one.
fn lower(x: f64, ulps: f64) -> f64 {
    -upper(-x, ulps)
}

fn ends(corners: [[f64; 2]; 2]) -> [f64; 2] {
    let [[a, b], [c, d]] = corners;
    [a.min(b).min(c).min(d), a.max(b).max(c).max(d)]
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low, value: -self.value, id: id() }
    }
}

impl PartialEq for Interval {
    fn eq(&self, other: &Self) -> bool {
        self.compare(*other, Ordering::is_eq)
    }
}

impl PartialOrd for Interval {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.compare(*other, Ordering::is_lt) {
            true => Some(Ordering::Less),
            false if self.compare(*other, Ordering::is_gt) => Some(Ordering::Greater),
            false => Some(Ordering::Equal),
        }
    }
    fn lt(&self, other: &Self) -> bool {
        self.compare(*other, Ordering::is_lt)
    }
    fn le(&self, other: &Self) -> bool {
        self.compare(*other, Ordering::is_le)
    }
    fn gt(&self, other: &Self) -> bool {
        self.compare(*other, Ordering::is_gt)
    }
    fn ge(&self, other: &Self) -> bool {
        self.compare(*other, Ordering::is_ge)
    }
}

impl Float for Interval {
    fn lit(value: f64) -> Self {
        Self::hull(value, value, value)
    }
    fn value(self) -> f64 {
        self.value
    }
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        if self.low < 0.0 {
            return Self::anything(value);
        }
        if self.high == 0.0 {
            return Self::hull(0.0, 0.0, value);
        }
        // 2 ULP of the inverse root, 2.5 of its inverse
        let low = match self.low == 0.0 {
            true => 0.0,
            false => lower(1.0 / upper(1.0 / self.low.sqrt(), 2.0), 2.5),
        };
        Self::hull(low, upper(1.0 / lower(1.0 / self.high.sqrt(), 2.0), 2.5), value)
    }
    fn abs(self) -> Self {
        let value = self.value.abs();
        match (self.low >= 0.0, self.high <= 0.0) {
            (true, _) => self,
            (_, true) => -self,
            _ if self.is_anything() => Self::anything(value),
            _ => Self { low: 0.0, high: self.high.max(-self.low), value, id: id() },
        }
    }
    fn max(self, other: Self) -> Self {
        -(-self).min(-other)
    }
    fn min(self, other: Self) -> Self {
        let value = self.value.min(other.value);
        if self.is_anything() || other.is_anything() {
            return Self::anything(value);
        }
        match (self.high <= other.low, other.high <= self.low) {
            (true, _) => self,
            (_, true) => other,
            _ => Self {
                low: self.low.min(other.low),
                high: self.high.min(other.high),
                value,
                id: id(),
            },
        }
    }
    fn floor(self) -> Self {
        self.whole(self.low.floor(), self.high.floor(), self.value.floor())
    }
    fn ceil(self) -> Self {
        self.whole(self.low.ceil(), self.high.ceil(), self.value.ceil())
    }
    fn to_integer(self) -> u32 {
        let low = self.low.max(0.0) as u32;
        let high = self.high.max(0.0) as u32;
        let first = (self.value as u32).clamp(low, high);
        let ways = (high - low).saturating_add(1);
        if ways == 1 { low } else { low + (first - low + choose(ways)) % ways }
    }
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        match terms[..] {
            [a, b, c] => (a + b + c).or(b + c + a).or(c + a + b),
            [a, b, c, d] => {
                let pairs = ((a + b) + (c + d)).or((a + c) + (b + d)).or((a + d) + (b + c));
                let last = |a, b, c, d| Self::sum([a, b, c]) + d;
                pairs
                    .or(last(a, b, c, d))
                    .or(last(b, c, d, a))
                    .or(last(c, d, a, b))
                    .or(last(d, a, b, c))
            }
            _ => terms.into_iter().reduce(Add::add).unwrap_or(Self::lit(0.0)),
        }
    }
}
