//! Maps of all directions, compared as Brabec, Annen and Seidel 2002 do in their section 3:
//! docs/parameterisations.md.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::data::Parameterisation;

/// A map of all directions to one or more images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// The image of all directions in a small mirror ball, seen along its axis.
    Sphere,
    /// Longitude and latitude (Blinn and Newell).
    LongitudeLatitude,
    /// Six perspective images of 90 degrees.
    Cube,
    /// Two stereographic disks, each in a square.
    Paraboloids,
    /// The octahedron, its lower half unfolded around the upper one into a square.
    Octahedron,
    /// Four perspective images of a tetrahedron's faces, the quarters of a square (Liao).
    Tetrahedron,
}

impl Map {
    /// Every map, in the order of the report.
    pub const ALL: [Self; 6] = [
        Self::Sphere,
        Self::LongitudeLatitude,
        Self::Cube,
        Self::Paraboloids,
        Self::Octahedron,
        Self::Tetrahedron,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere map",
            Self::LongitudeLatitude => "longitude-latitude",
            Self::Cube => "cube",
            Self::Paraboloids => "dual paraboloid",
            Self::Octahedron => "octahedron",
            Self::Tetrahedron => "tetrahedron",
        }
    }

    /// Stored images, each a rectangle.
    pub fn images(self) -> usize {
        match self {
            Self::Cube => 6,
            Self::Paraboloids => 2,
            _ => 1,
        }
    }

    /// Images that are rasterised one by one: a pass each, or a viewport.
    pub fn passes(self) -> u32 {
        match self {
            Self::Sphere | Self::LongitudeLatitude => 1,
            Self::Paraboloids => 2,
            Self::Tetrahedron => 4,
            Self::Cube => 6,
            Self::Octahedron => 8,
        }
    }

    /// Half the width and height of an image, whose middle is (0, 0).
    pub fn extent(self) -> DVec2 {
        match self {
            Self::LongitudeLatitude => dvec2(PI, FRAC_PI_2),
            _ => DVec2::ONE,
        }
    }

    /// The area of all images.
    pub fn area(self) -> f64 {
        self.images() as f64 * 4.0 * self.extent().x * self.extent().y
    }

    /// The unit direction stored at a place of an image; `None` where no direction is.
    pub fn direction(self, image: usize, place: DVec2) -> Option<DVec3> {
        let square = place.length_squared();
        Some(match self {
            Self::Sphere | Self::Paraboloids if square > 1.0 => return None,
            Self::Sphere => {
                let half = place.extend((1.0 - square).sqrt());
                2.0 * half.z * half - DVec3::Z
            }
            Self::LongitudeLatitude => {
                let (across, height) = (place.y.cos(), place.y.sin());
                dvec3(across * place.x.sin(), height, across * place.x.cos())
            }
            Self::Paraboloids => {
                let forward = if image == 0 { 1.0 } else { -1.0 };
                dvec3(2.0 * place.x, 2.0 * place.y, (1.0 - square) * forward) / (1.0 + square)
            }
            _ => self.plane(image, place).0.normalize(),
        })
    }

    /// The longest and the shortest of all angles that a step of unit length turns the direction
    /// by.
    pub fn sides(self, image: usize, place: DVec2) -> [f64; 2] {
        match self {
            Self::Sphere => {
                let half = (1.0 - place.length_squared()).max(0.0).sqrt();
                [2.0 / half, 2.0 * half]
            }
            Self::LongitudeLatitude => [1.0, place.y.cos()],
            Self::Paraboloids => [2.0 / (1.0 + place.length_squared()); 2],
            _ => self.singular_values(image, place),
        }
    }

    /// Solid angle of a unit of area at a place of an image.
    pub fn solid_angle(self, image: usize, place: DVec2) -> f64 {
        if self == Self::Sphere {
            return 4.0; // 2 / c times 2 c, also on the rim, where c is 0
        }
        let [longest, shortest] = self.sides(image, place);
        longest * shortest
    }

    /// A point on the polyhedron, and its steps along x and y.
    fn plane(self, image: usize, place: DVec2) -> (DVec3, DVec3, DVec3) {
        let DVec2 { x, y } = place;
        match self {
            Self::Octahedron => {
                let (a, b) = (1f64.copysign(x), 1f64.copysign(y));
                let height = 1.0 - x.abs() - y.abs();
                if height >= 0.0 {
                    return (dvec3(x, y, height), dvec3(1.0, 0.0, -a), dvec3(0.0, 1.0, -b));
                }
                let folded = dvec3((1.0 - y.abs()) * a, (1.0 - x.abs()) * b, height);
                (folded, dvec3(0.0, -a * b, -a), dvec3(-a * b, 0.0, -b))
            }
            Self::Tetrahedron => quarter(place),
            _ => {
                let sign = if image.is_multiple_of(2) { 1.0 } else { -1.0 };
                let turned = |v: DVec3| match image / 2 {
                    0 => dvec3(v.z, v.x, v.y),
                    1 => dvec3(v.y, v.z, v.x),
                    _ => v,
                };
                (turned(dvec3(x, y, sign)), turned(DVec3::X), turned(DVec3::Y))
            }
        }
    }

    /// Singular values of the direction's derivative on a polyhedron.
    fn singular_values(self, image: usize, place: DVec2) -> [f64; 2] {
        let (point, across, along) = self.plane(image, place);
        let square = point.length_squared();
        // a step turns the direction by its part across the direction, over the distance
        let product =
            |a: DVec3, b: DVec3| (a.dot(b) - a.dot(point) * b.dot(point) / square) / square;
        let (xx, xy, yy) = (product(across, across), product(across, along), product(along, along));
        let (mean, apart) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
        [(mean + apart).sqrt(), (mean - apart).max(0.0).sqrt()]
    }

    /// Places of the first image that have the extremes of all, docs/parameterisations.md.
    fn extremes(self) -> Vec<DVec2> {
        match self {
            Self::Sphere => vec![DVec2::ZERO, DVec2::X],
            Self::LongitudeLatitude => vec![DVec2::ZERO],
            Self::Paraboloids => vec![DVec2::ZERO, DVec2::X],
            Self::Cube => vec![DVec2::ZERO, DVec2::ONE],
            Self::Octahedron => vec![DVec2::splat(1.0 / 3.0), DVec2::ZERO, DVec2::X],
            // the image's own axis, half way up; a corner of the base
            Self::Tetrahedron => vec![dvec2(0.0, -0.5), dvec2(-1.0, -1.0)],
        }
    }

    fn note(self) -> &'static str {
        match self {
            Self::Sphere => {
                "Every texel has the same solid angle, but towards the rim it becomes a sliver: \
                 the whole rim is one direction, the one behind. Straight edges bow, and triangles \
                 across that direction cover a ring: nothing rasterises them in one pass as they \
                 are."
            }
            Self::LongitudeLatitude => {
                "Fewest texels of all at an equal longest side, yet texels shrink to nothing at \
                 both poles, straight edges bow, and a triangle over a pole or across the date \
                 line falls apart; the lookup needs an arc tangent and an arc sine."
            }
            Self::Cube => {
                "Straight edges stay straight, so the rasteriser draws it as it is. It needs fewer \
                 texels than two paraboloids, and three times the passes."
            }
            Self::Paraboloids => {
                "Paraboloids do not win on texels: a cube needs a quarter fewer for an equal \
                 largest texel, and the corners of each square are unused. What they win on is \
                 passes, two, and texels that are square everywhere and vary by 4 alone."
            }
            Self::Octahedron => {
                "Fewest texels of the maps that fill a square with flat pieces, judged by solid \
                 angle; judged by their longest side more than paraboloids need, since texels \
                 lean. Each of the eight faces is a perspective image of its own, or a cube is \
                 made first and resampled."
            }
            Self::Tetrahedron => {
                "Four perspective images whose axes halve the angle between a face's base and its \
                 apex, 143.99 by 125.26 degrees wide, each filling a quarter of a square: no texel \
                 is unused, but angles that wide make texels at the corners 53 times smaller than \
                 in the middle."
            }
        }
    }

    fn figures(self) -> Parameterisation {
        let places = self.extremes();
        let most = |of: &dyn Fn(DVec2) -> f64| places.iter().map(|p| of(*p)).fold(0.0, f64::max);
        let finite = |value: f64| (value < 1e12).then_some(value);
        let largest = self.area() * most(&|place| self.solid_angle(0, place));
        let vanishes = self == Self::LongitudeLatitude;
        let smallest =
            if vanishes { 0.0 } else { self.area() / most(&|p| 1.0 / self.solid_angle(0, p)) };
        let ratio = |[longest, shortest]: [f64; 2]| longest / shortest;
        let anisotropy = most(&|place| ratio(self.sides(0, place)));
        Parameterisation {
            name: self.name().to_string(),
            passes: self.passes(),
            used: match self {
                Self::Sphere | Self::Paraboloids => FRAC_PI_4,
                _ => 1.0,
            },
            largest,
            smallest,
            ratio: finite(largest / smallest),
            texels_for_equal_largest: largest,
            texels_for_equal_side: finite(
                self.area() * most(&|place| self.sides(0, place)[0].powi(2)),
            ),
            anisotropy: if vanishes { None } else { finite(anisotropy) },
            note: self.note().to_string(),
        }
    }
}

/// A place of the square that its diagonals cut into four images of a tetrahedron's faces: the
/// point on the image's plane, and its steps along x and y.
fn quarter(place: DVec2) -> (DVec3, DVec3, DVec3) {
    const CORNERS: [DVec3; 4] = [
        DVec3::ONE,
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::new(-1.0, -1.0, 1.0),
    ];
    let DVec2 { x, y } = place;
    // inwards is the way from the quarter's base, an edge of the square, to its apex in the middle
    let (face, across, inwards) = match x.abs() > y.abs() {
        false if y <= 0.0 => (0, DVec2::X, DVec2::Y),
        false => (1, -DVec2::X, -DVec2::Y),
        true if x > 0.0 => (2, DVec2::Y, -DVec2::X),
        true => (3, -DVec2::Y, DVec2::X),
    };
    let [left, right, apex] = [1, 2, 0].map(|corner| CORNERS[(face + corner) % 4]);
    let axis = ((left + right).normalize() + apex.normalize()).normalize();
    let [left, right, apex] = [left, right, apex].map(|corner| corner / corner.dot(axis));
    let (middle, half) = ((left + right) / 2.0, (right - left) / 2.0);
    let point = middle + half * place.dot(across) + (apex - middle) * (1.0 + place.dot(inwards));
    let step = |along: DVec2| half * along.dot(across) + (apex - middle) * along.dot(inwards);
    (point, step(DVec2::X), step(DVec2::Y))
}

/// The figures of every map.
///
/// ```
/// let all = dpsm::report::parameterisations::parameterisations();
/// let cube = all.iter().find(|map| map.name == "cube").unwrap();
/// assert!((cube.texels_for_equal_largest - 24.0).abs() < 1e-9);
/// ```
pub fn parameterisations() -> Vec<Parameterisation> {
    Map::ALL.iter().map(|map| map.figures()).collect()
}
