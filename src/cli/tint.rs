//! Tint, the compiler of Chrome, by node and its package `webgpu`: what tools/tint runs.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use dpsm::Linked;
use serde::Deserialize;

use super::CliError;

const SCRIPT: &str = include_str!("../../tools/tint.mjs");
const PACKAGE: &str = include_str!("../../tools/package.json");

/// One message of Tint's, in the linked text.
#[derive(Debug, Deserialize)]
struct Message {
    r#type: String,
    message: String,
    line: usize,
    column: usize,
}

/// Asks Tint; what it warns of is returned, what it refuses is an error.
pub fn check(linked: &Linked) -> Result<String, CliError> {
    let folder = folder()?;
    install(&folder)?;
    let messages = run(&folder, &linked.text)?;
    let shown: Vec<_> = messages.iter().map(|message| show(linked, message)).collect();
    match messages.iter().any(|message| message.r#type == "error") {
        true => Err(CliError::Refused(shown.join("\n"))),
        false => {
            let file = linked.name();
            let warnings: String = shown.iter().map(|message| format!("{message}\n")).collect();
            Ok(format!("{file}: valid by Tint, uniformity among it\n{warnings}"))
        }
    }
}

fn missing(what: String) -> CliError {
    CliError::NoTint(what)
}

/// Where the package is or will be.
fn folder() -> Result<PathBuf, CliError> {
    let path = |name| std::env::var_os(name).filter(|path| !path.is_empty()).map(PathBuf::from);
    let cache = || {
        let cache = path("XDG_CACHE_HOME").or_else(|| path("LOCALAPPDATA"));
        let cache = cache.or_else(|| Some(path("HOME")?.join(".cache")))?;
        Some(cache.join("dpsm").join("tint"))
    };
    path("DPSM_TINT").or_else(cache).ok_or_else(|| {
        missing("there is no home folder to install it into; set DPSM_TINT to a folder".into())
    })
}

/// Installs the package where it is not there yet.
fn install(folder: &Path) -> Result<(), CliError> {
    if !works("node") {
        return Err(missing("`node` is not there or does not run; install Node.js".into()));
    }
    let unwritable = |source| CliError::Write { path: folder.into(), source, remedy: "DPSM_TINT" };
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text);
    std::fs::create_dir_all(folder).map_err(unwritable)?;
    write("tint.mjs", SCRIPT).map_err(unwritable)?;
    let same = std::fs::read_to_string(folder.join("package.json")).is_ok_and(|old| old == PACKAGE);
    if same && folder.join("node_modules/webgpu/package.json").is_file() {
        return Ok(());
    }
    if !works(NPM) {
        return Err(missing("`npm` is not there or does not run; install it beside node".into()));
    }
    eprintln!("dpsm: installing the npm package `webgpu` into {}", folder.display());
    write("package.json", PACKAGE).map_err(unwritable)?;
    let npm = Command::new(NPM)
        .args(["install", "--silent", "--no-audit", "--no-fund"])
        .current_dir(folder)
        .stdin(Stdio::null())
        .output();
    match npm {
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => {
            // not half of it the next time
            let _ = std::fs::remove_file(folder.join("package.json"));
            let error = String::from_utf8_lossy(&output.stderr);
            let line =
                error.lines().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
            Err(missing(format!("`npm install webgpu` failed: {line}; is there a network?")))
        }
        Err(error) => Err(missing(format!("`npm` does not run: {error}"))),
    }
}

/// npm's name as a program.
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

fn works(program: &str) -> bool {
    let mut command = Command::new(program);
    command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

fn run(folder: &Path, text: &str) -> Result<Vec<Message>, CliError> {
    let failed = |what: String| missing(format!("it does not run: {what}"));
    let mut command = Command::new("node");
    command.arg("tint.mjs").arg("-").current_dir(folder);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| failed(error.to_string()))?;
    if let Some(mut input) = child.stdin.take() {
        // a process that has died says why on stderr
        let _ = input.write_all(text.as_bytes());
    }
    let output = child.wait_with_output().map_err(|error| failed(error.to_string()))?;
    let lines = String::from_utf8_lossy(&output.stdout);
    let answer = lines.lines().last().and_then(|line| serde_json::from_str(line).ok());
    answer.ok_or_else(|| {
        let error = String::from_utf8_lossy(&output.stderr);
        failed(error.lines().find(|line| line.contains("rror")).unwrap_or("no answer").to_owned())
    })
}

/// A message in terms of the file that the line came from.
fn show(linked: &Linked, message: &Message) -> String {
    let Message { r#type, message: what, line, column } = message;
    let (file, at) = match linked.origin(*line) {
        Some(origin) => (origin.file, origin.line),
        None => (linked.name(), *line),
    };
    let source = linked.source_line(*line).unwrap_or_default();
    format!("{file}:{at}:{column}: {type}: {what}\n{at} | {source}", r#type = r#type)
}
