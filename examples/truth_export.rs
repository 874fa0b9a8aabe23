//! Writes a scene's triangles, random rays and their first hits for tools/embree.py:
//! `cargo run --release --example truth_export SCENE RAYS > FILE`.
//!
//! Little-endian: the counts of triangles and rays (u32), nine f32 a triangle, six f32 a ray
//! (origin, direction), then a u32 (the triangle, or 2^32 - 1) and an f64 (the distance) a ray.

use std::io::Write;

use dpsm::scene::{Options, open};
use dpsm::truth::{Ray, Truth};
use glam::{Vec3, vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let usage = "usage: truth_export SCENE RAYS > FILE";
    let scene = open(&arguments.next().ok_or(usage)?, &Options::default())?;
    let count: u32 = arguments.next().ok_or(usage)?.parse()?;
    let bounds = scene.bounds();
    let mut rng = fastrand::Rng::with_seed(7);
    let mut cube = || vec3(rng.f32(), rng.f32(), rng.f32());
    let rays: Vec<[Vec3; 2]> = (0..count)
        .map(|_| {
            let origin = bounds.min + bounds.extent() * cube();
            let mut directions = std::iter::repeat_with(|| 2.0 * cube() - 1.0);
            let inside = |v: &Vec3| (1e-4..1.0).contains(&v.length_squared());
            [origin, directions.find(inside).unwrap_or(Vec3::X)]
        })
        .collect();
    let widened =
        rays.iter().map(|[origin, direction]| Ray::new(origin.as_dvec3(), direction.as_dvec3()));
    let hits = Truth::from(&scene).first_hits(&widened.collect::<Vec<_>>());

    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    out.write_all(&(scene.triangle_count() as u32).to_le_bytes())?;
    out.write_all(&count.to_le_bytes())?;
    for v in scene.triangles().flatten().chain(rays.into_iter().flatten()) {
        v.to_array().iter().try_for_each(|c| out.write_all(&c.to_le_bytes()))?;
    }
    for hit in hits {
        let (triangle, distance) =
            hit.map_or((u32::MAX, f64::INFINITY), |h| (h.triangle, h.distance));
        out.write_all(&triangle.to_le_bytes())?;
        out.write_all(&distance.to_le_bytes())?;
    }
    Ok(out.flush()?)
}
