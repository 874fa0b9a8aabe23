//! The arithmetic that the ports are generic over, and the vectors built on it.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number type that a port can run on: f32 mirrors the shader, f64 is the reference, an interval
/// ([`super::interval::Interval`]) holds what any adapter may answer.
///
/// Only IEEE operations, so results are the same on every machine.
pub trait Float:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A constant; rounded to the nearest value of the type.
    fn lit(value: f64) -> Self;
    /// The value in f64.
    fn value(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The larger one.
    fn max(self, other: Self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// The largest whole number that is not above.
    fn floor(self) -> Self;
    /// The smallest whole number that is not below.
    fn ceil(self) -> Self;
    /// The whole number that is left without the fraction; 0 below 0.
    fn to_integer(self) -> u32 {
        self.value() as u32
    }
    /// The sum of a dot product's terms, from left to right.
    fn sum<const N: usize>(terms: [Self; N]) -> Self {
        let [first, rest @ ..] = &terms[..] else { return Self::lit(0.0) };
        rest.iter().fold(*first, |sum, &term| sum + term)
    }
    /// WGSL's clamp.
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

macro_rules! float {
    ($t:ty) => {
        impl Float for $t {
            fn lit(value: f64) -> Self {
                value as $t
            }
            fn value(self) -> f64 {
                self as f64
            }
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            fn abs(self) -> Self {
                self.abs()
            }
            fn max(self, other: Self) -> Self {
                self.max(other)
            }
            fn min(self, other: Self) -> Self {
                self.min(other)
            }
            fn floor(self) -> Self {
                self.floor()
            }
            fn ceil(self) -> Self {
                self.ceil()
            }
        }
    };
}
float!(f32);
float!(f64);

macro_rules! vector {
    ($(#[$doc:meta])* $name:ident { $($c:ident),+ }) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $name<T> {
            $(
                #[allow(missing_docs)]
                pub $c: T,
            )+
        }

        impl<T: Float> $name<T> {
            /// The vector with these components.
            pub fn new($($c: T),+) -> Self {
                Self { $($c),+ }
            }

            /// The vector with every component `value`.
            pub fn splat(value: T) -> Self {
                Self { $($c: value),+ }
            }

            /// The smaller of each component.
            pub fn min(self, other: Self) -> Self {
                Self { $($c: self.$c.min(other.$c)),+ }
            }

            /// The larger of each component.
            pub fn max(self, other: Self) -> Self {
                Self { $($c: self.$c.max(other.$c)),+ }
            }

            /// Each component's largest whole number that is not above.
            pub fn floor(self) -> Self {
                Self { $($c: self.$c.floor()),+ }
            }

            /// Each component's smallest whole number that is not below.
            pub fn ceil(self) -> Self {
                Self { $($c: self.$c.ceil()),+ }
            }

            /// WGSL's dot product, summed from left to right.
            pub fn dot(self, other: Self) -> T {
                T::sum([$(self.$c * other.$c),+])
            }

            /// WGSL's length: the root of the dot product with itself.
            pub fn length(self) -> T {
                self.dot(self).sqrt()
            }
        }

        impl $name<f32> {
            /// The same vector in f64.
            pub fn widen(self) -> $name<f64> {
                $name { $($c: self.$c.into()),+ }
            }
        }

        impl $name<f64> {
            /// The nearest vector in f32.
            pub fn narrow(self) -> $name<f32> {
                $name { $($c: self.$c as f32),+ }
            }
        }

        vector!(@each $name { $($c),+ } Add add +, Sub sub -, Mul mul *);

        impl<T: Float> Neg for $name<T> {
            type Output = Self;
            fn neg(self) -> Self {
                Self { $($c: -self.$c),+ }
            }
        }

        impl<T: Float> Mul<T> for $name<T> {
            type Output = Self;
            fn mul(self, k: T) -> Self {
                Self { $($c: self.$c * k),+ }
            }
        }

        impl<T: Float> Div<T> for $name<T> {
            type Output = Self;
            fn div(self, k: T) -> Self {
                Self { $($c: self.$c / k),+ }
            }
        }
    };
    (@each $name:ident $fields:tt $($op:ident $f:ident $sign:tt),+) => {
        $( vector!(@one $name $fields $op $f $sign); )+
    };
    (@one $name:ident { $($c:ident),+ } $op:ident $f:ident $sign:tt) => {
        impl<T: Float> $op for $name<T> {
            type Output = Self;
            fn $f(self, other: Self) -> Self {
                Self { $($c: self.$c $sign other.$c),+ }
            }
        }
    };
}
vector! {
    /// WGSL's vec2.
    Vec2 { x, y }
}
vector! {
    /// WGSL's vec3.
    Vec3 { x, y, z }
}
vector! {
    /// WGSL's vec4.
    Vec4 { x, y, z, w }
}

#[cfg(feature = "gpu")]
mod bytes {
    use super::{Vec2, Vec3, Vec4};

    macro_rules! pod {
        ($($name:ident: $words:literal),+) => {$(
            const _: () = assert!(size_of::<$name<f32>>() == 4 * $words);
            // SAFETY: repr(C), every member an f32, and no padding by the size above.
            unsafe impl bytemuck::Zeroable for $name<f32> {}
            // SAFETY: as above; any bits are an f32.
            unsafe impl bytemuck::Pod for $name<f32> {}
        )+};
    }
    pod!(Vec2: 2, Vec3: 3, Vec4: 4);
}

impl<T: Float> Vec3<T> {
    /// The swizzle `xy`.
    pub fn xy(self) -> Vec2<T> {
        Vec2::new(self.x, self.y)
    }

    /// WGSL's cross product.
    pub fn cross(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
    }

    /// The vec4 with w behind.
    pub fn extend(self, w: T) -> Vec4<T> {
        Vec4::new(self.x, self.y, self.z, w)
    }
}

impl<T: Float> Vec4<T> {
    /// The swizzle `xyz`.
    pub fn xyz(self) -> Vec3<T> {
        Vec3::new(self.x, self.y, self.z)
    }

    /// The swizzle `xy`.
    pub fn xy(self) -> Vec2<T> {
        Vec2::new(self.x, self.y)
    }

    /// The swizzle `zw`.
    pub fn zw(self) -> Vec2<T> {
        Vec2::new(self.z, self.w)
    }

    /// The components in their order.
    pub fn to_array(self) -> [T; 4] {
        [self.x, self.y, self.z, self.w]
    }

    /// The vector of four components in their order.
    pub fn from_array([x, y, z, w]: [T; 4]) -> Self {
        Self::new(x, y, z, w)
    }
}

/// WGSL's select: `yes` where the condition holds.
pub fn select<V>(no: V, yes: V, condition: bool) -> V {
    if condition { yes } else { no }
}
