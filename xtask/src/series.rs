//! Time series in CSV files: the first column is `time`, the others are named by their header.

use crate::error::{Failure, at};
use std::fs;
use std::path::Path;

/// Columns over a strictly ascending time, without gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Names of the columns without `time`.
    pub names: Vec<String>,
    /// s, at least one.
    pub time: Vec<f64>,
    /// One row per time with one value per name.
    rows: Vec<Vec<f64>>,
}

impl Series {
    /// Reads a file.
    ///
    /// # Errors
    /// Names file, line, column and what was expected.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = fs::read_to_string(path).map_err(|e| at(path, format!("{e}; expected a CSV text file")))?;
        Self::parse(&text).map_err(|problem| Failure(format!("{}{problem}", path.display())))
    }

    /// Problems begin with ":line: " or ": ", to be put behind the file's name.
    fn parse(text: &str) -> Result<Self, String> {
        let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let (_, header) = lines.next().ok_or(": the file is empty; expected a header line that begins with 'time'")?;
        let mut names = header.split(',').map(|name| name.trim().trim_matches('"').to_owned());
        let first = names.next().unwrap_or_default();
        if first != "time" {
            return Err(format!(":1: the first column is '{first}'; expected 'time'"));
        }
        let names: Vec<_> = names.collect();
        if let Some(twice) = names.iter().enumerate().find(|(k, name)| names[..*k].contains(name)) {
            return Err(format!(":1: column '{}' is there twice", twice.1));
        }
        let mut series = Self { names, time: Vec::new(), rows: Vec::new() };
        for (k, line) in lines {
            series.row(line).map_err(|problem| format!(":{}: {problem}", k + 1))?;
        }
        if series.time.is_empty() { Err(": there are no rows after the header".into()) } else { Ok(series) }
    }

    fn row(&mut self, line: &str) -> Result<(), String> {
        let fields: Vec<_> = line.split(',').map(str::trim).collect();
        let expected = self.names.len() + 1;
        if fields.len() != expected {
            return Err(format!("{} fields; expected {expected}, as in the header", fields.len()));
        }
        let number = |name: &str, field: &str| match field.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(format!("column '{name}' is '{field}'; expected a finite number")),
        };
        let time = number("time", fields[0])?;
        if let Some(&last) = self.time.last().filter(|&&last| last >= time) {
            return Err(format!("column 'time' is {time} after {last}; expected it to ascend"));
        }
        let row: Result<Vec<_>, _> = self.names.iter().zip(&fields[1..]).map(|(name, field)| number(name, field)).collect();
        self.time.push(time);
        self.rows.push(row?);
        Ok(())
    }

    /// First and last time, s.
    pub fn span(&self) -> (f64, f64) {
        (self.time[0], self.time[self.time.len() - 1])
    }

    /// The value of a column at a time, linear between rows, constant beyond the ends.
    pub fn at(&self, column: usize, time: f64) -> f64 {
        let after = self.time.partition_point(|&t| t <= time);
        let value = |row: usize| self.rows[row][column];
        if after == 0 {
            return value(0);
        }
        if after == self.time.len() {
            return value(after - 1);
        }
        let (t0, t1) = (self.time[after - 1], self.time[after]);
        let (v0, v1) = (value(after - 1), value(after));
        v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_and_holds_the_ends() {
        let s = Series::parse("time, a,\"b\"\r\n0,1,2\n\n1.0,3,0\n").unwrap();
        assert_eq!(s.names, ["a", "b"]);
        assert_eq!(s.span(), (0.0, 1.0));
        assert_eq!([s.at(0, -1.0), s.at(0, 0.25), s.at(1, 1.0), s.at(1, 9.0)], [1.0, 1.5, 0.0, 0.0]);
    }

    #[test]
    fn problems_have_a_line_and_a_column() {
        for (text, expected) in [
            ("", ": the file is empty"),
            ("t,a\n0,1\n", ":1: the first column is 't'; expected 'time'"),
            ("time,a,a\n0,1,1\n", ":1: column 'a' is there twice"),
            ("time,a\n", ": there are no rows"),
            ("time,a\n0,1\n1\n", ":3: 1 fields; expected 2"),
            ("time,a\n0,1\n1,nan\n", ":3: column 'a' is 'nan'; expected a finite number"),
            ("time,a\n0,1\n\n1,x\n", ":4: column 'a' is 'x'"),
            ("time,a\n0,1\n0,1\n", ":3: column 'time' is 0 after 0"),
        ] {
            let problem = Series::parse(text).unwrap_err();
            assert!(problem.starts_with(expected), "{problem}");
        }
    }
}
