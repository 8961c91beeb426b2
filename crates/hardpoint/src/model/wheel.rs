//! Road wheels and axles: what carries them, where they touch the ground, and the axis that they steer about.

use super::{BodyId, Dimension, Direction, DriverId, PointId, WheelId};

/// A road wheel. Vehicle axes are those of ISO 8855: x forward, y left, z up.
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel {
    /// Name.
    pub name: String,
    /// The body that it turns on: the knuckle.
    pub body: BodyId,
    /// Centre, a point of that body.
    pub centre: PointId,
    /// Spin axis in the design configuration, pointing outboard.
    pub spin_axis: Direction,
    /// From the centre to the ground in the wheel's plane, m.
    pub radius: f64,
    /// On which side of the vehicle it is.
    pub side: Side,
    /// A lower and an upper point of the axis that it steers about; they may be on different bodies.
    pub kingpin: Option<[PointId; 2]>,
    /// The driver that moves it up and down.
    pub bump: Option<DriverId>,
    /// The driver that steers it.
    pub steer: Option<DriverId>,
    /// The planes of the lower and the upper arm.
    pub planes: Option<[ArmPlane; 2]>,
    /// The ends of its spring.
    pub spring: Option<[PointId; 2]>,
    /// At which end of the vehicle it is.
    pub end: Option<VehicleEnd>,
    /// Place where its drive torque is reacted.
    pub drive: TorqueReaction,
    /// Place where its brake torque is reacted.
    pub brakes: TorqueReaction,
}

/// The part that reacts the torque of a drive or a brake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorqueReaction {
    /// The vehicle's body, through shafts: a differential or a brake on the body.
    Inboard,
    /// The body that the wheel turns on: a brake at the wheel, a motor in the hub, the differential of a live axle.
    Outboard,
}

impl TorqueReaction {
    /// Both, in the order of the format's words.
    pub const ALL: [Self; 2] = [Self::Inboard, Self::Outboard];
}

impl Wheel {
    /// The driver that moves alone where a measure needs this.
    pub fn driver(&self, need: WheelRequirement) -> Option<DriverId> {
        if need == WheelRequirement::Steer { self.steer } else { self.bump }
    }
}

/// The motion of an axle along which a measure of one of its wheels is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxleMotion {
    /// The driver of the wheel alone; that of the other wheel is held.
    OneWheel,
    /// The other contact point falls at the rate at which that of the wheel rises.
    Roll,
    /// Both contact points rise alike.
    Heave,
}

/// The plane in which an arm lets its outer joint go, as textbooks construct instant centres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmPlane {
    /// Plane of an arm: through its two pivots and its ball joint.
    Through([PointId; 3]),
    /// Plane of a strut: through its top mount, the first point, and perpendicular to the line to the second one.
    Square([PointId; 2]),
}

impl ArmPlane {
    /// The points that it depends on.
    pub fn points(&self) -> &[PointId] {
        match self {
            Self::Through(points) => points,
            Self::Square(points) => points,
        }
    }
}

/// Two wheels side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Axle {
    /// Name.
    pub name: String,
    /// The left wheel and the right one.
    pub wheels: [WheelId; 2],
}

/// Vehicle data besides the suspension.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vehicle {
    /// Distance of the axles, m.
    pub wheelbase: Option<f64>,
    /// Height of the centre of gravity above the ground, m.
    pub cg_height: Option<f64>,
    /// Part of the braking force that the front wheels take, 0 to 1.
    pub front_brake_share: Option<f64>,
    /// Part of the driving force that the front wheels give, 0 to 1.
    pub front_drive_share: Option<f64>,
}

impl Vehicle {
    /// Share of the front wheels in the force that a measure uses: its key in model files, and its value.
    pub fn front_share(&self, need: WheelRequirement) -> Option<(&'static str, Option<f64>)> {
        match need {
            WheelRequirement::Braking(_) => Some(("front_brake_share", self.front_brake_share)),
            WheelRequirement::Driving(_) => Some(("front_drive_share", self.front_drive_share)),
            _ => None,
        }
    }

    /// Keys of the vehicle data that a measure of a wheel needs and the model lacks.
    pub fn lacks(&self, need: WheelRequirement) -> impl Iterator<Item = &'static str> {
        let share = self.front_share(need);
        let of_pitching = [("wheelbase", self.wheelbase), ("cg_height", self.cg_height)].map(Some);
        let needed = of_pitching.into_iter().filter(move |_| share.is_some()).chain([share]).flatten();
        needed.filter(|(_, known)| known.is_none()).map(|(key, _)| key)
    }
}

/// An end of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VehicleEnd {
    /// The end in the direction of +x.
    Front,
    /// The end in the direction of -x.
    Rear,
}

impl VehicleEnd {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Front, Self::Rear];

    /// As model files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Rear => "rear",
        }
    }
}

/// Data that a measure of a wheel needs besides the wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WheelRequirement {
    /// Nothing.
    Nothing,
    /// The kingpin.
    Kingpin,
    /// The planes of the arms.
    Planes,
    /// The driver that moves the wheel up and down.
    Bump,
    /// That, and the spring.
    Spring,
    /// The driver that steers the wheel.
    Steer,
    /// That, and what part of the braking force its end of the vehicle takes.
    Braking(VehicleEnd),
    /// That, and what part of the driving force its end of the vehicle gives.
    Driving(VehicleEnd),
}

impl WheelRequirement {
    /// The end of the vehicle that the measure is of, if it is not of both.
    pub fn end(self) -> Option<VehicleEnd> {
        match self {
            Self::Braking(end) | Self::Driving(end) => Some(end),
            _ => None,
        }
    }

    /// True if the measure is a derivative along the motion of a single driver.
    pub fn depends_on_driver(self) -> bool {
        !matches!(self, Self::Nothing | Self::Kingpin | Self::Planes)
    }
}

/// A side of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side in the direction of +y.
    Left,
    /// The side in the direction of -y.
    Right,
}

impl Side {
    /// 1 on the left, -1 on the right: the sign of y outboard.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// As model files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

macro_rules! wheel_measures {
    ($(#[$about:meta])* $name:ident, $need:ident: $of:ty; $(#[doc = $summary:literal] $variant:ident $text:literal $dimension:ident $what:expr, $positive:literal;)*) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $(#[doc = $summary] $variant,)*
        }

        impl $name {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// As model files write it.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),* }
            }

            /// Description in one sentence.
            pub fn summary(self) -> &'static str {
                match self { $(Self::$variant => $summary.trim_ascii()),* }
            }

            /// Dimension of the value.
            pub fn dimension(self) -> Dimension {
                match self { $(Self::$variant => $dimension),* }
            }

            /// Data that it needs besides.
            pub fn $need(self) -> $of {
                match self { $(Self::$variant => $what),* }
            }

            /// Direction in which it is positive, in words; empty if there is no common one.
            pub fn positive(self) -> &'static str {
                match self { $(Self::$variant => $positive),* }
            }

            /// The measure of that name.
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|m| m.name() == name)
            }
        }
    };
}

const NUMBER: Dimension = Dimension::NUMBER;
const LENGTH: Dimension = Dimension::LENGTH;
const ANGLE: Dimension = Dimension::ANGLE;
const ANGLE_PER_LENGTH: Dimension = ANGLE.over(LENGTH);

wheel_measures! {
    /// Measures of a wheel. Formulas and signs are in `docs/measures.md`.
    WheelMeasure, needs: WheelRequirement;
    /// Heading of the wheel's plane; positive where its front is inboard.
    Toe "toe" ANGLE WheelRequirement::Nothing, "toe-in";
    /// Lean of the wheel's plane; positive where its top is outboard.
    Camber "camber" ANGLE WheelRequirement::Nothing, "top outboard";
    /// Lean of the wheel's plane as the vehicle's front view shows it; positive where its top is outboard.
    CamberFront "camber_front" ANGLE WheelRequirement::Nothing, "top outboard";
    /// Heading of the wheel's plane since the design configuration; positive to the left.
    SteerAngle "steer_angle" ANGLE WheelRequirement::Nothing, "to the left";
    /// Lean of the kingpin in side view; positive where its top is rearward.
    Caster "caster" ANGLE WheelRequirement::Kingpin, "top rearward";
    /// Lean of the kingpin in front view; positive where its top is inboard.
    KingpinInclination "kingpin_inclination" ANGLE WheelRequirement::Kingpin, "top inboard";
    /// Distance of the contact point outboard of the kingpin, on the ground.
    ScrubRadius "scrub_radius" LENGTH WheelRequirement::Kingpin, "";
    /// Distance of the wheel centre outboard of the kingpin, at the height of the centre.
    SpindleOffset "spindle_offset" LENGTH WheelRequirement::Kingpin, "";
    /// Distance of the contact point behind the kingpin, on the ground.
    CasterTrail "caster_trail" LENGTH WheelRequirement::Kingpin, "";
    /// The same perpendicular to the kingpin, in the wheel's side view.
    MechanicalTrail "mechanical_trail" LENGTH WheelRequirement::Kingpin, "";
    /// Distance of the wheel centre in front of the kingpin, at the height of the centre.
    HubTrail "hub_trail" LENGTH WheelRequirement::Kingpin, "";
    /// Rise of the wheel centre since the design configuration.
    WheelTravel "wheel_travel" LENGTH WheelRequirement::Nothing, "bump";
    /// Way of the wheel centre rearward since the design configuration.
    WheelRecession "wheel_recession" LENGTH WheelRequirement::Nothing, "rearward";
    /// Distance of the contact point from the vehicle's plane of symmetry, outboard.
    HalfTrack "half_track" LENGTH WheelRequirement::Nothing, "outboard";
    /// Growth of that since the design configuration.
    HalfTrackChange "half_track_change" LENGTH WheelRequirement::Nothing, "outboard";
    /// Global x of the contact point.
    ContactX "contact_x" LENGTH WheelRequirement::Nothing, "forward";
    /// Global y of the contact point.
    ContactY "contact_y" LENGTH WheelRequirement::Nothing, "to the left";
    /// Global z of the contact point.
    ContactZ "contact_z" LENGTH WheelRequirement::Nothing, "up";
    /// Growth of toe per wheel travel.
    BumpSteer "bump_steer" ANGLE_PER_LENGTH WheelRequirement::Bump, "toe-in in bump";
    /// Growth of camber per wheel travel.
    BumpCamber "bump_camber" ANGLE_PER_LENGTH WheelRequirement::Bump, "top outboard in bump";
    /// Growth of wheel recession per wheel travel.
    BumpRecession "bump_recession" NUMBER WheelRequirement::Bump, "rearward in bump";
    /// Growth of half track per wheel travel.
    BumpScrub "bump_scrub" NUMBER WheelRequirement::Bump, "outboard in bump";
    /// Height of the roll centre above the ground, from the path of the contact point.
    RollCentreHeight "roll_centre_height" LENGTH WheelRequirement::Bump, "up";
    /// Height of the roll centre above the ground, from the instant centre of the wheel carrier in front view.
    RollCentreHeightGeometric "roll_centre_height_geometric" LENGTH WheelRequirement::Bump, "up";
    /// Global y of the instant centre in front view, at the contact point's x.
    FrontCentreY "instant_centre_front_y" LENGTH WheelRequirement::Bump, "";
    /// Global z of the instant centre in front view, at the contact point's x.
    FrontCentreZ "instant_centre_front_z" LENGTH WheelRequirement::Bump, "";
    /// Global x of the instant centre in side view, at the contact point's y.
    SideCentreX "instant_centre_side_x" LENGTH WheelRequirement::Bump, "";
    /// Global z of the instant centre in side view, at the contact point's y.
    SideCentreZ "instant_centre_side_z" LENGTH WheelRequirement::Bump, "";
    /// x component of the unit vector along the instant axis, about which a left wheel rises and a right one falls.
    InstantAxisX "instant_axis_x" NUMBER WheelRequirement::Bump, "";
    /// y component of the unit vector along the instant axis, about which a left wheel rises and a right one falls.
    InstantAxisY "instant_axis_y" NUMBER WheelRequirement::Bump, "";
    /// z component of the unit vector along the instant axis, about which a left wheel rises and a right one falls.
    InstantAxisZ "instant_axis_z" NUMBER WheelRequirement::Bump, "";
    /// Distance of the instant centre in front view inboard of the contact point.
    SwingArmFront "swing_arm_front" LENGTH WheelRequirement::Bump, "";
    /// Distance of the instant centre in side view in front of the contact point.
    SwingArmSide "swing_arm_side" LENGTH WheelRequirement::Bump, "";
    /// Shortening of the spring per wheel travel.
    MotionRatio "motion_ratio" NUMBER WheelRequirement::Spring, "";
    /// Global y of where the planes of both arms meet in front view, at the contact point's x.
    PlaneCentreFrontY "plane_centre_front_y" LENGTH WheelRequirement::Planes, "";
    /// Global z of where the planes of both arms meet in front view, at the contact point's x.
    PlaneCentreFrontZ "plane_centre_front_z" LENGTH WheelRequirement::Planes, "";
    /// Global x of where the planes of both arms meet in side view, at the contact point's y.
    PlaneCentreSideX "plane_centre_side_x" LENGTH WheelRequirement::Planes, "";
    /// Global z of where the planes of both arms meet in side view, at the contact point's y.
    PlaneCentreSideZ "plane_centre_side_z" LENGTH WheelRequirement::Planes, "";
    /// Height of the roll centre above the ground, from where the planes of both arms meet in front view.
    RollCentreHeightPlanes "roll_centre_height_planes" LENGTH WheelRequirement::Planes, "";
    /// Lean of the virtual steering axis in side view; positive where its top is rearward.
    VirtualCaster "virtual_caster" ANGLE WheelRequirement::Steer, "";
    /// Lean of the virtual steering axis in front view; positive where its top is inboard.
    VirtualKingpinInclination "virtual_kingpin_inclination" ANGLE WheelRequirement::Steer, "";
    /// Distance of the contact point outboard of the virtual steering axis, on the ground.
    VirtualScrubRadius "virtual_scrub_radius" LENGTH WheelRequirement::Steer, "";
    /// Distance of the wheel centre outboard of the virtual steering axis, at the height of the centre.
    VirtualSpindleOffset "virtual_spindle_offset" LENGTH WheelRequirement::Steer, "";
    /// Distance of the contact point behind the virtual steering axis, on the ground.
    VirtualCasterTrail "virtual_caster_trail" LENGTH WheelRequirement::Steer, "";
    /// The same perpendicular to the virtual steering axis, in the wheel's side view.
    VirtualMechanicalTrail "virtual_mechanical_trail" LENGTH WheelRequirement::Steer, "";
    /// Distance of the wheel centre in front of the virtual steering axis, at the height of the centre.
    VirtualHubTrail "virtual_hub_trail" LENGTH WheelRequirement::Steer, "";
    /// Part of the braking dive that the front suspension's geometry takes, 1 for all of it.
    AntiDive "anti_dive" NUMBER WheelRequirement::Braking(VehicleEnd::Front), "";
    /// Part of the braking lift that the rear suspension's geometry takes, 1 for all of it.
    AntiLift "anti_lift" NUMBER WheelRequirement::Braking(VehicleEnd::Rear), "";
    /// Part of the driving squat that the rear suspension's geometry takes, 1 for all of it.
    AntiSquat "anti_squat" NUMBER WheelRequirement::Driving(VehicleEnd::Rear), "";
    /// Part of the driving lift that the front suspension's geometry takes, 1 for all of it.
    AntiRise "anti_rise" NUMBER WheelRequirement::Driving(VehicleEnd::Front), "";
}

wheel_measures! {
    /// Measures of an axle. Formulas and signs are in `docs/measures.md`.
    AxleMeasure, depends_on_driver: bool;
    /// Distance of the contact points across the vehicle.
    Track "track" LENGTH false, "";
    /// Sum of both toe angles.
    TotalToe "total_toe" ANGLE false, "toe-in";
    /// Steer angle of the outer wheel into the turn beyond what Ackermann's condition makes of the inner one's.
    AckermannError "ackermann_error" ANGLE false, "";
    /// Difference of both steer angles relative to Ackermann's, by the inner wheel; none below a mean of 1 degree.
    Ackermann "ackermann" NUMBER false, "";
    /// Radius of the path of the outer wheel's contact point, with the other axle straight ahead.
    TurningRadius "turning_radius" LENGTH false, "";
    /// Global y of the roll centre, from the paths of both contact points.
    RollCentreY "axle_roll_centre_y" LENGTH true, "";
    /// Height of the roll centre above the ground, from the paths of both contact points.
    RollCentreHeight "axle_roll_centre_height" LENGTH true, "";
}

impl WheelMeasure {
    /// True if it needs the wheel's kingpin.
    pub fn needs_kingpin(self) -> bool {
        self.needs() == WheelRequirement::Kingpin
    }

    /// Motion of the axle along which it is taken, if it depends on a driver.
    pub(crate) fn motion(self) -> AxleMotion {
        match self {
            Self::RollCentreHeight
            | Self::RollCentreHeightGeometric
            | Self::FrontCentreY
            | Self::FrontCentreZ
            | Self::SwingArmFront => AxleMotion::Roll,
            Self::SideCentreX
            | Self::SideCentreZ
            | Self::SwingArmSide
            | Self::AntiDive
            | Self::AntiLift
            | Self::AntiSquat
            | Self::AntiRise => AxleMotion::Heave,
            Self::Toe
            | Self::Camber
            | Self::CamberFront
            | Self::SteerAngle
            | Self::Caster
            | Self::KingpinInclination
            | Self::ScrubRadius
            | Self::SpindleOffset
            | Self::CasterTrail
            | Self::MechanicalTrail
            | Self::HubTrail
            | Self::WheelTravel
            | Self::WheelRecession
            | Self::HalfTrack
            | Self::HalfTrackChange
            | Self::ContactX
            | Self::ContactY
            | Self::ContactZ
            | Self::BumpSteer
            | Self::BumpCamber
            | Self::BumpRecession
            | Self::BumpScrub
            | Self::InstantAxisX
            | Self::InstantAxisY
            | Self::InstantAxisZ
            | Self::MotionRatio
            | Self::PlaneCentreFrontY
            | Self::PlaneCentreFrontZ
            | Self::PlaneCentreSideX
            | Self::PlaneCentreSideZ
            | Self::RollCentreHeightPlanes
            | Self::VirtualCaster
            | Self::VirtualKingpinInclination
            | Self::VirtualScrubRadius
            | Self::VirtualSpindleOffset
            | Self::VirtualCasterTrail
            | Self::VirtualMechanicalTrail
            | Self::VirtualHubTrail => AxleMotion::OneWheel,
        }
    }

    /// Measure of the kingpin that corresponds to this one of the virtual steering axis.
    pub(crate) fn of_kingpin(self) -> Option<Self> {
        Some(match self {
            Self::VirtualCaster => Self::Caster,
            Self::VirtualKingpinInclination => Self::KingpinInclination,
            Self::VirtualScrubRadius => Self::ScrubRadius,
            Self::VirtualSpindleOffset => Self::SpindleOffset,
            Self::VirtualCasterTrail => Self::CasterTrail,
            Self::VirtualMechanicalTrail => Self::MechanicalTrail,
            Self::VirtualHubTrail => Self::HubTrail,
            _ => return None,
        })
    }
}

impl AxleMeasure {
    /// True if it needs the wheelbase of the vehicle.
    pub fn needs_wheelbase(self) -> bool {
        matches!(self, Self::AckermannError | Self::Ackermann | Self::TurningRadius)
    }
}
