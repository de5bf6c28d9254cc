//! The numbers of a scene: each is an FMI parameter, named by where it stands in the file.

use super::schema::{applies, get, instances, join};
use model_description::Value;
use model_description::keys::{Form, GROUPS, KEYS, Key};
use toml::{Table, Value as Toml};

/// A number of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Leaf {
    /// Parameter name: the dotted key with 1-based indices, such as `sheave[1].position[3]` or `fluid.current.profile[1,2]`.
    pub name: String,
    /// Real or Integer.
    pub value: Value,
    /// Where it stands.
    path: Vec<Step>,
}

#[derive(Clone, Debug, PartialEq)]
enum Step {
    Key(String),
    Index(usize),
}

/// All numbers of a normalized tree, in the order of the table of scene keys.
pub(super) fn leaves(tree: &Table) -> Vec<Leaf> {
    let mut all = Vec::new();
    for group in GROUPS {
        for (path, table) in instances(tree, group) {
            for key in KEYS.iter().filter(|k| k.group().name == group.name && !k.structural && applies(k, table)) {
                if let Some(value) = get(table, key.local_name()) {
                    let first = all.len();
                    append(key, &join(&path, key.local_name()), value, &mut all);
                    if let (Some(name), [leaf]) = (key.parameter, &mut all[first..]) {
                        leaf.name = name.to_owned();
                    }
                }
            }
        }
    }
    all
}

fn append(key: &Key, name: &str, value: &Toml, all: &mut Vec<Leaf>) {
    let numeric = !matches!(key.form, Form::Choice(_) | Form::Flag | Form::Text | Form::Identifier);
    match value {
        Toml::Float(x) if numeric => all.push(Leaf::new(name, Value::Real(*x), &[])),
        Toml::Integer(i) if numeric => all.extend(i32::try_from(*i).map(|i| Leaf::new(name, Value::Integer(i), &[]))),
        Toml::Array(rows) if numeric => {
            for (i, row) in rows.iter().enumerate() {
                match row {
                    Toml::Float(x) => all.push(Leaf::new(&format!("{name}[{}]", i + 1), Value::Real(*x), &[i])),
                    Toml::Array(cells) => {
                        let cells = cells.iter().enumerate().filter_map(|(j, cell)| Some((j, cell.as_float()?)));
                        all.extend(cells.map(|(j, x)| Leaf::new(&format!("{name}[{},{}]", i + 1, j + 1), Value::Real(x), &[i, j])));
                    }
                    _ => {}
                }
            }
        }
        _ => {}
    }
}

impl Leaf {
    /// `inner`: 0-based indices within the key's value.
    fn new(name: &str, value: Value, inner: &[usize]) -> Self {
        let key = if inner.is_empty() { name } else { &name[..name.rfind('[').unwrap_or(name.len())] };
        let mut path = Vec::new();
        for part in key.split('.') {
            let (part, index) = part.split_once('[').map_or((part, None), |(p, i)| (p, i.trim_end_matches(']').parse::<usize>().ok()));
            path.push(Step::Key(part.to_owned()));
            path.extend(index.map(|i| Step::Index(i - 1)));
        }
        path.extend(inner.iter().map(|&i| Step::Index(i)));
        Self { name: name.to_owned(), value, path }
    }

    /// Puts another value in this leaf's place. Returns whether there is such a place and the value is a number of its kind.
    pub(super) fn put(&self, tree: &mut Table, value: &Value) -> bool {
        let Some((Step::Key(first), rest)) = self.path.split_first() else { return false };
        let place = rest.iter().try_fold(tree.get_mut(first), |place, step| {
            place.map(|place| match step {
                Step::Key(key) => place.get_mut(key.as_str()),
                Step::Index(i) => place.get_mut(*i),
            })
        });
        match (place.flatten(), value) {
            (Some(place @ Toml::Float(_)), Value::Real(x)) => *place = Toml::Float(*x),
            (Some(place @ Toml::Integer(_)), Value::Integer(i)) => *place = Toml::Integer(i64::from(*i)),
            _ => return false,
        }
        true
    }
}
