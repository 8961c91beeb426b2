//! Shared settings of MJCF (compiler, default classes, meshes), and attributes of elements with their defaults.

use std::collections::HashMap;
use std::rc::Rc;

use hardpoint::space::{Mat3, Pose, Quat, Vec3};

use super::vocabulary::{COMPILER, DEFAULTS};
use super::{DEEPEST, Element, Reader};

use crate::report::SourceSpan;
use crate::turn::{from_z_and_x, none, sequence};
use crate::xml;
use crate::xml::exactly;

/// Attributes for orientations; those other than `quat` come first, since they take precedence.
pub(super) const NOTATIONS: [&str; 5] = ["axisangle", "xyaxes", "zaxis", "euler", "quat"];
/// Maximum number of attributes in all default classes.
const MOST_DEFAULTS: usize = 100_000;

impl<'d> Reader<'d, '_> {
    /// Reads compiler, options, default classes and meshes of a whole model, or of an extension of another format.
    pub(super) fn settings(&mut self, top: &[Element<'d>], is_whole: bool) {
        for (text, node) in top.iter().filter(|(_, n)| n.has_tag_name("compiler")) {
            xml::unknown(*text, *node, "", COMPILER, self.notes);
            if is_whole {
                self.mass_settings((*text, *node))
            } else {
                self.refuse_mass_settings((*text, *node))
            }
            if let Some(angle) = node.attribute("angle") {
                self.compiler.degrees = angle != "radian";
            }
            if let Some(sequence) = node.attribute("eulerseq") {
                let fits = sequence.len() == 3 && sequence.chars().all(|c| "xyzXYZ".contains(c));
                if fits {
                    self.compiler.euler = sequence.to_owned();
                } else {
                    let at = xml::attribute_at(*text, *node, "eulerseq");
                    self.notes.problem_with(
                        "HP0804",
                        at,
                        format!("`{sequence}` is not a sequence of axes"),
                        "use three of x, y, z, X, Y, Z",
                    );
                }
            }
            if let Some(folder) = node.attribute("meshdir").or_else(|| node.attribute("assetdir")) {
                self.compiler.mesh_folder = format!("{}/", folder.trim_end_matches('/'));
            }
            if let Some(auto) = node.attribute("autolimits") {
                self.compiler.auto_limits = auto == "true";
            }
            if node.attribute("exactmeshinertia") == Some("true") {
                self.compiler.mesh_inertia = "exact";
            }
            if node.attribute("coordinate") == Some("global") {
                let at = xml::attribute_at(*text, *node, "coordinate");
                self.notes.problem_with(
                    "HP0805",
                    at,
                    "global coordinates are no longer part of MJCF",
                    "convert the model to local coordinates with MuJoCo 2.3.2",
                );
            }
            self.notes.taken("compiler", "", xml::at(*text, *node));
        }
        for element in top.iter().filter(|(_, n)| n.has_tag_name("default")) {
            self.class(*element, None, 0);
        }
        for (text, node) in top.iter().filter(|(_, n)| n.has_tag_name("option")) {
            if is_whole {
                self.option((*text, *node));
            } else {
                let why = "options apply to models of MuJoCo only";
                self.notes.refused("option", "", xml::at(*text, *node), why);
            }
        }
        for (text, asset) in top.iter().filter(|(_, n)| n.has_tag_name("asset")) {
            for (text, node) in self.contents((*text, *asset), 0) {
                if !node.has_tag_name("mesh") {
                    self.notes.ignored(node.tag_name().name(), xml::at(text, node));
                    continue;
                }
                let (name, mesh) = self.mesh((text, node));
                self.meshes.insert(name, Rc::new(mesh));
            }
        }
    }

    /// Reads a default class and its nested classes.
    fn class(&mut self, (text, node): Element<'d>, outer: Option<&str>, depth: usize) {
        // Total number of attributes, including inherited ones.
        let count: usize = self.classes.values().map(HashMap::len).sum();
        if count > MOST_DEFAULTS {
            let help = "remove unused classes";
            self.notes.problem_with(
                "HP0802",
                xml::at(text, node),
                "the file has too many default classes",
                help,
            );
        }
        if depth > DEEPEST || count > MOST_DEFAULTS {
            return;
        }
        let name = node.attribute("class").unwrap_or(if outer.is_none() { "main" } else { "" });
        let mut class = match outer {
            Some(outer) => self.classes.get(outer).cloned().unwrap_or_default(),
            None => self.classes.get("main").cloned().unwrap_or_default(),
        };
        let inner = self.contents((text, node), 0);
        self.report_repeated((text, node), &inner, &DEFAULTS.map(|(kind, _)| kind));
        for (text, element) in inner.iter().filter(|(_, n)| !n.has_tag_name("default")) {
            if let Some((_, known)) = DEFAULTS.iter().find(|(kind, _)| element.has_tag_name(*kind)) {
                xml::unknown(*text, *element, name, *known, self.notes);
            }
            for a in element.attributes() {
                class.insert(
                    (element.tag_name().name().to_owned(), a.name().to_owned()),
                    a.value().to_owned(),
                );
            }
        }
        if outer.is_none() && name != "main" {
            // Older files rename the top-level class.
            self.classes.insert("main".to_owned(), class.clone());
        }
        self.classes.insert(name.to_owned(), class);
        self.notes.taken("default", name, xml::at(text, node));
        for element in inner.iter().filter(|(_, n)| n.has_tag_name("default")) {
            self.class(*element, Some(name), depth + 1);
        }
    }

    /// Returns an attribute of an element or its default, with its position.
    pub(super) fn attribute(
        &self,
        element: Element<'d>,
        key: &str,
        class: Option<&str>,
    ) -> Option<(String, Option<SourceSpan>)> {
        let defaults = match element.1.tag_name().name() {
            "freejoint" => "",
            "spatial" | "fixed" => "tendon",
            name => name,
        };
        self.attribute_of(defaults, element, key, class)
    }

    /// Returns an attribute of an element or its default, with its position. The defaults are those of this element of
    /// a class.
    pub(super) fn attribute_of(
        &self,
        defaults: &str,
        (text, node): Element<'d>,
        key: &str,
        class: Option<&str>,
    ) -> Option<(String, Option<SourceSpan>)> {
        if let Some(value) = node.attribute(key) {
            return Some((value.to_owned(), xml::attribute_at(text, node, key)));
        }
        let class = node.attribute("class").or(class).unwrap_or("main");
        let value = self.classes.get(class)?.get(&(defaults.to_owned(), key.to_owned()))?;
        Some((value.clone(), xml::at(text, node)))
    }

    pub(super) fn numbers<const N: usize>(
        &mut self,
        element: Element<'d>,
        key: &str,
        class: Option<&str>,
    ) -> Option<[f64; N]> {
        let (value, at) = self.attribute(element, key, class)?;
        exactly::<N>(&value, &format!("`{key}`"), at, self.notes)
    }

    pub(super) fn angle(&self, x: f64) -> f64 {
        if self.compiler.degrees { x.to_radians() } else { x }
    }

    /// Returns the orientation of an element in any of the notations of MJCF.
    pub(super) fn orientation(&mut self, element: Element<'d>, class: Option<&str>) -> Mat3 {
        let (text, node) = element;
        let fault = |reader: &mut Self, key| {
            let at = xml::attribute_at(text, node, key);
            reader.notes.problem_with(
                "HP0804",
                at,
                format!("`{key}` defines no orientation"),
                "give non-zero vectors that are not parallel",
            );
            none()
        };
        // The notation of the element takes precedence over that of its class.
        let mut of_element = NOTATIONS.into_iter().filter(|key| node.has_attribute(*key));
        let own = of_element.next();
        if let Some((first, second)) = own.zip(of_element.next()) {
            let at = xml::attribute_at(text, node, second);
            let message =
                format!("`{}` has two orientations: `{first}` and `{second}`", node.tag_name().name());
            self.notes.problem_with("HP0804", at, message, "remove all but one of them");
        }
        let notation =
            own.or_else(|| NOTATIONS.into_iter().find(|key| self.attribute(element, key, class).is_some()));
        match notation {
            Some("axisangle") => {
                let Some([x, y, z, angle]) = self.numbers::<4>(element, "axisangle", class) else {
                    return none();
                };
                let turn = Vec3::from([x, y, z]).unit().map(|axis| Mat3::about(axis, self.angle(angle)));
                turn.unwrap_or_else(|| fault(self, "axisangle"))
            }
            Some("xyaxes") => {
                let Some([a, b, c, d, e, f]) = self.numbers::<6>(element, "xyaxes", class) else {
                    return none();
                };
                let (x, y) = (Vec3::from([a, b, c]), Vec3::from([d, e, f]));
                from_z_and_x(x.cross(y), x).unwrap_or_else(|| fault(self, "xyaxes"))
            }
            Some("zaxis") => {
                let Some(z) = self.numbers::<3>(element, "zaxis", class) else { return none() };
                turned_to(z.into()).unwrap_or_else(|| fault(self, "zaxis"))
            }
            Some("euler") => {
                let angles = self.numbers::<3>(element, "euler", class).unwrap_or_default();
                sequence(&self.compiler.euler.clone(), angles.map(|a| self.angle(a)))
            }
            Some(_) => {
                let Some(q) = self.numbers::<4>(element, "quat", class) else { return none() };
                Quat::from_array(q).map_or_else(|| fault(self, "quat"), |q| q.rotation())
            }
            None => none(),
        }
    }

    pub(super) fn pose(&mut self, element: Element<'d>, class: Option<&str>) -> Pose {
        let r = self.numbers::<3>(element, "pos", class).unwrap_or_default();
        Pose { rot: self.orientation(element, class), r: r.into() }
    }

    /// Returns the pose of a site, which may be defined by two points.
    pub(super) fn site(&mut self, element: Element<'d>, class: Option<&str>) -> Pose {
        let ends = self.numbers::<6>(element, "fromto", class);
        ends.and_then(between_ends).unwrap_or_else(|| self.pose(element, class))
    }

    /// Reports unknown default classes of an element.
    pub(super) fn classes_of(&mut self, (text, node): Element<'d>) {
        for key in ["class", "childclass"] {
            let Some(class) = node.attribute(key).filter(|c| !self.classes.contains_key(*c)) else {
                continue;
            };
            // The class `main` always exists.
            if class == "main" {
                continue;
            }
            let near = hardpoint::draft::did_you_mean(class, self.classes.keys().map(String::as_str));
            let help = near.map_or("define it in `default`".into(), |n| format!("did you mean `{n}`?"));
            let message = format!("the default class `{class}` does not exist");
            self.notes.problem_with("HP0803", xml::attribute_at(text, node, key), message, &help);
        }
    }
}

/// Returns the smallest rotation that takes z into a direction; `None` for a null vector.
fn turned_to(z: Vec3) -> Option<Mat3> {
    let z = z.unit()?;
    let up = Vec3::from([0.0, 0.0, 1.0]);
    let is_opposite = (z + up).norm() < 1e-12;
    Some(if is_opposite {
        Mat3::about([1.0, 0.0, 0.0].into(), std::f64::consts::PI)
    } else {
        Mat3::between(up, z)
    })
}

/// Returns the frame that MuJoCo places between two points: in the middle, with z from the second to the first.
pub(super) fn between_ends([a, b, c, d, e, f]: [f64; 6]) -> Option<Pose> {
    let (from, to) = (Vec3::from([a, b, c]), Vec3::from([d, e, f]));
    Some(Pose { rot: turned_to(from - to)?, r: (from + to) * 0.5 })
}
