//! Pictures of the seeds' scenes: the ports against committed pictures, the adapter against the
//! ports.

#![cfg(feature = "cli")]

mod common;

use common::device;
use dpsm::cpu::{self, SurfacePoint};
use dpsm::gpu::{self, Device};
use dpsm::render::{Bias, Format, Frame, Lookup, Method, Picture, Rendering, Settings, srgb};
use dpsm::scalar::maps::{DepthMaps, Sampling};
use dpsm::scene::{self, Options};
use glam::Vec3;

const SIDE: u32 = 192;

fn frame(name: &str, settings: Settings) -> Frame {
    let scene = scene::open(name, &Options::default()).unwrap();
    let light = scene.default_light();
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light.position));
    let axis = light.axis.unwrap_or(Vec3::NEG_Y);
    Frame::new(&scene, light.position, axis, light.axis.is_some(), &camera, settings).unwrap()
}

fn settings() -> Settings {
    // one sample, in the pixel's centre, is what `surface_points` sees
    let exposure = Some(1.0);
    let image = [SIDE, SIDE];
    Settings {
        size: 256,
        image,
        samples: 1,
        exposure,
        terminator: false,
        views: true,
        ..Settings::default()
    }
}

fn levels_apart(a: [u8; 4], b: [u8; 4]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

#[test]
fn ports_render_the_committed_pictures() {
    for name in ["brabec-room", "brabec-ceiling"] {
        let shown =
            Settings { samples: 2, exposure: None, terminator: true, views: false, ..settings() };
        let lit = cpu::render(&frame(name, shown)).unwrap().lit;
        let path = format!("{}/tests/golden/{name}.png", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("DPSM_WRITE_GOLDEN").is_some() {
            let pixels = lit.pixels.as_flattened();
            image::save_buffer(&path, pixels, SIDE, SIDE, image::ColorType::Rgba8).unwrap();
        }
        let golden = image::open(&path).unwrap().into_rgba8();
        assert_eq!(golden.dimensions(), (SIDE, SIDE));
        for (index, (pixel, golden)) in lit.pixels.iter().zip(golden.pixels()).enumerate() {
            // the platform's own tan and pow may round an encoded level the other way
            let apart = levels_apart(*pixel, golden.0);
            assert!(apart <= 1, "{name}: pixel {index} is {pixel:?}, committed {golden:?}");
        }
    }
}

/// Smallest subpixel precision of a WebGPU rasterizer: 4 bits.
const SUBPIXEL: f32 = 1.0 / 16.0;

/// True where adapter and port must give the same colour to one level: the 3 x 3 pixels around lie
/// in one triangle, and the 3 x 3 texels around decide alike by more than the maps can differ.
fn comparable(
    frame: &Frame,
    port: &Rendering,
    seen: &[Option<SurfacePoint>],
    x: u32,
    y: u32,
) -> bool {
    let around = |x: u32, y: u32| {
        let near = move |c: u32| c.saturating_sub(1)..(c + 2).min(SIDE);
        near(y).flat_map(move |y| near(x).map(move |x| (y * SIDE + x) as usize))
    };
    let here = (y * SIDE + x) as usize;
    let Some(point @ SurfacePoint { triangle, .. }) = seen[here] else { return false };
    let one_triangle = around(x, y).all(|i| seen[i].is_some_and(|seen| seen.triangle == triangle));
    // a pixel's neighbours bound its gradient: an image shifted by SUBPIXEL stays within half a
    // level where they are within 8
    let smooth = around(x, y)
        .all(|i| levels_apart(port.lit.pixels[i], port.lit.pixels[here]) <= (0.5 / SUBPIXEL) as u8);
    one_triangle && smooth && port.maps.as_ref().is_some_and(|maps| decided(frame, maps, point))
}

/// True where all 3 x 3 texels around a point's lookup agree, by more than their depths can move
/// when the map's triangles do by SUBPIXEL, and the arithmetic's bounds (24 eps on unit depths).
fn decided(frame: &Frame, maps: &DepthMaps, point: SurfacePoint) -> bool {
    let at = frame.lookup(point.p, frame.light_normal(point.triangle));
    if !at.mapped {
        return true;
    }
    let texel = at.coordinates * maps.size as f32;
    let (x, y) = (texel.x as i64, texel.y as i64);
    let stored: Vec<f32> = (-1..=1)
        .flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)))
        .map(|(x, y)| maps.depths[maps.index(x, y, at.layer)])
        .collect();
    let low = stored.iter().copied().fold(f32::INFINITY, f32::min);
    let high = stored.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let margin = (high - low) * SUBPIXEL + 24.0 * f32::EPSILON + frame.settings.format.quantum();
    at.depth <= low - margin || at.depth > high + margin
}

fn compare(name: &str, frame: &Frame, device: &Device) {
    let adapter = gpu::render(device, frame).unwrap();
    let port = cpu::render(frame).unwrap();
    let seen = cpu::surface_points(frame);
    let (mut compared, mut most) = (0, 0);
    for y in 0..SIDE {
        for x in 0..SIDE {
            if !comparable(frame, &port, &seen, x, y) {
                continue;
            }
            let index = (y * SIDE + x) as usize;
            let apart = levels_apart(adapter.lit.pixels[index], port.lit.pixels[index]);
            assert!(apart <= 1, "{name}: pixel {x}, {y} is {apart} levels apart");
            most = most.max(apart);
            compared += 1;
        }
    }
    println!("{name}: {compared} of {} pixels compared, {most} levels apart", SIDE * SIDE);
    assert!(compared > SIDE * SIDE / 4, "{name}: only {compared} pixels compared");
    let lit = |picture: &Picture| picture.pixels.iter().map(|p| u64::from(p[0])).sum::<u64>();
    assert_ne!(lit(&adapter.lit), 0, "{name}");
}

#[test]
fn adapter_renders_what_the_ports_render() {
    let Some(device) = device() else { return };
    for name in ["brabec-room", "brabec-ceiling"] {
        for method in [Method::Vertex, Method::FragmentDepth] {
            for format in [Format::D16, Format::D24, Format::D32] {
                // a constant is compared far from the stored depths of lit surfaces
                let bias = Bias::Constant(None);
                let frame = frame(name, Settings { method, format, bias, ..settings() });
                compare(&format!("{name} {method:?} {format:?}"), &frame, &device);
            }
        }
    }
}

#[test]
fn adapter_takes_each_bias_as_the_ports_do() {
    let Some(device) = device() else { return };
    let differ = |a: &Picture, b: &Picture| {
        a.pixels.iter().zip(&b.pixels).filter(|(a, b)| levels_apart(**a, **b) > 1).count()
    };
    for method in [Method::Exact, Method::Cube] {
        let of = |bias| frame("brabec-room", Settings { bias, method, ..settings() });
        let none = cpu::render(&of(Bias::Constant(Some(0.0)))).unwrap().lit;
        for sampling in [Sampling::Nearest, Sampling::Linear] {
            for bias in [Bias::Constant(None), Bias::Footprint, Bias::TexelCentre] {
                let settings = Settings { bias, method, sampling, ..settings() };
                let frame = frame("brabec-room", settings);
                let adapter = gpu::render(&device, &frame).unwrap().lit;
                let port = cpu::render(&frame).unwrap().lit;
                let (apart, effect) = (differ(&adapter, &port), differ(&port, &none));
                println!("{method:?} {sampling:?} {bias:?}: {apart} pixels apart of {effect}");
                assert!(effect > 50 * apart, "{method:?} {sampling:?} {bias:?}: {apart} {effect}");
            }
        }
    }
}

#[test]
fn adapter_looks_up_by_vertex_as_the_ports_do() {
    let Some(device) = device() else { return };
    // interpolated coordinates differ from the pixel's own, so only whole pictures are compared:
    // nearly all pixels must agree, and the lookups must not be the same picture
    let by_vertex = frame("brabec-room", Settings { lookup: Lookup::Vertex, ..settings() });
    let adapter = gpu::render(&device, &by_vertex).unwrap().lit;
    let port = cpu::render(&by_vertex).unwrap().lit;
    let by_pixel = cpu::render(&frame("brabec-room", settings())).unwrap().lit;
    let differ = |a: &Picture, b: &Picture| {
        a.pixels.iter().zip(&b.pixels).filter(|(a, b)| levels_apart(**a, **b) > 1).count()
    };
    let (apart, effect) = (differ(&adapter, &port), differ(&port, &by_pixel));
    println!("by vertex: {apart} pixels differ from the port, {effect} from the lookup by pixel");
    assert!(effect > 10 * apart.max(1), "{apart} {effect}");
}

#[test]
fn closed_room_fills_both_maps_and_nothing_outside_their_disks() {
    let settings = Settings { method: Method::Exact, ..settings() };
    let maps = cpu::make_maps(&frame("brabec-room", settings)).unwrap();
    assert_eq!(maps.layers, 2);
    let stored = maps.depths.iter().filter(|&&depth| depth < 1.0).count();
    // the stored disk is pi / 4 of each square; its border crosses fewer than 4 N texels of each
    // layer, of which bowed edges of the 8 x 8 walls (docs/caster.md) may leave half empty
    let disk = std::f64::consts::FRAC_PI_4 * maps.depths.len() as f64;
    let border = f64::from(4 * maps.size * maps.layers);
    let off = stored as f64 - disk;
    assert!(off.abs() <= border, "{stored} texels stored, disks hold {disk:.0}");
}

#[test]
fn hemispherical_light_makes_one_map_and_leaves_its_back_dark() {
    let frame = frame("brabec-ceiling", settings());
    let rendering = cpu::render(&frame).unwrap();
    assert_eq!(rendering.maps.as_ref().unwrap().layers, 1);
    let mut back = 0;
    for (pixel, seen) in rendering.lit.pixels.iter().zip(cpu::surface_points(&frame)) {
        let Some(SurfacePoint { triangle, p }) = seen else { continue };
        if p.z < 0.0 {
            back += 1;
            let corner = frame.triangles[triangle as usize][0];
            let ambient = frame.vertices[corner as usize].albedo * dpsm::render::AMBIENT;
            let [low, high] = [0.5, 1.0].map(|share| (ambient * share).to_array().map(srgb));
            let ambient = (0..3).all(|i| (low[i]..=high[i]).contains(&pixel[i]));
            assert!(ambient, "a point behind the light is lit: {pixel:?}, {low:?} to {high:?}");
        }
    }
    assert!(back > 0, "the camera sees nothing behind the light");
}

#[test]
fn settings_that_do_not_fit_are_refused_with_the_remedy() {
    let scene = scene::open("cornell", &Options::default()).unwrap();
    let light = scene.default_light().position;
    let camera = scene.camera.unwrap_or_else(|| scene.default_camera(light));
    let make = |position, settings| {
        Frame::new(&scene, position, Vec3::NEG_Y, false, &camera, settings).unwrap_err().to_string()
    };
    assert_eq!(make(light, Settings { size: 0, ..settings() }), "--size 0 must be from 1 to 16384");
    assert_eq!(
        make(light, Settings { near: Some(2.0), far: Some(1.0), ..settings() }),
        "near 2 and far 1 must fit 1e-15 <= near < far <= 1e18; set --near and --far, or move the light off the geometry"
    );
    assert!(make(Vec3::new(f32::NAN, 0.0, 0.0), settings()).contains("outside float range"));
    assert!(
        make(light, Settings { bias: Bias::Constant(Some(-1.0)), ..settings() })
            .contains("bias -1")
    );
}
