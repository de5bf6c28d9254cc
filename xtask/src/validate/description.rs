//! The rules of modelDescription.xml that the XML schema does not know, and those that it does but users of no schema need.

use crate::xml_tree::Element;
use std::collections::{HashMap, HashSet};

/// Standard log categories that an importer may switch on.
const LOG_CATEGORIES: [&str; 5] = ["logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal", "logAll"];
/// Lists that have to be left out rather than be empty.
const LISTS: [&str; 4] = ["UnitDefinitions", "TypeDefinitions", "LogCategories", "ModelVariables"];

/// Everything wrong with the model description.
pub fn problems(root: &Element) -> Vec<String> {
    let mut problems = Vec::new();
    header(root, &mut problems);
    let units = units(root, &mut problems);
    let types = types(root, &units, &mut problems);
    categories(root, &mut problems);
    experiment(root, &mut problems);
    variables(root, &units, &types, &mut problems);
    structure(root, &mut problems);
    problems
}

fn header(root: &Element, problems: &mut Vec<String>) {
    let mut need = |holds: bool, problem: &str| {
        if !holds {
            problems.push(problem.to_owned());
        }
    };
    let filled = |attribute: &str| root.get(attribute).is_some_and(|v| !v.is_empty());
    need(root.name == "fmiModelDescription", "the root element is not fmiModelDescription");
    need(root.get("fmiVersion") == Some("2.0"), "fmiVersion is not exactly \"2.0\"");
    for attribute in ["modelName", "guid", "generationTool", "generationDateAndTime"] {
        need(filled(attribute), &format!("{attribute} is missing"));
    }
    need(root.get("generationDateAndTime").is_none_or(|t| t.ends_with('Z')), "generationDateAndTime is not in UTC");
    need(root.get("variableNamingConvention") == Some("structured"), "variableNamingConvention is not \"structured\"");
    for list in LISTS {
        need(
            root.child(list).is_none_or(|l| !l.children.is_empty()),
            &format!("{list} is empty; expected at least one element, or no {list}"),
        );
    }
    let Some(capabilities) = root.child("CoSimulation") else {
        return need(false, "CoSimulation is missing");
    };
    let yes = |attribute: &str| capabilities.get(attribute) == Some("true");
    need(capabilities.get("modelIdentifier").is_some_and(is_identifier), "modelIdentifier is no C identifier");
    need(!yes("canSerializeFMUstate") || yes("canGetAndSetFMUstate"), "canSerializeFMUstate needs canGetAndSetFMUstate");
    for flag in ["reinit", "canHandleMultipleSetPerTimeInstant"] {
        need(capabilities.get(flag).is_none(), &format!("{flag} is not for co-simulation"));
    }
}

fn is_identifier(s: &str) -> bool {
    let first = |c: char| c.is_ascii_alphabetic() || c == '_';
    s.starts_with(first) && s.chars().all(|c| first(c) || c.is_ascii_digit())
}

/// Unit -> display units.
type Units<'a> = HashMap<&'a str, HashSet<&'a str>>;

fn units<'a>(root: &'a Element, problems: &mut Vec<String>) -> Units<'a> {
    let mut units = Units::new();
    for unit in root.list("UnitDefinitions") {
        let name = unit.get("name").unwrap_or_default();
        if unit.child("BaseUnit").is_none() {
            problems.push(format!("unit {name} has no BaseUnit"));
        }
        let display = unit.children.iter().filter(|c| c.name == "DisplayUnit").filter_map(|d| d.get("name")).collect();
        if units.insert(name, display).is_some() {
            problems.push(format!("unit {name} is defined twice"));
        }
    }
    units
}

/// Type name -> its Real, Integer, ... element.
type Types<'a> = HashMap<&'a str, &'a Element>;

fn types<'a>(root: &'a Element, units: &Units, problems: &mut Vec<String>) -> Types<'a> {
    let mut types = Types::new();
    for simple in root.list("TypeDefinitions") {
        let name = simple.get("name").unwrap_or_default();
        let Some(inner) = simple.children.first() else {
            problems.push(format!("type {name} is empty"));
            continue;
        };
        unit_use(&format!("type {name}"), inner, units, problems);
        if types.insert(name, inner).is_some() {
            problems.push(format!("type {name} is defined twice"));
        }
    }
    types
}

fn unit_use(owner: &str, element: &Element, units: &Units, problems: &mut Vec<String>) {
    match (element.get("unit"), element.get("displayUnit")) {
        (None, Some(_)) => problems.push(format!("{owner} has a displayUnit without a unit")),
        (Some(unit), display) => match units.get(unit) {
            None => problems.push(format!("{owner}: unit {unit} is not defined")),
            Some(known) if display.is_some_and(|d| d != unit && !known.contains(d)) => {
                problems.push(format!("{owner}: displayUnit {} is not defined for {unit}", display.unwrap_or_default()));
            }
            Some(_) => {}
        },
        (None, None) => {}
    }
    for attribute in ["min", "max", "nominal"] {
        if element.name == "Real" && element.get(attribute).is_some_and(|v| !is_real(v)) {
            problems.push(format!("{owner}: {attribute} is no finite number"));
        }
    }
}

fn is_real(text: &str) -> bool {
    text.parse::<f64>().is_ok_and(f64::is_finite)
}

fn categories(root: &Element, problems: &mut Vec<String>) {
    let categories = root.list("LogCategories");
    let missing = LOG_CATEGORIES.iter().filter(|name| !categories.iter().any(|c| c.get("name") == Some(name)));
    problems.extend(missing.map(|name| format!("log category {name} is missing")));
    let silent = categories.iter().filter(|c| c.get("description").is_none_or(str::is_empty));
    problems.extend(silent.map(|c| format!("log category {} has no description", c.get("name").unwrap_or_default())));
}

fn experiment(root: &Element, problems: &mut Vec<String>) {
    let Some(experiment) = root.child("DefaultExperiment") else {
        problems.push("DefaultExperiment is missing".into());
        return;
    };
    for attribute in ["startTime", "stopTime", "tolerance", "stepSize"] {
        if !experiment.get(attribute).is_some_and(is_real) {
            problems.push(format!("DefaultExperiment: {attribute} is missing or no finite number"));
        }
    }
    let time = |attribute: &str| experiment.get(attribute).and_then(|t| t.parse::<f64>().ok());
    if let (Some(start), Some(stop)) = (time("startTime"), time("stopTime"))
        && stop <= start
    {
        problems.push("DefaultExperiment: stopTime is not after startTime".into());
    }
}

/// Causality, with the default of the standard.
fn causality(variable: &Element) -> &str {
    variable.get("causality").unwrap_or("local")
}

fn variability(variable: &Element) -> &str {
    variable.get("variability").unwrap_or("continuous")
}

/// `initial`, with the defaults of the standard.
fn initial(variable: &Element) -> Option<&str> {
    variable.get("initial").or(match (causality(variable), variability(variable)) {
        ("input" | "independent", _) => None,
        ("parameter", _) | (_, "constant") => Some("exact"),
        _ => Some("calculated"),
    })
}

fn variables(root: &Element, units: &Units, types: &Types, problems: &mut Vec<String>) {
    let mut names = HashSet::new();
    let mut references = HashMap::new();
    for variable in root.list("ModelVariables") {
        let name = variable.get("name").unwrap_or_default();
        let mut complain = |what: String| problems.push(format!("variable {name}: {what}"));
        if !names.insert(name) {
            complain("its name is not unique".into());
        }
        if !is_structured(name) {
            complain("its name is not a structured one (a.b[1].c)".into());
        }
        let Some(of) = variable.children.first() else {
            complain("it has no type".into());
            continue;
        };
        let base = if of.name == "Enumeration" { "Integer" } else { of.name.as_str() };
        match variable.get("valueReference").map(str::parse::<u32>) {
            Some(Ok(reference)) => {
                if let Some(other) = references.insert((base, reference), name) {
                    complain(format!("{base} value reference {reference} is {other}'s too"));
                }
            }
            _ => complain("its valueReference is no 32-bit number".into()),
        }
        rules(variable, of, types, &mut complain);
        unit_use(&format!("variable {name}"), of, units, problems);
    }
}

/// Rules of one variable.
fn rules(variable: &Element, of: &Element, types: &Types, complain: &mut impl FnMut(String)) {
    let (causality, variability, initial) = (causality(variable), variability(variable), initial(variable));
    let legal = match causality {
        "parameter" | "calculatedParameter" => ["fixed", "tunable"].contains(&variability),
        "input" => ["discrete", "continuous"].contains(&variability),
        "output" => ["constant", "discrete", "continuous"].contains(&variability),
        "local" => true,
        "independent" => variability == "continuous",
        _ => false,
    };
    if !legal {
        complain(format!("{causality} cannot be {variability}"));
    }
    if variability == "continuous" && of.name != "Real" {
        complain(format!("{} cannot be continuous; its variability has to be given", of.name));
    }
    if causality == "independent" {
        complain("time is implicit; importers report false errors for an independent variable".into());
    }
    if ["input", "independent"].contains(&causality) && variable.get("initial").is_some() {
        complain(format!("{causality} cannot have initial"));
    }
    if causality == "parameter" && initial != Some("exact") {
        complain("initial of a parameter has to be exact".into());
    }
    let needs_start = causality == "input" || matches!(initial, Some("exact" | "approx"));
    match (needs_start, of.get("start")) {
        (true, None) => complain("start is missing".into()),
        (false, Some(_)) => complain("start is not allowed for a calculated variable".into()),
        (_, Some(start)) => literal(of, start, types, complain),
        _ => {}
    }
    match of.get("declaredType").map(|t| (t, types.get(t))) {
        Some((t, None)) => complain(format!("type {t} is not defined")),
        Some((t, Some(definition))) if definition.name != of.name => complain(format!("type {t} is no {}", of.name)),
        None if of.name == "Enumeration" => complain("an enumeration needs a declaredType".into()),
        _ => {}
    }
}

/// A start value: of its type, and within the type's limits.
fn literal(of: &Element, start: &str, types: &Types, complain: &mut impl FnMut(String)) {
    let good = match of.name.as_str() {
        "Real" => is_real(start),
        "Integer" | "Enumeration" => start.parse::<i32>().is_ok(),
        "Boolean" => ["true", "false", "0", "1"].contains(&start),
        _ => true,
    };
    if !good {
        complain(format!("start \"{start}\" is no {}", of.name));
    }
    let definition = of.get("declaredType").and_then(|t| types.get(t));
    let limit = |name: &str| of.get(name).or_else(|| definition.and_then(|d| d.get(name))).and_then(|v| v.parse::<f64>().ok());
    let value = start.parse::<f64>().ok();
    if let (Some(value), Some(min)) = (value, limit("min"))
        && value < min
    {
        complain(format!("start {start} is less than min {min}"));
    }
    if let (Some(value), Some(max)) = (value, limit("max"))
        && value > max
    {
        complain(format!("start {start} is greater than max {max}"));
    }
}

/// `a.b[1,2].c`, with letters, digits and `_`; quoted and der() names are legal but none of ours.
fn is_structured(name: &str) -> bool {
    name.split('.').all(|part| {
        let (part, index) = part.split_once('[').map_or((part, None), |(p, i)| (p, Some(i)));
        let number = |i: &str| !i.is_empty() && i.chars().all(|c| c.is_ascii_digit());
        is_identifier(part) && index.is_none_or(|i| i.strip_suffix(']').is_some_and(|i| i.split(',').all(number)))
    })
}

fn structure(root: &Element, problems: &mut Vec<String>) {
    let variables = root.list("ModelVariables");
    let chosen =
        |choose: &dyn Fn(&Element) -> bool| -> Vec<usize> { (1..=variables.len()).filter(|&i| choose(&variables[i - 1])).collect() };
    let outputs = chosen(&|v| causality(v) == "output");
    let unknowns =
        chosen(&|v| matches!(causality(v), "output" | "calculatedParameter") && matches!(initial(v), Some("calculated" | "approx")));
    let Some(structure) = root.child("ModelStructure") else {
        problems.push("ModelStructure is missing".into());
        return;
    };
    for (list, expected, of) in [("Outputs", outputs, "outputs"), ("InitialUnknowns", unknowns, "outputs with calculated start")] {
        let listed: Vec<_> =
            structure.list(list).iter().map(|u| u.get("index").and_then(|i| i.parse::<usize>().ok()).unwrap_or(0)).collect();
        if listed != expected {
            problems.push(format!("ModelStructure/{list} does not list the 1-based positions of all {of} in declaration order"));
        }
        for unknown in structure.list(list) {
            let count = |attribute: &str| unknown.get(attribute).map(|v| v.split_whitespace().count());
            if count("dependenciesKind").is_some_and(|n| count("dependencies") != Some(n)) {
                problems.push(format!("ModelStructure/{list}: dependenciesKind and dependencies differ in length"));
            }
        }
    }
}
