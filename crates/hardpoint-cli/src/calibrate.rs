//! `hardpoint calibrate`.

use std::io::Write;
use std::num::NonZero;

use hardpoint::model::VariableId;
use hardpoint::{Analysis, Solution};
use hardpoint_file::ModelFile;
use hardpoint_report::calibrate::{CalibrateFacts, CalibrationInputs};
use hardpoint_report::figures::number;
use hardpoint_study::calibrate::{Calibration, Error, Loss, Overrides, Request, Status, calibrate};
use hardpoint_study::request::variable;
use hardpoint_study::{Control, Progress, Step};

use crate::args::{Calibrate, LossKind};
use crate::folder::{Folder, WriteError};
use crate::outcome::Outcome;
use crate::pages::{FoundDesign, page};
use crate::session::{Session, json_text};
use crate::text;

/// Fits the design, writes the results and prints a summary.
pub fn run(options: &Calibrate) -> Outcome {
    let session = Session::begin(options.common.json);
    session.end(calibrate_in(&session, options))
}

/// Result files; the summary is written last and marks them as complete.
const FILES: [&str; 4] = ["residuals.csv", "covariance.csv", "report.html", "summary.json"];

fn calibrate_in(session: &Session, options: &Calibrate) -> Result<Outcome, Outcome> {
    let file = session.read(&options.common.model)?;
    let sigmas = sigmas(session, &options.sigma)?;
    let measured = file.measured(&options.measured, &sigmas).map_err(|found| {
        session.not_read(&found);
        Outcome::BadModel
    })?;
    let validation = options.validate.as_ref().map(|path| file.measured(path, &sigmas)).transpose();
    let validation = validation.map_err(|found| {
        session.not_read(&found);
        Outcome::BadModel
    })?;
    let overrides = Overrides {
        variables: options.variable.clone(),
        priors: options.prior.iter().map(|text| prior(session, &file, text)).collect::<Result<_, _>>()?,
        priors_from: options.priors.clone(),
        groups: Vec::new(),
        offsets: options.offset.clone(),
        validation: validation.as_ref().map(|data| &data.measurements),
        loss: options.loss.of(),
        formulation: options.common.formulation(),
        iterations: Some(options.iterations.get()),
    };
    let request = Request::of(&file.model, &measured.measurements, &overrides)
        .map_err(|error| session.refused(&file, &error))?;
    session.may_save(&options.common.model, options.save.as_deref())?;
    session.can_save(&file, &request.variables, options.save.as_deref())?;
    let folder = session.folder(options.output.as_deref())?;

    session.patient(true);
    let found = search(session, &file, &request)?;
    let loss = request.loss;
    let data = options.measured.display().to_string();
    let validated = options.validate.as_ref().map(|path| path.display().to_string());
    let validation = validation.as_ref().zip(validated.as_deref());
    let calibrated =
        CalibrationInputs { file: &file, measured: &measured, data: &data, validation, loss, found: &found };
    let mut facts = CalibrateFacts::of(&calibrated);
    facts.seconds = session.seconds();
    let mut saved = Ok(None);
    if let Some(to) = &options.save {
        match session.save_result(&file, &found.design, to) {
            Ok(()) => {
                facts.files.push(to.display().to_string());
                saved = Ok(Some(to));
            }
            Err((diagnostics, why, outcome)) => {
                facts.message = format!("{}; the result could not be saved: {why}", facts.message);
                session.tell(&file, &diagnostics);
                saved = Err(outcome);
            }
        }
    }
    let unwritten = facts.files.len();
    if let Some(mut folder) = folder {
        let results = Results { calibrated, options };
        results.write(&mut folder, &mut facts).map_err(|e| session.not_written(&e))?;
        folder.commit(&FILES).map_err(|e| session.not_written(&e))?;
    }
    if session.is_json() {
        session.print_json(&facts);
    } else {
        text::print(&text::study(facts.rows(), facts.seconds, &facts.tables()));
        text::print(&text::written(&facts.files[unwritten..]));
        text::print(
            &saved.ok().flatten().map_or(String::new(), |path| format!("saved: {}\n", path.display())),
        );
    }
    saved?;
    Ok(match found.status {
        Status::Interrupted => Outcome::Interrupted,
        Status::IterationLimit | Status::Stuck | Status::Diverged => Outcome::FellShort,
        Status::Found => Outcome::Done,
    })
}

/// Names with their standard deviations.
fn sigmas(session: &Session, given: &[String]) -> Result<Vec<(String, f64)>, Outcome> {
    let of = |text: &String| {
        let (name, sigma) = text.split_once('=')?;
        Some((name.trim().to_owned(), sigma.trim().parse::<f64>().ok()?))
    };
    given
        .iter()
        .map(|text| {
            of(text).ok_or_else(|| {
                session.misunderstood(&format!(
                    "`--sigma {text}`: write a name and a number, like `--sigma toe=0.02`"
                ))
            })
        })
        .collect()
}

/// `NAME=SIGMA`, in the unit of the variable.
fn prior(session: &Session, file: &ModelFile, text: &str) -> Result<(VariableId, f64), Outcome> {
    let Some((name, sigma)) = text.split_once('=') else {
        return Err(session
            .misunderstood(&format!("`--prior {text}`: write it as `NAME=SIGMA`, like `--prior rod=0.5`")));
    };
    let variable = variable(&file.model, name.trim()).map_err(|error| session.refused(file, &error))?;
    let Some(sigma) = sigma.trim().parse().ok().filter(|sigma: &f64| sigma.is_finite()) else {
        return Err(session.misunderstood(&format!(
            "`--prior {text}`: the standard deviation is a number without a unit, in that of the variable"
        )));
    };
    Ok((variable, file.units.to_si(file.model.variables[variable.0].quantity, sigma)))
}

/// Fits the design and reports every iteration.
fn search(session: &Session, file: &ModelFile, request: &Request<'_>) -> Result<Calibration, Outcome> {
    session.line(&text::bold(&file.model.name));
    let mut progress = |Progress { step, done, .. }: Progress<'_>| {
        if let Step::Fit(objective) = step {
            session.line(&format!("{done:>4}  objective {}", number(objective)));
        }
        session.go_on()
    };
    let more = || session.go_on().is_continue();
    let control = Control { threads: NonZero::<usize>::MIN, progress: &mut progress, more: &more };
    calibrate(&file.model, request, control).map_err(|error| match error {
        Error::Topology(fault) => session.cannot_be_driven(file, &fault),
        Error::Request(error) => session.refused(file, &error),
    })
}

impl LossKind {
    fn of(self) -> Loss {
        match self {
            Self::Squares => Loss::Squares,
            Self::Huber => Loss::Huber,
            Self::Cauchy => Loss::Cauchy,
        }
    }
}

/// Results to write.
struct Results<'a> {
    calibrated: CalibrationInputs<'a>,
    options: &'a Calibrate,
}

impl Results<'_> {
    /// Writes tables, the page, and the summary last.
    fn write(&self, folder: &mut Folder, facts: &mut CalibrateFacts) -> Result<(), WriteError> {
        let of = &self.calibrated;
        folder.write("residuals.csv", |out| Ok(of.write_residuals(out)?))?;
        folder.write("covariance.csv", |out| Ok(of.write_covariance(out)?))?;
        let mut names = vec!["residuals.csv", "covariance.csv"];
        if let Some(html) = self.page(facts) {
            folder.write("report.html", |out| out.write_all(html.as_bytes()))?;
            names.push("report.html");
        }
        names.push("summary.json");
        facts.files.extend(names.iter().map(|name| folder.path_of(name).display().to_string()));
        let json = json_text(facts);
        folder.write("summary.json", |out| out.write_all(json.as_bytes()))
    }

    /// Page of the model's first motion with the nominal and the fitted design; `None` if no position could be solved.
    fn page(&self, facts: &CalibrateFacts) -> Option<String> {
        let model = self.calibrated.file.model.motions().into_iter().next()?;
        let analysis = Analysis::with(&model, self.options.common.formulation()).ok()?;
        let design = &self.calibrated.found.design;
        let found = FoundDesign { design, note: "The design fitted to the measured data." };
        let finish = |page, today: &Solution| facts.page(&self.calibrated, page, &today.measured.outputs);
        page(self.calibrated.file, &analysis, Some(&found), finish)
    }
}
