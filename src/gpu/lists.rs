//! Lists of triangles that a compute pass sorts: by class for the hybrid and exact methods, by face
//! for the cube.

use wgpu::BufferUsages as Usage;

use super::mesh::MeshBuffers;
use super::passes::{bind, shader, storage, uniform_entry};
use super::timer::{Ends, Stamps, compute_writes};
use super::{Device, GpuError, storage_bytes};

/// Indirect draws of the sorted classes, each list's front before its back.
pub const FLAT: u64 = 0;
pub const STRADDLING: u64 = 2;
pub const CURVED: u64 = 3;
pub const MASKED: u64 = 5;
pub const STEEP: u64 = 7;
const DRAWS: u64 = 9;

/// Bytes of one draw's arguments, the unused ones included.
pub const DRAW_BYTES: u64 = 32;

/// Room for parts beyond one a triangle, in each map, where the adapter has it: with less, large
/// triangles are drawn by hulls around the whole map.
const EXTRA: u64 = 1 << 17;

/// Bytes of a listed triangle's indices, of a part's entry, and of what is prepared of it
/// (seven vec4).
const INDEX_BYTES: u64 = 12;
const ENTRY_BYTES: u64 = 8;
const RECORD_BYTES: u64 = 112;

/// Bytes of a steep triangle's plane and number.
const PLANE_BYTES: u64 = 32;

/// Words of the counts in classify.wesl; those in faces.wesl are fewer.
const COUNTS: u64 = 13;

/// Triangles of a workgroup in classify.wesl and faces.wesl.
const GROUP: u32 = 64;

/// Most triangles that are sorted at once: 2^21 / 64 workgroups are half of WebGPU's limit.
const LARGEST_CHUNK: u64 = 1 << 21;

/// What sorts and by what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    Class,
    Face,
}

/// Lists with room for a chunk of triangles.
#[derive(Debug)]
pub struct Lists {
    pub indices: wgpu::Buffer,
    pub entries: wgpu::Buffer,
    pub records: wgpu::Buffer,
    pub planes: wgpu::Buffer,
    pub draws: wgpu::Buffer,
    dispatch: wgpu::Buffer,
    counts: wgpu::Buffer,
}

impl Lists {
    /// Triangles in a chunk, by the adapter's limit on what a shader may bind.
    pub fn chunk(device: &Device, triangles: u32) -> u32 {
        let limit = storage_bytes(&device.device.limits());
        let fits = (limit / (2 * RECORD_BYTES)).saturating_sub(Self::extra(device).into());
        triangles.clamp(1, fits.clamp(1, LARGEST_CHUNK) as u32)
    }

    /// Room for parts beyond one a triangle, in each map: at most half of what can be bound.
    pub fn extra(device: &Device) -> u32 {
        let limit = storage_bytes(&device.device.limits());
        (limit / (4 * RECORD_BYTES)).min(EXTRA) as u32
    }

    /// Lists for chunks of `capacity` triangles; with none of them sorted, as small as can be
    /// bound.
    pub fn new(device: &Device, by: Option<By>, capacity: u32) -> Result<Self, GpuError> {
        let (capacity, extra) = (u64::from(capacity), u64::from(Self::extra(device)));
        let (indices, parts) = match by {
            Some(By::Class) => (capacity, capacity + extra),
            Some(By::Face) => (6 * capacity, 0),
            None => (0, 0),
        };
        let list = |label, bytes, usage| device.buffer(label, bytes, usage | Usage::STORAGE);
        let entries = (capacity * 4).min(parts * 4) + 2 * parts * ENTRY_BYTES;
        let draws = Usage::INDIRECT | Usage::COPY_SRC;
        Ok(Self {
            indices: list("list index bytes", indices * INDEX_BYTES, Usage::INDEX)?,
            entries: list("part list bytes", entries, Usage::empty())?,
            records: list("record bytes", 2 * parts * RECORD_BYTES, Usage::empty())?,
            planes: list("plane bytes", capacity.min(parts) * PLANE_BYTES, Usage::empty())?,
            draws: list("draw bytes", (DRAWS + 1) * DRAW_BYTES, draws)?,
            dispatch: device.buffer("dispatch bytes", 12, Usage::INDIRECT | Usage::COPY_DST)?,
            counts: list("count bytes", COUNTS * 4, Usage::COPY_DST)?,
        })
    }
}

/// The compute pipelines that fill lists.
#[derive(Debug)]
pub struct Sorter {
    by: By,
    pipelines: Vec<wgpu::ComputePipeline>,
    layout: wgpu::BindGroupLayout,
}

impl Sorter {
    pub fn new(device: &Device, by: By) -> Result<Self, GpuError> {
        let (path, text, entries): (_, _, &[&str]) = match by {
            By::Class => (
                "classify.wesl",
                concat!(
                    include_str!("classify.wesl"),
                    include_str!("pass.wesl"),
                    include_str!("position.wesl")
                ),
                &["classify", "count", "prepare", "finish"],
            ),
            By::Face => (
                "faces.wesl",
                concat!(
                    include_str!("faces.wesl"),
                    include_str!("pass.wesl"),
                    include_str!("position.wesl")
                ),
                &["sort_faces", "finish_faces"],
            ),
        };
        let module = shader(device, path, text)?;
        let writable = match by {
            By::Class => 3..9,
            By::Face => 3..6,
        };
        device.step("the sorting pipelines", || {
            let compute = wgpu::ShaderStages::COMPUTE;
            let mut bindings = vec![uniform_entry(compute)];
            bindings.extend((1..3).map(|i| storage(i, true, compute)));
            bindings.extend(writable.map(|i| storage(i, false, compute)));
            let layout = device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("sorting"),
                entries: &bindings,
            });
            let pipeline_layout =
                device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("sorting"),
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                });
            let pipeline = |&entry: &&str| {
                device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: Some(&pipeline_layout),
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    cache: None,
                })
            };
            Self { by, pipelines: entries.iter().map(pipeline).collect(), layout }
        })
    }

    /// Binds uniforms, a mesh's triangles and lists.
    pub fn group(
        &self,
        device: &Device,
        uniforms: wgpu::BindingResource<'_>,
        mesh: &MeshBuffers,
        lists: &Lists,
    ) -> wgpu::BindGroup {
        let positions = mesh.positions.as_entire_binding();
        let indices = mesh.indices.as_entire_binding();
        let [counts, flats, entries, draws, records, planes] = [
            &lists.counts,
            &lists.indices,
            &lists.entries,
            &lists.draws,
            &lists.records,
            &lists.planes,
        ]
        .map(|buffer| buffer.as_entire_binding());
        let mut resources = vec![uniforms, positions, indices, counts, flats];
        match self.by {
            By::Class => resources.extend([entries, draws, records, planes]),
            By::Face => resources.push(draws),
        }
        bind(device, &self.layout, resources)
    }

    /// Records the sorting of so many triangles.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (group, offset): (&wgpu::BindGroup, u32),
        triangles: u32,
        lists: &Lists,
        stamps: Stamps<'_>,
        ends: Ends,
    ) {
        encoder.clear_buffer(&lists.counts, 0, None);
        let begin = |encoder: &mut wgpu::CommandEncoder, ends| {
            let mut pass = encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("sorting"),
                    timestamp_writes: compute_writes(stamps, ends),
                })
                .forget_lifetime();
            pass.set_bind_group(0, group, &[offset]);
            pass
        };
        let one = |pass: &mut wgpu::ComputePass<'_>, pipeline: &wgpu::ComputePipeline, groups| {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(groups, 1, 1);
        };
        let alone = self.by == By::Face;
        let mut pass = begin(encoder, Ends { last: ends.last && alone, ..ends });
        one(&mut pass, &self.pipelines[0], triangles.div_ceil(GROUP));
        one(&mut pass, &self.pipelines[1], 1);
        drop(pass);
        if alone {
            return;
        }
        let dispatch = DRAWS * DRAW_BYTES;
        encoder.copy_buffer_to_buffer(&lists.draws, dispatch, &lists.dispatch, 0, 12);
        let mut pass = begin(encoder, Ends { first: false, ..ends });
        pass.set_pipeline(&self.pipelines[2]);
        pass.dispatch_workgroups_indirect(&lists.dispatch, 0);
        one(&mut pass, &self.pipelines[3], 1);
    }
}
