//! What the targets share: a panic that our functions catch is no finding, one that leaves them is.

use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::sync::Mutex;

/// The last panic's message and place.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Takes libFuzzer's hook out, which aborts at every panic, and keeps the message instead.
pub fn keep_panics() {
    set_hook(Box::new(|panic| {
        if let Ok(mut last) = PANIC.lock() {
            *last = panic.to_string();
        }
    }));
}

/// Runs one input; a panic that comes out of it aborts, which libFuzzer counts as a crash.
pub fn no_panic(run: impl FnOnce()) {
    if catch_unwind(AssertUnwindSafe(run)).is_err() {
        match PANIC.lock() {
            Ok(last) => eprintln!("a panic left our functions: {last}"),
            Err(_) => eprintln!("a panic left our functions"),
        }
        std::process::abort();
    }
}
