//! Replacement of characters that other formats do not support in names.

use std::collections::HashSet;

use hardpoint_file::ModelFile;

use crate::ExportedModel;

/// Returns a copy of the file with names that every format supports, or `None` if no name has to change. Control
/// characters are replaced: XML cannot represent them, and elsewhere they would begin new lines. Every changed name is
/// reported.
pub fn with_supported_names(file: &ModelFile, out: &mut ExportedModel) -> Option<ModelFile> {
    let model = &file.model;
    let names = model.bodies.iter().map(|b| &b.name).chain(model.joints.iter().map(|j| &j.name));
    let others = model.couplers.iter().map(|c| &c.name).chain(model.hardpoints.iter().map(|h| &h.name));
    if !names.chain(others).chain([&model.name]).any(|name| !is_supported(name)) {
        return None;
    }
    let mut file = file.clone();
    let model = &mut file.model;
    replace_unsupported("model", std::iter::once(&mut model.name), out);
    replace_unsupported("body", model.bodies.iter_mut().map(|b| &mut b.name), out);
    replace_unsupported("joint", model.joints.iter_mut().map(|j| &mut j.name), out);
    replace_unsupported("coupler", model.couplers.iter_mut().map(|c| &mut c.name), out);
    replace_unsupported("hardpoint", model.hardpoints.iter_mut().map(|h| &mut h.name), out);
    Some(file)
}

/// Returns true if every format supports the character in names.
fn is_supported_char(c: char) -> bool {
    // XML 1.0 has neither control characters nor these two.
    !c.is_control() && !['\u{fffe}', '\u{ffff}'].contains(&c)
}

fn is_supported(name: &str) -> bool {
    name.chars().all(is_supported_char)
}

/// Replaces unsupported characters in names of one kind, and keeps the names unique.
fn replace_unsupported<'n>(
    kind: &'static str,
    names: impl Iterator<Item = &'n mut String>,
    out: &mut ExportedModel,
) {
    let names: Vec<&mut String> = names.collect();
    let mut taken: HashSet<String> = names.iter().filter(|n| is_supported(n)).map(|n| (*n).clone()).collect();
    for name in names.into_iter().filter(|n| !is_supported(n)) {
        let clean: String = name.chars().map(|c| if is_supported_char(c) { c } else { '_' }).collect();
        let numbered = std::iter::once(clean.clone()).chain((2..).map(|k| format!("{clean}_{k}")));
        let free = numbered.into_iter().find(|n| !taken.contains(n)).unwrap_or(clean);
        taken.insert(free.clone());
        let why = format!("the format does not support control characters: written as `{free}`");
        out.report_unsupported(kind, &name.escape_debug().to_string(), why);
        *name = free;
    }
}
