//! Checks of shapes and clearances.

use std::sync::Arc;

use crate::draft::{
    BetweenDraft, BodyShapeDraft, BodyShapeKindDraft, ClearanceDraft, DraftLocation, EndsDraft, NumberDraft,
    Section, matches_pattern,
};
use crate::model::{
    BodyId, BodyPoint, Clearance, ClearanceId, Joint, Length, PointId, Shape, ShapeId, ShapeKind, ShapePair,
};

use crate::space::{Surface, Vec3, hull};

use super::{Checker, Here, SAME_POINT, UNPLACED};

impl Checker<'_> {
    pub(super) fn add_shapes(&mut self) {
        let draft = self.draft;
        for (index, written) in draft.shapes.iter().enumerate() {
            let here = Here { section: Section::Shapes, index };
            let shape = self.one_shape(written, here);
            self.shape_ids.push(shape.as_ref().map(|_| ShapeId(self.model.shapes.len())));
            self.model.shapes.extend(shape);
        }
    }

    /// Resolves a shape; `None` if it is faulty.
    fn one_shape(&mut self, written: &BodyShapeDraft, here: Here) -> Option<Shape> {
        let name = &written.name;
        let faults = self.faults.len();
        let round = match &written.round {
            Some(round) => Some(self.length(round, name, here, "radius")?),
            None => None,
        };
        let kind = match &written.kind {
            BodyShapeKindDraft::Unread => return None,
            BodyShapeKindDraft::Sphere { centre } => {
                ShapeKind::Sphere { centre: self.point(centre, name, here.key("sphere"))? }
            }
            BodyShapeKindDraft::Capsule { ends } => {
                ShapeKind::Capsule { ends: self.ends(ends, name, here, "capsule")? }
            }
            BodyShapeKindDraft::Ring { centre, axis, radius } => {
                let centre = self.point(centre, name, here.key("ring"));
                let axis = self.line(axis, name, here, "axis");
                let radius = self.length(radius, name, here, "radius");
                ShapeKind::Ring { centre: centre?, axis: axis?.0, radius: radius? }
            }
            BodyShapeKindDraft::Cylinder { ends, radius } => {
                let ends = self.ends(ends, name, here, "cylinder");
                let radius = self.length(radius, name, here, "radius");
                ShapeKind::Cylinder { ends: ends?, radius: radius? }
            }
            BodyShapeKindDraft::Tyre { wheel, width } => {
                let wheel = self.wheel_named(wheel, here.key("wheel"));
                let width = self.length(width, name, here, "width");
                ShapeKind::Tyre { wheel: wheel?, width: width? }
            }
            BodyShapeKindDraft::Plane { point, normal } => {
                let point = self.point(point, name, here.key("plane"));
                let normal = self.line(normal, name, here, "normal");
                ShapeKind::Plane { point: point?, normal: normal?.0 }
            }
            BodyShapeKindDraft::Hull { points } => {
                let found: Vec<_> = (points.iter().enumerate())
                    .map(|(k, p)| self.point(p, name, here.item("hull", k)))
                    .collect();
                self.hull(name, found.into_iter().collect::<Option<_>>()?, here)?
            }
            BodyShapeKindDraft::Mesh { body, vertices, triangles, in_body } => {
                let body = self.body(body, here.key("body"))?;
                let frame = self.model.bodies[body.0].frame.inverse();
                let local = |p: &Vec3| if *in_body { *p } else { frame.point(*p) };
                let surface = Surface::new(vertices.iter().map(local).collect(), triangles.clone());
                ShapeKind::Mesh { body, surface: Arc::new(surface) }
            }
        };
        self.check_extent(name, &kind, round, here);
        (self.faults.len() == faults).then(|| Shape {
            name: name.clone(),
            group: written.group.clone(),
            kind,
            round,
        })
    }

    /// The hull of points: HP0263 if they lie in one plane.
    fn hull(&mut self, name: &str, points: Vec<PointId>, here: Here) -> Option<ShapeKind> {
        let places: Option<Vec<Vec3>> =
            points.iter().map(|p| self.position(self.model.points[p.0].at)).collect();
        let Some(facets) = hull(&places?) else {
            self.fault("HP0263", here.key("hull"), format!("the points of shape `{name}` lie in one plane"))
                .help("give at least four points that do not, or a `mesh`");
            return None;
        };
        Some(ShapeKind::Hull { points, facets })
    }

    fn length(&mut self, number: &NumberDraft, name: &str, here: Here, key: &'static str) -> Option<Length> {
        if self.unread(here, key) {
            return None;
        }
        self.element_number(number, name, key, here.key(key)).map(Length)
    }

    /// Ends of a capsule or cylinder: two points, or the ends of a rod, leg or spring.
    fn ends(&mut self, ends: &EndsDraft, name: &str, here: Here, key: &'static str) -> Option<[PointId; 2]> {
        let of = match ends {
            EndsDraft::Points(points) => {
                let [a, b] = [0, 1].map(|k| self.point(&points[k], name, here.item(key, k)));
                return Some([a?, b?]);
            }
            EndsDraft::Of(of) => of,
        };
        let force = self.model.elements.iter().find(|e| !e.kind.has_mass() && e.name == *of);
        let points =
            force.and_then(|e| e.kind.force(&self.model)).map(|force| force.acts_on.points(&self.model));
        if let Some([Some(a), Some(b)]) = points {
            return Some([a, b]);
        }
        let draft = self.draft;
        let Some(k) = draft.joints.iter().position(|j| j.name == *of) else {
            let message = format!("there is no rod, leg or spring named `{of}`");
            self.fault("HP0204", here.key(key), message).help(
                "name a joint or force with two ends, or give two points: `body = \"coupler\", capsule = [\"B\", \"C\"]`",
            );
            return None;
        };
        let joint = &self.model.joints[self.joint_ids[k]?.0];
        if joint.at[0] == joint.at[1] || joint.at.contains(&UNPLACED) {
            let message = format!("joint `{of}` has no two ends");
            self.fault("HP0263", here.key(key), message)
                .help("name a rod, a leg or a spring, or give two points of a body");
            return None;
        }
        let ends = [0, 1].map(|end| (joint.bodies[end], joint.at[end]));
        Some(ends.map(|(body, at)| {
            self.model.points.push(BodyPoint { name: name.into(), body, at, unnamed: true });
            PointId(self.model.points.len() - 1)
        }))
    }

    /// HP0263: a shape without extent, with ends that coincide, or rounder than it is large.
    fn check_extent(&mut self, name: &str, kind: &ShapeKind, round: Option<Length>, here: Here) {
        let value = |n: Length| self.model.numbers[n.0.0].value;
        let length = |[a, b]: [PointId; 2]| {
            let [p, q] = [a, b].map(|p| &self.model.points[p.0]);
            // Between two bodies the ends only coincide in the design configuration.
            let apart = self.position(p.at).zip(self.position(q.at)).map(|(p, q)| (q - p).norm());
            apart.filter(|_| p.body == q.body)
        };
        // The size that must be positive, the largest rounding, and the name of the rounding.
        let (size, most, rounding) = match kind {
            ShapeKind::Sphere { .. } | ShapeKind::Capsule { .. } => (None, f64::INFINITY, "radius"),
            ShapeKind::Plane { .. } | ShapeKind::Hull { .. } | ShapeKind::Mesh { .. } => {
                (None, f64::INFINITY, "round")
            }
            ShapeKind::Ring { radius, .. } => (Some((value(*radius), "radius")), value(*radius), "round"),
            ShapeKind::Cylinder { radius, ends } => {
                let half = 0.5 * length(*ends).unwrap_or(f64::INFINITY);
                (Some((value(*radius), "radius")), value(*radius).min(half), "round")
            }
            ShapeKind::Tyre { width, wheel } => {
                let radius = self.model.wheels[wheel.0].radius;
                (Some((value(*width), "width")), radius.min(0.5 * value(*width)), "round")
            }
        };
        let ends = match *kind {
            ShapeKind::Capsule { ends } => Some((ends, "capsule")),
            ShapeKind::Cylinder { ends, .. } => Some((ends, "cylinder")),
            ShapeKind::Sphere { .. }
            | ShapeKind::Ring { .. }
            | ShapeKind::Tyre { .. }
            | ShapeKind::Plane { .. }
            | ShapeKind::Hull { .. }
            | ShapeKind::Mesh { .. } => None,
        };
        let round = round.map_or(0.0, value);
        let coincide =
            ends.filter(|(ends, _)| length(*ends).is_some_and(|d| d <= SAME_POINT * self.extent.size()));
        if let Some((_, key)) = coincide {
            self.fault("HP0263", here.key(key), format!("both ends of shape `{name}` are at one place"))
                .help("give two places, or a `sphere`");
        } else if let Some((_, key)) = size.filter(|(size, _)| !(*size > 0.0)) {
            self.fault("HP0263", here.key(key), format!("the {key} of shape `{name}` is not positive"))
                .help(format!("give a positive {key}, in the file's length unit"));
        } else if !(round >= 0.0) {
            self.fault("HP0263", here.key(rounding), format!("the {rounding} of shape `{name}` is negative"))
                .help("give 0 or more, in the file's length unit");
        } else if round > most {
            let message = format!("the {rounding} of shape `{name}` is larger than the shape");
            self.fault("HP0263", here.key(rounding), message)
                .help("give at most its radius, and at most half of its width");
        }
    }

    pub(super) fn add_clearances(&mut self) {
        let draft = self.draft;
        for (index, written) in draft.clearances.iter().enumerate() {
            let here = Here { section: Section::Clearances, index };
            let clearance = self.one_clearance(written, here);
            self.clearance_ids.push(clearance.as_ref().map(|_| ClearanceId(self.model.clearances.len())));
            self.model.clearances.extend(clearance);
        }
    }

    /// Returns the clearance of this name; `None`, without a second error, if the clearance itself is faulty.
    pub(super) fn clearance_named(&mut self, name: &str, at: DraftLocation) -> Option<ClearanceId> {
        let draft = self.draft;
        let k = self.find("clearance", name, at, draft.clearances.iter().map(|c| c.name.as_str()))?;
        self.clearance_ids[k]
    }

    /// Resolves a clearance; `None` if it is faulty.
    fn one_clearance(&mut self, written: &ClearanceDraft, here: Here) -> Option<Clearance> {
        if self.shape_ids.iter().any(Option::is_none) || self.is_table_unread("shape") {
            return None;
        }
        let faults = self.faults.len();
        let count = self.model.shapes.len();
        let all: Vec<ShapeId> = (0..count).map(ShapeId).collect();
        let (sides, named) = match &written.between {
            BetweenDraft::All => ([all.clone(), all], false),
            BetweenDraft::Sides(sides) => {
                let found = [0, 1].map(|k| self.shapes_of(&sides[k], here.item("between", k)));
                let [a, b] = found;
                let ((a, of_shapes), (b, as_well)) = (a?, b?);
                ([a, b], of_shapes && as_well)
            }
        };
        let ignored: Vec<[Vec<ShapeId>; 2]> = (written.ignore.iter().enumerate())
            .filter_map(|(k, pair)| {
                let [a, b] = [0, 1]
                    .map(|side| self.shapes_of(std::slice::from_ref(&pair[side]), here.item("ignore", k)));
                Some([a?.0, b?.0])
            })
            .collect();
        let minima: Vec<(Vec<ShapeId>, f64)> = written
            .min
            .of
            .iter()
            .filter_map(|(name, min)| {
                Some((self.shapes_of(std::slice::from_ref(name), here.key("min"))?.0, *min))
            })
            .collect();
        let given = written.min.default.into_iter().chain(minima.iter().map(|m| m.1));
        if given.chain(written.beyond).any(|x| !x.is_finite()) {
            let message = format!("a distance of clearance `{}` is not a finite number", written.name);
            self.fault("HP0202", here.key("min"), message);
        }
        if self.faults.len() > faults {
            return None;
        }
        let mut pairs: Vec<ShapePair> = Vec::new();
        let mut only_neighbours = false;
        for &a in &sides[0] {
            for &b in &sides[1] {
                let shapes = if a <= b { [a, b] } else { [b, a] };
                let is_ignored = ignored
                    .iter()
                    .any(|[p, q]| p.contains(&a) && q.contains(&b) || p.contains(&b) && q.contains(&a));
                if a == b
                    || is_ignored
                    || pairs.iter().any(|pair| pair.shapes == shapes)
                    || !self.moves(shapes)
                {
                    continue;
                }
                if !named && self.are_neighbours(shapes) {
                    only_neighbours = true;
                    continue;
                }
                let own = minima.iter().filter(|(of, _)| shapes.iter().any(|s| of.contains(s))).map(|m| m.1);
                let min = own.reduce(f64::max).or(written.min.default);
                // In the order of the sides, so that results name the first side first.
                pairs.push(ShapePair { shapes, min });
            }
        }
        if pairs.is_empty() {
            let message = format!("clearance `{}` has no pair of shapes", written.name);
            let note = if only_neighbours {
                "shapes of bodies that share a joint count only where both are named as shapes"
            } else {
                "two shapes count if they move relative to each other and are not both planes"
            };
            self.fault("HP0264", here.key("between"), message)
                .note(note)
                .help("name shapes of two bodies, like `between = [\"rod\", \"screw*\"]`");
            return None;
        }
        Some(Clearance { name: written.name.clone(), pairs, beyond: written.beyond })
    }

    /// Shapes by names, patterns with `*`, names of bodies or groups; and true if all of them are named as shapes.
    fn shapes_of(&mut self, names: &[String], at: DraftLocation) -> Option<(Vec<ShapeId>, bool)> {
        let mut found: Vec<ShapeId> = Vec::new();
        let mut as_shapes = true;
        for name in names {
            let model = &self.model;
            let matching = |of: &dyn Fn(&Shape) -> bool| -> Vec<ShapeId> {
                (0..model.shapes.len()).map(ShapeId).filter(|s| of(&model.shapes[s.0])).collect()
            };
            let on_body = |s: &Shape| s.bodies(model).iter().any(|b| model.bodies[b.0].name == *name);
            let by_name = matching(&|s| matches_pattern(name, &s.name));
            let is_shape = !by_name.is_empty();
            let these = if is_shape {
                by_name
            } else {
                matching(&|s| s.group.as_deref() == Some(name) || on_body(s))
            };
            if these.is_empty() {
                let draft = self.draft;
                self.find("shape", name, at, draft.shapes.iter().map(|s| s.name.as_str()));
                return None;
            }
            as_shapes &= is_shape;
            found.extend(these.into_iter().filter(|s| !found.contains(s)).collect::<Vec<_>>());
        }
        Some((found, as_shapes))
    }

    /// True if two shapes may move relative to each other, and have a distance.
    fn moves(&self, shapes: [ShapeId; 2]) -> bool {
        let [a, b] = shapes.map(|s| &self.model.shapes[s.0]);
        let are_planes = [a, b].iter().all(|s| matches!(s.kind, ShapeKind::Plane { .. }));
        let are_rigid = match (&a.bodies(&self.model)[..], &b.bodies(&self.model)[..]) {
            ([p], [q]) => p == q,
            // Two rods between the same bodies turn about their own ends, unless these are the same.
            _ => self.have_the_same_ends([a, b]),
        };
        !are_planes && !are_rigid
    }

    /// True if two shapes between two bodies have their ends at the same points, in either order.
    fn have_the_same_ends(&self, shapes: [&Shape; 2]) -> bool {
        let ends = shapes.map(|s| match s.kind {
            ShapeKind::Capsule { ends } | ShapeKind::Cylinder { ends, .. } => Some(ends.map(|p| {
                let point = &self.model.points[p.0];
                (point.body, point.at)
            })),
            ShapeKind::Sphere { .. }
            | ShapeKind::Ring { .. }
            | ShapeKind::Tyre { .. }
            | ShapeKind::Plane { .. }
            | ShapeKind::Hull { .. }
            | ShapeKind::Mesh { .. } => None,
        });
        let [Some([a, b]), Some([c, d])] = ends else { return false };
        (a, b) == (c, d) || (a, b) == (d, c)
    }

    /// True if bodies of two shapes share a joint.
    fn are_neighbours(&self, shapes: [ShapeId; 2]) -> bool {
        let [a, b] = shapes.map(|s| self.model.shapes[s.0].bodies(&self.model));
        let joined = |p: BodyId, q: BodyId| {
            let on_both =
                |joint: &Joint| !joint.unnamed && joint.bodies.contains(&p) && joint.bodies.contains(&q);
            p == q || self.model.joints.iter().any(on_both)
        };
        a.iter().any(|p| b.iter().any(|q| joined(*p, *q)))
    }
}
