//! Columns of long tables, independent of the output format.

/// Cells of a column in consecutive rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Numbers; NaN for an empty cell.
    Numbers(Vec<f64>),
    /// Texts; empty for an empty cell.
    Texts(Vec<String>),
}

impl Cells {
    /// Number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Whole(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Texts(cells) => cells.len(),
        }
    }

    /// Appends cells of the same kind.
    ///
    /// # Panics
    /// If the kinds differ.
    pub fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::Whole(cells), Self::Whole(more)) => cells.extend(more),
            (Self::Numbers(cells), Self::Numbers(more)) => cells.extend(more),
            (Self::Texts(cells), Self::Texts(more)) => cells.extend(more),
            _ => panic!("a column keeps its kind"),
        }
    }

    /// Cell as text; empty for an empty cell.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Whole(cells) => cells[row].to_string(),
            Self::Numbers(cells) if cells[row].is_finite() => cells[row].to_string(),
            Self::Numbers(_) => String::new(),
            Self::Texts(cells) => cells[row].clone(),
        }
    }

    /// True if there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Keeps the cells with a true flag.
    ///
    /// # Panics
    /// If the number of flags differs from the number of cells.
    pub fn retain(&mut self, kept: &[bool]) {
        fn keep<T>(cells: &mut Vec<T>, kept: &[bool]) {
            assert_eq!(cells.len(), kept.len(), "each is kept or not");
            let mut kept = kept.iter();
            cells.retain(|_| kept.next().is_some_and(|k| *k));
        }
        match self {
            Self::Whole(cells) => keep(cells, kept),
            Self::Numbers(cells) => keep(cells, kept),
            Self::Texts(cells) => keep(cells, kept),
        }
    }

    /// Splits off the cells from an index on.
    pub fn split_off(&mut self, at: usize) -> Self {
        match self {
            Self::Whole(cells) => Self::Whole(cells.split_off(at.min(cells.len()))),
            Self::Numbers(cells) => Self::Numbers(cells.split_off(at.min(cells.len()))),
            Self::Texts(cells) => Self::Texts(cells.split_off(at.min(cells.len()))),
        }
    }
}
