//! Sources of loads: masses, forces, gravity.

use std::sync::LazyLock;

use hardpoint::draft::{ElementDraft, ElementKindDraft, ElementType, NumberDraft, Section, some_of};
use hardpoint::law::Law;
use hardpoint::model::{BodyId, ElementUnit};

use crate::ModelFile;
use crate::diagnostic::{Diagnostic, Severity};
use crate::format::{Key, Kinds, NUMBER, Table, table};
use crate::places::EntryPlace;
use crate::tree::{DIRECTION, Field, Fields, Reader};

use super::Raw;
use super::results::key;

/// Default acceleration of gravity, m/s^2 (CGPM 1901).
const STANDARD_GRAVITY: f64 = 9.80665;

pub(crate) const GRAVITY: Table = table! {
    /// Gravity.
    "Gravity":
    /// Direction of gravity.
    must "along": DIRECTION, "\"-z\"";
    /// Acceleration, in m/s^2 whatever the unit of length.
    or("9.80665") "acceleration": NUMBER, "9.81";
};
pub(crate) const MASS: Kinds = Kinds {
    name: "Mass",
    doc: "A mass on a body.",
    typed: true,
    tables: || TYPES.iter().filter(|t| t.1.table == "masses").map(|t| &t.0).collect(),
};
pub(crate) const FORCE: Kinds = Kinds {
    name: "Force",
    doc: "A force on bodies.",
    typed: true,
    tables: || TYPES.iter().filter(|t| t.1.table == "forces").map(|t| &t.0).collect(),
};

/// Other names of types of masses.
const ALIASES: [(&str, &str, &str); 3] = [
    ("cylinder", "bar", "Another name of `bar`."),
    ("tube", "bar", "Another name of `bar`, which is one with a `bore`."),
    ("box", "block", "Another name of `block`."),
];

/// Types of masses and forces, as declared in the core, with their aliases.
static TYPES: LazyLock<Vec<(Table, &'static ElementType)>> = LazyLock::new(|| {
    let tables = |own: &'static ElementType| {
        let keys: &'static [Key] = own.fields.iter().map(key).collect::<Vec<_>>().leak();
        let others = ALIASES.iter().filter(|(_, of, _)| *of == own.name);
        let others = others.map(|(name, _, summary)| (Table::new(name, summary, keys), own));
        [(Table::new(own.name, own.summary, keys), own)].into_iter().chain(others).collect::<Vec<_>>()
    };
    ElementType::ALL.iter().flat_map(tables).collect()
});
static MASSES: LazyLock<Vec<(Table, &'static ElementType)>> = LazyLock::new(|| of_table("masses"));
static FORCES: LazyLock<Vec<(Table, &'static ElementType)>> = LazyLock::new(|| of_table("forces"));

fn of_table(name: &str) -> Vec<(Table, &'static ElementType)> {
    TYPES.iter().filter(|t| t.1.table == name).copied().collect()
}

/// HP0253: notes on a model with loads whose bodies have no mass, or whose gravity has no effect.
pub(crate) fn weightless(file: &ModelFile) -> Option<Diagnostic> {
    let model = &file.model;
    let heavy: Vec<BodyId> = model.elements.iter().filter_map(|e| e.kind.mass_on(model)).collect();
    if heavy.is_empty() {
        let falls = model.gravity.norm() > 0.0;
        return falls.then(|| {
            file.diagnostic(Severity::Note, "HP0253", "gravity has no effect: no body has mass", None)
                .help("give the bodies `[masses]`, or remove `[gravity]`")
        });
    }
    let light = (1..model.bodies.len()).filter(|b| !heavy.contains(&BodyId(*b)));
    let light: Vec<usize> = light.collect();
    let names: Vec<String> = light.iter().map(|b| format!("`{}`", model.bodies[*b].name)).collect();
    let message = match &names[..] {
        [] => return None,
        [one] => format!("body {one} has no mass"),
        several => format!("{} bodies have no mass: {}", several.len(), some_of(several, ", ", MOST_NAMES)),
    };
    // `Section::Bodies` counts as the model does: ground is the first.
    let first = (Section::Bodies, light[0]);
    let d = file.diagnostic(Severity::Note, "HP0253", message, Some(first));
    Some(
        d.note("a body without mass transmits forces and needs none")
            .help("add it to `[masses]` if its weight or inertia matters"),
    )
}

/// Number of bodies without mass that are named.
const MOST_NAMES: usize = 8;

impl Reader<'_> {
    pub(super) fn gravity(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        let Some(f) = model.get("gravity") else { return };
        let subject = model.subject("gravity");
        let read = self.table(f.value, &subject, "a table with the direction of gravity").and_then(|table| {
            let fields = self.fields("`gravity`", f.value.span(), table, GRAVITY.keys());
            let along = self.vector_of(&fields, "along");
            let size = self.number_of(&fields, "acceleration").unwrap_or(STANDARD_GRAVITY);
            let along = along?;
            let unit = along.unit();
            if unit.is_none() {
                let at = fields.get("along").map_or(fields.at.clone(), |f| f.value.span());
                self.senseless(at, "the `along` of `gravity` has no direction").help =
                    Some("give a non-zero vector, like [0, 0, -1]".into());
            }
            Some(unit? * size)
        });
        if read.is_none() {
            raw.draft.unread.note(Section::Model, 0, "gravity");
        }
        self.unread.clear();
        raw.draft.gravity = read.unwrap_or_default();
    }

    pub(super) fn masses(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        self.elements(model, ("masses", "mass"), &MASSES, Section::Masses, raw);
    }

    pub(super) fn forces(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        self.elements(model, ("forces", "force"), &FORCES, Section::Forces, raw);
    }

    fn elements(
        &mut self,
        model: &Fields<'_>,
        (table, one): (&'static str, &str),
        types: &'static [(Table, &'static ElementType)],
        section: Section,
        raw: &mut Raw,
    ) {
        for entry in self.entries(model, table, one) {
            let (place, kind) = match self.entry_type(one, &entry, types) {
                Some((table, own)) => {
                    let fields = self.entry(one, &entry, table.typed_keys());
                    let mut place = EntryPlace::of(&fields);
                    let mut unread = false;
                    let kind = own.draft(|field| self.own_field(field, &fields, &mut place, &mut unread));
                    (place, kind.filter(|_| !unread))
                }
                None => (EntryPlace::at(entry.1.clone()), None),
            };
            self.unread.clear();
            if kind.is_none() {
                self.unread.push("");
            }
            self.push(raw, section, place);
            let draft = ElementDraft::new(entry.0, kind.unwrap_or(ElementKindDraft::Unread));
            match section {
                Section::Masses => raw.draft.masses.push(draft),
                _ => raw.draft.forces.push(draft),
            }
        }
    }

    /// A number of a mass or force: by itself, or by an expression that the core evaluates.
    pub(super) fn element_number(
        &mut self,
        fields: &Fields<'_>,
        f: Field<'_>,
        unit: ElementUnit,
    ) -> Option<NumberDraft> {
        let subject = fields.subject(f.key);
        let per_unit = self.units.per_si_of(unit);
        if f.value.get_ref().is_str() {
            let expression = self.expression(f.value, &subject)?;
            return Some(NumberDraft { value: 0.0, expression: Some(expression), per_unit });
        }
        let value = self.number(f.value, &subject)?;
        Some(NumberDraft { value: self.units.to_si_of(unit, value), expression: None, per_unit })
    }

    /// Law that scales a force over time.
    pub(super) fn factor_law(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<Law> {
        let law = self.law(fields, f);
        if !self.law_formulas.is_empty() {
            self.law_formulas.clear();
            self.senseless(f.value.span(), "the law of a force has a parameter that an expression gives")
                .help = Some(
                "write numbers in the law; the force that it multiplies may depend on parameters".into(),
            );
            return None;
        }
        law
    }
}
