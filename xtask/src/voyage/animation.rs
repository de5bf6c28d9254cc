//! `animation.html`: the moving cable, drawn by a page that needs nothing but itself.

use super::scene::{Wheel, z_up};
use super::{POSE, Record};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;

/// Frames a second, where the run's rows are as dense.
const RATE: f64 = 25.0;
/// Numbers in a page at most, which takes 8 MB: six minutes of 100 points. Longer runs have fewer frames a second.
const NUMBERS_MAX: f64 = 3e6;
/// Points of the cable at most.
const POINTS_MAX: usize = 101;

/// A number over the frames, as 16 bits between its least and its greatest value.
#[derive(Serialize)]
struct Channel {
    name: String,
    least: f64,
    greatest: f64,
}

/// What the page is told in JSON; the frames are beside it, channel by channel, little-endian and in base64.
#[derive(Serialize)]
struct Description<'a> {
    title: &'a str,
    start: f64,
    step: f64,
    frames: usize,
    points: usize,
    tip: Option<&'static str>,
    waterline: Option<f64>,
    drum: &'a Option<Wheel>,
    anchor: Option<[f64; 3]>,
    sheaves: &'a [Wheel],
    tensions: Vec<&'a str>,
    channels: Vec<Channel>,
}

/// The page; none where the FMU has fewer than two points of its cable as outputs.
pub fn html(record: &Record) -> Option<String> {
    let count = (1..).take_while(|k| record.has(&format!("cable.point[{k}].x"))).count();
    if count < 2 || record.times.is_empty() {
        return None;
    }
    let stride = (count - 1).div_ceil(POINTS_MAX - 1);
    let mut shown: Vec<usize> = (0..count).step_by(stride).collect();
    if shown.last() != Some(&(count - 1)) {
        shown.push(count - 1);
    }
    let tip = ["body", "load"].into_iter().find(|tip| record.has(&format!("{tip}.x")));
    let sources = sources(record, &shown, tip);

    let clock = Clock::new(&record.times, sources.len());
    let (mut channels, mut bytes) = (Vec::new(), Vec::new());
    for source in &sources {
        let values: Vec<f64> = (0..clock.frames).map(|frame| clock.value(&record.times, source, frame)).collect();
        let (least, greatest) = quantized(&values, &mut bytes);
        channels.push(Channel { name: source.name.clone(), least, greatest });
    }
    let scene = &record.scene;
    let description = Description {
        title: &record.title,
        start: record.times[0],
        step: clock.step,
        frames: clock.frames,
        points: shown.len(),
        tip,
        waterline: scene.waterline,
        drum: &scene.drum,
        anchor: scene.anchor,
        sheaves: &scene.sheaves,
        tensions: record.tensions(),
        channels,
    };
    // Numbers and names only: nothing in it can fail to be written. `<` could end the script.
    let json = serde_json::to_string(&description).unwrap_or_default().replace('<', "\\u003c");
    let title = record.title.replace('&', "&amp;").replace('<', "&lt;");
    let page = include_str!("animation.html").replace("{title}", &title);
    let page = page.replace("{scene}", &json).replace("{frames}", &BASE64_STANDARD.encode(bytes));
    Some(page.replace("{script}", include_str!("animation.js")))
}

/// A column under the name by which the page knows it.
struct Source<'a> {
    name: String,
    values: &'a [f64],
    sign: f64,
    /// A Boolean, which has no values between.
    flag: bool,
}

fn sources<'a>(record: &'a Record, shown: &[usize], tip: Option<&str>) -> Vec<Source<'a>> {
    let mut list = Vec::new();
    let mut add = |name: String, from: &str, sign: f64, flag: bool| {
        list.extend(record.column(from).map(|values| Source { name, values, sign, flag }));
    };
    let signs = z_up(record.scene.ned, [1.0; 3]);
    let vectors = shown.iter().enumerate().map(|(i, k)| (format!("p{i}"), format!("cable.point[{}]", k + 1)));
    let vectors = vectors.chain(tip.map(|tip| ("tip".to_owned(), tip.to_owned())));
    for (to, from) in vectors {
        for (axis, sign) in ["x", "y", "z"].into_iter().zip(signs) {
            add(format!("{to}.{axis}"), &format!("{from}.{axis}"), sign, false);
        }
    }
    // Turned about x by half a turn, the angles have the signs of their axes.
    for (name, sign) in POSE.into_iter().zip(signs.into_iter().chain(signs)) {
        add(name.to_owned(), name, sign, false);
    }
    for name in record.tensions().into_iter().chain(["winch.angle"]) {
        add(name.to_owned(), name, 1.0, false);
    }
    add("cable.slack".to_owned(), "cable.slack", 1.0, true);
    for i in 1..=record.scene.sheaves.len() {
        for (what, flag) in
            [("contact_begin", false), ("contact_end", false), ("angle", false), ("in_contact", true), ("out_of_groove", true)]
        {
            let name = format!("sheave[{i}].{what}");
            add(name.clone(), &name, 1.0, flag);
        }
    }
    list
}

/// Evenly spaced frames over a run.
struct Clock {
    start: f64,
    step: f64,
    frames: usize,
}

impl Clock {
    fn new(times: &[f64], channels: usize) -> Self {
        let (start, span) = (times[0], times[times.len() - 1] - times[0]);
        let most = (NUMBERS_MAX / channels as f64).max(2.0);
        let intervals = (span * RATE).min((times.len() - 1) as f64).min(most - 1.0).floor();
        if intervals < 1.0 {
            // One row, or two that are closer than a frame.
            return Self { start, step: span, frames: times.len().min(2) };
        }
        Self { start, step: span / intervals, frames: intervals as usize + 1 }
    }

    /// Linear between rows; a flag holds until the next row.
    fn value(&self, times: &[f64], source: &Source, frame: usize) -> f64 {
        // A frame that meets a row should not miss it by rounding.
        let time = self.start + frame as f64 * self.step + 1e-9 * self.step;
        let after = times.partition_point(|&t| t <= time).clamp(1, times.len());
        let (a, b) = (after - 1, after.min(times.len() - 1));
        if source.flag || a == b {
            return source.sign * source.values[a];
        }
        let part = (time - times[a]) / (times[b] - times[a]);
        source.sign * (source.values[a] + part * (source.values[b] - source.values[a]))
    }
}

/// Appends the values as 16 bits between the least and the greatest, which it returns. What is not finite keeps the value before it.
fn quantized(values: &[f64], bytes: &mut Vec<u8>) -> (f64, f64) {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (least, greatest) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let (least, greatest) = if least <= greatest { (least, greatest) } else { (0.0, 0.0) };
    let unit = if greatest > least { 65535.0 / (greatest - least) } else { 0.0 };
    let mut last = 0;
    for value in values {
        if value.is_finite() {
            last = ((value - least) * unit).round() as u16;
        }
        bytes.extend(last.to_le_bytes());
    }
    (least, greatest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voyage::Scene;
    use std::collections::BTreeMap;

    fn record(rows: usize, points: usize) -> Record {
        let times: Vec<f64> = (0..rows).map(|row| 0.01 * row as f64).collect();
        let mut columns = BTreeMap::new();
        for k in 1..=points {
            for axis in ["x", "y", "z"] {
                columns.insert(format!("cable.point[{k}].{axis}"), times.iter().map(|t| (t + k as f64).sin()).collect());
            }
        }
        columns.insert("winch.tension".to_owned(), times.clone());
        Record {
            title: "a </script> b".to_owned(),
            times,
            columns,
            scene: Scene { waterline: Some(-1.0), ..Scene::default() },
            failure: None,
        }
    }

    #[test]
    fn exact_sixteen_bits_hold_a_value_to_half_a_step() {
        let values = [-3.0, 0.123_456, f64::NAN, 7.0];
        let mut bytes = Vec::new();
        let (least, greatest) = quantized(&values, &mut bytes);
        let back: Vec<f64> =
            bytes.chunks(2).map(|b| least + (greatest - least) * f64::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0).collect();
        assert_eq!((back[0], back[2], back[3]), (-3.0, back[1], 7.0));
        assert!((back[1] - values[1]).abs() <= 0.5 * 10.0 / 65535.0);
    }

    #[test]
    fn exact_frames_end_with_the_run() {
        let times: Vec<f64> = (0..101).map(|row| 0.01 * f64::from(row)).collect();
        let clock = Clock::new(&times, 10);
        assert_eq!(clock.frames, 26);
        let values: Vec<f64> = times.iter().map(|t| 2.0 * t).collect();
        let source = Source { name: String::new(), values: &values, sign: -1.0, flag: false };
        assert!((clock.value(&times, &source, 25) + 2.0).abs() < 1e-9);
        assert!((clock.value(&times, &source, 3) + 0.24).abs() < 1e-9);
        assert_eq!(Clock::new(&[0.0, 0.5, 1.0], 10).frames, 3, "no more frames than rows");
        assert_eq!(Clock::new(&[2.0], 10).frames, 1);
        assert_eq!(Clock::new(&[2.0, 2.01], 10).frames, 2);
    }

    #[test]
    fn exact_a_minute_stays_below_two_megabytes() {
        let page = html(&record(6001, 101)).unwrap();
        assert!(page.len() < 2_000_000, "{}", page.len());
        assert!(!page.contains("http") && !page.contains(" src="), "it loads nothing");
        assert_eq!(page.matches("</script>").count(), page.matches("<script").count(), "a name cannot end a script");
        assert!(!page.contains("{script}") && !page.contains("{frames}"));
        assert!(html(&record(10, 1)).is_none());
    }

    /// With F = diag(1, -1, -1), the page's pose is F R F of the FMU's R.
    #[test]
    fn exact_z_down_is_drawn_upwards() {
        let mut record = record(2, 2);
        record.scene.ned = true;
        for (name, value) in POSE.into_iter().zip([3.0, 2.0, 1.0, 0.3, -0.2, 0.5]) {
            record.columns.insert(name.to_owned(), vec![value; 2]);
        }
        let list = sources(&record, &[0, 1], None);
        let shown = |name: &str| list.iter().find(|source| source.name == name).map(|source| source.sign * source.values[0]).unwrap();
        assert_eq!(["ship.x", "ship.y", "ship.z"].map(shown), [3.0, -2.0, -1.0]);
        let turned = nalgebra::Rotation3::from_euler_angles(shown("ship.roll"), shown("ship.pitch"), shown("ship.yaw"));
        let flip = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, -1.0, -1.0));
        let fmu = nalgebra::Rotation3::from_euler_angles(0.3, -0.2, 0.5);
        // A few roundings of numbers up to 1.
        assert!((turned.matrix() - flip * fmu.matrix() * flip).amax() < 1e-15);
        assert_eq!(shown("p0.z"), -record.columns["cable.point[1].z"][0]);
    }
}
