//! wgpu's adapters, with naga's translation: GPUs, lavapipe, SwiftShader.

use dpsm::gpu::{Device, Evaluator};

use super::Implementation;

/// Software drivers that this project knows how to get: part of the adapter's name, and how.
const SOFTWARE: [(&str, &str); 2] = [
    ("llvmpipe", "Debian: apt-get install mesa-vulkan-drivers"),
    ("SwiftShader", "Debian: apt-get install chromium; tools/accuracy shows it to the loader"),
];

/// One adapter.
pub struct Adapter {
    /// Lives as long as the process, so that evaluators can be kept beside it.
    device: &'static Device,
    /// The function compiled last.
    compiled: Option<Evaluator<'static>>,
}

/// Every adapter; prints a line for each software driver that is missing, or that gives no device.
pub fn all() -> Vec<Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(descriptor);
    let found = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let mut adapters = Vec::new();
    for adapter in found {
        match Device::of(&adapter) {
            Ok(device) => {
                let device = Box::leak(Box::new(device));
                adapters.push(Adapter { device, compiled: None });
            }
            Err(error) => println!("missing: {error}"),
        }
    }
    for (name, remedy) in SOFTWARE {
        if !adapters.iter().any(|adapter| adapter.device.info.name.contains(name)) {
            println!("missing: {name}, no such adapter ({remedy})");
        }
    }
    adapters
}

impl Implementation for Adapter {
    fn name(&self) -> String {
        self.device.describe()
    }

    fn evaluate(&mut self, function: &str, words: &[u32]) -> Result<Option<Vec<u32>>, String> {
        let evaluator = match self.compiled.take() {
            Some(compiled) if compiled.signature.name == function => compiled,
            _ => Evaluator::new(self.device, function).map_err(|error| error.to_string())?,
        };
        let evaluator = self.compiled.insert(evaluator);
        if evaluator.signature.needs_resources() {
            return Ok(None); // what a texture holds is no record
        }
        let evaluation = evaluator.run(words, None).map_err(|error| error.to_string())?;
        Ok(Some(evaluation.words))
    }
}
