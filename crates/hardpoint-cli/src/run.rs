//! `hardpoint run`.

use std::cell::OnceCell;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use hardpoint::model::{Model, NamedDesign, VariableId};
use hardpoint::run::{Clearances, metrics_beside};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_export::{DesignResult, PdfContent, PdfPart, RunDocument};
use hardpoint_file::ModelFile;
use hardpoint_report::GENERATOR;
use hardpoint_report::clearance::{self, ClearanceFact};
use hardpoint_report::columns::Columns;
use hardpoint_report::course::Course;
use hardpoint_report::deflection::DeflectionFact;
use hardpoint_report::diagnose;
use hardpoint_report::figures::{error, number, seconds, some_of, with_unit};
use hardpoint_report::joint_limits::JointLimitFact;
use hardpoint_report::loads;
use hardpoint_report::maps::MapFact;
use hardpoint_report::metric::{CaseMetrics, MetricFact};
use hardpoint_report::page::Table;
use hardpoint_report::payload::{Request, payload, report, stride_of_marks};
use hardpoint_report::results::JerkCsv;
use hardpoint_report::sketch::{Stroke, sketch};
use hardpoint_report::summary::{RunStatus, Summary};
use hardpoint_report::validity::ValidityFact;
use hardpoint_study::difference::{Difference, DifferenceScheme, finite_differences_each};
use hardpoint_study::validity;
use serde::{Deserialize, Serialize};

use crate::args::Run;
use crate::folder::{Folder, WriteError, file_name, of_case};
use crate::maps;
use crate::outcome::Outcome;
use crate::pages;
use crate::session::{Session, json_text};
use crate::tables::Plan;
use crate::text;

/// Step of the finite differences in the report, relative to the natural step: small enough for five digits, large
/// enough to avoid round-off.
const STEP: f64 = 1e-4;
/// Tolerance of motions solved with fewer output times, as a fraction of the mechanism's size.
const SAME_MOTION: f64 = 1e-6;
/// Message if the motion with fewer output times differs.
const NOT_THE_SAME: &str = "the motion changes if only the stored output times are solved: the sensitivities were not \
    compared with re-solved designs, and their linear range is unknown";
/// Message if sensitivities of bodies are not stored.
const TOO_MANY: &str = "the sensitivities were not compared with re-solved designs, because they are too many to be stored; \
    `hardpoint verify` compares them at fewer output times";
/// Message if the named designs of a long run are not solved for the printed report.
const DESIGNS_UNSOLVED: &str =
    "not in `report.pdf`: metrics of the named designs, because not all output times of the run are stored";
/// Number of output times per window of jerks.
const JERK_ROWS: usize = 256;

/// Page of a run.
const REPORT: &str = "report.html";
/// Distances of shapes.
const CLEARANCES: &str = "clearances.csv";
/// Metrics with their derivatives.
const METRICS: &str = "metrics.csv";
/// The outcome of a run, or of its cases.
const SUMMARY: &str = "summary.json";
/// All files that a run may write; the last one marks them as complete.
const FILES: [&str; 21] = [
    "motion.csv",
    "sensitivity.csv",
    "motion.npy",
    "sensitivity.npy",
    "columns.json",
    "motion.parquet",
    "sensitivity.parquet",
    "jerk.csv",
    "loads.csv",
    "drivers.csv",
    "deflections.csv",
    CLEARANCES,
    METRICS,
    "motion.xlsx",
    "report.pdf",
    "motion.glb",
    "maps.csv",
    "map_sensitivity.csv",
    "maps.json",
    REPORT,
    SUMMARY,
];

/// Solves, writes, and prints the summary.
pub fn run(options: &Run) -> Outcome {
    let session = Session::begin(options.common.json);
    let whole = options.output.clone().unwrap_or_else(|| default_folder(&options.common.model));
    let file = match session.read(&options.common.model) {
        Ok(file) => file,
        Err(outcome) => return outcome,
    };
    if let Some(name) = &options.motions.case {
        match grid_alone(&session, options, &file, name, &whole) {
            Ok(None) => {}
            Ok(Some(outcome)) | Err(outcome) => return outcome,
        }
    }
    // Every page has the maps of the whole file.
    let maps = match options.motions.case {
        None => maps::solved(&session, &file, options.common.formulation()),
        Some(_) => Vec::new(),
    };
    let earlier = if options.motions.case.is_none() { cases_in(&whole) } else { Vec::new() };
    let all = file.clone();
    let mut done: Vec<CaseDone> = Vec::new();
    let mut results = CaseResults { metrics: Vec::new(), first: None };
    let each = |file: ModelFile, case: Option<&str>| {
        let path = of_case(&whole, case);
        let outcome = run_in(&session, options, (&file, &maps), case, &path, &mut results);
        if let Some(case) = case {
            let (Ok(ended) | Err(ended)) = outcome;
            let folder = path.file_name().map(|name| name.to_string_lossy().into_owned());
            done.push(CaseDone {
                case: case.into(),
                folder: folder.unwrap_or_default(),
                exit_code: ended as u8,
            });
        }
        outcome
    };
    let several = !file.model.cases.is_empty() && options.motions.case.is_none();
    let outcome = session.end(session.for_motions_of(file, &options.motions, each));
    if !session.interrupted() {
        let gone = earlier.iter().filter(|folder| done.iter().all(|case| case.folder != **folder));
        if let Err(error) =
            gone.map(|name| whole.join(name)).try_for_each(|path| Folder::clear(&path, &FILES))
        {
            return session.not_written(&error);
        }
    }
    if !several {
        return outcome;
    }
    let written = Folder::open(&whole).and_then(|mut folder| {
        maps::write(&maps, &mut folder)?;
        let page = if session.interrupted() { None } else { page_of_cases(&all, options, &results, &maps) };
        write_metrics(&results.metrics, &all, &mut folder)?;
        if let Some(html) = &page {
            folder.write(REPORT, |out| out.write_all(html.as_bytes()))?;
        }
        let json = json_text(&serde_json::json!({ "generator": GENERATOR, "cases": done }));
        folder.write(SUMMARY, |out| out.write_all(json.as_bytes()))?;
        let report = page.map(|_| folder.path_of(REPORT));
        folder.commit(&[METRICS, REPORT])?;
        Ok(report)
    });
    let report = match written {
        Ok(report) => report,
        Err(error) => return session.not_written(&error),
    };
    if !options.common.json {
        let tables =
            CaseMetrics::table(&results.metrics, &all.model).into_iter().chain(MapFact::table(&maps));
        tables.for_each(|table| text::print(&text::section(&table)));
        if let Some(report) = report {
            text::print(&format!("\nreport of all cases: {}\n", report.display()));
        }
    }
    outcome
}

/// Names of the folders of cases that an earlier run left in the folder of the results, by its summary and by theirs:
/// a run of one case alone replaces the former.
fn cases_in(whole: &Path) -> Vec<String> {
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct Earlier {
        case: Option<String>,
        cases: Vec<CaseDone>,
    }
    let read = |folder: &Path| -> Earlier {
        let text = std::fs::read_to_string(folder.join(SUMMARY)).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    };
    let inside = std::fs::read_dir(whole).into_iter().flatten().flatten();
    let inside =
        inside.filter_map(|entry| Some((read(&entry.path()).case?, entry.file_name().into_string().ok()?)));
    let listed = read(whole).cases.into_iter().map(|done| (done.case, done.folder));
    listed
        .chain(inside)
        .filter(|(case, folder)| file_name(case) == *folder)
        .map(|(_, folder)| folder)
        .collect()
}

/// Writes the metrics of all cases, if there are any.
fn write_metrics(metrics: &[CaseMetrics], file: &ModelFile, folder: &mut Folder) -> Result<(), WriteError> {
    if metrics.iter().all(|of| of.metrics.is_empty()) {
        return Ok(());
    }
    folder.write(METRICS, |out| Ok(CaseMetrics::write(metrics, &file.model, file.units, out)?))
}

/// Results of the cases for the page of all of them.
struct CaseResults {
    metrics: Vec<CaseMetrics>,
    /// Motion of the first case, if it was solved.
    first: Option<Course>,
}

/// Page of the file's first motion with the metrics of all cases; `None` without metrics, or if no position of that
/// motion was solved.
fn page_of_cases(all: &ModelFile, options: &Run, results: &CaseResults, maps: &[MapFact]) -> Option<String> {
    let CaseResults { metrics, first } = results;
    let course = first.as_ref().filter(|course| !course.kept.motion.is_empty())?;
    if metrics.iter().all(|of| of.metrics.is_empty()) {
        return None;
    }
    let mut file = all.clone();
    file.model = all.model.motions().into_iter().next()?;
    let analysis = Analysis::with(&file.model, options.common.formulation()).ok()?;
    let mut summary = Summary::new(&file, &analysis, course);
    summary.diagnostics = diagnose::all(&file, &summary, course, None);
    let finish = |page| CaseMetrics::page(metrics, &all.model, MapFact::page(maps, page));
    Some(report(&Request::of(&file, &analysis, course, &summary), &finish).expect("a payload is plain data"))
}

/// Solves only the case of that name, if it is a grid.
fn grid_alone(
    session: &Session,
    options: &Run,
    file: &ModelFile,
    name: &str,
    whole: &Path,
) -> Result<Option<Outcome>, Outcome> {
    if session.case_or_grid(file, name)?.is_ok() {
        return Ok(None);
    }
    let mut file = file.clone();
    file.model.grids.retain(|grid| grid.name == name);
    let mut folder = Folder::open(whole).map_err(|e| session.not_written(&e))?;
    let maps = maps::solved(session, &file, options.common.formulation());
    if options.common.json {
        session.print_json(&serde_json::json!({ "generator": GENERATOR, "maps": maps }));
    } else {
        MapFact::table(&maps).iter().for_each(|table| text::print(&text::table(table)));
    }
    let mut names = maps::write(&maps, &mut folder).map_err(|e| session.not_written(&e))?;
    if let Some(html) = page_of_maps(&file, options.common.formulation(), &maps) {
        let page = folder.write("report.html", |out| out.write_all(html.as_bytes()));
        page.map_err(|e| session.not_written(&e))?;
        names.push("report.html");
    }
    let written: Vec<String> = names.iter().map(|name| folder.path_of(name).display().to_string()).collect();
    folder.commit(&FILES).map_err(|e| session.not_written(&e))?;
    if !options.common.json {
        text::print(&format!("\nwritten: {}\n", written.join(", ")));
    }
    Ok(Some(if session.interrupted() { Outcome::Interrupted } else { Outcome::Done }))
}

/// Outcome of a case, for the summary of all.
#[derive(Serialize, Deserialize)]
struct CaseDone {
    case: String,
    folder: String,
    exit_code: u8,
}

/// Page of the file's first motion with the maps of a grid; `None` if no position could be solved.
fn page_of_maps(file: &ModelFile, formulation: Formulation, maps: &[MapFact]) -> Option<String> {
    let model = file.model.motions().into_iter().next()?;
    let analysis = Analysis::with(&model, formulation).ok()?;
    pages::page(file, &analysis, None, |page, _| MapFact::page(maps, page))
}

/// Returns the report of a motion without writing it.
///
/// # Errors
/// Fails if the mechanism cannot be driven, or does not assemble.
pub fn page(
    session: &Session,
    file: &ModelFile,
    maps: &[MapFact],
    formulation: Formulation,
) -> Result<Page, Outcome> {
    let analysis = session.plan(file, formulation)?;
    let (read, started) = (session.seconds(), Instant::now());
    let course = session.solve_in_windows(&analysis, true, |_| true)?;
    let mut summary = Summary::new(file, &analysis, &course);
    (summary.timings.read, summary.timings.solve) = (read, started.elapsed().as_secs_f64());
    summary.diagnostics = diagnose::all(file, &summary, &course, None);
    if course.kept.motion.is_empty() {
        session.fail(file, &summary.diagnostics);
        return Err(Outcome::Stopped);
    }
    let mut results = Results {
        file,
        analysis: &analysis,
        course: &course,
        differences: Vec::new(),
        maps,
        clearances: None,
    };
    results.study(session, formulation, true, &mut summary);
    maps::note(maps, &mut summary);
    summary.timings.total = session.seconds();
    Ok(results.page(&summary))
}

fn run_in(
    session: &Session,
    options: &Run,
    (file, maps): (&ModelFile, &[MapFact]),
    case: Option<&str>,
    path: &Path,
    cases: &mut CaseResults,
) -> Result<Outcome, Outcome> {
    let not_written = |e: WriteError| session.not_written(&e);
    let analysis = session.plan(file, options.common.formulation())?;
    let read = session.seconds();
    let mut folder = Folder::open(path).map_err(not_written)?;
    let plan = Plan::new(file, options);
    if let Some(announcement) = plan.announcement(&path.display().to_string()) {
        session.remark(&announcement);
    }

    let started = Instant::now();
    let mut tables = plan.begin(&folder).map_err(not_written)?;
    session.patient(true);
    let course =
        session.solve_in_windows(&analysis, !options.no_sensitivities, |window| tables.add(window))?;
    let solve = started.elapsed().as_secs_f64();
    let solution = &course.kept;
    let mut summary = Summary::new(file, &analysis, &course);
    (summary.timings.read, summary.timings.solve) = (read, solve);
    summary.case = case.map(str::to_owned);
    let outputs = format!("the files in `{}`", path.display());
    summary.diagnostics = diagnose::all(file, &summary, &course, Some(&outputs));
    let written = tables.end(&mut folder, &solution.sensitivities.admissibility, session.for_a_moment());
    let written = written.map_err(not_written)?;
    summary.left_out.extend(plan.left_out());
    summary.left_out.extend(written.left_out);

    let mut results = Results {
        file,
        analysis: &analysis,
        course: &course,
        differences: Vec::new(),
        maps,
        clearances: None,
    };
    results.study(session, options.common.formulation(), !options.no_compare, &mut summary);

    cases.metrics.push(CaseMetrics {
        case: case.map_or_else(String::new, str::to_owned),
        metrics: summary.metrics.clone(),
    });

    let report = folder.path_of(REPORT);
    let mut tables_after = Vec::new();
    if solution.motion.is_empty() {
        summary.timings.total = session.seconds();
    } else {
        let stopped_before = session.interrupted();
        if stopped_before && summary.status == RunStatus::Complete {
            summary.status = RunStatus::Interrupted;
        }
        add_files(&mut summary, &folder, &written.names);
        if !stopped_before {
            let studied = results.write_studied(session, options.jerk, &mut folder, &mut summary);
            tables_after.extend(studied.map_err(not_written)?);
        }
        let documents = results.write_documents(session, options, &mut folder, &mut summary);
        documents.map_err(not_written)?;
        // In a file with cases, the summary of the whole file has the maps.
        if case.is_none() {
            write_metrics(&cases.metrics, file, &mut folder).map_err(not_written)?;
            if !summary.metrics.is_empty() {
                add_files(&mut summary, &folder, &[METRICS]);
            }
            maps::note(maps, &mut summary);
            let names = maps::write(maps, &mut folder).map_err(not_written)?;
            add_files(&mut summary, &folder, &names);
            tables_after.extend(MapFact::table(maps));
        }
        results.write(&mut folder, &mut summary, session).map_err(not_written)?;
        if session.interrupted() && !stopped_before {
            session.ended_while_writing(path);
            return Err(Outcome::Interrupted);
        }
        folder.commit(&FILES).map_err(not_written)?;
    }

    session.tell(file, &summary.diagnostics);
    if options.common.json {
        session.print_json(&summary);
    } else {
        print_summary(&summary, &tables_after, Some(report).filter(|_| !solution.motion.is_empty()));
    }
    // The page of all cases shows the first one.
    if case.is_some() && cases.metrics.len() == 1 {
        cases.first = Some(course);
    }
    Ok(match summary.status {
        RunStatus::Stopped => Outcome::Stopped,
        RunStatus::Interrupted => Outcome::Interrupted,
        RunStatus::Complete => Outcome::Done,
    })
}

/// Prints the summary, further tables, and the path of the report if it is written.
fn print_summary(summary: &Summary, tables: &[Table], report: Option<PathBuf>) {
    text::print(&summary_text(summary));
    for table in tables {
        text::print(&text::section(table));
    }
    if let Some(report) = report {
        let partial = if summary.status == RunStatus::Complete { "" } else { " (partial)" };
        text::print(&format!("\nreport: {}{partial}\n", report.display()));
    }
}

/// Adds the paths of written files to the summary.
fn add_files(summary: &mut Summary, folder: &Folder, names: &[impl AsRef<str>]) {
    summary.files.extend(names.iter().map(|name| folder.path_of(name.as_ref()).display().to_string()));
}

/// `results/<stem>` under the current folder.
fn default_folder(model: &Path) -> PathBuf {
    Path::new("results").join(model.file_stem().unwrap_or(model.as_os_str()))
}

/// The model with the stored output times of a long motion, for the studies after it.
struct Sample {
    /// `None` if all output times were stored.
    model: Option<Model>,
    formulation: Formulation,
}

impl Sample {
    fn of(file: &ModelFile, formulation: Formulation, course: &Course) -> Self {
        let thinned = || Model { times: course.kept.motion.times.clone(), ..file.model.clone() };
        Self { model: (course.stride > 1).then(thinned), formulation }
    }

    /// Analysis with the stored output times; `None` if the motion differs with fewer output times.
    fn analysis<'a>(&'a self, all: &Analysis<'a>, course: &Course) -> Option<Analysis<'a>> {
        let Some(model) = &self.model else { return Some(all.clone()) };
        let analysis = Analysis::with(model, self.formulation).ok()?;
        let again = analysis.solve(hardpoint::Run::new().without_sensitivities()).motion;
        let kept = &course.kept.motion;
        let near = SAME_MOTION * model.size();
        let same = again.len() == kept.len()
            && again.states().zip(kept.states()).all(|(a, b)| (a.r - b.r).norm() <= near);
        same.then_some(analysis)
    }
}

/// Linear ranges of the sensitivities, unless the user interrupts.
pub fn trusted(
    session: &Session,
    file: &ModelFile,
    analysis: &Analysis<'_>,
    solution: &Solution,
) -> Vec<ValidityFact> {
    let nothing = solution.motion.is_empty() || solution.measured.outputs.is_empty();
    if nothing || session.interrupted() {
        return Vec::new();
    }
    let _working = session.working("second derivatives");
    let found = validity(analysis, solution, |_| !session.interrupted());
    ValidityFact::all(&file.model, file.units, solution, &found)
}

/// Finite differences of a complete motion by every admissible variable, until the user interrupts.
fn compare(session: &Session, analysis: &Analysis<'_>, solution: &Solution) -> Vec<Option<Difference>> {
    let model = analysis.model();
    let mut differences = vec![None; model.variables.len()];
    if solution.stop.is_some() || solution.motion.is_empty() || solution.sensitivities.variables == 0 {
        return differences;
    }
    let variables: Vec<VariableId> = (0..model.variables.len())
        .filter(|b| solution.sensitivities.at(0, *b).is_some())
        .map(VariableId)
        .collect();
    // Only at the output times that the page marks; `verify` compares at all of them.
    let stride = stride_of_marks(solution.motion.len());
    let mut meter = session.meter("comparing with re-solved designs", "variables");
    // Four at a time fill the lanes of the core.
    for (k, group) in variables.chunks(4).enumerate() {
        if session.interrupted() {
            break;
        }
        let steps: Vec<(VariableId, f64)> =
            group.iter().map(|v| (*v, STEP * model.natural_step(*v))).collect();
        let found = finite_differences_each(analysis, solution, DifferenceScheme::Central, &steps, stride);
        for (variable, difference) in group.iter().zip(found) {
            differences[variable.0] = difference.ok();
        }
        meter.show(4 * k + group.len(), variables.len());
    }
    differences
}

fn write_jerk(
    session: &Session,
    file: &ModelFile,
    analysis: &Analysis<'_>,
    folder: &mut Folder,
) -> Result<(), WriteError> {
    let _working = session.working("third derivatives");
    let columns = Columns { model: &file.model, units: file.units, bodies: true, angles: None };
    folder.write("jerk.csv", |out| {
        // Only the end of the program can interrupt this part; no file is in its place yet.
        session.patient(false);
        let mut table = JerkCsv::new(columns, out)?;
        let mut failure = None;
        analysis.jerks_in_windows(JERK_ROWS, |jerks| {
            if failure.is_none() {
                failure = table.add(jerks).err();
            }
        });
        session.patient(true);
        failure.map_or(Ok(()), |e| Err(e.into())).and_then(|()| table.end().map(|_| ()))
    })
}

/// Page of a motion.
pub struct Page {
    pub html: String,
    /// Line drawing of the mechanism.
    pub picture: Vec<Stroke>,
}

struct Results<'a> {
    file: &'a ModelFile,
    analysis: &'a Analysis<'a>,
    course: &'a Course,
    differences: Vec<Option<Difference>>,
    maps: &'a [MapFact],
    /// Minima and contacts of the clearances, once they are located.
    clearances: Option<Clearances>,
}

impl Results<'_> {
    /// Compares the sensitivities with re-solved designs and determines their linear ranges, until the user interrupts.
    fn study(&mut self, session: &Session, formulation: Formulation, comparing: bool, summary: &mut Summary) {
        let (course, solution) = (self.course, &self.course.kept);
        if session.interrupted() || solution.motion.is_empty() {
            return;
        }
        let started = Instant::now();
        let sample = Sample::of(self.file, formulation, course);
        let studied = sample.analysis(self.analysis, course);
        if let Some(studied) = studied.as_ref().filter(|_| comparing && course.has_bodies()) {
            self.differences = compare(session, studied, solution);
        }
        summary.timings.compare = started.elapsed().as_secs_f64();
        if let Some(studied) = &studied {
            summary.validity = trusted(session, self.file, studied, solution);
        } else {
            summary.left_out.push(NOT_THE_SAME.into());
        }
        if comparing && !course.has_bodies() {
            summary.left_out.push(TOO_MANY.into());
        }
    }

    /// Solves and writes third derivatives if wanted, loads and clearances. Returns the table of the clearances.
    fn write_studied(
        &mut self,
        session: &Session,
        jerk: bool,
        folder: &mut Folder,
        summary: &mut Summary,
    ) -> Result<Option<Table>, WriteError> {
        let model = &self.file.model;
        if jerk {
            write_jerk(session, self.file, self.analysis, folder)?;
            add_files(summary, folder, &["jerk.csv"]);
        }
        if model.has_loads() {
            self.write_loads(session, folder, summary)?;
        }
        if model.clearances.is_empty() {
            return Ok(None);
        }
        let _working = session.working("least distances of shapes");
        let found = session.until_interrupted(self.analysis.clone()).clearances(&[]);
        let units = self.file.units;
        folder.write(CLEARANCES, |out| Ok(clearance::write(model, units, &found, out)?))?;
        add_files(summary, folder, &[CLEARANCES]);
        let table = ClearanceFact::table(&ClearanceFact::all(model, units, &found));
        self.clearances = Some(found);
        Ok(table)
    }

    /// Writes the reactions of the joints, the forces of the drivers, and the deflections of elastic joints, if any.
    fn write_loads(
        &self,
        session: &Session,
        folder: &mut Folder,
        summary: &mut Summary,
    ) -> Result<(), WriteError> {
        let _working = session.working("reactions of the joints");
        let loads = self.analysis.loads_with_sensitivities(&[]);
        let (model, units) = (&self.file.model, self.file.units);
        folder.write("loads.csv", |out| Ok(loads::write(model, units, &loads, out)?))?;
        folder.write("drivers.csv", |out| Ok(loads::write_drivers(model, units, &loads, out)?))?;
        add_files(summary, folder, &["loads.csv", "drivers.csv"]);
        let deflections = DeflectionFact::all(model, units, &loads);
        if !deflections.is_empty() {
            folder.write("deflections.csv", |out| {
                Ok(DeflectionFact::write(&deflections, model, units, out)?)
            })?;
            add_files(summary, folder, &["deflections.csv"]);
        }
        Ok(())
    }

    /// Writes the workbook, the printed report and the animation, as far as they are wanted.
    fn write_documents(
        &self,
        session: &Session,
        options: &Run,
        folder: &mut Folder,
        summary: &mut Summary,
    ) -> Result<(), WriteError> {
        let (file, course, suffix) = (self.file, self.course, options.format.suffix());
        if options.workbook {
            let contents = RunDocument { file, course, summary, suffix };
            let left_out = folder.write("motion.xlsx", |out| contents.write(out))?;
            summary.left_out.extend(left_out);
            add_files(summary, folder, &["motion.xlsx"]);
        }
        if options.pdf || !options.pdf_parts.is_empty() {
            let contents = RunDocument { file, course, summary, suffix };
            let content = self.pdf_content(session, &options.pdf_parts, summary);
            let left_out = folder.write("report.pdf", |out| contents.write_pdf(&content, out))?;
            if course.stride > 1 && !content.designs.is_empty() && content.has(PdfPart::Metrics) {
                summary.left_out.push(DESIGNS_UNSOLVED.into());
            }
            summary.left_out.extend(left_out);
            add_files(summary, folder, &["report.pdf"]);
        }
        if options.gltf {
            let glb = hardpoint_export::animation(file, &course.kept.motion);
            folder.write("motion.glb", |out| glb.and_then(|glb| out.write_all(&glb)))?;
            let every = course.stride;
            summary.left_out.extend(
                (every > 1).then(|| format!("not in `motion.glb`: only one output time in {every} is there")),
            );
            add_files(summary, folder, &["motion.glb"]);
        }
        Ok(())
    }

    /// Chosen parts of the printed report, all if none is chosen, with the named designs solved for them.
    fn pdf_content(&self, session: &Session, parts: &[PdfPart], summary: &Summary) -> PdfContent {
        let parts = if parts.is_empty() { PdfPart::ALL.to_vec() } else { parts.to_vec() };
        let (model, today) = (&self.file.model, &self.course.kept);
        let has = |part| parts.contains(&part);
        let picture = if has(PdfPart::Picture) && !today.motion.is_empty() {
            let run = Request::of(self.file, self.analysis, self.course, summary);
            sketch(&payload(&run))
        } else {
            Vec::new()
        };
        let is_compared = has(PdfPart::Metrics) || has(PdfPart::Hardpoints);
        let result = |design: &NamedDesign| {
            let change = design.changes_of(model.variables.len());
            let run = || hardpoint::Run::new().at(&change).without_sensitivities();
            // Of a long run, whose output times are not all stored, metrics are those of the nominal design only.
            let is_solved = has(PdfPart::Metrics) && !model.metrics.is_empty() && self.course.stride == 1;
            let metrics = if is_solved && !session.interrupted() {
                metrics_beside(model, today, &self.analysis.solve(run()))
            } else {
                vec![None; model.metrics.len()]
            };
            DesignResult { name: design.name.clone(), places: model.hardpoint_places(&change), metrics }
        };
        let designs = model.designs.iter().filter(|_| is_compared).map(result).collect();
        PdfContent { parts, picture, designs }
    }

    fn page(&self, summary: &Summary) -> Page {
        let run = Request::of(self.file, self.analysis, self.course, summary);
        let picture = OnceCell::new();
        let finish = |page| {
            picture.get_or_init(|| sketch(&page));
            MapFact::page(self.maps, page)
        };
        let request = Request { differences: &self.differences, clearances: self.clearances.as_ref(), ..run };
        let html = report(&request, &finish).expect("a payload is plain data");
        Page { html, picture: picture.into_inner().unwrap_or_default() }
    }

    fn write(&self, folder: &mut Folder, summary: &mut Summary, session: &Session) -> Result<(), WriteError> {
        let started = Instant::now();
        let _working = session.working("writing");
        let Page { html, .. } = self.page(summary);
        folder.write("report.html", |out| out.write_all(html.as_bytes()))?;
        add_files(summary, folder, &[REPORT, SUMMARY]);
        summary.timings.write = started.elapsed().as_secs_f64();
        summary.timings.total = session.seconds();
        let json = json_text(summary);
        folder.write(SUMMARY, |out| out.write_all(json.as_bytes()))
    }
}

fn summary_text(summary: &Summary) -> String {
    let (model, steps, timings) = (&summary.model, &summary.steps, &summary.timings);
    let bodies =
        if model.counts.bodies == 1 { "1 body".into() } else { format!("{} bodies", model.counts.bodies) };
    let cut: Vec<&str> = model.joints.iter().filter(|j| j.role == "cut").map(|j| j.name.as_str()).collect();
    let cut = if cut.is_empty() { String::new() } else { format!(", cut: {}", some_of(&cut, ", ")) };
    let joints = model.joints_text();
    let mut rows = vec![
        ("bodies and joints", format!("{bodies}, {joints}{cut}")),
        ("degrees of freedom", model.freedom_line()),
        ("loops", model.loops_line()),
    ];
    if model.counts.redundant_constraints > 0 {
        rows.push(("redundant constraints", model.counts.redundant_constraints.to_string()));
    }
    let last = steps
        .last_solved
        .map_or("none".into(), |t| format!("t = {} to {} s", number(steps.start), number(t)));
    rows.push(("steps", format!("{} of {}, {last}", steps.solved, steps.asked)));
    rows.push(("worst residual", format!("{} m or rad", error(summary.effort.worst_residual_si))));
    rows.extend(summary.margin.as_ref().map(|m| ("margin", m.line())));
    rows.extend(summary.effort.uncertain_stability.map(|t| {
        (
            "stability",
            format!("not certain from t = {} s on: forces that follow a body have no potential", number(t)),
        )
    }));
    rows.push(("design variables", model.variables_line()));
    let parts = [("solving", timings.solve), ("comparing", timings.compare), ("writing", timings.write)];
    let parts: Vec<String> =
        parts.iter().filter(|(_, s)| *s > 1e-5).map(|(what, s)| format!("{what} {}", seconds(*s))).collect();
    rows.push(("time taken", format!("{} ({})", seconds(timings.total), parts.join(", "))));
    let mut out = format!("{}\n{}{}", text::bold(&model.name), text::pairs(&rows), text::notes(summary));
    let assembly = summary.assembly.iter().flat_map(|a| a.tables());
    let metrics = MetricFact::table(&summary.metrics).into_iter();
    let limits = JointLimitFact::table(&summary.joint_limits).into_iter();
    let trusted = summary.validity_table().into_iter();
    for table in assembly
        .chain(limits)
        .chain(metrics)
        .chain(trusted)
        .chain(largest(summary).filter(|_| steps.solved > 0))
    {
        out += &text::section(&table);
    }
    out
}

/// The two largest sensitivities of every measure within each unit of variables.
fn largest(summary: &Summary) -> Option<Table> {
    const SHOWN: usize = 2;
    let mut rows = Vec::new();
    for ranking in summary.sensitivities.iter().filter(|r| r.order == "value") {
        let mut name = ranking.measure.clone();
        if ranking.largest.is_empty() {
            rows.push(vec![name, ranking.without_influence(), String::new(), String::new()]);
            continue;
        }
        for (k, r) in ranking.largest.iter().enumerate() {
            let before = ranking.largest[..k].iter().filter(|other| other.per == r.per).count();
            if before < SHOWN {
                let at = format!("{} s", number(r.time));
                rows.push(vec![
                    std::mem::take(&mut name),
                    r.variable.clone(),
                    with_unit(r.value, &r.unit),
                    at,
                ]);
            }
        }
    }
    (!rows.is_empty()).then(|| Table {
        title: "Largest sensitivities of each measure over the motion".into(),
        note: String::new(),
        header: ["measure", "by variable", "largest", "at t"].map(String::from).to_vec(),
        rows,
    })
}
