//! Live axles of Project Chrono's vehicle module: one rigid axle between both wheels. The file describes the left side;
//! the right side is its mirror image, as in Chrono.

use hardpoint::space::Vec3;

use crate::chrono_part::{self, Masses};
use crate::corner::{Corner, Role, plain, spin_axis};
use crate::mechanism::{Coordinate, Drives, GROUND, Joint, Law, Mechanism};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::{SIDES, over};
use crate::tree::Tree;
use crate::{axle, robot};

/// Templates that are read here.
pub const TEMPLATES: [&str; 6] = [
    "SolidAxle",
    "SolidThreeLinkAxle",
    "SolidBellcrankThreeLinkAxle",
    "RigidPanhardAxle",
    "PanhardAxle",
    "DeDionAxle",
];

struct Axle<'r> {
    root: &'r Tree,
    m: Mechanism,
    notes: &'r mut ImportLog,
    /// Parts of the file that were read.
    read: Vec<&'static str>,
}

/// Reads a live axle; `angles` are the static camber and toe of the wheels, rad.
pub fn read(
    root: &Tree,
    m: Mechanism,
    template: &str,
    angles: [f64; 2],
    notes: &mut ImportLog,
) -> Option<Mechanism> {
    let mut axle = Axle { root, m, notes, read: Vec::new() };
    axle.build(template, angles);
    let Axle { m, read, notes, .. } = axle;
    chrono_part::account(root, &read, &[], notes);
    Some(m)
}

impl Axle<'_> {
    fn at(&self, part: &str) -> Option<SourceSpan> {
        self.root.get(part).map(|t| t.at)
    }

    /// Returns a location of a part, by the first of some keys that is present. A missing location is reported.
    fn place(&mut self, parts: &[&'static str], names: &[&str]) -> Option<Vec3> {
        let found = parts.iter().find_map(|p| Some((*p, self.root.get(p)?)));
        let Some((part, tree)) = found else {
            let message = format!("the part `{}` is missing", parts[0]);
            self.notes.problem_with(
                "HP0803",
                Some(self.root.at),
                message,
                "add the part, or export the template again",
            );
            return None;
        };
        self.read.push(part);
        let Some(place) = names.iter().find_map(|n| tree.get(n)) else {
            let message = format!("`{part}` has no `{}`", names[0]);
            self.notes.problem_with("HP0803", Some(tree.at), message, "add it as a list of three numbers");
            return None;
        };
        let v = place.vector();
        if v.is_none() {
            let message = format!("`{}` of `{part}` must be three numbers", names[0]);
            let help = "write it as a list like `[0, 0.7, 0.2]`";
            self.notes.problem_with("HP0804", Some(place.at), message, help);
        }
        v.map(Vec3::from)
    }

    fn body(&mut self, name: &str, at: Vec3) -> usize {
        axle::body(&mut self.m, name, at)
    }

    fn hardpoint(&mut self, name: &str, at: Vec3) {
        self.m.hardpoints.push((name.to_owned(), at));
    }

    /// Adds a rod between two bodies, with both ends as hardpoints.
    fn rod(
        &mut self,
        name: &str,
        bodies: [usize; 2],
        ends: [Vec3; 2],
        words: [&str; 2],
        at: Option<SourceSpan>,
    ) {
        axle::ends(&mut self.m, name, ends, words);
        axle::rod(&mut self.m, self.notes, name, bodies, ends, at);
    }

    /// Returns the ends of a member on the vehicle and on the axle.
    fn ends(&mut self, part: &'static str) -> Option<[Vec3; 2]> {
        let chassis = self.place(&[part], &["Location Chassis"]);
        let outer = self.place(&[part], &["Location Axle"]);
        Some([chassis?, outer?])
    }

    /// Adds a rod on each side, from the vehicle body to the axle.
    fn rods(&mut self, part: &'static str, axle: usize) {
        let Some(ends) = self.ends(part) else { return };
        let at = self.at(part);
        for (side, suffix) in SIDES {
            let name = format!("{}{suffix}", plain(part));
            self.rod(&name, [GROUND, axle], ends.map(|p| over(p, side)), ["chassis", "axle"], at);
        }
    }

    /// Adds a spring or damper on each side. Returns its ends on the left, if the part is present.
    fn legs(&mut self, part: &'static str, draw: &'static str, axle: usize) -> Option<[Vec3; 2]> {
        self.root.get(part)?;
        let ends = self.ends(part).filter(|[c, a]| c != a)?;
        let at = self.at(part);
        for (side, suffix) in SIDES {
            let (name, places) = (format!("{draw}{suffix}"), ends.map(|p| over(p, side)));
            axle::ends(&mut self.m, &name, places, ["chassis", "axle"]);
            axle::leg(&mut self.m, self.notes, &name, [GROUND, axle], places, draw, at);
        }
        Some(ends)
    }

    /// Adds a triangular link with a hinge about y on the vehicle body and a ball joint on the axle.
    fn triangle(&mut self, axle: usize) {
        let part = "Triangular Link";
        let Some(ends) = self.ends(part) else { return };
        // Chrono uses the midpoint between both sides.
        let [pivot, ball] = ends.map(middle);
        let body = self.body("triangle", pivot);
        for (name, at) in [("triangle_chassis", pivot), ("triangle_axle", ball)] {
            self.hardpoint(name, at);
        }
        let y = Vec3::from([0.0, 1.0, 0.0]);
        self.m.joint(Joint::new("triangle_pivot", String::new(), "revolute", [GROUND, body], pivot).along(y));
        self.m.joint(Joint::new("triangle_ball", String::new(), "spherical", [body, axle], ball));
        self.notes.taken("arm", "triangle", self.at(part));
    }

    /// Adds the left and right knuckles with their kingpins on the axle.
    fn knuckles(&mut self, axle: usize) -> Option<[(usize, [Vec3; 2]); 2]> {
        let part = "Knuckle";
        let lower = self.place(&[part], &["Location Lower"]);
        let upper = self.place(&[part], &["Location Upper"]);
        let (Some(l), Some(u)) = (lower, upper) else { return None };
        if l == u {
            let message = "both points of the kingpin coincide";
            self.notes.problem_with("HP0804", self.at(part), message, "correct one of them");
            return None;
        }
        Some(SIDES.map(|(side, suffix)| {
            let [l, u] = [over(l, side), over(u, side)];
            let body = self.body(&format!("knuckle{suffix}"), (l + u) * 0.5);
            self.hardpoint(&format!("kingpin_lower{suffix}"), l);
            self.hardpoint(&format!("kingpin_upper{suffix}"), u);
            let name = format!("kingpin{suffix}");
            self.m.joint(Joint::new(&name, String::new(), "revolute", [axle, body], l).through(l, u));
            self.notes.taken("joint", &name, self.at(part));
            (body, [l, u])
        }))
    }

    /// Adds the drag link from the steering to the bell crank. The steering slides along the larger component of the
    /// drag link.
    fn drag_link(&mut self, crank: usize) -> Option<()> {
        let part = "Draglink";
        let from = self.place(&[part], &["Location Steering", "Location Chassis"]);
        let to = self.place(&[part], &["Location Bellcrank", "Location Bell Crank"]);
        let (from, to) = (from?, to?);
        let rack = self.body("steering_link", from);
        let along = to - from;
        let axis: [f64; 3] = if along.x.abs() > along.y.abs() { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let slide = self.m.joint(
            Joint::new("steering_slide", String::new(), "translational", [GROUND, rack], from)
                .along(axis.into()),
        );
        let drives = Drives::Coordinate(Coordinate { joint: slide, name: "displacement" });
        let steering = self.m.driver(
            "steering",
            "no law in the source: fixed in the design configuration".into(),
            drives,
            Law::Fixed,
        );
        self.m.steering = Some(steering);
        let why = "the steering is in another file: its link slides along the drag link, and a driver fixes it in the design configuration";
        self.notes.approximated("motion", "steering_slide", self.at(part), why);
        self.rod("drag_link", [rack, crank], [from, to], ["steering", "crank"], self.at(part));
        Some(())
    }

    /// Adds the bell crank on the axle, the drag link and the tie rods.
    fn steering(&mut self, template: &str, axle: usize, knuckles: &[(usize, [Vec3; 2]); 2]) -> Option<()> {
        let crank = ["Bellcrank", "Bell Crank"];
        let pivot = self.place(&crank, &["Location Axle"])?;
        let tie = self.place(&crank, &["Location Tierod"])?;
        let drag = self.place(&["Draglink"], &["Location Bellcrank", "Location Bell Crank"])?;
        let at = self.at("Bellcrank").or_else(|| self.at("Bell Crank"));
        let body = self.body("bell_crank", pivot);
        self.hardpoint("bell_crank_pivot", pivot);
        let is_solid = template == "SolidAxle";
        let z = Vec3::from([0.0, 0.0, 1.0]);
        let axis = if is_solid { (drag - pivot).cross(tie - pivot) } else { z };
        let Some(axis) = axis.unit() else {
            let message = "the points of the bell crank are collinear and define no axis";
            self.notes.problem_with("HP0804", at, message, "correct one of them");
            return None;
        };
        self.m.joint(
            Joint::new("bell_crank_pivot", String::new(), "revolute", [axle, body], pivot).along(axis),
        );
        if is_solid {
            let ends = self.place(&["Tierod"], &["Location Knuckle"])?;
            let [left, right] = [over(ends, 1.0), over(ends, -1.0)];
            if left == right {
                let message = "both ends of the tie rod coincide";
                self.notes.problem_with("HP0804", self.at("Tierod"), message, "correct its y coordinate");
                return None;
            }
            let rod = self.body("tie_rod", (left + right) * 0.5);
            for (name, at) in [("tie_rod_left", left), ("tie_rod_right", right), ("bell_crank_tie_rod", tie)]
            {
                self.hardpoint(name, at);
            }
            let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
            self.m.joint(Joint::new("tie_rod_left", String::new(), "spherical", [rod, knuckles[0].0], left));
            self.m.joint(
                Joint::new("tie_rod_right", String::new(), "universal", [rod, knuckles[1].0], right)
                    .with_axes(x, z),
            );
            // The crank guides the tie rod: its point stays in a plane of the rod.
            self.m.joint(
                Joint::new("bell_crank_guide", String::new(), "inplane", [rod, body], tie).with_axes(y, x),
            );
            self.notes.taken("link", "tie_rod", self.at("Tierod"));
        } else {
            let outer = self.place(&["Knuckle"], &["Location Tierod"])?;
            if self.root.get("Tierod").is_some() {
                self.read.push("Tierod");
            }
            for ((side, suffix), (knuckle, _)) in SIDES.into_iter().zip(knuckles) {
                let name = format!("tie_rod{suffix}");
                let ends = [over(tie, side), over(outer, side)];
                self.rod(&name, [body, *knuckle], ends, ["inner", "outer"], self.at("Knuckle"));
            }
        }
        self.notes.taken("rocker", "bell_crank", at);
        self.drag_link(body)
    }

    fn build(&mut self, template: &str, [camber, toe]: [f64; 2]) -> Option<()> {
        let spindle = self.place(&["Spindle"], &["COM", "Location"]);
        let part = "Axle Tube";
        let centre = self.place(&[part], &["COM"]);
        let (Some(spindle), Some(centre)) = (spindle, centre) else { return None };
        let axle = self.body("axle", centre);
        self.notes.taken("body", "axle", self.at(part));
        let mut knuckles = None;
        match template {
            "SolidAxle" => {
                self.rods("Upper Link", axle);
                self.rods("Lower Link", axle);
                knuckles = self.knuckles(axle);
            }
            "SolidThreeLinkAxle" | "SolidBellcrankThreeLinkAxle" => {
                self.triangle(axle);
                self.rods("Longitudinal Link", axle);
                if template == "SolidBellcrankThreeLinkAxle" {
                    knuckles = self.knuckles(axle);
                }
            }
            "DeDionAxle" => {
                if let Some(ball) = self.place(&[part], &["Location Connector"]) {
                    self.hardpoint("axle_ball", ball);
                    self.m.joint(Joint::new("axle_ball", String::new(), "spherical", [GROUND, axle], ball));
                }
                let middle = middle(spindle);
                self.hardpoint("axle_middle", middle);
                let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
                self.m.joint(
                    Joint::new("axle_guide", String::new(), "inplane", [GROUND, axle], middle)
                        .with_axes(y, x),
                );
                let why = "the Watt linkage is replaced by a lateral plane for its midpoint: the file has no points of the linkage";
                self.notes.approximated("joint", "axle_guide", self.at(part), why);
            }
            _ => {
                let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
                self.m.joint(
                    Joint::new("axle_guide", String::new(), "planar", [GROUND, axle], centre).with_axes(x, y),
                );
                self.notes.taken("joint", "axle_guide", self.at(part));
                if let Some(ends) = self.ends("Panhard Rod") {
                    let at = self.at("Panhard Rod");
                    self.rod("panhard_rod", [GROUND, axle], ends, ["chassis", "axle"], at);
                }
            }
        }
        if let Some(knuckles) = &knuckles {
            self.steering(template, axle, knuckles);
        }
        let legs = [("Spring", "spring"), ("Shock", "damper")]
            .map(|(part, draw)| (draw, self.legs(part, draw, axle)));
        if self.notes.problem_count() > 0 {
            return None;
        }
        let springs =
            chrono_part::springs(self.root, &[("Spring", "spring"), ("Shock", "damper")], self.notes);
        for (k, (side, suffix)) in SIDES.into_iter().enumerate() {
            let centre = over(spindle, side);
            self.hardpoint(&format!("spindle{suffix}"), centre);
            let mut corner = Corner {
                suffix: suffix.into(),
                spin_axis: Some(spin_axis(side, camber, toe)),
                rack: knuckles.is_some(),
                springs: springs.clone(),
                at: self.at("Spindle"),
                ..Corner::default()
            };
            let ends_of = |ends: [Vec3; 2]| [(GROUND, over(ends[0], side)), (axle, over(ends[1], side))];
            for (draw, ends) in legs.iter().filter_map(|(draw, ends)| Some((draw, ends.as_ref()?))) {
                corner.force(&mut self.m, self.notes, draw, ends_of(*ends));
            }
            let mut carrier = axle;
            if let Some(knuckles) = &knuckles {
                let (body, [lower, upper]) = knuckles[k];
                carrier = body;
                corner.points.extend([(Role::LowerOuter, lower), (Role::UpperOuter, upper)]);
            }
            corner.wheel(&mut self.m, self.notes, carrier, centre, legs[0].1.map(ends_of));
        }
        self.masses(template, [camber, toe], knuckles.is_some());
        Some(())
    }

    /// Adds the masses of the parts to their bodies, or to the ends of rods.
    fn masses(&mut self, template: &str, [camber, toe]: [f64; 2], has_knuckles: bool) {
        let root = self.root;
        let point = |part: &str, key: &str| root.get(part).and_then(|p| p.get(key)?.vector()).map(Vec3::from);
        let mut masses = Masses { root, m: &mut self.m, notes: self.notes, side: 1.0, suffix: "" };
        masses.on("Axle Tube", "axle", None, None);
        let ends = |part: &str| {
            point(part, "Location Chassis").zip(point(part, "Location Axle")).map(<[Vec3; 2]>::from)
        };
        if let Some(ends) = ends("Triangular Link").map(|ends| ends.map(middle)) {
            masses.on("Triangular Link", "triangle", Some((ends[0] + ends[1]) * 0.5), None);
        }
        if let Some(ends) = ends("Panhard Rod") {
            masses.rod("Panhard Rod", ["ground", "axle"], ends);
        }
        let crank = if root.get("Bellcrank").is_some() { "Bellcrank" } else { "Bell Crank" };
        let first = |part, keys: [&str; 2]| keys.iter().find_map(|key| point(part, key));
        let drag = first("Draglink", ["Location Steering", "Location Chassis"])
            .zip(first("Draglink", ["Location Bellcrank", "Location Bell Crank"]));
        if let Some((from, to)) = drag {
            masses.rod("Draglink", ["steering_link", "bell_crank"], [from, to]);
            let places = point(crank, "Location Axle").zip(point(crank, "Location Tierod"));
            if let Some((pivot, tie)) = places {
                let is_solid = template == "SolidAxle";
                // On four-link axles the axes of the crank are those of the drag link, perpendicular to its plane with
                // the lower link.
                let lower = point("Lower Link", "Location Axle").filter(|_| is_solid);
                let axes = lower.and_then(|l| chrono_part::link_axes(from - to, (to - l).cross(from - l)));
                let centre = if is_solid { (to + pivot + tie) * (1.0 / 3.0) } else { pivot };
                masses.on(crank, "bell_crank", Some(centre), axes);
            }
        }
        if let Some(end) = point("Tierod", "Location Knuckle") {
            masses.on("Tierod", "tie_rod", Some(middle(end)), None);
        }
        let ties = point(crank, "Location Tierod").zip(point("Knuckle", "Location Tierod"));
        for (side, suffix) in SIDES {
            let mut masses = Masses { side, suffix, ..masses.again() };
            let carrier = if has_knuckles { format!("knuckle{suffix}") } else { "axle".into() };
            masses.on("Spindle", &carrier, None, chrono_part::spindle_axes(spin_axis(side, camber, toe)));
            masses.on("Knuckle", &carrier, None, None);
            for part in ["Upper Link", "Lower Link", "Longitudinal Link"] {
                if let Some(ends) = ends(part) {
                    masses.rod(part, ["ground", "axle"], ends);
                }
            }
            if let Some((inner, outer)) = ties {
                masses.rod("Tierod", ["bell_crank", &carrier], [inner, outer]);
            }
        }
        robot::standard_gravity(&mut self.m, self.notes, "a Chrono suspension");
    }
}

/// Returns the midpoint between both sides.
fn middle(v: Vec3) -> Vec3 {
    Vec3::from([v.x, 0.0, v.z])
}
