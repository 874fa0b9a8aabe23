//! Are the maps right: every texel of random poses against ray casting.

use dpsm::gpu::{Device, GpuError, make_maps};
use dpsm::measure::{Bench, map_error, truth_of};
use dpsm::render::{Frame, Method, Settings};
use dpsm::scalar::float::Vec3 as Row;
use dpsm::truth::{Ray, Truth};
use fastrand::Rng;
use glam::{DVec3, Quat, Vec3};

use super::Place;

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
                for (method, sum) in [Method::Exact, Method::Hybrid].into_iter().zip(&mut sums) {
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
            for (name, s) in ["exact", "hybrid"].into_iter().zip(sums) {
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

/// A random place in the scene's box, at least a twentieth of its size from every surface; for the
/// cage, near its middle.
fn position(place: &Place, truth: &Truth, rng: &mut Rng) -> Vec3 {
    let bounds = place.scene.bounds();
    loop {
        let random = Vec3::new(rng.f32(), rng.f32(), rng.f32());
        let light = match place.scene.name.as_str() {
            "cage" => place.light + (random - 0.5) * 0.1,
            _ => bounds.min + bounds.extent() * (0.1 + 0.8 * random),
        };
        let clearance = match place.scene.name.as_str() {
            "cage" => 0.1,
            _ => f64::from(bounds.extent().min_element()) / 20.0,
        };
        let directions = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|d| [d, -d]);
        let clear = |direction| {
            let ray = Ray { far: clearance, ..Ray::new(light.as_dvec3(), direction) };
            truth.first_hit(&ray).is_none()
        };
        if directions.clone().all(clear) {
            return light;
        }
    }
}

fn rotation(rng: &mut Rng) -> Quat {
    loop {
        let q = [(); 4].map(|()| rng.f32() * 2.0 - 1.0);
        let q = Quat::from_array(q);
        if (0.1..1.0).contains(&q.length_squared()) {
            return q.normalize();
        }
    }
}

/// A frame whose light has a rotation of its own.
fn posed(place: &Place, settings: Settings, light: Vec3, turn: Quat) -> Frame {
    let camera = place.scene.default_camera(light);
    let mut frame = Frame::new(&place.scene, light, Vec3::NEG_Y, false, &camera, settings)
        .expect("a usable frame");
    let row = |v: Vec3| Row::new(v.x, v.y, v.z);
    frame.light.right = row(turn * Vec3::X);
    frame.light.up = row(turn * Vec3::Y);
    frame.light.forward = row(turn * Vec3::Z);
    frame
}
