//! What design variables do: the geometry of any design, and its derivative by each variable.
//!
//! The geometry is written once, over any [`Real`]; its derivatives are the same lines run on [`Dual`]s, at whatever design.

use super::*;
use crate::constraint::Row;
use crate::joint::Need;
use crate::law::Law;
use crate::number::{Dual, Real};
use crate::space::{euler_313_from_rotation, rotation_from_euler_313};

/// The body-fixed data of one design: all that the analysis needs of it besides the drivers' laws.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry<T = f64> {
    /// Per joint, marker i in body i and marker j in body j.
    pub markers: Vec<[Pose<T>; 2]>,
    /// Per joint, what its constraints may keep of the design configuration.
    pub kept: Vec<Kept<T>>,
    /// Per point of the model, its position in its body's frame, m.
    pub points: Vec<Vec3<T>>,
}

/// What measures go by, fixed in the bodies.
#[derive(Clone, Debug)]
pub(crate) struct Fixed<T> {
    /// Per point of the model, its position in its body's frame, m.
    pub points: Vec<Vec3<T>>,
    /// Per measure, the directions that it goes by: unit vectors in their bodies' frames.
    pub directions: Vec<[Option<Vec3<T>>; 2]>,
    /// Per measure of a joint's coordinate, marker i in body i and marker j in body j.
    pub markers: Vec<Option<[Pose<T>; 2]>>,
}

impl<T: Copy> Fixed<T> {
    /// The same, number by number.
    pub fn map<U>(&self, f: impl Fn(T) -> U + Copy) -> Fixed<U> {
        let pose = |p: Pose<T>| Pose { rot: Mat3 { cols: p.rot.cols.map(|c| c.map(f)) }, r: p.r.map(f) };
        Fixed {
            points: self.points.iter().map(|p| p.map(f)).collect(),
            directions: self.directions.iter().map(|d| d.map(|d| d.map(|d| d.map(f)))).collect(),
            markers: self.markers.iter().map(|m| m.map(|m| m.map(pose))).collect(),
        }
    }
}

/// What a joint can keep of its design configuration, or the rate at which a design variable changes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kept<T = f64> {
    /// Distance between its markers, m: the length of a rod.
    pub distance: T,
    /// Displacement of marker j along z_i, m.
    pub offset: T,
    /// Cosine of the angle between z_i and z_j.
    pub cosine: T,
    /// Distance of marker j from the curve of marker i, positive on its left, m.
    pub contact: T,
}

impl<T: Real> Kept<T> {
    /// What this constraint keeps; 0 for those that keep nothing.
    pub fn by(&self, row: Row) -> T {
        match row {
            Row::Distance => self.distance,
            Row::Offset => self.offset,
            Row::Cosine => self.cosine,
            Row::Contact => self.contact,
            _ => T::zero(),
        }
    }

    fn map<U>(self, f: impl Fn(T) -> U) -> Kept<U> {
        Kept {
            distance: f(self.distance),
            offset: f(self.offset),
            cosine: f(self.cosine),
            contact: f(self.contact),
        }
    }

    fn vanishes(self) -> bool {
        [self.distance, self.offset, self.cosine, self.contact].into_iter().all(T::vanishes)
    }

    /// The largest of them.
    pub(crate) fn size(&self) -> T {
        let [a, b] =
            [self.distance.abs().larger(self.offset.abs()), self.cosine.abs().larger(self.contact.abs())];
        a.larger(b)
    }
}

/// What the variables of a model change, by what they change: found once for many designs.
#[derive(Clone, Debug)]
pub(crate) struct Effects<'m> {
    pub model: &'m Model,
    /// Per hardpoint: the variables that move it, and its velocity by each.
    moves: Vec<Vec<(usize, Vec3)>>,
    /// Per joint: the variables that change the joint itself.
    changes: Vec<Vec<(usize, &'m Change)>>,
    /// Per hardpoint: the joints and points that follow it.
    joints: Vec<Vec<usize>>,
    points: Vec<Vec<usize>>,
    /// What formulas do; none in a model without.
    formulas: Option<Formulas>,
}

/// How formulas follow the variables and each other.
#[derive(Clone, Debug)]
struct Formulas {
    /// Per parameter: the variables that change it, and its rate by each.
    rates: Vec<Vec<(usize, f64)>>,
    /// Which formula gives a parameter, the coordinates of a hardpoint, the length of a joint.
    of_parameter: Vec<Option<usize>>,
    of_hardpoint: Vec<[Option<usize>; 3]>,
    of_length: Vec<Option<usize>>,
    /// The formulas that use a parameter, or a coordinate of a hardpoint.
    using_parameter: Vec<Vec<usize>>,
    using_hardpoint: Vec<Vec<usize>>,
    /// Per variable, whether any formula follows it.
    is_used: Vec<bool>,
}

impl Formulas {
    fn of(model: &Model) -> Option<Self> {
        if model.formulas.is_empty() {
            return None;
        }
        let (parameters, hardpoints) = (model.parameters.len(), model.hardpoints.len());
        let mut f = Self {
            rates: vec![Vec::new(); parameters],
            of_parameter: vec![None; parameters],
            of_hardpoint: vec![[None; 3]; hardpoints],
            of_length: vec![None; model.joints.len()],
            using_parameter: vec![Vec::new(); parameters],
            using_hardpoint: vec![Vec::new(); hardpoints],
            is_used: Vec::new(),
        };
        for (k, formula) in model.formulas.iter().enumerate() {
            match formula.of {
                Target::Parameter(p) => f.of_parameter[p.0] = Some(k),
                Target::Coordinate(h, axis) => f.of_hardpoint[h.0][axis] = Some(k),
                Target::Length(j) => f.of_length[j.0] = Some(k),
                Target::Law(..) => {}
            }
            for source in formula.sources() {
                match source {
                    Source::Parameter(p) => f.using_parameter[p.0].push(k),
                    Source::Coordinate(h, _) => f.using_hardpoint[h.0].push(k),
                }
            }
        }
        for (k, variable) in model.variables.iter().enumerate() {
            for change in &variable.changes {
                if let Change::Parameter { parameter, rate } = change {
                    f.rates[parameter.0].push((k, *rate));
                }
            }
            let is_used = variable.changes.iter().any(|change| !f.using(change).is_empty());
            f.is_used.push(is_used);
        }
        Some(f)
    }

    /// The formulas that use what a change moves.
    fn using(&self, change: &Change) -> &[usize] {
        match change {
            Change::Parameter { parameter, .. } => &self.using_parameter[parameter.0],
            Change::Move { hardpoint, .. } => &self.using_hardpoint[hardpoint.0],
            _ => &[],
        }
    }

    /// The formulas that follow a variable, directly or through others, in order.
    fn following(&self, model: &Model, variable: VariableId) -> Vec<usize> {
        let mut seen = vec![false; model.formulas.len()];
        let changes = &model.variables[variable.0].changes;
        let mut waiting: Vec<usize> = changes.iter().flat_map(|c| self.using(c)).copied().collect();
        while let Some(k) = waiting.pop() {
            if !std::mem::replace(&mut seen[k], true) {
                match model.formulas[k].of {
                    Target::Parameter(p) => waiting.extend(&self.using_parameter[p.0]),
                    Target::Coordinate(h, _) => waiting.extend(&self.using_hardpoint[h.0]),
                    Target::Length(_) | Target::Law(..) => {}
                }
            }
        }
        (0..seen.len()).filter(|k| seen[*k]).collect()
    }
}

impl<'m> Effects<'m> {
    pub fn of(model: &'m Model) -> Self {
        let hardpoints = model.hardpoints.len();
        let mut effects = Self {
            model,
            formulas: Formulas::of(model),
            moves: vec![Vec::new(); hardpoints],
            changes: vec![Vec::new(); model.joints.len()],
            joints: vec![Vec::new(); hardpoints],
            points: vec![Vec::new(); hardpoints],
        };
        for (k, variable) in model.variables.iter().enumerate() {
            for change in &variable.changes {
                if let Change::Move { hardpoint, velocity } = change {
                    effects.moves[hardpoint.0].push((k, *velocity));
                } else if let Some(joint) = change.joint() {
                    effects.changes[joint.0].push((k, change));
                }
            }
        }
        for (j, joint) in model.joints.iter().enumerate() {
            joint.at.iter().for_each(|h| effects.joints[h.0].push(j));
            for axis in [joint.axis, joint.axis2].into_iter().flatten() {
                axis.hardpoints().for_each(|h| effects.joints[h.0].push(j));
            }
        }
        for (k, point) in model.points.iter().enumerate() {
            effects.points[point.at.0].push(k);
        }
        effects
    }

    /// Whether a variable changes the law of a driver.
    pub fn laws_change(&self) -> bool {
        let changes = self.model.variables.iter().flat_map(|v| &v.changes);
        changes.into_iter().any(|c| matches!(c, Change::Law { .. }))
            || self.model.formulas.iter().any(|f| matches!(f.of, Target::Law(..)))
    }

    /// The geometry of the designs whose values these are, variable by variable.
    pub fn geometry<T: Real>(&self, values: &[T]) -> Geometry<T> {
        let model = self.model;
        let design = Design::new(self, values.to_vec());
        Geometry {
            markers: (0..model.joints.len()).map(|j| [0, 1].map(|e| design.marker(j, e))).collect(),
            kept: (0..model.joints.len()).map(|j| design.kept(j)).collect(),
            points: (0..model.points.len()).map(|k| design.point(k)).collect(),
        }
    }

    /// What the measures of these designs go by.
    pub fn fixed<T: Real>(&self, values: &[T]) -> Fixed<T> {
        let (model, design) = (self.model, Design::new(self, values.to_vec()));
        let markers = |m: &Measure| match m.kind {
            MeasureKind::Coordinate { joint, .. } => Some([0, 1].map(|e| design.marker(joint.0, e))),
            _ => None,
        };
        Fixed {
            points: (0..model.points.len()).map(|k| design.point(k)).collect(),
            directions: model.measures.iter().map(|m| design.directions(m)).collect(),
            markers: model.measures.iter().map(markers).collect(),
        }
    }

    /// How one variable changes the designs whose values these are.
    pub fn field<T: Real>(&self, variable: VariableId, values: &[T]) -> Field<T> {
        self.field_along(&[(variable, 1.0)], values)
    }

    /// How the designs whose values these are change along a direction, some variables at once.
    ///
    /// Paper Eqs. 3.1 to 3.10 and 5.5; `docs/theory.md` (8).
    pub fn field_along<T: Real>(&self, along: &[(VariableId, f64)], values: &[T]) -> Field<T> {
        let mut duals: Vec<Dual<T>> = values.iter().map(|v| Dual::constant(*v)).collect();
        for &(variable, rate) in along {
            duals[variable.0].d = T::constant(rate);
        }
        let design = Design::new(self, duals);
        let touched = self.touched(along);
        let mut field = Field { laws: self.law_rates(&touched, &design), ..Field::default() };
        for j in touched.joints {
            for end in 0..2 {
                let (_, twist) = design.marker(j, end).split();
                if !is_null(twist.w) || !is_null(twist.v) {
                    field.markers.push(MarkerField { joint: JointId(j), end, twist });
                }
            }
            let rates = design.kept(j).map(|x| x.d);
            if !rates.vanishes() {
                field.kept.push((JointId(j), rates));
            }
        }
        let moved = touched.points.into_iter().map(|k| (PointId(k), design.point(k).map(|x| x.d)));
        field.points = moved.filter(|(_, v)| !is_null(*v)).collect();
        field
    }

    /// What may change along a direction, some variables at once.
    fn touched(&self, along: &[(VariableId, f64)]) -> Touched {
        let mut touched = Touched::default();
        for (variable, by) in along {
            for change in &self.model.variables[variable.0].changes {
                match change {
                    Change::Move { hardpoint, .. } => touched.hardpoints.push(hardpoint.0),
                    Change::Law { driver, parameter, rate } => {
                        touched.laws.push((*driver, *parameter, by * rate));
                    }
                    _ => touched.joints.extend(change.joint().map(|j| j.0)),
                }
            }
            let following = self.formulas.as_ref().map(|f| f.following(self.model, *variable));
            for k in following.unwrap_or_default() {
                match self.model.formulas[k].of {
                    Target::Parameter(_) => {}
                    Target::Coordinate(h, _) => touched.hardpoints.push(h.0),
                    Target::Length(j) => touched.joints.push(j.0),
                    Target::Law(..) => touched.law_formulas.push(k),
                }
            }
        }
        for &h in &touched.hardpoints {
            touched.joints.extend(&self.joints[h]);
            touched.points.extend(&self.points[h]);
        }
        for list in [&mut touched.joints, &mut touched.points, &mut touched.law_formulas] {
            list.sort_unstable();
            list.dedup();
        }
        touched
    }

    /// The parameters of laws that change, and their rates.
    fn law_rates<T: Real>(
        &self,
        touched: &Touched,
        design: &Design<'_, Dual<T>>,
    ) -> Vec<(DriverId, usize, T)> {
        let mut rates: Vec<_> =
            touched.laws.iter().map(|(d, p, rate)| (*d, *p, T::constant(*rate))).collect();
        for &k in &touched.law_formulas {
            if let Target::Law(driver, parameter) = self.model.formulas[k].of {
                let rate = design.values.formulas[k].d;
                match rates.iter_mut().find(|r| (r.0, r.1) == (driver, parameter)) {
                    Some(known) => known.2 += rate,
                    None => rates.push((driver, parameter, rate)),
                }
            }
        }
        rates
    }

    /// The drivers' laws in the design with these values.
    pub fn laws(&self, values: &[f64]) -> Vec<Law> {
        let model = self.model;
        let mut laws: Vec<Law> = model.drivers.iter().map(|d| d.law.clone()).collect();
        if model.formulas.iter().any(|f| matches!(f.of, Target::Law(..))) {
            let results = Design::new(self, values.to_vec()).values.formulas;
            // Without results, no formula follows what is not at 0.
            for (formula, result) in model.formulas.iter().zip(results) {
                if let Target::Law(driver, parameter) = formula.of {
                    laws[driver.0] = laws[driver.0].with_parameter(parameter, result);
                }
            }
        }
        for (variable, value) in model.variables.iter().zip(values).filter(|(_, value)| **value != 0.0) {
            for change in &variable.changes {
                if let Change::Law { driver, parameter, rate } = change {
                    let law = &mut laws[driver.0];
                    let now = law.parameters()[*parameter].value;
                    *law = law.with_parameter(*parameter, now + rate * value);
                }
            }
        }
        laws
    }

    /// How every variable changes the designs whose values these are.
    pub fn fields<T: Real>(&self, values: &[T]) -> Vec<Field<T>> {
        (0..values.len()).map(|k| self.field(VariableId(k), values)).collect()
    }
}

fn is_null<T: Real>(v: Vec3<T>) -> bool {
    v.x.vanishes() && v.y.vanishes() && v.z.vanishes()
}

/// What may change along a direction: hardpoints, joints, points, parameters of laws at a rate, and formulas of such.
#[derive(Default)]
struct Touched {
    hardpoints: Vec<usize>,
    joints: Vec<usize>,
    points: Vec<usize>,
    laws: Vec<(DriverId, usize, f64)>,
    law_formulas: Vec<usize>,
}

/// Where everything is with the variables at these values.
struct Design<'e, T> {
    effects: &'e Effects<'e>,
    values: Values<T>,
    /// The same, 0 for variables that keep the lengths of rods: what the lengths are measured with.
    for_lengths: Values<T>,
    /// Per variable, whether it makes any difference.
    counts: Vec<bool>,
}

/// Values of the variables, and what formulas make of them; none where no formula follows a variable that counts.
#[derive(Clone)]
struct Values<T> {
    variables: Vec<T>,
    formulas: Vec<T>,
}

impl<'e, T: Real> Design<'e, T> {
    /// Variables at 0 are left out, unless it is differentiated by them.
    fn new(effects: &'e Effects<'_>, values: Vec<T>) -> Self {
        let variables = &effects.model.variables;
        let counts = values.iter().map(|v| !v.vanishes()).collect();
        let follows = |(value, v): (&T, &DesignVariable)| if v.fixed_length { T::zero() } else { *value };
        let for_lengths = values.iter().zip(variables).map(follows).collect();
        let plain = |variables| Values { variables, formulas: Vec::new() };
        let (values, for_lengths) = (plain(values), plain(for_lengths));
        let mut design = Self { effects, values, for_lengths, counts };
        if let Some(f) = &effects.formulas
            && f.is_used.iter().zip(&design.counts).any(|(is_used, counts)| *is_used && *counts)
        {
            design.values.formulas = design.solved(f, &design.values.variables);
            design.for_lengths.formulas = match variables.iter().any(|v| v.fixed_length) {
                true => design.solved(f, &design.for_lengths.variables),
                false => design.values.formulas.clone(),
            };
        }
        design
    }

    /// What all formulas give, one after the other.
    fn solved(&self, formulas: &Formulas, variables: &[T]) -> Vec<T> {
        let model = self.effects.model;
        let mut results: Vec<T> = Vec::with_capacity(model.formulas.len());
        for formula in &model.formulas {
            let result = formula.at(|source| {
                let (given, rates) = match source {
                    Source::Parameter(p) => {
                        (formulas.of_parameter[p.0], self.rates(&formulas.rates[p.0], |r| *r))
                    }
                    Source::Coordinate(h, axis) => (
                        formulas.of_hardpoint[h.0][axis],
                        self.rates(&self.effects.moves[h.0], move |v| v[axis]),
                    ),
                };
                let given = given.map_or_else(|| T::constant(model.nominal(source)), |k| results[k]);
                rates
                    .into_iter()
                    .fold(given, |sum, (k, rate)| T::constant(rate).times_plus(variables[k], sum))
            });
            results.push(result);
        }
        results
    }

    /// The variables of a list that make a difference, with their rates.
    fn rates<R>(&self, list: &[(usize, R)], rate: impl Fn(&R) -> f64) -> Vec<(usize, f64)> {
        list.iter().filter(|(k, _)| self.counts[*k]).map(|(k, r)| (*k, rate(r))).collect()
    }

    /// Global position of a hardpoint.
    fn place(&self, h: HardpointId, values: &Values<T>) -> Vec3<T> {
        let mut place = self.effects.model.position(h).spread();
        if let (Some(f), false) = (&self.effects.formulas, values.formulas.is_empty()) {
            let given = |axis: usize| f.of_hardpoint[h.0][axis].map_or(place[axis], |k| values.formulas[k]);
            place = Vec3::new(given(0), given(1), given(2));
        }
        for &(k, velocity) in self.effects.moves[h.0].iter().filter(|(k, _)| self.counts[*k]) {
            place = velocity.spread().times_plus(values.variables[k], place);
        }
        place
    }

    /// The unit vector of a direction.
    fn direction(&self, d: Direction, values: &Values<T>) -> Vec3<T> {
        match d {
            Direction::Along(u) => u.spread(),
            Direction::Through(a, b) => {
                let d = self.place(b, values) - self.place(a, values);
                d * (T::one() / d.norm())
            }
        }
    }

    /// A body's frame, which the design leaves where it is.
    fn frame(&self, body: BodyId) -> Pose<T> {
        self.effects.model.bodies[body.0].frame.spread()
    }

    /// Marker e of joint j in its body's frame.
    fn marker(&self, j: usize, e: usize) -> Pose<T> {
        let body = self.effects.model.joints[j].bodies[e];
        self.frame(body).inverse().compose(self.marker_in_world(j, e, &self.values))
    }

    /// Marker e of joint j in the design configuration.
    fn marker_in_world(&self, j: usize, e: usize, values: &Values<T>) -> Pose<T> {
        let joint = &self.effects.model.joints[j];
        let mut rot = self.followed_frame(joint, e, values);
        let mut r = self.place(joint.at[e], values);
        for &(k, change) in self.effects.changes[j].iter().filter(|(k, _)| self.counts[*k]) {
            let b = values.variables[k];
            match change {
                Change::Marker { end, position, rotation, .. } if end.covers(e) => {
                    r = position.spread().times_plus(b, r);
                    if let Some(axis) = rotation.unit() {
                        rot = Mat3::about(axis, b * T::constant(rotation.norm())) * rot;
                    }
                }
                Change::Field { end, v, u, .. } if *end == e => {
                    let body = self.frame(joint.bodies[e]).rot;
                    r += body * v.spread() * b;
                    let (theta, c) = self.effects.model.euler_of(joint, e);
                    let turned = [0, 1, 2].map(|n| T::constant(u[n]).times_plus(b, T::constant(theta[n])));
                    let turned = rotation_from_euler_313(turned) * c.transpose().spread();
                    rot = body * turned * body.transpose() * rot;
                }
                _ => {}
            }
        }
        Pose { rot, r }
    }

    /// The frame of marker e of a joint whose axes follow the hardpoints they pass through.
    ///
    /// z turns by the smallest rotation to its new direction; x then turns about z with `axis2`.
    fn followed_frame(&self, joint: &Joint, e: usize, values: &Values<T>) -> Mat3<T> {
        let mut rot = joint.frames[e].spread();
        let [axis, axis2] = joint.axes_of_marker(e);
        if let Some(axis @ Direction::Through(..)) = axis {
            rot = Mat3::between(rot.cols[2], self.direction(axis, values)) * rot;
        }
        if let Some(axis2 @ Direction::Through(..)) = axis2 {
            let (d, z) = (self.direction(axis2, values), rot.cols[2]);
            let across = d - z * z.dot(d);
            let length = across.norm();
            if length.decisive() > ALONG {
                let x = across * (T::one() / length);
                rot = Mat3 { cols: [x, z.cross(x), z] };
            }
        }
        rot
    }

    /// What joint j keeps.
    fn kept(&self, j: usize) -> Kept<T> {
        let (joint, zero) = (&self.effects.model.joints[j], T::zero());
        let [m_i, m_j] = [0, 1].map(|e| self.marker_in_world(j, e, &self.for_lengths));
        let (d, z_i, z_j) = (m_j.r - m_i.r, m_i.rot.cols[2], m_j.rot.cols[2]);
        let given = joint.length.map(|length| {
            let formula = self.effects.formulas.as_ref().and_then(|f| f.of_length[j]);
            let given = formula.and_then(|k| self.values.formulas.get(k)).copied();
            let mut given = given.unwrap_or_else(|| T::constant(length));
            for &(k, change) in self.effects.changes[j].iter().filter(|(k, _)| self.counts[*k]) {
                if let Change::Length { rate, .. } = change {
                    given = self.values.variables[k].times_plus(T::constant(*rate), given);
                }
            }
            given
        });
        // Markers at one place keep no distance, and it would have no derivative.
        let keeps = || {
            joint.kind.rows.contains(&Row::Distance)
                || joint.kind.coordinates.iter().any(|c| c.row == Row::Distance)
        };
        let distance =
            given.unwrap_or_else(|| if keeps() && d.dot(d).decisive() > 0.0 { d.norm() } else { zero });
        let contact = joint.curve.as_ref().map_or(zero, |curve| {
            let drawn = curve.distance(m_i.rot.transpose_mul(d));
            let sign = || T::constant(f64::signum(drawn.value()));
            given.map_or(drawn, |length| length.abs() * sign())
        });
        Kept { distance, offset: z_i.dot(d), cosine: z_i.dot(z_j), contact }
    }

    /// A point in its body's frame.
    fn point(&self, k: usize) -> Vec3<T> {
        let point = &self.effects.model.points[k];
        self.frame(point.body).inverse().point(self.place(point.at, &self.values))
    }

    /// The directions that a measure goes by, in their bodies' frames.
    fn directions(&self, measure: &Measure) -> [Option<Vec3<T>>; 2] {
        let in_body = |(body, axis): (BodyId, Direction)| {
            self.frame(body).rot.transpose_mul(self.direction(axis, &self.values))
        };
        self.effects.model.directions(measure).map(|d| d.map(in_body))
    }
}

/// A second axis nearer to the first than this, rad, says nothing about x.
const ALONG: f64 = 1e-12;

impl Model {
    /// The geometry of the design with variable k at `design[k]` (missing entries are 0).
    ///
    /// Body frames stay where they are in the design configuration; markers move on their bodies.
    pub fn geometry(&self, design: &[f64]) -> Geometry {
        Effects::of(self).geometry(&self.whole(design))
    }

    /// The first-order change of the nominal design per unit of one variable.
    pub fn field(&self, variable: VariableId) -> Field {
        Effects::of(self).field(variable, &self.whole(&[]))
    }

    /// The first-order changes of a design per unit of each variable.
    pub fn fields(&self, design: &[f64]) -> Vec<Field> {
        Effects::of(self).fields(&self.whole(design))
    }

    /// The variables whose change changes nothing that the motion or its results depend on.
    pub fn without_effect(&self) -> Vec<VariableId> {
        let effects = Effects::of(self);
        let directions = self.measures.iter().flat_map(|m| self.directions(m)).flatten();
        let seen: Vec<usize> = directions.flat_map(|(_, axis)| axis.hardpoints()).map(|h| h.0).collect();
        let is_idle = |v: &VariableId| {
            let touched = effects.touched(&[(*v, 1.0)]);
            let felt = [&touched.joints, &touched.points, &touched.law_formulas];
            felt.iter().all(|list| list.is_empty())
                && touched.laws.is_empty()
                && !touched.hardpoints.iter().any(|h| seen.contains(h))
        };
        (0..self.variables.len()).map(VariableId).filter(is_idle).collect()
    }

    /// A value for every variable: 0 but for this one.
    pub(crate) fn alone(&self, variable: VariableId, value: f64) -> Vec<f64> {
        let mut design = self.whole(&[]);
        design[variable.0] = value;
        design
    }

    /// A value for every variable: those given, then 0.
    pub(crate) fn whole(&self, design: &[f64]) -> Vec<f64> {
        let given = design.iter().copied().chain(std::iter::repeat(0.0));
        given.take(self.variables.len()).collect()
    }

    /// The drivers' laws in the design with variable k at `design[k]` (missing entries are 0).
    pub fn laws(&self, design: &[f64]) -> Vec<Law> {
        Effects::of(self).laws(&self.whole(design))
    }

    /// 3-1-3 Euler angles of a marker in its body's frame, and their rotation C(theta).
    fn euler_of(&self, joint: &Joint, e: usize) -> ([f64; 3], Mat3) {
        let in_body = self.bodies[joint.bodies[e].0].frame.rot.transpose() * joint.frames[e];
        let theta = euler_313_from_rotation(in_body);
        (theta, rotation_from_euler_313(theta))
    }

    pub(crate) fn position(&self, h: HardpointId) -> Vec3 {
        self.hardpoints[h.0].position
    }
}

impl Direction {
    /// The hardpoints that it follows.
    pub(super) fn hardpoints(self) -> impl Iterator<Item = HardpointId> {
        let through = match self {
            Self::Along(_) => None,
            Self::Through(a, b) => Some([a, b]),
        };
        through.into_iter().flatten()
    }
}

impl Joint {
    /// The directions of z and x of marker e, as far as they are given.
    fn axes_of_marker(&self, e: usize) -> [Option<Direction>; 2] {
        match (self.kind.axis2, e) {
            (Need::OnBodyJ, 0) => [self.axis, None],
            (Need::OnBodyJ, _) => [self.axis2, None],
            _ => [self.axis, self.axis2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Expression;

    #[test]
    fn formulas_have_exact_second_derivatives_on_duals_of_duals() {
        let arm = |name: &str| BodyDraft { name: name.into(), frame: FrameDraft::Default };
        let joint = |name: &str, kind: &str, bodies: [&str; 2], at: &[&str]| JointDraft {
            name: name.into(),
            kind: kind.into(),
            bodies: bodies.map(str::to_owned),
            at: at.iter().map(|h| Place::Hardpoint((*h).into())).collect(),
            axis: (kind == "revolute").then_some(Line::Along(Vec3::AXES[2])),
            ..JointDraft::default()
        };
        let texts = [("x", "length*cos(angle)"), ("y", "length*sin(angle)")];
        let expression = |text: &str| Expression::parse(text).unwrap();
        let model = Model::from_draft(&Draft {
            parameters: [("length", 0.3, Quantity::Length), ("angle", 0.8, Quantity::Angle)]
                .map(|(name, value, quantity)| ParameterDraft { name: name.into(), value, quantity })
                .into(),
            formulas: texts
                .iter()
                .enumerate()
                .map(|(axis, (_, text))| FormulaDraft {
                    of: FormulaOf::Coordinate("B".into(), axis),
                    expression: expression(text),
                })
                .collect(),
            hardpoints: [("A", 0.0), ("B", 0.0), ("C", 0.5)]
                .map(|(name, x)| HardpointDraft { name: name.into(), position: Vec3::new(x, 0.0, 0.0) })
                .into(),
            bodies: vec![arm("i"), arm("j")],
            joints: vec![
                joint("a", "revolute", ["ground", "i"], &["A"]),
                joint("c", "revolute", ["ground", "j"], &["C"]),
                joint("rod", "rod", ["i", "j"], &["B", "C"]),
            ],
            design: vec![VariableDraft {
                name: "angle".into(),
                changes: vec![ChangeDraft::Parameter { parameter: "angle".into(), rate: 1.0 }],
                ..VariableDraft::default()
            }],
            times: vec![0.0],
            ..Draft::default()
        })
        .unwrap();
        let effects = Effects::of(&model);
        for b in [0.0, 0.4] {
            let value = Dual { v: Dual::variable(b), d: Dual::constant(1.0) };
            let rod = effects.geometry(&[value]);
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
