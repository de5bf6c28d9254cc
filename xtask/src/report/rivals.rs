//! Ours against other programs at equal true error: `cargo xtask bench --peers`.

use super::cases::Case;
use super::rival_runs::{PLANS, Plan, Program, Rivals};
use super::row::share;
use super::section::Section;
use super::track::{Off, Track};
use crate::plots::{Colour, PALETTE, Series};

/// A run's error and CPU seconds.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// How wrong.
    pub off: Off,
    /// s.
    pub cost: f64,
}

/// A run of ours.
#[derive(Clone, Copy, Debug)]
pub struct OwnRun {
    /// `solver.method`.
    pub method: &'static str,
    /// Mesh.
    pub elements: usize,
    /// `solver.tolerance`.
    pub tolerance: f64,
    /// What came of it.
    pub work: Work,
    /// The solver's sub-steps.
    pub sub_steps: f64,
}

impl OwnRun {
    /// Method, mesh and tolerance in words.
    pub fn name(&self) -> String {
        format!("{}, {}", self.method, self.mesh_and_tolerance())
    }

    /// A mesh that is graded for an error has no number of elements in its scene.
    pub fn mesh_and_tolerance(&self) -> String {
        let mesh = if self.elements > 0 { format!("{} elements", self.elements) } else { "graded mesh".into() };
        format!("{mesh}, {:.0e}", self.tolerance)
    }
}

/// A run of theirs, or why there is none.
pub struct RivalPoint {
    /// Which.
    pub plan: Plan,
    /// What came of it.
    pub work: Result<Work, String>,
    /// Our cheapest run that is as good.
    pub ours: Option<OwnRun>,
}

impl RivalPoint {
    fn ratio(&self) -> Option<f64> {
        Some(self.work.as_ref().ok()?.cost / self.ours?.work.cost)
    }
}

/// Our cheapest run whose errors are no greater: of tension, and of place.
fn cheapest(own: &[OwnRun], off: &Off) -> Option<OwnRun> {
    let good = own.iter().filter(|run| {
        let place = off.place.is_none_or(|bound| run.work.off.place.is_some_and(|p| p <= bound));
        run.work.off.tension <= off.tension && place
    });
    good.min_by(|a, b| a.work.cost.total_cmp(&b.work.cost)).copied()
}

/// Runs what there is of other programs for a case and holds it against our runs.
pub fn measure(rivals: &Rivals, case: &Case, truth: &Track, own: &[OwnRun], repeats: usize, long: f64) -> Vec<RivalPoint> {
    // Samples as often as the truth's.
    let every = truth.times[1] - truth.times[0];
    let mut points = Vec::new();
    for plan in PLANS.into_iter().filter(|plan| plan.case == case.name) {
        let work = rivals
            .run(&plan, every, case.end, repeats, long)
            .and_then(|(track, cost)| Ok(Work { off: track.off(truth, case.from)?, cost }))
            .map_err(|e| e.to_string());
        let ours = work.as_ref().ok().and_then(|w| cheapest(own, &w.off));
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

/// Their lines in a case's chart of an error.
pub fn series(case: &Case, points: &[RivalPoint], error: fn(&Off) -> Option<f64>) -> Vec<Series> {
    const COLOURS: [Colour; 2] = [PALETTE[4], PALETTE[5]];
    let line = |(k, program): (usize, &Program)| {
        let works = points.iter().filter(|p| p.plan.program == *program).filter_map(|p| p.work.as_ref().ok());
        let points: Vec<_> = works.filter_map(|w| Some((error(&w.off)?.log10(), (case.end / w.cost).log10()))).collect();
        (!points.is_empty()).then(|| Series { points, ..Series::new(program.name(), &[], &[], COLOURS[k]) }.width(2.5))
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

/// The section with every run of theirs and our cheapest that is as good.
pub fn section(points: &[RivalPoint]) -> Section {
    let row = |p: &RivalPoint| {
        let (errors, cost) = match &p.work {
            Ok(w) => ([share(w.off.tension), place(w.off.place)], format!("{:.1}", 1e3 * w.cost)),
            Err(e) => ([format!("left out: {e}"), String::new()], String::new()),
        };
        let ours = match (&p.ours, &p.work) {
            (Some(run), _) => format!("{:.2}, {}", 1e3 * run.work.cost, run.name()),
            (None, Ok(_)) => "none as good".to_owned(),
            (None, Err(_)) => String::new(),
        };
        let [tension, place] = errors;
        let ratio = p.ratio().map_or(String::new(), |r| format!("{r:.1}"));
        vec![p.plan.case.to_uppercase(), p.plan.program.name().to_owned(), p.plan.mesh(), tension, place, cost, ours, ratio]
    };
    let header =
        ["Scene", "Program", "Mesh, step", "Tension error", "Place error", "Its run, ms", "Our cheapest as good, ms", "Times cheaper"];
    let text = "Exudyn 1.13.6 and MoorDyn 2.7.2 on the same scenes, in the same run on the same machine; CPU seconds of the solver call alone, \
                theirs and ours. \u{201c}As good\u{201d} is in tension and in place; the place is the body's in m, in P1 the wrap angle in rad. \
                Their drivers are in fmu-tests/peers. Exudyn runs in P1 with twelve contact segments an element, the most it takes, and in P4b \
                with a law in Python, because it has none of its own without compression. MoorDyn \
                starts P4 hung at rest, not stretched uniformly; its steps in P5 are of the greatest round number that stays stable.";
    Section::new("Other programs' runs").text(text).table(&header, points.iter().map(row).collect())
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

    fn run(method: &'static str, tension: f64, place: f64, cost: f64) -> OwnRun {
        let work = Work { off: Off { tension, place: Some(place) }, cost };
        OwnRun { method, elements: 20, tolerance: 1e-3, work, sub_steps: 1.0 }
    }

    #[test]
    fn exact_the_cheapest_run_that_is_as_good() {
        let own = [run("a", 1e-2, 1.0, 1.0), run("b", 1e-3, 1e-2, 5.0), run("c", 1e-3, 1e-3, 9.0)];
        let method = |tension, place| cheapest(&own, &Off { tension, place }).map(|run| run.method);
        assert_eq!(method(1e-2, None), Some("a"));
        assert_eq!(method(1e-2, Some(1e-2)), Some("b"));
        assert_eq!(method(5e-3, Some(5e-3)), Some("c"));
        assert_eq!(method(1e-4, Some(1.0)), None);
    }

    #[test]
    fn exact_every_run_of_theirs_has_a_row() {
        let plan = Plan { program: Program::MoorDyn, case: "p4b", elements: 20, step: 1e-3 };
        let ours = run("rodas4", 6e-3, 1.0, 0.5);
        let points = [
            RivalPoint { plan, work: Ok(Work { cost: 3.0, ..ours.work }), ours: Some(ours) },
            RivalPoint { plan, work: Err("it broke".into()), ours: None },
        ];
        let section = section(&points);
        let super::super::section::Block::Table(header, rows) = &section.blocks[1] else { panic!("a table") };
        assert!(rows.iter().all(|row| row.len() == header.len()));
        assert_eq!(rows[0][6..], ["500.00, rodas4, 20 elements, 1e-3", "6.0"].map(String::from));
        assert_eq!(rows[1][3..], ["left out: it broke", "", "", "", ""].map(String::from));
    }
}
