//! Every function over its whole domain: within its bound on the port and on the adapter, and the
//! two bit for bit the same where the driver rounds to nearest.

#![cfg(feature = "gpu")]

mod common;

use common::device;
use dpsm::accuracy::{CHUNK, Inputs, Judge, Stats, bits, judge_all, search};
use dpsm::gpu::{Device, Evaluator};
use dpsm::scalar::bounds;

/// Inputs of each function.
const INPUTS: u64 = 1_000_000;

/// Chunks that are evaluated at once.
const AT_ONCE: u64 = 16;

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
    while stats.points < INPUTS && first < 4 * INPUTS / CHUNK as u64 + AT_ONCE {
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
        "{:<34}{:>9}{:>8}{:>7}{:>8}{:>8}{:>8}{:>10}{:>9}",
        "function", "inputs", "other", "open", "worst", "mean", "rounded", "different", "outside"
    );
    for bound in bounds::all() {
        let judge = Judge::of(bound.function).unwrap();
        let stats = match &device {
            Some(device) => on_adapter(&judge, device),
            None => search(&judge, INPUTS, |_| {}),
        };
        println!(
            "{:<34}{:>9}{:>8}{:>7}{:>8.3}{:>8.3}{:>8.3}{:>10}{:>9}",
            bound.function,
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
        if stats.points < INPUTS {
            failures
                .push(format!("{}: only {} inputs in the domain", bound.function, stats.points));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
