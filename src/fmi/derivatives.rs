//! fmi2GetRealOutputDerivatives and fmi2GetDirectionalDerivative.

use super::abi::ValueReference;
use super::instance::Instance;
use super::trouble::{Outcome, Trouble, error};
use crate::sim::SimError;
use model_description::{MAX_OUTPUT_DERIVATIVE_ORDER, Output};

impl Instance {
    /// fmi2GetRealOutputDerivatives: time derivatives of outputs at the last communication point, in each output's unit per second.
    pub fn output_derivatives(&mut self, references: &[ValueReference], orders: &[i32], into: &mut [f64]) -> Outcome {
        let outputs = self.smooth_outputs(references)?;
        for (reference, &order) in references.iter().zip(orders) {
            if !(1..=MAX_OUTPUT_DERIVATIVE_ORDER).contains(&order) {
                let name = self.table.real_name(*reference)?;
                return Err(error(format!(
                    "a derivative of {name} of order {order} is asked for; expected 1 (maxOutputDerivativeOrder), and for the second \
                     derivative of a position the first of its velocity"
                )));
            }
        }
        if outputs.is_empty() {
            return Ok(());
        }
        let slope = self.simulation.as_ref().ok_or_else(no_state)?.rates();
        for (output, slot) in outputs.iter().zip(into) {
            *slot = self.table.slope_of(*output, &slope);
        }
        Ok(())
    }

    /// fmi2GetDirectionalDerivative: of outputs at the end of the last step by the inputs that it began with.
    pub fn directional_derivative(
        &mut self,
        unknown: &[ValueReference],
        known: &[ValueReference],
        seed: &[f64],
        into: &mut [f64],
    ) -> Outcome {
        let outputs = self.smooth_outputs(unknown)?;
        let direction = self.table.direction(known, seed)?;
        if outputs.is_empty() {
            return Ok(());
        }
        let simulation = self.simulation.as_ref().ok_or_else(no_state)?;
        let slope = simulation.sensitivity(&direction).map_err(|problem| match problem {
            SimError::State(text) | SimError::Step(text) | SimError::Start(text) => error(text),
        })?;
        for (output, slot) in outputs.iter().zip(into) {
            *slot = self.table.slope_of(*output, &slope);
        }
        Ok(())
    }

    fn smooth_outputs(&self, references: &[ValueReference]) -> Result<Vec<Output>, Trouble> {
        references.iter().map(|&reference| self.table.smooth_output(reference)).collect()
    }
}

fn no_state() -> Trouble {
    error("there is no state to take derivatives at; expected a call after a step")
}
