//! The program `dpsm`: parses arguments and calls one function a command.

mod cli;

use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::process::ExitCode;
use std::sync::Mutex;

use clap::Parser;

/// What the last panic said. The library turns wgpu's into errors; any other is a fault of ours.
static PANIC: Mutex<String> = Mutex::new(String::new());

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    set_hook(Box::new(|info| {
        if let Ok(mut panic) = PANIC.lock() {
            *panic = info.to_string();
        }
    }));
    match catch_unwind(AssertUnwindSafe(|| cli::run(arguments))) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(error)) => cli::fail(&error),
        Err(_) => {
            let panic = PANIC.lock().map(|panic| panic.clone()).unwrap_or_default();
            eprintln!("dpsm: a fault of this program, please report it: {panic}");
            cli::leave(1)
        }
    }
}
