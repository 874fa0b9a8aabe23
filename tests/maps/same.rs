//! What must not change the maps: how they are drawn, kept and cut into chunks.

use dpsm::gpu::{self, Device, MeshBuffers, Parts, ShadowMaps, Texels};
use dpsm::render::{Frame, Method, Passes, Settings};
use dpsm::scalar::light::DpsmLight;
use dpsm::scene::Scene;

use crate::common::rng;
use crate::support::{built_in, device, differing, frame, place, settings, turn};

const METHODS: [Method; 3] = [Method::Vertex, Method::Exact, Method::Hybrid];

fn make(scene: &Scene, settings: Settings) -> Frame {
    let mut rng = rng("same");
    let position = place(scene, &mut rng);
    let mut frame = frame(scene, position, settings);
    turn(&mut frame.light, &mut rng);
    frame
}

#[test]
fn maps_side_by_side_are_those_one_by_one() {
    let Some(device) = device() else { return };
    let scene = built_in("seam-box");
    for method in METHODS {
        let [single, atlas] = [Passes::Single, Passes::Atlas].map(|passes| {
            let frame = make(&scene, Settings { method, passes, ..settings() });
            gpu::make_maps(&device, &frame).unwrap()
        });
        if method == Method::Exact {
            assert_eq!(differing(&single, &atlas), 0);
        }
        // rasterizers interpolate from the attachment's corner: 24 eps as in ports.rs
        let is_apart = |(a, b): &(&f32, &f32)| (*a - *b).abs() > 24.0 * f32::EPSILON;
        let apart = single.depths.iter().zip(&atlas.depths).filter(is_apart).count();
        println!("{method:?}: {} differ, {apart} by more than 24 eps", differing(&single, &atlas));
        assert_eq!(apart, 0, "{method:?}");
    }
}

/// All layers of the maps of some lights.
fn layers(device: &Device, frame: &Frame, lights: &[DpsmLight<f32>], twice: bool) -> Vec<f32> {
    let mesh = MeshBuffers::new(device, frame).unwrap();
    let maps = ShadowMaps::with_lights(device, frame, &mesh, lights).unwrap();
    let record = |encoder: &mut _| match twice {
        false => maps.record(encoder, &mesh, None),
        true => {
            let sort = Parts { draw: false, ..Parts::ALL };
            let draw = Parts { sort: false, ..Parts::ALL };
            for parts in [sort, draw, draw] {
                maps.record_parts(encoder, &mesh, None, parts);
            }
        }
    };
    device.submit("maps", device.encode("maps", record).unwrap()).unwrap();
    Texels::new(device).unwrap().download(device, &maps.view, &maps.texture).unwrap()
}

#[test]
fn many_lights_have_the_maps_of_each_alone_and_kept_lists_draw_them_again() {
    let Some(device) = device() else { return };
    let scene = built_in("seam-box");
    for (method, count) in [(Method::Hybrid, 64), (Method::Exact, 4), (Method::Vertex, 4)] {
        let mut frame = make(&scene, Settings { method, size: 64, ..settings() });
        let mut rng = rng("lights");
        let lights: Vec<_> = (0..count)
            .map(|_| {
                let mut light = frame.light;
                turn(&mut light, &mut rng);
                light.position.x += rng.f32() * 0.2;
                light
            })
            .collect();
        let alone: Vec<f32> =
            lights.iter().flat_map(|&light| layers(&device, &frame, &[light], false)).collect();
        assert!(layers(&device, &frame, &lights, false) == alone, "{method:?}");
        frame.settings.keep_lists = true;
        assert!(layers(&device, &frame, &lights, true) == alone, "{method:?}, kept");
    }
}

#[test]
fn culling_of_meshes_and_spheres_changes_nothing() {
    let Some(device) = device() else { return };
    for method in METHODS {
        let frame =
            make(&built_in("brabec-room"), Settings { method, far: Some(3.0), ..settings() });
        let mut merged = frame.clone();
        merged.meshes = vec![("all".into(), 0..frame.triangles.len() as u32)];
        let [by_mesh, whole] = [&frame, &merged].map(|f| gpu::make_maps(&device, f).unwrap());
        assert_eq!(differing(&by_mesh, &whole), 0, "{method:?}");
    }
}
