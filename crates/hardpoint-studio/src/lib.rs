//! The engine as a page asks it: requests in, answers out, no files and no clock.
//!
//! An [`Engine`] keeps one model open and solves the designs of it that the reader makes: with a variable for every
//! coordinate of its hardpoints, so that each can be taken hold of. What takes long - the whole page of a model, a
//! search, tolerances - needs nothing that is open, and goes in an engine of its own while the first stays free.
//!
//! An answer is a block of bytes: the length of its JSON as four bytes, the JSON, zeros up to a multiple of four, then
//! the numbers of its curves, `f32`, all little-endian. A curve is in the JSON as the place of its first number and how
//! many it has.

mod offer;
mod open;
mod protocol;
mod study;

use std::ops::ControlFlow;

use hardpoint_file::{ModelFile, Severity, parse_with};
use hardpoint_report::encoding::Plain;
use hardpoint_report::page::ModelText;
use serde::Serialize;

pub use protocol::{
    CheckReply, Coordinate, DesignReply, DiagnosticMessage, ErrorReply, GoalChoice, MovableHardpoint,
    OpenReply, OptimizeOffer, OptimizeRequest, ProgressReply, Request, SearchGoal, SearchVariable,
    StudyReply, Text, ToleranceChoice, ToleranceOffer, ToleranceRequest, VariableChoice, VariableSetting,
};

use open::Open;

/// Is reported how far a study is, and may end it.
pub type ProgressListener<'t> = dyn FnMut(&ProgressReply) -> ControlFlow<()> + Send + 't;

/// Answers what a page asks.
#[derive(Debug, Default)]
pub struct Engine {
    open: Option<Open>,
}

/// Reason why there is no answer.
type Refusal = Vec<DiagnosticMessage>;

impl Engine {
    /// The answer to a request, which is JSON.
    ///
    /// ```
    /// let mut engine = hardpoint_studio::Engine::default();
    /// let answer = engine.answer(br#"{"ask": "check", "model": {"file": "x.toml", "text": "nmae = 1", "files": {}}}"#, &mut |_| {
    ///     std::ops::ControlFlow::Continue(())
    /// });
    /// assert!(String::from_utf8_lossy(&answer).contains("HP0104"));
    /// ```
    pub fn answer(&mut self, request: &[u8], tell: &mut ProgressListener<'_>) -> Vec<u8> {
        let answered = match serde_json::from_slice(request) {
            Ok(request) => self.answered(request, tell),
            Err(error) => {
                let message = format!("unknown request: {error}");
                Err(vec![DiagnosticMessage::plain(
                    "HP0701",
                    message,
                    "make the page anew with this version of Hardpoint",
                )])
            }
        };
        answered.unwrap_or_else(|failed| json(&ErrorReply { failed }))
    }

    fn answered(&mut self, request: Request, tell: &mut ProgressListener<'_>) -> Result<Vec<u8>, Refusal> {
        match request {
            Request::Check { model } => Ok(json(&checked(&model))),
            Request::Open { model } => {
                self.open = None;
                let (open, opened) = Open::new(&model)?;
                self.open = Some(open);
                Ok(json(&opened))
            }
            Request::Design { change, from } => {
                let mut solved = self.opened()?.design(&change, from.as_deref())?;
                Ok(block(&mut solved))
            }
            Request::Beside { model } => {
                let mut solved = self.opened()?.beside(&model)?;
                Ok(block(&mut solved))
            }
            Request::Text { change } => Ok(json(&Text { text: self.opened()?.text(&change)? })),
            Request::Page { model } => Ok(block(&mut study::page(&model)?)),
            Request::Optimize { model, asked } => {
                study::optimized(&model, &asked, tell).map(|found| json(&found))
            }
            Request::Tolerance { model, asked } => {
                study::toleranced(&model, &asked, tell).map(|found| json(&found))
            }
            Request::OptimizeOffer { model } => offer::optimize(&whole(&model)?).map(|offer| json(&offer)),
            Request::ToleranceOffer { model } => offer::tolerance(&whole(&model)?).map(|offer| json(&offer)),
        }
    }

    fn opened(&mut self) -> Result<&mut Open, Refusal> {
        let nothing =
            || vec![DiagnosticMessage::plain("HP0702", "no model is open".into(), "open one first")];
        self.open.as_mut().ok_or_else(nothing)
    }
}

/// The model of a text, in its case.
fn read(model: &ModelText) -> Result<ModelFile, Refusal> {
    let file = whole(model)?;
    let Some(name) = &model.case else { return Ok(first_case(file)) };
    match file.model.cases.iter().position(|case| case.name == *name) {
        Some(case) => Ok(file.in_case(hardpoint::model::CaseId(case))),
        None => Ok(first_case(file)),
    }
}

/// The model with all its cases.
fn whole(model: &ModelText) -> Result<ModelFile, Refusal> {
    parse_with(&model.text, &model.file, &model.files)
        .map_err(|all| all.list().iter().map(|d| DiagnosticMessage::of(&model.text, d)).collect())
}

/// For a file with cases, the model of the first case.
fn first_case(file: ModelFile) -> ModelFile {
    if file.model.cases.is_empty() { file } else { file.in_case(hardpoint::model::CaseId(0)) }
}

/// Diagnostics of a text, including those of its motion.
fn checked(model: &ModelText) -> CheckReply {
    let file = match read(model) {
        Ok(file) => file,
        Err(messages) => return CheckReply { messages },
    };
    let mut messages: Vec<DiagnosticMessage> =
        file.remarks.iter().map(|d| DiagnosticMessage::of(&model.text, d)).collect();
    if let Err(fault) = hardpoint::Analysis::new(&file.model) {
        let fault = hardpoint_report::diagnose::topology_fault(&file, &fault);
        assert_eq!(fault.severity, Severity::Error);
        messages.push(DiagnosticMessage::of(&model.text, &fault));
    }
    CheckReply { messages }
}

/// An answer without curves.
fn json(answer: &impl Serialize) -> Vec<u8> {
    bytes(answer, &[])
}

/// An answer with curves.
fn block(answer: &mut impl Plain) -> Vec<u8> {
    let mut numbers = Vec::new();
    answer.lay_out(&mut numbers);
    bytes(answer, &numbers)
}

fn bytes(answer: &impl Serialize, numbers: &[f32]) -> Vec<u8> {
    let json = serde_json::to_vec(answer).expect("answers are plain data");
    let length = u32::try_from(json.len()).expect("an answer has fewer than 2^32 bytes");
    let mut bytes = Vec::with_capacity(8 + json.len() + 4 * numbers.len());
    bytes.extend(length.to_le_bytes());
    bytes.extend(json);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

impl Plain for DesignReply {
    fn lay_out(&mut self, numbers: &mut Vec<f32>) {
        if let Some(design) = &mut self.design {
            design.lay_out(numbers);
        }
    }
}
