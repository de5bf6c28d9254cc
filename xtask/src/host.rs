//! A small FMI 2.0 co-simulation importer: what a host does with a packed FMU, through its C interface.

#![allow(unsafe_code)]
// Commands, benches and tests use different parts of it.
#![allow(dead_code)]

mod api;
mod description;

pub use description::{Description, Variable};

use crate::error::{Failure, at};
use api::Api;
use fairlead::fmi::abi::*;
use model_description::Kind;
use std::ffi::{CStr, CString, c_int};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::ptr;
use std::sync::{Arc, Mutex, PoisonError};
use tempfile::TempDir;
use zip::ZipArchive;

/// An unpacked FMU with its library loaded; the folder is removed when it is dropped.
pub struct Fmu {
    /// Of modelDescription.xml.
    pub description: Arc<Description>,
    api: Arc<Api>,
    folder: TempDir,
}

impl Fmu {
    /// Unpacks, reads and loads.
    ///
    /// # Errors
    /// Says why the file is no FMU that runs here.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let file = File::open(path).map_err(|e| at(path, format!("{e}; expected an .fmu file")))?;
        let mut archive = ZipArchive::new(file).map_err(|e| at(path, format!("{e}; expected an .fmu file, which is a zip archive")))?;
        let folder = tempfile::Builder::new().prefix("fairlead-").tempdir().map_err(|e| at(path, format!("cannot unpack it: {e}")))?;
        archive.extract(folder.path()).map_err(|e| at(path, format!("cannot unpack it: {e}")))?;
        let xml = fs::read_to_string(folder.path().join("modelDescription.xml"))
            .map_err(|e| at(path, format!("modelDescription.xml: {e}; expected it at the archive's root")))?;
        let description = Description::parse(&xml).map_err(|e| at(path, e))?;
        let library = library(folder.path(), &description.identifier).map_err(|e| at(path, e))?;
        let api = Api::load(&library)?;
        // SAFETY: the function returns a static string, if anything.
        let version = unsafe { text((api.version)()) };
        if version != "2.0" {
            return Err(at(path, format!("fmi2GetVersion says '{version}'; expected '2.0'")));
        }
        Ok(Self { description: Arc::new(description), api: Arc::new(api), folder })
    }

    /// The text of a file in the resources folder, if there is one.
    pub fn resource(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.folder.path().join("resources").join(name)).ok()
    }

    /// A new instance.
    ///
    /// # Errors
    /// The FMU's own reasons.
    pub fn instantiate(&self, name: &str) -> Result<Instance, Failure> {
        let messages = Arc::new(Messages::default());
        let callbacks = CallbackFunctions {
            logger: Some(logger()),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: Arc::as_ptr(&messages).cast_mut().cast(),
        };
        let arguments = [name, &self.description.guid, &resources(self.folder.path())].map(CString::new);
        let [Ok(name), Ok(guid), Ok(location)] = arguments else {
            return Err(Failure("instance name, GUID or folder contains a NUL character".into()));
        };
        let (name, guid, location) = (name.as_ptr(), guid.as_ptr(), location.as_ptr());
        // SAFETY: strings and struct live during the call; the messages live as long as the instance.
        let component = unsafe { (self.api.instantiate)(name, CO_SIMULATION, guid, location, &raw const callbacks, FALSE, FALSE) };
        if component.is_null() {
            return Err(Failure(format!("fmi2Instantiate of {} failed: {}", self.description.model_name, messages.take())));
        }
        Ok(Instance { component, api: Arc::clone(&self.api), description: Arc::clone(&self.description), messages })
    }
}

/// This platform's library in an unpacked FMU.
fn library(folder: &Path, identifier: &str) -> Result<PathBuf, Failure> {
    let bits = if cfg!(target_pointer_width = "64") { "64" } else { "32" };
    let (platform, ending) = match std::env::consts::OS {
        "windows" => (format!("win{bits}"), "dll"),
        "macos" => (format!("darwin{bits}"), "dylib"),
        os => (format!("{os}{bits}"), "so"),
    };
    let tuple = format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS);
    // The folders of FMI 2.0 say nothing of the processor; others than x86 go by their tuple's name.
    let platform = if cfg!(any(target_arch = "x86_64", target_arch = "x86")) { platform } else { tuple };
    let inside = format!("binaries/{platform}/{identifier}.{ending}");
    let path = folder.join(&inside);
    if path.is_file() { Ok(path) } else { Err(Failure(format!("has no {inside}; it was not packed for this machine"))) }
}

/// The URI of the resources folder.
fn resources(folder: &Path) -> String {
    let path = folder.join("resources");
    let text = path.to_string_lossy().replace('\\', "/");
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' | b':' => uri.push(char::from(byte)),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

/// What the FMU logged since somebody last looked.
#[derive(Default)]
struct Messages(Mutex<Vec<String>>);

impl Messages {
    fn push(&self, message: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }

    fn take(&self) -> String {
        let messages = std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner));
        if messages.is_empty() { "the FMU gave no reason".into() } else { messages.join("; ") }
    }

    fn clear(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }
}

/// Stable Rust cannot define variadic functions, but it can be one's callee: on every platform at hand the fixed arguments
/// arrive as in an ordinary call. Formats are shown as they are; fairlead sends no arguments.
fn logger() -> LoggerCallback {
    unsafe extern "C" fn log(messages: ComponentEnvironment, _instance: Text, _status: c_int, _category: Text, message: Text) {
        // SAFETY: the environment is the `Messages` of the living instance, the message a C string.
        unsafe {
            if let Some(messages) = messages.cast::<Messages>().as_ref() {
                messages.push(text(message));
            }
        }
    }
    let log: unsafe extern "C" fn(ComponentEnvironment, Text, c_int, Text, Text) = log;
    // SAFETY: see above.
    unsafe { std::mem::transmute(log) }
}

/// A C string's content; empty for NULL.
///
/// # Safety
/// A pointer that is not NULL must be to a C string.
unsafe fn text(pointer: Text) -> String {
    // SAFETY: as the caller says.
    if pointer.is_null() { String::new() } else { unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned() }
}

/// One instance; freed when dropped.
pub struct Instance {
    component: Component,
    api: Arc<Api>,
    /// Of its FMU.
    pub description: Arc<Description>,
    messages: Arc<Messages>,
}

// SAFETY: FMI lets any thread use an instance, one at a time; `Instance` is not Sync.
unsafe impl Send for Instance {}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: from fmi2Instantiate, freed only here.
        unsafe { (self.api.free_instance)(self.component) }
    }
}

/// A saved state; freed when dropped.
pub struct State<'a> {
    pointer: FmuState,
    owner: &'a Instance,
}

impl Drop for State<'_> {
    fn drop(&mut self) {
        // SAFETY: from the owner, which still lives; freed only here.
        unsafe { (self.owner.api.free_state)(self.owner.component, &raw mut self.pointer) };
    }
}

impl Instance {
    /// OK or a warning, which is printed; anything else is a failure with what the FMU logged.
    fn check(&self, function: &str, status: c_int) -> Result<(), Failure> {
        let name = match status {
            0 => {
                self.messages.clear();
                return Ok(());
            }
            1 => {
                eprintln!("warning: {}", self.messages.take());
                return Ok(());
            }
            2 => "fmi2Discard",
            3 => "fmi2Error",
            4 => "fmi2Fatal",
            5 => "fmi2Pending",
            _ => "an unknown status",
        };
        // Some FMUs, ours among them, put the function's name into their messages.
        let reason = self.messages.take().replace(&format!("{function}: "), "");
        Err(Failure(format!("{function} returned {name}: {reason}")))
    }

    /// fmi2SetupExperiment.
    pub fn setup(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Result<(), Failure> {
        let flag = |value: Option<f64>| Boolean::from(value.is_some());
        let (t, s) = (tolerance.unwrap_or(0.0), stop.unwrap_or(0.0));
        // SAFETY: a living instance.
        self.check("fmi2SetupExperiment", unsafe { (self.api.setup_experiment)(self.component, flag(tolerance), t, start, flag(stop), s) })
    }

    /// fmi2EnterInitializationMode.
    pub fn enter_initialization(&self) -> Result<(), Failure> {
        // SAFETY: a living instance.
        self.check("fmi2EnterInitializationMode", unsafe { (self.api.enter_initialization)(self.component) })
    }

    /// fmi2ExitInitializationMode.
    pub fn exit_initialization(&self) -> Result<(), Failure> {
        // SAFETY: a living instance.
        self.check("fmi2ExitInitializationMode", unsafe { (self.api.exit_initialization)(self.component) })
    }

    /// fmi2Terminate.
    pub fn terminate(&self) -> Result<(), Failure> {
        // SAFETY: a living instance.
        self.check("fmi2Terminate", unsafe { (self.api.terminate)(self.component) })
    }

    /// fmi2Reset.
    pub fn reset(&self) -> Result<(), Failure> {
        // SAFETY: a living instance.
        self.check("fmi2Reset", unsafe { (self.api.reset)(self.component) })
    }

    /// fmi2DoStep.
    pub fn do_step(&self, time: f64, step: f64) -> Result<(), Failure> {
        // SAFETY: a living instance.
        self.check("fmi2DoStep", unsafe { (self.api.do_step)(self.component, time, step, TRUE) })
    }

    /// fmi2LastSuccessfulTime.
    pub fn last_successful_time(&self) -> Result<f64, Failure> {
        let mut time = f64::NAN;
        // SAFETY: a living instance and a place to write.
        self.check("fmi2GetRealStatus", unsafe { (self.api.real_status)(self.component, LAST_SUCCESSFUL_TIME, &raw mut time) })?;
        Ok(time)
    }

    /// fmi2GetReal by value references.
    pub fn get_reals(&self, references: &[ValueReference], values: &mut [f64]) -> Result<(), Failure> {
        assert_eq!(references.len(), values.len());
        // SAFETY: a living instance, arrays of equal length.
        self.check("fmi2GetReal", unsafe {
            (self.api.get_real)(self.component, references.as_ptr(), references.len(), values.as_mut_ptr())
        })
    }

    /// fmi2SetReal by value references.
    pub fn set_reals(&self, references: &[ValueReference], values: &[f64]) -> Result<(), Failure> {
        assert_eq!(references.len(), values.len());
        // SAFETY: a living instance, arrays of equal length.
        self.check("fmi2SetReal", unsafe { (self.api.set_real)(self.component, references.as_ptr(), references.len(), values.as_ptr()) })
    }

    /// fmi2SetRealInputDerivatives of one order by value references.
    pub fn set_input_derivatives(&self, references: &[ValueReference], order: i32, values: &[f64]) -> Result<(), Failure> {
        assert_eq!(references.len(), values.len());
        let orders = vec![order; references.len()];
        // SAFETY: a living instance, arrays of equal length.
        self.check("fmi2SetRealInputDerivatives", unsafe {
            let (count, orders) = (references.len(), orders.as_ptr());
            (self.api.set_input_derivatives)(self.component, references.as_ptr(), count, orders, values.as_ptr())
        })
    }

    /// A number, whole number or Boolean (0 or 1) by name.
    pub fn get(&self, name: &str) -> Result<f64, Failure> {
        self.read(self.description.variable(name)?)
    }

    /// A number, whole number or Boolean (0 or 1).
    pub fn read(&self, variable: &Variable) -> Result<f64, Failure> {
        let (reference, mut real, mut integer) = (&raw const variable.reference, f64::NAN, 0);
        // SAFETY: a living instance, one value reference and one value.
        unsafe {
            match variable.kind {
                Kind::Real => self.check("fmi2GetReal", (self.api.get_real)(self.component, reference, 1, &raw mut real))?,
                Kind::Integer => self.check("fmi2GetInteger", (self.api.get_integer)(self.component, reference, 1, &raw mut integer))?,
                Kind::Boolean => self.check("fmi2GetBoolean", (self.api.get_boolean)(self.component, reference, 1, &raw mut integer))?,
                Kind::String => return Err(Failure(format!("{} is a string; expected a number", variable.name))),
            }
        }
        Ok(if variable.kind == Kind::Real { real } else { f64::from(integer) })
    }

    /// A String variable by name.
    pub fn get_text(&self, name: &str) -> Result<String, Failure> {
        let (variable, mut pointer) = (self.description.variable(name)?, ptr::null());
        // SAFETY: a living instance, one value reference and one value; the pointer is good until the next call.
        unsafe {
            let status = (self.api.get_string)(self.component, &raw const variable.reference, 1, &raw mut pointer);
            self.check("fmi2GetString", status)?;
            Ok(text(pointer))
        }
    }

    /// Sets a variable of any type by name.
    pub fn set(&self, name: &str, value: f64) -> Result<(), Failure> {
        self.set_text(name, &value.to_string())
    }

    /// Sets a variable of any type by name, from text as in the model description.
    pub fn set_text(&self, name: &str, value: &str) -> Result<(), Failure> {
        let variable = self.description.variable(name)?;
        let (reference, wrong) = (&raw const variable.reference, |what: &str| Failure(format!("{name} = '{value}': expected {what}")));
        // SAFETY: a living instance, one value reference and one value.
        unsafe {
            match variable.kind {
                Kind::Real => {
                    let x: f64 = value.trim().parse().map_err(|_| wrong("a number"))?;
                    self.check("fmi2SetReal", (self.api.set_real)(self.component, reference, 1, &raw const x))
                }
                Kind::Integer => {
                    let n: Integer = value.trim().parse().map_err(|_| wrong("a whole number"))?;
                    self.check("fmi2SetInteger", (self.api.set_integer)(self.component, reference, 1, &raw const n))
                }
                Kind::Boolean => {
                    let b: Boolean = match value.trim() {
                        "true" | "1" => TRUE,
                        "false" | "0" => FALSE,
                        _ => return Err(wrong("true or false")),
                    };
                    self.check("fmi2SetBoolean", (self.api.set_boolean)(self.component, reference, 1, &raw const b))
                }
                Kind::String => {
                    let text = CString::new(value).map_err(|_| wrong("text without NUL characters"))?;
                    let pointer = text.as_ptr();
                    self.check("fmi2SetString", (self.api.set_string)(self.component, reference, 1, &raw const pointer))
                }
            }
        }
    }

    /// fmi2GetFMUstate.
    pub fn save(&self) -> Result<State<'_>, Failure> {
        let mut state = State { pointer: ptr::null_mut(), owner: self };
        // SAFETY: a living instance and a place to write.
        self.check("fmi2GetFMUstate", unsafe { (self.api.get_state)(self.component, &raw mut state.pointer) })?;
        Ok(state)
    }

    /// fmi2SetFMUstate.
    pub fn restore(&self, state: &State) -> Result<(), Failure> {
        // SAFETY: a living instance and a living state.
        self.check("fmi2SetFMUstate", unsafe { (self.api.set_state)(self.component, state.pointer) })
    }

    /// A state as bytes.
    pub fn serialize(&self, state: &State) -> Result<Vec<u8>, Failure> {
        let mut size = 0;
        // SAFETY: a living instance, a living state and places to write.
        self.check("fmi2SerializedFMUstateSize", unsafe { (self.api.state_size)(self.component, state.pointer, &raw mut size) })?;
        let mut bytes = vec![0; size];
        // SAFETY: as above; the array has as many bytes as it says.
        self.check("fmi2SerializeFMUstate", unsafe { (self.api.serialize)(self.component, state.pointer, bytes.as_mut_ptr(), size) })?;
        Ok(bytes)
    }

    /// A state from bytes.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<State<'_>, Failure> {
        let mut state = State { pointer: ptr::null_mut(), owner: self };
        // SAFETY: a living instance, an array with its length and a place to write.
        self.check("fmi2DeSerializeFMUstate", unsafe {
            (self.api.deserialize)(self.component, bytes.as_ptr(), bytes.len(), &raw mut state.pointer)
        })?;
        Ok(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_uri_is_encoded_and_read_back() {
        let folder = Path::new("/tmp/a b/ü%20");
        let uri = resources(folder);
        assert_eq!(uri, "file:///tmp/a%20b/%C3%BC%2520/resources");
        assert_eq!(fairlead::fmi::uri::resources(uri.as_bytes()), Ok(Some(folder.join("resources"))));
    }

    #[test]
    fn what_is_no_fmu_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.fmu");
        assert!(Fmu::open(&path).err().unwrap().0.contains("x.fmu"));
        fs::write(&path, "text").unwrap();
        assert!(Fmu::open(&path).err().unwrap().0.contains("zip archive"));
    }
}
