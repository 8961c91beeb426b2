//! What the formats in XML share: places of elements, numbers in attributes.

use std::collections::BTreeMap;

use roxmltree::{Document, Node, ParsingOptions};

use crate::report::{At, Notes};

/// A document has so many nodes at most.
const MOST_NODES: u32 = 2_000_000;
/// Elements are nested so deep at most.
pub const DEEPEST: usize = 200;
/// Limits as far off as this say that there are none: SDFormat's own default is 1e16.
const UNLIMITED: f64 = 1e15;

/// The document of a text; what is wrong with it is told.
pub fn parse<'t>(text: &'t str, number: usize, notes: &mut Notes) -> Option<Document<'t>> {
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    if nesting(text) > DEEPEST {
        notes.problem_with("HP0802", None, "its elements are nested too deep", "export the mechanism again");
        return None;
    }
    match Document::parse_with_options(text, options) {
        Ok(document) => Some(document),
        Err(e) => {
            let start = offset(text, e.pos());
            let end = start + text[start..].chars().next().map_or(0, char::len_utf8);
            let at = Some(At { text: number, start, end });
            let what = e.to_string();
            // The parser's own place is the one that is shown.
            let what = what.rsplit_once(" at ").map_or(what.as_str(), |(what, _)| what);
            let help = "mostly a tag that is not closed, or a `<` or `&` in a text, at or before this place";
            notes.problem_with("HP0802", at, format!("this is not valid XML: {what}"), help);
            None
        }
    }
}

/// The text as the readers of robot formats take it, every byte where it was: comments, which may hold `--`, and the declaration, which
/// need not come first, are blank; what has a prefix that nothing declares is written with `_`, as `controller_joint`.
pub fn lenient(text: &str) -> String {
    let mut out = text.as_bytes().to_vec();
    let blank = |out: &mut Vec<u8>, range: std::ops::Range<usize>| {
        out[range].iter_mut().filter(|b| !b"\r\n".contains(b)).for_each(|b| *b = b' ');
    };
    let mut k = 0;
    while let Some(start) = text[k..].find("<!").map(|n| k + n) {
        let behind = |close: &str| text[start..].find(close).map(|n| start + n + close.len());
        k = if text[start..].starts_with("<!--") {
            let Some(end) = behind("-->") else { break };
            blank(&mut out, start..end);
            end
        } else if text[start..].starts_with("<![CDATA[") {
            behind("]]>").unwrap_or(text.len())
        } else {
            start + 2
        };
    }
    let first = out.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(0);
    if out[first..].starts_with(b"<?xml")
        && let Some(end) = text[first..].find("?>")
    {
        blank(&mut out, first..first + end + 2);
    }
    let mut declared: BTreeMap<&str, bool> = BTreeMap::from([("xml", true), ("xmlns", true)]);
    for colon in colons(&out) {
        let start = out[..colon].iter().rposition(|b| !is_of_name(*b)).map_or(0, |k| k + 1);
        let prefix = &text[start..colon];
        if !*declared.entry(prefix).or_insert_with(|| text.contains(&format!("xmlns:{prefix}"))) {
            out[colon] = b'_';
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| text.to_owned())
}

fn is_of_name(b: u8) -> bool {
    b.is_ascii_alphanumeric() || b"_-.".contains(&b) || !b.is_ascii()
}

/// Where the names of elements and attributes have a colon.
fn colons(text: &[u8]) -> Vec<usize> {
    let (mut out, mut inside, mut quote) = (Vec::new(), false, None);
    for (k, &b) in text.iter().enumerate() {
        match (inside, quote, b) {
            (false, _, b'<') => inside = text.get(k + 1).is_some_and(|c| is_of_name(*c) || *c == b'/'),
            (true, None, b'"' | b'\'') => quote = Some(b),
            (true, Some(q), _) if q == b => quote = None,
            (true, None, b'>') => inside = false,
            (true, None, b':') => out.push(k),
            _ => {}
        }
    }
    out
}

/// How deep elements are nested, at most, as far as that can be told without reading them.
pub fn nesting(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut deepest) = (0_usize, 0);
    for (k, b) in bytes.iter().enumerate() {
        match (b, bytes.get(k + 1)) {
            (b'<', Some(b'/')) => depth = depth.saturating_sub(1),
            (b'/', Some(b'>')) => depth = depth.saturating_sub(1),
            (b'<', Some(c)) if c.is_ascii_alphabetic() || *c == b'_' => depth += 1,
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

/// The byte at a line and column.
fn offset(text: &str, pos: roxmltree::TextPos) -> usize {
    let line =
        text.split_inclusive('\n').take((pos.row as usize).saturating_sub(1)).map(str::len).sum::<usize>();
    let rest = text.get(line..).unwrap_or_default();
    let column = rest.char_indices().nth((pos.col as usize).saturating_sub(1)).map_or(rest.len(), |(k, _)| k);
    line + column
}

/// Where an element stands: its name.
pub fn at(text: usize, node: Node<'_, '_>) -> Option<At> {
    let start = node.range().start;
    Some(At { text, start, end: start + 1 + node.tag_name().name().len() })
}

/// The child elements.
pub fn children<'a, 'i>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(Node::is_element)
}

/// The child elements of a name.
pub fn named<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    children(node).filter(move |n| n.tag_name().name() == name)
}

/// The first child element of a name.
pub fn child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Option<Node<'a, 'i>> {
    named(node, name).next()
}

/// Numbers of a text, between blanks; none where one is no finite number.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    let list: Option<Vec<f64>> = text.split_whitespace().map(|w| w.parse().ok()).collect();
    list.filter(|list| list.iter().all(|x: &f64| x.is_finite()))
}

/// So many numbers of a text; what is wrong with them is told.
pub fn exactly<const N: usize>(
    text: &str,
    what: &str,
    at: Option<At>,
    notes: &mut Notes,
) -> Option<[f64; N]> {
    let list = numbers(text).and_then(|list| <[f64; N]>::try_from(list).ok());
    if list.is_none() {
        let s = if N == 1 { "number" } else { "numbers" };
        let help = "write them with blanks between, and a point in fractions";
        notes.problem_with("HP0804", at, format!("{what} is {N} {s}, not `{}`", text.trim()), help);
    }
    list
}

/// A bound of a range, which may be infinite; what is wrong with it is told.
pub fn bound(text: &str, what: &str, at: Option<At>, notes: &mut Notes) -> Option<f64> {
    let value = text.trim().parse().ok().filter(|x: &f64| !x.is_nan());
    if value.is_none() {
        let help = "write it with a point in fractions, or `inf` where there is no bound";
        notes.problem_with("HP0804", at, format!("{what} is a number, not `{}`", text.trim()), help);
    }
    value
}

/// The range between two bounds; none where it is empty or has no end: such ends stand for no limit at all, as do numbers beyond these.
pub fn range(low: f64, high: f64) -> Option<[f64; 2]> {
    (low < high && low.abs() < UNLIMITED && high.abs() < UNLIMITED).then_some([low, high])
}

/// Where an attribute's value stands.
pub fn attribute_at(text: usize, node: Node<'_, '_>, name: &str) -> Option<At> {
    let range = node.attribute_node(name)?.range_value();
    Some(At { text, start: range.start, end: range.end })
}

/// An attribute of so many numbers, where there is one.
pub fn attribute<const N: usize>(
    text: usize,
    node: Node<'_, '_>,
    name: &str,
    notes: &mut Notes,
) -> Option<[f64; N]> {
    let value = node.attribute(name)?;
    let what = format!("`{name}` of `{}`", node.tag_name().name());
    exactly(value, &what, attribute_at(text, node, name), notes)
}
