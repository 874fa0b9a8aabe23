//! Faults of the host: no adapter, one that lacks something, one that is lost, out of memory, or
//! hangs, and places that cannot be written. docs/faults.md lists what the program does.

#![cfg(feature = "cli")]

#[path = "../common/mod.rs"]
mod common;
mod hang;
mod limits;
mod lost;
mod memory;
mod no_adapter;
mod outputs;
mod support;
