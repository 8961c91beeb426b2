//! `hardpoint sweep`.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;

use hardpoint::Solution;
use hardpoint::model::{Model, SweepMethod, SweepSettings, VariableId};
use hardpoint_file::ModelFile;
use hardpoint_report::page::SweepPlot;
use hardpoint_report::sweep::{SweepFacts, SweepInputs, Tally};
use hardpoint_study::Motions;
use hardpoint_study::request::variable;
use hardpoint_study::sweep::{self, Overrides, Request, Sweep as Designs};

use crate::args::{Method, Sweep, TableForm};
use crate::folder::{Folder, WriteError};
use crate::journal::{Checksum, Fingerprint, Journal, JournalError};
use crate::outcome::Outcome;
use crate::pages::{Page, Study, page, threads};
use crate::session::{Session, json_text};
use crate::text;
use hardpoint_export::long_table::{TableFormat, TableWriter};

/// Journal of an unfinished sweep in its folder.
const JOURNAL: &str = "sweep.partial";
/// Result files of a sweep; those of an earlier sweep are removed.
const FILES: [&str; 5] = ["designs.csv", "designs.parquet", "curves.csv", "curves.parquet", "summary.json"];

/// Sweeps over designs, writes the results and prints a summary.
pub fn run(options: &Sweep) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(sweep_in(&session, options))
}

pub fn sweep_in(session: &Session, options: &Sweep) -> Result<Outcome, Outcome> {
    let file = session.read(&options.common.model)?;
    let finish = |results: &Results<'_>, folder| results.finish(session, folder);
    let (mut facts, ()) = swept(session, &file, options, finish)?;
    facts.seconds = session.seconds();
    if session.is_json() {
        session.print_json(&facts);
    } else {
        text::print(&format!(
            "{}\n{}",
            text::bold(&file.model.name),
            text::study(facts.rows(), facts.seconds, &facts.tables())
        ));
        text::print(&text::written(&facts.files));
    }
    Ok(match facts.status {
        "interrupted" => Outcome::Interrupted,
        "no_design" => Outcome::Stopped,
        _ => Outcome::Done,
    })
}

/// Sweeps over designs for a page: returns all pages with their cases and writes no file.
pub fn for_page(
    session: &Session,
    file: &ModelFile,
    options: &Sweep,
) -> Result<(SweepFacts, Vec<Page>), Outcome> {
    swept(session, file, options, |results, _| {
        let (facts, plot) = results.facts(session, &results.tally(session)?)?;
        let pages = Pages { swept: results.swept, facts: &facts, plot: &plot }.pages().collect();
        Ok((facts, pages))
    })
}

/// Solves the designs; `end` turns them into the result.
fn swept<X>(
    session: &Session,
    file: &ModelFile,
    options: &Sweep,
    end: impl FnOnce(&Results<'_>, Option<Folder>) -> Result<(SweepFacts, X), Outcome>,
) -> Result<(SweepFacts, X), Outcome> {
    let numbers = session.numbers_of(file, &options.motions)?;
    let overrides = overrides(session, file, options)?;
    let request = Request::of(&file.model, overrides).map_err(|e| session.refused(file, &e))?;
    let asked = &request.settings;
    let models = file.model.motions();
    let models: Vec<Model> = numbers.iter().map(|k| models[*k].clone()).collect();
    let motions = Motions::of(&models, options.common.formulation());
    let motions = motions.map_err(|(_, fault)| session.cannot_be_driven(file, &fault))?;
    let designs = Designs::new(&file.model, &motions, &numbers, &request);
    let designs = designs.map_err(|e| session.refused(file, &e))?;
    let folder = session.folder(options.output.as_deref())?;
    let mut journal =
        journal(session, folder.as_ref(), fingerprint(file, &numbers, asked, options), options)?;

    session.patient(true);
    solve(session, &designs, &mut journal, options)?;
    let swept = SweepInputs { file, numbers: &numbers, asked, motions: &motions, sweep: &designs };
    let results = Results { swept, journal: &journal, format: options.format.of() };
    let (facts, made) = end(&results, folder)?;
    if facts.status != "interrupted" {
        journal.remove().map_err(|error| session.not_written(&WriteError { path: JOURNAL.into(), error }))?;
    }
    Ok((facts, made))
}

/// Options that override those of the file.
fn overrides(session: &Session, file: &ModelFile, options: &Sweep) -> Result<Overrides, Outcome> {
    let designs = options.designs.as_ref().map(|path| file.designs(path)).transpose();
    let designs = designs.map_err(|found| {
        session.not_read(&found);
        Outcome::BadModel
    })?;
    Ok(Overrides {
        designs,
        method: options.method.map(Method::of),
        samples: options.samples.map(|n| n as usize),
        seed: options.seed.map(u64::from),
        levels: options.levels.map(|n| n as usize),
        ranges: options.range.iter().map(|text| range(session, file, text)).collect::<Result<_, _>>()?,
        curves: options.curves.clone(),
    })
}

/// `NAME=FROM..TO`, in the unit of the variable.
fn range(session: &Session, file: &ModelFile, text: &str) -> Result<(VariableId, [f64; 2]), Outcome> {
    let refuse = |why: &str| session.misunderstood(&format!("`--range {text}`: {why}"));
    let parts = text.split_once('=').and_then(|(name, ends)| Some((name.trim(), ends.split_once("..")?)));
    let Some((name, (from, to))) = parts else {
        return Err(refuse("write it as `NAME=FROM..TO`, for example `lca_front_z=-5..5`"));
    };
    let variable = variable(&file.model, name).map_err(|error| session.refused(file, &error))?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let [Some(from), Some(to)] = [from, to].map(number) else {
        return Err(refuse("both ends are numbers without units, in the units of the model file"));
    };
    Ok((variable, [from, to].map(|x| file.change_to(variable, x))))
}

/// Identity of a sweep: the meaning of the model, the designs, the stored results, and the program.
fn fingerprint(file: &ModelFile, numbers: &[usize], asked: &SweepSettings, options: &Sweep) -> Fingerprint {
    let mut sum = Checksum::default();
    let of =
        (hardpoint_report::GENERATOR, &file.model, file.units, numbers, asked, options.common.formulation());
    write!(sum, "{of:?}").expect("a checksum takes everything");
    sum.0
}

fn journal(
    session: &Session,
    folder: Option<&Folder>,
    of: Fingerprint,
    options: &Sweep,
) -> Result<Journal, Outcome> {
    let path = folder.map(|f| f.path_of(JOURNAL));
    let shown = path.as_deref().unwrap_or(Path::new(JOURNAL)).display().to_string();
    match Journal::open(path.as_deref(), of, options.restart) {
        Ok(journal) => {
            if journal.designs() > 0 {
                session.remark(&format!("resuming after {} designs in `{shown}`", journal.designs()));
            }
            Ok(journal)
        }
        Err(JournalError::Other) => Err(session.misunderstood(&format!(
            "`{shown}` belongs to an unfinished sweep of another model or other designs; use another folder with `-o`, or start again \
             with `--restart`"
        ))),
        Err(JournalError::Busy) => Err(session.misunderstood(&format!(
            "another sweep is writing `{shown}`; wait until it ends, or use another folder with `-o`"
        ))),
        Err(JournalError::Failed(error)) => {
            Err(session.not_written(&WriteError { path: path.unwrap_or(JOURNAL.into()), error }))
        }
    }
}

/// Solves the designs that the journal lacks, with progress.
fn solve(
    session: &Session,
    designs: &Designs<'_>,
    journal: &mut Journal,
    options: &Sweep,
) -> Result<(), Outcome> {
    let count = designs.plan().count();
    let from = journal.designs();
    let mut meter = session.meter("solving", "designs").with_rate(from);
    let mut failure = None;
    let mut done = |block: sweep::Block| {
        if let Err(error) = journal.add(&block) {
            failure = Some(error);
            return ControlFlow::Break(());
        }
        meter.show(block.numbers.end, count);
        session.go_on()
    };
    if from < count {
        designs.run(from, threads(options.threads), &|| session.go_on().is_continue(), &mut done);
    }
    match failure {
        Some(error) => Err(session.not_written(&WriteError { path: JOURNAL.into(), error })),
        None => Ok(()),
    }
}

/// Results to write, from the journal.
struct Results<'a> {
    swept: SweepInputs<'a>,
    journal: &'a Journal,
    format: TableFormat,
}

impl Results<'_> {
    /// Writes tables, a page for each motion, and the summary last.
    fn finish(&self, session: &Session, folder: Option<Folder>) -> Result<(SweepFacts, ()), Outcome> {
        let mut files = Vec::new();
        let (folder, tally) = match folder {
            None => (None, self.tally(session)?),
            Some(mut folder) => {
                let mut tally = Tally::default();
                let written = self.write_tables(&mut folder, &mut tally, &mut files);
                written.map_err(|e| session.not_written(&e))?;
                (Some(folder), tally)
            }
        };
        let (mut facts, plot) = self.facts(session, &tally)?;
        if facts.status == "interrupted" {
            facts.message += match &folder {
                Some(_) => "; the same command resumes it",
                None => "; with `--output`, the same command would resume it",
            };
        }
        facts.files = files;
        let Some(mut folder) = folder else { return Ok((facts, ())) };
        let pages = Pages { swept: self.swept, facts: &facts, plot: &plot }.write_pages(&mut folder);
        facts.files.extend(pages.map_err(|e| session.not_written(&e))?);
        facts.files.push(folder.path_of("summary.json").display().to_string());
        facts.seconds = session.seconds();
        let json = json_text(&facts);
        let written = folder.write("summary.json", |out| out.write_all(json.as_bytes()));
        written.and_then(|()| folder.commit(&FILES)).map_err(|e| session.not_written(&e))?;
        Ok((facts, ()))
    }

    /// Facts of all blocks.
    fn tally(&self, session: &Session) -> Result<Tally, Outcome> {
        let mut tally = Tally::default();
        let see = |block| {
            self.swept.tally(&mut tally, &block);
            Ok(())
        };
        self.journal.each(see).map_err(|e| not_read(session, e))?;
        Ok(tally)
    }

    fn facts(&self, session: &Session, tally: &Tally) -> Result<(SweepFacts, SweepPlot), Outcome> {
        self.swept.facts(tally, |k| self.journal.column(k)).map_err(|e| not_read(session, e))
    }

    fn write_tables(
        &self,
        folder: &mut Folder,
        tally: &mut Tally,
        files: &mut Vec<String>,
    ) -> Result<(), WriteError> {
        let (swept, suffix) = (self.swept, self.format.suffix());
        let name = format!("designs.{suffix}");
        folder.write(&name, |out| {
            let mut table = TableWriter::new(out, self.format, swept.columns(), &[])?;
            self.journal.each(|block| {
                swept.tally(tally, &block);
                table.add(swept.rows(&block))
            })?;
            table.end().map(drop)
        })?;
        files.push(folder.path_of(&name).display().to_string());
        if !swept.asked.curves.is_empty() {
            let name = format!("curves.{suffix}");
            folder.write(&name, |out| {
                let mut table = TableWriter::new(out, self.format, swept.curve_columns(), &[])?;
                self.journal.each(|block| table.add(swept.curve_rows(&block)))?;
                table.end().map(drop)
            })?;
            files.push(folder.path_of(&name).display().to_string());
        }
        Ok(())
    }
}

fn not_read(session: &Session, error: io::Error) -> Outcome {
    session.not_written(&WriteError { path: JOURNAL.into(), error })
}

/// Contents of the pages of a sweep.
struct Pages<'a> {
    swept: SweepInputs<'a>,
    facts: &'a SweepFacts,
    plot: &'a SweepPlot,
}

impl Study for Pages<'_> {
    fn file(&self) -> &ModelFile {
        self.swept.file
    }

    fn motions(&self) -> &Motions<'_> {
        self.swept.motions
    }

    fn number(&self, motion: usize) -> usize {
        self.swept.numbers[motion]
    }

    /// Page of the nominal design with the results of the sweep.
    fn page(&self, motion: usize) -> Option<String> {
        let finish = |page, today: &Solution| {
            self.facts.page(&self.swept, self.plot, motion, page, &today.measured.outputs)
        };
        page(self.swept.file, &self.swept.motions.analyses()[motion], None, finish)
    }
}

impl Method {
    fn of(self) -> SweepMethod {
        match self {
            Self::Factorial => SweepMethod::Factorial,
            Self::LatinHypercube => SweepMethod::LatinHypercube,
            Self::Sobol => SweepMethod::Sobol,
            Self::SobolIndices => SweepMethod::Indices,
        }
    }
}

impl TableForm {
    fn of(self) -> TableFormat {
        match self {
            Self::Csv => TableFormat::Csv,
            Self::Parquet => TableFormat::Parquet,
        }
    }
}
