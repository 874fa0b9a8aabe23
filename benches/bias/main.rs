//! What the biases leave and what they cost.
//!
//! `cargo bench --bench bias [-- planes | faults | contact]`; without an argument all. Tables are
//! Markdown. `planes` needs no adapter.

#[path = "../../tests/common/mod.rs"]
mod common;
mod contact;
mod faults;
#[path = "../maps/place.rs"]
mod place;
mod planes;

use dpsm::gpu::Device;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let wanted = |name: &str| arguments.is_empty() || arguments.iter().any(|asked| asked == name);
    if wanted("planes") {
        planes::planes();
    }
    type Part = fn(&Device) -> Result<(), dpsm::gpu::GpuError>;
    let parts: [(&str, Part); 2] = [("faults", faults::faults), ("contact", contact::contact)];
    for (name, part) in parts.into_iter().filter(|(name, _)| wanted(name)) {
        match Device::open() {
            Ok(device) => {
                println!("\nadapter: {}", device.describe());
                if let Err(error) = part(&device) {
                    println!("{name}: {error}");
                }
            }
            Err(error) => println!("{name}: no figures: {error}"),
        }
    }
}
