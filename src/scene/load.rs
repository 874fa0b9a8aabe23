//! Files: which reader, and the repairs that every format's meshes go through.

mod alpha;
mod gltf;
mod named;
mod obj;
mod primitive;

use std::collections::{BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use glam::{Vec2, Vec3};

use super::{Mask, Mesh, Scene, SceneError};

/// Reads a `.obj`, `.gltf` or `.glb` file.
pub(super) fn read(path: &Path) -> Result<Scene, SceneError> {
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
    let mut scene = Scene {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into(),
        origin: glam::DVec3::ZERO,
        meshes: Vec::new(),
        lights: Vec::new(),
        camera: None,
        warnings: Vec::new(),
    };
    // The arithmetic of gltf on offsets and lengths, and of tobj on indices, is unchecked.
    let found = catch_unwind(AssertUnwindSafe(|| reader(path, &bytes, &mut scene)))
        .unwrap_or_else(|_| Err(malformed(path, "its offsets or indices are impossible")))?;
    if scene.triangle_count() == 0 {
        let found = [&[found], &scene.warnings[..]].concat().join("; ");
        return Err(SceneError::Empty { path: path_buf(), found });
    }
    Ok(scene)
}

fn malformed(path: &Path, what: impl ToString) -> SceneError {
    SceneError::Malformed {
        path: path.to_path_buf(),
        // The gltf crate ends a list of faults with a separator.
        what: what.to_string().trim_end_matches([';', ' ']).into(),
    }
}

/// Linear RGB from a file, where anything may stand.
fn albedo(color: [f32; 3]) -> Vec3 {
    let usable = |component: f32| {
        if component.is_nan() { 0.0 } else { component.clamp(0.0, 1.0) }
    };
    Vec3::from(color.map(usable))
}

/// A triangle's corner: indices of its position, normal and texture coordinates, counted from zero,
/// unchecked.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Corner {
    position: u32,
    normal: Option<u32>,
    texcoord: Option<u32>,
}

type Triangle = [Corner; 3];

/// A mesh as a file gives it; nothing about it is certain.
struct Draft<'a> {
    name: String,
    positions: &'a [Vec3],
    normals: &'a [Vec3],
    texcoords: &'a [Vec2],
    triangles: Vec<Triangle>,
    albedo: Vec3,
    mask: Option<Mask>,
}

/// Vertices that cannot be used, and how many triangles they cost.
#[derive(Default)]
struct Dropped {
    vertices: BTreeSet<u32>,
    triangles: usize,
}

impl Draft<'_> {
    /// Drops the triangles that cannot be used, gives every corner a unit normal, and says so;
    /// `None` if no triangle is left. Corners without a normal get their face's, as the glTF
    /// specification asks (3.7.2.1).
    fn finish(self, warnings: &mut Vec<String>) -> Option<Mesh> {
        let mut mesh = Mesh {
            name: self.name,
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::with_capacity(self.triangles.len()),
            albedo: self.albedo,
            texcoords: Vec::new(),
            mask: self.mask,
        };
        let (mut out_of_range, mut non_finite) = (Dropped::default(), Dropped::default());
        let (mut replaced_normals, mut unusable_texcoords) = (0, 0);
        let mut known = HashMap::new();
        for corners in self.triangles {
            let points = corners.map(|corner| at(self.positions, corner.position));
            let [Some(a), Some(b), Some(c)] = points else {
                out_of_range.add(corners, |i| at(self.positions, i).is_none());
                continue;
            };
            if ![a, b, c].iter().all(|point| point.is_finite()) {
                let bad = |i| at(self.positions, i).is_some_and(|point| !point.is_finite());
                non_finite.add(corners, bad);
                continue;
            }
            let mut add = |corner: Corner, position: Vec3, normal: Vec3| {
                mesh.positions.push(position);
                mesh.normals.push(normal);
                if mesh.mask.is_some() {
                    let texcoord = corner.texcoord.and_then(|i| at(self.texcoords, i));
                    let texcoord = texcoord.unwrap_or(Vec2::NAN);
                    unusable_texcoords += u32::from(!texcoord.is_finite());
                    mesh.texcoords.push(texcoord);
                }
                mesh.positions.len() as u32 - 1
            };
            let triangle = [(corners[0], a), (corners[1], b), (corners[2], c)];
            mesh.triangles.push(triangle.map(|(corner, position)| {
                let given = corner.normal.map(|i| at(self.normals, i).and_then(unit));
                if let Some(Some(normal)) = given {
                    *known.entry(corner).or_insert_with(|| add(corner, position, normal))
                } else {
                    replaced_normals += u32::from(given.is_some());
                    add(corner, position, face_normal(a, b, c))
                }
            }));
        }

        let mut warn = |what: String| warnings.push(format!("mesh `{}`: {what}", mesh.name));
        if let Some(first) = non_finite.vertices.first() {
            warn(format!(
                "{} non-finite vertices (first: number {} of the mesh, from 0), {} triangles dropped",
                non_finite.vertices.len(),
                first,
                non_finite.triangles
            ));
        }
        if let Some(first) = out_of_range.vertices.first() {
            warn(format!(
                "{} vertex indices out of range (first: {}, of {} vertices), {} triangles dropped",
                out_of_range.vertices.len(),
                first,
                self.positions.len(),
                out_of_range.triangles
            ));
        }
        if replaced_normals > 0 {
            warn(format!("{replaced_normals} corners have no usable normal and got their face's"));
        }
        if unusable_texcoords > 0 {
            let what = "vertices have no usable texture coordinates: opaque around them";
            warn(format!("{unusable_texcoords} {what}"));
        }
        (!mesh.triangles.is_empty()).then_some(mesh)
    }
}

impl Dropped {
    fn add(&mut self, corners: Triangle, bad: impl Fn(u32) -> bool) {
        let vertices = corners.map(|corner| corner.position);
        self.vertices.extend(vertices.into_iter().filter(|&i| bad(i)));
        self.triangles += 1;
    }
}

fn at<T: Copy>(items: &[T], index: u32) -> Option<T> {
    items.get(index as usize).copied()
}

/// `None` for a vector without a direction: zero or not finite.
fn unit(v: Vec3) -> Option<Vec3> {
    // In f64, where the squares of all finite f32 are finite and not zero.
    Some(v.as_dvec3().try_normalize()?.as_vec3())
}

/// Up for a triangle without area, whose normal nobody can see.
fn face_normal(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let [a, b, c] = [a, b, c].map(|point| point.as_dvec3());
    let normal = (b - a).cross(c - a).try_normalize();
    normal.map_or(Vec3::Y, |normal| normal.as_vec3())
}
