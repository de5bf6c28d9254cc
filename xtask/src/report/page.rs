//! The report as files: index.html, its charts and tables of numbers, summary.csv; and the verdicts for the terminal.

use super::must_hold::{LINES, worst};
use super::row::{Row, Verdict};
use super::section::{Block, Section};
use crate::error::Result;
use crate::html_report::Page;
use crate::results::{publish, save};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

const HEADER: [&str; 7] = ["What, source, why this bound", "Truth", "Ours", "Reference", "Off by", "Bound", "Verdict"];

/// Writes the folder anew; what was there before is gone only when the new one is whole.
///
/// # Errors
/// Files that cannot be written.
pub fn write(sections: &[Section], folder: &Path) -> Result<()> {
    publish(folder, |folder| {
        save(&folder.join("summary.csv"), &summary(sections))?;
        files(sections, folder)?;
        save(&folder.join("index.html"), &page(sections))
    })
}

/// Writes the folder of the hard cases anew.
///
/// # Errors
/// Files that cannot be written.
pub fn write_hard(sections: &[Section], folder: &Path) -> Result<()> {
    let mut page = Page::new("fairlead: hard cases").wide();
    page.paragraph(
        "Cases that are known to break cable programs, each a packed FMU driven through its FMI 2.0 C interface by \u{201c}cargo xtask report \
         --only hard\u{201d}, which wrote this page; repeating the command gives the same numbers. Every case runs three times: as shipped, with \
         half the solver's tolerance, and with twice the elements. A figure's claimed error must cover what either changes. A case must complete \
         with an energy error below 1e-3 of the work done, or stop with a refused step, status 2 and all outputs as they were before. No output \
         may ever be other than a finite number.",
    );
    page.paragraph(
        "Energy error: the FMU's own solver.energy_error at the end, work and energy over the work done. Momentum defect, for cables in vacuum: \
         weight and the forces on all supports, integrated over the communication points, against the momentum that the drawn points and the \
         body show, over the greatest; it comes from outputs alone, and is of second order in the communication step. Solves are linear solves. \
         Charts: blue as shipped, grey beneath it with twice the elements.",
    );
    let count = |verdict: Verdict| sections.iter().flat_map(Section::figures).filter(|row| row.verdict() == verdict).count().to_string();
    page.tiles(&[(count(Verdict::Holds), "figures within their bound"), (count(Verdict::Missed), "outside")]);
    body(&mut page, sections);
    publish(folder, |folder| {
        save(&folder.join("summary.csv"), &summary(sections))?;
        files(sections, folder)?;
        save(&folder.join("index.html"), &page.html())
    })
}

/// Writes the folder of `cargo xtask bench` anew: the page with the machine's name, charts, and all numbers in work.csv.
///
/// # Errors
/// Files that cannot be written.
pub fn write_speed(sections: &[Section], machine: &str, peers: bool, numbers: &str, folder: &Path) -> Result<()> {
    let mut page = Page::new("fairlead: speed against error").wide();
    page.paragraph(&format!(
        "Written by \u{201c}cargo xtask bench\u{201d} on {machine}. Each packed scene was run by every time integrator at tolerances from \
         3e-2 to 1e-4 on one thread; the time is the processor's in the communication loop (inputs, step, outputs), the least of three runs where \
         they are short. Times are this machine's and good to a third; sub-steps and errors are exact. {} All numbers are in work.csv.",
        if peers {
            "Other programs ran on the same scenes in between."
        } else {
            "Other programs were not run for this page, so their curves are left out; \u{201c}cargo xtask bench --peers\u{201d} runs them. What \
             was measured of them elsewhere stands in the report."
        }
    ));
    body(&mut page, sections);
    publish(folder, |folder| {
        save(&folder.join("work.csv"), numbers)?;
        files(sections, folder)?;
        save(&folder.join("index.html"), &page.html())
    })
}

/// Writes the folder of `cargo xtask bench --pace` anew.
///
/// # Errors
/// Files that cannot be written.
pub fn write_pace(sections: &[Section], machine: &str, folder: &Path) -> Result<()> {
    let mut page = Page::new("fairlead: the pace of communication steps").wide();
    page.paragraph(&format!(
        "Written by \u{201c}cargo xtask bench --pace\u{201d} on {machine}: how long each step takes, for controllers in the loop."
    ));
    body(&mut page, sections);
    publish(folder, |folder| {
        files(sections, folder)?;
        save(&folder.join("index.html"), &page.html())
    })
}

/// Charts and tables of numbers.
fn files(sections: &[Section], folder: &Path) -> Result<()> {
    for block in sections.iter().flat_map(|s| &s.blocks) {
        match block {
            Block::Chart(file, chart, _) => save(&folder.join(format!("{file}.svg")), &chart.svg())?,
            Block::Gallery(charts) => {
                charts.iter().try_for_each(|(file, chart)| save(&folder.join(format!("{file}.svg")), &chart.svg()))?
            }
            Block::Csv(file, text, _) => save(&folder.join(format!("{file}.csv")), text)?,
            _ => {}
        }
    }
    Ok(())
}

fn page(sections: &[Section]) -> String {
    let mut page = Page::new("fairlead held against closed forms, measurements and other programs").wide();
    page.paragraph(
        "The figures on this page were computed by packed FMUs (but for the tangent of contact, which FMI cannot see), driven through their FMI 2.0 C interface by \u{201c}cargo xtask report\u{201d}, \
         which wrote the page; repeating the command gives the same numbers. Truths: \u{201c}exact\u{201d} is a closed form or a conservation \
         law, \u{201c}paper\u{201d} a published measurement or result, \u{201c}cross\u{201d} another program. The thesis is C. Westin, Modelling \
         and Simulation of Marine Cables with Dynamic Winch and Sheave Contact, Carleton University, 2018. All figures are in summary.csv.",
    );
    let count = |verdict: Verdict| sections.iter().flat_map(Section::figures).filter(|row| row.verdict() == verdict).count().to_string();
    page.tiles(&[
        (count(Verdict::Holds), "figures within their bound"),
        (count(Verdict::Missed), "outside"),
        (count(Verdict::Shown), "shown beside a reference, without a bound"),
        (count(Verdict::Absent), "not there yet"),
    ]);
    page.heading("What must hold");
    page.paragraph(
        "Of the figures that belong to a line the one that uses most of its bound is shown; all of them are in the sections below.",
    );
    page.figure_table(&["Line, and its worst figure", "Ours", "Reference", "Off by", "Bound", "Verdict"], &must_hold(sections));
    page.paragraph(
        "Left out: higher modes, which the Rust tests hold by the eigenvalues of the linearized system (fmu-tests/rust/dynamics.rs); and the \
         thesis's records over time, of which its text gives ranges only. Speed against error is the matter of \u{201c}cargo xtask bench\u{201d} \
         (fmu-tests/bench).",
    );
    page.file(
        "hard/index.html",
        "hard cases: slack and snap, lift-off, whips, extreme numbers, rough masters; the folded falling chain is there too",
    );
    body(&mut page, sections);
    page.html()
}

/// Contents and sections.
fn body(page: &mut Page, sections: &[Section]) {
    page.heading("Contents").list(&sections.iter().map(|s| (anchor(&s.title), s.title.clone())).collect::<Vec<_>>());
    for section in sections {
        page.anchored_heading(&anchor(&section.title), &section.title);
        for block in &section.blocks {
            match block {
                Block::Text(text) => page.paragraph(text),
                Block::Table(header, rows) => page.wide_table(&header.iter().map(String::as_str).collect::<Vec<_>>(), rows),
                Block::Rows(rows) => page.figure_table(&HEADER, &figures(rows)),
                Block::Cases(header, rows) => page.figure_table(&header.iter().map(String::as_str).collect::<Vec<_>>(), rows),
                Block::Counted(_) => page,
                Block::Chart(file, chart, caption) => page.image(&format!("{file}.svg"), &chart.title, caption),
                Block::Gallery(charts) => {
                    page.gallery(&charts.iter().map(|(file, chart)| (format!("{file}.svg"), chart.title.clone())).collect::<Vec<_>>())
                }
                Block::Csv(file, _, what) => page.file(&format!("{file}.csv"), what),
            };
        }
    }
}

/// The table of a section's figures. A source that is the same as that of the row above is not repeated.
fn figures(rows: &[Row]) -> Vec<Vec<String>> {
    let line = |(i, row): (usize, &Row)| {
        let [measured, reference, error, bound] = row.cells();
        let known = i > 0 && rows[i - 1].source == row.source;
        let what = if known || row.source.is_empty() { row.what.clone() } else { format!("{}\n{}", row.what, row.source) };
        vec![what, row.truth.word().to_owned(), measured, reference, error, bound, row.verdict().word().to_owned()]
    };
    rows.iter().enumerate().map(line).collect()
}

/// The lines of [`must_hold`](super::must_hold) whose figures the sections hold.
fn must_hold(sections: &[Section]) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for (must, line) in LINES {
        let Some((row, count)) = worst(must, sections.iter().flat_map(Section::figures)) else { continue };
        let [measured, reference, error, bound] = row.cells();
        let worst = if count > 1 { format!("worst of {count}: {}", row.what) } else { row.what.clone() };
        let what = if row.measured.is_nan() { format!("{line}\n{worst}: {}", row.source) } else { format!("{line}\n{worst}") };
        rows.push(vec![what, measured, reference, error, bound, row.verdict().word().to_owned()]);
    }
    rows
}

/// A fragment identifier.
fn anchor(title: &str) -> String {
    let plain: String = title.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' }).collect();
    plain.split_whitespace().collect::<Vec<_>>().join("-")
}

/// Every figure, one a line.
fn summary(sections: &[Section]) -> String {
    let mut text = String::from("section,what,truth,measured,reference,unit,error,error_is,bound,verdict,source\n");
    let quoted = |t: &str| format!("\"{}\"", t.replace('"', "'"));
    let number = |x: f64| if x.is_nan() { String::new() } else { format!("{:?}", format!("{x:.9e}").parse::<f64>().unwrap_or(x)) };
    for section in sections {
        for row in section.figures() {
            let kind = if row.relative { "share of reference" } else { "amount" };
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{kind},{},{},{}",
                quoted(&section.title),
                quoted(&row.what),
                row.truth.word(),
                number(row.measured),
                number(row.reference),
                row.unit,
                number(row.error),
                row.bound.map_or(String::new(), number),
                row.verdict().word(),
                quoted(&row.source)
            );
        }
    }
    text
}

/// The verdicts as text: the lines that must hold, then every figure with a bound.
pub fn verdicts(sections: &[Section]) -> String {
    let mut text = String::new();
    let mut line = |verdict: &str, what: &str, cells: &[String]| {
        let [measured, reference, error, bound] = cells else { return };
        let parts = [(measured, ""), (reference, "reference "), (error, "off by "), (bound, "bound ")];
        let parts: Vec<String> = parts.iter().filter(|(cell, _)| !cell.is_empty()).map(|(cell, name)| format!("{name}{cell}")).collect();
        let _ = writeln!(text, "{verdict:7} {what}: {}", parts.join(", "));
    };
    for section in sections {
        for row in section.figures() {
            line(row.verdict().word(), &format!("[{}] {}", section.title, row.what), &row.cells());
        }
    }
    for row in must_hold(sections) {
        line(&row[5], &format!("MUST {}", row[0].replace('\n', " | ")), &row[1..5]);
    }
    // Failed runs say why.
    let reasons: BTreeSet<&str> = sections
        .iter()
        .flat_map(Section::figures)
        .filter(|row| row.verdict() == Verdict::Missed && row.measured.is_nan())
        .map(|r| r.source.as_str())
        .collect();
    for reason in reasons {
        let _ = writeln!(text, "        {reason}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::row::Truth;
    use super::*;

    #[test]
    fn exact_page_and_summary_say_the_same() {
        let rows = vec![
            Row::relative(Truth::Exact, "period, \"s\"", 2.02, 2.0, "s").within(0.02),
            Row::error(Truth::Cross, "rms", 0.5, "m").within(0.1),
            Row::absent(Truth::Paper, "scene", "not yet"),
        ];
        let sections = [Section::new("One & two").text("words").rows(rows).csv("numbers", "a,b", &[&[1.0, 2.0], &[3.0, 4.25]], "what")];
        let html = page(&sections);
        let csv = summary(&sections);
        for word in ["holds", "MISSED", "absent"] {
            assert!(html.contains(&format!(">{word}</td>")) && csv.contains(&format!(",{word},")), "{word}");
        }
        assert!(html.contains("id=\"one-two\"") && html.contains("href=\"numbers.csv\""));
        assert_eq!(csv.lines().count(), 4);
        assert!(verdicts(&sections).contains("MISSED  [One & two] rms: off by 0.5 m, bound 0.1 m"));
        let folder = tempfile::tempdir().unwrap();
        write(&sections, &folder.path().join("report")).unwrap();
        assert_eq!(std::fs::read_to_string(folder.path().join("report/numbers.csv")).unwrap(), "a,b\n1.0,3.0\n2.0,4.25\n");
    }

    /// The committed report belongs together: page and summary tell the same verdicts, every file is there and small.
    #[test]
    fn frozen_the_committed_report_is_whole() {
        let folder = crate::package::root().join("fmu-tests/report");
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
        let (html, csv) = (read("index.html"), read("summary.csv"));
        let in_csv = |word: &str| csv.lines().filter(|line| line.contains(&format!(",{word},"))).count();
        for (word, meaning) in [("holds", "figures within"), ("MISSED", "outside"), ("shown", "shown beside"), ("absent", "not there yet")]
        {
            assert!(html.contains(&format!("<b>{}</b><span>{meaning}", in_csv(word))), "{word}: {}", in_csv(word));
        }
        assert_eq!(in_csv("MISSED"), 0, "a report with misses is to be explained, not committed");
        let mut linked = 0;
        for link in html.split(['"']).filter(|part| part.ends_with(".svg") || part.ends_with(".csv")) {
            assert!(folder.join(link).is_file(), "{link}");
            linked += 1;
        }
        assert!(linked > 20, "{linked}");
        let sizes: Vec<u64> = std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().metadata().unwrap().len()).collect();
        assert!(sizes.iter().all(|size| *size < 500_000) && sizes.iter().sum::<u64>() < 3_000_000, "{sizes:?}");
    }

    /// The same of the hard cases.
    #[test]
    fn frozen_the_committed_hard_cases_are_whole() {
        let folder = crate::package::root().join("fmu-tests/report/hard");
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
        let (html, csv) = (read("index.html"), read("summary.csv"));
        for (word, meaning) in [("holds", "figures within"), ("MISSED", "outside")] {
            let in_csv = csv.lines().filter(|line| line.contains(&format!(",{word},"))).count();
            assert!(html.contains(&format!("<b>{in_csv}</b><span>{meaning}")), "{word}: {in_csv}");
        }
        let linked = html.split(['"']).filter(|part| part.ends_with(".svg") && folder.join(part).is_file()).count();
        assert!(linked > 30, "{linked}");
        let sizes: Vec<u64> = std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().metadata().unwrap().len()).collect();
        assert!(sizes.iter().all(|size| *size < 500_000) && sizes.iter().sum::<u64>() < 2_000_000, "{sizes:?}");
    }
}
