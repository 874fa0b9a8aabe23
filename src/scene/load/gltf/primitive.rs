//! One glTF primitive: its attributes made into a draft.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DAffine3, DMat3, DVec3, Vec2};
use serde::Deserialize;
use serde_json::value::RawValue;

use super::accessor::Accessors;
use super::document::Extensions;
use super::fault::Fault;
use super::material::Material;
use super::morph::Morph;
use super::skin;
use crate::scene::Mask;
use crate::scene::load::albedo;
use crate::scene::load::draft::{Corner, Draft, normal_matrix};

#[derive(Deserialize)]
pub(super) struct Primitive<'a> {
    #[serde(default)]
    pub attributes: HashMap<String, usize>,
    indices: Option<usize>,
    mode: Option<u64>,
    pub material: Option<usize>,
    #[serde(borrow)]
    pub targets: Option<&'a RawValue>,
    #[serde(borrow, default)]
    pub extensions: Extensions<'a>,
}

const TRIANGLES: u64 = 4;
const STRIP: u64 = 5;
const FAN: u64 = 6;

/// What a primitive without triangles is.
pub(super) enum Other {
    PointsOrLines,
    UnknownMode,
    NoPositions,
}

/// What the node and the mesh around a primitive make of it.
pub(super) struct Around<'a> {
    pub name: String,
    pub places: &'a [DAffine3],
    /// Of a skin, in the file's coordinates.
    pub joints: Option<&'a [DAffine3]>,
    pub mesh_weights: Option<&'a RawValue>,
    pub node_weights: Option<&'a RawValue>,
}

/// A primitive's attributes and where they come from.
struct Source<'a> {
    primitive: &'a Primitive<'a>,
    accessors: &'a Accessors<'a>,
}

const DRACO: &str = "KHR_draco_mesh_compression";

impl<'a> Source<'a> {
    fn new(primitive: &'a Primitive<'a>, accessors: &'a Accessors<'a>) -> Result<Self, Fault> {
        accessors.buffers.document.check(&primitive.extensions)?;
        // the format allows for the data as they are, beside the compressed
        let has_view = |index: &usize| {
            accessors.get(*index).is_ok_and(|accessor| accessor.buffer_view.is_some())
        };
        let mut needed = primitive.attributes.get("POSITION").into_iter().chain(&primitive.indices);
        if !primitive.extensions.contains_key(DRACO) || needed.all(has_view) {
            return Ok(Self { primitive, accessors });
        }
        let remedy = super::extensions::remedy(DRACO);
        Err(format!("{DRACO} is not decoded: {remedy}").into())
    }

    /// An attribute's vectors, morphed; `None` if there is no such attribute.
    fn vectors<const N: usize>(
        &self,
        name: &str,
        what: &str,
        morph: &Morph,
        warn: &mut dyn FnMut(String),
    ) -> Result<Option<Vec<[f64; N]>>, Fault> {
        let Some(&index) = self.primitive.attributes.get(name) else { return Ok(None) };
        let base = self.accessors.vectors(index, what)?;
        let mut moved = base.clone();
        match morph.add(name, &mut moved, self.accessors) {
            Ok(()) => Ok(Some(moved)),
            Err(fault) => {
                warn(format!("morph targets ignored: {fault}"));
                Ok(Some(base))
            }
        }
    }

    fn indices(&self, vertices: usize) -> Result<Vec<u32>, Fault> {
        match self.primitive.indices {
            Some(index) => self.accessors.integers(index, "indices"),
            None => Ok((0..vertices as u32).collect()),
        }
    }
}

impl Primitive<'_> {
    /// Why it has no triangles, if it has none.
    pub fn other(&self) -> Option<Other> {
        match self.mode.unwrap_or(TRIANGLES) {
            0..TRIANGLES => Some(Other::PointsOrLines),
            TRIANGLES..=FAN if self.attributes.contains_key("POSITION") => None,
            TRIANGLES..=FAN => Some(Other::NoPositions),
            _ => Some(Other::UnknownMode),
        }
    }

    /// An error says what is wrong with the file.
    pub fn draft(
        &self,
        around: Around,
        material: &Material,
        mut mask: Option<Mask>,
        accessors: &Accessors,
        warnings: &mut Vec<String>,
    ) -> Result<Draft, Fault> {
        let name = around.name.clone();
        let mut warn = |what: String| warnings.push(format!("mesh `{name}`: {what}"));
        let source = Source::new(self, accessors)?;
        let morph = Morph::new(self.targets, around.node_weights, around.mesh_weights);
        let morph = morph.unwrap_or_else(|fault| {
            warn(format!("morph targets ignored: {fault}"));
            Morph::default()
        });
        let positions = source.vectors("POSITION", "positions", &morph, &mut warn)?;
        let mut positions = to_vectors(positions.unwrap_or_default());
        let normals = source.vectors("NORMAL", "normals", &morph, &mut warn)?;
        let mut normals = normals.map(to_vectors);
        let indices = source.indices(positions.len())?;
        let mut texcoords = None;
        if mask.is_some() {
            let set = format!("TEXCOORD_{}", material.texcoord_set());
            texcoords = source.vectors::<2>(&set, "texture coordinates", &morph, &mut warn)?;
            if texcoords.is_none() {
                warn("its mask has no texture coordinates, so it is opaque".into());
                mask = None;
            }
        }

        let mut triangles = triangles(self.mode.unwrap_or(TRIANGLES), &indices);
        let mut places = around.places.to_vec();
        if let Some(joints) = around.joints {
            match skin::vertices(&self.attributes, positions.len(), joints, accessors) {
                Ok(matrices) => {
                    places = vec![DAffine3::IDENTITY];
                    turn_mirrored(&mut triangles, &matrices);
                    for (position, matrix) in positions.iter_mut().zip(&matrices) {
                        *position = matrix.transform_point3(*position);
                    }
                    for (normal, matrix) in normals.iter_mut().flatten().zip(&matrices) {
                        *normal = normal_matrix(matrix.matrix3) * *normal;
                    }
                }
                Err(fault) => warn(format!("skin ignored, shown in its bind pose: {fault}")),
            }
        }
        let has_normals = normals.is_some();
        let corner = |position| Corner {
            position,
            normal: has_normals.then_some(position),
            texcoord: mask.is_some().then_some(position),
        };
        let transform = material.texcoord_transform();
        let [r, g, b, _] = material.color_factor();
        Ok(Draft {
            name: around.name,
            positions: Rc::new(positions),
            normals: Rc::new(normals.unwrap_or_default()),
            texcoords: texcoords
                .into_iter()
                .flatten()
                .map(|[u, v]| transform(Vec2::new(u as f32, v as f32)))
                .collect(),
            triangles: triangles.into_iter().map(|t| t.map(corner)).collect(),
            places,
            albedo: albedo([r, g, b]),
            mask,
            first_number: 0,
        })
    }
}

fn to_vectors(list: Vec<[f64; 3]>) -> Vec<DVec3> {
    list.into_iter().map(DVec3::from).collect()
}

/// Turns around the triangles whose first corner's joints mirror.
fn turn_mirrored(triangles: &mut [[u32; 3]], matrices: &[DAffine3]) {
    let mirrored = |m: &DMat3| m.determinant() < 0.0;
    for triangle in triangles {
        if matrices.get(triangle[0] as usize).is_some_and(|matrix| mirrored(&matrix.matrix3)) {
            triangle.swap(1, 2);
        }
    }
}

/// Indices of each triangle, as glTF 2.0 numbers them (3.7.2.1).
fn triangles(mode: u64, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        STRIP => indices
            .windows(3)
            .enumerate()
            .map(|(i, t)| [t[0], t[1 + i % 2], t[2 - i % 2]])
            .collect(),
        FAN => indices.windows(2).skip(1).map(|edge| [edge[0], edge[1], indices[0]]).collect(),
        _ => indices.as_chunks().0.to_vec(),
    }
}
