//! Name patterns: `[i]` stands for a 1-based index, `{x,y,z}` for one of several components.

/// The components that a pattern runs over; one empty component without braces.
pub fn components(pattern: &str) -> Vec<&str> {
    match braces(pattern) {
        Some((open, close)) => pattern[open + 1..close].split(',').collect(),
        None => vec![""],
    }
}

/// The pattern with its component put in and `[i]` replaced by a 1-based index.
pub fn expand(pattern: &str, index: usize, component: &str) -> String {
    let name = match braces(pattern) {
        Some((open, close)) => format!("{}{component}{}", &pattern[..open], &pattern[close + 1..]),
        None => pattern.to_owned(),
    };
    name.replace("[i]", &format!("[{index}]"))
}

/// A name without its indices, and the indices: `sheave[2].position[3]` gives `sheave.position` and 2, 3.
/// `None` where a bracket holds something else than numbers.
pub fn strip(name: &str) -> Option<(String, Vec<usize>)> {
    let mut plain = String::new();
    let mut indices = Vec::new();
    let mut rest = name;
    while let Some((before, after)) = rest.split_once('[') {
        plain.push_str(before);
        let (inside, after) = after.split_once(']')?;
        for index in inside.split(',') {
            indices.push(index.parse().ok()?);
        }
        rest = after;
    }
    plain.push_str(rest);
    Some((plain, indices))
}

fn braces(pattern: &str) -> Option<(usize, usize)> {
    Some((pattern.find('{')?, pattern.find('}')?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_patterns_expand_and_names_strip() {
        assert_eq!(components("a.{x,y}"), ["x", "y"]);
        assert_eq!(expand("sheave[i].force.{x,y,z}", 2, "y"), "sheave[2].force.y");
        assert_eq!(expand("sheave[i].flank_force[{1,2}]", 1, "2"), "sheave[1].flank_force[2]");
        assert_eq!(strip("sheave[2].position[3]"), Some(("sheave.position".into(), vec![2, 3])));
        assert_eq!(strip("fluid.current.profile[1,2]"), Some(("fluid.current.profile".into(), vec![1, 2])));
        assert_eq!(strip("gravity"), Some(("gravity".into(), vec![])));
        assert_eq!(strip("a[i].b"), None);
    }
}
