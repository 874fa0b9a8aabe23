//! Port of `wgsl/edge.wesl`.

use super::float::{Float, Vec2, Vec3, Vec4, select};

/// How far on the disk rounding may move an arc: 32 eps.
pub const DPSM_EDGE_ROUNDING: f64 = 1.0 / (1u64 << 18) as f64;

/// How far rasterizers may move a chord, in texels.
pub const DPSM_EDGE_SNAP: f64 = 1.0 / 256.0;

/// Smallest distance that is told from 0.
pub const DPSM_EDGE_NEAREST: f64 = 1.0 / (1u64 << 60) as f64;

/// The largest component's magnitude.
pub fn dpsm_edge_largest<T: Float>(v: Vec3<T>) -> T {
    v.x.abs().max(v.y.abs()).max(v.z.abs())
}

/// The unit vector along v; zero for vectors below 2^-100.
pub fn dpsm_edge_unit<T: Float>(v: Vec3<T>) -> Vec3<T> {
    let largest = dpsm_edge_largest(v);
    if largest < T::lit(1.0 / (1u128 << 100) as f64) {
        return Vec3::splat(T::lit(0.0));
    }
    let scaled = v / largest;
    scaled / scaled.length()
}

/// True where a comes before b: the one nearer to the light first.
pub fn dpsm_edge_ordered<T: Float>(a: Vec3<T>, b: Vec3<T>) -> bool {
    let length_a = dpsm_edge_largest(a);
    let length_b = dpsm_edge_largest(b);
    if length_a != length_b {
        return length_a < length_b;
    }
    if a.x != b.x {
        return a.x < b.x;
    }
    if a.y != b.y {
        return a.y < b.y;
    }
    a.z <= b.z
}

/// Unit normal of the plane through the light and both points, along a x b.
pub fn dpsm_edge_normal<T: Float>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    let ordered = dpsm_edge_ordered(a, b);
    let first = select(b, a, ordered);
    let second = select(a, b, ordered);
    // as far as the first: of an edge along the line of sight little but rounding would be left
    let scaled = second * (first.length() / second.length().max(T::lit(DPSM_EDGE_NEAREST)));
    let normal = dpsm_edge_unit(first.cross(scaled - first));
    select(-normal, normal, ordered)
}

/// How far the arc lies from its chord, in disk units, positive on the chord's right.
pub fn dpsm_edge_sagitta<T: Float>(normal_z: T, chord: Vec2<T>) -> T {
    let one = T::lit(1.0);
    let quarter = T::lit(0.25) * chord.dot(chord);
    let square = quarter * normal_z * normal_z;
    quarter * normal_z / (one + (one - square).max(T::lit(0.0)).sqrt())
}

/// The terms that a line weighs: (2u, 2v, 1 - r^2, 1).
pub fn dpsm_edge_terms<T: Float>(uv: Vec2<T>) -> Vec4<T> {
    let one = T::lit(1.0);
    Vec4::new(uv.x + uv.x, uv.y + uv.y, one - uv.dot(uv), one)
}

/// The line of an edge: its arc.
pub fn dpsm_edge_line<T: Float>(a: Vec3<T>, b: Vec3<T>) -> Vec4<T> {
    let (zero, half) = (T::lit(0.0), T::lit(0.5));
    let normal = dpsm_edge_normal(a, b);
    (normal * half).extend(select(T::lit(-1.0), zero, normal.dot(normal) > zero))
}
