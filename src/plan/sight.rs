//! What a light reaches: shadow edges and gaps around the points that are to be lit.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

use super::Target;
use crate::measure::{Point, nearest_change};
use crate::truth::{Ray, Truth};

/// A light among a scene's triangles.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// The scene's triangles.
    pub truth: &'a Truth,
    /// The light's world position.
    pub origin: DVec3,
}

/// What a light makes of a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Along {
    /// It reaches the receiver's plane.
    Lit,
    /// Something keeps it from the plane: how far in front of it, and its own distance.
    Dark { gap: f64, occluder: f64 },
    /// It misses the plane.
    Beyond,
}

/// What a direction that misses a point's plane is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// No shadow edge: a lookup there compares the receiver itself.
    Pass,
    /// An edge, as `dpsm measure` takes it.
    Count,
}

/// A receiver, and how well a map must know what is around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Unit direction from the light, world space.
    pub direction: DVec3,
    /// Distance from the light.
    pub distance: f64,
    /// Unit normal; zero where it is not known.
    pub normal: DVec3,
    /// The angle that the target allows at this distance.
    pub allowed: f64,
    /// The angle by which a map may miss the point's direction without lighting it wrongly beyond
    /// the target: `allowed` beside a shadow edge, more where none is near.
    pub room: f64,
    /// The angle to the nearest shadow edge, at most that of the widest ring.
    pub edge: f64,
    /// Distance from the plane to what shadows it: at the point, and the least around it at the
    /// allowed angle. Infinite for a lit point, and where an edge is so near that the target
    /// forgives its light.
    pub gap: [f64; 2],
    /// How much nearer than the point what shadows it is: at the point, and the least around it.
    /// Infinite likewise.
    pub behind: [f64; 2],
}

/// Azimuths in which a plan looks for edges, and how far, in allowed angles: a ring near enough to
/// meet what is narrow, and one wide enough to know many points beside each edge.
const AZIMUTHS: u32 = 8;
const RINGS: [f64; 2] = [1.0, 4.0];

/// From where a triangle is looked at that no eye has to see, of the distance from the light.
const BESIDE: f64 = 1e-3;

/// Halvings of the gap between two rings: the edge is found to 1/64 of it.
const HALVINGS: u32 = 6;

impl Sample {
    /// The least gap within an angle, at most the allowed one: between the two that are known.
    pub fn gap_within(&self, angle: f64) -> f64 {
        self.between(self.gap, angle)
    }

    /// How much nearer than the point its occluders within an angle are at the least.
    pub fn behind_within(&self, angle: f64) -> f64 {
        self.between(self.behind, angle)
    }

    fn between(&self, [own, around]: [f64; 2], angle: f64) -> f64 {
        own + (around - own) * (angle / self.allowed).min(1.0)
    }

    /// The cosine of the incidence; 1 for a point without a normal.
    pub fn incidence(&self) -> f64 {
        match self.normal == DVec3::ZERO {
            true => 1.0,
            false => self.direction.dot(self.normal).abs().min(1.0),
        }
    }
}

impl Sight<'_> {
    /// Samples of the points that the light may reach.
    pub fn samples(&self, points: &[Point], target: Target) -> Vec<Sample> {
        points.par_iter().filter_map(|point| self.sample(point, target)).collect()
    }

    fn sample(&self, point: &Point, target: Target) -> Option<Sample> {
        let to_point = point.world - self.origin;
        let distance = to_point.length();
        let direction = to_point.try_normalize()?;
        let allowed = target.angle(distance);
        let rings = RINGS.map(|ring| ring * allowed);
        let edge = self.edge(point, &rings, AZIMUTHS, Ends::Pass);
        let [gap, behind] = match edge > allowed {
            true => self.gaps(point, direction, allowed),
            false => [[f64::INFINITY; 2]; 2],
        };
        Some(Sample {
            direction,
            distance,
            normal: point.normal.unwrap_or_default(),
            allowed,
            room: if edge.is_finite() { allowed } else { rings[1] },
            edge: edge.min(rings[1]),
            gap,
            behind,
        })
    }

    /// The angle from a point to the nearest place where its plane's light changes; infinite beyond
    /// the widest ring. Rings ascend.
    pub fn edge(&self, point: &Point, rings: &[f64], azimuths: u32, ends: Ends) -> f64 {
        let Some(axis) = (point.world - self.origin).try_normalize() else { return 0.0 };
        let lit = self.is_lit(point);
        let differs =
            |azimuth: f64, angle: f64| match self.along(point, turned(axis, azimuth, angle)) {
                Along::Lit => !lit,
                Along::Dark { .. } => lit,
                Along::Beyond => ends == Ends::Count,
            };
        nearest_change(rings, azimuths, HALVINGS, differs).unwrap_or(f64::INFINITY)
    }

    /// The angle from a point to the first change of its plane's light on the way to a direction;
    /// infinite where both ends are alike.
    pub fn edge_towards(&self, point: &Point, direction: DVec3) -> f64 {
        let Some(from) = (point.world - self.origin).try_normalize() else { return 0.0 };
        let lit = self.is_lit(point);
        let differs = |share: f64| match self.along(point, from.lerp(direction, share).normalize())
        {
            Along::Lit => !lit,
            Along::Dark { .. } => lit,
            Along::Beyond => true,
        };
        if !differs(1.0) {
            return f64::INFINITY;
        }
        let (mut same, mut other) = (0.0, 1.0);
        for _ in 0..2 * HALVINGS {
            let middle = 0.5 * (same + other);
            if differs(middle) { other = middle } else { same = middle }
        }
        from.angle_between(from.lerp(direction, other))
    }

    /// True where nothing keeps the light from a point.
    pub fn is_lit(&self, point: &Point) -> bool {
        self.truth.occluder(self.origin, point.world, point.triangle, 0.0).is_none()
    }

    /// The gap of a shadowed point and the least of its plane around it, and how much nearer than
    /// the point its occluder is, likewise.
    fn gaps(&self, point: &Point, direction: DVec3, angle: f64) -> [[f64; 2]; 2] {
        let distance = (point.world - self.origin).length();
        let Along::Dark { gap, occluder } = self.along(point, direction) else {
            return [[f64::INFINITY; 2]; 2];
        };
        let behind = distance - occluder;
        let around = (0..AZIMUTHS).map(|k| TAU * f64::from(k) / f64::from(AZIMUTHS));
        let [least_gap, least_behind] = around.fold([gap, behind], |[least, nearest], azimuth| {
            match self.along(point, turned(direction, azimuth, angle)) {
                Along::Dark { gap, occluder } => [least.min(gap), nearest.min(distance - occluder)],
                _ => [least, nearest],
            }
        });
        [[gap, least_gap], [behind, least_behind]]
    }

    /// Where a direction of the light meets a point's triangle, as an eye sees it, or for `None`
    /// as is seen from beside it.
    pub(super) fn on_triangle(
        &self,
        point: &Point,
        direction: DVec3,
        eye: Option<DVec3>,
    ) -> Option<Point> {
        let normal = point.normal?;
        let distance = normal.dot(point.world - self.origin) / normal.dot(direction);
        let there = self.origin + direction * distance;
        let eye = eye.unwrap_or(there + normal * (BESIDE * distance));
        let hit = self.truth.first_hit(&Ray::new(eye, there - eye))?;
        let world = self.truth.point(&hit).filter(|_| Some(hit.triangle) == point.triangle)?;
        Some(Point { world, ..*point })
    }

    /// What a unit direction of the light meets of a point's plane; without a normal the plane is a
    /// sphere around the light.
    fn along(&self, point: &Point, direction: DVec3) -> Along {
        let to_point = point.world - self.origin;
        let distance = match point.normal {
            Some(normal) => normal.dot(to_point) / normal.dot(direction),
            None => to_point.length(),
        };
        if !(distance.is_finite() && distance > 0.0) {
            return Along::Beyond;
        }
        let there = self.origin + direction * distance;
        match self.truth.occluder(self.origin, there, point.triangle, 0.0) {
            Some(hit) => Along::Dark { gap: distance - hit.distance, occluder: hit.distance },
            None => Along::Lit,
        }
    }
}

/// The unit direction at an angle from a unit axis.
pub(super) fn turned(axis: DVec3, azimuth: f64, angle: f64) -> DVec3 {
    let (side, other) = axis.any_orthonormal_pair();
    let (sin, cos) = azimuth.sin_cos();
    axis * angle.cos() + (side * cos + other * sin) * angle.sin()
}
