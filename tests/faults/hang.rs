//! An adapter that does not answer, or not soon enough.

use std::time::{Duration, Instant};

use dpsm::gpu::{Device, GpuError};

use crate::support::{EVAL, RENDER, Writes, adapter, contents, run};

/// Longest time from a patience of a second to the program's end, on a busy machine.
const SOON: Duration = Duration::from_secs(30);

/// A shader that keeps lavapipe busy for long: 2^16 passes of its loop, the most that it makes, in
/// each of 2^16 workgroups. A GPU may be done sooner.
const SLOW: &str = "
@group(0) @binding(0) var<storage, read_write> words: array<u32>;
@compute @workgroup_size(64)
fn slow(@builtin(global_invocation_id) id: vec3<u32>) {
    var x = id.x;
    for (var i = 0u; i < 65536u; i++) {
        x = x * 1664525u + 1013904223u + words[x % 64u];
    }
    words[id.x % 64u] = x;
}
";

/// Submits SLOW.
fn slow(device: &Device) -> Result<(), GpuError> {
    let words = device.buffer("words", 256, wgpu::BufferUsages::STORAGE)?;
    let encoder = device.encode("a slow shader", |encoder| {
        let (label, source) = (None, wgpu::ShaderSource::Wgsl(SLOW.into()));
        let descriptor = wgpu::ShaderModuleDescriptor { label, source };
        let module = device.device.create_shader_module(descriptor);
        let descriptor = wgpu::ComputePipelineDescriptor {
            label,
            layout: None,
            module: &module,
            entry_point: Some("slow"),
            compilation_options: Default::default(),
            cache: None,
        };
        let pipeline = device.device.create_compute_pipeline(&descriptor);
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: words.as_entire_binding() }],
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(65535, 1, 1);
    })?;
    device.submit("a slow shader", encoder)
}

#[test]
fn slow_shader_is_given_up_by_the_library_and_the_process_ends() {
    let Some((mut device, _alone)) = adapter() else { return };
    if !device.info.name.contains("llvmpipe") {
        return println!("skipped: on {} the shader may be too fast", device.info.name);
    }
    // in a process of its own, as the adapter goes on working after the test
    const INNER: &str = "DPSM_TEST_INNER";
    if std::env::var_os(INNER).is_none() {
        let mut test = std::process::Command::new(std::env::current_exe().unwrap());
        let name = "hang::slow_shader_is_given_up_by_the_library_and_the_process_ends";
        let run = run(test.args(["--exact", name, "--nocapture"]).env(INNER, "1"));
        // how a process ends in order while lavapipe works is lavapipe's affair: not judged
        assert!(run.stdout.contains("given up"), "{run:?}");
        assert!(run.took < SOON, "{run:?}");
        return;
    }
    device.patience = Duration::from_millis(500);
    let start = Instant::now();
    match slow(&device) {
        Err(GpuError::Hung { step, patience }) => {
            assert_eq!((step.as_str(), patience), ("a slow shader", device.patience));
        }
        other => panic!("{other:?}"),
    }
    // and whatever is asked of it next fails at once
    assert!(matches!(device.step("more", || ()), Err(GpuError::Lost { .. })));
    drop(device);
    assert!(start.elapsed() < SOON, "dropping it waited");
    println!("given up");
}

#[test]
fn patience_is_the_users_and_a_picture_that_needs_longer_is_not_written() {
    let Some((device, _alone)) = adapter() else { return };
    if !device.info.name.contains("llvmpipe") {
        return println!("skipped: {} may be fast enough", device.info.name);
    }
    let arguments = &[
        "render",
        "cornell",
        "--filter",
        "pcss",
        "--taps",
        "1024",
        "--light-size",
        "0.3",
        "--image",
        "4000x4000",
        "-o",
        "room.png",
    ];
    let render = Writes { name: "slow", arguments, files: &["room.png"] };
    let folder = render.folder("patience");
    let before = contents(&folder);
    let run = render.run(&folder, "gpu", "", &[("DPSM_PATIENCE", "0.5")]);
    run.failed("slow", 1, "set DPSM_PATIENCE to more seconds");
    assert!(run.stderr.contains("the adapter did not finish camera within 0.5 s"), "{run:?}");
    assert!(run.took < SOON, "{run:?}");
    assert_eq!(contents(&folder), before);
}

#[cfg(target_os = "linux")]
#[test]
fn driver_that_blocks_in_any_call_is_given_up_by_the_watchdog() {
    let Some(_alone) = adapter() else { return };
    for (command, function) in [
        (&RENDER, "vkQueueSubmit 4"),
        (&RENDER, "vkWaitSemaphores 3"),
        (&RENDER, "vkCreateGraphicsPipelines 2"),
        (&EVAL, "vkQueueSubmit 1"),
        // while the adapter is opened
        (&RENDER, "vkAllocateMemory 1"),
    ] {
        let start = Instant::now();
        let (fault, told) = (format!("{function} sleeps"), "within 1 s: it hangs");
        assert!(command.fails_with("hang", &fault, &[told], &[("DPSM_PATIENCE", "1")]));
        assert!(start.elapsed() < SOON, "{function}");
    }
}

#[test]
fn patience_that_is_no_time_is_refused_by_name() {
    for bad in ["soon", "", "0", "-1", "nan", "1e30"] {
        let folder = EVAL.folder("no-time");
        let before = contents(&folder);
        let run = EVAL.run(&folder, "auto", "", &[("DPSM_PATIENCE", bad)]);
        run.failed(bad, 2, "DPSM_PATIENCE=600");
        assert!(run.stderr.contains(&format!("DPSM_PATIENCE=`{bad}`")), "{run:?}");
        assert_eq!(contents(&folder), before);
    }
}
