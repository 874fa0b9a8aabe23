//! `cargo bench --bench truth`: a million random rays from one point, on all cores.

use std::path::Path;
use std::time::Instant;

use dpsm::scene::{Options, Scene, open};
use dpsm::truth::{Ray, Truth};
use glam::{DVec3, dvec3};

const RAYS: usize = 1_000_000;

fn main() {
    let sponza = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes/sponza.obj");
    match sponza.exists() {
        true => measure(&open(&sponza.to_string_lossy(), &Options::default()).expect("it opens")),
        false => println!("skipped: no file {}", sponza.display()),
    }
    // About as many triangles, built in.
    measure(
        &open("brabec-room", &Options { walls: 80, ..Options::default() }).expect("it is built in"),
    );
}

fn measure(scene: &Scene) {
    let start = Instant::now();
    let truth = Truth::from(scene);
    let build = start.elapsed();
    let mut rng = fastrand::Rng::with_seed(7);
    let mut direction = || loop {
        let v = DVec3::from([0; 3].map(|_| 2.0 * rng.f64() - 1.0));
        if (1e-4..1.0).contains(&v.length_squared()) {
            return v;
        }
    };
    let origin = if scene.name == "sponza" { dvec3(0.0, 4.0, 0.0) } else { dvec3(0.0, 2.0, 0.0) };
    let rays: Vec<Ray> = (0..RAYS).map(|_| Ray::new(origin, direction())).collect();
    let start = Instant::now();
    let hits = truth.first_hits(&rays).iter().flatten().count();
    let cast = start.elapsed();
    println!(
        "{}: {} triangles, tree built in {:.1} ms; {RAYS} rays in {:.3} s, {:.0} rays/s on \
         {} cores; {:.2}% hit",
        scene.name,
        scene.triangle_count(),
        build.as_secs_f64() * 1e3,
        cast.as_secs_f64(),
        RAYS as f64 / cast.as_secs_f64(),
        std::thread::available_parallelism().map_or(1, |cores| cores.get()),
        100.0 * hits as f64 / RAYS as f64,
    );
}
