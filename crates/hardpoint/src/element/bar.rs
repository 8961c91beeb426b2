//! Round bar or tube between two points of a body.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, MassFormula, Solid, Spread};
use crate::model::element::{Bar, MassProperties};
use crate::model::{BodyId, Model, NumberId, PointId};
use crate::number::Real;

impl MassProperties for Bar {
    fn body(&self, model: &Model) -> BodyId {
        model.points[self.from.0].body
    }

    fn mass<T: Real>(&self, number: impl Fn(NumberId) -> T, distance: impl Fn(PointId, PointId) -> T) -> T {
        let (outer, bore) = (number(self.diameter.0), self.bore.map_or_else(T::zero, |b| number(b.0)));
        // m = rho pi/4 (D^2 - d^2) L
        let area = (outer * outer - bore * bore) * T::constant(std::f64::consts::FRAC_PI_4);
        number(self.density.0) * area * distance(self.from, self.to)
    }
}

impl CheckElement for Bar {
    fn check(&self, c: &mut ElementCheck<'_, '_>) {
        c.check_mass_on(c.body_of(self.from), "from");
        if c.body_of(self.from) != c.body_of(self.to) {
            let message = format!("the ends of `{}` are on different bodies", c.name);
            c.fault("HP0251", "to", message).help("put both ends on the body that has the mass");
        } else if c.coincide(self.from, self.to) {
            let message = format!("the ends of `{}` coincide", c.name);
            c.fault("HP0251", "to", message).help("give two different ends");
        }
        if let Some(bore) = self.bore {
            let (bore, outer) = (c.value(bore.0), c.value(self.diameter.0));
            if !(bore >= 0.0 && bore < outer) {
                let message = format!("the bore of `{}` is not less than its diameter", c.name);
                c.fault("HP0252", "bore", message).help("give a bore between 0 and the diameter");
            }
        }
        c.check_positive("mass", [(self.diameter.0, "diameter"), (self.density.0, "density")]);
    }
}

impl MassFormula for Bar {
    fn solid<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Solid<T> {
        let (p, q) = (at.point(self.from), at.point(self.to));
        let (outer, bore) = (at.number(self.diameter.0), at.or_zero(self.bore.map(|b| b.0)));
        let d = q - p;
        let length = d.norm();
        let mass = self.mass(|n| at.number(n), |_, _| length);
        // I_a = m (D^2 + d^2)/8,   I_t = I_a/2 + m L^2/12
        let axial = mass * (outer * outer + bore * bore) * T::constant(0.125);
        let across = axial * T::constant(0.5) + mass * length * length * T::constant(1.0 / 12.0);
        let inertia = Spread::Line(d * (T::one() / length), axial, across);
        Solid { body: self.body(at.model), mass, centre: (p + q) * T::constant(0.5), inertia }
    }
}
