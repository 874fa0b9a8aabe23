//! glTF files that a test makes: a floor under a light, and casters that it adds.

use dpsm::scene::Scene;
use dpsm::truth::Truth;
use glam::{DVec3, Vec3, dvec3};
use serde_json::{Value, json};

use crate::gltf_files::glb_with;
use crate::{assert_valid, file, read};

pub(crate) const I8: u32 = 5120;
pub(crate) const U8: u32 = 5121;
pub(crate) const I16: u32 = 5122;
pub(crate) const U16: u32 = 5123;
pub(crate) const F32: u32 = 5126;

/// Components of glTF's types.
const SHAPES: [(&str, usize); 5] =
    [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4), ("MAT4", 16)];

/// A document with its binary chunk.
pub(crate) struct Model {
    pub json: Value,
    pub bin: Vec<u8>,
}

/// A plate of 2 x 2 around the y axis at y = 0, seen from above.
pub(crate) const PLATE: [[f32; 3]; 4] =
    [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];

pub(crate) const CORNERS: [u16; 6] = [0, 1, 2, 0, 2, 3];

impl Model {
    /// A floor of 16 x 16 at y = 0, and a light at y = 4 over its middle.
    pub fn new() -> Self {
        let mut model = Self::empty();
        let floor = PLATE.map(|corner| corner.map(|c| 8.0 * c));
        let mesh = model.plate("floor", &floor);
        model.node(json!({ "mesh": mesh }));
        let extension = json!({ "KHR_lights_punctual": { "light": 0 } });
        model.node(json!({ "translation": [0, 4, 0], "extensions": extension }));
        model.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{ "type": "point" }]);
        model.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
        model
    }

    pub fn empty() -> Self {
        let json =
            json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] });
        Self { json, bin: Vec::new() }
    }

    /// Adds to a list; returns the index.
    pub fn add(&mut self, list: &str, element: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(element);
        list.len() - 1
    }

    /// A node of the scene.
    pub fn node(&mut self, node: Value) -> usize {
        let index = self.add("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
        index
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bin.len();
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
        self.add("bufferViews", view)
    }

    /// An accessor of whole numbers or floats by its component type, elements touching.
    pub fn accessor(&mut self, component: u32, shape: &str, numbers: &[f64]) -> usize {
        let view = self.view(&bytes(component, numbers));
        let components = SHAPES.iter().find(|(name, _)| *name == shape).unwrap().1;
        let count = numbers.len() / components;
        self.add(
            "accessors",
            json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }),
        )
    }

    pub fn vectors(&mut self, vectors: &[[f32; 3]]) -> usize {
        let numbers: Vec<f64> = vectors.as_flattened().iter().map(|&c| c.into()).collect();
        self.accessor(F32, "VEC3", &numbers)
    }

    pub fn indices(&mut self) -> usize {
        self.accessor(U16, "SCALAR", &CORNERS.map(f64::from))
    }

    /// A mesh of four corners.
    pub fn plate(&mut self, name: &str, corners: &[[f32; 3]; 4]) -> usize {
        let positions = self.vectors(corners);
        let indices = self.indices();
        let primitive = json!({ "attributes": { "POSITION": positions }, "indices": indices });
        self.add("meshes", json!({ "name": name, "primitives": [primitive] }))
    }

    pub fn uses(&mut self, extension: &str) {
        if self.json["extensionsUsed"].is_null() {
            self.json["extensionsUsed"] = json!([]);
        }
        self.json["extensionsUsed"].as_array_mut().unwrap().push(json!(extension));
    }

    pub fn requires(&mut self, extension: &str) {
        self.uses(extension);
        self.json["extensionsRequired"] = json!([extension]);
    }

    /// As a binary file.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"].is_null() {
            json["buffers"] = json!([]);
        }
        let buffers = json["buffers"].as_array_mut().unwrap();
        let own = json!({ "byteLength": self.bin.len() });
        if buffers.is_empty() {
            buffers.push(own)
        } else {
            buffers[0] = own
        }
        glb_with(&json.to_string(), &self.bin)
    }

    pub fn read(&self, name: &str) -> Scene {
        let scene = read(&file(name, self.glb()));
        assert_valid(&scene);
        scene
    }

    pub fn error(&self, name: &str) -> String {
        crate::error(&file(name, self.glb()))
    }
}

/// Little-endian numbers of a component type.
pub(crate) fn bytes(component: u32, numbers: &[f64]) -> Vec<u8> {
    let number = |&number: &f64| match component {
        I8 => (number as i8).to_le_bytes().to_vec(),
        U8 => (number as u8).to_le_bytes().to_vec(),
        I16 => (number as i16).to_le_bytes().to_vec(),
        U16 => (number as u16).to_le_bytes().to_vec(),
        5125 => (number as u32).to_le_bytes().to_vec(),
        5130 => number.to_le_bytes().to_vec(),
        _ => (number as f32).to_le_bytes().to_vec(),
    };
    numbers.iter().flat_map(number).collect()
}

/// Which points of the floor the first light sees, `x` and `z` each in the file's coordinates: by
/// rays, not by maps.
pub(crate) fn lit<const N: usize>(scene: &Scene, points: [[f64; 2]; N]) -> [bool; N] {
    let truth = Truth::from(scene);
    let light = scene.lights[0].position.as_dvec3();
    // a millimetre above the floor, so that it is not its own caster
    points.map(|[x, z]| truth.sees(light, dvec3(x, 1e-3, z) - scene.origin, None, 0.0))
}

/// The scene's bounds in the file's coordinates.
pub(crate) fn bounds(scene: &Scene) -> [DVec3; 2] {
    let bounds = scene.bounds();
    [bounds.min, bounds.max].map(|corner: Vec3| corner.as_dvec3() + scene.origin)
}
