//! Second derivatives of equilibria: by every design variable and along one direction, of a force, a driver or the
//! design.
//!
//! First derivatives by the variables are computed in numbers that carry the derivative along the direction, so that
//! they carry the second ones. The compliance `dy/dF` of an output is its derivative along a force that grows, and its
//! gradient the second derivative by both; no step is chosen anywhere.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | `Curvatures::twists` | W and its derivative along c (55) | design twist of the bodies by a variable |

use crate::design::{BodyFixed, DesignMap, DesignVelocity};
use crate::law::Law;
use crate::linalg::Elimination;
use crate::load::{GivenLoads, OpeningLoads};
use crate::model::{DriverId, MeasureKind, Model, UnitForce};
use crate::motion::mechanism::Mechanism;
use crate::motion::parts::PlanGeometry;
use crate::motion::state_along::StateAlong;
use crate::number::Dual;
use crate::sensitivity::{DirectDifferentiation, PlanVelocity, along, laws_beside};
use crate::space::{Pose, Twist};
use crate::topology::Topology;

/// Equilibrium at which second derivatives are solved.
#[derive(Clone, Copy)]
pub(super) struct SolvedEquilibrium<'s> {
    /// Time, s.
    pub time: f64,
    /// Per element: approximate coordinate that it acts on.
    pub near: &'s [f64],
    /// All loads.
    pub loads: &'s GivenLoads,
    /// Per opening: its unit, in which the stiffness is near one.
    pub units: &'s [f64],
}

/// Direction of the second derivatives.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Along {
    /// A force grows from zero, beside all others.
    Force(UnitForce),
    /// A driver moves alone.
    Driver(DriverId),
    /// The design changes, with these rates of the variables.
    Design(Vec<f64>),
}

/// Solver of the second derivatives at equilibria along directions that share the values of the variables.
pub(crate) struct Curvatures<'a> {
    model: &'a Model,
    openings: &'a [DriverId],
    along: StateAlong,
    loads: OpeningLoads<'a, Dual>,
    /// Laws at a small step along the direction, forward and back, if the design changes along it.
    laws: Option<[Vec<Law>; 2]>,
    /// Per variable: body-fixed data of measures.
    pub fixed: Vec<BodyFixed<Dual<Dual>>>,
    stiffness: Elimination<Dual>,
    /// Per variable: twists of the bodies, with the derivative along the direction.
    twists: Vec<Vec<Twist<Dual>>>,
    /// Position along the direction.
    positions: Vec<(Along, Velocity)>,
}

/// First derivatives of the position along a direction.
struct Velocity {
    field: PlanVelocity<f64>,
    direct: DirectDifferentiation<f64>,
}

impl<'a> Curvatures<'a> {
    /// Solver for these directions, of the design with these values; `design` are the rates of the variables along all
    /// of them.
    pub fn new(
        design_map: &'a DesignMap<'a>,
        topology: &Topology,
        (values, design): (&[f64], &[f64]),
        (openings, kinds): (&'a [DriverId], &'a [MeasureKind]),
        directions: Vec<Along>,
    ) -> Self {
        let model = design_map.model();
        let variables = model.variables.len();
        let rate = |k: usize| design.get(k).copied().unwrap_or(0.0);
        let values: Vec<Dual> = values.iter().enumerate().map(|(k, v)| Dual { v: *v, d: rate(k) }).collect();
        let fixed = |by: usize| {
            let one = |k: usize| Dual::constant(if k == by { 1.0 } else { 0.0 });
            let along: Vec<_> = values.iter().enumerate().map(|(k, v)| Dual { v: *v, d: one(k) }).collect();
            design_map.fixed(&along)
        };
        let plain: Vec<f64> = values.iter().map(|x| x.v).collect();
        let velocity = |direction: Along| {
            let field = match &direction {
                Along::Force(_) => DesignVelocity::default(),
                Along::Driver(driver) => DesignVelocity::of_driver(*driver),
                Along::Design(rates) => design_map.field_along(&along(rates), &plain).with_laws_in_order(),
            };
            let field = PlanVelocity::new(topology, &field.with_openings(openings));
            (direction, Velocity { field, direct: DirectDifferentiation::new(model, topology) })
        };
        Self {
            model,
            openings,
            along: StateAlong::new(model, topology, &design_map.geometry(&values)),
            loads: OpeningLoads::new(
                design_map,
                topology,
                &values,
                (openings, kinds),
                &design_map.fields(&values),
                &[],
            ),
            laws: (!design.is_empty() && design_map.laws_change()).then(|| laws_beside(design_map, &values)),
            fixed: (0..variables).map(fixed).collect(),
            stiffness: Elimination::new(openings.len()),
            twists: vec![vec![Twist::zero(); model.bodies.len()]; variables],
            positions: directions.into_iter().map(velocity).collect(),
        }
    }

    /// Direction k.
    pub fn direction(&self, k: usize) -> &Along {
        &self.positions[k].0
    }

    /// Number of directions.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Solves at an equilibrium, along direction k, along which the openings have these rates.
    pub(super) fn solve(
        &mut self,
        mechanism: &mut Mechanism<'_>,
        at: &SolvedEquilibrium<'_>,
        k: usize,
        rates: &[f64],
    ) {
        let (direction, Velocity { field, direct }) = &mut self.positions[k];
        let (topology, parts) = (&mechanism.topology, &mechanism.parts);
        field.set_last_shifts(rates);
        field.set_time(|d| parts.law_of(d.0), at.time);
        direct.solve_position(topology, &mut mechanism.state, field);
        let further = match direction {
            Along::Force(force) => Some((*force, Dual { v: 0.0, d: 1.0 })),
            Along::Driver(_) | Along::Design(_) => None,
        };
        self.along.set(self.model, mechanism, &direct.flow.speeds[0]);
        let state = &mut self.along.state;
        self.loads.set_further(further);
        self.loads.forces((topology, state), at.near, at.loads, |_, _| ());
        self.loads.prepare(topology, state);
        self.set_twists(topology, parts, at);
    }

    /// Sets the twists of the bodies by every variable: `K p_b = -r_b`, `W = W_b + sum W_a p_b,a` (55).
    fn set_twists(&mut self, topology: &Topology, parts: &PlanGeometry<f64>, at: &SolvedEquilibrium<'_>) {
        let n = self.openings.len();
        let Self { along: StateAlong { state, .. }, loads, laws, stiffness, twists, .. } = self;
        loads.stiffness(|a, b, slope| {
            stiffness.row_mut(a)[b] = slope * Dual::constant(at.units[a] * at.units[b]);
        });
        stiffness.factor();
        let mut column = vec![Dual::constant(0.0); n];
        for (v, twists) in twists.iter_mut().enumerate() {
            let set_time = |field: &mut PlanVelocity<Dual>| {
                field.set_time(|d| parts.law_of(d.0), at.time);
                if let Some([ahead, behind]) = &*laws {
                    field.add_law_curvature([ahead, behind], at.time);
                }
            };
            let moved = |moved: &[Twist<Dual>]| twists.copy_from_slice(moved);
            loads.derivatives((topology, state), v, set_time, &mut column, moved);
            column.iter_mut().zip(at.units).for_each(|(r, unit)| *r = -*r * Dual::constant(*unit));
            stiffness.solve(&mut column);
            for ((p, unit), moved) in column.iter().zip(at.units).zip(loads.unit_twists()) {
                let p = *p * Dual::constant(*unit);
                twists.iter_mut().zip(moved).for_each(|(to, w)| *to = w.times_plus(p, *to));
            }
        }
    }

    /// Twist of a body along rates of the variables, and its derivative along the direction.
    pub fn twist_along(&self, rates: &[f64], body: usize) -> [Twist; 2] {
        let mut sums = [Twist::ZERO; 2];
        for (twists, rate) in self.twists.iter().zip(rates) {
            let (w, v) = (twists[body].w, twists[body].v);
            let value = Twist { w: w.map(|x| x.v), v: v.map(|x| x.v) };
            let derivative = Twist { w: w.map(|x| x.d), v: v.map(|x| x.d) };
            sums = [value.times_plus(*rate, sums[0]), derivative.times_plus(*rate, sums[1])];
        }
        sums
    }

    /// Poses of the bodies with their derivatives: outer by a variable, inner along the direction.
    pub fn poses(&self, variable: usize) -> Vec<Pose<Dual<Dual>>> {
        let of = |b: usize| {
            if b == 0 {
                Pose::IDENTITY.spread()
            } else {
                self.along.state.pose[b].along(self.twists[variable][b])
            }
        };
        (0..self.model.bodies.len()).map(of).collect()
    }
}
