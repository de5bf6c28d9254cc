//! The life of one instance, from fmi2Instantiate to fmi2FreeInstance.

use super::abi::ValueReference;
use super::function::Phase;
use super::logging::Log;
use super::snapshot::Snapshot;
use super::table::Table;
use super::trouble::{Outcome, Trouble, discard, error, warning};
use crate::outputs::Status as RunStatus;
use crate::sim::{SimError, Simulation};
use crate::variables::Model;
use model_description::{Kind, Value};
use std::ffi::c_char;

/// Communication points are compared with this part of the step and of the time itself: some hosts sum up their steps, others
/// multiply, and none hits the same doubles.
const STEP_TOLERANCE: f64 = 1e-6;
const TIME_TOLERANCE: f64 = 1e-10;

/// The scene's number that the importer's tolerance overrides.
const TOLERANCE_PARAMETER: &str = "solver.tolerance";

/// A start state, found when it is first needed: some hosts read every variable in initialization mode, many times.
enum Start {
    /// Not looked for with the present parameters and inputs.
    Unknown,
    /// The simulation stands at it.
    Found,
    /// There is none, and why.
    None(String),
}

/// One instance of the FMU.
pub(super) struct Instance {
    /// Where it is in its life.
    pub phase: Phase,
    /// The way to the importer's logger.
    pub log: Log,
    pub(super) table: Table,
    time: f64,
    stop: Option<f64>,
    start: Start,
    pub(super) simulation: Option<Simulation>,
    /// Parameter changes that the simulation's scene has.
    applied: Vec<(usize, Value)>,
    /// The status code that the importer knows of.
    told: i32,
}

impl Instance {
    /// Right after fmi2Instantiate.
    pub fn new(model: Model, log: Log) -> Self {
        log.event(|| format!("instantiated with {} variables, GUID {}", model.variables.len(), model.guid));
        Self {
            phase: Phase::Instantiated,
            log,
            table: Table::new(model),
            time: 0.0,
            stop: None,
            start: Start::Unknown,
            simulation: None,
            applied: Vec::new(),
            told: 0,
        }
    }

    /// fmi2Reset. The choice of log categories is the importer's and stays.
    pub fn reset(&mut self) -> Outcome {
        self.table.reset();
        self.time = 0.0;
        self.stop = None;
        self.start = Start::Unknown;
        self.simulation = None;
        self.applied.clear();
        self.told = 0;
        self.phase = Phase::Instantiated;
        self.log.event(|| "reset".into());
        Ok(())
    }

    /// fmi2SetupExperiment.
    pub fn setup(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        if !start.is_finite() {
            return Err(error(format!("the start time is {start}; expected a finite number")));
        }
        if let Some(stop) = stop.filter(|&stop| stop.is_nan() || stop < start) {
            return Err(error(format!("the stop time is {stop}; expected a number not before the start time {start}")));
        }
        if let Some(tolerance) = tolerance {
            if !(tolerance > 0.0 && tolerance.is_finite()) {
                return Err(error(format!("the tolerance is {tolerance}; expected a positive number")));
            }
            self.table.set_parameter(TOLERANCE_PARAMETER, tolerance);
        }
        self.time = start;
        self.stop = stop;
        Ok(())
    }

    /// fmi2EnterInitializationMode.
    pub fn enter_initialization(&mut self) -> Outcome {
        self.phase = Phase::Initialization;
        Ok(())
    }

    /// fmi2ExitInitializationMode.
    pub fn exit_initialization(&mut self) -> Outcome {
        match self.find_start() {
            Ok(()) => {
                self.phase = Phase::Stepping;
                self.log.event(|| format!("initialized at t = {} s with {} changed parameters", self.time, self.applied.len()));
                Ok(())
            }
            Err(trouble) => {
                self.phase = Phase::Failed;
                Err(trouble)
            }
        }
    }

    /// fmi2Terminate.
    pub fn terminate(&mut self) -> Outcome {
        self.phase = Phase::Terminated;
        self.log.event(|| format!("terminated at t = {} s", self.time));
        Ok(())
    }

    /// Sees to it that the simulation stands at the start state for the present parameters and inputs. Always begins with a new
    /// simulation, so that the result does not depend on whether and when somebody looked.
    fn find_start(&mut self) -> Outcome {
        if matches!(self.start, Start::Unknown) {
            self.applied = self.table.changes().map(|(leaf, value)| (leaf, value.clone())).collect();
            self.start = match self.start_simulation() {
                Ok(simulation) => {
                    self.table.refresh(simulation.outputs());
                    self.simulation = Some(simulation);
                    Start::Found
                }
                Err(problem) => Start::None(problem),
            };
        }
        match &self.start {
            Start::None(problem) => Err(error(problem.clone())),
            _ => Ok(()),
        }
    }

    fn start_simulation(&self) -> Result<Simulation, String> {
        let scene = self.table.scene(&self.applied)?;
        let mut simulation = Simulation::new(&scene).map_err(|e| e.to_string())?;
        simulation.initialize(self.time, &self.table.inputs()).map_err(|e| e.to_string())?;
        Ok(simulation)
    }

    /// Outputs are there to be read from initialization mode on; earlier they are zero.
    fn prepare_reading(&mut self, kind: Kind, references: &[ValueReference]) -> Outcome {
        if self.table.any_output(kind, references)? && self.phase == Phase::Initialization {
            self.find_start()?;
        }
        Ok(())
    }

    /// fmi2GetReal and its like.
    pub fn get<T>(&mut self, kind: Kind, references: &[ValueReference], into: &mut [T], convert: fn(&Value) -> T) -> Outcome {
        self.prepare_reading(kind, references)?;
        self.table.get(kind, references, into, convert)
    }

    /// fmi2GetString.
    pub fn get_texts(&mut self, references: &[ValueReference], into: &mut [*const c_char]) -> Outcome {
        self.prepare_reading(Kind::String, references)?;
        self.table.get_texts(references, into)
    }

    /// fmi2SetReal and its like.
    pub fn set<T: Copy>(
        &mut self,
        kind: Kind,
        references: &[ValueReference],
        values: &[T],
        convert: fn(T) -> Result<Value, String>,
    ) -> Outcome {
        let running = self.phase == Phase::Stepping;
        self.table.set(kind, references, values, running, convert)?;
        self.forget_start();
        Ok(())
    }

    /// fmi2SetRealInputDerivatives.
    pub fn set_input_derivatives(&mut self, references: &[ValueReference], orders: &[i32], values: &[f64]) -> Outcome {
        self.table.set_derivatives(references, orders, values)?;
        self.forget_start();
        Ok(())
    }

    fn forget_start(&mut self) {
        if self.phase != Phase::Stepping {
            self.start = Start::Unknown;
        }
    }

    /// fmi2DoStep.
    pub fn do_step(&mut self, point: f64, step: f64) -> Outcome {
        let target = self.end_of_step(point, step)?;
        self.retune()?;
        let inputs = self.table.inputs();
        let simulation = self.simulation.as_mut().ok_or_else(no_simulation)?;
        let result = simulation.step_to(target, &inputs);
        self.table.refresh(simulation.outputs());
        let (status, solver) = (simulation.outputs().status.clone(), &simulation.outputs().solver);
        result.map_err(|problem| match problem {
            SimError::Step(_) => discard(problem.to_string()),
            _ => error(problem.to_string()),
        })?;
        self.log.solver(|| {
            let (steps, rejected, iterations) = (solver.steps, solver.rejected, solver.iterations);
            format!("t = {target} s: {steps} sub-steps, {rejected} rejected, {iterations} iterations, energy error {}", solver.energy_error)
        });
        self.time = target;
        self.table.expire_derivatives();
        self.tell(&status)
    }

    /// A warning when the run becomes worse, not at every step while it is.
    fn tell(&mut self, status: &RunStatus) -> Outcome {
        let worse = status.code > self.told;
        self.told = status.code;
        if worse { Err(warning(format!("t = {} s: {}", self.time, status.message))) } else { Ok(()) }
    }

    /// Where this step ends. The master's clock counts; our own time only tells whether master and FMU mean the same step.
    fn end_of_step(&self, point: f64, step: f64) -> Result<f64, Trouble> {
        if !(step > 0.0 && step.is_finite()) {
            return Err(error(format!("the communication step size is {step}; expected a positive number")));
        }
        let near = |a: f64, b: f64| (a - b).abs() <= STEP_TOLERANCE * step + TIME_TOLERANCE * a.abs().max(b.abs());
        if !(point.is_finite() && near(point, self.time)) {
            return Err(error(format!("the communication point is {point} s; expected the present time {} s", self.time)));
        }
        let target = point + step;
        if !target.is_finite() || target <= self.time {
            return Err(error(format!("a step of {step} s does not advance the time {} s", self.time)));
        }
        match self.stop {
            Some(stop) if target > stop && !near(target, stop) => {
                Err(error(format!("the step would end at {target} s; expected not beyond the stop time {stop} s of fmi2SetupExperiment")))
            }
            _ => Ok(target),
        }
    }

    /// Lets the simulation have the tunable parameters set since the last step.
    fn retune(&mut self) -> Outcome {
        let same = self.table.changes().eq(self.applied.iter().map(|(leaf, value)| (*leaf, value)));
        if same {
            return Ok(());
        }
        let changes: Vec<_> = self.table.changes().map(|(leaf, value)| (leaf, value.clone())).collect();
        let scene = self.table.scene(&changes).map_err(error)?;
        let simulation = self.simulation.as_mut().ok_or_else(no_simulation)?;
        simulation.retune(&scene).map_err(|problem| error(problem.to_string()))?;
        self.applied = changes;
        self.log.event(|| format!("t = {} s: tunable parameters changed", self.time));
        Ok(())
    }

    /// fmi2LastSuccessfulTime.
    pub fn last_successful_time(&self) -> f64 {
        self.time
    }

    /// The FMU's fingerprint.
    pub fn guid(&self) -> &str {
        self.table.guid()
    }

    /// fmi2GetFMUstate.
    pub fn save(&self) -> Snapshot {
        let simulation = self.simulation.as_ref().filter(|_| matches!(self.start, Start::Found));
        Snapshot {
            guid: self.table.guid().to_owned(),
            phase: self.phase,
            time: self.time,
            stop: self.stop,
            settings: self.table.settings(),
            applied: self.applied.clone(),
            told: self.told,
            simulation: simulation.map(|simulation| {
                let mut bytes = Vec::new();
                simulation.write_state(&mut bytes);
                bytes
            }),
        }
    }

    /// fmi2SetFMUstate; all or nothing.
    pub fn load(&mut self, snapshot: &Snapshot) -> Outcome {
        if snapshot.guid != self.table.guid() {
            return Err(error(format!("the state is of the FMU {}; expected {}", snapshot.guid, self.table.guid())));
        }
        if !self.table.fits(&snapshot.settings, &snapshot.applied) {
            return Err(error("the state's variables are not those of this FMU"));
        }
        match &snapshot.simulation {
            Some(bytes) => self.load_simulation(bytes, &snapshot.applied)?,
            // A start state is found again when it is needed, and comes out the same.
            None if matches!(snapshot.phase, Phase::Stepping) => return Err(error("the state has no simulation in it")),
            None => {
                self.start = Start::Unknown;
                self.simulation = None;
                self.table.clear_outputs();
            }
        }
        self.table.restore(&snapshot.settings);
        self.applied.clone_from(&snapshot.applied);
        self.told = snapshot.told;
        self.time = snapshot.time;
        self.stop = snapshot.stop;
        self.phase = snapshot.phase;
        Ok(())
    }

    /// The simulation is built anew if its scene had other parameters.
    fn load_simulation(&mut self, bytes: &[u8], applied: &[(usize, Value)]) -> Outcome {
        match &mut self.simulation {
            Some(simulation) if matches!(self.start, Start::Found) && self.applied == applied => {
                simulation.read_state(bytes).map_err(|e| error(e.to_string()))?;
                self.table.refresh(simulation.outputs());
            }
            _ => {
                let scene = self.table.scene(applied).map_err(error)?;
                let mut simulation = Simulation::new(&scene).map_err(|e| error(e.to_string()))?;
                simulation.read_state(bytes).map_err(|e| error(e.to_string()))?;
                self.table.refresh(simulation.outputs());
                self.simulation = Some(simulation);
                self.start = Start::Found;
            }
        }
        Ok(())
    }
}

/// Cannot happen between a successful initialization and a reset.
fn no_simulation() -> Trouble {
    error("there is no simulation")
}

/// Converters from what C sends, for [`Instance::set`].
pub(super) mod incoming {
    use super::Value;
    use std::ffi::CStr;

    pub fn real(x: f64) -> Result<Value, String> {
        if x.is_finite() { Ok(Value::Real(x)) } else { Err(format!("is {x}; expected a finite number")) }
    }

    pub fn integer(n: i32) -> Result<Value, String> {
        Ok(Value::Integer(n))
    }

    /// C's convention: whatever is not zero is true, though FMI sends only 0 and 1.
    pub fn boolean(b: i32) -> Result<Value, String> {
        Ok(Value::Boolean(b != 0))
    }

    pub fn text(text: Option<&CStr>) -> Result<Value, String> {
        let text = text.ok_or("is NULL; expected a string")?;
        let text = text.to_str().map_err(|_| "is not UTF-8; expected a UTF-8 string")?;
        Ok(Value::String(text.to_owned()))
    }
}
