//! Proven bounds of outputs as functions of one to three drivers, with their partial derivatives.

use crate::design::BodyFixed;
use crate::measure::{Instant, bodies_asked_for};
use crate::model::{DriverId, Model, OutputSource};
use crate::motion::driver_box::{BoxEnclosure, DriverBoxes};
use crate::motion::parts::PlanGeometry;
use crate::motion::stepper::Stepper;
use crate::motion::{BoxFailure, Stop};
use crate::number::{Interval, Taylor};
use crate::space::Real;

use super::Analysis;
use super::walk::PreparedDesign;

/// Bounds of some outputs over a box of driver values, or at a point, with their partial derivatives by the drivers.
pub type BoundsOfOutputs = Vec<Taylor<Interval>>;

/// Outputs of a mechanism as functions of its drivers, with proven bounds.
///
/// The values of drivers count from the design configuration, m or rad; drivers that are not variables remain there.
pub struct DriverMap<'a> {
    model: &'a Model,
    outputs: Vec<OutputSource>,
    bodies: Vec<usize>,
    boxes: DriverBoxes<'a>,
    fixed: BodyFixed<Taylor<Interval>>,
}

impl DriverMap<'_> {
    /// Bounds over a box of driver values, on the branch of motion through the design configuration if all boxes whose
    /// union has the design configuration, or is [connected](Self::connect) with it, have been proved.
    ///
    /// # Errors
    /// A [`BoxFailure`]. A smaller box may succeed if [`BoxFailure::may_be_halved`].
    pub fn over(&mut self, boxed: &[Interval]) -> Result<BoundsOfOutputs, BoxFailure> {
        let (enclosure, middle) = self.boxes.over(boxed)?;
        let since: Vec<Interval> =
            boxed.iter().map(|over| *over - Interval::constant(over.middle())).collect();
        let (wide, narrow) = (self.outputs(&enclosure), self.outputs(&middle.enclosure));
        Ok(wide.into_iter().zip(&narrow).map(|(wide, narrow)| wide.narrowed(narrow, &since)).collect())
    }

    /// Bounds at a point, wide as round-off.
    ///
    /// # Errors
    /// A [`BoxFailure`].
    pub fn at(&mut self, values: &[f64]) -> Result<BoundsOfOutputs, BoxFailure> {
        let point = self.boxes.point(values)?;
        Ok(self.outputs(&point.enclosure))
    }

    /// Proves that the position at a point is that of a box which contains it.
    ///
    /// # Errors
    /// A [`BoxFailure`].
    pub fn connect(&mut self, boxed: &[Interval], values: &[f64]) -> Result<(), BoxFailure> {
        self.boxes.connect(boxed, values)
    }

    /// Number of boxes of which bounds were computed: the effort.
    pub fn computed(&self) -> usize {
        self.boxes.computed
    }

    fn outputs(&self, enclosure: &BoxEnclosure) -> BoundsOfOutputs {
        debug_assert!(self.bodies.iter().all(|b| *b < enclosure.poses.len()));
        let instant = Instant::new(self.model, &self.fixed, &enclosure.poses);
        self.outputs.iter().map(|output| instant.output(*output)).collect()
    }
}

impl Analysis<'_> {
    /// Outputs of a design as functions of one to three drivers; `None` with equilibrium, since elastic joints open as
    /// the forces require, not by laws.
    ///
    /// ```
    /// # use hardpoint::{Analysis, draft::Draft, law::Law, model::{DriverId, Model, OutputSource, PointId}};
    /// # use hardpoint::number::Interval;
    /// # let draft = Draft::new("pendulum").hardpoint("O", [0.0; 3]).hardpoint("tip", [2.0, 0.0, 0.0]).bodies(["arm"])
    /// #     .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0]).driver("motor", "O", Law::parse("t").unwrap())
    /// #     .point("tip", "arm", "tip").times([0.0, 0.5]);
    /// let model = Model::from_draft(&draft).unwrap();
    /// let analysis = Analysis::new(&model).unwrap();
    /// let height = OutputSource::Point(PointId(0), 1); // 2 sin(angle)
    /// let mut map = analysis.driver_map(&[], &[DriverId(0)], vec![height]).unwrap().unwrap();
    /// let bounds = &map.over(&[Interval::between(0.0, 0.1)]).unwrap()[0];
    /// let fourth = bounds.derivative([4, 0, 0]);
    /// assert!(fourth.contains(2.0 * 0.05_f64.sin()) && fourth.width() < 0.3);
    /// ```
    ///
    /// # Errors
    /// The reason why the design configuration cannot be solved.
    ///
    /// # Panics
    /// Panics unless there are one to three drivers.
    pub fn driver_map(
        &self,
        design: &[f64],
        drivers: &[DriverId],
        outputs: Vec<OutputSource>,
    ) -> Option<Result<DriverMap<'_>, Box<Stop>>> {
        assert!((1..=3).contains(&drivers.len()), "a map of {} drivers", drivers.len());
        if self.openings().is_some() {
            return None;
        }
        let (model, PreparedDesign { geometry, laws, .. }) = (self.solved_model(), self.design(design));
        let parts = PlanGeometry::same(model, self.topology(), &geometry, &laws);
        let one = Stepper::new(model, self.topology(), parts);
        let boxes = match DriverBoxes::new(one, drivers.iter().map(|d| d.0).collect()) {
            Ok(boxes) => boxes,
            Err(stop) => return Some(Err(stop)),
        };
        let fixed: BodyFixed<f64> = self.design_map().fixed(&model.whole(design));
        let fixed = fixed.map(Real::constant);
        Some(Ok(DriverMap { model, outputs, bodies: bodies_asked_for(model), boxes, fixed }))
    }
}
