//! Port of `wgsl/light.wesl`.

use super::float::{Float, Vec2, Vec3, Vec4, select};

/// The maps are layers first_layer (front) and first_layer + 1 (back).
pub const DPSM_LAYERS: u32 = 0;

/// The maps are in layer first_layer: front in `rectangle`, back in the rectangle at its right.
pub const DPSM_ATLAS: u32 = 1;

/// A hemispherical light: one map, the back always in shadow.
pub const DPSM_HEMISPHERICAL: u32 = 1;

/// An omnidirectional light: two maps.
pub const DPSM_OMNIDIRECTIONAL: u32 = 2;

/// The maps store depths as they are, compared with less-equal.
pub const DPSM_FORWARD: u32 = 0;

/// The maps store 1 less the depth, compared with greater-equal.
pub const DPSM_REVERSED: u32 = 1;

/// A point light with paraboloid maps; at f32 its bytes are the shader's struct.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmLight<T> {
    /// World position.
    pub position: Vec3<T>,
    /// Near clipping sphere's radius in world units, 0 < near < far.
    pub near: T,
    /// Light space's +x in world space; right, up, forward are orthonormal.
    pub right: Vec3<T>,
    /// Far clipping sphere's radius in world units.
    pub far: T,
    /// Light space's +y in world space.
    pub up: Vec3<T>,
    /// Width of the guard band: the map stores r <= 1 + guard, 0 <= guard <= 1.
    pub guard: T,
    /// Light space's +z in world space: the main axis, the front hemisphere's pole.
    pub forward: Vec3<T>,
    /// Map size N in texels: a map is N x N.
    pub size: T,
    /// First map's place in the atlas in texture coordinates: x, y, width, height.
    pub rectangle: Vec4<T>,
    /// First layer of the array texture.
    pub first_layer: u32,
    /// DPSM_LAYERS or DPSM_ATLAS.
    pub placement: u32,
    /// Number of maps: DPSM_HEMISPHERICAL or DPSM_OMNIDIRECTIONAL.
    pub hemispheres: u32,
    /// [`DPSM_FORWARD`] or [`DPSM_REVERSED`]: what the maps store of a depth.
    pub reversed: u32,
}

impl DpsmLight<f32> {
    /// The same light in f64.
    pub fn widen(self) -> DpsmLight<f64> {
        DpsmLight {
            position: self.position.widen(),
            near: self.near.into(),
            right: self.right.widen(),
            far: self.far.into(),
            up: self.up.widen(),
            guard: self.guard.into(),
            forward: self.forward.widen(),
            size: self.size.into(),
            rectangle: self.rectangle.widen(),
            first_layer: self.first_layer,
            placement: self.placement,
            hemispheres: self.hemispheres,
            reversed: self.reversed,
        }
    }
}

#[cfg(feature = "gpu")]
mod bytes {
    use super::DpsmLight;

    const _: () = assert!(size_of::<DpsmLight<f32>>() == 96);
    // SAFETY: repr(C), every member plain 32-bit words, and 24 of them fill the size above.
    unsafe impl bytemuck::Zeroable for DpsmLight<f32> {}
    // SAFETY: as above; any bits are an f32 or a u32.
    unsafe impl bytemuck::Pod for DpsmLight<f32> {}
}

/// The array layer that holds a hemisphere's map.
pub fn dpsm_light_layer<T: Float>(light: DpsmLight<T>, hemisphere: u32) -> u32 {
    light.first_layer.wrapping_add(select(hemisphere, 0, light.placement == DPSM_ATLAS))
}

/// A map's own texture coordinates st to those of the texture that holds it.
pub fn dpsm_light_coordinates<T: Float>(
    light: DpsmLight<T>,
    hemisphere: u32,
    st: Vec2<T>,
) -> Vec2<T> {
    if light.placement == DPSM_ATLAS {
        let beside = Vec2::new(T::lit(f64::from(hemisphere)), T::lit(0.0));
        return light.rectangle.xy() + (st + beside) * light.rectangle.zw();
    }
    st
}
