//! One glTF primitive: its accessors, made into a mesh in world space.

use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::mesh::{Mode, Reader};
use ::gltf::{Accessor, Primitive, Semantic, buffer};
use glam::{DMat3, Mat4, Vec2, Vec3};

use super::{Corner, Draft, albedo, alpha};
use crate::scene::{Mask, Mesh};

pub(super) fn has_triangles(mode: Mode) -> bool {
    use Mode::{TriangleFan, TriangleStrip, Triangles};
    matches!(mode, Triangles | TriangleStrip | TriangleFan)
}

/// `None` if no usable triangle is left; an error says what is wrong with the file.
pub(super) fn mesh(
    name: String,
    primitive: &Primitive,
    mut mask: Option<Mask>,
    world: Mat4,
    buffers: &[buffer::Data],
    warnings: &mut Vec<String>,
) -> Result<Option<Mesh>, String> {
    let linear = DMat3::from_mat4(world.as_dmat4());
    let mirrored = linear.determinant() < 0.0;
    let data = |buffer: buffer::Buffer| buffers.get(buffer.index()).map(|data| &data[..]);
    let reader = primitive.reader(data);

    let vec3 = (Dimensions::Vec3, &[DataType::F32][..]);
    check("positions", primitive.get(&Semantic::Positions), vec3)?;
    let positions = reader.read_positions().ok_or_else(|| outside("positions"))?;
    let positions: Vec<Vec3> = positions.map(|p| world.transform_point3(p.into())).collect();

    check("normals", primitive.get(&Semantic::Normals), vec3)?;
    let normals: Option<Vec<Vec3>> = match primitive.get(&Semantic::Normals) {
        None => None,
        Some(_) => {
            let normals = reader.read_normals().ok_or_else(|| outside("normals"))?;
            let to_world = normal_matrix(linear);
            // Only the direction matters, and the length may be beyond f32.
            let turned = |n| (to_world * Vec3::from(n).as_dvec3()).normalize_or_zero().as_vec3();
            Some(normals.map(turned).collect())
        }
    };

    let integers = [DataType::U8, DataType::U16, DataType::U32];
    check("indices", primitive.indices(), (Dimensions::Scalar, &integers))?;
    let indices: Vec<u32> = match primitive.indices() {
        None => (0..positions.len() as u32).collect(),
        Some(_) => {
            let indices = reader.read_indices().ok_or_else(|| outside("indices"))?;
            indices.into_u32().collect()
        }
    };

    let texcoords = match &mask {
        None => Vec::new(),
        Some(_) => texcoords(primitive, &reader)?.unwrap_or_else(|| {
            let what = "its mask has no texture coordinates, so it is opaque";
            warnings.push(format!("mesh `{name}`: {what}"));
            mask = None;
            Vec::new()
        }),
    };

    let corner = |position| Corner {
        position,
        normal: normals.is_some().then_some(position),
        texcoord: mask.is_some().then_some(position),
    };
    let [r, g, b, _] = primitive.material().pbr_metallic_roughness().base_color_factor();
    let draft = Draft {
        name,
        positions: &positions,
        normals: normals.as_deref().unwrap_or_default(),
        texcoords: &texcoords,
        triangles: triangles(primitive.mode(), &indices)
            .into_iter()
            // A mirroring transform turns the winding around (glTF 2.0, 3.7.4).
            .map(|[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }.map(corner))
            .collect(),
        albedo: albedo([r, g, b]),
        mask,
    };
    Ok(draft.finish(warnings))
}

/// Where the mask is read; `None` if the primitive does not say.
fn texcoords<'a, 's, F>(
    primitive: &Primitive<'a>,
    reader: &Reader<'a, 's, F>,
) -> Result<Option<Vec<Vec2>>, String>
where
    F: Clone + Fn(buffer::Buffer<'a>) -> Option<&'s [u8]>,
{
    let set = alpha::texcoord_set(primitive);
    let found = set.and_then(|set| Some((set, primitive.get(&Semantic::TexCoords(set))?)));
    let Some((set, accessor)) = found else { return Ok(None) };
    let types = [DataType::F32, DataType::U8, DataType::U16];
    check("texture coordinates", Some(accessor), (Dimensions::Vec2, &types))?;
    let read = reader.read_tex_coords(set).ok_or_else(|| outside("texture coordinates"))?;
    let transform = alpha::transform(&primitive.material());
    Ok(Some(read.into_f32().map(|texcoord| transform(texcoord.into())).collect()))
}

fn outside(what: &str) -> String {
    format!("its {what} lie outside their buffer")
}

/// What the crate's readers take for granted, and would panic or run out of memory without.
fn check(
    what: &str,
    accessor: Option<Accessor>,
    (shape, types): (Dimensions, &[DataType]),
) -> Result<(), String> {
    let Some(accessor) = accessor else {
        return Ok(());
    };
    let wrong = if accessor.dimensions() != shape || !types.contains(&accessor.data_type()) {
        "have an unexpected type"
    } else if accessor.count() == 0 {
        "have the length 0"
    } else if accessor.view().is_none() {
        "have no buffer view"
    } else if accessor.view().is_some_and(|view| accessor.count() > view.length()) {
        // each takes a byte at least; the crate's reader of sparse ones reserves as many as it is
        // told, and its arithmetic wraps
        return Err(outside(what));
    } else {
        return Ok(());
    };
    Err(format!("its {what} {wrong}"))
}

/// Indices of each triangle, as glTF 2.0 numbers them (3.7.2.1).
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, t)| [t[0], t[1 + i % 2], t[2 - i % 2]])
            .collect(),
        Mode::TriangleFan => {
            indices.windows(2).skip(1).map(|edge| [edge[0], edge[1], indices[0]]).collect()
        }
        _ => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    }
}

/// The inverse transpose but for a positive factor; as cofactors it exists for flat scales too.
fn normal_matrix(m: DMat3) -> DMat3 {
    let sign = m.determinant().signum();
    DMat3::from_cols(
        m.y_axis.cross(m.z_axis) * sign,
        m.z_axis.cross(m.x_axis) * sign,
        m.x_axis.cross(m.y_axis) * sign,
    )
}
