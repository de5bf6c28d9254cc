//! Variables that belong together: the components of a vector under one name, everything else alone.
//!
//! Importers with ports (OSP's variable groups, FMI's terminals) connect a whole group at once.

use crate::pattern::{components, expand};
use crate::table::{FAMILIES, Family};
use crate::{Causality, Variable};

/// One vector or one scalar among the inputs and outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Group<'a> {
    /// Dotted name: a vector's without its components (`winch.force`), or the variable's own.
    pub name: String,
    /// Members in the order x, y, z, each with its name within the group; a scalar's is empty.
    pub members: Vec<(&'static str, &'a Variable)>,
}

impl Group<'_> {
    /// Whether it is a vector.
    pub fn is_vector(&self) -> bool {
        self.members.len() > 1
    }

    /// Name of the physical type of its members; `None` unless they are Reals.
    pub fn declared_type(&self) -> Option<&'static str> {
        self.members[0].1.declared_type
    }
}

/// All inputs and outputs in groups, each in exactly one, in declaration order.
pub fn groups(variables: &[Variable]) -> Vec<Group<'_>> {
    let signals = variables.iter().filter(|v| v.causality != Causality::Parameter);
    let mut groups: Vec<Group> = Vec::new();
    for variable in signals {
        let Some(family) = FAMILIES.iter().find(|f| f.id == variable.reference >> 16) else { continue };
        let components = components(family.name);
        let index = variable.reference as usize & 0xffff;
        let (part, component) = (index / components.len(), components[index % components.len()]);
        if !is_vector(&components) {
            groups.push(Group { name: variable.name.clone(), members: vec![("", variable)] });
            continue;
        }
        let name = vector_name(family, &components, part, variable);
        match groups.last_mut().filter(|g| g.name == name) {
            Some(group) => group.members.push((component, variable)),
            None => groups.push(Group { name, members: vec![(component, variable)] }),
        }
    }
    groups
}

/// Numbered components, such as the two flanks of a groove, are no vector.
fn is_vector(components: &[&str]) -> bool {
    components.len() > 1 && components.iter().all(|c| c.parse::<u32>().is_err())
}

/// `body.{x,y,z}` is the body's position, but `winch.force.{x,y,z}` says already what it is.
fn vector_name(family: &Family, components: &[&str], part: usize, variable: &Variable) -> String {
    let first = expand(family.name, part + 1, components[0]);
    let stem = first.rsplit_once('.').map_or(first.as_str(), |(stem, _)| stem);
    let axes = components.iter().all(|c| ["x", "y", "z"].contains(c));
    let quantity = match variable.declared_type {
        Some("Position") => "position",
        _ if axes => return stem.to_owned(),
        Some("Velocity") => "velocity",
        Some("Acceleration") => "acceleration",
        Some("Angle") => "attitude",
        // Derivatives of the three angles, which are no angular velocity vector.
        Some("AngularVelocity") => "attitude_rate",
        Some("AngularAcceleration") => "attitude_acceleration",
        _ => "vector",
    };
    format!("{stem}.{quantity}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, SheaveShape, variables};
    use std::collections::HashSet;

    /// A scene that has nearly every family.
    fn rich() -> Vec<Variable> {
        let shape = Shape {
            ship_derivatives: Some(2),
            winch: true,
            external_setpoint: true,
            sheaves: vec![SheaveShape { groove: true, turns: true }; 2],
            fluid: true,
            body: true,
            body_force: true,
            points: 3,
            ..Shape::default()
        };
        variables(&shape, &[])
    }

    #[test]
    fn exact_every_signal_is_in_one_group() {
        let variables = rich();
        let groups = groups(&variables);
        let members: Vec<_> = groups.iter().flat_map(|g| g.members.iter().map(|(_, v)| v.name.as_str())).collect();
        let signals: Vec<_> = variables.iter().filter(|v| v.causality != Causality::Parameter).map(|v| v.name.as_str()).collect();
        assert_eq!(members, signals);
        let names: HashSet<_> = groups.iter().map(|g| &g.name).collect();
        assert_eq!(names.len(), groups.len(), "two groups of one name");
        assert!(groups.iter().all(|g| g.members.len() <= 3 && !g.name.ends_with(".vector")));
    }

    #[test]
    fn exact_vectors_are_called_what_they_are() {
        let variables = rich();
        let groups = groups(&variables);
        let members = |name: &str| -> Vec<&str> {
            groups.iter().find(|g| g.name == name).map_or(vec![], |g| g.members.iter().map(|(m, _)| *m).collect())
        };
        assert_eq!(members("ship.position"), ["x", "y", "z"]);
        assert_eq!(members("ship.attitude"), ["roll", "pitch", "yaw"]);
        assert_eq!(members("ship.attitude_rate"), ["roll_rate", "pitch_rate", "yaw_rate"]);
        assert_eq!(members("sheave[2].moment"), ["x", "y", "z"]);
        assert_eq!(members("cable.point[3].position"), ["x", "y", "z"]);
        assert_eq!(members("current"), ["x", "y"]);
        assert_eq!(members("sheave[1].flank_force[2]"), [""]);
        assert_eq!(members("winch.tension"), [""]);
    }
}
