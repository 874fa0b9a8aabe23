//! How far a shadow's edge may be from its place.

use std::f64::consts::FRAC_PI_4;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::render::guard_band;

/// The map that `texel` is a texel of.
pub const TEXEL_OF: u32 = 1024;

/// The error that a plan may have: how far from the true shadow edge a point may be that is lit
/// wrongly, seen from the light.
///
/// ```
/// use dpsm::plan::Target;
///
/// let tenth: Target = "0.1deg".parse()?;
/// assert_eq!(tenth, Target::Degrees(0.1));
/// assert_eq!("0.5texel".parse(), Ok(Target::Texels(0.5)));
/// assert_eq!("0.002".parse(), Ok(Target::Units(0.002)));
/// assert_eq!(tenth.to_string(), "0.1deg");
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Target {
    /// Texels of a map of [`TEXEL_OF`] a side, at its middle, where they are widest.
    Texels(f64),
    /// World units across the light's ray, at the receiver.
    Units(f64),
    /// Degrees.
    Degrees(f64),
}

impl Target {
    /// The angle in radians that is allowed at a distance from the light, at most 45 degrees.
    pub fn angle(self, distance: f64) -> f64 {
        let angle = match self {
            Self::Texels(texels) => texels * texel(),
            Self::Units(units) => (units / distance).atan(),
            Self::Degrees(degrees) => degrees.to_radians(),
        };
        angle.min(FRAC_PI_4)
    }

    /// True of an angle of more than 45 degrees.
    pub fn is_capped(self) -> bool {
        match self {
            Self::Texels(texels) => texels * texel() > FRAC_PI_4,
            Self::Units(_) => false,
            Self::Degrees(degrees) => degrees.to_radians() > FRAC_PI_4,
        }
    }

    /// The number before the unit.
    pub fn value(self) -> f64 {
        let (Self::Texels(value) | Self::Units(value) | Self::Degrees(value)) = self;
        value
    }

    /// The same with another number.
    pub fn with(self, value: f64) -> Self {
        match self {
            Self::Texels(_) => Self::Texels(value),
            Self::Units(_) => Self::Units(value),
            Self::Degrees(_) => Self::Degrees(value),
        }
    }

    /// As text with three significant digits.
    pub fn short(self) -> String {
        let value = self.value();
        let digits = (2.0 - value.abs().max(f64::MIN_POSITIVE).log10().floor()).clamp(0.0, 12.0);
        format!("{value:.*}{}", digits as usize, self.unit())
    }

    fn unit(self) -> &'static str {
        match self {
            Self::Texels(_) => "texel",
            Self::Units(_) => "",
            Self::Degrees(_) => "deg",
        }
    }
}

/// The angle of the texel that counts.
fn texel() -> f64 {
    4.0 * f64::from(1.0 + guard_band(TEXEL_OF)) / f64::from(TEXEL_OF)
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.value(), self.unit())
    }
}

impl From<Target> for String {
    fn from(target: Target) -> Self {
        target.to_string()
    }
}

impl TryFrom<String> for Target {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl FromStr for Target {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        type Make = fn(f64) -> Target;
        let units: [(&str, Make); 3] =
            [("texels", Self::Texels), ("texel", Self::Texels), ("deg", Self::Degrees)];
        let found = units.iter().find_map(|(unit, make)| Some((text.strip_suffix(unit)?, *make)));
        let (number, make) = found.unwrap_or((text, Self::Units));
        match number.trim().parse::<f64>() {
            Ok(value) if value.is_finite() && value > 0.0 => Ok(make(value)),
            _ => Err(format!(
                "`{text}` is no error above 0: give world units (0.002), 0.5texel or 0.1deg"
            )),
        }
    }
}
