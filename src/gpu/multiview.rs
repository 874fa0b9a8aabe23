//! Multiview: all maps of a light in one pass, each in its own layer.
//!
//! The shader is derived at run time from the one for single passes: Tint refuses `view_index`, and
//! the tree holds only what naga and Tint both accept.

use std::num::NonZeroU32;

use glam::{Vec3, vec3};

use super::maps::ShadowMaps;
use super::mesh::MeshBuffers;
use super::{Device, GpuError};
use crate::render::{Frame, Method, Passes, Settings};
use crate::scalar::light::DpsmLight;
use crate::scalar::maps::Sampling;
use crate::scene::{Camera, Mesh, Scene};

/// How the shader learns which map it draws, with single passes and with multiview.
const SINGLE: &str = "fn hemisphere() -> u32 {\n    return map_pass.hemisphere;\n}";
const MULTIVIEW: &str = "var<private> view: u32;\nfn hemisphere() -> u32 {\n    return view;\n}";

/// The shader for multiview: every entry point is given its view and keeps it for `hemisphere`.
pub fn multiview_text(text: &str) -> String {
    let mut derived = String::new();
    let mut in_entry_point = false;
    debug_assert!(text.contains(SINGLE), "the text that multiview replaces");
    for line in text.replace(SINGLE, MULTIVIEW).lines() {
        in_entry_point |= ["@vertex", "@fragment"].contains(&line);
        let ends = in_entry_point && line.ends_with('{');
        match line.strip_prefix("fn ").and_then(|line| line.split_once('(')) {
            Some((name, rest)) if in_entry_point => {
                derived += &format!("fn {name}(@builtin(view_index) view_index: u32, {rest}");
            }
            _ => derived += line,
        }
        if ends {
            derived += " view = view_index;";
            in_entry_point = false;
        }
        derived.push('\n');
    }
    derived
}

/// Views of each light's passes: with multiview its maps, within the adapter's limit; else 1.
pub fn views(
    device: &Device,
    lights: &[DpsmLight<f32>],
    passes: Passes,
) -> Result<Vec<u32>, GpuError> {
    let of = |light: &DpsmLight<f32>| match passes {
        Passes::Multiview => light.hemispheres.max(1),
        Passes::Single | Passes::Atlas => 1,
    };
    let all: Vec<u32> = lights.iter().map(of).collect();
    let limit = match device.device.features().contains(wgpu::Features::MULTIVIEW) {
        true => device.device.limits().max_multiview_view_count,
        false => 0,
    };
    match all.iter().max() {
        Some(&views) if views > limit.max(1) => {
            Err(refused(device, format!("a pass has at most {limit} views there, not {views}")))
        }
        _ => Ok(all),
    }
}

fn refused(device: &Device, reason: impl Into<String>) -> GpuError {
    GpuError::Multiview { adapter: device.info.name.clone(), reason: reason.into() }
}

/// Tries multiview, as a driver's may be wrong (docs/maps.md): a triangle behind the light that the
/// far sphere clips must be in the back map alone.
pub fn try_views(device: &Device) -> Result<(), GpuError> {
    // twice as far as the far sphere
    let corners = vec![vec3(-1.0, -1.0, -1.0), vec3(1.0, -1.0, -1.0), vec3(0.0, 1.0, -20.0)];
    let mesh = Mesh {
        name: "trial".into(),
        normals: vec![Vec3::Z; corners.len()],
        positions: corners,
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let (name, origin, lights, camera, warnings) = Default::default();
    let scene = Scene { name, origin, meshes: vec![mesh], lights, camera, warnings };
    let camera = Camera { eye: Vec3::ZERO, target: Vec3::Z, up: Vec3::Y, vertical_fov: 1.0 };
    let settings = Settings {
        size: 64,
        method: Method::Vertex,
        passes: Passes::Multiview,
        far: Some(10.0),
        ..Settings::default()
    };
    let frame = Frame::new(&scene, Vec3::ZERO, Vec3::Z, false, &camera, settings)?;
    let mesh = MeshBuffers::new(device, &frame)?;
    let maps = ShadowMaps::untried(device, &frame, &mesh, &[frame.light])?;
    let encoder = device.encode("multiview", |encoder| maps.record(encoder, &mesh, None))?;
    device.submit("multiview", encoder)?;
    let depths = maps.download(device, Sampling::Nearest)?.depths;
    let (front, back) = depths.split_at(depths.len() / 2);
    let is_stored = |map: &[f32]| map.iter().any(|&depth| depth < 1.0);
    match is_stored(back) && !is_stored(front) {
        true => Ok(()),
        false => Err(refused(device, "its driver draws clipped triangles into the wrong map")),
    }
}

/// The mask of so many views; none for one alone, which needs no multiview.
pub fn view_mask(views: u32) -> Option<NonZeroU32> {
    NonZeroU32::new(u32::MAX >> (u32::BITS - views)).filter(|_| views > 1)
}
