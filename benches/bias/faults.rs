//! Mismatches with ray casting away from edge points, over random light poses.

use dpsm::gpu::{Device, GpuError, make_maps};
use dpsm::measure::{Bench, ShadowError, shadow_error, truth_of};
use dpsm::render::{Bias, Filter, Format, Kernel, Method, Settings, Taps};
use fastrand::Rng;

use super::place::{Place, posed, position, rotation};

/// Random light poses of each scene.
const POSES: usize = 54;

/// Points of each pose, spread over all surfaces.
const POINTS: usize = 3000;

/// Each size with each format takes a pose in turn.
const SIZES: [u32; 6] = [128, 256, 512, 1024, 2048, 4096];
const FORMATS: [Format; 3] = [Format::D16, Format::D24, Format::D32];

/// The scenes, and the atrium where its file is.
pub fn places() -> Vec<Place> {
    let names = ["brabec-room", "cornell", "seam-box", "grazing", "gaps", "contact", "seam-edge"];
    let mut places: Vec<Place> = names.map(|name| Place::built_in(name, 1)).into();
    places.extend(Place::sponza());
    places
}

pub fn faults(device: &Device) -> Result<(), GpuError> {
    println!(
        "\n{POSES} random lights a scene, sizes 128 to 4096 and all formats in turn, hard test\n"
    );
    println!(
        "| scene | method | bias | points | edge points | faults: shadow, light | misclassified |"
    );
    println!("|---|---|---|---|---|---|---|");
    let single = Filter::Single;
    let tap = Filter::Disk(Taps { count: 1, kernel: Kernel::Tangent(0.0) });
    let biases = [
        ("texel-centre", Bias::TexelCentre, single),
        ("footprint", Bias::Footprint, single),
        ("constant", Bias::Constant(None), single),
        ("one tap of the disk", Bias::TexelCentre, tap),
    ];
    let methods = [("exact", Method::Exact), ("refined", Method::Refined)];
    for place in &places() {
        let base = place.frame(Settings::default());
        let truth = truth_of(&base);
        let mut rng = Rng::with_seed(11);
        let mut sums = vec![ShadowError::default(); methods.len() * biases.len()];
        for pose in 0..POSES {
            let (size, format) = (SIZES[pose % 6], FORMATS[pose / 6 % 3]);
            let (light, turn) = (position(place, &truth, &mut rng), rotation(&mut rng));
            for (m, (_, method)) in methods.into_iter().enumerate() {
                let settings = Settings { method, size, format, ..base.settings.clone() };
                let mut frame = posed(place, settings, light, turn);
                let maps = make_maps(device, &frame)?;
                for (b, (_, bias, filter)) in biases.into_iter().enumerate() {
                    frame.settings.bias = bias;
                    frame.settings.filter = filter;
                    let bench = Bench::new(&frame, &maps, &truth);
                    let points = bench.points_scattered(POINTS, pose as u64);
                    let error = shadow_error(&bench, &points, || ());
                    let sum = &mut sums[m * biases.len() + b];
                    sum.points += error.points;
                    sum.edge_points += error.edge_points;
                    sum.faults_shadow += error.faults_shadow;
                    sum.faults_light += error.faults_light;
                    sum.false_shadow += error.false_shadow;
                    sum.false_light += error.false_light;
                    if b == 0 && error.faults() > 0 {
                        eprintln!("{} {size} {format:?} {method:?}: {error:?}", place.name);
                    }
                }
            }
        }
        let names = methods.iter().flat_map(|(m, _)| biases.map(|(b, ..)| (*m, b)));
        for ((method, bias), s) in names.zip(sums) {
            println!(
                "| {} | {method} | {bias} | {} | {} | {}, {} | {} |",
                place.scene.name,
                s.points,
                s.edge_points,
                s.faults_shadow,
                s.faults_light,
                s.misclassified()
            );
        }
    }
    Ok(())
}
