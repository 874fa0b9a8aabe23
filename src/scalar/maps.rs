//! What stands for a depth texture and its comparison sampler in the ports.

use super::float::{Float, Vec2, Vec4};

/// A texture with a comparison sampler, as the ports of sampling functions see it.
pub trait Maps<T: Float> {
    /// textureSampleCompareLevel: the share of the sampled texels whose stored depth is not less
    /// than `reference`, or not greater where the sampler is so, at texture coordinates `st` of the
    /// layer.
    fn compare(&self, st: Vec2<T>, layer: u32, reference: T) -> T;

    /// textureSampleLevel without a comparison: the depth stored in the texel that holds texture
    /// coordinates `st` of the layer.
    fn sample(&self, st: Vec2<T>, layer: u32) -> T {
        self.load((st * self.size()).floor(), layer)
    }

    /// textureGather at the corner of four texels: lower left, lower right, upper right, upper left.
    fn gather(&self, st: Vec2<T>, layer: u32) -> Vec4<T> {
        let first = (st * self.size() - Vec2::splat(T::lit(0.5))).floor();
        let at = |right: f64, down: f64| {
            self.load(first + Vec2::new(T::lit(right), T::lit(down)), layer)
        };
        Vec4::new(at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0), at(0.0, 0.0))
    }

    /// textureDimensions: texels along each side.
    fn size(&self) -> Vec2<T>;

    /// textureLoad: the depth stored in a texel, whose coordinates are clamped to the texture.
    fn load(&self, texel: Vec2<T>, layer: u32) -> T;
}

/// How a comparison sampler reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// The texel that holds the coordinates.
    Nearest,
    /// The four nearest texels, each compared, then interpolated.
    Linear,
}

/// Depth maps in memory: `layers` square layers of `size` x `size` texels, row by row from the
/// top, clamped at the edges; a layer out of range reads the last one.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthMaps {
    /// Texels along a side.
    pub size: u32,
    /// Number of layers.
    pub layers: u32,
    /// Stored depths, `layers * size * size`.
    pub depths: Vec<f32>,
    /// Sampling of `compare`.
    pub sampling: Sampling,
    /// Whether 1 less the depth is stored, and `compare` is greater-equal.
    pub reversed: bool,
}

impl DepthMaps {
    /// Maps in which nothing is stored: every depth is 1.
    pub fn empty(size: u32, layers: u32, sampling: Sampling) -> Self {
        let texels = layers as usize * size as usize * size as usize;
        Self { size, layers, depths: vec![1.0; texels], sampling, reversed: false }
    }

    /// The same maps as a reversed light has them, which stores 1 less each depth.
    pub fn reverse(mut self) -> Self {
        self.depths.iter_mut().for_each(|depth| *depth = 1.0 - *depth);
        Self { reversed: !self.reversed, ..self }
    }

    /// The depth that a texel stands for, by its index in `depths`: 1 where it is empty.
    pub fn depth(&self, index: usize) -> f32 {
        let stored = self.depths[index];
        if self.reversed { 1.0 - stored } else { stored }
    }

    /// The index of a texel in `depths`, coordinates clamped to the map.
    pub fn index(&self, x: i64, y: i64, layer: u32) -> usize {
        let size = self.size as usize;
        let inside = |c: i64| c.clamp(0, size as i64 - 1) as usize;
        let layer = layer.min(self.layers - 1) as usize;
        (layer * size + inside(y)) * size + inside(x)
    }

    /// One layer's depths.
    pub fn layer(&self, layer: u32) -> &[f32] {
        let texels = self.size as usize * self.size as usize;
        &self.depths[layer as usize * texels..][..texels]
    }
}

impl<T: Float> Maps<T> for DepthMaps {
    fn compare(&self, st: Vec2<T>, layer: u32, reference: T) -> T {
        let lit = |x: i64, y: i64| {
            let stored = T::lit(f64::from(self.depths[self.index(x, y, layer)]));
            let lit = if self.reversed { reference >= stored } else { reference <= stored };
            T::lit(f64::from(u8::from(lit)))
        };
        let size = f64::from(self.size);
        let (x, y) = (st.x.value() * size, st.y.value() * size);
        if self.sampling == Sampling::Nearest {
            return lit(x.floor() as i64, y.floor() as i64);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor() as i64, y.floor() as i64);
        let mix = |a: T, b: T, k: f64| a * T::lit(1.0 - k) + b * T::lit(k);
        let row = |y: i64| mix(lit(left, y), lit(left.saturating_add(1), y), x - x.floor());
        mix(row(top), row(top.saturating_add(1)), y - y.floor())
    }

    fn size(&self) -> Vec2<T> {
        Vec2::splat(T::lit(self.size.into()))
    }

    fn load(&self, texel: Vec2<T>, layer: u32) -> T {
        let [x, y] = [texel.x, texel.y].map(|c| c.value() as i64);
        T::lit(self.depths[self.index(x, y, layer)].into())
    }
}
