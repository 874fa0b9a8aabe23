//! glTF 2.0, text or binary: triangles, punctual lights and the first perspective camera.
//!
//! The reader is our own, as the kept crates type and check a whole document before they give any of
//! it, have transforms in f32, and read neither sparse accessors without a view, nor quantised
//! positions, nor copies of a mesh.

mod accessor;
mod buffers;
mod container;
mod document;
mod extensions;
mod fault;
mod images;
mod instances;
mod light;
mod material;
mod meshopt;
mod morph;
mod nodes;
mod primitive;
mod skin;

use std::collections::HashMap;
use std::path::Path;

use glam::DAffine3;
use serde::Deserialize;
use serde_json::value::RawValue;

use super::Contents;
use crate::scene::SceneError;
use crate::scene::mask::Coverage;
use accessor::Accessors;
use buffers::Buffers;
use document::{Document, of_text};
use fault::Fault;
use images::Images;
use light::Found;
use material::{AlphaMode, Material};
use nodes::{Node, Placed, Tree};
use primitive::{Around, Other, Primitive};

/// What the file holds, and warnings about the rest.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Contents, SceneError> {
    let whole = |fault: Fault| fault.error(path, "");
    let parts = container::parts(bytes).map_err(|what| whole(what.into()))?;
    let document = Document::new(parts.json).map_err(whole)?;
    let buffers = Buffers::new(&document, path, parts.bin);
    let mut reader = Reader {
        path,
        document: &document,
        accessors: &Accessors::new(&buffers),
        images: Images { path, buffers: &buffers, decoded: HashMap::new() },
        tree: Tree::new(&document).map_err(whole)?,
        contents: Contents::default(),
        skipped: Skipped::default(),
        instances: 0,
    };
    reader.images.check()?;
    reader.contents.warnings = extensions::warnings(&document.used, &document.required);
    let mesh_nodes = reader.nodes()?;
    let Reader { mut contents, skipped, .. } = reader;
    contents.warnings.extend(skipped.report());
    let meshes = document.count("meshes");
    contents.found = format!("{meshes} meshes and {mesh_nodes} nodes that use one");
    Ok(contents)
}

struct Reader<'a> {
    path: &'a Path,
    document: &'a Document<'a>,
    accessors: &'a Accessors<'a>,
    images: Images<'a>,
    tree: Tree<'a>,
    contents: Contents,
    skipped: Skipped,
    /// Triangles of all copies.
    instances: usize,
}

/// How much of what was left out.
#[derive(Default)]
struct Skipped {
    colored: usize,
    points_or_lines: usize,
    unknown_modes: usize,
    without_positions: usize,
    directional: usize,
    dark: usize,
    /// Kinds of lights.
    unknown_lights: Vec<String>,
}

impl Skipped {
    fn report(&self) -> Vec<String> {
        let counts = [
            (self.colored, "masked primitives have vertex colours, whose alpha is ignored"),
            (self.points_or_lines, "point or line primitives skipped"),
            (self.unknown_modes, "primitives of an unknown mode skipped"),
            (self.without_positions, "primitives without positions skipped"),
            (self.directional, "directional lights skipped: they have no position"),
            (self.dark, "lights without colour, position or direction skipped"),
        ];
        let counted = counts.into_iter().filter(|(count, _)| *count > 0);
        let mut lines: Vec<_> = counted.map(|(count, what)| format!("{count} {what}")).collect();
        if let Some(kind) = self.unknown_lights.first() {
            let count = self.unknown_lights.len();
            lines.push(format!("{count} lights of an unknown kind, as `{kind}`, skipped"));
        }
        lines
    }
}

#[derive(Deserialize)]
struct Mesh<'a> {
    name: Option<String>,
    #[serde(borrow)]
    primitives: Vec<&'a RawValue>,
    #[serde(borrow)]
    weights: Option<&'a RawValue>,
}

/// Most triangles of all copies of meshes: a few kilobytes can ask for any number.
const MOST_INSTANCED: usize = 1 << 25;

impl<'a> Reader<'a> {
    /// Reads what each node holds; returns how many of those that are shown have a mesh.
    fn nodes(&mut self) -> Result<usize, SceneError> {
        let shown = std::mem::take(&mut self.tree.shown);
        let mut mesh_nodes = 0;
        for (index, Placed { node, visible }) in &shown {
            let world = self.tree.world(*index).unwrap_or(DAffine3::IDENTITY);
            if *visible {
                if let Some(mesh) = node.mesh {
                    mesh_nodes += 1;
                    self.mesh(mesh, node, world)?;
                }
                self.light(node, &world);
            }
            if let (Some(camera), None) = (node.camera, &self.contents.camera) {
                self.contents.camera = light::camera(self.document, camera, &world);
                if self.contents.camera.is_none() {
                    let warning = "a camera without a usable perspective was skipped";
                    self.contents.warnings.push(warning.into());
                }
            }
        }
        Ok(mesh_nodes)
    }

    fn light(&mut self, node: &Node, world: &DAffine3) {
        let warnings = &mut self.contents.warnings;
        match light::light(self.document, &node.extensions, world, warnings) {
            Ok(None) => {}
            Ok(Some(Found::Light(position, light))) => self.contents.lights.push((position, light)),
            Ok(Some(Found::Directional)) => self.skipped.directional += 1,
            Ok(Some(Found::Unknown(kind))) => self.skipped.unknown_lights.push(kind),
            Ok(Some(Found::Dark)) => self.skipped.dark += 1,
            Err(what) => warnings.push(format!("a light was skipped: {what}")),
        }
    }

    fn mesh(&mut self, index: usize, node: &Node, world: DAffine3) -> Result<(), SceneError> {
        let mesh: Mesh = self.get("meshes", index)?;
        let unnamed = format!("mesh {index}");
        let name = mesh.name.as_ref().or(node.name.as_ref()).unwrap_or(&unnamed);
        let joints = node.skin.and_then(|skin| self.joints(skin, name));
        let places = self.places(node, world, name);
        for (i, text) in mesh.primitives.iter().enumerate() {
            let name = match mesh.primitives.len() {
                1 => name.clone(),
                _ => format!("{name}/{i}"),
            };
            let error = |fault: Fault| fault.error(self.path, &format!("mesh `{name}`"));
            let primitive: Primitive = of_text(text).map_err(|what| error(what.into()))?;
            if let Some(other) = primitive.other() {
                self.skipped.count(other);
                continue;
            }
            let around = Around {
                name: name.clone(),
                places: &places,
                joints: joints.as_deref(),
                mesh_weights: mesh.weights,
                node_weights: node.weights,
            };
            self.primitive(&primitive, around)?;
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive, around: Around) -> Result<(), SceneError> {
        let path = self.path;
        let part = format!("mesh `{}`", around.name);
        let error = |fault: Fault| fault.error(path, &part);
        let material = Material::of(self.document, primitive.material).map_err(error)?;
        let warnings = &mut self.contents.warnings;
        let mask = match self.images.coverage(&material, &around.name, warnings)? {
            Coverage::Opaque => None,
            Coverage::Masked(mask) => Some(mask),
            Coverage::Nothing => return Ok(()),
        };
        let is_masked = matches!(material.alpha_mode(), AlphaMode::Mask);
        let has_colors = primitive.attributes.contains_key("COLOR_0");
        self.skipped.colored += usize::from(is_masked && has_colors);
        let draft = primitive.draft(around, &material, mask, self.accessors, warnings);
        let draft = draft.map_err(error)?;
        if draft.places.len() > 1 {
            self.instances += draft.places.len().saturating_mul(draft.triangles.len());
            if self.instances > MOST_INSTANCED {
                let what = format!("its copies have more than {MOST_INSTANCED} triangles");
                return Err(error(what.into()));
            }
        }
        self.contents.drafts.push(draft);
        Ok(())
    }

    fn get<T: Deserialize<'a>>(&self, list: &str, index: usize) -> Result<T, SceneError> {
        self.document.get(list, index).map_err(|fault| fault.error(self.path, ""))
    }

    /// Of a skin; `None`, with a warning, for one that cannot be used.
    fn joints(&mut self, skin: usize, mesh: &str) -> Option<Vec<DAffine3>> {
        let joints = skin::joints(skin, self.document, &mut self.tree, self.accessors);
        let mut warn = |fault: Fault| {
            let what = format!("mesh `{mesh}`: skin ignored, shown in its bind pose: {fault}");
            self.contents.warnings.push(what);
        };
        joints.map_err(&mut warn).ok()
    }

    /// Where the copies of a node's mesh are; the node's own place if there are none.
    fn places(&mut self, node: &Node, world: DAffine3, mesh: &str) -> Vec<DAffine3> {
        match instances::places(&node.extensions, self.accessors) {
            Ok(Some(places)) => places.into_iter().map(|place| world * place).collect(),
            Ok(None) => vec![world],
            Err(fault) => {
                let what = format!("mesh `{mesh}`: copies ignored, shown once: {fault}");
                self.contents.warnings.push(what);
                vec![world]
            }
        }
    }
}

impl Skipped {
    fn count(&mut self, other: Other) {
        *match other {
            Other::PointsOrLines => &mut self.points_or_lines,
            Other::UnknownMode => &mut self.unknown_modes,
            Other::NoPositions => &mut self.without_positions,
        } += 1;
    }
}
