//! The rendering of a frame by the scalar ports alone, with no adapter.

mod camera;
pub mod cube;
mod maps;
mod raster;
mod refined;
mod surface;
mod views;

pub use camera::{SurfacePoint, lit_by, surface_points};
pub use raster::{Fragment, triangle};
pub use refined::{Leaf, leaves};
pub use views::views;

use std::time::{Duration, Instant};

use crate::render::{Frame, FrameError, Rendering};
use crate::scalar::float as scalar;
use crate::scalar::maps::DepthMaps;

/// Renders a frame on the processor.
pub fn render(frame: &Frame) -> Result<Rendering, FrameError> {
    let [width, height] = frame.settings.image;
    let mut timings = Vec::new();
    // a pixel takes a sample's surface, depth and light, and the sum of the light
    type Pixel = (camera::Visible, f32, [[f32; 4]; 2]);
    reserve::<Pixel>("--image", u64::from(width) * u64::from(height))?;
    let maps = timed_maps(frame, &mut timings)?;
    let more = frame.more.iter().map(|&light| {
        let own = Frame { light, more: Vec::new(), ..frame.clone() };
        let maps = timed_maps(&own, &mut timings)?;
        Ok((own, maps))
    });
    let more: Vec<(Frame, DepthMaps)> = more.collect::<Result<_, FrameError>>()?;
    let start = Instant::now();
    let lit = camera::lit(frame, &maps, &more);
    timings.push(("camera".to_string(), start.elapsed()));
    let views = match frame.settings.views {
        true => views(frame, &mut timings),
        false => Vec::new(),
    };
    let maps = frame.settings.views.then_some(maps);
    Ok(Rendering::new(frame, &lit, &views, maps, timings))
}

/// Makes a frame's maps alone.
pub fn make_maps(frame: &Frame) -> Result<DepthMaps, FrameError> {
    timed_maps(frame, &mut Vec::new())
}

fn timed_maps(
    frame: &Frame,
    timings: &mut Vec<(String, Duration)>,
) -> Result<DepthMaps, FrameError> {
    let (size, hemispheres) = (frame.settings.map_size(), frame.light.hemispheres);
    reserve::<f32>("--size", u64::from(size) * u64::from(size) * u64::from(hemispheres))?;
    let mut maps = DepthMaps::empty(size, hemispheres, frame.settings.sampling_taken());
    if frame.settings.reversed {
        maps = maps.reverse();
    }
    let layers = maps.depths.chunks_mut(size as usize * size as usize);
    let start = Instant::now();
    for (hemisphere, layer) in (0..).zip(layers) {
        maps::map_pass(frame, hemisphere, layer)?;
    }
    timings.push(("maps".to_string(), start.elapsed()));
    Ok(maps)
}

/// Checks that there is memory for so many items before it is needed.
fn reserve<T>(what: &'static str, items: u64) -> Result<(), FrameError> {
    let failed = FrameError::Memory { what, bytes: items * size_of::<T>() as u64 };
    let mut probe = Vec::<T>::new();
    probe.try_reserve_exact(items as usize).map_err(|_| failed)
}

/// What a triangle's corners have, or `None` where an index is out of range.
fn pick<T: Copy>(items: &[T], corners: [u32; 3]) -> Option<[T; 3]> {
    let [a, b, c] = corners.map(|corner| items.get(corner as usize).copied());
    Some([a?, b?, c?])
}

/// Interpolates three values with a fragment's weights.
fn mix<T, const N: usize>(
    weights: [f32; 3],
    values: [T; 3],
    words: impl Fn(T) -> [f32; N],
) -> [f32; N] {
    let values = values.map(words);
    std::array::from_fn(|k| (0..3).map(|i| weights[i] * values[i][k]).sum())
}

fn words(v: scalar::Vec3<f32>) -> [f32; 3] {
    [v.x, v.y, v.z]
}

fn vector([x, y, z]: [f32; 3]) -> scalar::Vec3<f32> {
    scalar::Vec3::new(x, y, z)
}

/// False where a fragment is a hole of its triangle's mask.
fn opaque(frame: &Frame, triangle: u32, fragment: &Fragment) -> bool {
    frame.opaque(triangle, fragment.weights.map(f64::from))
}
