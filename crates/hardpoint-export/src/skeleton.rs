//! Spanning tree of a mechanism for robot formats: the joint that carries each body, and the joints that close loops.

use hardpoint::joint::JointType;
use hardpoint::model::{Joint, JointLimit, Model};
use hardpoint::space::Vec3;

use crate::ExportedModel;

/// Spanning tree over the bodies.
pub struct Skeleton<'m> {
    /// The model.
    pub model: &'m Model,
    /// Carrier of each body; `None` for ground and for bodies that are not written.
    pub carrier: Vec<Option<Carrier>>,
    /// Bodies in topological order: a body follows the body that carries it; ground is first.
    pub order: Vec<usize>,
    /// Indices of the joints that close loops (cut joints).
    pub loops: Vec<usize>,
}

/// Joint that carries a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// A joint: its index, and true if the carried body is body i. In the latter case the joint of the format has the
    /// opposite axis, about or along which the coordinate of body i has the same value.
    Joint(usize, bool),
    /// No joint: the body floats, and cut joints constrain it.
    Loops,
}

/// Points of a joint on bodies i and j in the design configuration, m, global.
pub fn joint_points(model: &Model, joint: &Joint) -> [Vec3; 2] {
    joint.at.map(|h| model.hardpoints[h.0].position)
}

/// Axis of a joint in the design configuration, global.
pub fn axis(joint: &Joint) -> Vec3 {
    joint.frames[0].cols[2]
}

impl<'m> Skeleton<'m> {
    /// Creates the tree of a model. `carries` is true of the types of joints that can carry a body, `closes` of those
    /// that can close a loop. Bodies and joints that cannot be written are reported.
    pub fn new(
        model: &'m Model,
        carries: impl Fn(&JointType) -> bool,
        closes: impl Fn(&JointType) -> bool,
        out: &mut ExportedModel,
    ) -> Self {
        let mut tree =
            Self { model, carrier: vec![None; model.bodies.len()], order: vec![0], loops: Vec::new() };
        let named: Vec<usize> = model.named_joints().map(|(id, _)| id.0).collect();
        let bodies = |k: usize| model.joints[k].bodies.map(|b| b.0);
        let can_close = |k: usize| closes(model.joints[k].kind);
        let can_carry = |k: usize| carries(model.joints[k].kind) && is_closed(model, &model.joints[k]);
        // Order of preference: joints that cannot close a loop, in either direction; joints from body i to body j,
        // which keep the sign of the coordinate; joints from body j to body i; and last, floating bodies that cut
        // joints constrain.
        let rank = |tree: &Self, k: usize| {
            let [i, j] = bodies(k).map(|b| tree.has(b));
            let backward = j;
            (i != j && can_carry(k)).then(|| (can_close(k), backward))
        };
        loop {
            let ranked = named.iter().filter_map(|k| Some((rank(&tree, *k)?, *k)));
            let floating = || {
                let mut ends = named.iter().filter(|k| can_close(**k)).map(|k| bodies(*k));
                ends.find(|[i, j]| tree.has(*i) != tree.has(*j)).map(|[i, j]| if tree.has(i) { j } else { i })
            };
            match (ranked.min(), floating()) {
                (Some(((_, backward), k)), _) => {
                    tree.add(bodies(k)[usize::from(!backward)], Carrier::Joint(k, backward));
                }
                (None, Some(body)) => tree.add(body, Carrier::Loops),
                (None, None) => break,
            }
        }
        for (body, _) in model.bodies.iter().enumerate().filter(|(b, _)| !tree.has(*b)) {
            out.report_unsupported(
                "body",
                &model.bodies[body].name,
                "no joint that the format supports connects it to a body that is written",
            );
        }
        for &k in &named {
            let is_carrier =
                tree.carrier.iter().any(|c| matches!(c, Some(Carrier::Joint(own, _)) if *own == k));
            if !bodies(k).iter().all(|b| tree.has(*b)) {
                out.report_unsupported("joint", &model.joints[k].name, "one of its bodies is not written");
            } else if !is_carrier {
                tree.loops.push(k);
            }
        }
        tree
    }

    fn has(&self, body: usize) -> bool {
        body == 0 || self.carrier[body].is_some()
    }

    fn add(&mut self, body: usize, by: Carrier) {
        self.carrier[body] = Some(by);
        self.order.push(body);
    }

    /// Returns the body that carries a body.
    pub fn outer(&self, body: usize) -> usize {
        match self.carrier[body] {
            Some(Carrier::Joint(k, backward)) => self.model.joints[k].bodies[usize::from(backward)].0,
            _ => 0,
        }
    }

    /// Returns true if the joint carries a body.
    pub fn is_carrier(&self, joint: usize) -> bool {
        self.carrier.iter().any(|c| matches!(c, Some(Carrier::Joint(k, _)) if *k == joint))
    }

    /// Origin of the frame of a body's element, m, global: at the joint that carries the body, or otherwise at a cut
    /// joint.
    pub fn origin(&self, body: usize) -> Vec3 {
        let on = |k: usize| {
            let joint = &self.model.joints[k];
            joint.bodies.iter().position(|b| b.0 == body).map(|end| joint_points(self.model, joint)[end])
        };
        match self.carrier[body] {
            Some(Carrier::Joint(k, _)) => on(k),
            Some(Carrier::Loops) => self.loops.iter().find_map(|k| on(*k)),
            None => None,
        }
        .unwrap_or_else(Vec3::zero)
    }
}

/// Ends of the range of a coordinate of a joint, SI; infinite where the range is open, `None` without a limit.
pub fn range_of(model: &Model, joint: usize, coordinate: usize) -> Option<[f64; 2]> {
    let is_it = |limit: &&JointLimit| limit.joint.0 == joint && limit.coordinate == Some(coordinate);
    model.joint_limits.iter().find(is_it).map(ends)
}

/// Both ends of a range, infinite where it is open.
pub fn ends(limit: &JointLimit) -> [f64; 2] {
    [limit.min.unwrap_or(f64::NEG_INFINITY), limit.max.unwrap_or(f64::INFINITY)]
}

/// Magnitude that represents an open end: importers take it as none.
const OPEN: f64 = 1e16;

/// A number with an open end as a large number.
pub fn bounded(x: f64) -> String {
    crate::number(x.clamp(-OPEN, OPEN))
}

/// Returns true if the points of a joint on both bodies coincide in the design configuration.
pub fn is_closed(model: &Model, joint: &Joint) -> bool {
    let [i, j] = joint_points(model, joint);
    i == j
}

/// Coupler of two joints with one coordinate each: `own = factor * master + constant`.
pub struct Follower {
    /// Name of the coupler.
    pub name: String,
    /// Index of the dependent joint.
    pub own: usize,
    /// Index of the independent joint.
    pub master: usize,
    /// Factor.
    pub factor: f64,
    /// Constant, rad or m.
    pub constant: f64,
}

/// Returns the couplers of two tree joints, and the names of all other couplers.
pub fn followers(tree: &Skeleton<'_>) -> (Vec<Follower>, Vec<String>) {
    let (mut two, mut other) = (Vec::new(), Vec::new());
    for coupler in &tree.model.couplers {
        let single = |k: usize| tree.model.joints[k].kind.coordinates.len() == 1 && tree.is_carrier(k);
        match &coupler.terms[..] {
            [a, b] if single(a.joint.0) && single(b.joint.0) && a.coefficient != 0.0 => {
                let factor = -b.coefficient / a.coefficient;
                let constant = coupler.constant / a.coefficient;
                two.push(Follower {
                    name: coupler.name.clone(),
                    own: a.joint.0,
                    master: b.joint.0,
                    factor,
                    constant,
                });
            }
            _ => other.push(coupler.name.clone()),
        }
    }
    (two, other)
}
