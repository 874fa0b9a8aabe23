//! Copies of a node's mesh (EXT_mesh_gpu_instancing).

use glam::{DAffine3, DQuat, DVec3};
use serde::Deserialize;

use super::accessor::Accessors;
use super::document::{Extensions, extension};
use super::fault::Fault;
use super::nodes::transform;

#[derive(Deserialize)]
struct Instancing {
    attributes: Attributes,
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
struct Attributes {
    translation: Option<usize>,
    rotation: Option<usize>,
    scale: Option<usize>,
}

/// Where each copy is, in the node's own coordinates; `None` for a node without copies.
pub(super) fn places(
    extensions: &Extensions,
    accessors: &Accessors,
) -> Result<Option<Vec<DAffine3>>, Fault> {
    let found = extension(extensions, "EXT_mesh_gpu_instancing")?;
    let Some(Instancing { attributes: Attributes { translation, rotation, scale } }) = found else {
        return Ok(None);
    };
    let mut counts = Vec::new();
    for accessor in [translation, rotation, scale].into_iter().flatten() {
        counts.push(accessors.get(accessor)?.count);
    }
    let Some(&count) = counts.first() else { return Ok(None) };
    if counts.iter().any(|other| *other != count) {
        return Err("its instances have attributes of different lengths".into());
    }
    let vectors = |accessor: Option<usize>, what| match accessor {
        None => Ok(None),
        Some(index) => accessors.vectors::<3>(index, what).map(Some),
    };
    let translations = vectors(translation, "instances' translations")?;
    let scales = vectors(scale, "instances' scales")?;
    let rotations = match rotation {
        None => None,
        Some(index) => Some(accessors.vectors::<4>(index, "instances' rotations")?),
    };
    let place = |i: usize| {
        transform(
            translations.as_ref().map_or(DVec3::ZERO, |list| list[i].into()),
            rotations.as_ref().map_or(DQuat::IDENTITY, |list| DQuat::from_array(list[i])),
            scales.as_ref().map_or(DVec3::ONE, |list| list[i].into()),
        )
    };
    Ok(Some((0..count).map(place).collect()))
}
