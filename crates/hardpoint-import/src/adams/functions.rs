//! Forces by functions between two markers (SFORCE), and springs about an axis: springs of the model.

use hardpoint::space::Vec3;

use super::{Reader, Statement};
use crate::adams_statement::SEAM;
use crate::law::{self, Language};
use crate::markers::{Marker, MarkerJoint, coordinate_sign, offset};
use crate::mechanism::{Coordinate, Force, ForceOn, Spring};
use crate::sampled;

/// Deviation from a straight line that is round-off, as a fraction of the largest value.
const LINEAR: f64 = 1e-9;
/// Sine of the angle below which axes are parallel, and distance from an axis as a fraction of that along it: typed
/// numbers agree to about this.
const ALIGNED: f64 = 1e-6;
/// Number of lengths or angles at which a function is examined.
const EXAMINED: usize = 24;

/// Units of a dataset: of forces in N, of lengths of the model in m.
#[derive(Clone, Copy)]
pub(super) struct ForceUnits {
    pub force: f64,
    pub metre: f64,
}

/// Force as a function of a length or an angle and of its rate, in the units of the dataset.
struct LengthFunction {
    /// Expressions of the length, in place of the time, at these rates.
    at_rates: Vec<(f64, hardpoint::law::Law)>,
    /// Lengths at which the slope jumps.
    corners: Vec<f64>,
}

/// Straight line through a function, and its damping.
struct Line {
    start: f64,
    slope: f64,
}

impl LengthFunction {
    fn at(&self, x: f64) -> f64 {
        self.at_rates[0].1.at(x).0[0]
    }

    /// Returns the straight line that the function is, if it is one.
    fn line(&self, [from, to]: [f64; 2]) -> Option<Line> {
        let slope = (self.at(to) - self.at(from)) / (to - from);
        let line = Line { start: self.at(from) - slope * from, slope };
        let largest = self.at(from).abs().max(self.at(to).abs());
        let is_near = |x: f64| (self.at(x) - line.start - line.slope * x).abs() <= LINEAR * largest;
        examined([from, to]).all(is_near).then_some(line)
    }

    /// Returns the coefficient of damping in proportion to the rate; `Err` for another damping.
    fn damping(&self, range: [f64; 2]) -> Result<f64, ()> {
        let lost = |rate: usize, x: f64| self.at(x) - self.at_rates[rate].1.at(x).0[0];
        let damping = lost(1, range[1]) / self.at_rates[1].0;
        let is_same = |x: f64| {
            (1..self.at_rates.len()).all(|n| {
                let wanted = damping * self.at_rates[n].0;
                (lost(n, x) - wanted).abs() <= LINEAR * (wanted.abs() + self.at(x).abs())
            })
        };
        if damping >= 0.0 && examined(range).all(is_same) { Ok(damping) } else { Err(()) }
    }
}

fn examined([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..=EXAMINED).map(move |k| from + (to - from) * k as f64 / EXAMINED as f64)
}

impl Reader<'_> {
    /// Reads a force by a function: along the line between its markers, where a positive force separates them, or about
    /// the z axis of marker J, on the part of marker I. Returns false if it has no force.
    pub(super) fn given_force(&mut self, s: &Statement, units: Option<ForceUnits>) -> bool {
        let function = s.text("FUNCTION").map(|f| self.expand_variables(f));
        let readings = |f: &str| {
            [" ", ","].map(|seam| f.replace(SEAM, seam).trim().trim_matches(['\'', '"']).to_owned())
        };
        let is_zero = |text: &String| {
            let text = law::translate(text, Language::Adams);
            text.is_ok_and(|text| law::constant(&text) == Some(0.0))
        };
        let readings = function.as_deref().map(readings);
        if readings.iter().flatten().any(is_zero) {
            return false;
        }
        let read =
            |reader: &mut Self, pair: [Marker; 2], units: ForceUnits, text: &str| match s.has("ROTATIONAL") {
                true => reader.moment(s, text, pair, units),
                false => reader.line_force(s, text, pair, units),
            };
        let found = match (readings, units) {
            (None, _) => Err("it has no FUNCTION".to_owned()),
            (Some(_), None) => Err(super::loads::NO_UNIT.to_owned()),
            (Some(_), Some(_)) if s.has("ACTIONONLY") => {
                Err("a force on one part alone that depends on positions has no equivalent".to_owned())
            }
            (Some([one, other]), Some(units)) => match self.pair(s) {
                None => return true,
                Some([j, i]) if i.body == j.body => Err("its markers are on the same part".to_owned()),
                Some(pair) => {
                    let found = read(self, pair, units, &one);
                    found.or_else(|why| read(self, pair, units, &other).map_err(|_| why))
                }
            },
        };
        if let Err(why) = found {
            self.notes.refused(&s.name, &s.label, Some(s.at), why);
        }
        true
    }

    /// Adds a spring between two markers whose force is a function of their distance.
    fn line_force(
        &mut self,
        s: &Statement,
        text: &str,
        [j, i]: [Marker; 2],
        units: ForceUnits,
    ) -> Result<(), String> {
        let nominal = (i.pose.r - j.pose.r).norm() / self.scale;
        if !(nominal > 0.0) {
            return Err(
                "its markers coincide in the design configuration, which leaves its direction open".into()
            );
        }
        let measured = |rate: &str, name: &str, x: &[String]| self.distance(s, [j, i], rate, name, x);
        let function = read(text, nominal, &measured)?;
        // Its stops within reach
        let corners: Vec<f64> =
            function.corners.iter().copied().filter(|x| *x > 0.0 && *x < 3.0 * nominal).collect();
        let range = [0.0, 2.0 * corners.iter().copied().fold(nominal, f64::max)];
        if let Some(x) = examined(range).find(|x| !function.at(*x).is_finite()) {
            return Err(format!("its function has no value at a distance of {x}"));
        }
        if examined(range).chain(corners.iter().copied()).all(|x| function.at(x) == 0.0) {
            return Err(format!("it has no force up to a distance of {}", range[1]));
        }
        let mut lost = Vec::new();
        let damping = function.damping(range).unwrap_or_else(|()| {
            lost.push("its damping is not in proportion to the speed alone and is not imported".to_owned());
            0.0
        });
        let per_length = units.force / self.scale;
        let mut spring = Spring { damping: damping * per_length / self.per_second(), ..Spring::default() };
        match function.line(range) {
            // Tension is positive in the model.
            Some(Line { start, slope: 0.0 }) => spring.preload = Some(-start * units.force),
            Some(Line { slope, .. }) if slope > 0.0 => {
                return Err("its stiffness is negative".into());
            }
            Some(Line { start, slope }) => {
                spring.stiffness = -slope * per_length;
                let free = -start / slope * self.scale;
                if free > 0.0 {
                    spring.free = Some(free);
                } else {
                    spring.preload = Some(-function.at(nominal) * units.force);
                }
            }
            None => {
                let table = sampled::sample(|x| function.at(x), range, &corners)
                    .map_err(|x| format!("its function has no value at a distance of {x}"))?;
                // Tension is positive in the model.
                let table = table.times(-units.force);
                let free = corners.first().copied().unwrap_or(nominal);
                spring.free = Some(free * self.scale);
                let point = |[x, force]: &[f64; 2]| [(x - free) * self.scale, force + 0.0];
                spring.extension = table.points.iter().map(point).collect();
                lost.push(table.report(range[1] * self.scale, self.m.length));
            }
        }
        let ends = [(i.body, i.pose.r), (j.body, j.pose.r)];
        self.add_force(s, ForceOn::Points(ends), spring, &lost);
        Ok(())
    }

    fn add_force(&mut self, s: &Statement, on: ForceOn, spring: Spring, lost: &[String]) {
        self.m.force(Force { name: s.label.clone(), note: s.source().note(self.notes), on, spring });
        match lost.is_empty() {
            true => self.notes.taken(&s.name, &s.label, Some(s.at)),
            false => self.notes.approximated(&s.name, &s.label, Some(s.at), lost.join("; ")),
        }
    }

    /// Returns a displacement or velocity between the two markers of a force as an expression of their distance.
    fn distance(
        &self,
        s: &Statement,
        [j, i]: [Marker; 2],
        rate: &str,
        name: &str,
        x: &[String],
    ) -> Option<Result<String, String>> {
        let axis = match name {
            "dm" | "vr" => None,
            "dx" | "vx" => Some(0),
            "dy" | "vy" => Some(1),
            "dz" | "vz" => Some(2),
            _ => return None,
        };
        let ids = ["I", "J"].map(|key| s.reference(key).unwrap_or_default());
        let other = || {
            let of = x.join(", ");
            Some(Err(format!("`{name}({of})` is not a displacement or velocity between its own markers")))
        };
        let [from, to] = match x {
            [a, b, ..] if [a.as_str(), b.as_str()] == ids => [j, i],
            [a, b, ..] if [b.as_str(), a.as_str()] == ids => [i, j],
            _ => return other(),
        };
        let value = if name.starts_with('d') { "t" } else { rate };
        let Some(axis) = axis else { return Some(Ok(value.into())) };
        let axes = match x.get(2) {
            Some(id) => match self.markers.get(id.as_str()) {
                Some(marker) if [i.body, j.body].contains(&marker.body) => *marker,
                Some(_) | None => return other(),
            },
            None => return other(),
        };
        let along = axes.pose.rot.cols[axis];
        let gap = to.pose.r - from.pose.r;
        let is_guided = self.joints.values().any(|k| {
            is_between(k, [i.body, j.body])
                && k.kind == "translational"
                && is_parallel(k.markers[0].z(), along)
        });
        if !is_guided || gap.cross(along).norm() > ALIGNED * gap.norm() {
            return Some(Err(format!(
                "`{name}({})` is not the distance of its markers: no translational joint guides them along that axis",
                x.join(", ")
            )));
        }
        let sign = if gap.dot(along) < 0.0 { "-" } else { "" };
        Some(Ok(format!("({sign}{value})")))
    }

    /// Adds a spring about the axis of a hinge, of which the moment is a function of the angle.
    fn moment(
        &mut self,
        s: &Statement,
        text: &str,
        pair: [Marker; 2],
        units: ForceUnits,
    ) -> Result<(), String> {
        let ids = ["I", "J"].map(|key| s.reference(key).unwrap_or_default());
        let measured = |rate: &str, name: &str, x: &[String]| {
            let value = match name {
                "az" => "t",
                "wz" => rate,
                _ => return None,
            };
            Some(match x {
                [a, b, ..] if [a.as_str(), b.as_str()] == ids => Ok(value.to_owned()),
                [a, b, ..] if [b.as_str(), a.as_str()] == ids => Ok(format!("(-{value})")),
                _ => Err(format!("`{name}({})` is not an angle between its own markers", x.join(", "))),
            })
        };
        let function = read(text, 1.0, &measured)?;
        let range = [-std::f64::consts::PI, std::f64::consts::PI];
        let Some(Line { start, slope }) = function.line(range) else {
            return Err("springs about an axis have constant stiffness in the model".into());
        };
        let damping = function.damping(range);
        let lost = "its damping is not in proportion to the speed alone and is not imported";
        let lost: Vec<String> = damping.err().map(|()| lost.to_owned()).into_iter().collect();
        self.turning_spring(s, pair, [start, slope, -damping.unwrap_or(0.0)], units, &lost)
    }

    /// Adds a spring about the axis of a hinge: on the part of marker I, about z of marker J, the moment is
    /// `a + b angle + c angle'`.
    pub(super) fn turning_spring(
        &mut self,
        s: &Statement,
        [j, i]: [Marker; 2],
        [a, b, c]: [f64; 3],
        units: ForceUnits,
        lost: &[String],
    ) -> Result<(), String> {
        let hinge = self.joints.values().find(|k| {
            let turns = ["revolute", "cylindrical"].contains(&k.kind);
            turns && is_between(k, [i.body, j.body]) && is_parallel(k.markers[0].z(), j.z())
        });
        let Some(hinge) = hinge else {
            return Err("no hinge with its axis is between its parts".into());
        };
        if !is_parallel(i.z(), j.z()) {
            return Err("the z axes of its markers are not parallel".into());
        }
        if !(b <= 0.0 && c <= 0.0) {
            return Err("its stiffness or damping is negative".into());
        }
        if b == 0.0 && a != 0.0 {
            return Err("a constant moment between two parts has no equivalent".into());
        }
        // The angle is that of the design configuration plus the coordinate, with the sign of its axis.
        let sign = coordinate_sign(hinge, i.body, j.z());
        let nominal = offset(&j, &i).angle;
        let per_angle = units.force * self.scale * units.metre;
        let spring = Spring {
            stiffness: -b * per_angle,
            damping: -c * per_angle / self.per_second(),
            free: (b != 0.0).then(|| sign * (-a / b - nominal)),
            ..Spring::default()
        };
        let on = ForceOn::Coordinate(Coordinate { joint: hinge.number, name: "angle" });
        self.add_force(s, on, spring, lost);
        Ok(())
    }
}

/// Functions of the motion of Adams by the expression of the rate, their name and their arguments.
type RateFunctions<'m> = dyn Fn(&str, &str, &[String]) -> Option<Result<String, String>> + 'm;

/// Reads a function of a length and its rate; `measured` gets the rate as an expression. The nominal length defines the
/// speeds at which damping is examined.
fn read(text: &str, nominal: f64, measured: &RateFunctions<'_>) -> Result<LengthFunction, String> {
    let mut at_rates = Vec::new();
    let mut corners = Vec::new();
    let parse = |text: &str| {
        hardpoint::law::Law::parse(text).map_err(|_| format!("its translation `{text}` cannot be evaluated"))
    };
    for part in [0.0, 1.0, -1.0, 5.0] {
        let rate = part * nominal;
        let written = format!("({rate})");
        let found = law::translate_characteristic(text, &|name, x| measured(&written, name, x))?;
        at_rates.push((rate, parse(&found.text)?));
        if part == 0.0 {
            for pair in &found.corners {
                let difference = parse(&format!("({}) - ({})", pair[0], pair[1]))?;
                let [a, b, c] = [0.0, 1.0, 2.0].map(|x| difference.at(x).0[0]);
                let is_line = (c - 2.0 * b + a).abs() <= LINEAR * (a.abs() + c.abs());
                // The root of a straight line
                corners.extend((is_line && a != b).then(|| a / (a - b)).filter(|x| x.is_finite()));
            }
        }
    }
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    Ok(LengthFunction { at_rates, corners })
}

fn is_between(joint: &MarkerJoint, bodies: [usize; 2]) -> bool {
    let own = joint.markers.map(|m| m.body);
    own == bodies || own == [bodies[1], bodies[0]]
}

fn is_parallel(a: Vec3, b: Vec3) -> bool {
    a.cross(b).norm() <= ALIGNED
}
