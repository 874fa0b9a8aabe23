//! Accessors: numbers of any type that the format and KHR_mesh_quantization allow, sparse ones, and
//! those without a view, which are zeros.

use std::cell::Cell;

use serde::Deserialize;

use super::buffers::{Buffers, OUTSIDE, View};
use super::document::Extensions;
use super::fault::Fault;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor<'a> {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    shape: String,
    sparse: Option<Sparse>,
    #[serde(borrow, default)]
    extensions: Extensions<'a>,
}

#[derive(Deserialize)]
struct Sparse {
    count: usize,
    indices: SparseIndices,
    values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SparseIndices {
    buffer_view: usize,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SparseValues {
    buffer_view: usize,
    #[serde(default)]
    byte_offset: usize,
}

/// The format's component types; 64-bit floats are of KHR_accessor_float64.
#[derive(Clone, Copy)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
    F64,
}

impl Component {
    fn new(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            5130 => Self::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number at the start of some bytes, of which there are enough.
    fn read(self, bytes: &[u8]) -> f64 {
        fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
            *bytes.first_chunk().expect("as many bytes as the type has")
        }
        match self {
            Self::I8 => i8::from_le_bytes(first(bytes)).into(),
            Self::U8 => bytes[0].into(),
            Self::I16 => i16::from_le_bytes(first(bytes)).into(),
            Self::U16 => u16::from_le_bytes(first(bytes)).into(),
            Self::U32 => u32::from_le_bytes(first(bytes)).into(),
            Self::F32 => f32::from_le_bytes(first(bytes)).into(),
            Self::F64 => f64::from_le_bytes(first(bytes)),
        }
    }

    /// What a normalised integer stands for (glTF 2.0, 3.6.2.2): its largest value is 1.
    fn normalized(self, value: f64) -> f64 {
        let largest = match self {
            Self::I8 => f64::from(i8::MAX),
            Self::U8 => f64::from(u8::MAX),
            Self::I16 => f64::from(i16::MAX),
            Self::U16 => f64::from(u16::MAX),
            Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => return value,
        };
        (value / largest).max(-1.0)
    }

    /// The vector at the start of some bytes, if there are as many.
    pub fn vector<const N: usize>(self, bytes: &[u8], normalized: bool) -> Option<[f64; N]> {
        let bytes = bytes.get(..N * self.size())?;
        Some(std::array::from_fn(|i| {
            let value = self.read(&bytes[i * self.size()..]);
            if normalized { self.normalized(value) } else { value }
        }))
    }
}

/// Most elements of all accessors of a file that have no view: a few bytes can claim any number.
const MOST_ZEROS: usize = 1 << 22;

/// A file's accessors, and how many zeros they have made.
pub(super) struct Accessors<'a> {
    pub buffers: &'a Buffers<'a>,
    zeros: Cell<usize>,
}

impl<'a> Accessors<'a> {
    pub fn new(buffers: &'a Buffers<'a>) -> Self {
        Self { buffers, zeros: Cell::new(0) }
    }

    pub fn get(&self, index: usize) -> Result<Accessor<'a>, Fault> {
        let accessor: Accessor = self.buffers.document.get("accessors", index)?;
        self.buffers.document.check(&accessor.extensions)?;
        Ok(accessor)
    }

    /// Vectors or matrices of N components, as f64; `what` names them in an error.
    pub fn vectors<const N: usize>(
        &self,
        index: usize,
        what: &str,
    ) -> Result<Vec<[f64; N]>, Fault> {
        // others name a part of the file themselves
        let is_theirs = |fault: &str| fault.starts_with("have ") || fault.starts_with("lie ");
        let named = |fault: Fault| match fault {
            Fault::Text(fault) if is_theirs(&fault) => Fault::Text(format!("its {what} {fault}")),
            other => other,
        };
        let accessor = self.get(index)?;
        self.numbers(&accessor, shape_of(N)).map_err(named)
    }

    /// Whole numbers that are no f32, f64 or signed.
    pub fn integers(&self, index: usize, what: &str) -> Result<Vec<u32>, Fault> {
        if !matches!(self.get(index)?.component_type, 5121 | 5123 | 5125) {
            return Err(format!("its {what} have an unexpected type").into());
        }
        let numbers = self.vectors::<1>(index, what)?;
        Ok(numbers.into_iter().map(|[number]| number as u32).collect())
    }

    fn numbers<const N: usize>(
        &self,
        accessor: &Accessor,
        shape: &str,
    ) -> Result<Vec<[f64; N]>, Fault> {
        let Some(component) = Component::new(accessor.component_type) else {
            return Err("have an unexpected type".into());
        };
        if accessor.shape != shape {
            return Err("have an unexpected type".into());
        }
        if accessor.count == 0 {
            return Err("have the length 0".into());
        }
        let element = |bytes: &[u8]| {
            let vector = component.vector(bytes, accessor.normalized);
            vector.expect("as many bytes as an element has")
        };
        let size = N * component.size();
        let mut numbers = match accessor.buffer_view {
            None => self.zeros(accessor.count)?,
            Some(index) => {
                let view = self.buffers.view(index)?;
                elements(&view, accessor.byte_offset, size, accessor.count)?.map(element).collect()
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let values = self.buffers.view(sparse.values.buffer_view)?.touching();
            let values = elements(&values, sparse.values.byte_offset, size, sparse.count)?;
            for (index, value) in self.sparse_indices(sparse)?.into_iter().zip(values) {
                let number = numbers.get_mut(index as usize);
                *number.ok_or("have a sparse index out of range")? = element(value);
            }
        }
        Ok(numbers)
    }

    fn zeros<const N: usize>(&self, count: usize) -> Result<Vec<[f64; N]>, Fault> {
        let all = self.zeros.get().saturating_add(count);
        self.zeros.set(all);
        match all > MOST_ZEROS {
            true => {
                let what = format!("have no buffer view: a file may claim {MOST_ZEROS} zeros");
                Err(format!("{what}, and this one claims {all}").into())
            }
            false => Ok(vec![[0.0; N]; count]),
        }
    }

    fn sparse_indices(&self, sparse: &Sparse) -> Result<Vec<u32>, Fault> {
        let Sparse { count, indices, .. } = sparse;
        let component = Component::new(indices.component_type);
        let component = component.ok_or("have sparse indices of an unexpected type")?;
        let view = self.buffers.view(indices.buffer_view)?.touching();
        let bytes = elements(&view, indices.byte_offset, component.size(), *count)?;
        Ok(bytes.map(|bytes| component.read(bytes) as u32).collect())
    }
}

/// An accessor's name for vectors of so many components.
fn shape_of(components: usize) -> &'static str {
    match components {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        4 => "VEC4",
        _ => "MAT4",
    }
}

/// The bytes of each of `count` elements of a size, all of which lie in the view.
fn elements(
    view: &View,
    offset: usize,
    size: usize,
    count: usize,
) -> Result<impl Iterator<Item = &[u8]>, Fault> {
    let stride = view.stride.unwrap_or(size);
    let last = count.saturating_sub(1).checked_mul(stride);
    let end = last.and_then(|last| last.checked_add(offset)?.checked_add(size));
    let bytes = view.bytes();
    if count > 0 && end.is_none_or(|end| end > bytes.len()) {
        return Err(OUTSIDE.into());
    }
    Ok((0..count).map(move |i| &bytes[offset + i * stride..][..size]))
}
