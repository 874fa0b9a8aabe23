//! Is an answer one that the specification allows, and how close to the bound is it?

use super::loose::Loose;
use crate::reflect::{Component, Kind, Signature};
use crate::scalar::bounds::{Bound, Error, Unit, number};
use crate::scalar::float::Float;
use crate::scalar::interval::{Interval, answers};
use crate::scalar::ports::{self, Port, Word};

/// Room for the longest record, 46 words of `dpsm_triangle_fragment`.
const MOST_WORDS: usize = 64;

/// The error of an answer that is outside altogether.
const BROKEN: Error = Error { eps: f64::INFINITY, bound: 1.0 };

/// What an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the bound of the exact result.
    Within,
    /// Within the bound of what another decision gives, where WGSL leaves the decision open.
    Decision,
    /// WGSL promises nothing here: a division whose divisor may be 0, an overflow.
    Open,
    /// Outside.
    Broken,
}

/// A judged answer.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// What it is.
    pub verdict: Verdict,
    /// Error and bound in eps; where the interval is the bound, the shares of its half-width.
    pub error: Error,
    /// True where every float is the exact result's nearest one.
    pub rounded: bool,
}

/// Judges one function's answers.
#[derive(Clone, Debug)]
pub struct Judge {
    /// The bound.
    pub bound: &'static Bound,
    /// The function's signature.
    pub signature: Signature,
    /// Words of a result.
    outputs: usize,
    /// The port that answers as a driver does that rounds to nearest.
    pub port: Port<f32>,
    /// The port as any driver may run it.
    pub loose: Port<Loose>,
    exact: Port<f64>,
    interval: Port<Interval>,
}

impl Judge {
    /// The judge of a function; `None` for one without a port.
    pub fn of(function: &str) -> Option<Self> {
        let validated = crate::validate(&crate::link::link_function(function).ok()?).ok()?;
        let signature = Signature::of(&validated.module, function).ok()?;
        Some(Self {
            bound: Bound::of(function)?,
            outputs: signature.outputs().len(),
            signature,
            port: ports::find(function)?,
            loose: ports::find(function)?,
            exact: ports::find(function)?,
            interval: ports::find(function)?,
        })
    }

    /// A record from its words' bits; `None` for too few or too many.
    pub fn record(&self, bits: &[u32]) -> Option<Vec<Word<f32>>> {
        let inputs = self.signature.inputs();
        let word = |(component, &bits): (&Component, &u32)| match component.kind {
            Kind::Float => Word::Float(f32::from_bits(bits)),
            _ => Word::Integer(bits),
        };
        (inputs.len() == bits.len()).then(|| inputs.iter().zip(bits).map(word).collect())
    }

    /// True where a record lies in the function's domain. Subnormal numbers never do: they may
    /// count as 0.
    pub fn inside(&self, record: &[Word<f32>]) -> bool {
        let usable = |word: &Word<f32>| match word {
            Word::Float(x) => *x == 0.0 || x.is_normal(),
            Word::Integer(_) => true,
        };
        let mut input = [0.0; MOST_WORDS];
        record.iter().all(usable) && (self.bound.inside)(numbers(record, &mut input))
    }

    /// Judges an answer; `None` for a record outside the domain.
    pub fn judge(&self, record: &[Word<f32>], answer: &[Word<f32>]) -> Option<Judged> {
        if !self.inside(record) {
            return None;
        }
        if answer.len() != self.outputs {
            return Some(Judged { verdict: Verdict::Broken, error: BROKEN, rounded: false });
        }
        let (mut input, mut actual, mut numbers_of_exact) =
            ([0.0; MOST_WORDS], [0.0; MOST_WORDS], [0.0; MOST_WORDS]);
        let input = numbers(record, &mut input);
        let actual = numbers(answer, &mut actual);
        let mut wide = [Word::Integer(0); MOST_WORDS];
        for (wide, word) in wide.iter_mut().zip(record) {
            *wide = map(*word, f64::from);
        }
        let mut exact = Vec::with_capacity(answer.len());
        if (self.exact)(&wide[..record.len()], &mut exact).is_some()
            && self.bound.unit != Unit::Interval
            && same_integers(answer, &exact)
        {
            let exact = numbers(&exact, &mut numbers_of_exact);
            if let Some(error) = self.bound.error(input, exact, actual)
                && error.share() <= 1.0
            {
                let rounded = rounded(actual, exact);
                return Some(Judged { verdict: Verdict::Within, error, rounded });
            }
        }
        Some(self.judge_by_interval(record, answer))
    }

    /// Judges an answer by the bound and by the interval, in which it must lie as well; `None` for
    /// a record outside the domain.
    pub fn judge_strictly(&self, record: &[Word<f32>], answer: &[Word<f32>]) -> Option<Judged> {
        self.inside(record).then(|| self.judge_by_interval(record, answer))
    }

    /// Judges an answer by the interval of the port, and by the bound for each way to decide.
    fn judge_by_interval(&self, record: &[Word<f32>], answer: &[Word<f32>]) -> Judged {
        let (mut input, mut actual) = ([0.0; MOST_WORDS], [0.0; MOST_WORDS]);
        let input = numbers(record, &mut input);
        let actual = numbers(answer, &mut actual);
        let words: Vec<_> = record.iter().map(|word| map(*word, Interval::exact)).collect();
        let mut way = 0;
        let mut judged = Judged { verdict: Verdict::Broken, error: BROKEN, rounded: false };
        if answer.len() != self.outputs {
            return judged;
        }
        let port = || {
            let mut out = Vec::new();
            (self.interval)(&words, &mut out).map(|()| out)
        };
        let found = answers(port, |result| {
            way += 1;
            let Some(result) = result else { return false };
            if !same_integers(answer, &result) || !holds(&result, answer) {
                return false;
            }
            let mut exact = [0.0; MOST_WORDS];
            let exact = numbers(&result, &mut exact);
            let open = |word: &Word<Interval>| matches!(word, Word::Float(x) if x.is_anything());
            let error = self.bound.error(input, exact, actual);
            // a closed bound holds also where intervals have lost the sign of a divisor
            if error.is_none() && result.iter().any(open) {
                judged.verdict = Verdict::Open;
                return true;
            }
            judged.error = error.unwrap_or_else(|| off_middle(&result, actual));
            judged.rounded = rounded(actual, exact);
            let fits = judged.error.share() <= 1.0;
            if fits {
                judged.verdict = if way == 1 { Verdict::Within } else { Verdict::Decision };
            }
            fits
        });
        if found.is_none() && self.bound.unit == Unit::Interval {
            judged.verdict = Verdict::Open; // more ways to decide than were tried
        }
        judged
    }

    /// The largest share of the closed bound that the interval takes, the exact decision assumed;
    /// `None` without a closed bound, or where the interval holds everything.
    pub fn allowed(&self, record: &[Word<f32>]) -> Option<Error> {
        if !self.inside(record) {
            return None;
        }
        let mut input = [0.0; MOST_WORDS];
        let input = numbers(record, &mut input);
        let words: Vec<_> = record.iter().map(|word| map(*word, Interval::exact)).collect();
        let mut worst = None;
        let port = || {
            let mut out = Vec::new();
            (self.interval)(&words, &mut out).map(|()| out)
        };
        answers(port, |result| {
            let Some(result) = result else { return true };
            let end = |pick: fn(Interval) -> f64| -> Vec<f64> {
                result
                    .iter()
                    .map(|word| match word {
                        Word::Float(x) => pick(*x),
                        Word::Integer(x) => f64::from(*x),
                    })
                    .collect()
            };
            let exact = end(|x| x.value);
            let ends = [end(|x| x.low), end(|x| x.high)];
            if ends.iter().flatten().all(|x| x.is_finite()) {
                let errors = ends.map(|end| self.bound.error(input, &exact, &end));
                worst = errors.into_iter().flatten().max_by(|a, b| a.share().total_cmp(&b.share()));
            }
            true
        });
        worst
    }
}

/// The words as numbers.
fn numbers<'a, T: Float>(words: &[Word<T>], room: &'a mut [f64; MOST_WORDS]) -> &'a [f64] {
    for (number_of, word) in room.iter_mut().zip(words) {
        *number_of = number(*word);
    }
    &room[..words.len()]
}

/// True where every float is the nearest one, and integers are the same.
fn rounded(actual: &[f64], exact: &[f64]) -> bool {
    actual.iter().zip(exact).all(|(a, b)| a == b || *a == f64::from(*b as f32))
}

fn map<T>(word: Word<f32>, float: impl Fn(f32) -> T) -> Word<T> {
    match word {
        Word::Float(value) => Word::Float(float(value)),
        Word::Integer(value) => Word::Integer(value),
    }
}

fn same_integers<T>(answer: &[Word<f32>], exact: &[Word<T>]) -> bool {
    answer.iter().zip(exact).all(|pair| match pair {
        (Word::Integer(a), Word::Integer(b)) => a == b,
        _ => true,
    })
}

fn holds(result: &[Word<Interval>], answer: &[Word<f32>]) -> bool {
    result.iter().zip(answer).all(|pair| match pair {
        (Word::Float(interval), Word::Float(value)) => interval.holds(*value),
        _ => true,
    })
}

/// How far from the exact value, as a share of the way to the interval's end.
fn off_middle(result: &[Word<Interval>], actual: &[f64]) -> Error {
    let share = result.iter().zip(actual).map(|(word, &a)| match word {
        Word::Float(x) if a > x.value => (a - x.value) / (x.high - x.value),
        Word::Float(x) if a < x.value => (x.value - a) / (x.value - x.low),
        _ => 0.0,
    });
    Error { eps: share.fold(0.0, f64::max), bound: 1.0 }
}
