//! Hardpoints, and the nominal values of parameters and hardpoints.

use hardpoint::draft::{FormulaDraft, FormulaOf, HardpointDraft, LocationDraft, Nominal, Section};
use hardpoint::space::Vec3;

use crate::values::{EntryPlace, Fields, Reader, Subject, above_tables, shown};

use super::raw::Raw;

pub(super) fn hardpoints(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let example = if r.plane.is_some() { "[100.0, -50.5]" } else { "[100.0, 0, -50.5]" };
    for (name, at, value) in r.entries(model, "hardpoints", "hardpoint") {
        let subject = Subject {
            name: format!("hardpoint `{name}`"),
            example: above_tables(&name)
                .unwrap_or_else(|| format!("for example `{} = {example}`", shown(&name))),
        };
        r.unread.clear();
        let mut place = EntryPlace::at(at);
        place.key("position", value);
        let position = match r.written_place(value, &subject, "") {
            Some(LocationDraft::At(position)) => position,
            Some(LocationDraft::Formula(coordinates)) => {
                for (axis, expression) in coordinates.into_iter().enumerate() {
                    let of = FormulaOf::Coordinate(name.clone(), axis);
                    raw.draft.formulas.push(FormulaDraft { of, expression });
                }
                Vec3::ZERO
            }
            _ => {
                r.unread.push("position");
                Vec3::ZERO
            }
        };
        raw.push(r, Section::Hardpoints, place);
        raw.hardpoint_numbers.entry(name.clone()).or_insert(raw.draft.hardpoints.len());
        raw.draft.hardpoints.push(HardpointDraft { name, position });
    }
}

/// Computes the nominal values of parameters and hardpoints, all at once.
pub(super) fn settle(r: &mut Reader<'_>, raw: &mut Raw) {
    if raw.draft.parameters.is_empty() && raw.draft.formulas.is_empty() {
        return;
    }
    r.nominal = Nominal::of(&raw.draft);
    for (hardpoint, position) in raw.draft.hardpoints.iter_mut().zip(&r.nominal.positions) {
        hardpoint.position = *position;
    }
}
