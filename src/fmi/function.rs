//! Which function may be called in which phase of an instance's life.

/// The phases of a co-simulation instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Phase {
    /// After fmi2Instantiate or fmi2Reset.
    Instantiated = 1,
    /// Between fmi2EnterInitializationMode and fmi2ExitInitializationMode.
    Initialization = 2,
    /// At a communication point; a step that could not be done leaves the instance here too.
    Stepping = 4,
    /// No start state was found.
    Failed = 8,
    /// After fmi2Terminate.
    Terminated = 16,
    /// After a caught panic: nothing in the instance can be trusted.
    Poisoned = 32,
}

impl Phase {
    const ALL: [Self; 6] = [Self::Instantiated, Self::Initialization, Self::Stepping, Self::Failed, Self::Terminated, Self::Poisoned];

    /// The phase with this number in a saved state. A poisoned instance saves nothing.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|&phase| phase as u8 == number && phase != Self::Poisoned)
    }

    /// For messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "in initialization mode",
            Self::Stepping => "initialized",
            Self::Failed => "without a start state after a failed initialization",
            Self::Terminated => "terminated",
            Self::Poisoned => "unusable after an internal error",
        }
    }
}

const I: u8 = Phase::Instantiated as u8;
const N: u8 = Phase::Initialization as u8;
const S: u8 = Phase::Stepping as u8;
const F: u8 = Phase::Failed as u8;
const T: u8 = Phase::Terminated as u8;
const P: u8 = Phase::Poisoned as u8;

macro_rules! functions {
    ($($name:ident: $phases:expr;)*) => {
        /// The functions that take an instance.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Function { $($name),* }

        impl Function {
            /// As FMI spells it.
            pub fn name(self) -> &'static str {
                match self { $(Self::$name => concat!("fmi2", stringify!($name))),* }
            }

            fn phases(self) -> u8 {
                match self { $(Self::$name => $phases),* }
            }
        }
    };
}

// FMI 2.0.5 section 4.2.4, more lenient where no harm can come of it: values may be read in every phase, and an instance goes on
// after a step that it could not do.
functions! {
    SetDebugLogging:          I | N | S | F | T;
    SetupExperiment:          I;
    EnterInitializationMode:  I;
    ExitInitializationMode:       N;
    Terminate:                        S;
    Reset:                    I | N | S | F | T | P;
    GetReal:                  I | N | S | F | T;
    GetInteger:               I | N | S | F | T;
    GetBoolean:               I | N | S | F | T;
    GetString:                I | N | S | F | T;
    SetReal:                  I | N | S;
    SetInteger:               I | N | S;
    SetBoolean:               I | N | S;
    SetString:                I | N | S;
    GetFMUstate:              I | N | S | F | T;
    SetFMUstate:              I | N | S | F | T;
    FreeFMUstate:             I | N | S | F | T | P;
    SerializedFMUstateSize:   I | N | S | F | T;
    SerializeFMUstate:        I | N | S | F | T;
    DeSerializeFMUstate:      I | N | S | F | T;
    GetDirectionalDerivative:     N | S | F | T;
    SetRealInputDerivatives:  I | N | S;
    GetRealOutputDerivatives:         S | F | T;
    DoStep:                           S;
    CancelStep:                       S;
    GetStatus:                        S | F | T;
    GetRealStatus:                    S | F | T;
    GetIntegerStatus:                 S | F | T;
    GetBooleanStatus:                 S | F | T;
    GetStringStatus:                  S | F | T;
}

impl Function {
    /// Whether the table allows this function now.
    pub fn allowed(self, phase: Phase) -> bool {
        self.phases() & phase as u8 != 0
    }

    /// For messages.
    pub fn when(self) -> String {
        let names: Vec<_> = Phase::ALL.into_iter().filter(|&phase| self.allowed(phase)).map(Phase::name).collect();
        names.join(", or ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_survive_their_numbers() {
        for phase in Phase::ALL {
            let expected = (phase != Phase::Poisoned).then_some(phase);
            assert_eq!(Phase::from_number(phase as u8), expected);
        }
        assert_eq!(Phase::from_number(3), None);
    }

    #[test]
    fn poisoned_instances_can_only_be_reset() {
        assert!(Function::Reset.allowed(Phase::Poisoned) && Function::FreeFMUstate.allowed(Phase::Poisoned));
        assert!(!Function::GetReal.allowed(Phase::Poisoned) && !Function::DoStep.allowed(Phase::Poisoned));
        assert_eq!(Function::DoStep.when(), "initialized");
        assert_eq!(Function::DoStep.name(), "fmi2DoStep");
    }
}
