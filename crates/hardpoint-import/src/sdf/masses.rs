//! Masses of links in SDFormat: explicit ones, those computed from collision shapes, and gravity.

use hardpoint::space::{Mat3, Pose, Vec3};
use roxmltree::Node;

use super::{Frame, Model, Reader, relative_to, solid_of};
use crate::markers::ElementSource;
use crate::mechanism::GROUND;
use crate::robot;
use crate::turn::{diagonal, home};
use crate::xml::{self, Vocabulary, child, children, exactly, named};

/// Default gravity of SDFormat, m/s^2.
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.8];
/// Default density of SDFormat, kg/m^3.
const DENSITY: f64 = 1000.0;
/// Known content of an inertial.
const INERTIAL: Vocabulary = Vocabulary {
    attributes: &["auto"],
    read: &["pose", "mass", "inertia", "density", "fluid_added_mass"],
    // Parameters of computations with meshes, which are not supported.
    irrelevant: &["auto_inertia_params"],
};
/// Known content of an inertia matrix.
const INERTIA: Vocabulary =
    Vocabulary { attributes: &[], read: &["ixx", "iyy", "izz", "ixy", "ixz", "iyz"], irrelevant: &[] };
/// Elements of a link with loads that the model does not support, if they have numbers other than zero.
const UNSUPPORTED: [(&str, &str); 3] = [
    ("velocity_decay", "damping of the velocity of a link has no equivalent"),
    ("damping", "damping of the velocity of a link has no equivalent"),
    ("enable_wind", "forces of wind have no equivalent"),
];

/// Mass about its centre; the inertia matrix is along the axes of the frame.
struct MassProperties {
    mass: f64,
    frame: Pose,
    inertia: Mat3,
}

impl<'d> Reader<'d, '_> {
    /// Adds the masses of links, and gravity.
    pub(super) fn masses(&mut self, outer: &[Node<'d, 'd>]) {
        let (mut massless, mut weightless) = (Vec::new(), Vec::new());
        for model in self.models.clone() {
            for link in named(model.node, "link") {
                let name = link.attribute("name").unwrap_or_default().trim();
                let Some(Frame { body, pose }) = self.frame(&model, name) else { continue };
                self.unsupported_of_link(link, &model, name);
                let has_gravity = child(link, "gravity").and_then(|g| g.text()).unwrap_or("1").trim();
                if ["0", "false"].contains(&has_gravity) && body != GROUND {
                    weightless.push((model.text, link, body));
                }
                let Some(inertial) = child(link, "inertial") else {
                    massless.push(format!("`{name}`"));
                    continue;
                };
                xml::unknown(model.text, inertial, name, INERTIAL, self.notes);
                self.poses_of(model.text, inertial, name);
                named(inertial, "inertia")
                    .for_each(|i| xml::unknown(model.text, i, name, INERTIA, self.notes));
                if let Some(added) = child(inertial, "fluid_added_mass") {
                    let why = "added mass of a fluid has no equivalent";
                    self.notes.refused("fluid_added_mass", name, xml::at(model.text, added), why);
                }
                let is_auto = inertial.attribute("auto").is_some_and(|a| ["1", "true"].contains(&a.trim()));
                let source = ElementSource { kind: "inertial", name, at: xml::at(model.text, inertial) };
                let found = if is_auto {
                    self.mass_of_collisions(link, inertial, &model, pose)
                } else {
                    Ok(self.explicit_mass(inertial, &model, pose))
                };
                match found {
                    Ok(MassProperties { mass, frame, inertia }) => {
                        robot::mass(&mut self.m, self.notes, source, body, frame, mass, Some(inertia));
                    }
                    Err(why) => self.notes.refused(source.kind, name, source.at, why),
                }
            }
        }
        if self.m.masses.is_empty() {
            return;
        }
        if !massless.is_empty() {
            let why = format!(
                "links without it have no mass, while the default of SDFormat is 1 kg: {}",
                massless.join(", ")
            );
            self.notes.approximated("inertial", "", None, why);
        }
        self.gravity(outer);
        for (text, link, body) in weightless {
            let name = link.attribute("name").unwrap_or_default().trim();
            let at = child(link, "gravity").and_then(|g| xml::at(text, g));
            let source = ElementSource { kind: "gravity", name, at };
            robot::compensate_gravity(&mut self.m, self.notes, source, body, 1.0);
        }
    }

    /// Adds gravity, which belongs to the world, or to its physics up to version 1.5.
    fn gravity(&mut self, outer: &[Node<'d, 'd>]) {
        let of = |n: &Node<'d, 'd>| child(*n, "gravity").or_else(|| child(child(*n, "physics")?, "gravity"));
        let written = outer.iter().find_map(of);
        let given = written
            .and_then(|g| exactly::<3>(g.text().unwrap_or_default(), "`gravity`", xml::at(0, g), self.notes));
        match given {
            Some(g) if g.iter().any(|x| *x != 0.0) => {
                self.m.gravity = Some(g.into());
                self.notes.taken("gravity", "", written.and_then(|g| xml::at(0, g)));
            }
            Some(_) => {}
            None => {
                self.m.gravity = Some(GRAVITY.into());
                self.notes.approximated(
                    "gravity",
                    "",
                    None,
                    "no gravity is defined: the default of SDFormat, 9.8 m/s^2 along -z, is used",
                );
            }
        }
    }

    /// Reports loads on a link that the model does not support.
    fn unsupported_of_link(&mut self, link: Node<'d, 'd>, model: &Model<'d>, name: &str) {
        for (key, why) in UNSUPPORTED {
            let Some(element) = child(link, key) else { continue };
            let acts = |n: Node<'_, '_>| {
                let word = n.text().unwrap_or_default().trim();
                word == "true" || word.parse::<f64>().is_ok_and(|x| x != 0.0)
            };
            let at = xml::at(model.text, element);
            if acts(element) || children(element).any(acts) {
                self.notes.refused(key, name, at, why);
            } else {
                self.notes.ignored(key, at);
            }
        }
    }

    /// Returns a number in an element, if present.
    fn number(&mut self, model: &Model<'d>, node: Node<'d, 'd>, key: &'static str) -> Option<f64> {
        let n = child(node, key)?;
        let words = n.text().unwrap_or_default();
        exactly::<1>(words, &format!("`{key}`"), xml::at(model.text, n), self.notes).map(|[x]| x)
    }

    /// Returns the global pose of an element in a link.
    fn pose_in_link(&mut self, node: Node<'d, 'd>, model: &Model<'d>, link: Pose) -> Pose {
        let written = child(node, "pose");
        let base = written.and_then(relative_to).and_then(|frame| self.frame(model, frame));
        let base = base.map_or(link, |frame| frame.pose);
        base.compose(written.map_or_else(home, |p| self.written_pose(model.text, p)))
    }

    fn explicit_mass(&mut self, inertial: Node<'d, 'd>, model: &Model<'d>, link: Pose) -> MassProperties {
        let frame = self.pose_in_link(inertial, model, link);
        // Defaults of SDFormat.
        let mass = self.number(model, inertial, "mass").unwrap_or(1.0);
        let i = child(inertial, "inertia");
        let mut entry =
            |key: &'static str, default: f64| i.and_then(|i| self.number(model, i, key)).unwrap_or(default);
        let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|key| entry(key, 1.0));
        let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|key| entry(key, 0.0));
        let inertia = Mat3 { cols: [[xx, xy, xz].into(), [xy, yy, yz].into(), [xz, yz, zz].into()] };
        MassProperties { mass, frame, inertia }
    }

    /// Returns the mass of the collision shapes of a link, scaled to its mass if that is defined.
    fn mass_of_collisions(
        &mut self,
        link: Node<'d, 'd>,
        inertial: Node<'d, 'd>,
        model: &Model<'d>,
        pose: Pose,
    ) -> Result<MassProperties, String> {
        let default = self.number(model, inertial, "density").unwrap_or(DENSITY);
        let mut parts = Vec::new();
        for collision in named(link, "collision") {
            let density = self.number(model, collision, "density").unwrap_or(default);
            let (volume, per_mass, centre) = moments_of(collision)?;
            let mass = density * volume;
            let place = self.pose_in_link(collision, model, pose);
            let matrix = diagonal(per_mass.map(|i| mass * i));
            let inertia = place.rot * matrix * place.rot.transpose();
            parts.push((mass, place.point([0.0, 0.0, centre].into()), inertia));
        }
        let sum: f64 = parts.iter().map(|part| part.0).sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return Err("its mass is to be computed from collision shapes, but they have no mass".into());
        }
        let mass = self.number(model, inertial, "mass").unwrap_or(sum);
        let scale = mass / sum;
        let centre = parts.iter().fold(Vec3::zero(), |c, (m, r, _)| c + *r * (m / sum));
        let scaled = parts.iter().map(|(m, r, own)| (m * scale, *r - centre, *own * diagonal([scale; 3])));
        let inertia = robot::combined(scaled);
        Ok(MassProperties { mass, frame: Pose { rot: home().rot, r: centre }, inertia })
    }
}

/// Returns the volume of a collision shape, its moments of inertia about its centre per unit of mass, and the position
/// of the centre on its z axis.
fn moments_of(collision: Node<'_, '_>) -> Result<(f64, [f64; 3], f64), String> {
    let shape = child(collision, "geometry").and_then(|g| children(g).next());
    let Some(shape) = shape else {
        return Err("its mass is to be computed from a collision without a shape".into());
    };
    if shape.has_tag_name("cone") {
        let size = |key| child(shape, key).and_then(|n| xml::numbers(n.text()?)?.first().copied());
        let (Some(r), Some(l)) = (size("radius"), size("length")) else {
            return Err("its mass is to be computed from a cone whose size is not numeric".into());
        };
        let across = 0.15 * r * r + 0.0375 * l * l;
        return Ok((std::f64::consts::PI * r * r * l / 3.0, [across, across, 0.3 * r * r], -l / 4.0));
    }
    match solid_of(shape) {
        Some(Ok(solid)) => {
            let (volume, per_mass) = solid.moments();
            Ok((volume, per_mass, 0.0))
        }
        Some(Err(why)) => Err(format!("its mass is to be computed from a collision: {why}")),
        None => {
            let kind = shape.tag_name().name();
            Err(format!("masses computed from collisions of type `{kind}` are not supported"))
        }
    }
}
