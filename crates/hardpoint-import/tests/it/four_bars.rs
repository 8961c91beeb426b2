//! The same four-bar in every format that supports it: a crank of 0.1 m, a coupler of 0.35 m and a rocker of 0.25 m,
//! with bearings 0.4 m apart and the crank at 60 deg in the design configuration.

use hardpoint::model::BodyId;
use hardpoint::{Analysis, Run};

use crate::{folder, import, model};

const A: f64 = 0.1;
const B: f64 = 0.35;
const C: f64 = 0.25;
const D: f64 = 0.4;

/// Angle of the rocker at a crank angle, rad, with the coupler above.
fn rocker(crank: f64) -> f64 {
    let a = [A * crank.cos(), A * crank.sin()];
    let (dx, dy) = (D - a[0], -a[1]);
    let l = dx.hypot(dy);
    let x = (B * B - C * C + l * l) / (2.0 * l);
    let y = (B * B - x * x).sqrt();
    let b = [a[0] + (x * dx - y * dy) / l, a[1] + (x * dy + y * dx) / l];
    b[1].atan2(b[0] - D)
}

#[test]
fn a_four_bar_is_the_same_mechanism_in_every_format() {
    /// Tolerance of sources with sixteen digits.
    const SAME: f64 = 1e-12;
    let files = [
        "asmt/four_bar.asmt",
        "adams/four_bar.adm",
        "urdf/four_bar.urdf",
        "sdf/four_bar.sdf",
        "mjcf/four_bar.xml",
        "freecad/four_bar",
    ];
    for name in files {
        let file = model(&import(&folder().join(name)).unwrap());
        let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
        let body = |wanted: &str| {
            BodyId(file.model.bodies.iter().position(|b| b.name.eq_ignore_ascii_case(wanted)).unwrap())
        };
        let turned = |k: usize, wanted: &str| {
            let [x, drawn] = [k, 0].map(|k| solution.body(k, body(wanted)).rotation.cols[0]);
            (drawn.x * x.y - drawn.y * x.x).atan2(drawn.x * x.x + drawn.y * x.y)
        };
        let (crank, mut largest) = (60_f64.to_radians(), 0.0_f64);
        for k in 0..solution.motion.len() {
            let by = turned(k, "crank");
            largest = largest.max(by.abs());
            let off = turned(k, "rocker") - (rocker(crank + by) - rocker(crank));
            assert!(off.abs() < SAME, "{name}: the rocker is off by {off} at step {k}");
        }
        assert!(largest > 0.19, "{name}: the crank turns by {largest}");
    }
}
