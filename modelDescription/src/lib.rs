//! The one source of truth for fairlead's FMI variables: which there are for a scene of a given shape,
//! and everything that the model description and the documentation say of them.
//!
//! Two declarative tables are the source: [`table::FAMILIES`] has the inputs and outputs, [`keys::KEYS`] what a scene file may say (each
//! number there is an FMI parameter). From them come the variables, modelDescription.xml, the HTML page and the check of scene files.
//! This crate knows FMI and names, but no physics and no file format of scenes.

mod advice;
mod document;
#[cfg(feature = "xml")]
mod groups;
pub mod guid;
pub mod html;
pub mod keys;
pub mod notes;
#[cfg(feature = "xml")]
pub mod osp;
mod pattern;
pub mod scenes;
mod smooth;
#[cfg(feature = "xml")]
pub mod ssp;
pub mod table;
#[cfg(feature = "xml")]
pub mod terminals;
pub mod units;
#[cfg(feature = "xml")]
pub mod xml;

pub use document::{Document, LOG_CATEGORIES, STATUS_CODES};
pub use smooth::MAX_OUTPUT_DERIVATIVE_ORDER;
pub use table::{Output, variables};

/// FMI base type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// f64.
    Real,
    /// i32.
    Integer,
    /// bool.
    Boolean,
    /// UTF-8.
    String,
}

/// A value of any FMI base type.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// f64, in the unit of its variable.
    Real(f64),
    /// i32.
    Integer(i32),
    /// bool.
    Boolean(bool),
    /// UTF-8.
    String(String),
}

/// FMI causality (those in use).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// A number of the scene.
    Parameter,
    /// Set by the importer at communication points.
    Input,
    /// Read by the importer.
    Output,
}

/// FMI variability (those in use).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Parameters that may be set before initialization only.
    Fixed,
    /// Parameters that may also be set at communication points.
    Tunable,
    /// Changes at communication points only.
    Discrete,
    /// Real signals.
    Continuous,
}

/// What of a sheave decides which variables it has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SheaveShape {
    /// It has a groove.
    pub groove: bool,
    /// It turns.
    pub turns: bool,
}

/// What of the scene decides which variables exist.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Number of pose derivatives among the inputs (0, 1, 2); `None`: no ship.
    pub ship_derivatives: Option<usize>,
    /// World and ship axes have z down.
    pub ned: bool,
    /// There is a winch.
    pub winch: bool,
    /// Its set-point is metres of payout.
    pub payout_command: bool,
    /// Its set-point is an FMU input.
    pub external_setpoint: bool,
    /// There is an anchor.
    pub anchor: bool,
    /// One entry per sheave.
    pub sheaves: Vec<SheaveShape>,
    /// There is water.
    pub fluid: bool,
    /// Its current is turbulent.
    pub noise: bool,
    /// There is a towed body.
    pub body: bool,
    /// It takes an external force.
    pub body_force: bool,
    /// There is a rigid load.
    pub load: bool,
    /// The far end is fixed.
    pub far_end: bool,
    /// Number of `cable.point[k]`.
    pub points: usize,
}

/// Input quantities, in the order of their natural index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// (pose component 0..6: x, y, z, roll, pitch, yaw; time derivative 0..=2).
    Ship(usize, usize),
    /// Winch set-point.
    Setpoint,
    /// Its rate.
    SetpointRate,
    /// Uniform current, component 0..2.
    Current(usize),
    /// Force on the body, component 0..3.
    BodyForce(usize),
}

/// One FMI scalar variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Structured name.
    pub name: String,
    /// Value reference, unique per kind, stable for the same scene.
    pub reference: u32,
    /// Base type.
    pub kind: Kind,
    /// FMI causality.
    pub causality: Causality,
    /// FMI variability.
    pub variability: Variability,
    /// Start value; present exactly for parameters (initial = exact) and inputs.
    pub start: Option<Value>,
    /// Unit name; `None` for pure numbers.
    pub unit: Option<&'static str>,
    /// Type definition, of Reals.
    pub declared_type: Option<&'static str>,
    /// One sentence.
    pub description: String,
    /// What it stands for.
    pub quantity: Quantity,
}

/// What a variable stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// The scene number of this index in the scene's list of leaves.
    Parameter(usize),
    /// An input.
    Input(Input),
    /// An output.
    Output(Output),
}
