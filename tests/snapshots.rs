//! What a change of a module changes, to be read in review: linked text, generated entry points,
//! and the ports' results on the named hard cases as bits.

#![cfg(feature = "naga")]

use std::fmt::Write;

use dpsm::cases;
use dpsm::scalar::ports::{self, Word};

#[test]
fn linked_text_of_each_module() {
    for module in dpsm::MODULES {
        let linked = dpsm::link(&[module.name]).unwrap();
        dpsm::validate(&linked).unwrap();
        insta::assert_snapshot!(format!("linked-{}", module.name), linked.text);
    }
}

#[test]
fn one_item_links_with_what_it_needs_alone() {
    insta::assert_snapshot!(
        "linked-item",
        dpsm::link(&["depth::dpsm_receiver_depth"]).unwrap().text
    );
}

#[cfg(feature = "gpu")]
#[test]
fn generated_entry_points() {
    use dpsm::reflect::Signature;
    for function in ["dpsm_project", "dpsm_caster_fragment", "dpsm_visibility"] {
        let validated = dpsm::validate(&dpsm::link::link_function(function).unwrap()).unwrap();
        let signature = Signature::of(&validated.module, function).unwrap();
        let entry = dpsm::gpu::entry_point(&signature);
        insta::assert_snapshot!(format!("entry-point-{function}"), entry);
    }
}

#[test]
fn ports_on_the_named_hard_cases() {
    let mut text = String::new();
    for (function, cases) in cases::all() {
        assert!(!cases.is_empty(), "{function} has no named hard case");
        let _ = writeln!(text, "{function}");
        for case in cases {
            let result = ports::call(function, &case.words).unwrap();
            let words = result.into_iter().map(|word| match word {
                // which NaN is not specified
                Word::Float(value) if value.is_nan() => "nan".to_string(),
                Word::Float(value) => format!("{:08x}", value.to_bits()),
                Word::Integer(value) => value.to_string(),
            });
            let words = words.collect::<Vec<_>>().join(" ");
            let _ = writeln!(text, "  {:<48}{words}", case.name);
        }
    }
    insta::assert_snapshot!("hard-cases", text);
}
