//! Files: which reader, where the scene's origin is, and the repairs that every format's meshes go
//! through.

mod draft;
mod gltf;
mod kind;
mod named;
mod obj;
mod origin;
mod text;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use glam::{DVec3, Vec3};

use super::{Camera, Light, Options, Scene, SceneError};
use draft::Draft;

/// Reads a `.obj`, `.gltf` or `.glb` file.
pub(super) fn read(path: &Path, options: &Options) -> Result<Scene, SceneError> {
    let path_buf = || path.to_path_buf();
    if path.is_dir() {
        return Err(SceneError::Directory { path: path_buf() });
    }
    let extension = path.extension().unwrap_or_default();
    let extension = extension.to_string_lossy().to_lowercase();
    let reader = match extension.as_str() {
        "obj" => obj::read,
        "gltf" | "glb" => gltf::read,
        _ => {
            return Err(SceneError::UnknownExtension { path: path_buf(), extension });
        }
    };
    let bytes =
        std::fs::read(path).map_err(|source| SceneError::Read { path: path_buf(), source })?;
    if bytes.is_empty() {
        return Err(SceneError::EmptyFile { path: path_buf() });
    }
    kind::check(path, &bytes, &extension)?;
    // The decoders of images and of compressed meshes are others' code, which a broken file may
    // bring to panic.
    let mut contents = catch_unwind(AssertUnwindSafe(|| reader(path, &bytes)))
        .unwrap_or_else(|_| Err(malformed(path, "its offsets or indices are impossible")))?;
    let found = std::mem::take(&mut contents.found);
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into();
    let scene = contents.finish(name, options.around);
    if scene.triangle_count() == 0 {
        let found = [&[found], &scene.warnings[..]].concat().join("; ");
        return Err(SceneError::Empty { path: path_buf(), found });
    }
    Ok(scene)
}

fn malformed(path: &Path, what: impl ToString) -> SceneError {
    SceneError::Malformed { path: path.to_path_buf(), what: what.to_string() }
}

/// What a file holds, in its own coordinates and in f64, as node transforms may take a mesh millions
/// of metres away.
#[derive(Default)]
struct Contents {
    drafts: Vec<Draft>,
    /// Their positions, and the rest of them.
    lights: Vec<(DVec3, Light)>,
    camera: Option<View>,
    warnings: Vec<String>,
    /// What the file has, in words, for one without triangles.
    found: String,
}

/// A camera before the scene's origin is known.
struct View {
    eye: DVec3,
    forward: Vec3,
    up: Vec3,
    vertical_fov: f32,
}

impl Contents {
    fn finish(self, name: String, around: Option<DVec3>) -> Scene {
        let origin = origin::of(&self, around);
        let Self { drafts, lights, camera, mut warnings, .. } = self;
        let meshes =
            drafts.into_iter().filter_map(|draft| draft.finish(origin, &mut warnings)).collect();
        let (lights, lost): (Vec<Light>, Vec<Light>) = lights
            .into_iter()
            .map(|(at, light)| Light { position: (at - origin).as_vec3(), ..light })
            .partition(|light| light.position.is_finite());
        if !lost.is_empty() {
            warnings.push(format!("{} lights beyond the range of numbers skipped", lost.len()));
        }
        let camera = camera.and_then(|view| {
            let camera = view.at(origin);
            if camera.is_none() {
                warnings.push("a camera without a usable perspective was skipped".into());
            }
            camera
        });
        Scene { name, origin, meshes, lights, camera, warnings }
    }
}

impl View {
    fn at(self, origin: DVec3) -> Option<Camera> {
        let Self { eye, forward, up, vertical_fov } = self;
        let eye = (eye - origin).as_vec3();
        let target = eye + forward;
        // So far from the origin that a metre is lost, the target would be the eye.
        (target.is_finite() && target != eye).then_some(Camera { eye, target, up, vertical_fov })
    }
}

/// Linear RGB from a file, where anything may stand.
fn albedo(color: [f32; 3]) -> Vec3 {
    let usable = |component: f32| {
        if component.is_nan() { 0.0 } else { component.clamp(0.0, 1.0) }
    };
    Vec3::from(color.map(usable))
}

/// `None` for a vector without a direction: zero or not finite.
fn unit(v: DVec3) -> Option<Vec3> {
    // Scaled first, as squares of the smallest and largest f64 are no use.
    let v = v / v.abs().max_element();
    Some(v.try_normalize()?.as_vec3())
}
