//! A user's own modules in files.

use std::path::Path;

use dpsm::{Catalogue, Linked, link, validate};

use super::{check_origins, features, folder};

fn linked(folder: &Path, file: &str) -> Linked {
    let path = folder.join(file);
    let linked = link::link_file(&path).unwrap_or_else(|error| panic!("{error}"));
    validate(&linked).unwrap_or_else(|error| panic!("{error}\n{}", linked.text));
    linked
}

/// The message, with paths from the folder.
fn error(folder: &Path, file: &str) -> String {
    let error = link::link_file(folder.join(file)).unwrap_err().to_string();
    error
        .replace(&format!("{}/", folder.display()), "")
        .replace(&folder.display().to_string(), "HERE")
}

#[test]
fn imports_are_looked_up_from_the_files_folder() {
    let files = [
        (
            "main.wesl",
            "import super::tone::{tone};\nimport package::lib::noise::{noise};\nimport dpsm::depth::{dpsm_depth};\n\
             fn f(x: f32) -> f32 { return tone(x) + noise(x) + dpsm_depth(x, 0.1, 1.0); }\n",
        ),
        ("tone.wesl", "/// Tone.\nfn tone(x: f32) -> f32 { return x; }\nfn unused() {}\n"),
        (
            "lib/noise.wgsl",
            "import super::hash::hash2;\nimport super::super::tone::{tone};\nimport package::lib::deep::more::{more};\n\
             import super::depth::{dpsm_within};\n\
             fn noise(x: f32) -> f32 { return hash2(x) + tone(x) + more(); }\n",
        ),
        ("lib/hash.wesl", "fn hash2(x: f32) -> f32 { return fract(x); }\n"),
        (
            "lib/deep/more.wesl",
            "import super::super::hash::{hash2};\nfn more() -> f32 { return hash2(1.0); }\n",
        ),
    ];
    let folder = folder("folders", &files);
    let linked = linked(&folder, "main.wesl");
    for once in ["fn tone(", "fn noise(", "fn hash2(", "fn more(", "fn dpsm_depth("] {
        assert_eq!(linked.text.matches(once).count(), 1, "{once}");
    }
    assert!(!linked.text.contains("unused"));
    let mut lines = 0;
    for (name, text) in files {
        lines += check_origins(&linked, &folder.join(name).display().to_string(), text);
    }
    assert!(lines >= 6, "{lines}");
    assert!(linked.text.contains(&format!("// {}\n", folder.join("lib/noise.wgsl").display())));
}

#[test]
fn dpsms_modules_come_first_under_their_names() {
    // as before there were modules in files
    let folder = folder(
        "own-name",
        &[
            (
                "main.wesl",
                "import super::depth::{dpsm_depth};\nimport super::depth::{mine};\nfn f() -> f32 { return mine(); }\n",
            ),
            ("depth.wgsl", "fn mine() -> f32 { return 1.0; }\nfn dpsm_depth() {}\n"),
        ],
    );
    let text = linked(&folder, "main.wesl").text;
    assert!(text.contains("fn mine()") && text.contains("fn dpsm_depth(l: f32"), "{text}");
}

#[test]
fn wesl_files_come_before_wgsl_files() {
    let folder = folder(
        "both",
        &[
            ("main.wesl", "import super::m::{f};"),
            ("m.wesl", "fn f() { }"),
            ("m.wgsl", "fn f() { return; }"),
        ],
    );
    assert!(linked(&folder, "main.wesl").text.contains("fn f() { }"));
}

#[test]
fn missing_files_and_items_name_what_there_is() {
    let folder = folder(
        "missing",
        &[
            ("main.wesl", "\nimport super::tnoe::{tone};"),
            ("deep.wesl", "import package::lib::nosie::{noise};"),
            ("nofolder.wesl", "import package::bil::noise::{noise};"),
            ("item.wesl", "import super::tone::{tune};"),
            ("out.wesl", "import super::super::tone::{tone};"),
            ("near.wesl", "import super::visibilty::{dpsm_visibility};"),
            ("inner.wesl", "import super::lib::broken::{noise};"),
            ("tone.wesl", "fn tone() {}\nfn other() {}"),
            ("lib/noise.wesl", "fn noise() {}"),
            ("lib/broken.wesl", "\n\nfn noise() {"),
        ],
    );
    let tnoe = error(&folder, "main.wesl");
    assert!(
        tnoe.starts_with(
            "main.wesl:2: no module `tnoe`: no file tnoe.wesl or .wgsl, and HERE holds `tone.wesl`"
        ),
        "{tnoe}"
    );
    assert!(tnoe.contains("--module PATH"), "{tnoe}");
    let nosie = error(&folder, "deep.wesl");
    assert!(
        nosie.starts_with("deep.wesl:1: no module `lib::nosie`: ")
            && nosie.contains("`noise.wesl`"),
        "{nosie}"
    );
    assert!(error(&folder, "nofolder.wesl").contains("there is no folder bil"));
    assert_eq!(
        error(&folder, "item.wesl"),
        "item.wesl:1: unknown item `tune` in module `tone`; did you mean `tone`? There are `tone`, `other`"
    );
    let out = error(&folder, "out.wesl");
    assert!(
        out.starts_with("out.wesl:1: ") && out.contains("`super::super` leads out of HERE"),
        "{out}"
    );
    assert!(error(&folder, "near.wesl").contains("dpsm has `dpsm::visibility`"));
    assert_eq!(error(&folder, "inner.wesl"), "lib/broken.wesl:3: `{` is not closed");
}

#[test]
fn cycles_of_files_name_their_chain() {
    let folder = folder(
        "cycle",
        &[
            ("main.wesl", "import super::a::{a};"),
            ("a.wesl", "import super::b::{b};\nfn a() {}"),
            ("b.wesl", "\nimport super::a::{a};\nfn b() {}"),
            ("self.wesl", "import super::self::{f};\nfn f() {}"),
            ("back.wesl", "import super::c::{c};\nfn back() {}"),
            ("c.wesl", "import package::back::{back};\nfn c() {}"),
        ],
    );
    assert_eq!(error(&folder, "main.wesl"), "b.wesl:2: import cycle: a -> b -> a");
    assert_eq!(error(&folder, "self.wesl"), "self.wesl:1: import cycle: self.wesl -> self.wesl");
    assert_eq!(error(&folder, "back.wesl"), "c.wesl:1: import cycle: back.wesl -> c -> back.wesl");
}

#[test]
fn modules_are_named_by_path_from_anywhere() {
    let folder = folder(
        "named",
        &[
            (
                "shaders/main.wesl",
                "import super::noise::{noise};\nfn f() -> f32 { return noise(); }",
            ),
            (
                "shaders/lib/inner.wesl",
                "import package::noise::{noise};\nfn g() -> f32 { return noise(); }",
            ),
            (
                "common/noise.wesl",
                "import super::hash::{hash2};\nfn noise() -> f32 { return hash2(); }",
            ),
            ("common/hash.wesl", "fn hash2() -> f32 { return 1.0; }"),
        ],
    );
    let named = Catalogue::dpsm().unwrap().with_file(folder.join("common/noise.wesl")).unwrap();
    for main in ["shaders/main.wesl", "shaders/lib/inner.wesl"] {
        let linked = named.link_file(folder.join(main)).unwrap();
        assert_eq!(linked.text.matches("fn hash2()").count(), 1);
        validate(&linked).unwrap();
    }
    // by name, alone and beside dpsm's, and from a text in no file
    let linked = named.link(&["noise", "depth::dpsm_depth"]).unwrap();
    assert!(linked.text.contains("fn noise()") && linked.text.contains("fn dpsm_depth("));
    assert!(
        !linked.text.starts_with("// Generated by dpsm"),
        "a user's licence is the user's matter"
    );
    assert!(named.link(&["noise::noise"]).unwrap().text.contains("fn hash2()"));
    assert!(
        named
            .link_source("x.wesl", "import super::noise::{noise};")
            .unwrap()
            .text
            .contains("fn hash2()")
    );
    let error = named.link(&["nois"]).unwrap_err().to_string();
    assert!(error.contains("did you mean `noise`?"), "{error}");
    let twice = named.with_file(folder.join("common/noise.wesl")).unwrap();
    let error = twice.link(&["noise"]).unwrap_err().to_string();
    assert!(error.contains("module `noise` is already in the catalogue"), "{error}");
}

#[test]
fn modules_in_files_follow_features_and_no_naming_rule() {
    let folder = folder(
        "features",
        &[
            (
                "main.wesl",
                "@if(SOFT) import super::soft2::{taps1};\n@else const taps1 = 1;\nfn f() -> i32 { return taps1; }\n",
            ),
            ("soft2.wesl", "@if(MANY) const taps1 = 64;\n@else const taps1 = 16;\n"),
        ],
    );
    let link = |given: &[(&str, bool)]| {
        let all = Catalogue::dpsm().unwrap().features(features(given));
        let linked = all.link_file(folder.join("main.wesl")).unwrap();
        validate(&linked).unwrap();
        linked.text
    };
    assert!(link(&[("SOFT", true), ("MANY", false)]).contains("const taps1 = 16;"));
    assert!(link(&[("SOFT", false)]).contains("const taps1 = 1;"));
}

#[test]
fn files_that_are_no_text_are_named_as_what_they_are() {
    let folder = folder("kinds", &[("good.wesl", "fn f() {}"), ("sub/x.wesl", "")]);
    let utf16: Vec<u8> = "fn f() {}".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = "fn f() {}".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let cases: [(&str, Vec<u8>, &str); 13] = [
        ("spirv.wgsl", [0x07230203u32, 0x10000, 0, 9].map(u32::to_le_bytes).concat(), "SPIR-V"),
        ("le.wesl", [&[0xff, 0xfe][..], &utf16].concat(), "UTF-16"),
        ("be.wesl", [&[0xfe, 0xff][..], &big].concat(), "UTF-16"),
        ("bare.wesl", utf16, "UTF-16"),
        ("png.wesl", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec(), "binary"),
        ("zip.wesl", (0..400).map(|i| (i * 89 % 255 + 1) as u8).collect(), "binary"),
        ("latin.wesl", b"// gr\xf6\xdfer\nfn f() {}".to_vec(), "line 1 is no UTF-8 (byte 0xf6)"),
        ("empty.wesl", Vec::new(), "empty"),
        ("blank.wesl", b" \r\n\n".to_vec(), "empty"),
        ("bom.wesl", b"\xef\xbb\xbf".to_vec(), "empty"),
        ("lfs.wesl", b"version https://git-lfs.github.com/spec/v1\n".to_vec(), "Git LFS"),
        ("page.wesl", b"\n<!DOCTYPE html>\n<html>".to_vec(), "web page"),
        ("utf32.wesl", vec![0xff, 0xfe, 0, 0, b'f', 0, 0, 0], "UTF-32"),
    ];
    for (name, bytes, what) in cases {
        std::fs::write(folder.join(name), bytes).unwrap();
        let error = error(&folder, name);
        assert!(error.starts_with(&format!("{name}: ")) && error.contains(what), "{error}");
        // the same of a module, with the import that asks for it
        let stem = name.split('.').next().unwrap();
        let main = format!("\nimport super::{stem}::{{f}};");
        std::fs::write(folder.join("main.wesl"), main).unwrap();
        if name.ends_with(".wesl") {
            let error = self::error(&folder, "main.wesl");
            assert!(
                error.starts_with(&format!("main.wesl:2: {name}: ")) && error.contains(what),
                "{error}"
            );
        }
    }
    let marked = b"\xef\xbb\xbffn f() {}\r\n";
    std::fs::write(folder.join("marked.wesl"), marked).unwrap();
    assert_eq!(linked(&folder, "marked.wesl").text, "fn f() {}\n");
    assert!(
        error(&folder, "sub")
            .starts_with("HERE/sub: it is a folder; name one of its files, `x.wesl`")
            || error(&folder, "sub").contains("it is a folder; name one of its files, `x.wesl`")
    );
    let missing = error(&folder, "goood.wesl");
    assert!(missing.starts_with("goood.wesl: no such file; HERE holds `good.wesl`"), "{missing}");
    assert!(error(&folder, "nowhere/x.wesl").contains("there is no folder nowhere"));
}
