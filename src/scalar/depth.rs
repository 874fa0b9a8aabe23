//! Port of `wgsl/depth.wesl`.

use super::float::{Float, Vec4, select};

/// The stored depth of a radial distance l: (l - near) / (far - near).
pub fn dpsm_depth<T: Float>(l: T, near: T, far: T) -> T {
    (l - near) / (far - near)
}

/// The radial distance of a stored depth, the inverse of dpsm_depth.
pub fn dpsm_distance<T: Float>(depth: T, near: T, far: T) -> T {
    near + depth * (far - near)
}

/// A depth as the maps store it, and a stored one as the depth that it is.
pub fn dpsm_depth_stored<T: Float>(depth: T, reversed: u32) -> T {
    select(depth, T::lit(1.0) - depth, reversed == 1)
}

/// dpsm_depth_stored of four depths that are not below 0, for loops: no choice.
pub fn dpsm_depth_stored_four<T: Float>(depths: Vec4<T>, reversed: u32) -> Vec4<T> {
    let one = T::lit(reversed.into());
    Vec4::from_array(depths.to_array().map(|depth| (one - depth).abs()))
}

/// True where a radial distance lies between the clipping spheres, both included.
pub fn dpsm_within<T: Float>(l: T, near: T, far: T) -> bool {
    l >= near && l <= far
}

/// The depth of a receiver, clamped to [0, 1].
pub fn dpsm_receiver_depth<T: Float>(l: T, near: T, far: T) -> T {
    dpsm_depth(l, near, far).clamp(T::lit(0.0), T::lit(1.0))
}
