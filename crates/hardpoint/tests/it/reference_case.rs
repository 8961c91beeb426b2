//! Reads a case of the reference folder and compares a solution with it.

use std::path::Path;

use hardpoint::Solution;
use hardpoint::joint::{JointType, Need};
use hardpoint::law::Law;
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::{Pose, Quat, Vec3};
use hardpoint::{draft::*, model::*};
use serde_json::Value;

pub struct Case {
    pub draft: Draft,
    pub redundant: usize,
    inadmissible: Vec<String>,
    admissible_at_design: Vec<(String, bool)>,
    results: Vec<Value>,
}

/// Result of a comparison.
#[derive(Default)]
pub struct Comparison {
    pub count: usize,
    pub worst: f64,
    pub worst_name: String,
}

fn text(v: &Value, key: &str) -> Result<String, String> {
    v[key].as_str().map(Into::into).ok_or_else(|| format!("`{key}` is missing in {v}"))
}

fn vec3(v: &Value) -> Option<Vec3> {
    let a = v.as_array()?;
    (a.len() == 3).then(|| Vec3::new(a[0].as_f64().unwrap(), a[1].as_f64().unwrap(), a[2].as_f64().unwrap()))
}

fn list<'a>(v: &'a Value, key: &str) -> impl Iterator<Item = &'a Value> {
    v[key].as_array().into_iter().flatten()
}

impl Case {
    pub fn read(path: &Path) -> Result<Self, String> {
        let bytes = std::fs::read(path).map_err(|e| e.to_string())?;
        let json: Value = serde_json::from_slice(&bytes).map_err(|e| e.to_string())?;
        let mut draft = Draft { name: text(&json, "name")?, ..Draft::default() };
        for b in list(&json, "bodies") {
            let q: Vec<f64> = list(b, "quaternion").map(|x| x.as_f64().unwrap()).collect();
            let rot = Quat::from_array([q[0], q[1], q[2], q[3]]).ok_or("null quaternion")?.rotation();
            let frame = FrameDraft::Pose(Pose { rot, r: vec3(&b["r"]).ok_or("no r")? });
            draft.bodies.push(BodyDraft { name: text(b, "name")?, frame });
        }
        for j in list(&json, "joints") {
            draft.joints.push(joint(j)?);
        }
        for c in list(&json, "couplers") {
            let terms = list(c, "terms").map(|t| {
                Ok(TermDraft {
                    joint: text(t, "joint")?,
                    coordinate: Some(text(t, "coordinate")?),
                    coefficient: t["coefficient"].as_f64().ok_or("no coefficient")?,
                })
            });
            let terms: Vec<TermDraft> = terms.collect::<Result<_, String>>()?;
            draft.couplers.push(CouplerDraft {
                name: text(c, "name")?,
                kind: CouplerKindDraft::Linear(terms),
                constant: 0.0,
            });
        }
        for d in list(&json, "drivers") {
            let coordinate = |name: &str| -> Result<DrivenDraft, String> {
                Ok(DrivenDraft::Coordinate { joint: text(d, "joint")?, coordinate: Some(name.into()) })
            };
            let law = Law::parse(&text(d, "expression")?).map_err(|e| e.to_string())?;
            let drives = match text(d, "kind")?.as_str() {
                "joint_angle" => coordinate("angle")?,
                "joint_displacement" => coordinate("displacement")?,
                "joint_length" => coordinate("length")?,
                "point_coordinate" => {
                    let along = vec3(&d["direction"]).ok_or("no direction")?;
                    let point = PointRef::On { body: text(d, "body")?, at: place(&d["location"])? };
                    DrivenDraft::Position { point, along: DirectionDraft::Along(along) }
                }
                other => return Err(format!("driver kind `{other}` is not built yet")),
            };
            draft.drivers.push(DriverDraft::new(text(d, "name")?, drives, law));
        }
        let mut inadmissible = Vec::new();
        let mut admissible_at_design = Vec::new();
        for v in list(&json, "design_variables") {
            draft.design.push(variable(v)?);
            admissible_at_design
                .push((text(v, "name")?, v["admissible_at_design"].as_bool().unwrap_or(true)));
        }
        for v in list(&json, "inadmissible_design_variables") {
            draft.design.push(variable(v)?);
            inadmissible.push(text(v, "name")?);
        }
        for p in list(&json, "points") {
            draft.points.push(PointDraft::new(text(p, "name")?, text(p, "body")?, place(&p["location"])?));
        }
        for m in list(&json, "measures") {
            draft.measures.push(measure(m)?);
        }
        draft.times = list(&json, "times").map(|t| t.as_f64().unwrap()).collect();
        Ok(Self {
            draft,
            redundant: json["counts"]["redundant_equations"].as_u64().unwrap_or(0) as usize,
            inadmissible,
            admissible_at_design,
            results: list(&json, "results").cloned().collect(),
        })
    }

    /// Inadmissible variables are reported as such, and the others as admissible or re-assembled.
    pub fn check_admissibility(&self, model: &Model, solution: &Solution) -> Result<(), String> {
        for name in &self.inadmissible {
            let b = model.variable(name).unwrap();
            match &solution.sensitivities.admissibility[b.0] {
                Admissibility::CannotFollow { joints, .. } if !joints.is_empty() => {
                    if solution.sensitivities.at(0, b.0).is_some() {
                        return Err(format!("`{name}` cannot be followed but has numbers"));
                    }
                }
                other => return Err(format!("`{name}` is inadmissible but reported as {other:?}")),
            }
        }
        for (name, at_design) in &self.admissible_at_design {
            let b = model.variable(name).unwrap();
            match (&solution.sensitivities.admissibility[b.0], at_design) {
                (Admissibility::Admissible, true) | (Admissibility::Reassembled { .. }, false) => {}
                (other, _) => {
                    return Err(format!(
                        "`{name}`: admissible at the design {at_design}, reported as {other:?}"
                    ));
                }
            }
        }
        Ok(())
    }

    /// The case's output times are every that many of the solution's.
    pub fn compare(&self, model: &Model, solution: &Solution, every: usize) -> Result<Comparison, String> {
        let mut scales = Scales::default();
        for result in &self.results {
            scales.gather(result, &mut Vec::new());
        }
        let mut out = Comparison::default();
        for (k, result) in self.results.iter().enumerate().map(|(k, result)| (every * k, result)) {
            let at = format!("t = {}", result["t"]);
            for (name, body) in result["bodies"].as_object().ok_or("no bodies")? {
                let id = model.body(name).ok_or("unknown body")?;
                let s = solution.motion.at(k).body(id.0);
                let mut check = |key: &str, got: Vec3| {
                    out.check(&scales, &["bodies", key], got, &body[key], || format!("{name} {key} at {at}"))
                };
                check("r", s.r)?;
                check("v", s.v)?;
                check("a", s.a)?;
                check("omega", s.omega)?;
                check("alpha", s.alpha)?;
                out.check_quaternion(s.quaternion(), &body["q"], || format!("{name} q at {at}"))?;
                for (variable, want) in body["d"].as_object().into_iter().flatten() {
                    let b = model.variable(variable).ok_or("unknown variable")?;
                    let d = solution
                        .sensitivities
                        .at(k, b.0)
                        .ok_or_else(|| format!("`{variable}` has no numbers"))?
                        .body(id.0);
                    let all = [
                        ("dr", d.dr),
                        ("dpi", d.dpi),
                        ("dv", d.dv),
                        ("domega", d.domega),
                        ("da", d.da),
                        ("dalpha", d.dalpha),
                    ];
                    for (key, got) in all {
                        let what = || format!("{name} {key} by {variable} at {at}");
                        out.check(&scales, &["bodies", "d", key], got, &want[key], what)?;
                    }
                }
            }
            for (name, point) in result["points"].as_object().into_iter().flatten() {
                let m = ["x", "y", "z"].map(|c| solution.measured.index(&format!("{name}.{c}")).unwrap());
                for (order, key) in ["p", "v", "a"].into_iter().enumerate() {
                    let got = Vec3::from(m.map(|m| solution.measured.value(k, m)[order]));
                    out.check(&scales, &["points", key], got, &point[key], || {
                        format!("{name} {key} at {at}")
                    })?;
                }
                for (variable, want) in point["d"].as_object().into_iter().flatten() {
                    let b = model.variable(variable).ok_or("unknown variable")?;
                    for (order, key) in ["dp", "dv", "da"].into_iter().enumerate() {
                        let got = Vec3::from(m.map(|m| solution.measured.d(k, b, m)[order]));
                        let what = || format!("{name} {key} by {variable} at {at}");
                        out.check(&scales, &["points", "d", key], got, &want[key], what)?;
                    }
                }
            }
            for (name, measure) in result["measures"].as_object().into_iter().flatten() {
                let m = solution.measured.index(name).ok_or("unknown measure")?;
                let value = solution.measured.value(k, m);
                for (order, key) in ["value", "rate", "accel"].into_iter().enumerate() {
                    let mut got = value[order];
                    let want = measure[key].as_f64().ok_or("no number")?;
                    if key == "value" && solution.measured.outputs[m].dimension == Dimension::ANGLE {
                        let turn = 2.0 * std::f64::consts::PI;
                        got -= turn * ((got - want) / turn).round();
                    }
                    out.check_number(&scales, &["measures", key], got, want, || {
                        format!("{name} {key} at {at}")
                    });
                }
                for (variable, want) in measure["d"].as_object().into_iter().flatten() {
                    let b = model.variable(variable).ok_or("unknown variable")?;
                    for (order, key) in ["dvalue", "drate", "daccel"].into_iter().enumerate() {
                        let got = solution.measured.d(k, b, m)[order];
                        let what = || format!("{name} {key} by {variable} at {at}");
                        out.check_number(
                            &scales,
                            &["measures", "d", key],
                            got,
                            want[key].as_f64().unwrap(),
                            what,
                        );
                    }
                }
            }
        }
        Ok(out)
    }
}

/// The largest magnitude of each kind of quantity in a case, at least 1.
#[derive(Default)]
struct Scales(std::collections::BTreeMap<String, f64>);

impl Scales {
    fn gather(&mut self, v: &Value, path: &mut Vec<String>) {
        match v {
            Value::Object(map) => {
                for (key, v) in map {
                    path.push(key.clone());
                    self.gather(v, path);
                    path.pop();
                }
            }
            Value::Array(a) => a.iter().for_each(|v| self.gather(v, path)),
            Value::Number(n) => {
                let key = Self::key(&path.iter().map(String::as_str).collect::<Vec<_>>());
                let most = self.0.entry(key).or_insert(1.0);
                *most = most.max(n.as_f64().unwrap().abs());
            }
            _ => {}
        }
    }

    /// `bodies/d/dr` of `bodies/crank/d/J1_x/dr`.
    fn key(path: &[&str]) -> String {
        let d = if path.contains(&"d") { "/d" } else { "" };
        format!("{}{d}/{}", path[0], path[path.len() - 1])
    }

    fn of(&self, path: &[&str]) -> f64 {
        self.0.get(&Self::key(path)).copied().unwrap_or(1.0)
    }
}

impl Comparison {
    fn check_number(
        &mut self,
        scales: &Scales,
        path: &[&str],
        got: f64,
        want: f64,
        what: impl Fn() -> String,
    ) {
        self.count += 1;
        let deviation = (got - want).abs() / scales.of(path);
        // NaN is the worst deviation of all.
        if !(deviation <= self.worst) {
            self.worst = if deviation.is_nan() { f64::INFINITY } else { deviation };
            self.worst_name = format!("{} (got {got:e}, reference {want:e})", what());
        }
    }

    fn check(
        &mut self,
        scales: &Scales,
        path: &[&str],
        got: Vec3,
        want: &Value,
        what: impl Fn() -> String,
    ) -> Result<(), String> {
        let want = vec3(want).ok_or_else(|| format!("no vector for {}", what()))?;
        for k in 0..3 {
            self.check_number(scales, path, got[k], want[k], &what);
        }
        Ok(())
    }

    /// Up to sign.
    fn check_quaternion(
        &mut self,
        got: [f64; 4],
        want: &Value,
        what: impl Fn() -> String,
    ) -> Result<(), String> {
        let want: Vec<f64> =
            want.as_array().ok_or("no quaternion")?.iter().map(|x| x.as_f64().unwrap()).collect();
        let sign = if got.iter().zip(&want).map(|(a, b)| a * b).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
        for k in 0..4 {
            self.check_number(&Scales::default(), &["q"], sign * got[k], want[k], &what);
        }
        Ok(())
    }
}

fn place(v: &Value) -> Result<LocationDraft, String> {
    vec3(v).map(LocationDraft::At).ok_or_else(|| format!("not a place: {v}"))
}

fn joint(j: &Value) -> Result<JointDraft, String> {
    let at = match (j.get("pivots"), j.get("location"), j.get("location_i")) {
        (Some(pivots), ..) => vec![place(&pivots[0])?],
        (_, Some(location), _) => vec![place(location)?],
        (_, _, Some(i)) => vec![place(i)?, place(&j["location_j"])?],
        _ => Vec::new(),
    };
    let pivot_axis = j.get("pivots").and_then(|p| Some(vec3(&p[1])? - vec3(&p[0])?));
    // A case may give a marker's axes where the joint needs none (a weld's, say): they place nothing.
    let kind = hardpoint::joint::named(&text(j, "type")?);
    let needs = |need: fn(&JointType) -> Need| {
        kind.is_none_or(|k| ![Need::Unused, Need::Orienting].contains(&need(k)))
    };
    let axis = |key: &str| j.get(key).and_then(vec3).map(DirectionDraft::Along);
    Ok(JointDraft {
        name: text(j, "name")?,
        kind: text(j, "type")?,
        bodies: [text(j, "body_i")?, text(j, "body_j")?],
        at,
        axis: pivot_axis.map(DirectionDraft::Along).or_else(|| axis("axis")).filter(|_| needs(|k| k.axis)),
        axis2: axis("axis2").filter(|_| needs(|k| k.axis2)),
        ..JointDraft::default()
    })
}

fn variable(v: &Value) -> Result<VariableDraft, String> {
    let changes = list(v, "terms")
        .map(|t| {
            let end = match text(t, "end")?.as_str() {
                "i" => End::I,
                "j" => End::J,
                _ => End::Both,
            };
            Ok(ChangeDraft::Marker {
                joint: text(t, "joint")?,
                end,
                position: vec3(&t["position"]).ok_or("no position")?,
                rotation: vec3(&t["rotation"]).ok_or("no rotation")?,
            })
        })
        .collect::<Result<_, String>>()?;
    Ok(VariableDraft {
        name: text(v, "name")?,
        changes,
        fixed_length: v["fixed_length"].as_bool().unwrap_or(false),
        ..VariableDraft::default()
    })
}

fn measure(m: &Value) -> Result<MeasureDraft, String> {
    let coordinate = |name: &str| -> Result<MeasureKindDraft, String> {
        Ok(MeasureKindDraft::Coordinate { joint: text(m, "joint")?, coordinate: Some(name.into()) })
    };
    let spin_axis = || vec3(&m["spin_axis"]).map(DirectionDraft::Along).ok_or("no spin axis");
    let point = |end: &str| -> Result<PointRef, String> {
        Ok(PointRef::On { body: text(m, &format!("body_{end}"))?, at: place(&m[format!("location_{end}")])? })
    };
    let kind = match text(m, "kind")?.as_str() {
        "joint_angle" => coordinate("angle")?,
        "joint_displacement" => coordinate("displacement")?,
        "joint_length" => coordinate("length")?,
        "toe" => MeasureKindDraft::Toe { body: text(m, "body")?, spin_axis: spin_axis()? },
        "camber" => MeasureKindDraft::Camber { body: text(m, "body")?, spin_axis: spin_axis()? },
        "distance" => MeasureKindDraft::Distance { from: point("i")?, to: point("j")? },
        other => return Err(format!("measure kind `{other}` is not built yet")),
    };
    Ok(MeasureDraft::new(text(m, "name")?, kind))
}
