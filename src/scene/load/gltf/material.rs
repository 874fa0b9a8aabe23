//! Materials, as far as shadows need them: the base colour, and its alpha where it cuts holes.

use glam::Vec2;
use serde::Deserialize;

use super::document::{Document, Extensions, extension};
use super::fault::Fault;

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material<'a> {
    alpha_mode: Option<String>,
    pub alpha_cutoff: Option<f32>,
    #[serde(borrow, default)]
    pbr_metallic_roughness: Pbr<'a>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Pbr<'a> {
    base_color_factor: Option<[f32; 4]>,
    #[serde(borrow)]
    base_color_texture: Option<TextureInfo<'a>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo<'a> {
    pub index: usize,
    #[serde(default)]
    tex_coord: u32,
    #[serde(borrow, default)]
    extensions: Extensions<'a>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct TextureTransform {
    offset: Option<Vec2>,
    rotation: Option<f32>,
    scale: Option<Vec2>,
    tex_coord: Option<u32>,
}

/// What a material's alpha does.
pub(super) enum AlphaMode<'a> {
    Opaque,
    Mask,
    Blend,
    Unknown(&'a str),
}

impl<'a> Material<'a> {
    /// The material of that index, or the format's default one.
    pub fn of(document: &Document<'a>, index: Option<usize>) -> Result<Self, Fault> {
        index.map_or_else(|| Ok(Self::default()), |index| document.get("materials", index))
    }

    pub fn alpha_mode(&self) -> AlphaMode<'_> {
        match self.alpha_mode.as_deref() {
            None | Some("OPAQUE") => AlphaMode::Opaque,
            Some("MASK") => AlphaMode::Mask,
            Some("BLEND") => AlphaMode::Blend,
            Some(other) => AlphaMode::Unknown(other),
        }
    }

    pub fn color_factor(&self) -> [f32; 4] {
        self.pbr_metallic_roughness.base_color_factor.unwrap_or([1.0; 4])
    }

    pub fn color_texture(&self) -> Option<&TextureInfo<'a>> {
        self.pbr_metallic_roughness.base_color_texture.as_ref()
    }

    fn transform(&self) -> Option<TextureTransform> {
        extension(&self.color_texture()?.extensions, "KHR_texture_transform").ok()?
    }

    /// Where a primitive keeps the texture coordinates of its base colour.
    pub fn texcoord_set(&self) -> u32 {
        let moved = self.transform().and_then(|transform| transform.tex_coord);
        moved.or(self.color_texture().map(|info| info.tex_coord)).unwrap_or(0)
    }

    /// What it does to texture coordinates before it reads its base colour: it scales them, turns
    /// them around the origin from +v to +u, and moves them (KHR_texture_transform).
    pub fn texcoord_transform(&self) -> impl Fn(Vec2) -> Vec2 + use<> {
        let transform = self.transform().map(|transform| {
            let turn = Vec2::from_angle(-transform.rotation.unwrap_or(0.0));
            let (scale, offset) = (transform.scale, transform.offset);
            (scale.unwrap_or(Vec2::ONE), turn, offset.unwrap_or(Vec2::ZERO))
        });
        move |texcoord| match transform {
            None => texcoord,
            Some((scale, turn, offset)) => turn.rotate(scale * texcoord) + offset,
        }
    }
}
