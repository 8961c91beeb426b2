//! Random mechanisms. A case's number decides all of it.

use hardpoint::joint::{ALL, JointType, Need, Quantity, named};
use hardpoint::law::Law;
use hardpoint::space::{Mat3, Pose, Vec3};
use hardpoint::{draft::*, model::*};

use super::rank::{Basis, coupler_row, driver_row, joint_rows};

/// A row of an exactly determined mechanism keeps at least this part of its length beside the rows before it. Weaker
/// ones exist in practice, but near a singular position nothing smooth can be requested.
const WELL_POSED: f64 = 0.05;

/// Steele's, Lea's and Flood's splitmix64: small, and good enough to draw with.
pub struct Rng(u64);

impl Rng {
    pub fn new(family: u64, case: u64) -> Self {
        let mut rng =
            Self(family.wrapping_mul(0xA076_1D64_78BD_642F) ^ case.wrapping_mul(0xE703_7ED1_A0B4_28DB));
        rng.next();
        rng
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Between these, either sign.
    fn signed(&mut self, low: f64, high: f64) -> f64 {
        let x = self.between(low, high);
        if self.chance(0.5) { -x } else { x }
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    pub fn chance(&mut self, p: f64) -> bool {
        self.unit() < p
    }

    pub fn pick<T: Clone>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())].clone()
    }

    /// Any direction, unit length.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.in_box(1.0);
            if (0.1..1.0).contains(&v.norm()) {
                return v.unit().expect("not null");
            }
        }
    }

    fn in_box(&mut self, half: f64) -> Vec3 {
        Vec3::new(self.between(-half, half), self.between(-half, half), self.between(-half, half))
    }

    pub fn pose(&mut self, half: f64) -> Pose {
        let turn = self.direction() * self.between(0.0, 3.0);
        Pose { rot: Mat3::from_rotation_vector(turn), r: self.in_box(half) }
    }

    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for k in (1..list.len()).rev() {
            list.swap(k, self.below(k + 1));
        }
    }
}

/// A draft that grows, closed in the design configuration at every moment.
pub struct Drawing<'r> {
    pub rng: &'r mut Rng,
    pub draft: Draft,
    /// The edge of the box that it is drawn in, m.
    pub size: f64,
    basis: Basis,
    /// All moving joints of a planar mechanism have their axes along z of this pose; its places are in its x-y plane.
    plane: Option<Pose>,
}

/// An exactly determined spatial mechanism: a tree of joints, closed by joints whose rows fit, driven on the rest.
pub fn spatial(rng: &mut Rng) -> Option<Draft> {
    let bodies = 2 + rng.below(7);
    let mut d = Drawing::new(rng, bodies);
    for b in 1..=bodies {
        let parent = if d.rng.chance(0.3) { 0 } else { d.rng.below(b) };
        let kind = d.tree_kind();
        let ends = if d.rng.chance(0.8) { [parent, b] } else { [b, parent] };
        let mut joint = d.joint(kind, ends);
        joint.cut = d.rng.chance(0.2);
        d.draft.joints.push(joint);
    }
    let model = Model::from_draft(&d.draft).unwrap_or_else(|f| panic!("{f:?}"));
    for k in 0..bodies {
        if !d.basis.add_all(joint_rows(&model, k, d.size), WELL_POSED) {
            return None;
        }
    }
    for _ in 0..2 * bodies + 1 {
        match d.rng.below(6) {
            0 => d.try_coupler(),
            _ => d.try_closing(),
        }
    }
    d.rods_become_bodies();
    d.drive().then_some(())?;
    d.furnish();
    Some(d.draft)
}

/// A planar linkage of revolute and translational joints of space, somewhere in space: three redundant rows per loop.
pub fn planar(rng: &mut Rng) -> Option<Draft> {
    let mut d = Drawing::new(rng, 0);
    d.plane = Some(d.rng.pose(0.5 * d.size));
    let drivers = 1 + d.rng.below(2);
    for _ in 0..drivers {
        let crank = d.body();
        let base = d.rng.below(crank);
        let kind = if d.rng.chance(0.8) { "revolute" } else { "translational" };
        let joint = d.planar_joint(kind, [base, crank]);
        let drives = DrivenDraft::Coordinate { joint: joint.name.clone(), coordinate: None };
        d.draft.joints.push(joint);
        d.driver(drives);
    }
    for _ in 0..1 + d.rng.below(3) {
        // An Assur group of two bodies between two others; three slides do not hold it.
        let ends = d.two_bodies();
        let (c, e) = (d.body(), d.body());
        let mut slides = 0;
        for bodies in [[ends[0], c], [c, e], [e, ends[1]]] {
            let slide = slides < 1 && d.rng.chance(0.25);
            slides += usize::from(slide);
            let joint = d.planar_joint(if slide { "translational" } else { "revolute" }, bodies);
            d.draft.joints.push(joint);
        }
    }
    if d.rng.chance(0.4) {
        // A rocker on a rod.
        let rocker = d.body();
        let pivot = d.planar_joint("revolute", [0, rocker]);
        d.draft.joints.push(pivot);
        let other = 1 + d.rng.below(rocker - 1);
        let rod = d.planar_joint("distance", [other, rocker]);
        d.draft.joints.push(rod);
    }
    for _ in 0..d.rng.below(3) {
        // Constraints that the plane keeps anyway.
        let kind = d.rng.pick(&["planar", "inplane", "parallel"]);
        let ends = d.two_bodies();
        let joint = d.planar_joint(kind, ends);
        d.draft.joints.push(joint);
    }
    d.furnish();
    Some(d.draft)
}

/// Shafts coupled by gears, belts, racks and screws, and cams with their followers.
pub fn train(rng: &mut Rng) -> Option<Draft> {
    let mut d = Drawing::new(rng, 0);
    let first = d.body();
    let mut joint = d.joint(named("revolute")?, [0, first]);
    joint.name = "shaft".into();
    d.draft.joints.push(joint);
    let law = d.law_of(1.0, 5.0);
    let drives = DrivenDraft::Coordinate { joint: "shaft".into(), coordinate: None };
    d.draft.drivers.push(DriverDraft::new("motor", drives, law));
    // Joints with an angle, and the body that each turns.
    let mut shafts = vec![("shaft".to_string(), first)];
    for _ in 0..1 + d.rng.below(6) {
        let base = if d.rng.chance(0.6) { 0 } else { d.rng.pick(&shafts).1 };
        let (from, turning) = d.rng.pick(&shafts);
        let body = d.body();
        let name = d.new_joint_name();
        let joints = [from.clone(), name.clone()];
        match d.rng.below(6) {
            0 | 1 => {
                let mut joint = d.joint(named("revolute")?, [base, body]);
                joint.name = name.clone();
                joint.cut = d.rng.chance(0.2);
                d.draft.joints.push(joint);
                let ratio = [d.rng.between(0.5, 2.0), d.rng.between(0.5, 2.0)];
                let by = if d.rng.chance(0.5) {
                    Transmission::Gears {
                        teeth: ratio.map(|r| (20.0 * r).round()),
                        internal: d.rng.chance(0.3),
                        bevel: false,
                    }
                } else {
                    Transmission::Belt { radii: ratio.map(|r| 0.1 * r * d.size), crossed: d.rng.chance(0.3) }
                };
                d.coupler(CouplerKindDraft::Pair { by, joints });
                shafts.push((name, body));
            }
            2 => {
                let mut joint = d.joint(named("translational")?, [base, body]);
                joint.name = name.clone();
                joint.cut = d.rng.chance(0.2);
                d.draft.joints.push(joint);
                let radius = d.rng.signed(0.01, 0.05) * d.size;
                let by = Transmission::Rack { radius };
                d.coupler(CouplerKindDraft::Pair { by, joints: [name, from] });
            }
            3 => {
                // A nut that turns with a shaft.
                let mut joint = d.joint(named("screw")?, [base, body]);
                joint.name = name.clone();
                d.draft.joints.push(joint);
                let term = |joint: &str, coefficient: f64| TermDraft {
                    joint: joint.into(),
                    coordinate: Some("angle".into()),
                    coefficient,
                };
                let ratio = d.rng.signed(0.5, 2.0);
                d.coupler(CouplerKindDraft::Linear(vec![term(&from, 1.0), term(&name, ratio)]));
                shafts.push((name, body));
            }
            4 if shafts.len() > 1 => {
                // A sum of two turns.
                let mut joint = d.joint(named("cylindrical")?, [base, body]);
                joint.name = name.clone();
                d.draft.joints.push(joint);
                let mut two = shafts.clone();
                d.rng.shuffle(&mut two);
                let mut terms: Vec<TermDraft> = two[..2]
                    .iter()
                    .map(|(name, _)| TermDraft {
                        joint: name.clone(),
                        coordinate: Some("angle".into()),
                        coefficient: 0.0,
                    })
                    .collect();
                terms.push(TermDraft {
                    joint: name.clone(),
                    coordinate: Some("angle".into()),
                    coefficient: 0.0,
                });
                terms.iter_mut().for_each(|t| t.coefficient = d.rng.signed(0.5, 2.0));
                d.coupler(CouplerKindDraft::Linear(terms));
                let length = vec![
                    TermDraft {
                        joint: name.clone(),
                        coordinate: Some("displacement".into()),
                        coefficient: 1.0,
                    },
                    TermDraft { joint: from, coordinate: Some("angle".into()), coefficient: 0.02 * d.size },
                ];
                d.coupler(CouplerKindDraft::Linear(length));
                shafts.push((name, body));
            }
            _ => {
                d.cam(turning, &from, body, name);
            }
        }
    }
    d.furnish();
    Some(d.draft)
}

/// A mechanism with rods of other lengths than drawn, and joints drawn apart.
pub fn open(rng: &mut Rng) -> Option<Draft> {
    let mut draft = if rng.chance(0.8) { spatial(rng)? } else { planar(rng)? };
    let planar = draft.name == "planar";
    let model = Model::from_draft(&draft).ok()?;
    let size = model.size();
    let mut opened = 0;
    for (j, joint) in draft.joints.iter_mut().zip(&model.joints) {
        let [a, b] = joint.at.map(|h| model.hardpoints[h.0].position);
        if joint.kind.coordinates.iter().any(|c| c.name == "length") && rng.chance(0.7) {
            j.length = Some((b - a).norm() * rng.between(0.95, 1.05));
            opened += 1;
        } else if joint.kind.places == 1 && j.at.len() == 1 && rng.chance(0.15) && !planar {
            j.at.push(LocationDraft::At(a + rng.direction() * (size * rng.between(0.001, 0.01))));
            opened += 1;
        }
    }
    draft.name = "open".into();
    (opened > 0).then_some(draft)
}

impl<'r> Drawing<'r> {
    fn new(rng: &'r mut Rng, bodies: usize) -> Self {
        let size = 10.0_f64.powf(rng.between(-1.0, 1.0));
        let n = 5 + rng.below(4);
        // Some start at rest where they are drawn, some on the way.
        let start = if rng.chance(0.75) { 0.0 } else { rng.between(-0.3, 0.3) };
        let times = (0..n).map(|k| start + k as f64 / (n - 1) as f64).collect();
        let mut drawing = Self {
            rng,
            draft: Draft { name: "random".into(), times, ..Draft::default() },
            size,
            basis: Basis::default(),
            plane: None,
        };
        for _ in 0..bodies {
            drawing.body();
        }
        drawing
    }

    /// A new body; its number.
    fn body(&mut self) -> usize {
        let number = self.draft.bodies.len() + 1;
        let frame = if self.rng.chance(0.5) {
            FrameDraft::Default
        } else {
            FrameDraft::Pose(self.rng.pose(0.5 * self.size))
        };
        self.draft.bodies.push(BodyDraft { name: format!("b{number}"), frame });
        number
    }

    fn name(&self, body: usize) -> String {
        if body == 0 { "ground".into() } else { self.draft.bodies[body - 1].name.clone() }
    }

    fn new_joint_name(&self) -> String {
        format!("j{}", self.draft.joints.len())
    }

    fn two_bodies(&mut self) -> [usize; 2] {
        let n = self.draft.bodies.len() + 1;
        let a = self.rng.below(n);
        let b = (a + 1 + self.rng.below(n - 1)) % n;
        [a, b]
    }

    fn spot(&mut self) -> Vec3 {
        let mut p = self.rng.in_box(0.5 * self.size);
        if let Some(plane) = self.plane {
            p.z = 0.0;
            p = plane.point(p);
        }
        p
    }

    /// A place there, by coordinates or by a new hardpoint's name.
    fn place(&mut self, position: Vec3) -> LocationDraft {
        if self.rng.chance(0.4) {
            return LocationDraft::At(position);
        }
        let name = format!("h{}", self.draft.hardpoints.len());
        self.draft.hardpoints.push(HardpointDraft::new(name.clone(), position));
        LocationDraft::Hardpoint(name)
    }

    /// Somewhere, now and then at a hardpoint that is there already.
    fn somewhere(&mut self) -> (LocationDraft, Vec3) {
        if !self.draft.hardpoints.is_empty() && self.rng.chance(0.15) {
            let h = self.rng.pick(&self.draft.hardpoints);
            return (LocationDraft::Hardpoint(h.name), h.position);
        }
        let p = self.spot();
        (self.place(p), p)
    }

    /// A line that way: along a vector of some length, or through two hardpoints.
    fn line(&mut self, along: Vec3) -> DirectionDraft {
        if self.rng.chance(0.7) {
            return DirectionDraft::Along(along * self.rng.between(0.3, 3.0));
        }
        let from = self.spot();
        let to = from + along * (self.size * self.rng.between(0.3, 0.6));
        let n = self.draft.hardpoints.len();
        let names = [n, n + 1].map(|k| format!("h{k}"));
        for (name, position) in names.iter().zip([from, to]) {
            self.draft.hardpoints.push(HardpointDraft::new(name.clone(), position));
        }
        DirectionDraft::Through(names[0].clone(), names[1].clone())
    }

    /// A direction perpendicular to that one.
    fn square_to(&mut self, z: Vec3) -> Vec3 {
        let v = loop {
            let v = z.cross(self.rng.direction());
            if v.norm() > 0.3 {
                break v;
            }
        };
        v.unit().expect("not null")
    }

    /// Types that can carry a tree, the common ones more often.
    fn tree_kind(&mut self) -> &'static JointType {
        let kinds: Vec<&'static JointType> = ALL.iter().copied().filter(|t| t.freedoms.is_some()).collect();
        loop {
            let kind = self.rng.pick(&kinds);
            if self.rng.chance(1.0 / (1.0 + 0.5 * kind.freedom_count().unwrap_or(6) as f64)) {
                return kind;
            }
        }
    }

    /// A joint of that type anywhere, closed in the design configuration.
    fn joint(&mut self, kind: &'static JointType, bodies: [usize; 2]) -> JointDraft {
        let z = self.rng.direction();
        let mut j = JointDraft {
            name: self.new_joint_name(),
            kind: if kind.aliases.is_empty() || self.rng.chance(0.7) {
                kind.name
            } else {
                self.rng.pick(kind.aliases)
            }
            .into(),
            bodies: bodies.map(|b| self.name(b)),
            ..JointDraft::default()
        };
        if ![Need::Unused, Need::Orienting].contains(&kind.axis) {
            j.axis = Some(self.line(z));
        }
        j.axis2 = match kind.axis2 {
            Need::Unused | Need::Orienting => None,
            Need::Required | Need::Optional => {
                let x = self.square_to(z);
                Some(self.line(x))
            }
            Need::OnBodyJ => {
                let x = self.square_to(z);
                let angle = self.rng.between(0.2, 0.8);
                let other = z * angle.cos() + x * angle.sin();
                Some(self.line(other))
            }
        };
        let (first, p) = self.somewhere();
        match kind.places {
            0 => {}
            1 => match &j.axis {
                Some(DirectionDraft::Through(..)) if self.rng.chance(0.3) => {}
                _ => j.at = vec![first],
            },
            _ => {
                let mut d = self.rng.direction() * (self.size * self.rng.between(0.3, 0.8));
                if kind.name == "dot2" {
                    d = d - z * z.dot(d);
                }
                if kind.name == "point_on_curve" {
                    d = self.curve(&mut j, p, z);
                }
                j.at = vec![first, self.place(p + d)];
                let rod = kind.coordinates.iter().any(|c| c.name == "length");
                if rod && self.rng.chance(0.4) {
                    j.length = Some(d.norm());
                }
            }
        }
        if kind.name == "screw" {
            j.lead = Some(self.rng.signed(0.3, 1.0) * self.size);
        }
        j
    }

    /// A closed curve without sharp bends about a place, for a joint along z; the way from there to the point that
    /// follows.
    fn curve(&mut self, j: &mut JointDraft, p: Vec3, z: Vec3) -> Vec3 {
        let x = self.square_to(z);
        let y = z.cross(x);
        let radius = self.size * self.rng.between(0.15, 0.3);
        let waves: Vec<[f64; 2]> = (1..=3)
            .map(|n| [self.rng.between(0.0, 0.08 / f64::from(n * n)), self.rng.between(0.0, 6.25)])
            .collect();
        let at = |angle: f64, r: f64| x * (r * angle.cos()) + y * (r * angle.sin());
        let r = |angle: f64| {
            let waves = waves.iter().enumerate();
            radius * (1.0 + waves.map(|(n, [a, b])| a * ((n + 1) as f64 * angle + b).sin()).sum::<f64>())
        };
        let n = 12 + self.rng.below(20);
        let points = (0..n).map(|k| std::f64::consts::TAU * k as f64 / n as f64);
        let points = points.map(|angle| LocationDraft::At(p + at(angle, r(angle)))).collect();
        j.curve = Some(CurveDraft { points, closed: true });
        let angle = self.rng.between(0.0, 6.25);
        let above = z * (self.size * self.rng.between(-0.1, 0.1));
        at(angle, r(angle) + self.size * self.rng.between(0.01, 0.1)) + above
    }

    /// A cam on a body that turns about a joint, and its follower on a slide across the axis.
    fn cam(&mut self, turning: usize, shaft: &str, follower: usize, name: String) {
        let model = Model::from_draft(&Draft {
            bodies: self.draft.bodies[..follower - 1].to_vec(),
            ..self.draft.clone()
        });
        let model = model.unwrap_or_else(|f| panic!("{f:?}"));
        let shaft = model.joints.iter().find(|j| j.name == *shaft).expect("a shaft");
        let (z, p) = (shaft.frames[0].cols[2], model.hardpoints[shaft.at[0].0].position);
        let base = usize::from(shaft.bodies[1].0 == turning);
        let base = shaft.bodies[1 - base].0;
        let bodies = [turning, follower].map(|b| self.name(b));
        let mut j = JointDraft {
            name,
            kind: "cam".into(),
            bodies,
            axis: Some(DirectionDraft::Along(z)),
            ..JointDraft::default()
        };
        let d = self.curve(&mut j, p, z);
        j.at = vec![LocationDraft::At(p), LocationDraft::At(p + d)];
        let way = (d - z * z.dot(d)).unit().expect("off the axis");
        self.draft.joints.push(j);
        let mut slide = self.joint(named("translational").expect("a type"), [base, follower]);
        slide.axis = Some(DirectionDraft::Along(way));
        slide.at = vec![LocationDraft::At(p + d)];
        self.draft.joints.push(slide);
    }

    fn try_closing(&mut self) {
        let (bodies, kind) = (self.two_bodies(), self.rng.pick(ALL));
        let before = self.draft.hardpoints.len();
        let mut joint = self.joint(kind, bodies);
        joint.cut = self.rng.chance(0.1);
        self.draft.joints.push(joint);
        let model = Model::from_draft(&self.draft).unwrap_or_else(|f| panic!("{f:?}"));
        let rows = joint_rows(&model, self.draft.joints.len() - 1, self.size);
        let free = 6 * self.draft.bodies.len() - self.basis.rank();
        let fits = rows.len() < free && model.idle.is_empty() && self.basis.add_all(rows, WELL_POSED);
        if !fits {
            self.draft.joints.pop();
            self.draft.hardpoints.truncate(before);
        }
    }

    fn try_coupler(&mut self) {
        let mut coordinates = self.coordinates();
        coordinates.retain(|(_, _, c)| c.name != "length");
        self.rng.shuffle(&mut coordinates);
        if coordinates.len() < 2 {
            return;
        }
        let quantity = |k: usize| coordinates[k].2.quantity;
        let joints = [0, 1].map(|k: usize| coordinates[k].0.clone());
        let are =
            |names: [&str; 2]| (0..2).all(|k| coordinates[k].2.name == names[k]) && joints[0] != joints[1];
        let kind = if are(["angle", "angle"]) && self.rng.chance(0.5) {
            let teeth = [self.rng.between(10.0, 40.0), 21.0];
            let by = Transmission::Gears { teeth, internal: self.rng.chance(0.5), bevel: false };
            CouplerKindDraft::Pair { by, joints }
        } else if are(["displacement", "angle"]) {
            let radius = self.rng.signed(0.1, 0.5) * self.size;
            CouplerKindDraft::Pair { by: Transmission::Rack { radius }, joints }
        } else {
            let n = usize::min(coordinates.len(), 2 + self.rng.below(2));
            let term = |k: usize, x: f64| TermDraft {
                joint: coordinates[k].0.clone(),
                coordinate: Some(coordinates[k].1.clone()),
                coefficient: x / if quantity(k) == Quantity::Length { self.size } else { 1.0 },
            };
            let factors: Vec<f64> = (0..n).map(|_| self.rng.signed(0.5, 2.0)).collect();
            CouplerKindDraft::Linear(factors.into_iter().enumerate().map(|(k, x)| term(k, x)).collect())
        };
        self.coupler(kind);
        let model = Model::from_draft(&self.draft).unwrap_or_else(|f| panic!("{f:?}"));
        let row = coupler_row(&model, self.draft.couplers.len() - 1, self.size);
        let free = 6 * self.draft.bodies.len() - self.basis.rank();
        if !(free > 1 && model.idle.is_empty() && self.basis.add_all(vec![row], WELL_POSED)) {
            self.draft.couplers.pop();
        }
    }

    fn coupler(&mut self, kind: CouplerKindDraft) {
        let name = format!("c{}", self.draft.couplers.len());
        self.draft.couplers.push(CouplerDraft { name, kind, constant: 0.0 });
    }

    /// All coordinates of joints that are not constant: joint, name, type.
    fn coordinates(&self) -> Vec<(String, String, &'static hardpoint::joint::CoordinateType)> {
        let kinds = self.draft.joints.iter().map(|j| (j, named(&j.kind).expect("a type")));
        let all = kinds.flat_map(|(j, t)| t.coordinates.iter().map(move |c| (j, t, c)));
        let loose = all.filter(|(_, t, c)| !t.rows.contains(&c.row));
        loose.map(|(j, _, c)| (j.name.clone(), c.name.to_string(), c)).collect()
    }

    /// Some rods become bodies between two balls, which can spin.
    fn rods_become_bodies(&mut self) {
        for k in 0..self.draft.joints.len() {
            let j = self.draft.joints[k].clone();
            let plain = j.length.is_none() && self.draft.bodies.len() < 8;
            let spheres =
                |b: &String| self.draft.joints.iter().any(|j| j.kind == "spherical" && j.bodies.contains(b));
            if named(&j.kind).is_some_and(|t| t.name == "distance")
                && plain
                && self.rng.chance(0.3)
                && !j.bodies.iter().any(spheres)
            {
                let rod = self.body();
                for (e, place) in j.at.iter().enumerate() {
                    let bodies = if e == 0 {
                        [j.bodies[0].clone(), self.name(rod)]
                    } else {
                        [self.name(rod), j.bodies[1].clone()]
                    };
                    let name = if e == 0 { j.name.clone() } else { format!("{}_far", j.name) };
                    let ball = JointDraft {
                        name,
                        kind: "spherical".into(),
                        bodies,
                        at: vec![place.clone()],
                        ..JointDraft::default()
                    };
                    if e == 0 { self.draft.joints[k] = ball } else { self.draft.joints.push(ball) }
                }
            }
        }
        // What holds now, a new body's six columns included.
        let model = Model::from_draft(&self.draft).unwrap_or_else(|f| panic!("{f:?}"));
        self.basis = Basis::default();
        for k in 0..model.joints.len() {
            self.basis.add_all(joint_rows(&model, k, self.size), 0.0);
        }
        for c in 0..self.draft.couplers.len() {
            self.basis.add_all(vec![coupler_row(&model, c, self.size)], 0.0);
        }
    }

    /// Drivers for all that is left free; whether that worked.
    fn drive(&mut self) -> bool {
        let unknowns = 6 * self.draft.bodies.len();
        let mut least = WELL_POSED;
        for attempt in 0..40 * unknowns {
            if self.basis.rank() == unknowns {
                return true;
            }
            if attempt % (8 * unknowns) == 8 * unknowns - 1 {
                least *= 0.5;
            }
            let before = (self.draft.hardpoints.len(), self.draft.drivers.len());
            // A driver on a rod that could spin would make its spin count.
            let idle = Model::from_draft(&self.draft).map_or(0, |m| m.idle.len());
            let drives = self.something_to_drive();
            self.driver(drives);
            let fits = match Model::from_draft(&self.draft) {
                Ok(model) if model.idle.len() != idle => false,
                Ok(model) => {
                    let row = driver_row(&model, model.drivers.len() - 1, self.size);
                    self.basis.add_all(vec![row], least)
                }
                Err(_) => false, // the same coordinate twice
            };
            if !fits {
                self.draft.hardpoints.truncate(before.0);
                self.draft.drivers.truncate(before.1);
            }
        }
        false
    }

    fn something_to_drive(&mut self) -> DrivenDraft {
        let coordinates = self.coordinates();
        let body = 1 + self.rng.below(self.draft.bodies.len());
        let form = self.rng.below(10);
        if form < 6 && !coordinates.is_empty() {
            let (joint, coordinate, _) = self.rng.pick(&coordinates);
            return DrivenDraft::Coordinate { joint, coordinate: Some(coordinate) };
        }
        match form % 3 {
            0 => {
                let (point, along) = (self.point_on(body), self.rng.direction());
                DrivenDraft::Position { point, along: self.line(along) }
            }
            1 => {
                let ends = self.two_bodies();
                let (a, d) = (self.spot(), self.rng.direction() * (0.5 * self.size));
                let on = |body: String, at: LocationDraft| PointRef::On { body, at };
                let (from, to) = (self.place(a), self.place(a + d));
                DrivenDraft::Distance { from: on(self.name(ends[0]), from), to: on(self.name(ends[1]), to) }
            }
            _ => {
                let about = self.rng.direction();
                let about = self.line(about);
                let others: Vec<usize> = (1..=self.draft.bodies.len()).filter(|b| *b != body).collect();
                let other = (self.rng.chance(0.3) && !others.is_empty()).then(|| self.rng.pick(&others));
                let relative_to = other.map(|b| self.name(b));
                DrivenDraft::Orientation { body: self.name(body), relative_to, about, axis2: None }
            }
        }
    }

    fn point_on(&mut self, body: usize) -> PointRef {
        let (at, _) = self.somewhere();
        PointRef::On { body: self.name(body), at }
    }

    fn driver(&mut self, drives: DrivenDraft) {
        let length = match &drives {
            DrivenDraft::Coordinate { joint, coordinate } => {
                let joint = self.draft.joints.iter().find(|j| j.name == *joint).expect("that joint");
                let kind = named(&joint.kind).expect("a type");
                let c = coordinate
                    .as_ref()
                    .map_or(Some(&kind.coordinates[0]), |c| kind.coordinate(c).map(|c| c.1));
                c.expect("that coordinate").quantity == Quantity::Length
            }
            DrivenDraft::Position { .. } | DrivenDraft::Distance { .. } => true,
            DrivenDraft::Orientation { .. } => false,
            DrivenDraft::Measure(_) | DrivenDraft::Contact(_) | DrivenDraft::Unread => {
                unreachable!("none is drawn here")
            }
        };
        let (low, high) = if length { (0.01 * self.size, 0.08 * self.size) } else { (0.05, 0.4) };
        let law = self.law_of(low, high);
        let name = format!("d{}", self.draft.drivers.len());
        self.draft.drivers.push(DriverDraft::new(name, drives, law));
    }

    /// A smooth law that is zero at t = 0, whatever its parameters.
    fn law_of(&mut self, low: f64, high: f64) -> Law {
        let a = self.rng.signed(low, high);
        let w = self.rng.between(1.0, 4.0);
        let text = self.rng.pick(&[
            "a*sin(w*t)",
            "a*(1-cos(w*t))",
            "a*t*exp(-t*t/w)",
            "a*(t-t^2/w)",
            "a*tanh(w*t)",
            "a*t",
        ]);
        let parameters = [("a", a), ("w", w)];
        let used = if text.contains('w') { 2 } else { 1 };
        Law::parse_with(text, &parameters[..used]).unwrap_or_else(|e| panic!("{text}: {e:?}"))
    }

    /// A planar joint through a place of the plane, off it by any way along the axis.
    fn planar_joint(&mut self, kind: &str, bodies: [usize; 2]) -> JointDraft {
        let plane = self.plane.expect("a plane");
        let off = plane.rot.cols[2] * (self.size * self.rng.between(-0.3, 0.3));
        let kind = named(kind).expect("a type");
        let at = |d: &mut Self| {
            let p = d.spot() + off;
            d.place(p)
        };
        let angle = self.rng.between(0.0, 6.25);
        let x = plane.rot.cols[0] * angle.cos() + plane.rot.cols[1] * angle.sin();
        let is_moving = |need: Need| ![Need::Unused, Need::Orienting].contains(&need);
        let places = kind.places;
        let at = (0..places).map(|_| at(self)).collect();
        let axis = match kind.name {
            "translational" => Some(x),
            _ => is_moving(kind.axis).then_some(plane.rot.cols[2]),
        };
        JointDraft {
            name: self.new_joint_name(),
            kind: kind.name.into(),
            bodies: bodies.map(|b| self.name(b)),
            at,
            axis: axis.map(DirectionDraft::Along),
            axis2: is_moving(kind.axis2).then_some(DirectionDraft::Along(x)),
            ..JointDraft::default()
        }
    }

    /// Points, measures and design variables.
    fn furnish(&mut self) {
        if self.plane.is_some() {
            self.draft.name = "planar".into();
        }
        for b in 1..=self.draft.bodies.len() {
            // The default frame of a body whose joints have no places is the global one, which does not move along.
            let name = self.name(b);
            if !self.draft.joints.iter().any(|j| j.bodies.contains(&name) && !j.at.is_empty()) {
                self.draft.bodies[b - 1].frame = FrameDraft::Pose(self.rng.pose(0.5 * self.size));
            }
            let at = self.spot();
            let at = self.place(at);
            let point = PointDraft::new(format!("p{b}"), self.name(b), at);
            self.draft.points.push(point);
        }
        let kinds: Vec<_> =
            self.draft.joints.iter().map(|j| (j.name.clone(), named(&j.kind).expect("a type"))).collect();
        let mut measured: Vec<_> = kinds
            .iter()
            .flat_map(|(name, t)| t.coordinates.iter().map(move |c| (name.clone(), c.name.to_string())))
            .collect();
        self.rng.shuffle(&mut measured);
        for (joint, coordinate) in measured.into_iter().take(6) {
            self.measure(MeasureKindDraft::Coordinate { joint, coordinate: Some(coordinate) });
        }
        let body = 1 + self.rng.below(self.draft.bodies.len());
        let [a, b] = self.two_bodies();
        let from = self.spot();
        let to = from + self.rng.direction() * (0.5 * self.size);
        let (from, to) = (self.place(from), self.place(to));
        let on = |body: String, at: LocationDraft| PointRef::On { body, at };
        self.measure(MeasureKindDraft::Distance { from: on(self.name(a), from), to: on(self.name(b), to) });
        let along = self.rng.direction();
        self.measure(MeasureKindDraft::Coordinates { point: PointRef::Named(format!("p{body}")), along });
        // Away from the vertical, where toe has no value.
        let (turn, rise) = (self.rng.between(-0.5, 0.5), self.rng.between(-0.3, 0.3));
        let spin = Vec3::new(turn, 1.0, rise);
        let (toe, camber) = (self.line(spin), self.line(spin));
        self.measure(MeasureKindDraft::Toe { body: self.name(body), spin_axis: toe });
        self.measure(MeasureKindDraft::Camber { body: self.name(body), spin_axis: camber });
        let position = format!("m{}", self.draft.measures.len() - 3);
        let moving = || PointRef::Named(format!("p{body}"));
        let (velocity, acceleration) = (Some(spin), Some(along));
        self.measure(MeasureKindDraft::Velocity { point: moving(), along: velocity });
        self.measure(MeasureKindDraft::Acceleration { point: moving(), along: acceleration });
        self.measure(MeasureKindDraft::AngularVelocity { body: self.name(body), along: velocity });
        let ray = |body: String, axis: Vec3| RayDraft::Fixed { body, axis: DirectionDraft::Along(axis) };
        let (from, to) = (ray(self.name(a), spin), ray(self.name(b), along));
        self.measure(MeasureKindDraft::Angle { from, to, about: None });
        let driven = self.draft.drivers.iter().find_map(|d| match &d.drives {
            DrivenDraft::Coordinate { joint, coordinate } => Some((d, joint.clone(), coordinate.clone())),
            _ => None,
        });
        if let Some((driver, joint, coordinate)) = driven {
            let (over, driver) = (format!("m{}", self.draft.measures.len()), Some(driver.name.clone()));
            self.measure(MeasureKindDraft::Coordinate { joint, coordinate });
            let drivers = driver.clone().map(|driver| vec![driver]);
            self.measure(MeasureKindDraft::Slope {
                of: position,
                over,
                driver,
                together: None,
                opposed: None,
            });
            let at = LocationDraft::At([0.1, 0.2, -0.1].into());
            let points = vec![PointRef::On { body: self.name(body), at }];
            let value = Some(JacobianValue::LeastGain);
            self.measure(MeasureKindDraft::Dexterity { points, drivers, value });
        }
        for _ in 0..3 + self.rng.below(4) {
            self.variable();
        }
    }

    fn measure(&mut self, kind: MeasureKindDraft) {
        let name = format!("m{}", self.draft.measures.len());
        self.draft.measures.push(MeasureDraft::new(name, kind));
    }

    fn variable(&mut self) {
        let mut changes = Vec::new();
        let parts = if self.rng.chance(0.8) { 1 } else { 2 };
        while changes.len() < parts {
            let j = self.rng.pick(&self.draft.joints);
            let joint = j.name.clone();
            let (p, w) = (self.rng.direction(), self.rng.direction() * self.rng.between(0.3, 1.0));
            let end = self.rng.pick(&[End::I, End::J, End::Both, End::Both]);
            let (position, rotation) = match self.rng.below(3) {
                0 => (p, Vec3::ZERO),
                1 => (Vec3::ZERO, w),
                _ => (p, w * (1.0 / self.size)),
            };
            changes.push(match self.rng.below(8) {
                0 | 1 if !self.draft.hardpoints.is_empty() => {
                    let hardpoint = self.rng.pick(&self.draft.hardpoints).name;
                    let velocity = match self.plane {
                        Some(plane) if self.rng.chance(0.7) => {
                            p - plane.rot.cols[2] * plane.rot.cols[2].dot(p)
                        }
                        _ => p,
                    };
                    ChangeDraft::Move { hardpoint, velocity }
                }
                2 => ChangeDraft::Tilt { joint, about: DirectionDraft::Along(w) },
                3 | 4 => ChangeDraft::Marker { joint, end, position, rotation },
                5 if j.length.is_some() => ChangeDraft::Length { joint, rate: self.rng.signed(0.5, 2.0) },
                6 if !self.draft.drivers.is_empty() => {
                    let driver = self.rng.pick(&self.draft.drivers);
                    let parameters = driver.law.parameters();
                    let parameter = self.rng.pick(&parameters).name;
                    ChangeDraft::Law { driver: driver.name, parameter, rate: self.rng.signed(0.2, 1.0) }
                }
                7 => {
                    let posed = |b: &&String| {
                        self.draft
                            .bodies
                            .iter()
                            .any(|x| x.name == **b && matches!(x.frame, FrameDraft::Pose(_)))
                    };
                    let Some(body) = j.bodies.iter().find(posed).cloned() else { continue };
                    ChangeDraft::Field { joint, body, v: position, u: rotation }
                }
                _ => continue,
            });
        }
        let name = format!("v{}", self.draft.design.len());
        let fixed_length = self.rng.chance(0.25);
        self.draft.design.push(VariableDraft { name, changes, fixed_length, ..VariableDraft::default() });
    }
}

/// A draft of any other family with something in it that makes no sense.
pub fn nonsense(rng: &mut Rng) -> Option<Draft> {
    let mut d = match rng.below(4) {
        0 => planar(rng)?,
        1 => train(rng)?,
        2 => open(rng)?,
        _ => spatial(rng)?,
    };
    for _ in 0..1 + rng.below(3) {
        spoil(&mut d, rng);
    }
    Some(d)
}

fn spoil(d: &mut Draft, rng: &mut Rng) {
    if d.joints.len() < 2 || d.drivers.is_empty() {
        return;
    }
    let joint = rng.below(d.joints.len());
    let any = |rng: &mut Rng| {
        rng.pick(&[0.0, 1e-12, -1e-9, 1e-6, 1.0, -3.0, 1e6, 1e12, f64::NAN, f64::INFINITY, f64::MIN_POSITIVE])
    };
    let factor = 10.0_f64.powf(rng.between(-6.0, 6.0));
    match rng.below(20) {
        0 => d.drivers.truncate(rng.below(d.drivers.len() + 1)),
        1 => {
            let mut again = d.drivers[rng.below(d.drivers.len())].clone();
            again.name = "again".into();
            d.drivers.push(again);
        }
        2 => {
            let body = d.bodies[rng.below(d.bodies.len())].name.clone();
            let about = DirectionDraft::Along(rng.direction());
            let drives = DrivenDraft::Orientation { body, relative_to: None, about, axis2: None };
            d.drivers.push(DriverDraft::new("more", drives, Law::constant(0.0)));
        }
        3 => each_place(d, &mut |p| *p = *p * factor),
        4 => each_place(d, &mut |p| p.z = 0.0),
        5 => each_place(d, &mut |p| *p = Vec3::ZERO),
        6 => {
            let z = rng.direction();
            d.joints
                .iter_mut()
                .filter(|j| j.axis.is_some())
                .for_each(|j| j.axis = Some(DirectionDraft::Along(z)));
        }
        7 => {
            for j in d.joints.iter_mut().filter(|j| j.at.len() == 2) {
                j.at[1] = j.at[0].clone();
            }
        }
        8 => d.joints[joint].length = Some(any(rng)),
        9 => d.joints[joint].lead = Some(any(rng)),
        10 => d.joints[joint].axis = Some(DirectionDraft::Along(Vec3::new(any(rng), any(rng), 0.0))),
        11 => d.joints[joint].kind = rng.pick(ALL).name.into(),
        12 => d.joints[joint].bodies.swap(0, 1),
        13 => d.joints.iter_mut().for_each(|j| j.cut = true),
        14 => drop(d.joints.remove(joint)),
        15 => {
            let text = rng.pick(&[
                "1/t",
                "sqrt(t-0.5)",
                "tan(3*t)",
                "1e3*t",
                "abs(t-0.5)",
                "1e-9*sin(1e4*t)",
                "1e300*t",
                "exp(40*t)",
            ]);
            let k = rng.below(d.drivers.len().max(1));
            if let (Some(driver), Ok(law)) = (d.drivers.get_mut(k), Law::parse(text)) {
                driver.law = law;
                d.design.clear();
            }
        }
        16 => d.times.iter_mut().for_each(|t| *t *= factor),
        17 => {
            if let Some(h) = d.hardpoints.first_mut() {
                h.position = h.position * factor;
            }
        }
        18 => {
            for c in &mut d.couplers {
                match &mut c.kind {
                    CouplerKindDraft::Linear(terms) => terms[0].coefficient = any(rng),
                    CouplerKindDraft::Pair { by, .. } => match by {
                        Transmission::Gears { teeth, .. } => teeth[1] = any(rng),
                        Transmission::Belt { radii, .. } => radii[0] = any(rng),
                        Transmission::Rack { radius } => *radius = any(rng),
                        Transmission::Screw { lead } => *lead = any(rng),
                    },
                }
            }
        }
        _ => {
            for v in d.design.iter_mut().flat_map(|v| &mut v.changes) {
                if let ChangeDraft::Marker { position, rotation, .. } = v {
                    (*position, *rotation) = (*position * factor, *rotation * factor);
                }
            }
            for m in &mut d.measures {
                if let MeasureKindDraft::Distance { from, to } = &mut m.kind {
                    *to = from.clone();
                }
            }
        }
    }
}

/// Changes all hardpoints and places of joints.
fn each_place(d: &mut Draft, change: &mut dyn FnMut(&mut Vec3)) {
    d.hardpoints.iter_mut().for_each(|h| change(&mut h.position));
    for place in d.joints.iter_mut().flat_map(|j| &mut j.at) {
        if let LocationDraft::At(p) = place {
            change(p);
        }
    }
}
