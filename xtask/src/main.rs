//! fairlead's commands.

mod error;
mod package;
mod platform;
mod scenes;
mod validate;
mod xml_tree;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Cables over winches and sheaves, as FMI 2.0 co-simulation FMUs.
#[derive(Parser)]
#[command(name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Package(package::Args),
    Scenes(scenes::Args),
    Validate(validate::Args),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Package(args) => package::run(args),
        Command::Scenes(args) => scenes::run(args),
        Command::Validate(args) => validate::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            for line in error.to_string().lines() {
                eprintln!("error: {line}");
            }
            ExitCode::FAILURE
        }
    }
}
