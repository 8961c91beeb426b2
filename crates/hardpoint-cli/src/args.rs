//! Arguments of the command `hardpoint`.

use std::num::NonZero;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use hardpoint::space::Angles;
use hardpoint::study::DifferenceScheme;
use hardpoint::topology::Formulation;

/// Maximum number of designs are drawn from tolerances, and swept over.
pub const MOST_DRAWN: u32 = 10_000_000;
pub const MOST_SWEPT: u32 = 1_000_000_000;

const AFTER: &str = "\
Examples:
  hardpoint new strut --template macpherson
  hardpoint check models/macpherson.toml
  hardpoint import four_bar.asmt -o four_bar.toml
  hardpoint run models/macpherson.toml -o results/macpherson
  hardpoint verify models/macpherson.toml --sweep
  hardpoint whatif models/macpherson.toml --set tie_rod_outer.z=+2mm --measure toe
  hardpoint optimize models/four_bar_inverse.toml --save found.toml
  hardpoint tolerance models/studies/strut_tolerances.toml -o results/strut
  hardpoint calibrate models/studies/strut_calibrate.toml models/studies/strut_measured.csv
  hardpoint sweep models/studies/strut_sweep.toml -o results/sweep
  hardpoint studio models/macpherson.toml
  hardpoint site public

Exit codes:
    0  done; for verify: every variable passed
    1  verify: a sensitivity and its re-solved designs disagree;
       optimize: the search ended short of an optimum, or limits are not kept
    2  the command line cannot be understood
    3  the model file cannot be read, or has errors
    4  the mechanism cannot be driven as it is written
    5  the mechanism does not assemble, or its motion ends early (limit position, dead point, lock);
       run writes the part that was solved
    6  a result could not be written, to a file or to stdout
  130  interrupted; run writes the part that was solved, unless it was writing already;
       studio ends with 0 then, as it is meant to

A closed pipe (as by `| head`) is no failure to write.

Results go to stdout, everything else to stderr. With --json, stdout carries
exactly one JSON document, also where there is no result (except after code 2):
then its \"status\" is \"error\" and its \"diagnostics\" say why.";

/// Motion and exact design sensitivities of mechanisms.
#[derive(Debug, Parser)]
#[command(name = "hardpoint", version, after_help = AFTER, max_term_width = 110)]
pub struct Arguments {
    /// Subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Begin a model from a template that runs at once, with your own hardpoints if you have them in a table
    New(New),
    /// Solve the motion and its sensitivities; write CSV files, a summary and a report
    Run(Run),
    /// Examine a model: mobility, loops, redundancy, margins, and whether its design variables can be followed
    Check(Check),
    /// Write a model as a file of another program, and say what that does not support
    Export(Export),
    /// Make a model file of a mechanism of another program, and check it
    Import(Import),
    /// Compare the sensitivities with re-solved designs
    Verify(Verify),
    /// Change the design: today's curves, predicted ones and exact ones; and which variable moves which measure most
    Whatif(Whatif),
    /// Set two model files beside each other: what differs, and what that does to measures and metrics
    Compare(Compare),
    /// Search for the design that serves the goals of the model file best, within its bounds and limits
    Optimize(Optimize),
    /// Analyse how tolerances of the design variables affect the results: spread, yield, contributions, loosest
    /// tolerances
    Tolerance(Tolerance),
    /// Find the design that explains what was measured, how well it is known, and what to measure next
    Calibrate(Calibrate),
    /// Solve many designs over the ranges of the design variables, exactly: a table of their metrics, what is best,
    /// what matters
    Sweep(Sweep),
    /// Open a model in the browser, from a server on this machine: save in place, follow the file, run long studies
    Studio(Studio),
    /// Write the gallery as a static site: a page for each model
    Site(Site),
    /// Print the JSON Schema of model files, for editors
    #[command(after_help = "Example:\n  hardpoint schema > hardpoint.schema.json")]
    Schema,
    /// Print completions for a shell
    #[command(
        after_help = "Example:\n  hardpoint completions bash > ~/.local/share/bash-completion/completions/hardpoint"
    )]
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// Arguments of all analyses.
#[derive(Args, Debug, Default)]
pub struct Common {
    /// The model file (TOML)
    pub model: PathBuf,
    /// Solve in absolute coordinates: six for every body, every joint cut
    #[arg(long)]
    absolute: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// Selection of the motions of a model file.
#[derive(Args, Debug, Default)]
pub struct Motions {
    /// Do one case of the model file only [default: all of them]
    #[arg(long, value_name = "NAME")]
    pub case: Option<String>,
}

impl Common {
    /// The coordinates requested.
    pub fn formulation(&self) -> Formulation {
        if self.absolute { Formulation::Absolute } else { Formulation::Relative }
    }
}

const AFTER_NEW: &str = "\
The file is a commented model with cases, measures, targets and variables. Nothing that is
there already is overwritten.

A table of hardpoints has a name, x, y and z on each line; its first line may name these
columns. Its names are those of the template, capitals and hyphens or not. All coordinates
are in one unit, and the directions of its axes are said as

  iso      x forward, y left, z up (ISO 8855)
  sae      x forward, y right, z down (SAE J670)
  adams    x back, y right, z up
  lotus    x back, y right, z up
  or in words, like \"x back, z up, y right\"

Examples:
  hardpoint new --list
  hardpoint new front --template double-wishbone
  hardpoint new front --template macpherson --hardpoints points.csv --units mm --axes sae
  hardpoint new rear -t five-link --hardpoints points.xlsx --units in --axes \"x back, y right, z up\"";

/// Options of `new`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_NEW)]
pub struct New {
    /// The name of the model, and of its file unless that ends with `.toml`
    #[arg(value_name = "NAME", required_unless_present = "list")]
    pub name: Option<PathBuf>,
    /// Template to start from; without it, the command asks on a terminal
    #[arg(short, long, value_name = "TEMPLATE")]
    pub template: Option<String>,
    /// List the templates
    #[arg(long)]
    pub list: bool,
    /// A table with the places of the hardpoints: CSV or .xlsx
    #[arg(long, value_name = "FILE")]
    pub hardpoints: Option<PathBuf>,
    /// The unit of the table: mm, cm, m or in
    #[arg(long, value_name = "UNIT", requires = "hardpoints")]
    pub units: Option<String>,
    /// The axes of the table, by name or in words
    #[arg(long, value_name = "AXES", requires = "hardpoints")]
    pub axes: Option<String>,
}

const AFTER_RUN: &str = "\
Writes into the folder, each file whole or not at all:
  report.html      the motion in 3D, curves, sensitivities and checks; opens from disk
  motion.csv       position, velocity and acceleration of bodies, points and measures
                   (of bodies where there are 100 of them at most)
  sensitivity.csv  derivatives of measures and points by every design variable
                   (of bodies where the model has neither, and is small)
  summary.json     the model, how the run went, the largest sensitivities
and if requested
  motion.xlsx      an Excel workbook with charts (--workbook)
  report.pdf       facts, key figures, curves and rankings on paper (--pdf)
  motion.glb       the motion as animated glTF (--gltf)
  jerk.csv         third time derivatives (--jerk)
Of a model with cases, each case gets a folder of its own there, and summary.json says how
each of them went. What is in which column: docs/results.md. Files of an earlier run that this one
does not write are removed. Ctrl-C while it solves writes the part that was solved;
while it writes, the files of the earlier run stay.

Examples:
  hardpoint run models/slider_crank.toml
  hardpoint run models/macpherson.toml -o results/baseline --bodies
  hardpoint run models/macpherson.toml --format parquet
  hardpoint run models/double_wishbone.toml --workbook --gltf
  hardpoint run models/studies/strut_toe.toml --case bump
  hardpoint run models/macpherson.toml --json | jq '.sensitivities[0]'";

/// Format of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Text: motion.csv and sensitivity.csv
    Csv,
    /// NumPy arrays, less than half as large: motion.npy and sensitivity.npy, with columns.json to name their columns
    Npy,
    /// Apache Parquet: motion.parquet and sensitivity.parquet, with units in the names of the columns and in the
    /// metadata
    Parquet,
}

impl Format {
    /// Ending of the file names.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Npy => "npy",
            Self::Parquet => "parquet",
        }
    }
}

/// Three angles that say how a body is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Orientation {
    /// The 3-1-3 Euler angles
    Euler,
    /// Cardan angles: about x, the new y, the new z
    Cardan,
    /// Roll, pitch and yaw
    RollPitchYaw,
}

impl Orientation {
    /// The same for the core.
    pub fn angles(self) -> Angles {
        match self {
            Self::Euler => Angles::Euler,
            Self::Cardan => Angles::Cardan,
            Self::RollPitchYaw => Angles::RollPitchYaw,
        }
    }
}

/// `hardpoint run`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_RUN)]
pub struct Run {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// The folder for the results [default: results/NAME for NAME.toml]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Do not re-solve moved designs for the report to compare with
    #[arg(long)]
    pub no_compare: bool,
    /// Write the third time derivatives of all bodies too, as jerk.csv
    #[arg(long)]
    pub jerk: bool,
    /// Write an Excel workbook too, motion.xlsx: variables, measures over time with charts, sensitivities
    #[arg(long)]
    pub workbook: bool,
    /// Write the run as pages to print too, report.pdf: facts, key figures, curves, what moves them
    #[arg(long)]
    pub pdf: bool,
    /// Write an animated glTF too, motion.glb, for Blender and other viewers
    #[arg(long)]
    pub gltf: bool,
    /// Write three angles of every body into the motion too, beside its quaternion: euler (3-1-3), cardan or
    /// roll_pitch_yaw
    #[arg(long, value_enum, hide_possible_values = true)]
    pub angles: Option<Orientation>,
    /// Write motion and sensitivities of all bodies, however many there are
    #[arg(long)]
    pub bodies: bool,
    /// Solve the motion only
    #[arg(long)]
    pub no_sensitivities: bool,
    /// Write motion and sensitivities as text (csv), or half as large as NumPy arrays with columns.json (npy), or as
    /// Apache Parquet with units in its metadata (parquet)
    #[arg(long, value_enum, default_value_t = Format::Csv, hide_possible_values = true)]
    pub format: Format,
}

const AFTER_CHECK: &str = "\
A design variable gets one of three answers:
  admissible     every joint stays closed with all bodies where they are
  re-assembled   joints open, and the mechanism closes them again by moving
  cannot follow  no motion closes them: there is no sensitivity by this variable

Example:
  hardpoint check models/double_wishbone.toml";

/// `hardpoint check`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_CHECK)]
pub struct Check {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
}

const AFTER_VERIFY: &str = "\
Every design variable is moved by +h and -h, both designs are solved, and their
difference quotient is compared with the sensitivity, over all times. As h falls
the deviation falls with its square, then rises by round-off; every quantity
(a body's acceleration, a measure's rate) is judged at its own best step, and a
variable passes if all of them agree to 1e-6 there.

Forward and backward differences move the design to one side only, for variables
that cannot go to the other. Their deviation falls with h itself, so that they
reach 1.5e-8 at best instead of 4e-11, and must agree to 4e-4.

Examples:
  hardpoint verify models/slider_crank.toml
  hardpoint verify models/macpherson.toml --sweep -o results/macpherson
  hardpoint verify models/macpherson.toml --differences backward --sweep";

/// `hardpoint verify`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_VERIFY)]
pub struct Verify {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Also show the deviation at every step
    #[arg(long)]
    pub sweep: bool,
    /// The designs to compare: at +h and -h, at +h and 0, or at 0 and -h
    #[arg(long, value_name = "SCHEME", value_enum, default_value_t = Differences::Central)]
    pub differences: Differences,
    /// Steps to try, as parts of the change that moves a joint by the mechanism's size or turns it by 1 rad
    /// [default: half decades from 1e-2 to 1e-6, for one-sided differences to 1e-9]
    #[arg(long, value_name = "PARTS", value_delimiter = ',', value_parser = step)]
    pub steps: Option<Vec<f64>>,
    /// Write verify.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Designs that `verify` compares.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Differences {
    Central,
    Forward,
    Backward,
}

impl Differences {
    /// The same for the core.
    pub fn scheme(self) -> DifferenceScheme {
        match self {
            Self::Central => DifferenceScheme::Central,
            Self::Forward => DifferenceScheme::Forward,
            Self::Backward => DifferenceScheme::Backward,
        }
    }
}

const AFTER_WHATIF: &str = "\
Without --set: ranks all variables of the model, and all coordinates of its
hardpoints, by how much they move each measure. With --set: the design is
changed, and today's curves stand beside
  1st order     predicted from today's exact sensitivities
  2nd order     and from their exact derivative along the change
  exact         the changed design, solved again
so that the predictions' errors can be read.

NAME is a design variable of the file, a hardpoint's coordinate (tie_rod_outer.z)
or a joint's tilt about a global axis (lca_pivot.tilt_y). The value is a change,
in mm, cm, m, in, deg or rad, or in the unit of the file where none is given.

Examples:
  hardpoint whatif models/macpherson.toml --measure toe
  hardpoint whatif models/macpherson.toml --set tie_rod_outer.z=+2mm --set lca_pivot.tilt_y=0.5deg
  hardpoint whatif models/macpherson.toml --set tie_rod_inner.z=-3mm --measure toe --over wheel_travel -o results/higher_rack
  hardpoint whatif models/macpherson.toml --set tie_rod_outer.z=+2mm --save strut_2.toml";

/// `hardpoint whatif`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_WHATIF)]
pub struct Whatif {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// A change of the design; may be given several times
    #[arg(long, value_name = "NAME=CHANGE")]
    pub set: Vec<String>,
    /// Make the nearest change that keeps all joints closed, where the one requested does not
    #[arg(long, requires = "set")]
    pub admissible: bool,
    /// Show this measure only; may be given several times
    #[arg(long, value_name = "NAME")]
    pub measure: Vec<String>,
    /// Draw the curves over this measure instead of time
    #[arg(long, value_name = "NAME")]
    pub over: Option<String>,
    /// Write whatif.html, whatif.csv and whatif.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write the model file with the changed design, its comments and layout kept
    #[arg(long, value_name = "FILE", requires = "set")]
    pub save: Option<PathBuf>,
}

const AFTER_COMPARE: &str = "\
Both are solved at the output times of the first. What differs is reported in its
units: hardpoints, parameters, metrics, the curves of measures, and what only
one of them has. Cases are compared with those of the same name.

With --output it writes into the folder:
  compare.html  the first design with the second beside it, where both have the same bodies and measures
  compare.csv   the curves of both
  compare.json  all that is printed

Examples:
  hardpoint compare models/macpherson.toml strut_2.toml
  hardpoint compare models/studies/strut_toe.toml found.toml --case bump --measure toe -o results/found";

/// `hardpoint compare`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_COMPARE)]
pub struct Compare {
    #[command(flatten)]
    pub common: Common,
    /// The model file to compare with
    pub other: PathBuf,
    #[command(flatten)]
    pub motions: Motions,
    /// Show this measure only; may be given several times
    #[arg(long, value_name = "NAME")]
    pub measure: Vec<String>,
    /// Write compare.html, compare.csv and compare.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

const AFTER_OPTIMIZE: &str = "\
The model file says what is wanted: `[optimize.goals]` names metrics that are to
be small or to meet a target, `[optimize.limits]` what must hold, and every
variable that may change has `bounds` (docs/file-format.md). Every iteration is a
line: the objective, whether limits are kept, and the variable that moved most.
A design whose motion does not assemble, locks or reaches a dead point is a step
that is not taken. Ctrl-C ends the search with the best design so far.

With --output it writes into the folder:
  report.html   the design found beside the one in the design configuration (report-CASE.html for each case)
  summary.json  all that is printed, with every variable's start and end

Examples:
  hardpoint optimize models/four_bar_inverse.toml
  hardpoint optimize models/four_bar_inverse.toml --starts 100 --json | jq '.starts[].status'
  hardpoint optimize models/four_bar_inverse.toml -o results/found --save found.toml";

/// `hardpoint optimize`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_OPTIMIZE)]
pub struct Optimize {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Write a report and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write the model file with the design found, its comments and layout kept
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    /// Start from that many designs, the one in the design configuration and others spread within the bounds [default:
    /// as the file says, or 1]
    #[arg(long, value_name = "N")]
    pub starts: Option<NonZero<usize>>,
    /// End a search after that many iterations [default: as the file says, or 100]
    #[arg(long, value_name = "N")]
    pub iterations: Option<NonZero<usize>>,
    /// Search from several starts on that many threads; what is found does not depend on it [default: one for each
    /// core]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZero<usize>>,
}

const AFTER_EXPORT: &str = "\
The ending of the file indicates the format; `--list` names the formats. What a format cannot
say, as motions in URDF, is named; the file is written all the same (docs/import.md).
The motion itself is written by `hardpoint run`.

Examples:
  hardpoint export models/four_bar.toml -o four_bar.urdf
  hardpoint export models/double_wishbone.toml -o hardpoints.csv
  hardpoint export models/double_wishbone.toml -o skeleton.dxf
  hardpoint export models/double_wishbone.toml -o front.sub --json | jq '.unsaid[]'
  hardpoint export --list";

/// `hardpoint export`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_EXPORT)]
pub struct Export {
    /// The model file (TOML)
    #[arg(required_unless_present = "list")]
    pub model: Option<PathBuf>,
    /// Write this file
    #[arg(short, long, value_name = "FILE", required_unless_present = "list")]
    pub output: Option<PathBuf>,
    /// Write it as this format [default: as its ending indicates]
    #[arg(long, value_name = "NAME")]
    pub format: Option<String>,
    /// List the formats
    #[arg(long, conflicts_with_all = ["model", "output", "format"])]
    pub list: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

const AFTER_IMPORT: &str = "\
The format shows in the file; `--list` names the formats. Names of bodies and joints are
kept. What nothing drives in the source gets a driver that holds it in the design configuration; where that
is the only freedom, it swings. Shapes are written beside the model, as FILE_meshes/BODY.stl.
The report says what was taken, approximated and refused, with the place in the source
(docs/import.md). Then the model is checked as by `hardpoint check`, whose exit codes
these are; 3 also where the source has errors, and then no model is written.

Examples:
  hardpoint import four_bar.asmt -o four_bar.toml
  hardpoint import suspension.adm -o suspension.toml
  hardpoint import robot.xml --format mjcf -o robot.toml --json | jq '.report.entries[]'
  hardpoint import --list";

/// `hardpoint import`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_IMPORT)]
pub struct Import {
    /// The other program's file
    #[arg(value_name = "FILE", required_unless_present = "list")]
    pub source: Option<PathBuf>,
    /// Write the model into this file
    #[arg(short, long, value_name = "MODEL.toml", required_unless_present = "list")]
    pub output: Option<PathBuf>,
    /// Read it as this format [default: as it shows]
    #[arg(long, value_name = "NAME")]
    pub format: Option<String>,
    /// Close a loop of a robot where its frames A and B meet [joint: a ball joint, or as in `A=B:revolute:x`]
    #[arg(long, value_name = "A=B")]
    pub close: Vec<String>,
    /// List the formats
    #[arg(long, conflicts_with_all = ["source", "output", "format", "close"])]
    pub list: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

const AFTER_TOLERANCE: &str = "\
Design variables have a `tolerance` in the model file, or one in
`[tolerance.variables]`; `[tolerance]` says how they scatter, which go together
and what must hold (docs/tolerance.md). From exact derivatives: worst case, root
of the sum of squares (RSS), mean and standard deviation to second order, what
each variable contributes, yield. Beside it designs are drawn and solved exactly.
Where second derivatives say that the linear answer is off, the result says so.
Ctrl-C keeps what was drawn.

With --output it writes into the folder:
  report.html        bands over the curves (report-CASE.html for each case)
  metrics.csv        a row for each metric
  contributions.csv  what each variable contributes to each metric
  bands.csv          mean, standard deviation and worst case along every curve
  samples.csv        the designs drawn: deviations and metrics
  summary.json       all that is printed

Examples:
  hardpoint tolerance models/studies/strut_tolerances.toml
  hardpoint tolerance models/studies/strut_tolerances.toml --samples 100000 -o results/strut
  hardpoint tolerance models/studies/strut_tolerances.toml --case bump --json | jq '.metrics[].rss'";

/// `hardpoint tolerance`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_TOLERANCE)]
pub struct Tolerance {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Write a report, tables and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Draw that many designs and solve them exactly, 0 for none [default: as the file says, or 10000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(MOST_DRAWN)))]
    pub samples: Option<u32>,
    /// Draw them from this number [default: as the file says, or 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// Seek the loosest tolerances that keep the limits, by the root of the sum of squares (rss) or at worst
    /// (worst-case)
    #[arg(long, value_enum, value_name = "RULE")]
    pub allocate: Option<Allocate>,
    /// Solve designs on that many threads; what is found does not depend on it [default: one for each core]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZero<usize>>,
}

const AFTER_CALIBRATE: &str = "\
The measured file is a CSV table. Its first line names drivers, what was measured
(measures, and points as P.x) and, for each, how exactly (`sigma toe`); each line below
is a posture, in the units of the model file. Empty cells were not measured; a name that
begins with # leaves its column out. Drivers count as their laws do; those that the table
does not name stood in the design configuration. Readings of one kind may go without standard deviations:
then these come from the residuals (docs/calibration.md).

With --output it writes into the folder:
  residuals.csv    a row for each reading: measured, in the design configuration, found, the difference
  covariance.csv   the covariance of the variables
  report.html      the mechanism in the design configuration and as found, residuals as points
  summary.json     all that is printed

Examples:
  hardpoint calibrate models/studies/strut_calibrate.toml models/studies/strut_measured.csv -o results/strut
  hardpoint calibrate models/five_link.toml measured.csv --sigma toe=0.02 --sigma camber=0.02 --loss huber
  hardpoint calibrate models/stewart.toml poses.csv --variable base_1_x --variable base_1_y --save as_built.toml";

/// `hardpoint calibrate`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_CALIBRATE)]
pub struct Calibrate {
    #[command(flatten)]
    pub common: Common,
    /// Measured data: a CSV table of readings in postures of the drivers
    #[arg(value_name = "MEASURED.csv")]
    pub measured: PathBuf,
    /// Write tables, a report and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Seek this design variable; may be given several times [default: all]
    #[arg(long, value_name = "NAME")]
    pub variable: Vec<String>,
    /// Standard deviation of readings whose cells have none, in their unit; may be given several times
    #[arg(long, value_name = "NAME=SIGMA")]
    pub sigma: Vec<String>,
    /// Loss function of residuals far from the others
    #[arg(long, value_enum, default_value_t = LossKind::Squares)]
    pub loss: LossKind,
    /// End after that many iterations
    #[arg(long, value_name = "N", default_value = "100")]
    pub iterations: NonZero<usize>,
    /// Write the model with the design found into this file, with its comments and layout
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
}

/// Loss function of a residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LossKind {
    /// Square: best where errors are normal
    Squares,
    /// Less than its square beyond 1.345 standard deviations: where some readings are off
    Huber,
    /// Next to nothing far out: where some readings are wrong
    Cauchy,
}

const AFTER_SWEEP: &str = "\
Variables that have `bounds` in the model file are swept within them, or those of
`[sweep.variables]` within the ranges there; `--range` gives others. Ranges are in the
units of the file: of a parameter its values, of all others changes (docs/sweep.md).
A design that does not assemble, locks or reaches a dead point keeps its row, with
the reason.

With --output it writes into the folder:
  designs.csv   a row for each design: its variables and metrics (or designs.parquet)
  curves.csv    a row for each output time of each design, with --curves (or curves.parquet)
  report.html   how metrics go with variables (report-CASE.html for each case)
  summary.json  all that is printed
A sweep that is interrupted or killed leaves sweep.partial there: the same command
goes on where it ended, and the files are the same to the last byte.

Examples:
  hardpoint sweep models/studies/strut_sweep.toml -o results/sweep
  hardpoint sweep models/studies/strut_sweep.toml --method indices --samples 2000
  hardpoint sweep models/macpherson.toml --range B_z=-5..5 --range D_z=-3..3 --method factorial --levels 11
  hardpoint sweep models/studies/strut_sweep.toml --designs mine.csv --curves toe --format parquet -o results/mine";

/// `hardpoint sweep`.
#[derive(Args, Debug, Default)]
#[command(after_help = AFTER_SWEEP)]
pub struct Sweep {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Write tables, a report and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Method that chooses the designs within the ranges [default: that of the file, or sobol]
    #[arg(long, value_enum)]
    pub method: Option<Method>,
    /// Choose that many designs; with indices that many pairs of them [default: as the file says, or 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SWEPT)))]
    pub samples: Option<u32>,
    /// Choose them from this number [default: as the file says, or 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// In a factorial, that many values of every variable [default: as the file says, or 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub levels: Option<u32>,
    /// Solve the designs of a CSV file, whose first line names design variables
    #[arg(long, value_name = "FILE", conflicts_with_all = ["method", "samples", "seed", "levels", "range"])]
    pub designs: Option<PathBuf>,
    /// Sweep this variable from here to there; may be given several times
    #[arg(long, value_name = "NAME=FROM..TO", allow_hyphen_values = true)]
    pub range: Vec<String>,
    /// Keep the curve of this measure too; may be given several times
    #[arg(long, value_name = "NAME")]
    pub curves: Vec<String>,
    /// Write tables as text, or as Parquet
    #[arg(long, value_enum, default_value_t = TableForm::Csv)]
    pub format: TableForm,
    /// Solve designs on that many threads; what is found does not depend on it [default: one for each core]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZero<usize>>,
    /// Begin anew where the folder holds a sweep that has not ended
    #[arg(long)]
    pub restart: bool,
}

const AFTER_STUDIO: &str = "\
The page is the one that `run` writes. The server adds what a page cannot do: it
saves the model in place, indicates the page when the file changes on disk, opens other
models of the folder, and runs long studies natively. It listens on this machine
only, and answers who has the token of the address that it prints. Ctrl-C ends it.

Without a model it shows all models of the current folder, or of `models` in it.
With --port and --token a server that is started anew is found by its pages again.

Examples:
  hardpoint studio models/macpherson.toml
  hardpoint studio
  hardpoint studio models/macpherson.toml --no-browser --port 4711 --token my-own-long-token";

/// `hardpoint studio`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_STUDIO)]
pub struct Studio {
    /// The model file (TOML), or a folder of them
    pub model: Option<PathBuf>,
    /// Listen on this port [default: one that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Let in who has this token: at least 16 letters, digits, - and _ [default: a random one]
    #[arg(long, value_name = "TOKEN", value_parser = crate::studio::given_token)]
    pub token: Option<String>,
    /// Print the address and open no browser
    #[arg(long)]
    pub no_browser: bool,
}

const AFTER_SITE: &str = "\
Writes into the folder, each file whole or not at all:
  index.html  all models, with what they say about themselves
  NAME.html   the report of NAME.toml (NAME-CASE.html for each further case)
Any static host serves it, and it opens from disk. A model that cannot be shown is left
out, with the reason.

Examples:
  hardpoint site public
  hardpoint site public models/macpherson.toml models/five_link.toml";

/// `hardpoint site`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_SITE)]
pub struct Site {
    /// The folder for the site
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// The model files [default: models/*.toml]
    pub models: Vec<PathBuf>,
}

/// Method that chooses the designs.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Method {
    /// Every combination of evenly spaced values
    Factorial,
    /// At random, one in each slice of every range
    LatinHypercube,
    /// Evenly, however many there are
    Sobol,
    /// As Sobol's indices of sensitivity need them: for v variables, (v + 2) times as many designs as samples
    Indices,
}

/// Format of the tables of a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum TableForm {
    /// Text
    #[default]
    Csv,
    /// Apache Parquet
    Parquet,
}

/// By which rule tolerances are sought.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Allocate {
    Rss,
    WorstCase,
}

fn step(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(step) if step > 0.0 && step < 1.0 => Ok(step),
        _ => Err("a step is a number between 0 and 1".into()),
    }
}
