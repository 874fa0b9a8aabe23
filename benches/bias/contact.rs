//! Contact gap and acne of the biases, beside a constant tuned by hand and what two engines do.

use dpsm::gpu::{Device, GpuError, make_maps};
use dpsm::measure::{Bench, Judgement, Point, judge, truth_of};
use dpsm::render::{Bias, Frame, Settings};
use dpsm::scalar::float::Vec3;
use dpsm::scalar::light::DpsmLight;
use dpsm::scalar::maps::{DepthMaps, Maps};
use dpsm::scalar::visibility::dpsm_lookup;

use super::faults::places;

/// Points of each scene, spread over all surfaces.
const POINTS: usize = 40_000;

/// Map size.
const SIZE: u32 = 1024;

/// The constants tried by hand: the default's, halved and doubled.
const TRIES: [f32; 9] = [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0];

/// What one bias does to a scene's points.
#[derive(Default)]
struct Sum {
    faults_shadow: usize,
    faults_light: usize,
    false_shadow: usize,
    false_light: usize,
    gap: f64,
}

/// The judged points of one scene.
struct Judged<'a> {
    frame: &'a Frame,
    maps: &'a DepthMaps,
    points: Vec<(Vec3<f32>, Vec3<f32>, Judgement)>,
}

impl Judged<'_> {
    fn sum(&self, visibility: impl Fn(Vec3<f32>, Vec3<f32>) -> f32) -> Sum {
        let mut sum = Sum::default();
        for (p, normal, j) in &self.points {
            let lit = visibility(*p, *normal) >= 0.5;
            if lit == j.lit {
                continue;
            }
            if j.lit {
                sum.false_shadow += 1;
                sum.faults_shadow += usize::from(!j.edge);
                continue;
            }
            sum.false_light += 1;
            sum.faults_light += usize::from(!j.edge);
            // the texel holds the occluder, not the receiver that lies behind it
            let by_bias = (j.stored - (j.own - j.gap)).abs() < j.own - j.stored;
            if !j.edge && by_bias && j.gap.is_finite() {
                sum.gap = sum.gap.max(j.gap);
            }
        }
        sum
    }

    fn of_frame(&self, bias: Bias) -> Sum {
        let settings = Settings { bias, ..self.frame.settings.clone() };
        let bias = match bias {
            Bias::Constant(Some(bias)) => bias,
            _ => self.frame.bias,
        };
        let frame = Frame { settings, bias, ..self.frame.clone() };
        self.sum(|p, normal| frame.visibility(self.maps, p, normal))
    }

    /// The hard test at one point's direction with another's distance.
    fn compare(&self, direction: Vec3<f32>, distance: f32) -> f32 {
        let light = self.frame.light;
        let at = dpsm_lookup(direction, light);
        let depth = ((distance - light.near) / (light.far - light.near)).clamp(0.0, 1.0);
        self.maps.compare(at.coordinates, at.layer, depth)
    }

    /// Bevy: the point moves 0.6 sqrt(2) texels of the cube's face along its normal, as wide as
    /// they are at the point, and 0.08 world units towards the light. A face is N / 2 wide here.
    fn bevy(&self) -> Sum {
        self.sum(|p, normal| {
            let normal = facing(p, normal);
            let axis = p.x.abs().max(p.y.abs()).max(p.z.abs());
            let texel = 2.0 / (self.frame.light.size / 2.0);
            let along = 0.6 * std::f32::consts::SQRT_2 * texel * axis;
            let moved = p + normal * along - p * (0.08 / p.length());
            self.compare(moved, moved.length())
        })
    }

    /// Godot, omnidirectional: the direction moves along the normal by 10 / N (1 - |cos a|), and
    /// the distance is less 0.1 world units.
    fn godot(&self) -> Sum {
        self.sum(|p, normal| {
            let (normal, d) = (facing(p, normal), p / p.length());
            let along = 10.0 / self.frame.light.size * (1.0 - normal.dot(d).abs());
            self.compare(d + normal * along, p.length() - 0.1)
        })
    }
}

/// A unit normal turned towards the light.
fn facing(p: Vec3<f32>, normal: Vec3<f32>) -> Vec3<f32> {
    let unit = normal / normal.length().max(f32::MIN_POSITIVE);
    if unit.dot(p) > 0.0 { -unit } else { unit }
}

pub fn contact(device: &Device) -> Result<(), GpuError> {
    println!(
        "\n{POINTS} points spread over all surfaces, {SIZE} x {SIZE}, D32, refined, hard test\n"
    );
    println!("| scene | bias | faults: shadow, light | false shadow | false light | contact gap |");
    println!("|---|---|---|---|---|---|");
    for place in &places() {
        let frame = place.frame(Settings { size: SIZE, ..Settings::default() });
        let truth = truth_of(&frame);
        let maps = make_maps(device, &frame)?;
        let bench = Bench::new(&frame, &maps, &truth);
        let judged = |point: &Point| {
            let (p, normal) = bench.receiver(point);
            (p, normal, judge(&bench, point))
        };
        let points = bench.points_scattered(POINTS, 1).iter().map(judged).collect();
        let judged = Judged { frame: &frame, maps: &maps, points };
        let row = |name: &str, s: Sum| {
            println!(
                "| {} | {name} | {}, {} | {} | {} | {:.4} |",
                place.scene.name,
                s.faults_shadow,
                s.faults_light,
                s.false_shadow,
                s.false_light,
                s.gap
            );
        };
        row("texel-centre", judged.of_frame(Bias::TexelCentre));
        row("footprint", judged.of_frame(Bias::Footprint));
        row("constant", judged.of_frame(Bias::Constant(None)));
        let DpsmLight { near, far, .. } = frame.light;
        let tuned = TRIES
            .map(|share| (share * frame.bias).min(0.49))
            .map(|bias| (bias, judged.of_frame(Bias::Constant(Some(bias)))))
            .into_iter()
            .min_by_key(|(_, s)| s.false_shadow + s.false_light);
        if let Some((bias, sum)) = tuned {
            row(&format!("constant by hand, {:.4} units", bias * (far - near)), sum);
        }
        row("as Bevy", judged.bevy());
        row("as Godot", judged.godot());
    }
    Ok(())
}
