//! Holds a scene file against the table of scene keys: unknown keys, wrong types, values out of range, missing keys; fills in defaults.

use super::problem::Problems;
use model_description::keys::{
    COEFFICIENT_COLUMNS, CORRELATIONS, Column, Constant, Form, GROUPS, Group, KEYS, Key, Presence, Range, When, key_named,
};
use toml::{Table, Value};

/// Finds everything that is wrong key by key and brings the tree into its full form: defaults filled in, real numbers as floats.
pub(super) fn normalize(tree: &mut Table) -> Problems {
    let mut problems = Problems::default();
    walk(tree, "", "", &mut problems);
    for group in GROUPS {
        check_group(tree, group, &mut problems);
    }
    problems
}

/// The value at a dotted name relative to a table.
pub(super) fn get<'a>(table: &'a Table, name: &str) -> Option<&'a Value> {
    match name.split_once('.') {
        None => table.get(name),
        Some((first, rest)) => get(table.get(first)?.as_table()?, rest),
    }
}

/// The tables of a group that the tree has, with their dotted names (1-based indices).
pub(super) fn instances<'a>(tree: &'a Table, group: &Group) -> Vec<(String, &'a Table)> {
    if group.name.is_empty() {
        return vec![(String::new(), tree)];
    }
    match get(tree, group.name) {
        Some(Value::Table(table)) if !group.repeated => vec![(group.name.to_owned(), table)],
        Some(Value::Array(array)) if group.repeated => {
            let named = array.iter().enumerate().map(|(i, v)| (format!("{}[{}]", group.name, i + 1), v));
            named.filter_map(|(name, v)| Some((name, v.as_table()?))).collect()
        }
        _ => vec![],
    }
}

/// Whether a key applies to a table of its group.
pub(super) fn applies(key: &Key, table: &Table) -> bool {
    match key.when {
        When::Always => true,
        When::Given(other) => get(table, other).is_some(),
        When::Is(other, values) => get(table, other).and_then(Value::as_str).is_some_and(|v| values.contains(&v)),
    }
}

/// Joins two parts of a dotted name.
pub(super) fn join(parent: &str, child: &str) -> String {
    if parent.is_empty() { child.to_owned() } else { format!("{parent}.{child}") }
}

fn walk(table: &mut Table, path: &str, plain: &str, problems: &mut Problems) {
    for (name, value) in table.iter_mut() {
        let path = join(path, name);
        let plain = join(plain, name);
        if let Some(key) = key_named(&plain) {
            if let Err(found) = check_value(key.form, value) {
                problems.add(path, format!("{found}; expected {}", key.form.expected()));
            }
        } else if GROUPS.iter().any(|g| g.name == plain && g.repeated) {
            match value {
                Value::Array(array) if array.iter().all(Value::is_table) => {
                    for (i, element) in array.iter_mut().filter_map(Value::as_table_mut).enumerate() {
                        walk(element, &format!("{path}[{}]", i + 1), &plain, problems);
                    }
                }
                _ => problems.add(path, format!("{}; expected an array of tables [[{plain}]]", found(value))),
            }
        } else if KEYS.iter().any(|k| k.name.starts_with(&format!("{plain}."))) {
            match value {
                Value::Table(inner) => walk(inner, &path, &plain, problems),
                _ => problems.add(path, format!("{}; expected a table [{plain}]", found(value))),
            }
        } else {
            problems.add(path, format!("unknown key{}", hint(&plain)));
        }
    }
}

/// The most similar key beside an unknown one, or else a key of that name elsewhere.
fn hint(plain: &str) -> String {
    let (parent, name) = plain.rsplit_once('.').unwrap_or(("", plain));
    let names = KEYS.iter().map(|k| k.name).chain(GROUPS.iter().map(|g| g.name));
    let siblings = names.filter_map(|n| if parent.is_empty() { Some(n) } else { n.strip_prefix(parent)?.strip_prefix('.') });
    let siblings = siblings.filter_map(|n| n.split('.').next()).filter(|n| !n.is_empty());
    let elsewhere = || KEYS.iter().find(|k| k.name.rsplit('.').next() == Some(name)).map(|k| k.name.to_owned());
    let known = best_match(name, siblings).map(|n| join(parent, n)).or_else(elsewhere);
    known.map_or(String::new(), |n| format!("; did you mean {n}?"))
}

/// The candidate most like `word`, if any is much like it.
pub fn best_match<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let scored = candidates.map(|c| (strsim::jaro_winkler(&word, &c.to_lowercase()), c));
    scored.filter(|(score, _)| *score > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, c)| c)
}

fn check_group(tree: &mut Table, group: &Group, problems: &mut Problems) {
    if get(tree, group.name).is_none() && !group.name.is_empty() {
        match group.presence {
            Presence::Required => problems.add(group.name, format!("missing; expected a table [{}]", group.name)),
            Presence::Default(_) => {
                tree.insert(group.name.to_owned(), Value::Table(Table::new()));
            }
            Presence::RequiredWith(_) | Presence::Optional => {}
        }
    }
    let keys: Vec<_> = KEYS.iter().filter(|k| k.group().name == group.name).collect();
    let top_level: Vec<_> = tree.keys().cloned().collect();
    for (path, table) in instances_mut(tree, group) {
        for key in &keys {
            check_presence(key, &path, table, &top_level, problems);
        }
    }
}

fn check_presence(key: &Key, path: &str, table: &mut Table, top_level: &[String], problems: &mut Problems) {
    let name = key.local_name();
    let given = get(table, name).is_some();
    let required_with = |other: &str| top_level.iter().any(|t| t == other);
    match (applies(key, table), given, key.presence) {
        (false, true, _) => {
            // What it depends on may be wrong itself; then one complaint is enough.
            let excused = matches!(key.when, When::Is(other, _) if problems.has(&join(path, other)));
            if !excused {
                problems.add(join(path, name), condition(key.when, path));
            }
        }
        (true, false, Presence::Required) => problems.add(join(path, name), format!("missing; expected {}", key.form.expected())),
        (true, false, Presence::RequiredWith(other)) if required_with(other) => {
            problems.add(join(path, name), format!("missing; a scene with [{other}] needs {}", key.form.expected()));
        }
        (true, false, Presence::Default(value)) => insert(table, name, constant(value)),
        _ => {}
    }
}

fn condition(when: When, path: &str) -> String {
    match when {
        When::Always => String::new(),
        When::Given(other) => format!("only allowed together with {}", join(path, other)),
        When::Is(other, values) => {
            let values: Vec<_> = values.iter().map(|v| format!("\"{v}\"")).collect();
            format!("only allowed with {} = {}", join(path, other), values.join(" or "))
        }
    }
}

fn constant(value: Constant) -> Value {
    match value {
        Constant::Real(x) => Value::Float(x),
        Constant::Integer(i) => Value::Integer(i),
        Constant::Text(s) => Value::String(s.to_owned()),
        Constant::Flag(b) => Value::Boolean(b),
    }
}

/// Puts a value at a dotted name; what is in the way and no table stays (and has been complained of).
fn insert(table: &mut Table, name: &str, value: Value) {
    match name.split_once('.') {
        None => {
            table.insert(name.to_owned(), value);
        }
        Some((first, rest)) => {
            if let Value::Table(inner) = table.entry(first).or_insert_with(|| Value::Table(Table::new())) {
                insert(inner, rest, value);
            }
        }
    }
}

fn instances_mut<'a>(tree: &'a mut Table, group: &Group) -> Vec<(String, &'a mut Table)> {
    let mut table = tree;
    let mut parts = group.name.split('.').filter(|p| !p.is_empty()).peekable();
    while let Some(part) = parts.next() {
        match table.get_mut(part) {
            Some(Value::Table(inner)) if parts.peek().is_some() || !group.repeated => table = inner,
            Some(Value::Array(array)) if parts.peek().is_none() && group.repeated => {
                let named = array.iter_mut().enumerate().map(|(i, v)| (format!("{}[{}]", group.name, i + 1), v));
                return named.filter_map(|(name, v)| Some((name, v.as_table_mut()?))).collect();
            }
            _ => return vec![],
        }
    }
    vec![(group.name.to_owned(), table)]
}

/// Checks a value and turns whole numbers into floats where the key is real. `Err`: what was found instead.
fn check_value(form: Form, value: &mut Value) -> Result<(), String> {
    let fits = match form {
        Form::Real(_, range) => real(value, range),
        Form::Integer(low, high) => value.as_integer().is_some_and(|i| (low..=high).contains(&i)),
        Form::OneOf(values) => value.as_integer().is_some_and(|i| values.contains(&i)),
        Form::Vector(_) => value.as_array_mut().is_some_and(|a| a.len() == 3 && a.iter_mut().all(|v| real(v, Range::Any))),
        Form::Rows(columns) => rows(value, columns),
        Form::Coefficient => match value {
            Value::String(s) => CORRELATIONS.contains(&s.as_str()),
            Value::Array(_) => rows(value, COEFFICIENT_COLUMNS),
            _ => real(value, Range::NotNegative),
        },
        Form::Choice(values) => value.as_str().is_some_and(|s| values.contains(&s)),
        Form::Flag => value.is_bool(),
        Form::Text => value.as_str().is_some_and(|s| !s.chars().any(|c| c.is_control() && !c.is_ascii_whitespace())),
        Form::Identifier => value.as_str().is_some_and(is_identifier),
    };
    if fits {
        return Ok(());
    }
    let suggestion = match (form, value.as_str()) {
        (Form::Choice(values), Some(s)) => best_match(s, values.iter().copied()),
        (Form::Coefficient, Some(s)) => best_match(s, CORRELATIONS.iter().copied()),
        _ => None,
    };
    Err(found(value) + &suggestion.map_or(String::new(), |s| format!("; did you mean \"{s}\"?")))
}

fn real(value: &mut Value, range: Range) -> bool {
    if let Value::Integer(i) = *value {
        *value = Value::Float(i as f64);
    }
    value.as_float().is_some_and(|x| range.holds(x))
}

fn rows(value: &mut Value, columns: &[Column]) -> bool {
    let row = |row: &mut Value| {
        row.as_array_mut()
            .is_some_and(|cells| cells.len() == columns.len() && cells.iter_mut().zip(columns).all(|(cell, c)| real(cell, c.range)))
    };
    value.as_array_mut().is_some_and(|a| !a.is_empty() && a.iter_mut().all(row))
}

fn is_identifier(s: &str) -> bool {
    let first = |c: char| c.is_ascii_alphabetic() || c == '_';
    s.len() <= 63 && s.starts_with(first) && s.chars().all(|c| first(c) || c.is_ascii_digit())
}

/// What stands in the file, in few words.
fn found(value: &Value) -> String {
    let text = value.to_string();
    let short = if text.chars().count() > 80 { text.chars().take(77).chain("...".chars()).collect() } else { text };
    format!("found {}", short.replace('\n', " "))
}
