//! Texts that another tool finishes: passed on as they are, with a word on which tool that is.

use dpsm::link::Note;
use dpsm::{Linked, link_source, validate};

use super::{HEAD, check_origins};

/// A shader around a bias, which is linked with what it imports.
fn with_bias(bias: &str) -> (String, Linked) {
    let text = format!(
        "{HEAD}fn lit(p: vec3<f32>) -> f32 {{\n    return dpsm_visibility(maps, comparison, p, light, {bias});\n}}\n"
    );
    let linked = link_source("my.wesl", &text).unwrap_or_else(|error| panic!("{bias}: {error}"));
    check_origins(&linked, "my.wesl", &text);
    assert!(linked.text.contains("fn dpsm_visibility("), "{bias}");
    (text, linked)
}

fn linked(text: &str) -> Linked {
    let linked = link_source("my.wesl", text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    check_origins(&linked, "my.wesl", text);
    linked
}

/// The text's own lines come out as they went in, but for its imports.
fn passed_on(text: &str) -> Linked {
    let linked = linked(text);
    for line in text.lines().filter(|line| !line.starts_with("import")) {
        assert!(
            linked.text.lines().any(|other| other == line),
            "`{line}` is not in\n{}",
            linked.text
        );
    }
    linked
}

#[test]
fn placeholders_of_other_preprocessors_are_passed_on() {
    for bias in [
        "$BIAS",
        "${BIAS}",
        "#{BIAS}",
        "#BIAS",
        "{{ bias }}",
        "{{bias}}",
        "<%= bias %>",
        "0.#{DIGITS}",
        "bias_#{N}",
        "bias_#{N}_x",
        "$$",
        "%BIAS%",
        "__BIAS__",
        "@BIAS@",
        "${ light.bias * 2 }",
    ] {
        let (_, linked) = with_bias(bias);
        assert!(linked.text.contains(&format!("light, {bias});")), "{bias}");
        if !bias.starts_with(['%', '_', '@']) {
            let note = linked.notes()[0].to_string();
            assert!(note.starts_with("my.wesl:7: `") && note.contains("placeholder"), "{note}");
            let error = validate(&linked).unwrap_err().to_string();
            assert!(error.starts_with("my.wesl:7: no WGSL yet: `"), "{error}");
        }
    }
}

#[test]
fn placeholders_may_stand_for_anything_of_a_declaration() {
    for text in [
        "@group(#{GROUP}) @binding(0) var<uniform> x: f32;",
        "const N = #{N};\nfn f() -> i32 { return N; }",
        "var<workgroup> x: array<f32, #{N}>;",
        "var<storage, #{MODE}> x: array<f32>;",
        "fn #{NAME}() {}\nfn #{NAME}() {}",
        "fn f_#{NAME}(x: #{TYPE}) -> #{TYPE} { return x; }",
        "#{DECLARATIONS}\nfn f() {}",
        "${declarations}\n\nconst x = 1;",
        "{{ declarations }}\nconst x = 1;",
        "fn f() {\n    #{BODY}\n}",
        "import dpsm::light::{DpsmLight};\nfn f(l: DpsmLight{{ more }}) {}",
        "struct S {\n    #{MEMBERS}\n    x: f32,\n}",
        "{% if soft %}\nfn f() {}\n{% else %}\nfn f() { g(); }\n{% endif %}",
        "<% if (soft) { %>\nfn f() {}\n<% } %>",
        "const x = {{ x }};\nconst y = $y;",
        "const x = ${ a ? 1 : 2 };",
    ] {
        let linked = passed_on(text);
        assert!(linked.notes().iter().any(|note| note.unfinished), "{text}");
        assert_eq!(text.contains("DpsmLight"), linked.text.contains("struct DpsmLight"));
    }
}

#[test]
fn lines_of_other_tools_are_passed_on_and_named() {
    for (line, tool) in [
        ("#ifdef SHADOWS", "C preprocessor or naga_oil"),
        ("#ifndef SHADOWS", "C preprocessor or naga_oil"),
        ("#if SHADOWS > 1", "C preprocessor or naga_oil"),
        ("  #  ifdef SHADOWS", "C preprocessor or naga_oil"),
        ("#define N 4", "C preprocessor or naga_oil"),
        ("#define MAX(a, b) \\\n    max(a, b)", "C preprocessor or naga_oil"),
        ("#import bevy_pbr::mesh_functions", "naga_oil"),
        ("#import bevy_pbr::{\n    forward_io::VertexOutput,\n    utils::PI,\n}", "naga_oil"),
        ("#define_import_path my::module", "naga_oil"),
        ("#include \"noise.wgsl\"", "C preprocessor or a bundler's plugin"),
        ("#include <noise>", "C preprocessor or a bundler's plugin"),
        ("#version 450", "GLSL"),
        ("#pragma once", "C preprocessor"),
        ("#something else", "another preprocessor"),
    ] {
        let linked = passed_on(&format!("{HEAD}{line}\nfn f() {{}}\n"));
        let note = linked.notes()[0].to_string();
        assert!(note.starts_with("my.wesl:6: `#") && note.contains(tool), "{note}");
        assert!(linked.text.contains("struct DpsmLight"));
        let error = validate(&linked).unwrap_err().to_string();
        assert!(error.starts_with("my.wesl:6: no WGSL yet: `#"), "{error}");
    }
}

#[test]
fn branches_of_another_preprocessor_may_declare_the_same_or_open_brackets() {
    let text = "import dpsm::depth::{dpsm_depth};
#ifdef LINEAR
fn f(l: f32) -> f32 { return l; }
#else
fn f(l: f32) -> f32 { return dpsm_depth(l, 0.1, 1.0); }
#endif
";
    assert!(passed_on(text).text.contains("fn dpsm_depth("));
    let text = "import dpsm::depth::{dpsm_depth};
enable f16;
#ifdef WIDE
fn f(l: f32, wide: f32) -> f32 {
#else
fn f(l: f32) -> f32 {
#endif
    let dpsm_within = 1.0;
    return dpsm_depth(l, 0.1, 1.0);
}
";
    let linked = linked(text);
    assert!(linked.text.contains("fn dpsm_depth(") && linked.text.starts_with("enable f16;\n"));
    assert!(linked.text.ends_with(text.split_once("enable f16;\n").unwrap().1));
    assert!(linked.notes().iter().any(|note| note.what.contains("brackets do not pair")));
    // without such a tool it is a slip, and the line is named
    let error = link_source("my.wesl", "fn f() {\n").unwrap_err().to_string();
    assert_eq!(error, "my.wesl:1: `{` is not closed");
}

#[test]
fn other_tools_imports_of_dpsm_are_told_what_to_write() {
    for (line, instead) in [
        ("#import dpsm::visibility::dpsm_visibility", "dpsm::visibility::{dpsm_visibility}"),
        ("#import dpsm::visibility", "dpsm::visibility::{name}"),
        ("#import dpsm::light as light", "dpsm::light::{name}"),
        (
            "#import dpsm::{\n    visibility::dpsm_visibility\n}",
            "dpsm::visibility::{dpsm_visibility}",
        ),
        ("#include \"dpsm/visibility.wgsl\"", "dpsm::visibility::{name}"),
        ("#include <dpsm/shade.wgsl>", "dpsm::shade::{name}"),
    ] {
        let error =
            link_source("my.wesl", &format!("\n{line}\nfn f() {{}}")).unwrap_err().to_string();
        let (start, end) =
            (format!("my.wesl:2: `{}", line.lines().next().unwrap()), "another tool's line");
        assert!(error.starts_with(&start) && error.contains(end), "{error}");
        assert!(error.ends_with(&format!("write `import {instead};`")), "{error}");
    }
    // a path of the module's own is no import
    passed_on("#define_import_path dpsm::mine\nfn f() {}");
}

#[test]
fn comments_that_others_act_on_are_named_and_do_no_harm() {
    for comment in [
        "//!include \"noise.wgsl\"",
        "//#include <noise>",
        "// @import noise/simplex.wgsl",
        "//! use noise::x",
    ] {
        let linked = passed_on(&format!("{comment}\nfn f() {{}}"));
        let note = linked.notes()[0].to_string();
        assert!(
            note.starts_with("my.wesl:1: `") && note.contains("is a comment to dpsm"),
            "{note}"
        );
        validate(&linked).unwrap();
    }
    for comment in ["//! Includes all.", "// #1 import of all", "// @important", "//! import it"] {
        assert!(linked(&format!("{comment}\nfn f() {{}}")).notes().is_empty(), "{comment}");
    }
}

#[test]
fn words_that_naga_does_not_know_are_passed_on() {
    let text = "enable chromium_experimental_x;\nrequires some_feature;\n@future(1) fn f() { @soon g(); }\n";
    let linked = passed_on(text);
    assert!(linked.notes().is_empty());
    let error = validate(&linked).unwrap_err().to_string();
    assert!(
        error.contains("chromium_experimental_x") && error.contains("another compiler"),
        "{error}"
    );
    for text in [
        "interface I { fn f(); }\nfn g() {}",
        "public fn f() {}\nfn g() {}",
        "uniform x : f32;\nvarying y : vec2f;\nfn g() {}",
        "@!wildcardable;\nfn g() {}",
        "use '@use-gpu/wgsl/x'::{ y };\nfn g() {}",
        "template<T>\nfn g() {}",
    ] {
        let linked = passed_on(text);
        let Note { what, unfinished, .. } = &linked.notes()[0];
        assert!(what.contains("starts no declaration that dpsm knows") && !unfinished, "{what}");
        // the declarations after it are still seen
        let twice = format!("{text}\nfn g() {{}}");
        assert!(link_source("my.wesl", &twice).unwrap_err().to_string().contains("declared twice"));
    }
}

#[test]
fn modules_take_marks_of_other_tools_in_declarations_but_no_lines_between_them() {
    let all = dpsm::Catalogue::new().with("m", "m.wesl", "const N = #{N};\nconst M = $M;").unwrap();
    let linked = all.link(&["m::N"]).unwrap();
    assert!(linked.text.contains("const N = #{N};"));
    assert_eq!(linked.notes().len(), 1);
    assert!(linked.notes()[0].to_string().starts_with("m.wesl:1: `#{N}`"));
    let inside = "fn f() {\n#ifdef N\n    g();\n#endif\n}\nfn g() {}";
    let all = dpsm::Catalogue::new().with("m", "m.wesl", inside).unwrap();
    let linked = all.link_source("my.wesl", "import super::m::{f};").unwrap();
    assert!(linked.text.contains("{\n#ifdef N\n    g();\n#endif\n}") && linked.notes().len() == 1);
    let error =
        dpsm::Catalogue::new().with("m", "m.wesl", "\n#ifdef N\nconst N = 1;\n#endif").unwrap_err();
    assert!(error.to_string().starts_with("m.wesl:2: `#ifdef N` is a line of"), "{error}");
}

#[test]
fn valid_texts_have_no_notes() {
    for text in [
        "fn f() {{ let x = 1; }}",
        "fn f() { if true {{}} }",
        "fn f() {{ /* nothing */ }}",
        "fn f(a: i32, b: i32) -> bool { return a<b; }",
        "const a = 7 % 3; // 100% {% sure %} #{x} $y\n",
        "/* #ifdef A\n#import b */ const x = 1;",
        "fn f() -> i32 { return 5 %3; }",
    ] {
        let linked = linked(text);
        assert!(linked.notes().is_empty(), "{text}: {:?}", linked.notes());
        validate(&linked).unwrap();
    }
}

#[test]
fn shaders_may_hold_the_declarations_of_dist() {
    for module in dpsm::MODULES {
        let path = format!("{}/dist/{}.wgsl", env!("CARGO_MANIFEST_DIR"), module.name);
        let text = std::fs::read_to_string(&path).unwrap();
        let own = format!("{text}\n@compute @workgroup_size(1) fn main() {{}}\n");
        for text in [&text, &own] {
            let linked = link_source(&path, text).unwrap();
            assert!(linked.text.contains(text.trim_end()) && linked.notes().is_empty());
            validate(&linked).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    // beside imports of what it does not hold
    let depth = dpsm::link(&["depth::dpsm_depth"]).unwrap().text;
    let text = format!("import dpsm::hemisphere::{{dpsm_is_front}};\n{depth}");
    match link_source("my.wesl", &text) {
        Ok(linked) => drop(validate(&linked).unwrap()),
        Err(error) => assert!(error.to_string().contains("dpsm_is_front"), "{error}"),
    }
    let mine = link_source("my.wesl", "fn dpsm_mine() {}").unwrap_err().to_string();
    assert!(mine.contains("reserved for dpsm's modules"), "{mine}");
}

#[test]
fn calls_that_need_uniform_control_flow_are_named() {
    let places = |text: &str| {
        let linked = link_source("my.wesl", text).unwrap();
        let places = validate(&linked).unwrap().unchecked(&linked);
        places.iter().map(|label| (label.line, label.column)).collect::<Vec<_>>()
    };
    let head =
        "@group(0) @binding(3) var t: texture_2d<f32>; @group(0) @binding(4) var s: sampler;\n";
    let body = |call: &str| {
        format!(
            "{HEAD}{head}fn f(p: vec3<f32>) -> f32 {{\n    if dpsm_visibility(maps, comparison, p, light, 0.001) > 0.0 {{ return {call}; }}\n    return 0.0;\n}}\n"
        )
    };
    for call in [
        "dpdx(p.x)",
        "fwidthFine(p.x)",
        "textureSample(t, s, p.xy).x",
        "textureSampleBias(t, s, p.xy, 1.0).x",
        "textureSampleCompare(maps, comparison, p.xy, 0, 0.5)",
    ] {
        assert_eq!(places(&body(call)), [(8, 74)], "{call}");
    }
    for call in [
        "textureSampleLevel(t, s, p.xy, 0.0).x",
        "textureSampleGrad(t, s, p.xy, p.xy, p.xy).x",
        "textureLoad(t, vec2(0), 0).x",
        "textureSampleCompareLevel(maps, comparison, p.xy, 0, 0.5)",
    ] {
        assert_eq!(places(&body(call)), [], "{call}");
    }
    let head = "@compute @workgroup_size(4) fn f(@builtin(local_invocation_index) i: u32) {";
    let barrier = |call: &str| {
        format!(
            "var<workgroup> w: u32;\n{head}\n    loop {{ if i > 1 {{ {call} }} else {{ break; }} }}\n}}"
        )
    };
    for call in ["workgroupBarrier();", "storageBarrier();", "let x = workgroupUniformLoad(&w);"] {
        assert_eq!(places(&barrier(call)).first().map(|place| place.0), Some(3), "{call}");
    }
    assert_eq!(places(&barrier("w = 1;")), []);
}
