//! Port of `wgsl/kernel.wesl`.

use super::float::{Float, Vec2, Vec3, select};
use super::hemisphere::{DPSM_BACK, dpsm_flip, dpsm_hemisphere};
use super::paraboloid::{DPSM_SMALLEST, dpsm_project_own};

/// Cosine and sine of the golden angle pi (3 - sqrt 5).
pub const DPSM_KERNEL_GOLDEN: [f64; 2] = [-0.7373688780783197, 0.6754902942615238];

/// tan(pi / 16).
pub const DPSM_KERNEL_SIXTEENTH: f64 = 0.198912367379658;

/// Half the diagonal of a texel, in texels.
pub const DPSM_KERNEL_DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A cone of directions as one hemisphere's disk coordinates show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmKernel<T> {
    /// The axis's disk coordinates, r <= 1.
    pub axis: Vec2<T>,
    /// The disk's radius when the axis is the pole: the tangent of half the half-angle.
    pub reach: T,
    /// The hemisphere of the axis.
    pub hemisphere: u32,
}

/// Where a tap reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DpsmTap<T> {
    /// Disk coordinates in its own hemisphere, r <= 1.
    pub uv: Vec2<T>,
    /// The tap's hemisphere.
    pub hemisphere: u32,
}

/// The tangent of the half-angle under which the light sees a disk that faces it at p.
pub fn dpsm_kernel_tangent<T: Float>(p: Vec3<T>, radius: T) -> T {
    radius / p.length().max(T::lit(DPSM_SMALLEST))
}

/// The cone around p's direction, in p's own hemisphere.
pub fn dpsm_kernel<T: Float>(p: Vec3<T>, tangent: T) -> DpsmKernel<T> {
    let one = T::lit(1.0);
    let reach = tangent / (one + (one + tangent * tangent).sqrt());
    DpsmKernel { axis: dpsm_project_own(p), reach, hemisphere: dpsm_hemisphere(p) }
}

/// The disk of a cone in its hemisphere's coordinates: centre and radius.
pub fn dpsm_kernel_disk<T: Float>(p: Vec3<T>, tangent: T) -> Vec3<T> {
    let k = (T::lit(1.0) + tangent * tangent).sqrt();
    let l = p.length();
    let below = (k * p.z.abs() + l).max(T::lit(DPSM_SMALLEST));
    Vec3::new(p.x, p.y, l) / below * Vec3::new(k, k, tangent)
}

/// A tap of a kernel, continued in the other hemisphere where it lies beyond the rim.
pub fn dpsm_kernel_tap<T: Float>(kernel: DpsmKernel<T>, offset: Vec2<T>) -> DpsmTap<T> {
    let DpsmKernel { axis, reach, hemisphere } = kernel;
    let w = offset * reach;
    let above = axis + w;
    let real = T::lit(1.0) - axis.dot(w);
    let imaginary = axis.x * w.y - axis.y * w.x;
    let beyond = above.dot(above);
    let within = real * real + imaginary * imaginary;
    let product =
        Vec2::new(above.x * real - above.y * imaginary, above.y * real + above.x * imaginary);
    let other = DPSM_BACK.wrapping_sub(hemisphere);
    DpsmTap {
        uv: product / beyond.max(within),
        hemisphere: select(hemisphere, other, beyond > within),
    }
}

/// The tap as some engines continue it, r to 2 - r.
pub fn dpsm_kernel_mirrored<T: Float>(kernel: DpsmKernel<T>, offset: Vec2<T>) -> DpsmTap<T> {
    let tap = dpsm_kernel_tap(kernel, offset);
    if tap.hemisphere == kernel.hemisphere {
        return tap;
    }
    let inner = tap.uv.length().max(T::lit(DPSM_SMALLEST));
    let mirrored = (T::lit(2.0) - T::lit(1.0) / inner).max(T::lit(0.0));
    DpsmTap { uv: tap.uv * (mirrored / inner), ..tap }
}

/// A tap as Osman's text describes it: moved across the receiver's direction, projected again.
pub fn dpsm_kernel_projected<T: Float>(p: Vec3<T>, tangent: T, offset: Vec2<T>) -> DpsmTap<T> {
    let hemisphere = dpsm_hemisphere(p);
    let l = p.length();
    let rise = p.xy().dot(offset) / l.max(T::lit(DPSM_SMALLEST));
    let plane = offset - dpsm_project_own(p) * rise;
    let across = Vec3::new(plane.x, plane.y, -rise);
    let q = p + dpsm_flip(across, hemisphere) * (tangent * l);
    DpsmTap { uv: dpsm_project_own(q), hemisphere: dpsm_hemisphere(q) }
}

/// Radius in the unit disk of a tap of Vogel's spiral: sqrt((index + 1/2) / count).
pub fn dpsm_kernel_ring<T: Float>(index: u32, count: u32) -> T {
    ((T::lit(index.into()) + T::lit(0.5)) / T::lit(count.into())).sqrt()
}

/// The direction of the spiral's next tap: turned by the golden angle.
pub fn dpsm_kernel_turn<T: Float>(direction: Vec2<T>) -> Vec2<T> {
    let [c, s] = DPSM_KERNEL_GOLDEN.map(T::lit);
    Vec2::new(c * direction.x - s * direction.y, s * direction.x + c * direction.y)
}

/// Cosine and sine of the golden section of a right angle.
pub const DPSM_KERNEL_QUARTER: [f64; 2] = [0.5646348864175503, 0.8253408053890465];

/// Taps in rings of four, a right angle apart: how many rings.
pub fn dpsm_kernel_rings(count: u32) -> u32 {
    (count.wrapping_add(3) / 4).max(1)
}

/// The direction of the first tap of the next ring.
pub fn dpsm_kernel_next<T: Float>(direction: Vec2<T>) -> Vec2<T> {
    let [c, s] = DPSM_KERNEL_QUARTER.map(T::lit);
    Vec2::new(c * direction.x - s * direction.y, s * direction.x + c * direction.y)
}

/// A direction for a kernel's first tap that differs from pixel to pixel so that neighbours make
/// up for each other.
pub fn dpsm_kernel_rotation<T: Float>(pixel: [u32; 2]) -> Vec2<T> {
    // shares of a turn in 2^-32: 0.06711056 x + 0.00583715 y, and 52.9829189 times it
    let [x, y] = pixel;
    let along = x.wrapping_mul(288_237_660).wrapping_add(y.wrapping_mul(25_070_368));
    let bits = along.wrapping_mul(52).wrapping_add((along >> 16).wrapping_mul(64_417));
    let share = f64::from(bits >> 8) / f64::from(1 << 23) - 1.0;
    let start = Vec2::new(T::lit(1.0), T::lit(DPSM_KERNEL_SIXTEENTH) * T::lit(share));
    let mut turned = start / start.length();
    // four squarings of a complex number: the angle times 16
    for _ in 0..4 {
        turned = Vec2::new(
            turned.x * turned.x - turned.y * turned.y,
            turned.x * turned.y + turned.y * turned.x,
        );
    }
    turned
}

/// The guard band that keeps what a tap reads inside the stored disk for taps up to the rim.
pub fn dpsm_kernel_guard<T: Float>(size: T, side: T) -> T {
    let across = T::lit(2.0) * T::lit(DPSM_KERNEL_DIAGONAL) * side;
    across / (size - across).max(across)
}
