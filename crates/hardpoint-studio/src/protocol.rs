//! Requests of a page, and their replies.

use hardpoint_file::{Diagnostic, Severity};
use hardpoint_report::page::{Design, ModelText, Table};
use serde::{Deserialize, Serialize};

#[cfg(test)]
use ts_rs::TS;

/// Request to the engine.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "ask", rename_all = "snake_case")]
pub enum Request {
    /// Checks a model text. Reply: [`CheckReply`]. The open model is unchanged.
    Check {
        /// Model text.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Opens a model, whose designs are solved from now on. Reply: [`OpenReply`].
    Open {
        /// Model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Solves a design of the open model. Reply: [`DesignReply`].
    Design {
        /// Changed variables.
        change: Vec<VariableSetting>,
        /// A solved design. If the changed design cannot be reached, the reply is the last design on the path from this
        /// one that can be solved.
        from: Option<Vec<VariableSetting>>,
        /// True if shapes stop the change: the reply is then the last design on the path at which none of the pairs
        /// touch that are apart in the design `from`.
        #[serde(default)]
        solid: bool,
    },
    /// Returns the text of the open model with changes. Reply: [`Text`].
    Text {
        /// Changed variables.
        change: Vec<VariableSetting>,
    },
    /// Returns the whole page of a model, which need not be open. Reply: a payload.
    Page {
        /// Model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Solves another model for comparison with the open one. Reply: [`DesignReply`].
    Beside {
        /// Other model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Optimises the design for the goals of a model. Reply: [`StudyReply`].
    Optimize {
        /// Model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
        /// Options that replace those of the model text.
        asked: OptimizeRequest,
    },
    /// Returns the options of an optimisation. Reply: [`OptimizeOffer`].
    OptimizeOffer {
        /// Model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Returns the options of a tolerance study. Reply: [`ToleranceOffer`].
    ToleranceOffer {
        /// Model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Runs the tolerance study of a model. Reply: [`StudyReply`].
    Tolerance {
        /// Model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
        /// Options that replace those of the model text.
        asked: ToleranceRequest,
    },
}

/// Options of an optimisation; all other options are those of the model text.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct OptimizeRequest {
    /// Variables that may change, with their bounds.
    pub variables: Vec<VariableChoice>,
    /// Goals to minimise.
    pub goals: Vec<GoalChoice>,
    /// Number of start designs.
    pub starts: usize,
    /// Maximum number of iterations per start.
    pub iterations: usize,
}

/// Variable of an optimisation.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct VariableChoice {
    /// Name.
    pub name: String,
    /// Lower and upper bound of the change, or of the value of a parameter.
    pub bounds: [f64; 2],
}

/// Metric to minimise, or to bring to a target.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct GoalChoice {
    /// Name.
    pub metric: String,
    /// Weight per unit of the metric.
    pub weight: f64,
    /// Target; `null` to minimise.
    pub target: Option<f64>,
}

/// Options of an optimisation, with their values in the table `[optimize]` of the model text.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct OptimizeOffer {
    /// All design variables.
    pub variables: Vec<SearchVariable>,
    /// All metrics.
    pub goals: Vec<SearchGoal>,
    /// Limits, one sentence each.
    pub limits: Vec<String>,
    /// Number of start designs.
    pub starts: usize,
    /// Maximum number of iterations per start.
    pub iterations: usize,
}

/// A design variable that an optimisation may change.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SearchVariable {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Lower and upper bound of the change, or of the value of a parameter; `null` without bounds in the model text.
    pub bounds: Option<[f64; 2]>,
    /// True if it is a variable of `[optimize]`.
    pub chosen: bool,
}

/// Metric that an optimisation may minimise or bring to a target.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SearchGoal {
    /// Name.
    pub metric: String,
    /// Unit.
    pub unit: String,
    /// Value of the nominal design in the first case in which the metric is evaluated, if known.
    pub value: Option<f64>,
    /// Weight per unit of the metric.
    pub weight: f64,
    /// Target; `null` to minimise.
    pub target: Option<f64>,
    /// True if the target is a curve in the model text; `target` is `null` then.
    pub curve: bool,
    /// True if it is a goal of `[optimize]`.
    pub chosen: bool,
}

/// Options of a tolerance study, with their values in the table `[tolerance]` of the model text.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToleranceOffer {
    /// Tolerances of the variables.
    pub tolerances: Vec<ToleranceChoice>,
    /// Names of the metrics.
    pub metrics: Vec<String>,
    /// Number of sampled designs.
    pub samples: usize,
    /// Seed of the random numbers.
    #[cfg_attr(test, ts(type = "number"))]
    pub seed: u64,
}

/// Variable or group of variables with a tolerance.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToleranceChoice {
    /// Name.
    pub name: String,
    /// Half width of the tolerance.
    pub tolerance: f64,
    /// Unit.
    pub unit: String,
    /// Distribution of the deviations.
    pub distribution: String,
}

/// Options of a tolerance study; all other options are those of the model text.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToleranceRequest {
    /// Number of designs that are sampled and solved exactly.
    pub samples: usize,
    /// Seed of the random numbers: the same seed gives the same designs.
    pub seed: u32,
    /// Name of the rule by which the loosest tolerances are allocated; `null` for that of the model text.
    #[serde(default)]
    #[cfg_attr(test, ts(optional = nullable))]
    pub allocate: Option<String>,
}

/// Change of a variable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct VariableSetting {
    /// Design variable, or coordinate of a hardpoint such as `tie_rod_outer.z`.
    pub name: String,
    /// Change from the nominal value, in the unit of the model.
    pub by: f64,
}

/// Diagnostic of the model text, worded as on the command line.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DiagnosticMessage {
    /// `error`, `warning` or `note`.
    #[cfg_attr(test, ts(type = "'error' | 'warning' | 'note'"))]
    pub severity: String,
    /// Stable code.
    pub code: String,
    /// Headline, complete by itself.
    pub message: String,
    /// Name of the file; `null` for the displayed text.
    pub file: Option<String>,
    /// Line of the text, from 1; `null` for the text as a whole.
    pub line: Option<usize>,
    /// Column of the line in characters, from 1.
    pub column: Option<usize>,
    /// Number of underlined characters.
    pub length: Option<usize>,
    /// Name of the entry that is underlined.
    pub element: Option<String>,
    /// Label of the underlined characters.
    pub label: Option<String>,
    /// Facts.
    pub notes: Vec<String>,
    /// Instruction that corrects the problem.
    pub help: Option<String>,
}

impl DiagnosticMessage {
    /// Converts a diagnostic of a text.
    pub(crate) fn of(text: &str, d: &Diagnostic) -> Self {
        // An included file has no position in the displayed text.
        let is_here = d.span.as_ref().is_none_or(|span| text.get(span.clone()).is_some());
        let message = match (is_here, d.line) {
            (false, Some(line)) => format!("{}, line {line}: {}", d.file, d.message),
            _ => d.message.clone(),
        };
        Self {
            severity: match d.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            }
            .to_owned(),
            code: d.code.into(),
            message,
            file: Some(d.file.clone()).filter(|_| !is_here),
            line: d.line.filter(|_| is_here),
            column: d.column.filter(|_| is_here),
            length: d.length.filter(|_| is_here),
            element: d.element.clone(),
            label: d.label.clone(),
            notes: d.notes.clone(),
            help: d.help.clone(),
        }
    }

    /// Creates an error without a position in the text.
    pub(crate) fn plain(code: &str, message: String, help: &str) -> Self {
        Self {
            severity: "error".into(),
            code: code.into(),
            message,
            file: None,
            line: None,
            column: None,
            length: None,
            element: None,
            label: None,
            notes: Vec::new(),
            help: Some(help.into()),
        }
    }
}

/// Diagnostics of a model text.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CheckReply {
    /// Errors, warnings and notes, in the order of the text.
    pub messages: Vec<DiagnosticMessage>,
}

/// Properties of a model that was opened.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct OpenReply {
    /// Names of the cases of the file, one of which is open.
    pub cases: Vec<String>,
    /// Hardpoints that can be moved.
    pub grips: Vec<MovableHardpoint>,
    /// Orientations of the body frames in the design configuration, quaternions w, x, y, z; ground first.
    pub frames: Vec<[f64; 4]>,
    /// Reason why the motion ends early.
    pub stop: Option<DiagnosticMessage>,
}

/// A hardpoint that can be moved.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct MovableHardpoint {
    /// Name.
    pub name: String,
    /// Position in the design configuration, in the unit of the model, global.
    pub place: [f64; 3],
    /// Variables of its coordinates.
    pub coordinates: [Coordinate; 3],
}

/// Coordinate of a hardpoint, with its variable.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Coordinate {
    /// Name of the variable.
    pub variable: String,
    /// Derivative of the coordinate with respect to the variable: 1 or -1.
    pub sign: f64,
    /// Bounds of the variable, in the unit of the model, if the model defines them.
    pub bounds: Option<[f64; 2]>,
}

/// Solved design.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DesignReply {
    /// Fraction of the path to the requested design that was reached, 0 to 1.
    pub part: f64,
    /// Design; `null` if its motion is empty.
    #[cfg_attr(test, ts(type = "Design | null"))]
    pub design: Option<Design>,
    /// Reason why the requested design was not reached, or why its motion ends early.
    pub why: Option<DiagnosticMessage>,
}

/// Model text.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Text {
    /// Model text.
    pub text: String,
}

/// Result of a study.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct StudyReply {
    /// Summary in one line.
    pub message: String,
    /// Tables of the result.
    #[cfg_attr(test, ts(type = "Array<Table>"))]
    pub tables: Vec<Table>,
    /// Optimised design, after an optimisation.
    pub change: Option<Vec<VariableSetting>>,
    /// Model text with the optimised design; none where the text cannot have it, for which `message` has the reason.
    pub text: Option<String>,
}

/// Failed request.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ErrorReply {
    /// Diagnostics; never empty.
    pub failed: Vec<DiagnosticMessage>,
}

/// Progress of a study.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ProgressReply {
    /// Number of completed steps.
    pub done: usize,
    /// Total number of steps, if known.
    pub total: Option<usize>,
    /// Description of the last step.
    pub line: String,
    /// Current design of the study.
    pub change: Option<Vec<VariableSetting>>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{fs, path::Path};

    #[test]
    fn typescript_types_are_those_of_the_protocol() {
        let config = ts_rs::Config::default();
        let mut expected = String::from(
            "// Written by the tests of `crates/hardpoint-studio/src/protocol.rs`; change the structs there.\n\nimport type { Design, ModelText, Table } from '../payload'\n",
        );
        macro_rules! declare {
            ($($name:ident)*) => { $(
                expected += "\n";
                expected += &<$name as TS>::docs().unwrap_or_default();
                expected += &format!("export {}\n", <$name as TS>::decl(&config)).replace(" \n", "\n");
            )* };
        }
        declare!(Request OptimizeRequest VariableChoice GoalChoice OptimizeOffer SearchVariable SearchGoal ToleranceOffer ToleranceChoice ToleranceRequest VariableSetting DiagnosticMessage CheckReply OpenReply MovableHardpoint Coordinate DesignReply Text StudyReply ErrorReply ProgressReply);
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../web/src/engine/protocol.ts");
        if fs::read_to_string(&path).ok().as_deref() != Some(&expected) {
            fs::write(&path, expected).unwrap();
            panic!(
                "web/src/engine/protocol.ts was out of date and has been rewritten: rebuild the page and commit both"
            );
        }
    }
}
