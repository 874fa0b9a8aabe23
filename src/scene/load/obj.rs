//! Wavefront OBJ as the `tobj` crate reads it: a mesh for each group and run of one material.

use std::cell::RefCell;
use std::fmt::Display;
use std::path::Path;

use earcut::{Earcut, deviation, utils3d::project3d_to_2d};
use glam::Vec3;
use tobj::{LoadOptions, MTLLoadResult, Material, Model};

use super::{Corner, Draft, albedo, malformed, named};
use crate::scene::{Scene, SceneError};

/// Of faces without a material: a light grey.
const DEFAULT_ALBEDO: Vec3 = Vec3::splat(0.8);

/// Adds the file's meshes and warnings to the scene; returns what it found, in words.
pub(super) fn read(path: &Path, bytes: &[u8], scene: &mut Scene) -> Result<String, SceneError> {
    let warnings = &mut scene.warnings;
    let text = clean(bytes);
    // `tobj` would make faces of lines, and check texture coordinates, which nobody needs.
    let mut not_faces = statements(&text, &["l", "p"]).lines().count();
    let used = ["v", "vn", "f", "o", "g", "usemtl", "mtllib"];
    let (models, materials) = load(path, &statements(&text, &used), warnings)?;

    let (mut faces, mut crossing) = (0, 0);
    for Model { mut mesh, name } in models {
        if mesh.face_arities.is_empty() {
            mesh.face_arities = vec![3; mesh.indices.len() / 3];
        }
        let positions = vectors(&mesh.positions);
        let mut normals = vectors(&mesh.normals);
        // `tobj` leaves no gap for a missing normal, so nobody knows whose the others are.
        if !normals.is_empty() && normals.len() != positions.len() {
            normals.clear();
            let what = "some corners have no normal, so all got their face's";
            warnings.push(format!("mesh `{name}`: {what}"));
        }
        let normal = |position| (!normals.is_empty()).then_some(position);
        let corner = |position| Corner { position, normal: normal(position), texcoord: None };
        let mut triangles = Vec::new();
        let mut rest = &mesh.indices[..];
        for &arity in &mesh.face_arities {
            let (face, others) = rest.split_at(arity as usize);
            rest = others;
            if arity < 3 {
                not_faces += 1;
                continue;
            }
            faces += 1;
            let points: Vec<Vec3> = face.iter().map(|&i| positions[i as usize]).collect();
            let (cut, covered) = triangulate(&points);
            crossing += usize::from(!covered);
            triangles.extend(cut.into_iter().map(|t| t.map(|i| corner(face[i]))));
        }
        let material = mesh.material_id.map(|i| &materials[i]);
        let draft = Draft {
            name: material.map_or(name.clone(), |material| format!("{name}/{}", material.name)),
            positions: &positions,
            normals: &normals,
            texcoords: &[],
            triangles,
            albedo: material.and_then(|material| material.diffuse).map_or(DEFAULT_ALBEDO, albedo),
            mask: None,
        };
        scene.meshes.extend(draft.finish(warnings));
    }
    let mut counted = |count: usize, what: &str| {
        if count > 0 {
            warnings.push(format!("{count} {what}"));
        }
    };
    counted(not_faces, "points, lines or faces of fewer than three corners skipped");
    counted(crossing, "polygons cross themselves or have no area, and may be covered wrongly");
    Ok(format!("{faces} faces"))
}

fn load(
    path: &Path,
    text: &str,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Model>, Vec<Material>), SceneError> {
    let options = LoadOptions {
        // With indices of their own, normals that are missing would be the previous corner's.
        single_index: true,
        ..LoadOptions::default()
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let warnings = RefCell::new(warnings);
    let mut rest = text.as_bytes();
    let loaded = tobj::load_obj_buf(&mut rest, &options, |names| {
        libraries(folder, &names.to_string_lossy(), &mut warnings.borrow_mut())
    });
    let (models, materials) = loaded.map_err(|error| {
        // The last line that `tobj` has read; it checks indices at the end of a mesh only.
        let read = &text[..text.len() - rest.len()];
        let line = read.lines().next_back().unwrap_or_default();
        malformed(path, format!("{error}, at or before the line `{line}`"))
    })?;
    Ok((models, materials.unwrap_or_default()))
}

/// The names and diffuse colours of the one file, possibly with spaces in its name, or several.
fn libraries(folder: &Path, names: &str, warnings: &mut Vec<String>) -> MTLLoadResult {
    let mut warn = |name: &str, error: &dyn Display| {
        warnings.push(format!(
            "material library `{name}` cannot be read ({error}): its materials are grey"
        ));
    };
    let files = match folder.join(names).exists() {
        true => vec![names],
        false => names.split_whitespace().collect(),
    };
    let mut text = String::new();
    for name in files {
        match named::read(&folder.join(name)) {
            Ok(bytes) => text += &statements(&clean(&bytes), &["newmtl", "Kd"]),
            Err(error) => warn(name, &error),
        }
    }
    // `tobj` panics for a colour of fewer than three numbers, as a grey is, and ignores a fourth.
    let lines = text.lines().map(|line| match line.split_whitespace().next_back() {
        Some(last) if line.starts_with("Kd") => format!("{line} {last} {last}\n"),
        _ => format!("{line}\n"),
    });
    let text: String = lines.collect();
    tobj::load_mtl_buf(&mut text.as_bytes()).inspect_err(|error| warn(names, error))
}

/// Statements one a line, as `tobj` wants them: it knows no continued lines, and takes
/// indentation and tabs for parts of names. Names may be in any encoding.
fn clean(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n");
    text.replace("\\\n", " ").replace('\t', " ")
}

/// Those of some kinds.
fn statements(text: &str, keywords: &[&str]) -> String {
    let lines = text.lines().map(str::trim);
    let kept = lines.filter(|line| {
        let keyword = line.split_whitespace().next();
        keyword.is_some_and(|keyword| keywords.contains(&keyword))
    });
    kept.flat_map(|line| [line, "\n"]).collect()
}

/// Corner numbers of triangles that wind like the polygon, and whether they cover it once.
fn triangulate(polygon: &[Vec3]) -> (Vec<[usize; 3]>, bool) {
    /// Of the areas, relative. Polygons that cross themselves are far beyond it.
    const MAX_DEVIATION: f64 = 1e-6;
    let corners = polygon.len();
    let fan = || (2..corners).map(|i| [0, i - 1, i]).collect();
    // What is not finite will be dropped: any cut will do.
    if corners == 3 || !polygon.iter().all(|point| point.is_finite()) {
        return (fan(), true);
    }
    let points = polygon.iter().map(|point| point.as_dvec3().to_array());
    let points: Vec<[f64; 3]> = points.collect();
    let (mut flat, mut cut) = (Vec::new(), Vec::new());
    if !project3d_to_2d(&points, corners, &mut flat) {
        return (fan(), false);
    }
    Earcut::new().earcut_slice(&flat, &[], &mut cut);
    if deviation(flat, &[], &cut) > MAX_DEVIATION {
        return (fan(), false);
    }
    (cut.as_chunks().0.to_vec(), true)
}

fn vectors(numbers: &[f32]) -> Vec<Vec3> {
    numbers.chunks_exact(3).map(Vec3::from_slice).collect()
}
