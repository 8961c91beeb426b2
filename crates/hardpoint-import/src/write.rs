//! Writer of model files.

use std::collections::HashSet;

use hardpoint::joint::DIRECTION_NAMES;
use hardpoint::space::{Mat3, Quat, Vec3};
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, Value, value};

use crate::mechanism::{Drives, ForceOn, GROUND, Law, Mechanism, valid_name};
use crate::sides::{self, over, with_word};

/// Distance below which points are one hardpoint, as a fraction of the mechanism size; typed coordinates agree to about
/// this.
pub(crate) const SAME_PLACE: f64 = 1e-9;
/// Coordinates below this fraction of the mechanism size are round-off.
const ROUND_OFF: f64 = 1e-13;
/// Maximum number of hardpoints with automatic design variables: a page with three hundred is of no use.
const MOST_VARIED: usize = 24;
/// Default number of intervals in one second.
const STEPS: i64 = 100;

/// Returns the text of a model file. For a symmetric vehicle, only the left side is written, with a mirror.
pub fn text(mechanism: &Mechanism, about: &str) -> String {
    Writer::new(mechanism, sides::symmetry(mechanism)).text(about)
}

/// Returns the text of a model file with all bodies and joints of the mechanism, in its order.
pub fn explicit(mechanism: &Mechanism, about: &str) -> String {
    Writer::new(mechanism, None).text(about)
}

struct Writer<'m> {
    m: &'m Mechanism,
    size: f64,
    hardpoints: Vec<(String, Vec3)>,
    /// Names of the hardpoints in use.
    named: HashSet<String>,
    /// Joints of the right side that are written although there is a mirror; `None` without a mirror.
    mirror: Option<HashSet<&'m str>>,
}

impl<'m> Writer<'m> {
    fn new(m: &'m Mechanism, mirror: Option<HashSet<&'m str>>) -> Self {
        let mut hardpoints: Vec<(String, Vec3)> = Vec::new();
        for (name, at) in &m.hardpoints {
            let name = free_name(name, &hardpoints);
            hardpoints.push((name, *at));
        }
        Self { m, size: m.size(), hardpoints, named: HashSet::new(), mirror }
    }

    /// Returns the hardpoint at a position, which is added if necessary.
    fn hardpoint(&mut self, wanted: &str, at: Vec3) -> String {
        let near = |p: &Vec3| (*p - at).norm() <= SAME_PLACE * self.size;
        if let Some((name, _)) = self.hardpoints.iter().find(|(_, p)| near(p)) {
            self.named.insert(name.clone());
            return name.clone();
        }
        let name = free_name(wanted, &self.hardpoints);
        self.hardpoints.push((name.clone(), at));
        self.named.insert(name.clone());
        name
    }

    fn text(mut self, about: &str) -> String {
        let m = self.m;
        let joints = self.joints();
        let wheels = self.wheels();
        let mut doc = DocumentMut::new();
        doc["name"] = value(m.name.as_str());
        doc["description"] = value(about);
        let mut units = InlineTable::new();
        units.insert("length", m.length.into());
        units.insert("angle", m.angle.into());
        doc["units"] = value(units);

        if self.mirror.is_some() {
            let mut table = Table::new();
            table["across"] = value("y");
            table
                .decor_mut()
                .set_prefix(format!("\n{}", comment("the right side is the mirror image of the left side")));
            doc["mirror"] = Item::Table(table);
        }
        put(&mut doc, "vehicle", self.vehicle());
        let mut table = Table::new();
        for (name, at) in self.hardpoints.iter().filter(|h| !self.is_image_of_one(h)) {
            table[name] = value(self.place(*at));
        }
        put(&mut doc, "hardpoints", table);
        put(&mut doc, "bodies", self.one_side(self.bodies()));
        put(&mut doc, "joints", self.one_side(joints));
        put(&mut doc, "couplers", self.couplers());
        put(&mut doc, "drivers", self.one_side(self.drivers()));
        put(&mut doc, "design", self.design());
        put(&mut doc, "points", self.one_side(self.points()));
        put(&mut doc, "wheels", self.one_side(wheels));
        put(&mut doc, "axles", self.axles());
        if let Some(gravity) = m.gravity {
            let mut table = Table::new();
            table["along"] = direction(gravity);
            table["acceleration"] = value(gravity.norm());
            put(&mut doc, "gravity", table);
        }
        put(&mut doc, "masses", self.one_side(self.masses()));
        put(&mut doc, "forces", self.one_side(self.forces()));
        put(&mut doc, "cases", self.cases());
        let mut time = Table::new();
        match m.times {
            Some(t) => {
                if t.start != 0.0 {
                    time["start"] = value(t.start);
                }
                time["end"] = value(t.end);
                time["steps"] = value(i64::try_from(t.steps).unwrap_or(STEPS));
            }
            None => {
                time["end"] = value(1.0);
                time["steps"] = value(STEPS);
            }
        }
        put(&mut doc, "time", time);
        doc.to_string()
    }

    /// Removes the entries that the mirror creates from the left side.
    fn one_side(&self, mut table: Table) -> Table {
        if let Some(written) = &self.mirror {
            let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
            let images =
                names.iter().filter(|name| sides::is_right(name) && !written.contains(name.as_str()));
            images.for_each(|name| drop(table.remove(name)));
        }
        table
    }

    /// Returns true if the mirror creates this hardpoint from one of the left side.
    fn is_image_of_one(&self, (name, at): &(String, Vec3)) -> bool {
        self.mirror.is_some() && sides::is_right(name) && self.is_image(&sides::other(name), *at)
    }

    /// Returns true if the hardpoint of that name is the mirror image of a point.
    fn is_image(&self, name: &str, at: Vec3) -> bool {
        let image = over(at, -1.0);
        self.hardpoints.iter().any(|(n, p)| n == name && (*p - image).norm() <= SAME_PLACE * self.size)
    }

    fn vehicle(&self) -> Table {
        let v = &self.m.vehicle;
        let figures = [
            ("wheelbase", v.wheelbase),
            ("cg_height", v.cg_height),
            ("front_brake_share", v.front_brake_share),
            ("front_drive_share", v.front_drive_share),
        ];
        let mut table = Table::new();
        figures.into_iter().filter_map(|(key, x)| Some((key, x?))).for_each(|(key, x)| table[key] = value(x));
        table
    }

    fn axles(&self) -> Table {
        let mut table = Table::new();
        let [left, right] = self.m.wheels.as_slice() else { return table };
        if sides::other(&left.name) == right.name && left.name != right.name {
            let mut axle = InlineTable::new();
            axle.insert("left", left.name.as_str().into());
            axle.insert("right", right.name.as_str().into());
            axle.insert("measures", "all".into());
            table[left.end.map_or("axle", |end| end.name())] = value(axle);
        }
        table
    }

    fn cases(&self) -> Table {
        let mut table = Table::new();
        for case in &self.m.cases {
            let mut laws = InlineTable::new();
            for (driver, law) in &case.laws {
                laws.insert(self.m.drivers[*driver].name.as_str(), law.as_str().into());
            }
            let mut entry = InlineTable::new();
            entry.insert("laws", laws.into());
            table[case.name] = value(entry);
        }
        table
    }

    fn bodies(&self) -> Table {
        let mut table = Table::new();
        for body in &self.m.bodies[1..] {
            let mut entry = InlineTable::new();
            if let Some(pose) = body.pose {
                let mut frame = InlineTable::new();
                frame.insert("position", self.place(pose.r).into());
                let q = Quat::from_rotation(pose.rot).to_array();
                if q[1..].iter().any(|x| x.abs() > ROUND_OFF) {
                    frame.insert("quaternion", numbers(&q.map(|x| clean(x, ROUND_OFF))).into());
                }
                entry.insert("frame", frame.into());
            }
            if let Some(mesh) = &body.mesh {
                let mut m = InlineTable::new();
                m.insert("file", mesh.file.as_str().into());
                m.insert("frame", "body".into());
                entry.insert("mesh", m.into());
            }
            table[&body.name] = value(entry);
            if let Some(mut key) = table.key_mut(&body.name) {
                key.leaf_decor_mut().set_prefix(comment(&body.note));
            }
        }
        table
    }

    fn joints(&mut self) -> Table {
        let m = self.m;
        let mut table = Table::new();
        for joint in &m.joints {
            let mut t = Table::new();
            t["type"] = value(joint.kind);
            t["bodies"] = value(joint.bodies.iter().map(|b| m.bodies[*b].name.as_str()).collect::<Array>());
            let kind = joint.joint_type();
            // Joints that only constrain directions need no location.
            if kind.is_none_or(|k| k.places > 0) {
                match joint.at[..] {
                    [at] => t["at"] = value(self.hardpoint(&joint.name, at)),
                    [i, j] => {
                        let [i, j] = [("i", i), ("j", j)]
                            .map(|(end, at)| self.hardpoint(&with_word(&joint.name, end), at));
                        t["at"] = value([i, j].into_iter().collect::<Array>());
                    }
                    _ => {}
                }
            }
            match (joint.through, joint.axis) {
                (Some(ends), _) => t["axis"] = value(self.through(&joint.name, ends)),
                (None, Some(axis)) => t["axis"] = direction(axis),
                (None, None) => {}
            }
            if let Some(axis) = joint.axis2 {
                t["axis2"] = direction(axis);
            }
            if let Some(lead) = joint.lead {
                t["lead"] = value(lead);
            }
            if let Some(length) = joint.length {
                t["length"] = value(length);
            }
            if let Some(draw) = joint.draw {
                t["draw"] = value(draw);
            }
            if !joint.limits.is_empty() {
                let limits = joint.limits.iter().map(|limit| (limit.of, Value::from(range(limit.range))));
                t["limits"] = value(limits.collect::<InlineTable>());
            }
            decorate(&mut t, &joint.note);
            table[&joint.name] = Item::Table(t);
        }
        table
    }

    /// Writes a direction from one hardpoint to another.
    fn through(&mut self, name: &str, [from, to]: [Vec3; 2]) -> InlineTable {
        let ends = [("from", from), ("to", to)].map(|(end, at)| self.hardpoint(&with_word(name, end), at));
        let mut axis = InlineTable::new();
        axis.insert("through", ends.into_iter().collect::<Array>().into());
        axis
    }

    fn couplers(&self) -> Table {
        let mut table = Table::new();
        for coupler in &self.m.couplers {
            let mut t = Table::new();
            t["type"] = value("linear");
            let terms = coupler.terms.iter().map(|(c, factor)| {
                let mut term = InlineTable::new();
                term.insert("joint", self.m.joints[c.joint].name.as_str().into());
                term.insert("coordinate", c.name.into());
                term.insert("coefficient", (*factor).into());
                term
            });
            t["terms"] = value(terms.collect::<Array>());
            if coupler.constant != 0.0 {
                t["constant"] = value(coupler.constant);
            }
            decorate(&mut t, &coupler.note);
            table[&coupler.name] = Item::Table(t);
        }
        table
    }

    /// Writes a point of a body, as a hardpoint if there is one.
    fn point(&self, body: usize, at: Vec3) -> Value {
        self.point_at(body, at, &self.hardpoints)
    }

    /// Writes a point of a body, as one of the given hardpoints if it coincides with one.
    fn point_at(&self, body: usize, at: Vec3, hardpoints: &[(String, Vec3)]) -> Value {
        let mut point = InlineTable::new();
        point.insert("body", self.m.bodies[body].name.as_str().into());
        let name = hardpoints.iter().find(|h| (h.1 - at).norm() <= SAME_PLACE * self.size);
        point.insert("at", name.map_or_else(|| self.place(at).into(), |(name, _)| name.as_str().into()));
        point.into()
    }

    /// Writes masses, whose centres follow the hardpoints of the source.
    fn masses(&self) -> Table {
        let mut table = Table::new();
        for mass in &self.m.masses {
            let mut entry = InlineTable::new();
            entry.insert("type", "rigid".into());
            entry.insert(
                "centre",
                self.point_at(mass.body, mass.centre, &self.hardpoints[..self.m.hardpoints.len()]),
            );
            entry.insert("mass", mass.mass.into());
            if let Some(inertia) = mass.inertia {
                let i = |r: usize, c: usize| inertia.cols[c][r];
                let most = i(0, 0).max(i(1, 1)).max(i(2, 2));
                // Products of inertia are the negative entries of the matrix.
                let moments = [("ixx", i(0, 0)), ("iyy", i(1, 1)), ("izz", i(2, 2))];
                let products = [("ixy", -i(0, 1)), ("iyz", -i(1, 2)), ("izx", -i(2, 0))];
                moments.into_iter().for_each(|(key, x)| drop(entry.insert(key, x.into())));
                let products = products.into_iter().filter(|(_, x)| x.abs() > ROUND_OFF * most);
                products.for_each(|(key, x)| drop(entry.insert(key, x.into())));
            }
            table[&mass.name] = value(entry);
        }
        table
    }

    fn forces(&self) -> Table {
        let mut table = Table::new();
        for force in &self.m.forces {
            let spring = &force.spring;
            let mut t = Table::new();
            match force.on {
                ForceOn::Coordinate(c) => {
                    let turns = c.name.starts_with("angle");
                    t["type"] = value(if turns { "torsion_spring" } else { "joint_spring" });
                    t["joint"] = value(self.m.joints[c.joint].name.as_str());
                    t["coordinate"] = value(c.name);
                    t["stiffness"] = value(spring.stiffness);
                    spring.free.filter(|x| *x != 0.0).into_iter().for_each(|x| t["equilibrium"] = value(x));
                }
                ForceOn::Points(ends) => {
                    t["type"] = value("spring");
                    for (key, (body, at)) in ["from", "to"].into_iter().zip(ends) {
                        t[key] = value(self.point(body, at));
                    }
                    if spring.stiffness != 0.0 || spring.extension.is_empty() {
                        t["stiffness"] = value(spring.stiffness);
                    }
                    if !spring.extension.is_empty() {
                        let points = spring.extension.iter().map(|p| Value::from(numbers(p)));
                        t["extension"] = value(points.collect::<Array>());
                    }
                    spring.free.into_iter().for_each(|x| t["free_length"] = value(x));
                    spring.preload.into_iter().for_each(|x| t["preload"] = value(x));
                }
                ForceOn::Bushing(ends, bushing) => {
                    t["type"] = value("bushing");
                    for (key, (body, at)) in ["from", "to"].into_iter().zip(ends) {
                        t[key] = value(self.point(body, at));
                    }
                    let Mat3 { cols: [x, _, z] } = bushing.axes;
                    if (z - Vec3::AXES[2]).norm() > ROUND_OFF || (x - Vec3::AXES[0]).norm() > ROUND_OFF {
                        t["axis"] = direction(z);
                        t["axis2"] = direction(x);
                    }
                    for (k, name) in DIRECTION_NAMES.iter().enumerate() {
                        // Stiffnesses along the axes are required.
                        if k < 3 || bushing.stiffness[k] != 0.0 {
                            t[name] = value(bushing.stiffness[k]);
                        }
                    }
                    for (name, preload) in DIRECTION_NAMES.iter().zip(bushing.preload) {
                        if preload != 0.0 {
                            t[&format!("preload_{name}")] = value(preload);
                        }
                    }
                }
                ForceOn::Joint(joint, elasticity) => {
                    t["type"] = value("elastic_joint");
                    t["joint"] = value(self.m.joints[joint].name.as_str());
                    for (name, stiffness) in DIRECTION_NAMES.iter().zip(elasticity.stiffness) {
                        if stiffness != 0.0 {
                            t[name] = value(stiffness);
                        }
                    }
                    if let Some(matrix) = elasticity.matrix(self.m.per_angle()) {
                        t["matrix"] =
                            value(matrix.iter().map(|row| Value::from(numbers(row))).collect::<Array>());
                    }
                }
                ForceOn::Constant((body, at), force) => {
                    t["type"] = value("force");
                    t["at"] = value(self.point(body, at));
                    t["force"] = value(force.norm());
                    t["along"] = direction(force);
                }
            }
            if spring.damping != 0.0 {
                t["damping"] = value(spring.damping);
            }
            decorate(&mut t, &force.note);
            table[&force.name] = Item::Table(t);
        }
        table
    }

    fn drivers(&self) -> Table {
        let m = self.m;
        let mut table = Table::new();
        for driver in &m.drivers {
            let mut t = Table::new();
            match driver.drives {
                Drives::Coordinate(c) => {
                    t["joint"] = value(m.joints[c.joint].name.as_str());
                    t["coordinate"] = value(c.name);
                }
                Drives::Translation { body, at, along } => {
                    t["point"] = value(self.point(body, at));
                    t["along"] = direction(along);
                }
                Drives::Rotation { body, about, relative_to } => {
                    t["body"] = value(m.bodies[body].name.as_str());
                    t["about"] = direction(about);
                    if relative_to != GROUND {
                        t["relative_to"] = value(m.bodies[relative_to].name.as_str());
                    }
                }
            }
            match &driver.law {
                Law::Fixed => t["law"] = value(0),
                Law::Constant(x) => t["law"] = value(*x),
                Law::Text(text) => t["law"] = value(text.as_str()),
                Law::Table(points) => {
                    let mut law = InlineTable::new();
                    law.insert("type", "table".into());
                    law.insert(
                        "points",
                        points.iter().map(|p| Value::from(numbers(p))).collect::<Array>().into(),
                    );
                    law.insert("ends", "natural".into());
                    t["law"] = value(law);
                }
            }
            decorate(&mut t, &driver.note);
            table[&driver.name] = Item::Table(t);
        }
        table
    }

    /// Writes variables that move hardpoints; those of the left side also move their mirror images.
    fn design(&self) -> Table {
        let mut table = Table::new();
        let twin = |(name, at): &(String, Vec3)| {
            let other = sides::other(name);
            (other != *name && self.is_image(&other, *at)).then_some(other)
        };
        // Unused hardpoints have no effect.
        let used = self.hardpoints.iter().filter(|h| self.named.contains(&h.0));
        let own: Vec<(&(String, Vec3), Option<String>)> =
            used.map(|h| (h, twin(h))).filter(|(h, twin)| twin.is_none() || !sides::is_right(&h.0)).collect();
        if own.len() > MOST_VARIED {
            return table;
        }
        for ((name, _), twin) in &own {
            let base =
                sides::base(name).filter(|base| twin.is_some() && own.iter().all(|(h, _)| h.0 != *base));
            let base = base.as_deref().unwrap_or(name);
            let variable = |axes: &str| {
                let mut entry = InlineTable::new();
                entry.insert("move", name.as_str().into());
                entry.insert("along", axes.into());
                if let (Some(twin), None) = (twin, &self.mirror) {
                    entry.insert("mirror", "y".into());
                    entry.insert("mirrored", twin.as_str().into());
                }
                value(entry)
            };
            let followed = |axis: &&str| !self.m.inadmissible.contains(&format!("{base}_{axis}"));
            let axes: Vec<&str> = ["x", "y", "z"].into_iter().filter(followed).collect();
            match axes[..] {
                [_, _, _] => table[base] = variable("xyz"),
                _ => axes.iter().for_each(|axis| table[&format!("{base}_{axis}")] = variable(axis)),
            }
        }
        table
    }

    fn points(&self) -> Table {
        let mut table = Table::new();
        for point in &self.m.points {
            let mut entry = InlineTable::new();
            entry.insert("body", self.m.bodies[point.body].name.as_str().into());
            entry.insert("at", self.place(point.at).into());
            table[&point.name] = value(entry);
        }
        table
    }

    fn wheels(&mut self) -> Table {
        let m = self.m;
        let mut table = Table::new();
        for wheel in &m.wheels {
            let mut t = Table::new();
            t["body"] = value(m.bodies[wheel.body].name.as_str());
            t["centre"] = value(self.hardpoint(&with_word(&wheel.name, "centre"), wheel.centre));
            t["spin_axis"] = match wheel.spindle {
                Some(spindle) => {
                    value(self.through(&with_word(&wheel.name, "spindle"), [spindle, wheel.centre]))
                }
                None => direction(wheel.spin_axis),
            };
            t["radius"] = value(wheel.radius);
            if let Some(kingpin) = wheel.kingpin {
                let points = [("lower", kingpin[0]), ("upper", kingpin[1])].map(|(end, (body, at))| {
                    let mut point = InlineTable::new();
                    point.insert("body", m.bodies[body].name.as_str().into());
                    let name = with_word(&wheel.name, &format!("kingpin_{end}"));
                    point.insert("at", self.hardpoint(&name, at).into());
                    point
                });
                t["kingpin"] = value(points.into_iter().collect::<Array>());
            }
            if let Some(ends) = wheel.spring {
                t["spring"] =
                    value(ends.into_iter().map(|(body, at)| self.point(body, at)).collect::<Array>());
            }
            if let Some(end) = wheel.end {
                t["end"] = value(end.name());
            }
            t["bump"] = value(m.drivers[wheel.bump].name.as_str());
            if let Some(steering) = m.steering.filter(|_| wheel.is_steered) {
                t["steer"] = value(m.drivers[steering].name.as_str());
            }
            t["measures"] = value("all");
            table[&wheel.name] = Item::Table(t);
        }
        table
    }

    fn place(&self, at: Vec3) -> Array {
        numbers(&at.to_array().map(|x| clean(x, ROUND_OFF * self.size)))
    }
}

fn free_name(wanted: &str, taken: &[(String, Vec3)]) -> String {
    let taken: HashSet<&str> = taken.iter().map(|(name, _)| name.as_str()).collect();
    valid_name(wanted, "point", &taken)
}

/// Adds a table to the document, unless it is empty.
fn put(doc: &mut DocumentMut, name: &str, mut table: Table) {
    if table.is_empty() {
        return;
    }
    // `[joints.NAME]` needs no `[joints]` before it.
    table.set_implicit(true);
    doc[name] = Item::Table(table);
}

fn decorate(table: &mut Table, note: &str) {
    table.decor_mut().set_prefix(format!("\n{}", comment(note)));
}

fn comment(note: &str) -> String {
    let note: String = note.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if note.is_empty() { String::new() } else { format!("# {note}\n") }
}

/// Writes a range whose open ends are infinite.
fn range(ends: [f64; 2]) -> InlineTable {
    let ends = ["min", "max"].into_iter().zip(ends).filter(|(_, x)| x.is_finite());
    ends.map(|(key, x)| (key, Value::from(x))).collect()
}

fn clean(x: f64, nothing: f64) -> f64 {
    if x.abs() <= nothing { 0.0 } else { x }
}

fn numbers(list: &[f64]) -> Array {
    list.iter().copied().collect()
}

/// Writes a direction, by its name if it is a global axis.
fn direction(v: Vec3) -> Item {
    let v = v.unit().unwrap_or(v).to_array().map(|x| clean(x, ROUND_OFF));
    for (k, names) in [["x", "-x"], ["y", "-y"], ["z", "-z"]].iter().enumerate() {
        let others = (0..3).filter(|c| *c != k).all(|c| v[c] == 0.0);
        if others && v[k] != 0.0 {
            return value(names[usize::from(v[k] < 0.0)]);
        }
    }
    value(numbers(&v))
}
