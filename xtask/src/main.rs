//! fairlead's commands: one file each.

// Until the demo uses it.
#[cfg_attr(not(test), allow(dead_code))]
mod demo_report;
mod error;
mod host;
#[cfg_attr(not(test), allow(dead_code))]
mod html_report;
#[cfg_attr(not(test), allow(dead_code))]
mod plots;
mod run;
mod seakeeping;
mod series;
mod ship_motion;

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
    /// Drive a packed FMU over a series of inputs and write its outputs as CSV
    Run(run::Args),
    /// Write a 6-DOF ship motion in an irregular sea as CSV
    ShipMotion(ship_motion::Args),
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
        Command::Run(args) => run::run(args),
        Command::ShipMotion(args) => ship_motion::run(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}
