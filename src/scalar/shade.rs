//! Port of `wgsl/shade.wesl`.

use super::float::{Float, Vec3};

/// A corner of a triangle that is shaded smoothly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmCorner<T> {
    /// Where it is, in any space.
    pub position: Vec3<T>,
    /// Unit normal there, on the side that is lit.
    pub normal: Vec3<T>,
}

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

/// How much of a spot light goes in a direction.
pub fn dpsm_spot<T: Float>(cosine: T, inner: T, outer: T) -> T {
    let wide = (inner - outer).max(T::lit(0.001));
    let share = ((cosine - outer) / wide).clamp(T::lit(0.0), T::lit(1.0));
    share * share
}

/// What a light's range leaves of it at a distance.
pub fn dpsm_range<T: Float>(distance: T, range: T) -> T {
    let share = (distance / range).min(T::lit(1.0));
    let square = share * share;
    T::lit(1.0) - square * square
}

/// Where the shadow test of a smoothly shaded triangle should be made: on the curved surface that
/// the corners' normals suggest.
pub fn dpsm_shadow_terminator<T: Float>(
    p: Vec3<T>,
    weights: Vec3<T>,
    a: DpsmCorner<T>,
    b: DpsmCorner<T>,
    c: DpsmCorner<T>,
) -> Vec3<T> {
    // how far the point is below a corner's plane, as a number below 0
    let below = |corner: DpsmCorner<T>| (p - corner.position).dot(corner.normal).min(T::lit(0.0));
    let share = Vec3::new(weights.x * below(a), weights.y * below(b), weights.z * below(c));
    p - (a.normal * share.x + b.normal * share.y + c.normal * share.z)
}
