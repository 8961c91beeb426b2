//! Map from design variables to geometry, and its derivative by each variable.
//!
//! The geometry is written once, over any [`Real`]; its derivatives at any design are the same lines evaluated with
//! [`Dual`] numbers.
//!
//! Implements section 3 of the paper, with tau the value of one variable, and `s_o`, `theta_o` of the nominal design:
//!
//! | here | paper | what |
//! |---|---|---|
//! | [`PlacedDesign::place`] | | hardpoint `P = P_o + sum_k v_k b_k`, m, global |
//! | [`PlacedDesign::marker`] | s, C of (3.1), (2.2) | marker in its body, `X_body^-1 X_marker` |
//! | `position`, `v` of a change | `V_Omega` (3.2) | location design velocity, m per unit |
//! | `rotation` of a change | `d(xi)/dtau = R U` (3.10) | orientation design velocity (rotation vector), rad per unit |
//! | `u` of a change | `U_theta` (3.3) | the same as rates of the 3-1-3 Euler angles, rad per unit |
//! | [`DesignMap::field_along`] | `dD/dtau` (5.5) | `d/db` of all of it, by duals `b + eps` |

use crate::constraint::{MarkerPair, Row};
use crate::design::{BodyFixed, DesignVelocity, Geometry, JointConstants, MarkerVelocity, ShapeGeometry};
use crate::law::Law;
use crate::model::element::ActsOn;
use crate::model::{
    BodyId, Change, Contact, DesignVariable, Direction, Driver, DriverId, ElementId, HardpointId, Joint,
    JointId, Length, Measure, Model, NumberId, PointId, Shape, ShapeKind, SharedModel, Source, Target,
    VariableId,
};
use crate::number::{self, Dual, Real};
use crate::space::{Mat3, Pose, Twist, Vec3};

use super::change::Effect;
use super::formulas::Formulas;
use super::geometry;

/// Entries of a model that its variables change, grouped by kind; collected once for many designs.
#[derive(Clone, Debug)]
pub struct DesignMap<'m> {
    held: SharedModel<'m>,
    /// Per hardpoint: variables that move it, and its velocity by each, m per unit.
    moves: Vec<Vec<(usize, Vec3)>>,
    /// Per joint: variables that change the joint itself, with the index of the change.
    changes: Vec<Vec<(usize, usize)>>,
    /// Per hardpoint: joints and points that depend on it.
    joints: Vec<Vec<usize>>,
    points: Vec<Vec<usize>>,
    /// Formulas of the model; `None` if there are none.
    formulas: Option<Formulas>,
}

impl<'m> DesignMap<'m> {
    /// Collects the entries of a model.
    pub fn of(held: impl Into<SharedModel<'m>>) -> Self {
        let held = held.into();
        let model: &Model = &held;
        let hardpoints = model.hardpoints.len();
        let mut moves = vec![Vec::new(); hardpoints];
        let mut changes = vec![Vec::new(); model.joints.len()];
        let mut joints = vec![Vec::new(); hardpoints];
        let mut points = vec![Vec::new(); hardpoints];
        for (k, variable) in model.variables.iter().enumerate() {
            for (c, change) in variable.changes.iter().enumerate() {
                if let Some((hardpoint, velocity)) = change.hardpoint() {
                    // dP/db = V, constant: P = P_o + V b at any b
                    moves[hardpoint.0].push((k, velocity));
                }
                if let Some(joint) = change.joint() {
                    changes[joint.0].push((k, c));
                }
            }
        }
        for (j, joint) in model.joints.iter().enumerate() {
            joint.hardpoints().for_each(|h| joints[h.0].push(j));
        }
        for (k, point) in model.points.iter().enumerate() {
            points[point.at.0].push(k);
        }
        Self { formulas: Formulas::of(model), moves, changes, joints, points, held }
    }

    /// Returns the model.
    pub fn model(&self) -> &Model {
        &self.held
    }

    /// True if a variable changes the law of a driver.
    pub fn laws_change(&self) -> bool {
        self.model().variables.iter().flat_map(|v| &v.changes).any(|c| c.law().is_some())
            || self.model().formulas.iter().any(|f| matches!(f.of, Target::Law(..)))
    }

    /// Returns the geometry of designs, given by the values of all variables.
    pub fn geometry<T: Real>(&self, values: &[T]) -> Geometry<T> {
        self.placed_geometry(&PlacedDesign::new(self, values.to_vec()))
    }

    /// Returns the geometry of designs for known feet of followers on the curves of joints, and the followers, each in
    /// the frame of its curve.
    pub(crate) fn geometry_on<T: Real>(&self, values: &[T], feet: Feet<T>) -> (Geometry<T>, Vec<Vec3<T>>) {
        let design = PlacedDesign::on_feet(self, values.to_vec(), feet);
        let followers = design.feet.iter().map(|(joint, _)| design.follower(joint.0)).collect();
        (self.placed_geometry(&design), followers)
    }

    /// Returns the point that follows the curve of a joint, in the frame of the curve, for these values of the
    /// variables; `None` unless their distance results from its position.
    pub(crate) fn follower<T: Real>(&self, joint: JointId, values: &[T]) -> Option<Vec3<T>> {
        let Joint { curve, length, .. } = &self.model().joints[joint.0];
        let is_measured = curve.is_some() && length.is_none();
        is_measured.then(|| PlacedDesign::new(self, values.to_vec()).follower(joint.0))
    }

    fn placed_geometry<T: Real>(&self, design: &PlacedDesign<'_, T>) -> Geometry<T> {
        let model = self.model();
        Geometry {
            markers: (0..model.joints.len()).map(|j| number::both([0, 1], |e| design.marker(j, e))).collect(),
            kept: (0..model.joints.len()).map(|j| design.kept(j)).collect(),
            points: (0..model.points.len()).map(|k| design.point(k)).collect(),
            spin_axes: model.wheels.iter().map(|w| design.in_body(w.body, w.spin_axis)).collect(),
            axes: (0..model.elements.len()).map(|e| design.axes(ElementId(e))).collect(),
            numbers: (0..model.numbers.len()).map(|k| design.number(k)).collect(),
            size: model.size(),
        }
    }

    /// Index of the first formula that has no finite value for these values of the variables; laws are evaluated over
    /// time.
    pub fn undefined_formula(&self, values: &[f64]) -> Option<usize> {
        self.formulas.as_ref()?;
        let design = PlacedDesign::new(self, values.to_vec());
        let is_law = |k: usize| matches!(self.model().formulas[k].of, Target::Law(..));
        let results = [&design.values.formulas, &design.for_lengths.formulas];
        let mut all = results.into_iter().flat_map(|of| of.iter().enumerate());
        all.find(|(k, value)| !value.is_finite() && !is_law(*k)).map(|(k, _)| k)
    }

    /// Returns the global positions of the hardpoints for these values of the variables, m.
    pub fn places<T: Real>(&self, values: &[T]) -> Vec<Vec3<T>> {
        let design = PlacedDesign::new(self, values.to_vec());
        (0..self.model().hardpoints.len()).map(|h| design.place(HardpointId(h), &design.values)).collect()
    }

    /// Returns the body-fixed data of the measures for these values of the variables.
    pub(crate) fn fixed<T: Real>(&self, values: &[T]) -> BodyFixed<T> {
        let (model, design) = (self.model(), PlacedDesign::new(self, values.to_vec()));
        let markers = |m: &Measure| {
            if let Some((force, _)) = m.kind.elastic() {
                return design.elastic_markers(force.0);
            }
            let joint = m.kind.joint_value()?;
            Some(number::both([0, 1], |e| design.marker(joint.0, e)))
        };
        BodyFixed {
            points: (0..model.points.len()).map(|k| design.point(k)).collect(),
            directions: model.measures.iter().map(|m| design.directions(m)).collect(),
            markers: model.measures.iter().map(markers).collect(),
            shapes: model.shapes.iter().map(|shape| design.shape(shape)).collect(),
            size: model.size(),
        }
    }

    /// Returns the design velocity of one variable at these values.
    pub fn field<T: Real>(&self, variable: VariableId, values: &[T]) -> DesignVelocity<T> {
        self.field_along(&[(variable, 1.0)], values)
    }

    /// Returns the design velocity along a direction in the space of several variables, at these values.
    ///
    /// Paper Eqs. 3.1 to 3.10 and 5.5; `docs/theory.md` (8).
    pub fn field_along<T: Real>(&self, along: &[(VariableId, f64)], values: &[T]) -> DesignVelocity<T> {
        let mut duals: Vec<Dual<T>> = values.iter().map(|v| Dual::constant(*v)).collect();
        for &(variable, rate) in along {
            // b_k + eps rate_k: the coefficient of eps of any result is its derivative along the direction
            duals[variable.0].d = T::constant(rate);
        }
        let design = PlacedDesign::new(self, duals);
        let affected = self.affected(along);
        let mut field =
            DesignVelocity { laws: self.law_rates(&affected, &design), ..DesignVelocity::default() };
        for j in affected.joints {
            for end in 0..2 {
                // e = [R U; V - (R U) x s], the twist of the marker's pose in its body                              (8)
                let (_, twist) = design.marker(j, end).split();
                if !is_null(twist.w) || !is_null(twist.v) {
                    field.markers.push(MarkerVelocity { joint: JointId(j), end, twist });
                }
            }
            // L'
            let rates = design.kept(j).map(|x| x.d);
            if !rates.vanishes() {
                field.kept.push((JointId(j), rates));
            }
        }
        let moved = affected.points.into_iter().map(|k| (PointId(k), design.point(k).map(|x| x.d)));
        field.points = moved.filter(|(_, v)| !is_null(*v)).collect();
        field
    }

    /// Returns the design velocity of a twist of marker i of a joint, given along the joint's own axes, for these
    /// values.
    pub fn opening<T: Real>(&self, joint: JointId, twist: Twist, values: &[T]) -> DesignVelocity<T> {
        let design = PlacedDesign::new(self, values.to_vec());
        // e = Ad(M) of it
        let twist = design.marker(joint.0, 0).carry(twist.spread());
        DesignVelocity { markers: vec![MarkerVelocity { joint, end: 0, twist }], ..DesignVelocity::default() }
    }

    /// Returns the entries that may change along a direction in the space of several variables.
    pub(super) fn affected(&self, along: &[(VariableId, f64)]) -> Affected {
        let mut affected = Affected::default();
        for (variable, by) in along {
            for change in &self.model().variables[variable.0].changes {
                affected.hardpoints.extend(change.hardpoint().map(|(h, _)| h.0));
                affected.joints.extend(change.joint().map(|j| j.0));
                // dp/db times the rate of b
                affected
                    .laws
                    .extend(change.law().map(|(driver, parameter, rate)| (driver, parameter, by * rate)));
            }
            // entries that change through formulas, directly or through others
            let following = self.formulas.as_ref().map(|f| f.following(self.model(), *variable));
            for k in following.unwrap_or_default() {
                match self.model().formulas[k].of {
                    Target::Parameter(_) => {}
                    Target::Coordinate(h, _) => affected.hardpoints.push(h.0),
                    Target::Length(j) => affected.joints.push(j.0),
                    Target::Law(..) => affected.law_formulas.push(k),
                    Target::Number(n) => affected.numbers.push(n),
                }
            }
        }
        for &h in &affected.hardpoints {
            affected.joints.extend(&self.joints[h]);
            affected.points.extend(&self.points[h]);
        }
        for list in [&mut affected.joints, &mut affected.points, &mut affected.law_formulas] {
            list.sort_unstable();
            list.dedup();
        }
        affected
    }

    /// Returns the parameters of laws that change, and their rates.
    fn law_rates<T: Real>(
        &self,
        affected: &Affected,
        design: &PlacedDesign<'_, Dual<T>>,
    ) -> Vec<(DriverId, usize, T)> {
        let mut rates: Vec<_> =
            affected.laws.iter().map(|(d, p, rate)| (*d, *p, T::constant(*rate))).collect();
        for &k in &affected.law_formulas {
            if let Target::Law(driver, parameter) = self.model().formulas[k].of {
                // dp/db of a parameter of a law that a formula defines
                let rate = design.values.formulas[k].d;
                match rates.iter_mut().find(|r| (r.0, r.1) == (driver, parameter)) {
                    Some(known) => known.2 += rate,
                    None => rates.push((driver, parameter, rate)),
                }
            }
        }
        rates
    }

    /// Returns the laws of the driven coordinates in the design with these values.
    pub fn laws(&self, values: &[f64]) -> Vec<Law> {
        let model = self.model();
        let mut laws: Vec<Law> = model.drivers.iter().map(Driver::coordinate_law).collect();
        if model.formulas.iter().any(|f| matches!(f.of, Target::Law(..))) {
            let results = PlacedDesign::new(self, values.to_vec()).values.formulas;
            // Without results, no formula depends on a variable that is not 0.
            for (formula, result) in model.formulas.iter().zip(results) {
                if let Target::Law(driver, parameter) = formula.of {
                    laws[driver.0] = laws[driver.0].with_parameter(parameter, result);
                }
            }
        }
        for (variable, value) in model.variables.iter().zip(values).filter(|(_, value)| **value != 0.0) {
            for change in &variable.changes {
                if let Some((driver, parameter, rate)) = change.law() {
                    let law = &mut laws[driver.0];
                    let now = law.parameters()[parameter].value;
                    // p = p_o + (dp/db) b
                    *law = law.with_parameter(parameter, now + rate * value);
                }
            }
        }
        laws
    }

    /// Returns the design velocities of all variables at these values.
    pub fn fields<T: Real>(&self, values: &[T]) -> Vec<DesignVelocity<T>> {
        (0..values.len()).map(|k| self.field(VariableId(k), values)).collect()
    }
}

fn is_null<T: Real>(v: Vec3<T>) -> bool {
    v.x.vanishes() && v.y.vanishes() && v.z.vanishes()
}

/// Entries that may change along a direction: hardpoints, joints, points, parameters of laws with their rates, their
/// formulas, numbers of masses and forces.
#[derive(Default)]
pub(super) struct Affected {
    pub hardpoints: Vec<usize>,
    pub joints: Vec<usize>,
    pub points: Vec<usize>,
    pub laws: Vec<(DriverId, usize, f64)>,
    pub law_formulas: Vec<usize>,
    pub numbers: Vec<NumberId>,
}

/// Positions and directions of all entries for values of the variables.
struct PlacedDesign<'e, T> {
    design_map: &'e DesignMap<'e>,
    values: Values<T>,
    /// Values with 0 for variables that do not change the lengths of rods; lengths are computed with these.
    for_lengths: Values<T>,
    /// Per variable: true if it has an effect.
    counts: Vec<bool>,
    feet: Feet<T>,
}

/// Known feet of followers on the curves of joints.
type Feet<T> = Vec<(JointId, Contact<T>)>;

/// Values of the variables, and the results of formulas; no results if no formula depends on an active variable.
#[derive(Clone)]
struct Values<T> {
    variables: Vec<T>,
    formulas: Vec<T>,
}

impl<'e, T: Real> PlacedDesign<'e, T> {
    /// Omits variables at 0, unless they are differentiated.
    fn new(design_map: &'e DesignMap<'_>, values: Vec<T>) -> Self {
        Self::on_feet(design_map, values, Vec::new())
    }

    /// The same for known feet; those of other followers are found by iterations.
    fn on_feet(design_map: &'e DesignMap<'_>, values: Vec<T>, feet: Feet<T>) -> Self {
        let variables = &design_map.model().variables;
        let counts = values.iter().map(|v| !v.vanishes()).collect();
        // With b = 0 for the variables of fixed length, L = abs(d) does not depend on them: L' = 0, and the mechanism
        // re-assembles.
        let follows = |(value, v): (&T, &DesignVariable)| if v.fixed_length { T::zero() } else { *value };
        let for_lengths = values.iter().zip(variables).map(follows).collect();
        let plain = |variables| Values { variables, formulas: Vec::new() };
        let (values, for_lengths) = (plain(values), plain(for_lengths));
        let mut design = Self { design_map, values, for_lengths, counts, feet };
        if let Some(f) = &design_map.formulas
            && f.is_used.iter().zip(&design.counts).any(|(is_used, counts)| *is_used && *counts)
        {
            design.values.formulas = design.evaluate_formulas(f, &design.values.variables);
            design.for_lengths.formulas = match variables.iter().any(|v| v.fixed_length) {
                true => design.evaluate_formulas(f, &design.for_lengths.variables),
                false => design.values.formulas.clone(),
            };
            design.evaluate_over_constants();
        }
        design
    }

    /// Sets the results of formulas over joint constants, which depend on all other results.
    fn evaluate_over_constants(&mut self) {
        let model = self.design_map.model();
        for (k, formula) in model.formulas.iter().enumerate() {
            if formula.sources().any(|s| matches!(s, Source::Kept(..))) {
                self.values.formulas[k] = formula.at(|source| match source {
                    Source::Kept(j, coordinate) => {
                        self.kept(j.0).by(model.joints[j.0].kind.coordinates[coordinate].row)
                    }
                    Source::Parameter(_) | Source::Coordinate(..) => T::constant(model.nominal(source)),
                });
            }
        }
    }

    /// Returns the results of all formulas, in order.
    fn evaluate_formulas(&self, formulas: &Formulas, variables: &[T]) -> Vec<T> {
        let model = self.design_map.model();
        let mut results: Vec<T> = Vec::with_capacity(model.formulas.len());
        for formula in &model.formulas {
            let result = formula.at(|source| {
                let (given, rates) = match source {
                    Source::Parameter(p) => {
                        (formulas.of_parameter[p.0], self.rates(&formulas.rates[p.0], |r| *r))
                    }
                    Source::Coordinate(h, axis) => (
                        formulas.of_hardpoint[h.0][axis],
                        self.rates(&self.design_map.moves[h.0], move |v| v[axis]),
                    ),
                    // Set by `evaluate_over_constants` once all others are known.
                    Source::Kept(..) => (None, Vec::new()),
                };
                let given = given.map_or_else(|| T::constant(model.nominal(source)), |k| results[k]);
                rates
                    .into_iter()
                    // input of the formula = given value + sum_k rate_k b_k
                    .fold(given, |sum, (k, rate)| T::constant(rate).times_plus(variables[k], sum))
            });
            results.push(result);
        }
        results
    }

    /// Returns the variables of a list that have an effect, with their rates.
    fn rates<R>(&self, list: &[(usize, R)], rate: impl Fn(&R) -> f64) -> Vec<(usize, f64)> {
        list.iter().filter(|(k, _)| self.counts[*k]).map(|(k, r)| (*k, rate(r))).collect()
    }

    /// Returns the global position of a hardpoint, m.
    fn place(&self, h: HardpointId, values: &Values<T>) -> Vec3<T> {
        let mut place = self.design_map.model().position(h).spread();
        if let (Some(f), false) = (&self.design_map.formulas, values.formulas.is_empty()) {
            // P_o, or per component the result of its formula
            let given = |axis: usize| f.of_hardpoint[h.0][axis].map_or(place[axis], |k| values.formulas[k]);
            place = Vec3::new(given(0), given(1), given(2));
        }
        for &(k, velocity) in self.design_map.moves[h.0].iter().filter(|(k, _)| self.counts[*k]) {
            // P = P_o + sum_k v_k b_k, with P_o from formulas if defined by them
            place = velocity.spread().times_plus(values.variables[k], place);
        }
        place
    }

    /// Returns the global unit vector of a direction.
    fn direction(&self, d: Direction, values: &Values<T>) -> Vec3<T> {
        match d {
            Direction::Along(u) => u.spread(),
            Direction::Through(a, b) => {
                // h = (P_b - P_a) / abs(P_b - P_a):  h' = ((V_b - V_a) - h h . (V_b - V_a)) / abs(P_b - P_a)
                let d = self.place(b, values) - self.place(a, values);
                d * (T::one() / d.norm())
            }
        }
    }

    /// Returns the frame of a body, which does not depend on the design.
    fn frame(&self, body: BodyId) -> Pose<T> {
        self.design_map.model().bodies[body.0].frame.spread()
    }

    /// Returns marker e of joint j in its body's frame.
    fn marker(&self, j: usize, e: usize) -> Pose<T> {
        let body = self.design_map.model().joints[j].bodies[e];
        // (s, C) = X_body^-1 X_marker; the body's frame is fixed (paper, section 2).
        self.frame(body).inverse().compose(self.global_marker(j, e, &self.values))
    }

    /// Returns marker e of joint j in the design configuration, global.
    fn global_marker(&self, j: usize, e: usize, values: &Values<T>) -> Pose<T> {
        let model = self.design_map.model();
        let joint = &model.joints[j];
        // From its hardpoint and axes, then the changes of this joint alone (paper 3.1, 3.4; `design/change.rs`).
        let mut drawn =
            Pose { rot: self.followed_frame(joint, e, values), r: self.place(joint.at[e], values) };
        // C = exp(b R U) C_o in global axes, with the sum of b R U of all variables                         (paper 3.4)
        let turns = || {
            let turns = self.changes_of(j).map(|(k, change)| (k, change.rotation(e)));
            turns.filter_map(|(k, by)| Some((values.variables[k], by.unit()?, by.norm())))
        };
        let mut all = turns();
        if let Some((b, axis, rate)) = all.next() {
            let is_alone = all.next().is_none();
            let sum = |sum, (b, axis, rate): (T, Vec3, f64)| (axis * rate).spread().times_plus(b, sum);
            let turn = match is_alone {
                true => Mat3::about(axis, b * T::constant(rate)),
                false => Mat3::about_vector(turns().fold(Vec3::zero(), sum)),
            };
            drawn.rot = turn * drawn.rot;
        }
        self.changes_of(j)
            .fold(drawn, |marker, (k, change)| change.marker(model, marker, e, values.variables[k]))
    }

    /// Returns the changes of joint j itself by active variables, with their values.
    fn changes_of(&self, j: usize) -> impl Iterator<Item = (usize, &'e Change)> {
        let of = move |&(k, c): &(usize, usize)| (k, &self.design_map.model().variables[k].changes[c]);
        self.design_map.changes[j].iter().filter(|(k, _)| self.counts[*k]).map(of)
    }

    /// Returns the frame of marker e of a joint whose axes pass through hardpoints.
    ///
    /// The smallest rotation takes z to its new direction; then x rotates about z to the part of `axis2` that is
    /// perpendicular to z, as of a file with the new hardpoints. Of two shafts that rotate equally, marker j is marker
    /// i after the smallest rotation of one shaft onto the other.
    fn followed_frame(&self, joint: &Joint, e: usize, values: &Values<T>) -> Mat3<T> {
        let own = |e: usize| self.followed(joint.frames[e].spread(), joint.axes_of_marker(e), values);
        let axes = [joint.axis, joint.axis2];
        let follows = axes.iter().any(|axis| matches!(axis, Some(Direction::Through(..))));
        if e == 1 && follows && joint.kind.rows.contains(&Row::ConstantVelocity) {
            let [m_i, m_j] = number::both([0, 1], own);
            return Mat3::between(m_i.cols[2], m_j.cols[2]) * m_i;
        }
        own(e)
    }

    /// Returns axes that have this direction in the nominal design, and whose z and x axes follow these directions.
    fn followed(
        &self,
        mut rot: Mat3<T>,
        [axis, axis2]: [Option<Direction>; 2],
        values: &Values<T>,
    ) -> Mat3<T> {
        if let Some(axis @ Direction::Through(..)) = axis {
            // The rotation about z x h takes z to h; to first order it is h x h'.
            rot = Mat3::between(rot.cols[2], self.direction(axis, values)) * rot;
        }
        let follows = |of: Option<Direction>| matches!(of, Some(Direction::Through(..)));
        if let Some(axis2) = axis2.filter(|_| follows(axis) || follows(axis2)) {
            let (d, z) = (self.direction(axis2, values), rot.cols[2]);
            // x = (d - z z . d) / abs(..),  y = z x x
            let across = d - z * z.dot(d);
            let length = across.norm();
            if length.decisive() > ALONG {
                let x = across * (T::one() / length);
                rot = Mat3 { cols: [x, z.cross(x), z] };
            }
        }
        rot
    }

    /// Returns the point that follows the curve of joint j, in the frame of the curve.
    fn follower(&self, j: usize) -> Vec3<T> {
        let [m_i, m_j] = number::both([0, 1], |e| self.global_marker(j, e, &self.for_lengths));
        m_i.rot.transpose_mul(m_j.r - m_i.r)
    }

    /// Returns the constants of joint j.
    fn kept(&self, j: usize) -> JointConstants<T> {
        let (joint, zero) = (&self.design_map.model().joints[j], T::zero());
        let [m_i, m_j] = number::both([0, 1], |e| self.global_marker(j, e, &self.for_lengths));
        // d = P_j - P_i of the design; the constants of a joint are functions of it: L = abs(d), z_i . d, z_i . z_j,
        // the distance from a curve.
        let (d, z_i, z_j) = (m_j.r - m_i.r, m_i.rot.cols[2], m_j.rot.cols[2]);
        let given = joint.length.map(|length| {
            let formula = self.design_map.formulas.as_ref().and_then(|f| f.of_length[j]);
            let given = formula.and_then(|k| self.values.formulas.get(k)).copied();
            let given = given.unwrap_or_else(|| T::constant(length));
            self.changes_of(j)
                .fold(given, |length, (k, change)| change.length(length, self.values.variables[k]))
        });
        // Coincident markers have no constant distance; it would have no derivative.
        let keeps = joint.kind.is_rod() && d.dot(d).decisive() > 0.0;
        let distance = given.unwrap_or_else(|| if keeps { d.norm() } else { zero });
        let contact = joint.curve.as_ref().map_or(zero, |curve| {
            // The side of the curve on which the point is remains the same; a given distance has no sign.
            let side = || {
                let [m_i, m_j] = [0, 1].map(|e| self.design_map.model().marker(JointId(j), e));
                curve.distance(m_i.rot.transpose_mul(m_j.r - m_i.r)).signum()
            };
            let drawn = || {
                let (p, foot) = (m_i.rot.transpose_mul(d), self.feet.iter().find(|(joint, _)| joint.0 == j));
                foot.map_or_else(|| curve.distance(p), |(_, foot)| foot.distance(p))
            };
            given.map_or_else(drawn, |length| length.abs() * T::constant(side()))
        });
        // Parallel axes have no angle about z_i; it would have no derivative.
        let has_course = joint.kind.coordinates.iter().any(|c| c.row == Row::Course);
        let [x_i, y_i] = number::both([0, 1], |k| m_i.rot.cols[k]);
        let course = if has_course { y_i.dot(z_j).atan2(x_i.dot(z_j)) } else { zero };
        let lowest = joint.kind.coordinates.iter().find(|c| matches!(c.row, Row::LowestPoint(_)));
        let height = lowest.map_or(zero, |c| {
            let axes = Mat3::IDENTITY.spread();
            c.row.residual(&MarkerPair { i: m_i, j: m_j, axes }, zero)
        });
        JointConstants { distance, offset: z_i.dot(d), cosine: z_i.dot(z_j), course, contact, height }
    }

    /// Returns the axes of a force in the frames of its bodies, if it has axes of its own.
    fn axes(&self, e: ElementId) -> Option<[Mat3<T>; 2]> {
        let model = self.design_map.model();
        let (bodies, nominal, axes) = model.axes_of(e)?;
        let rot = self.followed(nominal.spread(), axes, &self.values);
        Some(number::both(bodies, |body| self.frame(body).rot.transpose() * rot))
    }

    /// Returns the markers between which an elastic joint or bushing deflects; those of a bushing without axes have the
    /// global ones in the design configuration.
    fn elastic_markers(&self, e: ElementId) -> Option<[Pose<T>; 2]> {
        let model = self.design_map.model();
        match model.elements[e.0].kind.force(model)?.acts_on {
            ActsOn::Joint(joint) => {
                let markers = number::both([0, 1], |end| self.marker(joint.0, end));
                Some(geometry::elastic_markers(model, joint, markers))
            }
            ActsOn::Points(points) => {
                let axes = self.axes(e);
                Some(number::both([0, 1], |end| {
                    let point = points[end].0;
                    let frame = self.frame(model.points[point].body);
                    let rot = axes.map_or_else(|| frame.rot.transpose(), |axes| axes[end]);
                    Pose { rot, r: self.point(point) }
                }))
            }
            ActsOn::Line(_)
            | ActsOn::Point(_)
            | ActsOn::Wheel(_)
            | ActsOn::Body(_)
            | ActsOn::Coordinate(..) => None,
        }
    }

    /// Returns a number of a mass or force, SI.
    fn number(&self, k: usize) -> T {
        let formula = self.design_map.formulas.as_ref().and_then(|f| f.of_number[k]);
        let given = formula.and_then(|formula| self.values.formulas.get(formula)).copied();
        given.unwrap_or_else(|| T::constant(self.design_map.model().numbers[k].value))
    }

    /// Returns a point in its body's frame, m.
    fn point(&self, k: usize) -> Vec3<T> {
        let point = &self.design_map.model().points[k];
        self.frame(point.body).inverse().point(self.place(point.at, &self.values))
    }

    /// Returns the numbers of a shape that no point gives.
    fn shape(&self, shape: &Shape) -> ShapeGeometry<T> {
        let number = |n: Option<Length>| n.map_or(T::zero(), |n| self.number(n.0.0));
        let size = match shape.kind {
            ShapeKind::Ring { radius: size, .. }
            | ShapeKind::Cylinder { radius: size, .. }
            | ShapeKind::Tyre { width: size, .. } => Some(size),
            ShapeKind::Sphere { .. }
            | ShapeKind::Capsule { .. }
            | ShapeKind::Plane { .. }
            | ShapeKind::Hull { .. }
            | ShapeKind::Mesh { .. } => None,
        };
        let axis = shape.axis(self.design_map.model()).map(|(body, axis)| self.in_body(body, axis));
        ShapeGeometry { axis, size: number(size), round: number(shape.round) }
    }

    /// Returns the directions that a measure depends on, in their bodies' frames.
    fn directions(&self, measure: &Measure) -> [Option<Vec3<T>>; 2] {
        let in_body = |(body, axis)| self.in_body(body, axis);
        number::both(self.design_map.model().directions(measure), |d| d.map(in_body))
    }

    /// Returns a direction in a body's frame: `A^T h`.
    fn in_body(&self, body: BodyId, axis: Direction) -> Vec3<T> {
        self.frame(body).rot.transpose_mul(self.direction(axis, &self.values))
    }
}

/// Minimum angle of the second axis to the first, rad, for it to define the x axis.
const ALONG: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::*;
    use crate::expression::Expression;
    use crate::joint::Quantity;

    #[test]
    fn formulas_have_exact_second_derivatives_on_duals_of_duals() {
        let z = Vec3::AXES[2];
        let parameters = [("length", 0.3, Quantity::Length), ("angle", 0.8, Quantity::Angle)];
        let texts = ["length*cos(angle)", "length*sin(angle)"].map(|text| Expression::parse(text).unwrap());
        let formulas = (0..).zip(texts).map(|(axis, expression)| FormulaDraft {
            of: FormulaOf::Coordinate("B".into(), axis),
            expression,
        });
        let draft = Draft {
            parameters: parameters
                .map(|(name, value, quantity)| ParameterDraft { name: name.into(), value, quantity })
                .into(),
            formulas: formulas.collect(),
            ..Draft::new("two arms and a rod")
        };
        let draft = draft
            .hardpoint("A", [0.0; 3])
            .hardpoint("B", [0.0; 3])
            .hardpoint("C", [0.5, 0.0, 0.0])
            .bodies(["i", "j"])
            .revolute("a", ["ground", "i"], "A", z)
            .revolute("c", ["ground", "j"], "C", z)
            .distance("rod", ["i", "j"], ["B", "C"])
            .variable(VariableDraft::new(
                "angle",
                [ChangeDraft::Parameter { parameter: "angle".into(), rate: 1.0 }],
            ))
            .times([0.0]);
        let model = Model::from_draft(&draft).unwrap();
        let design_map = DesignMap::of(&model);
        for b in [0.0, 0.4] {
            let value = Dual { v: Dual::variable(b), d: Dual::constant(1.0) };
            let rod = design_map.geometry(&[value]);
            let place = rod.markers[2][0].r;
            let (s, c) = (0.8_f64 + b).sin_cos();
            for (found, expected) in [
                (place.x.d.v, -0.3 * s),
                (place.y.d.v, 0.3 * c),
                (place.x.d.d, -0.3 * c),
                (place.y.d.d, -0.3 * s),
            ] {
                assert!((found - expected).abs() < 1e-15, "{found} {expected}");
            }
            // l² = 0.34 - 0.3 cos, l l' = 0.15 sin, l l'' + l'² = 0.15 cos
            let l = rod.kept[2].distance;
            let length = (0.34 - 0.3 * c).sqrt();
            let slope = 0.15 * s / length;
            assert!((l.v.v - length).abs() < 1e-15 && (l.d.v - slope).abs() < 1e-14);
            assert!((l.d.d - (0.15 * c - slope * slope) / length).abs() < 1e-14);
        }
    }
}
