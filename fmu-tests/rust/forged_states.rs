//! Saved states of a simulation in which one number after the other was changed on purpose: refused, or taken and then survived.
//!
//! The random search is in `fuzz.rs`; this one leaves no number of the state out.

mod bench;

use bench::{Wire, channel, run, started};
use fairlead::scene::Scene;
use fairlead::sim::{Channel, Inputs, Simulation};

/// Everything that keeps something from step to step: ship, winch, turbulence, a turning sheave, axial unknowns, a rigid load; few elements,
/// and no patience.
fn scene() -> Scene {
    let wire = Wire { length: 1.5, diameter: 0.008, mass_per_length: 0.05, ea: 1e5, ei: 1e-4, laws: "damping.axial = 60.0" };
    wire.scene(
        10,
        "[fluid]\ndensity = 1026\nwaterline = -0.2\ndrag = { law = \"cross_flow\", cd_normal = 1.2, cd_tangential = 0.02 }\n\
         [fluid.current]\nprofile = [[-1.0, 0.1, 0.0], [0.0, 0.3, 0.0]]\n\
         [fluid.current.noise]\nstd_dev = [0.03, 0.03, 0.02]\nseed = 1\nsample_rate = 100.0\nattenuation = 80.0\norder = 8\ncutoff = 2.0\nramp = 2.0\n\
         [ship]\ninput = \"pose\"\n\
         [winch]\nposition = [-1.0, 0, -0.046]\naxis = [0, 1, 0]\nradius = 0.096\ngain_position = 400\ngain_rate = 40\ndirection = 1\n\
         [[sheave]]\nname = \"block\"\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.046\nstiffness = 1e8\nfriction = 0.3\ninertia = 1e-3\n\
         [load]\nmass = 10.0\nlength_inertia = 0.3\nlength_gravity = 0.25\n[solver]\nsteps_max = 60\n[outputs]\npoints = 2\n",
    )
}

/// A ship that heaves and a drum that turns.
fn under_way(t: f64) -> Inputs {
    let mut inputs = Inputs { ship: [channel([0.0; 3]); 6], ..Inputs::default() };
    inputs.ship[2] = Channel { value: 0.01 * (3.0 * t).sin(), ..Channel::default() };
    inputs.winch = Channel { value: 0.05 * t, first: Some(0.05), second: None };
    inputs
}

const STEP: f64 = 1e-3;

/// A simulation under way and its state's numbers.
fn running() -> (Simulation, Vec<f64>) {
    let mut sim = started(&scene(), &under_way(0.0));
    run(&mut sim, STEP, 8.0 * STEP, under_way, |_, _| ());
    let mut bytes = vec![];
    sim.write_state(&mut bytes);
    let numbers = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight"))).collect();
    (sim, numbers)
}

fn bytes_of(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn numbers_of(sim: &Simulation) -> Vec<f64> {
    let mut bytes = vec![];
    sim.write_state(&mut bytes);
    bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight"))).collect()
}

#[test]
fn exact_numbers_that_are_not_finite_are_refused_wherever_they_stand() {
    let (mut sim, good) = running();
    for i in 0..good.len() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut forged = good.clone();
            forged[i] = value;
            let message = sim.read_state(&bytes_of(&forged)).expect_err("not finite").to_string();
            assert!(message.contains("not finite"), "number {i}: {message}");
        }
    }
    assert_eq!(numbers_of(&sim), good);
    let short = sim.read_state(&bytes_of(&good[1..])).expect_err("too short").to_string();
    assert!(short.contains(&format!("{} bytes", 8 * good.len() - 8)) && short.contains(&format!("needs {}", 8 * good.len())), "{short}");
}

#[test]
fn exact_forged_counts_and_flags_are_cut_to_what_they_can_be() {
    let (mut sim, good) = running();
    let (mut counts, mut seen, mut flags) = (0, 0, 0);
    for i in 0..good.len() {
        let mut forged = good.clone();
        forged[i] = 1e300;
        sim.read_state(&bytes_of(&forged)).expect("finite");
        match numbers_of(&sim)[i] {
            1e300 => {}
            // 2⁵³, the last whole number before doubles leave some out.
            9_007_199_254_740_992.0 => counts += 1,
            // Three samples of each of the ship's six channels are remembered.
            3.0 => seen += 1,
            1.0 => flags += 1,
            // The status code, an Integer of FMI.
            2_147_483_647.0 => {}
            other => panic!("number {i} came back as {other}"),
        }
    }
    println!("{} numbers, of them {counts} counts of work, {seen} of samples, {flags} flags", good.len());
    assert!(counts >= 4 && seen == 6 && flags >= 1, "{counts} {seen} {flags}");
}

/// Debug builds stop at overflows, so these would panic.
#[test]
fn exact_absurd_numbers_end_in_an_error_or_in_a_finite_step() {
    let (mut sim, good) = running();
    let after = {
        let mut sim = sim.clone();
        sim.step_to(9.0 * STEP, &under_way(8.0 * STEP)).expect("a completed step");
        numbers_of(&sim)
    };
    let (mut failed, mut done) = (0, 0);
    for i in 0..good.len() {
        for value in [0.0, -1.0, 5e-324, 1e300, -f64::MAX, 2f64.powi(60)] {
            let mut forged = good.clone();
            forged[i] = value;
            sim.read_state(&bytes_of(&forged)).expect("finite");
            let time = sim.time();
            let to = time + STEP.max(1e-12 * time.abs());
            match sim.step_to(to, &under_way(8.0 * STEP)) {
                Ok(()) => done += 1,
                Err(_) => failed += 1,
            }
            let mut outputs = sim.outputs().clone();
            outputs.status.message.clear(); // may name a place that is none
            let outputs = format!("{outputs:?}");
            assert!(!outputs.contains("NaN") && !outputs.contains("inf"), "number {i} = {value:e}: {outputs}");
        }
        // Nothing of it remains.
        sim.read_state(&bytes_of(&good)).expect("its own state");
        sim.step_to(9.0 * STEP, &under_way(8.0 * STEP)).expect("a completed step");
        assert_eq!(numbers_of(&sim), after, "after number {i}");
    }
    println!("{} numbers: {failed} steps failed, {done} were made", good.len());
    // Else the search looks at one side only.
    assert!(failed > good.len() / 10 && done > good.len() / 10, "{failed} {done}");
}
