//! What plans rest on and how well they do.
//!
//! `cargo bench --bench plan -- rates`: the cost model's rates, fitted to this adapter's times.
//! `cargo bench --bench plan -- score [SCENE...]`: plans for random lights, measured, against a sweep
//! over all choices.
#[path = "../maps/place.rs"]
mod place;
mod rates;
mod score;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let result = match arguments.split_first() {
        Some((part, [])) if part == "rates" => rates::rates(),
        Some((part, scenes)) if part == "score" => score::score(scenes),
        _ => return println!("name a part: rates, or score and maybe scenes"),
    };
    if let Err(error) = result {
        println!("{error}");
    }
}
