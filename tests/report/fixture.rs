//! A complete report of invented figures, with whatever is hard to show.

use dpsm::report::data::*;
use dpsm::report::parameterisations::parameterisations;
use dpsm::report::pareto;

/// A name that would break a page which does not escape it.
pub const HARD_NAME: &str = "a <b>\"room\"</b> & 'light'";

pub fn times(median: f64, noise: f64) -> Times {
    let [low, high] = [1.0 - noise, 1.0 + 1.3 * noise].map(|share| median * share);
    Times { runs: 15, least: median * (1.0 - 2.0 * noise), low, median, high }
}

/// Generation at 512, error at 512, passes and maps.
const METHODS: [(&str, f64, f64, u32); 6] = [
    ("vertex", 4.1, 0.0131, 2),
    ("fragment-depth", 6.3, 0.0118, 2),
    ("tessellated", 9.8, 0.0084, 2),
    ("exact", 21.0, 0.0071, 2),
    ("refined", 7.2, 0.0071, 2),
    ("cube", 8.9, 0.0075, 6),
];

fn variant(method: usize, size: u32, filter: usize) -> Variant {
    let (name, making, error, maps) = METHODS[method];
    let (filter, lookup, gain) =
        [("hard", 2.1, 1.0), ("hardware", 2.6, 0.74), ("disk", 19.0, 0.66)][filter];
    let scale = f64::from(size) / 512.0;
    let role = match (name, size, filter) {
        ("cube", ..) => Role::Cube,
        ("refined", 1024, "hardware") => Role::Plan,
        _ => Role::Other,
    };
    let side = if maps == 6 { size / 2 } else { size };
    let texels = u64::from(maps * side * side);
    let wrong = error * gain / scale;
    Variant {
        name: format!("{name} {side} {filter}"),
        method: name.to_string(),
        size: side,
        maps,
        passes: maps,
        filter: filter.to_string(),
        bias: "footprint".to_string(),
        format: "d32".to_string(),
        texels,
        bytes: 4 * texels,
        triangles: if method == 2 { 96_000 } else { 6_012 },
        generation: times(making * (0.6 + 0.4 * scale), 0.03),
        lookup: times(lookup * (1.0 + 0.02 * method as f64) * scale.powf(0.1), 0.05),
        error: ErrorFigures {
            rmse: (wrong * 0.9).sqrt(),
            acne: wrong * 0.4,
            acne_mean: wrong * 0.45,
            smoothly_lit: 15_000,
            leak: wrong * 0.05,
            leak_mean: wrong * 0.06,
            deep_in_shadow: 3_000,
            false_shadow: wrong * 0.7,
            false_light: wrong * 0.3,
            faults: if method < 2 { wrong * 0.1 } else { 0.0 },
            contact_gap: 0.017 / scale,
            edge_texels_median: 0.31,
            edge_texels_largest: 0.706,
            edge_degrees_largest: 0.31 / scale,
        },
        role,
        dominated_by: String::new(),
    }
}

fn scene(name: &str) -> SceneFigures {
    let all = (0..6).flat_map(|m| [256, 512, 1024].map(|size| (m, size)));
    let all = all.flat_map(|(m, size)| (0..3).map(move |f| variant(m, size, f)));
    let mut scene = SceneFigures {
        name: name.to_string(),
        about: "A room, its light in the middle & a box < 1 m from it.".to_string(),
        triangles: 6_012,
        light: [-1.0, 2.0, 0.5],
        hemispherical: false,
        points: 20_000,
        seed: 1,
        variants: all.collect(),
        plan: vec![
            "method: refined, since the walls' edges would bow by 3.1 texels > 0.5".to_string(),
            "size: 1024, since 0.35 degrees are asked for & 512 has 0.45".to_string(),
        ],
        sources: ["f32 arithmetic", "storage format", "resolution", "bias", "filter"]
            .map(|name| Source {
                name: name.to_string(),
                variant: "refined 1024 hardware".to_string(),
                measured: 0.000_012_5 * name.len() as f64,
                predicted: (name != "filter").then_some(0.000_31),
                unit: "world units".to_string(),
            })
            .to_vec(),
    };
    pareto::mark(&mut scene.variants);
    scene
}

/// Two full scenes, one that nothing was measured of, and one of a single variant without error.
pub fn report() -> Report {
    let mut perfect = scene("no-error");
    perfect.variants.truncate(5);
    perfect.variants[0].error = ErrorFigures::default();
    perfect.variants[3].error = ErrorFigures::default();
    perfect.plan.clear();
    perfect.variants.iter_mut().for_each(|variant| variant.dominated_by.clear());
    pareto::mark(&mut perfect.variants);
    let empty = SceneFigures { name: "No Error".to_string(), ..SceneFigures::default() };
    let curve = |name: &str, slope: f64, base: f64| Curve {
        name: name.to_string(),
        points: [1_000.0, 10_000.0, 100_000.0, 500_000.0]
            .map(|x: f64| (x, times(base * (1.0 + (x / 4_000.0).powf(slope)), 0.06)))
            .to_vec(),
    };
    let curves = |title: &str, axis: &str, unit: &str| Curves {
        title: title.to_string(),
        axis: axis.to_string(),
        unit: unit.to_string(),
        curves: vec![
            curve("vertex", 0.9, 3.0),
            curve("refined", 0.8, 4.0),
            curve("cube", 1.0, 6.0),
        ],
    };
    Report {
        version: VERSION,
        machine: Machine {
            computed_by: "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6, a software adapter"
                .to_string(),
            adapter: "llvmpipe (LLVM 15.0.6, 256 bits)".to_string(),
            driver: "Mesa 22.3.6".to_string(),
            backend: "vulkan".to_string(),
            software: true,
            cores: 2,
            system: "linux x86_64".to_string(),
            versions: [("dpsm", "0.1.0"), ("wgpu", "30.0.1")]
                .map(|(name, version)| (name.to_string(), version.to_string()))
                .into(),
        },
        timing: Timing { warm_up: 1, runs: 15, empty_pass: None },
        scenes: vec![scene("brabec-room"), scene(HARD_NAME), perfect, empty],
        parameterisations: parameterisations(),
        costs: vec![
            curves("Making the maps against triangles", "triangles", "ms"),
            curves("Making the maps against triangles!", "triangles <again>", "ms"),
        ],
        unfinished: vec!["costs: lights & <taps>".to_string()],
    }
}

/// Pictures of the report's scenes.
pub fn images() -> Vec<Image> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pictures");
    let image = |scene: &str, kind: &str, file: &str, title: &str| {
        let path = format!("{folder}/{file}.png");
        let (width, height) = image::image_dimensions(&path).unwrap();
        Image {
            scene: scene.to_string(),
            kind: kind.to_string(),
            title: title.to_string(),
            caption:
                "What to look for: edges of shadows < 1 texel from where they belong, straight \
                      & unbroken across the seam."
                    .to_string(),
            size: [width, height],
            png: base64(&std::fs::read(&path).unwrap()),
        }
    };
    vec![
        image("brabec-room", "lit", "brabec-room", "The lit image"),
        image("brabec-room", "maps", "brabec-room-maps", "Both maps"),
        image("brabec-room", "view", "brabec-room-view", "A hemisphere's view"),
        image(HARD_NAME, "lit", "method-refined", "Title <with> \"quotes\" & 'more'"),
        image(HARD_NAME, "Lit!", "method-vertex", "The same id but for its sign"),
        image("no such scene", "lit", "method-vertex", "left out"),
    ]
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0, |word, byte| word << 8 | u32::from(*byte))
            << (8 * (3 - chunk.len()));
        for i in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * i)) as usize & 63];
            out.push(if i > chunk.len() { '=' } else { char::from(letter) });
        }
    }
    out
}
