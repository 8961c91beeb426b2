//! Analyses that solve a mechanism many times: each in a module of its own.
//!
//! - [`optimize`]: minimises misfits of metrics within limits, by exact derivatives.
//! - [`trade_off`]: the front of the best compromises between two or three goals.
//! - [`tolerance`]: spread of metrics and curves from tolerances of hardpoints; yields; allocation.
//! - [`calibrate`]: fits a design to measurements, and states what the data determine.
//! - [`sweep`]: metrics of designs drawn at random or on a grid, with sensitivity indices.
//! - [`grid`]: outputs and clearances over a grid of driver positions.
//! - [`map`]: tables of outputs over one to three drivers, whose interpolation has a proved error.
//! - [`envelope`]: the space that a shape sweeps, as a closed surface.
//! - [`synthesis`]: four-bars and slider-cranks from poses of a body, or from points of a path.
//! - [`verify`]: exact sensitivities against differences of re-solved designs.
//! - [`whatif`]: outputs of changed designs, predicted and solved.
//!
//! A study solves all cases of a model as one [`Motions`] and counts its effort in [`StudyCost`]. Its request is made
//! of the settings of the model file and the caller's overrides ([`optimize::Request::of`] and its siblings), or
//! refused with a [`RequestError`]; all defaults and rules are there. A [`Control`] receives the [`Progress`] and can
//! end the study.
//!
//! # Example
//!
//! The length of a pendulum for a target:
//!
//! ```
//! # use std::{num::NonZero, ops::ControlFlow};
//! # use hardpoint::{draft::Draft, law::Law};
//! use hardpoint::draft::{GoalDraft, MetricDraft, OptimizationSettingsDraft};
//! use hardpoint::model::{Model, Reduction};
//! use hardpoint_study::{Control, Motions, optimize::{self, optimize}};
//! use hardpoint::topology::Formulation;
//! # fn pendulum() -> Draft {
//! #     Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
//! #         .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
//! #         .point("tip", "arm", "tip").variable_moving("longer", "tip", [1.0, 0.0, 0.0]).times([0.0, 0.5])
//! # }
//!
//! let mut draft = pendulum();
//! draft.design[0].bounds = Some([-1.0, 1.0]);
//! draft.metrics.push(MetricDraft {
//!     name: "height".into(),
//!     of: "tip.y".into(),
//!     over: None,
//!     take: Reduction::Value(0.5),
//!     window: None,
//!     case: None,
//!     per_metre: 1.0,
//!     per_radian: 1.0,
//! });
//! let goal = GoalDraft {
//!     name: "height".into(),
//!     metric: "height".into(),
//!     weight: 1.0,
//!     target: Some(1.2),
//!     per_metre: 1.0,
//!     per_radian: 1.0,
//! };
//! draft.optimization = Some(OptimizationSettingsDraft {
//!     variables: None,
//!     goals: vec![goal],
//!     limits: vec![],
//!     margin: None,
//!     starts: 1,
//!     other_assemblies: false,
//!     both_senses: false,
//!     iterations: 50,
//!     trade_off: vec![],
//! });
//! let model = Model::from_draft(&draft).unwrap();
//! let models = model.motions();
//! let motions = Motions::of(&models, Formulation::Relative).unwrap_or_else(|_| panic!("it can be driven"));
//! let request = optimize::Request::of(&model, optimize::Overrides::default()).unwrap();
//! let control = Control {
//!     threads: NonZero::<usize>::MIN,
//!     progress: &mut |_| ControlFlow::Continue(()),
//!     more: &|| true,
//! };
//! let result = optimize(&model, &motions, &request, control);
//! let best = result.searches[0].found.as_ref().unwrap();
//! assert!((best.design[0] - (1.2 / 0.5_f64.sin() - 2.0)).abs() < 1e-6);
//! ```

pub mod calibrate;
pub mod envelope;
pub mod grid;
pub mod map;
pub mod optimize;
pub mod request;
pub mod sweep;
pub mod synthesis;
pub mod tolerance;
pub mod trade_off;
pub mod verify;
pub mod whatif;

mod evaluation;
mod position;
mod progress;
mod random;
mod recent;
mod samples;
mod validity;

pub use hardpoint_difference as difference;
pub use hardpoint_difference::{Comparison, Magnitude, NonsmoothClearances, StepError};

pub use evaluation::{DesignEvaluation, EvaluationError, Motions, StudyCost};
pub use position::position_model;
pub use progress::{Control, Progress, Step};
pub use random::{design_stream, draw};
pub use request::RequestError;
pub use samples::BLOCK;
pub use validity::{Validity, validity};

#[cfg(test)]
mod test_models {
    use hardpoint::draft::{Draft, JointDraft};
    use hardpoint::law::Law;

    /// Planar crank-rocker in the plane z = 0. The coupler is a distance joint; a point is measured on the rocker.
    pub fn crank_rocker() -> Draft {
        let rod = JointDraft::new("rod", "distance", ["crank", "rocker"]).at("B").at("C");
        Draft::new("four-bar")
            .hardpoint("A", [0.0, 0.0, 0.0])
            .hardpoint("B", [0.04, 0.2, 0.0])
            .hardpoint("C", [0.36, 0.6, 0.0])
            .hardpoint("D", [0.5, 0.0, 0.0])
            .bodies(["crank", "rocker"])
            .revolute("bearing", ["ground", "crank"], "A", [0.0, 0.0, 1.0])
            .revolute("pivot", ["ground", "rocker"], "D", [0.0, 0.0, 1.0])
            .joint(rod)
            .driver("motor", "bearing", Law::parse("2*t").unwrap())
            .point("tip", "rocker", [0.3, 0.5, 0.0])
    }
}
