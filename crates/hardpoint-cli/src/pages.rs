//! Pages of studies: one for each motion, with the result of the study alongside the nominal design.

use std::io::Write;
use std::num::NonZero;

use hardpoint::model::Model;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::page::Payload;
use hardpoint_report::payload::{ChangedDesign, Request, report};
use hardpoint_report::study::case_name;
use hardpoint_report::summary::Summary;
use hardpoint_study::Motions;

use crate::folder::{Folder, WriteError, file_name};

/// A page as HTML, with its case if the model has cases.
pub type Page = (Option<String>, String);

/// A finished study of several motions.
pub trait Study {
    /// The model that was studied.
    fn file(&self) -> &ModelFile;
    /// Studied motions.
    fn motions(&self) -> &Motions<'_>;
    /// Index among all motions of the model.
    fn number(&self, motion: usize) -> usize;
    /// Page of a motion; `None` if no position could be solved.
    fn page(&self, motion: usize) -> Option<String>;

    /// All pages.
    fn pages(&self) -> impl Iterator<Item = Page> {
        let case = |k| case_name(&self.file().model, self.number(k));
        (0..self.motions().analyses().len()).filter_map(move |k| Some((case(k), self.page(k)?)))
    }

    /// Writes the pages and returns the file names.
    fn write_pages(&self, folder: &mut Folder) -> Result<Vec<String>, WriteError> {
        let mut written = Vec::new();
        for (case, html) in self.pages() {
            let name = case.map_or("report.html".into(), |case| format!("report-{}.html", file_name(&case)));
            folder.write(&name, |out| out.write_all(html.as_bytes()))?;
            written.push(folder.path_of(&name).display().to_string());
        }
        Ok(written)
    }
}

/// The design that a study found.
pub struct FoundDesign<'a> {
    /// Change of every variable, in SI.
    pub design: &'a [f64],
    /// Description in one sentence.
    pub note: &'a str,
}

/// Page of one motion with the nominal and the resulting design; `finish` adds the results of the study. `None` if no
/// position could be solved.
pub fn page(
    file: &ModelFile,
    analysis: &Analysis<'_>,
    found: Option<&FoundDesign<'_>>,
    finish: impl Fn(Payload, &Solution) -> Payload,
) -> Option<String> {
    let mut file = file.clone();
    file.model = Model::clone(analysis.model());
    let today = analysis.run();
    if today.motion.is_empty() {
        return None;
    }
    let course = Course::of(&file.model, &today);
    let mut summary = Summary::new(&file, analysis, &course);
    summary.diagnostics = diagnose::all(&file, &summary, &course, None);
    let exact = found.map(|f| analysis.solve(Run::new().at(f.design).without_sensitivities()));
    let changed = found.zip(exact.as_ref()).map(|(found, exact)| ChangedDesign {
        name: "found".into(),
        note: found.note.into(),
        change: found.design,
        today: &today,
        exact,
        prediction: None,
    });
    let request = Request { changed, ..Request::of(&file, analysis, &course, &summary) };
    Some(report(&request, &|page| finish(page, &today)).expect("a payload is plain data"))
}

/// Requested number of threads, or one for each core.
pub fn threads(asked: Option<NonZero<usize>>) -> NonZero<usize> {
    asked.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZero::<usize>::MIN)
}
