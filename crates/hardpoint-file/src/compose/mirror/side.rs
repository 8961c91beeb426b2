//! Mirror images of all kinds of entries.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

use hardpoint::draft::{ElementType, FieldKind, MeasureType};
use hardpoint::joint;
use hardpoint::joint::{CoordinateAxis, CoordinateType, DIRECTION_NAMES, JointType, VectorKind};
use hardpoint::model::{ElementUnit, WheelMeasure};
use hardpoint::space::Vec3;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::compose::entries::lay_under;
use crate::values::{Shape, Table, Value, axis_named, list_of, shown, table_of};

use super::rule::{Opposites, Rule, each, turn_sign};

/// The other side under construction.
pub(super) struct Side<'m, 'a> {
    pub rule: Rule<'a>,
    pub format: &'static Table,
    /// The written side.
    pub model: &'m DeTable<'a>,
    pub opposite: HashSet<String>,
    /// Images by section and name, with the name of their original.
    pub made: HashMap<(&'static str, String), String>,
    /// Entries that cannot be mirrored: place, reason, and instruction.
    pub refused: Vec<(Range<usize>, String, String)>,
}

impl<'a> Side<'_, 'a> {
    fn entry(&self, section: &str, name: &str) -> Option<&DeTable<'a>> {
        self.model.get(section)?.get_ref().as_table()?.get(name)?.get_ref().as_table()
    }

    /// Adds the mirror images of a section's entries after these; entries written by hand take precedence.
    pub fn add(&mut self, section: &'static str, entries: &mut DeTable<'a>) {
        let of = self.format.entries_of(section);
        let originals: Vec<_> = entries
            .iter()
            .filter_map(|(k, v)| {
                Some((k.get_ref().to_string(), self.rule.twin(k.get_ref())?, k.span(), v.clone()))
            })
            .collect();
        for (name, twin, at, mut value) in originals {
            if self.is_taken(section, &twin, &name, &at) {
                continue;
            }
            self.mirror(section, of, &name, &mut value);
            let (key, at) = (Cow::Owned(twin.clone()), at);
            if !lay_under(of, entries, Spanned::new(at, key), value) {
                continue;
            }
            self.made.insert((section, twin), name);
        }
    }

    /// Returns whether another entry has an image of that name, which is an error.
    fn is_taken(&mut self, section: &'static str, twin: &str, name: &str, at: &Range<usize>) -> bool {
        let Some(other) = self.made.get(&(section, twin.to_owned())) else { return false };
        let message = format!(
            "`{}` and `{}` have the same image `{}`: two words of `names` have one counterpart",
            shown(other),
            shown(name),
            shown(twin)
        );
        let help = "rename one of them, or put it under `except` and write its other side by hand".to_owned();
        self.refused.push((at.clone(), message, help));
        true
    }

    /// Mirror image of one entry.
    fn mirror(&mut self, section: &str, of: Shape, name: &str, value: &mut Value<'a>) -> bool {
        let entry = value.get_ref().as_table();
        let joint = entry.filter(|_| section == "joints").and_then(type_of);
        let measure = entry.and_then(|t| word(t, "type")).and_then(MeasureType::named);
        let turns = move |key: &str| match (section, key) {
            (_, "about" | "rotate" | "turn") => true,
            ("joints", "axis") => joint.is_some_and(|t| t.vector_kinds[0] == VectorKind::Axial),
            ("joints", "axis2") => joint.is_some_and(|t| t.vector_kinds[1] == VectorKind::Axial),
            ("measures", "along") => measure.is_some_and(|t| t.vector_kind == VectorKind::Axial),
            _ => false,
        };
        let named = self.rule.mirror(of, value, &turns);
        let through = first_of_axis(value).filter(|_| turns("axis"));
        turn_lines(value, &turns);
        let span = value.span();
        let Some(table) = table_of(value) else { return named };
        match section {
            "joints" => {
                self.limits(joint, table);
                table.get_mut("lead").into_iter().for_each(|v| turn_sign(v, self.rule.numbers));
                // It is at the first point of its axis, for both directions.
                if let (Some(at), false) = (through, table.contains_key("at")) {
                    put(table, "at", at);
                }
                if !table.contains_key("axis2") {
                    put(table, "mirror", self.axis_across(span));
                }
            }
            "forces" => {
                self.coordinate_values(name, table);
                self.elastic_law(name, table);
            }
            "bodies" => {
                let by_points = table.get("frame").is_some_and(|f| is_by_points(f.get_ref().as_table()));
                self.mesh(table, by_points);
            }
            "masses" => self.mass(name, table),
            "wheels" => self.wheel(table),
            "couplers" => self.coupler(name, table, span),
            "measures" => self.slope(name, table),
            "drivers" => {
                if let (true, Some(law)) = (self.is_turned(name), table.get_mut("law")) {
                    let at = law.span();
                    if !turn_law(law, self.rule.numbers) {
                        self.no_law(at, name);
                    }
                }
            }
            "design" => {
                self.fields(table);
                // Its three variables are the images of those of the original.
                let moved = table.get("move").filter(|_| word(table, "along") == Some("xyz")).cloned();
                if let (Some(moved), false) = (moved, table.contains_key("mirror")) {
                    put(table, "mirror", self.axis_across(moved.span()));
                    put(table, "move", Spanned::new(moved.span(), DeValue::Array(DeArray::new())));
                    put(table, "mirrored", moved);
                }
            }
            _ => {}
        }
        named
    }

    /// Name of the mirrored axis.
    fn axis_across(&self, span: Range<usize>) -> Value<'a> {
        Spanned::new(span, DeValue::String(Cow::Borrowed(["x", "y", "z"][self.rule.across])))
    }

    /// Mirrors the shape of a mass, and the products of inertia with the mirrored axis.
    fn mass(&mut self, name: &str, table: &mut DeTable<'a>) {
        let body = self.entry("masses", name).and_then(|mass| word(mass, "body"));
        let frame = body.and_then(|body| self.entry("bodies", body)).and_then(|b| b.get("frame"));
        self.mesh(table, is_by_points(frame.and_then(|f| f.get_ref().as_table())));
        let products = [["ixy", "izx"], ["ixy", "iyz"], ["iyz", "izx"]][self.rule.across];
        let found = products.into_iter().filter_map(|key| table.remove(key).map(|v| (key, v)));
        for (key, mut product) in found.collect::<Vec<_>>() {
            turn_sign(&mut product, self.rule.numbers);
            put(table, key, product);
        }
    }

    /// Moves a wheel to the other side or end of the vehicle.
    fn wheel(&self, table: &mut DeTable<'a>) {
        let ends = [("side", ["left", "right"], 1), ("end", ["front", "rear"], 0)];
        for (key, [one, other], axis) in ends {
            let Some(value) = table.get_mut(key).filter(|_| self.rule.across == axis) else { continue };
            let turned = match value.get_ref().as_str() {
                Some(w) if w == one => other,
                Some(w) if w == other => one,
                _ => continue,
            };
            *value = text(turned, value);
        }
    }

    /// Moves drivers of a slope from `together` to `opposed` and back, where either they or its `driver` change their
    /// sign in the mirror.
    fn slope(&self, name: &str, table: &mut DeTable<'a>) {
        let Some(original) = self.entry("measures", name).filter(|m| word(m, "type") == Some("slope")) else {
            return;
        };
        let changes_sign = |driver: &str| {
            // The side that the file describes, or its image.
            let described = self.rule.twin(driver).map(|_| driver.to_owned());
            let of_side = described.or_else(|| self.rule.said(driver)).unwrap_or_else(|| driver.to_owned());
            let is_shared = self.rule.twin(&of_side).is_none();
            if is_shared { self.opposite.contains(&of_side) } else { self.is_handed(&of_side) }
        };
        let first = word(original, "driver").is_some_and(changes_sign);
        let keys = ["together", "opposed"];
        let mut moved = Vec::new();
        for (key, other) in keys.into_iter().zip(keys.into_iter().rev()) {
            let names = original.get(key).and_then(|v| v.get_ref().as_array());
            let is_moved = names
                .into_iter()
                .flatten()
                .map(|driver| driver.get_ref().as_str().is_some_and(|driver| changes_sign(driver) != first));
            let Some(list) = table.get_mut(key) else { continue };
            let at = list.span();
            let Some(images) = list_of(list) else { continue };
            let images: Vec<_> =
                std::mem::replace(images, DeArray::new()).into_iter().zip(is_moved).collect();
            let (out, kept): (Vec<_>, Vec<_>) = images.into_iter().partition(|(_, is_moved)| *is_moved);
            let kept: DeArray<'a> = kept.into_iter().map(|(image, _)| image).collect();
            if kept.is_empty() {
                table.remove(key);
            } else if let Some(list) = table.get_mut(key).and_then(list_of) {
                *list = kept;
            }
            moved.extend(out.into_iter().map(|(image, _)| (other, at.clone(), image)));
        }
        for (key, at, image) in moved {
            if let Some(list) = table.get_mut(key).and_then(list_of) {
                list.push(image);
            } else {
                put(table, key, Spanned::new(at, DeValue::Array([image].into_iter().collect())));
            }
        }
    }

    /// Exchanges the ends of limits of coordinates with the opposite sign in the mirror.
    fn limits(&self, joint: Option<&JointType>, table: &mut DeTable<'a>) {
        let Some(kind) = joint else { return };
        let limits = table.get_mut("limits").and_then(table_of);
        for (coordinate, limit) in limits.into_iter().flat_map(|limits| limits.iter_mut()) {
            let is_reversed =
                kind.coordinate(coordinate.get_ref()).is_some_and(|(_, c)| kind.is_reversed_in_mirror(c));
            let Some(limit) = table_of(limit).filter(|_| is_reversed) else { continue };
            let ends = [("min", "max"), ("max", "min")].map(|(from, to)| (to, limit.remove(from)));
            for (key, value) in ends {
                let Some(mut value) = value else { continue };
                turn_sign(&mut value, self.rule.numbers);
                put(limit, key, value);
            }
        }
    }

    /// Changes the signs of an element's numbers that refer to a coordinate with the opposite sign in the mirror.
    fn coordinate_values(&mut self, name: &str, table: &mut DeTable<'a>) {
        let Some(original) = self.entry("forces", name) else { return };
        let kind = word(original, "type").and_then(|t| ElementType::ALL.iter().find(|e| e.name == t));
        let Some(fields) =
            kind.map(|e| e.fields).filter(|f| f.iter().any(|f| f.kind == FieldKind::Coordinate))
        else {
            return;
        };
        if !word(original, "joint").is_some_and(|joint| self.is_reversed(joint, word(original, "coordinate")))
        {
            return;
        }
        for field in fields {
            if let FieldKind::Number(ElementUnit::Length | ElementUnit::Angle) = field.kind {
                table.get_mut(field.key).into_iter().for_each(|v| turn_sign(v, self.rule.numbers));
            } else if let FieldKind::Table | FieldKind::MomentTable = field.kind {
                self.reverse_curve(name, table, field.key);
            }
        }
    }

    /// Reverses a curve of an element: its force and its deflection are opposite in the mirror.
    fn reverse_curve(&mut self, name: &str, table: &mut DeTable<'a>, key: &str) {
        let Some(curve) = table.get_mut(key) else { return };
        let at = curve.span();
        let Some(points) = list_of(curve) else {
            let other = self.rule.twin(name).unwrap_or_default();
            let message = format!("the curve of `{name}` is in a file, and cannot be reversed for `{other}`");
            let help =
                format!("write the points in the model, or write `{other}` as well, with a file of its own");
            self.refused.push((at, message, help));
            return;
        };
        let turned: Vec<_> = std::mem::replace(points, DeArray::new()).into_iter().collect();
        *points = turned.into_iter().rev().collect();
        for point in points.iter_mut() {
            list_of(point).into_iter().for_each(|point| each(point, self.rule.numbers, |_| true));
        }
    }

    /// Changes the signs of preloads, curves and couplings along the axes of a bushing or elastic joint that are
    /// opposite in the mirror.
    fn elastic_law(&mut self, name: &str, table: &mut DeTable<'a>) {
        let Some(original) = self.entry("forces", name) else { return };
        let mut own = [1_i8; 3];
        own[self.rule.across] = -1;
        let axes = match word(original, "type") {
            // Its axes are mirrored as arrows: z and x become their images.
            Some("bushing") if original.contains_key("axis") => [1, -1, 1],
            Some("bushing") => own,
            Some("elastic_joint") => {
                let joint = word(original, "joint").and_then(|joint| self.entry("joints", joint));
                match joint.filter(|joint| joint.contains_key("axis")).and_then(type_of) {
                    Some(kind) => kind.axes_in_mirror(),
                    None => own,
                }
            }
            Some(_) | None => return,
        };
        // An angle keeps its sign about an axis that becomes the opposite of its image.
        let signs: Vec<i8> = axes.into_iter().chain(axes.map(|sign| -sign)).collect();
        for (direction, _) in DIRECTION_NAMES.iter().zip(&signs).filter(|(_, sign)| **sign < 0) {
            let preload = format!("preload_{direction}");
            table.get_mut(preload.as_str()).into_iter().for_each(|v| turn_sign(v, self.rule.numbers));
            self.reverse_curve(name, table, &format!("curve_{direction}"));
        }
        let rows = table.get_mut("matrix").and_then(list_of);
        for (row, sign) in rows.into_iter().flat_map(|rows| rows.iter_mut()).zip(&signs) {
            let turned = |k: usize| signs.get(k).is_some_and(|other| other != sign);
            list_of(row).into_iter().for_each(|row| each(row, self.rule.numbers, turned));
        }
    }

    /// Returns whether a coordinate of a mirrored joint has the opposite sign on the other side.
    fn is_reversed(&self, joint: &str, coordinate: Option<&str>) -> bool {
        let kind = self.entry("joints", joint).and_then(type_of);
        kind.is_some_and(|kind| {
            coordinate_of(kind, coordinate).is_some_and(|c| kind.is_reversed_in_mirror(c))
        })
    }

    /// True if a driver's law has the opposite sign on the other side for a symmetric motion.
    fn is_turned(&self, driver: &str) -> bool {
        self.opposite.contains(driver) != self.is_handed(driver)
    }

    /// True if a driver's coordinate changes its sign in the mirror.
    fn is_handed(&self, driver: &str) -> bool {
        let Some(drives) = self.entry("drivers", driver) else { return false };
        match (word(drives, "joint"), word(drives, "measure")) {
            (Some(joint), _) => self.is_reversed(joint, word(drives, "coordinate")),
            (None, Some(measure)) => self.is_opposite_measure(measure),
            (None, None) => false,
        }
    }

    /// Returns whether a measure that a driver may prescribe has the opposite sign on the other side.
    fn is_opposite_measure(&self, name: &str) -> bool {
        if let Some(measure) = self.entry("measures", name) {
            let is_coordinate = word(measure, "type") == Some("coordinate");
            let joint = word(measure, "joint").filter(|_| is_coordinate);
            return joint.is_some_and(|joint| self.is_reversed(joint, word(measure, "coordinate")));
        }
        // For a wheel it is counted about z on both sides.
        let of_wheel = name.split_once('.').filter(|(wheel, _)| self.entry("wheels", wheel).is_some());
        of_wheel.is_some_and(|(_, what)| what == WheelMeasure::SteerAngle.name()) && self.rule.across != 2
    }

    fn no_law(&mut self, at: Range<usize>, driver: &str) {
        let other = self.rule.twin(driver).unwrap_or_default();
        self.refused.push((
            at,
            format!("the law of driver `{driver}` is in a file, and cannot be reversed for `{other}`"),
            format!("write the law of `{other}` as well, with a file of its own"),
        ));
    }

    /// Mirrored shape of a body, or of a mass on it; a frame by points has another axis there.
    fn mesh(&self, entry: &mut DeTable<'a>, by_points: bool) {
        let Some(mesh) = entry.get_mut("mesh") else { return };
        if mesh.get_ref().is_str() {
            let file = mesh.clone();
            *mesh = Spanned::new(mesh.span(), DeValue::Table(DeTable::new()));
            table_of(mesh).into_iter().for_each(|table| put(table, "file", file.clone()));
        }
        let span = mesh.span();
        let Some(table) = table_of(mesh) else { return };
        let in_body = word(table, "frame") == Some("body");
        let axis = ["x", "y", "z"][if by_points && in_body { 2 } else { self.rule.across }];
        put(table, "mirror", Spanned::new(span, DeValue::String(Cow::Borrowed(axis))));
    }

    /// Mirror image of a coupler: the same relation between mirrored joints; otherwise it depends on the signs of the
    /// coordinates.
    fn coupler(&mut self, name: &str, coupler: &mut DeTable<'a>, at: Range<usize>) {
        // The entry is mirrored already: the originals are in the model.
        let Some(original) = self.entry("couplers", name) else { return };
        let list = |key: &str| -> Vec<String> {
            let list = original.get(key).and_then(|v| v.get_ref().as_array());
            list.into_iter().flatten().filter_map(|v| Some(v.get_ref().as_str()?.to_owned())).collect()
        };
        let (mut signs, mut asked) = (Vec::new(), Vec::new());
        match word(original, "type") {
            Some("gear" | "bevel" | "belt") => {
                asked.extend(list("joints").into_iter().map(|j| (j, "angle".to_owned())))
            }
            Some("rack" | "rack_and_pinion") => {
                asked.extend(word(original, "rack").map(|j| (j.to_owned(), "displacement".to_owned())));
                asked.extend(word(original, "pinion").map(|j| (j.to_owned(), "angle".to_owned())));
            }
            _ => {
                let terms = original.get("terms").and_then(|v| v.get_ref().as_array()).into_iter().flatten();
                for term in terms.filter_map(|t| t.get_ref().as_table()) {
                    let joint = word(term, "joint").unwrap_or_default();
                    asked.push((joint.to_owned(), word(term, "coordinate").unwrap_or_default().to_owned()));
                }
            }
        }
        for (joint, coordinate) in &asked {
            match self.sign(joint, coordinate) {
                Some(sign) => signs.push(sign),
                None => {
                    let twin = self.rule.twin(name).unwrap_or_default();
                    let message = format!(
                        "coupler `{name}` cannot be mirrored: the axis of joint `{joint}` is neither perpendicular to the mirror nor in it"
                    );
                    let help =
                        format!("write `{twin}` by hand with a `type`, or put `{name}` under `except`");
                    self.refused.push((at, message, help));
                    return;
                }
            }
        }
        let odd = signs.iter().filter(|s| **s).count() % 2 == 1;
        let mut toggle = |key: &'static str| {
            let on = coupler.get(key).and_then(|v| v.get_ref().as_bool()).unwrap_or(false);
            put(coupler, key, Spanned::new(at.clone(), DeValue::Boolean(!on)));
        };
        match word(original, "type") {
            Some("gear" | "bevel") if odd => toggle("internal"),
            Some("belt") if odd => toggle("crossed"),
            Some("rack" | "rack_and_pinion") if odd => {
                coupler.get_mut("radius").into_iter().for_each(|v| turn_sign(v, self.rule.numbers))
            }
            Some("linear") => {
                let terms = coupler.get_mut("terms").and_then(|v| list_of(v));
                for (term, _) in
                    terms.into_iter().flat_map(|l| l.iter_mut()).zip(signs).filter(|(_, sign)| *sign)
                {
                    let factor = table_of(term).and_then(|t| t.get_mut("coefficient"));
                    factor.into_iter().for_each(|v| turn_sign(v, self.rule.numbers));
                }
            }
            _ => {}
        }
    }

    /// True if a coordinate of a joint changes its sign in the mirror; `None` if it becomes another coordinate.
    fn sign(&self, joint: &str, coordinate: &str) -> Option<bool> {
        // Unknown names are reported when they are read.
        let Some(table) = self.entry("joints", joint) else { return Some(false) };
        let Some(kind) = type_of(table) else { return Some(false) };
        let coordinate = Some(coordinate).filter(|c| !c.is_empty());
        let Some(coordinate) = coordinate_of(kind, coordinate) else { return Some(false) };
        if self.rule.twin(joint).is_some() {
            return Some(kind.is_reversed_in_mirror(coordinate));
        }
        // A shared joint: its axis has to be its own image, or the opposite. If its bodies are images of each other,
        // its coordinate is that of the first relative to the second.
        let bodies = table.get("bodies").and_then(|v| v.get_ref().as_array());
        let bodies: Vec<_> = bodies.into_iter().flatten().filter_map(|v| v.get_ref().as_str()).collect();
        let swapped = matches!(bodies[..], [i, j] if self.rule.said(i).as_deref() == Some(j));
        let at = |name: &str| -> Option<[f64; 3]> {
            let list = self.model.get("hardpoints")?.get_ref().as_table()?.get(name)?.get_ref().as_array()?;
            numbers(list)
        };
        let line = |key: &str| -> Option<Vec3> {
            let direction = match table.get(key)?.get_ref() {
                DeValue::String(word) => return axis_named(word),
                DeValue::Array(list) => numbers(list),
                DeValue::Table(table) => {
                    let ends = table.get("through").and_then(|v| v.get_ref().as_array());
                    let ends: Vec<_> =
                        ends.into_iter().flatten().filter_map(|v| at(v.get_ref().as_str()?)).collect();
                    match ends.as_slice() {
                        [a, b] => Some([b[0] - a[0], b[1] - a[1], b[2] - a[2]]),
                        _ => None,
                    }
                }
                _ => None,
            };
            direction.map(|[x, y, z]| Vec3::new(x, y, z))
        };
        let (along, angle) = match coordinate.axis() {
            CoordinateAxis::Scalar => return Some(false),
            CoordinateAxis::Along(k) => (k, false),
            CoordinateAxis::About(k) => (k, true),
        };
        let z = line("axis")?;
        let x = || match table.contains_key("axis2") {
            true => line("axis2"),
            false => z.unit().map(Vec3::any_perpendicular),
        };
        let direction = match along {
            0 => x()?,
            1 => z.cross(x()?),
            _ => z,
        };
        let direction = [direction.x, direction.y, direction.z];
        let out = direction[self.rule.across] != 0.0;
        let in_plane = (0..3).any(|k| k != self.rule.across && direction[k] != 0.0);
        // A translation perpendicular to the mirror is reversed; a rotation is reversed parallel to it.
        if out && in_plane { None } else { Some((out != angle) != swapped) }
    }

    /// Velocity fields count in the frames of bodies, which have another axis in the mirror where points give them.
    fn fields(&self, variable: &mut DeTable<'a>) {
        let list = variable.get_mut("fields").and_then(|v| list_of(v));
        for field in list.into_iter().flat_map(|l| l.iter_mut()).filter_map(table_of) {
            let body = word(field, "body").and_then(|b| self.rule.said(b)).unwrap_or_default();
            let frame = self.entry("bodies", &body).and_then(|b| b.get("frame"));
            if !is_by_points(frame.and_then(|f| f.get_ref().as_table())) {
                continue;
            }
            // Mirrored across the one axis already, and to be across z.
            let across = self.rule.across;
            let changed = |k: usize| (k == across) != (k == 2);
            let angles = |axis: usize, k: usize| (if k == 1 { 0 } else { 2 }) != axis;
            for (key, value) in field.iter_mut() {
                let Some(list) = list_of(value) else { continue };
                match &**key.get_ref() {
                    "V" => each(list, self.rule.numbers, changed),
                    "U" => each(list, self.rule.numbers, |k| angles(across, k) != angles(2, k)),
                    _ => {}
                }
            }
        }
    }

    /// Cases of one side become cases of the other; in all other cases the law of a driver or a force also applies to
    /// its image.
    pub fn cases(&mut self, cases: &mut DeTable<'a>) {
        let of_case = self.format.entries_of("cases");
        let of_laws = if let Shape::Table(case) = of_case { case.entries_of("laws") } else { Shape::Text };
        for (name, case) in cases.iter_mut() {
            if self
                .rule
                .exchanged(name.get_ref())
                .is_some_and(|_| !self.rule.kept.contains(&**name.get_ref()))
            {
                continue;
            }
            let laws = table_of(case).and_then(|case| table_of(case.get_mut("laws")?));
            let Some(laws) = laws else { continue };
            let originals: Vec<_> =
                laws.iter().map(|(k, v)| (k.get_ref().to_string(), k.span(), v.clone())).collect();
            for (driver, at, mut law) in originals {
                let Some(twin) = self.rule.twin(&driver) else { continue };
                // The image of a force has the same sign.
                let is_force = self.made.contains_key(&("forces", twin.clone()));
                let is_made = is_force || self.made.contains_key(&("drivers", twin.clone()));
                if !is_made || laws.contains_key(&*twin) {
                    continue;
                }
                self.rule.mirror(of_laws, &mut law, &|_| false);
                if !is_force && self.is_turned(&driver) && !turn_law(&mut law, self.rule.numbers) {
                    self.no_law(at.clone(), &driver);
                }
                laws.insert(Spanned::new(at, Cow::Owned(twin)), law);
            }
        }
        let originals: Vec<_> = cases
            .iter()
            .filter_map(|(k, v)| {
                Some((k.get_ref().to_string(), self.rule.twin(k.get_ref())?, k.span(), v.clone()))
            })
            .collect();
        for (name, twin, at, mut case) in originals {
            if self.entry("cases", &twin).is_some() || self.is_taken("cases", &twin, &name, &at) {
                continue;
            }
            self.rule.mirror(of_case, &mut case, &|_| false);
            let laws = table_of(&mut case).and_then(|case| table_of(case.get_mut("laws")?));
            for (driver, law) in laws.into_iter().flat_map(|laws| laws.iter_mut()) {
                // A driver of one side has the law of its image; a shared one, such as steering, may have the opposite
                // law.
                let original =
                    self.rule.said(driver.get_ref()).unwrap_or_else(|| driver.get_ref().to_string());
                let shared = original == **driver.get_ref();
                let turned =
                    if shared { self.opposite.contains(&original) } else { self.is_handed(&original) };
                if turned && !turn_law(law, self.rule.numbers) {
                    self.no_law(driver.span(), &original);
                }
            }
            cases.insert(Spanned::new(at, Cow::Owned(twin.clone())), case);
            self.made.insert(("cases", twin), name);
        }
    }

    /// Applies each design variable to the other side, too.
    pub fn design(&mut self, design: &mut DeTable<'a>, twins: &mut HashMap<String, Value<'a>>) {
        let shape = self.format.entries_of("design");
        let kept = self.rule.kept.clone();
        for (name, value) in design.iter_mut().filter(|(name, _)| !kept.contains(&**name.get_ref())) {
            let Some(table) = table_of(value) else { continue };
            if let Some(moved) = table.get("move") {
                if table.contains_key("mirror") || table.contains_key("mirrored") {
                    continue;
                }
                let list = match moved.get_ref() {
                    DeValue::Array(list) => list.iter().collect(),
                    _ => vec![moved],
                };
                let names: Vec<&str> = list.iter().filter_map(|v| v.get_ref().as_str()).collect();
                let images: Vec<Value<'a>> = list
                    .iter()
                    .filter_map(|v| Some((v, self.rule.twin(v.get_ref().as_str()?)?)))
                    .filter(|(_, twin)| {
                        self.made.contains_key(&("hardpoints", twin.clone())) && !names.contains(&&**twin)
                    })
                    .map(|(v, twin)| text(twin, v))
                    .collect();
                if !images.is_empty() {
                    let at = moved.span();
                    let images = Spanned::new(at.clone(), DeValue::Array(images.into_iter().collect()));
                    let axis = DeValue::String(Cow::Borrowed(["x", "y", "z"][self.rule.across]));
                    put(table, "mirror", Spanned::new(at, axis));
                    put(table, "mirrored", images);
                }
                continue;
            }
            let mut twin = value.clone();
            let driver = twin.get_ref().as_table().and_then(|t| Some(word(t, "driver")?.to_owned()));
            let turned = driver.is_some_and(|d| self.rule.twin(&d).is_some() && self.is_turned(&d));
            if !self.mirror("design", shape, name.get_ref(), &mut twin) {
                continue;
            }
            if turned {
                let message = format!("`{}` cannot change two laws of opposite signs", shown(name.get_ref()));
                let help = "put it under `except`, or use a parameter in the law".to_owned();
                self.refused.push((name.span(), message, help));
                continue;
            }
            // Entries on both sides, or shared ones, must not change twice.
            if let (Some(twin), Some(original)) = (table_of(&mut twin), value.get_ref().as_table()) {
                for key in ["shape", "fields", "markers"] {
                    let old = original.get(key).and_then(|v| v.get_ref().as_array());
                    let (Some(old), Some(new)) = (old, twin.get_mut(key).and_then(|v| list_of(v))) else {
                        continue;
                    };
                    let said = |v: &Value<'_>| match v.get_ref() {
                        DeValue::Table(t) => word(t, "joint").map(str::to_owned),
                        v => v.as_str().map(str::to_owned),
                    };
                    let old: Vec<_> = old.iter().map(said).collect();
                    let kept: Vec<Value<'a>> =
                        new.iter().filter(|v| !old.contains(&said(v))).cloned().collect();
                    *new = kept.into_iter().collect();
                }
            }
            twins.insert(name.get_ref().to_string(), twin);
        }
    }
}

fn is_by_points(frame: Option<&DeTable<'_>>) -> bool {
    frame.is_some_and(|frame| frame.contains_key("origin"))
}

fn numbers(list: &DeArray<'_>) -> Option<[f64; 3]> {
    let number = |v: &Value<'_>| match v.get_ref() {
        DeValue::Integer(i) => i.as_str().parse().ok(),
        DeValue::Float(f) => f.as_str().parse().ok(),
        _ => None,
    };
    list.iter().map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
}

fn text<'a>(text: impl Into<String>, at: &Value<'_>) -> Value<'a> {
    Spanned::new(at.span(), DeValue::String(Cow::Owned(text.into())))
}

/// First hardpoint of an axis that passes through two of them.
fn first_of_axis<'a>(joint: &Value<'a>) -> Option<Value<'a>> {
    let axis = joint.get_ref().as_table()?.get("axis")?;
    let through = axis.get_ref().as_table()?.get("through")?;
    through.get_ref().as_array()?.first().filter(|at| at.get_ref().is_str()).cloned()
}

/// Inserts a value into a table; the key has the location of the value.
fn put<'a>(table: &mut DeTable<'a>, key: &'static str, value: Value<'a>) {
    table.insert(Spanned::new(value.span(), Cow::Borrowed(key)), value);
}

fn word<'t>(table: &'t DeTable<'_>, key: &str) -> Option<&'t str> {
    table.get(key)?.get_ref().as_str()
}

/// Type of a joint, also for aliases.
fn type_of(joint: &DeTable<'_>) -> Option<&'static JointType> {
    word(joint, "type").and_then(joint::named)
}

/// Coordinate of that name, or the only one by default.
fn coordinate_of(kind: &'static JointType, name: Option<&str>) -> Option<&'static CoordinateType> {
    match (name, kind.coordinates) {
        (Some(name), _) => kind.coordinate(name).map(|c| c.1),
        (None, [only]) => Some(only),
        (None, _) => None,
    }
}

/// Reverses lines through two points that are axes of rotation.
fn turn_lines(value: &mut Value<'_>, turns: &dyn Fn(&str) -> bool) {
    if let Some(list) = list_of(value) {
        list.iter_mut().for_each(|value| turn_lines(value, turns));
        return;
    }
    let Some(table) = table_of(value) else { return };
    for (key, value) in table.iter_mut() {
        let line = table_of(value).filter(|_| turns(key.get_ref()));
        match line.and_then(|line| list_of(line.get_mut("through")?)) {
            Some(points) if points.len() == 2 => {
                let mut points = points.iter_mut();
                if let (Some(a), Some(b)) = (points.next(), points.next()) {
                    std::mem::swap(a, b);
                }
            }
            _ => turn_lines(value, turns),
        }
    }
}

/// Law with the opposite sign; `None` if it cannot be written.
fn turn_law<'a>(value: &mut Value<'a>, numbers: &'a Opposites) -> bool {
    let Some(table) = table_of(value) else {
        turn_sign(value, numbers);
        return true;
    };
    if table.contains_key("file") {
        return false;
    }
    let keys = [
        "amplitude",
        "offset",
        "speed",
        "from",
        "to",
        "start_speed",
        "end_speed",
        "start_acceleration",
        "end_acceleration",
        "law",
    ];
    let mut whole = true;
    for (key, value) in table.iter_mut() {
        match &**key.get_ref() {
            "law" => whole &= turn_law(value, numbers),
            key if keys.contains(&key) => turn_sign(value, numbers),
            "coefficients" => list_of(value).into_iter().for_each(|l| each(l, numbers, |_| true)),
            "points" => list_of(value)
                .into_iter()
                .flat_map(|list| list.iter_mut())
                .for_each(|p| list_of(p).into_iter().for_each(|p| each(p, numbers, |k| k == 1))),
            "pieces" => {
                let pieces = list_of(value).into_iter().flat_map(|list| list.iter_mut());
                for piece in pieces {
                    let law = table_of(piece).and_then(|t| t.get_mut("law"));
                    whole &= law.is_none_or(|law| turn_law(law, numbers));
                }
            }
            _ => {}
        }
    }
    whole
}
