//! Alpha masks: holes are holes by every method.

use dpsm::measure::{Bench, truth_of};
use dpsm::render::{Level, Method, Settings};
use dpsm::scalar::depth::dpsm_distance;
use dpsm::{cpu, gpu};

use crate::support::{built_in, device, frame, settings};
use crate::texels::{centre, hits};

#[test]
fn holes_of_the_fence_are_holes_by_every_method() {
    let device = device();
    let scene = built_in("fence");
    let position = scene.default_light().position;
    for method in
        [Method::Exact, Method::Refined, Method::Vertex, Method::FragmentDepth, Method::Tessellated]
    {
        let settings = Settings { method, size: 512, level: Level::Constant(64), ..settings() };
        let frame = frame(&scene, position, settings);
        let truth = truth_of(&frame);
        let adapter = device.as_ref().map(|device| gpu::make_maps(device, &frame).unwrap());
        let port = adapter.is_none() || method == Method::Refined;
        let port = port.then(|| cpu::make_maps(&frame).unwrap());
        for maps in adapter.iter().chain(&port) {
            let bench = Bench::new(&frame, maps, &truth);
            let (whole, side) = (truth.clone().with_opacity(|_, _| true), i64::from(maps.size));
            let (seen, solid) = (hits(&bench), hits(&Bench::new(&frame, maps, &whole)));
            let masked = |hit: &Option<dpsm::truth::Hit>| {
                hit.is_some_and(|hit| hit.triangle >= frame.first_masked())
            };
            let (mut compared, mut holes, mut wrong) = (0, 0, 0);
            for index in 0..maps.depths.len() {
                let (layer, y, x) =
                    (index as i64 / side / side, index as i64 / side % side, index as i64 % side);
                let uv = centre(&bench, x as u32, y as u32);
                // straight edges bow by up to a texel: none of two texels around may differ
                let around =
                    (0..25).map(|i| maps.index(x + i % 5 - 2, y + i / 5 - 2, layer as u32));
                let same = around
                    .into_iter()
                    .all(|i| masked(&seen[i]) == masked(&seen[index]) && masked(&solid[i]));
                let Some(hit) = seen[index].filter(|_| same && uv.length() <= 0.98) else {
                    continue;
                };
                let depth = f64::from(maps.depths[index]);
                let stored = dpsm_distance(depth, bench.light.near, bench.light.far);
                compared += 1;
                holes += usize::from(!masked(&seen[index]));
                // the panels stand well before what is behind them
                wrong += usize::from((stored - hit.distance).abs() > 0.1 * hit.distance);
            }
            println!("{method:?}: {compared} texels, {holes} of them holes, {wrong} wrong");
            let crude = matches!(method, Method::Vertex | Method::FragmentDepth);
            assert!(compared > 10_000 && holes > 1000);
            // panels of two triangles bow by many texels there
            assert!(crude || wrong == 0, "{method:?}: {wrong}");
        }
    }
}
