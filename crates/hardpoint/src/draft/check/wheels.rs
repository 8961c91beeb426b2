//! Checks of the vehicle, road wheels, axles and their measures.

use crate::draft::{AxleDraft, PointRef, Section, WheelDraft, WheelSpinDraft};
use crate::model::{
    ArmPlane, Axle, AxleId, AxleMeasure, BodyId, BodyPoint, Direction, HardpointId, MeasureKind, PointId,
    Side, TorqueReaction, VehicleEnd, Wheel, WheelId, WheelMeasure, WheelRequirement,
};
use crate::space::Vec3;

use super::{Checker, Here, SAME_POINT};

/// Relative horizontal component below which a direction is vertical, and vertical component below which it is
/// horizontal.
const MIN_SINE: f64 = 1e-6;

impl Checker<'_> {
    pub(super) fn check_vehicle(&mut self) {
        let v = &self.draft.vehicle;
        let here = Here { section: Section::Vehicle, index: 0 };
        for (key, value) in [("wheelbase", v.wheelbase), ("cg_height", v.cg_height)] {
            if value.is_some_and(|x| !(x > 0.0 && x.is_finite())) {
                self.fault("HP0231", here.key(key), format!("the {key} of the vehicle is not positive"))
                    .help("give a positive length, in the file's length unit");
            }
        }
        for (key, value) in
            [("front_brake_share", v.front_brake_share), ("front_drive_share", v.front_drive_share)]
        {
            if value.is_some_and(|x| !(0.0..=1.0).contains(&x)) {
                self.fault(
                    "HP0231",
                    here.key(key),
                    format!("the {key} of the vehicle is not between 0 and 1"),
                )
                .help("give the share of the front wheels, 0 to 1");
            }
        }
    }

    pub(super) fn add_axles(&mut self) {
        let draft = self.draft;
        for (index, a) in draft.axles.iter().enumerate() {
            let here = Here { section: Section::Axles, index };
            let axle = self.one_axle(a, here);
            self.axle_ids.push(axle.as_ref().map(|_| AxleId(self.model.axles.len())));
            self.model.axles.extend(axle);
        }
    }

    /// Resolves an axle; `None` if it or one of its wheels is faulty.
    fn one_axle(&mut self, a: &AxleDraft, here: Here) -> Option<Axle> {
        let draft = self.draft;
        let mut wheel = |key: &'static str, name: &str, side: Side| {
            let names = draft.wheels.iter().map(|w| w.name.as_str());
            let k = self.find("wheel", name, here.key(key), names)?;
            let id = self.wheel_ids[k]?;
            if self.model.wheels[id.0].side != side {
                let message =
                    format!("the {key} wheel of axle `{}` is on the wrong side of the vehicle", a.name);
                self.fault("HP0231", here.key(key), message)
                    .help(format!("name the wheel on the {key}; y points left"));
                return None;
            }
            Some(id)
        };
        let (left, right) = (wheel("left", &a.left, Side::Left), wheel("right", &a.right, Side::Right));
        Some(Axle { name: a.name.clone(), wheels: [left?, right?] })
    }

    /// Resolves a measure of an axle; `None`, without a second error, if the axle itself is faulty.
    pub(super) fn axle_measure(&mut self, name: &str, what: AxleMeasure, here: Here) -> Option<MeasureKind> {
        let draft = self.draft;
        let names = draft.axles.iter().map(|a| a.name.as_str());
        let k = self.find("axle", name, here.key("axle"), names)?;
        let axle = self.axle_ids[k]?;
        if what.needs_wheelbase() && draft.vehicle.wheelbase.is_none() {
            if self.vehicle_is_unread() {
                return None;
            }
            let message = format!("`{}` needs the wheelbase of the vehicle", what.name());
            self.fault("HP0232", here.key("type"), message).help("add `[vehicle]` with `wheelbase = ...`");
            return None;
        }
        let unmoved =
            self.model.axles[axle.0].wheels.into_iter().find(|w| self.model.wheels[w.0].bump.is_none());
        if let Some(wheel) = unmoved.filter(|_| what.depends_on_driver()) {
            let wheel = self.model.wheels[wheel.0].name.clone();
            self.report_missing_driver(what.name(), &wheel, WheelRequirement::Bump, here);
            return None;
        }
        Some(MeasureKind::Axle { axle, what })
    }

    pub(super) fn vehicle_is_unread(&self) -> bool {
        self.draft.unread.any(Section::Vehicle, 0) || self.is_table_unread("vehicle")
    }

    fn report_missing_driver(&mut self, what: &str, wheel: &str, need: WheelRequirement, here: Here) {
        if self.is_table_unread("driver") {
            return;
        }
        let drivers: Vec<String> = self.draft.drivers.iter().map(|d| format!("`{}`", d.name)).collect();
        let (does, key) = match need {
            WheelRequirement::Steer => (format!("steers wheel `{wheel}`"), "steer"),
            _ => (format!("moves wheel `{wheel}` up and down"), "bump"),
        };
        let message = format!("`{what}` needs the driver that {does}");
        self.fault("HP0232", here.key("type"), message)
            .note(format!("drivers: {}", drivers.join(", ")))
            .help(format!("add `{key} = DRIVER` to the wheel"));
    }

    pub(super) fn add_wheels(&mut self) {
        let draft = self.draft;
        for (index, w) in draft.wheels.iter().enumerate() {
            let here = Here { section: Section::Wheels, index };
            let wheel = self.one_wheel(w, here);
            self.wheel_ids.push(wheel.as_ref().map(|_| WheelId(self.model.wheels.len())));
            self.model.wheels.extend(wheel);
        }
        // A body that carries wheels of both sides is a live axle with its differential.
        let carried: Vec<(BodyId, Side)> = self.model.wheels.iter().map(|w| (w.body, w.side)).collect();
        for (id, given) in self.wheel_ids.iter().zip(&draft.wheels) {
            let Some(id) = id.filter(|_| given.drive.is_none()) else { continue };
            let wheel = &mut self.model.wheels[id.0];
            if carried.iter().any(|(body, side)| *body == wheel.body && *side != wheel.side) {
                wheel.drive = TorqueReaction::Outboard;
            }
        }
    }

    /// Resolves a wheel; `None` if it is faulty.
    fn one_wheel(&mut self, w: &WheelDraft, here: Here) -> Option<Wheel> {
        let faults = self.faults.len();
        let body = self.body(&w.body, here.key("body"));
        let [centre, radius, spin, side, bump] =
            ["centre", "radius", "spin_axis", "side", "bump"].map(|key| !self.unread(here, key));
        if ["kingpin", "steer", "arm_planes", "spring"].into_iter().any(|key| self.unread(here, key)) {
            return None;
        }
        let centre = if centre { self.place(&w.centre, &w.name, here.key("centre")) } else { None };
        if radius && !(w.radius > 0.0 && w.radius.is_finite()) {
            self.fault(
                "HP0231",
                here.key("radius"),
                format!("the radius of wheel `{}` is not positive", w.name),
            )
            .help("give the distance from the wheel's centre to the ground");
        }
        let side = w.side.or_else(|| centre.filter(|_| side).and_then(|c| self.side_of(w, c, here)));
        let spin_axis = if spin { self.spin_axis(w, side, here) } else { None };
        let kingpin = match &w.kingpin {
            Some(points) => Some(self.kingpin(w, points, here)?),
            None => None,
        };
        let planes = match &w.planes {
            Some([lower, upper]) => {
                let (lower, upper) = (self.arm_plane(w, lower, 0, here), self.arm_plane(w, upper, 1, here));
                Some([lower?, upper?])
            }
            None => None,
        };
        let spring = match &w.spring {
            Some(ends) => Some(self.spring(w, ends, here)?),
            None => None,
        };
        let steer = match &w.steer {
            Some(name) => Some(self.driver_named(name, here.key("steer"))?),
            None => None,
        };
        let bump = match &w.bump {
            None if !bump => return None,
            None if self.draft.drivers.len() == 1 => Some(self.driver_ids[0]?),
            None => None,
            Some(name) => Some(self.driver_named(name, here.key("bump"))?),
        };
        let (body, at, side, spin_axis) = (body?, centre?, side?, spin_axis?);
        self.model.points.push(BodyPoint { name: w.name.clone(), body, at, unnamed: true });
        let centre = PointId(self.model.points.len() - 1);
        let (name, radius, end) = (w.name.clone(), w.radius, w.end);
        let brakes = w.brakes.unwrap_or(TorqueReaction::Outboard);
        let drive = w.drive.unwrap_or(TorqueReaction::Inboard);
        let wheel = Wheel {
            name,
            body,
            centre,
            spin_axis,
            radius,
            side,
            kingpin,
            bump,
            steer,
            planes,
            spring,
            end,
            drive,
            brakes,
        };
        (self.faults.len() == faults && !self.draft.unread.any(here.section, here.index)).then_some(wheel)
    }

    /// Returns body, centre, side and spin axis of a wheel in the design configuration.
    pub(super) fn nominal_wheel(
        &mut self,
        w: &WheelDraft,
        index: usize,
    ) -> Option<(BodyId, HardpointId, Side, Direction)> {
        let here = Here { section: Section::Wheels, index };
        if ["body", "centre", "spin_axis", "side"].into_iter().any(|key| self.unread(here, key)) {
            return None;
        }
        let body = self.body(&w.body, here.key("body"))?;
        let centre = self.place(&w.centre, &w.name, here.key("centre"))?;
        let side = w.side.or_else(|| self.side_of(w, centre, here))?;
        Some((body, centre, side, self.spin_axis(w, Some(side), here)?))
    }

    /// Returns the side of the vehicle of a wheel's centre; y points left.
    fn side_of(&mut self, w: &WheelDraft, centre: HardpointId, here: Here) -> Option<Side> {
        let y = self.position(centre)?.y;
        if !(y.abs() > SAME_POINT * self.extent.size()) {
            let message = format!("wheel `{}` is on neither side of the vehicle", w.name);
            self.fault("HP0231", here.key("centre"), message)
                .note("the y coordinate of its centre is zero")
                .help("give `side = \"left\"` or `side = \"right\"`");
            return None;
        }
        Some(if y > 0.0 { Side::Left } else { Side::Right })
    }

    /// Resolves the spin axis. HP0231 unless it points outboard.
    fn spin_axis(&mut self, w: &WheelDraft, side: Option<Side>, here: Here) -> Option<Direction> {
        match &w.spin {
            WheelSpinDraft::Axis(line) => {
                let (axis, e) = self.line(line, &w.name, here, "spin_axis")?;
                let side = side?;
                let name = &w.name;
                let (message, help) = if e.x.hypot(e.y) <= MIN_SINE {
                    (
                        format!("the spin axis of wheel `{name}` is vertical"),
                        "give the axis that the wheel spins about",
                    )
                } else if !(side.sign() * e.y > 0.0) {
                    let message = format!("the spin axis of wheel `{name}` does not point outboard");
                    (message, "reverse it, or give the `side` of the wheel; y points left")
                } else {
                    return Some(axis);
                };
                self.fault("HP0231", here.key("spin_axis"), message)
                    .note(format!(
                        "it points along [{:.4}, {:.4}, {:.4}]; a {} wheel's points to {}y",
                        e.x,
                        e.y,
                        e.z,
                        side.name(),
                        if side == Side::Left { "+" } else { "-" }
                    ))
                    .help(help);
                None
            }
            WheelSpinDraft::Angles { toe, camber } => {
                let quarter = std::f64::consts::FRAC_PI_2;
                let mut upright = true;
                for (key, angle) in [("toe", toe), ("camber", camber)] {
                    if !(angle.abs() < quarter * (1.0 - MIN_SINE)) {
                        upright = false;
                        let message = format!("the {key} of wheel `{}` is 90 deg or more", w.name);
                        self.fault("HP0231", here.key(key), message)
                            .help("give the angle of the design configuration, in the file's angle unit");
                    }
                }
                let ((toe, to_y), (camber, to_side)) = (toe.sin_cos(), camber.sin_cos());
                let y = side?.sign() * to_y;
                upright.then(|| Direction::Along(Vec3::new(to_side * toe, to_side * y, -camber)))
            }
        }
    }

    /// Resolves the points of the kingpin. HP0231 unless the upper one is above the lower.
    fn kingpin(&mut self, w: &WheelDraft, points: &[PointRef; 2], here: Here) -> Option<[PointId; 2]> {
        let [lower, upper] = [0, 1].map(|k| self.point(&points[k], &w.name, here.item("kingpin", k)));
        let (lower, upper) = (lower?, upper?);
        let [low, high] = [lower, upper].map(|p| self.position(self.model.points[p.0].at));
        let k = high? - low?;
        let name = &w.name;
        let (message, help) = if !(k.norm() > SAME_POINT * self.extent.size()) {
            (
                format!("the two points of the kingpin of wheel `{name}` coincide"),
                "name a lower and an upper point of the axis that the wheel steers about",
            )
        } else if k.z.abs() <= MIN_SINE * k.norm() {
            (
                format!("the kingpin of wheel `{name}` is horizontal"),
                "name an upper point that lies above the lower one",
            )
        } else if !(k.z > 0.0) {
            (
                format!("the kingpin of wheel `{name}` points down"),
                "list its lower point first, then its upper one",
            )
        } else {
            return Some([lower, upper]);
        };
        self.fault("HP0231", here.key("kingpin"), message).help(help);
        None
    }

    /// Resolves the plane of an arm. HP0231 unless its points define a plane.
    fn arm_plane(&mut self, w: &WheelDraft, points: &[PointRef], arm: usize, here: Here) -> Option<ArmPlane> {
        let found: Vec<Option<PointId>> =
            points.iter().map(|p| self.point(p, &w.name, here.item("arm_planes", arm))).collect();
        let found: Vec<PointId> = found.into_iter().collect::<Option<_>>()?;
        let places = found.iter().map(|p| self.position(self.model.points[p.0].at));
        let places: Vec<Vec3> = places.collect::<Option<_>>()?;
        let size = self.extent.size();
        let (name, which) = (&w.name, ["lower", "upper"][arm]);
        let (plane, makes_one) = match (&found[..], &places[..]) {
            (&[a, b, c], &[p, q, r]) => {
                let (along, across) = (q - p, (q - p).cross(r - p));
                (ArmPlane::Through([a, b, c]), across.norm() > SAME_POINT * size * along.norm())
            }
            (&[a, b], &[p, q]) => (ArmPlane::Square([a, b]), (q - p).norm() > SAME_POINT * size),
            _ => {
                let message = format!("the {which} plane of wheel `{name}` has {} points", found.len());
                self.fault("HP0231", here.item("arm_planes", arm), message).help(
                    "give three points of an arm, or two of a strut: its top mount and another point of its axis",
                );
                return None;
            }
        };
        if makes_one {
            return Some(plane);
        }
        let message = format!("the points of the {which} plane of wheel `{name}` do not define a plane");
        self.fault("HP0231", here.item("arm_planes", arm), message).help(match plane {
            ArmPlane::Through(_) => "name two pivots and the ball joint of an arm that are not on one line",
            ArmPlane::Square(_) => "name a strut's top mount and another point of its axis",
        });
        None
    }

    /// Resolves the ends of the spring. HP0231 if they coincide.
    fn spring(&mut self, w: &WheelDraft, ends: &[PointRef; 2], here: Here) -> Option<[PointId; 2]> {
        let [a, b] = [0, 1].map(|k| self.point(&ends[k], &w.name, here.item("spring", k)));
        let ends = [a?, b?];
        let [p, q] = ends.map(|p| self.position(self.model.points[p.0].at));
        if !((q? - p?).norm() > SAME_POINT * self.extent.size()) {
            let message = format!("the two ends of the spring of wheel `{}` coincide", w.name);
            self.fault("HP0231", here.key("spring"), message)
                .help("name the ends of the spring, one on each body");
            return None;
        }
        Some(ends)
    }

    /// Resolves a measure of a wheel; `None`, without a second error, if the wheel itself is faulty.
    pub(super) fn wheel_measure(
        &mut self,
        name: &str,
        what: WheelMeasure,
        here: Here,
    ) -> Option<MeasureKind> {
        let draft = self.draft;
        let names = draft.wheels.iter().map(|w| w.name.as_str());
        let k = self.find("wheel", name, here.key("wheel"), names)?;
        let wheel = Here { section: Section::Wheels, index: k };
        if what.needs_kingpin() && draft.wheels[k].kingpin.is_none() && !self.unread(wheel, "kingpin") {
            let message = format!("`{}` needs the kingpin of wheel `{name}`, which has none", what.name());
            self.fault("HP0232", here.key("type"), message).help(
                "add `kingpin = [LOWER, UPPER]` to the wheel, two points of the axis that it steers about, each a \
                 point's name or `{ body = ..., at = ... }`",
            );
            return None;
        }
        let (given, help) = (&draft.wheels[k], "add to the wheel ");
        let lacks = match what.needs() {
            WheelRequirement::Planes if given.planes.is_none() && !self.unread(wheel, "arm_planes") => {
                Some((
                    "planes of the arms",
                    "`arm_planes = [LOWER, UPPER]`, each `{ body = ..., at = [PIVOT, PIVOT, BALL] }`",
                ))
            }
            WheelRequirement::Spring if given.spring.is_none() && !self.unread(wheel, "spring") => {
                Some(("spring", "`spring = [END, END]`, each a point's name or `{ body = ..., at = ... }`"))
            }
            _ => None,
        };
        if let Some((lacks, add)) = lacks {
            let message = format!("`{}` needs the {lacks} of wheel `{name}`, which has none", what.name());
            self.fault("HP0232", here.key("type"), message).help(format!("{help}{add}"));
            return None;
        }
        let id = self.wheel_ids[k]?;
        let (needs, wheel) = (what.needs(), &self.model.wheels[id.0]);
        if needs.depends_on_driver() && wheel.driver(needs).is_none() {
            self.report_missing_driver(what.name(), name, needs, here);
            return None;
        }
        if let (Some(end), Some(at)) = (needs.end(), wheel.end)
            && end != at
        {
            let message =
                format!("`{}` applies to {} wheels, but `{name}` is not one", what.name(), end.name());
            self.fault("HP0232", here.key("type"), message).help(match end {
                VehicleEnd::Front => "at the rear measure `anti_lift` or `anti_squat`",
                VehicleEnd::Rear => "at the front measure `anti_dive` or `anti_rise`",
            });
            return None;
        }
        let missing: Vec<String> = draft.vehicle.lacks(needs).map(|key| format!("`{key} = ...`")).collect();
        if !missing.is_empty() && self.vehicle_is_unread() {
            return None;
        }
        if !missing.is_empty() {
            let message = format!("`{}` needs vehicle data that is missing", what.name());
            let help = format!("add to `[vehicle]`: {}", missing.join(", "));
            self.fault("HP0232", here.key("type"), message).help(help);
            return None;
        }
        Some(MeasureKind::Wheel { wheel: id, what })
    }
}
