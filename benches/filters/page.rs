//! The page of pictures: one shadow across the seam by each filter, with its error and its cost.
//! `cargo bench --bench filters -- page` writes docs/seam.md and docs/pictures/seam-*.png.

use std::fmt::Write;
use std::path::Path;

use dpsm::gpu::{self, Device};
use dpsm::measure::{self, Bench, Point};
use dpsm::render::{Filter, Frame, Kernel, Settings, Taps};
use dpsm::scalar::paraboloid::dpsm_texel_width;
use dpsm::scene::{self, Camera, Options};
use glam::Vec3;

/// A wide kernel and small maps, so that what is wrong can be seen.
const HALF_ANGLE_DEGREES: f32 = 6.0;
const SIZE: u32 = 256;

/// Taps enough for a smooth shadow.
const TAPS: u32 = 64;

/// Texels along the naive kernel's side: the cone's area at the rim, where a texel is 2 / N rad.
fn naive_side() -> u32 {
    let texels = HALF_ANGLE_DEGREES.to_radians() / (2.0 / SIZE as f32);
    (texels * std::f32::consts::PI.sqrt()).round() as u32
}

/// How far from the rim points are the seam's.
const SEAM_TEXELS: f64 = 5.0;

/// Points of the picture that are judged.
const POINTS: usize = 20_000;

type Failure = Box<dyn std::error::Error>;

pub fn write(device: &Device) -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let scene = scene::open("brabec-room", &Options::default())?;
    let light = scene.default_light();
    // the light looks along the wall, so that the seam crosses the shadow of the tall box
    let camera = Camera {
        eye: Vec3::new(-0.4, 1.9, 2.0),
        target: TARGET,
        ..scene.default_camera(light.position)
    };
    let axis = (TARGET - light.position).cross(Vec3::Y).normalize();
    let kernel = Kernel::Tangent(HALF_ANGLE_DEGREES.to_radians().tan());
    let taps = Taps { count: TAPS, kernel };
    let side = naive_side();
    let rows: [(&str, String, Filter); 4] = [
        ("naive", format!("naive, {side} x {side} texels"), Filter::Naive(side)),
        ("mirror", format!("mirrored, {TAPS} taps"), Filter::Mirror(taps)),
        ("reproject", format!("reprojected, {TAPS} taps"), Filter::Reproject(taps)),
        ("disk", format!("conformal, {TAPS} taps"), Filter::Disk(taps)),
    ];
    let mut text = format!(
        "# A shadow across the seam\n\n\
         `cargo bench --bench filters -- page` writes this page. The same shadow by four filters: \
         maps of {SIZE}, a cone of {HALF_ANGLE_DEGREES} degrees half-angle, the seam through the \
         shadow. Error: RMSE of the visibility against rays to the spherical light that the cone \
         stands for, over {POINTS} points of the picture less those on sides turned away from the \
         light; the seam's are those within five texels of it. The disk narrows towards contacts \
         as that light's penumbra does; mirrored and reprojected kernels do not, and darken what \
         lies beside the column. The naive filter stands for no light: its error is that of its \
         penumbra points against a cone as wide as its texels. It takes the footprint bias of its \
         whole window, and has the guard band of 2 x 2 texels, as it comes from no kernel's. Cost: \
         the camera pass, by tap, as a share of the naive filter's; {}.\n",
        device.describe()
    );
    let mut base = None;
    for (name, title, filter) in rows {
        let settings = Settings { size: SIZE, image: [480, 360], filter, ..Settings::default() };
        let frame = Frame::new(&scene, light.position, axis, false, &camera, settings)?;
        let mut times = Vec::new();
        let mut picture = None;
        for _ in 0..5 {
            let rendering = gpu::render(device, &frame)?;
            times.extend(rendering.timings.iter().find(|(pass, _)| pass == "camera").map(|t| t.1));
            picture = Some(rendering.lit);
        }
        times.sort();
        let count = if let Filter::Naive(side) = filter { side * side } else { TAPS };
        let tap =
            times.get(times.len() / 2).map_or(0.0, |time| time.as_secs_f64()) / f64::from(count);
        let base = *base.get_or_insert(tap);
        let maps = gpu::make_maps(device, &frame)?;
        let truth = measure::truth_of(&frame);
        let bench = Bench::new(&frame, &maps, &truth);
        let points = bench.points_from_camera(POINTS, 1);
        let at_seam = |point: &&Point| {
            let (_, uv) = bench.place(point);
            let texel = dpsm_texel_width(bench.light.size, bench.light.guard);
            (uv.length() - 1.0).abs() <= SEAM_TEXELS * texel
        };
        let beside: Vec<Point> = points.iter().filter(at_seam).copied().collect();
        let soft = |points: &[Point]| Some(measure::soft_error(&bench, points, || {})?.facing);
        let (error, seam_error, seam_points) = match (soft(&points), soft(&beside)) {
            (Some(all), Some(seam)) => (all.rmse, seam.rmse, seam.points),
            _ => {
                let error = measure::penumbra_error(&bench, &points, || {});
                (error.penumbra_rmse, error.seam_rmse, error.seam_points)
            }
        };
        if let Some(picture) = picture {
            let path = root.join(format!("pictures/seam-{name}.png"));
            let rgb: Vec<u8> =
                picture.pixels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
            image::save_buffer(path, &rgb, picture.width, picture.height, image::ColorType::Rgb8)?;
        }
        let _ = write!(
            text,
            "\n![{title}](pictures/seam-{name}.png)\n\n\
             {title}: RMSE {:.4}, in the seam band {:.4} over {} points; a tap costs {:.2} of the \
             naive filter's.\n",
            error,
            seam_error,
            seam_points,
            tap / base.max(f64::MIN_POSITIVE),
        );
    }
    println!("{text}");
    std::fs::write(root.join("seam.md"), text)?;
    Ok(())
}

/// A place in the shadow of the tall box, on the wall.
const TARGET: Vec3 = Vec3::new(-2.0, 1.3, 0.85);
