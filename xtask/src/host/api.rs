//! The C functions of an FMU's library.

use crate::error::{Failure, at};
use fairlead::fmi::abi::*;
use libloading::Library;
use std::ffi::c_int;
use std::path::Path;

macro_rules! api {
    ($($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions, and the library that must outlive them.
        pub struct Api {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            _library: Library,
        }

        impl Api {
            /// Loads the library and looks up every function.
            pub fn load(path: &Path) -> Result<Self, Failure> {
                // SAFETY: running an FMU is what the user asked for; its initializers are as trusted as the rest of it.
                let library = unsafe { Library::new(path) }.map_err(|e| at(path, e))?;
                Ok(Self {
                    // SAFETY: the types are those of FMI 2.0.
                    $($field: *unsafe { library.get($symbol) }
                        .map_err(|_| at(path, format!("does not export {}", $symbol)))?,)*
                    _library: library,
                })
            }
        }
    };
}

// Statuses come back as plain integers: a foreign value in a Rust enum would be undefined behaviour.
api! {
    version = "fmi2GetVersion": fn() -> Text;
    instantiate = "fmi2Instantiate": fn(Text, c_int, Text, Text, *const CallbackFunctions, Boolean, Boolean) -> Component;
    free_instance = "fmi2FreeInstance": fn(Component);
    setup_experiment = "fmi2SetupExperiment": fn(Component, Boolean, Real, Real, Boolean, Real) -> c_int;
    enter_initialization = "fmi2EnterInitializationMode": fn(Component) -> c_int;
    exit_initialization = "fmi2ExitInitializationMode": fn(Component) -> c_int;
    terminate = "fmi2Terminate": fn(Component) -> c_int;
    reset = "fmi2Reset": fn(Component) -> c_int;
    get_real = "fmi2GetReal": fn(Component, *const ValueReference, usize, *mut Real) -> c_int;
    get_integer = "fmi2GetInteger": fn(Component, *const ValueReference, usize, *mut Integer) -> c_int;
    get_boolean = "fmi2GetBoolean": fn(Component, *const ValueReference, usize, *mut Boolean) -> c_int;
    get_string = "fmi2GetString": fn(Component, *const ValueReference, usize, *mut Text) -> c_int;
    set_real = "fmi2SetReal": fn(Component, *const ValueReference, usize, *const Real) -> c_int;
    set_integer = "fmi2SetInteger": fn(Component, *const ValueReference, usize, *const Integer) -> c_int;
    set_boolean = "fmi2SetBoolean": fn(Component, *const ValueReference, usize, *const Boolean) -> c_int;
    set_string = "fmi2SetString": fn(Component, *const ValueReference, usize, *const Text) -> c_int;
    get_state = "fmi2GetFMUstate": fn(Component, *mut FmuState) -> c_int;
    set_state = "fmi2SetFMUstate": fn(Component, FmuState) -> c_int;
    free_state = "fmi2FreeFMUstate": fn(Component, *mut FmuState) -> c_int;
    state_size = "fmi2SerializedFMUstateSize": fn(Component, FmuState, *mut usize) -> c_int;
    serialize = "fmi2SerializeFMUstate": fn(Component, FmuState, *mut Byte, usize) -> c_int;
    deserialize = "fmi2DeSerializeFMUstate": fn(Component, *const Byte, usize, *mut FmuState) -> c_int;
    set_input_derivatives = "fmi2SetRealInputDerivatives":
        fn(Component, *const ValueReference, usize, *const Integer, *const Real) -> c_int;
    do_step = "fmi2DoStep": fn(Component, Real, Real, Boolean) -> c_int;
    real_status = "fmi2GetRealStatus": fn(Component, c_int, *mut Real) -> c_int;
}
