//! Triangles with holes: rays pass through them, and through nothing else.

use dpsm::scene::{Mask, Mesh, Options, Scene, open};
use glam::{Vec3, vec2, vec3};

use crate::common::rng;
use crate::*;

/// Squares in a row of the checkerboard.
const CELLS: u32 = 8;

/// A level square of half-width 1 at a height, with a checkerboard over it where asked for.
fn square(name: &str, height: f32, masked: bool) -> Mesh {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let alpha = (0..CELLS * CELLS).map(|i| if (i + i / CELLS).is_multiple_of(2) { 255 } else { 0 });
    let mask = Mask { width: CELLS, height: CELLS, alpha: alpha.collect(), cutoff: 0.5 };
    Mesh {
        name: name.into(),
        positions: corners.map(|(x, z)| vec3(x, height, z)).to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        albedo: Vec3::ONE,
        // two and a half times over, from below zero on
        texcoords: if masked { corners.map(|(x, z)| vec2(x, z) * 1.25).to_vec() } else { vec![] },
        mask: masked.then_some(mask),
    }
}

/// Whether the checkerboard is opaque at x and z; `None` within rounding of a border.
fn opaque(x: f64, z: f64) -> Option<bool> {
    let cells = [x, z].map(|t| t * 1.25 * f64::from(CELLS));
    // texture coordinates up to 1.25 are rounded to 2^-24 when they are narrowed, and to 2^-25
    // when they are wrapped: 2^-22 of 10 cells is far more
    let sure = cells.iter().all(|t| (t - t.round()).abs() > 10.0 * 2f64.powi(-22));
    let sum: f64 = cells.iter().map(|t| t.floor()).sum();
    sure.then_some(sum.rem_euclid(2.0) == 0.0)
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    let (origin, lights, camera, warnings) = Default::default();
    Scene { name: "squares".into(), origin, meshes, lights, camera, warnings }
}

#[test]
fn rays_and_light_pass_through_the_holes_of_a_mask_alone() {
    let meshes = vec![
        square("roof", 3.0, false),
        square("upper", 2.0, true),
        square("middle", 1.5, false),
        square("lower", 1.0, true),
        square("floor", 0.0, false),
    ];
    let truth = Truth::from(&scene(meshes));
    let mut rng = rng("holes");
    let (mut lit, mut dark) = (0, 0);
    for _ in 0..100_000 {
        let down = |from: f64, x: f64, z: f64| Ray::new(dvec3(x, from, z), DVec3::NEG_Y);
        let [x, z] = [0; 2].map(|_| 2.0 * rng.f64() - 1.0);
        let Some(opaque) = opaque(x, z) else { continue };
        // through the upper one onto the middle one, through the lower one onto the floor
        for (from, masked, to, below) in [(2.5, 1, 1.5, 2), (1.25, 3, 0.0, 4)] {
            let ray = down(from, x, z);
            let hit = truth.first_hit(&ray).unwrap();
            assert_eq!(hit.triangle / 2, if opaque { masked } else { below }, "{x} {z}");
            // one triangle alone, of the two one
            let alone = [0, 1].map(|i| truth.hit(&ray, 2 * masked + i).is_some());
            assert_eq!(alone[0] != alone[1], opaque, "{x} {z}");
            let (light, point) = (dvec3(x, from, z), dvec3(x, to, z));
            let own = truth.first_hit(&down(to + 0.1, x, z)).map(|hit| hit.triangle);
            let occluder = truth.occluder(light, point, own, 0.0).map(|hit| hit.triangle / 2);
            assert_eq!(occluder, opaque.then_some(masked), "{x} {z}");
            assert_eq!(truth.sees(light, point, own, 0.0), !opaque);
        }
        *(if opaque { &mut dark } else { &mut lit }) += 1;
    }
    println!("{lit} through holes, {dark} not");
    assert!(lit > 40_000 && dark > 40_000);
}

#[test]
fn holes_inside_triangles_tear_no_edge_open() {
    let mut rng = rng("rims");
    let triangles = ball(1.0, 4);
    let rim = |weights: [f64; 3]| weights.into_iter().fold(1.0, f64::min) < 0.1;
    let truth = soup(&triangles).with_opacity(move |_, weights| rim(weights));
    let whole = soup(&triangles);
    let mut rays = Vec::new();
    for _ in 0..100_000 {
        let [a, b, _] = triangles[rng.usize(0..triangles.len())];
        let part = [0.0, 0.5, 0.25, rng.f64()][rng.usize(0..4)];
        let origin = within(&mut rng, 0.3);
        rays.push(Ray::new(origin, a.lerp(b, part) - origin));
        rays.push(Ray::new(origin, direction(&mut rng)));
    }
    let (mut edges, mut holes) = (0, 0);
    let all = truth.first_hits(&rays);
    for ((i, ray), hit) in rays.iter().enumerate().zip(all) {
        let expected = whole.first_hit(ray).filter(|hit| rim(hit.weights));
        assert_eq!(hit, expected);
        assert!(i % 2 == 1 || hit.is_some(), "a ray through an edge escaped");
        edges += usize::from(i % 2 == 0);
        holes += usize::from(hit.is_none());
    }
    println!("{edges} rays through edges, {holes} through holes");
    // a hole has 0.7^2 = 0.49 of its triangle's area, and from near the middle of its angle
    assert!((0.45..0.53).contains(&(holes as f64 / 1e5)));
}

#[test]
fn bulk_forms_copies_and_wholly_opaque_triangles_agree() {
    let scene = open("fence", &Options { walls: 1, ..Options::default() }).unwrap();
    let light = scene.default_light().position.as_dvec3();
    let truth = Truth::from(&scene);
    let copy = truth.clone();
    assert!(format!("{truth:?}").contains("some holes"));
    let whole: Vec<DVec3> = scene.triangles().flatten().map(Vec3::as_dvec3).collect();
    let whole =
        Truth::new(&whole, (0..).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).take(whole.len() / 3));
    assert!(format!("{whole:?}").contains("no holes"));
    let opaque = whole.clone().with_opacity(|_, _| true);
    let mut rng = rng("fence");
    let rays: Vec<Ray> = (0..20_000).map(|_| Ray::new(light, direction(&mut rng))).collect();
    let hits = truth.first_hits(&rays);
    assert!(hits.iter().all(|hit| hit.is_some()), "the room is closed");
    assert_eq!(hits, rays.iter().map(|ray| copy.first_hit(ray)).collect::<Vec<_>>());
    assert_eq!(opaque.first_hits(&rays), whole.first_hits(&rays));
    let differ = hits.iter().zip(whole.first_hits(&rays)).filter(|(a, b)| *a != b).count();
    assert!(differ > 500, "rays through the holes: {differ}");
    let point = |hit: &Hit| (whole.point(hit).unwrap(), Some(hit.triangle));
    let receivers: Vec<_> = whole.first_hits(&rays).iter().flatten().map(point).collect();
    let single = receivers.iter().map(|&(point, own)| truth.occluder(light, point, own, 0.0));
    assert_eq!(truth.occluders(light, &receivers, 0.0), single.collect::<Vec<_>>());
}
