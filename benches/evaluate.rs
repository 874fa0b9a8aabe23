//! Evaluator throughput as a share of a plain copy kernel over the same bytes, and the time to
//! link and validate. Run: `cargo bench --bench evaluate`.

use std::time::{Duration, Instant};

use dpsm::gpu::{Device, Evaluator, GpuError};
use wgpu::BufferUsages as Usage;

/// Words moved (read and written) by each kernel.
const WORDS: usize = 24 << 20;

/// Timed runs of each kernel, after one that is thrown away; kernels take turns.
const RUNS: usize = 15;

/// Copies four words an invocation, the quickest plain copy found; a grid in two dimensions, as one is limited to 65535 groups.
const COPY: &str = "
@group(0) @binding(0) var<storage, read> from_words: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> to_words: array<vec4<u32>>;

@compute @workgroup_size(64)
fn copy(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let at = id.y * groups.x * 64u + id.x;
    if at < arrayLength(&from_words) {
        to_words[at] = from_words[at];
    }
}";

fn main() {
    link_and_validate();
    let device = match Device::open() {
        Ok(device) => device,
        Err(error) => return println!("no throughput: {error}"),
    };
    println!("adapter: {}", device.describe());
    println!(
        "{RUNS} runs, interleaved, median [quartiles] in ms; {WORDS} words moved by each kernel"
    );
    if let Err(error) = throughputs(&device) {
        println!("{error}");
    }
}

/// What the harness costs by itself: as many words as dpsm_project, and nothing computed.
const NOTHING: &str = "fn nothing(p: vec3<f32>) -> vec2<f32> { return p.xy; }";

fn throughputs(device: &Device) -> Result<(), GpuError> {
    let nothing = dpsm::link_source("nothing.wgsl", NOTHING)?;
    throughput(device, &Evaluator::of(device, &nothing, "nothing")?)?;
    for (_, function) in dpsm::scalar::ports::PORTS {
        throughput(device, &Evaluator::new(device, function)?)?;
    }
    Ok(())
}

fn throughput(device: &Device, evaluator: &Evaluator<'_>) -> Result<(), GpuError> {
    let function = evaluator.signature.name.as_str();
    let (taken, given) = (evaluator.signature.inputs().len(), evaluator.signature.outputs().len());
    let records = WORDS / (taken + given);
    let bytes = |words: usize| (words * 4) as u64;
    let input = device.buffer("input", bytes(records * taken), Usage::STORAGE | Usage::COPY_DST)?;
    let output = device.buffer("output", bytes(records * given), Usage::STORAGE)?;
    // values around 1, so that no path is short
    let words: Vec<u32> =
        (0..records * taken).map(|i| (0.5 + (i % 977) as f32).to_bits()).collect();
    device.step("input", || device.queue.write_buffer(&input, 0, bytemuck::cast_slice(&words)))?;
    let copy = Copy::new(device, records * (taken + given) / 2)?;
    let evaluate = |encoder: &mut wgpu::CommandEncoder, stamps: dpsm::gpu::Stamps<'_>| {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: dpsm::gpu::compute_writes(stamps, dpsm::gpu::ALONE),
        });
        evaluator.record(&mut pass, &input, &output, records, None);
    };
    let (mut evaluations, mut copies) = (Vec::new(), Vec::new());
    for run in 0..=RUNS {
        let evaluation = device.time(function, evaluate)?;
        let copied = device.time("copy", |encoder, stamps| copy.record(encoder, stamps))?;
        if run > 0 {
            evaluations.extend(evaluation);
            copies.extend(copied);
        }
    }
    let (evaluation, copied) = (quartiles(&mut evaluations), quartiles(&mut copies));
    println!(
        "{function:<24}{} evaluation  {} copy  share of the copy's throughput {:.2}",
        show(evaluation),
        show(copied),
        copied[1].as_secs_f64() / evaluation[1].as_secs_f64(),
    );
    Ok(())
}

struct Copy {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    groups: [u32; 2],
}

impl Copy {
    fn new(device: &Device, words: usize) -> Result<Self, GpuError> {
        let bytes = (words * 4) as u64;
        let from = device.buffer("from", bytes, Usage::STORAGE)?;
        let to = device.buffer("to", bytes, Usage::STORAGE)?;
        let source = wgpu::ShaderSource::Wgsl(COPY.into());
        device.step("copy", || {
            let module = device
                .device
                .create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
            let pipeline =
                device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: None,
                    layout: None,
                    module: &module,
                    entry_point: Some("copy"),
                    compilation_options: Default::default(),
                    cache: None,
                });
            let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: from.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: to.as_entire_binding() },
                ],
            });
            let needed = (words as u32 / 4).div_ceil(64);
            let rows = needed.div_ceil(65535);
            Self { pipeline, group, groups: [needed.div_ceil(rows), rows] }
        })
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, stamps: dpsm::gpu::Stamps<'_>) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: dpsm::gpu::compute_writes(stamps, dpsm::gpu::ALONE),
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(self.groups[0], self.groups[1], 1);
    }
}

fn link_and_validate() {
    let names: Vec<&str> = dpsm::MODULES.iter().map(|module| module.name).collect();
    let mut times: Vec<Duration> = (0..=RUNS)
        .map(|_| {
            let start = Instant::now();
            let linked = dpsm::link(&names).expect("the modules link");
            dpsm::validate(&linked).expect("the modules are valid");
            start.elapsed()
        })
        .skip(1)
        .collect();
    println!("link and validate all {} modules: {} ms", names.len(), show(quartiles(&mut times)));
}

fn quartiles(times: &mut [Duration]) -> [Duration; 3] {
    times.sort();
    [1, 2, 3].map(|quarter| times.get(times.len() * quarter / 4).copied().unwrap_or_default())
}

fn show([low, median, high]: [Duration; 3]) -> String {
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    format!("{:8.3} [{:.3}, {:.3}]", ms(median), ms(low), ms(high))
}
