//! A file's text, its lines, and which lines of it are left to link.

use std::sync::Arc;

use super::error::Place;

/// A text with its path and the offsets at which its lines start.
#[derive(Debug)]
pub(crate) struct Source {
    pub path: String,
    /// What is linked: the file's text, or what its conditions leave of it.
    pub text: String,
    starts: Vec<usize>,
    /// The file as it is, and which of its lines each line of `text` is, from 1.
    file: Option<(Arc<Source>, Vec<usize>)>,
}

impl Source {
    /// Drops a byte order mark and turns `\r\n` into `\n`, so that a checkout's line endings
    /// change neither the linked text nor any column.
    pub fn new(path: &str, text: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self::of(path, text.replace("\r\n", "\n"), None)
    }

    /// What is left of a file: some of its lines, each in its own columns.
    pub fn left_of(file: &Arc<Source>, text: String, lines: Vec<usize>) -> Self {
        Self::of(&file.path, text, Some((Arc::clone(file), lines)))
    }

    fn of(path: &str, text: String, file: Option<(Arc<Source>, Vec<usize>)>) -> Self {
        let breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        let starts = std::iter::once(0).chain(breaks).collect();
        Self { path: path.to_owned(), text, starts, file }
    }

    /// The 1-based row of `text` that an offset is in.
    pub fn row_at(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    /// The file's line that a row of `text` is.
    pub fn line_of(&self, row: usize) -> usize {
        let left = self.file.as_ref().and_then(|(_, lines)| lines.get(row.checked_sub(1)?));
        left.copied().unwrap_or(row)
    }

    /// The file's 1-based line that a byte offset is in.
    pub fn line_at(&self, offset: usize) -> usize {
        self.line_of(self.row_at(offset))
    }

    /// Offset at which the line of a byte offset starts.
    pub fn line_start(&self, offset: usize) -> usize {
        self.starts[self.row_at(offset) - 1]
    }

    /// The text of a line of the file, without its end.
    pub fn line(&self, line: usize) -> Option<&str> {
        if let Some((file, _)) = &self.file {
            return file.line(line);
        }
        let start = *self.starts.get(line.checked_sub(1)?)?;
        self.text[start..].split('\n').next()
    }

    pub fn place(&self, offset: usize) -> Place {
        Place { file: self.path.clone(), line: self.line_at(offset) }
    }

    /// The number of line breaks between two offsets.
    pub fn breaks_between(&self, from: usize, to: usize) -> usize {
        self.row_at(to) - self.row_at(from)
    }
}
