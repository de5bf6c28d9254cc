//! A section of the report: what stands on the page, and the files beside it.

use super::row::{Row, Verdict};
use crate::plots::{Chart, Colour, Mark, Panel, Series};
use std::fmt::Write as _;

/// Something on the page.
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table of anything: header, rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// Figures held against a truth.
    Rows(Vec<Row>),
    /// Cases: a table whose first column holds sentences.
    Cases(Vec<String>, Vec<Vec<String>>),
    /// Figures that a table of [`Block::Cases`] shows; they count, and stand in the summary.
    Counted(Vec<Row>),
    /// A chart in a file of this name (without ending), with its caption.
    Chart(String, Box<Chart>, String),
    /// Small charts side by side: file (without ending) and chart.
    Gallery(Vec<(String, Chart)>),
    /// A file of numbers: name, text, what it holds.
    Csv(String, String, String),
}

/// One section.
pub struct Section {
    /// Heading.
    pub title: String,
    /// In order.
    pub blocks: Vec<Block>,
}

impl Section {
    /// An empty section.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), blocks: Vec::new() }
    }

    /// With a paragraph.
    pub fn text(mut self, text: impl Into<String>) -> Self {
        self.blocks.push(Block::Text(text.into()));
        self
    }

    /// With a table.
    pub fn table(mut self, header: &[&str], rows: Vec<Vec<String>>) -> Self {
        self.blocks.push(Block::Table(header.iter().map(|h| (*h).to_owned()).collect(), rows));
        self
    }

    /// With figures and their verdicts.
    pub fn rows(mut self, rows: Vec<Row>) -> Self {
        self.blocks.push(Block::Rows(rows));
        self
    }

    /// With a table of cases.
    pub fn case_table(mut self, header: &[&str], rows: Vec<Vec<String>>) -> Self {
        self.blocks.push(Block::Cases(header.iter().map(|h| (*h).to_owned()).collect(), rows));
        self
    }

    /// With figures that another table shows.
    pub fn counted(mut self, rows: Vec<Row>) -> Self {
        self.blocks.push(Block::Counted(rows));
        self
    }

    /// With a chart.
    pub fn chart(mut self, file: &str, chart: Chart, caption: impl Into<String>) -> Self {
        self.blocks.push(Block::Chart(file.to_owned(), Box::new(chart), caption.into()));
        self
    }

    /// With small charts side by side.
    pub fn gallery(mut self, charts: Vec<(String, Chart)>) -> Self {
        self.blocks.push(Block::Gallery(charts));
        self
    }

    /// With a file of numbers.
    pub fn csv(mut self, file: &str, header: &str, columns: &[&[f64]], what: &str) -> Self {
        self.blocks.push(Block::Csv(file.to_owned(), csv(header, columns), what.to_owned()));
        self
    }

    /// All figures.
    pub fn figures(&self) -> impl Iterator<Item = &Row> {
        self.blocks
            .iter()
            .filter_map(|block| if let Block::Rows(rows) | Block::Counted(rows) = block { Some(rows) } else { None })
            .flatten()
    }

    /// How many figures missed their bound.
    pub fn missed(&self) -> usize {
        self.figures().filter(|row| row.verdict() == Verdict::Missed).count()
    }
}

/// Columns under a header, seven significant digits.
pub fn csv(header: &str, columns: &[&[f64]]) -> String {
    let mut text = format!("{header}\n");
    for row in 0..columns.iter().map(|c| c.len()).min().unwrap_or(0) {
        let cells: Vec<String> = columns.iter().map(|c| number(c[row])).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// Seven significant digits as the shortest text.
fn number(x: f64) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    format!("{rounded:?}")
}

/// Every `n`th value.
pub fn thinned(values: &[f64], n: usize) -> Vec<f64> {
    values.iter().copied().step_by(n.max(1)).collect()
}

/// Values times a factor, such as from radians to degrees.
pub fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|v| v * factor).collect()
}

/// A panel whose series are dots joined by thin lines.
pub fn dotted(panel: Panel) -> Panel {
    let mut panel = panel;
    let dots: Vec<Mark> =
        panel.series.iter().flat_map(|s| s.points.iter().map(|p| Mark::Dot { centre: *p, radius: 3.2, colour: s.colour })).collect();
    panel.marks.extend(dots);
    panel
}

/// A level line over a range of x.
pub fn level(label: &str, x: [f64; 2], y: f64, colour: Colour) -> Series {
    Series::new(label, &x, &[y, y], colour).dashed().width(1.2)
}
