//! What the alpha of glTF materials leaves of their meshes.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use ::gltf::image::{Image, Source};
use ::gltf::material::{AlphaMode, Material};
use ::gltf::texture::{Texture, WrappingMode};
use ::gltf::{Document, Primitive, buffer};
use ::image::{ImageReader, Limits};
use glam::Vec2;

use super::{malformed, named};
use crate::scene::SceneError;
use crate::scene::mask::{Coverage, Mask};

/// glTF's cutoff where the material gives none.
const DEFAULT_CUTOFF: f32 = 0.5;

/// Sizes and alphas of a file's images, each decoded once.
pub(super) struct Images<'a> {
    pub path: &'a Path,
    pub decoded: HashMap<usize, ([u32; 2], Arc<[u8]>)>,
}

/// Most texels along a side of a mask's image: a file of a few kilobytes can ask for any number.
/// As for a texture on every WebGPU adapter.
const LARGEST_IMAGE: u32 = 8192;

/// Most texels of all masks' images: sixteen of the largest, a byte each.
const MOST_TEXELS: u64 = 16 * (LARGEST_IMAGE as u64).pow(2);

impl Images<'_> {
    /// What a material leaves of the mesh of that name.
    pub(super) fn coverage(
        &mut self,
        material: &Material,
        mesh: &str,
        buffers: &[buffer::Data],
        warnings: &mut Vec<String>,
    ) -> Result<Coverage, SceneError> {
        let mut warn = |what: &str| warnings.push(format!("mesh `{mesh}`: {what}"));
        match material.alpha_mode() {
            AlphaMode::Opaque => return Ok(Coverage::Opaque),
            AlphaMode::Blend => {
                warn("alphaMode BLEND is not supported, so it is opaque");
                return Ok(Coverage::Opaque);
            }
            AlphaMode::Mask => {}
        }
        let color = material.pbr_metallic_roughness();
        // Without a texture the factor decides, as one opaque texel would let it.
        let (size, alpha) = match color.base_color_texture() {
            None => ([1, 1], Arc::from([u8::MAX])),
            Some(info) => {
                let sampler = info.texture().sampler();
                if [sampler.wrap_s(), sampler.wrap_t()] != [WrappingMode::Repeat; 2] {
                    warn("its mask repeats, although the file wraps it another way");
                }
                self.image(&info.texture(), mesh, buffers)?
            }
        };
        let [.., factor] = color.base_color_factor();
        let cutoff = material.alpha_cutoff().unwrap_or(DEFAULT_CUTOFF);
        let coverage = Mask::of_material(size, alpha, factor, cutoff);
        if let Coverage::Nothing = coverage {
            warn("its alpha is below the cutoff everywhere, so it is left out");
        }
        Ok(coverage)
    }

    /// Size and alphas of a texture's image.
    fn image(
        &mut self,
        texture: &Texture,
        mesh: &str,
        buffers: &[buffer::Data],
    ) -> Result<([u32; 2], Arc<[u8]>), SceneError> {
        let image = texture.source();
        if let Some(known) = self.decoded.get(&image.index()) {
            return Ok(known.clone());
        }
        let error = |what: String| {
            let image = match image.source() {
                Source::Uri { uri, .. } if !uri.starts_with("data:") => uri.into(),
                _ => image.name().map_or_else(|| image.index().to_string(), String::from),
            };
            SceneError::Image { path: self.path.into(), image, mesh: mesh.into(), what }
        };
        let bytes = self.bytes(&image, buffers).map_err(error)?;
        let reader = reader(&bytes).map_err(|e| error(e.to_string()))?;
        let picture = reader.decode().map_err(|e| error(e.to_string()))?;
        let size = [picture.width(), picture.height()];
        let alpha: Arc<[u8]> = picture.into_rgba8().pixels().map(|pixel| pixel.0[3]).collect();
        Ok(self.decoded.entry(image.index()).or_insert((size, alpha)).clone())
    }

    /// An image as the file holds it.
    fn bytes<'b>(
        &self,
        image: &Image,
        buffers: &'b [buffer::Data],
    ) -> Result<Cow<'b, [u8]>, String> {
        match image.source() {
            Source::View { view, .. } => {
                let (start, length) = (view.offset(), view.length());
                let whole = buffers.get(view.buffer().index());
                let bytes = whole.and_then(|data| data.get(start..)?.get(..length));
                bytes.map(Cow::from).ok_or_else(|| "it lies outside its buffer".into())
            }
            Source::Uri { uri, .. } => named::of_uri(uri, self.path.parent()).map(Cow::from),
        }
    }

    /// Refuses more texels than a file may ask memory for: masks compress to almost nothing.
    pub(super) fn check(
        &self,
        document: &Document,
        buffers: &[buffer::Data],
    ) -> Result<(), SceneError> {
        let masked = document.materials().filter(|m| m.alpha_mode() == AlphaMode::Mask);
        let colors = masked.filter_map(|m| m.pbr_metallic_roughness().base_color_texture());
        let images = colors.map(|info| info.texture().source());
        let images: BTreeMap<_, _> = images.map(|image| (image.index(), image)).collect();
        // those that cannot be read are named where a mesh needs them
        let texels = |image: &Image| {
            let bytes = self.bytes(image, buffers).ok()?;
            let (width, height) = reader(&bytes).ok()?.into_dimensions().ok()?;
            Some(u64::from(width) * u64::from(height))
        };
        let texels = images.values().filter_map(texels).fold(0, u64::saturating_add);
        match texels > MOST_TEXELS {
            true => {
                let what = format!("its masks have {texels} texels, and may have {MOST_TEXELS}");
                Err(malformed(self.path, what))
            }
            false => Ok(()),
        }
    }
}

/// Reads a PNG or JPEG of a size that the file may ask memory for.
fn reader(bytes: &[u8]) -> std::io::Result<ImageReader<Cursor<&[u8]>>> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_IMAGE);
    limits.max_image_height = Some(LARGEST_IMAGE);
    reader.limits(limits);
    Ok(reader)
}

/// Where a primitive keeps the texture coordinates of its base colour.
pub(super) fn texcoord_set(primitive: &Primitive) -> Option<u32> {
    let info = primitive.material().pbr_metallic_roughness().base_color_texture()?;
    let moved = info.texture_transform().and_then(|transform| transform.tex_coord());
    Some(moved.unwrap_or(info.tex_coord()))
}

/// What a material does to texture coordinates before it reads its base colour: it scales them,
/// turns them around the origin from +v to +u, and moves them (KHR_texture_transform).
pub(super) fn transform(material: &Material) -> impl Fn(Vec2) -> Vec2 + use<> {
    let info = material.pbr_metallic_roughness().base_color_texture();
    let transform = info.and_then(|info| {
        let transform = info.texture_transform()?;
        let turn = Vec2::from_angle(-transform.rotation());
        Some((Vec2::from(transform.scale()), turn, Vec2::from(transform.offset())))
    });
    move |texcoord| match transform {
        None => texcoord,
        Some((scale, turn, offset)) => turn.rotate(scale * texcoord) + offset,
    }
}
