//! Random sequences of calls with good and bad arguments.

use super::harness::random::{Random, rounds};
use super::harness::{Fmu, Request};
use super::{sane, small_scene};
use fairlead::fmi::abi::*;
use fairlead::fmi::exports::*;
use model_description::{Causality, Kind, Variability};
use std::ptr::{null, null_mut};

/// An instance under random calls, with what it has been through.
struct Victim<'a> {
    fmu: &'a Fmu,
    random: Random,
    states: Vec<FmuState>,
    time: f64,
    history: Vec<String>,
}

impl Victim<'_> {
    fn said(&mut self, call: String, status: Status) {
        // No host can do anything with these two, and we promise never to use them.
        assert!(!matches!(status, Status::Fatal | Status::Pending), "{call}: {status:?} after {:?}", self.history);
        self.history.push(format!("{call}: {status:?}"));
    }

    fn reference(&mut self, kind: Kind) -> u32 {
        let of_kind: Vec<u32> = self.fmu.model.variables.iter().filter(|row| row.kind == kind).map(|row| row.reference).collect();
        if of_kind.is_empty() || self.random.once_in(20) { self.random.next() as u32 } else { *self.random.pick(&of_kind) }
    }

    /// Reals that can be set: mostly near to what they are, now and then absurd.
    fn set_reals(&mut self) {
        let count = 1 + self.random.below(3);
        let (mut references, mut values) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let settable: Vec<_> =
                self.fmu.model.variables.iter().filter(|row| row.kind == Kind::Real && row.causality != Causality::Output).collect();
            let mut row = *self.random.pick(&settable);
            // Most parameters are fixed once the run has begun.
            while self.random.below(3) > 0 && row.causality == Causality::Parameter && row.variability != Variability::Tunable {
                row = *self.random.pick(&settable);
            }
            let now = self.fmu.get(&row.name);
            let near = if now == 0.0 { 0.01 * (self.random.unit() - 0.5) } else { now * (0.8 + 0.4 * self.random.unit()) };
            references.push(if self.random.once_in(30) { self.reference(Kind::Real) } else { row.reference });
            values.push(if self.random.once_in(12) { self.random.nasty() } else { near });
        }
        let status = unsafe { fmi2SetReal(self.fmu.c, references.as_ptr(), count, values.as_ptr()) };
        self.said(format!("set {references:?} {values:?}"), status);
    }

    fn step(&mut self) {
        let h = if self.random.once_in(8) {
            *self.random.pick(&[f64::NAN, f64::INFINITY, 0.0, -1.0, 1e-300])
        } else {
            0.02 * self.random.unit()
        };
        let point = if self.random.once_in(12) { self.random.nasty() } else { self.time };
        let status = unsafe { fmi2DoStep(self.fmu.c, point, h, TRUE) };
        self.said(format!("step {point} {h}"), status);
        let mut time = self.time;
        if unsafe { fmi2GetRealStatus(self.fmu.c, LAST_SUCCESSFUL_TIME, &mut time) } == Status::Ok {
            self.time = time;
        }
    }

    fn states(&mut self) {
        let c = self.fmu.c;
        let slot = self.random.below(self.states.len());
        match self.random.below(4) {
            0 => {
                let status = unsafe { fmi2GetFMUstate(c, &mut self.states[slot]) };
                self.said(format!("get state {slot}"), status);
            }
            1 => {
                let status = unsafe { fmi2SetFMUstate(c, self.states[slot]) };
                self.said(format!("set state {slot}"), status);
                let _ = unsafe { fmi2GetRealStatus(c, LAST_SUCCESSFUL_TIME, &mut self.time) };
            }
            2 => {
                let status = unsafe { fmi2FreeFMUstate(c, &mut self.states[slot]) };
                self.said(format!("free state {slot}"), status);
            }
            _ => {
                let mut size = 0;
                if unsafe { fmi2SerializedFMUstateSize(c, self.states[slot], &mut size) } == Status::Ok {
                    let mut bytes = vec![0; size + self.random.below(3)];
                    let short = self.random.below(3);
                    let status = unsafe { fmi2SerializeFMUstate(c, self.states[slot], bytes.as_mut_ptr(), bytes.len() - short) };
                    self.said(format!("serialize {slot}"), status);
                    let status = unsafe { fmi2DeSerializeFMUstate(c, bytes.as_ptr(), size, &mut self.states[slot]) };
                    self.said(format!("deserialize {slot}"), status);
                }
            }
        }
    }

    fn life(&mut self) {
        let f = self.fmu;
        let (name, status) = match self.random.below(12) {
            0..=2 => {
                let (start, stop) =
                    if self.random.once_in(4) { (self.random.nasty(), self.random.nasty()) } else { (self.time, self.time + 1.0) };
                let (given, tolerance) = (self.random.below(2) as i32, if self.random.once_in(3) { self.random.nasty() } else { 1e-3 });
                let status = unsafe { fmi2SetupExperiment(f.c, given, tolerance, start, self.random.below(2) as i32, stop) };
                if status == Status::Ok {
                    self.time = start;
                }
                ("setup", status)
            }
            3..=5 => ("enter", f.enter()),
            6..=8 => ("exit", f.exit()),
            9 => ("terminate", f.terminate()),
            10 => ("cancel", unsafe { fmi2CancelStep(f.c) }),
            _ => ("reset", f.reset()),
        };
        self.said(name.into(), status);
    }

    /// Reads, with arrays that are there or not.
    fn read(&mut self) {
        let c = self.fmu.c;
        let count = self.random.below(3);
        let kind = *self.random.pick(&[Kind::Real, Kind::Integer, Kind::Boolean, Kind::String]);
        let references: Vec<u32> = (0..count).map(|_| self.reference(kind)).collect();
        let given = if self.random.once_in(6) { null() } else { references.as_ptr() };
        let (mut reals, mut integers, mut texts) = ([0.0; 3], [0; 3], [null(); 3]);
        let status = unsafe {
            match kind {
                Kind::Real => fmi2GetReal(c, given, count, reals.as_mut_ptr()),
                Kind::Integer => fmi2GetInteger(c, given, count, integers.as_mut_ptr()),
                Kind::Boolean => fmi2GetBoolean(c, given, count, integers.as_mut_ptr()),
                Kind::String => fmi2GetString(c, given, count, texts.as_mut_ptr()),
            }
        };
        assert!(reals.iter().all(|x| x.is_finite()), "{references:?} = {reals:?} after {:?}", self.history);
        self.said(format!("get {kind:?} {references:?}"), status);
    }

    fn other(&mut self) {
        let c = self.fmu.c;
        let (vr, order, value) = (self.reference(Kind::Real), self.random.below(4) as i32, 0.1 * self.random.unit());
        let kind = self.random.below(6) as i32 - 1;
        let (name, status) = unsafe {
            match self.random.below(9) {
                0..=2 => ("input derivative", fmi2SetRealInputDerivatives(c, &vr, 1, &order, &value)),
                3 => ("output derivative", fmi2GetRealOutputDerivatives(c, &vr, 1, &order, &mut 0.0)),
                4 => ("directional derivative", fmi2GetDirectionalDerivative(c, &vr, 1, &vr, 1, &value, &mut 0.0)),
                5 => ("real status", fmi2GetRealStatus(c, kind, &mut 0.0)),
                6 => ("status", fmi2GetStatus(c, kind, &mut Status::Ok)),
                7 => ("string status", fmi2GetStringStatus(c, kind, &mut null())),
                _ => ("integers", fmi2SetInteger(c, &vr, 1, &(self.random.next() as i32))),
            }
        };
        self.said(name.into(), status);
    }
}

/// After any sequence the instance can be reset, is then like a new one, and runs like one.
#[test]
fn exact_any_sequence_of_calls_ends_in_a_working_instance() {
    let folder = small_scene();
    let fresh = Fmu::in_folder(&folder, &Request::good());
    let new = fresh.everything();
    fresh.start(0.0);
    let expected = fresh.sail(0, 2, 0.01);
    let mut steps = 0;
    for seed in 0..rounds(60) {
        let fmu = Fmu::in_folder(&folder, &Request::good());
        let mut victim = Victim { fmu: &fmu, random: Random::new(seed), states: vec![null_mut(); 3], time: 0.0, history: Vec::new() };
        // Half of them begin as a host would.
        if seed % 2 == 0 {
            fmu.start(0.0);
        }
        for _ in 0..60 {
            match victim.random.below(16) {
                0 => victim.life(),
                1 | 2 => victim.states(),
                3..=6 => victim.set_reals(),
                7 | 8 => victim.read(),
                9 => victim.other(),
                _ => victim.step(),
            }
            sane(&fmu, &|| format!("seed {seed}: {:#?}", victim.history));
        }
        steps += victim.history.iter().filter(|line| line.starts_with("step") && line.ends_with("Ok")).count();
        for state in victim.states {
            fmu.free(state);
        }
        assert_eq!(fmu.reset(), Status::Ok);
        assert_eq!(fmu.everything(), new, "seed {seed}");
        fmu.start(0.0);
        assert_eq!(fmu.sail(0, 2, 0.01), expected, "seed {seed}");
    }
    assert!(steps as u64 > rounds(60), "only {steps} steps were made");
    std::fs::remove_dir_all(folder).expect("our own folder");
}
