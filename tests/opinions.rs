//! A second opinion that needs no driver: the modules as native Rust, as benches/accuracy runs
//! them, beside the f32 ports.

#![cfg(feature = "gpu")]

mod common;
#[path = "../benches/accuracy/implementation/native.rs"]
mod native;

use dpsm::accuracy::{Records, bits};
use dpsm::link::link_function;
use dpsm::reflect::{Kind, Signature};
use dpsm::scalar::ports::{self, PORTS};

/// Records of each function.
const INPUTS: usize = 1 << 12;

/// The same float, whatever the sign of a zero and the bits of a NaN: naga-rust-embed's dot
/// product ends with + 0.
fn same(kind: Kind, a: u32, b: u32) -> bool {
    let [float_a, float_b] = [a, b].map(f32::from_bits);
    let floats = float_a == float_b || (float_a.is_nan() && float_b.is_nan());
    a == b || (kind == Kind::Float && floats)
}

#[test]
fn native_rust_of_the_modules_gives_the_ports_bits_but_for_signs_of_zeros() {
    let mut run = 0;
    for (_, function) in PORTS {
        let validated = dpsm::validate(&link_function(function).unwrap()).unwrap();
        let signature = Signature::of(&validated.module, function).unwrap();
        let mut rng = common::rng(function);
        let made = Records::of(&signature);
        let records: Vec<_> = (0..INPUTS).map(|i| made.record(i % 8 == 0, &mut rng)).collect();
        let words: Vec<u32> = records.iter().flatten().map(|&word| bits(word)).collect();
        let Some(answers) = native::call(function, &words) else { continue };
        run += 1;
        let outputs = signature.outputs();
        assert_eq!(answers.len(), INPUTS * outputs.len(), "{function}");
        for (record, answer) in records.iter().zip(answers.chunks(outputs.len())) {
            let port: Vec<_> =
                ports::call(function, record).unwrap().into_iter().map(bits).collect();
            let mut words = outputs.iter().zip(answer).zip(&port);
            let agree = words.all(|((output, &a), &b)| same(output.kind, a, b));
            assert!(agree, "{function} of {record:?}: {answer:08x?}, port {port:08x?}");
        }
    }
    println!("{run} of {} functions", PORTS.len());
    assert!(run > 0);
}
