//! Are the maps right: every texel of random poses against ray casting.

use dpsm::gpu::{Device, GpuError, make_maps};
use dpsm::measure::{Bench, map_error, truth_of};
use dpsm::render::{Method, Settings};
use fastrand::Rng;

use super::place::{Place, posed, position, rotation};

/// Map size and random poses of each scene: with five scenes 200 of the small ones.
const POSES: [(u32, usize); 3] = [(256, 40), (1024, 4), (4096, 1)];

/// The largest error of all poses, and how many texels are at fault.
#[derive(Default)]
struct Sum {
    texels: usize,
    holes: usize,
    off: usize,
    extra: usize,
    excused: usize,
    largest: f64,
    /// eps times the tangent of the incidence there.
    conditioning: f64,
}

pub fn right(device: &Device) -> Result<(), GpuError> {
    println!("\nevery texel of random light positions and rotations, against ray casting\n");
    println!(
        "| scene | size | poses | method | texels | holes | off by > 1e-3 | extra | excused by a \
         silhouette | largest error of the rest | eps tan(incidence) there |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let mut places: Vec<Place> =
        ["brabec-room", "cornell", "seam-box", "cage"].map(|n| Place::built_in(n, 1)).into();
    places.extend(Place::sponza());
    for place in &places {
        let base = place.frame(Settings::default());
        let truth = truth_of(&base);
        for (size, poses) in POSES {
            let mut sums = [Sum::default(), Sum::default()];
            let mut rng = Rng::with_seed(7);
            for _ in 0..poses {
                let light = position(place, &truth, &mut rng);
                let turn = rotation(&mut rng);
                for (method, sum) in [Method::Exact, Method::Refined].into_iter().zip(&mut sums) {
                    let frame = posed(
                        place,
                        Settings { method, size, ..base.settings.clone() },
                        light,
                        turn,
                    );
                    let maps = make_maps(device, &frame)?;
                    let [tau, _] = frame.settings.tolerances();
                    let error = map_error(&Bench::new(&frame, &maps, &truth), tau.into(), || ());
                    sum.texels += error.all.texels;
                    sum.holes += error.all.holes;
                    sum.off += error.all.faults_off;
                    sum.extra += error.all.faults_extra;
                    sum.excused += error.all.excused;
                    if error.all.largest_rest > sum.largest {
                        sum.largest = error.all.largest_rest;
                        sum.conditioning = error.worst.map_or(0.0, |worst| worst.conditioning);
                    }
                }
            }
            for (name, s) in ["exact", "refined"].into_iter().zip(sums) {
                println!(
                    "| {} | {size} | {poses} | {name} | {} | {} | {} | {} | {} | {:.1e} | {:.1e} |",
                    place.scene.name,
                    s.texels,
                    s.holes,
                    s.off,
                    s.extra,
                    s.excused,
                    s.largest,
                    s.conditioning
                );
            }
        }
    }
    Ok(())
}
