//! What a scene file says beside its numbers: the comment at its head, and a remark for each number that has one.

/// A scene file's comments.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Notes {
    /// Paragraphs of the comment before the first key.
    pub preface: Vec<String>,
    /// Numbers (and choices) with a remark, in the file's order.
    pub remarks: Vec<Remark>,
}

/// A key with the comment beside it, or above it.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// Dotted name, with 1-based indices.
    pub key: String,
    /// As it stands in the file.
    pub value: String,
    /// The comment.
    pub text: String,
}

impl Remark {
    /// Whether the number was assumed, not found.
    pub fn is_assumed(&self) -> bool {
        self.text.contains("assumed")
    }
}

/// Reads the comments of a scene file. Works line by line: a value that goes over several lines is shown with `…` for what is within.
pub fn notes(text: &str) -> Notes {
    let mut notes = Notes::default();
    let mut lines = text.lines().peekable();
    let mut paragraph = String::new();
    while let Some(line) = lines.next_if(|line| line.starts_with('#')) {
        let words = line[1..].trim();
        if words.is_empty() {
            notes.preface.extend((!paragraph.is_empty()).then(|| std::mem::take(&mut paragraph)));
        } else {
            paragraph += if paragraph.is_empty() { "" } else { " " };
            paragraph += words;
        }
    }
    notes.preface.extend((!paragraph.is_empty()).then_some(paragraph));

    // The table we are in; the array we are in, with its rows counted; a comment on a line of its own.
    let (mut table, mut rows, mut above) = (String::new(), None::<(String, usize)>, String::new());
    for line in lines {
        let (code, comment) = split(line);
        let code = code.trim();
        if code.is_empty() {
            above += if above.is_empty() || comment.is_empty() { "" } else { " " };
            above += comment;
            continue;
        }
        let over = std::mem::take(&mut above);
        let remark = if comment.is_empty() { over } else { comment.to_owned() };
        if let Some((key, count)) = &mut rows {
            if code == "]" {
                rows = None;
                continue;
            }
            *count += 1;
            notes.add(&format!("{key}[{count}]"), code.trim_end_matches(','), remark);
        } else if let Some(name) = code.strip_prefix("[[").and_then(|c| c.strip_suffix("]]")) {
            let before = format!("{name}[");
            let last = table.strip_prefix(&before).and_then(|t| t.strip_suffix(']')).and_then(|n| n.parse::<usize>().ok());
            table = format!("{name}[{}]", last.unwrap_or(0) + 1);
        } else if let Some(name) = code.strip_prefix('[').and_then(|c| c.strip_suffix(']')) {
            table = name.to_owned();
        } else if let Some((key, value)) = code.split_once('=') {
            let (key, value) = (key.trim(), value.trim());
            let key = if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") };
            if value == "[" {
                notes.add(&key, "[…]", remark);
                rows = Some((key, 0));
            } else {
                notes.add(&key, value, remark);
            }
        }
    }
    notes
}

impl Notes {
    fn add(&mut self, key: &str, value: &str, text: String) {
        if !text.is_empty() {
            self.remarks.push(Remark { key: key.to_owned(), value: value.to_owned(), text });
        }
    }
}

/// What is before a `#` that stands in no string, and what is behind it.
fn split(line: &str) -> (&str, &str) {
    let mut quoted = false;
    for (i, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            '#' if !quoted => return (&line[..i], line[i + 1..].trim()),
            _ => {}
        }
    }
    (line, "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_comments_are_found_where_they_stand() {
        let text = "# One\n# line.\n#\n# Two.\n\nname = \"a # b\" # the name\ngravity = 9.81\n[mesh]\n# cut\nregions = [\n    \
                    { length = 1, elements = 2 }, # fine\n    { length = 2, elements = 2 },\n]\n[[sheave]]\nradius = 1 # assumed\n\
                    [[sheave]]\n# big\nradius = 2\n";
        let found = notes(text);
        assert_eq!(found.preface, ["One line.", "Two."]);
        let remarks: Vec<_> = found.remarks.iter().map(|r| (r.key.as_str(), r.value.as_str(), r.text.as_str())).collect();
        let expected = [
            ("name", "\"a # b\"", "the name"),
            ("mesh.regions", "[…]", "cut"),
            ("mesh.regions[1]", "{ length = 1, elements = 2 }", "fine"),
            ("sheave[1].radius", "1", "assumed"),
            ("sheave[2].radius", "2", "big"),
        ];
        assert_eq!(remarks, expected);
        assert!(found.remarks[3].is_assumed() && !found.remarks[4].is_assumed());
    }

    #[test]
    fn exact_every_built_in_scene_says_its_source_and_what_is_assumed() {
        for scene in crate::scenes::SCENES {
            let found = notes(scene.text);
            assert!(found.preface.len() >= 2, "{}: no source", scene.name);
            assert!(found.remarks.iter().any(Remark::is_assumed), "{}: nothing is said to be assumed", scene.name);
        }
    }
}
