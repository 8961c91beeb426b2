//! Assemblies and senses of a mechanism from which an optimisation starts.

use std::sync::Arc;

use hardpoint::model::{Model, OptimizationSettings, StartPlacement};

use crate::evaluation::Motions;

/// Maximum number of other assemblies from which the searches start, the nearest first.
const MOST_ASSEMBLIES: usize = 15;

/// One assembly of the mechanism with one sense of its drivers.
///
/// All variants have the same design variables: the design configuration defines the shapes of the bodies, the
/// assembly how they are put together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variant {
    /// Number of the assembly; 0 is that of the model.
    pub assembly: usize,
    /// Placements of the bodies in that assembly of the nominal design.
    pub start: Vec<StartPlacement>,
    /// True if all drivers move in the opposite sense.
    pub reversed: bool,
}

impl Variant {
    /// Variants that the settings ask for; the first is the model as it is. `more` is called before every search for
    /// an assembly; if it returns false, the rest is not searched.
    pub fn all(
        model: &Model,
        motions: &Motions<'_>,
        settings: &OptimizationSettings,
        more: &dyn Fn() -> bool,
    ) -> Vec<Self> {
        let others = match motions.analyses().first() {
            Some(analysis) if settings.other_assemblies => analysis.other_assemblies(more),
            Some(_) | None => Vec::new(),
        };
        let assemblies = std::iter::once(model.start.clone()).chain(others.into_iter().take(MOST_ASSEMBLIES));
        let senses: &[bool] = if settings.both_senses { &[false, true] } else { &[false] };
        let variants = assemblies.enumerate().flat_map(|(assembly, start)| {
            senses.iter().map(move |reversed| Self { assembly, start: start.clone(), reversed: *reversed })
        });
        variants.collect()
    }

    /// True if the variant is the model as it is.
    pub fn is_own(&self) -> bool {
        self.assembly == 0 && !self.reversed
    }

    /// The model in this assembly and sense.
    pub fn model(&self, model: &Model) -> Model {
        let model = model.starting_at(&self.start);
        if self.reversed { model.reversed() } else { model }
    }

    /// Motions of the model in this assembly and sense; `None` if they cannot be driven.
    pub(super) fn motions(&self, model: &Model, motions: &Motions<'_>) -> Option<Motions<'static>> {
        let formulation = motions.analyses().first()?.topology().formulation;
        Motions::of(self.model(model).motions().into_iter().map(Arc::new), formulation).ok()
    }
}
