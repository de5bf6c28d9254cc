//! Which outputs have derivatives.

use crate::Output;

/// The greatest order of time derivatives of outputs.
pub const MAX_OUTPUT_DERIVATIVE_ORDER: i32 = 1;

impl Output {
    /// Whether it is a differentiable function of the state: all continuous Reals but those found by sampling or following the contact arc.
    pub fn is_smooth(self) -> bool {
        use Output::*;
        !matches!(
            self,
            SheaveWrapAngle(_)
                | SheaveContactBegin(_)
                | SheaveContactEnd(_)
                | SheaveTurnAngle(_)
                | SheaveLineLoadMax(_)
                | SheaveLineLoadMin(_)
                | SheaveInContact(_)
                | SheaveOutOfGroove(_)
                | CableSlack
                | StatusCode
                | StatusMessage
                | SolverSteps
                | SolverRejected
                | SolverIterations
                | SolverEnergyError
        )
    }
}
