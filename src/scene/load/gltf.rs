//! glTF 2.0, text or binary: triangles, punctual lights and the first perspective camera.

use std::collections::HashMap;
use std::f32::consts::PI;
use std::path::Path;

use ::gltf::camera::Projection;
use ::gltf::json::validation::Checked;
use ::gltf::khr_lights_punctual::Kind;
use ::gltf::material::AlphaMode;
use ::gltf::{Document, Gltf, Node, Semantic, buffer};
use glam::{Mat4, Vec3};

use super::alpha::Images;
use super::{malformed, named, primitive, unit};
use crate::scene::mask::Coverage;
use crate::scene::{Camera, Light, Scene, SceneError};

/// Adds the file's content and warnings to the scene; returns what it found, in words.
pub(super) fn read(path: &Path, bytes: &[u8], scene: &mut Scene) -> Result<String, SceneError> {
    let file = Gltf::from_slice_without_validation(bytes).map_err(|e| malformed(path, e))?;
    let mut json = file.document.into_json();
    for extension in std::mem::take(&mut json.extensions_required) {
        if ["KHR_materials_", "KHR_texture_", "EXT_texture_"]
            .iter()
            .any(|appearance| extension.starts_with(appearance))
        {
            scene.warnings.push(format!("extension `{extension}` ignored"));
        } else if extension != "KHR_lights_punctual" {
            return Err(SceneError::RequiredExtension { path: path.into(), extension });
        }
    }
    let mut colored = 0;
    // The crate's validation refuses attributes that it does not know, which the format allows.
    for primitive in json.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        let material = primitive.material.and_then(|index| json.materials.get(index.value()));
        let masked = material.is_some_and(|m| m.alpha_mode == Checked::Valid(AlphaMode::Mask));
        let colors = Checked::Valid(Semantic::Colors(0));
        colored += usize::from(masked && primitive.attributes.contains_key(&colors));
        primitive.attributes.retain(|name, _| match name {
            Checked::Valid(Semantic::Positions | Semantic::Normals) => true,
            Checked::Valid(Semantic::TexCoords(_)) => masked,
            _ => false,
        });
    }
    let document = Document::from_json(json).map_err(|e| malformed(path, e))?;
    let mut reader = Reader {
        path,
        buffers: buffers(path, &document, file.blob)?,
        images: Images { path, decoded: HashMap::new() },
        scene,
        mesh_nodes: 0,
        not_triangles: 0,
        directional: 0,
        dark: 0,
    };
    reader.images.check(&document, &reader.buffers)?;
    reader.nodes(&document)?;
    let Reader { mesh_nodes, not_triangles, directional, dark, .. } = reader;
    let mut counted = |count: usize, what: &str| {
        if count > 0 {
            scene.warnings.push(format!("{count} {what}"));
        }
    };
    counted(colored, "masked primitives have vertex colours, whose alpha is ignored");
    counted(not_triangles, "point or line primitives skipped");
    counted(directional, "directional lights skipped: they have no position");
    counted(dark, "lights without colour, position or direction skipped");
    let meshes = document.meshes().len();
    Ok(format!("{meshes} meshes and {mesh_nodes} nodes that use one"))
}

/// Every buffer's bytes, from the file itself, a data URI or another file.
fn buffers(
    path: &Path,
    document: &Document,
    mut blob: Option<Vec<u8>>,
) -> Result<Vec<buffer::Data>, SceneError> {
    let folder = path.parent();
    document
        .buffers()
        .map(|buffer| {
            let uri = match buffer.source() {
                buffer::Source::Bin => "BIN chunk",
                buffer::Source::Uri(uri) if uri.starts_with("data:") => "data URI",
                buffer::Source::Uri(uri) => uri,
            };
            let error =
                |what: String| SceneError::Buffer { path: path.into(), uri: uri.into(), what };
            let mut data = match buffer.source() {
                buffer::Source::Uri(uri) => named::of_uri(uri, folder).map_err(error)?,
                buffer::Source::Bin => blob.take().ok_or_else(|| error("there is none".into()))?,
            };
            // lengths that count the padding of a multiple of 4 are common
            data.resize(data.len().next_multiple_of(4), 0);
            let data = buffer::Data(data);
            if data.len() < buffer.length() {
                let (is, wants) = (data.len(), buffer.length());
                return Err(error(format!("it has {is} bytes of {wants}")));
            }
            Ok(data)
        })
        .collect()
}

struct Reader<'a> {
    path: &'a Path,
    buffers: Vec<buffer::Data>,
    images: Images<'a>,
    scene: &'a mut Scene,
    mesh_nodes: usize,
    not_triangles: usize,
    directional: usize,
    dark: usize,
}

impl Reader<'_> {
    /// The nodes of the default scene, else of the first, else all nodes; each once.
    fn nodes(&mut self, document: &Document) -> Result<(), SceneError> {
        let mut roots: Vec<Node> = document
            .default_scene()
            .or_else(|| document.scenes().next())
            .into_iter()
            .flat_map(|scene| scene.nodes())
            .collect();
        if roots.is_empty() {
            let mut is_root = vec![true; document.nodes().len()];
            for child in document.nodes().flat_map(|node| node.children()) {
                is_root[child.index()] = false;
            }
            roots = document.nodes().filter(|node| is_root[node.index()]).collect();
        }
        // A stack, not recursion, and a mark: the file may be deep, or cyclic against the rules.
        let mut stack: Vec<(Node, Mat4)> =
            roots.into_iter().rev().map(|node| (node, Mat4::IDENTITY)).collect();
        let mut seen = vec![false; document.nodes().len()];
        while let Some((node, parent)) = stack.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                continue;
            }
            let world = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
            self.node(&node, world)?;
            let first = stack.len();
            stack.extend(node.children().map(|child| (child, world)));
            stack[first..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, node: &Node, world: Mat4) -> Result<(), SceneError> {
        if let Some(mesh) = node.mesh() {
            self.mesh_nodes += 1;
            let unnamed = format!("mesh {}", mesh.index());
            let name = mesh.name().or(node.name()).unwrap_or(&unnamed);
            if node.skin().is_some() {
                let warning = format!("mesh `{name}`: skin ignored, shown in its bind pose");
                self.scene.warnings.push(warning);
            }
            for it in mesh.primitives() {
                let name = match mesh.primitives().len() {
                    1 => name.to_string(),
                    _ => format!("{name}/{}", it.index()),
                };
                if !primitive::has_triangles(it.mode()) {
                    self.not_triangles += 1;
                    continue;
                }
                let warnings = &mut self.scene.warnings;
                let images = &mut self.images;
                let mask = match images.coverage(&it.material(), &name, &self.buffers, warnings)? {
                    Coverage::Opaque => None,
                    Coverage::Masked(mask) => Some(mask),
                    Coverage::Nothing => continue,
                };
                let (label, buffers) = (name.clone(), &self.buffers);
                let mesh = primitive::mesh(label, &it, mask, world, buffers, warnings)
                    .map_err(|what| malformed(self.path, format!("mesh `{name}`: {what}")))?;
                self.scene.meshes.extend(mesh);
            }
        }
        let eye = world.w_axis.truncate();
        let forward = unit(-world.z_axis.truncate());
        if let Some(light) = node.light() {
            match (light.kind(), self::light(&light, eye, forward)) {
                (Kind::Directional, _) => self.directional += 1,
                (_, Some(light)) => self.scene.lights.push(light),
                (_, None) => self.dark += 1,
            }
        }
        if let (Some(camera), None) = (node.camera(), self.scene.camera) {
            let up = unit(world.y_axis.truncate());
            self.scene.camera = self::camera(&camera, eye, forward, up);
            if self.scene.camera.is_none() {
                let warning = "a camera without a usable perspective was skipped";
                self.scene.warnings.push(warning.into());
            }
        }
        Ok(())
    }
}

/// `None` if it lights nothing. A spot is hemispherical: its cone is wider here than in the file.
fn light(
    light: &::gltf::khr_lights_punctual::Light,
    position: Vec3,
    forward: Option<Vec3>,
) -> Option<Light> {
    let axis = match light.kind() {
        Kind::Spot { .. } => Some(forward?),
        _ => None,
    };
    let color = Vec3::from(light.color());
    let brightest = color.max_element();
    let shines = color.is_finite() && brightest > 0.0 && light.intensity() > 0.0;
    (shines && position.is_finite()).then(|| Light {
        position,
        axis,
        color: (color / brightest).max(Vec3::ZERO),
        cone: None,
        range: None,
    })
}

fn camera(
    camera: &::gltf::Camera,
    eye: Vec3,
    forward: Option<Vec3>,
    up: Option<Vec3>,
) -> Option<Camera> {
    let Projection::Perspective(lens) = camera.projection() else {
        return None;
    };
    let (target, vertical_fov) = (eye + forward?, lens.yfov());
    // So far from the origin that a metre is lost, the target would be the eye.
    let usable = target.is_finite() && target != eye && vertical_fov > 0.0 && vertical_fov < PI;
    usable.then_some(Camera { eye, target, up: up?, vertical_fov })
}
