//! Which variants are worth having: those that no other beats in everything.

use super::data::Variant;

/// Generation, lookup, memory, misclassified: less is better.
fn costs(variant: &Variant) -> [f64; 4] {
    [
        variant.generation.median,
        variant.lookup.median,
        variant.bytes as f64,
        variant.error.misclassified(),
    ]
}

/// True where a is nowhere worse than b, and better somewhere.
fn dominates(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
}

/// Fills `dominated_by` of all variants of a scene, with the most exact of those that dominate and
/// are dominated by none. Variants that tie in everything dominate neither each other.
pub fn mark(variants: &mut [Variant]) {
    let costs: Vec<_> = variants.iter().map(costs).collect();
    let beaten = |of: usize| costs.iter().any(|other| dominates(other, &costs[of]));
    let front: Vec<usize> = (0..costs.len()).filter(|&i| !beaten(i)).collect();
    let by: Vec<Option<usize>> = (0..costs.len())
        .map(|i| {
            let better = front.iter().copied().filter(|&f| dominates(&costs[f], &costs[i]));
            better.min_by(|&a, &b| costs[a][3].total_cmp(&costs[b][3]))
        })
        .collect();
    for (i, by) in by.into_iter().enumerate() {
        variants[i].dominated_by = by.map_or(String::new(), |by| variants[by].name.clone());
    }
}

/// The points of a plot that no other beats on both axes, from left to right; of equal ones all.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let beaten = |&(x, y): &(f64, f64)| points.iter().any(|&(a, b)| dominates(&[a, b], &[x, y]));
    let mut front: Vec<usize> = (0..points.len()).filter(|&i| !beaten(&points[i])).collect();
    front.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0));
    front
}
