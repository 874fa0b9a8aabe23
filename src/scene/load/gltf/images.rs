//! Images of masks, decoded once each.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use ::image::{ImageReader, Limits};
use serde::Deserialize;

use super::buffers::{Buffers, View};
use super::document::{Document, Extensions, extension};
use super::fault::Fault;
use super::material::{AlphaMode, Material, TextureInfo};
use crate::scene::SceneError;
use crate::scene::load::{malformed, named};
use crate::scene::mask::{Coverage, Mask};

/// glTF's cutoff where the material gives none.
const DEFAULT_CUTOFF: f32 = 0.5;

const REPEAT: u32 = 10497;

/// Sizes and alphas of a file's images.
pub(super) struct Images<'a> {
    pub path: &'a Path,
    pub buffers: &'a Buffers<'a>,
    pub decoded: HashMap<usize, Alpha>,
}

type Alpha = ([u32; 2], Arc<[u8]>);

#[derive(Default, Deserialize)]
struct Texture<'a> {
    source: Option<usize>,
    sampler: Option<usize>,
    #[serde(borrow, default)]
    extensions: Extensions<'a>,
}

/// What extensions of textures have in common.
#[derive(Deserialize)]
struct Source {
    source: usize,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Sampler {
    wrap_s: Option<u32>,
    wrap_t: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Image {
    name: Option<String>,
    uri: Option<String>,
    buffer_view: Option<usize>,
}

/// Most texels along a side of a mask's image: a file of a few kilobytes can ask for any number.
/// As for a texture on every WebGPU adapter.
const LARGEST_IMAGE: u32 = 8192;

/// Most texels of all masks' images: sixteen of the largest, a byte each.
const MOST_TEXELS: u64 = 16 * (LARGEST_IMAGE as u64).pow(2);

impl<'a> Images<'a> {
    /// What a material leaves of the mesh of that name.
    pub fn coverage(
        &mut self,
        material: &Material<'a>,
        mesh: &str,
        warnings: &mut Vec<String>,
    ) -> Result<Coverage, SceneError> {
        let mut warn = |what: &str| warnings.push(format!("mesh `{mesh}`: {what}"));
        match material.alpha_mode() {
            AlphaMode::Opaque => return Ok(Coverage::Opaque),
            AlphaMode::Blend => {
                warn("alphaMode BLEND is not supported, so it is opaque");
                return Ok(Coverage::Opaque);
            }
            AlphaMode::Unknown(mode) => {
                warn(&format!("alphaMode `{mode}` is not known, so it is opaque"));
                return Ok(Coverage::Opaque);
            }
            AlphaMode::Mask => {}
        }
        // Without a texture the factor decides, as one opaque texel would let it.
        let (size, alpha) = match material.color_texture() {
            None => ([1, 1], Arc::from([u8::MAX])),
            Some(info) => match self.of_texture(info, mesh, &mut warn)? {
                Some(found) => found,
                None => return Ok(Coverage::Opaque),
            },
        };
        let [.., factor] = material.color_factor();
        let cutoff = material.alpha_cutoff.unwrap_or(DEFAULT_CUTOFF);
        let coverage = Mask::of_material(size, alpha, factor, cutoff);
        if let Coverage::Nothing = coverage {
            warn("its alpha is below the cutoff everywhere, so it is left out");
        }
        Ok(coverage)
    }

    /// Size and alphas of a texture's image; `None`, with a warning, if it is of a kind that is not
    /// decoded.
    fn of_texture(
        &mut self,
        info: &TextureInfo,
        mesh: &str,
        warn: &mut impl FnMut(&str),
    ) -> Result<Option<Alpha>, SceneError> {
        let part = format!("mesh `{mesh}`");
        let document = self.buffers.document;
        let texture: Texture =
            document.get("textures", info.index).map_err(|fault| fault.error(self.path, &part))?;
        let sampler = texture.sampler.and_then(|index| document.get("samplers", index).ok());
        let Sampler { wrap_s, wrap_t } = sampler.unwrap_or_default();
        if [wrap_s, wrap_t].iter().any(|wrap| wrap.unwrap_or(REPEAT) != REPEAT) {
            warn("its mask repeats, although the file wraps it another way");
        }
        match image_of(&texture) {
            Ok(image) => self.image(image, mesh, warn),
            Err(what) => {
                warn(&format!(
                    "its mask is {what}, which is not read, so it is opaque: \
                     convert the image to PNG"
                ));
                Ok(None)
            }
        }
    }

    fn image(
        &mut self,
        index: usize,
        mesh: &str,
        warn: &mut impl FnMut(&str),
    ) -> Result<Option<Alpha>, SceneError> {
        if let Some(known) = self.decoded.get(&index) {
            return Ok(Some(known.clone()));
        }
        let document = self.buffers.document;
        let image: Image = document
            .get("images", index)
            .map_err(|fault| fault.error(self.path, &format!("mesh `{mesh}`")))?;
        let error = |what: String| {
            let image = match &image.uri {
                Some(uri) if !uri.starts_with("data:") => uri.clone(),
                _ => image.name.clone().unwrap_or_else(|| index.to_string()),
            };
            SceneError::Image { path: self.path.into(), image, mesh: mesh.into(), what }
        };
        let bytes = self.bytes(&image).map_err(|fault| error(fault.to_string()))?;
        if let Some(kind) = unread_kind(&bytes) {
            warn(&format!(
                "its mask is {kind}, which is not read, so it is opaque: convert the image to PNG"
            ));
            return Ok(None);
        }
        let reader = reader(&bytes).map_err(|e| error(e.to_string()))?;
        let picture = reader.decode().map_err(|e| error(e.to_string()))?;
        let size = [picture.width(), picture.height()];
        let alpha: Arc<[u8]> = picture.into_rgba8().pixels().map(|pixel| pixel.0[3]).collect();
        Ok(Some(self.decoded.entry(index).or_insert((size, alpha)).clone()))
    }

    /// An image as the file holds it.
    fn bytes(&self, image: &Image) -> Result<Cow<'_, [u8]>, Fault> {
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => Ok(named::of_uri(uri, self.path.parent())?.into()),
            (None, Some(view)) => match self.buffers.view(view) {
                Ok(view) => Ok(View::bytes(&view).to_vec().into()),
                Err(Fault::Text(_)) => Err("it lies outside its buffer".into()),
                Err(fault) => Err(fault),
            },
            (None, None) => Err("it has neither a file nor a buffer view".into()),
        }
    }

    /// Refuses more texels than a file may ask memory for: masks compress to almost nothing.
    pub fn check(&self) -> Result<(), SceneError> {
        let document = self.buffers.document;
        // those that cannot be read are named where a mesh needs them
        let texels = |index: &usize| {
            let image: Image = document.get("images", *index).ok()?;
            let bytes = self.bytes(&image).ok()?;
            let (width, height) = reader(&bytes).ok()?.into_dimensions().ok()?;
            Some(u64::from(width) * u64::from(height))
        };
        let texels = masks(document).iter().filter_map(texels).fold(0, u64::saturating_add);
        match texels > MOST_TEXELS {
            true => {
                let what = format!("its masks have {texels} texels, and may have {MOST_TEXELS}");
                Err(malformed(self.path, what))
            }
            false => Ok(()),
        }
    }
}

/// The images of all masks.
fn masks(document: &Document) -> BTreeSet<usize> {
    let image = |index| {
        let material: Material = document.get("materials", index).ok()?;
        let AlphaMode::Mask = material.alpha_mode() else { return None };
        let texture: Texture = document.get("textures", material.color_texture()?.index).ok()?;
        image_of(&texture).ok()
    };
    (0..document.count("materials")).filter_map(image).collect()
}

/// The image of a texture, else what it is instead.
fn image_of(texture: &Texture) -> Result<usize, String> {
    let webp = || extension::<Source>(&texture.extensions, "EXT_texture_webp").ok()?;
    match texture.source.or_else(|| webp().map(|source| source.source)) {
        Some(image) => Ok(image),
        None => match texture.extensions.keys().min() {
            Some(name) => Err(format!("an image of the extension `{name}`")),
            None => Err("a texture without an image".into()),
        },
    }
}

/// What an image is that no decoder here knows, by its first bytes.
fn unread_kind(bytes: &[u8]) -> Option<&'static str> {
    let brand = bytes.get(4..12).unwrap_or_default();
    match bytes {
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => Some("a KTX2 image"),
        [0xab, b'K', b'T', b'X', ..] => Some("a KTX image"),
        [b'D', b'D', b'S', b' ', ..] => Some("a DDS image"),
        [b's', b'B', ..] => Some("a Basis image"),
        _ if brand.starts_with(b"ftypavi") => Some("an AVIF image"),
        [0xff, 0x0a, ..] | [0, 0, 0, 0x0c, b'J', b'X', b'L', b' ', ..] => Some("a JPEG XL image"),
        _ => None,
    }
}

/// Reads a PNG, JPEG or WebP of a size that the file may ask memory for.
fn reader(bytes: &[u8]) -> std::io::Result<ImageReader<Cursor<&[u8]>>> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_IMAGE);
    limits.max_image_height = Some(LARGEST_IMAGE);
    reader.limits(limits);
    Ok(reader)
}
