//! What an importer needs from modelDescription.xml.

use crate::error::Failure;
use model_description::Kind;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::str::FromStr;

/// The part of modelDescription.xml that it takes to run an FMU.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// Free text.
    pub model_name: String,
    /// Name of the library.
    pub identifier: String,
    /// To be given to fmi2Instantiate.
    pub guid: String,
    /// s.
    pub start: Option<f64>,
    /// s.
    pub stop: Option<f64>,
    /// Preferred communication step, s.
    pub step: Option<f64>,
    /// In declaration order.
    pub variables: Vec<Variable>,
}

/// One scalar variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Structured name.
    pub name: String,
    /// Value reference.
    pub reference: u32,
    /// Base type; enumerations count as integers.
    pub kind: Kind,
    /// `parameter`, `input`, `output`, ...
    pub causality: String,
    /// `fixed`, `tunable`, ...
    pub variability: String,
    /// As written.
    pub start: Option<String>,
    /// Of Reals.
    pub unit: Option<String>,
}

impl Description {
    /// Reads the text of a modelDescription.xml.
    ///
    /// # Errors
    /// Says where the text is no FMI 2.0 co-simulation description.
    pub fn parse(xml: &str) -> Result<Self, Failure> {
        let mut description = Self::default();
        let mut reader = Reader::from_str(xml);
        let mut pending: Option<Variable> = None;
        loop {
            let place = reader.buffer_position();
            let fail = |problem: String| {
                let line = 1 + xml.bytes().take(place as usize).filter(|&b| b == b'\n').count();
                Failure(format!("modelDescription.xml:{line}: {problem}"))
            };
            match reader.read_event().map_err(|e| fail(e.to_string()))? {
                Event::Start(tag) | Event::Empty(tag) => description.element(&Tag(tag), &mut pending).map_err(fail)?,
                Event::Eof => break,
                _ => {}
            }
        }
        let missing = |what: &str| Failure(format!("modelDescription.xml: {what}"));
        if description.guid.is_empty() {
            return Err(missing("there is no fmiModelDescription element with a guid"));
        }
        if description.identifier.is_empty() {
            return Err(missing("there is no CoSimulation element with a modelIdentifier; expected an FMI 2.0 co-simulation FMU"));
        }
        Ok(description)
    }

    fn element(&mut self, tag: &Tag, pending: &mut Option<Variable>) -> Result<(), String> {
        match tag.0.name().as_ref() {
            "fmiModelDescription" => {
                let version = tag.required("fmiVersion")?;
                if version != "2.0" {
                    return Err(format!("fmiVersion is '{version}'; expected '2.0'"));
                }
                self.model_name = tag.required("modelName")?;
                self.guid = tag.required("guid")?;
            }
            "CoSimulation" => self.identifier = tag.required("modelIdentifier")?,
            "DefaultExperiment" => {
                self.start = tag.number("startTime")?;
                self.stop = tag.number("stopTime")?;
                self.step = tag.number("stepSize")?;
            }
            "ScalarVariable" => {
                *pending = Some(Variable {
                    name: tag.required("name")?,
                    reference: tag.number("valueReference")?.ok_or("a variable has no valueReference")?,
                    kind: Kind::Real,
                    causality: tag.optional("causality")?.unwrap_or_else(|| "local".into()),
                    variability: tag.optional("variability")?.unwrap_or_else(|| "continuous".into()),
                    start: None,
                    unit: None,
                });
            }
            element => {
                if let (Some(kind), Some(mut variable)) = (kind(element), pending.take()) {
                    variable.kind = kind;
                    variable.start = tag.optional("start")?;
                    variable.unit = tag.optional("unit")?;
                    self.variables.push(variable);
                }
            }
        }
        Ok(())
    }

    /// The variable of this name.
    ///
    /// # Errors
    /// Names the variable that there is not.
    pub fn variable(&self, name: &str) -> Result<&Variable, Failure> {
        let found = self.variables.iter().find(|variable| variable.name == name);
        found.ok_or_else(|| Failure(format!("the FMU {} has no variable '{name}'{}", self.model_name, self.similar(name))))
    }

    /// "; did you mean ...?" where some name is close.
    pub fn similar(&self, name: &str) -> String {
        let scored = self.variables.iter().map(|variable| (strsim::jaro_winkler(name, &variable.name), &variable.name));
        let best = scored.filter(|(score, _)| *score > 0.85).max_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(String::new, |(_, best)| format!("; did you mean '{best}'?"))
    }

    /// All variables of this causality.
    pub fn with_causality<'a>(&'a self, causality: &'a str) -> impl Iterator<Item = &'a Variable> {
        self.variables.iter().filter(move |variable| variable.causality == causality)
    }
}

fn kind(element: &str) -> Option<Kind> {
    match element {
        "Real" => Some(Kind::Real),
        "Integer" | "Enumeration" => Some(Kind::Integer),
        "Boolean" => Some(Kind::Boolean),
        "String" => Some(Kind::String),
        _ => None,
    }
}

struct Tag<'a>(BytesStart<'a>);

impl Tag<'_> {
    fn optional(&self, name: &str) -> Result<Option<String>, String> {
        let attribute = self.0.try_get_attribute(name).map_err(|e| e.to_string())?;
        let value = attribute.map(|attribute| attribute.normalized_value(XmlVersion::Explicit1_0).map(|value| value.into_owned()));
        value.transpose().map_err(|e| e.to_string())
    }

    fn required(&self, name: &str) -> Result<String, String> {
        self.optional(name)?.ok_or_else(|| format!("{} has no attribute '{name}'", self.0.name().as_ref()))
    }

    fn number<T: FromStr>(&self, name: &str) -> Result<Option<T>, String> {
        let text = self.optional(name)?;
        text.map(|text| text.parse().map_err(|_| format!("attribute {name} is '{text}'; expected a number"))).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const XML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="a &amp; b" guid="{1}">
  <CoSimulation modelIdentifier="ab"/>
  <TypeDefinitions><SimpleType name="Length"><Real unit="m"/></SimpleType></TypeDefinitions>
  <DefaultExperiment startTime="0" stopTime="2.5" stepSize="0.01"/>
  <ModelVariables>
    <ScalarVariable name="ship.x" valueReference="3" causality="input"><Real unit="m" start="1"/></ScalarVariable>
    <ScalarVariable name="cable.slack" valueReference="0" causality="output" variability="discrete"><Boolean/></ScalarVariable>
  </ModelVariables>
</fmiModelDescription>"#;

    #[test]
    fn reads_what_it_needs() {
        let d = Description::parse(XML).unwrap();
        assert_eq!((d.model_name.as_str(), d.guid.as_str(), d.identifier.as_str()), ("a & b", "{1}", "ab"));
        assert_eq!((d.start, d.stop, d.step), (Some(0.0), Some(2.5), Some(0.01)));
        assert_eq!(d.variables.len(), 2);
        let x = d.variable("ship.x").unwrap();
        assert_eq!((x.reference, x.kind, x.start.as_deref(), x.unit.as_deref()), (3, Kind::Real, Some("1"), Some("m")));
        assert_eq!(d.variable("cable.slack").unwrap().kind, Kind::Boolean);
        assert!(d.variable("ship.xx").unwrap_err().0.contains("did you mean 'ship.x'"));
    }

    #[test]
    fn says_what_is_wrong_and_where() {
        let message = |xml: &str| Description::parse(xml).unwrap_err().0;
        assert!(message(&XML.replace("\"2.0\"", "\"3.0\"")).contains(":2: fmiVersion is '3.0'"));
        assert!(message(&XML.replace("CoSimulation", "ModelExchange")).contains("CoSimulation"));
        assert!(message(&XML.replace("valueReference=\"3\"", "valueReference=\"x\"")).contains(":7: attribute valueReference is 'x'"));
        assert!(message("no xml").contains("modelDescription.xml"));
    }
}
