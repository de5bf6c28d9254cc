//! The life of an instance: right order, wrong order, and what it is told on the way.
#![allow(unsafe_code)]

mod harness;

use fairlead::fmi::abi::*;
use fairlead::fmi::exports::*;
use harness::{Fmu, Messages, Request, callbacks};
use model_description::{Causality, Value};
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

#[test]
fn version_and_platform() {
    let text = |pointer| unsafe { CStr::from_ptr(pointer) };
    assert_eq!(text(fmi2GetVersion()), c"2.0");
    assert_eq!(text(fmi2GetTypesPlatform()), c"default");
}

#[test]
fn a_run_from_begin_to_end() {
    let fmu = Fmu::new();
    fmu.start(0.0);
    let before = fmu.get("winch.tension");
    assert!(before.is_finite() && before > 0.0);
    fmu.sail(0, 5, 0.02);
    assert_eq!(fmu.terminate(), Status::Ok);
    assert!(fmu.get("winch.tension").is_finite());
}

#[test]
fn a_request_that_is_wrong_is_refused_with_the_reason() {
    let none = || Request { name: None, ..Request::good() };
    let cases: [(Request, &str); 7] = [
        (Request { name: Some(c"".into()), ..Request::good() }, "name"),
        (none(), "name"),
        (Request { fmu_type: 0, ..Request::good() }, "fmi2CoSimulation"),
        (Request { guid: Some(c"{other}".into()), ..Request::good() }, "{other}"),
        (Request { guid: None, ..Request::good() }, "GUID"),
        (Request { location: Some(c"http://x/y".into()), ..Request::good() }, "http://x/y"),
        (Request { location: Some(c"file:///no/such/folder".into()), ..Request::good() }, "/no/such/folder"),
    ];
    for (request, word) in cases {
        let messages = Messages::default();
        assert!(request.send(&callbacks(&messages)).is_null());
        let lines = messages.take();
        assert!(
            lines.iter().any(|(status, category, text)| *status == 3 && category == "logStatusError" && text.contains(word)),
            "{lines:?}"
        );
        // Without anybody to tell it to, it is refused all the same.
        assert!(request.send(null()).is_null());
    }
}

#[test]
fn callbacks_may_be_missing() {
    let messages = Messages::default();
    let silent = CallbackFunctions { logger: None, ..callbacks(&messages) };
    for callbacks in [null(), &raw const silent] {
        let c = Request { debug: TRUE, ..Request::good() }.send(callbacks);
        assert!(!c.is_null());
        unsafe {
            assert_eq!(fmi2DoStep(c, 0.0, 0.1, TRUE), Status::Error);
            fmi2FreeInstance(c);
        }
    }
    assert!(messages.take().is_empty());
}

type Call = (&'static str, &'static str, fn(&Fmu) -> Status);

/// One call of every function that takes an instance, harmless where it is allowed, and the phases that allow it:
/// I(nstantiated), (i)N(itialization), S(tepping), F(ailed), T(erminated).
fn calls() -> Vec<Call> {
    vec![
        ("fmi2SetDebugLogging", "INSFT", |f| unsafe { fmi2SetDebugLogging(f.c, TRUE, 0, null()) }),
        ("fmi2SetupExperiment", "I", |f| f.setup(0.0)),
        ("fmi2GetReal", "INSFT", |f| unsafe { fmi2GetReal(f.c, null(), 0, null_mut()) }),
        ("fmi2GetInteger", "INSFT", |f| unsafe { fmi2GetInteger(f.c, null(), 0, null_mut()) }),
        ("fmi2GetBoolean", "INSFT", |f| unsafe { fmi2GetBoolean(f.c, null(), 0, null_mut()) }),
        ("fmi2GetString", "INSFT", |f| unsafe { fmi2GetString(f.c, null(), 0, null_mut()) }),
        ("fmi2SetReal", "INS", |f| unsafe { fmi2SetReal(f.c, null(), 0, null()) }),
        ("fmi2SetInteger", "INS", |f| unsafe { fmi2SetInteger(f.c, null(), 0, null()) }),
        ("fmi2SetBoolean", "INS", |f| unsafe { fmi2SetBoolean(f.c, null(), 0, null()) }),
        ("fmi2SetString", "INS", |f| unsafe { fmi2SetString(f.c, null(), 0, null()) }),
        ("fmi2SetRealInputDerivatives", "INS", |f| unsafe { fmi2SetRealInputDerivatives(f.c, null(), 0, null(), null()) }),
        ("fmi2GetRealOutputDerivatives", "SFT", |f| unsafe { fmi2GetRealOutputDerivatives(f.c, null(), 0, null(), null_mut()) }),
        ("fmi2GetDirectionalDerivative", "NSFT", |f| unsafe {
            fmi2GetDirectionalDerivative(f.c, null(), 0, null(), 0, null(), null_mut())
        }),
        ("fmi2GetFMUstate", "INSFT", |f| {
            let state = f.save();
            f.free(state);
            Status::Ok
        }),
        ("fmi2CancelStep", "", |f| unsafe { fmi2CancelStep(f.c) }),
        ("fmi2GetRealStatus", "SFT", |f| unsafe { fmi2GetRealStatus(f.c, LAST_SUCCESSFUL_TIME, &mut 0.0) }),
        ("fmi2GetBooleanStatus", "SFT", |f| unsafe { fmi2GetBooleanStatus(f.c, TERMINATED, &mut 0) }),
        ("fmi2DoStep", "S", |f| f.step(0.0, 0.01)),
        // These change the phase where they are allowed, so they are tried only where they are not.
        ("fmi2EnterInitializationMode", "I!", Fmu::enter),
        ("fmi2ExitInitializationMode", "N!", Fmu::exit),
        ("fmi2Terminate", "S!", Fmu::terminate),
    ]
}

#[test]
fn every_function_in_every_phase() {
    let phases: [(char, fn() -> Fmu); 5] = [
        ('I', Fmu::new),
        ('N', || {
            let fmu = Fmu::new();
            assert_eq!(fmu.enter(), Status::Ok);
            fmu
        }),
        ('S', Fmu::started),
        ('F', || {
            let fmu = Fmu::new();
            assert_eq!(fmu.set("body.mass", -1.0), Status::Ok);
            assert_eq!(fmu.enter(), Status::Ok);
            fmu.refused(fmu.exit(), &["body.mass"]);
            fmu
        }),
        ('T', || {
            let fmu = Fmu::started();
            assert_eq!(fmu.terminate(), Status::Ok);
            fmu
        }),
    ];
    for (phase, arrive) in phases {
        let fmu = arrive();
        for (name, allowed, call) in calls() {
            if allowed.contains(phase) {
                assert!(allowed.ends_with('!') || call(&fmu) == Status::Ok, "{name} in {phase}");
            } else {
                let before = fmu.everything();
                fmu.refused(call(&fmu), &[name]);
                assert_eq!(before, fmu.everything(), "{name} in {phase} changed something");
            }
        }
        assert_eq!(fmu.reset(), Status::Ok);
        fmu.start(0.0);
    }
}

#[test]
fn no_instance_no_crash() {
    let nobody = Fmu { c: null_mut(), model: harness::model(), messages: Box::default() };
    for (name, _, call) in calls() {
        if name != "fmi2GetFMUstate" {
            assert_eq!(call(&nobody), Status::Error, "{name}");
        }
    }
    let mut state = null_mut();
    unsafe {
        assert_eq!(fmi2GetFMUstate(null_mut(), &mut state), Status::Error);
        assert_eq!(fmi2Reset(null_mut()), Status::Error);
        let mut foreign = [0x1234_5678_9abc_def0_u64; 64];
        assert_eq!(fmi2Reset(foreign.as_mut_ptr().cast()), Status::Error);
        fmi2FreeInstance(foreign.as_mut_ptr().cast());
        fmi2FreeInstance(null_mut());
    }
}

#[test]
fn null_arrays_are_refused() {
    let fmu = Fmu::started();
    let vr = [fmu.reference("ship.x")];
    let texts = [null()];
    unsafe {
        fmu.refused(fmi2GetReal(fmu.c, vr.as_ptr(), 1, null_mut()), &["NULL"]);
        fmu.refused(fmi2GetReal(fmu.c, null(), 1, &mut 0.0), &["NULL"]);
        fmu.refused(fmi2SetReal(fmu.c, vr.as_ptr(), 1, null()), &["NULL"]);
        fmu.refused(fmi2SetString(fmu.c, vr.as_ptr(), 1, texts.as_ptr()), &["fmi2SetString"]);
        fmu.refused(fmi2SetDebugLogging(fmu.c, TRUE, 1, texts.as_ptr()), &["NULL"]);
        fmu.refused(fmi2SetRealInputDerivatives(fmu.c, vr.as_ptr(), 1, null(), &1.0), &["NULL"]);
        fmu.refused(fmi2GetFMUstate(fmu.c, null_mut()), &["NULL"]);
        fmu.refused(fmi2SetFMUstate(fmu.c, null_mut()), &["NULL"]);
        fmu.refused(fmi2GetRealStatus(fmu.c, LAST_SUCCESSFUL_TIME, null_mut()), &["NULL"]);
        assert_eq!(fmi2FreeFMUstate(fmu.c, null_mut()), Status::Ok);
    }
    fmu.sail(0, 1, 0.01);
}

#[test]
fn values_that_are_refused_leave_no_trace() {
    let fmu = Fmu::started();
    assert_eq!(fmu.set("ship.y", 0.001), Status::Ok);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        fmu.refused(fmu.set("ship.x", bad), &["ship.x", "finite"]);
    }
    let references = [fmu.reference("ship.y"), fmu.reference("ship.x")];
    unsafe {
        fmu.refused(fmi2SetReal(fmu.c, references.as_ptr(), 2, [0.5, f64::NAN].as_ptr()), &["ship.x"]);
        fmu.refused(fmi2SetReal(fmu.c, [references[0], 0xffff_fff0].as_ptr(), 2, [0.5, 0.5].as_ptr()), &["4294967280"]);
        fmu.refused(fmi2GetReal(fmu.c, &0xffff_fff0, 1, &mut 0.0), &["4294967280"]);
        fmu.refused(fmi2SetInteger(fmu.c, &fmu.reference("status.code"), 1, &1), &["status.code", "output"]);
    }
    fmu.refused(fmu.set("winch.tension", 1.0), &["winch.tension", "output"]);
    fmu.refused(fmu.set("body.mass", 5000.0), &["body.mass", "fixed"]);
    assert_eq!([fmu.get("ship.x"), fmu.get("ship.y")], [0.0, 0.001]);
    fmu.sail(0, 2, 0.01);
}

#[test]
fn steps_that_are_refused_leave_the_state_alone() {
    let fmu = Fmu::new();
    assert_eq!(unsafe { fmi2SetupExperiment(fmu.c, FALSE, 0.0, 0.0, TRUE, 0.1) }, Status::Ok);
    assert_eq!(fmu.enter(), Status::Ok);
    assert_eq!(fmu.exit(), Status::Ok);
    let before = fmu.everything();
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        fmu.refused(fmu.step(0.0, step), &["step size"]);
    }
    for point in [0.01, -0.01, f64::NAN, f64::INFINITY] {
        fmu.refused(fmu.step(point, 0.01), &["communication point"]);
    }
    fmu.refused(fmu.step(0.0, 0.2), &["stop time"]);
    assert_eq!(before, fmu.everything());
    // Rounded times are the host's right.
    assert_eq!(fmu.step(1e-12, 0.05), Status::Ok);
    assert_eq!(fmu.step(0.05 - 1e-12, 0.05 + 2e-12), Status::Ok);
    fmu.refused(fmu.step(0.1, 0.01), &["stop time"]);
    let mut time = 0.0;
    assert_eq!(unsafe { fmi2GetRealStatus(fmu.c, LAST_SUCCESSFUL_TIME, &mut time) }, Status::Ok);
    assert!((time - 0.1).abs() < 1e-11);
}

#[test]
fn status_queries() {
    let fmu = Fmu::started();
    let mut ended = TRUE;
    unsafe {
        assert_eq!(fmi2GetBooleanStatus(fmu.c, TERMINATED, &mut ended), Status::Ok);
        assert_eq!(ended, FALSE);
        assert_eq!(fmi2GetStatus(fmu.c, DO_STEP_STATUS, &mut Status::Ok), Status::Discard);
        assert_eq!(fmi2GetStringStatus(fmu.c, PENDING_STATUS, &mut null()), Status::Discard);
        assert_eq!(fmi2GetIntegerStatus(fmu.c, PENDING_STATUS, &mut 0), Status::Discard);
        assert_eq!(fmi2GetRealStatus(fmu.c, TERMINATED, &mut 0.0), Status::Discard);
        assert_eq!(fmi2GetRealStatus(fmu.c, 99, &mut 0.0), Status::Error);
    }
}

#[test]
fn set_up_any_time_and_again() {
    let fmu = Fmu::new();
    let setup = |tolerance: f64, start, stop| unsafe { fmi2SetupExperiment(fmu.c, TRUE, tolerance, start, TRUE, stop) };
    for (tolerance, start, stop, word) in [
        (1e-3, f64::NAN, 1.0, "start time"),
        (1e-3, 1.0, 0.0, "stop time"),
        (0.0, 0.0, 1.0, "tolerance"),
        (f64::NAN, 0.0, 1.0, "tolerance"),
    ] {
        fmu.refused(setup(tolerance, start, stop), &[word]);
    }
    assert_eq!(setup(1e-4, 5.0, 6.0), Status::Ok);
    assert_eq!(fmu.get("solver.tolerance"), 1e-4);
    fmu.start(-3.0);
    assert_eq!(fmu.step(-3.0, 0.01), Status::Ok);
    assert_eq!(fmu.step(-2.99, 0.01), Status::Ok);
}

#[test]
fn a_fresh_instance_has_the_start_values() {
    let fmu = Fmu::new();
    for row in &fmu.model.variables {
        let value = fmu.read(row).unwrap();
        match &row.start {
            Some(start) => assert_eq!(&value, start, "{}", row.name),
            None => assert!([Value::Real(0.0), Value::Integer(0), Value::Boolean(false), Value::String(String::new())].contains(&value)),
        }
    }
}

#[test]
fn outputs_are_right_in_initialization_mode() {
    let fmu = Fmu::new();
    assert_eq!(fmu.enter(), Status::Ok);
    let first = fmu.everything();
    assert_eq!(first, fmu.everything());
    assert_eq!(fmu.set("ship.x", 0.01), Status::Ok);
    let moved = fmu.everything();
    assert_ne!(first, moved);
    assert_eq!(fmu.exit(), Status::Ok);
    assert_eq!(moved, fmu.everything());
    // It makes no difference whether anybody looked.
    let blind = Fmu::new();
    assert_eq!(blind.set("ship.x", 0.01), Status::Ok);
    blind.start(0.0);
    assert_eq!(moved, blind.everything());
    assert_eq!(fmu.sail(0, 3, 0.01), blind.sail(0, 3, 0.01));
}

#[test]
fn reset_is_like_new() {
    let fresh = Fmu::new();
    let fmu = Fmu::new();
    for name in ["body.mass", "solver.tolerance"] {
        assert_eq!(fmu.set(name, 0.9 * fmu.get(name)), Status::Ok);
    }
    fmu.start(2.0);
    assert_eq!(fmu.step(2.0, 0.01), Status::Ok);
    assert_eq!(fmu.terminate(), Status::Ok);
    assert_eq!(fmu.reset(), Status::Ok);
    assert_eq!(fmu.everything(), fresh.everything());
    fmu.start(0.0);
    fresh.start(0.0);
    assert_eq!(fmu.sail(0, 5, 0.01), fresh.sail(0, 5, 0.01));
}

#[test]
fn parameters_take_effect() {
    let fmu = Fmu::new();
    let tunable = fmu.model.variables.iter().find(|row| row.name == "winch.gain_position").unwrap().clone();
    assert_eq!(fmu.set("body.mass", 2.0 * fmu.get("body.mass")), Status::Ok);
    fmu.start(0.0);
    let plain = Fmu::started();
    assert_ne!(fmu.sail(0, 5, 0.01), plain.sail(0, 5, 0.01));
    // Tunable ones at communication points too, refused ones at the step, which can be repeated.
    assert_eq!(fmu.set(&tunable.name, 150.0), Status::Ok);
    assert_eq!(fmu.step(0.05, 0.01), Status::Ok);
    let before = fmu.outputs();
    assert_eq!(fmu.set(&tunable.name, -1.0), Status::Ok);
    fmu.refused(fmu.step(0.06, 0.01), &[&tunable.name]);
    assert_eq!(before, fmu.outputs());
    assert_eq!(fmu.set(&tunable.name, 150.0), Status::Ok);
    assert_eq!(fmu.step(0.06, 0.01), Status::Ok);
}

#[test]
fn input_derivatives_hold_for_one_step() {
    let fmu = Fmu::started();
    let plain = Fmu::started();
    let send = |order: i32, value: f64, name: &str| unsafe { fmi2SetRealInputDerivatives(fmu.c, &fmu.reference(name), 1, &order, &value) };
    fmu.refused(send(0, 1.0, "ship.x"), &["order 0"]);
    fmu.refused(send(3, 1.0, "ship.x"), &["order 3"]);
    fmu.refused(send(1, f64::NAN, "ship.x"), &["finite"]);
    fmu.refused(send(1, 1.0, "winch.tension"), &["no input"]);
    assert_eq!(fmu.sail(0, 1, 0.01), plain.sail(0, 1, 0.01));
    // They count in the next step, and only there: the same steps without them, from the same state, differ in the first.
    let saved = fmu.save();
    let steps = |derivative: bool| {
        assert_eq!(fmu.restore(saved), Status::Ok);
        assert!(!derivative || send(1, 0.05, "ship.x") == Status::Ok);
        assert!(fmu.step(0.01, 0.01) <= Status::Warning);
        (fmu.outputs(), fmu.save())
    };
    let ((without, a), (with, b)) = (steps(false), steps(true));
    assert_ne!(without, with);
    let expired = |state| {
        assert_eq!(fmu.restore(state), Status::Ok);
        assert_eq!(send(1, 0.05, "ship.x"), Status::Ok);
        let set = fmu.save();
        let differs = fmu.serialize(set) != fmu.serialize(state);
        fmu.free(set);
        differs
    };
    assert!(expired(a) && expired(b));
    [saved, a, b].into_iter().for_each(|state| fmu.free(state));
}

#[test]
fn derivatives_of_outputs_are_refused_with_their_names() {
    let fmu = Fmu::started();
    let rate = |name: &str, order: i32| unsafe { fmi2GetRealOutputDerivatives(fmu.c, &fmu.reference(name), 1, &order, &mut 0.0) };
    fmu.refused(rate("winch.tension", 2), &["winch.tension", "order 2", "expected 1"]);
    fmu.refused(rate("winch.tension", 0), &["winch.tension", "order 0"]);
    fmu.refused(rate("solver.energy_error", 1), &["solver.energy_error", "no derivatives"]);
    fmu.refused(rate("ship.x", 1), &["ship.x", "no output"]);
    assert_eq!(rate("winch.tension", 1), Status::Ok);
    let by = |unknown: &str, known: &str, seed: f64| unsafe {
        fmi2GetDirectionalDerivative(fmu.c, &fmu.reference(unknown), 1, &fmu.reference(known), 1, &seed, &mut 0.0)
    };
    fmu.refused(by("winch.tension", "ship.x", 1.0), &["after a step"]);
    fmu.sail(0, 1, 0.01);
    fmu.refused(by("winch.tension", "body.x", 1.0), &["body.x", "no input"]);
    fmu.refused(by("ship.x", "ship.x", 1.0), &["ship.x", "no output"]);
    fmu.refused(by("winch.tension", "ship.x", f64::NAN), &["ship.x", "finite"]);
    assert_eq!(by("winch.tension", "ship.x", 1.0), Status::Ok);
    // Nothing is asked along no direction.
    assert_eq!(by("winch.tension", "ship.x", 0.0), Status::Ok);
}

/// Rates are part of the state: a restored instance has them to the bit, and asking changes nothing.
#[test]
fn exact_rates_come_back_with_the_state() {
    let (fmu, other) = (Fmu::started(), Fmu::new());
    fmu.sail(0, 5, 0.01);
    let rates = |fmu: &Fmu| {
        let references = ["winch.tension", "winch.rate", "body.tension", "body.vx", "ship.force.z"].map(|name| fmu.reference(name));
        let mut values = [f64::NAN; 5];
        assert_eq!(
            unsafe { fmi2GetRealOutputDerivatives(fmu.c, references.as_ptr(), 5, [1; 5].as_ptr(), values.as_mut_ptr()) },
            Status::Ok
        );
        values.map(f64::to_bits)
    };
    let state = fmu.save();
    let expected = rates(&fmu);
    assert_eq!(other.restore(state), Status::Ok);
    assert_eq!(rates(&other), expected);
    assert_eq!(other.sail(5, 7, 0.01), fmu.sail(5, 7, 0.01));
    fmu.free(state);
}

#[test]
fn text_stays_until_it_is_read_again() {
    let fmu = Fmu::started();
    let (vr, mut texts) = (fmu.reference("status.message"), [null(); 2]);
    unsafe {
        assert_eq!(fmi2GetString(fmu.c, [vr, vr].as_ptr(), 2, texts.as_mut_ptr()), Status::Ok);
        fmu.sail(0, 2, 0.01);
        assert_eq!(CStr::from_ptr(texts[0]), CStr::from_ptr(texts[1]));
    }
}

#[test]
fn the_log_is_what_was_asked_for() {
    let quiet = Fmu::started();
    assert!(quiet.messages.take().is_empty());

    let verbose = Fmu::from(&Request { debug: TRUE, name: Some(CString::new("100 % #r1#").unwrap()), ..Request::good() });
    verbose.start(0.0);
    verbose.sail(0, 2, 0.01);
    verbose.refused(verbose.set("ship.x", f64::NAN), &["ship.x"]);
    let select = |on: Boolean, names: &[*const i8]| unsafe { fmi2SetDebugLogging(verbose.c, on, names.len(), names.as_ptr().cast()) };
    let name = |text: &CStr| text.as_ptr().cast::<i8>();
    verbose.refused(select(TRUE, &[name(c"logEvents"), name(c"logNothing")]), &["logNothing", "logEvents"]);

    assert_eq!(select(TRUE, &[name(c"logEvents")]), Status::Ok);
    verbose.sail(2, 3, 0.01);
    assert_eq!(verbose.set("ship.x", f64::NAN), Status::Error);
    assert!(verbose.messages.take().is_empty());
    assert_eq!(verbose.terminate(), Status::Ok);
    assert_eq!(verbose.messages.take().len(), 1);
    assert_eq!(select(FALSE, &[]), Status::Ok);
    assert_eq!(verbose.reset(), Status::Ok);
    assert!(verbose.messages.take().is_empty());
}

#[test]
fn log_lines_have_listed_categories_and_nothing_to_format() {
    let fmu = Fmu::from(&Request { debug: TRUE, ..Request::good() });
    fmu.start(0.0);
    fmu.sail(0, 2, 0.01);
    assert_eq!(fmu.set("winch.tension", 1.0), Status::Error);
    let listed: Vec<_> = model_description::LOG_CATEGORIES.iter().map(|(name, _)| *name).collect();
    let known: Vec<_> = fairlead::fmi::Category::ALL.iter().map(|category| category.name().to_str().unwrap()).collect();
    assert_eq!(listed, known);
    let lines = fmu.messages.take();
    assert!(lines.iter().any(|(_, category, _)| category == "logEvents") && lines.iter().any(|(_, category, _)| category == "logSolver"));
    for (_, category, text) in lines {
        assert!(listed.contains(&category.as_str()));
        assert!(!text.is_empty() && !text.contains(['%', '#', '\n']), "{text}");
    }
}

/// Values far outside of anything sensible: whatever the status, the instance lives, and says finite things.
#[test]
fn absurd_inputs_do_no_lasting_harm() {
    let fmu = Fmu::started();
    fmu.sail(0, 2, 0.01);
    let cases = [
        ("ship.x", 1e9),
        ("ship.vx", 1e300),
        ("winch.setpoint", -1e12),
        // These once made a path of as many pieces as memory has room for.
        ("winch.gain_rate", 1e300),
        ("winch.gain_position", 1e300),
        // The outputs of a step once overflowed and were given out.
        ("current.x", 1e200),
    ];
    for (name, value) in cases {
        let good = fmu.save();
        assert_eq!(fmu.set(name, value), Status::Ok);
        assert!(fmu.step(0.02, 0.01) <= Status::Error);
        let outputs = fmu.model.variables.iter().filter(|row| row.causality == Causality::Output);
        for row in outputs {
            assert!(!matches!(fmu.read(row), Ok(Value::Real(x)) if !x.is_finite()), "{}", row.name);
        }
        assert_eq!(fmu.restore(good), Status::Ok);
        fmu.free(good);
    }
    fmu.sail(2, 4, 0.01);
}
