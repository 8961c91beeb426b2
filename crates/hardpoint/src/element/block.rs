//! Block with edges along the global axes in the design configuration.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, MassFormula, Solid, Spread};
use crate::model::element::{Block, MassProperties};
use crate::model::{BodyId, Model, NumberId, PointId};
use crate::number::{self, Real};
use crate::space::{Mat3, Vec3};

impl MassProperties for Block {
    fn body(&self, model: &Model) -> BodyId {
        model.points[self.centre.0].body
    }

    fn mass<T: Real>(&self, number: impl Fn(NumberId) -> T, _distance: impl Fn(PointId, PointId) -> T) -> T {
        number(self.density.0) * number(self.x.0) * number(self.y.0) * number(self.z.0)
    }
}

impl CheckElement for Block {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        c.check_mass_on(c.body_of(self.centre), "centre");
        let Self { centre: _, x, y, z, density } = self;
        c.check_positive("mass", [(x.0, "x"), (y.0, "y"), (z.0, "z"), (density.0, "density")]);
    }
}

impl MassFormula for Block {
    fn solid<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Solid<T> {
        let (body, zero) = (self.body(at.model), T::zero());
        let [x, y, z] = number::each(&[self.x, self.y, self.z], |n| at.number(n.0));
        let mass = self.mass(|n| at.number(n), |_, _| zero);
        let twelfth = mass * T::constant(1.0 / 12.0);
        let [a, b, c] =
            number::each(&[y * y + z * z, z * z + x * x, x * x + y * y], |square| square * twelfth);
        let cols = [Vec3::new(a, zero, zero), Vec3::new(zero, b, zero), Vec3::new(zero, zero, c)];
        let inertia = Spread::Matrix(at.turned(body.0), Mat3 { cols });
        Solid { body, mass, centre: at.point(self.centre), inertia }
    }
}
