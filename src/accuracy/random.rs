//! Random inputs: numbers, directions, points and lights.

use dpsm::scalar::float::Vec3;
use dpsm::scalar::light::DpsmLight;
use fastrand::Rng;

/// The generator of a named test, the same in every run.
pub fn rng(name: &str) -> Rng {
    Rng::with_seed(name.bytes().fold(7_u64, |seed, byte| seed.wrapping_mul(31) + u64::from(byte)))
}

/// Uniform in [low, high).
pub fn uniform(rng: &mut Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * rng.f32()
}

/// Either sign, magnitude log-uniform between two powers of two.
pub fn spread(rng: &mut Rng, low: i32, high: i32) -> f32 {
    let magnitude = f64::from(low) + f64::from(high - low) * rng.f64();
    let sign = if rng.bool() { 1.0 } else { -1.0 };
    (magnitude.exp2() * sign) as f32
}

/// A point whose components' magnitudes are log-uniform in [2^low, 2^high]: nearly every
/// neighbourhood of axes, poles and seam.
pub fn point(rng: &mut Rng, low: i32, high: i32) -> Vec3<f32> {
    Vec3::new(spread(rng, low, high), spread(rng, low, high), spread(rng, low, high))
}

/// A unit vector, uniform over the sphere up to rounding.
pub fn unit(rng: &mut Rng) -> Vec3<f32> {
    loop {
        let [x, y, z] = [0; 3].map(|_| f64::from(uniform(rng, -1.0, 1.0)));
        let length = (x * x + y * y + z * z).sqrt();
        if (0.1..=1.0).contains(&length) {
            return Vec3::new(x / length, y / length, z / length).narrow();
        }
    }
}

/// A point near another: off by 2^low to 2^high of its distance, in any direction.
pub fn nearby(rng: &mut Rng, p: Vec3<f32>, low: i32, high: i32) -> Vec3<f32> {
    p + unit(rng) * (p.length() * spread(rng, low, high))
}

/// A light with a random place, rotation and spheres.
pub fn light(rng: &mut Rng) -> DpsmLight<f32> {
    let forward = unit(rng).widen();
    let other = unit(rng).widen();
    let right = cross(forward, other);
    let right = right / right.length();
    let near = uniform(rng, 0.01, 1.0);
    DpsmLight {
        position: point(rng, -4, 8),
        near,
        right: right.narrow(),
        far: near * uniform(rng, 2.0, 1000.0),
        up: cross(forward, right).narrow(),
        guard: uniform(rng, 0.0, 1.0),
        forward: forward.narrow(),
        ..dpsm::cases::light(rng.u32(0..2))
    }
}

/// Cross product.
pub fn cross(a: Vec3<f64>, b: Vec3<f64>) -> Vec3<f64> {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}
