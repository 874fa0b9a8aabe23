//! The report's page: every figure is there, in the text and in a browser; docs/report.md.

#![cfg(feature = "cli")]

#[path = "report/browser.rs"]
mod browser;
#[path = "report/fixture.rs"]
mod fixture;

use std::collections::BTreeSet;

use dpsm::report::data::{Report, Role};
use dpsm::report::page::{figures, page};
use fixture::{HARD_NAME, images, report};

/// Elements that have no end tag.
const VOID: [&str; 4] = ["meta", "link", "img", "br"];

#[test]
fn every_figure_is_there_once() {
    let (report, images) = (report(), images());
    let (page, ids) = (page(&report, &images), figures(&report, &images));
    let wanted = [
        "fig-brabec-room-lit",
        "fig-brabec-room-maps",
        "fig-brabec-room-plot-generation",
        "fig-brabec-room-plot-lookup",
        "fig-brabec-room-plot-memory",
        "fig-brabec-room-variants",
        "fig-brabec-room-sources",
        "fig-a-b-room-b-light-lit",
        "fig-a-b-room-b-light-lit-2",
        "fig-no-error-plot-memory",
        "fig-no-error-2-plot-memory",
        "fig-parameterisations",
        "fig-cost-making-the-maps-against-triangles",
        "fig-cost-making-the-maps-against-triangles-2",
    ];
    for id in wanted {
        assert!(ids.iter().any(|other| other == id), "{id} is none of {ids:?}");
    }
    assert_eq!(ids.len(), 5 + 4 * 5 + 1 + 2);
    let mut seen = BTreeSet::new();
    for (at, _) in page.match_indices(" id=\"") {
        let id = page[at + 5..].split('"').next().unwrap();
        assert!(seen.insert(id), "{id} is there twice");
    }
    for id in &ids {
        assert!(seen.contains(id.as_str()), "{id} is not there");
    }
    for (at, _) in page.match_indices("href=\"#") {
        let id = page[at + 7..].split('"').next().unwrap();
        assert!(seen.contains(id), "a link goes to {id}, which is not there");
    }
}

#[test]
fn page_is_well_formed_and_fetches_nothing() {
    for report in [report(), Report::default()] {
        let page = page(&report, &images());
        let mut open = Vec::new();
        for part in page.split('<').skip(2) {
            let (tag, _) = part.split_once('>').unwrap_or_else(|| panic!("`<{part}` has no end"));
            assert!(tag.matches('"').count() % 2 == 0, "<{tag}>");
            let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap();
            if tag.starts_with('/') {
                assert_eq!(open.pop(), Some(name), "</{name}>");
            } else if !tag.ends_with('/') && !VOID.contains(&name) {
                open.push(name);
            }
            for source in ["src=\"", "href=\""].iter().filter_map(|what| tag.split_once(what)) {
                assert!(source.1.starts_with("data:") || source.1.starts_with('#'), "<{tag}>");
            }
        }
        assert_eq!(open, [""; 0], "left open");
        assert!(!page.contains("<script") && !page.contains("url(") && !page.contains("@import"));
    }
}

#[test]
fn texts_are_escaped_and_numbers_are_numbers() {
    let (report, images) = (report(), images());
    let page = page(&report, &images);
    assert!(!page.contains(HARD_NAME) && !page.contains("<taps>") && !page.contains("<with>"));
    assert!(page.contains("a &lt;b&gt;&quot;room&quot;&lt;/b&gt; &amp; &#39;light&#39;"));
    let text: String =
        page.split('<').filter_map(|part| part.split_once('>')).map(|p| p.1).collect();
    for no_number in ["NaN", "inf ", "inf<", "None", "Some("] {
        assert!(!text.contains(no_number), "{no_number}");
    }
    let empty = dpsm::report::page::page(&Report::default(), &[]);
    assert!(!empty.contains("NaN") && empty.contains("unknown"));
}

#[test]
fn page_warns_of_software_and_of_what_is_unfinished() {
    let mut report = report();
    let warned = page(&report, &[]);
    // above all, beside each scene's times, and beside the costs
    assert_eq!(
        warned.matches("class=\"warning\">Times of a software adapter").count(),
        2 + report.scenes.len()
    );
    assert!(
        warned.contains("id=\"unfinished\"") && warned.contains("costs: lights &amp; &lt;taps&gt;")
    );
    report.machine.software = false;
    report.unfinished.clear();
    let quiet = page(&report, &[]);
    assert!(!quiet.contains("class=\"warning\"") && !quiet.contains("unfinished"));
}

#[test]
fn dominated_variants_stay_in_the_table_and_name_who_beats_them() {
    let report = report();
    let page = page(&report, &[]);
    let scene = &report.scenes[0];
    let beaten: Vec<_> = scene.variants.iter().filter(|v| !v.dominated_by.is_empty()).collect();
    assert!(!beaten.is_empty() && beaten.len() < scene.variants.len());
    for variant in beaten {
        let row =
            page.split("<tr ").find(|row| row.contains(&format!("\"row\">{}<", variant.name)));
        let row = row.unwrap();
        assert!(row.starts_with("class=\"beaten\""), "{row}");
        assert!(row.contains(&format!("<small>beaten by {}</small>", variant.dominated_by)));
    }
    assert!(scene.variants.iter().any(|v| v.role == Role::Plan) && page.contains(" ★</th>"));
    assert!(page.contains("do not win on texels"));
}

#[test]
fn plots_have_a_mark_for_every_variant_and_a_title() {
    let (report, images) = (report(), images());
    let page = page(&report, &images);
    let scene = &report.scenes[0];
    let figure = |id: &str| {
        let from = page.find(&format!("id=\"{id}\"")).unwrap();
        page[from..].split("</figure>").next().unwrap()
    };
    for cost in ["generation", "lookup", "memory"] {
        let plot = figure(&format!("fig-brabec-room-plot-{cost}"));
        let of = |role: Role| scene.variants.iter().filter(|v| v.role == role).count();
        assert_eq!(plot.matches("<circle").count(), of(Role::Other), "{cost}");
        assert_eq!(plot.matches("<polygon").count(), of(Role::Plan), "{cost}");
        assert_eq!(plot.matches("<rect").count(), of(Role::Cube), "{cost}");
        assert!(
            plot.contains("role=\"img\"") && plot.contains("<title>") && plot.contains("<desc>")
        );
        assert!(!plot.contains("#000000") && !plot.contains("#FFFFFF"), "fixed ink in the dark");
    }
    // zero has a place of its own where a variant has no error
    let zero = |id: &str| figure(id).matches("\n0\n</text>").count();
    assert_eq!(zero("fig-no-error-plot-memory"), 1);
    assert_eq!(zero("fig-brabec-room-plot-memory"), 0);
}

#[test]
fn browser_shows_every_figure_without_a_message() {
    let (report, images) = (report(), images());
    let ids = figures(&report, &images);
    // to look at
    let file = concat!(env!("CARGO_TARGET_TMPDIR"), "/report.html");
    std::fs::write(file, page(&report, &images)).unwrap();
    for width in [360, 1200] {
        let Some(seen) = browser::open(&page(&report, &images), &ids, width) else { return };
        assert_eq!(seen.messages, [""; 0], "console at {width}");
        assert_eq!(seen.width, f64::from(width), "the window's width");
        assert!(seen.scroll <= seen.width, "the page is {} wide at {width}", seen.scroll);
        assert_eq!(seen.boxes.len(), ids.len());
        for (id, [wide, high]) in ids.iter().zip(&seen.boxes) {
            assert!(*wide >= 100.0 && *high >= 30.0, "{id} is {wide} x {high} at {width}");
            assert!(*wide <= seen.width, "{id} is {wide} wide at {width}");
        }
    }
}

#[test]
fn browser_test_would_see_a_script_error_and_a_missing_figure() {
    let page = page(&report(), &[]).replace("</main>", "</main><script>nothing.at.all()</script>");
    let Some(seen) = browser::open(&page, &["no-such-figure".to_string()], 360) else { return };
    assert!(seen.messages.iter().any(|message| message.contains("nothing")), "{:?}", seen.messages);
    assert_eq!(seen.boxes, [[0.0, 0.0]]);
}
