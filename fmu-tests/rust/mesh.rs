//! Elements graded from a target error: they are where they are needed, and tensions are as good as asked.

mod bench;

use bench::{channel, relative_rms, run, started};
use fairlead::scene::Scene;
use fairlead::scene::file::SceneFile;
use fairlead::sim::Inputs;
use std::f64::consts::TAU;

const OVERBOARD: &str = include_str!("../../modelDescription/scenes/overboard.toml");
const FLUME: &str = include_str!("../../modelDescription/scenes/flume.toml");

/// The scene with this for its [mesh].
fn with_mesh(text: &str, mesh: &str) -> Scene {
    let begin = text.find("[mesh]").expect("a mesh");
    let end = begin + text[begin..].find("\n[fluid]").expect("a fluid behind it");
    let text = format!("{}[mesh]\n{mesh}\n{}", &text[..begin], &text[end..]);
    SceneFile::parse(&text, "mesh.toml").and_then(|f| f.check(None)).expect("a right scene")
}

/// Where element boundaries lie, m.
fn nodes(scene: &Scene) -> Vec<f64> {
    scene.elements.iter().fold(vec![0.0], |mut s, l| {
        s.push(s[s.len() - 1] + l);
        s
    })
}

#[test]
fn exact_short_elements_lie_where_wheels_touch_the_cable() {
    for travel in [0.0, 1.0, 3.0] {
        let scene = with_mesh(OVERBOARD, &format!("error = 5e-3\ntravel = {travel}"));
        let s = nodes(&scene);
        assert!((s[s.len() - 1] - scene.cable.length).abs() < 1e-9 * scene.cable.length);
        let longest_within = |from: f64, to: f64| {
            let inside = s.windows(2).filter(|w| w[0] >= from && w[1] <= to);
            inside.map(|w| w[1] - w[0]).fold(0.0, f64::max)
        };
        // 2.3 m on the drum, then 12 m to the stern sheave, on which 0.6 m lie.
        let angle = 0.43 * if travel > 0.0 { (0.005f64 / 0.03).cbrt() } else { (0.005f64 / 0.0096).powf(0.4) };
        for (from, to, radius) in [(0.0, 2.3 + travel, 0.508), (14.4 - travel, 15.0 + travel, 0.358)] {
            // Nodes take equal shares; beside the stretch elements already grow.
            let longest = longest_within(from, to);
            assert!(longest < 1.2 * angle * radius, "travel {travel}, {from} to {to} m: {longest} m");
            assert!(longest > 0.8 * angle * radius, "travel {travel}, {from} to {to} m: {longest} m, needlessly short");
        }
        let growth = scene.elements.windows(2).map(|w| (w[1] / w[0]).max(w[0] / w[1])).fold(1.0, f64::max);
        assert!(growth < 1.6, "neighbours differ by {growth}");
    }
    // Elsewhere no more than the spans need.
    assert!(with_mesh(FLUME, "error = 1e-2").elements.len() < 45);
}

#[test]
fn exact_elements_become_more_as_the_error_falls_and_never_none() {
    let count = |error: f64| with_mesh(OVERBOARD, &format!("error = {error:e}")).elements.len();
    let counts = [0.5, 1e-1, 1e-2, 1e-3, 1e-4].map(count);
    assert!(counts.windows(2).all(|w| w[0] < w[1]) && counts[0] >= 1, "{counts:?}");
    // Not even for what nobody can want.
    assert!(count(1e-12) <= 20_001);
}

/// The ship heaves by half a metre in 5 s while the winch pays out and reels in by as much: nodes run over the sheave at 0.6 m/s.
fn reeling(t: f64) -> Inputs {
    let w = TAU / 5.0;
    let (sin, cos) = (w * t).sin_cos();
    // 1 − cos, which starts from rest.
    let wave = |a: f64| channel([a * (1.0 - cos), a * w * sin, a * w * w * cos]);
    let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], winch: wave(0.5), ..Inputs::default() };
    inputs.ship[2] = wave(0.5);
    inputs
}

#[test]
fn exact_tensions_are_as_good_as_asked() {
    let tensions = |mesh: &str, tolerance: f64| {
        let mut scene = with_mesh(OVERBOARD, mesh);
        scene.solver.tolerance = tolerance;
        let mut sim = started(&scene, &reeling(0.0));
        let mut tension = vec![];
        run(&mut sim, 0.02, 3.0, reeling, |_, o| tension.push(o.winch.tension));
        (tension, scene.elements.len())
    };
    let (truth, _) = tensions("error = 3e-4", 1e-4);
    for error in [1e-2, 2e-3] {
        let (tension, elements) = tensions(&format!("error = {error:e}"), 1e-3);
        let found = relative_rms(&tension.iter().copied().zip(truth.iter().copied()).collect::<Vec<_>>());
        println!("mesh.error {error:.0e}: {elements} elements, tension off by {found:.1e}");
        assert!(found < error, "{error}: {found}");
    }
}
