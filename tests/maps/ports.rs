//! The adapter's maps against those of the ports.

use dpsm::render::{Format, Frame, Level, Method, Settings};
use dpsm::scalar::edge::DPSM_EDGE_SNAP;
use dpsm::scalar::hemisphere::{dpsm_flip, dpsm_to_light};
use dpsm::scalar::maps::DepthMaps;
use dpsm::scalar::paraboloid::{dpsm_project, dpsm_texel_width};
use dpsm::{cpu, gpu, render};

use crate::common::rng;
use crate::support::{built_in, device, differing, frame, is_whole, place, settings, stored, turn};

const SCENES: [&str; 5] = ["brabec-room", "cornell", "seam-box", "cage", "fence"];

fn turned(name: &str, settings: Settings) -> Frame {
    let scene = built_in(name);
    let mut rng = rng(name);
    let position = place(&scene, &mut rng);
    let mut frame = frame(&scene, position, settings);
    turn(&mut frame.light, &mut rng);
    frame
}

#[test]
fn exact_maps_of_adapter_and_ports_are_the_same() {
    let Some(device) = device() else { return };
    // the driver that rounds as the ports do; on others the bounds of right.rs are the check
    if !device.info.name.contains("llvmpipe") {
        println!("skipped: {} may round otherwise", device.describe());
        return;
    }
    for name in SCENES {
        for format in [Format::D32, Format::D24, Format::D16] {
            let frame = turned(name, Settings { method: Method::Exact, format, ..settings() });
            let adapter = gpu::make_maps(&device, &frame).unwrap();
            let port = cpu::make_maps(&frame).unwrap();
            assert!(stored(&port) * 2 > port.depths.len() && is_whole(&adapter));
            if format == Format::D32 {
                assert_eq!(differing(&adapter, &port), 0, "{name}");
                continue;
            }
            // either neighbour of a depth, as an f32
            let step = format.quantum() * (1.0 + f32::EPSILON) + f32::EPSILON / 2.0;
            for (a, p) in adapter.depths.iter().zip(&port.depths) {
                assert!((a - p).abs() <= step, "{name} {format:?}: {a} {p}");
            }
        }
    }
}

/// Length of all edges on the maps, in texels; what lies outside counts as up to the map's width.
fn edges(frame: &Frame) -> f64 {
    let light = &frame.light;
    let texel = dpsm_texel_width(light.size, light.guard);
    let mut sum = 0.0;
    for map in 0..light.hemispheres {
        let place = |i: u32| {
            let position = render::float(frame.vertices[i as usize].position);
            dpsm_project(dpsm_flip(dpsm_to_light(position, *light), map))
        };
        for corners in &frame.triangles {
            let disk = corners.map(place);
            if disk.iter().all(|uv| uv.length() > 2.0) {
                continue;
            }
            for i in 0..3 {
                let chord = (disk[i] - disk[(i + 1) % 3]).length().min(3.0);
                sum += f64::from(chord / texel);
            }
        }
    }
    sum
}

/// Texels that are farther apart than shifting the port's map by a step of the rasterizer allows:
/// those where an edge passes the centre.
fn apart(frame: &Frame, adapter: &DepthMaps, port: &DepthMaps) -> usize {
    let side = i64::from(port.size);
    let mut count = 0;
    for index in 0..port.depths.len() {
        let (a, p) = (adapter.depths[index], port.depths[index]);
        let (layer, y, x) =
            (index as i64 / side / side, index as i64 / side % side, index as i64 % side);
        let around =
            (0..9).map(|i| port.depths[port.index(x + i % 3 - 1, y + i / 3 - 1, layer as u32)]);
        let (low, high) = around
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)));
        // 24 eps: vertices' depths by both, interpolated
        let margin = (high - low) * DPSM_EDGE_SNAP as f32
            + 24.0 * f32::EPSILON
            + frame.settings.format.quantum();
        count += usize::from((a - p).abs() > margin);
    }
    count
}

#[test]
fn other_maps_of_adapter_and_ports_differ_at_edges_alone() {
    let Some(device) = device() else { return };
    for name in SCENES {
        // refined also from a near sphere inside the rooms on, and reversed
        for (method, near_share, reversed) in [
            (Method::Refined, None, false),
            (Method::Refined, Some(0.4), false),
            (Method::Refined, Some(0.4), true),
            (Method::Vertex, None, false),
            (Method::FragmentDepth, None, false),
            (Method::Tessellated, None, false),
        ] {
            let level = Level::Mesh(4);
            let mut frame = turned(name, Settings { method, level, reversed, ..settings() });
            if let Some(share) = near_share {
                frame.light.near = share * frame.light.far;
            }
            let adapter = gpu::make_maps(&device, &frame).unwrap();
            let port = cpu::make_maps(&frame).unwrap();
            assert!(is_whole(&adapter) && is_whole(&port));
            let apart = apart(&frame, &adapter, &port);
            // an edge whose ends are moved by up to a step passes over this many centres, times
            // the sub-triangles of a level
            let cuts = if method == Method::Tessellated { 4.0 } else { 1.0 };
            let passed = cuts * edges(&frame) * DPSM_EDGE_SNAP;
            println!(
                "{name:12} {method:?} {near_share:?} {reversed}: {apart} of {} apart, at most {passed:.0} expected",
                stored(&port)
            );
            assert!((apart as f64) <= passed, "{name} {method:?}: {apart}");
        }
    }
}
