//! The program `dpsm`: parses arguments and calls one function a command.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    match cli::run(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("dpsm: {error}");
            ExitCode::from(error.code())
        }
    }
}
