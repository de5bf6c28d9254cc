//! fairlead's commands: one file each.

mod attachments;
mod binary;
mod companions;
mod demo;
mod demo_report;
mod dist;
mod error;
mod example;
mod host;
mod html_report;
mod library;
mod licenses;
mod package;
mod platform;
mod plots;
mod python;
mod report;
mod results;
mod run;
mod scene_pages;
mod scenes;
mod seakeeping;
mod series;
mod ship_motion;
mod test;
mod toolchain;
mod validate;
mod voyage;
mod xml_tree;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "fairlead's commands")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run scenes by every time integrator: speed against error; writes fmu-tests/bench
    Bench(report::BenchArgs),
    /// Pack the default scene, drive it over a ship motion and report under target/demo
    Demo(demo::Args),
    /// Gather the built-in scenes' FMUs with all that goes with them in target/dist
    Dist(dist::Args),
    /// Run an example in Python of fmu-tests/examples
    Example(example::Args),
    /// Pack a scene as target/fmu/NAME.fmu
    Package(package::Args),
    /// Hold packed FMUs against closed forms, measurements and other programs; writes fmu-tests/report
    Report(report::Args),
    /// Drive a packed FMU over a series of inputs and write its outputs as CSV
    Run(run::Args),
    /// List the built-in scenes
    Scenes(scenes::Args),
    /// Write a 6-DOF ship motion in an irregular sea as CSV
    ShipMotion(ship_motion::Args),
    /// Run every test: Rust's, then the Python tests of the packed FMU
    Test(test::Args),
    /// Say what an importer would complain about
    Validate(validate::Args),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let code = if error.use_stderr() { ExitCode::FAILURE } else { ExitCode::SUCCESS };
            // Nothing sensible is left to do if the terminal is gone.
            let _ = error.print();
            return code;
        }
    };
    let outcome = match cli.command {
        Command::Bench(args) => report::run_bench(args),
        Command::Demo(args) => demo::run(args),
        Command::Dist(args) => dist::run(args),
        Command::Example(args) => example::run(args),
        Command::Package(args) => package::run(args),
        Command::Report(args) => report::run(args),
        Command::Run(args) => run::run(args),
        Command::Scenes(args) => scenes::run(args),
        Command::ShipMotion(args) => ship_motion::run(&args),
        Command::Test(args) => test::run(args),
        Command::Validate(args) => validate::run(args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            for line in failure.to_string().lines() {
                eprintln!("error: {line}");
            }
            ExitCode::FAILURE
        }
    }
}
