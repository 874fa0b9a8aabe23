//! `dpsm eval`: one function on the adapter, in the f32 port and in the f64 reference; or a search
//! for its largest error.

use std::path::{Path, PathBuf};

use clap::Args;
use dpsm::Catalogue;
use dpsm::accuracy::{Judge, Verdict, bits};
use dpsm::cases;
use dpsm::gpu::{Device, Evaluator, GpuError};
use dpsm::link::LinkError;
use dpsm::reflect::{Component, Kind, Signature};
use dpsm::scalar::ports::{self, Word};
use dpsm::ulp::{ulps_apart, ulps_off};

use super::number::whole;
use super::output::{check_output, print, write_or_print};
use super::table::Table;
use super::{AdapterChoice, CliError, search};

/// Evaluate one function: on the adapter, by the f32 port, by the f64 reference
#[derive(Debug, Args)]
#[command(after_help = "\
Writes CSV, one line for each component of each result: adapter and port, the f64 reference, how
many floats the adapter is from the port, how many ULP the port is from the reference, and the
share of the function's bound that the adapter's result takes (the port's where there is none);
`open` where WGSL promises nothing, `outside` above the bound, empty outside the function's domain.

With --exhaustive: one line a function, the port's largest error over so many inputs of its domain,
random, spaced evenly over all floats, and at edges; above the bound the exit code is 1.

Examples:
  dpsm eval --exhaustive -o errors.csv          (every function; hours)
  dpsm eval dpsm_project --exhaustive --count 1000000
  dpsm eval --list                              (functions and what they take)
  dpsm eval dpsm_project
  dpsm eval dpsm_project --input points.csv     (header p.x,p.y,p.z)
  dpsm eval dpsm_depth --input depths.csv -o errors.csv")]
pub struct EvalArguments {
    /// The function's name; with --exhaustive by default every function
    #[arg(required_unless_present_any = ["exhaustive", "list"])]
    function: Option<String>,
    /// Print every function that can be evaluated, with the components of its arguments
    #[arg(long, conflicts_with_all = ["function", "exhaustive", "input", "output"])]
    list: bool,
    /// Search the port's errors over the whole domain instead
    #[arg(long, conflicts_with = "input")]
    exhaustive: bool,
    /// Inputs of each function in a search
    #[arg(long, requires = "exhaustive", default_value = "100000000",
        value_parser = whole::<1, { u64::MAX }>, alias = "points")]
    count: u64,
    /// Inputs, one record a line; the header names the arguments' components. By default the
    /// function's named hard cases
    #[arg(long)]
    input: Option<PathBuf>,
    /// Write here instead of standard output
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// One input record.
pub struct Record {
    name: String,
    words: Vec<Word<f32>>,
}

pub fn eval(adapter: AdapterChoice, arguments: &EvalArguments) -> Result<(), CliError> {
    check_output(arguments.output.as_deref())?;
    if arguments.list {
        return print(&list()?);
    }
    if arguments.exhaustive {
        let function = arguments.function.as_deref();
        return search::search(function, arguments.count, arguments.output.as_deref());
    }
    let (signature, records) = inputs(arguments)?;
    let function = signature.name.as_str();
    let device = adapter.open()?;
    eprintln!("dpsm: {}", super::describe(device.as_ref()));
    let answers = device.map(|device| on_adapter(&device, function, &records)).transpose()?;
    let text = table(&signature, &records, answers.as_deref())?;
    write_or_print(arguments.output.as_deref(), &text)
}

/// What is evaluated, and at which records.
pub fn inputs(arguments: &EvalArguments) -> Result<(Signature, Vec<Record>), CliError> {
    let function = arguments.function.as_deref().unwrap_or_default();
    let signature = signature(function)?;
    let inputs = signature.inputs();
    let records = match &arguments.input {
        Some(path) => records(path, Table::read(path)?, &inputs)?,
        None => cases::of(function)
            .into_iter()
            .map(|case| Record { name: case.name, words: case.words })
            .collect(),
    };
    Ok((signature, records))
}

pub fn signature(function: &str) -> Result<Signature, CliError> {
    let unsupported = |reason| GpuError::Unsupported { function: function.to_string(), reason };
    let linked = dpsm::link::link_function(function).map_err(|error| match error {
        LinkError::UnknownFunction { .. } => {
            CliError::Usage(format!("{error}; `dpsm eval --list` shows all"))
        }
        error => error.into(),
    })?;
    let validated = dpsm::validate(&linked)?;
    let signature = Signature::of(&validated.module, function).map_err(unsupported)?;
    if signature.needs_resources() {
        let reason = "it takes a texture; `dpsm render` runs it on real maps".to_string();
        return Err(unsupported(reason).into());
    }
    Ok(signature)
}

/// Each function with what it takes: `dpsm_project(p.x, p.y, p.z)`.
fn list() -> Result<String, CliError> {
    let modules = Catalogue::dpsm()?.describe();
    let names: Vec<_> = modules.iter().map(|module| module.name.as_str()).collect();
    let validated = dpsm::validate(&dpsm::link(&names)?)?;
    let items = modules.iter().flat_map(|module| &module.items).filter(|item| item.kind == "fn");
    let mut lines: Vec<_> = items
        .filter_map(|item| Signature::of(&validated.module, &item.name).ok())
        .filter(|signature| !signature.needs_resources())
        .map(|signature| {
            let inputs: Vec<_> = signature.inputs().into_iter().map(|input| input.path).collect();
            format!("{}({})\n", signature.name, inputs.join(", "))
        })
        .collect();
    lines.sort();
    Ok(lines.concat())
}

fn on_adapter(device: &Device, function: &str, records: &[Record]) -> Result<Vec<u32>, CliError> {
    let words: Vec<u32> =
        records.iter().flat_map(|record| record.words.iter().map(|&word| bits(word))).collect();
    Ok(Evaluator::new(device, function)?.run(&words, None)?.words)
}

fn table(
    signature: &Signature,
    records: &[Record],
    answers: Option<&[u32]>,
) -> Result<String, CliError> {
    let outputs = signature.outputs();
    let judge = Judge::of(&signature.name);
    let mut writer = csv::Writer::from_writer(Vec::new());
    let broken = |error: csv::Error| CliError::Usage(format!("cannot write the table: {error}"));
    writer
        .write_record([
            "record",
            "component",
            "adapter",
            "port_f32",
            "reference_f64",
            "floats_adapter_port",
            "ulp_port_reference",
            "share_of_bound",
        ])
        .map_err(broken)?;
    for (index, record) in records.iter().enumerate() {
        let port = call(signature, &record.words)?;
        let exact: Vec<_> = record.words.iter().map(widen).collect();
        let reference = call(signature, &exact)?;
        let word = |(k, component): (usize, &Component)| match (answers, component.kind) {
            (None, _) => port[k],
            (Some(all), Kind::Float) => Word::Float(f32::from_bits(all[index * outputs.len() + k])),
            (Some(all), _) => Word::Integer(all[index * outputs.len() + k]),
        };
        let answer: Vec<_> = outputs.iter().enumerate().map(word).collect();
        let judged = judge.as_ref().and_then(|judge| judge.judge(&record.words, &answer));
        let share = judged.map_or(String::new(), |judged| match judged.verdict {
            Verdict::Open => "open".into(),
            Verdict::Broken => "outside".into(),
            _ => format!("{:.3}", judged.error.share()),
        });
        for (k, component) in outputs.iter().enumerate() {
            let adapter = answers.map(|answers| answers[index * outputs.len() + k]);
            let name = match component.path.trim_start_matches('.') {
                "" => "result",
                path => path,
            };
            let (port, reference) = (port[k], reference[k]);
            let row = match (port, reference) {
                (Word::Float(port), Word::Float(reference)) => [
                    adapter.map(|bits| f32::from_bits(bits).to_string()).unwrap_or_default(),
                    port.to_string(),
                    reference.to_string(),
                    adapter
                        .map(|bits| ulps_apart(f32::from_bits(bits), port).to_string())
                        .unwrap_or_default(),
                    format!("{:.3}", ulps_off(port, reference)),
                ],
                (port, reference) => [
                    adapter.map(|bits| bits.to_string()).unwrap_or_default(),
                    integer(port).to_string(),
                    integer(reference).to_string(),
                    adapter
                        .map(|bits| bits.abs_diff(integer(port)).to_string())
                        .unwrap_or_default(),
                    integer(port).abs_diff(integer(reference)).to_string(),
                ],
            };
            let [adapter, port, reference, apart, off] = &row;
            writer
                .write_record([&record.name, name, adapter, port, reference, apart, off, &share])
                .map_err(broken)?;
        }
    }
    let bytes = writer.into_inner().map_err(|error| CliError::Usage(error.to_string()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn call<T>(signature: &Signature, words: &[Word<T>]) -> Result<Vec<Word<T>>, CliError>
where
    T: dpsm::scalar::float::Float + ports::Flat<T>,
{
    ports::call(&signature.name, words)
        .ok_or_else(|| CliError::Usage(format!("`{}` has no port", signature.name)))
}

fn widen(word: &Word<f32>) -> Word<f64> {
    match *word {
        Word::Float(value) => Word::Float(f64::from(value)),
        Word::Integer(value) => Word::Integer(value),
    }
}

fn integer<T>(word: Word<T>) -> u32 {
    match word {
        Word::Integer(value) => value,
        Word::Float(_) => 0,
    }
}

/// Records by the header's names; a last part of a name is enough where it is unique.
pub fn records(path: &Path, table: Table, inputs: &[Component]) -> Result<Vec<Record>, CliError> {
    let header = &table.header;
    let csv_error = |line: u64, message: String| CliError::Csv { path: path.into(), line, message };
    let wanted = inputs.iter().map(|c| c.path.as_str()).collect::<Vec<_>>().join(",");
    let column = |component: &Component| {
        let full = header.iter().position(|name| *name == component.path);
        let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_string();
        let unique = inputs.iter().filter(|c| last(&c.path) == last(&component.path)).count() == 1;
        let short = || header.iter().position(|name| unique && *name == last(&component.path));
        full.or_else(short).ok_or_else(|| {
            csv_error(1, format!("no column `{}`; the header must name {wanted}", component.path))
        })
    };
    let columns = inputs.iter().map(column).collect::<Result<Vec<_>, _>>()?;
    let mut records = Vec::new();
    for (index, (line, row)) in table.records.iter().enumerate() {
        let parse = |(component, &column): (&Component, &usize)| {
            let field = row[column].as_str();
            word(field, component.kind).ok_or_else(|| {
                let kind = component.kind.wgsl();
                csv_error(*line, format!("column `{}`: `{field}` is no {kind}", component.path))
            })
        };
        let words = inputs.iter().zip(&columns).map(parse).collect::<Result<Vec<_>, _>>()?;
        records.push(Record { name: format!("{}", index + 1), words });
    }
    Ok(records)
}

fn word(field: &str, kind: Kind) -> Option<Word<f32>> {
    match kind {
        Kind::Float => field.parse().ok().map(Word::Float),
        Kind::Unsigned => field.parse().ok().map(Word::Integer),
        Kind::Signed => field.parse::<i32>().ok().map(|value| Word::Integer(value as u32)),
        Kind::Bool => field.parse::<bool>().ok().map(|value| Word::Integer(value.into())),
    }
}
