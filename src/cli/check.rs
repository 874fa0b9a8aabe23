//! What the commands check before they open an adapter or write anything, for fuzzing.

use std::path::Path;

use dpsm::reflect::Component;

use super::table::Table;
use super::{Arguments, CliError, Command, eval, measure, plan, probe, render, report, text};

/// Everything that a command does before it opens an adapter.
pub fn arguments(arguments: &Arguments) -> Result<(), CliError> {
    match &arguments.command {
        None | Some(Command::Modules) => Ok(()),
        Some(Command::Render(render)) => render::framed(render).map(drop),
        Some(Command::Link(link)) => text::linked(link).map(drop),
        Some(Command::Validate(validate)) => text::validated(validate).map(drop),
        Some(Command::Eval(eval)) => eval::inputs(eval).map(drop),
        Some(Command::Bake(bake)) => {
            bake.check()?;
            measure::framed(&bake.setup).map(drop)
        }
        Some(Command::Probe(probe)) => {
            probe::points(&probe.points, Table::read(&probe.points)?)?;
            measure::framed(&probe.setup).map(drop)
        }
        Some(Command::Measure(measure)) => measure::framed(&measure.setup).map(drop),
        Some(Command::Plan(arguments)) => plan::request(arguments).map(drop),
        Some(Command::Report(report)) => match report::compared(report)? {
            Some(_) => Ok(()),
            None => report::subjects(report).map(drop),
        },
    }
}

/// The bytes as `dpsm probe` reads points; how many there are.
pub fn points(bytes: &[u8]) -> Result<usize, CliError> {
    let path = Path::new("points.csv");
    Ok(probe::points(path, Table::parse(path, bytes)?)?.len())
}

/// The bytes as `dpsm eval` reads records of these inputs; how many there are.
pub fn records(bytes: &[u8], inputs: &[Component]) -> Result<usize, CliError> {
    let path = Path::new("records.csv");
    Ok(eval::records(path, Table::parse(path, bytes)?, inputs)?.len())
}
