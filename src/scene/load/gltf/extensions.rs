//! Which extensions are read, which change no shadow, and what to do about the others.

/// Those that the loader reads.
const READ: [&str; 9] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Starts of names whose extensions add pictures, sounds, physics or descriptions, and leave the
/// triangles where they are; animations among them, as a scene is read in the pose of its nodes.
const HARMLESS: [&str; 31] = [
    "ADOBE_materials_",
    "AGI_stk_metadata",
    "CESIUM_primitive_outline",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_lights_",
    "EXT_materials_",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "EXT_texture_",
    "FB_geometry_metadata",
    "GODOT_single_root",
    "KHR_animation",
    "KHR_audio",
    "KHR_environment_map",
    "KHR_interactivity",
    "KHR_materials_",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_",
    "KHR_rigid_bodies",
    "KHR_texture_",
    "KHR_xmp",
    "MOZ_lightmap",
    "MSFT_lod",
    "MSFT_packing_",
    "MSFT_texture_",
    "NV_materials_",
    "OMI_",
    "VRM",
];

/// Those that move vertices although their names start as above.
const MOVING: [&str; 2] = ["EXT_materials_displacement", "KHR_materials_displacement"];

pub(super) fn is_read_or_harmless(name: &str) -> bool {
    let harmless = || HARMLESS.iter().any(|start| name.starts_with(start));
    READ.contains(&name) || harmless() && !MOVING.contains(&name)
}

/// A warning for each extension of the file that may change its geometry and is not read.
pub(super) fn warnings(used: &[String], required: &[String]) -> Vec<String> {
    let mut names: Vec<&String> = used.iter().chain(required).collect();
    let mut known = std::collections::HashSet::new();
    names.retain(|name| !is_read_or_harmless(name) && known.insert(name.as_str()));
    let warning = |name| format!("extension `{name}` is not read: what it changes is not shown");
    names.into_iter().map(warning).collect()
}

/// How a file gets rid of an extension that its meshes cannot do without.
pub(super) fn remedy(extension: &str) -> &'static str {
    match extension {
        "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "decompress it with `gltf-transform copy IN.glb OUT.glb`"
        }
        _ => "export it without",
    }
}
