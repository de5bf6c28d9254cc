//! fairlead's commands.

// Until the demo uses it.
#[cfg_attr(not(test), allow(dead_code))]
mod demo_report;
mod error;
#[cfg_attr(not(test), allow(dead_code))]
mod html_report;
#[cfg_attr(not(test), allow(dead_code))]
mod plots;
mod seakeeping;
mod ship_motion;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// fairlead's commands, one variant each.
#[derive(Parser)]
#[command(name = "cargo xtask", about = "fairlead's commands")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
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
