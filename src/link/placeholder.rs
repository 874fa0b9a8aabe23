//! Marks that WGSL does not have: what another tool fills in or acts on before a compiler reads it.

/// Bytes of the longest placeholder or tag; what goes on for longer is something else.
const LONGEST: usize = 256;

/// Length of the placeholder at the start of a text: `#{NAME}` of naga_oil, `${NAME}` and `$NAME` of
/// shells and script strings, `{{ name }}` and `<%= name %>` of template languages. None of them
/// can be WGSL.
pub(crate) fn placeholder(text: &str) -> Option<usize> {
    let line = text[..text.floor_char_boundary(LONGEST)].lines().next()?;
    let within = |close: &str, forbidden: &[char]| {
        let end = line.get(2..)?.find(close)? + 2;
        let name = &line[2..end];
        (!name.trim().is_empty() && !name.contains(forbidden)).then_some(end + close.len())
    };
    let word = |from: usize| {
        let end = line[from..].find(|c: char| !super::token::is_word_char(c));
        end.map_or(line.len(), |end| from + end)
    };
    match line.as_bytes() {
        [b'#' | b'$', b'{', ..] => within("}", &['{', ';']),
        // a block in a block needs a statement, and so a `;`, or a comment
        [b'{', b'{', ..] => within("}}", &['{', '}', ';', '/']),
        [b'<', b'%', b'=' | b'-', ..] => within("%>", &[]),
        [b'$', b'$', ..] => Some(2),
        [b'#' | b'$', ..] => Some(word(1)).filter(|end| *end > 1),
        _ => None,
    }
}

/// A word up to its first placeholder, which may well stand for nothing.
pub(crate) fn plain(word: &str) -> &str {
    word.split(['#', '$', '{', '<']).next().unwrap_or(word)
}

/// Length of another tool's line or tag at the start of a text: `#ifdef NAME` to the end of its line,
/// `{% if name %}`, `<% if %>`. A `#` counts at the start of a line only.
pub(crate) fn line_or_tag(text: &str, starts_line: bool) -> Option<usize> {
    let near = &text[..text.floor_char_boundary(LONGEST)];
    let closed = |close: &str| near.find(close).map(|end| end + close.len());
    match text.as_bytes() {
        [b'#', b'{', ..] => None,
        [b'#', ..] if starts_line => Some(directive(text)),
        [b'{', b'%', ..] => closed("%}"),
        [b'<', b'%', b'=' | b'-', ..] => None,
        [b'<', b'%', ..] => closed("%>"),
        _ => None,
    }
}

/// A line, with those that a `\` at its end or the braces of naga_oil's `#import` continue it by.
fn directive(text: &str) -> usize {
    let mut end = 0;
    let mut open = 0usize;
    let imports = text[1..].trim_start().starts_with("import");
    for line in text.split_inclusive('\n') {
        end += line.len();
        let line = line.trim_end();
        if imports {
            open += line.matches('{').count();
            open = open.saturating_sub(line.matches('}').count());
        }
        if open == 0 && !line.ends_with('\\') {
            break;
        }
    }
    text[..end].trim_end().len()
}
