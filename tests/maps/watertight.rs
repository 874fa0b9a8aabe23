//! No light passes between triangles that share an edge.

use dpsm::render::{Frame, Method, Settings};
use dpsm::scalar::edge::DPSM_EDGE_ROUNDING;
use dpsm::scalar::maps::DepthMaps;
use dpsm::scene::Mesh;
use dpsm::{cpu, gpu};
use glam::Vec3;

use crate::common::rng;
use crate::meshes::Shell;
use crate::support::{device, frame, scene_of, settings, turn};

/// Empty texels whose centre lies inside the rim.
fn empty(frame: &Frame, maps: &DepthMaps) -> usize {
    let side = maps.size as usize;
    let texel = 2.0 * (1.0 + f64::from(frame.light.guard)) / side as f64;
    let inside = |index: usize| {
        let at = |c: usize| (c as f64 + 0.5 - side as f64 / 2.0) * texel;
        at(index % side).hypot(at(index / side % side)) <= 1.0
    };
    (0..maps.depths.len()).filter(|&i| inside(i) && maps.depths[i] >= 1.0).count()
}

/// Radians: smaller triangles are not cut further. Rounding turns an edge by up to DPSM_EDGE_ROUNDING
/// over its length: where that is a good part of a right angle, triangles are no triangles.
const FINEST: f64 = 64.0 * DPSM_EDGE_ROUNDING;

fn check(mesh: Mesh, rotations: u32, ports: bool, size: u32) {
    let device = device();
    let scene = scene_of(vec![mesh]);
    let mut rng = rng("watertight");
    for rotation in 0..rotations {
        let mut light = None;
        for method in [Method::Exact, Method::Refined] {
            let mut frame = frame(&scene, Vec3::ZERO, Settings { size, method, ..settings() });
            frame.light = *light.get_or_insert_with(|| {
                turn(&mut frame.light, &mut rng);
                frame.light
            });
            let adapter = device.as_ref().map(|device| gpu::make_maps(device, &frame).unwrap());
            let port = (ports || device.is_none()).then(|| cpu::make_maps(&frame).unwrap());
            for maps in adapter.iter().chain(&port) {
                let empty = empty(&frame, maps);
                println!(
                    "{} triangles, rotation {rotation}, {method:?}: {empty} empty",
                    frame.triangles.len()
                );
                assert_eq!(empty, 0, "{method:?}, rotation {rotation}");
            }
        }
    }
}

#[test]
fn million_edges_of_all_sizes_let_nothing_through() {
    let mut rng = rng("million edges");
    let mut shell = Shell::icosahedron();
    (0..3).for_each(|_| shell.cut());
    shell.split_up_to(666_668, FINEST, &mut rng);
    println!("{} triangles, the largest {:.0} times the smallest", shell.len(), shell.spread());
    assert!(shell.spread() > 1000.0);
    check(shell.mesh(|_| 1.0 + 2.0 * rng.f64()), 3, false, 1024);
}

#[test]
fn smooth_mesh_of_all_sizes_lets_nothing_through() {
    let mut rng = rng("smooth");
    let mut shell = Shell::icosahedron();
    (0..4).for_each(|_| shell.cut());
    shell.split_up_to(60_000, FINEST, &mut rng);
    // flat triangles beside curved ones, nearly face-on
    check(shell.mesh(|d| 2.0 + 0.1 * (3.0 * d.x).sin()), 3, true, 512);
}

#[test]
fn fine_patches_in_coarse_meshes_let_nothing_through() {
    let mut rng = rng("patches");
    let mut shell = Shell::icosahedron();
    (0..2).for_each(|_| shell.cut());
    shell.split_up_to(500, 0.1, &mut rng);
    for _ in 0..4 {
        shell.patch(rng.usize(0..500), 25_000, &mut rng);
    }
    check(shell.mesh(|_| 1.0 + rng.f64()), 2, true, 512);
}
