//! A cube map's faces by the ports.

use super::{opaque, triangle};
use crate::render::{Frame, Vertex, float};
use crate::scalar::cube::{dpsm_cube_outside, dpsm_cube_vertex};
use crate::scalar::float::{Vec3, Vec4};
use crate::scalar::hemisphere::dpsm_to_light;

/// One face's map: the stored depths of all casters. Nothing nearer than the near plane is drawn.
pub fn map_pass(frame: &Frame, face: u32, layer: &mut [f32]) {
    let Frame { light, settings, .. } = frame;
    let size = settings.map_size();
    let (places, clip) = placed(frame, face);
    for index in frame.drawn().into_iter().flat_map(|(triangles, _)| triangles) {
        let corners = frame.triangles[index as usize];
        let [a, b, c] = corners.map(|corner| places[corner as usize]);
        if settings.cull_faces && dpsm_cube_outside(a, b, c, face, light.guard) {
            continue;
        }
        let clip = corners.map(|corner| clip[corner as usize]);
        triangle(clip, [size; 2], light.near, &mut |fragment| {
            if (0.0..=1.0).contains(&fragment.depth) && opaque(frame, index, &fragment) {
                let texel = &mut layer[(fragment.y * size + fragment.x) as usize];
                *texel = texel.min(settings.format.store(fragment.depth));
            }
        });
    }
}

/// Every vertex in light space, and in the face's clip space.
fn placed(frame: &Frame, face: u32) -> (Vec<Vec3<f32>>, Vec<Vec4<f32>>) {
    let place = |vertex: &Vertex| {
        let p = dpsm_to_light(float(vertex.position), frame.light);
        (p, dpsm_cube_vertex(p, face, frame.light))
    };
    frame.vertices.iter().map(place).unzip()
}
