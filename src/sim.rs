//! The only door to the physics: a scene goes in, committed states come out.

use crate::outputs::Outputs;
use crate::scene::Scene;
use thiserror::Error;

/// One scalar input over a communication step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel {
    /// Value at the step's begin.
    pub value: f64,
    /// First time derivative there, if known.
    pub first: Option<f64>,
    /// Second time derivative there, if known (only together with the first).
    pub second: Option<f64>,
}

/// Everything that comes from outside, at the begin of a communication step. z up, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// x, y, z, roll, pitch, yaw of the ship's frame.
    pub ship: [Channel; 6],
    /// Winch set-point (rad, or m with a payout command), with its rate.
    pub winch: Channel,
    /// Uniform current added to the profile, x and y, m/s.
    pub current: [Channel; 2],
    /// External force on the body, world, N.
    pub body_force: [Channel; 3],
}

/// What can go wrong in a simulation; every message says when, where, why and what to try.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SimError {
    /// The scene cannot be started.
    #[error("no start state: {0}")]
    Start(String),
    /// A communication step could not be completed; the state is as it was before it.
    #[error("step failed: {0}")]
    Step(String),
    /// A saved state does not fit.
    #[error("state refused: {0}")]
    State(String),
}

/// A simulation of one scene.
#[derive(Clone)]
pub struct Simulation {
    outputs: Outputs,
    time: f64,
}

impl Simulation {
    /// Allocates everything that the scene needs. Nothing is solved yet.
    pub fn new(_scene: &Scene) -> Result<Self, SimError> {
        Ok(Self { outputs: Outputs::default(), time: 0.0 })
    }

    /// Finds the start state under the first inputs and evaluates the outputs there. May be called again (inputs changed before the first step).
    ///
    /// # Errors
    /// [`SimError::Start`] when there is no such state.
    pub fn initialize(&mut self, time: f64, _inputs: &Inputs) -> Result<(), SimError> {
        self.time = time;
        Ok(())
    }

    /// Integrates to `time` (s) exactly, with `inputs` as of the present time.
    ///
    /// # Errors
    /// [`SimError::Step`]; the state is then as it was before the call.
    pub fn step_to(&mut self, time: f64, _inputs: &Inputs) -> Result<(), SimError> {
        self.time = time;
        Ok(())
    }

    /// Takes over the tunable parameters of a changed scene between two steps.
    ///
    /// # Errors
    /// [`SimError::State`] when something else than a tunable parameter differs.
    pub fn retune(&mut self, _scene: &Scene) -> Result<(), SimError> {
        Ok(())
    }

    /// Quantities of the last committed state.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Time of the last committed state, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Appends everything that the next step depends on: little-endian, no pointers, complete (a restored run is bit-identical).
    pub fn write_state(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.time.to_le_bytes());
    }

    /// Takes over a state written by [`Self::write_state`] of a simulation of the same scene; leaves `self` untouched on error.
    ///
    /// # Errors
    /// [`SimError::State`] when the bytes do not fit this scene.
    pub fn read_state(&mut self, bytes: &[u8]) -> Result<(), SimError> {
        let b: [u8; 8] = bytes.try_into().map_err(|_| SimError::State("wrong length".into()))?;
        self.time = f64::from_le_bytes(b);
        Ok(())
    }
}
