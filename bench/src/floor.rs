//! The floor of the comparison: closed forms of W1 to W4 written by hand in C++ (`peers/floor/`), which also make the
//! reference that everybody's results are held against.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::Command;

use crate::designs::{DESIGNS, designs};

/// Inputs of the floor, in SI units: steps, times and drivers; then hardpoints and frames of W1 (in the plane) and of
/// W2, as in `peers/workloads.py`.
const DATA: &str = "2001 2.0 1001 10.0 0.06 0.5 0.03 0.2 1000 101 10.0
0.0 0.0 0.15 0.2 0.75 0.0
0.075 0.1 0.45 0.1 0.75 0.0
0.1 0.4 0.22 -0.25 0.38 0.23 0.0 0.72 0.19 -0.03 0.58 0.85 -0.005 0.66 0.4 -0.13 0.69 0.3 -0.15 0.33 0.31 -0.15 -0.33 0.31
-0.05 0.5 0.21 0.0 0.75 0.3 -0.02 0.6 0.7 -0.15 0.0 0.31
";

/// Compiles and runs the floor; its reference files are in `folder` then. Returns its JSON lines, whose times are
/// medians of that many repetitions.
///
/// # Errors
/// Where there is no g++, or files cannot be written.
pub fn run(folder: &Path, repetitions: usize) -> io::Result<String> {
    fs::create_dir_all(folder)?;
    let data = folder.join("floor_data.txt");
    let mut file = io::BufWriter::new(fs::File::create(&data)?);
    file.write_all(DATA.as_bytes())?;
    let base: Vec<f64> =
        DATA.lines().nth(3).unwrap_or("").split_whitespace().filter_map(|x| x.parse().ok()).collect();
    let designs = designs();
    assert_eq!((designs.len(), designs[0].len()), (DESIGNS, base.len()));
    for design in &designs {
        for (x, d) in base.iter().zip(design) {
            write!(file, "{} ", x + d)?;
        }
        writeln!(file)?;
    }
    file.into_inner()?.sync_data()?;

    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/peers/floor/floor.cpp");
    let program = folder.join("floor");
    let compiled = Command::new("g++")
        .args(["-O3", "-march=native", "-std=c++17", "-ffp-contract=fast", "-fno-math-errno"])
        .args(["-fno-trapping-math", "-mprefer-vector-width=512", source, "-lmvec", "-lm", "-o"])
        .arg(&program)
        .status()?;
    if !compiled.success() {
        return Err(io::Error::other("g++ does not compile peers/floor/floor.cpp"));
    }
    let out = Command::new(&program).arg(&data).arg(folder).arg(repetitions.to_string()).output()?;
    if !out.status.success() {
        return Err(io::Error::other(format!("the floor ends with {}", out.status)));
    }
    Ok(String::from_utf8_lossy(&out.stdout).into_owned())
}
