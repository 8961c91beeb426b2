//! Shapes of bodies: meshes that a source names, boxes, cylinders and balls. The shapes of a body are combined in one
//! file of triangles.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use hardpoint::space::{Mat3, Pose, Vec3};

use crate::mechanism::{GROUND, Mechanism, Mesh};
use crate::report::{ImportLog, SourceSpan};
use crate::turn::none;

/// Maximum number of triangles of a body.
const MOST: usize = 200_000;
/// Number of sides of cylinders and balls.
const SIDES: usize = 24;

/// Corners of a triangle.
pub type Triangle = [Vec3; 3];

/// Shapes of a mechanism by body, in the body frame and the unit of the mechanism.
#[derive(Debug, Default)]
pub struct Shapes {
    bodies: BTreeMap<usize, Vec<Triangle>>,
}

/// Simple shape as in the robot formats: axis along z, origin in the middle.
#[derive(Clone, Copy, Debug)]
pub enum Solid {
    /// A box with the lengths of its sides.
    Box([f64; 3]),
    /// A cylinder with its radius and length.
    Cylinder(f64, f64),
    /// A capsule with its radius and the length of its cylinder.
    Capsule(f64, f64),
    /// An ellipsoid with its three semi-axes.
    Ball([f64; 3]),
}

impl Solid {
    /// Returns the volume and the moments of inertia about its own axes per unit of mass.
    pub fn moments(self) -> (f64, [f64; 3]) {
        use std::f64::consts::PI;
        match self {
            Self::Box([x, y, z]) => {
                let [x2, y2, z2] = [x, y, z].map(|a| a * a);
                (x * y * z, [(y2 + z2) / 12.0, (z2 + x2) / 12.0, (x2 + y2) / 12.0])
            }
            Self::Cylinder(r, l) => {
                let across = (3.0 * r * r + l * l) / 12.0;
                (PI * r * r * l, [across, across, r * r / 2.0])
            }
            Self::Capsule(r, l) => {
                // A cylinder with half a ball at each end.
                let [tube, ball] = [PI * r * r * l, 4.0 / 3.0 * PI * r * r * r];
                let volume = tube + ball;
                let [t, b] = [tube / volume, ball / volume];
                let h = l / 2.0;
                let across = t * (3.0 * r * r + l * l) / 12.0 + b * (0.4 * r * r + h * h + 0.75 * r * h);
                (volume, [across, across, t * r * r / 2.0 + b * 0.4 * r * r])
            }
            Self::Ball([a, b, c]) => {
                let [a2, b2, c2] = [a, b, c].map(|x| x * x);
                (4.0 / 3.0 * PI * a * b * c, [(b2 + c2) / 5.0, (c2 + a2) / 5.0, (a2 + b2) / 5.0])
            }
        }
    }
}

impl Shapes {
    /// Adds a simple shape at a pose in its body.
    pub fn solid(&mut self, body: usize, place: Pose, solid: Solid) {
        let triangles = match solid {
            Solid::Box(sides) => cuboid(sides),
            Solid::Cylinder(radius, length) => {
                let half = length / 2.0;
                turned(&[[0.0, -half], [radius, -half], [radius, half], [0.0, half]])
            }
            Solid::Capsule(radius, length) => turned(&arc(radius, length / 2.0)),
            Solid::Ball(axes) => {
                let scaled = |p: Vec3| Vec3::from([p.x * axes[0], p.y * axes[1], p.z * axes[2]]);
                turned(&arc(1.0, 0.0)).into_iter().map(|t| t.map(scaled)).collect()
            }
        };
        self.triangles(body, place, none(), triangles.into_iter());
    }

    /// Adds a file of triangles at a pose in its body, after a linear map of its coordinates.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be read.
    pub fn file(
        &mut self,
        body: usize,
        place: Pose,
        linear: Mat3,
        name: &str,
        bytes: &[u8],
    ) -> Result<(), String> {
        self.triangles(body, place, linear, in_file(name, bytes)?.into_iter());
        Ok(())
    }

    /// Adds triangles at a pose in their body, after a linear map of their coordinates.
    pub fn triangles(
        &mut self,
        body: usize,
        place: Pose,
        linear: Mat3,
        triangles: impl Iterator<Item = Triangle>,
    ) {
        let list = self.bodies.entry(body).or_default();
        let put = |t: Triangle| mapped(linear, t).map(|p| place.point(p));
        list.extend(triangles.take(MOST.saturating_sub(list.len())).map(put));
    }

    /// Returns a file for each body with a shape, in a folder, and sets the meshes of the bodies.
    pub fn files(&self, m: &mut Mechanism, folder: &str) -> Vec<(String, Vec<u8>)> {
        let mut files: Vec<(String, Vec<u8>)> = Vec::new();
        for (&body, triangles) in &self.bodies {
            // Balls of radius 0 are for contact only.
            let seen = |[a, b, c]: &&Triangle| {
                [a, b, c].iter().all(|p| p.is_finite()) && (*b - *a).cross(*c - *a).norm() > 0.0
            };
            let triangles: Vec<&Triangle> = triangles.iter().filter(seen).collect();
            if body == GROUND || triangles.is_empty() || m.bodies[body].pose.is_none() {
                continue;
            }
            let name = file_name(&m.bodies[body].name);
            let taken = |file: &str| files.iter().any(|f| f.0.eq_ignore_ascii_case(file));
            let wanted = format!("{folder}/{name}.stl");
            let file = if taken(&wanted) { format!("{folder}/{name}_{body}.stl") } else { wanted };
            m.bodies[body].mesh = Some(Mesh { file: file.clone() });
            files.push((file, stl(&triangles)));
        }
        files
    }
}

/// Returns the triangles of a file.
///
/// # Errors
/// Returns the reason why the file cannot be read.
pub fn in_file(name: &str, bytes: &[u8]) -> Result<Vec<Triangle>, String> {
    if name.to_ascii_lowercase().ends_with(".dae") {
        return crate::collada::triangles(&crate::decoded(bytes));
    }
    Ok(hardpoint_file::triangles(name, bytes)?.into_iter().map(|t| t.map(Vec3::from)).collect())
}

/// Returns the corners of a triangle in the order in which a linear map keeps the outer side of the surface: one that
/// mirrors reverses it.
pub fn oriented(linear: Mat3, [a, b, c]: Triangle) -> Triangle {
    if linear.is_mirror() { [a, c, b] } else { [a, b, c] }
}

/// Returns a triangle after a linear map, with the same outer side.
pub fn mapped(linear: Mat3, triangle: Triangle) -> Triangle {
    oriented(linear, triangle).map(|p| linear * p)
}

/// Returns a name without characters that are invalid in file names.
pub fn file_name(name: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' };
    name.chars().map(kept).collect()
}

/// Reports a missing shape with the reason.
pub fn report_missing_shape(
    notes: &mut ImportLog,
    kind: &str,
    name: &str,
    at: Option<SourceSpan>,
    why: &str,
) {
    notes.refused(kind, name, at, format!("the shape is not imported: {why}"));
}

/// Returns a binary STL file.
fn stl(triangles: &[&Triangle]) -> Vec<u8> {
    let mut out = vec![b' '; 80];
    let words = |v: Vec3| v.to_array().into_iter().flat_map(|x| (x as f32).to_le_bytes());
    out.extend(u32::try_from(triangles.len()).unwrap_or(u32::MAX).to_le_bytes());
    for [a, b, c] in triangles {
        let normal = (*b - *a).cross(*c - *a);
        out.extend(words(normal.unit().unwrap_or(normal)));
        [a, b, c].into_iter().for_each(|p| out.extend(words(*p)));
        out.extend([0, 0]);
    }
    out
}

fn cuboid(sides: [f64; 3]) -> Vec<Triangle> {
    let corner = |k: usize| {
        let side = |axis: usize| if k >> axis & 1 == 1 { sides[axis] / 2.0 } else { -sides[axis] / 2.0 };
        Vec3::from([side(0), side(1), side(2)])
    };
    // Corners of each face, counter-clockwise seen from outside.
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).map(|t| t.map(corner)).collect()
}

/// Outline `[radius, height]` of a ball whose halves are separated by `2 * half`.
fn arc(radius: f64, half: f64) -> Vec<[f64; 2]> {
    let point = |k: usize| {
        let angle = TAU * (k as f64 / SIDES as f64 - 0.25);
        [radius * angle.cos().max(0.0), radius * angle.sin() + if 2 * k < SIDES / 2 { -half } else { half }]
    };
    (0..=SIDES / 2).map(point).collect()
}

/// Surface of revolution of an outline `[radius, height]` about z.
fn turned(outline: &[[f64; 2]]) -> Vec<Triangle> {
    let at = |[r, z]: [f64; 2], k: usize| {
        let (sin, cos) = (TAU * (k % SIDES) as f64 / SIDES as f64).sin_cos();
        Vec3::from([r * cos, r * sin, z])
    };
    let mut out = Vec::new();
    for (low, high) in outline.iter().zip(&outline[1..]) {
        for k in 0..SIDES {
            let [a, b, c, d] = [at(*low, k), at(*low, k + 1), at(*high, k + 1), at(*high, k)];
            out.extend(
                [[a, b, c], [a, c, d]].into_iter().filter(|[p, q, r]| (*q - *p).cross(*r - *p).norm() > 0.0),
            );
        }
    }
    out
}
