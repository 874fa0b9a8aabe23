//! What making and reading the maps costs, by what is drawn.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::scene::Scene;

/// Times of the steps, milliseconds each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// A map's pass, sorting's share included.
    pub pass: f64,
    /// A triangle that is sorted.
    pub sort: f64,
    /// A triangle drawn into a map.
    pub triangle: f64,
    /// A texel along a triangle's outline.
    pub outline: f64,
    /// A texel inside a triangle.
    pub inside: f64,
    /// A texel of a map: clearing and storing.
    pub texel: f64,
    /// A pixel's lookup of the four texels around it.
    pub lookup: f64,
}

impl Rates {
    /// llvmpipe's on two cores (docs/plan.md says how they were measured).
    pub const LLVMPIPE: Self = Self {
        pass: 0.48,
        sort: 1.3e-4,
        triangle: 7.8e-6,
        outline: 3.1e-5,
        inside: 1.3e-6,
        texel: 1.0e-6,
        lookup: 8.6e-6,
    };

    /// The same where triangles are drawn with straight edges (`vertex`, `fragment-depth`).
    pub const LLVMPIPE_STRAIGHT: Self = Self {
        pass: 0.072,
        sort: 3.7e-5,
        triangle: 5.2e-5,
        outline: 9.9e-6,
        inside: 1.1e-6,
        texel: 6.8e-7,
        ..Self::LLVMPIPE
    };
}

/// Time of exact maps over what the rates were fitted to, on llvmpipe (docs/plan.md).
pub const EXACT: f64 = 1.06;

/// A triangle as the light sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    corners: [DVec3; 3],
    middle: DVec3,
    /// Its sides' angles, together.
    outline: f64,
    /// Its solid angle.
    area: f64,
}

/// What is drawn into one map of a side of one texel: counts grow with the side and its square.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Triangles.
    pub triangles: f64,
    /// Texels along outlines, of the side.
    pub outline: f64,
    /// Texels inside, of the side's square.
    pub inside: f64,
}

impl Load {
    /// Adds a share of another.
    pub fn add(&mut self, other: &Self, share: f64) {
        self.triangles += other.triangles * share;
        self.outline += other.outline * share;
        self.inside += other.inside * share;
    }
}

/// The triangles of the meshes that are kept, as a light sees them.
pub fn seen(scene: &Scene, kept: &[bool], light: DVec3) -> Vec<Seen> {
    let meshes = scene.meshes.iter().zip(kept).filter(|(_, kept)| **kept);
    let triangles = meshes.flat_map(|(mesh, _)| {
        let corner = |i: u32| mesh.positions[i as usize].as_dvec3() - light;
        mesh.triangles.iter().filter_map(move |t| Seen::of(t.map(corner)))
    });
    triangles.collect()
}

impl Seen {
    fn of(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let [a, b, c] = [a.try_normalize()?, b.try_normalize()?, c.try_normalize()?];
        let angle = |p: DVec3, q: DVec3| p.cross(q).length().atan2(p.dot(q));
        // van Oosterom and Strackee 1983
        let volume = a.dot(b.cross(c)).abs();
        let area = 2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        Some(Self {
            corners: [a, b, c],
            middle: (a + b + c).normalize_or(a),
            outline: angle(a, b) + angle(b, c) + angle(c, a),
            area,
        })
    }

    /// True where the plane across an axis cuts it.
    pub fn straddles(&self, axis: DVec3) -> bool {
        let front = self.corners.map(|corner| corner.dot(axis) >= 0.0);
        front != [true; 3] && front != [false; 3]
    }
}

/// What the front and the back map of an axis hold.
pub fn loads(seen: &[Seen], axis: DVec3) -> [Load; 2] {
    let mut loads = [Load::default(); 2];
    for triangle in seen {
        let cosine = triangle.middle.dot(axis);
        // 1 + r^2 where its middle lies: texels a radian are N times a quarter of it
        let finer = 0.5 / (1.0 + cosine.abs());
        let both = triangle.straddles(axis);
        for (map, load) in loads.iter_mut().enumerate() {
            if both || (map == 1) == (cosine < 0.0) {
                load.triangles += 1.0;
                load.outline += triangle.outline * finer;
                load.inside += triangle.area * finer * finer;
            }
        }
    }
    loads
}

/// Milliseconds to make maps of a side, of which `loads` are drawn, sorting so many triangles.
pub fn generation(rates: &Rates, loads: &[Load], sorted: usize, size: u32) -> f64 {
    let size = f64::from(size);
    let of_map = |load: &Load| {
        rates.pass
            + rates.triangle * load.triangles
            + rates.outline * load.outline * size
            + (rates.inside * load.inside + rates.texel) * size * size
    };
    rates.sort * sorted as f64 + loads.iter().map(of_map).sum::<f64>()
}
