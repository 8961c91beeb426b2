//! `hardpoint trade-off`.

use std::io::Write;
use std::num::NonZero;
use std::path::Path;

use hardpoint::Solution;
use hardpoint_file::ModelFile;
use hardpoint_report::optimize::to_save;
use hardpoint_report::trade_off::{SavedPoint, TradeOffFacts, TradeOffInputs};
use hardpoint_study::optimize::judge;
use hardpoint_study::trade_off::{Overrides, Request, trade_off};
use hardpoint_study::{Control, Motions, Progress, Step};

use crate::args::TradeOff;
use crate::folder::{Folder, WriteError};
use crate::optimize::judged_as_written;
use crate::outcome::Outcome;
use crate::pages::{FoundDesign, Study, page, threads};
use crate::session::{Session, json_text};
use crate::text;

/// Relative difference of goals up to which a saved design is the point of the front: the effect of rounding its
/// variables.
const SAME: f64 = 1e-6;

/// Computes the front, writes the results and prints a summary.
pub fn run(options: &TradeOff) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(trade_off_in(&session, options))
}

fn trade_off_in(session: &Session, options: &TradeOff) -> Result<Outcome, Outcome> {
    let mut file = session.read(&options.common.model)?;
    session.keep_case(&mut file, options.motions.case.as_deref())?;
    let [points, starts, iterations] =
        [options.points, options.starts, options.iterations].map(|n| n.map(NonZero::get));
    let overrides = Overrides { goals: options.goals.clone(), points, starts, iterations };
    let request = Request::of(&file.model, overrides).map_err(|e| session.refused(&file, &e))?;
    request.check_point(options.point).map_err(|e| session.refused(&file, &e))?;
    session.may_save(&options.common.model, options.save.as_deref())?;
    session.can_save(&file, &request.settings.variables, options.save.as_deref())?;
    let models = file.model.motions();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(&file, &fault))?;
    let folder = session.folder(options.output.as_deref())?;

    session.patient(true);
    let mut meter = session.meter("tracing the front", "points");
    let mut progress = |Progress { step, done, total, .. }: Progress<'_>| {
        match step {
            Step::FrontPoint => meter.show(done, total),
            Step::Variable | Step::Designs | Step::Iteration(_) | Step::Search(..) | Step::Fit(_) => {}
        }
        session.go_on()
    };
    let more = || session.go_on().is_continue();
    let control = Control { threads: threads(options.threads), progress: &mut progress, more: &more };
    let found = trade_off(&file.model, &motions, &request, control);
    drop(meter);
    let inputs = TradeOffInputs { file: &file, asked: &request.settings, found: &found };
    let mut facts = TradeOffFacts::of(&inputs);
    facts.seconds = session.seconds();

    let chosen = options.point.or(facts.balanced).filter(|k| *k < found.points.len());
    let mut saved = Ok(None);
    if let (Some(to), Some(k)) = (&options.save, chosen) {
        let point = &found.points[k].assessment;
        let design = to_save(&file, &motions, &request.settings, &point.design);
        match session.save_result(&file, &design, to) {
            Ok(()) => {
                facts.files.push(to.display().to_string());
                facts.check_saved(saved_point(to, options, &request, k, &point.goals));
                saved = Ok(Some(to));
            }
            Err((diagnostics, why, outcome)) => {
                facts.not_saved(&why);
                facts.diagnostics.extend(diagnostics);
                saved = Err(outcome);
            }
        }
    } else if options.save.is_some() {
        let points = found.points.len();
        facts.not_saved(&format!("the front has {points} points, numbered from 0"));
    }
    let mut results = Results { inputs, motions: &motions, chosen, facts };
    let unwritten = results.facts.files.len();
    if let Some(mut folder) = folder.filter(|_| !found.points.is_empty()) {
        results.write(&mut folder).map_err(|e| session.not_written(&e))?;
        folder.commit(&FILES).map_err(|e| session.not_written(&e))?;
    }
    let facts = &results.facts;
    if session.is_json() {
        session.print_json(facts);
    } else {
        let text = text::study(facts.rows(), facts.seconds, &facts.tables());
        text::print(&format!("{}\n{text}", text::bold(&file.model.name)));
        text::print(&text::written(&facts.files[unwritten..]));
        session.tell(&file, &facts.diagnostics);
        let saved = saved.as_ref().ok().and_then(|to| *to);
        text::print(&saved.map_or(String::new(), |path| format!("saved: {}\n", path.display())));
    }
    saved?;
    Ok(match facts.status {
        "interrupted" => Outcome::Interrupted,
        "front" if facts.points.len() > 1 => Outcome::Done,
        "no_conflict" => Outcome::Done,
        _ => Outcome::FellShort,
    })
}

/// Result files; the summary is written last and marks them as complete.
const FILES: [&str; 2] = ["front.csv", "summary.json"];

/// Reads a saved file and solves its design again.
fn saved_point(
    to: &Path,
    options: &TradeOff,
    request: &Request,
    point: usize,
    goals: &[(usize, usize, f64)],
) -> SavedPoint {
    let (case, formulation) = (options.motions.case.as_deref(), options.common.formulation());
    let judged = judged_as_written(to, case, formulation, |model, motions| {
        judge(model, motions, &request.settings, &[])
    });
    let (margin, why) = match judged {
        Ok(judged) => {
            let differs = |((_, _, a), (_, _, b)): (&(usize, usize, f64), &(usize, usize, f64))| {
                !((a - b).abs() <= SAME * a.abs().max(b.abs()))
            };
            let differ = goals.iter().zip(&judged.goals).any(differs);
            (judged.margin, differ.then(|| "its goals have other values".to_owned()))
        }
        Err(why) => (None, Some(why)),
    };
    SavedPoint { file: to.display().to_string(), point, margin, why }
}

/// A finished study.
struct Results<'a> {
    inputs: TradeOffInputs<'a>,
    motions: &'a Motions<'a>,
    /// Point that the pages show.
    chosen: Option<usize>,
    facts: TradeOffFacts,
}

impl Results<'_> {
    /// Writes the table of the front, a page for each motion, and the summary last.
    fn write(&mut self, folder: &mut Folder) -> Result<(), WriteError> {
        let pages = self.write_pages(folder)?;
        self.facts.files.extend(pages);
        let facts = &self.facts;
        folder.write("front.csv", |out| facts.write_points(out).map_err(Into::into))?;
        self.facts.files.extend(FILES.iter().map(|name| folder.path_of(name).display().to_string()));
        let json = json_text(&self.facts);
        folder.write("summary.json", |out| out.write_all(json.as_bytes()))
    }
}

impl Study for Results<'_> {
    fn file(&self) -> &ModelFile {
        self.inputs.file
    }

    fn motions(&self) -> &Motions<'_> {
        self.motions
    }

    fn number(&self, motion: usize) -> usize {
        motion
    }

    /// Page of the nominal design, with the chosen point of the front beside it.
    fn page(&self, motion: usize) -> Option<String> {
        let k = self.chosen?;
        let note = format!("Point {k} of the front.");
        let found = FoundDesign { design: &self.inputs.found.points[k].assessment.design, note: &note };
        let analysis = &self.motions.analyses()[motion];
        let finish =
            |page, today: &Solution| self.facts.page(page, analysis.model(), &today.measured.outputs);
        page(self.inputs.file, analysis, Some(&found), finish)
    }
}
