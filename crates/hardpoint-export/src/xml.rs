//! Writer of XML with indented elements.

use std::fmt::Write;

use super::escaped;

/// XML document that is being written.
#[derive(Debug)]
pub struct Xml {
    text: String,
    /// Names of the open elements.
    open: Vec<&'static str>,
}

/// Attributes: name and value.
pub type Attributes<'a> = &'a [(&'a str, String)];

impl Xml {
    /// Document without elements.
    pub fn new() -> Self {
        Self { text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(), open: Vec::new() }
    }

    /// Begins an element that contains others.
    pub fn begin(&mut self, name: &'static str, attributes: Attributes<'_>) {
        self.tag(name, attributes, ">");
        self.open.push(name);
    }

    /// Ends the element that was begun last.
    pub fn end(&mut self) {
        if let Some(name) = self.open.pop() {
            let _ = writeln!(self.text, "{}</{name}>", "  ".repeat(self.open.len()));
        }
    }

    /// Writes an element without content.
    pub fn empty(&mut self, name: &str, attributes: Attributes<'_>) {
        self.tag(name, attributes, "/>");
    }

    /// Ends all open elements and returns the text.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.end();
        }
        self.text
    }

    fn tag(&mut self, name: &str, attributes: Attributes<'_>, end: &str) {
        let _ = write!(self.text, "{}<{name}", "  ".repeat(self.open.len()));
        for (name, value) in attributes {
            // XML has no control characters.
            let plain: String = value.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            let _ = write!(self.text, " {name}=\"{}\"", escaped(&plain));
        }
        let _ = writeln!(self.text, "{end}");
    }
}
