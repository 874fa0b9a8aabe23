//! The space around a point: what rays from it meet.

use glam::{DVec3, Vec3};

use crate::scene::{Bounds, Scene};
use crate::truth::{Ray, Truth};

/// Rays around a point.
const RAYS: usize = 96;

/// The share of them that meets the front of a surface in a room: five of six walls and more, as
/// some open to a side or to the sky.
const ENCLOSED: f64 = 0.7;

/// A hollow of an object, not a room, is less free than this share of the radius around the whole.
const CAVITY: f64 = 0.05;

/// Places along each side of the bounds that a light may hang at.
const PLACES: usize = 6;

/// A scene to cast rays at.
pub struct Space {
    truth: Truth,
    triangles: Vec<[Vec3; 3]>,
    bounds: Bounds,
}

/// What is around a point.
struct Surroundings {
    /// True where most rays meet the front of a surface. Inside of a solid they meet backs.
    enclosed: bool,
    /// The distance that three quarters of the rays go freely at least.
    free: f64,
}

impl Space {
    pub fn new(scene: &Scene) -> Self {
        let triangles = scene.triangles().collect();
        Self { truth: Truth::from(scene), triangles, bounds: scene.bounds() }
    }

    /// True for a point in a room.
    pub fn encloses(&self, point: Vec3) -> bool {
        self.bounds.contains(point) && self.around(point.as_dvec3()).enclosed
    }

    /// A place in the open of a room, or `None` where there is no room.
    pub fn place_for_light(&self) -> Option<DVec3> {
        let at = |i: usize| (i as f64 + 0.5) / PLACES as f64;
        let [min, max] = [self.bounds.min, self.bounds.max].map(|corner| corner.as_dvec3());
        let places = (0..PLACES.pow(3)).map(|i| {
            let share = [i, i / PLACES, i / PLACES / PLACES].map(|i| at(i % PLACES));
            min + (max - min) * DVec3::from(share)
        });
        let open = |place: DVec3| Some(self.around(place)).filter(|of| of.enclosed);
        let freest = places
            .filter_map(|place| Some((open(place)?.free, place)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let roomy = CAVITY * 0.5 * (max - min).length();
        let (_, place) = freest.filter(|(free, _)| *free > roomy)?;
        let [up, down] = [DVec3::Y, DVec3::NEG_Y].map(|way| self.free_way(place, way));
        let ceiling = (place.y + up).min(self.bounds.max.y.into());
        let floor = (place.y - down).max(self.bounds.min.y.into());
        let halfway = place.with_y(0.5 * (ceiling + floor));
        Some(if self.around(halfway).enclosed { halfway } else { place })
    }

    /// The ray parameter of the nearest surface along `origin + t * direction`, either side.
    pub fn free_way(&self, origin: DVec3, direction: DVec3) -> f64 {
        let hit = self.truth.first_hit(&Ray::new(origin, direction));
        hit.map_or(f64::INFINITY, |hit| hit.distance / direction.length())
    }

    /// The distance that three quarters of the rays around a point go freely at least.
    pub fn free_around(&self, point: DVec3) -> f64 {
        self.around(point).free
    }

    fn around(&self, point: DVec3) -> Surroundings {
        let mut fronts = 0;
        let mut free: Vec<f64> = directions()
            .map(|direction| match self.truth.first_hit(&Ray::new(point, direction)) {
                None => f64::INFINITY,
                Some(hit) => {
                    fronts += usize::from(self.shows_front(hit.triangle, direction));
                    hit.distance
                }
            })
            .collect();
        let (_, free, _) = free.select_nth_unstable_by(RAYS / 4, f64::total_cmp);
        Surroundings { enclosed: fronts as f64 >= ENCLOSED * RAYS as f64, free: *free }
    }

    fn shows_front(&self, triangle: u32, direction: DVec3) -> bool {
        self.triangles.get(triangle as usize).is_some_and(|corners| {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            (b - a).cross(c - a).dot(direction) < 0.0
        })
    }
}

/// Directions spread evenly over the sphere, on a spiral of golden angles.
fn directions() -> impl Iterator<Item = DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..RAYS).map(move |i| {
        let y = 1.0 - (2 * i + 1) as f64 / RAYS as f64;
        let (sine, cosine) = (golden * i as f64).sin_cos();
        let across = (1.0 - y * y).sqrt();
        DVec3::new(across * cosine, y, across * sine)
    })
}
