//! Runs of the program in a folder with files from before, with faults or without.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use dpsm::gpu::Device;

/// When a run is taken for endless: all end within seconds.
const LONG: Duration = Duration::from_secs(60);

/// What an older file of the same name holds.
const OLD: &str = "from before";

/// The adapter for one test at a time, subprocesses included.
pub fn adapter() -> Option<(Device, MutexGuard<'static, ()>)> {
    static ALONE: Mutex<()> = Mutex::new(());
    let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    crate::common::device().map(|device| (device, alone))
}

/// An empty folder of its own for each test.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("faults-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Every folder and file in a folder, with what it holds.
pub fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let bytes = match path.is_dir() {
            true => {
                files.extend(contents(&path));
                Vec::new()
            }
            false => std::fs::read(&path).unwrap(),
        };
        files.push((path, bytes));
    }
    files.sort();
    files
}

/// A command that writes files, the first of which is there from before.
pub struct Writes {
    pub name: &'static str,
    pub arguments: &'static [&'static str],
    pub files: &'static [&'static str],
}

pub const RENDER: Writes = Writes {
    name: "render",
    arguments: &[
        "render", "seam-box", "--size", "32", "--image", "16x16", "--maps", "-o", "room.png",
    ],
    files: &[
        "room.png",
        "room-back-map.png",
        "room-back-view.png",
        "room-front-map.png",
        "room-front-view.png",
    ],
};
pub const BAKE: Writes = Writes {
    name: "bake",
    arguments: &["bake", "seam-box", "--size", "32", "-o", "maps.exr"],
    files: &["maps.exr", "maps.json"],
};
pub const PROBE: Writes = Writes {
    name: "probe",
    arguments: &["probe", "seam-box", "--size", "32", "--points", "points.csv", "-o", "judged.csv"],
    files: &["judged.csv"],
};
pub const EVAL: Writes = Writes {
    name: "eval",
    arguments: &["eval", "dpsm_project", "-o", "errors.csv"],
    files: &["errors.csv"],
};
pub const LINK: Writes = Writes {
    name: "link",
    arguments: &["link", "visibility", "-o", "linked.wgsl"],
    files: &["linked.wgsl"],
};
/// Writes nothing; its table must not appear in part.
pub const MEASURE: Writes = Writes {
    name: "measure",
    arguments: &["measure", "seam-box", "--size", "32", "--count", "20"],
    files: &[],
};

/// What a run gave.
#[derive(Debug)]
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
    /// From its start to its end.
    pub took: Duration,
}

impl Writes {
    /// A folder where the first file is there from before, and what the command reads.
    pub fn folder(&self, test: &str) -> PathBuf {
        let folder = folder(&format!("{test}-{}", self.name));
        std::fs::write(folder.join("points.csv"), "x,y,z\n0.5,0,0.5\n").unwrap();
        if let Some(first) = self.files.first() {
            std::fs::write(folder.join(first), OLD).unwrap();
        }
        folder
    }

    /// The command for a shell that limits it, or with variables of the environment.
    pub fn run(
        &self,
        folder: &Path,
        adapter: &str,
        shell: &str,
        variables: &[(&str, &str)],
    ) -> Run {
        let mut command = Command::new("sh");
        let script = format!("{shell} exec \"$@\"");
        command.args(["-c", &script, "sh", env!("CARGO_BIN_EXE_dpsm")]);
        command.args(self.arguments).args(["--adapter", adapter]);
        run(command.current_dir(folder).envs(variables.iter().copied()))
    }

    /// With a fault as layer.rs reads it.
    pub fn struck(&self, folder: &Path, adapter: &str, fault: &str, more: &[(&str, &str)]) -> Run {
        let path = layer().display().to_string();
        let layer = [
            ("VK_LAYER_PATH", &*path),
            ("VK_INSTANCE_LAYERS", "VK_LAYER_DPSM_faults"),
            ("DPSM_FAULT", fault),
        ];
        self.run(folder, adapter, "", &[&layer, more].concat())
    }

    /// With the N-th call of a Vulkan function at fault; true where the run was long enough for it.
    /// Where it was, the program must fail whole: exit code 1, one message with its remedy and one of
    /// `parts`, no output and every file as before.
    pub fn fails_at(&self, test: &str, fault: &str, parts: &[&str]) -> bool {
        self.fails_with(test, fault, parts, &[])
    }

    /// The same with more variables of the environment.
    pub fn fails_with(
        &self,
        test: &str,
        fault: &str,
        parts: &[&str],
        more: &[(&str, &str)],
    ) -> bool {
        let folder = self.folder(test);
        let before = contents(&folder);
        let run = self.struck(&folder, "gpu", fault, more);
        if run.code == Some(0) {
            for file in self.files {
                let bytes = std::fs::read(folder.join(file)).unwrap();
                assert!(!bytes.is_empty() && bytes != OLD.as_bytes(), "{file}: {run:?}");
            }
            return false;
        }
        assert!(parts.iter().any(|part| run.stderr.contains(part)), "{fault}: {run:?}");
        run.failed(fault, 1, "--adapter cpu");
        assert_eq!(contents(&folder), before, "{fault}: {run:?}");
        true
    }
}

impl Run {
    /// One message that names the remedy, and nothing that looks like a result.
    pub fn failed(&self, context: &str, code: i32, remedy: &str) {
        assert_eq!(self.code, Some(code), "{context}: {self:?}");
        assert!(self.stderr.contains(remedy), "{context}: {self:?}");
        assert!(!self.stderr.contains("panicked"), "{context}: {self:?}");
        assert_eq!(self.stdout, "", "{context}");
    }
}

/// Runs a command to its end, or ends it where it does not by itself.
pub fn run(command: &mut Command) -> Run {
    let start = Instant::now();
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // what these print fits into a pipe
    while child.try_wait().unwrap().is_none() {
        match start.elapsed() < LONG {
            true => std::thread::sleep(Duration::from_millis(5)),
            false => child.kill().unwrap(),
        }
    }
    let output = child.wait_with_output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Run {
        code: output.status.code(),
        stdout: text(&output.stdout),
        stderr: text(&output.stderr),
        took: start.elapsed(),
    }
}

/// The folder of the Vulkan layer layer.rs, which is compiled once.
fn layer() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = folder("layer");
        let library = folder.join("libfaults.so");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults/layer.rs");
        let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        let mut command = Command::new(compiler);
        command.args(["--edition=2024", "--crate-type=cdylib", "--crate-name=faults"]);
        let built = run(command.arg(source).arg("-o").arg(&library));
        assert_eq!(built.code, Some(0), "{}", built.stderr);
        let manifest = serde_json::json!({
            "file_format_version": "1.0.0",
            "layer": {
                "name": "VK_LAYER_DPSM_faults",
                "type": "GLOBAL",
                "library_path": library,
                "api_version": "1.1.0",
                "implementation_version": "1",
                "description": "a driver that fails",
            },
        });
        std::fs::write(folder.join("faults.json"), manifest.to_string()).unwrap();
        folder
    })
}
