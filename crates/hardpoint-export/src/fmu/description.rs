//! Descriptions of a unit: its variables with units and dependencies, its sources, and a page of documentation.

use std::collections::BTreeMap;
use std::fmt::Write;

use hardpoint::model::Dimension;
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::figures::unit;
use hardpoint_table::Units;

use crate::c::MotionSource;
use crate::xml::Xml;
use crate::{UnsupportedFeature, escaped};

use super::variable::{Role, Variable};

/// Description of a unit.
pub struct Description<'a> {
    pub file: &'a ModelFile,
    pub source: &'a MotionSource,
    pub variables: &'a [Variable],
}

impl Description<'_> {
    /// `modelDescription.xml`.
    pub fn text(&self, token: &str) -> String {
        let model = &self.file.model;
        let mut xml = Xml::new();
        let about = self.file.description.clone().unwrap_or_else(|| model.name.clone());
        xml.begin(
            "fmiModelDescription",
            &[
                ("fmiVersion", "3.0".to_owned()),
                ("modelName", model.name.clone()),
                ("instantiationToken", token.to_owned()),
                ("description", about),
                ("generationTool", GENERATOR.to_owned()),
                ("variableNamingConvention", "structured".to_owned()),
            ],
        );
        let yes = || "true".to_owned();
        let interface = vec![
            ("modelIdentifier", self.source.name.clone()),
            ("canGetAndSetFMUState", yes()),
            ("canSerializeFMUState", yes()),
            ("providesDirectionalDerivatives", yes()),
            ("providesAdjointDerivatives", yes()),
        ];
        xml.empty("ModelExchange", &interface);
        let variable_step = ("canHandleVariableCommunicationStepSize", yes());
        xml.empty("CoSimulation", &[interface, vec![variable_step]].concat());
        self.units(&mut xml);
        xml.begin("LogCategories", &[]);
        for (name, about) in [
            ("logStatusDiscard", "Positions that cannot be reached"),
            ("logStatusError", "Positions that cannot be reached, and invalid calls"),
        ] {
            xml.empty("Category", &[("name", name.to_owned()), ("description", about.to_owned())]);
        }
        xml.end();
        if let [start, .., stop] = model.times[..] {
            let step = (stop - start) / (model.times.len() - 1) as f64;
            xml.empty(
                "DefaultExperiment",
                &[
                    ("startTime", start.to_string()),
                    ("stopTime", stop.to_string()),
                    ("stepSize", step.to_string()),
                ],
            );
        }
        xml.begin("ModelVariables", &[]);
        (0..self.variables.len()).for_each(|k| self.variable(&mut xml, k));
        xml.end();
        xml.begin("ModelStructure", &[]);
        for element in ["Output", "InitialUnknown"] {
            for (reference, variable) in self.variables.iter().enumerate() {
                if variable.role.is_output() {
                    let dependencies = self.dependencies(variable.role);
                    let reference = ("valueReference", reference.to_string());
                    xml.empty(element, &[reference, ("dependencies", dependencies)]);
                }
            }
        }
        xml.finish()
    }

    /// Units of all variables, with those of the model file for display.
    fn units(&self, xml: &mut Xml) {
        let (si, shown) = (Units::default(), self.file.units);
        let all: BTreeMap<String, Dimension> =
            self.variables.iter().map(|v| (unit(si, v.dimension), v.dimension)).collect();
        xml.begin("UnitDefinitions", &[]);
        for (name, dimension) in all {
            xml.begin("Unit", &[("name", name.clone())]);
            // N = kg m/s^2
            let Dimension { length, angle, time, force } = dimension;
            let powers = [("kg", force), ("m", length + force), ("s", time - 2 * force), ("rad", angle)];
            let powers = powers.into_iter().filter(|(_, power)| *power != 0);
            xml.empty("BaseUnit", &powers.map(|(of, power)| (of, power.to_string())).collect::<Vec<_>>());
            let display = unit(shown, dimension);
            if display != name {
                let factor = shown.per_si(dimension).to_string();
                xml.empty("DisplayUnit", &[("name", display), ("factor", factor)]);
            }
            xml.end();
        }
        xml.end();
    }

    fn variable(&self, xml: &mut Xml, reference: usize) {
        let Variable { name, about, role, dimension } = &self.variables[reference];
        let (causality, variability, start) = match *role {
            Role::Time => ("independent", "continuous", None),
            Role::Driver(k, 0) => ("input", "continuous", Some(self.source.start[k])),
            Role::Driver(..) => ("input", "continuous", Some(0.0)),
            Role::Design(_) => ("parameter", "tunable", Some(0.0)),
            Role::Measure(..) | Role::BodyPosition(_) | Role::BodyRotation(_) => {
                ("output", "continuous", None)
            }
        };
        let (si, shown) = (unit(Units::default(), *dimension), unit(self.file.units, *dimension));
        let mut attributes = vec![
            ("name", name.clone()),
            ("valueReference", reference.to_string()),
            ("causality", causality.to_owned()),
            ("variability", variability.to_owned()),
            ("description", about.clone()),
            ("unit", si.clone()),
        ];
        if shown != si {
            attributes.push(("displayUnit", shown));
        }
        if let Role::Design(k) = *role
            && let Some([min, max]) = self.file.model.variables[self.source.design[k]].bounds
        {
            let finite = [("min", min), ("max", max)].into_iter().filter(|(_, x)| x.is_finite());
            attributes.extend(finite.map(|(name, x)| (name, x.to_string())));
        }
        attributes.extend(start.map(|x| ("start", x.to_string())));
        let sizes: &[usize] = match role {
            Role::BodyPosition(_) => &[3],
            Role::BodyRotation(_) => &[3, 3],
            Role::Time | Role::Driver(..) | Role::Design(_) | Role::Measure(..) => &[],
        };
        if sizes.is_empty() {
            xml.empty("Float64", &attributes);
            return;
        }
        xml.begin("Float64", &attributes);
        sizes.iter().for_each(|size| xml.empty("Dimension", &[("start", size.to_string())]));
        xml.end();
    }

    /// Value references of the dependencies of an output: the drivers up to its own order, and the design.
    fn dependencies(&self, of: Role) -> String {
        let is_one = |role: Role| match role {
            Role::Driver(_, order) => order <= of.order(),
            Role::Design(_) => true,
            Role::Time | Role::Measure(..) | Role::BodyPosition(_) | Role::BodyRotation(_) => false,
        };
        let all = self.variables.iter().enumerate().filter(|(_, v)| is_one(v.role));
        all.map(|(reference, _)| reference.to_string()).collect::<Vec<_>>().join(" ")
    }

    /// `buildDescription.xml`.
    pub fn build(&self) -> String {
        let name = &self.source.name;
        let mut xml = Xml::new();
        xml.begin("fmiBuildDescription", &[("fmiVersion", "3.0".to_owned())]);
        xml.begin("BuildConfiguration", &[("modelIdentifier", name.clone())]);
        xml.begin("SourceFileSet", &[("language", "C99".to_owned())]);
        for source in [format!("{name}.c"), "fmi3.c".to_owned()] {
            xml.empty("SourceFile", &[("name", source)]);
        }
        xml.end();
        xml.empty("Library", &[("name", "m".to_owned()), ("external", "true".to_owned())]);
        xml.finish()
    }

    /// `documentation/index.html`: the variables, and the unsupported features.
    pub fn page(&self, unsupported: &[UnsupportedFeature]) -> String {
        let title = escaped(&self.file.model.name);
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n</head>\n\
             <body>\n<h1>{title}</h1>\n<p>Kinematics of a mechanism as a function of its drivers, generated by \
             {GENERATOR} from <code>{}</code>. Outputs are algebraic functions of the inputs. All values are in SI \
             units; drivers are measured from the design configuration. Set position, velocity and acceleration of \
             every driver: the unit does not integrate them.</p>\n<h2>Variables</h2>\n<table>\n\
             <tr><th>Name</th><th>Unit</th><th>Description</th></tr>\n",
            escaped(&self.source.origin),
        );
        for Variable { name, about, dimension, .. } in self.variables {
            let row = [escaped(name), unit(Units::default(), *dimension), escaped(about)];
            let _ = writeln!(page, "<tr><td>{}</td></tr>", row.join("</td><td>"));
        }
        page += "</table>\n";
        if !unsupported.is_empty() {
            page += "<h2>Not contained, or with changes</h2>\n<ul>\n";
            for UnsupportedFeature { kind, name, why } in unsupported {
                let _ = writeln!(page, "<li>{kind} <code>{}</code>: {}</li>", escaped(name), escaped(why));
            }
            page += "</ul>\n";
        }
        page + "</body>\n</html>\n"
    }
}
