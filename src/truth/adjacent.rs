//! Which triangles touch: corners at equal positions are one, whatever mesh they belong to.

use std::collections::{HashMap, HashSet, VecDeque};

use glam::DVec3;

/// The triangles around each position.
#[derive(Clone, Debug)]
pub(super) struct Adjacent {
    /// The positions of a triangle's corners, by number.
    corners: Vec<[u32; 3]>,
    /// Where a position's triangles begin in `around`, and at the end where the last ones end.
    starts: Vec<u32>,
    around: Vec<u32>,
}

impl Adjacent {
    /// Of triangles whose corners may be NaN: those touch nothing.
    pub(super) fn new(triangles: &[[DVec3; 3]]) -> Self {
        // adding 0 makes -0 a 0
        let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let mut numbers = HashMap::with_capacity(triangles.len());
        let mut number = |p: DVec3| {
            let next = numbers.len() as u32;
            *numbers.entry(key(p)).or_insert(next)
        };
        let corners: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(&mut number)).collect();
        let mut starts = vec![0; numbers.len() + 1];
        let usable = |triangle: &[DVec3; 3]| !triangle[0].is_nan();
        let used = || (0..).zip(triangles.iter().zip(&corners)).filter(|(_, (t, _))| usable(t));
        for corner in used().flat_map(|(_, (_, corners))| corners) {
            starts[*corner as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut around = vec![0; starts.last().map_or(0, |end| *end as usize)];
        for (index, (_, corners)) in used() {
            for corner in corners {
                let place = &mut next[*corner as usize];
                around[*place as usize] = index;
                *place += 1;
            }
        }
        Self { corners, starts, around }
    }

    fn around(&self, corner: u32) -> &[u32] {
        let [from, to] = [0, 1].map(|next| self.starts[corner as usize + next] as usize);
        &self.around[from..to]
    }

    /// The triangle and those that are reached from it over edges and corners of which some point
    /// is within `radius` of `centre`.
    pub(super) fn connected(
        &self,
        triangles: &[[DVec3; 3]],
        triangle: u32,
        centre: DVec3,
        radius: f64,
    ) -> HashSet<u32> {
        let mut found = HashSet::from([triangle]);
        let mut open = VecDeque::from([triangle]);
        while let Some(from) = open.pop_front() {
            let own = self.corners[from as usize];
            let positions = triangles[from as usize];
            for (k, corner) in own.into_iter().enumerate() {
                for &to in self.around(corner) {
                    if found.contains(&to) {
                        continue;
                    }
                    // the corner, or the edges from it that both have
                    let other = self.corners[to as usize];
                    let ends = (0..3).filter(|j| other.contains(&own[*j]));
                    let meets = |j: usize| distance(centre, positions[k], positions[j]) <= radius;
                    if ends.into_iter().any(meets) {
                        found.insert(to);
                        open.push_back(to);
                    }
                }
            }
        }
        found
    }
}

/// From a point to a piece of a line, whose ends may be one.
fn distance(point: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let share = (point - a).dot(along) / along.length_squared();
    // not a number where both ends are one
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    point.distance(a + along * share)
}
