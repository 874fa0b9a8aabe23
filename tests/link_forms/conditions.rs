//! WESL's conditional translation: `@if`, `@elif`, `@else`.

use dpsm::validate::ValidateError;
use dpsm::{Catalogue, Linked, validate};

use super::{HEAD, check_origins, features, with_features};

/// What is left of a text, without blanks at the ends of lines or around it.
fn left(text: &str, given: &[(&str, bool)]) -> String {
    let linked = with_features(text, given).unwrap_or_else(|error| panic!("{text}: {error}"));
    check_origins(&linked, "my.wesl", text);
    assert!(linked.notes().is_empty(), "{:?}", linked.notes());
    linked.text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn error(text: &str, given: &[(&str, bool)]) -> String {
    with_features(text, given).unwrap_err().to_string()
}

fn lines(linked: &Linked) -> Vec<(usize, &str)> {
    let lines = linked.text.lines().enumerate();
    lines.filter_map(|(at, line)| Some((linked.origin(at + 1)?.line, line))).collect()
}

#[test]
fn condition_keeps_or_removes_whatever_it_may_stand_before() {
    for (text, on, off) in [
        ("@if(A) const x = 1;", "const x = 1;", ""),
        ("@if(A) override x = 1;", "override x = 1;", ""),
        ("@if(A) alias x = f32;", "alias x = f32;", ""),
        ("@if(A) const_assert true;", "const_assert true;", ""),
        ("@if(A) var<private> x: array<f32, 4>;", "var<private> x: array<f32, 4>;", ""),
        (
            "@if(A) @compute @workgroup_size(1) fn f() {}",
            "@compute @workgroup_size(1) fn f() {}",
            "",
        ),
        (
            "@compute @if(A) @workgroup_size(1) fn f() {}",
            "@compute @workgroup_size(1) fn f() {}",
            "",
        ),
        ("@if(A) struct S { x: f32 }", "struct S { x: f32 }", ""),
        ("@if(A) enable f16;", "enable f16;", ""),
        ("@if(A) requires r; const x = 1;", "requires r; const x = 1;", "const x = 1;"),
        ("@if(A) diagnostic(off, d);", "diagnostic(off, d);", ""),
        ("@if(A,) const x = 1;", "const x = 1;", ""),
        ("@ if ( A ) const x = 1;", "const x = 1;", ""),
        ("@if /* why */ (A) const x = 1;", "const x = 1;", ""),
        (
            "struct S { @if(A) a: f32, b: f32 }",
            "struct S { a: f32, b: f32 }",
            "struct S { b: f32 }",
        ),
        (
            "struct S { b: f32, @if(A) a: f32 }",
            "struct S { b: f32, a: f32 }",
            "struct S { b: f32, }",
        ),
        (
            "struct S { @if(A) @size(16) a: array<vec2<f32>, (1<2)>, b: f32 }",
            "struct S { @size(16) a: array<vec2<f32>, (1<2)>, b: f32 }",
            "struct S { b: f32 }",
        ),
        (
            "struct S { @if(A) a: array<f32, 1<<2>, b: f32 }",
            "struct S { a: array<f32, 1<<2>, b: f32 }",
            "struct S { b: f32 }",
        ),
        ("fn f(@if(A) a: f32, b: f32) {}", "fn f( a: f32, b: f32) {}", "fn f( b: f32) {}"),
        (
            "fn f(b: f32, @if(A) @builtin(position) a: vec4<f32>) {}",
            "fn f(b: f32, @builtin(position) a: vec4<f32>) {}",
            "fn f(b: f32, ) {}",
        ),
    ] {
        assert_eq!(left(text, &[("A", true)]), on);
        assert_eq!(left(text, &[("A", false)]), off, "{text}");
    }
}

#[test]
fn condition_keeps_or_removes_any_statement() {
    for statement in [
        "let x = 1;",
        "var x: array<f32, 2>;",
        "const x = 1;",
        "x = 1;",
        "x += 1;",
        "x++;",
        "(x)--;",
        "*p = 1;",
        "_ = g();",
        "g(1, 2);",
        "return;",
        "return g(1);",
        "discard;",
        "const_assert true;",
        "{ x = 1; }",
        "if x { y = 1; }",
        "if x { } else if (y) { z(); } else { w(); }",
        "for (var i = 0; i < 4; i++) { g(); }",
        "while x { break; }",
        "loop { continue; }",
        "switch x { case 1: { } default: { } }",
        "@diagnostic(off, d) if x { }",
    ] {
        let text = format!("fn f() {{ a(); @if(A) {statement} b(); }}");
        assert_eq!(left(&text, &[("A", true)]), format!("fn f() {{ a(); {statement} b(); }}"));
        assert_eq!(left(&text, &[("A", false)]), "fn f() { a(); b(); }", "{statement}");
    }
    for inside in [
        ("loop { @if(A) break; g(); }", "loop { g(); }"),
        ("loop { g(); @if(A) continuing { h(); } }", "loop { g(); }"),
        ("loop { g(); continuing { @if(A) break if x; } }", "loop { g(); continuing { } }"),
        ("for (;;) { @if(A) continue; }", "for (;;) { }"),
        ("if x { } else { @if(A) g(); }", "if x { } else { }"),
        ("if x { } else if y { @if(A) g(); } else { }", "if x { } else if y { } else { }"),
        (
            "switch x { @if(A) case 1, 2: { g(); } case 3 { } @if(A) default: { } }",
            "switch x { case 3 { } }",
        ),
        ("switch x { default: { @if(A) { { g(); } } } }", "switch x { default: { } }"),
        ("{ { { @if(A) g(); } } }", "{ { { } } }"),
    ] {
        let (before, after) = inside;
        let text = format!("fn f() {{ {before} }}");
        assert_eq!(left(&text, &[("A", false)]), format!("fn f() {{ {after} }}"));
        let kept = before.replace("@if(A) ", "");
        assert_eq!(left(&text, &[("A", true)]), format!("fn f() {{ {kept} }}"));
    }
}

#[test]
fn else_takes_what_no_condition_before_it_took() {
    let text = "@if(A) const x = 1; @elif(B) const x = 2; @elif(C) const x = 3; @else const x = 4;";
    for (number, which) in [("111", 1), ("011", 2), ("001", 3), ("000", 4), ("100", 1), ("010", 2)]
    {
        let on: Vec<_> = number.chars().map(|c| c == '1').collect();
        let given = [("A", on[0]), ("B", on[1]), ("C", on[2])];
        assert_eq!(left(text, &given), format!("const x = {which};"), "{number}");
    }
    let statements = "fn f() { @if(A) { g(); } @else (x)++; @if(A) y = 1; @elif(!A) y = 2; h(); }";
    assert_eq!(left(statements, &[("A", true)]), "fn f() { { g(); } y = 1; h(); }");
    assert_eq!(left(statements, &[("A", false)]), "fn f() { (x)++; y = 2; h(); }");
    let members = "struct S { @if(A) a: f32, @else b: f32, c: f32 }";
    assert_eq!(left(members, &[("A", false)]), "struct S { b: f32, c: f32 }");
    // as the specification's own example
    let own = "@if(a && (!b || c)) fn f() { p(); } @elif(!a) fn f() { q(); } @else fn f() { r(); }";
    assert_eq!(left(own, &[("a", true), ("b", true), ("c", false)]), "fn f() { r(); }");
    assert_eq!(left(own, &[("a", true), ("b", false), ("c", false)]), "fn f() { p(); }");
    assert_eq!(left(own, &[("a", false), ("b", true), ("c", true)]), "fn f() { q(); }");
}

#[test]
fn expressions_have_the_values_of_logic() {
    let value = |expression: &str, a: bool, b: bool| {
        let text = format!("@if({expression}) const x = 1;");
        !left(&text, &[("A", a), ("B", b)]).is_empty()
    };
    type Truth = fn(bool, bool) -> bool;
    let all: [(&str, Truth); 12] = [
        ("A && B", |a, b| a && b),
        ("A || B", |a, b| a || b),
        ("!A && B", |a, b| !a && b),
        ("!(A && B)", |a, b| !(a && b)),
        ("!!A || false && B", |_, _| true),
        ("A || (B && true)", |a, b| a || b),
        ("(A || B) && !(A && B)", |a, b| a != b),
        ("A && B && true", |a, b| a && b),
        ("A || B || false", |a, b| a || b),
        ("((A)) && ((!B))", |a, b| a && !b),
        ("true && (A || !A) && (B || !B)", |_, _| true),
        ("false && (A && B)", |_, _| false),
    ];
    for (expression, truth) in all {
        for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
            if expression.contains("|| false &&") {
                let text = format!("@if({expression}) const x = 1;");
                assert!(error(&text, &[("A", a), ("B", b)]).contains("need parentheses"));
                continue;
            }
            assert_eq!(value(expression, a, b), truth(a, b), "{expression} {a} {b}");
        }
    }
}

#[test]
fn names_of_features_are_their_own() {
    let text = "const A = 10;\n@if(A) fn f() -> i32 { return A * 2; }";
    assert_eq!(left(text, &[("A", true)]), "const A = 10; fn f() -> i32 { return A * 2; }");
    // not even a name of dpsm's that is linked is captured by one
    let text =
        "import dpsm::depth::{dpsm_depth};\n@if(dpsm_within) fn f() { _ = dpsm_depth(1, 2, 3); }";
    assert!(
        with_features(text, &[]).is_ok() && with_features(text, &[("dpsm_within", true)]).is_ok()
    );
}

#[test]
fn missing_features_are_named_with_their_line() {
    assert_eq!(
        error("const y = 1;\n@if(A && SHADOWS) const x = 1;", &[("A", false)]),
        "my.wesl:2: the feature `SHADOWS` is not given; add `--feature SHADOWS` or \
         `--feature SHADOWS=false`"
    );
    assert_eq!(
        error("@if(SHADOWS) const x = 1;", &[("SHADOW", true)]),
        "my.wesl:1: the feature `SHADOWS` is not given; did you mean `SHADOW`?; add \
         `--feature SHADOWS` or `--feature SHADOWS=false`"
    );
    // what is removed asks for nothing
    let text = "@if(A) fn f() { @if(B) g(); }";
    assert_eq!(left(text, &[("A", false)]), "");
    assert!(error(text, &[("A", true)]).contains("`B` is not given"));
    let all = Catalogue::dpsm().unwrap().features(features(&[("A", true)]).others(false));
    assert_eq!(all.link_source("my.wesl", text).unwrap().text.trim(), "fn f() {             }");
}

#[test]
fn feature_that_nothing_asks_for_is_named() {
    let linked = with_features("@if(SHADOWS) const x = 1;", &[("SHADOWS", true), ("SHADWS", true)]);
    let notes = linked.unwrap().notes().iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(
        notes,
        ["my.wesl: no condition asks for the feature `SHADWS`; did you mean `SHADOWS`?"]
    );
}

#[test]
fn wrong_conditions_are_refused_where_they_stand() {
    let on = [("A", true), ("B", true), ("C", false)];
    for (text, line, what) in [
        ("\n@else const x = 1;", 2, "`@else` does not follow"),
        ("\n@elif(A) const x = 1;", 2, "`@elif` does not follow"),
        ("@if(A) const x = 1;\nconst y = 1;\n@else const z = 1;", 3, "`@else` does not follow"),
        ("@if(A) const x = 1; @else const x = 2;\n@else const x = 3;", 2, "does not follow"),
        ("fn f() { @if(A) g(); }\n@else fn g() {}", 2, "does not follow"),
        ("@if(A) @if(B)\nconst x = 1;", 1, "two conditions on one thing"),
        ("@if const x = 1;", 1, "lacks its condition"),
        ("@if() const x = 1;", 1, "a feature is missing"),
        ("@if(A B) const x = 1;", 1, "`B` is not expected here"),
        ("@if(A & B) const x = 1;", 1, "write `&&`"),
        ("@if(A | B) const x = 1;", 1, "write `||`"),
        ("@if(A & & B) const x = 1;", 1, "write `&&`"),
        ("@if(A &&) const x = 1;", 1, "a feature is missing"),
        ("@if(A && B || C) const x = 1;", 1, "need parentheses"),
        ("@if(1) const x = 1;", 1, "`1` is no feature"),
        ("@if(A == B) const x = 1;", 1, "`=` is not expected here"),
        ("@if(#{A}) const x = 1;", 1, "`#{A}` is no feature"),
        ("fn f() -> @if(A) f32 { return 1; }", 1, "`@if` cannot stand here"),
        ("fn f() {\n let x = @if(A) 1;\n}", 2, "`@if` cannot stand here"),
        ("fn f() @if(A) { }", 1, "`@if` cannot stand here"),
        ("fn f() { for (@if(A) var i = 0;;) { } }", 1, "`@if` cannot stand here"),
        ("fn f() { g(); @if(A) }", 1, "nothing follows `@if`"),
        ("struct S { a: f32, @if(A) }", 1, "nothing follows `@if`"),
        ("const x = 1; @if(A)", 1, "nothing follows `@if`"),
    ] {
        let error = error(text, &on);
        assert!(error.starts_with(&format!("my.wesl:{line}: ")) && error.contains(what), "{error}");
    }
    let deep = format!("@if({}A{}) const x = 1;", "(".repeat(1000), ")".repeat(1000));
    assert!(error(&deep, &on).contains("in each other"));
}

#[test]
fn lines_and_columns_stay_those_of_the_file() {
    let text = "\
// Mine.
@if(SOFT)
/// Soft.
fn shade() -> f32 { return 1.0; }

/// Sharp: größer.
@if(!SOFT)
fn sharp() -> f32 {
    @if(DEBUG) { debug(); } // slow
    /* ü */ @if(!DEBUG) return 2.0; return 3.0;
}
/// Of nothing.
@if(SOFT) const A = 1; // why
const B = bad;
";
    let linked = with_features(text, &[("SOFT", false), ("DEBUG", false)]).unwrap();
    assert_eq!(
        lines(&linked),
        [
            (1, "// Mine."),
            (5, ""),
            (6, "/// Sharp: größer."),
            (8, "fn sharp() -> f32 {"),
            (10, "    /* ü */             return 2.0; return 3.0;"),
            (11, "}"),
            (14, "const B = bad;"),
        ]
    );
    let ValidateError::Parse(report) = validate(&linked).unwrap_err() else { panic!() };
    let label = &report.labels[0];
    assert_eq!((label.file.as_str(), label.line, label.column), ("my.wesl", 14, 11));
    assert_eq!(label.source, "const B = bad;");
}

#[test]
fn conditions_of_windows_files_and_long_files_keep_their_lines() {
    let line = |at: usize| match at % 3 {
        0 => format!("@if(A) const a{at}x = 1;"),
        1 => format!("@else const b{at}x = 1;"),
        _ => format!("const c{at}x = 1;"),
    };
    let text: Vec<_> = (0..3000).map(line).collect();
    for end in ["\n", "\r\n"] {
        let text = text.join(end);
        let linked = with_features(&text, &[("A", false)]).unwrap();
        assert_eq!(check_origins(&linked, "my.wesl", &text), 2000);
        assert!(!linked.text.contains("const a") && linked.text.contains("const b2998x"));
    }
}

#[test]
fn imports_under_conditions_are_followed_or_not() {
    let choice = "@if(SOFT) import super::soft::{taps};\n@else import super::sharp::{taps};\n";
    let catalogue = Catalogue::new()
        .with("soft", "soft.wesl", "fn taps() -> i32 { return 16; }")
        .and_then(|all| all.with("sharp", "sharp.wesl", "fn taps() -> i32 { return 1; }"))
        .unwrap();
    let text = format!("{choice}fn f() -> i32 {{ return taps(); }}");
    for (on, number) in [(true, "16"), (false, "1")] {
        let all = catalogue.clone().features(features(&[("SOFT", on)]));
        let linked = all.link_source("my.wesl", &text).unwrap();
        assert!(linked.text.contains(&format!("return {number};")), "{}", linked.text);
        assert_eq!(linked.text.matches("fn taps").count(), 1);
        validate(&linked).unwrap();
    }
    // undecided, both would be there
    let error = catalogue.link_source("my.wesl", &text).unwrap_err().to_string();
    assert!(error.starts_with("my.wesl:2: ") && error.contains("give the features"), "{error}");
    let mixed = "@if(A) import super::soft::{taps};\n@else fn taps() {}";
    let error = catalogue.link_source("my.wesl", mixed).unwrap_err().to_string();
    assert!(error.starts_with("my.wesl:2: `@else` goes on from an import"), "{error}");
    let on = catalogue.features(features(&[("A", false)]));
    assert_eq!(on.link_source("my.wesl", mixed).unwrap().text.trim(), "fn taps() {}");
}

#[test]
fn modules_are_decided_like_the_shader() {
    let module = "\
/// Counts.

@if(SOFT)
const N = 16;
@else
const N = 1;

/// How many.
@if(SOFT)
fn count() -> i32 {
    return N;
}
/// How many, sharp.
@else
fn count() -> i32 {
    @if(TWICE)
    return 2 * N;
    @else
    return N;
}
";
    let all = Catalogue::new().with("count", "count.wesl", module).unwrap();
    let user = "import super::count::{count};\n";
    let on = all.clone().features(features(&[("SOFT", false), ("TWICE", true)]));
    let linked = on.link_source("my.wesl", user).unwrap();
    assert_eq!(
        linked.text.trim(),
        "// dpsm::count\n\nconst N = 1;\n\n/// How many, sharp.\nfn count() -> i32 {\n    return 2 * N;\n}"
    );
    assert_eq!(check_origins(&linked, "count.wesl", module), 5);
    validate(&linked).unwrap();
    // features may change after a module was added, and the module's own text stays
    let linked = on.features(features(&[("SOFT", true)])).link(&["count::count"]).unwrap();
    assert!(linked.text.contains("const N = 16;") && linked.text.contains("/// How many.\n"));
    let error = all.features(features(&[("TWICE", true)])).link(&["count"]).unwrap_err();
    assert!(error.to_string().starts_with("count.wesl:3: the feature `SOFT`"), "{error}");
}

#[test]
fn undecided_conditions_are_passed_on_whole() {
    let text = format!(
        "{HEAD}@if(SHADOWS)\n@fragment\nfn lit(@location(0) p: vec3<f32>) -> @location(0) vec4<f32> {{\n    \
         @if(A) {{ return vec4f(0.0); }}\n    return vec4<f32>(dpsm_visibility(maps, comparison, p, light, \
         0.001));\n}}\n@else\nfn lit() {{}}\n"
    );
    let linked = dpsm::link_source("my.wesl", &text).unwrap();
    let own = text.split_once("{dpsm_visibility};\n").unwrap().1;
    assert!(linked.text.ends_with(own), "{}", linked.text);
    let note = linked.notes()[0].to_string();
    assert!(note.starts_with("my.wesl:6: `@if(SHADOWS)` is WESL's"), "{note}");
    assert!(
        note.contains("--feature SHADOWS=false") && note.contains("(2 more of its kind)"),
        "{note}"
    );
    let error = validate(&linked).unwrap_err();
    assert!(error.to_string().starts_with("my.wesl:6: no WGSL yet: `@if(SHADOWS)`"), "{error}");
    // decided, it is what the specification says
    let linked = with_features(&text, &[("SHADOWS", true), ("A", false)]).unwrap();
    assert!(validate(&linked).unwrap().module.entry_points.len() == 1 && linked.notes().is_empty());
    let linked = with_features(&text, &[("SHADOWS", false)]).unwrap();
    assert!(validate(&linked).unwrap().module.entry_points.is_empty());
}

#[test]
fn alternatives_of_a_module_stay_together_while_undecided() {
    let module = "\
@if(A) const N = 16;
@elif(B) const M = 2;
@else const N = 1;
const Z = 0;
fn f() -> i32 { return N; }
@if(A) enable f16_like;
";
    let all = Catalogue::new()
        .with("m", "m.wesl", module.split_once("@if(A) enable").unwrap().0)
        .unwrap();
    let linked = all.link_source("my.wesl", "import super::m::{f};").unwrap();
    for line in ["@if(A) const N = 16;", "@elif(B) const M = 2;", "@else const N = 1;"] {
        assert!(linked.text.contains(line), "{}", linked.text);
    }
    assert!(!linked.text.contains("const Z"));
    assert_eq!(linked.notes()[0].place.to_string(), "m.wesl:1");
    // directives move to the top in their order
    let user = "@if(A) enable f16;\n@else enable other;\nconst x = 1;";
    let linked = all.link_source("my.wesl", user).unwrap();
    assert!(
        linked.text.starts_with("@if(A) enable f16;\n@else enable other;\n"),
        "{}",
        linked.text
    );
}

#[test]
fn declarations_that_both_stay_are_declared_twice() {
    let text = "@if(A) const x = 1;\n@if(B) const x = 2;";
    assert!(dpsm::link_source("my.wesl", text).is_ok());
    let both = error(text, &[("A", true), ("B", true)]);
    assert_eq!(both, "my.wesl:2: `x` is declared twice, first at my.wesl:1");
    assert_eq!(left(text, &[("A", true), ("B", false)]), "const x = 1;");
}

#[test]
fn any_start_of_any_text_is_an_answer_and_never_a_panic() {
    let deep = 100_000;
    let seeds = ["features", "foreign", "mine", "declarations", "shader"].map(|name| {
        let path = format!("{}/fuzz/seeds/link/{name}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).unwrap()
    });
    let mut texts = seeds.to_vec();
    texts.push("@if(A)".repeat(deep));
    texts.push(format!("@if({}A) const x = 1;", "!".repeat(deep)));
    texts.push(format!("fn f() {{ {} }}", "@if(A) {".repeat(deep)));
    texts.push(format!("fn f() {{ {} {} }}", "@if(A) {".repeat(deep), "}".repeat(deep)));
    texts.push(format!("fn f() {{ {} x(); {} }}", "@if(A) if y {".repeat(deep), "}".repeat(deep)));
    texts.push("@if(A) const x = 1; @else const x = 2;\n".repeat(deep));
    texts.push("#{".repeat(deep));
    texts.push("{{ x }}".repeat(deep));
    texts.push("{%".repeat(deep));
    texts.push("<%".repeat(deep));
    texts.push("$".repeat(deep));
    texts.push("#\n".repeat(deep));
    texts.push("#import {\n".repeat(deep));
    texts.push("a\n".repeat(deep));
    texts.push(format!("fn f() {{ {} }}", "a::b ".repeat(deep)));
    texts.push(format!("#x\nfn f() {{ {} }}", "a::b ".repeat(deep)));
    let all = Catalogue::dpsm().unwrap();
    let mut answers = 0;
    for text in &texts {
        let step = if text.len() < 2000 { 1 } else { text.len() };
        for cut in (0..text.len()).step_by(step).chain([text.len()]) {
            let Some(part) = text.get(..cut) else { continue };
            for given in [&[][..], &[("A", true), ("B", false), ("C", true)], &[("A", false)]] {
                let all = all.clone().features(features(given));
                if let Ok(linked) = all.link_source("my.wesl", part) {
                    check_origins(&linked, "my.wesl", part);
                    answers += 1;
                }
            }
        }
    }
    assert!(answers > 500, "{answers}");
}
