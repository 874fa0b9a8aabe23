//! Alpha masks: textures that cut holes into meshes.

use std::sync::Arc;

use glam::{DVec2, Vec2};

/// Where a mesh has holes: glTF's `alphaMode: MASK`. It is opaque where the alpha of the nearest
/// texel is at least the cutoff, and not there elsewhere. The texture repeats.
///
/// The cutoff of a mask from a file lies halfway between two of the 256 alphas, with the
/// material's own factor in it, so that no rounding of an alpha can change a decision.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Alpha in 255ths of each texel, row by row from texture coordinate v = 0. Shared, as many
    /// meshes may have the same.
    pub alpha: Arc<[u8]>,
    /// The least alpha that is opaque, 1 being a byte of 255.
    pub cutoff: f32,
}

/// What a material leaves of a mesh.
pub(super) enum Coverage {
    Opaque,
    Masked(Mask),
    Nothing,
}

impl Mask {
    /// True where the mask is opaque at texture coordinates, u to the right and v down, and where
    /// they are not finite.
    ///
    /// The texel is `min(floor((t - floor(t)) * size), size - 1)` in each direction, every
    /// operation in f32: a shader that does the same reads the same texel. The minimum is for a t
    /// less than half a rounding below a whole number, where the difference rounds to 1.
    pub fn opaque(&self, texcoord: Vec2) -> bool {
        if !texcoord.is_finite() {
            return true;
        }
        let texel = |t: f32, size: u32| {
            let texel = ((t - t.floor()) * size as f32).floor();
            (texel as u32).min(size.saturating_sub(1)) as usize
        };
        let (x, y) = (texel(texcoord.x, self.width), texel(texcoord.y, self.height));
        let alpha = self.alpha.get(y * self.width as usize + x);
        alpha.is_none_or(|&byte| value(byte) >= self.cutoff)
    }

    /// [`Mask::opaque`] at a triangle's point, from the corners' texture coordinates and weights;
    /// they are interpolated in f64 and rounded to f32.
    pub fn opaque_at(&self, corners: [Vec2; 3], weights: [f64; 3]) -> bool {
        let terms = corners.map(Vec2::as_dvec2).into_iter().zip(weights);
        let texcoord: DVec2 = terms.map(|(corner, weight)| corner * weight).sum();
        self.opaque(texcoord.as_vec2())
    }

    /// True where there is one texel at least, an alpha for each, and a cutoff that is a number.
    pub(crate) fn is_usable(&self) -> bool {
        let texels = u64::from(self.width) * u64::from(self.height);
        texels > 0 && texels == self.alpha.len() as u64 && !self.cutoff.is_nan()
    }

    /// Of alphas that are multiplied by a factor before they are compared with glTF's cutoff.
    pub(super) fn of_material(
        [width, height]: [u32; 2],
        alpha: Arc<[u8]>,
        factor: f32,
        cutoff: f32,
    ) -> Coverage {
        // Rounding keeps order, so that all alphas from the least one on are opaque.
        let Some(least) = (0..=u8::MAX).find(|&byte| value(byte) * factor >= cutoff) else {
            return Coverage::Nothing;
        };
        let opaque = alpha.iter().filter(|&&byte| byte >= least).count();
        match opaque {
            _ if opaque == alpha.len() => Coverage::Opaque,
            0 => Coverage::Nothing,
            _ => {
                let cutoff = (f32::from(least) - 0.5) / 255.0;
                Coverage::Masked(Self { width, height, alpha, cutoff })
            }
        }
    }
}

/// A byte's alpha, correctly rounded.
fn value(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}
