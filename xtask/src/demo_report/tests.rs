//! The report of a made-up run.

use super::*;
use crate::ship_motion::{HEADER, Options, generate};
use std::collections::BTreeMap;

/// A made-up run that looks like the flume demo: 60 s, a ship in waves, a cable that swings like a string with a current.
fn synthetic() -> DemoData {
    let options = Options { scale: 60.0, heading: 160.0, step: 0.02, seed: 7, ..Options::default() };
    let motion = generate(&options).unwrap();
    let n = motion.times.len();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for i in 0..n {
        for (name, value) in HEADER[1..].iter().zip(motion.row(i)) {
            columns.entry((*name).to_owned()).or_default().push(value);
        }
    }
    let set = |columns: &mut BTreeMap<String, Vec<f64>>, name: &str, f: &dyn Fn(usize, f64) -> f64| {
        let values = (0..n).map(|i| f(i, motion.times[i])).collect();
        columns.insert(name.to_owned(), values);
    };
    let heave = |i: usize| motion.states[i].pose[2];
    let surge = |i: usize| motion.states[i].pose[0];
    let pitch = |i: usize| motion.states[i].pose[4];
    set(&mut columns, "winch.setpoint", &|i, _| 1.57 + 12.0 * heave(i) + 3.0 * pitch(i));
    set(&mut columns, "winch.angle", &|i, t| 1.57 + 12.0 * heave(i.saturating_sub(2)) + 3.0 * pitch(i) + 1e-3 * (9.0 * t).sin());
    set(&mut columns, "winch.rate", &|i, _| 12.0 * motion.states[i].velocity[2]);
    set(&mut columns, "winch.torque", &|i, _| 1.4e-4 + 2e-3 * heave(i));
    set(&mut columns, "winch.tension", &|i, t| 8.3e-3 + 2e-3 * motion.states[i].acceleration[2] + 2e-4 * (31.0 * t).sin());
    set(&mut columns, "body.tension", &|i, _| 7.6e-3 + 1.2e-3 * motion.states[i].acceleration[2]);
    set(&mut columns, "body.x", &|i, t| -0.708 + 0.4 * surge(i) + 0.004 * (0.9 * t).sin());
    set(&mut columns, "body.y", &|i, _| 0.2 * motion.states[i].pose[1]);
    set(&mut columns, "body.z", &|i, t| -0.685 + 0.3 * heave(i) + 0.003 * (1.1 * t).sin());
    set(&mut columns, "solver.steps", &|i, _| (2 * i + i / 9) as f64);
    set(&mut columns, "solver.iterations", &|i, _| (7 * i + i / 3) as f64);
    set(&mut columns, "solver.rejected", &|i, _| (i / 40) as f64);
    set(&mut columns, "solver.energy_error", &|_, t| 1e-5 * (1.0 - (-t / 20.0).exp()));
    let drum = Drum { x: 0.0, z: -0.01735, radius: 0.01735, clockwise: false };
    let body: Vec<(f64, f64)> = (0..n).map(|i| (columns["body.x"][i], columns["body.z"][i])).collect();
    for k in 1..=25 {
        let s = (k - 1) as f64 / 24.0;
        set(&mut columns, &format!("cable.point[{k}].x"), &|i, _| {
            let x0 = surge(i);
            x0 + (body[i].0 - x0) * (0.35 * s + 0.65 * s.powf(2.2))
        });
        set(&mut columns, &format!("cable.point[{k}].z"), &|i, _| heave(i) + (body[i].1 - heave(i)) * s.powf(0.85));
    }
    let held = BTreeMap::from([
        ("body.x".to_owned(), (0..n).map(|i| -0.708 + 0.9 * surge(i)).collect()),
        ("body.z".to_owned(), (0..n).map(|i| -0.685 + 0.9 * heave(i)).collect()),
    ]);
    DemoData {
        times: motion.times.clone(),
        columns,
        held,
        drum: Some(drum),
        waterline: Some(-0.46),
        wall_seconds: 1.234,
        facts: vec![
            ("Scene".into(), "flume".into()),
            ("Sea".into(), "JONSWAP, Hs 2.5 m, Tp 8 s, γ 3.3, heading 160°, scale 1:60".into()),
            ("Communication step".into(), "0.02 s".into()),
        ],
        machine: "made-up numbers, no machine".into(),
        animation: None,
    }
}

#[test]
fn exact_report_is_complete_and_self_contained() {
    let folder = tempfile::tempdir().unwrap();
    // `FAIRLEAD_REPORT_TEST` keeps the report for a look at it.
    let dir = std::env::var_os("FAIRLEAD_REPORT_TEST").map_or(folder.path().join("demo"), Into::into);
    write(&synthetic(), &dir).unwrap();
    let html = std::fs::read_to_string(dir.join("index.html")).unwrap();
    assert!(!html.contains("NaN") && !html.contains("src=") && !html.contains("href="));
    assert!(html.contains("48.6 \u{d7}"), "60 s in 1.234 s");
    for file in ["side-view", "drum-view", "ship-motion", "winch", "heave", "tension", "close-up", "body", "body-path", "solver"] {
        let svg = std::fs::read_to_string(dir.join(format!("{file}.svg"))).unwrap();
        assert!(html.contains(&svg), "{file}");
        assert!(svg.len() < 400_000, "{file}: {} bytes", svg.len());
    }
}

#[test]
fn exact_missing_columns_are_left_out_and_wrong_lengths_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut data = DemoData { times: vec![0.0, 1.0], ..DemoData::default() };
    data.columns.insert("body.x".into(), vec![0.0, 1.0]);
    write(&data, folder.path()).unwrap();
    assert!(folder.path().join("body.svg").exists() && !folder.path().join("winch.svg").exists());
    data.columns.insert("body.z".into(), vec![0.0]);
    let Failure(message) = write(&data, folder.path()).unwrap_err();
    assert!(message.contains("body.z: 1 values, expected 2"), "{message}");
    assert!(write(&DemoData::default(), folder.path()).is_err());
}
