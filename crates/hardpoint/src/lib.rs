//! **Exact kinematics and design sensitivities of driven mechanisms.**
//!
//! Hardpoint solves mechanisms that prescribed motions drive (suspensions, linkages, parallel robots) for
//! position, velocity and acceleration, and differentiates all of them exactly by the *design*: where the
//! joints sit and how their axes point. No design is re-solved for that, and nothing is re-assembled.
//!
//! # Example
//!
//! Does the foot of an inclined slide move faster if its pivot goes up? A crank of 3 and a rod of 5 push a slider
//! along x; at the design configuration the crank is upright, so the slider is at x = 4.
//!
//! ```
//! use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
//!
//! let [x, z] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
//! let draft = Draft::new("slider-crank")
//!     .hardpoint("O", [0.0, 0.0, 0.0])
//!     .hardpoint("A", [0.0, 3.0, 0.0])
//!     .hardpoint("B", [4.0, 0.0, 0.0])
//!     .bodies(["crank", "rod", "slider"])
//!     .revolute("O", ["ground", "crank"], "O", z)
//!     .revolute("A", ["crank", "rod"], "A", z)
//!     .revolute("B", ["rod", "slider"], "B", z)
//!     .translational("slide", ["ground", "slider"], "B", x)
//!     .driver("motor", "O", Law::parse("-t").unwrap()) // one radian per second, clockwise
//!     .variable_moving("O up", "O", [0.0, 1.0, 0.0])
//!     .measure("stroke", "slide")
//!     .times([0.0, 0.1]);
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
//! Forces, masses and friction: motion here follows from drivers alone. Flexible bodies. Contacts that open and close.
//! Joint types beyond [`joint::ALL`]. The shape of a curve as a design variable.

mod blocks;
pub mod constraint;
pub mod design;
pub mod draft;
pub mod expression;
pub mod joint;
pub mod law;
mod linalg;
mod load;
pub mod measure;
pub mod model;
pub mod motion;
pub mod number;
mod run;
pub mod sensitivity;
pub mod space;
pub mod study;
pub mod topology;

pub use run::{Analysis, Footprint, Progress, Run, SampledResults, Sampling, Sink, Solution, StreamSummary};

/// The example of the readme compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
