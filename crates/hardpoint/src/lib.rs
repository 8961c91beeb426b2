//! **Exact kinematics and design sensitivities of driven mechanisms.**
//!
//! Hardpoint solves mechanisms that prescribed motions drive (suspensions, linkages, parallel robots) for
//! position, velocity and acceleration, and differentiates all of them exactly by the *design*: where the
//! joints sit and how their axes point. No design is re-solved for that, and nothing is re-assembled.
//!
//! # Example
//!
//! Does the foot of an inclined slide move faster if its pivot goes up? A crank of 3 and a rod of 5 push a slider
//! along x; at the design configuration the crank stands upright, so the slider is at x = 4.
//!
//! ```
//! use hardpoint::{Analysis, law::Law, draft::*, model::*, space::Vec3};
//!
//! let body = |name: &str| BodyDraft { name: name.into(), frame: FrameDraft::Default };
//! let joint = |name: &str, kind: &str, i: &str, j: &str, at: &str, axis: [f64; 3]| JointDraft {
//!     name: name.into(),
//!     kind: kind.into(),
//!     bodies: [i.into(), j.into()],
//!     at: vec![Place::Hardpoint(at.into())],
//!     axis: Some(Line::Along(axis.into())),
//!     ..JointDraft::default()
//! };
//! let point = |name: &str, x: f64, y: f64| HardpointDraft { name: name.into(), position: Vec3::new(x, y, 0.0) };
//! let z = [0.0, 0.0, 1.0];
//! let draft = Draft {
//!     name: "slider-crank".into(),
//!     hardpoints: vec![point("O", 0.0, 0.0), point("A", 0.0, 3.0), point("B", 4.0, 0.0)],
//!     bodies: vec![body("crank"), body("rod"), body("slider")],
//!     joints: vec![
//!         joint("O", "revolute", "ground", "crank", "O", z),
//!         joint("A", "revolute", "crank", "rod", "A", z),
//!         joint("B", "revolute", "rod", "slider", "B", z),
//!         joint("slide", "translational", "ground", "slider", "B", [1.0, 0.0, 0.0]),
//!     ],
//!     drivers: vec![DriverDraft {
//!         name: "motor".into(),
//!         drives: DrivenDraft::Coordinate { joint: "O".into(), coordinate: None },
//!         law: Law::parse("-t").unwrap(), // one radian per second, clockwise
//!     }],
//!     design: vec![VariableDraft {
//!         name: "O up".into(),
//!         changes: vec![ChangeDraft::Move { hardpoint: "O".into(), velocity: Vec3::new(0.0, 1.0, 0.0) }],
//!         ..VariableDraft::default()
//!     }],
//!     measures: vec![MeasureDraft {
//!         name: "stroke".into(),
//!         kind: MeasureKindDraft::Coordinate { joint: "slide".into(), coordinate: None },
//!     }],
//!     times: vec![0.0, 0.1],
//!     ..Draft::default()
//! };
//! let model = Model::from_draft(&draft).expect("a sound model");
//! let solution = Analysis::new(&model).expect("one driver for one freedom").run();
//!
//! let stroke = solution.measured.index("stroke").unwrap();
//! let [_, speed, _] = solution.measured.value(0, stroke);
//! assert!((speed - 3.0).abs() < 1e-12); // the pin moves along x at 3 rad/s * 1, the slider with it
//!
//! let up = model.variable("O up").unwrap();
//! let [_, d_speed, _] = solution.measured.d(0, up, stroke);
//! assert!((d_speed + 1.0).abs() < 1e-12); // a crank shorter by 1 per unit
//! ```
//!
//! # The few ideas it rests on
//!
//! - A **model** is checked once and never changes; a changed design is a [`design::Geometry`] made from it.
//! - Columns are twists, rows are wrenches, and a design variable is a twist too (`docs/theory.md`). Joints are
//!   data: a chain of freedoms, and a list of elementary constraints ([`joint::JointType`]).
//! - A [`topology::Topology`] says once how the mechanism is solved; position, velocity, acceleration and every
//!   sensitivity then share one factorisation per step.
//! - What the numerics find (a limit, a dead point, a change that cannot be followed) is a value with figures,
//!   not an error: [`motion::Stop`], [`sensitivity::Admissibility`].
//!
//! SI units and radians inside and in this interface. The house from file to report is in `ARCHITECTURE.md`.
//!
//! # What is not supported
//!
//! Forces, masses and friction: motion here follows from drivers alone. Flexible bodies. Contacts that open and close. Joint
//! types beyond [`joint::ALL`]. The shape of a curve as a design variable.

mod blocks;
pub mod constraint;
pub mod design;
pub mod draft;
pub mod expression;
pub mod joint;
pub mod law;
mod linalg;
pub mod measure;
pub mod model;
pub mod motion;
pub mod number;
mod run;
pub mod sensitivity;
pub mod space;
pub mod study;
pub mod topology;

pub use run::{Analysis, Footprint, Keep, Kept, Progress, Sink, Solution, Streamed};
