//! Punctual lights (KHR_lights_punctual) and cameras.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DAffine3, DVec3, Vec3};
use serde::Deserialize;
use serde_json::value::RawValue;

use super::document::{Document, Extensions, extension, of_text};
use crate::scene::load::{View, unit};
use crate::scene::{Cone, Light};

/// Of a cone's angles.
const WIDEST: f32 = std::f32::consts::FRAC_PI_2;

const NAME: &str = "KHR_lights_punctual";

#[derive(Deserialize)]
struct Reference {
    light: usize,
}

#[derive(Deserialize)]
struct Lights<'a> {
    #[serde(borrow)]
    lights: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
struct Punctual {
    #[serde(rename = "type")]
    kind: String,
    color: Option<Vec3>,
    intensity: Option<f64>,
    range: Option<f64>,
    spot: Option<Spot>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Spot {
    inner_cone_angle: Option<f64>,
    outer_cone_angle: Option<f64>,
}

/// What a node's light is to the scene.
pub(super) enum Found {
    Light(DVec3, Light),
    /// Without a position.
    Directional,
    /// Of a kind that is not known.
    Unknown(String),
    /// Without colour, position or direction.
    Dark,
}

/// The light of a node, if it has one; repairs are added to the warnings.
pub(super) fn light(
    document: &Document,
    extensions: &Extensions,
    world: &DAffine3,
    warnings: &mut Vec<String>,
) -> Result<Option<Found>, String> {
    let Some(Reference { light }) = extension(extensions, NAME)? else { return Ok(None) };
    let lights = extension::<Lights>(&document.extensions, NAME)?.ok_or("it has no lights")?.lights;
    let light = lights.get(light).ok_or_else(|| format!("there is no light {light}"))?;
    let Punctual { kind, color, intensity, range, spot } = of_text(light)?;
    let axis = match kind.as_str() {
        "point" => None,
        "spot" => match unit(-world.matrix3.z_axis) {
            Some(axis) => Some(axis),
            None => return Ok(Some(Found::Dark)),
        },
        "directional" => return Ok(Some(Found::Directional)),
        _ => return Ok(Some(Found::Unknown(kind))),
    };
    let color = color.unwrap_or(Vec3::ONE);
    let brightest = color.max_element();
    let shines = color.is_finite() && brightest > 0.0 && intensity.unwrap_or(1.0) > 0.0;
    let position = world.translation;
    if !shines || !position.is_finite() {
        return Ok(Some(Found::Dark));
    }
    let light = Light {
        position: Vec3::ZERO,
        axis,
        color: (color / brightest).max(Vec3::ZERO),
        cone: axis.map(|_| cone(&spot.unwrap_or_default(), warnings)),
        range: range.and_then(|range| limit(range, warnings)),
    };
    Ok(Some(Found::Light(position, light)))
}

/// The angles of a spot, by default none and 45 degrees. An inner one that is not below the outer
/// one, as of a spot with a hard edge, comes as near to it as f32 has numbers.
fn cone(spot: &Spot, warnings: &mut Vec<String>) -> Cone {
    let inner = spot.inner_cone_angle.unwrap_or(0.0);
    let outer = spot.outer_cone_angle.unwrap_or(FRAC_PI_4);
    let is_usable = outer > 0.0 && outer as f32 <= WIDEST && (0.0..=outer).contains(&inner);
    if !is_usable {
        warnings.push(format!("a spot's cone of {inner} to {outer} rad is not possible: cut"));
    }
    let outer = if outer > 0.0 { outer as f32 } else { FRAC_PI_4 as f32 };
    // an angle may be so narrow that f32 has none
    let outer = outer.clamp(f32::MIN_POSITIVE, WIDEST);
    Cone { inner: (inner.max(0.0) as f32).min(outer.next_down()), outer }
}

fn limit(range: f64, warnings: &mut Vec<String>) -> Option<f32> {
    if range <= 0.0 {
        warnings.push(format!("a light's range of {range} is not possible: without limit"));
    }
    Some(range as f32).filter(|range| *range > 0.0 && range.is_finite())
}

#[derive(Deserialize)]
struct Camera {
    perspective: Option<Perspective>,
}

#[derive(Deserialize)]
struct Perspective {
    yfov: f64,
}

/// `None` for one without a usable perspective.
pub(super) fn camera(document: &Document, index: usize, world: &DAffine3) -> Option<View> {
    let camera: Camera = document.get("cameras", index).ok()?;
    let vertical_fov = camera.perspective?.yfov;
    let usable = vertical_fov as f32 > 0.0 && vertical_fov < PI && world.translation.is_finite();
    let (forward, up) = (unit(-world.matrix3.z_axis)?, unit(world.matrix3.y_axis)?);
    let vertical_fov = (vertical_fov as f32).min(std::f32::consts::PI.next_down());
    usable.then_some(View { eye: world.translation, forward, up, vertical_fov })
}
