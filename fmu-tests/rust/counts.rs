//! Work in numbers that no machine's mood changes: sub-steps of built-in scenes beside those of the day they were written down. What makes
//! them grow makes every run slower.

mod bench;

use bench::{channel, run, started};
use fairlead::scene::file::SceneFile;
use fairlead::sim::{Channel, Inputs};
use std::f64::consts::TAU;

/// Steps tried may exceed the frozen number by this much: other libraries round sines and powers differently, and a step control answers.
const SLACK: f64 = 1.05;

fn tried(name: &str, h: f64, end: f64, inputs: impl Fn(f64) -> Inputs) -> (u64, u64) {
    let built_in = model_description::scenes::named(name).expect("a built-in scene");
    let scene = SceneFile::parse(built_in.text, name).and_then(|f| f.check(None)).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = started(&scene, &inputs(0.0));
    run(&mut sim, h, end, inputs, |_, _| ());
    (sim.outputs().solver.steps, sim.outputs().solver.rejected)
}

/// A small ship in waves, on the flume's scale, the winch working against them; from rest.
fn in_waves(t: f64) -> Inputs {
    let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
    // s³(10 − 15s + 6s²): a start with two continuous derivatives.
    let s = (t / 2.0).min(1.0);
    let ramp = [s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 15.0 * (s * (1.0 - s)).powi(2), 30.0 * s * (1.0 - s) * (1.0 - 2.0 * s)];
    let wave = |size: f64, period: f64| {
        let w = TAU / period;
        let (sine, cosine) = (w * t).sin_cos();
        let f = [size * sine, size * w * cosine, -size * w * w * sine];
        [f[0] * ramp[0], f[1] * ramp[0] + f[0] * ramp[1], f[2] * ramp[0] + 2.0 * f[1] * ramp[1] + f[0] * ramp[2]]
    };
    let sizes = [(0.004, 1.9), (0.006, 1.3), (0.012, 1.45), (0.05, 1.2), (0.03, 1.45), (0.01, 2.3)];
    for (c, (size, period)) in sizes.into_iter().enumerate() {
        inputs.ship[c] = channel(wave(size, period));
    }
    let payout = wave(-0.012 / 0.01735, 1.45);
    inputs.winch = Channel { value: std::f64::consts::FRAC_PI_2 - payout[0], first: Some(-payout[1]), second: None };
    inputs
}

#[test]
fn frozen_sub_steps_of_built_in_scenes() {
    let still = |_: f64| Inputs::default();
    let runs = [
        ("flume", tried("flume", 0.01, 10.0, in_waves), 2645),
        // A rope that sinks 0.1 µm into a V groove without damping wobbles sideways from rounding alone: with forces and tangent that agreed
        // to 1e-15 three orders of summation took 542, 579 and 611 sub-steps.
        ("pulley_1", tried("pulley_1", 0.01, 0.5, still), 611),
        ("pulley_3", tried("pulley_3", 0.01, 0.5, still), 792),
    ];
    for (name, (steps, rejected), _) in &runs {
        println!("{name}: {steps} sub-steps, {rejected} rejected, {} tried", steps + rejected);
    }
    for (name, (steps, rejected), frozen) in runs {
        assert!((steps + rejected) as f64 <= SLACK * f64::from(frozen), "{name}: {steps} + {rejected}, {frozen} when written down");
    }
}
