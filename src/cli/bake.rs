//! `dpsm bake`: the maps as distances, for anyone to check.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dpsm::render::Frame;
use dpsm::scalar::maps::DepthMaps;

use super::measure::{prepare, pretty};
use super::output::{Outputs, check_output, print};
use super::setup::{Names, SetupArguments};
use super::{AdapterChoice, CliError, describe};

/// Make the maps and write them as EXR, distances in world units
#[derive(Debug, Args)]
#[command(after_help = "\
One layer a hemisphere (`front`, `back`), or a cube's face (`+x`, `-x`, `+y`, `-y`, `+z`, `-z`), with
the channel `distance`: f32, world units, infinite where nothing was hit. MAPS.json beside it holds the light's parameters. Nothing is
chosen at random.

Example:
  dpsm bake brabec-room --light=-1,2,0.5 --size 512 -o maps.exr
  dpsm bake cornell --method cube -o faces.exr")]
pub struct BakeArguments {
    #[command(flatten)]
    pub setup: SetupArguments,
    /// The .exr file to write
    #[arg(short, long)]
    output: PathBuf,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
}

impl BakeArguments {
    /// Refuses an output that is no EXR file, before there is anything to write.
    pub fn check(&self) -> Result<(), CliError> {
        let path = &self.output;
        if let Some(plan) = &self.setup.plan
            && path.with_extension("json") == *plan
        {
            let (path, plan) = (path.display(), plan.display());
            let message = format!(
                "{path}'s parameters would replace the plan {plan}; choose another name with -o"
            );
            return Err(CliError::Usage(message));
        }
        match path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr")) {
            true => Ok(()),
            false => {
                Err(CliError::Usage(format!("maps are EXR: name {} something.exr", path.display())))
            }
        }
    }
}

/// `dpsm bake`.
pub fn bake(adapter: AdapterChoice, arguments: &BakeArguments) -> Result<(), CliError> {
    arguments.check()?;
    check_output(Some(&arguments.output))?;
    let (scene, frame, maps, device) = prepare(adapter, &arguments.setup)?;
    let path = &arguments.output;
    let beside = path.with_extension("json");
    let light = frame.light;
    let vector = |v: dpsm::scalar::float::Vec3<f32>| [v.x, v.y, v.z];
    let names = Names::of(&frame.settings);
    let parameters = serde_json::json!({
        "scene": scene,
        "position": frame.in_file(light.position).to_array(),
        "right": vector(light.right),
        "up": vector(light.up),
        "forward": vector(light.forward),
        "near": light.near,
        "far": light.far,
        "guard": light.guard,
        "size": maps.size,
        "hemispheres": light.hemispheres,
        "reversed": light.reversed,
        "format": names.format,
        "method": names.method,
        "tau": names.tau,
        "level": names.level,
        "passes": names.passes,
        "filter": names.filter,
        "bias": names.bias,
        "constant_bias": frame.constant_bias(),
        "depth_tolerance": frame.settings.too_near(),
        "computed_by": describe(device.as_ref()),
    });
    let mut outputs = Outputs::for_option("-o");
    outputs.add(path, exr_bytes(path, &frame, &maps)?)?;
    outputs.add(&beside, pretty(&parameters)?.into())?;
    let written = outputs.finish()?;
    if arguments.json {
        return print(&pretty(&serde_json::json!({ "written": written, "light": parameters }))?);
    }
    let mut text =
        format!("{}\n{scene}: {} triangles\n", describe(device.as_ref()), frame.triangles.len());
    for path in written {
        let _ = writeln!(text, "  {}", path.display());
    }
    print(&text)
}

/// The maps as an EXR file, one layer a hemisphere or face.
fn exr_bytes(path: &Path, frame: &Frame, maps: &DepthMaps) -> Result<Vec<u8>, CliError> {
    use exr::prelude::*;
    let size = maps.size as usize;
    let names = frame.settings.method.projection().names();
    let layer = |(index, &name): (u32, &&str)| {
        let samples = frame.distances(maps, index).collect();
        let channel = AnyChannel::new("distance", FlatSamples::F32(samples));
        let attributes = LayerAttributes::named(name);
        Layer::new(
            (size, size),
            attributes,
            Encoding::SMALL_LOSSLESS,
            AnyChannels::sort(std::iter::once(channel).collect()),
        )
    };
    let layers: Vec<_> = (0..maps.layers).zip(names).map(layer).collect();
    let bounds = IntegerBounds::from_dimensions((size, size));
    let image = Image::from_layers(ImageAttributes::new(bounds), layers);
    let mut bytes = std::io::Cursor::new(Vec::new());
    image
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| CliError::Exr { path: path.into(), message: error.to_string() })?;
    Ok(bytes.into_inner())
}
