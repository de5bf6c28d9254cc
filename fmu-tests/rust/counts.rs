//! Work in numbers that no machine's mood changes: sub-steps, linear solves and tangents of built-in scenes beside those of the day they were
//! written down. What makes them grow makes every run slower.

mod bench;

use bench::{HEAVY_WIRE, channel, heaving, run, started};
use fairlead::scene::Method;
use fairlead::scene::file::SceneFile;
use fairlead::sim::{Channel, Inputs};
use std::f64::consts::TAU;

/// Steps tried may exceed the frozen number by this much: other libraries round sines and powers differently, and a step control answers.
const SLACK: f64 = 1.05;

/// Sub-steps tried, solves and tangents of a run in communication steps of `h`; `edit` may change the scene's text.
fn work(name: &str, edit: impl Fn(&str) -> String, h: f64, end: f64, inputs: impl Fn(f64) -> Inputs) -> [u64; 3] {
    let built_in = model_description::scenes::named(name).expect("a built-in scene");
    let scene = SceneFile::parse(&edit(built_in.text), name).and_then(|f| f.check(None)).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = started(&scene, &inputs(0.0));
    run(&mut sim, h, end, inputs, |_, _| ());
    let solver = &sim.outputs().solver;
    let [solves, tangents, _] = sim.effort();
    [solver.steps + solver.rejected, solves, tangents]
}

/// The ship heaves by half a metre in 5 s while the winch pays out and reels in by as much: wire runs over the stern sheave.
fn reeling(t: f64) -> Inputs {
    let w = TAU / 5.0;
    let (sine, cosine) = (w * t).sin_cos();
    let wave = channel([0.5 * (1.0 - cosine), 0.5 * w * sine, 0.5 * w * w * cosine]);
    let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], winch: wave, ..Inputs::default() };
    inputs.ship[2] = wave;
    inputs
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

/// Where nothing turns or touches one tangent lasts for the run: stages that one iteration solves must not wear it out.
#[test]
fn frozen_a_heaved_wire_keeps_its_tangent() {
    for method in [Method::TrBdf2, Method::Esdirk3, Method::Esdirk4] {
        let mut scene =
            HEAVY_WIRE.scene(5, "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 500.0\n[ship]\ninput = \"pose_velocity_acceleration\"\n");
        (scene.solver.method, scene.solver.tolerance) = (method, 1e-2);
        let inputs = heaving(2.5, 6.0);
        let mut sim = started(&scene, &inputs(0.0));
        run(&mut sim, 0.05, 60.0, inputs, |_, _| ());
        let [solves, tangents, factors] = sim.effort();
        println!("{method:?}: {solves} solves, {tangents} tangents, {factors} factorizations in 1200 communication steps");
        // 1 and at most 8, with room for a step control that answers to other roundings.
        assert!(tangents <= 3 && factors <= 20, "{method:?}: {tangents} tangents, {factors} factorizations");
    }
}

#[test]
fn frozen_work_of_built_in_scenes() {
    let still = |_: f64| Inputs::default();
    let as_it_is = |text: &str| text.to_owned();
    let kept = |text: &str| text.replace("method = \"rodas4\"", "method = \"tr_bdf2\"");
    let runs = [
        ("flume", work("flume", as_it_is, 0.01, 10.0, in_waves), [2645, 16_026, 2657]),
        ("flume with kept factors", work("flume", kept, 0.01, 10.0, in_waves), [5650, 25_199, 1255]),
        ("overboard, reeling", work("overboard", as_it_is, 0.02, 5.0, reeling), [686, 3640, 367]),
        // A rope that sinks 0.1 µm into a V groove without damping wobbles sideways from rounding alone: with forces and tangent that agreed
        // to 1e-15 three orders of summation took 542, 579 and 611 sub-steps.
        ("pulley_1", work("pulley_1", as_it_is, 0.01, 0.5, still), [611, 3666, 519]),
        ("pulley_3", work("pulley_3", as_it_is, 0.01, 0.5, still), [792, 4752, 578]),
    ];
    for (name, [tried, solves, tangents], _) in &runs {
        println!("{name}: {tried} sub-steps tried, {solves} solves, {tangents} tangents");
    }
    for (name, work, frozen) in runs {
        for ((what, found), then) in ["sub-steps", "solves", "tangents"].into_iter().zip(work).zip(frozen) {
            assert!(found as f64 <= SLACK * f64::from(then), "{name}: {found} {what}, {then} when written down");
        }
    }
}
