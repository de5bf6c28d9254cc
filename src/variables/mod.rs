//! The FMI variables of a scene, bound to physical quantities.

use crate::outputs::Outputs;
use crate::scene::Scene;
use crate::sim::Inputs;
use model_description::{Input, Output, Value, Variable};
use std::path::Path;

/// A scene file with its variables: what one FMU is.
#[derive(Clone, Debug)]
pub struct Model {
    /// All variables in declaration order; index = position in the model description − 1.
    pub variables: Vec<Variable>,
    /// Fingerprint of scene, description and binary; what `fmi2Instantiate` must be given.
    pub guid: String,
}

impl Model {
    /// Reads `scene.toml` from an FMU's unpacked resources, or the embedded default scene without any.
    ///
    /// # Errors
    /// A message that names the file, every wrong key and what was expected.
    pub fn load(_resources: Option<&Path>) -> Result<Self, String> {
        Err("not written yet".into())
    }

    /// The checked scene with changed parameters: (index into the leaves, value).
    ///
    /// # Errors
    /// A message that names every wrong parameter and what was expected.
    pub fn scene(&self, _changes: &[(usize, Value)]) -> Result<Scene, String> {
        Err("not written yet".into())
    }

    /// One output of a committed state in the user's frame.
    pub fn output(&self, _quantity: Output, _outputs: &Outputs) -> Value {
        Value::Real(0.0)
    }

    /// The simulation's inputs from the values in the user's frame. `derivative(input, order)` gives what the importer set by
    /// `fmi2SetRealInputDerivatives`, if it did.
    pub fn inputs(&self, _value: &dyn Fn(Input) -> f64, _derivative: &dyn Fn(Input, i32) -> Option<f64>) -> Inputs {
        Inputs::default()
    }
}
