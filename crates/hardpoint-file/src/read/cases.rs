//! Cases: several motions of one mechanism.

use std::collections::{HashMap, HashSet};

use hardpoint::draft::{CaseDraft, FormulaDraft, FormulaOf, Rest, Section};
use hardpoint::joint::Quantity;
use hardpoint::law::Law;

use crate::diagnostic::shown;
use crate::format::{Shape, Table, table};
use crate::places::EntryPlace;
use crate::tree::{Field, Fields, MOST_ENTRIES, Reader, Subject};

use super::results::{MOST_TIMES, TIME};
use super::{Raw, law};

/// More cases than this are surely a slip.
const MOST_CASES: usize = 1000;
pub(crate) const CASE: Table = table! {
    /// A motion of the mechanism, with laws and output times of its own.
    "Case":
    /// The laws of the drivers that it moves, by the drivers' names; each as the `law` of a driver.
    or("{}") "laws": Shape::Entries(&law::LAW), "{ bump = \"40*sin(2*pi*t)\" }";
    /// What all other drivers do.
    or("\"held\"") "rest": REST, "\"as_above\"";
    /// Its output times, as `[time]` has them. Default: those of `[time]`.
    may "time": Shape::Kinds(&TIME), "{ end = 1.0, steps = 100 }";
};
const REST: Shape = Shape::Words(&[
    ("held", "They are held as drawn: their law is 0."),
    ("as_above", "They follow the laws that they have in `[drivers]`."),
]);
const RESTS: [Rest; 2] = [Rest::Held, Rest::AsAbove];

impl Reader<'_> {
    pub(super) fn cases(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        let entries = self.entries(model, "cases", "case");
        if let (Some(f), true) = (model.get("cases"), entries.len() > MOST_CASES) {
            let message = format!("there are {} cases", entries.len());
            self.senseless(f.value.span(), message).help = Some(format!("give at most {MOST_CASES}"));
            raw.draft.unread.note(Section::Model, 0, "cases");
            return;
        }
        let driven = raw.draft.drivers.iter().zip(&raw.driven).map(|(d, q)| (d.name.clone(), *q));
        let driven: HashMap<String, Quantity> = driven.collect();
        let mut outputs = 0;
        for entry in entries {
            let fields = self.entry("case", &entry, CASE.keys());
            let mut place = EntryPlace::of(&fields);
            let formulas = &mut raw.draft.formulas;
            let laws = self.given(&fields, "laws", |r, f| {
                r.case_laws(&entry.0, &fields, f, &mut place, &driven, formulas)
            });
            let rest = self.word_of(&fields, "rest").map(|k| RESTS[k]);
            let mut times = self.given(&fields, "time", |r, f| {
                r.times(&format!("`time` of {}", fields.what), &fields.subject("time"), f)
            });
            outputs += times.as_ref().unwrap_or(&raw.draft.times).len();
            if outputs > MOST_TIMES as usize {
                let message = format!("the cases have more than {MOST_TIMES} output times together");
                self.senseless(entry.1.clone(), message).help = Some("ask for fewer `steps`".into());
                self.unread.push("time");
                times = Some(Vec::new());
            }
            let laws = laws.unwrap_or_default();
            if rest == Some(Rest::AsAbove) && !self.unread.contains(&"laws") {
                self.laws_of_their_own(&fields, &laws, raw);
            }
            self.push(raw, Section::Cases, place);
            raw.draft.cases.push(CaseDraft { name: entry.0, laws, rest: rest.unwrap_or_default(), times });
        }
    }

    /// HP0104: drivers that have no laws to follow in this case.
    fn laws_of_their_own(&mut self, fields: &Fields<'_>, laws: &[(String, Law)], raw: &Raw) {
        let named: HashSet<&str> = laws.iter().map(|law| law.0.as_str()).collect();
        let without = raw.without_law.iter().map(|k| &raw.draft.drivers[*k].name);
        let without: Vec<&String> = without.filter(|name| !named.contains(name.as_str())).collect();
        let Some(first) = without.first() else { return };
        let names: Vec<String> = without.iter().map(|name| format!("`{}`", shown(name))).collect();
        let names = hardpoint::draft::some_of(&names, ", ", 12);
        let what = if without.len() == 1 { "driver" } else { "drivers" };
        let at = fields.get("rest").map_or(fields.at.clone(), |f| f.value.span());
        let message = format!("{} leaves {what} {names} to a `law` that is not there", fields.what);
        self.report("HP0104", at, message).help = Some(format!(
            "give one in the case, like `laws = {{ {first} = \"10*t\" }}`, or in `[drivers.{first}]`, or hold it with `rest = \"held\"`"
        ));
    }

    /// The laws of a case, in SI.
    fn case_laws(
        &mut self,
        case: &str,
        fields: &Fields<'_>,
        f: Field<'_>,
        place: &mut EntryPlace,
        driven: &HashMap<String, Quantity>,
        formulas: &mut Vec<FormulaDraft>,
    ) -> Option<Vec<(String, Law)>> {
        let subject = fields.subject("laws");
        let table = self.table(f.value, &subject, "a table of drivers' names and laws")?;
        if table.len() > MOST_ENTRIES {
            self.too_many(f.value.span(), &subject.name, table.len());
            return None;
        }
        let (mut laws, mut names, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut complete = true;
        for (name, value) in table {
            let Some(driver) = self.short(name.get_ref(), name.span(), "the name of a driver") else {
                complete = false;
                continue;
            };
            let of = format!("driver `{}` in {}", shown(&driver), fields.what);
            let subject = Subject {
                name: format!("the law of {of}"),
                example: "for example `\"30*sin(2*pi*t)\"`".into(),
            };
            let law = self.law_in(&of, &subject, value);
            let quantity = driven.get(&driver).copied().unwrap_or(Quantity::Number);
            for (parameter, expression) in self.law_formulas.drain(..) {
                let of = FormulaOf::CaseLaw(case.to_owned(), driver.clone(), parameter);
                formulas.push(FormulaDraft { of, expression });
            }
            complete &= law.is_some();
            if let Some(law) = law {
                names.push(name.span());
                values.push(value.span());
                laws.push((driver, law.scaled(self.units.to_si(quantity, 1.0))));
            }
        }
        place.items("laws", names);
        place.items("law", values);
        if !complete {
            self.unread.push("laws");
            self.unread.push("law");
        }
        Some(laws)
    }
}
