//! Left and right sides of a vehicle: names, mirror images across y = 0, and the test for symmetry of both sides.

use std::collections::HashSet;

use hardpoint::space::{Mat3, Vec3};
use hardpoint_file::side_names::{WORDS, exchanged, is_original, pieces};

use crate::mechanism::{
    Body, Bushing, Driver, Drives, Force, ForceOn, Joint, Law, Mass, Mechanism, Point, Wheel,
};
use crate::write::SAME_PLACE;

/// Sign of y and suffix of names, left and right.
pub const SIDES: [(f64, &str); 2] = [(1.0, "_left"), (-1.0, "_right")];

/// Words of both sides, the default of a mirror.
const BOTH: [(&str, &str); 1] = [(WORDS[0], WORDS[1])];

/// Returns a point or vector of the left side on the left (1) or mirrored to the right (-1).
pub fn over(v: Vec3, side: f64) -> Vec3 {
    Vec3::from([v.x, side * v.y, v.z])
}

/// Appends a word to a name; the side remains the last word.
pub fn with_word(name: &str, word: &str) -> String {
    let sided = SIDES.iter().find_map(|(_, suffix)| Some((name.strip_suffix(suffix)?, suffix)));
    match sided {
        Some((base, suffix)) => format!("{base}_{word}{suffix}"),
        None => format!("{name}_{word}"),
    }
}

/// Returns true for names of the right side.
pub fn is_right(name: &str) -> bool {
    is_original(name, &BOTH) == Some(false)
}

/// Returns the name of the counterpart on the other side, or the name itself if it has no side.
pub fn other(name: &str) -> String {
    exchanged(name, &BOTH).unwrap_or_else(|| name.to_owned())
}

/// Returns a name of the left side without its side.
pub fn base(name: &str) -> Option<String> {
    if is_original(name, &BOTH) != Some(true) {
        return None;
    }
    let words: Vec<&str> = name.split('_').filter(|word| *word != WORDS[0]).collect();
    Some(words.join("_")).filter(|base| !base.is_empty() && is_original(base, &BOTH).is_none())
}

/// Returns the joints of the right side that are not images of their counterparts, if everything else is symmetric;
/// `None` if it is not, or if there are no sides.
pub fn symmetry(m: &Mechanism) -> Option<HashSet<&str>> {
    let is_sided = |c: &crate::mechanism::Coupler| {
        let joints = c.terms.iter().map(|(c, _)| m.joints[c.joint].name.as_str());
        joints.chain([c.name.as_str()]).any(|name| is_original(name, &BOTH).is_some())
    };
    if m.couplers.iter().any(is_sided) || !m.turned.is_empty() || m.bodies.iter().any(|b| b.mesh.is_some()) {
        return None;
    }
    let image = |b: &Body| m.bodies.iter().position(|other| other.name == self::other(&b.name));
    let bodies = m.bodies.iter().map(image).collect::<Option<Vec<usize>>>()?;
    let mirror = Mirror { m, bodies, near: SAME_PLACE * m.size() };
    let both = |name: &str| WORDS.iter().all(|word| pieces(name).any(|piece| piece == *word));
    let names = m.bodies.iter().map(|b| &b.name).chain(m.joints.iter().map(|j| &j.name));
    if names.chain(m.hardpoints.iter().map(|h| &h.0)).any(|name| both(name)) {
        return None;
    }
    let hardpoints = pairs(&m.hardpoints, |h| &h.0)?;
    let joints = pairs(&m.joints, |j| &j.name)?;
    let is_image = !joints.is_empty()
        && hardpoints.iter().all(|(l, r)| mirror.is_place(l.1, r.1))
        && pairs(&m.bodies, |b| &b.name)?.iter().all(|(l, r)| mirror.is_body(l, r))
        && pairs(&m.drivers, |d| &d.name)?.iter().all(|(l, r)| mirror.is_driver(l, r))
        && pairs(&m.masses, |m| &m.name)?.iter().all(|(l, r)| mirror.is_mass(l, r))
        && pairs(&m.forces, |f| &f.name)?.iter().all(|(l, r)| mirror.is_force(l, r))
        && pairs(&m.points, |p| &p.name)?.iter().all(|(l, r)| mirror.is_point(l, r))
        && pairs(&m.wheels, |w| &w.name)?.iter().all(|(l, r)| mirror.is_wheel(l, r));
    let differs = joints.iter().filter(|(l, r)| !mirror.is_joint(l, r));
    is_image.then(|| differs.map(|(_, right)| right.name.as_str()).collect())
}

/// Pairs the objects of the left side with those of the right side; `None` if one has no counterpart.
fn pairs<T>(list: &[T], name: impl Fn(&T) -> &String) -> Option<Vec<(&T, &T)>> {
    let of =
        |left: bool| list.iter().filter(|t| is_original(name(t), &BOTH) == Some(left)).collect::<Vec<_>>();
    let (left, right) = (of(true), of(false));
    let counterpart = |l: &T| right.iter().copied().find(|r| *name(r) == other(name(l)));
    let pairs: Option<Vec<_>> = left.iter().map(|l| Some((*l, counterpart(l)?))).collect();
    pairs.filter(|_| left.len() == right.len())
}

/// Images of the bodies of a mechanism, and tests for images of other objects.
struct Mirror<'m> {
    m: &'m Mechanism,
    /// Image of each body.
    bodies: Vec<usize>,
    /// Distance below which points coincide.
    near: f64,
}

impl Mirror<'_> {
    fn is_place(&self, left: Vec3, right: Vec3) -> bool {
        (over(left, -1.0) - right).norm() <= self.near
    }

    fn is_direction(left: Vec3, right: Vec3) -> bool {
        let apart = |l: Vec3, r: Vec3| (over(l, -1.0) - r).norm() <= SAME_PLACE;
        left.unit().zip(right.unit()).is_some_and(|(l, r)| apart(l, r))
    }

    /// Returns true if one axis is the image of the other up to its sign, or if both are missing. The sign of an axis
    /// of rotation does not matter.
    fn is_axis(left: Option<Vec3>, right: Option<Vec3>) -> bool {
        match (left, right) {
            (Some(l), Some(r)) => Self::is_direction(l, r) || Self::is_direction(l, -r),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        }
    }

    fn is_at(&self, (l, left): (usize, Vec3), (r, right): (usize, Vec3)) -> bool {
        self.bodies[l] == r && self.is_place(left, right)
    }

    fn are_at(&self, left: Option<[(usize, Vec3); 2]>, right: Option<[(usize, Vec3); 2]>) -> bool {
        match (left, right) {
            (Some(l), Some(r)) => l.into_iter().zip(r).all(|(l, r)| self.is_at(l, r)),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        }
    }

    fn is_body(&self, left: &Body, right: &Body) -> bool {
        let is_upright = |rot: Mat3| rot.cols == Mat3::IDENTITY.cols;
        match (left.pose, right.pose) {
            (Some(l), Some(r)) => self.is_place(l.r, r.r) && is_upright(l.rot) && is_upright(r.rot),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        }
    }

    fn is_joint(&self, left: &Joint, right: &Joint) -> bool {
        let places = left.at.iter().zip(&right.at).all(|(l, r)| self.is_place(*l, *r));
        left.kind == right.kind
            && left.bodies.map(|b| self.bodies[b]) == right.bodies
            && left.at.len() == right.at.len()
            && places
            && left.through.is_some() == right.through.is_some()
            && Self::is_axis(left.axis, right.axis)
            && Self::is_axis(left.axis2, right.axis2)
            && (left.lead, left.length, left.draw) == (right.lead, right.length, right.draw)
    }

    fn is_driver(&self, left: &Driver, right: &Driver) -> bool {
        let held = left.law == Law::Fixed && right.law == Law::Fixed;
        match (left.drives, right.drives) {
            (Drives::Coordinate(l), Drives::Coordinate(r)) => {
                let [one, two] = [l, r].map(|c| &self.m.joints[c.joint].name);
                held && l.name == r.name && *two == other(one)
            }
            (
                Drives::Translation { body: l, at: from, along },
                Drives::Translation { body: r, at: to, along: other_along },
            ) => {
                self.is_at((l, from), (r, to))
                    && Self::is_direction(along, other_along)
                    && left.law == right.law
            }
            (
                Drives::Rotation { body: l, about, relative_to: base },
                Drives::Rotation { body: r, about: other_about, relative_to: other_base },
            ) => {
                held && self.bodies[l] == r
                    && self.bodies[base] == other_base
                    && Self::is_axis(Some(about), Some(other_about))
            }
            (Drives::Coordinate(_) | Drives::Translation { .. } | Drives::Rotation { .. }, _) => false,
        }
    }

    fn is_mass(&self, left: &Mass, right: &Mass) -> bool {
        let same = match (left.inertia, right.inertia) {
            (Some(l), Some(r)) => {
                let most = l.cols.iter().chain(&r.cols).map(|c| c.norm()).fold(0.0, f64::max);
                let near =
                    |c: usize| (over(if c == 1 { -l.cols[c] } else { l.cols[c] }, -1.0) - r.cols[c]).norm();
                (0..3).all(|c| near(c) <= SAME_PLACE * most)
            }
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        };
        same && left.mass == right.mass && self.is_at((left.body, left.centre), (right.body, right.centre))
    }

    fn is_force(&self, left: &Force, right: &Force) -> bool {
        let ends = |on| match on {
            ForceOn::Points(ends) => Some(ends),
            // The sign on the other side depends on the joint, or on the axes.
            ForceOn::Coordinate(_) | ForceOn::Bushing(..) | ForceOn::Joint(..) | ForceOn::Constant(..) => {
                None
            }
        };
        if let (ForceOn::Joint(l, left_law), ForceOn::Joint(r, right_law)) = (left.on, right.on) {
            let names = [l, r].map(|k| &self.m.joints[k].name);
            return *names[1] == other(names[0]) && left_law == right_law && left.spring == right.spring;
        }
        // The mirror takes the x and z axes as arrows, so that y is the opposite of an image.
        let is_image = |l: Bushing, r: Bushing| {
            let signs = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
            let is_axis = |k: usize| Self::is_direction(l.axes.cols[k], r.axes.cols[k]);
            let preload = (0..6).all(|k| l.preload[k] * signs[k] == r.preload[k]);
            is_axis(0) && is_axis(2) && l.stiffness == r.stiffness && preload
        };
        if let (ForceOn::Bushing(l, left_law), ForceOn::Bushing(r, right_law)) = (left.on, right.on) {
            return self.are_at(Some(l), Some(r))
                && left.spring == right.spring
                && is_image(left_law, right_law);
        }
        let (l, r) = (ends(left.on), ends(right.on));
        l.is_some() && self.are_at(l, r) && left.spring == right.spring
    }

    fn is_point(&self, left: &Point, right: &Point) -> bool {
        self.is_at((left.body, left.at), (right.body, right.at))
    }

    fn is_wheel(&self, left: &Wheel, right: &Wheel) -> bool {
        let [l, r] = [left, right].map(|w| &self.m.drivers[w.bump].name);
        let spindles = match (left.spindle, right.spindle) {
            (Some(l), Some(r)) => self.is_place(l, r),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        };
        self.is_at((left.body, left.centre), (right.body, right.centre))
            && Self::is_direction(left.spin_axis, right.spin_axis)
            && spindles
            && (left.radius, left.is_steered, left.end) == (right.radius, right.is_steered, right.end)
            && self.are_at(left.kingpin, right.kingpin)
            && self.are_at(left.spring, right.spring)
            && *r == other(l)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_is_the_last_word_of_a_name_and_is_exchanged_anywhere_in_it() {
        assert_eq!(with_word("tie_rod_left", "inner"), "tie_rod_inner_left");
        assert_eq!(with_word("rack", "slide"), "rack_slide");
        assert_eq!(other("left_arm-right"), "right_arm-left");
        assert_eq!(other("leftover_left"), "leftover_right");
        assert_eq!(base("lca_front_left").as_deref(), Some("lca_front"));
        assert_eq!(base("left_lca").as_deref(), Some("lca"));
        assert_eq!((base("lca_right"), base("left"), base("leftover")), (None, None, None));
    }
}
