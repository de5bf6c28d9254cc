//! The FMI variables of a scene, bound to physical quantities.

mod binding;

use crate::outputs::Outputs;
use crate::scene::file::SceneFile;
use crate::scene::{Leaf, Scene, SceneErrors, Setpoint};
use crate::sim::Inputs;
use model_description::guid::guid;
use model_description::scenes::{BuiltIn, SCENES};
use model_description::{Document, Input, Output, Shape, SheaveShape, Value, Variable};
use std::fs;
use std::path::Path;

/// Fingerprint of the program: version and hash of the sources.
pub const FINGERPRINT: &str = env!("FAIRLEAD_FINGERPRINT");
/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Name of the scene file among an FMU's resources.
pub const SCENE_FILE: &str = "scene.toml";

/// A scene file with its variables: what one FMU is.
#[derive(Clone, Debug)]
pub struct Model {
    /// All variables in declaration order; index = position in the model description − 1.
    pub variables: Vec<Variable>,
    /// Fingerprint of scene, description and binary; what `fmi2Instantiate` must be given.
    pub guid: String,
    /// Numbers of the scene, in the order that [`Quantity::Parameter`](model_description::Quantity::Parameter) counts in.
    pub leaves: Vec<Leaf>,
    /// What decides which variables there are.
    pub shape: Shape,
    /// The checked scene with the file's own numbers.
    pub initial_scene: Scene,
    file: SceneFile,
    text: String,
    start_shape: Option<String>,
}

impl Model {
    /// Reads `scene.toml` from an FMU's unpacked resources, or the embedded default scene without any.
    ///
    /// # Errors
    /// A message that names the file, every wrong key and what was expected.
    pub fn load(resources: Option<&Path>) -> Result<Self, String> {
        match resources {
            Some(folder) => Self::read(&folder.join(SCENE_FILE)),
            None => Self::built_in(&SCENES[0]),
        }
    }

    /// Reads a scene file, and the start shape beside it if the scene has one.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = read_text(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::new(text, &path.display().to_string(), |file| read_text(&folder.join(file)))
    }

    /// A built-in scene.
    ///
    /// # Errors
    /// None in practice: a test reads them all.
    pub fn built_in(scene: &BuiltIn) -> Result<Self, String> {
        Self::new(scene.text.to_owned(), scene.name, |file| Err(format!("{}: a built-in scene cannot read {file}", scene.name)))
    }

    fn new(text: String, source: &str, read: impl Fn(&str) -> Result<String, String>) -> Result<Self, String> {
        let file = SceneFile::parse(&text, source).map_err(|e| e.to_string())?;
        let start_shape = file.start_shape().map(read).transpose()?;
        let initial_scene = file.check(start_shape.as_deref()).map_err(|e| e.to_string())?;
        let shape = shape(&initial_scene);
        let leaves = file.leaves();
        let numbers: Vec<_> = leaves.iter().map(|leaf| (leaf.name.clone(), leaf.value.clone())).collect();
        let variables = model_description::variables(&shape, &numbers);
        let description = format!("{variables:?}");
        let shape_bytes = start_shape.as_deref().unwrap_or_default().as_bytes();
        let guid = guid(&[FINGERPRINT.as_bytes(), text.as_bytes(), shape_bytes, description.as_bytes()]);
        Ok(Self { variables, guid, leaves, shape, initial_scene, file, text, start_shape })
    }

    /// The checked scene with changed parameters: (index into the leaves, value).
    ///
    /// # Errors
    /// A message that names every wrong parameter and what was expected.
    pub fn scene(&self, changes: &[(usize, Value)]) -> Result<Scene, String> {
        if changes.is_empty() {
            return Ok(self.initial_scene.clone());
        }
        let changed = |changes| -> Result<Scene, SceneErrors> { self.file.with(changes)?.check(self.start_shape.as_deref()) };
        changed(changes).map_err(|e| e.to_string())
    }

    /// Files that an FMU of this scene needs among its resources: path there, text.
    pub fn resources(&self) -> Vec<(&str, &str)> {
        let start_shape = self.file.start_shape().zip(self.start_shape.as_deref());
        std::iter::once((SCENE_FILE, self.text.as_str())).chain(start_shape).collect()
    }

    /// What the model description and the documentation are written from.
    pub fn document(&self) -> Document<'_> {
        Document {
            name: &self.initial_scene.name,
            description: &self.initial_scene.description,
            guid: &self.guid,
            version: VERSION,
            tolerance: self.initial_scene.solver.tolerance,
            shape: &self.shape,
            text: &self.text,
            picture: None,
            variables: &self.variables,
        }
    }

    /// One output of a committed state in the user's frame.
    pub fn output(&self, quantity: Output, outputs: &Outputs) -> Value {
        binding::output(quantity, outputs, self.shape.ned)
    }

    /// The simulation's inputs from the values in the user's frame. `derivative(input, order)` gives what the importer set by
    /// `fmi2SetRealInputDerivatives`, if it did.
    pub fn inputs(&self, value: &dyn Fn(Input) -> f64, derivative: &dyn Fn(Input, i32) -> Option<f64>) -> Inputs {
        binding::inputs(&self.shape, value, derivative)
    }
}

/// What of the scene decides which variables exist.
fn shape(scene: &Scene) -> Shape {
    Shape {
        ship_derivatives: scene.ship.map(|s| s.derivatives),
        ned: scene.ship.is_some_and(|s| s.ned),
        winch: scene.winch.is_some(),
        payout_command: scene.winch.as_ref().is_some_and(|w| w.payout_command),
        external_setpoint: scene.winch.as_ref().is_some_and(|w| w.setpoint == Setpoint::External),
        anchor: scene.anchor.is_some(),
        sheaves: scene.sheaves.iter().map(|s| SheaveShape { groove: s.groove_angle.is_some(), turns: s.inertia.is_some() }).collect(),
        fluid: scene.fluid.is_some(),
        noise: scene.fluid.as_ref().is_some_and(|f| f.noise.is_some()),
        body: scene.body.is_some(),
        body_force: scene.body.as_ref().is_some_and(|b| b.force_input),
        load: scene.load.is_some(),
        far_end: scene.far_end.is_some(),
        points: scene.points,
    }
}

fn read_text(path: &Path) -> Result<String, String> {
    let bytes = fs::read(path).map_err(|e| format!("{}: cannot be read: {e}", path.display()))?;
    String::from_utf8(bytes).map_err(|e| format!("{}: no UTF-8 text (byte {})", path.display(), e.utf8_error().valid_up_to() + 1))
}

#[cfg(test)]
mod tests;
