//! Text and numbers for HTML.

/// Text where HTML or SVG may not see its own characters in it.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // no document holds these, escaped or not
            c if c.is_control() && c != '\n' && c != '\t' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// A name as part of an id: letters, digits and hyphens.
pub fn slug(name: &str) -> String {
    let word = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' };
    let words: String = name.chars().map(word).collect();
    words.split_whitespace().collect::<Vec<_>>().join("-")
}

/// Three digits that count; a dash for what is no number.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_string();
    }
    if value == 0.0 {
        return "0".to_string();
    }
    let text = format!("{value:.2e}");
    let exponent: i32 = text.rsplit('e').next().and_then(|e| e.parse().ok()).unwrap_or(0);
    match exponent {
        -4..=2 => format!("{value:.*}", (2 - exponent) as usize),
        3..=14 => grouped(value.round() as i64),
        _ => text,
    }
}

/// A count with commas between thousands.
pub fn count(value: impl TryInto<i64>) -> String {
    grouped(value.try_into().unwrap_or(i64::MAX))
}

fn grouped(value: i64) -> String {
    let digits = value.unsigned_abs().to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    if value < 0 { format!("−{out}") } else { out }
}

/// A share as a percentage.
pub fn percent(share: f64) -> String {
    format!("{}%", number(share * 100.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_three_digits() {
        let texts = [0.0, 1.5, 0.012345, 999.6, 1234.5, 31_234_567.0, 1e-7, f64::NAN].map(number);
        let wanted = ["0", "1.50", "0.0123", "1,000", "1,235", "31,234,567", "1.00e-7", "–"];
        assert_eq!(texts, wanted);
        assert_eq!(percent(0.00755), "0.755%");
    }

    #[test]
    fn names_cannot_leave_their_place() {
        assert_eq!(escape("<b a=\"'&\u{1}"), "&lt;b a=&quot;&#39;&amp;\u{fffd}");
        assert_eq!(slug("A <room> & 'light'"), "a-room-light");
    }
}
