//! What was chosen, why, and what each choice does to the error.

use serde::{Deserialize, Serialize};

use super::axis::Axis;
use super::casters::Reason;
use super::choose::{Candidate, Case, reach};
use super::{LeftOut, Plan, Request, VERSION};
use crate::render::Format;

/// One choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// What is chosen.
    pub what: String,
    /// What it is.
    pub value: String,
    /// Why, and what was left out.
    pub why: String,
    /// The largest error that it makes, in the target's unit, as predicted; `None` where it makes
    /// none.
    pub error: Option<f64>,
}

/// A format's name, as on the command line.
fn name(format: Format) -> &'static str {
    match format {
        Format::D16 => "d16",
        Format::D24 => "d24",
        Format::D32 => "d32",
    }
}

/// The plan of the best candidate, and a line for each choice.
pub fn explained(
    request: &Request<'_>,
    case: &Case<'_>,
    axes: &[Axis],
    candidates: &[Candidate],
    best: &Candidate,
    left_out: &[Option<Reason>],
) -> Plan {
    let axis = &axes[best.axis];
    let left_out_meshes = left_out.iter().zip(&request.scene.meshes).enumerate();
    let left_out_meshes =
        left_out_meshes.filter(|(_, (reason, _))| reason.is_some()).map(|(mesh, (reason, of))| {
            let no_cast = *reason == Some(Reason::Switched);
            LeftOut { mesh, name: of.name.clone(), no_cast }
        });
    let error = |share: f64| request.error.value() * share;
    let mut plan = Plan {
        version: VERSION,
        scene: request.scene.name.clone(),
        meshes: request.scene.meshes.len(),
        triangles: request.scene.triangle_count(),
        lights: request
            .lights
            .iter()
            .map(|light| request.scene.in_file(*light).to_array())
            .collect(),
        error: request.error,
        axis: axis.axis.as_vec3().to_array(),
        hemispheres: axis.maps,
        size: best.size,
        format: name(best.format).into(),
        method: "exact".into(),
        filter: "single".into(),
        near: case.spheres[0],
        far: case.spheres[1],
        left_out: left_out_meshes.collect(),
        meets: best.share <= 1.0,
        predicted: request.error.with(error(best.share)),
        milliseconds: [best.generation, best.lookup],
        bytes: best.bytes,
        choices: Vec::new(),
    };
    let line = |what: &str, value: String, why: String, error: Option<f64>| Choice {
        what: what.into(),
        value,
        why,
        error,
    };
    let edge_size = case.edge_size(axis);
    let edges = edge_size / f64::from(best.size);
    plan.choices = vec![
        hemispheres(request, axes, candidates, best),
        seam(axes, candidates, best),
        line("near and far", format!("{} and {}", plan.near, plan.far), spheres(left_out), None),
        casters(request, left_out),
        line(
            "size",
            format!("{} x {}", best.size, best.size),
            format!(
                "a lookup is off by {:.3} to {:.3} texel, the more the more grazing the light; the \
                 shadow edges that show ask for {edge_size:.0}",
                reach(1.0),
                reach(0.0)
            ),
            Some(error(edges)),
        ),
        format_line(case, candidates, best),
        line(
            "method",
            "exact".into(),
            "for every mesh that is kept: refined maps forgive gaps thinner than their tolerance of \
             distances"
                .into(),
            None,
        ),
        line(
            "filter and bias",
            "single, plane".into(),
            "2 x 2 texels, each lit, in shadow or left out against the receiver's plane: no bias to \
             tune"
                .into(),
            None,
        ),
        line(
            "whole",
            request.error.with(error(best.share)).short(),
            match plan.meets {
                true => format!("within {}", request.error),
                false => format!(
                    "{} is not met: raise --budget or --error; what it asks for is above",
                    request.error
                ),
            },
            Some(error(best.share)),
        ),
    ];
    plan
}

/// The cheapest candidate that meets the target among some.
fn cheapest(candidates: &[Candidate], wanted: impl Fn(&Candidate) -> bool) -> Option<&Candidate> {
    let fits = candidates.iter().filter(|c| c.share <= 1.0 && wanted(c));
    fits.min_by(|a, b| a.order(b))
}

/// What something would cost in place of the choice.
fn instead(best: &Candidate, other: Option<&Candidate>) -> String {
    match other {
        Some(other) => format!("{:.0}% of the cost", 100.0 * other.cost() / best.cost()),
        None => "out of reach of the target".into(),
    }
}

fn hemispheres(
    request: &Request<'_>,
    axes: &[Axis],
    candidates: &[Candidate],
    best: &Candidate,
) -> Choice {
    let maps = axes[best.axis].maps;
    let other = cheapest(candidates, |c| axes[c.axis].maps != maps);
    let one_holds_all = axes.iter().any(|axis| axis.maps == 1);
    let why = match (request.axis, maps) {
        (Some(_), _) => "a hemispherical light: the other half is dark".to_string(),
        (None, 1) => format!(
            "back hemisphere left out: no receiver that shows is in it; two maps would be {}",
            instead(best, other)
        ),
        (None, _) if one_holds_all => {
            format!("one map could hold all that shows, at {}", instead(best, other))
        }
        (None, _) => "no hemisphere holds all that shows".to_string(),
    };
    Choice { what: "hemispheres".into(), value: maps.to_string(), why, error: None }
}

fn seam(axes: &[Axis], candidates: &[Candidate], best: &Candidate) -> Choice {
    let axis = &axes[best.axis];
    let down = axes.iter().position(|other| other.name == "down" && other.maps == axis.maps);
    let of_down = down.and_then(|down| cheapest(candidates, |c| c.axis == down));
    let straddling = down.map_or(axis.straddling, |down| axes[down].straddling);
    let mut why = format!("{}, of {} tried", axis.name, axes.len());
    if down != Some(best.axis) && down.is_some() {
        why += &format!(
            "; looking down would be {} and cut {straddling} triangles in place of {}",
            instead(best, of_down),
            axis.straddling
        );
    } else {
        why += &format!("; the seam cuts {} triangles", axis.straddling);
    }
    Choice { what: "axis".into(), value: format!("{:.4}", axis.axis), why, error: None }
}

fn spheres(left_out: &[Option<Reason>]) -> String {
    match left_out.iter().all(Option::is_some) {
        true => "no caster is left; far lies behind the farthest receiver that may show".into(),
        false => "in front of the nearest caster that is kept, and behind the farthest receiver \
                  that may show"
            .into(),
    }
}

fn casters(request: &Request<'_>, left_out: &[Option<Reason>]) -> Choice {
    let named = |wanted: Reason| {
        let meshes = request.scene.meshes.iter().zip(left_out);
        let names = meshes.filter(|(_, reason)| **reason == Some(wanted));
        names.map(|(mesh, _)| mesh.name.clone()).collect::<Vec<_>>()
    };
    let mut why = Vec::new();
    for (reason, because) in [
        (Reason::Bounds, "nothing that shows lies behind"),
        (Reason::Beyond, "farther than all that shows:"),
        (Reason::Switched, "to cast no shadow:"),
    ] {
        let names = named(reason);
        if !names.is_empty() {
            why.push(format!("{because} {}", names.join(", ")));
        }
    }
    let count = left_out.iter().flatten().count();
    Choice {
        what: "meshes".into(),
        value: format!("{count} of {} left out", left_out.len()),
        why: match why.is_empty() {
            true => "each may shadow something that shows".into(),
            false => why.join("; "),
        },
        error: None,
    }
}

fn format_line(case: &Case<'_>, candidates: &[Candidate], best: &Candidate) -> Choice {
    let thinnest = case.samples.iter().map(|sample| sample.gap[0]).fold(f64::INFINITY, f64::min);
    let step = f64::from(best.format.quantum()) * f64::from(case.spheres[1] - case.spheres[0]);
    let mut why = match thinnest.is_finite() {
        true => format!("a step is {step:.1e}, the thinnest gap that must hold {thinnest:.1e}"),
        false => "no gap must hold".into(),
    };
    if !case.is_fine(best.size, Format::D16) {
        let step = f64::from(Format::D16.quantum()) * f64::from(case.spheres[1] - case.spheres[0]);
        why += &format!("; a step of d16 is {step:.1e}, wider than a texel at the nearest caster");
    } else if best.format == Format::D32 {
        let d16 = cheapest(candidates, |c| c.format == Format::D16);
        why += &format!("; d16 would be {}", instead(best, d16));
    }
    why += "; d24 takes the memory of d32";
    Choice { what: "format".into(), value: name(best.format).into(), why, error: None }
}

impl Plan {
    /// The choices as text, a line each, and what the whole costs.
    pub fn explanation(&self) -> String {
        use std::fmt::Write;
        let mut text = String::new();
        let _ = writeln!(text, "{}: shadow edges within {}", self.scene, self.error);
        for Choice { what, value, why, error } in &self.choices {
            let error = error.map_or("-".into(), |error| self.error.with(error).short());
            let _ = writeln!(text, "  {what:<16}{value:<28}{error:>12}  {why}");
        }
        let [generation, lookup] = self.milliseconds;
        let mib = self.bytes as f64 / f64::from(1 << 20);
        let _ = writeln!(
            text,
            "  predicted: {mib:.2} MiB, {generation:.1} ms to make the maps, {lookup:.1} ms to read \
             them, on llvmpipe with two cores"
        );
        text
    }
}
