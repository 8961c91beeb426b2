//! Suspensions recognised by the names of their hardpoints; the topology follows from the hardpoints that are present.

use std::collections::BTreeMap;

use hardpoint::model::VehicleEnd;
use hardpoint::space::Vec3;

use crate::axle::{body, leg, rod};
use crate::cases;
use crate::markers::ElementSource;
use crate::mechanism::{Coordinate, Drives, Force, ForceOn, GROUND, Joint, Law, Mechanism, Spring, Wheel};
use crate::report::{ImportLog, SourceSpan};
use crate::sides::over;
use crate::turn::{X, Y, from_z_and_x};

/// Role of a hardpoint in a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Front pivot of the lower arm.
    LowerFront,
    /// Rear pivot of the lower arm.
    LowerRear,
    /// Ball joint of the lower arm.
    LowerOuter,
    /// Front pivot of the upper arm.
    UpperFront,
    /// Rear pivot of the upper arm.
    UpperRear,
    /// Ball joint of the upper arm.
    UpperOuter,
    /// Inner end of the tie rod.
    TieInner,
    /// Outer end of the tie rod.
    TieOuter,
    /// Wheel centre.
    WheelCentre,
    /// Point on the spin axis, inboard of the centre.
    Spindle,
    /// Top mount of the strut or coilover, on the vehicle body.
    StrutTop,
    /// Lower end of the strut or coilover, at its clamp.
    StrutBottom,
    /// Outer end of the push or pull rod, at the suspension.
    RodOuter,
    /// Inner end of the push or pull rod, at the rocker.
    RodInner,
    /// First point on the axis of the rocker.
    RockerA,
    /// Second point on the axis of the rocker.
    RockerB,
    /// End of the damper on the vehicle body.
    DamperChassis,
    /// End of the damper on the rocker or arm.
    DamperMoving,
    /// End of the spring on the vehicle body.
    SpringChassis,
    /// End of the spring on the rocker or arm.
    SpringMoving,
    /// First pivot of the trailing arm.
    TrailingA,
    /// Second pivot of the trailing arm.
    TrailingB,
    /// Ball joint of a trailing arm with a single pivot.
    TrailingBall,
}

impl Role {
    /// Returns true for the points of an arm that carries the upright.
    pub fn is_of_an_arm(self) -> bool {
        use Role::*;
        let arms = [LowerFront, LowerRear, LowerOuter, UpperFront, UpperRear, UpperOuter];
        arms.contains(&self) || [TrailingA, TrailingB, TrailingBall].contains(&self)
    }
}

/// Names of hardpoints by their role, in lower case and with `_` between words. The first match is used.
const NAMES: &[(Role, &[&str])] = &[
    (
        Role::LowerFront,
        &[
            "lower_wishbone_inboard_front",
            "lower_wishbone_front_pivot",
            "lca_front",
            "lower_arm_front",
            "lf",
            "lower_control_arm_front",
            "lwr_arm_front",
            "lca_frt",
            "arm_front",
        ],
    ),
    (
        Role::LowerRear,
        &[
            "lower_wishbone_inboard_rear",
            "lower_wishbone_rear_pivot",
            "lca_rear",
            "lower_arm_rear",
            "la",
            "lr",
            "lower_control_arm_rear",
            "lwr_arm_rear",
            "arm_rear",
        ],
    ),
    (
        Role::LowerOuter,
        &[
            "lower_wishbone_outboard",
            "lower_wishbone_outer_ball_joint",
            "lca_outer",
            "lower_arm_outer",
            "lbj",
            "lower_ball_joint",
            "lower_ball",
            "ball_joint",
            "lca_balljoint",
            "lower_control_arm_outer",
            "lower_ball",
            "ball_joint",
            "arm_outer",
        ],
    ),
    (
        Role::UpperFront,
        &[
            "upper_wishbone_inboard_front",
            "upper_wishbone_front_pivot",
            "uca_front",
            "upper_arm_front",
            "uf",
            "upper_control_arm_front",
            "upr_arm_front",
        ],
    ),
    (
        Role::UpperRear,
        &[
            "upper_wishbone_inboard_rear",
            "upper_wishbone_rear_pivot",
            "uca_rear",
            "upper_arm_rear",
            "ua",
            "ur",
            "upper_control_arm_rear",
            "upr_arm_rear",
        ],
    ),
    (
        Role::UpperOuter,
        &[
            "upper_wishbone_outboard",
            "upper_wishbone_outer_ball_joint",
            "uca_outer",
            "upper_arm_outer",
            "ubj",
            "upper_ball_joint",
            "upper_ball",
            "uca_balljoint",
            "upper_control_arm_outer",
            "upper_ball",
        ],
    ),
    (
        Role::TieInner,
        &[
            "trackrod_inboard",
            "inner_track_rod_ball_joint",
            "track_rod_inner_ball_joint",
            "tierod_inner",
            "tie_rod_inner",
            "tri",
            "toe_link_inner",
            "track_rod_inner",
        ],
    ),
    (
        Role::TieOuter,
        &[
            "trackrod_outboard",
            "outer_track_rod_ball_joint",
            "track_rod_outer_ball_joint",
            "tierod_outer",
            "tie_rod_outer",
            "tro",
            "toe_link_outer",
            "track_rod_outer",
        ],
    ),
    (
        Role::WheelCentre,
        &["wheel_centre_point", "wheel_center", "wheel_centre", "axle_outboard", "wc", "wheel_center_point"],
    ),
    (
        Role::Spindle,
        &["wheel_spindle_point", "axle_inboard", "spindle", "spindle_inner", "wsp", "spindle_align"],
    ),
    (
        Role::StrutTop,
        &[
            "strut_top",
            "top_mount",
            "strut_slider_top",
            "strut_top_point",
            "upper_strut_mount",
            "strut_body_point",
            "strut_upper",
        ],
    ),
    (
        Role::StrutBottom,
        &[
            "strut_bottom",
            "strut_lower",
            "lower_strut_point",
            "strut_lwr_mount",
            "lwr_strut_mount",
            "lower_strut_mount",
            "strut_slider_bottom",
            "strut_lower_point",
            "strut_lower_mount",
            "strut_clamp",
        ],
    ),
    (
        Role::RodOuter,
        &[
            "pushrod_outboard",
            "push_rod_wishbone_end",
            "pull_rod_wishbone_end",
            "push_rod_upright_end",
            "prod_outboard",
            "pushrod_outer",
            "pullrod_outer",
            "push_rod_outer",
            "pro",
        ],
    ),
    (
        Role::RodInner,
        &[
            "pushrod_inboard",
            "push_rod_rocker_end",
            "pull_rod_rocker_end",
            "prod_to_bellcrank",
            "pushrod_inner",
            "pullrod_inner",
            "push_rod_inner",
            "pri",
        ],
    ),
    (
        Role::RockerA,
        &["rocker_axis_a", "rocker_axis_1st_point", "bellcrank_pivot", "rocker_axis_front", "rpa1"],
    ),
    (
        Role::RockerB,
        &[
            "rocker_axis_b",
            "rocker_axis_2nd_point",
            "bellcrank_pivot_orient",
            "bellcrank_axis",
            "rocker_axis_rear",
            "rpa2",
        ],
    ),
    (
        Role::DamperChassis,
        &[
            "damper_chassis",
            "damper_to_body_point",
            "damper_body_point",
            "damper_inboard",
            "shock_to_chassis",
            "top_damper_mount",
            "damper_upper",
            "shock_upper",
            "damper_top",
            "dc",
            "damper_frame",
            "shock_frame",
            "shock_chassis",
        ],
    ),
    (
        Role::DamperMoving,
        &[
            "damper_rocker",
            "damper_to_rocker_point",
            "damper_to_wishbone_point",
            "damper_wishbone_point",
            "damper_outboard",
            "shock_to_bellcrank",
            "lwr_shock_mount",
            "damper_lower",
            "shock_lower",
            "damper_foot",
            "damper_bottom",
            "rd",
            "damper_axle",
            "shock_axle",
        ],
    ),
    (
        Role::SpringChassis,
        &[
            "spring_to_body_point",
            "upper_spring_pivot_point",
            "spring_chassis",
            "upper_spring_seat",
            "upr_spring_seat",
            "spring_upr_seat",
            "spring_upper_seat",
            "spring_upper",
            "spring_top",
            "spring_frame",
        ],
    ),
    (
        Role::SpringMoving,
        &[
            "spring_to_wishbone_point",
            "lower_spring_pivot_point",
            "spring_rocker",
            "lwr_spring_seat",
            "lower_spring_seat",
            "spring_lwr_seat",
            "spring_lower_seat",
            "spring_lower",
            "spring_bottom",
            "spring_axle",
        ],
    ),
    (Role::TrailingA, &["trailing_arm_pivot_a", "trailing_arm_inner", "trailing_arm_front"]),
    (Role::TrailingB, &["trailing_arm_pivot_b", "trailing_arm_outer", "trailing_arm_rear"]),
];

/// Explanation of a hardpoint whose name has no role.
pub const ONLY_LISTED: &str = "no member follows from its name: the hardpoint is only listed";

/// Returns a name in lower case, with `_` between words.
pub fn plain(name: &str) -> String {
    let mut out = String::new();
    for c in name.trim().chars() {
        if c.is_alphanumeric() {
            out.extend(c.to_lowercase());
        } else if !out.ends_with('_') && !out.is_empty() {
            out.push('_');
        }
    }
    out.trim_end_matches('_').to_owned()
}

/// Returns the role of a hardpoint with this name.
pub fn role_of(name: &str) -> Option<Role> {
    let name = plain(name);
    NAMES.iter().find(|(_, names)| names.contains(&name.as_str())).map(|(role, _)| *role)
}

/// Part to which a rod or a spring is attached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mount {
    /// The lower arm.
    Lower,
    /// The upper arm.
    Upper,
    /// The upright.
    Upright,
    /// A link, which then has a body.
    Link(String),
    /// A part without a body.
    Nothing(String),
}

/// Rod of constant length from the vehicle body to the upright.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name.
    pub name: String,
    /// Ends, inboard first.
    pub ends: [Vec3; 2],
    /// Pins of the cross at the inner end, that of the vehicle body and that of the link, if the source defines them.
    pub pins: Option<[Vec3; 2]>,
    /// Position in the source.
    pub at: Option<SourceSpan>,
}

impl Link {
    /// Returns perpendicular pins of the cross: those of the source as nearly as possible, or otherwise two directions
    /// perpendicular to the link.
    fn cross(&self) -> [Vec3; 2] {
        let along = (self.ends[1] - self.ends[0]).unit().unwrap_or(X.into());
        let square = |a: Vec3, b: Vec3| Some([a.unit()?, from_z_and_x(a, b)?.cols[0]]);
        let own = self.pins.and_then(|[a, b]| square(a, b));
        own.or_else(|| square(along.any_perpendicular(), along.cross(along.any_perpendicular())))
            .unwrap_or([X.into(), Y.into()])
    }
}

/// Corner of a vehicle.
#[derive(Clone, Debug, Default)]
pub struct Corner {
    /// Suffix of the names of its bodies and joints.
    pub suffix: String,
    /// Hardpoints by their role.
    pub points: BTreeMap<Role, Vec3>,
    /// Further links between the vehicle body and the upright.
    pub links: Vec<Link>,
    /// Part to which the push rod is attached.
    pub rod_on: Option<Mount>,
    /// Part to which the coilover, or the spring and damper, are attached.
    pub spring_on: Option<Mount>,
    /// Part to which the damper is attached, if it differs.
    pub damper_on: Option<Mount>,
    /// True if a rack moves the tie rod.
    pub rack: bool,
    /// Radius of the wheel, from its centre to the road.
    pub radius: Option<f64>,
    /// Spin axis, pointing outboard, if there is no spindle point.
    pub spin_axis: Option<Vec3>,
    /// Characteristics of the coilover, spring and damper, by these names, with their positions in the source.
    pub springs: BTreeMap<&'static str, (Spring, SourceSpan)>,
    /// End of the vehicle.
    pub end: Option<VehicleEnd>,
    /// Index of the driver that moves the wheel vertically, if it exists.
    pub bump: Option<usize>,
    /// Start of its description in the file.
    pub at: Option<SourceSpan>,
}

/// Ends of a spring: body and point.
type Ends = [(usize, Vec3); 2];

/// Front pivot, rear pivot and ball joint of the lower arm.
pub const LOWER_ARM: [Role; 3] = [Role::LowerFront, Role::LowerRear, Role::LowerOuter];
/// Front pivot, rear pivot and ball joint of the upper arm.
pub const UPPER_ARM: [Role; 3] = [Role::UpperFront, Role::UpperRear, Role::UpperOuter];
/// Inner and outer end of the tie rod.
pub const TIE_ROD: [Role; 2] = [Role::TieInner, Role::TieOuter];

/// Default radius of a wheel, mm.
const RADIUS: f64 = 330.0;

/// Adds a driver that moves a point of a body, such as a wheel centre, vertically. Returns its index.
pub fn bump(
    m: &mut Mechanism,
    notes: &mut ImportLog,
    suffix: &str,
    at: Option<SourceSpan>,
    body: usize,
    centre: Vec3,
) -> usize {
    let text = cases::oscillation(m, cases::HEAVE);
    let why = "nothing drives it in the source: a vertical bump motion is added";
    notes.approximated("motion", &format!("wheel{suffix}"), at, why);
    let drives = Drives::Translation { body, at: centre, along: [0.0, 0.0, 1.0].into() };
    let note = "no law in the source: vertical bump motion of the wheel".into();
    m.driver(&format!("bump{suffix}"), note, drives, Law::Text(text))
}

/// Spin axis, pointing outboard, of a wheel with static camber and toe-in, rad. Toe-in turns the axis forward, camber
/// tilts it down. `side` is 1 on the left and -1 on the right.
pub fn spin_axis(side: f64, camber: f64, toe: f64) -> Vec3 {
    Vec3::from([toe.sin() * camber.cos(), side * toe.cos() * camber.cos(), -camber.sin()])
}

impl Corner {
    fn get(&self, role: Role) -> Option<Vec3> {
        self.points.get(&role).copied()
    }

    fn all<const N: usize>(&self, roles: [Role; N]) -> Option<[Vec3; N]> {
        let found: Option<Vec<Vec3>> = roles.iter().map(|r| self.get(*r)).collect();
        found.and_then(|v| <[Vec3; N]>::try_from(v).ok())
    }

    /// Returns the name of a body or joint of the corner.
    fn name(&self, base: &str) -> String {
        format!("{base}{}", self.suffix)
    }

    /// Returns the number of constraints of the upright by the arms and the tie rod.
    fn constraints(&self) -> usize {
        let arms = [LOWER_ARM, UPPER_ARM].into_iter().filter(|arm| self.all(*arm).is_some());
        2 * arms.count() + usize::from(self.all(TIE_ROD).is_some())
    }

    /// Returns true if this number of rods, together with an arm and the tie rod, leaves the upright one degree of
    /// freedom, as in a multi-link suspension.
    pub fn is_held_by(&self, rods: usize) -> bool {
        use Role::*;
        let is_guided = [TrailingA, TrailingB, TrailingBall].iter().any(|r| self.get(*r).is_some());
        rods > 0 && !is_guided && self.constraints() + rods == 5
    }

    /// Returns the mirror image of the corner.
    pub fn mirrored(&self, suffix: &str) -> Self {
        let image = |v: Vec3| over(v, -1.0);
        let mut out = self.clone();
        out.suffix = suffix.to_owned();
        out.points.values_mut().for_each(|p| *p = image(*p));
        let links = out.links.iter_mut();
        links.for_each(|l| (l.ends, l.pins) = (l.ends.map(image), l.pins.map(|p| p.map(image))));
        out.spin_axis = self.spin_axis.map(image);
        out
    }

    /// Adds the bodies, joints and wheel of the corner; `rack` is the rack of the axle, once it exists. Returns true if
    /// the topology is known.
    pub fn build(&self, m: &mut Mechanism, notes: &mut ImportLog, rack: &mut Option<usize>) -> bool {
        use Role::*;
        let strut = self.strut_ends();
        let ball = self.get(TrailingBall);
        let held = self.constraints() + 3 * usize::from(ball.is_some()) + self.links.len();
        if self.trailing_axis().is_none() && strut.is_none() && held < 5 {
            return false;
        }
        self.check_points(notes);
        if notes.problem_count() > 0 {
            return true;
        }
        let centre = self.get(WheelCentre);
        let upright_at = centre.or(self.all(LOWER_ARM).map(|l| l[2])).unwrap_or_else(Vec3::zero);
        let upright = body(m, &self.name("upright"), upright_at);
        let arms = [("lower_arm", LOWER_ARM), ("upper_arm", UPPER_ARM)];
        let [lower, upper] = arms.map(|(arm, points)| self.arm(m, notes, upright, arm, points));
        if let Some(ends) = strut {
            self.strut(m, notes, upright, ends);
        }
        self.trailing_arm(m, notes, upright);
        let links = self.links(m, notes, upright);
        if let Some(ends) = self.all(TIE_ROD) {
            let carrier = if self.rack { self.rack_of(m, notes, rack, ends[0]) } else { GROUND };
            rod(m, notes, &self.name("tie_rod"), [carrier, upright], ends, self.at);
        }
        let on = |mount: &Mount| match mount {
            Mount::Lower => lower,
            Mount::Upper => upper,
            Mount::Upright => Some(upright),
            Mount::Link(name) => links.get(name.as_str()).copied(),
            Mount::Nothing(_) => None,
        };
        let rocker = self.rocker(m, notes, &on);
        let leg = self.springs(m, notes, &on, rocker, strut.is_some());
        let spring = strut.map(|[top, bottom]| [(GROUND, top), (upright, bottom)]).or(leg);
        if let Some(centre) = centre {
            self.wheel(m, notes, upright, centre, spring);
        } else {
            let why = "its centre is not in the file: motions are fixed, or oscillate if there is only one";
            notes.approximated("wheel", &self.name("wheel"), self.at, why);
        }
        true
    }

    /// Returns the pivots of the trailing arm.
    fn trailing_axis(&self) -> Option<[Vec3; 2]> {
        self.all([Role::TrailingA, Role::TrailingB])
    }

    /// Returns the ends of the strut, upper one first, if it guides the upright together with the lower arm.
    fn strut_ends(&self) -> Option<[Vec3; 2]> {
        let is_guided =
            self.all(LOWER_ARM).is_some() && self.all(UPPER_ARM).is_none() && self.links.is_empty();
        self.all([Role::StrutTop, Role::StrutBottom]).filter(|_| is_guided)
    }

    /// HP0804: two points that define an axis or a rod coincide.
    fn check_points(&self, notes: &mut ImportLog) {
        let strut = self.all([Role::StrutTop, Role::StrutBottom]);
        let lines =
            [("strut", strut), ("trailing arm's axis", self.trailing_axis()), ("tie rod", self.all(TIE_ROD))];
        for (what, _) in lines.iter().filter(|(_, ends)| ends.is_some_and(|[a, b]| a == b)) {
            let message = format!("both points of the {what} coincide");
            notes.problem_with("HP0804", self.at, message, "correct one of them");
        }
    }

    /// Adds an arm between the vehicle body and the upright. Returns its body.
    fn arm(
        &self,
        m: &mut Mechanism,
        notes: &mut ImportLog,
        upright: usize,
        arm: &str,
        points: [Role; 3],
    ) -> Option<usize> {
        let [front, rear, outer] = self.all(points)?;
        let name = self.name(arm);
        let body = body(m, &name, (front + rear) * 0.5);
        if (front - rear).norm() > 0.0 {
            let pivot = self.name(&format!("{arm}_pivot"));
            let pivot = Joint::new(&pivot, String::new(), "revolute", [GROUND, body], rear);
            m.joint(pivot.through(rear, front));
        } else {
            let message = format!("both pivots of the {} coincide", arm.replace('_', " "));
            notes.problem_with("HP0804", self.at, message, "correct one of them");
        }
        let ball = self.name(&format!("{arm}_ball"));
        m.joint(Joint::new(&ball, String::new(), "spherical", [body, upright], outer));
        notes.taken("arm", &name, self.at);
        Some(body)
    }

    /// Adds the strut, along which the upright slides, and the force of its coilover.
    fn strut(&self, m: &mut Mechanism, notes: &mut ImportLog, upright: usize, [top, bottom]: [Vec3; 2]) {
        let name = self.name("strut");
        let body = body(m, &name, top);
        let mount = self.name("strut_top_mount");
        m.joint(Joint::new(&mount, String::new(), "spherical", [GROUND, body], top));
        let slide = self.name("strut_slide");
        let mut slide = Joint::new(&slide, String::new(), "translational", [upright, body], bottom);
        slide.draw = Some("coilover");
        m.joint(slide.through(bottom, top));
        notes.taken("strut", &name, self.at);
        self.force(m, notes, "coilover", [(GROUND, top), (upright, bottom)]);
    }

    /// Adds the pivot and the ball joint of the trailing arm, whose body is the upright.
    fn trailing_arm(&self, m: &mut Mechanism, notes: &mut ImportLog, upright: usize) {
        let pivot = self.trailing_axis().map(|[a, b]| {
            let pivot = self.name("trailing_arm_pivot");
            Joint::new(&pivot, String::new(), "revolute", [GROUND, upright], a).through(a, b)
        });
        let ball = self.get(Role::TrailingBall).map(|at| {
            let ball = self.name("trailing_arm_ball");
            Joint::new(&ball, String::new(), "spherical", [GROUND, upright], at)
        });
        for joint in [pivot, ball].into_iter().flatten() {
            m.joint(joint);
            notes.taken("arm", &self.name("trailing_arm"), self.at);
        }
    }

    /// Adds the links as rods, or with a body if they carry another part. Returns these bodies by the name of the link.
    fn links(&self, m: &mut Mechanism, notes: &mut ImportLog, upright: usize) -> BTreeMap<&str, usize> {
        let mounts = [&self.rod_on, &self.spring_on, &self.damper_on];
        let carries = |link: &Link| {
            mounts.into_iter().any(|m| matches!(m, Some(Mount::Link(name)) if *name == link.name))
        };
        let mut bodies = BTreeMap::new();
        for link in self.links.iter().filter(|l| l.ends[0] != l.ends[1]) {
            let name = self.name(&link.name);
            if !carries(link) {
                rod(m, notes, &name, [GROUND, upright], link.ends, link.at);
                continue;
            }
            let [inner, outer] = link.ends;
            let body = body(m, &name, inner);
            let [a, b] = link.cross();
            let (cross, ball) = (format!("{name}_cross"), format!("{name}_ball"));
            m.joint(Joint::new(&cross, String::new(), "universal", [GROUND, body], inner).with_axes(a, b));
            m.joint(Joint::new(&ball, String::new(), "spherical", [body, upright], outer));
            bodies.insert(link.name.as_str(), body);
            if link.pins.is_some() {
                notes.taken("link", &name, link.at);
            } else {
                let why = "it carries another part: its rotation about itself is not in the file, and a cross at its inner end fixes it";
                notes.approximated("link", &name, link.at, why);
            }
        }
        bodies
    }

    /// Returns the rack of the axle, which is added if necessary.
    pub fn rack_of(
        &self,
        m: &mut Mechanism,
        notes: &mut ImportLog,
        rack: &mut Option<usize>,
        at: Vec3,
    ) -> usize {
        if let Some(body) = *rack {
            return body;
        }
        let at = Vec3::from([at.x, 0.0, at.z]);
        let body = m.body(
            "rack",
            "carrier of the tie rods".into(),
            Some(hardpoint::space::Pose { rot: crate::turn::none(), r: at }),
        );
        let slide = m.joint(
            Joint::new("rack_slide", String::new(), "translational", [GROUND, body], at)
                .along([0.0, 1.0, 0.0].into()),
        );
        let drives = Drives::Coordinate(Coordinate { joint: slide, name: "displacement" });
        let steering = m.driver(
            "steering",
            "no law in the source: fixed in the design configuration".into(),
            drives,
            Law::Fixed,
        );
        m.steering = Some(steering);
        notes.approximated(
            "motion",
            "rack_slide",
            self.at,
            "nothing drives it in the source: a driver fixes it in the design configuration",
        );
        *rack = Some(body);
        body
    }

    /// Adds the rocker and its push rod. Returns the body of the rocker.
    fn rocker(
        &self,
        m: &mut Mechanism,
        notes: &mut ImportLog,
        on: &dyn Fn(&Mount) -> Option<usize>,
    ) -> Option<usize> {
        use Role::*;
        let [outer, inner] = self.all([RodOuter, RodInner])?;
        let Some([a, b]) = self.all([RockerA, RockerB]).filter(|[a, b]| a != b && outer != inner) else {
            notes.refused("push rod", &self.name("push_rod"), self.at, "its rocker has no axis in the file");
            return None;
        };
        let nearest = || {
            let to = |role| self.get(role).map_or(f64::INFINITY, |p| (p - outer).norm());
            if to(UpperOuter) < to(LowerOuter) { Mount::Upper } else { Mount::Lower }
        };
        let mount = self.rod_on.clone().unwrap_or_else(nearest);
        if self.rod_on.is_none() {
            let why =
                "the part at its outer end is not in the file: the arm with the nearest ball joint is used";
            notes.approximated("push rod", &self.name("push_rod"), self.at, why);
        }
        let Some(carrier) = on(&mount) else {
            notes.refused(
                "push rod",
                &self.name("push_rod"),
                self.at,
                "the part at its outer end has no body in the model",
            );
            return None;
        };
        let body = body(m, &self.name("rocker"), a);
        m.joint(
            Joint::new(&self.name("rocker_pivot"), String::new(), "revolute", [GROUND, body], a)
                .through(a, b),
        );
        m.joint(
            Joint::new(&self.name("push_rod"), String::new(), "distance", [carrier, body], outer)
                .between(outer, inner),
        );
        notes.taken("rocker", &self.name("rocker"), self.at);
        Some(body)
    }

    /// Adds coilover, damper and spring as legs, whose lengths are measured, and their forces. Returns the ends of the
    /// spring.
    fn springs(
        &self,
        m: &mut Mechanism,
        notes: &mut ImportLog,
        on: &dyn Fn(&Mount) -> Option<usize>,
        rocker: Option<usize>,
        is_strut: bool,
    ) -> Option<Ends> {
        use Role::*;
        let mut spring = None;
        let pairs = [
            ("coilover", [StrutTop, StrutBottom], is_strut),
            ("damper", [DamperChassis, DamperMoving], false),
            ("spring", [SpringChassis, SpringMoving], false),
        ];
        for (base, ends, done) in pairs {
            let Some([top, bottom]) = self.all(ends).filter(|[a, b]| !done && a != b) else { continue };
            let name = self.name(base);
            let guess = if self.get(LowerOuter).is_some() { Mount::Lower } else { Mount::Upright };
            let own = self.damper_on.clone().filter(|_| base == "damper");
            let mount = own.or_else(|| self.spring_on.clone()).unwrap_or(guess);
            let carrier = rocker.or_else(|| on(&mount));
            let Some(carrier) = carrier else {
                notes.refused(base, &name, self.at, "the part at its lower end has no body in the model");
                continue;
            };
            leg(m, notes, &name, [GROUND, carrier], [top, bottom], base, self.at);
            let ends = [(GROUND, top), (carrier, bottom)];
            self.force(m, notes, base, ends);
            if base != "damper" {
                spring = Some(ends);
            }
        }
        spring
    }

    /// Adds the force of a coilover, spring or damper if the source defines its characteristic.
    pub fn force(&self, m: &mut Mechanism, notes: &mut ImportLog, base: &str, ends: Ends) {
        let Some((spring, at)) = self.springs.get(base) else { return };
        let name = self.name(base);
        let note = ElementSource { kind: base, name: &name, at: Some(*at) }.note(notes);
        m.force(Force { name: name.clone(), note, on: ForceOn::Points(ends), spring: spring.clone() });
        notes.taken("force", &name, Some(*at));
    }

    /// Adds the wheel on an upright, with its bump driver.
    pub fn wheel(
        &self,
        m: &mut Mechanism,
        notes: &mut ImportLog,
        upright: usize,
        centre: Vec3,
        spring: Option<Ends>,
    ) {
        use Role::*;
        let name = self.name("wheel");
        let per_mm = m.per_mm();
        let outboard = Vec3::from([0.0, if centre.y < 0.0 { -1.0 } else { 1.0 }, 0.0]);
        let axis = self.get(Spindle).and_then(|s| (centre - s).unit()).or(self.spin_axis).unwrap_or(outboard);
        let spindle = self.get(Spindle).filter(|s| (centre - *s).dot(outboard) > 0.0);
        let axis = if axis.dot(outboard) < 0.0 { -axis } else { axis };
        let radius = self.radius.filter(|r| *r > 0.0).unwrap_or_else(|| {
            let radius = RADIUS * per_mm;
            notes.approximated(
                "wheel",
                &name,
                self.at,
                format!("its radius is not in the file: {radius} {} is assumed", m.length),
            );
            radius
        });
        let driver = || bump(m, notes, &self.suffix, self.at, upright, centre);
        let bump = self.bump.unwrap_or_else(driver);
        let lower = self.get(LowerOuter).map(|p| (upright, p));
        let upper = self.get(UpperOuter).map(|p| (upright, p)).or(self.get(StrutTop).map(|p| (GROUND, p)));
        let kingpin = lower.zip(upper).map(|(l, u)| [l, u]).filter(|_| self.rack);
        m.wheels.push(Wheel {
            name: name.clone(),
            body: upright,
            centre,
            spin_axis: axis,
            spindle,
            radius,
            kingpin,
            bump,
            is_steered: self.rack && m.steering.is_some(),
            spring,
            end: self.end,
        });
        notes.taken("wheel", &name, self.at);
    }
}
