//! From linear light to a picture: samples, exposure, background, and what the light sees.

#![cfg(feature = "cli")]

mod common;
#[path = "common/scenes.rs"]
mod scenes;

use common::device;
use dpsm::measure::{Bench, truth_of};
use dpsm::render::{
    AMBIENT, BACKGROUND, BRIGHTEST, CLIPPED, Frame, Linear, Method, Picture, Rendering, SPECULAR,
    Settings, exposure, srgb,
};
use dpsm::scalar::float::Vec2;
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scalar::paraboloid::dpsm_disk_to_texture;
use dpsm::scene::{self, Camera, Mesh, Options, Scene};
use dpsm::{cpu, gpu};
use glam::{DVec3, Vec3, vec3};
use scenes::square;

fn settings() -> Settings {
    Settings { size: 256, image: [96, 72], exposure: Some(1.0), ..Settings::default() }
}

fn room(walls: u32, settings: Settings) -> Frame {
    let scene = scene::open("brabec-room", &Options { walls, ..Options::default() }).unwrap();
    let (light, camera) = (scene.default_light(), scene.camera.unwrap());
    Frame::new(&scene, light.position, Vec3::NEG_Y, false, &camera, settings).unwrap()
}

/// Pixels of two pictures that are more than so many levels apart.
fn apart(a: &Picture, b: &Picture, levels: u8) -> usize {
    let differs =
        |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > levels);
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| differs((a, b))).count()
}

#[test]
fn samples_of_a_pixel_share_no_row_and_no_column() {
    for samples in 1..=8 {
        let places = Settings { samples, ..settings() }.places();
        let count = samples * samples;
        assert_eq!(places.len(), count as usize);
        for axis in 0..2 {
            let mut steps: Vec<_> =
                places.iter().map(|place| (place[axis] * count as f32 - 0.5).round()).collect();
            steps.sort_by(f32::total_cmp);
            assert_eq!(steps, (0..count).map(|step| step as f32).collect::<Vec<_>>());
        }
    }
    assert_eq!(Settings { samples: 1, ..settings() }.places(), [[0.5; 2]]);
}

#[test]
fn silhouette_has_as_many_shades_as_samples_and_their_mean_is_its_area() {
    let floor = square("floor", 0.0, 0.0, 1.0);
    let scene = Scene {
        name: "made".into(),
        origin: Default::default(),
        meshes: vec![floor],
        lights: Vec::new(),
        camera: None,
        warnings: Vec::new(),
    };
    // from straight above, turned by 0.3 rad: 4 units high and wide
    let camera = Camera {
        eye: vec3(0.0, 2.0, 0.0),
        target: Vec3::ZERO,
        up: vec3(0.3_f32.sin(), 0.0, 0.3_f32.cos()),
        vertical_fov: std::f32::consts::FRAC_PI_2,
    };
    for samples in [1, 2, 4] {
        let settings = Settings { image: [65, 65], samples, ..settings() };
        // a light so far below that no direct light is on the floor's upper side
        let light = vec3(0.0, -50.0, 0.0);
        let frame =
            Frame::new(&scene, light, Vec3::NEG_Y, false, &camera, settings.clone()).unwrap();
        let [port, adapter] = [Some(cpu::render(&frame).unwrap()), {
            device().map(|device| gpu::render(&device, &frame).unwrap())
        }];
        for Rendering { lit, .. } in port.into_iter().chain(adapter) {
            // linear light is background (1 - covered) + at most AMBIENT covered: darker inside
            let linear = |byte: u8| {
                let c = f64::from(byte) / 255.0;
                if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
            };
            let mut area = 0.0;
            let mut partly = 0;
            for pixel in &lit.pixels {
                let inside = 0.95 * f64::from(AMBIENT);
                let covered =
                    (f64::from(BACKGROUND) - linear(pixel[0])) / (f64::from(BACKGROUND) - inside);
                let covered = covered.clamp(0.0, 1.0);
                area += covered;
                partly += usize::from((0.1..0.85).contains(&covered));
            }
            // the square is 2 of 4 units wide: a quarter of the image
            let share = area / lit.pixels.len() as f64;
            println!("{samples}: {share:.4} of the image, {partly} pixels covered in part");
            assert!((share - 0.25).abs() < 0.012, "{samples}: {share}");
            assert_eq!(partly > 0, samples > 1, "{samples}: {partly}");
        }
    }
}

#[test]
fn adapter_takes_the_mean_of_the_samples_that_the_ports_take() {
    let Some(device) = device() else { return };
    let frame = room(8, settings());
    let ours = gpu::render(&device, &frame).unwrap().lit;
    let ports = cpu::render(&frame).unwrap().lit;
    let single = cpu::render(&room(8, Settings { samples: 1, ..settings() })).unwrap().lit;
    let (off, smoothed) = (apart(&ours, &ports, 2), apart(&ports, &single, 2));
    println!("{off} pixels apart, {smoothed} smoothed");
    assert!(smoothed > 300 && off < smoothed / 10, "{off} {smoothed}");
}

#[test]
fn exposure_leaves_the_brightest_half_percent_out_and_brightens_by_a_stop_at_most() {
    let of = |levels: &[f32]| {
        let pixels = levels.iter().map(|level| [0.5 * level, *level, 0.0, 1.0]).collect();
        Linear { width: levels.len() as u32, height: 1, pixels }
    };
    let mut levels: Vec<f32> = (1..=1000).map(|level| level as f32 / 100.0).collect();
    levels.reverse();
    let picture = of(&levels);
    let bright = |exposure: f32| {
        picture.picture(exposure).pixels.iter().filter(|pixel| pixel[1] == 255).count()
    };
    let found = exposure(&[&picture]);
    let most = (1000.0 * CLIPPED) as usize;
    assert_eq!(bright(found), most);
    assert!(bright(found * 1.002) > most, "as bright as may be");
    assert_eq!(exposure(&[&of(&[0.01; 9])]), BRIGHTEST);
    assert_eq!(exposure(&[&of(&[0.0; 9])]), 1.0);
    assert_eq!(exposure(&[&Linear::empty([4, 4])]), 1.0);
    assert_eq!(exposure(&[&of(&[f32::NAN, 4.0])]), exposure(&[&of(&[4.0])]));
    // a pixel that is covered in part has the colour of its surface
    let part = Linear { width: 1, height: 1, pixels: vec![[0.5, 1.0, 0.0, 0.25]] };
    assert_eq!(exposure(&[&part]), exposure(&[&of(&[4.0])]));
    // two pictures are exposed as one
    assert_eq!(exposure(&[&of(&[4.0]), &of(&[2.0])]), exposure(&[&of(&[4.0])]));
    let grey = srgb(BACKGROUND);
    assert_eq!(Linear::empty([1, 1]).picture(0.1).pixels, [[grey, grey, grey, 255]]);
}

#[test]
fn renderings_are_exposed_by_themselves_or_as_told() {
    let told = cpu::render(&room(8, settings())).unwrap();
    assert_eq!(told.exposure, 1.0);
    let found = cpu::render(&room(8, Settings { exposure: None, ..settings() })).unwrap();
    assert!(found.exposure < 1.0, "{}", found.exposure);
    let white = |picture: &Picture| {
        let clipped = picture.pixels.iter().filter(|p| p[..3].contains(&255)).count();
        clipped as f64 / picture.pixels.len() as f64
    };
    assert!(white(&told.lit) > 2.0 * CLIPPED && white(&found.lit) <= CLIPPED);
    let refused = |settings: Settings| {
        let scene = scene::open("cornell", &Options::default()).unwrap();
        let camera = scene.camera.unwrap();
        let made = Frame::new(&scene, Vec3::Y, Vec3::NEG_Y, false, &camera, settings);
        made.unwrap_err().to_string()
    };
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let message = refused(Settings { exposure: Some(bad), ..settings() });
        assert!(message.starts_with(&format!("--exposure {bad} must be")), "{message}");
    }
    let message = refused(Settings { samples: 0, ..settings() });
    assert_eq!(message, "--samples 0 must be from 1 to 8");
    assert!(refused(Settings { samples: 9, ..settings() }).contains("--samples 9"));
}

#[test]
fn what_the_light_sees_does_not_depend_on_method_or_tessellation() {
    let views = |walls, method| {
        let settings = Settings { method, views: true, ..settings() };
        cpu::render(&room(walls, settings)).unwrap().views
    };
    let exact = views(8, Method::Exact);
    assert_eq!(exact, views(8, Method::Vertex));
    for (fine, coarse) in exact.iter().zip(&views(1, Method::Vertex)) {
        let off = apart(fine, coarse, 2);
        println!("{off} texels apart");
        assert!(off < fine.pixels.len() / 1000, "{off}");
    }
}

#[test]
fn what_the_light_sees_lies_where_the_maps_hold_it_and_is_wholly_lit() {
    for method in [Method::Exact, Method::Cube] {
        let frame = room(2, Settings { method, views: true, ..settings() });
        let views = cpu::render(&frame).unwrap().views;
        let truth = truth_of(&frame);
        let empty = DepthMaps::empty(1, 1, Sampling::Nearest);
        let bench = Bench::new(&frame, &empty, &truth);
        let origin = bench.origin;
        let mut compared = 0;
        for (index, triangle) in (0..).zip(&frame.triangles) {
            let corners = triangle.map(|corner| frame.vertices[corner as usize]);
            let mean = |of: &dyn Fn(usize) -> Vec3| ((of(0) + of(1) + of(2)) / 3.0).as_dvec3();
            let world = mean(&|i| corners[i].position);
            if !truth.sees(origin, world, Some(index), 0.0) {
                continue;
            }
            let (map, uv) = bench.projection.place(bench.to_light(world));
            let st = dpsm_disk_to_texture(uv, bench.light.guard);
            let view = &views[map as usize];
            let texel = |at: f64| (at * f64::from(view.width)) as i64;
            let (x, y) = (texel(st.x), texel(st.y));
            let at = |x: i64, y: i64| view.pixels[(y * i64::from(view.width) + x) as usize];
            let inside = |c: i64| (1..i64::from(view.width) - 1).contains(&c);
            if !(inside(x) && inside(y)) {
                continue;
            }
            // smooth around it: no edge, no silhouette
            let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
            let mut far = around
                .map(|(a, b)| (0..3).map(|i| at(a, b)[i].abs_diff(at(x, y)[i])).max().unwrap_or(0));
            if far.any(|levels| levels > 6) {
                continue;
            }
            let normal = mean(&|i| corners[i].normal).normalize();
            let cosine = normal.dot((origin - world).normalize()).abs();
            let albedo = corners[0].albedo.as_dvec3();
            let ambient = f64::from(AMBIENT) * (0.5 + 0.5 * cosine);
            let light =
                albedo * (ambient + cosine) + DVec3::splat(f64::from(SPECULAR) * cosine.powi(32));
            let expected = light.to_array().map(|channel| srgb(channel as f32));
            let found = at(x, y);
            assert!(
                (0..3).all(|i| found[i].abs_diff(expected[i]) <= 4),
                "{method:?}: {world} shows {found:?}, not {expected:?}"
            );
            compared += 1;
        }
        println!("{method:?}: {compared} triangles");
        assert!(compared > 50, "{method:?}: {compared}");
    }
}

#[test]
fn places_beyond_the_rim_show_no_surface() {
    let frame = room(8, Settings { views: true, ..settings() });
    let views = cpu::render(&frame).unwrap().views;
    let grey = [srgb(BACKGROUND), srgb(BACKGROUND), srgb(BACKGROUND), 255];
    let width = views[0].width;
    let mut inside = 0;
    for (index, pixel) in (0..).zip(&views[0].pixels) {
        let centre = |i: u32| (f64::from(i) + 0.5) / f64::from(width) * 2.0 - 1.0;
        let place = Vec2::new(centre(index % width), centre(index / width));
        let radius = place.length() * (1.0 + f64::from(frame.light.guard));
        if radius > 1.02 {
            assert_eq!(*pixel, grey, "{place:?}");
        } else if radius < 0.98 {
            inside += usize::from(*pixel == grey);
        }
    }
    // a surface may have that colour by chance
    assert!(inside < views[0].pixels.len() / 1000, "{inside}");
}

/// A coarse unit sphere with the sphere's own normals, lit from the side and seen from the front.
fn coarse_sphere(terminator: bool) -> Frame {
    const SIDES: u32 = 12;
    let at = |ring: u32, side: u32| {
        let step = std::f32::consts::PI / SIDES as f32;
        let (polar, around) = (ring as f32 * step, 2.0 * side as f32 * step);
        vec3(polar.sin() * around.sin(), polar.cos(), polar.sin() * around.cos())
    };
    let cells = |rings| (0..rings).flat_map(|ring| (0..SIDES).map(move |side| (ring, side)));
    let index = |ring: u32, side: u32| ring * SIDES + side % SIDES;
    let positions: Vec<Vec3> = cells(SIDES + 1).map(|(ring, side)| at(ring, side)).collect();
    let quads = cells(SIDES).flat_map(|(ring, side)| {
        let [a, b] = [index(ring, side), index(ring, side + 1)];
        let [c, d] = [index(ring + 1, side), index(ring + 1, side + 1)];
        [[a, c, d], [a, d, b]]
    });
    let sphere = Mesh {
        name: "sphere".into(),
        triangles: quads.collect(),
        normals: positions.clone(),
        positions,
        albedo: Vec3::splat(0.5),
        ..Mesh::default()
    };
    let (origin, lights, camera, warnings) = Default::default();
    let scene =
        Scene { name: "made".into(), origin, meshes: vec![sphere], lights, camera, warnings };
    let camera =
        Camera { eye: vec3(0.0, 0.0, 4.0), target: Vec3::ZERO, up: Vec3::Y, vertical_fov: 0.6 };
    let settings = Settings { size: 1024, image: [320, 320], samples: 1, terminator, ..settings() };
    Frame::new(&scene, vec3(4.0, 3.0, 2.0), Vec3::NEG_Y, false, &camera, settings).unwrap()
}

/// Pixels that the smooth sphere turns to the light by more than 6 degrees but that are dark.
fn falsely_dark(frame: &Frame, lit: &Picture) -> usize {
    let light = vec3(4.0, 3.0, 2.0);
    let turned = frame.light;
    let world = |v: dpsm::scalar::float::Vec3<f32>| {
        let [right, up, forward] =
            [turned.right, turned.up, turned.forward].map(|row| vec3(row.x, row.y, row.z));
        light + right * v.x + up * v.y + forward * v.z
    };
    let dark = |(pixel, seen): (&[u8; 4], Option<cpu::SurfacePoint>)| {
        seen.is_some_and(|seen| {
            let normal = world(seen.p).normalize();
            let cosine = normal.dot((light - world(seen.p)).normalize());
            // with no direct light at all
            cosine > 0.1 && pixel[0] <= srgb(0.5 * (AMBIENT + 0.3 * cosine))
        })
    };
    lit.pixels.iter().zip(cpu::surface_points(frame)).filter(|of| dark(*of)).count()
}

#[test]
fn coarse_sphere_has_a_smooth_shadow_where_the_terminator_is_moved() {
    let [moved, unmoved] = [true, false].map(coarse_sphere);
    let port = cpu::render(&moved).unwrap().lit;
    let flat = cpu::render(&unmoved).unwrap().lit;
    let (few, many) = (falsely_dark(&moved, &port), falsely_dark(&unmoved, &flat));
    println!("{few} pixels falsely dark, {many} without");
    assert!(few < many / 6 && many > 150, "{few} {many}");
    let Some(device) = device() else { return };
    let adapter = gpu::render(&device, &moved).unwrap().lit;
    let off = apart(&adapter, &port, 2);
    println!("{off} pixels apart");
    assert!(off <= 2, "{off}");
}

#[test]
fn flat_meshes_look_the_same_wherever_the_shadow_is_tested() {
    let scene = scene::open("cornell", &Options { walls: 1, ..Options::default() }).unwrap();
    let (light, camera) = (scene.default_light().position, scene.camera.unwrap());
    let [moved, unmoved] = [true, false].map(|terminator| {
        let settings = Settings { terminator, ..settings() };
        let frame = Frame::new(&scene, light, Vec3::NEG_Y, false, &camera, settings).unwrap();
        cpu::render(&frame).unwrap().lit
    });
    // rounding alone, at shadow edges
    assert!(apart(&moved, &unmoved, 2) <= moved.pixels.len() / 1000);
}

#[test]
fn winding_of_triangles_and_side_of_normals_do_not_matter() {
    let frame = coarse_sphere(true);
    let mut wound = frame.clone();
    wound.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let mut turned = frame.clone();
    turned.vertices.iter_mut().for_each(|vertex| vertex.normal = -vertex.normal);
    let device = device();
    let render = |frame: &Frame| match &device {
        Some(device) => gpu::render(device, frame).unwrap().lit,
        None => cpu::render(frame).unwrap().lit,
    };
    let lit = render(&frame);
    for other in [&wound, &turned] {
        for picture in [render(other), cpu::render(other).unwrap().lit] {
            let off = apart(&picture, &lit, 2);
            assert!(off <= lit.pixels.len() / 2000, "{off}");
        }
    }
}
