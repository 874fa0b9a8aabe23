//! Lists of triangles that compute passes make: refined ones, parts for the exact method, and for
//! the cube what each face sees.

mod room;

pub use room::Room;

use wgpu::BufferUsages as Usage;

use super::mesh::MeshBuffers;
use super::passes::{bind, shader, storage, uniform_entry};
use super::timer::{Ends, Stamps, compute_writes};
use super::{Device, GpuError};

/// Indirect draws of the refined lists, each map's front before its back.
pub const FLAT: u64 = 0;
pub const PLANE: u64 = 2;
pub const MASKED: u64 = 4;
pub const WHOLE: u64 = 6;

/// Indirect draws of the exact lists.
pub const PARTS: u64 = 0;
pub const MASKED_PARTS: u64 = 2;

/// Draws, and behind them how many workgroups the exact lists' second kernel takes.
const DRAWS: u64 = 8;

/// Bytes of one draw's arguments, the unused ones included.
pub const DRAW_BYTES: u64 = 32;

/// Bytes of a listed triangle's indices, of a part's entry, and of what is prepared of it (seven
/// vec4); of a refined vertex, a triangle to be split, and one drawn with its plane.
const INDEX_BYTES: u64 = 12;
const ENTRY_BYTES: u64 = 8;
const PART_BYTES: u64 = 112;
const VERTEX_BYTES: u64 = 32;
const QUEUE_BYTES: u64 = 16;
const RECORD_BYTES: u64 = 96;

/// Words of the counts in refine.wesl; those in the other kernels are fewer.
const COUNTS: u64 = 40;

/// Invocations of a workgroup in the kernels.
const GROUP: u32 = 64;

/// Most workgroups in one direction.
const GROUPS: u32 = 65535;

/// What makes lists and of what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum By {
    /// Refined triangles.
    Refinement,
    /// Parts of exact ones.
    Part,
    /// What each face of a cube sees.
    Face,
}

/// Lists with room for a chunk of triangles.
#[derive(Debug)]
pub struct Lists {
    pub room: Room,
    pub indices: wgpu::Buffer,
    pub entries: wgpu::Buffer,
    pub records: wgpu::Buffer,
    pub vertices: wgpu::Buffer,
    pub draws: wgpu::Buffer,
    dispatch: wgpu::Buffer,
    counts: wgpu::Buffer,
}

impl Lists {
    /// Lists with that room; for `None` as small as can be bound.
    pub fn new(device: &Device, by: Option<By>, room: Room) -> Result<Self, GpuError> {
        let Room { triangles, extra, vertices, queue } = room;
        let [triangles, extra, vertices, queue] =
            [triangles, extra, vertices, queue].map(u64::from);
        let [indices, entries, records] = match by {
            Some(By::Refinement) => [triangles, 2 * queue * QUEUE_BYTES, 2 * extra * RECORD_BYTES],
            Some(By::Part) => {
                let parts = 2 * (triangles + extra);
                [0, parts * ENTRY_BYTES, parts * PART_BYTES]
            }
            Some(By::Face) => [6 * triangles, 0, 0],
            None => [0, 0, 0],
        };
        let list = |label, bytes, usage| device.buffer(label, bytes, usage | Usage::STORAGE);
        let draws = Usage::INDIRECT | Usage::COPY_SRC;
        let dispatch = Usage::INDIRECT | Usage::COPY_DST;
        Ok(Self {
            room,
            indices: list("list index bytes", indices * INDEX_BYTES, Usage::INDEX)?,
            entries: list("list entry bytes", entries, Usage::empty())?,
            records: list("record bytes", records, Usage::VERTEX)?,
            vertices: list("list vertex bytes", vertices * VERTEX_BYTES, Usage::VERTEX)?,
            draws: list("draw bytes", (DRAWS + 1) * DRAW_BYTES, draws)?,
            dispatch: list("dispatch bytes", 12, dispatch)?,
            counts: list("count bytes", COUNTS * 4, Usage::COPY_DST | Usage::COPY_SRC)?,
        })
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> u64 {
        let Self { indices, entries, records, vertices, .. } = self;
        [indices, entries, records, vertices].iter().map(|buffer| buffer.size()).sum()
    }

    /// What the last refinement needed, and whether that was more than there is room for; of one
    /// that ran out of room it may need more still.
    pub fn needed(&self, device: &Device, vertices: u32) -> Result<(Room, bool), GpuError> {
        let bytes = COUNTS * 4;
        let copy = device.buffer("count bytes", bytes, Usage::MAP_READ | Usage::COPY_DST)?;
        let encoder = device.encode("counts", |encoder| {
            encoder.copy_buffer_to_buffer(&self.counts, 0, &copy, 0, bytes);
        })?;
        device.submit("counts", encoder)?;
        let words = device.read(&copy, bytes)?;
        let words: &[u32] = bytemuck::cast_slice(&words);
        let [flat_front, flat_back, front, back, masked_front, masked_back, split, _] =
            std::array::from_fn(|k| words.get(k).copied().unwrap_or(0));
        let queues = words.get(8..).unwrap_or_default();
        let room = Room {
            triangles: flat_front.saturating_add(flat_back),
            extra: (front.saturating_add(masked_front)).max(back.saturating_add(masked_back)),
            vertices: vertices.saturating_add(split),
            queue: queues.iter().copied().max().unwrap_or(0),
        };
        let is_over = room.triangles > self.room.triangles
            || room.extra > self.room.extra
            || room.vertices > self.room.vertices
            || room.queue > self.room.queue;
        Ok((room, is_over))
    }
}

/// The compute pipelines that fill lists.
#[derive(Debug)]
pub struct Sorter {
    by: By,
    pipelines: Vec<wgpu::ComputePipeline>,
    layout: wgpu::BindGroupLayout,
    /// Of the kernel that says how many workgroups the next one takes.
    dispatch: wgpu::BindGroupLayout,
}

/// What a sorter binds.
#[derive(Debug)]
pub struct Bound {
    lists: wgpu::BindGroup,
    dispatch: wgpu::BindGroup,
}

/// What a sorter sorts: how many vertices and triangles, and into how many levels.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// Where the pass's uniforms are.
    pub offset: u32,
    pub vertices: u32,
    pub triangles: u32,
    pub levels: u32,
}

impl Sorter {
    pub fn new(device: &Device, by: By) -> Result<Self, GpuError> {
        let (path, text, entries): (_, _, &[&str]) = match by {
            By::Refinement => (
                "refine.wesl",
                concat!(
                    include_str!("refine.wesl"),
                    include_str!("pass.wesl"),
                    include_str!("position.wesl")
                ),
                &["place", "roots", "prepare", "level", "finish"],
            ),
            By::Part => (
                "parts.wesl",
                concat!(
                    include_str!("parts.wesl"),
                    include_str!("pass.wesl"),
                    include_str!("position.wesl")
                ),
                &["sort", "count", "prepare", "finish"],
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
            By::Refinement => 3..9,
            By::Part => 3..7,
            By::Face => 3..6,
        };
        device.step("the sorting pipelines", || {
            let compute = wgpu::ShaderStages::COMPUTE;
            let mut bindings = vec![uniform_entry(compute)];
            bindings.extend((1..3).map(|i| storage(i, true, compute)));
            bindings.extend(writable.map(|i| storage(i, false, compute)));
            let group = |entries: &[wgpu::BindGroupLayoutEntry]| {
                device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                    label: Some("sorting"),
                    entries,
                })
            };
            let layout = group(&bindings);
            let dispatch = group(&[storage(0, false, compute)]);
            let pipeline = |&entry: &&str| {
                let groups = [Some(&layout), Some(&dispatch)];
                // the dispatch's own arguments may be bound only where nothing is dispatched by them
                let count = if by.tells(entry) { 2 } else { 1 };
                let pipeline_layout =
                    device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                        label: Some("sorting"),
                        bind_group_layouts: &groups[..count],
                        immediate_size: 0,
                    });
                device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: Some(&pipeline_layout),
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    cache: None,
                })
            };
            Self { by, pipelines: entries.iter().map(pipeline).collect(), layout, dispatch }
        })
    }

    /// Binds uniforms, a mesh's triangles and lists.
    pub fn group(
        &self,
        device: &Device,
        uniforms: wgpu::BindingResource<'_>,
        mesh: &MeshBuffers,
        lists: &Lists,
    ) -> Bound {
        let positions = mesh.positions.as_entire_binding();
        let triangles = mesh.indices.as_entire_binding();
        let [counts, indices, entries, draws, records, vertices] = [
            &lists.counts,
            &lists.indices,
            &lists.entries,
            &lists.draws,
            &lists.records,
            &lists.vertices,
        ]
        .map(|buffer| buffer.as_entire_binding());
        let mut resources = vec![uniforms, positions, triangles, counts];
        match self.by {
            By::Refinement => resources.extend([vertices, entries, indices, records, draws]),
            By::Part => resources.extend([entries, draws, records]),
            By::Face => resources.extend([indices, draws]),
        }
        let dispatch = bind(device, &self.dispatch, vec![lists.dispatch.as_entire_binding()]);
        Bound { lists: bind(device, &self.layout, resources), dispatch }
    }

    /// Records the making of the lists.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: &Bound,
        work: Work,
        lists: &Lists,
        stamps: Stamps<'_>,
        ends: Ends,
    ) {
        encoder.clear_buffer(&lists.counts, 0, None);
        let mut pass = encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("sorting"),
                timestamp_writes: compute_writes(stamps, ends),
            })
            .forget_lifetime();
        pass.set_bind_group(0, &group.lists, &[work.offset]);
        let one = |pass: &mut wgpu::ComputePass<'_>, pipeline: usize, groups: u32| {
            pass.set_pipeline(&self.pipelines[pipeline]);
            // two directions where one has not enough
            let rows = groups.div_ceil(GROUPS).max(1);
            pass.dispatch_workgroups(groups.div_ceil(rows), rows, 1);
        };
        // a kernel that says how many workgroups the next one takes
        let told = |pass: &mut wgpu::ComputePass<'_>, pipeline: usize| {
            pass.set_pipeline(&self.pipelines[pipeline]);
            pass.set_bind_group(1, &group.dispatch, &[]);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&self.pipelines[pipeline + 1]);
            pass.dispatch_workgroups_indirect(&lists.dispatch, 0);
        };
        let groups = work.triangles.div_ceil(GROUP);
        match self.by {
            By::Refinement => {
                one(&mut pass, 0, work.vertices.div_ceil(GROUP));
                one(&mut pass, 1, groups);
                for _ in 0..work.levels {
                    told(&mut pass, 2);
                }
                one(&mut pass, 4, 1);
            }
            By::Part => {
                one(&mut pass, 0, groups);
                told(&mut pass, 1);
                one(&mut pass, 3, 1);
            }
            By::Face => {
                one(&mut pass, 0, groups);
                one(&mut pass, 1, 1);
            }
        }
    }
}

impl By {
    /// Whether a kernel says how many workgroups the next one takes.
    fn tells(self, entry: &str) -> bool {
        match self {
            By::Refinement => entry == "prepare",
            By::Part => entry == "count",
            By::Face => false,
        }
    }
}
