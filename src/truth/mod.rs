//! Ground truth: a ray caster in f64 that loses no hit.
//!
//! The search goes through a tree of boxes, the triangle test is watertight: no ray slips between
//! two triangles that share an edge. Method, error bounds and how they were checked:
//! `docs/truth.md`.
//!
//! ```
//! use dpsm::truth::{Ray, Truth};
//! use glam::{DVec3, dvec3};
//!
//! let corners = [dvec3(0.0, 0.0, 0.0), dvec3(4.0, 0.0, 0.0), dvec3(0.0, 0.0, 4.0)];
//! let truth = Truth::new(&corners, [[0, 1, 2]]);
//! let hit = truth.first_hit(&Ray::new(dvec3(1.0, 3.0, 1.0), DVec3::NEG_Y)).unwrap();
//! assert_eq!((hit.distance, hit.triangle), (3.0, 0));
//! assert!(truth.sees(dvec3(1.0, 3.0, 1.0), dvec3(1.0, 0.0, 1.0), Some(0), 0.0));
//! assert!(!truth.sees(dvec3(1.0, 3.0, 1.0), dvec3(1.0, -1.0, 1.0), None, 0.0));
//! ```

mod adjacent;
mod sheared;
mod tree;

use std::collections::HashSet;
use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::DVec3;
use rayon::prelude::*;

use crate::scene::{Mesh, Scene};
use adjacent::Adjacent;
use sheared::Sheared;
use tree::Tree;

/// Largest magnitude of a usable coordinate: products of four stay finite in f64.
pub const LARGEST: f64 = 1e75;

/// How far rounding may move an end of a shadow ray off a triangle that holds it, in units of the
/// largest coordinate involved (docs/truth.md, "Ends").
pub const TOUCH: f64 = 64.0 * f64::EPSILON;

/// Triangles to cast rays at.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Of each triangle; of an unusable one, which nothing meets, NaN.
    corners: Vec<[DVec3; 3]>,
    tree: Tree,
    /// Made when it is first asked for.
    adjacent: OnceLock<Adjacent>,
    opacity: Opacity,
}

/// True where a triangle is opaque at a point given by its corners' weights.
type Opaque = dyn Fn(u32, [f64; 3]) -> bool + Send + Sync;

/// Without a function all is opaque.
#[derive(Clone)]
struct Opacity(Option<Arc<Opaque>>);

impl fmt::Debug for Opacity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "some holes" } else { "no holes" })
    }
}

/// An open piece of a half-line: the distances strictly between `near` and `far`, as rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// World position.
    pub origin: DVec3,
    /// Of any length above 0.
    pub direction: DVec3,
    /// Where the piece begins, a distance in world units, at least 0.
    pub near: f64,
    /// Where it ends; may be infinite.
    pub far: f64,
    /// A triangle that the ray passes through.
    pub except: Option<u32>,
}

impl Ray {
    /// All that lies ahead of `origin`.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, near: 0.0, far: f64::INFINITY, except: None }
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// World units from the ray's origin, whatever the length of its direction. Off by at most
    /// `16 f64::EPSILON R / cos`: R is the largest coordinate of the triangle relative to the
    /// origin, cos that of the angle between ray and normal.
    pub distance: f64,
    /// Index into the triangles of all meshes in order.
    pub triangle: u32,
    /// Barycentric weights of the corners: each in [0, 1], their sum is 1 up to rounding.
    pub weights: [f64; 3],
}

/// A point that may be lit, and the triangle that it lies on.
pub type Receiver = (DVec3, Option<u32>);

impl Truth {
    /// Triangles are indices into `positions`. A triangle with an index out of range or a
    /// coordinate that is not a number up to [`LARGEST`] is never hit.
    pub fn new(positions: &[DVec3], triangles: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let corner = |i: u32| positions.get(i as usize).copied().unwrap_or(DVec3::NAN);
        Self::of(triangles.into_iter().map(|triangle| triangle.map(corner)))
    }

    fn of(corners: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let usable = |triangle: &[DVec3; 3]| triangle.iter().all(|&corner| is_usable(corner));
        let nothing = [DVec3::NAN; 3];
        let corners: Vec<_> = corners.map(|t| if usable(&t) { t } else { nothing }).collect();
        let hittable = (0..).zip(corners.iter().copied()).filter(|(_, triangle)| usable(triangle));
        let tree = Tree::new(&hittable.collect::<Vec<_>>());
        Self { corners, tree, adjacent: OnceLock::new(), opacity: Opacity(None) }
    }

    /// The same triangles with holes: a ray meets a triangle only where `opaque` of its index and
    /// the [weights](Hit::weights) of the point is true. Elsewhere it passes through, whatever
    /// asks.
    ///
    /// ```
    /// # use dpsm::truth::{Ray, Truth};
    /// # use glam::{DVec3, dvec3};
    /// let corners = [dvec3(0.0, 0.0, 0.0), dvec3(4.0, 0.0, 0.0), dvec3(0.0, 0.0, 4.0)];
    /// let near_first = |_, weights: [f64; 3]| weights[0] >= 0.5;
    /// let truth = Truth::new(&corners, [[0, 1, 2]]).with_opacity(near_first);
    /// let down = |x| Ray::new(dvec3(x, 1.0, 0.5), DVec3::NEG_Y);
    /// assert!(truth.first_hit(&down(0.5)).is_some() && truth.first_hit(&down(3.0)).is_none());
    /// ```
    pub fn with_opacity(
        self,
        opaque: impl Fn(u32, [f64; 3]) -> bool + Send + Sync + 'static,
    ) -> Self {
        Self { opacity: Opacity(Some(Arc::new(opaque))), ..self }
    }

    /// The first triangle on the ray, from either side; of equally distant ones that with the
    /// lowest index. `None` also for a direction that is zero or for anything not finite.
    pub fn first_hit(&self, ray: &Ray) -> Option<Hit> {
        self.search(ray, |_| true)
    }

    /// [`Truth::first_hit`] of each ray, in order, on all cores.
    pub fn first_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        rays.par_iter().map(|ray| self.first_hit(ray)).collect()
    }

    /// The ray against one triangle alone, without the tree.
    pub fn hit(&self, ray: &Ray, triangle: u32) -> Option<Hit> {
        self.test(&Sheared::new(ray)?, ray, triangle)
    }

    /// The first triangle that keeps the light from the point: farther than `near` from the
    /// light, nearer than the point, and not `own`, the one that the point lies on. A triangle
    /// whose plane holds the light or the point, up to [`TOUCH`], ends there and keeps nothing;
    /// so a neighbour that shares the point's edge does not, and neither does a coincident twin.
    pub fn occluder(&self, light: DVec3, point: DVec3, own: Option<u32>, near: f64) -> Option<Hit> {
        let direction = point - light;
        let ray = Ray { origin: light, direction, near, far: direction.length(), except: own };
        self.search(&ray, |hit| {
            let [a, b, c] = self.corners[hit.triangle as usize];
            let normal = (b - a).cross(c - a);
            let inside = weighted([a, b, c], hit.weights);
            // the point's coordinates play no part at the light's end
            [light, point].iter().all(|end| {
                let largest = [*end, light, a, b, c].map(|v| v.abs().max_element());
                let touch = TOUCH * largest.into_iter().fold(0.0, f64::max) * normal.length();
                normal.dot(end - inside).abs() > touch
            })
        })
    }

    /// [`Truth::occluder`] of each receiver, in order, on all cores.
    pub fn occluders(&self, light: DVec3, receivers: &[Receiver], near: f64) -> Vec<Option<Hit>> {
        let occluder = |&(point, own): &Receiver| self.occluder(light, point, own, near);
        receivers.par_iter().map(occluder).collect()
    }

    /// True where nothing keeps the light from the point; see [`Truth::occluder`].
    pub fn sees(&self, light: DVec3, point: DVec3, own: Option<u32>, near: f64) -> bool {
        self.occluder(light, point, own, near).is_none()
    }

    /// The point that was hit, made from the triangle's corners: never farther off the triangle's
    /// plane than [`TOUCH`] allows.
    pub fn point(&self, hit: &Hit) -> Option<DVec3> {
        self.corners.get(hit.triangle as usize).map(|corners| weighted(*corners, hit.weights))
    }

    /// The triangle and all that are connected with it within a ball: reached over edges and corners
    /// of which some point is within `radius` of `centre`. Corners at equal positions are one, whatever
    /// mesh they belong to; holes do not matter.
    pub fn connected(&self, triangle: u32, centre: DVec3, radius: f64) -> HashSet<u32> {
        let adjacent = self.adjacent.get_or_init(|| Adjacent::new(&self.corners));
        match (triangle as usize) < self.corners.len() {
            true => adjacent.connected(&self.corners, triangle, centre, radius),
            false => HashSet::new(),
        }
    }

    fn search(&self, ray: &Ray, counts: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let sheared = Sheared::new(ray)?;
        let mut first: Option<Hit> = None;
        self.tree.visit(&sheared, ray, |triangle| {
            if let Some(hit) = self.test(&sheared, ray, triangle)
                && first.is_none_or(|best| hit.is_before(&best))
                && counts(&hit)
            {
                first = Some(hit);
            }
            first.map_or(ray.far, |best| best.distance)
        });
        first
    }

    fn test(&self, sheared: &Sheared, ray: &Ray, triangle: u32) -> Option<Hit> {
        let (distance, weights) = sheared.meet(*self.corners.get(triangle as usize)?)?;
        let hit = Hit { distance, triangle, weights };
        let counts = distance > ray.near && distance < ray.far && ray.except != Some(triangle);
        let opaque = || self.opacity.0.as_ref().is_none_or(|opaque| opaque(triangle, weights));
        (counts && opaque()).then_some(hit)
    }
}

/// Mesh after mesh, as [`Scene::triangles`] counts, with the holes of their masks.
impl From<&Scene> for Truth {
    fn from(scene: &Scene) -> Self {
        let truth = Self::of(scene.triangles().map(|t| t.map(|corner| corner.as_dvec3())));
        let mut end = 0;
        let starts = scene.meshes.iter().map(|mesh| {
            let start = end;
            end += mesh.triangles.len();
            (start, mesh)
        });
        let masked: Vec<(usize, Mesh)> = starts
            .filter(|(_, mesh)| mesh.mask.is_some())
            .map(|(start, mesh)| (start, mesh.clone()))
            .collect();
        if masked.is_empty() {
            return truth;
        }
        truth.with_opacity(move |triangle, weights| {
            let triangle = triangle as usize;
            let after = masked.partition_point(|(start, _)| *start <= triangle);
            // of an opaque mesh that follows, the triangle is not one of the masked mesh
            let before = after.checked_sub(1).map(|i| &masked[i]);
            before.is_none_or(|(start, mesh)| mesh.opaque(triangle - start, weights))
        })
    }
}

impl Hit {
    fn is_before(&self, other: &Self) -> bool {
        (self.distance, self.triangle) < (other.distance, other.triangle)
    }
}

fn is_usable(point: DVec3) -> bool {
    point.abs().cmple(DVec3::splat(LARGEST)).all()
}

fn weighted(corners: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}
