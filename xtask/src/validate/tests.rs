use super::description;
use crate::xml_tree::Element;
use fairlead::variables::Model;
use model_description::scenes::SCENES;
use model_description::xml::model_description;

fn text() -> String {
    let model = Model::built_in(&SCENES[0]).expect("good");
    String::from_utf8(model_description(&model.document()).expect("in memory")).expect("UTF-8")
}

fn problems(text: &str) -> Vec<String> {
    description::problems(&Element::parse(text).expect("well-formed"))
}

#[test]
fn exact_our_own_description_is_without_problems() {
    assert_eq!(problems(&text()), Vec::<String>::new());
}

#[test]
fn exact_each_broken_rule_is_named() {
    let cases = [
        ("fmiVersion=\"2.0\"", "fmiVersion=\"2.0.5\"", "fmiVersion is not exactly \"2.0\""),
        ("modelIdentifier=\"flume\"", "modelIdentifier=\"fl ume\"", "modelIdentifier is no C identifier"),
        ("canGetAndSetFMUstate=\"true\"", "", "canSerializeFMUstate needs canGetAndSetFMUstate"),
        ("<Unit name=\"N\">", "<Unit name=\"Newton\">", "type Force: unit N is not defined"),
        ("\"logAll\"", "\"all\"", "log category logAll is missing"),
        ("stopTime=\"60.0\"", "stopTime=\"0.0\"", "DefaultExperiment: stopTime is not after startTime"),
        ("name=\"gravity\"", "name=\"cable.length\"", "variable cable.length: its name is not unique"),
        ("name=\"gravity\"", "name=\"gravity \"", "variable gravity : its name is not a structured one (a.b[1].c)"),
        ("start=\"9.81\"", "", "variable gravity: start is missing"),
        ("start=\"9.81\"", "start=\"INF\"", "variable gravity: start \"INF\" is no Real"),
        ("start=\"0.00045\"", "start=\"-1.0\"", "variable cable.diameter: start -1.0 is less than min 0"),
        ("declaredType=\"Density\"", "declaredType=\"Thickness\"", "variable fluid.density: type Thickness is not defined"),
        (
            "variability=\"discrete\" initial=\"calculated\"",
            "initial=\"calculated\"",
            "variable cable.slack: Boolean cannot be continuous; its variability has to be given",
        ),
        (
            "<Outputs>",
            "<Outputs><Unknown index=\"1\"/>",
            "ModelStructure/Outputs does not list the 1-based positions of all outputs in declaration order",
        ),
    ];
    let good = text();
    for (old, new, expected) in cases {
        assert!(good.contains(old), "{old}");
        let found = problems(&good.replacen(old, new, 1));
        assert!(found.iter().any(|p| p == expected), "for {new}: {found:#?}");
    }
}

#[test]
fn exact_broken_xml_is_named_with_its_line() {
    let error = |text: &str| Element::parse(text).expect_err(text);
    assert!(error("<a>\n<b></a>").starts_with("line 2: "), "{}", error("<a>\n<b></a>"));
    assert_eq!(error("<a>"), "it ends before its root element does");
    assert_eq!(error(""), "there is no element");
}

#[test]
fn exact_a_file_that_is_no_zip_is_named() {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    let error = super::problems(file.path()).expect_err("an empty file").to_string();
    assert!(error.contains("no zip archive"), "{error}");
}
