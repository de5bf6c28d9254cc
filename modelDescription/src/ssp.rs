//! System Structure and Parameterization 1.0: a parameter set (.ssv) with every number of the scene, and an example system (.ssd).

use crate::units::{UNITS, Unit};
use crate::xml::{Attributes, EXPERIMENT, Xml, base_unit, document, leaf, literal, number, parent};
use crate::{Causality, Document, Kind, Variable};
use std::io;

/// Names of the two cables of the example systems.
pub const CABLES: [&str; 2] = ["leader", "follower"];
/// Name of the parameter set; Ecos applies a set only when asked for it by name.
pub const PARAMETER_SET: &str = "initialValues";

const DESCRIPTION: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const COMMON: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
const VALUES: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";
/// libcosim's own elements, which tell it the step size.
const OSP: &str = "http://opensimulationplatform.com/SSP/OSPAnnotations";

/// Which output of the first cable feeds which input of the second in the example systems: a winch follows the other.
/// An angle follows an angle, metres of payout follow metres. Empty for a scene without a winch.
pub fn follow(variables: &[Variable]) -> Vec<(&'static str, &'static str)> {
    let unit = |name: &str| variables.iter().find(|v| v.name == name && v.causality != Causality::Parameter).map(|v| v.unit);
    let wires = [("winch.angle", "winch.setpoint"), ("winch.payout", "winch.setpoint"), ("winch.rate", "winch.setpoint_rate")];
    wires.into_iter().filter(|(output, input)| unit(output).is_some() && unit(output) == unit(input)).collect()
}

/// The text of a parameter set with every parameter of the FMU at its start value.
///
/// # Errors
/// None in practice: writing goes to memory.
pub fn parameter_values(d: &Document) -> io::Result<Vec<u8>> {
    let root = vec![("xmlns:ssv", VALUES.into()), ("xmlns:ssc", COMMON.into()), ("version", "1.0".into()), ("name", PARAMETER_SET.into())];
    let parameters: Vec<_> = d.variables.iter().filter(|v| v.causality == Causality::Parameter).collect();
    document("ssv:ParameterSet", root, |w| {
        parent(w, "ssv:Parameters", vec![], |w| {
            parameters.iter().try_for_each(|v| {
                parent(w, "ssv:Parameter", vec![("name", v.name.clone())], |w| {
                    let mut attributes: Attributes = v.start.iter().map(|start| ("value", literal(start))).collect();
                    attributes.extend(v.unit.map(|unit| ("unit", unit.into())));
                    leaf(w, &format!("ssv:{:?}", v.kind), attributes)
                })
            })
        })?;
        units(w, "ssv:Units", parameters.iter().copied())
    })
}

/// The text of SystemStructure.ssd: two of the cables with one parameter set each, the second's winch following the first's where there
/// is a winch. `fmu` and `values` are the paths of the FMU and of the parameter set seen from the file.
///
/// # Errors
/// None in practice: writing goes to memory.
pub fn system_structure(d: &Document, fmu: &str, values: &str) -> io::Result<Vec<u8>> {
    let names = [("xmlns:ssd", DESCRIPTION), ("xmlns:ssc", COMMON), ("xmlns:ssv", VALUES), ("xmlns:osp", OSP), ("version", "1.0")];
    let mut root: Attributes = names.map(|(name, value)| (name, value.to_owned())).into();
    root.push(("name", d.name.into()));
    let signals: Vec<_> = d.variables.iter().filter(|v| v.causality != Causality::Parameter).collect();
    document("ssd:SystemStructureDescription", root, |w| {
        parent(w, "ssd:System", vec![("name", d.name.into()), ("description", d.description.into())], |w| {
            parent(w, "ssd:Elements", vec![], |w| CABLES.iter().try_for_each(|&name| component(w, name, fmu, values, &signals)))?;
            let wires = follow(d.variables);
            if wires.is_empty() {
                return Ok(());
            }
            parent(w, "ssd:Connections", vec![], |w| {
                wires.iter().try_for_each(|(output, input)| {
                    let [leader, follower] = CABLES;
                    let ends = [("startElement", leader), ("startConnector", output), ("endElement", follower), ("endConnector", input)];
                    leaf(w, "ssd:Connection", ends.map(|(name, value)| (name, value.to_owned())).into())
                })
            })
        })?;
        units(w, "ssd:Units", signals.iter().copied())?;
        let (start, stop, step) = EXPERIMENT;
        parent(w, "ssd:DefaultExperiment", vec![("startTime", number(start)), ("stopTime", number(stop))], |w| {
            parent(w, "ssd:Annotations", vec![], |w| {
                parent(w, "ssc:Annotation", vec![("type", "com.opensimulationplatform".into())], |w| {
                    let step = vec![("baseStepSize", number(step))];
                    parent(w, "osp:Algorithm", vec![], |w| leaf(w, "osp:FixedStepAlgorithm", step))
                })
            })
        })
    })
}

fn component(w: &mut Xml, name: &str, fmu: &str, values: &str, signals: &[&Variable]) -> io::Result<()> {
    let component = [("name", name), ("type", "application/x-fmu-sharedlibrary"), ("source", fmu)];
    parent(w, "ssd:Component", component.map(|(name, value)| (name, value.to_owned())).into(), |w| {
        parent(w, "ssd:Connectors", vec![], |w| {
            signals.iter().try_for_each(|v| {
                let kind = if v.causality == Causality::Input { "input" } else { "output" };
                parent(w, "ssd:Connector", vec![("name", v.name.clone()), ("kind", kind.into())], |w| {
                    leaf(w, &format!("ssc:{:?}", v.kind), v.unit.map(|unit| ("unit", unit.to_owned())).into_iter().collect())
                })
            })
        })?;
        parent(w, "ssd:ParameterBindings", vec![], |w| leaf(w, "ssd:ParameterBinding", vec![("source", values.into())]))
    })
}

/// The units in use, each with its SI base units.
fn units<'a>(w: &mut Xml, name: &str, variables: impl Iterator<Item = &'a Variable>) -> io::Result<()> {
    let used: Vec<_> = variables.filter(|v| v.kind == Kind::Real).filter_map(|v| v.unit).collect();
    let units: Vec<&Unit> = UNITS.iter().filter(|u| used.contains(&u.name)).collect();
    if units.is_empty() {
        return Ok(());
    }
    parent(w, name, vec![], |w| {
        units.iter().try_for_each(|u| parent(w, "ssc:Unit", vec![("name", u.name.into())], |w| leaf(w, "ssc:BaseUnit", base_unit(u))))
    })
}
