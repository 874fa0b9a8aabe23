//! Arguments, and the choice of the command.

mod bake;
#[cfg(fuzzing)]
pub mod check;
mod error;
mod eval;
mod measure;
mod number;
mod output;
mod parts;
mod plan;
mod probe;
mod render;
mod report;
mod search;
mod setup;
mod table;
mod text;
mod tint;

pub use error::CliError;

use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand, ValueEnum};
use dpsm::gpu::{Device, GpuError};
use glam::DVec3;

/// Point-light shadows from dual-paraboloid maps.
///
/// With no command: `dpsm report` on all built-in scenes, which says what every method costs and how
/// wrong its shadows are.
#[derive(Debug, Parser)]
#[command(version, after_help = EXAMPLES)]
pub struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// What computes: an adapter if there is one, the processor, or an adapter or nothing
    ///
    /// WGPU_ADAPTER_NAME (part of its name) and WGPU_BACKEND (vulkan, metal, dx12) choose the
    /// adapter. `cpu` runs the scalar ports. DPSM_PATIENCE is how many seconds one step may take on
    /// an adapter, 120 by default.
    #[arg(long, global = true, value_enum, default_value = "auto")]
    adapter: AdapterChoice,
    /// Folder for the report when no command is given
    #[arg(long)]
    folder: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  dpsm
  dpsm render brabec-room --light=-1,2,0.5 --maps -o room.png
  dpsm render atrium.obj --light 0,4,0 --size 2048 -o atrium.png
  dpsm link visibility shade -o shadows.wgsl
  dpsm validate my-shader.wesl
  dpsm eval dpsm_project --input points.csv
  dpsm measure brabec-room --walls 1 --size 512
  dpsm plan brabec-room --camera scene --error 0.2deg -o plan.json
  dpsm render brabec-room --plan plan.json -o planned.png
  dpsm report atrium.obj --light 0,4,0";

/// Which implementation computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum AdapterChoice {
    /// An adapter, or the scalar ports where there is none
    Auto,
    /// The scalar ports
    Cpu,
    /// An adapter; an error where there is none
    Gpu,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(render::RenderArguments),
    /// List the modules: name, one line, imports
    Modules,
    Link(text::LinkArguments),
    Validate(text::ValidateArguments),
    Eval(eval::EvalArguments),
    Bake(bake::BakeArguments),
    Probe(probe::ProbeArguments),
    Measure(measure::MeasureArguments),
    Plan(plan::PlanArguments),
    Report(report::ReportArguments),
}

impl Arguments {
    /// Refuses what the command would not look at.
    fn check(&self) -> Result<(), CliError> {
        match (&self.command, &self.folder) {
            (Some(_), Some(folder)) => {
                let folder = folder.display();
                let message = format!(
                    "--folder {folder} is for the report that no command makes; give `dpsm report` \
                     its own --folder behind it, and the other commands -o"
                );
                Err(CliError::Usage(message))
            }
            _ => Ok(()),
        }
    }
}

/// Runs the command.
pub fn run(arguments: Arguments) -> Result<(), CliError> {
    let adapter = arguments.adapter;
    arguments.check()?;
    match arguments.command {
        None => {
            let folder = arguments.folder.as_deref().unwrap_or(Path::new(report::FOLDER));
            report::report(adapter, &report::ReportArguments::all(folder))
        }
        Some(Command::Render(render)) => render::render(adapter, &render),
        Some(Command::Modules) => text::modules(),
        Some(Command::Link(link)) => text::link(&link),
        Some(Command::Validate(validate)) => text::validate(&validate),
        Some(Command::Eval(eval)) => eval::eval(adapter, &eval),
        Some(Command::Bake(bake)) => bake::bake(adapter, &bake),
        Some(Command::Probe(probe)) => probe::probe(adapter, &probe),
        Some(Command::Measure(measure)) => measure::measure(adapter, &measure),
        Some(Command::Plan(plan)) => plan::plan(&plan),
        Some(Command::Report(report)) => report::report(adapter, &report),
    }
}

/// Says what went wrong and ends the program.
pub fn fail(error: &CliError) -> ! {
    eprintln!("dpsm: {error}");
    leave(error.code())
}

/// Ends the program at once: a driver that is still at work, as after a hang, may wait for ever or
/// crash when the process is taken down in order. What was printed is flushed.
pub fn leave(code: u8) -> ! {
    unsafe extern "C" {
        safe fn _exit(code: std::ffi::c_int) -> !;
    }
    _exit(code.into())
}

impl AdapterChoice {
    /// Opens the adapter; `None` means the scalar ports, and stderr says why.
    fn open(self) -> Result<Option<Device>, CliError> {
        if self == AdapterChoice::Cpu {
            return Ok(None);
        }
        match Device::open() {
            Ok(device) => {
                // nothing is being written while the adapter works
                device.watch(|error| fail(&error.into()));
                Ok(Some(device))
            }
            // who names an adapter wants no other
            Err(error @ GpuError::NoAdapter { .. })
                if std::env::var("WGPU_ADAPTER_NAME").is_ok_and(|name| !name.is_empty()) =>
            {
                Err(error.into())
            }
            Err(
                error @ (GpuError::NoAdapter { .. }
                | GpuError::NoDevice { .. }
                | GpuError::Hung { .. }),
            ) if self == AdapterChoice::Auto => {
                eprintln!("dpsm: {error}");
                eprintln!("dpsm: running the scalar ports on the processor instead");
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }
}

/// The line that says what computed.
fn describe(device: Option<&Device>) -> String {
    match device {
        Some(device) => format!("adapter: {}", device.describe()),
        None => "adapter: none; the scalar ports on the processor".to_string(),
    }
}

/// Parses `x,y,z`.
fn parse_vector(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<&str> = text.split(',').map(str::trim).collect();
    let &[x, y, z] = numbers.as_slice() else {
        return Err("expected three numbers, as in -1,2,0.5".into());
    };
    let number = |text: &str| {
        let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
        match (value as f32).is_finite() {
            true => Ok(value),
            false => Err(format!("`{text}` is outside float range, 3.4e38 at the most")),
        }
    };
    Ok(DVec3::new(number(x)?, number(y)?, number(z)?))
}
