//! terminalsAndIcons/terminalsAndIcons.xml: FMI 3.0's format, which FMI 2.0.4 and later allow in an FMU.

use crate::Document;
use crate::groups::{Group, groups};
use crate::xml::{Attributes, Xml, document, leaf, number, parent};
use std::io;

/// Half the width of the icon in the diagram's units, which are tenths of a millimetre.
const HALF: f64 = 100.0;

/// The text of terminalsAndIcons.xml: one terminal a part of the scene, with its scalars as members and its vectors as terminals of
/// their own. Every input and output is in exactly one.
///
/// # Errors
/// None in practice: writing goes to memory.
pub fn terminals_and_icons(d: &Document) -> io::Result<Vec<u8>> {
    let groups = groups(d.variables);
    let mut parts: Vec<&str> = Vec::new();
    for group in &groups {
        if !parts.contains(&part(group)) {
            parts.push(part(group));
        }
    }
    document("fmiTerminalsAndIcons", vec![("fmiVersion", "3.0".into())], |w| {
        let corners = || ["x1", "y1", "x2", "y2"].into_iter().zip([-HALF, -HALF, HALF, HALF]).map(|(name, x)| (name, number(x)));
        parent(w, "GraphicalRepresentation", vec![], |w| {
            leaf(w, "CoordinateSystem", corners().chain([("suggestedScalingFactorTo_mm", number(0.1))]).collect())?;
            leaf(w, "Icon", corners().collect())
        })?;
        parent(w, "Terminals", vec![], |w| {
            parts.iter().try_for_each(|&name| {
                let inside: Vec<_> = groups.iter().filter(|g| part(g) == name).collect();
                parent(w, "Terminal", terminal(name, "bus"), |w| members_and_vectors(w, name, &inside))
            })
        })
    })
}

/// The part of the scene that a group belongs to: `sheave[1]` of `sheave[1].force`.
fn part<'a>(group: &'a Group) -> &'a str {
    group.name.split('.').next().unwrap_or_default()
}

/// What the group is called within its part; a group that is a part of its own has its members there.
fn within<'a>(name: &'a str, part: &str) -> &'a str {
    name.strip_prefix(part).map_or(name, |rest| rest.strip_prefix('.').unwrap_or(rest))
}

/// The schema wants all members first.
fn members_and_vectors(w: &mut Xml, part: &str, groups: &[&Group]) -> io::Result<()> {
    let alone = |g: &&&Group| !g.is_vector() || g.name == part;
    for group in groups.iter().filter(alone) {
        for (component, variable) in &group.members {
            let member = if component.is_empty() { within(&variable.name, part) } else { component };
            leaf(w, "TerminalMemberVariable", signal(&variable.name, member))?;
        }
    }
    groups.iter().filter(|g| !alone(g)).try_for_each(|group| {
        parent(w, "Terminal", terminal(within(&group.name, part), "plug"), |w| {
            group.members.iter().try_for_each(|(component, v)| leaf(w, "TerminalMemberVariable", signal(&v.name, component)))
        })
    })
}

fn terminal(name: &str, matching: &str) -> Attributes {
    vec![("name", name.into()), ("matchingRule", matching.into())]
}

fn signal(variable: &str, member: &str) -> Attributes {
    vec![("variableName", variable.into()), ("memberName", member.into()), ("variableKind", "signal".into())]
}
