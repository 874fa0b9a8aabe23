//! The commands on module text: modules, link, validate.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dpsm::{Catalogue, Linked, Validated};

use super::CliError;
use super::output::{print, read_text, write_or_print};

/// Link modules, items or a shader of your own into one plain WGSL text
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  dpsm link visibility
  dpsm link paraboloid::dpsm_project hemisphere
  dpsm link my-shader.wesl -o my-shader.wgsl")]
pub struct LinkArguments {
    /// Modules (`depth`), items (`depth::dpsm_depth`), or one file that imports them
    #[arg(required = true, value_name = "NAMES|FILE")]
    names: Vec<String>,
    /// Write here instead of standard output
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// Check a shader of your own that imports dpsm modules
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  dpsm validate my-shader.wesl")]
pub struct ValidateArguments {
    /// A WGSL or WESL file
    file: PathBuf,
}

pub fn modules() -> Result<(), CliError> {
    let mut text = String::new();
    for module in Catalogue::dpsm()?.describe() {
        let imports = match module.imports.as_slice() {
            [] => "nothing".into(),
            imports => imports.join(", "),
        };
        let _ = writeln!(text, "{:<12}{}\n{:12}imports {imports}", module.name, module.summary, "");
    }
    print(&text)
}

pub fn link(arguments: &LinkArguments) -> Result<(), CliError> {
    let linked = linked(arguments)?;
    dpsm::validate(&linked)?;
    write_or_print(arguments.output.as_deref(), &linked.text)
}

/// What the names or the file ask for.
pub fn linked(arguments: &LinkArguments) -> Result<Linked, CliError> {
    Ok(match arguments.names.as_slice() {
        [file] if is_file(file) => link_file(Path::new(file))?,
        names => {
            if let Some(file) = names.iter().find(|name| is_file(name)) {
                let message = format!("{file} is a file: link one file, or modules by name");
                return Err(CliError::Usage(message));
            }
            dpsm::link(&names.iter().map(String::as_str).collect::<Vec<_>>())?
        }
    })
}

pub fn validate(arguments: &ValidateArguments) -> Result<(), CliError> {
    let validated = validated(arguments)?;
    print(&format!(
        "{}: valid, {} functions and {} entry points\n",
        arguments.file.display(),
        validated.module.functions.len(),
        validated.module.entry_points.len(),
    ))
}

/// What naga makes of the file.
pub fn validated(arguments: &ValidateArguments) -> Result<Validated, CliError> {
    Ok(dpsm::validate(&link_file(&arguments.file)?)?)
}

/// A module's name has neither a dot nor a slash.
fn is_file(name: &str) -> bool {
    name.contains(['.', '/', '\\']) || Path::new(name).is_file()
}

fn link_file(path: &Path) -> Result<Linked, CliError> {
    Ok(dpsm::link_source(&path.display().to_string(), &read_text(path)?)?)
}
