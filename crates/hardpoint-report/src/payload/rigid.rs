//! Rigid mechanism alongside the elastic one, as a design to be compared with.

use hardpoint::Solution;
use hardpoint::load::Loads;

use crate::page::{BodyTrack, Curve, Design, DesignCurves, DesignKind, Value};
use crate::rigid::{has_metric, is_kinematic};

use super::Compose;
use super::designs::ChangedDesign;

impl Compose<'_> {
    /// Rigid mechanism with its measures and metrics as far as they have a meaning.
    /// It is under the same given `loads`, over which its measures can be drawn, and deflects nowhere.
    pub(super) fn rigid(
        &self,
        solved: &Solution,
        loads: &Loads,
        bodies: &[BodyTrack],
        values: &[Value],
    ) -> Design {
        let rigid = ChangedDesign {
            name: "rigid".into(),
            note: "The mechanism with rigid joints, over the same motion of the drivers.".into(),
            change: &[],
            today: self.solution,
            exact: solved,
            prediction: None,
        };
        let mut design = self.unloaded(&rigid, bodies, values);
        let outputs = &self.solution.measured.outputs;
        for (output, curves) in outputs.iter().zip(&mut design.quantities) {
            curves.take_if(|_| !is_kinematic(self.model, output.source));
        }
        let none = Curve::default;
        let of_loads = self.load_curves(loads).into_iter().map(|of| {
            let given = of.group == "force";
            given.then(|| DesignCurves { value: of.curve, rate: none(), accel: none() })
        });
        design.quantities.extend(of_loads);
        for (k, (of, value)) in values.iter().zip(&mut design.values).enumerate() {
            let known = match self.model.metrics.get(k) {
                Some(metric) => has_metric(self.model, metric),
                None => of.quantity.is_some_and(|m| is_kinematic(self.model, outputs[m].source)),
            };
            value.take_if(|_| !known);
        }
        Design { kind: DesignKind::Rigid, change: vec![0.0; self.model.variables.len()], ..design }
    }
}
