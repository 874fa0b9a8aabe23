//! What can be wrong with the settings of a rendering.

use glam::Vec3;

use super::{LARGEST, Method, SMALLEST};

/// Bad settings.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum FrameError {
    /// A coordinate that is not a usable number.
    #[error(
        "{what} {value} is outside float range; each coordinate must be a number between -{LARGEST:e} and {LARGEST:e}"
    )]
    Range {
        /// Which coordinate.
        what: &'static str,
        /// The value.
        value: Vec3,
    },
    /// The clipping spheres enclose nothing.
    #[error(
        "near {near} and far {far} must fit {SMALLEST:e} <= near < far <= {LARGEST:e}; set --near and --far, or move the light off the geometry"
    )]
    Spheres {
        /// Near sphere's radius.
        near: f32,
        /// Far sphere's radius.
        far: f32,
    },
    /// An exposure that leaves no light, or no number.
    #[error("--exposure {0} must be a finite number above 0; leave it out to have one chosen")]
    Exposure(f32),
    /// A bias that leaves no depth.
    #[error("bias {0} must be at least 0 and below 0.5, in units of depth")]
    Bias(f32),
    /// An image or map size of 0 or too large.
    #[error("{what} {asked} must be from 1 to {limit}")]
    Size {
        /// Which size.
        what: &'static str,
        /// The value.
        asked: u32,
        /// The largest allowed.
        limit: u32,
    },
    /// More memory than there is.
    #[error(
        "{what} needs {bytes} bytes of memory at once, more than there are; choose a smaller one"
    )]
    Memory {
        /// The option.
        what: &'static str,
        /// Bytes needed.
        bytes: u64,
    },
    /// A scene's vertex that is too far out.
    #[error(
        "mesh `{mesh}`: vertex {index} at {value} is outside float range, -{LARGEST:e} to {LARGEST:e}; scale the scene down"
    )]
    Vertex {
        /// The mesh.
        mesh: String,
        /// Index in the mesh.
        index: usize,
        /// The vertex.
        value: Vec3,
    },
    /// A triangle's corner that is not there.
    #[error(
        "mesh `{mesh}`: triangle {triangle} has the vertex {index}, but there are {positions}, counted from 0; give it one of those"
    )]
    Index {
        /// The mesh.
        mesh: String,
        /// Index in the mesh.
        triangle: usize,
        /// The corner's.
        index: u32,
        /// Vertices of the mesh.
        positions: usize,
    },
    /// Vertices that are not whole.
    #[error("mesh `{mesh}` has {found} {what} for {positions} positions; give it as many")]
    Count {
        /// The mesh.
        mesh: String,
        /// Normals or texture coordinates.
        what: &'static str,
        /// How many of them.
        found: usize,
        /// Vertices of the mesh.
        positions: usize,
    },
    /// A mask that is no picture.
    #[error(
        "mesh `{mesh}`: a mask of {width} x {height} texels has {found} alphas and the cutoff {cutoff}; give each texel one, at least one texel, and a number for the cutoff"
    )]
    Mask {
        /// The mesh.
        mesh: String,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// How many alphas.
        found: usize,
        /// The cutoff.
        cutoff: f32,
    },
    /// The light's main axis points nowhere.
    #[error("the light's axis {0} has no direction; set --axis to a vector other than 0,0,0")]
    Axis(Vec3),
    /// Castings that are not those of the scene's meshes.
    #[error(
        "{found} castings for the {meshes} meshes of the scene; give each mesh one, or give none"
    )]
    Castings {
        /// How many castings.
        found: usize,
        /// The scene's meshes.
        meshes: usize,
    },
    /// A mesh's method that the maps or the passes do not have.
    #[error("mesh `{mesh}` is cast by {method:?}, but {why}; cast it by {remedy}, or leave it out")]
    Casting {
        /// The mesh.
        mesh: String,
        /// Its method.
        method: Method,
        /// What speaks against it.
        why: &'static str,
        /// Methods that would do.
        remedy: &'static str,
    },
    /// Something that the cube method does not have.
    #[error("the cube method has no {what}; choose {remedy}, or another --method")]
    Cube {
        /// What it has not.
        what: &'static str,
        /// What it has.
        remedy: &'static str,
    },
    /// Edges that are drawn too near their arcs, or too far.
    #[error("--tau {0} must be from 0.015625 to 4 texels")]
    Tau(f32),
    /// A tolerance that is none.
    #[error("a depth tolerance of {0} must be a number from 0 to 1")]
    DepthTolerance(f32),
    /// A filter that cannot be.
    #[error("the filter has {0}")]
    Filter(String),
    /// Several lights where there is but one.
    #[error(
        "several lights need paraboloid maps, --lookup pixel, and --filter hard, hardware or disk"
    )]
    Lights,
    /// A filter with a kernel where it has none.
    #[error("filters with a kernel need {needs}; choose --filter hard or hardware, or {remedy}")]
    Kernel {
        /// What they need.
        needs: &'static str,
        /// What has it.
        remedy: &'static str,
    },
    /// The camera looks nowhere.
    #[error("the camera's eye and target are the same point {0}; set --camera and --look-at apart")]
    Camera(Vec3),
    /// A level of tessellation whose vertices cannot be counted.
    #[error(
        "tessellation level {level} makes {vertices} vertices of a mesh, more than 4294967295; \
         use a smaller --level"
    )]
    Level {
        /// The level.
        level: u32,
        /// Vertices up to the mesh's end.
        vertices: u64,
    },
}
