//! Changed design alongside the nominal one: solved again, and predicted from the nominal derivatives.
//!
//! A value that differs from the nominal one by round-off only is replaced by it, so that the page draws both in the
//! same place.

use std::iter;

use hardpoint::Solution;
use hardpoint::joint::Quantity as Kind;
use hardpoint::load::Loads;
use hardpoint::model::{BodyId, Dimension, Direction, Model, VariableId};
use hardpoint::run::metrics_beside;
use hardpoint::space::Vec3;
use hardpoint_file::ModelFile;
use hardpoint_study::whatif::{WhatIf, unwrapped_value};
use hardpoint_table::series::{ORIGIN, settled};

use crate::page::{BodyTrack, Curve, Design, DesignCurves, DesignKind, DesignShapes, Value};
use crate::summary::StopFact;
use crate::whatif::follows;

use super::Compose;

/// Hardpoints of a body coincide if their distance is less than this fraction of the mechanism's size.
const SAME: f64 = 1e-9;

/// Changed design, solved over the same output times as the nominal one.
#[derive(Clone, Debug)]
pub struct ChangedDesign<'a> {
    /// Name on the page.
    pub name: String,
    /// Sentence on the origin and admissibility of the design; may be empty.
    pub note: String,
    /// Change of every variable, m, rad, or plain.
    pub change: &'a [f64],
    /// Solution of the nominal design at all output times.
    pub today: &'a Solution,
    /// Solution of the changed design.
    pub exact: &'a Solution,
    /// Prediction of the changed design from the nominal derivatives, if it is to be shown.
    pub prediction: Option<&'a WhatIf>,
}

impl<'a> ChangedDesign<'a> {
    /// Changed design of a what-if study, solved and predicted.
    pub fn of(model: &Model, what_if: &'a WhatIf) -> Self {
        Self {
            name: "changed".into(),
            note: sentence(&follows(model, what_if)),
            change: &what_if.change,
            today: &what_if.today,
            exact: &what_if.exact,
            prediction: Some(what_if),
        }
    }

    /// Maximum number of designs it adds to the page: solved, and predicted to first and to second order.
    pub(super) fn designs(&self) -> usize {
        if self.prediction.is_some() { 3 } else { 1 }
    }

    /// Sentence on the reason why its motion stopped early, if it did.
    pub(super) fn stopped(&self, file: &ModelFile) -> Option<String> {
        let stop = StopFact::of(file, self.exact)?;
        let (name, solved, asked) = (&self.name, self.exact.motion.len(), file.model.times.len());
        let solved = match solved {
            0 => "could not be solved".to_owned(),
            _ => format!("was solved for {solved} of {asked} steps"),
        };
        Some(format!("The {name} design {solved}: {} ({}).", stop.message, stop.code))
    }

    /// Number of output times at which both designs were solved.
    fn solved(&self) -> usize {
        self.today.motion.len().min(self.exact.motion.len())
    }

    /// Value of output m at time k, SI.
    fn value(&self, k: usize, m: usize) -> f64 {
        unwrapped_value(self.today, self.exact, k, m)
    }
}

impl Compose<'_> {
    /// The changed design, then its predictions. The nominal solution is stored at every `stride`-th output time;
    /// `bodies` and `values` are nominal.
    pub(super) fn designs(
        &self,
        changed: &ChangedDesign<'_>,
        stride: usize,
        bodies: &[BodyTrack],
        values: &[Value],
    ) -> Vec<Design> {
        let comparison = DesignComparison { today: self, changed, stride };
        let mut designs = vec![comparison.exact(bodies, values, &self.solved_loads(changed.change))];
        let follows = |what_if: &&WhatIf| what_if.cannot_follow.is_empty() && changed.solved() > 0;
        if let Some(what_if) = changed.prediction.filter(follows) {
            designs
                .extend([comparison.first_order(what_if, values), comparison.second_order(what_if, values)]);
        }
        designs
    }

    /// Changed design, solved.
    pub(super) fn exact(
        &self,
        changed: &ChangedDesign<'_>,
        stride: usize,
        bodies: &[BodyTrack],
        values: &[Value],
    ) -> Design {
        let loads = self.solved_loads(changed.change);
        DesignComparison { today: self, changed, stride }.exact(bodies, values, &loads)
    }

    /// Design at the stored output times, without its loads.
    pub(super) fn unloaded(
        &self,
        design: &ChangedDesign<'_>,
        bodies: &[BodyTrack],
        values: &[Value],
    ) -> Design {
        let comparison = DesignComparison { today: self, changed: design, stride: 1 };
        comparison.exact(bodies, values, &Loads::default())
    }
}

/// Returns `other`, replaced by the nominal number if they differ by round-off only, and by 0 if it is round-off
/// itself.
fn same_or_other(round_off: f64, today: f64, other: f64) -> f64 {
    settled(if (other - today).abs() <= round_off { today } else { other }, round_off)
}

struct DesignComparison<'a> {
    today: &'a Compose<'a>,
    changed: &'a ChangedDesign<'a>,
    /// Stride of the stored output times among the solved ones.
    stride: usize,
}

impl DesignComparison<'_> {
    /// Curve over the shown output times; `value` is called for those at which both designs were solved.
    fn curve(&self, value: impl Fn(usize) -> f64) -> Curve {
        let solved = self.changed.solved();
        self.whole_steps().map(|k| if k < solved { value(k) } else { f64::NAN }).collect()
    }

    /// Shown output times, as indices of all solved ones.
    fn whole_steps(&self) -> impl Iterator<Item = usize> + '_ {
        self.today.steps.iter().map(|k| k * self.stride)
    }

    /// Value, rate and acceleration up to `orders`; the others are empty.
    fn curves(&self, orders: usize, value: impl Fn(usize, usize) -> f64) -> DesignCurves {
        let curve = |order| if order < orders { self.curve(|k| value(k, order)) } else { Curve::default() };
        DesignCurves { value: curve(0), rate: curve(1), accel: curve(2) }
    }

    /// Number of the other design, replaced by the nominal one if they differ by round-off only, and by 0 if it is
    /// round-off itself.
    fn other_value(&self, of: impl Into<Dimension>, order: usize, today: f64, other: f64) -> f64 {
        same_or_other(self.today.round_off.value(of.into(), order), today, other)
    }

    /// Position, velocity and acceleration of the origin of each moving body in the changed design, at each shown
    /// output time.
    fn origins(&self) -> Vec<Vec<[[f64; 3]; 3]>> {
        let (units, solved) = (self.today.units, self.changed.solved());
        let round_off = [0, 1, 2].map(|order| self.today.round_off.value(Dimension::LENGTH, order));
        let at = |b: usize, k: usize| {
            if k >= solved {
                return [[f64::NAN; 3]; 3];
            }
            let [now, other] = [self.changed.today, self.changed.exact].map(|s| {
                let state = s.body(k, BodyId(b));
                [state.r, state.v, state.a].map(Vec3::to_array)
            });
            let shown = |order: usize, axis: usize| {
                let found = same_or_other(round_off[order], now[order][axis], other[order][axis]);
                units.from_si(Kind::Length, found)
            };
            [0, 1, 2].map(|order| [0, 1, 2].map(|axis| shown(order, axis)))
        };
        let bodies = if self.today.detail.origins { self.today.model.bodies.len() } else { 1 };
        (1..bodies).map(|b| self.whole_steps().map(|k| at(b, k)).collect()).collect()
    }

    /// Curves of all quantities: outputs, then x, y and z of every body's origin.
    fn quantities(
        &self,
        output: impl Fn(usize) -> Option<DesignCurves>,
        origin: impl Fn(usize, usize) -> Option<DesignCurves>,
    ) -> Vec<Option<DesignCurves>> {
        let (outputs, model) = (self.changed.today.measured.outputs.len(), self.today.model);
        let bodies = if self.today.detail.origins { model.bodies.len() } else { 1 };
        let origins = (1..bodies).flat_map(|b| (0..3).map(move |axis| (b, axis)));
        (0..outputs).map(output).chain(origins.map(|(b, axis)| origin(b, axis))).collect()
    }

    /// Values of the changed design in the order of the nominal ones: metrics, then measures at one time.
    fn values(
        &self,
        today: &[Value],
        metric: impl Fn(usize) -> Option<f64>,
        static_value: impl Fn(usize, usize) -> Option<f64>,
    ) -> Vec<Option<f64>> {
        let (model, units) = (self.today.model, self.today.units);
        let times = &self.changed.today.motion.times[..self.changed.solved()];
        let value = |(i, of): (usize, &Value)| {
            let (dimension, found) = match model.metrics.get(i) {
                Some(known) => (model.metric_dimension(known), metric(i)?),
                None => {
                    let (m, t) = (of.quantity?, of.time?);
                    let k = times.iter().position(|time| *time == t)?;
                    (self.changed.today.measured.outputs[m].dimension, static_value(k, m)?)
                }
            };
            let shown = units.from_si(dimension, found);
            let least = units.from_si(dimension, self.today.round_off.value(dimension, 0));
            let same = |now: &f64| (shown - now).abs() <= least;
            shown.is_finite().then(|| of.value.filter(same).unwrap_or(shown))
        };
        today.iter().enumerate().map(value).collect()
    }

    /// Design as solved again.
    fn exact(&self, bodies: &[BodyTrack], values: &[Value], loads: &Loads) -> Design {
        let (changed, units) = (self.changed, self.today.units);
        let (today, exact) = (changed.today, changed.exact);
        let output = |m: usize| {
            let output = &today.measured.outputs[m];
            let round_off = [0, 1, 2].map(|order| self.today.round_off.value(output.dimension, order));
            let value = |k: usize, order: usize| {
                let now = today.measured.value(k, m)[order];
                let other = if order == 0 { changed.value(k, m) } else { exact.measured.value(k, m)[order] };
                units.from_si(output.dimension, same_or_other(round_off[order], now, other))
            };
            Some(self.curves(output.known.orders, value))
        };
        let origins = self.origins();
        let origin = |b: usize, axis: usize| {
            let curve = |order: usize| origins[b - 1].iter().map(|at| at[order][axis]).collect();
            Some(DesignCurves { value: curve(0), rate: curve(1), accel: curve(2) })
        };
        let margins = &exact.motion.margins;
        let mut quantities = self.quantities(output, origin);
        if !loads.times.is_empty() {
            let of_loads = self.today.load_curves(loads).into_iter().map(|of| {
                Some(DesignCurves { value: of.curve, rate: Curve::default(), accel: Curve::default() })
            });
            quantities.extend(of_loads);
        }
        let found = metrics_beside(self.today.model, today, exact);
        let static_value = |k: usize, m: usize| Some(changed.value(k, m));
        Design {
            poses: self.poses(),
            skeletons: self.skeletons(bodies),
            loads: if loads.times.is_empty() { Vec::new() } else { self.today.forces(loads) },
            quantities,
            values: self.values(values, |metric| found[metric], static_value),
            margin: (!margins.is_empty())
                .then(|| self.curve(|k| margins.get(k).map_or(f64::NAN, |m| m.value))),
            clearance: self.clearance(),
            ..self.design(&changed.name, DesignKind::Exact, changed.note.clone())
        }
    }

    /// Design as predicted from the nominal sensitivities.
    fn first_order(&self, what_if: &WhatIf, values: &[Value]) -> Design {
        let units = self.today.units;
        let today = &what_if.today;
        let changed = || what_if.change.iter().enumerate().filter(|(_, by)| **by != 0.0);
        // A combination of variables may be followed although the single variables are not; rates are then unknown.
        let one_by_one = changed().all(|(v, _)| today.sensitivities.at(0, v).is_some());
        let output = |m: usize| {
            let output = &today.measured.outputs[m];
            let value = |k: usize, order: usize| {
                let now = today.measured.value(k, m)[order];
                let rise = || {
                    changed()
                        .map(|(v, by)| by * today.measured.derivative(k, VariableId(v), m, order))
                        .sum::<f64>()
                };
                let other = if order == 0 { what_if.predicted(k, m)[0] } else { now + rise() };
                units.from_si(output.dimension, self.other_value(output.dimension, order, now, other))
            };
            let known = one_by_one || output.known.by_position;
            let orders = if one_by_one { output.known.orders } else { 1 };
            known.then(|| self.curves(orders, value))
        };
        let origin = |b: usize, axis: usize| {
            let value = |k: usize, order: usize| {
                let state = today.body(k, BodyId(b));
                let now = [state.r, state.v, state.a][order].to_array()[axis];
                let rise = changed().map(|(v, by)| {
                    let s = today.sensitivities.at(k, v).map(|s| s.body(b));
                    by * s.map_or(f64::NAN, |s| ORIGIN[order](&s).to_array()[axis])
                });
                units.from_si(
                    Kind::Length,
                    self.other_value(Kind::Length, order, now, now + rise.sum::<f64>()),
                )
            };
            one_by_one.then(|| self.curves(3, value))
        };
        let change = self.change();
        let prediction = |of: &Value| {
            let rise = change.iter().zip(&of.sensitivities).filter(|(by, _)| **by != 0.0);
            let rise: Option<f64> = rise.map(|(by, d)| d.map(|d| by * d)).sum();
            Some(of.value? + rise.filter(|_| !of.sensitivities.is_empty())?)
        };
        let note = "Predicted from the nominal sensitivities, without solving again.".to_owned();
        Design {
            quantities: self.quantities(output, origin),
            values: values.iter().map(prediction).collect(),
            ..self.design("predicted to first order", DesignKind::FirstOrder, note)
        }
    }

    /// Design as predicted from the nominal first and second derivatives: quantities that depend on positions alone.
    fn second_order(&self, what_if: &WhatIf, values: &[Value]) -> Design {
        let units = self.today.units;
        let output = |m: usize| {
            let output = &what_if.today.measured.outputs[m];
            let value = |k: usize, _| {
                let now = what_if.today.measured.value(k, m)[0];
                units.from_si(
                    output.dimension,
                    self.other_value(output.dimension, 0, now, what_if.predicted(k, m)[1]),
                )
            };
            output.known.by_position.then(|| self.curves(1, value))
        };
        let static_value = |k: usize, m: usize| {
            what_if.today.measured.outputs[m].known.by_position.then(|| what_if.predicted(k, m)[1])
        };
        let note =
            "Predicted from the nominal first and second derivatives, without solving again.".to_owned();
        Design {
            quantities: self.quantities(output, |_, _| None),
            values: self.values(values, |_| None, static_value),
            ..self.design("predicted to second order", DesignKind::SecondOrder, note)
        }
    }

    /// Design without any known curves.
    fn design(&self, name: &str, kind: DesignKind, note: String) -> Design {
        Design {
            name: name.into(),
            kind,
            change: self.change(),
            note,
            poses: Vec::new(),
            skeletons: Vec::new(),
            loads: Vec::new(),
            quantities: Vec::new(),
            values: Vec::new(),
            margin: None,
            clearance: None,
        }
    }

    /// Shapes of the changed design and their distances, if the model has shapes.
    fn clearance(&self) -> Option<DesignShapes> {
        let model = self.today.analysis.model();
        if model.shapes.is_empty() {
            return None;
        }
        let steps: Vec<usize> = self.whole_steps().filter(|k| *k < self.changed.solved()).collect();
        let mut shapes = self.today.shapes(self.changed.change);
        shapes.iter_mut().for_each(|shape| shape.vertices = Curve::default());
        let pairs = self.today.pairs(self.changed.change, &self.changed.exact.motion, &steps, None);
        Some(DesignShapes { shapes, pairs })
    }

    /// Change of every variable, in its unit.
    fn change(&self) -> Vec<f64> {
        let variables = self.today.model.variables.iter().zip(self.changed.change);
        variables.map(|(v, by)| self.today.units.from_si(v.quantity, *by)).collect()
    }

    /// Poses of the bodies of the changed design. Unchanged bodies have the same numbers as in the nominal design.
    fn poses(&self) -> Vec<Curve> {
        let [far, turned] = [Dimension::LENGTH, Dimension::ANGLE].map(|of| self.today.round_off.value(of, 0));
        let pose = |k: usize, b: usize| {
            let [now, other] = [self.changed.today, self.changed.exact].map(|s| s.motion.at(k).body(b));
            let [p, mut q] = [now.quaternion(), other.quaternion()];
            if iter::zip(p, q).map(|(p, q)| p * q).sum::<f64>() < 0.0 {
                // Both signs of a quaternion are the same orientation.
                q = q.map(|x| -x);
            }
            let apart = iter::zip(p, q).map(|(p, q)| (p - q) * (p - q)).sum::<f64>().sqrt();
            let same = (now.r - other.r).norm() <= far && apart <= turned;
            let [x, y, z] = self.today.length(if same { now.r } else { other.r });
            let [qw, qx, qy, qz] = if same { p } else { q };
            [x, y, z, qw, qx, qy, qz]
        };
        let solved = self.changed.solved();
        let track = |b: usize| {
            let at = |k: usize| if k < solved { pose(k, b) } else { [f64::NAN; 7] };
            self.whole_steps().flat_map(at).collect()
        };
        (0..self.today.model.bodies.len()).map(track).collect()
    }

    /// Hardpoints of the changed design in its bodies' frames, in the order of the nominal ones.
    fn skeletons(&self, bodies: &[BodyTrack]) -> Vec<Vec<[f64; 3]>> {
        // Other designs can be requested even if the page shows no variables.
        let model = self.today.analysis.model();
        let same = self.today.units.from_si(Kind::Length, SAME * model.size());
        let mut moved: Vec<Vec<[Vec3; 2]>> = vec![Vec::new(); model.bodies.len()];
        let [today, changed] = [&[][..], self.changed.change].map(|design| model.geometry(design));
        let places = [&[][..], self.changed.change].map(|design| model.hardpoint_places(design));
        for (j, joint) in model.joints.iter().enumerate() {
            for (end, body) in joint.bodies.iter().enumerate() {
                moved[body.0].push([&today, &changed].map(|g| g.markers[j][end].r));
                let in_body = model.bodies[body.0].frame.inverse();
                let ends = [joint.axis, joint.axis2].into_iter().flatten().filter_map(Direction::hardpoints);
                moved[body.0]
                    .extend(ends.flatten().map(|h| [0, 1].map(|of: usize| in_body.point(places[of][h.0]))));
            }
        }
        for (p, point) in model.points.iter().enumerate() {
            moved[point.body.0].push([&today, &changed].map(|g| g.points[p]));
        }
        let near = |p: [f64; 3], q: [f64; 3]| iter::zip(p, q).all(|(p, q)| (p - q).abs() <= same);
        let at = |body: usize, place: [f64; 3]| {
            let candidates = moved[body].iter().map(|pair| pair.map(|p| self.today.length(p)));
            let mut found = candidates.filter(|[now, other]| near(*now, place) && !near(*other, place));
            found.next().map_or(place, |[_, other]| other)
        };
        let of_body = |(b, body): (usize, &BodyTrack)| body.skeleton.iter().map(|p| at(b, *p)).collect();
        bodies.iter().enumerate().map(of_body).collect()
    }
}

/// Text with an initial capital and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}
