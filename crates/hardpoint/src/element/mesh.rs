//! Body of even density with the shape of a closed mesh.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, MassFormula, Solid, Spread};
use crate::model::element::{MassProperties, Mesh};
use crate::model::{BodyId, Model, NumberId, PointId};
use crate::number::{self, Real};
use crate::space::Mat3;

impl MassProperties for Mesh {
    fn body(&self, _model: &Model) -> BodyId {
        self.body
    }

    fn mass<T: Real>(&self, number: impl Fn(NumberId) -> T, _distance: impl Fn(PointId, PointId) -> T) -> T {
        number(self.density.0) * T::constant(self.mesh.volume)
    }
}

impl CheckElement for Mesh {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        c.check_mass_on(self.body, "body");
        c.check_positive("mass", [(self.density.0, "density")]);
    }
}

impl MassFormula for Mesh {
    fn solid<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Solid<T> {
        let Self { body, mesh, density } = self;
        let mass = self.mass(|n| at.number(n), |_, _| T::zero());
        let density = at.number(density.0);
        let (pose, frame) = (at.bodies[body.0].pose, at.model.bodies[body.0].frame);
        let place = if mesh.in_body { mesh.centre } else { frame.inverse().point(mesh.centre) };
        let axes = if mesh.in_body { pose.rot } else { at.turned(body.0) };
        let cols = number::each(&mesh.inertia(), |col| col.spread() * density);
        let inertia = Spread::Matrix(axes, Mat3 { cols });
        let centre = pose.point(place.spread());
        Solid { body: *body, mass, centre, inertia }
    }
}
