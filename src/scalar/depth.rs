//! Port of `wgsl/depth.wesl`.

use super::float::Float;

/// The stored depth of a radial distance l: (l - near) / (far - near).
pub fn dpsm_depth<T: Float>(l: T, near: T, far: T) -> T {
    (l - near) / (far - near)
}

/// The radial distance of a stored depth, the inverse of dpsm_depth.
pub fn dpsm_distance<T: Float>(depth: T, near: T, far: T) -> T {
    near + depth * (far - near)
}

/// True where a radial distance lies between the clipping spheres, both included.
pub fn dpsm_within<T: Float>(l: T, near: T, far: T) -> bool {
    l >= near && l <= far
}

/// The depth of a receiver, clamped to [0, 1].
pub fn dpsm_receiver_depth<T: Float>(l: T, near: T, far: T) -> T {
    dpsm_depth(l, near, far).clamp(T::lit(0.0), T::lit(1.0))
}
