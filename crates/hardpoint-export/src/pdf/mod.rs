//! `report.pdf`: a run on paper with facts, picture, metrics, hardpoints, curves and influences.

mod document;
mod paper;
mod parts;
mod picture;
mod plot;

pub use parts::{DesignResult, PdfContent, PdfPart};
