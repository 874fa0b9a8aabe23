//! Scalar ports: each module of `wgsl/` again in Rust, under the same names and in the same order,
//! generic over the float type. At f32 they mirror the shader, at f64 they are the reference.
//!
//! Domains and bounds are those of the WGSL functions; no dependency is needed.
//!
//! ```
//! use dpsm::scalar::{float::Vec3, paraboloid::dpsm_project};
//! let rim = dpsm_project(Vec3::new(3.0_f64, 4.0, 0.0));
//! assert_eq!((rim.x, rim.y), (0.6, 0.8));
//! ```

pub mod bias;
pub mod bounds;
pub mod caster;
pub mod classify;
pub mod cube;
pub mod depth;
pub mod edge;
pub mod filter;
pub mod float;
pub mod hemisphere;
pub mod interval;
pub mod kernel;
pub mod light;
pub mod lights;
pub mod maps;
pub mod paraboloid;
pub mod part;
pub mod pcss;
pub mod plane;
pub mod ports;
pub mod raw;
pub mod refine;
pub mod shade;
pub mod tessellate;
pub mod triangle;
pub mod visibility;
