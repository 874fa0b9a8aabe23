//! Instructions of a filter's loop, as naga writes SPIR-V: those between the loop's header and its
//! merge block, and those of every function called there, each as often as it is called.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::{SHARED, VARIANTS};

const FUNCTION: u32 = 54;
const FUNCTION_PARAMETER: u32 = 55;
const FUNCTION_END: u32 = 56;
const FUNCTION_CALL: u32 = 57;
const LOOP_MERGE: u32 = 246;
const LABEL: u32 = 248;
const LINE: u32 = 8;

/// One function: its result id, and its instructions as opcode and operands.
struct Function {
    id: u32,
    instructions: Vec<(u32, Vec<u32>)>,
}

impl Function {
    /// The instructions of the largest loop, or of the whole function where there is none.
    fn looped(&self) -> Option<&[(u32, Vec<u32>)]> {
        let merges = self.instructions.iter().enumerate().filter(|(_, (op, _))| *op == LOOP_MERGE);
        merges
            .filter_map(|(at, (_, operands))| {
                let end = |(op, words): &(u32, Vec<u32>)| *op == LABEL && words[0] == operands[0];
                let end = self.instructions.iter().position(end)?;
                self.instructions.get(at..end)
            })
            .max_by_key(|part| part.len())
    }
}

/// Splits a module's functions.
fn functions(words: &[u32]) -> Vec<Function> {
    let mut found: Vec<Function> = Vec::new();
    let mut inside = false;
    let mut rest = words.get(5..).unwrap_or_default();
    while let Some(&first) = rest.first() {
        let (length, op) = ((first >> 16).max(1) as usize, first & 0xffff);
        let operands = rest.get(1..length).unwrap_or_default().to_vec();
        match op {
            FUNCTION => {
                found.push(Function { id: operands[1], instructions: Vec::new() });
                inside = true;
            }
            FUNCTION_END => inside = false,
            FUNCTION_PARAMETER | LINE => {}
            _ if inside => {
                if let Some(function) = found.last_mut() {
                    function.instructions.push((op, operands));
                }
            }
            _ => {}
        }
        rest = rest.get(length..).unwrap_or_default();
    }
    found
}

/// Instructions of a part, its calls followed.
fn count(part: &[(u32, Vec<u32>)], functions: &[Function]) -> usize {
    let callee = |operands: &[u32]| functions.iter().find(|function| function.id == operands[2]);
    part.iter()
        .map(|(op, operands)| match *op {
            LABEL => 0,
            FUNCTION_CALL => {
                1 + callee(operands).map_or(0, |function| count(&function.instructions, functions))
            }
            _ => 1,
        })
        .sum()
}

/// The ids of the functions that one calls, itself included.
fn reach(function: &Function, functions: &[Function], called: &mut Vec<u32>) {
    if called.contains(&function.id) {
        return;
    }
    called.push(function.id);
    for (_, operands) in function.instructions.iter().filter(|(op, _)| *op == FUNCTION_CALL) {
        if let Some(callee) = functions.iter().find(|callee| callee.id == operands[2]) {
            reach(callee, functions, called);
        }
    }
}

/// Prints each variant's counts: in its loop, and in all.
pub fn table() {
    println!("| filter | SPIR-V instructions in the loop | in all |\n|---|---|---|");
    for (name, _, body, _) in VARIANTS {
        match counts(body) {
            Ok([looped, all]) => println!("| {name} | {looped} | {all} |"),
            Err(error) => println!("| {name} | {error} | |"),
        }
    }
}

fn counts(body: &str) -> Result<[usize; 2], String> {
    let linked = dpsm::link_source("pixel.wesl", &format!("{SHARED}{body}\n}}\n"))
        .map_err(|error| error.to_string())?;
    let entry = "
@group(0) @binding(0) var the_maps: texture_depth_2d_array;
@group(0) @binding(1) var the_sampler: sampler_comparison;
@group(0) @binding(2) var the_point: sampler;
@fragment fn main(@location(0) p: vec3<f32>, @location(1) n: vec3<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(pixel(the_maps, the_sampler, the_point, p, n));
}";
    let text = format!("{}{entry}", linked.text);
    let module = naga::front::wgsl::parse_str(&text).map_err(|error| error.to_string())?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| error.to_string())?;
    let options = spv::Options { flags: spv::WriterFlags::empty(), ..Default::default() };
    let words =
        spv::write_vec(&module, &info, &options, None).map_err(|error| error.to_string())?;
    let functions = functions(&words);
    let Some(main) = functions.last() else { return Ok([0; 2]) };
    let mut called = Vec::new();
    reach(main, &functions, &mut called);
    // pcss has two loops, the search and the filter
    let loops = called
        .iter()
        .filter_map(|id| functions.iter().find(|function| function.id == *id)?.looped())
        .map(|part| count(part, &functions));
    Ok([loops.sum(), count(&main.instructions, &functions)])
}
