//! Parts of the document, and their content beyond the run itself.

use hardpoint::space::Vec3;
use hardpoint_report::sketch::Stroke;

/// Part of a printed report. The print dialog of the page has the same parts with the same names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PdfPart {
    /// Line drawing of the mechanism.
    Picture,
    /// Metrics, of the nominal and all named designs.
    Metrics,
    /// Hardpoints, and the coordinates that each named design changes: old, new, change.
    Hardpoints,
    /// Design variables.
    Variables,
    /// Curves of the measures.
    Curves,
    /// Most influential variables of each measure.
    Influence,
}

impl PdfPart {
    /// All parts, in the order of the document.
    pub const ALL: [Self; 6] =
        [Self::Picture, Self::Metrics, Self::Hardpoints, Self::Variables, Self::Curves, Self::Influence];

    /// Name of the part.
    pub fn name(self) -> &'static str {
        match self {
            Self::Picture => "picture",
            Self::Metrics => "metrics",
            Self::Hardpoints => "hardpoints",
            Self::Variables => "variables",
            Self::Curves => "curves",
            Self::Influence => "influence",
        }
    }

    /// Part of this name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|part| part.name() == name)
    }
}

/// Choice of parts, with the results that the run itself does not have.
#[derive(Clone, Debug)]
pub struct PdfContent {
    /// Parts; their order is that of [`PdfPart::ALL`].
    pub parts: Vec<PdfPart>,
    /// Drawing of the mechanism.
    pub picture: Vec<Stroke>,
    /// Solved named designs of the model.
    pub designs: Vec<DesignResult>,
}

/// Named design of the model with its results, SI.
#[derive(Clone, Debug)]
pub struct DesignResult {
    /// Name.
    pub name: String,
    /// Positions of all hardpoints, in the order of the model.
    pub places: Vec<Vec3>,
    /// Metrics, in the order of the model; `None` where the motion does not reach them.
    pub metrics: Vec<Option<f64>>,
}

impl PdfContent {
    /// Returns whether the document has a part.
    pub fn has(&self, part: PdfPart) -> bool {
        self.parts.contains(&part)
    }
}
