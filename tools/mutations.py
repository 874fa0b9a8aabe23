#!/usr/bin/env python3
"""Applies deliberate mistakes one at a time and checks that the named test catches each.

Run from a clean checkout: it changes files under src/ and wgsl/ and puts them back.
    tools/mutations.py [PART OF A TEST'S NAME]
"""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# file, right, wrong, test file, test
PORT = "src/scalar/"
MUTATIONS = [
    ("hemisphere.rs", "DPSM_FRONT, p.z >= T::lit(0.0)", "DPSM_FRONT, p.z > T::lit(0.0)",
     "hemisphere", "seam_itself_is_in_front_with_either_sign_of_zero"),
    ("hemisphere.rs", "select(p.z, -p.z, hemisphere == DPSM_BACK)", "p.z",
     "hemisphere", "flip_mirrors_the_back_alone_and_undoes_itself"),
    ("hemisphere.rs", "    uv / square\n", "    uv * (T::lit(2.0) / square.sqrt() - T::lit(1.0))\n",
     "hemisphere", "inversion_is_the_same_direction_in_the_other_map"),
    ("hemisphere.rs", "    uv / square\n", "    uv * (T::lit(1.00001) / square)\n",
     "hemisphere", "inversion_is_the_same_direction_in_the_other_map"),
    ("hemisphere.rs", "if square <= T::lit(1.0 / (DPSM_POLE_RADIUS * DPSM_POLE_RADIUS))",
     "if square < T::lit(0.0)", "hemisphere", "centre_goes_to_the_other_pole"),
    ("hemisphere.rs", "let p = world - light.position;",
     "let p = world - light.position + light.right * T::lit(1e-9);",
     "hemisphere", "light_space_is_a_rotation_about_the_light"),
    ("hemisphere.rs",
     "    let p = world - light.position;\n    Vec3::new(light.right.dot(p), light.up.dot(p), light.forward.dot(p))",
     "    let r = |row: Vec3<T>| row.dot(world) - row.dot(light.position);\n    Vec3::new(r(light.right), r(light.up), r(light.forward))",
     "hemisphere", "light_space_stays_within_its_bound_far_from_the_origin"),
    ("hemisphere.rs", "light.right.dot(p), light.up.dot(p)", "light.up.dot(p), light.right.dot(p)",
     "hemisphere", "light_space_is_a_rotation_about_the_light"),
    ("paraboloid.rs", "(p.length() + p.z.abs())", "(p.length() + p.z)",
     "paraboloid", "project_stays_within_its_bound_over_its_whole_domain"),
    ("paraboloid.rs", "    dpsm_invert(own)\n", "    p.xy() / (p.length() + p.z)\n",
     "paraboloid", "project_stays_within_its_bound_over_its_whole_domain"),
    ("paraboloid.rs", "    dpsm_invert(own)\n", "    own / own.dot(own)\n",
     "paraboloid", "directions_near_the_back_pole_stay_within_one_rounding_of_it"),
    ("paraboloid.rs", ".max(T::lit(DPSM_SMALLEST))", "",
     "paraboloid", "light_position_and_back_pole_have_defined_results"),
    ("paraboloid.rs", "uv.y + uv.y, one - square", "uv.y + uv.y, square - one",
     "paraboloid", "unproject_takes_project_back_to_the_direction"),
    ("paraboloid.rs", "Vec3::new(uv.x + uv.x, uv.y + uv.y, one - square) / (one + square)",
     "{ let d = Vec3::new(uv.x + uv.x, uv.y + uv.y, one - square); let k = one / d.length(); d * k * (one + T::lit(1e-6)) }",
     "paraboloid", "unproject_stays_within_its_bound"),
    ("paraboloid.rs", "T::lit(4.0) * (T::lit(1.0) + guard)", "T::lit(4.0)",
     "paraboloid", "texel_pitch_is_the_angle_across_a_texel_in_both_directions"),
    ("paraboloid.rs", "size + size * uv.dot(uv)", "size + size * uv.length()",
     "paraboloid", "texel_pitch_is_the_angle_across_a_texel_in_both_directions"),
    ("paraboloid.rs", "    pitch * pitch\n", "    pitch\n",
     "paraboloid", "solid_angles_of_a_hemisphere_add_up_to_half_the_sphere"),
    ("paraboloid.rs", "Vec2::new(uv.x, -uv.y) * half", "uv * half",
     "paraboloid", "stored_disk_fills_the_texture_and_y_points_down"),
    ("paraboloid.rs", " * half / (T::lit(1.0) + guard)", " * half",
     "paraboloid", "stored_disk_fills_the_texture_and_y_points_down"),
    ("paraboloid.rs", "Vec2::new(T::lit(2.0), T::lit(-2.0)) * (T::lit(1.0) + guard)",
     "Vec2::new(T::lit(2.0), T::lit(-2.0))",
     "paraboloid", "texture_coordinates_and_back_stay_within_their_bounds"),
    ("light.rs", "    pub near: T,\n    /// Light space's +x in world space; right, up, forward are orthonormal.\n    pub right: Vec3<T>,",
     "    pub right: Vec3<T>,\n    /// Moved.\n    pub near: T,",
     "light", "layout_is_the_same_in_rust_and_in_the_shader"),
    ("light.rs", "select(hemisphere, 0, light.placement == DPSM_ATLAS)", "hemisphere",
     "light", "layers_hold_one_hemisphere_each_and_an_atlas_holds_both"),
    ("light.rs", "(st + beside) * light.rectangle.zw()", "st * light.rectangle.zw()",
     "light", "back_map_begins_in_an_atlas_where_the_front_map_ends"),
    ("depth.rs", "(l - near) / (far - near)", "l / far",
     "depth", "spheres_store_zero_and_one_exactly"),
    ("depth.rs", "(l - near) / (far - near)", "(l - near) * (T::lit(1.0) / (far - near))",
     "depth", "spheres_store_zero_and_one_exactly"),
    ("depth.rs", "near + depth * (far - near)", "depth * (far - near)",
     "depth", "distance_of_a_depth_is_the_distance_again"),
    ("depth.rs", "l >= near && l <= far", "l > near && l < far",
     "depth", "both_spheres_are_within"),
    ("depth.rs", ".clamp(T::lit(0.0), T::lit(1.0))", "",
     "depth", "receivers_outside_the_spheres_compare_at_the_spheres"),
    ("caster.rs", "(one - square) / (one + square)", "T::lit(0.0) * square",
     "caster", "border_is_the_height_of_the_guard_bands_edge"),
    ("caster.rs", "dpsm_project(p) / (T::lit(1.0) + light.guard)", "dpsm_project(p)",
     "caster", "stored_disk_ends_at_the_guard_band"),
    ("caster.rs", "p.z >= l * dpsm_caster_border(light.guard)", "p.z >= T::lit(0.0)",
     "caster", "stored_disk_ends_at_the_guard_band"),
    ("caster.rs", "hemisphere_value >= T::lit(0.5)", "hemisphere_value > T::lit(0.5)",
     "caster", "without_a_guard_band_the_seam_is_kept_on_both_sides"),
    ("caster.rs", "inside && dpsm_within(l, light.near, light.far)", "inside",
     "caster", "fragments_outside_the_clipping_spheres_are_discarded"),
    ("caster.rs", "let depth = dpsm_depth(l, light.near, light.far) + bias;",
     "let depth = dpsm_depth(l, light.near, light.far) - bias;",
     "caster", "bias_moves_the_stored_depth_away_from_the_light"),
    ("visibility.rs", "let disk = dpsm_project(dpsm_flip(p, hemisphere));", "let disk = dpsm_project(p);",
     "visibility", "points_behind_the_cap_are_in_shadow_and_no_others"),
    ("visibility.rs", "layer: dpsm_light_layer(light, hemisphere)",
     "layer: dpsm_light_layer(light, 1 - hemisphere)",
     "visibility", "points_behind_the_cap_are_in_shadow_and_no_others"),
    ("visibility.rs", "dpsm_disk_to_texture(disk, light.guard)", "dpsm_disk_to_texture(disk, T::lit(0.0))",
     "visibility", "points_behind_the_cap_are_in_shadow_and_no_others"),
    ("visibility.rs", "select(T::lit(0.0), lit, at.mapped)", "lit",
     "visibility", "back_of_a_hemispherical_light_is_always_in_shadow"),
    ("visibility.rs", "at.depth - bias);", "at.depth + bias);",
     "visibility", "equal_depth_is_lit_and_one_float_less_in_the_map_is_shadow"),
    ("maps.rs", "reference <= stored", "reference < stored",
     "visibility", "equal_depth_is_lit_and_one_float_less_in_the_map_is_shadow"),
    ("visibility.rs", "dpsm_receiver_depth(p.length(), light.near, light.far)",
     "dpsm_depth(p.length(), light.near, light.far)",
     "visibility", "empty_maps_shadow_nothing_even_beyond_far"),
    ("visibility.rs", "back: dpsm_disk_to_texture(back, light.guard)",
     "back: dpsm_disk_to_texture(front, light.guard)",
     "visibility", "lookup_by_vertex_is_the_lookup_by_pixel_at_the_vertices"),
    ("maps.rs", "let (x, y) = (x - 0.5, y - 0.5);", "",
     "visibility", "linear_sampling_weighs_the_four_comparisons"),
    ("shade.rs", "ambient + (diffuse + specular) * visibility", "(ambient + diffuse + specular) * visibility",
     "shade", "shadow_leaves_the_ambient_light_alone"),
    ("shade.rs", "normal.dot(to_light).max(T::lit(0.0))", "normal.dot(to_light)",
     "shade", "surfaces_that_face_away_catch_no_light"),
    ("shade.rs", "    sixteenth * sixteenth\n", "    sixteenth\n",
     "shade", "highlight_is_the_32nd_power_of_the_halfway_cosine"),
    # the measures
    ("src/measure/map.rs", "hit: bench.first_distance(uv, layer)", "hit: bench.first_distance(uv, 1 - layer)",
     "measure", "exact_maps_have_no_map_error"),
    ("src/measure/map.rs", "(f64::from(y) + 0.5) / size", "1.0 - (f64::from(y) + 0.5) / size",
     "measure", "exact_maps_have_no_map_error"),
    ("src/measure/map.rs", "dpsm_distance(f64::from(depth), bench.light.near, bench.light.far)",
     "dpsm_distance(f64::from(depth), 0.0, bench.light.far)",
     "measure", "exact_maps_have_no_map_error"),
    ("src/measure/map.rs", "(None, Some(_)) => band.missing += 1", "(None, Some(_)) => band.extra += 1",
     "measure", "missing_and_extra_texels_are_counted"),
    ("src/measure/mod.rs", "world(dpsm_flip(dpsm_unproject(uv), hemisphere))",
     "world(dpsm_flip(dpsm_unproject(Vec2::new(uv.x, -uv.y)), hemisphere))",
     "measure", "measures_of_a_box_agree_with_its_closed_form"),
    ("src/measure/mod.rs", "            near: self.light.near,\n            far: self.light.far,", "",
     "measure", "measures_of_a_box_agree_with_its_closed_form"),
    ("src/measure/shadow.rs", "point.world, point.triangle, bench.light.near)", "point.world, point.triangle, 0.0)",
     "measure", "measures_of_a_box_agree_with_its_closed_form"),
    ("src/measure/shadow.rs", "Sampling::Linear => 1.0", "Sampling::Linear => 0.0",
     "measure", "footprint_of_linear_sampling_is_wider_than_that_of_the_hard_test"),
    ("src/measure/shadow.rs", "let seam = r >=", "let seam = r > 9.0 + ",
     "measure", "faults_are_sorted_by_seam_angle_and_bias"),
    ("src/measure/shadow.rs", "let radians = distance *", "let radians = 7.0 * distance *",
     "measure", "faults_are_sorted_by_seam_angle_and_bias"),
    ("src/measure/shadow.rs", "(judgement.stored - occluder).abs() < judgement.own - judgement.stored",
     "judgement.stored < judgement.own", "measure", "faults_are_sorted_by_seam_angle_and_bias"),
    ("src/measure/shadow.rs", "(judgement.stored - occluder).abs() < judgement.own - judgement.stored",
     "judgement.stored > occluder + 9.0", "measure",
     "contact_gap_is_the_distance_to_the_occluder_that_the_bias_forgives"),
    ("src/measure/attribution.rs", "filter(|gap| *gap <= bias)", "filter(|gap| *gap <= 0.5 * bias)",
     "measure", "contact_gap_is_the_distance_to_the_occluder_that_the_bias_forgives"),
    ("src/measure/attribution.rs", "phi * phi / 6.0 *", "phi * phi / 12.0 *",
     "measure", "affine_depth_of_small_triangles_stays_within_its_bound"),
    ("src/measure/map.rs", "if r > 1.0 {", "if r > 1.5 {", "measure", "exact_maps_have_no_map_error"),
    ("src/measure/map.rs", "band.off_1e2 = above(1e-2)", "band.off_1e2 = above(1e-1)",
     "measure", "texels_are_counted_by_how_far_they_are_off"),
    ("src/measure/map.rs", "band.off_1e3 = above(1e-3)", "band.off_1e3 = above(1e-2)",
     "measure", "texels_are_counted_by_how_far_they_are_off"),
    ("src/measure/shadow.rs", "occluder.is_none() && !unmapped", "occluder.is_some() && !unmapped",
     "measure", "point_under_the_covers_border_is_an_edge_point_and_others_are_not"),
    ("src/measure/shadow.rs", "is_none_or(|reaches| reaches != sees)", "is_none_or(|reaches| reaches == sees)",
     "measure", "point_under_the_covers_border_is_an_edge_point_and_others_are_not"),
    ("src/measure/shadow.rs", "own - hit.distance", "0.25 * hit.distance",
     "measure", "point_under_the_covers_border_is_an_edge_point_and_others_are_not"),
    ("src/measure/shadow.rs", "(texels * bench.texel())", "(texels * 1.1 * bench.texel())",
     "measure", "misclassified_points_are_as_far_from_the_true_edge_as_they_were_put"),
    ("src/measure/shadow.rs", "            false => {\n                error.false_light += 1;",
     "            false => {\n                error.false_shadow += 1;",
     "measure", "misclassified_points_are_as_far_from_the_true_edge_as_they_were_put"),
    ("src/measure/penumbra.rs", "lit += u32::from(reaches)", "lit += u32::from(!reaches)",
     "measure", "coverage_of_a_cone_that_the_border_halves_is_one_half"),
    ("src/measure/penumbra.rs", "axis * cosine + (side * cos + other * sin) * sine",
     "axis * cosine + (side * cos + other * sin + side) * sine",
     "measure", "coverage_of_a_cone_that_the_border_halves_is_one_half"),
    ("src/measure/attribution.rs", "bow * scale, chord", "2.0 * bow * scale, chord",
     "measure", "walls_of_8_x_8_quads_bow_half_a_texel_and_err_by_one_and_a_half_percent"),
    ("src/measure/attribution.rs", "chord * chord * lean / 8.0", "chord * chord / 8.0 * 0.5",
     "measure", "walls_of_8_x_8_quads_bow_half_a_texel_and_err_by_one_and_a_half_percent"),
    ("src/measure/attribution.rs", "(affine - p.length()).abs() / p.length()", "(affine - p.length()).abs()",
     "measure", "walls_of_8_x_8_quads_bow_half_a_texel_and_err_by_one_and_a_half_percent"),
    ("src/measure/attribution.rs", "(10.5 * p.widen().length() + 4.5 * near)", "1e-3",
     "measure", "sources_stay_within_their_bounds"),
    ("src/measure/attribution.rs", "let stored = format.store(exact as f32);",
     "let stored = format.store(exact as f32) + format.quantum() + 1e-6;",
     "measure", "sources_stay_within_their_bounds"),
    ("src/measure/attribution.rs", "st.x.floor() + 0.5, st.y.floor() + 0.5", "st.x.floor(), st.y.floor() - 1.0",
     "measure", "sources_stay_within_their_bounds"),
    ("src/measure/attribution.rs", "filter(|gap| *gap <= bias)", "filter(|gap| *gap <= 2.0 * bias)",
     "measure", "sources_stay_within_their_bounds"),
    ("src/scalar/maps.rs", "reference <= stored", "reference >= stored",
     "measure", "doubling_every_stored_value_lights_some_shadows_and_darkens_nothing"),
    ("src/scalar/maps.rs", "mix(row(top), row(top.saturating_add(1)), y - y.floor())", "row(top)",
     "visibility", "linear_sampling_weighs_the_four_comparisons"),
    ("src/measure/mod.rs", "let mut rng = Rng::with_seed(seed);\n        let mut total",
     "let mut rng = Rng::with_seed(0);\n        let mut total", "measure", "same_seed_gives_the_same_points"),
    # the modules and the host, on an adapter
    ("wgsl/paraboloid.wesl", "return dpsm_invert(own);", "return p.xy / (length(p) + p.z);",
     "adapter", "every_function_agrees_with_its_port"),
    ("wgsl/caster.wesl", "fn dpsm_caster_border", "fn dpsm_caster_edge",
     "adapter", "ports_and_modules_declare_the_same_functions_in_the_same_order"),
    ("wgsl/visibility.wesl", "at.depth - bias);", "at.depth + bias);",
     "adapter", "sampling_functions_agree_with_their_ports"),
    ("src/gpu/evaluate.rs", "*word += 1;", "*word += 1; if *word == 8 { *word = 7; }",
     "adapter", "values_far_apart_in_one_struct_keep_their_places"),
    ("src/gpu/texels.wesl", "row % size.y", "size.y - 1u - row % size.y",
     "adapter", "depths_survive_upload_and_download_in_each_format"),
    ("src/gpu/caster.wesl", "let p = dpsm_flip(dpsm_to_light(position, light), hemisphere);\n    let v = dpsm_caster_vertex(p, light, NO_BIAS);\n    return VertexMethod",
     "let p = dpsm_flip(dpsm_to_light(position, light), 1u - hemisphere);\n    let v = dpsm_caster_vertex(p, light, NO_BIAS);\n    return VertexMethod",
     "render", "adapter_renders_what_the_ports_render"),
    ("src/gpu/camera.wesl", "fn pixel_lookup(v: Vertex) -> Surface {\n    let p = dpsm_to_light(v.position, camera.light);",
     "fn pixel_lookup(v: Vertex) -> Surface {\n    let p = dpsm_to_light(v.position, camera.light).yxz;",
     "render", "adapter_renders_what_the_ports_render"),
    ("src/render.rs", "guard: guard_band(settings.size),", "guard: 0.2,",
     "render", "ports_render_the_committed_pictures"),
    ("src/cpu/mod.rs", "if keep && (0.0..=1.0).contains(&depth)", "if (0.0..=1.0).contains(&depth)",
     "render", "closed_room_fills_both_maps_and_nothing_outside_their_disks"),
]


def caught(test_file, test):
    """True when the test runs and fails; a mistake that does not compile proves nothing."""
    features = {
        "adapter": [], "render": [], "light": [],
        "measure": ["--no-default-features", "--features", "scene"],
    }.get(test_file, ["--no-default-features"])
    command = ["cargo", "test", "--quiet", *features, "--test", test_file, "--", "--exact", test]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    return run.returncode != 0 and "1 failed" in run.stdout + run.stderr


def main():
    part = sys.argv[1] if len(sys.argv) > 1 else ""
    chosen = [m for m in MUTATIONS if part in m[4]]
    survived = 0
    for file, right, wrong, test_file, test in chosen:
        path = ROOT / (file if "/" in file else PORT + file)
        text = path.read_text()
        if right not in text:
            print(f"STALE     {path.name}: {right!r} is not there")
            survived += 1
            continue
        try:
            path.write_text(text.replace(right, wrong))
            if caught(test_file, test):
                print(f"caught    {path.name}: {test}", flush=True)
            else:
                print(f"SURVIVED  {path.name}: {wrong!r} was not caught by {test}", flush=True)
                survived += 1
        finally:
            path.write_text(text)
    print(f"{len(chosen) - survived} of {len(chosen)} mistakes caught")
    sys.exit(1 if survived else 0)


main()
