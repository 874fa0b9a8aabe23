//! Port of `wgsl/shade.wesl`.

use super::float::{Float, Vec3};

/// Ambient light, plus diffuse and specular as far as the light is visible.
pub fn dpsm_shade<T: Float>(
    ambient: Vec3<T>,
    diffuse: Vec3<T>,
    specular: Vec3<T>,
    visibility: T,
) -> Vec3<T> {
    ambient + (diffuse + specular) * visibility
}

/// Brabec's blend: visibility times full illumination plus the rest of ambient illumination.
pub fn dpsm_blend<T: Float>(full: Vec3<T>, ambient: Vec3<T>, visibility: T) -> Vec3<T> {
    full * visibility + ambient * (T::lit(1.0) - visibility)
}

/// Lambert's cosine: how much of the light a surface catches, 0 where it faces away.
pub fn dpsm_lambert<T: Float>(normal: Vec3<T>, to_light: Vec3<T>) -> T {
    normal.dot(to_light).max(T::lit(0.0))
}

/// Blinn's highlight with the exponent 32, by five squarings.
pub fn dpsm_highlight<T: Float>(normal: Vec3<T>, to_light: Vec3<T>, to_eye: Vec3<T>) -> T {
    let halfway = to_light + to_eye;
    let smallest = T::lit(1.0 / f64::from(1 << 24));
    let cosine = normal.dot(halfway).max(T::lit(0.0)) / halfway.length().max(smallest);
    let second = cosine * cosine;
    let fourth = second * second;
    let eighth = fourth * fourth;
    let sixteenth = eighth * eighth;
    sixteenth * sixteenth
}
