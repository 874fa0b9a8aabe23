//! What the hard cases promise: results that are finite and in the function's range, in the f32
//! port, in the f64 port and on the adapter; and the page that lists them.

use std::fmt::Write;

use dpsm::cases::{self, Case, Promise, values};
use dpsm::scalar::ports::{self, Word};

#[path = "hard_cases/range.rs"]
mod range;

use range::in_range;

fn widen(words: &[Word<f32>]) -> Vec<Word<f64>> {
    let widen = |word: &Word<f32>| match *word {
        Word::Float(value) => Word::Float(value.into()),
        Word::Integer(value) => Word::Integer(value),
    };
    words.iter().map(widen).collect()
}

fn number(word: Word<f64>) -> f64 {
    match word {
        Word::Float(value) => value,
        Word::Integer(value) => value.into(),
    }
}

/// What is wrong with a result that was promised to be finite and in range.
fn fault(function: &str, case: &Case, result: &[Word<f64>]) -> Option<String> {
    let result: Vec<f64> = result.iter().map(|&word| number(word)).collect();
    let fault = match in_range(function, &result) {
        _ if !result.iter().all(|value| value.is_finite()) => "not finite",
        false => "out of range",
        true => return None,
    };
    Some(format!("{function}, {} of {}: {fault}: {result:?}", case.name, case.table))
}

#[test]
fn ports_give_finite_results_in_range_wherever_they_are_promised() {
    let mut faults = Vec::new();
    let mut counts = [0; 3];
    for (function, cases) in cases::all() {
        for case in cases {
            let single = ports::call(function, &case.words).unwrap();
            let double = ports::call(function, &widen(&case.words)).unwrap();
            counts[case.promise as usize] += 1;
            if case.promise != Promise::Outside {
                faults.extend(fault(function, &case, &widen(&single)).map(|f| f + " (f32)"));
                faults.extend(fault(function, &case, &double).map(|f| f + " (f64)"));
            }
        }
    }
    let [outside, finite, inside] = counts;
    println!("{inside} cases inside the domains, {finite} finite outside, {outside} outside");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(inside > 2 * outside && finite > 0, "most cases must promise something");
}

/// Set to write the page anew.
const WRITE: &str = "DPSM_WRITE_DOCS";

/// docs/hard-cases.md: the tables, who takes them, and how much is promised.
fn page() -> String {
    let all: Vec<(&str, Vec<Case>)> = cases::all().collect();
    let count = |promise| {
        all.iter().flat_map(|(_, cases)| cases).filter(move |c| c.promise == promise).count()
    };
    let [inside, finite, outside] = [Promise::Inside, Promise::Finite, Promise::Outside].map(count);
    let mut text = format!(
        "# Hard cases\n\nGenerated from src/cases/values.rs by \
        `{WRITE}=1 cargo test --test hard_cases`; `dpsm eval FUNCTION` runs a function's.\n\n\
        Each value is promised to each function that takes it, by the function's domain: inside \
        ({inside} cases), where the result is finite, in the function's range and within its \
        bound; outside but finite and in range ({finite}: underflow, degenerate shapes); outside \
        ({outside}: overflow, infinity, NaN), where anything may come out, but the same kind of \
        thing, finite or not, on lavapipe and in the f32 port. tests/hard_cases.rs checks that in \
        both ports and on the adapter, but for the bound, which tests/accuracy.rs checks where no \
        word is subnormal; tests/big checks the f64 ports against 256 bits \
        ([numerics](numerics.md)). The columns on the right count the functions' cases of each \
        kind.\n"
    );
    for (table, about, rows) in values::tables() {
        let takes = |cases: &[Case]| cases.iter().any(|case| case.table == table);
        let taking = all.iter().filter(|(_, cases)| takes(cases));
        let taking: Vec<String> = taking.map(|(function, _)| format!("`{function}`")).collect();
        assert!(!taking.is_empty(), "no function takes {table}");
        let _ = write!(
            text,
            "\n## {table}\n\n{about} Taken by {}.\n\n\
            | case | value | expected | inside | finite | outside |\n|---|---|---|---|---|---|\n",
            taking.join(", ")
        );
        for (name, value, expected) in rows {
            let of = |promise| {
                let same = |c: &&Case| c.table == table && c.value == name && c.promise == promise;
                match all.iter().flat_map(|(_, cases)| cases).filter(same).count() {
                    0 => String::new(),
                    count => count.to_string(),
                }
            };
            let [inside, finite, outside] =
                [Promise::Inside, Promise::Finite, Promise::Outside].map(of);
            let _ = writeln!(
                text,
                "| {name} | {value} | {expected} | {inside} | {finite} | {outside} |"
            );
        }
    }
    text
}

#[test]
fn page_of_hard_cases_is_what_the_tables_make() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/hard-cases.md");
    let text = page();
    if std::env::var_os(WRITE).is_some() {
        std::fs::write(path, &text).unwrap();
    }
    let stored = std::fs::read_to_string(path).unwrap_or_default().replace("\r\n", "\n");
    assert!(stored == text, "{path} is stale: run the tests with {WRITE}=1 and commit it");
}

#[cfg(feature = "gpu")]
#[test]
fn adapter_keeps_the_promises_and_lavapipe_agrees_outside_the_domains() {
    use dpsm::gpu::{Device, Evaluator};
    let device = match Device::open() {
        Ok(device) => device,
        Err(error) if std::env::var_os("DPSM_REQUIRE_ADAPTER").is_none() => {
            println!("skipped: {error}");
            return;
        }
        Err(error) => panic!("{error}"),
    };
    // neither fuses, flushes nor reorders
    let exact = device.info.name.contains("llvmpipe");
    let mut faults = Vec::new();
    let (mut checked, mut alike) = (0, 0);
    for (function, cases) in cases::all() {
        let bits = |word: &Word<f32>| match *word {
            Word::Float(value) => value.to_bits(),
            Word::Integer(value) => value,
        };
        let words: Vec<u32> = cases.iter().flat_map(|case| case.words.iter().map(bits)).collect();
        let answers = Evaluator::new(&device, function).unwrap().run(&words, None).unwrap().words;
        let length = answers.len() / cases.len();
        for (case, answer) in cases.iter().zip(answers.chunks(length)) {
            let port = ports::call(function, &case.words).unwrap();
            let read = |(port, &answer): (&Word<f32>, &u32)| match port {
                Word::Float(_) => Word::Float(f32::from_bits(answer)),
                Word::Integer(_) => Word::Integer(answer),
            };
            let answer: Vec<Word<f32>> = port.iter().zip(answer).map(read).collect();
            checked += 1;
            if case.promise != Promise::Outside {
                faults.extend(fault(function, case, &widen(&answer)));
            }
            if exact {
                let same = |(a, b): (&Word<f32>, &Word<f32>)| match (*a, *b) {
                    (Word::Float(a), Word::Float(b)) if case.promise == Promise::Outside => {
                        a.is_finite() == b.is_finite()
                    }
                    // but for signs of zeros: Mesa makes select(-1, 0, c) of -f32(!c)
                    (Word::Float(a), Word::Float(b)) => a.to_bits() == b.to_bits() || a == b,
                    (a, b) => a == b || case.promise == Promise::Outside,
                };
                alike += 1;
                if !answer.iter().zip(&port).all(same) {
                    let name = &case.name;
                    faults.push(format!("{function}, {name}: {answer:?} is not {port:?}"));
                }
            }
        }
    }
    println!("{}: {checked} cases, {alike} compared with the port", device.info.name);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
