//! A model of any size.

use std::fmt::Write;

/// Rockers in a row on pivots 100 mm apart, each coupled to the next one: two bodies and six design variables a stage.
pub fn rockers(stages: usize) -> String {
    let mut text = String::from(
        "name = \"rockers in a row\"\nunits = { length = \"mm\", angle = \"deg\" }\n[time]\nend = 2\nsteps = 200\n",
    );
    let mut points = String::from("[hardpoints]\npivot_0 = [0, 0, 0]\n");
    let mut bodies = String::from("[bodies]\nrocker_0 = {}\n");
    let joint = |name: &str, bodies: [&str; 2], at: &str| {
        let [i, j] = bodies;
        format!(
            "{name} = {{ type = \"revolute\", bodies = [\"{i}\", \"{j}\"], at = \"{at}\", axis = \"z\" }}\n"
        )
    };
    let mut joints = String::from("[joints]\n") + &joint("pivot_0", ["ground", "rocker_0"], "pivot_0");
    let (mut design, mut measures) = (String::from("[design]\n"), String::from("[measures]\n"));
    for k in 1..=stages {
        let (x, lean) = (100 * k, k % 3);
        let (rocker, coupler, before) =
            (format!("rocker_{k}"), format!("coupler_{k}"), format!("rocker_{}", k - 1));
        let (near, far, pivot) = (format!("near_{k}"), format!("far_{k}"), format!("pivot_{k}"));
        writeln!(
            points,
            "{pivot} = [{x}, 0, 0]\n{near} = [{}, 80, 0]\n{far} = [{}, {}, 0]",
            x - 90,
            x - lean,
            80 + lean
        )
        .unwrap();
        writeln!(bodies, "{coupler} = {{}}\n{rocker} = {{}}").unwrap();
        joints += &joint(&near, [&before, &coupler], &near);
        joints += &joint(&pivot, ["ground", &rocker], &pivot);
        joints += &joint(&far, [&coupler, &rocker], &far);
        for point in [&near, &far, &pivot] {
            for axis in ["x", "y"] {
                writeln!(design, "{point}_{axis} = {{ move = \"{point}\", along = \"{axis}\" }}").unwrap();
            }
        }
        writeln!(measures, "angle_{k} = {{ type = \"coordinate\", joint = \"{pivot}\" }}").unwrap();
    }
    text += &[points, bodies, joints, design, measures].concat();
    text + "[drivers]\nmotor = { joint = \"pivot_0\", law = \"0.2*sin(pi*t)\" }\n"
}
