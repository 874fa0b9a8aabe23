//! Pictures, and how they are stored.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};

use super::Frame;
use crate::scalar::depth::dpsm_depth;
use crate::scalar::maps::DepthMaps;

/// A picture: sRGB bytes, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, alpha.
    pub pixels: Vec<[u8; 4]>,
}

impl Picture {
    /// The RGBA bytes.
    pub fn bytes(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// The picture as PNG.
    pub fn png(&self) -> Result<Vec<u8>, ImageError> {
        let mut bytes = Vec::new();
        let (width, height) = (self.width, self.height);
        let encoder = PngEncoder::new(&mut bytes);
        encoder.write_image(self.bytes(), width, height, ExtendedColorType::Rgba8)?;
        Ok(bytes)
    }
}

impl Frame {
    /// A map as a grey picture: black at the near sphere, white at the far one or where it is empty.
    pub fn grey(&self, maps: &DepthMaps, layer: u32) -> Picture {
        let (near, far) = (self.light.near, self.light.far);
        let shade = |distance: f32| {
            let value = (dpsm_depth(distance, near, far) * 255.0).round() as u8;
            [value, value, value, 255]
        };
        let pixels = self.distances(maps, layer).map(shade).collect();
        Picture { width: maps.size, height: maps.size, pixels }
    }
}
