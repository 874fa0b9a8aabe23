//! `dpsm plan`: the least that a scene needs, and why.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use dpsm::plan::{Request, Target};
use dpsm::render::Settings;
use dpsm::scene::{Camera, Scene};
use glam::{DVec3, Vec3};

use super::measure::pretty;
use super::number::{ANY, whole, whole32};
use super::output::{Outputs, check_output, print};
use super::probe::points;
use super::render::parse_size;
use super::setup::{no_cast, open};
use super::table::Table;
use super::{CliError, parse_vector};

/// Choose the least that keeps a scene's shadow edges within an error
#[derive(Debug, Args)]
#[command(after_help = "\
One map or two, the seam's place, near and far, map size, format, method, filter and bias, and the
meshes that no map needs; a line a choice with its predicted error. docs/plan.md has the derivations.
Nothing runs on an adapter. The same seed gives the same plan.

The error is how far from the true shadow edge a wrongly lit point may be, across the light's ray:
world units (0.002), degrees seen from the light (0.1deg), or texels (0.5texel) of a map of 1024 x
1024, at its middle. Several --light, or --path, are positions of one moving light; the plan holds
for all of them.

Examples:
  dpsm plan brabec-room
  dpsm plan brabec-room --camera scene --error 0.2deg -o plan.json
  dpsm render brabec-room --plan plan.json -o planned.png
  dpsm plan cornell --light 0.2,0.4,0.2 --light 0.3,0.4,0.2 --error 0.002 --budget 2
  dpsm plan atrium.obj --light 0,4,0 --camera 8,2,0 --look-at 0,2,0")]
pub struct PlanArguments {
    /// A built-in scene, or a .obj, .gltf or .glb file
    scene: String,
    /// The light's position, by default the scene's own light; several for a moving one
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    light: Vec<DVec3>,
    /// A CSV file of the light's positions, with the header x,y,z
    #[arg(long, value_name = "FILE", conflicts_with = "light")]
    path: Option<PathBuf>,
    /// A hemispherical light: it lights one half alone
    #[arg(long)]
    hemisphere: bool,
    /// A hemispherical light's main axis; by default the light's own, or down
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    axis: Option<DVec3>,
    /// The camera's position, or `scene` for the scene's own camera; by default all surfaces count
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    camera: Option<Eye>,
    /// The point that the camera looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, requires = "camera")]
    look_at: Option<DVec3>,
    /// Width and height of the camera's image
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "960x720")]
    image: [u32; 2],
    /// How far shadow edges may be off: world units, or with the unit `deg` or `texel`
    #[arg(long, default_value = "0.5texel", allow_negative_numbers = true)]
    error: Target,
    /// Most memory of the maps
    #[arg(long, value_name = "MiB", allow_negative_numbers = true)]
    budget: Option<f64>,
    /// A mesh that casts no shadow, by its name: a bulb, a lamp's shade; several by one option each
    #[arg(long, value_name = "NAME")]
    no_cast: Vec<String>,
    /// Quads along a side of a built-in room's wall, by default 8; 1 gives two triangles
    #[arg(long, value_name = "N", value_parser = whole32::<0, ANY>)]
    walls: Option<u32>,
    /// Chooses the receivers that are looked at
    #[arg(long, value_parser = whole::<0, { u64::MAX }>, default_value_t = 1)]
    seed: u64,
    /// Also write the plan here, for `--plan` of render, bake, probe and measure
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// JSON in place of the explanation
    #[arg(long)]
    json: bool,
}

/// A camera's place.
#[derive(Clone, Copy, Debug)]
enum Eye {
    Scene,
    At(DVec3),
}

impl FromStr for Eye {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "scene" => Ok(Self::Scene),
            _ => parse_vector(text).map(Self::At).map_err(|error| format!("{error}, or `scene`")),
        }
    }
}

/// The scene and what is asked of it, checked.
pub fn request(arguments: &PlanArguments) -> Result<(Scene, Settled), CliError> {
    let mut settled = Settled::default();
    let mut positions = arguments.light.clone();
    if let Some(path) = &arguments.path {
        let given = points(path, Table::read(path)?)?;
        positions = given.iter().map(|(position, _)| *position).collect();
        if positions.is_empty() {
            let path = path.display();
            return Err(CliError::Usage(format!("{path} has no position; give a line for each")));
        }
    }
    let scene = open(&arguments.scene, arguments.walls, positions.first().copied())?;
    settled.lights = positions.into_iter().map(|position| scene.local(position)).collect();
    settled.budget = match arguments.budget {
        Some(mib) if !(mib > 0.0 && mib.is_finite()) => {
            return Err(CliError::Usage(format!("--budget {mib} is no number of MiB above 0")));
        }
        mib => mib.map(|mib| (mib * f64::from(1 << 20)) as u64),
    };
    let light = scene.default_light();
    let own = settled.lights.is_empty();
    if own {
        settled.lights.push(light.position);
    }
    // as the other commands: a light that is moved is omnidirectional unless it is said not to be
    let own_axis = light.axis.filter(|_| own);
    if arguments.hemisphere || own_axis.is_some() {
        let axis = arguments.axis.map(|axis| axis.as_vec3());
        settled.axis = axis.or(light.axis).or(Some(Vec3::NEG_Y));
    }
    settled.camera = arguments.camera.map(|eye| {
        let camera = scene.camera.unwrap_or_else(|| scene.default_camera(settled.lights[0]));
        let eye = match eye {
            Eye::Scene => camera.eye,
            Eye::At(eye) => scene.local(eye),
        };
        Camera {
            eye,
            target: arguments.look_at.map_or(camera.target, |target| scene.local(target)),
            ..camera
        }
    });
    Ok((scene, settled))
}

/// What the arguments come to.
#[derive(Debug, Default)]
pub struct Settled {
    lights: Vec<Vec3>,
    axis: Option<Vec3>,
    camera: Option<Camera>,
    budget: Option<u64>,
}

/// `dpsm plan`.
pub fn plan(arguments: &PlanArguments) -> Result<(), CliError> {
    check_output(arguments.output.as_deref())?;
    let (scene, Settled { lights, axis, camera, budget }) = request(arguments)?;
    let request = Request {
        no_cast: no_cast(&scene, &arguments.no_cast)?,
        lights,
        axis,
        camera,
        image: arguments.image,
        budget,
        seed: arguments.seed,
        ..Request::new(&scene, arguments.error)
    };
    let plan = dpsm::plan::plan(&request)?;
    // a plan that would be refused is not written
    plan.settings(&Settings::default())?;
    let json = pretty(&plan)?;
    if let Some(path) = &arguments.output {
        let mut outputs = Outputs::for_option("-o");
        outputs.add(path, json.clone().into())?;
        outputs.finish()?;
    }
    match arguments.json {
        true => print(&json),
        false => print(&plan.explanation()),
    }
}
