//! Pictures of a scene: lit, its maps, what the light sees, and where shadows are wrong.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rayon::prelude::*;

use super::data::Image;
use super::gather::{Job, ReportError, Subject};
use super::variants::{self, method_name};
use crate::measure::{Bench, Point, edge_point};
use crate::render::{Method, Picture, Rendering, Settings};
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::truth::Truth;
use crate::{cpu, gpu};

/// Pictures are taken with maps of half the largest size: errors can be seen, files stay small.
///
/// `maps` gives a method's maps of that size where they were made; `seen` is what the camera sees
/// through each pixel.
pub fn pictures(
    job: &Job<'_>,
    subject: &Subject,
    truth: &Truth,
    seen: &[Option<Point>],
    maps: impl Fn(Method) -> Option<DepthMaps>,
) -> Result<Vec<Image>, ReportError> {
    let pictured = |method| variants::pictured(job.effort, method);
    let mut gallery = Gallery { scene: &subject.name, images: Vec::new() };
    let size = pictured(Method::Hybrid).size;
    let frame = subject.frame(&Settings { views: true, ..pictured(Method::Hybrid) })?;
    let Rendering { lit, maps: stored, views, .. } = render(job, &frame)?;
    let caption = format!(
        "The scene lit by the default method, hybrid, with maps of {size} x {size} texels. Shadows \
         should begin where casters touch the ground, with straight edges where casters have them."
    );
    gallery.add("lit", "Lit, hybrid method", caption, &lit)?;
    let by_vertex = subject.frame(&pictured(Method::Vertex))?;
    let caption = format!(
        "The same by the method of Brabec 2002, which projects vertices and draws straight edges \
         between them, maps of {size} x {size}. Where triangles are large, look for shadows that \
         are bent, shifted or missing, and for surfaces that shadow themselves."
    );
    gallery.add("lit-vertex", "Lit, vertex method", caption, &render(job, &by_vertex)?.lit)?;
    let names = frame.settings.method.projection().names();
    for ((layer, name), view) in (0..).zip(names).zip(&views) {
        let caption = format!(
            "What the light sees of the {name} hemisphere: a disk whose middle is the light's axis \
             and whose rim is 90 degrees off it. Straight edges become arcs of circles; a texel at \
             the rim spans half the angle of one in the middle. What lies outside the disk belongs \
             to the other map, or to the guard band that filters read."
        );
        gallery.add(&format!("{name}-view"), &format!("{name} hemisphere"), caption, view)?;
        let Some(stored) = &stored else { continue };
        let caption = format!(
            "The {name} map as it is stored: the distance to the nearest surface by direction, \
             black at the near sphere and white at the far one or where there is nothing. A point \
             is in shadow where its own distance is larger."
        );
        let grey = frame.grey(stored, layer);
        gallery.add(&format!("{name}-map"), &format!("{name} map"), caption, &grey)?;
    }
    let empty = DepthMaps::empty(1, 1, Sampling::Nearest);
    let bench = Bench::new(&frame, &empty, truth);
    let lit: Vec<bool> =
        seen.par_iter().map(|point| point.is_some_and(|point| bench.sees(&point))).collect();
    for method in [Method::Hybrid, Method::Vertex, Method::Cube] {
        let Some(maps) = maps(method) else { continue };
        let frame = subject.frame(&pictured(method))?;
        let bench = Bench::new(&frame, &maps, truth);
        let (picture, counts) = errors(&bench, seen, &lit);
        let name = method_name(method);
        let side = maps.size;
        let caption = format!(
            "Every pixel's shadow by the {name} method (maps of {side} x {side}) against ray \
             casting. Light grey: rightly lit; dark grey: rightly in shadow; black: no surface. \
             Orange: falsely in shadow, {} pixels; blue: falsely lit, {} pixels. Pale where the \
             true shadow edge runs through the texel, so that its size explains the error ({} \
             pixels); saturated where it does not, a fault of the method ({} pixels).",
            counts.shadow,
            counts.light,
            counts.edges,
            counts.shadow + counts.light - counts.edges,
        );
        let title = format!("Errors, {name} method");
        gallery.add(&format!("{name}-errors"), &title, caption, &picture)?;
    }
    Ok(gallery.images)
}

/// The images so far.
struct Gallery<'a> {
    scene: &'a str,
    images: Vec<Image>,
}

impl Gallery<'_> {
    fn add(
        &mut self,
        kind: &str,
        title: &str,
        caption: String,
        picture: &Picture,
    ) -> Result<(), ReportError> {
        self.images.push(Image {
            scene: self.scene.into(),
            kind: kind.into(),
            title: title.into(),
            caption,
            size: [picture.width, picture.height],
            png: STANDARD.encode(picture.png()?),
        });
        Ok(())
    }
}

fn render(job: &Job<'_>, frame: &crate::render::Frame) -> Result<Rendering, ReportError> {
    Ok(match job.device {
        Some(device) => gpu::render(device, frame)?,
        None => cpu::render(frame)?,
    })
}

/// Misclassified pixels.
struct Counts {
    shadow: usize,
    light: usize,
    /// Of both: those at true shadow edges.
    edges: usize,
}

/// A pixel's verdict.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Nothing,
    Lit,
    Dark,
    FalseShadow { edge: bool },
    FalseLight { edge: bool },
}

impl Verdict {
    /// Vermilion and blue of Okabe and Ito's palette, which colour-blind people can tell apart;
    /// the same mixed with white.
    fn colour(self) -> [u8; 4] {
        let [r, g, b] = match self {
            Self::Nothing => [0, 0, 0],
            Self::Lit => [228, 228, 228],
            Self::Dark => [95, 95, 95],
            Self::FalseShadow { edge: false } => [213, 94, 0],
            Self::FalseShadow { edge: true } => [240, 170, 110],
            Self::FalseLight { edge: false } => [0, 114, 178],
            Self::FalseLight { edge: true } => [120, 185, 228],
        };
        [r, g, b, 255]
    }
}

/// Each pixel against `lit`, what ray casting says of it.
fn errors(bench: &Bench<'_>, seen: &[Option<Point>], lit: &[bool]) -> (Picture, Counts) {
    let judge = |(point, lit): (&Option<Point>, &bool)| {
        let Some(point) = point else { return Verdict::Nothing };
        let at = bench.projection.lookup(bench.to_light(point.world).narrow(), bench.frame.light);
        // behind a hemispherical light all is dark by definition
        let lit = *lit && at.mapped;
        match (bench.visibility(point) >= 0.5, lit) {
            (true, true) => Verdict::Lit,
            (false, false) => Verdict::Dark,
            (false, true) => Verdict::FalseShadow { edge: edge_point(bench, point) },
            (true, false) => Verdict::FalseLight { edge: edge_point(bench, point) },
        }
    };
    let verdicts: Vec<Verdict> = seen.par_iter().zip(lit).map(judge).collect();
    let count = |wanted: &[Verdict]| verdicts.iter().filter(|v| wanted.contains(v)).count();
    let [shadow, light] = [
        [Verdict::FalseShadow { edge: false }, Verdict::FalseShadow { edge: true }],
        [Verdict::FalseLight { edge: false }, Verdict::FalseLight { edge: true }],
    ];
    let counts = Counts {
        shadow: count(&shadow),
        light: count(&light),
        edges: count(&[shadow[1], light[1]]),
    };
    let [width, height] = bench.frame.settings.image;
    let pixels = verdicts.iter().map(|verdict| verdict.colour()).collect();
    (Picture { width, height, pixels }, counts)
}
