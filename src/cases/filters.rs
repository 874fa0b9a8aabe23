//! The cases of the filters' modules: plane, kernel, filter, pcss and lights.

use super::domain::{Finite, all as any, projected, received, sized, up_to, when};
use super::values::*;
use super::{Cases, disk, point};
use crate::scalar::bias::dpsm_receiver;
use crate::scalar::filter::{
    DPSM_TAP_HARD, DPSM_TAP_LINEAR, DpsmContact, DpsmTaps, dpsm_filter_cone, dpsm_filter_reader,
};
use crate::scalar::float::{Vec2, Vec4};
use crate::scalar::kernel::{DpsmKernel, DpsmTap};
use crate::scalar::light::DpsmLight;
use crate::scalar::pcss::DpsmBlockers;
use crate::scalar::plane::dpsm_plane;

/// Adds a function's cases.
pub fn add(function: &str, cases: &mut Cases) {
    // half of it beyond the rim
    let kernel = DpsmKernel { axis: Vec2::new(0.6_f32, 0.8), reach: 0.125, hemisphere: 1 };
    let kernels = |p| sized(-51, 50, p);
    let slanted = point([3.0, 4.0, -1.0]);
    let taps = |kind| DpsmTaps { count: 16, kind, quantum: 1e-5_f32, tolerance: 1e-3 };
    let receiver = dpsm_receiver(point([1.0, 2.0, -0.5]), point([0.0, 0.6, 0.8]), 0.0);
    const PLAIN: [f32; 3] = [3.0, 4.0, -1.0];
    let facing = point([0.0, 0.6, -0.8]);
    let at = |p: [f32; 3]| {
        dpsm_plane(point(p), dpsm_receiver(point(p), facing, 0.0), 0.45_f32, LIGHT, 1e-5, 1e-3)
    };
    let turned = Vec2::new(0.6_f32, 0.8);
    let disk_of = |p: [f32; 3]| dpsm_filter_cone(at(p), 0.125, 0.0625, turned);
    let own = Vec4::new(0.5_f32, 0.5, 0.498, 0.498);
    let offset = Vec2::new(0.3_f32, -0.4);
    let four = |depth: f32| Vec4::new(depth, 1.0, 0.25, 0.0);
    let stored = |depth: f32| when((0.0..=1.0).contains(&depth));
    match function {
        "dpsm_kernel_tangent" => {
            // a radius up to 2^10 |p|
            let domain = |p| projected(p).min(sized(-12, 63, p).max(Finite));
            cases.each(&POINTS, domain, |p| (point(p), 0.25));
        }
        "dpsm_kernel" | "dpsm_kernel_disk" => {
            cases.each(&POINTS, kernels, |p| (point(p), 0.125));
            cases.each(&TANGENTS, any, |tangent| (slanted, tangent));
        }
        "dpsm_kernel_tap" | "dpsm_kernel_mirrored" => {
            cases.each(&OFFSETS, any, |offset| (kernel, disk(offset)));
            cases.named(&OFFSETS, ", from the pole", any, |offset| {
                (DpsmKernel { axis: Vec2::splat(0.0), reach: 1.0, ..kernel }, disk(offset))
            });
        }
        "dpsm_kernel_projected" => {
            cases.each(&POINTS, kernels, |p| (point(p), 0.125, disk([0.6, 0.8])));
            cases.each(&TANGENTS, any, |t| (slanted, t, disk([0.6, 0.8])));
            cases.each(&OFFSETS, any, |offset| (slanted, 0.125, disk(offset)));
        }
        "dpsm_kernel_ring" => cases.each(&RINGS, any, |[index, count]| (index, count)),
        "dpsm_kernel_turn" => {
            cases.each(&OFFSETS, any, |direction| (disk(direction),));
        }
        "dpsm_kernel_rotation" => cases.each(&PIXELS, any, |pixel| (pixel,)),
        "dpsm_kernel_guard" => cases.each(&SIDES, any, |[size, side]| (size, side)),
        "dpsm_filter_lookup" => {
            for (kind, name) in [(DPSM_TAP_HARD, ", hard"), (DPSM_TAP_LINEAR, ", linear")] {
                let read = |uv, receiver, light: DpsmLight<f32>| {
                    let tap = DpsmTap { uv: disk(uv), hemisphere: 1 };
                    (dpsm_filter_reader(receiver, light, taps(kind)), tap, light)
                };
                cases.named(&TAPS, name, any, |uv| read(uv, receiver, LIGHT));
                cases.named(&LIGHTS, name, any, |light| read(TAPS.rows[1].1, receiver, light));
                cases.named(&POINTS, name, received, |p| {
                    let facing = dpsm_receiver(point(p), point([0.0, 0.6, -0.8]), 0.0);
                    read(TAPS.rows[1].1, facing, LIGHT)
                });
            }
        }
        "dpsm_filter_reader" => {
            cases.each(&LIGHTS, any, |light| (receiver, light, taps(DPSM_TAP_HARD)));
            let of = |size| (receiver, DpsmLight { size, ..LIGHT }, taps(DPSM_TAP_LINEAR));
            cases.each(&SIZES, any, of);
        }
        "dpsm_pcss_tangent" => {
            // distances below 2^-51 are finite
            let domain = |[l, b]: [f32; 2]| {
                let least = l.min(b) >= 1.0 / (1u64 << 51) as f32;
                up_to(62, [l]).min(up_to(62, [b])).min(when(least).max(Finite))
            };
            cases.each(&GAPS, domain, |[distance, blocker]| (distance, blocker, 0.1));
        }
        "dpsm_pcss_found" => {
            let found =
                DpsmBlockers { farthest: Vec4::splat(-1.0), all: [true, false, true, true] };
            cases.each(&DEPTHS, stored, |depth| (found, disk_of(PLAIN), offset, 0.5, four(depth)));
        }
        "dpsm_pcss_width" => {
            let found = |depth| DpsmBlockers { farthest: four(depth), all: [false; 4] };
            cases.each(&DEPTHS, stored, |depth| (found(depth), 4.0, 1.0 / 128.0, 0.1, LIGHT));
            let none = DpsmBlockers { farthest: Vec4::splat(-1.0), all: [false; 4] };
            cases.each(&LIGHTS, any, |light| (none, 4.0, 1.0 / 128.0, 0.1, light));
        }
        "dpsm_pcss_ring" | "dpsm_filter_dense" => cases.each(&DEPTHS, stored, |share| (share,)),
        "dpsm_kernel_rings" => cases.each(&COUNTS, any, |count| (count,)),
        "dpsm_kernel_next" => cases.each(&OFFSETS, any, |direction| (disk(direction),)),
        "dpsm_filter_cone" => {
            cases.each(&POINTS, |p| sized(-51, 60, p), |p| (at(p), 0.125, 0.0625, turned));
            let tangents = |t: f32| when((1.0 / 16777216.0..=1.0).contains(&t));
            cases.each(&TANGENTS, tangents, |tangent| (at(PLAIN), tangent, 0.0625, turned));
        }
        "dpsm_filter_map" => {
            for (hemisphere, name) in [(0, ", front"), (1, ", back")] {
                cases.named(&LIGHTS, name, any, |light| (light, hemisphere));
            }
        }
        "dpsm_filter_layers" => cases.each(&LIGHTS, any, |light| (light, 1)),
        "dpsm_filter_places" => {
            cases.each(&OFFSETS, any, |offset| (disk_of(PLAIN), own, 0.5, disk(offset)));
            let points = |p| sized(-51, 60, p);
            cases.each(&POINTS, points, |p| (disk_of(p), own, 0.5, disk([0.6, 0.8])));
        }
        "dpsm_filter_step" => {
            cases.each(&OFFSETS, any, |offset| (disk_of(PLAIN), disk(offset)));
        }
        "dpsm_filter_lit" => {
            let reach = |p| sized(-51, 60, p);
            cases.each(&POINTS, reach, |p| (disk_of(p), offset, 0.5, four(0.25)));
            cases.each(&DEPTHS, stored, |depth| (disk_of(PLAIN), offset, 0.5, four(depth)));
        }
        "dpsm_filter_within" => {
            cases.each(&DEPTHS, stored, |depth| (disk_of(PLAIN), 0.5, four(depth)));
        }
        "dpsm_filter_share" => {
            let sums = [("none", 0.0), ("lit", 4.0), ("mixed", 2050.0), ("dark", 4096.0)];
            for (_, sum) in sums {
                cases.each(
                    &COUNTS,
                    |n| when(n < 1024),
                    |n| (Vec4::new(sum, n.min(1023) as f32, 1024.0, 0.0),),
                );
            }
        }
        "dpsm_filter_even" => {
            cases.each(&DEPTHS, stored, |depth| (disk_of(PLAIN), offset, 0.5, four(depth)));
        }
        "dpsm_filter_contact" => {
            let found = DpsmContact { sum: Vec4::splat(1.0), farthest: 0.125 };
            cases.each(&DEPTHS, stored, |depth| (found, disk_of(PLAIN), offset, 0.5, four(depth)));
        }
        "dpsm_plane" => {
            let facing = point([0.0, 0.6, -0.8]);
            let points = |p| sized(-51, 60, p);
            cases.each(&POINTS, points, |p| {
                (
                    point(p),
                    dpsm_receiver(point(p), facing, 0.0),
                    0.35_f32,
                    LIGHT,
                    1e-5_f32,
                    1e-3_f32,
                )
            });
            cases.each(&LIGHTS, any, |light| {
                (slanted, dpsm_receiver(slanted, facing, 0.0), 0.35_f32, light, 1e-5_f32, 1e-3_f32)
            });
            let normals = |n| super::domain::normals(n);
            cases.each(&NORMALS, normals, |n| {
                (slanted, dpsm_receiver(slanted, point(n), 0.0), 0.35_f32, LIGHT, 0.0_f32, 0.0_f32)
            });
        }
        "dpsm_plane_four" => {
            cases.each(&POINTS, |p| sized(-51, 60, p), |p| (at(p), LIGHT));
            cases.each(&LIGHTS, any, |light| (at(PLAIN), light));
        }
        "dpsm_plane_share" => {
            let places = Vec4::new(10.0, 20.0, 0.25, 0.5);
            cases.each(&DEPTHS, stored, |depth| (at(PLAIN), places, four(depth)));
            cases.each(&POINTS, |p| sized(-51, 60, p), |p| (at(p), places, four(0.25)));
        }
        "dpsm_plane_depths" => {
            cases.each(
                &POINTS,
                |p| sized(-51, 60, p),
                |p| (at(p), dpsm_receiver(point(p), facing, 0.25), LIGHT, 1e-5_f32, 1e-3_f32),
            );
        }
        "dpsm_lights_turn" => {
            cases.each(&POINTS, |p| up_to(62, p), |p| (point(p), LIGHT));
            cases.each(&LIGHTS, any, |light| (slanted, light));
        }
        _ => {}
    }
}
