//! Pictures of a scene: lit, its maps, what the light sees, and where shadows are wrong.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rayon::prelude::*;

use super::data::Image;
use super::gather::{Job, ReportError, Subject};
use super::html::percent;
use super::variants::{self, method_name};
use crate::measure::{
    Bench, PictureError, Point, Surroundings, WRONG_HARD, picture_error, surroundings,
};
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
    let size = pictured(Method::Refined).size;
    let frame = subject.frame(&Settings { views: true, ..pictured(Method::Refined) })?;
    let Rendering { lit, maps: stored, views, .. } = render(job, &frame)?;
    let caption = format!(
        "The scene lit by the default method, refined, with maps of {size} x {size} texels. Shadows \
         should begin where casters touch the ground, with straight edges where casters have them."
    );
    gallery.add("lit", "Lit, refined method", caption, &lit)?;
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
    for method in [Method::Refined, Method::Vertex, Method::Cube] {
        let Some(maps) = maps(method) else { continue };
        let frame = subject.frame(&pictured(method))?;
        let bench = Bench::new(&frame, &maps, truth);
        let (picture, [acne, leak, edge], lie) = errors(&bench, seen, &lit);
        let name = method_name(method);
        let side = maps.size;
        let caption = format!(
            "Every pixel's shadow by the {name} method (maps of {side} x {side}) against ray \
             casting. Light grey: rightly lit; dark grey: rightly in shadow; black: no surface. \
             Orange: acne, in shadow where the surface is smoothly lit, {acne} pixels; blue: \
             leaks, lit deep in shadow, {leak} pixels; yellow: wrong where an outline passes \
             through what the lookup reads, {edge} pixels. {} of all are wrong; the largest patch of \
             them has {} pixels, and {} stand alone as dots.",
            percent(lie.wrong_share()),
            lie.largest_patch,
            lie.dots,
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

/// A pixel's verdict.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Nothing,
    Lit,
    Dark,
    /// Smoothly lit and in shadow by the map.
    Acne,
    /// Deep in shadow and lit by the map.
    Leak,
    /// Wrong where an outline passes through what is read.
    Edge,
}

impl Verdict {
    /// Vermilion, blue and yellow of Okabe and Ito's palette, which colour-blind people can tell apart.
    fn colour(self) -> [u8; 4] {
        let [r, g, b] = match self {
            Self::Nothing => [0, 0, 0],
            Self::Lit => [228, 228, 228],
            Self::Dark => [95, 95, 95],
            Self::Acne => [213, 94, 0],
            Self::Leak => [0, 114, 178],
            Self::Edge => [240, 228, 66],
        };
        [r, g, b, 255]
    }
}

/// A picture of each pixel against `lit`, what ray casting says of it; the pixels of acne, leaks and
/// edges; and how they lie.
fn errors(
    bench: &Bench<'_>,
    seen: &[Option<Point>],
    lit: &[bool],
) -> (Picture, [usize; 3], PictureError) {
    let judge = |(point, lit): (&Option<Point>, &bool)| {
        let Some(point) = point else { return (Verdict::Nothing, None) };
        let at = bench.projection.lookup(bench.to_light(point.world).narrow(), bench.frame.light);
        // behind a hemispherical light all is dark by definition
        let lit = *lit && at.mapped;
        let visibility = f64::from(bench.visibility(point));
        let verdict = match (visibility >= 0.5, lit) {
            (true, true) => Verdict::Lit,
            (false, false) => Verdict::Dark,
            _ => match surroundings(bench, point, lit) {
                Surroundings::SmoothlyLit => Verdict::Acne,
                Surroundings::DeepInShadow => Verdict::Leak,
                Surroundings::Mixed => Verdict::Edge,
            },
        };
        (verdict, Some(visibility - f64::from(u8::from(lit))))
    };
    let (verdicts, off): (Vec<Verdict>, Vec<Option<f64>>) =
        seen.par_iter().zip(lit).map(judge).unzip();
    let count = |wanted: Verdict| verdicts.iter().filter(|found| **found == wanted).count();
    let counts = [Verdict::Acne, Verdict::Leak, Verdict::Edge].map(count);
    let [width, height] = bench.frame.settings.image;
    let pixels = verdicts.iter().map(|verdict| verdict.colour()).collect();
    (Picture { width, height, pixels }, counts, picture_error(&off, width, WRONG_HARD))
}
