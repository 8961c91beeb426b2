//! A model in somebody's hands: borrowed for a while, or shared by all who use it.

use std::ops::Deref;
use std::sync::Arc;

use super::Model;

/// A model that is borrowed, or owned together with others: a plan of the first kind ends with its model, one of the
/// second keeps it.
///
/// ```
/// # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
/// # let draft = Draft::new("crank")
/// #     .body("crank")
/// #     .revolute("pivot", ["ground", "crank"], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
/// #     .driver("motor", "pivot", Law::parse("t").unwrap())
/// #     .times([0.0, 0.5]);
/// use std::sync::Arc;
/// let model = Model::from_draft(&draft).unwrap();
/// let borrowed = Analysis::new(&model).unwrap();
/// let kept: Analysis<'static> = Analysis::new(Arc::new(model.clone())).unwrap();
/// assert_eq!(borrowed.model().name, kept.model().name);
/// ```
#[derive(Clone, Debug)]
pub enum SharedModel<'m> {
    /// Borrowed.
    Borrowed(&'m Model),
    /// Shared.
    Shared(Arc<Model>),
}

impl Deref for SharedModel<'_> {
    type Target = Model;

    fn deref(&self) -> &Model {
        match self {
            Self::Borrowed(model) => model,
            Self::Shared(model) => model,
        }
    }
}

impl<'m> From<&'m Model> for SharedModel<'m> {
    fn from(model: &'m Model) -> Self {
        Self::Borrowed(model)
    }
}

impl From<Arc<Model>> for SharedModel<'static> {
    fn from(model: Arc<Model>) -> Self {
        Self::Shared(model)
    }
}
