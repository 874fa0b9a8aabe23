//! Which triangles a face can be spared.

use dpsm::scalar::cube::*;
use dpsm::scalar::float::Vec3;
use dpsm::scalar::light::DpsmLight;

use crate::common::{CASES, point, rng, uniform, unit};

#[test]
fn triangles_that_reach_a_face_are_never_outside_it() {
    let mut rng = rng("reach");
    let mut reaching = 0;
    for _ in 0..CASES {
        let (face, guard) = (rng.u32(0..6), rng.f32());
        let mut corners = [(); 3].map(|()| point(&mut rng, -3, 3));
        if rng.bool() {
            // one corner on a side, a few floats in or out, and the others beyond that side
            let z = uniform(&mut rng, 0.1, 9.0);
            let side = z * (1.0 + guard);
            let x = f32::from_bits(side.to_bits() + rng.u32(0..9) - 4);
            let beyond = |rng: &mut fastrand::Rng| uniform(rng, 1.5, 3.0) * side;
            let views = [
                Vec3::new(x, uniform(&mut rng, -z, z), z),
                Vec3::new(beyond(&mut rng), z, z),
                Vec3::new(beyond(&mut rng), -z, z),
            ];
            let turn = rng.u32(0..4);
            corners = views.map(|v| {
                let turned = [(v.x, v.y), (-v.x, v.y), (v.y, v.x), (v.y, -v.x)][turn as usize];
                dpsm_cube_unview(Vec3::new(turned.0, turned.1, v.z), face)
            });
        }
        let [a, b, c] = corners;
        // the corners by the pass's own rounding, and a point inside by exact arithmetic
        let light = DpsmLight { guard, ..dpsm::cases::light(0) };
        let stored = corners.iter().any(|&p| {
            let clip = dpsm_cube_vertex(p, face, light);
            clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w
        });
        let (s, t) = (rng.f64(), rng.f64() * 0.5);
        let inside = (a.widen() * (1.0 - s) + b.widen() * s) * (1.0 - t) + c.widen() * t;
        let v = dpsm_cube_view(inside, face);
        let reach = v.z * (1.0 + f64::from(guard));
        if stored || (v.z > 0.0 && v.x.abs() <= reach && v.y.abs() <= reach) {
            reaching += 1;
            assert!(!dpsm_cube_outside(a, b, c, face, guard), "{corners:?} {face} {guard}");
        }
    }
    assert!(reaching > CASES / 5, "{reaching} reach the face");
}

#[test]
fn small_triangles_are_kept_by_the_faces_that_hold_them_alone() {
    let mut rng = rng("cull");
    for _ in 0..CASES {
        let (a, guard) = (unit(&mut rng), 0.25 * rng.f32());
        let [b, c] = [0; 2].map(|_| a + unit(&mut rng) * 1e-3);
        for face in 0..DPSM_CUBE_FACES {
            let v = dpsm_cube_view(a.widen(), face);
            let most = v.x.abs().max(v.y.abs());
            // how far outside the face; b and c are 1e-3 away, on a side that leans at most to 1 in
            // 1.25 and so moves by at most sqrt(1 + 1.25^2) of that
            let off = most - v.z * (1.0 + f64::from(guard));
            if off.abs() > 1e-3 * 1.7 {
                assert_eq!(dpsm_cube_outside(a, b, c, face, guard), off > 0.0, "{a:?} {face}");
            }
        }
    }
}

#[test]
fn triangles_behind_a_face_are_outside_it_also_where_they_are_wide() {
    let corners = [(-9.0, -9.0, -1.0), (9.0, -9.0, -1.0), (0.0, 9.0, 0.0)];
    for face in 0..DPSM_CUBE_FACES {
        let [a, b, c] = corners.map(|(x, y, z)| dpsm_cube_unview(Vec3::new(x, y, z), face));
        assert!(dpsm_cube_outside(a, b, c, face, 0.1_f32));
    }
}
