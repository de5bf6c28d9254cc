//! The values of one instance's variables: what setters write, getters read, and the simulation takes its inputs from.

use super::abi::ValueReference;
use super::trouble::{Trouble, error};
use crate::outputs::{Outputs, Slope};
use crate::scene::Scene;
use crate::sim::Inputs;
use crate::variables::Model;
use model_description::{Causality, Input, Kind, Output, Quantity, Value, Variability, Variable};
use std::collections::BTreeMap;
use std::ffi::{CString, c_char};

/// Greatest order of input derivatives that means anything to the simulation.
const MAX_ORDER: i32 = 2;

/// One input with what the importer said of its time derivatives.
struct InputRow {
    input: Input,
    variable: usize,
    derivatives: Derivatives,
    /// Those of the last step.
    expired: Derivatives,
}

/// Time derivatives of order 1 and 2.
pub(super) type Derivatives = [Option<f64>; MAX_ORDER as usize];

/// Everything that an importer can set; what a saved state remembers of the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Settings {
    /// Parameters and inputs in declaration order.
    pub values: Vec<Value>,
    /// Of the inputs in declaration order.
    pub derivatives: Vec<Derivatives>,
}

/// The variables with their values.
pub(super) struct Table {
    model: Model,
    /// Position of a variable by the halves of its value reference, [`NOWHERE`] where there is none.
    positions: Vec<Vec<usize>>,
    values: Vec<Value>,
    inputs: Vec<InputRow>,
    /// What the pointers given out by fmi2GetString point to, by variable.
    texts: BTreeMap<usize, CString>,
}

/// No variable.
const NOWHERE: usize = usize::MAX;

/// Upper and lower half of a value reference: what it is, and which of several.
fn halves(reference: ValueReference) -> [usize; 2] {
    [(reference >> 16) as usize, (reference & 0xffff) as usize]
}

impl Table {
    /// All variables at their start values, outputs at zero.
    pub fn new(model: Model) -> Self {
        let variables = || model.variables.iter().enumerate();
        let mut positions: Vec<Vec<usize>> = Vec::new();
        for (at, variable) in variables() {
            let [upper, lower] = halves(variable.reference);
            if positions.len() <= upper {
                positions.resize_with(upper + 1, Vec::new);
            }
            let row = &mut positions[upper];
            if row.len() <= lower {
                row.resize(lower + 1, NOWHERE);
            }
            row[lower] = at;
        }
        let inputs = variables()
            .filter_map(|(variable, row)| match row.quantity {
                Quantity::Input(input) => Some(InputRow { input, variable, derivatives: [None; 2], expired: [None; 2] }),
                _ => None,
            })
            .collect();
        let values = start_values(&model);
        Self { model, positions, values, inputs, texts: BTreeMap::new() }
    }

    /// Back to the start values.
    pub fn reset(&mut self) {
        self.values = start_values(&self.model);
        self.expire_derivatives();
        self.texts.clear();
    }

    /// The FMU's fingerprint.
    pub fn guid(&self) -> &str {
        &self.model.guid
    }

    fn find(&self, kind: Kind, reference: ValueReference) -> Result<usize, Trouble> {
        let [upper, lower] = halves(reference);
        let at = self.positions.get(upper).and_then(|row| row.get(lower)).copied().unwrap_or(NOWHERE);
        let found = self.model.variables.get(at).is_some_and(|variable| variable.kind == kind);
        if found { Ok(at) } else { Err(error(format!("there is no {kind:?} variable with value reference {reference}"))) }
    }

    /// Whether any of the variables is an output, so that there must be a state to read it from.
    ///
    /// # Errors
    /// A value reference that does not exist.
    pub fn any_output(&self, kind: Kind, references: &[ValueReference]) -> Result<bool, Trouble> {
        references
            .iter()
            .try_fold(false, |any, &reference| Ok(any | (self.model.variables[self.find(kind, reference)?].causality == Causality::Output)))
    }

    /// Reads; writes nothing unless all value references exist.
    pub fn get<T>(&self, kind: Kind, references: &[ValueReference], into: &mut [T], convert: fn(&Value) -> T) -> Result<(), Trouble> {
        self.any_output(kind, references)?;
        for (&reference, slot) in references.iter().zip(into) {
            *slot = convert(&self.values[self.find(kind, reference)?]);
        }
        Ok(())
    }

    /// Reads strings; the pointers are good until the same variable is read again.
    pub fn get_texts(&mut self, references: &[ValueReference], into: &mut [*const c_char]) -> Result<(), Trouble> {
        self.any_output(Kind::String, references)?;
        for (&reference, slot) in references.iter().zip(into) {
            let at = self.find(Kind::String, reference)?;
            let text = match &self.values[at] {
                Value::String(text) => CString::new(text.replace('\0', "")).unwrap_or_default(),
                _ => CString::default(),
            };
            let kept = self.texts.entry(at).or_default();
            // The same text keeps its pointer, so that reading twice in one call is harmless too.
            if *kept != text {
                *kept = text;
            }
            *slot = kept.as_ptr();
        }
        Ok(())
    }

    /// Writes all values or, if one is refused, none. `running`: the instance is initialized.
    pub fn set<T: Copy>(
        &mut self,
        kind: Kind,
        references: &[ValueReference],
        values: &[T],
        running: bool,
        convert: fn(T) -> Result<Value, String>,
    ) -> Result<(), Trouble> {
        for (&reference, &value) in references.iter().zip(values) {
            let variable = &self.model.variables[self.find(kind, reference)?];
            may_be_set(variable, running)?;
            convert(value).map_err(|problem| error(format!("{} {problem}", variable.name)))?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            let at = self.find(kind, reference)?;
            if let Ok(value) = convert(value) {
                self.values[at] = value;
            }
        }
        Ok(())
    }

    /// Takes over time derivatives of inputs, all or none.
    pub fn set_derivatives(&mut self, references: &[ValueReference], orders: &[i32], values: &[f64]) -> Result<(), Trouble> {
        let mut rows = Vec::with_capacity(references.len());
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let at = self.find(Kind::Real, reference)?;
            let name = &self.model.variables[at].name;
            let row = self.inputs.iter().position(|row| row.variable == at);
            let row = row.ok_or_else(|| error(format!("{name} is no input; only inputs have derivatives to set")))?;
            if !(1..=MAX_ORDER).contains(&order) {
                return Err(error(format!("the derivative of {name} has order {order}; expected 1 to {MAX_ORDER}")));
            }
            if !value.is_finite() {
                return Err(error(format!("the derivative of {name} of order {order} is {value}; expected a finite number")));
            }
            rows.push((row, order as usize - 1, value));
        }
        for (row, order, value) in rows {
            self.inputs[row].derivatives[order] = Some(value);
        }
        Ok(())
    }

    /// Input derivatives hold for one step.
    pub fn expire_derivatives(&mut self) {
        for row in &mut self.inputs {
            row.expired = std::mem::take(&mut row.derivatives);
        }
    }

    /// Overrides the parameter of this name, if the scene has it.
    pub fn set_parameter(&mut self, name: &str, value: f64) {
        let found = self.model.variables.iter().position(|row| row.name == name && row.causality == Causality::Parameter);
        if let Some(at) = found {
            self.values[at] = Value::Real(value);
        }
    }

    /// The scene's numbers that differ from the packed scene: (index into its leaves, value).
    pub fn changes(&self) -> impl Iterator<Item = (usize, &Value)> {
        self.model.variables.iter().zip(&self.values).filter_map(|(row, value)| match row.quantity {
            Quantity::Parameter(leaf) if row.start.as_ref() != Some(value) => Some((leaf, value)),
            _ => None,
        })
    }

    /// The checked scene with these numbers changed.
    pub fn scene(&self, changes: &[(usize, Value)]) -> Result<Scene, String> {
        self.model.scene(changes)
    }

    /// The simulation's inputs as set now.
    pub fn inputs(&self) -> Inputs {
        let row = |input: Input| self.inputs.iter().find(|row| row.input == input);
        self.model.inputs(&|input| row(input).map_or(0.0, |row| real(&self.values[row.variable])), &|input, order| {
            let order = usize::try_from(order).ok()?.checked_sub(1)?;
            row(input)?.derivatives.get(order).copied().flatten()
        })
    }

    /// The name of a Real variable.
    ///
    /// # Errors
    /// A value reference that does not exist.
    pub fn real_name(&self, reference: ValueReference) -> Result<&str, Trouble> {
        Ok(&self.model.variables[self.find(Kind::Real, reference)?].name)
    }

    /// The output of this value reference, which has derivatives.
    ///
    /// # Errors
    /// A variable that is no output, or has none.
    pub fn smooth_output(&self, reference: ValueReference) -> Result<Output, Trouble> {
        let row = &self.model.variables[self.find(Kind::Real, reference)?];
        match row.quantity {
            Quantity::Output(output) if output.is_smooth() => Ok(output),
            Quantity::Output(_) => Err(error(format!("{} has no derivatives; expected an output that changes smoothly", row.name))),
            _ => Err(error(format!("{} is no output; expected an output", row.name))),
        }
    }

    /// The derivative of an output, in the user's frame.
    pub fn slope_of(&self, output: Output, slope: &Slope) -> f64 {
        slope.of(|outputs| real(&self.model.output(output, outputs)))
    }

    /// A change of the inputs that the last step began with. What the importer said of a derivative then beats what another input says of
    /// it, so that the latter changes nothing.
    ///
    /// # Errors
    /// A variable that is no input, a seed that is not finite.
    pub fn direction(&self, references: &[ValueReference], seed: &[f64]) -> Result<Inputs, Trouble> {
        let mut seeds = vec![0.0; self.inputs.len()];
        for (&reference, &seed) in references.iter().zip(seed) {
            let at = self.find(Kind::Real, reference)?;
            let name = &self.model.variables[at].name;
            let row = self.inputs.iter().position(|row| row.variable == at);
            let row = row.ok_or_else(|| error(format!("{name} is no input; outputs have derivatives by inputs only")))?;
            if !seed.is_finite() {
                return Err(error(format!("the seed of {name} is {seed}; expected a finite number")));
            }
            seeds[row] += seed;
        }
        let row = |input: Input| self.inputs.iter().position(|row| row.input == input);
        Ok(self.model.inputs(&|input| row(input).map_or(0.0, |row| seeds[row]), &|input, order| {
            let order = usize::try_from(order).ok()?.checked_sub(1)?;
            self.inputs[row(input)?].expired.get(order).copied().flatten().map(|_| 0.0)
        }))
    }

    /// Takes over the outputs of a committed state.
    pub fn refresh(&mut self, outputs: &Outputs) {
        for (row, value) in self.model.variables.iter().zip(&mut self.values) {
            if let Quantity::Output(quantity) = row.quantity {
                *value = self.model.output(quantity, outputs);
            }
        }
    }

    /// Outputs at zero, as before initialization.
    pub fn clear_outputs(&mut self) {
        for (row, value) in self.model.variables.iter().zip(&mut self.values) {
            if row.causality == Causality::Output {
                *value = zero(row.kind);
            }
        }
    }

    /// What a saved state remembers.
    pub fn settings(&self) -> Settings {
        Settings {
            values: self.settable().map(|at| self.values[at].clone()).collect(),
            derivatives: self.inputs.iter().map(|row| row.derivatives).collect(),
        }
    }

    /// Whether remembered settings and parameter changes can be from this FMU.
    pub fn fits(&self, settings: &Settings, changes: &[(usize, Value)]) -> bool {
        let parameter = |leaf: usize| self.model.variables.iter().find(|row| row.quantity == Quantity::Parameter(leaf));
        let acceptable = |value: &Value, row: &Variable| match value {
            Value::Real(x) => row.kind == Kind::Real && x.is_finite(),
            other => row.kind == kind(other),
        };
        settings.derivatives.len() == self.inputs.len()
            && settings.values.len() == self.settable().count()
            && self.settable().zip(&settings.values).all(|(at, value)| acceptable(value, &self.model.variables[at]))
            && changes.iter().all(|(leaf, value)| parameter(*leaf).is_some_and(|row| acceptable(value, row)))
    }

    /// Takes back what [`Self::settings`] gave and [`Self::fits`] accepted.
    pub fn restore(&mut self, settings: &Settings) {
        let settable: Vec<_> = self.settable().collect();
        for (at, value) in settable.into_iter().zip(&settings.values) {
            self.values[at].clone_from(value);
        }
        for (row, &derivatives) in self.inputs.iter_mut().zip(&settings.derivatives) {
            row.derivatives = derivatives;
        }
    }

    fn settable(&self) -> impl Iterator<Item = usize> {
        self.model.variables.iter().enumerate().filter(|(_, row)| row.causality != Causality::Output).map(|(at, _)| at)
    }
}

fn start_values(model: &Model) -> Vec<Value> {
    model.variables.iter().map(|row| row.start.clone().unwrap_or_else(|| zero(row.kind))).collect()
}

fn may_be_set(variable: &Variable, running: bool) -> Result<(), Trouble> {
    let name = &variable.name;
    match (variable.causality, variable.variability) {
        (Causality::Output, _) => Err(error(format!("{name} is an output and cannot be set"))),
        (Causality::Parameter, Variability::Fixed) if running => {
            Err(error(format!("{name} is a fixed parameter; it can be set only before fmi2ExitInitializationMode")))
        }
        _ => Ok(()),
    }
}

fn zero(kind: Kind) -> Value {
    match kind {
        Kind::Real => Value::Real(0.0),
        Kind::Integer => Value::Integer(0),
        Kind::Boolean => Value::Boolean(false),
        Kind::String => Value::String(String::new()),
    }
}

fn kind(value: &Value) -> Kind {
    match value {
        Value::Real(_) => Kind::Real,
        Value::Integer(_) => Kind::Integer,
        Value::Boolean(_) => Kind::Boolean,
        Value::String(_) => Kind::String,
    }
}

/// A value that is known to be real.
pub(super) fn real(value: &Value) -> f64 {
    if let Value::Real(x) = value { *x } else { 0.0 }
}

/// A value that is known to be an integer.
pub(super) fn integer(value: &Value) -> i32 {
    if let Value::Integer(n) = value { *n } else { 0 }
}

/// A value that is known to be a Boolean, as C has it.
pub(super) fn boolean(value: &Value) -> i32 {
    i32::from(matches!(value, Value::Boolean(true)))
}
