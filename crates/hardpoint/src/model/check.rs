//! From a draft to a model: every reference resolved, every fault found.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::fault::did_you_mean;
use super::*;
use crate::constraint::Row;
use crate::joint::{self, CoordinateType, Need};
use crate::law::ParameterKind;

/// How far `axis2` may be from square to `axis`, as a cosine: typed unit vectors are good to this.
const SQUARE_TOLERANCE: f64 = 1e-6;
/// Points closer than this part of the mechanism's size are the same point.
const SAME_POINT: f64 = 1e-9;
/// A fault lists at most this many valid names.
const LISTED_NAMES: usize = 24;
/// The first so many faults guess which name was meant ...
const GUESSES: usize = 50;
/// ... as long as that takes no more than so many comparisons of names in all.
const COMPARISONS: usize = 250_000;

impl Model {
    /// Checks a draft and resolves its names.
    ///
    /// # Errors
    /// Every [`Fault`] of the draft, in its order: unknown or duplicate names, axes that are null or
    /// missing or not square, places that do not fit the joint type, drivers on coordinates that a joint
    /// does not have, laws that are not finite at an output time, times that do not increase.
    ///
    /// ```
    /// use hardpoint::model::{Draft, Model};
    /// let faults = Model::from_draft(&Draft::default()).unwrap_err();
    /// assert_eq!(faults[0].message, "the model has no bodies");
    /// ```
    pub fn from_draft(draft: &Draft) -> Result<Self, Vec<Fault>> {
        let mut c = Check::new(draft);
        c.names();
        c.bodies();
        c.joints();
        c.default_frames();
        c.places_of_directions();
        c.couplers();
        c.points();
        c.drivers();
        c.measures();
        c.variables();
        c.times();
        if !c.faults.is_empty() {
            return Err(c.faults);
        }
        c.model.hold_idle_spins();
        Ok(c.model)
    }
}

/// A place in the draft that is being looked at.
#[derive(Clone, Copy)]
struct Here {
    section: Section,
    index: usize,
}

impl Here {
    fn key(self, key: &'static str) -> Locus {
        Locus { section: self.section, index: self.index, key, item: None }
    }

    fn item(self, key: &'static str, item: usize) -> Locus {
        Locus { item: Some(item), ..self.key(key) }
    }
}

struct Check<'a> {
    draft: &'a Draft,
    model: Model,
    faults: Vec<Fault>,
    /// Which drafted joint became which joint; `None` for those that are faulty.
    joint_ids: Vec<Option<JointId>>,
    /// The hardpoints that curves pass through.
    curve_points: Vec<HardpointId>,
    /// By kind of entry: which number a name has. Only looked up, never walked.
    numbers: HashMap<&'static str, HashMap<&'a str, usize>>,
    /// Comparisons of names that guesses may still take.
    comparisons: usize,
    /// The box around the hardpoints listed so far.
    extent: Extent,
}

impl<'a> Check<'a> {
    fn new(draft: &'a Draft) -> Self {
        let model = Model {
            name: draft.name.clone(),
            hardpoints: draft
                .hardpoints
                .iter()
                .map(|h| Hardpoint { name: h.name.clone(), position: h.position, unnamed: false })
                .collect(),
            bodies: vec![Body { name: "ground".into(), frame: Pose::IDENTITY }],
            joints: Vec::new(),
            couplers: Vec::new(),
            drivers: Vec::new(),
            variables: Vec::new(),
            points: Vec::new(),
            measures: Vec::new(),
            idle: Vec::new(),
            times: draft.times.clone(),
        };
        let ground = ["ground"].into_iter();
        let numbers = HashMap::from([
            ("body", numbered(ground.chain(draft.bodies.iter().map(|b| b.name.as_str())))),
            ("hardpoint", numbered(draft.hardpoints.iter().map(|h| h.name.as_str()))),
            ("joint", numbered(draft.joints.iter().map(|j| j.name.as_str()))),
            ("point", numbered(draft.points.iter().map(|p| p.name.as_str()))),
        ]);
        let extent = Extent::of(draft.hardpoints.iter().map(|h| h.position));
        let (faults, joint_ids) = (Vec::new(), Vec::new());
        let curve_points = Vec::new();
        Self { draft, model, faults, joint_ids, curve_points, numbers, comparisons: COMPARISONS, extent }
    }

    fn fault(&mut self, code: &'static str, at: Locus, message: impl Into<String>) -> &mut Fault {
        self.faults.push(Fault { code, at, message: message.into(), notes: Vec::new(), help: None });
        self.faults.last_mut().expect("just pushed")
    }

    /// HP0201: empty and duplicate names; HP0202: coordinates that are not finite.
    fn names(&mut self) {
        let d = self.draft;
        let lists: [(Section, &str, Vec<&str>); 8] = [
            (Section::Hardpoints, "hardpoint", d.hardpoints.iter().map(|x| x.name.as_str()).collect()),
            (Section::Bodies, "body", d.bodies.iter().map(|x| x.name.as_str()).collect()),
            (Section::Joints, "joint", d.joints.iter().map(|x| x.name.as_str()).collect()),
            (Section::Couplers, "coupler", d.couplers.iter().map(|x| x.name.as_str()).collect()),
            (Section::Drivers, "driver", d.drivers.iter().map(|x| x.name.as_str()).collect()),
            (Section::Design, "design variable", d.design.iter().map(|x| x.name.as_str()).collect()),
            (Section::Points, "point", d.points.iter().map(|x| x.name.as_str()).collect()),
            (Section::Measures, "measure", d.measures.iter().map(|x| x.name.as_str()).collect()),
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
                    self.fault("HP0201", at, "`ground` is the name of the body that does not move")
                        .help("it is always there and need not be declared; give this body another name");
                }
            }
        }
        for (index, h) in d.hardpoints.iter().enumerate() {
            if !h.position.is_finite() {
                let at = Here { section: Section::Hardpoints, index }.key("position");
                self.fault(
                    "HP0202",
                    at,
                    format!("a coordinate of hardpoint `{}` is not a finite number", h.name),
                );
            }
        }
        if d.bodies.is_empty() {
            let at = Here { section: Section::Bodies, index: 0 }.key("");
            self.fault("HP0203", at, "the model has no bodies")
                .help("declare at least one body besides `ground`");
        }
    }

    /// Looks a name up among candidates, or says what is there instead.
    fn find<'n>(
        &mut self,
        what: &str,
        name: &str,
        at: Locus,
        candidates: impl Iterator<Item = &'n str> + Clone,
    ) -> Option<usize> {
        let numbers = self.numbers.get(what);
        let found = match numbers {
            Some(numbers) => numbers.get(name).copied(),
            None => candidates.clone().position(|c| c == name),
        };
        if found.is_some() {
            return found;
        }
        let count = numbers.map_or_else(|| candidates.clone().count(), HashMap::len);
        // A guess compares with every name; past the faults that anybody reads it would only cost time.
        let guess = self.faults.len() < GUESSES && count <= self.comparisons;
        let close = if guess { did_you_mean(name, candidates.clone()) } else { None };
        self.comparisons -= if guess { count } else { 0 };
        let valid: Vec<String> = candidates.take(LISTED_NAMES).map(|c| format!("`{c}`")).collect();
        let more = count.saturating_sub(valid.len());
        let fault = self.fault("HP0204", at, format!("there is no {what} named `{name}`"));
        if !valid.is_empty() {
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            fault.note(format!("valid names: {}{more}", valid.join(", ")));
        }
        match close {
            Some(close) => drop(fault.help(format!("did you mean `{close}`?"))),
            None if valid.is_empty() => drop(fault.help(format!("the model declares no {what}"))),
            None => {}
        }
        None
    }

    fn body(&mut self, name: &str, at: Locus) -> Option<BodyId> {
        let draft = self.draft;
        let names = std::iter::once("ground").chain(draft.bodies.iter().map(|b| b.name.as_str()));
        self.find("body", name, at, names).map(BodyId)
    }

    fn hardpoint(&mut self, name: &str, at: Locus) -> Option<HardpointId> {
        let draft = self.draft;
        self.find("hardpoint", name, at, draft.hardpoints.iter().map(|h| h.name.as_str())).map(HardpointId)
    }

    /// The joint of that name; `None`, without a second fault, where the joint itself is faulty.
    fn joint(&mut self, name: &str, at: Locus) -> Option<JointId> {
        let draft = self.draft;
        let k = self.find("joint", name, at, draft.joints.iter().map(|j| j.name.as_str()))?;
        self.joint_ids[k]
    }

    /// A hardpoint for a place; coordinates become an unnamed one.
    fn place(&mut self, place: &Place, owner: &str, at: Locus) -> Option<HardpointId> {
        match place {
            Place::Hardpoint(name) => self.hardpoint(name, at),
            Place::At(p) if p.is_finite() => {
                self.model.hardpoints.push(Hardpoint { name: owner.into(), position: *p, unnamed: true });
                self.extent.include(*p);
                Some(HardpointId(self.model.hardpoints.len() - 1))
            }
            Place::At(_) => {
                self.fault("HP0202", at, format!("a coordinate of `{owner}` is not a finite number"));
                None
            }
        }
    }

    fn position(&self, h: HardpointId) -> Vec3 {
        self.model.hardpoints[h.0].position
    }

    /// A direction, and its unit vector at the design configuration.
    fn line(&mut self, line: &Line, owner: &str, here: Here, key: &'static str) -> Option<(Direction, Vec3)> {
        match line {
            Line::Along(v) => match v.unit() {
                Some(u) => Some((Direction::Along(u), u)),
                None => {
                    self.fault("HP0205", here.key(key), format!("the {key} of `{owner}` has no direction"))
                        .note(format!("it is written as [{}, {}, {}]", v.x, v.y, v.z))
                        .help("give a vector of any length but zero, like [0, 0, 1]");
                    None
                }
            },
            Line::Through(a, b) => {
                let a_id = self.hardpoint(a, here.item(key, 0));
                let b_id = self.hardpoint(b, here.item(key, 1));
                let (a_id, b_id) = (a_id?, b_id?);
                let d = self.position(b_id) - self.position(a_id);
                match d.unit() {
                    Some(u) if d.norm() > SAME_POINT * self.extent.size() => {
                        Some((Direction::Through(a_id, b_id), u))
                    }
                    _ => {
                        let message = format!("the {key} of `{owner}` passes through one point only");
                        self.fault("HP0205", here.key(key), message)
                            .note(if a == b {
                                format!("both of its hardpoints are `{a}`")
                            } else {
                                format!("hardpoints `{a}` and `{b}` are at the same place")
                            })
                            .help("name two hardpoints that lie apart");
                        None
                    }
                }
            }
        }
    }

    fn bodies(&mut self) {
        let draft = self.draft;
        for (index, b) in draft.bodies.iter().enumerate() {
            let here = Here { section: Section::Bodies, index };
            let mut frame = Pose::IDENTITY;
            match &b.frame {
                FrameDraft::Default => {}
                FrameDraft::Pose(pose) => {
                    if !(pose.r.is_finite() && pose.rot.cols.iter().all(|c| c.is_finite())) {
                        self.fault(
                            "HP0202",
                            here.key("frame"),
                            format!("the frame of body `{}` is not finite", b.name),
                        );
                    }
                    frame = *pose;
                }
                FrameDraft::Points(origin, x, xy) => {
                    let mut at = |k: usize, p: &Place| match p {
                        Place::At(v) if v.is_finite() => Some(*v),
                        Place::At(_) => {
                            let message =
                                format!("a coordinate of the frame of `{}` is not a finite number", b.name);
                            self.fault("HP0202", here.item("frame", k), message);
                            None
                        }
                        Place::Hardpoint(name) => {
                            self.hardpoint(name, here.item("frame", k)).map(|h| self.position(h))
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
                                let message =
                                    format!("the frame points of body `{}` lie on one line", b.name);
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

    fn joints(&mut self) {
        let draft = self.draft;
        for (index, j) in draft.joints.iter().enumerate() {
            let before = self.faults.len();
            let joint = self.one_joint(j, Here { section: Section::Joints, index });
            let id = match joint {
                Some(joint) if self.faults.len() == before => {
                    self.model.joints.push(joint);
                    Some(JointId(self.model.joints.len() - 1))
                }
                _ => None,
            };
            self.joint_ids.push(id);
        }
    }

    fn one_joint(&mut self, j: &JointDraft, here: Here) -> Option<Joint> {
        let name = &j.name;
        let kind = joint::named(&j.kind).or_else(|| {
            let names =
                joint::ALL.iter().flat_map(|t| std::iter::once(t.name).chain(t.aliases.iter().copied()));
            self.find("joint type", &j.kind, here.key("type"), names);
            None
        });
        let body_i = self.body(&j.bodies[0], here.item("bodies", 0));
        let body_j = self.body(&j.bodies[1], here.item("bodies", 1));
        if body_i.is_some() && body_i == body_j {
            let message = format!("joint `{name}` connects body `{}` with itself", j.bodies[0]);
            self.fault("HP0207", here.key("bodies"), message)
                .help("name two different bodies, or `ground` for one");
        }
        let kind = kind?;
        let [axis, axis2] =
            [(&j.axis, kind.axis, "axis"), (&j.axis2, kind.axis2, "axis2")].map(|(line, need, key)| {
                match (line, need) {
                    (Some(line), Need::Required | Need::Optional | Need::OnBodyJ) => {
                        self.line(line, name, here, key)
                    }
                    (None, Need::Optional) => None,
                    (None, Need::Required | Need::OnBodyJ) => {
                        let message = format!("joint `{name}` needs `{key}`");
                        self.fault("HP0208", here.key("type"), message)
                        .note(format!("{}: {}", kind.name, kind.summary))
                        .help(format!(
                            "add a direction, like `{key} = [0, 0, 1]`, or let it pass through two hardpoints"
                        ));
                        None
                    }
                    (Some(_), Need::Unused) => {
                        let message = format!("a {} joint has no `{key}`", kind.name);
                        self.fault("HP0208", here.key(key), message)
                            .help(format!("remove `{key}` from `{name}`"));
                        None
                    }
                    (None, Need::Unused) => None,
                }
            });
        let at = self.joint_places(j, kind, axis.map(|a| a.0), here);
        let frames = match (axis, axis2) {
            (Some((_, z)), Some((_, z_j))) if kind.axis2 == Need::OnBodyJ => {
                let cosine = z.dot(z_j);
                if std::ptr::eq(kind, &joint::ANGLE) && cosine.abs() > 1.0 - SQUARE_TOLERANCE {
                    let message =
                        format!("the axes of joint `{name}` are parallel, where their angle holds nothing");
                    self.fault("HP0209", here.key("axis2"), message).help("use a `parallel` joint");
                }
                if std::ptr::eq(kind, &joint::CONSTANT_VELOCITY) && cosine < SQUARE_TOLERANCE {
                    let message = format!("the shafts of joint `{name}` point at each other or are square");
                    self.fault("HP0209", here.key("axis2"), message)
                        .note(format!(
                            "the angle between `axis` and `axis2` is {:.4} deg",
                            degrees_between(z, z_j)
                        ))
                        .help("let both point the same way along the train, less than 90 deg apart");
                }
                let i = frame_along(z, z.any_square());
                [i, Mat3::between(z, z_j) * i]
            }
            (Some((_, z)), Some((_, x))) => {
                if z.dot(x).abs() > SQUARE_TOLERANCE {
                    let angle = degrees_between(z, x);
                    let message = format!("the axes of joint `{name}` are not square to each other");
                    self.fault("HP0209", here.key("axis2"), message)
                        .note(format!("the angle between `axis` and `axis2` is {angle:.4} deg"))
                        .help("turn one of them until they are square");
                }
                [frame_along(z, (x - z * z.dot(x)).unit()?); 2]
            }
            (Some((_, z)), None) => [frame_along(z, z.any_square()); 2],
            _ => [Mat3::IDENTITY; 2],
        };
        let length = self.rod_length(j, kind, here);
        self.lead(j, kind, here);
        let (axis, axis2) = (axis.map(|a| a.0), axis2.map(|a| a.0));
        let bodies = [body_i?, body_j?];
        let (name, cut) = (name.clone(), j.cut);
        let at = at?;
        let curve = self.curve(j, kind, at, frames[0], here);
        Some(Joint { name, kind, bodies, at, axis, axis2, frames, length, curve, cut, unnamed: false })
    }

    /// HP0226: a curve that is missing, out of place, or no curve in the plane square to the joint's axis.
    fn curve(
        &mut self,
        j: &JointDraft,
        kind: &'static JointType,
        at: [HardpointId; 2],
        frame: Mat3,
        here: Here,
    ) -> Option<Curve> {
        let name = &j.name;
        let follows = std::ptr::eq(kind, &joint::POINT_ON_CURVE);
        let draft = match (&j.curve, follows) {
            (None, false) => return None,
            (Some(_), false) => {
                self.fault("HP0226", here.key("curve"), format!("a {} joint has no `curve`", kind.name))
                    .help(format!("remove `curve` from `{name}`, or make it a `point_on_curve`"));
                return None;
            }
            (None, true) => {
                self.fault("HP0226", here.key("type"), format!("joint `{name}` needs a `curve`"))
                    .help("give the points of the cam or slot, like `curve = { points = [[0, 0, 0], ...], closed = true }`");
                return None;
            }
            (Some(curve), true) => curve,
        };
        let places = draft.points.iter().enumerate();
        let ids: Vec<_> = places.map(|(k, p)| self.place(p, name, here.item("curve", k))).collect();
        let ids: Vec<_> = ids.into_iter().collect::<Option<_>>()?;
        let m_i = Pose { rot: frame, r: self.position(at[0]) };
        let local: Vec<Vec3> = ids.iter().map(|h| m_i.inverse().point(self.position(*h))).collect();
        let size = self.model.size();
        let least = if draft.closed { 4 } else { 3 };
        if local.len() < least {
            let message = format!("the curve of `{name}` has {} points", local.len());
            self.fault("HP0226", here.key("curve"), message).help(format!("give at least {least}"));
            return None;
        }
        let off_plane =
            local.iter().enumerate().find(|(_, p)| (p.z - local[0].z).abs() > SQUARE_TOLERANCE * size);
        if let Some((k, p)) = off_plane {
            let message = format!("the curve of `{name}` does not lie in a plane square to its axis");
            self.fault("HP0226", here.key("curve"), message)
                .note(format!(
                    "point {} is {:e} m from the plane of the first",
                    k + 1,
                    (p.z - local[0].z).abs()
                ))
                .help("let all points have the same coordinate along `axis`");
            return None;
        }
        let next = |k: usize| local[(k + 1) % local.len()];
        let last = if draft.closed { local.len() } else { local.len() - 1 };
        if let Some(k) = (0..last).find(|&k| (next(k) - local[k]).norm() <= SAME_POINT * size) {
            let message = format!(
                "points {} and {} of the curve of `{name}` are at the same place",
                k + 1,
                (k + 1) % local.len() + 1
            );
            self.fault("HP0226", here.key("curve"), message)
                .help("leave one of them out; a closed curve does not repeat its first point");
            return None;
        }
        let points: Vec<[f64; 2]> = local.iter().map(|p| [p.x, p.y]).collect();
        let follower = m_i.inverse().point(self.position(at[1]));
        self.curve_points.extend(ids);
        match Curve::through(&points, draft.closed, [follower.x, follower.y]) {
            Ok(curve) if curve.at(curve.start())[0][0].is_finite() => Some(curve),
            Ok(_) => {
                let message = format!("the point of `{name}` is drawn beyond the ends of its curve");
                self.fault("HP0226", here.key("at"), message)
                    .help("place it beside the curve, or make the curve longer");
                None
            }
            Err(error) => {
                self.fault("HP0226", here.key("curve"), format!("no curve for `{name}`: {error}"));
                None
            }
        }
    }

    /// HP0223: a length where there is no rod, or that is none.
    fn rod_length(&mut self, j: &JointDraft, kind: &'static JointType, here: Here) -> Option<f64> {
        let length = j.length?;
        if !kind.coordinates.iter().any(|c| c.row == Row::Distance) && !kind.rows.contains(&Row::Contact) {
            self.fault("HP0223", here.key("length"), format!("a {} joint has no `length`", kind.name))
                .help(format!("remove `length` from `{}`", j.name));
        } else if !(length > 0.0 && length.is_finite()) {
            self.fault("HP0223", here.key("length"), format!("the length of `{}` must be positive", j.name))
                .help("give the distance between its two ends, or leave it out to have it measured");
        }
        Some(length)
    }

    /// HP0223: a screw without a lead, or a lead without a screw.
    fn lead(&mut self, j: &JointDraft, kind: &'static JointType, here: Here) {
        let is_screw = std::ptr::eq(kind, &joint::SCREW);
        match j.lead {
            Some(_) if !is_screw => {
                self.fault("HP0223", here.key("lead"), format!("a {} joint has no `lead`", kind.name))
                    .help(format!("remove `lead` from `{}`, or make it a `screw`", j.name));
            }
            Some(lead) if !(lead != 0.0 && lead.is_finite()) => {
                let message = format!("the lead of screw `{}` must be a number other than zero", j.name);
                self.fault("HP0223", here.key("lead"), message)
                    .help("give the advance of one turn; negative for a left-hand thread");
            }
            None if is_screw => {
                self.fault("HP0223", here.key("type"), format!("screw `{}` needs `lead`", j.name))
                    .help("give the advance of one turn, like `lead = 5`; negative for a left-hand thread");
            }
            _ => {}
        }
    }

    /// The hardpoints of the two markers: one shared, or one on each body.
    fn joint_places(
        &mut self,
        j: &JointDraft,
        kind: &'static JointType,
        axis: Option<Direction>,
        here: Here,
    ) -> Option<[HardpointId; 2]> {
        let name = &j.name;
        if let (true, Some(Direction::Through(a, _))) = (j.at.is_empty() && kind.places == 1, axis) {
            return Some([a, a]);
        }
        let fits = match kind.places {
            0 => j.at.len() <= 1,
            1 => (1..=2).contains(&j.at.len()),
            _ => j.at.len() == 2,
        };
        if fits && j.at.is_empty() {
            return Some([UNPLACED; 2]);
        }
        if !fits {
            let message = match kind.places {
                0 => format!("joint `{name}` takes at most one hardpoint in `at`, not {}", j.at.len()),
                1 => format!("joint `{name}` needs one hardpoint in `at`, not {}", j.at.len()),
                _ => format!(
                    "joint `{name}` needs two hardpoints in `at`, one on each body, not {}",
                    j.at.len()
                ),
            };
            let at = if j.at.is_empty() { here.key("type") } else { here.key("at") };
            let fault = self.fault("HP0210", at, message);
            fault.note(format!("{}: {}", kind.name, kind.summary));
            fault.help(match (kind.places, j.at.len()) {
                (0, _) => "only its directions matter; leave `at` out".to_string(),
                (1, _) => "name the hardpoint where the bodies meet".into(),
                _ => format!("first the point on `{}`, then the point on `{}`", j.bodies[0], j.bodies[1]),
            });
            return None;
        }
        let places: Vec<_> =
            j.at.iter().enumerate().map(|(k, p)| self.place(p, name, here.item("at", k))).collect();
        let (first, last) = (places[0]?, places[places.len() - 1]?);
        let is_rod = kind.coordinates.iter().any(|c| c.row == Row::Distance);
        if is_rod && (self.position(last) - self.position(first)).norm() <= SAME_POINT * self.extent.size() {
            self.fault("HP0211", here.key("at"), format!("the two ends of `{name}` are at the same place"))
                .help("a rod needs two points that lie apart");
        }
        Some([first, last])
    }

    /// Joints that need no place get one all the same, amid the places of their bodies' other joints, for their markers.
    fn places_of_directions(&mut self) {
        for k in 0..self.model.joints.len() {
            if self.model.joints[k].at[0] != UNPLACED {
                continue;
            }
            let bodies = self.model.joints[k].bodies;
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for j in self.model.joints.iter().filter(|j| j.at[0] != UNPLACED) {
                for (body, at) in j.bodies.iter().zip(j.at) {
                    if *body != GROUND && bodies.contains(body) {
                        sum += self.model.hardpoints[at.0].position;
                        count += 1.0;
                    }
                }
            }
            let position = if count > 0.0 { sum * (1.0 / count) } else { Vec3::ZERO };
            let name = self.model.joints[k].name.clone();
            self.model.hardpoints.push(Hardpoint { name, position, unnamed: true });
            self.model.joints[k].at = [HardpointId(self.model.hardpoints.len() - 1); 2];
        }
    }

    /// HP0212 for bodies that nothing holds; default frames for the others that gave none.
    fn default_frames(&mut self) {
        let mut ends = vec![(Vec3::ZERO, 0.0); self.model.bodies.len()];
        for j in self.model.joints.iter().filter(|j| j.at[0] != UNPLACED) {
            for (body, at) in j.bodies.iter().zip(j.at) {
                let (sum, count) = &mut ends[body.0];
                *sum += self.model.hardpoints[at.0].position;
                *count += 1.0;
            }
        }
        let named: BTreeSet<&str> =
            self.draft.joints.iter().flat_map(|j| &j.bodies).map(String::as_str).collect();
        for (index, b) in self.draft.bodies.iter().enumerate() {
            if !named.contains(b.name.as_str()) {
                let at = Here { section: Section::Bodies, index }.key("name");
                self.fault("HP0212", at, format!("no joint holds body `{}`", b.name))
                    .help("connect it with a joint, or remove it");
            }
            let (sum, count) = ends[index + 1];
            if matches!(b.frame, FrameDraft::Default) && count > 0.0 {
                self.model.bodies[index + 1].frame.r = sum * (1.0 / count);
            }
        }
    }

    /// A coordinate of a joint, by name or as its only one.
    fn coordinate(&mut self, joint: JointId, name: Option<&str>, here: Here) -> Option<usize> {
        self.coordinate_at(joint, name, [here.key("joint"), here.key("coordinate")])
    }

    /// As [`Check::coordinate`], where the joint and the coordinate are named at these places.
    fn coordinate_at(&mut self, joint: JointId, name: Option<&str>, at: [Locus; 2]) -> Option<usize> {
        let [at_joint, at_coordinate] = at;
        let kind = self.model.joints[joint.0].kind;
        let list =
            |c: &[CoordinateType]| c.iter().map(|c| format!("`{}`", c.name)).collect::<Vec<_>>().join(", ");
        let joint_name = self.model.joints[joint.0].name.clone();
        let (message, at) = match (name, kind.coordinates) {
            (_, []) => (format!("a {} joint has no coordinate to name", kind.name), at_joint),
            (None, [_]) => return Some(0),
            (None, _) => (format!("joint `{joint_name}` has more than one coordinate"), at_joint),
            (Some(name), coordinates) => match coordinates.iter().position(|c| c.name == name) {
                Some(k) => return Some(k),
                None => (format!("a {} joint has no coordinate `{name}`", kind.name), at_coordinate),
            },
        };
        let fault = self.fault("HP0213", at, message);
        fault.note(format!("type of `{joint_name}`: {} ({})", kind.name, kind.summary));
        fault.help(if kind.coordinates.is_empty() {
            "name a joint that has one: a revolute, translational or cylindrical joint, a rod or a leg".into()
        } else {
            format!("its coordinates: {}", list(kind.coordinates))
        });
        None
    }

    fn drivers(&mut self) {
        let draft = self.draft;
        for (index, d) in draft.drivers.iter().enumerate() {
            let here = Here { section: Section::Drivers, index };
            let finite = |t: f64| d.law.at(t).derivatives()[..3].iter().all(|x| x.is_finite());
            if let Some(&t) = draft.times.iter().find(|&&t| !finite(t)) {
                let [f, fd, fdd, _] = d.law.at(t).derivatives();
                let message = format!("the law of driver `{}` has no finite value at t = {t} s", d.name);
                self.fault("HP0214", here.key("law"), message)
                    .note(format!("value {f}, first derivative {fd}, second derivative {fdd} there"))
                    .help("change the law, or the times, so that all three are finite");
            }
            let Some((joint, coordinate)) = self.driven(d, here) else { continue };
            self.model.drivers.push(Driver { name: d.name.clone(), joint, coordinate, law: d.law.clone() });
        }
    }

    /// The joint coordinate that a driver prescribes; for what is no joint's, an unnamed joint that has it.
    fn driven(&mut self, d: &DriverDraft, here: Here) -> Option<(JointId, usize)> {
        match &d.drives {
            DrivenDraft::Coordinate { joint: name, coordinate } => {
                let joint = self.joint(name, here.key("joint"))?;
                let coordinate = self.coordinate(joint, coordinate.as_deref(), here)?;
                self.drivable(d, name, joint, coordinate, here).then_some((joint, coordinate))
            }
            DrivenDraft::Position { point, along } => {
                let point = self.point(point, &d.name, here.key("point"));
                let along = self.line(along, &d.name, here, "along");
                let (point, (axis, z)) = (point?, along?);
                let BodyPoint { body, at, .. } = self.model.points[point.0];
                let axes = Some((axis, frame_along(z, z.any_square())));
                Some((self.driven_joint(d, &joint::TRAVEL, [GROUND, body], [at, at], axes, here)?, 0))
            }
            DrivenDraft::Distance { from, to } => {
                let (a, b) =
                    (self.point(from, &d.name, here.key("from")), self.point(to, &d.name, here.key("to")));
                let [i, j] = [a?, b?].map(|p| self.model.points[p.0].clone());
                if (self.position(i.at) - self.position(j.at)).norm() <= SAME_POINT * self.model.size() {
                    let message = format!("the two points of driver `{}` are at the same place", d.name);
                    self.fault("HP0211", here.key("to"), message)
                        .help("an actuator needs two points that lie apart");
                }
                Some((self.driven_joint(d, &joint::LEG, [i.body, j.body], [i.at, j.at], None, here)?, 0))
            }
            DrivenDraft::Orientation { body, relative_to, about } => {
                let body = self.body(body, here.key("body"));
                let base = match relative_to {
                    Some(name) => self.body(name, here.key("relative_to")),
                    None => Some(GROUND),
                };
                let (axis, z) = self.line(about, &d.name, here, "about")?;
                let (body, base) = (body?, base?);
                let axes = Some((axis, frame_along(z, z.any_square())));
                let at = self.model.joints.iter().find(|j| j.bodies.contains(&body)).map(|j| j.at[0])?;
                Some((self.driven_joint(d, &joint::HEADING, [base, body], [at, at], axes, here)?, 0))
            }
        }
    }

    /// An unnamed joint that has the coordinate that a driver prescribes.
    fn driven_joint(
        &mut self,
        d: &DriverDraft,
        kind: &'static JointType,
        bodies: [BodyId; 2],
        at: [HardpointId; 2],
        axis: Option<(Direction, Mat3)>,
        here: Here,
    ) -> Option<JointId> {
        if bodies[0] == bodies[1] {
            let name = &self.model.bodies[bodies[0].0].name;
            let message = format!("driver `{}` prescribes how `{name}` moves relative to itself", d.name);
            self.fault("HP0213", here.key("name"), message).help("name two different bodies");
            return None;
        }
        self.model.joints.push(Joint {
            name: d.name.clone(),
            kind,
            bodies,
            at,
            axis: axis.map(|a| a.0),
            axis2: None,
            frames: [axis.map_or(Mat3::IDENTITY, |a| a.1); 2],
            length: None,
            curve: None,
            cut: false,
            unnamed: true,
        });
        Some(JointId(self.model.joints.len() - 1))
    }

    /// Whether a joint's coordinate may be prescribed: by one driver, and not where a constraint keeps it.
    fn drivable(
        &mut self,
        d: &DriverDraft,
        name: &str,
        joint: JointId,
        coordinate: usize,
        here: Here,
    ) -> bool {
        let kind = self.model.joints[joint.0].kind;
        if let Some(other) =
            self.model.drivers.iter().find(|o| o.joint == joint && o.coordinate == coordinate)
        {
            let message = format!("drivers `{}` and `{}` prescribe the same coordinate", other.name, d.name);
            let c = kind.coordinates[coordinate].name;
            self.fault("HP0215", here.key("joint"), message)
                .note(format!("the {c} of joint `{name}`"))
                .help("remove one of them");
            return false;
        }
        if kind.rows.contains(&kind.coordinates[coordinate].row) {
            let message = format!("driver `{}` prescribes the length of a rod, which is constant", d.name);
            self.fault("HP0213", here.key("joint"), message)
                .help(format!("make `{name}` a `leg`: a rod whose length a driver prescribes"));
            return false;
        }
        true
    }

    /// Couplers, then those that screws are.
    fn couplers(&mut self) {
        let draft = self.draft;
        for (index, c) in draft.couplers.iter().enumerate() {
            let here = Here { section: Section::Couplers, index };
            let terms = match &c.kind {
                CouplerKindDraft::Linear(terms) => {
                    let terms: Vec<_> = terms
                        .iter()
                        .enumerate()
                        .map(|(k, t)| {
                            let at = here.item("terms", k);
                            let joint = self.joint(&t.joint, at.clone())?;
                            let coordinate =
                                self.coordinate_at(joint, t.coordinate.as_deref(), [at.clone(), at])?;
                            Some(Term { joint, coordinate, coefficient: t.coefficient })
                        })
                        .collect();
                    terms.into_iter().collect::<Option<Vec<Term>>>()
                }
                CouplerKindDraft::Gears { joints, teeth, internal } => {
                    let sign = if *internal { -1.0 } else { 1.0 };
                    self.pair(joints, ["angle"; 2], [teeth[0], sign * teeth[1]], here)
                }
                CouplerKindDraft::Belt { joints, radii, crossed } => {
                    let sign = if *crossed { 1.0 } else { -1.0 };
                    self.pair(joints, ["angle"; 2], [radii[0], sign * radii[1]], here)
                }
                CouplerKindDraft::Rack { rack, pinion, radius } => {
                    let joints = [rack.clone(), pinion.clone()];
                    self.pair(&joints, ["displacement", "angle"], [1.0, -radius], here)
                }
            };
            let Some(terms) = terms else { continue };
            let (joints, ratios) = match &c.kind {
                CouplerKindDraft::Linear(_) => ("terms", "terms"),
                CouplerKindDraft::Gears { .. } => ("joints", "teeth"),
                CouplerKindDraft::Rack { .. } => ("rack", "radius"),
                CouplerKindDraft::Belt { .. } => ("joints", "radii"),
            };
            if !terms.iter().all(|t| t.coefficient.is_finite() && t.coefficient != 0.0) {
                let message = format!("coupler `{}` has a ratio that is zero or not finite", c.name);
                self.fault("HP0224", here.key(ratios), message)
                    .help("give every joint a number of teeth, a radius or a coefficient other than zero");
            }
            let twice = (1..terms.len()).any(|k| {
                terms[..k].iter().any(|t| t.joint == terms[k].joint && t.coordinate == terms[k].coordinate)
            });
            if terms.len() < 2 || twice {
                let message = format!("coupler `{}` must couple at least two different coordinates", c.name);
                self.fault("HP0224", here.key(joints), message)
                    .help("name two joints, or two coordinates of one joint");
            }
            self.model.couplers.push(Coupler { name: c.name.clone(), terms });
        }
        for k in 0..draft.joints.len() {
            if let (Some(joint), Some(lead)) = (self.joint_ids[k], draft.joints[k].lead) {
                let coordinate = |name: &str| joint::SCREW.coordinate(name).expect("a screw has it").0;
                let per_radian = lead / (2.0 * std::f64::consts::PI);
                let terms = vec![
                    Term { joint, coordinate: coordinate("displacement"), coefficient: 1.0 },
                    Term { joint, coordinate: coordinate("angle"), coefficient: -per_radian },
                ];
                self.model.couplers.push(Coupler { name: draft.joints[k].name.clone(), terms });
            }
        }
    }

    /// The terms of two joints.
    fn pair(
        &mut self,
        joints: &[String; 2],
        coordinates: [&str; 2],
        coefficients: [f64; 2],
        here: Here,
    ) -> Option<Vec<Term>> {
        let terms = [0, 1].map(|k| {
            let at = here.item("joints", k);
            let joint = self.joint(&joints[k], at.clone())?;
            let coordinate = self.coordinate_at(joint, Some(coordinates[k]), [at.clone(), at])?;
            Some(Term { joint, coordinate, coefficient: coefficients[k] })
        });
        terms.into_iter().collect()
    }

    fn points(&mut self) {
        let draft = self.draft;
        for (index, p) in draft.points.iter().enumerate() {
            let here = Here { section: Section::Points, index };
            let body = self.body(&p.body, here.key("body"));
            let at = self.place(&p.at, &p.name, here.key("at"));
            // A faulty point keeps its place in the list, so that later names still resolve.
            let (body, at) = (body.unwrap_or(GROUND), at.unwrap_or(HardpointId(0)));
            self.model.points.push(BodyPoint { name: p.name.clone(), body, at, unnamed: false });
        }
    }

    fn point(&mut self, p: &PointRef, owner: &str, at: Locus) -> Option<PointId> {
        match p {
            PointRef::Named(name) => {
                let draft = self.draft;
                self.find("point", name, at, draft.points.iter().map(|p| p.name.as_str())).map(PointId)
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

    fn measures(&mut self) {
        let draft = self.draft;
        for (index, m) in draft.measures.iter().enumerate() {
            let here = Here { section: Section::Measures, index };
            if let Some(kind) = self.one_measure(m, here) {
                self.model.measures.push(Measure { name: m.name.clone(), kind });
            }
        }
    }

    fn one_measure(&mut self, m: &MeasureDraft, here: Here) -> Option<MeasureKind> {
        Some(match &m.kind {
            MeasureKindDraft::Coordinate { joint, coordinate } => {
                let joint = self.joint(joint, here.key("joint"))?;
                let coordinate = self.coordinate(joint, coordinate.as_deref(), here)?;
                MeasureKind::Coordinate { joint, coordinate }
            }
            MeasureKindDraft::Distance { from, to } => {
                let (a, b) =
                    (self.point(from, &m.name, here.key("from")), self.point(to, &m.name, here.key("to")));
                let (from, to) = (a?, b?);
                if from == to {
                    let message = format!("measure `{}` is the distance of a point from itself", m.name);
                    self.fault("HP0216", here.key("to"), message);
                }
                MeasureKind::Distance { from, to }
            }
            MeasureKindDraft::Coordinates { point, along } => {
                let point = self.point(point, &m.name, here.key("point"));
                let (_, along) = self.line(&Line::Along(*along), &m.name, here, "along")?;
                MeasureKind::Coordinates { point: point?, along }
            }
            MeasureKindDraft::Toe { body, spin_axis } | MeasureKindDraft::Camber { body, spin_axis } => {
                let body = self.body(body, here.key("body"));
                let (spin_axis, _) = self.line(spin_axis, &m.name, here, "spin_axis")?;
                let body = body?;
                match &m.kind {
                    MeasureKindDraft::Toe { .. } => MeasureKind::Toe { body, spin_axis },
                    _ => MeasureKind::Camber { body, spin_axis },
                }
            }
        })
    }

    fn variables(&mut self) {
        let draft = self.draft;
        for (index, v) in draft.design.iter().enumerate() {
            let here = Here { section: Section::Design, index };
            if v.changes.is_empty() {
                let message = format!("design variable `{}` changes nothing", v.name);
                self.fault("HP0217", here.key("name"), message)
                    .help("say which hardpoint it moves, which joint it tilts, or give a velocity field");
            }
            let mut quantity: Option<Quantity> = None;
            let mut changes = Vec::new();
            for (k, change) in v.changes.iter().enumerate() {
                let Some((change, q)) = self.one_change(change, &v.name, here, k) else { continue };
                quantity = Some(if quantity.is_none_or(|before| before == q) { q } else { Quantity::Number });
                changes.push(change);
            }
            self.model.variables.push(DesignVariable {
                name: v.name.clone(),
                quantity: quantity.unwrap_or(Quantity::Number),
                changes,
                fixed_length: v.fixed_length,
            });
        }
    }

    fn one_change(
        &mut self,
        change: &ChangeDraft,
        owner: &str,
        here: Here,
        k: usize,
    ) -> Option<(Change, Quantity)> {
        let at = here.item("changes", k);
        let null = |check: &mut Self| {
            let message = format!("a velocity of design variable `{owner}` is null or not finite");
            check.fault("HP0217", here.item("changes", k), message);
        };
        let is_null =
            |a: Vec3, b: Vec3| !(a.is_finite() && b.is_finite()) || (a.norm() < 1e-12 && b.norm() < 1e-12);
        match change {
            ChangeDraft::Move { hardpoint, velocity } => {
                let name = hardpoint;
                let hardpoint = self.hardpoint(hardpoint, at.clone())?;
                if self.curve_points.contains(&hardpoint) {
                    let message = format!("design variable `{owner}` moves `{name}`, a point of a curve");
                    self.fault("HP0226", at, message)
                        .note("the shape of a curve is no design variable; its place and direction are")
                        .help(
                            "write the curve's points as coordinates, and move the hardpoint that carries it",
                        );
                    return None;
                }
                if is_null(*velocity, Vec3::ZERO) {
                    null(self);
                }
                Some((Change::Move { hardpoint, velocity: *velocity }, Quantity::Length))
            }
            ChangeDraft::Tilt { joint, about } => {
                let joint = self.joint(joint, at)?;
                let (_, rotation) = self.line(about, owner, here, "about")?;
                let change = Change::Marker { joint, end: End::Both, position: Vec3::ZERO, rotation };
                Some((change, Quantity::Angle))
            }
            ChangeDraft::Marker { joint, end, position, rotation } => {
                let joint = self.joint(joint, at)?;
                if is_null(*position, *rotation) {
                    null(self);
                }
                let quantity = match (position.norm() > 0.0, rotation.norm() > 0.0) {
                    (_, false) => Quantity::Length,
                    (false, true) => Quantity::Angle,
                    (true, true) => Quantity::Number,
                };
                let change = Change::Marker { joint, end: *end, position: *position, rotation: *rotation };
                Some((change, quantity))
            }
            ChangeDraft::Length { joint, rate } => {
                let joint = self.joint(joint, at.clone())?;
                if !(rate.is_finite() && *rate != 0.0) {
                    null(self);
                }
                let j = &self.model.joints[joint.0];
                if j.length.is_none() {
                    let (name, kind) = (j.name.clone(), j.kind.name);
                    let message = format!("joint `{name}` has no `length` of its own that could change");
                    let fault = self.fault("HP0225", at, message);
                    fault.note(format!(
                        "it is a {kind} joint; the length of a rod is measured between its hardpoints"
                    ));
                    fault.help(format!("give rod `{name}` a `length`, or move one of its hardpoints"));
                    return None;
                }
                Some((Change::Length { joint, rate: *rate }, Quantity::Length))
            }
            ChangeDraft::Law { driver, parameter, rate } => {
                let draft = self.draft;
                let names = draft.drivers.iter().map(|d| d.name.as_str());
                let k = self.find("driver", driver, at.clone(), names)?;
                let parameters = draft.drivers[k].law.parameters();
                let names = parameters.iter().map(|p| p.name.as_str());
                let p = self.find(
                    &format!("parameter of the law of `{driver}`"),
                    parameter,
                    here.key("parameter"),
                    names,
                )?;
                if !(rate.is_finite() && *rate != 0.0) {
                    null(self);
                }
                // A faulty driver has been reported.
                let driver = self.model.drivers.iter().position(|d| d.name == *driver).map(DriverId)?;
                let quantity = match parameters[p].kind {
                    ParameterKind::Value => self.model.driven(&self.model.drivers[driver.0]).quantity,
                    ParameterKind::Angle => Quantity::Angle,
                    _ => Quantity::Number,
                };
                Some((Change::Law { driver, parameter: p, rate: *rate }, quantity))
            }
            ChangeDraft::Field { joint, body, v, u } => {
                let joint = self.joint(joint, at.clone());
                let body = self.body(body, at.clone());
                let (joint, body) = (joint?, body?);
                if is_null(*v, *u) {
                    null(self);
                }
                let bodies = self.model.joints[joint.0].bodies;
                let Some(end) = bodies.iter().position(|b| *b == body) else {
                    let names = bodies.map(|b| format!("`{}`", self.model.bodies[b.0].name)).join(" and ");
                    let message = format!(
                        "joint `{}` has no marker on body `{}`",
                        self.model.joints[joint.0].name, self.model.bodies[body.0].name
                    );
                    self.fault("HP0218", at, message).note(format!("it connects {names}"));
                    return None;
                };
                Some((Change::Field { joint, end, v: *v, u: *u }, Quantity::Number))
            }
        }
    }

    fn times(&mut self) {
        let times = &self.draft.times;
        let here = Here { section: Section::Time, index: 0 };
        if times.is_empty() {
            self.fault("HP0219", here.key(""), "there are no output times")
                .help("give a `[time]` table with `end` and `steps`");
        } else if let Some(k) =
            (0..times.len()).find(|&k| !times[k].is_finite() || (k > 0 && times[k] <= times[k - 1]))
        {
            self.fault("HP0219", here.key(""), "output times must be finite and increase").note(format!(
                "time number {} is {} s",
                k + 1,
                times[k]
            ));
        }
    }
}

/// The place of a joint that needs none, until it gets one.
const UNPLACED: HardpointId = HardpointId(usize::MAX);

fn degrees_between(a: Vec3, b: Vec3) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos().to_degrees()
}

/// Which number each name has; of equal names, the first.
fn numbered<'a>(names: impl Iterator<Item = &'a str>) -> HashMap<&'a str, usize> {
    let mut numbers = HashMap::new();
    for (k, name) in names.enumerate() {
        numbers.entry(name).or_insert(k);
    }
    numbers
}

/// The frame with z along `z` and x along `x`, two unit vectors square to each other.
fn frame_along(z: Vec3, x: Vec3) -> Mat3 {
    Mat3 { cols: [x, z.cross(x), z] }
}
