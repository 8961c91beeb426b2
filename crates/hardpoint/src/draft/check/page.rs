//! Checks of the plots and the named designs.

use crate::draft::{NamedDesignDraft, PlotDraft, Section};
use crate::model::{NamedDesign, OutputSource, Plot, VariableId};

use super::{Checker, Here};

impl Checker<'_> {
    pub(super) fn add_plots(&mut self) {
        let draft = self.draft;
        for (index, plot) in draft.plots.iter().enumerate() {
            let here = Here { section: Section::Plots, index };
            let found = if self.unread(here, "") { None } else { self.plot(plot, here) };
            self.model.plots.extend(found);
        }
    }

    /// Resolves a plot. HP0254 if it shows nothing, a quantity over itself, or quantities of different units.
    fn plot(&mut self, plot: &PlotDraft, here: Here) -> Option<Plot> {
        if plot.y.is_empty() && !self.unread(here, "y") {
            self.fault("HP0254", here.key("y"), "the plot has no quantity on its ordinate")
                .help("name measures, like `y = [\"toe\"]`, or remove the plot");
            return None;
        }
        let y: Vec<Option<OutputSource>> =
            plot.y.iter().enumerate().map(|(k, name)| self.output(name, here.item("y", k))).collect();
        let is_time = plot.over == PlotDraft::TIME && self.number_of("measure", PlotDraft::TIME).is_none();
        let over = match is_time {
            true => Some(None),
            false => self.abscissa(&plot.over, here).map(Some),
        };
        let y = y.into_iter().collect::<Option<Vec<_>>>()?;
        let over = over?;
        if let Some(k) = y.iter().position(|of| Some(*of) == over) {
            let message = format!("`{}` is drawn over itself", plot.y[k]);
            self.fault("HP0254", here.item("y", k), message)
                .help("name another measure in `over`, or `over = \"time\"`");
            return None;
        }
        if let Some(k) = (1..y.len()).find(|k| y[..*k].contains(&y[*k])) {
            self.fault("HP0254", here.item("y", k), format!("`{}` is listed twice", plot.y[k]))
                .help("remove one of the two");
            return None;
        }
        if self.model.measures.len() < self.draft.measures.len() {
            // The unit of a faulty measure is unknown.
            return None;
        }
        let dimension = self.model.dimension(y[0]);
        if let Some(k) = y.iter().position(|of| self.model.dimension(*of) != dimension) {
            let message = format!("`{}` and `{}` have different units", plot.y[0], plot.y[k]);
            self.fault("HP0254", here.item("y", k), message)
                .note("all curves of a plot share its ordinate")
                .help(format!("give `{}` a plot of its own", plot.y[k]));
            return None;
        }
        Some(Plot { y, over })
    }

    /// Output on the abscissa. A driver has none of its own, so a measure that follows it is suggested.
    fn abscissa(&mut self, name: &str, here: Here) -> Option<OutputSource> {
        let faults = self.faults.len();
        let found = self.output(name, here.key("over"));
        let draft = self.draft;
        if let Some(k) = draft.drivers.iter().position(|d| d.name == name)
            && let Some(fault) = self.faults.get_mut(faults)
        {
            let of = &draft.drivers[k].name;
            fault.help(format!(
                "`{of}` is a driver; name a measure that follows it, or write `over = \"time\"`"
            ));
        }
        found
    }

    pub(super) fn add_designs(&mut self) {
        let draft = self.draft;
        for (index, design) in draft.designs.iter().enumerate() {
            let here = Here { section: Section::Designs, index };
            let found = if self.unread(here, "") { None } else { self.named_design(design, here) };
            self.model.designs.extend(found);
        }
    }

    /// Resolves a named design. HP0255 if it changes nothing or has a value that is not finite.
    fn named_design(&mut self, design: &NamedDesignDraft, here: Here) -> Option<NamedDesign> {
        let name = &design.name;
        if design.values.is_empty() {
            self.fault("HP0255", here.key("name"), format!("design `{name}` has no values"))
                .help("give values of design variables, like `NAME = 5`, or remove the design");
            return None;
        }
        let mut changes = Vec::new();
        for (k, (variable, value)) in design.values.iter().enumerate() {
            let Some(found) = self.variable_index(variable, here.item("variables", k)) else { continue };
            if !value.is_finite() {
                let message = format!("the value of `{variable}` in design `{name}` is not finite");
                self.fault("HP0255", here.item("values", k), message).help("give a finite number");
                continue;
            }
            let Some(quantity) = self.model.variables.get(found).map(|v| v.quantity) else { continue };
            let id = VariableId(found);
            changes.push((id, self.in_si(id, quantity, *value, [design.per_metre, design.per_radian])));
        }
        Some(NamedDesign { name: name.clone(), changes })
    }
}
