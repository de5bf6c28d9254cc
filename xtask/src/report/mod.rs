//! `cargo xtask report`: what the packed FMUs compute beside closed forms, the thesis's experiments and other programs.
//!
//! One file a section; each packs the scenes it needs and returns a [`Section`]. A further section is a further line in [`SECTIONS`].

mod bench;
mod cases;
mod cost;
mod dynamics;
mod edge;
mod flume;
mod hard;
mod identification;
mod inputs;
mod meshes;
mod moving_pulley;
mod must_hold;
mod noise;
mod numerics;
mod pace;
mod page;
mod peers;
mod pulley;
mod rival_runs;
mod rivals;
mod row;
mod scene;
mod section;
#[path = "../../../fmu-tests/rust/bench/numerics.rs"]
mod shared_numerics;
mod sheaves;
mod speed;
mod statics;
mod tangent;
mod targets;
mod track;
#[path = "../../../fmu-tests/rust/bench/wire.rs"]
mod wire;

use crate::error::{Failure, Result};
use crate::package::root;
use bench::Bench;
use indicatif::{ProgressBar, ProgressStyle};
use row::{Row, Truth};
use section::Section;
use std::io::IsTerminal;
use std::time::Instant;

pub use speed::{Args as BenchArgs, bench as run_bench};

/// Write fmu-tests/report from runs of packed FMUs: closed forms, the thesis's experiments, other programs' references
#[derive(clap::Args)]
pub struct Args {
    /// Only the sections whose name contains this; prints the verdicts and writes nothing, but for `hard`, which writes the hard cases' page
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
}

type Make = fn(&Bench) -> Result<Section>;

/// The sections: name for `--only`, and what makes them.
const SECTIONS: [(&str, Make); 12] = [
    ("statics", statics::section),
    ("dynamics", dynamics::section),
    ("sheaves", sheaves::section),
    ("edge", edge::section),
    ("tangent", tangent::section),
    ("pulley", pulley::section),
    ("moving-pulley", moving_pulley::section),
    ("flume", flume::section),
    ("identification", identification::section),
    ("noise", noise::section),
    ("inputs", inputs::section),
    ("peers", peers::section),
];

/// Runs the command.
///
/// # Errors
/// A build that fails, a folder that cannot be written, a bound that is missed.
pub fn run(args: Args) -> Result<()> {
    let all: Vec<_> = SECTIONS.iter().chain(&hard::GROUPS).collect();
    let chosen: Vec<_> = all.iter().filter(|(name, _)| args.only.as_ref().is_none_or(|only| name.contains(only.as_str()))).collect();
    if chosen.is_empty() {
        let names: Vec<_> = all.iter().map(|(name, _)| *name).collect();
        return Err(Failure(format!("--only {}: no such section; there are {}", args.only.unwrap_or_default(), names.join(", "))));
    }
    let clock = Instant::now();
    println!("building the library (the first build takes a while)");
    let bench = Bench::new()?;
    let bar = std::io::stderr().is_terminal().then(|| ProgressBar::new(chosen.len() as u64));
    if let (Some(bar), Ok(style)) = (&bar, ProgressStyle::with_template("{bar:40} {pos} of {len}  {msg}  {elapsed}")) {
        bar.set_style(style);
        bar.enable_steady_tick(std::time::Duration::from_millis(500));
    }
    let mut sections = Vec::new();
    for (i, (name, make)) in chosen.iter().enumerate() {
        match &bar {
            Some(bar) => bar.set_message(*name),
            None => println!("{} of {}: {name}", i + 1, chosen.len()),
        }
        // One scene that does not run is a miss; it does not take the other sections with it.
        sections.push(make(&bench).unwrap_or_else(|e| Section::new(name).rows(vec![Row::failed(Truth::Exact, "The section's scenes", e)])));
        if let Some(bar) = &bar {
            bar.inc(1);
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    print!("{}", page::verdicts(&sections));
    println!("{} FMUs packed, {:.0} s", bench.count(), clock.elapsed().as_secs_f64());
    let folder = root().join("fmu-tests").join("report");
    let first_hard = chosen.iter().position(|(name, _)| name.starts_with(hard::PREFIX)).unwrap_or(chosen.len());
    if args.only.is_none() {
        page::write(&sections[..first_hard], &folder)?;
        println!("{}", crate::results::shown(&folder.join("index.html")));
    }
    // A page of its own, written when it is whole: its cases take as long as all the rest.
    if chosen.len() - first_hard == hard::GROUPS.len() {
        let folder = folder.join("hard");
        page::write_hard(&sections[first_hard..], &folder)?;
        println!("{}", crate::results::shown(&folder.join("index.html")));
    }
    let missed: usize = sections.iter().map(Section::missed).sum();
    if missed > 0 {
        return Err(Failure(format!("{missed} figures miss their bound; they are marked MISSED above")));
    }
    Ok(())
}
