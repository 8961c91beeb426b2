//! Common parts of the XML formats: positions of elements, numbers in attributes.

use std::collections::BTreeSet;

use roxmltree::{Document, Node, ParsingOptions};

use crate::report::{ImportLog, SourceSpan};

/// Maximum number of nodes of a document.
const MOST_NODES: u32 = 2_000_000;
/// Maximum depth of nested elements.
pub const DEEPEST: usize = 200;
/// Magnitude from which a limit counts as infinite: the default of SDFormat is 1e16.
const UNLIMITED: f64 = 1e15;

/// Maximum number of attributes of an element: parsers compare each with all others.
const MOST_ATTRIBUTES: usize = 1000;

/// Exceeded limit of a text, which is not parsed.
enum ExceededLimit {
    /// Elements are nested too deep, from this byte on.
    Deep(usize),
    /// The element at this byte has too many attributes.
    Wide(usize),
    /// Entities are declared at this byte; a few can expand to a text of any length.
    Entities(usize),
}

impl ExceededLimit {
    fn message(&self) -> (usize, &'static str, &'static str) {
        match *self {
            Self::Deep(at) => (at, "its elements are nested too deep", "export the mechanism again"),
            Self::Wide(at) => (at, "an element has more than a thousand attributes", "reduce them to 1000"),
            Self::Entities(at) => (
                at,
                "the file declares entities, which are not supported",
                "expand them, for example with `xmllint --noent FILE`",
            ),
        }
    }
}

fn options<'t>() -> ParsingOptions<'t> {
    ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() }
}

/// Parses a text; errors are reported.
pub fn parse<'t>(text: &'t str, number: usize, notes: &mut ImportLog) -> Option<Document<'t>> {
    if let Some(exceeded_limit) = exceeded_limit(text) {
        let (start, message, help) = exceeded_limit.message();
        notes.problem_with("HP0802", Some(SourceSpan { text: number, start, end: start + 1 }), message, help);
        return None;
    }
    match Document::parse_with_options(text, options()) {
        Ok(document) => Some(document),
        Err(e) => {
            let start = offset(text, e.pos());
            let end = start + text[start..].chars().next().map_or(0, char::len_utf8);
            let at = Some(SourceSpan { text: number, start, end });
            let what = e.to_string();
            // The position is reported separately.
            let what = what.rsplit_once(" at ").map_or(what.as_str(), |(what, _)| what);
            let help = "check for an unclosed tag, or a `<` or `&` in a text, at or before this position";
            notes.problem_with("HP0802", at, format!("invalid XML: {what}"), help);
            None
        }
    }
}

/// Parses a text.
///
/// # Errors
/// Returns the first error of the document.
pub fn parse_quietly(text: &str) -> Result<Document<'_>, String> {
    if let Some(exceeded_limit) = exceeded_limit(text) {
        return Err(exceeded_limit.message().1.into());
    }
    Document::parse_with_options(text, options()).map_err(|e| format!("invalid XML: {e}"))
}

/// Returns the text as tolerant readers of robot formats see it, with all byte positions preserved. Comments, which may
/// contain `--`, the declaration, which may come late, and a document type without entities are blanked. Undeclared
/// prefixes are written with `_`, as in `controller_joint`.
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
        } else if text[start..].starts_with("<!DOCTYPE") {
            let end = document_type(text, start);
            if !text[start..end].contains("<!ENTITY") {
                blank(&mut out, start..end);
            }
            end
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
    const DECLARES: &str = "xmlns:";
    let mut declared: BTreeSet<&str> = BTreeSet::from(["xml", "xmlns"]);
    declared.extend(text.match_indices(DECLARES).map(|(k, _)| {
        let rest = &text[k + DECLARES.len()..];
        let end = rest.bytes().position(|b| !is_of_name(b)).unwrap_or(rest.len());
        &rest[..end]
    }));
    for colon in colons(&out) {
        let start = out[..colon].iter().rposition(|b| !is_of_name(*b)).map_or(0, |k| k + 1);
        if !declared.contains(&text[start..colon]) {
            out[colon] = b'_';
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| text.to_owned())
}

/// Returns the byte after a document type that begins at `start`, including its declarations in brackets.
fn document_type(text: &str, start: usize) -> usize {
    let (mut inner, mut quote) = (false, None);
    for (k, b) in text.bytes().enumerate().skip(start) {
        match (quote, b) {
            (Some(q), _) if q == b => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(b),
            (None, b'[') => inner = true,
            (None, b']') => inner = false,
            (None, b'>') if !inner => return k + 1,
            (None, _) => {}
        }
    }
    text.len()
}

fn is_of_name(b: u8) -> bool {
    b.is_ascii_alphanumeric() || b"_-.".contains(&b) || !b.is_ascii()
}

/// Positions of elements and attributes with a colon in their names.
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

/// Returns the limit on time or memory of the parser that a text would exceed.
fn exceeded_limit(text: &str) -> Option<ExceededLimit> {
    let bytes = text.as_bytes();
    let (mut k, mut depth) = (0, 0_usize);
    while let Some(start) = bytes[k..].iter().position(|b| *b == b'<').map(|n| k + n) {
        let behind = |close: &str| text[start..].find(close).map_or(text.len(), |n| start + n + close.len());
        let rest = &text[start..];
        if rest.starts_with("<!--") {
            k = behind("-->");
            continue;
        }
        if rest.starts_with("<![CDATA[") {
            k = behind("]]>");
            continue;
        }
        if rest.starts_with("<!DOCTYPE") {
            let end = document_type(text, start);
            if let Some(at) = text[start..end].find("<!ENTITY") {
                return Some(ExceededLimit::Entities(start + at));
            }
            k = end;
            continue;
        }
        // A tag, up to its end outside quotes.
        let (mut quote, mut attributes, mut end) = (None, 0, bytes.len());
        for (n, b) in bytes.iter().enumerate().skip(start + 1) {
            match (quote, b) {
                (Some(q), _) if q == *b => quote = None,
                (Some(_), _) => {}
                (None, b'"' | b'\'') => quote = Some(*b),
                (None, b'=') => attributes += 1,
                (None, b'>') => {
                    end = n + 1;
                    break;
                }
                (None, _) => {}
            }
        }
        if attributes > MOST_ATTRIBUTES {
            return Some(ExceededLimit::Wide(start));
        }
        match (bytes.get(start + 1), bytes.get(end.saturating_sub(2))) {
            (Some(b'/'), _) => depth = depth.saturating_sub(1),
            (Some(b'?' | b'!'), _) | (_, Some(b'/')) => {}
            _ => depth += 1,
        }
        if depth > DEEPEST {
            return Some(ExceededLimit::Deep(start));
        }
        k = end;
    }
    None
}

/// Returns the byte at a line and column.
fn offset(text: &str, pos: roxmltree::TextPos) -> usize {
    let line =
        text.split_inclusive('\n').take((pos.row as usize).saturating_sub(1)).map(str::len).sum::<usize>();
    let rest = text.get(line..).unwrap_or_default();
    let column = rest.char_indices().nth((pos.col as usize).saturating_sub(1)).map_or(rest.len(), |(k, _)| k);
    line + column
}

/// Returns the position of the name of an element.
pub fn at(text: usize, node: Node<'_, '_>) -> Option<SourceSpan> {
    let start = node.range().start;
    Some(SourceSpan { text, start, end: start + 1 + node.tag_name().name().len() })
}

/// Returns the name of an element without the prefix of a known program, declared or not: `drake:ball_constraint`.
pub fn local<'a>(node: Node<'a, '_>) -> &'a str {
    let name = node.tag_name().name();
    name.strip_prefix("drake_").unwrap_or(name)
}

/// Known content of an element.
#[derive(Clone, Copy, Debug)]
pub struct Vocabulary {
    /// Attributes that are read, or without effect on the motion.
    pub attributes: &'static [&'static str],
    /// Elements that are read.
    pub read: &'static [&'static str],
    /// Elements without effect on the motion.
    pub irrelevant: &'static [&'static str],
}

/// Reports the unknown content of an element, which may affect the motion. `owner` is the name of the object that
/// contains it.
pub fn unknown(text: usize, node: Node<'_, '_>, owner: &str, words: Vocabulary, notes: &mut ImportLog) {
    unknown_attributes(text, node, owner, words.attributes, notes);
    repeated(text, node, owner, words.read, notes);
    let kind = node.tag_name().name();
    for part in children(node) {
        let name = local(part);
        if words.irrelevant.contains(&name) {
            notes.ignored(name, at(text, part));
        } else if !words.read.contains(&name) {
            let why = format!("`{kind}` has an unknown element `{name}`");
            notes.not_understood(name, owner, at(text, part), why);
        }
    }
}

/// Elements of which an object may have more than one.
const SEVERAL: [&str; 10] =
    ["visual", "collision", "link1", "site", "geom", "pulley", "joint", "include", "plugin", "flag"];

/// Reports elements of an object beyond the first of a kind, if it may have only one. They are not read.
pub fn repeated(text: usize, node: Node<'_, '_>, owner: &str, kinds: &[&str], notes: &mut ImportLog) {
    let mut found = BTreeSet::new();
    for part in children(node).filter(|part| kinds.contains(&local(*part))) {
        let kind = local(part);
        if !found.insert(kind) && !SEVERAL.contains(&kind) {
            let why =
                format!("`{}` has more than one `{kind}`: only the first is read", node.tag_name().name());
            notes.refused(kind, owner, at(text, part), why);
        }
    }
}

/// Returns the shape in the `geometry` of an element; further ones are reported.
pub fn shape<'a, 'i>(
    text: usize,
    node: Node<'a, 'i>,
    owner: &str,
    notes: &mut ImportLog,
) -> Option<Node<'a, 'i>> {
    let mut shapes = children(child(node, "geometry")?);
    let first = shapes.next();
    for other in shapes {
        let why = "`geometry` has more than one shape: only the first is read";
        notes.refused(other.tag_name().name(), owner, at(text, other), why);
    }
    first
}

/// Reports the unknown attributes of an element, which may affect the motion.
pub fn unknown_attributes(
    text: usize,
    node: Node<'_, '_>,
    owner: &str,
    known: &[&str],
    notes: &mut ImportLog,
) {
    for a in node.attributes().filter(|a| !known.contains(&a.name())) {
        let range = a.range();
        let at = Some(SourceSpan { text, start: range.start, end: range.end });
        let why = format!("`{}` has an unknown attribute `{}`", node.tag_name().name(), a.name());
        notes.not_understood(a.name(), owner, at, why);
    }
}

/// Returns the child elements.
pub fn children<'a, 'i>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(Node::is_element)
}

/// Returns the child elements with a name.
pub fn named<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    children(node).filter(move |n| local(*n) == name)
}

/// Returns the first child element with a name.
pub fn child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Option<Node<'a, 'i>> {
    named(node, name).next()
}

/// Returns the numbers of a text, separated by blanks; `None` if one is not finite.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    let list: Option<Vec<f64>> = text.split_whitespace().map(|w| w.parse().ok()).collect();
    list.filter(|list| list.iter().all(|x: &f64| x.is_finite()))
}

/// Returns exactly N numbers of a text; errors are reported.
pub fn exactly<const N: usize>(
    text: &str,
    what: &str,
    at: Option<SourceSpan>,
    notes: &mut ImportLog,
) -> Option<[f64; N]> {
    let list = numbers(text).and_then(|list| <[f64; N]>::try_from(list).ok());
    if list.is_none() {
        let s = if N == 1 { "number" } else { "numbers" };
        let help = "separate them with blanks, and use decimal points";
        notes.problem_with("HP0804", at, format!("{what} must be {N} {s}, not `{}`", text.trim()), help);
    }
    list
}

/// Returns a bound of a range, which may be infinite; errors are reported.
pub fn bound(text: &str, what: &str, at: Option<SourceSpan>, notes: &mut ImportLog) -> Option<f64> {
    let value = text.trim().parse().ok().filter(|x: &f64| !x.is_nan());
    if value.is_none() {
        let help = "use a decimal point, or `inf` if there is no bound";
        notes.problem_with("HP0804", at, format!("{what} must be a number, not `{}`", text.trim()), help);
    }
    value
}

/// Returns the range between two bounds, infinite for numbers beyond [`UNLIMITED`]; `None` if it is open at both ends,
/// since such bounds mean no limit. A range may be empty.
pub fn range(low: f64, high: f64) -> Option<[f64; 2]> {
    let end = |x: f64| if x.abs() < UNLIMITED { x } else { x.signum() * f64::INFINITY };
    let range = [low, high].map(end);
    range.iter().any(|x| x.is_finite()).then_some(range)
}

/// Returns the position of an attribute's value.
pub fn attribute_at(text: usize, node: Node<'_, '_>, name: &str) -> Option<SourceSpan> {
    let range = node.attribute_node(name)?.range_value();
    Some(SourceSpan { text, start: range.start, end: range.end })
}

/// Returns an attribute of N numbers, if present; errors are reported.
pub fn attribute<const N: usize>(
    text: usize,
    node: Node<'_, '_>,
    name: &str,
    notes: &mut ImportLog,
) -> Option<[f64; N]> {
    let value = node.attribute(name)?;
    let what = format!("`{name}` of `{}`", node.tag_name().name());
    exactly(value, &what, attribute_at(text, node, name), notes)
}
