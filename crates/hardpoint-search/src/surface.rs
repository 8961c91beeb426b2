//! Closed surface where a function that changes by no more than its place does is zero.
//!
//! A cube that encloses everything is halved; a part whose middle is farther from zero than its corners holds no
//! surface. In cells of the last size the surface is found in six tetrahedra, each cut by triangles whose corners lie
//! exactly on the edges' zeros, so that neighbours share them and the surface is closed (marching tetrahedra: Doi and
//! Koide 1991).

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use hardpoint::space::{Vec3, nearest_of_triangle};

/// The function, as the least of several: `parts[k]` are those that can be the least nearby.
pub trait LeastOf {
    /// Value of part k at a point.
    fn part(&self, k: usize, p: Vec3) -> f64;
    /// Zero of part k that is nearest to a point.
    fn zero(&self, k: usize, p: Vec3) -> Vec3;
    /// Points of part k, none of them outside, at which parts thinner than a cell may end.
    fn corners(&self, k: usize) -> Vec<Vec3>;
}

/// A closed surface of triangles.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Corners, m.
    pub vertices: Vec<Vec3>,
    /// Indices of corners; seen from outside they turn to the left.
    pub triangles: Vec<[u32; 3]>,
    /// Largest distance between the surface and the triangles, at their centres and the middles of their edges, and
    /// from points of the surface to the triangles, m.
    pub deviation: f64,
    /// Points of the surface: the nearest ones to the middles of all cells that may hold some of it.
    pub samples: Vec<Vec3>,
}

impl Triangles {
    /// Enclosed volume, m^3.
    pub fn volume(&self) -> f64 {
        let six = |[a, b, c]: [Vec3; 3]| a.dot(b.cross(c));
        self.corners().map(six).sum::<f64>() / 6.0
    }

    /// Area, m^2.
    pub fn area(&self) -> f64 {
        self.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).norm()).sum()
    }

    /// Corners of all triangles.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [Vec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|k| self.vertices[k as usize]))
    }
}

/// Cells of the last size along each edge of the first cube are 2 to the power of this at most.
const MOST_HALVINGS: u32 = 20;
/// Corners of a cell in units of its size.
const CORNERS: [[u32; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
/// Tetrahedra of a cell by its corners: all have the diagonal from 0 to 7, so that those of neighbours fit.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
/// A zero on an edge is known to this fraction of its length.
const RESOLVED: f64 = 1e-9;
/// Maximum number of steps of the search for a zero: every fourth one halves the interval.
const MOST_STEPS: usize = 120;
/// Maximum number of points without triangles nearby whose distance from all triangles is computed.
const MOST_FAR: usize = 64;
/// Smallest part of an interval by which a step shortens it.
const MARGIN: f64 = 1e-3;

/// Corner of the lattice of cells.
type Node = [u32; 3];

/// The surface of a function of `count` parts within the cube from `low` with edges of `size`, with cells no larger
/// than `cell`. `None` if it has more than `most` cells, if no values of parts are `left` to be evaluated, or if `more`
/// returns false.
pub fn surface(
    of: &dyn LeastOf,
    count: usize,
    (low, size): (Vec3, f64),
    cell: f64,
    most: usize,
    left: &Cell<usize>,
    more: &dyn Fn() -> bool,
) -> Option<Triangles> {
    let halvings = ((size / cell).log2().ceil().max(0.0) as u32).min(MOST_HALVINGS);
    let cell = size / f64::from(1_u32 << halvings);
    let (values, zeros) = (HashMap::new(), HashMap::new());
    let found = Triangles::default();
    let (parts, lists) = (Vec::new(), Vec::new());
    let by_cell = HashMap::new();
    let of = &Counted { of, left };
    let mut search = Search { of, low, cell, most, cells: 0, values, zeros, found, parts, lists, by_cell };
    let all = Nearby { middle: low, parts: (0..count).map(|k| (f64::NEG_INFINITY, k)).collect() };
    search.part([0; 3], halvings, &all, more)?;
    search.measure();
    search.measure_from(count, more)?;
    Some(search.found)
}

/// The parts that can be the least near a place.
#[derive(Clone, Debug)]
struct Nearby {
    middle: Vec3,
    /// Values there, the least first, and numbers of the parts.
    parts: Vec<(f64, usize)>,
}

impl Nearby {
    /// The least part at a point: none whose value cannot have fallen so far is evaluated.
    fn least(&self, of: &dyn LeastOf, p: Vec3) -> f64 {
        let way = (p - self.middle).norm();
        let mut least = f64::INFINITY;
        for (value, k) in &self.parts {
            if value - way >= least {
                break;
            }
            least = least.min(of.part(*k, p));
        }
        least
    }
}

/// A function whose values of parts are counted.
struct Counted<'a> {
    of: &'a dyn LeastOf,
    left: &'a Cell<usize>,
}

impl LeastOf for Counted<'_> {
    fn part(&self, k: usize, p: Vec3) -> f64 {
        self.left.set(self.left.get().saturating_sub(1));
        self.of.part(k, p)
    }

    fn zero(&self, k: usize, p: Vec3) -> Vec3 {
        self.of.zero(k, p)
    }

    fn corners(&self, k: usize) -> Vec<Vec3> {
        self.of.corners(k)
    }
}

struct Search<'a> {
    of: &'a Counted<'a>,
    low: Vec3,
    cell: f64,
    most: usize,
    cells: usize,
    /// Values at corners of the lattice.
    values: HashMap<Node, f64>,
    /// Corners of triangles, by the edges of the lattice on which they lie.
    zeros: HashMap<[Node; 2], u32>,
    found: Triangles,
    /// Per triangle: the parts that can be the least in its cell.
    parts: Vec<u32>,
    lists: Vec<Nearby>,
    /// First triangle of each cell and the one after its last one, by the cell's first corner.
    by_cell: HashMap<Node, [usize; 2]>,
}

impl Search<'_> {
    fn place(&self, node: Node) -> Vec3 {
        let [x, y, z] = node.map(|n| f64::from(n) * self.cell);
        self.low + Vec3::new(x, y, z)
    }

    /// The surface in a cube with this corner and edges of 2 to the power of `halvings` cells.
    fn part(&mut self, corner: Node, halvings: u32, nearby: &Nearby, more: &dyn Fn() -> bool) -> Option<()> {
        let edge = f64::from(1_u32 << halvings) * self.cell;
        let middle = self.place(corner) + Vec3::new(1.0, 1.0, 1.0) * (0.5 * edge);
        let reach = 0.5 * edge * 3.0_f64.sqrt();
        if self.of.left.get() == 0 {
            return None;
        }
        let way = (middle - nearby.middle).norm();
        let (mut least, mut parts) = (f64::INFINITY, Vec::new());
        for (before, k) in &nearby.parts {
            // Neither this part nor those after it are the least anywhere in the cube.
            if before - way > least + 2.0 * reach {
                break;
            }
            let value = self.of.part(*k, middle);
            least = least.min(value);
            if least < -reach {
                return Some(());
            }
            parts.push((value, *k));
        }
        if least > reach {
            return Some(());
        }
        parts.sort_by(|a: &(f64, usize), b| a.0.total_cmp(&b.0));
        // A part that is farther by two radii is not the least anywhere in the cube.
        parts.retain(|(value, _)| *value <= least + 2.0 * reach);
        let near = Nearby { middle, parts };
        if halvings == 0 {
            self.cells += 1;
            if self.cells > self.most {
                return None;
            }
            if let Some((_, k)) = near.parts.first() {
                self.found.samples.push(self.of.zero(*k, middle));
            }
            self.cut(corner, near);
            return Some(());
        }
        if !more() {
            return None;
        }
        let half = 1_u32 << (halvings - 1);
        for step in CORNERS {
            let child = [0, 1, 2].map(|k| corner[k] + half * step[k]);
            self.part(child, halvings - 1, &near, more)?;
        }
        Some(())
    }

    /// The triangles of a cell.
    fn cut(&mut self, corner: Node, nearby: Nearby) {
        let nodes = CORNERS.map(|step| [0, 1, 2].map(|k| corner[k] + step[k]));
        let values = nodes.map(|node| {
            if let Some(value) = self.values.get(&node) {
                return *value;
            }
            let value = nearby.least(self.of, self.place(node));
            self.values.insert(node, value);
            value
        });
        let before = self.found.triangles.len();
        for tetrahedron in TETRAHEDRA {
            let inside = tetrahedron.map(|k| values[k] < 0.0);
            let of = |is_inside: bool| (0..4).filter(move |k| inside[*k] == is_inside);
            let (within, without): (Vec<usize>, Vec<usize>) = (of(true).collect(), of(false).collect());
            let mut zero = |a: usize, b: usize| {
                let [a, b] = [a, b].map(|k| tetrahedron[k]);
                self.zero([nodes[a], nodes[b]], [values[a], values[b]], &nearby)
            };
            let corners: Vec<u32> = match (&within[..], &without[..]) {
                ([a], [b, c, d]) | ([b, c, d], [a]) => [b, c, d].iter().map(|k| zero(*a, **k)).collect(),
                ([a, b], [c, d]) => vec![zero(*a, *c), zero(*a, *d), zero(*b, *d), zero(*b, *c)],
                _ => continue,
            };
            // Outwards: from the corners inside to those outside.
            let mean = |all: &[usize]| {
                let sum = all.iter().fold(Vec3::ZERO, |sum, k| sum + self.place(nodes[tetrahedron[*k]]));
                sum * (1.0 / all.len() as f64)
            };
            let outwards = mean(&without) - mean(&within);
            for k in 1..corners.len() - 1 {
                let triangle = [corners[0], corners[k], corners[k + 1]];
                let [a, b, c] = triangle.map(|k| self.found.vertices[k as usize]);
                let is_turned = (b - a).cross(c - a).dot(outwards) < 0.0;
                let [a, b, c] = triangle;
                self.found.triangles.push(if is_turned { [a, c, b] } else { triangle });
            }
        }
        let list = self.lists.len() as u32;
        let count = self.found.triangles.len() - before;
        self.by_cell.insert(corner, [before, before + count]);
        if count > 0 {
            self.parts.extend(std::iter::repeat_n(list, count));
            self.lists.push(nearby);
        }
    }

    /// The corner of triangles on an edge of the lattice.
    fn zero(&mut self, ends: [Node; 2], values: [f64; 2], nearby: &Nearby) -> u32 {
        let (mut ends, mut values) = (ends, values);
        if ends[1] < ends[0] {
            ends.reverse();
            values.reverse();
        }
        if let Some(k) = self.zeros.get(&ends) {
            return *k;
        }
        let [a, b] = ends.map(|node| self.place(node));
        // Regula falsi (Illinois), halved where that is slow.
        let length = (b - a).norm();
        let [mut from, mut to] = [0.0, 1.0];
        let mut kept = values;
        let mut last_side = None;
        for step in 0..MOST_STEPS {
            let part = if step % 4 == 3 { 0.5 } else { kept[0] / (kept[0] - kept[1]) };
            let middle = from + (to - from) * part.clamp(MARGIN, 1.0 - MARGIN);
            let p = a + (b - a) * middle;
            let value = nearby.least(self.of, p);
            let side = usize::from((value < 0.0) != (values[0] < 0.0));
            if side == 0 {
                from = middle
            } else {
                to = middle
            }
            kept[side] = value;
            // The end that stays a second time counts half.
            if last_side == Some(side) {
                kept[1 - side] *= 0.5;
            }
            last_side = Some(side);
            if value.abs() <= RESOLVED * length || to - from <= RESOLVED {
                (from, to) = (middle, middle);
                break;
            }
        }
        let k = self.found.vertices.len() as u32;
        self.found.vertices.push(a + (b - a) * (0.5 * (from + to)));
        self.zeros.insert(ends, k);
        k
    }

    /// Distance of the triangles from the surface, at their centres and the middles of their edges.
    fn measure(&mut self) {
        let mut most = 0.0_f64;
        for (t, [a, b, c]) in self.found.corners().enumerate() {
            let nearby = &self.lists[self.parts[t] as usize];
            let points = [(a + b + c) * (1.0 / 3.0), (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
            most = points.into_iter().map(|p| nearby.least(self.of, p).abs()).fold(most, f64::max);
        }
        self.found.deviation = most;
    }

    /// Adds the distances from points of the surface to the triangles: parts that are thinner than a cell have none.
    fn measure_from(&mut self, count: usize, more: &dyn Fn() -> bool) -> Option<()> {
        let mut most = self.found.deviation;
        // One point of each eighth of a cell.
        let mut measured: HashSet<Node> = HashSet::new();
        let mut far = Vec::new();
        let mut measure = |p: Vec3| {
            let v = (p - self.low).to_array();
            let of_size = |size: f64| v.map(|x| (x / size).floor().max(0.0) as u32);
            if measured.insert(of_size(0.5 * self.cell)) {
                match self.beyond(p, of_size(self.cell)) {
                    Some(beyond) => most = most.max(beyond),
                    None => far.push(p),
                }
            }
        };
        for k in 0..count {
            if !more() {
                return None;
            }
            self.of.corners(k).into_iter().for_each(&mut measure);
        }
        self.found.samples.iter().for_each(|p| measure(*p));
        // Of parts without triangles some points are enough.
        let apart = |p: &Vec3| {
            let square = |q: &Vec3| (*q - *p).dot(*q - *p);
            self.found.vertices.iter().map(square).fold(f64::INFINITY, f64::min).sqrt()
        };
        let every = far.len() / MOST_FAR + 1;
        most = far.iter().step_by(every).map(apart).fold(most, f64::max);
        self.found.deviation = most;
        Some(())
    }

    /// Distance of a point of the solid in a cell from the triangles, if it is outside them; `None` if this cell and
    /// those around it have none.
    fn beyond(&self, p: Vec3, cell: Node) -> Option<f64> {
        let corners = CORNERS.map(|step| self.values.get(&[0, 1, 2].map(|k| cell[k] + step[k])));
        // A cell that was left out is inside, since the point is not outside.
        let is_inside = |value: &Option<&f64>| value.is_some_and(|value| *value < 0.0);
        if !self.by_cell.contains_key(&cell) || corners.iter().all(is_inside) {
            return Some(0.0);
        }
        // Distance, and height over the plane of the triangle: of those that are as near, the greatest.
        let mut best: Option<(f64, f64)> = None;
        let mut visit = |node: Node| {
            let [from, to] = self.by_cell.get(&node).copied().unwrap_or([0; 2]);
            for t in &self.found.triangles[from..to] {
                let corners = t.map(|k| self.found.vertices[k as usize]);
                let (q, _) = nearest_of_triangle(p, corners, *t);
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a);
                let (apart, height) = ((q - p).norm(), normal.dot(p - q) / normal.norm());
                let is_nearer = best.is_none_or(|(least, highest)| {
                    let same = RESOLVED * self.cell;
                    apart < least - same || apart <= least + same && height.abs() > highest.abs()
                });
                if is_nearer && height.is_finite() {
                    best = Some((apart, height));
                }
            }
            best.map_or(f64::INFINITY, |(apart, _)| apart)
        };
        let mut least = visit(cell);
        for [x, y, z] in (0..27_u32).map(|k| [k % 3, k / 3 % 3, k / 9]) {
            let node =
                [(cell[0] + x).checked_sub(1), (cell[1] + y).checked_sub(1), (cell[2] + z).checked_sub(1)];
            let [Some(x), Some(y), Some(z)] = node else { continue };
            let (low, node) = (self.place([x, y, z]), [x, y, z]);
            let gap = |p: f64, low: f64| (low - p).max(p - low - self.cell).max(0.0);
            let apart = Vec3::new(gap(p.x, low.x), gap(p.y, low.y), gap(p.z, low.z)).norm();
            if node != cell && apart < least {
                least = visit(node);
            }
        }
        best.map(|(apart, height)| if height > 0.0 { apart } else { 0.0 })
    }
}
