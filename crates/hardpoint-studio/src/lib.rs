//! Engine of the page: requests in, replies out, without files or a clock.
//!
//! An [`Engine`] holds one open model and solves its designs as the reader changes them. Every coordinate of a
//! hardpoint has a variable, so that every hardpoint can be dragged. Long tasks (the whole page of a model, an
//! optimisation, a tolerance study) do not use the open model, and run in a second engine while the first one stays
//! responsive.
//!
//! A reply is a block of bytes: the length of its JSON (four bytes), the JSON, zeros up to a multiple of four, and the
//! values of its curves as `f32`, all little-endian. In the JSON, a curve is the index of its first value and the
//! number of its values.

mod offer;
mod open;
mod protocol;
mod shapes;
mod study;

use std::ops::ControlFlow;

use hardpoint_file::{ModelFile, parse_with};
use hardpoint_report::encoding::Plain;
use hardpoint_report::page::ModelText;
use serde::Serialize;

pub use protocol::{
    CheckReply, Coordinate, DesignReply, DiagnosticMessage, ErrorReply, GoalChoice, MovableHardpoint,
    OpenReply, OptimizeOffer, OptimizeRequest, ProgressReply, Request, SearchGoal, SearchVariable,
    StudyReply, Text, ToleranceChoice, ToleranceOffer, ToleranceRequest, VariableChoice, VariableSetting,
};

use open::OpenModel;

/// Callback that receives the progress of a study, and may end the study.
pub type ProgressListener<'t> = dyn FnMut(&ProgressReply) -> ControlFlow<()> + Send + 't;

/// Replies to the requests of a page.
#[derive(Debug, Default)]
pub struct Engine {
    open: Option<OpenModel>,
}

/// Diagnostics in place of a reply; never empty.
type EngineError = Vec<DiagnosticMessage>;

impl Engine {
    /// Returns the reply to a JSON request.
    ///
    /// ```
    /// let mut engine = hardpoint_studio::Engine::default();
    /// let answer = engine.answer(br#"{"ask": "check", "model": {"file": "x.toml", "text": "nmae = 1", "files": {}}}"#, &mut |_| {
    ///     std::ops::ControlFlow::Continue(())
    /// });
    /// assert!(String::from_utf8_lossy(&answer).contains("HP0104"));
    /// ```
    pub fn answer(&mut self, request: &[u8], listener: &mut ProgressListener<'_>) -> Vec<u8> {
        let reply = match serde_json::from_slice(request) {
            Ok(request) => self.dispatch(request, listener),
            Err(error) => {
                let message = format!("unknown request: {error}");
                Err(vec![DiagnosticMessage::plain(
                    "HP0701",
                    message,
                    "create the page again with this version of Hardpoint",
                )])
            }
        };
        reply.unwrap_or_else(|failed| json(&ErrorReply { failed }))
    }

    fn dispatch(
        &mut self,
        request: Request,
        listener: &mut ProgressListener<'_>,
    ) -> Result<Vec<u8>, EngineError> {
        match request {
            Request::Check { model } => Ok(json(&check(&model))),
            Request::Open { model } => {
                self.open = None;
                let (open, opened) = OpenModel::new(&model)?;
                self.open = Some(open);
                Ok(json(&opened))
            }
            Request::Design { change, from, solid } => {
                let mut reply = self.open_model()?.design(&change, from.as_deref(), solid)?;
                Ok(block(&mut reply))
            }
            Request::Beside { model } => {
                let mut reply = self.open_model()?.compare(&model)?;
                Ok(block(&mut reply))
            }
            Request::Text { change } => Ok(json(&Text { text: self.open_model()?.text(&change)? })),
            Request::Page { model } => Ok(block(&mut study::page(&model)?)),
            Request::Optimize { model, asked } => {
                study::run_optimization(&model, &asked, listener).map(|found| json(&found))
            }
            Request::Tolerance { model, asked } => {
                study::run_tolerance(&model, &asked, listener).map(|found| json(&found))
            }
            Request::OptimizeOffer { model } => {
                offer::optimize(&parse_model(&model)?).map(|offer| json(&offer))
            }
            Request::ToleranceOffer { model } => {
                offer::tolerance(&parse_model(&model)?).map(|offer| json(&offer))
            }
        }
    }

    fn open_model(&mut self) -> Result<&mut OpenModel, EngineError> {
        let nothing =
            || vec![DiagnosticMessage::plain("HP0702", "no model is open".into(), "open one first")];
        self.open.as_mut().ok_or_else(nothing)
    }
}

/// Parses a model in the requested case, or in its first case if there is no such case.
fn parse_in_case(model: &ModelText) -> Result<ModelFile, EngineError> {
    Ok(in_case(parse_model(model)?, model))
}

/// Returns a model in the requested case, or in its first case if there is no such case.
fn in_case(file: ModelFile, model: &ModelText) -> ModelFile {
    let asked = model.case.as_ref().and_then(|name| file.model.cases.iter().position(|c| c.name == *name));
    match asked {
        Some(case) => file.in_case(hardpoint::model::CaseId(case)),
        None => first_case(file),
    }
}

/// Parses a model with all its cases.
fn parse_model(model: &ModelText) -> Result<ModelFile, EngineError> {
    parse_with(&model.text, &model.file, &model.files)
        .map_err(|all| all.list().iter().map(|d| DiagnosticMessage::of(&model.text, d)).collect())
}

/// Returns the model in its first case, or unchanged if it has no cases.
fn first_case(file: ModelFile) -> ModelFile {
    if file.model.cases.is_empty() { file } else { file.in_case(hardpoint::model::CaseId(0)) }
}

/// Returns the diagnostics of a text, including those of its topology.
fn check(model: &ModelText) -> CheckReply {
    let read = parse_with(&model.text, &model.file, &model.files).map(|file| in_case(file, model));
    let (_, list) = hardpoint_report::diagnose::of_text(read);
    CheckReply { messages: list.iter().map(|d| DiagnosticMessage::of(&model.text, d)).collect() }
}

/// Encodes a reply without curves.
fn json(answer: &impl Serialize) -> Vec<u8> {
    bytes(answer, &[])
}

/// Encodes a reply with curves.
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
