//! Files for the Open Simulation Platform: what a model's variables mean (OSP-IS 1.0), and an example system for libcosim.

use crate::groups::{Group, groups};
use crate::ssp::{CABLES, follow};
use crate::xml::{EXPERIMENT, Xml, document, leaf, number, parent, units};
use crate::{Causality, Document, Variable};
use std::io;

const MODEL_DESCRIPTION: &str = "https://open-simulation-platform.com/OspModelDescription/1.0.0";
const SYSTEM_STRUCTURE: &str = "http://opensimulationplatform.com/MSMI/OSPSystemStructure";

/// Power bonds: a force and the velocity of the point that it acts on, in the same frame, one in and one out.
/// Of `ship.moment` there is none: it is in ship axes, and the rates that go in are those of the three angles.
const PORTS: [(&str, &str, &str); 2] = [("ship.bond", "ship.force_world", "ship.velocity"), ("body.bond", "body.force", "body.velocity")];

/// Kinds of variable groups, in the order that the schema wants, and the types of the variables in them.
const KINDS: [(&str, &[&str]); 9] = [
    ("Generic", &[]),
    ("Force", &["Force", "ContactForce"]),
    ("Torque", &["Moment"]),
    ("LinearVelocity", &["Velocity"]),
    ("AngularVelocity", &["AngularVelocity"]),
    ("LinearDisplacement", &["Position", "Payout"]),
    ("AngularDisplacement", &["Angle", "ArcAngle"]),
    ("LinearAcceleration", &["Acceleration"]),
    ("AngularAcceleration", &["AngularAcceleration"]),
];

/// The text of `NAME_OspModelDescription.xml`, which libcosim looks for beside the FMU.
///
/// # Errors
/// None in practice: writing goes to memory.
pub fn model_description(d: &Document) -> io::Result<Vec<u8>> {
    let signals: Vec<Variable> = d.variables.iter().filter(|v| v.causality != Causality::Parameter).cloned().collect();
    let groups = groups(&signals);
    let named = |name: &str| groups.iter().find(|g| g.name == name);
    let ports: Vec<_> = PORTS.iter().filter_map(|(name, force, velocity)| Some((*name, named(force)?, named(velocity)?))).collect();
    let in_port = |g: &Group| ports.iter().any(|(_, force, velocity)| force.name == g.name || velocity.name == g.name);
    let root = vec![("xmlns", MODEL_DESCRIPTION.into()), ("version", "1.0".into())];
    document("OspModelDescription", root, |w| {
        units(w, &signals)?;
        parent(w, "VariableGroups", vec![], |w| {
            for (kind, _) in KINDS {
                groups.iter().filter(|g| kind_of(g) == kind && !in_port(g)).try_for_each(|g| group(w, g))?;
            }
            ports.iter().try_for_each(|(name, force, velocity)| {
                parent(w, "LinearMechanicalPort", vec![("name", (*name).into())], |w| group(w, force).and_then(|()| group(w, velocity)))
            })
        })
    })
}

/// The kind of a group. The rates of the three angles are no angular velocity, whatever their unit says.
fn kind_of(group: &Group) -> &'static str {
    let angle_rates = group.is_vector() && matches!(group.declared_type(), Some("AngularVelocity" | "AngularAcceleration"));
    let of = group.declared_type().filter(|_| !angle_rates);
    KINDS.iter().find(|(_, types)| of.is_some_and(|t| types.contains(&t))).map_or("Generic", |(kind, _)| kind)
}

fn group(w: &mut Xml, group: &Group) -> io::Result<()> {
    parent(w, kind_of(group), vec![("name", group.name.clone())], |w| {
        group.members.iter().try_for_each(|(_, v)| {
            let unit = v.unit.map(|unit| ("unit", unit.to_owned()));
            leaf(w, "Variable", [("ref", v.name.clone())].into_iter().chain(unit).collect())
        })
    })
}

/// The text of an example OspSystemStructure.xml: two of the cables, the second's winch following the first's where there is a winch.
/// `fmu` is the FMU's path seen from the file.
///
/// # Errors
/// None in practice: writing goes to memory.
pub fn system_structure(d: &Document, fmu: &str) -> io::Result<Vec<u8>> {
    let (start, _, step) = EXPERIMENT;
    let root = vec![("xmlns", SYSTEM_STRUCTURE.into()), ("version", "0.1".into())];
    document("OspSystemStructure", root, |w| {
        text(w, "StartTime", &number(start))?;
        text(w, "BaseStepSize", &number(step))?;
        text(w, "Algorithm", "fixedStep")?;
        parent(w, "Simulators", vec![], |w| {
            CABLES.iter().try_for_each(|&name| {
                let simulator = vec![("name", name.into()), ("source", fmu.into()), ("stepSize", number(step))];
                leaf(w, "Simulator", simulator)
            })
        })?;
        let wires = follow(d.variables);
        if wires.is_empty() {
            return Ok(());
        }
        parent(w, "Connections", vec![], |w| {
            wires.iter().try_for_each(|(output, input)| {
                parent(w, "VariableConnection", vec![], |w| {
                    leaf(w, "Variable", vec![("simulator", CABLES[0].into()), ("name", (*output).into())])?;
                    leaf(w, "Variable", vec![("simulator", CABLES[1].into()), ("name", (*input).into())])
                })
            })
        })
    })
}

fn text(w: &mut Xml, name: &str, text: &str) -> io::Result<()> {
    w.create_element(name).write_text_content(quick_xml::events::BytesText::new(text)).map(|_| ())
}
