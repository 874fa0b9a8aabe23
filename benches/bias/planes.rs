//! A million random planes for each bias and kernel: does any shadow itself, and how tight is the
//! footprint bias?

use super::common::planes::*;
use super::common::rng;
use dpsm::scalar::bias::*;
use dpsm::scalar::paraboloid::dpsm_project_own;

/// Planes of each bias and radius.
const PLANES: usize = 1_000_000;

/// Half the kernels' sides in texels, less a half.
const RADII: [i32; 3] = [0, 1, 3];

pub fn planes() {
    println!(
        "\n{PLANES} random planes each, incidence to 89.9 degrees, by format and size in turn\n"
    );
    println!("| bias | k | planes shadowed by themselves |");
    println!("|---|---|---|");
    let mut rng = rng("planes");
    let turns = || (0..PLANES).map(|i| (SIZES[i % 6], FORMATS[i / 6 % 3]));
    let mut shadowed = 0;
    for (size, steps) in turns() {
        let light = plain_light(size);
        let (p, normal) = grazing(&mut rng, size);
        let map = PlaneMap { p: p.widen(), normal, light, steps, tap: [0, 0] };
        let receiver = dpsm_receiver(p, normal.narrow(), 0.0);
        let lit = dpsm_visibility_texel_centre(&map, p, receiver, light, quantum(steps), 0.0);
        shadowed += usize::from(lit == 0.0);
    }
    println!("| texel-centre | 0 | {shadowed} |");
    for radius in RADII {
        let mut shadowed = 0;
        for (size, steps) in turns() {
            let light = plain_light(size);
            let (p, normal) = grazing(&mut rng, size);
            let tap = tap(&mut rng, radius);
            let map = PlaneMap { p: p.widen(), normal, light, steps, tap };
            let receiver = dpsm_receiver(p, normal.narrow(), 0.0);
            let (texels, q) = (radius as f32 + 0.5, quantum(steps));
            let lit = dpsm_visibility_footprint(&map, p, receiver, light, texels, q, 0.0);
            shadowed += usize::from(lit == 0.0);
        }
        println!("| footprint | {radius} | {shadowed} |");
    }
    println!("\ntightness: the largest share of the footprint bias that a plane needs, in f64\n");
    println!("| size | k = 0 | k = 1 | k = 3 |");
    println!("|---|---|---|---|");
    for size in SIZES {
        let row = RADII.map(|radius| {
            let most = (0..40_000).map(|_| {
                let (p, normal) = worst(&mut rng, size, radius);
                let light = plain_light(size).widen();
                let receiver = dpsm_receiver(p.widen(), normal, 0.0);
                let texels = f64::from(radius) + 0.5;
                let bias =
                    dpsm_bias_footprint(receiver, dpsm_project_own(p.widen()), texels, light);
                needed(p, normal, plain_light(size), radius) / bias
            });
            format!("{:.4}", most.fold(0.0, f64::max))
        });
        println!("| {size} | {} |", row.join(" | "));
    }
}
