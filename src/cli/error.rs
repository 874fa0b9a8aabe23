//! Errors of the commands and their exit codes.

use std::path::PathBuf;

use dpsm::gpu::GpuError;
use dpsm::link::LinkError;
use dpsm::plan::PlanError;
use dpsm::render::FrameError;
use dpsm::report::ReportError;
use dpsm::scene::SceneError;
use dpsm::validate::ValidateError;

/// What a command can fail with.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// A file that cannot be read.
    #[error("cannot read {}: {source}; check the path", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// An output that cannot be written.
    #[error("cannot write {}: {source}; choose another place with {remedy}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
        /// The option that says where.
        remedy: &'static str,
    },
    /// An option whose value does not fit.
    #[error("{0}")]
    Usage(String),
    /// A line of a CSV file.
    #[error("{}:{line}: {message}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What is wrong, and where in the line.
        message: String,
    },
    /// A scene that cannot be used.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Settings that do not fit.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// No plan, or one that does not fit.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// WGSL that does not link.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// WGSL that is not valid.
    #[error(transparent)]
    Validate(#[from] ValidateError),
    /// WGSL that Tint refuses.
    #[error("{0}\nrefused by Tint")]
    Refused(String),
    /// Tint that is not there.
    #[error("no Tint: {0}; without --tint, naga alone is asked")]
    NoTint(String),
    /// The adapter.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Results outside their bounds.
    #[error("outside the bound: {0}; the table has an input of each")]
    Outside(String),
    /// Maps that cannot be encoded.
    #[error("cannot encode {}: {message}", path.display())]
    Exr {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// An image that cannot be encoded.
    #[error("cannot encode {}: {source}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Why.
        source: image::ImageError,
    },
}

impl From<ReportError> for CliError {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Gpu(error) => error.into(),
            ReportError::Frame(error) => error.into(),
            ReportError::Scene(error) => error.into(),
            ReportError::Picture(source) => Self::Encode { path: "a picture".into(), source },
        }
    }
}

impl CliError {
    /// 2 for bad input, 1 for what failed on good input.
    pub fn code(&self) -> u8 {
        use std::io::ErrorKind as Kind;
        match self {
            CliError::Write { source, .. } => match source.kind() {
                Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge => 1,
                _ => 2,
            },
            CliError::Gpu(
                GpuError::NoDevice { .. }
                | GpuError::Rejected { .. }
                | GpuError::OutOfMemory { .. }
                | GpuError::Lost { .. }
                | GpuError::Hung { .. },
            )
            | CliError::Encode { .. }
            | CliError::NoTint(_)
            | CliError::Outside(_)
            | CliError::Exr { .. } => 1,
            _ => 2,
        }
    }
}
