//! **Exact kinematics and design sensitivities of driven mechanisms.**
//!
//! Hardpoint solves mechanisms that are driven by prescribed motions (suspensions, linkages, parallel robots) for
//! position, velocity and acceleration, and differentiates all of them exactly with respect to the *design*: the
//! positions of the joints and the directions of their axes. The derivatives follow from the nominal solution: no
//! changed design is solved, so that there are no errors of finite differences.
//!
//! # Example
//!
//! Does the slider of a slider-crank move faster if the pivot of its crank moves up? A crank of length 3 and a
//! rod of length 5 drive a slider along x. In the design configuration the crank is upright and the slider at x = 4.
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
//! let model = Model::from_draft(&draft).expect("a consistent model");
//! let solution = Analysis::new(&model).expect("one driver for one freedom").run();
//!
//! let stroke = solution.measured.index("stroke").unwrap();
//! let [_, speed, _] = solution.measured.value(0, stroke);
//! assert!((speed - 3.0).abs() < 1e-12); // the pin moves along x at 3 m/s, and the slider with it
//!
//! let up = model.variable("O up").unwrap();
//! let [_, d_speed, _] = solution.measured.d(0, up, stroke);
//! assert!((d_speed + 1.0).abs() < 1e-12); // speed = angular speed x crank length, which shrinks
//! ```
//!
//! # Primary types
//!
//! - [`draft::Draft`] is a mechanism as written, with names for references. [`model::Model::from_draft`] checks it.
//! - [`model::Model`] is the checked mechanism. It is immutable; a changed design is a vector with one value per
//!   [`model::DesignVariable`].
//! - [`Analysis`] is a model with its solution plan ([`topology::Topology`]), ready to be run.
//! - [`Run`] is a request, and [`Solution`] its result: [`motion::Motion`], [`sensitivity::Sensitivities`] and
//!   [`measure::MeasureResults`].
//! - [`load::Loads`], [`run::Gradients`], [`run::SecondDerivatives`], [`run::Jerks`] and metrics ([`run::metrics`]) are
//!   other results of one design.
//! - The crate `hardpoint-study` has the analyses that need many runs: optimisation, tolerances, calibration, sweeps,
//!   verification.
//!
//! An early end of a run is part of its result, not an error: [`motion::Stop`] describes the reason.
//! [`sensitivity::Admissibility`] describes why a mechanism does not assemble when a design variable changes. Errors
//! are for invalid input and for mechanisms that cannot be driven: [`draft::DraftError`],
//! [`topology::TopologyError`], [`law::LawError`].
//!
//! # Conventions
//!
//! SI units and radians; global components unless stated otherwise. A *design* is one value per design variable, the
//! change from the *nominal design*, in which all are zero. The *design configuration* is the posture in which the
//! hardpoints are given. Joint angles and displacements are those of body j relative to body i and zero in the design
//! configuration; see [`joint`]. A *measure* is a scalar over time; an *output* is a measure or a component of a point;
//! a *metric* reduces an output to one number. Derivatives are total derivatives at fixed time. Functions do not panic
//! on any input unless their documentation has a section *Panics*.
//!
//! # Not supported
//!
//! - Dynamics: the motion follows from the drivers. Loads are computed along it ([`load::Loads`]), and small
//!   deflections about it (compliance).
//! - Flexible bodies.
//! - Contacts that open and close.
//! - Joint types beyond [`joint::ALL`].
//! - The shape of a cam or slot as a design variable.
//!
//! # Cookbook
//!
//! The examples share this pendulum, which turns about z at one radian per second:
//!
//! ```
//! # use hardpoint::{draft::Draft, law::Law};
//! fn pendulum() -> Draft {
//!     Draft::new("pendulum")
//!         .hardpoint("O", [0.0, 0.0, 0.0])
//!         .hardpoint("tip", [2.0, 0.0, 0.0])
//!         .bodies(["arm"])
//!         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0])
//!         .driver("motor", "O", Law::parse("t").unwrap())
//!         .point("tip", "arm", "tip")
//!         .variable_moving("longer", "tip", [1.0, 0.0, 0.0])
//!         .times([0.0, 0.5])
//! }
//! # let _ = pendulum();
//! ```
//!
//! ## Mass: torque of a driver
//!
//! ```
//! # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//! let draft = pendulum().point_mass("bob", "arm", "tip", 3.0).gravity([0.0, -10.0, 0.0]);
//! let model = Model::from_draft(&draft).unwrap();
//! let loads = Analysis::new(&model).unwrap().loads(&[]);
//! // 3 kg * 10 m/s^2 * 2 m, with the arm horizontal
//! assert!((loads.drivers_at(0)[0].force - 60.0).abs() < 1e-12);
//! ```
//!
//! ## Force: reaction of a joint
//!
//! ```
//! # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//! let draft = pendulum().force("pull", "arm", "tip", 7.0, [0.0, 1.0, 0.0]);
//! let model = Model::from_draft(&draft).unwrap();
//! let loads = Analysis::new(&model).unwrap().loads(&[]);
//! assert!((loads.joints_at(0)[0].force.y + 7.0).abs() < 1e-12); // the joint holds the arm
//! assert!((loads.drivers_at(0)[0].force + 14.0).abs() < 1e-12); // the motor resists 7 N * 2 m
//! ```
//!
//! ## Law: a smooth step instead of an expression
//!
//! ```
//! # use hardpoint::law::{Law, SmoothStep};
//! let law = Law::smooth_step(SmoothStep { from: 0.0, to: 1.0, start: 0.0, end: 2.0, degree: 5 }).unwrap();
//! let [value, speed, ..] = law.at(1.0).derivatives();
//! assert!((law.at(1.0).value() - 0.5).abs() < 1e-12);
//! # let _ = (value, speed);
//! ```
//!
//! ## Sensitivity of a point's position
//!
//! ```
//! # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//! let model = Model::from_draft(&pendulum()).unwrap();
//! let solution = Analysis::new(&model).unwrap().run();
//! let (y, longer) = (solution.measured.index("tip.y").unwrap(), model.variable("longer").unwrap());
//! let [d_value, d_rate, _] = solution.measured.d(1, longer, y);
//! assert!((d_value - 0.5_f64.sin()).abs() < 1e-12); // y = (2 + b) sin t
//! assert!((d_rate - 0.5_f64.cos()).abs() < 1e-12);
//! ```
//!
//! ## Gradients of few outputs by many variables
//!
//! ```
//! # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model, run::GradientMethod};
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//! let model = Model::from_draft(&pendulum()).unwrap();
//! let analysis = Analysis::new(&model).unwrap();
//! let gradients = analysis.gradients(&[], &[1], GradientMethod::Adjoint); // output 1 is tip.y
//! assert!((gradients.at(1, 0)[0][0] - 0.5_f64.sin()).abs() < 1e-12);
//! ```
//!
//! ## Second derivatives along a direction
//!
//! ```
//! # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//! let model = Model::from_draft(&pendulum()).unwrap();
//! let second = Analysis::new(&model).unwrap().second(&[0.0], &[vec![1.0]], &[[0, 0]]);
//! assert!(second.value(1, 0, 1).abs() < 1e-12); // tip.y is linear in the length
//! ```
//!
//! ## Many designs in one call
//!
//! ```
//! # use hardpoint::{Analysis, Run, draft::Draft, law::Law, model::Model};
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//! let model = Model::from_draft(&pendulum()).unwrap();
//! let designs: Vec<Vec<f64>> = (0..10).map(|k| vec![0.1 * f64::from(k)]).collect();
//! let mut heights = vec![0.0; designs.len()];
//! Analysis::new(&model).unwrap().solve_designs(Run::new().without_sensitivities(), &designs, |k, solution| {
//!     heights[k] = solution.measured.value(1, 1)[0];
//! });
//! assert!((heights[9] - 2.9 * 0.5_f64.sin()).abs() < 1e-12);
//! ```
//!
//! Studies (optimisation, tolerances, calibration, sweeps, verification) are in the crate `hardpoint-study`; model
//! files are read by the crate `hardpoint-file`.

mod blocks;
mod clearance;
pub mod constraint;
pub mod design;
pub mod draft;
mod element;
mod equilibrium;
pub mod expression;
pub mod joint;
pub mod law;
pub mod linalg;
pub mod load;
pub mod measure;
pub mod model;
pub mod motion;
pub mod number;
mod order;
pub mod run;
pub mod sensitivity;
pub mod space;
pub mod topology;

pub use run::{Analysis, Footprint, Progress, Run, SampledResults, Sampling, Sink, Solution, StreamSummary};

/// The example of the readme compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
