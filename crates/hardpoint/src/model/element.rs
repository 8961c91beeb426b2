//! Sources of a mechanism's loads: masses, springs, given forces.

use crate::joint::Quantity;
use crate::law::Law;
use crate::model::{
    BodyId, Dimension, Direction, Formula, GROUND, JointId, Model, MomentTable, NumberId, PointId, Solid,
    SpringTable, Target, WheelId,
};
use crate::number::Real;
use crate::space::{Mat3, Vec3};

/// A mass or an applied force.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Name.
    pub name: String,
    /// Kind of the element.
    pub kind: ElementKind,
}

/// An element's place in [`Model::elements`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ElementId(pub usize);

/// Along which axes something is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// The global ones.
    #[default]
    Global,
    /// Those of its body, which are the global ones in the design configuration and turn with it.
    Body,
    /// Those of its joint's marker.
    Joint,
}

impl Axes {
    /// As model files write them, and what they are.
    pub const WORDS: &[(&str, &str)] = &[
        ("global", "The global axes."),
        ("body", "The global axes in the design configuration, turning with the body."),
        ("joint", "Those of the joint on that body: z along its axis."),
    ];

    /// That of a place in [`WORDS`](Self::WORDS).
    pub fn at(word: usize) -> Self {
        [Self::Global, Self::Body, Self::Joint][word]
    }
}

/// Point of a wheel at which a force acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WheelPoint {
    /// The contact point.
    #[default]
    Contact,
    /// The wheel centre.
    Centre,
}

impl WheelPoint {
    /// As model files write them, and what they are.
    pub const WORDS: &[(&str, &str)] = &[("contact", "The contact point."), ("centre", "The wheel centre.")];

    /// That of a place in [`WORDS`](Self::WORDS).
    pub fn at(word: usize) -> Self {
        [Self::Contact, Self::Centre][word]
    }
}

/// Declares the kinds of numbers that elements have.
macro_rules! numbers {
    ($($(#[doc = $doc:literal])* $name:ident)*) => {
        /// Unit of a number of an element.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum ElementUnit { $($(#[doc = $doc])* $name,)* }

        $(
            $(#[doc = $doc])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            pub struct $name(pub NumberId);
        )*

        /// The kinds of numbers, for those who handle them all.
        macro_rules! each_number {
            ($do:ident) => { $($do!($name);)* };
        }
        pub(crate) use each_number;
    };
}

numbers! {
    /// A mass, kg.
    Mass
    /// A moment of inertia, kg m^2.
    Inertia
    /// A density, kg/m^3.
    Density
    /// A length, m.
    Length
    /// An angle, rad.
    Angle
    /// A force, N.
    Force
    /// A moment, N m.
    Moment
    /// A stiffness, N/m.
    Stiffness
    /// A stiffness per square or cube of the way, N/m^3.
    CubicStiffness
    /// A damping, N s/m.
    Damping
    /// A torsional stiffness, N m/rad.
    TorsionalStiffness
    /// A torsional stiffness per square of the angle, N m/rad^3.
    CubicTorsionalStiffness
    /// A torsional damping, N m s/rad.
    TorsionalDamping
    /// A stiffness that couples a displacement with an angle: a force per angle, N/rad.
    Coupling
    /// A plain number.
    Plain
}

/// The ends of a spring that are closer than this part of the mechanism's size meet: positions are solved to 1e-12 of
/// it, so that the line between the ends would have lost three of its digits or all.
pub const ENDS_MEET: f64 = 1e-9;

/// The types of elements: their fields, as written and as they mean in a model. With its file in `element/`, which has
/// its properties, check and formula, a type is complete. Elements with elastic laws share the fields of these.
macro_rules! elements {
    ($declare:ident) => {
        elements! { $declare {
            /// About x.
            about_x: Option<NumberDraft> => Option<TorsionalStiffness>,
            /// About y.
            about_y: Option<NumberDraft> => Option<TorsionalStiffness>,
            /// About z.
            about_z: Option<NumberDraft> => Option<TorsionalStiffness>,
            /// Further stiffnesses: a symmetric matrix with the rows and columns x, y, z, about_x, about_y, about_z.
            matrix: Option<Box<[[NumberDraft; 6]; 6]>> => Option<CoupledStiffness>,
            /// Cubic stiffness along x: a further force of this times the cube of the displacement.
            cubic_x: Option<NumberDraft> => Option<CubicStiffness>,
            /// Along y.
            cubic_y: Option<NumberDraft> => Option<CubicStiffness>,
            /// Along z.
            cubic_z: Option<NumberDraft> => Option<CubicStiffness>,
            /// Cubic stiffness about x: a further moment of this times the cube of the angle.
            cubic_about_x: Option<NumberDraft> => Option<CubicTorsionalStiffness>,
            /// About y.
            cubic_about_y: Option<NumberDraft> => Option<CubicTorsionalStiffness>,
            /// About z.
            cubic_about_z: Option<NumberDraft> => Option<CubicTorsionalStiffness>,
            /// A further force against the displacement along x, as a curve: `[displacement, force]`, the force in N.
            curve_x: Option<Vec<TablePointDraft>> => Option<SpringTable>,
            /// Along y.
            curve_y: Option<Vec<TablePointDraft>> => Option<SpringTable>,
            /// Along z.
            curve_z: Option<Vec<TablePointDraft>> => Option<SpringTable>,
            /// A further moment against the angle about x, as a curve: `[angle, moment]`, the moment in N m.
            curve_about_x: Option<Vec<TablePointDraft>> => Option<MomentTable>,
            /// About y.
            curve_about_y: Option<Vec<TablePointDraft>> => Option<MomentTable>,
            /// About z.
            curve_about_z: Option<Vec<TablePointDraft>> => Option<MomentTable>,
            /// Factor of the forces of `curve_x`. Default: 1.
            scale_x: Option<NumberDraft> => Option<Plain>,
            /// Factor of `curve_y`.
            scale_y: Option<NumberDraft> => Option<Plain>,
            /// Factor of `curve_z`.
            scale_z: Option<NumberDraft> => Option<Plain>,
            /// Factor of the moments of `curve_about_x`. Default: 1.
            scale_about_x: Option<NumberDraft> => Option<Plain>,
            /// Factor of `curve_about_y`.
            scale_about_y: Option<NumberDraft> => Option<Plain>,
            /// Factor of `curve_about_z`.
            scale_about_z: Option<NumberDraft> => Option<Plain>,
            /// Preload: the force that pushes the second body along x in the design configuration.
            preload_x: Option<NumberDraft> => Option<Force>,
            /// Along y.
            preload_y: Option<NumberDraft> => Option<Force>,
            /// Along z.
            preload_z: Option<NumberDraft> => Option<Force>,
            /// The moment that turns the second body about x in the design configuration.
            preload_about_x: Option<NumberDraft> => Option<Moment>,
            /// About y.
            preload_about_y: Option<NumberDraft> => Option<Moment>,
            /// About z.
            preload_about_z: Option<NumberDraft> => Option<Moment>,
        } }
    };
    ($declare:ident { $($laws:tt)* }) => {
        $declare! {
        /// A rigid mass: a point mass, unless its inertia is given.
        Rigid "rigid" masses {
            /// Centre: a point of the body that it belongs to.
            centre: PointRef => PointId,
            /// Mass.
            mass: NumberDraft => Mass,
            /// Moment of inertia about its centre, or about the point `about`: about the global x axis in the design
            /// configuration.
            ixx: Option<NumberDraft> => Option<Inertia>,
            /// The same about y.
            iyy: Option<NumberDraft> => Option<Inertia>,
            /// The same about z.
            izz: Option<NumberDraft> => Option<Inertia>,
            /// The product of inertia, the integral of x y; an entry of the inertia matrix is its opposite.
            ixy: Option<NumberDraft> => Option<Inertia>,
            /// The integral of y z.
            iyz: Option<NumberDraft> => Option<Inertia>,
            /// The integral of z x.
            izx: Option<NumberDraft> => Option<Inertia>,
            /// The point of the same body that these are about. Default: its centre.
            about: Option<PointRef> => Option<PointId>,
        }

        /// A round bar or tube between two points of a body; it follows them when the design moves them.
        Bar "bar" masses {
            /// From this point.
            from: PointRef => PointId,
            /// To this one, of the same body.
            to: PointRef => PointId,
            /// Outer diameter.
            diameter: NumberDraft => Length,
            /// The diameter of its bore. Default: it is solid.
            bore: Option<NumberDraft> => Option<Length>,
            /// Density, kg/m^3; steel has 7850.
            density: NumberDraft => Density,
        }

        /// A block, its edges along the global axes in the design configuration.
        Block "block" masses {
            /// Centre: a point of the body that it belongs to.
            centre: PointRef => PointId,
            /// Edge along x.
            x: NumberDraft => Length,
            /// Edge along y.
            y: NumberDraft => Length,
            /// Edge along z.
            z: NumberDraft => Length,
            /// Density, kg/m^3; steel has 7850.
            density: NumberDraft => Density,
        }

        /// A body of even density with the shape of a closed mesh. Its shape is constant: changes of the design do not
        /// bend it.
        Mesh "mesh" masses {
            /// The body that it belongs to.
            body: String => BodyId,
            /// Surface. Default: the `mesh` of its body.
            mesh: Solid => Solid,
            /// Density, kg/m^3; steel has 7850.
            density: NumberDraft => Density,
        }

        /// A spring and damper between two points.
        Spring "spring" forces {
            /// One end.
            from: PointRef => PointId,
            /// The other one.
            to: PointRef => PointId,
            /// Stiffness. May be left out where a table gives its force.
            stiffness: Option<NumberDraft> => Option<Stiffness>,
            /// The further force per cube of its deflection: progressive, if it is above zero.
            cubic: Option<NumberDraft> => Option<CubicStiffness>,
            /// Force by a table: points `[way, force]` of how far it is shorter than its free length, and how hard it
            /// pushes there; or the name of a CSV file that holds them.
            compression: Option<Vec<TablePointDraft>> => Option<SpringTable>,
            /// The same of how far it is longer, and how hard it pulls.
            extension: Option<Vec<TablePointDraft>> => Option<SpringTable>,
            /// Factor of the forces in the table. Default: 1.
            scale: Option<NumberDraft> => Option<Plain>,
            /// The length that its deflection counts from, at which a spring without a table has no force. Default:
            /// that of the drawing, or what `preload` makes it.
            free_length: Option<NumberDraft> => Option<Length>,
            /// The force with which it pulls its ends together in the design configuration; a spring that pushes them
            /// apart has one below zero.
            preload: Option<NumberDraft> => Option<Force>,
            /// Damping.
            damping: Option<NumberDraft> => Option<Damping>,
        }

        /// A spring and damper along a joint's sliding coordinate.
        JointSpring "joint_spring" forces {
            /// The joint.
            joint: String => JointId,
            /// Coordinate of the joint; may be left out if it has only one.
            coordinate: Option<String> => usize,
            /// Stiffness.
            stiffness: NumberDraft => Stiffness,
            /// The coordinate at which it pushes nothing; it counts from the drawing. Default: 0.
            equilibrium: Option<NumberDraft> => Option<Length>,
            /// A further force against the way from `equilibrium`, as a curve: `[way, force]`, the force in N.
            curve: Option<Vec<TablePointDraft>> => Option<SpringTable>,
            /// Factor of the forces of `curve`. Default: 1.
            scale: Option<NumberDraft> => Option<Plain>,
            /// Damping.
            damping: Option<NumberDraft> => Option<Damping>,
        }

        /// A spring and damper about a joint's axis.
        TorsionSpring "torsion_spring" forces {
            /// The joint.
            joint: String => JointId,
            /// Angle of the joint; may be left out if it has only one.
            coordinate: Option<String> => usize,
            /// Stiffness.
            stiffness: NumberDraft => TorsionalStiffness,
            /// The angle at which it turns nothing; it counts from the drawing. Default: 0.
            equilibrium: Option<NumberDraft> => Option<Angle>,
            /// A further moment against the angle from `equilibrium`, as a curve: `[angle, moment]`, the moment in N m.
            curve: Option<Vec<TablePointDraft>> => Option<MomentTable>,
            /// Factor of the moments of `curve`. Default: 1.
            scale: Option<NumberDraft> => Option<Plain>,
            /// Damping, or a viscous friction of the joint.
            damping: Option<NumberDraft> => Option<TorsionalDamping>,
        }

        /// Coulomb friction in a hinge or ball joint, from the force that it carries, and viscous friction besides.
        Friction "friction" forces {
            /// The joint: a revolute, a cylindrical joint as far as it turns, or a spherical one.
            joint: String => JointId,
            /// The coefficient of friction.
            coefficient: NumberDraft => Plain,
            /// The radius of its pin or ball.
            radius: NumberDraft => Length,
            /// Length of the bearing, centred at the joint's point on its second body. The moment across the axis then
            /// adds normal forces at both ends. Default: only the force counts.
            length: Option<NumberDraft> => Option<Length>,
            /// A further moment against the motion in proportion to its speed.
            viscous: Option<NumberDraft> => Option<TorsionalDamping>,
            /// Speed, per second, below which friction goes smoothly to zero; at rest it is zero. Default: 0.01 rad/s.
            transition_velocity: Option<NumberDraft> => Option<Angle>,
        }

        /// Coulomb friction in a slide, from the force that it carries across its axis, and viscous friction besides.
        SlideFriction "slide_friction" forces {
            /// The joint: a translational one, or a cylindrical one as far as it slides.
            joint: String => JointId,
            /// The coefficient of friction.
            coefficient: NumberDraft => Plain,
            /// Length of the guide, centred at the joint's point on its second body. The moment across the axis then
            /// adds normal forces at both ends. Default: only the force counts.
            length: Option<NumberDraft> => Option<Length>,
            /// Direction across the axis, in the design configuration, in which normal forces are ignored, with the
            /// moments about the other directions. Default: in a planar model the normal of the plane; otherwise none.
            ignored_direction: Option<Vec3> => Option<Vec3>,
            /// A further force against the motion in proportion to its speed.
            viscous: Option<NumberDraft> => Option<Damping>,
            /// Speed, per second, below which friction goes smoothly to zero; at rest it is zero. Default: 1 mm/s.
            transition_velocity: Option<NumberDraft> => Option<Length>,
        }

        /// A given force on a point.
        PointForce "force" forces {
            /// The point.
            at: PointRef => PointId,
            /// Size; below zero it pushes the other way.
            force: NumberDraft => Force,
            /// Direction of the force, of any length.
            along: Vec3 => Vec3,
            /// True if that direction turns with the body.
            axes: Option<Axes> => Option<Axes>,
            /// Factor over time.
            law: Option<Law> => Option<Law>,
        }

        /// A given force and moment of the road on a wheel, along the wheel's own directions.
        WheelForce "wheel_force" forces {
            /// The wheel's name.
            wheel: String => WheelId,
            /// The contact, for outboard brakes, or the wheel centre, for half shafts. Default: the contact.
            at: Option<WheelPoint> => Option<WheelPoint>,
            /// Along the ground, away from the vehicle: the horizontal part of the spin axis.
            outboard: Option<NumberDraft> => Option<Force>,
            /// Along the ground in the wheel's plane.
            forward: Option<NumberDraft> => Option<Force>,
            /// Along z: the wheel load.
            up: Option<NumberDraft> => Option<Force>,
            /// The aligning torque: a moment about z on a left wheel, about -z on a right one.
            about_up: Option<NumberDraft> => Option<Moment>,
            /// Factor of all components over time.
            law: Option<Law> => Option<Law>,
        }

        /// A given moment on a body.
        BodyMoment "moment" forces {
            /// The body's name.
            body: String => BodyId,
            /// Size; below zero it turns the other way.
            moment: NumberDraft => Moment,
            /// About which direction, of any length.
            about: Vec3 => Vec3,
            /// True if that direction turns with the body.
            axes: Option<Axes> => Option<Axes>,
            /// Factor over time.
            law: Option<Law> => Option<Law>,
        }

        /// A tyre: a vertical spring between the road and the contact point of a wheel.
        Tyre "tyre" forces {
            /// The wheel's name.
            wheel: String => WheelId,
            /// Vertical stiffness.
            stiffness: NumberDraft => Stiffness,
            /// The vertical load in the design configuration. Default: 0.
            preload: Option<NumberDraft> => Option<Force>,
            /// Height of the road over its place in the design configuration. Default: 0.
            height: Option<NumberDraft> => Option<Length>,
            /// Factor of that height over time.
            law: Option<Law> => Option<Law>,
        }

        /// A bushing: springs and dampers between two bodies at a place, along axes that are fixed in the first.
        Bushing "bushing" forces {
            /// Place on the first body.
            from: PointRef => PointId,
            /// The same place on the second one.
            to: PointRef => PointId,
            /// Direction of its z axis in the design configuration. Default: its axes are the global ones there.
            axis: Option<DirectionDraft> => Option<Direction>,
            /// Direction of its x axis, or its part perpendicular to `axis`. Required with `axis` if x and y differ.
            axis2: Option<DirectionDraft> => Option<Direction>,
            /// Stiffness along x.
            x: NumberDraft => Stiffness,
            /// Along y.
            y: NumberDraft => Stiffness,
            /// Along z.
            z: NumberDraft => Stiffness,
            $($laws)*
            /// Damping, the same along all axes.
            damping: Option<NumberDraft> => Option<Damping>,
        }

        /// A joint that gives along its own axes, z along its `axis`, x along its `axis2`: under load with
        /// `[equilibrium]`, otherwise only for measures of `compliance`.
        ElasticJoint "elastic_joint" forces {
            /// The joint.
            joint: String => JointId,
            /// Stiffness along x. Default: it is rigid, and so for all that are left out.
            x: Option<NumberDraft> => Option<Stiffness>,
            /// Along y.
            y: Option<NumberDraft> => Option<Stiffness>,
            /// Along z.
            z: Option<NumberDraft> => Option<Stiffness>,
            $($laws)*
        }
        }
    };
}
pub(crate) use elements;

/// The first expression for a type of `masses`, the second for one of `forces`.
macro_rules! if_mass {
    (masses, $mass:expr, $force:expr) => {
        $mass
    };
    (forces, $mass:expr, $force:expr) => {
        $force
    };
}
pub(crate) use if_mass;

/// Properties of a mass.
pub(crate) trait MassProperties {
    /// Returns the body that it belongs to.
    fn body(&self, model: &Model) -> BodyId;

    /// Returns its mass, kg, from the values of numbers and the distance of two points, m.
    fn mass<T: Real>(&self, number: impl Fn(NumberId) -> T, distance: impl Fn(PointId, PointId) -> T) -> T;
}

/// Properties of a force.
pub(crate) trait ForceProperties {
    /// Returns what the program uses besides the formulas.
    fn properties(&self, model: &Model) -> Properties<'_>;
}

/// Properties of a force besides its formulas. Every type defines all of them.
#[derive(Clone, Copy, Debug)]
pub struct Properties<'a> {
    /// Part of the model that it acts on.
    pub acts_on: ActsOn,
    /// Directions of its z and x axes, which are fixed in its first body, if they are not the global ones.
    pub axes: [Option<Direction>; 2],
    /// Dimension of its magnitude.
    pub dimension: Dimension,
    /// Forces or moments that the element defines.
    pub given: [Option<NumberId>; 3],
    /// Table of its force, after its key in model files.
    pub table: Option<(&'static str, &'a SpringTable)>,
    /// The law that it is multiplied by.
    pub law: Option<&'a Law>,
    /// True if its formula is arithmetic on where bodies are, which can be recorded: it looks up no table, and has no
    /// branch.
    pub is_arithmetic: bool,
    /// Compliance under load.
    pub compliance: Compliance<'a>,
    /// Coulomb friction.
    pub friction: Option<JointFriction>,
}

/// Symmetric stiffness matrix of the directions x, y, z, about_x, about_y and about_z.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoupledStiffness {
    /// Entries on the diagonal and above it; those that are always zero are left out.
    pub entries: Vec<StiffnessEntry>,
}

/// Entry of a symmetric stiffness matrix, and of its transpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StiffnessEntry {
    /// Row.
    pub row: usize,
    /// Column, not before the row.
    pub column: usize,
    /// Value.
    pub value: NumberId,
}

impl CoupledStiffness {
    /// Unit of an entry.
    pub fn unit(row: usize, column: usize) -> ElementUnit {
        match (row < 3, column < 3) {
            (true, true) => ElementUnit::Stiffness,
            (false, false) => ElementUnit::TorsionalStiffness,
            (true, false) | (false, true) => ElementUnit::Coupling,
        }
    }

    /// Entry of a row and column, or of its transpose.
    pub fn entry(&self, row: usize, column: usize) -> Option<NumberId> {
        let at = (row.min(column), row.max(column));
        self.entries.iter().find(|e| (e.row, e.column) == at).map(|e| e.value)
    }
}

/// Elastic law along x, y and z and about them.
#[derive(Clone, Copy, Debug)]
pub struct ElasticLaw<'a> {
    /// Laws of single directions.
    pub directions: [Elasticity<'a>; 6],
    /// Further stiffness that couples them.
    pub coupled: Option<&'a CoupledStiffness>,
}

impl ElasticLaw<'_> {
    /// Directions that give: those with a stiffness or a curve of their own.
    pub fn gives(&self) -> [bool; 6] {
        std::array::from_fn(|k| self.directions[k].gives() || self.in_matrix(k, k).is_some())
    }

    /// Entry of the matrix.
    pub fn in_matrix(&self, row: usize, column: usize) -> Option<NumberId> {
        self.coupled?.entry(row, column)
    }

    /// True if a turn about z causes any force.
    pub fn resists_turns_about_z(&self) -> bool {
        let mut coupled = self.coupled.iter().flat_map(|matrix| &matrix.entries);
        self.directions[5].resists() || coupled.any(|e| e.row == 5 || e.column == 5)
    }

    /// True if the force depends on positions by arithmetic alone.
    pub fn is_arithmetic(&self) -> bool {
        self.directions.iter().all(|of| of.curve.is_none())
    }

    /// Numbers whose sum is the stiffness of a row and column in the design configuration without load.
    pub fn stiffnesses(&self, row: usize, column: usize) -> impl Iterator<Item = NumberId> + use<> {
        let own = self.directions[row].stiffness.filter(|_| row == column);
        [own, self.in_matrix(row, column)].into_iter().flatten()
    }
}

/// Keys of the curves of an elastic law.
pub const CURVES: [&str; 6] =
    ["curve_x", "curve_y", "curve_z", "curve_about_x", "curve_about_y", "curve_about_z"];
/// Keys of the factors of these curves.
pub(crate) const SCALES: [&str; 6] =
    ["scale_x", "scale_y", "scale_z", "scale_about_x", "scale_about_y", "scale_about_z"];

/// Curve of a force over a deflection.
#[derive(Clone, Copy, Debug)]
pub struct ForceCurve<'a> {
    /// The element.
    pub element: ElementId,
    /// Direction of an elastic joint or bushing: 0 to 2 along x, y and z, 3 to 5 about them.
    pub direction: Option<usize>,
    /// Key in model files.
    pub key: &'static str,
    /// Points.
    pub table: &'a SpringTable,
}

impl ForceCurve<'_> {
    /// Quantity of the deflections: a curve over an angle has moments.
    pub fn quantity(&self, model: &Model) -> Quantity {
        let is_angle = match self.direction {
            Some(direction) => direction >= 3,
            None => model.force_dimension(self.element) == Dimension::MOMENT,
        };
        if is_angle { Quantity::Angle } else { Quantity::Length }
    }

    /// A deflection as model files have it: a compression is a negative extension.
    pub fn as_written(&self, deflection: f64) -> f64 {
        if self.key == "compression" { -deflection } else { deflection }
    }
}

/// Elastic law of one direction: `s(e) = k e + k_3 e^3 + f C(e) - f_0`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Elasticity<'a> {
    /// Stiffness k.
    pub stiffness: Option<NumberId>,
    /// Cubic stiffness k_3.
    pub cubic: Option<NumberId>,
    /// Curve C of a force over the displacement, or of a moment over the angle.
    pub curve: Option<&'a SpringTable>,
    /// Factor f of the curve; 1 without it.
    pub scale: Option<NumberId>,
    /// Preload f_0, which pushes the second body along the direction.
    pub preload: Option<NumberId>,
}

impl Elasticity<'_> {
    /// True if the direction gives.
    pub fn gives(&self) -> bool {
        self.stiffness.is_some() || self.curve.is_some()
    }

    /// True if a displacement along it causes a force.
    pub fn resists(&self) -> bool {
        self.gives() || self.cubic.is_some()
    }
}

/// Elastic law of a direction with a stiffness, from the fields of these names.
macro_rules! direction {
    ($of:ident, $stiffness:expr, $cubic:ident, $curve:ident, $scale:ident, $preload:ident) => {
        Elasticity {
            stiffness: $stiffness,
            cubic: $of.$cubic.map(|n| n.0),
            curve: $of.$curve.as_ref().map(AsRef::as_ref),
            scale: $of.$scale.map(|n| n.0),
            preload: $of.$preload.map(|n| n.0),
        }
    };
}

/// Elastic law of an element; `$wrap` makes its stiffness along an axis an optional number.
macro_rules! elastic_law {
    ($of:expr, $wrap:expr) => {{
        let (of, wrap) = ($of, $wrap);
        let about = |n: Option<TorsionalStiffness>| n.map(|n| n.0);
        let directions = [
            direction!(of, wrap(of.x), cubic_x, curve_x, scale_x, preload_x),
            direction!(of, wrap(of.y), cubic_y, curve_y, scale_y, preload_y),
            direction!(of, wrap(of.z), cubic_z, curve_z, scale_z, preload_z),
            direction!(of, about(of.about_x), cubic_about_x, curve_about_x, scale_about_x, preload_about_x),
            direction!(of, about(of.about_y), cubic_about_y, curve_about_y, scale_about_y, preload_about_y),
            direction!(of, about(of.about_z), cubic_about_z, curve_about_z, scale_about_z, preload_about_z),
        ];
        ElasticLaw { directions, coupled: of.matrix.as_ref() }
    }};
}

impl Bushing {
    /// Elastic law along and about its axes.
    pub fn law(&self) -> ElasticLaw<'_> {
        elastic_law!(self, |n: Stiffness| Some(n.0))
    }
}

impl ElasticJoint {
    /// Elastic law along and about the joint's axes.
    pub fn law(&self) -> ElasticLaw<'_> {
        elastic_law!(self, |n: Option<Stiffness>| n.map(|n| n.0))
    }
}

/// Part of a model that a force acts on.
#[derive(Clone, Copy, Debug)]
pub enum ActsOn {
    /// Two points, along the line between them.
    Line([PointId; 2]),
    /// Two points.
    Points([PointId; 2]),
    /// A point.
    Point(PointId),
    /// A wheel, at its contact point.
    Wheel(WheelId),
    /// A body.
    Body(BodyId),
    /// A coordinate of a joint.
    Coordinate(JointId, usize),
    /// A joint.
    Joint(JointId),
}

impl ActsOn {
    /// Bodies that the force acts on. If it acts on a single body, the first is ground.
    pub fn bodies(self, model: &Model) -> [BodyId; 2] {
        let body = |p: PointId| model.points[p.0].body;
        match self {
            Self::Line(points) | Self::Points(points) => points.map(body),
            Self::Point(point) => [GROUND, body(point)],
            Self::Wheel(wheel) => [GROUND, model.wheels[wheel.0].body],
            Self::Body(body) => [GROUND, body],
            Self::Coordinate(joint, _) | Self::Joint(joint) => model.joints[joint.0].bodies,
        }
    }

    /// Points at which the force acts.
    pub fn points(self, model: &Model) -> [Option<PointId>; 2] {
        match self {
            Self::Line(points) | Self::Points(points) => points.map(Some),
            Self::Point(point) => [Some(point), None],
            // The contact point moves over the wheel.
            Self::Wheel(wheel) => [Some(model.wheels[wheel.0].centre), None],
            Self::Body(_) | Self::Coordinate(..) | Self::Joint(_) => [None; 2],
        }
    }
}

/// Compliance of a force element.
#[derive(Clone, Copy, Debug)]
pub enum Compliance<'a> {
    /// It does not deflect under load.
    None,
    /// It deflects: its force depends on the position.
    Element,
    /// The joint deflects along and about its axes; directions that do not give are rigid.
    Joint(&'a ElasticJoint),
}

/// Coulomb friction in a joint, and viscous friction besides.
#[derive(Clone, Copy, Debug)]
pub struct JointFriction {
    /// The joint.
    pub joint: JointId,
    /// Coordinate that the friction acts on; none in a ball joint.
    pub coordinate: Option<usize>,
    /// The coefficient of friction.
    pub coefficient: NumberId,
    /// Radius of the pin or ball, if the friction is a moment.
    pub radius: Option<NumberId>,
    /// Length of the bearing or guide.
    pub length: Option<NumberId>,
    /// Direction in which normal forces are ignored.
    pub ignored_direction: Option<Vec3>,
    /// Viscous friction.
    pub viscous: Option<NumberId>,
    /// Transition velocity.
    pub transition_velocity: Option<NumberId>,
    /// Transition velocity by default, rad/s or m/s.
    pub default_transition_velocity: f64,
}

/// Element types with references resolved to ids.
macro_rules! in_models {
    ($(
        $(#[doc = $doc:literal])* $variant:ident $name:literal $table:ident {
            $($(#[doc = $field_doc:literal])* $field:ident: $draft:ty => $type:ty),* $(,)?
        }
    )*) => {
        /// Kind of an element. The formulas are in `docs/loads.md`.
        #[derive(Clone, Debug, PartialEq)]
        pub enum ElementKind {
            $($(#[doc = $doc])* $variant($variant),)*
        }

        $(
            $(#[doc = $doc])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $variant {
                $($(#[doc = $field_doc])* pub $field: $type,)*
            }
        )*

        #[allow(unused_variables, reason = "a question to masses does not look at forces, and vice versa")]
        impl ElementKind {
            /// Name of its type in model files.
            pub fn type_name(&self) -> &'static str {
                match self { $(Self::$variant(_) => $name),* }
            }

            /// True if it has mass; all others are forces.
            pub fn has_mass(&self) -> bool {
                match self { $(Self::$variant(_) => if_mass!($table, true, false)),* }
            }

            /// Returns the body that a mass belongs to.
            pub fn mass_on(&self, model: &Model) -> Option<BodyId> {
                match self { $(Self::$variant(e) => if_mass!($table, Some(e.body(model)), None)),* }
            }

            /// Mass in the design configuration, kg.
            fn mass(&self, model: &Model) -> f64 {
                let number = |n: NumberId| model.numbers[n.0].value;
                let position = |p: PointId| model.position(model.points[p.0].at);
                let distance = |p, q| (position(q) - position(p)).norm();
                match self { $(Self::$variant(e) => if_mass!($table, e.mass(number, distance), 0.0)),* }
            }

            /// Properties of a force; `None` for a mass.
            #[inline]
            pub fn force(&self, model: &Model) -> Option<Properties<'_>> {
                match self { $(Self::$variant(e) => if_mass!($table, None, Some(e.properties(model)))),* }
            }
        }
    };
}
elements!(in_models);

impl ElementKind {
    /// Coulomb friction of the element, if it is a friction element: its force depends on joint reactions, which it
    /// changes.
    #[inline]
    pub fn friction(&self, model: &Model) -> Option<JointFriction> {
        self.force(model)?.friction
    }

    /// True if it is a friction element.
    pub fn has_friction(&self, model: &Model) -> bool {
        self.friction(model).is_some()
    }

    /// Magnitude of the force in the design configuration, N, if the element defines one: a given force, a preload, or
    /// the largest force of a table.
    pub fn given_force(&self, model: &Model) -> f64 {
        let Some(Properties { given, table, dimension, .. }) = self.force(model) else { return 0.0 };
        let given = given.into_iter().flatten().map(|n| model.numbers[n.0].value.abs()).reduce(f64::max);
        let in_table = || table.map_or(0.0, |(_, t)| t.points().map(|p| p[1].abs()).fold(0.0, f64::max));
        let force = given.unwrap_or_else(in_table);
        if dimension == Dimension::MOMENT { force / model.size() } else { force }
    }

    /// True if a law multiplies it, which a case or a measured posture may replace: a given force or moment, or a tyre.
    pub fn has_law(&self) -> bool {
        self.clone().law_mut().is_some()
    }

    /// Place of the law of a given force or moment; `None` for elements that have none.
    pub(crate) fn law_mut(&mut self) -> Option<&mut Option<Law>> {
        match self {
            Self::PointForce(force) => Some(&mut force.law),
            Self::WheelForce(force) => Some(&mut force.law),
            Self::BodyMoment(moment) => Some(&mut moment.law),
            Self::Tyre(tyre) => Some(&mut tyre.law),
            Self::Rigid(_)
            | Self::Bar(_)
            | Self::Block(_)
            | Self::Mesh(_)
            | Self::Spring(_)
            | Self::JointSpring(_)
            | Self::TorsionSpring(_)
            | Self::Friction(_)
            | Self::SlideFriction(_)
            | Self::Bushing(_)
            | Self::ElasticJoint(_) => None,
        }
    }

    /// Elastic law along and about three axes, of elements that have one.
    pub(crate) fn elastic_law(&self) -> Option<ElasticLaw<'_>> {
        match self {
            Self::Bushing(bushing) => Some(bushing.law()),
            Self::ElasticJoint(joint) => Some(joint.law()),
            Self::Rigid(_)
            | Self::Bar(_)
            | Self::Block(_)
            | Self::Mesh(_)
            | Self::Spring(_)
            | Self::JointSpring(_)
            | Self::TorsionSpring(_)
            | Self::Friction(_)
            | Self::SlideFriction(_)
            | Self::PointForce(_)
            | Self::WheelForce(_)
            | Self::BodyMoment(_)
            | Self::Tyre(_) => None,
        }
    }

    /// The law that a given force or moment is multiplied by.
    #[inline]
    pub(crate) fn law(&self, model: &Model) -> Option<&Law> {
        self.force(model)?.law
    }

    /// The joint whose coordinate it acts on.
    #[inline]
    pub(crate) fn coordinate(&self, model: &Model) -> Option<(JointId, usize)> {
        match self.force(model)?.acts_on {
            ActsOn::Coordinate(joint, coordinate) => Some((joint, coordinate)),
            ActsOn::Line(_)
            | ActsOn::Points(_)
            | ActsOn::Point(_)
            | ActsOn::Wheel(_)
            | ActsOn::Body(_)
            | ActsOn::Joint(_) => None,
        }
    }
}

impl Model {
    /// Points at which forces act: both ends of a spring or bushing, the point of a given force, the centre of a wheel.
    pub fn points_of_application(&self) -> Vec<(ElementId, PointId)> {
        let of = |(e, element): (usize, &Element)| {
            let points = element.kind.force(self).map_or([None; 2], |force| force.acts_on.points(self));
            points.into_iter().flatten().map(move |p| (ElementId(e), p))
        };
        self.elements.iter().enumerate().flat_map(of).collect()
    }

    /// Directions in which elastic joints and bushings deflect: 0 to 2 along x, y and z, 3 to 5 about them. Without
    /// equilibrium elastic joints are rigid.
    pub fn elastic_directions(&self) -> Vec<(ElementId, usize)> {
        let of = |(e, element): (usize, &Element)| {
            let acts_on = element.kind.force(self).map(|force| force.acts_on);
            let is_rigid = matches!(acts_on, Some(ActsOn::Joint(_))) && self.equilibrium.is_none();
            let law = element.kind.elastic_law().filter(|_| !is_rigid);
            let compliant = law.map_or([false; 6], |law| law.gives());
            (0..6).filter(move |k| compliant[*k]).map(move |k| (ElementId(e), k))
        };
        self.elements.iter().enumerate().flat_map(of).collect()
    }

    /// Curves of springs, bushings and elastic joints; without equilibrium elastic joints are rigid.
    pub fn force_curves(&self) -> Vec<ForceCurve<'_>> {
        let deflects = self.elastic_directions();
        let mut curves = Vec::new();
        for (e, Element { kind, .. }) in self.elements.iter().enumerate() {
            let element = ElementId(e);
            if let Some((key, table)) = kind.force(self).and_then(|force| force.table) {
                curves.push(ForceCurve { element, direction: None, key, table });
            }
            let Some(law) = kind.elastic_law() else { continue };
            for (k, of) in
                law.directions.iter().enumerate().filter(|(k, _)| deflects.contains(&(element, *k)))
            {
                curves.extend(of.curve.map(|table| ForceCurve {
                    element,
                    direction: Some(k),
                    key: CURVES[k],
                    table,
                }));
            }
        }
        curves
    }

    /// Intervals of deflections between the points of a curve in which the force in its direction, with the stiffness
    /// beside the curve, falls with the deflection; empty for a curve of a spring.
    pub fn falling_intervals(&self, curve: &ForceCurve<'_>) -> Vec<[f64; 2]> {
        let law = self.elements[curve.element.0].kind.elastic_law();
        let (Some(k), Some(law)) = (curve.direction, law) else { return Vec::new() };
        let number = |n: NumberId| self.numbers[n.0].value;
        let of = law.directions[k];
        let stiffness: f64 = law.stiffnesses(k, k).map(number).sum();
        let (cubic, factor) = (of.cubic.map_or(0.0, number), of.scale.map_or(1.0, number));
        let force = |[e, c]: [f64; 2]| stiffness * e + cubic * e.powi(3) + factor * c;
        let mut falling: Vec<[f64; 2]> = Vec::new();
        for [start, end] in curve.table.chords().filter(|[start, end]| force(*end) < force(*start)) {
            let [from, to] = [start[0], end[0]];
            match falling.last_mut() {
                Some(last) if last[1] == from => last[1] = to,
                _ => falling.push([from, to]),
            }
        }
        falling
    }

    /// Deflections between which a curve is flat in the nominal design, but not in every one: at forces that are equal
    /// its slope has a kink, so that derivatives by these forces exist on either side only.
    pub fn kinked_intervals(&self, curve: &ForceCurve<'_>) -> Vec<[f64; 2]> {
        let expression =
            |n: &NumberId| self.formulas.iter().find(|f| f.of == Target::Number(*n)).map(Formula::text);
        let is_kinked = |([from, to], numbers): &([[f64; 2]; 2], &[NumberId])| {
            from[1] == to[1] && expression(&numbers[0]) != expression(&numbers[1])
        };
        let chords = curve.table.chords().zip(curve.table.numbers().windows(2)).filter(is_kinked);
        chords.map(|([from, to], _)| [from[0], to[0]]).collect()
    }

    /// Given forces and moments with a law.
    pub fn given_forces(&self) -> Vec<ElementId> {
        let has_law = |e: &usize| self.elements[*e].kind.law(self).is_some();
        (0..self.elements.len()).filter(has_law).map(ElementId).collect()
    }

    /// Magnitude that the law of a given force multiplies, in the nominal design, and its dimension: the force or
    /// moment, the resultant of a wheel force with several components, and the height of the road of a tyre. It is zero
    /// for an element without a law.
    pub fn at_unit_law(&self, force: ElementId) -> (f64, Dimension) {
        let number = |n: Option<NumberId>| n.map_or(0.0, |n| self.numbers[n.0].value);
        match &self.elements[force.0].kind {
            ElementKind::PointForce(it) => (number(Some(it.force.0)), Dimension::FORCE),
            ElementKind::BodyMoment(it) => (number(Some(it.moment.0)), Dimension::MOMENT),
            ElementKind::WheelForce(it) => {
                let [x, y, z] = [it.outboard, it.forward, it.up].map(|n| number(n.map(|n| n.0)));
                match self.force_dimension(force) {
                    Dimension::MOMENT => (number(it.about_up.map(|n| n.0)).abs(), Dimension::MOMENT),
                    dimension => (Vec3::new(x, y, z).norm(), dimension),
                }
            }
            ElementKind::Tyre(it) => (number(it.height.map(|n| n.0)), Dimension::LENGTH),
            ElementKind::Rigid(_)
            | ElementKind::Bar(_)
            | ElementKind::Block(_)
            | ElementKind::Mesh(_)
            | ElementKind::Spring(_)
            | ElementKind::JointSpring(_)
            | ElementKind::TorsionSpring(_)
            | ElementKind::Friction(_)
            | ElementKind::SlideFriction(_)
            | ElementKind::Bushing(_)
            | ElementKind::ElasticJoint(_) => (0.0, Dimension::FORCE),
        }
    }

    /// True if the law of a given force has different values at the output times.
    pub fn varies(&self, force: ElementId) -> bool {
        self.elements[force.0].kind.law(self).is_some_and(|law| self.changes(law))
    }

    /// True if a law has different values at the output times.
    pub fn changes(&self, law: &Law) -> bool {
        let mut values = self.times.iter().map(|t| law.at(*t).value());
        let first = values.next();
        values.any(|value| Some(value) != first)
    }

    /// Bodies of a force with axes of its own, these axes in the nominal design, and the directions that its z and x
    /// axes follow.
    pub(crate) fn axes_of(&self, e: ElementId) -> Option<([BodyId; 2], Mat3, [Option<Direction>; 2])> {
        let Properties { acts_on, axes, .. } = self.elements[e.0].kind.force(self)?;
        let z = self.vector(axes[0]?).unit()?;
        let given = axes[1].and_then(|x| self.vector(x).unit()).and_then(|d| (d - z * z.dot(d)).unit());
        let x = given.unwrap_or_else(|| z.any_perpendicular());
        Some((acts_on.bodies(self), Mat3 { cols: [x, z.cross(x), z] }, axes))
    }

    /// The laws that forces depend on, in the order of the elements that have one.
    pub(crate) fn laws_of_forces(&self) -> impl Iterator<Item = &Law> {
        self.elements.iter().filter_map(|e| e.kind.law(self))
    }

    /// The mass of all bodies in the design configuration, kg.
    pub fn mass(&self) -> f64 {
        self.elements.iter().map(|e| e.kind.mass(self)).sum()
    }

    /// Dimension of the magnitude of a force.
    pub fn force_dimension(&self, e: ElementId) -> Dimension {
        self.elements[e.0].kind.force(self).map_or(Dimension::FORCE, |force| force.dimension)
    }

    /// True if anything of it has mass, or pushes: without, there are no loads.
    pub fn has_loads(&self) -> bool {
        !self.elements.is_empty()
    }

    /// The element of that name.
    pub fn element(&self, name: &str) -> Option<ElementId> {
        self.elements.iter().position(|e| e.name == name).map(ElementId)
    }
}
