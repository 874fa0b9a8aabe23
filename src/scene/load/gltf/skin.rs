//! Skins, in the pose that the nodes of the file give (glTF 2.0, 3.7.3).

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DMat4, DVec3};
use serde::Deserialize;

use super::accessor::Accessors;
use super::document::Document;
use super::fault::Fault;
use super::nodes::Tree;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Skin {
    inverse_bind_matrices: Option<usize>,
    #[serde(default)]
    joints: Vec<usize>,
}

/// What each joint does to the vertices that it holds, in the file's coordinates.
pub(super) fn joints<'a>(
    index: usize,
    document: &Document<'a>,
    tree: &mut Tree<'a>,
    accessors: &Accessors,
) -> Result<Vec<DAffine3>, Fault> {
    let skin: Skin = document.get("skins", index)?;
    if skin.joints.iter().any(|&joint| tree.world(joint).is_none()) {
        tree.place_others(document)?;
    }
    let inverses = match skin.inverse_bind_matrices {
        None => None,
        Some(accessor) => Some(accessors.vectors::<16>(accessor, "inverse bind matrices")?),
    };
    let mut joints = Vec::with_capacity(skin.joints.len());
    for (i, &joint) in skin.joints.iter().enumerate() {
        let world = tree.world(joint).ok_or_else(|| format!("there is no node {joint}"))?;
        let inverse = match &inverses {
            None => DAffine3::IDENTITY,
            Some(list) => {
                let matrix = list.get(i).ok_or("it has fewer inverse bind matrices than joints")?;
                DAffine3::from_mat4(DMat4::from_cols_array(matrix))
            }
        };
        joints.push(world * inverse);
    }
    Ok(joints)
}

/// What becomes of each of `count` vertices: the mean of its joints by their weights, of all sets.
/// Weights are scaled so that their sum is 1, as viewers do; without any, the first joint counts.
pub(super) fn vertices(
    attributes: &HashMap<String, usize>,
    count: usize,
    joints: &[DAffine3],
    accessors: &Accessors,
) -> Result<Vec<DAffine3>, Fault> {
    let zero = DAffine3::from_mat3_translation(DMat3::ZERO, DVec3::ZERO);
    let mut sums = vec![(zero, 0.0); count];
    let mut first = Vec::new();
    for set in 0.. {
        let names = ["JOINTS", "WEIGHTS"].map(|name| attributes.get(&format!("{name}_{set}")));
        let [Some(&numbers), Some(&weights)] = names else { break };
        let numbers = accessors.vectors::<4>(numbers, "joints")?;
        let weights = accessors.vectors::<4>(weights, "weights")?;
        if numbers.len() < count || weights.len() < count {
            return Err("it has fewer joints or weights than positions".into());
        }
        for ((sum, total), (numbers, weights)) in sums.iter_mut().zip(numbers.iter().zip(weights)) {
            for (number, weight) in numbers.iter().zip(weights) {
                if weight == 0.0 {
                    continue;
                }
                let joint = joints.get(*number as usize);
                let joint = joint.ok_or_else(|| format!("there is no joint {number}"))?;
                sum.matrix3 += joint.matrix3 * weight;
                sum.translation += joint.translation * weight;
                *total += weight;
            }
        }
        if set == 0 {
            first = numbers;
        }
    }
    if first.is_empty() {
        return Err("it has no joints and weights".into());
    }
    let whole = |((sum, total), numbers): ((DAffine3, f64), [f64; 4])| match total == 0.0 {
        true => {
            let joint = joints.get(numbers[0] as usize);
            joint.copied().ok_or_else(|| format!("there is no joint {}", numbers[0]).into())
        }
        false => Ok(DAffine3 {
            matrix3: sum.matrix3 * total.recip(),
            translation: sum.translation / total,
        }),
    };
    sums.into_iter().zip(first).map(whole).collect()
}
