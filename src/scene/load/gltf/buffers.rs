//! Buffers and views of them. A buffer is read when the first view of it is: those that nothing
//! needs may be missing.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::rc::Rc;

use serde::Deserialize;

use super::document::{Document, Extensions, extension};
use super::fault::Fault;
use super::meshopt;
use crate::scene::SceneError;
use crate::scene::load::named;

pub(super) struct Buffers<'a> {
    pub document: &'a Document<'a>,
    path: &'a Path,
    bin: Option<&'a [u8]>,
    read: RefCell<HashMap<usize, Rc<Vec<u8>>>>,
    decompressed: RefCell<HashMap<usize, Rc<Vec<u8>>>>,
}

/// A range of a buffer.
#[derive(Clone)]
pub(super) struct View {
    data: Rc<Vec<u8>>,
    range: Range<usize>,
    /// Bytes from element to element; `None` where they touch.
    pub stride: Option<usize>,
}

impl View {
    pub fn bytes(&self) -> &[u8] {
        &self.data[self.range.clone()]
    }

    /// The same for elements that touch, as those of sparse accessors do.
    pub fn touching(self) -> Self {
        Self { stride: None, ..self }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer<'a> {
    uri: Option<String>,
    #[serde(default)]
    byte_length: usize,
    #[serde(borrow, default)]
    extensions: Extensions<'a>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct BufferView<'a> {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
    #[serde(borrow, default)]
    extensions: Extensions<'a>,
}

const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

impl<'a> Buffers<'a> {
    pub fn new(document: &'a Document<'a>, path: &'a Path, bin: Option<&'a [u8]>) -> Self {
        let (read, decompressed) = Default::default();
        Self { document, path, bin, read, decompressed }
    }

    /// A view's bytes, decompressed where it is compressed.
    pub fn view(&self, index: usize) -> Result<View, Fault> {
        let view: BufferView = self.document.get("bufferViews", index)?;
        self.document.check(&view.extensions)?;
        let stride = view.byte_stride.filter(|&stride| stride > 0);
        for name in MESHOPT {
            let Some(packed) = extension::<meshopt::Packed>(&view.extensions, name)? else {
                continue;
            };
            match self.decompressed(index, &packed) {
                Ok(data) => return Ok(View { range: 0..data.len(), data, stride }),
                // the format allows for the data as it is, beside the compressed
                Err(fault) if self.is_placeholder(view.buffer) => {
                    return Err(match fault {
                        Fault::Text(what) => format!("{name}: {what}").into(),
                        other => other,
                    });
                }
                Err(_) => {}
            }
        }
        self.part(view.buffer, view.byte_offset, view.byte_length, stride)
    }

    fn part(
        &self,
        buffer: usize,
        offset: usize,
        length: usize,
        stride: Option<usize>,
    ) -> Result<View, Fault> {
        let data = self.buffer(buffer)?;
        let end = offset.checked_add(length).filter(|&end| end <= data.len());
        let end = end.ok_or(Fault::Text(String::from(OUTSIDE)))?;
        Ok(View { data, range: offset..end, stride })
    }

    fn decompressed(&self, index: usize, packed: &meshopt::Packed) -> Result<Rc<Vec<u8>>, Fault> {
        if let Some(known) = self.decompressed.borrow().get(&index) {
            return Ok(known.clone());
        }
        let view = self.part(packed.buffer, packed.byte_offset, packed.byte_length, None)?;
        let data = Rc::new(meshopt::unpack(packed, view.bytes())?);
        self.decompressed.borrow_mut().insert(index, data.clone());
        Ok(data)
    }

    /// True for a buffer that only says how much space the decompressed data take.
    fn is_placeholder(&self, index: usize) -> bool {
        let buffer = self.document.get::<Buffer>("buffers", index);
        buffer.is_ok_and(|buffer| {
            let marked = MESHOPT.iter().any(|name| buffer.extensions.contains_key(*name));
            buffer.uri.is_none() && (marked || index > 0 || self.bin.is_none())
        })
    }

    /// A buffer's bytes, from the file itself, a data URI or another file.
    fn buffer(&self, index: usize) -> Result<Rc<Vec<u8>>, Fault> {
        if let Some(known) = self.read.borrow().get(&index) {
            return Ok(known.clone());
        }
        let buffer: Buffer = self.document.get("buffers", index)?;
        self.document.check(&buffer.extensions)?;
        let name = match &buffer.uri {
            None => "BIN chunk",
            Some(uri) if uri.starts_with("data:") => "data URI",
            Some(uri) => uri,
        };
        let error = |what: String| {
            let (path, uri) = (self.path.into(), name.into());
            Fault::Scene(SceneError::Buffer { path, uri, what })
        };
        let mut data = match &buffer.uri {
            Some(uri) => named::of_uri(uri, self.path.parent()).map_err(error)?,
            None => self.bin.ok_or_else(|| error("there is none".into()))?.to_vec(),
        };
        // lengths that count the padding of a multiple of 4 are common
        data.resize(data.len().next_multiple_of(4), 0);
        if data.len() < buffer.byte_length {
            let (is, wants) = (data.len(), buffer.byte_length);
            return Err(error(format!("it has {is} bytes of {wants}")));
        }
        let data = Rc::new(data);
        self.read.borrow_mut().insert(index, data.clone());
        Ok(data)
    }
}

/// Of a view or an accessor.
pub(super) const OUTSIDE: &str = "lie outside their buffer";
