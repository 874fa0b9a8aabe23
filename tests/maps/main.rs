//! The maps of the paraboloid methods: against ray casting, against the ports, and on bad input.

#![cfg(feature = "gpu")]

#[path = "../common/mod.rs"]
mod common;

mod bad_input;
mod many;
mod masks;
mod meshes;
mod ports;
mod right;
mod rim;
mod room;
mod same;
mod support;
mod texels;
mod watertight;
