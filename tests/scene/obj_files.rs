//! OBJ files, and errors that any file can cause.

use std::path::Path;

use glam::{Vec3, vec3};

use crate::{assert_valid, error, file, read, shared};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn groups_and_materials_are_meshes_with_their_diffuse_colour() {
    let materials = "newmtl red\nKd 0.5 0.1 0\nnewmtl grey\nKd 0.25\nnewmtl odd\nKd nan 2 -1\n";
    file("materials.mtl", materials);
    let faces = "o left\nusemtl red\nf 1 2 3\nusemtl grey\nf 1 3 4\nusemtl red\nf 4 3 1\n\
                 g right\nf 1 2 4\nusemtl odd\nf 1 2 4\nusemtl none\nf 1 2 4\n";
    let scene = read(&file("groups.obj", format!("mtllib materials.mtl\n{SQUARE}{faces}")));
    let found: Vec<_> = scene
        .meshes
        .iter()
        .map(|mesh| (mesh.name.as_str(), mesh.triangles.len(), mesh.albedo))
        .collect();
    let red = vec3(0.5, 0.1, 0.0);
    assert_eq!(
        found,
        [
            ("left/red", 1, red),
            ("left/grey", 1, Vec3::splat(0.25)),
            ("left/red", 1, red),
            ("right/red", 1, red),
            ("right/odd", 1, vec3(0.0, 1.0, 0.0)),
            ("right", 1, Vec3::splat(0.8)),
        ]
    );
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.name, "groups");
    assert!(scene.camera.is_none() && scene.lights.is_empty());
}

#[test]
fn missing_material_library_is_only_a_warning() {
    let scene = read(&file("no_mtl.obj", format!("mtllib gone.mtl\n{SQUARE}f 1 2 3\n")));
    assert_eq!(scene.warnings.len(), 1);
    let warning = &scene.warnings[0];
    assert!(warning.starts_with("material library `gone.mtl` cannot be read ("), "{warning}");
    assert!(warning.ends_with("): its materials are grey"), "{warning}");
}

#[test]
fn material_libraries_may_be_several_and_a_broken_one_is_only_a_warning() {
    file("first.mtl", b"# caf\xe9\nnewmtl a\xe9\nd -halo 0.5\nKd 1 0 0");
    file("the second.mtl", "\tnewmtl\tb\n\tKd\t0\t1\t0\n");
    file("third.mtl", "newmtl c\nKd x\n");
    let libraries = "mtllib first.mtl gone.mtl\n\tmtllib\tthe second.mtl\nmtllib third.mtl\n";
    let mut bytes = format!("{libraries}{SQUARE}").into_bytes();
    bytes.extend(b"usemtl a\xe9\nf 1 2 3\n  usemtl b\n\tf 1 2 4\nusemtl c\nf 1 2 3\n");
    let scene = read(&file("libraries.obj", bytes));
    let found: Vec<_> = scene.meshes.iter().map(|mesh| mesh.albedo).collect();
    assert_eq!(found, [Vec3::X, Vec3::Y, Vec3::splat(0.8)]);
    let [gone, third] = &scene.warnings[..] else {
        panic!("{:?}", scene.warnings);
    };
    assert!(gone.starts_with("material library `gone.mtl` cannot be read ("), "{gone}");
    assert_eq!(
        third,
        "material library `third.mtl` cannot be read \
         (line 2, `Kd x`: no colour of one or three numbers): its materials are grey"
    );
}

#[test]
fn missing_normals_are_the_faces_and_given_ones_are_kept_and_normalised() {
    let text = format!("{SQUARE}vn 0 3 4\no a\nf 1 2 3\no b\nf 1//1 3//1 4//1\n");
    let scene = read(&file("normals.obj", text));
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 3]);
    let given = &scene.meshes[1].normals;
    assert!(given.iter().all(|n| n.distance(vec3(0.0, 0.6, 0.8)) < 1e-6));

    let text = format!("{SQUARE}vn 0 3 4\nf 1//1 3//1 4//1\nf 1 2 3\n");
    let scene = read(&file("some_normals.obj", text));
    let given = vec3(0.0, 0.6, 0.8);
    assert_eq!(scene.meshes[0].normals, [given, given, given, Vec3::Z, Vec3::Z, Vec3::Z]);
    assert_eq!(scene.warnings, [""; 0]);
}

#[test]
fn relative_indices_continued_lines_and_foreign_encodings_are_read() {
    let mut bytes = b"# caf\xe9\n\r\n".to_vec();
    bytes.extend(SQUARE.bytes());
    bytes.extend(b"f -4/7/-1 -3 \\\n -2\r\nf 1 2 \\");
    bytes.extend(b"\n 4");
    let scene = read(&file("odd.obj", &bytes));
    assert_eq!(scene.triangle_count(), 2);
    let first = scene.triangles().next().unwrap();
    assert_eq!(first, [vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(1.0, 1.0, 0.0)]);
}

#[test]
fn concave_polygons_are_covered_once() {
    // A comb of three teeth: from no corner does a fan cover it.
    let comb = [
        (0, 0),
        (5, 0),
        (5, 3),
        (4, 3),
        (4, 1),
        (3, 1),
        (3, 3),
        (2, 3),
        (2, 1),
        (1, 1),
        (1, 3),
        (0, 3),
    ];
    let corners: String = comb.iter().map(|(x, z)| format!("v {x} 0 {z}\n")).collect();
    let scene = read(&file("comb.obj", format!("{corners}f 1 2 3 4 5 6 7 8 9 10 11 12\n")));
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.triangle_count(), comb.len() - 2);
    let area: f32 = scene.triangles().map(|[a, b, c]| (b - a).cross(c - a).y / -2.0).sum();
    let size: f32 = scene.triangles().map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum();
    assert_eq!((area, size), (5.0 * 3.0 - 2.0 * 2.0, 11.0));

    let bow = read(&file("bow.obj", format!("{SQUARE}f 1 2 4 3\n")));
    assert_eq!(
        bow.warnings,
        ["1 polygons cross themselves or have no area, and may be covered wrongly"]
    );
    assert_eq!(bow.triangle_count(), 2);
}

#[test]
fn corners_on_a_straight_edge_are_kept() {
    // Neighbouring faces meet there: an edge that skipped them would leave gaps.
    let octagon = "v 0 0 0\nv 1 0 1\nv 2 0 2\nv 2 1 2\nv 2 2 2\nv 1 2 1\nv 0 2 0\nv 0 1 0\n";
    for first in 0..8 {
        let face: String = (first..first + 8).map(|i| format!(" {}", i % 8 + 1)).collect();
        let scene = read(&file("octagon.obj", format!("{octagon}f{face}\n")));
        assert_eq!(scene.warnings, [""; 0]);
        assert_eq!(scene.triangle_count(), 6);
        let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).length() / 2.0;
        let sum: f32 = scene.triangles().map(area).sum();
        assert!((sum - 32.0_f32.sqrt()).abs() < 1e-5, "{sum}");
    }
}

#[test]
fn lines_and_points_are_counted_and_never_become_triangles() {
    let scene = read(&file("lines.obj", format!("{SQUARE}l 1 2 3\np 1 2 3\nf 1 2\nf 1 2 3\n")));
    assert_eq!(scene.triangle_count(), 1);
    let warning = "3 points, lines or faces of fewer than three corners skipped";
    assert_eq!(scene.warnings, [warning]);
}

#[test]
fn unusable_vertices_and_normals_are_counted_named_and_dropped() {
    let bad = "v nan 0 0\nv 0 inf 0\nvn 0 0 0\nvn nan 0 0\nvn 0 0 1\no x\n\
               f 1//3 2//3 5//3\nf 1//3 6//3 5//3\nf 1//3 2//3 3//3 5//3\nf 1//1 2//2 3//3\n";
    let scene = read(&file("bad.obj", format!("{SQUARE}{bad}")));
    assert_valid(&scene);
    assert_eq!(scene.triangle_count(), 2);
    assert_eq!(
        scene.warnings,
        [
            "mesh `x`: 2 non-finite vertices (first: number 5, from 1), 3 triangles dropped",
            "mesh `x`: 2 corners have no usable normal and got their face's",
        ]
    );
}

#[test]
fn triangles_without_area_keep_a_unit_normal() {
    let scene = read(&file("flat.obj", format!("{SQUARE}f 1 1 2\nf 1 2 3\n")));
    assert_valid(&scene);
    assert_eq!(scene.triangle_count(), 2);
}

#[test]
fn faults_are_named_with_the_line_that_has_them() {
    for (line, fault) in [
        ("v 1 2", "a vertex needs three numbers"),
        ("v 1 2,5 3", "a vertex needs three numbers"),
        ("f 1 x 2", "`x` is no number of a vertex"),
        ("f 1 2 //1", "`//1` names no vertex"),
        ("vn 1 , 2", "a normal needs three numbers"),
        ("f 1 2 0", "there is no vertex 0, of 4"),
        ("f -9 1 2", "there is no vertex -9, of 4"),
        ("f -1 -5 2", "there is no vertex -5, of 4"),
        // these may be behind the face, so they are missed at the end
        ("f 1 2 6", "there is no vertex 6, of 5"),
        ("f 1 2 3 4294967295", "there is no vertex 4294967295, of 5"),
        ("f 1 2 3 4294967296", "there is no vertex 4294967296, of 4"),
        ("f 1 2 99999999999999999999", "`99999999999999999999` is no number of a vertex"),
    ] {
        let expected = format!(
            "`fault.obj`: line 6, `{line}`: {fault}; export it again, or check it with a validator"
        );
        let path = file("fault.obj", format!("# two\n{SQUARE}  {line}\nv 0 0 1\nf 1 2 3\n"));
        assert_eq!(error(&path), expected);
    }
    let path = file("range.obj", format!("{SQUARE}vn 0 0 1\nf 1//1 \\\n2//1 3//2\nf 1 2 3\n"));
    let message = error(&path);
    assert!(message.contains("line 6, `f 1//1 \\`: there is no normal 2, of 1; "), "{message}");
    let many: String = (0..100).map(|_| " 1").collect();
    let message = error(&file("long.obj", format!("{SQUARE}f{many} 7\n")));
    assert!(message.contains("…`: there is no vertex 7, of 4; ") && message.len() < 200);
}

#[test]
fn every_cut_and_changed_byte_gives_an_error_or_a_valid_scene() {
    const MATERIALS: &[u8] = b"newmtl red\nKd 0.5 0.1 0\nnewmtl grey\nKd 0.25\n";
    const OBJECT: &[u8] = b"mtllib fuzz.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .2 .5 0\n\
        vt 0 0\nvn 0 0 1\no left\nusemtl red\nf 1/1/1 2/1/1 3/1/1\nl 1 2 3\n\
        g right\nusemtl grey\nf 1 2 3 4 5\nf -5//-1 -4//-1 \\\n-3//-1 -2//1\n";
    let check = |object: &[u8], materials: &[u8]| {
        file("fuzz.mtl", materials);
        let path = file("fuzz.obj", object);
        match dpsm::scene::open(path.to_str().unwrap(), &Default::default()) {
            Ok(scene) => {
                assert_valid(&scene);
                true
            }
            Err(_) => false,
        }
    };
    let variants = |whole: &[u8]| {
        let mut variants: Vec<_> = (0..whole.len()).map(|i| whole[..i].to_vec()).collect();
        for i in 0..whole.len() {
            for byte in *b"09-/ \n\\\t#.ev\xff\0" {
                let mut changed = whole.to_vec();
                changed[i] = byte;
                variants.push(changed);
            }
        }
        variants
    };
    let objects = variants(OBJECT);
    let read = objects.iter().filter(|o| check(o, MATERIALS)).count();
    assert!(read > 0 && read < objects.len());
    // Materials are never an error.
    let mut materials = variants(MATERIALS).into_iter();
    assert!(materials.all(|materials| check(OBJECT, &materials)));
}

#[test]
fn files_without_triangles_say_what_was_found() {
    let remedy = "export its meshes as triangles";
    let points = file("points.obj", format!("{SQUARE}p 1\n"));
    assert_eq!(
        error(&points),
        format!(
            "`points.obj` has no triangles, only 0 faces; \
             1 points, lines or faces of fewer than three corners skipped; {remedy}"
        )
    );
    let all_bad = file("all_bad.obj", "v nan 0 0\nf 1 1 1\n");
    assert_eq!(
        error(&all_bad),
        format!(
            "`all_bad.obj` has no triangles, only 1 faces; mesh `unnamed_object`: \
             1 non-finite vertices (first: number 1, from 1), 1 triangles dropped; {remedy}"
        )
    );
}

#[test]
fn paths_that_are_no_scene_files_are_errors_with_a_remedy() {
    assert_eq!(error(&file("empty.obj", "")), "`empty.obj` is empty (0 bytes); export it again");
    let unknown = error(&file("scene.FBX", "x"));
    assert_eq!(unknown, "`scene.FBX`: unknown extension `fbx`; convert it to .glb, .gltf or .obj");
    let none = error(&file("scene", "x"));
    assert_eq!(none, "`scene`: unknown extension ``; convert it to .glb, .gltf or .obj");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("folder.obj");
    std::fs::create_dir_all(&folder).unwrap();
    assert_eq!(
        error(&folder),
        "`folder.obj` is a directory; name a .obj, .gltf or .glb file in it"
    );
    let missing = error(Path::new("no/such/file.glb"));
    assert!(missing.starts_with("cannot read `file.glb`: "), "{missing}");
    assert!(missing.ends_with("; check the path and its permissions"), "{missing}");
}

#[test]
fn sponza_is_read_whole() {
    let Some(scene) = shared("sponza.obj") else {
        return;
    };
    assert_valid(&scene);
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!(scene.triangle_count(), 76_154);
    let extent = scene.bounds().extent();
    assert!(extent.distance(vec3(34.82, 16.56, 15.6)) < 0.01, "{extent}");
}
