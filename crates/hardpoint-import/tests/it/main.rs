//! Imported files are models that can be analysed.

mod bounded;
mod broken;
mod extensions;
mod four_bars;
mod fuzz;
mod meanings;
mod models;
mod robots;
mod settings;
mod unknown;
mod vehicles;

use std::io::Write;
use std::path::{Path, PathBuf};

use hardpoint_import::{ImportErrors, ImportedModel};

/// Folder of the sources, written in the style of their programs, one folder per format.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models")
}

/// Sources of all formats, by format and name, without included files.
fn sources() -> Vec<(String, PathBuf)> {
    const PARTS: [&str; 3] = ["finger.xml", "assets", "hook"];
    let mut out = Vec::new();
    for format in listed(&folder()) {
        for file in listed(&format) {
            let name = file.file_name().unwrap().to_string_lossy().into_owned();
            if !PARTS.contains(&name.as_str()) && name != "meshes" {
                out.push((format.file_name().unwrap().to_string_lossy().into_owned(), file));
            }
        }
    }
    out
}

fn listed(folder: &Path) -> Vec<PathBuf> {
    let mut list: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    list.sort();
    list
}

/// Returns the bytes of a source, or the FreeCAD document of a folder.
fn bytes(path: &Path) -> Vec<u8> {
    if path.is_dir() {
        document(&std::fs::read(path.join("Document.xml")).unwrap())
    } else {
        std::fs::read(path).unwrap()
    }
}

/// Returns a FreeCAD document.
fn document(xml: &[u8]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    zip.start_file("Document.xml", zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(xml).unwrap();
    zip.start_file("GuiDocument.xml", zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(b"<Document/>").unwrap();
    zip.finish().unwrap().into_inner()
}

/// Imports a source with access to its folder.
fn import(path: &Path) -> Result<ImportedModel, ImportErrors> {
    let folder = path.parent().unwrap().to_owned();
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    hardpoint_import::import(&bytes(path), &name, &|p| std::fs::read(folder.join(p)).ok())
}

/// Reads the model of an import with its files.
fn model(imported: &ImportedModel) -> hardpoint_file::ModelFile {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &imported.files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let path = folder.path().join("model.toml");
    std::fs::write(&path, &imported.text).unwrap();
    hardpoint_file::read(&path).unwrap_or_else(|e| panic!("{e}\n{}", imported.text))
}
