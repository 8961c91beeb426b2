//! Checks of drivers and couplers, and of the coordinates that they name.

use crate::draft::{CouplerKindDraft, DraftLocation, Section, short, with_digits};
use crate::joint;
use crate::joint::CoordinateType;
use crate::law::Law;
use crate::model::{
    BodyId, Coupler, CouplerTerm, Driver, DriverId, GROUND, JointId, StartPlacement, Transmission,
};

use super::driven::Driven;
use super::{Checker, Here};

/// Upper bound of the derivatives of a law. Accelerations are quadratic in speeds and jerks cubic, and must not
/// overflow.
const LARGEST_RATE: f64 = 1e100;

impl Checker<'_> {
    /// Returns a coordinate of a joint, by name or as its only one.
    pub(super) fn coordinate(&mut self, joint: JointId, name: Option<&str>, here: Here) -> Option<usize> {
        self.coordinate_at(joint, name, [here.key("joint"), here.key("coordinate")])
    }

    /// [`Checker::coordinate`], with errors reported at these locations of the joint and the coordinate.
    pub(super) fn coordinate_at(
        &mut self,
        joint: JointId,
        name: Option<&str>,
        at: [DraftLocation; 2],
    ) -> Option<usize> {
        let [at_joint, at_coordinate] = at;
        let kind = self.model.joints[joint.0].kind;
        let list =
            |c: &[CoordinateType]| c.iter().map(|c| format!("`{}`", c.name)).collect::<Vec<_>>().join(", ");
        let joint_name = self.model.joints[joint.0].name.clone();
        let (message, at) = match (name, kind.coordinates) {
            (_, []) => (format!("{} joints have no coordinates", kind.name), at_joint),
            (None, [_]) => return Some(0),
            (None, _) => (format!("joint `{joint_name}` has more than one coordinate"), at_joint),
            (Some(name), coordinates) => match coordinates.iter().position(|c| c.name == name) {
                Some(k) => return Some(k),
                None => (format!("{} joints have no coordinate `{name}`", kind.name), at_coordinate),
            },
        };
        let fault = self.fault("HP0213", at, message);
        fault.note(format!("type of `{joint_name}`: {} ({})", kind.name, kind.summary));
        fault.help(if kind.coordinates.is_empty() {
            "name a joint with coordinates: a revolute, translational or cylindrical joint, a rod or a leg"
                .into()
        } else {
            format!("name one of its coordinates: {}", list(kind.coordinates))
        });
        None
    }

    pub(super) fn add_drivers(&mut self) {
        let draft = self.draft;
        for (index, d) in draft.drivers.iter().enumerate() {
            let here = Here { section: Section::Drivers, index };
            let driver = DriverId(self.model.drivers.len());
            let driven = self.driven(d, here);
            let zero = driven
                .filter(|_| d.counts_from_zero())
                .and_then(|driven| self.nominal_value(d, driven, here));
            self.zeros.extend(zero.map(|zero| (driver, zero)));
            let law = self.formula_law(&d.name, &d.law, &here.key("law"));
            if let (Some(law), true) = (&law, draft.cases.is_empty()) {
                self.check_law(&format!("driver `{}`", d.name), (law, d.unit), &draft.times, here.key("law"));
            }
            let Some((law, Driven { joint, coordinate, .. })) = law.zip(driven) else {
                self.remove_law_formulas(driver);
                self.driver_ids.push(None);
                continue;
            };
            self.driver_of.insert((joint, coordinate), driver);
            self.driver_ids.push(Some(driver));
            let (name, is_reversed) = (d.name.clone(), d.reversed);
            self.model.drivers.push(Driver { name, joint, coordinate, law, is_reversed });
        }
    }

    /// Returns the driver with this name. HP0204 if there is none; no second error if the driver itself is faulty.
    pub(super) fn driver_named(&mut self, name: &str, at: DraftLocation) -> Option<DriverId> {
        let draft = self.draft;
        let k = self.find("driver", name, at, draft.drivers.iter().map(|d| d.name.as_str()))?;
        self.driver_ids[k]
    }

    /// Placements at which the assembly starts. HP0276: of ground, twice of one body, or not finite.
    pub(super) fn add_start(&mut self) {
        let draft = self.draft;
        for (index, placement) in draft.start.iter().enumerate() {
            let here = Here { section: Section::Start, index };
            let name = &placement.body;
            let bodies = ["ground"].into_iter().chain(draft.bodies.iter().map(|b| b.name.as_str()));
            if self.find("body", name, here.key("name"), bodies).is_none() {
                continue;
            }
            let Some(body) = self.model.bodies.iter().position(|b| b.name == *name).map(BodyId) else {
                continue;
            };
            let message = if body == GROUND {
                "ground cannot start anywhere else than in the design configuration".to_owned()
            } else if self.model.start.iter().any(|start| start.body == body) {
                format!("the start of body `{name}` is given twice")
            } else if !(placement.turn.is_finite() && placement.shift.is_finite()) {
                format!("the start of body `{name}` is not finite")
            } else {
                self.model.start.push(StartPlacement::new(body, placement.turn, placement.shift));
                continue;
            };
            self.fault("HP0276", here.key("name"), message)
                .help("give each body that starts elsewhere one entry with finite numbers");
        }
    }

    /// HP0214: a law that is not finite, or too fast, at an output time.
    pub(super) fn check_law(
        &mut self,
        of: &str,
        (law, unit): (&Law, &str),
        times: &[f64],
        at: DraftLocation,
    ) {
        let all = |t: f64, holds: &dyn Fn(&f64) -> bool| law.at(t).derivatives()[..3].iter().all(holds);
        if let Some(&t) = times.iter().find(|&&t| !all(t, &|x| x.abs() < LARGEST_RATE)) {
            // As the user wrote it.
            let written = law.as_written().at(t).derivatives();
            let number = |order: usize| match (unit, order) {
                ("", _) => short(written[order]),
                (_, 0) => format!("{} {unit}", short(written[order])),
                (_, 1) => format!("{} {unit}/s", short(written[order])),
                _ => format!("{} {unit}/s^{order}", short(written[order])),
            };
            let (what, remedy) = match all(t, &|x| x.is_finite()) {
                false => ("has no finite value", "are finite".to_owned()),
                true => ("changes too fast", format!("are below {LARGEST_RATE:e} in SI units")),
            };
            // A table ends, and a root begins.
            let end = finite_until(|t| all(t, &|x| x.is_finite()), times, t).filter(|_| written[0].is_nan());
            let (note, help) = match end {
                Some(end) => (
                    format!(
                        "its values {} at t = {} s",
                        if end < t { "end" } else { "begin" },
                        with_digits(end, 10)
                    ),
                    "change the law, or the times, so that it has a value at each of them".to_owned(),
                ),
                None => (
                    format!(
                        "value {}, first derivative {}, second derivative {} there",
                        number(0),
                        number(1),
                        number(2)
                    ),
                    format!("change the law, or the times, so that all three {remedy}"),
                ),
            };
            self.fault("HP0214", at, format!("the law of {of} {what} at t = {t} s")).note(note).help(help);
        }
    }

    /// Adds the couplers, then the couplers of screws.
    pub(super) fn add_couplers(&mut self) {
        let draft = self.draft;
        for (index, c) in draft.couplers.iter().enumerate() {
            let here = Here { section: Section::Couplers, index };
            let (transmission, terms) = match &c.kind {
                CouplerKindDraft::Linear(terms) => {
                    let terms: Vec<_> = terms
                        .iter()
                        .enumerate()
                        .map(|(k, t)| {
                            let at = here.item("terms", k);
                            let joint = self.joint(&t.joint, at.clone())?;
                            let coordinate =
                                self.coordinate_at(joint, t.coordinate.as_deref(), [at.clone(), at])?;
                            Some(CouplerTerm { joint, coordinate, coefficient: t.coefficient })
                        })
                        .collect();
                    (None, terms.into_iter().collect::<Option<Vec<CouplerTerm>>>())
                }
                CouplerKindDraft::Pair { by, joints } => (Some(*by), self.pair(joints, *by, here)),
            };
            let Some(terms) = terms else { continue };
            let (joints, ratios) = match transmission {
                None => ("terms", "terms"),
                Some(Transmission::Gears { .. }) => ("joints", "teeth"),
                Some(Transmission::Rack { .. }) => ("rack", "radius"),
                Some(Transmission::Belt { .. }) => ("joints", "radii"),
                Some(Transmission::Screw { .. }) => ("joints", "lead"),
            };
            if !terms.iter().all(|t| t.coefficient.is_finite() && t.coefficient != 0.0) {
                let message = format!("coupler `{}` has a ratio that is zero or not finite", c.name);
                self.fault("HP0224", here.key(ratios), message)
                    .help("give every joint a non-zero number of teeth, radius or coefficient");
            }
            if !c.constant.is_finite() {
                let message = format!("the constant of coupler `{}` is not finite", c.name);
                self.fault("HP0224", here.key("constant"), message).help("give it a finite number");
            }
            let twice = (1..terms.len()).any(|k| {
                terms[..k].iter().any(|t| t.joint == terms[k].joint && t.coordinate == terms[k].coordinate)
            });
            if terms.len() < 2 || twice {
                let message = format!("coupler `{}` connects fewer than two different coordinates", c.name);
                self.fault("HP0224", here.key(joints), message)
                    .help("name two joints, or two coordinates of one joint");
            }
            self.model.couplers.push(Coupler {
                name: c.name.clone(),
                transmission,
                terms,
                constant: c.constant,
            });
        }
        for k in 0..draft.joints.len() {
            if let (Some(joint), Some(lead)) = (self.joint_ids[k], draft.joints[k].lead) {
                let by = Transmission::Screw { lead };
                let coordinate = |name: &str| joint::SCREW.coordinate(name).expect("a screw has it").0;
                let term = |(name, coefficient): (&str, f64)| CouplerTerm {
                    joint,
                    coordinate: coordinate(name),
                    coefficient,
                };
                let terms = by.relation().map(term).into();
                let name = draft.joints[k].name.clone();
                self.model.couplers.push(Coupler { name, transmission: Some(by), terms, constant: 0.0 });
            }
        }
    }

    /// Returns the terms of a transmission between two joints.
    fn pair(&mut self, joints: &[String; 2], by: Transmission, here: Here) -> Option<Vec<CouplerTerm>> {
        let relation = by.relation();
        let terms = [0, 1].map(|k| {
            let (name, coefficient) = relation[k];
            let at = here.item("joints", k);
            let joint = self.joint(&joints[k], at.clone())?;
            let coordinate = self.coordinate_at(joint, Some(name), [at.clone(), at])?;
            Some(CouplerTerm { joint, coordinate, coefficient })
        });
        terms.into_iter().collect()
    }
}

/// Time at which a law that is not finite at time t, but at another output time, begins or ends to be; to round-off.
fn finite_until(is_finite: impl Fn(f64) -> bool, times: &[f64], t: f64) -> Option<f64> {
    let distance = |x: &f64| (x - t).abs();
    let near = times.iter().filter(|x| is_finite(**x)).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let (mut inside, mut outside) = (*near?, t);
    if is_finite(outside) {
        return None;
    }
    loop {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            return Some(inside);
        }
        *(if is_finite(middle) { &mut inside } else { &mut outside }) = middle;
    }
}
