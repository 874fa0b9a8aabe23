//! Where a camera stands in a room, or around an object.

use glam::{DVec3, Vec3};

use super::space::Space;
use super::{SHOWN_FROM, short};
use crate::scene::{Camera, Scene};

/// Of a camera in a room: 60 degrees.
const INTERIOR_FOV: f32 = std::f32::consts::FRAC_PI_3;

/// Of a camera around an object: 36 degrees, which distorts less.
const EXTERIOR_FOV: f32 = std::f32::consts::PI / 5.0;

/// The part of the image's height, and as much of its width, that an object may fill.
const FILLED: f64 = 0.9;

impl Scene {
    /// A camera for a scene that has none, given the light's position in metres.
    ///
    /// A light in a room: the eye stands in the open at the light's height and looks along the
    /// longest horizontal side, past the light and somewhat down. Otherwise the whole scene is
    /// framed from outside, three quarters from the front (+z), so that it fills nine tenths of the
    /// image's height, or as much of its width.
    pub fn default_camera(&self, light: Vec3) -> Camera {
        let space = Space::new(self);
        let interior =
            space.encloses(light).then(|| self.interior_view(&space, light.as_dvec3())).flatten();
        let (vertical_fov, (eye, target)) = match interior {
            Some(view) => (INTERIOR_FOV, view),
            None => (EXTERIOR_FOV, self.exterior_view()),
        };
        let [eye, target] = [eye, target].map(|point| short(point, 0.1 * self.radius()));
        Camera { eye, target, up: Vec3::Y, vertical_fov }
    }

    /// Eye and target in the open space around the light; `None` if the light touches a surface.
    fn interior_view(&self, space: &Space, light: DVec3) -> Option<(DVec3, DVec3)> {
        /// Share of the side between the centre and the eye: 10% short of the end.
        const EYE_FROM_CENTER: f64 = 0.4;
        /// Of the free way to the nearest surface, so that the eye keeps off the surface.
        const FREE_SHARE: f64 = 0.9;
        /// Of the openness around the light that the eye has at least.
        const OPEN_SHARE: f64 = 0.75;
        /// Of the way back, the longest first.
        const STEPS: [f64; 5] = [1.0, 0.9, 0.8, 0.7, 0.6];
        /// Slopes to look down at, steepest first. The last one meets the light itself, and
        /// the way from the eye to the light is free.
        const SLOPES: [f64; 4] = [0.2, 0.1, 0.05, 0.0];

        let bounds = self.bounds();
        let side = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).with_y(0.0);
        let axis = if side.x >= side.z { DVec3::X } else { DVec3::Z };
        let (step, back) = [axis, -axis]
            .map(|back| {
                let center = bounds.center().as_dvec3();
                let end = center + back * (EYE_FROM_CENTER * side.max_element());
                let wanted = (end - light).dot(back);
                (wanted.min(FREE_SHARE * space.free_way(light, back)), back)
            })
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        // not behind columns: the longest way back that ends in a place nearly as open
        let openness = OPEN_SHARE * space.free_around(light);
        let open = |share: &f64| space.free_around(light + back * (share * step)) >= openness;
        let step = step * STEPS.into_iter().find(open).unwrap_or(1.0);
        let eye = light + back * step;
        let slope = SLOPES.into_iter().find(|slope| {
            // A ray parameter of 1 is the light's distance.
            space.free_way(eye, (light - eye) - DVec3::Y * (slope * step)) > 1.0
        });
        // Twice as far as the light, at the slope found.
        let target = light - back * step - DVec3::Y * (2.0 * step * slope.unwrap_or(0.0));
        (step > 0.0).then_some((eye, target))
    }

    /// Eye and target such that no vertex is outside the middle of the image, and some are at its
    /// border.
    fn exterior_view(&self) -> (DVec3, DVec3) {
        let forward = -SHOWN_FROM.normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let center = self.bounds().center().as_dvec3();
        let slope = FILLED * (0.5 * f64::from(EXTERIOR_FOV)).tan();
        // A vertex at (x, z) off the centre is inside a border of the image where
        // x - slope z <= slope distance + shift, and the same on the other side.
        let positions = || self.meshes.iter().flat_map(|mesh| &mesh.positions);
        let widest = |axis: DVec3| {
            let reach = |p: &Vec3| {
                let p = p.as_dvec3() - center;
                p.dot(axis) - slope * p.dot(forward)
            };
            positions().map(reach).fold(f64::NEG_INFINITY, f64::max)
        };
        let mut distance = 0.0_f64;
        let mut middle = center;
        for axis in [right, up] {
            let (more, less) = (widest(axis), widest(-axis));
            middle += axis * (0.5 * (more - less));
            distance = distance.max(0.5 * (more + less) / slope);
        }
        // A scene without extent still needs an eye apart from its target.
        let distance = if distance > 0.0 && distance.is_finite() { distance } else { 1.0 };
        let middle = if middle.is_finite() { middle } else { center };
        (middle - forward * distance, middle)
    }
}
