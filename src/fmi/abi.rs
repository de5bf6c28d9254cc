//! The types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h` (FMI 2.0.5, platform "default").
//!
//! Enumerations that come in from C are plain integers here: a foreign value in a Rust enum would be undefined behaviour.

use std::ffi::{c_char, c_int, c_void};

/// `fmi2Component`.
pub type Component = *mut c_void;
/// `fmi2ComponentEnvironment`.
pub type ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`.
pub type FmuState = *mut c_void;
/// `fmi2ValueReference`.
pub type ValueReference = u32;
/// `fmi2Real`.
pub type Real = f64;
/// `fmi2Integer`.
pub type Integer = c_int;
/// `fmi2Boolean`.
pub type Boolean = c_int;
/// `fmi2Char`.
pub type Char = c_char;
/// `fmi2String`.
pub type Text = *const Char;
/// `fmi2Byte`.
pub type Byte = u8;

/// `fmi2True`.
pub const TRUE: Boolean = 1;
/// `fmi2False`.
pub const FALSE: Boolean = 0;

/// `fmi2CoSimulation` of `fmi2Type`.
pub const CO_SIMULATION: c_int = 1;

/// `fmi2Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(C)]
pub enum Status {
    /// `fmi2OK`.
    Ok = 0,
    /// `fmi2Warning`.
    Warning = 1,
    /// `fmi2Discard`.
    Discard = 2,
    /// `fmi2Error`.
    Error = 3,
    /// `fmi2Fatal`.
    Fatal = 4,
    /// `fmi2Pending`.
    Pending = 5,
}

/// `fmi2DoStepStatus` of `fmi2StatusKind`.
pub const DO_STEP_STATUS: c_int = 0;
/// `fmi2PendingStatus`.
pub const PENDING_STATUS: c_int = 1;
/// `fmi2LastSuccessfulTime`.
pub const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated`.
pub const TERMINATED: c_int = 3;

/// `fmi2CallbackLogger`; the message is a printf format.
pub type LoggerCallback = unsafe extern "C" fn(ComponentEnvironment, Text, Status, Text, Text, ...);

/// `fmi2CallbackFunctions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct CallbackFunctions {
    /// Takes messages; may be NULL.
    pub logger: Option<LoggerCallback>,
    /// Never used: the FMU has its own allocator.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Never used.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Never used: steps are synchronous.
    pub step_finished: Option<unsafe extern "C" fn(ComponentEnvironment, Status)>,
    /// Handed back to the logger.
    pub component_environment: ComponentEnvironment,
}
