//! The commands on module text: modules, link, validate.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dpsm::link::Features;
use dpsm::{Catalogue, Linked, Validated};

use super::output::{print, write_or_print};
use super::{CliError, tint};

/// Link modules, items or a shader of your own into one plain WGSL text
///
/// What only another tool understands is passed on as it is, and named on stderr: extensions,
/// placeholders, `#ifdef`, and `@if` where no feature is given.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  dpsm link visibility
  dpsm link paraboloid::dpsm_project hemisphere
  dpsm link my-shader.wesl -o my-shader.wgsl
  dpsm link my-shader.wesl --feature SOFT --feature DEBUG=false
  dpsm link my-shader.wesl --module ../common/noise.wesl --validate")]
pub struct LinkArguments {
    /// Modules (`depth`), items (`depth::dpsm_depth`), or one file that imports them
    #[arg(required = true, value_name = "NAMES|FILE")]
    names: Vec<String>,
    #[command(flatten)]
    sources: Sources,
    /// Ask naga whether the result is valid
    #[arg(long)]
    validate: bool,
    /// Write here instead of standard output
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// Check a shader of your own that imports dpsm modules
///
/// naga checks everything but uniformity: whether derivatives and textureSample are called where all
/// invocations come by. --tint asks Tint, the compiler of Chrome, which does check that.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  dpsm validate my-shader.wesl
  dpsm validate my-shader.wesl --tint           (needs node and npm)
  dpsm validate my-shader.wesl --feature SOFT --feature '*=false'")]
pub struct ValidateArguments {
    /// A WGSL or WESL file
    file: PathBuf,
    #[command(flatten)]
    sources: Sources,
    /// Ask Tint too, by node and its package `webgpu`, which is installed once into DPSM_TINT, by
    /// default a folder of the user's cache
    #[arg(long)]
    tint: bool,
}

/// What else goes into a linked text, and what is decided in it.
#[derive(Debug, Default, Args)]
struct Sources {
    /// A module of your own, which imports find by its file's name; those beside the shader are
    /// found without. May be given several times
    #[arg(long = "module", value_name = "PATH")]
    modules: Vec<PathBuf>,
    /// Turns a feature of `@if` on, or off by NAME=false; `*=false` is for all that are not named.
    /// May be given several times
    #[arg(long = "feature", value_name = "NAME[=BOOL]", value_delimiter = ',',
        value_parser = parse_feature)]
    features: Vec<(String, bool)>,
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
    if arguments.validate {
        dpsm::validate(&linked)?;
    }
    say_notes(&linked);
    write_or_print(arguments.output.as_deref(), &linked.text)
}

/// What the names or the file ask for.
pub fn linked(arguments: &LinkArguments) -> Result<Linked, CliError> {
    let catalogue = arguments.sources.catalogue()?;
    Ok(match arguments.names.as_slice() {
        [file] if is_file(file) => catalogue.link_file(file)?,
        names => {
            if let Some(file) = names.iter().find(|name| is_file(name)) {
                let message = format!("{file} is a file: link one file, or modules by name");
                return Err(CliError::Usage(message));
            }
            catalogue.link(&names.iter().map(String::as_str).collect::<Vec<_>>())?
        }
    })
}

pub fn validate(arguments: &ValidateArguments) -> Result<(), CliError> {
    let (linked, validated) = validated(arguments)?;
    say_notes(&linked);
    let mut text = format!(
        "{}: valid by naga, {} functions and {} entry points\n",
        arguments.file.display(),
        validated.module.functions.len(),
        validated.module.entry_points.len(),
    );
    match arguments.tint {
        true => text += &tint::check(&linked)?,
        false => text += &uniformity(&linked, &validated),
    }
    print(&text)
}

/// What naga makes of the file.
pub fn validated(arguments: &ValidateArguments) -> Result<(Linked, Validated), CliError> {
    let catalogue = arguments.sources.catalogue()?;
    let name = arguments.file.to_string_lossy();
    if !is_file(&name) && catalogue.link(&[&*name]).is_ok() {
        let message =
            format!("`{name}` is a module, not a file; `dpsm link {name} --validate` checks it");
        return Err(CliError::Usage(message));
    }
    let linked = catalogue.link_file(&arguments.file)?;
    let validated = dpsm::validate(&linked)?;
    Ok((linked, validated))
}

/// What naga does not check, and where that matters.
fn uniformity(linked: &Linked, validated: &Validated) -> String {
    /// Places that the message lists at the most.
    const LISTED: usize = 4;
    let places = validated.unchecked(linked);
    if places.is_empty() {
        return "not checked: uniformity, which nothing here asks for\n".into();
    }
    let place = |label: &dpsm::validate::Label| {
        let call = label.source.chars().skip(label.column - 1).take(label.length);
        let call: String = call.collect();
        let name = call.split('(').next().unwrap_or_default().trim();
        format!("{}:{}:{} (`{name}`)", label.file, label.line, label.column)
    };
    let list: Vec<_> = places.iter().take(LISTED).map(place).collect();
    let more = match places.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!(
        "not checked: uniformity. It is an error of WGSL if not all invocations come by {}{more}; \
         `dpsm validate --tint` asks Tint\n",
        list.join(", ")
    )
}

fn say_notes(linked: &Linked) {
    for note in linked.notes() {
        eprintln!("dpsm: {note}");
    }
}

impl Sources {
    fn catalogue(&self) -> Result<Catalogue, CliError> {
        let features = self.features.iter().fold(Features::new(), |features, (name, on)| {
            if name == "*" { features.others(*on) } else { features.with(name, *on) }
        });
        let catalogue = Catalogue::dpsm()?.features(features);
        Ok(self.modules.iter().try_fold(catalogue, Catalogue::with_file)?)
    }
}

/// Parses `NAME`, `NAME=true` or `NAME=false`.
fn parse_feature(text: &str) -> Result<(String, bool), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "true"));
    let on = match value.trim() {
        "true" => true,
        "false" => false,
        other => return Err(format!("`{other}` is neither `true` nor `false`")),
    };
    let name = name.trim();
    let word = |c: char| c == '_' || c.is_alphanumeric();
    match !name.is_empty() && name.chars().all(word) || name == "*" && text.contains('=') {
        true => Ok((name.to_owned(), on)),
        false => Err(format!("`{name}` is no name of a feature")),
    }
}

/// A module's name has neither a dot nor a slash.
fn is_file(name: &str) -> bool {
    name.contains(['.', '/', '\\']) || Path::new(name).is_file()
}
