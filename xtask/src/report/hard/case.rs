//! What a hard case is: a scene, how it is driven, what is asked of it.

use super::super::scene::Scene;
use super::run::Run;

/// Communication points.
pub enum Times {
    /// Steps of this size up to this end, s.
    Equal(f64, f64),
    /// These points, s, the first of them 0.
    Listed(Vec<f64>),
}

impl Times {
    /// The points in order, from 0.
    pub fn points(&self) -> Vec<f64> {
        match self {
            Self::Equal(step, end) => (0..=(end / step).round() as usize).map(|k| k as f64 * step).collect(),
            Self::Listed(points) => points.clone(),
        }
    }
}

/// The error that the report claims for a figure.
#[derive(Clone, Copy, Debug)]
pub enum Claim {
    /// Of the figure itself.
    Share(f64),
    /// In its unit.
    Amount(f64),
}

/// What a figure is.
pub enum Measure {
    /// A number of a run; NaN where the run has none.
    Value(Box<dyn Fn(&Run) -> f64 + Send + Sync>),
    /// A recorded output as a whole: figures are rms distances from the shipped run over its rms.
    Signal(&'static str),
}

/// A figure that is reported, with its error.
pub struct Quantity {
    /// What it is.
    pub what: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// How it comes from a run.
    pub measure: Measure,
    /// What refinement may change.
    pub claim: Claim,
    /// A truth from elsewhere, the share by which the figure may be off, and the source.
    pub truth: Option<(f64, f64, &'static str)>,
}

impl Quantity {
    /// A number of a run.
    pub fn new(what: &'static str, unit: &'static str, claim: Claim, of: impl Fn(&Run) -> f64 + Send + Sync + 'static) -> Self {
        Self { what, unit, measure: Measure::Value(Box::new(of)), claim, truth: None }
    }

    /// A recorded output as a whole.
    pub fn signal(what: &'static str, name: &'static str, claim: f64) -> Self {
        Self { what, unit: "", measure: Measure::Signal(name), claim: Claim::Share(claim), truth: None }
    }

    /// With a truth to be met within a share of it.
    pub fn against(self, truth: f64, within: f64, source: &'static str) -> Self {
        Self { truth: Some((truth, within, source)), ..self }
    }
}

/// How a run must end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// At the last communication point.
    Completes,
    /// With a step that is refused (fmi2Discard, `status.code` 2) by a message with these words; the instance is as it was before.
    Stops(&'static str),
}

/// How a case is driven: input names, their values at the begin of each step.
pub type Drive = (&'static [&'static str], Box<dyn Fn(f64) -> Vec<f64> + Send + Sync>);

/// A hard case.
pub struct Case {
    /// Short name.
    pub name: String,
    /// What happens physically.
    pub happens: String,
    /// What other programs do, where that is known.
    pub peers: &'static str,
    /// The scene as shipped.
    pub scene: Scene,
    /// Communication points.
    pub times: Times,
    /// Inputs.
    pub drive: Drive,
    /// Outputs to record.
    pub record: Vec<&'static str>,
    /// What is reported.
    pub quantities: Vec<Quantity>,
    /// How it must end.
    pub ends: Ends,
    /// Greatest energy error over the work done.
    pub energy: f64,
    /// Greatest momentum defect (see [`super::momentum`]); without it the balance is not made.
    pub momentum: Option<f64>,
    /// Further scenes that the figures are compared with.
    pub others: Vec<(&'static str, Scene)>,
    /// Signal to draw, its label and the factor to the label's unit.
    pub draw: (&'static str, &'static str, f64),
}

/// What the energy error of a case that completes must stay below.
pub const ENERGY: f64 = 1e-3;

impl Case {
    /// A case without inputs, balance and figures, which must complete; the signal to draw is recorded.
    pub fn new(name: impl Into<String>, scene: Scene, times: Times, draw: (&'static str, &'static str, f64)) -> Self {
        Self {
            name: name.into(),
            happens: String::new(),
            peers: "",
            scene,
            times,
            drive: (&[], Box::new(|_| Vec::new())),
            record: vec![draw.0],
            quantities: Vec::new(),
            ends: Ends::Completes,
            energy: ENERGY,
            momentum: None,
            others: Vec::new(),
            draw,
        }
    }

    /// With what happens, and what other programs do.
    pub fn happens(self, happens: impl Into<String>, peers: &'static str) -> Self {
        Self { happens: happens.into(), peers, ..self }
    }

    /// With inputs over time.
    pub fn driven(self, inputs: &'static [&'static str], at: impl Fn(f64) -> Vec<f64> + Send + Sync + 'static) -> Self {
        Self { drive: (inputs, Box::new(at)), ..self }
    }

    /// With further outputs recorded.
    pub fn record(mut self, names: &[&'static str]) -> Self {
        self.record.extend(names);
        self
    }

    /// With a figure.
    pub fn asks(mut self, quantity: Quantity) -> Self {
        self.quantities.push(quantity);
        self
    }

    /// With a refused step as its end.
    pub fn stops(self, words: &'static str) -> Self {
        Self { ends: Ends::Stops(words), ..self }
    }

    /// With the balance of momentum, which must close to `bound`.
    pub fn balanced(self, bound: f64) -> Self {
        Self { momentum: Some(bound), ..self }
    }

    /// With a further scene that the figures are compared with.
    pub fn beside(mut self, label: &'static str, scene: Scene) -> Self {
        self.others.push((label, scene));
        self
    }
}
