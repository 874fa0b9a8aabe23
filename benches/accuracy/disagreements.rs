//! Where the implementations are not the f32 port bit for bit, and which of WGSL's freedoms
//! explains it.

use dpsm::accuracy::Records;
use dpsm::reflect::{Component, Kind, Signature};
use dpsm::scalar::ports::{self, Flat, PORTS, Word};

use super::common;
use super::flushed::{Flushed, OPEN};
use super::implementation::Implementation;

/// What a function's results on one implementation are, beside the port's.
const CAUSES: [&str; 5] = ["same", "flushed", "zero", "open", "other"];

/// The port's words; `value` and `back` take a float to the port's type and to f32.
fn port<T: dpsm::scalar::float::Float + Flat<T>>(
    function: &str,
    record: &[Word<f32>],
    value: impl Fn(f32) -> T,
    back: impl Fn(T) -> f32,
) -> Vec<u32> {
    let word = |word: &Word<f32>| match *word {
        Word::Float(float) => Word::Float(value(float)),
        Word::Integer(integer) => Word::Integer(integer),
    };
    let record: Vec<_> = record.iter().map(word).collect();
    let results = ports::call(function, &record).expect("a record of the function");
    let bits = |word| match word {
        Word::Float(float) => back(float).to_bits(),
        Word::Integer(integer) => integer,
    };
    results.into_iter().map(bits).collect()
}

/// The same results, NaN as NaN; with `zeros` also where only the sign of a zero differs.
fn agree(outputs: &[Component], a: &[u32], b: &[u32], zeros: bool) -> bool {
    let nan = |bits| f32::from_bits(bits).is_nan();
    let same = |kind, a: u32, b: u32| {
        let float = (nan(a) && nan(b)) || (zeros && (a | b) << 1 == 0);
        a == b || (kind == Kind::Float && float)
    };
    outputs.iter().zip(a).zip(b).all(|((output, &a), &b)| same(output.kind, a, b))
}

/// Prints for each function and implementation how many of `inputs` records each cause explains,
/// and the first that none explains.
pub fn print(all: &mut [Box<dyn Implementation>], inputs: usize) -> Result<(), String> {
    println!("{inputs} records a function; for each implementation:");
    println!("  same     bit for bit as the f32 port, any NaN for a NaN");
    println!("  flushed  as the port on an f32 whose operations flush subnormals");
    println!("  zero     as one of these but for the sign of a zero");
    println!("  open     else, where the port gives min or max a NaN, or zeros of either sign");
    println!("  other    else");
    for implementation in all {
        println!("\n{}", implementation.name());
        println!("{:<32}{}", "function", CAUSES.map(|cause| format!("{cause:>9}")).concat());
        let mut whole = 0;
        for (_, function) in PORTS {
            let linked = dpsm::link::link_function(function).map_err(|error| error.to_string())?;
            let validated = dpsm::validate(&linked).map_err(|error| error.to_string())?;
            let signature = Signature::of(&validated.module, function)?;
            let outputs = signature.outputs();
            let mut rng = common::rng(function);
            let made = Records::of(&signature);
            let records: Vec<_> = (0..inputs).map(|i| made.record(i % 8 == 0, &mut rng)).collect();
            let bits = |word: &Word<f32>| match *word {
                Word::Float(float) => float.to_bits(),
                Word::Integer(integer) => integer,
            };
            let words: Vec<u32> = records.iter().flatten().map(bits).collect();
            let answers = match implementation.evaluate(function, &words) {
                Ok(Some(answers)) => answers,
                Ok(None) => {
                    println!("{function:<32} not run");
                    continue;
                }
                Err(error) => {
                    println!("{function:<32} {error}");
                    continue;
                }
            };
            let mut counts = [0; CAUSES.len()];
            let mut first = None;
            for (record, answer) in records.iter().zip(answers.chunks(outputs.len())) {
                let plain = port(function, record, |value| value, |value| value);
                OPEN.set(false);
                let flushed = port(function, record, Flushed, |value| value.0);
                let agree = |port, zeros| agree(&outputs, answer, port, zeros);
                let cause = match () {
                    () if agree(&plain, false) => 0,
                    () if agree(&flushed, false) => 1,
                    () if agree(&plain, true) || agree(&flushed, true) => 2,
                    () if OPEN.get() => 3,
                    () => 4,
                };
                counts[cause] += 1;
                if cause == 4 {
                    let input: Vec<_> = record.iter().map(bits).collect();
                    first.get_or_insert_with(|| {
                        format!("  {input:08x?}\n  gives {answer:08x?}\n  port  {plain:08x?}")
                    });
                }
            }
            match counts[0] == inputs {
                true => whole += 1,
                false => println!("{function:<32}{}", counts.map(|n| format!("{n:>9}")).concat()),
            }
            first.iter().for_each(|first| println!("{first}"));
        }
        println!("{whole} functions are the same in all records");
    }
    Ok(())
}
