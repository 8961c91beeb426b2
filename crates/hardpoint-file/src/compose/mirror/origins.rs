//! Originals of mirrored entries, for messages: an image has no text of its own.

use std::collections::{BTreeMap, HashSet};

use crate::compose::side_names::{exchanged, is_original};
use crate::values::Diagnostic;

/// Origins of a mirror's images.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origins {
    /// Names of images, and of their originals.
    pub names: BTreeMap<String, String>,
    /// Words that are exchanged in names.
    pub(super) words: Vec<(String, String)>,
    /// Names of entries of included files, with their files.
    pub included: BTreeMap<String, String>,
}

impl Origins {
    /// Adds a prefix to these names.
    pub fn renamed(&mut self, prefix: &str, own: &HashSet<String>) {
        let say = |name: String| if own.contains(&name) { format!("{prefix}{name}") } else { name };
        self.names = std::mem::take(&mut self.names).into_iter().map(|(a, b)| (say(a), say(b))).collect();
        self.included = std::mem::take(&mut self.included).into_iter().map(|(a, b)| (say(a), b)).collect();
    }
}

/// Reports each error once, under the name of the entry that was written; errors of images name their original.
pub(crate) fn deduplicated(list: Vec<Diagnostic>, origins: &Origins) -> Vec<Diagnostic> {
    if origins.words.is_empty() {
        return list;
    }
    let key = |d: &Diagnostic| {
        let (message, made) = in_original_names(&d.message, origins);
        ((d.code, d.span.as_ref().map(|s| (s.start, s.end)), message), made)
    };
    let own: HashSet<_> = list.iter().map(key).filter(|(_, made)| made.is_none()).map(|k| k.0).collect();
    let mut seen = HashSet::new();
    let keeps = |d: &Diagnostic| {
        let (key, made) = key(d);
        (made.is_none() || !own.contains(&key)) && seen.insert(key)
    };
    let mut keeps = keeps;
    list.into_iter().filter(|d| keeps(d)).map(|d| with_origin(d, origins)).collect()
}

/// Adds a note if the diagnostic refers to an image.
pub(crate) fn with_origin(diagnostic: Diagnostic, origins: &Origins) -> Diagnostic {
    match in_original_names(&diagnostic.message, origins).1.filter(|made| origins.names.contains_key(made)) {
        Some(made) => {
            let note = format!("`{made}` is the mirror image of `{}`", origins.names[&made]);
            diagnostic.note(note)
        }
        None => diagnostic,
    }
}

/// Message in terms of the original, and the first name of an image in it.
fn in_original_names(message: &str, origins: &Origins) -> (String, Option<String>) {
    let mut made = None;
    let parts = message.split('`').enumerate().map(|(k, part)| {
        let base = part.split('.').next().unwrap_or(part);
        let is_image = k % 2 == 1 && is_original(part, &origins.words) == Some(false);
        match exchanged(part, &origins.words).filter(|_| is_image) {
            Some(original) => {
                made = made.take().or(Some(base.to_owned()));
                original
            }
            None => part.to_owned(),
        }
    });
    let said = parts.collect::<Vec<_>>().join("`");
    (said, made)
}
