//! Whole numbers on the command line, with messages that say how to write them.

/// Parses a whole number from LOW to HIGH.
pub fn whole<const LOW: u64, const HIGH: u64>(text: &str) -> Result<u64, String> {
    let Ok(number) = text.parse::<u64>() else {
        return Err(match text.parse::<f64>() {
            Ok(number) if number >= 0.0 && number.fract() == 0.0 && number < 1e18 => {
                format!("`{text}` is not written as a whole number: give {}", number as u64)
            }
            _ => format!("`{text}` is not a whole number"),
        });
    };
    match (LOW..=HIGH).contains(&number) {
        true => Ok(number),
        false if HIGH == u64::MAX => Err(format!("`{text}` is not {LOW} or more")),
        false => Err(format!("`{text}` is not from {LOW} to {HIGH}")),
    }
}

/// The same of 32 bits.
pub fn whole32<const LOW: u64, const HIGH: u64>(text: &str) -> Result<u32, String> {
    let number = whole::<LOW, HIGH>(text)?;
    u32::try_from(number)
        .map_err(|_| format!("`{text}` is above {}, the most there can be", u32::MAX))
}

/// The largest of 32 bits.
pub const ANY: u64 = u32::MAX as u64;
