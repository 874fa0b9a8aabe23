//! Lists of refined triangles: as large as they need to be, and right where they have no room.

use dpsm::gpu::{self, MeshBuffers, ShadowMaps};
use dpsm::render::{Method, Settings};
use dpsm::scalar::maps::Sampling;

use crate::common::rng;
use crate::support::{built_in, device, differing, frame, place, settings, turn};

#[test]
fn lists_without_room_are_drawn_exactly() {
    let Some(device) = device() else { return };
    // the second with masks
    for name in ["seam-box", "fence"] {
        let scene = built_in(name);
        let mut rng = rng(name);
        let position = place(&scene, &mut rng);
        let mut light = None;
        let mut make = |settings: Settings| {
            let mut frame = frame(&scene, position, settings);
            let light = *light.get_or_insert_with(|| {
                turn(&mut frame.light, &mut rng);
                frame.light
            });
            frame.light = light;
            frame
        };
        let exact = make(Settings { method: Method::Exact, ..settings() });
        let exact = gpu::make_maps(&device, &exact).unwrap();
        for most_refined in [None, Some(0), Some(7), Some(1 << 20)] {
            let frame = make(Settings { most_refined, ..settings() });
            let mesh = MeshBuffers::new(&device, &frame).unwrap();
            let maps = ShadowMaps::new(&device, &frame, &mesh).unwrap();
            let is_short = most_refined.is_some_and(|most| most < 100);
            assert_eq!(maps.is_overfull(), is_short, "{name} {most_refined:?}");
            let record = |encoder: &mut _| maps.record(encoder, &mesh, None);
            device.submit("maps", device.encode("maps", record).unwrap()).unwrap();
            let made = maps.download(&device, Sampling::Nearest).unwrap();
            let differ = differing(&made, &exact);
            // one hull in place of parts: at a silhouette's rounding alone
            println!("{name} {most_refined:?}: {differ} texels differ from exact ones");
            assert_eq!(differ < 40, is_short, "{name} {most_refined:?}: {differ}");
            assert!(maps.list_bytes() > 0);
        }
    }
}

#[test]
fn lists_hold_what_lights_need_and_no_more() {
    let Some(device) = device() else { return };
    let scene = built_in("brabec-room");
    let position = scene.default_light().position;
    let bytes = |size, tau| {
        let frame = frame(&scene, position, Settings { size, tau, ..settings() });
        let mesh = MeshBuffers::new(&device, &frame).unwrap();
        ShadowMaps::new(&device, &frame, &mesh).unwrap().list_bytes()
    };
    let [coarse, usual, fine] = [bytes(256, 0.25), bytes(1024, 0.25), bytes(1024, 1.0 / 32.0)];
    println!("{coarse}, {usual}, {fine} bytes");
    assert!(coarse < usual && usual < fine && fine < 8 << 20);
}
