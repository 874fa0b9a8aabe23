//! The frame's filters by the ports, and what the camera pass is told of them.

use super::{Filter, Frame, Kernel, Taps};
use crate::scalar::bias::{dpsm_bias_footprint, dpsm_bias_slack};
use crate::scalar::filter::{
    DPSM_TAP_HARD, DPSM_TAP_LINEAR, DpsmTaps, dpsm_filter_disk, dpsm_filter_mirror,
    dpsm_filter_pcf, dpsm_filter_reproject,
};
use crate::scalar::float::{Vec2, Vec3};
use crate::scalar::kernel::{dpsm_kernel, dpsm_kernel_rotation};
use crate::scalar::maps::{DepthMaps, Sampling};
use crate::scalar::paraboloid::dpsm_project_own;
use crate::scalar::pcss::dpsm_pcss;

/// A soft light's radius as a share of far, where none is given.
const LIGHT_SHARE: f32 = 1.0 / 50.0;

/// Its nearest casters' distance as a share of far, where none is given.
const NEAREST_SHARE: f32 = 1.0 / 8.0;

impl Frame {
    /// The taps of the frame's filter, or one.
    pub fn taps(&self) -> DpsmTaps<f32> {
        let tolerance = self.settings.too_near();
        DpsmTaps {
            count: match self.settings.filter {
                Filter::Single => 1,
                Filter::Naive(side) => side,
                Filter::Disk(taps) | Filter::Mirror(taps) | Filter::Reproject(taps) => taps.count,
                Filter::Soft { taps, .. } => taps,
            },
            kind: match self.settings.sampling {
                Sampling::Nearest => DPSM_TAP_HARD,
                Sampling::Linear => DPSM_TAP_LINEAR,
            },
            quantum: self.settings.quantum(),
            tolerance,
        }
    }

    /// A soft light's radius and the distance of its nearest casters.
    pub fn soft(&self) -> [f32; 2] {
        let far = self.light.far;
        let (radius, nearest) = match self.settings.filter {
            Filter::Soft { radius, nearest, .. } => (radius, nearest),
            _ => (None, None),
        };
        [radius.unwrap_or(far * LIGHT_SHARE), nearest.unwrap_or(far * NEAREST_SHARE)]
    }

    /// What the camera pass is told of the filter: taps' number and kind, whether the kernel is a
    /// world radius; kernel, light's radius, nearest casters, naive kernel's own bias or -1.
    pub fn filter_words(&self) -> [u32; 7] {
        let taps = self.taps();
        let kernel = match self.settings.filter {
            Filter::Disk(taps) | Filter::Mirror(taps) | Filter::Reproject(taps) => {
                Some(taps.kernel)
            }
            Filter::Single | Filter::Naive(_) | Filter::Soft { .. } => None,
        };
        let (world, size) = match kernel {
            Some(Kernel::Radius(radius)) => (1, radius),
            Some(Kernel::Tangent(tangent)) => (0, tangent),
            None => (0, 0.0),
        };
        let [radius, nearest] = self.soft();
        let bias = self.constant_bias().unwrap_or(-1.0);
        let [size, radius, nearest, bias] = [size, radius, nearest, bias].map(f32::to_bits);
        [taps.count, taps.kind, world, size, radius, nearest, bias]
    }

    /// The filtered share of the light, by any filter but a single lookup.
    pub(super) fn filtered(
        &self,
        maps: &DepthMaps,
        p: Vec3<f32>,
        normal: Vec3<f32>,
        rotation: Vec2<f32>,
    ) -> f32 {
        let light = self.light;
        let receiver = self.receiver(p, normal);
        let taps = self.taps();
        let first = Vec2::new(1.0, 0.0);
        match self.settings.filter {
            Filter::Single => self.visibility(maps, p, normal),
            Filter::Naive(side) => {
                let bias = self.constant_bias().unwrap_or_else(|| {
                    // the outermost taps lie (side - 1) / 2 texels from the middle
                    let window = 0.5 * side as f32 + (self.settings.window() - 0.5);
                    let uv = dpsm_project_own(p);
                    let l = receiver.distance;
                    dpsm_bias_footprint(receiver, uv, window, light)
                        + dpsm_bias_slack(l, light, taps.quantum, taps.tolerance)
                });
                dpsm_filter_pcf(maps, p, light, side, bias)
            }
            Filter::Disk(Taps { kernel, .. }) => {
                let tangent = kernel.tangent(receiver.distance);
                dpsm_filter_disk(maps, p, receiver, tangent, light, taps, rotation)
            }
            Filter::Mirror(Taps { kernel, .. }) => {
                let kernel = dpsm_kernel(p, kernel.tangent(receiver.distance));
                dpsm_filter_mirror(maps, receiver, kernel, light, taps, first)
            }
            Filter::Reproject(Taps { kernel, .. }) => {
                let tangent = kernel.tangent(receiver.distance);
                dpsm_filter_reproject(maps, p, tangent, receiver, light, taps, first)
            }
            Filter::Soft { .. } => {
                let [radius, nearest] = self.soft();
                dpsm_pcss(maps, p, receiver, light, taps, radius, nearest, rotation)
            }
        }
    }
}

/// The direction of a kernel's first tap at a pixel, whose samples each have their own: `shift` is
/// that of the sample's view.
pub fn rotation_at([x, y]: [u32; 2], shift: [f32; 2]) -> Vec2<f32> {
    if shift == [0.0; 2] {
        return dpsm_kernel_rotation([x, y]);
    }
    let cell = [u32::from(shift[0] < 0.0), u32::from(shift[1] > 0.0)];
    dpsm_kernel_rotation([2 * x + cell[0], 2 * y + cell[1]])
}
