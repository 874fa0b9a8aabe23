//! Inputs over a domain, in numbers: random, spaced evenly over the floats' bits, and at edges.

use fastrand::Rng;
use rayon::prelude::*;

use super::judge::{Judge, Judged, Verdict};
use super::loose::loosely;
use super::records::Records;
use crate::cases;
use crate::reflect::{Component, Kind};
use crate::scalar::bounds::{Error, Unit};
use crate::scalar::ports::Word;
use crate::ulp::ulps_apart;

/// Inputs that are judged at once.
pub const CHUNK: usize = 1 << 12;

/// One in so many results must lie in the interval too, where a closed bound is checked for all;
/// of results that are the port's own, it is the share that the interval judges at all.
const SAMPLE: usize = 16;

/// Bins of the histogram of shares of the bound, the last for what is above it.
pub const BINS: usize = 21;

/// What a search found out about one function on one implementation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stats {
    /// Inputs of the domain that were judged.
    pub points: u64,
    /// Answers by another decision that WGSL leaves open.
    pub decisions: u64,
    /// Inputs for which WGSL promises nothing.
    pub open: u64,
    /// Answers outside the bound.
    pub broken: u64,
    /// Answers that are the exact result's nearest floats.
    pub rounded: u64,
    /// The error closest to its bound.
    pub worst: Error,
    /// Its input's bits; empty where nothing is off.
    pub input: Vec<u32>,
    /// The first input outside the bound.
    pub broken_input: Vec<u32>,
    /// Inputs of the domain whose answers were compared with the f32 port's.
    pub compared: u64,
    /// Answers with other bits than the f32 port's.
    pub differ: u64,
    /// The same for inputs outside the domain, which count nowhere else.
    pub differ_outside: u64,
    /// The most floats that they are apart.
    pub apart: u32,
    /// The first input of theirs.
    pub differ_input: Vec<u32>,
    /// Sum of the shares of the bound.
    pub sum: f64,
    /// Answers by the share of their bound, in twentieths, and above.
    pub histogram: [u64; BINS],
}

impl Stats {
    fn note(&mut self, record: &[Word<f32>], judged: Option<Judged>) {
        let Some(judged) = judged else { return };
        self.points += 1;
        let share = judged.error.share();
        match judged.verdict {
            Verdict::Within => {}
            Verdict::Decision => self.decisions += 1,
            Verdict::Open => {
                self.open += 1;
                return;
            }
            Verdict::Broken => {
                self.broken += 1;
                if self.broken_input.is_empty() {
                    self.broken_input = record.iter().map(|word| bits(*word)).collect();
                }
            }
        }
        self.rounded += u64::from(judged.rounded);
        self.sum += share;
        let bin = (share * (BINS - 1) as f64) as usize;
        let broken = judged.verdict == Verdict::Broken || share.is_nan();
        self.histogram[if broken { BINS - 1 } else { bin.min(BINS - 2) }] += 1;
        if share > self.worst.share() || share.is_nan() {
            self.worst = judged.error;
            self.input = record.iter().map(|word| bits(*word)).collect();
        }
    }

    /// Both together.
    pub fn and(mut self, other: Self) -> Self {
        self.points += other.points;
        self.decisions += other.decisions;
        self.open += other.open;
        self.broken += other.broken;
        self.rounded += other.rounded;
        self.compared += other.compared;
        self.differ += other.differ;
        self.differ_outside += other.differ_outside;
        self.apart = self.apart.max(other.apart);
        if self.differ_input.is_empty() {
            self.differ_input = other.differ_input;
        }
        self.sum += other.sum;
        for (bin, more) in self.histogram.iter_mut().zip(other.histogram) {
            *bin += more;
        }
        if other.worst.share() > self.worst.share() {
            (self.worst, self.input) = (other.worst, other.input);
        }
        if self.broken_input.is_empty() {
            self.broken_input = other.broken_input;
        }
        self
    }

    /// Counts an answer, so many floats from the port's.
    fn compare(&mut self, record: &[Word<f32>], inside: bool, apart: u32) {
        self.compared += u64::from(inside);
        if apart > 0 && !inside {
            self.differ_outside += 1;
        } else if apart > 0 {
            self.differ += 1;
            self.apart = self.apart.max(apart);
            if self.differ_input.is_empty() {
                self.differ_input = record.iter().map(|word| bits(*word)).collect();
            }
        }
    }

    /// The mean share of the bound.
    pub fn mean(&self) -> f64 {
        self.sum / self.histogram.iter().sum::<u64>().max(1) as f64
    }

    /// The share of the bound that 99% of the answers stay below, to the next twentieth.
    pub fn percentile(&self) -> f64 {
        let all: u64 = self.histogram.iter().sum();
        let mut left = all / 100;
        for (bin, count) in self.histogram.iter().enumerate().rev() {
            if *count > left {
                return (bin + 1) as f64 / (BINS - 1) as f64;
            }
            left -= count;
        }
        0.0
    }
}

/// The inputs of a search, the same in every run: each is made from its number alone.
#[derive(Debug)]
pub struct Inputs {
    records: Records,
    cases: Vec<Vec<Word<f32>>>,
}

impl Inputs {
    /// Inputs of the judge's function.
    pub fn of(judge: &Judge) -> Self {
        let cases = cases::of(&judge.signature.name).into_iter().map(|case| case.words).collect();
        Self { records: Records::of(&judge.signature), cases }
    }

    /// The inputs of a chunk, of which [`CHUNK`] are judged at once; some lie outside the domain.
    pub fn chunk(&self, index: u64) -> Vec<Vec<Word<f32>>> {
        let mut rng = Rng::with_seed(index.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 7);
        let first = index.wrapping_mul(CHUNK as u64);
        let one = |place: usize| self.one(first.wrapping_add(place as u64), &mut rng);
        (0..CHUNK).map(one).collect()
    }

    /// The inputs of several chunks.
    pub fn chunks(&self, indices: std::ops::Range<u64>) -> Vec<Vec<Word<f32>>> {
        indices.into_par_iter().flat_map_iter(|index| self.chunk(index)).collect()
    }

    /// One input: as the function is used, and every other time with some of its words replaced by
    /// any bits, by bits that step evenly through all floats, or by values at edges.
    fn one(&self, number: u64, rng: &mut Rng) -> Vec<Word<f32>> {
        let mut words = match rng.u8(0..16) {
            0 if !self.cases.is_empty() => self.cases[rng.usize(..self.cases.len())].clone(),
            kind => self.records.record(kind == 1, rng),
        };
        if rng.bool() {
            return words;
        }
        for _ in 0..rng.usize(1..=3) {
            let at = rng.usize(..words.len());
            let other = words[rng.usize(..words.len())];
            let Word::Float(old) = words[at] else {
                // of every length, and at the ends
                let bits = rng.u32(..) >> rng.u32(0..32);
                words[at] = Word::Integer(if rng.bool() { bits } else { u32::MAX - bits });
                continue;
            };
            let new = match rng.u8(0..4) {
                0 => f32::from_bits(rng.u32(..)),
                // a step that is odd meets every pattern of bits
                1 => f32::from_bits((number as u32).wrapping_mul(0x9e37_79b1)),
                2 => edge(rng),
                _ => {
                    let from = if let Word::Float(other) = other { other } else { old };
                    let away = rng.i32(-4..=4);
                    f32::from_bits(from.to_bits().wrapping_add_signed(away))
                }
            };
            // NaN and infinities are hard cases of their own
            let new = if new.is_finite() { new } else { old };
            // most domains end at a sign
            words[at] = Word::Float(if rng.bool() { new.abs() } else { new });
        }
        words
    }
}

/// A value at which formulas change: a power of two or its neighbours, 0, a subnormal number.
fn edge(rng: &mut Rng) -> f32 {
    let sign = if rng.bool() { 1.0 } else { -1.0 };
    let power = f64::from(rng.i32(-127..=127)).exp2() as f32;
    sign * match rng.u8(0..8) {
        0 => 0.0,
        1 => f32::from_bits(rng.u32(1..1 << 23)),
        2 => 1.0,
        3 => power.next_down(),
        4 => power.next_up(),
        5 => 1.0_f32.next_down(),
        _ => power,
    }
}

/// Searches the port's errors, as [`search_by`] does.
pub fn search(judge: &Judge, points: u64, progress: impl Fn(u64) + Sync) -> Stats {
    let port = |record: &[Word<f32>], _| {
        let mut answer = Vec::with_capacity(8);
        (judge.port)(record, &mut answer).map(|()| answer)
    };
    search_by(judge, points, port, progress)
}

/// Searches the errors of any driver that follows WGSL's rules, as [`search_by`] does.
pub fn search_loosely(judge: &Judge, points: u64, progress: impl Fn(u64) + Sync) -> Stats {
    search_by(judge, points, |record, seed| loosely(judge.loose, record, seed), progress)
}

/// Searches errors over at least `points` inputs of the domain, or until as many
/// thirty-two times were tried; `answer` gets a record and its number, `progress` is told how many
/// more there are now and then.
fn search_by(
    judge: &Judge,
    points: u64,
    answer: impl Fn(&[Word<f32>], u64) -> Option<Vec<Word<f32>>> + Sync,
    progress: impl Fn(u64) + Sync,
) -> Stats {
    let inputs = Inputs::of(judge);
    let of_chunk = |chunk: u64| {
        let mut stats = Stats::default();
        for (place, record) in inputs.chunk(chunk).iter().enumerate() {
            let number = chunk.wrapping_mul(CHUNK as u64).wrapping_add(place as u64);
            let Some(answer) = answer(record, number) else { continue };
            let judged = match place % SAMPLE {
                0 => judge.judge_strictly(record, &answer),
                _ => judge.judge(record, &answer),
            };
            stats.note(record, judged);
        }
        progress(stats.points);
        stats
    };
    let mut stats = Stats::default();
    let most = points.saturating_mul(32).div_ceil(CHUNK as u64);
    let mut first = 0;
    // in rounds, so that the same chunks are judged in every run
    while stats.points < points && first < most {
        let round = (points - stats.points).div_ceil(CHUNK as u64).min(1024);
        let found = (first..first + round).into_par_iter().map(of_chunk);
        stats = stats.and(found.reduce(Stats::default, Stats::and));
        first += round;
    }
    stats
}

/// Judges an implementation's answers to records, given as flat words, and counts those that are
/// not the port's; records outside the domain are compared with the port alone.
pub fn judge_all(judge: &Judge, records: &[Vec<Word<f32>>], answers: &[u32]) -> Stats {
    let outputs = judge.signature.outputs();
    let size = outputs.len().max(1);
    let judged = records.par_chunks(CHUNK).zip(answers.par_chunks(CHUNK * size));
    judged
        .map(|(records, answers)| {
            let mut stats = Stats::default();
            let mut port = Vec::new();
            for (place, (record, answer)) in records.iter().zip(answers.chunks(size)).enumerate() {
                let word = |(component, &bits): (&Component, &u32)| match component.kind {
                    Kind::Float => Word::Float(f32::from_bits(bits)),
                    _ => Word::Integer(bits),
                };
                let answer: Vec<_> = outputs.iter().zip(answer).map(word).collect();
                port.clear();
                let ran = (judge.port)(record, &mut port).is_some();
                let inside = judge.inside(record);
                let apart = if ran { apart(&answer, &port) } else { 0 };
                stats.compare(record, inside, apart);
                // rounding to nearest lies in every interval (tests/interval.rs): a sample is enough
                let skipped = judge.bound.unit == Unit::Interval && apart == 0;
                if inside && place % SAMPLE == 0 {
                    stats.note(record, judge.judge_strictly(record, &answer));
                } else if inside && !skipped {
                    stats.note(record, judge.judge(record, &answer));
                }
            }
            stats
        })
        .reduce(Stats::default, Stats::and)
}

/// The most floats that two results are apart in a word.
fn apart(answer: &[Word<f32>], port: &[Word<f32>]) -> u32 {
    let words = answer.iter().zip(port).map(|(a, b)| match (*a, *b) {
        // the sign of zero may be ignored
        (Word::Float(a), Word::Float(b)) if a == b => 0,
        (Word::Float(a), Word::Float(b)) if a.is_nan() && b.is_nan() => 0,
        (Word::Float(a), Word::Float(b)) => ulps_apart(a, b).max(1),
        (a, b) => bits(a).abs_diff(bits(b)),
    });
    words.max().unwrap_or_default()
}

/// A word's bits.
pub fn bits(word: Word<f32>) -> u32 {
    match word {
        Word::Float(value) => value.to_bits(),
        Word::Integer(value) => value,
    }
}
