//! Pictures of what is drawn: the room's triangles on the disk, as they are and refined.

use dpsm::cpu::leaves;
use dpsm::gpu::{Device, GpuError};
use dpsm::render::{Frame, Method, Settings, float};
use dpsm::scalar::classify::dpsm_projected;
use dpsm::scalar::float::Vec2;
use dpsm::scalar::hemisphere::dpsm_to_light;
use image::{Rgb, RgbImage};

use super::Place;

/// Pixels along a side, and what they show of the disk.
const SIDE: u32 = 720;
const REACH: f32 = 1.1;

/// Colours of lines: triangles that are drawn as depth alone, with their planes, and the rim.
const FLAT: Rgb<u8> = Rgb([40, 90, 170]);
const PLANE: Rgb<u8> = Rgb([215, 110, 20]);
const RIM: Rgb<u8> = Rgb([150, 150, 150]);

pub fn pictures(_: &Device) -> Result<(), GpuError> {
    let place = Place::built_in("brabec-room", 1);
    let frame =
        place.frame(Settings { size: 1024, method: Method::Refined, ..Settings::default() });
    save("leaves-vertex", &as_they_are(&frame));
    let refined: Vec<_> = leaves(&frame, 0, 0..frame.triangles.len() as u32)
        .iter()
        .map(|leaf| {
            let colour = if leaf.face.is_some() { PLANE } else { FLAT };
            (leaf.corners.map(|corner| corner.uv), colour)
        })
        .collect();
    println!("{} triangles, {} leaves in the front map", frame.triangles.len(), refined.len());
    save("leaves-refined", &refined);
    Ok(())
}

type Drawn = ([Vec2<f32>; 3], Rgb<u8>);

/// What the vertex method draws: each triangle with a corner in front, by chords.
fn as_they_are(frame: &Frame) -> Vec<Drawn> {
    let place =
        |&index: &u32| dpsm_to_light(float(frame.vertices[index as usize].position), frame.light);
    let seen = frame.triangles.iter().map(|corners| [0, 1, 2].map(|k| place(&corners[k])));
    let in_front = seen.filter(|corners| corners.iter().any(|p| p.z >= 0.0));
    in_front.map(|corners| (corners.map(|p| dpsm_projected(p).uv), FLAT)).collect()
}

fn save(name: &str, triangles: &[Drawn]) {
    let mut image = RgbImage::from_pixel(SIDE, SIDE, Rgb([255, 255, 255]));
    for (corners, colour) in triangles {
        for k in 0..3 {
            line(&mut image, corners[k], corners[(k + 1) % 3], *colour);
        }
    }
    let on_rim = |i: u32| {
        let (sine, cosine) = (i as f32 * std::f32::consts::TAU / 720.0).sin_cos();
        Vec2::new(cosine, sine)
    };
    (0..720).for_each(|i| line(&mut image, on_rim(i), on_rim(i + 1), RIM));
    let path = format!("{}/docs/pictures/{name}.png", env!("CARGO_MANIFEST_DIR"));
    match image.save(&path) {
        Ok(()) => println!("wrote docs/pictures/{name}.png"),
        Err(error) => println!("docs/pictures/{name}.png: {error}"),
    }
}

/// A line between disk points, as far as it is in the picture.
fn line(image: &mut RgbImage, from: Vec2<f32>, to: Vec2<f32>, colour: Rgb<u8>) {
    let scale = SIDE as f32 / (2.0 * REACH);
    let along = to - from;
    let steps = (along.length() * scale * 1.5).min(1e5) as u32 + 1;
    for i in 0..=steps {
        let p = from + along * (i as f32 / steps as f32);
        let [x, y] = [(REACH + p.x) * scale, (REACH - p.y) * scale];
        if (0.0..SIDE as f32).contains(&x) && (0.0..SIDE as f32).contains(&y) {
            image.put_pixel(x as u32, y as u32, colour);
        }
    }
}
