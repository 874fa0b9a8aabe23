//! Alpha-masked casters: the shapes are the masks', and the meshes mere quads.

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::room::{BLUE, GREEN, RED, WHITE, shell};
use crate::scene::shapes::{ball, cuboid, quads, revolve};
use crate::scene::{Mask, Mesh};

/// Texels in a row and a column of both masks.
const SIZE: u32 = 64;

/// A lattice across the plane between the hemispheres, leaves above, and two solids below.
pub(super) fn fence(walls: u32) -> Vec<Mesh> {
    let lattice = [[-1.2, 0.8], [0.8, 0.8], [0.8, 2.8], [-1.2, 2.8]];
    let leaves = [[-1.4, 2.3, 1.2], [-1.4, 2.3, -0.6], [-0.9, 3.2, -0.6], [-0.9, 3.2, 1.2]];
    let upright = Quat::IDENTITY;
    let mut meshes = shell(walls);
    meshes.extend([
        panel("lattice", WHITE, lattice.map(|[x, y]| vec3(x, y, -0.9)), 5.0, mask(in_lattice)),
        panel("leaves", GREEN, leaves.map(Vec3::from), 3.0, mask(in_leaf)),
        revolve("sphere", RED, 32, &ball(0.35, 16)).placed(upright, vec3(0.9, 0.35, -0.4)),
        cuboid("box", BLUE, Vec3::splat(0.6), 0.5).placed(upright, vec3(-1.2, 0.0, 0.6)),
    ]);
    meshes
}

/// A quad, corners counter-clockwise from the lower left, with a mask that repeats.
fn panel(name: &str, albedo: Vec3, corners: [Vec3; 4], repeats: f32, mask: Mask) -> Mesh {
    let mut mesh = quads(name, albedo, &[corners], 1);
    // The quad's vertices are in rows from below; v points down.
    mesh.texcoords = [(0.0, 1.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)]
        .map(|(u, v)| vec2(u, v) * repeats)
        .to_vec();
    mesh.mask = Some(mask);
    mesh
}

/// A shape, tested at texel centres in [-1, 1] x [-1, 1].
fn mask(inside: impl Fn(Vec2) -> bool) -> Mask {
    let center = |i: u32| (2 * i + 1) as f32 / SIZE as f32 - 1.0;
    let texels = (0..SIZE * SIZE).map(|i| vec2(center(i % SIZE), center(i / SIZE)));
    let alpha = texels.map(|texel| if inside(texel) { u8::MAX } else { 0 }).collect();
    Mask { width: SIZE, height: SIZE, alpha, cutoff: 0.5 }
}

/// Two diagonal laths, each an eighth of the square's width, that go on in its neighbours.
fn in_lattice(p: Vec2) -> bool {
    let off_lath = |across: f32| (across - 2.0 * (across / 2.0).round()).abs();
    off_lath(p.x + p.y).min(off_lath(p.x - p.y)) <= 0.25
}

/// What two circles have in common.
fn in_leaf(p: Vec2) -> bool {
    let aside = 0.8;
    (p.abs() + vec2(aside, 0.0)).length() <= 1.2
}
