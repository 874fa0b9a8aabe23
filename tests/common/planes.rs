//! Maps of one plane, and planes to be seen at any incidence.
#![allow(dead_code)] // each test file uses its part

use dpsm::scalar::depth::{dpsm_depth, dpsm_within};
use dpsm::scalar::float::{Vec2, Vec3};
use dpsm::scalar::hemisphere::dpsm_flip;
use dpsm::scalar::light::{DPSM_LAYERS, DpsmLight};
use dpsm::scalar::maps::Maps;
use dpsm::scalar::paraboloid::{dpsm_texture_to_disk, dpsm_unproject};
use dpsm::scalar::visibility::dpsm_lookup;
use fastrand::Rng;

use super::{cross, spread, uniform, unit};

/// Steps of the formats' stored values; none where a float is stored.
pub const FORMATS: [Option<f64>; 3] = [Some(65535.0), Some(16777215.0), None];

/// Map sizes.
pub const SIZES: [u32; 6] = [128, 256, 512, 1024, 2048, 4096];

/// The guard band of the host, two diagonals of a texel.
pub fn plain_light(size: u32) -> DpsmLight<f32> {
    let diagonal = 8_f32.sqrt();
    DpsmLight {
        near: 0.01,
        far: 10.0,
        guard: diagonal / (size as f32 - diagonal),
        size: size as f32,
        first_layer: 0,
        ..dpsm::cases::light(DPSM_LAYERS)
    }
}

/// A format's quantum, as its callers give it.
pub fn quantum(steps: Option<f64>) -> f32 {
    steps.map_or(0.0, |steps| (1.0 / steps) as f32)
}

/// A depth as an adapter may store it at the least: the neighbour below.
pub fn stored_below(depth: f64, steps: Option<f64>) -> f32 {
    match steps {
        Some(steps) => ((depth.clamp(0.0, 1.0) * steps).floor() / steps) as f32,
        None => (depth as f32).next_down(),
    }
}

/// A point and a normal whose incidence is up to 89.9 degrees, as often near that as near 0; every
/// fourth point is within a few texels of the seam.
pub fn grazing(rng: &mut Rng, size: u32) -> (Vec3<f32>, Vec3<f64>) {
    let mut d = unit(rng).widen();
    if rng.u8(0..4) == 0 {
        d.z = f64::from(uniform(rng, -8.0, 8.0)) / f64::from(size);
        d = d / d.length();
    }
    let p = (d * f64::from(uniform(rng, 0.1, 9.0))).narrow();
    let steepest = 89.9_f64.to_radians();
    let incidence = match rng.bool() {
        true => steepest * rng.f64(),
        false => steepest - steepest * f64::from(spread(rng, -10, 0).abs()),
    };
    let d = p.widen() / p.widen().length();
    let across = loop {
        let across = cross(d, unit(rng).widen());
        if across.length() > 0.1 {
            break across / across.length();
        }
    };
    (p, d * incidence.cos() + across * incidence.sin())
}

/// The distance of the plane through p in a direction; `None` where it is not met.
pub fn met(p: Vec3<f64>, normal: Vec3<f64>, direction: Vec3<f64>) -> Option<f64> {
    let distance = normal.dot(p) / normal.dot(direction);
    (distance > 0.0 && distance.is_finite()).then_some(distance)
}

/// A map that holds one plane alone, each texel asked for as it is read.
pub struct PlaneMap {
    /// A point of the plane.
    pub p: Vec3<f64>,
    /// Its normal.
    pub normal: Vec3<f64>,
    /// The light.
    pub light: DpsmLight<f32>,
    /// The format.
    pub steps: Option<f64>,
    /// Texels from the one that is looked up to the one that is read.
    pub tap: [i32; 2],
}

impl PlaneMap {
    /// What the texel stores.
    pub fn depth(&self, st: Vec2<f32>, layer: u32) -> f32 {
        let size = f64::from(self.light.size);
        let texel = |c: f32, by: i32| (f64::from(c) * size).floor() + f64::from(by) + 0.5;
        let centre = Vec2::new(texel(st.x, self.tap[0]), texel(st.y, self.tap[1])) / size;
        let uv = dpsm_texture_to_disk(centre, self.light.guard.into());
        let (near, far) = (f64::from(self.light.near), f64::from(self.light.far));
        match met(self.p, self.normal, dpsm_flip(dpsm_unproject(uv), layer)) {
            Some(l) if dpsm_within(l, near, far) => {
                stored_below(dpsm_depth(l, near, far), self.steps)
            }
            _ => 1.0,
        }
    }
}

impl Maps<f32> for PlaneMap {
    fn compare(&self, st: Vec2<f32>, layer: u32, reference: f32) -> f32 {
        f32::from(u8::from(reference <= self.depth(st, layer)))
    }

    fn size(&self) -> Vec2<f32> {
        Vec2::splat(self.light.size)
    }

    fn load(&self, texel: Vec2<f32>, layer: u32) -> f32 {
        self.depth((texel + Vec2::splat(0.5)) / self.light.size, layer)
    }
}

/// A texel of a kernel's window, as often one of its corners as any.
pub fn tap(rng: &mut Rng, radius: i32) -> [i32; 2] {
    [0; 2].map(|_| match rng.bool() {
        true => rng.i32(-radius..=radius),
        false => radius * (rng.i32(0..2) * 2 - 1),
    })
}

/// How much nearer than a point its plane is at the window's texel centres at most, in units of
/// depth; 0 where no corner of the window meets it.
pub fn needed(p: Vec3<f32>, normal: Vec3<f64>, light: DpsmLight<f32>, radius: i32) -> f64 {
    let at = dpsm_lookup(p, light);
    let size = f64::from(light.size);
    let own = p.widen().length();
    let span = f64::from(light.far - light.near);
    let sides = if radius == 0 { vec![0] } else { vec![-radius, 0, radius] };
    let mut most: f64 = 0.0;
    for (x, y) in sides.iter().flat_map(|x| sides.iter().map(move |y| (*x, *y))) {
        let texel = |c: f32, by: i32| (f64::from(c) * size).floor() + f64::from(by) + 0.5;
        let centre = Vec2::new(texel(at.coordinates.x, x), texel(at.coordinates.y, y)) / size;
        let uv = dpsm_texture_to_disk(centre, light.guard.into());
        if let Some(l) = met(p.widen(), normal, dpsm_flip(dpsm_unproject(uv), at.hemisphere)) {
            most = most.max((own - l) / span);
        }
    }
    most
}

/// A point in a texel's corner and a plane that rises straight towards the farthest of the
/// window's centres: what needs the whole footprint bias.
pub fn worst(rng: &mut Rng, size: u32, radius: i32) -> (Vec3<f32>, Vec3<f64>) {
    let light = plain_light(size).widen();
    let side = f64::from(size);
    let unproject =
        |x: f64, y: f64| dpsm_unproject(dpsm_texture_to_disk(Vec2::new(x, y) / side, light.guard));
    // texels within the disk
    let texel = [0; 2].map(|_| (side * (0.2 + 0.6 * rng.f64())).floor());
    let reach = f64::from(radius) + 0.499;
    let d = unproject(texel[0] + 0.5 - 0.499, texel[1] + 0.5 - 0.499);
    let far = unproject(texel[0] - 0.499 + reach + 0.5, texel[1] - 0.499 + reach + 0.5);
    let towards = far - d * d.dot(far);
    let incidence = (10.0 + 79.0 * rng.f64()).to_radians();
    let normal = d * incidence.cos() + towards / towards.length() * incidence.sin();
    ((d * f64::from(uniform(rng, 0.1, 9.0))).narrow(), normal)
}
