//! Checks of cases that sweep two drivers over a grid.

use crate::draft::Section;
use crate::model::Grid;

use super::{Checker, Here};

/// Maximum number of positions of a grid. Each position is solved with all sensitivities, and all are stored.
const MOST_POSITIONS: usize = 100_000;

/// Minimum distance of two positions, relative to the range of the driver. Nearer positions cannot be distinguished by
/// their times.
const MIN_SEPARATION: f64 = 1e-9;

impl Checker<'_> {
    /// HP0240: invalid grids, or grids that are too large.
    pub(super) fn add_grids(&mut self) {
        let draft = self.draft;
        for (index, g) in draft.grids.iter().enumerate() {
            let here = Here { section: Section::Grids, index };
            let at = here.key("grid");
            let mut drivers = Vec::new();
            for (k, (driver, values)) in g.sweeps.iter().enumerate() {
                let names = draft.drivers.iter().map(|d| d.name.as_str());
                let Some(found) = self.find("driver", driver, here.item("grid", k), names) else { continue };
                let range = values.last().zip(values.first()).map_or(0.0, |(last, first)| last - first);
                let ascends = values.windows(2).all(|pair| pair[1] - pair[0] > MIN_SEPARATION * range);
                if !(range > 0.0 && range.is_finite() && ascends) {
                    let message = format!("driver `{driver}` has no range in the grid of case `{}`", g.name);
                    self.fault("HP0240", here.item("grid", k), message)
                        .help("give at least two finite positions in ascending order");
                    continue;
                }
                // A faulty driver is already reported.
                drivers.extend(self.driver_ids[found]);
            }
            let [(a, first), (b, second)] = &g.sweeps[..] else {
                let message = match g.sweeps.len() {
                    0 => format!("the grid of case `{}` names no driver", g.name),
                    1 => format!("the grid of case `{}` names one driver", g.name),
                    n => format!("the grid of case `{}` names {n} drivers", g.name),
                };
                let [x, y] = [0, 1].map(|k| draft.drivers.get(k).map_or("DRIVER", |d| d.name.as_str()));
                let fault = self.fault("HP0240", at, message);
                fault.note("a grid moves two drivers; all others are fixed in the design configuration");
                fault.help(match draft.drivers.len() {
                    0 | 1 => "give the case `laws` instead: a grid needs two drivers".into(),
                    _ => format!(
                        "name two, like `grid = {{ {x} = {{ from = -10, to = 10, steps = 8 }}, {y} = {{ from = -10, to = 10, steps = 8 }} }}`"
                    ),
                });
                continue;
            };
            if a == b {
                self.fault("HP0240", at, format!("the grid of case `{}` names driver `{a}` twice", g.name))
                    .help("name two drivers");
                continue;
            }
            let positions = first.len().saturating_mul(second.len());
            if positions > MOST_POSITIONS {
                let message = format!("the grid of case `{}` has {positions} positions", g.name);
                self.fault("HP0240", at, message)
                    .help(format!("use fewer `steps`: a grid has at most {MOST_POSITIONS} positions"));
                continue;
            }
            if let [a, b] = drivers[..] {
                let values = [first.clone(), second.clone()];
                self.model.grids.push(Grid { name: g.name.clone(), drivers: [a, b], values });
            }
        }
    }
}
