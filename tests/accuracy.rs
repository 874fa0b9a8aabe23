//! Every function over its whole domain: within its bound on the port and on the adapter, and the
//! two bit for bit the same where the driver rounds to nearest.

#![cfg(feature = "gpu")]

mod common;

use common::device;
use dpsm::accuracy::{
    CHUNK, Inputs, Judge, Stats, Verdict, bits, judge_all, loosely, search, search_loosely,
};
use dpsm::cases;
use dpsm::gpu::{Device, Evaluator};
use dpsm::scalar::bounds::{self, Bound, Unit};
use dpsm::scalar::ports::{PORTS, Word};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestError, TestRunner};

/// Inputs of each function.
const INPUTS: u64 = 1_000_000;

/// Inputs of each function on a driver that rounds at random.
const LOOSE: u64 = 20_000;

/// Chunks that are evaluated at once.
const AT_ONCE: u64 = 16;

/// The functions to test: all, or those with `DPSM_ONLY` in their names, as
/// `DPSM_ONLY=dpsm_project cargo test --test accuracy` sets it.
fn chosen() -> Vec<&'static Bound> {
    let part = std::env::var("DPSM_ONLY").unwrap_or_default();
    let chosen: Vec<_> = bounds::all().iter().filter(|b| b.function.contains(&part)).collect();
    assert!(
        !chosen.is_empty(),
        "no function has DPSM_ONLY=`{part}` in its name; give part of one or unset it"
    );
    chosen
}

/// A driver that neither fuses, flushes nor reorders.
fn rounds_to_nearest(device: &Device) -> bool {
    device.info.name.contains("llvmpipe")
}

/// Judges the adapter's answers.
fn on_adapter(judge: &Judge, device: &Device) -> Stats {
    let evaluator = Evaluator::new(device, judge.bound.function).unwrap();
    let inputs = Inputs::of(judge);
    let run = |first: u64| {
        let records = inputs.chunks(first..first + AT_ONCE);
        let words: Vec<u32> = records.iter().flatten().map(|&word| bits(word)).collect();
        judge_all(judge, &records, &evaluator.run(&words, None).unwrap().words)
    };
    let mut stats = Stats::default();
    let mut first = 0;
    while stats.compared < INPUTS && first < 8 * INPUTS / CHUNK as u64 {
        stats = stats.and(run(first));
        first += AT_ONCE;
    }
    stats
}

fn floats(words: &[u32]) -> Vec<f32> {
    words.iter().map(|&bits| f32::from_bits(bits)).collect()
}

#[test]
fn no_result_is_outside_its_bound_and_the_adapter_agrees_with_the_ports() {
    let device = device();
    let mut failures = Vec::new();
    println!(
        "{:<34}{:>9}{:>9}{:>8}{:>7}{:>8}{:>8}{:>8}{:>10}{:>9}",
        "function",
        "compared",
        "judged",
        "other",
        "open",
        "worst",
        "mean",
        "rounded",
        "different",
        "outside"
    );
    for bound in chosen() {
        let judge = Judge::of(bound.function).unwrap();
        // without an adapter the intervals hold the port by their construction: a sample
        let sampled = device.is_none() && bound.unit == Unit::Interval;
        let wanted = if sampled { INPUTS / 16 } else { INPUTS };
        let stats = match &device {
            Some(device) => on_adapter(&judge, device),
            None => search(&judge, wanted, |_| {}),
        };
        println!(
            "{:<34}{:>9}{:>9}{:>8}{:>7}{:>8.3}{:>8.3}{:>8.3}{:>10}{:>9}",
            bound.function,
            stats.compared,
            stats.points,
            stats.decisions,
            stats.open,
            stats.worst.share(),
            stats.mean(),
            stats.rounded as f64 / stats.points as f64,
            stats.differ,
            stats.differ_outside
        );
        if stats.broken > 0 {
            let input = floats(&stats.broken_input);
            failures.push(format!("{}: {} broken, {input:?}", bound.function, stats.broken));
        }
        if stats.differ > 0 && device.as_ref().is_some_and(rounds_to_nearest) {
            let input = floats(&stats.differ_input);
            failures.push(format!("{}: {} differ, {input:?}", bound.function, stats.differ));
        }
        let inputs = stats.compared.max(stats.points);
        if inputs < wanted {
            failures.push(format!("{}: only {inputs} inputs in the domain", bound.function));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn any_driver_stays_within_the_bounds() {
    let mut failures = Vec::new();
    for bound in chosen() {
        let judge = Judge::of(bound.function).unwrap();
        let stats = search_loosely(&judge, LOOSE, |_| {});
        println!(
            "{:<34}{:>9}{:>8}{:>7}{:>8.3}",
            bound.function,
            stats.points,
            stats.decisions,
            stats.open,
            stats.worst.share()
        );
        if stats.broken > 0 {
            let input = floats(&stats.broken_input);
            failures.push(format!(
                "{}: {} broken, {} of {}, {input:?}",
                bound.function, stats.broken, stats.worst.eps, stats.worst.bound
            ));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Shrinks whatever breaks a bound to the fewest changed words and the smallest bits.
#[test]
fn no_words_changed_in_a_hard_case_break_a_bound() {
    for bound in bounds::all() {
        let judge = Judge::of(bound.function).unwrap();
        let cases: Vec<_> = cases::of(bound.function).into_iter().map(|case| case.words).collect();
        let config = Config { cases: 512, failure_persistence: None, ..Config::default() };
        let mut runner = TestRunner::new_with_rng(
            config,
            proptest::test_runner::TestRng::deterministic_rng(Default::default()),
        );
        let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u32>()), 0..4);
        let record = |case: prop::sample::Index, changes: &[(prop::sample::Index, u32)]| {
            let mut record = case.get(&cases).clone();
            for (place, bits) in changes {
                let place = place.index(record.len());
                if let Word::Float(value) = &mut record[place] {
                    *value = f32::from_bits(*bits);
                }
            }
            record
        };
        let found = runner.run(&(any::<prop::sample::Index>(), changes), |(case, changes)| {
            let record = record(case, &changes);
            let mut answer = Vec::new();
            (judge.port)(&record, &mut answer).unwrap();
            let broken = judge
                .judge(&record, &answer)
                .is_some_and(|judged| judged.verdict == Verdict::Broken);
            prop_assert!(!broken);
            Ok(())
        });
        if let Err(TestError::Fail(_, (case, changes))) = found {
            panic!("{}: {:?}", bound.function, record(case, &changes));
        }
    }
}

#[test]
fn worst_inputs_that_were_found_stay_within_their_bounds() {
    let mut seen = 0;
    for (function, bits) in cases::worst() {
        let judge = Judge::of(function).unwrap();
        let record = judge.record(&bits).unwrap_or_else(|| panic!("{function}: {bits:08x?}"));
        let mut answers = vec![Vec::new()];
        (judge.port)(&record, &mut answers[0]).unwrap();
        answers.extend((0..64).filter_map(|seed| loosely(judge.loose, &record, seed)));
        for answer in answers {
            let judged = judge.judge(&record, &answer);
            let judged = judged.unwrap_or_else(|| panic!("{function} is outside its domain"));
            assert_ne!(judged.verdict, Verdict::Broken, "{function} of {record:?}: {judged:?}");
        }
        seen += 1;
    }
    println!("{seen} inputs");
    assert!(seen > 0);
}

#[test]
fn every_port_has_a_bound_in_the_ports_order() {
    let bounds: Vec<_> = bounds::all().iter().map(|b| (b.module, b.function)).collect();
    assert_eq!(bounds, PORTS);
}

#[test]
fn comments_of_the_functions_state_the_tables_bounds() {
    for bound in bounds::all() {
        let text = dpsm::module(bound.module).unwrap().text;
        let end = text.find(&format!("fn {}(", bound.function)).unwrap();
        let comment = text[..end].rsplit("\n\n").next().unwrap();
        let comment: Vec<_> = comment.lines().map(|l| l.trim_start_matches("///").trim()).collect();
        let comment = comment.join(" ");
        match bound.unit {
            Unit::Exact => {
                let says = ["Exact", "decision", "rounding up", "exact"];
                assert!(says.iter().any(|word| comment.contains(word)), "{}", bound.function);
            }
            Unit::Interval => {}
            _ => {
                let judge = Judge::of(bound.function).unwrap();
                let stats = search(&judge, 1, |_| {});
                let eps = format!("{}", stats.worst.bound);
                println!("{}: {eps} eps", bound.function);
                // a bound of 1 is the whole of a scale, one with many digits depends on the input
                let plain = eps.len() <= 4 && eps != "1";
                let stated = comment.contains(&format!("{eps} eps"))
                    || comment.contains("as for")
                    || comment.contains("as dpsm_");
                assert!(!plain || stated, "{}: {eps} eps is not in: {comment}", bound.function);
            }
        }
    }
}

#[test]
fn answers_within_the_bound_but_outside_the_interval_are_broken() {
    let judge = Judge::of("dpsm_depth").unwrap();
    let record = [0.75_f32, 0.5, 1.0].map(Word::Float);
    let verdict =
        |depth: f32| judge.judge_strictly(&record, &[Word::Float(depth)]).unwrap().verdict;
    let ulp = f32::EPSILON / 4.0;
    // both differences are exact, the quotient may be 2.5 ULP off, and 4.5 (l + near) eps are allowed
    assert_eq!(verdict(0.5 + 2.0 * (2.0 * ulp)), Verdict::Within);
    assert_eq!(verdict(0.5 + 3.0 * (2.0 * ulp)), Verdict::Broken);
    let loosely = judge.judge(&record, &[Word::Float(0.5 + 3.0 * (2.0 * ulp))]).unwrap();
    assert_eq!(loosely.verdict, Verdict::Within);
    assert_eq!(judge.judge(&record, &[Word::Float(0.51)]).unwrap().verdict, Verdict::Broken);
    // nothing is said outside the domain
    assert!(judge.judge(&[0.75_f32, 1.0, 0.5].map(Word::Float), &[Word::Float(9.0)]).is_none());
}

#[test]
fn answers_that_are_no_numbers_or_too_few_are_broken() {
    for bound in bounds::all() {
        let judge = Judge::of(bound.function).unwrap();
        let records = Inputs::of(&judge).chunk(0);
        let inside = |record: &&Vec<Word<f32>>| judge.inside(record);
        let (mut open, mut tried) = (0, 0);
        for record in records.iter().filter(inside).take(32) {
            let mut answer = Vec::new();
            (judge.port)(record, &mut answer).unwrap();
            assert_eq!(judge.judge(record, &[]).unwrap().verdict, Verdict::Broken);
            for place in 0..answer.len() {
                let mut wrong = answer.clone();
                match &mut wrong[place] {
                    Word::Float(value) => *value = f32::NAN,
                    Word::Integer(value) => *value ^= 1 << 30,
                }
                let judged = judge.judge(record, &wrong).unwrap();
                tried += 1;
                open += usize::from(judged.verdict == Verdict::Open);
                let broken = judged.verdict == Verdict::Broken && judged.error.share() > 1.0;
                let excused = judged.verdict == Verdict::Open && bound.unit == Unit::Interval;
                assert!(broken || excused, "{}: word {place} of {record:?}", bound.function);
            }
        }
        // WGSL promises nothing of few of the inputs, or the domain is too wide
        assert!(open * 8 <= tried, "{}: {open} of {tried} open", bound.function);
    }
}

#[test]
fn hard_cases_of_the_domain_are_within_their_bounds() {
    let (mut judged, mut left_out) = (0, 0);
    for bound in bounds::all() {
        let judge = Judge::of(bound.function).unwrap();
        let before = judged;
        for case in cases::of(bound.function) {
            let mut answer = Vec::new();
            (judge.port)(&case.words, &mut answer).unwrap();
            match judge.judge_strictly(&case.words, &answer) {
                Some(found) => {
                    judged += 1;
                    let named = format!("{} at {}: {found:?}", bound.function, case.name);
                    assert_ne!(found.verdict, Verdict::Broken, "{named}");
                }
                None if case.promise == cases::Promise::Inside => {
                    left_out += 1;
                    println!("not judged: {} at {}", bound.function, case.name);
                }
                None => {}
            }
        }
        assert!(judged > before, "{}: no case of its domain", bound.function);
    }
    // those with subnormal words, which may count as 0, and at the ends of wider domains
    println!("{judged} cases judged, {left_out} of a domain are not");
}

#[test]
fn page_lists_every_function_with_no_figure_above_its_bound() {
    let page = include_str!("../docs/accuracy.md");
    let header = page.lines().find(|line| line.starts_with("| function |")).unwrap();
    let slack = header.split('|').position(|name| name.trim() == "slack").unwrap();
    for bound in bounds::all() {
        let start = format!("| `{}` |", bound.function);
        let row = page.lines().find(|line| line.starts_with(&start));
        let row = row.unwrap_or_else(|| panic!("{}: run tools/accuracy --write", bound.function));
        let left = row.split('|').nth(slack).unwrap().trim();
        assert!(left == "-" || left.parse::<f64>().unwrap() >= 0.0, "{}: {left}", bound.function);
    }
}
