//! The cases of the filters' modules: kernel, filter, pcss and lights.

use super::domain::{Finite, all as any, projected, received, sized, up_to, when};
use super::values::*;
use super::{Cases, disk, point};
use crate::scalar::bias::dpsm_receiver;
use crate::scalar::filter::{DPSM_TAP_HARD, DPSM_TAP_LINEAR, DpsmTaps, dpsm_filter_reader};
use crate::scalar::float::Vec2;
use crate::scalar::kernel::{DpsmKernel, DpsmTap};
use crate::scalar::light::DpsmLight;
use crate::scalar::pcss::DpsmBlockers;
use crate::scalar::visibility::DpsmLookup;

/// Adds a function's cases.
pub fn add(function: &str, cases: &mut Cases) {
    // half of it beyond the rim
    let kernel = DpsmKernel { axis: Vec2::new(0.6_f32, 0.8), reach: 0.125, hemisphere: 1 };
    let kernels = |p| sized(-51, 50, p);
    let slanted = point([3.0, 4.0, -1.0]);
    let taps = |kind| DpsmTaps { count: 16, kind, quantum: 1e-5_f32, tolerance: 1e-3 };
    let receiver = dpsm_receiver(point([1.0, 2.0, -0.5]), point([0.0, 0.6, 0.8]));
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
                    let facing = dpsm_receiver(point(p), point([0.0, 0.6, -0.8]));
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
            let found = DpsmBlockers { tangents: 0.5, count: 2, unmapped: 1 };
            let receiver = dpsm_receiver(point([3.0, 4.0, 0.0]), point([0.6, 0.8, 0.0]));
            for (mapped, name) in [(true, ""), (false, ", unmapped")] {
                let coordinates = Vec2::new(0.5, 0.5);
                let at = DpsmLookup { coordinates, depth: 0.3, layer: 6, hemisphere: 0, mapped };
                let stored = |stored: f32| when((0.0..=1.0).contains(&stored));
                cases
                    .named(&DEPTHS, name, stored, |depth| (found, depth, at, receiver, LIGHT, 0.1));
            }
        }
        "dpsm_pcss_width" => cases.each(&COUNTS, any, |count| {
            (DpsmBlockers { tangents: 0.5, count, unmapped: 0 }, 1.0 / 128.0)
        }),
        "dpsm_lights_turn" => {
            cases.each(&POINTS, |p| up_to(62, p), |p| (point(p), LIGHT));
            cases.each(&LIGHTS, any, |light| (slanted, light));
        }
        _ => {}
    }
}
