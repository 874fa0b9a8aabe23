//! The cases of module bias, and of the biases of module cube.

use super::domain::{Promise, all as any, normals, received, up_to};
use super::values::*;
use super::{Cases, disk, point};
use crate::scalar::bias::{DPSM_RECEIVER_ROUNDING, DpsmReceiver, dpsm_receiver};
use crate::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT};
use crate::scalar::light::DpsmLight;

/// The format's quantum and the method's tolerance in the cases.
const SLACK: (f32, f32) = (1.0 / 65535.0, 9e-4);

/// A receiver's rounding in the cases.
const ROUNDING: f32 = DPSM_RECEIVER_ROUNDING as f32;

/// Adds the cases of one of these functions.
pub fn add(function: &str, cases: &mut Cases) {
    let ordinary = point(POINTS.rows[0].1);
    let of =
        |normal: [f32; 3]| -> DpsmReceiver<f32> { dpsm_receiver(ordinary, point(normal), 0.0) };
    let oblique = of([0.0, 1.0, 0.0]);
    let inside = disk(DISKS.rows[1].1);
    // a point with a plane of one normal, and the point (1, 2, 3) with planes of each
    let facing = |p| (point(p), dpsm_receiver(point(p), point([0.0, 0.6, -0.8]), 0.0));
    let normal_at = |normal| (ordinary, of(normal));
    let upright = (ordinary, oblique);
    match function {
        "dpsm_position_error" => cases.each(&POINTS, |p| up_to(126, p), point),
        "dpsm_receiver" => {
            let error = 1e-3_f32;
            cases.each(&NORMALS, normals, |normal| (ordinary, point(normal), error));
            cases.each(&POINTS, received, |p| (point(p), point([0.0, 0.6, -0.8]), error));
            cases.named(&POINTS, ", no normal", received, |p| (point(p), point([0.0; 3]), 0.0_f32));
        }
        "dpsm_receiver_cosine" => {
            cases.each(&NORMALS, normals, of);
            cases.each(&POINTS, received, |p| facing(p).1);
        }
        "dpsm_receiver_distance" => {
            cases.named(
                &DISKS,
                ", front",
                |uv| up_to(62, uv),
                |uv| (oblique, disk(uv), DPSM_FRONT),
            );
            cases.named(&DISKS, ", back", |uv| up_to(62, uv), |uv| (oblique, disk(uv), DPSM_BACK));
            cases.each(&NORMALS, normals, |normal| (of(normal), disk([0.25, 0.5]), DPSM_FRONT));
        }
        "dpsm_bias_slack" => {
            let domain = |l: [f32; 3]| up_to(62, [l[0]]);
            cases.each(&DISTANCES, domain, |[l, near, far]| {
                (l, DpsmLight { near, far, ..LIGHT }, SLACK)
            });
            cases.named(&LIGHTS, ", exact", any, |light| (3.0, light, (0.0, 0.0)));
        }
        "dpsm_bias_window" => {
            cases.each(&DISKS, |uv| up_to(30, uv), |uv| (disk(uv), 0.5, LIGHT));
            cases.each(&WINDOWS, any, |texels| (inside, texels, LIGHT));
            cases.each(&LIGHTS, any, |light| (inside, 0.5, light));
        }
        "dpsm_bias_plane" => {
            for (chord, square, _) in CHORDS.rows {
                let behind = format!(", {chord}");
                cases.named(&COSINES, &behind, any, |cosine| {
                    (cosine, 3.0, *square, ROUNDING, LIGHT)
                });
            }
            cases.each(&CHORDS, any, |square| (0.5, 3.0, square, ROUNDING, LIGHT));
            cases.each(&LIGHTS, any, |light| (0.5, 3.0, 1.0 / 4096.0, ROUNDING, light));
        }
        "dpsm_bias_footprint" => {
            cases.each(&NORMALS, normals, |normal| (of(normal), inside, 0.5, LIGHT));
            cases.each(&WINDOWS, any, |texels| (oblique, disk([0.6, 0.8]), texels, LIGHT));
            cases.each(&LIGHTS, any, |light| (oblique, inside, 0.5, light));
        }
        "dpsm_texel_centre" => {
            cases.each(&DISKS, |uv| up_to(63, uv), |uv| (disk(uv), LIGHT));
            cases.each(&LIGHTS, any, |light| (inside, light));
        }
        "dpsm_lookup_texel_centre" => {
            cases.each(&POINTS, received, |p| (facing(p), LIGHT, SLACK));
            cases.each(&NORMALS, normals, |normal| (normal_at(normal), LIGHT, SLACK));
            cases.each(&LIGHTS, any, |light| (upright, light, SLACK));
        }
        "dpsm_lookup_biased" => {
            cases.each(&POINTS, received, |p| (point(p), 0.01, LIGHT, SLACK));
            cases.each(&LIGHTS, any, |light| (ordinary, 0.01, light, SLACK));
        }
        "dpsm_cube_slack" => {
            let domain = |[l, near, _]: [f32; 3]| -> Promise {
                // nearer ones count as near
                let promise = up_to(62, [l]);
                if l < near { promise.min(Promise::Finite) } else { promise }
            };
            cases.each(&DISTANCES, domain, |[l, near, far]| {
                (l, DpsmLight { near, far, ..LIGHT }, SLACK.0)
            });
            cases.each(&LIGHTS, any, |light| (3.72, light, SLACK.0));
        }
        "dpsm_cube_lookup_texel_centre" => {
            cases.each(&POINTS, received, |p| (facing(p), LIGHT, SLACK.0));
            cases.each(&NORMALS, normals, |normal| (normal_at(normal), LIGHT, SLACK.0));
            cases.each(&LIGHTS, any, |light| (upright, light, SLACK.0));
        }
        "dpsm_cube_lookup_footprint" => {
            cases.each(&POINTS, received, |p| (facing(p), 0.5, LIGHT, SLACK.0));
            cases.each(&NORMALS, normals, |normal| (normal_at(normal), 1.0, LIGHT, SLACK.0));
            cases.each(&WINDOWS, any, |texels| (upright, texels, LIGHT, SLACK.0));
            cases.each(&LIGHTS, any, |light| (upright, 0.5, light, SLACK.0));
        }
        _ => {}
    }
}
