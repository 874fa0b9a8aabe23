//! What a rendering may vary, and what follows from it.

use super::{FrameError, Projection, guard_band};
use crate::scalar::edge::DPSM_EDGE_SNAP;
use crate::scalar::maps::Sampling;
use crate::scalar::refine::DPSM_REFINE_NEARER;
use crate::scene::Mesh;

/// Storage of a depth map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 16-bit unorm.
    D16,
    /// 24-bit unorm; an adapter may use 32-bit float in its place.
    D24,
    /// 32-bit float.
    D32,
}

impl Format {
    /// Step of the stored values: 1 / 65535, 1 / 16777215, or 0 where f32 itself is stored.
    pub fn quantum(self) -> f32 {
        match self {
            Format::D16 => 1.0 / 65535.0,
            Format::D24 => 1.0 / 16777215.0,
            Format::D32 => 0.0,
        }
    }

    /// A depth in [0, 1] as the format stores it.
    pub fn store(self, depth: f32) -> f32 {
        let unorm = |steps: f64| ((f64::from(depth) * steps).round() / steps) as f32;
        match self {
            Format::D16 => unorm(65535.0),
            Format::D24 => unorm(16777215.0),
            Format::D32 => depth,
        }
    }
}

/// How the maps are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Brabec 2002: project vertices, interpolate everything.
    Vertex,
    /// The blog: radial depth of each fragment's interpolated position.
    FragmentDepth,
    /// Osman 2006: `Vertex` on subdivided triangles.
    Tessellated,
    /// Each triangle as its arcs bound it, its distance computed for each texel.
    Exact,
    /// Edges split until they lie within `tau` of their arcs, then plain triangles.
    Refined,
    /// Six perspective faces, the baseline.
    Cube,
}

/// What one mesh is in the maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Casting {
    /// Drawn by this method.
    By(Method),
    /// It casts no shadow, in the maps and by rays: a bulb, a lamp's shade, or what only receives.
    LeftOut,
    /// Not drawn, as nothing that is seen lies in its shadow; by rays it casts one all the same.
    Unseen,
}

impl Casting {
    /// The method that draws it, if any does.
    pub fn method(self) -> Option<Method> {
        match self {
            Self::By(method) => Some(method),
            Self::LeftOut | Self::Unseen => None,
        }
    }
}

/// Smallest and largest `Settings::tau`, in texels.
pub const SMALLEST_TAU: f32 = 1.0 / 64.0;
/// See `SMALLEST_TAU`.
pub const LARGEST_TAU: f32 = 4.0;

/// How often refinement splits an edge at most. Each time halves the angle between its ends, below
/// pi: after 6 times its chord is short in any case, and each further time takes the bow of what is
/// left, 1/64 of the disk's radius, to a quarter. One more is the split at the light's foot.
pub fn refinement_levels(size: u32, tau: f32) -> u32 {
    let texel = 2.0 * (1.0 + guard_band(size)) / size as f32;
    let reach = (0.9375 * tau - DPSM_EDGE_SNAP as f32) * texel;
    let quarters = (1.0 / 64.0 / reach).log2() / 2.0;
    6 + quarters.clamp(0.0, 16.0).ceil() as u32 + 2
}

/// How finely the tessellated method subdivides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Each triangle into level^2 (Osman's constant level).
    Constant(u32),
    /// Each mesh as its longest edge, its distance and `tau` ask, up to a level.
    Mesh(u32),
}

/// How the maps of a light are drawn and where they lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passes {
    /// One pass a map, one layer each.
    Single,
    /// All maps of a light in one pass, side by side in one layer.
    Atlas,
    /// All maps of a light in one pass, one layer each, on adapters that have multiview.
    Multiview,
}

/// Where receivers find their texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lookup {
    /// For each pixel (Osman 2006).
    Pixel,
    /// For each vertex, interpolated (Brabec 2002).
    Vertex,
}

/// What keeps surfaces from shadowing themselves.
///
/// `Plane` and `Normal` are lookups of their own: they read 2 x 2 texels, whatever
/// `Settings::sampling` says. A cube's maps are read by `Footprint` of 2 x 2 texels in their place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bias {
    /// `dpsm_visibility_plane`: four texels, each lit, in shadow or undecided against the receiver's
    /// plane.
    Plane,
    /// `dpsm_visibility_normal`: the same against the receiver's own distance, by the hardware's
    /// comparisons.
    Normal,
    /// A constant in units of depth, at the receiver; by default `constant_bias`.
    Constant(Option<f32>),
    /// By the receiver's plane, over the texels that are read.
    Footprint,
    /// The receiver's plane along the texel's centre; where 2 x 2 texels are compared with one
    /// depth, `Footprint`.
    TexelCentre,
}

/// How the lookups of a receiver are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// One lookup: the hard test or 2 x 2 comparisons, as `Settings::sampling` and the bias say.
    Single,
    /// `dpsm_filter_pcf`: as many texels along a side around the receiver's own.
    Naive(u32),
    /// `dpsm_filter_disk`.
    Disk(Taps),
    /// `dpsm_filter_mirror`.
    Mirror(Taps),
    /// `dpsm_filter_reproject`.
    Reproject(Taps),
    /// `dpsm_pcss`.
    Soft {
        /// Taps of the search, and of the filter.
        taps: u32,
        /// The light's radius in world units; by default a fiftieth of far.
        radius: Option<f32>,
        /// Distance of the nearest casters that are found all over their penumbra; by default an
        /// eighth of far.
        nearest: Option<f32>,
    },
}

/// Taps over a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taps {
    /// How many.
    pub count: u32,
    /// What they are spread over.
    pub kernel: Kernel,
}

/// A cone around a receiver's direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// Given by the tangent of its half-angle.
    Tangent(f32),
    /// Given by its radius in world units at the receiver.
    Radius(f32),
}

impl Kernel {
    /// The tangent of its half-angle at a distance.
    pub fn tangent(self, distance: f32) -> f32 {
        match self {
            Self::Tangent(tangent) => tangent,
            Self::Radius(radius) => radius / distance.max(super::SMALLEST),
        }
    }
}

/// Most taps of a filter, and texels along a side of a naive kernel.
pub const MOST_TAPS: u32 = 1024;

/// Widest kernel's tangent: what `dpsm_kernel` is specified for.
const WIDEST: f32 = 1024.0;

impl Filter {
    /// What is wrong with it, if anything.
    pub(super) fn fault(self) -> Option<String> {
        let (count, sizes) = match self {
            Self::Single => return None,
            Self::Naive(side) => (side, vec![]),
            Self::Disk(taps) | Self::Mirror(taps) | Self::Reproject(taps) => match taps.kernel {
                Kernel::Tangent(size) => {
                    (taps.count, vec![("kernel of tangent (--kernel-angle)", size)])
                }
                Kernel::Radius(size) => {
                    (taps.count, vec![("kernel radius (--kernel-radius)", size)])
                }
            },
            Self::Soft { taps, radius, nearest } => {
                let radius = radius.map(|size| ("light radius (--light-size)", size));
                let nearest = nearest.map(|size| ("nearest distance (--nearest)", size));
                (taps, radius.into_iter().chain(nearest).collect())
            }
        };
        if !(1..=MOST_TAPS).contains(&count) {
            return Some(format!("{count} taps: there may be 1 to {MOST_TAPS}"));
        }
        let bad = sizes.into_iter().find(|(_, size)| !(0.0..=WIDEST).contains(size));
        bad.map(|(name, size)| format!("a {name} of {size}: it may be 0 to {WIDEST}"))
    }
}

/// The methods of paraboloid maps, as a message says it.
const PARABOLOID: &str = "Vertex, FragmentDepth, Tessellated, Exact or Refined";

/// The settings of a rendering.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Map size N in texels.
    pub size: u32,
    /// Storage of the maps.
    pub format: Format,
    /// Whether the maps hold 1 less each depth and are compared with greater-equal, as renderers
    /// with reversed depth have it; paraboloid maps only.
    pub reversed: bool,
    /// How the maps are made: which maps a light has, and who draws the meshes without a casting.
    pub method: Method,
    /// What each mesh is in the maps: one for each of the scene's meshes, in the scene's order;
    /// empty: all by `method`. `Frame::new` reads it; methods must draw the same kind of maps as
    /// `method`.
    pub casting: Vec<Casting>,
    /// Refined method: how far an edge may be drawn from its place, in texels, from `SMALLEST_TAU`
    /// to `LARGEST_TAU`.
    pub tau: f32,
    /// Refined method: how far a stored distance may be off, relative; by default
    /// `depth_tolerance`.
    pub depth_tolerance: Option<f32>,
    /// Refined method: the most triangles and vertices that refinement may add, for a bound on its
    /// memory; more, and the maps are drawn exactly. By default as many as the lights need.
    pub most_refined: Option<u32>,
    /// Tessellated method: how finely.
    pub level: Level,
    /// Cube method: leave out of each face what it cannot see.
    pub cull_faces: bool,
    /// How the maps are drawn.
    pub passes: Passes,
    /// Keep the lists of sorted triangles of every light, for scenes that stand still.
    pub keep_lists: bool,
    /// How receivers look.
    pub lookup: Lookup,
    /// How the maps are sampled: the hard test, or 2 x 2 comparisons.
    pub sampling: Sampling,
    /// How the lookups are averaged; all but `Single` are for paraboloid maps and lookups by pixel.
    pub filter: Filter,
    /// Width and height of the lit image in pixels.
    pub image: [u32; 2],
    /// Samples along a side of each pixel, `1..=MOST_SAMPLES`: each has a shadow test of its own,
    /// and a pixel is their mean in linear light.
    pub samples: u32,
    /// The lit image's shadows are tested on the curved surface that the vertices' normals suggest,
    /// `dpsm_shadow_terminator`, in lookups by pixel.
    pub terminator: bool,
    /// The factor on linear light; by default what [`exposure`](super::exposure) finds.
    pub exposure: Option<f32>,
    /// Near sphere's radius; by default as small as can be, and for a cube the nearest caster's
    /// distance, from a thousandth of far to where a step of the format at far is a texel wide.
    pub near: Option<f32>,
    /// Far sphere's radius; by default just beyond the farthest vertex.
    pub far: Option<f32>,
    /// What keeps surfaces from shadowing themselves; lookups by vertex take a constant bias.
    pub bias: Bias,
    /// Also give the maps and what the light sees of each hemisphere.
    pub views: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: 1024,
            format: Format::D32,
            reversed: false,
            method: Method::Refined,
            casting: Vec::new(),
            tau: 1.0 / 4.0,
            depth_tolerance: None,
            most_refined: None,
            level: Level::Mesh(64),
            cull_faces: true,
            passes: Passes::Single,
            keep_lists: false,
            lookup: Lookup::Pixel,
            sampling: Sampling::Nearest,
            filter: Filter::Single,
            image: [960, 720],
            samples: 2,
            terminator: true,
            exposure: None,
            near: None,
            far: None,
            bias: Bias::Plane,
            views: false,
        }
    }
}

/// Step of the floats below 1.
const REVERSED_STEP: f32 = 1.0 / (1 << 24) as f32;

/// Brabec's constant bias in units of depth: what a receiver at the far sphere needs at 45 degrees
/// incidence, half a texel's diagonal off, sqrt(2) / 2 texel of 4 (1 + guard) / N rad, plus one
/// step of the format. For near much smaller than far; at most 1/4.
pub fn constant_bias(size: u32, format: Format) -> f32 {
    let pitch = 4.0 * (1.0 + guard_band(size)) / size as f32;
    (std::f32::consts::FRAC_1_SQRT_2 * pitch + format.quantum()).min(0.25)
}

/// The relative error of distances that the refined method is allowed: half the finest texel's
/// width, 2 (1 + guard) / N at the rim, which is a quarter of the coarsest's, so that maps of any
/// size are as exact along a ray as across it; at most a sixteenth.
pub fn depth_tolerance(size: u32) -> f32 {
    ((1.0 + guard_band(size)) / size as f32).min(1.0 / 16.0)
}

impl Settings {
    /// Texels along a side of a map: for the cube method half of `size`, as its faces then have
    /// the same largest texel (docs/cube.md).
    pub fn map_size(&self) -> u32 {
        match self.method {
            Method::Cube => (self.size / 2).max(1),
            _ => self.size,
        }
    }

    /// Marks those of a scene's meshes that cast no shadow.
    pub fn leave_out(&mut self, no_cast: &[bool]) {
        if no_cast.contains(&true) && self.casting.is_empty() {
            self.casting = vec![Casting::By(self.method); no_cast.len()];
        }
        for (casting, _) in self.casting.iter_mut().zip(no_cast).filter(|(_, out)| **out) {
            *casting = Casting::LeftOut;
        }
    }

    /// Step of the stored values: the format's, and of reversed ones what 1 less a depth is rounded by.
    pub fn quantum(&self) -> f32 {
        self.format.quantum() + if self.reversed { REVERSED_STEP } else { 0.0 }
    }

    /// The methods that draw meshes.
    pub fn methods(&self) -> impl Iterator<Item = Method> {
        let all = self.casting.is_empty().then_some(self.method);
        all.into_iter().chain(self.casting.iter().filter_map(|casting| casting.method()))
    }

    /// Refuses tolerances that the refined method cannot keep.
    pub(super) fn check_tolerances(&self) -> Result<(), FrameError> {
        if !(SMALLEST_TAU..=LARGEST_TAU).contains(&self.tau) {
            return Err(FrameError::Tau(self.tau));
        }
        match self.depth_tolerance {
            Some(tolerance) if !(0.0..=1.0).contains(&tolerance) => {
                Err(FrameError::DepthTolerance(tolerance))
            }
            _ => Ok(()),
        }
    }

    /// Refuses castings that do not fit the scene's meshes, the maps or the passes.
    pub(super) fn check_casting(&self, meshes: &[Mesh]) -> Result<(), FrameError> {
        if ![0, meshes.len()].contains(&self.casting.len()) {
            let (found, meshes) = (self.casting.len(), meshes.len());
            return Err(FrameError::Castings { found, meshes });
        }
        for (mesh, casting) in meshes.iter().zip(&self.casting) {
            let Some(method) = casting.method() else { continue };
            let (why, remedy) = match (self.method.projection(), method) {
                (Projection::Cube, Method::Cube) => continue,
                (Projection::Cube, _) => ("the light's maps are the faces of a cube", "Cube"),
                (_, Method::Cube) => ("the light's maps are paraboloid", PARABOLOID),
                _ => continue,
            };
            return Err(FrameError::Casting { mesh: mesh.name.clone(), method, why, remedy });
        }
        Ok(())
    }

    /// Refuses passes that the methods do not have.
    pub(crate) fn check_passes(&self) -> Result<(), FrameError> {
        let remedy = "--passes single";
        match (self.passes, self.method) {
            (Passes::Atlas, Method::Cube) => Err(FrameError::Cube { what: "atlas", remedy }),
            (Passes::Multiview, Method::Cube) => {
                Err(FrameError::Cube { what: "multiview", remedy })
            }
            _ => Ok(()),
        }
    }

    /// The largest tau and depth tolerance that a mesh is drawn with.
    pub fn tolerances(&self) -> [f32; 2] {
        let of = self.methods().map(|method| self.tolerances_of(method));
        of.fold([0.0; 2], |[a, b], [tau, depth]| [a.max(tau), b.max(depth)])
    }

    /// How much nearer than what it shows a stored distance may be, relative: what a receiver's bias
    /// must allow for the maps' own tolerance.
    pub fn too_near(&self) -> f32 {
        DPSM_REFINE_NEARER as f32 * self.tolerances()[1]
    }

    /// tau and depth tolerance of a method: both 0 for all but the refined one.
    pub fn tolerances_of(&self, method: Method) -> [f32; 2] {
        match method {
            Method::Refined => {
                let depth = self.depth_tolerance.unwrap_or_else(|| depth_tolerance(self.size));
                [self.tau, depth]
            }
            _ => [0.0, 0.0],
        }
    }

    /// The bias's window: half the side, in texels, of the square that holds the centres read.
    pub fn window(&self) -> f32 {
        match self.sampling_taken() {
            Sampling::Nearest => 0.5,
            Sampling::Linear => 1.0,
        }
    }

    /// How the maps are sampled: what reads 2 x 2 texels of itself takes them.
    pub fn sampling_taken(&self) -> Sampling {
        match (self.filter, self.bias, self.lookup) {
            (Filter::Single, Bias::Plane | Bias::Normal, Lookup::Pixel) => Sampling::Linear,
            _ => self.sampling,
        }
    }

    /// The bias that is taken: one depth for 2 x 2 texels cannot follow each one's centre, lookups by
    /// vertex know no plane, and a cube's are `Footprint` in place of `Plane` and `Normal`.
    pub fn bias_taken(&self) -> Bias {
        match (self.bias, self.sampling, self.lookup) {
            (Bias::Constant(_), _, _) => self.bias,
            (_, _, Lookup::Vertex) => Bias::Constant(None),
            (Bias::Plane | Bias::Normal, _, _) if self.method.projection() == Projection::Cube => {
                Bias::Footprint
            }
            (Bias::TexelCentre, Sampling::Linear, _) => Bias::Footprint,
            (bias, _, _) => bias,
        }
    }
}
