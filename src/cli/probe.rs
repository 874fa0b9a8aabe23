//! `dpsm probe`: given points, by the maps and by ray casting.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dpsm::measure::{self, Bench, Judgement};
use dpsm::render::LARGEST;
use glam::DVec3;
use serde::Serialize;

use super::measure::{bar, prepare, pretty};
use super::output::{check_output, write_or_print};
use super::setup::SetupArguments;
use super::table::Table;
use super::{AdapterChoice, CliError, describe};

/// Judge points given in a CSV file: by the maps, and by ray casting
#[derive(Debug, Args)]
#[command(after_help = "\
The input's header is x,y,z or x,y,z,nx,ny,nz: world units, unit normals. One line of output for
each line of input, in its order, with the header
visibility,hemisphere,u,v,stored,own,truth,edge: u and v are disk coordinates in the hemisphere's
map, and for a cube its face 0 to 5 (+x, -x, +y, -y, +z, -z) and the place on the face's plane at
distance 1; stored and own distances from the light, truth 1 where ray casting sees the light, edge 1
where the rays over the texel's footprint do not all agree. Nothing is chosen at random.

Example:
  dpsm probe brabec-room --points points.csv --size 512 -o judged.csv")]
pub struct ProbeArguments {
    #[command(flatten)]
    pub setup: SetupArguments,
    /// The points
    #[arg(long)]
    pub points: PathBuf,
    /// Write here instead of standard output
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// JSON in place of CSV
    #[arg(long)]
    json: bool,
}

/// A position, with its unit normal where the file gives it.
pub type Point = (DVec3, Option<DVec3>);

/// `dpsm probe`.
pub fn probe(adapter: AdapterChoice, arguments: &ProbeArguments) -> Result<(), CliError> {
    check_output(arguments.output.as_deref())?;
    let given = points(&arguments.points, Table::read(&arguments.points)?)?;
    let (_, frame, maps, device) = prepare(adapter, &arguments.setup)?;
    eprintln!("dpsm: {}", describe(device.as_ref()));
    let truth = measure::truth_of(&frame);
    let bench = Bench::new(&frame, &maps, &truth);
    let progress = bar("points", given.len());
    let judge = |&(position, normal): &Point| {
        progress.inc(1);
        measure::judge(&bench, &bench.point_at(position - frame.origin, normal))
    };
    let judged: Vec<Judgement> = given.iter().map(judge).collect();
    progress.finish_and_clear();
    let (near, far) = (bench.light.near, bench.light.far);
    let outside = judged.iter().filter(|judged| !judged.inside).count();
    if outside > 0 {
        eprintln!(
            "dpsm: {outside} points lie inside near {near} or beyond far {far}: compared there"
        );
    }
    let text = match arguments.json {
        true => pretty(&judged.iter().map(row).collect::<Vec<_>>())?,
        false => {
            let mut text = String::from("visibility,hemisphere,u,v,stored,own,truth,edge\n");
            for judgement in &judged {
                let Row { visibility, hemisphere, u, v, stored, own, truth, edge } = row(judgement);
                let stored = stored.unwrap_or(f64::INFINITY);
                let _ = writeln!(
                    text,
                    "{visibility},{hemisphere},{u},{v},{stored},{own},{truth},{edge}"
                );
            }
            text
        }
    };
    write_or_print(arguments.output.as_deref(), &text)
}

/// One line of `dpsm probe`.
#[derive(Serialize)]
struct Row {
    visibility: f32,
    hemisphere: u32,
    u: f64,
    v: f64,
    /// `None` (null) where the texel is empty: JSON has no infinity.
    stored: Option<f64>,
    own: f64,
    truth: u8,
    edge: u8,
}

fn row(judgement: &Judgement) -> Row {
    Row {
        visibility: judgement.visibility,
        hemisphere: judgement.hemisphere,
        u: judgement.uv[0],
        v: judgement.uv[1],
        stored: judgement.stored.is_finite().then_some(judgement.stored),
        own: judgement.own,
        truth: judgement.lit.into(),
        edge: judgement.edge.into(),
    }
}

/// Positions, with normals where the header has them.
pub fn points(path: &Path, table: Table) -> Result<Vec<Point>, CliError> {
    let fault = |line: u64, message: String| CliError::Csv { path: path.into(), line, message };
    let names = ["x", "y", "z", "nx", "ny", "nz"];
    let header: Vec<&str> = table.header.iter().map(String::as_str).collect();
    if header != names[..3] && header != names {
        let found = header.join(",");
        let message = format!("the header is `{found}`, and must be x,y,z or x,y,z,nx,ny,nz");
        return Err(fault(1, message));
    }
    let mut points = Vec::new();
    for (line, record) in table.records {
        let mut numbers = [0.0; 6];
        for ((field, name), number) in record.iter().zip(names).zip(&mut numbers) {
            // as for the light: beyond it squares of distances overflow f32
            let usable = |value: &f64| value.abs() <= f64::from(LARGEST);
            let parsed: Option<f64> = field.parse().ok().filter(usable);
            *number = parsed.ok_or_else(|| {
                let range = "is not a finite number up to 1e18";
                fault(line, format!("column `{name}`: `{field}` {range}"))
            })?;
        }
        let [x, y, z, nx, ny, nz] = numbers;
        let normal = match header.len() {
            6 => {
                let normal = DVec3::new(nx, ny, nz);
                if (normal.length() - 1.0).abs() > 1e-3 {
                    let message =
                        format!("columns `nx,ny,nz`: the normal {normal} is not a unit one");
                    return Err(fault(line, message));
                }
                Some(normal.normalize())
            }
            _ => None,
        };
        points.push((DVec3::new(x, y, z), normal));
    }
    Ok(points)
}
