//! A design laid out in the order in which the plan walks it.

use crate::constraint::Row;
use crate::law::Law;
use crate::model::{BodyId, Curve, GROUND, Geometry, Model};
use crate::space::{LANES, Mat3, Pose, Real, Vec3};
use crate::topology::Topology;

/// Marker poses per link and per closure, one design per lane.
///
/// A body is known by the marker of the link that places it: all others are given as seen from that one.
#[derive(Clone, Debug)]
pub(crate) struct Parts<T> {
    /// Per link: the marker on the parent.
    pub parent_marker: Poses<T>,
    /// Per link: the child's own frame.
    pub child_from_marker: Poses<T>,
    /// Per closure: marker i on body i, and marker j on body j.
    pub ends: [Poses<T>; 2],
    /// Per row: what it keeps of the design configuration, like the length of a rod; 0 where it keeps nothing.
    pub kept: Vec<T>,
    /// Curves, in the order of [`crate::topology::Closure::contact`].
    pub curves: Vec<Curve>,
    /// Per driver, the law of every lane; one where all lanes have the same.
    laws: Vec<Vec<Law>>,
}

/// Poses of one design, or of one per lane.
#[derive(Clone, Debug)]
pub(crate) enum Poses<T> {
    /// The same in all lanes: an eighth of the memory to read.
    Same(Vec<Pose>),
    Each(Vec<Pose<T>>),
}

impl<T: Real> Poses<T> {
    #[inline(always)]
    pub fn get(&self, k: usize, witness: T) -> Pose<T> {
        match self {
            Self::Same(poses) => poses[k].spread(witness),
            Self::Each(poses) => poses[k],
        }
    }
}

/// All poses of a design, or of the designs in all lanes.
struct Layout<U> {
    parent_marker: Vec<Pose<U>>,
    child_from_marker: Vec<Pose<U>>,
    ends: [Vec<Pose<U>>; 2],
}

impl<U: Real> Layout<U> {
    fn new(model: &Model, topology: &Topology, marker: impl Fn(usize, usize) -> Pose<U>, witness: U) -> Self {
        // Per body, its frame as seen from the marker that places it.
        let mut seen = vec![Pose::IDENTITY.spread(witness); model.bodies.len()];
        for link in &topology.links {
            if let Some(j) = link.joint {
                // The freedoms end in a frame that is parallel to their first one in the design configuration;
                // where the joint's own markers are not, the child's is turned back.
                let frames = &model.joints[j.0].frames;
                let (parent, child) = (frames[link.parent_end], frames[1 - link.parent_end]);
                let mut m = marker(j.0, 1 - link.parent_end);
                if parent != child {
                    m.rot = m.rot * (child.transpose() * parent).spread(witness);
                }
                seen[link.child.0] = m.inverse();
            }
        }
        let on = |body: BodyId, m: Pose<U>| if body == GROUND { m } else { seen[body.0].compose(m) };
        let ends = |end: usize| {
            topology.closures.iter().map(|c| on(c.bodies[end], marker(c.joint.0, end))).collect()
        };
        Self {
            parent_marker: topology
                .links
                .iter()
                .map(|l| match l.joint {
                    Some(j) => on(l.parent, marker(j.0, l.parent_end)),
                    None => model.bodies[l.child.0].frame.spread(witness),
                })
                .collect(),
            child_from_marker: topology.links.iter().map(|l| seen[l.child.0]).collect(),
            ends: [ends(0), ends(1)],
        }
    }
}

impl<T: Real> Parts<T> {
    /// One design in any number, without laws.
    pub fn of(model: &Model, topology: &Topology, design: &Geometry<T>, witness: T) -> Self {
        let l = Layout::new(model, topology, |joint, end| design.markers[joint][end], witness);
        Self {
            parent_marker: Poses::Each(l.parent_marker),
            child_from_marker: Poses::Each(l.child_from_marker),
            ends: l.ends.map(Poses::Each),
            kept: kept(topology, |joint, row| design.kept[joint].by(row)),
            curves: curves(model, topology),
            laws: Vec::new(),
        }
    }

    /// One design, the same in all lanes.
    pub fn same(model: &Model, topology: &Topology, design: &Geometry, laws: &[Law], witness: T) -> Self {
        let l = Layout::new(model, topology, |joint, end| design.markers[joint][end], 0.0);
        Self {
            parent_marker: Poses::Same(l.parent_marker),
            child_from_marker: Poses::Same(l.child_from_marker),
            ends: l.ends.map(Poses::Same),
            kept: kept(topology, |joint, row| witness.like(design.kept[joint].by(row))),
            curves: curves(model, topology),
            laws: laws.iter().map(|law| vec![law.clone()]).collect(),
        }
    }

    /// One design per lane, each with the laws of its drivers; the last one fills the lanes that are left.
    pub fn each(
        model: &Model,
        topology: &Topology,
        designs: &[Geometry],
        laws: &[Vec<Law>],
        witness: T,
    ) -> Self {
        let lane = |k: usize| &designs[k.min(designs.len() - 1)];
        let gather = |joint: usize, end: usize| Pose::gather(witness, |k| lane(k).markers[joint][end]);
        let l = Layout::new(model, topology, gather, witness);
        let of_driver = |d: usize| {
            let same = laws.iter().all(|of_lane| of_lane[d] == laws[0][d]);
            let lanes = if same { &laws[..1] } else { laws };
            lanes.iter().map(|of_lane| of_lane[d].clone()).collect()
        };
        Self {
            parent_marker: Poses::Each(l.parent_marker),
            child_from_marker: Poses::Each(l.child_from_marker),
            ends: l.ends.map(Poses::Each),
            kept: kept(topology, |joint, row| witness.like_lanes(|k| lane(k).kept[joint].by(row))),
            curves: curves(model, topology),
            laws: (0..model.drivers.len()).map(of_driver).collect(),
        }
    }

    /// The same geometry in other numbers, one after the other, always in the same order; without laws.
    pub fn map<U: Real>(&self, witness: T, mut f: impl FnMut(T) -> U) -> Parts<U> {
        let mut pose = |pose: Pose<T>| {
            let mut vector = |v: Vec3<T>| Vec3::new(f(v.x), f(v.y), f(v.z));
            Pose { rot: Mat3 { cols: pose.rot.cols.map(&mut vector) }, r: vector(pose.r) }
        };
        let mut poses = |poses: &Poses<T>| {
            let count = match poses {
                Poses::Same(list) => list.len(),
                Poses::Each(list) => list.len(),
            };
            Poses::Each((0..count).map(|k| pose(poses.get(k, witness))).collect())
        };
        let (parent_marker, child_from_marker) = (poses(&self.parent_marker), poses(&self.child_from_marker));
        let ends = [poses(&self.ends[0]), poses(&self.ends[1])];
        let kept = self.kept.iter().map(|x| f(*x)).collect();
        Parts { parent_marker, child_from_marker, ends, kept, curves: self.curves.clone(), laws: Vec::new() }
    }

    /// All numbers of the geometry, in the order of [`Parts::map`].
    pub fn numbers(&self, witness: T) -> Vec<T> {
        let mut numbers = Vec::new();
        self.map(witness, |x| {
            numbers.push(x);
            x
        });
        numbers
    }

    /// The laws of driver d: one per lane, or one for all.
    pub fn laws_of(&self, d: usize) -> &[Law] {
        &self.laws[d]
    }

    /// The law of driver d in lane k.
    pub fn law_of(&self, d: usize, k: usize) -> &Law {
        &self.laws[d][k.min(self.laws[d].len() - 1)]
    }

    /// How far driver d gets from a value, at most, from one time to another.
    pub fn travel(&self, d: usize, from: f64, to: f64, value: T) -> f64 {
        let laws = self.laws[d].iter().enumerate();
        laws.map(|(k, law)| law.over(from, to).value.reach_from(value.lane(k))).fold(0.0, f64::max)
    }

    /// The fastest that driver d moves from one time to another.
    pub fn fastest(&self, d: usize, from: f64, to: f64) -> f64 {
        self.laws[d].iter().map(|law| law.fastest(from, to)).fold(0.0, f64::max)
    }

    /// The same at one time per lane, where all lanes have the same law.
    #[inline(always)]
    pub fn law_at_times(&self, d: usize, times: T) -> [T; 3] {
        self.laws[d][0].to_order(times).derivatives()
    }

    /// Value, speed and acceleration that driver d prescribes at time t.
    pub fn law(&self, d: usize, t: f64, witness: T) -> [T; 3] {
        if let [law] = &self.laws[d][..] {
            let [f, fd, fdd, _] = law.at(t).derivatives();
            return [f, fd, fdd].map(|x| witness.like(x));
        }
        let all: [[f64; 4]; LANES] = std::array::from_fn(|k| self.law_of(d, k).at(t).derivatives());
        std::array::from_fn(|order| witness.like_lanes(|k| all[k][order]))
    }
}

/// Per row, what it keeps.
fn kept<T: Real>(topology: &Topology, of: impl Fn(usize, Row) -> T) -> Vec<T> {
    let of_row = |place: &crate::topology::RowPlace| {
        let closure = &topology.closures[place.closure];
        of(closure.joint.0, closure.rows[place.index])
    };
    topology.rows.iter().map(of_row).collect()
}

/// The curves that the plan's closures follow.
fn curves(model: &Model, topology: &Topology) -> Vec<Curve> {
    let contacts = topology.closures.iter().filter(|c| c.contact.is_some());
    contacts.filter_map(|c| model.joints[c.joint.0].curve.clone()).collect()
}
