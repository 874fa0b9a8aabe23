//! Why there is no plan, or one that cannot be used.

use crate::render::FrameError;

/// What can go wrong.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum PlanError {
    /// No position of the light.
    #[error("a plan needs a light; give its position with --light")]
    NoLight,
    /// No surface that could be lit.
    #[error("nothing that the light could reach is seen; move --camera or --light")]
    NothingSeen,
    /// Not even the smallest maps fit.
    #[error("the smallest maps do not fit the budget; raise --budget")]
    Budget,
    /// An error as large as the scene.
    #[error("an error of {error} is {than}: no shadow is left to be right; give a smaller --error")]
    Target {
        /// What was asked for.
        error: String,
        /// What it is compared with.
        than: String,
    },
    /// A plan of another version.
    #[error(
        "a plan of version {0}, not {version}; make it again with `dpsm plan`",
        version = super::VERSION
    )]
    Version(u32),
    /// A plan of another scene.
    #[error(
        "the plan is for `{planned}` with {meshes} meshes and {triangles} triangles, not this scene; make one for it with `dpsm plan`"
    )]
    Scene {
        /// The plan's scene.
        planned: String,
        /// Its meshes.
        meshes: usize,
        /// Its triangles.
        triangles: usize,
    },
    /// A value that no plan has.
    #[error("the plan's {what} `{value}` is unknown; make it again with `dpsm plan`")]
    Value {
        /// The member.
        what: &'static str,
        /// What it holds.
        value: String,
    },
    /// Settings that do not fit.
    #[error(transparent)]
    Frame(#[from] FrameError),
}
