//! Proven bounds of the motion of a design.

use crate::motion::parts::PlanGeometry;
use crate::motion::stepper::Stepper;
use crate::motion::tube::OutputPosition;
use crate::motion::{ProvenMotion, Stop, advance};

use super::analysis::Analysis;
use super::walk::PreparedDesign;

impl Analysis<'_> {
    /// Motion of a design (variable k at `design[k]`), of which bounds between the output times are proved, and the
    /// reason why it ends before the last one, if it does. `None` with equilibrium: its elastic joints open as the forces
    /// ask for, not by laws.
    ///
    /// ```
    /// # use hardpoint::{Analysis, draft::Draft, law::Law, model::Model};
    /// # let draft = Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
    /// #     .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
    /// #     .times([0.0, 0.5]);
    /// let model = Model::from_draft(&draft).unwrap();
    /// let analysis = Analysis::new(&model).unwrap();
    /// let (mut motion, _) = analysis.proven_motion(&[]).unwrap();
    /// let arm = motion.over(0.0, 0.1).unwrap()[1];
    /// let sine = arm.rot.cols[0].y; // of every angle from 0 to 0.1 rad, and its rates
    /// assert!(sine.value().contains(0.05_f64.sin()) && sine.value().width() < 0.101);
    /// assert!(sine.d().contains(0.05_f64.cos()) && sine.dd().contains(-(0.05_f64.sin())));
    /// ```
    pub fn proven_motion(&self, design: &[f64]) -> Option<(ProvenMotion<'_>, Option<Stop>)> {
        if self.openings().is_some() {
            return None;
        }
        let (model, PreparedDesign { geometry, laws, .. }) = (self.solved_model(), self.design(design));
        let parts = PlanGeometry::same(model, self.topology(), &geometry, &laws);
        let mut one = Stepper::new(model, self.topology(), parts);
        let (mut outputs, mut plans, mut selections) = (Vec::new(), Vec::new(), None);
        let mut stop = None;
        for (k, &t) in model.times.iter().enumerate() {
            let moved = if k == 0 { advance::start(&mut one, t) } else { advance::advance(&mut one, t) };
            if let Err(reason) = moved {
                stop = Some(*reason);
                break;
            }
            if selections != Some(one.mechanism.selections) {
                selections = Some(one.mechanism.selections);
                plans.push(one.mechanism.topology.clone());
            }
            outputs.push(OutputPosition { at: one.mechanism.saved.clone(), plan: plans.len() - 1 });
        }
        Some((ProvenMotion::new(one.mechanism, outputs, plans), stop))
    }
}
