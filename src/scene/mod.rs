//! Scenes: triangle meshes, point lights and a camera, built in or read from a file.
//!
//! Coordinates are right-handed with y up, lengths are metres, colours are linear RGB.
//!
//! ```
//! use dpsm::scene::{Options, open};
//!
//! let scene = open("brabec-room", &Options::default())?;
//! let light = scene.default_light();
//! let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
//! assert!(scene.triangle_count() > 6 * 8 * 8 * 2);
//! assert!(scene.bounds().contains(camera.eye));
//! # Ok::<(), dpsm::scene::SceneError>(())
//! ```

mod load;
mod mask;
mod nearest;
mod procedural;
mod shapes;

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec2, Vec3};

pub use mask::Mask;
pub(crate) use nearest::nearest_of;
pub use procedural::{BUILT_IN, crowd, dozen};

/// A triangle mesh in world space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The file's name for it, or a made-up one; not necessarily unique.
    pub name: String,
    /// Metres, all finite.
    pub positions: Vec<Vec3>,
    /// Unit length, one for each position.
    pub normals: Vec<Vec3>,
    /// Indices into `positions`, counter-clockwise seen from the visible side.
    pub triangles: Vec<[u32; 3]>,
    /// Diffuse reflectance, linear RGB, each component in [0, 1].
    pub albedo: Vec3,
    /// Where `mask` is read, one for each position; empty without a mask.
    pub texcoords: Vec<Vec2>,
    /// Where the mesh has holes; `None` for an opaque one.
    pub mask: Option<Mask>,
}

impl Mesh {
    /// False where a triangle's point, given by its corners' weights, is a hole of the mask.
    pub fn opaque(&self, triangle: usize, weights: [f64; 3]) -> bool {
        let Some((mask, corners)) = self.mask.as_ref().zip(self.triangles.get(triangle)) else {
            return true;
        };
        let texcoord = |i: u32| self.texcoords.get(i as usize).copied().unwrap_or(Vec2::NAN);
        mask.opaque_at(corners.map(texcoord), weights)
    }
}

/// A point light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Metres, world space.
    pub position: Vec3,
    /// The unit main axis of a hemispherical light; `None` for an omnidirectional one.
    pub axis: Option<Vec3>,
    /// Linear RGB, the largest component is 1.
    pub color: Vec3,
    /// The cone that a spot lights; `None` for all directions, or all of the hemisphere.
    pub cone: Option<Cone>,
    /// Metres from the light to where it lights nothing any more, above 0; `None` for no limit.
    pub range: Option<f32>,
}

/// How a spot fades: full light up to the inner angle, none from the outer one on. Both are radians
/// from [`Light::axis`], which is `Some`; 0 <= `inner` < `outer` <= pi / 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Where the light begins to fade.
    pub inner: f32,
    /// Where none is left.
    pub outer: f32,
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Metres, world space.
    pub eye: Vec3,
    /// A point the camera looks at, never the eye itself.
    pub target: Vec3,
    /// Unit length, not parallel to the viewing direction.
    pub up: Vec3,
    /// Radians, in (0, pi).
    pub vertical_fov: f32,
}

/// Meshes, lights and a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The built-in name, or the file's name without its extension.
    pub name: String,
    /// Where the scene's own origin lies in the coordinates of the file, metres. All positions here
    /// are the file's less this one, rounded once from f64. Zero for built-in scenes and for files
    /// whose coordinates f32 holds well; see [`Options::around`].
    pub origin: DVec3,
    /// At least one triangle in all.
    pub meshes: Vec<Mesh>,
    /// Empty when the file has none; see [`Scene::default_light`].
    pub lights: Vec<Light>,
    /// `None` when the file has none; see [`Scene::default_camera`].
    pub camera: Option<Camera>,
    /// What was left out or repaired while reading, one sentence each.
    pub warnings: Vec<String>,
}

/// An axis-aligned box in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The middle.
    pub fn center(&self) -> Vec3 {
        // Halves first: the sum of two large coordinates would overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Lengths of the sides.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// True for points inside or on the surface.
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }
}

impl Light {
    /// The same light elsewhere: it shines everywhere and without limit unless told otherwise.
    pub fn moved(self, position: Vec3) -> Self {
        Self { position, axis: None, cone: None, range: None, ..self }
    }
}

impl Scene {
    /// A point of the file's coordinates in the scene's own.
    pub fn local(&self, point: DVec3) -> Vec3 {
        (point - self.origin).as_vec3()
    }

    /// A point of the scene in the file's coordinates.
    pub fn in_file(&self, point: Vec3) -> DVec3 {
        in_file(point, self.origin)
    }

    /// The smallest box around all positions; a point at the origin if there are none.
    pub fn bounds(&self) -> Bounds {
        let positions = || self.meshes.iter().flat_map(|mesh| &mesh.positions).copied();
        Bounds {
            min: positions().reduce(Vec3::min).unwrap_or_default(),
            max: positions().reduce(Vec3::max).unwrap_or_default(),
        }
    }

    /// Triangles of all meshes.
    pub fn triangle_count(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
    }

    /// The corners of every triangle, mesh after mesh; NaN where an index is out of range.
    pub fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.meshes.iter().flat_map(|mesh| {
            let corner = |i: u32| mesh.positions.get(i as usize).copied().unwrap_or(Vec3::NAN);
            mesh.triangles.iter().map(move |corners| corners.map(corner))
        })
    }
}

/// A local point in coordinates whose origin lies at `origin`: where that is 0, the decimal number that
/// the float was rounded from, as nearly as a float tells.
pub(crate) fn in_file(point: Vec3, origin: DVec3) -> DVec3 {
    let decimal = |c: f32| c.to_string().parse::<f64>().unwrap_or(c.into());
    let sum = |local: f32, origin: f64| match origin {
        0.0 => decimal(local),
        origin => f64::from(local) + origin,
    };
    DVec3::new(sum(point.x, origin.x), sum(point.y, origin.y), sum(point.z, origin.z))
}

/// What [`open`] may vary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Each wall, floor and ceiling of a built-in scene is a grid of `walls` x `walls` quads:
    /// 1 to [`Options::MAX_WALLS`], 8 in Brabec's paper and by default. Files and `hills` ignore it.
    pub walls: u32,
    /// The point, in the file's coordinates, around which positions should be most exact: the
    /// light's. By default the file's first light with a position, else the middle of its bounds.
    /// Built-in scenes ignore it.
    pub around: Option<DVec3>,
}

impl Options {
    /// Six walls of this many quads a side are 12.6 million triangles.
    pub const MAX_WALLS: u32 = 1024;
}

impl Default for Options {
    fn default() -> Self {
        Self { walls: 8, around: None }
    }
}

/// Builds the scene of [`BUILT_IN`] with this name, or reads a `.obj`, `.gltf` or `.glb` file.
///
/// # Errors
/// See [`SceneError`]. What can be repaired or left out is not an error but a line in
/// [`Scene::warnings`]. Bad input never panics.
pub fn open(name_or_path: &str, options: &Options) -> Result<Scene, SceneError> {
    if BUILT_IN.iter().any(|(name, _)| *name == name_or_path) {
        return procedural::build(name_or_path, options.walls);
    }
    let path = Path::new(name_or_path);
    let looks_like_a_path = path.extension().is_some() || path.components().nth(1).is_some();
    if looks_like_a_path || path.exists() {
        load::read(path, options)
    } else {
        Err(SceneError::UnknownName {
            name: name_or_path.into(),
            hint: nearest_built_in(name_or_path)
                .map(|nearest| format!("; did you mean `{nearest}`?"))
                .unwrap_or_default(),
        })
    }
}

/// A built-in name that starts with what was typed or is a few typing errors away.
fn nearest_built_in(typed: &str) -> Option<&'static str> {
    const MAX_TYPING_ERRORS: usize = 3;
    let typed = typed.to_lowercase();
    let names = || BUILT_IN.iter().map(|(name, _)| *name);
    let prefixed = names().find(|name| !typed.is_empty() && name.starts_with(&typed));
    prefixed.or_else(|| {
        names()
            .map(|name| (strsim::damerau_levenshtein(name, &typed), name))
            .min()
            // Of a short name, half the letters at least must be right.
            .filter(|(errors, name)| *errors <= MAX_TYPING_ERRORS.min(name.len() / 2))
            .map(|(_, name)| name)
    })
}

fn built_in_names() -> String {
    BUILT_IN.map(|(name, _)| name).join(", ")
}

/// Why a scene could not be opened, and what to do about it.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the messages say what the variants and fields are
pub enum SceneError {
    #[error(
        "no scene is called `{name}`{hint} (built in: {}; or give the path of a .obj, .gltf or .glb file)",
        built_in_names()
    )]
    UnknownName { name: String, hint: String },
    #[error("walls of {walls} x {walls} quads: use 1 to {}", Options::MAX_WALLS)]
    Walls { walls: u32 },
    #[error("cannot read `{path}`: {source}; check the path and its permissions")]
    Read { path: PathBuf, source: std::io::Error },
    #[error("`{path}` is a directory; name a .obj, .gltf or .glb file in it")]
    Directory { path: PathBuf },
    #[error("`{path}` is empty (0 bytes); export it again")]
    EmptyFile { path: PathBuf },
    #[error("`{path}`: unknown extension `{extension}`; convert it to .glb, .gltf or .obj")]
    UnknownExtension { path: PathBuf, extension: String },
    #[error("`{path}`: {what}; export it again, or check it with a validator")]
    Malformed { path: PathBuf, what: String },
    #[error(
        "`{path}` needs the buffer `{uri}`: {what}; put it where the file expects it, or export a .glb, which holds its buffers"
    )]
    Buffer { path: PathBuf, uri: String, what: String },
    #[error(
        "`{path}` needs the image `{image}` for the mask of mesh `{mesh}`: {what}; put a PNG, JPEG or WebP where the file expects it, or export a .glb, which holds its images"
    )]
    Image { path: PathBuf, image: String, mesh: String, what: String },
    #[error("`{path}` requires the glTF extension `{extension}`, which is not supported; {remedy}")]
    RequiredExtension { path: PathBuf, extension: String, remedy: &'static str },
    #[error("`{path}` is {kind}, not {expected}; {remedy}")]
    OtherKind { path: PathBuf, kind: &'static str, expected: &'static str, remedy: &'static str },
    #[error("`{path}` has no triangles, only {found}; export its meshes as triangles")]
    Empty { path: PathBuf, found: String },
}
