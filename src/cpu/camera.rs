//! The lit image by the ports.

use glam::Vec3;
use rayon::prelude::*;

use super::surface::Surface;
use super::{mix, opaque, pick, triangle};
use crate::render::{
    Filter, Frame, Kernel, Linear, Lookup, Taps, Vertex, View, float, rotation_at,
};
use crate::scalar::float::{self as scalar, Vec2, Vec4};
use crate::scalar::hemisphere::dpsm_to_light;
use crate::scalar::lights::{dpsm_lights_turn, dpsm_lights_visibility};
use crate::scalar::maps::DepthMaps;
use crate::scalar::visibility::{DpsmReceiverVertex, dpsm_receiver_vertex, dpsm_visibility_vertex};

/// The visible fragment of each pixel: triangle and weights.
pub(super) type Visible = Option<(u32, [f32; 3])>;

/// What a view sees through the centre of each pixel; depth is reversed, so the largest stays.
fn seen_by(frame: &Frame, view: &View) -> Vec<Visible> {
    let image = frame.settings.image;
    let clip: Vec<_> = frame.vertices.iter().map(|v| project(view, v.position)).collect();
    let pixels = image[0] as usize * image[1] as usize;
    let mut nearest = vec![f32::NEG_INFINITY; pixels];
    let mut seen = vec![None; pixels];
    for (index, corners) in (0..).zip(&frame.triangles) {
        let Some(clip) = pick(&clip, *corners) else { continue };
        triangle(clip, image, view.near, &mut |fragment| {
            let pixel = (fragment.y * image[0] + fragment.x) as usize;
            if fragment.depth > nearest[pixel] && opaque(frame, index, &fragment) {
                nearest[pixel] = fragment.depth;
                seen[pixel] = Some((index, fragment.weights));
            }
        });
    }
    seen
}

/// The camera's projection, as camera.wesl's `project`.
fn project(view: &View, position: Vec3) -> Vec4<f32> {
    let d = float(position) - float(view.eye);
    let w = float(view.forward).dot(d);
    Vec4::new(
        float(view.right).dot(d) * view.scale[0] + view.shift[0] * w,
        float(view.up).dot(d) * view.scale[1] + view.shift[1] * w,
        view.near,
        w,
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

/// What the camera sees through the centre of each pixel, row by row from the top.
pub fn surface_points(frame: &Frame) -> Vec<Option<SurfacePoint>> {
    let point = |(triangle, weights)| SurfacePoint {
        triangle,
        p: Surface::new(frame, triangle, weights).p,
    };
    seen_by(frame, &frame.view).into_iter().map(|seen| seen.map(point)).collect()
}

/// The lit image: the mean of each pixel's samples.
pub(super) fn lit(frame: &Frame, maps: &DepthMaps, more: &[(Frame, DepthMaps)]) -> Linear {
    let image = frame.settings.image;
    let places = frame.settings.places();
    let mut sum = Linear::empty(image);
    for place in &places {
        let sample = frame.view.sampled(*place, image);
        sum.add(&match more {
            [] => camera_pass(frame, maps, &sample),
            more => lights_pass(frame, maps, more, &sample),
        });
    }
    sum.divided(places.len() as u32)
}

/// The lit image with a visibility of one's own, from 0 to 1, in place of what the maps say: of the
/// place where a surface is tested.
pub fn lit_by(frame: &Frame, visibility: impl Fn(SurfacePoint) -> f32 + Sync) -> Linear {
    let image = frame.settings.image;
    let places = frame.settings.places();
    let eye = dpsm_to_light(float(frame.view.eye), frame.light);
    let mut sum = Linear::empty(image);
    for place in &places {
        let seen = seen_by(frame, &frame.view.sampled(*place, image));
        sum.add(&color(&seen, image, |_, triangle, weights| {
            let surface = Surface::new(frame, triangle, weights);
            let p = surface.receiver(frame, eye);
            surface.shade(frame, eye, visibility(SurfacePoint { triangle, p }))
        }));
    }
    sum.divided(places.len() as u32)
}

/// The same as the mean over several lights, as camera.wesl's `lights_fragment`.
fn lights_pass(
    frame: &Frame,
    maps: &DepthMaps,
    more: &[(Frame, DepthMaps)],
    sample: &View,
) -> Linear {
    let Frame { light, view, settings, .. } = frame;
    let seen = seen_by(frame, sample);
    let taps = frame.taps();
    let to_world = |v: scalar::Vec3<f32>| light.right * v.x + light.up * v.y + light.forward * v.z;
    let eye = dpsm_to_light(float(view.eye), *light);
    color(&seen, settings.image, |pixel, triangle, weights| {
        let surface = Surface::new(frame, triangle, weights);
        let world = light.position + to_world(surface.p);
        let tested = light.position + to_world(surface.receiver(frame, eye));
        let plane = to_world(surface.plane);
        let normal = to_world(surface.normal);
        let rotation = rotation_at(pixel, sample.shift);
        let shaded = |own: &Frame, maps: &DepthMaps| {
            let light = own.light;
            let p = dpsm_to_light(world, light);
            let radius = match settings.filter {
                Filter::Disk(Taps { kernel: Kernel::Radius(radius), .. }) => radius,
                Filter::Disk(Taps { kernel: Kernel::Tangent(tangent), .. }) => tangent * p.length(),
                _ => 0.0,
            };
            let share = dpsm_lights_visibility(maps, tested, plane, light, taps, radius, rotation);
            let eye = dpsm_to_light(float(view.eye), light);
            let normal = dpsm_lights_turn(normal, light);
            let plane = dpsm_lights_turn(plane, light);
            Surface { p, plane, normal, ..surface }.shade(own, eye, share)
        };
        let others = more.iter().map(|(own, maps)| shaded(own, maps));
        let sum = others.fold(shaded(frame, maps), |sum, part| sum + part);
        sum / (1 + more.len()) as f32
    })
}

/// One sample of each pixel of the lit image.
fn camera_pass(frame: &Frame, maps: &DepthMaps, sample: &View) -> Linear {
    let Frame { light, view, settings, .. } = frame;
    let seen = seen_by(frame, sample);
    let at_vertices: Vec<DpsmReceiverVertex<f32>> = match settings.lookup {
        Lookup::Pixel => Vec::new(),
        Lookup::Vertex => {
            let receiver = |v: &Vertex| dpsm_to_light(float(v.position), *light);
            frame.vertices.iter().map(|v| dpsm_receiver_vertex(receiver(v), *light)).collect()
        }
    };
    let eye = dpsm_to_light(float(view.eye), *light);
    color(&seen, settings.image, |pixel, triangle, weights| {
        let surface = Surface::new(frame, triangle, weights);
        let visibility = match settings.lookup {
            Lookup::Pixel => {
                let rotation = rotation_at(pixel, sample.shift);
                let receiver = surface.receiver(frame, eye);
                frame.visibility_turned(maps, receiver, surface.plane, rotation)
            }
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

/// Colours a visibility buffer, its rows shared out over the processor's cores.
fn color(
    seen: &[Visible],
    image: [u32; 2],
    shade: impl Fn([u32; 2], u32, [f32; 3]) -> Vec3 + Sync,
) -> Linear {
    let mut linear = Linear::empty(image);
    linear.pixels.par_iter_mut().zip(seen).enumerate().for_each(|(index, (pixel, seen))| {
        if let Some((triangle, weights)) = *seen {
            let index = index as u32;
            let place = [index % image[0], index / image[0]];
            *pixel = shade(place, triangle, weights).extend(1.0).to_array();
        }
    });
    linear
}
