//! Ours against real time at a given error: `cargo xtask bench`.

use super::cases::Case;
use super::rivals::{Work, cheapest};
use super::row::share;
use super::section::Section;
use super::track::Off;

/// Scenes, the tension error that is allowed, and how many times faster than real time is asked for.
const TARGETS: [(&str, f64, f64); 2] = [("flume", 1e-2, 500.0), ("overboard", 1e-2, 200.0)];

/// What a case reached: its line in the table, if something is asked of it.
pub fn line(case: &Case, curves: &[(String, Vec<Work>)]) -> Option<Vec<String>> {
    let (_, error, asked) = TARGETS.into_iter().find(|(name, ..)| case.name.starts_with(name))?;
    let found = cheapest(curves, &Off { tension: error, place: None }, false);
    let (method, times) = found.as_ref().map_or(("none", f64::NAN), |(method, cost)| (method.as_str(), case.end / cost));
    let (reached, verdict) = match &found {
        Some(_) => (format!("{times:.0}"), if times >= asked { "held" } else { "NOT HELD" }),
        None => (String::new(), "NOT HELD"),
    };
    println!("{:6} at {}: {times:.0} x real time with {method}, asked for {asked}: {verdict}", case.name, share(error));
    Some(vec![case.what.to_owned(), share(error), method.to_owned(), reached, format!("{asked}"), verdict.to_owned()])
}

/// The table of them.
pub fn section(lines: Vec<Vec<String>>) -> Section {
    let text = "The cheapest of our methods at the error, between two tolerances by logarithms. The error is that in time, on the scene's own \
                mesh; what the mesh adds is said in the README (\u{201c}mesh.error\u{201d}). Where the time goes: see \u{201c}What parts of a scene cost\u{201d} below.";
    Section::new("Against real time").text(text).table(&["Scene", "Tension error", "Method", "Times real time", "Asked for", ""], lines)
}

#[cfg(test)]
mod tests {
    use super::super::cases::cases;
    use super::*;

    #[test]
    fn exact_verdicts_are_of_the_cheapest_method() {
        let all = cases().unwrap();
        let case = |name: &str| all.iter().find(|c| c.name == name).unwrap();
        let curve = |cost: f64| vec![Work { off: Off { tension: 1e-2, place: None }, cost }];
        let of =
            |name, cost| line(case(name), &[("slow".into(), curve(2.0 * cost)), ("fast".into(), curve(cost))]).map(|l| l[2..].to_vec());
        let words = |all: [&str; 4]| Some(all.map(String::from).to_vec());
        assert_eq!(of("flume", case("flume").end / 500.0), words(["fast", "500", "500", "held"]));
        assert_eq!(of("overboard", case("overboard").end / 100.0), words(["fast", "100", "200", "NOT HELD"]));
        assert_eq!(of("p3", 1.0), None);
        assert_eq!(line(case("flume"), &[]).unwrap()[3..], ["", "500", "NOT HELD"].map(String::from));
    }
}
