//! A host in miniature that calls the exported functions of the linked library.

// Every test program uses a part of it.
#![allow(dead_code, unsafe_code)]

pub mod random;

use fairlead::fmi::abi::*;
use fairlead::fmi::exports::*;
use fairlead::variables::Model;
use model_description::{Causality, Kind, Value, Variable};
use std::ffi::{CStr, CString, c_int, c_void};
use std::path::Path;
use std::ptr;
use std::sync::Mutex;

/// (status, category, message).
pub type Line = (c_int, String, String);

/// What an instance logged.
#[derive(Default)]
pub struct Messages(Mutex<Vec<Line>>);

impl Messages {
    /// Everything since the last call.
    pub fn take(&self) -> Vec<Line> {
        std::mem::take(&mut *self.0.lock().unwrap())
    }
}

unsafe extern "C" fn record(messages: *mut c_void, name: Text, status: c_int, category: Text, message: Text) {
    let read = |text: Text| unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned();
    assert!(!name.is_null());
    unsafe { &*messages.cast::<Messages>() }.0.lock().unwrap().push((status, read(category), read(message)));
}

/// A callback struct whose logger writes to `messages`.
pub fn callbacks(messages: &Messages) -> CallbackFunctions {
    let record: unsafe extern "C" fn(*mut c_void, Text, c_int, Text, Text) = record;
    CallbackFunctions {
        // SAFETY: the fixed arguments of a variadic call arrive as in an ordinary one.
        logger: Some(unsafe { std::mem::transmute::<*const (), LoggerCallback>(record as *const ()) }),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::from_ref(messages).cast_mut().cast(),
    }
}

/// Everything that fmi2Instantiate is given; change what a test is about.
pub struct Request {
    pub name: Option<CString>,
    pub fmu_type: c_int,
    pub guid: Option<CString>,
    pub location: Option<CString>,
    pub debug: Boolean,
}

impl Request {
    pub fn good() -> Self {
        let guid = CString::new(model().guid).unwrap();
        Self { name: Some(c"rope".into()), fmu_type: CO_SIMULATION, guid: Some(guid), location: None, debug: FALSE }
    }

    pub fn send(&self, callbacks: *const CallbackFunctions) -> Component {
        let pointer = |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
        let (name, guid, location) = (pointer(&self.name), pointer(&self.guid), pointer(&self.location));
        unsafe { fmi2Instantiate(name, self.fmu_type, guid, location, callbacks, FALSE, self.debug) }
    }
}

/// The embedded default scene.
pub fn model() -> Model {
    Model::load(None).unwrap()
}

/// An instance of the default scene.
pub struct Fmu {
    pub c: Component,
    pub model: Model,
    pub messages: Box<Messages>,
}

// SAFETY: as FMI has it: any thread, one at a time.
unsafe impl Send for Fmu {}

impl Drop for Fmu {
    fn drop(&mut self) {
        unsafe { fmi2FreeInstance(self.c) }
    }
}

impl Fmu {
    pub fn new() -> Self {
        Self::from(&Request::good())
    }

    pub fn from(request: &Request) -> Self {
        Self::of(model(), request)
    }

    /// An instance of the scene in a folder, otherwise as requested.
    pub fn in_folder(folder: &Path, request: &Request) -> Self {
        let model = Model::load(Some(folder)).unwrap();
        let guid = Some(CString::new(model.guid.clone()).unwrap());
        let location = Some(CString::new(format!("file://{}", folder.display())).unwrap());
        let Request { name, fmu_type, debug, .. } = request;
        Self::of(model, &Request { name: name.clone(), fmu_type: *fmu_type, guid, location, debug: *debug })
    }

    fn of(model: Model, request: &Request) -> Self {
        let messages = Box::<Messages>::default();
        // The struct is gone after the call, as in hosts that keep it on the stack.
        let c = request.send(&callbacks(&messages));
        assert!(!c.is_null(), "{:?}", messages.take());
        Self { c, model, messages }
    }

    /// At the first communication point.
    pub fn started() -> Self {
        let fmu = Self::new();
        fmu.start(0.0);
        fmu
    }

    pub fn start(&self, time: f64) {
        assert_eq!(self.setup(time), Status::Ok);
        assert_eq!(self.enter(), Status::Ok);
        assert_eq!(self.exit(), Status::Ok, "{:?}", self.messages.take());
    }

    pub fn setup(&self, start: f64) -> Status {
        unsafe { fmi2SetupExperiment(self.c, FALSE, 0.0, start, FALSE, 0.0) }
    }

    pub fn enter(&self) -> Status {
        unsafe { fmi2EnterInitializationMode(self.c) }
    }

    pub fn exit(&self) -> Status {
        unsafe { fmi2ExitInitializationMode(self.c) }
    }

    pub fn step(&self, time: f64, step: f64) -> Status {
        unsafe { fmi2DoStep(self.c, time, step, TRUE) }
    }

    pub fn terminate(&self) -> Status {
        unsafe { fmi2Terminate(self.c) }
    }

    pub fn reset(&self) -> Status {
        unsafe { fmi2Reset(self.c) }
    }

    pub fn variable(&self, name: &str) -> &Variable {
        self.model.variables.iter().find(|row| row.name == name).unwrap_or_else(|| panic!("no variable {name}"))
    }

    pub fn reference(&self, name: &str) -> u32 {
        self.variable(name).reference
    }

    pub fn set(&self, name: &str, value: f64) -> Status {
        unsafe { fmi2SetReal(self.c, &self.reference(name), 1, &value) }
    }

    pub fn get(&self, name: &str) -> f64 {
        match self.read(self.variable(name)) {
            Ok(Value::Real(x)) => x,
            other => panic!("{name}: {other:?}"),
        }
    }

    pub fn read(&self, row: &Variable) -> Result<Value, Status> {
        let (vr, mut x, mut n, mut text) = (&raw const row.reference, f64::NAN, -1, ptr::null());
        let status = unsafe {
            match row.kind {
                Kind::Real => fmi2GetReal(self.c, vr, 1, &mut x),
                Kind::Integer => fmi2GetInteger(self.c, vr, 1, &mut n),
                Kind::Boolean => fmi2GetBoolean(self.c, vr, 1, &mut n),
                Kind::String => fmi2GetString(self.c, vr, 1, &mut text),
            }
        };
        if status != Status::Ok {
            return Err(status);
        }
        Ok(match row.kind {
            Kind::Real => Value::Real(x),
            Kind::Integer => Value::Integer(n),
            Kind::Boolean => Value::Boolean(n == TRUE),
            Kind::String => Value::String(unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()),
        })
    }

    /// All variables.
    pub fn everything(&self) -> Vec<Value> {
        self.model.variables.iter().map(|row| self.read(row).unwrap()).collect()
    }

    /// All outputs.
    pub fn outputs(&self) -> Vec<Value> {
        let outputs = self.model.variables.iter().filter(|row| row.causality == Causality::Output);
        outputs.map(|row| self.read(row).unwrap()).collect()
    }

    /// Some motion of the ship, in steps of `step` from `first` to before `last`; all outputs after each step.
    pub fn sail(&self, first: u32, last: u32, step: f64) -> Vec<Vec<Value>> {
        let steps = first..last;
        steps
            .map(|k| {
                let t = f64::from(k) * step;
                let (sin, cos) = (3.0 * t).sin_cos();
                for (name, value) in [("ship.x", 0.002 * (1.0 - cos)), ("ship.vx", 0.006 * sin), ("ship.ax", 0.018 * cos)] {
                    assert_eq!(self.set(name, value), Status::Ok);
                }
                assert!(self.step(t, step) <= Status::Warning, "{:?}", self.messages.take());
                self.outputs()
            })
            .collect()
    }

    pub fn save(&self) -> FmuState {
        let mut state = ptr::null_mut();
        assert_eq!(unsafe { fmi2GetFMUstate(self.c, &mut state) }, Status::Ok);
        state
    }

    pub fn restore(&self, state: FmuState) -> Status {
        unsafe { fmi2SetFMUstate(self.c, state) }
    }

    pub fn free(&self, mut state: FmuState) {
        assert_eq!(unsafe { fmi2FreeFMUstate(self.c, &mut state) }, Status::Ok);
        assert!(state.is_null());
    }

    pub fn serialize(&self, state: FmuState) -> Vec<u8> {
        let mut size = 0;
        assert_eq!(unsafe { fmi2SerializedFMUstateSize(self.c, state, &mut size) }, Status::Ok);
        let mut bytes = vec![0; size];
        assert_eq!(unsafe { fmi2SerializeFMUstate(self.c, state, bytes.as_mut_ptr(), size) }, Status::Ok);
        bytes
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<FmuState, Status> {
        let mut state = ptr::null_mut();
        match unsafe { fmi2DeSerializeFMUstate(self.c, bytes.as_ptr(), bytes.len(), &mut state) } {
            Status::Ok => Ok(state),
            status => {
                assert!(state.is_null());
                Err(status)
            }
        }
    }

    /// Asserts that the call was refused with fmi2Error and one log line that says so with these words.
    #[track_caller]
    pub fn refused(&self, status: Status, words: &[&str]) {
        assert_eq!(status, Status::Error);
        let lines = self.messages.take();
        let (_, category, text) = lines.last().expect("a refusal is logged");
        assert_eq!(category, "logStatusError");
        for word in words {
            assert!(text.contains(word), "'{word}' is not in: {text}");
        }
    }
}
