//! Directions of the axes of a table.

use std::str::FromStr;

/// Index and sign of the table's coordinate for forward, left and up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes([(usize, f64); 3]);

/// Conventions by name, each in words.
const NAMED: [(&[&str], &str); 4] = [
    (&["iso", "iso8855"], "x forward, y left, z up"),
    (&["sae", "saej670"], "x forward, y right, z down"),
    (&["adams", "adamscar"], "x back, y right, z up"),
    (&["lotus", "lotusshark"], "x back, y right, z up"),
];
/// Words for directions, each with its axis of ISO 8855 and its sign.
const WORDS: [(&[&str], usize, f64); 6] = [
    (&["forward", "forwards", "front"], 0, 1.0),
    (&["back", "backward", "backwards", "rear", "rearward", "rearwards"], 0, -1.0),
    (&["left", "port"], 1, 1.0),
    (&["right", "starboard"], 1, -1.0),
    (&["up", "upward", "upwards"], 2, 1.0),
    (&["down", "downward", "downwards"], 2, -1.0),
];

impl Axes {
    /// Converts a point of the table to the axes of ISO 8855.
    pub fn turned(self, place: [f64; 3]) -> [f64; 3] {
        // No -0.
        self.0.map(|(k, sign)| place[k] * sign + 0.0)
    }
}

impl FromStr for Axes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let name = plain(text);
        let words = NAMED.iter().find(|n| n.0.contains(&name.as_str())).map_or(text, |n| n.1);
        let like = "write them like \"x back, y right, z up\", or as `iso`, `sae`, `adams` or `lotus`";
        let mut found: [Option<(usize, f64)>; 3] = [None; 3];
        let mut taken = [false; 3];
        for part in words.split(',') {
            let mut both = part.split_whitespace();
            let (Some(axis), Some(word), None) = (both.next(), both.next(), both.next()) else {
                return Err(format!("`{}` is not an axis with a direction; {like}", part.trim()));
            };
            let (axis, word) = (axis.to_lowercase(), word.to_lowercase());
            let Some(k) = ["x", "y", "z"].iter().position(|a| *a == axis) else {
                return Err(format!("`{axis}` is not an axis; {like}"));
            };
            let Some((_, along, sign)) = WORDS.iter().find(|w| w.0.contains(&word.as_str())) else {
                return Err(format!("`{word}` is not a direction; {like}"));
            };
            if std::mem::replace(&mut taken[k], true) {
                return Err(format!("`{axis}` occurs twice; {like}"));
            }
            if found[*along].replace((k, *sign)).is_some() {
                return Err(format!("two axes go forward or back, left or right, or up or down; {like}"));
            }
        }
        match found {
            [Some(a), Some(b), Some(c)] => Ok(Self([a, b, c])),
            _ => Err(format!("three axes are needed; {like}")),
        }
    }
}

/// Normalises a name: no capitals, hyphens and the like.
pub(super) fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_the_same_in_all_conventions() {
        // 1 forward, 2 to the left, 3 up
        for (text, place) in [
            ("iso", [1.0, 2.0, 3.0]),
            ("ISO 8855", [1.0, 2.0, 3.0]),
            ("SAE", [1.0, -2.0, -3.0]),
            ("Adams", [-1.0, -2.0, 3.0]),
            ("lotus", [-1.0, -2.0, 3.0]),
            ("x back, z up, y right", [-1.0, -2.0, 3.0]),
            ("x left, y up, z forward", [2.0, 3.0, 1.0]),
        ] {
            assert_eq!(text.parse::<Axes>().unwrap().turned(place), [1.0, 2.0, 3.0], "{text}");
        }
    }

    #[test]
    fn invalid_axes_are_rejected() {
        for (text, part) in [
            ("x back, y right", "three axes"),
            ("x back, y forward, z up", "two axes"),
            ("x back, x right, z up", "twice"),
            ("x back, y sideways, z up", "`sideways`"),
            ("w back, y right, z up", "`w`"),
            ("marine", "`marine`"),
        ] {
            let error = text.parse::<Axes>().unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
