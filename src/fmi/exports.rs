//! The 34 functions of FMI 2.0 co-simulation, under their C names.
//!
//! # Safety
//! All of them trust what FMI asks of a caller: an instance is NULL or from [`fmi2Instantiate`] and not yet freed, arrays have the
//! stated number of elements, strings end with NUL. NULL, misalignment, wrong order, unknown numbers and, as far as it can be
//! seen, freed or foreign instances are answered with fmi2Error.

#![allow(non_snake_case, clippy::missing_safety_doc)]

use super::abi::*;
use super::function::Function;
use super::guard::{give_out, guard, or_null, take_back};
use super::instance::{Instance, incoming};
use super::logging::Log;
use super::panics::catch;
use super::pointers::{input, output, single, text};
use super::snapshot::Snapshot;
use super::table::{boolean, integer, real};
use super::trouble::{Outcome, discard, error};
use super::{states, uri};
use crate::variables::Model;
use model_description::Kind;
use std::ffi::{CStr, c_int};
use std::ptr;

/// The platform's C types: "default".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

/// The version of the interface: "2.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

/// Chooses log categories; none listed stands for all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(c: Component, on: Boolean, count: usize, categories: *const Text) -> Status {
    let body = |instance: &mut Instance| {
        let names = unsafe { input(categories, count)? };
        let names: Option<Vec<&CStr>> = names.iter().map(|&name| unsafe { text(name) }).collect();
        instance.log.select(on != FALSE, &names.ok_or_else(|| error("a category is NULL"))?).map_err(error)
    };
    unsafe { guard(c, Function::SetDebugLogging, body) }
}

/// A new instance, or NULL with the reason in the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: Text,
    fmu_type: c_int,
    guid: Text,
    resource_location: Text,
    callbacks: *const CallbackFunctions,
    _visible: Boolean,
    logging_on: Boolean,
) -> Component {
    or_null(catch(|| {
        let name = unsafe { text(instance_name) }.unwrap_or_default();
        // SAFETY: NULL or the importer's struct, which is only read during this call.
        let callbacks = unsafe { callbacks.as_ref() };
        let log = Log::new(callbacks, name.to_owned(), logging_on != FALSE);
        let made = catch(|| model(name, fmu_type, unsafe { text(guid) }, unsafe { text(resource_location) }));
        match made.unwrap_or_else(|panic| Err(format!("internal error: {panic}"))) {
            Ok(model) => give_out(Instance::new(model, log)),
            Err(reason) => {
                log.refusal(&reason);
                ptr::null_mut()
            }
        }
    }))
}

/// The model for an instance that is asked for in the right way.
fn model(name: &CStr, fmu_type: c_int, guid: Option<&CStr>, location: Option<&CStr>) -> Result<Model, String> {
    if name.is_empty() {
        return Err("the instance name is empty; expected a name".into());
    }
    if fmu_type != CO_SIMULATION {
        return Err(format!("the FMU type is {fmu_type}; expected fmi2CoSimulation ({CO_SIMULATION}), the only one this FMU has"));
    }
    let folder = uri::resources(location.unwrap_or_default().to_bytes())?;
    let model = Model::load(folder.as_deref())?;
    let guid = guid.unwrap_or_default().to_string_lossy();
    if guid != model.guid {
        return Err(format!("the GUID is '{guid}'; expected '{}': model description and FMU do not belong together", model.guid));
    }
    Ok(model)
}

/// Frees an instance in any phase.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: Component) {
    unsafe { take_back(c) }
}

/// Start time, stop time and tolerance, which overrides the scene's `solver.tolerance`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: Component,
    tolerance_defined: Boolean,
    tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    let given = |defined: Boolean, value: Real| (defined != FALSE).then_some(value);
    unsafe {
        guard(c, Function::SetupExperiment, |instance| {
            instance.setup(given(tolerance_defined, tolerance), start, given(stop_defined, stop))
        })
    }
}

/// From here on outputs can be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: Component) -> Status {
    unsafe { guard(c, Function::EnterInitializationMode, Instance::enter_initialization) }
}

/// Finds the start state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: Component) -> Status {
    unsafe { guard(c, Function::ExitInitializationMode, Instance::exit_initialization) }
}

/// Ends the run; values can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: Component) -> Status {
    unsafe { guard(c, Function::Terminate, Instance::terminate) }
}

/// Back to the state right after instantiation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: Component) -> Status {
    unsafe { guard(c, Function::Reset, Instance::reset) }
}

/// Reals, of the last communication point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(c: Component, vr: *const ValueReference, nvr: usize, value: *mut Real) -> Status {
    unsafe { guard(c, Function::GetReal, |i| i.get(Kind::Real, input(vr, nvr)?, output(value, nvr)?, real)) }
}

/// Integers, of the last communication point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(c: Component, vr: *const ValueReference, nvr: usize, value: *mut Integer) -> Status {
    unsafe { guard(c, Function::GetInteger, |i| i.get(Kind::Integer, input(vr, nvr)?, output(value, nvr)?, integer)) }
}

/// Booleans, of the last communication point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(c: Component, vr: *const ValueReference, nvr: usize, value: *mut Boolean) -> Status {
    unsafe { guard(c, Function::GetBoolean, |i| i.get(Kind::Boolean, input(vr, nvr)?, output(value, nvr)?, boolean)) }
}

/// Strings, of the last communication point; a pointer is good until its variable is read again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(c: Component, vr: *const ValueReference, nvr: usize, value: *mut Text) -> Status {
    unsafe { guard(c, Function::GetString, |i| i.get_texts(input(vr, nvr)?, output(value, nvr)?)) }
}

/// All of the Reals, or none if one of them is refused.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(c: Component, vr: *const ValueReference, nvr: usize, value: *const Real) -> Status {
    unsafe { guard(c, Function::SetReal, |i| i.set(Kind::Real, input(vr, nvr)?, input(value, nvr)?, incoming::real)) }
}

/// All of the Integers, or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(c: Component, vr: *const ValueReference, nvr: usize, value: *const Integer) -> Status {
    unsafe { guard(c, Function::SetInteger, |i| i.set(Kind::Integer, input(vr, nvr)?, input(value, nvr)?, incoming::integer)) }
}

/// All of the Booleans, or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(c: Component, vr: *const ValueReference, nvr: usize, value: *const Boolean) -> Status {
    unsafe { guard(c, Function::SetBoolean, |i| i.set(Kind::Boolean, input(vr, nvr)?, input(value, nvr)?, incoming::boolean)) }
}

/// All of the Strings, or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(c: Component, vr: *const ValueReference, nvr: usize, value: *const Text) -> Status {
    let body = |instance: &mut Instance| {
        let texts: Vec<Option<&CStr>> = unsafe { input(value, nvr)? }.iter().map(|&one| unsafe { text(one) }).collect();
        instance.set(Kind::String, unsafe { input(vr, nvr)? }, &texts, incoming::text)
    };
    unsafe { guard(c, Function::SetString, body) }
}

/// Saves the instance into a new state, or into the one that is given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: Component, state: *mut FmuState) -> Status {
    unsafe { guard(c, Function::GetFMUstate, |i| states::put(single(state)?, i.save())) }
}

/// Takes the instance to a saved state, also of another instance of this FMU.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: Component, state: FmuState) -> Status {
    unsafe { guard(c, Function::SetFMUstate, |i| i.load(states::get(state)?)) }
}

/// Frees a state and sets the pointer to NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: Component, state: *mut FmuState) -> Status {
    unsafe { guard(c, Function::FreeFMUstate, |_| state.as_mut().map_or(Ok(()), |slot| states::free(slot))) }
}

/// How many bytes [`fmi2SerializeFMUstate`] will write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: Component, state: FmuState, size: *mut usize) -> Status {
    let body = |_: &mut Instance| {
        *unsafe { single(size)? } = unsafe { states::get(state)? }.to_bytes().len();
        Ok(())
    };
    unsafe { guard(c, Function::SerializedFMUstateSize, body) }
}

/// Writes a state as bytes that other instances and machines can read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(c: Component, state: FmuState, bytes: *mut Byte, size: usize) -> Status {
    let body = |_: &mut Instance| {
        let written = unsafe { states::get(state)? }.to_bytes();
        let room = unsafe { output(bytes, size)? }.get_mut(..written.len());
        room.ok_or_else(|| error(format!("the array has {size} bytes; expected {}", written.len())))?.copy_from_slice(&written);
        Ok(())
    };
    unsafe { guard(c, Function::SerializeFMUstate, body) }
}

/// Makes a state from bytes that [`fmi2SerializeFMUstate`] wrote; any others are refused.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(c: Component, bytes: *const Byte, size: usize, state: *mut FmuState) -> Status {
    let body = |instance: &mut Instance| {
        let snapshot = Snapshot::from_bytes(unsafe { input(bytes, size)? }, instance.guid()).map_err(error)?;
        unsafe { states::put(single(state)?, snapshot) }
    };
    unsafe { guard(c, Function::DeSerializeFMUstate, body) }
}

/// How outputs at the end of the last step depend on the inputs of that step, along a direction of the inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: Component,
    unknown: *const ValueReference,
    unknown_count: usize,
    known: *const ValueReference,
    known_count: usize,
    seed: *const Real,
    sensitivity: *mut Real,
) -> Status {
    let body = |i: &mut Instance| unsafe {
        let (unknown, into) = (input(unknown, unknown_count)?, output(sensitivity, unknown_count)?);
        i.directional_derivative(unknown, input(known, known_count)?, input(seed, known_count)?, into)
    };
    unsafe { guard(c, Function::GetDirectionalDerivative, body) }
}

/// Time derivatives of inputs, of order 1 and 2, at the begin of the next step and for that step only.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: Component,
    vr: *const ValueReference,
    nvr: usize,
    order: *const Integer,
    value: *const Real,
) -> Status {
    unsafe {
        guard(c, Function::SetRealInputDerivatives, |i| i.set_input_derivatives(input(vr, nvr)?, input(order, nvr)?, input(value, nvr)?))
    }
}

/// Time derivatives of outputs, of order 1, at the last communication point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: Component,
    vr: *const ValueReference,
    nvr: usize,
    order: *const Integer,
    value: *mut Real,
) -> Status {
    unsafe {
        guard(c, Function::GetRealOutputDerivatives, |i| i.output_derivatives(input(vr, nvr)?, input(order, nvr)?, output(value, nvr)?))
    }
}

/// One communication step of any size. fmi2Discard: it could not be done, and the instance is as it was before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(c: Component, point: Real, step: Real, _no_set_state_prior_to_point: Boolean) -> Status {
    unsafe { guard(c, Function::DoStep, |instance| instance.do_step(point, step)) }
}

/// Steps are synchronous: there never is one to cancel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: Component) -> Status {
    let body = |_: &mut Instance| Err(error("no step is under way; this FMU's steps are synchronous"));
    unsafe { guard(c, Function::CancelStep, body) }
}

/// No kind applies: steps are synchronous.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: Component, kind: c_int, _value: *mut Status) -> Status {
    unsafe { guard(c, Function::GetStatus, |_| not_applicable(kind)) }
}

/// fmi2LastSuccessfulTime.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Component, kind: c_int, value: *mut Real) -> Status {
    let body = |instance: &mut Instance| {
        if kind != LAST_SUCCESSFUL_TIME {
            return not_applicable(kind);
        }
        *unsafe { single(value)? } = instance.last_successful_time();
        Ok(())
    };
    unsafe { guard(c, Function::GetRealStatus, body) }
}

/// No kind applies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(c: Component, kind: c_int, _value: *mut Integer) -> Status {
    unsafe { guard(c, Function::GetIntegerStatus, |_| not_applicable(kind)) }
}

/// fmi2Terminated: the FMU never ends a run by itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: Component, kind: c_int, value: *mut Boolean) -> Status {
    let body = |_: &mut Instance| {
        if kind != TERMINATED {
            return not_applicable(kind);
        }
        *unsafe { single(value)? } = FALSE;
        Ok(())
    };
    unsafe { guard(c, Function::GetBooleanStatus, body) }
}

/// No kind applies: steps are synchronous.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(c: Component, kind: c_int, _value: *mut Text) -> Status {
    unsafe { guard(c, Function::GetStringStatus, |_| not_applicable(kind)) }
}

fn not_applicable(kind: c_int) -> Outcome {
    let name = match kind {
        DO_STEP_STATUS => "fmi2DoStepStatus",
        PENDING_STATUS => "fmi2PendingStatus",
        LAST_SUCCESSFUL_TIME => "fmi2LastSuccessfulTime",
        TERMINATED => "fmi2Terminated",
        _ => return Err(error(format!("there is no status kind {kind}"))),
    };
    Err(discard(format!("{name} has no answer here: steps are synchronous, and kinds have their own functions")))
}
