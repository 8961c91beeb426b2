//! Pages without a mechanism: the gallery of models, and models that cannot be shown.

use std::fmt::Write;

use crate::page::{escape_text, fill};

/// Entry of the gallery.
pub struct Card {
    /// Name.
    pub title: String,
    /// Description in the model.
    pub description: Option<String>,
    /// Name of its file.
    pub file: String,
    /// Reason why the model cannot be shown, in a few words.
    pub wrong: Option<String>,
    /// Address of the model's page.
    pub link: String,
    /// Further pages of the model, one per case: name and address.
    pub more: Vec<(String, String)>,
    /// Picture as SVG, made by this program, or [`pending`].
    pub picture: Option<String>,
}

/// Empty frame for a picture that a server returns as `{"svg": ...}` at this address, once the frame is seen.
pub fn pending(address: &str) -> String {
    format!("<div class=\"drawing\" data-drawing=\"{}\"></div>\n", escape_text(address))
}

/// Number of models that are shown without a field for a search.
const MOST_UNSEARCHED: usize = 6;
/// Field for a search, which hides the models without its words.
const SEARCH: &str = r#"<template id="search">
<input type="search" class="search" placeholder="Search the models" aria-label="Search the models" data-testid="search">
</template>
<script>
const list = document.querySelector('.gallery')
list.before(document.getElementById('search').content.cloneNode(true))
const field = document.querySelector('.search')
field.addEventListener('input', () => {
  const words = field.value.toLowerCase().split(/\s+/)
  for (const model of list.children) {
    const text = model.textContent.toLowerCase()
    model.hidden = !words.every((word) => text.includes(word))
  }
})
</script>"#;

/// Fills the frames of [`pending`], one at a time.
const DRAWINGS: &str = r#"<script type="module">
const { token } = JSON.parse(document.getElementById('server').textContent)
const waiting = []
let busy = false
async function draw() {
  if (busy) return
  busy = true
  for (let frame; (frame = waiting.shift()); ) {
    const reply = await fetch(frame.dataset.drawing, { headers: { 'x-hardpoint-token': token } }).catch(() => {})
    if (reply?.ok) frame.innerHTML = (await reply.json()).svg
  }
  busy = false
}
const seen = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue
    seen.unobserve(target)
    waiting.push(target)
  }
  draw()
})
for (const frame of document.querySelectorAll('[data-drawing]')) seen.observe(frame)
</script>"#;

/// Page of all models, with an introduction `lead`, and a link to the page of a `new` linkage.
///
/// ```
/// use hardpoint_report::gallery::{Card, gallery};
/// let card = Card {
///     title: "a < b".into(),
///     description: None,
///     file: "ab.toml".into(),
///     wrong: None,
///     link: "ab.html".into(),
///     more: Vec::new(),
///     picture: None,
/// };
/// assert!(gallery("Models", "Two bodies.", None, &[card]).contains(r#"<a href="ab.html">a &lt; b</a>"#));
/// ```
pub fn gallery(title: &str, lead: &str, new: Option<&str>, cards: &[Card]) -> String {
    let new = new.map_or_else(String::new, |address| {
        let address = escape_text(address);
        format!("<p><a class=\"new\" data-testid=\"new-linkage\" href=\"{address}\">New linkage</a></p>\n")
    });
    let mut body = format!(
        "<h1>{}</h1>\n<p class=\"lead\">{}</p>\n{new}<div class=\"gallery\">\n",
        escape_text(title),
        escape_text(lead)
    );
    cards.iter().for_each(|card| body += &card.html());
    body += "</div>\n";
    if cards.len() > MOST_UNSEARCHED {
        body += SEARCH;
    }
    if body.contains("data-drawing=") {
        body += DRAWINGS;
    }
    sheet(title, &body)
}

impl Card {
    fn html(&self) -> String {
        let link =
            |to: &str, name: &str| format!("<a href=\"{}\">{}</a>", escape_text(to), escape_text(name));
        let mut html = format!("<article class=\"model\"><h2>{}</h2>\n", link(&self.link, &self.title));
        html += self.picture.as_deref().unwrap_or_default();
        if let Some(text) = &self.description {
            _ = writeln!(html, "<p>{}</p>", escape_text(text));
        }
        _ = write!(html, "<p class=\"foot\"><code>{}</code>", escape_text(&self.file));
        if let Some(text) = &self.wrong {
            _ = write!(html, "<span class=\"wrong\">{}</span>", escape_text(text));
        }
        self.more.iter().for_each(|(name, to)| html += &link(to, name));
        html + "</p></article>\n"
    }
}

/// Page of a model that cannot be shown: the reason, and the text with the faulty lines marked.
pub fn trouble(file: &str, why: &str, text: &str, lines: &[usize]) -> String {
    let mut body = format!(
        "<h1>{}</h1>\n<p class=\"lead\">This model cannot be shown as it is.</p>\n",
        escape_text(file)
    );
    _ = write!(
        body,
        "<pre class=\"trouble\" data-testid=\"trouble\">{}</pre>\n<pre class=\"text\">",
        escape_text(why)
    );
    for (k, line) in text.lines().enumerate() {
        let class = if lines.contains(&(k + 1)) { " class=\"at\"" } else { "" };
        _ = write!(body, "<span{class}>{}</span>", escape_text(line));
    }
    sheet(file, &(body + "</pre>"))
}

/// Page in place of a model that is not there: the reason, and a link to the models that are.
pub fn missing(file: &str, why: &str, models: &str) -> String {
    let [title, why, models] = [file, why, models].map(escape_text);
    let lead = format!("<p class=\"lead\" data-testid=\"trouble\">{why}.</p>");
    sheet(file, &format!("<h1>{title}</h1>\n{lead}\n<p><a href=\"{models}\">Models in this folder</a></p>"))
}

fn sheet(title: &str, body: &str) -> String {
    fill(include_str!("../page/sheet.html"), |slot| match slot {
        "title" => escape_text(title),
        "style" => include_str!("../page/app.css").to_owned(),
        "sheet" => include_str!("../page/sheet.css").to_owned(),
        "body" => body.to_owned(),
        _ => panic!("the template of sheets names an unknown slot `{slot}`"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_a_model_is_no_markup() {
        let page = trouble("<x>.toml", "error: `<b>`", "a = \"<script>\"\nb", &[2]);
        assert!(!page.contains("<script>") && !page.contains("<b>") && !page.contains("<x>"));
        assert!(page.contains("<span class=\"at\">b</span>"));
        let page = missing("<x>.toml", "there is no `<x>`", "/?a&b");
        assert!(!page.contains("<x>") && page.contains("<a href=\"/?a&amp;b\">"));
    }
}
