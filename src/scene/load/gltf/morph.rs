//! Morph targets by the weights that the file gives (glTF 2.0, 3.7.2.2).

use std::collections::HashMap;

use serde_json::value::RawValue;

use super::accessor::Accessors;
use super::document::of_text;
use super::fault::Fault;

/// The targets of a primitive that count, and by how much.
#[derive(Default)]
pub(super) struct Morph {
    targets: Vec<(HashMap<String, usize>, f64)>,
}

impl Morph {
    /// By the node's weights, else by the mesh's; missing ones are 0.
    pub fn new(
        targets: Option<&RawValue>,
        node: Option<&RawValue>,
        mesh: Option<&RawValue>,
    ) -> Result<Self, Fault> {
        let (Some(targets), Some(weights)) = (targets, node.or(mesh)) else {
            return Ok(Self::default());
        };
        let targets: Vec<HashMap<String, usize>> = of_text(targets)?;
        let weights: Vec<f64> = of_text(weights)?;
        let pairs = targets.into_iter().zip(weights);
        Ok(Self { targets: pairs.filter(|(_, weight)| *weight != 0.0).collect() })
    }

    /// Adds what the targets do to one attribute.
    pub fn add<const N: usize>(
        &self,
        attribute: &str,
        to: &mut [[f64; N]],
        accessors: &Accessors,
    ) -> Result<(), Fault> {
        for (target, weight) in &self.targets {
            let Some(&index) = target.get(attribute) else { continue };
            // before they are read: those without a view may claim any number
            if accessors.get(index)?.count != to.len() {
                return Err("a morph target has another number of vertices".into());
            }
            let moves = accessors.vectors::<N>(index, "morph targets")?;
            for (value, by) in to.iter_mut().zip(moves) {
                for (value, by) in value.iter_mut().zip(by) {
                    *value += by * weight;
                }
            }
        }
        Ok(())
    }
}
