//! Whether a method of its own for each mesh pays: meshes whose triangles are all flat, in one
//! hemisphere, drawn without sorting.

use std::time::Duration;

use dpsm::gpu::{Device, MeshBuffers, Parts, ShadowMaps};
use dpsm::render::{Casting, Frame, Method, Settings, float};
use dpsm::scalar::classify::{DPSM_CULLED, DPSM_FLAT, DPSM_IN_BACK, DPSM_IN_FRONT, dpsm_classify};
use dpsm::scalar::hemisphere::dpsm_to_light;
use dpsm::scene;

use super::place::Place;

const RUNS: usize = 15;

pub fn methods() -> Result<(), Box<dyn std::error::Error>> {
    let device = Device::open()?;
    println!("adapter: {}", device.describe());
    let mut places: Vec<Place> =
        scene::BUILT_IN.iter().map(|(name, _)| Place::built_in(name, 8)).collect();
    places.push(Place::of(scene::dozen(250_000), "dozen"));
    println!("| scene | size | meshes | flat | their triangles | vertex of hybrid |");
    println!("|---|---|---|---|---|---|");
    for place in &places {
        for size in [256, 1024] {
            let hybrid = Settings { size, ..Settings::default() };
            let frame = place.frame(hybrid.clone());
            let found = flat(&frame);
            // no scene here has a mask among its first meshes: the frame's order is the scene's
            let by_flat = |flat: &bool| match flat {
                true => Casting::By(Method::Vertex),
                false => Casting::By(Method::Hybrid),
            };
            let casting: Vec<Casting> = found.iter().map(by_flat).collect();
            let ranges = frame.meshes.iter().zip(&found).filter(|(_, flat)| **flat);
            let triangles: usize = ranges.map(|((_, range), _)| range.len()).sum();
            let count = found.iter().filter(|flat| **flat).count();
            let mut ratio = f64::NAN;
            if count > 0 {
                let mixed = Settings { casting, ..hybrid.clone() };
                let mut ready = Vec::new();
                for settings in [mixed, hybrid] {
                    let frame = place.frame(settings);
                    let mesh = MeshBuffers::new(&device, &frame)?;
                    ready.push((ShadowMaps::new(&device, &frame, &mesh)?, mesh, Vec::new()));
                }
                for run in 0..=RUNS {
                    for (maps, mesh, times) in &mut ready {
                        let time = device.time("maps", |encoder, stamps| {
                            maps.record_parts(encoder, mesh, stamps, Parts::ALL);
                        })?;
                        times.extend(time.filter(|_| run > 0));
                    }
                }
                let median = |times: &mut Vec<Duration>| {
                    times.sort();
                    times[times.len() / 2].as_secs_f64()
                };
                let [mixed, hybrid] = [0, 1].map(|i: usize| median(&mut ready[i].2));
                ratio = mixed / hybrid;
            }
            let meshes = found.len();
            let name = &place.scene.name;
            println!("| {name} | {size} | {meshes} | {count} | {triangles} | {ratio:.2} |");
        }
    }
    Ok(())
}

/// For each of a frame's meshes, in the frame's order, whether drawing its triangles as they are,
/// in one map, is as good as the hybrid method: straight edges within `tau`, interpolated distances
/// within the depth tolerance, none cut by the seam.
fn flat(frame: &Frame) -> Vec<bool> {
    let light = frame.light;
    let [tau, tolerance] = frame.settings.tolerances();
    let corner = |index: u32| dpsm_to_light(float(frame.vertices[index as usize].position), light);
    let is_flat = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(corner);
        let class = dpsm_classify(a, b, c, light, tau, tolerance);
        let one = [DPSM_IN_FRONT, DPSM_IN_BACK].contains(&class.hemispheres);
        class.kind == DPSM_CULLED || (class.kind == DPSM_FLAT && one)
    };
    let of_mesh = |(_, range): &(String, std::ops::Range<u32>)| {
        frame.triangles[range.start as usize..range.end as usize].iter().all(is_flat)
    };
    frame.meshes.iter().map(of_mesh).collect()
}
