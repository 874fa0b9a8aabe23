//! Native Rust that naga-rust-embed makes of the same WGSL: no driver, and arithmetic as written.
//!
//! `native.wgsl` and `native_calls.rs` are generated and kept in step by tests/native.rs.

use naga_rust_embed::rt::{Scalar, Vec2, Vec3, Vec4};

// constructors take all members, and constants stand as WGSL has them
#[allow(clippy::approx_constant, clippy::too_many_arguments)]
mod wgsl {
    // what naga-rust-embed's runtime lacks, found where its own methods are looked up
    use super::{FirstLeadingBit as _, SquareRoot as _, Swizzle as _};

    naga_rust_embed::include_wgsl_mr!(
        public_items = true,
        "benches/accuracy/implementation/native.wgsl"
    );
}
use wgsl::*;

/// WGSL's `sqrt` of a scalar.
trait SquareRoot {
    fn sqrt(self) -> Self;
}
impl SquareRoot for Scalar<f32> {
    fn sqrt(self) -> Self {
        Scalar(self.0.sqrt())
    }
}

/// WGSL's `firstLeadingBit`.
trait FirstLeadingBit {
    #[allow(non_snake_case)]
    fn firstLeadingBit(self) -> Self;
}
impl FirstLeadingBit for Scalar<u32> {
    fn firstLeadingBit(self) -> Self {
        Scalar(self.0.checked_ilog2().unwrap_or(u32::MAX))
    }
}

/// A swizzle that starts in the middle.
trait Swizzle {
    fn zw(self) -> Vec2<f32>;
}
impl Swizzle for Vec4<f32> {
    fn zw(self) -> Vec2<f32> {
        Vec2 { x: self.z, y: self.w }
    }
}

/// A value as a list of 32-bit words.
trait Words {
    fn read(words: &mut impl Iterator<Item = u32>) -> Self;
    fn write(self, words: &mut Vec<u32>);
}

macro_rules! scalar {
    ($($t:ty: $read:expr, $write:expr;)+) => {$(
        impl Words for $t {
            fn read(words: &mut impl Iterator<Item = u32>) -> Self {
                $read(words.next().expect("whole records"))
            }
            fn write(self, words: &mut Vec<u32>) {
                words.push($write(self));
            }
        }
    )+};
}
scalar! {
    f32: f32::from_bits, f32::to_bits;
    u32: u32::from, u32::from;
    bool: |word| word != 0, u32::from;
}

macro_rules! vector {
    ($($name:ident { $($member:ident),+ })+) => {$(
        impl<T: Words> Words for $name<T> {
            fn read(words: &mut impl Iterator<Item = u32>) -> Self {
                Self { $($member: Words::read(words)),+ }
            }
            fn write(self, words: &mut Vec<u32>) {
                $( self.$member.write(words); )+
            }
        }
    )+};
}
vector! {
    Vec2 { x, y }
    Vec3 { x, y, z }
    Vec4 { x, y, z, w }
}

impl<T: Words, const N: usize> Words for [T; N] {
    fn read(words: &mut impl Iterator<Item = u32>) -> Self {
        std::array::from_fn(|_| T::read(words))
    }
    fn write(self, words: &mut Vec<u32>) {
        self.into_iter().for_each(|part| part.write(words));
    }
}

macro_rules! structs {
    ($($name:ident { $($member:ident),+ })+) => {$(
        impl Words for $name {
            fn read(words: &mut impl Iterator<Item = u32>) -> Self {
                Self { $($member: Words::read(words)),+ }
            }
            fn write(self, words: &mut Vec<u32>) {
                $( self.$member.write(words); )+
            }
        }
    )+};
}

macro_rules! calls {
    ($($function:ident($($argument:ty),+))+) => {
        /// A function on every record of flat words; `None` for one that is left out.
        pub fn call(function: &str, words: &[u32]) -> Option<Vec<u32>> {
            let mut words = words.iter().copied().peekable();
            let mut results = Vec::new();
            match function {
                $(stringify!($function) => while words.peek().is_some() {
                    $function($(<$argument>::read(&mut words)),+).write(&mut results);
                })+
                _ => return None,
            }
            Some(results)
        }
    };
}

include!("native_calls.rs");
