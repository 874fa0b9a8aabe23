//! What a rendering is made of, whoever makes it: the adapter (`gpu`) or the ports (`cpu`).

mod clipped;
mod error;
mod exposure;
mod extent;
mod filter;
mod meshes;
mod picture;
mod projection;
mod settings;
mod shine;
mod spheres;

pub use error::FrameError;
pub use exposure::{BACKGROUND, BRIGHTEST, CLIPPED, Linear, MOST_SAMPLES, WHITE, exposure, srgb};
pub use extent::Extent;
pub(crate) use extent::common;
pub use filter::rotation_at;
pub use picture::Picture;
pub use projection::{Projection, texel};
pub use settings::{
    Bias, Casting, Filter, Format, Kernel, LARGEST_TAU, Level, Lookup, MOST_TAPS, Method, Passes,
    SMALLEST_TAU, Settings, Taps, constant_bias, depth_tolerance, refinement_levels,
};
pub use shine::Shine;

use std::ops::Range;
use std::time::Duration;

use glam::{DVec3, Vec2, Vec3};

use crate::scalar::cube::{DPSM_CUBE_FACES, dpsm_cube_guard};
use crate::scalar::float as scalar;
use crate::scalar::hemisphere::dpsm_to_light;
use crate::scalar::kernel::dpsm_kernel_guard;
use crate::scalar::light::{
    DPSM_FORWARD, DPSM_HEMISPHERICAL, DPSM_LAYERS, DPSM_OMNIDIRECTIONAL, DPSM_REVERSED, DpsmLight,
};
use crate::scalar::maps::DepthMaps;
use crate::scalar::triangle::dpsm_triangle_plane;
use crate::scene::{Camera, Mask, Scene, in_file, nearest_of};
use meshes::Meshes;

/// A vertex as the passes read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct Vertex {
    /// World position.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Linear reflectance.
    pub albedo: Vec3,
    /// Where the mask of a masked mesh is read.
    pub texcoord: Vec2,
}

/// A pinhole camera, ready for the vertex stage: right, up and forward are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// World position.
    pub eye: Vec3,
    /// To the image's right.
    pub right: Vec3,
    /// To the image's top.
    pub up: Vec3,
    /// Into the image.
    pub forward: Vec3,
    /// Distance of the near plane.
    pub near: f32,
    /// Cotangents of half the horizontal and vertical fields of view.
    pub scale: [f32; 2],
    /// How far the image is moved to the right and up, in halves of it; for samples.
    pub shift: [f32; 2],
}

/// Ambient light's share of the light's colour on a surface that faces the eye; half of it on one
/// seen edge-on, so that shadows show shapes too.
pub const AMBIENT: f32 = 0.2;

/// Strength of the highlight.
pub const SPECULAR: f32 = 0.25;

/// Everything that a rendering needs.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Vertices of all meshes.
    pub vertices: Vec<Vertex>,
    /// Triangles, those of masked meshes after all others.
    pub triangles: Vec<[u32; 3]>,
    /// Name and triangles of each mesh, in the triangles' order.
    pub meshes: Vec<(String, Range<u32>)>,
    /// Triangles and mask of each masked mesh, in the triangles' order.
    pub masks: Vec<(Range<u32>, Mask)>,
    /// Triangles of each mesh and what it is in the maps, in the triangles' order; empty where all
    /// are drawn by the settings' method.
    pub castings: Vec<(Range<u32>, Casting)>,
    /// The light.
    pub light: DpsmLight<f32>,
    /// More lights, which the lit image takes the mean of with the first; views, maps and measures
    /// are of the first alone.
    pub more: Vec<DpsmLight<f32>>,
    /// The light's linear colour.
    pub color: Vec3,
    /// What the lights reach.
    pub shine: Shine,
    /// Where the origin of all positions lies in the coordinates of the scene's file.
    pub origin: DVec3,
    /// The constant bias in units of depth, at the receiver, where that is what is taken.
    pub bias: f32,
    /// The camera.
    pub view: View,
    /// The settings that the frame was made with.
    pub settings: Settings,
}

/// A rendering.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The lit image.
    pub lit: Picture,
    /// The stored maps, one layer a hemisphere, where the settings ask for views.
    pub maps: Option<DepthMaps>,
    /// What the light sees of each hemisphere, where asked for, all with one exposure of their own.
    pub views: Vec<Picture>,
    /// The factor on the lit image's linear light.
    pub exposure: f32,
    /// Each pass and its time; of the camera's on an adapter, one sample of each pixel.
    pub timings: Vec<(String, Duration)>,
}

impl Rendering {
    /// The rendering under the exposures that the frame's settings ask for.
    pub(crate) fn new(
        frame: &Frame,
        lit: &Linear,
        views: &[Linear],
        maps: Option<DepthMaps>,
        timings: Vec<(String, Duration)>,
    ) -> Self {
        let exposure = frame.settings.exposure_of(&[lit]);
        let of_views = frame.settings.exposure_of(&views.iter().collect::<Vec<_>>());
        let views = views.iter().map(|view| view.picture(of_views)).collect();
        Self { lit: lit.picture(exposure), maps, views, exposure, timings }
    }
}

/// Largest coordinate: squares of sums of three stay finite in f32.
pub const LARGEST: f32 = 1e18;

/// Smallest near sphere: squares of distances beyond it do not underflow.
pub const SMALLEST: f32 = 1e-15;

/// Largest map or image side without an adapter, WebGPU's usual limit on large ones.
pub const LARGEST_SIZE: u32 = 16384;

/// Guard band that keeps the 2 x 2 texels of any lookup up to the rim inside the stored disk. Taps
/// of a kernel go on in the other map, so it is wide enough for all filters but the naive one.
pub fn guard_band(size: u32) -> f32 {
    dpsm_kernel_guard(size as f32, 2.0)
}

impl Frame {
    /// Checks the settings and gathers what the passes read.
    ///
    /// `axis` is the light's main axis; `hemispherical` lights have one map around it.
    pub fn new(
        scene: &Scene,
        position: Vec3,
        axis: Vec3,
        hemispherical: bool,
        camera: &Camera,
        settings: Settings,
    ) -> Result<Self, FrameError> {
        settings.check_casting(&scene.meshes)?;
        let Meshes { vertices, triangles, meshes, masks, castings } =
            Meshes::gather(&scene.meshes, &settings.casting)?;
        check("the light's position", position)?;
        if !axis.is_finite() || axis.as_dvec3().try_normalize().is_none() {
            return Err(FrameError::Axis(axis));
        }
        check("the camera's eye", camera.eye)?;
        check("the camera's target", camera.target)?;
        if settings.method == Method::Cube && settings.lookup == Lookup::Vertex {
            let remedy = "--lookup pixel";
            return Err(FrameError::Cube { what: "lookup by vertex", remedy });
        }
        if settings.method == Method::Cube && settings.reversed {
            let remedy = "depths as they are";
            return Err(FrameError::Cube { what: "reversed depth", remedy });
        }
        settings.check_passes()?;
        settings.check_tolerances()?;
        check_filter(&settings)?;
        check_size("--size", settings.size, LARGEST_SIZE)?;
        check_size("image width", settings.image[0], LARGEST_SIZE)?;
        check_size("image height", settings.image[1], LARGEST_SIZE)?;
        settings.check_pixels()?;
        let constant = constant_bias(settings.size, settings.format);
        let bias = match settings.bias {
            Bias::Constant(Some(bias)) => bias,
            _ => constant,
        };
        if !(0.0..0.5).contains(&bias) {
            return Err(FrameError::Bias(bias));
        }
        let corner =
            |index: u32| vertices[index as usize].position.as_dvec3() - position.as_dvec3();
        let nearest =
            || triangles.iter().map(|t| nearest_of(t.map(corner))).fold(f64::INFINITY, f64::min);
        let nearest = (!triangles.is_empty()).then_some(nearest);
        let [near, far] = settings.spheres(&vertices, position.as_dvec3(), nearest)?;
        let [right, up, forward] = basis(axis.as_dvec3()).map(|row| float(row.as_vec3()));
        let size = settings.map_size();
        let cube = settings.method == Method::Cube;
        let guard = if cube { dpsm_cube_guard(size as f32) } else { guard_band(size) };
        let corner = if cube { spheres::corner(guard) } else { 1.0 };
        let light = DpsmLight {
            position: float(position),
            near: near / corner,
            right,
            far,
            up,
            guard,
            forward,
            size: size as f32,
            rectangle: scalar::Vec4::new(0.0, 0.0, 1.0, 1.0),
            first_layer: 0,
            placement: DPSM_LAYERS,
            hemispheres: match (cube, hemispherical) {
                (true, _) => DPSM_CUBE_FACES,
                (false, true) => DPSM_HEMISPHERICAL,
                (false, false) => DPSM_OMNIDIRECTIONAL,
            },
            reversed: if settings.reversed { DPSM_REVERSED } else { DPSM_FORWARD },
        };
        let view = View::new(camera, settings.image)?;
        let color = Vec3::ONE;
        let more = Vec::new();
        Ok(Self {
            vertices,
            triangles,
            meshes,
            masks,
            castings,
            light,
            more,
            color,
            shine: Shine::EVERYWHERE,
            origin: scene.origin,
            bias,
            view,
            settings,
        })
    }
}

impl Frame {
    /// The constant bias, where it is what is taken.
    pub fn constant_bias(&self) -> Option<f32> {
        matches!(self.settings.bias_taken(), Bias::Constant(_)).then_some(self.bias)
    }

    /// A world position in the coordinates of the scene's file.
    pub fn in_file(&self, position: scalar::Vec3<f32>) -> DVec3 {
        in_file(Vec3::new(position.x, position.y, position.z), self.origin)
    }

    /// A triangle's unit normal in light space, of either side; zero without area or corners.
    pub fn light_normal(&self, triangle: u32) -> scalar::Vec3<f32> {
        let none = scalar::Vec3::splat(0.0);
        let Some(corners) = self.triangles.get(triangle as usize) else { return none };
        let corner = |index: u32| self.vertices.get(index as usize);
        let [Some(a), Some(b), Some(c)] = corners.map(corner) else { return none };
        let [a, b, c] = [a, b, c].map(|v| dpsm_to_light(float(v.position), self.light));
        dpsm_triangle_plane(a, b, c).xyz()
    }
}

impl Frame {
    /// The frame with more lights, each with the spheres that a frame of its own would have.
    ///
    /// For paraboloid maps, lookups by pixel, and a single lookup or the disk of a cone.
    pub fn with_lights(
        mut self,
        lights: impl IntoIterator<Item = DpsmLight<f32>>,
    ) -> Result<Self, FrameError> {
        self.more = lights.into_iter().collect();
        let Settings { filter, method, lookup, .. } = self.settings;
        let fits = matches!(filter, Filter::Single | Filter::Disk(_))
            && method != Method::Cube
            && lookup == Lookup::Pixel;
        match fits || self.more.is_empty() {
            true => Ok(self),
            false => Err(FrameError::Lights),
        }
    }
}

/// The camera's near plane as a share of the distance to its target.
const CAMERA_NEAR_SHARE: f64 = 1e-3;

impl View {
    /// The view of a camera that makes an image of `width` x `height`.
    pub fn new(camera: &Camera, [width, height]: [u32; 2]) -> Result<Self, FrameError> {
        let towards = camera.target.as_dvec3() - camera.eye.as_dvec3();
        let Some(forward) = towards.try_normalize() else {
            return Err(FrameError::Camera(camera.eye));
        };
        let right = forward.cross(camera.up.as_dvec3());
        let right = right.try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let up = right.cross(forward);
        let cotangent = 1.0 / (f64::from(camera.vertical_fov) / 2.0).tan();
        Ok(Self {
            eye: camera.eye,
            right: right.as_vec3(),
            up: up.as_vec3(),
            forward: forward.as_vec3(),
            near: (towards.length() * CAMERA_NEAR_SHARE) as f32,
            scale: [(cotangent * f64::from(height) / f64::from(width)) as f32, cotangent as f32],
            shift: [0.0; 2],
        })
    }

    /// The point that the camera looks at, as near as the near plane tells.
    pub fn target(&self) -> Vec3 {
        (self.eye.as_dvec3() + self.forward.as_dvec3() * (f64::from(self.near) / CAMERA_NEAR_SHARE))
            .as_vec3()
    }
}

/// The light space whose +z is `axis`: right, up, forward with right x up = forward.
pub fn basis(axis: DVec3) -> [DVec3; 3] {
    let forward = axis.try_normalize().unwrap_or(DVec3::NEG_Y);
    let helper = if forward.x.abs() < 0.9 { DVec3::X } else { DVec3::Z };
    let right = (helper - forward * forward.dot(helper)).normalize();
    [right, forward.cross(right), forward]
}

/// glam's vector as the ports' one.
pub fn float(v: Vec3) -> scalar::Vec3<f32> {
    scalar::Vec3::new(v.x, v.y, v.z)
}

fn check(what: &'static str, value: Vec3) -> Result<(), FrameError> {
    match value.abs().max_element() <= LARGEST && value.is_finite() {
        true => Ok(()),
        false => Err(FrameError::Range { what, value }),
    }
}

/// What filters with a kernel need.
fn check_filter(settings: &Settings) -> Result<(), FrameError> {
    if let Some(fault) = settings.filter.fault() {
        return Err(FrameError::Filter(fault));
    }
    match (settings.filter, settings.method, settings.lookup) {
        (Filter::Single, _, _) => Ok(()),
        (_, Method::Cube, _) => {
            Err(FrameError::Kernel { needs: "paraboloid maps", remedy: "another --method" })
        }
        (_, _, Lookup::Vertex) => {
            Err(FrameError::Kernel { needs: "lookups by pixel", remedy: "--lookup pixel" })
        }
        _ => Ok(()),
    }
}

/// A size against its limit.
pub fn check_size(what: &'static str, asked: u32, limit: u32) -> Result<(), FrameError> {
    match (1..=limit).contains(&asked) {
        true => Ok(()),
        false => Err(FrameError::Size { what, asked, limit }),
    }
}
