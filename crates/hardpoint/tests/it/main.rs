//! The library as its users see it: whole mechanisms, from draft to sensitivities.

mod adjoint;
mod allocation;
mod assembly;
mod design_variables;
mod diagnosis;
mod documents;
mod elements;
mod formulas;
mod house;
mod identities;
mod jerk;
mod joints;
mod language;
mod loads;
mod loops;
mod random;
mod reference;
mod reference_case;
mod second;
mod verify;
mod workbench;
