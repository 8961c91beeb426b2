//! Requests of a page, and the replies.

use hardpoint_file::Diagnostic;
use hardpoint_report::page::{Design, ModelText, Table};
use serde::{Deserialize, Serialize};

#[cfg(test)]
use ts_rs::TS;

/// Request to the engine.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(tag = "ask", rename_all = "snake_case")]
pub enum Request {
    /// True if a text is a model. Answered by [`CheckReply`]; nothing that is open changes.
    Check {
        /// The text.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// To solve the designs of this model from now on. Answered by [`OpenReply`].
    Open {
        /// The model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// A design of the open model. Answered by [`DesignReply`].
    Design {
        /// Changed variables.
        change: Vec<VariableSetting>,
        /// A design that is solved already: where the changed one cannot be, what is given is as far on the way from
        /// this one to it as can be.
        from: Option<Vec<VariableSetting>>,
    },
    /// The text of the open model with a changed design. Answered by [`Text`].
    Text {
        /// Changed variables.
        change: Vec<VariableSetting>,
    },
    /// Everything that the page of a model shows, which need not be open. Answered by a payload.
    Page {
        /// The model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Another model's motion beside that of the open one. Answered by [`DesignReply`].
    Beside {
        /// The other model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// A search for the design that serves the goals of a model best. Answered by [`StudyReply`].
    Optimize {
        /// The model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
        /// Options besides those of the text.
        asked: OptimizeRequest,
    },
    /// Asks for the options of an optimisation. Answered by [`OptimizeOffer`].
    OptimizeOffer {
        /// The model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Asks for the options of a tolerance study. Answered by [`ToleranceOffer`].
    ToleranceOffer {
        /// The model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
    },
    /// Runs the tolerance study of a model. Answered by [`StudyReply`].
    Tolerance {
        /// The model.
        #[cfg_attr(test, ts(type = "ModelText"))]
        model: ModelText,
        /// Options besides those of the text.
        asked: ToleranceRequest,
    },
}

/// Options of an optimisation; all others are those of the text.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct OptimizeRequest {
    /// Variables that may change, with their bounds.
    pub variables: Vec<VariableChoice>,
    /// Goals to minimise.
    pub goals: Vec<GoalChoice>,
    /// From how many designs it starts.
    pub starts: usize,
    /// After that many iterations a search ends.
    pub iterations: usize,
}

/// A variable that is searched over.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct VariableChoice {
    /// Name.
    pub name: String,
    /// Lowest and highest change, or value of a parameter.
    pub bounds: [f64; 2],
}

/// A metric that is made small.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct GoalChoice {
    /// Name.
    pub metric: String,
    /// Weight of one unit.
    pub weight: f64,
    /// Target; `null` to minimise.
    pub target: Option<f64>,
}

/// Options of an optimisation, with their values in the text: `[optimize]` and its possible entries.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct OptimizeOffer {
    /// All design variables.
    pub variables: Vec<SearchVariable>,
    /// All metrics.
    pub goals: Vec<SearchGoal>,
    /// Limits, a sentence each.
    pub limits: Vec<String>,
    /// From how many designs it starts.
    pub starts: usize,
    /// After that many iterations a search ends.
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
    /// Lowest and highest change, or value of a parameter; none where the text has no bounds.
    pub bounds: Option<[f64; 2]>,
    /// True if the search of the text changes it.
    pub chosen: bool,
}

/// A metric that an optimisation may make small, or bring to a target.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct SearchGoal {
    /// Name.
    pub metric: String,
    /// Unit.
    pub unit: String,
    /// The value of the design of the text, in the first case that it is taken in, where it is known.
    pub value: Option<f64>,
    /// Weight of one unit.
    pub weight: f64,
    /// Target; `null` to minimise.
    pub target: Option<f64>,
    /// True if its target is a curve, which the text has: then it has none of its own.
    pub curve: bool,
    /// True if it is a goal of the text.
    pub chosen: bool,
}

/// Options of a tolerance study, with their values in the text: `[tolerance]`.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToleranceOffer {
    /// Tolerances of the variables.
    pub tolerances: Vec<ToleranceChoice>,
    /// Names of the metrics.
    pub metrics: Vec<String>,
    /// Number of designs that are drawn.
    pub samples: usize,
    /// Seed of the random numbers.
    #[cfg_attr(test, ts(type = "number"))]
    pub seed: u64,
}

/// Something that may be off.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToleranceChoice {
    /// Name.
    pub name: String,
    /// By so much either way.
    pub tolerance: f64,
    /// Unit.
    pub unit: String,
    /// Distribution of the deviations.
    pub distribution: String,
}

/// Options of a tolerance study; all others are those of the text.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct ToleranceRequest {
    /// Number of designs that are drawn and solved exactly.
    pub samples: usize,
    /// Seed of the random numbers: the same seed gives the same designs.
    pub seed: u32,
}

/// A variable and its change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
pub struct VariableSetting {
    /// A design variable of the model, or a coordinate of a hardpoint like `tie_rod_outer.z`.
    pub name: String,
    /// By how much it is changed, in the model's unit.
    pub by: f64,
}

/// A diagnostic of the text, in the words of the command line.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DiagnosticMessage {
    /// `error`, `warning` or `note`.
    #[cfg_attr(test, ts(type = "'error' | 'warning' | 'note'"))]
    pub severity: String,
    /// Stable code.
    pub code: String,
    /// The headline, enough alone.
    pub message: String,
    /// Name of the file; none for the text that the page shows.
    pub file: Option<String>,
    /// Line of the text, from 1; none where the text as a whole is meant.
    pub line: Option<usize>,
    /// Column of the line in characters, from 1.
    pub column: Option<usize>,
    /// Number of underlined characters.
    pub length: Option<usize>,
    /// Name of the entry that is underlined.
    pub element: Option<String>,
    /// Text at that place.
    pub label: Option<String>,
    /// Facts.
    pub notes: Vec<String>,
    /// Instruction that corrects the problem.
    pub help: Option<String>,
}

impl DiagnosticMessage {
    /// A diagnostic of this text.
    pub(crate) fn of(text: &str, d: &Diagnostic) -> Self {
        // An included file has no place in the text that the page shows.
        let is_here = d.span.as_ref().is_none_or(|span| text.get(span.clone()).is_some());
        let message = match (is_here, d.line) {
            (false, Some(line)) => format!("{}, line {line}: {}", d.file, d.message),
            _ => d.message.clone(),
        };
        Self {
            severity: format!("{:?}", d.severity).to_lowercase(),
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

    /// Something that has no place in the text.
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

/// Diagnostics of a text.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct CheckReply {
    /// Errors, warnings and notes, in the order of the text.
    pub messages: Vec<DiagnosticMessage>,
}

/// Abilities of a model that was opened.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct OpenReply {
    /// The cases of the file, of which one is open.
    pub cases: Vec<String>,
    /// The hardpoints that can be taken hold of.
    pub grips: Vec<MovableHardpoint>,
    /// Orientations of the bodies' frames in the design configuration, quaternions w x y z, ground first.
    pub frames: Vec<[f64; 4]>,
    /// Reason of an early end of its motion.
    pub stop: Option<DiagnosticMessage>,
}

/// A hardpoint that can be moved.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct MovableHardpoint {
    /// Name.
    pub name: String,
    /// Position in the design configuration, in the model's unit.
    pub place: [f64; 3],
    /// Variables of its coordinates.
    pub coordinates: [Coordinate; 3],
}

/// Variable of a coordinate of a hardpoint.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Coordinate {
    /// The variable.
    pub variable: String,
    /// By how much the coordinate goes with one unit of it: 1 or -1.
    pub sign: f64,
    /// The bounds of the variable, where the model has it and gives them.
    pub bounds: Option<[f64; 2]>,
}

/// A design that was solved.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct DesignReply {
    /// The part of the way to the design that was requested, 0 to 1: 1 where it is that one.
    pub part: f64,
    /// The design; `None` where nothing of its motion could be solved.
    #[cfg_attr(test, ts(type = "Design | null"))]
    pub design: Option<Design>,
    /// Reason why it is not the requested design, or of an early end of its motion.
    pub why: Option<DiagnosticMessage>,
}

/// A text.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Text {
    /// The text.
    pub text: String,
}

/// Result of a study.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct StudyReply {
    /// Sentence about its end.
    pub message: String,
    /// Tables of the result.
    #[cfg_attr(test, ts(type = "Array<Table>"))]
    pub tables: Vec<Table>,
    /// The design found, where one was searched for.
    pub change: Option<Vec<VariableSetting>>,
    /// The model's text with it.
    pub text: Option<String>,
}

/// Reason why there is no answer.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ErrorReply {
    /// Never none.
    pub failed: Vec<DiagnosticMessage>,
}

/// Progress of a study.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct ProgressReply {
    /// Amount that is done ...
    pub done: usize,
    /// ... of so much, where that is known.
    pub total: Option<usize>,
    /// Line about the last event.
    pub line: String,
    /// The design that the study is at.
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
