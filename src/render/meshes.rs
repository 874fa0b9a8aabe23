//! A scene's meshes in a frame: whether they are whole, their order, and their holes.

use std::cmp::Reverse;
use std::ops::Range;

use super::{Casting, Frame, FrameError, Method, Vertex, check};
use crate::scene::{Mask, Mesh};

/// A frame's part that comes from meshes alone.
#[derive(Default)]
pub(super) struct Meshes {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<[u32; 3]>,
    pub meshes: Vec<(String, Range<u32>)>,
    pub masks: Vec<(Range<u32>, Mask)>,
    pub castings: Vec<(Range<u32>, Casting)>,
}

impl Meshes {
    /// Checks the meshes and puts them one after the other, masked ones last. With castings, of
    /// the opaque ones those left out come first and those sorted last, of the masked ones the
    /// other way about: so a method's triangles are few ranges, and what is sorted most often one.
    pub(super) fn gather(meshes: &[Mesh], castings: &[Casting]) -> Result<Self, FrameError> {
        meshes.iter().try_for_each(check_mesh)?;
        let mut all = Self::default();
        let casting = |index: usize| castings.get(index).copied();
        let method = |&(index, _): &(usize, &Mesh)| casting(index).and_then(Casting::method);
        let (mut masked, mut opaque): (Vec<_>, Vec<_>) =
            meshes.iter().enumerate().partition(|(_, mesh)| mesh.mask.is_some());
        opaque.sort_by_key(method);
        masked.sort_by_key(|of| Reverse(method(of)));
        for (index, mesh) in opaque.into_iter().chain(masked) {
            let base = all.vertices.len() as u32;
            all.vertices.extend((0..mesh.positions.len()).map(|index| Vertex {
                position: mesh.positions[index],
                normal: mesh.normals[index],
                albedo: mesh.albedo,
                texcoord: mesh.texcoords.get(index).copied().unwrap_or_default(),
            }));
            let first = all.triangles.len() as u32;
            all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|index| base + index)));
            let range = first..all.triangles.len() as u32;
            all.meshes.push((mesh.name.clone(), range.clone()));
            all.castings.extend(casting(index).map(|casting| (range.clone(), casting)));
            all.masks.extend(mesh.mask.clone().map(|mask| (range, mask)));
        }
        Ok(all)
    }
}

impl Frame {
    /// The first triangle of a masked mesh: it and all after it have a mask, none before it has.
    pub fn first_masked(&self) -> u32 {
        self.masks.first().map_or(self.triangles.len() as u32, |(range, _)| range.start)
    }

    /// The triangles that the maps hold, in order, each range with the method that draws it;
    /// adjacent ranges of one method are joined, and none is empty.
    pub fn drawn(&self) -> Vec<(Range<u32>, Method)> {
        let all = (0..self.triangles.len() as u32, Casting::By(self.settings.method));
        let all = self.castings.is_empty().then_some(all);
        let mut drawn: Vec<(Range<u32>, Method)> = Vec::new();
        for (range, casting) in all.iter().chain(&self.castings) {
            let Some(method) = casting.method().filter(|_| !range.is_empty()) else { continue };
            match drawn.last_mut() {
                Some((last, by)) if *by == method && last.end == range.start => {
                    last.end = range.end;
                }
                _ => drawn.push((range.clone(), method)),
            }
        }
        drawn
    }

    /// True where some mesh casts no shadow.
    pub fn has_left_out(&self) -> bool {
        self.castings.iter().any(|(_, casting)| *casting == Casting::LeftOut)
    }

    /// True of a triangle whose mesh casts no shadow.
    pub fn is_left_out(&self, triangle: u32) -> bool {
        let out = |(range, casting): &(Range<u32>, Casting)| {
            *casting == Casting::LeftOut && range.contains(&triangle)
        };
        self.castings.iter().any(out)
    }

    /// The mask of a triangle's mesh.
    pub fn mask(&self, triangle: u32) -> Option<&Mask> {
        let index = self.masks.partition_point(|(range, _)| range.end <= triangle);
        let (range, mask) = self.masks.get(index)?;
        range.contains(&triangle).then_some(mask)
    }

    /// False where a triangle's point, given by its corners' weights, is a hole of its mask.
    pub fn opaque(&self, triangle: u32, weights: [f64; 3]) -> bool {
        self.mask(triangle).is_none_or(|mask| {
            let corners = self.triangles[triangle as usize];
            mask.opaque_at(corners.map(|index| self.vertices[index as usize].texcoord), weights)
        })
    }
}

/// What user code may have put together wrongly.
fn check_mesh(mesh: &Mesh) -> Result<(), FrameError> {
    let name = || mesh.name.clone();
    let positions = mesh.positions.len();
    if let Some(index) = mesh.positions.iter().position(|v| check("", *v).is_err()) {
        return Err(FrameError::Vertex { mesh: name(), index, value: mesh.positions[index] });
    }
    let texcoords = mesh.texcoords.len();
    let read = mesh.mask.is_some() || texcoords > 0;
    for (what, found, needed) in
        [("normals", mesh.normals.len(), true), ("texture coordinates", texcoords, read)]
    {
        if needed && found != positions {
            return Err(FrameError::Count { mesh: name(), what, found, positions });
        }
    }
    let outside = |index: &u32| *index as usize >= positions;
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|index| outside(index)) {
            return Err(FrameError::Index { mesh: name(), triangle, index, positions });
        }
    }
    match &mesh.mask {
        Some(mask) if !mask.is_usable() => {
            let Mask { width, height, cutoff, .. } = *mask;
            let found = mask.alpha.len();
            Err(FrameError::Mask { mesh: name(), width, height, found, cutoff })
        }
        _ => Ok(()),
    }
}
