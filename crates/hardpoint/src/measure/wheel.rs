//! Formulas of a wheel and its kingpin. Their signs: `docs/measures.md`.
//!
//! | here | symbol there | |
//! |---|---|---|
//! | `centre`, `radius` | W, R | wheel centre, global, m; from it to the ground in the wheel's plane, m |
//! | `spin_axis` | e | unit vector, outboard |
//! | `side` | s | 1 left, -1 right |
//! | `kingpin` | L, U, k = U - L | lower and upper point, global, m |
//! | `contact()`, `outboard()`, `forward()` | C, o, f | |
//! | `off_kingpin(P)` | d(P) | |
//! | `.d` of a number of [`TravellingWheel`], `carrier` | X', w and v | per unit of the driver q, (11) with `L_u = 1` |

use crate::model::{AxleMotion, TorqueReaction, Vehicle, VehicleEnd, WheelMeasure, WheelRequirement};
use crate::number::{self, Dual, Real};
use crate::space::{Twist, Vec3};

/// A wheel somewhere on its way: z is up and the ground level.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WheelAt<T> {
    /// Wheel centre.
    pub centre: Vec3<T>,
    /// Unit vector, outboard.
    pub spin_axis: Vec3<T>,
    pub radius: T,
    /// 1 for a left wheel, -1 for a right one.
    pub side: T,
    /// A lower and an upper point of the axis that it steers about.
    pub kingpin: Option<[Vec3<T>; 2]>,
    /// Planes of the lower and the upper arm: a normal, of any length, and a point.
    pub planes: Option<[[Vec3<T>; 2]; 2]>,
    /// Length of the spring.
    pub spring: Option<T>,
}

/// `atan2(e_x, s e_y)` of the outboard spin axis e of a wheel on side s.
pub(super) fn toe<T: Real>(e: Vec3<T>, side: T) -> T {
    bearing([e.x, side * e.y], T::one())
}

/// `atan2(y, x)` of a part [y, x] of a vector with this square; NaN if the part is round-off beside the vector.
fn bearing<T: Real>([y, x]: [T; 2], square: T) -> T {
    if is_seen(y * y + x * x, square) { y.atan2(x) } else { T::constant(f64::NAN) }
}

/// True if the square of a part is not round-off beside the square of the whole.
fn is_seen<T: Real>(part: T, whole: T) -> bool {
    part.exceeds(whole * T::constant(STILL * STILL))
}

/// `-asin(e_z)`.
pub(super) fn camber<T: Real>(e: Vec3<T>) -> T {
    -e.z.asin()
}

impl<T: Real> WheelAt<T> {
    /// The value of a measure; `design` is the wheel in the design configuration.
    pub fn measure(&self, what: WheelMeasure, design: impl Fn() -> Self) -> T {
        match what {
            WheelMeasure::Toe => toe(self.spin_axis, self.side),
            WheelMeasure::Camber => camber(self.spin_axis),
            // -atan2(e_z, s e_y)
            WheelMeasure::CamberFront => -bearing([self.spin_axis.z, self.side * self.spin_axis.y], T::one()),
            // atan2(z . (f_0 x f), f_0 . f)
            WheelMeasure::SteerAngle => {
                let (d, f) = (design().forward(), self.forward());
                d.cross(f).z.atan2(d.dot(f))
            }
            // atan2(-k_x, k_z)
            WheelMeasure::Caster => {
                let k = self.along_kingpin();
                bearing([-k.x, k.z], k.dot(k))
            }
            // atan2(-s k_y, k_z)
            WheelMeasure::KingpinInclination => {
                let k = self.along_kingpin();
                bearing([-self.side * k.y, k.z], k.dot(k))
            }
            // d(C) . o
            WheelMeasure::ScrubRadius => self.off_kingpin(self.contact()).dot(self.outboard()),
            // d(W) . o
            WheelMeasure::SpindleOffset => self.off_kingpin(self.centre).dot(self.outboard()),
            // -d(C) . f
            WheelMeasure::CasterTrail => self.caster_trail(),
            WheelMeasure::MechanicalTrail => {
                // The kingpin as the wheel's side view shows it: its slope is that of k.f against k.z.
                let k = self.along_kingpin();
                let aside = k.dot(self.forward());
                // caster_trail k_z / sqrt((k . f)^2 + k_z^2)
                self.caster_trail() * k.z / (aside * aside + k.z * k.z).sqrt()
            }
            // d(W) . f
            WheelMeasure::HubTrail => self.off_kingpin(self.centre).dot(self.forward()),
            // W_z - W0_z,    W0_x - W_x
            WheelMeasure::WheelTravel => self.centre.z - design().centre.z,
            WheelMeasure::WheelRecession => design().centre.x - self.centre.x,
            // s C_y,    s (C_y - C0_y)
            WheelMeasure::HalfTrack => self.half_track(),
            WheelMeasure::HalfTrackChange => self.half_track() - design().half_track(),
            WheelMeasure::ContactX => self.contact().x,
            WheelMeasure::ContactY => self.contact().y,
            WheelMeasure::ContactZ => self.contact().z,
            // C + m / m_0 of the lines in which the planes x = C_x, or y = C_y, cut those of the arms
            WheelMeasure::PlaneCentreFrontY => self.contact().y + self.planes_meet(1).beside(),
            WheelMeasure::PlaneCentreFrontZ => self.contact().z + self.planes_meet(1).above(),
            WheelMeasure::PlaneCentreSideX => self.contact().x + self.planes_meet(0).beside(),
            WheelMeasure::PlaneCentreSideZ => self.contact().z + self.planes_meet(0).above(),
            // The line from C to there meets y = 0 at -C_y m_z / m_y above C, also where it is at infinity.
            WheelMeasure::RollCentreHeightPlanes => {
                let meet = self.planes_meet(1);
                -(self.contact().y * meet.z / meet.aside)
            }
            WheelMeasure::BumpSteer
            | WheelMeasure::BumpCamber
            | WheelMeasure::BumpRecession
            | WheelMeasure::BumpScrub
            | WheelMeasure::RollCentreHeight
            | WheelMeasure::RollCentreHeightGeometric
            | WheelMeasure::FrontCentreY
            | WheelMeasure::FrontCentreZ
            | WheelMeasure::SideCentreX
            | WheelMeasure::SideCentreZ
            | WheelMeasure::InstantAxisX
            | WheelMeasure::InstantAxisY
            | WheelMeasure::InstantAxisZ
            | WheelMeasure::SwingArmFront
            | WheelMeasure::SwingArmSide
            | WheelMeasure::MotionRatio
            | WheelMeasure::VirtualCaster
            | WheelMeasure::VirtualKingpinInclination
            | WheelMeasure::VirtualScrubRadius
            | WheelMeasure::VirtualSpindleOffset
            | WheelMeasure::VirtualCasterTrail
            | WheelMeasure::VirtualMechanicalTrail
            | WheelMeasure::VirtualHubTrail
            | WheelMeasure::AntiDive
            | WheelMeasure::AntiLift
            | WheelMeasure::AntiSquat
            | WheelMeasure::AntiRise => T::constant(f64::NAN),
        }
    }

    /// Intersection of the planes of the arms in a view that shows z and another axis, relative to the contact point,
    /// in its plane.
    fn planes_meet(&self, axis: usize) -> Meet<T> {
        let planes = self.planes.expect("a measure that needs planes is of a wheel that has them");
        let contact = self.contact();
        // n_a a + n_z z = n . (P - C) of both,  solved by Cramer's rule
        let [(a, z, d), (b, y, e)] = number::both(planes, |[n, p]| (n[axis], n.z, n.dot(p - contact)));
        let lengths = number::both(planes, |[n, _]| n.norm());
        Meet { aside: d * y - z * e, z: a * e - d * b, by: a * y - z * b, lengths: lengths[0] * lengths[1] }
    }

    /// Outboard along the ground: the horizontal part of the spin axis, of unit length; NaN if the axis is vertical.
    pub fn outboard(&self) -> Vec3<T> {
        // o = (e_x, e_y, 0) / sqrt(e_x^2 + e_y^2)
        let Vec3 { x, y, .. } = self.spin_axis;
        Vec3::new(x, y, T::zero()) * (T::one() / if_moving((x * x + y * y).sqrt(), T::one()))
    }

    /// Forward along the ground: where the wheel's plane and the ground meet.
    pub fn forward(&self) -> Vec3<T> {
        // f = (s o_y, -s o_x, 0): o turned by a right angle, to the right of a left wheel's outboard and to the left of
        // a right one's
        let Vec3 { x, y, z } = self.outboard();
        Vec3::new(self.side * y, -self.side * x, z)
    }

    /// The contact point, the lowest of the wheel: from the centre along the direction in its plane that points most
    /// downward; NaN if its axis is vertical.
    pub fn contact(&self) -> Vec3<T> {
        let e = self.spin_axis;
        // C = W - R u,    u = (z - (z . e) e) / abs(z - (z . e) e)
        let up = Vec3::AXES[2].spread() - e * e.z;
        self.centre - up * (self.radius / if_moving(up.norm(), T::one()))
    }

    fn half_track(&self) -> T {
        self.side * self.contact().y
    }

    fn caster_trail(&self) -> T {
        -self.off_kingpin(self.contact()).dot(self.forward())
    }

    /// From the lower point of the kingpin to the upper one.
    fn along_kingpin(&self) -> Vec3<T> {
        let [lower, upper] = self.kingpin();
        upper - lower
    }

    /// From the kingpin to a point, at the point's height: `P - L - k (P_z - L_z) / k_z`; NaN if the kingpin is
    /// horizontal.
    fn off_kingpin(&self, p: Vec3<T>) -> Vec3<T> {
        let [lower, upper] = self.kingpin();
        let (d, k) = (p - lower, upper - lower);
        // d(P) = P - L - k (P_z - L_z) / k_z
        d - k * (d.z / if_moving(k.z, k.dot(k)))
    }

    fn kingpin(&self) -> [Vec3<T>; 2] {
        self.kingpin.expect("a measure that needs the kingpin is of a wheel that has one")
    }
}

/// Intersection of two lines in a plane: `aside / by` and `z / by` relative to a point.
struct Meet<T> {
    aside: T,
    z: T,
    by: T,
    /// Product of the lengths of both normals.
    lengths: T,
}

impl<T: Real> Meet<T> {
    fn beside(&self) -> T {
        self.aside / self.apart()
    }

    fn above(&self) -> T {
        self.z / self.apart()
    }

    /// For division; NaN where lines that are nearly parallel meet at infinity.
    fn apart(&self) -> T {
        let limit = self.lengths * T::constant(AT_INFINITY);
        if self.by.abs().exceeds(limit) { self.by } else { T::constant(f64::NAN) }
    }
}

/// A wheel while the driver that moves it up and down, or the one that steers it, moves alone: derivatives are by that
/// driver.
pub(super) struct TravellingWheel<T> {
    pub wheel: WheelAt<Dual<T>>,
    /// The motion of the body that it turns on.
    pub carrier: Twist<T>,
    /// Places where the torques of its drive and its brakes are reacted.
    pub drive: TorqueReaction,
    pub brakes: TorqueReaction,
}

impl<T: Real> TravellingWheel<T> {
    /// The value of a measure that depends on this driver.
    pub fn measure(&self, what: WheelMeasure, vehicle: &Vehicle) -> T {
        let wheel = &self.wheel;
        // W_z', C and C': the contact point wanders on the wheel, so C' is not the velocity of a point of the carrier.
        let (rise, contact) = (|| self.if_rising(wheel.centre.z.d), wheel.contact());
        let (c, path) = (contact.map(|x| x.v), contact.map(|x| x.d));
        let Twist { w, .. } = self.carrier;
        // Of the carrier's point that is at C now.
        let v = self.carrier.at(c);
        let side = wheel.side.v;
        if let Some(what) = what.of_kingpin() {
            return self
                .about_its_screw(w, v, c)
                .measure(what, || unreachable!("no kingpin's measure counts"));
        }
        match what {
            // toe' / W_z',    camber' / W_z',    -W_x' / W_z',    s C_y' / W_z'
            WheelMeasure::BumpSteer => toe(wheel.spin_axis, wheel.side).d / rise(),
            WheelMeasure::BumpCamber => camber(wheel.spin_axis).d / rise(),
            WheelMeasure::BumpRecession => -wheel.centre.x.d / rise(),
            WheelMeasure::BumpScrub => side * path.y / rise(),
            // The line from C perpendicular to its path (C_y', C_z') meets y = 0 at C_y C_y' / C_z' above C; geometric
            // with v in place of C'.
            WheelMeasure::RollCentreHeight => c.y * path.y / self.if_rising(path.z),
            WheelMeasure::RollCentreHeightGeometric => c.y * v.y / self.if_rising(v.z),
            // v + w x (P - C) = 0 in y and z at P_x = C_x:  v_y - w_x (P_z - C_z) = 0,  v_z + w_x (P_y - C_y) = 0
            WheelMeasure::FrontCentreY => c.y - v.z / self.seen(w.x),
            WheelMeasure::FrontCentreZ => c.z + v.y / self.seen(w.x),
            // ... in x and z at P_y = C_y:  v_x + w_y (P_z - C_z) = 0,  v_z - w_y (P_x - C_x) = 0
            WheelMeasure::SideCentreX => c.x + v.z / self.seen(w.y),
            WheelMeasure::SideCentreZ => c.z - v.x / self.seen(w.y),
            // s (C_y - P_y),  P_x - C_x  of these
            WheelMeasure::SwingArmFront => side * v.z / self.seen(w.x),
            WheelMeasure::SwingArmSide => v.z / self.seen(w.y),
            // -l' / W_z'
            WheelMeasure::MotionRatio => {
                let spring = wheel.spring.expect("a motion ratio is of a wheel that has a spring");
                -(spring.d / rise())
            }
            // s w / abs(w) of a rising wheel
            WheelMeasure::InstantAxisX => self.about(w.x),
            WheelMeasure::InstantAxisY => self.about(w.y),
            WheelMeasure::InstantAxisZ => self.about(w.z),
            // (+-X_x' / X_z') p l / h of braking, (+-X_x' / X_z') d l / h of driving
            WheelMeasure::AntiDive | WheelMeasure::AntiRise => {
                self.reacting(what, v) * support::<T>(what, vehicle)
            }
            WheelMeasure::AntiLift | WheelMeasure::AntiSquat => {
                -(self.reacting(what, v) * support::<T>(what, vehicle))
            }
            WheelMeasure::Toe
            | WheelMeasure::Camber
            | WheelMeasure::CamberFront
            | WheelMeasure::SteerAngle
            | WheelMeasure::Caster
            | WheelMeasure::KingpinInclination
            | WheelMeasure::ScrubRadius
            | WheelMeasure::SpindleOffset
            | WheelMeasure::CasterTrail
            | WheelMeasure::MechanicalTrail
            | WheelMeasure::HubTrail
            | WheelMeasure::WheelTravel
            | WheelMeasure::WheelRecession
            | WheelMeasure::HalfTrack
            | WheelMeasure::HalfTrackChange
            | WheelMeasure::ContactX
            | WheelMeasure::ContactY
            | WheelMeasure::ContactZ
            | WheelMeasure::PlaneCentreFrontY
            | WheelMeasure::PlaneCentreFrontZ
            | WheelMeasure::PlaneCentreSideX
            | WheelMeasure::PlaneCentreSideZ
            | WheelMeasure::RollCentreHeightPlanes
            | WheelMeasure::VirtualCaster
            | WheelMeasure::VirtualKingpinInclination
            | WheelMeasure::VirtualScrubRadius
            | WheelMeasure::VirtualSpindleOffset
            | WheelMeasure::VirtualCasterTrail
            | WheelMeasure::VirtualMechanicalTrail
            | WheelMeasure::VirtualHubTrail => T::constant(f64::NAN),
        }
    }
}

impl<T: Real> TravellingWheel<T> {
    /// The same wheel while both drivers move by these amounts.
    pub fn along(self, other: Self, [p, q]: [T; 2]) -> Self {
        let sum = |a: Dual<T>, b: Dual<T>| Dual { v: a.v, d: a.d * p + b.d * q };
        let vector =
            |a: Vec3<Dual<T>>, b: Vec3<Dual<T>>| Vec3::new(sum(a.x, b.x), sum(a.y, b.y), sum(a.z, b.z));
        let pair = |[a, b]: [Vec3<Dual<T>>; 2], [c, d]: [Vec3<Dual<T>>; 2]| [vector(a, c), vector(b, d)];
        let (one, two) = (self.wheel, other.wheel);
        let [w, v] = [(self.carrier.w, other.carrier.w), (self.carrier.v, other.carrier.v)]
            .map(|(a, b)| a * p + b * q);
        Self {
            wheel: WheelAt {
                centre: vector(one.centre, two.centre),
                spin_axis: vector(one.spin_axis, two.spin_axis),
                radius: one.radius,
                side: one.side,
                kingpin: one.kingpin.zip(two.kingpin).map(|(a, b)| pair(a, b)),
                planes: one.planes.zip(two.planes).map(|([a, b], [c, d])| [pair(a, c), pair(b, d)]),
                spring: one.spring.zip(two.spring).map(|(a, b)| sum(a, b)),
            },
            carrier: Twist { w, v },
            ..self
        }
    }

    /// The rate of a height at the wheel, for division; NaN if the driver does not lift the wheel.
    fn if_rising(&self, rate: T) -> T {
        let (v, w) = (self.wheel.centre.map(|x| x.d), self.carrier.w * self.wheel.radius.v);
        if_moving(rate, v.dot(v) + w.dot(w))
    }

    /// A component of the unit vector along the axis that the carrier turns about as the wheel rises: of a right wheel
    /// the opposite, so that both sides are images of each other. It goes through zero with the component, and never
    /// turns around on the way. NaN if the wheel does not rise or the carrier does not turn.
    fn about(&self, component: T) -> T {
        let WheelAt { centre, side, radius, .. } = &self.wheel;
        let (rise, v, turn) = (self.if_rising(centre.z.d), centre.map(|x| x.d), self.carrier.w.norm());
        // w R beside W'
        let turn = if_moving(turn * radius.v, v.dot(v)) / radius.v;
        component * (side.v * (rise.abs() / rise) / turn)
    }

    /// A component of the carrier's turn, for division; NaN where an instant centre seen along it is at infinity, and
    /// where the carrier does not turn.
    fn seen(&self, component: T) -> T {
        let (v, r) = (self.wheel.centre.map(|x| x.d), self.wheel.radius.v);
        let (seen, turn) = (component * r, self.carrier.w * r);
        // Both conditions in one: each that is recorded costs every step.
        let turned = turn.dot(turn) * T::constant(AT_INFINITY * AT_INFINITY);
        let moved = v.dot(v) * T::constant(STILL * STILL);
        if (seen * seen).exceeds(turned + moved) { component } else { T::constant(f64::NAN) }
    }

    /// `X_x' / X_z'` of the point X at which the tyre's force acts on the carrier while it is held, v the velocity of
    /// the carrier's point at C: C where the carrier reacts the torque, for the wheel is locked to it; W where the body
    /// does, for the wheel turns freely on it.
    fn reacting(&self, what: WheelMeasure, v: Vec3<T>) -> T {
        let reacted = match what.needs() {
            WheelRequirement::Braking(_) => self.brakes,
            WheelRequirement::Driving(_)
            | WheelRequirement::Nothing
            | WheelRequirement::Kingpin
            | WheelRequirement::Planes
            | WheelRequirement::Bump
            | WheelRequirement::Spring
            | WheelRequirement::Steer => self.drive,
        };
        match reacted {
            TorqueReaction::Outboard => v.x / self.if_rising(v.z),
            TorqueReaction::Inboard => self.wheel.centre.x.d / self.if_rising(self.wheel.centre.z.d),
        }
    }

    /// The wheel where it is, with the axis of the screw that its carrier moves about as its kingpin: the carrier turns
    /// by w, and v is the velocity of its point that is at c.
    fn about_its_screw(&self, w: Vec3<T>, v: Vec3<T>, c: Vec3<T>) -> WheelAt<T> {
        let WheelAt { centre, spin_axis, radius, side, .. } = &self.wheel;
        // P = C + w x v / w^2 moves along w alone;  k = w / w_z points up
        let foot = c + w.cross(v) * (T::one() / w.dot(w));
        let up = w * (T::one() / self.seen(w.z));
        WheelAt {
            centre: centre.map(|x| x.v),
            spin_axis: spin_axis.map(|x| x.v),
            radius: radius.v,
            side: side.v,
            kingpin: Some([foot, foot + up]),
            planes: None,
            spring: None,
        }
    }
}

/// Amounts by which the drivers of two wheels of an axle move in a motion of the axle, from both wheels along the
/// driver of the first and along that of the second.
pub(super) fn amounts<T: Real>(
    first: &[TravellingWheel<T>; 2],
    second: &[TravellingWheel<T>; 2],
    motion: AxleMotion,
) -> [T; 2] {
    // C_z' of each wheel, by each driver
    let rates = |wheel: &[TravellingWheel<T>; 2]| [0, 1].map(|k| wheel[k].wheel.contact().z.d);
    let ([a, b], [c, d]) = (rates(first), rates(second));
    // a p + b q = 1,  c p + d q = +-1,  times the determinant: no measure depends on how fast they move
    match motion {
        AxleMotion::OneWheel => [T::one(), T::zero()],
        AxleMotion::Heave => [d - b, a - c],
        AxleMotion::Roll => [d + b, -(a + c)],
    }
}

/// A body that is seen to turn by less than this part of its turn has its instant centre at infinity: some hundred
/// metres away, on one side now and on the other a moment later.
const AT_INFINITY: f64 = 1e-2;

/// Largest rate of a measure along a driver, relative to the motion of the bodies, that is round-off, and largest
/// component of a unit vector that is: ten times the relative error of a position.
const STILL: f64 = 1e-11;

/// A rate along a driver, or a component, for division; NaN if it is round-off beside the motion, or the vector, with
/// this square.
pub(super) fn if_moving<T: Real>(rate: T, motion: T) -> T {
    if is_seen(rate * rate, motion) { rate } else { T::constant(f64::NAN) }
}

/// Weight of a wheel's rise per rearward travel: its end's share of the force times wheelbase over height of the centre
/// of gravity.
fn support<T: Real>(what: WheelMeasure, vehicle: &Vehicle) -> T {
    let need = what.needs();
    let front = vehicle.front_share(need).and_then(|(_, share)| share);
    // p or d of this end; p l / h, d l / h
    let share = front.map(|front| if need.end() == Some(VehicleEnd::Front) { front } else { 1.0 - front });
    let known = share.zip(vehicle.wheelbase).zip(vehicle.cg_height);
    T::constant(known.map_or(f64::NAN, |((share, wheelbase), height)| share * wheelbase / height))
}

/// Global y of an axle's roll centre, and its height above the ground midway: where the lines meet that pass in front
/// view through the contact points, perpendicular to their paths.
pub(super) fn axle_roll_centre<T: Real>(wheels: [TravellingWheel<T>; 2]) -> (T, T) {
    let [(p, a), (q, b)] = number::both(wheels, |side| {
        let contact = side.wheel.contact();
        // Perpendicular to the path (C_y', C_z'): (-C_z', C_y')
        let along = [-contact.z.d, contact.y.d];
        ([contact.y.v, contact.z.v], along)
    });
    let cross = |a: [T; 2], b: [T; 2]| a[0] * b[1] - a[1] * b[0];
    let square = |a: [T; 2]| a[0] * a[0] + a[1] * a[1];
    // Parallel lines meet at infinity.
    let apart = if_moving(cross(a, b), square(a) * square(b));
    // p + way a = q + other b,  times b:  way = (q - p) x b / (a x b)
    let way = cross([q[0] - p[0], q[1] - p[1]], b) / apart;
    let ground = (p[1] + q[1]) * T::constant(0.5);
    (p[0] + way * a[0], p[1] + way * a[1] - ground)
}
