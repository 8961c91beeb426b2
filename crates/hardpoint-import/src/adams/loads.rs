//! Loads of a dataset: masses of parts, gravity, springs and dampers, bushings, forces by functions.

use std::collections::BTreeSet;

use hardpoint::space::{Mat3, Pose, Vec3};

use super::functions::ForceUnits;
use super::{Reader, Statement};
use crate::markers::ElementSource;
use crate::mechanism::{Bushing, Force, ForceOn, GROUND, Spring};
use crate::robot;

/// Units of mass, in kg.
const MASSES: [(&str, f64); 11] = [
    ("KILOGRAM", 1.0),
    ("KG", 1.0),
    ("GRAM", 1e-3),
    ("MEGAGRAM", 1e3),
    ("TONNE", 1e3),
    ("POUND_MASS", 0.453_592_37),
    ("LBM", 0.453_592_37),
    ("OUNCE_MASS", 0.028_349_523_125),
    ("KPOUND_MASS", 453.592_37),
    ("SLUG", 14.593_902_937_206_364),
    ("SLINCH", 175.126_835_246_476_37),
];
/// Units of force, in N.
const FORCES: [(&str, f64); 11] = [
    ("NEWTON", 1.0),
    ("N", 1.0),
    ("KNEWTON", 1e3),
    ("KN", 1e3),
    ("MEGANEWTON", 1e6),
    ("MILLINEWTON", 1e-3),
    ("DYNE", 1e-5),
    ("KILOGRAM_FORCE", 9.806_65),
    ("KGF", 9.806_65),
    ("POUND_FORCE", 4.448_221_615_260_5),
    ("KPOUND_FORCE", 4_448.221_615_260_5),
];
/// Units of mass and force of a system of units.
const SYSTEMS: [(&str, &str, &str); 5] = [
    ("MKS", "KILOGRAM", "NEWTON"),
    ("SI", "KILOGRAM", "NEWTON"),
    ("CGS", "GRAM", "DYNE"),
    ("IPS", "SLINCH", "POUND_FORCE"),
    ("FPS", "SLUG", "POUND_FORCE"),
];

/// Reason for a force without a unit.
pub(super) const NO_UNIT: &str = "the file defines no known unit of force";
/// Difference of unit vectors above which markers have different orientations; typed angles agree to about this.
const ALIGNED: f64 = 1e-6;

impl Reader<'_> {
    /// Reads masses, gravity, springs and bushings, and returns the statements that were read.
    pub(super) fn loads(&mut self, statements: &[Statement]) -> BTreeSet<(String, String)> {
        let mut done = BTreeSet::new();
        let units = statements.iter().find(|s| s.name == "UNITS");
        let system = units.and_then(|u| u.text("SYSTEM")).map(str::to_ascii_uppercase);
        let system = SYSTEMS.iter().find(|(name, ..)| Some(*name) == system.as_deref());
        let unit = |key: &str, known: &[(&str, f64)], of_system: Option<&str>| {
            let word = units.and_then(|u| u.text(key)).map(|w| w.trim().to_ascii_uppercase());
            let word = word.as_deref().or(of_system)?;
            known
                .iter()
                .find(|(name, _)| *name == word.trim_end_matches('S') || *name == word)
                .map(|(_, x)| *x)
        };
        let mass = unit("MASS", &MASSES, system.map(|s| s.1));
        let force = unit("FORCE", &FORCES, system.map(|s| s.2));
        let metre = match self.m.length {
            "mm" => 1e-3,
            "cm" => 1e-2,
            "in" => 0.0254,
            _ => 1.0,
        };
        for s in statements {
            match (s.name.as_str(), mass, force) {
                ("PART" | "POINT_MASS", Some(unit), _) if s.has("MASS") && !s.has("GROUND") => {
                    self.mass(s, unit, metre);
                }
                ("ACCGRAV", ..) => {
                    let per_second = self.per_second();
                    let along = ["IGRAV", "JGRAV", "KGRAV"].map(|key| {
                        s.numbers(key, self.notes).and_then(|n| n.first().copied()).unwrap_or(0.0)
                    });
                    let gravity = Vec3::from(along) * (self.scale * metre * per_second * per_second);
                    if gravity.norm() > 0.0 {
                        self.m.gravity = Some(gravity);
                    }
                    self.notes.taken("ACCGRAV", &s.label, Some(s.at));
                    done.insert((s.name.clone(), s.id.clone()));
                }
                ("SPRINGDAMPER", _, Some(unit)) if !s.has("ROTATIONAL") => {
                    self.spring(s, unit);
                    done.insert((s.name.clone(), s.id.clone()));
                }
                ("SPRINGDAMPER", _, Some(unit)) => {
                    self.turning_damper(s, ForceUnits { force: unit, metre });
                    done.insert((s.name.clone(), s.id.clone()));
                }
                ("BUSHING", _, Some(unit)) => {
                    self.bushing(s, unit, metre);
                    done.insert((s.name.clone(), s.id.clone()));
                }
                ("SFORCE", ..) if self.given_force(s, force.map(|force| ForceUnits { force, metre })) => {
                    done.insert((s.name.clone(), s.id.clone()));
                }
                ("SPRINGDAMPER" | "BUSHING", _, None) => {
                    self.notes.refused(&s.name, &s.label, Some(s.at), NO_UNIT);
                    done.insert((s.name.clone(), s.id.clone()));
                }
                _ => {}
            }
        }
        let unknown =
            statements.iter().find(|s| s.name == "PART" && s.has("MASS")).filter(|_| mass.is_none());
        if let Some(s) = unknown {
            let why = "masses are not imported: the file defines no known unit of mass";
            self.notes.refused("MASS", "", Some(s.at), why);
        }
        done
    }

    /// Reads the mass of a part; moments of inertia are about the marker IM, or otherwise about the centre CM.
    fn mass(&mut self, s: &Statement, unit: f64, metre: f64) {
        let Some(&body) = self.parts.get(&format!("{}/{}", s.name, s.id)) else { return };
        let mut first = |key: &str| s.numbers(key, self.notes).and_then(|n| n.first().copied());
        let Some(mass) = first("MASS").map(|m| m * unit).filter(|m| *m != 0.0 && body != GROUND) else {
            return;
        };
        let source = ElementSource { kind: "mass", ..s.source() };
        let marker =
            |reader: &Self, key: &str| s.reference(key).and_then(|id| reader.markers.get(id)).copied();
        let own = self.m.bodies[body].pose;
        let centre = match (marker(self, "CM"), s.name.as_str(), own) {
            (Some(cm), ..) => cm.pose,
            // The centre of a point mass is its origin.
            (None, "POINT_MASS", Some(own)) => own,
            _ => {
                self.notes.refused(
                    "mass",
                    &s.label,
                    Some(s.at),
                    "the mass has no marker CM for its centre and is not imported",
                );
                return;
            }
        };
        let about = marker(self, "IM").map_or(centre, |im| im.pose);
        let list = s.numbers("IP", self.notes).unwrap_or_default();
        let get = |k: usize| {
            list.get(k).copied().unwrap_or(0.0) * unit * (self.scale * metre) * (self.scale * metre)
        };
        // Products of inertia are integrals: the entries of the matrix have the opposite sign.
        let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(get);
        let mut matrix = Mat3 { cols: [[xx, -xy, -xz].into(), [-xy, yy, -yz].into(), [-xz, -yz, zz].into()] };
        // I_c = I_P - m (d^2 1 - d d^T), d in the marker's axes
        let d = about.rot.transpose_mul(about.r - centre.r) * metre;
        for (c, column) in matrix.cols.iter_mut().enumerate() {
            let mut one = [0.0; 3];
            one[c] = d.dot(d);
            *column -= (Vec3::from(one) - d * d[c]) * mass;
        }
        let frame = Pose { rot: about.rot, r: centre.r };
        robot::mass(&mut self.m, self.notes, source, body, frame, mass, (!list.is_empty()).then_some(matrix));
    }

    /// Reads a spring and damper between two markers. The force that separates them is
    /// `-C dR/dt - K (R - LENGTH) + FORCE`.
    fn spring(&mut self, s: &Statement, unit: f64) {
        let Some([j, i]) = self.pair(s) else { return };
        let mut first =
            |key: &str| s.numbers(key, self.notes).and_then(|n| n.first().copied()).unwrap_or(0.0);
        let [k, c, length, force] = [first("K"), first("C"), first("LENGTH"), first("FORCE")];
        let (per_length, scale) = (unit / self.scale, self.scale);
        let damping = c * per_length / self.per_second();
        let fits = [k, c, length, force].iter().all(|x| x.is_finite()) && k >= 0.0 && c >= 0.0;
        if !fits || i.body == j.body {
            let why = "a spring requires non-negative stiffness and damping, and ends on two parts";
            self.notes.refused("SPRINGDAMPER", &s.label, Some(s.at), why);
            return;
        }
        // Without stiffness the force is constant. Tension is positive in the model.
        let free = (k > 0.0).then(|| (length + force / k) * scale);
        if free.is_some_and(|l| l <= 0.0) {
            let why = "a spring with a free length of zero or less is not imported";
            self.notes.refused("SPRINGDAMPER", &s.label, Some(s.at), why);
            return;
        }
        self.m.force(Force {
            name: s.label.clone(),
            note: s.source().note(self.notes),
            on: ForceOn::Points([(i.body, i.pose.r), (j.body, j.pose.r)]),
            spring: Spring {
                stiffness: k * per_length,
                damping,
                free,
                preload: (k == 0.0 && force != 0.0).then_some(-force * unit),
                ..Spring::default()
            },
        });
        self.notes.taken("SPRINGDAMPER", &s.label, Some(s.at));
    }

    /// Reads a spring and damper about an axis. The moment on the part of marker I about z of marker J is
    /// `-CT da/dt - KT (a - ANGLE) + TORQUE`.
    fn turning_damper(&mut self, s: &Statement, units: ForceUnits) {
        let Some(pair) = self.pair(s) else { return };
        let mut first =
            |key: &str| s.numbers(key, self.notes).and_then(|n| n.first().copied()).unwrap_or(0.0);
        let [k, c, angle, torque] = ["KT", "CT", "ANGLE", "TORQUE"].map(&mut first);
        if let Err(why) = self.turning_spring(s, pair, [torque + k * angle, -k, -c], units, &[]) {
            self.notes.refused(&s.name, &s.label, Some(s.at), why);
        }
    }

    /// Reads a bushing between two markers: along and about the axes of marker J, on the part of marker I, the force is
    /// `-K e - C e' + FORCE` and the moment `-KT a - CT a' + TORQUE`.
    fn bushing(&mut self, s: &Statement, unit: f64, metre: f64) {
        let Some([j, i]) = self.pair(s) else { return };
        let mut three = |key: &str| {
            let list = s.numbers(key, self.notes).unwrap_or_default();
            [0, 1, 2].map(|k| list.get(k).copied().unwrap_or(0.0))
        };
        let [k, kt, c, ct, force, torque] = ["K", "KT", "C", "CT", "FORCE", "TORQUE"].map(&mut three);
        let fits = [k, kt, c, ct, force, torque].iter().flatten().all(|x| x.is_finite());
        if !fits || i.body == j.body {
            let why = "a bushing requires finite numbers, and ends on two parts";
            self.notes.refused("BUSHING", &s.label, Some(s.at), why);
            return;
        }
        let (per_length, per_angle) = (unit / self.scale, unit * self.scale * metre);
        let axes = j.pose.rot;
        let mut lost = Vec::new();
        let turned = (0..3).map(|n| (i.pose.rot.cols[n] - axes.cols[n]).norm()).fold(0.0, f64::max);
        if turned > ALIGNED {
            lost.push(
                "its markers have different orientations, and its angles count from the design configuration",
            );
        }
        // Its damping is the same along all axes.
        let damping = if c[0] == c[1] && c[1] == c[2] { c[0] } else { 0.0 };
        if damping != c[0] {
            lost.push("its damping is not imported, since it is not the same along all axes");
        }
        if ct.iter().any(|x| *x != 0.0) {
            lost.push("its damping about its axes is not imported");
        }
        let [stiffness, preload] = [(k, kt, per_length, per_angle), (force, torque, unit, per_angle)].map(
            |([x, y, z], [a, b, c], slide, turn)| {
                [x * slide, y * slide, z * slide, a * turn, b * turn, c * turn]
            },
        );
        self.m.force(Force {
            name: s.label.clone(),
            note: s.source().note(self.notes),
            on: ForceOn::Bushing(
                [(j.body, j.pose.r), (i.body, i.pose.r)],
                Bushing { axes, stiffness, preload },
            ),
            spring: Spring { damping: damping * per_length / self.per_second(), ..Spring::default() },
        });
        match lost.is_empty() {
            true => self.notes.taken("BUSHING", &s.label, Some(s.at)),
            false => self.notes.approximated("BUSHING", &s.label, Some(s.at), lost.join("; ")),
        }
    }
}
