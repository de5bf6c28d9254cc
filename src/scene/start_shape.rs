//! The CSV file of `[initial] state = "shape"`: one row a point, over arc length.

use super::model::ShapePoint;
use super::problem::Problems;
use super::schema::best_match;
use nalgebra::Vector3;

/// How closely the arc length must begin at 0 and end at the cable's length, relative to that length.
const END_TOLERANCE: f64 = 1e-6;

/// Columns: all of a triple or none of it; `s`, `x`, `y`, `z` always.
const COLUMNS: [&str; 10] = ["s", "x", "y", "z", "tx", "ty", "tz", "vx", "vy", "vz"];
/// Where the triples of [`COLUMNS`] begin.
const POSITION: usize = 1;
const TANGENT: usize = 4;
const VELOCITY: usize = 7;

/// Reads the file's text. Problems are named after the key `initial.file` with the line number.
pub(super) fn parse(file: &str, text: &str, length: f64, problems: &mut Problems) -> Vec<ShapePoint> {
    let mut fault = |line: usize, message: String| problems.add("initial.file", format!("{file}:{line}: {message}"));
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));

    let Some((line, header)) = lines.next() else {
        fault(1, "the file is empty; expected a header s,x,y,z".into());
        return vec![];
    };
    let header: Vec<_> = header.split(',').map(str::trim).collect();
    let place = match places(&header) {
        Ok(place) => place,
        Err(message) => {
            fault(line, message);
            return vec![];
        }
    };

    let mut points: Vec<ShapePoint> = Vec::new();
    for (line, row) in lines {
        let cells: Vec<_> = row.split(',').map(str::trim).collect();
        if cells.len() != header.len() {
            fault(line, format!("found {} values; expected {}, one for each column of the header", cells.len(), header.len()));
            continue;
        }
        let bad = cells.iter().zip(&header).find(|(cell, _)| !cell.parse::<f64>().is_ok_and(f64::is_finite));
        if let Some((cell, column)) = bad {
            fault(line, format!("found \"{cell}\" in column {column}; expected a finite number"));
            continue;
        }
        let value = |column: usize| place[column].and_then(|p| cells[p].parse::<f64>().ok());
        let triple = |first: usize| Some(Vector3::new(value(first)?, value(first + 1)?, value(first + 2)?));
        let (Some(s), Some(position)) = (value(0), triple(POSITION)) else { continue };
        if points.last().is_some_and(|p| p.s >= s) {
            fault(line, format!("found s = {s}; expected the arc length to ascend strictly"));
        }
        points.push(ShapePoint { s, position, tangent: triple(TANGENT), velocity: triple(VELOCITY).unwrap_or_default() });
    }
    let ends = (points.first().map(|p| p.s), points.last().map(|p| p.s));
    let (Some(first), Some(last)) = ends else {
        fault(line, "there are no rows below the header".into());
        return vec![];
    };
    if first.abs() > END_TOLERANCE * length || (last - length).abs() > END_TOLERANCE * length {
        fault(line, format!("s runs from {first} to {last}; expected from 0 to cable.length = {length} m"));
    }
    points
}

/// Where in a row each of [`COLUMNS`] stands.
fn places(header: &[&str]) -> Result<[Option<usize>; COLUMNS.len()], String> {
    for (i, name) in header.iter().enumerate() {
        if !COLUMNS.contains(name) {
            let hint = best_match(name, COLUMNS.into_iter()).map_or(String::new(), |m| format!("; did you mean {m}?"));
            return Err(format!("unknown column \"{name}\"{hint}; expected s,x,y,z and optionally tx,ty,tz and vx,vy,vz"));
        }
        if header[..i].contains(name) {
            return Err(format!("column {name} stands there twice"));
        }
    }
    let place = COLUMNS.map(|column| header.iter().position(|name| *name == column));
    let partly = |first: usize| (first..first + 3).any(|c| place[c].is_some());
    for (c, column) in COLUMNS.iter().enumerate() {
        let needed = c < TANGENT || (c < VELOCITY && partly(TANGENT)) || (c >= VELOCITY && partly(VELOCITY));
        if needed && place[c].is_none() {
            return Err(format!("column {column} is missing; expected s,x,y,z and optionally tx,ty,tz and vx,vy,vz"));
        }
    }
    Ok(place)
}
