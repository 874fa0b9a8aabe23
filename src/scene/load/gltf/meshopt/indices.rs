//! Modes 1 and 2, triangles and indices.

use super::{Bytes, zigzag};

const TRIANGLES: u8 = 0xe1;
const SEQUENCE: u8 = 0xd1;
const TABLE: usize = 16;
const SEQUENCE_TAIL: usize = 4;

/// The last sixteen of something, the newest first.
struct Fifo<T>([Option<T>; 16]);

impl<T: Copy> Fifo<T> {
    fn push(&mut self, item: T) {
        self.0.rotate_right(1);
        self.0[0] = Some(item);
    }

    fn get(&self, age: u8) -> Option<T> {
        *self.0.get(usize::from(age))?
    }
}

struct Triangles<'a> {
    edges: Fifo<[u32; 2]>,
    vertices: Fifo<u32>,
    next: u32,
    last: u32,
    data: Bytes<'a>,
}

impl Triangles<'_> {
    fn fresh(&mut self) -> u32 {
        self.next = self.next.wrapping_add(1);
        self.next.wrapping_sub(1)
    }

    fn explicit(&mut self) -> Option<u32> {
        self.last = self.last.wrapping_add(zigzag(self.data.number()?));
        Some(self.last)
    }

    /// A vertex by four bits, and whether it is to be remembered.
    fn corner(&mut self, code: u8) -> Option<(u32, bool)> {
        Some(match code {
            0 => (self.fresh(), true),
            15 => (self.explicit()?, true),
            _ => (self.vertices.get(code - 1)?, false),
        })
    }

    /// A triangle on an edge that was seen before.
    fn on_edge(&mut self, edge: u8, code: u8) -> Option<[u32; 3]> {
        let [a, b] = self.edges.get(edge)?;
        let (c, is_new) = match code {
            0 => (self.fresh(), true),
            13 | 14 => {
                self.last = self.last.wrapping_add(if code == 13 { u32::MAX } else { 1 });
                (self.last, true)
            }
            15 => (self.explicit()?, true),
            _ => (self.vertices.get(code)?, false),
        };
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if is_new {
            self.vertices.push(c);
        }
        Some([a, b, c])
    }

    /// A triangle without one: the codes of its second and third corner are in a table or the data.
    fn apart(&mut self, code: u8, table: &[u8]) -> Option<[u32; 3]> {
        let pair = match code {
            14 | 15 => self.data.byte()?,
            _ => table[usize::from(code)],
        };
        if code >= 14 && pair == 0 {
            self.next = 0;
        }
        let a = if code == 15 { self.explicit()? } else { self.fresh() };
        let (b, b_is_new) = self.corner(pair >> 4)?;
        let (c, c_is_new) = self.corner(pair & 15)?;
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        self.vertices.push(a);
        for vertex in [(b, b_is_new), (c, c_is_new)] {
            if vertex.1 {
                self.vertices.push(vertex.0);
            }
        }
        Some([a, b, c])
    }
}

/// Indices of a list of triangles; `None` for a stream that ends early or cannot be.
pub(super) fn triangles(stream: &[u8], count: usize) -> Option<Vec<u32>> {
    let (&version, rest) = stream.split_first()?;
    if version != TRIANGLES || !count.is_multiple_of(3) {
        return None;
    }
    let (codes, rest) = rest.split_at_checked(count / 3)?;
    let (data, table) = rest.split_at_checked(rest.len().checked_sub(TABLE)?)?;
    let (edges, vertices) = (Fifo([None; 16]), Fifo([None; 16]));
    let mut state = Triangles { edges, vertices, next: 0, last: 0, data: Bytes(data) };
    let mut out = Vec::with_capacity(count);
    for &code in codes {
        out.extend(match (code >> 4, code & 15) {
            (15, low) => state.apart(low, table)?,
            (edge, low) => state.on_edge(edge, low)?,
        });
    }
    state.data.0.is_empty().then_some(out)
}

/// Indices of anything else.
pub(super) fn sequence(stream: &[u8], count: usize) -> Option<Vec<u32>> {
    let (&version, rest) = stream.split_first()?;
    let data = rest.get(..rest.len().checked_sub(SEQUENCE_TAIL)?)?;
    if version != SEQUENCE {
        return None;
    }
    let mut data = Bytes(data);
    let mut last = [0_u32; 2];
    let mut out = Vec::with_capacity(count);
    for _ in 0..count {
        let code = data.number()?;
        let last = &mut last[code as usize & 1];
        *last = last.wrapping_add(zigzag(code >> 1));
        out.push(*last);
    }
    data.0.is_empty().then_some(out)
}
