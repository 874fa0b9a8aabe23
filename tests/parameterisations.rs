//! Maps of all directions: the computed figures against independent ones,
//! docs/parameterisations.md.

#![cfg(feature = "cli")]

use std::f64::consts::PI;

use dpsm::report::parameterisations::{Map, parameterisations};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::paraboloid::dpsm_texel_solid_angle;
use glam::{DVec2, DVec3, dvec2, dvec3};

/// Texels along a side of an image where they are all visited.
const SIDE: usize = 600;

/// The middles of all texels of all images that hold a direction, and the area of one.
fn texels(map: Map) -> (Vec<(usize, DVec2)>, f64) {
    let step = 2.0 * map.extent() / SIDE as f64;
    let middle = |i: usize, j: usize| step * (dvec2(i as f64, j as f64) + 0.5) - map.extent();
    let all = (0..map.images())
        .flat_map(|image| (0..SIDE * SIDE).map(move |at| (image, middle(at % SIDE, at / SIDE))));
    (all.filter(|&(image, at)| map.direction(image, at).is_some()).collect(), step.x * step.y)
}

/// Where a direction is stored, from each map's definition and not by its inverse in the library.
fn stored(map: Map, d: DVec3) -> DVec2 {
    let major = d.abs().max_element();
    match map {
        // the mirror's normal halves the angle to the viewer
        Map::Sphere => (d + DVec3::Z).normalize().truncate(),
        Map::LongitudeLatitude => dvec2(d.x.atan2(d.z), d.y.asin()),
        Map::Paraboloids => d.truncate() / (1.0 + d.z.abs()),
        Map::Cube if d.x.abs() == major => dvec2(d.y, d.z) / major,
        Map::Cube if d.y.abs() == major => dvec2(d.z, d.x) / major,
        Map::Cube => dvec2(d.x, d.y) / major,
        Map::Octahedron => {
            let p = d / (d.x.abs() + d.y.abs() + d.z.abs());
            if p.z >= 0.0 { p.truncate() } else { (1.0 - p.truncate().yx().abs()) * signs(p) }
        }
        Map::Tetrahedron => unreachable!("only its images are defined"),
    }
}

fn signs(p: DVec3) -> DVec2 {
    dvec2(p.x.signum(), p.y.signum())
}

trait Swapped {
    fn yx(self) -> Self;
}

impl Swapped for DVec2 {
    fn yx(self) -> Self {
        dvec2(self.y, self.x)
    }
}

#[test]
fn texels_of_every_map_add_up_to_the_sphere() {
    for map in Map::ALL {
        let (texels, area) = texels(map);
        let sum: f64 = texels.iter().map(|&(image, at)| map.solid_angle(image, at) * area).sum();
        // the midpoint rule errs by h^2 / 24 of the second derivatives, at most 30 per unit of area
        // here, in each direction; a disk's rim decides for at most 8 N texels a disk, half of
        // which err by half a texel each in a random walk: 4 standard deviations
        let step = map.extent().max_element() * 2.0 / SIDE as f64;
        let rim = match map {
            Map::Sphere | Map::Paraboloids => 4.0 * (8.0 * SIDE as f64).sqrt() * 4.0 * area,
            // texels on the diagonals belong to one quarter or the other, and no two are alike
            Map::Tetrahedron => 2.0 * SIDE as f64 * area,
            _ => 0.0,
        };
        let tolerance = 2.0 * 30.0 / 24.0 * step * step * map.area() + rim;
        let off = (sum - 4.0 * PI).abs();
        assert!(off <= tolerance, "{map:?}: {sum} is off by {off}, more than {tolerance}");
    }
}

#[test]
fn sides_are_the_differences_of_neighbouring_directions() {
    let mut rng = fastrand::Rng::with_seed(3);
    let h = 1e-6;
    for map in Map::ALL {
        for _ in 0..20_000 {
            let image = rng.usize(..map.images());
            let at = map.extent() * dvec2(2.0 * rng.f64() - 1.0, 2.0 * rng.f64() - 1.0) * 0.999;
            // no derivative on the folds and the diagonals, and none outside the disks
            let folds = [at.x, at.y, at.x.abs() + at.y.abs() - 1.0, at.x.abs() - at.y.abs()];
            if folds.iter().any(|fold| fold.abs() < 1e-5)
                || at.length() > 0.999 && map.extent() == DVec2::ONE
            {
                continue;
            }
            let d = |x: f64, y: f64| map.direction(image, at + dvec2(x, y)).unwrap();
            let dx = (d(h, 0.0) - d(-h, 0.0)) / (2.0 * h);
            let dy = (d(0.0, h) - d(0.0, -h)) / (2.0 * h);
            let [longest, shortest] = map.sides(image, at);
            // rounding 1e-16 / h, and h^2 of the third derivatives, which grow as 1 / c^5 on a
            // sphere map, c >= 0.04
            let tolerance = 1e-6 * longest.powi(2) * longest.max(1.0);
            let area = dx.cross(dy).length();
            assert!((area - map.solid_angle(image, at)).abs() <= tolerance, "{map:?} {at}: {area}");
            // both singular values: their squares add up to those of the columns
            let sum = dx.length_squared() + dy.length_squared();
            let squares = longest.powi(2) + shortest.powi(2);
            assert!((sum - squares).abs() <= tolerance * longest, "{map:?} {at}: {sum} {squares}");
        }
    }
}

#[test]
fn directions_are_those_of_the_definitions() {
    for map in Map::ALL.into_iter().filter(|&map| map != Map::Tetrahedron) {
        let (texels, _) = texels(map);
        for &(image, at) in texels.iter().step_by(7) {
            let back = stored(map, map.direction(image, at).unwrap());
            // the sphere map's rim is the direction behind: 1 / c times the rounding
            assert!((back - at).abs().max_element() < 1e-9, "{map:?} {image} {at}: {back}");
        }
    }
    // each face's three corners, and no direction in two faces: the nearest corner's opposite
    let corners =
        [DVec3::ONE, dvec3(1.0, -1.0, -1.0), dvec3(-1.0, 1.0, -1.0), dvec3(-1.0, -1.0, 1.0)];
    let (texels, _) = texels(Map::Tetrahedron);
    for &(image, at) in
        texels.iter().step_by(7).filter(|(_, at)| (at.x.abs() - at.y.abs()).abs() > 1e-9)
    {
        let d = Map::Tetrahedron.direction(image, at).unwrap();
        let face = match at.x.abs() > at.y.abs() {
            false => usize::from(at.y > 0.0),
            true => {
                if at.x > 0.0 {
                    2
                } else {
                    3
                }
            }
        };
        let away = |k: &usize| corners[*k].dot(d);
        let opposite = (0..4).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
        assert_eq!(opposite, (face + 3) % 4, "{at}");
    }
}

#[test]
fn paraboloids_texel_is_the_librarys() {
    let (texels, area) = texels(Map::Paraboloids);
    for &(image, at) in texels.iter().step_by(11) {
        let own = Map::Paraboloids.solid_angle(image, at) * area;
        let module = dpsm_texel_solid_angle(Vec2::new(at.x, at.y), SIDE as f64, 0.0);
        assert!((own - module).abs() <= 1e-14 * module, "{at}: {own} {module}");
    }
}

#[test]
fn no_texel_exceeds_the_extremes() {
    for (map, figures) in Map::ALL.into_iter().zip(parameterisations()) {
        let (texels, _) = texels(map);
        let (mut largest, mut smallest, mut side, mut anisotropy) =
            (0f64, f64::INFINITY, 0f64, 0f64);
        for (image, at) in texels {
            let solid_angle = map.solid_angle(image, at) * map.area();
            let [long, short] = map.sides(image, at);
            largest = largest.max(solid_angle);
            smallest = smallest.min(solid_angle);
            side = side.max(long.powi(2) * map.area());
            anisotropy = anisotropy.max(long / short);
        }
        // the extremes are at corners and centres, within a texel of one that is visited; the
        // steepest fall is the tetrahedron's, 3 / 2 of the square at the corner: 3% in a texel
        let near = |found: f64, stated: Option<f64>, what: &str| match stated {
            Some(stated) => {
                let share = found / stated;
                assert!((0.97..=1.0 + 1e-9).contains(&share), "{map:?} {what}: {found} {stated}");
            }
            None => assert!(found > 100.0, "{map:?} {what}: {found} is no infinity"),
        };
        near(largest, Some(figures.largest), "largest");
        near(side, figures.texels_for_equal_side, "side");
        near(anisotropy, figures.anisotropy, "anisotropy");
        match figures.ratio {
            Some(_) => near(1.0 / smallest, Some(1.0 / figures.smallest), "smallest"),
            None => assert!(figures.smallest == 0.0 && smallest < largest / 100.0, "{map:?}"),
        }
    }
}

#[test]
fn texels_needed_are_the_known_ones() {
    let texels = |name: &str| {
        let all = parameterisations();
        let map = all.iter().find(|map| map.name == name).unwrap();
        (map.texels_for_equal_largest, map.used, map.ratio)
    };
    let close = |(texels, used, ratio): (f64, f64, Option<f64>), stated: (f64, f64, f64)| {
        let off = (texels - stated.0).abs().max((used - stated.1).abs());
        assert!(off < 1e-12 * texels && (ratio.unwrap() - stated.2).abs() < 1e-12, "{stated:?}");
    };
    let root = 3f64.sqrt();
    close(texels("dual paraboloid"), (32.0, PI / 4.0, 4.0));
    close(texels("cube"), (24.0, 1.0, 3.0 * root));
    close(texels("octahedron"), (12.0 * root, 1.0, 3.0 * root));
    close(texels("sphere map"), (16.0, PI / 4.0, 1.0));
    // fields of view of 143.99 and 125.26 degrees, as renderers of tetrahedron maps set them
    let [across, along] = [143.98570868f64, 125.26438968].map(|a| (a / 2.0).to_radians().tan());
    let (tetrahedron, _, ratio) = texels("tetrahedron");
    assert!((tetrahedron - 8.0 * across * along).abs() < 1e-6, "{tetrahedron}");
    let corner = (1.0 + across * across + along * along).powf(1.5);
    assert!((ratio.unwrap() - corner).abs() < 1e-5 * corner, "{ratio:?} {corner}");
}

#[test]
fn paraboloids_are_not_said_to_win_on_texels() {
    let all = parameterisations();
    let paraboloids = all.iter().find(|map| map.name == "dual paraboloid").unwrap();
    let fewer = all.iter().filter(|m| m.texels_for_equal_largest < paraboloids.largest).count();
    assert!(fewer >= 3);
    assert!(paraboloids.note.contains("do not win on texels"));
}
