//! The demo's report: a page with figures of what was simulated, and each figure as an SVG file of its own.

mod cable;
mod data;
mod figures;
mod tables;
#[cfg(test)]
mod tests;
pub mod units;

use crate::error::Failure;
use crate::html_report::Page;
use std::path::Path;

pub use data::{DemoData, Drum};
pub use tables::findings;

/// Writes `index.html` and one SVG file a figure into `dir`, which is made if it does not exist.
///
/// # Errors
/// Columns of a wrong length, and files that cannot be written.
pub fn write(data: &DemoData, dir: &Path) -> Result<(), Failure> {
    for (name, values) in data.columns.iter().chain(&data.held) {
        if values.len() != data.times.len() {
            return Err(Failure(format!("{name}: {} values, expected {}, one a time", values.len(), data.times.len())));
        }
    }
    if data.times.is_empty() {
        return Err(Failure("the demo's results: no rows, expected at least one".to_owned()));
    }
    let save = |name: &str, text: &str| {
        let path = dir.join(name);
        std::fs::write(&path, text).map_err(|error| Failure(format!("{}: cannot be written: {error}", path.display())))
    };
    std::fs::create_dir_all(dir).map_err(|error| Failure(format!("{}: cannot be made: {error}", dir.display())))?;

    let mut page = Page::new("fairlead: a towed cable on a heave-compensating winch");
    page.paragraph(
        "A ship moves in an irregular sea and tows a small sphere through a current. The winch on its deck reels cable in and out so that \
         the sphere stays where it is. Every number below was computed by a packed FMU, driven through its FMI 2.0 C interface; a controller \
         outside the FMU made the winch's set-point from the ship's motion.",
    );
    page.tiles(&tables::key_figures(data));
    if let Some(animation) = &data.animation {
        save("animation.html", animation)?;
        page.file("animation.html", "the cable, the winch and the ship moving");
    }
    for (heading, figures) in figures::sections(data) {
        if figures.is_empty() {
            continue;
        }
        page.heading(heading);
        for figure in &figures {
            let svg = figure.chart.svg();
            save(&format!("{}.svg", figure.file), &svg)?;
            page.figure(&svg, &figure.caption);
        }
    }
    page.heading("Extremes").table(&["Variable", "Least", "Mean", "Greatest", "Std. dev.", "Unit"], &tables::extremes(data));
    page.heading("The run").table(&[], &tables::run_table(data));
    page.paragraph(
        "Frames: x forward, y to port, z up, the origin at the drum's top in the calm; roll, pitch and yaw about x, y and z, pitch positive \
         bow down. The drum's angle is right-handed about its axis, which points to port.",
    );
    save("index.html", &page.html())
}
