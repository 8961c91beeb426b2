//! Meshes in COLLADA, the usual format of robots: the displayed scene as triangles in metres. The `up_axis` of a file
//! is ignored, as by RViz and Gazebo: such meshes are already in the frames of their links.

use std::collections::BTreeMap;

use hardpoint::space::{Mat3, Vec3};
use roxmltree::Node;

use crate::shapes::oriented;
use crate::xml::{self, child, children, named};

/// Maximum depth of nested nodes.
const DEEPEST: usize = 60;
/// Maximum number of triangles of a mesh.
const MOST: usize = 1_000_000;

type Triangle = [Vec3; 3];

/// Affine transformation of a node: `turn s + shift`.
#[derive(Clone, Copy)]
struct Affine {
    turn: Mat3,
    shift: Vec3,
}

impl Affine {
    fn point(self, s: Vec3) -> Vec3 {
        self.turn * s + self.shift
    }

    fn then(self, inner: Self) -> Self {
        Self { turn: self.turn * inner.turn, shift: self.point(inner.shift) }
    }
}

/// Returns the triangles of a file, m.
///
/// # Errors
/// Returns a description of the first error.
pub fn triangles(text: &str) -> Result<Vec<Triangle>, String> {
    let text = xml::lenient(text);
    let document = xml::parse_quietly(&text)?;
    let root = document.root_element();
    let ids = root.descendants().filter_map(|n| Some((n.attribute("id")?, n))).collect();
    let unit =
        child(root, "asset").and_then(|a| child(a, "unit")).and_then(|u| u.attribute("meter")?.parse().ok());
    let metre: f64 = unit.filter(|m: &f64| m.is_finite() && *m > 0.0).unwrap_or(1.0);
    let mut reader = Reader { ids, out: Vec::new() };
    let instance = child(root, "scene").and_then(|s| child(s, "instance_visual_scene"));
    let scene = instance.and_then(|s| reader.named(s, "url"));
    let first = || child(child(root, "library_visual_scenes")?, "visual_scene");
    let scaled = Affine { turn: scale([metre; 3]), shift: Vec3::zero() };
    match scene.or_else(first) {
        Some(scene) => reader.node(scene, scaled, 0),
        None => named(root, "library_geometries").flat_map(children).for_each(|g| reader.geometry(g, scaled)),
    }
    if reader.out.is_empty() { Err("it has no triangles".into()) } else { Ok(reader.out) }
}

fn scale(by: [f64; 3]) -> Mat3 {
    let [x, y, z] = by;
    Mat3 { cols: [Vec3::new(x, 0.0, 0.0), Vec3::new(0.0, y, 0.0), Vec3::new(0.0, 0.0, z)] }
}

struct Reader<'a, 'i> {
    ids: BTreeMap<&'a str, Node<'a, 'i>>,
    out: Vec<Triangle>,
}

impl<'a, 'i: 'a> Reader<'a, 'i> {
    /// Returns the element that an attribute refers to as `#id`.
    fn named(&self, node: Node<'a, 'i>, key: &str) -> Option<Node<'a, 'i>> {
        self.ids.get(node.attribute(key)?.trim().strip_prefix('#')?).copied()
    }

    /// Adds the shapes of a node and of its descendants.
    fn node(&mut self, node: Node<'a, 'i>, outer: Affine, depth: usize) {
        if depth > DEEPEST || self.out.len() > MOST {
            return;
        }
        let mut place = outer;
        for part in children(node) {
            let numbers = || xml::numbers(part.text().unwrap_or_default()).unwrap_or_default();
            let step = match (part.tag_name().name(), &numbers()[..]) {
                ("matrix", m @ [_, _, _, _, _, _, _, _, _, _, _, _, ..]) => {
                    let column = |k: usize| Vec3::new(m[k], m[4 + k], m[8 + k]);
                    Affine { turn: Mat3 { cols: [column(0), column(1), column(2)] }, shift: column(3) }
                }
                ("translate", [x, y, z]) => Affine { turn: scale([1.0; 3]), shift: Vec3::new(*x, *y, *z) },
                ("scale", [x, y, z]) => Affine { turn: scale([*x, *y, *z]), shift: Vec3::zero() },
                ("rotate", [x, y, z, angle]) => {
                    let Some(axis) = Vec3::new(*x, *y, *z).unit() else { continue };
                    Affine { turn: Mat3::about(axis, angle.to_radians()), shift: Vec3::zero() }
                }
                _ => continue,
            };
            place = place.then(step);
        }
        for part in children(node) {
            match part.tag_name().name() {
                "node" => self.node(part, place, depth + 1),
                "instance_node" => {
                    if let Some(other) = self.named(part, "url") {
                        self.node(other, place, depth + 1);
                    }
                }
                "instance_geometry" => {
                    if let Some(geometry) = self.named(part, "url") {
                        self.geometry(geometry, place);
                    }
                }
                _ => {}
            }
        }
    }

    fn geometry(&mut self, geometry: Node<'a, 'i>, place: Affine) {
        for faces in named(geometry, "mesh").flat_map(children) {
            let kind = faces.tag_name().name();
            if !["triangles", "polylist", "polygons"].contains(&kind) {
                continue;
            }
            let Some(points) = self.points(faces) else { continue };
            let offset = |input: Node<'_, '_>| {
                input.attribute("offset").and_then(|o| o.parse::<usize>().ok()).unwrap_or(0)
            };
            let stride = named(faces, "input").map(offset).max().unwrap_or(0) + 1;
            let Some(own) = named(faces, "input").find(|i| i.attribute("semantic") == Some("VERTEX")) else {
                continue;
            };
            let own = offset(own);
            let list = |node: Node<'_, '_>| -> Vec<usize> {
                node.text().unwrap_or_default().split_whitespace().map_while(|w| w.parse().ok()).collect()
            };
            let mut counts = child(faces, "vcount").map(list).unwrap_or_default().into_iter();
            for p in named(faces, "p") {
                let corners: Vec<usize> = list(p).chunks_exact(stride).map(|c| c[own]).collect();
                let mut rest = &corners[..];
                while !rest.is_empty() && self.out.len() <= MOST {
                    let count = match kind {
                        "triangles" => 3,
                        "polylist" => counts.next().unwrap_or(rest.len()),
                        _ => rest.len(),
                    };
                    let (face, behind) = rest.split_at(count.clamp(1, rest.len()));
                    rest = behind;
                    let at: Option<Vec<Vec3>> =
                        face.iter().map(|k| points.get(*k).map(|s| place.point(*s))).collect();
                    let Some([first, others @ ..]) = at.as_deref() else { continue };
                    let fan = others.windows(2).map(|pair| [*first, pair[0], pair[1]]);
                    self.out.extend(fan.map(|triangle| oriented(place.turn, triangle)));
                }
            }
        }
    }

    /// Returns the points that faces refer to.
    fn points(&self, faces: Node<'a, 'i>) -> Option<Vec<Vec3>> {
        let semantic = |node: Node<'a, 'i>, what: &str| {
            named(node, "input")
                .find(|i| i.attribute("semantic") == Some(what))
                .and_then(|i| self.named(i, "source"))
        };
        let source = semantic(semantic(faces, "VERTEX")?, "POSITION")?;
        let numbers = xml::numbers(child(source, "float_array")?.text()?)?;
        let accessor = child(source, "technique_common").and_then(|t| child(t, "accessor"));
        let stride = accessor.and_then(|a| a.attribute("stride")?.parse().ok()).unwrap_or(3_usize).max(3);
        Some(numbers.chunks_exact(stride).map(|p| Vec3::new(p[0], p[1], p[2])).collect())
    }
}
