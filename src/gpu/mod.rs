//! The adapter: opening one, running work on it with errors caught, reading results back.

mod camera;
mod evaluate;
mod lists;
mod lookup;
mod maps;
mod mesh;
mod multiview;
mod open;
mod passes;
mod steps;
mod texels;
mod timer;

pub use camera::{comparison_sampler, make_maps, point_sampler, render};
pub use evaluate::{Evaluation, Evaluator, Resources, entry_point};
pub use lookup::{PointTest, PointTests};
pub use maps::{Parts, ShadowMaps};
pub use mesh::MeshBuffers;
pub use texels::Texels;
pub use timer::{ALONE, Ends, Stamps, Timed, compute_writes, quartiles, render_writes};

use std::sync::Arc;
use std::time::Duration;

use crate::link::LinkError;
use crate::validate::ValidateError;

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
    #[error(
        "adapter `{adapter}` gives no device: {message}; choose another with WGPU_ADAPTER_NAME, or \
         use `--adapter cpu`"
    )]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// wgpu's message.
        message: String,
    },
    /// wgpu rejected a step.
    #[error(
        "the adapter rejected {step}; choose another with WGPU_ADAPTER_NAME, or use `--adapter \
         cpu`: {message}"
    )]
    Rejected {
        /// What was being done.
        step: String,
        /// wgpu's message.
        message: String,
    },
    /// The adapter's memory is used up.
    #[error("out of memory on the adapter in {step}; use a smaller size, or `--adapter cpu`")]
    OutOfMemory {
        /// What was being done.
        step: String,
    },
    /// The device was lost.
    #[error(
        "the adapter was lost in {step}: {message}; try again, with a smaller size if it is lost \
         again, or use `--adapter cpu`"
    )]
    Lost {
        /// What was being done.
        step: String,
        /// wgpu's message.
        message: String,
    },
    /// A step that took longer than the device's patience.
    #[error(
        "the adapter did not finish {step} within {} s: it hangs, or needs longer; set \
         DPSM_PATIENCE to more seconds, use a smaller size, or `--adapter cpu`",
        .patience.as_secs_f64()
    )]
    Hung {
        /// What was being done.
        step: String,
        /// How long it was waited for.
        patience: Duration,
    },
    /// `DPSM_PATIENCE` is no time.
    #[error("DPSM_PATIENCE=`{0}` is no number of seconds above 0, as in DPSM_PATIENCE=600")]
    Patience(String),
    /// A size above a limit.
    #[error(
        "{what} {asked} is outside this adapter's range 1 to {limit}; {}",
        if .what.ends_with("bytes") {
            "use a smaller scene or size, or `--adapter cpu`"
        } else {
            "choose one inside it"
        }
    )]
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
    /// Longest wait for one step, from `DPSM_PATIENCE` in seconds.
    pub patience: Duration,
    reports: Arc<steps::Reports>,
}

impl Device {
    /// One line that names the adapter, its driver and back-end.
    pub fn describe(&self) -> String {
        let wgpu::AdapterInfo { name, backend, driver, driver_info, device_type, .. } = &self.info;
        let software = match device_type {
            wgpu::DeviceType::Cpu => ", a software adapter",
            _ => "",
        };
        format!("{name} ({backend}, {driver} {driver_info}{software})")
    }

    /// A buffer of `bytes` bytes, checked against the adapter's limits.
    pub fn buffer(
        &self,
        label: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let size = bytes.max(16).next_multiple_of(4);
        let limits = self.device.limits();
        // a shader is given the whole of it
        let limit = match usage.contains(wgpu::BufferUsages::STORAGE) {
            true => storage_bytes(&limits),
            false => limits.max_buffer_size,
        };
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

/// Bytes of the largest buffer that a shader can be given whole.
fn storage_bytes(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}
