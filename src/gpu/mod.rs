//! The adapter: opening one, running work on it with errors caught, reading results back.

mod camera;
mod evaluate;
mod lists;
mod maps;
mod mesh;
mod multiview;
mod passes;
mod texels;
mod timer;

pub use camera::{comparison_sampler, make_maps, render};
pub use evaluate::{Evaluation, Evaluator, Resources, entry_point};
pub use maps::{Parts, ShadowMaps};
pub use mesh::MeshBuffers;
pub use texels::Texels;
pub use timer::{ALONE, Ends, Stamps, compute_writes, render_writes};

use std::time::Duration;

use crate::link::LinkError;
use crate::validate::ValidateError;

/// Longest wait for one submission; a pass that takes longer is taken for hung.
const PATIENCE: Duration = Duration::from_secs(120);

/// Largest chunk of an evaluation in bytes, WebGPU's default limit for a storage binding.
const CHUNK_BYTES: u64 = 128 << 20;

/// What can go wrong on the way to an adapter's answer.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No adapter, or none of the name asked for.
    #[error(
        "no usable adapter{wanted}; found: {found}. Install a Vulkan driver (Debian: \
         `apt-get install mesa-vulkan-drivers`), change WGPU_ADAPTER_NAME or WGPU_BACKEND, or use \
         `--adapter cpu`"
    )]
    NoAdapter {
        /// ` whose name contains ...`, or nothing.
        wanted: String,
        /// The adapters there are.
        found: String,
    },
    /// The adapter refused to open a device.
    #[error("adapter `{adapter}` gives no device: {message}")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// wgpu's message.
        message: String,
    },
    /// wgpu rejected a step.
    #[error("the adapter rejected {step}: {message}")]
    Rejected {
        /// What was being done.
        step: String,
        /// wgpu's message.
        message: String,
    },
    /// The adapter's memory is used up.
    #[error("out of memory on the adapter in {step}; use a smaller size")]
    OutOfMemory {
        /// What was being done.
        step: String,
    },
    /// The device was lost, or did not answer in time.
    #[error("the adapter did not finish {step}: {message}")]
    Lost {
        /// What was being done.
        step: String,
        /// wgpu's message.
        message: String,
    },
    /// A size above a limit.
    #[error("{what} {asked} is outside this adapter's range 1 to {limit}; choose one inside it")]
    Limit {
        /// What was asked for.
        what: &'static str,
        /// The value.
        asked: u64,
        /// The largest allowed.
        limit: u64,
    },
    /// Multiview on an adapter that does not have it, or not as it should be.
    #[error(
        "no multiview on adapter `{adapter}`: {reason}; choose --passes atlas or --passes single"
    )]
    Multiview {
        /// The adapter's name.
        adapter: String,
        /// What is missing or wrong.
        reason: String,
    },
    /// A type that the evaluator cannot move.
    #[error("`{function}` cannot be evaluated: {reason}")]
    Unsupported {
        /// The function.
        function: String,
        /// The part that is not supported.
        reason: String,
    },
    /// Input records of the wrong size.
    #[error("`{function}` takes {expected} words a record ({signature}), not {given}")]
    Record {
        /// The function.
        function: String,
        /// Words it takes.
        expected: usize,
        /// Their names.
        signature: String,
        /// What was given, in words or bytes.
        given: String,
    },
    /// Linking failed.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The frame asks for too much.
    #[error(transparent)]
    Frame(#[from] crate::render::FrameError),
    /// naga rejected the linked text.
    #[error(transparent)]
    Validate(#[from] ValidateError),
}

/// An open adapter.
#[derive(Debug)]
pub struct Device {
    /// wgpu's device.
    pub device: wgpu::Device,
    /// wgpu's queue.
    pub queue: wgpu::Queue,
    /// Name, driver and back-end.
    pub info: wgpu::AdapterInfo,
    /// Largest chunk in bytes that an evaluation sends at once.
    pub chunk_bytes: u64,
}

impl Device {
    /// Opens the adapter that `WGPU_ADAPTER_NAME` (part of a name) and `WGPU_BACKEND` choose; a
    /// GPU before a software adapter where they are silent.
    pub fn open() -> Result<Self, GpuError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        let named = std::env::var("WGPU_BACKEND").unwrap_or_default();
        descriptor.backends = match named.trim() {
            "" => wgpu::Backends::PRIMARY,
            named => wgpu::Backends::from_comma_list(named),
        };
        let backends = descriptor.backends;
        let instance = wgpu::Instance::new(descriptor);
        let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
        adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
        let names: Vec<_> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        let wanted = std::env::var("WGPU_ADAPTER_NAME").unwrap_or_default();
        let fits = |adapter: &wgpu::Adapter| {
            let name = adapter.get_info().name.to_lowercase();
            name.contains(&wanted.to_lowercase())
        };
        let Some(adapter) = adapters.into_iter().find(fits) else {
            let found = if names.is_empty() { "none".into() } else { names.join(", ") };
            let mut wanted = match wanted.as_str() {
                "" => String::new(),
                name => format!(" whose name contains `{name}`"),
            };
            if !named.trim().is_empty() {
                wanted.push_str(&format!(" of the back-end WGPU_BACKEND={named}"));
            }
            return Err(GpuError::NoAdapter { wanted, found });
        };
        Self::of(&adapter)
    }

    /// Opens a device on a given adapter, with the adapter's own limits.
    pub fn of(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        Self::with_limits(adapter, adapter.limits())
    }

    /// Opens a device on a given adapter, with limits that it has or lower ones.
    pub fn with_limits(adapter: &wgpu::Adapter, limits: wgpu::Limits) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let useful = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::MULTIVIEW;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("dpsm"),
            required_features: adapter.features() & useful,
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
                GpuError::NoDevice { adapter: info.name.clone(), message: error.to_string() }
            })?;
        let limits = device.limits();
        let chunk_bytes =
            CHUNK_BYTES.min(limits.max_storage_buffer_binding_size).min(limits.max_buffer_size);
        Ok(Self { device, queue, info, chunk_bytes })
    }

    /// One line that names the adapter, its driver and back-end.
    pub fn describe(&self) -> String {
        let wgpu::AdapterInfo { name, backend, driver, driver_info, device_type, .. } = &self.info;
        let software = match device_type {
            wgpu::DeviceType::Cpu => ", a software adapter",
            _ => "",
        };
        format!("{name} ({backend}, {driver} {driver_info}{software})")
    }

    /// Runs one step with wgpu's errors caught.
    pub fn step<R>(&self, step: &str, work: impl FnOnce() -> R) -> Result<R, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = work();
        let errors = [validation.pop(), internal.pop()].map(pollster::block_on);
        let out_of_memory = pollster::block_on(memory.pop());
        if out_of_memory.is_some() {
            return Err(GpuError::OutOfMemory { step: step.into() });
        }
        match errors.into_iter().flatten().next() {
            Some(error) => {
                Err(GpuError::Rejected { step: step.into(), message: error.to_string() })
            }
            None => Ok(result),
        }
    }

    /// Submits one encoder's commands and waits for them.
    pub fn submit(&self, step: &str, encoder: wgpu::CommandEncoder) -> Result<(), GpuError> {
        let index = self.step(step, || self.queue.submit([encoder.finish()]))?;
        self.wait(step, index)
    }

    fn wait(&self, step: &str, index: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        let lost = |message| GpuError::Lost { step: step.into(), message };
        let wait = wgpu::PollType::Wait { submission_index: Some(index), timeout: Some(PATIENCE) };
        self.device.poll(wait).map_err(|error| lost(error.to_string()))?;
        Ok(())
    }

    /// Reads a mappable buffer's first `bytes` bytes.
    pub fn read(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u8>, GpuError> {
        let step = "reading back";
        let lost = |message: String| GpuError::Lost { step: step.into(), message };
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let (sender, receiver) = std::sync::mpsc::channel();
        self.step(step, || {
            buffer.map_async(wgpu::MapMode::Read, ..bytes, move |result| {
                let _ = sender.send(result); // the receiver outlives the poll below
            });
        })?;
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        self.device.poll(wait).map_err(|error| lost(error.to_string()))?;
        let mapped = receiver.recv().map_err(|error| lost(error.to_string()))?;
        mapped.map_err(|error| lost(error.to_string()))?;
        let range = buffer.get_mapped_range(..bytes).map_err(|error| lost(error.to_string()))?;
        let data = range.to_vec();
        drop(range);
        buffer.unmap();
        Ok(data)
    }

    /// A buffer of `bytes` bytes, checked against the adapter's limits.
    pub fn buffer(
        &self,
        label: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let size = bytes.max(16).next_multiple_of(4);
        let limit = self.device.limits().max_buffer_size;
        if size > limit {
            return Err(GpuError::Limit { what: label, asked: size, limit });
        }
        let descriptor =
            wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        self.step(label, || self.device.create_buffer(&descriptor))
    }

    /// A buffer that holds these bytes.
    pub fn upload(
        &self,
        label: &'static str,
        bytes: &[u8],
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        let buffer = self.buffer(label, bytes.len() as u64, usage)?;
        self.step(label, || self.queue.write_buffer(&buffer, 0, bytes))?;
        Ok(buffer)
    }
}

/// GPUs before software adapters.
fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}
