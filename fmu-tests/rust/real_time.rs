//! Real time: a bound on the work of a communication step that holds whatever the sea, and says when it cost accuracy.

mod bench;

use bench::{HEAVY_WIRE, heaving, relative_rms, started};
use fairlead::scene::Scene;
use fairlead::sim::{SimError, Simulation};

/// A heavy wire that goes slack and snaps (P4b), the hardest seconds that a fixed step must get through.
fn scene(tries_max: usize) -> Scene {
    let mut scene =
        HEAVY_WIRE.scene(20, "[anchor]\nposition = [0, 0, 0]\n[body]\nmass = 500.0\n[ship]\ninput = \"pose_velocity_acceleration\"\n");
    scene.solver.tries_max = tries_max;
    scene
}

/// Tension over time, and per communication step the sub-steps tried and the status.
fn ride(tries_max: usize) -> (Vec<f64>, Vec<(u64, i32, String)>) {
    let inputs = heaving(5.0, 4.0);
    let mut sim = started(&scene(tries_max), &inputs(0.0));
    let (mut tension, mut steps) = (vec![], vec![]);
    let tried = |sim: &Simulation| sim.outputs().solver.steps + sim.outputs().solver.rejected;
    for i in 0..400 {
        let before = tried(&sim);
        sim.step_to(0.05 * f64::from(i + 1), &inputs(0.05 * f64::from(i))).expect("a bounded step is no failure");
        let status = &sim.outputs().status;
        steps.push((tried(&sim) - before, status.code, status.message.clone()));
        tension.push(sim.outputs().anchor.tension);
    }
    (tension, steps)
}

#[test]
fn exact_no_step_tries_more_than_allowed_and_an_overrun_is_told() {
    let (truth, free) = ride(0);
    let most = free.iter().map(|s| s.0).max().unwrap_or(0);
    assert!(most > 8, "the scene needs {most} sub-steps at most, so tries nothing");
    let mut before = f64::INFINITY;
    for tries in [2, 4, 8] {
        let (tension, steps) = ride(tries);
        let error = relative_rms(&tension.iter().copied().zip(truth.iter().copied()).collect::<Vec<_>>());
        let over = steps.iter().filter(|s| s.1 == 1).count();
        println!("{tries} tries: tension {error:.1e} from that without a bound, {over} of {} steps told as overrun", steps.len());
        assert!(steps.iter().all(|s| s.0 <= tries as u64), "more than {tries} tries");
        assert!(over > 0, "{tries} of {most} were enough everywhere");
        let message = &steps.iter().find(|s| s.1 == 1 && s.2.contains("real time")).expect("a message").2;
        assert!(message.contains(&format!("the {tries} sub-steps of solver.tries_max")), "{message}");
        // Steps that did not need more are as good as without a bound, so errors fall as fewer steps are cut.
        assert!(error < before, "{tries} tries: {error:.1e} after {before:.1e}");
        before = error;
    }
    // Enough but at the snaps, whose instants then shift: a measured 3 %, with room for other roundings.
    assert!(before < 0.05, "{before:.1e}");
    // A bound that is far off changes nothing, to the bit.
    assert!(ride(100_000).0 == truth, "a bound that is never met has changed the run");
}

#[test]
fn exact_an_absurd_input_in_real_time_ends_as_without() {
    let mut sim = started(&scene(3), &heaving(5.0, 4.0)(0.0));
    let mut absurd = heaving(5.0, 4.0)(0.0);
    absurd.ship[2].value = 1e300;
    let before = sim.outputs().clone();
    let failed = sim.step_to(0.05, &absurd);
    assert!(matches!(failed, Err(SimError::Step(_))), "{failed:?}");
    assert_eq!(sim.outputs().anchor.tension, before.anchor.tension);
    sim.step_to(0.05, &heaving(5.0, 4.0)(0.0)).expect("the state before is whole");
}
