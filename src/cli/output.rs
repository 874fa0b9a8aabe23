//! Files that appear whole or not at all, and standard output that may be closed early.

use std::io::Write;
use std::path::{Path, PathBuf};

use dpsm::render::Picture;

use super::CliError;

/// Files that are written aside and moved to their places together.
pub struct Outputs {
    files: Vec<(PathBuf, tempfile::NamedTempFile)>,
    /// The option that says where they go, for messages.
    option: &'static str,
}

impl Outputs {
    /// No files yet; `option` is the one that says where they go.
    pub fn for_option(option: &'static str) -> Self {
        Self { files: Vec::new(), option }
    }

    /// Adds a file's bytes; nothing shows under `path` yet. A link's target is replaced, not the
    /// link; a pipe or a device is refused, as it can take no whole file.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) -> Result<(), CliError> {
        let wrap = |source| CliError::Write { path: path.into(), source, remedy: self.option };
        let target = path.canonicalize().unwrap_or_else(|_| path.into());
        if target.exists() && !target.is_file() {
            let what = if target.is_dir() { "it is a folder" } else { "it is no regular file" };
            return Err(wrap(std::io::Error::other(what)));
        }
        if target.metadata().is_ok_and(|metadata| metadata.permissions().readonly()) {
            return Err(wrap(std::io::ErrorKind::PermissionDenied.into()));
        }
        let path = target.as_path();
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // the user's umask decides, as for any other file
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let created = builder.prefix(".dpsm-").tempfile_in(folder);
        let mut file = created.map_err(|error| wrap(error.kind().into()))?;
        file.write_all(bytes).map_err(wrap)?;
        self.files.push((path.into(), file));
        Ok(())
    }

    /// Adds a picture as PNG.
    pub fn add_picture(&mut self, path: &Path, picture: &Picture) -> Result<(), CliError> {
        use image::ImageEncoder;
        let mut bytes = Vec::new();
        image::codecs::png::PngEncoder::new(&mut bytes)
            .write_image(
                picture.bytes(),
                picture.width,
                picture.height,
                image::ExtendedColorType::Rgba8,
            )
            .map_err(|source| CliError::Encode { path: path.into(), source })?;
        self.add(path, &bytes)
    }

    /// Moves all files to their places and names them.
    pub fn finish(self) -> Result<Vec<PathBuf>, CliError> {
        let mut paths = Vec::new();
        for (path, file) in self.files {
            file.persist(&path).map_err(|error| CliError::Write {
                path: path.clone(),
                source: error.error,
                remedy: self.option,
            })?;
            paths.push(path);
        }
        Ok(paths)
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

/// Writes text to a file, or prints it.
pub fn write_or_print(path: Option<&Path>, text: &str) -> Result<(), CliError> {
    let Some(path) = path else { return print(text) };
    let mut outputs = Outputs::for_option("-o");
    outputs.add(path, text.as_bytes())?;
    outputs.finish()?;
    Ok(())
}

/// Reads a text file.
pub fn read_text(path: &Path) -> Result<String, CliError> {
    std::fs::read_to_string(path).map_err(|source| CliError::Read { path: path.into(), source })
}
