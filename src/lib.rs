//! Point-light shadows from dual-paraboloid maps.
//!
//! The product is `wgsl/`: composable WGSL modules. [`MODULES`] holds their text and needs no
//! dependency. [`scalar`] holds the same functions in Rust. With the feature `naga`, [`mod@link`]
//! makes one plain WGSL text of the modules that a shader imports and [`mod@validate`] checks it;
//! with `gpu`, [`gpu`] evaluates any of the functions on an adapter and renders; `cli` adds the
//! program `dpsm`.
//!
//! ```
//! let paraboloid = dpsm::module("paraboloid").unwrap();
//! assert!(paraboloid.text.contains("fn dpsm_project"));
//! ```

#![warn(missing_docs)]

// sources that tests share name the crate
extern crate self as dpsm;

#[cfg(feature = "gpu")]
pub mod accuracy;
pub mod cases;
#[cfg(feature = "scene")]
pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "naga")]
pub mod link;
#[cfg(feature = "scene")]
pub mod measure;
#[cfg(feature = "scene")]
mod placement;
#[cfg(feature = "scene")]
pub mod plan;
#[cfg(feature = "naga")]
pub mod reflect;
#[cfg(feature = "scene")]
pub mod render;
#[cfg(feature = "cli")]
pub mod report;
pub mod scalar;
#[cfg(feature = "scene")]
pub mod scene;
#[cfg(feature = "scene")]
pub mod truth;
pub mod ulp;
#[cfg(feature = "naga")]
pub mod validate;

#[cfg(feature = "naga")]
pub use link::{Catalogue, LinkError, Linked, link, link_source};
#[cfg(feature = "naga")]
pub use validate::{ValidateError, Validated, validate};

/// One module's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Module {
    /// The name that imports use.
    pub name: &'static str,
    /// Path in the source tree, for messages.
    pub path: &'static str,
    /// WGSL with leading `import` lines (WESL).
    pub text: &'static str,
}

macro_rules! modules {
    ($($name:literal)+) => {
        /// Every module, each after those it imports.
        pub const MODULES: &[Module] = &[$(Module {
            name: $name,
            path: concat!("wgsl/", $name, ".wesl"),
            text: include_str!(concat!("../wgsl/", $name, ".wesl")),
        }),+];
    };
}
modules! {
    "light" "hemisphere" "paraboloid" "depth" "caster" "tessellate" "edge" "triangle" "classify"
    "refine" "part" "visibility" "bias" "plane" "cube" "kernel" "filter" "pcss" "raw" "lights" "shade"
}

/// The module of that name.
pub fn module(name: &str) -> Option<&'static Module> {
    MODULES.iter().find(|module| module.name == name)
}
