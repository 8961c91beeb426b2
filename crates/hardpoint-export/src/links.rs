//! Default appearance of bodies: their points, and lines between them.

use hardpoint::model::{Direction, Joint, Model};
use hardpoint::space::Vec3;

/// Points of a body closer than this fraction of the mechanism size coincide.
const SAME_PLACE: f64 = 1e-9;

/// Points of every body in its frame, m: joint locations, bearings of hinges, and named points.
pub fn body_points(model: &Model) -> Vec<Vec<Vec3>> {
    let geometry = model.geometry(&[]);
    let same = SAME_PLACE * model.size();
    let mut places = vec![Vec::<Vec3>::new(); model.bodies.len()];
    let mut add = |body: usize, at: Vec3| {
        let list = &mut places[body];
        if list.iter().all(|other| (*other - at).norm() > same) {
            list.push(at);
        }
    };
    for (id, joint) in model.named_joints() {
        let bearings = match joint.axis {
            // A bearing at both hardpoints that define the axis.
            Some(Direction::Through(a, b)) if joint.kind.is_hinge => vec![a, b],
            _ => Vec::new(),
        };
        for end in 0..2 {
            let body = joint.bodies[end];
            add(body.0, geometry.markers[id.0][end].r);
            let body_from_world = model.bodies[body.0].frame.inverse();
            bearings.iter().for_each(|h| add(body.0, body_from_world.point(model.hardpoints[h.0].position)));
        }
    }
    for (k, point) in model.points.iter().enumerate().filter(|(_, p)| !p.unnamed) {
        add(point.body.0, geometry.points[k]);
    }
    places
}

/// Joints that are rods, each with its two end points in the frames of bodies i and j, m.
pub fn rods(model: &Model) -> impl Iterator<Item = (&Joint, [Vec3; 2])> {
    let geometry = model.geometry(&[]);
    let rods = model.named_joints().filter(|(_, joint)| joint.kind.is_rod());
    rods.map(move |(id, joint)| (joint, [0, 1].map(|end| geometry.markers[id.0][end].r)))
}

/// Lines that connect points: all pairs of up to three points, the shortest tree of more.
pub fn lines(places: &[Vec3]) -> Vec<[Vec3; 2]> {
    let mut lines = Vec::new();
    let mut left: Vec<Vec3> = places.to_vec();
    let Some(first) = left.pop() else { return lines };
    let mut reached = vec![first];
    while !left.is_empty() {
        let pairs = reached.iter().flat_map(|a| left.iter().enumerate().map(move |(k, b)| (*a, k, *b)));
        let nearest = pairs.min_by(|(a, _, b), (c, _, d)| (*a - *b).norm().total_cmp(&(*c - *d).norm()));
        let Some((from, k, to)) = nearest else { break };
        lines.push([from, to]);
        reached.push(to);
        left.swap_remove(k);
    }
    if let [a, b, c] = places {
        let pairs = [[*a, *b], [*b, *c], [*c, *a]];
        lines = pairs.to_vec();
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_places_are_all_connected_and_many_by_the_shortest_tree() {
        let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
        assert_eq!(lines(&[at(0.0, 0.0)]).len(), 0);
        assert_eq!(lines(&[at(0.0, 0.0), at(1.0, 0.0)]).len(), 1);
        assert_eq!(lines(&[at(0.0, 0.0), at(1.0, 0.0), at(5.0, 5.0)]).len(), 3);
        let row = [at(0.0, 0.0), at(3.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(2.0, 0.5)];
        let tree = lines(&row);
        let length: f64 = tree.iter().map(|[a, b]| (*a - *b).norm()).sum();
        assert_eq!((tree.len(), length), (4, 3.5));
    }
}
