//! A folder for each test, and the command in it.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use flate2::read::DeflateDecoder;
use hardpoint_report::base91;
use tempfile::TempDir;

/// A folder with a model.
pub struct Bench {
    folder: TempDir,
}

impl Bench {
    /// Creates a folder with these model files of `tests/models`.
    pub fn with(models: &[&str]) -> Self {
        let bench = Self { folder: TempDir::new().unwrap() };
        for name in models {
            let text = std::fs::read_to_string(models_folder().join(name)).unwrap();
            bench.put(name, &text);
        }
        bench
    }

    /// Writes a file atomically, so that a server that watches it never reads half of it.
    pub fn put(&self, name: &str, text: &str) {
        let beside = self.folder.path().with_extension("put");
        std::fs::write(&beside, text).unwrap();
        std::fs::rename(&beside, self.path(name)).unwrap();
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// Reads the data of a page. A curve is a list of tracks; equal curves share them.
    pub fn page(&self, name: &str) -> serde_json::Value {
        let html = self.text(name);
        let (_, data) = html.split_once("id=\"payload\">").unwrap();
        let (data, _) = data.split_once("</script>").unwrap();
        let mut block = Vec::new();
        DeflateDecoder::new(&*base91::decode(data.trim()).unwrap()).read_to_end(&mut block).unwrap();
        // The block begins with four numbers; the first one is the length of the JSON after them.
        let length = u32::from_le_bytes(block[..4].try_into().unwrap()) as usize;
        serde_json::from_slice(&block[16..16 + length]).unwrap()
    }

    /// Names in a folder, sorted.
    pub fn list(&self, name: &str) -> Vec<String> {
        let Ok(entries) = std::fs::read_dir(self.path(name)) else { return Vec::new() };
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("hardpoint"));
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .env_remove("CLICOLOR_FORCE")
            .env("COLUMNS", "100");
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Output, error output and exit code as one text.
    pub fn shown(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let code = output.status.code().map_or("signal".into(), |c| c.to_string());
        format!(
            "$ hardpoint {}\n{}--- stderr\n{}--- exit {code}\n",
            arguments.join(" "),
            text(&output.stdout),
            text(&output.stderr)
        )
    }
}

pub fn models_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models")
}
