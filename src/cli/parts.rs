//! The folder of a report: what is finished of it, and the files that show that.

use std::path::{Path, PathBuf};

use dpsm::gpu::Device;
use dpsm::report::data::{Image, Machine, Report, Timing, VERSION};
use dpsm::report::{self, Effort, Part, Subject, page, parameterisations, table};

use super::CliError;
use super::measure::pretty;
use super::output::Outputs;

/// The name of the part that is no scene.
pub const COSTS: &str = "costs";

/// Parts of a report in the order of the page, the costs last.
pub struct Parts {
    folder: PathBuf,
    machine: Machine,
    timing: Timing,
    parts: Vec<Wanted>,
}

struct Wanted {
    name: String,
    fingerprint: String,
    part: Option<Part>,
}

impl Parts {
    /// Nothing finished yet, and a folder for it.
    pub fn new(
        folder: &Path,
        device: Option<&Device>,
        effort: &Effort,
        subjects: &[Subject],
    ) -> Result<Self, CliError> {
        let parts = folder.join("parts");
        std::fs::create_dir_all(&parts).map_err(|source| CliError::Write {
            path: folder.into(),
            source,
            remedy: "--folder",
        })?;
        let machine = report::machine(device);
        let common = format!("{}; {}; {effort:?}", program(), machine.computed_by);
        let scene = |subject: &Subject| Wanted {
            name: subject.name.clone(),
            fingerprint: format!("{common}; scene {:016x}", subject.hash()),
            part: None,
        };
        let mut parts: Vec<Wanted> = subjects.iter().map(scene).collect();
        parts.push(Wanted { name: COSTS.into(), fingerprint: common, part: None });
        let timing = report::timing(effort, device.is_none());
        Ok(Self { folder: folder.into(), machine, timing, parts })
    }

    /// Takes the parts that an earlier run has finished. Others are named on stderr, to be made
    /// again.
    pub fn take_up(&mut self) {
        for wanted in &mut self.parts {
            let path = path(&self.folder, &wanted.name);
            let text = match std::fs::read_to_string(&path) {
                Ok(text) => text,
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
                Err(error) => {
                    eprintln!("dpsm: cannot read {}: {error}; made again", path.display());
                    continue;
                }
            };
            match serde_json::from_str::<Part>(&text) {
                Ok(part) if part.fingerprint == wanted.fingerprint => wanted.part = Some(part),
                Ok(_) => eprintln!(
                    "dpsm: {} is of another program, adapter, scene or option; made again",
                    path.display()
                ),
                Err(error) => eprintln!(
                    "dpsm: {} is no part of a report: {error}; made again",
                    path.display()
                ),
            }
        }
    }

    /// The parts' names.
    pub fn names(&self) -> Vec<String> {
        self.parts.iter().map(|wanted| wanted.name.clone()).collect()
    }

    /// True of a part that is finished.
    pub fn is_finished(&self, place: usize) -> bool {
        self.parts.get(place).is_some_and(|wanted| wanted.part.is_some())
    }

    /// Writes a part that is finished, if there is one, and the report on all that are: each file
    /// is whole at any time.
    pub fn write(&mut self, finished: Option<(usize, Part)>) -> Result<(), CliError> {
        let mut outputs = Outputs::for_option("--folder");
        if let Some((place, part)) = finished
            && let Some(wanted) = self.parts.get_mut(place)
        {
            let part = Part { fingerprint: wanted.fingerprint.clone(), ..part };
            let text = serde_json::to_string(&part);
            let text = text.map_err(|error| CliError::Usage(format!("no JSON: {error}")))?;
            outputs.add(&path(&self.folder, &wanted.name), text.into())?;
            wanted.part = Some(part);
        }
        let (report, images) = self.report();
        let [html, json, csv_path] = self.outputs();
        outputs.add(&html, page::page(&report, &images).into())?;
        outputs.add(&json, pretty(&report)?.into())?;
        let broken =
            |error: csv::Error| CliError::Usage(format!("cannot write the table: {error}"));
        outputs.add(&csv_path, table::csv(&report).map_err(broken)?)?;
        outputs.finish().map(drop)
    }

    /// The three files of a report.
    pub fn outputs(&self) -> [PathBuf; 3] {
        ["report.html", "report.json", "report.csv"].map(|name| self.folder.join(name))
    }

    /// The report on what is finished, and its pictures.
    fn report(&self) -> (Report, Vec<Image>) {
        let parts = || self.parts.iter().filter_map(|wanted| wanted.part.as_ref());
        let unfinished = self.parts.iter().filter(|wanted| wanted.part.is_none());
        let report = Report {
            version: VERSION,
            machine: self.machine.clone(),
            timing: Timing { empty_pass: parts().find_map(|part| part.empty_pass), ..self.timing },
            scenes: parts().filter_map(|part| part.scene.clone()).collect(),
            parameterisations: parameterisations::parameterisations(),
            costs: parts().flat_map(|part| part.costs.clone()).collect(),
            unfinished: unfinished.map(|wanted| wanted.name.clone()).collect(),
        };
        (report, parts().flat_map(|part| part.images.clone()).collect())
    }
}

fn path(folder: &Path, name: &str) -> PathBuf {
    folder.join("parts").join(format!("{name}.json"))
}

/// The program: its version, and the length and age of its file, which differ from build to build.
fn program() -> String {
    let file = std::env::current_exe().and_then(std::fs::metadata);
    let built = file.ok().map(|file| {
        let since = file.modified().ok().and_then(|t| t.duration_since(std::time::UNIX_EPOCH).ok());
        format!(" of {} bytes, {:?}", file.len(), since.unwrap_or_default())
    });
    format!("dpsm {}{}", env!("CARGO_PKG_VERSION"), built.unwrap_or_default())
}
