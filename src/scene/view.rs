//! A light and a camera for scenes that bring none.

use glam::Vec3;

use super::{Camera, Light, Scene};

const VERTICAL_FOV: f32 = std::f32::consts::FRAC_PI_3;

impl Scene {
    /// The scene's first light; without one, a white omnidirectional light above the geometry:
    /// over the centre of the bounds, half their largest side higher than their top.
    pub fn default_light(&self) -> Light {
        self.lights.first().copied().unwrap_or_else(|| {
            let bounds = self.bounds();
            let above = bounds.max.y + 0.5 * bounds.extent().max_element();
            Light { position: bounds.center().with_y(above), axis: None, color: Vec3::ONE }
        })
    }

    /// A camera for a scene that has none, given the light's position in metres.
    ///
    /// A light within the bounds is taken as an interior: the eye stands in the open at the
    /// light's height and looks along the longest horizontal side, past the light and somewhat
    /// down. Otherwise the whole scene is framed from outside, from the light's side.
    /// Casts a few rays at all triangles: milliseconds for 100,000.
    pub fn default_camera(&self, light: Vec3) -> Camera {
        let inside = self.bounds().contains(light);
        let (eye, target) = inside
            .then(|| self.interior_view(light))
            .flatten()
            .unwrap_or_else(|| self.exterior_view(light));
        Camera { eye, target, up: Vec3::Y, vertical_fov: VERTICAL_FOV }
    }

    /// Eye and target in the open space around the light; `None` if the light touches a surface.
    fn interior_view(&self, light: Vec3) -> Option<(Vec3, Vec3)> {
        /// Share of the side between the centre and the eye: 10% short of the end.
        const EYE_FROM_CENTER: f32 = 0.4;
        /// Of the free way to the nearest surface, so that the eye keeps off the surface.
        const FREE_SHARE: f32 = 0.9;
        /// Slopes to look down at, steepest first. The last one meets the light itself, and
        /// the way from the eye to the light is free.
        const SLOPES: [f32; 4] = [0.2, 0.1, 0.05, 0.0];

        let bounds = self.bounds();
        let side = bounds.extent().with_y(0.0);
        let axis = if side.x >= side.z { Vec3::X } else { Vec3::Z };
        let (step, back) = [axis, -axis]
            .map(|back| {
                let end = bounds.center() + back * (EYE_FROM_CENTER * side.max_element());
                let wanted = (end - light).dot(back);
                (wanted.min(FREE_SHARE * self.free_way(light, back)), back)
            })
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        let eye = light + back * step;
        let slope = SLOPES.into_iter().find(|slope| {
            // A ray parameter of 1 is the light's distance.
            self.free_way(eye, (light - eye) - Vec3::Y * (slope * step)) > 1.0
        });
        // Twice as far as the light, at the slope found.
        let target = light - back * step - Vec3::Y * (2.0 * step * slope.unwrap_or(0.0));
        (step > 0.0).then_some((eye, target))
    }

    /// Eye and target such that the sphere around the bounds fills the image's height.
    fn exterior_view(&self, light: Vec3) -> (Vec3, Vec3) {
        let bounds = self.bounds();
        let center = bounds.center();
        let toward = |light: f32, center: f32| if light < center { -1.0 } else { 1.0 };
        let diagonal = Vec3::new(
            toward(light.x, center.x),
            // About 27 degrees above the horizon: tops and sides both show.
            std::f32::consts::FRAC_1_SQRT_2,
            toward(light.z, center.z),
        );
        let radius = 0.5 * bounds.extent().length();
        // A scene that is a single point still needs an eye apart from its target.
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let distance = radius / (0.5 * VERTICAL_FOV).sin();
        (center + diagonal.normalize() * distance, center)
    }

    /// The ray parameter of the nearest surface along `origin + t * direction`, either side.
    fn free_way(&self, origin: Vec3, direction: Vec3) -> f32 {
        self.triangles()
            .filter_map(|triangle| ray_hits(origin, direction, triangle))
            .fold(f32::INFINITY, f32::min)
    }
}

/// Möller and Trumbore's test: the ray parameter t >= 0 of the hit.
fn ray_hits(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    // Zero for a parallel ray: the divisions give infinities or NaN, and no comparison holds.
    let scale = 1.0 / ab.dot(p);
    let s = origin - a;
    let u = s.dot(p) * scale;
    let q = s.cross(ab);
    let v = direction.dot(q) * scale;
    let t = ac.dot(q) * scale;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
}
