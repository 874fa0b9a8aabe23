//! Wavefront OBJ: polygons with optional normals, grouped by object or group and material.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};

use super::polygon::triangulate;
use super::{Corner, Draft, Triangle, albedo, at, malformed};
use crate::scene::{Scene, SceneError};

/// Of faces without a material: a light grey.
const DEFAULT_ALBEDO: Vec3 = Vec3::splat(0.8);

/// Adds the file's meshes and warnings to the scene; returns what it found, in words.
pub(super) fn read(path: &Path, bytes: &[u8], scene: &mut Scene) -> Result<String, SceneError> {
    let mut file =
        File { folder: path.parent().unwrap_or(Path::new("")).into(), ..File::default() };
    // Names and comments may be in any encoding.
    let text = String::from_utf8_lossy(bytes);
    let mut statement = String::new();
    // The empty last line ends a statement that the file's last line leaves open.
    for (number, line) in (1..).zip(text.lines().chain([""])) {
        if let Some(continued) = line.strip_suffix('\\') {
            statement.push_str(continued);
            statement.push(' ');
            continue;
        }
        statement.push_str(line);
        file.statement(statement.trim())
            .ok_or_else(|| malformed(path, format!("cannot read line {number}: `{line}`")))?;
        statement.clear();
    }
    file.finish(scene)
}

/// A group's and a material's name: the faces that share both are a mesh.
type Key = (String, String);

#[derive(Default)]
struct File {
    folder: PathBuf,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// In order of appearance.
    meshes: Vec<(Key, Vec<Triangle>)>,
    index_of: HashMap<Key, usize>,
    /// Of the faces to come.
    current: Key,
    albedo_of: HashMap<String, Vec3>,
    warnings: Vec<String>,
    faces: usize,
    not_faces: usize,
    crossing: usize,
}

impl File {
    /// `None` if the statement cannot be read. Statements about anything else are passed over.
    fn statement(&mut self, text: &str) -> Option<()> {
        let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        match keyword {
            "v" => self.positions.push(vector(rest)?),
            "vn" => self.normals.push(vector(rest)?),
            "f" => self.face(rest)?,
            "l" | "p" => self.not_faces += 1,
            "o" | "g" => self.current.0 = rest.into(),
            "usemtl" => self.current.1 = rest.into(),
            "mtllib" => self.libraries(rest),
            _ => {}
        }
        Some(())
    }

    fn face(&mut self, rest: &str) -> Option<()> {
        let corners: Option<Vec<Corner>> =
            rest.split_whitespace().map(|text| self.corner(text)).collect();
        let corners = corners?;
        if corners.len() < 3 {
            self.not_faces += 1;
            return Some(());
        }
        self.faces += 1;
        let triangles = self.triangulated(&corners);
        let index = match self.index_of.get(&self.current) {
            Some(index) => *index,
            None => {
                self.index_of.insert(self.current.clone(), self.meshes.len());
                self.meshes.push((self.current.clone(), Vec::new()));
                self.meshes.len() - 1
            }
        };
        let triangles = triangles.into_iter().map(|t| t.map(|i| corners[i]));
        self.meshes[index].1.extend(triangles);
        Some(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`; one is the first, negative counts from the last.
    fn corner(&self, text: &str) -> Option<Corner> {
        let index = |text: &str, count: usize| {
            let number: i64 = text.parse().ok()?;
            Some(if number < 0 { count as i64 + number } else { number - 1 })
        };
        let mut fields = text.split('/');
        let position = index(fields.next()?, self.positions.len())?;
        let normal = match fields.nth(1) {
            None | Some("") => None,
            Some(text) => Some(index(text, self.normals.len())?),
        };
        Some(Corner { position, normal })
    }

    /// Corner numbers of the triangles that cover the face.
    fn triangulated(&mut self, corners: &[Corner]) -> Vec<[usize; 3]> {
        // A polygon with a corner that is missing or infinite will be dropped: any cut will do.
        let points = corners.iter().map(|corner| {
            let point = at(&self.positions, corner.position);
            point.filter(|p| p.is_finite()).unwrap_or_default()
        });
        let points: Vec<DVec3> = points.map(|p| p.as_dvec3()).collect();
        let (triangles, simple) = triangulate(&points);
        self.crossing += usize::from(!simple);
        triangles
    }

    /// `mtllib` names one file, possibly with spaces in it, or several.
    fn libraries(&mut self, rest: &str) {
        let names: Vec<&str> = if self.folder.join(rest).exists() {
            vec![rest]
        } else {
            rest.split_whitespace().collect()
        };
        for name in names {
            match std::fs::read(self.folder.join(name)) {
                Ok(bytes) => self.materials(&String::from_utf8_lossy(&bytes)),
                Err(error) => self.warnings.push(format!(
                    "material library `{name}` cannot be read ({error}): its materials are grey"
                )),
            }
        }
    }

    /// The diffuse colours; a single number is a grey.
    fn materials(&mut self, text: &str) {
        let mut name = "";
        for line in text.lines() {
            let (keyword, rest) = line.trim().split_once(char::is_whitespace).unwrap_or_default();
            let numbers: Vec<f32> = rest.split_whitespace().map_while(|n| n.parse().ok()).collect();
            match (keyword, &numbers[..]) {
                ("newmtl", _) => name = rest.trim(),
                ("Kd", &[r, g, b, ..]) => _ = self.albedo_of.insert(name.into(), albedo([r, g, b])),
                ("Kd", &[grey, ..]) => _ = self.albedo_of.insert(name.into(), albedo([grey; 3])),
                _ => {}
            }
        }
    }

    fn finish(self, scene: &mut Scene) -> Result<String, SceneError> {
        scene.warnings = self.warnings;
        let mut counted = |count: usize, what: &str| {
            if count > 0 {
                scene.warnings.push(format!("{count} {what}"));
            }
        };
        counted(self.not_faces, "points, lines or faces of fewer than three corners skipped");
        counted(self.crossing, "polygons cross themselves and may be covered wrongly");
        let found = format!("{} vertices and {} faces", self.positions.len(), self.faces);
        for ((group, material), triangles) in self.meshes {
            let names = [group.as_str(), material.as_str()];
            let named: Vec<&str> = names.into_iter().filter(|name| !name.is_empty()).collect();
            let draft = Draft {
                name: if named.is_empty() { "unnamed".into() } else { named.join("/") },
                positions: &self.positions,
                normals: &self.normals,
                triangles,
                albedo: self.albedo_of.get(&material).copied().unwrap_or(DEFAULT_ALBEDO),
                first_index: 1,
            };
            scene.meshes.extend(draft.finish(&mut scene.warnings));
        }
        Ok(found)
    }
}

/// The first three numbers; more are a weight or a colour.
fn vector(text: &str) -> Option<Vec3> {
    let mut numbers = text.split_whitespace().map(|number| number.parse().ok());
    let mut next = || numbers.next().flatten();
    Some(Vec3::new(next()?, next()?, next()?))
}
