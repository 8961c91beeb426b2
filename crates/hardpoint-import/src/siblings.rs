//! Detection of related file types that are not supported: the error names the file to import instead.

/// Unsupported kind of file.
pub struct Sibling {
    /// Description of the kind, with its article.
    pub what: &'static str,
    /// File to import instead, and how to create it.
    pub help: &'static str,
}

/// Kind that is recognised by its text (in lower case) or by its extension.
struct Kind {
    endings: &'static [&'static str],
    recognises: fn(&str) -> bool,
    sibling: Sibling,
}

const KINDS: &[Kind] = &[
    Kind {
        endings: &["cmd"],
        recognises: |text| {
            let command = |l: &str| {
                ["model create", "part create", "marker create", "constraint create", "defaults "]
                    .iter()
                    .any(|c| l.starts_with(c))
            };
            text.lines().map(str::trim_start).filter(|l| command(l)).count() >= 2
        },
        sibling: Sibling {
            what: "an Adams/View command file (.cmd)",
            help: "open it in Adams/View, export the model as an Adams/Solver dataset (.adm), and import that",
        },
    },
    Kind {
        endings: &["bin"],
        recognises: |_| false,
        sibling: Sibling {
            what: "a binary database of Adams/View (.bin)",
            help: "open it in Adams/View, export the model as an Adams/Solver dataset (.adm), and import that",
        },
    },
    Kind {
        endings: &["acf"],
        recognises: |text| text.contains("simulate/"),
        sibling: Sibling {
            what: "a command file of Adams/Solver (.acf), which contains no mechanism",
            help: "import the dataset (.adm) that its first line names",
        },
    },
    Kind {
        endings: &["asy", "tpl"],
        recognises: |text| text.contains("file_type") && ["'asy'", "'tpl'"].iter().any(|t| text.contains(t)),
        sibling: Sibling {
            what: "an assembly or a template of Adams/Car (.asy, .tpl)",
            help: "import one of its subsystems (.sub), which contain the hardpoints",
        },
    },
    Kind {
        endings: &["mbd", "mbdyn"],
        recognises: |text| {
            text.contains("begin:")
                && text.contains("end:")
                && text.contains("problem")
                && text.contains("data;")
        },
        sibling: Sibling {
            what: "an input file of MBDyn (.mbd)",
            help: "MBDyn exports no other format: write bodies and joints as described in docs/file-format.md",
        },
    },
    Kind {
        endings: &["mdl"],
        recognises: |text| text.contains("*beginmdl") || text.contains("*begincontext"),
        sibling: Sibling {
            what: "a model of MotionView (.mdl)",
            help: "export it as an Adams/Solver dataset (.adm), and import that",
        },
    },
    Kind {
        endings: &["xacro"],
        recognises: |_| false,
        sibling: Sibling {
            what: "a xacro file, from which a URDF is made",
            help: "run `xacro FILE > robot.urdf` and import that",
        },
    },
    Kind {
        endings: &["slx", "sldasm", "iam", "catproduct", "step", "stp", "rdyn", "mjb"],
        recognises: |text| text.starts_with("iso-10303-21"),
        sibling: Sibling {
            what: "a CAD, Simscape, RecurDyn or compiled MuJoCo file, whose joints are not read",
            help: "export the mechanism as URDF, SDF, MJCF or an Adams/Solver dataset, and import that",
        },
    },
];

/// Returns the unsupported kind of a file, from its text or otherwise from its extension.
pub fn of(text: &str, name: &str) -> Option<&'static Sibling> {
    let text = text.to_ascii_lowercase();
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
    let by_text = KINDS.iter().find(|k| (k.recognises)(&text));
    by_text.or_else(|| KINDS.iter().find(|k| k.endings.contains(&ending.as_str()))).map(|k| &k.sibling)
}
