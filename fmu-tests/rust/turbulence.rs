//! The flume's turbulent current: whatever a host does, the same seed gives the same water.

mod bench;

use bench::{run, started};
use fairlead::scene::Scene;
use fairlead::scene::file::SceneFile;
use fairlead::sim::{Channel, Inputs, Simulation};
use nalgebra::Vector3;

const SCENE: &str = include_str!("../../modelDescription/scenes/flume_noise.toml");

fn scene() -> Scene {
    SceneFile::parse(SCENE, "flume_noise.toml").and_then(|f| f.check(None)).expect("a right scene")
}

/// The winch holds still.
fn held(_: f64) -> Inputs {
    Inputs { winch: Channel { value: std::f64::consts::FRAC_PI_2, first: Some(0.0), second: None }, ..Inputs::default() }
}

fn advance(sim: &mut Simulation, end: f64) {
    run(sim, 0.01, end, held, |_, _| {});
}

#[test]
fn exact_saved_restored_and_retuned_runs_meet_the_same_water() {
    let scene = scene();
    let mut straight = started(&scene, &held(0.0));
    advance(&mut straight, 1.0);
    let mut saved = Vec::new();
    straight.write_state(&mut saved);
    advance(&mut straight, 2.0);
    // Rolled back from a later time.
    let mut rolled = straight.clone();
    rolled.read_state(&saved).expect("its own state");
    // Another instance that has not run.
    let mut fresh = Simulation::new(&scene).expect("supported");
    fresh.read_state(&saved).expect("a state of the same scene");
    // Tunable parameters set to what they are.
    let mut retuned = fresh.clone();
    retuned.retune(&scene).expect("the same scene");
    for other in [&mut rolled, &mut fresh, &mut retuned] {
        advance(other, 2.0);
        assert_eq!(other.outputs(), straight.outputs());
        assert_eq!(other.shape(), straight.shape());
    }
    assert_ne!(straight.outputs().current_noise, Vector3::zeros());
}

#[test]
fn exact_start_is_the_mean_currents_and_another_seed_another_run() {
    let quiet = {
        let mut scene = scene();
        scene.fluid.as_mut().expect("there").noise = None;
        scene
    };
    let other = {
        let mut scene = scene();
        scene.fluid.as_mut().and_then(|f| f.noise.as_mut()).expect("there").seed = 2;
        scene
    };
    let [mut a, mut b, c] = [scene(), other, quiet].map(|s| started(&s, &held(0.0)));
    assert!(a.shape() == c.shape() && b.shape() == c.shape());
    advance(&mut a, 1.0);
    advance(&mut b, 1.0);
    assert_ne!(a.outputs().body.position, b.outputs().body.position);
    // Whenever the run starts, it starts in the mean current.
    let mut late = Simulation::new(&scene()).expect("supported");
    late.initialize(1234.567, &held(0.0)).expect("a start state");
    assert!(late.shape() == c.shape() && late.outputs().current_noise == Vector3::zeros());
}

#[test]
fn exact_noise_moves_between_communication_points() {
    // Not sampled at them: long steps end where short ones end, to the integrator's accuracy.
    let mut scene = scene();
    scene.solver.tolerance = 1e-5;
    let path = |h: f64| {
        let mut sim = started(&scene, &held(0.0));
        let mut path = vec![];
        run(&mut sim, h, 4.0, held, |t, o| {
            if ((t / 0.2).round() * 0.2 - t).abs() < 1e-9 {
                path.push(o.body.position);
            }
        });
        path
    };
    let (short, long) = (path(0.01), path(0.2));
    assert_eq!(short.len(), long.len());
    let travel = short.iter().map(|r| (r - short[0]).norm()).fold(0.0, f64::max);
    let apart = short.iter().zip(&long).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    println!("the body travels {:.2} mm; steps of 10 and 200 ms end {:.5} mm apart", 1e3 * travel, 1e3 * apart);
    // The tolerance bounds the error of a sub-step; some hundreds add up to a thousandth of the travel. A current that stood still within
    // the steps would lag by half a step: a tenth of the travel.
    assert!(apart < 1e-3 * travel, "{apart} {travel}");
}
