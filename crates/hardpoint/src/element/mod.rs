//! Masses and forces: per type one file with its properties, its check and its formula.
//!
//! The fields of a type are declared in `elements!` of `model/element.rs`. Earlier rooms define what a type must have,
//! in traits without default methods, and use it without knowing the types:
//!
//! | trait | room | contents |
//! |---|---|---|
//! | `MassProperties` | model | body and mass |
//! | `ForceProperties` | model | bodies, dimension, law, compliance, friction |
//! | `CheckElement` | draft | errors in references and parameters |
//! | `MassFormula` | load | centre and inertia |
//! | `ForceFormula` | load | applied wrenches, magnitude, deflections |
//!
//! Signs and formulas are those of `docs/loads.md`.

mod bar;
mod block;
mod body_moment;
mod bushing;
mod coordinate_spring;
mod elastic_joint;
mod friction;
mod mesh;
mod point_force;
mod rigid;
mod spring;
mod tyre;
mod wheel_force;
