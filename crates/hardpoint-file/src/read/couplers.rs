//! Couplers: gears, racks, belts, and linear relations between joint coordinates.

use hardpoint::joint::Quantity;
use hardpoint::model::{CouplerDraft, CouplerKindDraft, Section, TermDraft};

use super::{Raw, coordinate_quantity};
use crate::places::EntryPlace;
use crate::tree::{Fields, Key, Reader};

const TYPES: [&str; 6] = ["gear", "bevel", "rack", "rack_and_pinion", "belt", "linear"];
const GEARS: &[Key] =
    &[("type", "\"gear\""), ("joints", "[\"J1\", \"J2\"]"), ("teeth", "[20, 40]"), ("internal", "true")];
const RACK: &[Key] =
    &[("type", "\"rack\""), ("rack", "\"slide\""), ("pinion", "\"hinge\""), ("radius", "12.5")];
const BELT: &[Key] =
    &[("type", "\"belt\""), ("joints", "[\"J1\", \"J2\"]"), ("radii", "[20, 40]"), ("crossed", "true")];
const LINEAR: &[Key] = &[
    ("type", "\"linear\""),
    ("terms", "[{ joint = \"J1\", coefficient = 2 }, { joint = \"J2\", coefficient = -1 }]"),
];
const TERM: &[Key] = &[("joint", "\"J1\""), ("coordinate", "\"angle\""), ("coefficient", "2")];
const COUPLER: &[Key] = &[("type", "\"gear\"")];

impl Reader<'_> {
    pub(super) fn couplers(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "couplers", "coupler") {
            let Some(kind) = self.entry_type("coupler", &entry, &TYPES, COUPLER) else { continue };
            let keys = match kind {
                "gear" | "bevel" => GEARS,
                "rack" | "rack_and_pinion" => RACK,
                "belt" => BELT,
                _ => LINEAR,
            };
            let fields = self.entry("coupler", &entry, keys);
            let mut place = EntryPlace::of(&fields);
            let kind = match kind {
                "gear" | "bevel" => self.gears(&fields),
                "rack" | "rack_and_pinion" => self.rack(&fields, &mut place),
                "belt" => self.belt(&fields),
                _ => self.linear(&fields, raw),
            };
            if let Some(kind) = kind {
                raw.places.push(Section::Couplers, place);
                raw.draft.couplers.push(CouplerDraft { name: entry.0, kind });
            }
        }
    }

    fn gears(&mut self, fields: &Fields<'_>) -> Option<CouplerKindDraft> {
        let joints = self.joint_pair(fields);
        let teeth = self.pair_of_numbers(fields, "teeth", "two numbers of teeth");
        let internal = self.flag(fields, "internal");
        Some(CouplerKindDraft::Gears { joints: joints?, teeth: teeth?, internal: internal? })
    }

    fn rack(&mut self, fields: &Fields<'_>, place: &mut EntryPlace) -> Option<CouplerKindDraft> {
        let [rack, pinion] = ["rack", "pinion"].map(|key| self.required(fields, key, "the name of a joint"));
        let radius = self.needed_number(fields, "radius").map(|r| self.units.length.metres(r));
        let named = ["rack", "pinion"].iter().filter_map(|key| fields.get(key));
        place.items("joints", named.map(|f| f.value.span()).collect());
        Some(CouplerKindDraft::Rack { rack: rack?, pinion: pinion?, radius: radius? })
    }

    fn belt(&mut self, fields: &Fields<'_>) -> Option<CouplerKindDraft> {
        let joints = self.joint_pair(fields);
        let radii = self.pair_of_numbers(fields, "radii", "two radii");
        let radii = radii.map(|r| r.map(|r| self.units.length.metres(r)));
        let crossed = self.flag(fields, "crossed");
        Some(CouplerKindDraft::Belt { joints: joints?, radii: radii?, crossed: crossed? })
    }

    /// The file's sum of `coefficient x coordinate` is zero in the file's units; so it must be in SI.
    fn linear(&mut self, fields: &Fields<'_>, raw: &Raw) -> Option<CouplerKindDraft> {
        let f = self.need(fields, "terms")?;
        let subject = fields.subject("terms");
        let list = self.list(f.value, &subject, "a list of tables")?;
        let terms: Vec<_> = list
            .into_iter()
            .enumerate()
            .map(|(k, v)| {
                let table = self.table(v, &subject, "a list of tables")?;
                let what = format!("entry {} of `terms` in {}", k + 1, fields.what);
                let term = self.fields(what, v.span(), table, TERM);
                let joint = self.required(&term, "joint", "the name of a joint");
                let coordinate = match term.get("coordinate") {
                    Some(f) => {
                        Some(self.name(f.value, &term.subject("coordinate"), "the name of a coordinate")?)
                    }
                    None => None,
                };
                let coefficient = self.needed_number(&term, "coefficient");
                let joint = joint?;
                let quantity = coordinate_quantity(raw, &joint, coordinate.as_deref());
                let per_si = self.units.of(quantity.unwrap_or(Quantity::Number)).1;
                Some(TermDraft { joint, coordinate, coefficient: coefficient? * per_si })
            })
            .collect();
        terms.into_iter().collect::<Option<_>>().map(CouplerKindDraft::Linear)
    }

    fn joint_pair(&mut self, fields: &Fields<'_>) -> Option<[String; 2]> {
        let f = self.need(fields, "joints")?;
        let (subject, expected) = (fields.subject("joints"), "the names of two joints");
        match f.value.get_ref().as_array() {
            Some(list) if list.len() == 2 => {
                let [a, b] = [0, 1].map(|k| self.name(&list[k], &subject, expected));
                Some([a?, b?])
            }
            _ => {
                self.wrong(f.value, &subject, expected);
                None
            }
        }
    }

    fn pair_of_numbers(&mut self, fields: &Fields<'_>, key: &str, expected: &str) -> Option<[f64; 2]> {
        let f = self.need(fields, key)?;
        self.numbers::<2>(f.value, &fields.subject(key), expected)
    }

    /// `true` or `false`; false where it is left out.
    fn flag(&mut self, fields: &Fields<'_>, key: &str) -> Option<bool> {
        match fields.get(key) {
            Some(f) => self.boolean(f.value, &fields.subject(key)),
            None => Some(false),
        }
    }
}
