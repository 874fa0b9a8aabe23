//! The texels of one part of the maps, and what is wrong with them.

use rayon::prelude::*;
use serde::Serialize;

use super::Bench;
use super::map::Texel;
use super::silhouette::{JUMP, Marks, Search};

/// A texel off by more than this, of the distance, needs an excuse.
const WRONG: f64 = 1e-3;

/// Slightly wrong texels that are asked about at once, at first: each walk along all edges is worth
/// some thousand texels' rays.
const ASKED_AT_ONCE: usize = 1024;

/// Texels of one part of the maps, and what is wrong with them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Band {
    /// Texels whose centre lies in the band.
    pub texels: usize,
    /// Of those, texels where a surface is hit and one is stored.
    pub covered: usize,
    /// Texels where a surface is hit and none is stored.
    pub missing: usize,
    /// Texels where none is hit and one is stored.
    pub extra: usize,
    /// Covered texels off by more than 1% of the distance.
    pub off_1e2: usize,
    /// Covered texels off by more than 0.1% of the distance.
    pub off_1e3: usize,
    /// Largest relative error of the covered texels.
    pub largest: f64,
    /// 99th percentile of the covered texels' relative error.
    pub percentile_99: f64,
    /// Texels off by more than 0.1%, missing or extra, that a silhouette passes within tau.
    pub excused: usize,
    /// Covered texels off by more than 0.1% that none passes.
    pub faults_off: usize,
    /// Missing texels that none passes.
    pub holes: usize,
    /// Extra texels that none passes.
    pub faults_extra: usize,
    /// Largest relative error of the covered texels that none passes.
    pub largest_rest: f64,
}

impl Band {
    /// Wrong texels that no silhouette explains; the goal is none.
    pub fn faults(&self) -> usize {
        self.faults_off + self.holes + self.faults_extra
    }
}

/// A texel by its index in the maps, and its relative error.
#[derive(Clone, Copy)]
pub struct Off {
    pub error: f64,
    pub index: usize,
}

/// A band while it is being filled.
#[derive(Default)]
pub struct Part {
    band: Band,
    /// Of the covered texels.
    errors: Vec<f64>,
    /// Texels that need an excuse.
    wrong: Vec<Off>,
    /// Other texels off by more than a silhouette's smallest jump.
    slight: Vec<Off>,
    /// The one with the largest error of all others.
    calm: Option<Off>,
}

impl Part {
    /// Adds a texel.
    pub fn add(&mut self, bench: &Bench<'_>, texel: &Texel) {
        let off = Off { error: texel.error(), index: texel.index };
        self.band.texels += 1;
        match (texel.stored, texel.hit) {
            (Some(_), Some(_)) => self.errors.push(off.error),
            (None, Some(_)) => self.band.missing += 1,
            (Some(_), None) => self.band.extra += 1,
            (None, None) => return,
        }
        // what a step of the format alone makes of the distance needs no ray
        let step = |hit: f64| {
            let quantum = f64::from(bench.frame.settings.format.quantum());
            let stored = bench.maps.depth(texel.index).into();
            bench.spread(stored, quantum, texel.uv) / hit
        };
        if off.error > WRONG {
            self.wrong.push(off);
        } else if off.error > JUMP + texel.hit.map_or(0.0, step) {
            self.slight.push(off);
        } else {
            self.calm = larger(self.calm, Some(off));
        }
    }

    /// Adds all of another part.
    pub fn join(&mut self, mut other: Self) {
        let (band, added) = (&mut self.band, other.band);
        band.texels += added.texels;
        band.missing += added.missing;
        band.extra += added.extra;
        band.excused += added.excused;
        band.faults_off += added.faults_off;
        band.holes += added.holes;
        band.faults_extra += added.faults_extra;
        band.largest_rest = band.largest_rest.max(added.largest_rest);
        self.errors.append(&mut other.errors);
        self.wrong.append(&mut other.wrong);
        self.slight.append(&mut other.slight);
        self.calm = larger(self.calm, other.calm);
    }

    /// Asks about the texels that need an excuse, and the first of the others.
    pub fn ask(&mut self, marks: &Marks) {
        self.slight.par_sort_unstable_by(|a, b| b.error.total_cmp(&a.error));
        let first = self.slight.iter().take(ASKED_AT_ONCE);
        self.wrong.iter().chain(first).for_each(|off| marks.ask(off.index));
    }

    /// Sorts the wrong texels into excused ones and faults; gives the worst of the rest.
    pub fn judge(&mut self, search: &Search<'_>, marks: &Marks) -> Option<Off> {
        let judged: Vec<(Texel, bool)> = self
            .wrong
            .par_iter()
            .map(|off| {
                let texel = Texel::at(search.bench, off.index);
                let excused = texel.is_excused(search, marks);
                (texel, excused)
            })
            .collect();
        let mut worst = None;
        for (off, (texel, excused)) in self.wrong.iter().zip(judged) {
            match (excused, texel.stored, texel.hit) {
                (true, ..) => self.band.excused += 1,
                (_, None, _) => self.band.holes += 1,
                (_, _, None) => self.band.faults_extra += 1,
                _ => {
                    self.band.faults_off += 1;
                    worst = larger(worst, Some(*off));
                }
            }
        }
        let worst = worst.or_else(|| self.worst_slight(search, marks)).or(self.calm);
        self.band.largest_rest = worst.map_or(0.0, |off| off.error);
        worst
    }

    /// The first of the slightly wrong texels, largest error first, that is not excused.
    fn worst_slight(&self, search: &Search<'_>, marks: &Marks) -> Option<Off> {
        let (mut left, mut count) = (self.slight.as_slice(), ASKED_AT_ONCE);
        loop {
            let (asked, others) = left.split_at(count.min(left.len()));
            let is_rest =
                |off: &&Off| !Texel::at(search.bench, off.index).is_excused(search, marks);
            let found = asked.iter().find(is_rest);
            if found.is_some() || others.is_empty() {
                return found.copied();
            }
            (left, count) = (others, 4 * count);
            left.iter().take(count).for_each(|off| marks.ask(off.index));
            search.mark_edges(marks);
        }
    }

    /// The band, with what the errors of the covered texels say.
    pub fn finish(&mut self) -> Band {
        let errors = &mut self.errors;
        let above = |limit: f64| errors.iter().filter(|&&error| error > limit).count();
        let (off_1e2, off_1e3) = (above(1e-2), above(WRONG));
        let largest = errors.iter().copied().fold(0.0, f64::max);
        let rank = (errors.len() as f64 * 0.99).ceil() as usize;
        let percentile_99 = rank
            .checked_sub(1)
            .map_or(0.0, |index| *errors.select_nth_unstable_by(index, f64::total_cmp).1);
        let covered = errors.len();
        Band { covered, off_1e2, off_1e3, largest, percentile_99, ..self.band.clone() }
    }
}

/// The texel with the larger error.
pub fn larger(a: Option<Off>, b: Option<Off>) -> Option<Off> {
    let error = |off: &Option<Off>| off.map_or(-1.0, |off| off.error);
    if error(&b) > error(&a) { b } else { a }
}
