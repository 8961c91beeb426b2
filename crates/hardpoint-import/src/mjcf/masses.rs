//! Masses of MJCF: explicit ones, those of geoms, the settings of the compiler that change them, gravity and its
//! compensation.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use hardpoint::space::{Mat3, Pose, Vec3};

use super::defaults::NOTATIONS;
use super::meshes::MeshAsset;
use super::{Element, Reader, TreePosition};
use crate::markers::ElementSource;
use crate::mechanism::GROUND;
use crate::report::SourceSpan;
use crate::shapes::Solid;
use crate::turn::{diagonal, home};
use crate::{Input, robot, xml};

/// Default gravity of MuJoCo, m/s^2.
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];
/// Default density of MuJoCo, kg/m^3, or kg/m^2 of a shell.
const DENSITY: f64 = 1000.0;
/// Settings of the compiler that change masses.
const OF_MASSES: [&str; 6] =
    ["settotalmass", "boundmass", "boundinertia", "balanceinertia", "inertiafromgeom", "inertiagrouprange"];

/// Source of the mass of a body.
#[derive(Clone, Copy, Default, PartialEq)]
enum MassSource {
    /// `inertial`, otherwise the geoms.
    #[default]
    Auto,
    /// `inertial` only.
    Explicit,
    /// The geoms, if a body has any with a mass.
    Geoms,
}

/// Masses of a model while it is read, with the settings of the compiler for them.
pub(super) struct Masses {
    source: MassSource,
    /// First and last group of the geoms with masses.
    groups: [f64; 2],
    /// Total mass, kg, with the position of the setting.
    total: Option<(f64, Option<SourceSpan>)>,
    /// Minimum mass of a body, kg, and minimum principal moment of inertia, kg m^2.
    least: [f64; 2],
    /// True if impossible moments of inertia are replaced by their mean.
    are_balanced: bool,
    gravity: Vec3,
    explicit: Vec<BodyMass>,
    geoms: Vec<GeomMass>,
    meshes: Vec<MeshMass>,
    compensated: Vec<Compensation>,
}

impl Default for Masses {
    fn default() -> Self {
        Self {
            source: MassSource::default(),
            groups: [f64::NEG_INFINITY, f64::INFINITY],
            total: None,
            least: [0.0; 2],
            are_balanced: false,
            gravity: GRAVITY.into(),
            explicit: Vec::new(),
            geoms: Vec::new(),
            meshes: Vec::new(),
            compensated: Vec::new(),
        }
    }
}

/// Mass of a body.
struct BodyMass {
    kind: &'static str,
    name: String,
    at: Option<SourceSpan>,
    body: usize,
    /// Centre, with the axes of the inertia matrix.
    frame: Pose,
    mass: f64,
    /// Inertia matrix about the centre, kg m^2.
    inertia: Mat3,
}

/// Mass of a geom.
struct GeomMass {
    body: usize,
    group: f64,
    centre: Vec3,
    mass: f64,
    /// Inertia matrix about the centre, along the global axes, kg m^2.
    inertia: Mat3,
}

/// Mass of a geom with a mesh.
struct MeshMass {
    body: usize,
    at: Option<SourceSpan>,
    group: f64,
    /// Global pose.
    place: Pose,
    /// Mass, kg, if the file defines it, or density, kg/m^3.
    mass: Option<f64>,
    density: f64,
    /// Mesh, or the reason why its mass is not known.
    mesh: Result<Rc<MeshAsset>, String>,
}

impl MeshMass {
    /// Returns the mass of the geom.
    ///
    /// # Errors
    /// Returns the reason why it is not known.
    fn computed(&self, input: &Input<'_>) -> Result<GeomMass, String> {
        let found = self.mesh.as_ref().map_err(String::clone)?.moments(input)?;
        let mass = self.mass.unwrap_or(self.density * found.volume);
        let rot = self.place.rot;
        Ok(GeomMass {
            body: self.body,
            group: self.group,
            centre: self.place.point(found.centre),
            mass,
            inertia: rot * found.per_mass * diagonal([mass; 3]) * rot.transpose(),
        })
    }
}

/// Shape of a geom with a mass, and its pose in the body or frame.
pub(super) enum MassShape {
    Solid(Solid, Pose),
    /// A mesh, or the reason why its mass is not known.
    Mesh(Result<Rc<MeshAsset>, String>, Pose),
}

/// Compensation of gravity on a body.
struct Compensation {
    name: String,
    at: Option<SourceSpan>,
    body: usize,
    factor: f64,
}

impl<'d> Reader<'d, '_> {
    /// Reads the settings of the compiler for masses.
    pub(super) fn mass_settings(&mut self, element: Element<'d>) {
        let (text, node) = element;
        let mut number = |key: &str| self.numbers::<1>(element, key, None).map(|[x]| x);
        let [total, mass, inertia] = ["settotalmass", "boundmass", "boundinertia"].map(&mut number);
        if let Some(total) = total {
            let at = xml::attribute_at(text, node, "settotalmass");
            self.masses.total = (total > 0.0).then_some((total, at));
        }
        for (least, x) in self.masses.least.iter_mut().zip([mass, inertia]) {
            *least = x.unwrap_or(*least);
        }
        if let Some(range) = self.numbers::<2>(element, "inertiagrouprange", None) {
            self.masses.groups = range;
        }
        if let Some(flag) = node.attribute("balanceinertia") {
            self.masses.are_balanced = flag == "true";
        }
        match node.attribute("inertiafromgeom") {
            Some("true") => self.masses.source = MassSource::Geoms,
            Some("false") => self.masses.source = MassSource::Explicit,
            Some(_) => self.masses.source = MassSource::Auto,
            None => {}
        }
    }

    /// Reports settings for masses in a file of another format, whose masses follow its own rules.
    pub(super) fn refuse_mass_settings(&mut self, (text, node): Element<'d>) {
        for key in OF_MASSES.into_iter().filter(|key| node.has_attribute(*key)) {
            let why = "masses are those of the links: the setting changes them in MuJoCo only";
            self.notes.refused("compiler", key, xml::attribute_at(text, node, key), why);
        }
    }

    /// Reads `option`: gravity, and the flags that disable constraints and loads.
    pub(super) fn option(&mut self, element: Element<'d>) {
        use super::vocabulary::{EFFECTIVE_FLAGS, FLAG, OPTION};
        let (text, node) = element;
        xml::unknown(text, node, "", OPTION, self.notes);
        if let Some(gravity) = self.numbers::<3>(element, "gravity", None) {
            self.masses.gravity = gravity.into();
        }
        for key in ["density", "viscosity"] {
            if self.numbers::<1>(element, key, None).is_some_and(|[x]| x != 0.0) {
                let why = "forces of the surrounding medium have no equivalent: motions that drivers prescribe are the same \
                           without them, but not loads";
                self.notes.refused("option", key, xml::attribute_at(text, node, key), why);
            }
        }
        let mut is_read = node.has_attribute("gravity");
        let contents = self.contents(element, 0);
        self.report_repeated(element, &contents, &["flag"]);
        for flag in xml::named(node, "flag") {
            xml::unknown(text, flag, "", FLAG, self.notes);
            for name in EFFECTIVE_FLAGS {
                let Some(value) = flag.attribute(name) else { continue };
                self.disabled.remove(name);
                if value == "disable" {
                    self.disabled.insert(name.to_owned());
                }
                self.notes.taken("flag", name, xml::attribute_at(text, flag, name));
                is_read = true;
            }
        }
        if is_read {
            self.notes.taken("option", "", xml::at(text, node));
        } else {
            self.notes.ignored("option", xml::at(text, node));
        }
    }

    /// Returns true if the flag of an effect, or one that includes it, disables the effect.
    pub(super) fn is_disabled(&self, effect: &str) -> bool {
        let by = match effect {
            "equality" | "limit" | "frictionloss" => "constraint",
            "spring" | "damper" => "passive",
            other => other,
        };
        [effect, by].iter().any(|flag| self.disabled.contains(*flag))
    }

    /// Records the explicit mass of a body.
    pub(super) fn inertial(&mut self, element: Element<'d>, inside: &TreePosition, name: &str) {
        let (text, node) = element;
        xml::unknown(text, node, name, super::vocabulary::INERTIAL, self.notes);
        let frame = inside.pose.compose(self.pose(element, None));
        let [mass] = self.numbers::<1>(element, "mass", None).unwrap_or_default();
        let diagonal = self.numbers::<3>(element, "diaginertia", None);
        let full = self.numbers::<6>(element, "fullinertia", None);
        // MuJoCo reports these conflicts, but none with `quat`.
        let others = NOTATIONS.into_iter().filter(|key| *key != "quat");
        let others = others.chain(diagonal.filter(|d| d.iter().any(|x| *x != 0.0)).map(|_| "diaginertia"));
        for key in others.filter(|key| full.is_some() && node.has_attribute(*key)) {
            let at = xml::attribute_at(text, node, key);
            let message = format!("`inertial` has `fullinertia` and `{key}`, which exclude each other");
            self.notes.problem_with("HP0804", at, message, "remove one of them");
        }
        let [xx, yy, zz, xy, xz, yz] = full.unwrap_or_else(|| {
            let [x, y, z] = diagonal.unwrap_or_default();
            [x, y, z, 0.0, 0.0, 0.0]
        });
        let inertia = Mat3 { cols: [[xx, xy, xz].into(), [xy, yy, yz].into(), [xz, yz, zz].into()] };
        self.masses.explicit.push(BodyMass {
            kind: "inertial",
            name: name.to_owned(),
            at: xml::at(text, node),
            body: inside.body,
            frame,
            mass,
            inertia,
        });
    }

    /// Records the mass of a geom: its volume or, of a shell, its area times its density.
    pub(super) fn add_geom_mass(&mut self, element: Element<'d>, inside: &TreePosition, shape: MassShape) {
        let class = inside.class.as_deref();
        let mass = self.numbers::<1>(element, "mass", class).map(|[mass]| mass);
        let [density] = self.numbers::<1>(element, "density", class).unwrap_or([DENSITY]);
        let [group] = self.numbers::<1>(element, "group", class).unwrap_or_default();
        let (solid, place) = match shape {
            MassShape::Solid(solid, place) => (solid, place),
            MassShape::Mesh(mesh, place) => {
                if mass.unwrap_or(density) > 0.0 {
                    let (at, place) = (xml::at(element.0, element.1), inside.pose.compose(place));
                    let geom = MeshMass { body: inside.body, at, group, place, mass, density, mesh };
                    self.masses.meshes.push(geom);
                }
                return;
            }
        };
        let is_shell = self.attribute(element, "shellinertia", class).is_some_and(|(flag, _)| flag == "true");
        let (size, per_mass) = if is_shell { shell_moments(solid) } else { solid.moments() };
        let mass = mass.unwrap_or(density * size);
        if !(mass > 0.0 && mass.is_finite()) {
            return;
        }
        let rot = inside.pose.rot * place.rot;
        let inertia = rot * diagonal(per_mass.map(|i| mass * i)) * rot.transpose();
        let centre = inside.pose.point(place.r);
        self.masses.geoms.push(GeomMass { body: inside.body, group, centre, mass, inertia });
    }

    /// Records the compensation of gravity on a body.
    pub(super) fn compensation(&mut self, (text, node): Element<'d>, body: usize, name: &str) {
        let Some([factor]) = self.numbers::<1>((text, node), "gravcomp", None) else { return };
        let at = xml::attribute_at(text, node, "gravcomp");
        if factor != 0.0 {
            self.masses.compensated.push(Compensation { name: name.to_owned(), at, body, factor });
        }
    }

    /// Moves the masses of a body from one pose of a frame on it to another.
    pub(super) fn move_masses(&mut self, body: usize, [from, to]: [Pose; 2]) {
        let turn = to.rot * from.rot.transpose();
        for mass in self.masses.explicit.iter_mut().filter(|mass| mass.body == body) {
            mass.frame = to.compose(from.inverse().compose(mass.frame));
        }
        for geom in self.masses.geoms.iter_mut().filter(|geom| geom.body == body) {
            geom.centre = to.point(from.inverse().point(geom.centre));
            geom.inertia = turn * geom.inertia * turn.transpose();
        }
        for geom in self.masses.meshes.iter_mut().filter(|geom| geom.body == body) {
            geom.place = to.compose(from.inverse().compose(geom.place));
        }
    }

    /// Adds the masses of all bodies, gravity and its compensation. A body has no mass if that of one of its geoms is
    /// not known.
    pub(super) fn add_masses(&mut self, input: &Input<'_>) {
        let mut masses = std::mem::take(&mut self.masses);
        let [first, last] = masses.groups;
        let is_counted = |body: usize, group: f64| body != GROUND && (first..=last).contains(&group);
        let explicit: BTreeSet<usize> = masses.explicit.iter().map(|mass| mass.body).collect();
        let is_from_geoms = |body: usize| match masses.source {
            MassSource::Auto => !explicit.contains(&body),
            MassSource::Explicit => false,
            MassSource::Geoms => true,
        };
        let mut of_body: BTreeMap<usize, Vec<GeomMass>> = BTreeMap::new();
        for geom in masses.geoms.drain(..) {
            if is_counted(geom.body, geom.group) && is_from_geoms(geom.body) {
                of_body.entry(geom.body).or_default().push(geom);
            }
        }
        let mut unknown: BTreeMap<usize, (Option<SourceSpan>, String)> = BTreeMap::new();
        for geom in &masses.meshes {
            if is_counted(geom.body, geom.group) && is_from_geoms(geom.body) {
                match geom.computed(input) {
                    Ok(mass) => of_body.entry(geom.body).or_default().push(mass),
                    Err(why) => {
                        unknown.entry(geom.body).or_insert((geom.at, why));
                    }
                }
            }
        }
        let mut list = Vec::new();
        for mass in masses.explicit.drain(..) {
            if of_body.contains_key(&mass.body) || unknown.contains_key(&mass.body) {
                // With `inertiafromgeom` the geoms replace it.
                self.notes.ignored("inertial", mass.at);
            } else {
                list.push(mass);
            }
        }
        for (body, geoms) in of_body.into_iter().filter(|(body, _)| !unknown.contains_key(body)) {
            let name = self.m.bodies[body].name.clone();
            list.push(mass_of_geoms(body, name, &geoms));
        }
        for (body, (at, why)) in &unknown {
            let why = format!("the body has no mass in the model, since that of a geom is not known: {why}");
            self.notes.refused("mass of geoms", &self.m.bodies[*body].name, *at, why);
        }
        let [least_mass, least_inertia] = masses.least;
        if least_mass > 0.0 {
            let known: BTreeSet<usize> =
                list.iter().map(|mass| mass.body).chain(unknown.keys().copied()).collect();
            let massless = self.bodies.iter().filter(|(_, (body, _))| !known.contains(body));
            list.extend(massless.map(|(name, (body, pose))| BodyMass {
                kind: "boundmass",
                name: name.clone(),
                at: None,
                body: *body,
                frame: *pose,
                mass: least_mass,
                inertia: diagonal([0.0; 3]),
            }));
        }
        for mass in &mut list {
            mass.mass = mass.mass.max(least_mass);
            mass.inertia = adjusted(mass.inertia, least_inertia, masses.are_balanced);
        }
        if let Some((total, at)) = masses.total {
            let sum: f64 = list.iter().filter(|mass| mass.body != GROUND).map(|mass| mass.mass).sum();
            if unknown.is_empty() && sum > 0.0 {
                for mass in &mut list {
                    mass.mass *= total / sum;
                    mass.inertia = mass.inertia * diagonal([total / sum; 3]);
                }
            } else {
                let why = "the masses are not scaled to this total, since not all of them are known";
                self.notes.refused("compiler", "settotalmass", at, why);
            }
        }
        for BodyMass { kind, name, at, body, frame, mass, inertia } in list {
            let source = ElementSource { kind, name: &name, at };
            robot::mass(&mut self.m, self.notes, source, body, frame, mass, Some(inertia));
        }
        self.add_gravity(masses.gravity, &masses.compensated);
    }

    /// Adds gravity, unless a flag disables it, and forces on the bodies where it is compensated.
    fn add_gravity(&mut self, gravity: Vec3, compensated: &[Compensation]) {
        if gravity.norm() > 0.0 && !self.is_disabled("gravity") && !self.m.masses.is_empty() {
            self.m.gravity = Some(gravity);
            self.notes.taken("gravity", "", None);
        }
        for Compensation { name, at, body, factor } in compensated {
            let source = ElementSource { kind: "gravcomp", name, at: *at };
            robot::compensate_gravity(&mut self.m, self.notes, source, *body, *factor);
        }
    }

    /// Reports inertia and laws of a joint that the model does not support.
    pub(super) fn unsupported_of_joint(&mut self, element: Element<'d>, class: Option<&str>, name: &str) {
        const UNSUPPORTED: [(&str, &str); 3] = [
            ("armature", robot::ROTOR),
            (
                "springdamper",
                "stiffness and damping that MuJoCo computes from the masses are not imported: use `stiffness` and `damping`",
            ),
            ("springyield", "springs with a yield limit are not supported: the spring is linear"),
        ];
        for (key, why) in UNSUPPORTED {
            let Some((value, at)) = self.attribute(element, key, class) else { continue };
            if xml::numbers(&value).is_none_or(|list| list.iter().any(|x| *x != 0.0)) {
                self.notes.refused(key, name, at, why);
            }
        }
    }
}

/// Returns true if a geom of this type has a volume.
pub(super) fn has_volume(kind: &str) -> bool {
    !["plane", "hfield"].contains(&kind)
}

/// Returns the mass of a body from its geoms.
fn mass_of_geoms(body: usize, name: String, geoms: &[GeomMass]) -> BodyMass {
    let mass: f64 = geoms.iter().map(|s| s.mass).sum();
    let centre = geoms.iter().fold(Vec3::zero(), |c, s| c + s.centre * (s.mass / mass));
    let parts = geoms.iter().map(|s| (s.mass, s.centre - centre, s.inertia));
    BodyMass {
        kind: "mass of geoms",
        name,
        at: None,
        body,
        frame: Pose { rot: home().rot, r: centre },
        mass,
        inertia: robot::combined(parts),
    }
}

/// Applies the settings of the compiler to an inertia matrix: the lower bound of its principal moments and, where one
/// exceeds the sum of the other two, their mean.
fn adjusted(inertia: Mat3, least: f64, is_balanced: bool) -> Mat3 {
    if least <= 0.0 && !is_balanced {
        return inertia;
    }
    let (axes, moments) = principal(inertia);
    let mut bounded = moments.map(|i| i.max(least));
    let sum: f64 = bounded.iter().sum();
    if is_balanced && bounded.iter().any(|i| 2.0 * i > sum) {
        bounded = [sum / 3.0; 3];
    }
    if bounded == moments { inertia } else { axes * diagonal(bounded) * axes.transpose() }
}

/// Returns the principal axes and moments of an inertia matrix, by Jacobi's method.
fn principal(inertia: Mat3) -> (Mat3, [f64; 3]) {
    /// Maximum number of sweeps; convergence is quadratic.
    const SWEEPS: usize = 20;
    let mut axes = home().rot;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let a = axes.transpose() * inertia * axes;
            let [pp, qq, pq] = [a.cols[p][p], a.cols[q][q], a.cols[q][p]];
            if pq == 0.0 {
                continue;
            }
            // tan 2x = 2 a_pq / (a_qq - a_pp)
            let angle = 0.5 * (2.0 * pq).atan2(qq - pp);
            let (sin, cos) = angle.sin_cos();
            let [u, v] = [axes.cols[p], axes.cols[q]];
            (axes.cols[p], axes.cols[q]) = (u * cos - v * sin, u * sin + v * cos);
        }
    }
    let a = axes.transpose() * inertia * axes;
    (axes, [0, 1, 2].map(|k| a.cols[k][k]))
}

/// Returns the area of the surface of a solid, m^2, and the moments of inertia of a shell of this surface about its own
/// axes per unit of mass, m^2. Those of an ellipsoid are MuJoCo's approximation.
fn shell_moments(solid: Solid) -> (f64, [f64; 3]) {
    use std::f64::consts::PI;
    match solid {
        Solid::Box([x, y, z]) => {
            let [x2, y2, z2] = [x, y, z].map(|a| a * a);
            let faces = [2.0 * y * z, 2.0 * z * x, 2.0 * x * y];
            let area: f64 = faces.iter().sum();
            // Faces in the order of their normals: across a normal a, 1/12 b^2 and 1/4 a^2.
            let [fx, fy, fz] = faces.map(|face| face / area);
            let about = |b2: f64, c2: f64, [fa, fb, fc]: [f64; 3]| {
                fa * (b2 + c2) / 12.0 + fb * (b2 / 4.0 + c2 / 12.0) + fc * (b2 / 12.0 + c2 / 4.0)
            };
            (area, [about(y2, z2, [fx, fy, fz]), about(z2, x2, [fy, fz, fx]), about(x2, y2, [fz, fx, fy])])
        }
        Solid::Cylinder(r, l) => {
            let [side, ends] = [2.0 * PI * r * l, 2.0 * PI * r * r];
            let [s, e] = [side, ends].map(|part| part / (side + ends));
            let across = s * (r * r / 2.0 + l * l / 12.0) + e * (r * r / 4.0 + l * l / 4.0);
            (side + ends, [across, across, s * r * r + e * r * r / 2.0])
        }
        Solid::Capsule(r, l) => {
            let [side, ball] = [2.0 * PI * r * l, 4.0 * PI * r * r];
            let [s, b] = [side, ball].map(|part| part / (side + ball));
            let h = l / 2.0;
            let across = s * (r * r / 2.0 + l * l / 12.0) + b * (2.0 / 3.0 * r * r + h * h + h * r);
            (side + ball, [across, across, s * r * r + b * 2.0 / 3.0 * r * r])
        }
        Solid::Ball([a, b, c]) => {
            /// Exponent of Thomsen's formula for the area of an ellipsoid.
            const EXPONENT: f64 = 1.6075;
            let power = |x: f64| x.powf(EXPONENT);
            let mean = (power(a * b) + power(b * c) + power(c * a)) / 3.0;
            // Difference of two ellipsoids whose semi-axes differ by the same small length
            let thin = 0.4 / (1.0 / a + 1.0 / b + 1.0 / c);
            let about = |b: f64, c: f64| (b * b + c * c) / 5.0 + thin * (b + c);
            (4.0 * PI * mean.powf(1.0 / EXPONENT), [about(b, c), about(c, a), about(a, b)])
        }
    }
}
