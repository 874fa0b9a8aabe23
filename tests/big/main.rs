//! The f64 ports, which are the reference of all other checks, against the same ports over numbers
//! of 256 bits, on the hard cases.
//!
//! The bound of each result is carried along with it: what every operation of f64 may add, and
//! what it makes of its operands' errors (docs/numerics.md). It is the f32 ports' bound by the same
//! rules, scaled by 2^-29. Where it straddles a decision both answers are right: the wide port then
//! takes the f64 port's, and none elsewhere.

mod tracked;
mod wide;

use dpsm::cases::{self, Promise};
use dpsm::scalar::ports::{self, Word};
use tracked::Tracked;
use wide::Wide;

/// What the bounds' own rounding in f64 may hide.
const SLACK: f64 = 1.0 + 1.0 / (1u64 << 30) as f64;

fn over<T>(words: &[Word<f32>], number: impl Fn(f64) -> T) -> Vec<Word<T>> {
    let over = |word: &Word<f32>| match *word {
        Word::Float(value) => Word::Float(number(value.into())),
        Word::Integer(value) => Word::Integer(value),
    };
    words.iter().map(over).collect()
}

#[test]
fn f64_ports_agree_with_256_bits_within_their_bounds_on_the_hard_cases() {
    let mut faults = Vec::new();
    let (mut results, mut straddled, mut loose) = (0, 0, 0);
    println!("{:<34}{:>8}{:>12}{:>12}", "function", "results", "straddling", "of bound");
    for (function, cases) in cases::all() {
        let (mut worst, mut straddling, mut compared) = (0.0_f64, 0, 0);
        for case in cases.iter().filter(|case| case.promise != Promise::Outside) {
            let name = format!("{function}, {} of {}", case.name, case.table);
            let double = ports::call(function, &over(&case.words, |value| value)).unwrap();
            tracked::forget();
            let bounded = ports::call(function, &over(&case.words, Tracked::exact)).unwrap();
            wide::forget();
            let exact = ports::call(function, &over(&case.words, Wide::exact)).unwrap();
            faults.extend(wide::faults().into_iter().map(|fault| format!("{name}: {fault}")));
            straddling += usize::from(tracked::straddles() > 0);
            for ((double, bounded), exact) in double.into_iter().zip(bounded).zip(exact) {
                compared += 1;
                match (double, bounded, exact) {
                    (Word::Float(double), Word::Float(bounded), Word::Float(exact)) => {
                        assert_eq!(double.to_bits(), bounded.value.to_bits(), "{name}");
                        let error = exact.off(double);
                        if bounded.error == f64::INFINITY {
                            loose += 1;
                            println!("no bound: {name}: {double:e}, off by {error:e}");
                        } else if error > 0.0 {
                            worst = worst.max(error / bounded.error);
                        }
                        if error.is_nan() || error > bounded.error * SLACK {
                            let bound = bounded.error;
                            faults
                                .push(format!("{name}: {double:e} is off by {error:e}, {bound:e}"));
                        }
                    }
                    (Word::Integer(double), _, Word::Integer(exact)) if double == exact => {}
                    other => faults.push(format!("{name}: {other:?}")),
                }
            }
        }
        println!("{function:<34}{compared:>8}{straddling:>12}{worst:>12.3}");
        results += compared;
        straddled += straddling;
    }
    println!("{results} results, {straddled} records with a straddled decision, {loose} unbounded");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(loose * 100 < results, "{loose} of {results} results have no bound");
}
