//! The level is enough, and not more.

use dpsm::scalar::float::Vec3;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::paraboloid::dpsm_project;
use dpsm::scalar::tessellate::*;

use crate::common::{CASES, EPS, Worst, cross, light, rng, spread, uniform, unit};
use crate::sub_triangles;

/// Distance of the origin from the nearest point of a triangle.
fn nearest([a, b, c]: [Vec3<f64>; 3]) -> f64 {
    let segment = |p: Vec3<f64>, q: Vec3<f64>| {
        let d = q - p;
        (p - d * (p.dot(d) / d.dot(d)).clamp(-1.0, 0.0)).length()
    };
    let edges = segment(a, b).min(segment(b, c)).min(segment(c, a));
    let n = cross(b - a, c - a);
    let sides = [cross(a, b).dot(n), cross(b, c).dot(n), cross(c, a).dot(n)];
    match sides.iter().all(|side| *side >= 0.0) {
        true => a.dot(n).abs() / n.length(),
        false => edges,
    }
}

/// How far the arc of an edge lies from its chord in texels, by points of the edge; `None` where
/// an end is not on the stored disk.
fn sagitta(a: Vec3<f64>, b: Vec3<f64>, light: DpsmLight<f64>) -> Option<f64> {
    let (start, end) = (dpsm_project(a), dpsm_project(b));
    let stored = (1.0 + light.guard) * (1.0 + 8.0 * f64::EPSILON);
    if start.length() > stored || end.length() > stored {
        return None;
    }
    let chord = end - start;
    let off = |i: u32| {
        let at = dpsm_project(a + (b - a) * (f64::from(i) / 32.0)) - start;
        (chord.x * at.y - chord.y * at.x).abs() / chord.length()
    };
    let texels = light.size / (2.0 * (1.0 + light.guard));
    Some((1..32).map(off).fold(0.0, f64::max) * texels)
}

/// A light's guard band, map size and tolerance as the level depends on them.
fn demand(rng: &mut fastrand::Rng) -> (DpsmLight<f64>, f64) {
    let guard = match rng.u8(0..3) {
        0 => 0.0,
        1 => 0.1 * rng.f32(),
        _ => rng.f32(),
    };
    let size = spread(rng, 5, 12).abs();
    let light = DpsmLight { guard, size, ..light(rng) };
    (light.widen(), spread(rng, -4, 3).abs().into())
}

#[test]
fn level_is_enough_for_every_edge_of_random_triangles() {
    let mut rng = rng("enough");
    let (mut worst, mut edges, mut triangles) = (Worst::default(), 0, 0);
    while triangles < 3000 {
        let (light, tau) = demand(&mut rng);
        let centre = unit(&mut rng).widen();
        let reach = f64::from(uniform(&mut rng, 0.02, 2.0));
        let corners = [(); 3].map(|()| centre + unit(&mut rng).widen() * reach);
        let [a, b, c] = corners;
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let level = dpsm_tessellate_level(longest, nearest(corners), light, tau, 1 << 15);
        if level > 16 {
            continue;
        }
        triangles += 1;
        for sub in sub_triangles(level) {
            let [p, q, r] = sub.map(|weights| dpsm_tessellate_point(a, b, c, weights));
            for (p, q) in [(p, q), (q, r), (r, p)] {
                if let Some(texels) = sagitta(p, q, light) {
                    edges += 1;
                    worst.note(texels, tau * (1.0 + 1e-9), (corners, level, light.guard));
                }
            }
        }
    }
    println!("{edges} edges");
    assert!(edges > 10_000);
    worst.check("sagitta against tau");
}

/// An edge of a length and distance that lies along the stored border, where edges bow most: both
/// ends on it, the middle nearest to the light.
fn border_edge(length: f64, distance: f64, guard: f64) -> Option<[Vec3<f64>; 2]> {
    let square = (1.0 + guard) * (1.0 + guard);
    let cosine = distance / (0.25 * length * length + distance * distance).sqrt();
    let height = (1.0 - square) / (1.0 + square) / cosine;
    if height <= -1.0 {
        return None;
    }
    let middle = Vec3::new((1.0 - height * height).sqrt(), 0.0, height) * distance;
    let half = Vec3::new(0.0, 0.5 * length, 0.0);
    Some([middle - half, middle + half])
}

#[test]
fn level_is_enough_along_the_border_and_one_less_is_not() {
    let mut rng = rng("border");
    let (mut enough, mut checked) = (Worst::default(), 0);
    for _ in 0..CASES / 10 {
        let (light, tau) = demand(&mut rng);
        let (length, distance) = (spread(&mut rng, -3, 5).abs().into(), 1.0);
        let level = dpsm_tessellate_level(length, distance, light, tau, 1 << 15);
        let k = 1.0 + light.guard;
        let edge = |cuts: u32| border_edge(length / f64::from(cuts), distance, light.guard);
        if let Some([a, b]) = edge(level) {
            let texels = sagitta(a, b, light).unwrap();
            enough.note(texels, tau * (1.0 + 1e-9), (length, light.guard, light.size, tau));
        }
        // where tau is so large that the level keeps edges short for another reason, or 1
        let short = 4.0 * tau / (light.size * (1.0 + k * k)) >= 0.25 / (k * k);
        let Some([a, b]) = edge(level.saturating_sub(1).max(1)) else { continue };
        if level == 1 || short {
            continue;
        }
        checked += 1;
        // the bound takes the edge's plane to lean as the border does: with a guard band it leans
        // less, |m_z| against 2 k / (1 + k^2); the rest is the exact sagitta at both
        let half = 0.5 * length / f64::from(level - 1);
        let sine_square = half * half / (half * half + distance * distance);
        let lean = (a + b).xy().length() / (a + b).length();
        let allowed = 2.0 * k / (1.0 + k * k);
        let root = |lean: f64| {
            1.0 + (1.0 - sine_square * (lean * (1.0 + k * k) / 2.0).powi(2)).max(0.0).sqrt()
        };
        let ratio = lean / allowed * root(allowed) / root(lean);
        let texels = sagitta(a, b, light).unwrap();
        assert!(texels >= tau * ratio * (1.0 - 1e-9), "{texels} {tau} {ratio} {light:?} {length}");
        if light.guard == 0.0 {
            assert!(ratio >= 1.0 - 1e-9 && texels > tau * (1.0 - 1e-9));
        }
    }
    println!("{checked} one level less");
    assert!(checked > CASES / 100);
    enough.check("sagitta along the border against tau");
}

#[test]
fn level_in_f32_is_that_of_a_length_within_its_bound() {
    let mut rng = rng("level");
    for _ in 0..CASES {
        let (wide, tau) = demand(&mut rng);
        let light =
            DpsmLight { guard: wide.guard as f32, size: wide.size as f32, ..light(&mut rng) };
        let length = spread(&mut rng, -8, 8).abs();
        let distance = spread(&mut rng, -8, 8).abs();
        let level = dpsm_tessellate_level(length, distance, light, tau as f32, 1 << 15);
        let exact = |off: f64| {
            let length = f64::from(length) * (1.0 + off * EPS);
            dpsm_tessellate_level(length, distance.into(), light.widen(), tau, 1 << 15)
        };
        assert!((exact(-21.0)..=exact(21.0)).contains(&level), "{level} {}", exact(0.0));
    }
}

#[test]
fn level_stays_between_one_and_most_whatever_is_asked() {
    let light = dpsm::cases::light(0);
    let level = |longest, distance, tau, most| {
        dpsm_tessellate_level::<f32>(longest, distance, light, tau, most)
    };
    assert_eq!(level(1.0, 0.0, 0.5, 64), 64);
    assert_eq!(level(0.0, 1.0, 0.5, 64), 1);
    assert_eq!(level(0.0, 0.0, 0.0, 64), 1);
    assert_eq!(level(1e-6, 1.0, 0.0, 64), 1);
    assert_eq!(level(1e18, 1.0, -1.0, 64), 64);
    assert_eq!(level(1.0, 1.0, 0.5, 0), 1);
    // tan(phi / 2) = 1 uncut: 90 degrees, more than the 83 that any tolerance leaves
    assert_eq!(level(4.0, 2.0, 1e9, 64), 2);
}
