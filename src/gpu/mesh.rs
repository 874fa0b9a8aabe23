//! A frame's triangles in the adapter's memory.

use std::ops::Range;

use glam::{Vec2, Vec3};
use wgpu::BufferUsages as Usage;

use super::{Device, GpuError};
use crate::render::{Extent, Frame};
use crate::scalar::light::DpsmLight;

/// Positions apart from what only the camera and masks need, so that the map passes read little.
#[derive(Debug)]
pub struct MeshBuffers {
    /// Three f32 a vertex.
    pub positions: wgpu::Buffer,
    /// Normal, albedo, texture coordinates and mask of each vertex.
    pub surfaces: wgpu::Buffer,
    /// Three u32 a triangle.
    pub indices: wgpu::Buffer,
    /// Alpha masks, as mask.wesl reads them.
    pub masks: wgpu::Buffer,
    /// Number of triangles.
    pub triangles: u32,
    /// The first alpha-tested triangle; all behind it are.
    pub first_masked: u32,
    /// Meshes in the order of their triangles.
    pub meshes: Vec<Extent>,
}

/// What else a vertex has.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Surface {
    normal: Vec3,
    albedo: Vec3,
    texcoord: Vec2,
    /// One more than the place of its mask's words; 0 without a mask.
    mask: u32,
}

/// The layout of `positions`.
pub const POSITION_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vec3>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
};

/// The layout of `surfaces`.
pub const SURFACE_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Surface>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        1 => Float32x3, 2 => Float32x3, 3 => Float32x2, 4 => Uint32
    ],
};

impl MeshBuffers {
    /// Uploads the triangles of a frame.
    pub fn new(device: &Device, frame: &Frame) -> Result<Self, GpuError> {
        let positions: Vec<Vec3> = frame.vertices.iter().map(|v| v.position).collect();
        let mut words = Vec::new();
        let mut masks = vec![0; frame.vertices.len()];
        for (triangles, mask) in &frame.masks {
            for corner in frame.triangles[triangles.start as usize..triangles.end as usize].iter() {
                for &vertex in corner {
                    if let Some(mask) = masks.get_mut(vertex as usize) {
                        *mask = words.len() as u32 + 1;
                    }
                }
            }
            words.extend([mask.width, mask.height, mask.cutoff.to_bits()]);
            let word = |bytes: &[u8]| {
                let byte = |i: usize| bytes.get(i).copied().unwrap_or(0);
                u32::from_le_bytes(std::array::from_fn(byte))
            };
            words.extend(mask.alpha.chunks(4).map(word));
        }
        let surface = |(v, &mask): (&crate::render::Vertex, &u32)| Surface {
            normal: v.normal,
            albedo: v.albedo,
            texcoord: v.texcoord,
            mask,
        };
        let surfaces: Vec<Surface> = frame.vertices.iter().zip(&masks).map(surface).collect();
        let geometry = Usage::VERTEX | Usage::STORAGE;
        let upload = |label, bytes: &[u8], usage| device.upload(label, bytes, usage);
        let indices = bytemuck::cast_slice(frame.triangles.as_flattened());
        Ok(Self {
            positions: upload("vertex position bytes", bytemuck::cast_slice(&positions), geometry)?,
            surfaces: upload("vertex surface bytes", bytemuck::cast_slice(&surfaces), geometry)?,
            indices: upload("index bytes", indices, Usage::INDEX | Usage::STORAGE)?,
            masks: upload("alpha mask bytes", bytemuck::cast_slice(&words), Usage::STORAGE)?,
            triangles: frame.triangles.len() as u32,
            first_masked: frame.first_masked(),
            meshes: frame.extents(),
        })
    }

    /// Draws a range of triangles with positions and surfaces.
    pub fn draw_range(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        triangles: Range<u32>,
        instance: u32,
    ) {
        pass.set_vertex_buffer(0, self.positions.slice(..));
        pass.set_vertex_buffer(1, self.surfaces.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(triangles.start * 3..triangles.end * 3, 0, instance..instance + 1);
    }

    /// The triangles of meshes that a light may see, adjacent ranges joined: in one hemisphere, or
    /// for `None` between the clipping spheres alone.
    pub fn seen(&self, light: &DpsmLight<f32>, hemisphere: Option<u32>) -> Vec<Range<u32>> {
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for mesh in self.meshes.iter().filter(|mesh| mesh.is_seen(light, hemisphere)) {
            match ranges.last_mut() {
                Some(last) if last.end == mesh.triangles.start => last.end = mesh.triangles.end,
                _ => ranges.push(mesh.triangles.clone()),
            }
        }
        ranges
    }
}
