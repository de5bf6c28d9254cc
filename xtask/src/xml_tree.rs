//! A small XML document as a tree.

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::BTreeMap;

/// An element without its text.
#[derive(Debug, Default)]
pub struct Element {
    /// Name.
    pub name: String,
    /// Attributes, unescaped.
    pub attributes: BTreeMap<String, String>,
    /// Child elements.
    pub children: Vec<Element>,
}

impl Element {
    /// Reads a document.
    ///
    /// # Errors
    /// What is wrong with it and where.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut reader = Reader::from_str(text);
        reader.config_mut().trim_text(true);
        // The outermost element collects the document's root.
        let mut open = vec![Self::default()];
        loop {
            let event = reader.read_event().map_err(|e| format!("line {}: {e}", line(text, reader.error_position())))?;
            let here = || line(text, reader.buffer_position());
            match event {
                Event::Start(start) => open.push(Self::new(&start).map_err(|e| format!("line {}: {e}", here()))?),
                Event::Empty(start) => {
                    let element = Self::new(&start).map_err(|e| format!("line {}: {e}", here()))?;
                    open.last_mut().ok_or("no root")?.children.push(element);
                }
                Event::End(_) => {
                    let element = open.pop().ok_or("no root")?;
                    open.last_mut().ok_or("no root")?.children.push(element);
                }
                Event::Eof => break,
                _ => {}
            }
        }
        match (open.len(), open.pop().and_then(|mut document| document.children.pop())) {
            (1, Some(root)) => Ok(root),
            (1, None) => Err("there is no element".into()),
            _ => Err("it ends before its root element does".into()),
        }
    }

    fn new(start: &BytesStart) -> Result<Self, String> {
        let mut attributes = BTreeMap::new();
        for attribute in start.attributes() {
            let attribute = attribute.map_err(|e| e.to_string())?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|e| e.to_string())?;
            attributes.insert(attribute.key.as_ref().to_owned(), value.into_owned());
        }
        Ok(Self { name: start.name().as_ref().to_owned(), attributes, children: vec![] })
    }

    /// An attribute's value.
    pub fn get(&self, attribute: &str) -> Option<&str> {
        self.attributes.get(attribute).map(String::as_str)
    }

    /// The first child of that name.
    pub fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|c| c.name == name)
    }

    /// The children of the first child of that name.
    pub fn list(&self, name: &str) -> &[Self] {
        self.child(name).map_or(&[], |c| &c.children)
    }
}

fn line(text: &str, position: u64) -> usize {
    let end = usize::try_from(position).unwrap_or(usize::MAX).min(text.len());
    text.as_bytes()[..end].iter().filter(|&&b| b == b'\n').count() + 1
}
