//! What the light sees through each texel of a map, by casting rays: nothing between the texel and
//! its surface, so no shadow; an arc is an arc, whatever the method that makes the maps.

use std::time::{Duration, Instant};

use glam::DVec3;
use rayon::prelude::*;

use super::camera::Visible;
use super::surface::Surface;
use super::vector;
use crate::measure::truth_of_casters;
use crate::render::{Frame, Linear};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::light::DpsmLight;
use crate::scalar::paraboloid::dpsm_texture_to_disk;
use crate::truth::{Ray, Truth};

/// The view of each map, its time added to `timings`. On a disk it ends at the rim.
///
/// A texel that shows the same triangle as all of its neighbours has the light of its centre; the
/// others take all samples of the settings.
pub fn views(frame: &Frame, timings: &mut Vec<(String, Duration)>) -> Vec<Linear> {
    let truth = truth_of_casters(frame);
    let light = frame.light.widen();
    let names = frame.settings.method.projection().names();
    let view = |(map, name): (u32, &&str)| {
        let start = Instant::now();
        let view = Texels { frame, truth: &truth, light, map }.view();
        timings.push((format!("{name} view"), start.elapsed()));
        view
    };
    (0..frame.light.hemispheres).zip(names).map(view).collect()
}

/// The texels of one map.
struct Texels<'a> {
    frame: &'a Frame,
    truth: &'a Truth,
    light: DpsmLight<f64>,
    map: u32,
}

impl Texels<'_> {
    fn view(&self) -> Linear {
        let size = self.frame.settings.map_size() as usize;
        let centre = |index: usize| self.seen([index % size, index / size], [0.5; 2]);
        let centres: Vec<Visible> = (0..size * size).into_par_iter().map(centre).collect();
        let places = self.frame.settings.places();
        let light = |index: usize| {
            let [x, y] = [index % size, index / size];
            let near = |c: usize| c.saturating_sub(1)..(c + 2).min(size);
            let triangle = |index: usize| centres[index].map(|(triangle, _)| triangle);
            let same = near(y).all(|y| near(x).all(|x| triangle(y * size + x) == triangle(index)));
            if same {
                return self.light(centres[index]);
            }
            let samples = places.iter().map(|place| self.light(self.seen([x, y], *place)));
            let sum = samples.fold(glam::Vec4::ZERO, |sum, sample| sum + glam::Vec4::from(sample));
            (sum / places.len() as f32).to_array()
        };
        let pixels = (0..size * size).into_par_iter().map(light).collect();
        Linear { width: size as u32, height: size as u32, pixels }
    }

    /// What the light sees through a place of a texel, from its top left corner.
    fn seen(&self, texel: [usize; 2], place: [f32; 2]) -> Visible {
        let size = self.light.size;
        let at = |axis: usize| (texel[axis] as f64 + f64::from(place[axis])) / size;
        let uv = dpsm_texture_to_disk(Vec2::new(at(0), at(1)), self.light.guard);
        let projection = self.frame.settings.method.projection();
        if projection.radius(uv) > 1.0 {
            return None;
        }
        let DpsmLight { position, right, up, forward, near, far, .. } = self.light;
        let d = projection.direction(uv, self.map);
        // a face's planes are as much farther off its axis as the direction is long
        let stretch = d.length();
        let direction = world(right * d.x + up * d.y + forward * d.z);
        let ray = Ray {
            near: near * stretch,
            far: far * stretch,
            ..Ray::new(world(position), direction)
        };
        let hit = self.truth.first_hit(&ray)?;
        Some((hit.triangle, hit.weights.map(|weight| weight as f32)))
    }

    /// Lit by the light, seen from there.
    fn light(&self, seen: Visible) -> [f32; 4] {
        let Some((triangle, weights)) = seen else { return [0.0; 4] };
        let surface = Surface::new(self.frame, triangle, weights);
        surface.shade(self.frame, vector([0.0; 3]), 1.0).extend(1.0).to_array()
    }
}

fn world(v: Vec3<f64>) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}
