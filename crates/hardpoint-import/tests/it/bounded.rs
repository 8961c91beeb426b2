//! Limits on the work that a small file can cause.

use std::time::Instant;

use hardpoint_import::{Format, ImportErrors, ImportedModel};

/// Upper bound of the time without optimisation on a busy machine, s. Without limits these files take hours, or all
/// memory.
const LONGEST: f64 = 30.0;

fn import(
    format: &str,
    bytes: &[u8],
    beside: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<ImportedModel, ImportErrors> {
    let start = Instant::now();
    let result = hardpoint_import::import_as(Format::named(format).unwrap(), bytes, "source", beside);
    let taken = start.elapsed().as_secs_f64();
    assert!(taken < LONGEST, "{format}: {taken} s");
    result
}

fn refused(format: &str, text: &str, words: &str) {
    let problems = import(format, text.as_bytes(), &|_| None).unwrap_err().to_string();
    assert!(problems.contains(words), "{format}: {}", problems.chars().take(2000).collect::<String>());
    assert!(problems.len() < 50_000, "{format}: {}", problems.len());
}

/// Document of each XML format: its beginning, an element in it, its end.
const FORMATS: [(&str, [&str; 3]); 3] = [
    ("urdf", [r#"<robot name="r">"#, r#"<link name="a"/>"#, "</robot>"]),
    ("sdf", [r#"<sdf version="1.9"><model name="m">"#, r#"<link name="a"/>"#, "</model></sdf>"]),
    ("mjcf", ["<mujoco><worldbody>", r#"<body name="a"/>"#, "</worldbody></mujoco>"]),
];

#[test]
fn entities_are_not_expanded() {
    // Ten entities that expand to 10^10 letters.
    let names: Vec<char> = ('a'..='k').collect();
    let inner: String = names
        .windows(2)
        .map(|n| format!("<!ENTITY {} \"{}\">", n[1], format!("&{};", n[0]).repeat(10)))
        .collect();
    let kind = format!("<!DOCTYPE x [<!ENTITY a \"x>x\">{inner}]>");
    for (format, [begin, element, end]) in FORMATS {
        refused(format, &format!("{kind}{begin}{element}<what>&k;</what>{end}"), "entities");
        refused(
            format,
            &format!("<?xml version=\"1.0\"?><!-- [ --> {kind}{begin}{element}{end}"),
            "entities",
        );
        // A document type without entities is accepted.
        let plain = format!(
            "<?xml version=\"1.0\"?><!DOCTYPE x SYSTEM \"x.dtd\" [<!ELEMENT a ANY>]>{begin}{element}{end}"
        );
        let reported = import(format, plain.as_bytes(), &|_| None);
        assert!(reported.is_ok(), "{format}: {}", reported.unwrap_err());
    }
    let document = crate::document(format!("{kind}<Document>&k;</Document>").as_bytes());
    assert!(import("freecad", &document, &|_| None).unwrap_err().to_string().contains("entities"));
    // Invalid meshes do not prevent the import.
    let robot = r#"<robot name="r"><link name="a"><visual><geometry><mesh filename="a.dae"/></geometry></visual></link></robot>"#;
    let mesh = format!("{kind}<COLLADA>&k;</COLLADA>");
    let imported = import("urdf", robot.as_bytes(), &|_| Some(mesh.clone().into_bytes())).unwrap();
    assert!(imported.report.to_string().contains("entities"), "{}", imported.report);
}

#[test]
fn elements_and_attributes_are_counted() {
    for (format, [begin, element, end]) in FORMATS {
        let attributes: String = (0..100_000).map(|k| format!(" a{k}=\"1\"")).collect();
        refused(format, &format!("{begin}<what{attributes}/>{element}{end}"), "attributes");
        let prefixes: String = (0..100_000).map(|k| format!(" p{k}:a=\"1\"")).collect();
        refused(format, &format!("{begin}<what{prefixes}/>{element}{end}"), "attributes");
        let deep = format!("{begin}{}{}{end}", "<a>".repeat(100_000), "</a>".repeat(100_000));
        refused(format, &deep, "too deep");
        // A closing tag within quotes is ignored.
        let quoted = format!("{begin}{}{}{end}", "<a x=\"</\">".repeat(100_000), "</a>".repeat(100_000));
        refused(format, &quoted, "too deep");
        // Unknown elements are listed, in linear time.
        let kinds: String = (0..20_000).map(|k| format!("<p{k}:x/>")).collect();
        let imported = import(format, format!("{begin}{element}{kinds}{end}").as_bytes(), &|_| None).unwrap();
        assert!(imported.report.to_string().contains("... and 19"), "{}", imported.report);
        let many: String = (0..20_000).map(|k| element.replace("\"a\"", &format!("\"a{k}\""))).collect();
        refused(format, &format!("{begin}{many}{end}"), "5000");
        let same = format!("{begin}{}{end}", element.repeat(3000));
        refused(format, &same, "more like these");
    }
}

#[test]
fn a_document_of_freecad_that_is_too_large_in_its_archive_is_named() {
    let document = crate::document(&vec![b' '; (64 << 20) + 1]);
    let message = import("freecad", &document, &|_| None).unwrap_err().to_string();
    assert!(message.contains("`Document.xml` is too large: at most 64 MiB are read"), "{message}");
}

#[test]
fn files_that_include_each_other_twice_end() {
    // 2^25 inclusions by 25 small files.
    let number = |path: &str| {
        path.trim_start_matches(|c: char| !c.is_ascii_digit()).split('.').next()?.parse::<u32>().ok()
    };
    let mjcf = |path: &str| {
        let k = number(path)?;
        let inner =
            if k < 25 { format!("<include file=\"i{0}.xml\"/>", k + 1).repeat(2) } else { "<body/>".into() };
        Some(format!("<mujocoinclude>{inner}</mujocoinclude>").into_bytes())
    };
    let text = "<mujoco><worldbody><include file=\"i1.xml\"/></worldbody></mujoco>";
    let problems = import("mjcf", text.as_bytes(), &mjcf).unwrap_err().to_string();
    assert!(problems.contains("more than 5000 bodies") && problems.contains("too often"), "{problems}");
    let empty = |path: &str| {
        let k = number(path)?;
        let inner =
            if k < 25 { format!("<include file=\"i{0}.xml\"/>", k + 1).repeat(2) } else { String::new() };
        Some(format!("<mujocoinclude>{inner}</mujocoinclude>").into_bytes())
    };
    let problems = import("mjcf", text.as_bytes(), &empty).unwrap_err().to_string();
    assert!(problems.contains("too often"), "{problems}");
    let sdf = |path: &str| {
        let k = number(path)?;
        let inner = if k < 25 {
            format!("<include><uri>m{}.sdf</uri></include>", k + 1).repeat(2)
        } else {
            "<link name=\"l\"/>".into()
        };
        Some(format!("<sdf version=\"1.9\"><model name=\"m{k}\">{inner}</model></sdf>").into_bytes())
    };
    let text = "<sdf version=\"1.9\"><model name=\"m0\"><include><uri>m1.sdf</uri></include></model></sdf>";
    let problems = import("sdf", text.as_bytes(), &sdf).unwrap_err().to_string();
    assert!(problems.contains("more than 5000 models"), "{problems}");
    // Models with a placement frame are placed twice, and nested models twice as often per level.
    let mut nested = "<link name=\"l\"/>".to_owned();
    for k in 0..30 {
        nested = format!("<model name=\"n{k}\" placement_frame=\"f\"><frame name=\"f\"/>{nested}</model>");
    }
    refused("sdf", &format!("<sdf version=\"1.9\">{nested}</sdf>"), "too often");
    // Default classes inherit the attributes of the enclosing classes.
    let wide: String = (0..900).map(|k| format!(" a{k}=\"1\"")).collect();
    let classes: String = (0..3000).map(|k| format!("<default class=\"c{k}\"/>")).collect();
    let text =
        format!("<mujoco><default><geom{wide}/>{classes}</default><worldbody><body/></worldbody></mujoco>");
    refused("mjcf", &text, "default classes");
}

#[test]
fn functions_of_many_terms_and_levels_are_read_or_refused() {
    let folder = crate::folder();
    let adams = std::fs::read_to_string(folder.join("adams/four_bar.adm")).unwrap();
    let asmt = std::fs::read_to_string(folder.join("asmt/four_bar.asmt")).unwrap();
    let in_adams =
        |function: &str| adams.replace("FUNCTION = 60D\n, + 360.0D*time", &format!("FUNCTION = {function}"));
    let in_asmt = |function: &str| asmt.replace("1.0471975511966d + (2.0d*pi*time)", function);
    for (format, write) in [("adams", &in_adams as &dyn Fn(&str) -> String), ("asmt", &in_asmt)] {
        assert_ne!(write("0"), write("1"), "{format}");
        let imported = |function: &str| import(format, write(function).as_bytes(), &|_| None).unwrap();
        for nested in [
            format!("{}time{}", "(".repeat(100_000), ")".repeat(100_000)),
            "-2^".repeat(100_000) + "time",
            format!("{}time{}", "sin(".repeat(100_000), ")".repeat(100_000)),
        ] {
            assert!(imported(&nested).report.to_string().contains("nested too deep"), "{format}");
        }
        // Nested functions that repeat their arguments.
        let repeated = format!("{}time{}", "step5(".repeat(40), ", 0, 0, 1, 1)".repeat(40));
        assert!(imported(&repeated).report.to_string().contains("longer"), "{format}");
        let signs = "+-".repeat(50_000) + "time*0.1";
        assert!(!imported(&signs).report.to_string().contains("deep"), "{format}");
    }
}
