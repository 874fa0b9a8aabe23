//! Wavefront OBJ: a mesh for each group and run of one material.
//!
//! The reader is our own: the kept crate has no numbers of lines, reads eight numbers of a vertex as
//! an error, and loses a normal's place where others have none.

mod materials;
mod polygon;
mod statements;

use std::path::Path;
use std::rc::Rc;

use glam::{DAffine3, DVec3, Vec3};

use super::draft::{Corner, Draft};
use super::{Contents, malformed, text};
use crate::scene::SceneError;
use materials::Materials;
use statements::{Statement, numbers, statement, statements};

/// Of faces without a material: a light grey.
const DEFAULT_ALBEDO: Vec3 = Vec3::splat(0.8);

/// Of faces before the first group.
const UNNAMED: &str = "unnamed_object";

/// What the file holds, and warnings about the rest.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Contents, SceneError> {
    let text = text::decoded(bytes);
    let mut file = File::default();
    for statement in statements(&text).iter().filter_map(statement) {
        file.add(&statement).map_err(|what| malformed(path, statement.fault(&what)))?;
    }
    file.check(&text).map_err(|what| malformed(path, what))?;
    Ok(file.contents(path))
}

/// Faces of one group and one material.
struct Run {
    group: String,
    /// As the file names it, which may end in a comment.
    material: String,
    faces: Vec<Face>,
}

/// Some of the file's corners, and the line that has them.
struct Face {
    corners: std::ops::Range<usize>,
    line: usize,
}

#[derive(Default)]
struct File {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    corners: Vec<Corner>,
    runs: Vec<Run>,
    group: String,
    material: String,
    libraries: Vec<String>,
    not_faces: usize,
    free_form: usize,
}

impl File {
    fn add(&mut self, statement: &Statement) -> Result<(), String> {
        let Statement { keyword, rest, .. } = statement;
        match *keyword {
            "v" => self.positions.push(numbers(rest).ok_or("a vertex needs three numbers")?),
            "vn" => self.normals.push(numbers(rest).ok_or("a normal needs three numbers")?),
            "f" => self.face(statement)?,
            "l" | "p" => self.not_faces += 1,
            "curv" | "curv2" | "surf" => self.free_form += 1,
            "o" | "g" => {
                self.group = statements::name(rest).into();
                self.begin();
            }
            "usemtl" if self.material != *rest => {
                self.material = (*rest).into();
                self.begin();
            }
            "mtllib" => self.libraries.push((*rest).into()),
            _ => {}
        }
        Ok(())
    }

    /// Begins a mesh, if the last one has a face.
    fn begin(&mut self) {
        let run = Run {
            group: if self.group.is_empty() { UNNAMED.into() } else { self.group.clone() },
            material: self.material.clone(),
            faces: Vec::new(),
        };
        match self.runs.last_mut() {
            Some(last) if last.faces.is_empty() => *last = run,
            _ => self.runs.push(run),
        }
    }

    fn face(&mut self, statement: &Statement) -> Result<(), String> {
        let start = self.corners.len();
        for corner in statements::without_comment(statement.rest).split_whitespace() {
            let mut parts = corner.split('/');
            let position = index(parts.next(), self.positions.len(), "vertex")?;
            // before the first normal there is none to name
            let normal = parts.nth(1).filter(|_| !self.normals.is_empty());
            let normal = index(normal, self.normals.len(), "normal")?;
            let position = position.ok_or_else(|| format!("`{corner}` names no vertex"))?;
            self.corners.push(Corner { position, normal, texcoord: None });
        }
        let corners = start..self.corners.len();
        if corners.len() < 3 {
            self.not_faces += 1;
            self.corners.truncate(start);
            return Ok(());
        }
        if self.runs.is_empty() {
            self.begin();
        }
        let faces = self.runs.last_mut().map(|run| &mut run.faces);
        faces.into_iter().for_each(|faces| {
            faces.push(Face { corners: corners.clone(), line: statement.line });
        });
        Ok(())
    }

    /// Refuses faces that name what the file has nowhere; it may have it behind them.
    fn check(&self, text: &str) -> Result<(), String> {
        let vertices = self.positions.len();
        let normals = self.normals.len();
        let is_there = |corner: &Corner| {
            let normal = corner.normal.is_none_or(|normal| (normal as usize) < normals);
            (corner.position as usize) < vertices && normal
        };
        for face in self.runs.iter().flat_map(|run| &run.faces) {
            let corners = &self.corners[face.corners.clone()];
            let Some(wrong) = corners.iter().find(|corner| !is_there(corner)) else { continue };
            let what = match (wrong.position as usize) < vertices {
                false => format!("there is no vertex {}, of {vertices}", wrong.position + 1),
                true => {
                    let normal = wrong.normal.unwrap_or_default() + 1;
                    format!("there is no normal {normal}, of {normals}")
                }
            };
            return Err(statements::fault(text, face.line, &what));
        }
        Ok(())
    }

    fn contents(self, path: &Path) -> Contents {
        let mut contents = Contents::default();
        let folder = path.parent().unwrap_or(Path::new(""));
        let materials = Materials::read(folder, &self.libraries, &mut contents.warnings);
        let positions = Rc::new(self.positions);
        let normals = Rc::new(self.normals);
        let (mut faces, mut crossing) = (0, 0);
        for run in self.runs {
            faces += run.faces.len();
            let mut triangles = Vec::with_capacity(run.faces.len());
            for face in run.faces {
                let corners = &self.corners[face.corners];
                let points = corners.iter().map(|corner| positions[corner.position as usize]);
                let (cut, covered) = polygon::triangulate(&points.collect::<Vec<_>>());
                crossing += usize::from(!covered);
                triangles.extend(cut.into_iter().map(|t| t.map(|i| corners[i])));
            }
            let material = materials.get(&run.material);
            let group = run.group;
            contents.drafts.push(Draft {
                name: material.map_or(group.clone(), |(name, _)| format!("{group}/{name}")),
                positions: positions.clone(),
                normals: normals.clone(),
                texcoords: Vec::new(),
                triangles,
                places: vec![DAffine3::IDENTITY],
                albedo: material.and_then(|(_, diffuse)| diffuse).unwrap_or(DEFAULT_ALBEDO),
                mask: None,
                first_number: 1,
            });
        }
        let mut counted = |count: usize, what: &str| {
            if count > 0 {
                contents.warnings.push(format!("{count} {what}"));
            }
        };
        let few = "points, lines or faces of fewer than three corners skipped";
        counted(self.not_faces, few);
        counted(self.free_form, "free-form curves or surfaces skipped");
        counted(crossing, "polygons cross themselves or have no area, and may be covered wrongly");
        contents.found = format!("{faces} faces");
        contents
    }
}

/// An index from zero of one that counts from one, or backward from -1; `None` if it is left out.
/// Those that count forward may name what follows.
fn index(text: Option<&str>, count: usize, what: &str) -> Result<Option<u32>, String> {
    let Some(text) = text.filter(|text| !text.is_empty()) else { return Ok(None) };
    let number: i64 = text.parse().map_err(|_| format!("`{text}` is no number of a {what}"))?;
    let index = match number {
        1.. => number - 1,
        _ if number < 0 => count as i64 + number,
        _ => -1,
    };
    match u32::try_from(index) {
        // the largest would not be countable from one
        Ok(index) if index < u32::MAX => Ok(Some(index)),
        _ => Err(format!("there is no {what} {number}, of {count}")),
    }
}
