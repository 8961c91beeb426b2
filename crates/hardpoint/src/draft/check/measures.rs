//! Checks of measures and metrics: references, and availability of derivatives.

use crate::draft::{DraftLocation, MeasureDraft, MetricDraft, RayDraft, Section};
use crate::expression::Expression;
use crate::joint::free_directions;
use crate::model::element::{ActsOn, Compliance, Properties};
use crate::model::{
    CaseId, Combination, CurvePart, Dimension, DriverId, ElasticId, Element, ElementId, JacobianValue,
    Measure, MeasureKind, Metric, OutputSource, PointId, Ray, WheelId, loads, of_bodies,
};

use super::field::FieldCheck;
use super::{Checker, Here};

impl Checker<'_> {
    pub(super) fn add_measures(&mut self) {
        let draft = self.draft;
        for (index, m) in draft.measures.iter().enumerate() {
            let here = Here { section: Section::Measures, index };
            if let Some(kind) = self.one_measure(m, here) {
                self.model.measures.push(Measure { name: m.name.clone(), kind });
            }
        }
        if self.model.measures.len() == draft.measures.len() {
            self.check_dependencies();
        }
    }

    fn one_measure(&mut self, m: &MeasureDraft, here: Here) -> Option<MeasureKind> {
        let kind = m.kind.resolve(&mut FieldCheck::new(self, &m.name, here))?;
        self.check_load(&kind, m, here);
        self.check_articulation(&kind, here);
        self.check_deflection(&kind, here);
        if let MeasureKind::Distance { from, to } = kind {
            let [a, b] = [from, to].map(|p| self.model.points[p.0].clone());
            let at_one_place = self.separation(a.at, b.at) == Some(None);
            if from == to || a.body == b.body && at_one_place {
                let message = format!("measure `{}` is the distance of a point from itself", m.name);
                self.fault("HP0216", here.key("to"), message);
            } else if at_one_place {
                let message = format!("the two points of measure `{}` coincide", m.name);
                self.fault("HP0216", here.key("to"), message).note("a distance of zero has no rate").help(
                    "measure the `position` of one of them along each direction, or name points that do not coincide",
                );
            }
        }
        Some(kind)
    }

    /// HP0265: the articulation of a joint whose axis does not tilt.
    fn check_articulation(&mut self, kind: &MeasureKind, here: Here) {
        let Some(joint) = kind.tilting_joint().map(|joint| &self.model.joints[joint.0]) else { return };
        if joint.kind.articulates() {
            return;
        }
        let coordinates: Vec<String> =
            joint.kind.coordinates.iter().map(|c| format!("`{}`", c.name)).collect();
        let note = format!("type of `{}`: {} ({})", joint.name, joint.kind.name, joint.kind.summary);
        let message = format!("the axis of joint `{}` does not tilt: it has no articulation", joint.name);
        let help = match coordinates.is_empty() {
            true => {
                "name a ball joint, a universal or constant-velocity joint, an inline or inplane joint".into()
            }
            false => format!("name one of its coordinates: {}", coordinates.join(", ")),
        };
        self.fault("HP0265", here.key("joint"), message).note(note).help(help);
    }

    /// HP0250: the deflection of an elastic joint in a direction in which it is rigid.
    fn check_deflection(&mut self, kind: &MeasureKind, here: Here) {
        let Some((ElasticId(element), direction)) = kind.elastic() else { return };
        let Element { name, kind, .. } = &self.model.elements[element.0];
        let Some(Properties { acts_on: ActsOn::Joint(joint), .. }) = kind.force(&self.model) else { return };
        let joint = &self.model.joints[joint.0];
        let is_free = free_directions(joint.kind)[direction.0];
        if is_free || kind.elastic_law().is_none_or(|law| law.gives()[direction.0]) {
            return;
        }
        let message = format!(
            "`{name}` has no deflection `{}`: joint `{}` is rigid there",
            direction.name(),
            joint.name
        );
        let help = format!("name a direction with a stiffness, or add `{}` to `{name}`", direction.name());
        self.fault("HP0250", here.key("direction"), message).help(help);
    }

    /// The elastic joint or bushing of that name.
    pub(super) fn elastic(&mut self, name: &str, at: DraftLocation) -> Option<ElasticId> {
        let element = self.force(name, at.clone())?;
        if self.model.elements[element.0].kind.elastic_law().is_some() {
            return Some(ElasticId(element));
        }
        let message = format!("`{name}` has no deflections along and about axes");
        self.fault("HP0250", at, message)
            .help("name a force of `type = \"elastic_joint\"` or `\"bushing\"`; of a spring measure the `distance` of its ends");
        None
    }

    /// HP0250: loads or compliances of a model without any. HP0251: reactions on a body that the joint does not
    /// connect.
    fn check_load(&mut self, kind: &MeasureKind, m: &MeasureDraft, here: Here) {
        let draft = self.draft;
        let nothing = draft.masses.is_empty() && draft.forces.is_empty();
        if kind.is_load() && nothing && !self.is_table_unread("mass") && !self.is_table_unread("force") {
            let message =
                format!("measure `{}` is a load, but the model has no masses and no forces", m.name);
            self.fault("HP0250", here.key("type"), message).help("add `[masses]`, `[gravity]` or `[forces]`");
        }
        let deflects = |e: &Element| match e.kind.force(&self.model).map(|force| force.compliance) {
            Some(Compliance::Element | Compliance::Joint(..)) => true,
            Some(Compliance::None) | None => false,
        };
        // A faulty force may be the one that deflects.
        let forces = self.model.elements.iter().filter(|e| !e.kind.has_mass()).count();
        let rigid = forces == draft.forces.len() && !self.model.elements.iter().any(deflects);
        if matches!(kind, MeasureKind::Compliance { .. })
            && rigid
            && !self.draft.unread.any_of(Section::Forces)
        {
            let message =
                format!("measure `{}` is a compliance, but no part of the model is compliant", m.name);
            self.fault("HP0250", here.key("type"), message)
                .help("add compliant joints as `[forces]` of `type = \"elastic_joint\"`");
        }
        if let MeasureKind::Compliance { at, wheel, force, along, released, .. } = kind {
            let given =
                usize::from(at.is_some()) + usize::from(wheel.is_some()) + usize::from(force.is_some());
            if given != 1 {
                let (message, help) = if given > 1 {
                    ("has more than one of `at`, `wheel` and `force`", "leave one in")
                } else {
                    (
                        "has no point of application",
                        "give the point as `at`, the `wheel` that the road acts on, or the `force` that changes",
                    )
                };
                self.fault("HP0251", here.key("at"), format!("`{}` {message}", m.name)).help(help);
            } else if force.is_none() && along.is_none() {
                self.fault("HP0251", here.key("along"), format!("`{}` has no direction", m.name))
                    .help("give the direction of the force, like `along = \"y\"`");
            } else if force.is_some() && along.is_some() {
                let message = format!("`{}` has a direction of its own, and that of its `force`", m.name);
                self.fault("HP0251", here.key("along"), message)
                    .help("remove `along`: the force grows along its own direction");
            }
            let is_given = |e: &ElementId| {
                let kind = &self.model.elements[e.0].kind;
                // The law of a tyre is that of the road.
                let deflects =
                    kind.force(&self.model).is_none_or(|f| !matches!(f.compliance, Compliance::None));
                !deflects && kind.clone().law_mut().is_some()
            };
            if let Some(e) = force
                && !is_given(e)
            {
                let message = format!(
                    "`{}` of measure `{}` is not a given force",
                    self.model.elements[e.0].name, m.name
                );
                self.fault("HP0251", here.key("force"), message)
                    .help("name a force of type `force`, `wheel_force` or `moment`");
            }
            let at_equilibrium = self.draft.equilibrium.is_some();
            if force.is_some() && !at_equilibrium {
                let message = format!("measure `{}` needs the equilibrium under its force", m.name);
                self.fault("HP0261", here.key("force"), message)
                    .help("add `[equilibrium]`, or give `at` or `wheel` with `along` instead of `force`");
            }
            if released.is_some() && at_equilibrium {
                let message = format!("measure `{}` releases a driver by itself", m.name);
                self.fault("HP0261", here.key("released"), message)
                    .help("write `released` in `[equilibrium]` instead");
            }
        }
        if let MeasureKind::Reaction { joint, on: Some(on), .. } = kind {
            let joint = &self.model.joints[joint.0];
            if !joint.bodies.contains(on) {
                let [i, j] = joint.bodies.map(|b| self.model.bodies[b.0].name.clone());
                let message = format!(
                    "joint `{}` does not connect body `{}`",
                    joint.name, self.model.bodies[on.0].name
                );
                self.fault("HP0251", here.key("on"), message).help(format!("write `{i}` or `{j}`"));
            }
        }
    }

    /// Returns the wheel with this name.
    pub(super) fn wheel_named(&mut self, name: &str, at: DraftLocation) -> Option<WheelId> {
        let draft = self.draft;
        let k = self.find("wheel", name, at, draft.wheels.iter().map(|w| w.name.as_str()))?;
        self.wheel_ids[k]
    }

    /// Returns the force with this name.
    pub(super) fn force(&mut self, name: &str, at: DraftLocation) -> Option<ElementId> {
        let draft = self.draft;
        let k = self.find("force", name, at, draft.forces.iter().map(|f| f.name.as_str()))?;
        let name = &draft.forces[k].name;
        let is_it = |e: &Element| !e.kind.has_mass() && e.name == *name;
        self.model.elements.iter().position(is_it).map(ElementId)
    }

    pub(super) fn add_metrics(&mut self) {
        let draft = self.draft;
        for (index, m) in draft.metrics.iter().enumerate() {
            let here = Here { section: Section::Metrics, index };
            let metric = if self.unread(here, "") { None } else { self.one_metric(m, here) };
            self.metric_ids.push(metric.is_some().then_some(self.model.metrics.len()));
            self.model.metrics.extend(metric);
        }
    }

    fn one_metric(&mut self, m: &MetricDraft, here: Here) -> Option<Metric> {
        let case = m.case.as_ref().map(|case| self.case(case, here.key("case")));
        let of = self.output(&m.of, here.key("of"));
        let over = match &m.over {
            Some(over) => Some(self.output(over, here.key("over"))?),
            None => None,
        };
        let of = of?;
        if self.model.measures.len() < self.draft.measures.len() {
            // The unit of a faulty measure is unknown.
            return None;
        }
        let si = |dimension: Dimension, x: f64| {
            let [length, angle] =
                [(m.per_metre, dimension.length_in_units()), (m.per_radian, dimension.angle)]
                    .map(|(per, power)| per.powi(power.into()));
            x / (length * angle)
        };
        let x = |c: &Self| over.map_or(Dimension::NUMBER, |over| c.model.dimension(over));
        let (x, y) = (x(self), self.model.dimension(of));
        let take = m.take.converted(&|at| si(x, at), &|value| si(y, value));
        let rises = |points: &mut dyn Iterator<Item = f64>| {
            let points: Vec<f64> = points.collect();
            points.iter().all(|x| x.is_finite()) && points.windows(2).all(|w| w[0] < w[1])
        };
        if let Some(window) = m.window
            && !rises(&mut window.into_iter())
        {
            let message = format!("the window of metric `{}` is not in ascending order", m.name);
            self.fault("HP0234", here.key("window"), message).help("give the lower and the upper end");
            return None;
        }
        if let Some(target) = take.target()
            && !(rises(&mut target.iter().map(|p| p[0])) && target.iter().all(|p| p[1].is_finite()))
        {
            let message = format!("the abscissas of the target of metric `{}` do not increase", m.name);
            self.fault("HP0234", here.key("target"), message)
                .help("list points `[abscissa, value]` in the order of their abscissa");
            return None;
        }
        if take.part() == CurvePart::Points(&[]) {
            let message = format!("the target of metric `{}` has no points", m.name);
            self.fault("HP0234", here.key("target"), message)
                .help("list points `[abscissa, value]` in the order of their abscissa");
            return None;
        }
        if matches!(take.part(), CurvePart::Place { is_slope: true, .. }) && self.model.known(of).orders == 1
        {
            let message = format!("metric `{}` needs the rate of `{}`, which is not known", m.name, m.of);
            let [note, help] = if self.model.equilibrium.is_some() {
                [
                    "an equilibrium is solved at each output time by itself, at rest: nothing has a rate",
                    "take the `value` of a measure of `type = \"slope\"`: the exact slope while its `driver` moves, with \
                     the drivers in `together` or `opposed`; over a force take one of `type = \"compliance\"`",
                ]
            } else {
                [
                    "the motion is solved up to accelerations, and slopes over a driver have no rates",
                    "use its value, or the slope of a measure that depends on positions only",
                ]
            };
            self.fault("HP0233", here.key("of"), message).note(note).help(help);
            return None;
        }
        // Between its output times an equilibrium is known by straight lines.
        if let Some(over) = over
            && self.model.known(over).orders == 1
            && self.model.equilibrium.is_none()
        {
            let name = m.over.as_deref().unwrap_or_default();
            let message = format!("`{name}` cannot be an abscissa, because its rate is not known");
            self.fault("HP0233", here.key("over"), message)
                .help("use a measure that depends on positions or velocities only");
            return None;
        }
        let window = m.window.map(|w| w.map(|end| si(x, end)));
        let case = match case {
            Some(found) => Some(found?),
            None => None,
        };
        Some(Metric { name: m.name.clone(), of, over, take, window, case })
    }

    /// Returns the case with this name.
    fn case(&mut self, name: &str, at: DraftLocation) -> Option<CaseId> {
        let draft = self.draft;
        if draft.grids.iter().any(|g| g.name == name) {
            self.fault("HP0204", at, format!("case `{name}` is a grid, which has no metrics")).help(
                "name a case with `laws`; `run` writes every measure of a grid with its derivatives into `maps.json`",
            );
            return None;
        }
        let found = self.find("case", name, at, draft.cases.iter().map(|c| c.name.as_str()));
        if found.is_none() && draft.cases.is_empty() && !self.is_table_unread("case") {
            let fault = self.faults.last_mut().expect("just reported");
            fault.help(format!(
                "declare it as `[cases.{name}]`, or remove `case`: a model without cases has a single motion"
            ));
        }
        found.map(CaseId)
    }

    /// Resolves a direction that an angle is measured from or to.
    pub(super) fn ray(&mut self, ray: &RayDraft, owner: &str, here: Here, key: &'static str) -> Option<Ray> {
        match ray {
            RayDraft::Between([from, to]) => {
                let points =
                    (self.point(from, owner, here.item(key, 0)), self.point(to, owner, here.item(key, 1)));
                let ends = [points.0?, points.1?];
                let [a, b] = ends.map(|p| self.model.points[p.0].at);
                if self.separation(a, b) == Some(None) {
                    let message = format!("the two points of `{key}` of measure `{owner}` coincide");
                    self.fault("HP0216", here.key(key), message).help("name two different points");
                    return None;
                }
                Some(Ray::Between(ends))
            }
            RayDraft::Fixed { body, axis } => {
                let body = self.body(body, here.key(key));
                let (axis, _) = self.line(axis, owner, here, key)?;
                Some(Ray::Fixed { body: body?, axis })
            }
        }
    }

    /// Returns the output with this name: a measure, or a component of a point.
    pub(super) fn output(&mut self, name: &str, at: DraftLocation) -> Option<OutputSource> {
        if let Some(k) = self.number_of("measure", name) {
            return Some(OutputSource::Measure(k));
        }
        if let component @ Some(_) = self.component(name) {
            return component;
        }
        let draft = self.draft;
        if name.rsplit_once('.').is_some_and(|(owner, _)| self.may_measure(owner)) {
            return None;
        }
        self.find("measure", name, at, draft.measures.iter().map(|m| m.name.as_str()));
        if !draft.points.is_empty() && self.faults.last().is_some_and(|f| f.help.is_none()) {
            let fault = self.faults.last_mut().expect("just reported");
            fault.help("write a component of a point as `POINT.x`, `POINT.y` or `POINT.z`");
        }
        None
    }

    /// Returns the component of a point with this name.
    pub(super) fn component(&self, name: &str) -> Option<OutputSource> {
        let (point, axis) = name.rsplit_once('.')?;
        let axis = ["x", "y", "z"].iter().position(|a| *a == axis)?;
        self.number_of("point", point).map(|k| OutputSource::Point(PointId(k), axis))
    }

    /// True if a wheel or axle with this name may define a measure that could not be read.
    fn may_measure(&self, owner: &str) -> bool {
        let (draft, unread) = (self.draft, &self.draft.unread);
        let wheel = draft.wheels.iter().position(|w| w.name == owner).map(|k| (Section::Wheels, k));
        let axle = draft.axles.iter().position(|a| a.name == owner).map(|k| (Section::Axles, k));
        let mut owners = wheel.into_iter().chain(axle);
        owners.any(|(section, k)| unread.any(section, k) || self.vehicle_is_unread())
    }

    /// Returns the driver with this name, or the only driver.
    pub(super) fn driver_or_only(&mut self, name: Option<&str>, owner: &str, here: Here) -> Option<DriverId> {
        let draft = self.draft;
        let names = draft.drivers.iter().map(|d| d.name.as_str());
        match name {
            Some(name) => self.driver_named(name, here.key("driver")),
            None if draft.drivers.len() == 1 => self.driver_ids[0],
            None if self.is_table_unread("driver") => None,
            None => {
                let listed: Vec<String> = names.map(|n| format!("`{n}`")).collect();
                let message = format!("measure `{owner}` has no driver");
                self.fault("HP0232", here.key("driver"), message)
                    .note(format!("drivers: {}", listed.join(", ")))
                    .help("add `driver = ...`");
                None
            }
        }
    }

    /// Checks measures of other measures: no cycles, and only known derivatives.
    fn check_dependencies(&mut self) {
        let mut state = vec![Visit::New; self.model.measures.len()];
        for k in 0..state.len() {
            self.check_after_sources(k, &mut state);
        }
    }

    /// Checks a measure after those that it uses; true if it is valid.
    fn check_after_sources(&mut self, k: usize, state: &mut [Visit]) -> bool {
        let here = Here { section: Section::Measures, index: k };
        let name = self.model.measures[k].name.clone();
        match state[k] {
            Visit::Open => {
                self.fault("HP0227", here.key("of"), format!("measure `{name}` depends on itself"))
                    .help("remove the circular reference");
                return false;
            }
            Visit::Done(sound) => return sound,
            Visit::New => state[k] = Visit::Open,
        }
        let kind = self.model.measures[k].kind.clone();
        let mut sound = true;
        for source in kind.sources() {
            if let OutputSource::Measure(other) = source {
                sound &= self.check_after_sources(other, state);
            }
        }
        if sound {
            sound = self.has_known_derivatives(&kind, &name, here);
        }
        if sound && let MeasureKind::Combination { expression } = &kind {
            let expression = self.in_units(expression);
            self.model.measures[k].kind = MeasureKind::Combination { expression };
        }
        state[k] = Visit::Done(sound);
        sound
    }

    /// HP0233: rates of measures without rates; slopes and compliances of measures that do not depend on positions
    /// only.
    fn has_known_derivatives(&mut self, kind: &MeasureKind, name: &str, here: Here) -> bool {
        match kind {
            MeasureKind::Rate { of } if self.model.known(*of).orders < 2 => {
                let of = self.model.output_name(*of);
                self.fault(
                    "HP0233",
                    here.key("of"),
                    format!("`{name}` needs the rate of `{of}`, which is not known"),
                )
                .note("the motion is solved up to accelerations, and slopes over a driver have no rates")
                .help("use a measure that depends on positions or velocities only");
                false
            }
            MeasureKind::Compliance { of, .. } if !self.model.known(*of).by_position => {
                let what = self.model.output_name(*of);
                let message = format!("`{name}` needs the compliance of `{what}`, which is not known");
                self.fault("HP0233", here.key("of"), message)
                    .note("deflections are computed at each position separately")
                    .help("use a measure that depends on positions only");
                false
            }
            MeasureKind::Dexterity { points, drivers, .. } => {
                self.is_one_jacobian(points, drivers, name, here)
            }
            MeasureKind::Slope { of, over, driver, together, opposed } => {
                if !self.is_one_motion(*driver, [together, opposed], name, here) {
                    return false;
                }
                for (key, source) in [("of", *of), ("over", *over)] {
                    if !self.model.known(source).by_position {
                        let what = self.model.output_name(source);
                        self.fault(
                            "HP0233",
                            here.key(key),
                            format!("`{name}` needs the slope of `{what}`, which is not known"),
                        )
                        .note("slopes over a driver exist only for measures that depend on positions only")
                        .help("use measures that are not rates, velocities or slopes themselves");
                        return false;
                    }
                }
                true
            }
            of_bodies!()
            | loads!()
            | MeasureKind::Compliance { .. }
            | MeasureKind::Wheel { .. }
            | MeasureKind::Axle { .. } => true,
        }
    }

    /// HP0274: a driver that a slope names twice, or drivers of lengths and angles together.
    fn is_one_motion(
        &mut self,
        driver: DriverId,
        others: [&Option<Vec<DriverId>>; 2],
        name: &str,
        here: Here,
    ) -> bool {
        let quantity = |d: DriverId| self.model.driven(&self.model.drivers[d.0]).quantity;
        let mut moving = vec![driver];
        for (key, d) in ["together", "opposed"]
            .into_iter()
            .zip(others)
            .flat_map(|(key, list)| list.iter().flatten().map(move |d| (key, *d)))
        {
            let other = &self.model.drivers[d.0].name;
            let (message, help) = if moving.contains(&d) {
                (format!("`{name}` moves driver `{other}` twice"), "name each driver once")
            } else if quantity(d) != quantity(driver) {
                let first = &self.model.drivers[driver.0].name;
                let message = format!(
                    "`{name}` moves `{first}` and `{other}` by the same amount, a length and an angle"
                );
                (message, "name drivers of lengths only, or of angles only")
            } else {
                moving.push(d);
                continue;
            };
            self.fault("HP0274", here.key(key), message).help(help);
            return false;
        }
        true
    }

    /// HP0274: points of several bodies, no driver or too many, lengths and angles mixed.
    fn is_one_jacobian(&mut self, points: &[PointId], drivers: &[DriverId], name: &str, here: Here) -> bool {
        let body = |p: &PointId| self.model.points[p.0].body;
        let quantity = |d: &DriverId| self.model.driven(&self.model.drivers[d.0]).quantity;
        let most = JacobianValue::MOST_DRIVERS;
        let are_alike = |same: &dyn Fn(usize, usize) -> bool, n: usize| (1..n).all(|k| same(0, k));
        let (key, message, help) = if points.is_empty() {
            ("points", "has no point".to_owned(), "add a point of the body, or two or three for its rotation")
        } else if !are_alike(&|a, b| body(&points[a]) == body(&points[b]), points.len()) {
            ("points", "has points of several bodies".into(), "use points of one body")
        } else if drivers.is_empty() || drivers.len() > most {
            let message = format!("has {} drivers instead of 1 to {most}", drivers.len());
            ("drivers", message, "list the drivers that move the body under `drivers`")
        } else if drivers.iter().enumerate().any(|(k, d)| drivers[..k].contains(d)) {
            ("drivers", "has a driver twice".into(), "list each driver once")
        } else if !are_alike(&|a, b| quantity(&drivers[a]) == quantity(&drivers[b]), drivers.len()) {
            let message = "has drivers of lengths and of angles, whose speeds do not compare".into();
            ("drivers", message, "list drivers of one kind under `drivers`, and use a measure for each kind")
        } else {
            return true;
        };
        self.fault("HP0274", here.key(key), format!("measure `{name}` {message}")).help(help);
        false
    }

    /// Returns a combination with its units; the units of its inputs are known.
    fn in_units(&self, c: &Combination) -> Combination {
        let per_metre = c.expression.per_metre();
        let per_unit = |d: Dimension| per_metre.powi(d.length_in_units().into());
        let dimensions: Vec<Dimension> = c.sources().map(|s| self.model.dimension(s)).collect();
        let dimension = dimension_of(&c.expression, &dimensions);
        let inputs = c.sources().zip(&dimensions).map(|(source, d)| (source, per_unit(*d)));
        Combination { inputs: inputs.collect(), per_unit: per_unit(dimension), dimension, ..c.clone() }
    }
}

/// State of the check of a measure.
#[derive(Clone, Copy)]
enum Visit {
    New,
    Open,
    Done(bool),
}

/// Tolerance of the exponents of a power law.
const HOMOGENEOUS: f64 = 1e-9;

/// Dimension of an expression: the powers by which it grows with the units of length, angle and time of its inputs. If
/// that is not a power law, as in `toe + 3`, the result is a plain number in that unit.
fn dimension_of(expression: &Expression, inputs: &[Dimension]) -> Dimension {
    let value = |powers: &dyn Fn(&Dimension) -> i8, scale: f64| {
        // Arbitrary numbers below 1, so that inverse sines have values.
        let at: Vec<f64> = inputs
            .iter()
            .enumerate()
            .map(|(k, d)| (0.31 + 0.17 / (k as f64 + 1.0)) * scale.powi(powers(d).into()))
            .collect();
        expression.at(&at)
    };
    let power = |powers: &dyn Fn(&Dimension) -> i8| {
        let base = value(powers, 1.0);
        let exponent = |scale: f64| (value(powers, scale) / base).ln() / scale.ln();
        let (found, again) = (exponent(1.25), exponent(0.75));
        let whole = found.round();
        let holds = |x: f64| (x - whole).abs() < HOMOGENEOUS;
        if holds(found) && holds(again) && whole.abs() < 100.0 { whole as i8 } else { 0 }
    };
    Dimension {
        length: power(&|d| d.length),
        angle: power(&|d| d.angle),
        time: power(&|d| d.time),
        force: power(&|d| d.force),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_measures_what_it_grows_by() {
        let (length, angle) = (Dimension::LENGTH, Dimension::ANGLE);
        let of = |text: &str| {
            let expression = Expression::parse(text).unwrap();
            let inputs = expression.names().iter().map(|name| if name == "b" { angle } else { length });
            dimension_of(&expression, &inputs.collect::<Vec<_>>())
        };
        assert_eq!(of("a - c/2"), length);
        assert_eq!(of("a*b/c"), angle);
        assert_eq!(of("sqrt(a*c)"), length);
        assert_eq!(of("a*sin(b) - max(c, a)"), length);
        assert_eq!(of("a + 3"), Dimension::NUMBER);
        assert_eq!(of("b/(a*c)"), angle.over(length).over(length));
        assert_eq!(of("ln(a/c) + b"), Dimension::NUMBER);
        assert_eq!(dimension_of(&Expression::parse("v/2").unwrap(), &[length.rate(1)]), length.rate(1));
    }
}
