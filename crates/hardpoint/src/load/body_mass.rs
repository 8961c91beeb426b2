//! Mass properties of whole bodies.

use crate::model::Model;
use crate::space::{Mat3, Vec3};

use super::acting::{AppliedLoads, MovingBody, Solid};

/// Mass properties of a body in the nominal design configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMass {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass, m, global.
    pub centre: Vec3,
    /// Inertia matrix about the centre, kg m^2, along the global axes.
    pub inertia: Mat3,
}

/// Returns the sum of all masses of every body, ground included; `None` for bodies without mass.
pub fn body_masses(model: &Model) -> Vec<Option<BodyMass>> {
    let geometry = model.geometry(&[]);
    let bodies: Vec<MovingBody<f64>> =
        model.bodies.iter().map(|b| MovingBody { pose: b.frame, ..MovingBody::at_rest() }).collect();
    let acting = AppliedLoads {
        model,
        geometry: &geometry,
        bodies: &bodies,
        laws: &[],
        near: &[],
        friction: &[],
        share: 1.0,
        further: None,
    };
    let solids: Vec<Solid<f64>> = model.elements.iter().filter_map(|e| acting.solid(&e.kind)).collect();
    (0..model.bodies.len())
        .map(|b| {
            let own = || solids.iter().filter(|s| s.body.0 == b);
            let mass: f64 = own().map(|s| s.mass).sum();
            let centre = own().fold(Vec3::ZERO, |c, s| c + s.centre * (s.mass / mass));
            let mut cols = [Vec3::ZERO; 3];
            for (col, axis) in cols.iter_mut().zip(Vec3::AXES) {
                // I = sum I_k + m_k (d^2 1 - d d^T)
                for Solid { mass, centre: c, inertia, .. } in own() {
                    let d = *c - centre;
                    *col += inertia.on(axis) + (axis * d.dot(d) - d * d.dot(axis)) * *mass;
                }
            }
            (mass > 0.0).then_some(BodyMass { mass, centre, inertia: Mat3 { cols } })
        })
        .collect()
}
