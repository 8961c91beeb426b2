//! Equality constraints of MJCF, which close loops, couple joints and constrain free bodies.

use std::collections::BTreeSet;

use hardpoint::space::{Mat3, Pose, Quat, Vec3};

use super::{CLOSED, Closure, Element, Reader};
use crate::markers::{ElementSource, Marker, join};
use crate::mechanism::{Coordinate, Drives, Force, ForceOn, GROUND, Joint, Law, Spring};
use crate::report::SourceSpan;
use crate::turn::{home, none};
use crate::{robot, sampled, xml};

impl<'d> Reader<'d, '_> {
    fn end(&mut self, element: Element<'d>, key: &str) -> Option<(usize, Pose)> {
        let (text, node) = element;
        let name = node.attribute(key);
        let found = match name {
            None | Some("world") => Some((GROUND, home())),
            Some(name) => self.bodies.get(name).copied(),
        };
        if found.is_none() {
            let name = name.unwrap_or_default();
            let known = self.bodies.keys().map(String::as_str);
            let near = hardpoint::draft::did_you_mean(name, known);
            let help = near.map_or("use a body of the model".into(), |n| format!("did you mean `{n}`?"));
            let at = xml::attribute_at(text, node, key);
            self.notes.problem_with("HP0803", at, format!("the body `{name}` does not exist"), &help);
        }
        found
    }

    fn coordinate(&mut self, element: Element<'d>, key: &str) -> Option<Coordinate> {
        let (text, node) = element;
        let name = node.attribute(key)?;
        let found = self.joints.get(name).copied();
        if found.is_none() {
            let known = self.joints.keys().map(String::as_str);
            let near = hardpoint::draft::did_you_mean(name, known);
            let help =
                near.map_or("use a hinge or slide of the model".into(), |n| format!("did you mean `{n}`?"));
            let at = xml::attribute_at(text, node, key);
            self.notes.problem_with(
                "HP0803",
                at,
                format!("no joint `{name}` with a single coordinate exists"),
                &help,
            );
        }
        found
    }

    pub(super) fn equalities(&mut self, list: Element<'d>) {
        for (k, element) in self.contents(list, 0).into_iter().enumerate() {
            let (text, node) = element;
            let kind = node.tag_name().name();
            let at = xml::at(text, node);
            let name = node.attribute("name").map_or_else(|| format!("{kind}_{}", k + 1), str::to_owned);
            // Equalities of joints and tendons share the element names of joints and tendons, but not their defaults.
            let active = self.attribute_of("equality", element, "active", None);
            if active.is_some_and(|(active, _)| active == "false") {
                self.notes.refused(kind, &name, at, "it is not active");
                continue;
            }
            xml::unknown(text, node, &name, super::vocabulary::EQUALITY, self.notes);
            if self.is_disabled("equality") {
                self.notes.refused(kind, &name, at, "a flag of `option` disables equalities");
                continue;
            }
            match kind {
                "connect" | "weld" => self.closure(element, kind, &name),
                "joint" | "tendon" => self.relation(element, kind, &name),
                other => self.notes.refused(other, &name, at, "constraints of this type have no equivalent"),
            }
        }
    }

    /// Reads a constraint between two bodies: at a point (`connect`), or of frames (`weld`). Both are added after all
    /// have been read, since their offsets are those of the source's design configuration.
    fn closure(&mut self, element: Element<'d>, kind: &str, name: &str) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let sites = ["site1", "site2"].map(|key| node.attribute(key));
        let ends = if let [Some(a), Some(b)] = sites {
            let found = [a, b].map(|s| self.sites.get(s).copied());
            for (site, end) in [a, b].iter().zip(&found) {
                if end.is_none() {
                    self.notes.problem_with(
                        "HP0803",
                        at,
                        format!("the site `{site}` does not exist"),
                        "use a site of the model",
                    );
                }
            }
            found
        } else {
            let [first, second] = ["body1", "body2"].map(|key| self.end(element, key));
            let anchor = self.numbers::<3>(element, "anchor", None).unwrap_or_default();
            let place = |(_, pose): (usize, Pose)| pose.point(anchor.into());
            // The anchor of a weld is in the frame of the second body.
            let place = if kind == "weld" { second.map(place) } else { first.map(place) };
            let put = |end: Option<(usize, Pose)>| Some((end?.0, Pose { rot: none(), r: place? }));
            [put(first), put(second)]
        };
        let [Some(i), Some(j)] = ends else { return };
        let [mut i, mut j] = [i, j].map(|(body, pose)| Marker { body, pose });
        if kind == "connect" {
            self.connections.push(Closure { name: name.to_owned(), at, ends: [i, j] });
            return;
        }
        if !matches!(sites, [Some(_), Some(_)])
            && let Some((first, second)) = self.relative_pose(element)
        {
            (i.pose, j.pose) = (first, second);
        }
        self.welds.push(Closure { name: name.to_owned(), at, ends: [i, j] });
    }

    /// Adds the welds. Free bodies are moved to where they hold them.
    pub(super) fn join_welds(&mut self) {
        self.place_free_bodies();
        for Closure { name, at, ends } in std::mem::take(&mut self.welds) {
            let source = ElementSource { kind: "weld", name: &name, at };
            robot::weld(&mut self.m, self.notes, source, "fixed", ends);
        }
    }

    /// Moves free bodies to where welds hold them, from bodies that have their place to others.
    fn place_free_bodies(&mut self) {
        let is_free = |body: &usize| {
            self.free.iter().any(|f| f.bodies[1] == *body)
                && !self.m.joints.iter().any(|j| j.bodies.contains(body))
        };
        let mut free: BTreeSet<usize> = self.welds.iter().flat_map(|w| w.ends.map(|end| end.body)).collect();
        free.retain(is_free);
        let connected: BTreeSet<usize> =
            self.connections.iter().flat_map(|c| c.ends.map(|end| end.body)).collect();
        while !free.is_empty() {
            let next = self.welds.iter().enumerate().find_map(|(k, weld)| {
                match weld.ends.map(|end| free.contains(&end.body)) {
                    [false, true] => Some((k, 1)),
                    [true, false] => Some((k, 0)),
                    [true, true] | [false, false] => None,
                }
            });
            let Some((k, own)) = next else {
                // Of bodies that are welded to each other only, one stays: one with a connection, if there is any.
                let stays = free.intersection(&connected).chain(&free).next().copied();
                free.retain(|body| Some(*body) != stays);
                continue;
            };
            let (body, wanted) = (self.welds[k].ends[own].body, self.welds[k].ends[1 - own].pose);
            self.move_body(body, [self.welds[k].ends[own].pose, wanted]);
            // Both frames are the same, to the last digit.
            self.welds[k].ends[own].pose = wanted;
            free.remove(&body);
        }
    }

    /// Moves a body without joints, and everything on it, from one pose of a frame on it to another.
    fn move_body(&mut self, body: usize, [from, to]: [Pose; 2]) {
        let moved = |pose: Pose| to.compose(from.inverse().compose(pose));
        let moved_point = |r: Vec3| to.point(from.inverse().point(r));
        let place = self.m.bodies[body].pose.as_mut().into_iter();
        let frames = self.bodies.values_mut().chain(self.sites.values_mut());
        let frames = frames.filter(|frame| frame.0 == body).map(|frame| &mut frame.1);
        let closures = self.connections.iter_mut().chain(&mut self.welds).flat_map(|c| &mut c.ends);
        let markers = closures.filter(|end| end.body == body).map(|end| &mut end.pose);
        place.chain(frames).chain(markers).for_each(|pose| *pose = moved(*pose));
        for free in self.free.iter_mut().filter(|free| free.bodies[1] == body) {
            free.place = moved_point(free.place);
        }
        for Force { on, spring, .. } in &mut self.m.forces {
            let ForceOn::Points(ends) = on else { continue };
            let length = |ends: &[(usize, Vec3); 2]| (ends[1].1 - ends[0].1).norm();
            let before = length(ends);
            ends.iter_mut().filter(|end| end.0 == body).for_each(|end| end.1 = moved_point(end.1));
            // The tension is that of the source at its lengths.
            if spring.free.is_none() && spring.stiffness > 0.0 {
                let tension = spring.preload.unwrap_or(0.0) + spring.stiffness * (length(ends) - before);
                spring.preload = (tension != 0.0).then_some(tension);
            }
        }
        self.move_masses(body, [from, to]);
    }

    /// Adds joints for connected points. Two bodies that are connected at two points rotate about the line through
    /// both.
    pub(super) fn join_connections(&mut self) {
        let connections = std::mem::take(&mut self.connections);
        let apart = |a: Vec3, b: Vec3| (a - b).norm() > CLOSED * self.m.size();
        let place = |k: usize| connections[k].ends[0].pose.r;
        let pair = |k: usize| {
            let [i, j] = connections[k].ends.map(|end| end.body);
            (i.min(j), i.max(j))
        };
        let closed = |k: usize| !apart(place(k), connections[k].ends[1].pose.r);
        let mut partner = vec![None; connections.len()];
        for k in 0..connections.len() {
            let same: Vec<usize> = (0..connections.len()).filter(|l| pair(*l) == pair(k)).collect();
            if let [a, b] = same[..]
                && closed(a)
                && closed(b)
                && apart(place(a), place(b))
            {
                partner[k] = Some(if k == a { b } else { a });
            }
        }
        for (k, connection) in connections.iter().enumerate() {
            let source = ElementSource { kind: "connect", name: &connection.name, at: connection.at };
            match partner[k] {
                None => {
                    join(&mut self.m, self.notes, source, "spherical", connection.ends);
                }
                Some(other) if other > k => {
                    let axis = connections[other].ends[0].pose.r - connection.ends[0].pose.r;
                    let ends =
                        connection.ends.map(|end| Marker::along(end.body, connection.ends[0].pose.r, axis));
                    if let [Some(i), Some(j)] = ends {
                        join(&mut self.m, self.notes, source, "revolute", [i, j]);
                        self.notes.taken("connect", &connections[other].name, connections[other].at);
                    }
                }
                Some(_) => {}
            }
        }
    }

    /// Handles free bodies: those with equalities remain free, the others are fixed in the design configuration.
    pub(super) fn free_bodies(&mut self) {
        for free in std::mem::take(&mut self.free) {
            let [i, j] = free.bodies;
            if self.m.are_connected([i, j]) {
                let why = "no joint: equalities constrain the body, and drivers fix its remaining degrees of freedom";
                self.notes.approximated("joint", &free.name, free.at, why);
                continue;
            }
            let why = "nothing constrains it in the source: it is fixed in the design configuration";
            self.notes.approximated("joint", &free.name, free.at, why);
            let note = ElementSource { kind: "joint", name: &free.name, at: free.at }.note(self.notes);
            self.m.joint(Joint::new(&free.name, note, "fixed", [i, j], free.place));
        }
    }

    /// Returns the two frames of a weld with a relative pose: the target frame of the second body, and its current
    /// frame.
    fn relative_pose(&mut self, element: Element<'d>) -> Option<(Pose, Pose)> {
        let [x, y, z, q @ ..] = self.numbers::<7>(element, "relpose", None)?;
        // A null quaternion means the relative pose in the design configuration.
        let rot = Quat::from_array(q)?.rotation();
        let (_, first) = self.end(element, "body1")?;
        let (_, second) = self.end(element, "body2")?;
        Some((first.compose(Pose { rot, r: [x, y, z].into() }), second))
    }

    /// Reads a polynomial relation between two joints, or between two tendons that are sums of joints.
    fn relation(&mut self, element: Element<'d>, kind: &str, name: &str) {
        let (text, node) = element;
        let at = xml::at(text, node);
        let [first, second] = if kind == "joint" {
            ["joint1", "joint2"].map(|key| self.coordinate(element, key).map(|c| vec![(c, 1.0)]))
        } else {
            ["tendon1", "tendon2"].map(|key| node.attribute(key).and_then(|t| self.tendons.get(t).cloned()))
        };
        let has_second = node.attribute(if kind == "joint" { "joint2" } else { "tendon2" }).is_some();
        if kind == "tendon"
            && !has_second
            && let Some(rod) = node.attribute("tendon1").and_then(|t| self.rods.get(t).cloned())
        {
            self.rod(element, name, &rod);
            return;
        }
        let Some(first) = first else {
            if kind == "tendon" {
                self.notes.refused(kind, name, at, "only fixed tendons (sums of joints) have an equivalent");
            }
            return;
        };
        if has_second && second.is_none() {
            return;
        }
        let coefficients = self.attribute(element, "polycoef", None).and_then(|(p, _)| xml::numbers(&p));
        let mut a = coefficients.unwrap_or_else(|| vec![0.0, 1.0]);
        a.resize(5, 0.0);
        if has_second && a[2..].iter().any(|x| *x != 0.0) {
            self.notes.refused(kind, name, at, "nonlinear relations have no equivalent");
            return;
        }
        let source = ElementSource { kind, name, at };
        let note = source.note(self.notes);
        let mut terms = first;
        if let Some(second) = second {
            terms.extend(second.iter().map(|(c, k)| (*c, -a[1] * k)));
        }
        // The constant is relative to the reference, like the coordinates of the model.
        match terms[..] {
            [(only, factor)] => {
                let value = if factor == 0.0 { 0.0 } else { a[0] / factor };
                let law = if value == 0.0 { Law::Fixed } else { Law::Constant(value) };
                self.m.driver(name, note, Drives::Coordinate(only), law);
            }
            _ => self.m.coupler_to(name, note, terms, a[0]),
        }
        self.notes.taken(kind, name, at);
    }

    /// Adds a tendon of constant length between two sites as a rod.
    fn rod(&mut self, element: Element<'d>, name: &str, [from, to]: &[String; 2]) {
        let at = xml::at(element.0, element.1);
        let mut end = |site: &String| {
            let found = self.sites.get(site).copied();
            if found.is_none() {
                let message = format!("the site `{site}` does not exist");
                self.notes.problem_with("HP0803", at, message, "use a site of the model");
            }
            found
        };
        let (Some((i, from)), Some((j, to))) = (end(from), end(to)) else { return };
        if i == j {
            self.notes.refused("tendon", name, at, "its sites are on the same body");
            return;
        }
        let constant = self.attribute(element, "polycoef", None).and_then(|(p, _)| xml::numbers(&p));
        let constant = constant.and_then(|c| c.first().copied()).unwrap_or(0.0);
        let length = (to.r - from.r).norm() + constant;
        if !(length > 0.0) {
            self.notes.refused("tendon", name, at, format!("its length would be {length} m"));
            return;
        }
        self.notes.taken("tendon", name, at);
        let note = ElementSource { kind: "tendon", name, at }.note(self.notes);
        let rod = Joint::new(name, note, "distance", [i, j], to.r).between(from.r, to.r);
        self.m.joint(Joint { length: (constant != 0.0).then_some(length), ..rod });
    }

    /// Reads tendons: fixed ones are sums of joints, those between two sites can be rods.
    pub(super) fn tendons(&mut self, top: &[Element<'d>]) {
        for list in top.iter().filter(|(_, n)| n.has_tag_name("tendon")) {
            for element in self.contents(*list, 0) {
                let (text, node) = element;
                let name = node.attribute("name").unwrap_or_default();
                xml::unknown(text, node, name, super::vocabulary::TENDON, self.notes);
                let inner = self.contents(element, 0);
                if node.has_tag_name("fixed") {
                    let mut terms = Vec::new();
                    for part in inner {
                        let factor = self.numbers::<1>(part, "coef", None).map_or(1.0, |[c]| c);
                        if let Some(c) = self.coordinate(part, "joint") {
                            terms.push((c, factor));
                        }
                    }
                    self.tendons.insert(name.to_owned(), terms);
                    self.notes.taken("tendon", name, xml::at(text, node));
                    self.sum_spring(element, name);
                    continue;
                }
                let sites: Vec<String> =
                    inner.iter().filter_map(|(_, n)| n.attribute("site")).map(str::to_owned).collect();
                if let [from, to] = &sites[..]
                    && inner.len() == 2
                {
                    self.rods.insert(name.to_owned(), [from.clone(), to.clone()]);
                }
                // A tendon constrains nothing by itself; an equality may.
                self.tendon_spring(element, name, &inner);
            }
        }
    }

    /// Reads stiffness, damping and the two lengths between which a tendon has no force; reports other properties.
    /// `None` if it has neither stiffness nor damping.
    fn tendon_law(&mut self, element: Element<'d>, name: &str) -> Option<TendonLaw> {
        let (text, node) = element;
        let (kind, at) = (node.tag_name().name(), xml::at(text, node));
        let list = |reader: &Self, key: &str| {
            let found = reader.attribute(element, key, None);
            found.and_then(|(value, _)| xml::numbers(&value)).unwrap_or_default()
        };
        let is_limited = self.attribute(element, "limited", None).is_none_or(|(value, _)| value != "false")
            && !self.is_disabled("limit");
        if self.attribute(element, "range", None).is_some() && is_limited {
            self.notes.refused(
                kind,
                name,
                at,
                "limits of tendons have no equivalent: limit the joints that they span",
            );
        }
        let friction = list(self, "frictionloss").first().copied().unwrap_or(0.0);
        let friction = if self.is_disabled("frictionloss") { 0.0 } else { friction };
        robot::friction(self.notes, name, at, friction);
        for (key, why) in [
            ("armature", "inertia of tendons has no equivalent"),
            ("springyield", "springs with a yield limit are not supported: the spring is linear"),
        ] {
            if list(self, key).iter().any(|x| *x != 0.0) {
                self.notes.refused(key, name, at, why);
            }
        }
        let mut coefficient = |key: &str| match list(self, key)[..] {
            [x, ref rest @ ..] => {
                if rest.iter().any(|x| *x != 0.0) {
                    let why = format!("`{key}` that depends on the length is not supported");
                    self.notes.refused(key, name, at, why);
                }
                x
            }
            [] => 0.0,
        };
        let [stiffness, damping] = ["stiffness", "damping"].map(&mut coefficient);
        let stiffness = if self.is_disabled("spring") { 0.0 } else { stiffness };
        let damping = if self.is_disabled("damper") { 0.0 } else { damping };
        if stiffness == 0.0 && damping == 0.0 {
            return None;
        }
        if !(stiffness >= 0.0 && damping >= 0.0) {
            self.notes.refused(kind, name, at, "stiffness and damping must not be negative");
            return None;
        }
        let lengths = match list(self, "springlength")[..] {
            [length] => Some([length; 2]),
            [low, high] => Some([low, high]),
            _ => None,
        };
        // Only -1 means the length at the reference of the springs: fixed tendons may have negative lengths.
        let lengths = lengths.filter(|lengths| *lengths != [-1.0; 2]);
        if lengths.is_some_and(|[low, high]| low > high) {
            self.notes.refused(kind, name, at, "the second number of `springlength` is below the first");
            return None;
        }
        Some(TendonLaw { stiffness, damping, lengths })
    }

    /// Adds the spring and damper of a tendon that is a multiple of one joint coordinate.
    fn sum_spring(&mut self, element: Element<'d>, name: &str) {
        let at = xml::at(element.0, element.1);
        let Some(TendonLaw { stiffness, damping, lengths }) = self.tendon_law(element, name) else { return };
        let terms = self.tendons.get(name).cloned().unwrap_or_default();
        let [(coordinate, factor)] = terms[..] else {
            let why = "springs of tendons that are sums of several joints have no equivalent";
            self.notes.refused("fixed", name, at, why);
            return;
        };
        let [zero, reference] = self.references.get(&coordinate.joint).copied().unwrap_or_default();
        let free = match lengths {
            None => Some(reference),
            Some([low, high]) if low == high && factor != 0.0 => Some(low / factor),
            Some(_) => None,
        };
        let Some(free) = free else {
            let why = "a spring about a joint without force between two lengths has no equivalent";
            self.notes.refused("fixed", name, at, why);
            return;
        };
        let source = ElementSource { kind: "fixed", name, at };
        let square = factor * factor;
        let law = [stiffness * square, damping * square, free - zero];
        robot::joint_spring(&mut self.m, self.notes, source, Some(coordinate), law);
    }

    /// Returns the part of a tendon that changes its length, from one body to another, and the length of all other
    /// parts.
    fn changing_part(
        &mut self,
        path: &[Element<'d>],
        at: Option<SourceSpan>,
    ) -> Result<ChangingPart, Option<&'static str>> {
        let mut sites = Vec::new();
        for (_, node) in path {
            match node.tag_name().name() {
                "site" => {
                    let site = node.attribute("site").unwrap_or_default();
                    let Some(found) = self.sites.get(site).copied() else {
                        let message = format!("the site `{site}` does not exist");
                        self.notes.problem_with("HP0803", at, message, "use a site of the model");
                        return Err(None);
                    };
                    sites.push(found);
                }
                "geom" => return Err(Some("springs of tendons that wrap around a geom have no equivalent")),
                _ => return Err(Some("springs of tendons with pulleys have no equivalent")),
            }
        }
        let (mut changing, mut rest) = (None, 0.0);
        for pair in sites.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if a.0 == b.0 {
                rest += (a.1.r - b.1.r).norm();
            } else if changing.replace([a, b]).is_some() {
                return Err(Some(
                    "springs of tendons that lead over more than two bodies, or to and fro, have no equivalent",
                ));
            }
        }
        changing
            .map(|ends| (ends, rest))
            .ok_or(Some("its sites are on the same body, so that its length is constant"))
    }

    /// Returns the motion of a body from the design configuration to the reference of the springs (`qpos_spring`).
    fn spring_reference(&self, body: usize) -> Pose {
        let joint_of = |body: usize| self.m.joints.iter().position(|joint| joint.bodies[1] == body);
        let (mut motion, mut body) = (home(), body);
        // A tree has one joint per body.
        for _ in 0..self.m.joints.len() {
            let Some(number) = joint_of(body).filter(|_| body != GROUND) else { break };
            let joint = &self.m.joints[number];
            if let (Some([zero, reference]), Some(axis)) = (self.references.get(&number), joint.axis)
                && zero != reference
            {
                let moved = reference - zero;
                let step = if joint.kind == "translational" {
                    Pose { rot: none(), r: axis * moved }
                } else {
                    let (rot, at) = (Mat3::about(axis, moved), joint.at[0]);
                    Pose { rot, r: at - rot * at }
                };
                motion = step.compose(motion);
            }
            body = joint.bodies[0];
        }
        motion
    }

    /// Adds the spring and damper of a tendon through sites.
    fn tendon_spring(&mut self, element: Element<'d>, name: &str, path: &[Element<'d>]) {
        let (text, node) = element;
        let (kind, at) = (node.tag_name().name(), xml::at(text, node));
        let Some(TendonLaw { stiffness, damping, lengths }) = self.tendon_law(element, name) else {
            self.notes.ignored(kind, at);
            return;
        };
        let ([(i, from), (j, to)], rest) = match self.changing_part(path, at) {
            Ok(found) => found,
            Err(why) => {
                why.into_iter().for_each(|why| self.notes.refused(kind, name, at, why));
                return;
            }
        };
        let source = ElementSource { kind, name, at };
        let nominal = (to.r - from.r).norm();
        let mut spring = Spring { stiffness, damping, ..Spring::default() };
        let mut lost = None;
        // The length at the reference of the springs, unless it is that of the design configuration
        let reference = || {
            let [from, to] = [(i, from), (j, to)].map(|(body, end)| self.spring_reference(body).point(end.r));
            let length = (to - from).norm();
            (length != nominal).then_some([length; 2])
        };
        match lengths.map(|[low, high]| [low - rest, high - rest]).or_else(reference) {
            None => {}
            Some([low, high]) if low == high && (low > 0.0 || stiffness == 0.0) => {
                spring.free = (stiffness > 0.0).then_some(low);
            }
            Some([low, high]) if low == high => spring.preload = Some(stiffness * (nominal - low)),
            Some([low, high]) => {
                let tension = |x: f64| stiffness * ((x - high).max(0.0) - (low - x).max(0.0));
                let to = 2.0 * nominal.max(high);
                match sampled::sample(tension, [0.0, to], &[low, high]) {
                    Ok(table) => {
                        let free = if low > 0.0 { low } else { nominal };
                        spring.stiffness = 0.0;
                        spring.free = Some(free);
                        spring.extension = table.points.iter().map(|[x, force]| [x - free, *force]).collect();
                        lost = Some(table.report(to, "m"));
                    }
                    Err(x) => {
                        self.notes.refused(
                            kind,
                            name,
                            at,
                            format!("its force has no value at a length of {x} m"),
                        );
                        return;
                    }
                }
            }
        }
        self.m.force(Force {
            name: name.to_owned(),
            note: source.note(self.notes),
            on: ForceOn::Points([(i, from.r), (j, to.r)]),
            spring,
        });
        match lost {
            Some(why) => self.notes.approximated(kind, name, at, why),
            None => self.notes.taken(kind, name, at),
        }
    }
}

/// Ends of the part of a tendon that changes its length, each on a body, and the length of its other parts.
type ChangingPart = ([(usize, Pose); 2], f64);

/// Spring and damper of a tendon.
struct TendonLaw {
    stiffness: f64,
    damping: f64,
    /// Lengths between which it has no force, if the file defines them.
    lengths: Option<[f64; 2]>,
}
