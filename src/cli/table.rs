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
        Self::parse(path, &bytes)
    }

    /// As [`Table::read`] of the bytes; `path` only names them in messages.
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, CliError> {
        let fault = |line: u64, message: String| CliError::Csv { path: path.into(), line, message };
        let mut lines = Lines { bytes, at: 0, line: 1 };
        let text = std::str::from_utf8(bytes)
            .map_err(|error| fault(lines.of(error.valid_up_to()), "not UTF-8 text".to_string()))?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .flexible(true)
            .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let marked = bytes.len() - text.trim_start_matches('\u{feff}').len();
        let mut position = |position: Option<&csv::Position>| {
            position.map_or(1, |position| lines.of(marked + position.byte() as usize))
        };
        let header = reader.headers().cloned();
        let header =
            header.map_err(|error| fault(position(error.position()), error.to_string()))?;
        let header: Vec<String> = header.iter().map(String::from).collect();
        let mut records = Vec::new();
        for record in reader.records() {
            let record =
                record.map_err(|error| fault(position(error.position()), error.to_string()))?;
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

/// The lines of places that are mostly asked for in order, each counted from the one before.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
}

impl Lines<'_> {
    /// The line of a place, from 1; of the text behind it, where line ends are.
    fn of(&mut self, at: usize) -> u64 {
        // a record's position may be that of the line end before it
        let ends = |byte: &&u8| matches!(byte, b'\r' | b'\n');
        let at = at + self.bytes[at..].iter().take_while(ends).count();
        if at < self.at {
            (self.at, self.line) = (0, 1);
        }
        let passed = &self.bytes[self.at..at];
        self.line += passed.iter().filter(|byte| **byte == b'\n').count() as u64;
        self.at = at;
        self.line
    }
}
