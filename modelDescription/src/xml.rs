//! modelDescription.xml (FMI 2.0.5, co-simulation).

use crate::document::LOG_CATEGORIES;
use crate::units::{TYPES, Type, UNITS, Unit};
use crate::{Causality, Document, Kind, MAX_OUTPUT_DERIVATIVE_ORDER, Value, Variability, Variable};
use quick_xml::events::{BytesDecl, Event};
use quick_xml::writer::Writer;
use std::io;

/// Generation date that is written into every FMU: a fixed one, so that equal inputs give equal bytes.
const GENERATION_DATE: &str = "2025-01-01T00:00:00Z";
/// Default experiment: start, stop and communication step, s.
pub(crate) const EXPERIMENT: (f64, f64, f64) = (0.0, 60.0, 0.01);

pub(crate) type Xml = Writer<Vec<u8>>;
pub(crate) type Attributes = Vec<(&'static str, String)>;

/// The text of modelDescription.xml.
///
/// # Errors
/// None in practice: writing goes to memory.
pub fn model_description(d: &Document) -> io::Result<Vec<u8>> {
    let root = vec![
        ("fmiVersion", "2.0".into()),
        ("modelName", d.name.into()),
        ("guid", d.guid.into()),
        ("description", d.description.into()),
        ("author", "The fairlead developers".into()),
        ("version", d.version.into()),
        ("copyright", "The fairlead developers".into()),
        ("license", "MIT OR Apache-2.0".into()),
        ("generationTool", format!("fairlead {}", d.version)),
        ("generationDateAndTime", GENERATION_DATE.into()),
        ("variableNamingConvention", "structured".into()),
        ("numberOfEventIndicators", "0".into()),
    ];
    document("fmiModelDescription", root, |w| {
        leaf(w, "CoSimulation", capabilities(d.name))?;
        units(w, d.variables)?;
        types(w, d.variables)?;
        parent(w, "LogCategories", vec![], |w| {
            LOG_CATEGORIES
                .iter()
                .try_for_each(|(name, text)| leaf(w, "Category", vec![("name", (*name).into()), ("description", (*text).into())]))
        })?;
        let (start, stop, step) = EXPERIMENT;
        let experiment = [("startTime", start), ("stopTime", stop), ("tolerance", d.tolerance), ("stepSize", step)];
        leaf(w, "DefaultExperiment", experiment.map(|(name, value)| (name, number(value))).into())?;
        parent(w, "ModelVariables", vec![], |w| d.variables.iter().try_for_each(|v| variable(w, v)))?;
        structure(w, d.variables)
    })
}

fn capabilities(name: &str) -> Attributes {
    vec![
        ("modelIdentifier", name.into()),
        ("canHandleVariableCommunicationStepSize", "true".into()),
        ("canInterpolateInputs", "true".into()),
        ("maxOutputDerivativeOrder", MAX_OUTPUT_DERIVATIVE_ORDER.to_string()),
        ("canNotUseMemoryManagementFunctions", "true".into()),
        ("canGetAndSetFMUstate", "true".into()),
        ("canSerializeFMUstate", "true".into()),
        ("providesDirectionalDerivative", "true".into()),
    ]
}

/// The types that some variable uses.
pub(crate) fn used_types(variables: &[Variable]) -> impl Iterator<Item = &'static Type> {
    TYPES.iter().copied().filter(|t| variables.iter().any(|v| v.declared_type == Some(t.name)))
}

pub(crate) fn units(w: &mut Xml, variables: &[Variable]) -> io::Result<()> {
    let used: Vec<_> = UNITS.iter().filter(|u| used_types(variables).any(|t| t.unit == Some(u.name))).collect();
    if used.is_empty() {
        return Ok(());
    }
    parent(w, "UnitDefinitions", vec![], |w| {
        used.iter().try_for_each(|u| {
            parent(w, "Unit", vec![("name", u.name.into())], |w| {
                leaf(w, "BaseUnit", base_unit(u))?;
                u.display.iter().try_for_each(|s| leaf(w, "DisplayUnit", vec![("name", s.name.into()), ("factor", number(s.factor))]))
            })
        })
    })
}

/// Exponents of the base units. The schemas fix no order of attributes, but readers like the usual one.
pub(crate) fn base_unit(unit: &Unit) -> Attributes {
    let base = ["kg", "m", "s", "rad"].into_iter();
    base.filter_map(|b| unit.base.iter().find(|(name, _)| *name == b)).map(|&(name, power)| (name, power.to_string())).collect()
}

fn types(w: &mut Xml, variables: &[Variable]) -> io::Result<()> {
    if used_types(variables).next().is_none() {
        return Ok(());
    }
    parent(w, "TypeDefinitions", vec![], |w| {
        used_types(variables).try_for_each(|t| {
            parent(w, "SimpleType", vec![("name", t.name.into())], |w| {
                let mut a: Attributes = vec![("quantity", t.quantity.into())];
                a.extend(t.unit.map(|unit| ("unit", unit.into())));
                a.extend(t.display.map(|unit| ("displayUnit", unit.into())));
                a.extend(t.min.map(|min| ("min", number(min))));
                a.extend(t.max.map(|max| ("max", number(max))));
                a.extend(t.nominal.map(|nominal| ("nominal", number(nominal))));
                leaf(w, "Real", a)
            })
        })
    })
}

fn variable(w: &mut Xml, v: &Variable) -> io::Result<()> {
    let causality = match v.causality {
        Causality::Parameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
    };
    let variability = match v.variability {
        Variability::Fixed => "fixed",
        Variability::Tunable => "tunable",
        Variability::Discrete => "discrete",
        Variability::Continuous => "continuous",
    };
    let mut a: Attributes = vec![
        ("name", v.name.clone()),
        ("valueReference", v.reference.to_string()),
        ("description", v.description.clone()),
        ("causality", causality.into()),
        ("variability", variability.into()),
    ];
    match v.causality {
        Causality::Parameter => a.push(("initial", "exact".into())),
        Causality::Output => a.push(("initial", "calculated".into())),
        Causality::Input => {}
    }
    parent(w, "ScalarVariable", a, |w| {
        let element = match v.kind {
            Kind::Real => "Real",
            Kind::Integer => "Integer",
            Kind::Boolean => "Boolean",
            Kind::String => "String",
        };
        let mut a: Attributes = Vec::new();
        a.extend(v.declared_type.map(|t| ("declaredType", t.into())));
        a.extend(v.unit.map(|unit| ("unit", unit.into())));
        a.extend(v.start.as_ref().map(|start| ("start", literal(start))));
        leaf(w, element, a)
    })
}

fn structure(w: &mut Xml, variables: &[Variable]) -> io::Result<()> {
    let outputs: Vec<usize> = (1..=variables.len()).filter(|&i| variables[i - 1].causality == Causality::Output).collect();
    if outputs.is_empty() {
        return leaf(w, "ModelStructure", vec![]);
    }
    parent(w, "ModelStructure", vec![], |w| {
        // Outputs are those of the last committed state: no direct feed-through. The directional derivatives are those of a whole step, which
        // is no dependency at a communication point.
        let no_dependencies = |i: &usize| vec![("index", i.to_string()), ("dependencies", String::new())];
        parent(w, "Outputs", vec![], |w| outputs.iter().try_for_each(|i| leaf(w, "Unknown", no_dependencies(i))))?;
        // The start state may depend on everything, which is what leaving out the dependencies means.
        parent(w, "InitialUnknowns", vec![], |w| outputs.iter().try_for_each(|i| leaf(w, "Unknown", vec![("index", i.to_string())])))
    })
}

/// A value as an XML Schema literal; numbers in the shortest form that reads back the same.
pub fn literal(value: &Value) -> String {
    match value {
        Value::Real(x) => number(*x),
        Value::Integer(i) => i.to_string(),
        Value::Boolean(b) => b.to_string(),
        Value::String(s) => s.clone(),
    }
}

pub(crate) fn number(x: f64) -> String {
    format!("{x:?}")
}

/// A whole document: declaration, root element, line end.
pub(crate) fn document(name: &str, attributes: Attributes, inside: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<Vec<u8>> {
    let mut w = Writer::new_with_indent(Vec::new(), b' ', 2);
    w.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    parent(&mut w, name, attributes, inside)?;
    let mut text = w.into_inner();
    text.push(b'\n');
    Ok(text)
}

/// An element without content.
pub(crate) fn leaf(w: &mut Xml, name: &str, attributes: Attributes) -> io::Result<()> {
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    w.create_element(name).with_attributes(attributes).write_empty().map(|_| ())
}

/// An element with content.
pub(crate) fn parent(w: &mut Xml, name: &str, attributes: Attributes, inside: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<()> {
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    w.create_element(name).with_attributes(attributes).write_inner_content(inside).map(|_| ())
}
