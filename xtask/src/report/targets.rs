//! What `cargo xtask bench` must reach: so many times cheaper than another program, or than real time, at equal true error.

use super::rival_runs::Program;
use super::rivals::{OwnRun, RivalPoint, Work, place};
use super::row::share;
use super::section::Section;
use super::track::Off;

/// What a run of ours is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Against {
    /// The program's cheapest run that is as good.
    Rival(Program),
    /// The simulated time.
    RealTime,
}

/// What is asked for.
struct Target {
    case: &'static str,
    against: Against,
    /// At least so many times cheaper.
    times: f64,
    /// At an error of tension over its rms.
    tension: f64,
    /// And at one of place, where it counts.
    place: Option<f64>,
}

const fn target(case: &'static str, against: Against, times: f64, tension: f64, place: Option<f64>) -> Target {
    Target { case, against, times, tension, place }
}

const TARGETS: [Target; 7] = [
    target("p1", Against::Rival(Program::Exudyn), 100.0, 2e-3, Some(1e-4)),
    target("p3", Against::Rival(Program::Exudyn), 40.0, 7e-3, None),
    target("p5", Against::Rival(Program::MoorDyn), 100.0, 1.5e-3, None),
    target("p4a", Against::Rival(Program::Exudyn), 6.0, 4e-5, None),
    target("p4b", Against::Rival(Program::MoorDyn), 5.0, 6e-3, None),
    target("flume", Against::RealTime, 500.0, 1e-2, None),
    target("overboard", Against::RealTime, 200.0, 1e-2, None),
];

/// The errors asked for are a program's, rounded: a run meets them if it is no worse than this share of them, whosever it is.
const ROUNDING: f64 = 1.05;

impl Target {
    fn met_by(&self, off: &Off) -> bool {
        let place = self.place.is_none_or(|bound| off.place.is_some_and(|p| p <= ROUNDING * bound));
        off.tension <= ROUNDING * self.tension && place
    }

    fn error(&self) -> String {
        share(self.tension) + &self.place.map_or(String::new(), |p| format!(", {p:.0e} rad"))
    }
}

/// A case's runs, ours and theirs.
pub struct Runs<'a> {
    /// Its name.
    pub case: &'a str,
    /// Simulated time, s.
    pub end: f64,
    /// Ours.
    pub own: &'a [OwnRun],
    /// Theirs.
    pub theirs: &'a [RivalPoint],
}

/// The cheapest of some runs.
fn cheapest<T>(runs: impl Iterator<Item = (T, Work)>) -> Option<(T, Work)> {
    runs.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost))
}

/// A row of the table: what is asked for, the two runs, their ratio, the verdict.
fn judge(target: &Target, runs: &Runs) -> [String; 7] {
    let cell = |what: &str, work: &Work| {
        let place = work.off.place.filter(|_| target.place.is_some()).map_or(String::new(), |p| format!(", {}", place(Some(p))));
        format!("{what}: {}{place}, {:.2} ms", share(work.off.tension), 1e3 * work.cost)
    };
    let own = cheapest(runs.own.iter().filter(|r| target.met_by(&r.work.off)).map(|r| (r.name(), r.work)));
    let (whom, peer) = match target.against {
        Against::RealTime => ("real time".to_owned(), Some((String::new(), runs.end))),
        Against::Rival(program) => {
            let of = runs.theirs.iter().filter(|p| p.plan.program == program);
            let good = of.filter_map(|p| p.work.as_ref().ok().filter(|w| target.met_by(&w.off)).map(|w| (p.plan.mesh(), *w)));
            (program.name().to_owned(), cheapest(good).map(|(mesh, work)| (cell(&mesh, &work), work.cost)))
        }
    };
    let ratio = own.as_ref().zip(peer.as_ref()).map(|((_, own), (_, peer))| peer / own.cost);
    let verdict = match (ratio, &own, target.against) {
        (Some(ratio), ..) if ratio >= target.times => "reached",
        (Some(_), ..) | (None, None, _) => "NOT REACHED",
        (None, Some(_), _) if runs.theirs.is_empty() => "not run",
        (None, Some(_), _) => "the program is never as good",
    };
    [
        format!("{}, {}", target.case, target.error()),
        whom,
        own.map_or("none as good".to_owned(), |(name, work)| cell(&name, &work)),
        peer.map_or(String::new(), |(words, _)| words),
        ratio.map_or(String::new(), |r| format!("{r:.1}")),
        format!("{:.0}", target.times),
        verdict.to_owned(),
    ]
}

/// The rows of the scenes that were run.
fn rows(all: &[Runs]) -> Vec<[String; 7]> {
    TARGETS.iter().filter_map(|t| Some(judge(t, all.iter().find(|r| r.case == t.case)?))).collect()
}

/// The section, also printed.
pub fn section(all: &[Runs]) -> Section {
    let rows = rows(all);
    for [what, whom, own, peer, ratio, asked, verdict] in &rows {
        println!("MUST {what} against {whom}: ours {own}; theirs {peer}; {ratio} times, {asked} asked for: {verdict}");
    }
    let header = ["Scene, error", "Against", "Our cheapest run", "Its cheapest run", "Times cheaper", "Asked for", ""];
    let text = "Each side's cheapest run on this page that meets the error, in all that is asked for, over all methods, meshes and tolerances that \
                were run; errors up to 5 % above the rounded figure count, on both sides. Flume and overboard are held against real time; \
                their error is that in time.";
    Section::new("What must be reached").text(text).table(&header, rows.into_iter().map(Vec::from).collect())
}

#[cfg(test)]
mod tests {
    use super::super::rival_runs::Plan;
    use super::*;

    fn own(tension: f64, place: f64, cost: f64) -> OwnRun {
        OwnRun {
            method: "rodas4",
            elements: 40,
            tolerance: 1e-3,
            work: Work { off: Off { tension, place: Some(place) }, cost },
            sub_steps: 1.0,
        }
    }

    fn rival(tension: f64, place: f64, cost: f64) -> RivalPoint {
        let plan = Plan { program: Program::Exudyn, case: "p1", elements: 40, step: 1e-4 };
        RivalPoint { plan, work: Ok(Work { off: Off { tension, place: Some(place) }, cost }), ours: None }
    }

    fn verdict(own: &[OwnRun], theirs: &[RivalPoint]) -> [String; 2] {
        let [.., ratio, _, verdict] = rows(&[Runs { case: "p1", end: 1.0, own, theirs }])[0].clone();
        [ratio, verdict]
    }

    #[test]
    fn exact_the_cheapest_runs_that_meet_all_conditions_are_compared() {
        // Cheap but wrong in one of the two does not count, on either side; nor does the dearer of two good runs.
        let ours = [own(1e-3, 1e-2, 1e-4), own(1e-2, 1e-5, 1e-4), own(2e-3, 1e-4, 0.01), own(1e-3, 1e-5, 0.1)];
        let theirs = [rival(1e-3, 1e-2, 0.1), rival(1.8e-3, 1.04e-4, 2.0), rival(1e-3, 1e-5, 9.0)];
        assert_eq!(verdict(&ours, &theirs), ["200.0", "reached"]);
        assert_eq!(verdict(&ours[3..], &theirs), ["20.0", "NOT REACHED"]);
    }

    #[test]
    fn exact_what_cannot_be_compared_says_so() {
        let good = [own(1e-3, 1e-5, 0.1)];
        assert_eq!(verdict(&good, &[]), ["", "not run"]);
        assert_eq!(verdict(&good, &[rival(1e-2, 1e-5, 1.0)]), ["", "the program is never as good"]);
        assert_eq!(verdict(&[], &[rival(1e-3, 1e-5, 1.0)]), ["", "NOT REACHED"]);
    }

    #[test]
    fn exact_real_time_is_the_simulated_time() {
        let runs = |cost| rows(&[Runs { case: "flume", end: 20.0, own: &[own(5e-3, 1.0, cost)], theirs: &[] }])[0].clone();
        assert_eq!(runs(0.03)[6], "reached");
        assert_eq!((runs(0.1)[4].as_str(), runs(0.1)[6].as_str()), ("200.0", "NOT REACHED"));
    }

    #[test]
    fn exact_every_target_is_of_a_case_and_of_a_plan() {
        let cases = super::super::cases::cases().unwrap();
        for target in TARGETS {
            assert!(cases.iter().any(|case| case.name == target.case), "{}", target.case);
            if let Against::Rival(program) = target.against {
                assert!(super::super::rival_runs::PLANS.iter().any(|p| p.case == target.case && p.program == program), "{}", target.case);
            }
        }
    }
}
