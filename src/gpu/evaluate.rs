//! Runs any WGSL function over arrays: the compute entry point, its bindings and the packing of
//! arguments and results are generated from naga's reflection of the function.
//!
//! A record is the function's arguments as 32-bit words without padding, in order; so is a result
//! (bool as 0 or 1). Textures and samplers are bound once for all records.

use std::fmt::Write;

use bytemuck::Pod;

use super::{Device, GpuError};
use crate::link::{Linked, link_function};
use crate::reflect::{Component, Kind, Shape, Signature};
use crate::validate::validate;

/// Invocations of a workgroup, the most that every adapter allows.
const WORKGROUP: u32 = 256;

/// What the records' function reads besides them.
#[derive(Clone, Copy, Debug)]
pub struct Resources<'a> {
    /// Bound to every texture argument.
    pub texture: &'a wgpu::TextureView,
    /// Bound to every comparison sampler argument.
    pub sampler: &'a wgpu::Sampler,
    /// Bound to every other sampler argument: `point_sampler`.
    pub point: &'a wgpu::Sampler,
}

/// A function compiled for evaluation on one device.
#[derive(Debug)]
pub struct Evaluator<'a> {
    device: &'a Device,
    /// The function's signature.
    pub signature: Signature,
    /// The WGSL that runs: the linked function and the generated entry point.
    pub text: String,
    pipeline: wgpu::ComputePipeline,
}

/// Results and what they cost.
#[derive(Debug)]
pub struct Evaluation {
    /// Result words, record by record.
    pub words: Vec<u32>,
    /// Chunks that the records were split into.
    pub chunks: usize,
}

impl Device {
    /// Evaluates one of the library's functions on every input.
    ///
    /// `I` is one record: all arguments' components, 4 bytes each, no padding (`glam::Vec3` for
    /// `dpsm_project`); `O` one result.
    ///
    /// ```no_run
    /// # use glam::{Vec2, Vec3};
    /// let gpu = dpsm::gpu::Device::open()?;
    /// let uv: Vec<Vec2> = gpu.evaluate("dpsm_project", &[Vec3::new(3.0, 4.0, 0.0)])?;
    /// # Ok::<(), dpsm::gpu::GpuError>(())
    /// ```
    pub fn evaluate<I: Pod, O: Pod>(
        &self,
        function: &str,
        inputs: &[I],
    ) -> Result<Vec<O>, GpuError> {
        let evaluator = Evaluator::new(self, function)?;
        let expected = evaluator.signature.outputs().len() * 4;
        if size_of::<O>() != expected {
            return Err(GpuError::Unsupported {
                function: function.into(),
                reason: format!("a result has {expected} bytes, not {}", size_of::<O>()),
            });
        }
        if size_of::<I>() != evaluator.record_bytes() {
            return Err(evaluator.record_error(format!("{} bytes", size_of::<I>())));
        }
        let evaluation = evaluator.run(bytemuck::cast_slice(inputs), None)?;
        Ok(bytemuck::cast_slice(&evaluation.words).to_vec())
    }
}

impl<'a> Evaluator<'a> {
    /// Compiles one of the library's functions.
    pub fn new(device: &'a Device, function: &str) -> Result<Self, GpuError> {
        Self::of(device, &link_function(function)?, function)
    }

    /// Compiles a function of a linked text.
    pub fn of(device: &'a Device, linked: &Linked, function: &str) -> Result<Self, GpuError> {
        let validated = validate(linked)?;
        let signature = Signature::of(&validated.module, function)
            .map_err(|reason| GpuError::Unsupported { function: function.into(), reason })?;
        let text = format!("{}\n{}", linked.text, entry_point(&signature));
        let source = wgpu::ShaderSource::Wgsl(text.as_str().into());
        let pipeline = device.step(function, || {
            let module = device.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(function),
                source,
            });
            device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(function),
                layout: None,
                module: &module,
                entry_point: Some("evaluate"),
                compilation_options: Default::default(),
                cache: None,
            })
        })?;
        Ok(Self { device, signature, text, pipeline })
    }

    /// Bytes of one input record.
    pub fn record_bytes(&self) -> usize {
        self.signature.inputs().len() * 4
    }

    /// Evaluates records given as flat words, in chunks that fit the adapter.
    pub fn run(
        &self,
        words: &[u32],
        resources: Option<Resources<'_>>,
    ) -> Result<Evaluation, GpuError> {
        let (taken, given) = (self.signature.inputs().len(), self.signature.outputs().len());
        if !words.len().is_multiple_of(taken) {
            return Err(self.record_error(format!("{} words in all", words.len())));
        }
        if self.signature.needs_resources() && resources.is_none() {
            return Err(GpuError::Unsupported {
                function: self.signature.name.clone(),
                reason: "it takes a texture, and none was given".into(),
            });
        }
        let chunk = (self.device.chunk_bytes / (4 * taken.max(given) as u64)).max(1) as usize;
        let mut evaluation = Evaluation { words: Vec::new(), chunks: 0 };
        for records in words.chunks(chunk * taken) {
            let results = self.run_chunk(records, records.len() / taken, given, resources)?;
            evaluation.words.extend_from_slice(bytemuck::cast_slice(&results));
            evaluation.chunks += 1;
        }
        Ok(evaluation)
    }

    fn run_chunk(
        &self,
        records: &[u32],
        count: usize,
        given: usize,
        resources: Option<Resources<'_>>,
    ) -> Result<Vec<u8>, GpuError> {
        use wgpu::BufferUsages as Usage;
        let name = self.signature.name.as_str();
        let bytes = (count * given * 4) as u64;
        let input = self.device.buffer(
            "evaluation input",
            size_of_val(records) as u64,
            Usage::STORAGE | Usage::COPY_DST,
        )?;
        let output =
            self.device.buffer("evaluation output", bytes, Usage::STORAGE | Usage::COPY_SRC)?;
        let back =
            self.device.buffer("evaluation result", bytes, Usage::MAP_READ | Usage::COPY_DST)?;
        let encoder = self.device.step(name, || {
            self.device.queue.write_buffer(&input, 0, bytemuck::cast_slice(records));
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.record(&mut pass, &input, &output, count, resources);
            drop(pass);
            encoder.copy_buffer_to_buffer(&output, 0, &back, 0, bytes);
            encoder
        })?;
        self.device.submit(name, encoder)?;
        self.device.read(&back, bytes)
    }

    /// Records the evaluation of `count` records from one storage buffer to another.
    pub fn record(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        input: &wgpu::Buffer,
        output: &wgpu::Buffer,
        count: usize,
        resources: Option<Resources<'_>>,
    ) {
        let words = |buffer, signature: usize| {
            let size = wgpu::BufferSize::new((count * signature * 4) as u64);
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
        };
        let (taken, given) = (self.signature.inputs().len(), self.signature.outputs().len());
        let mut entries = vec![
            wgpu::BindGroupEntry { binding: 0, resource: words(input, taken) },
            wgpu::BindGroupEntry { binding: 1, resource: words(output, given) },
        ];
        let bound = self.signature.arguments.iter().filter(|(_, shape)| shape.is_resource());
        for ((_, shape), binding) in bound.zip(2..) {
            let Some(resources) = resources else { continue };
            let resource = match shape {
                Shape::Sampler(ty) if ty == "sampler" => {
                    wgpu::BindingResource::Sampler(resources.point)
                }
                Shape::Sampler(_) => wgpu::BindingResource::Sampler(resources.sampler),
                _ => wgpu::BindingResource::TextureView(resources.texture),
            };
            entries.push(wgpu::BindGroupEntry { binding, resource });
        }
        let group = self.device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.signature.name),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        // two dimensions, as one is limited to 65535 workgroups on many adapters
        let groups = (count as u32).div_ceil(WORKGROUP);
        let rows =
            groups.div_ceil(self.device.device.limits().max_compute_workgroups_per_dimension);
        pass.dispatch_workgroups(groups.div_ceil(rows.max(1)), rows, 1);
    }

    fn record_error(&self, given: String) -> GpuError {
        let components = self.signature.inputs();
        let names = |c: &Component| format!("{}: {}", c.path, c.kind.wgsl());
        GpuError::Record {
            function: self.signature.name.clone(),
            expected: components.len(),
            signature: components.iter().map(names).collect::<Vec<_>>().join(", "),
            given,
        }
    }
}

/// The generated entry point: unpacks a record's words, calls the function, packs its result.
pub fn entry_point(signature: &Signature) -> String {
    let mut text = String::new();
    record_struct(&mut text, "EvaluationInput", &signature.inputs());
    record_struct(&mut text, "EvaluationOutput", &signature.outputs());
    text.push_str(
        "@group(0) @binding(0) var<storage, read> evaluation_input: array<EvaluationInput>;\n\
         @group(0) @binding(1) var<storage, read_write> evaluation_output: array<EvaluationOutput>;\n",
    );
    let mut arguments = Vec::new();
    let mut word = 0;
    let mut binding = 2;
    for (name, shape) in &signature.arguments {
        if let Shape::Texture(ty) | Shape::Sampler(ty) = shape {
            let variable = format!("evaluation_{name}");
            let _ = writeln!(text, "@group(0) @binding({binding}) var {variable}: {ty};");
            arguments.push(variable);
            binding += 1;
        } else {
            arguments.push(unpack(shape, &mut word));
        }
    }
    let pack = |component: &Component| match component.kind {
        Kind::Bool => format!("select(0u, 1u, result{})", component.path),
        _ => format!("result{}", component.path),
    };
    let _ = write!(
        text,
        "\n@compute @workgroup_size({WORKGROUP})\n\
         fn evaluate(\n\
         \x20   @builtin(global_invocation_id) id: vec3<u32>,\n\
         \x20   @builtin(num_workgroups) groups: vec3<u32>,\n\
         ) {{\n\
         \x20   let index = id.y * groups.x * {WORKGROUP}u + id.x;\n\
         \x20   if index >= arrayLength(&evaluation_input) {{ return; }}\n\
         \x20   let record = evaluation_input[index];\n\
         \x20   let result = {}({});\n\
         \x20   evaluation_output[index] = EvaluationOutput({});\n\
         }}\n",
        signature.name,
        arguments.join(", "),
        signature.outputs().iter().map(pack).collect::<Vec<_>>().join(", "),
    );
    text
}

/// A struct of a record's words: loaded and stored as a whole, its bounds are checked once.
fn record_struct(text: &mut String, name: &str, components: &[Component]) {
    let _ = writeln!(text, "struct {name} {{");
    for (word, component) in components.iter().enumerate() {
        let ty = match component.kind {
            Kind::Bool => Kind::Unsigned, // a bool cannot be stored
            kind => kind,
        };
        let _ = writeln!(text, "    word_{word}: {},", ty.wgsl());
    }
    text.push_str("}\n");
}

/// A WGSL expression that builds a value from the record's words, counting them.
fn unpack(shape: &Shape, word: &mut usize) -> String {
    match shape {
        Shape::Scalar(kind) => {
            let stored = format!("record.word_{word}");
            *word += 1;
            match kind {
                Kind::Bool => format!("({stored} != 0u)"),
                _ => stored,
            }
        }
        Shape::Composite(constructor, parts) => {
            let parts: Vec<_> = parts.iter().map(|(_, part)| unpack(part, word)).collect();
            format!("{constructor}({})", parts.join(", "))
        }
        Shape::Texture(_) | Shape::Sampler(_) => String::new(), // bound, never packed
    }
}
