//! Joint types that models can use.

mod angle;
mod constant_velocity;
mod cylindrical;
mod distance;
mod dot1;
mod dot2;
mod fixed;
mod heading;
mod inline;
mod inplane;
mod leg;
mod orientation;
mod parallel;
mod pin_in_slot;
mod planar;
mod point_on_curve;
mod revolute;
mod revolute_spherical;
mod screw;
mod spherical;
mod translational;
mod travel;
mod universal;

use super::{
    CoordinateType, Freedom, JointType, LENGTH, Need, Quantity, Slide, VectorKind, angle, displacement,
    displacement_along,
};

/// Exports and lists the types.
macro_rules! joints {
    ($($file:ident $TYPE:ident)*) => {
        $(pub use $file::$TYPE;)*

        /// All joint types that models can use.
        pub const ALL: &[&JointType] = &[$(&$TYPE),*];
    };
}

joints! {
    fixed FIXED
    revolute REVOLUTE
    translational TRANSLATIONAL
    cylindrical CYLINDRICAL
    spherical SPHERICAL
    universal UNIVERSAL
    constant_velocity CONSTANT_VELOCITY
    planar PLANAR
    pin_in_slot PIN_IN_SLOT
    screw SCREW
    inline INLINE
    inplane INPLANE
    orientation ORIENTATION
    parallel PARALLEL
    dot1 DOT1
    dot2 DOT2
    angle ANGLE
    distance DISTANCE
    revolute_spherical REVOLUTE_SPHERICAL
    point_on_curve POINT_ON_CURVE
    leg LEG
    travel TRAVEL
    heading HEADING
}

/// Returns the joint type with this name or alias.
pub fn named(name: &str) -> Option<&'static JointType> {
    ALL.iter().copied().find(|t| t.name == name || t.aliases.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn freedoms_and_constraints_of_every_joint_add_up_to_six() {
        for t in ALL {
            if let Some(n) = t.freedom_count() {
                assert_eq!(n + t.rows.len() - t.tree_rows.len(), 6, "{}", t.name);
            }
        }
    }

    #[test]
    fn relaxations_have_fewer_constraints_and_other_numbers_of_them() {
        for t in ALL {
            let rows: Vec<usize> = t.relaxations.iter().map(|other| other.rows.len()).collect();
            assert!(rows.first().is_none_or(|first| *first < t.rows.len()), "{}", t.name);
            assert!(rows.is_sorted_by(|a, b| a > b), "{}", t.name);
        }
    }

    #[test]
    fn guides_are_along_freedoms() {
        for t in ALL {
            let along = |k: usize| t.freedoms.is_some_and(|f| f.contains(&Freedom::Slide(k)));
            let has_freedom = match t.slide {
                Slide::None => true,
                Slide::Block => along(2),
                Slide::Line(k) => along(k),
                Slide::Plane => along(0) && along(1),
            };
            assert!(has_freedom, "{}", t.name);
            assert!(!t.is_hinge || t.freedoms.is_some_and(|f| f.contains(&Freedom::Turn(2))), "{}", t.name);
        }
    }

    #[test]
    fn what_is_asked_of_joints_is_true_of_those_that_it_is_meant_for() {
        let those = |is: fn(&JointType) -> bool| -> Vec<&str> {
            ALL.iter().copied().filter(|t| is(t)).map(|t| t.name).collect()
        };
        assert_eq!(those(JointType::is_ball), ["spherical"]);
        assert_eq!(those(JointType::is_cross), ["universal"]);
        assert_eq!(
            those(JointType::articulates),
            ["spherical", "universal", "constant_velocity", "inline", "inplane"]
        );
        assert_eq!(those(JointType::turns_as_one), ["fixed", "translational"]);
        assert_eq!(
            those(JointType::slides),
            [
                "translational",
                "cylindrical",
                "planar",
                "pin_in_slot",
                "screw",
                "inline",
                "inplane",
                "orientation",
                "parallel",
                "dot1"
            ]
        );
        assert_eq!(those(JointType::is_rod), ["distance", "revolute_spherical", "leg"]);
        assert_eq!(those(JointType::follows_curve), ["point_on_curve"]);
        assert_eq!(those(JointType::has_lead), ["screw"]);
    }

    #[test]
    fn a_mirror_reverses_turns_about_what_a_joint_slides_along_and_nothing_else() {
        let reversed = ALL.iter().flat_map(|t| {
            let of = |c: &&CoordinateType| t.is_reversed_in_mirror(c);
            t.coordinates.iter().filter(of).map(|c| (t.name, c.name)).collect::<Vec<_>>()
        });
        assert_eq!(reversed.collect::<Vec<_>>(), [("cylindrical", "angle"), ("screw", "angle")]);
    }

    #[test]
    fn names_are_unique_and_found() {
        for t in ALL {
            assert!(std::ptr::eq(named(t.name).unwrap(), *t));
            for alias in t.aliases {
                assert!(std::ptr::eq(named(alias).unwrap(), *t), "{alias} represents two types");
            }
        }
        assert!(named("hinge").is_none());
    }
}
