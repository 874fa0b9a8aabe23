//! The cost model's rates: least squares of relative errors over scenes, sizes and maps.

use dpsm::gpu::{Device, MeshBuffers, Parts, ShadowMaps};
use dpsm::plan::cost::{self, Rates, generation};
use dpsm::render::{Frame, Method, Settings};
use dpsm::scene;
use glam::{DVec3, Vec3};

use super::place::Place;

/// Runs of each case; the least time counts, as what else the machine does only adds.
const RUNS: usize = 7;

/// What a case's time is made of, in the order of `Rates`.
type Row = [f64; 6];

pub fn rates() -> Result<(), Box<dyn std::error::Error>> {
    let device = Device::open()?;
    println!("adapter: {}", device.describe());
    let mut places: Vec<Place> =
        scene::BUILT_IN.iter().map(|(name, _)| Place::built_in(name, 8)).collect();
    places.push(Place::built_in("brabec-room", 1));
    places.push(Place::of(scene::dozen(250_000), "dozen"));
    places.extend(Place::sponza());
    let mut rows: Vec<(String, Row, f64)> = Vec::new();
    let (mut exact, mut straight) = (Vec::new(), Vec::new());
    for place in &places {
        let kept = vec![true; place.scene.meshes.len()];
        for size in [128, 256, 512, 1024, 2048] {
            for maps in [2, 1] {
                let time = |method| -> Result<(f64, Frame), Box<dyn std::error::Error>> {
                    let settings = Settings { method, size, ..Settings::default() };
                    let frame = one(place, settings, maps == 1);
                    let mesh = MeshBuffers::new(&device, &frame)?;
                    let maps = ShadowMaps::new(&device, &frame, &mesh)?;
                    let mut least = f64::INFINITY;
                    for _ in 0..RUNS {
                        let run = device.time("maps", |encoder, stamps| {
                            maps.record_parts(encoder, &mesh, stamps, Parts::ALL);
                        })?;
                        least = run.map_or(least, |run| least.min(run.as_secs_f64() * 1e3));
                    }
                    Ok((least, frame))
                };
                let (refined, frame) = time(Method::Refined)?;
                exact.push(time(Method::Exact)?.0 / refined);
                let p = frame.light.position;
                let axis = frame.light.forward;
                let seen = cost::seen(&place.scene, &kept, Vec3::new(p.x, p.y, p.z).as_dvec3());
                let axis = DVec3::new(axis.x.into(), axis.y.into(), axis.z.into());
                let loads = &cost::loads(&seen, axis)[..maps];
                let row = std::array::from_fn(|i| generation(&unit(i), loads, seen.len(), size));
                let name = format!("{}, {size}, {maps}", place.name);
                straight.push((name.clone(), row, time(Method::Vertex)?.0));
                rows.push((name, row, refined));
            }
        }
    }
    let found = fit(&rows);
    println!("\npass, sort, triangle, outline, inside, texel: {found:?}");
    println!("of the vertex method: {:?}\n", fit(&straight));
    let mut ratios = Vec::new();
    for (name, row, time) in &rows {
        let predicted: f64 = row.iter().zip(found).map(|(x, rate)| x * rate).sum();
        println!("| {name} | {time:.2} | {predicted:.2} | {:.2} |", predicted / time);
        ratios.push(predicted / time);
    }
    for (what, ratios) in [("predicted of measured", &mut ratios), ("exact of refined", &mut exact)]
    {
        ratios.sort_by(f64::total_cmp);
        let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share) as usize];
        println!(
            "{what}: {:.2} [{:.2}, {:.2}], 5% {:.2}, 95% {:.2}",
            at(0.5),
            at(0.25),
            at(0.75),
            at(0.05),
            at(0.95)
        );
    }
    Ok(())
}

/// The place's frame, or with one map alone.
fn one(place: &Place, settings: Settings, hemispherical: bool) -> Frame {
    let camera = place.scene.default_camera(place.light);
    let axis = Vec3::new(0.05, -1.0, 0.03);
    Frame::new(&place.scene, place.light, axis, hemispherical, &camera, settings)
        .expect("a usable frame")
}

/// Rates of which one is 1.
fn unit(index: usize) -> Rates {
    let mut rates = [0.0; 6];
    rates[index] = 1.0;
    let [pass, sort, triangle, outline, inside, texel] = rates;
    Rates { pass, sort, triangle, outline, inside, texel, ..Rates::LLVMPIPE }
}

/// Rates of at least 0 that make the sum of squared relative errors least, one at a time in turn.
fn fit(rows: &[(String, Row, f64)]) -> Row {
    let mut rates = [0.0; 6];
    for _ in 0..20_000 {
        for i in 0..6 {
            let (mut with, mut square) = (0.0, 0.0);
            for (_, row, time) in rows {
                let others: f64 = (0..6).filter(|&k| k != i).map(|k| row[k] * rates[k]).sum();
                with += row[i] / time * (1.0 - others / time);
                square += (row[i] / time).powi(2);
            }
            rates[i] = if square > 0.0 { (with / square).max(0.0) } else { 0.0 };
        }
    }
    rates
}
