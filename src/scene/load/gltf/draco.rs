//! Primitives compressed with KHR_draco_mesh_compression.

use std::collections::HashMap;

use draco_oxide_core::attribute::ComponentDataType;
use draco_oxide_core::mesh::Mesh;
use draco_oxide_core::types::PointIdx;
use draco_oxide_decoder::decode_mesh;
use serde::Deserialize;

use super::accessor::Component;
use super::buffers::Buffers;
use super::fault::Fault;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Packed {
    buffer_view: usize,
    attributes: HashMap<String, usize>,
}

/// A decoded mesh, and what its attributes are called.
pub(super) struct Decoded {
    mesh: Mesh,
    attributes: HashMap<String, usize>,
}

impl Decoded {
    pub fn new(packed: Packed, buffers: &Buffers) -> Result<Self, Fault> {
        let view = buffers.view(packed.buffer_view)?;
        let mesh = decode_mesh(view.bytes()).map_err(|error| error.to_string())?;
        Ok(Self { mesh, attributes: packed.attributes })
    }

    pub fn indices(&self) -> Vec<u32> {
        let corners = self.mesh.get_faces().iter().flatten();
        corners.map(|&point| usize::from(point) as u32).collect()
    }

    /// An attribute's vectors, a vertex each; `None` if it is not among the compressed.
    pub fn vectors<const N: usize>(
        &self,
        name: &str,
        normalized: bool,
    ) -> Result<Option<Vec<[f64; N]>>, Fault> {
        let Some(&id) = self.attributes.get(name) else { return Ok(None) };
        let found = self.mesh.get_attributes().iter().find(|it| it.get_id().as_usize() == id);
        let attribute = found.ok_or_else(|| format!("Draco has no attribute {id}"))?;
        let component = component(attribute.get_component_type());
        let component = component.ok_or("Draco has an attribute of an unexpected type")?;
        if attribute.get_num_components() != N {
            return Err("Draco has an attribute of an unexpected shape".into());
        }
        let bytes = attribute.get_data_as_bytes();
        let vector = |point: usize| {
            let value = usize::from(attribute.get_unique_val_idx(PointIdx::from(point)));
            let element = bytes.get(value * N * component.size()..)?;
            component.vector(element, normalized)
        };
        let vectors: Option<_> = (0..attribute.len()).map(vector).collect();
        Ok(Some(vectors.ok_or("Draco has too few values of an attribute")?))
    }
}

fn component(kind: ComponentDataType) -> Option<Component> {
    Some(match kind {
        ComponentDataType::I8 => Component::I8,
        ComponentDataType::U8 => Component::U8,
        ComponentDataType::I16 => Component::I16,
        ComponentDataType::U16 => Component::U16,
        ComponentDataType::U32 => Component::U32,
        ComponentDataType::F32 => Component::F32,
        ComponentDataType::F64 => Component::F64,
        _ => return None,
    })
}
