//! Opening an adapter: the best that there is, or a given one with less than it has.

use std::sync::mpsc::RecvTimeoutError;

use super::{Device, GpuError, steps, storage_bytes};

/// Largest chunk of an evaluation in bytes, WebGPU's default limit for a storage binding.
const CHUNK_BYTES: u64 = 128 << 20;

impl Device {
    /// Features that are used where an adapter has them: times and multiview. None is needed.
    pub const FEATURES: wgpu::Features =
        wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::MULTIVIEW);

    /// Opens the adapter that `WGPU_ADAPTER_NAME` (part of a name) and `WGPU_BACKEND` choose; a
    /// GPU before a software adapter where they are silent.
    pub fn open() -> Result<Self, GpuError> {
        let patience = steps::patience()?;
        let (sender, receiver) = std::sync::mpsc::channel();
        // a driver that hangs keeps the thread
        let thread = std::thread::spawn(move || drop(sender.send(Self::open_here())));
        receiver.recv_timeout(patience).unwrap_or_else(|error| {
            let hung = GpuError::Hung { step: "opening".into(), patience };
            match error {
                RecvTimeoutError::Timeout => Err(hung),
                RecvTimeoutError::Disconnected => match thread.join() {
                    Err(panic) => std::panic::resume_unwind(panic),
                    Ok(_) => Err(hung),
                },
            }
        })
    }

    fn open_here() -> Result<Self, GpuError> {
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
        Self::with_features(adapter, Self::FEATURES, limits)
    }

    /// Opens a device with those of the features that the adapter has.
    pub fn with_features(
        adapter: &wgpu::Adapter,
        features: wgpu::Features,
        limits: wgpu::Limits,
    ) -> Result<Self, GpuError> {
        let patience = steps::patience()?;
        let info = adapter.get_info();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("dpsm"),
            required_features: adapter.features() & features,
            required_limits: limits,
            ..Default::default()
        };
        let opened = steps::caught(|| pollster::block_on(adapter.request_device(&descriptor)));
        let (device, queue) =
            opened
                .and_then(|opened| opened.map_err(|error| error.to_string()))
                .map_err(|message| GpuError::NoDevice { adapter: info.name.clone(), message })?;
        let limits = device.limits();
        let chunk_bytes = CHUNK_BYTES.min(storage_bytes(&limits));
        let reports = steps::Reports::of(&device);
        Ok(Self { device, queue, info, chunk_bytes, patience, reports })
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
