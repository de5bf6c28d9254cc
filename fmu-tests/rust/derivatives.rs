//! Derivatives of the outputs, by time and by the inputs of a step, against differences.

mod bench;

use bench::{channel, started};
use fairlead::outputs::Outputs;
use fairlead::scene::Scene;
use fairlead::scene::file::SceneFile;
use fairlead::sim::{Channel, Inputs, Simulation};

fn built_in(name: &str, tolerance: f64) -> Scene {
    let text = model_description::scenes::SCENES.iter().find(|s| s.name == name).expect("a built-in scene").text;
    let mut scene = SceneFile::parse(text, name).and_then(|f| f.check(None)).expect("good");
    scene.solver.tolerance = tolerance;
    scene
}

fn sea(size: f64, t: f64) -> Inputs {
    let wave = |a: f64, w: f64, p: f64| { let (s, c) = (w * t + p).sin_cos(); channel([size * a * s, size * a * w * c, -size * a * w * w * s]) };
    Inputs {
        ship: [wave(0.15, 0.73, 0.3), wave(0.09, 0.8, 1.1), wave(0.22, 0.75, 2.2), wave(0.013, 0.7, 0.7), wave(0.017, 0.73, 5.1), wave(0.007, 0.8, 3.9)],
        winch: channel([0.0; 3]),
        current: [Channel { value: 0.1 * size, first: Some(0.02*size), second: None }; 2],
        ..Inputs::default()
    }
}

type Get = fn(&Outputs) -> f64;
const QUANTITIES: [(&str, Get); 12] = [
    ("winch.tension", |o| o.winch.tension),
    ("winch.angle", |o| o.winch.angle),
    ("winch.rate", |o| o.winch.rate),
    ("winch.payout", |o| o.winch.payout),
    ("winch.force.x", |o| o.winch.force.x),
    ("body.tension", |o| o.body.tension),
    ("body.z", |o| o.body.position.z),
    ("body.vz", |o| o.body.velocity.z),
    ("cable.tension_max", |o| o.cable.tension_max),
    ("ship.force.z", |o| o.ship.force.z),
    ("sheave.tension_out", |o| o.sheaves.first().map_or(0.0, |s| s.tension_out)),
    ("sheave.normal_force", |o| o.sheaves.first().map_or(0.0, |s| s.normal_force)),
];

#[test]
fn scratch_rates() {
    for (name, size) in [("overboard", 1.0), ("flume", 0.02)] {
        let scene = built_in(name, 1e-6);
        let mut inputs = |t: f64| { let mut i = sea(size, t); if name == "flume" { i.winch = channel([1.57 + 0.05 * (3.0 * t).sin(), 0.15 * (3.0 * t).cos(), -0.45 * (3.0 * t).sin()]); } i };
        let mut sim = started(&scene, &inputs(0.0));
        let h = 0.001;
        let mut past: Vec<(Outputs, fairlead::outputs::Slope)> = vec![];
        for i in 0..1500 {
            sim.step_to(h * (i + 1) as f64, &inputs(h * i as f64)).unwrap();
            if i >= 1490 { past.push((sim.outputs().clone(), sim.rates())); }
        }
        for (q, get) in QUANTITIES {
            let d = (get(&past[6].0) - get(&past[4].0)) / (2.0 * h);
            let d2 = (get(&past[7].0) - get(&past[3].0)) / (4.0 * h);
            println!("{name} {q}: value {:.6} rate {:.6} differences {:.6} {:.6}", get(&past[5].0), past[5].1.of(get), d, d2);
        }
    }
}

fn unit(c: usize, k: usize) -> Inputs {
    let mut d = Inputs::default();
    let zero = Channel { value: 0.0, first: Some(0.0), second: Some(0.0) };
    d.ship = [zero; 6]; d.winch = zero;
    let ch = match c { 0..6 => &mut d.ship[c], 6 => &mut d.winch, 7 | 8 => &mut d.current[c - 7], _ => &mut d.body_force[c - 9] };
    match k { 0 => ch.value = 1.0, 1 => ch.first = Some(1.0), _ => ch.second = Some(1.0) };
    d
}
fn moved(i: &Inputs, d: &Inputs, s: f64) -> Inputs {
    let add = |a: &Channel, b: &Channel| Channel { value: a.value + s * b.value, first: a.first.map(|x| x + s * b.first.unwrap_or(0.0)), second: a.second.map(|x| x + s * b.second.unwrap_or(0.0)) };
    Inputs { ship: std::array::from_fn(|c| add(&i.ship[c], &d.ship[c])), winch: add(&i.winch, &d.winch), current: std::array::from_fn(|c| add(&i.current[c], &d.current[c])), body_force: std::array::from_fn(|c| add(&i.body_force[c], &d.body_force[c])) }
}

#[test]
fn scratch_sensitivity() {
    for (name, size) in [("overboard", 1.0), ("flume", 0.02)] {
      for h in [0.01, 0.05] {
        let scene = built_in(name, if name == "flume" {1e-6} else {1e-5});
        let inputs = |t: f64| { let mut i = sea(size, t); if name == "flume" { i.winch = channel([1.57 + 0.05 * (3.0 * t).sin(), 0.15 * (3.0 * t).cos(), -0.45 * (3.0 * t).sin()]); } i };
        let mut sim = started(&scene, &inputs(0.0));
        let n = (0.5 / h) as usize;
        for i in 0..n { sim.step_to(h * (i + 1) as f64, &inputs(h * i as f64)).unwrap(); }
        let before = sim.clone();
        let (t, now) = (h * (n + 1) as f64, inputs(h * n as f64));
        let c0 = std::time::Instant::now();
        sim.step_to(t, &now).unwrap();
        let c1 = std::time::Instant::now();
        for (c, k) in [(0, 0), (2, 0), (2, 1), (2, 2), (4, 2), (5, 1), (6, 0), (6, 1), (7, 0), (9, 0), (11, 0)] {
            let d = unit(c, k);
            let c2 = std::time::Instant::now();
            let slope = sim.sensitivity(&d).unwrap();
            let took = c2.elapsed();
            let eps = if c >= 9 { 1.0 * if name=="flume" {1e-4} else {1.0} } else { 1e-3 };
            let side = |s: f64| -> Simulation { let mut x = before.clone(); x.step_to(t, &moved(&now, &d, s)).unwrap(); x };
            let (p, m) = (side(eps), side(-eps));
            println!("{name} h {h} input {c} order {k} (step {:?}, this {took:?}), sub {}", c1 - c0, sim.outputs().solver.steps - before.outputs().solver.steps);
            for (q, get) in QUANTITIES {
                let (a, b) = (slope.of(get), (get(p.outputs()) - get(m.outputs())) / (2.0 * eps));
                if a != 0.0 || b != 0.0 { println!("    {q}: {a:.6e} {b:.6e}  {:.2e}", (a - b).abs() / b.abs().max(1e-300)); }
            }
        }
      }
    }
}
