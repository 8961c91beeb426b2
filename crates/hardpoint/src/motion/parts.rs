//! Geometry of a design in the order of the solution plan.

use crate::design::Geometry;
use crate::law::Law;
use crate::model::{BodyId, Curve, GROUND, Model};
use crate::number;
use crate::space::{Pose, Real};
use crate::topology::{RowPlace, Topology};

/// Marker poses per link and per closure.
///
/// A body is known by the marker of the link that places it: all others are given as seen from that one.
#[derive(Clone, Debug)]
pub(crate) struct PlanGeometry<T> {
    /// Per link: the marker on the parent.
    ///
    /// `M_c,parent^-1 M_p`: the marker M_p as seen from the marker by which the parent is placed (theory (4)).
    pub parent_marker: Vec<Pose<T>>,
    /// Per link: the child's own frame.
    ///
    /// M_c^-1 of theory (4).
    pub child_from_marker: Vec<Pose<T>>,
    /// Per closure: marker i on body i, and marker j on body j.
    ///
    /// M_i and M_j, likewise as seen from the markers by which the bodies are placed.
    pub ends: [Vec<Pose<T>>; 2],
    /// Per row: its constant from the design configuration, such as the length of a rod; 0 if it has none.
    /// L, c0, d0, r0 of the table in theory, section 2; m or a cosine.
    pub kept: Vec<T>,
    /// Curves, in the order of [`crate::topology::Closure::contact`].
    pub curves: Vec<Curve>,
    /// Per driver.
    laws: Vec<Law>,
}

impl<T: Real> PlanGeometry<T> {
    /// Geometry of a design, without laws.
    pub fn of(model: &Model, topology: &Topology, design: &Geometry<T>) -> Self {
        let marker = |joint: usize, end: usize| design.markers[joint][end];
        // Per body, its frame as seen from the marker that places it.
        let mut seen = vec![Pose::IDENTITY.spread(); model.bodies.len()];
        for link in &topology.links {
            if let Some(j) = link.joint {
                // The freedoms end in a frame that is parallel to their first one in the design configuration;
                // where the joint's own markers are not, the child's is turned back.
                let frames = &model.joints[j.0].frames;
                let (parent, child) = (frames[link.parent_end], frames[1 - link.parent_end]);
                let mut m = marker(j.0, 1 - link.parent_end);
                if parent != child {
                    // M_c C_c^T C_p: in the design configuration parallel to the parent's marker, so that J(0) = 1
                    m.rot = m.rot * (child.transpose() * parent).spread();
                }
                seen[link.child.0] = m.inverse();
            }
        }
        let on = |body: BodyId, m: Pose<T>| if body == GROUND { m } else { seen[body.0].compose(m) };
        let ends = |end: usize| {
            topology.closures.iter().map(|c| on(c.bodies[end], marker(c.joint.0, end))).collect()
        };
        Self {
            parent_marker: topology
                .links
                .iter()
                .map(|l| match l.joint {
                    Some(j) => on(l.parent, marker(j.0, l.parent_end)),
                    None => model.bodies[l.child.0].frame.spread(),
                })
                .collect(),
            child_from_marker: topology.links.iter().map(|l| seen[l.child.0]).collect(),
            ends: [ends(0), ends(1)],
            kept: kept(topology, design),
            curves: curves(model, topology),
            laws: Vec::new(),
        }
    }
}

impl PlanGeometry<f64> {
    /// Geometry of a design, with the laws of its drivers.
    pub fn same(model: &Model, topology: &Topology, design: &Geometry, laws: &[Law]) -> Self {
        Self { laws: laws.to_vec(), ..Self::of(model, topology, design) }
    }

    /// This geometry in another scalar type, as constants, without laws.
    pub fn spread<T: Real>(&self) -> PlanGeometry<T> {
        let poses = |poses: &[Pose<f64>]| poses.iter().map(|pose| pose.spread()).collect();
        PlanGeometry {
            parent_marker: poses(&self.parent_marker),
            child_from_marker: poses(&self.child_from_marker),
            ends: number::both(self.ends.each_ref(), |ends| poses(ends)),
            kept: self.kept.iter().map(|x| T::constant(*x)).collect(),
            curves: self.curves.clone(),
            laws: Vec::new(),
        }
    }

    /// The law of driver d.
    pub fn law_of(&self, d: usize) -> &Law {
        &self.laws[d]
    }

    /// Maximum distance of driver d from a value, between two times.
    pub fn travel(&self, d: usize, from: f64, to: f64, value: f64) -> f64 {
        self.laws[d].over(from, to).value.reach_from(value)
    }

    /// Maximum speed of driver d between two times.
    #[inline]
    pub fn fastest(&self, d: usize, from: f64, to: f64) -> f64 {
        // A law times zero rests, even if the law is NaN.
        f64::max(self.laws[d].fastest(from, to), 0.0)
    }

    /// Value, speed and acceleration that driver d prescribes at time t.
    #[inline]
    pub fn law(&self, d: usize, t: f64) -> [f64; 3] {
        let [f, fd, fdd, _] = self.laws[d].at(t).derivatives();
        [f, fd, fdd]
    }
}

/// Constant of each row.
fn kept<T: Real>(topology: &Topology, design: &Geometry<T>) -> Vec<T> {
    let of_row = |place: &RowPlace| {
        let closure = &topology[place.closure];
        // A coupler's sum counts from its constant, by its first term.
        let constant = T::constant(place.constant);
        design.kept[closure.joint.0].by(closure.rows[place.index]) + constant
    };
    topology.rows.iter().map(of_row).collect()
}

/// The curves that the plan's closures follow.
fn curves(model: &Model, topology: &Topology) -> Vec<Curve> {
    let contacts = topology.closures.iter().filter(|c| c.contact.is_some());
    contacts.filter_map(|c| model.joints[c.joint.0].curve.clone()).collect()
}
