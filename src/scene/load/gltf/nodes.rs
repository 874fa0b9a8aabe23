//! The tree of nodes: which are shown, in which order, and where.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use serde::Deserialize;
use serde_json::value::RawValue;

use super::document::{Document, Extensions, extension};
use super::fault::Fault;

#[derive(Deserialize)]
pub(super) struct Node<'a> {
    pub name: Option<String>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub camera: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<DVec3>,
    rotation: Option<DQuat>,
    scale: Option<DVec3>,
    #[serde(borrow)]
    pub weights: Option<&'a RawValue>,
    #[serde(borrow, default)]
    pub extensions: Extensions<'a>,
}

impl Node<'_> {
    fn transform(&self) -> DAffine3 {
        match &self.matrix {
            Some(matrix) => DAffine3::from_mat4(DMat4::from_cols_array(matrix)),
            None => transform(
                self.translation.unwrap_or(DVec3::ZERO),
                self.rotation.unwrap_or(DQuat::IDENTITY),
                self.scale.unwrap_or(DVec3::ONE),
            ),
        }
    }
}

/// Translation times rotation times scale. A rotation is made unit length; one of length zero turns
/// nothing.
pub(super) fn transform(translation: DVec3, rotation: DQuat, scale: DVec3) -> DAffine3 {
    let length = rotation.length();
    let rotation = if length == 0.0 { DQuat::IDENTITY } else { rotation / length };
    DAffine3::from_scale_rotation_translation(scale, rotation, translation)
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Visibility {
    visible: Option<bool>,
}

/// A node of the scene, visible or not, as joints and cameras count even where nothing is shown.
pub(super) struct Placed<'a> {
    pub node: Node<'a>,
    pub visible: bool,
}

/// The nodes that a scene reaches, in their order, and where each node of the file is.
pub(super) struct Tree<'a> {
    pub shown: Vec<(usize, Placed<'a>)>,
    worlds: Vec<Option<DAffine3>>,
}

impl<'a> Tree<'a> {
    /// The nodes of the default scene, else of the first, else all nodes; each once.
    pub fn new(document: &Document<'a>) -> Result<Self, Fault> {
        let count = document.count("nodes");
        let mut tree = Self { shown: Vec::new(), worlds: vec![None; count] };
        let mut roots = match (document.scene, document.count("scenes")) {
            (Some(scene), _) => document.get::<Scene>("scenes", scene)?.nodes,
            (None, 1..) => document.get::<Scene>("scenes", 0)?.nodes,
            (None, 0) => Vec::new(),
        };
        if roots.is_empty() {
            roots = all_roots(document);
        }
        tree.shown = tree.reach(document, &roots)?;
        Ok(tree)
    }

    /// A stack, not recursion, and a mark: the file may be deep, or cyclic against the rules.
    fn reach(
        &mut self,
        document: &Document<'a>,
        roots: &[usize],
    ) -> Result<Vec<(usize, Placed<'a>)>, Fault> {
        let mut reached = Vec::new();
        let root = |&index: &usize| (index, DAffine3::IDENTITY, true);
        let mut stack: Vec<_> = roots.iter().rev().map(root).collect();
        while let Some((index, parent, visible)) = stack.pop() {
            if self.worlds.get(index).is_some_and(Option::is_some) {
                continue;
            }
            let node: Node = document.get("nodes", index)?;
            let world = parent * node.transform();
            self.worlds[index] = Some(world);
            let visible = visible && is_visible(&node);
            let children = node.children.iter().rev();
            stack.extend(children.map(|&child| (child, world, visible)));
            reached.push((index, Placed { node, visible }));
        }
        Ok(reached)
    }

    /// Where a node is that the scene has.
    pub fn world(&self, index: usize) -> Option<DAffine3> {
        *self.worlds.get(index)?
    }

    /// Finds also where the nodes are that the scene has not: a skin may have its joints there.
    pub fn place_others(&mut self, document: &Document<'a>) -> Result<(), Fault> {
        self.reach(document, &all_roots(document)).map(drop)
    }
}

/// What cannot be read is shown: it was before there was such an extension.
fn is_visible(node: &Node) -> bool {
    let found = extension::<Visibility>(&node.extensions, "KHR_node_visibility");
    found.ok().flatten().and_then(|visibility| visibility.visible).unwrap_or(true)
}

/// Nodes that are nobody's child.
fn all_roots(document: &Document) -> Vec<usize> {
    let count = document.count("nodes");
    let mut is_root = vec![true; count];
    for index in 0..count {
        // those that cannot be read are named where they are needed
        let Ok(node) = document.get::<Node>("nodes", index) else { continue };
        for child in node.children {
            if let Some(root) = is_root.get_mut(child) {
                *root = false;
            }
        }
    }
    (0..count).filter(|&index| is_root[index]).collect()
}
