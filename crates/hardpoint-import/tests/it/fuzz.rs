//! Importers neither panic nor hang on any input.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::{bytes, sources};

/// Number of mutated files per source; the generator has a fixed seed.
const CHANGED: u32 = 40;

/// Mutation of the bytes of a file.
#[derive(Clone, Debug)]
enum Change {
    Cut(usize, usize),
    Put(usize, Vec<u8>),
    Swap(usize, usize, usize),
}

fn change() -> impl Strategy<Value = Change> {
    let words = [
        "<",
        ">",
        "\"",
        "'",
        "{",
        "}",
        "[",
        "]",
        "0",
        "-1e308",
        "1e999",
        "nan",
        "\n",
        "\t",
        ",",
        ":",
        "=",
        "(",
        "((((",
        "/",
        "!",
        "&",
        "\u{fffd}",
        "9999999999999",
    ];
    let word = prop_oneof![
        proptest::sample::select(words.to_vec()).prop_map(|w| w.as_bytes().to_vec()),
        proptest::collection::vec(any::<u8>(), 1..4)
    ];
    prop_oneof![
        (any::<usize>(), 1_usize..60).prop_map(|(k, n)| Change::Cut(k, n)),
        (any::<usize>(), word).prop_map(|(k, w)| Change::Put(k, w)),
        (any::<usize>(), any::<usize>(), 1_usize..30).prop_map(|(a, b, n)| Change::Swap(a, b, n)),
    ]
}

fn changed(mut bytes: Vec<u8>, changes: &[Change]) -> Vec<u8> {
    for change in changes {
        let n = bytes.len();
        if n == 0 {
            return bytes;
        }
        match change {
            Change::Cut(k, by) => {
                let k = k % n;
                bytes.drain(k..(k + by).min(n));
            }
            Change::Put(k, word) => {
                let k = k % n;
                bytes.splice(k..k, word.iter().copied());
            }
            Change::Swap(a, b, by) => {
                let (a, b) = (a % n, b % n);
                let piece = bytes[a..(a + by).min(n)].to_vec();
                bytes.splice(b..b, piece);
            }
        }
    }
    bytes
}

#[test]
fn no_bytes_make_an_importer_panic() {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let config = Config { cases: CHANGED, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, rng);
    for (format, path) in sources() {
        let format = hardpoint_import::Format::named(&format).unwrap();
        // Only the document in an archive is mutated, since nothing else in it is read.
        let is_folder = path.is_dir();
        let original =
            if is_folder { std::fs::read(path.join("Document.xml")).unwrap() } else { bytes(&path) };
        let folder = path.parent().unwrap().to_owned();
        let tried = runner.run(&proptest::collection::vec(change(), 1..6), |changes| {
            let mut bytes = changed(original.clone(), &changes);
            if is_folder {
                bytes = crate::document(&bytes);
            }
            let resolve = |p: &str| std::fs::read(folder.join(p)).ok();
            match hardpoint_import::import_as(format, &bytes, "file", &resolve) {
                Ok(imported) => {
                    // The result is a valid model file, even if the mechanism has errors.
                    let text: toml_edit::DocumentMut = imported.text.parse().unwrap();
                    prop_assert!(text.contains_key("name"));
                }
                Err(problems) => {
                    prop_assert!(problems.list().all(|d| d.code.starts_with("HP08") && !d.message.is_empty()))
                }
            }
            Ok(())
        });
        tried.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    }
}

#[test]
fn deeply_nested_files_are_rejected() {
    let deep = |open: &str, n: usize| open.repeat(n);
    for format in hardpoint_import::FORMATS {
        for open in ["<a>", "[", "{a: ", "- ", "(", "<default>", "<body>", "\t"] {
            let text = deep(open, 100_000);
            let bytes =
                if format.name == "freecad" { crate::document(text.as_bytes()) } else { text.into_bytes() };
            let result = hardpoint_import::import_as(format, &bytes, "file", &|_| None);
            assert!(result.is_err(), "{}: {open}", format.name);
        }
    }
}
