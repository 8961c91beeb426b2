//! Statements of Adams/Solver datasets and their keys: names may be abbreviated as far as they are unique.

/// Names of statements.
const STATEMENTS: &[&str] = &[
    "ACCGRAV",
    "ADAMS",
    "ARRAY",
    "BEAM",
    "BUSHING",
    "CBUSHING",
    "COMMAND",
    "CONTACT",
    "CONTROL",
    "COUPLER",
    "CURVE",
    "CVCV",
    "DEBUG",
    "DIFF",
    "DYNAMICS",
    "END",
    "EQUILIBRIUM",
    "FEMDATA",
    "FE_LOAD",
    "FE_PART",
    "FIELD",
    "FLEX_BODY",
    "FRICTION",
    "GCON",
    "GEAR",
    "GFORCE",
    "GRAPHICS",
    "GSE",
    "IC",
    "INTEGRATOR",
    "JOINT",
    "JPRIM",
    "KINEMATICS",
    "LINEAR",
    "LIST",
    "LSE",
    "MARKER",
    "MATERIAL",
    "MATRIX",
    "MFORCE",
    "MOTION",
    "MREQUEST",
    "NFORCE",
    "OUTPUT",
    "PART",
    "PINPUT",
    "PLANT_INPUT",
    "PLANT_OUTPUT",
    "POINT",
    "POINT_MASS",
    "POUTPUT",
    "PREFERENCES",
    "PRINT",
    "PSTATE",
    "PTCV",
    "PTSF",
    "REQSAVE",
    "REQUEST",
    "RESULTS",
    "ROAD",
    "SAVE",
    "SENSOR",
    "SFORCE",
    "SIMULATE",
    "SPLINE",
    "SPRINGDAMPER",
    "STRING",
    "SURFACE",
    "TFSISO",
    "TIRE",
    "UCON",
    "UNITS",
    "VARIABLE",
    "VFORCE",
    "VTORQUE",
];
/// Statements that an ambiguous abbreviation of three letters or more means, the most frequent first.
const FREQUENT: [&str; 10] =
    ["PART", "MARKER", "JOINT", "JPRIM", "MOTION", "COUPLER", "GEAR", "UNITS", "SPLINE", "FLEX_BODY"];

/// Keys of a statement.
pub struct Keys {
    /// Keys with values that are read.
    values: &'static [&'static str],
    /// Keys without values that are read.
    flags: &'static [&'static str],
    /// Keys without effect on the imported mechanism.
    irrelevant: &'static [&'static str],
}

/// Initial velocities, which belong to dynamic motions.
const SPEEDS: &[&str] = &["VX", "VY", "VZ", "WX", "WY", "WZ", "VM", "WM"];
const PART: Keys = Keys {
    values: &["QG", "REULER", "EULER", "ZG", "XG", "MASS", "CM", "IM", "IP"],
    flags: &["GROUND", "USEXP"],
    irrelevant: &["MATERIAL", "EXACT", "DENSITY", "VX", "VY", "VZ", "WX", "WY", "WZ", "VM", "WM"],
};
const KEYS: [(&str, Keys); 16] = [
    ("PART", PART),
    ("POINT_MASS", PART),
    ("FLEX_BODY", PART),
    (
        "MARKER",
        Keys {
            values: &[
                "PART",
                "POINT_MASS",
                "FLEX_BODY",
                "FE_PART",
                "NODE_ID",
                "QP",
                "REULER",
                "EULER",
                "ZP",
                "XP",
            ],
            flags: &["FLOATING", "USEXP"],
            irrelevant: SPEEDS,
        },
    ),
    (
        "JOINT",
        Keys {
            values: &["I", "J", "PITCH", "PD", "ICTRAN", "ICROT", "IC"],
            flags: &[
                "REVOLUTE",
                "TRANSLATIONAL",
                "CYLINDRICAL",
                "SPHERICAL",
                "UNIVERSAL",
                "HOOKE",
                "PLANAR",
                "FIXED",
                "CONVEL",
                "SCREW",
                "INLINE",
                "RACKPIN",
            ],
            // Friction of a joint does not affect prescribed motions.
            irrelevant: &[
                "FRICTION",
                "MU_STATIC",
                "MU_DYNAMIC",
                "STICTION_TRANSITION_VELOCITY",
                "MAX_STICTION_DEFORMATION",
                "FRICTION_TORQUE_PRELOAD",
                "FRICTION_FORCE_PRELOAD",
                "PIN_RADIUS",
                "FRICTION_ARM",
                "BENDING_REACTION_ARM",
                "INITIAL_OVERLAP",
                "OVERLAP_DELTA",
                "EFFECT",
                "BALL_RADIUS",
                "REACTION_ARM",
                "INNER_RADIUS",
                "DELTA_V",
                "MAXIT",
                "YOKE",
                "INACTIVE",
                "OUTER_RADIUS",
                "INPUTS",
                "FORCE_PRELOAD",
                "TORQUE_PRELOAD",
                "SLIDING_AND_STICTION",
                "TORSIONAL_MOMENT",
                "BENDING_MOMENT",
                "PRELOAD",
                "REACTION_FORCE",
                "X_PIN",
                "Y_PIN",
            ],
        },
    ),
    (
        "JPRIM",
        Keys {
            values: &["I", "J"],
            flags: &["ATPOINT", "INLINE", "INPLANE", "ORIENTATION", "PARALLEL_AXES", "PERPENDICULAR"],
            irrelevant: &["INACTIVE"],
        },
    ),
    (
        "MOTION",
        Keys {
            values: &["I", "J", "JOINT", "FUNCTION", "ICDISP", "ICVEL"],
            flags: &[
                "ROTATIONAL",
                "TRANSLATIONAL",
                "DISPLACEMENT",
                "VELOCITY",
                "ACCELERATION",
                "X",
                "Y",
                "Z",
                "B1",
                "B2",
                "B3",
            ],
            irrelevant: &["ROUTINE"],
        },
    ),
    (
        "COUPLER",
        Keys { values: &["JOINTS", "TYPE", "SCALES", "FUNCTION", "ROUTINE"], flags: &[], irrelevant: &[] },
    ),
    ("GEAR", Keys { values: &["JOINTS", "CV"], flags: &[], irrelevant: &[] }),
    ("UNITS", Keys { values: &["SYSTEM", "FORCE", "MASS", "LENGTH", "TIME"], flags: &[], irrelevant: &[] }),
    ("ACCGRAV", Keys { values: &["IGRAV", "JGRAV", "KGRAV"], flags: &[], irrelevant: &[] }),
    (
        "SPRINGDAMPER",
        Keys {
            values: &["I", "J", "K", "C", "LENGTH", "FORCE", "KT", "CT", "ANGLE", "TORQUE"],
            flags: &["TRANSLATIONAL", "ROTATIONAL"],
            irrelevant: &[],
        },
    ),
    (
        "BUSHING",
        Keys { values: &["I", "J", "K", "KT", "C", "CT", "FORCE", "TORQUE"], flags: &[], irrelevant: &[] },
    ),
    (
        "SFORCE",
        Keys {
            values: &["I", "J", "FUNCTION"],
            flags: &["TRANSLATIONAL", "ROTATIONAL", "ACTIONONLY"],
            irrelevant: &["ROUTINE"],
        },
    ),
    ("VARIABLE", Keys { values: &["FUNCTION"], flags: &[], irrelevant: &["IC", "ROUTINE"] }),
    ("SPLINE", Keys { values: &["X", "Y"], flags: &[], irrelevant: &["LINEAR_EXTRAPOLATE", "UNITS"] }),
];

/// Returns the full name of a statement, or the name as written if it is unknown or ambiguous.
pub fn statement_name(written: &str) -> String {
    let exact = STATEMENTS.iter().find(|name| **name == written);
    let frequent = FREQUENT.iter().find(|name| written.len() >= 3 && name.starts_with(written));
    let full = exact.or(frequent).copied().or_else(|| only(STATEMENTS.iter().copied(), written));
    full.unwrap_or(written).to_owned()
}

/// Returns true for the full name of a statement of Adams/Solver.
pub fn is_statement(name: &str) -> bool {
    STATEMENTS.contains(&name)
}

/// Flags of a statement that exclude each other: types, and components of motions.
pub fn exclusive_flags(statement: &str) -> Vec<&'static [&'static str]> {
    const WAYS: &[&str] = &["TRANSLATIONAL", "ROTATIONAL"];
    match statement {
        "JOINT" | "JPRIM" => of(statement).map(|keys| keys.flags).into_iter().collect(),
        "MOTION" => {
            vec![WAYS, &["DISPLACEMENT", "VELOCITY", "ACCELERATION"], &["X", "Y", "Z", "B1", "B2", "B3"]]
        }
        "SPRINGDAMPER" | "SFORCE" => vec![WAYS],
        _ => Vec::new(),
    }
}

/// Returns the keys of a statement, if it is read.
pub fn of(statement: &str) -> Option<&'static Keys> {
    KEYS.iter().find(|(name, _)| *name == statement).map(|(_, keys)| keys)
}

impl Keys {
    /// Returns the full name of a key, with or without a value; `None` if it is unknown or ambiguous.
    pub fn named(&self, written: &str, is_flag: bool) -> Option<&'static str> {
        let all = || self.values.iter().chain(self.flags).chain(self.irrelevant).copied();
        all().find(|key| *key == written).or_else(|| only(self.candidates(is_flag), written))
    }

    /// Returns the flag that a word means. It is not abbreviated to less than three letters where it may be part of a
    /// function.
    pub fn flag_after_function(&self, word: &str) -> Option<&'static str> {
        only(self.flags.iter().copied(), word).filter(|flag| word.len() >= 3 || *flag == word)
    }

    /// Returns the keys that an abbreviation may mean.
    pub fn meant(&self, written: &str, is_flag: bool) -> Vec<&'static str> {
        self.candidates(is_flag).filter(|key| key.starts_with(written)).collect()
    }

    /// Returns true for a key with a value that is read.
    pub fn is_value(&self, key: &str) -> bool {
        self.values.contains(&key)
    }

    fn candidates(&self, is_flag: bool) -> impl Iterator<Item = &'static str> {
        let own = if is_flag { self.flags } else { self.values };
        own.iter().chain(self.irrelevant).copied()
    }
}

/// Returns the only name that begins with an abbreviation, or equals it.
fn only<'n>(names: impl Iterator<Item = &'n str>, written: &str) -> Option<&'n str> {
    let mut found = names.filter(|name| name.starts_with(written) && !written.is_empty());
    let first = found.next()?;
    found.next().is_none().then_some(first)
}
