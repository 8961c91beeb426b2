//! A4 pages with text and lines, in points from the lower left corner.

use std::io::{self, Write};

use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

/// Width and height of a page.
pub const PAGE: (f32, f32) = (595.0, 842.0);
pub const MARGIN: f32 = 50.0;
/// Line spacing, in text sizes.
const LEADING: f32 = 1.35;
/// Approximate width ratio of bold letters.
const BOLD: f32 = 1.07;
const FONTS: [(Name<'static>, Name<'static>); 2] =
    [(Name(b"F1"), Name(b"Helvetica")), (Name(b"F2"), Name(b"Helvetica-Bold"))];
/// Widths of the letters of Helvetica from the blank to the tilde, in thousandths of the size (Adobe's font metrics).
/// PDF readers have the font themselves.
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556,
    556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278,
    500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469,
    556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500,
    278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];
/// Maximum width of all other letters of the font.
const WIDEST: u16 = 722;

/// Style of a line of text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    pub size: f32,
    pub is_bold: bool,
}

pub const TITLE: Face = Face { size: 17.0, is_bold: true };
pub const HEADING: Face = Face { size: 11.5, is_bold: true };
pub const TEXT: Face = Face { size: 8.5, is_bold: false };
pub const STRONG: Face = Face { is_bold: true, ..TEXT };
pub const SMALL: Face = Face { size: 7.0, is_bold: false };

/// A colour: red, green and blue from 0 to 1.
pub type Colour = [f32; 3];
pub const BLACK: Colour = [0.1, 0.1, 0.12];
pub const GREY: Colour = [0.45, 0.47, 0.5];
pub const PALE: Colour = [0.85, 0.86, 0.88];
pub const WHITE: Colour = [1.0, 1.0, 1.0];
pub const BLUE: Colour = [0.02, 0.37, 0.73];
pub const RED: Colour = [0.7, 0.33, 0.6];

impl Face {
    pub fn line(self) -> f32 {
        self.size * LEADING
    }

    /// Width of a text.
    pub fn width(self, text: &str) -> f32 {
        let thousandths: u32 = bytes(text).0.into_iter().map(|b| u32::from(width_of(b))).sum();
        thousandths as f32 * 1e-3 * self.size * if self.is_bold { BOLD } else { 1.0 }
    }

    /// Breaks a text into lines of this width, at blanks; a word that is wider is broken anywhere.
    pub fn lines(self, text: &str, width: f32) -> Vec<String> {
        let mut lines = Vec::new();
        for paragraph in text.lines() {
            let mut line = String::new();
            for word in paragraph.split_whitespace() {
                let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
                if self.width(&longer) <= width {
                    line = longer;
                    continue;
                }
                if !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                }
                for letter in word.chars() {
                    line.push(letter);
                    if self.width(&line) > width && line.chars().count() > 1 {
                        line.pop();
                        lines.push(std::mem::replace(&mut line, letter.to_string()));
                    }
                }
            }
            lines.push(line);
        }
        lines
    }
}

fn width_of(byte: u8) -> u16 {
    byte.checked_sub(b' ').and_then(|k| WIDTHS.get(usize::from(k))).copied().unwrap_or(WIDEST)
}

/// Encodes a text for the pages (Windows-1252), and returns whether all letters exist; others become `?`.
fn bytes(text: &str) -> (Vec<u8>, bool) {
    let mut whole = true;
    let byte = |c: char| match c {
        ' '..='~' | '\u{a0}'..='\u{ff}' => c as u8,
        '\t' => b' ',
        '\u{2212}' => b'-',
        '\u{2026}' => 0x85,
        '\u{2018}' => 0x91,
        '\u{2019}' => 0x92,
        '\u{201c}' => 0x93,
        '\u{201d}' => 0x94,
        '\u{2013}' => 0x96,
        '\u{2014}' => 0x97,
        _ => {
            whole = false;
            b'?'
        }
    };
    let all = text.chars().map(byte).collect();
    (all, whole)
}

/// A document that is being written, from the top of its first page.
pub struct Paper {
    /// Contents of the full pages, and of the current one.
    pages: Vec<Content>,
    /// Position on the last page, from the top.
    pub y: f32,
    /// True if the font has all letters.
    is_whole: bool,
}

impl Paper {
    pub fn new() -> Self {
        Self { pages: vec![Content::new()], y: PAGE.1 - MARGIN, is_whole: true }
    }

    /// Starts the next page if there is not enough room.
    pub fn need(&mut self, height: f32) {
        if self.y - height < MARGIN {
            self.pages.push(Content::new());
            self.y = PAGE.1 - MARGIN;
        }
    }

    fn content(&mut self) -> &mut Content {
        self.pages.last_mut().expect("there is a page from the beginning on")
    }

    /// Writes a line of text that begins here, upwards if it is turned.
    pub fn text(&mut self, face: Face, colour: Colour, [x, y]: [f32; 2], is_turned: bool, text: &str) {
        let (bytes, whole) = bytes(text);
        self.is_whole &= whole;
        let along = if is_turned { [0.0, 1.0, -1.0, 0.0] } else { [1.0, 0.0, 0.0, 1.0] };
        let content = self.content();
        content.set_fill_rgb(colour[0], colour[1], colour[2]);
        content.begin_text().set_font(FONTS[usize::from(face.is_bold)].0, face.size);
        content.set_text_matrix([along[0], along[1], along[2], along[3], x, y]);
        content.show(Str(&bytes)).end_text();
    }

    /// Writes a text over the whole width, broken into lines.
    pub fn paragraph(&mut self, face: Face, colour: Colour, text: &str) {
        for line in face.lines(text, PAGE.0 - 2.0 * MARGIN) {
            self.need(face.line());
            self.y -= face.line();
            self.text(face, colour, [MARGIN, self.y], false, &line);
        }
    }

    /// Writes a heading, never alone at the foot of a page.
    pub fn heading(&mut self, text: &str, with: f32) {
        self.need(2.0 * HEADING.line() + with);
        self.y -= HEADING.size;
        self.paragraph(HEADING, BLACK, text);
        self.y -= 0.4 * HEADING.size;
    }

    /// Writes a row of a table: texts in columns at these positions from the left margin, each broken into lines.
    pub fn row(&mut self, face: Face, columns: &[f32], cells: &[&str]) {
        /// Between two columns.
        const GAP: f32 = 8.0;
        let ends = columns.iter().skip(1).copied().chain([PAGE.0 - 2.0 * MARGIN + GAP]);
        let widths = columns.iter().zip(ends).map(|(from, to)| to - from - GAP);
        let cells: Vec<Vec<String>> = cells.iter().zip(widths).map(|(cell, w)| face.lines(cell, w)).collect();
        let lines = cells.iter().map(Vec::len).max().unwrap_or(0);
        self.need((lines as f32 * face.line()).min(PAGE.1 / 2.0));
        for k in 0..lines {
            self.need(face.line());
            self.y -= face.line();
            for (cell, x) in cells.iter().zip(columns) {
                if let Some(line) = cell.get(k) {
                    self.text(face, BLACK, [MARGIN + x, self.y], false, line);
                }
            }
        }
    }

    /// Draws a polyline; a point that is not a number leaves a gap, and a single point is a dot.
    pub fn lines(&mut self, colour: Colour, width: f32, points: impl IntoIterator<Item = [f32; 2]>) {
        let content = self.content();
        content.set_stroke_rgb(colour[0], colour[1], colour[2]).set_line_width(width);
        content.set_line_cap(pdf_writer::types::LineCapStyle::RoundCap);
        content.set_line_join(pdf_writer::types::LineJoinStyle::RoundJoin);
        let mut is_on = false;
        for [x, y] in points {
            if !(x.is_finite() && y.is_finite()) {
                is_on = false;
            } else {
                if !std::mem::replace(&mut is_on, true) {
                    content.move_to(x, y);
                }
                content.line_to(x, y);
            }
        }
        content.stroke();
    }

    /// Draws a filled outline.
    pub fn shape(&mut self, fill: Colour, colour: Colour, width: f32, points: &[[f32; 2]]) {
        let Some(([x, y], rest)) = points.split_first() else { return };
        let content = self.content();
        content.set_stroke_rgb(colour[0], colour[1], colour[2]).set_line_width(width);
        content.set_line_cap(pdf_writer::types::LineCapStyle::RoundCap);
        content.set_line_join(pdf_writer::types::LineJoinStyle::RoundJoin);
        content.set_fill_rgb(fill[0], fill[1], fill[2]);
        content.move_to(*x, *y);
        rest.iter().for_each(|[x, y]| _ = content.line_to(*x, *y));
        content.close_path().fill_nonzero_and_stroke();
    }

    /// Draws a filled rectangle.
    pub fn bar(&mut self, colour: Colour, [x, y]: [f32; 2], width: f32, height: f32) {
        self.content().set_fill_rgb(colour[0], colour[1], colour[2]).rect(x, y, width, height).fill_nonzero();
    }

    /// Completes the document: each page gets a footer with its number.
    ///
    /// # Errors
    /// Fails if `out` cannot be written.
    pub fn end(mut self, title: &str, generator: &str, out: &mut impl Write) -> io::Result<()> {
        let foot = if bytes(title).1 && self.is_whole {
            format!("{title}, {generator}")
        } else {
            format!("{title}, {generator}; ? replaces letters that the font lacks")
        };
        let pages = self.pages.len();
        let contents = std::mem::take(&mut self.pages);
        let mut pdf = Pdf::new();
        let mut id = 0;
        let mut next = || {
            id += 1;
            Ref::new(id)
        };
        let (catalog, tree, info) = (next(), next(), next());
        let fonts = FONTS.map(|_| next());
        let ids: Vec<[Ref; 2]> = contents.iter().map(|_| [next(), next()]).collect();
        pdf.catalog(catalog).pages(tree);
        pdf.pages(tree).kids(ids.iter().map(|ids| ids[0])).count(pages as i32);
        pdf.document_info(info).title(TextStr(title)).creator(TextStr(generator));
        for (id, (_, name)) in fonts.into_iter().zip(FONTS) {
            pdf.type1_font(id).base_font(name).encoding_predefined(Name(b"WinAnsiEncoding"));
        }
        for (k, (content, ids)) in contents.into_iter().zip(ids).enumerate() {
            let mut page = pdf.page(ids[0]);
            page.media_box(Rect::new(0.0, 0.0, PAGE.0, PAGE.1)).parent(tree).contents(ids[1]);
            let mut resources = page.resources();
            let mut names = resources.fonts();
            for ((name, _), id) in FONTS.iter().zip(fonts) {
                names.pair(*name, id);
            }
            names.finish();
            resources.finish();
            page.finish();
            self.pages = vec![content];
            let number = format!("{} / {pages}", k + 1);
            let right = PAGE.0 - MARGIN - SMALL.width(&number);
            self.text(SMALL, GREY, [MARGIN, MARGIN / 2.0], false, &foot);
            self.text(SMALL, GREY, [right, MARGIN / 2.0], false, &number);
            pdf.stream(ids[1], &self.pages.remove(0).finish());
        }
        out.write_all(&pdf.finish())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_as_wide_as_the_paper_and_lose_no_letter() {
        let text = "the margin of a_very_long_name_without_any_blank_in_it_that_goes_on_and_on is 0.19";
        let lines = TEXT.lines(text, 100.0);
        assert!(lines.len() > 3 && lines.iter().all(|line| TEXT.width(line) <= 100.0), "{lines:?}");
        let letters = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
        assert_eq!(letters(&lines.concat()), letters(text));
    }

    #[test]
    fn letters_that_the_font_lacks_are_reported() {
        assert_eq!(bytes("\u{fc}ber 2 \u{b5}m \u{2013}"), (b"\xfcber 2 \xb5m \x96".to_vec(), true));
        assert_eq!(bytes("\u{3c6}1"), (b"?1".to_vec(), false));
    }

    /// By the metrics: H 722, e 556, l 222 twice, o 556.
    #[test]
    fn a_text_is_as_wide_as_its_letters() {
        assert!((TEXT.width("Hello") - 2.278 * TEXT.size).abs() < 1e-4);
    }
}
