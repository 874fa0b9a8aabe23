//! The cases of module bias, and of the biases of module cube.

use super::{Cases, DISKS, GUARD, POINTS, disk, light, point};
use crate::scalar::bias::{DpsmReceiver, dpsm_receiver};
use crate::scalar::hemisphere::{DPSM_BACK, DPSM_FRONT};
use crate::scalar::light::{DPSM_ATLAS, DPSM_LAYERS};

/// Normals at the point (1, 2, 3).
const NORMALS: &[(&str, [f32; 3])] = &[
    ("facing", [1.0, 2.0, 3.0]),
    ("turned away", [-3.0, -6.0, -9.0]),
    ("oblique and long", [0.0, 1e20, 0.0]),
    ("short", [1e-20, 0.0, 1e-20]),
    ("edge-on", [3.0, 0.0, -1.0]),
    ("nearly edge-on", [3.0, 0.0, -0.999]),
    ("none", [0.0, 0.0, 0.0]),
];

/// Half sides of windows in texels.
const WINDOWS: &[(&str, f32)] =
    &[("nearest texel", 0.5), ("radius 3", 3.5), ("nothing", 0.0), ("whole map", 1024.0)];

/// The format's quantum and the method's tolerance in the cases.
const SLACK: (f32, f32) = (1.0 / 65535.0, 9e-4);

/// Adds the cases of one of these functions.
pub fn add(function: &str, cases: &mut Cases) {
    let layers = light(DPSM_LAYERS);
    let ordinary = point([1.0, 2.0, 3.0]);
    let of = |normal: [f32; 3]| -> DpsmReceiver<f32> { dpsm_receiver(ordinary, point(normal)) };
    let oblique = of([0.0, 1.0, 0.0]);
    let cosines = [("facing", 1.0), ("oblique", 0.5), ("grazing", 0.001_745), ("edge-on", 0.0)];
    match function {
        "dpsm_receiver" => {
            cases.each(NORMALS, |normal| (ordinary, point(normal)));
            cases.each(POINTS, |p| (point(p), point([0.0, 0.6, -0.8])));
            cases.each(&[("light's own position, no normal", [0.0; 3])], |p| (point(p), point(p)));
        }
        "dpsm_receiver_cosine" => cases.each(NORMALS, of),
        "dpsm_receiver_distance" => {
            for (name, uv) in DISKS {
                let both = [format!("{name}, front"), format!("{name}, back")];
                cases.each(&[(&both[0], DPSM_FRONT)], |map| (oblique, disk(*uv), map));
                cases.each(&[(&both[1], DPSM_BACK)], |map| (oblique, disk(*uv), map));
            }
            cases.each(NORMALS, |normal| (of(normal), disk([0.25, 0.5]), DPSM_FRONT));
        }
        "dpsm_bias_slack" => {
            let distances = [("near", 0.1), ("far", 10.0), ("none", 0.0)];
            cases.each(&distances, |l| (l, layers, SLACK));
            cases.each(&distances, |l| (l, layers, (0.0, 0.0)));
        }
        "dpsm_bias_window" => {
            cases.each(DISKS, |uv| (disk(uv), 0.5, layers));
            cases.each(WINDOWS, |texels| (disk([0.3, -0.4]), texels, layers));
        }
        "dpsm_bias_plane" => {
            let chords = [("chord 1/64", 1.0 / 4096.0), ("none", 0.0), ("90 degrees", 2.0)];
            for (chord, square) in chords {
                for (name, cosine) in cosines {
                    let name = format!("{name}, {chord}");
                    cases.each(&[(name, cosine)], |cosine| (cosine, 3.0, square, layers));
                }
            }
        }
        "dpsm_bias_footprint" => {
            cases.each(NORMALS, |normal| (of(normal), disk([0.3, -0.4]), 0.5, layers));
            cases.each(WINDOWS, |texels| (oblique, disk([0.6, 0.8]), texels, layers));
        }
        "dpsm_bias_without_normal" => {
            cases.each(&cosines, |cosine| (3.0, cosine, disk([0.3, -0.4]), (0.5, layers)));
        }
        "dpsm_texel_centre" => {
            cases.each(DISKS, |uv| (disk(uv), layers));
            let edge = 1.0 + GUARD;
            let corners = [("a corner", [edge, -edge]), ("outside the map", [-2.0, 3.0])];
            cases.each(&corners, |uv| (disk(uv), layers));
        }
        "dpsm_lookup_texel_centre" | "dpsm_lookup_texel_centre_or_own" => {
            for (name, p) in POINTS {
                let of = |light| {
                    let p = point(*p);
                    (p, dpsm_receiver(p, point([0.0, 0.6, -0.8])), light, SLACK)
                };
                cases.each(&[(format!("{name}, layers"), layers)], of);
                cases.each(&[(format!("{name}, atlas"), light(DPSM_ATLAS))], of);
            }
            cases.each(NORMALS, |normal| (ordinary, of(normal), layers, SLACK));
        }
        "dpsm_lookup_along_centre" => {
            let most = [("nothing", 0.0), ("own", 3.741_657_5), ("far", 10.0)];
            cases.each(&most, |most| (ordinary, oblique, most, (layers, SLACK)));
        }
        "dpsm_cube_slack" => {
            let distances = [("near", 0.1), ("far", 10.0), ("behind", -1.0)];
            cases.each(&distances, |z| (z, layers, SLACK.0));
        }
        "dpsm_cube_lookup_along_centre" => {
            cases.each(POINTS, |p| {
                let p = point(p);
                (p, dpsm_receiver(p, point([0.0, 0.6, -0.8])), 3.0, (layers, SLACK.0))
            });
            cases.each(NORMALS, |normal| (ordinary, of(normal), 10.0, (layers, SLACK.0)));
        }
        "dpsm_cube_lookup_footprint" => {
            cases.each(POINTS, |p| {
                let p = point(p);
                (p, dpsm_receiver(p, point([0.0, 0.6, -0.8])), 0.5, (layers, SLACK.0))
            });
            cases.each(NORMALS, |normal| (ordinary, of(normal), 1.0, (layers, SLACK.0)));
        }
        "dpsm_cube_lookup_without_normal" => {
            cases.each(POINTS, |p| (point(p), 0.5, 0.5, (layers, SLACK.0)));
        }
        "dpsm_cube_lookup_rising" => {
            cases.each(POINTS, |p| (point(p), 1.0, 0.01, (layers, SLACK.0)));
        }
        "dpsm_lookup_biased" => cases.each(POINTS, |p| (point(p), 0.01, layers, SLACK)),
        _ => {}
    }
}
