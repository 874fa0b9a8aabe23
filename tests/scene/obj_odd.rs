//! OBJ files as programs write them: byte order marks, comments, colours, names, large polygons.

use std::time::{Duration, Instant};

use dpsm::scene::Scene;
use dpsm::truth::Truth;
use glam::{DVec3, Vec3, dvec3, vec3};

use crate::{assert_valid, error, file, read};

/// A floor of 16 x 16 at y = 0 and a lid of 2 x 2 at y = 1; faces are left out.
const CORNERS: [[i32; 3]; 8] = [
    [-8, 0, 8],
    [8, 0, 8],
    [8, 0, -8],
    [-8, 0, -8],
    [-1, 1, 1],
    [1, 1, 1],
    [1, 1, -1],
    [-1, 1, -1],
];

/// Vertices with something behind each.
fn vertices(more: impl Fn(usize) -> String) -> String {
    let line = |(i, [x, y, z]): (usize, &[i32; 3])| format!("v {x} {y} {z}{}\n", more(i));
    CORNERS.iter().enumerate().map(line).collect()
}

const FACES: &str = "f 1 2 3 4\nf 5 6 7 8\n";

/// A light at (0, 3, 0) sees the floor beyond 1.5 from its middle alone.
fn assert_shadow(scene: &Scene, name: &str) {
    assert_valid(scene);
    let truth = Truth::from(scene);
    let sees = |x: f64| truth.sees(dvec3(0.0, 3.0, 0.0), dvec3(x, 1e-3, 0.2), None, 0.0);
    assert_eq!([-3.0, -1.4, 0.1, 1.4, 3.0].map(sees), [true, false, false, false, true], "{name}");
    assert!(!truth.sees(DVec3::Y * 0.5, DVec3::NEG_Y, None, 0.0), "no floor: {name}");
    assert_eq!(scene.triangle_count(), 4, "{name}");
}

fn assert_reads(name: &str, text: impl AsRef<[u8]>) {
    let scene = read(&file(name, text));
    assert_shadow(&scene, name);
    assert_eq!(scene.warnings, [""; 0], "{name}");
}

#[test]
fn byte_order_marks_cost_no_statement() {
    let text = vertices(|_| String::new()) + FACES;
    assert_reads("bom.obj", format!("\u{feff}{text}"));
    let utf16 = |unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
        format!("\u{feff}{text}").encode_utf16().flat_map(unit).collect()
    };
    assert_reads("utf16le.obj", utf16(u16::to_le_bytes));
    assert_reads("utf16be.obj", utf16(u16::to_be_bytes));

    file("bom.mtl", "\u{feff}newmtl red\nKd 1 0 0\n");
    let scene = read(&file("bom_mtl.obj", format!("\u{feff}mtllib bom.mtl\nusemtl red\n{text}")));
    assert_eq!((scene.meshes[0].albedo, scene.warnings.len()), (Vec3::X, 0));
    assert_shadow(&scene, "bom_mtl.obj");
}

#[test]
fn comments_behind_statements_are_no_part_of_them() {
    let vertices = vertices(|i| ["", " # c", "\t#c", "#c"][i % 4].into());
    assert_reads("comment.obj", format!("# c\n{vertices}f 1 2 3 4 # f 1 2\nf 5 6 7 8#c\n"));
    assert_reads(
        "comment.obj",
        format!("#\n {vertices} f 1 2 3 4\t# 9/9\n\t#f 1\nf 5 6 7 8 # \\\n"),
    );
    // a comment is not continued
    assert_reads("path.obj", format!("# C:\\\n{vertices}{FACES}"));
}

#[test]
fn names_may_be_left_out_have_a_hash_or_end_in_a_comment() {
    file("hash.mtl", "newmtl wood #3\nKd 1 0 0\nnewmtl b#\nKd 0 1 0 # green\nnewmtl c\nKd 0 0 1\n");
    let text = vertices(|_| String::new());
    let albedo = |statement: &str| {
        let text = format!("mtllib hash.mtl # colours\n{text}{statement}\n{FACES}");
        let scene = read(&file("hash.obj", text));
        assert_shadow(&scene, statement);
        assert_eq!(scene.warnings, [""; 0], "{statement}");
        (scene.meshes[0].name.clone(), scene.meshes[0].albedo)
    };
    let grey = ("unnamed_object".to_string(), Vec3::splat(0.8));
    for none in ["usemtl", "usemtl ", "usemtl # none", "usemtl gone", "usemtl\t", "#usemtl c"] {
        assert_eq!(albedo(none), grey, "{none}");
    }
    let named = |name: &str, color| (format!("unnamed_object/{name}"), color);
    assert_eq!(albedo("usemtl wood #3"), named("wood #3", Vec3::X));
    assert_eq!(albedo("usemtl b#"), named("b#", Vec3::Y));
    assert_eq!(albedo("usemtl c # the third"), named("c", Vec3::Z));
    assert_eq!(albedo("usemtl c\t#"), named("c", Vec3::Z));
    assert_eq!(albedo("o a # b\nusemtl c"), ("a/c".into(), Vec3::Z));
    assert_eq!(albedo("g\nusemtl c"), named("c", Vec3::Z));
    // one without a name ends another
    let text = format!("mtllib hash.mtl\n{text}usemtl c\nf 1 2 3 4\nusemtl\nf 5 6 7 8\n");
    let scene = read(&file("ended.obj", text));
    let colors: Vec<_> = scene.meshes.iter().map(|mesh| mesh.albedo).collect();
    assert_eq!(colors, [Vec3::Z, Vec3::splat(0.8)]);
}

#[test]
fn vertices_may_have_colours_alpha_and_weights_some_or_all() {
    for (name, more) in [
        ("colour.obj", (|_| " 0.5 0.5 0.5".into()) as fn(usize) -> String),
        ("alpha.obj", |_| " 0.5 0.5 0.5 1.0".into()),
        ("some.obj", |i| if i < 4 { " 1 0 0".into() } else { String::new() }),
        ("others.obj", |i| if i < 4 { String::new() } else { " 1 0 0 0.5".into() }),
        ("mixed.obj", |i| " 0.25".repeat(i % 6)),
        ("weight.obj", |_| " 1.0".into()),
        ("not_numbers.obj", |_| " red".into()),
    ] {
        assert_reads(name, vertices(more) + FACES);
    }
}

#[test]
fn corners_may_be_written_in_any_mix_of_ways() {
    let text = vertices(|_| String::new()) + "vt 0 0\nvt x\nvn 0 1 0\nvn 0 2 0\n";
    for faces in [
        "f 1 2/1 3//1 4/1/2\nf 5 6 7 8\n",
        "f -8 -7/-1 -6//-1 -5/-1/-2\nf -4 -3 -2 -1\n",
        "f 1 -7 3 -5\nf 5/1 6/ 7// 8//1\n",
        "f 1 \\\n2 3 \\\r\n4\r\nf 5 6 \\ \n 7 8\n",
        "f\t1  2\t\t3 4 \n   f 5 6 7 8",
        "f 1/9/1 2/9/1 3/9/1 4/9/1\ns off\nf 5/x/1 6//1 7 8\n",
    ] {
        let scene = read(&file("mix.obj", format!("{text}{faces}")));
        assert_shadow(&scene, faces);
        assert_eq!(scene.warnings, [""; 0], "{faces}");
    }
    // faces may come before what they name, and lines end as on old Macs
    let early = format!("{FACES}{}", vertices(|_| String::new()));
    assert_reads("early.obj", &early);
    assert_reads("mac.obj", early.replace('\n', "\r"));
    assert_reads("windows.obj", early.replace('\n', "\r\n"));
}

#[test]
fn normals_that_the_file_lacks_do_not_take_anothers_place() {
    let text = vertices(|_| String::new()) + "vn 0 3 4\nf 1//1 2 3//1 4\nf 5 6 7 8\n";
    let scene = read(&file("lacks.obj", text));
    let normals = &scene.meshes[0].normals;
    let given = normals.iter().filter(|n| n.distance(vec3(0.0, 0.6, 0.8)) < 1e-6).count();
    let up = normals.iter().filter(|n| **n == Vec3::Y).count();
    assert_eq!((given, given + up), (2, normals.len()));
}

#[test]
fn curves_and_surfaces_are_counted() {
    let text = vertices(|_| String::new()) + FACES;
    let free = "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\nsurf 0 1 0 1 1 2 3 4\n";
    let scene = read(&file("free.obj", format!("{text}{free}")));
    assert_shadow(&scene, "free.obj");
    assert_eq!(scene.warnings, ["2 free-form curves or surfaces skipped"]);
}

#[test]
fn wrong_line_is_named_by_its_number_behind_comments_and_continued_lines() {
    let text = "# a\n\nv 0 0 0\nv 1 0 0 # b\nv \\\n 0 1 \\\n 0\n# c\\\nf 1 2 3\nv 1 O 0\nf 1 2 3\n";
    let message = error(&file("numbered.obj", text));
    let expected = "`numbered.obj`: line 10, `v 1 O 0`: a vertex needs three numbers; ";
    assert!(message.starts_with(expected), "{message}");
    let behind =
        error(&file("behind.obj", format!("\u{feff}{}", text.replace('O', "0") + "f 1 2 9 # x")));
    assert!(behind.contains("line 12, `f 1 2 9 # x`: there is no vertex 9, of 4; "), "{behind}");
}

/// Corners of a polygon in the plane y = 0, from above and against the clock.
fn polygon(name: &str, corners: &[[f64; 2]]) -> (Scene, Duration) {
    let vertices = corners.iter().map(|[x, z]| format!("v {x} 0 {}\n", -z));
    let face: String = (1..=corners.len()).map(|i| format!(" {i}")).collect();
    let path = file(name, vertices.collect::<String>() + "f" + &face + "\n");
    let start = Instant::now();
    (read(&path), start.elapsed())
}

fn area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0
}

/// Shapes of so many corners, on which cutting ears takes from milliseconds to half a minute.
fn shapes(corners: usize) -> [(&'static str, Vec<[f64; 2]>); 6] {
    let turn = |i: usize, radius: f64| {
        let (sin, cos) = (i as f64 / corners as f64 * std::f64::consts::TAU).sin_cos();
        [radius * cos, radius * sin]
    };
    let half = corners / 2;
    let zigzag = |i: usize| if i.is_multiple_of(2) { 0.0 } else { 9.0 };
    let saw = (0..half).map(|i| [i as f64, zigzag(i)]);
    let back = (0..half).rev().map(|i| [i as f64, zigzag(i) + 0.5]);
    let quarter = corners / 4;
    let side = |f: fn(f64) -> [f64; 2]| (0..quarter).map(move |i| f(i as f64 / quarter as f64));
    let square = side(|t| [t, 0.0]).chain(side(|t| [1.0, t]));
    let square = square.chain(side(|t| [1.0 - t, 1.0])).chain(side(|t| [0.0, 1.0 - t]));
    let mut random = fastrand::Rng::with_seed(1);
    [
        ("circle", (0..corners).map(|i| turn(i, 9.0)).collect()),
        ("star", (0..corners).map(|i| turn(i, if i % 2 == 0 { 9.0 } else { 5.0 })).collect()),
        ("coast", (0..corners).map(|i| turn(i, 8.0 + random.f64())).collect()),
        ("saw", saw.chain(back).collect()),
        ("square", square.collect()),
        ("spikes", (0..corners).map(|i| turn(i, 0.1 + 9.0 * random.f64())).collect()),
    ]
}

#[test]
fn large_polygons_are_covered_once_in_about_a_second() {
    for (name, corners) in shapes(80_000) {
        let (scene, time) = polygon("large.obj", &corners);
        println!("{name}: {time:?}");
        assert_eq!(scene.warnings, [""; 0], "{name}");
        assert_eq!(scene.triangle_count(), corners.len() - 2, "{name}");
        let up = scene.triangles().map(|t| t.map(Vec3::as_dvec3));
        let areas: Vec<f64> = up.map(|[a, b, c]| (b - a).cross(c - a).y / 2.0).collect();
        assert!(areas.iter().all(|&area| area > -1e-6), "{name}");
        let (sum, whole) = (areas.iter().sum::<f64>(), area(&corners));
        assert!((sum - whole).abs() < 1e-5 * whole, "{name}: {sum} of {whole}");
        // ten times what it takes, as the machine may be busy
        assert!(time < Duration::from_secs(10), "{name}: {time:?}");
    }
}

#[test]
fn polygons_around_the_limit_of_the_two_ways_to_cut_are_covered_once() {
    for corners in [996, 1000, 1004] {
        for (name, shape) in shapes(corners) {
            for turned in [false, true] {
                let mut shape = shape.clone();
                if turned {
                    shape.reverse();
                }
                let (scene, _) = polygon("limit.obj", &shape);
                assert_eq!(scene.warnings, [""; 0], "{name}");
                let up = scene.triangles().map(|t| t.map(Vec3::as_dvec3));
                let sum: f64 = up.map(|[a, b, c]| (b - a).cross(c - a).y / 2.0).sum();
                let whole = area(&shape);
                assert!((sum - whole).abs() < 1e-5 * whole.abs(), "{name}: {sum} of {whole}");
            }
        }
    }
}

#[test]
fn large_polygons_that_touch_or_cross_themselves_are_still_read() {
    // a ring, as polygons with a hole are written: its cut is there twice
    let turn = |i: usize, radius: f64| {
        let (sin, cos) = (i as f64 / 1000.0 * std::f64::consts::TAU).sin_cos();
        [radius * cos, radius * sin]
    };
    let outer = (0..=1000).map(|i| turn(i % 1000, 9.0));
    let inner = (0..=1000).rev().map(|i| turn(i % 1000, 5.0));
    let ring: Vec<_> = outer.chain(inner).collect();
    let (scene, _) = polygon("ring.obj", &ring);
    assert_eq!(scene.warnings, [""; 0]);
    let sum: f32 = scene.triangles().map(|[a, b, c]| (b - a).cross(c - a).y / 2.0).sum();
    assert!((f64::from(sum) - area(&ring)).abs() < 1e-3 * area(&ring), "{sum}");

    let mut crossing: Vec<_> = (0..2000).map(|i| turn(i, 9.0)).collect();
    crossing.swap(100, 700);
    let (scene, _) = polygon("crossing.obj", &crossing);
    assert_valid(&scene);
    let what = "1 polygons cross themselves or have no area, and may be covered wrongly";
    assert_eq!(scene.warnings, [what]);
}
