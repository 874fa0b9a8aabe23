//! In place of `draco` in a build without that feature.

use serde::Deserialize;

use super::buffers::Buffers;
use super::fault::Fault;

#[derive(Deserialize)]
pub(super) struct Packed {}

/// There is none.
pub(super) enum Decoded {}

impl Decoded {
    pub fn new(_: Packed, _: &Buffers) -> Result<Self, Fault> {
        Err("this program was built without the feature `draco`".into())
    }

    pub fn indices(&self) -> Vec<u32> {
        match *self {}
    }

    pub fn vectors<const N: usize>(
        &self,
        _: &str,
        _: bool,
    ) -> Result<Option<Vec<[f64; N]>>, Fault> {
        match *self {}
    }
}
