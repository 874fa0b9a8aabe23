//! From linear light to the bytes of a picture: samples, exposure, background.

use super::{FrameError, Picture, Settings, View};

/// The share of the surfaces' pixels that an exposure may leave too bright to show.
pub const CLIPPED: f64 = 0.005;

/// The most that an exposure brightens a picture: one stop.
pub const BRIGHTEST: f32 = 2.0;

/// The linear level that only those pixels exceed: the highest that is stored as 254 of 255.
pub const WHITE: f32 = 0.995;

/// Linear grey of pixels without a surface, which is not exposed: between the ambient and the full
/// light of most surfaces, so that outlines show on both sides.
pub const BACKGROUND: f32 = 0.3;

/// Most samples along a side of a pixel.
pub const MOST_SAMPLES: u32 = 8;

/// Linear light of each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of the surfaces, and the share of the pixel that they cover: 0 where
    /// there is none. The colours are sums over the covered samples, divided by the number of all.
    pub pixels: Vec<[f32; 4]>,
}

impl Linear {
    /// A picture without surfaces.
    pub fn empty([width, height]: [u32; 2]) -> Self {
        Self { width, height, pixels: vec![[0.0; 4]; width as usize * height as usize] }
    }

    /// Adds one sample of each pixel.
    pub fn add(&mut self, sample: &Self) {
        for (sum, value) in self.pixels.iter_mut().zip(&sample.pixels) {
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += value;
            }
        }
    }

    /// The mean, where this is the sum of so many samples of each pixel.
    pub fn divided(mut self, samples: u32) -> Self {
        let value = |channel: &mut f32| *channel /= samples as f32;
        self.pixels.as_flattened_mut().iter_mut().for_each(value);
        self
    }

    /// The picture under an exposure, as sRGB bytes.
    pub fn picture(&self, exposure: f32) -> Picture {
        let byte = |[r, g, b, covered]: &[f32; 4]| {
            let behind = (1.0 - covered).max(0.0) * BACKGROUND;
            let [r, g, b] = [r, g, b].map(|channel| srgb(exposure * channel + behind));
            [r, g, b, 255]
        };
        let pixels = self.pixels.iter().map(byte).collect();
        Picture { width: self.width, height: self.height, pixels }
    }
}

/// The factor on linear light with which at most [`CLIPPED`] of the surfaces' pixels have a channel
/// above [`WHITE`], and never more than [`BRIGHTEST`]; 1 for pictures without surfaces or light.
///
/// A pixel that is covered in part counts with the colour of its surfaces alone.
pub fn exposure(pictures: &[&Linear]) -> f32 {
    let brightest = |[r, g, b, covered]: &[f32; 4]| r.max(*g).max(*b) / covered;
    let all = pictures.iter().flat_map(|picture| &picture.pixels);
    let surfaces = all.filter(|pixel| pixel[3] > 0.0).map(brightest);
    let mut levels: Vec<f32> = surfaces.filter(|level| level.is_finite()).collect();
    let clipped = (levels.len() as f64 * CLIPPED) as usize;
    let Some(index) = levels.len().checked_sub(1 + clipped) else { return 1.0 };
    let (_, &mut white, _) = levels.select_nth_unstable_by(index, f32::total_cmp);
    match white > 0.0 {
        true => (WHITE / white).min(BRIGHTEST),
        false => 1.0,
    }
}

/// A linear channel as an sRGB byte.
pub fn srgb(linear: f32) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let encoded = if c <= 0.0031308 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

impl Settings {
    /// Where the samples lie in a pixel or texel, from its top left corner. No two of them share a
    /// row or a column, so that an edge along either axis has as many steps as there are samples.
    pub fn places(&self) -> Vec<[f32; 2]> {
        let n = self.samples;
        let place =
            |cell: u32, shift: u32| (cell as f32 + (shift as f32 + 0.5) / n as f32) / n as f32;
        let of = |(x, y)| [place(x, y), place(y, n - 1 - x)];
        (0..n).flat_map(|y| (0..n).map(move |x| (x, y))).map(of).collect()
    }

    /// The exposure of pictures that are shown together.
    pub fn exposure_of(&self, pictures: &[&Linear]) -> f32 {
        self.exposure.unwrap_or_else(|| exposure(pictures))
    }

    /// Refuses samples and exposures that there are not.
    pub(super) fn check_pixels(&self) -> Result<(), FrameError> {
        super::check_size("--samples", self.samples, MOST_SAMPLES)?;
        match self.exposure {
            Some(exposure) if !(exposure > 0.0 && exposure.is_finite()) => {
                Err(FrameError::Exposure(exposure))
            }
            _ => Ok(()),
        }
    }
}

impl View {
    /// The view whose pixel centres are these places of the pixels of an image.
    pub fn sampled(self, [x, y]: [f32; 2], [width, height]: [u32; 2]) -> Self {
        let shift = [(1.0 - 2.0 * x) / width as f32, (2.0 * y - 1.0) / height as f32];
        Self { shift, ..self }
    }
}
