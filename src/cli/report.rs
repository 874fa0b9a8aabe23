//! `dpsm report`: every method's speed and error in some scenes, in one page.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use dpsm::gpu::Device;
use dpsm::report::data::Report;
use dpsm::report::{self, Effort, Job, Part, Subject, compare};
use dpsm::scene::BUILT_IN;
use glam::DVec3;
use indicatif::{ProgressBar, ProgressStyle};

use super::number::{ANY, whole, whole32};
use super::output::{print, read_text};
use super::parts::{COSTS, Parts};
use super::render::parse_size;
use super::setup::{has_walls, no_cast, open};
use super::{AdapterChoice, CliError, describe, parse_vector};

/// Where a report goes unless another folder is named.
pub const FOLDER: &str = "dpsm-report";

const SMALLEST: u64 = Effort::SMALLEST as u64;

/// Report on scenes: speed and error of every method, size and filter, with pictures
#[derive(Debug, Args)]
#[command(after_help = "\
Writes report.html (all in one file), report.json and report.csv (every figure) into the folder, and
parts/SCENE.json as each scene is finished. An interrupted run leaves a report on the finished part;
run again, it takes up parts that the same program made of the same scene with the same adapter and
options, and does the rest. docs/report.md explains each figure.

The ports (--adapter cpu) are slow: smaller maps, fewer variants, points, runs and kinds of cost.

Examples:
  dpsm report
  dpsm report brabec-room cornell
  dpsm report atrium.obj --light 0,4,0 -o atrium
  dpsm report brabec-room --walls 1 --size 512 --fresh
  dpsm report --compare before/report.json after/report.json")]
pub struct ReportArguments {
    /// Built-in scenes, or .obj, .gltf or .glb files; by default all built-in ones
    scenes: Vec<String>,
    /// The folder to write into
    #[arg(short = 'o', long, default_value = FOLDER)]
    folder: PathBuf,
    /// Measure all again, also what the folder holds from an earlier run
    #[arg(long)]
    fresh: bool,
    /// The light's position in every scene; by default each scene's own light
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    light: Option<DVec3>,
    /// A mesh that casts no shadow, by its name, in each scene that has it; several by one option each
    #[arg(long, value_name = "NAME")]
    no_cast: Vec<String>,
    /// Quads along a side of a built-in room's wall, by default 8; 1 gives two triangles
    #[arg(long, value_name = "N", value_parser = whole32::<0, ANY>)]
    walls: Option<u32>,
    /// Texels along a side of the largest maps, the others having half and a quarter; by default
    /// 1024, or 256 by the ports
    #[arg(long, value_name = "N", value_parser = whole32::<SMALLEST, ANY>)]
    size: Option<u32>,
    /// Width and height of the pictures
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    image: Option<[u32; 2]>,
    /// Points that are judged in each scene; by default 2000, or 1000 by the ports
    #[arg(long, value_name = "N", value_parser = whole32::<1, 1_000_000>, alias = "points")]
    count: Option<u32>,
    /// Chooses the points; the same seed chooses the same ones
    #[arg(long, value_parser = whole::<0, { u64::MAX }>, default_value_t = 1)]
    seed: u64,
    /// Timed runs of each variant; by default 5, or 2 by the ports
    #[arg(long, value_name = "N", value_parser = whole32::<1, 1000>)]
    runs: Option<u32>,
    /// Say what changed from one report.json to another, and write nothing
    #[arg(long, num_args = 2, value_names = ["A.json", "B.json"], exclusive = true)]
    compare: Option<Vec<PathBuf>>,
}

impl ReportArguments {
    /// All built-in scenes.
    pub fn all(folder: &Path) -> Self {
        Self {
            scenes: Vec::new(),
            folder: folder.into(),
            fresh: false,
            light: None,
            no_cast: Vec::new(),
            walls: None,
            size: None,
            image: None,
            count: None,
            seed: 1,
            runs: None,
            compare: None,
        }
    }

    fn effort(&self, ports: bool) -> Effort {
        let usual = Effort::usual(ports);
        Effort {
            size: self.size.unwrap_or(usual.size),
            image: self.image.unwrap_or(usual.image),
            points: self.count.map_or(usual.points, |count| count as usize),
            seed: self.seed,
            runs: self.runs.unwrap_or(usual.runs),
        }
    }
}

/// The scenes, each with a name of its own, checked before an adapter is opened; warnings go to
/// stderr.
pub fn subjects(arguments: &ReportArguments) -> Result<Vec<Subject>, CliError> {
    let all = || BUILT_IN.iter().map(|(name, _)| name.to_string()).collect();
    let asked = if arguments.scenes.is_empty() { all() } else { arguments.scenes.clone() };
    let mut subjects: Vec<Subject> = Vec::new();
    let mut unknown = arguments.no_cast.clone();
    for (place, wanted) in asked.iter().enumerate() {
        if asked[..place].contains(wanted) {
            return Err(CliError::Usage(format!("{wanted} is named twice; name each scene once")));
        }
        // of all scenes, those that have walls
        let named = !arguments.scenes.is_empty();
        let walls = arguments.walls.filter(|_| named || has_walls(wanted));
        let scene = open(wanted, walls, arguments.light)?;
        let here = |name: &&String| scene.meshes.iter().any(|mesh| mesh.name == **name);
        let named: Vec<String> = arguments.no_cast.iter().filter(here).cloned().collect();
        unknown.retain(|name| !named.contains(name));
        let no_cast = no_cast(&scene, &named)?;
        let mut subject = Subject { no_cast, ..Subject::new(scene, arguments.light) };
        let stem = subject.name.clone();
        let taken = |name: &String| name == COSTS || subjects.iter().any(|s| s.name == *name);
        let names = std::iter::once(stem.clone()).chain((2..).map(|n| format!("{stem}-{n}")));
        if let Some(name) = names.into_iter().find(|name| !taken(name)) {
            subject.name = name;
        }
        subject.check(&arguments.effort(false))?;
        subjects.push(subject);
    }
    if let Some(name) = unknown.first() {
        let message = format!("--no-cast {name}: none of the scenes has a mesh of that name");
        return Err(CliError::Usage(message));
    }
    Ok(subjects)
}

/// `dpsm report`.
pub fn report(adapter: AdapterChoice, arguments: &ReportArguments) -> Result<(), CliError> {
    if let Some(text) = compared(arguments)? {
        return print(&text);
    }
    let subjects = subjects(arguments)?;
    let device = adapter.open()?;
    let device = device.as_ref();
    let effort = arguments.effort(device.is_none());
    let mut parts = Parts::new(&arguments.folder, device, &effort, &subjects)?;
    if !arguments.fresh {
        parts.take_up();
    }
    parts.write(None)?;
    let mut text = format!("{}\n", describe(device));
    let style = ProgressStyle::with_template("[{bar:24}] {pos}/{len} {msg}");
    let bar = ProgressBar::new(subjects.len() as u64 + 1)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(100));
    for (place, name) in parts.names().into_iter().enumerate() {
        bar.set_position(place as u64);
        if parts.is_finished(place) {
            let _ = writeln!(text, "{name}: taken from an earlier run");
            continue;
        }
        let start = Instant::now();
        let part = made(device, &effort, subjects.get(place), |step| {
            bar.set_message(format!("{name}: {step}"));
        })?;
        parts.write(Some((place, part)))?;
        let _ = writeln!(text, "{name}: {:.1} s", start.elapsed().as_secs_f64());
    }
    bar.finish_and_clear();
    text.push_str("written:\n");
    for path in parts.outputs() {
        let _ = writeln!(text, "  {}", path.display());
    }
    print(&text)
}

/// A scene's part, or without one that of the costs.
fn made(
    device: Option<&Device>,
    effort: &Effort,
    subject: Option<&Subject>,
    step: impl Fn(&str),
) -> Result<Part, CliError> {
    let job = Job { device, effort, step: &step };
    Ok(match subject {
        Some(subject) => report::scene(&job, subject)?,
        None => report::costs(&job)?,
    })
}

/// What changed between two reports, where that is asked.
pub fn compared(arguments: &ReportArguments) -> Result<Option<String>, CliError> {
    let Some([a, b]) = arguments.compare.as_deref() else { return Ok(None) };
    let text = compare::compare(&read("A", a)?, &read("B", b)?);
    text.map(Some).map_err(|error| CliError::Usage(error.to_string()))
}

/// Reads a report.json.
fn read(name: &'static str, path: &Path) -> Result<Report, CliError> {
    compare::read(name, &read_text(path)?).map_err(|error| {
        let path = path.display();
        CliError::Usage(format!("{path}: {error}; name a report.json that `dpsm report` wrote"))
    })
}
