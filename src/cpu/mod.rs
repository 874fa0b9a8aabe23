//! The rendering of a frame by the scalar ports alone, with no adapter.

pub mod cube;
mod maps;
mod raster;

pub use raster::{Fragment, triangle};

use std::time::{Duration, Instant};

use glam::Vec3;

use crate::render::{
    AMBIENT, Filter, Frame, FrameError, Kernel, Lookup, Method, Picture, Rendering, SPECULAR, Taps,
    Vertex, View, float,
};
use crate::scalar::caster::{dpsm_caster_keep, dpsm_caster_vertex};
use crate::scalar::float::{self as scalar, Float, Vec2, Vec4, select};
use crate::scalar::hemisphere::{dpsm_flip, dpsm_to_light};
use crate::scalar::lights::{dpsm_lights_turn, dpsm_lights_visibility};
use crate::scalar::maps::DepthMaps;
use crate::scalar::shade::{dpsm_highlight, dpsm_lambert, dpsm_shade};
use crate::scalar::visibility::{DpsmReceiverVertex, dpsm_receiver_vertex, dpsm_visibility_vertex};

/// Renders a frame on the processor.
pub fn render(frame: &Frame) -> Result<Rendering, FrameError> {
    let hemispheres = frame.light.hemispheres;
    let [width, height] = frame.settings.image;
    let mut timings = Vec::new();
    // a pixel takes its surface, its depth and its colour
    reserve::<(Visible, f32, [u8; 4])>("--image", u64::from(width) * u64::from(height))?;
    let maps = timed_maps(frame, &mut timings)?;
    let more = frame.more.iter().map(|&light| {
        let own = Frame { light, more: Vec::new(), ..frame.clone() };
        let maps = timed_maps(&own, &mut timings)?;
        Ok((own, maps))
    });
    let more: Vec<(Frame, DepthMaps)> = more.collect::<Result<_, FrameError>>()?;
    let start = Instant::now();
    let lit = match more.as_slice() {
        [] => camera_pass(frame, &maps),
        more => lights_pass(frame, &maps, more),
    };
    timings.push(("camera".to_string(), start.elapsed()));
    let mut views = Vec::new();
    if frame.settings.views {
        for (map, name) in (0..hemispheres).zip(frame.settings.method.projection().names()) {
            let start = Instant::now();
            views.push(view_pass(frame, &maps, map));
            timings.push((format!("{name} view"), start.elapsed()));
        }
    }
    let maps = frame.settings.views.then_some(maps);
    Ok(Rendering { lit, maps, views, timings })
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
    let mut maps = DepthMaps::empty(size, hemispheres, frame.settings.sampling);
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

/// The visible fragment of each pixel: triangle and weights.
type Visible = Option<(u32, [f32; 3])>;

/// Draws triangles into a visibility buffer; the fragment with the larger `nearness` stays.
fn visible(
    triangles: &[[u32; 3]],
    clip: &[Vec4<f32>],
    image: [u32; 2],
    smallest_w: f32,
    nearness: impl Fn(u32, &Fragment) -> Option<f32>,
) -> Vec<Visible> {
    let pixels = image[0] as usize * image[1] as usize;
    let mut nearest = vec![f32::NEG_INFINITY; pixels];
    let mut seen = vec![None; pixels];
    for (index, corners) in (0..).zip(triangles) {
        let Some(clip) = pick(clip, *corners) else { continue };
        triangle(clip, image, smallest_w, &mut |fragment| {
            let pixel = (fragment.y * image[0] + fragment.x) as usize;
            let Some(nearness) = nearness(index, &fragment) else {
                return;
            };
            if nearness > nearest[pixel] {
                nearest[pixel] = nearness;
                seen[pixel] = Some((index, fragment.weights));
            }
        });
    }
    seen
}

/// Colours a visibility buffer, its rows shared out over the processor's cores.
fn color(
    seen: &[Visible],
    [width, height]: [u32; 2],
    shade: impl Fn(u32, [f32; 3]) -> Vec3 + Sync,
) -> Picture {
    let mut pixels = vec![[0, 0, 0, 255]; seen.len()];
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let share = seen.len().div_ceil(cores).max(1);
    std::thread::scope(|scope| {
        for (pixels, seen) in pixels.chunks_mut(share).zip(seen.chunks(share)) {
            let shade = &shade;
            scope.spawn(move || {
                for (pixel, seen) in pixels.iter_mut().zip(seen) {
                    if let Some((triangle, weights)) = *seen {
                        let [r, g, b] = shade(triangle, weights).to_array().map(srgb);
                        *pixel = [r, g, b, 255];
                    }
                }
            });
        }
    });
    Picture { width, height, pixels }
}

/// The camera's projection, as camera.wesl's `project`.
fn project(view: &View, position: Vec3) -> Vec4<f32> {
    let d = float(position) - float(view.eye);
    Vec4::new(
        float(view.right).dot(d) * view.scale[0],
        float(view.up).dot(d) * view.scale[1],
        view.near,
        float(view.forward).dot(d),
    )
}

/// A pixel's surface: the triangle's index and the light-space point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Index in the frame's triangles.
    pub triangle: u32,
    /// Light-space position.
    pub p: scalar::Vec3<f32>,
}

/// What the camera sees through each pixel, row by row from the top.
pub fn surface_points(frame: &Frame) -> Vec<Option<SurfacePoint>> {
    let point = |(triangle, weights)| SurfacePoint {
        triangle,
        p: Surface::new(frame, triangle, weights).p,
    };
    seen_by_camera(frame).into_iter().map(|seen| seen.map(point)).collect()
}

fn seen_by_camera(frame: &Frame) -> Vec<Visible> {
    let Frame { view, settings, .. } = frame;
    let clip: Vec<_> = frame.vertices.iter().map(|v| project(view, v.position)).collect();
    let nearness =
        |index: u32, fragment: &Fragment| opaque(frame, index, fragment).then_some(fragment.depth);
    visible(&frame.triangles, &clip, settings.image, view.near, nearness)
}

/// The lit image as the mean over several lights, as camera.wesl's `lights_fragment`.
fn lights_pass(frame: &Frame, maps: &DepthMaps, more: &[(Frame, DepthMaps)]) -> Picture {
    let Frame { light, view, settings, .. } = frame;
    let seen = seen_by_camera(frame);
    let taps = frame.taps();
    let to_world = |v: scalar::Vec3<f32>| light.right * v.x + light.up * v.y + light.forward * v.z;
    let first = Vec2::new(1.0, 0.0);
    color(&seen, settings.image, |triangle, weights| {
        let surface = Surface::new(frame, triangle, weights);
        let world = light.position + to_world(surface.p);
        let plane = to_world(frame.light_normal(triangle));
        let normal = to_world(surface.normal);
        let shaded = |own: &Frame, maps: &DepthMaps| {
            let light = own.light;
            let p = dpsm_to_light(world, light);
            let radius = match settings.filter {
                Filter::Disk(Taps { kernel: Kernel::Radius(radius), .. }) => radius,
                Filter::Disk(Taps { kernel: Kernel::Tangent(tangent), .. }) => tangent * p.length(),
                _ => 0.0,
            };
            let share = dpsm_lights_visibility(maps, world, plane, light, taps, radius, first);
            let eye = dpsm_to_light(float(view.eye), light);
            let normal = dpsm_lights_turn(normal, light);
            Surface { p, normal, albedo: surface.albedo }.shade(own, eye, share)
        };
        let others = more.iter().map(|(own, maps)| shaded(own, maps));
        let sum = others.fold(shaded(frame, maps), |sum, part| sum + part);
        sum / (1 + more.len()) as f32
    })
}

/// The lit image.
fn camera_pass(frame: &Frame, maps: &DepthMaps) -> Picture {
    let Frame { light, view, settings, .. } = frame;
    let seen = seen_by_camera(frame);
    let at_vertices: Vec<DpsmReceiverVertex<f32>> = match settings.lookup {
        Lookup::Pixel => Vec::new(),
        Lookup::Vertex => {
            let receiver = |v: &Vertex| dpsm_to_light(float(v.position), *light);
            frame.vertices.iter().map(|v| dpsm_receiver_vertex(receiver(v), *light)).collect()
        }
    };
    let eye = dpsm_to_light(float(view.eye), *light);
    color(&seen, settings.image, |triangle, weights| {
        let surface = Surface::new(frame, triangle, weights);
        let visibility = match settings.lookup {
            Lookup::Pixel => frame.visibility(maps, surface.p, frame.light_normal(triangle)),
            Lookup::Vertex => {
                let corners = frame.triangles[triangle as usize].map(|i| at_vertices[i as usize]);
                let [fx, fy, bx, by, depth, hemisphere_value] = mix(weights, corners, |at| {
                    let DpsmReceiverVertex { front, back, depth, hemisphere_value } = at;
                    [front.x, front.y, back.x, back.y, depth, hemisphere_value]
                });
                let (front, back) = (Vec2::new(fx, fy), Vec2::new(bx, by));
                let at = DpsmReceiverVertex { front, back, depth, hemisphere_value };
                dpsm_visibility_vertex(maps, at, *light, frame.bias)
            }
        };
        surface.shade(frame, eye, visibility)
    })
}

/// What the light sees of one hemisphere or face.
fn view_pass(frame: &Frame, maps: &DepthMaps, map: u32) -> Picture {
    let seen = match frame.settings.method {
        Method::Cube => cube::seen(frame, map),
        _ => seen_by_light(frame, map),
    };
    color(&seen, [frame.settings.map_size(); 2], |triangle, weights| {
        let surface = Surface::new(frame, triangle, weights);
        let visibility = frame.visibility(maps, surface.p, frame.light_normal(triangle));
        surface.shade(frame, vector([0.0; 3]), visibility)
    })
}

/// What the light sees through each texel of one hemisphere.
fn seen_by_light(frame: &Frame, hemisphere: u32) -> Vec<Visible> {
    let Frame { light, settings, .. } = frame;
    let place = |vertex: &Vertex| {
        let p = dpsm_flip(dpsm_to_light(float(vertex.position), *light), hemisphere);
        dpsm_caster_vertex(p, *light, 0.0)
    };
    let placed: Vec<_> = frame.vertices.iter().map(place).collect();
    let clip: Vec<_> = placed.iter().map(|vertex| vertex.clip).collect();
    let image = [settings.size; 2];
    visible(&frame.triangles, &clip, image, 1.0, |index, fragment| {
        let corners = frame.triangles[index as usize].map(|i| placed[i as usize]);
        let [value] = mix(fragment.weights, corners, |vertex| [vertex.hemisphere_value]);
        let inside = dpsm_caster_keep(value) && (0.0..=1.0).contains(&fragment.depth);
        (inside && opaque(frame, index, fragment)).then_some(-fragment.depth)
    })
}

/// A surface point in light space.
struct Surface {
    p: scalar::Vec3<f32>,
    normal: scalar::Vec3<f32>,
    albedo: Vec3,
}

impl Surface {
    fn new(frame: &Frame, triangle: u32, weights: [f32; 3]) -> Self {
        let light = frame.light;
        let corners = frame.triangles[triangle as usize].map(|i| frame.vertices[i as usize]);
        let p = mix(weights, corners, |v| words(dpsm_to_light(float(v.position), light)));
        let normal = mix(weights, corners, |v| {
            let n = float(v.normal);
            [light.right.dot(n), light.up.dot(n), light.forward.dot(n)]
        });
        Self { p: vector(p), normal: vector(normal), albedo: corners[0].albedo }
    }

    /// Lit colour seen from `eye` in light space, as camera.wesl's `shade`.
    fn shade(&self, frame: &Frame, eye: scalar::Vec3<f32>, visibility: f32) -> Vec3 {
        let opposite = vector([0.0; 3]) - self.p;
        let to_light = opposite / self.p.length().max(frame.light.near);
        let to_eye = (eye - self.p) / Float::max((eye - self.p).length(), frame.view.near);
        let unit = self.normal / self.normal.length().max(1e-6);
        let normal = select(vector([0.0; 3]) - unit, unit, unit.dot(to_eye) >= 0.0);
        let cosine = dpsm_lambert(normal, to_light);
        let highlight = select(0.0, dpsm_highlight(normal, to_light, to_eye), cosine > 0.0);
        let color = frame.color;
        let lit = dpsm_shade(
            float(color * self.albedo * AMBIENT),
            float(color * self.albedo * cosine),
            float(color * SPECULAR * highlight),
            visibility,
        );
        Vec3::new(lit.x, lit.y, lit.z)
    }
}

/// A linear channel as an sRGB byte.
pub fn srgb(linear: f32) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let encoded = if c <= 0.0031308 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}
