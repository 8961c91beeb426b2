//! A model with its text.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use hardpoint::draft::{Section, some_of};
use hardpoint::joint::Quantity;
use hardpoint::model::element::{ActsOn, ForceCurve};
use hardpoint::model::{
    BodyId, CaseId, DesignVariable, Element, LimitTarget, Model, SweepRange, SweepSettings, VariableId,
};

use crate::compose::{Origins, Plane, with_origin};
use crate::values::{DataError, Diagnostic, Diagnostics, Places, Severity, Source, Texts, closest, shown};
use hardpoint_table::Units;

use super::drawing::Appearance;
use super::mesh::SURFACE;
use super::sweep::{self, DesignList};

/// Number of bodies without mass that are named.
const MOST_NAMES: usize = 8;

/// A model with its text.
#[derive(Clone, Debug)]
pub struct ModelFile {
    /// Checked model, in SI units.
    pub model: Model,
    /// Units of the file, for output.
    pub units: Units,
    /// Description in the file.
    pub description: Option<String>,
    /// Appearance in drawings.
    pub drawing: Appearance,
    /// Warnings and notes of the reader, in the order of the text.
    pub remarks: Vec<Diagnostic>,
    /// Texts of the files that the model names: tables of laws, target curves, lists of designs, and the triangles of
    /// shapes.
    pub texts: Texts,
    /// Plane of a planar model.
    pub plane: Option<Plane>,
    /// Minimum and maximum of metrics by name, SI: those of the optimisation and of the tolerance study, which a single
    /// case no longer has.
    pub limits: BTreeMap<String, [Option<f64>; 2]>,
    /// Mirror images with their originals, by name.
    pub(crate) origins: Origins,
    /// Selected case, if the file has cases.
    pub case: Option<String>,
    pub(crate) source: Source,
    pub(crate) places: Places,
}

impl ModelFile {
    /// Texts of files for a page. The triangles of shapes are in its drawing, so that their texts are left out.
    pub fn page_texts(&self) -> Texts {
        let mut texts = self.texts.clone();
        texts.retain(|name, _| !name.ends_with(SURFACE));
        texts
    }

    /// Returns the file with a single case as its motion.
    pub fn in_case(&self, case: CaseId) -> Self {
        let mut model = self.model.in_case(case);
        model.grids.clear();
        Self { model, case: Some(self.model.cases[case.0].name.clone()), ..self.clone() }
    }

    /// Value of a variable after a change in SI, in the file's units.
    pub fn value_of(&self, variable: VariableId, change: f64) -> f64 {
        let quantity = self.model.variables[variable.0].quantity;
        self.units.from_si(quantity, change + self.model.nominal_value(variable))
    }

    /// Change, in SI, that gives a variable a value in the file's units; exactly 0 for its nominal value.
    pub fn change_to(&self, variable: VariableId, value: f64) -> f64 {
        self.change_in(self.units, variable, value)
    }

    /// Change, in SI, that gives a variable a value in these units; exactly 0 for its nominal value in the file's.
    fn change_in(&self, units: Units, variable: VariableId, value: f64) -> f64 {
        if units == self.units && value == self.value_of(variable, 0.0) {
            return 0.0;
        }
        units.to_si(self.model.variables[variable.0].quantity, value) - self.model.nominal_value(variable)
    }

    /// Variables that the file has; those that were added to the model since, such as coordinates of hardpoints, come
    /// after them.
    pub(crate) fn own_variables(&self) -> &[DesignVariable] {
        let count = self.places.list(Section::Design).len().min(self.model.variables.len());
        &self.model.variables[..count]
    }

    /// Name of the file, as given.
    pub fn file_name(&self) -> &str {
        &self.source.file
    }

    /// Text of the file.
    pub fn text(&self) -> &str {
        &self.source.text[self.source.range(0)]
    }

    /// Line and column, from 1, of the name of an entry: `index` counts as in the lists of [`Model`].
    ///
    /// `None` for elements without an entry: ground, coordinates in place of a hardpoint's name.
    pub fn place(&self, section: Section, index: usize) -> Option<(usize, usize)> {
        self.span(section, index).map(|s| self.source.line_column(s.start))
    }

    fn span(&self, section: Section, index: usize) -> Option<Range<usize>> {
        // Ground is the model's first body and is not in the file.
        let index = if section == Section::Bodies { index.checked_sub(1)? } else { index };
        let at = hardpoint::draft::DraftLocation { section, index, key: "", item: None };
        self.places.find(&at)
    }

    /// Reads designs from a CSV file in any folder: its first line names design variables, each line below has their
    /// values in the file's units (values of parameters, changes for all others). The result has changes in SI, as in
    /// [`SweepSettings`].
    ///
    /// # Errors
    /// Returns the errors of the file.
    pub fn designs(&self, path: &Path) -> Result<(Vec<SweepRange>, Vec<Vec<f64>>), Diagnostics> {
        let name = path.display().to_string();
        let source = Source::new(&name, "");
        let rejected = |e: DataError| Diagnostics::new(source.clone(), vec![e.diagnostic(&source, None)]);
        let DesignList { titles, rows } = sweep::list_at(path).map_err(rejected)?;
        let (mut variables, mut units) = (Vec::new(), Vec::new());
        for (column, title) in titles.iter().enumerate() {
            let wanted = &title.name;
            let note = || format!("it is the title of column {} of `{}`", column + 1, shown(&name));
            let known = self.model.variables.iter().position(|v| v.name == *wanted);
            let Some(k) = known else {
                let all = self.model.variables.iter().map(|v| v.name.as_str());
                let help = closest(wanted, all).map(|c| format!("did you mean `{c}`?"));
                let message = format!("there is no design variable named `{}`", shown(wanted));
                let error = DataError { help, ..DataError::new(sweep::LIST_CODE, message, "") };
                return Err(rejected(error.note(note())));
            };
            let variable = VariableId(k);
            if variables.contains(&variable) {
                let message =
                    format!("`{}` is the title of two columns of `{}`", shown(wanted), shown(&name));
                return Err(rejected(DataError::new(sweep::LIST_CODE, message, "remove one of the two")));
            }
            let own = sweep::units_of_column(&self.model, self.units, title, variable);
            units.push(own.map_err(|error| rejected(error.note(note())))?);
            variables.push(variable);
        }
        let in_si = |row: &Vec<f64>| {
            let columns = variables.iter().zip(&units).zip(row);
            columns.map(|((variable, units), x)| self.change_in(*units, *variable, *x)).collect()
        };
        let rows: Vec<Vec<f64>> = rows.iter().map(in_si).collect();
        Ok((SweepSettings::spanned(&variables, &rows), rows))
    }

    /// Creates a diagnostic of an entry of the model, or of the whole model, for [`render`](Self::render).
    ///
    /// ```
    /// # let text = r#"
    /// # name = "pendulum"
    /// # units = { length = "mm", angle = "deg" }
    /// # hardpoints = { pivot = [0, 0, 500] }
    /// # bodies = { arm = {} }
    /// # joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
    /// # time = { end = 1.0, steps = 100 }
    /// # "#;
    /// # let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
    /// use hardpoint::draft::Section;
    /// use hardpoint_file::Severity;
    ///
    /// let d = file
    ///     .diagnostic(Severity::Error, "HP0411", "the mechanism does not move", Some((Section::Joints, 0)))
    ///     .help("add a driver for `hinge`");
    /// assert!(file.render(&d, false).contains("pendulum.toml:6:8"));
    /// ```
    pub fn diagnostic(
        &self,
        severity: Severity,
        code: &'static str,
        message: impl Into<String>,
        about: Option<(Section, usize)>,
    ) -> Diagnostic {
        let span = about.and_then(|(section, index)| self.span(section, index));
        with_origin(self.source.diagnostic(severity, code, message, span), &self.origins)
    }

    /// Limits of all metrics that have any; of two limits of a metric the tighter one.
    pub(super) fn limits_of(model: &Model) -> BTreeMap<String, [Option<f64>; 2]> {
        let studies = model.optimization.iter().map(|o| &o.limits);
        let studies = studies.chain(model.tolerancing.iter().map(|t| &t.limits));
        let mut found: BTreeMap<String, [Option<f64>; 2]> = BTreeMap::new();
        for limit in studies.flatten() {
            let LimitTarget::Metric(metric) = limit.of else { continue };
            let [least, most] = found.entry(model.metrics[metric].name.clone()).or_default();
            *least = limit.least.into_iter().chain(*least).reduce(f64::max);
            *most = limit.most.into_iter().chain(*most).reduce(f64::min);
        }
        found
    }

    /// HP0253: notes on a model with loads whose bodies have no mass, or whose gravity has no effect.
    pub(super) fn weightless(&self) -> Option<Diagnostic> {
        let model = &self.model;
        let heavy: Vec<BodyId> = model.elements.iter().filter_map(|e| e.kind.mass_on(model)).collect();
        if heavy.is_empty() {
            let falls = model.gravity.norm() > 0.0;
            return falls.then(|| {
                self.diagnostic(Severity::Note, "HP0253", "gravity has no effect: no body has mass", None)
                    .help("give the bodies `[masses]`, or remove `[gravity]`")
            });
        }
        let light = (1..model.bodies.len()).filter(|b| !heavy.contains(&BodyId(*b)));
        let light: Vec<usize> = light.collect();
        let names: Vec<String> = light.iter().map(|b| format!("`{}`", model.bodies[*b].name)).collect();
        let message = match &names[..] {
            [] => return None,
            [one] => format!("body {one} has no mass"),
            several => {
                format!("{} bodies have no mass: {}", several.len(), some_of(several, ", ", MOST_NAMES))
            }
        };
        // `Section::Bodies` counts as the model does: ground is the first.
        let first = (Section::Bodies, light[0]);
        let d = self.diagnostic(Severity::Note, "HP0253", message, Some(first));
        Some(
            d.note("a body without mass transmits forces and needs none")
                .help("add it to `[masses]` if its weight or inertia matters"),
        )
    }

    /// HP0256: warnings about bushings whose two points differ in the nominal design.
    pub(super) fn open_bushings(&self) -> Vec<Diagnostic> {
        let model = &self.model;
        // The elements are the masses, then the forces.
        let forces = model.elements.iter().filter(|e| !e.kind.has_mass());
        let of = |(k, element): (usize, &Element)| {
            let acts_on = element.kind.force(model).map(|force| force.acts_on);
            let Some(ActsOn::Points(ends)) = acts_on else { return None };
            let [from, to] = ends.map(|p| model.hardpoints[model.points[p.0].at.0].position);
            let apart = (to - from).norm();
            if !(apart > SAME_PLACE * model.size()) {
                return None;
            }
            let apart = self.units.from_si(Quantity::Length, apart);
            let apart = hardpoint_table::figures::with_unit(apart, self.units.length.symbol());
            let name = shown(&element.name);
            let message = format!("the two points of bushing `{name}` are {apart} apart");
            let d = self.diagnostic(Severity::Warning, "HP0256", message, Some((Section::Forces, k)));
            Some(
                d.note("it is under stress in the design configuration: its deflection is zero where they coincide")
                    .help("give `to` the place of `from`; add `preload_x` and so on if it is under stress there"),
            )
        };
        forces.enumerate().filter_map(of).collect()
    }

    /// HP0257: warnings about curves of elastic joints and bushings whose force falls with the deflection somewhere,
    /// or does not change at zero deflection.
    pub(super) fn falling_curves(&self) -> Vec<Diagnostic> {
        let of = |curve: ForceCurve<'_>| {
            let falling = self.model.falling_intervals(&curve);
            let mut d = self.curve_warning("HP0257", &curve, *falling.first()?, |[from, to]| {
                format!("falls with the deflection from {from} to {to}")
            });
            if falling.len() > 1 {
                d = d.note(format!("and in {} further intervals", falling.len() - 1));
            }
            Some(
                d.note(
                    "where the stiffness is negative, an equilibrium may be unstable, or jump to another one",
                )
                .help("let the force grow from point to point, unless this is meant"),
            )
        };
        self.model.force_curves().into_iter().filter_map(of).collect()
    }

    /// HP0258: warnings about curves with adjacent points whose forces are equal, but may differ in other designs.
    pub(super) fn kinked_curves(&self) -> Vec<Diagnostic> {
        let of = |curve: ForceCurve<'_>| {
            let interval = *self.model.kinked_intervals(&curve).first()?;
            let d = self.curve_warning("HP0258", &curve, interval, |[from, to]| {
                format!("has the same force at {from} and {to}")
            });
            Some(
                d.note("the slope of the curve there has a kink over these forces, and derivatives by them are those of one side")
                    .help("give the two points different forces, or the same expression"),
            )
        };
        self.model.force_curves().into_iter().filter_map(of).collect()
    }

    /// Warning about a curve of a force, of which something is true between two deflections.
    fn curve_warning(
        &self,
        code: &'static str,
        curve: &ForceCurve<'_>,
        interval: [f64; 2],
        what: impl Fn([String; 2]) -> String,
    ) -> Diagnostic {
        let model = &self.model;
        let masses = model.elements.iter().filter(|e| e.kind.has_mass()).count();
        let name = shown(&model.elements[curve.element.0].name);
        let (unit, per_si) = self.units.of(curve.quantity(model));
        let mut ends = interval.map(|e| curve.as_written(e) * per_si);
        ends.sort_by(f64::total_cmp);
        let what = what(ends.map(|e| hardpoint_table::figures::with_unit(e, unit)));
        let place = Some((Section::Forces, curve.element.0 - masses));
        self.diagnostic(Severity::Warning, code, format!("`{}` of `{name}` {what}", curve.key), place)
    }

    /// Renders a diagnostic of this file for a terminal; with `color`, with ANSI escapes.
    pub fn render(&self, diagnostic: &Diagnostic, color: bool) -> String {
        self.source.render(diagnostic, color)
    }
}

/// Distance between the two points of a bushing, in sizes of the mechanism, up to which they are one place: typed
/// coordinates agree to about this.
const SAME_PLACE: f64 = 1e-6;
