//! The ranges of the functions' results.

/// Rounding that a range may be missed by: the largest bound of a result of size 1.
const ROUNDING: f64 = 64.0 / (1u64 << 23) as f64;

/// True where a result, its integers as numbers, is one that the function may give.
pub fn in_range(function: &str, result: &[f64]) -> bool {
    let slack = |value: f64| ROUNDING * value.abs().max(1.0);
    let between = |i: usize, low: f64, high: f64| {
        low - slack(low) <= result[i] && result[i] <= high + slack(high)
    };
    let flag = |i: usize| result[i] == 0.0 || result[i] == 1.0;
    let positive = |i: usize| result[i] >= 0.0;
    let square = |parts: &[f64]| parts.iter().map(|c| c * c).sum::<f64>();
    let unit = |parts: &[f64]| (square(parts) - 1.0).abs() <= 2.0 * ROUNDING;
    let unit_or_zero = |parts: &[f64]| unit(parts) || parts.iter().all(|&c| c == 0.0);
    let disk = |i: usize| square(&result[i..i + 2]) <= 1.0 + 2.0 * ROUNDING;
    // coordinates, depth less bias, hemisphere or face, mapped; the layer has a test of its own
    let lookup = |deepest: f64, faces: f64| {
        between(0, 0.0, 1.0)
            && between(1, 0.0, 1.0)
            && between(2, deepest, 1.0)
            && between(4, 0.0, faces)
            && flag(5)
    };
    // 2^25 (docs/paraboloid.md)
    let pole = (1u64 << 25) as f64;
    match function {
        "dpsm_hemisphere"
        | "dpsm_within"
        | "dpsm_caster_keep"
        | "dpsm_edge_ordered"
        | "dpsm_refine_long"
        | "dpsm_refine_splits"
        | "dpsm_refine_fat"
        | "dpsm_refine_flat"
        | "dpsm_refine_foot"
        | "dpsm_refine_outside"
        | "dpsm_triangle_covers"
        | "dpsm_classify_usable"
        | "dpsm_classify_misses"
        | "dpsm_cube_outside" => flag(0),
        "dpsm_invert" | "dpsm_project" => result.iter().all(|c| c.abs() <= pole * (1.0 + ROUNDING)),
        "dpsm_project_own" => disk(0),
        "dpsm_unproject" | "dpsm_kernel_turn" | "dpsm_kernel_rotation" => {
            function == "dpsm_kernel_turn" && square(result) == 0.0 || unit(result)
        }
        "dpsm_texel_width" | "dpsm_texel_pitch" => positive(0) && between(0, 0.0, 8.0),
        "dpsm_receiver_depth"
        | "dpsm_cube_depth"
        | "dpsm_cube_receiver_depth"
        | "dpsm_receiver_cosine"
        | "dpsm_lambert"
        | "dpsm_highlight" => between(0, 0.0, 1.0),
        "dpsm_caster_border" => between(0, -0.6, 0.0),
        "dpsm_caster_fragment" | "dpsm_triangle_fragment" => flag(1),
        "dpsm_caster_vertex" => result[3] == 1.0,
        "dpsm_lookup" => lookup(0.0, 1.0),
        "dpsm_lookup_texel_centre" | "dpsm_filter_lookup" => lookup(-1.0, 1.0),
        // the slack grows with the receiver's distance, beyond far too
        "dpsm_lookup_biased" => lookup(f64::MIN, 1.0),
        "dpsm_cube_lookup" => lookup(0.0, 5.0),
        name if name.starts_with("dpsm_cube_lookup_") => lookup(-1.0, 5.0),
        "dpsm_cube_face" => between(0, 0.0, 5.0),
        "dpsm_tessellate_level" => between(0, 1.0, 32768.0),
        "dpsm_edge_unit" | "dpsm_edge_normal" => unit_or_zero(result),
        "dpsm_edge_largest"
        | "dpsm_texel_solid_angle"
        | "dpsm_refine_reach"
        | "dpsm_bias_slack"
        | "dpsm_cube_slack"
        | "dpsm_bias_plane"
        | "dpsm_bias_footprint"
        | "dpsm_kernel_tangent"
        | "dpsm_triangle_distance"
        | "dpsm_triangle_behind"
        | "dpsm_receiver_distance"
        | "dpsm_pcss_width" => positive(0),
        "dpsm_classify_flat_error" => positive(0) && positive(1),
        "dpsm_triangle_plane" => unit_or_zero(&result[..3]),
        // at less than 2^-51 without a normal it is shorter
        "dpsm_receiver" => {
            let near = result[4] <= 1.0 / (1u64 << 51) as f64;
            (near || unit_or_zero(&result[..3])) && positive(3) && positive(4)
        }
        "dpsm_bias_window" => between(0, 0.0, 2.0),
        "dpsm_texel_centre" => result.iter().all(|c| c.abs() <= 2.0),
        "dpsm_classify" => between(0, 0.0, 3.0),
        "dpsm_refine_corners" => result.iter().all(|corner| (0.0..=5.0).contains(corner)),
        "dpsm_refine_edge" => between(0, 0.0, 6.0),
        "dpsm_refine_turned" => between(0, 0.0, 5.0),
        "dpsm_part_kind" => between(0, 0.0, 2.0),
        "dpsm_part" | "dpsm_part_half" => result.chunks(3).all(unit_or_zero),
        "dpsm_kernel" => disk(0) && between(2, 0.0, 1.0) && flag(3),
        "dpsm_kernel_disk" => positive(2),
        "dpsm_kernel_tap" | "dpsm_kernel_mirrored" | "dpsm_kernel_projected" => disk(0) && flag(2),
        "dpsm_kernel_ring" | "dpsm_kernel_guard" | "dpsm_cube_guard" | "dpsm_pcss_tangent" => {
            between(0, 0.0, 1.0)
        }
        // any finite numbers
        _ => true,
    }
}
