//! fmi2FMUstate: rollback to the bit, across instances, as bytes.
#![allow(unsafe_code)]

mod harness;

use fairlead::fmi::abi::*;
use fairlead::fmi::exports::*;
use harness::random::Random;
use harness::{Fmu, Request};
use std::ffi::CString;
use std::ptr::null_mut;

#[test]
fn replay_is_bit_identical() {
    let fmu = Fmu::started();
    let straight = Fmu::started().sail(0, 12, 0.01);
    fmu.sail(0, 5, 0.01);
    let point = fmu.save();
    let before = fmu.everything();
    for _ in 0..3 {
        fmu.sail(5, 9, 0.01);
        assert_eq!(fmu.restore(point), Status::Ok);
        assert_eq!(fmu.everything(), before);
    }
    assert_eq!(fmu.sail(5, 12, 0.01), straight[5..]);
    // Also back from the end of the run.
    assert_eq!(fmu.terminate(), Status::Ok);
    assert_eq!(fmu.restore(point), Status::Ok);
    assert_eq!(fmu.sail(5, 12, 0.01), straight[5..]);
    fmu.free(point);
}

/// The set-point's memory (its path, the mean, the measured direction) is in the state, and a reset forgets it.
#[test]
fn built_in_set_points_replay_to_the_bit() {
    let text = include_str!("../../modelDescription/scenes/flume.toml");
    for setpoint in ["simplified_sheave", "sheave", "waterline"] {
        let folder = std::env::temp_dir().join(format!("fairlead-{setpoint}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("scene.toml"), text.replace("setpoint = \"external\"", &format!("setpoint = \"{setpoint}\""))).unwrap();
        let fmu = Fmu::in_folder(&folder, &Request::good());
        assert!(fmu.model.variables.iter().all(|v| !v.name.starts_with("winch.setpoint")));
        fmu.start(0.0);
        let straight = fmu.sail(0, 12, 0.01);
        let told = fmu.get("winch.target");
        assert!((told - std::f64::consts::FRAC_PI_2).abs() > 1e-3 && fmu.get("winch.target_rate") != 0.0, "{told}");
        assert_eq!(fmu.reset(), Status::Ok);
        // The inputs too: `sail` sets some of them only.
        fmu.start(0.0);
        fmu.sail(0, 5, 0.01);
        let point = fmu.save();
        let bytes = fmu.serialize(point);
        fmu.sail(5, 9, 0.01);
        assert_eq!(fmu.restore(point), Status::Ok);
        assert_eq!(fmu.sail(5, 12, 0.01), straight[5..], "{setpoint}");
        let other = Fmu::in_folder(&folder, &Request::good());
        other.start(0.0);
        other.sail(0, 2, 0.02);
        let read = other.deserialize(&bytes).unwrap();
        assert_eq!(other.restore(read), Status::Ok);
        assert_eq!(other.sail(5, 12, 0.01), straight[5..], "{setpoint}, from bytes");
        fmu.free(point);
        other.free(read);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn a_state_carries_its_parameters_to_other_instances() {
    let a = Fmu::new();
    assert_eq!(a.set("body.mass", 0.5 * a.get("body.mass")), Status::Ok);
    a.start(0.0);
    a.sail(0, 3, 0.01);
    // Changed, but not yet used in a step.
    assert_eq!(a.set("winch.gain_position", 120.0), Status::Ok);
    let state = a.save();
    let bytes = a.serialize(state);
    let expected = a.sail(3, 8, 0.01);
    for b in [Fmu::new(), Fmu::started()] {
        assert_eq!(b.restore(state), Status::Ok);
        assert_eq!(b.sail(3, 8, 0.01), expected);
        let read = b.deserialize(&bytes).unwrap();
        assert_eq!(b.restore(read), Status::Ok);
        assert_eq!(b.sail(3, 8, 0.01), expected);
        b.free(read);
    }
    a.free(state);
}

#[test]
fn states_of_every_phase() {
    let fmu = Fmu::new();
    assert_eq!(fmu.set("ship.x", 0.003), Status::Ok);
    let fresh = fmu.save();
    assert_eq!(fmu.setup(1.0), Status::Ok);
    assert_eq!(fmu.enter(), Status::Ok);
    let initializing = fmu.save();
    let looked = fmu.everything();
    assert_eq!(fmu.exit(), Status::Ok);
    assert_eq!(fmu.step(1.0, 0.02), Status::Ok);
    let after = fmu.everything();

    assert_eq!(fmu.restore(initializing), Status::Ok);
    assert_eq!(fmu.everything(), looked);
    assert_eq!(fmu.exit(), Status::Ok);
    assert_eq!(fmu.step(1.0, 0.02), Status::Ok);
    assert_eq!(fmu.everything(), after);

    assert_eq!(fmu.restore(fresh), Status::Ok);
    assert_eq!(fmu.get("ship.x"), 0.003);
    assert_eq!(fmu.get("winch.tension"), 0.0);
    fmu.start(1.0);
    assert_eq!(fmu.step(1.0, 0.02), Status::Ok);
    assert_eq!(fmu.everything(), after);
    fmu.free(fresh);
    fmu.free(initializing);
}

/// A thousand times to any earlier point, on any of three instances, in memory or as bytes: every step is the one of an undisturbed run.
#[test]
fn a_thousand_random_rollbacks() {
    const STEPS: usize = 30;
    let straight = Fmu::started().sail(0, STEPS as u32, 0.01);
    let fmus = [Fmu::started(), Fmu::started(), Fmu::new()];
    let mut random = Random::new(2018);
    // What was saved at each communication point, last.
    let mut saved = vec![null_mut(); STEPS + 1];
    saved[0] = fmus[0].save();
    for _ in 0..1000 {
        let fmu = &fmus[random.below(fmus.len())];
        let k = loop {
            let k = random.below(saved.len());
            if !saved[k].is_null() {
                break k;
            }
        };
        if random.once_in(2) {
            assert_eq!(fmu.restore(saved[k]), Status::Ok);
        } else {
            let read = fmu.deserialize(&fmu.serialize(saved[k])).unwrap();
            assert_eq!(fmu.restore(read), Status::Ok);
            assert_eq!(fmu.serialize(read), fmu.serialize(saved[k]));
            fmu.free(read);
        }
        let last = (k + 1 + random.below(2)).min(STEPS);
        assert_eq!(fmu.sail(k as u32, last as u32, 0.01), straight[k..last], "from {k} to {last}");
        // Into the handle that is there already, if there is one.
        assert_eq!(unsafe { fmi2GetFMUstate(fmu.c, &mut saved[last]) }, Status::Ok);
    }
    assert!(saved.iter().all(|state| !state.is_null()), "some points were never reached");
    saved.into_iter().for_each(|state| fmus[0].free(state));
}

#[test]
fn handles_are_reused_and_freed() {
    let fmu = Fmu::started();
    let mut state = fmu.save();
    let pointer = state;
    fmu.sail(0, 2, 0.01);
    let here = fmu.everything();
    unsafe {
        assert_eq!(fmi2GetFMUstate(fmu.c, &mut state), Status::Ok);
        assert_eq!(state, pointer);
        fmu.sail(2, 3, 0.01);
        assert_eq!(fmu.restore(state), Status::Ok);
        assert_eq!(fmu.everything(), here);
        assert_eq!(fmi2FreeFMUstate(fmu.c, &mut state), Status::Ok);
        assert!(state.is_null());
        assert_eq!(fmi2FreeFMUstate(fmu.c, &mut state), Status::Ok);
        // Something else behind the pointer.
        let mut foreign = [0_u64; 64];
        let mut state: FmuState = foreign.as_mut_ptr().cast();
        fmu.refused(fmi2SetFMUstate(fmu.c, state), &["not from this FMU"]);
        fmu.refused(fmi2GetFMUstate(fmu.c, &mut state), &["not from this FMU"]);
        fmu.refused(fmi2FreeFMUstate(fmu.c, &mut state), &["not from this FMU"]);
        fmu.refused(fmi2SerializedFMUstateSize(fmu.c, state, &mut 0), &["not from this FMU"]);
    }
}

#[test]
fn damaged_bytes_are_refused() {
    let fmu = Fmu::started();
    fmu.sail(0, 2, 0.01);
    let state = fmu.save();
    let bytes = fmu.serialize(state);
    assert!(bytes.starts_with(b"FAIRLEAD"));
    for length in [0, 1, 7, 8, 20, bytes.len() / 2, bytes.len() - 1] {
        fmu.refused(fmu.deserialize(&bytes[..length]).unwrap_err(), &["fmi2DeSerializeFMUstate"]);
    }
    for at in (0..bytes.len()).step_by(7) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        fmu.refused(fmu.deserialize(&damaged).unwrap_err(), &["state"]);
    }
    fmu.refused(fmu.deserialize(&[0x5a; 4096]).unwrap_err(), &["no state of a fairlead FMU"]);
    let mut small = vec![0; bytes.len() - 1];
    let status = unsafe { fmi2SerializeFMUstate(fmu.c, state, small.as_mut_ptr(), small.len()) };
    fmu.refused(status, &[&bytes.len().to_string()]);
    fmu.free(state);
    fmu.sail(2, 3, 0.01);
}

#[test]
fn states_outlive_the_instance_that_made_them() {
    let a = Fmu::started();
    let b = Fmu::started();
    a.sail(0, 2, 0.01);
    let state = a.save();
    let expected = a.sail(2, 4, 0.01);
    drop(a);
    assert_eq!(b.restore(state), Status::Ok);
    assert_eq!(b.sail(2, 4, 0.01), expected);
    b.free(state);
    let mut none = null_mut();
    assert_eq!(unsafe { fmi2FreeFMUstate(b.c, &mut none) }, Status::Ok);
}

#[test]
fn instances_know_nothing_of_each_other() {
    let alone = Fmu::started().sail(0, 6, 0.01);
    let (a, b) = (Fmu::started(), Fmu::started());
    let mut interleaved = Vec::new();
    for k in 0..6 {
        interleaved.extend(a.sail(k, k + 1, 0.01));
        b.sail(2 * k, 2 * k + 1, 0.01 / 2.0);
        b.sail(2 * k + 1, 2 * k + 2, 0.01 / 2.0);
    }
    assert_eq!(interleaved, alone);
}

#[test]
fn eight_threads_and_one_that_hands_over() {
    let alone = Fmu::started().sail(0, 6, 0.01);
    std::thread::scope(|scope| {
        let runs: Vec<_> = (0..8)
            .map(|k| {
                let name = CString::new(format!("rope {k}")).unwrap();
                let made_here = Fmu::from(&Request { name: Some(name), ..Request::good() });
                scope.spawn(move || {
                    made_here.start(0.0);
                    made_here.sail(0, 6, 0.01)
                })
            })
            .collect();
        for run in runs {
            assert_eq!(run.join().unwrap(), alone);
        }
    });
}

#[test]
fn instances_come_and_go() {
    for _ in 0..100 {
        drop(Fmu::new());
    }
}
