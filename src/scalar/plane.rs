//! Port of `wgsl/plane.wesl`.

use super::bias::{DPSM_RECEIVER_ROUNDING, DpsmReceiver, dpsm_bias_slack};
use super::depth::{dpsm_depth_stored, dpsm_depth_stored_four, dpsm_receiver_depth};
use super::float::{Float, Vec2, Vec3, Vec4, select};
use super::hemisphere::{dpsm_flip, dpsm_hemisphere};
use super::light::{DpsmLight, dpsm_light_coordinates, dpsm_light_layer};
use super::maps::Maps;
use super::paraboloid::{DPSM_SMALLEST, dpsm_disk_to_texture, dpsm_texel_width};

/// How far along its normal a receiver is moved for a single lookup: texels, times the sine.
pub const DPSM_PLANE_SHIFT: f64 = 0.25;

/// The same where no plane is compared: half a texel's diagonal, rounded up.
pub const DPSM_PLANE_DIAGONAL: f64 = 0x16a09e8 as f64 / (1u64 << 25) as f64;

/// How much nearer than plane and receiver, in texels, a stored depth must be to shadow.
pub const DPSM_PLANE_DARK: f64 = 0.5;

/// Where no plane is compared, how much nearer than the receiver, in texels, is still lit.
pub const DPSM_PLANE_OWN: f64 = 0.3;

/// How far rounding may turn and move two planes against each other beyond the receiver's own: 64 eps.
pub const DPSM_PLANE_ROUNDING: f64 = 1.0 / (1u64 << 17) as f64;

/// What a stored distance is to be taken for: 36 eps more.
pub const DPSM_PLANE_REACH: f64 = 1.0 + 36.0 / (1u64 << 23) as f64;

/// A receiver in its map, moved along its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmPlane<T> {
    /// Disk coordinates of the moved receiver, in the receiver's own hemisphere.
    pub uv: Vec2<T>,
    /// What n . d gains for each radian along u and v.
    pub lean: Vec2<T>,
    /// n . d of the moved plane at uv, and all that it may be too small by.
    pub facing: T,
    /// The cosine of the incidence.
    pub cosine: T,
    /// The angle of a texel there.
    pub pitch: T,
    /// The plane's height above the light, in units of far - near.
    pub height: T,
    /// The moved receiver's distance in the same units, at most far's.
    pub distance: T,
    /// What a stored depth lacks to be a distance in these units.
    pub near: T,
    /// The receiver's hemisphere.
    pub hemisphere: u32,
}

/// The receiver moved towards the light along its normal by `shift` texels times the sine of its
/// incidence.
pub fn dpsm_plane<T: Float>(
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    shift: T,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> DpsmPlane<T> {
    let one = T::lit(1.0);
    let hemisphere = dpsm_hemisphere(p);
    let n = dpsm_flip(receiver.plane.xyz(), hemisphere);
    let l = receiver.distance.max(T::lit(DPSM_SMALLEST));
    let sum = l + p.z.abs();
    let inverse = one / (l * sum);
    let uv = p.xy() * (inverse * l);
    let cosine = (receiver.plane.w * (inverse * sum)).min(one);
    let sine = ((one - cosine) * (one + cosine)).sqrt();
    let width = dpsm_texel_width(light.size, light.guard);
    let pitch = width * (sum * (inverse * sum));
    let lean = n.xy() - uv * (n.z + cosine);
    let moved = shift * sine;
    let inside = (light.far * (inverse * sum)).min(one);
    let grown = tolerance + T::lit(DPSM_PLANE_REACH);
    let range = one / (grown * (light.far - light.near));
    let rounding = receiver.rounding + T::lit(DPSM_PLANE_ROUNDING);
    DpsmPlane {
        uv: uv - lean * (moved * width),
        lean,
        facing: cosine + rounding + moved * pitch * (cosine * cosine),
        cosine,
        pitch,
        height: receiver.plane.w * inside * range,
        distance: l * inside * range * (one - moved * pitch * cosine),
        near: light.near * grown * range + quantum,
        hemisphere,
    }
}

/// The share of the light at a receiver by the four texels around it.
pub fn dpsm_visibility_plane<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> T {
    let shift = T::lit(DPSM_PLANE_SHIFT);
    let at = dpsm_plane(p, receiver, shift, light, quantum, tolerance);
    let four = dpsm_plane_four(at, light);
    let corner = (four.xy() + Vec2::splat(T::lit(1.0))) / light.size;
    let st = dpsm_light_coordinates(light, at.hemisphere, corner);
    let stored = maps.gather(st, dpsm_light_layer(light, at.hemisphere));
    let depths = dpsm_depth_stored_four(stored, light.reversed);
    select(T::lit(0.0), dpsm_plane_share(at, four, depths), at.hemisphere < light.hemispheres)
}

/// The four texels around a receiver: the first one's place, and how far the receiver is from it.
pub fn dpsm_plane_four<T: Float>(at: DpsmPlane<T>, light: DpsmLight<T>) -> Vec4<T> {
    let half = Vec2::splat(T::lit(0.5));
    let place = dpsm_disk_to_texture(at.uv, light.guard) * light.size - half;
    let last = Vec2::splat(light.size - T::lit(2.0));
    let first = place.floor().max(Vec2::splat(T::lit(0.0))).min(last);
    let share = place - first;
    Vec4::new(first.x, first.y, share.x, share.y)
}

/// The share of the light by the four depths that a gather at the corner of four texels gives.
pub fn dpsm_plane_share<T: Float>(at: DpsmPlane<T>, four: Vec4<T>, stored: Vec4<T>) -> T {
    let (zero, one) = (T::lit(0.0), T::lit(1.0));
    let step = at.lean * at.pitch;
    let left = at.facing - step.x * four.z;
    let right = left + step.x;
    let up = step.y * four.w;
    let down = up - step.y;
    let facing = [left + down, right + down, right + up, left + up];
    let texel = (T::lit(DPSM_PLANE_DARK) * at.pitch) * at.cosine;
    let near = Vec2::splat(one) - four.zw();
    let weight = [near.x * four.w, four.z * four.w, four.z * near.y, near.x * near.y];
    let reach = stored.to_array().map(|stored| stored + at.near);
    let each = |says: &dyn Fn(usize) -> bool| {
        T::sum(std::array::from_fn::<T, 4, _>(|i| select(zero, weight[i], says(i))))
    };
    let bright = each(&|i| reach[i] * facing[i] >= at.height);
    let dark = each(&|i| reach[i] * (facing[i].max(at.cosine) + texel) < at.height);
    let both = bright + dark;
    if both > zero { bright / both } else { one }
}

/// The share of the light at a receiver by the hardware's 2 x 2 comparison, of its own distance.
pub fn dpsm_visibility_normal<T: Float>(
    maps: &impl Maps<T>,
    p: Vec3<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> T {
    let at = dpsm_plane(p, receiver, T::lit(DPSM_PLANE_DIAGONAL), light, quantum, tolerance);
    let layer = dpsm_light_layer(light, at.hemisphere);
    let st = dpsm_disk_to_texture(at.uv, light.guard);
    let place = dpsm_light_coordinates(light, at.hemisphere, st);
    let depths = dpsm_plane_depths(at, receiver, light, quantum, tolerance);
    let first = dpsm_depth_stored(depths.x, light.reversed);
    let second = dpsm_depth_stored(depths.y, light.reversed);
    let lit = maps.compare(place, layer, first);
    let dark = T::lit(1.0) - maps.compare(place, layer, second);
    let decided = lit + dark;
    let share = if decided > T::lit(0.0) { lit / decided } else { T::lit(0.0) };
    select(T::lit(0.0), share, at.hemisphere < light.hemispheres)
}

/// The depths of a moved receiver's own distance: what is no nearer is lit, what is nearer than the
/// second is in shadow.
pub fn dpsm_plane_depths<T: Float>(
    at: DpsmPlane<T>,
    receiver: DpsmReceiver<T>,
    light: DpsmLight<T>,
    quantum: T,
    tolerance: T,
) -> Vec2<T> {
    let sine = at.lean.length();
    let distance = receiver.distance;
    let texel = at.pitch * distance;
    let off = receiver.rounding - T::lit(DPSM_RECEIVER_ROUNDING);
    let near = distance - distance * (off / (at.cosine + off).max(T::lit(DPSM_SMALLEST)));
    let own = near - texel * (T::lit(DPSM_PLANE_DIAGONAL) * sine * at.cosine);
    let depth = |less: T| dpsm_receiver_depth(own - texel * less, light.near, light.far);
    let slack = dpsm_bias_slack(distance, light, quantum, tolerance);
    let [lit, dark] = [depth(T::lit(DPSM_PLANE_OWN)), depth(T::lit(1.0))];
    Vec2::new(lit - slack, dark - slack)
}
