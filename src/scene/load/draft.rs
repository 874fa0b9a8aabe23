//! A mesh as a file gives it, and what is done so that every field of [`Mesh`] holds its promise.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};

use super::unit;
use crate::scene::{Mask, Mesh};

/// A triangle's corner: indices of its position, normal and texture coordinates, counted from zero,
/// unchecked.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub position: u32,
    pub normal: Option<u32>,
    pub texcoord: Option<u32>,
}

pub(super) type Triangle = [Corner; 3];

/// A mesh as a file gives it; nothing about it is certain.
pub(super) struct Draft {
    pub name: String,
    pub positions: Rc<Vec<DVec3>>,
    pub normals: Rc<Vec<DVec3>>,
    pub texcoords: Vec<Vec2>,
    pub triangles: Vec<Triangle>,
    /// Into the file's coordinates; as many copies of the mesh as there are places.
    pub places: Vec<DAffine3>,
    pub albedo: Vec3,
    pub mask: Option<Mask>,
    /// The number that the file gives its first vertex.
    pub first_number: u32,
}

/// Vertices that cannot be used, and how many triangles they cost.
#[derive(Default)]
struct Dropped {
    vertices: BTreeSet<u32>,
    triangles: usize,
}

/// What had to be left out or replaced.
#[derive(Default)]
struct Faults {
    out_of_range: Dropped,
    non_finite: Dropped,
    normals: u32,
    texcoords: u32,
}

impl Draft {
    /// Every triangle in the file's coordinates; corners out of range are not finite.
    pub fn world(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.places.iter().flat_map(|place| {
            let corner = |corner: Corner| {
                let position = at(&self.positions, corner.position).unwrap_or(DVec3::NAN);
                place.transform_point3(position)
            };
            self.triangles.iter().map(move |corners| corners.map(corner))
        })
    }

    /// Moves the mesh to the scene's origin, drops the triangles that cannot be used, gives every
    /// corner a unit normal, and says so; `None` if no triangle is left.
    pub fn finish(self, origin: DVec3, warnings: &mut Vec<String>) -> Option<Mesh> {
        let mut mesh = Mesh {
            name: self.name.clone(),
            triangles: Vec::with_capacity(self.places.len() * self.triangles.len()),
            albedo: self.albedo,
            mask: self.mask.clone(),
            ..Mesh::default()
        };
        let mut faults = Faults::default();
        for place in &self.places {
            self.copy(place, origin, &mut mesh, &mut faults);
        }
        faults.report(&self, warnings);
        (!mesh.triangles.is_empty()).then_some(mesh)
    }

    /// Adds the mesh at one place. Corners without a normal get their face's, as the glTF
    /// specification asks (3.7.2.1).
    fn copy(&self, place: &DAffine3, origin: DVec3, mesh: &mut Mesh, faults: &mut Faults) {
        let to_world = normal_matrix(place.matrix3);
        // A mirroring transform turns the winding around (glTF 2.0, 3.7.4).
        let mirrored = place.matrix3.determinant() < 0.0;
        // in f64 up to here, and rounded once
        let position = |i| {
            let position = at(&self.positions, i)?;
            Some((place.transform_point3(position) - origin).as_vec3())
        };
        let normal = |i| unit(to_world * at(&self.normals, i)?);
        let mut known = HashMap::new();
        for &[a, b, c] in &self.triangles {
            let corners = if mirrored { [a, c, b] } else { [a, b, c] };
            let points = corners.map(|corner| position(corner.position));
            let [Some(a), Some(b), Some(c)] = points else {
                faults.out_of_range.add(corners, |i| position(i).is_none());
                continue;
            };
            if ![a, b, c].iter().all(|point| point.is_finite()) {
                let bad = |i| position(i).is_some_and(|point| !point.is_finite());
                faults.non_finite.add(corners, bad);
                continue;
            }
            let mut add = |corner: Corner, position: Vec3, normal: Vec3| {
                mesh.positions.push(position);
                mesh.normals.push(normal);
                if mesh.mask.is_some() {
                    let texcoord = corner.texcoord.and_then(|i| at(&self.texcoords, i));
                    let texcoord = texcoord.unwrap_or(Vec2::NAN);
                    faults.texcoords += u32::from(!texcoord.is_finite());
                    mesh.texcoords.push(texcoord);
                }
                mesh.positions.len() as u32 - 1
            };
            let triangle = [(corners[0], a), (corners[1], b), (corners[2], c)];
            mesh.triangles.push(triangle.map(|(corner, position)| {
                let given = corner.normal.map(normal);
                if let Some(Some(normal)) = given {
                    *known.entry(corner).or_insert_with(|| add(corner, position, normal))
                } else {
                    faults.normals += u32::from(given.is_some());
                    add(corner, position, face_normal(a, b, c))
                }
            }));
        }
    }
}

impl Faults {
    fn report(self, draft: &Draft, warnings: &mut Vec<String>) {
        let mut warn = |what: String| warnings.push(format!("mesh `{}`: {what}", draft.name));
        let from = draft.first_number;
        if let Some(first) = self.non_finite.vertices.first() {
            warn(format!(
                "{} non-finite vertices (first: number {}, from {from}), {} triangles dropped",
                self.non_finite.vertices.len(),
                first + from,
                self.non_finite.triangles
            ));
        }
        if let Some(first) = self.out_of_range.vertices.first() {
            warn(format!(
                "{} vertex indices out of range (first: {}, of {} vertices), {} triangles dropped",
                self.out_of_range.vertices.len(),
                first,
                draft.positions.len(),
                self.out_of_range.triangles
            ));
        }
        if self.normals > 0 {
            warn(format!("{} corners have no usable normal and got their face's", self.normals));
        }
        if self.texcoords > 0 {
            let what = "vertices have no usable texture coordinates: opaque around them";
            warn(format!("{} {what}", self.texcoords));
        }
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

/// Up for a triangle without area, whose normal nobody can see.
fn face_normal(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let [a, b, c] = [a, b, c].map(|point| point.as_dvec3());
    let normal = (b - a).cross(c - a).try_normalize();
    normal.map_or(Vec3::Y, |normal| normal.as_vec3())
}

/// The inverse transpose but for a positive factor; as cofactors it exists for flat scales too.
pub(super) fn normal_matrix(m: DMat3) -> DMat3 {
    let sign = m.determinant().signum();
    DMat3::from_cols(
        m.y_axis.cross(m.z_axis) * sign,
        m.z_axis.cross(m.x_axis) * sign,
        m.x_axis.cross(m.y_axis) * sign,
    )
}
