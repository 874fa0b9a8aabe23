//! Files that appear whole or not at all, and standard output that may be closed early.

use std::fs::File;
use std::io::{Error, Write};
use std::path::{Path, PathBuf};

use dpsm::render::Picture;
use tempfile::NamedTempFile;

use super::CliError;

/// Files that are kept until the command is done, and then appear all together or not at all.
pub struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
    /// The option that says where they go, for messages.
    option: &'static str,
}

impl Outputs {
    /// No files yet; `option` is the one that says where they go.
    pub fn for_option(option: &'static str) -> Self {
        Self { files: Vec::new(), option }
    }

    /// Refuses a file that could not be written, before anything is made for it.
    pub fn check(&self, path: &Path) -> Result<(), CliError> {
        self.target(path).map(drop)
    }

    /// Adds a file's bytes; nothing is written yet. A link's target is replaced, not the link; a
    /// pipe or a device is refused, as it can take no whole file.
    pub fn add(&mut self, path: &Path, bytes: Vec<u8>) -> Result<(), CliError> {
        let target = self.target(path)?;
        self.files.push((target, bytes));
        Ok(())
    }

    fn target(&self, path: &Path) -> Result<PathBuf, CliError> {
        let target = path.canonicalize().unwrap_or_else(|_| path.into());
        if let Some(folder) = folder_of(&target).filter(|folder| !folder.is_dir()) {
            let what = match folder.exists() {
                true => format!("`{}` is not a folder", folder.display()),
                false => format!("there is no folder `{}`; make it", folder.display()),
            };
            return Err(self.unwritable(path, Error::other(what)));
        }
        if target.exists() && !target.is_file() {
            let what = if target.is_dir() { "it is a folder" } else { "it is no regular file" };
            return Err(self.unwritable(path, Error::other(what)));
        }
        if target.metadata().is_ok_and(|metadata| metadata.permissions().readonly()) {
            return Err(self.unwritable(path, std::io::ErrorKind::PermissionDenied.into()));
        }
        Ok(target)
    }

    /// Adds a picture as PNG.
    pub fn add_picture(&mut self, path: &Path, picture: &Picture) -> Result<(), CliError> {
        let encoded = picture.png();
        let bytes = encoded.map_err(|source| CliError::Encode { path: path.into(), source })?;
        self.add(path, bytes)
    }

    /// Writes all files and names them: aside first, then each is moved to its place. Where one
    /// cannot be, those before it are taken back.
    pub fn finish(self) -> Result<Vec<PathBuf>, CliError> {
        let write = |(path, bytes): &(PathBuf, Vec<u8>)| {
            aside(path, bytes).map_err(|source| self.unwritable(path, source))
        };
        let written = self.files.iter().map(write).collect::<Result<Vec<_>, _>>()?;
        let mut placed = Vec::new();
        for (file, (path, _)) in written.into_iter().zip(&self.files) {
            let moved = kept(path).and_then(|old| {
                file.persist(path)?;
                Ok(old)
            });
            match moved {
                Ok(old) => placed.push((path, old)),
                Err(source) => {
                    take_back(placed);
                    return Err(self.unwritable(path, source));
                }
            }
        }
        Ok(self.files.into_iter().map(|(path, _)| path).collect())
    }

    fn unwritable(&self, path: &Path, source: Error) -> CliError {
        CliError::Write { path: path.into(), source, remedy: self.option }
    }
}

/// The folder that a file lies in; `None` where the path does not name one.
fn folder_of(path: &Path) -> Option<&Path> {
    path.parent().filter(|folder| !folder.as_os_str().is_empty())
}

/// A name of its own beside a file, that vanishes unless it is moved.
fn beside<T>(
    path: &Path,
    make: impl FnMut(&Path) -> std::io::Result<T>,
) -> std::io::Result<NamedTempFile<T>> {
    let folder = folder_of(path).unwrap_or(Path::new("."));
    // the kind alone: the message names the file that was asked for
    tempfile::Builder::new().prefix(".dpsm-").make_in(folder, make).map_err(|e| e.kind().into())
}

/// The bytes in a file beside the one that they are for, down to the disk: only then is it known
/// that there is room.
fn aside(path: &Path, bytes: &[u8]) -> std::io::Result<NamedTempFile<File>> {
    // the user's umask decides who may read it, as for any other file
    let mut aside = beside(path, |path| File::create_new(path))?;
    let file = aside.as_file_mut();
    file.write_all(bytes)?;
    file.sync_all()?;
    Ok(aside)
}

/// What a file holds now under another name, if there is one.
fn kept(path: &Path) -> std::io::Result<Option<NamedTempFile<()>>> {
    let link = |aside: &Path| {
        let linked = std::fs::hard_link(path, aside);
        // not every file system has links
        linked.or_else(|_| std::fs::copy(path, aside).map(drop))
    };
    path.exists().then(|| beside(path, link)).transpose()
}

/// Puts back what was there. What cannot be put back is left: the first error is the one to tell.
fn take_back(placed: Vec<(&PathBuf, Option<NamedTempFile<()>>)>) {
    for (path, old) in placed.into_iter().rev() {
        let _ = match old {
            Some(old) => old.persist(path).map_err(|error| error.error),
            None => std::fs::remove_file(path),
        };
    }
}

/// Prints to standard output; a reader that has gone is no error.
pub fn print(text: &str) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(CliError::Write { path: "standard output".into(), source: error, remedy: "-o" })
        }
        _ => Ok(()),
    }
}

/// Refuses an output that could not be written, before there is one.
pub fn check_output(path: Option<&Path>) -> Result<(), CliError> {
    path.map_or(Ok(()), |path| Outputs::for_option("-o").check(path))
}

/// Writes text to a file, or prints it.
pub fn write_or_print(path: Option<&Path>, text: &str) -> Result<(), CliError> {
    let Some(path) = path else { return print(text) };
    let mut outputs = Outputs::for_option("-o");
    outputs.add(path, text.into())?;
    outputs.finish()?;
    Ok(())
}

/// Reads a text file.
pub fn read_text(path: &Path) -> Result<String, CliError> {
    std::fs::read_to_string(path).map_err(|source| CliError::Read { path: path.into(), source })
}
