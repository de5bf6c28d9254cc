//! Random abuse that is the same in every run: scene files, saved states, sequences of calls. Nothing may panic, hang or say things
//! that are not finite. `FAIRLEAD_FUZZ_ROUNDS=100000 cargo test --test fuzz --release` searches longer; what it found is kept as a
//! test of its own.
#![allow(unsafe_code)]

#[path = "fuzz/calls.rs"]
mod calls;
mod harness;
#[path = "fuzz/scenes.rs"]
mod scenes;
#[path = "fuzz/states.rs"]
mod states;

use harness::Fmu;
use model_description::{Causality, Value};
use std::path::PathBuf;

/// A folder with a scene that is quick to simulate: the default one with a few elements, and no patience for absurd inputs.
fn small_scene() -> PathBuf {
    let folder = std::env::temp_dir().join(format!("fairlead-fuzz-{}-{:?}", std::process::id(), std::thread::current().id()));
    let flume = model_description::scenes::SCENES[0].text;
    let begin = flume.find("[mesh]").expect("the flume scene has a mesh");
    let end = begin + flume[begin + 1..].find("\n[").expect("and more tables") + 2;
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let text = format!("{}[mesh]\nelements = 4\n\n{}", &flume[..begin], &flume[end..]);
    let text = text.replace("[solver]\n", "[solver]\nsteps_max = 500\n");
    assert!(text.contains("steps_max"), "the flume scene has a solver table");
    std::fs::write(folder.join("scene.toml"), text).expect("a file in it");
    folder
}

/// No message tells of a panic, and every output is finite.
#[track_caller]
fn sane(fmu: &Fmu, what: &dyn Fn() -> String) {
    for (_, _, text) in fmu.messages.take() {
        assert!(!text.contains("internal error"), "{text}\nafter {}", what());
    }
    for row in fmu.model.variables.iter().filter(|row| row.causality == Causality::Output) {
        assert!(!matches!(fmu.read(row), Ok(Value::Real(x)) if !x.is_finite()), "{} is not finite after {}", row.name, what());
    }
}
