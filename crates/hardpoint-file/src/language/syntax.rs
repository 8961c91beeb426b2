//! Places of all keys and values of a text, which need not be valid TOML, and the position of a writer in it.

use std::borrow::Cow;
use std::ops::Range;

use toml_parser::lexer::{Token, TokenKind};
use toml_parser::{Source, Span};

/// Maximum nesting depth of values.
const DEEPEST: usize = 64;

/// A value with its place.
#[derive(Debug)]
pub(super) struct Node {
    pub at: Range<usize>,
    pub value: Tree,
}

/// Contents of a value.
#[derive(Debug)]
pub(super) enum Tree {
    /// A text in quotes.
    Text(String),
    /// A number, a flag or a date; or nothing where a value is missing.
    Word,
    List(Vec<Node>),
    Table(Vec<Member>),
}

/// A key with all places where the text has it.
#[derive(Debug)]
pub(super) struct Member {
    pub name: String,
    /// Places of the name: several for a table with several headings.
    pub at: Vec<Range<usize>>,
    /// From the first character to the last.
    pub whole: Range<usize>,
    pub value: Node,
}

impl Node {
    fn empty(at: usize, value: Tree) -> Self {
        Self { at: at..at, value }
    }

    /// Members of a table.
    pub fn members(&self) -> &[Member] {
        if let Tree::Table(members) = &self.value { members } else { &[] }
    }

    /// Value of a key.
    pub fn get(&self, name: &str) -> Option<&Node> {
        self.members().iter().find(|m| m.name == name).map(|m| &m.value)
    }

    /// The value as a text.
    pub fn text(&self) -> Option<&str> {
        if let Tree::Text(text) = &self.value { Some(text) } else { None }
    }

    /// Elements of a list.
    pub fn elements(&self) -> &[Node] {
        if let Tree::List(list) = &self.value { list } else { &[] }
    }
}

/// Entry that is about to be written at the end of a text.
#[derive(Debug, PartialEq)]
pub(super) struct Cursor {
    pub place: CursorPlace,
    /// Keys from the root to the table, or to the value.
    pub path: Vec<String>,
    /// The text in quotes, the key or the word that was begun.
    pub begun: String,
    /// `type` of the table that is being written, and its keys so far.
    pub kind: Option<String>,
    pub siblings: Vec<String>,
    /// True if the table, or a table around it, is an element of a list.
    pub in_list: bool,
}

/// Kind of the entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CursorPlace {
    /// A part of a table's heading.
    Heading,
    Key,
    /// A value; true in quotes.
    Value(bool),
}

/// Reads a text; errors are skipped.
pub(super) fn read(text: &str) -> Node {
    Reader::new(text).document().0
}

/// Entry that is about to be written at a byte of the text; `None` in a comment, and after a complete value.
pub(super) fn cursor(text: &str, at: usize) -> Option<Cursor> {
    Reader::new(&text[..at]).document().1
}

struct Reader<'t> {
    text: &'t str,
    tokens: Vec<Token>,
    next: usize,
    /// Keys from the root.
    path: Vec<String>,
    /// Number of lists around the current value.
    lists: usize,
    depth: usize,
    cursor: Option<Cursor>,
}

impl<'t> Reader<'t> {
    fn new(text: &'t str) -> Self {
        let tokens = Source::new(text).lex().into_vec();
        Self { text, tokens, next: 0, path: Vec::new(), lists: 0, depth: 0, cursor: None }
    }

    fn kind(&self) -> TokenKind {
        self.tokens.get(self.next).map_or(TokenKind::Eof, Token::kind)
    }

    fn span(&self) -> Range<usize> {
        self.tokens.get(self.next).map_or(self.text.len()..self.text.len(), |t| range(t.span()))
    }

    /// End of the token before.
    fn end(&self) -> usize {
        self.next.checked_sub(1).map_or(0, |k| range(self.tokens[k].span()).end)
    }

    fn is_at_end(&self) -> bool {
        self.kind() == TokenKind::Eof
    }

    fn skip(&mut self, kinds: &[TokenKind]) {
        while kinds.contains(&self.kind()) {
            self.next += 1;
        }
    }

    fn blanks(&mut self) {
        self.skip(&[TokenKind::Whitespace]);
    }

    fn lines(&mut self) {
        self.skip(&[TokenKind::Whitespace, TokenKind::Comment, TokenKind::Newline]);
    }

    fn rest_of_line(&mut self) {
        while !matches!(self.kind(), TokenKind::Newline | TokenKind::Eof) {
            self.next += 1;
        }
    }

    /// True if the token before is the end of a line.
    fn is_line_start(&self) -> bool {
        self.next.checked_sub(1).is_none_or(|k| self.tokens[k].kind() == TokenKind::Newline)
    }

    /// True if the text ends within a comment.
    fn ends_in_comment(&self) -> bool {
        self.next.checked_sub(1).is_some_and(|k| self.tokens[k].kind() == TokenKind::Comment)
    }

    fn note(&mut self, place: CursorPlace, begun: String, table: &[Member]) {
        if self.cursor.is_some() || self.ends_in_comment() {
            return;
        }
        let kind = table.iter().find(|m| m.name == "type").and_then(|m| m.value.text());
        self.cursor = Some(Cursor {
            place,
            path: self.path.clone(),
            begun,
            kind: kind.map(str::to_owned),
            siblings: table.iter().map(|m| m.name.clone()).collect(),
            in_list: self.lists > 0,
        });
    }

    fn document(mut self) -> (Node, Option<Cursor>) {
        let mut root = Vec::new();
        let mut heading: Vec<(String, Range<usize>)> = Vec::new();
        loop {
            self.lines();
            self.path = heading.iter().map(|(name, _)| name.clone()).collect();
            let start = self.span().start;
            match self.kind() {
                TokenKind::Eof => {
                    // Nothing follows a value or a heading on its line.
                    let line = self.text.rsplit('\n').next().unwrap_or_default();
                    if line.trim().is_empty() {
                        let table = table_at(&mut root, &heading, start..start, false);
                        self.note(CursorPlace::Key, String::new(), table);
                    }
                    break;
                }
                TokenKind::LeftSquareBracket => {
                    self.next += 1;
                    let is_list = self.kind() == TokenKind::LeftSquareBracket;
                    self.next += usize::from(is_list);
                    self.path.clear();
                    heading = self.keys(CursorPlace::Heading, &[]);
                    self.path.clear();
                    self.skip(&[TokenKind::RightSquareBracket]);
                    let end = self.end();
                    table_at(&mut root, &heading, start..end, is_list);
                    self.rest_of_line();
                }
                _ => {
                    let at = start..start;
                    let table = std::mem::take(table_at(&mut root, &heading, at.clone(), false));
                    let table = self.member(table);
                    *table_at(&mut root, &heading, at, false) = table;
                    extend(&mut root, &heading, self.end());
                    // A value that was not closed may end on a later line.
                    if !self.is_line_start() {
                        self.rest_of_line();
                    }
                }
            }
        }
        (Node { at: 0..self.text.len(), value: Tree::Table(root) }, self.cursor)
    }

    /// Keys of a path, separated by points.
    fn keys(&mut self, place: CursorPlace, table: &[Member]) -> Vec<(String, Range<usize>)> {
        let mut keys = Vec::new();
        loop {
            self.blanks();
            let at = self.span();
            let name = match self.kind() {
                TokenKind::Atom => self.text[at.clone()].to_owned(),
                TokenKind::BasicString | TokenKind::LiteralString => {
                    decoded(self.text, self.tokens[self.next])
                }
                TokenKind::Eof => {
                    self.note(place, String::new(), table);
                    return keys;
                }
                _ => return keys,
            };
            self.next += 1;
            if self.is_at_end() {
                self.note(place, name.clone(), table);
            }
            self.path.push(name.clone());
            keys.push((name, at));
            self.blanks();
            if self.kind() != TokenKind::Dot {
                return keys;
            }
            self.next += 1;
        }
    }

    /// Reads a key with its value into a table.
    fn member(&mut self, mut table: Vec<Member>) -> Vec<Member> {
        let depth = self.path.len();
        let start = self.span().start;
        let keys = self.keys(CursorPlace::Key, &table);
        if keys.is_empty() {
            // No key begins here.
            if !self.is_at_end() {
                self.next += 1;
            }
            return table;
        }
        let value = if self.kind() == TokenKind::Equals {
            self.next += 1;
            self.value(&table)
        } else {
            Node::empty(self.end(), Tree::Word)
        };
        self.path.truncate(depth);
        let end = self.end();
        put(&mut table, &keys, start..end, value);
        table
    }

    /// Reads a value; `table` has the keys around it.
    fn value(&mut self, table: &[Member]) -> Node {
        self.blanks();
        let at = self.span();
        match self.kind() {
            TokenKind::Eof => {
                self.note(CursorPlace::Value(false), String::new(), table);
                Node::empty(at.start, Tree::Word)
            }
            TokenKind::BasicString | TokenKind::LiteralString => {
                let value = Tree::Text(decoded(self.text, self.tokens[self.next]));
                self.next += 1;
                let written = &self.text[at.clone()];
                let quote = &written[..1];
                let is_closed = written.len() > 1 && written.ends_with(quote);
                if self.is_at_end() && !is_closed {
                    self.note(CursorPlace::Value(true), written[1..].to_owned(), table);
                }
                Node { at, value }
            }
            TokenKind::MlBasicString | TokenKind::MlLiteralString => {
                let value = Tree::Text(decoded(self.text, self.tokens[self.next]));
                self.next += 1;
                Node { at, value }
            }
            TokenKind::LeftSquareBracket if self.depth < DEEPEST => self.list(table),
            TokenKind::LeftCurlyBracket if self.depth < DEEPEST => self.inline_table(),
            TokenKind::Atom | TokenKind::Dot => {
                self.skip(&[TokenKind::Atom, TokenKind::Dot]);
                let at = at.start..self.end();
                let word = &self.text[at.clone()];
                if self.is_at_end() && word.starts_with(|c: char| c.is_alphabetic() || c == '_') {
                    self.note(CursorPlace::Value(false), word.to_owned(), table);
                }
                Node { at, value: Tree::Word }
            }
            _ => Node::empty(at.start, Tree::Word),
        }
    }

    fn list(&mut self, table: &[Member]) -> Node {
        let start = self.span().start;
        self.next += 1;
        (self.depth, self.lists) = (self.depth + 1, self.lists + 1);
        let mut list = Vec::new();
        loop {
            self.lines();
            if self.is_at_end() {
                self.note(CursorPlace::Value(false), String::new(), table);
                break;
            }
            if self.kind() == TokenKind::RightSquareBracket {
                self.next += 1;
                break;
            }
            if self.begins_a_statement() {
                break;
            }
            let before = self.next;
            list.push(self.value(table));
            if self.next == before {
                list.pop();
                if matches!(self.kind(), TokenKind::RightCurlyBracket | TokenKind::Equals) {
                    break;
                }
                self.next += 1;
                continue;
            }
            if self.is_at_end() {
                break;
            }
            self.lines();
            self.skip(&[TokenKind::Comma]);
        }
        (self.depth, self.lists) = (self.depth - 1, self.lists - 1);
        Node { at: start..self.end(), value: Tree::List(list) }
    }

    fn inline_table(&mut self) -> Node {
        let start = self.span().start;
        self.next += 1;
        self.depth += 1;
        let mut table = Vec::new();
        loop {
            self.lines();
            if self.is_at_end() {
                self.note(CursorPlace::Key, String::new(), &table);
                break;
            }
            if self.kind() == TokenKind::RightCurlyBracket {
                self.next += 1;
                break;
            }
            if self.begins_a_statement() || self.kind() == TokenKind::RightSquareBracket {
                break;
            }
            table = self.member(table);
            if self.is_at_end() {
                break;
            }
            self.lines();
            self.skip(&[TokenKind::Comma]);
        }
        self.depth -= 1;
        Node { at: start..self.end(), value: Tree::Table(table) }
    }

    /// True at the start of a line that can only be a heading, so that a bracket above it was left open.
    fn begins_a_statement(&self) -> bool {
        let kind = |k: usize| self.tokens.get(self.next + k).map_or(TokenKind::Eof, Token::kind);
        if !self.is_line_start() || kind(0) != TokenKind::LeftSquareBracket {
            return false;
        }
        let mut k = 1 + usize::from(kind(1) == TokenKind::LeftSquareBracket);
        let word = self.tokens.get(self.next + k).map_or("", |t| &self.text[range(t.span())]);
        let is_name = |c: char| c.is_alphabetic() || c == '_';
        if kind(k) != TokenKind::Atom || !word.starts_with(is_name) || ["true", "false"].contains(&word) {
            return false;
        }
        while matches!(
            kind(k),
            TokenKind::Atom | TokenKind::Dot | TokenKind::BasicString | TokenKind::LiteralString
        ) {
            k += 1;
        }
        kind(k) == TokenKind::RightSquareBracket
    }
}

fn range(span: Span) -> Range<usize> {
    span.start()..span.end()
}

/// Contents of a text in quotes.
fn decoded(text: &str, token: Token) -> String {
    let written = &text[range(token.span())];
    if !written.contains('\\') {
        let quote = ["\"\"\"", "'''"].into_iter().find(|q| written.len() >= 6 && written.starts_with(q));
        let quote = quote.unwrap_or(&written[..1]);
        let inner = written.strip_prefix(quote).unwrap_or(written);
        return inner.strip_suffix(quote).unwrap_or(inner).to_owned();
    }
    let mut out = Cow::Borrowed("");
    if let Some(raw) = Source::new(text).get(token) {
        let _ = raw.decode_scalar(&mut out, &mut ());
    }
    out.into_owned()
}

/// The table at a path of keys, which is created with these places.
fn table_at<'n>(
    root: &'n mut Vec<Member>,
    path: &[(String, Range<usize>)],
    whole: Range<usize>,
    is_list: bool,
) -> &'n mut Vec<Member> {
    let mut table = root;
    for (k, (name, at)) in path.iter().enumerate() {
        let is_last = k + 1 == path.len();
        let member = match table.iter().position(|m| m.name == *name) {
            Some(found) => found,
            None => {
                table.push(Member {
                    name: name.clone(),
                    at: Vec::new(),
                    whole: at.clone(),
                    value: Node::empty(at.start, Tree::Table(Vec::new())),
                });
                table.len() - 1
            }
        };
        let member = &mut table[member];
        if !member.at.contains(at) {
            member.at.push(at.clone());
            member.whole.start = member.whole.start.min(if is_last { whole.start } else { at.start });
        }
        member.whole.end = member.whole.end.max(whole.end);
        if is_last && is_list && !whole.is_empty() {
            if !matches!(member.value.value, Tree::List(_)) {
                member.value.value = Tree::List(Vec::new());
            }
            if let Tree::List(list) = &mut member.value.value {
                list.push(Node { at: whole.clone(), value: Tree::Table(Vec::new()) });
            }
        }
        let mut node = &mut member.value;
        if matches!(&node.value, Tree::List(list) if list.last().is_some_and(|n| matches!(n.value, Tree::Table(_))))
        {
            let Tree::List(list) = &mut node.value else { unreachable!("just matched") };
            node = list.last_mut().expect("just matched");
        }
        if !matches!(node.value, Tree::Table(_)) {
            // The name is a value above and a table here: the later one counts.
            node.value = Tree::Table(Vec::new());
        }
        let Tree::Table(members) = &mut node.value else { unreachable!("just made") };
        table = members;
    }
    table
}

/// Extends the entries of a path to this end.
fn extend(root: &mut [Member], path: &[(String, Range<usize>)], end: usize) {
    let mut table = root;
    for (name, _) in path {
        let Some(member) = table.iter_mut().find(|m| m.name == *name) else { return };
        member.whole.end = member.whole.end.max(end);
        let mut node = &mut member.value;
        if matches!(&node.value, Tree::List(list) if !list.is_empty()) {
            let Tree::List(list) = &mut node.value else { unreachable!("just matched") };
            node = list.last_mut().expect("just matched");
            node.at.end = node.at.end.max(end);
        }
        let Tree::Table(members) = &mut node.value else { return };
        table = members;
    }
}

/// Puts a value at a path of keys in a table.
fn put(table: &mut Vec<Member>, keys: &[(String, Range<usize>)], whole: Range<usize>, value: Node) {
    let Some(((name, at), above)) = keys.split_last() else { return };
    let table = table_at(table, above, whole.clone(), false);
    match table.iter_mut().find(|m| m.name == *name) {
        Some(member) => {
            member.at.push(at.clone());
            member.whole = member.whole.start.min(whole.start)..member.whole.end.max(whole.end);
            member.value = value;
        }
        None => table.push(Member { name: name.clone(), at: vec![at.clone()], whole, value }),
    }
}
