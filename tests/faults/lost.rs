//! A device that is lost in mid-run: in the program by a driver that fails, in the library by
//! wgpu's own means.

use dpsm::gpu::{self, Device, Evaluator, GpuError, MeshBuffers, ShadowMaps, Texels};
use dpsm::render::{Format, Frame, Method, Settings};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::{self, Options};
use glam::Vec3;

use crate::support::{BAKE, EVAL, MEASURE, PROBE, RENDER, Writes, adapter, contents};

/// A small frame with a view of each map.
pub fn frame(method: Method) -> Frame {
    let scene = scene::open("seam-box", &Options { walls: 1, ..Options::default() }).unwrap();
    let position = scene.default_light().position;
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(position));
    let settings =
        Settings { size: 32, image: [16, 16], views: true, method, ..Settings::default() };
    Frame::new(&scene, position, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

/// Every call of a function in turn; how many there are.
#[cfg(target_os = "linux")]
fn sweep(command: &Writes, function: &str) -> usize {
    let lost = ["the adapter was lost in ", "gives no device"];
    let fails = |n: &usize| command.fails_at("lost", &format!("{function} {n} lost"), &lost);
    (1..).take_while(fails).count()
}

#[cfg(target_os = "linux")]
#[test]
fn device_lost_at_any_submission_or_wait_leaves_every_file_as_it_was() {
    let Some(_alone) = adapter() else { return };
    for (command, functions) in [
        (&RENDER, &["vkQueueSubmit", "vkWaitSemaphores"][..]),
        (&BAKE, &["vkQueueSubmit"]),
        (&PROBE, &["vkQueueSubmit"]),
        (&MEASURE, &["vkQueueSubmit"]),
        (&EVAL, &["vkQueueSubmit", "vkWaitSemaphores"]),
    ] {
        for function in functions {
            let calls = sweep(command, function);
            println!("{}: {calls} calls of {function}", command.name);
            assert!(calls > 0, "{} {function}", command.name);
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn default_job_that_is_lost_leaves_what_is_finished_whole() {
    let Some(_alone) = adapter() else { return };
    let job = Writes { name: "job", arguments: &[], files: &[] };
    // in the first scene, before anything of it is finished
    for fault in ["vkQueueSubmit 1 lost", "vkQueueSubmit 18 lost"] {
        let folder = job.folder("job");
        let run = job.struck(&folder, "gpu", fault, &[]);
        run.failed(fault, 1, "--adapter cpu");
        assert!(run.stderr.contains("the adapter was lost in "), "{fault}: {}", run.stderr);
        let left = folder.join("dpsm-report");
        let files = contents(&left).into_iter().filter(|(path, _)| path.is_file());
        let mut names: Vec<_> = files.map(|(path, _)| path).collect();
        names.sort();
        let whole = ["report.csv", "report.html", "report.json"].map(|name| left.join(name));
        assert_eq!(names, whole, "{fault}: nothing that is half finished is left");
        let json = std::fs::read_to_string(left.join("report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(report["unfinished"][0], "brabec-room", "{fault}");
        let page = std::fs::read_to_string(left.join("report.html")).unwrap();
        assert!(page.trim_end().ends_with("</html>"), "{fault}");
    }
}

/// The error of a run whose device is destroyed somewhere on the way.
fn lost(made: Result<(), GpuError>, place: &str) {
    match made {
        Err(GpuError::Lost { step, message }) => {
            assert!(message.contains("destroyed"), "{place}, {step}: {message}");
        }
        other => panic!("{place}: {other:?}"),
    }
}

/// Makes maps by hand, and destroys the device at one of five points.
fn maps_with_loss(device: &Device, point: usize) -> Result<(), GpuError> {
    let destroy_at = |here| {
        if here == point {
            device.device.destroy();
        }
    };
    let frame = frame(Method::Refined);
    destroy_at(0);
    let mesh = MeshBuffers::new(device, &frame)?;
    destroy_at(1);
    let maps = ShadowMaps::new(device, &frame, &mesh)?;
    let encoder = device.encode("the maps", |encoder| {
        destroy_at(2);
        maps.record(encoder, &mesh, None);
    })?;
    destroy_at(3);
    device.submit("the maps", encoder)?;
    destroy_at(4);
    maps.download(device, Sampling::Nearest).map(drop)
}

#[test]
fn library_names_the_loss_wherever_the_device_is_destroyed() {
    for point in 0..6 {
        let Some((device, _alone)) = adapter() else { return };
        let made = maps_with_loss(&device, point);
        match point {
            5 => assert!(made.is_ok(), "nothing was destroyed: {made:?}"),
            _ => lost(made, &format!("point {point}")),
        }
    }
}

#[test]
fn device_that_is_lost_stays_lost_for_all_its_uses() {
    let Some((device, _alone)) = adapter() else { return };
    let evaluator = Evaluator::new(&device, "dpsm_depth").unwrap();
    let words = [1.0_f32, 0.1, 10.0].map(f32::to_bits);
    assert!(evaluator.run(&words, None).is_ok());
    device.device.destroy();
    lost(evaluator.run(&words, None).map(drop), "evaluation");
    lost(evaluator.run(&words, None).map(drop), "evaluation again");
    lost(device.evaluate::<_, f32>("dpsm_depth", &[[1.0_f32, 0.1, 10.0]]).map(drop), "evaluate");
    lost(gpu::render(&device, &frame(Method::Refined)).map(drop), "render");
    lost(gpu::make_maps(&device, &frame(Method::Refined)).map(drop), "make_maps");
    let maps = DepthMaps {
        size: 2,
        layers: 1,
        depths: vec![0.5; 4],
        sampling: Sampling::Nearest,
        reversed: false,
    };
    let upload = |texels: Texels| texels.upload(&device, &maps, Format::D32);
    lost(Texels::new(&device).and_then(upload).map(drop), "upload");
}

#[test]
fn errors_outside_any_step_are_told_by_the_next_one_and_do_not_panic() {
    let Some((device, _alone)) = adapter() else { return };
    // MAP_READ goes with COPY_DST alone
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::STORAGE;
    let (label, mapped_at_creation) = (Some("wrong"), false);
    let _ = device.device.create_buffer(&wgpu::BufferDescriptor {
        label,
        size: 16,
        usage,
        mapped_at_creation,
    });
    match device.step("the next step", || ()) {
        Err(GpuError::Rejected { step, message }) => {
            assert!(step == "the next step" && message.contains("wrong"), "{step}: {message}");
        }
        other => panic!("{other:?}"),
    }
    assert!(device.step("the one after", || ()).is_ok());
}
