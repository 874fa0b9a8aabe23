//! The cases of the filters' modules: kernel, filter, pcss and lights.

use super::{Cases, POINTS, disk, light, point};
use crate::scalar::bias::dpsm_receiver;
use crate::scalar::filter::{DPSM_TAP_HARD, DPSM_TAP_LINEAR, DpsmTaps, dpsm_filter_reader};
use crate::scalar::float::Vec2;
use crate::scalar::kernel::{DpsmKernel, DpsmTap};
use crate::scalar::light::{DPSM_ATLAS, DPSM_LAYERS, DpsmLight};
use crate::scalar::pcss::DpsmBlockers;
use crate::scalar::visibility::DpsmLookup;

/// Tangents of half-angles.
const TANGENTS: &[(&str, f32)] =
    &[("nothing", 0.0), ("a texel", 1.0 / 256.0), ("45 degrees", 1.0), ("nearly flat", 1024.0)];

/// Offsets in the unit disk.
const OFFSETS: &[(&str, [f32; 2])] =
    &[("middle", [0.0, 0.0]), ("outwards", [0.6, 0.8]), ("inwards", [-0.6, -0.8])];

/// Adds a function's cases.
pub fn add(function: &str, cases: &mut Cases) {
    // half of it beyond the rim
    let kernel = DpsmKernel { axis: Vec2::new(0.6_f32, 0.8), reach: 0.125, hemisphere: 1 };
    match function {
        "dpsm_kernel_tangent" => cases.each(POINTS, |p| (point(p), 0.25)),
        "dpsm_kernel" | "dpsm_kernel_disk" => {
            cases.each(POINTS, |p| (point(p), 0.125));
            cases.each(TANGENTS, |tangent| (point([3.0, 4.0, -1.0]), tangent));
        }
        "dpsm_kernel_tap" | "dpsm_kernel_mirrored" => {
            cases.each(OFFSETS, |offset| (kernel, disk(offset)));
        }
        "dpsm_kernel_projected" => {
            cases.each(POINTS, |p| (point(p), 0.125, disk([0.6, 0.8])));
            cases.each(TANGENTS, |t| (point([3.0, 4.0, -1.0]), t, disk([0.6, 0.8])));
        }
        "dpsm_kernel_ring" => {
            let rings = [("first of one", [0, 1]), ("first", [0, 16]), ("last", [15, 16])];
            cases.each(&rings, |[index, count]| (index, count));
        }
        "dpsm_kernel_turn" => cases.each(&OFFSETS[1..], |direction| (disk(direction),)),
        "dpsm_kernel_rotation" => {
            let pixels = [("first", [0, 0]), ("other", [959, 719]), ("largest", [u32::MAX; 2])];
            cases.each(&pixels, |pixel| (pixel,));
        }
        "dpsm_kernel_guard" => {
            let sizes = [("one texel", [1.0, 2.0]), ("512", [512.0, 2.0]), ("wide", [512.0, 7.0])];
            cases.each(&sizes, |[size, side]| (size, side));
        }
        "dpsm_filter_lookup" => {
            let receiver = dpsm_receiver(point([1.0, 2.0, -0.5]), point([0.0, 0.6, 0.8]));
            let both = [("hard", DPSM_TAP_HARD), ("linear", DPSM_TAP_LINEAR)];
            for (name, uv) in TAPS {
                let tap = DpsmTap { uv: disk(*uv), hemisphere: 1 };
                let named = both.map(|(kind, value)| (format!("{name}, {kind}"), value));
                cases.each(&named, |kind| {
                    let placement = if kind == DPSM_TAP_HARD { DPSM_LAYERS } else { DPSM_ATLAS };
                    let taps = DpsmTaps { count: 16, kind, quantum: 1e-5, tolerance: 1e-3 };
                    let light = light(placement);
                    (dpsm_filter_reader(receiver, light, taps), tap, light)
                });
            }
        }
        "dpsm_filter_reader" => {
            let receiver = dpsm_receiver(point([1.0, 2.0, -0.5]), point([0.0, 0.6, 0.8]));
            let taps = DpsmTaps { count: 16, kind: DPSM_TAP_HARD, quantum: 1e-5, tolerance: 1e-3 };
            let sizes = [("512", 512.0), ("one texel", 1.0), ("not a power of 2", 300.0)];
            cases.each(&sizes, |size| (receiver, DpsmLight { size, ..light(DPSM_LAYERS) }, taps));
        }
        "dpsm_pcss_tangent" => cases.each(GAPS, |[distance, blocker]| (distance, blocker, 0.1)),
        "dpsm_pcss_found" => {
            let found = DpsmBlockers { tangents: 0.5, count: 2, unmapped: 1 };
            let receiver = dpsm_receiver(point([3.0, 4.0, 0.0]), point([0.6, 0.8, 0.0]));
            let depths = [("nearer", 0.25), ("the same", 0.5), ("farther", 0.75)];
            for (name, mapped) in [("mapped", true), ("unmapped", false)] {
                let coordinates = Vec2::new(0.5, 0.5);
                let at = DpsmLookup { coordinates, depth: 0.5, layer: 6, hemisphere: 0, mapped };
                let named = depths.map(|(depth, value)| (format!("{depth}, {name}"), value));
                cases.each(&named, |stored| (found, stored, at, receiver, light(DPSM_LAYERS), 0.1));
            }
        }
        "dpsm_pcss_width" => {
            let counts = [("none", 0), ("two", 2)];
            cases.each(&counts, |count| {
                (DpsmBlockers { tangents: 0.5, count, unmapped: 0 }, 1.0 / 128.0)
            });
        }
        "dpsm_lights_turn" => cases.each(POINTS, |p| (point(p), light(DPSM_LAYERS))),
        _ => {}
    }
}

/// Places of taps.
const TAPS: &[(&str, [f32; 2])] =
    &[("middle", [0.0, 0.0]), ("rim", [0.6, 0.8]), ("behind the plane", [-0.6, -0.8])];

/// Distances of receivers and blockers.
const GAPS: &[(&str, [f32; 2])] = &[
    ("halfway", [2.0, 1.0]),
    ("contact", [2.0, 2.0]),
    ("behind", [2.0, 3.0]),
    ("at the light", [2.0, 0.0]),
    ("both at the light", [0.0, 0.0]),
];
