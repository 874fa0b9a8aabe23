//! CSV tables with the lines that their records are on.

use std::path::Path;

use super::CliError;

/// A header, and records of as many fields with their lines, from 1.
pub struct Table {
    pub header: Vec<String>,
    pub records: Vec<(u64, Vec<String>)>,
}

impl Table {
    /// Reads a CSV file with a header; a record with a field too few or too many is an error that
    /// names the column.
    pub fn read(path: &Path) -> Result<Self, CliError> {
        let bytes =
            std::fs::read(path).map_err(|source| CliError::Read { path: path.into(), source })?;
        let fault = |line: u64, message: String| CliError::Csv { path: path.into(), line, message };
        let line_at = |at: usize| {
            // a record's position may be that of the line end before it
            let skipped =
                bytes[at..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
            let before = &bytes[..at + skipped];
            1 + before.iter().filter(|byte| **byte == b'\n').count() as u64
        };
        let text = std::str::from_utf8(&bytes)
            .map_err(|error| fault(line_at(error.valid_up_to()), "not UTF-8 text".to_string()))?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let marked = bytes.len() - text.trim_start_matches('\u{feff}').len();
        let position = |position: Option<&csv::Position>| {
            position.map_or(1, |position| line_at(marked + position.byte() as usize))
        };
        let broken = |error: csv::Error| fault(position(error.position()), error.to_string());
        let header: Vec<String> =
            reader.headers().map_err(broken)?.iter().map(String::from).collect();
        let mut records = Vec::new();
        for record in reader.records() {
            let record = record.map_err(broken)?;
            let line = position(record.position());
            if let Some(missing) = header.get(record.len()) {
                return Err(fault(line, format!("column `{missing}` is missing")));
            }
            if let Some(extra) = record.get(header.len()) {
                let last = header.last().map_or("", String::as_str);
                return Err(fault(
                    line,
                    format!("`{extra}` stands behind the last column `{last}`"),
                ));
            }
            records.push((line, record.iter().map(String::from).collect()));
        }
        Ok(Self { header, records })
    }
}
