//! Derivatives of loads by the design, by the virtual motion of each load; over plain numbers, or during recording.
//!
//! Every load is `y = sum F . Y`, with Y the twists of the bodies when its joint opens, or its driver moves alone. So
//! `y' = sum F' . Y + sum F . Y'` is linear in the design twists W, W., W.. and in the twists of the joint frames
//! (`docs/theory.md` (48)). The coefficients of masses and frames are computed once per load; each variable then takes
//! a few products per load, and one evaluation of the applied forces.
//!
//! | here | theory | meaning |
//! |---|---|---|
//! | [`Weights`] | C, w | derivatives of the load by joint wrenches, driver loads, and the wrench on ground |
//! | [`VirtualMotion`] | Y, S_Y | virtual motion due to these weights |
//! | `by_twists` | P | `sum F' . Y` of masses by W, W., W.. of each body |
//! | `turning` | | `sum F . Y'` by the twists of the frames that unit twists and wrenches turn with |
//! | `multipliers` | lambda | of the friction equations (46), which make friction independent of the design |

use std::mem::take;

use crate::design::Geometry;
use crate::model::{DriverId, ElementId, GROUND, MeasureKind, Model, VariableId};
use crate::motion::kinematics::State;
use crate::motion::level::of_body;
use crate::number::{self, Dual, Real};
use crate::sensitivity::{Differentiated, Turning};
use crate::space::{Twist, Vec3, Wrench};
use crate::topology::Topology;

use super::acting::{AppliedLoads, MovingBody};
use super::equilibrium::{Equilibrium, LoadedPosition};
use super::friction::Friction;
use super::inertia::{ChangedGeometry, InertialLoad, SpatialInertia};
use super::measures::LoadMeasures;
use super::transmitted::TransmittedLoads;
use super::virtual_motion::{TurningClosures, VirtualMotion, Weights};

/// A function of the transmitted loads.
#[derive(Clone, Copy)]
enum LoadFunction<'a> {
    /// A measure.
    Measure(&'a MeasureKind),
    /// The residual of a friction equation.
    Friction(usize),
}

impl LoadFunction<'_> {
    /// Derivative along the direction of these loads.
    fn derivative<T: Real>(
        self,
        friction: &Friction,
        applied: &AppliedLoads<'_, Dual<T>>,
        transmitted: &TransmittedLoads<Dual<T>>,
    ) -> T {
        match self {
            Self::Measure(kind) => LoadMeasures::new(applied, transmitted).measure(kind).d,
            Self::Friction(k) => friction.residual(k, applied, transmitted).d,
        }
    }
}

/// A load with its derivatives by required wrenches, by design twists, and by the twists of the joint frames.
pub(super) struct LoadAdjoint<'a, T> {
    function: LoadFunction<'a>,
    weights: Weights<T>,
    /// Per body: Y, less that of ground.
    virtual_twists: Vec<Twist<T>>,
    /// Per coordinate: its speed in the virtual motion.
    virtual_speeds: Vec<T>,
    /// Per body: coefficients of W, W., W... Those of ground are not used.
    pub by_twists: Vec<[Wrench<T>; 3]>,
    pub turning: Turning<T>,
    /// Multipliers of the friction equations that are part of all of the above.
    multipliers: Vec<T>,
}

impl<'a, T: Real> LoadAdjoint<'a, T> {
    fn new(function: LoadFunction<'a>, weights: Weights<T>, topology: &Topology, bodies: usize) -> Self {
        Self {
            function,
            weights,
            virtual_twists: vec![Twist::zero(); bodies],
            virtual_speeds: vec![T::zero(); topology.coordinates.len()],
            by_twists: vec![[Wrench::zero(); 3]; bodies],
            turning: Turning::new(topology),
            multipliers: Vec::new(),
        }
    }

    /// Adds `k` times a friction equation.
    fn add_times(&mut self, equation: &Self, k: T) {
        for b in 0..self.virtual_twists.len() {
            self.virtual_twists[b] = equation.virtual_twists[b].times_plus(k, self.virtual_twists[b]);
            for n in 0..3 {
                self.by_twists[b][n] = equation.by_twists[b][n].times_plus(k, self.by_twists[b][n]);
            }
        }
        self.turning.add_times(&equation.turning, k);
        self.multipliers.push(k);
    }
}

/// Derivatives of some loads at an equilibrium.
pub(super) struct LoadDerivatives<'a, T> {
    model: &'a Model,
    /// Per variable.
    pub changed: Vec<ChangedGeometry<T>>,
    pub constant: Geometry<Dual<T>>,
    /// The position with its derivative along the direction that was set last.
    pub position: LoadedPosition<Dual<T>>,
    /// Nominal motion of the bodies.
    pub nominal: Vec<MovingBody<Dual<T>>>,
    /// Required wrenches along the direction, and the bodies on which they may change.
    required: Vec<Wrench<Dual<T>>>,
    forced: Vec<usize>,
    /// Per body: the forces that act on it, and the bodies on which these forces act, itself included.
    forces_on: Vec<Vec<ElementId>>,
    beside: Vec<Vec<usize>>,
    /// Per body: true if it has masses.
    has_mass: Vec<bool>,
    /// Required wrenches on the bodies beside one, by its unit twists W.
    by_units: Vec<[Wrench<T>; 6]>,
    /// Per load: see [`LoadDerivatives::terms_by_own_driver`].
    terms: Vec<f64>,
    /// Derivatives of the friction equations along the direction, at constant reactions.
    residuals: Vec<T>,
    /// Transmitted loads at constant wrenches: only the speeds of drivers change.
    pub transmitted: TransmittedLoads<Dual<T>>,
    inertia: Vec<SpatialInertia<T>>,
    inertial: Vec<InertialLoad<T>>,
    closures: TurningClosures<T>,
    virtual_motion: VirtualMotion<T>,
    /// The loads, and the friction equations.
    pub loads: Vec<LoadAdjoint<'a, T>>,
    equations: Vec<LoadAdjoint<'a, T>>,
    /// Derivatives of the loads by the last variable.
    sums: Vec<T>,
    /// Components of all virtual motions, one load after the other for each.
    moves: Vec<T>,
}

impl<'a, T: Real> LoadDerivatives<'a, T> {
    /// Derivatives of these measures by variables with these geometries; `constant` has no derivative.
    pub fn new(
        at: &Equilibrium<'a, T>,
        topology: &Topology,
        kinds: impl IntoIterator<Item = &'a MeasureKind>,
        geometries: impl IntoIterator<Item = Geometry<Dual<T>>>,
        constant: Geometry<Dual<T>>,
    ) -> Self {
        let model = at.model;
        let bodies = model.bodies.len();
        let adjoint = |function, weights| LoadAdjoint::new(function, weights, topology, bodies);
        let load = |kind| adjoint(LoadFunction::Measure(kind), Weights::of_measure(kind));
        let equation = |(k, joint)| adjoint(LoadFunction::Friction(k), Weights::of_joint(joint));
        let loads: Vec<_> = kinds.into_iter().map(load).collect();
        let equations: Vec<_> = at.friction.joints().enumerate().map(equation).collect();
        let geometries = geometries.into_iter();
        let changed: Vec<_> = geometries.map(|g| ChangedGeometry::new(model, g)).collect();
        let inertia = vec![SpatialInertia::zero(); bodies];
        Self {
            model,
            forced: forced_bodies(model, &changed),
            beside: bodies_beside(model),
            has_mass: bodies_with_masses(model),
            forces_on: forces_on_bodies(model),
            by_units: vec![[Wrench::zero(); 6]; bodies],
            terms: vec![0.0; loads.len()],
            changed,
            constant,
            position: LoadedPosition::new(model),
            nominal: vec![MovingBody::at_rest(); bodies],
            required: vec![Wrench::zero(); bodies],
            residuals: vec![T::zero(); equations.len()],
            transmitted: TransmittedLoads::new(model),
            inertial: inertia.iter().map(|m| m.load(model, &MovingBody::at_rest())).collect(),
            inertia,
            closures: TurningClosures::new(topology),
            virtual_motion: VirtualMotion::new(topology, bodies),
            sums: vec![T::zero(); loads.len()],
            moves: Vec::new(),
            loads,
            equations,
        }
    }

    /// Solves for the virtual motions of all loads at an equilibrium. `multipliers` solves for the multipliers of the
    /// friction equations, given the derivatives of a load by the friction moments.
    pub fn set_equilibrium(
        &mut self,
        at: &Equilibrium<'_, T>,
        topology: &Topology,
        state: &mut State<T>,
        multipliers: impl Fn(&mut [T]),
    ) {
        SpatialInertia::all(&at.applied(), &mut self.inertia);
        for (b, inertial) in self.inertial.iter_mut().enumerate() {
            *inertial = self.inertia[b].load(self.model, &at.position.bodies[b]);
        }
        self.position.set_constant(&at.position);
        self.nominal.copy_from_slice(&self.position.bodies);
        self.transmitted.set_constant(&at.transmitted);
        self.closures.set(topology, state, &at.transmission);
        let (mut loads, mut equations) = (take(&mut self.loads), take(&mut self.equations));
        for load in loads.iter_mut().chain(&mut equations) {
            self.solve_virtual_motion(load, at, topology, state);
        }
        self.equations = equations;
        if !at.friction.is_empty() {
            self.add_friction(&mut loads, &at.friction, multipliers);
        }
        self.loads = loads;
    }

    /// Adds the friction equations to the loads, each times its multiplier: with them the moments need no derivative.
    fn add_friction(
        &mut self,
        loads: &mut [LoadAdjoint<'a, T>],
        friction: &Friction,
        multipliers: impl Fn(&mut [T]),
    ) {
        let mut by_moments = vec![Vec::new(); loads.len()];
        for e in friction.elements() {
            self.position.friction[e.0].d = T::one();
            self.require(friction, [e]);
            for (load, y) in loads.iter().zip(&mut by_moments) {
                y.push(self.partial(load, &self.constant, friction));
            }
            self.position.friction[e.0].d = T::zero();
        }
        for (load, mut y) in loads.iter_mut().zip(by_moments) {
            multipliers(&mut y);
            self.equations.iter().zip(y).for_each(|(equation, k)| load.add_times(equation, k));
        }
    }

    /// Solves for the virtual motion of a load, and sets its coefficients of masses and frames.
    fn solve_virtual_motion(
        &mut self,
        load: &mut LoadAdjoint<'_, T>,
        at: &Equilibrium<'_, T>,
        topology: &Topology,
        state: &mut State<T>,
    ) {
        let Self { model, constant, position, transmitted, virtual_motion, .. } = self;
        let LoadAdjoint {
            function,
            weights,
            virtual_twists,
            virtual_speeds,
            by_twists,
            turning,
            multipliers,
        } = load;
        multipliers.clear();
        let applied = position.loads(model, constant);
        weights.set(transmitted, |transmitted| function.derivative(&at.friction, &applied, transmitted));
        virtual_motion.solve(&at.sites, topology, state, weights);
        // The wrench on ground is -sum F.
        let ground = weights.of_ground();
        for (b, y) in virtual_motion.twists().iter().enumerate() {
            virtual_twists[b] = *y - ground;
        }
        virtual_speeds.copy_from_slice(virtual_motion.speeds());
        for (b, to) in by_twists.iter_mut().enumerate() {
            *to = match self.has_mass[b] {
                true => self.inertia[b].weights(model, &self.inertial[b], virtual_twists[b]),
                false => [Wrench::zero(); 3],
            };
        }
        let of = (&at.sites, &at.transmission);
        virtual_motion.turn(of, (topology, state, &self.closures), weights, turning, |body, load| {
            by_twists[body.0][0] += load;
        });
    }

    /// Computes the required wrenches of these elements, and the friction equations, along the direction that was set,
    /// with the constant geometry.
    pub fn require(&mut self, friction: &Friction, elements: impl IntoIterator<Item = ElementId>) {
        let Self { model, constant, position, required, residuals, transmitted, .. } = self;
        let applied = position.loads(model, constant);
        required.fill(Wrench::zero());
        elements.into_iter().for_each(|e| applied.add(e, required));
        set_residuals(residuals, friction, &applied, transmitted);
    }

    /// Computes the same along the direction that was set for a variable: the required wrenches of all forces, and of
    /// the masses that depend on it. The other masses are part of the coefficients.
    pub fn require_of(&mut self, friction: &Friction, variable: usize) {
        let Self { model, changed, position, nominal, required, residuals, transmitted, .. } = self;
        let ChangedGeometry { geometry, masses, .. } = &changed[variable];
        required.fill(Wrench::zero());
        let applied = position.loads(model, geometry);
        let forces = (0..model.elements.len()).filter(|e| !model.elements[*e].kind.has_mass());
        forces.for_each(|e| applied.add(ElementId(e), required));
        applied.add_further(required);
        // The coefficients have the derivative of the motion.
        let at_rest = AppliedLoads { bodies: nominal, ..applied };
        masses.iter().for_each(|e| at_rest.add(*e, required));
        set_residuals(residuals, friction, &applied, transmitted);
    }

    /// Adds the derivatives of all forces by the twists W of the bodies to the coefficients of the loads. This is for
    /// positions at rest, at which forces depend on nothing else that moves, and for loads of drivers.
    pub fn add_force_coefficients(&mut self, at: &Equilibrium<'_, T>) {
        self.terms.fill(0.0);
        for b in 1..self.forces_on.len() {
            if self.forces_on[b].is_empty() && !self.forced.contains(&b) {
                continue;
            }
            let beside = &self.beside[b];
            for (unit, twist) in Twist::UNITS.iter().enumerate() {
                let w = Twist { w: twist.w.spread(), v: twist.v.spread() };
                self.position.bodies[b] = at.position.bodies[b].along([w, Twist::zero(), Twist::zero()]);
                self.required.fill(Wrench::zero());
                let applied = self.position.loads(self.model, &self.constant);
                self.forces_on[b].iter().for_each(|e| applied.add(*e, &mut self.required));
                applied.add_further(&mut self.required);
                for (wrenches, of) in self.by_units.iter_mut().zip(beside) {
                    wrenches[unit] = self.required[*of].derivative();
                }
            }
            self.position.bodies[b] = self.nominal[b];
            for (load, terms) in self.loads.iter_mut().zip(&mut self.terms) {
                let own = number::each(&load.virtual_twists[b].components(), |y| y.value().abs());
                let mut slopes = [T::zero(); 6];
                for (wrenches, of) in self.by_units.iter().zip(beside) {
                    let y = load.virtual_twists[*of];
                    // A load does not depend on all bodies.
                    if y.components().into_iter().all(T::vanishes) {
                        continue;
                    }
                    let (w, v) = (sum_of_sizes(y.w), sum_of_sizes(y.v));
                    for (unit, wrench) in wrenches.iter().enumerate() {
                        slopes[unit] += wrench.on(y);
                        *terms += own[unit] * (sum_of_sizes(wrench.m) * w + sum_of_sizes(wrench.f) * v);
                    }
                }
                load.by_twists[b][0] += Wrench::from_work(slopes);
            }
        }
    }

    /// Sum of F' . Y with the required wrenches that were computed last.
    fn work_of_forces(&self, load: &LoadAdjoint<'_, T>) -> T {
        let work = |b: &usize| self.required[*b].derivative().on(load.virtual_twists[*b]);
        self.forced.iter().fold(T::zero(), |sum, b| sum + work(b))
    }

    /// Twists of the bodies in the virtual motion of each load; of the load of a driver those while it moves alone.
    pub fn virtual_twists(&self) -> impl Iterator<Item = &[Twist<T>]> + Clone {
        self.loads.iter().map(|load| &load.virtual_twists[..])
    }

    /// Derivatives of the loads of drivers at rest by these drivers, with the coefficients of the forces; calls `each`
    /// with the numbers of load and driver, and the derivative. The motion of a driver alone is the virtual motion of
    /// its load.
    pub fn differentiate_by_drivers(&mut self, mut each: impl FnMut(usize, usize, T)) {
        // K = P Y^T, with a row of P and of Y per load, over twists of bodies and speeds of coordinates. Y is stored by
        // columns: many coefficients are zero, since a load does not depend on all bodies.
        let Self { loads, moves, sums, .. } = self;
        let n = loads.len();
        moves.clear();
        if let Some(LoadAdjoint { virtual_twists, virtual_speeds, .. }) = loads.first() {
            moves.resize(n * (6 * virtual_twists.len() + virtual_speeds.len()), T::zero());
        }
        for (b, load) in loads.iter().enumerate() {
            let mut first = b;
            for y in &load.virtual_twists {
                for (k, y) in y.components().into_iter().enumerate() {
                    moves[first + k * n] = y;
                }
                first += 6 * n;
            }
            for (k, y) in load.virtual_speeds.iter().enumerate() {
                moves[first + k * n] = *y;
            }
        }
        let sums = &mut sums[..n];
        for (a, load) in loads.iter().enumerate() {
            sums.fill(T::zero());
            let mut add = |k: usize, p: T| {
                if !p.vanishes() {
                    let row = &moves[k * n..][..n];
                    for b in 0..n {
                        sums[b] = row[b].times_plus(p, sums[b]);
                    }
                }
            };
            for (body, by) in load.by_twists.iter().enumerate() {
                for (k, p) in by[0].work().into_iter().enumerate() {
                    add(6 * body + k, p);
                }
            }
            let first = 6 * load.by_twists.len();
            for (k, p) in load.turning.pulls.iter().enumerate() {
                add(first + k, *p);
            }
            for b in 0..n {
                each(a, b, sums[b]);
            }
        }
    }

    /// Per load of a driver: a bound of the terms of the forces in its derivative by this driver, whose round-off is
    /// that of the derivative. Set with the coefficients of the forces.
    pub fn terms_by_own_driver(&self) -> &[f64] {
        &self.terms
    }

    /// Derivatives of the loads of drivers at rest by a variable whose sensitivities have been solved, with the
    /// coefficients of the forces; calls `each` with the number of the load and its derivative.
    pub fn differentiate_at_rest(&mut self, by: &Differentiated<'_, T>, mut each: impl FnMut(usize, T)) {
        let Differentiated { variable, topology, state, field, flow } = by;
        let ChangedGeometry { geometry, masses, forces } = &self.changed[variable.0];
        let is_explicit = !masses.is_empty() || !forces.is_empty() || self.position.further.is_some();
        if is_explicit {
            self.required.fill(Wrench::zero());
            let applied = self.position.loads(self.model, geometry);
            masses.iter().chain(forces).for_each(|e| applied.add(*e, &mut self.required));
            applied.add_further(&mut self.required);
        }
        self.sums.fill(T::zero());
        let loads = self.loads.iter().map(|load| (&load.by_twists[..], &load.turning));
        field.add_work_at_rest((topology, state), flow, loads, &mut self.sums);
        for (n, load) in self.loads.iter().enumerate() {
            let explicit = if is_explicit { self.work_of_forces(load) } else { T::zero() };
            each(n, self.sums[n] + explicit);
        }
    }

    /// Takes into account that a further force acts on this body.
    pub fn act_on(&mut self, body: usize) {
        if let Err(place) = self.forced.binary_search(&body) {
            self.forced.insert(place, body);
        }
    }

    /// Derivative of a load along the direction that was set, apart from the coefficients: explicit, and through the
    /// required wrenches and friction equations that were computed last.
    pub fn partial(&self, load: &LoadAdjoint<'_, T>, geometry: &Geometry<Dual<T>>, friction: &Friction) -> T {
        let applied = self.position.loads(self.model, geometry);
        let mut sum = load.function.derivative(friction, &applied, &self.transmitted);
        for &b in &self.forced {
            sum += self.required[b].derivative().on(load.virtual_twists[b]);
        }
        for (n, k) in load.multipliers.iter().enumerate() {
            sum = self.residuals[n].times_plus(*k, sum);
        }
        sum
    }

    /// Computes the derivatives of all loads by a variable whose sensitivities have been solved; calls `each` with the
    /// number of the load and its derivative.
    pub fn differentiate(
        &mut self,
        at: &Equilibrium<'_, T>,
        by: &Differentiated<'_, T>,
        mut each: impl FnMut(usize, T),
    ) {
        let Differentiated { variable, topology, state, field, flow } = by;
        for (b, body) in at.position.bodies.iter().enumerate().skip(1) {
            self.position.bodies[b] = body.along(of_body(&flow.twists, b));
        }
        for (d, speed) in self.transmitted.speeds.iter_mut().enumerate() {
            speed.d = field.law_rate(DriverId(d), 1);
        }
        self.require_of(&at.friction, variable.0);
        // y' = sum (P2 . W.. + P1 . W. + P0 . W) + turning of frames + sum F' . Y of force elements + dy/db     (48)
        self.sums.fill(T::zero());
        let loads = self.loads.iter().map(|load| (&load.by_twists[..], &load.turning));
        field.add_work((topology, state), flow, loads, &mut self.sums);
        for (n, load) in self.loads.iter().enumerate() {
            let geometry = &self.changed[variable.0].geometry;
            each(n, self.sums[n] + self.partial(load, geometry, &at.friction));
        }
    }

    /// Derivatives of deflections by the variable that was differentiated last, in the order of these directions.
    pub fn deflections<'s>(
        &'s self,
        variable: VariableId,
        directions: &'s [(ElementId, usize)],
    ) -> impl Iterator<Item = T> + 's {
        let applied = self.position.loads(self.model, &self.changed[variable.0].geometry);
        // The directions of an element follow each other.
        directions.chunk_by(|a, b| a.0 == b.0).flat_map(move |of_element| {
            let opening = applied.opening_at(of_element[0].0);
            let of = move |(_, k): &(_, usize)| match &opening {
                Some(opening) => opening.coordinates[*k].d,
                None => T::constant(f64::NAN),
            };
            of_element.iter().map(of)
        })
    }
}

/// Derivatives of the friction equations along the direction of these loads.
fn set_residuals<T: Real>(
    to: &mut [T],
    friction: &Friction,
    applied: &AppliedLoads<'_, Dual<T>>,
    transmitted: &TransmittedLoads<Dual<T>>,
) {
    to.iter_mut().enumerate().for_each(|(k, to)| *to = friction.residual(k, applied, transmitted).d);
}

/// Sum of the sizes of the components of a vector.
fn sum_of_sizes<T: Real>(v: Vec3<T>) -> f64 {
    v.x.value().abs() + v.y.value().abs() + v.z.value().abs()
}

/// Per body: the forces that act on it.
pub(super) fn forces_on_bodies(model: &Model) -> Vec<Vec<ElementId>> {
    let mut forces_on = vec![Vec::new(); model.bodies.len()];
    for (e, element) in model.elements.iter().enumerate() {
        let Some(force) = element.kind.force(model) else { continue };
        let [i, j] = force.acts_on.bodies(model);
        forces_on[i.0].push(ElementId(e));
        if i != j {
            forces_on[j.0].push(ElementId(e));
        }
    }
    forces_on
}

/// Per body: the bodies on which the forces on it act, itself included, without ground.
fn bodies_beside(model: &Model) -> Vec<Vec<usize>> {
    let mut beside: Vec<Vec<usize>> = (0..model.bodies.len()).map(|b| vec![b]).collect();
    for force in model.elements.iter().filter_map(|e| e.kind.force(model)) {
        let [i, j] = number::both(force.acts_on.bodies(model), |b| b.0);
        for (of, other) in [(i, j), (j, i)] {
            if other != GROUND.0 && !beside[of].contains(&other) {
                beside[of].push(other);
            }
        }
    }
    beside
}

/// Per body: true if it has masses.
fn bodies_with_masses(model: &Model) -> Vec<bool> {
    let mut has_mass = vec![false; model.bodies.len()];
    let masses = model.elements.iter().filter_map(|e| e.kind.mass_on(model));
    masses.for_each(|body| has_mass[body.0] = true);
    has_mass
}

/// Bodies with forces, or with masses that a variable changes.
fn forced_bodies<T>(model: &Model, changed: &[ChangedGeometry<T>]) -> Vec<usize> {
    let forces = model.elements.iter().filter_map(|e| e.kind.force(model));
    let masses = changed.iter().flat_map(|c| &c.masses);
    let masses = masses.filter_map(|e| model.elements[e.0].kind.mass_on(model));
    let all = forces.flat_map(|force| force.acts_on.bodies(model)).chain(masses);
    let mut bodies: Vec<usize> = all.map(|b| b.0).collect();
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}
