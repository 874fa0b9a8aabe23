//! Port of `wgsl/cube.wesl`.

use super::bias::{DpsmReceiver, dpsm_texel_centre};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::light::DpsmLight;
use super::maps::Maps;
use super::paraboloid::{
    DPSM_SMALLEST, dpsm_disk_to_texture, dpsm_texel_width, dpsm_texture_to_disk,
};
use super::visibility::DpsmLookup;

/// Faces of a cube.
pub const DPSM_CUBE_FACES: u32 = 6;

/// 1 and 16 eps: what dpsm_cube_outside adds to a face's half-extent.
pub const DPSM_CUBE_REACH: f64 = 1.0 + 1.0 / (1u64 << 19) as f64;

/// What rounding adds to a stored depth, over far / (far - near), for each (far + near) / z.
pub const DPSM_CUBE_STORED: f64 = 5.5 / (1u64 << 23) as f64;

/// The same to a stored depth's own rounding and to a receiver's depth: 12 eps.
pub const DPSM_CUBE_OWN: f64 = 12.0 / (1u64 << 23) as f64;

/// The face of a light-space point, by its largest component; z wins over y and y over x.
pub fn dpsm_cube_face<T: Float>(p: Vec3<T>) -> u32 {
    let zero = T::lit(0.0);
    let size = Vec3::new(p.x.abs(), p.y.abs(), p.z.abs());
    if size.z >= size.x.max(size.y) {
        return select(5, 4, p.z >= zero);
    }
    if size.y >= size.x {
        return select(3, 2, p.y >= zero);
    }
    select(1, 0, p.x >= zero)
}

/// A light-space point in a face's view space: x right, y up, z forward along the face's axis.
pub fn dpsm_cube_view<T: Float>(p: Vec3<T>, face: u32) -> Vec3<T> {
    match face {
        0 => Vec3::new(-p.z, p.y, p.x),
        1 => Vec3::new(p.z, p.y, -p.x),
        2 => Vec3::new(p.x, -p.z, p.y),
        3 => Vec3::new(p.x, p.z, -p.y),
        4 => p,
        _ => Vec3::new(-p.x, p.y, -p.z),
    }
}

/// A point of a face's view space in light space, the inverse of dpsm_cube_view.
pub fn dpsm_cube_unview<T: Float>(v: Vec3<T>, face: u32) -> Vec3<T> {
    match face {
        0 => Vec3::new(v.z, v.y, -v.x),
        1 => Vec3::new(-v.z, v.y, v.x),
        2 => Vec3::new(v.x, v.z, -v.y),
        3 => Vec3::new(v.x, -v.z, v.y),
        4 => v,
        _ => Vec3::new(-v.x, v.y, -v.z),
    }
}

/// The guard band of a face of size x size texels that is one texel wide, 2 / (size - 2).
pub fn dpsm_cube_guard<T: Float>(size: T) -> T {
    let two = T::lit(2.0);
    two / (size - two).max(two)
}

/// Clip-space position for a face's pass.
pub fn dpsm_cube_vertex<T: Float>(p: Vec3<T>, face: u32, light: DpsmLight<T>) -> Vec4<T> {
    let v = dpsm_cube_view(p, face);
    let depth = light.far * (v.z - light.near) / (light.far - light.near);
    let plane = v.xy() / (T::lit(1.0) + light.guard);
    Vec4::new(plane.x, plane.y, depth, v.z)
}

/// The stored depth at the distance z along a face's axis: far (z - near) / (z (far - near)).
pub fn dpsm_cube_depth<T: Float>(z: T, near: T, far: T) -> T {
    let at = z.max(near);
    (((at - near) / at) / ((far - near) / far)).min(T::lit(1.0))
}

/// The stored depth that a receiver compares, moved towards the light by bias (far - near).
pub fn dpsm_cube_receiver_depth<T: Float>(
    p: Vec3<T>,
    face: u32,
    light: DpsmLight<T>,
    bias: T,
) -> T {
    let z = dpsm_cube_view(p, face).z;
    let share = bias * (light.far - light.near) / p.length().max(T::lit(DPSM_SMALLEST));
    dpsm_cube_depth(z - z * share, light.near, light.far)
}

/// The lookup of a light-space point: face, place in its layer and own depth.
pub fn dpsm_cube_lookup<T: Float>(p: Vec3<T>, light: DpsmLight<T>) -> DpsmLookup<T> {
    let face = dpsm_cube_face(p);
    let v = dpsm_cube_view(p, face);
    DpsmLookup {
        coordinates: dpsm_disk_to_texture(v.xy() / v.z.max(T::lit(DPSM_SMALLEST)), light.guard),
        depth: dpsm_cube_depth(v.z, light.near, light.far),
        layer: light.first_layer.wrapping_add(face),
        hemisphere: face,
        mapped: true,
    }
}

/// What is left of the bias where the same direction is compared, in units of the stored depth.
pub fn dpsm_cube_slack<T: Float>(z: T, light: DpsmLight<T>, quantum: T) -> T {
    let steps = T::lit(DPSM_CUBE_STORED) * ((light.far + light.near) / z.max(light.near))
        + T::lit(DPSM_CUBE_OWN);
    quantum + steps * (light.far / (light.far - light.near))
}

/// The depth along the centre of the receiver's texel, of its plane, less the slack.
pub fn dpsm_cube_lookup_texel_centre<T: Float>(
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
) -> DpsmLookup<T> {
    let zero = T::lit(0.0);
    let at = dpsm_cube_lookup(p, light);
    let v = dpsm_cube_view(p, at.hemisphere);
    let centre = dpsm_texel_centre(v.xy() / v.z.max(T::lit(DPSM_SMALLEST)), light);
    let direction = Vec3::new(centre.x, centre.y, T::lit(1.0));
    let l = direction.length();
    let facing = receiver.plane.xyz().dot(dpsm_cube_unview(direction, at.hemisphere));
    let leaned = facing.max(zero) + receiver.rounding * l;
    // beyond the plane's horizon only what is nearer than the receiver can shadow it
    let there = (receiver.plane.w / leaned).min(light.far / l);
    let z = select(receiver.distance / l, there, facing > zero);
    DpsmLookup {
        coordinates: dpsm_disk_to_texture(centre, light.guard),
        depth: dpsm_cube_depth(z, light.near, light.far) - dpsm_cube_slack(z, light, quantum),
        ..at
    }
}

/// The lookup less the footprint bias of a square window, whose half side is `texels`, and the
/// slack.
pub fn dpsm_cube_lookup_footprint<T: Float>(
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    texels: T,
    light: DpsmLight<T>,
    quantum: T,
) -> DpsmLookup<T> {
    let at = dpsm_cube_lookup(p, light);
    let normal = dpsm_cube_view(receiver.plane.xyz(), at.hemisphere);
    let side = texels * dpsm_texel_width(light.size, light.guard);
    let rise = side * (normal.x.abs() + normal.y.abs());
    let own = dpsm_cube_view(p, at.hemisphere).z.max(T::lit(DPSM_SMALLEST));
    let height = receiver.plane.w;
    let risen = height + rise * own + receiver.rounding * receiver.distance;
    let z = own * (height / risen.max(T::lit(DPSM_SMALLEST)));
    let depth = dpsm_cube_depth(z, light.near, light.far) - dpsm_cube_slack(z, light, quantum);
    DpsmLookup { depth, ..at }
}

/// The shadow test for each pixel: 1 lit, 0 in shadow; `maps` stands for texture and sampler.
pub fn dpsm_cube_visibility<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    light: DpsmLight<T>,
    bias: T,
) -> T {
    let at = dpsm_cube_lookup(p, light);
    let own = dpsm_cube_receiver_depth(p, at.hemisphere, light, bias);
    maps.compare(at.coordinates, at.layer, own)
}

/// The light-space direction of a face's texture coordinates, of length 1 along the face's axis.
pub fn dpsm_cube_direction<T: Float>(st: Vec2<T>, face: u32, guard: T) -> Vec3<T> {
    let plane = dpsm_texture_to_disk(st, guard);
    dpsm_cube_unview(Vec3::new(plane.x, plane.y, T::lit(1.0)), face)
}

/// The radial distance of a stored depth in a direction of dpsm_cube_direction.
pub fn dpsm_cube_distance<T: Float>(depth: T, direction: Vec3<T>, near: T, far: T) -> T {
    direction.length() * (near * far / (far * (T::lit(1.0) - depth) + near * depth))
}

/// True when a triangle of light-space corners cannot reach a face.
pub fn dpsm_cube_outside<T: Float>(
    a: Vec3<T>,
    b: Vec3<T>,
    c: Vec3<T>,
    face: u32,
    guard: T,
) -> bool {
    let corners = [a, b, c].map(|p| dpsm_cube_view(p, face));
    let reach = T::lit(DPSM_CUBE_REACH) + guard;
    corners.iter().all(|v| v.x > v.z * reach)
        || corners.iter().all(|v| -v.x > v.z * reach)
        || corners.iter().all(|v| v.y > v.z * reach)
        || corners.iter().all(|v| -v.y > v.z * reach)
        || corners.iter().all(|v| v.z <= T::lit(0.0))
}
