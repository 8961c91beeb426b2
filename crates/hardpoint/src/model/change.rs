//! The kinds of changes: what a design variable may do to a model, per unit of it.

use crate::model::{BodyId, DriverId, HardpointId, JointId, Model, ParameterId};
use crate::space::Vec3;

/// One of the two markers of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Marker on body i.
    I,
    /// Marker on body j.
    J,
    /// Both markers alike.
    Both,
}

impl End {
    /// True if marker 0 (i) or 1 (j) is meant.
    pub fn covers(self, end: usize) -> bool {
        match self {
            Self::I => end == 0,
            Self::J => end == 1,
            Self::Both => true,
        }
    }
}

/// The kinds of changes: their fields in a draft and in a model, the quantity of their variable, the number or marker
/// of the model that they change, and their description. A kind also has an effect (`design/change.rs`) and a check
/// (`draft/check/design.rs`). The model uses its half of each line, the draft (`draft/change.rs`) the other, and the
/// design the list.
macro_rules! changes {
    ($declare:ident) => { $declare! {
    /// A hardpoint moves; markers, axes and points on it follow.
    Move {
        /// Hardpoint that moves.
        hardpoint: String => HardpointId,
        /// Global velocity, m per unit.
        velocity: Vec3 => Vec3,
    } |_| Quantity::Length, ChangeTarget::Hardpoint(*hardpoint, *velocity),
        |w| w.say("moves", &w.model.hardpoints[hardpoint.0].name, format!(" along {}", (w.direction)(*velocity)));

    /// Markers of a joint move and turn by themselves.
    Marker {
        /// Joint whose markers rotate.
        joint: String => JointId,
        /// Markers that rotate.
        end: End => End,
        /// Global velocity of the marker's origin, m per unit.
        position: Vec3 => Vec3,
        /// Global rotation vector rate of the marker's axes, about its origin, rad per unit.
        rotation: Vec3 => Vec3,
    } |_| match (position.norm() > 0.0, rotation.norm() > 0.0) {
            (_, false) => Quantity::Length,
            (false, true) => Quantity::Angle,
            (true, true) => Quantity::Number,
        },
        ChangeTarget::Marker(*joint),
        |w| {
            let whose = match end {
                End::I => " marker i of",
                End::J => " marker j of",
                End::Both => "",
            };
            let name = w.joint(*joint);
            if *position != Vec3::ZERO {
                w.say(&format!("moves{whose}"), name, format!(" along {}", (w.direction)(*position)));
            }
            if *rotation != Vec3::ZERO {
                w.say(&format!("turns{whose}"), name, format!(" about {}", (w.direction)(*rotation)));
            }
        };

    /// The length of a rod that is given by itself grows.
    Length {
        /// Joint whose length changes.
        joint: String => JointId,
        /// m per unit.
        rate: f64 => f64,
    } |_| Quantity::Length, ChangeTarget::Length(*joint, *rate),
        |w| {
            let times = match rate.abs() {
                1.0 => String::new(),
                rate => format!(" ({} per unit)", (w.number)(rate)),
            };
            let name = w.joint(*joint);
            match (&w.model.joints[joint.0].curve, *rate > 0.0) {
                (Some(_), true) => w.say("moves", name, format!(" away from its curve{times}")),
                (Some(_), false) => w.say("moves", name, format!(" towards its curve{times}")),
                (None, true) => w.say("lengthens", name, times),
                (None, false) => w.say("shortens", name, times),
            }
        };

    /// A parameter of the model grows, and all that formulas make of it follows.
    Parameter {
        /// Parameter that changes.
        parameter: String => ParameterId,
        /// In the parameter's unit, per unit.
        rate: f64 => f64,
    } |known| known.parameter(parameter), ChangeTarget::Parameter(*parameter, *rate),
        |w| w.say(&format!("{} parameter", raises(*rate)), &w.model.parameters[parameter.0].name, String::new());

    /// A parameter of a driver's law grows, like its amplitude.
    Law {
        /// Driver whose law changes.
        driver: String => DriverId,
        /// Parameter of its law that changes.
        parameter: String => usize,
        /// In the parameter's own unit, per unit.
        rate: f64 => f64,
    } |known| known.parameter_of_law(driver, parameter), ChangeTarget::Law(*driver, *parameter, *rate),
        |w| {
            let driver = &w.model.drivers[driver.0];
            let name = &driver.law.parameters()[*parameter].name;
            w.say(raises(*rate), name, format!(" in the law of `{}`", driver.name));
        };

    /// The paper's design velocity of one marker: V of its place and U of its 3-1-3 Euler angles, both in its own
    /// body's frame (Eqs. 3.2, 3.3).
    Field {
        /// Joint whose marker moves.
        joint: String => JointId,
        /// The body whose marker it is.
        body: String => BodyId,
        /// V = ds'/d(tau), body frame, m per unit.
        v: Vec3 => Vec3,
        /// U = d(theta)/d(tau), rad per unit.
        u: Vec3 => Vec3,
    } |_| Quantity::Number, ChangeTarget::Marker(*joint),
        |w| {
            let marker = if w.model.joints[joint.0].bodies[0] == *body { "i" } else { "j" };
            w.say(&format!("field of marker {marker} of"), w.joint(*joint), String::new());
        };
    }};
}
pub(crate) use changes;

/// Changes with references resolved to ids.
macro_rules! in_models {
    ($(
        $(#[doc = $doc:literal])* $kind:ident {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        } |$known:pat_param| $quantity:expr, $target:expr, |$words:pat_param| $says:expr;
    )*) => {
        /// A part of what a design variable does, per unit of it.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Change {
            $($(#[doc = $doc])* $kind($kind),)*
        }

        $(
            $(#[doc = $doc])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $kind {
                $($(#[doc = $field_doc])* pub $field: $type,)*
            }

            impl From<$kind> for Change {
                fn from(change: $kind) -> Self {
                    Self::$kind(change)
                }
            }
        )*

        impl Change {
            /// Returns what it changes, and how fast, per unit of the variable.
            pub fn target(&self) -> ChangeTarget {
                match self {
                    $(#[allow(unused_variables, reason = "the rest is its effect")]
                    Self::$kind($kind { $($field),* }) => $target,)*
                }
            }
        }

        impl ChangeWords<'_> {
            fn change(&mut self, change: &Change) {
                match change {
                    $(#[allow(unused_variables, reason = "not every field is said")]
                    Change::$kind($kind { $($field),* }) => { let $words = self; $says })*
                }
            }
        }
    };
}

changes!(in_models);

/// Number or marker of a model that a change acts on, with its rate per unit of the variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChangeTarget {
    /// A hardpoint, which has this global velocity, m per unit.
    Hardpoint(HardpointId, Vec3),
    /// Markers of a joint by themselves.
    Marker(JointId),
    /// The given length of a joint, m per unit.
    Length(JointId, f64),
    /// A parameter of the model, in its own unit per unit.
    Parameter(ParameterId, f64),
    /// A parameter of a driver's law, by its index in [`Law::parameters`](crate::law::Law::parameters), in its own unit
    /// per unit.
    Law(DriverId, usize, f64),
}

impl Change {
    /// Returns the hardpoint that moves, and its global velocity, m per unit.
    pub fn hardpoint(&self) -> Option<(HardpointId, Vec3)> {
        if let ChangeTarget::Hardpoint(hardpoint, velocity) = self.target() {
            Some((hardpoint, velocity))
        } else {
            None
        }
    }

    /// Returns the joint whose markers change by themselves.
    pub fn markers_of(&self) -> Option<JointId> {
        if let ChangeTarget::Marker(joint) = self.target() { Some(joint) } else { None }
    }

    /// Returns the joint whose given length changes, and the rate, m per unit.
    pub fn length_of(&self) -> Option<(JointId, f64)> {
        if let ChangeTarget::Length(joint, rate) = self.target() { Some((joint, rate)) } else { None }
    }

    /// Returns the joint whose markers or length change by themselves.
    pub(crate) fn joint(&self) -> Option<JointId> {
        self.markers_of().or(self.length_of().map(|(joint, _)| joint))
    }

    /// Returns the parameter of the model that changes, and its rate, in its own unit per unit.
    pub fn parameter(&self) -> Option<(ParameterId, f64)> {
        if let ChangeTarget::Parameter(parameter, rate) = self.target() {
            Some((parameter, rate))
        } else {
            None
        }
    }

    /// Returns the parameter of a driver's law that changes, by its index in
    /// [`Law::parameters`](crate::law::Law::parameters), and its rate, in its own unit per unit.
    pub fn law(&self) -> Option<(DriverId, usize, f64)> {
        if let ChangeTarget::Law(driver, parameter, rate) = self.target() {
            Some((driver, parameter, rate))
        } else {
            None
        }
    }
}

/// Description of what changes do to some parts of a model: `moves` `a` and `b` ` along x`.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangeText {
    /// Verb of the change.
    pub verb: String,
    /// The names of those that it is done to.
    pub names: Vec<String>,
    /// Manner of the change; empty, or with a leading space.
    pub how: String,
}

/// Builder of the descriptions of changes.
struct ChangeWords<'a> {
    model: &'a Model,
    direction: &'a dyn Fn(Vec3) -> String,
    number: &'a dyn Fn(f64) -> String,
    said: Vec<ChangeText>,
}

impl<'a> ChangeWords<'a> {
    /// Adds a description; parts with the same verb and manner share one.
    fn say(&mut self, verb: &str, name: &str, how: String) {
        match self.said.iter_mut().find(|d| d.verb == verb && d.how == how) {
            Some(text) => text.names.push(name.to_owned()),
            None => self.said.push(ChangeText { verb: verb.to_owned(), names: vec![name.to_owned()], how }),
        }
    }

    fn joint(&self, joint: JointId) -> &'a str {
        &self.model.joints[joint.0].name
    }
}

fn raises(rate: f64) -> &'static str {
    if rate > 0.0 { "raises" } else { "lowers" }
}

impl Model {
    /// Describes changes in words. `direction` formats a global direction, `number` a number (SI, or without unit).
    /// Parts with the same description share one text.
    pub fn describe_changes(
        &self,
        changes: &[Change],
        direction: &dyn Fn(Vec3) -> String,
        number: &dyn Fn(f64) -> String,
    ) -> Vec<ChangeText> {
        let mut words = ChangeWords { model: self, direction, number, said: Vec::new() };
        changes.iter().for_each(|change| words.change(change));
        words.said
    }
}
