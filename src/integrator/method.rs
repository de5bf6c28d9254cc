//! The method that a scene asks for.

use super::{ESDIRK3, ESDIRK4, Esdirk, Integrator, Problem, Radau5, Rodas4, TR_BDF2, Trial};
use crate::scene;

/// One of the methods, chosen once: no call is virtual.
#[derive(Clone, Debug)]
pub enum Method {
    /// Rosenbrock.
    Rodas4(Box<Rodas4>),
    /// Implicit, with kept factors.
    Esdirk(Box<Esdirk>),
    /// Implicit, all stages at once.
    Radau5(Box<Radau5>),
}

impl Method {
    /// For `size` unknowns, of which those `at` are coupled beyond the band.
    pub fn new(which: scene::Method, size: usize, at: &[usize]) -> Self {
        let esdirk = |tableau| Self::Esdirk(Box::new(Esdirk::new(tableau, size, at)));
        match which {
            scene::Method::Rodas4 => Self::Rodas4(Box::new(Rodas4::new(size, at))),
            scene::Method::TrBdf2 => esdirk(&TR_BDF2),
            scene::Method::Esdirk3 => esdirk(&ESDIRK3),
            scene::Method::Esdirk4 => esdirk(&ESDIRK4),
            scene::Method::Radau5 => Self::Radau5(Box::new(Radau5::new(size, at))),
        }
    }
}

/// The same call of whichever method it is.
macro_rules! whichever {
    ($self:ident, $method:ident => $call:expr) => {
        match $self {
            Method::Rodas4($method) => $call,
            Method::Esdirk($method) => $call,
            Method::Radau5($method) => $call,
        }
    };
}

impl Integrator for Method {
    fn estimate_order(&self) -> usize {
        whichever!(self, m => m.estimate_order())
    }

    fn strictness(&self, relative: f64) -> f64 {
        whichever!(self, m => m.strictness(relative))
    }

    fn begin<P: Problem>(&mut self, problem: &mut P, t: f64, from: [&[f64]; 3], force: &mut [f64]) {
        whichever!(self, m => m.begin(problem, t, from, force));
    }

    fn attempt<P: Problem>(&mut self, problem: &mut P, t: f64, h: f64, from: [&[f64]; 3], force: &[f64]) -> Trial {
        whichever!(self, m => m.attempt(problem, t, h, from, force))
    }

    fn state(&self) -> [&[f64]; 3] {
        whichever!(self, m => m.state())
    }

    fn error(&self) -> &[f64] {
        whichever!(self, m => m.error())
    }

    fn accept<P: Problem>(&self, problem: &mut P) {
        whichever!(self, m => m.accept(problem));
    }

    fn forget(&mut self) {
        whichever!(self, m => m.forget());
    }

    fn visit(&mut self, visit: &mut dyn FnMut(&mut [f64])) {
        whichever!(self, m => m.visit(visit));
    }

    fn retake<P: Problem>(&mut self, problem: &mut P) {
        whichever!(self, m => m.retake(problem));
    }

    fn carries_over(&self) -> bool {
        whichever!(self, m => m.carries_over())
    }

    fn counts(&self) -> [u64; 3] {
        whichever!(self, m => m.counts())
    }
}
