//! A motion as an animated binary glTF file.

use std::io;

use gltf::binary::{Glb, Header};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::animation::{Channel, Interpolation, Property, Sampler, Target};
use gltf::json::buffer::{Target as Purpose, View};
use gltf::json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::scene::UnitQuaternion;
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Accessor, Animation, Asset, Buffer, Index, Material, Mesh, Node, Root, Scene};
use hardpoint::model::Model;
use hardpoint::motion::Motion;
use hardpoint::space::{Pose, Vec3};
use hardpoint_file::{MeshFrame, ModelFile};

use crate::links::{body_points, lines, rods};

const GENERATOR: &str = concat!("hardpoint ", env!("CARGO_PKG_VERSION"));
/// Half diagonal of the section of links, and radius of joints, as fractions of the mechanism size.
const LINK: f64 = 0.006;
const JOINT: f64 = 0.011;
/// Rotation from z up (model) to y up (glTF): x, y, z become x, z, -y by a quarter turn about x; quaternion x, y, z, w.
const Y_UP: [f32; 4] = [-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2];
/// Colour of ground, and colours that the other bodies cycle through.
const GROUND: [f32; 3] = [0.35, 0.35, 0.37];
const COLOURS: [[f32; 3]; 8] = [
    [0.06, 0.26, 0.56],
    [0.78, 0.27, 0.03],
    [0.07, 0.40, 0.20],
    [0.50, 0.10, 0.35],
    [0.62, 0.45, 0.02],
    [0.02, 0.42, 0.48],
    [0.45, 0.06, 0.06],
    [0.25, 0.18, 0.55],
];

/// Writes a motion as a binary glTF file (`.glb`). A root node with the model's name turns z up into glTF's y up. Below
/// it is one node per body with its translation (m) and rotation at every output time, counted from 0 s. A body is
/// drawn with the mesh that the model names for it, otherwise, like rods, as links between its points.
///
/// ```
/// let text = r#"
/// name = "pendulum"
/// units = { length = "mm", angle = "deg" }
/// hardpoints = { pivot = [0, 0, 500] }
/// bodies = { arm = {} }
/// joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
/// drivers.swing = { joint = "hinge", law = "30*sin(2*pi*t)" }
/// time = { end = 1.0, steps = 100 }
/// "#;
/// let file = hardpoint_file::parse(text, "pendulum.toml").unwrap();
/// let analysis = hardpoint::Analysis::new(&file.model).unwrap();
/// let glb = hardpoint_export::animation(&file, &analysis.run().motion).unwrap();
/// assert_eq!(&glb[..4], b"glTF");
/// ```
///
/// # Errors
/// Returns an error if the file exceeds the limit of the format, 4 GiB.
pub fn animation(file: &ModelFile, motion: &Motion) -> io::Result<Vec<u8>> {
    let model = &file.model;
    let steps = distinct_times(motion);
    let mut scene = Writer::new();
    let start = steps.first().map_or(0.0, |k| motion.times[*k]);
    let times: Vec<f32> = steps.iter().map(|k| (motion.times[*k] - start) as f32).collect();
    let times = scene.accessor(Type::Scalar, &times, None);
    let mut tracks = Vec::new();
    let mut nodes = Vec::new();
    for (b, places) in body_points(model).iter().enumerate() {
        let mesh = shape(file, b).unwrap_or_else(|| link_triangles(places, b > 0, model.size()));
        let colour = if b == 0 { GROUND } else { COLOURS[(b - 1) % COLOURS.len()] };
        let poses: Vec<Pose> = steps.iter().map(|&k| motion.at(k).body(b).pose()).collect();
        let turns = poses.iter().map(|p| quaternion(*p));
        let track = Track::new(poses.iter().map(|p| p.r), turns, None);
        nodes.push(scene.add_node(&model.bodies[b].name, &mesh, colour, &track, &mut tracks));
    }
    for (joint, ends) in rods(model) {
        let [i, j] = joint.bodies.map(|b| b.0);
        let place = |k: usize, b: usize, at: Vec3| {
            let state = motion.at(k).body(b);
            state.r + state.rotation * at
        };
        let spans: Vec<[Vec3; 2]> =
            steps.iter().map(|&k| [place(k, i, ends[0]), place(k, j, ends[1])]).collect();
        // A rod of unit length along z, which is rotated and scaled.
        let mut mesh = Triangles::default();
        mesh.prism([Vec3::zero(), Vec3::new(0.0, 0.0, 1.0)], LINK * model.size());
        let lengths = spans.iter().map(|[a, b]| (*b - *a).norm()).collect();
        let turns = spans.iter().map(|[a, b]| from_z(*b - *a));
        let track = Track::new(spans.iter().map(|[a, _]| *a), turns, Some(lengths));
        nodes.push(scene.add_node(&joint.name, &mesh, GROUND, &track, &mut tracks));
    }
    scene.end(model, nodes, times, tracks)
}

/// Indices of the output times that remain distinct in single precision.
fn distinct_times(motion: &Motion) -> Vec<usize> {
    let Some(start) = motion.times.first() else { return Vec::new() };
    let mut last = None;
    let later = |k: &usize| {
        let t = (motion.times[*k] - start) as f32;
        let later = last.is_none_or(|last| t > last);
        last = if later { Some(t) } else { last };
        later
    };
    (0..motion.len()).filter(later).collect()
}

/// Orientation as a quaternion in the order of glTF: x, y, z, w.
fn quaternion(pose: Pose) -> [f64; 4] {
    let [w, x, y, z] = hardpoint::space::Quat::from_rotation(pose.rot).to_array();
    [x, y, z, w]
}

/// Quaternion x, y, z, w of the smallest rotation that takes z into the direction `d`.
fn from_z(d: Vec3) -> [f64; 4] {
    let length = d.norm();
    let w = length + d.z;
    // Half a turn, about any axis perpendicular to z.
    if !(w > 1e-9 * length) {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let norm = (d.x * d.x + d.y * d.y + w * w).sqrt();
    [-d.y / norm, d.x / norm, 0.0, w / norm]
}

/// Mesh that the model names for a body, in the body frame.
fn shape(file: &ModelFile, body: usize) -> Option<Triangles> {
    let mesh = file.drawing.bodies.get(&body)?;
    let body_from_file = match mesh.frame {
        MeshFrame::World => file.model.bodies[body].frame.inverse(),
        MeshFrame::Body => Pose::IDENTITY,
    };
    let places = mesh.vertices.iter().map(|v| body_from_file.point(*v)).collect();
    Some(Triangles { places, corners: mesh.triangles.iter().flatten().copied().collect() })
}

/// Triangles of the joints at the points of a body and, if `links`, of the links between them.
fn link_triangles(places: &[Vec3], links: bool, size: f64) -> Triangles {
    let mut mesh = Triangles::default();
    for line in lines(places).into_iter().filter(|_| links) {
        mesh.prism(line, LINK * size);
    }
    places.iter().for_each(|at| mesh.joint(*at, JOINT * size));
    mesh
}

/// Triangulated surface.
#[derive(Default)]
struct Triangles {
    places: Vec<Vec3>,
    /// Vertex indices, three per triangle.
    corners: Vec<u32>,
}

impl Triangles {
    /// Adds a rod of square section along a line; `half` is the half diagonal of the section.
    fn prism(&mut self, [from, to]: [Vec3; 2], half: f64) {
        let along = (to - from) * (1.0 / (to - from).norm());
        let other = if along.x.abs() < 0.9 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
        let across = along.cross(other);
        let across = across * (half / across.norm());
        let sides = [across, along.cross(across)];
        let first = self.places.len() as u32;
        for end in [from, to] {
            self.places.extend([sides[0], sides[1], sides[0] * -1.0, sides[1] * -1.0].map(|s| end + s));
        }
        for k in 0..4 {
            let next = (k + 1) % 4;
            self.corners.extend([k, next, k + 4, next, next + 4, k + 4].map(|c| first + c));
        }
        self.corners.extend([0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7].map(|c| first + c));
    }

    /// Adds an octahedron about a point.
    fn joint(&mut self, at: Vec3, radius: f64) {
        let first = self.places.len() as u32;
        let axes =
            [[radius, 0.0, 0.0], [0.0, radius, 0.0], [0.0, 0.0, radius]].map(|[x, y, z]| Vec3::new(x, y, z));
        self.places.extend(axes.into_iter().flat_map(|a| [at + a, at - a]));
        for [x, y, z] in
            [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
        {
            self.corners.extend([x, y, z].map(|c| first + c));
        }
    }
}

/// Transformation of a node at every output time.
struct Track {
    places: Vec<[f32; 3]>,
    turns: Vec<[f32; 4]>,
    scales: Vec<[f32; 3]>,
}

impl Track {
    /// Creates a track; `lengths` scale the node along its z axis.
    fn new(
        places: impl Iterator<Item = Vec3>,
        turns: impl Iterator<Item = [f64; 4]>,
        lengths: Option<Vec<f64>>,
    ) -> Self {
        let mut turns: Vec<[f64; 4]> = turns.collect();
        // A rotation has two quaternions: choose the one nearer to the previous.
        for k in 1..turns.len() {
            let dot: f64 = turns[k].iter().zip(&turns[k - 1]).map(|(a, b)| a * b).sum();
            if dot < 0.0 {
                turns[k] = turns[k].map(|x| -x);
            }
        }
        Self {
            places: places.map(|p| p.to_array().map(|x| x as f32)).collect(),
            turns: turns.into_iter().map(|q| q.map(|x| x as f32)).collect(),
            scales: lengths.into_iter().flatten().map(|l| [1.0, 1.0, l as f32]).collect(),
        }
    }
}

/// Animated property of a node, with the accessor of its values.
type AnimatedProperty = (Index<Node>, Property, Index<Accessor>);

struct Writer {
    root: Root,
    data: Vec<u8>,
    buffer: Index<Buffer>,
}

impl Writer {
    fn new() -> Self {
        let mut root = Root {
            asset: Asset { generator: Some(GENERATOR.into()), ..Asset::default() },
            ..Root::default()
        };
        let buffer = root.push(Buffer {
            byte_length: USize64(0),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
        Self { root, data: Vec::new(), buffer }
    }

    /// Adds an animated node; its varying properties are appended to `tracks`.
    fn add_node(
        &mut self,
        name: &str,
        shape: &Triangles,
        colour: [f32; 3],
        track: &Track,
        tracks: &mut Vec<AnimatedProperty>,
    ) -> Index<Node> {
        let mesh = self.mesh(name, shape, colour);
        let node = self.root.push(Node {
            name: Some(name.to_owned()),
            mesh,
            translation: track.places.first().copied(),
            rotation: track.turns.first().copied().map(UnitQuaternion),
            scale: track.scales.first().copied(),
            ..Node::default()
        });
        // Constant properties need no track.
        let mut add = |property, kind, varies: bool, numbers: &[f32]| {
            if varies {
                tracks.push((node, property, self.accessor(kind, numbers, None)));
            }
        };
        add(Property::Translation, Type::Vec3, varies(&track.places), track.places.as_flattened());
        add(Property::Rotation, Type::Vec4, varies(&track.turns), track.turns.as_flattened());
        add(Property::Scale, Type::Vec3, varies(&track.scales), track.scales.as_flattened());
        node
    }

    fn mesh(&mut self, name: &str, shape: &Triangles, [r, g, b]: [f32; 3]) -> Option<Index<Mesh>> {
        if shape.corners.is_empty() {
            return None;
        }
        let places: Vec<f32> = shape.places.iter().flat_map(|v| v.to_array().map(|x| x as f32)).collect();
        let positions = self.accessor(Type::Vec3, &places, Some(Purpose::ArrayBuffer));
        let bytes = shape.corners.iter().flat_map(|c| c.to_le_bytes());
        let view = self.view(bytes, Some(Purpose::ElementArrayBuffer));
        let indices = accessor(view, shape.corners.len(), ComponentType::U32, Type::Scalar, None);
        let indices = self.root.push(indices);
        let material = self.root.push(Material {
            name: Some(name.to_owned()),
            double_sided: true,
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(0.7),
                ..PbrMetallicRoughness::default()
            },
            ..Material::default()
        });
        let primitive = Primitive {
            attributes: [(Checked::Valid(Semantic::Positions), positions)].into(),
            indices: Some(indices),
            material: Some(material),
            mode: Checked::Valid(Mode::Triangles),
            targets: None,
            extensions: None,
            extras: Default::default(),
        };
        Some(self.root.push(Mesh {
            name: Some(name.to_owned()),
            primitives: vec![primitive],
            weights: None,
            extensions: None,
            extras: Default::default(),
        }))
    }

    fn accessor(&mut self, kind: Type, numbers: &[f32], purpose: Option<Purpose>) -> Index<Accessor> {
        let width = kind.multiplicity();
        let bounds = (0..width).map(|c| {
            let of = || numbers.iter().skip(c).step_by(width).copied();
            (of().fold(f32::INFINITY, f32::min), of().fold(f32::NEG_INFINITY, f32::max))
        });
        let bounds = (!numbers.is_empty()).then(|| bounds.unzip());
        let view = self.view(numbers.iter().flat_map(|x| x.to_le_bytes()), purpose);
        self.root.push(accessor(view, numbers.len() / width, ComponentType::F32, kind, bounds))
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, purpose: Option<Purpose>) -> Index<View> {
        let offset = self.data.len();
        self.data.extend(bytes);
        self.root.push(View {
            buffer: self.buffer,
            byte_length: USize64::from(self.data.len() - offset),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: None,
            name: None,
            target: purpose.map(Checked::Valid),
            extensions: None,
            extras: Default::default(),
        })
    }

    fn end(
        mut self,
        model: &Model,
        children: Vec<Index<Node>>,
        times: Index<Accessor>,
        tracks: Vec<AnimatedProperty>,
    ) -> io::Result<Vec<u8>> {
        let top = self.root.push(Node {
            name: Some(model.name.clone()),
            rotation: Some(UnitQuaternion(Y_UP)),
            children: Some(children),
            ..Node::default()
        });
        let scene = Scene {
            name: Some(model.name.clone()),
            nodes: vec![top],
            extensions: None,
            extras: Default::default(),
        };
        self.root.scene = Some(self.root.push(scene));
        let sampler = |(_, _, output): &AnimatedProperty| Sampler {
            input: times,
            interpolation: Checked::Valid(Interpolation::Linear),
            output: *output,
            extensions: None,
            extras: Default::default(),
        };
        let channel = |(k, (node, property, _)): (usize, &AnimatedProperty)| Channel {
            sampler: Index::new(k as u32),
            target: Target {
                node: *node,
                path: Checked::Valid(*property),
                extensions: None,
                extras: Default::default(),
            },
            extensions: None,
            extras: Default::default(),
        };
        if !tracks.is_empty() {
            self.root.animations.push(Animation {
                name: Some("motion".into()),
                samplers: tracks.iter().map(sampler).collect(),
                channels: tracks.iter().enumerate().map(channel).collect(),
                extensions: None,
                extras: Default::default(),
            });
        }
        self.root.buffers[0].byte_length = USize64::from(self.data.len());
        let json = self.root.to_vec().map_err(io::Error::other)?;
        let glb = Glb {
            header: Header { magic: *b"glTF", version: 2, length: 0 },
            json: json.into(),
            bin: Some(self.data.into()),
        };
        glb.to_vec().map_err(io::Error::other)
    }
}

fn accessor(
    view: Index<View>,
    count: usize,
    component: ComponentType,
    kind: Type,
    bounds: Option<(Vec<f32>, Vec<f32>)>,
) -> Accessor {
    let (min, max) = bounds.map(|(min, max)| (min.into(), max.into())).unzip();
    Accessor {
        buffer_view: Some(view),
        byte_offset: None,
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component)),
        type_: Checked::Valid(kind),
        min,
        max,
        name: None,
        normalized: false,
        sparse: None,
        extensions: None,
        extras: Default::default(),
    }
}

fn varies<const N: usize>(list: &[[f32; N]]) -> bool {
    list.iter().any(|x| *x != list[0])
}
