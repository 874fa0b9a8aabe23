//! What must not change the maps: how they are drawn, kept and cut into chunks.

use dpsm::cpu;
use dpsm::gpu::{self, Device, GpuError, MeshBuffers, Parts, ShadowMaps, Texels};
use dpsm::render::{Frame, Method, Passes, Settings};
use dpsm::scalar::light::{DPSM_HEMISPHERICAL, DpsmLight};
use dpsm::scene::Scene;

use crate::common::rng;
use crate::support::{Adapter, built_in, device, differing, frame, place, settings, stored, turn};

const METHODS: [Method; 3] = [Method::Vertex, Method::Exact, Method::Refined];

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

/// The methods of paraboloid maps: those that draw all triangles into each map, and those that draw
/// a list for each.
const MULTIVIEW: [Method; 5] =
    [Method::Vertex, Method::FragmentDepth, Method::Tessellated, Method::Exact, Method::Refined];

/// The adapter, if it has multiview and no fault of it that is known; else a line says why not.
fn multiview() -> Option<Adapter> {
    let device = device()?;
    let settings = Settings { method: Method::Vertex, passes: Passes::Multiview, ..settings() };
    let has = device.device.features().contains(wgpu::Features::MULTIVIEW);
    match gpu::make_maps(&device, &make(&built_in("seam-box"), settings)) {
        Ok(_) => Some(device),
        // docs/maps.md says what is wrong with lavapipe's
        Err(error @ GpuError::Multiview { .. }) if !has || device.info.driver == "llvmpipe" => {
            println!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn maps_by_multiview_are_those_one_by_one() {
    let Some(device) = multiview() else { return };
    // the second with masks, the third with the far sphere within the room
    for (name, far) in [("seam-box", None), ("fence", None), ("brabec-room", Some(3.0))] {
        let scene = built_in(name);
        for method in MULTIVIEW {
            let [single, multiview] = [Passes::Single, Passes::Multiview].map(|passes| {
                let frame = make(&scene, Settings { method, passes, far, ..settings() });
                gpu::make_maps(&device, &frame).unwrap()
            });
            assert_eq!(differing(&single, &multiview), 0, "{name}, {method:?}");
            assert!(stored(&multiview) > 10_000, "{name}, {method:?}");
        }
    }
}

#[test]
fn lights_with_two_maps_and_with_one_share_a_texture_by_multiview() {
    let Some(device) = multiview() else { return };
    let scene = built_in("seam-box");
    for method in MULTIVIEW {
        let mut frame = make(&scene, Settings { method, size: 64, ..settings() });
        let one = DpsmLight { hemispheres: DPSM_HEMISPHERICAL, ..frame.light };
        let lights = [frame.light, one, frame.light, one];
        let single = layers(&device, &frame, &lights, false);
        frame.settings.passes = Passes::Multiview;
        assert!(layers(&device, &frame, &lights, false) == single, "{method:?}");
    }
}

#[test]
fn ports_make_the_same_maps_whatever_the_passes() {
    let scene = built_in("seam-box");
    let [single, atlas, multiview] =
        [Passes::Single, Passes::Atlas, Passes::Multiview].map(|passes| {
            let settings = Settings { method: Method::Vertex, size: 64, passes, ..settings() };
            cpu::make_maps(&make(&scene, settings)).unwrap()
        });
    assert!(stored(&single) > 1000);
    assert_eq!([differing(&single, &atlas), differing(&single, &multiview)], [0, 0]);
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
    for (method, count) in [(Method::Refined, 64), (Method::Exact, 4), (Method::Vertex, 4)] {
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
