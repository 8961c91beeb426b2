//! The header: sizes, names and functions.

use std::collections::HashSet;

use hardpoint::measure::Output;
use hardpoint_report::figures::unit;
use hardpoint_table::Units;

use super::super::emit::comment;
use super::super::header::identifier;
use super::super::measures::MeasureSource;
use super::{Sizes, Source};

const HEADER: &str = include_str!("../header.h");
const MEASURE_TYPES: &str = include_str!("../measures.h");
const JACOBIAN_DECLARED: &str = include_str!("../jacobian.h");
const DERIVATIVE_DECLARED: &str = include_str!("../derivative.h");
const DESIGN_DECLARED: &str = include_str!("../design.h");
const GRADIENT_DECLARED: &str = include_str!("../gradient.h");

impl Source<'_> {
    pub(super) fn header(&self, sizes: Sizes) -> String {
        let (model, step) = (&self.file.model, self.step);
        let upper = self.name.to_ascii_uppercase();
        let [driver_names, body_names, design_names, measure_names] = self.enumerations();
        let count = |name: &str, count: usize| format!("#define {upper}_{name} {count}\n");
        let designs =
            format!("\n/* Design variables: indices of `design`. */\nenum {{\n{design_names}\n}};\n");
        let with_design = |text: String| if self.has_design() { text } else { String::new() };
        let measure_text = self.filled(MEASURE_TYPES, &[("measure_constants", measure_names)]);
        let jacobian = self.filled(JACOBIAN_DECLARED, &[]);
        let field = format!("    {}_measure_value measure[{upper}_MEASURES];\n", self.name);
        let when = |text: String| if self.has_measures() { text } else { String::new() };
        let mut places = vec![
            ("drivers", step.drivers.len().to_string()),
            ("bodies", (model.bodies.len() - 1).to_string()),
            ("measures", self.measures.list.len().to_string()),
            ("coordinates", step.coordinates.len().to_string()),
            ("blocks", step.logarithmic.len().to_string()),
            ("coordinates_or_one", step.position_inputs().max(1).to_string()),
            ("blocks_or_one", step.logarithmic.len().max(1).to_string()),
            ("counted_or_one", self.measures.counted.len().max(1).to_string()),
            ("work", sizes.work.max(1).to_string()),
            ("design_count", with_design(count("DESIGN", self.design.len()))),
            ("design_names", with_design(designs)),
            (
                "position_design",
                with_design(format!(
                    "    double design[{upper}_DESIGN]; /* changes of the design variables from their nominal values */\n"
                )),
            ),
            (
                "state_design",
                with_design(format!(
                    "    double geometry[{}]; /* numbers that depend on the design alone */\n",
                    sizes.geometry.max(1)
                )),
            ),
            ("derivative", self.derivative_declarations()),
            ("driver_names", driver_names),
            ("body_names", body_names),
            ("measure_names", when(measure_text)),
            ("measure_field", when(field)),
            ("jacobian", when(jacobian)),
            ("start", self.start_values()),
        ];
        places.extend(self.heading());
        self.filled(HEADER, &places)
    }

    /// Constants of the drivers, bodies, design variables and measures, with distinct names.
    fn enumerations(&self) -> [String; 4] {
        let (model, si) = (&self.file.model, Units::default());
        let upper = self.name.to_ascii_uppercase();
        let mut taken = HashSet::new();
        let mut enumerated = |kind: &str, list: &mut dyn Iterator<Item = (String, String)>| {
            let mut lines = Vec::new();
            for (k, (name, about)) in list.enumerate() {
                let plain = format!("{upper}_{kind}_{}", identifier(&name).to_ascii_uppercase());
                let constant = std::iter::once(plain.clone()).chain((2..).map(|n| format!("{plain}_{n}")));
                let constant = constant.into_iter().find(|c| !taken.contains(c)).unwrap_or(plain);
                taken.insert(constant.clone());
                lines.push(format!("    {constant} = {k}, /* {} */", comment(&about)));
            }
            // C99 has a comma before the comment of the last one, too.
            lines.join("\n")
        };
        let mut drivers = model.drivers.iter().map(|driver| {
            let note = if driver.is_reversed { "; reversed, as in the model file" } else { "" };
            let unit = unit(si, model.driven(driver).quantity);
            (driver.name.clone(), format!("{}, {unit}{note}", driver.name))
        });
        let drivers = enumerated("DRIVER", &mut drivers);
        let mut bodies = model.bodies.iter().skip(1).map(|body| (body.name.clone(), body.name.clone()));
        let bodies = enumerated("BODY", &mut bodies);
        let mut variables = self.design.iter().map(|k| {
            let variable = &model.variables[*k];
            (variable.name.clone(), format!("{}, {}", variable.name, unit(si, variable.quantity)))
        });
        let variables = enumerated("DESIGN", &mut variables);
        let mut measures = self.measures.list.iter().map(|m| {
            let note = match m.from {
                MeasureSource::Formulas(_) => "",
                MeasureSource::Step(_) => "; without rates",
            };
            let Output { name, dimension, .. } = &m.output;
            (name.clone(), format!("{name}, {}{note}", unit(si, *dimension)))
        });
        let measures = enumerated("MEASURE", &mut measures);
        [drivers, bodies, variables, measures]
    }

    /// Declarations of the functions for derivatives and design variables.
    fn derivative_declarations(&self) -> String {
        let upper = self.name.to_ascii_uppercase();
        let with_design = |text: String| if self.has_design() { text } else { String::new() };
        let mut derivative = String::new();
        if self.derivatives {
            let places = [
                ("and_of_design", with_design(" and of the design".to_owned())),
                (
                    "locked",
                    with_design(format!(
                        " {upper}_LOCKED: redundant constraints would\n * contradict each other in this direction of \
                         the design."
                    )),
                ),
                ("direction_field", with_design(format!("    double design[{upper}_DESIGN];\n"))),
            ];
            derivative += &self.filled(DERIVATIVE_DECLARED, &places);
        }
        if self.has_design() {
            derivative += &self.filled(DESIGN_DECLARED, &[]);
            if self.has_measures() {
                derivative += &self.filled(GRADIENT_DECLARED, &[]);
            }
        }
        derivative
    }

    /// Values of the drivers at which the motion starts.
    fn start_values(&self) -> String {
        let (model, si) = (&self.file.model, Units::default());
        let values: Vec<String> = model
            .drivers
            .iter()
            .zip(&self.step.drivers)
            .map(|(driver, at)| {
                format!(
                    "{} at {} {}",
                    comment(&driver.name),
                    at.start,
                    unit(si, model.driven(driver).quantity)
                )
            })
            .collect();
        values.join(", ")
    }
}
