//! Ours against other programs at equal true error: `cargo xtask bench --peers`.

use super::cases::Case;
use super::rival_runs::{PLANS, Plan, Program, Rivals};
use super::row::share;
use super::section::Section;
use super::track::{Off, Track};
use crate::plots::{Colour, PALETTE, Series};

/// What is asked for: ours at least so many times cheaper than the program, at the error of its finest run.
struct Target {
    case: &'static str,
    program: Program,
    times: f64,
    /// Errors that the program's finest run was found to have when the target was set: tension over its rms, and the place where it counts.
    error: f64,
    place: Option<f64>,
}

const TARGETS: [Target; 5] = [
    Target { case: "p1", program: Program::Exudyn, times: 100.0, error: 2e-3, place: Some(1e-4) },
    Target { case: "p3", program: Program::Exudyn, times: 40.0, error: 7e-3, place: None },
    Target { case: "p5", program: Program::MoorDyn, times: 100.0, error: 1.5e-3, place: None },
    Target { case: "p4a", program: Program::Exudyn, times: 6.0, error: 4e-5, place: None },
    Target { case: "p4b", program: Program::MoorDyn, times: 5.0, error: 6e-3, place: None },
];

/// A run of ours: error and CPU seconds.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// How wrong.
    pub off: Off,
    /// s.
    pub cost: f64,
}

/// A run of theirs, or why there is none.
pub struct RivalPoint {
    /// Which.
    pub plan: Plan,
    /// What came of it.
    pub work: Result<Work, String>,
    /// Ours at its error: method and mesh, and s.
    ours: Option<(String, f64)>,
}

impl RivalPoint {
    fn ratio(&self) -> Option<f64> {
        Some(self.work.as_ref().ok()?.cost / self.ours.as_ref()?.1)
    }
}

/// CPU seconds on a curve of runs, from the loosest tolerance to the tightest, at an error: between two runs on either side linear in the
/// logarithms; where every run is better the cheapest one. None where none is as good.
fn cost_at(curve: &[Work], error: f64, of: fn(&Off) -> Option<f64>) -> Option<f64> {
    let points: Vec<(f64, f64)> = curve.iter().filter_map(|w| Some((of(&w.off)?, w.cost))).collect();
    let good = points.iter().filter(|(e, _)| *e <= error).map(|(_, cost)| *cost);
    let between = points.windows(2).filter_map(|pair| {
        let [(e0, c0), (e1, c1)] = [pair[0], pair[1]];
        // Rounding aside, an exact run has no logarithm to interpolate.
        let inside = e0.max(e1) > error && e0.min(e1) <= error && e0.min(e1) > 0.0;
        inside.then(|| (c0.ln() + (error / e0).ln() / (e1 / e0).ln() * (c1 / c0).ln()).exp())
    });
    good.chain(between).min_by(f64::total_cmp)
}

/// The cheapest of our curves at an error: of tension, and of place where that counts too.
pub fn cheapest(curves: &[(String, Vec<Work>)], off: &Off, place: bool) -> Option<(String, f64)> {
    let costs = curves.iter().filter_map(|(method, curve)| {
        let tension = cost_at(curve, off.tension, |o| Some(o.tension))?;
        let both = match off.place.filter(|_| place) {
            Some(error) => tension.max(cost_at(curve, error, |o| o.place)?),
            None => tension,
        };
        Some((method.clone(), both))
    });
    costs.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Runs what there is of other programs for a case and holds it against our curves, one a method.
pub fn measure(rivals: &Rivals, case: &Case, truth: &Track, curves: &[(String, Vec<Work>)], repeats: usize, long: f64) -> Vec<RivalPoint> {
    // Samples as often as the truth's.
    let every = truth.times[1] - truth.times[0];
    let counts = TARGETS.iter().any(|t| t.case == case.name && t.place.is_some());
    let mut points = Vec::new();
    for plan in PLANS.into_iter().filter(|plan| plan.case == case.name) {
        let work = rivals
            .run(&plan, every, case.end, repeats, long)
            .and_then(|(track, cost)| Ok(Work { off: track.off(truth, case.from)?, cost }))
            .map_err(|e| e.to_string());
        let ours = work.as_ref().ok().and_then(|w| cheapest(curves, &w.off, counts));
        let what = match &work {
            Ok(w) => format!(
                "error {:.1e}{}  {:8.1} ms  {:6.1} x real time",
                w.off.tension,
                w.off.place.map_or(String::new(), |p| format!(", place {p:.1e}")),
                1e3 * w.cost,
                case.end / w.cost
            ),
            Err(e) => format!("left out: {e}"),
        };
        let point = RivalPoint { plan, work, ours };
        let ratio = point.ratio().map_or(String::new(), |r| format!("  ours {r:.1} times cheaper"));
        println!("{:6} {:8} {}  {what}{ratio}", case.name, plan.program.name(), plan.mesh());
        points.push(point);
    }
    points
}

/// Their lines in a case's chart.
pub fn series(case: &Case, points: &[RivalPoint]) -> Vec<Series> {
    const COLOURS: [Colour; 2] = [PALETTE[4], PALETTE[5]];
    let line = |(k, program): (usize, &Program)| {
        let works = points.iter().filter(|p| p.plan.program == *program).filter_map(|p| p.work.as_ref().ok());
        let points: Vec<_> = works.map(|w| (w.off.tension.log10(), (case.end / w.cost).log10())).collect();
        (!points.is_empty()).then(|| Series { points, ..Series::new(program.name(), &[], &[], COLOURS[k]) }.dashed())
    };
    Program::ALL.iter().enumerate().filter_map(line).collect()
}

/// Their rows in a case's table: program, mesh and step, tension error, place error, ms, times real time, and nothing for sub-steps.
pub fn rows(case: &Case, points: &[RivalPoint]) -> Vec<Vec<String>> {
    let row = |p: &RivalPoint| {
        let mut cells = vec![p.plan.program.name().to_owned(), p.plan.mesh()];
        cells.extend(match &p.work {
            Ok(w) => vec![share(w.off.tension), place(w.off.place), format!("{:.1}", 1e3 * w.cost), format!("{:.1}", case.end / w.cost)],
            Err(e) => vec![format!("left out: {e}"), String::new(), String::new(), String::new()],
        });
        cells.push(String::new());
        cells
    };
    points.iter().map(row).collect()
}

/// An error of place for a table.
pub fn place(error: Option<f64>) -> String {
    error.map_or(String::new(), |p| format!("{p:.1e}"))
}

/// The program's run that the target speaks of: its finest.
fn finest<'a>(target: &Target, points: &'a [RivalPoint]) -> Option<&'a RivalPoint> {
    points.iter().rfind(|p| p.plan.case == target.case && p.plan.program == target.program)
}

/// The section with all ratios and what was asked for; the second says how many targets are held of how many measured.
pub fn section(points: &[RivalPoint]) -> (Section, [usize; 2]) {
    let mut held = [0; 2];
    let rows = points.iter().map(|p| {
        let target = TARGETS.iter().find(|t| finest(t, points).is_some_and(|f| std::ptr::eq(f, p)));
        let asked = target.map_or(String::new(), |t| {
            let place = t.place.map_or(String::new(), |p| format!(", {p:.0e}"));
            format!("{}, at {}{place}", t.times, share(t.error))
        });
        let verdict = match (target, p.ratio()) {
            (Some(t), Some(ratio)) => {
                held[1] += 1;
                held[0] += usize::from(ratio >= t.times);
                if ratio >= t.times { "held" } else { "NOT HELD" }
            }
            (Some(_), None) => "not measured",
            (None, _) => "",
        };
        let (errors, cost) = match &p.work {
            Ok(w) => ([share(w.off.tension), place(w.off.place)], format!("{:.1}", 1e3 * w.cost)),
            Err(e) => ([format!("left out: {e}"), String::new()], String::new()),
        };
        let ours = match (&p.ours, &p.work) {
            (Some((method, cost)), _) => format!("{:.2}, {method}", 1e3 * cost),
            (None, Ok(_)) => "none as good".to_owned(),
            (None, Err(_)) => String::new(),
        };
        let [tension, place] = errors;
        let ratio = p.ratio().map_or(String::new(), |r| format!("{r:.1}"));
        let program = p.plan.program.name().to_owned();
        vec![p.plan.case.to_uppercase(), program, p.plan.mesh(), tension, place, cost, ours, ratio, asked, verdict.to_owned()]
    });
    let rows = rows.collect();
    let header = [
        "Scene",
        "Program",
        "Mesh, step",
        "Tension error",
        "Place error",
        "Its run, ms",
        "Ours at its error, ms",
        "Times cheaper",
        "Asked for",
        "",
    ];
    let text = "Exudyn 1.13.6 and MoorDyn 2.7.2 on the same scenes, in the same run on the same machine; CPU seconds of the solver call alone, \
                theirs and ours. \u{201c}Ours at its error\u{201d} lies on the cheapest of our curves below, one a method and mesh, between two tolerances by \
                logarithms; where our coarsest run is better than theirs it is that run, so the ratio is a lower bound. In P1 both the tension \
                and the wrap angle must be as good. The place is the body's in m, in P1 the wrap angle in rad. Their drivers are in \
                fmu-tests/peers; Exudyn runs in P1 with twelve contact segments an element, the most it takes; MoorDyn's steps in P5 are the \
                greatest of a round number that stay stable.";
    (Section::new("Against other programs").text(text).table(&header, rows), held)
}

/// Numbers for peers.csv: case and program by their places in `cases` and [`Program::ALL`], elements, step, errors (NaN for none), s.
pub fn numbers(points: &[RivalPoint], cases: &[&str]) -> [Vec<f64>; 7] {
    let mut columns: [Vec<f64>; 7] = Default::default();
    for p in points {
        let Ok(w) = &p.work else { continue };
        let case = cases.iter().position(|name| *name == p.plan.case).unwrap_or_default();
        let program = Program::ALL.iter().position(|program| *program == p.plan.program).unwrap_or_default();
        let row =
            [case as f64, program as f64, f64::from(p.plan.elements), p.plan.step, w.off.tension, w.off.place.unwrap_or(f64::NAN), w.cost];
        columns.iter_mut().zip(row).for_each(|(column, x)| column.push(x));
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(tension: f64, place: f64, cost: f64) -> Work {
        Work { off: Off { tension, place: Some(place) }, cost }
    }

    #[test]
    fn exact_cost_at_an_error() {
        // Error down by 100 for a cost up by 10: at a tenth of the first error √10 of its cost.
        let curve = [work(1e-2, 1.0, 1.0), work(1e-4, 1e-3, 10.0), work(1e-4, 1e-3, 40.0)];
        let at = |e| cost_at(&curve, e, |o| Some(o.tension));
        assert!((at(1e-3).unwrap() - 10f64.sqrt()).abs() < 1e-12); // rounding
        // Better than asked: the cheapest. As good as a run: that run. Worse than all: none.
        assert_eq!((at(0.5), at(1e-2), at(1e-4), at(1e-5)), (Some(1.0), Some(1.0), Some(10.0), None));
        assert_eq!(cost_at(&[], 1.0, |o| o.place), None);
    }

    #[test]
    fn exact_the_dearer_of_two_errors_counts() {
        let curves =
            [("a".to_owned(), vec![work(1e-2, 1.0, 1.0), work(1e-4, 1e-4, 100.0)]), ("b".to_owned(), vec![work(1e-3, 1e-5, 50.0)])];
        let off = Off { tension: 1e-2, place: Some(1e-2) };
        assert_eq!(cheapest(&curves, &off, false), Some(("a".to_owned(), 1.0)));
        // By the place, a costs 10 and b 50.
        let (method, cost) = cheapest(&curves, &off, true).unwrap();
        assert!(method == "a" && (cost - 10.0).abs() < 1e-12, "{method} {cost}"); // rounding
        assert_eq!(cheapest(&curves, &Off { tension: 1e-2, place: Some(2e-5) }, true), Some(("b".to_owned(), 50.0)));
        assert_eq!(cheapest(&curves, &Off { tension: 1e-9, place: None }, true), None);
    }

    #[test]
    fn exact_verdicts_go_by_the_finest_run() {
        let point = |elements, cost, ours: Option<f64>| RivalPoint {
            plan: Plan { program: Program::MoorDyn, case: "p4b", elements, step: 1e-3 },
            work: Ok(work(6e-3, 1.0, cost)),
            ours: ours.map(|cost| ("rodas4".to_owned(), cost)),
        };
        let (section, held) = section(&[point(10, 1.0, Some(1.0)), point(20, 6.0, Some(1.0))]);
        assert_eq!(held, [1, 1]);
        let super::super::section::Block::Table(header, rows) = &section.blocks[1] else { panic!("a table") };
        assert_eq!((header.len(), rows[0].len()), (10, 10));
        assert_eq!(rows[0][7..], ["1.0", "", ""].map(String::from));
        assert_eq!(rows[1][7..], ["6.0", "5, at 0.60 %", "held"].map(String::from));
        assert_eq!(super::section(&[point(20, 4.0, Some(1.0))]).1, [0, 1]);
        assert_eq!(super::section(&[point(20, 4.0, None)]).1, [0, 0]);
    }
}
