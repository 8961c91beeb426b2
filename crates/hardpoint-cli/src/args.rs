//! Arguments of the command `hardpoint`.

use std::num::NonZero;
use std::path::PathBuf;

use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use hardpoint::model::{AllocationRule, OptimizationSettings, SweepSettings, ToleranceSettings};
use hardpoint::space::Angles;
use hardpoint::topology::Formulation;
use hardpoint_export::PdfPart;
use hardpoint_study::difference::DifferenceScheme;
use serde::Deserialize;

const AFTER: &str = "\
Examples:
  hardpoint new strut --template macpherson
  hardpoint synthesize models/tasks/tailgate.toml -o results/tailgate
  hardpoint check models/macpherson.toml
  hardpoint import four_bar.asmt -o four_bar.toml
  hardpoint run models/macpherson.toml -o results/macpherson
  hardpoint verify models/macpherson.toml --sweep
  hardpoint clearance models/studies/knee.toml
  hardpoint whatif models/macpherson.toml --set tie_rod_outer.z=+2mm \\
      --measure toe
  hardpoint optimize models/four_bar_inverse.toml --save found.toml
  hardpoint tolerance models/studies/strut_tolerances.toml -o results/strut
  hardpoint calibrate models/studies/strut_calibrate.toml \\
      models/studies/strut_measured.csv
  hardpoint sweep models/studies/strut_sweep.toml -o results/sweep
  hardpoint studio models/macpherson.toml
  hardpoint site public

Exit codes:
    0  done; for verify: every variable passed
    1  verify: a sensitivity and its re-solved designs disagree;
       clearance: shapes are nearer than required;
       envelope: the permitted error is not reached;
       map: no error is proved, or the table would be too large;
       optimize, trade-off, calibrate: the search did not converge, or limits are violated;
       synthesize: no linkage fulfils the task
    2  invalid command line
    3  the model file cannot be read, or has errors
    4  the mechanism cannot be driven
    5  the mechanism does not assemble, or its motion ends early (limit position, dead point, lock);
       run writes the part that was solved
    6  a result could not be written, to a file or to stdout
  130  interrupted; run writes the part that was solved, unless it was writing already;
       studio ends with 0

A closed pipe (such as `| head`) is not an error.

Results go to stdout, everything else to stderr. With --json, stdout carries
exactly one JSON document, except after code 2. Without a result its \"status\" is
\"error\", and its \"diagnostics\" have the reasons.";

/// Solve driven mechanisms: exact motion, and its exact sensitivities to the design.
#[derive(Debug, Parser)]
#[command(name = "hardpoint", version, after_help = AFTER, max_term_width = 110)]
pub struct Arguments {
    /// Subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// Subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Create a model from a template, with your own hardpoints if you have a table of them
    New(New),
    /// Find linkages for poses of a body or points of a path, and write a model of each
    Synthesize(Synthesize),
    /// Solve the motion and its sensitivities; write tables, a summary and an interactive report
    Run(Run),
    /// Check a model: mobility, loops, redundant constraints, margins, admissibility of the design variables
    Check(Check),
    /// Find the least distances of shapes over the motion, when they touch, and how both change with the design
    Clearance(Clearance),
    /// Compute the space that a shape sweeps over the motion, as a closed surface (STL)
    Envelope(Envelope),
    /// Tabulate measures over one to three drivers, with a proved error of the interpolation
    Map(Map),
    /// Export a model to a file of another program, and list its unsupported features
    Export(Export),
    /// Import a mechanism of another program as a model file, and check it
    Import(Import),
    /// Verify the sensitivities against re-solved designs
    Verify(Verify),
    /// Change the design: nominal, predicted and exact curves, and the most influential variables of each measure
    Whatif(Whatif),
    /// Compare two model files: differences of the models, measures and metrics
    Compare(Compare),
    /// Optimise the design for the goals in the model file, within its bounds and limits
    Optimize(Optimize),
    /// Trade two or three goals against each other: the designs that are the best compromises, and what one goal costs
    /// in the others
    TradeOff(TradeOff),
    /// Analyse how tolerances of the design variables affect the results: spread, yield, contributions, loosest
    /// tolerances
    Tolerance(Tolerance),
    /// Fit the design to measured data, with standard deviations and readings to add
    Calibrate(Calibrate),
    /// Sweep over the ranges of the design variables: exact metrics of many designs, the best ones, and the
    /// influence of each variable
    Sweep(Sweep),
    /// Open a model in the browser from a local server: save in place, follow the file, run long studies
    Studio(Studio),
    /// Write all models as a static site: a gallery, and a page for each model
    Site(Site),
    /// Serve agents over the Model Context Protocol: check, run, change and optimise models
    #[command(after_help = AFTER_MCP)]
    Mcp,
    /// Serve editors over the language server protocol: diagnostics, completion, references, renaming
    #[command(after_help = AFTER_LSP)]
    Lsp(Lsp),
    /// Print the JSON Schema of model files, for completion in editors
    #[command(after_help = "Example:\n  hardpoint schema > hardpoint.schema.json")]
    Schema,
    /// Print completions for a shell
    #[command(after_help = "Example:\n  hardpoint completions bash \\
      > ~/.local/share/bash-completion/completions/hardpoint")]
    Completions {
        /// The shell
        shell: Shell,
    },
}

const AFTER_MCP: &str = "\
Reads one JSON-RPC message per line from stdin and writes its answers to stdout; everything
else goes to stderr. Clients start it themselves. Tools: check, run, what_if, optimize,
tolerance, sweep, synthesize, explain, new_model, import_model. Resources: the documents, the
JSON Schema of models, the templates (docs/agents.md).

Configuration of a client:
  { \"mcpServers\": { \"hardpoint\": { \"command\": \"hardpoint\", \"args\": [\"mcp\"] } } }

Example:
  echo '{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"ping\"}' | hardpoint mcp";

const AFTER_LSP: &str = "\
Speaks the language server protocol on stdin and stdout; editors start it themselves
(docs/editors.md has configurations of VS Code, Neovim and Helix). It checks a model while you
write, completes keys, names and words, shows the meaning of keys and the values of
entries, finds references, and renames entries at all their places.

Example, for Neovim 0.11 or later:
  vim.lsp.config('hardpoint',
      { cmd = { 'hardpoint', 'lsp' }, filetypes = { 'toml' } })
  vim.lsp.enable('hardpoint')";

/// `hardpoint lsp`.
#[derive(Args, Debug)]
pub struct Lsp {
    /// Communicate on stdin and stdout, which is the only way; editors add this option
    #[arg(long, hide = true)]
    pub stdio: bool,
}

/// Arguments of all analyses.
#[derive(Args, Debug, Default)]
pub struct Common {
    /// The model file (TOML)
    pub model: PathBuf,
    /// Solve in absolute coordinates: six per body, every joint cut
    #[arg(long)]
    pub absolute: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// Selection of the motions of a model file.
#[derive(Args, Debug, Default)]
pub struct Motions {
    /// Solve this case of the model file only [default: all cases]
    #[arg(long, value_name = "NAME")]
    pub case: Option<String>,
}

impl Common {
    /// Requested coordinates.
    pub fn formulation(&self) -> Formulation {
        if self.absolute { Formulation::Absolute } else { Formulation::Relative }
    }
}

const AFTER_NEW: &str = "\
Writes a commented model with cases, measures, targets and variables. Existing files are
not overwritten.

A table of hardpoints has a name, x, y and z on each line; its first line may name these
columns. Its names are those of the template; case and hyphens do not matter. All coordinates
are in one unit, and the axes are one of

  iso      x forward, y left, z up (ISO 8855)
  sae      x forward, y right, z down (SAE J670)
  adams    x back, y right, z up
  lotus    x back, y right, z up
  or in words, like \"x back, z up, y right\"

Examples:
  hardpoint new --list
  hardpoint new front --template double-wishbone
  hardpoint new front --template macpherson --hardpoints points.csv \\
      --units mm --axes sae
  hardpoint new rear -t five-link --hardpoints points.xlsx --units in \\
      --axes \"x back, y right, z up\"";

/// Options of `new`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_NEW)]
pub struct New {
    /// Name of the model, and of its file unless it ends with `.toml`
    #[arg(value_name = "NAME", required_unless_present = "list")]
    pub name: Option<PathBuf>,
    /// Template to start from; without it, the command asks on a terminal
    #[arg(short, long, value_name = "TEMPLATE")]
    pub template: Option<String>,
    /// List the templates
    #[arg(long)]
    pub list: bool,
    /// Table of hardpoints: CSV or .xlsx
    #[arg(long, value_name = "FILE")]
    pub hardpoints: Option<PathBuf>,
    /// Unit of the table: mm, cm, m or in
    #[arg(long, value_name = "UNIT", requires = "hardpoints")]
    pub units: Option<String>,
    /// Axes of the table, by name or in words
    #[arg(long, value_name = "AXES", requires = "hardpoints")]
    pub axes: Option<String>,
}

const AFTER_SYNTHESIZE: &str = "\
A task file has three to five poses of a body, or the points of a path:

  name = \"tailgate\"
  units = { length = \"mm\", angle = \"deg\" }
  poses = [[0, 0, 0], [60, 90, 25], [70, 190, 60]]    # x, y, angle

All four-bars and slider-cranks that have the poses are found (Burmester); three and four
poses have infinitely many, of which samples are taken. Points are met exactly, or in the
least squares. Every answer passes all poses in order, driven by its crank, without a dead
point; its motion is solved and compared. docs/synthesis.md describes all keys.

Files in the folder (without `-o`, nothing is written):
  index.html               the answers with links to their pages
  1/model.toml             the best answer, as a model for all other commands
  1/report.html            its page
  2/ ...                   the next ones
  answers.csv              joints, transmission angles and distances of all answers
  summary.json             the same, and the numbers of linkages with each defect

Examples:
  hardpoint synthesize models/tasks/tailgate.toml
  hardpoint synthesize models/tasks/tailgate.toml -o results/tailgate
  hardpoint synthesize models/tasks/tailgate.toml --answers 3 \\
      --json | jq '.answers[0]'";

/// Options of `synthesize`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_SYNTHESIZE)]
pub struct Synthesize {
    /// The task file (TOML)
    pub task: PathBuf,
    /// Folder for the models and pages of the answers
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Number of answers [default: that of the file, or 10]
    #[arg(long, value_name = "N", value_parser = count)]
    pub answers: Option<NonZero<usize>>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

const AFTER_RUN: &str = "\
Files in the folder (each appears whole or not at all):
  report.html      the motion in 3D, curves, sensitivities and checks; opens from disk
  motion.csv       position, velocity and acceleration of bodies, points and measures
                   (bodies up to 100)
  sensitivity.csv  derivatives of measures and points by every design variable
                   (of bodies for small models without either)
  summary.json     the model, the outcome of the run, the largest sensitivities
On request:
  motion.xlsx      an Excel workbook with charts (--workbook)
  report.pdf       picture, key figures, hardpoints, curves and rankings on paper (--pdf)
  motion.glb       the motion as animated glTF (--gltf)
  jerk.csv         third time derivatives (--jerk)
For a model with cases, each case gets a folder of its own, and summary.json has their outcomes.
The columns are described in docs/results.md. Files of an earlier run that this one does not
write are removed. Ctrl-C during the solution writes the part that was solved; during writing,
the files of the earlier run stay.

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
    /// CSV text: motion.csv and sensitivity.csv
    Csv,
    /// NumPy arrays, less than half the size: motion.npy and sensitivity.npy, with column names in columns.json
    Npy,
    /// Apache Parquet: motion.parquet and sensitivity.parquet, with units in the column names and in the
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

/// Orientation of a body as three angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Orientation {
    /// 3-1-3 Euler angles
    Euler,
    /// Cardan angles: about x, the new y, the new z
    Cardan,
    /// Roll, pitch and yaw
    RollPitchYaw,
}

impl Orientation {
    /// Corresponding value of the core.
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
    /// Folder for the results [default: results/NAME for NAME.toml]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Skip the comparison with re-solved designs in the report
    #[arg(long)]
    pub no_compare: bool,
    /// Also write the third time derivatives of all bodies, jerk.csv
    #[arg(long)]
    pub jerk: bool,
    /// Also write an Excel workbook, motion.xlsx: variables, measures over time with charts, sensitivities
    #[arg(long)]
    pub workbook: bool,
    /// Also write a printable report, report.pdf: facts, picture, metrics, hardpoints, curves, influences
    #[arg(long)]
    pub pdf: bool,
    /// Parts of report.pdf, which this writes, separated by commas: picture, metrics, hardpoints, variables,
    /// curves, influence [default: all]
    #[arg(long, value_name = "PARTS", value_delimiter = ',', value_parser = pdf_part)]
    pub pdf_parts: Vec<PdfPart>,
    /// Also write an animated glTF file, motion.glb, for Blender and other viewers
    #[arg(long)]
    pub gltf: bool,
    /// Also write three angles of every body, next to its quaternion: euler (3-1-3), cardan or
    /// roll_pitch_yaw
    #[arg(long, value_enum, hide_possible_values = true)]
    pub angles: Option<Orientation>,
    /// Write motion and sensitivities of all bodies, whatever their size
    #[arg(long)]
    pub bodies: bool,
    /// Solve the motion only
    #[arg(long)]
    pub no_sensitivities: bool,
    /// Format of motion and sensitivities: text (csv), NumPy arrays with columns.json (npy, half the size), or
    /// Apache Parquet with units in its metadata (parquet)
    #[arg(long, value_enum, default_value_t = Format::Csv, hide_possible_values = true)]
    pub format: Format,
}

/// Part of a printed report.
fn pdf_part(text: &str) -> Result<PdfPart, String> {
    let names = PdfPart::ALL.map(|part| format!("`{}`", part.name())).join(", ");
    PdfPart::of(text).ok_or_else(|| format!("`{text}` is not a part of the report; give some of {names}"))
}

/// Number of things, of which there is at least one.
fn count(text: &str) -> Result<NonZero<usize>, String> {
    text.parse().map_err(|_| format!("{text} is not a whole number from 1"))
}

/// Help on the maximum number of iterations of an optimisation.
fn iterations_help(of: &str) -> String {
    let default = OptimizationSettings::ITERATIONS;
    format!("Maximum number of iterations of {of} [default: that of the file, or {default}]")
}

const AFTER_CHECK: &str = "\
Each design variable is one of:
  admissible     every joint stays closed with all bodies fixed
  re-assembled   joints open, and the mechanism closes them again by moving
  cannot follow  no motion closes them: there is no sensitivity to this variable

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

const AFTER_CLEARANCE: &str = "\
The model has `[shapes]` of its bodies, and `[clearances.NAME]` with the pairs of shapes. Least
distances are located exactly, between output times too, with their derivatives by all design
variables; so are the times at which shapes touch and part. Distances are negative where shapes
overlap. That nothing is nearer between output times is proved with intervals; where it is not,
the reason and the time are given. Over a grid of two drivers (`grid` of a case) the least
distance is located between the positions, and not proved.

The exit code is 1 if a pair is nearer than the `min` of its clearance, or its distance is not
known.

Examples:
  hardpoint clearance models/studies/knee.toml
  hardpoint clearance models/studies/knee.toml -o results/knee
  hardpoint clearance models/studies/knee.toml \\
      --json | jq '.pairs[] | [.shapes, .least]'";

/// `hardpoint clearance`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_CLEARANCE)]
pub struct Clearance {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Skip the proof that nothing is nearer between output times
    #[arg(long)]
    pub no_proof: bool,
    /// Write clearances.csv into this folder: distances, rates, accelerations and nearest points
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

const AFTER_ENVELOPE: &str = "\
The envelope is the union of a shape of `[shapes]` at all positions of the motion, of all cases
and of all grids of two drivers, unless `--case` names one: a tyre over travel and steer, for the
wheel house. Positions between output times are added until they change the surface by less than
half of the permitted error; triangles deviate from it by less than the other half. Both figures
are stated, with the volume. A motion that ends early is swept to where a limit of a joint stops
it, or to the last position that is reached. Lengths are in the unit of the model file, like the surface, unless
another one is given: `0.5` or `0.02in`.

The exit code is 1 if the permitted error is not reached.

Examples:
  hardpoint envelope models/wheel_clearance.toml tyre --error 3 \\
      -o wheel_house.stl
  hardpoint envelope models/wheel_clearance.toml tyre --case everywhere \\
      --error 5 --margin 15
  hardpoint envelope models/wheel_clearance.toml strut --error 2 \\
      --relative-to knuckle";

/// `hardpoint envelope`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_ENVELOPE)]
pub struct Envelope {
    #[command(flatten)]
    pub common: Common,
    /// Name of the shape
    pub shape: String,
    #[command(flatten)]
    pub motions: Motions,
    /// Body from which the shape is seen, and in whose frame the surface is [default: ground]
    #[arg(long, value_name = "BODY")]
    pub relative_to: Option<String>,
    /// Permitted error, a length [default: 1/200 of the shape's extent]
    #[arg(long, value_name = "LENGTH")]
    pub error: Option<String>,
    /// Distance to add around the shape [default: 0]
    #[arg(long, value_name = "LENGTH")]
    pub margin: Option<String>,
    /// The file to write [default: SHAPE_envelope.stl]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

const AFTER_MAP: &str = "\
The table has the values at the knots of a grid of the drivers, and for cubic Hermite
interpolation the mixed first derivatives. The knots are chosen so that the error of
the interpolation is below the permitted one everywhere in the ranges, which is proved
in interval arithmetic, not sampled. Other drivers remain in the design configuration.

The file's ending selects the format: .csv, .json (with units and errors), .txt for
CombiTable1Ds and CombiTable2Ds of Modelica, in SI, or .adm for SPLINE statements of
Adams. The last two are linear: their points are those of linear interpolation.

Examples:
  hardpoint map models/double_wishbone.toml --over spring_drive=-16..24 \\
      --of toe --error 0.001deg -o toe.csv
  hardpoint map models/slider_crank.toml --over crank_drive=0..90deg \\
      --of stroke --error 1e-6m -o stroke.txt";

/// `hardpoint map`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_MAP)]
pub struct Map {
    #[command(flatten)]
    pub common: Common,
    /// Range of a driver, such as `bump=-80..80` or `bump=-3in..3in`; one to three drivers
    #[arg(long, value_name = "DRIVER=FROM..TO", allow_hyphen_values = true, required = true)]
    pub over: Vec<String>,
    /// Measures, and coordinates of points such as `wheel_centre.z` [default: all measures of positions]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub of: Vec<String>,
    /// Permitted error: of all outputs with this unit, or of one, such as `toe=0.001deg`; may be repeated
    #[arg(
        long,
        value_name = "[NAME=]ERROR",
        allow_hyphen_values = true,
        value_delimiter = ',',
        required = true
    )]
    pub error: Vec<String>,
    /// Interpolation of the table [default: hermite; for Modelica and Adams linear]
    #[arg(long, value_enum)]
    pub interpolation: Option<Interpolation>,
    /// The file to write: .csv, .json, .txt (Modelica) or .adm (Adams)
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

/// Interpolation of a table.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Cubic, from values and derivatives
    Hermite,
    /// Linear between values
    Linear,
}

const AFTER_VERIFY: &str = "\
Every design variable is moved by +h and -h, both designs are solved, and their
difference quotient is compared with the sensitivity, over all times. The deviation
decreases with the square of h until round-off dominates; every quantity (a body's
acceleration, a measure's rate) is judged at its own best step, and a variable
passes if all of them agree to 1e-6 there.

Forward and backward differences move the design in one direction only, for variables
that cannot move in the other. Their deviation is proportional to h, so that they
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
    /// Show the deviation at every step
    #[arg(long)]
    pub sweep: bool,
    /// Designs to compare: at +h and -h, at +h and 0, or at 0 and -h
    #[arg(long, value_name = "SCHEME", value_enum, default_value_t = Differences::Central)]
    pub differences: Differences,
    /// Steps to try, relative to the change that moves a joint by the mechanism's size or rotates it by 1 rad
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
    /// Corresponding value of the core.
    pub fn scheme(self) -> DifferenceScheme {
        match self {
            Self::Central => DifferenceScheme::Central,
            Self::Forward => DifferenceScheme::Forward,
            Self::Backward => DifferenceScheme::Backward,
        }
    }
}

const AFTER_WHATIF: &str = "\
Without --set or --design: ranks all variables of the model, and all coordinates of
its hardpoints, by their influence on each measure. With either: compares the nominal
curves with those of the changed design:
  1st order     predicted from the exact sensitivities
  2nd order     predicted with their exact derivative along the change
  exact         the changed design, solved again

NAME is a design variable of the file, a hardpoint's coordinate (tie_rod_outer.z)
or a joint's tilt about a global axis (lca_pivot.tilt_y). The value is a change,
in mm, cm, m, in, deg or rad; without a unit, in that of the file. Fractions (1/2in) and
decimal commas (2,5mm) are read too. --design takes the changes of a design of the file.

Examples:
  hardpoint whatif models/macpherson.toml --measure toe
  hardpoint whatif models/macpherson.toml --set tie_rod_outer.z=+2mm \\
      --set lca_pivot.tilt_y=0.5deg
  hardpoint whatif models/macpherson.toml --set tie_rod_inner.z=-3mm \\
      --measure toe --over wheel_travel -o results/higher_rack
  hardpoint whatif models/macpherson.toml --set tie_rod_outer.z=+2mm \\
      --save strut_2.toml";

/// `hardpoint whatif`.
#[derive(Args, Debug, Default)]
#[command(after_help = AFTER_WHATIF, group = ArgGroup::new("change").args(["set", "design"]).multiple(true))]
pub struct Whatif {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Change of a variable, such as `tie_rod_outer.z=+2mm`; may be repeated
    #[arg(long, value_name = "NAME=CHANGE")]
    pub set: Vec<String>,
    /// Change of all variables of this design in `[designs]`
    #[arg(long, value_name = "NAME")]
    pub design: Option<String>,
    /// Make the nearest admissible change if the requested one would open joints
    #[arg(long, requires = "change")]
    pub admissible: bool,
    /// Show this measure only; may be repeated
    #[arg(long, value_name = "NAME")]
    pub measure: Vec<String>,
    /// Draw the curves over this measure instead of time
    #[arg(long, value_name = "NAME")]
    pub over: Option<String>,
    /// Write whatif.html, whatif.csv and whatif.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write the model file with the changed design; comments and layout are kept
    #[arg(long, value_name = "FILE", requires = "change")]
    pub save: Option<PathBuf>,
}

const AFTER_COMPARE: &str = "\
Both are solved at the output times of the first, and compared in its units:
hardpoints, parameters, metrics, curves of measures, and entries of one file only.
Cases are compared with those of the same name. Instead of a second file, name a design
of `[designs]` in the first: its variables change, and all else is the same.

With --output it writes into the folder:
  compare.html  both designs on one page, if they have the same bodies and measures
  compare.csv   the curves of both
  compare.json  the printed results

Examples:
  hardpoint compare models/macpherson.toml strut_2.toml
  hardpoint compare models/solid_axle.toml level_rod
  hardpoint compare models/studies/strut_toe.toml found.toml --case bump \\
      --measure toe -o results/found";

/// `hardpoint compare`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_COMPARE)]
pub struct Compare {
    #[command(flatten)]
    pub common: Common,
    /// Model file to compare with, or the name of a design in `[designs]` of the first
    pub other: PathBuf,
    #[command(flatten)]
    pub motions: Motions,
    /// Show this measure only; may be repeated
    #[arg(long, value_name = "NAME")]
    pub measure: Vec<String>,
    /// Write compare.html, compare.csv and compare.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

const AFTER_OPTIMIZE: &str = "\
The model file defines the problem: `[optimize.goals]` has metrics to minimise or to
bring to a target, `[optimize.limits]` the conditions, and every variable that may
change has `bounds` (docs/file-format.md). Each iteration prints a line: the
objective, the limits, and the variable that moved most. Designs whose motion does
not assemble, locks or reaches a dead point are rejected. Ctrl-C ends the search
with the best design so far.

With --output it writes into the folder:
  report.html   the optimised and the nominal design (report-CASE.html for each case)
  summary.json  the printed results, with the initial and final value of every variable

Examples:
  hardpoint optimize models/four_bar_inverse.toml
  hardpoint optimize models/four_bar_inverse.toml --starts 100 \\
      --json | jq '.starts[].status'
  hardpoint optimize models/synthesis/arc_five_points.toml --starts 20 \\
      --optimum 2 --save second.toml
  hardpoint optimize models/synthesis/arc_five_points.toml --other-assemblies \\
      --both-senses
  hardpoint optimize models/four_bar_inverse.toml -o results/found \\
      --save found.toml";

/// `hardpoint optimize`.
#[derive(Args, Debug, Default)]
#[command(after_help = AFTER_OPTIMIZE)]
pub struct Optimize {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Write a report and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write the model file with the optimised design; comments and layout are kept
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    /// Number of starts: the nominal design and others spread within the bounds [default: that of the
    /// file, or 1]
    #[arg(long, value_name = "N", value_parser = count)]
    pub starts: Option<NonZero<usize>>,
    /// Start from the other assemblies of the mechanism too, with the same number of starts each
    #[arg(long)]
    pub other_assemblies: bool,
    /// Start with all drivers in the opposite sense too
    #[arg(long)]
    pub both_senses: bool,
    /// Maximum number of iterations of a search
    #[arg(long, value_name = "N", help = iterations_help("a search"), value_parser = count)]
    pub iterations: Option<NonZero<usize>>,
    /// Report and save the N-th of the distinct optima that the starts ended in [default: the best]
    #[arg(long, value_name = "N", value_parser = count)]
    pub optimum: Option<NonZero<usize>>,
    /// Number of threads for several starts; the result does not depend on it [default: one per
    /// core]
    #[arg(long, value_name = "N", value_parser = count)]
    pub threads: Option<NonZero<usize>>,
}

const AFTER_EXPORT: &str = "\
The file name selects the format; `--list` shows the formats. Unsupported features, such as
motions in URDF, are listed, and the file is written all the same (docs/import.md).
`hardpoint run` writes the motion itself; `-o NAME.c` writes its formulas, a function of the
drivers, as C99 (docs/export-c.md), and `-o NAME.fmu` as an FMI 3.0 unit for other simulators
(docs/export-fmi.md). docs/export.md compares the formats.

Examples:
  hardpoint export models/four_bar.toml -o four_bar.urdf
  hardpoint export models/double_wishbone.toml -o hardpoints.csv
  hardpoint export models/double_wishbone.toml -o skeleton.dxf
  hardpoint export models/double_wishbone.toml -o corner.c --design
  hardpoint export models/double_wishbone.toml -o corner.fmu --coordinates
  hardpoint export models/double_wishbone.toml -o front.sub \\
      --json | jq '.unsaid[]'
  hardpoint export --list";

/// `hardpoint export`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_EXPORT)]
pub struct Export {
    /// The model file (TOML)
    #[arg(required_unless_present = "list")]
    pub model: Option<PathBuf>,
    /// Output file
    #[arg(short, long, value_name = "FILE", required_unless_present = "list")]
    pub output: Option<PathBuf>,
    /// Format [default: from the file name]
    #[arg(long, value_name = "NAME")]
    pub format: Option<String>,
    /// Make the design variables arguments, with the derivatives by them (C, FMU)
    #[arg(long)]
    pub design: bool,
    /// As `--design`, with every coordinate of a hardpoint as a variable (`A.x`)
    #[arg(long)]
    pub coordinates: bool,
    /// As `--design`, with every tilt of a joint axis as a variable (`J.tilt_x`)
    #[arg(long)]
    pub tilts: bool,
    /// List the formats
    #[arg(long, conflicts_with_all = ["model", "output", "format", "design", "coordinates", "tilts"])]
    pub list: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

const AFTER_IMPORT: &str = "\
The contents select the format; `--list` shows the formats. Names of bodies and joints are
kept. A motion that nothing drives in the source gets a driver that fixes it in the design
configuration; if it is the only freedom, it swings. Shapes are written next to the model, as
MODEL_meshes/BODY.stl. The report lists what was imported, approximated and rejected, with the
place in the source (docs/import.md). The model is then checked as by `hardpoint check`, with
its exit codes; code 3 also if the source has errors, and then no model is written. A model
that needs corrections by hand (HP0807, HP0808, HP03) is written, and ends with code 3 or 4.

Examples:
  hardpoint import four_bar.asmt -o four_bar.toml
  hardpoint import suspension.adm -o suspension.toml
  hardpoint import robot.xml --format mjcf -o robot.toml \\
      --json | jq '.report.entries[]'
  hardpoint import --list";

/// `hardpoint import`.
#[derive(Args, Debug, Default)]
#[command(after_help = AFTER_IMPORT)]
pub struct Import {
    /// Source file of the other program
    #[arg(value_name = "FILE", required_unless_present = "list")]
    pub source: Option<PathBuf>,
    /// Output model file
    #[arg(short, long, value_name = "MODEL.toml", required_unless_present = "list")]
    pub output: Option<PathBuf>,
    /// Format [default: from the contents]
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
`[tolerance.variables]`; `[tolerance]` has distributions, correlations and limits
(docs/tolerance.md). Exact derivatives give worst case, root sum of squares (RSS),
mean and standard deviation to second order, contributions of the variables, and
yield. Monte Carlo designs are solved exactly for comparison. A warning marks
metrics that are too nonlinear for linear statistics. Ctrl-C keeps the designs
that were solved.

With --output it writes into the folder:
  report.html        bands over the curves (report-CASE.html for each case)
  metrics.csv        a row for each metric
  contributions.csv  contribution of each variable to each metric
  bands.csv          mean, standard deviation and worst case along every curve
  samples.csv        the Monte Carlo designs: deviations and metrics
  summary.json       the printed results

Examples:
  hardpoint tolerance models/studies/strut_tolerances.toml
  hardpoint tolerance models/studies/strut_tolerances.toml --samples 100000 \\
      -o results/strut
  hardpoint tolerance models/studies/strut_tolerances.toml --case bump \\
      --json | jq '.metrics[].rss'";

const AFTER_TRADE_OFF: &str = "\
`[optimize.goals]` of the model file has the goals, `[optimize.limits]` the conditions,
and every variable that may change has `bounds`. `trade_off` in `[optimize]` names the
goals to trade (docs/trade-off.md). The optimum of each goal is found first, then the
points between them. No point is better than another in all goals, and each satisfies
the first-order condition to 1e-6. Ctrl-C keeps the points found so far.

With --output it writes into the folder:
  report.html   the front as a plot, with the nominal design and one point of the front
                (report-CASE.html for each case)
  front.csv     a row for each point: goals, weights, variables, residual, margin
  summary.json  the printed results

Examples:
  hardpoint trade-off models/studies/wishbone_trade_off.toml
  hardpoint trade-off models/studies/wishbone_trade_off.toml --points 60 \\
      --output out/front
  hardpoint trade-off models/studies/wishbone_trade_off.toml \\
      --save chosen.toml --point 4";

/// `hardpoint trade-off`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_TRADE_OFF)]
pub struct TradeOff {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Names of two or three goals of `[optimize.goals]`, separated by commas [default: `trade_off` of the file, or
    /// all goals]
    #[arg(long, value_name = "GOALS", value_delimiter = ',')]
    pub goals: Vec<String>,
    /// Number of designs on the front [default: 15 for two goals, 45 for three]
    #[arg(long, value_name = "N", value_parser = count)]
    pub points: Option<NonZero<usize>>,
    /// Write a report with a plot of the front, front.csv and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write the model file with the design of a point; comments and layout are kept
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    /// Number of the point to save and to show in the report [default: the balanced compromise]
    #[arg(long, value_name = "K")]
    pub point: Option<usize>,
    /// Number of starts of the search for the optimum of each goal [default: that of the file, or 1]
    #[arg(long, value_name = "N", value_parser = count)]
    pub starts: Option<NonZero<usize>>,
    /// Maximum number of iterations of such a search
    #[arg(long, value_name = "N", help = iterations_help("such a search"), value_parser = count)]
    pub iterations: Option<NonZero<usize>>,
    /// Number of threads for several starts; the result does not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = count)]
    pub threads: Option<NonZero<usize>>,
}

/// `hardpoint tolerance`.
#[derive(Args, Debug, Default)]
#[command(after_help = AFTER_TOLERANCE)]
pub struct Tolerance {
    #[command(flatten)]
    pub common: Common,
    #[command(flatten)]
    pub motions: Motions,
    /// Write a report, tables and summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Number of Monte Carlo designs, 0 for none [default: that of the file, or 10000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(ToleranceSettings::MOST)))]
    pub samples: Option<u32>,
    /// Seed of the random numbers [default: that of the file, or 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// Allocate the loosest tolerances that keep the limits, by the root sum of squares (rss) or the worst case
    /// (worst-case)
    #[arg(long, value_enum, value_name = "RULE")]
    pub allocate: Option<Allocate>,
    /// Number of threads; the result does not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = count)]
    pub threads: Option<NonZero<usize>>,
}

const AFTER_CALIBRATE: &str = "\
The measured file is a CSV table. Its first line names drivers, given forces, outputs (measures,
and points as P.x) and their standard deviations (`sigma toe`); each line below is a posture,
in the units of the model file. Empty cells were not measured; a name that begins with #
leaves its column out. Values of a driver have the zero, sign and unit of its law; a driver
without a column is at its position in the design configuration. If no reading has a standard
deviation, it is estimated from the residuals (docs/calibration.md).

Prior knowledge is in `[calibrate]` of the model file: standard deviations of variables, groups
of variables that deviate alike, and offsets of drivers and sensors. --prior, --priors and
--offset add to it. With such a table or with priors the bounds of variables are kept.

With --output it writes into the folder:
  residuals.csv    a row for each reading: measured, nominal, fitted, difference
  covariance.csv   the covariance of the variables
  report.html      the nominal and the fitted mechanism, residuals as points
  summary.json     the printed results

Examples:
  hardpoint calibrate models/studies/strut_calibrate.toml \\
      models/studies/strut_measured.csv -o results/strut
  hardpoint calibrate models/studies/strut_calibrate.toml \\
      models/studies/strut_measured.csv --prior strut_top_x=0.5
  hardpoint calibrate models/five_link.toml measured.csv --priors tolerances \\
      --offset toe --validate other.csv
  hardpoint calibrate models/five_link.toml measured.csv --sigma toe=0.02 \\
      --sigma camber=0.02 --loss huber
  hardpoint calibrate models/stewart.toml poses.csv --variable base_1_x \\
      --variable base_1_y --save as_built.toml";

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
    /// Fit this design variable; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    pub variable: Vec<String>,
    /// Standard deviation of readings without one, in their unit; may be repeated
    #[arg(long, value_name = "NAME=SIGMA")]
    pub sigma: Vec<String>,
    /// Prior of a design variable: its standard deviation about the nominal value, in its unit; may be repeated
    #[arg(long, value_name = "NAME=SIGMA")]
    pub prior: Vec<String>,
    /// Priors of all other variables: `tolerances`, their own
    #[arg(long, value_name = "SOURCE")]
    pub priors: Option<String>,
    /// Fit an unknown offset of this driver or measure; may be repeated
    #[arg(long, value_name = "NAME")]
    pub offset: Vec<String>,
    /// Compare the fitted design with these readings, which are not fitted: a CSV table
    #[arg(long, value_name = "FILE")]
    pub validate: Option<PathBuf>,
    /// Loss function of large residuals
    #[arg(long, value_enum, default_value_t = LossKind::Squares)]
    pub loss: LossKind,
    /// Maximum number of iterations
    #[arg(long, value_name = "N", default_value = "100", value_parser = count)]
    pub iterations: NonZero<usize>,
    /// Write the model file with the fitted design; comments and layout are kept
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
}

/// Loss function of a residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LossKind {
    /// Square: best for normal errors
    Squares,
    /// Linear beyond 1.345 standard deviations: for a few outliers
    Huber,
    /// Nearly constant for large residuals: for gross errors
    Cauchy,
}

const AFTER_SWEEP: &str = "\
Variables that have `bounds` in the model file are swept within them, or those of
`[sweep.variables]` within the ranges there; `--range` overrides them. Ranges are in the
units of the file: values of parameters, changes for all other variables (docs/sweep.md).
A design that does not assemble, locks or reaches a dead point keeps its row, with
the reason.

With --output it writes into the folder:
  designs.csv   a row for each design: its variables and metrics (or designs.parquet)
  curves.csv    a row for each output time of each design, with --curves (or curves.parquet)
  report.html   metrics over variables (report-CASE.html for each case)
  summary.json  the printed results
An interrupted sweep leaves sweep.partial there: the same command resumes it, and the
files are the same to the last byte.

Examples:
  hardpoint sweep models/studies/strut_sweep.toml -o results/sweep
  hardpoint sweep models/studies/strut_sweep.toml --method sobol-indices \\
      --samples 2000
  hardpoint sweep models/macpherson.toml --range lca_front_z=-5..5 \\
      --method factorial --levels 11 --curves toe
  hardpoint sweep models/studies/strut_sweep.toml --designs mine.csv \\
      --curves toe --format parquet -o results/mine";

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
    /// Number of designs; for sobol-indices the number of pairs of designs [default: that of the file, or 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=SweepSettings::MOST as i64))]
    pub samples: Option<u32>,
    /// Seed of the random numbers [default: that of the file, or 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// Number of levels of every variable of a factorial [default: that of the file, or 3]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub levels: Option<u32>,
    /// Solve the designs of a CSV file, whose first line names design variables
    #[arg(long, value_name = "FILE", conflicts_with_all = ["method", "samples", "seed", "levels", "range"])]
    pub designs: Option<PathBuf>,
    /// Range of a variable, such as `lca_front_z=-5..5`; may be repeated
    #[arg(long, value_name = "NAME=FROM..TO", allow_hyphen_values = true)]
    pub range: Vec<String>,
    /// Also store the curve of this measure; may be repeated
    #[arg(long, value_name = "NAME")]
    pub curves: Vec<String>,
    /// Format of the tables: text, or Parquet
    #[arg(long, value_enum, default_value_t = TableForm::Csv)]
    pub format: TableForm,
    /// Number of threads; the result does not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = count)]
    pub threads: Option<NonZero<usize>>,
    /// Start again if the folder has an unfinished sweep
    #[arg(long)]
    pub restart: bool,
}

const AFTER_STUDIO: &str = "\
The page is the one that `run` writes. The server adds what a page cannot do: it
saves the model in place, notifies the page when the file changes on disk, opens other
models of the folder, and runs long studies natively. It listens on this machine
only, and answers requests with the token of the printed address. Ctrl-C stops it.

Without a model it shows all models of the current folder, or of `models` in it.
With --port and --token, pages find the server again after a restart.

Examples:
  hardpoint studio models/macpherson.toml
  hardpoint studio
  hardpoint studio models/macpherson.toml --no-browser --port 4711 \\
      --token my-own-long-token";

/// `hardpoint studio`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_STUDIO)]
pub struct Studio {
    /// Model file (TOML), or a folder of model files
    pub model: Option<PathBuf>,
    /// Port [default: a free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Access token: at least 16 letters, digits, - and _ [default: a random one]
    #[arg(long, value_name = "TOKEN", value_parser = crate::studio::given_token)]
    pub token: Option<String>,
    /// Print the address without opening a browser
    #[arg(long)]
    pub no_browser: bool,
}

const AFTER_SITE: &str = "\
Files in the folder (each appears whole or not at all):
  index.html    all models with their descriptions
  NAME.html     the report of NAME.toml (NAME-CASE.html for each further case)
  hardpoint.js  engine and code of all reports
Any static host can serve it, and it opens from disk. Models that cannot be shown are left
out, with the reason.

Examples:
  hardpoint site public
  hardpoint site public models/macpherson.toml models/five_link.toml";

/// `hardpoint site`.
#[derive(Args, Debug)]
#[command(after_help = AFTER_SITE)]
pub struct Site {
    /// Folder for the site
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Model files [default: models/*.toml]
    pub models: Vec<PathBuf>,
}

/// Method that chooses the designs.
#[derive(Clone, Copy, Debug, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Every combination of evenly spaced values
    Factorial,
    /// Random, one design in each slice of every range
    #[value(alias = "latin_hypercube")]
    LatinHypercube,
    /// Quasi-random points that fill the ranges evenly
    Sobol,
    /// Designs for Sobol indices: for v variables, (v + 2) times the number of samples
    #[value(alias = "sobol_indices")]
    SobolIndices,
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

/// Rule of the allocation of tolerances, in the order of [`AllocationRule::NAMED`].
#[derive(Clone, Copy, Debug, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Allocate {
    Rss,
    #[value(alias = "worst_case")]
    WorstCase,
}

impl Allocate {
    pub fn rule(self) -> AllocationRule {
        AllocationRule::NAMED[self as usize]
    }
}

fn step(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(step) if step > 0.0 && step < 1.0 => Ok(step),
        _ => Err("a step is a number between 0 and 1".into()),
    }
}
