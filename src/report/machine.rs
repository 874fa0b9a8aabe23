//! What computes a report.

use std::collections::BTreeMap;

use super::data::Machine;
use crate::gpu::Device;

/// The version of wgpu that is built in, as Cargo.lock has it.
pub const WGPU: &str = "30.0.1";

/// The version of naga that is built in.
pub const NAGA: &str = "30.0.1";

/// The adapter, or for `None` the ports, on this computer.
pub fn machine(device: Option<&Device>) -> Machine {
    let versions = [("dpsm", env!("CARGO_PKG_VERSION")), ("wgpu", WGPU), ("naga", NAGA)];
    let named = |(name, version): (&str, &str)| (name.to_string(), version.to_string());
    let common = Machine {
        computed_by: "the scalar ports on the processor, no adapter".into(),
        software: true,
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        versions: BTreeMap::from(versions.map(named)),
        ..Machine::default()
    };
    let Some(device) = device else { return common };
    let wgpu::AdapterInfo { name, driver, driver_info, backend, device_type, .. } = &device.info;
    Machine {
        computed_by: device.describe(),
        adapter: name.clone(),
        driver: format!("{driver} {driver_info}").trim().into(),
        backend: backend.to_string(),
        software: *device_type == wgpu::DeviceType::Cpu,
        ..common
    }
}
