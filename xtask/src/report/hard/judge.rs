//! A case's runs, what they say, and the table.

use super::case::{Case, Claim, Ends, Measure, Quantity};
use super::run::{Run, run};
use crate::error::Result;
use crate::plots::{Chart, PALETTE, Panel, SOFT, Series};
use crate::report::bench::{Bench, side_by_side};
use crate::report::numerics::{pairs, relative_rms};
use crate::report::row::{Row, Truth, Verdict, figure, share};
use crate::report::scene::Scene;
use crate::report::section::Section;

/// The runs of a case.
pub struct Findings {
    /// The case.
    pub case: Case,
    /// As shipped.
    pub shipped: Run,
    /// With half the tolerance.
    pub tighter: Option<Run>,
    /// With twice the elements.
    pub finer: Option<Run>,
    /// Of [`Case::others`].
    pub others: Vec<Run>,
}

/// Used where a scene says nothing.
const TOLERANCE: f64 = 1e-3;

/// The scene with twice the elements everywhere.
fn refined(scene: &Scene) -> Scene {
    match scene.number("mesh.elements") {
        Some(n) => scene.clone().elements(2 * n as usize),
        None => scene.clone().refined(2.0),
    }
}

fn examine(bench: &Bench, case: Case) -> Result<Findings> {
    let fmu = bench.pack(&case.scene)?;
    let shipped = run(&fmu, &case, &[], case.momentum.is_some())?;
    let tolerance = case.scene.number("solver.tolerance").unwrap_or(TOLERANCE);
    let tighter = Some(run(&fmu, &case, &[("solver.tolerance", 0.5 * tolerance)], false)?);
    let finer = Some(run(&bench.pack(&refined(&case.scene))?, &case, &[], false)?);
    let others = case.others.iter().map(|(_, scene)| run(&bench.pack(scene)?, &case, &[], false)).collect::<Result<_>>()?;
    Ok(Findings { case, shipped, tighter, finer, others })
}

/// All cases, on two threads; one that does not run is a miss by its name.
pub fn examine_all(bench: &Bench, cases: Vec<Case>) -> Vec<std::result::Result<Findings, Row>> {
    let cases: Vec<_> = cases.into_iter().map(|case| std::sync::Mutex::new(Some(case))).collect();
    side_by_side(&cases, |slot| {
        let case = slot.lock().unwrap_or_else(std::sync::PoisonError::into_inner).take();
        let Some(case) = case else { return Err(Row::failed(Truth::Own, "a case", "taken twice")) };
        let name = case.name.clone();
        let found = examine(bench, case).map_err(|e| Row::failed(Truth::Own, name, e));
        if let Ok(f) = &found {
            eprintln!("{}", f.line());
        }
        found
    })
}

impl Quantity {
    /// The figure of a run; NaN for a signal as a whole.
    pub fn value(&self, run: &Run) -> f64 {
        match &self.measure {
            Measure::Value(of) => of(run),
            Measure::Signal(_) => f64::NAN,
        }
    }

    /// How far another run is from the shipped one, and the claim, both in the same measure.
    pub fn change(&self, shipped: &Run, other: &Run) -> (f64, f64) {
        match (&self.measure, self.claim) {
            (Measure::Signal(name), Claim::Share(c) | Claim::Amount(c)) => (relative_rms(&pairs(other.of(name), shipped.of(name))), c),
            (Measure::Value(of), Claim::Share(c)) => ((of(other) / of(shipped) - 1.0).abs(), c),
            (Measure::Value(of), Claim::Amount(c)) => ((of(other) - of(shipped)).abs(), c),
        }
    }

    /// A change or claim as text.
    fn off(&self, x: f64) -> String {
        match self.claim {
            _ if x.is_nan() => "none".into(),
            Claim::Share(_) => share(x),
            Claim::Amount(_) => format!("{} {}", figure(format!("{x:.1e}").parse().unwrap_or(x)), self.unit),
        }
    }
}

impl Findings {
    /// Ended as it must: the words of the message, or the last communication point.
    fn ended(&self, run: &Run) -> bool {
        match (self.case.ends, &run.stopped) {
            (Ends::Completes, None) => true,
            (Ends::Stops(words), Some((_, message))) => run.status == 2.0 && message.contains(words),
            _ => false,
        }
    }

    fn refinements(&self) -> impl Iterator<Item = (&'static str, &Run)> {
        let own = [("half the tolerance", &self.tighter), ("twice the elements", &self.finer)];
        let others = self.case.others.iter().map(|(label, _)| *label).zip(&self.others);
        own.into_iter().filter_map(|(label, run)| Some((label, run.as_ref()?))).chain(others)
    }

    /// The verdicts: how it ends, energy, momentum, each figure under each refinement and against its truth.
    pub fn rows(&self) -> Vec<Row> {
        let name = &self.case.name;
        let wrong = std::iter::once(("as shipped", &self.shipped)).chain(self.refinements()).find(|(_, run)| !self.ended(run));
        let wanted = match self.case.ends {
            Ends::Completes => "completes".to_owned(),
            Ends::Stops(words) => format!("a step is refused with \u{201c}{words}\u{201d}, status 2, outputs as before"),
        };
        let mut rows = vec![match wrong {
            None => Row::error(Truth::Own, format!("{name}: ends as documented"), 0.0, "").within(0.0).because(wanted),
            Some((label, run)) => {
                let message = run.stopped.as_ref().map_or(String::new(), |(_, m)| format!(": {m}"));
                Row::failed(
                    Truth::Own,
                    format!("{name}: ends as documented"),
                    format!("expected: {wanted}; {label} it {}{message}", run.end()),
                )
            }
        }];
        if self.shipped.stopped.is_none() {
            rows.push(
                Row::error(Truth::Exact, format!("{name}: energy error"), self.shipped.energy_error, "")
                    .within(self.case.energy)
                    .because("work and energy, over the work done"),
            );
        }
        if let Some((found, bound)) = self.shipped.momentum.zip(self.case.momentum) {
            rows.push(Row::error(Truth::Exact, format!("{name}: momentum defect"), found, "").within(bound).because(
                "forces on the supports and weight, integrated over the communication points, against the momentum of points and body",
            ));
        }
        for q in &self.case.quantities {
            for (label, run) in self.refinements() {
                let (change, claim) = q.change(&self.shipped, run);
                let unit = if matches!(q.claim, Claim::Share(_)) { "" } else { q.unit };
                rows.push(
                    Row::error(Truth::Own, format!("{name}: {} against {label}", q.what), change, unit)
                        .within(claim)
                        .because("the error claimed for the figure"),
                );
            }
            if let Some((truth, within, source)) = q.truth {
                let kind = if source.contains("closed form") { Truth::Exact } else { Truth::Cross };
                rows.push(
                    Row::relative(kind, format!("{name}: {}", q.what), q.value(&self.shipped), truth, q.unit)
                        .within(within)
                        .because(source),
                );
            }
        }
        rows
    }

    /// Lines of the table: one a figure, the first of them with what is said of the case as a whole.
    fn lines(&self, rows: &[Row]) -> Vec<Vec<String>> {
        let run = &self.shipped;
        let [steps, rejected, solves] = run.counts;
        let peers = if self.case.peers.is_empty() { String::new() } else { format!(" Others: {}", self.case.peers) };
        let energy = if run.stopped.is_some() { String::new() } else { format!("{:.1e}", run.energy_error) };
        let momentum = run.momentum.map_or(String::new(), |m| format!("\n{m:.1e}"));
        let mut facts = vec![
            format!("{}\n{}{peers}", self.case.name, self.case.happens),
            run.end() + &run.stopped.as_ref().map_or(String::new(), |(_, m)| format!("\n{}", brief(m))),
            format!("{energy}{momentum}"),
            format!("{steps} ({rejected})\n{solves}"),
        ];
        let figures: Vec<String> = self.case.quantities.iter().map(|q| format!("{}: {}", self.case.name, q.what)).collect();
        let verdict = |mine: &dyn Fn(&Row) -> bool| {
            let missed = rows.iter().any(|r| mine(r) && r.verdict() == Verdict::Missed);
            if missed { "MISSED" } else { "holds" }.to_owned()
        };
        let whole = |row: &Row| !figures.iter().any(|f| row.what.starts_with(f.as_str()));
        let mut lines = Vec::new();
        for (q, figure_name) in self.case.quantities.iter().zip(&figures) {
            let value = q.value(run);
            let other = |run: &Option<Run>| run.as_ref().map_or(String::new(), |run| q.off(q.change(&self.shipped, run).0));
            let (Claim::Share(claim) | Claim::Amount(claim)) = q.claim;
            let text = if value.is_nan() { String::new() } else { format!("{} {}", figure(value), q.unit) };
            let first = lines.is_empty();
            facts.extend([
                q.what.to_owned(),
                format!("{}\n\u{b1} {}", text.trim(), q.off(claim)),
                format!("{}\n{}", other(&self.tighter), other(&self.finer)),
                verdict(&|row| row.what.starts_with(figure_name.as_str()) || first && whole(row)),
            ]);
            lines.push(std::mem::replace(&mut facts, vec![String::new(); 4]));
        }
        if lines.is_empty() {
            facts.extend([String::new(), String::new(), String::new(), verdict(&|_| true)]);
            lines.push(facts);
        }
        lines
    }

    /// One line for the terminal.
    fn line(&self) -> String {
        let figures: Vec<String> = self
            .case
            .quantities
            .iter()
            .map(|q| {
                let changes: Vec<String> = self.refinements().map(|(_, run)| q.off(q.change(&self.shipped, run).0)).collect();
                format!("{} {} ({})", q.what, figure(q.value(&self.shipped)), changes.join(", "))
            })
            .collect();
        let seconds: f64 = self.refinements().map(|(_, run)| run.seconds).sum::<f64>() + self.shipped.seconds;
        let message = self.shipped.stopped.as_ref().map_or("", |(_, m)| m);
        format!(
            "    {}: {}; energy {:.1e}; momentum {}; steps {:?}; {}; {seconds:.1} s {message}",
            self.case.name,
            self.shipped.end(),
            self.shipped.energy_error,
            self.shipped.momentum.map_or("-".into(), |m| format!("{m:.1e}")),
            self.shipped.counts,
            figures.join("; "),
        )
    }

    /// The signal of the shipped run and, thin, of the finer mesh.
    fn chart(&self) -> (String, Chart) {
        let (name, label, factor) = self.case.draw;
        let series = |label: &str, run: &Run, colour| {
            let y: Vec<f64> = run.of(name).iter().map(|v| v * factor).collect();
            let (x, y) = outline(&run.times, &y);
            Series::new(label, &x, &y, colour)
        };
        let mut lines: Vec<Series> = self.finer.iter().map(|run| series("twice the elements", run, SOFT).width(2.4)).collect();
        lines.push(series("as shipped", &self.shipped, PALETTE[0]));
        let chart = Chart::new(&self.case.name, "Time, s", vec![Panel::new(label, lines).height(150.0)]);
        (slug(&self.case.name), Chart { width: 520.0, ..chart })
    }
}

/// Most columns of pixels of a small chart.
const COLUMNS: usize = 300;

/// A line of many points as the least and greatest of each column of pixels, in their order.
fn outline(x: &[f64], y: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let size = x.len().div_ceil(COLUMNS);
    if size <= 2 {
        return (x.to_vec(), y.to_vec());
    }
    let mut thin = (Vec::new(), Vec::new());
    for (x, y) in x.chunks(size).zip(y.chunks(size)) {
        let by = |better: fn(f64, f64) -> bool| (0..y.len()).fold(0, |best, i| if better(y[i], y[best]) { i } else { best });
        let (low, high) = (by(|a, b| a < b), by(|a, b| a > b));
        for i in [low.min(high), low.max(high)] {
            thin.0.push(x[i]);
            thin.1.push(y[i]);
        }
    }
    thin
}

/// A file's name.
fn slug(name: &str) -> String {
    let plain: String = name.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' }).collect();
    plain.split_whitespace().collect::<Vec<_>>().join("-")
}

const HEADER: [&str; 8] = [
    "Case, what happens",
    "Ends",
    "Energy error, momentum defect",
    "Sub-steps (rejected), solves",
    "Figure",
    "Value, error claimed",
    "Moved by half the tolerance, by twice the elements",
    "Verdict",
];

/// The message of a refused step up to its advice.
fn brief(message: &str) -> &str {
    message.split(" Try: ").next().unwrap_or(message)
}

/// A section: its table, then a small chart a case.
pub fn section(title: &str, text: &str, found: Vec<std::result::Result<Findings, Row>>) -> Section {
    let (mut lines, mut rows, mut charts) = (Vec::new(), Vec::new(), Vec::new());
    for findings in found {
        match findings {
            Ok(findings) => {
                let own = findings.rows();
                lines.extend(findings.lines(&own));
                rows.extend(own);
                charts.push(findings.chart());
            }
            Err(row) => {
                let mut line = vec![format!("{}\n{}", row.what, row.source)];
                line.resize(HEADER.len() - 1, String::new());
                line.push("MISSED".into());
                lines.push(line);
                rows.push(row);
            }
        }
    }
    Section::new(title).text(text).case_table(&HEADER, lines).counted(rows).gallery(charts)
}
