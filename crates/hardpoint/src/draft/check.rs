//! Check of a draft: resolves all references, reports all errors, and builds the model.

mod calibrating;
mod cases;
mod design;
mod driven;
mod elements;
mod equilibrium;
mod field;
mod formulas;
mod grids;
mod joint_limits;
mod joints;
mod measures;
mod motion;
mod optimization;
mod page;
mod shapes;
mod sweeping;
mod tolerancing;
mod wheels;

pub(crate) use elements::{CheckElement, ElementCheck, StiffnessRule};
pub use formulas::{ConstantError, Nominal};

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::draft::{
    CaseDraft, DirectionDraft, Draft, DraftError, DraftLocation, FormulaOf, FrameDraft, LocationDraft,
    PointRef, Section, did_you_mean,
};
use crate::expression::Expression;
use crate::model::element::Compliance;
use crate::model::{
    AxleId, Body, BodyId, BodyPoint, ClearanceId, Direction, DriverId, Extent, GROUND, Hardpoint,
    HardpointId, JointId, Model, PointId, ShapeId, Source, WheelId,
};
use crate::space::{Mat3, Pose, Vec3};

/// Tolerance of the right angle between `axis2` and `axis`, as a cosine. Typed unit vectors satisfy it.
const PERPENDICULAR_TOLERANCE: f64 = 1e-6;
/// Distance, relative to the size of the mechanism, below which two points coincide.
const SAME_POINT: f64 = 1e-9;
/// Distance from a curve, relative to the size of the mechanism, below which a point is drawn on it: coordinates typed
/// into a file have about six digits.
const ON_CURVE: f64 = 1e-6;
/// Largest coordinate and length, m: beyond the size of the universe, and so small that products of ten of them do not
/// overflow.
const LARGEST_LENGTH: f64 = 1e30;
/// Maximum number of valid names in an error.
const LISTED_NAMES: usize = 24;
/// Number of errors up to which the check suggests a name ...
const GUESSES: usize = 50;
/// ... and the maximum number of name comparisons for suggestions.
const COMPARISONS: usize = 250_000;

impl Model {
    /// Checks a draft and resolves its names.
    ///
    /// # Errors
    /// Every [`DraftError`] of the draft, in its order: unknown or duplicate names, missing, null or non-perpendicular
    /// axes, locations that do not fit the joint type, drivers of coordinates that a joint does not have, laws that are
    /// not finite at an output time, times that do not increase. If the draft has
    /// [`UnreadEntries`](crate::draft::UnreadEntries) and no errors, the list is empty.
    ///
    /// ```
    /// use hardpoint::{draft::Draft, model::Model};
    /// let faults = Model::from_draft(&Draft::default()).unwrap_err();
    /// assert_eq!(faults[0].message, "the model has no bodies");
    /// ```
    pub fn from_draft(draft: &Draft) -> Result<Self, Vec<DraftError>> {
        let mut c = Checker::new(draft);
        c.check_names();
        c.add_formulas();
        c.add_bodies();
        c.add_joints();
        c.set_default_frames();
        c.place_unplaced_joints();
        c.add_couplers();
        c.add_points();
        c.add_drivers();
        c.add_start();
        c.check_vehicle();
        c.add_wheels();
        c.add_axles();
        c.add_elements();
        c.add_shapes();
        c.add_clearances();
        c.check_unconnected_bodies();
        c.add_cases();
        c.add_grids();
        c.add_measures();
        c.add_joint_limits();
        c.add_equilibrium();
        c.add_metrics();
        c.add_variables();
        c.add_varying_formulas();
        c.check_times();
        c.add_optimization();
        c.add_tolerancing();
        c.add_sweeping();
        c.add_calibrating();
        c.add_plots();
        c.add_designs();
        c.faults.retain(|f| !draft.unread.has(f.at.section, f.at.index, f.at.key));
        if !c.faults.is_empty() || !draft.unread.is_empty() {
            return Err(c.faults);
        }
        c.model.fix_idle_rotations();
        Ok(c.model)
    }
}

/// Entry of the draft that is being checked.
#[derive(Clone, Copy)]
struct Here {
    section: Section,
    index: usize,
}

impl Here {
    fn key(self, key: &'static str) -> DraftLocation {
        DraftLocation { section: self.section, index: self.index, key, item: None }
    }

    fn item(self, key: &'static str, item: usize) -> DraftLocation {
        DraftLocation { item: Some(item), ..self.key(key) }
    }
}

struct Checker<'a> {
    draft: &'a Draft,
    model: Model,
    faults: Vec<DraftError>,
    /// Model joint of each joint of the draft; `None` for faulty ones.
    joint_ids: Vec<Option<JointId>>,
    /// Model driver of each driver of the draft; `None` for faulty ones.
    driver_ids: Vec<Option<DriverId>>,
    /// Model wheel of each wheel of the draft, and model axle of each axle.
    wheel_ids: Vec<Option<WheelId>>,
    axle_ids: Vec<Option<AxleId>>,
    /// Model shape of each shape of the draft, and model clearance of each clearance.
    shape_ids: Vec<Option<ShapeId>>,
    clearance_ids: Vec<Option<ClearanceId>>,
    /// Model metric of each metric of the draft; `None` for faulty ones.
    metric_ids: Vec<Option<usize>>,
    /// Hardpoints that curves pass through.
    curve_points: Vec<HardpointId>,
    /// Formulas resolved so far, each after those whose results it uses.
    written: Vec<formulas::LocatedFormula>,
    /// Parameters and coordinates of hardpoints without a known value: unread, or defined by a faulty formula.
    unknown_sources: BTreeSet<Source>,
    /// Expressions for lengths of joints, and for parameters of drivers' laws, by name.
    length_formulas: HashMap<&'a str, &'a Expression>,
    law_formulas: HashMap<&'a str, Vec<(&'a str, &'a Expression)>>,
    /// Expressions for parameters of the laws of cases, by the names of case and driver.
    case_formulas: HashMap<(&'a str, &'a str), Vec<(&'a str, &'a Expression)>>,
    /// Index of each name, by kind of entry. Only used for lookups, never iterated.
    numbers: HashMap<&'static str, HashMap<&'a str, usize>>,
    /// Driver of a joint coordinate. Only used for lookups, never iterated.
    driver_of: HashMap<(JointId, usize), DriverId>,
    /// Nominal values of the drivers whose laws give absolute values.
    zeros: HashMap<DriverId, driven::NominalValue>,
    /// Remaining number of name comparisons for suggestions.
    comparisons: usize,
    /// Bounding box of the known hardpoints of joints. Hardpoints without joints do not affect the tolerances.
    extent: Extent,
}

/// Table of each kind of entry.
const TABLES: [(&str, &str); 17] = [
    ("parameter", "parameters"),
    ("hardpoint", "hardpoints"),
    ("body", "bodies"),
    ("joint", "joints"),
    ("driver", "drivers"),
    ("point", "points"),
    ("wheel", "wheels"),
    ("axle", "axles"),
    ("shape", "shapes"),
    ("clearance", "clearances"),
    ("mass", "masses"),
    ("force", "forces"),
    ("measure", "measures"),
    ("metric", "metrics"),
    ("case", "cases"),
    ("design variable", "design"),
    ("vehicle", "vehicle"),
];

/// Bounding box of the known hardpoints that joints use, or of all known hardpoints if joints use none.
fn extent_of_joints(draft: &Draft, hardpoints: &[Hardpoint], unknown_sources: &BTreeSet<Source>) -> Extent {
    let known = |(k, _): &(usize, &Hardpoint)| is_known(HardpointId(*k), unknown_sources);
    let known: Vec<&Hardpoint> = hardpoints.iter().enumerate().filter(known).map(|h| h.1).collect();
    let places = draft.joints.iter().flat_map(|j| &j.at);
    let named: BTreeSet<&str> = places
        .filter_map(|place| match place {
            LocationDraft::Hardpoint(name) => Some(name.as_str()),
            _ => None,
        })
        .collect();
    let used = |h: &&&Hardpoint| h.unnamed || named.contains(h.name.as_str());
    let extent = Extent::of(known.iter().filter(used).map(|h| h.position));
    if extent.size_or_zero() > 0.0 { extent } else { Extent::of(known.iter().map(|h| h.position)) }
}

/// True if all coordinates of a hardpoint are known.
fn is_known(h: HardpointId, unknown_sources: &BTreeSet<Source>) -> bool {
    unknown_sources.is_empty() || (0..3).all(|axis| !unknown_sources.contains(&Source::Coordinate(h, axis)))
}

/// Returns the model of a draft before its entries are added: ground, the hardpoints, and the settings.
fn empty_model(draft: &Draft) -> Model {
    Model {
        name: draft.name.clone(),
        parameters: Vec::new(),
        formulas: Vec::new(),
        hardpoints: draft
            .hardpoints
            .iter()
            .map(|h| Hardpoint { name: h.name.clone(), position: h.position, unnamed: false })
            .collect(),
        bodies: vec![Body { name: "ground".into(), frame: Pose::IDENTITY }],
        joints: Vec::new(),
        couplers: Vec::new(),
        drivers: Vec::new(),
        start: Vec::new(),
        variables: Vec::new(),
        points: Vec::new(),
        vehicle: draft.vehicle.clone(),
        wheels: Vec::new(),
        axles: Vec::new(),
        shapes: Vec::new(),
        clearances: Vec::new(),
        elements: Vec::new(),
        numbers: Vec::new(),
        gravity: draft.gravity,
        load_mode: draft.load_mode,
        equilibrium: None,
        measures: Vec::new(),
        joint_limits: Vec::new(),
        metrics: Vec::new(),
        idle: Vec::new(),
        times: draft.times.clone(),
        at_change_points: draft.at_change_points,
        cases: Vec::new(),
        grids: Vec::new(),
        optimization: None,
        tolerancing: None,
        sweeping: None,
        calibrating: None,
        plots: Vec::new(),
        designs: Vec::new(),
    }
}

/// Returns the index of each name, by kind of entry.
fn numbers_of(draft: &Draft) -> HashMap<&'static str, HashMap<&str, usize>> {
    let ground = ["ground"].into_iter();
    HashMap::from([
        ("body", numbered(ground.chain(draft.bodies.iter().map(|b| b.name.as_str())))),
        ("parameter", numbered(draft.parameters.iter().map(|p| p.name.as_str()))),
        ("hardpoint", numbered(draft.hardpoints.iter().map(|h| h.name.as_str()))),
        ("joint", numbered(draft.joints.iter().map(|j| j.name.as_str()))),
        ("point", numbered(draft.points.iter().map(|p| p.name.as_str()))),
        ("driver", numbered(draft.drivers.iter().map(|d| d.name.as_str()))),
        ("shape", numbered(draft.shapes.iter().map(|s| s.name.as_str()))),
        ("clearance", numbered(draft.clearances.iter().map(|c| c.name.as_str()))),
        ("mass", numbered(draft.masses.iter().map(|m| m.name.as_str()))),
        ("force", numbered(draft.forces.iter().map(|f| f.name.as_str()))),
        ("measure", numbered(draft.measures.iter().map(|m| m.name.as_str()))),
        ("metric", numbered(draft.metrics.iter().map(|m| m.name.as_str()))),
        ("case", numbered(draft.cases.iter().map(|c| c.name.as_str()))),
        ("design variable", numbered(draft.design.iter().map(|v| v.name.as_str()))),
    ])
}

impl<'a> Checker<'a> {
    fn new(draft: &'a Draft) -> Self {
        let model = empty_model(draft);
        let extent = extent_of_joints(draft, &model.hardpoints, &BTreeSet::new());
        let mut checker = Self {
            draft,
            model,
            faults: Vec::new(),
            joint_ids: Vec::new(),
            driver_ids: Vec::new(),
            wheel_ids: Vec::new(),
            axle_ids: Vec::new(),
            shape_ids: Vec::new(),
            clearance_ids: Vec::new(),
            metric_ids: Vec::new(),
            curve_points: Vec::new(),
            written: Vec::new(),
            unknown_sources: BTreeSet::new(),
            length_formulas: HashMap::new(),
            law_formulas: HashMap::new(),
            case_formulas: HashMap::new(),
            numbers: numbers_of(draft),
            driver_of: HashMap::new(),
            zeros: HashMap::new(),
            comparisons: COMPARISONS,
            extent,
        };
        checker.index_formulas();
        checker
    }

    /// Files the formulas of lengths and laws by the names of what they define.
    fn index_formulas(&mut self) {
        for f in &self.draft.formulas {
            match &f.of {
                FormulaOf::Length(joint) => {
                    self.length_formulas.insert(joint, &f.expression);
                }
                FormulaOf::Law(driver, parameter) => {
                    self.law_formulas.entry(driver).or_default().push((parameter, &f.expression));
                }
                FormulaOf::CaseLaw(case, driver, parameter) => {
                    let list = self.case_formulas.entry((case, driver)).or_default();
                    list.push((parameter, &f.expression));
                }
                FormulaOf::Parameter(_) | FormulaOf::Coordinate(..) => {}
            }
        }
    }

    fn fault(
        &mut self,
        code: &'static str,
        at: DraftLocation,
        message: impl Into<String>,
    ) -> &mut DraftError {
        self.faults.push(DraftError { code, at, message: message.into(), notes: Vec::new(), help: None });
        self.faults.last_mut().expect("just pushed")
    }

    /// HP0202: coordinates or a length that are not finite or too large.
    fn check_lengths(&mut self, what: &str, lengths: [f64; 3], at: DraftLocation) -> bool {
        let [x, y, z] = lengths.map(f64::abs);
        // NaN is not finite.
        if x <= LARGEST_LENGTH && y <= LARGEST_LENGTH && z <= LARGEST_LENGTH {
            return true;
        }
        if lengths.iter().all(|x| x.is_finite()) {
            self.fault("HP0202", at, format!("{what} is larger than {LARGEST_LENGTH:e} m"))
                .help(format!("give a number below {LARGEST_LENGTH:e} m"));
        } else {
            self.fault("HP0202", at, format!("{what} is not a finite number"));
        }
        false
    }

    /// HP0201: empty and duplicate names; HP0202: invalid coordinates.
    fn check_names(&mut self) {
        let d = self.draft;
        let lists: [(Section, &str, Vec<&str>); 26] = [
            (Section::Parameters, "parameter", d.parameters.iter().map(|x| x.name.as_str()).collect()),
            (Section::Hardpoints, "hardpoint", d.hardpoints.iter().map(|x| x.name.as_str()).collect()),
            (Section::Bodies, "body", d.bodies.iter().map(|x| x.name.as_str()).collect()),
            (Section::Joints, "joint", d.joints.iter().map(|x| x.name.as_str()).collect()),
            (Section::Couplers, "coupler", d.couplers.iter().map(|x| x.name.as_str()).collect()),
            (Section::Drivers, "driver", d.drivers.iter().map(|x| x.name.as_str()).collect()),
            (Section::Design, "design variable", d.design.iter().map(|x| x.name.as_str()).collect()),
            (Section::Points, "point", d.points.iter().map(|x| x.name.as_str()).collect()),
            (Section::Wheels, "wheel", d.wheels.iter().map(|x| x.name.as_str()).collect()),
            (Section::Axles, "axle", d.axles.iter().map(|x| x.name.as_str()).collect()),
            (Section::Shapes, "shape", d.shapes.iter().map(|x| x.name.as_str()).collect()),
            (Section::Clearances, "clearance", d.clearances.iter().map(|x| x.name.as_str()).collect()),
            (Section::Masses, "mass", d.masses.iter().map(|x| x.name.as_str()).collect()),
            (Section::Forces, "force", d.forces.iter().map(|x| x.name.as_str()).collect()),
            (Section::Measures, "measure", d.measures.iter().map(|x| x.name.as_str()).collect()),
            (Section::Metrics, "metric", d.metrics.iter().map(|x| x.name.as_str()).collect()),
            (Section::Cases, "case", d.cases.iter().map(|x| x.name.as_str()).collect()),
            (Section::Grids, "case", d.grids.iter().map(|x| x.name.as_str()).collect()),
            (Section::Designs, "design", d.designs.iter().map(|x| x.name.as_str()).collect()),
            (
                Section::Goals,
                "goal",
                d.optimization.iter().flat_map(|o| &o.goals).map(|x| x.name.as_str()).collect(),
            ),
            (
                Section::Limits,
                "limit",
                d.optimization.iter().flat_map(|o| &o.limits).map(|x| x.name.as_str()).collect(),
            ),
            (
                Section::Tolerances,
                "tolerance",
                d.tolerancing.iter().flat_map(|t| &t.tolerances).map(|x| x.name.as_str()).collect(),
            ),
            (
                Section::Correlations,
                "correlation",
                d.tolerancing.iter().flat_map(|t| &t.correlations).map(|x| x.name.as_str()).collect(),
            ),
            (
                Section::ToleranceLimits,
                "limit",
                d.tolerancing.iter().flat_map(|t| &t.limits).map(|x| x.name.as_str()).collect(),
            ),
            (
                Section::Priors,
                "prior",
                d.calibrating.iter().flat_map(|c| &c.priors).map(|x| x.name.as_str()).collect(),
            ),
            (
                Section::PriorGroups,
                "group",
                d.calibrating.iter().flat_map(|c| &c.groups).map(|x| x.name.as_str()).collect(),
            ),
        ];
        for (section, what, names) in lists {
            let mut first_of = BTreeMap::new();
            for (index, name) in names.iter().enumerate() {
                let first = *first_of.entry(name).or_insert(index);
                let at = Here { section, index }.key("name");
                if name.trim().is_empty() {
                    self.fault("HP0201", at, format!("a {what} has an empty name")).help("give it a name");
                } else if first < index {
                    self.fault("HP0201", at, format!("there are two {what}s named `{name}`")).note(format!(
                        "the first is number {} of the {what}s, this is number {}",
                        first + 1,
                        index + 1
                    ));
                } else if section == Section::Bodies && *name == "ground" {
                    self.fault("HP0201", at, "the name `ground` is reserved for the fixed body")
                        .help("give this body another name");
                } else if section == Section::Measures && Expression::is_constant(name) {
                    let message =
                        format!("no expression can use a measure named `{name}`: it is a constant there");
                    self.fault("HP0201", at, message).help("give it another name");
                } else if section == Section::Measures && self.component(name).is_some() {
                    let message = format!("a component of a point has the name of measure `{name}`");
                    self.fault("HP0201", at, message).help("give it another name");
                }
            }
        }
        self.check_folders();
        for (index, h) in d.hardpoints.iter().enumerate() {
            let at = Here { section: Section::Hardpoints, index }.key("position");
            self.check_lengths(&format!("a coordinate of hardpoint `{}`", h.name), h.position.to_array(), at);
        }
        if d.bodies.is_empty() && !self.is_table_unread("body") {
            let at = Here { section: Section::Bodies, index: 0 }.key("");
            self.fault("HP0203", at, "the model has no bodies")
                .help("declare at least one body besides `ground`");
        }
    }

    /// HP0201: names of cases that differ in capital letters only.
    fn check_folders(&mut self) {
        let cases = &self.draft.cases;
        for (index, case) in cases.iter().enumerate() {
            let is_other =
                |c: &&CaseDraft| c.name != case.name && c.name.to_lowercase() == case.name.to_lowercase();
            let Some(other) = cases[..index].iter().find(is_other) else { continue };
            let message =
                format!("cases `{}` and `{}` differ in capital letters only", other.name, case.name);
            let at = Here { section: Section::Cases, index }.key("name");
            self.fault("HP0201", at, message)
                .note("results of a case are in a folder of its name, and some file systems ignore the difference")
                .help("give one of them another name");
        }
    }

    /// True if a field of an entry could not be read.
    fn unread(&self, here: Here, field: &str) -> bool {
        self.draft.unread.has(here.section, here.index, field)
    }

    /// True if the table of this kind of entry could not be read.
    fn is_table_unread(&self, what: &str) -> bool {
        let table = TABLES.iter().find(|t| t.0 == what);
        table.is_some_and(|(_, table)| self.draft.unread.has(Section::Model, 0, table))
    }

    /// Returns the index of a name among candidates. Reports HP0204 with the valid names if it is unknown, unless their
    /// table could not be read.
    fn find<'n>(
        &mut self,
        what: &str,
        name: &str,
        at: DraftLocation,
        candidates: impl Iterator<Item = &'n str> + Clone,
    ) -> Option<usize> {
        let numbers = self.numbers.get(what);
        let found = match numbers {
            Some(numbers) => numbers.get(name).copied(),
            None => candidates.clone().position(|c| c == name),
        };
        if found.is_some() || self.is_table_unread(what) {
            return found;
        }
        let count = numbers.map_or_else(|| candidates.clone().count(), HashMap::len);
        // A suggestion takes a comparison with every name. Beyond the errors that a user reads, it only costs time.
        let guess = self.faults.len() < GUESSES && count <= self.comparisons;
        self.comparisons -= if guess { count } else { 0 };
        let names: Vec<&str> = candidates.take(if guess { count } else { LISTED_NAMES }).collect();
        let close = if guess { did_you_mean(name, names.iter().copied()) } else { None };
        self.report_unknown(what, name, at, (&names, count), close);
        None
    }

    /// Reports HP0204 with some of the valid names and their count, and with a similar name if there is one.
    fn report_unknown(
        &mut self,
        what: &str,
        name: &str,
        at: DraftLocation,
        (names, count): (&[&str], usize),
        close: Option<&str>,
    ) {
        let valid: Vec<String> = names.iter().take(LISTED_NAMES).map(|c| format!("`{c}`")).collect();
        let more = count.saturating_sub(valid.len());
        let on_a_body = (what == "point").then(|| self.point_at(name)).flatten();
        let fault = self.fault("HP0204", at, format!("there is no {what} named `{name}`"));
        if !valid.is_empty() {
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            fault.note(format!("valid names: {}{more}", valid.join(", ")));
        }
        match on_a_body.or_else(|| close.map(|close| format!("did you mean `{close}`?"))) {
            Some(help) => drop(fault.help(help)),
            None if valid.is_empty() => {
                fault.help(format!("declare `{name}` first: the model has no {what}"));
            }
            None => {}
        }
    }

    /// Returns a suggestion if a hardpoint is named instead of a point.
    fn point_at(&self, hardpoint: &str) -> Option<String> {
        self.draft.hardpoints.iter().find(|h| h.name == hardpoint)?;
        let is_there =
            |place: &LocationDraft| matches!(place, LocationDraft::Hardpoint(name) if name == hardpoint);
        // A joint with one location has it on both bodies.
        let bodies = self.draft.joints.iter().filter_map(|joint| {
            let k = joint.at.iter().position(is_there)?;
            Some(joint.bodies[if joint.at.len() == 1 { 1 } else { k.min(1) }].as_str())
        });
        let body = bodies.into_iter().next().unwrap_or("...");
        Some(format!(
            "`{hardpoint}` is a hardpoint; a point is on a body: `{{ body = \"{body}\", at = \"{hardpoint}\" }}`"
        ))
    }

    fn body(&mut self, name: &str, at: DraftLocation) -> Option<BodyId> {
        let draft = self.draft;
        let names = std::iter::once("ground").chain(draft.bodies.iter().map(|b| b.name.as_str()));
        self.find("body", name, at, names).map(BodyId)
    }

    fn hardpoint(&mut self, name: &str, at: DraftLocation) -> Option<HardpointId> {
        let draft = self.draft;
        self.find("hardpoint", name, at, draft.hardpoints.iter().map(|h| h.name.as_str())).map(HardpointId)
    }

    /// Returns the joint with this name; `None`, without a second error, if the joint itself is faulty.
    fn joint(&mut self, name: &str, at: DraftLocation) -> Option<JointId> {
        let draft = self.draft;
        let k = self.find("joint", name, at, draft.joints.iter().map(|j| j.name.as_str()))?;
        self.joint_ids[k]
    }

    /// Returns the hardpoint of a location; coordinates become an unnamed hardpoint.
    fn place(&mut self, place: &LocationDraft, owner: &str, at: DraftLocation) -> Option<HardpointId> {
        match place {
            LocationDraft::Hardpoint(name) => self.hardpoint(name, at),
            LocationDraft::At(p) => {
                if !self.check_lengths(&format!("a coordinate of `{owner}`"), p.to_array(), at) {
                    return None;
                }
                self.model.hardpoints.push(Hardpoint { name: owner.into(), position: *p, unnamed: true });
                self.extent.include(*p);
                Some(HardpointId(self.model.hardpoints.len() - 1))
            }
            LocationDraft::Formula(coordinates) => self.formula_place(coordinates, owner, at),
        }
    }

    /// Position of a hardpoint, if it is known.
    fn position(&self, h: HardpointId) -> Option<Vec3> {
        is_known(h, &self.unknown_sources).then(|| self.model.hardpoints[h.0].position)
    }

    /// Vector from one hardpoint to another, if it is known; `Some(None)` if they coincide.
    fn separation(&self, a: HardpointId, b: HardpointId) -> Option<Option<Vec3>> {
        let d = self.position(b)? - self.position(a)?;
        Some((d.norm() > SAME_POINT * self.extent.size()).then_some(d))
    }

    /// Returns a direction, and its unit vector in the design configuration. HP0205 if it is null.
    fn line(
        &mut self,
        line: &DirectionDraft,
        owner: &str,
        here: Here,
        key: &'static str,
    ) -> Option<(Direction, Vec3)> {
        self.line_at(line, owner, here.key(key))
    }

    /// [`Checker::line`], with errors reported at a location.
    fn line_at(
        &mut self,
        line: &DirectionDraft,
        owner: &str,
        at: DraftLocation,
    ) -> Option<(Direction, Vec3)> {
        let key = at.key;
        match line {
            DirectionDraft::Along(v) => match v.unit() {
                Some(u) => Some((Direction::Along(u), u)),
                None => {
                    self.fault("HP0205", at, format!("the {key} of `{owner}` has no direction"))
                        .note(format!("its value is [{}, {}, {}]", v.x, v.y, v.z))
                        .help("give a non-zero vector, like [0, 0, 1]");
                    None
                }
            },
            DirectionDraft::Through(a, b) => {
                let a_id = self.hardpoint(a, DraftLocation { item: Some(0), ..at.clone() });
                let b_id = self.hardpoint(b, DraftLocation { item: Some(1), ..at.clone() });
                let (a_id, b_id) = (a_id?, b_id?);
                match self.separation(a_id, b_id)?.and_then(Vec3::unit) {
                    Some(u) => Some((Direction::Through(a_id, b_id), u)),
                    None => {
                        let message = format!("the two points of the {key} of `{owner}` coincide");
                        self.fault("HP0205", at, message)
                            .note(if a == b {
                                format!("both of its hardpoints are `{a}`")
                            } else {
                                format!("hardpoints `{a}` and `{b}` coincide")
                            })
                            .help("name two different hardpoints");
                        None
                    }
                }
            }
        }
    }

    fn add_bodies(&mut self) {
        let draft = self.draft;
        for (index, b) in draft.bodies.iter().enumerate() {
            let here = Here { section: Section::Bodies, index };
            let mut frame = Pose::IDENTITY;
            match &b.frame {
                FrameDraft::Default => {}
                FrameDraft::Pose(pose) => {
                    let what = format!("a coordinate of the frame of body `{}`", b.name);
                    let is_placed = self.check_lengths(&what, pose.r.to_array(), here.key("frame"));
                    if is_placed && !pose.rot.cols.iter().all(|c| c.is_finite()) {
                        let message = format!("the orientation of body `{}` is not finite", b.name);
                        self.fault("HP0202", here.key("frame"), message);
                    }
                    frame = *pose;
                }
                FrameDraft::Points(origin, x, xy) => {
                    let mut at = |k: usize, p: &LocationDraft| match p {
                        LocationDraft::Formula(_) => {
                            let message = format!("the frame of body `{}` contains an expression", b.name);
                            self.fault("HP0230", here.item("frame", k), message)
                                .help("give numbers: body frames do not change with the design");
                            None
                        }
                        LocationDraft::At(v) => {
                            let what = format!("a coordinate of the frame of `{}`", b.name);
                            self.check_lengths(&what, v.to_array(), here.item("frame", k)).then_some(*v)
                        }
                        LocationDraft::Hardpoint(name) => {
                            self.hardpoint(name, here.item("frame", k)).and_then(|h| self.position(h))
                        }
                    };
                    let points = (at(0, origin), at(1, x), at(2, xy));
                    if let (Some(o), Some(x), Some(p)) = points {
                        let f = (x - o).unit();
                        let h = f.and_then(|f| f.cross(p - o).unit());
                        match (f, h) {
                            (Some(f), Some(h)) => {
                                frame = Pose { rot: Mat3 { cols: [f, h.cross(f), h] }, r: o };
                            }
                            _ => {
                                let message = format!("the frame points of body `{}` are collinear", b.name);
                                self.fault("HP0206", here.key("frame"), message).help(
                                    "give an origin, a point on the x axis, and a third point off that axis",
                                );
                            }
                        }
                    }
                }
            }
            self.model.bodies.push(Body { name: b.name.clone(), frame });
        }
    }

    /// Sets the default frames.
    fn set_default_frames(&mut self) {
        let mut ends = vec![(Vec3::ZERO, 0.0); self.model.bodies.len()];
        for j in self.model.joints.iter().filter(|j| j.at[0] != UNPLACED) {
            for (body, at) in j.bodies.iter().zip(j.at) {
                let (sum, count) = &mut ends[body.0];
                *sum += self.model.hardpoints[at.0].position;
                *count += 1.0;
            }
        }
        for (index, b) in self.draft.bodies.iter().enumerate() {
            let (sum, count) = ends[index + 1];
            if matches!(b.frame, FrameDraft::Default) && count > 0.0 {
                self.model.bodies[index + 1].frame.r = sum * (1.0 / count);
            }
        }
    }

    /// HP0212: bodies without joints, unless they are held by springs or bushings in an equilibrium. Sets the default
    /// frames of those.
    fn check_unconnected_bodies(&mut self) {
        let named: BTreeSet<&str> =
            self.draft.joints.iter().flat_map(|j| &j.bodies).map(String::as_str).collect();
        // An unread joint, or one of an unknown body, may connect any body, and a faulty force may hold any.
        let all_known = !self.is_table_unread("joint")
            && !self.draft.unread.anywhere(Section::Joints, "bodies")
            && named.iter().all(|name| self.number_of("body", name).is_some());
        let forces = self.model.elements.iter().filter(|e| !e.kind.has_mass()).count();
        let forces_known = !self.is_table_unread("force") && forces == self.draft.forces.len();
        for (index, b) in self.draft.bodies.iter().enumerate() {
            if named.contains(b.name.as_str()) || !all_known {
                continue;
            }
            let body = BodyId(index + 1);
            let places: Vec<Vec3> = self.places_of_elasticity(body).collect();
            let at_equilibrium = self.draft.equilibrium.is_some();
            if at_equilibrium && (!places.is_empty() || !forces_known) {
                if matches!(b.frame, FrameDraft::Default) && !places.is_empty() {
                    let sum = places.iter().fold(Vec3::ZERO, |sum, p| sum + *p);
                    self.model.bodies[body.0].frame.r = sum * (1.0 / places.len() as f64);
                }
                continue;
            }
            let at = Here { section: Section::Bodies, index }.key("name");
            self.fault("HP0212", at, format!("body `{}` is not connected to any joint", b.name)).help(
                match places.is_empty() {
                    true => "connect it with a joint, or remove it",
                    false => "connect it with a joint, or add `[equilibrium]`, in which springs and bushings hold it",
                },
            );
        }
    }

    /// Points at which springs and bushings act on a body, in the design configuration.
    fn places_of_elasticity(&self, body: BodyId) -> impl Iterator<Item = Vec3> {
        let model = &self.model;
        let forces = model.elements.iter().filter_map(|e| e.kind.force(model));
        let elastic = forces.filter(|force| matches!(force.compliance, Compliance::Element));
        let points = elastic.flat_map(|force| force.acts_on.points(model)).flatten();
        points.map(|p| &model.points[p.0]).filter(move |p| p.body == body).map(|p| model.position(p.at))
    }

    fn add_points(&mut self) {
        let draft = self.draft;
        for (index, p) in draft.points.iter().enumerate() {
            let here = Here { section: Section::Points, index };
            let body = self.body(&p.body, here.key("body"));
            let at = if self.unread(here, "at") { None } else { self.place(&p.at, &p.name, here.key("at")) };
            // A faulty point stays in the list, so that the indices of later points are correct.
            let (body, at) = body.zip(at).unwrap_or((GROUND, UNPLACED));
            self.model.points.push(BodyPoint { name: p.name.clone(), body, at, unnamed: false });
        }
    }

    /// Returns a point; `None`, without a second error, if a named point itself is faulty.
    fn point(&mut self, p: &PointRef, owner: &str, at: DraftLocation) -> Option<PointId> {
        match p {
            PointRef::Named(name) => {
                let draft = self.draft;
                let k = self.find("point", name, at, draft.points.iter().map(|p| p.name.as_str()))?;
                (self.model.points[k].at != UNPLACED).then_some(PointId(k))
            }
            PointRef::On { body, at: place } => {
                let body = self.body(body, at.clone());
                let place = self.place(place, owner, at);
                let (body, at) = (body?, place?);
                self.model.points.push(BodyPoint { name: owner.into(), body, at, unnamed: true });
                Some(PointId(self.model.points.len() - 1))
            }
        }
    }

    fn check_times(&mut self) {
        let cases = &self.draft.cases;
        if self.draft.times.is_empty() && !cases.is_empty() && cases.iter().all(|c| c.times.is_some()) {
            // The times of the model are only a default for cases.
            self.model.times = cases[0].times.clone().unwrap_or_default();
            return;
        }
        self.check_output_times(&self.draft.times, Here { section: Section::Time, index: 0 }.key(""));
    }

    /// HP0219: missing output times, or times that are not finite and increasing.
    fn check_output_times(&mut self, times: &[f64], at: DraftLocation) {
        if times.is_empty() {
            self.fault("HP0219", at, "the model has no output times")
                .help("give a `[time]` table with `end` and `steps`");
        } else if let Some(k) =
            (0..times.len()).find(|&k| !times[k].is_finite() || (k > 0 && times[k] <= times[k - 1]))
        {
            self.fault("HP0219", at, "the output times are not finite and increasing").note(format!(
                "time number {} is {} s",
                k + 1,
                times[k]
            ));
        }
    }
}

/// Placeholder for the hardpoint of a joint without a location, until it gets one, and of a faulty point.
const UNPLACED: HardpointId = HardpointId(usize::MAX);

fn degrees_between(a: Vec3, b: Vec3) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos().to_degrees()
}

/// Returns the index of each name; the first one of equal names.
fn numbered<'a>(names: impl Iterator<Item = &'a str>) -> HashMap<&'a str, usize> {
    let mut numbers = HashMap::new();
    for (k, name) in names.enumerate() {
        numbers.entry(name).or_insert(k);
    }
    numbers
}

/// Returns the frame with axes z and x along two perpendicular unit vectors.
fn frame_along(z: Vec3, x: Vec3) -> Mat3 {
    Mat3 { cols: [x, z.cross(x), z] }
}
