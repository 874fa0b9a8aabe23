//! Dawn with Tint, through the npm package `webgpu`: no line in common with wgpu and naga.
//!
//! Each call is a process of its own with a time limit, tried twice, so that an abort or a hang of
//! Dawn's is an error here. Dawn's toggles are left as they are.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use dpsm::gpu::entry_point;
use dpsm::reflect::Signature;

use super::Implementation;

/// Where `tools/webgpu` installs the package.
const PACKAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/target/tint");

/// The script; node looks for packages beside it.
const SCRIPT: &str = include_str!("dawn.mjs");

/// Tries of a process.
const TRIES: usize = 2;

/// Longest wait for a process to start, compile a function and run a million records.
const PATIENCE: Duration = Duration::from_secs(120);

/// Dawn in a child process.
pub struct Dawn {
    name: String,
}

/// Dawn where it runs, or why it does not.
pub fn open() -> Result<Dawn, String> {
    if !PathBuf::from(PACKAGE).join("node_modules/webgpu").is_dir() {
        return Err("the npm package webgpu is not installed (tools/webgpu)".into());
    }
    fs::write(script(), SCRIPT).map_err(|error| error.to_string())?;
    let mut dawn = Dawn { name: String::new() };
    dawn.name = node(&[])?.trim().into();
    Ok(dawn)
}

impl Implementation for Dawn {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn evaluate(&mut self, function: &str, words: &[u32]) -> Result<Option<Vec<u32>>, String> {
        let linked = dpsm::link::link_function(function).map_err(|error| error.to_string())?;
        let validated = dpsm::validate(&linked).map_err(|error| error.to_string())?;
        let signature = Signature::of(&validated.module, function)?;
        if signature.needs_resources() {
            return Ok(None); // what a texture holds is no record
        }
        let (taken, given) = (signature.inputs().len(), signature.outputs().len());
        let [shader, input, output] = ["wgsl", "in", "out"].map(file);
        let text = format!("{}\n{}", linked.text, entry_point(&signature));
        fs::write(&shader, text).map_err(|error| error.to_string())?;
        fs::write(&input, bytemuck::cast_slice(words)).map_err(|error| error.to_string())?;
        node(&[&shader, &input, &output, &taken.to_string(), &given.to_string()])?;
        let bytes = fs::read(&output).map_err(|error| error.to_string())?;
        if bytes.len() * taken != size_of_val(words) * given {
            return Err(format!("{} bytes of results for {} words", bytes.len(), words.len()));
        }
        Ok(Some(bytemuck::pod_collect_to_vec(&bytes)))
    }
}

fn script() -> PathBuf {
    PathBuf::from(PACKAGE).join("dawn.mjs")
}

/// A scratch file of this process.
fn file(kind: &str) -> String {
    format!("{}/dawn-{}.{kind}", env!("CARGO_TARGET_TMPDIR"), std::process::id())
}

/// Runs the script; gives what it prints.
fn node(arguments: &[&str]) -> Result<String, String> {
    let mut reason = String::new();
    for _ in 0..TRIES {
        match node_once(arguments) {
            Ok(printed) => return Ok(printed),
            Err(message) => reason = message,
        }
    }
    Err(reason)
}

fn node_once(arguments: &[&str]) -> Result<String, String> {
    // files, as a pipe that nobody reads could fill up
    let [printed, errors] = ["stdout", "stderr"].map(file);
    let open = |path: &str| fs::File::create(path).map_err(|error| error.to_string());
    let mut child = Command::new("node")
        .arg(script())
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(open(&printed)?)
        .stderr(open(&errors)?)
        .spawn()
        .map_err(|error| format!("node does not start: {error}"))?;
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let start = Instant::now();
    loop {
        match child.try_wait().map_err(|error| error.to_string())? {
            Some(status) if status.success() => return Ok(read(&printed)),
            Some(status) => return Err(format!("node: {status}: {}", reason(&read(&errors)))),
            None if start.elapsed() > PATIENCE => {
                let _ = child.kill(); // it may have ended by itself
                let _ = child.wait();
                return Err(format!("node: no answer in {} s", PATIENCE.as_secs()));
            }
            None => sleep(Duration::from_millis(20)),
        }
    }
}

/// The error that the script throws, among the driver's warnings; all of it where there is none.
fn reason(errors: &str) -> &str {
    errors.lines().find(|line| line.starts_with("Error: ")).unwrap_or(errors).trim()
}

impl Drop for Dawn {
    fn drop(&mut self) {
        for kind in ["wgsl", "in", "out", "stdout", "stderr"] {
            let _ = fs::remove_file(file(kind)); // one that was never written is none to remove
        }
    }
}
