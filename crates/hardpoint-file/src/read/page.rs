//! Plots that a page opens with, and named designs.

use hardpoint::draft::{NamedDesignDraft, PlotDraft, Section};

use crate::values::{EntryPlace, Fields, NUMBER, OUTPUT, Reader, Shape, Subject, Table, shown, table};

use super::raw::Raw;

/// Maximum number of plots.
const MOST_PLOTS: usize = 100;
pub(crate) const PAGE: Table = table! {
    /// Contents of the report's page.
    "Page":
    /// Plots that it opens with, in this order. Default: those that suit the mechanism, such as toe and camber over
    /// wheel travel.
    may "plots": Shape::list(&Shape::Table(&PLOT)), "[{ y = [\"left.toe\", \"right.toe\"], over = \"left.wheel_travel\" }]";
};
pub(crate) const PLOT: Table = table! {
    /// A plot of measures of the same unit.
    "Plot":
    /// Measures on the ordinate, or components of points.
    must "y": Shape::some(&OUTPUT), "[\"toe\"]";
    /// Measure on the abscissa, a component of a point, or `"time"`.
    or("\"time\"") "over": OUTPUT, "\"wheel_travel\"";
};
/// A named design.
pub(crate) const DESIGN: Shape = Shape::Entries("a design variable", &NUMBER);

pub(super) fn page(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let Some(f) = model.get("page") else { return };
    let mut subject = model.subject("page");
    subject.example = "write `[page]`, in single brackets, and `plots = [...]` below it".into();
    let Some(table) = r.table(f.value, &subject, "one table") else { return };
    let fields = r.fields("`page`", f.at.0..f.at.1, table, PAGE.keys());
    let subject = fields.subject("plots");
    let Some(f) = fields.get("plots") else { return };
    let Some(list) = r.list(f.value, &subject, "a list of plots") else { return };
    if list.len() > MOST_PLOTS {
        let message = format!("{} has {} entries", subject.name, list.len());
        r.senseless(f.value.span(), message).help = Some(format!("give at most {MOST_PLOTS}"));
        return;
    }
    for (k, value) in list.into_iter().enumerate() {
        r.unread.clear();
        let subject = subject.item(k);
        let Some(table) = r.table(value, &subject, "a table with `y` and `over`") else { continue };
        let fields = r.fields(format!("plot {} of `page`", k + 1), value.span(), table, PLOT.keys());
        let place = EntryPlace::of(&fields);
        let y = r.list_of_names(&fields, "y", "the plots that suit the mechanism");
        let over = r.name_of(&fields, "over");
        if !r.unread.is_empty() {
            r.unread.push("");
        }
        raw.push(r, Section::Plots, place);
        raw.draft.plots.push(PlotDraft { y: y.unwrap_or_default(), over: over.unwrap_or_default() });
    }
}

pub(super) fn designs(r: &mut Reader<'_>, model: &Fields<'_>, raw: &mut Raw) {
    let (per_metre, per_radian) = (r.units.length.per_metre(), r.units.angle.per_radian());
    for (name, at, value) in r.entries(model, "designs", "design") {
        r.unread.clear();
        let subject = Subject {
            name: format!("design `{}`", shown(&name)),
            example: "give values of design variables, like `NAME = 5`".into(),
        };
        let mut place = EntryPlace::at(at);
        let table = r.table_of_names(value, &subject, "a table of design variables and their values");
        let (mut names, mut items, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for (variable, value) in table.into_iter().flatten() {
            let what = format!("the name of a design variable in {}", subject.name);
            let short = r.short(variable.get_ref(), variable.span(), &what);
            let of = Subject {
                name: format!("the value of `{}` in {}", shown(variable.get_ref()), subject.name),
                example: "give a number in the unit of the variable, like `5`".into(),
            };
            match short.zip(r.number(value, &of)) {
                Some(found) => {
                    names.push(variable.span());
                    items.push(value.span());
                    values.push(found);
                }
                None => r.unread.push(""),
            }
        }
        if table.is_none() {
            r.unread.push("");
        }
        place.items("variables", names);
        place.items("values", items);
        raw.push(r, Section::Designs, place);
        raw.draft.designs.push(NamedDesignDraft { name, values, per_metre, per_radian });
    }
}
