//! Maps of `hardpoint run`: cases that sweep two drivers over a grid.

use std::io;
use std::io::Write;

use hardpoint::topology::Formulation;
use hardpoint_file::ModelFile;
use hardpoint_report::maps::{MapFact, write_csv, write_sensitivity_csv};
use hardpoint_report::summary::Summary;
use hardpoint_study::grid::GridMap;

use crate::folder::{Folder, WriteError};
use crate::session::{Session, json_text};

/// Solves all maps of a file until the user interrupts.
pub fn solved(session: &Session, file: &ModelFile, formulation: Formulation) -> Vec<MapFact> {
    if file.model.grids.is_empty() {
        return Vec::new();
    }
    let _working = session.working("maps");
    let more = || !session.interrupted();
    let map = |grid| GridMap::solve(&file.model, grid, formulation, &[], &more).ok();
    let maps = file.model.grids.iter().filter_map(map);
    maps.map(|map| MapFact::of(&file.model, file.units, &map)).collect()
}

/// Adds the maps to a summary.
pub fn note(maps: &[MapFact], summary: &mut Summary) {
    summary.maps = maps.iter().map(MapFact::line).collect();
}

/// Writes the maps and returns the file names.
pub fn write(maps: &[MapFact], folder: &mut Folder) -> Result<Vec<&'static str>, WriteError> {
    if maps.is_empty() {
        return Ok(Vec::new());
    }
    folder.write("maps.csv", |out| write_csv(maps, out).map_err(io::Error::from))?;
    let mut names = vec!["maps.csv", "maps.json"];
    if maps.iter().flat_map(|m| &m.measures).any(|m| !m.sensitivities.is_empty()) {
        folder
            .write("map_sensitivity.csv", |out| write_sensitivity_csv(maps, out).map_err(io::Error::from))?;
        names.insert(1, "map_sensitivity.csv");
    }
    let json = json_text(&maps);
    folder.write("maps.json", |out| out.write_all(json.as_bytes()))?;
    Ok(names)
}
