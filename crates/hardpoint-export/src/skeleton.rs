//! The tree that robot formats are made of: which joint carries which body, and which joints close loops.

use std::collections::VecDeque;

use hardpoint::model::{Joint, Model};
use hardpoint::space::Vec3;

use crate::Exported;

/// A tree over the bodies.
pub struct Skeleton<'m> {
    /// The model.
    pub model: &'m Model,
    /// The joint that carries each body, if one does; ground has none.
    pub carrier: Vec<Option<usize>>,
    /// The bodies in an order in which what carries comes first; ground is the first.
    pub order: Vec<usize>,
    /// The joints that close loops.
    pub loops: Vec<usize>,
}

/// The place of a joint on each of its bodies, as drawn.
pub fn places(model: &Model, joint: &Joint) -> [Vec3; 2] {
    joint.at.map(|h| model.hardpoints[h.0].position)
}

/// The axis of a joint, as drawn.
pub fn axis(joint: &Joint) -> Vec3 {
    joint.frames[0].cols[2]
}

impl<'m> Skeleton<'m> {
    /// Of a model; `carries` says which types of joints can carry a body. Those to which nothing leads are named.
    pub fn new(model: &'m Model, carries: &[&str], out: &mut Exported) -> Self {
        let (mut carrier, mut order) = (vec![None; model.bodies.len()], vec![0]);
        let mut seen: Vec<bool> = (0..model.bodies.len()).map(|b| b == 0).collect();
        let mut waiting = VecDeque::from([0]);
        let named: Vec<usize> = model.named_joints().map(|(id, _)| id.0).collect();
        while let Some(body) = waiting.pop_front() {
            for &k in &named {
                let joint = &model.joints[k];
                let [i, j] = joint.bodies.map(|b| b.0);
                // Only from i to j: the coordinate counts that way.
                if i == body && !seen[j] && carries.contains(&joint.kind.name) && is_closed(model, joint) {
                    seen[j] = true;
                    carrier[j] = Some(k);
                    order.push(j);
                    waiting.push_back(j);
                }
            }
        }
        for (body, _) in seen.iter().enumerate().filter(|(_, s)| !**s) {
            out.unsaid(
                "body",
                &model.bodies[body].name,
                "no joint that the format has carries it from a body that stands",
            );
        }
        let has = |b: usize| seen[b];
        let loops = named.iter().copied().filter(|k| {
            let joint = &model.joints[*k];
            !carrier.contains(&Some(*k)) && joint.bodies.iter().all(|b| has(b.0))
        });
        let loops = loops.collect();
        for &k in named.iter().filter(|k| model.joints[**k].bodies.iter().any(|b| !has(b.0))) {
            out.unsaid("joint", &model.joints[k].name, "a body that it connects is not written");
        }
        Self { model, carrier, order, loops }
    }

    /// Where the frame of a body's element is: at the joint that carries it.
    pub fn origin(&self, body: usize) -> Vec3 {
        self.carrier[body].map_or_else(Vec3::zero, |k| places(self.model, &self.model.joints[k])[1])
    }
}

/// Whether both places of a joint are one.
pub fn is_closed(model: &Model, joint: &Joint) -> bool {
    let [i, j] = places(model, joint);
    i == j
}

/// A coupler of two joints with one coordinate each.
pub struct Follower {
    /// The coupler's name.
    pub name: String,
    /// The number of the joint that follows.
    pub own: usize,
    /// That of the one which it follows.
    pub master: usize,
    /// By what factor.
    pub factor: f64,
}

/// The couplers by which one joint follows another; the names of all others are handed back.
pub fn followers(model: &Model) -> (Vec<Follower>, Vec<String>) {
    let (mut two, mut other) = (Vec::new(), Vec::new());
    for coupler in &model.couplers {
        let single = |k: usize| model.joints[k].kind.coordinates.len() == 1;
        match &coupler.terms[..] {
            [a, b] if single(a.joint.0) && single(b.joint.0) && a.coefficient != 0.0 => {
                let factor = -b.coefficient / a.coefficient;
                two.push(Follower { name: coupler.name.clone(), own: a.joint.0, master: b.joint.0, factor });
            }
            _ => other.push(coupler.name.clone()),
        }
    }
    (two, other)
}
