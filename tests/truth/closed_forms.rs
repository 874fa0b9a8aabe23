//! Against closed forms: a ball over a plane, a box in a room.

use crate::common::rng;
use crate::*;

const POINTS: usize = 200_000;

/// Parameters at which a ray enters and leaves a cuboid, with the axes of the two faces.
fn slabs(origin: DVec3, direction: DVec3, min: DVec3, max: DVec3) -> [(f64, usize); 2] {
    let (from, to) = ((min - origin) / direction, (max - origin) / direction);
    let (enter, leave) = (from.min(to), from.max(to));
    [(enter.max_element(), enter.max_position()), (leave.min_element(), leave.min_position())]
}

#[test]
fn a_ball_over_a_plane_casts_the_cones_disk() {
    const RADIUS: f64 = 1.0;
    const LIGHT: f64 = 3.0; // above the ball's middle
    const FLOOR: f64 = -2.0;
    let light = DVec3::Y * LIGHT;
    let mut triangles = ball(RADIUS, 6);
    // Every face's plane is at least this far from the middle: the mesh encloses that ball and
    // lies in the one of RADIUS.
    let inner = triangles.iter().map(|&[a, b, c]| (b - a).cross(c - a).normalize().dot(a).abs());
    let inner = inner.fold(RADIUS, f64::min);
    assert!(inner > 0.999);
    let [a, b, c, d] =
        [(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)].map(|(x, z)| dvec3(x, FLOOR, z));
    let floor = triangles.len() as u32;
    triangles.extend([[a, b, c], [a, c, d]]);
    let truth = soup(&triangles);

    let mut rng = rng("ball");
    let points: Vec<_> = (0..POINTS).map(|_| within(&mut rng, 4.0).with_y(FLOOR)).collect();
    let rays: Vec<_> = points.iter().map(|&point| Ray::new(light, point - light)).collect();
    let receivers: Vec<_> = points.iter().map(|&point| (point, None)).collect();
    let hits = truth.first_hits(&rays);
    let occluders = truth.occluders(light, &receivers, 0.0);
    let (mut lit, mut dark, mut skipped) = (0, 0, 0);
    for ((&point, hit), occluder) in points.iter().zip(hits).zip(occluders) {
        let hit = hit.unwrap();
        let length = (point - light).length();
        // Distance of the ray from the ball's middle, by the cone's half-angle.
        let aside = LIGHT * (point - light).with_y(0.0).length() / length;
        if aside > RADIUS + 1e-12 {
            lit += 1;
            assert!(occluder.is_none() && hit.triangle >= floor, "{point}");
            let bound = DISTANCE * 9.0 * length / (LIGHT - FLOOR);
            assert!((hit.distance - length).abs() <= bound, "{point}");
        } else if aside < inner - 1e-12 {
            dark += 1;
            assert!(hit.triangle < floor && occluder == Some(hit), "{point}");
            let entry = |radius: f64| {
                let along = (LIGHT * LIGHT - aside * aside).sqrt();
                along - (radius * radius - aside * aside).sqrt()
            };
            // 1e-7: the roots lose half their digits where the ray grazes.
            let range = entry(RADIUS) - 1e-7..=entry(inner) + 1e-7;
            assert!(range.contains(&hit.distance), "{point} {hit:?} {range:?}");
        } else {
            skipped += 1;
        }
    }
    println!("{lit} lit, {dark} dark, {skipped} in the band of {:.1e}", RADIUS - inner);
    assert!(lit > POINTS / 4 && dark > POINTS / 10 && skipped < POINTS / 500);
}

#[test]
fn in_a_room_with_a_box_every_ray_hits_the_right_face_at_the_right_distance() {
    let room = [dvec3(-4.0, 0.0, -3.0), dvec3(4.0, 4.0, 3.0)];
    let solid = [dvec3(-1.0, 0.5, -0.75), dvec3(0.5, 1.5, 1.0)];
    let triangles = [cuboid(room[0], room[1]), cuboid(solid[0], solid[1])].concat();
    let truth = soup(&triangles);
    let mut rng = rng("room");
    let (mut at_box, mut at_wall, mut skipped) = (0, 0, 0);
    for _ in 0..POINTS {
        let origin = room[0] + (room[1] - room[0]) * DVec3::from([0; 3].map(|_| rng.f64()));
        if origin.cmpgt(solid[0] - 0.01).all() && origin.cmplt(solid[1] + 0.01).all() {
            continue;
        }
        let direction = direction(&mut rng);
        let [enter, leave] = slabs(origin, direction, solid[0], solid[1]);
        if (enter.0 - leave.0).abs() < 1e-9 {
            skipped += 1;
            continue;
        }
        let meets_box = enter.0 < leave.0 && enter.0 > 0.0;
        let (face, (parameter, axis)) = match meets_box {
            true => (6 + 2 * enter.1 + usize::from(direction[enter.1] < 0.0), enter),
            false => {
                let [_, wall] = slabs(origin, direction, room[0], room[1]);
                (2 * wall.1 + usize::from(direction[wall.1] > 0.0), wall)
            }
        };
        let hit = truth.first_hit(&Ray::new(origin, direction)).unwrap();
        assert_eq!(hit.triangle as usize / 2, face, "{origin} {direction}");
        let length = direction.length();
        let reach = reach(triangles[hit.triangle as usize], origin);
        // The closed form itself: four roundings.
        let bound = DISTANCE * reach * length / direction[axis].abs()
            + 2.0 * f64::EPSILON * parameter * length;
        assert!((hit.distance - parameter * length).abs() <= bound, "{origin} {direction}");
        *(if meets_box { &mut at_box } else { &mut at_wall }) += 1;
    }
    println!("{at_box} at the box, {at_wall} at a wall, {skipped} along its edges");
    assert!(at_box > POINTS / 50 && at_wall > POINTS / 2 && skipped < 100);
}

#[test]
fn the_boxs_shadow_on_the_floor_is_that_of_the_closed_form() {
    let (light, min, max) = (dvec3(0.5, 3.5, -0.25), dvec3(-1.0, 0.5, -0.75), dvec3(0.5, 1.5, 1.0));
    let room = cuboid(dvec3(-4.0, 0.0, -3.0), dvec3(4.0, 4.0, 3.0));
    let truth = soup(&[room, cuboid(min, max)].concat());
    let mut rng = rng("floor");
    let (mut dark, mut skipped) = (0, 0);
    for _ in 0..POINTS {
        let point = dvec3(8.0 * rng.f64() - 4.0, 0.0, 6.0 * rng.f64() - 3.0);
        let own = truth.first_hit(&Ray::new(point + DVec3::Y * 0.1, DVec3::NEG_Y)).unwrap();
        assert!((4..6).contains(&own.triangle), "the floor");
        let [enter, leave] = slabs(light, point - light, min, max);
        if (enter.0 - leave.0).abs() < 1e-12 {
            skipped += 1;
            continue;
        }
        let occluder = truth.occluder(light, point, Some(own.triangle), 0.0);
        assert_eq!(occluder.is_some(), enter.0 < leave.0, "{point}");
        assert!(occluder.is_none_or(|hit| hit.triangle >= 12));
        dark += u32::from(occluder.is_some());
    }
    println!("{dark} of {POINTS} dark, {skipped} on the shadow's edge");
    assert!(dark > 10_000 && skipped < 100);
}
