//! The cells of long tables, which whoever writes them takes as they come.

/// The cells of a column, in some rows that follow each other.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Texts; empty where there is none.
    Texts(Vec<String>),
}

impl Cells {
    /// Total number.
    pub fn len(&self) -> usize {
        match self {
            Self::Whole(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Texts(cells) => cells.len(),
        }
    }

    /// More of the same kind.
    ///
    /// # Panics
    /// Where they are of another kind.
    pub fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::Whole(cells), Self::Whole(more)) => cells.extend(more),
            (Self::Numbers(cells), Self::Numbers(more)) => cells.extend(more),
            (Self::Texts(cells), Self::Texts(more)) => cells.extend(more),
            _ => panic!("a column keeps its kind"),
        }
    }

    /// One of them as text; empty where there is none.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Whole(cells) => cells[row].to_string(),
            Self::Numbers(cells) if cells[row].is_finite() => cells[row].to_string(),
            Self::Numbers(_) => String::new(),
            Self::Texts(cells) => cells[row].clone(),
        }
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Keeps some of them.
    ///
    /// # Panics
    /// Where `kept` does not say that of each.
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

    /// Cells beyond that number, split off.
    pub fn split_off(&mut self, at: usize) -> Self {
        match self {
            Self::Whole(cells) => Self::Whole(cells.split_off(at.min(cells.len()))),
            Self::Numbers(cells) => Self::Numbers(cells.split_off(at.min(cells.len()))),
            Self::Texts(cells) => Self::Texts(cells.split_off(at.min(cells.len()))),
        }
    }
}
