//! Where the stored disk ends.

use dpsm::render::{Frame, Method, Settings};
use dpsm::scalar::maps::DepthMaps;
use dpsm::{cpu, gpu};
use glam::vec3;

use crate::common::{EPS, rng};
use crate::support::{built_in, device, frame, settings, turn};

/// Texels on the wrong side of the border: empty ones within it, and stored ones beyond. A centre
/// within rounding of it may be either: 5 eps (1 + guard) of the coordinates (dpsm_triangle_disk)
/// and 3 eps of the square.
fn misplaced(frame: &Frame, maps: &DepthMaps) -> [usize; 2] {
    let side = maps.size as usize;
    let rim = 1.0 + f64::from(frame.light.guard);
    let slack = (5.0 + 3.0) * EPS * rim;
    let mut wrong = [0; 2];
    for (index, &depth) in maps.depths.iter().enumerate() {
        let at = |c: usize| (c as f64 + 0.5 - side as f64 / 2.0) * 2.0 * rim / side as f64;
        let r = at(index % side).hypot(at(index / side % side));
        let is_stored = depth < 1.0;
        wrong[0] += usize::from(r < rim - slack && !is_stored);
        wrong[1] += usize::from(r > rim + slack && is_stored);
    }
    wrong
}

#[test]
fn stored_disk_is_full_up_to_its_border_and_empty_beyond() {
    let device = device();
    let mut rng = rng("rim");
    // small triangles at the rim straddle it; walls are cut
    let scenes = ["seam-box", "cage"].map(built_in).into_iter().chain([dpsm::scene::crowd(4_000)]);
    let mut by_vertex = 0;
    for scene in scenes {
        for size in [64, 256, 333] {
            let position = scene.default_light().position + vec3(0.03, -0.05, 0.02);
            let mut light = None;
            for method in [Method::Exact, Method::Refined, Method::Vertex] {
                let mut frame = frame(&scene, position, Settings { size, method, ..settings() });
                frame.light = *light.get_or_insert_with(|| {
                    turn(&mut frame.light, &mut rng);
                    frame.light
                });
                let adapter = device.as_ref().map(|device| gpu::make_maps(device, &frame).unwrap());
                let port = cpu::make_maps(&frame).unwrap();
                for maps in adapter.iter().chain([&port]) {
                    let wrong = misplaced(&frame, maps);
                    match method {
                        Method::Vertex => by_vertex += wrong[0] + wrong[1],
                        // what is beyond the border is never read: refined maps leave it as it falls
                        Method::Refined => assert_eq!(wrong[0], 0, "{} {size}", scene.name),
                        _ => assert_eq!(wrong, [0; 2], "{} {size} {method:?}", scene.name),
                    }
                }
            }
        }
    }
    println!("by vertex {by_vertex} texels are on the wrong side");
    assert!(by_vertex > 1000, "{by_vertex}");
}
