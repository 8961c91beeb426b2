//! Rigid mass: a point mass, unless its inertia is given.

use crate::draft::{CheckElement, ElementCheck};
use crate::load::{AppliedLoads, MassFormula, Solid, Spread};
use crate::model::element::{MassProperties, Rigid};
use crate::model::{BodyId, Inertia, Model, NumberId, PointId, about_centre};
use crate::number::{Real, each};
use crate::space::{Mat3, Vec3};

/// Relative tolerance by which a moment of inertia may exceed the sum of the other two: rounding of the typed digits of
/// a flat plate.
const FLAT: f64 = 1e-3;

impl MassProperties for Rigid {
    fn body(&self, model: &Model) -> BodyId {
        model.points[self.centre.0].body
    }

    fn mass<T: Real>(&self, number: impl Fn(NumberId) -> T, _distance: impl Fn(PointId, PointId) -> T) -> T {
        number(self.mass.0)
    }
}

impl CheckElement for Rigid {
    fn check(&self, check: &mut ElementCheck<'_, '_>) {
        check.check_mass_on(check.body_of(self.centre), "centre");
        if self.about.is_some_and(|about| check.body_of(about) != check.body_of(self.centre)) {
            let message = format!("`about` of `{}` is not on the body of its centre", check.name);
            check.fault("HP0251", "about", message).help("put both points on the body that has the mass");
        }
        check.check_positive("mass", [(self.mass.0, "mass")]);
        self.check_inertia(check);
    }
}

impl Rigid {
    /// HP0252: moments of inertia about the centre that are physically impossible.
    fn check_inertia(&self, check: &mut ElementCheck<'_, '_>) {
        let Self { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about } = self;
        let given = [ixx, iyy, izz].map(|n| n.map(|n| check.value(n.0)));
        let products = [ixy, iyz, izx].map(|n| n.map(|n| check.value(n.0)));
        let offset = about.map_or(Vec3::ZERO, |about| {
            let [c, p] = [*centre, about].map(|p| check.model().position(check.model().points[p.0].at));
            c - p
        });
        let [moments, [d, e, f]] = about_centre(check.value(mass.0), offset, [given, products]);
        let [a, b, c] = moments;
        let shown = || {
            format!(
                "about its centre they are {a:.4}, {b:.4} and {c:.4} kg m^2, with products {d:.4}, {e:.4} and {f:.4}"
            )
        };
        let moved = about.is_some();
        let below = given.iter().zip(["ixx", "iyy", "izz"]).zip(moments);
        let below = below.filter(|((n, _), i)| n.is_some() && !(*i >= 0.0)).map(|((_, key), _)| key).next();
        if let Some(key) = below {
            let message = format!(
                "`{key}` of `{}` is negative{}",
                check.name,
                if moved { " about its centre" } else { "" }
            );
            let fault = check.fault("HP0252", key, message);
            if moved {
                fault.note(shown()).help("check `about`, `centre` and the units: moments of inertia about another point are never less than those about the centre of mass");
            } else {
                fault.help("correct it, or leave it out");
            }
            return;
        }
        // If a planar model gives only some of the moments, the others are unknown.
        if given.iter().any(|n| n.is_none()) {
            return;
        }
        let largest = a.max(b).max(c);
        let slack = largest * FLAT;
        // Principal moments obey I1 + I2 >= I3: the matrix (tr I / 2) 1 - I, the second moments of the mass, has no
        // negative eigenvalue.
        let half = 0.5 * (a + b + c);
        let (x, y, z) = (half - a + slack, half - b + slack, half - c + slack);
        let minors = [x, y, z, x * y - d * d, y * z - e * e, z * x - f * f];
        let determinant = x * (y * z - e * e) - d * (d * z - e * f) + f * (d * e - y * f);
        let cubed = slack * slack * slack;
        if !(minors.iter().all(|m| *m >= 0.0) && determinant >= -cubed) {
            let message = format!("the moments of inertia of `{}` are physically impossible", check.name);
            let fault = check.fault("HP0252", "ixx", message);
            fault.note("each is at most the sum of the other two, about any axes; products of inertia are the integrals of x y, y z and z x");
            if moved {
                fault.note(shown());
            }
            fault.help("give all three about the centre of mass, or give the point as `about`; if the products are entries of the inertia matrix, change their signs");
        }
    }
}

impl MassFormula for Rigid {
    fn solid<T: Real>(&self, at: &AppliedLoads<'_, T>) -> Solid<T> {
        let Self { centre, mass, ixx, iyy, izz, ixy, iyz, izx, about } = self;
        let of = |n: &Option<Inertia>| n.map(|n| at.number(n.0));
        let given = [[of(ixx), of(iyy), of(izz)], [of(ixy), of(iyz), of(izx)]];
        let (body, mass) = (self.body(at.model), at.number(mass.0));
        let [[a, b, c], [d, e, f]] = match about {
            Some(about) => {
                about_centre(mass, at.design_position(*centre) - at.design_position(*about), given)
            }
            None => each(&given, |list| each(&list, |n| n.unwrap_or(T::zero()))),
        };
        let cols = [Vec3::new(a, -d, -f), Vec3::new(-d, b, -e), Vec3::new(-f, -e, c)];
        let inertia = Spread::Matrix(at.turned(body.0), Mat3 { cols });
        Solid { body, mass, centre: at.point(*centre), inertia }
    }
}
