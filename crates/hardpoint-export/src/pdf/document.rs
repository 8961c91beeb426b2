//! The document: its parts, in their order.

use std::io::{self, Write};

use hardpoint::joint::Quantity;
use hardpoint_file::{Diagnostic, Severity};
use hardpoint_report::GENERATOR;
use hardpoint_report::figures::{count, number, order_unit, rounded, unit, with_unit};
use hardpoint_report::summary::Ranking;

use super::paper::{BLACK, BLUE, GREY, MARGIN, PAGE, Paper, RED, SMALL, STRONG, TEXT, TITLE};
use super::parts::{DesignResult, PdfContent, PdfPart};
use super::picture::picture;
use super::plot::{self, Plot};
use crate::workbook::RunDocument;

/// Maximum number of curves.
const MOST_CURVES: usize = 200;
/// Maximum number of variables in the ranking of a measure.
const MOST_RANKED: usize = 12;
/// Positions of the columns of tables.
const FACTS: [f32; 2] = [0.0, 90.0];
const FIGURES: [f32; 3] = [0.0, 130.0, 220.0];
const VARIABLES: [f32; 4] = [0.0, 130.0, 220.0, 400.0];
const RANKED: [f32; 4] = [0.0, 170.0, 290.0, 410.0];
const POINTS: [f32; 4] = [0.0, 190.0, 280.0, 370.0];
/// Metrics of designs side by side, in a table of this width of columns.
const DESIGNS: usize = 4;
const METRIC: f32 = 130.0;
/// Changes of coordinates below this are round-off, m.
const SAME_PLACE: f64 = 1e-12;
/// Significant digits of coordinates.
const PLACE_DIGITS: usize = 8;
/// Length of the longest bar of a ranking.
const BAR: f32 = 110.0;

impl RunDocument<'_> {
    /// Writes the document and returns notes on omitted data.
    ///
    /// # Errors
    /// Fails if `out` cannot be written.
    pub fn write_pdf(&self, content: &PdfContent, out: &mut impl Write) -> io::Result<Vec<String>> {
        let mut paper = Paper::new();
        self.head(&mut paper);
        let mut left_out = Vec::new();
        for part in PdfPart::ALL.into_iter().filter(|part| content.has(*part)) {
            match part {
                PdfPart::Picture => picture(&mut paper, &content.picture),
                PdfPart::Metrics => self.metrics(&mut paper, &content.designs),
                PdfPart::Hardpoints => self.places(&mut paper, &content.designs),
                PdfPart::Variables => self.variables(&mut paper),
                PdfPart::Curves => left_out.extend(self.drawn(&mut paper)),
                PdfPart::Influence => left_out.extend(self.influence(&mut paper)),
            }
        }
        paper.end(&self.summary.model.name, GENERATOR, out)?;
        Ok(left_out.into_iter().map(|left_out| format!("not in `report.pdf`: {left_out}")).collect())
    }

    /// Writes the most influential variables of each measure; returns a note on omitted ones.
    fn influence(&self, paper: &mut Paper) -> Option<String> {
        let rankings =
            self.summary.sensitivities.iter().filter(|r| r.order == "value" && !r.largest.is_empty());
        let rankings: Vec<&Ranking> = rankings.collect();
        if !rankings.is_empty() {
            paper.heading("Most influential variables", 3.0 * TEXT.line());
            let most = "The largest sensitivity to each variable over the motion, with its sign and time; bars compare variables of one unit.";
            paper.paragraph(TEXT, GREY, most);
        }
        rankings.iter().for_each(|ranking| ranked(paper, ranking));
        rankings.iter().any(|ranking| ranking.largest.len() > MOST_RANKED).then(|| {
            format!(
                "only the {MOST_RANKED} most influential variables of each measure are shown; `summary.json` has all"
            )
        })
    }

    /// Writes the name of the model and the facts of the run.
    fn head(&self, paper: &mut Paper) {
        let summary = self.summary;
        paper.paragraph(TITLE, BLACK, &summary.model.name);
        paper.y -= 4.0;
        summary.model.description.iter().for_each(|said| paper.paragraph(TEXT, GREY, said));
        paper.y -= 6.0;
        let counts = &summary.model.counts;
        let parts = format!(
            "{}, {}, {}, {}, {}",
            if counts.bodies == 1 { "1 body".into() } else { format!("{} bodies", counts.bodies) },
            count(counts.joints, "joint"),
            count(counts.loops, "loop"),
            count(counts.drivers, "driver"),
            count(summary.model.variables.len(), "design variable"),
        );
        let facts = self.facts().into_iter().chain([("mechanism", parts)]);
        facts.for_each(|(what, said)| paper.row(TEXT, &FACTS, &[what, &said]));
        if let Some(margin) = summary.margin.as_ref() {
            let least = format!("{} at t = {} s", number(margin.least), number(margin.time));
            paper.row(TEXT, &FACTS, &["minimum margin", &least]);
        }
        let worth = |d: &&Diagnostic| d.severity != Severity::Note;
        for d in summary.diagnostics.iter().filter(worth) {
            paper.row(TEXT, &FACTS, &[d.code, &d.message]);
        }
    }

    /// Writes the metrics, and those of the named designs next to them.
    fn metrics(&self, paper: &mut Paper, designs: &[DesignResult]) {
        let (summary, model) = (self.summary, &self.file.model);
        if !summary.metrics.is_empty() {
            paper.heading("Key figures", 2.0 * TEXT.line());
            paper.row(STRONG, &FIGURES, &["metric", "value", "what"]);
            for metric in &summary.metrics {
                let value = metric.value.map_or("-".into(), |value| with_unit(value, &metric.unit));
                paper.row(TEXT, &FIGURES, &[&metric.name, &value, &metric.what]);
            }
        }
        for designs in designs.chunks(DESIGNS).filter(|_| !model.metrics.is_empty()) {
            paper.heading("Key figures by design", 2.0 * TEXT.line());
            let width = (PAGE.0 - 2.0 * MARGIN - METRIC) / (designs.len() + 1) as f32;
            let columns: Vec<f32> =
                [0.0].into_iter().chain((0..=designs.len()).map(|k| METRIC + k as f32 * width)).collect();
            let names = ["metric", "nominal"].into_iter().chain(designs.iter().map(|d| d.name.as_str()));
            paper.row(STRONG, &columns, &names.collect::<Vec<_>>());
            for (k, (metric, nominal)) in model.metrics.iter().zip(&summary.metrics).enumerate() {
                let of = model.metric_dimension(metric);
                let shown =
                    |value: Option<f64>| value.map_or("-".into(), |value| with_unit(value, &nominal.unit));
                let others = designs.iter().map(|d| d.metrics[k].map(|x| self.file.units.from_si(of, x)));
                let values: Vec<String> = [nominal.value].into_iter().chain(others).map(shown).collect();
                let cells = [metric.name.as_str()].into_iter().chain(values.iter().map(String::as_str));
                paper.row(TEXT, &columns, &cells.collect::<Vec<_>>());
            }
        }
    }

    /// Writes the hardpoints, and the coordinates that each named design changes.
    fn places(&self, paper: &mut Paper, designs: &[DesignResult]) {
        let (model, units) = (&self.file.model, self.file.units);
        let length = unit(units, Quantity::Length);
        let shown = |x: f64| rounded(units.from_si(Quantity::Length, x), PLACE_DIGITS);
        let named: Vec<usize> =
            (0..model.hardpoints.len()).filter(|h| !model.hardpoints[*h].unnamed).collect();
        if named.is_empty() {
            return;
        }
        paper.heading("Hardpoints", 2.0 * TEXT.line());
        let [x, y, z] = ["x", "y", "z"].map(|axis| format!("{axis} [{length}]"));
        paper.row(STRONG, &POINTS, &["hardpoint", &x, &y, &z]);
        for h in &named {
            let [x, y, z] = model.hardpoints[*h].position.to_array().map(shown);
            paper.row(TEXT, &POINTS, &[&model.hardpoints[*h].name, &x, &y, &z]);
        }
        for design in designs {
            let coordinates = named.iter().flat_map(|h| {
                let [old, new] = [model.hardpoints[*h].position, design.places[*h]].map(|p| p.to_array());
                ["x", "y", "z"]
                    .into_iter()
                    .zip(old.into_iter().zip(new))
                    .map(|(axis, values)| (*h, axis, values))
            });
            let moved: Vec<_> =
                coordinates.filter(|(_, _, (old, new))| (new - old).abs() > SAME_PLACE).collect();
            if moved.is_empty() {
                continue;
            }
            paper.heading(&format!("Hardpoints of {}", design.name), 2.0 * TEXT.line());
            let [old, new, change] = ["old", "new", "change"].map(|what| format!("{what} [{length}]"));
            paper.row(STRONG, &POINTS, &["coordinate", &old, &new, &change]);
            for (h, axis, (old, new)) in moved {
                let name = format!("{}.{axis}", model.hardpoints[h].name);
                let [old, new, change] = [old, new, new - old].map(shown);
                paper.row(TEXT, &POINTS, &[&name, &old, &new, &change]);
            }
        }
    }

    /// Writes the design variables.
    fn variables(&self, paper: &mut Paper) {
        let summary = self.summary;
        if !summary.model.variables.is_empty() {
            paper.heading("Design variables", 2.0 * TEXT.line());
            paper.row(STRONG, &VARIABLES, &["variable", "unit", "change", "over the motion"]);
            for variable in &summary.model.variables {
                let unit = if variable.unit == "1" { "-" } else { &variable.unit };
                let cells = [&variable.name, unit, &variable.change, variable.admissibility_text()];
                paper.row(TEXT, &VARIABLES, &cells);
            }
        }
    }

    /// Draws the curves of the measures, or of the points if there are none, two in a row; returns a note on omitted
    /// curves.
    fn drawn(&self, paper: &mut Paper) -> Option<String> {
        let (solution, units) = (&self.course.kept, self.file.units);
        let outputs = self.shown();
        if outputs.is_empty() {
            return None;
        }
        paper.heading("Curves", plot::SIZE.1);
        let aside = PAGE.0 - 2.0 * MARGIN - plot::SIZE.0;
        for (n, (m, output)) in outputs.iter().take(MOST_CURVES).enumerate() {
            let values: Vec<f64> = (0..solution.motion.len())
                .map(|k| units.from_si(output.dimension, solution.measured.value(k, *m)[0]))
                .collect();
            if n % 2 == 0 {
                paper.need(plot::SIZE.1);
                paper.y -= plot::SIZE.1;
            }
            let unit = order_unit(units, output.dimension, 0);
            let left = MARGIN + if n % 2 == 0 { 0.0 } else { aside };
            Plot { name: &output.name, unit: &unit, times: &solution.motion.times, values: &values }
                .draw(paper, [left, paper.y]);
        }
        let more = outputs.len().saturating_sub(MOST_CURVES);
        (more > 0).then(|| format!("{}; `motion.{}` has all", count(more, "more curve"), self.suffix))
    }
}

/// Draws the most influential variables of a measure.
fn ranked(paper: &mut Paper, ranking: &Ranking) {
    paper.need(4.0 * TEXT.line());
    paper.y -= 0.6 * TEXT.line();
    paper.row(STRONG, &RANKED, &[&ranking.measure, "sensitivity", "", "at t [s]"]);
    for of in ranking.largest.iter().take(MOST_RANKED) {
        let value = with_unit(of.value, &of.unit);
        paper.row(TEXT, &RANKED, &[&of.variable, &value, "", &number(of.time)]);
        let alike = ranking.largest.iter().filter(|other| other.unit == of.unit);
        let greatest = alike.fold(0f64, |all, other| all.max(other.value.abs()));
        let length = (of.value.abs() / greatest) as f32 * BAR;
        let colour = if of.value < 0.0 { RED } else { BLUE };
        paper.bar(colour, [MARGIN + RANKED[2], paper.y], length.max(0.5), 0.6 * TEXT.size);
    }
    let more = ranking.largest.len().saturating_sub(MOST_RANKED);
    if more > 0 {
        paper.row(SMALL, &RANKED, &[&format!("and {}", count(more, "more variable"))]);
    }
}
