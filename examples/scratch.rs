use fairlead::scene::file::SceneFile;
use fairlead::sim::*;
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let scene = match SceneFile::parse(&text, &args[1]).and_then(|f| f.check(None)) { Ok(s) => s, Err(e) => { println!("{e}"); return; } };
    let stop: f64 = args[2].parse().unwrap();
    let h: f64 = args[3].parse().unwrap();
    let heave: f64 = args.get(4).map_or(0.0, |a| a.parse().unwrap());
    let period: f64 = args.get(5).map_or(1.0, |a| a.parse().unwrap());
    let ramp: f64 = args.get(6).map_or(2.0 * period, |a| a.parse().unwrap());
    let print: usize = args.get(7).map_or(10, |a| a.parse().unwrap());
    let mut sim = Simulation::new(&scene).unwrap();
    let mut inputs = Inputs::default();
    if let Some(w) = &scene.winch { inputs.winch.value = w.angle; inputs.winch.first = Some(0.0); }
    let t0 = Instant::now();
    if let Err(e) = sim.initialize(0.0, &inputs) { println!("{e}"); return; }
    println!("init {:?}", t0.elapsed());
    println!("{:#?}", { let mut o = sim.outputs().clone(); o.cable.points.clear(); o });
    let w = std::f64::consts::TAU / period;
    let f = |t: f64| { let (s, ds, dds) = if ramp > 0.0 && t < ramp { let k = std::f64::consts::PI / ramp; (0.5*(1.0-(k*t).cos()), 0.5*k*(k*t).sin(), 0.5*k*k*(k*t).cos()) } else { (1.0,0.0,0.0) };
        let (x, dx, ddx) = ((w*t).sin(), w*(w*t).cos(), -w*w*(w*t).sin());
        (heave*s*x, heave*(ds*x+s*dx), heave*(dds*x+2.0*ds*dx+s*ddx)) };
    let n = (stop / h).round() as usize;
    let t0 = Instant::now();
    for i in 0..n {
        let t = i as f64 * h;
        let (x, v, a) = f(t);
        inputs.ship[2] = Channel { value: x, first: Some(v), second: Some(a) };
        if let Err(e) = sim.step_to((i + 1) as f64 * h, &inputs) { println!("{e}"); break; }
        if (i + 1) % (n / print).max(1) == 0 {
            let o = sim.outputs();
            println!("{:.4} T {:.6} / {:.6} / {:.6} body {:.6?} payout {:.4} steps {} rej {} energy {:.2e} slack {}", sim.time(), o.winch.tension + o.anchor.tension, o.body.tension, o.cable.tension_max, o.body.position.as_slice(), o.winch.payout, o.solver.steps, o.solver.rejected, o.solver.energy_error, o.cable.slack);
        }
    }
    let e = t0.elapsed().as_secs_f64();
    println!("wall {e:.4} s, RTF {:.1}", stop / e);
}
