//! Names in the unit.

use std::collections::HashSet;

use hardpoint_file::ModelFile;

use crate::c::MotionSource;

/// Names in the unit, in the order of the model: drivers, design variables, measures, and bodies without ground.
pub(super) struct StructuredNames {
    pub drivers: Vec<(String, String)>,
    pub design: Vec<(String, String)>,
    pub measures: Vec<(String, String)>,
    pub bodies: Vec<(String, String)>,
}

impl StructuredNames {
    pub fn of(file: &ModelFile, source: &MotionSource) -> Self {
        let model = &file.model;
        Self {
            drivers: unique(model.drivers.iter().map(|driver| driver.name.as_str())),
            design: unique(source.design.iter().map(|of| model.variables[*of].name.as_str())),
            measures: unique(source.measures.iter().map(|measure| measure.output.name.as_str())),
            bodies: unique(model.bodies.iter().skip(1).map(|body| body.name.as_str())),
        }
    }

    /// Names with characters that names of units do not have, with those in the unit.
    pub fn renamed(&self) -> impl Iterator<Item = (&str, &str)> {
        let all = [&self.drivers, &self.design, &self.measures, &self.bodies].into_iter().flatten();
        all.filter(|(name, _)| plain(name) != *name).map(|(name, unit)| (name.as_str(), unit.as_str()))
    }
}

/// Names with those in the unit. The grammar of names has ASCII characters only, so `_` replaces others; among equal
/// ones, `_2`, `_3` and so on follow, as in the C source.
fn unique<'n>(names: impl Iterator<Item = &'n str> + Clone) -> Vec<(String, String)> {
    let mut taken: HashSet<String> =
        names.clone().filter(|name| plain(name) == **name).map(str::to_owned).collect();
    let one = |name: &str| {
        let plain = plain(name);
        let mut unit = plain.clone();
        if plain != name {
            let mut count = 1;
            while !taken.insert(unit.clone()) {
                count += 1;
                unit = format!("{plain}_{count}");
            }
        }
        (name.to_owned(), structured(&unit))
    };
    names.map(one).collect()
}

/// Name in the characters that names of units have.
fn plain(name: &str) -> String {
    let plain = |c: char| if (c.is_ascii_graphic() || c == ' ') && c != '`' { c } else { '_' };
    name.chars().map(plain).collect()
}

/// ASCII name by the structured naming convention: identifiers that are separated by dots, and quoted ones.
fn structured(name: &str) -> String {
    let is_identifier = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    if name.split('.').all(is_identifier) {
        return name.to_owned();
    }
    let escape = |c: char| if matches!(c, '\\' | '\'' | '"') { format!("\\{c}") } else { c.to_string() };
    let escaped: String = name.chars().map(escape).collect();
    format!("'{escaped}'")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_structured_convention() {
        assert_eq!(structured("front.camber_2"), "front.camber_2");
        assert_eq!(structured("wheel-centre"), "'wheel-centre'");
        assert_eq!(structured("2nd gear's"), "'2nd gear\\'s'");
        assert_eq!(structured("1\"-pin"), "'1\\\"-pin'");
    }

    #[test]
    fn names_outside_ascii_stay_different() {
        let names = ["α", "β", "_", "größe", "gr__e_2", "grüße", "a`b", "α β"];
        let unit: Vec<String> = unique(names.into_iter()).into_iter().map(|(_, unit)| unit).collect();
        let expected = ["__2", "__3", "_", "gr__e", "gr__e_2", "gr__e_3", "a_b", "'_ _'"];
        assert_eq!(unit, expected);
    }
}
